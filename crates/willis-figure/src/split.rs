//! A power split over its ratio: efficiency, share of the variator, powers of its machines.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::analysis::{Role, SolutionReport, operate};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::kinematics::Configuration;
use willis::model::Model;
use willis::study::{Axis, Hold, PointSetup, Sweep};
use willis::train::{Load, MemberId, Operation, Train};
use willis::work::Effort;

use crate::kind::{Ask, FigureRequest, Kind};
use crate::parts::axes::{self, ChartAxis};
use crate::parts::style::digits;

pub(crate) const KIND: Kind<Split> = Kind {
    title: "Power split",
    takes: &[Ask::State, Ask::Operation, Ask::Over],
    effort: |model, request| {
        let points = if request.over.is_empty() { POINTS } else { axes::points(&request.over, model) };
        Effort::of_points(model.train(), (points * model.train().states().len().max(1)) as u64)
    },
    applies: None,
    make: split,
    steps: None,
    draw: draw::draw_on,
};

/// Ratios where the caller does not say.
const POINTS: usize = 161;

/// A power split over its ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Split {
    /// The train.
    pub title: String,
    /// The operating point, and what it prescribes.
    pub basis: String,
    /// Speed of the input over that of the output.
    pub x: ChartAxis,
    /// The states in which a variator has its ratio free.
    pub modes: Vec<SplitMode>,
    /// States in which the gears fix the ratio.
    pub gears: Vec<SplitGear>,
    /// The mode with the best efficiency at each ratio, by its place in `modes`; absent where none has an answer.
    pub best: Vec<Option<usize>>,
}

/// A state over the ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SplitMode {
    /// The state of the shift table; absent for the train as drawn.
    pub state: Option<String>,
    /// One for each value of the axis.
    pub points: Vec<SplitPoint>,
    /// Ratios at which a side of a variator stands still.
    pub mechanical: Vec<MechanicalPoint>,
}

/// A mode at one ratio.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SplitPoint {
    /// The efficiency of every equilibrium, the best first; 0 where everything is dissipated.
    pub efficiencies: Vec<f64>,
    /// Power through all variators over the input power, signed, in the best of them.
    pub share: Option<f64>,
    /// Power that each machine, or side, delivers to its member, W, in the best of them.
    pub powers_w: Vec<(String, f64)>,
    /// Whether a limit of a variator is exceeded.
    pub beyond_limits: bool,
}

/// A ratio at which a side of a variator stands still, so that no power passes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MechanicalPoint {
    /// The machine, or the member.
    pub side: String,
    /// Speed of the input over that of the output.
    pub ratio: f64,
    /// The same exactly.
    pub exact: Rational,
}

/// A state in which the gears fix the ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SplitGear {
    /// The state.
    pub state: String,
    /// Speed of the input over that of the output.
    pub ratio: f64,
    /// Output over input power.
    pub efficiency: f64,
}

fn refuse(text: impl Into<String>, hint: &str) -> Diagnostics {
    Diagnostic::new(Code::Unfit, "", text).hint(hint).into()
}

/// A power split over its ratio: at the operation that is named, else the file's first; in every state in which a variator
/// acts, or in one.
///
/// # Errors
/// A train without a variator, or without an operation that says how its input turns and is loaded; an axis that is not
/// the ratio.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis_figure::{FigureRequest, split};
///
/// let model = Model::from_toml(r#"
///     format = 1
///     name = "Prius set"
///     members = ["mg1", "engine", "ring"]
///     terminals = ["engine", "ring"]
///     variator = [{ name = "electric path", members = ["mg1", "ring"], efficiency = 0.85 }]
///     [[set]]
///     name = "P1"
///     sun = { member = "mg1", teeth = 30 }
///     ring = { member = "ring", teeth = 78 }
///     carrier = "engine"
///     mesh_efficiency = 0.985
///     [[operation]]
///     name = "cruise"
///     speeds = { engine = "2000 rpm", ring = "1500 rpm" }
///     torques = { engine = "100 N m" }
/// "#).unwrap();
/// let split = split(&model, &FigureRequest::default())?;
/// // With mg1 at rest the ring turns 18/13 as fast as the engine.
/// assert_eq!(split.modes[0].mechanical[0].exact.to_string(), "13/18");
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn split(model: &Model, r: &FigureRequest) -> Result<Split, Diagnostics> {
    let train = model.train();
    if train.variators().is_empty() {
        let hint = "describe the second path as a [[variator]]: two members and an efficiency, or machines on a bus";
        return Err(refuse("no power split: the train has no variator", hint));
    }
    let base = PointSetup::new(model, r.operation.as_deref(), r.state.as_deref(), Hold::AsGiven)?.base().clone();
    if base.loads.is_empty() || base.speeds.is_empty() {
        let hint = "add an [[operation]] with the speed and the torque or power of the input";
        return Err(refuse("no power split: there is no operating point to start from", hint));
    }
    let states: Vec<Option<String>> = match (&r.state, train.states()) {
        (Some(state), _) => vec![Some(state.clone())],
        (None, []) => vec![None],
        (None, all) => all.iter().map(|s| Some(s.name.clone())).collect(),
    };
    // What a machine drives alone is no split.
    let within: Vec<MemberId> = train.variators().iter().flat_map(|v| v.members()).collect();
    let split = |state: &Option<String>| ends(train, state).is_some_and(|[input, _]| !within.contains(&input));
    let states: Vec<Option<String>> = states.into_iter().filter(split).collect();
    let (free, fixed): (Vec<_>, Vec<_>) = states.into_iter().partition(|state| freedoms(train, &base, state) > 1);
    if free.is_empty() {
        return Err(refuse("no power split: the gears fix the ratio in every state asked for", "name another `state`"));
    }
    let mechanical: Vec<Vec<MechanicalPoint>> = free.iter().map(|s| mechanical_points(train, &base, s)).collect();
    let over = match &r.over[..] {
        [] => usual(&mechanical, own_ratio(train, &base)),
        [one] if one.trim_start().starts_with("ratio") => one.clone(),
        _ => {
            let message = "a power split is drawn over the ratio alone";
            return Err(Diagnostic::new(Code::BadAxis, "", message).hint("write it as `ratio=0.5..3:100`").into());
        }
    };
    let [x] = <[Axis; 1]>::try_from(axes::parse(&[over], model)?).expect("one is parsed");
    let mut modes = Vec::new();
    for (state, mechanical) in free.into_iter().zip(mechanical) {
        let question = PointSetup::new(model, r.operation.as_deref(), state.as_deref(), Hold::AsGiven)?;
        let sweep = Sweep::new(question, vec![x.clone()], &[])?;
        let mut trains = Default::default();
        let one = |k: u64| match sweep.ask(k, &mut trains) {
            Ok((train, operation)) => point(&train, &operation),
            Err(_) => SplitPoint::default(),
        };
        modes.push(SplitMode { state, points: (0..sweep.len()).map(one).collect(), mechanical });
    }
    let efficiency = |mode: &SplitMode, k: usize| mode.points[k].efficiencies.first().copied().filter(|e| *e > 0.0);
    let best = (0..x.len())
        .map(|k| {
            let answered = (0..modes.len()).filter_map(|m| Some((m, efficiency(&modes[m], k)?)));
            answered.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))).map(|(m, _)| m)
        })
        .collect();
    let gears = fixed.iter().flatten().filter_map(|state| gear(model, r, state)).collect();
    let given = base.loads.iter().map(|(m, load)| {
        let name = train.member_name(*m);
        match load {
            Load::Torque(q) => format!("{name} {} N m", digits(q.si())),
            Load::Power(q) => format!("{name} {} kW", digits(q.si() / 1e3)),
        }
    });
    let basis = format!("{}: {}", base.name, given.collect::<Vec<_>>().join(", "));
    Ok(Split { title: train.name().to_owned(), basis, x: ChartAxis::of(&x), modes, gears, best })
}

fn engaged<'t>(train: &'t Train, base: &Operation, state: &Option<String>) -> Configuration<'t> {
    let engaged = state.as_deref().and_then(|name| train.state(name)).map_or(&[][..], |s| &s.engaged);
    Configuration::new(train, engaged, &base.fixed, train.terminals())
}

fn freedoms(train: &Train, base: &Operation, state: &Option<String>) -> usize {
    engaged(train, base, state).degrees_of_freedom()
}

/// Input and output in a state.
fn ends(train: &Train, state: &Option<String>) -> Option<[MemberId; 2]> {
    let state = state.as_deref().and_then(|name| train.find_state(name).ok());
    let [input, output] = train.ends(state);
    Some([input?, output?])
}

/// Ratios at which a side of a variator stands still while input and output turn.
fn mechanical_points(train: &Train, base: &Operation, state: &Option<String>) -> Vec<MechanicalPoint> {
    let Some(ends) = ends(train, state) else { return vec![] };
    let transfer = engaged(train, base, state).transfer(&ends);
    let mut all: Vec<MechanicalPoint> = Vec::new();
    for v in train.variators() {
        let members = v.members();
        for (k, member) in members.into_iter().enumerate() {
            // w = a w_in + b w_out vanishes at w_in/w_out = −b/a.
            let Some([a, b]) = transfer.speeds[member.index()].as_deref() else { continue };
            if a.is_zero() || b.is_zero() {
                continue;
            }
            let exact = -(b / a);
            let side = v.machines().get(k).map_or(train.member_name(member), |m| &m.name).to_owned();
            all.push(MechanicalPoint { side, ratio: exact.to_f64(), exact });
        }
    }
    all.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    all
}

/// Speed of the input over that of the output in the operation.
fn own_ratio(train: &Train, base: &Operation) -> Option<f64> {
    let state = base.state.map(|k| train.states()[k].name.clone());
    let [input, output] = ends(train, &state)?;
    let motion = engaged(train, base, &state).motion(&base.speeds).ok()?;
    Some(motion.si(input)? / motion.si(output)?).filter(|r| r.is_finite() && *r != 0.0)
}

/// An axis around the mechanical points on the side of zero on which the operation runs.
fn usual(mechanical: &[Vec<MechanicalPoint>], own: Option<f64>) -> String {
    let side = own.map_or(1.0, f64::signum);
    let points = mechanical.iter().flatten().map(|m| side * m.ratio).filter(|r| *r > 0.0);
    let (low, high) = points.fold((f64::INFINITY, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
    let (low, high) = match own {
        _ if high > 0.0 => (0.5 * low, 2.5 * high),
        Some(own) => (0.4 * own.abs(), 2.5 * own.abs()),
        None => (0.3, 3.0),
    };
    let [from, to] = if side < 0.0 { [-high, -low] } else { [low, high] };
    format!("ratio={from:.3}..{to:.3}:{POINTS}")
}

fn point(train: &Train, operation: &Operation) -> SplitPoint {
    let Ok((report, _)) = operate(train, operation) else { return SplitPoint::default() };
    let efficiency = |s: &SolutionReport| if s.all_dissipated { Some(0.0) } else { s.efficiency };
    let drives = |s: &SolutionReport| s.members.iter().any(|(_, m)| m.role == Role::Output);
    let mut all: Vec<(f64, &SolutionReport)> = (report.solutions.iter())
        .filter(|s| drives(s) || s.all_dissipated)
        .filter_map(|s| Some((efficiency(s)?, s)))
        .collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let Some((_, best)) = all.first() else { return SplitPoint::default() };
    let sides = best.variators.iter().flat_map(|(_, v)| v.machines.iter().map(|(n, m)| (n.clone(), m.power_w)));
    SplitPoint {
        efficiencies: all.iter().map(|a| a.0).collect(),
        share: Some(best.variators.iter().map(|(_, v)| v.share).sum()),
        powers_w: sides.collect(),
        beyond_limits: !best.beyond_limits.is_empty(),
    }
}

/// A state in which the gears fix the ratio, at the speed of the input.
fn gear(model: &Model, r: &FigureRequest, state: &str) -> Option<SplitGear> {
    let train = model.train();
    let question = PointSetup::new(model, r.operation.as_deref(), Some(state), Hold::AsGiven).ok()?;
    let mut operation = question.base().clone();
    let [input, output] = ends(train, &Some(state.to_owned()))?;
    operation.speeds.retain(|(m, _)| *m == input);
    let (report, _) = operate(train, &operation).ok()?;
    let [s] = &report.solutions[..] else { return None };
    let speed = |m: MemberId| s.members.get(train.member_name(m))?.speed_rad_s;
    let ratio = speed(input)? / speed(output)?;
    Some(SplitGear { state: state.to_owned(), ratio, efficiency: s.efficiency? }).filter(|g| g.ratio.is_finite())
}
