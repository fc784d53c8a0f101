//! Loss factor of a mesh: mean sliding loss over rolling power and coefficient of friction.
//!
//! `P_loss = P μ H_V` with the power P that the mesh transmits seen from the carrier (times the
//! force: `F_bt v_bt`) and one mean coefficient of friction μ.

use crate::geometry::Pair;
use crate::losses::load_sharing::Relief;

/// Path of contact of a pair.
#[derive(Clone, Copy, Debug)]
pub struct PathOfContact<D> {
    /// Tooth counts, in the order of `e`.
    pub teeth: [f64; 2],
    /// Whether one wheel, that with more teeth, is a ring gear.
    pub internal: bool,
    /// Helix angle at the base circle `β_b`, rad.
    pub base_helix: D,
    /// Helix angle at the operating circles `β_w`, rad.
    pub operating_helix: D,
    /// Addendum contact ratios `e_1`, `e_2`: parts of the path beyond the pitch point, of the
    /// addendum of each wheel.
    pub e: [D; 2],
    /// Overlap ratio `ε_β` of one helix, 0 for spur gears.
    pub overlap_ratio: D,
    /// Tip relief of both gears under the load.
    pub relief: Relief<D>,
}

family! {
    /// Loss factor of a mesh.
    LossFactor ("loss_factor"): PathOfContact => "H_V" ["-"];
    integrated::Integrated,
    two_pair::TwoPair,
    ohlendorf::Ohlendorf,
    uniform::Uniform,
    buckingham_merritt::BuckinghamMerritt,
    iso_14179_1::Iso14179Part1,
}

impl<D: crate::Real> PathOfContact<D> {
    /// `K = π (1/z_1 ± 1/z_2)/cos β_b`, −, with − for a ring.
    ///
    /// # Example
    /// 17/22 spur: by hand π (1/17 + 1/22) = 0.32760.
    /// ```
    /// use willis::losses::loss_factor::PathOfContact;
    ///
    /// assert_eq!(format!("{:.5}", PathOfContact::typical().factor()), "0.32760");
    /// ```
    pub fn factor(&self) -> D {
        let [first, second] = self.teeth.map(|z| 1.0 / z);
        let relative = if self.internal { (first - second).abs() } else { first + second };
        D::from(std::f64::consts::PI * relative) / self.base_helix.cos()
    }

    /// Transverse contact ratio `ε_α = e_1 + e_2`.
    pub fn contact_ratio(&self) -> D {
        self.e[0] + self.e[1]
    }
}

impl<D: crate::Real> PathOfContact<D> {
    /// The path of a pair of gears without tip relief.
    ///
    /// # Example
    /// ```
    /// use willis::geometry::{Pair, PairData, Tip, Wheel};
    /// use willis::losses::loss_factor::{LossFactor, PathOfContact};
    ///
    /// let tip = Tip::Addendum { coefficient: 1.0, alteration: 0.0 };
    /// let wheel = |teeth| Wheel { teeth, internal: false, shift: 0.0, tip, dedendum: 1.25 };
    /// let pair = Pair::new(&PairData {
    ///     module: 4e-3,
    ///     pressure_angle: 20f64.to_radians(),
    ///     helix: 0.0,
    ///     double_helical: false,
    ///     width: 50e-3,
    ///     centre_distance: None,
    ///     wheels: [wheel(17.0), wheel(22.0)],
    /// })
    /// .unwrap();
    /// let h = LossFactor::default().eval(&PathOfContact::of(&pair));
    /// assert_eq!(format!("{h:.6}"), "0.213122");
    /// ```
    pub fn of(pair: &Pair<D>) -> Self {
        Self {
            teeth: [pair.data.wheels[0].teeth, pair.data.wheels[1].teeth],
            internal: pair.internal(),
            base_helix: pair.base_helix,
            operating_helix: pair.operating_helix,
            e: pair.addendum_contact_ratios,
            overlap_ratio: pair.overlap_ratio,
            relief: Relief::none(),
        }
    }
}

impl PathOfContact<f64> {
    /// A spur pair 17/22 of standard proportions, for examples and tests.
    pub fn typical() -> Self {
        Self {
            teeth: [17.0, 22.0],
            internal: false,
            base_helix: 0.0,
            operating_helix: 0.0,
            e: [0.7574, 0.790348],
            overlap_ratio: 0.0,
            relief: Relief::none(),
        }
    }
}
