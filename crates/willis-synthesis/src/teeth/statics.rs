//! Efficiencies of many trains of one layout: every sign pattern of the powers in the meshes is solved, and those that
//! agree with themselves are the equilibria.
//!
//! The torque that a mesh passes on is that of a mesh without loss and another ratio: `x ρ` in place of `x`, with ρ the
//! efficiency if the first end drives and its inverse if the second does. Which end drives is a sign of the solution.
//! So there are 2^k linear systems for k meshes, and an efficiency never comes from a formula outside its range: where no
//! pattern agrees, friction locks the train; where several do, there are several equilibria.

use super::layout::{Factor, Layout, LayoutState};

/// What can be said of one direction of power.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Way {
    /// One equilibrium, with this efficiency.
    One(f64),
    /// No equilibrium in which power comes out: friction locks it.
    Locks,
    /// So many equilibria; the least and the greatest efficiency.
    Several(usize, [f64; 2]),
    /// Floating point cannot tell, or there are too many patterns; the certified solver must be asked.
    Unclear,
}

/// Speeds in a state for an input of one.
#[derive(Clone, Debug)]
pub(crate) struct Speeds {
    /// Of every node.
    nodes: Vec<f64>,
}

/// A state of a layout with tooth numbers.
pub(crate) struct Point<'l> {
    layout: &'l Layout,
    state: &'l LayoutState,
    /// Factor of each element, with its sense.
    factors: Vec<f64>,
    speeds: Speeds,
    /// Speed of the first end of each element relative to the carrier.
    relative: Vec<f64>,
}

/// More meshes than this have too many patterns to solve each.
const MOST_PATTERNS: usize = 10;
/// What is smaller than this part of the largest is not told from zero.
const NOTHING: f64 = 1e-10;

/// Solves a square system in place, the right side as the last column; none where it is singular.
fn solve(m: &mut [Vec<f64>]) -> Option<Vec<f64>> {
    let n = m.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|a, b| m[*a][k].abs().total_cmp(&m[*b][k].abs()))?;
        if m[pivot][k].abs() < 1e-13 {
            return None;
        }
        m.swap(k, pivot);
        let (above, below) = m.split_at_mut(k + 1);
        let row = &above[k];
        for other in below {
            let factor = other[k] / row[k];
            if factor != 0.0 {
                for j in k..=n {
                    other[j] -= factor * row[j];
                }
            }
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| m[k][j] * x[j]).sum();
        x[k] = (m[k][n] - sum) / m[k][k];
    }
    Some(x)
}

impl<'l> Point<'l> {
    /// A state at tooth numbers; `teeth` has those of every designed set. None where equations repeat each other or the
    /// train is singular there.
    pub fn new(layout: &'l Layout, state: &'l LayoutState, teeth: &dyn Fn(usize) -> &'l [i64]) -> Option<Self> {
        if state.redundant {
            return None;
        }
        let factors: Vec<f64> = layout
            .elements
            .iter()
            .map(|e| {
                e.sense
                    * match e.factor {
                        Factor::Teeth { set, above, below } => teeth(set)[above] as f64 / teeth(set)[below] as f64,
                        Factor::Fixed(x) => x,
                    }
            })
            .collect();
        let n = state.nodes;
        let mut rows: Vec<Vec<f64>> = vec![];
        for (e, x) in layout.elements.iter().zip(&factors) {
            let mut row = vec![0.0; n + 1];
            let mut add = |m: usize, value: f64| {
                if let Some(k) = state.node_of[m] {
                    row[k] += value;
                }
            };
            add(e.p, 1.0);
            add(e.q, -x);
            add(e.carrier, x - 1.0);
            rows.push(row);
        }
        let unit = |k: usize, value: f64| {
            let mut row = vec![0.0; n + 1];
            row[k] = 1.0;
            row[n] = value;
            row
        };
        rows.push(unit(state.node_of[state.input]?, 1.0));
        rows.extend(state.pins.iter().map(|k| unit(*k, 0.0)));
        // A set that rests as a whole says nothing.
        rows.retain(|r| r.iter().any(|x| *x != 0.0));
        if rows.len() != n {
            return None;
        }
        let nodes = solve(&mut rows)?;
        let speed = |m: usize| state.node_of[m].map_or(0.0, |k| nodes[k]);
        let relative = layout.elements.iter().map(|e| speed(e.p) - speed(e.carrier)).collect();
        Some(Self { layout, state, factors, relative, speeds: Speeds { nodes } })
    }

    /// Speed of a member for an input of one.
    pub fn speed(&self, member: usize) -> f64 {
        self.state.node_of[member].map_or(0.0, |k| self.speeds.nodes[k])
    }

    /// Largest speed of a member, as a multiple of the input's.
    pub fn largest_speed(&self) -> f64 {
        self.speeds.nodes.iter().fold(0.0, |a: f64, w| a.max(w.abs()))
    }

    /// Largest speed of a planet relative to its carrier, as a multiple of the input's.
    pub fn planet_spin(&self, teeth: &dyn Fn(usize) -> &'l [i64]) -> f64 {
        let spin = |p: &super::layout::PlanetOf| {
            let z = teeth(p.set);
            let ratio = z[p.central_gear] as f64 / z[p.gear] as f64;
            ((self.speed(p.central) - self.speed(p.carrier)) * ratio).abs()
        };
        self.layout.planets.iter().map(spin).fold(0.0, f64::max)
    }

    /// Efficiencies: from input to output, and back. `factor` multiplies every mesh loss.
    pub fn efficiency(&self, forward: bool, factor: f64) -> Way {
        let moving: Vec<usize> = (0..self.factors.len()).filter(|e| self.relative[*e].abs() > 1e-9).collect();
        if moving.len() > MOST_PATTERNS {
            return Way::Unclear;
        }
        let (from, to) =
            if forward { (self.state.input, self.state.output) } else { (self.state.output, self.state.input) };
        let (enters, leaves) = (self.speed(from), self.speed(to));
        if enters.abs() < 1e-12 {
            return Way::Unclear;
        }
        // Loss factors with either end driving.
        let rho: Vec<[f64; 2]> = self
            .layout
            .elements
            .iter()
            .map(|e| {
                let passed =
                    |k: usize| e.meshes.iter().map(|m| (1.0 - factor * (1.0 - m[k])).max(1e-9)).product::<f64>();
                [passed(0), 1.0 / passed(1)]
            })
            .collect();
        let torque = enters.signum();
        let mut found: Vec<f64> = vec![];
        let mut all: Vec<Vec<f64>> = vec![];
        for pattern in 0..1usize << moving.len() {
            let first_drives = |e: usize| moving.iter().position(|m| *m == e).map(|k| pattern >> k & 1 == 0);
            let chosen = |e: usize| first_drives(e).map_or(1.0, |p| rho[e][usize::from(!p)]);
            let Some(x) = self.balance(&chosen, from, to, torque) else { return Way::Unclear };
            let largest =
                moving.iter().map(|e| (x[*e] * self.relative[*e]).abs()).fold(0.0, f64::max).max(enters.abs());
            let mut agrees = true;
            for &e in &moving {
                let power = x[e] * self.relative[e];
                if power.abs() <= NOTHING * largest {
                    // Idle: both patterns give the same, and only one is counted.
                    agrees &= first_drives(e) == Some(true);
                } else if power.abs() < 1e-7 * largest {
                    return Way::Unclear;
                } else {
                    agrees &= (power > 0.0) == (first_drives(e) == Some(true));
                }
            }
            if agrees {
                let out = -x[self.factors.len()] * leaves / (torque * enters);
                // Where both ends feed power in, nothing is driven.
                if out > 1e-12 && !all.iter().any(|o| o.iter().zip(&x).all(|(a, b)| (a - b).abs() <= 1e-9 * (a.abs() + b.abs()))) {
                    all.push(x);
                    found.push(out);
                }
            }
        }
        match found[..] {
            [] => Way::Locks,
            [one] => Way::One(one),
            _ => {
                let low = found.iter().copied().fold(f64::INFINITY, f64::min);
                let high = found.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                Way::Several(found.len(), [low, high])
            }
        }
    }

    /// Torques that the first end of every element puts into its mesh, and the torque on `to`, when `torque` acts on
    /// `from`.
    fn balance(&self, rho: &dyn Fn(usize) -> f64, from: usize, to: usize, torque: f64) -> Option<Vec<f64>> {
        let (state, elements) = (self.state, &self.layout.elements);
        let nodes: Vec<usize> = (0..state.nodes).filter(|n| !state.pins.contains(n)).collect();
        let unknowns = elements.len() + 1;
        let mut rows = vec![vec![0.0; unknowns + 1]; state.nodes];
        let mut add = |m: usize, column: usize, value: f64| {
            if let Some(n) = state.node_of[m] {
                rows[n][column] += value;
            }
        };
        for (k, e) in elements.iter().enumerate() {
            let passed = self.factors[k] * rho(k);
            add(e.p, k, 1.0);
            add(e.q, k, -passed);
            add(e.carrier, k, passed - 1.0);
        }
        add(to, unknowns - 1, -1.0);
        add(from, unknowns, torque);
        let mut rows: Vec<Vec<f64>> = nodes.into_iter().map(|n| std::mem::take(&mut rows[n])).collect();
        if rows.len() == unknowns {
            return solve(&mut rows);
        }
        // Sets at rest as a whole, whose forces nothing settles and nothing asks for.
        let idle: Vec<usize> = (0..elements.len()).filter(|k| rows.iter().all(|r| r[*k] == 0.0)).collect();
        if rows.len() + idle.len() != unknowns {
            return None;
        }
        for row in &mut rows {
            let kept = row.iter().enumerate().filter(|(k, _)| !idle.contains(k)).map(|(_, x)| *x).collect();
            *row = kept;
        }
        let mut x = solve(&mut rows)?;
        for k in idle {
            x.insert(k, 0.0);
        }
        Some(x)
    }

    /// Largest torque of a closed shift element without losses, as a multiple of the input's; none without any.
    pub fn largest_element_torque(&self) -> Option<f64> {
        let x = self.balance(&|_| 1.0, self.state.input, self.state.output, 1.0)?;
        let on = |m: usize| {
            let mut sum = 0.0;
            for (k, e) in self.layout.elements.iter().enumerate() {
                let f = x[k];
                sum -= if m == e.p { f } else { 0.0 };
                sum += if m == e.q { self.factors[k] * f } else { 0.0 };
                sum += if m == e.carrier { (1.0 - self.factors[k]) * f } else { 0.0 };
            }
            sum + if m == self.state.input { 1.0 } else { 0.0 }
                + if m == self.state.output { x[self.factors.len()] } else { 0.0 }
        };
        let torques = self.state.closed.iter().filter_map(|(_, side)| side.as_ref());
        torques.map(|side| side.iter().map(|m| on(*m)).sum::<f64>().abs()).reduce(f64::max)
    }

    /// The factor on every mesh loss at which the output can no longer drive the input; none where that does not happen
    /// before a mesh passes nothing at all.
    pub fn lock_margin(&self) -> Option<f64> {
        let least = self.layout.elements.iter().flat_map(|e| &e.meshes).flatten().copied().fold(1.0, f64::min);
        if least >= 1.0 {
            return None;
        }
        let most = 0.999_999 / (1.0 - least);
        let locks = |factor: f64| matches!(self.efficiency(false, factor), Way::Locks);
        let (mut low, mut high) = (0.0, 1.0);
        while !locks(high) {
            if high >= most {
                return None;
            }
            low = high;
            high = (2.0 * high).min(most);
        }
        for _ in 0..48 {
            let middle = 0.5 * (low + high);
            if locks(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(0.5 * (low + high))
    }
}
