//! Losses at a few points: over speed, load and temperature, and law beside law.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Severity};
use crate::losses::{self, LawSummary, Tag};
use crate::train::{Load, MemberId, Operation, Train};
use crate::units::Quantity;

use super::band::LawBand;
use super::{Convergence, LossSource, Losses, NameMap, OutsideLaw, Verdict, Why, assumptions, operate_unnamed, words};

/// Where to evaluate the losses of a train. An empty list leaves a quantity as the file has it.
#[derive(Clone, Debug, Default)]
pub struct LossRequest {
    /// Only this operation of the file.
    pub operation: Option<String>,
    /// Values of the operation's first prescribed speed; further ones are scaled with it.
    pub speeds: Vec<Quantity>,
    /// Values of the power at the operation's first load; further loads are scaled with it.
    pub powers: Vec<Quantity>,
    /// Values of the torque at the operation's first load; further loads are scaled with it.
    pub torques: Vec<Quantity>,
    /// Oil temperatures, K.
    pub temperatures: Vec<f64>,
    /// A family of laws: every point is evaluated with every law of it.
    pub compare: Option<String>,
    /// Also what other laws of loss make of each efficiency: some twenty points in floating point each.
    pub bands: bool,
}

impl LossRequest {
    /// How many points it asks for.
    pub fn points(&self, train: &Train) -> u64 {
        let operations = if self.operation.is_some() { 1 } else { train.operations.len() };
        let laws = (self.compare.as_ref()).map_or(1, |f| losses::entries().iter().filter(|e| e.family == *f).count());
        let values = [&self.speeds, &self.powers, &self.torques].map(|v| v.len()).into_iter();
        let all = values.chain([self.temperatures.len(), operations, laws]);
        all.fold(1, |n: u64, k| n.saturating_mul(k.max(1) as u64))
    }
}

/// One point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LossPoint {
    /// The operation it comes from.
    pub operation: String,
    /// The member of the first prescribed speed.
    pub speed_of: Option<String>,
    /// Its speed, rad/s.
    pub speed_rad_s: f64,
    /// The member of the first load.
    pub torque_of: Option<String>,
    /// Its torque, N m.
    pub torque_n_m: Option<f64>,
    /// Oil temperature, K; absent without an oil.
    pub temperature_k: Option<f64>,
    /// The law in force, where laws are compared.
    pub law: Option<String>,
    /// What can be said of the point.
    pub verdict: Verdict,
    /// One sentence that explains the verdict.
    pub reason: Option<String>,
    /// What `reason` says, as data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<Why>,
    /// Output over input power.
    pub efficiency: Option<f64>,
    /// Between which values other laws put it, where [`LossRequest::bands`] asks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Box<LawBand>>,
    /// Power in, W.
    pub input_power_w: f64,
    /// All losses, W.
    pub loss_w: f64,
    /// Losses by kind.
    pub losses_w: Losses,
    /// Losses by source, largest first.
    pub sources: Vec<LossSource>,
    /// Mean coefficient of friction of each mesh.
    pub friction: NameMap<Option<f64>>,
    /// How losses and torques were brought into agreement.
    pub convergence: Option<Convergence>,
    /// Warnings of this point.
    pub warnings: Vec<String>,
    /// Those of them that say that a law was used outside its range, as data.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside_laws: Vec<OutsideLaw>,
}

/// How far the laws of a family disagree at a point: the honest uncertainty of a prediction. Laws
/// outside their range count only where fewer than two are inside; laws that reproduce a published
/// error never count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Spread {
    /// Smallest loss, W, and the law that gives it.
    pub least_w: (f64, String),
    /// Largest loss, W, and the law that gives it.
    pub most_w: (f64, String),
    /// Laws that were used inside their ranges.
    pub inside: usize,
    /// Laws in all.
    pub laws: usize,
}

/// Losses at the points asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LossTable {
    /// `willis-losses-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// The family whose laws are compared.
    pub family: Option<String>,
    /// The points, operation by operation, speed, load, temperature, law.
    pub points: Vec<LossPoint>,
    /// Where laws are compared: the spread over each group of points that differ in the law alone.
    pub spreads: Vec<Spread>,
    /// What the model leaves out, and what stands in for data that were not given.
    #[serde(default)]
    pub assumptions: Vec<String>,
}

impl Contract for LossTable {
    const FORMAT: &'static str = "willis-losses-1";
}

/// What is wrong with oil temperatures, K, that are asked for.
pub(super) fn beyond_oils(train: &Train, temperatures: &[f64]) -> Diagnostics {
    let mut wrong = Diagnostics::default();
    if !temperatures.is_empty() && train.lubrication.is_none() {
        let d = Diagnostic::new(Code::MissingKey, "oil", "a temperature is given, but the train has no oil");
        wrong.push(d.hint("add [oil] with a name of the catalogue, or its viscosities"));
    }
    for t in temperatures.iter().filter(|t| !(200.0..=600.0).contains(*t)) {
        let message = format!("an oil temperature of {:.1} °C is none that a gearbox has", t - 273.15);
        wrong.push(Diagnostic::new(Code::OutOfRange, "", message).hint("from -73 to 327 °C is computed"));
    }
    wrong
}

/// Evaluates losses.
///
/// # Errors
/// An unknown operation or family, a train without operations, a speed or load to scale that is
/// zero, a temperature without an oil, and what an operation prescribes wrongly.
///
/// # Example
/// ```
/// use willis::analysis::{losses, LossRequest};
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "one set"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [oil]
///     name = "ISO VG 220"
///     temperature = "70 degC"
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     planet = { teeth = 20, count = 4 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     geometry = { module = "2 mm", width = "25 mm", roughness = "0.4 um" }
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "200 N m" }
/// "#)?;
/// let table = losses(&train, &LossRequest { compare: Some("mesh_friction".into()), ..LossRequest::default() })?;
/// assert!(table.points.len() > 5);
/// assert!(table.spreads[0].most_w.0 > table.spreads[0].least_w.0);
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
pub fn losses(train: &Train, request: &LossRequest) -> Result<LossTable, Diagnostics> {
    let mut wrong = Diagnostics::default();
    let chosen: Vec<&Operation> = match &request.operation {
        Some(name) => train.operations.iter().filter(|o| o.name == *name).collect(),
        None => train.operations.iter().collect(),
    };
    if let Some(Err(d)) = request.operation.as_ref().map(|name| train.find_operation(name)) {
        wrong.push(*d);
    } else if chosen.is_empty() {
        let d = Diagnostic::new(Code::UnknownSelection, "", "losses belong to an operating point, and there is none");
        wrong.push(d.hint("add an [[operation]] with speeds and torques or powers"));
    }
    if let Some(family) = &request.compare
        && !losses::FAMILIES.contains(&family.as_str())
    {
        let message = format!("there is no family of laws `{family}`");
        let d = Diagnostic::new(Code::UnknownName, "", message).suggest(family, losses::FAMILIES.iter().copied());
        wrong.push(d.hint(format!("the families are: {}", losses::FAMILIES.join(", "))));
    }
    wrong.extend(beyond_oils(train, &request.temperatures));
    if wrong.has_errors() {
        return Err(wrong);
    }
    let laws: Vec<(Option<LawSummary>, Cow<'_, Train>)> = match &request.compare {
        // A law that needs what this train does not give is left out.
        Some(family) => (losses::entries().into_iter().filter(|e| e.family == *family))
            .filter_map(|e| train.clone().with_law(family, e.id).ok().map(|train| (Some(e), Cow::Owned(train))))
            .collect(),
        None => vec![(None, Cow::Borrowed(train))],
    };
    let mut table = LossTable {
        format: Format::new(),
        train: train.name.clone(),
        family: request.compare.clone(),
        points: vec![],
        spreads: vec![],
        assumptions: assumptions(train),
    };
    for operation in chosen {
        for varied in variants(operation, request, &mut wrong) {
            let from = table.points.len();
            for (law, train) in &laws {
                match point(train, &varied, law.as_ref().map(|l| l.id)) {
                    Ok(mut p) => {
                        if request.bands {
                            let at = Operation { temperature: p.temperature_k, ..varied.clone() };
                            p.band = LawBand::of(train, &at).map(Box::new);
                        }
                        table.points.push(p);
                    }
                    Err(d) => wrong.extend(d),
                }
            }
            if let Some(family) = &request.compare {
                let compatibility = |id: &str| {
                    laws.iter().filter_map(|l| l.0.as_ref()).any(|e| e.id == id && e.tags.contains(&Tag::Compatibility))
                };
                table.spreads.extend(spread(&table.points[from..], family, compatibility));
            }
        }
    }
    if wrong.has_errors() { Err(wrong) } else { Ok(table) }
}

/// The operation at every combination of the values asked for.
fn variants(operation: &Operation, request: &LossRequest, wrong: &mut Diagnostics) -> Vec<Operation> {
    let mut all = vec![operation.clone()];
    let mut fail = |what: &str| {
        let message =
            format!("operation `{}` prescribes no {what} other than zero that could be varied", operation.name);
        wrong.push(Diagnostic::new(Code::Unfit, operation.place.as_str(), message));
    };
    if !request.speeds.is_empty() {
        match operation.speeds.first().filter(|s| !s.1.value.is_zero()) {
            None => fail("speed"),
            Some((_, old)) => {
                let scaled = |new: &Quantity| {
                    let scale = |q: &Quantity| Quantity {
                        value: &q.value * &new.value / &old.value,
                        pi_power: q.pi_power + new.pi_power - old.pi_power,
                        dimension: q.dimension,
                    };
                    let speeds = operation.speeds.iter().map(|(m, q)| (*m, scale(q))).collect();
                    Operation { speeds, ..operation.clone() }
                };
                all = request.speeds.iter().map(scaled).collect();
            }
        }
    }
    for (values, torque) in [(&request.powers, false), (&request.torques, true)] {
        if values.is_empty() {
            continue;
        }
        let mut next = Vec::new();
        for base in &all {
            let first = base.loads.first().map(|(m, l)| (*m, quantity(l).clone()));
            let Some((member, old)) = first.filter(|(_, q)| !q.value.is_zero() || base.loads.len() == 1) else {
                fail("load");
                return vec![];
            };
            for new in values {
                let loads: Vec<(MemberId, Load)> = (base.loads.iter().enumerate())
                    .map(|(k, (m, load))| {
                        if k == 0 {
                            let q = new.clone();
                            return (member, if torque { Load::Torque(q) } else { Load::Power(q) });
                        }
                        // As the first changes; where its kind changes, the others stay.
                        let same_kind = matches!(load, Load::Torque(_)) == torque && old.dimension == new.dimension;
                        let q = quantity(load);
                        let q = match same_kind {
                            true => Quantity {
                                value: &q.value * &new.value / &old.value,
                                pi_power: q.pi_power + new.pi_power - old.pi_power,
                                dimension: q.dimension,
                            },
                            false => q.clone(),
                        };
                        (*m, if matches!(load, Load::Torque(_)) { Load::Torque(q) } else { Load::Power(q) })
                    })
                    .collect();
                next.push(Operation { loads, ..base.clone() });
            }
        }
        all = next;
    }
    if !request.temperatures.is_empty() {
        let at = |o: &Operation, t: f64| Operation { temperature: Some(t), ..o.clone() };
        all = all.iter().flat_map(|o| request.temperatures.iter().map(|t| at(o, *t))).collect();
    }
    all
}

pub(super) fn quantity(load: &Load) -> &Quantity {
    match load {
        Load::Torque(q) | Load::Power(q) => q,
    }
}

fn point(train: &Train, operation: &Operation, law: Option<&str>) -> Result<LossPoint, Diagnostics> {
    let (report, notes) = operate_unnamed(train, operation).map_err(|wrong| words::named(operation, wrong))?;
    let solution = report.solutions.first();
    let speed = operation.speeds.first().map_or(0.0, |s| s.1.si());
    let torque = operation.loads.first().and_then(|(m, load)| match load {
        Load::Torque(q) => Some(q.si()),
        Load::Power(p) => {
            let speed = (report.speeds_rad_s.get(train.member_name(*m)).copied().flatten()).filter(|w| *w != 0.0);
            speed.map(|w| p.si() / w)
        }
    });
    Ok(LossPoint {
        operation: operation.name.clone(),
        speed_of: operation.speeds.first().map(|s| train.member_name(s.0).to_owned()),
        speed_rad_s: speed,
        torque_of: operation.loads.first().map(|l| train.member_name(l.0).to_owned()),
        torque_n_m: torque,
        temperature_k: report.oil_k(train, operation),
        law: law.map(str::to_owned),
        verdict: report.verdict,
        reason: report.reason.clone(),
        efficiency: solution.and_then(|s| s.efficiency),
        band: None,
        input_power_w: solution.map_or(0.0, |s| s.input_power_w),
        loss_w: solution.map_or(0.0, |s| s.loss_w),
        losses_w: solution.map_or(Losses::default(), |s| s.losses_w),
        sources: solution.map(|s| s.sources.clone()).unwrap_or_default(),
        friction: NameMap(
            solution.map(|s| s.contacts.iter().map(|(n, c)| (n.clone(), c.friction)).collect()).unwrap_or_default(),
        ),
        convergence: solution.and_then(|s| s.convergence),
        warnings: warnings(train, report.oil_k(train, operation), notes),
        why: report.why,
        outside_laws: report.outside_laws,
    })
}

/// Warnings of a point, and those of its oil, whose operation stands beside them.
pub(super) fn warnings(train: &Train, oil_k: Option<f64>, notes: Diagnostics) -> Vec<String> {
    let oil = train.lubrication.iter().filter_map(|l| l.beyond(oil_k?)).map(|b| b.to_string());
    oil.chain(notes.into_iter().filter(|d| d.severity == Severity::Warning).map(|d| d.message)).collect()
}

fn spread(points: &[LossPoint], family: &str, compatibility: impl Fn(&str) -> bool) -> Option<Spread> {
    // Laws that reproduce errors are shown, and not counted.
    let counts = |p: &&LossPoint| p.verdict == Verdict::Unique && p.law.as_ref().is_some_and(|l| !compatibility(l));
    let all: Vec<&LossPoint> = points.iter().filter(counts).collect();
    let inside = |p: &&LossPoint| {
        let own = |o: &OutsideLaw| o.family == family && Some(&o.law) == p.law.as_ref();
        !p.outside_laws.iter().any(own)
    };
    let within: Vec<&LossPoint> = all.iter().copied().filter(inside).collect();
    let counted = if within.len() > 1 { &within } else { &all };
    let by_loss = |a: &&&LossPoint, b: &&&LossPoint| a.loss_w.total_cmp(&b.loss_w);
    let least = counted.iter().min_by(by_loss)?;
    let most = counted.iter().max_by(by_loss)?;
    Some(Spread {
        least_w: (least.loss_w, least.law.clone()?),
        most_w: (most.loss_w, most.law.clone()?),
        inside: within.len(),
        laws: all.len(),
    })
}
