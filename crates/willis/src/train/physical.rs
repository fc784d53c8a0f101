//! The physical layer of a train: teeth, oil, bearings, seals, bodies that drag.

use crate::catalogue::bearing::Bearing;
use crate::catalogue::oil::{Oil, Viscosity};
use crate::geometry::Pair;
use crate::geometry::hypoid::Hypoid;
use crate::losses::load_sharing::Relief;
use crate::losses::seal::Material;
use crate::real::{self, Real};

use super::dynamic::Curve;
use super::specification::{Fluid, JetSide, OilSupply};
use super::{MemberId, Mesh, MeshId};

/// Part of the face width of bevel gears that carries, ISO 10300-1. Confirm.
pub(crate) const BEVEL_WIDTH: f64 = 0.85;

/// Teeth of a mesh.
#[derive(Clone, Debug)]
pub struct Teeth<R = f64> {
    /// The involute pair; its wheels stand in the order of the mesh's gears. Of bevel gears the virtual cylindrical pair at the
    /// middle of the face width: `z_v = z/cos δ`, `d_v = d_m/cos δ` (Tredgold), on the part of the width that carries.
    pub pair: Pair<R>,
    /// How many times as fast as bevel gears their virtual gears turn: `cos δ` of the pitch cones, of hypoid gears
    /// [another factor](Hypoid::speed_factor). None of cylindrical gears.
    pub cones: Option<[f64; 2]>,
    /// What makes bevel gears hypoid gears.
    pub hypoid: Option<Hypoid>,
    /// Arithmetic mean roughness of both flanks, m.
    pub roughness: [R; 2],
    /// Depth of immersion of both gears at rest, m.
    pub immersion: [Option<R>; 2],
    /// Oil that is sprayed at the mesh; of parallel meshes, at each.
    pub jet: Option<Jet<R>>,
    /// Hand of the helix of the first gear: 1 right, -1 left. That of the second is the opposite, of a ring the same.
    pub hand: f64,
    /// Where the middle of the teeth stands along the axis, m.
    pub position: Option<R>,
    /// Load of the mesh that is loaded most of those in parallel over the mean, `K_γ`, ≥ 1.
    pub sharing: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus: R,
    /// Poisson's ratio.
    pub poisson_ratio: R,
    /// Stiffness of one pair along the line of action over its whole width, N/m; `None`: rigid.
    pub stiffness: Option<f64>,
    /// Whether it may follow from the teeth, by ISO 6336-1.
    pub stiffness_by_standard: bool,
    /// Tip relief of the gears; none where neither has any.
    pub relief: Option<TipRelief<R>>,
}

/// Linear tip relief of both gears of a mesh, in the order of the mesh's gears; zeros where one has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipRelief<R = f64> {
    /// Amount at the tip `C_a`, m.
    pub amount: [R; 2],
    /// Length along the path of contact, from the tip, m.
    pub length: [R; 2],
    /// Mean stiffness of the mesh over its width `c_γ` where it is given, N/m for each m; by ISO 6336-1 where it is not.
    pub stiffness: Option<f64>,
}

impl<R: Real> Teeth<R> {
    /// Speed of a gear of the pair over that of the gear of the mesh: 1, of bevel gears `cos δ`.
    pub(crate) fn cone(&self, gear: usize) -> f64 {
        self.cones.map_or(1.0, |c| c[gear])
    }

    /// Radius of a gear of the mesh over that of the pair.
    pub(crate) fn size(&self, gear: usize) -> f64 {
        self.hypoid.as_ref().map_or(self.cone(gear), |h| h.radius_factor(gear))
    }

    /// Speed along the teeth of hypoid gears over that of the first gear of the pair, m; zero of others.
    pub(crate) fn lengthwise_per_speed(&self) -> R {
        let Some(hypoid) = &self.hypoid else { return R::from(0.0) };
        self.pair.gears[0].operating_radius * (hypoid.helix().cos() * hypoid.lengthwise())
    }

    /// Reduced modulus `E' = E/(1 − ν²)` of two equal materials, Pa.
    pub fn reduced_modulus(&self) -> R {
        self.youngs_modulus / (-(self.poisson_ratio * self.poisson_ratio) + 1.0)
    }

    /// The tip relief under a force at the base circles, N.
    pub(crate) fn relief(&self, base_force: R) -> Relief<R> {
        let Some(relief) = self.relief.filter(|_| base_force.re() > 0.0) else { return Relief::none() };
        let pair = &self.pair;
        let stiffness = match relief.stiffness {
            Some(mean) => R::from(mean) / (pair.contact_ratio * 0.75 + 0.25),
            None => pair.pair_stiffness(self.youngs_modulus),
        };
        let width = pair.total_width();
        // Beyond the bound all contact is single to one part in a million, and the difference of two depths is lost.
        let depth = |k: usize| real::min(relief.amount[k] * stiffness * width / base_force, R::from(1e6));
        let length = |k: usize| relief.length[k] / pair.base_pitch;
        // The tip of the second gear enters at A, that of the first leaves at E.
        Relief { depth: [depth(1), depth(0)], length: [length(1), length(0)] }
    }

    /// Hand of the helix of one of the two gears: 1 right, -1 left.
    pub fn hand_of(&self, gear: usize) -> f64 {
        if gear == 0 || self.pair.internal() { self.hand } else { -self.hand }
    }
}

/// Oil that is sprayed at a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<R = f64> {
    /// Oil, m³/s.
    pub flow: R,
    /// Speed against the motion of the teeth, m/s.
    pub speed: R,
    /// Where.
    pub side: JetSide,
}

/// What a shift element does while it is open.
#[derive(Clone, Debug, PartialEq)]
pub enum OpenElement<R = f64> {
    /// The plates of a pack.
    Pack {
        /// Friction surfaces.
        surfaces: u32,
        /// Inner radius, m.
        inner_radius: R,
        /// Outer radius, m.
        outer_radius: R,
        /// Gap between two plates, m.
        gap: R,
        /// Oil through one gap, m³/s.
        flow: R,
        /// Part of the surface that is groove.
        groove_share: R,
        /// Depth of the grooves, m.
        groove_depth: R,
    },
    /// A band around a drum.
    Band {
        /// Radius of the drum, m.
        radius: R,
        /// Width of the band, m.
        width: R,
        /// Angle of wrap, rad.
        wrap: R,
        /// Gap, m.
        gap: R,
        /// Part of the band that oil wets.
        wetted: R,
    },
    /// A measured curve over slip, rad/s to N m, at a temperature of the oil, K.
    Curve(Curve, f64),
    /// One torque at any slip, N m.
    Torque(R),
}

/// The numbers of an open shift element that a study may move.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub(crate) enum OpenNumber {
    InnerRadius,
    OuterRadius,
    Gap,
    Flow,
    GrooveShare,
    GrooveDepth,
    DrumRadius,
    Width,
    Wrap,
    Wetted,
    Torque,
}

impl OpenElement {
    /// The same with other numbers, each made from which it is and its value.
    pub(crate) fn lift<D: Real>(&self, of: &dyn Fn(OpenNumber, f64) -> D) -> OpenElement<D> {
        use OpenNumber as N;
        match self {
            Self::Pack { surfaces, inner_radius, outer_radius, gap, flow, groove_share, groove_depth } => {
                OpenElement::Pack {
                    surfaces: *surfaces,
                    inner_radius: of(N::InnerRadius, *inner_radius),
                    outer_radius: of(N::OuterRadius, *outer_radius),
                    gap: of(N::Gap, *gap),
                    flow: of(N::Flow, *flow),
                    groove_share: of(N::GrooveShare, *groove_share),
                    groove_depth: of(N::GrooveDepth, *groove_depth),
                }
            }
            Self::Band { radius, width, wrap, gap, wetted } => OpenElement::Band {
                radius: of(N::DrumRadius, *radius),
                width: of(N::Width, *width),
                wrap: of(N::Wrap, *wrap),
                gap: of(N::Gap, *gap),
                wetted: of(N::Wetted, *wetted),
            },
            Self::Curve(curve, temperature) => OpenElement::Curve(curve.clone(), *temperature),
            Self::Torque(torque) => OpenElement::Torque(of(N::Torque, *torque)),
        }
    }
}

/// An oil pump that a member drives.
#[derive(Clone, Debug)]
pub struct Pump {
    /// What it is called.
    pub name: String,
    /// The member that drives it.
    pub member: MemberId,
    /// Oil of one turn, m³.
    pub displacement: f64,
    /// Pressure, Pa.
    pub pressure: f64,
    /// Hydromechanical efficiency, where given.
    pub efficiency: Option<f64>,
}

/// The oil of a train and how it gets around.
#[derive(Clone, Debug)]
pub struct Lubrication {
    /// The oil.
    pub oil: Oil,
    /// Operating temperature, K.
    pub temperature: f64,
    /// How the oil gets to gears and bearings, when given.
    pub supply: Option<OilSupply>,
    /// Volume in the sump, m³.
    pub volume: Option<f64>,
    /// Volumes of air to one of oil in the mist, where given.
    pub mist: Option<f64>,
}

impl Lubrication {
    /// What is wrong with the oil's data at a temperature, K: it lies outside them, or they hold for one
    /// temperature only.
    pub(crate) fn beyond(&self, temperature: f64) -> Option<Beyond> {
        let known = match self.oil.viscosity {
            Viscosity::Fixed { .. } => Known::At(self.temperature),
            _ => Known::Between(self.oil.temperature_range()),
        };
        let inside = match known {
            Known::At(given) => (temperature - given).abs() <= 0.5,
            Known::Between(_) => self.oil.covers(temperature),
        };
        (!inside).then(|| Beyond { oil: self.oil.name.clone(), temperature, known })
    }
}

/// A kind of loss that tests can scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LossPart {
    /// Tooth friction, sliding and rolling.
    Teeth,
    /// The part of bearing friction that grows with the load.
    BearingLoad,
    /// The part of bearing friction that is there without load.
    BearingNoLoad,
    /// Lip seals.
    Seal,
    /// Gears in the sump.
    Churning,
    /// Gears in air.
    Windage,
    /// Carriers and drums.
    Rotor,
}

impl LossPart {
    /// How many there are.
    pub const COUNT: usize = 7;
    /// All, in their order.
    pub const ALL: [Self; Self::COUNT] =
        [Self::Teeth, Self::BearingLoad, Self::BearingNoLoad, Self::Seal, Self::Churning, Self::Windage, Self::Rotor];

    /// Its key in the train file: `bearing_load`.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Teeth => "teeth",
            Self::BearingLoad => "bearing_load",
            Self::BearingNoLoad => "bearing_no_load",
            Self::Seal => "seal",
            Self::Churning => "churning",
            Self::Windage => "windage",
            Self::Rotor => "rotor",
        }
    }

    /// For people: `bearings under load`.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Teeth => "tooth friction",
            Self::BearingLoad => "bearings, by load",
            Self::BearingNoLoad => "bearings, without load",
            Self::Seal => "seals",
            Self::Churning => "churning",
            Self::Windage => "windage",
            Self::Rotor => "carriers and drums",
        }
    }

    /// Standard deviation of the logarithm of its factor before any test: how far the laws of its family lie apart. Teeth:
    /// a spread of 3.6 of ten laws in range, over 3.08, the mean range of ten normal numbers; seals: 2 over 1.69, that of
    /// three. The others are estimates.
    pub const fn prior(self) -> f64 {
        match self {
            Self::Teeth => 0.42,
            Self::BearingLoad => 0.3,
            Self::BearingNoLoad | Self::Churning | Self::Rotor => 0.5,
            Self::Seal | Self::Windage => 0.4,
        }
    }
}

/// Factors on the losses of the laws, by kind of loss, and what is left open of each.
#[derive(Clone, Debug, PartialEq)]
pub struct LossFactors {
    /// In the order of [`LossPart::ALL`].
    pub factors: [f64; LossPart::COUNT],
    /// Standard deviation of the logarithm of each, where tests gave one.
    pub spreads: [Option<f64>; LossPart::COUNT],
    /// What they rest on.
    pub calibrated: Option<String>,
}

impl Default for LossFactors {
    fn default() -> Self {
        Self { factors: [1.0; LossPart::COUNT], spreads: [None; LossPart::COUNT], calibrated: None }
    }
}

/// What surrounds the gears.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Housing {
    /// Factor of the enclosure on windage.
    pub enclosure: Option<f64>,
    /// Axial distance from the gear faces to the wall, m.
    pub axial_gap: Option<f64>,
}

/// A temperature that lies outside what is known of an oil.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Beyond {
    oil: String,
    /// K.
    temperature: f64,
    pub known: Known,
}

/// Where the viscosity of an oil is known; temperatures in K.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Known {
    At(f64),
    Between([f64; 2]),
}

impl std::fmt::Display for Beyond {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let celsius = |t: f64| t - 273.15;
        write!(f, "{} at {:.0} °C: ", self.oil, celsius(self.temperature))?;
        match self.known {
            Known::At(t) => {
                write!(f, "its viscosity is given for {:.0} °C alone and taken as the same here", celsius(t))
            }
            Known::Between([low, high]) => {
                write!(f, "its data reach from {:.0} to {:.0} °C", celsius(low), celsius(high))
            }
        }
    }
}

/// Rolling bearings between two members.
#[derive(Clone, Debug)]
pub struct BearingMount {
    /// What it is called.
    pub name: String,
    /// The members it joins.
    pub members: [MemberId; 2],
    /// The bearing.
    pub bearing: Bearing,
    /// How many share the load (at each planet, on planets).
    pub count: u32,
    /// Identical places: the number of planets, else one.
    pub places: u32,
    /// Distance between the outermost, m.
    pub span: Option<f64>,
    /// Where their middle stands along the axis, m.
    pub position: Option<f64>,
    /// Of a plain bearing: difference of its two diameters, m.
    pub clearance: f64,
    /// Of a plain bearing: coefficient of friction where there is no full film.
    pub friction: f64,
    /// Whether they take the thrust of their shaft, where that is said.
    pub locates: Option<bool>,
    /// Constant radial load beside those of the gears, N.
    pub radial_load: f64,
    /// Constant axial load beside those of the gears, N.
    pub axial_load: f64,
    /// How it gets its oil, where that differs from the train.
    pub supply: Option<OilSupply>,
    /// Oil level above the lowest rolling element's contact, m.
    pub level: Option<f64>,
}

/// Radial lip seals between two members.
#[derive(Clone, Debug)]
pub struct SealMount {
    /// What it is called.
    pub name: String,
    /// Shaft and seat.
    pub members: [MemberId; 2],
    /// Shaft diameter, m.
    pub diameter: f64,
    /// Material of the lip.
    pub material: Material,
    /// How many lips.
    pub count: u32,
}

/// A smooth body of revolution that drags the fluid around it.
#[derive(Clone, Debug)]
pub struct Rotor {
    /// What it is called.
    pub name: String,
    /// The member it belongs to.
    pub member: MemberId,
    /// Outer radius, m.
    pub radius: f64,
    /// Axial length of the rim, m.
    pub length: f64,
    /// Gap between rim and wall, m.
    pub radial_gap: f64,
    /// Gap between each face and the wall, m.
    pub axial_gap: f64,
    /// What it turns in.
    pub fluid: Fluid,
}

/// A planet that revolves: what its bearings feel beside the gears.
#[derive(Clone, Copy, Debug)]
pub struct PlanetBody {
    /// The planets.
    pub member: MemberId,
    /// Their carrier.
    pub carrier: MemberId,
    /// How many.
    pub count: u32,
    /// Distance of their axes from that of the carrier, m.
    pub orbit_radius: f64,
    /// Mass of one, kg.
    pub mass: f64,
    /// The mesh whose centre distance is the radius of the orbit.
    pub(crate) mesh: MeshId,
    /// Whether the mass was not given.
    pub(crate) estimated: bool,
}

/// Density of steel, kg/m³.
const STEEL: f64 = 7850.0;

/// Mass of a planet as a steel cylinder of each gear's pitch circle and width around a hole, kg.
pub(crate) fn steel_mass<R: Real>(
    meshes: &[Mesh],
    planet: MemberId,
    hole_radius: R,
    teeth: &dyn Fn(usize) -> Option<Teeth<R>>,
) -> R {
    let mut seen: Vec<(&crate::exact::Rational, R)> = Vec::new();
    for (j, mesh) in meshes.iter().enumerate() {
        for (k, g) in mesh.gears.iter().enumerate().filter(|(_, g)| g.member == planet) {
            if seen.iter().any(|s| *s.0 == g.teeth) {
                continue;
            }
            if let Some(t) = teeth(j) {
                let r = t.pair.gears[k].reference_radius;
                let area = real::max(r * r - hole_radius * hole_radius, R::from(0.0)) * std::f64::consts::PI;
                seen.push((&g.teeth, area * STEEL * t.pair.total_width()));
            }
        }
    }
    seen.iter().fold(R::from(0.0), |sum, s| sum + s.1)
}
