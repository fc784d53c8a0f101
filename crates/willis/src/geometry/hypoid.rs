//! Hypoid pairs: bevel gears on axes that do not meet, with a spiral angle each.

use std::f64::consts::FRAC_PI_2;

use crate::real::Real;

/// Halvings of the interval in which the pitch cones are looked for: to the last digit.
const HALVINGS: usize = 100;

/// A hypoid pair at its mean point, where the two pitch cones touch.
///
/// The teeth run along one common direction through the pitch point, so the gears have different spiral angles and slide along
/// their teeth. Across them they roll like the cylindrical pair whose teeth have the same section there.
///
/// # Formula
/// ```text
/// r_k = m_n z_k/(2 cos ψ_k)                                   both gears have one normal pitch
/// cos Σ = cos δ_1 cos δ_2 cos(ψ_1 − ψ_2) − sin δ_1 sin δ_2     axes in the frame of the pitch plane
/// a = (r_1 cos δ_2 + r_2 cos δ_1) |sin(ψ_1 − ψ_2)|/sin Σ       their distance; the cones are those for which it is largest
/// β = (ψ_1 + ψ_2)/2        z_vk = z_k/cos δ_k (cos β/cos ψ_k)³   the same teeth in the normal section
/// v_l = v_n |tan ψ_1 − tan ψ_2|        v_n = ω_1 r_1 cos ψ_1
/// ```
/// Without an offset the cones are those of bevel gears, `r_1/sin δ_1 = r_2/sin δ_2`: there the distance of the cones' axes is stationary too.
///
/// # Source
/// Derived: kinematics of two cones that touch in a plane; Tredgold's approximation in the normal section.
///
/// # Example
/// ```
/// use willis::geometry::hypoid::Hypoid;
///
/// let angle = |degrees: f64| degrees.to_radians();
/// let pair = Hypoid::new(4e-3, [11.0, 41.0], [angle(50.0), angle(30.0)], angle(90.0)).unwrap();
/// assert_eq!(format!("{:.1}", pair.offset * 1e3), "34.7");
/// // Along the teeth alone, at a coefficient of friction of 0.06: pinion driving, wheel driving.
/// let eta = pair.lengthwise_efficiency(angle(20.0), 0.06);
/// assert_eq!(eta.map(|e| format!("{:.4}", e)), ["0.9635", "0.9593"]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Hypoid {
    /// Mean spiral angles `ψ`, rad.
    pub spiral: [f64; 2],
    /// Pitch cone angles `δ`, rad.
    pub cones: [f64; 2],
    /// Distance of the axes `a`, m.
    pub offset: f64,
}

impl Hypoid {
    /// The pair of this normal module, m, and these tooth counts, spiral angles and angle of the axes, rad; none where cones of
    /// less than 87° do not touch so.
    pub fn new(module: f64, teeth: [f64; 2], spiral: [f64; 2], shaft_angle: f64) -> Option<Self> {
        let radii = [0, 1].map(|k| module * teeth[k] / (2.0 * spiral[k].cos()));
        let turn = (spiral[0] - spiral[1]).cos();
        let other = |first: f64| {
            let (along, across) = (first.cos() * turn, first.sin());
            let cosine = shaft_angle.cos() / along.hypot(across);
            (cosine.abs() <= 1.0).then(|| cosine.acos() - across.atan2(along))
        };
        // The distance of the axes rises with the first cone up to the cones that are looked for.
        let rises = |first: f64, second: f64| {
            let [(s1, c1), (s2, c2)] = [first, second].map(f64::sin_cos);
            radii[0] * s2 * (s1 * c2 * turn + c1 * s2) > radii[1] * s1 * (c1 * s2 * turn + s1 * c2)
        };
        let (mut low, mut high) = (0.0, FRAC_PI_2);
        for _ in 0..HALVINGS {
            let first = f64::midpoint(low, high);
            match other(first) {
                Some(second) if second > 0.0 && rises(first, second) => low = first,
                _ => high = first,
            }
        }
        let cones = [low, other(low)?];
        let offset = (radii[0] * cones[1].cos() + radii[1] * cones[0].cos()) * (spiral[0] - spiral[1]).sin().abs()
            / shaft_angle.sin();
        let good = cones.iter().all(|d| *d > 0.0 && d.cos() > 0.05) && offset.is_finite();
        good.then_some(Self { spiral, cones, offset })
    }

    /// Helix angle of the virtual pair `β`, rad.
    pub fn helix(&self) -> f64 {
        f64::midpoint(self.spiral[0], self.spiral[1])
    }

    /// How many times as fast as a gear its virtual one turns.
    pub fn speed_factor(&self, gear: usize) -> f64 {
        self.cones[gear].cos() * (self.spiral[gear].cos() / self.helix().cos()).powi(3)
    }

    /// Radius of a gear over that of its virtual one.
    pub fn radius_factor(&self, gear: usize) -> f64 {
        self.cones[gear].cos() * (self.spiral[gear].cos() / self.helix().cos()).powi(2)
    }

    /// Face width of the virtual pair over that of a gear: the teeth are equally long.
    pub fn width_factor(&self, gear: usize) -> f64 {
        self.helix().cos() / self.spiral[gear].cos()
    }

    /// Speed along the teeth over that across them, `|tan ψ_1 − tan ψ_2|`.
    pub fn lengthwise(&self) -> f64 {
        (self.spiral[0].tan() - self.spiral[1].tan()).abs()
    }

    /// The efficiency of the sliding along the teeth, first gear driving and second gear driving; at or below zero the gear
    /// cannot drive.
    ///
    /// # Formula
    /// ```text
    /// η = (cos α_n + s μ tan ψ_2)/(cos α_n + s μ tan ψ_1)     s = 1 where ψ_1 > ψ_2, else −1
    /// η' = (cos α_n − s μ tan ψ_1)/(cos α_n − s μ tan ψ_2)
    /// ```
    /// The tangential force of a gear is `F_N (cos α_n cos ψ ± μ sin ψ)`: friction along the teeth of the gear with the larger
    /// spiral angle resists its motion, and helps that of the other.
    pub fn lengthwise_efficiency<R: Real>(&self, pressure_angle: R, mu: R) -> [R; 2] {
        let sign = (self.spiral[0] - self.spiral[1]).signum();
        let normal = pressure_angle.cos();
        let [first, second] = self.spiral.map(|psi| mu * (psi.tan() * sign));
        let over = |out: &R, input: &R| match input.re() > 0.0 {
            true => *out / *input,
            // Friction alone holds the gear that should drive.
            false => R::from(-1.0),
        };
        [over(&(normal + second), &(normal + first)), over(&(normal - first), &(normal - second))]
    }
}
