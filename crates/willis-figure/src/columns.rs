//! Sets as columns: where each set stands across a panel of a screen, the same in the stick diagram and in the levers beneath
//! it.
//!
//! On paper the schematic keeps one scale along its axis. On a screen each lever needs room for names and speeds, so the gaps
//! between sets are stretched; the sets themselves keep the scale.

use svg::node::element::Group;

use crate::parts::alive::{Of, of};
use crate::parts::style::{BOLD, rectangle, wide};
use crate::{Lever, LeverBar, Stick};

/// The ground of a column.
const GROUND: &str = "#f7f7f3";
/// What a lever needs at least, px, and from what on more is worth nothing; between them a part of what there is.
const NARROWEST: f64 = 128.0;
const WIDEST: f64 = 260.0;
const PART: f64 = 0.7;
/// Left of the first lever stand its names, right of the last its speeds, px.
const ENDS: [f64; 2] = [84.0, 62.0];
/// A step of the grid in a gap: two lines side by side can be told apart, px.
const STEP: f64 = 11.0;
/// An arrow of a terminal with the gap to its name, px.
const ARROW: f64 = 50.0;

/// A set across a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name; of a lever of several sets all of theirs.
    pub name: String,
    /// The middle of the set, and where its lever stands, px.
    pub x: f64,
    /// From where to where the column reaches, px.
    pub span: [f64; 2],
}

/// Where the sets of a train stand across a panel.
///
/// # Example
/// ```
/// use willis_figure::{Columns, LeverRequest, lever, lever_panel, stick, stick_panel};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
///     .build()?;
/// let (stick, lever) = (stick(&train, None)?, lever(&train, &LeverRequest::First)?);
/// let columns = Columns::new(&stick, &lever, 480.0);
/// assert_eq!(columns.all().len(), 1);
/// assert!(stick_panel(&stick, &columns, 240.0).contains("width=\"480\""));
/// assert!(lever_panel(&lever, &columns, 240.0, None).contains("data-value"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Width of both panels, px: what was asked, or more where the sets need it.
    pub width: f64,
    columns: Vec<Column>,
    /// Places of the grid of the schematic and where they are, px; between two of them the scale is even.
    knots: Vec<[f64; 2]>,
    aligned: bool,
    /// Left and right of the schematic, px.
    margin: f64,
}

impl Columns {
    /// Columns within a width in px.
    pub fn new(stick: &Stick, lever: &Lever, width: f64) -> Self {
        let names = stick.terminals.iter().map(|t| wide(&stick.members[t.member].name, 12.0) * BOLD);
        let margin = (names.fold(0.0, f64::max) + ARROW + 12.0).clamp(48.0, 150.0);
        match Blocks::of(stick, lever) {
            Some(blocks) => blocks.columns(lever, margin, width),
            None => Self::apart(stick, lever, margin, width),
        }
    }

    /// One for each lever, in their order.
    pub fn all(&self) -> &[Column] {
        &self.columns
    }

    /// Whether each set stands above its lever. Where sets of a schematic lie over each other they do not.
    pub fn aligned(&self) -> bool {
        self.aligned
    }

    /// Left and right of the schematic, px.
    pub(crate) fn margin(&self) -> f64 {
        self.margin
    }

    /// Where a place of the schematic's grid is, px.
    pub(crate) fn across(&self, x: f64) -> f64 {
        let k = self.knots[1..self.knots.len() - 1].iter().take_while(|knot| knot[0] < x).count();
        let [[a, from], [b, to]] = [self.knots[k], self.knots[k + 1]];
        if b > a { from + (x - a) / (b - a) * (to - from) } else { from }
    }

    /// Schematic and levers each evenly across, without regard to each other.
    fn apart(stick: &Stick, lever: &Lever, margin: f64, width: f64) -> Self {
        let n = lever.bars.len().max(1);
        let width = width.max(NARROWEST * (n - 1) as f64 + ENDS[0] + ENDS[1]).max(STEP * stick.width + 2.0 * margin);
        let each = ((width - ENDS[0] - ENDS[1]) / (n - 1).max(1) as f64).min(WIDEST);
        let first = (width - each * (n - 1) as f64) / 2.0 + (ENDS[0] - ENDS[1]) / 2.0;
        let middles: Vec<f64> = (0..n).map(|k| first + each * k as f64).collect();
        let knots = vec![[0.0, margin], [stick.width.max(1.0), width - margin]];
        Self { width, columns: between(lever, &middles, width), knots, aligned: false, margin }
    }

    /// The grounds of the columns, one beside the other.
    pub(crate) fn zones(&self, height: f64) -> Group {
        let zone = |c: &Column| {
            let ground = rectangle(c.span[0] + 1.0, 0.0, c.span[1] - c.span[0] - 2.0, height, GROUND);
            of(ground, "zone", &[Of::Mesh(&c.name)])
        };
        self.columns.iter().map(zone).fold(Group::new(), Group::add)
    }
}

/// Columns up to the middles between neighbours.
fn between(lever: &Lever, middles: &[f64], width: f64) -> Vec<Column> {
    let mut order: Vec<usize> = (0..middles.len()).collect();
    order.sort_by(|a, b| middles[*a].total_cmp(&middles[*b]));
    let rank = |k: usize| order.iter().position(|o| *o == k).expect("each is in the order");
    let one = |(k, bar): (usize, &LeverBar)| {
        let (x, place) = (middles[k], rank(k));
        let left = place.checked_sub(1).map_or(0.0, |p| (middles[order[p]] + x) / 2.0);
        let right = order.get(place + 1).map_or(width, |o| (middles[*o] + x) / 2.0);
        Column { name: bar.name(), x, span: [left, right] }
    };
    lever.bars.iter().enumerate().map(one).collect()
}

/// The sets of a schematic side by side, the first on the left.
struct Blocks {
    /// From where to where each reaches, in steps of the grid.
    spans: Vec<[f64; 2]>,
    /// Which of them stands above each lever.
    of: Vec<usize>,
    grid: f64,
}

impl Blocks {
    /// None where sets lie over each other, or a lever has no set of its own.
    fn of(stick: &Stick, lever: &Lever) -> Option<Self> {
        let mut order: Vec<usize> = (0..stick.blocks.len()).collect();
        order.sort_by(|a, b| stick.blocks[*a].span[0].total_cmp(&stick.blocks[*b].span[0]));
        let spans: Vec<[f64; 2]> = order.iter().map(|k| stick.blocks[*k].span).collect();
        if spans.is_empty() || spans.windows(2).any(|w| w[0][1] > w[1][0]) {
            return None;
        }
        let mut of = vec![];
        for bar in &lever.bars {
            let is = |k: &usize| bar.sets.iter().any(|s| s.name == stick.blocks[*k].name);
            // Several sets on one lever stand side by side: the lever stands under the first.
            let own = order.iter().position(is).filter(|k| !of.contains(k))?;
            of.push(own);
        }
        Some(Self { spans, of, grid: stick.width })
    }

    fn columns(self, lever: &Lever, margin: f64, width: f64) -> Columns {
        let n = self.spans.len();
        let lengths: Vec<f64> = self.spans.iter().map(|s| s[1] - s[0]).collect();
        // Steps of the grid between the sets, and beside the first and last.
        let mut gaps = vec![self.spans[0][0]];
        gaps.extend(self.spans.windows(2).map(|w| w[1][0] - w[0][1]));
        gaps.push(self.grid - self.spans[n - 1][1]);
        let widest = lengths.iter().fold(1.0, |a: f64, b| a.max(*b));
        let even = (width - 2.0 * margin) / self.grid.max(1.0);
        let unit = even.clamp(2.0 * STEP, 0.62 * NARROWEST / widest).max(STEP);
        let half = |k: usize| 0.5 * unit * lengths[k];
        let column = (PART * width / self.of.len().max(1) as f64).clamp(NARROWEST, WIDEST);
        let needs = |gap: usize| {
            let lines = STEP * gaps[gap];
            let has_lever = |k: usize| self.of.contains(&k);
            match gap {
                0 if has_lever(0) => lines.max(ENDS[0] - margin - half(0)),
                g if g == n && has_lever(n - 1) => lines.max(ENDS[1] - margin - half(n - 1)),
                g if g > 0 && g < n && has_lever(g - 1) && has_lever(g) => lines.max(column - half(g - 1) - half(g)),
                _ => lines,
            }
        };
        let least: Vec<f64> = (0..=n).map(needs).collect();
        let sets = unit * lengths.iter().sum::<f64>();
        let width = width.max(least.iter().sum::<f64>() + sets + 2.0 * margin);
        let room = width - sets - 2.0 * margin;
        // As even as the least gaps allow: one scale for all gaps that are wider than that.
        let total = |scale: f64| gaps.iter().zip(&least).map(|(g, l)| (scale * g).max(*l)).sum::<f64>();
        let (mut low, mut high) = (0.0, room.max(1.0));
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if total(middle) > room { high = middle } else { low = middle }
        }
        let mut px: Vec<f64> = gaps.iter().zip(&least).map(|(g, l)| (low * g).max(*l)).collect();
        // What no gap wants stands on both sides.
        let over = (room - px.iter().sum::<f64>()).max(0.0);
        px[0] += over / 2.0;
        let mut at = margin;
        let mut knots = vec![[0.0, margin]];
        let mut middles = vec![];
        for (k, span) in self.spans.iter().enumerate() {
            at += px[k];
            knots.push([span[0], at]);
            middles.push(at + half(k));
            at += unit * lengths[k];
            knots.push([span[1], at]);
        }
        knots.push([self.grid, at + px[n]]);
        let middles: Vec<f64> = self.of.iter().map(|k| middles[*k].round()).collect();
        Columns { width, columns: between(lever, &middles, width), knots, aligned: true, margin }
    }
}
