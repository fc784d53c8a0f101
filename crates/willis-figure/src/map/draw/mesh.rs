//! A map as triangles in which values are linear. No triangle lies across a border of zones, so regions end and lines break
//! exactly where the map says.

use std::collections::BTreeMap;

use crate::parts::chart::Chart;
use crate::{EfficiencyMap, MapPoint};

/// A place on the page.
pub type Place = (f64, f64);

/// A value at a place.
#[derive(Clone, Copy)]
struct Corner {
    at: Place,
    /// NaN where there is none.
    loss: f64,
    power: f64,
}

/// What contours are drawn of.
#[derive(Clone, Copy)]
pub enum Height {
    /// One less the efficiency.
    Loss,
    /// Power into the train, W.
    Power,
}

impl Height {
    fn of(self, c: &Corner) -> f64 {
        match self {
            Self::Loss => c.loss,
            Self::Power => c.power,
        }
    }
}

/// A part of a cell of the grid within one zone.
struct Piece {
    /// A point of the map in this zone.
    point: usize,
    triangles: Vec<[Corner; 3]>,
}

/// The map on the page.
pub struct Mesh<'m> {
    map: &'m EfficiencyMap,
    pieces: Vec<Piece>,
}

impl<'m> Mesh<'m> {
    pub fn new(map: &'m EfficiencyMap, chart: &Chart) -> Self {
        let borders = map.borders.iter().map(|b| (b.between, b)).collect::<BTreeMap<_, _>>();
        let width = map.x.values.len();
        let place = |k: usize| (chart.x(map.x.values[k % width]), chart.y(map.y.values[k / width]));
        let corner = |at: Place, p: &MapPoint| Corner {
            at,
            loss: p.efficiency.map_or(f64::NAN, |e| 1.0 - e),
            power: p.input_power_w.unwrap_or(f64::NAN),
        };
        // Where the border between two points is, and the values on the side of each; and whether the map jumps there.
        let crossing = |a: usize, b: usize| {
            let border = borders.get(&[a.min(b), a.max(b)])?;
            let [from, to] = border.between.map(place);
            let at = (from.0 + border.at * (to.0 - from.0), from.1 + border.at * (to.1 - from.1));
            let mut sides = [0, 1].map(|k| corner(at, &border.sides[k]));
            let ends = border.between.map(|k| corner(at, &map.points[k]));
            // What is the same within what a step of the search changes is the same.
            let step = (ends[0].loss - sides[0].loss).abs().max((ends[1].loss - sides[1].loss).abs());
            let apart = (sides[0].loss - sides[1].loss).abs();
            let jumps = apart.is_nan() || apart > 1e-6 + 0.02 * step;
            if !jumps {
                let mean = |of: fn(&Corner) -> f64| (of(&sides[0]) + of(&sides[1])) / 2.0;
                let (loss, power) = (mean(|c| c.loss), mean(|c| c.power));
                sides = [Corner { at, loss, power }; 2];
            }
            Some((if a < b { sides } else { [sides[1], sides[0]] }, jumps))
        };
        let mut pieces = vec![];
        for cell in (0..map.points.len().saturating_sub(width)).filter(|k| (k + 1) % width > 0) {
            let around = [cell, cell + 1, cell + 1 + width, cell + width];
            let crossings = [0, 1, 2, 3].map(|k| crossing(around[k], around[(k + 1) % 4]));
            let corners = around.map(|k| corner(place(k), &map.points[k]));
            let cuts: Vec<usize> = (0..4).filter(|k| crossings[*k].is_some()).collect();
            let apart = map.through(cell);
            let joint = (cuts.len() > 2 && apart.is_none()).then(|| {
                let all = cuts.iter().filter_map(|k| crossings[*k]);
                let smooth = all.clone().all(|c| !c.1);
                let all: Vec<Corner> = all.map(|c| c.0[0]).collect();
                let own = map.joints.iter().find(|j| j.cell == cell).map(|j| {
                    let [low, high] = [place(around[0]), place(around[2])];
                    (low.0 + j.at[0] * (high.0 - low.0), low.1 + j.at[1] * (high.1 - low.1))
                });
                let middle = middle(&all);
                (Corner { at: own.unwrap_or(middle.at), ..middle }, smooth)
            });
            let fan = |ring: &[Corner], centre: Corner, open: bool| -> Vec<[Corner; 3]> {
                let sides = ring.len() - usize::from(open);
                (0..sides).map(|k| [centre, ring[k], ring[(k + 1) % ring.len()]]).collect()
            };
            if cuts.is_empty() {
                pieces.push(Piece { point: cell, triangles: fan(&corners, middle(&corners), false) });
            }
            if let (Some(first), [Some(a), Some(b), Some(c), Some(d)]) = (apart, crossings) {
                // Two borders cross the cell beside each other: a zone lies between them, and each other has a corner.
                let sides = [a, b, c, d].map(|crossing| crossing.0);
                let edge = |k: usize, side: usize| sides[(first + k) % 4][side];
                let corner = |k: usize| corners[(first + k) % 4];
                let between = [corner(0), edge(0, 0), edge(1, 1), corner(2), edge(2, 0), edge(3, 1)];
                pieces.push(Piece { point: around[first], triangles: fan(&between, middle(&between), false) });
                for k in [1, 3] {
                    let own = [edge(k - 1, 1), corner(k), edge(k, 0)];
                    pieces.push(Piece { point: around[(first + k) % 4], triangles: vec![own] });
                }
                continue;
            }
            for (n, from) in cuts.iter().enumerate() {
                let to = cuts[(n + 1) % cuts.len()];
                // From one crossing to the next, the corners between them; then over the joint, if there is one.
                let between = (1..=4).map(|k| (from + k) % 4).take((to + 3 - from) % 4 + 1);
                let own: Vec<usize> = between.collect();
                let (Some((first, _)), Some((last, _))) = (crossings[*from], crossings[to]) else { continue };
                let mut ring = vec![first[1]];
                ring.extend(own.iter().map(|k| corners[*k]));
                ring.push(last[0]);
                let centre = match joint {
                    None => middle(&ring),
                    Some((joint, true)) => joint,
                    // Where the map jumps every side has values of its own there: those of its plane.
                    Some((joint, false)) => plane([ring[0], ring[ring.len() / 2], ring[ring.len() - 1]], joint.at),
                };
                // Round a joint the ring is open: its ends meet there.
                pieces.push(Piece { point: around[own[0]], triangles: fan(&ring, centre, joint.is_some()) });
            }
        }
        Self { map, pieces }
    }

    /// The outlines of where a point of the map is of some kind.
    pub fn region(&self, is: impl Fn(&MapPoint) -> bool) -> Vec<Vec<Place>> {
        let own = self.pieces.iter().filter(|p| is(&self.map.points[p.point]));
        outlines(own.flat_map(|p| &p.triangles).map(|t| t.iter().map(|c| c.at).collect()))
    }

    /// Its middle, and its part of the map.
    pub fn middle(&self, is: impl Fn(&MapPoint) -> bool) -> (Place, f64) {
        let (mut own, mut sum, mut all) = (0.0, (0.0, 0.0), 0.0);
        for p in &self.pieces {
            for [a, b, c] in p.triangles.iter().map(|t| t.map(|c| c.at)) {
                let area = ((b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1)).abs();
                all += area;
                if is(&self.map.points[p.point]) {
                    own += area;
                    sum = (sum.0 + area * (a.0 + b.0 + c.0) / 3.0, sum.1 + area * (a.1 + b.1 + c.1) / 3.0);
                }
            }
        }
        ((sum.0 / own, sum.1 / own), own / all)
    }

    /// Whether a place is where a point of the map is of some kind.
    pub fn holds(&self, place: Place, is: impl Fn(&MapPoint) -> bool) -> bool {
        let left = |a: Place, b: Place| (b.0 - a.0) * (place.1 - a.1) - (place.0 - a.0) * (b.1 - a.1);
        let inside = |t: &[Corner; 3]| {
            let sides = [0, 1, 2].map(|k| left(t[k].at, t[(k + 1) % 3].at));
            sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0)
        };
        let own = self.pieces.iter().filter(|p| is(&self.map.points[p.point]));
        own.flat_map(|p| &p.triangles).any(inside)
    }

    /// The outlines of where as much is lost, or more.
    pub fn above(&self, loss: f64) -> Vec<Vec<Place>> {
        let clipped = |t: &[Corner; 3]| {
            let mut ring = vec![];
            for k in 0..3 {
                let (a, b) = (&t[k], &t[(k + 1) % 3]);
                if a.loss >= loss {
                    ring.push(a.at);
                }
                if (a.loss >= loss) != (b.loss >= loss) {
                    ring.push(on(a, b, Height::Loss, loss));
                }
            }
            ring
        };
        let known = self.pieces.iter().flat_map(|p| &p.triangles).filter(|t| t.iter().all(|c| c.loss.is_finite()));
        outlines(known.map(clipped))
    }

    /// The lines at a height.
    pub fn lines(&self, of: Height, level: f64) -> Vec<Vec<Place>> {
        let known = self.pieces.iter().flat_map(|p| &p.triangles);
        let segment = |t: &[Corner; 3]| {
            if !t.iter().all(|c| of.of(c).is_finite()) {
                return None;
            }
            let above = |c: &Corner| of.of(c) >= level;
            let ends: Vec<Place> = (0..3)
                .map(|k| (&t[k], &t[(k + 1) % 3]))
                .filter(|(a, b)| above(a) != above(b))
                .map(|(a, b)| on(a, b, of, level))
                .collect();
            match ends[..] {
                [a, b] if a != b => Some((a, b)),
                _ => None,
            }
        };
        strung(known.filter_map(segment).collect())
    }
}

fn middle(all: &[Corner]) -> Corner {
    let mean = |of: &dyn Fn(&Corner) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
    Corner { at: (mean(&|c| c.at.0), mean(&|c| c.at.1)), loss: mean(&|c| c.loss), power: mean(&|c| c.power) }
}

/// The values at a place on the plane through three corners; their mean where they lie on one line.
fn plane([a, b, c]: [Corner; 3], at: Place) -> Corner {
    let from = |p: Place| (p.0 - a.at.0, p.1 - a.at.1);
    let (u, v, p) = (from(b.at), from(c.at), from(at));
    let across = u.0 * v.1 - u.1 * v.0;
    if across.abs() < 1e-9 {
        return Corner { at, ..middle(&[a, b, c]) };
    }
    let (s, t) = ((p.0 * v.1 - p.1 * v.0) / across, (u.0 * p.1 - u.1 * p.0) / across);
    let of = |f: fn(&Corner) -> f64| f(&a) + s * (f(&b) - f(&a)) + t * (f(&c) - f(&a));
    Corner { at, loss: of(|c| c.loss), power: of(|c| c.power) }
}

/// The place of a level between two corners; the same to the last bit from both triangles that share them.
fn on(a: &Corner, b: &Corner, of: Height, level: f64) -> Place {
    let (a, b) = if bits(a.at) < bits(b.at) { (a, b) } else { (b, a) };
    let t = (level - of.of(a)) / (of.of(b) - of.of(a));
    (a.at.0 + t * (b.at.0 - a.at.0), a.at.1 + t * (b.at.1 - a.at.1))
}

type Bits = (u64, u64);

fn bits(p: Place) -> Bits {
    (p.0.to_bits(), p.1.to_bits())
}

fn place(b: Bits) -> Place {
    (f64::from_bits(b.0), f64::from_bits(b.1))
}

/// The outlines of areas that share sides: sides that two of them have are gone.
fn outlines(areas: impl Iterator<Item = Vec<Place>>) -> Vec<Vec<Place>> {
    let mut sides: BTreeMap<Bits, Vec<Bits>> = BTreeMap::new();
    for area in areas {
        for (k, a) in area.iter().enumerate() {
            let (a, b) = (bits(*a), bits(area[(k + 1) % area.len()]));
            let back = sides.get(&b).and_then(|all| all.iter().position(|c| *c == a));
            match back {
                _ if a == b => {}
                Some(at) => {
                    sides.get_mut(&b).map(|all| all.swap_remove(at));
                }
                None => sides.entry(a).or_default().push(b),
            }
        }
    }
    let mut all = vec![];
    while let Some((&start, _)) = sides.iter().find(|s| !s.1.is_empty()) {
        let (mut ring, mut at) = (vec![], start);
        while let Some(next) = sides.get_mut(&at).and_then(Vec::pop) {
            ring.push(place(at));
            at = next;
        }
        sides.retain(|_, next| !next.is_empty());
        ring.push(ring[0]);
        let mut ring = straightened(ring);
        ring.pop();
        if ring.len() > 2 {
            all.push(ring);
        }
    }
    all
}

/// Segments as lines.
fn strung(segments: Vec<(Place, Place)>) -> Vec<Vec<Place>> {
    let mut ends: BTreeMap<Bits, Vec<usize>> = BTreeMap::new();
    for (k, (a, b)) in segments.iter().enumerate() {
        ends.entry(bits(*a)).or_default().push(k);
        ends.entry(bits(*b)).or_default().push(k);
    }
    let mut used = vec![false; segments.len()];
    let mut all = vec![];
    // Open lines from their ends first, then the closed ones.
    let open = ends.iter().filter(|e| e.1.len() == 1).map(|e| *e.0);
    let starts: Vec<Bits> = open.chain(ends.keys().copied()).collect();
    for start in starts {
        let (mut at, mut line) = (start, vec![place(start)]);
        while let Some(k) = ends[&at].iter().copied().find(|k| !used[*k]) {
            used[k] = true;
            let (a, b) = segments[k];
            let next = if bits(a) == at { b } else { a };
            line.push(next);
            at = bits(next);
        }
        if line.len() > 1 {
            all.push(straightened(line));
        }
    }
    all
}

/// The same line without places on a straight part of it.
fn straightened(line: Vec<Place>) -> Vec<Place> {
    /// So far beside its neighbours a place may lie to be left out, pixels.
    const STRAIGHT: f64 = 0.02;
    let mut kept: Vec<Place> = vec![];
    let mut from = 0;
    for (k, p) in line.iter().enumerate() {
        if let Some(last) = kept.last()
            && line[from + 1..k].iter().any(|q| beside(*q, *last, *p) > STRAIGHT)
        {
            kept.push(line[k - 1]);
            from = k - 1;
        }
        if kept.is_empty() {
            kept.push(*p);
        }
    }
    kept.extend(line.last());
    kept
}

/// How far a place lies from the way between two others.
fn beside(q: Place, a: Place, b: Place) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let square = dx * dx + dy * dy;
    let t = if square > 0.0 { (((q.0 - a.0) * dx + (q.1 - a.1) * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (q.0 - a.0 - t * dx).hypot(q.1 - a.1 - t * dy)
}
