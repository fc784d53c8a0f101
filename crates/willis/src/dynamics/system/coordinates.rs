//! Coordinates: the speeds, chosen among the members, that settle all others.

use nalgebra::DMatrix;

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::Configuration;
use crate::train::{MemberId, Scenario, SourceKind};

/// The coordinates: exact speeds of every member over chosen ones.
pub(super) struct Coordinates {
    /// Free ones, then prescribed ones.
    pub chosen: Vec<MemberId>,
    /// How many are free.
    pub free: usize,
    /// Every member's speed over them.
    pub speeds: Vec<Vec<f64>>,
    pub exact: Vec<Vec<Rational>>,
}

impl Coordinates {
    /// Those of a scenario: prescribed speeds, and beside them preferably speeds that a reader looks at first.
    ///
    /// # Errors
    /// Prescribed speeds that the gears tie together.
    pub fn of(c: &Configuration<'_>, scenario: &Scenario) -> Result<Self, Diagnostics> {
        let train = c.train;
        let prescribed: Vec<MemberId> =
            (scenario.sources.iter()).filter(|s| matches!(s.kind, SourceKind::Speed(_))).map(|s| s.member).collect();
        let wish: Vec<MemberId> = (train.inertias().iter().map(|i| i.member))
            .filter(|m| train.terminals().contains(m))
            .chain(train.terminals().iter().copied())
            .chain(train.inertias().iter().map(|i| i.member))
            .collect();
        Self::choose(c, &prescribed, &wish).map_err(|members| {
            let names: Vec<&str> = members.iter().map(|m| train.member_name(*m)).collect();
            let message = format!("the gears tie the prescribed speeds of {} together", names.join(", "));
            Diagnostic::new(Code::ContradictorySpeeds, scenario.place.clone(), message)
                .hint("prescribe one of them")
                .into()
        })
    }

    /// The prescribed speeds and as many of the wished, then of all, as are independent; if the prescribed ones are
    /// not, the first of them that depend on each other.
    fn choose(c: &Configuration<'_>, prescribed: &[MemberId], wish: &[MemberId]) -> Result<Self, Vec<MemberId>> {
        let all = (1..c.train.members().len()).map(MemberId);
        let order: Vec<MemberId> = prescribed.iter().chain(wish).copied().chain(all).collect();
        let mut chosen = c.settling(&order);
        // They are its first ones where they are independent.
        if let Some(tied) = (0..prescribed.len()).find(|&k| chosen.get(k) != Some(&prescribed[k])) {
            return Err(prescribed[..=tied].to_vec());
        }
        // Prescribed speeds come last.
        chosen.rotate_left(prescribed.len());
        let exact: Vec<Vec<Rational>> = (c.transfer(&chosen).speeds.into_iter())
            .map(|s| s.unwrap_or_else(|| vec![Rational::ZERO; chosen.len()]))
            .collect();
        let speeds = exact.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
        Ok(Self { free: chosen.len() - prescribed.len(), chosen, speeds, exact })
    }

    /// Free and prescribed ones.
    pub fn all(&self) -> usize {
        self.chosen.len()
    }

    /// Members whose speeds are prescribed.
    pub fn prescribed(&self) -> &[MemberId] {
        &self.chosen[self.free..]
    }

    /// Speed of a member relative to another over the coordinates.
    pub fn slip(&self, [a, b]: [MemberId; 2]) -> Vec<f64> {
        self.speeds[a.0].iter().zip(&self.speeds[b.0]).map(|(x, y)| x - y).collect()
    }

    /// The same, exactly.
    pub fn exact_slip(&self, [a, b]: [MemberId; 2]) -> Vec<Rational> {
        self.exact[a.0].iter().zip(&self.exact[b.0]).map(|(x, y)| x - y).collect()
    }

    /// Speeds of the nodes, the matrix N.
    pub fn of_nodes(&self, c: &Configuration<'_>) -> DMatrix<f64> {
        let mut n = DMatrix::zeros(c.nodes, self.all());
        for m in 0..c.train.members().len() {
            if let (false, Some(node)) = (c.inner[m], c.node_of[m]) {
                for k in 0..self.all() {
                    n[(node, k)] = self.speeds[m][k];
                }
            }
        }
        n
    }
}
