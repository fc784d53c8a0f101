use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, Tag, Trust};

/// One coefficient of friction for every state of the mesh.
///
/// # Formula
/// ```text
/// mu = constant
/// ```
///
/// # Symbols
/// | there | here | unit there | meaning                 |
/// |-------|------|------------|-------------------------|
/// | mu    | `mu` | −          | coefficient of friction |
///
/// # Valid for
/// Whatever the number was chosen for. As a hand value 0.05 to 0.06 stands for ground steel teeth in
/// mineral oil, 0.02 to 0.03 for superfinished teeth at high speed.
///
/// # Departs from the source
/// Nothing. The default is a hand value without one source, to be replaced by a measured one.
///
/// # Source
/// `[practice]`, hand value.
///
/// # Example
/// By hand: the number itself, 0.05.
/// ```
/// # use willis::losses::mesh_friction::{Constant, Law, MeshContact};
/// assert_eq!(Constant::DEFAULT.eval(&MeshContact::typical()), 0.05);
/// assert_eq!(Constant { mu: 0.03 }.eval(&MeshContact::typical()), 0.03);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    /// Coefficient of friction, −.
    pub mu: f64,
}

impl Constant {
    /// Ground steel teeth in mineral oil.
    pub const DEFAULT: Self = Self { mu: 0.05 };
}

impl Law for Constant {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "constant",
        by: "",
        title: "Constant coefficient",
        source: ("practice", "hand value for ground steel teeth in mineral oil"),
        trust: Trust::Confirm("the default 0.05"),
        tags: &[Tag::WithoutOil],
        valid: &[],
    };

    fn eval<D: Real>(&self, _: &MeshContact<D>) -> D {
        D::from(self.mu)
    }
}
