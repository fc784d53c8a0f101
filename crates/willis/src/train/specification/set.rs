//! Planetary sets of a specification.

use crate::train::format::keys::{Key, Kind, Table, TypedTable};
use crate::train::format::{Datum, Fields, Node};

use super::field::{Field, Tabular, choice, specification, table};
use super::{EfficiencySpec, GeometrySpec, PlanetBodySpec, SetEfficiencySpec, ToothSpec};

/// A side of a bevel planet's apex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Left.
    Left,
    /// Right.
    Right,
}
choice!(Side { Left = "left", Right = "right" });

specification! {
    /// A sun or ring gear.
    CentralSpec => PlainCentral {
        /// The rotor it sits on; `frame` for a gear that is always held.
        must member: String as Kind::Name,
        /// Tooth count.
        must teeth: i64,
        ..tooth: ToothSpec,
    }

    /// A sun or ring gear and the step of the planet it meshes with.
    StepSpec => PlainStep {
        /// The rotor it sits on; `frame` for a gear that is always held.
        must member: String as Kind::Name,
        /// Tooth count.
        must teeth: i64,
        /// Teeth of the step of the planet that it meshes with.
        must planet_teeth: i64,
        /// The teeth of that step.
        may planet: Option<ToothSpec>,
        /// The teeth: module, width, angles. With an oil, losses are computed.
        may geometry: Option<GeometrySpec>,
        ..tooth: ToothSpec,
    }

    /// A side gear of a bevel set.
    SideSpec => PlainSide {
        /// The rotor it sits on; `frame` for a gear that is always held.
        must member: String as Kind::Name,
        /// Tooth count.
        must teeth: i64,
        /// Teeth of the planet where this gear meshes, when the planet is stepped.
        may planet_teeth: Option<i64>,
        /// Gears on different sides turn in opposite senses relative to the carrier. Default: the first left, the
        /// others right.
        may side: Option<Side>,
    }

    /// The planets of a set.
    PlanetSpec => PlainPlanet {
        /// Tooth count. Without it planet speeds are those of the nominal planet (z_ring - z_sun)/2.
        may teeth: Option<i64>,
        /// Number of planets; enables the assembly checks.
        may count: Option<i64>,
        ..body: PlanetBodySpec,
        ..tooth: ToothSpec,
    }

    /// The stepped planets of a set; their teeth stand with the gears they mesh with.
    SteppedPlanetSpec => PlainSteppedPlanet {
        /// Number of planets; enables the assembly checks.
        may count: Option<i64>,
        ..body: PlanetBodySpec,
    }

    /// Sun, planets, ring.
    SimpleSpec => PlainSimple {
        /// The sun gear.
        must sun: CentralSpec,
        /// The planets.
        may planet: Option<PlanetSpec>,
        /// The ring gear.
        must ring: CentralSpec,
    }

    /// Sun, inner planets, outer planets, ring.
    DoublePlanetSpec => PlainDoublePlanet {
        /// The sun gear; meshes with the inner planets.
        must sun: CentralSpec,
        /// The planets on the sun.
        may inner_planet: Option<PlanetSpec>,
        /// The planets on the ring, in mesh with the inner ones.
        may outer_planet: Option<PlanetSpec>,
        /// The ring gear.
        must ring: CentralSpec,
    }

    /// Planet shafts with several steps, each in mesh with a sun or a ring.
    SteppedSpec => PlainStepped {
        /// Sun gears.
        may suns: Vec<StepSpec>,
        /// Ring gears.
        may rings: Vec<StepSpec>,
        /// The planets.
        may planet: Option<SteppedPlanetSpec>,
    }

    /// Short planets on the small sun, long planets on the large sun and the ring, short and long in mesh. One of
    /// small_sun, large_sun and ring may be absent.
    RavigneauxSpec => PlainRavigneaux {
        /// Meshes with the short planets.
        may small_sun: Option<CentralSpec>,
        /// Meshes with the long planets.
        may large_sun: Option<CentralSpec>,
        /// Meshes with the long planets.
        may ring: Option<CentralSpec>,
        /// Short planets.
        may short_planet: Option<PlanetSpec>,
        /// Long planets.
        may long_planet: Option<PlanetSpec>,
    }

    /// Bevel planets between side gears.
    BevelSpec => PlainBevel {
        /// Side gears.
        must sides: Vec<SideSpec>,
        /// The planets.
        may planet: Option<PlanetSpec>,
    }
}

impl CentralSpec {
    /// A gear of a member.
    pub fn new(member: impl Into<String>, teeth: i64) -> Self {
        Self { member: member.into(), teeth, ..Self::default() }
    }
}

/// The gears of a set, by its type.
#[derive(Clone, Debug, PartialEq)]
// A description lives for the length of a call; its size does not matter.
#[allow(clippy::large_enum_variant)]
pub enum SetParts {
    /// Sun, planets, ring.
    Simple(SimpleSpec),
    /// Sun, inner planets, outer planets, ring.
    DoublePlanet(DoublePlanetSpec),
    /// Planet shafts with several steps.
    Stepped(SteppedSpec),
    /// Short and long planets in mesh.
    Ravigneaux(RavigneauxSpec),
    /// Bevel planets between side gears.
    Bevel(BevelSpec),
}

/// A planetary set.
///
/// Sun, ring and carrier are given as `(member, teeth)` and `member`; planets are added with [`SetSpec::planet`] and
/// [`SetSpec::second_planet`].
#[derive(Clone, Debug, PartialEq)]
pub struct SetSpec {
    /// Unique; its planets are called after it, `P1.planet`.
    pub name: String,
    /// The gears.
    pub parts: SetParts,
    /// The member that carries the planets.
    pub carrier: String,
    /// The teeth: module, width, angles. With an oil, losses are computed.
    pub geometry: Option<GeometrySpec>,
    /// Of each mesh in the carrier frame: a number, { forward, backward }, or { external = …, internal = … }.
    pub mesh_efficiency: Option<SetEfficiencySpec>,
    /// From the first to the second central gear with the carrier held; instead of mesh_efficiency.
    pub basic_efficiency: Option<EfficiencySpec>,
    /// What was asked of it that its type does not have.
    pub(crate) misuse: Vec<&'static str>,
}

/// What every set has before its gears, and behind them.
const NAME: Key = Key {
    name: "name",
    kind: Kind::Text,
    required: true,
    doc: "Unique; its planets are called after it, `P1.planet`.",
};
const TYPES: &[&str] = &["simple", "double-planet", "stepped", "ravigneaux", "bevel"];
const TYPE: Key = Key { name: "type", kind: Kind::Choice(TYPES), required: false, doc: "Default: simple." };
const CARRIER: Key =
    Key { name: "carrier", kind: Kind::Name, required: true, doc: "The member that carries the planets." };
const MESH_EFFICIENCY: Key = Key {
    name: "mesh_efficiency",
    kind: Kind::SetEfficiency,
    required: false,
    doc: "Of each mesh in the carrier frame: a number, { forward, backward }, or { external = …, internal = … }.",
};
const BASIC_EFFICIENCY: Key = Key {
    name: "basic_efficiency",
    kind: Kind::Efficiency,
    required: false,
    doc: "From the first to the second central gear with the carrier held; instead of mesh_efficiency.",
};
const GEOMETRY: Key = Key {
    name: "geometry",
    kind: <GeometrySpec as Field>::KIND,
    required: false,
    doc: "The teeth: module, width, angles. With an oil, losses are computed.",
};

const fn table_of<T: Tabular>(groups: &'static [&'static [Key]]) -> Table {
    Table { doc: T::TABLE.doc, groups }
}

const HEAD: &[Key] = &[NAME, TYPE];
const TAIL: &[Key] = &[CARRIER, GEOMETRY, MESH_EFFICIENCY, BASIC_EFFICIENCY];

/// The keys of each type of set; the first is the default.
pub(crate) const SETS: &[TypedTable] = &[
    ("simple", &table_of::<SimpleSpec>(&[HEAD, SimpleSpec::KEYS, TAIL])),
    ("double-planet", &table_of::<DoublePlanetSpec>(&[HEAD, DoublePlanetSpec::KEYS, TAIL])),
    ("stepped", &table_of::<SteppedSpec>(&[HEAD, SteppedSpec::KEYS, TAIL])),
    ("ravigneaux", &table_of::<RavigneauxSpec>(&[HEAD, RavigneauxSpec::KEYS, TAIL])),
    ("bevel", &table_of::<BevelSpec>(&[HEAD, BevelSpec::KEYS, TAIL])),
];

impl SetSpec {
    fn read_fields(t: &Fields) -> Self {
        let parts = match t.get::<Option<String>>("type").as_deref() {
            Some("double-planet") => SetParts::DoublePlanet(Tabular::read_fields(t)),
            Some("stepped") => SetParts::Stepped(Tabular::read_fields(t)),
            Some("ravigneaux") => SetParts::Ravigneaux(Tabular::read_fields(t)),
            Some("bevel") => SetParts::Bevel(Tabular::read_fields(t)),
            _ => SetParts::Simple(Tabular::read_fields(t)),
        };
        Self {
            name: t.get("name"),
            parts,
            carrier: t.get("carrier"),
            geometry: t.get("geometry"),
            mesh_efficiency: t.get("mesh_efficiency"),
            basic_efficiency: t.get("basic_efficiency"),
            misuse: vec![],
        }
    }

    /// The type, as in the file: `simple`, `stepped`, …
    pub fn kind(&self) -> &'static str {
        match self.parts {
            SetParts::Simple(_) => TYPES[0],
            SetParts::DoublePlanet(_) => TYPES[1],
            SetParts::Stepped(_) => TYPES[2],
            SetParts::Ravigneaux(_) => TYPES[3],
            SetParts::Bevel(_) => TYPES[4],
        }
    }

    fn datum(&self) -> Datum {
        let mut all = vec![("name".to_owned(), Datum::Text(self.name.clone()))];
        if !matches!(self.parts, SetParts::Simple(_)) {
            all.push(("type".to_owned(), Datum::Text(self.kind().to_owned())));
        }
        match &self.parts {
            SetParts::Simple(p) => p.write_fields(&mut all),
            SetParts::DoublePlanet(p) => p.write_fields(&mut all),
            SetParts::Stepped(p) => p.write_fields(&mut all),
            SetParts::Ravigneaux(p) => p.write_fields(&mut all),
            SetParts::Bevel(p) => p.write_fields(&mut all),
        }
        all.push(("carrier".to_owned(), Datum::Text(self.carrier.clone())));
        all.extend(self.geometry.as_ref().map(|g| ("geometry".to_owned(), table(g))));
        all.extend(self.mesh_efficiency.write().map(|e| ("mesh_efficiency".to_owned(), e)));
        all.extend(self.basic_efficiency.write().map(|e| ("basic_efficiency".to_owned(), e)));
        Datum::Table(all)
    }

    fn new(name: impl Into<String>, carrier: impl Into<String>, parts: SetParts) -> Self {
        Self {
            name: name.into(),
            parts,
            carrier: carrier.into(),
            geometry: None,
            mesh_efficiency: None,
            basic_efficiency: None,
            misuse: vec![],
        }
    }

    /// Sun, planets, ring.
    pub fn simple(name: impl Into<String>, sun: (&str, i64), ring: (&str, i64), carrier: impl Into<String>) -> Self {
        let (sun, ring) = (CentralSpec::new(sun.0, sun.1), CentralSpec::new(ring.0, ring.1));
        Self::new(name, carrier, SetParts::Simple(SimpleSpec { sun, planet: None, ring }))
    }

    /// Sun, inner planets, outer planets, ring: sun and ring turn in the same sense on a held carrier.
    pub fn double_planet(
        name: impl Into<String>,
        sun: (&str, i64),
        ring: (&str, i64),
        carrier: impl Into<String>,
    ) -> Self {
        let (sun, ring) = (CentralSpec::new(sun.0, sun.1), CentralSpec::new(ring.0, ring.1));
        Self::new(name, carrier, SetParts::DoublePlanet(DoublePlanetSpec { sun, ring, ..Default::default() }))
    }

    /// One planet shaft with several steps; add central gears with [`SetSpec::sun`] and [`SetSpec::ring`].
    pub fn stepped(name: impl Into<String>, carrier: impl Into<String>) -> Self {
        Self::new(name, carrier, SetParts::Stepped(SteppedSpec::default()))
    }

    /// A bevel set; add its gears with [`SetSpec::side`].
    pub fn bevel(name: impl Into<String>, carrier: impl Into<String>) -> Self {
        Self::new(name, carrier, SetParts::Bevel(BevelSpec::default()))
    }

    /// Short planets on the small sun, long planets on the large sun and the ring, short and long in mesh.
    pub fn ravigneaux(
        name: impl Into<String>,
        small_sun: (&str, i64),
        large_sun: (&str, i64),
        ring: (&str, i64),
        carrier: impl Into<String>,
    ) -> Self {
        let central = |(member, teeth): (&str, i64)| Some(CentralSpec::new(member, teeth));
        let parts = RavigneauxSpec {
            small_sun: central(small_sun),
            large_sun: central(large_sun),
            ring: central(ring),
            ..Default::default()
        };
        Self::new(name, carrier, SetParts::Ravigneaux(parts))
    }

    /// Adds a sun that meshes with the step of `planet_teeth` teeth (stepped sets).
    #[must_use]
    pub fn sun(mut self, member: &str, teeth: i64, planet_teeth: i64) -> Self {
        let step = StepSpec { member: member.into(), teeth, planet_teeth, ..StepSpec::default() };
        match &mut self.parts {
            SetParts::Stepped(p) => p.suns.push(step),
            _ => self.misuse.push("only a stepped set takes more suns"),
        }
        self
    }

    /// Adds a ring that meshes with the step of `planet_teeth` teeth (stepped sets).
    #[must_use]
    pub fn ring(mut self, member: &str, teeth: i64, planet_teeth: i64) -> Self {
        let step = StepSpec { member: member.into(), teeth, planet_teeth, ..StepSpec::default() };
        match &mut self.parts {
            SetParts::Stepped(p) => p.rings.push(step),
            _ => self.misuse.push("only a stepped set takes more rings"),
        }
        self
    }

    /// Adds a gear of a bevel set, on the left or the right of the planet.
    #[must_use]
    pub fn side(mut self, member: &str, teeth: i64, right: bool) -> Self {
        let side = Some(if right { Side::Right } else { Side::Left });
        match &mut self.parts {
            SetParts::Bevel(p) => p.sides.push(SideSpec { member: member.into(), teeth, planet_teeth: None, side }),
            _ => self.misuse.push("only a bevel set has sides"),
        }
        self
    }

    /// Teeth and number of the planets (the first kind, where there are two). Those of a stepped set have their teeth
    /// with the gears that they mesh with.
    #[must_use]
    pub fn planet(mut self, teeth: i64, count: i64) -> Self {
        if let SetParts::Stepped(p) = &mut self.parts {
            p.planet.get_or_insert_default().count = Some(count);
        } else if let Some(planet) = self.kind_of_planet(0) {
            (planet.teeth, planet.count) = (Some(teeth), Some(count));
        }
        self
    }

    /// Teeth of the second kind of planet (outer, long), as many as of the first.
    #[must_use]
    pub fn second_planet(mut self, teeth: i64) -> Self {
        let count = self.kind_of_planet(0).and_then(|p| p.count);
        match self.kind_of_planet(1) {
            Some(planet) => (planet.teeth, planet.count) = (Some(teeth), count),
            None => self.misuse.push(ONE_KIND),
        }
        self
    }

    /// Mass and inertia of each planet (of the first kind, where there are two).
    #[must_use]
    pub fn planet_body(mut self, body: PlanetBodySpec) -> Self {
        if let SetParts::Stepped(p) = &mut self.parts {
            p.planet.get_or_insert_default().body = body;
        } else if let Some(planet) = self.kind_of_planet(0) {
            planet.body = body;
        }
        self
    }

    /// Mass and inertia of each planet of the second kind (outer, long).
    #[must_use]
    pub fn second_planet_body(mut self, body: PlanetBodySpec) -> Self {
        match self.kind_of_planet(1) {
            Some(planet) => planet.body = body,
            None => self.misuse.push(ONE_KIND),
        }
        self
    }

    /// A kind of planets with teeth of its own.
    fn kind_of_planet(&mut self, which: usize) -> Option<&mut PlanetSpec> {
        let place = match (&mut self.parts, which) {
            (SetParts::Simple(p), 0) => &mut p.planet,
            (SetParts::Bevel(p), 0) => &mut p.planet,
            (SetParts::DoublePlanet(p), 0) => &mut p.inner_planet,
            (SetParts::DoublePlanet(p), 1) => &mut p.outer_planet,
            (SetParts::Ravigneaux(p), 0) => &mut p.short_planet,
            (SetParts::Ravigneaux(p), 1) => &mut p.long_planet,
            _ => return None,
        };
        Some(place.get_or_insert_default())
    }

    /// Gives the teeth of all its meshes, from which losses are computed when no efficiency is given.
    #[must_use]
    pub fn geometry(mut self, geometry: GeometrySpec) -> Self {
        self.geometry = Some(geometry);
        self
    }

    /// The efficiency of every mesh.
    #[must_use]
    pub fn mesh_efficiency(mut self, efficiency: impl Into<EfficiencySpec>) -> Self {
        self.mesh_efficiency = Some(SetEfficiencySpec::All(efficiency.into()));
        self
    }

    /// The efficiencies of meshes between external gears, and of those with a ring gear.
    #[must_use]
    pub fn mesh_efficiencies(
        mut self,
        external: impl Into<EfficiencySpec>,
        internal: impl Into<EfficiencySpec>,
    ) -> Self {
        let (external, internal) = (external.into(), internal.into());
        self.mesh_efficiency = Some(SetEfficiencySpec::ByKind { external, internal });
        self
    }

    /// The efficiency from the first central gear to the second with the carrier held.
    #[must_use]
    pub fn basic_efficiency(mut self, efficiency: impl Into<EfficiencySpec>) -> Self {
        self.basic_efficiency = Some(efficiency.into());
        self
    }
}

const ONE_KIND: &str = "this set has one kind of planet";

impl Field for Vec<SetSpec> {
    const KIND: Kind = Kind::Variants(SETS);
    type Plain = Self;
    fn read(node: &Node) -> Self {
        match node {
            Node::Tables(all) => all.iter().map(SetSpec::read_fields).collect(),
            node => unreachable!("the reader keeps to the kind of a key, here is {node:?}"),
        }
    }
    fn blank() -> Self {
        vec![]
    }
    fn write(&self) -> Option<Datum> {
        (!self.is_empty()).then(|| Datum::List(self.iter().map(SetSpec::datum).collect()))
    }
    fn plain(&self) -> Self {
        self.clone()
    }
}

impl serde::Serialize for SetSpec {
    /// In the shape of the train file.
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.datum().serialize(serializer)
    }
}

impl<'de> serde::Deserialize<'de> for SetSpec {
    /// From the shape of the train file, with the checks of its reader.
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let datum = Datum::deserialize(deserializer)?;
        let name = datum.get("type").and_then(Datum::as_text);
        let table = SETS.iter().find(|s| Some(s.0) == name).unwrap_or(&SETS[0]).1;
        crate::train::format::fields(&datum, table).map(|t| Self::read_fields(&t)).map_err(serde::de::Error::custom)
    }
}
