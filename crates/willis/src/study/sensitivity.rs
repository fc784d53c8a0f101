//! Which input moves efficiency and each loss most, by exact derivatives.
//!
//! Every continuous quantity of the train file and of an operation is moved in turn, as a dual number, through
//! everything that follows from it: the geometry of the teeth, orbits and masses of planets, the state of the oil, the
//! laws, and the agreement of losses and torques. No difference is taken.
//!
//! With `ρ` the efficiencies in force, torques obey `B(ρ) f = t + d`: loads `t`, drags `d`. Which end of each mesh
//! drives is known at the point and does not change with an infinitesimal step, so the equations stay linear:
//! `B f′ = t′ + d′ − B′ f`. Laws and these equations are repeated until the derivatives agree, as the operating point
//! itself was.

mod balance;
mod heat;
mod lanes;
mod seeded;

use serde::{Deserialize, Serialize};

use crate::analysis::{self, HeatBasis, Margin, Point, Selection, Verdict};
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::losses::mesh_friction::MeshFriction;
use crate::operating_point::LossKind;
use crate::train::{FRAME, Input, Load, MemberKind, Operation, Slot, Train};

use balance::{Powers, powers};
use heat::Following;
use lanes::{Asked, LANES, Moved};

/// A loss is said to move with a quantity when it does so by this part of the largest change.
const WORTH_TELLING: f64 = 1e-3;
/// Derivatives of the loss below this part of it for a step are none.
const NO_EFFECT: f64 = 1e-13;
/// A balance of derivatives that closes no better than this part is none.
const NOT_CLOSED: f64 = 1e-6;

/// What every input does to efficiency and losses: the results contract `willis-sensitivity-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Sensitivity {
    /// `willis-sensitivity-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// Every operation asked for.
    pub operations: Vec<OperationSensitivity>,
    /// What the model leaves out, and what stands in for data that were not given.
    #[serde(default)]
    pub assumptions: Vec<String>,
    /// Warnings and notes of the operations.
    pub diagnostics: Vec<Diagnostic>,
}

impl Contract for Sensitivity {
    const FORMAT: &'static str = "willis-sensitivity-1";
}

/// What every input does at one operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OperationSensitivity {
    /// Name of the operation.
    pub name: String,
    /// The state of the shift table, if not as drawn.
    pub state: Option<String>,
    /// What can be said of the operation. There are derivatives only where it is `unique`.
    pub verdict: Verdict,
    /// Why there are no derivatives.
    pub reason: Option<String>,
    /// Output over input power; absent where nothing comes in.
    pub efficiency: Option<f64>,
    /// The same exactly, where it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_exact: Option<Rational>,
    /// Power in at all inputs, W.
    pub input_power_w: f64,
    /// Oil temperature, K, where the train says what carries heat away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub oil_k: Option<f64>,
    /// All losses, W.
    pub loss_w: f64,
    /// Every quantity that moves a loss, the one with the largest effect first.
    pub quantities: Vec<QuantitySensitivity>,
    /// Quantities on which no loss depends here.
    pub without_effect: Vec<String>,
    /// Quantities without a derivative here, each with the reason.
    pub without_derivative: Vec<(String, String)>,
    /// How far the point is from another driving end, and from locking.
    pub margin: Option<Margin>,
    /// How far the derivatives are settled.
    pub checks: Option<Checks>,
    /// What must be known to read the numbers.
    pub notes: Vec<String>,
}

/// How far derivatives are settled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Checks {
    /// Largest derivative of input less output less losses, over the largest of the three: round-off.
    pub balance_residual: f64,
    /// Most rounds of laws and statics that one quantity took.
    pub rounds: usize,
    /// Bound on the error that was left, over the largest derivative of a loss: the worst of all quantities.
    pub error: f64,
}

/// The step of a quantity for which changes are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum StepKind {
    /// One percent of it.
    Percent,
    /// One percent less: efficiencies of which one percent more would pass 1.
    PercentLess,
    /// One kelvin.
    Kelvin,
    /// One degree.
    Degree,
    /// One hundredth: profile shifts, which may be zero, and plain numbers that are.
    Hundredth,
    /// One revolution per minute: speeds that are zero.
    Rpm,
    /// A tenth of a millimetre: lengths that are zero, and centre distances and tip diameters, which other data fix.
    TenthMillimetre,
    /// One SI unit: torques, powers, forces that are zero.
    Unit,
}

impl StepKind {
    /// For people: `+1 %`, `+1 K`.
    pub fn label(self) -> &'static str {
        match self {
            Self::Percent => "+1 %",
            Self::PercentLess => "−1 %",
            Self::Kelvin => "+1 K",
            Self::Degree => "+1°",
            Self::Hundredth => "+0.01",
            Self::Rpm => "+1 rpm",
            Self::TenthMillimetre => "+0.1 mm",
            Self::Unit => "+1",
        }
    }

    /// How large it is, in words.
    pub fn size(self) -> &'static str {
        match self {
            Self::Percent => "1 %",
            Self::PercentLess => "−1 %",
            Self::Kelvin => "1 K",
            Self::Degree => "1°",
            Self::Hundredth => "0.01",
            Self::Rpm => "1 rpm",
            Self::TenthMillimetre => "0.1 mm",
            Self::Unit => "1",
        }
    }
}

/// What one quantity does. Changes for a step are the derivative times the step: exact for small ones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuantitySensitivity {
    /// Its path, as the file has it: `P1.geometry.module`, `B1.radial_load`; of the operation what an
    /// [axis](crate::study::Axis) calls it: `oil.temperature`, `sun.speed`, `sun.torque`.
    pub name: String,
    /// Its value, SI.
    pub value: f64,
    /// SI unit of the value.
    pub unit: String,
    /// Whether it is not given but taken.
    pub assumed: bool,
    /// Quantities of the same teeth that move with it, because alone it would contradict them: in proportion, profile shifts by
    /// as much.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub together: Vec<String>,
    /// Profile shifts that move by as much the other way, because the centre distance is given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub opposite: Vec<String>,
    /// The step for which changes are told.
    pub step: StepKind,
    /// That step, SI; negative where it is one to less.
    pub step_size: f64,
    /// `dη/dq`, over the SI unit of the value.
    pub efficiency_derivative: Option<f64>,
    /// `dP_loss/dq`, W over the SI unit of the value.
    pub loss_derivative_w: f64,
    /// Change of the efficiency for the step.
    pub efficiency_change: Option<f64>,
    /// Change of all losses for the step, W.
    pub loss_change_w: f64,
    /// `dT_oil/dq`, K over the SI unit of the value, where the oil temperature follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub oil_derivative: Option<f64>,
    /// Change of the oil temperature for the step, K.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub oil_change_k: Option<f64>,
    /// `(dP_loss/P_loss)/(dq/q)`: percent of loss for one percent of the quantity; absent for temperatures, angles and
    /// shifts.
    pub loss_elasticity: Option<f64>,
    /// The losses that it moves, the one that changes most first.
    pub sources: Vec<SourceChange>,
}

/// What a quantity does to one loss.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SourceChange {
    /// What loses it.
    pub name: String,
    /// What kind of loss it is.
    pub kind: LossKind,
    /// Its law.
    pub law: String,
    /// Change for the step, W.
    pub change_w: f64,
}

/// A quantity to move.
struct Quantity {
    name: String,
    value: f64,
    unit: &'static str,
    assumed: bool,
    /// What moves with it, and at which rate.
    slots: Vec<(Slot, f64)>,
    /// Other quantities of the file that these are, in proportion; profile shifts by as much, and the other way.
    together: Vec<String>,
    opposite: Vec<String>,
    /// Whether it can move at all.
    fits: bool,
    moved: Moved,
}

impl Quantity {
    fn asked(&self) -> Asked<'_> {
        Asked { slots: &self.slots, moved: self.moved }
    }

    /// Whether it cannot pass 1.
    fn is_efficiency(&self) -> bool {
        let cannot = |s: &Slot| matches!(s, Slot::Efficiency(..) | Slot::Variator(..) | Slot::Machine(..));
        self.slots.iter().any(|(s, _)| cannot(s))
    }

    fn step(&self) -> (StepKind, f64) {
        let shift = self.slots.iter().any(|(s, _)| matches!(s, Slot::Shift(..)));
        // Lengths that others of the same teeth fix: a percent of them is no gear any more.
        let fits = |(s, _): &(Slot, f64)| matches!(s, Slot::CentreDistance(_) | Slot::TipDiameter(..));
        let fitted = self.together.is_empty() && self.slots.iter().any(fits);
        match self.unit {
            "K" => (StepKind::Kelvin, 1.0),
            "rad" => (StepKind::Degree, 1f64.to_radians()),
            _ if shift => (StepKind::Hundredth, 0.01),
            "rad/s" if self.value == 0.0 => (StepKind::Rpm, std::f64::consts::PI / 30.0),
            "m" if self.value == 0.0 || fitted => (StepKind::TenthMillimetre, 1e-4),
            "-" if self.value == 0.0 => (StepKind::Hundredth, 0.01),
            _ if self.value == 0.0 => (StepKind::Unit, 1.0),
            _ if self.is_efficiency() && 1.01 * self.value > 1.0 => (StepKind::PercentLess, -0.01 * self.value),
            _ => (StepKind::Percent, 0.01 * self.value),
        }
    }
}

/// Derivatives of efficiency and losses by every continuous quantity of the file, at the operations that are selected.
///
/// For a step `Δq` the changes are `Δη = dη/dq · Δq` and `ΔP = dP/dq · Δq`, in W; the elasticity is
/// `dP/dq · q/P`. Integer inputs (teeth, planets, bearings side by side) have no derivative.
///
/// # Errors
/// Unknown operation or state, a train without operations, or an operation that makes no question, as
/// [`analyze`](crate::analyze) says it. A train that locks is no error: [`OperationSensitivity::reason`] says so.
///
/// # Example
/// One set with the ring held has `η = (1 + z_r/z_s η_0)/(1 + z_r/z_s)`, and the basic efficiency is that of two equal
/// meshes, `η_0 = η_m²`: `dη/dη_m = 2 η_m (70/30)/(1 + 70/30) = 1.386`.
/// ```
/// use willis::study::sensitivity;
/// use willis::{Selection, Train};
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "sun drives, ring held"
///     members = ["sun", "carrier"]
///     terminals = ["sun", "carrier"]
///
///     [[set]]
///     name = "P1"
///     sun = { member = "sun", teeth = 30 }
///     planet = { teeth = 20, count = 4 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "carrier"
///     mesh_efficiency = 0.99
///
///     [[operation]]
///     name = "rated"
///     speeds = { sun = "1000 rpm" }
///     torques = { sun = "100 N m" }
/// "#)?;
/// let all = sensitivity(&train, &Selection::default())?;
/// let by_mesh = &all.operations[0].quantities[0];
/// assert_eq!(by_mesh.name, "P1.mesh_efficiency");
/// assert!((by_mesh.efficiency_derivative.unwrap() - 2.0 * 0.99 * 0.7).abs() < 1e-12);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn sensitivity(train: &Train, selection: &Selection) -> Result<Sensitivity, Diagnostics> {
    selection.check(train)?;
    let mut wrong = Diagnostics::default();
    let chosen: Vec<&Operation> = train.operations.iter().filter(|o| selection.wants(train, o)).collect();
    if chosen.is_empty() {
        let text = match &selection.state {
            Some(state) => format!("sensitivities belong to an operating point, and none runs in state `{state}`"),
            None => "sensitivities belong to an operating point, and there is none".to_owned(),
        };
        let d = Diagnostic::new(Code::UnknownSelection, "", text);
        wrong.push(d.hint("add an [[operation]] with speeds and torques or powers"));
        return Err(wrong);
    }
    let mut notes = Diagnostics::default();
    let mut operations = Vec::new();
    for operation in chosen {
        match of_operation(train, operation, &mut notes) {
            Ok(found) => operations.push(found),
            Err(more) => wrong.extend(more),
        }
    }
    if wrong.has_errors() {
        return Err(wrong);
    }
    Ok(Sensitivity {
        format: Format::new(),
        train: train.name.clone(),
        operations,
        assumptions: analysis::assumptions(train),
        diagnostics: notes.into_iter().collect(),
    })
}

/// Loss of an operating point, W, with its derivative by each quantity, and the speeds of all members, rad/s; `None` where
/// there is no one equilibrium, or a derivative is not settled.
pub(super) fn loss_by(
    train: &Train,
    operation: &Operation,
    quantities: &[Slot],
) -> Result<Option<(f64, Vec<f64>)>, Diagnostics> {
    let (report, point, _) = analysis::settle(train, operation)?;
    let (Some(point), [solution]) = (&point, &report.solutions[..]) else { return Ok(None) };
    let hot = report.heat.as_ref().map(|h| Operation { temperature: Some(h.oil_k), ..operation.clone() });
    let operation = hot.as_ref().unwrap_or(operation);
    let following = report.heat.as_ref().and_then(|h| Following::new(train, operation, point, h));
    let mut slopes = Vec::with_capacity(quantities.len());
    let slots: Vec<[(Slot, f64); 1]> = quantities.iter().map(|slot| [(*slot, 1.0)]).collect();
    let asked: Vec<Asked<'_>> = slots.iter().map(|slots| Asked { slots, moved: Moved::Train }).collect();
    let found = asked.chunks(LANES).flat_map(|group| powers(train, operation, point, group));
    for (own, found) in asked.iter().zip(found) {
        let Some(mut found) = found else { return Ok(None) };
        if let Some(following) = &following {
            following.follow(own.slots, &mut found);
        }
        if !found.loss.eps.is_finite() || found.error > 1e-6 {
            return Ok(None);
        }
        slopes.push(found.loss.eps);
    }
    Ok(Some((solution.loss_w, slopes)))
}

fn of_operation(
    train: &Train,
    operation: &Operation,
    diagnostics: &mut Diagnostics,
) -> Result<OperationSensitivity, Diagnostics> {
    let (report, point, found) = analysis::settle(train, operation)?;
    diagnostics.extend(found);
    let mut all = OperationSensitivity {
        name: report.name,
        state: report.state,
        verdict: report.verdict,
        reason: None,
        efficiency: None,
        efficiency_exact: None,
        input_power_w: 0.0,
        oil_k: None,
        loss_w: 0.0,
        quantities: vec![],
        without_effect: vec![],
        without_derivative: vec![],
        margin: None,
        checks: None,
        notes: vec![],
    };
    let (Some(point), [solution]) = (&point, &report.solutions[..]) else {
        let why = report.reason.unwrap_or_else(|| "there is no one equilibrium here".into());
        all.reason = Some(format!("no derivatives: {why}"));
        return Ok(all);
    };
    all.efficiency = solution.efficiency;
    all.efficiency_exact.clone_from(&solution.efficiency_exact);
    all.input_power_w = solution.input_power_w;
    all.loss_w = solution.loss_w;
    all.margin = Some(solution.margin.clone());
    all.notes = notes(train, point);
    // The oil temperature that follows, or the one at its limit.
    let hot = report.heat.as_ref().map(|h| Operation { temperature: Some(h.oil_k), ..operation.clone() });
    let follows = report.heat.as_ref().is_some_and(|h| h.basis == HeatBasis::Balance);
    let operation = hot.as_ref().unwrap_or(operation);
    let following = report.heat.as_ref().and_then(|h| Following::new(train, operation, point, h));
    all.oil_k = report.heat.as_ref().map(|h| h.oil_k);
    if follows {
        all.notes.push(match &following {
            Some(_) => "the oil temperature follows: what a quantity does through it is counted".into(),
            None => "the oil temperature is not stable here, and is held".into(),
        });
    }

    let mut checks = Checks { balance_residual: 0.0, rounds: 0, error: 0.0 };
    // A temperature that follows is moved by the others.
    let held = |quantity: &Quantity| follows && quantity.slots.iter().any(|(s, _)| *s == Slot::Temperature);
    let wanted: Vec<(Quantity, Option<String>)> = (quantities(train, operation).into_iter())
        .filter(|quantity| !held(quantity))
        .map(|quantity| {
            let edge = edge(train, operation, point, &quantity);
            (quantity, edge)
        })
        .collect();
    let asked: Vec<Asked<'_>> =
        wanted.iter().filter(|(_, edge)| edge.is_none()).map(|(quantity, _)| quantity.asked()).collect();
    let mut all_found = asked.chunks(LANES).flat_map(|group| powers(train, operation, point, group));
    for (quantity, edge) in &wanted {
        let without = |why: &str| (quantity.name.clone(), why.to_owned());
        if let Some(why) = edge {
            all.without_derivative.push(without(why));
            continue;
        }
        let Some(mut found) = all_found.next().flatten() else {
            let why = "the geometry or the equilibrium stands on an edge of what is possible";
            all.without_derivative.push(without(why));
            continue;
        };
        let finite = found.is_finite();
        if !finite || found.error > 1e-6 {
            let why = match finite {
                true => format!("losses and torques did not agree: {:.1e} of the derivative is left", found.error),
                false => "a law has no slope here".to_owned(),
            };
            all.without_derivative.push(without(&why));
            continue;
        }
        let size = NO_EFFECT * found.input.re.abs().max(found.loss.re.abs());
        // Of a quantity that moves nothing there is only rounding.
        let residual = if (found.steepest() * quantity.step().1).abs() > size { found.residual() } else { 0.0 };
        if residual > NOT_CLOSED {
            // A mesh without load has no row in the equations of the point.
            let why = match solution.meshes.iter().any(|(_, mesh)| mesh.driver.is_none()) {
                true => "it loads what carries nothing here, and that loses whichever way it is loaded".to_owned(),
                false => format!("derivatives of input, output and losses differ by {residual:.1e} of the largest"),
            };
            all.without_derivative.push(without(&why));
            continue;
        }
        checks.balance_residual = checks.balance_residual.max(residual);
        checks.rounds = checks.rounds.max(found.rounds);
        checks.error = checks.error.max(found.error);
        let oil = following.as_ref().map(|f| f.follow(&quantity.slots, &mut found));
        match told(quantity, &found) {
            Ok(q) => all.quantities.push(QuantitySensitivity {
                oil_derivative: oil,
                oil_change_k: oil.map(|t| t * q.step_size),
                ..q
            }),
            Err(name) => all.without_effect.push(name),
        }
    }
    all.quantities.sort_by(|a, b| b.loss_change_w.abs().total_cmp(&a.loss_change_w.abs()));
    all.checks = Some(checks);
    Ok(all)
}

/// Why a quantity has no derivative, as far as the point tells.
fn edge(train: &Train, operation: &Operation, point: &Point<'_>, quantity: &Quantity) -> Option<String> {
    if let Some(mesh) = starts_to_move(train, operation, point, quantity.moved) {
        return Some(format!("{mesh} is loaded and at rest, and loses when it moves, whichever way"));
    }
    let why = "the centre distances are given, and no other shifts in this ring of gears keep them all";
    (!quantity.fits).then(|| why.to_owned())
}

/// A loaded mesh at rest that a prescribed speed sets in motion: there the loss has a kink.
fn starts_to_move(train: &Train, operation: &Operation, point: &Point<'_>, moved: Moved) -> Option<String> {
    let Moved::Speed(k) = moved else { return None };
    let prescribed: Vec<_> = operation.speeds.iter().map(|(m, _)| *m).collect();
    let speeds = point.c.transfer(&prescribed).speeds;
    point.columns.iter().filter(|c| c.p_drives.is_none() && point.forces[c.element] != 0.0).find_map(|c| {
        let element = &point.c.elements[c.element];
        let (p, carrier) = (speeds[element.p.index()].as_ref()?, speeds[element.carrier.index()].as_ref()?);
        let name = match point.c.couplings.get(c.element.wrapping_sub(point.c.gears().len())) {
            Some(coupling) => &train.variators[coupling.variator].name,
            None => &train.meshes[element.links.first()?.mesh.index()].name,
        };
        (p[k] != carrier[k]).then(|| name.clone())
    })
}

/// What a quantity does, in the form in which it is told; its name where it does nothing.
fn told(quantity: &Quantity, found: &Powers) -> Result<QuantitySensitivity, String> {
    let (step, step_size) = quantity.step();
    let size = NO_EFFECT * found.input.re.abs().max(found.loss.re.abs());
    let moves = |x: f64| (x * step_size).abs() > size;
    let efficiency = (found.input.re > 0.0).then(|| found.efficiency().eps);
    let none = !moves(found.loss.eps)
        && !found.sources.iter().any(|s| moves(s.3.eps))
        && efficiency.is_none_or(|e| (e * step_size).abs() <= NO_EFFECT);
    if none {
        return Err(quantity.name.clone());
    }
    let most = found.sources.iter().fold(0.0f64, |a, s| a.max(s.3.eps.abs()));
    let mut sources: Vec<SourceChange> = (found.sources.iter())
        .filter(|s| s.3.eps.abs() > WORTH_TELLING * most)
        .map(|(name, kind, law, loss)| SourceChange {
            name: name.clone(),
            kind: *kind,
            law: (*law).to_owned(),
            change_w: loss.eps * step_size,
        })
        .collect();
    sources.sort_by(|a, b| b.change_w.abs().total_cmp(&a.change_w.abs()));
    let loss = found.loss;
    Ok(QuantitySensitivity {
        name: quantity.name.clone(),
        value: quantity.value,
        unit: quantity.unit.to_owned(),
        assumed: quantity.assumed,
        together: quantity.together.clone(),
        opposite: quantity.opposite.clone(),
        step,
        step_size,
        efficiency_derivative: efficiency,
        loss_derivative_w: loss.eps,
        efficiency_change: efficiency.map(|e| e * step_size),
        loss_change_w: loss.eps * step_size,
        oil_derivative: None,
        oil_change_k: None,
        loss_elasticity: (matches!(step, StepKind::Percent | StepKind::PercentLess) && loss.re > 0.0)
            .then(|| loss.eps * quantity.value / loss.re),
        sources,
    })
}

/// What must move with a module so that teeth stay similar and fit: their lengths that are given, and the modules, with
/// their lengths, of other teeth on the same planets.
fn together<'t>(train: &'t Train, input: &Input) -> Vec<&'t Input> {
    let modules = |i: &Input| -> Vec<usize> {
        let own = |s: &Slot| match s {
            Slot::Module(j) => Some(*j),
            _ => None,
        };
        i.slots.iter().filter_map(own).collect()
    };
    let mut meshes = modules(input);
    if meshes.is_empty() {
        return vec![];
    }
    let planets = |j: usize| {
        let own = train.meshes[j].gears.iter().map(|g| g.member);
        own.filter(|m| train.members[m.index()].kind == MemberKind::Planet).collect::<Vec<_>>()
    };
    // Meshes of one input at a time, until no other shares a planet with them.
    loop {
        let near = |i: &&Input| {
            let own = modules(i);
            let shares = |j: &usize| meshes.iter().any(|k| planets(*k).iter().any(|p| planets(*j).contains(p)));
            own.iter().any(|j| !meshes.contains(j)) && own.iter().any(shares)
        };
        let Some(more) = train.inputs.iter().find(near) else { break };
        meshes.extend(modules(more));
    }
    let moves = |s: &Slot| match s {
        Slot::Module(j) | Slot::CentreDistance(j) | Slot::TipDiameter(j, _) | Slot::TipAlteration(j, _) => {
            meshes.contains(j)
        }
        _ => false,
    };
    train.inputs.iter().filter(|i| i.path != input.path && i.slots.iter().any(moves)).collect()
}

/// What must move with a profile shift so that centre distances that are given hold, each with its rate: the shift of the other gear
/// the other way, of a ring and its planet the same way, from gear to gear. Of bevel gears too, whose shifts are opposite. `None`
/// where that comes back to a gear with another rate.
fn shifts_together<'t>(train: &'t Train, input: &'t Input) -> Option<Vec<(&'t Input, f64)>> {
    let mut all = vec![(input, 1.0)];
    let mut next = 0;
    while let Some(&(own, rate)) = all.get(next) {
        next += 1;
        for slot in &own.slots {
            let Slot::Shift(j, k) = *slot else { continue };
            let Some(teeth) = &train.meshes[j].teeth else { continue };
            if teeth.pair.data.centre_distance.is_none() && teeth.cones.is_none() {
                continue;
            }
            let wanted = if teeth.pair.internal() { rate } else { -rate };
            let Some(other) = train.inputs.iter().find(|i| i.slots.contains(&Slot::Shift(j, 1 - k))) else { continue };
            match all.iter().find(|(i, _)| i.path == other.path) {
                Some((_, rate)) if *rate == wanted => {}
                Some(_) => return None,
                None => all.push((other, wanted)),
            }
        }
    }
    all.remove(0);
    Some(all)
}

/// Every continuous quantity of train and operation.
fn quantities(train: &Train, operation: &Operation) -> Vec<Quantity> {
    let mut all = Vec::new();
    let friction = train.laws.mesh_friction(train.lubrication.is_some());
    let constant = matches!(friction, MeshFriction::Constant(_));
    for input in &train.inputs {
        // The coefficient that stands in is read by one law only.
        if input.assumed && !constant && input.slots == [Slot::FrictionCoefficient] {
            continue;
        }
        let heat = input.slots.contains(&Slot::Temperature);
        let (name, value, assumed) = match operation.temperature.filter(|_| heat) {
            Some(own) => ("oil.temperature".to_owned(), own, false),
            None => (input.path.clone(), input.value, input.assumed),
        };
        let with = together(train, input);
        let along = with.iter().flat_map(|o| o.slots.iter().map(|s| (*s, o.value / input.value)));
        let shifts = shifts_together(train, input);
        let fits = shifts.is_some();
        let shifts = shifts.unwrap_or_default();
        let along = along.chain(shifts.iter().flat_map(|(o, rate)| o.slots.iter().map(|s| (*s, *rate))));
        let slots = input.slots.iter().map(|s| (*s, 1.0)).chain(along).collect();
        let turned = |way: f64| shifts.iter().filter(move |s| s.1 == way).map(|s| s.0.path.clone());
        let together = with.iter().map(|o| o.path.clone()).chain(turned(1.0)).collect();
        let opposite = turned(-1.0).collect();
        let moved = Moved::Train;
        all.push(Quantity { name, value, unit: input.unit, assumed, slots, together, opposite, fits, moved });
    }
    let moving = |name: String, value: f64, unit: &'static str, moved: Moved| Quantity {
        name,
        value,
        unit,
        assumed: false,
        slots: vec![],
        together: vec![],
        opposite: vec![],
        fits: true,
        moved,
    };
    for (k, (member, speed)) in operation.speeds.iter().enumerate() {
        let name = format!("{}.speed", train.member_name(*member));
        all.push(moving(name, speed.si(), "rad/s", Moved::Speed(k)));
    }
    for (k, (member, load)) in operation.loads.iter().enumerate() {
        let member = train.member_name(*member);
        all.push(match load {
            Load::Torque(q) => moving(format!("{member}.torque"), q.si(), "N m", Moved::Load(k)),
            Load::Power(q) => moving(format!("{member}.power"), q.si(), "W", Moved::Load(k)),
        });
    }
    all
}

/// What must be known to read the numbers.
fn notes(train: &Train, point: &Point<'_>) -> Vec<String> {
    let mut all = Vec::new();
    let names = |wanted: &dyn Fn(usize, Option<bool>) -> bool| {
        let meshes =
            point.columns.iter().filter(|c| wanted(c.element, c.p_drives)).flat_map(|c| {
                point.c.elements[c.element].links.iter().map(|l| train.meshes[l.mesh.index()].name.clone())
            });
        meshes.collect::<Vec<_>>().join(", ")
    };
    let idle = names(&|e, drives| drives.is_some() && point.forces[e] == 0.0);
    if !idle.is_empty() {
        all.push(format!("{idle}: idle, so either end may drive after a step; the derivatives hold on one side only"));
    }
    let stuck = names(&|e, drives| drives.is_none() && point.forces[e] != 0.0);
    if !stuck.is_empty() {
        all.push(format!("{stuck}: loaded and at rest relative to the carrier, taken without friction"));
    }
    let mut left_out = vec!["numbers of teeth"];
    if train.meshes.iter().any(|m| m.count > 1) {
        left_out.push("planets");
    }
    if !train.bearings.is_empty() {
        left_out.push("bearings");
    }
    let list = match left_out.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => left_out.concat(),
    };
    all.push(format!("whole numbers have no derivative: {list}; compare trains that differ by one"));
    if train.is_physical() {
        all.push("where a law changes its formula, the derivative is that of the formula in force".into());
    }
    let bearing = |b: &&crate::train::BearingMount| {
        let path = format!("{}.bore", b.name);
        b.members != [FRAME; 2] && train.inputs.iter().all(|i| i.path != path)
    };
    let catalogue: Vec<&str> = train.bearings.iter().filter(bearing).map(|b| b.bearing.designation.as_str()).collect();
    if !catalogue.is_empty() {
        let mut names = catalogue;
        names.dedup();
        all.push(format!("{}: sizes are those of the designation and are not moved", names.join(", ")));
    }
    if let Some(l) = &train.lubrication
        && train.inputs.iter().all(|i| !i.path.starts_with("oil.viscosity"))
    {
        all.push(format!("{}: viscosity is the catalogue's; its temperature moves it", l.oil.name));
    }
    let hypoid = train.meshes.iter().filter(|m| m.teeth.as_ref().is_some_and(|t| t.hypoid.is_some()));
    all.extend(hypoid.map(|m| format!("{}: its spiral angles are not moved", m.name)));
    for table in &train.loss_tables {
        let name = &train.meshes[table.mesh.index()].name;
        all.push(format!("{name}: the first row of its loss table is in force and is not moved"));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(found: &Powers) -> Vec<u64> {
        let sums = [found.input, found.output, found.loss];
        let all = sums.into_iter().chain(found.sources.iter().map(|s| s.3));
        all.flat_map(|x| [x.re.to_bits(), x.eps.to_bits()]).chain([found.rounds as u64]).collect()
    }

    /// Each alone, all side by side in two orders, and beside one that has no slope: the same bits, and the values of the analysis.
    #[test]
    fn quantities_side_by_side_do_not_mix() {
        let texts = [
            include_str!("sensitivity/examples/fva-planetary-stage.toml"),
            include_str!("sensitivity/examples/industrial-planetary-heat.toml"),
            include_str!("sensitivity/examples/two-speed-wet-brake.toml"),
        ];
        for text in texts {
            let train = Train::from_toml(text).unwrap();
            for operation in &train.operations {
                let (report, point, _) = analysis::settle(&train, operation).unwrap();
                let (Some(point), [solution]) = (&point, &report.solutions[..]) else { continue };
                let hot = report.heat.as_ref().map(|h| Operation { temperature: Some(h.oil_k), ..operation.clone() });
                let operation = hot.as_ref().unwrap_or(operation);
                let all = quantities(&train, operation);
                let asked: Vec<Asked<'_>> =
                    all.iter().filter(|q| edge(&train, operation, point, q).is_none()).map(Quantity::asked).collect();
                assert!(asked.len() > LANES, "{}", report.name);
                let found = |group: &[Asked<'_>]| -> Vec<Option<Powers>> {
                    group.chunks(LANES).flat_map(|g| powers(&train, operation, point, g)).collect()
                };
                let alone: Vec<Powers> =
                    asked.iter().map(|own| found(std::slice::from_ref(own)).remove(0).unwrap()).collect();
                for own in &alone {
                    let loss = own.loss.re;
                    assert!((loss - solution.loss_w).abs() <= 1e-9 * solution.loss_w, "{loss} {}", solution.loss_w);
                }
                let none = [(Slot::Temperature, f64::NAN)];
                let without = Asked { slots: &none, moved: Moved::Train };
                let spoiled: Vec<Asked<'_>> = std::iter::once(without).chain(asked.iter().copied()).collect();
                let back: Vec<Asked<'_>> = asked.iter().rev().copied().collect();
                for (own, beside) in [
                    (found(&asked), alone.iter().collect::<Vec<_>>()),
                    (found(&back), alone.iter().rev().collect()),
                    (found(&spoiled).split_off(1), alone.iter().collect()),
                ] {
                    for (own, alone) in own.iter().zip(beside) {
                        assert_eq!(bits(own.as_ref().unwrap()), bits(alone), "{}", report.name);
                    }
                }
            }
        }
    }
}
