//! The physical layer of a train: teeth, oil, bearings, seals, bodies that drag.

use crate::catalogue::bearing::Bearing;
use crate::catalogue::oil::{Oil, Viscosity};
use crate::geometry::Pair;
use crate::losses::seal::Material;
use crate::real::{self, Real};

use super::specification::{Fluid, OilSupply};
use super::{MemberId, Mesh, MeshId};

/// Teeth of a mesh.
#[derive(Clone, Debug)]
pub struct Teeth<R = f64> {
    /// The involute pair; its wheels stand in the order of the mesh's gears.
    pub pair: Pair<R>,
    /// Arithmetic mean roughness of both flanks, m.
    pub roughness: [R; 2],
    /// Depth of immersion of both gears at rest, m.
    pub immersion: [Option<R>; 2],
    /// Young's modulus, Pa.
    pub youngs_modulus: R,
    /// Poisson's ratio.
    pub poisson_ratio: R,
    /// Stiffness of one pair along the line of action over its whole width, N/m; `None`: rigid.
    pub stiffness: Option<f64>,
    /// Whether it may follow from the teeth, by ISO 6336-1.
    pub stiffness_by_standard: bool,
}

impl<R: Real> Teeth<R> {
    /// Reduced modulus `E' = E/(1 − ν²)` of two equal materials, Pa.
    pub fn reduced_modulus(&self) -> R {
        self.youngs_modulus / (-(self.poisson_ratio * self.poisson_ratio) + 1.0)
    }
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
