use std::f64::consts::{PI, TAU};

use super::{Basis, PairData, inverse_involute, involute};

/// Sun, planet and ring of one set with a common module: what decides whether sun and ring can
/// share one axis.
///
/// # Example
/// Sun 17, planet 24, ring 67 of diametral pitch 8/in: without shifts they would need 25 teeth on
/// the planet. With 24 at 2.65 in the two meshes run at different angles.
/// ```
/// use willis::geometry::SimpleSetGeometry;
///
/// let chain = SimpleSetGeometry {
///     module: 25.4e-3 / 8.0,
///     pressure_angle: 20f64.to_radians(),
///     helix: 0.0,
///     teeth: [17.0, 24.0, 67.0],
///     shifts: [0.0, 0.0, 0.0],
/// };
/// let [outer, inner] = chain.coaxial_operating_angles(2.65 * 25.4e-3).unwrap();
/// assert_eq!(format!("{:.4} {:.4}", outer.to_degrees(), inner.to_degrees()), "24.6785 17.6380");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SimpleSetGeometry {
    /// Normal module, m.
    pub module: f64,
    /// Normal pressure angle, rad.
    pub pressure_angle: f64,
    /// Helix angle at the reference circle, rad.
    pub helix: f64,
    /// Tooth counts of sun, planet and ring.
    pub teeth: [f64; 3],
    /// Profile shifts of sun, planet and ring, positive outward also on the ring.
    pub shifts: [f64; 3],
}

impl SimpleSetGeometry {
    /// Operating centre distances of sun–planet and planet–ring, m, each without backlash at its
    /// own shifts. Sun and ring are coaxial where both are equal. `None` where a mesh has no
    /// operating angle.
    ///
    /// `inv α_wt = inv α_t + 2 tan α_n Σx/Σz`, `a = Σz m_t cos α_t/(2 cos α_wt)`, with
    /// Σx = x_s + x_p, Σz = z_s + z_p outside and Σx = x_r − x_p, Σz = z_r − z_p inside.
    ///
    /// # Source
    /// `[iso21771]`, working transverse pressure angle.
    ///
    /// # Example
    /// ```
    /// # use willis::geometry::SimpleSetGeometry;
    /// let chain = SimpleSetGeometry {
    ///     module: 4e-3,
    ///     pressure_angle: 20f64.to_radians(),
    ///     helix: 0.0,
    ///     teeth: [17.0, 22.0, 61.0],
    ///     shifts: [0.0; 3],
    /// };
    /// let [outer, inner] = chain.centre_distances().unwrap();
    /// assert!((outer - 78e-3).abs() < 1e-15 && (inner - 78e-3).abs() < 1e-15);
    /// ```
    pub fn centre_distances(&self) -> Option<[f64; 2]> {
        let basis = self.basis();
        let mut distances = [0.0; 2];
        for (distance, (sum_of_teeth, sum_of_shifts)) in distances.iter_mut().zip(self.sums()) {
            let value =
                involute(basis.transverse_angle) + 2.0 * self.pressure_angle.tan() * sum_of_shifts / sum_of_teeth;
            *distance = basis.base_distance(sum_of_teeth) / inverse_involute(value)?.cos();
        }
        distances.iter().all(|a| a.is_finite() && *a > 0.0).then_some(distances)
    }

    /// Operating transverse pressure angles, rad, of sun–planet and planet–ring on a common centre
    /// distance, m: `cos α_wt = Σz m_t cos α_t/(2 a)`. `None` where the base circles do not leave
    /// room for one of them.
    ///
    /// # Source
    /// `[iso21771]`, working transverse pressure angle. Example: [`SimpleSetGeometry`].
    pub fn coaxial_operating_angles(&self, centre_distance: f64) -> Option<[f64; 2]> {
        let basis = self.basis();
        let cosines = self.sums().map(|(teeth, _)| basis.base_distance(teeth) / centre_distance);
        cosines.iter().all(|c| *c > 0.0 && *c <= 1.0).then(|| cosines.map(f64::acos))
    }

    /// Profile shift of the ring at which the mesh planet–ring runs without backlash on the centre
    /// distance of sun–planet: the condition of coaxiality solved for x_r. `None` where there is
    /// no such angle.
    ///
    /// # Example
    /// ```
    /// # use willis::geometry::SimpleSetGeometry;
    /// let mut chain = SimpleSetGeometry {
    ///     module: 4e-3,
    ///     pressure_angle: 20f64.to_radians(),
    ///     helix: 0.0,
    ///     teeth: [17.0, 22.0, 62.0],
    ///     shifts: [0.3, 0.2, 0.0],
    /// };
    /// chain.shifts[2] = chain.coaxial_ring_shift().unwrap();
    /// let [outer, inner] = chain.centre_distances().unwrap();
    /// assert!((outer - inner).abs() < 1e-15);
    /// ```
    pub fn coaxial_ring_shift(&self) -> Option<f64> {
        let [distance, _] =
            Self { shifts: [self.shifts[0], self.shifts[1], self.shifts[1]], ..*self }.centre_distances()?;
        let [_, angle] = self.coaxial_operating_angles(distance)?;
        let teeth = self.teeth[2] - self.teeth[1];
        let needed = involute(angle) - involute(self.basis().transverse_angle);
        Some(self.shifts[1] + teeth * needed / (2.0 * self.pressure_angle.tan()))
    }

    fn basis(&self) -> Basis<f64> {
        Basis::new(self.module, self.pressure_angle, self.helix)
    }

    /// Sums of teeth and of shifts, outer and inner mesh.
    fn sums(&self) -> [(f64, f64); 2] {
        let ([zs, zp, zr], [xs, xp, xr]) = (self.teeth, self.shifts);
        [(zs + zp, xs + xp), (zr - zp, xr - xp)]
    }
}

/// Least mesh angle, rad: every angle between two simple planets of a set is a multiple of
/// `2π/(z_sun + z_ring)`.
///
/// # Source
/// Derived from the phases of the teeth; `[uts_60_1161]` prints the number of the example.
///
/// # Example
/// ```
/// let angle = willis::geometry::least_mesh_angle(17.0, 67.0);
/// assert_eq!(format!("{:.4}", angle.to_degrees()), "4.2857");
/// ```
pub fn least_mesh_angle(sun_teeth: f64, ring_teeth: f64) -> f64 {
    TAU / (sun_teeth + ring_teeth)
}

/// Clearance between the tip circles of neighbouring planets, m: `2 a sin(π/n) − d_a`. Negative:
/// they collide. One planet has no neighbour: infinite.
///
/// # Example
/// Three planets of 31 teeth on 249.14 mm: by hand 2 · 249.14 · 0.86603 − 248.04 = 183.48 mm.
/// ```
/// let gap = willis::geometry::neighbour_clearance(249.141526e-3, 3, 124.021020e-3);
/// assert_eq!(format!("{:.3}", gap * 1e3), "183.484");
/// ```
pub fn neighbour_clearance(centre_distance: f64, planets: u32, tip_radius: f64) -> f64 {
    match planets {
        0 | 1 => f64::INFINITY,
        n => 2.0 * centre_distance * (PI / f64::from(n)).sin() - 2.0 * tip_radius,
    }
}

/// Profile shifts of a pair that runs without backlash on its given centre distance, when the
/// first wheel keeps its own: `x_1 + x_2 = (z_1 + z_2)(inv α_wt − inv α_t)/(2 tan α_n)`; with a
/// ring the difference ring less pinion. Without a centre distance the shifts are those of the
/// data. `None` where there is no operating angle.
///
/// # Source
/// `[iso21771]`, sum of the profile shift coefficients.
///
/// # Example
/// ```
/// use willis::geometry::{Pair, PairData, Tip, Wheel, conjugate_shifts};
///
/// let wheel = |teeth, shift| Wheel {
///     teeth,
///     internal: false,
///     shift,
///     tip: Tip::Addendum { coefficient: 1.0, alteration: 0.0 },
///     dedendum: 1.25,
/// };
/// let mut data = PairData {
///     module: 4.5e-3,
///     pressure_angle: 20f64.to_radians(),
///     helix: 0.0,
///     double_helical: false,
///     width: 14e-3,
///     centre_distance: Some(91.5e-3),
///     wheels: [wheel(16.0, 0.1817), wheel(24.0, 0.0)],
/// };
/// let [x1, x2] = conjugate_shifts(&data).unwrap();
/// assert_eq!(format!("{x1:.4} {x2:.4}"), "0.1817 0.1715");
/// ```
pub fn conjugate_shifts(data: &PairData) -> Option<[f64; 2]> {
    let [first, second] = &data.wheels;
    let Some(distance) = data.centre_distance else {
        return Some([first.shift, second.shift]);
    };
    let basis = Basis::new(data.module, data.pressure_angle, data.helix);
    let [side0, side1] = [first, second].map(|w| if w.internal { -1.0 } else { 1.0 });
    let internal = first.internal || second.internal;
    let teeth = if internal { (second.teeth - first.teeth).abs() } else { first.teeth + second.teeth };
    let cosine = basis.base_distance(teeth) / distance;
    if !(cosine > 0.0 && cosine <= 1.0) {
        return None;
    }
    let sum = teeth * (involute(cosine.acos()) - involute(basis.transverse_angle)) / (2.0 * data.pressure_angle.tan());
    // outside x1 + x2 = sum; with a ring (ring) − (pinion) = sum
    let sum = if internal { -sum } else { sum };
    let other = (sum - side0 * first.shift) / side1;
    other.is_finite().then_some([first.shift, other])
}
