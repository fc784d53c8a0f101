//! Bands of constant width: across the picture, or round above it.

use crate::parts::style::number;

/// Distance of hatching lines along a band.
const HATCH: f64 = 7.0;

/// A band with two edges; in a step, the edges run side by side.
#[derive(Clone, Debug)]
pub struct Ribbon {
    start: [(f64, f64); 2],
    steps: Vec<Step>,
    width: f64,
    back: bool,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    /// Straight to both points.
    Line([(f64, f64); 2]),
    /// A level S to both points.
    Bend([(f64, f64); 2]),
    /// A quarter turn to both points; horizontally first or not.
    Turn([(f64, f64); 2], bool),
}

impl Step {
    fn ends(self) -> [(f64, f64); 2] {
        match self {
            Self::Line(e) | Self::Bend(e) | Self::Turn(e, _) => e,
        }
    }
}

fn point(p: (f64, f64)) -> String {
    format!("{} {}", number(p.0), number(p.1))
}

/// Handle of a cubic that stands for a quarter circle.
const QUARTER: f64 = 0.552_284_75;

/// The control points between two ends.
fn handles(step: Step, a: (f64, f64), edge: usize) -> Option<[(f64, f64); 2]> {
    let b = step.ends()[edge];
    match step {
        Step::Line(_) => None,
        Step::Bend(_) => {
            let m = (a.0 + b.0) / 2.0;
            Some([(m, a.1), (m, b.1)])
        }
        Step::Turn(_, true) => Some([(a.0 + QUARTER * (b.0 - a.0), a.1), (b.0, b.1 - QUARTER * (b.1 - a.1))]),
        Step::Turn(_, false) => Some([(a.0, a.1 + QUARTER * (b.1 - a.1)), (b.0 - QUARTER * (b.0 - a.0), b.1)]),
    }
}

fn on_cubic(a: (f64, f64), h: [(f64, f64); 2], b: (f64, f64), t: f64) -> (f64, f64) {
    let s = 1.0 - t;
    let mix = |p: [f64; 4]| s * s * s * p[0] + 3.0 * s * s * t * p[1] + 3.0 * s * t * t * p[2] + t * t * t * p[3];
    (mix([a.0, h[0].0, h[1].0, b.0]), mix([a.1, h[0].1, h[1].1, b.1]))
}

impl Ribbon {
    /// Level, from x to x, between two heights.
    pub fn straight(from: f64, to: f64, y: [f64; 2]) -> Self {
        let start = y.map(|y| (from, y));
        Self { start, steps: vec![Step::Line(y.map(|y| (to, y)))], width: y[1] - y[0], back: false }
    }

    /// From left to right: level through each column (from x, to x, upper edge), bent between them.
    pub fn across(columns: &[[f64; 3]], width: f64) -> Self {
        let both = |x: f64, y: f64| [(x, y), (x, y + width)];
        let first = columns[0];
        let mut steps = vec![Step::Line(both(first[1], first[2]))];
        for c in &columns[1..] {
            steps.push(Step::Bend(both(c[0], c[2])));
            steps.push(Step::Line(both(c[1], c[2])));
        }
        Self { start: both(first[0], first[2]), steps, width, back: false }
    }

    /// From the right side of a node up, back to the left, down, and into the left side of another.
    ///
    /// The edges begin at `from` (x, upper edge) and end at `to`; they rise with their inner edge at
    /// `rise`, come down with their inner edge at `fall`, and run with their lower edge at `lane`.
    /// `inset` is how far this band lies from the ribbon's inner edge.
    pub fn round(from: (f64, f64), to: (f64, f64), [rise, fall, lane]: [f64; 3], r: f64, inset: f64, w: f64) -> Self {
        // Both edges by their distance from the inner one.
        let edges = |f: &dyn Fn(f64) -> (f64, f64)| [f(inset), f(inset + w)];
        let steps = vec![
            Step::Line(edges(&|d| (rise - r, from.1 + d))),
            Step::Turn(edges(&|d| (rise + d, from.1 - r)), true),
            Step::Line(edges(&|d| (rise + d, lane + r))),
            Step::Turn(edges(&|d| (rise - r, lane - d)), false),
            Step::Line(edges(&|d| (fall + r, lane - d))),
            Step::Turn(edges(&|d| (fall - d, lane + r)), true),
            Step::Line(edges(&|d| (fall - d, to.1 - r))),
            Step::Turn(edges(&|d| (fall + r, to.1 + d)), false),
            Step::Line(edges(&|d| (to.0, to.1 + d))),
        ];
        Self { start: edges(&|d| (from.0, from.1 + d)), steps, width: w, back: true }
    }

    pub fn width(&self) -> f64 {
        self.width
    }

    /// One of its edges from the beginning, or the middle of both.
    fn edge(&self, of: &dyn Fn([(f64, f64); 2]) -> (f64, f64)) -> String {
        let mut d = format!("M{}", point(of(self.start)));
        let mut at = self.start;
        for s in &self.steps {
            let end = s.ends();
            d += &match (handles(*s, at[0], 0), handles(*s, at[1], 1)) {
                (Some(h), Some(i)) => {
                    let h = [of([h[0], i[0]]), of([h[1], i[1]])];
                    format!(" C{} {} {}", point(h[0]), point(h[1]), point(of(end)))
                }
                _ => format!(" L{}", point(of(end))),
            };
            at = end;
        }
        d
    }

    /// The middle of the band.
    pub fn spine(&self) -> String {
        self.edge(&|e| ((e[0].0 + e[1].0) / 2.0, (e[0].1 + e[1].1) / 2.0))
    }

    /// The band as an area: along one edge and back along the other.
    pub fn outline(&self) -> String {
        let mut d = self.edge(&|e| e[0]);
        let last = self.steps.last().map_or(self.start, |s| s.ends());
        d += &format!(" L{}", point(last[1]));
        for k in (0..self.steps.len()).rev() {
            let before = if k == 0 { self.start } else { self.steps[k - 1].ends() };
            d += &match handles(self.steps[k], before[1], 1) {
                Some(h) => format!(" C{} {} {}", point(h[1]), point(h[0]), point(before[1])),
                None => format!(" L{}", point(before[1])),
            };
        }
        d + " Z"
    }

    /// Pairs of opposite points at about even distances.
    fn sections(&self, apart: f64) -> Vec<[(f64, f64); 2]> {
        let mut all = vec![self.start];
        let mut at = self.start;
        for s in &self.steps {
            let end = s.ends();
            let middle = |e: [(f64, f64); 2]| ((e[0].0 + e[1].0) / 2.0, (e[0].1 + e[1].1) / 2.0);
            let (a, b) = (middle(at), middle(end));
            let long = (b.0 - a.0).hypot(b.1 - a.1) * if matches!(s, Step::Line(_)) { 1.0 } else { 1.1 };
            let count = (long / apart).round().max(1.0) as usize;
            for k in 1..=count {
                let t = k as f64 / count as f64;
                let on = |edge: usize| match handles(*s, at[edge], edge) {
                    Some(h) => on_cubic(at[edge], h, end[edge], t),
                    None => (at[edge].0 + t * (end[edge].0 - at[edge].0), at[edge].1 + t * (end[edge].1 - at[edge].1)),
                };
                all.push([on(0), on(1)]);
            }
            at = end;
        }
        all
    }

    /// Slanted lines from edge to edge.
    pub fn hatching(&self) -> String {
        let all = self.sections(HATCH / 2.0);
        // From every second section to the next but one: the lines slant and keep their distance.
        let lines = all.iter().step_by(2).zip(all.iter().skip(2).step_by(2));
        lines.map(|(a, b)| format!("M{} L{}", point(a[0]), point(b[1]))).collect::<Vec<_>>().join(" ")
    }

    /// The points of the middle, for what must keep clear of it.
    pub fn points(&self) -> Vec<(f64, f64)> {
        self.sections(4.0).iter().map(|e| ((e[0].0 + e[1].0) / 2.0, (e[0].1 + e[1].1) / 2.0)).collect()
    }

    /// Where arrow heads show that it runs to the left.
    pub fn on_the_way_back(&self) -> Vec<(f64, f64)> {
        if !self.back {
            return vec![];
        }
        let (a, b) = (self.steps[3].ends(), self.steps[4].ends());
        let y = (a[0].1 + a[1].1) / 2.0;
        [0.2, 0.8].map(|t| (a[0].0 + t * (b[0].0 - a[0].0), y)).to_vec()
    }
}
