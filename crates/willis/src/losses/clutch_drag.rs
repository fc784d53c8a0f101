//! Torque of an open multi-plate clutch or brake in oil.

/// State of an open pack.
#[derive(Clone, Copy, Debug)]
pub struct OpenPack<D> {
    /// Absolute speeds of both kinds of plates, signed, rad/s.
    pub speeds: [D; 2],
    /// Friction surfaces.
    pub surfaces: f64,
    /// Inner radius of the friction surfaces, m.
    pub inner_radius: D,
    /// Outer radius of the friction surfaces, m.
    pub outer_radius: D,
    /// Gap between two plates, m.
    pub gap: D,
    /// Oil that flows through one gap, m³/s.
    pub flow: D,
    /// Part of the surface that is groove, 0 to below 1.
    pub groove_share: D,
    /// Depth of the grooves, m.
    pub groove_depth: D,
    /// Density of the oil, kg/m³.
    pub density: D,
    /// Dynamic viscosity of the oil, Pa s.
    pub viscosity: D,
}

family! {
    /// Torque of an open multi-plate clutch or brake in oil.
    ClutchDrag ("clutch_drag"): OpenPack => "T" ["N m"];
    rivulets::Rivulets,
    equivalent_radius::EquivalentRadius,
    full_film::FullFilm,
}

impl OpenPack<f64> {
    /// Ten surfaces of 62 to 75 mm, 0.2 mm apart, with 0.1 l/min of an automatic transmission fluid of 6.5 mPa s in each
    /// gap; one side at rest, the other at 1000 r/min. For examples and tests.
    pub fn typical() -> Self {
        Self {
            speeds: [1000.0 * std::f64::consts::PI / 30.0, 0.0],
            surfaces: 10.0,
            inner_radius: 62e-3,
            outer_radius: 75e-3,
            gap: 0.2e-3,
            flow: 1e-4 / 60.0,
            groove_share: 0.0,
            groove_depth: 0.0,
            density: 820.0,
            viscosity: 6.5e-3,
        }
    }
}

impl<D: crate::Real> OpenPack<D> {
    /// Speed of the plates relative to each other, rad/s.
    fn slip(&self) -> D {
        crate::real::abs(self.speeds[0] - self.speeds[1])
    }

    /// `K = (3 ω₁² + 4 ω₁ ω₂ + 3 ω₂²)/10`, by which the film is thrown outward.
    fn throw(&self) -> D {
        let [a, b] = self.speeds;
        (a * a * 3.0 + a * b * 4.0 + b * b * 3.0) / 10.0
    }

    /// Groove area and depth take part of the shear.
    fn shear_share(&self) -> D {
        let f = self.groove_share;
        -f + 1.0 + f * self.gap / (self.gap + self.groove_depth)
    }

    /// Torque of gaps full of oil out to a radius.
    fn film(&self, outer: D) -> D {
        let ring = outer.powi(4) - self.inner_radius.powi(4);
        self.viscosity * self.slip() * ring * self.shear_share() / self.gap
            * (0.5 * std::f64::consts::PI * self.surfaces)
    }

    /// Oil that each gap passes when it is just full, over the throw, m³ s.
    fn passes(&self) -> D {
        let channels = (self.groove_depth / self.gap + 1.0).powi(3);
        let wider = -self.groove_share + 1.0 + self.groove_share * channels;
        self.density * self.gap.powi(3) * wider / self.viscosity * (std::f64::consts::PI / 12.0)
    }
}
