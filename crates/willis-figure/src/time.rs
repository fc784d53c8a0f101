//! A run over time: what turns, what acts, what sticks and slips.

pub mod draw;

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::dynamics::{
    Column, ColumnKind, ColumnUnit, Event, ModeLabel, Options, Outcome, Recorder, RunReport, Sample, simulate,
};
use willis::train::{MemberKind, Train};

use crate::kind::{self, Ask, Kind};

pub(crate) const KIND: Kind<TimePlot> = Kind {
    title: "Motion over time",
    takes: &[Ask::Part, Ask::Window],
    effort: kind::of_file,
    applies: Some(|model| !model.train().scenarios().is_empty()),
    make: |s, r| scenario(s.train(), r.part.as_deref(), r.window),
    steps: None,
    draw: draw::draw_on,
};

/// The scenario of that name, or the first, simulated.
///
/// # Errors
/// No such scenario, none at all, a window in which nothing happens, or what [`simulate`] says.
fn scenario(train: &Train, name: Option<&str>, window: Option<[f64; 2]>) -> Result<TimePlot, Diagnostics> {
    let scenario = match (name, train.scenarios().first()) {
        (Some(name), _) => train.find_scenario(name)?,
        (None, Some(first)) => first,
        (None, None) => {
            let d = Diagnostic::new(Code::Unfit, "", "the train has no scenario that could run over time");
            return Err(d.hint("a [[scenario]] says what drives and what happens when").into());
        }
    };
    let span = [scenario.start, scenario.end];
    let (mut plot, mut options) = (TimePlotBuilder::new(train, span), Options::default());
    if let Some([from, to]) = window {
        let [from, to] = [from.max(span[0]), to.min(span[1])];
        // Not numbers are no window either.
        if !matches!(from.partial_cmp(&to), Some(std::cmp::Ordering::Less)) {
            let message = format!("nothing of the scenario `{}` lies in that time", scenario.name);
            let hint = format!("it runs from {} s to {} s", span[0], span[1]);
            return Err(Diagnostic::new(Code::OutOfRange, "", message).hint(hint).into());
        }
        plot = plot.within([from, to]);
        // All rows lie in the window; what comes after it is not run.
        (options.from_s, options.to_s) = (Some(from), Some(to));
    }
    let report = simulate(train, &scenario.name, &options, &mut plot)?;
    Ok(TimePlot { cut: options.to_s.is_some_and(|to| to < span[1]), ..plot.finish(&report) })
}

/// A run over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TimePlot {
    /// The train.
    pub train: String,
    /// The scenario.
    pub scenario: String,
    /// How the run ended.
    pub outcome: Outcome,
    /// Where it began and ended, s.
    pub run: [f64; 2],
    /// The run was ended where the picture ends, before the end of the scenario.
    #[serde(default)]
    pub cut: bool,
    /// What the time axis shows, s: the whole scenario, unless the run ended in its first fifth.
    pub axis: [f64; 2],
    /// One a quantity.
    pub panels: Vec<TimePanel>,
    /// What sticks, slips or is free.
    pub modes: Vec<ModeRow>,
    /// Elements that found no place among the modes.
    pub modes_left_out: usize,
    /// The first changes of mode after the start, with their causes.
    pub marks: Vec<TimeMark>,
    /// When modes changed, s; of several within a thousandth of the run, the first.
    pub event_times: Vec<f64>,
    /// All changes of mode after the start, of those that are shown.
    pub event_count: usize,
    /// Where changes of mode lie together in several short times, such as the shifts of an automatic: each of them closely.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shifts: Vec<TimeShift>,
}

/// A short time in which modes change, seen closely.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TimeShift {
    /// From when to when, s; equally long for all shifts of a run.
    pub window: [f64; 2],
    /// The first and the last change of mode in it, s.
    pub events: [f64; 2],
    /// The curves of the first panels, in the same order.
    pub panels: Vec<TimePanel>,
}

/// Curves that share an axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TimePanel {
    /// Its heading: `Speed`.
    pub quantity: String,
    /// SI; of temperatures °C.
    pub unit: ColumnUnit,
    /// The curves, in the order of the columns.
    pub lines: Vec<TimeLine>,
    /// Curves that found no place: those with the smallest values.
    pub left_out: usize,
}

/// A curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TimeLine {
    /// Whose it is; several names where they agree throughout.
    pub names: Vec<String>,
    /// Number of the colour of the first, of a speed: the place of the member in the train.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<usize>,
    /// Its pieces between gaps: time, s, and value. First, least, greatest and last value of every
    /// short interval are kept, so that no spike is lost.
    pub pieces: Vec<Vec<[f64; 2]>>,
}

/// The modes of one element.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ModeRow {
    /// The element.
    pub element: String,
    /// In rising time.
    pub segments: Vec<ModeSegment>,
}

/// A time in one mode.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ModeSegment {
    /// s
    pub from: f64,
    /// s
    pub to: f64,
    /// Absent where the modes change too fast to be drawn.
    pub mode: Option<ModeLabel>,
}

/// A change of mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TimeMark {
    /// s
    pub time: f64,
    /// Why.
    pub cause: String,
}

/// Kinds of columns that make panels, with their quantity; the first seven wherever they are, the
/// others where none of the first is.
const KINDS: [(ColumnKind, &str); 11] = [
    (ColumnKind::Speed, "Speed"),
    (ColumnKind::Torque, "Torque"),
    (ColumnKind::Power, "Power"),
    (ColumnKind::Energy, "Energy"),
    (ColumnKind::Temperature, "Temperature"),
    (ColumnKind::Ratio, "Ratio"),
    (ColumnKind::Twist, "Twist"),
    (ColumnKind::Reaction, "Reaction"),
    (ColumnKind::Acceleration, "Acceleration"),
    (ColumnKind::Angle, "Angle"),
    (ColumnKind::Efficiency, "Efficiency"),
];
const USUAL: usize = 7;
/// Curves in a panel; a label beside each has to find room.
const MOST_LINES: usize = 8;
/// Rows of modes.
const MOST_MODES: usize = 24;
/// Events that are told in words.
const MOST_MARKS: usize = 10;
/// Intervals kept of a curve; twice as many before neighbours are joined.
const INTERVALS: usize = 450;
/// The same for the curves of single shifts, which are a small part of the run.
const FINE: usize = 7200;
/// Shifts are apart when nothing changes for this part of the run, and short when all of them take less than the other part.
const APART: f64 = 0.05;
const SHORT_SHIFTS: f64 = 0.5;
/// Panels that are shown of a shift, and shifts that are shown.
const SHIFT_PANELS: usize = 2;
const MOST_SHIFTS: usize = 12;
/// Segments or times kept before short ones are joined.
const MOST_SEGMENTS: usize = 4096;
/// The shortest that stays itself then, as a part of the run.
const SHORT: f64 = 1e-3;

/// Collects a run for its figure while it goes on; memory does not grow with the length of the run.
///
/// # Example
/// ```
/// use willis_figure::TimePlotBuilder;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["s", "r", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .build()?;
/// let mut plot = TimePlotBuilder::new(&train, [0.0, 3.0]);
/// // willis::dynamics::simulate(&train, "launch", &Options::default(), &mut plot)?;
/// # let _ = &mut plot;
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Debug)]
pub struct TimePlotBuilder {
    span: [f64; 2],
    /// Whether the span is a part of the run, and the row before the next.
    part: bool,
    before: Option<(f64, Vec<f64>)>,
    members: Vec<String>,
    planets: Vec<String>,
    meshes: Vec<String>,
    curves: Vec<(usize, Column, Decimated)>,
    /// The same curves, for what is seen closely.
    fine: Vec<Decimated>,
    modes: Vec<(usize, String, Modes)>,
    marks: Vec<TimeMark>,
    event_times: Vec<f64>,
    event_count: usize,
}

impl TimePlotBuilder {
    /// For a scenario that lasts from its first to its second time, s.
    pub fn new(train: &Train, span: [f64; 2]) -> Self {
        let planet = |m: &&willis::train::Member| m.kind == MemberKind::Planet;
        Self {
            span,
            part: false,
            before: None,
            members: train.members().iter().map(|m| m.name.clone()).collect(),
            planets: train.members().iter().filter(planet).map(|m| m.name.clone()).collect(),
            meshes: train.meshes().iter().map(|m| m.name.clone()).collect(),
            curves: vec![],
            fine: vec![],
            modes: vec![],
            marks: vec![],
            event_times: vec![],
            event_count: 0,
        }
    }

    /// Only what happens between two times, s.
    pub fn within(self, window: [f64; 2]) -> Self {
        Self { span: window, part: true, ..self }
    }

    /// Takes a row into curves and modes.
    fn take(&mut self, time: f64, values: &[f64]) {
        for ((k, column, curve), fine) in self.curves.iter_mut().zip(&mut self.fine) {
            // Temperatures are drawn in °C.
            let zero = if column.kind == ColumnKind::Temperature { 273.15 } else { 0.0 };
            curve.push(time, values[*k] - zero);
            fine.push(time, values[*k] - zero);
        }
        for (k, _, modes) in &mut self.modes {
            modes.push(time, values[*k]);
        }
    }

    /// Takes what of a row lies in the window: at its ends the values between this row and the one before.
    fn take_part(&mut self, time: f64, values: &[f64]) {
        let before = self.before.replace((time, values.to_vec()));
        let [from, to] = self.span;
        let Some((earlier, old)) = before.filter(|b| b.0 < time) else {
            if (from..=to).contains(&time) {
                self.take(time, values);
            }
            return;
        };
        let modes: Vec<usize> = self.modes.iter().map(|m| m.0).collect();
        for end in [from, to].into_iter().filter(|end| earlier < *end && *end < time) {
            let part = (end - earlier) / (time - earlier);
            let between = |k: usize| if modes.contains(&k) { old[k] } else { old[k] + part * (values[k] - old[k]) };
            let row: Vec<f64> = (0..values.len()).map(between).collect();
            self.take(end, &row);
        }
        if (from..=to).contains(&time) {
            self.take(time, values);
        }
    }

    /// The figure.
    pub fn finish(self, report: &RunReport) -> TimePlot {
        let [start, end] = self.span;
        let reached = report.end_s;
        let axis = if !self.part && reached > start && reached - start < 0.2 * (end - start) {
            [start, reached]
        } else {
            [start, end]
        };
        let panels = KINDS.iter().filter_map(|(kind, quantity)| {
            let own: Vec<_> = self.curves.iter().filter(|(_, c, _)| c.kind == *kind).collect();
            let mut panel = panel(quantity, own.first()?.1.unit, own.iter().map(|(_, c, d)| (label(c), d.pieces())))?;
            if *kind == ColumnKind::Temperature {
                panel.unit = ColumnUnit::DegreeCelsius;
            }
            if *kind == ColumnKind::Speed {
                // The frame is the first member.
                let place = |name: &String| self.members.iter().position(|m| m == name)?.checked_sub(1);
                panel.lines.iter_mut().for_each(|l| l.colour = l.names.first().and_then(place));
            }
            Some(panel)
        });
        let panels: Vec<TimePanel> = panels.collect();
        let windows = shifts(&self.event_times, axis);
        let shifts = windows.iter().map(|(window, events)| TimeShift {
            window: *window,
            events: *events,
            panels: panels.iter().take(SHIFT_PANELS).map(|p| self.closely(p, *window)).collect(),
        });
        let shifts = shifts.collect();
        let mut modes: Vec<_> = self
            .modes
            .into_iter()
            .map(|(_, element, m)| ModeRow { element, segments: m.segments })
            .filter(|r| !r.segments.is_empty())
            .collect();
        let all = modes.len();
        if all > MOST_MODES {
            // Those that never change give way first, the last of them before the others.
            let mut order: Vec<usize> = (0..all).collect();
            order.sort_by_key(|&k| modes[k].segments.len() < 2);
            order.truncate(MOST_MODES);
            let mut k = 0;
            modes.retain(|_| {
                k += 1;
                order.contains(&(k - 1))
            });
        }
        TimePlot {
            train: report.train.clone(),
            scenario: report.scenario.clone(),
            outcome: report.outcome.clone(),
            run: [report.start_s, reached],
            cut: false,
            axis,
            panels,
            modes_left_out: all - modes.len(),
            modes,
            marks: self.marks,
            event_times: self.event_times,
            event_count: self.event_count,
            shifts,
        }
    }

    /// The curves of a panel within a window.
    fn closely(&self, panel: &TimePanel, window: [f64; 2]) -> TimePanel {
        let kind = KINDS.iter().find(|k| k.1 == panel.quantity).map(|k| k.0);
        let own = || self.curves.iter().zip(&self.fine).filter(|((_, c, _), _)| Some(c.kind) == kind);
        let line = |l: &TimeLine| {
            let curve = own().find(|((_, c, _), _)| l.names.first() == Some(&label(c)));
            let pieces = curve.map_or(vec![], |(_, fine)| fine.pieces());
            TimeLine {
                pieces: pieces.iter().map(|p| clipped(p, window)).filter(|p| !p.is_empty()).collect(),
                ..l.clone()
            }
        };
        TimePanel { lines: panel.lines.iter().map(line).collect(), ..panel.clone() }
    }
}

/// The part of a curve within a window, with its values at the ends of it.
fn clipped(piece: &[[f64; 2]], [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut all: Vec<[f64; 2]> = vec![];
    for (k, p) in piece.iter().enumerate() {
        let before = k.checked_sub(1).map(|k| piece[k]).filter(|b| b[0] < p[0]);
        for end in [from, to] {
            if let Some(b) = before.filter(|b| b[0] < end && end < p[0]) {
                all.push([end, b[1] + (end - b[0]) / (p[0] - b[0]) * (p[1] - b[1])]);
            }
        }
        if (from..=to).contains(&p[0]) {
            all.push(*p);
        }
    }
    all
}

/// Windows of the shifts of a run, all equally long, with the first and last event of each; none where there are fewer than two, or
/// where they are no short parts of the run.
fn shifts(events: &[f64], [from, to]: [f64; 2]) -> Vec<([f64; 2], [f64; 2])> {
    let mut groups: Vec<[f64; 2]> = vec![];
    for t in events.iter().filter(|t| (from..=to).contains(*t)) {
        match groups.last_mut() {
            Some(last) if t - last[1] < APART * (to - from) => last[1] = *t,
            _ => groups.push([*t, *t]),
        }
    }
    let longest = groups.iter().map(|g| g[1] - g[0]).fold(0.0, f64::max);
    // A little before and behind.
    let width = 1.5 * longest;
    let short = width > 0.0 && width * groups.len() as f64 <= SHORT_SHIFTS * (to - from);
    if groups.len() < 2 || !short {
        return vec![];
    }
    let window = |g: &[f64; 2]| {
        let start = (g[0] - width / 6.0).clamp(from, to - width);
        ([start, start + width], *g)
    };
    groups.iter().take(MOST_SHIFTS).map(window).collect()
}

fn label(c: &Column) -> String {
    if c.of.is_empty() { c.quantity().replace('_', " ") } else { c.of.clone() }
}

fn panel(
    quantity: &str,
    unit: ColumnUnit,
    curves: impl Iterator<Item = (String, Vec<Vec<[f64; 2]>>)>,
) -> Option<TimePanel> {
    let mut lines: Vec<TimeLine> = Vec::new();
    for (name, pieces) in curves {
        if pieces.is_empty() {
            continue;
        }
        match lines.iter_mut().find(|l| agree(&l.pieces, &pieces)) {
            Some(same) => same.names.push(name),
            None => lines.push(TimeLine { names: vec![name], colour: None, pieces }),
        }
    }
    let all = lines.len();
    if all > MOST_LINES {
        let size = |l: &TimeLine| l.pieces.iter().flatten().fold(0.0f64, |m, p| m.max(p[1].abs()));
        let mut sizes: Vec<f64> = lines.iter().map(size).collect();
        sizes.sort_by(|a, b| b.total_cmp(a));
        let least = sizes[MOST_LINES - 1];
        let mut room = MOST_LINES;
        lines.retain(|l| {
            let stays = room > 0 && size(l) >= least;
            room -= usize::from(stays);
            stays
        });
    }
    (all > 0).then(|| TimePanel { quantity: quantity.to_owned(), unit, left_out: all - lines.len(), lines })
}

/// Whether two curves are one to the eye and to any reader of numbers.
fn agree(a: &[Vec<[f64; 2]>], b: &[Vec<[f64; 2]>]) -> bool {
    let size = a.iter().chain(b).flatten().fold(0.0f64, |m, p| m.max(p[1].abs()));
    let near = |p: &[f64; 2], q: &[f64; 2]| p[0] == q[0] && (p[1] - q[1]).abs() <= 1e-6 * size;
    let same = |a: &Vec<[f64; 2]>, b: &Vec<[f64; 2]>| a.len() == b.len() && a.iter().zip(b).all(|(p, q)| near(p, q));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
}

impl Recorder for TimePlotBuilder {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        let usual = |c: &Column| KINDS[..USUAL].iter().any(|k| k.0 == c.kind);
        let some = columns.iter().any(usual);
        let energy = !columns.iter().any(|c| c.kind == ColumnKind::Power);
        let other =
            |kind: ColumnKind, names: &[String]| columns.iter().any(|c| c.kind == kind && !names.contains(&c.of));
        let (shafts, sources) = (other(ColumnKind::Speed, &self.planets), other(ColumnKind::Torque, &self.meshes));
        for (k, c) in columns.iter().enumerate() {
            let drawn = match c.kind {
                ColumnKind::Time => false,
                ColumnKind::Mode => {
                    self.modes.push((k, label(c), Modes::new(self.span[0])));
                    false
                }
                ColumnKind::Speed => !shafts || !self.planets.contains(&c.of),
                ColumnKind::Torque => !sources || !self.meshes.contains(&c.of),
                ColumnKind::Energy => energy,
                kind => usual(c) || (!some && KINDS.iter().any(|(k, _)| *k == kind)),
            };
            if drawn {
                self.curves.push((k, c.clone(), Decimated::new(self.span, INTERVALS)));
                self.fine.push(Decimated::new(self.span, FINE));
            }
        }
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        match self.part {
            true => self.take_part(sample.time_s, sample.values),
            false => self.take(sample.time_s, sample.values),
        }
        ControlFlow::Continue(())
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        let inside = !self.part || (self.span[0]..=self.span[1]).contains(&event.time_s);
        if event.is_start() || !inside {
            return ControlFlow::Continue(());
        }
        self.event_count += 1;
        if self.marks.len() < MOST_MARKS {
            self.marks.push(TimeMark { time: event.time_s, cause: event.cause.clone() });
        }
        self.event_times.push(event.time_s);
        if self.event_times.len() > MOST_SEGMENTS {
            let apart = SHORT * (event.time_s - self.span[0]);
            let mut last = f64::NEG_INFINITY;
            self.event_times.retain(|t| {
                let stays = *t - last >= apart;
                if stays {
                    last = *t;
                }
                stays
            });
        }
        ControlFlow::Continue(())
    }
}

/// A curve of bounded size: of every interval the first, least, greatest and last value.
#[derive(Debug)]
struct Decimated {
    start: f64,
    width: f64,
    intervals: Vec<Interval>,
    /// How many are kept; twice as many before neighbours are joined.
    most: usize,
    gap: bool,
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    index: u64,
    points: [[f64; 2]; 5],
    length: usize,
    after_gap: bool,
}

impl Interval {
    fn push(&mut self, point: [f64; 2]) {
        self.points[self.length] = point;
        self.length += 1;
        if self.length == self.points.len() {
            let by = |a: &usize, b: &usize| self.points[*a][1].total_cmp(&self.points[*b][1]);
            let last = self.length - 1;
            let least = (0..=last).min_by(by).expect("not empty");
            let greatest = (0..=last).max_by(by).expect("not empty");
            let mut kept = 0;
            for k in 0..=last {
                if [0, least, greatest, last].contains(&k) {
                    self.points[kept] = self.points[k];
                    kept += 1;
                }
            }
            self.length = kept;
        }
    }
}

impl Decimated {
    fn new(span: [f64; 2], most: usize) -> Self {
        // Fine at first: a run may end early.
        let width = ((span[1] - span[0]) / most as f64 / 4096.0).max(f64::MIN_POSITIVE);
        Self { start: span[0], width, intervals: vec![], most, gap: true }
    }

    fn push(&mut self, time: f64, value: f64) {
        if !value.is_finite() {
            self.gap = true;
            return;
        }
        let index = ((time - self.start) / self.width).max(0.0) as u64;
        let point = [time, value];
        match self.intervals.last_mut() {
            // A gap within an interval is too short to be seen.
            Some(last) if last.index >= index => last.push(point),
            _ => {
                let mut points = [[0.0; 2]; 5];
                points[0] = point;
                self.intervals.push(Interval { index, points, length: 1, after_gap: self.gap });
            }
        }
        self.gap = false;
        while self.intervals.len() > 2 * self.most {
            self.width *= 2.0;
            for i in &mut self.intervals {
                i.index /= 2;
            }
            let mut kept = 0;
            for k in 1..self.intervals.len() {
                let next = self.intervals[k];
                if self.intervals[kept].index == next.index {
                    next.points[..next.length].iter().for_each(|p| self.intervals[kept].push(*p));
                } else {
                    kept += 1;
                    self.intervals[kept] = next;
                }
            }
            self.intervals.truncate(kept + 1);
        }
    }

    fn pieces(&self) -> Vec<Vec<[f64; 2]>> {
        let mut all: Vec<Vec<[f64; 2]>> = Vec::new();
        for i in &self.intervals {
            if i.after_gap || all.is_empty() {
                all.push(vec![]);
            }
            all.last_mut().expect("it was just added").extend(&i.points[..i.length]);
        }
        all
    }
}

/// The modes of an element, bounded in number.
#[derive(Debug)]
struct Modes {
    start: f64,
    segments: Vec<ModeSegment>,
    open: bool,
}

impl Modes {
    fn new(start: f64) -> Self {
        Self { start, segments: vec![], open: false }
    }

    fn push(&mut self, time: f64, value: f64) {
        let mode = match value {
            -1.0 => ModeLabel::Backward,
            0.0 => ModeLabel::Stuck,
            1.0 => ModeLabel::Forward,
            2.0 => ModeLabel::Free,
            _ => {
                self.open = false;
                return;
            }
        };
        let last = self.segments.last_mut().filter(|_| self.open);
        self.open = true;
        if let Some(last) = last {
            // A mode holds until the row that tells of the next.
            last.to = time;
            if last.mode == Some(mode) {
                return;
            }
        }
        self.segments.push(ModeSegment { from: time, to: time, mode: Some(mode) });
        if self.segments.len() > MOST_SEGMENTS {
            let short = SHORT * (time - self.start);
            let open = self.segments.pop();
            let mut kept: Vec<ModeSegment> = Vec::new();
            for s in &self.segments {
                let mode = s.mode.filter(|_| s.to - s.from >= short);
                match kept.last_mut() {
                    Some(last) if last.mode.is_none() && mode.is_none() && last.to == s.from => last.to = s.to,
                    _ => kept.push(ModeSegment { mode, ..*s }),
                }
            }
            kept.extend(open);
            self.segments = kept;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_survives_a_million_rows() {
        let mut d = Decimated::new([0.0, 1.0], INTERVALS);
        for k in 0..1_000_000 {
            let value = if k == 654_321 { 50.0 } else { (k as f64 * 1e-3).sin() };
            d.push(k as f64 * 1e-6, value);
        }
        assert!(d.intervals.len() <= 2 * INTERVALS && d.intervals.len() >= INTERVALS);
        let pieces = d.pieces();
        assert_eq!(pieces.len(), 1);
        assert!(pieces[0].contains(&[654_321.0 * 1e-6, 50.0]));
        assert_eq!(pieces[0][0], [0.0, 0.0]);
        assert_eq!(pieces[0].last().unwrap()[0], 999_999.0 * 1e-6);
        assert!(pieces[0].windows(2).all(|w| w[0][0] <= w[1][0]));
    }

    #[test]
    fn few_rows_are_kept_as_they_are_also_of_a_run_that_ends_early() {
        let mut d = Decimated::new([0.0, 100.0], INTERVALS);
        let rows: Vec<[f64; 2]> = (0..400).map(|k| [k as f64 * 1e-3, f64::from(k % 7)]).collect();
        rows.iter().for_each(|r| d.push(r[0], r[1]));
        assert_eq!(d.pieces(), [rows]);
    }

    #[test]
    fn a_jump_keeps_both_its_values_and_a_gap_stays_open() {
        let mut d = Decimated::new([0.0, 1.0], INTERVALS);
        for (t, v) in [(0.0, 1.0), (0.5, 1.0), (0.5, 3.0), (0.6, f64::NAN), (0.7, f64::NAN), (0.8, 2.0), (1.0, 2.0)] {
            d.push(t, v);
        }
        assert_eq!(d.pieces(), [vec![[0.0, 1.0], [0.5, 1.0], [0.5, 3.0]], vec![[0.8, 2.0], [1.0, 2.0]]]);
    }

    #[test]
    fn shifts_are_short_times_with_events_of_one_width() {
        let found = shifts(&[3.0, 3.1, 3.2, 6.0, 6.4, 9.0], [0.0, 20.0]);
        assert_eq!(found.iter().map(|s| s.1).collect::<Vec<_>>(), [[3.0, 3.2], [6.0, 6.4], [9.0, 9.0]]);
        for ([from, to], [first, last]) in &found {
            assert!((to - from - 0.6).abs() < 1e-9 && from < first && last < to);
        }
        // One shift, no time at all, and events all the time.
        assert!(shifts(&[3.0, 3.2], [0.0, 20.0]).is_empty());
        assert!(shifts(&[3.0, 6.0], [0.0, 20.0]).is_empty());
        assert!(shifts(&[3.0, 7.0, 9.0], [0.0, 20.0]).is_empty());
        let all: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k)).collect();
        assert!(shifts(&all, [0.0, 20.0]).is_empty());
    }

    #[test]
    fn a_window_keeps_the_values_at_its_ends() {
        let piece = [[0.0, 0.0], [1.0, 10.0], [1.0, 20.0], [3.0, 40.0]];
        assert_eq!(clipped(&piece, [0.5, 2.0]), [[0.5, 5.0], [1.0, 10.0], [1.0, 20.0], [2.0, 30.0]]);
        assert_eq!(clipped(&piece, [1.5, 2.0]), [[1.5, 25.0], [2.0, 30.0]]);
        assert_eq!(clipped(&piece, [3.5, 4.0]), [] as [[f64; 2]; 0]);
    }

    #[test]
    fn modes_that_change_too_fast_become_one_segment() {
        let mut m = Modes::new(0.0);
        m.push(0.0, 1.0);
        for k in 0..20_000 {
            m.push(0.5 + 1e-6 * f64::from(k), f64::from(k % 2));
        }
        m.push(0.6, 0.0);
        m.push(1.0, 0.0);
        assert!(m.segments.len() <= MOST_SEGMENTS);
        assert_eq!(m.segments[0], ModeSegment { from: 0.0, to: 0.5, mode: Some(ModeLabel::Forward) });
        assert_eq!(m.segments[1].mode, None);
        let last = m.segments.last().unwrap();
        assert_eq!((last.mode, last.to), (Some(ModeLabel::Stuck), 1.0));
        assert!(m.segments.windows(2).all(|w| w[0].to == w[1].from));
    }
}
