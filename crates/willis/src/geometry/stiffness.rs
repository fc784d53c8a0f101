//! Mean stiffness of a mesh.

use super::Pair;
use crate::real::Real;

/// Young's modulus for which the formula's constants hold, Pa.
const STEEL: f64 = 206e9;

/// How far the formula's data reach: sum of the profile shifts, and helix angle, rad.
const SHIFTS: [f64; 2] = [-0.5, 2.0];
const HELIX: f64 = std::f64::consts::FRAC_PI_4;

impl Pair {
    /// Mean stiffness of the mesh over its face width, `c_γ`, N/m for each m of width, of gears with solid discs.
    ///
    /// # Formula
    /// ```text
    /// q' = C1 + C2/z_n1 + C3/z_n2 + C4 x_1 + C5 x_1/z_n1 + C6 x_2 + C7 x_2/z_n2 + C8 x_1² + C9 x_2²
    /// c' = (1/q') C_M C_B cos β · E/206 GPa           N/(mm µm)
    /// c_γ = c' (0.75 ε_α + 0.25)
    /// z_n = z/(cos² β_b cos β)      C_M = 0.8      C_B = (1 + 0.5 (1.2 − h_fP*)) (1 − 0.02 (20 − α_n/1°))
    /// ```
    /// Wheel 1 is the one with the larger shift. A ring counts as a rack, `1/z_n2 = 0`, with its shift in the sense of the
    /// standard. `C_B` is the mean of both wheels' racks. For loads above 100 N per mm of width.
    ///
    /// # Source
    /// ISO 6336-1:2019, method B: equations (82) to (91) and the section on internal gearing.
    ///
    /// # Example
    /// Steel, z = 20 and 40, spur, without shift: q' = 0.04723 + 0.15551/20 + 0.25791/40 = 0.061453,
    /// c' = 0.8 · 0.975/0.061453 = 12.69 N/(mm µm).
    /// ```
    /// use willis::geometry::{Pair, PairData, Tip, Wheel};
    ///
    /// let wheel = |teeth| Wheel {
    ///     teeth,
    ///     internal: false,
    ///     shift: 0.0,
    ///     tip: Tip::Addendum { coefficient: 1.0, alteration: 0.0 },
    ///     dedendum: 1.25,
    /// };
    /// let pair = Pair::new(&PairData {
    ///     module: 4e-3,
    ///     pressure_angle: 20f64.to_radians(),
    ///     helix: 0.0,
    ///     double_helical: false,
    ///     width: 40e-3,
    ///     centre_distance: None,
    ///     wheels: [wheel(20.0), wheel(40.0)],
    /// })
    /// .unwrap();
    /// let single = pair.mesh_stiffness(206e9) / (0.75 * pair.contact_ratio + 0.25);
    /// assert!((single / 12.6926e9 - 1.0).abs() < 1e-4);
    /// ```
    pub fn mesh_stiffness(&self, youngs_modulus: f64) -> f64 {
        self.pair_stiffness(youngs_modulus) * (0.75 * self.contact_ratio + 0.25)
    }

    /// In which ways the pair lies outside of what [`Pair::mesh_stiffness`] has data for, in words.
    pub(crate) fn beyond_stiffness(&self) -> Option<String> {
        let [a, b] = &self.data.wheels;
        let shifts = a.shift + b.shift;
        if !a.internal && !b.internal && !(SHIFTS[0]..=SHIFTS[1]).contains(&shifts) {
            return Some(format!("a sum of profile shifts of {shifts:.3}; its data reach from -0.5 to 2"));
        }
        if self.data.helix > HELIX {
            let helix = self.data.helix.to_degrees();
            return Some(format!("a helix angle of {helix:.1}°; its data reach to 45°"));
        }
        (self.contact_ratio < 1.0).then(|| format!("a contact ratio of {:.3}; its data begin at 1", self.contact_ratio))
    }
}

impl<R: Real> Pair<R> {
    /// Stiffness of one tooth pair where it is stiffest, over its face width, `c'`, N/m for each m of width: that of
    /// [`Pair::mesh_stiffness`] before the mean over the mesh is taken.
    ///
    /// # Source
    /// ISO 6336-1:2019, method B: equations (82) to (91) and the section on internal gearing.
    pub fn pair_stiffness(&self, youngs_modulus: R) -> R {
        let cos_helix = self.data.helix.cos();
        let virtual_teeth = self.base_helix.cos().powi(2) * cos_helix;
        // Over 1/z_n and x, a ring in the sense of the standard, which counts outwards from the axis as positive.
        let mut wheels = self.data.wheels.each_ref().map(|w| match w.internal {
            true => (R::from(0.0), -w.shift),
            false => (virtual_teeth / w.teeth, w.shift),
        });
        if wheels[0].0.re() == 0.0 || (wheels[1].0.re() > 0.0 && wheels[0].1.re() < wheels[1].1.re()) {
            wheels.swap(0, 1);
        }
        let [(n1, x1), (n2, x2)] = wheels;
        let flexibility =
            n1 * 0.15551 + 0.04723 + n2 * 0.25791 - x1 * 0.00635 - x1 * 0.11654 * n1 - x2 * 0.00193 - x2 * 0.24188 * n2
                + x1 * 0.00529 * x1
                + x2 * 0.00182 * x2;
        let degrees = self.data.pressure_angle * (180.0 / std::f64::consts::PI);
        let racks =
            [0, 1].map(|k| ((-self.data.wheels[k].dedendum + 1.2) * 0.5 + 1.0) * (-((-degrees + 20.0) * 0.02) + 1.0));
        let racks = (racks[0] + racks[1]) * 0.5;
        racks * 0.8 * cos_helix / flexibility * youngs_modulus / STEEL * 1e9
    }
}
