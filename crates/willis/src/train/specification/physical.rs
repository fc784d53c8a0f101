//! The physical layer of a specification: teeth, oil, bearings, seals, bodies that drag.

use crate::catalogue::bearing::Kind as BearingKind;
use crate::catalogue::oil::Base;
use crate::losses::seal::Material;
use crate::train::format::keys::Kind;
use crate::train::physical::LossPart;
use crate::units::{
    Angle, AngularSpeed, Density, DynamicViscosity, Force, KinematicViscosity, Length, Pressure, PressureCoefficient,
    Speed, Temperature, Torque, Volume, VolumeFlow,
};

use super::field::{choice, specification};

choice!(Base {
    Mineral = "mineral",
    Pao = "pao",
    Ester = "ester",
    Pag = "pag",
    PhosphateEster = "phosphate-ester",
    Traction = "traction",
});
choice!(BearingKind {
    DeepGrooveBall = "deep-groove-ball",
    AngularContactBall = "angular-contact-ball",
    DoubleRowAngularContactBall = "double-row-angular-contact-ball",
    FourPointContactBall = "four-point-contact-ball",
    SelfAligningBall = "self-aligning-ball",
    CylindricalRoller = "cylindrical-roller",
    FullComplementCylindricalRoller = "full-complement-cylindrical-roller",
    NeedleRoller = "needle-roller",
    TaperedRoller = "tapered-roller",
    SphericalRoller = "spherical-roller",
    ToroidalRoller = "toroidal-roller",
    AxialBall = "axial-ball",
    AxialCylindricalRoller = "axial-cylindrical-roller",
    Plain = "plain",
});
choice!(Material { Fkm = "fkm", Nbr = "nbr" });

/// How oil gets to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
choice!(OilSupply { Bath = "bath", Jet = "jet", Mist = "mist", Grease = "grease" });

/// What a body turns in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Fluid {
    /// Oil.
    Oil,
    /// What the gears turn in under a jet or a mist: air with oil in the ratio `mist` of `[oil]`, or what the law of
    /// windage was measured in.
    #[default]
    Mist,
    /// Air.
    Air,
}
choice!(Fluid { Oil = "oil", Mist = "mist", Air = "air" });

/// What a mesh is between its gears when a train vibrates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum MeshStiffness {
    /// It ties them.
    #[default]
    Rigid,
    /// A spring, by ISO 6336-1, method B.
    Iso6336,
}
choice!(MeshStiffness { Rigid = "rigid", Iso6336 = "iso-6336" });

/// Which way the teeth of a helical gear wind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Hand {
    /// As the thread of a common screw.
    Right,
    /// The other way.
    Left,
}
choice!(Hand { Right = "right", Left = "left" });

/// Where oil is sprayed at a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum JetSide {
    /// Where the teeth come into mesh.
    IntoMesh,
    /// Where they leave it.
    OutOfMesh,
}
choice!(JetSide { IntoMesh = "into-mesh", OutOfMesh = "out-of-mesh" });

impl Hand {
    /// 1 for right, -1 for left.
    pub(crate) fn sign(self) -> f64 {
        if self == Self::Right { 1.0 } else { -1.0 }
    }
}

specification! {
    /// The teeth of one gear, as far as known.
    ToothSpec => PlainTooth {
        /// Profile shift coefficient x; positive moves the teeth outward, also on a ring (DIN gives the opposite sign
        /// for rings). Default: 0.
        may shift: Option<f64>,
        /// Addendum coefficient of the basic rack. Default: that of the geometry, 1.
        may addendum: Option<f64>,
        /// Dedendum coefficient of the basic rack. Default: that of the geometry, 1.25.
        may dedendum: Option<f64>,
        /// Tip alteration k m_n; negative shortens the teeth.
        may tip_alteration: Option<Length>,
        /// Tip diameter, instead of addendum and alteration.
        may tip_diameter: Option<Length>,
        /// Arithmetic mean roughness Ra of the flanks. Default: that of the geometry.
        may roughness: Option<Length>,
        /// How deep the pitch circle dips into the oil at rest.
        may immersion: Option<Length>,
        /// Amount of a linear tip relief at the tip, C_a, in the transverse section. Default: none.
        may tip_relief: Option<Length>,
        /// Its length along the path of contact, from the tip.
        may tip_relief_length: Option<Length>,
        /// Mean spiral angle of a bevel gear, on both gears of the pair. Different ones make a hypoid pair. Default: `helix` of the
        /// geometry.
        may spiral_angle: Option<Angle>,
    }

    /// Involute teeth of a cylindrical pair, or of all pairs of a set.
    ///
    /// # Example
    /// ```
    /// use willis::train::{GeometrySpec, SetSpec, Train};
    /// use willis::units::Length;
    ///
    /// let train = Train::builder("reducer")
    ///     .members(["s", "c"])
    ///     .terminals(["s", "c"])
    ///     .set(
    ///         SetSpec::simple("P1", ("s", 30), ("frame", 70), "c")
    ///             .planet(20, 4)
    ///             .geometry(GeometrySpec::new(Length::mm(2.0), Length::mm(20.0))),
    ///     )
    ///     .build()?;
    /// let teeth = train.meshes()[0].teeth.as_ref().unwrap();
    /// assert!((teeth.pair.centre_distance - 50e-3).abs() < 1e-12);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    GeometrySpec => PlainGeometry {
        /// Normal module.
        must module: Length,
        /// Common face width; of one helix when double helical.
        must width: Length,
        /// Normal pressure angle. Default: 20 deg.
        may pressure_angle: Option<Angle>,
        /// Helix angle at the reference circle. Default: 0 deg.
        may helix: Option<Angle>,
        /// true for herringbone gears: two helices whose axial forces cancel.
        may double_helical: bool,
        /// Hand of the helix: of the first gear of a mesh, of the suns of a set (of its rings where it has none), of a
        /// gear with a geometry of its own. The mating gears follow. Default: gears on one shaft have the same hand.
        may hand: Option<Hand>,
        /// Where the middle of the teeth stands along the axis, from any origin that all positions share. Default: all
        /// gears and bearings in one plane.
        may position: Option<Length>,
        /// Operating centre distance. Default: the one that follows from the profile shifts.
        may centre_distance: Option<Length>,
        /// Angle between the axes of bevel gears. Default: 90 deg.
        may shaft_angle: Option<Angle>,
        /// Distance of the axes of a hypoid pair, to compare with the one that follows from the spiral angles.
        may offset: Option<Length>,
        /// Addendum coefficient of the basic rack. Default: 1.
        may addendum: Option<f64>,
        /// Dedendum coefficient of the basic rack. Default: 1.25.
        may dedendum: Option<f64>,
        /// Arithmetic mean roughness Ra of the flanks.
        may roughness: Option<Length>,
        /// Load of the planet that is loaded most over the mean, K_gamma, 1 or more. Pressures, films and loads of planet
        /// bearings are those of that planet; losses follow the mean. Default: 1, all planets alike.
        may load_sharing_factor: Option<f64>,
        /// Of the gear material. Default: steel, 206 GPa.
        may youngs_modulus: Option<Pressure>,
        /// Of the gear material. Default: 0.3.
        may poisson_ratio: Option<f64>,
        /// Oil that is sprayed at the mesh; of parallel meshes, at each.
        may jet_flow: Option<VolumeFlow>,
        /// Speed of that oil against the motion of the teeth. Default: none.
        may jet_speed: Option<Speed>,
        /// Where it is sprayed: `into-mesh`, or `out-of-mesh`. Default: into-mesh.
        may jet_side: Option<JetSide>,
        /// What the meshes are between their gears in `modes`: `rigid`, or springs by `iso-6336`. Default: rigid.
        may mesh_stiffness: Option<MeshStiffness>,
        /// Mean stiffness of each pair of external gears along the line of action over the face width, c_gamma, instead:
        /// 20 N/(mm um).
        may external_mesh_stiffness: Option<Pressure>,
        /// The same of each pair with a ring gear.
        may internal_mesh_stiffness: Option<Pressure>,
    }

    /// The lubricant. Either a name of the catalogue (`willis laws --oils`), or its data.
    OilSpec => PlainOil {
        /// A designation of the catalogue, `ISO VG 220`; or any name beside own data.
        may name: Option<String>,
        /// Base of the oil. Default: mineral.
        may base: Option<Base>,
        /// Kinematic viscosity at 40 degrees Celsius.
        may viscosity_40: Option<KinematicViscosity>,
        /// Kinematic viscosity at 100 degrees Celsius.
        may viscosity_100: Option<KinematicViscosity>,
        /// Dynamic viscosity at the operating temperature, instead of the two others.
        may viscosity: Option<DynamicViscosity>,
        /// Density at 15 degrees Celsius. Default: by base.
        may density_15: Option<Density>,
        /// Pressure-viscosity coefficient. Default: by base and viscosity.
        may pressure_viscosity: Option<PressureCoefficient>,
        /// Factor X_L of the oil in tooth friction, where measured. Default: by base.
        may lubricant_factor: Option<f64>,
        /// Operating temperature. Default: 60 degC.
        may temperature: Option<Temperature>,
        /// How the oil gets to gears and bearings: `bath` churns where gears are immersed, `jet` and `mist` turn the
        /// gears in air and oil mist.
        may supply: Option<OilSupply>,
        /// Volume of oil in the sump; needed for churning.
        may volume: Option<Volume>,
        /// Volumes of air to one volume of oil in the mist in which gears and rotors turn. Default: 34.25 under the windage
        /// law anderson-loewenthal, which was measured in it; air under the other laws.
        may mist: Option<f64>,
    }

    /// Which law of each family is used; `willis laws` lists them with range and source.
    LawsSpec => PlainLaws {
        /// Friction of the teeth. Default: schlenk, or constant without an oil.
        may mesh_friction: Option<String>,
        /// The coefficient of the law `constant`. Default: 0.05.
        may friction_coefficient: Option<f64>,
        /// Loss factor of a mesh.
        may loss_factor: Option<String>,
        /// Sharing of the load between tooth pairs.
        may load_sharing: Option<String>,
        /// Thickness of the oil film.
        may film: Option<String>,
        /// Reduction of the film by heating at the inlet.
        may film_reduction: Option<String>,
        /// Rolling losses. Default: with friction laws that lack them.
        may rolling: Option<String>,
        /// Friction of rolling bearings.
        may bearing: Option<String>,
        /// Gears in air.
        may windage: Option<String>,
        /// Gears in the sump.
        may churning: Option<String>,
        /// Lip seals.
        may seal: Option<String>,
        /// Carriers and drums.
        may rotor_drag: Option<String>,
        /// Open multi-plate clutches and brakes.
        may clutch_drag: Option<String>,
        /// Oil pumps.
        may pump: Option<String>,
        /// Oil that is sprayed at meshes.
        may injection: Option<String>,
        /// Plain bearings.
        may plain_bearing: Option<String>,
    }

    /// A number for each kind of loss, as tests give it.
    LossFactorSpec => PlainLossFactor {
        /// Tooth friction, sliding and rolling.
        may teeth: Option<f64>,
        /// The part of bearing friction that grows with the load.
        may bearing_load: Option<f64>,
        /// The part of bearing friction that is there without load.
        may bearing_no_load: Option<f64>,
        /// Lip seals.
        may seal: Option<f64>,
        /// Gears in the sump.
        may churning: Option<f64>,
        /// Gears in air.
        may windage: Option<f64>,
        /// Carriers and drums.
        may rotor: Option<f64>,
    }

    /// What tests say of the losses that the laws give.
    LossesSpec => PlainLosses {
        /// What the factors rest on, for readers: tests and their range.
        may calibrated: Option<String>,
        /// Factors on the losses of the laws. Default: 1.
        may factor: Option<LossFactorSpec>,
        /// Standard deviation of the natural logarithm of each factor that the tests leave; `willis uncertainty` reads it.
        may spread: Option<LossFactorSpec>,
    }

    /// What surrounds the gears.
    HousingSpec => PlainHousing {
        /// Factor on windage by `dawson-1984`: 1 free, 0.6 to 0.7 large case, 0.5 fitting case. Default: 1. `diab`
        /// takes the axial gap instead.
        may enclosure: Option<f64>,
        /// Axial distance from the gear faces to the wall. Default: free.
        may axial_gap: Option<Length>,
    }

    /// Rolling bearings between two members: `count` of them; on planets, at every planet.
    BearingSpec => PlainBearing {
        /// What it is called.
        must name: String,
        /// The two members it joins, or one that turns against the frame.
        must members: Vec<String>,
        /// `NU 1022`, `6205-2RS1`, `32216`: kind, size and constants from the catalogue.
        may designation: Option<String>,
        /// Kind, where the catalogue does not have it.
        may kind: Option<BearingKind>,
        /// Series of its constants, `10`, `62`, `322`.
        may series: Option<String>,
        /// Bore.
        may bore: Option<Length>,
        /// Outside diameter.
        may outside_diameter: Option<Length>,
        /// Width.
        may width: Option<Length>,
        /// Static load rating C0.
        may static_rating: Option<Force>,
        /// Of a plain bearing (kind `plain`, with bore and width): difference of its two diameters. Default: 0.0015 of
        /// the bore.
        may clearance: Option<Length>,
        /// Of a plain bearing: coefficient of friction where there is no full film. Default: 0.08.
        may friction: Option<f64>,
        /// Axial factor Y of a tapered bearing.
        may axial_factor: Option<f64>,
        /// How many sit side by side and share the load. Default: 1.
        may count: Option<i64>,
        /// Of the seat; checked against the bore.
        may shaft_diameter: Option<Length>,
        /// Distance between the outermost of them; takes the tilting moment of helical planets. Default: the face
        /// width.
        may span: Option<Length>,
        /// Where their middle stands along the axis, from the origin of the positions of the gears. Default: in the
        /// middle of the gears of their shaft.
        may position: Option<Length>,
        /// Whether they hold their shaft in place and take its thrust. Default: the first bearing of a shaft whose kind
        /// can.
        may locates: Option<bool>,
        /// A constant radial load beside those of the gears, on all of them together. Default: none.
        may radial_load: Option<Force>,
        /// A constant axial load beside those of the gears. Default: none.
        may axial_load: Option<Force>,
        /// How it gets its oil. Default: as the train.
        may supply: Option<OilSupply>,
        /// Oil level above the lowest rolling element's contact, for a bath.
        may level: Option<Length>,
    }

    /// What a shift element does while it is open: a measured curve, the plates of a pack, a band around a drum, or one
    /// torque.
    OpenSpec => PlainOpen {
        /// Torque over the amount of slip, measured by its maker or on a test bench.
        may curve: Option<Vec<(AngularSpeed, Torque)>>,
        /// Oil temperature at which the curve was measured. Default: 80 degC.
        may temperature: Option<Temperature>,
        /// Friction surfaces of a pack.
        may surfaces: Option<i64>,
        /// Inner radius of the friction surfaces.
        may inner_radius: Option<Length>,
        /// Outer radius of the friction surfaces.
        may outer_radius: Option<Length>,
        /// Gap between two plates, or between band and drum.
        may gap: Option<Length>,
        /// Oil through one gap. Default: 0.1 l/min.
        may flow: Option<VolumeFlow>,
        /// Part of the friction surface that is groove. Default: none.
        may groove_share: Option<f64>,
        /// Depth of the grooves.
        may groove_depth: Option<Length>,
        /// Radius of the drum of a band brake.
        may drum_radius: Option<Length>,
        /// Width of the band.
        may width: Option<Length>,
        /// Angle over which the band wraps the drum.
        may wrap: Option<Angle>,
        /// Part of the band that oil wets. Default: 1.
        may wetted: Option<f64>,
        /// One torque at any slip: the spring of a one-way clutch that overruns.
        may torque: Option<Torque>,
    }

    /// An oil pump that a member of the train drives. All of its power becomes heat of the oil.
    PumpSpec => PlainPump {
        /// What it is called.
        must name: String,
        /// The member that drives it.
        must member: String as Kind::Name,
        /// Oil of one turn.
        must displacement: Volume,
        /// Pressure against which it delivers.
        must pressure: Pressure,
        /// Hydromechanical efficiency. Default: 0.85.
        may efficiency: Option<f64>,
    }

    /// A radial lip seal.
    SealSpec => PlainSeal {
        /// What it is called.
        must name: String,
        /// The shaft, or the shaft and the member that holds the seal (default: the frame).
        must members: Vec<String>,
        /// Shaft diameter.
        must diameter: Length,
        /// Of the lip. Default: fkm.
        may material: Option<Material>,
        /// How many lips. Default: 1.
        may count: Option<i64>,
    }

    /// A smooth body of revolution, a carrier or a drum, that drags the fluid around it.
    RotorSpec => PlainRotor {
        /// What it is called.
        must name: String,
        /// The member it belongs to.
        must member: String as Kind::Name,
        /// Outer radius.
        must radius: Length,
        /// Axial length of the rim.
        must length: Length,
        /// Gap between rim and wall.
        must radial_gap: Length,
        /// Gap between each face and the wall. Default: the radial gap.
        may axial_gap: Option<Length>,
        /// What it turns in. Default: mist, the same fluid as the gears.
        may fluid: Option<Fluid>,
    }
}

impl GeometrySpec {
    /// Spur gears of steel with the basic rack of ISO 53.
    pub fn new(module: Length, width: Length) -> Self {
        Self { module, width, ..Self::default() }
    }
}

/// What stands in for what a geometry does not say: spur gears of steel with the basic rack of ISO 53.
impl PlainGeometry {
    pub(crate) fn pressure_angle(&self) -> f64 {
        self.pressure_angle.unwrap_or(20f64.to_radians())
    }

    pub(crate) fn helix(&self) -> f64 {
        self.helix.unwrap_or(0.0)
    }

    pub(crate) fn addendum(&self) -> f64 {
        self.addendum.unwrap_or(1.0)
    }

    pub(crate) fn dedendum(&self) -> f64 {
        self.dedendum.unwrap_or(1.25)
    }

    pub(crate) fn youngs_modulus(&self) -> f64 {
        self.youngs_modulus.unwrap_or(206e9)
    }

    pub(crate) fn poisson_ratio(&self) -> f64 {
        self.poisson_ratio.unwrap_or(0.3)
    }
}

impl LawsSpec {
    fn families_mut(&mut self) -> [(&'static str, &mut Option<String>); 15] {
        [
            ("mesh_friction", &mut self.mesh_friction),
            ("loss_factor", &mut self.loss_factor),
            ("load_sharing", &mut self.load_sharing),
            ("film", &mut self.film),
            ("film_reduction", &mut self.film_reduction),
            ("rolling", &mut self.rolling),
            ("bearing", &mut self.bearing),
            ("windage", &mut self.windage),
            ("churning", &mut self.churning),
            ("seal", &mut self.seal),
            ("rotor_drag", &mut self.rotor_drag),
            ("clutch_drag", &mut self.clutch_drag),
            ("pump", &mut self.pump),
            ("injection", &mut self.injection),
            ("plain_bearing", &mut self.plain_bearing),
        ]
    }

    /// Family and law of each choice.
    pub(crate) fn choices(&self) -> Vec<(&'static str, String)> {
        let mut all = self.clone();
        all.families_mut().into_iter().filter_map(|(family, law)| Some((family, law.take()?))).collect()
    }
}

impl PlainLossFactor {
    /// By kind of loss, in their order.
    pub(crate) fn values(&self) -> [Option<f64>; LossPart::COUNT] {
        [self.teeth, self.bearing_load, self.bearing_no_load, self.seal, self.churning, self.windage, self.rotor]
    }
}
