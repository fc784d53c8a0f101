//! What the arithmetic of the points gets from the compiler, and where its results go.

use std::ops::Range;

use crate::train::MeshId;

/// Most elements with relative motion for which all sign patterns are kept.
pub(super) const MOST_MOVING: usize = 12;
/// Most quantities that torques may depend on.
pub(super) const MOST_FEATURES: usize = 32;
/// Points per chunk: every array of a chunk stays in the first-level cache.
pub(super) const CHUNK: usize = 512;
/// Most linear outputs.
pub(super) const MOST_LINEAR: usize = 64;

/// Where the torque of a terminal comes from.
#[derive(Clone, Copy, Debug)]
pub(super) enum TorqueFrom {
    Input(usize),
    Linear(usize),
}

/// A terminal, for the power balance.
#[derive(Clone, Debug)]
pub(super) struct Terminal {
    pub torque: TorqueFrom,
    /// Over the prescribed speeds.
    pub speed: Vec<f64>,
}

/// `λ = min(c · ((|T| + torque)/(|ω| + speed))^exponent, most)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Law {
    /// When p drives, when q drives.
    pub c: [f64; 2],
    pub exponent: f64,
    pub torque: f64,
    pub speed: f64,
    pub most: f64,
}

impl Law {
    /// ρ when p drives and when q drives, as a law.
    pub fn constant(rho: [f64; 2]) -> Self {
        Self { c: [1.0 - rho[0], 1.0 - 1.0 / rho[1]], most: f64::INFINITY, ..Self::default() }
    }

    /// Bounds of `d(ρ f)/df`: if no system between them is singular, every load has one solution.
    pub fn slopes(&self) -> [f64; 2] {
        let p = self.exponent;
        let most = if p == 0.0 { self.most.min(self.c[0].max(self.c[1])) } else { self.most };
        [1.0 - (1.0 + p) * most, (1.0 + p * most / (1.0 - most)) / (1.0 - most)]
    }
}

/// An element of the equilibrium.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub rho: [f64; 2],
    /// Relative speed of end p over the prescribed speeds, with the sign of its coefficient.
    pub relative: Vec<f64>,
    pub entries: Vec<(usize, f64, f64)>,
    /// Torque on end p per force.
    pub arm: f64,
    /// A loss that depends on load and speed; `rho` are then the bounds of its slopes.
    pub law: Option<Law>,
    /// What each mesh in it loses, over the power at end p: where p drives, and where q does.
    pub meshes: Vec<(MeshId, [f64; 2])>,
}

/// What the compiler hands over.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    pub speeds: usize,
    pub torques: usize,
    /// Speed rows whose signs are features.
    pub signs: Vec<Vec<f64>>,
    pub columns: Vec<Element>,
    /// Right-hand side by feature.
    pub right: Vec<Vec<f64>>,
    /// Linear outputs by feature, with no force in any element.
    pub direct: Vec<Vec<f64>>,
    /// Linear outputs per force: constant part, and part times ρ.
    pub per_force: Vec<[Vec<f64>; 2]>,
    pub speed_rows: Vec<Vec<f64>>,
    pub terminals: Vec<Terminal>,
    pub linear: usize,
    pub certified: bool,
}

/// Where the results of a chunk go.
pub(super) struct Target<'o, 'a> {
    /// Output column of each linear output, if it has one.
    pub column: &'a [Option<usize>],
    /// The columns; empty when nothing is stored.
    pub out: &'a mut [&'o mut [f64]],
    /// Whether loss and efficiency are wanted.
    pub powers: bool,
}

impl Target<'_, '_> {
    /// The slice for linear output `o`: the caller's where it asked for it, else the chunk's own.
    #[inline]
    pub fn slice<'s>(&'s mut self, o: usize, own: &'s mut [[f64; CHUNK]], range: Range<usize>) -> &'s mut [f64] {
        match self.column[o] {
            Some(k) if !self.out.is_empty() => &mut self.out[k][range],
            _ => &mut own[o][..range.len()],
        }
    }
}
