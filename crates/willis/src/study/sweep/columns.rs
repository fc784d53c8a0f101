//! What the columns of a sweep hold.

use crate::analysis::{Losses, PointNumbers};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::model::Target;
use crate::study::answer::PointAnswer;
use crate::study::column::{Column, ColumnValues};
use crate::train::Train;

use super::Sweep;

/// What a column holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::study) enum What {
    Axis(usize),
    Verdict,
    Best,
    Efficiency,
    InputPower,
    OutputPower,
    Loss,
    LossOf(usize),
    Residual,
    Circulating,
    LockFactor,
    Speed(String),
    Torque(String),
    Power(String),
    MeshLoss(String),
    MeshEfficiency(String),
    MeshFriction(String),
    ElementTorque(String),
    SourceLoss(String),
    /// Speed of the input over that of the output.
    Ratio,
    /// Speed of a member in rpm.
    SpeedRpm(String),
    /// Of a variator: power that reaches the receiving side, that over the input power, loss, power of the store, and
    /// its own ratio.
    Variator(String, OfVariator),
    /// Of a machine, or a side, of a variator.
    Machine([String; 2], OfMachine),
    Reason,
    Warnings,
}

impl What {
    /// Whether the [numbers](PointNumbers) of a point have it.
    pub(super) fn is_among_numbers(&self) -> bool {
        match self {
            Self::Axis(_) | Self::Verdict | Self::Best | Self::Reason | Self::Warnings | Self::Ratio => true,
            Self::Efficiency | Self::InputPower | Self::OutputPower | Self::Loss | Self::LossOf(_) | Self::Residual => {
                true
            }
            Self::Speed(_) | Self::Torque(_) | Self::Power(_) | Self::SpeedRpm(_) => true,
            Self::Circulating | Self::LockFactor | Self::MeshLoss(_) | Self::MeshEfficiency(_) => false,
            Self::MeshFriction(_) | Self::ElementTorque(_) | Self::SourceLoss(_) => false,
            Self::Variator(..) | Self::Machine(..) => false,
        }
    }
}

/// A number of a variator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) enum OfVariator {
    Power,
    Share,
    Loss,
    Store,
    Ratio,
}

/// A number of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) enum OfMachine {
    Torque,
    Speed,
    Power,
}

/// The group of columns that are only had by their own name.
const SINGLY: &str = "";

/// A column that may be asked for.
struct Offer {
    /// The name that several go by.
    group: &'static str,
    column: Column,
    what: What,
}

/// The columns that may be asked for.
fn offers(train: &Train) -> Vec<Offer> {
    let mut all = vec![];
    let mut offer = |group, name: String, unit: &str, what| {
        all.push(Offer { group, column: Column::number(name, unit), what });
    };
    offer("all", "power_residual_w".into(), "W", What::Residual);
    offer("all", "circulating_power_w".into(), "W", What::Circulating);
    offer("all", "lock_loss_factor".into(), "", What::LockFactor);
    offer("all", "ratio".into(), "", What::Ratio);
    // All but the frame, which is at rest.
    for m in train.members().iter().skip(1).map(|m| &m.name) {
        offer("members", format!("{m}.speed_rad_s"), "rad/s", What::Speed(m.clone()));
        offer("members", format!("{m}.torque_n_m"), "N m", What::Torque(m.clone()));
        offer("members", format!("{m}.power_w"), "W", What::Power(m.clone()));
        offer(SINGLY, format!("{m}.speed_rpm"), "rpm", What::SpeedRpm(m.clone()));
    }
    for m in train.meshes().iter().map(|m| &m.name) {
        offer("meshes", format!("{m}.loss_w"), "W", What::MeshLoss(m.clone()));
        offer("meshes", format!("{m}.efficiency"), "", What::MeshEfficiency(m.clone()));
        if train.is_physical() {
            offer("meshes", format!("{m}.friction"), "", What::MeshFriction(m.clone()));
        }
    }
    for e in train.shift_elements().iter().map(|e| &e.name) {
        offer("elements", format!("{e}.torque_n_m"), "N m", What::ElementTorque(e.clone()));
    }
    let sources = (train.meshes().iter().map(|m| &m.name))
        .chain(train.bearings.iter().map(|b| &b.name))
        .chain(train.seals.iter().map(|b| &b.name))
        .chain(train.rotors.iter().map(|b| &b.name))
        .chain(train.drags.iter().map(|b| &b.name))
        .chain(train.pumps.iter().map(|b| &b.name))
        .chain(train.shift_elements.iter().filter(|e| e.open.is_some()).map(|b| &b.name))
        .chain(train.variators.iter().map(|v| &v.name));
    for s in sources {
        // A mesh has a loss of its own by sliding; this is all that is lost under a name.
        offer("sources", format!("{s}.total_loss_w"), "W", What::SourceLoss(s.clone()));
    }
    for v in &train.variators {
        let name = &v.name;
        let mut own = |key: &str, unit, of| {
            offer("variators", format!("{name}.{key}"), unit, What::Variator(name.clone(), of));
        };
        own("power_w", "W", OfVariator::Power);
        own("share", "", OfVariator::Share);
        own("loss_w", "W", OfVariator::Loss);
        if v.has_bus() {
            own("store_w", "W", OfVariator::Store);
        }
        if v.members().len() == 2 {
            own("ratio", "", OfVariator::Ratio);
        }
        let sides: Vec<String> = match v.machines() {
            [] => v.members().iter().map(|m| train.member_name(*m).to_owned()).collect(),
            machines => machines.iter().map(|m| m.name.clone()).collect(),
        };
        for side in sides {
            for (key, unit, of) in [
                ("torque_n_m", "N m", OfMachine::Torque),
                ("speed_rad_s", "rad/s", OfMachine::Speed),
                ("power_w", "W", OfMachine::Power),
            ] {
                let what = What::Machine([name.clone(), side.clone()], of);
                offer("variators", format!("{name}.{side}.{key}"), unit, what);
            }
        }
    }
    all
}

impl Sweep<'_> {
    /// The columns that every sweep over these axes has, up to the reason and the warnings.
    fn usual(&self) -> Vec<(Column, What)> {
        let train = self.question.model().train();
        let physical = train.is_physical()
            || !train.variators.is_empty()
            || self.axes.iter().any(|a| matches!(a.target, Target::File(_)));
        let axis = |(k, a): (usize, &super::Axis)| match a.is_text() {
            true => (Column::text(a.column()), What::Axis(k)),
            false => (Column::number(a.column(), a.unit.clone()), What::Axis(k)),
        };
        let mut all: Vec<(Column, What)> = self.axes.iter().enumerate().map(axis).collect();
        all.push((Column::text("verdict"), What::Verdict));
        if self.group() > 1 {
            all.push((Column::text("best"), What::Best));
        }
        all.push((Column::number("efficiency", ""), What::Efficiency));
        all.push((Column::number("input_power_w", "W"), What::InputPower));
        all.push((Column::number("output_power_w", "W"), What::OutputPower));
        all.push((Column::number("loss_w", "W"), What::Loss));
        if physical {
            let column = |k: usize| Column::number(Losses::column(k), "W");
            all.extend(Losses::of_train(train).map(|k| (column(k), What::LossOf(k))));
        }
        all
    }

    /// The usual columns and those asked for.
    pub(super) fn choose(&self, asked: &[String]) -> Result<Vec<(Column, What)>, Diagnostics> {
        let mut all = self.usual();
        let offers = offers(self.question.model().train());
        let mut wrong = Diagnostics::default();
        for name in asked {
            let name = name.trim();
            let known = all.iter().any(|c| c.0.is_called(name));
            let in_group = |o: &Offer| o.group != SINGLY && (name == "all" || o.group == name);
            let is_meant =
                |o: &&Offer| in_group(o) || o.column.name == name || o.group != SINGLY && o.column.is_called(name);
            let chosen: Vec<&Offer> = offers.iter().filter(is_meant).collect();
            if chosen.is_empty() && !known && !matches!(name, "elements" | "variators") {
                let d = Diagnostic::new(Code::UnknownName, "", format!("there is no column `{name}`"));
                let groups = ["members", "meshes", "elements", "sources", "variators"];
                let d = d.suggest(name, offers.iter().map(|o| o.column.name.as_str()).chain(groups));
                wrong.push(d.hint("`members`, `meshes`, `elements`, `sources`, `variators` and `all` name several"));
            }
            for Offer { column, what, .. } in chosen {
                // An axis of that name has its values.
                if !all.iter().any(|c| c.1 == *what || c.0.name == column.name) {
                    all.push((column.clone(), what.clone()));
                }
            }
        }
        if wrong.has_errors() {
            return Err(wrong);
        }
        all.push((Column::text("reason"), What::Reason));
        all.push((Column::text("warnings"), What::Warnings));
        Ok(all)
    }

    /// Adds the value of a column at a point.
    pub(super) fn cell(
        &self,
        values: &mut ColumnValues,
        what: &What,
        place: &[usize],
        answer: &PointAnswer,
        is_best: bool,
    ) {
        match values {
            ColumnValues::Numbers(all) => all.push(self.number(what, place, answer)),
            ColumnValues::Integers(_) => unreachable!("no column of a sweep counts"),
            ColumnValues::Texts(all) => all.push(match what {
                What::Axis(k) => self.axes[*k].setting(place[*k]).into(),
                What::Verdict => answer.verdict.name().into(),
                What::Best => if is_best { "yes" } else { "no" }.into(),
                What::Reason => answer.reason.clone().into(),
                What::Warnings => {
                    let all: Vec<String> =
                        answer.warnings.iter().map(|w| format!("{} {}", w.code, w.message)).collect();
                    all.join("; ").into()
                }
                _ => unreachable!("all others are numbers"),
            }),
        }
    }

    fn number(&self, what: &What, place: &[usize], answer: &PointAnswer) -> f64 {
        if let What::Axis(k) = what {
            return self.axes[*k].number(place[*k]);
        }
        if *what == What::Ratio {
            return answer.ratio.unwrap_or(f64::NAN);
        }
        if let Some(found) = answer.numbers.as_ref().and_then(|numbers| self.among(what, numbers, answer)) {
            return found.unwrap_or(f64::NAN);
        }
        let Some(s) = &answer.solution else { return f64::NAN };
        let found = match what {
            What::Circulating => Some(s.recirculation.iter().map(|r| r.power_w).fold(0.0, f64::max)),
            What::LockFactor => s.margin.lock_loss_factor,
            What::MeshLoss(name) => s.meshes.get(name).map(|m| m.loss_w),
            What::MeshEfficiency(name) => s.meshes.get(name).map(|m| m.efficiency),
            What::MeshFriction(name) => s.contacts.get(name).and_then(|m| m.friction),
            What::ElementTorque(name) => s.shift_elements.get(name).and_then(|m| m.torque_n_m),
            What::SourceLoss(name) => {
                let mut own = s.sources.iter().filter(|x| x.name == *name).map(|x| x.loss_w).peekable();
                own.peek().is_some().then(|| own.sum())
            }
            What::Variator(name, of) => s.variators.get(name).and_then(|v| match of {
                OfVariator::Power => Some(v.power_w),
                OfVariator::Share => Some(v.share),
                OfVariator::Loss => Some(v.loss_w),
                OfVariator::Store => v.store_w,
                OfVariator::Ratio => v.ratio,
            }),
            What::Machine([name, side], of) => {
                s.variators.get(name).and_then(|v| v.machines.get(side)).map(|m| match of {
                    OfMachine::Torque => m.torque_n_m,
                    OfMachine::Speed => m.speed_rad_s,
                    OfMachine::Power => m.power_w,
                })
            }
            _ => None,
        };
        found.unwrap_or(f64::NAN)
    }

    /// A quantity that is [among the numbers](What::is_among_numbers) of a point, where it has a value; `None` for others.
    fn among(&self, what: &What, s: &PointNumbers, answer: &PointAnswer) -> Option<Option<f64>> {
        let member = |name: &str| self.question.model().train().member(name);
        let numbers = |name: &str| member(name).and_then(|m| s.member(m));
        Some(match what {
            What::Efficiency => s.efficiency,
            What::InputPower => Some(s.input_power_w),
            What::OutputPower => Some(s.output_power_w),
            What::Loss => Some(s.loss_w),
            What::LossOf(kind) => Some(s.losses_w.all()[*kind]),
            What::Residual => Some(s.power_residual_w),
            What::Speed(name) => numbers(name).and_then(|m| m.speed_rad_s),
            What::Torque(name) => numbers(name).and_then(|m| m.torque_n_m),
            What::Power(name) => numbers(name).and_then(|m| m.power_w),
            What::SpeedRpm(name) => {
                let prescribed = answer.prescribed_rpm.iter().find(|(own, _)| Some(*own) == member(name));
                let turning = || numbers(name)?.speed_rad_s.map(|w| w * 30.0 / std::f64::consts::PI);
                prescribed.map(|(_, rpm)| *rpm).or_else(turning)
            }
            _ => return None,
        })
    }
}
