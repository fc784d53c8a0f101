use super::{Inlet, Law};
use crate::Real;
use crate::losses::{LawInfo, Trust};

/// No thinning of the film: the isothermal thickness is used as it is.
///
/// # Formula
/// ```text
/// φ_T = 1
/// ```
///
/// # Symbols
/// | there | here | unit there | meaning                                    |
/// |-------|------|------------|--------------------------------------------|
/// | φ_T   |      | −          | film thickness over isothermal thickness   |
///
/// # Valid for
/// Slow contacts. It errs towards thick films, the more the faster the contact.
///
/// # Departs from the source
/// Nothing.
///
/// # Source
/// `[practice]`, the limit of no heating.
///
/// # Example
/// By hand: 1.
/// ```
/// # use willis::losses::film_reduction::{Inlet, Law, NoReduction};
/// assert_eq!(NoReduction::DEFAULT.eval(&Inlet::typical()), 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoReduction;

impl NoReduction {
    /// The only one.
    pub const DEFAULT: Self = Self;
}

impl Law for NoReduction {
    const META: LawInfo<Inlet<f64>> = LawInfo {
        id: "none",
        by: "",
        title: "No thermal reduction",
        source: ("practice", "limit of no heating"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, _: &Inlet<D>) -> D {
        D::from(1.0)
    }
}
