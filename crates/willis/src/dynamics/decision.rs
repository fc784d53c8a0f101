//! The mode of a state: which clutches hold, which meshes at rest begin to roll and which way power flows in each,
//! decided as one linear complementarity problem.
//!
//! This is a function of linear data alone; it knows neither trains nor time. Unknown are all accelerations, two
//! forces `f` and `e` for each mesh (what its gears put into it, over their factors) and the torque of each element:
//!
//! ```text
//! J a + Σ (f z₁ at gear 1, e z₂ at gear 2, −f z₁ − e z₂ at the carrier) = T + Σ (τ at the first, −τ at the second)
//! z₁ a₁ + z₂ a₂ − (z₁ + z₂) a_c = 0        z₂ < 0: internal
//! rolling:  e = P h₊ − h₋ or h₊ − P h₋,   f = η₂₁ (h₊ − h₋),   P = η₁₂ η₂₁,   0 ≤ h₊ ⊥ h₋ ≥ 0
//! at rest:  e = P h₊ − h₋ + u,   u + v = (1 − P)(h₊ + h₋),   0 ≤ α₊ ⊥ u ≥ 0,   0 ≤ α₋ ⊥ v ≥ 0,   α = z₁ (a₁ − a_c)
//! element:  0 ≤ α₊ ⊥ c₊ + τ ≥ 0,   0 ≤ α₋ ⊥ c₋ − τ ≥ 0,   α = a_first − a_second
//! ```
//!
//! An element that cannot slip in a direction has no such pair there, and a rigid hold none at all. Where holds
//! and meshes say the same thing twice, the forces between them are those of equal compliances.
//!
//! A basis of these equations is a mode. Pivoting from the last one leads to that of the loads just after the
//! instant, `d + ε d′`; where a force is at its limit within its own rounding bound, the rates `d′` decide, as an
//! event of a run is such an instant. Signs of the matrix, which does not come out of a run, are exact. Pivoting is
//! believed where a certificate says that every load has one motion. Otherwise all modes are searched, exactly, and
//! only that may say that there is no motion, or that there are two.

mod basis;
mod certificate;
mod equations;
mod motion;
mod pivoting;
mod problem;
mod search;
#[cfg(test)]
mod tests;

use basis::{Basis, Vector, Work};
use equations::Equations;

pub(super) use motion::{Amount, Motion, Verdict};
pub(super) use problem::{Body, Element, Inertia, Load, Mesh, Problem};

/// Choices that a certificate looks at, at most.
const MOST_CHOICES: usize = 1 << 17;

/// Whether every load of a problem has one motion; none if there are more choices than these to look at.
pub(super) fn is_unique(problem: &Problem, most: usize) -> Option<bool> {
    certificate::is_unique(&Equations::new(problem), most)
}

/// The decision for one set of contacts, under whatever loads.
#[derive(Clone)]
pub(super) struct Decision {
    problem: Problem,
    equations: Equations,
    /// The lossless train with all held, from whose forces a cold start takes its directions.
    ideal: Box<(Equations, Basis)>,
    basis: Basis,
    /// Loads and unknowns, and their rates.
    loads: [Vec<f64>; 2],
    unknowns: [Vector; 2],
    work: Work,
    certified: Option<bool>,
    motion: Motion,
    second: Motion,
}

impl Decision {
    pub fn new(problem: &Problem) -> Self {
        let equations = Equations::new(problem);
        let ideal = Equations::new(&problem.ideal());
        let ideal_basis = Basis::new(&ideal);
        let rows = equations.rows;
        Self {
            basis: Basis::new(&equations),
            ideal: Box::new((ideal, ideal_basis)),
            loads: [vec![0.0; rows], vec![0.0; rows]],
            unknowns: [Vector::new(rows), Vector::new(rows)],
            work: Work::new(rows),
            certified: None,
            motion: equations.motionless(),
            second: equations.motionless(),
            problem: problem.clone(),
            equations,
        }
    }

    /// Whether every load has one motion.
    pub fn is_certified(&mut self) -> bool {
        *self.certified.get_or_insert_with(|| certificate::is_unique(&self.equations, MOST_CHOICES) == Some(true))
    }

    /// What happens under a load; `certified`: it is known that every load has one motion. Starts from the mode of the
    /// last time.
    pub fn decide(&mut self, load: &Load, certified: bool) -> Verdict {
        let Some(found) = self.follow(load) else { return Verdict::Contradiction };
        if found && (certified || self.is_certified()) {
            return Verdict::One { proved: true };
        }
        self.search(load, found)
    }

    /// Pivots to a motion, and reads it. False says nothing about motions; none: a contradiction.
    fn follow(&mut self, load: &Load) -> Option<bool> {
        if !self.equations.load(load, &mut self.loads) {
            return None;
        }
        // The second time from a cold start.
        let found = self.pivot() || self.pivot();
        if found {
            self.basis.read(&self.equations, &self.unknowns, &mut self.motion);
        }
        Some(found)
    }

    /// How far what holds is from slipping under a load: the least of its spare forces, of no particular unit. Below 0
    /// where something slips: how fast, over the bound of its error.
    pub fn spare(&mut self, load: &Load) -> f64 {
        if self.follow(load) != Some(true) && !matches!(self.search(load, false), Verdict::One { .. }) {
            return f64::NEG_INFINITY;
        }
        let (problem, motion) = (&self.problem, &self.motion);
        let beyond = |[a, b]: [Body; 2]| {
            let of = |b: Body| b.map_or((0.0, 0.0), |i| (motion.accelerations[i].value, motion.accelerations[i].error));
            let (a, b) = (of(a), of(b));
            (a.0 - b.0).abs() / (a.1 + b.1 + f64::MIN_POSITIVE)
        };
        let meshes = problem.meshes.iter().zip(&motion.meshes).filter(|(p, m)| p.slip == 0 && m.slip != 0);
        let elements = problem.elements.iter().zip(&motion.elements).filter(|(_, m)| m.slip != 0);
        let slips = (meshes.map(|(p, _)| [p.bodies[0], p.bodies[2]])).chain(elements.map(|(p, _)| p.bodies));
        let worst = slips.map(beyond).fold(0.0, f64::max);
        if worst == 0.0 {
            self.least_spare()
        } else if !self.is_certified() && self.can_rest(load) {
            // Another motion than the present one, which goes on.
            0.0
        } else {
            -worst
        }
    }

    /// The motion found last.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The other one, where there are two.
    pub fn second(&self) -> &Motion {
        &self.second
    }
}
