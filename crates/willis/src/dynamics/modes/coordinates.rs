//! Coordinates, and what inertias and shafts feel of them.

use nalgebra::DMatrix;

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::{Matrix, Rational, null_space};
use crate::kinematics::Configuration;
use crate::train::{MemberId, Train};

use super::oscillator::Oscillator;
use super::rows::{Rows, floats};

/// Independent speeds that settle those of all inertias and shafts.
pub(super) struct Coordinates {
    pub chosen: Vec<MemberId>,
    /// Every member's speed over them; `None` where they do not settle it.
    pub speeds: Vec<Option<Vec<Rational>>>,
}

impl Coordinates {
    pub fn of(configuration: &Configuration<'_>, oscillator: &Oscillator<'_>) -> Self {
        let mut chosen: Vec<MemberId> = Vec::new();
        let mut speeds = configuration.transfer(&chosen).speeds;
        for m in oscillator.swinging() {
            if speeds[m.0].is_none() {
                chosen.push(m);
                speeds = configuration.transfer(&chosen).speeds;
            }
        }
        Self { chosen, speeds }
    }

    pub fn count(&self) -> usize {
        self.chosen.len()
    }

    /// Speed of a member relative to another, if it is settled.
    pub fn slip(&self, [a, b]: [MemberId; 2]) -> Option<Vec<Rational>> {
        let (a, b) = (self.speeds[a.0].as_ref()?, self.speeds[b.0].as_ref()?);
        Some(a.iter().zip(b).map(|(a, b)| a - b).collect())
    }

    /// A sum over the speeds of members, if they are settled.
    pub fn sum(&self, of: &[(MemberId, Rational)]) -> Option<Vec<Rational>> {
        let mut sum = vec![Rational::ZERO; self.count()];
        for (member, factor) in of {
            let speed = self.speeds[member.0].as_ref()?;
            sum.iter_mut().zip(speed).for_each(|(sum, x)| *sum = &*sum + &(factor * x));
        }
        Some(sum)
    }

    /// Speeds of all members, the matrix N; rows of zeros where nothing settles them.
    pub fn of_members(&self) -> DMatrix<f64> {
        let n = self.count();
        let settled = |s: &Option<Vec<Rational>>| s.clone().unwrap_or_else(|| vec![Rational::ZERO; n]);
        floats(&self.speeds.iter().map(settled).collect(), n)
    }
}

/// What inertias and shafts feel of the coordinates.
pub(super) struct Felt {
    /// How each inertia turns.
    pub turns: Rows,
    /// How each shaft and elastic mesh is strained.
    pub twists: Rows,
}

impl Felt {
    pub fn of(oscillator: &Oscillator<'_>, coordinates: &Coordinates) -> Self {
        let known = "the coordinates settle it";
        let row = |members: [MemberId; 2]| coordinates.slip(members).expect(known);
        let turns = oscillator.rotors.iter().map(|j| row([j.member, j.reference])).collect();
        let twists = oscillator.springs.iter().map(|s| coordinates.sum(&s.strain).expect(known)).collect();
        let n = coordinates.count();
        Self { turns: Rows::new(turns, n), twists: Rows::new(twists, n) }
    }

    /// An error for a motion that neither an inertia nor a shaft feels.
    pub fn check(&self, train: &Train, coordinates: &Coordinates) -> Result<(), Diagnostics> {
        let (n, chosen) = (coordinates.count(), &coordinates.chosen);
        let both: Matrix = self.turns.exact.iter().chain(&self.twists.exact).cloned().collect();
        let Some(free) = null_space(both, n).into_iter().next() else { return Ok(()) };
        let names: Vec<_> = (0..n).filter(|&k| !free[k].is_zero()).map(|k| train.member_name(chosen[k])).collect();
        let text = format!("a motion of `{}` has neither inertia nor stiffness", names.join("`, `"));
        let hint =
            format!("give `{}` a moment of inertia, or hold a member that leaves this motion no freedom", names[0]);
        Err(Diagnostic::new(Code::MissingKey, "", text).hint(hint).into())
    }
}
