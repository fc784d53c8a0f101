//! Where nodes, ribbons and words stand.
//!
//! A column holds a layer: nodes with their words, and ribbons that pass between them, all level.
//! Ribbons bend, rise and come down only in the gaps between columns, where their words stand too.
//! So nothing crosses a node or its words.

use std::collections::BTreeMap;

use super::ribbon::Ribbon;
use super::words::{SMALL, Words};
use crate::parts::style::{BOLD, wide};
use crate::{SankeyFlow, SankeyNode};

/// Width of a node.
pub const BAR: f64 = 10.0;
pub const LINE_HEIGHT: f64 = 14.0;
/// Inner radius of a loss.
pub const TURN: f64 = 5.0;
/// Length of the tail of an input and of the head of an output.
pub const END: f64 = 30.0;
/// Width of the largest power.
const WIDEST: f64 = 92.0;
/// The same where power is led back, and the rising ribbons widen the picture.
const WIDEST_ROUND: f64 = 58.0;
/// Least room beside a node and between columns, and the most that a ribbon takes to bend: usual, and tight.
const SPACING: [[f64; 3]; 2] = [[16.0, 50.0, 120.0], [6.0, 22.0, 70.0]];
/// The same in a panel, where words of neighbours may stand over each other's columns.
const BRIEF: [[f64; 3]; 2] = [[2.0, 7.0, 28.0], [0.0, 3.0, 12.0]];
/// Half the width of the words that a column of a panel has room for; and the most that a panel adds to a gap.
const BRIEF_WORDS: f64 = 13.0;
const BRIEF_GAP: f64 = 90.0;
/// Inner radius of what is led back.
const ROUND: f64 = 8.0;
/// How many times its words a gap is wide, where a narrow ribbon is steep in it.
const STEEP_ROOM: f64 = 2.4;
/// Least room between nodes of a column.
const APART: f64 = 12.0;

/// How many times wider losses may be than power, and how wide the largest becomes so at most, pixels.
const WIDER: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
const WIDEST_LOSS: f64 = 18.0;

/// Half the width of a loss's arrow head, and its length.
pub fn head_of(width: f64) -> f64 {
    (width / 2.0 + 3.5).min(width / 2.0 * 1.25 + 4.0)
}

/// What a bar stands out beyond its power.
pub fn pad(height: f64) -> f64 {
    ((8.0 - height) / 2.0).max(1.5)
}

#[derive(Clone, Copy, Debug)]
struct Column {
    left: f64,
    right: f64,
}

/// The room that a column takes.
#[derive(Clone, Copy, Debug, Default)]
struct Room {
    /// For ribbons that come down before it, and rise behind it.
    channels: [f64; 2],
    /// Half its width.
    half: f64,
    /// To the next, for ribbons to bend.
    bend: f64,
}

/// What stays while powers change: pixels for a watt, and the columns.
#[derive(Clone, Debug)]
pub struct Frame {
    scale: f64,
    widened: f64,
    columns: Vec<Column>,
    width: f64,
    brief: bool,
}

impl Frame {
    /// For a panel of a screen: names, losses and what goes round, as wide as the panel if that suffices, and no higher than it
    /// where the powers can be drawn that small. Losses are so many times wider than power, or as wide as they can be seen.
    pub fn of_panel(flows: &[&SankeyFlow], [width, height]: [f64; 2], losses: Option<f64>) -> Self {
        let full = flows.iter().map(|f| Layout::scale_of(f)).fold(f64::INFINITY, f64::min);
        let mut frame = Self::brief(flows, full, width, losses);
        for part in [0.8, 0.64, 0.5, 0.4, 0.3, 0.22] {
            let tall = flows.iter().map(|f| Layout::within(f, &frame, &mut BTreeMap::new()).height).fold(0.0, f64::max);
            if tall <= height {
                break;
            }
            frame = Self::brief(flows, part * full, width, losses);
        }
        frame
    }

    fn brief(flows: &[&SankeyFlow], scale: f64, width: f64, losses: Option<f64>) -> Self {
        let seen = || flows.iter().map(|f| Layout::widening(f, scale)).fold(WIDER[WIDER.len() - 1], f64::min);
        let widened = losses.unwrap_or_else(seen);
        let [mut rooms, tight] = BRIEF.map(|spacing| Self::rooms(flows, scale, widened, spacing, true));
        if spread(&rooms).1 > width {
            rooms = tight;
        }
        let narrow = spread(&rooms).1;
        let gaps = rooms.len().saturating_sub(1).max(1) as f64;
        let more = ((width - narrow) / gaps).clamp(0.0, BRIEF_GAP);
        rooms.iter_mut().for_each(|r| r.bend += more);
        let (columns, width) = spread(&rooms);
        Self { scale, widened, columns, width, brief: true }
    }

    /// The room that each column takes in all of these flows.
    fn rooms(flows: &[&SankeyFlow], scale: f64, widened: f64, spacing: [f64; 3], brief: bool) -> Vec<Room> {
        let mut rooms: Vec<Room> = Vec::new();
        for flow in flows {
            let mut own = Layout::blank(flow, scale, widened, brief);
            own.stack_columns();
            for (k, r) in own.rooms_of_columns(spacing).into_iter().enumerate() {
                if k == rooms.len() {
                    rooms.push(Room::default());
                }
                let all = &mut rooms[k];
                all.channels = [0, 1].map(|c| all.channels[c].max(r.channels[c]));
                all.half = all.half.max(r.half);
                all.bend = all.bend.max(r.bend);
            }
        }
        rooms
    }

    /// That has room for all of these flows, at the scale of the one that needs most.
    pub fn of(flows: &[&SankeyFlow], room: f64) -> Self {
        let scale = flows.iter().map(|f| Layout::scale_of(f)).fold(f64::INFINITY, f64::min);
        let widened = flows.iter().map(|f| Layout::widening(f, scale)).fold(WIDER[WIDER.len() - 1], f64::min);
        let of = |spacing: [f64; 3]| {
            let rooms = Self::rooms(flows, scale, widened, spacing, false);
            let (columns, width) = spread(&rooms);
            Self { scale, widened, columns, width, brief: false }
        };
        let usual = of(SPACING[0]);
        if usual.width <= room { usual } else { of(SPACING[1]) }
    }

    /// How many times wider losses are than power.
    pub fn widened(&self) -> f64 {
        self.widened
    }

    /// The columns of a flow that has more of them go on behind.
    fn columns(&self, layers: usize) -> Vec<Column> {
        let mut all = self.columns.clone();
        while all.len() < layers {
            let left = all.last().map_or(0.0, |c| c.right + SPACING[0][1]);
            all.push(Column { left, right: left + 2.0 * (BAR / 2.0 + END) });
        }
        all
    }
}

/// Columns beside each other; and how wide they are together.
fn spread(rooms: &[Room]) -> (Vec<Column>, f64) {
    let mut x = 0.0;
    let mut columns = Vec::with_capacity(rooms.len());
    for (k, r) in rooms.iter().enumerate() {
        x += r.channels[0];
        columns.push(Column { left: x, right: x + 2.0 * r.half });
        x += 2.0 * r.half + r.channels[1];
        if k + 1 < rooms.len() {
            x += r.bend;
        }
    }
    (columns, x)
}

/// Where the words of a link stand on its way: in which gap, at which part of it, and how far beside it, in steps.
pub type Spot = (usize, f64, usize);

/// Steps that words may stand beside their ribbon; at none they stand on it.
const STEPS: usize = 40;

/// How wide a ribbon is, and points of its middle.
type Band = (f64, Vec<(f64, f64)>);

/// Places for the words of a link in a gap.
struct Spots<'a, 'f> {
    layout: &'a Layout<'f>,
    link: usize,
    gap: usize,
    /// Width and height of the words.
    size: [f64; 2],
    /// Where the gap begins and ends.
    sides: [f64; 2],
    /// Points of the link within it.
    way: Vec<(f64, f64)>,
    /// The links that run there, with as much of them.
    near: Vec<(usize, Band)>,
}

impl Spots<'_, '_> {
    /// Words at a part of the way, so many steps beside it; and what that place costs. None where other words stand.
    fn at(&self, part: f64, step: usize) -> Option<(f64, Label)> {
        let [wide, tall] = self.size;
        let [left, right] = self.sides;
        let spot = self.way.get((part * self.way.len() as f64) as usize)?;
        let x = spot.0.clamp(left + wide / 2.0, (right - wide / 2.0).max(left + wide / 2.0));
        let thick = self.layout.thickness(self.link);
        let beside = (thick + tall) / 2.0 + 1.0;
        // How far the words would stick out of their own ribbon: letters are lower than their rows.
        let stray = |y: f64| {
            let near = self.way.iter().filter(|p| (p.0 - x).abs() <= wide / 2.0);
            let far = near.fold(0.0f64, |a, p| a.max((p.1 - y).abs()));
            (far + tall / 2.0 - 3.0 - thick / 2.0).max(0.0)
        };
        let (dy, far) = match step.checked_sub(1) {
            // On a narrow ribbon words still belong to it more clearly than beyond another.
            None => (0.0, (2.5 * stray(spot.1)).min(if thick < LINE_HEIGHT { 24.0 } else { 12.0 })),
            Some(k) => {
                let far = 5.0 * (k / 2) as f64;
                (if k % 2 == 0 { -beside - far } else { beside + far }, far + 2.0)
            }
        };
        let y = spot.1 + dy;
        let place = Label {
            link: self.link,
            x: [x - wide / 2.0, x + wide / 2.0],
            y: [y - tall / 2.0, y + tall / 2.0],
            clear: false,
        };
        if self.layout.labels.iter().any(|o| o.meets(&place)) {
            return None;
        }
        let others = || self.near.iter().filter(|(k, _)| *k != self.link).map(|(_, r)| r);
        let within = |p: &(f64, f64)| place.x[0] <= p.0 && p.0 <= place.x[1];
        // How much of a ribbon the words would cover, in rows and points.
        let covered = |(thick, points): &Band| -> f64 {
            let one = |p: &(f64, f64)| {
                let [low, high] = [p.1 - thick / 2.0, p.1 + thick / 2.0];
                let both = high.min(place.y[1]) - low.max(place.y[0]);
                (both / LINE_HEIGHT).max(0.0)
            };
            points.iter().filter(|p| within(p)).map(one).sum()
        };
        let crossed: f64 = others().map(covered).sum();
        let beyond = |(thick, points): &Band| {
            let [low, high] = [spot.1.min(y), spot.1.max(y)];
            let lies = |p: &&(f64, f64)| within(p) && low < p.1 - thick / 2.0 && p.1 + thick / 2.0 < high;
            points.iter().filter(lies).count()
        };
        let behind: usize = others().map(beyond).sum();
        let own: f64 = self.near.iter().filter(|(k, _)| step > 0 && *k == self.link).map(|(_, r)| covered(r)).sum();
        let l = &self.layout.flow.links[self.link];
        let cost = far
            + 2.0 * crossed
            + 4.0 * behind as f64
            + 2.0 * own
            + 12.0 * (part - 0.5f64).abs()
            + 2.0 * (self.gap - self.layout.flow.nodes[l.from].layer) as f64;
        let clear = step == 0 && stray(y) == 0.0 && crossed == 0.0 && l.circulating_w == 0.0;
        Some((cost, Label { clear, ..place }))
    }
}

/// Words at a link.
pub struct Label {
    pub link: usize,
    pub x: [f64; 2],
    pub y: [f64; 2],
    /// Nothing but one plain ribbon lies behind.
    pub clear: bool,
}

impl Label {
    pub fn middle(&self) -> f64 {
        (self.x[0] + self.x[1]) / 2.0
    }

    fn meets(&self, o: &Self) -> bool {
        let near = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] + 2.0 && b[0] < a[1] + 2.0;
        near(self.x, o.x) && near(self.y, o.y)
    }
}

pub struct Layout<'f> {
    pub flow: &'f SankeyFlow,
    pub words: Words,
    brief: bool,
    /// Pixels for a watt.
    pub scale: f64,
    /// So many times wider losses are drawn: what is lost is little, and would not be seen.
    pub widened: f64,
    pub width: f64,
    pub height: f64,
    /// By node: the upper end of its power.
    pub top: Vec<f64>,
    pub labels: Vec<Label>,
    columns: Vec<Column>,
    /// By link: upper edges in the columns that it passes.
    passes: Vec<Vec<f64>>,
    /// By link that is led back: where it rises, comes down, and runs.
    rounds: Vec<Option<[f64; 3]>>,
}

/// Something in a column: half heights are around the upper end of its power.
struct Item {
    node: Option<usize>,
    /// Of a passing ribbon: link, and which of its passes.
    pass: (usize, usize),
    above: f64,
    below: f64,
    y: f64,
}

impl<'f> Layout<'f> {
    /// As wide as looks good, or tighter where there is less room than that.
    pub fn new(flow: &'f SankeyFlow, room: f64) -> Self {
        let usual = Self::spaced(flow, SPACING[0]);
        if usual.width <= room { usual } else { Self::spaced(flow, SPACING[1]) }
    }

    fn spaced(flow: &'f SankeyFlow, spacing: [f64; 3]) -> Self {
        let scale = Self::scale_of(flow);
        let mut own = Self::blank(flow, scale, Self::widening(flow, scale), false);
        own.stack_columns();
        (own.columns, own.width) = spread(&own.rooms_of_columns(spacing));
        own.finish(&mut BTreeMap::new());
        own
    }

    /// Within a frame that stays, with words where they stood.
    pub fn within(flow: &'f SankeyFlow, frame: &Frame, spots: &mut BTreeMap<(String, String), Spot>) -> Self {
        let mut own = Self::blank(flow, frame.scale, frame.widened, frame.brief);
        own.stack_columns();
        own.columns = frame.columns(flow.layers);
        own.width = own.columns.last().map_or(0.0, |c| c.right).max(frame.width);
        own.finish(spots);
        own
    }

    /// Pixels for a watt of a picture by itself.
    fn scale_of(flow: &SankeyFlow) -> f64 {
        let largest = flow.nodes.iter().fold(f64::MIN_POSITIVE, |a, n| a.max(n.power_w));
        let round = flow.links.iter().any(|l| l.back);
        let widest = if round { WIDEST_ROUND } else { WIDEST };
        widest / largest
    }

    fn widening(flow: &SankeyFlow, scale: f64) -> f64 {
        let lost = |n: &SankeyNode| n.losses.iter().map(|l| l.power_w).sum::<f64>();
        let most = flow.nodes.iter().map(lost).fold(f64::MIN_POSITIVE, f64::max);
        WIDER.into_iter().rev().find(|times| times * most * scale <= WIDEST_LOSS).unwrap_or(1.0)
    }

    fn blank(flow: &'f SankeyFlow, scale: f64, widened: f64, brief: bool) -> Self {
        Self {
            flow,
            words: Words::of(flow, brief),
            brief,
            scale,
            widened,
            width: 0.0,
            height: 0.0,
            top: vec![0.0; flow.nodes.len()],
            labels: vec![],
            columns: vec![],
            passes: flow.links.iter().map(|l| vec![0.0; l.rows.len()]).collect(),
            rounds: vec![None; flow.links.len()],
        }
    }

    fn finish(&mut self, spots: &mut BTreeMap<(String, String), Spot>) {
        self.lead_round();
        self.place_labels(spots);
        self.move_to_corner();
    }

    pub fn middle(&self, layer: usize) -> f64 {
        (self.columns[layer].left + self.columns[layer].right) / 2.0
    }

    /// Whether a link has words of its own: not where an input or output says the same.
    fn told(&self, k: usize) -> bool {
        let l = &self.flow.links[k];
        if self.brief {
            return false;
        }
        let (from, to) = (&self.flow.nodes[l.from], &self.flow.nodes[l.to]);
        let same = |end: f64| (end - l.power_w).abs() <= 1e-9 * l.power_w;
        !(l.via.is_empty() && (same(from.input_w) || same(to.output_w)))
    }

    /// Rooms above and below the upper end of a node's power.
    fn rooms(&self, n: &SankeyNode) -> [f64; 2] {
        let height = n.power_w * self.scale;
        let head = self.words.head(n).len() as f64;
        let mut below = height + pad(height) + 2.0;
        if let Some(first) = n.losses.first() {
            let width = (n.power_w - first.offset_w) * self.scale * self.widened;
            let rows = self.words.foot(n).len() as f64;
            below = height + TURN + 4.0 + head_of(width) + LINE_HEIGHT * (rows + 0.2);
        }
        if n.output_w > 0.0 {
            below = below.max(n.output_w * self.scale + 7.0);
        }
        [pad(height) + 5.0 + LINE_HEIGHT * head, below]
    }

    /// Heights: every item as near to its neighbours in the flow as the order of its column allows.
    fn stack_columns(&mut self) {
        let mut columns: Vec<Vec<(usize, Item)>> = (0..self.flow.layers).map(|_| vec![]).collect();
        for (k, n) in self.flow.nodes.iter().enumerate() {
            let [above, below] = self.rooms(n);
            columns[n.layer].push((n.row, Item { node: Some(k), pass: (0, 0), above, below, y: 0.0 }));
        }
        for (j, l) in self.flow.links.iter().enumerate() {
            for (step, row) in l.rows.iter().enumerate() {
                let below = (l.power_w * self.scale).max(1.0) + 3.0;
                let item = Item { node: None, pass: (j, step), above: 3.0, below, y: 0.0 };
                columns[self.flow.nodes[l.from].layer + 1 + step].push((*row, item));
            }
        }
        for c in &mut columns {
            c.sort_by_key(|i| i.0);
            let total: f64 = c.iter().map(|i| i.1.above + i.1.below + APART).sum();
            let mut y = -total / 2.0;
            for (_, i) in c.iter_mut() {
                i.y = y + i.above;
                y += i.above + i.below + APART;
            }
            self.note(c);
        }
        for round in 0..24 {
            // From the left, from the right, and at last by both sides.
            let sides: &[bool] = if round >= 18 { &[true, false] } else { &[[true, false][round % 2]] };
            for k in 0..columns.len() {
                let k = if sides == [false] { columns.len() - 1 - k } else { k };
                let wishes: Vec<(f64, f64)> = columns[k].iter().map(|(_, i)| self.wish(i, sides)).collect();
                settle(&mut columns[k], &wishes);
                self.note(&columns[k]);
            }
        }
    }

    fn note(&mut self, column: &[(usize, Item)]) {
        for (_, i) in column {
            match i.node {
                Some(k) => self.top[k] = i.y,
                None => self.passes[i.pass.0][i.pass.1] = i.y,
            }
        }
    }

    /// Upper edges of a link along its way, ends included.
    fn heights(&self, j: usize) -> Vec<f64> {
        let l = &self.flow.links[j];
        let mut all = vec![self.top[l.from] + l.from_offset_w * self.scale];
        all.extend(&self.passes[j]);
        all.push(self.top[l.to] + l.to_offset_w * self.scale);
        all
    }

    /// Where an item would have its links straight, and how much it matters.
    fn wish(&self, i: &Item, sides: &[bool]) -> (f64, f64) {
        let (mut sum, mut weight) = (0.0, 0.0);
        let mut pull = |y: f64, power: f64| {
            sum += y * power;
            weight += power;
        };
        for (j, l) in self.flow.links.iter().enumerate().filter(|(_, l)| !l.back) {
            let heights = self.heights(j);
            for &left in sides {
                match i.node {
                    Some(k) if left && l.to == k => {
                        pull(heights[heights.len() - 2] - l.to_offset_w * self.scale, l.power_w);
                    }
                    Some(k) if !left && l.from == k => pull(heights[1] - l.from_offset_w * self.scale, l.power_w),
                    None if i.pass.0 == j => pull(heights[if left { i.pass.1 } else { i.pass.1 + 2 }], l.power_w),
                    _ => {}
                }
            }
        }
        if weight > 0.0 { (sum / weight, weight * self.scale) } else { (i.y, 0.01) }
    }

    /// The ribbons that rise right of a column or come down left of it, the innermost first.
    fn beside(&self, layer: usize, right: bool) -> Vec<usize> {
        let l = |k: &usize| &self.flow.links[*k];
        let end = |k: &usize| if right { l(k).from } else { l(k).to };
        let mut all: Vec<usize> =
            (0..self.flow.links.len()).filter(|k| l(k).back && self.flow.nodes[end(k)].layer == layer).collect();
        let height = |k: &usize| {
            let offset = if right { l(k).from_offset_w } else { l(k).to_offset_w };
            self.top[end(k)] + offset * self.scale
        };
        all.sort_by(|a, b| height(a).total_cmp(&height(b)));
        all
    }

    fn thickness(&self, k: usize) -> f64 {
        (self.flow.links[k].power_w * self.scale).max(1.0)
    }

    /// Room of ribbons that rise or come down.
    fn channel(&self, layer: usize, right: bool) -> f64 {
        let all = self.beside(layer, right);
        let sum: f64 = all.iter().map(|k| self.thickness(*k) + 6.0).sum();
        if all.is_empty() { 0.0 } else { sum + ROUND + 4.0 }
    }

    fn rooms_of_columns(&self, [beside, between, bend]: [f64; 3]) -> Vec<Room> {
        let layers = self.flow.layers;
        let mut half = vec![BAR / 2.0 + beside; layers];
        for n in &self.flow.nodes {
            let texts = self
                .words
                .head(n)
                .iter()
                .enumerate()
                .map(|(k, t)| wide(t, SMALL) * if k == 0 { BOLD } else { 1.0 })
                .chain(self.words.foot(n).iter().map(|t| wide(t, SMALL)))
                .fold(0.0f64, f64::max);
            let lost: f64 = n.losses.iter().map(|l| l.power_w * self.scale * self.widened).sum();
            let ends = if n.input_w > 0.0 || n.output_w > 0.0 { BAR / 2.0 + END } else { 0.0 };
            let turn = if n.losses.is_empty() { 0.0 } else { BAR / 2.0 + TURN + lost + 6.0 };
            let texts = if self.brief { (texts / 2.0).min(BRIEF_WORDS) } else { texts / 2.0 + 4.0 };
            half[n.layer] = half[n.layer].max(texts).max(ends).max(turn);
        }
        let mut bends = vec![between; layers];
        for (j, l) in self.flow.links.iter().enumerate().filter(|(_, l)| !l.back) {
            let first = self.flow.nodes[l.from].layer;
            let heights = self.heights(j);
            for (k, w) in heights.windows(2).enumerate() {
                // Wide enough that the band does not look thin where it is steep.
                let fall = (w[1] - w[0]).abs();
                bends[first + k] = bends[first + k].max((0.5 * fall + 0.3 * self.thickness(j).min(fall)).min(bend));
            }
            if self.told(j) {
                let rows = self.words.link(l);
                let texts = rows.iter().map(|t| wide(t, SMALL)).fold(0.0f64, f64::max);
                // A narrow ribbon that is steep has no level part for its words: they need room beside it.
                let tall = LINE_HEIGHT * rows.len() as f64;
                let steep = self.thickness(j) < LINE_HEIGHT && (heights[1] - heights[0]).abs() > tall;
                bends[first] = bends[first].max(if steep { STEEP_ROOM * texts } else { texts } + 8.0);
            }
        }
        (0..layers)
            .map(|k| Room {
                channels: [false, true].map(|right| self.channel(k, right)),
                half: half[k],
                bend: bends[k],
            })
            .collect()
    }

    /// Lanes above all, the shortest way lowest.
    fn lead_round(&mut self) {
        let mut all: Vec<usize> = (0..self.flow.links.len()).filter(|&k| self.flow.links[k].back).collect();
        let layer = |n: usize| self.flow.nodes[n].layer;
        all.sort_by_key(|&k| layer(self.flow.links[k].from) - layer(self.flow.links[k].to));
        let mut channels = vec![[0.0; 2]; self.flow.links.len()];
        for k in 0..self.flow.layers {
            let mut x = self.columns[k].right + ROUND;
            for j in self.beside(k, true) {
                channels[j][0] = x;
                x += self.thickness(j) + 6.0;
            }
            let mut x = self.columns[k].left - ROUND;
            for j in self.beside(k, false) {
                channels[j][1] = x;
                x -= self.thickness(j) + 6.0;
            }
        }
        // The upper end of each column.
        let mut tops = vec![f64::INFINITY; self.flow.layers];
        for (k, n) in self.flow.nodes.iter().enumerate() {
            tops[n.layer] = tops[n.layer].min(self.top[k] - self.rooms(n)[0]);
        }
        for (l, passes) in self.flow.links.iter().zip(&self.passes) {
            for (k, y) in passes.iter().enumerate() {
                let column = &mut tops[layer(l.from) + 1 + k];
                *column = column.min(y - 3.0);
            }
        }
        // Lanes so far: from x to x, and how high they and their words reach.
        let mut lanes: Vec<([f64; 2], f64)> = Vec::new();
        for j in all.iter().copied() {
            let l = &self.flow.links[j];
            let thick = self.thickness(j);
            let [rise, fall] = channels[j];
            let span = [fall - thick - ROUND, rise + thick + ROUND];
            let below = tops[layer(l.to)..=layer(l.from)].iter().copied();
            let others = lanes.iter().filter(|o| o.0[0] < span[1] && span[0] < o.0[1]).map(|o| o.1);
            let start = self.top[l.from] + l.from_offset_w * self.scale - 2.0 * ROUND;
            let end = self.top[l.to] + l.to_offset_w * self.scale - 2.0 * ROUND;
            let lane = below.chain(others).map(|y| y - 8.0).fold(start.min(end), f64::min);
            self.rounds[j] = Some([rise, fall, lane]);
            let rows = self.words.link(l);
            let tall = LINE_HEIGHT * rows.len() as f64;
            let inside = thick >= tall - 2.0;
            let half = rows.iter().map(|t| wide(t, SMALL)).fold(0.0f64, f64::max) / 2.0 + 1.0;
            // In the middle, if nothing else rises or comes down there.
            let free = |x: &f64| {
                all.iter().filter(|k| **k != j).all(|&k| {
                    let other = self.thickness(k);
                    let [rise, fall] = channels[k];
                    [[rise, rise + other], [fall - other, fall]]
                        .iter()
                        .all(|c| c[1] < x - half - 2.0 || x + half + 2.0 < c[0])
                })
            };
            let places = [0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74].map(|t| fall + t * (rise - fall));
            let x = places.into_iter().find(free).unwrap_or(places[0]);
            let top = if inside { lane - (thick + tall) / 2.0 } else { lane - thick - 2.0 - tall };
            self.labels.push(Label { link: j, x: [x - half, x + half], y: [top, top + tall], clear: false });
            lanes.push((span, top.min(lane - thick)));
        }
    }

    /// A part of a link, between two powers from its upper edge.
    pub fn ribbon(&self, j: usize, [from, to]: [f64; 2]) -> Ribbon {
        let l = &self.flow.links[j];
        let (inset, width) = (from * self.scale, (to - from) * self.scale);
        let heights = self.heights(j);
        let start = self.middle(self.flow.nodes[l.from].layer) + BAR / 2.0;
        let end = self.middle(self.flow.nodes[l.to].layer) - BAR / 2.0;
        if let Some(ways) = self.rounds[j] {
            return Ribbon::round((start, heights[0]), (end, heights[1]), ways, ROUND, inset, width);
        }
        let first = self.flow.nodes[l.from].layer;
        let last = heights.len() - 1;
        let columns: Vec<[f64; 3]> = heights
            .iter()
            .enumerate()
            .map(|(k, y)| {
                let c = &self.columns[first + k];
                // Level beside what rises or comes down as well.
                let left = c.left - self.channel(first + k, false);
                let right = c.right + self.channel(first + k, true);
                [if k == 0 { start } else { left }, if k == last { end } else { right }, y + inset]
            })
            .collect();
        Ribbon::across(&columns, width)
    }

    /// Words of links, the strongest first: on the ribbon where it is wide enough, beside it else; where they stood before, as
    /// long as nothing else stands there.
    fn place_labels(&mut self, kept: &mut BTreeMap<(String, String), Spot>) {
        let mut order: Vec<usize> =
            (0..self.flow.links.len()).filter(|&k| !self.flow.links[k].back && self.told(k)).collect();
        order.sort_by(|&a, &b| self.flow.links[b].power_w.total_cmp(&self.flow.links[a].power_w));
        let ribbons: Vec<Band> = (0..self.flow.links.len())
            .map(|k| {
                let r = self.ribbon(k, [0.0, self.flow.links[k].power_w]);
                (self.thickness(k), r.points())
            })
            .collect();
        for j in order {
            let l = &self.flow.links[j];
            let rows = self.words.link(l);
            let tall = LINE_HEIGHT * rows.len() as f64;
            let wide = rows.iter().map(|t| wide(t, SMALL)).fold(0.0f64, f64::max) + 2.0;
            let first = self.flow.nodes[l.from].layer;
            let size = [wide, tall];
            let key = [l.from, l.to].map(|k| self.flow.nodes[k].id.clone()).into();
            let old = kept.get(&key).filter(|spot| (first..self.flow.nodes[l.to].layer).contains(&spot.0));
            let mut best =
                old.and_then(|spot| Some((*spot, self.spot(j, spot.0, size, &ribbons)?.at(spot.1, spot.2)?)));
            if best.is_none() {
                for gap in first..self.flow.nodes[l.to].layer {
                    let Some(spots) = self.spot(j, gap, size, &ribbons) else { continue };
                    for part in [0.5, 0.35, 0.65, 0.2, 0.8] {
                        for step in 0..=STEPS {
                            let Some((cost, label)) = spots.at(part, step) else { continue };
                            if best.as_ref().is_none_or(|b| cost < b.1.0) {
                                best = Some(((gap, part, step), (cost, label)));
                            }
                        }
                    }
                }
            }
            // Nothing vanishes: where no gap has room, below everything.
            let place = match best {
                Some((spot, (_, label))) => {
                    kept.insert(key, spot);
                    label
                }
                None => {
                    let rooms = self.flow.nodes.iter().enumerate().map(|(k, n)| self.top[k] + self.rooms(n)[1]);
                    let low = rooms.chain(self.labels.iter().map(|o| o.y[1])).fold(0.0, f64::max) + 8.0;
                    let x = self.middle(first).max(wide / 2.0);
                    Label { link: j, x: [x - wide / 2.0, x + wide / 2.0], y: [low, low + tall], clear: false }
                }
            };
            self.labels.push(place);
        }
    }

    /// The places for words of that size along a link in a gap between columns, if they fit in there: the first gap of a link
    /// has room for them.
    fn spot<'a>(&'a self, link: usize, gap: usize, size: [f64; 2], ribbons: &[Band]) -> Option<Spots<'a, 'f>> {
        let left = self.columns[gap].right + self.channel(gap, true);
        let right = self.columns[gap + 1].left - self.channel(gap + 1, false);
        if right - left < size[0] {
            return None;
        }
        let between = |margin: f64| move |p: &(f64, f64)| left - margin <= p.0 && p.0 <= right + margin;
        let way = ribbons[link].1.iter().copied().filter(between(0.0)).collect();
        let near = ribbons.iter().enumerate().filter_map(|(k, (thick, points))| {
            let points: Vec<_> = points.iter().copied().filter(between(1.0)).collect();
            (!points.is_empty()).then_some((k, (*thick, points)))
        });
        let near = near.collect();
        Some(Spots { layout: self, link, gap, size, sides: [left, right], way, near })
    }

    /// The upper left corner becomes the origin.
    fn move_to_corner(&mut self) {
        let (mut top, mut bottom) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut see = |a: f64, b: f64| {
            top = top.min(a);
            bottom = bottom.max(b);
        };
        for (k, n) in self.flow.nodes.iter().enumerate() {
            let [above, below] = self.rooms(n);
            see(self.top[k] - above, self.top[k] + below);
        }
        for (j, l) in self.flow.links.iter().enumerate() {
            self.passes[j].iter().for_each(|y| see(y - 3.0, y + l.power_w * self.scale + 3.0));
            if let Some([_, _, lane]) = self.rounds[j] {
                see(lane - self.thickness(j) - 3.0, lane);
            }
        }
        self.labels.iter().for_each(|l| see(l.y[0], l.y[1]));
        let shift = 2.0 - top;
        self.top.iter_mut().chain(self.passes.iter_mut().flatten()).for_each(|y| *y += shift);
        self.rounds.iter_mut().flatten().for_each(|r| r[2] += shift);
        self.labels.iter_mut().flat_map(|l| &mut l.y).for_each(|y| *y += shift);
        self.height = bottom - top + 6.0;
    }
}

/// Heights closest to the wishes that keep order and distance: neighbours that would meet form a
/// block, which goes where its weights want it.
fn settle(column: &mut [(usize, Item)], wishes: &[(f64, f64)]) {
    // Each item's distance from the first when all stand close together.
    let mut offset = vec![0.0; column.len()];
    for k in 1..column.len() {
        offset[k] = offset[k - 1] + column[k - 1].1.below + column[k].1.above + APART;
    }
    // Blocks: first item, weighted place of the first of all items, weight.
    let mut blocks: Vec<(usize, f64, f64)> = Vec::new();
    for (k, (y, weight)) in wishes.iter().enumerate() {
        let mut block = (k, y - offset[k], weight.max(1e-3));
        while let Some(last) = blocks.pop_if(|b| b.1 > block.1) {
            let weight = last.2 + block.2;
            block = (last.0, (last.1 * last.2 + block.1 * block.2) / weight, weight);
        }
        blocks.push(block);
    }
    for (n, b) in blocks.iter().enumerate() {
        let end = blocks.get(n + 1).map_or(column.len(), |b| b.0);
        for k in b.0..end {
            column[k].1.y = b.1 + offset[k];
        }
    }
}
