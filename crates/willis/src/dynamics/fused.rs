//! A step in one mode as a single affine map, with every condition under which the mode goes on.
//!
//! Within a mode all is linear: the speeds after a step and the margins of the mode (a slip that keeps its sign, a held
//! group within what holds it, a mesh whose drive does not reverse) are sums over the speeds before it
//! and over what enters it. One small product says both where the step ends and whether it may be taken.

use super::element::Loss;
use super::fixed::groups::{GroupStep, UNBOUNDED};
use super::fixed::map::StepMap;
use super::fixed::shafts::ShaftStep;
use super::mode::Side;
use super::rounding::NOISE;
use super::system::System;

/// Rows come in blocks of as many, so that the product runs without a remainder.
pub(super) const BLOCK: usize = 4;

/// The affine map of a step in a mode.
#[derive(Clone)]
pub(super) struct Fused {
    /// Speeds after the step, then margins, then zeros up to a whole number of blocks.
    pub rows: usize,
    pub free: usize,
    /// The end of the margins.
    pub checked: usize,
    pub mode: Exactly,
    /// Speeds before the step, then inputs.
    width: usize,
    /// By blocks of rows, the part of each column in one piece.
    weights: Vec<f64>,
}

/// What tells a mode from others: by group whether it is held, slides forward, or has nothing to hold it; by element
/// its side, for teeth at rest the sign of the torque in them.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub(super) struct Exactly {
    pub held: u64,
    pub forward: u64,
    pub idle: u64,
    pub coast: u64,
    /// Contacts of the shafts.
    pub touch: u64,
}

impl Exactly {
    fn has(word: u64, k: usize) -> bool {
        word >> k & 1 == 1
    }

    fn side(&self, element: usize) -> Side {
        if Self::has(self.coast, element) { Side::Coast } else { Side::Drive }
    }

    fn sign(&self, group: usize) -> f64 {
        if Self::has(self.forward, group) { 1.0 } else { -1.0 }
    }
}

impl Fused {
    /// From the map of a mode over torques of ports and slips of groups; `h` is the length of the step.
    pub fn new(
        s: &System,
        groups: &[GroupStep],
        teeth: &[(usize, f64, Loss)],
        shafts: &[ShaftStep],
        map: &StepMap,
        mode: &Exactly,
        h: f64,
    ) -> Self {
        let (free, all, cols) = (s.free, s.all(), s.ports + groups.len());
        let (drivers, frictions) = (s.drivers.len(), s.frictions.len());
        let one = drivers + frictions + s.elastic.len();
        let width = all + one + 1;
        // A sum over the torques of the ports, as a sum over speeds and inputs.
        let widen = |row: &[f64]| -> Vec<f64> {
            let mut x = vec![0.0; width];
            for (k, driver) in s.drivers.iter().enumerate() {
                match driver.prescribed {
                    Some(i) => {
                        let per_step = row[s.port_of_prescribed + i] / h;
                        x[all + k] += per_step;
                        x[free + i] -= per_step;
                    }
                    None => x[all + k] += row[driver.port.expect("a torque")],
                }
            }
            for f in &s.frictions {
                for (x, w) in x.iter_mut().zip(&f.row) {
                    *x -= row[f.port] * f.viscous * w;
                }
            }
            for (k, e) in s.elastic.iter().enumerate() {
                let [spring, damper, constant] = shafts[k].resists();
                x[all + drivers + frictions + k] -= row[e.port] * spring;
                x[all + one] -= row[e.port] * constant;
                x.iter_mut().zip(&e.row).for_each(|(x, w)| *x -= row[e.port] * damper * w);
            }
            for (g, group) in groups.iter().enumerate() {
                let per_step = row[s.ports + g] / h;
                for i in 0..free {
                    x[i] += per_step * group.row[i];
                }
                for (k, driver) in s.drivers.iter().enumerate() {
                    if let Some(i) = driver.prescribed {
                        x[all + k] += per_step * group.row[free + i];
                    }
                }
                if Exactly::has(mode.held, g) || Exactly::has(mode.idle, g) {
                    continue;
                }
                let sign = mode.sign(g);
                for rub in group.rubs.iter().filter(|r| !r.is_rigid) {
                    x[all + drivers + rub.friction] -= sign * rub.factor.signum() * row[rub.port];
                }
                for &(j, port, [drive, coast]) in &group.constants {
                    let torque = if mode.side(j) == Side::Drive { drive } else { coast };
                    x[all + one] += sign * teeth[j].1.signum() * torque * row[port];
                }
            }
            x
        };
        let add = |x: &mut [f64], y: &[f64], factor: f64| x.iter_mut().zip(y).for_each(|(x, y)| *x += factor * y);
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for (i, row) in map.rows[..free * cols].chunks_exact(cols).enumerate() {
            let mut row = widen(row);
            row.iter_mut().for_each(|x| *x *= h);
            row[i] += 1.0;
            rows.push(row);
        }
        // A sum over the speeds at the end of the step.
        let at_end = |of: &[f64], factor: f64| -> Vec<f64> {
            let mut row = vec![0.0; width];
            for (next, w) in rows.iter().zip(of) {
                add(&mut row, next, factor * w);
            }
            for (k, driver) in s.drivers.iter().enumerate() {
                if let Some(i) = driver.prescribed {
                    row[all + k] += factor * of[free + i];
                }
            }
            row
        };
        let slides = |g: &usize| !Exactly::has(mode.held, *g) && !Exactly::has(mode.idle, *g);
        let mut margins: Vec<Vec<f64>> =
            (0..groups.len()).filter(slides).map(|g| at_end(&groups[g].row, mode.sign(g))).collect();
        for (k, shaft) in shafts.iter().enumerate() {
            for [twist, rate, constant] in shaft.margins() {
                let mut row = at_end(&s.elastic[k].row, rate);
                row[all + drivers + frictions + k] += twist;
                row[all + one] += constant;
                margins.push(row);
            }
        }
        rows.append(&mut margins);
        let mut lines = map.rows[free * cols..].chunks_exact(cols);
        let mut still = map.still.iter();
        for &g in &map.held {
            let group = &groups[usize::from(g)];
            let force = widen(lines.next().expect("a row for each"));
            let mut margins = [force.clone(), force];
            scale(&mut margins[0], group.lead.1);
            scale(&mut margins[1], -group.lead.1);
            for rub in &group.rubs {
                let friction = &s.frictions[rub.friction];
                for (k, margin) in margins.iter_mut().enumerate() {
                    match friction.blocks {
                        Some(blocks) => {
                            let along = f64::from(blocks) * rub.factor;
                            if (along > 0.0) == (k == 0) {
                                margin[all + one] += UNBOUNDED * rub.factor.abs();
                            }
                        }
                        None => margin[all + drivers + rub.friction] += rub.factor.abs() * friction.peak,
                    }
                }
            }
            // What teeth at rest can hold is a kinked function of the torque in them; either of its pieces is a
            // safe bound, and this is the one that is right for the present sign of that torque.
            for &j in &group.elements {
                let (_, row) = still.next().expect("a row for each");
                let (_, factor, loss) = teeth[j];
                let torque = widen(row);
                let ((up, up_one), (down, down_one)) = match mode.side(j) {
                    Side::Drive => ((loss.drive, loss.drive_torque), (-loss.coast, loss.coast_torque)),
                    Side::Coast => ((loss.coast, loss.coast_torque), (-loss.drive, loss.drive_torque)),
                };
                let pieces = [(up, up_one), (down, down_one)];
                let order = if factor > 0.0 { [0, 1] } else { [1, 0] };
                for (margin, piece) in margins.iter_mut().zip(order) {
                    let (slope, constant) = pieces[piece];
                    add(margin, &torque, factor.abs() * slope);
                    margin[all + one] += factor.abs() * constant;
                }
            }
            rows.extend(margins);
        }
        for (&j, line) in map.moving.iter().zip(lines) {
            let j = usize::from(j);
            let (g, factor, loss) = teeth[j];
            let along = if mode.side(j) == Side::Drive { 1.0 } else { -1.0 };
            let mut row = widen(line);
            scale(&mut row, along * mode.sign(g) * factor.signum() * (loss.drive - loss.coast));
            row[all + one] += along * (loss.drive_torque - loss.coast_torque);
            rows.push(row);
        }
        let checked = rows.len();
        rows.resize(checked.next_multiple_of(BLOCK), vec![0.0; width]);
        let of_block =
            |block: &[Vec<f64>]| (0..width).flat_map(|c| block.iter().map(move |row| row[c])).collect::<Vec<_>>();
        let weights = rows.chunks_exact(BLOCK).flat_map(of_block).collect();
        Self { rows: rows.len(), free, checked, mode: *mode, width, weights }
    }

    /// How many numbers it is made of.
    pub fn size(&self) -> usize {
        self.weights.len()
    }

    /// By block of rows: the weights of each column, the speeds first.
    #[inline(always)]
    fn blocks(&self) -> impl Iterator<Item = &[[f64; BLOCK]]> {
        self.weights.chunks_exact(BLOCK * self.width).map(|block| block.as_chunks().0)
    }

    /// The columns of speeds and of inputs that are not level, each block of rows in one piece.
    pub fn pack(&self, speeds: usize, varying: &[usize], packed: &mut Vec<f64>) {
        packed.clear();
        for block in self.blocks() {
            let columns = (0..speeds).chain(varying.iter().map(|k| speeds + k));
            packed.extend(columns.flat_map(|k| block[k]));
        }
    }

    /// Where the step ends, and whether every margin is at least as large as `least` says; what is no number breaks too.
    ///
    /// A block of rows is summed up in registers: first its part of level inputs, then speeds and inputs that are not level.
    #[inline(always)]
    pub fn ends(
        &self,
        [v, inputs]: [&[f64]; 2],
        varying: &[usize],
        [base, least]: [&[f64]; 2],
        ends: &mut [f64],
    ) -> bool {
        let rows = base.as_chunks().0.iter().zip(least.as_chunks().0).zip(ends.as_chunks_mut().0);
        let mut holds = [true; BLOCK];
        for (((base, least), end), block) in rows.zip(self.blocks()) {
            let (of_speeds, of_inputs) = block.split_at(v.len());
            let mut sum: [f64; BLOCK] = *base;
            let mut add = |weights: &[f64; BLOCK], x: f64| {
                (0..BLOCK).for_each(|k| sum[k] += weights[k] * x);
            };
            of_speeds.iter().zip(v).for_each(|(weights, x)| add(weights, *x));
            varying.iter().for_each(|&k| add(&of_inputs[k], inputs[k]));
            let least: &[f64; BLOCK] = least;
            (0..BLOCK).for_each(|k| holds[k] &= sum[k] >= least[k]);
            *end = sum;
        }
        holds == [true; BLOCK]
    }

    /// The part of level inputs, and for each row how negative it may be from round-off.
    pub fn settle(&self, v: &[f64], inputs: &[f64], varying: &[usize], base: &mut Vec<f64>, least: &mut Vec<f64>) {
        base.clear();
        base.resize(self.rows, 0.0);
        least.clear();
        least.resize(self.rows, 0.0);
        for (k, x) in v.iter().chain(inputs).enumerate().filter(|(_, x)| **x != 0.0) {
            let is_level = k >= v.len() && !varying.contains(&(k - v.len()));
            let rows = base.as_chunks_mut().0.iter_mut().zip(least.as_chunks_mut().0).zip(self.blocks());
            for ((base, least), block) in rows {
                let (base, least): (&mut [f64; BLOCK], &mut [f64; BLOCK]) = (base, least);
                for ((b, l), w) in base.iter_mut().zip(least).zip(block[k]) {
                    let part = w * x;
                    *l -= NOISE * part.abs();
                    if is_level {
                        *b += part;
                    }
                }
            }
        }
        least[..self.free].fill(f64::NEG_INFINITY);
    }
}

/// By how many times its round-off a margin is far from its edge.
pub(super) const FAR: f64 = 1e3;

impl Fused {
    /// Whether every margin is far from its edge at these speeds and inputs; what [`settle`](Self::settle) gave, and
    /// room for the ends of the step.
    pub fn holds_by_far(&self, of: [&[f64]; 2], varying: &[usize], settled: [&[f64]; 2], ends: &mut Vec<f64>) -> bool {
        ends.resize(self.rows, 0.0);
        self.ends(of, varying, settled, ends);
        let least = settled[1];
        let margins = self.free..self.checked;
        ends[margins.clone()]
            .iter()
            .zip(&least[margins])
            .fold(true, |holds, (end, least)| holds & (*end > -FAR * least))
    }
}

fn scale(x: &mut [f64], factor: f64) {
    x.iter_mut().for_each(|x| *x *= factor);
}
