use super::benedict_kelley::{argument, logarithm};
use super::{Law, MeshContact};
use crate::Real;
use crate::losses::{LawInfo, ValidityRange, Tag, Trust};

/// Friction at one point of a mesh of smooth teeth after Anderson and Loewenthal (NASA TP-1622):
/// Benedict and Kelley without roughness.
///
/// # Formula
/// ```text
/// mu = 0.0127 · log10(29.66 w / (η · v_g · v_Σ²))
/// ```
///
/// # Symbols
/// | there | here                | unit there | meaning                                      |
/// |-------|---------------------|------------|----------------------------------------------|
/// | w     | `local_line_load`   | N/m        | load per length of contact line at the point |
/// | η     | `dynamic_viscosity` | mPa s      | dynamic viscosity of the oil                 |
/// | v_g   | `sliding_speed`     | m/s        | sliding speed at the point                   |
/// | v_Σ   | `sum_speed`         | m/s        | SUM of the surface speeds at the point       |
///
/// # Valid for
/// Spur gears in mineral oil and in MIL-L-7808 and MIL-L-23699 oils, and a logarithm above 1.
/// Rolling losses are not contained; the same report gives them.
///
/// # Departs from the source
/// The logarithm is not taken below 1 (flagged by the range in [`Law::META`]), so that the coefficient
/// never falls below 0.0127, and v_g not below a thousandth of v_Σ, as for Benedict and Kelley.
///
/// # Source
/// `[anderson1980]`, sliding loss. The number of the equation there is not known to us. The sliding speed is
/// in table III, on page 32; see the errata of the report.
///
/// # Example
/// By hand: 29.66 · 200e3/(20 · 2 · 10²) = 1483, log10 3.17114; 0.0127 · 3.17114 = 0.040273.
/// ```
/// # use willis::losses::mesh_friction::{AndersonLoewenthal, Law, MeshContact};
/// let contact = MeshContact {
///     local_line_load: 200e3,
///     dynamic_viscosity: 20e-3,
///     sliding_speed: 2.0,
///     sum_speed: 10.0,
///     ..MeshContact::typical()
/// };
/// assert_eq!(format!("{:.6}", AndersonLoewenthal::DEFAULT.eval(&contact)), "0.040273");
/// assert!(AndersonLoewenthal::DEFAULT.outside(&contact).is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AndersonLoewenthal;

impl AndersonLoewenthal {
    /// As published.
    pub const DEFAULT: Self = Self;
}

impl Law for AndersonLoewenthal {
    const META: LawInfo<MeshContact<f64>> = LawInfo {
        id: "anderson-loewenthal",
        by: "Anderson–Loewenthal",
        title: "Anderson–Loewenthal (NASA TP-1622), smooth teeth",
        source: ("anderson1980", "sliding loss"),
        trust: Trust::Confirm("0.0127 and 29.66"),
        tags: &[Tag::Local, Tag::SlidingOnly],
        valid: &[ValidityRange {
            symbol: "29.66 w/(η v_g v_Σ²)",
            unit: "-",
            min: 10.0,
            max: f64::INFINITY,
            get: argument,
        }],
    };

    fn eval<D: Real>(&self, s: &MeshContact<D>) -> D {
        logarithm(s) * 0.0127
    }
}
