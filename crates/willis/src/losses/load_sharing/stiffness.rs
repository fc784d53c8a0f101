use super::{Law, ToothLoad};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::min;

/// Sharing by the stiffness of the teeth: a trapezoid from 1/3 to 2/3 in double contact.
///
/// # Formula
/// ```text
/// share = c(x)/Σ_k c(x + k)    c(x) = 1/3 + 1/3 · min(x, ε_α − x, ε_α − 1)/(ε_α − 1)
/// 1 ≤ ε_α ≤ 2:  A to B 1/3 … 2/3,  B to D 1,  D to E 2/3 … 1/3
/// relieved tips: share = 3/2 c(x) max(0, δ − g(x)),  Σ_k 3/2 c(x + k) max(0, δ − g(x + k)) = 1
/// ```
///
/// # Symbols
/// | there | here            | unit there | meaning                         |
/// |-------|-----------------|------------|---------------------------------|
/// | x     | `position`      | −          | distance from A in base pitches |
/// | ε_α   | `contact_ratio` | −          | transverse contact ratio        |
/// | c     |                 | −          | relative stiffness of the pair  |
/// | g, δ  | `relief`        | −          | gap by tip relief; approach of the flanks, both over the deflection of one pair under the whole load |
///
/// # Valid for
/// Gears of steel of usual proportions, their tips relieved or not, contact ratio 1 to 2. A
/// helical gear is taken as slices that do not support each other, whatever its overlap ratio.
///
/// # Departs from the source
/// The source gives the trapezoid for a contact ratio of 1 to 2. Beyond 2 the pairs in contact
/// share in the proportion of the same c(x). Tip relief is derived here: springs side by side, less their gaps.
///
/// # Source
/// `[isotr13989_1]`, clause 9.2, equations (57) to (60): load sharing factor, spur gears with unmodified
/// profiles.
///
/// # Example
/// ε_α = 1.5, x = 0.25, by hand: 1/3 + 1/3 · 0.25/0.5 = 0.5; x = 0: 1/3.
/// ```
/// # use willis::losses::load_sharing::{Law, Relief, Stiffness, ToothLoad};
/// let relief = Relief::none();
/// let at = |position| ToothLoad { position, contact_ratio: 1.5, overlap_ratio: 0.0, relief };
/// assert_eq!(format!("{:.4}", Stiffness::DEFAULT.eval(&at(0.25))), "0.5000");
/// assert!(Stiffness::DEFAULT.outside(&at(0.25)).is_empty());
/// assert_eq!(format!("{:.4}", Stiffness::DEFAULT.eval(&at(0.0))), "0.3333");
/// assert_eq!(Stiffness::DEFAULT.eval(&at(0.75)), 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness;

impl Stiffness {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for Stiffness {
    const META: LawInfo<ToothLoad<f64>> = LawInfo {
        id: "stiffness",
        by: "",
        title: "By stiffness, trapezoid 1/3 to 2/3",
        source: ("isotr13989_1", "clause 9.2, equations (57) to (60)"),
        trust: Trust::Confirm("the bounds 1/3 and 2/3"),
        tags: &[],
        valid: &[
            ValidityRange { symbol: "e_a", unit: "-", min: 1.0, max: 2.0, get: |s| s.contact_ratio },
            ValidityRange { symbol: "e_b", unit: "-", min: 0.0, max: 0.0, get: |s| s.overlap_ratio },
        ],
    };

    fn eval<D: Real>(&self, s: &ToothLoad<D>) -> D {
        let (x, e_a) = (s.position, s.contact_ratio);
        if !s.on_path() {
            return D::zero();
        }
        if e_a.re() <= 1.0 {
            return D::one();
        }
        let stiffness = |x: &D| (min(min(*x, e_a - *x), e_a - 1.0) / (e_a - 1.0) + 1.0) / 3.0;
        if s.relief.any() {
            return s.relieved(|x| stiffness(x) * 1.5);
        }
        let first = -x.re().floor();
        let mut sum = D::zero();
        for k in 0..((x.re().floor() + (e_a.re() - x.re()).floor()) as usize + 1).min(1000) {
            sum += stiffness(&(x + (first + k as f64)));
        }
        stiffness(&x) / sum
    }
}
