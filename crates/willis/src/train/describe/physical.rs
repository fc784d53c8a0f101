//! The physical layer of a train as a person describes it: teeth, oil, bearings, seals, bodies that
//! drag. All quantities SI; what is `None` is assumed, and the assumption is told.

/// Teeth of one gear, as far as known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToothSpec {
    /// Profile shift coefficient; positive moves the teeth outward, also on a ring.
    pub shift: Option<f64>,
    /// Addendum coefficient of the basic rack.
    pub addendum: Option<f64>,
    /// Dedendum coefficient of the basic rack.
    pub dedendum: Option<f64>,
    /// Tip alteration `k m_n`, m; negative shortens the teeth.
    pub tip_alteration: Option<f64>,
    /// Tip diameter, m, instead of addendum and alteration.
    pub tip_diameter: Option<f64>,
    /// Arithmetic mean roughness `Ra`, m.
    pub roughness: Option<f64>,
    /// Depth of immersion of the pitch circle at rest, m.
    pub immersion: Option<f64>,
}

/// Involute teeth of a cylindrical pair, or of all pairs of a set.
///
/// # Example
/// ```
/// use willis::train::{GeometrySpec, SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(
///         SetSpec::simple("P1", ("s", 30), ("frame", 70), "c")
///             .planet(20, 4)
///             .geometry(GeometrySpec { module: 2e-3, width: 20e-3, ..GeometrySpec::default() }),
///     )
///     .build()?;
/// let teeth = train.meshes()[0].teeth.as_ref().unwrap();
/// assert!((teeth.pair.centre_distance - 50e-3).abs() < 1e-12);
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeometrySpec {
    /// Normal module, m.
    pub module: f64,
    /// Common face width, m; of one helix when double helical.
    pub width: f64,
    /// Normal pressure angle, rad.
    pub pressure_angle: f64,
    /// Helix angle at the reference circle, rad.
    pub helix: f64,
    /// Herringbone gears.
    pub double_helical: bool,
    /// Operating centre distance, m; `None`: as the profile shifts give it.
    pub centre_distance: Option<f64>,
    /// Addendum coefficient of the basic rack.
    pub addendum: f64,
    /// Dedendum coefficient of the basic rack.
    pub dedendum: f64,
    /// Arithmetic mean roughness `Ra` of the flanks, m.
    pub roughness: Option<f64>,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
}

impl Default for GeometrySpec {
    /// Spur gears of steel with the basic rack of ISO 53; module and width are to be given.
    fn default() -> Self {
        Self {
            module: 0.0,
            width: 0.0,
            pressure_angle: 20f64.to_radians(),
            helix: 0.0,
            double_helical: false,
            centre_distance: None,
            addendum: 1.0,
            dedendum: 1.25,
            roughness: None,
            youngs_modulus: 206e9,
            poisson_ratio: 0.3,
        }
    }
}

/// The lubricant: a name of the catalogue, or data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OilSpec {
    /// Designation in the catalogue, or any name beside own data.
    pub name: Option<String>,
    /// Base of the oil.
    pub base: Option<crate::catalogue::oil::Base>,
    /// Kinematic viscosity at 40 °C, m²/s.
    pub viscosity_40: Option<f64>,
    /// Kinematic viscosity at 100 °C, m²/s.
    pub viscosity_100: Option<f64>,
    /// Dynamic viscosity at the operating temperature, Pa s.
    pub viscosity: Option<f64>,
    /// Density at 15 °C, kg/m³.
    pub density_15: Option<f64>,
    /// Pressure-viscosity coefficient, 1/Pa.
    pub pressure_viscosity: Option<f64>,
    /// Factor `X_L` of the oil in tooth friction.
    pub lubricant_factor: Option<f64>,
    /// Operating temperature, K.
    pub temperature: Option<f64>,
    /// How the oil gets to gears and bearings.
    pub supply: Option<OilSupply>,
    /// Volume in the sump, m³.
    pub volume: Option<f64>,
    /// Volumes of air to one of oil in the mist.
    pub mist: Option<f64>,
}

/// How oil gets to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OilSupply {
    /// Gears and bearings dip into a sump.
    Bath,
    /// Oil is injected; gears turn in a mist.
    Jet,
    /// Oil mist or oil-air.
    Mist,
    /// Grease.
    Grease,
}

/// What surrounds the gears.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HousingSpec {
    /// Factor of the enclosure on windage.
    pub enclosure: Option<f64>,
    /// Axial distance from the gear faces to the wall, m.
    pub axial_gap: Option<f64>,
}

/// Rolling bearings between two members.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BearingSpec {
    /// What it is called.
    pub name: String,
    /// The members it joins; one means against the frame.
    pub members: Vec<String>,
    /// Designation in the catalogue.
    pub designation: Option<String>,
    /// Kind, where the catalogue does not have it.
    pub kind: Option<crate::catalogue::bearing::Kind>,
    /// Series of its constants.
    pub series: Option<String>,
    /// Bore, m.
    pub bore: Option<f64>,
    /// Outside diameter, m.
    pub outside_diameter: Option<f64>,
    /// Width, m.
    pub width: Option<f64>,
    /// Static load rating, N.
    pub static_rating: Option<f64>,
    /// Axial factor `Y`.
    pub axial_factor: Option<f64>,
    /// How many share the load.
    pub count: Option<i64>,
    /// Diameter of the seat, m.
    pub shaft_diameter: Option<f64>,
    /// Distance between the outermost, m.
    pub span: Option<f64>,
    /// Constant radial load beside those of the gears, N.
    pub radial_load: Option<f64>,
    /// Constant axial load beside those of the gears, N.
    pub axial_load: Option<f64>,
    /// How it gets its oil.
    pub supply: Option<OilSupply>,
    /// Oil level, m.
    pub level: Option<f64>,
}

/// A radial lip seal.
#[derive(Clone, Debug, PartialEq)]
pub struct SealSpec {
    /// What it is called.
    pub name: String,
    /// The shaft, and the member that holds the seal (default: the frame).
    pub members: Vec<String>,
    /// Shaft diameter, m.
    pub diameter: f64,
    /// Material of the lip.
    pub material: crate::losses::seal::Material,
    /// How many lips.
    pub count: i64,
}

/// A smooth body of revolution that drags the fluid around it.
#[derive(Clone, Debug, PartialEq)]
pub struct RotorSpec {
    /// What it is called.
    pub name: String,
    /// The member it belongs to.
    pub member: String,
    /// Outer radius, m.
    pub radius: f64,
    /// Axial length of the rim, m.
    pub length: f64,
    /// Gap between rim and wall, m.
    pub radial_gap: f64,
    /// Gap between each face and the wall, m; `None`: the radial gap.
    pub axial_gap: Option<f64>,
    /// What it turns in.
    pub fluid: Fluid,
}

/// What a body turns in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Fluid {
    /// Oil.
    Oil,
    /// Air and oil mist.
    #[default]
    Mist,
    /// Air.
    Air,
}
