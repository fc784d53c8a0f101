//! Efficiency over two quantities, with what has no answer, and the gear that loses least.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::analysis::{self, Selection};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::Model;
use willis::study::{Axis, Hold, PointAnswer, PointVerdict, Question, Sweep};
use willis::train::{Load, MemberId, Operation, Train};
use willis::work::Effort;

use crate::kind::{Ask, FigureRequest, Kind};
use crate::parts::axes::{self, ChartAxis};

pub(crate) const KIND: Kind<EfficiencyMap> = Kind {
    title: "Efficiency map",
    takes: &[Ask::State, Ask::Operation, Ask::Over],
    effort,
    make: |s, r| efficiency_map(s, r.state.as_deref(), r.operation.as_deref(), &r.over),
    draw: draw::draw_on,
};

/// Points along the axes where the caller does not say.
const COLUMNS: usize = 41;
const ROWS: usize = 31;
/// How many times finer where efficiencies are given and points are cheap.
const FINER: usize = 2;
/// Points of a map that are computed at most.
const MOST_POINTS: u64 = 100_000;

/// An efficiency map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EfficiencyMap {
    /// The train.
    pub title: String,
    /// The operating point, and what was chosen for it.
    pub basis: String,
    /// The quantity to the right.
    pub x: ChartAxis,
    /// The quantity upwards.
    pub y: ChartAxis,
    /// The points, row by row from the lowest `y` on, each row along `x`.
    pub points: Vec<MapPoint>,
    /// The states among which the best is chosen at every point; empty for a map of one state.
    pub states: Vec<String>,
    /// The operations of the file that lie in the map.
    pub marks: Vec<MapMark>,
}

/// A point of a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapPoint {
    /// One of [`PointVerdict`](willis::study::PointVerdict); `beyond` where no state stays within the limits of the input.
    pub verdict: MapVerdict,
    /// Output over input power.
    pub efficiency: Option<f64>,
    /// Power in, W.
    pub input_power_w: Option<f64>,
    /// All losses, W.
    pub loss_w: Option<f64>,
    /// The best state, as position among [`EfficiencyMap::states`].
    pub best: Option<usize>,
}

/// An operation of the file in a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapMark {
    /// Its name.
    pub operation: String,
    /// Where it is, in the units of the axes.
    pub at: [f64; 2],
}

/// What can be said of a place on a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum MapVerdict {
    /// Of the states of the train none reaches it.
    Beyond,
    /// The verdict on the operating point there.
    #[serde(untagged)]
    Point(PointVerdict),
}

impl MapPoint {
    fn of(answer: &PointAnswer) -> Self {
        let s = answer.solution.as_ref().filter(|_| answer.is_unique());
        Self {
            verdict: MapVerdict::Point(answer.verdict),
            efficiency: s.and_then(|s| s.efficiency),
            input_power_w: s.map(|s| s.input_power_w),
            loss_w: s.map(|s| s.loss_w),
            best: None,
        }
    }
}

/// The axes as asked, else the usual ones: of each, how many values it has.
fn effort(model: &Model, request: &FigureRequest) -> Effort {
    let train = model.train();
    let one = Effort::of_points(train, 1).seconds;
    let points = match &*request.over {
        [] => {
            // Where neither is named, every state may be tried.
            let open = request.state.is_none() && request.operation.is_none();
            let states = if open { train.states().len().max(1) } else { 1 };
            usual(train).iter().product::<usize>().max(COLUMNS * ROWS * states)
        }
        over => axes::points(over, model),
    };
    Effort::new("operating points", points as u64, one)
}

/// How many columns and rows a map has where nothing is said.
fn usual(train: &Train) -> [usize; 2] {
    /// Points of a finer map take so long at most, s.
    const QUICK: f64 = 2.0;
    let finer = [COLUMNS, ROWS].map(|n| FINER * (n - 1) + 1);
    let takes = Effort::of_points(train, finer.iter().product::<usize>() as u64).seconds;
    if takes > QUICK || train.meshes().iter().any(|m| m.computed) { [COLUMNS, ROWS] } else { finer }
}

/// Computes an efficiency map. Without axes it runs over the first speed of the operation and its load (of a train with
/// several freedoms: its first two speeds); of an automatic transmission, where neither state nor operation is named,
/// over speed and torque of the output, and at every point the state that loses least of those that keep the input
/// within what the operations of the file use.
///
/// # Errors
/// No such state or operation; axes that are none; a train of which nothing can be asked.
///
/// # Example
/// ```
/// use willis_figure::efficiency_map;
/// use willis::model::Model;
///
/// let text = r#"
///     format = 1
///     name = "one set"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 0.99
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "10 N m" }
/// "#;
/// let model = Model::from_toml(text).unwrap();
/// let map = efficiency_map(&model, None, None, &[])?;
/// assert!(map.points.iter().all(|p| (p.efficiency.unwrap() - 0.98607).abs() < 1e-9));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn efficiency_map(
    model: &Model,
    state: Option<&str>,
    operation: Option<&str>,
    over: &[String],
) -> Result<EfficiencyMap, Diagnostics> {
    let train = model.train();
    // Without an operation that says so, a train with states is looked at in its first.
    let first = train.states().first().filter(|_| train.operations().is_empty()).map(|s| s.name.as_str());
    let question = Question::new(model, operation, state.or(first), Hold::AsGiven)?;
    let open = state.is_none() && operation.is_none() && over.is_empty();
    if open
        && train.states().len() > 1
        && let Some(map) = best_state(&question)?
    {
        return Ok(map);
    }
    let over = match over {
        [] => {
            let [columns, rows] = usual(train);
            vec![axes::usual_speed(&question, columns), axes::usual_load(&question, rows)]
        }
        [_, _] => over.to_vec(),
        _ => {
            let message = format!("a map runs over two quantities, not {}", over.len());
            return Err(Diagnostic::new(Code::BadAxis, "", message).into());
        }
    };
    let [x, y] = <[Axis; 2]>::try_from(axes::parse(&over, model)?).expect("two are parsed");
    let basis = axes::basis(&question, &[&x, &y]);
    let marks = marks(&question, &x, &y);
    let (own_x, own_y) = (ChartAxis::of(&x), ChartAxis::of(&y));
    let sweep = bounded(question, vec![y, x])?;
    let mut trains = Default::default();
    let points = (0..sweep.len()).map(|k| MapPoint::of(&sweep.answer(k, &mut trains))).collect();
    Ok(EfficiencyMap { title: train.name().to_owned(), basis, x: own_x, y: own_y, points, states: vec![], marks })
}

fn bounded<'s>(question: Question<'s>, axes: Vec<Axis>) -> Result<Sweep<'s>, Diagnostics> {
    let sweep = Sweep::new(question, axes, &[])?;
    if sweep.len() > MOST_POINTS {
        let message = format!("{} points are too many for a picture", sweep.len());
        let d = Diagnostic::new(Code::BadAxis, "", message);
        return Err(d.hint(format!("{MOST_POINTS} are possible; `sweep` takes more")).into());
    }
    Ok(sweep)
}

/// Where the operations of the file lie that prescribe both quantities.
fn marks(question: &Question<'_>, x: &Axis, y: &Axis) -> Vec<MapMark> {
    let train = question.model().train();
    let mut all = vec![];
    let base = question.base();
    // What the map holds must be theirs too, at least in its direction.
    let like = |o: &&Operation| {
        let sign = |l: &Load| match l {
            Load::Torque(q) | Load::Power(q) => q.si() > 0.0,
        };
        let opposite = |l: &(MemberId, Load)| base.loads.iter().any(|b| b.0 == l.0 && sign(&b.1) != sign(&l.1));
        o.state == base.state && !o.loads.iter().any(opposite)
    };
    for o in train.operations().iter().filter(like) {
        let value = |axis: &Axis| {
            let (who, what) = axis.name.rsplit_once('.')?;
            let member = match who {
                "input" => train.input()?,
                "output" => train.output()?,
                _ => train.member(who)?,
            };
            let loads = o.loads.iter().filter(|l| l.0 == member);
            let si = match what {
                "speed" => o.speeds.iter().find(|s| s.0 == member)?.1.si(),
                "torque" => {
                    loads.filter_map(|l| if let Load::Torque(t) = &l.1 { Some(t.si()) } else { None }).next()?
                }
                "power" => loads.filter_map(|l| if let Load::Power(p) = &l.1 { Some(p.si()) } else { None }).next()?,
                _ => return None,
            };
            let unit = match axis.unit.as_str() {
                "rpm" => std::f64::consts::PI / 30.0,
                "kW" => 1e3,
                "N m" | "W" | "rad/s" => 1.0,
                _ => return None,
            };
            let value = si / unit;
            (value >= axis.number(0) && value <= axis.number(axis.len() - 1)).then_some(value)
        };
        if let (Some(a), Some(b)) = (value(x), value(y)) {
            all.push(MapMark { operation: o.name.clone(), at: [a, b] });
        }
    }
    all
}

/// Over speed and torque of the output, at every point the best state.
fn best_state(question: &Question<'_>) -> Result<Option<EfficiencyMap>, Diagnostics> {
    let model = question.model();
    let train = model.train();
    let (Some(input), Some(output)) = (train.input(), train.output()) else { return Ok(None) };
    if train.states().iter().any(|s| s.input.is_some_and(|m| m != input) || s.output.is_some_and(|m| m != output)) {
        return Ok(None);
    }
    let table = analysis::analyze(train, &Selection { state: None, operation: None })?.ratios;
    let ratios: Vec<f64> = table.0.iter().filter_map(|(_, row)| row.value).filter(|r| *r > 0.0).collect();
    if ratios.len() < 2 {
        return Ok(None);
    }
    let (most_speed, most_torque) = (axes::most_speed(question, input), axes::most_torque(question, input));
    let (high, low) = ratios.iter().fold((0.0f64, f64::INFINITY), |(h, l), r| (h.max(*r), l.min(*r)));
    let digits = |x: f64| {
        let unit = 10f64.powf(x.log10().floor() - 1.0);
        format!("{:.12e}", (x / unit).ceil() * unit).parse::<f64>().unwrap_or(x)
    };
    let (speed, torque) = (digits(most_speed / low), digits(most_torque * high));
    let over = [
        format!("output.speed={} rpm..{speed} rpm:{COLUMNS}", speed / 40.0),
        format!("output.torque={} N m..{torque} N m:{ROWS}", torque / 30.0),
        "state=all".to_owned(),
    ];
    let [x, y] = <[Axis; 2]>::try_from(axes::parse(&over[..2], model)?).expect("two are parsed");
    let states = Axis::parse(&over[2], model).map_err(|d| Diagnostics::from_iter([*d]))?;
    let names: Vec<String> = (0..states.len()).map(|k| states.setting(k)).collect();
    let (own_x, own_y) = (ChartAxis::of(&x), ChartAxis::of(&y));
    let sweep = bounded(question.clone(), vec![y, x, states])?;
    let mut trains = Default::default();
    let input_name = train.member_name(input);
    let count = names.len() as u64;
    let points: Vec<MapPoint> = (0..sweep.len() / count)
        .map(|p| {
            let mut best = MapPoint {
                verdict: MapVerdict::Beyond,
                efficiency: None,
                input_power_w: None,
                loss_w: None,
                best: None,
            };
            for k in 0..count {
                let answer = sweep.answer(p * count + k, &mut trains);
                let Some(m) = answer.solution.as_ref().and_then(|s| s.members.get(input_name)) else { continue };
                let speed = m.speed_rad_s.unwrap_or(f64::NAN) * 30.0 / std::f64::consts::PI;
                let torque = m.torque_n_m.unwrap_or(f64::NAN);
                let within = speed > 0.0 && speed <= most_speed * (1.0 + 1e-9) && torque <= most_torque * (1.0 + 1e-9);
                let new = MapPoint { best: Some(k as usize), ..MapPoint::of(&answer) };
                if within && new.efficiency > best.efficiency {
                    best = new;
                }
            }
            best
        })
        .collect();
    if points.iter().filter_map(|p| p.best).collect::<std::collections::BTreeSet<_>>().len() < 2 {
        return Ok(None);
    }
    let basis = format!(
        "At every point the state that loses least, with {input_name} up to {most_speed} rpm and {most_torque} N m"
    );
    let title = train.name().to_owned();
    Ok(Some(EfficiencyMap { title, basis, x: own_x, y: own_y, points, states: names, marks: vec![] }))
}
