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

/// A square system with its right side: rows of `n + 1` numbers, on the stack where it is small.
struct System {
    n: usize,
    small: [f64; SMALL],
    large: Vec<f64>,
}

/// So many numbers stand on the stack.
const SMALL: usize = 13 * 14;

impl System {
    fn new(n: usize) -> Self {
        let large = if n * (n + 1) > SMALL { vec![0.0; n * (n + 1)] } else { vec![] };
        Self { n, small: [0.0; SMALL], large }
    }

    fn numbers(&mut self) -> &mut [f64] {
        if self.large.is_empty() { &mut self.small[..self.n * (self.n + 1)] } else { &mut self.large }
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        let width = self.n + 1;
        self.numbers()[row * width + column] += value;
    }

    /// The solution; none where the system is singular.
    fn solve(mut self) -> Option<Vec<f64>> {
        let (n, width) = (self.n, self.n + 1);
        let m = self.numbers();
        for k in 0..n {
            let pivot = (k..n).max_by(|a, b| m[a * width + k].abs().total_cmp(&m[b * width + k].abs()))?;
            if m[pivot * width + k].abs() < 1e-13 {
                return None;
            }
            if pivot != k {
                for j in k..width {
                    m.swap(pivot * width + j, k * width + j);
                }
            }
            let (above, below) = m.split_at_mut((k + 1) * width);
            let row = &above[k * width..];
            for other in below.chunks_exact_mut(width) {
                let factor = other[k] / row[k];
                if factor != 0.0 {
                    for j in k..width {
                        other[j] -= factor * row[j];
                    }
                }
            }
        }
        let mut x = vec![0.0; n];
        for k in (0..n).rev() {
            let row = &m[k * width..(k + 1) * width];
            let sum: f64 = (k + 1..n).map(|j| row[j] * x[j]).sum();
            x[k] = (row[n] - sum) / row[k];
        }
        Some(x)
    }
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
        let node = |m: usize| state.node_of[m];
        // A set that rests as a whole says nothing.
        let moves = |e: &super::layout::Element| [e.p, e.q, e.carrier].into_iter().any(|m| node(m).is_some());
        let count = layout.elements.iter().filter(|e| moves(e)).count();
        if count + 1 + state.pins.len() != n {
            return None;
        }
        let mut system = System::new(n);
        for (row, (e, x)) in layout.elements.iter().zip(&factors).filter(|(e, _)| moves(e)).enumerate() {
            for (m, value) in [(e.p, 1.0), (e.q, -x), (e.carrier, x - 1.0)] {
                if let Some(k) = node(m) {
                    system.add(row, k, value);
                }
            }
        }
        system.add(count, node(state.input)?, 1.0);
        system.add(count, n, 1.0);
        for (k, pin) in state.pins.iter().enumerate() {
            system.add(count + 1 + k, *pin, 1.0);
        }
        let nodes = system.solve()?;
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

    /// Efficiencies: from input to output, and back. `factor` multiplies every mesh loss. `quick` takes the first pattern
    /// that agrees, beginning with that of a train without losses, and does not ask whether it is the only one.
    pub fn efficiency(&self, forward: bool, factor: f64, quick: bool) -> Way {
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
        if quick {
            let mut pattern: Vec<bool> = vec![];
            for _ in 0..8 {
                let chosen = |e: usize| match pattern.get(e) {
                    Some(p) if self.relative[e].abs() > 1e-9 => rho[e][usize::from(!p)],
                    _ => 1.0,
                };
                let Some(x) = self.balance(&chosen, from, to, torque) else { return Way::Unclear };
                let next: Vec<bool> = (0..self.factors.len()).map(|e| x[e] * self.relative[e] >= 0.0).collect();
                if next == pattern {
                    let out = -x[self.factors.len()] * leaves / (torque * enters);
                    if out > 1e-12 {
                        return Way::One(out);
                    }
                    break;
                }
                pattern = next;
            }
        }
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
                if out > 1e-12
                    && !all.iter().any(|o| o.iter().zip(&x).all(|(a, b)| (a - b).abs() <= 1e-9 * (a.abs() + b.abs())))
                {
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
        // Sets at rest as a whole, whose forces nothing settles and nothing asks for.
        let idle = |e: &super::layout::Element| [e.p, e.q, e.carrier].iter().all(|m| state.node_of[*m].is_none());
        let acting: Vec<usize> = (0..elements.len()).filter(|k| !idle(&elements[*k])).collect();
        let n = acting.len() + 1;
        if state.nodes - state.pins.len() != n {
            return None;
        }
        // Rows: nodes without those that nothing settles.
        let row = |m: usize| {
            let node = state.node_of[m]?;
            (!state.pins.contains(&node)).then(|| node - state.pins.iter().filter(|p| **p < node).count())
        };
        let mut system = System::new(n);
        let mut add = |m: usize, column: usize, value: f64| {
            if let Some(r) = row(m) {
                system.add(r, column, value);
            }
        };
        for (column, k) in acting.iter().enumerate() {
            let (e, passed) = (&elements[*k], self.factors[*k] * rho(*k));
            add(e.p, column, 1.0);
            add(e.q, column, -passed);
            add(e.carrier, column, passed - 1.0);
        }
        add(to, n - 1, -1.0);
        add(from, n, torque);
        let found = system.solve()?;
        if n == elements.len() + 1 {
            return Some(found);
        }
        let mut x = vec![0.0; elements.len() + 1];
        for (k, value) in acting.iter().chain([&elements.len()]).zip(found) {
            x[*k] = value;
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
        let locks = |factor: f64| matches!(self.efficiency(false, factor, false), Way::Locks);
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
