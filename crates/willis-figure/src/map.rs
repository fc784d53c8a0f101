//! Efficiency over two quantities, with what has no answer, and the gear that loses least.

pub(crate) mod compiled;
pub mod draw;
mod probe;
mod told;

use serde::{Deserialize, Serialize};
use willis::analysis::{self, Selection};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::Model;
use willis::study::{Axis, Hold, PointAnswer, PointSetup, PointVerdict};
use willis::train::{Load, MemberId, Operation, Train};
use willis::unstable;
use willis::work::{Cancelled, Effort, Serial, Work};

use crate::kind::{Ask, Detail, FigureRequest, Kind, Pace};
use crate::parts::axes::{self, ChartAxis};
use probe::{Limits, Probe};

pub(crate) const KIND: Kind<EfficiencyMap> = Kind {
    title: "Efficiency map",
    takes: &[Ask::State, Ask::Operation, Ask::Over],
    effort,
    applies: Some(applies),
    make: |s, r| in_steps(s, r, &Serial, Detail::Fine),
    steps: Some(in_steps),
    draw: draw::draw_on,
};

fn in_steps(model: &Model, r: &FigureRequest, work: &dyn Work, detail: Detail) -> Result<EfficiencyMap, Diagnostics> {
    map_within(model, [r.state.as_deref(), r.operation.as_deref()], &r.over, work, detail)
}

/// Points along the axes where the caller does not say.
const COLUMNS: usize = 41;
const ROWS: usize = 31;
/// The same where each point is asked of every state.
const FEWER: [usize; 2] = [21, 16];
/// Points of a map that are computed at most.
const MOST_POINTS: usize = 100_000;
/// Halvings of a step of the grid in which a border is looked for: a hundredth of a pixel.
const HALVINGS: usize = 11;
/// Lines that are added to each axis at most, so that no zone lies between two neighbours unseen.
const MOST_LINES: usize = 24;
/// Rounds in which lines are added: a new line has new neighbours.
const ROUNDS: usize = 4;

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
    /// Where one zone ends and the next begins: between all neighbours of different zones.
    pub borders: Vec<MapBorder>,
    /// Where three zones or more meet within a cell of the grid.
    pub joints: Vec<MapJoint>,
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
    /// Points of a zone have the same verdict and best state, power through each mesh in the same direction, and the same
    /// inputs and outputs: within it the efficiency has neither jump nor kink.
    pub zone: usize,
}

/// The border of two zones between two neighbouring points of the map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapBorder {
    /// The points, as positions among [`EfficiencyMap::points`].
    pub between: [usize; 2],
    /// Where it is: 0 at the first point, 1 at the second.
    pub at: f64,
    /// What holds right before and right behind it.
    pub sides: [MapPoint; 2],
}

/// Where several zones meet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapJoint {
    /// The lower left point of its cell, as position among [`EfficiencyMap::points`].
    pub cell: usize,
    /// Where it is in the cell: 0 at that point, 1 at the next along each axis.
    pub at: [f64; 2],
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

/// There is a map where there is an operating point and quantities to vary.
fn applies(model: &Model) -> bool {
    let first = model.train().states().first().filter(|_| model.train().operations().is_empty());
    let Ok(question) = PointSetup::new(model, None, first.map(|s| s.name.as_str()), Hold::AsGiven) else {
        return false;
    };
    axes::parse(&[axes::usual_speed(&question, 2), axes::usual_load(&question, 2)], model).is_ok()
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
            // The limits of every gear are lines of the grid.
            let fewer = (FEWER[0] + 2 * states) * (FEWER[1] + 2 * states) * states;
            if states > 1 { fewer } else { COLUMNS * ROWS }
        }
        over => axes::points(over, model),
    };
    // Borders are looked for between points: as many evaluations again, and half as many more, on trains that have many.
    Effort::new("operating points", points as u64 * 5 / 2, one)
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
    map_within(model, [state, operation], over, &Serial, Detail::Fine)
}

fn map_within(
    model: &Model,
    [state, operation]: [Option<&str>; 2],
    over: &[String],
    work: &dyn Work,
    detail: Detail,
) -> Result<EfficiencyMap, Diagnostics> {
    let train = model.train();
    // Without an operation that says so, a train with states is looked at in its first.
    let first = train.states().first().filter(|_| train.operations().is_empty()).map(|s| s.name.as_str());
    let question = PointSetup::new(model, operation, state.or(first), Hold::AsGiven)?;
    let open = state.is_none() && operation.is_none() && over.is_empty();
    if open
        && train.states().len() > 1
        && let Some(map) = best_state(&question, work, detail)?
    {
        return Ok(map);
    }
    let pace = detail.pace(train, 1, work, || {
        let _ = PointAnswer::of(train, question.base());
    });
    let over = match over {
        [] => {
            let [columns, rows] = pace.grid([COLUMNS, ROWS]);
            vec![axes::usual_speed(&question, columns), axes::usual_load(&question, rows)]
        }
        [_, _] => over.to_vec(),
        _ => {
            let message = format!("a map runs over two quantities, not {}", over.len());
            return Err(Diagnostic::new(Code::BadAxis, "", message).into());
        }
    };
    let [x, y] = <[Axis; 2]>::try_from(axes::parse(&over, model)?).expect("two are parsed");
    few_enough(x.len() * y.len())?;
    let basis = axes::basis(&question, &[&x, &y]);
    let marks = marks(&question, &x, &y);
    let mut probe = Probe::new(&question, [&x, &y], None)?;
    let own = [ChartAxis::of(&x), ChartAxis::of(&y)];
    Ok(EfficiencyMap { title: train.name().to_owned(), basis, marks, ..mapped(own, &mut probe, work, pace)? })
}

/// How many different zones there are.
fn several(mut zones: [usize; 4]) -> usize {
    zones.sort_unstable();
    1 + zones.windows(2).filter(|w| w[0] != w[1]).count()
}

/// Where zones meet in the unit square with these zones at its corners: the quarter in which most of them still meet, again and
/// again.
fn joint(mut corners: [usize; 4], mut zone: impl FnMut([f64; 2]) -> usize) -> [f64; 2] {
    let ([mut x, mut y], mut half) = ([0.0, 0.0], 0.5);
    for _ in 0..HALVINGS - 2 {
        let [low, right, top, left, middle] = [[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0], [1.0, 1.0]]
            .map(|[a, b]| zone([x + a * half, y + b * half]));
        let [a, b, c, d] = corners;
        let quarters = [
            ([0.0, 0.0], [a, low, middle, left]),
            ([1.0, 0.0], [low, b, right, middle]),
            ([1.0, 1.0], [middle, right, c, top]),
            ([0.0, 1.0], [left, middle, top, d]),
        ];
        // Of several the first.
        let Some(([u, v], own)) = quarters.into_iter().rev().max_by_key(|q| several(q.1)) else { break };
        (x, y, corners) = (x + u * half, y + v * half, own);
        half /= 2.0;
    }
    [x + half, y + half]
}

fn few_enough(points: usize) -> Result<(), Diagnostics> {
    if points > MOST_POINTS {
        let message = format!("{points} points are too many for a picture");
        let d = Diagnostic::new(Code::BadAxis, "", message);
        return Err(d.hint(format!("{MOST_POINTS} are possible; `sweep` takes more")).into());
    }
    Ok(())
}

/// The points of a grid, row by row.
fn gridded([x, y]: [&ChartAxis; 2], probe: &mut Probe<'_, '_>, work: &dyn Work) -> Result<Vec<MapPoint>, Cancelled> {
    let width = x.values.len();
    let rows: Vec<Vec<[f64; 2]>> = y.values.iter().map(|y| x.values.iter().map(|x| [*x, *y]).collect()).collect();
    work.begin("points", (width * rows.len()) as u64);
    let mut found = probe.at_all(&rows, work)?;
    // A point exactly on a border belongs to no zone: it is told as what lies a millionth of a step inwards of it.
    let plain = probe.loosest();
    let inwards = |values: &[f64], k: usize| match k + 1 < values.len() {
        true => values[k] + 1e-6 * (values[k + 1] - values[k]),
        false => values[k] - 1e-6 * (values[k] - values[k - 1]),
    };
    for (k, f) in found.iter_mut().enumerate().filter(|(_, f)| plain.on_border(f)) {
        *f = probe.at([inwards(&x.values, k % width), inwards(&y.values, k / width)]);
    }
    Ok(found.into_iter().map(|f| f.point).collect())
}

/// Refuses to go on where the work was cancelled.
fn going(work: &dyn Work) -> Result<(), Cancelled> {
    if work.cancelled() { Err(Cancelled) } else { Ok(()) }
}

/// The border between two points of different zones, by so many halvings of their distance.
fn border(
    between: [usize; 2],
    map: &EfficiencyMap,
    probe: &mut Probe<'_, '_>,
    halvings: usize,
) -> (MapBorder, Option<f64>) {
    let [a, b] = between.map(|k| map.place(k));
    let on = |t: f64| [0, 1].map(|c| a[c] + t * (b[c] - a[c]));
    let ends = between.map(|k| map.points[k].zone);
    let mut sides = between.map(|k| map.points[k].clone());
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..halvings {
        let middle = (low + high) / 2.0;
        let there = probe.at(on(middle)).point;
        match there.zone == ends[0] {
            true => (low, sides[0]) = (middle, there),
            false => (high, sides[1]) = (middle, there),
        }
    }
    let at = (low + high) / 2.0;
    // Another zone lies between: its middle is where its other border is as far as this one.
    let mut skipped = None;
    if halvings > 0 && sides[1].zone != ends[1] {
        let (mut low, mut high) = (high, 1.0);
        for _ in 0..halvings {
            let middle = (low + high) / 2.0;
            match probe.at(on(middle)).point.zone == ends[1] {
                true => high = middle,
                false => low = middle,
            }
        }
        skipped = Some((at + low) / 2.0);
        // Where no line of the grid finds room for it, it goes to the zone beyond it.
        sides[1] = map.points[between[1]].clone();
    }
    (MapBorder { between, at, sides }, skipped)
}

/// The points of a map and the borders between them; no words yet.
///
/// A ridge of efficiency may lie between two neighbours: the zone on its one side is then seen at neither of them, and contours
/// along it would break into islands. So a line is added to the grid wherever a border has a third zone within it.
fn mapped(
    [x, y]: [ChartAxis; 2],
    probe: &mut Probe<'_, '_>,
    work: &dyn Work,
    pace: Pace,
) -> Result<EfficiencyMap, Cancelled> {
    let points = gridded([&x, &y], probe, work)?;
    let mut map = EfficiencyMap {
        title: String::new(),
        basis: String::new(),
        x,
        y,
        points,
        borders: vec![],
        joints: vec![],
        states: vec![],
        marks: vec![],
    };
    let most = [&map.x, &map.y].map(|a| a.values.len() + MOST_LINES);
    // A coarse map has the lines that it has.
    let rounds = if pace.is_full() { ROUNDS } else { 0 };
    for round in 0..=rounds {
        let (borders, wanted) = borders(&map, probe, work, pace)?;
        map.borders = borders;
        if round == rounds || !map.refined(&wanted, most) {
            break;
        }
        map.points = gridded([&map.x, &map.y], probe, work)?;
    }
    let width = map.x.values.len();
    for cell in (0..map.points.len() - width).filter(|k| (k + 1) % width > 0) {
        let corners = [cell, cell + 1, cell + 1 + width, cell + width].map(|k| map.points[k].zone);
        // Where two borders pass beside each other, nothing meets.
        if several(corners) > 2 && map.through(cell).is_none() {
            let [a, b] = [cell, cell + 1 + width].map(|k| map.place(k));
            let zone = |at: [f64; 2]| probe.at([0, 1].map(|c| a[c] + at[c] * (b[c] - a[c]))).point.zone;
            map.joints.push(MapJoint { cell, at: if pace.is_full() { joint(corners, zone) } else { [0.5; 2] } });
        }
    }
    Ok(map)
}

/// All borders of a map, and where lines of the grid are wanted, on each axis.
fn borders(
    map: &EfficiencyMap,
    probe: &mut Probe<'_, '_>,
    work: &dyn Work,
    pace: Pace,
) -> Result<(Vec<MapBorder>, [Vec<f64>; 2]), Cancelled> {
    let width = map.x.values.len();
    let right = (0..map.points.len()).filter(|k| (k + 1) % width > 0).map(|k| ([k, k + 1], 0));
    let up = (0..map.points.len() - width).map(|k| ([k, k + width], 1));
    let differ = |&([a, b], _): &([usize; 2], usize)| map.points[a].zone != map.points[b].zone;
    let pairs: Vec<_> = right.chain(up).filter(differ).collect();
    let halvings = pace.at_each(pairs.len(), HALVINGS);
    let (mut all, mut wanted) = (vec![], [vec![], vec![]]);
    for (between, axis) in pairs {
        going(work)?;
        let (found, skipped) = border(between, map, probe, halvings);
        all.push(found);
        if let Some(t) = skipped {
            let [from, to] = between.map(|k| map.place(k)[axis]);
            wanted[axis].push(from + t * (to - from));
        }
    }
    Ok((all, wanted))
}

impl EfficiencyMap {
    /// Where a point of the grid is.
    fn place(&self, k: usize) -> [f64; 2] {
        let width = self.x.values.len();
        [self.x.values[k % width], self.y.values[k / width]]
    }

    /// Whether two borders pass each other in the cell with this lower left point: the first corner of the zone between them, counted
    /// round the cell. Opposite corners have one zone then, and the other two are of two others.
    pub(crate) fn through(&self, cell: usize) -> Option<usize> {
        let width = self.x.values.len();
        let [a, b, c, d] = [cell, cell + 1, cell + 1 + width, cell + width].map(|k| self.points[k].zone);
        match (a == c && a != b && a != d, b == d && b != a && b != c) {
            (true, false) if b != d => Some(0),
            (false, true) if a != c => Some(1),
            _ => None,
        }
    }

    /// Adds lines to the grid where they are wanted, within what an axis may have; whether there is a new one.
    fn refined(&mut self, wanted: &[Vec<f64>; 2], most: [usize; 2]) -> bool {
        /// Lines nearer than this part of the axis are one.
        const CLOSE: f64 = 1.0 / 400.0;
        let mut any = false;
        for (axis, (wanted, most)) in [&mut self.x, &mut self.y].into_iter().zip(wanted.iter().zip(most)) {
            let [Some(first), Some(last)] = [axis.values.first().copied(), axis.values.last().copied()] else {
                continue;
            };
            for value in wanted {
                let close = |v: &f64| (v - value).abs() < CLOSE * (last - first);
                if axis.values.len() < most && !axis.values.iter().any(close) {
                    axis.values.insert(axis.values.partition_point(|v| v < value), *value);
                    any = true;
                }
            }
        }
        any
    }
}

/// Where the operations of the file lie that prescribe both quantities.
fn marks(question: &PointSetup<'_>, x: &Axis, y: &Axis) -> Vec<MapMark> {
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
                "rpm" => axes::RPM,
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
fn best_state(
    question: &PointSetup<'_>,
    work: &dyn Work,
    detail: Detail,
) -> Result<Option<EfficiencyMap>, Diagnostics> {
    let model = question.model();
    let train = model.train();
    let (Some(input), Some(output)) = (train.input(), train.output()) else { return Ok(None) };
    if train.states().iter().any(|s| s.input.is_some_and(|m| m != input) || s.output.is_some_and(|m| m != output)) {
        return Ok(None);
    }
    // Operations do not matter here, nor what is wrong with them.
    let table = analysis::analyze(&unstable::without_operations(train), &Selection::default())?.ratios;
    let own = |name: &str| table.0.iter().find(|row| row.0 == name).and_then(|row| row.1.value);
    let ratios: Vec<f64> = table.0.iter().filter_map(|(_, row)| row.value).filter(|r| *r > 0.0).collect();
    if ratios.len() < 2 {
        return Ok(None);
    }
    let (most_speed, most_torque) = (axes::most_speed(question, input), axes::most_torque(question, input));
    let limits = Limits { input, speed: [least_speed(train, input), most_speed], torque: most_torque };
    let (high, low) = ratios.iter().fold((0.0f64, f64::INFINITY), |(h, l), r| (h.max(*r), l.min(*r)));
    let digits = |x: f64| {
        let unit = 10f64.powf(x.log10().floor() - 1.0);
        format!("{:.12e}", (x / unit).ceil() * unit).parse::<f64>().unwrap_or(x)
    };
    let (speed, torque) = (digits(most_speed / low), digits(most_torque * high));
    let pace = detail.pace(train, ratios.len() as u64, work, || {
        let _ = PointAnswer::of(train, question.base());
    });
    let [columns, rows] = pace.grid(FEWER);
    // Low enough that no gear lies outside as a whole.
    let (least_speed, least_torque) =
        ((speed / 40.0).min(most_speed / high / 2.0), (torque / 30.0).min(most_torque * low / 2.0));
    let over = [
        format!("output.speed={least_speed} rpm..{speed} rpm:{columns}"),
        format!("output.torque={least_torque} N m..{torque} N m:{rows}"),
        "state=all".to_owned(),
    ];
    let [x, y] = <[Axis; 2]>::try_from(axes::parse(&over[..2], model)?).expect("two are parsed");
    let states = Axis::parse(&over[2], model).map_err(|d| Diagnostics::from_iter([*d]))?;
    let names: Vec<String> = (0..states.len()).map(|k| states.setting(k)).collect();
    let choice = names.iter().map(|name| (name.clone(), own(name))).collect();
    let mut probe = Probe::new(question, [&x, &y], Some((limits, choice)))?;
    // The limits of every gear are lines of the grid, so that the corners between them are sharp.
    let [mut own_x, mut own_y] = [ChartAxis::of(&x), ChartAxis::of(&y)];
    let corners = if pace.is_full() { probe.corners([own_x.values[0], own_y.values[0]]) } else { vec![] };
    for at in corners {
        for (axis, value) in [&mut own_x, &mut own_y].into_iter().zip(at) {
            let within = axis.values[0] < value && axis.values.last() > Some(&value);
            let close = |v: &f64| (v - value).abs() < 1e-9 * value.abs();
            if within && !axis.values.iter().any(close) {
                axis.values.insert(axis.values.partition_point(|v| *v < value), value);
            }
        }
    }
    let map = mapped([own_x, own_y], &mut probe, work, pace)?;
    if map.points.iter().filter_map(|p| p.best).collect::<std::collections::BTreeSet<_>>().len() < 2 {
        return Ok(None);
    }
    let input_name = train.member_name(input);
    let from = if limits.speed[0] > 0.0 { format!("from {} ", limits.speed[0]) } else { "up ".to_owned() };
    let basis = format!(
        "At every point the state that loses least, with {input_name} {from}to {most_speed} rpm and up to {most_torque} N m"
    );
    Ok(Some(EfficiencyMap { title: train.name().to_owned(), basis, states: names, ..map }))
}

/// The speed below which the file never drives its input, rpm: five sixths of the least, as the largest is six fifths of
/// the most. Operations at one speed, or nearly so, do not say that it cannot turn more slowly.
fn least_speed(train: &Train, input: MemberId) -> f64 {
    /// From the least speed to the most, where they are a range.
    const RANGE: f64 = 2.0;
    let all = train.operations().iter().flat_map(|o| &o.speeds).filter(|s| s.0 == input);
    let rpm = all.map(|s| s.1.si() * 30.0 / std::f64::consts::PI).filter(|w| *w > 0.0);
    let (least, most) = rpm.fold((f64::INFINITY, 0.0f64), |(l, m), w| (l.min(w), m.max(w)));
    if most >= RANGE * least { (least / 1.2).floor() } else { 0.0 }
}
