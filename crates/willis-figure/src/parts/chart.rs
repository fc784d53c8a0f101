//! Axes: a frame with a grid, numbers and titles, and the way from values to places.

use svg::node::element::{Group, Path};

use crate::parts::alive::guide;
use crate::parts::style::{Anchor, FAINT, LINE, fit, line, number, rectangle, text, ticks, wide};
use crate::parts::words::along;

/// Grid lines.
pub const GRID: &str = "#e4e4e4";

/// A quantity along one side of a chart.
pub struct Scale {
    pub low: f64,
    pub high: f64,
    /// With its unit.
    pub title: String,
}

impl Scale {
    /// From the values it shows; with some room where they are all alike.
    pub fn of(values: impl Iterator<Item = f64>, title: impl Into<String>) -> Self {
        let (low, high) =
            values.filter(|v| v.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low > high { (0.0, 1.0) } else { (low, high) };
        let room = if high - low > 1e-9 * high.abs().max(low.abs()) { 0.0 } else { 0.5 * high.abs().max(1e-3) };
        Self { low: low - room, high: high + room, title: title.into() }
    }

    /// Efficiencies in per cent: never above 100, and one per cent high at least, so that a level line looks level.
    pub fn efficiency(values: impl Iterator<Item = f64>) -> Self {
        let own = Self::of(values, "Efficiency, %");
        let (low, high) = (own.low.max(0.0), own.high.min(100.0));
        if own.high - own.low < 1.0 || own.high > 100.0 || own.low < 0.0 {
            let middle = (own.low + own.high) / 2.0;
            let high = (middle + 0.5).ceil().clamp(1.0, 100.0).max(high);
            return Self { low: low.min(high - 1.0).max((middle - 0.5).floor().max(0.0)), high, ..own };
        }
        Self { low, high, ..own }.rounded()
    }

    /// Numbers at even steps, about so many; the scale may run downwards.
    fn ticks(&self, about: usize) -> Vec<f64> {
        ticks(self.low.min(self.high), self.low.max(self.high), about)
    }

    /// To the next full tick at both ends.
    pub fn rounded(self) -> Self {
        let all = ticks(self.low, self.high, 5);
        let [a, b, ..] = all[..] else { return self };
        let step = b - a;
        Self { low: (self.low / step).floor() * step, high: (self.high / step - 1e-9).ceil() * step, ..self }
    }
}

/// A chart's place on the page: pixels of its frame.
pub struct Chart {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
    pub x: Scale,
    pub y: Scale,
}

impl Chart {
    pub fn x(&self, value: f64) -> f64 {
        self.left + (value - self.x.low) / (self.x.high - self.x.low) * (self.right - self.left)
    }

    pub fn y(&self, value: f64) -> f64 {
        self.bottom - (value - self.y.low) / (self.y.high - self.y.low) * (self.bottom - self.top)
    }

    /// The grid, to be drawn below what the chart shows.
    pub fn grid(&self) -> Group {
        let mut g = guide(Group::new());
        for t in self.ticks_x() {
            g = g.add(line((self.x(t), self.top), (self.x(t), self.bottom), GRID, 1.0));
        }
        for t in self.ticks_y() {
            g = g.add(line((self.left, self.y(t)), (self.right, self.y(t)), GRID, 1.0));
        }
        g
    }

    /// Frame, numbers and titles, to be drawn above it.
    pub fn frame(&self) -> Group {
        let mut g = guide(Group::new()).add(
            rectangle(self.left, self.top, self.right - self.left, self.bottom - self.top, "none")
                .set("stroke", LINE)
                .set("stroke-width", 1),
        );
        let (xs, ys) = (self.ticks_x(), self.ticks_y());
        for (t, label) in xs.iter().zip(labels(&xs)) {
            g = g.add(text(self.x(*t), self.bottom + 16.0, 11.0, Anchor::Middle, &label).set("fill", FAINT));
        }
        let mut widest = 0.0f64;
        for (t, label) in ys.iter().zip(labels(&ys)) {
            widest = widest.max(wide(&label, 11.0));
            g = g.add(text(self.left - 7.0, self.y(*t) + 4.0, 11.0, Anchor::End, &label).set("fill", FAINT));
        }
        let (middle_x, middle_y) = ((self.left + self.right) / 2.0, (self.top + self.bottom) / 2.0);
        let x_title = fit(&self.x.title, self.right - self.left, 12.0);
        let y_title = fit(&self.y.title, self.bottom - self.top, 12.0);
        let at = self.left - 7.0 - widest - 12.0;
        let turn = format!("rotate(-90 {} {})", number(at), number(middle_y));
        g.add(text(middle_x, self.bottom + 36.0, 12.0, Anchor::Middle, &x_title))
            .add(text(at, middle_y, 12.0, Anchor::Middle, &y_title).set("transform", turn))
    }

    fn ticks_x(&self) -> Vec<f64> {
        self.x.ticks(((self.right - self.left) / 80.0).max(3.0) as usize)
    }

    fn ticks_y(&self) -> Vec<f64> {
        self.y.ticks(((self.bottom - self.top) / 45.0).max(2.0) as usize)
    }

    /// A line through points; broken where one is missing, none where all are.
    pub fn path(&self, points: impl IntoIterator<Item = (f64, Option<f64>)>) -> Option<Path> {
        let mut d = String::new();
        let mut pen = false;
        for (x, y) in points {
            match y {
                Some(y) => {
                    d += &format!("{}{} {} ", if pen { 'L' } else { 'M' }, number(self.x(x)), number(self.y(y)));
                    pen = true;
                }
                None => pen = false,
            }
        }
        let line = || Path::new().set("d", d.trim_end().to_owned()).set("fill", "none").set("stroke-linejoin", "round");
        (!d.is_empty()).then(line)
    }

    /// The areas between two lines, one for each run of values that are all there.
    pub fn areas(&self, points: &[(f64, Option<[f64; 2]>)]) -> Vec<Path> {
        let there = |run: &&[(f64, Option<[f64; 2]>)]| run.len() > 1 && run[0].1.is_some();
        let runs = points.chunk_by(|a, b| a.1.is_some() == b.1.is_some());
        let one = |run: &[(f64, Option<[f64; 2]>)]| {
            let side = |which: usize| run.iter().filter_map(move |(x, y)| Some((*x, y.as_ref()?[which])));
            let back: Vec<_> = side(1).collect();
            let all = side(0).chain(back.into_iter().rev());
            let points: Vec<String> =
                all.map(|(x, y)| format!("{} {}", number(self.x(x)), number(self.y(y)))).collect();
            Path::new().set("d", format!("M{} Z", points.join(" L")))
        };
        runs.filter(there).map(one).collect()
    }
}

/// Numbers at ticks, with the decimals that their step needs.
fn labels(all: &[f64]) -> Vec<String> {
    let step = all.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
    let most = all.iter().fold(0.0f64, |a, t| a.max(t.abs()));
    if most >= 1e6 || (most > 0.0 && most < 1e-3) {
        return all.iter().map(|t| crate::parts::style::digits(*t)).collect();
    }
    let decimals =
        if step.is_finite() && step > 0.0 { (-(step.log10() + 1e-9).floor()).clamp(0.0, 6.0) as usize } else { 0 };
    if !step.is_finite() {
        return all.iter().map(|t| crate::parts::style::digits(*t)).collect();
    }
    all.iter()
        .map(|t| {
            let text = format!("{:.decimals$}", if t.abs() < 1e-12 * most { 0.0 } else { *t });
            text.replace('-', "−")
        })
        .collect()
}

/// `sun.speed` and its unit as the title of an axis.
pub fn title(axis: &crate::ChartAxis) -> String {
    // A name of the file keeps its letters.
    let named = ["speed", "torque", "power", "temperature"].iter().any(|what| axis.name.ends_with(what));
    let words = along(&axis.name);
    let mut letters = words.chars();
    let first = letters.next().map(|c| if named { c.to_ascii_uppercase() } else { c }).into_iter();
    let name: String = first.chain(letters).collect();
    match axis.unit.as_str() {
        "" => name,
        "degC" => format!("{name}, °C"),
        unit => format!("{name}, {unit}"),
    }
}
