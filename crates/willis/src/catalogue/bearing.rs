//! Rolling bearings: type, series, envelope and the constants of their friction laws.

/// Type of a rolling bearing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// Deep groove ball bearing.
    DeepGrooveBall,
    /// Angular contact ball bearing, one row.
    AngularContactBall,
    /// Cylindrical roller bearing with cage.
    CylindricalRoller,
    /// Cylindrical roller bearing, full complement.
    FullComplementCylindricalRoller,
    /// Needle roller bearing or cage.
    NeedleRoller,
    /// Tapered roller bearing.
    TaperedRoller,
    /// Spherical roller bearing.
    SphericalRoller,
}

/// A rolling bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct Bearing {
    /// Designation, or what the user calls it.
    pub designation: String,
    /// Its type.
    pub kind: Kind,
    /// Dimension series, `10`, `3`, `322`; empty when not known.
    pub series: String,
    /// Bore, m.
    pub bore: f64,
    /// Outside diameter, m.
    pub outside_diameter: f64,
    /// Width, m.
    pub width: f64,
    /// Static load rating `C0`, N, where known.
    pub static_rating: Option<f64>,
    /// Axial factor `Y` of tapered rollers, where known.
    pub axial_factor: Option<f64>,
}
