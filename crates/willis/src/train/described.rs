//! A specification made ready for calculation: quantities as numbers in SI units, the gears of all types of sets alike.

use super::specification::{
    BevelSpec, CentralSpec, Direction, DoublePlanetSpec, EfficiencySpec, FrictionSpec, GearSpec, MeshSpec, PairKind,
    PlainGeometry, PlainLossRow, PlainPlanetBody, PlainTooth, PlanetSpec, RavigneauxSpec, Sense, SetEfficiencySpec,
    SetParts, SetSpec, ShiftElementSpec, Side, SideSpec, SimpleSpec, StepSpec, SteppedSpec, ToothSpec,
    field::{Field, Tabular},
};

/// A gear of a mesh or a set.
#[derive(Clone, Debug)]
pub(super) struct GivenGear {
    pub member: String,
    pub teeth: i64,
    pub internal: bool,
    /// The step of the planet that it meshes with, in a stepped set; teeth of the planet at a bevel side gear.
    pub planet_teeth: Option<i64>,
    /// Right side of the planet's apex, in a bevel set.
    pub right: Option<bool>,
    pub tooth: PlainTooth,
    /// Teeth of the step of the planet, in a stepped set.
    pub planet_tooth: PlainTooth,
    /// Geometry of this gear's mesh, in a stepped set.
    pub geometry: Option<PlainGeometry>,
}

impl GivenGear {
    fn new(member: &str, teeth: i64, internal: bool, tooth: &ToothSpec) -> Self {
        Self {
            member: member.to_owned(),
            teeth,
            internal,
            planet_teeth: None,
            right: None,
            tooth: tooth.twin(),
            planet_tooth: ToothSpec::default().twin(),
            geometry: None,
        }
    }

    /// Teeth within the bounds that are enforced: safe to calculate with.
    pub fn z(&self) -> i64 {
        self.teeth.clamp(1, MOST_TEETH)
    }

    /// What people call this gear's role in a set.
    pub fn role(&self) -> &'static str {
        if self.internal { "ring" } else { "sun" }
    }
}

/// Most teeth of a gear.
pub(super) const MOST_TEETH: i64 = 100_000;

fn gear(spec: &GearSpec) -> GivenGear {
    GivenGear::new(&spec.member, spec.teeth, spec.internal, &spec.tooth)
}

fn central(spec: &CentralSpec, internal: bool) -> GivenGear {
    GivenGear::new(&spec.member, spec.teeth, internal, &spec.tooth)
}

fn step(spec: &StepSpec, internal: bool) -> GivenGear {
    GivenGear {
        planet_teeth: Some(spec.planet_teeth),
        planet_tooth: spec.planet.clone().unwrap_or_default().twin(),
        geometry: spec.geometry.plain(),
        ..GivenGear::new(&spec.member, spec.teeth, internal, &spec.tooth)
    }
}

fn side(spec: &SideSpec) -> GivenGear {
    GivenGear {
        planet_teeth: spec.planet_teeth,
        right: spec.side.map(|s| s == Side::Right),
        ..GivenGear::new(&spec.member, spec.teeth, false, &ToothSpec::default())
    }
}

/// A gear pair on a carrier.
pub(super) struct GivenMesh {
    pub name: Option<String>,
    pub gears: [GivenGear; 2],
    pub carrier: String,
    pub efficiency: Option<EfficiencySpec>,
    pub same_sense: Option<bool>,
    pub bevel: bool,
    pub count: i64,
    pub geometry: Option<PlainGeometry>,
    pub angle: Option<f64>,
    pub loss_table: Option<Vec<PlainLossRow>>,
}

impl From<&MeshSpec> for GivenMesh {
    fn from(spec: &MeshSpec) -> Self {
        Self {
            name: spec.name.clone(),
            gears: [gear(&spec.gears[0]), gear(&spec.gears[1])],
            carrier: spec.carrier.clone().unwrap_or_else(|| "frame".into()),
            efficiency: spec.efficiency.clone(),
            same_sense: spec.sense.map(|s| s == Sense::Same),
            bevel: spec.kind == Some(PairKind::Bevel),
            count: spec.count.unwrap_or(1),
            geometry: spec.geometry.plain(),
            angle: spec.angle.plain(),
            loss_table: spec.loss_table.plain(),
        }
    }
}

/// Planets of a set: teeth and number, as far as known.
#[derive(Clone, Debug)]
pub(super) struct GivenPlanet {
    pub teeth: Option<i64>,
    pub count: Option<i64>,
    pub tooth: PlainTooth,
    pub body: PlainPlanetBody,
}

impl From<&Option<PlanetSpec>> for GivenPlanet {
    fn from(spec: &Option<PlanetSpec>) -> Self {
        let PlanetSpec { teeth, count, body, tooth } = spec.clone().unwrap_or_default();
        Self { teeth, count, tooth: tooth.twin(), body: body.twin() }
    }
}

/// The parts of a set, by type.
#[allow(clippy::large_enum_variant)]
pub(super) enum Parts {
    Simple {
        sun: GivenGear,
        ring: GivenGear,
        planet: GivenPlanet,
    },
    DoublePlanet {
        sun: GivenGear,
        ring: GivenGear,
        inner: GivenPlanet,
        outer: GivenPlanet,
    },
    Stepped {
        central: Vec<GivenGear>,
        planet: GivenPlanet,
    },
    Ravigneaux {
        small_sun: Option<GivenGear>,
        large_sun: Option<GivenGear>,
        ring: Option<GivenGear>,
        short: GivenPlanet,
        long: GivenPlanet,
    },
    Bevel {
        sides: Vec<GivenGear>,
        planet: GivenPlanet,
    },
}

/// What is known of the losses of a set.
pub(super) enum GivenEfficiency {
    /// Of each mesh.
    Meshes(SetEfficiencySpec),
    /// From the first to the second central gear with the carrier held.
    Basic(EfficiencySpec),
}

/// A planetary set.
pub(super) struct GivenSet {
    pub name: String,
    /// The type, as in the file.
    pub kind: &'static str,
    pub carrier: String,
    pub parts: Parts,
    pub efficiency: Option<GivenEfficiency>,
    pub geometry: Option<PlainGeometry>,
}

impl From<&SetSpec> for GivenSet {
    fn from(spec: &SetSpec) -> Self {
        let parts = match &spec.parts {
            SetParts::Simple(SimpleSpec { sun, planet, ring }) => {
                Parts::Simple { sun: central(sun, false), ring: central(ring, true), planet: planet.into() }
            }
            SetParts::DoublePlanet(DoublePlanetSpec { sun, inner_planet, outer_planet, ring }) => Parts::DoublePlanet {
                sun: central(sun, false),
                ring: central(ring, true),
                inner: inner_planet.into(),
                outer: outer_planet.into(),
            },
            SetParts::Stepped(SteppedSpec { suns, rings, planet }) => {
                let planet = planet.clone().unwrap_or_default();
                let planet = PlanetSpec { teeth: None, count: planet.count, body: planet.body, ..Default::default() };
                let suns = suns.iter().map(|s| step(s, false));
                Parts::Stepped {
                    central: suns.chain(rings.iter().map(|r| step(r, true))).collect(),
                    planet: (&Some(planet)).into(),
                }
            }
            SetParts::Ravigneaux(RavigneauxSpec { small_sun, large_sun, ring, short_planet, long_planet }) => {
                Parts::Ravigneaux {
                    small_sun: small_sun.as_ref().map(|g| central(g, false)),
                    large_sun: large_sun.as_ref().map(|g| central(g, false)),
                    ring: ring.as_ref().map(|g| central(g, true)),
                    short: short_planet.into(),
                    long: long_planet.into(),
                }
            }
            SetParts::Bevel(BevelSpec { sides, planet }) => {
                Parts::Bevel { sides: sides.iter().map(side).collect(), planet: planet.into() }
            }
        };
        let meshes = spec.mesh_efficiency.clone().map(GivenEfficiency::Meshes);
        Self {
            name: spec.name.clone(),
            kind: spec.kind(),
            carrier: spec.carrier.clone(),
            parts,
            efficiency: meshes.or(spec.basic_efficiency.clone().map(GivenEfficiency::Basic)),
            geometry: spec.geometry.plain(),
        }
    }
}

impl GivenSet {
    /// What the kinds of planets are called, and what is known of them.
    pub fn planets(&self) -> Vec<(&'static str, &GivenPlanet)> {
        match &self.parts {
            Parts::Simple { planet, .. } | Parts::Stepped { planet, .. } | Parts::Bevel { planet, .. } => {
                vec![("planet", planet)]
            }
            Parts::DoublePlanet { inner, outer, .. } => vec![("inner_planet", inner), ("outer_planet", outer)],
            Parts::Ravigneaux { short, long, .. } => vec![("short_planet", short), ("long_planet", long)],
        }
    }
}

/// What a shift element can hold, as far as given.
#[derive(PartialEq)]
pub(super) struct GivenFriction {
    pub capacity: Option<f64>,
    pub coefficient: Option<Vec<[f64; 2]>>,
    pub normal_force: Option<f64>,
    pub effective_radius: Option<f64>,
    pub peak: Option<f64>,
}

impl From<&ShiftElementSpec> for GivenFriction {
    fn from(spec: &ShiftElementSpec) -> Self {
        Self {
            capacity: spec.capacity.plain(),
            coefficient: spec.friction.as_ref().map(FrictionSpec::plain),
            normal_force: spec.normal_force.plain(),
            effective_radius: spec.effective_radius.plain(),
            peak: spec.peak,
        }
    }
}

impl GivenFriction {
    /// Whether nothing is given.
    pub fn is_open(&self) -> bool {
        let Self { capacity, coefficient, normal_force, effective_radius, peak } = self;
        [capacity, normal_force, effective_radius, peak].iter().all(|x| x.is_none()) && coefficient.is_none()
    }
}

/// The sign of the relative speed that a one-way clutch prevents.
pub(super) fn sign(direction: Direction) -> i8 {
    match direction {
        Direction::Backward => -1,
        Direction::Forward => 1,
    }
}
