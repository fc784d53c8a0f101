//! Members without inertia that shafts, dampers and slipping clutches act on: each gets a trace of inertia.
//!
//! Without inertia the torques on such a member are in balance, and its speed is the one that makes them so: `δ ω + κ θ
//! = τ` between dampers and springs. Where something may stick, or lose contact, that balance need not have a solution in
//! every mode, and it would be a second kind of equation. With an inertia that is small enough the same equations hold
//! as for all others, and the balance is met after a time T that nobody can see:
//!
//! ```text
//! J = κ T² + δ T + C T / ω₀
//! ```
//!
//! κ, δ and C are the stiffness, damping and sliding friction against the motion, ω₀ a slip that C stops within T.
//! Between springs alone it would swing for ever; so it is damped critically, by `2 κ T`, against the mean of what its
//! springs lead to, weighted by their stiffness. In balance it turns with that mean, and nothing is lost: springs in series
//! swing as long as the one spring that they are.

use nalgebra::{DMatrix, DVector};

use crate::dynamics::rounding::short;
use crate::exact::{Matrix, Rational, null_space};
use crate::train::{Curve, MemberId, Scenario, Train};

use super::coordinates::Coordinates;
use super::frictions::{Friction, Rubs};
use super::inertia::NodeInertia;
use super::ports::{Between, Ports};
use super::shafts::Elastic;

/// T over the duration of the scenario.
const PART: f64 = 1e-7;

/// The longest T, s.
const LONGEST: f64 = 1e-6;

/// ω₀, rad/s.
const SLIP: f64 = 100.0;

/// Part of the largest stiffness below which there is none.
const ROUND_OFF: f64 = 1e-13;

/// What has no inertia, and what it is given.
pub(super) struct Traces {
    /// Inertias of members.
    pub given: Vec<(MemberId, f64)>,
    /// What their dampers, or where there are none their springs, resist to: a row over the coordinates each.
    pub leads: Vec<Vec<f64>>,
    /// Twist rates of the shafts, one row each, in the motions without inertia, one column each.
    rates: DMatrix<f64>,
    /// T, s.
    settles: f64,
}

impl Traces {
    /// What is acted on and has no inertia. `step`: the length of the steps, s, below which the T of drags, which act
    /// with the speed before a step, is not; 0 where it is adapted.
    pub fn of(
        scenario: &Scenario,
        step: f64,
        coordinates: &Coordinates,
        train: &Train,
        frictions: &[Friction],
        elastic: &[Elastic],
        inertia: &NodeInertia<'_>,
    ) -> Self {
        let free = coordinates.free;
        let turns: Matrix = (inertia.pairs.iter())
            .map(|&members| coordinates.exact_slip(members)[..free].to_vec())
            .filter(|row| row.iter().any(|x| !x.is_zero()))
            .collect();
        let settles = (PART * (scenario.end - scenario.start)).min(LONGEST);
        let motions = null_space(turns, free);
        let rate =
            |row: &[f64], motion: &[Rational]| -> f64 { row.iter().zip(motion).map(|(x, n)| x * n.to_f64()).sum() };
        let (mut given, mut leads) = (Vec::new(), Vec::new());
        for motion in &motions {
            let mut value = 0.0;
            let [mut sprung, mut damped] = [vec![0.0; coordinates.all()], vec![0.0; coordinates.all()]];
            let add =
                |sum: &mut [f64], part: f64, row: &[f64]| sum.iter_mut().zip(row).for_each(|(s, x)| *s += part * x);
            for (shaft, of) in train.shafts().iter().zip(elastic) {
                let rate = rate(&of.row, motion);
                value += rate * rate * settles * (shaft.stiffness * settles + shaft.damping);
                add(&mut sprung, shaft.stiffness * rate, &of.row);
                add(&mut damped, shaft.damping * rate, &of.row);
            }
            for f in frictions.iter().filter(|f| !f.open) {
                let rate = rate(&f.row, motion);
                let most = f.peak * f.torque.points().iter().fold(0.0, |most, p| p[1].max(most));
                value += rate * rate * f.viscous * settles.max(step) + rate.abs() * most / SLIP * settles;
                add(&mut damped, f.viscous * rate, &f.row);
            }
            if value > 0.0 {
                // This coordinate turns at 1, and in none of the other motions.
                let own = motion.iter().rposition(|x| !x.is_zero()).expect("it moves");
                given.push((coordinates.chosen[own], value));
                leads.push(if damped[own] != 0.0 { damped } else { sprung });
            }
        }
        let rates = DMatrix::from_fn(elastic.len(), motions.len(), |s, k| rate(&elastic[s].row, &motions[k]));
        Self { given, leads, rates, settles }
    }

    /// That in words.
    pub fn assumption(&self, train: &Train) -> Option<String> {
        let names: Vec<&str> = self.given.iter().map(|(m, _)| train.member_name(*m)).collect();
        (!names.is_empty()).then(|| {
            format!(
                "without inertia, following what acts on them within {} s: {}",
                short(self.settles),
                names.join(", ")
            )
        })
    }

    /// The dampers between what has no inertia and the mean of what its springs lead to.
    ///
    /// With the stiffness K over the twist rates, R those in the motions without inertia, and `RᵀKR = V Λ Vᵀ`, they have
    /// the rows `Λ^-½ Vᵀ Rᵀ K` over the twist rates.
    pub fn dampers(
        &self,
        train: &Train,
        coordinates: &Coordinates,
        elastic: &[Elastic],
        ports: &mut Ports<'_>,
    ) -> Vec<Friction> {
        let Some(&(member, _)) = self.given.first().filter(|_| !self.rates.is_empty()) else { return vec![] };
        let stiffness = DVector::from_iterator(elastic.len(), train.shafts().iter().map(|s| s.stiffness));
        let pulls = self.rates.transpose() * DMatrix::from_diagonal(&stiffness);
        let eigen = (&pulls * &self.rates).symmetric_eigen();
        let least = ROUND_OFF * eigen.eigenvalues.amax();
        (eigen.eigenvectors.column_iter().zip(&eigen.eigenvalues))
            .filter(|(_, value)| **value > least)
            .map(|(own, value)| {
                let parts = own.transpose() * &pulls / value.sqrt();
                let rate = |i: usize| parts.iter().zip(elastic).map(|(part, of)| part * of.row[i]).sum();
                let column = ports.sum(elastic.iter().map(|of| of.port).zip(parts.iter().copied()));
                // It acts on several members; of two it would be no other.
                let row = (0..coordinates.all()).map(rate).collect();
                let between = Between { members: [member; 2], row, port: ports.add(column) };
                let name = "members without inertia, settling";
                let damper = Friction::new(Rubs::Trace, name, Curve::constant(0.0), between);
                Friction { viscous: 2.0 * self.settles, ..damper }
            })
            .collect()
    }
}
