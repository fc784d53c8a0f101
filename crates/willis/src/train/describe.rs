//! The train as a person describes it: names and numbers, not yet checked.

use crate::diagnostic::Diagnostics;
use crate::exact::Rational;
use crate::train::{Efficiency, ShiftElementKind, Train};
use crate::units::{AngularSpeed, Power, Quantity, Torque};

use super::{Load, assemble};

pub(super) mod dynamic;
pub(super) mod physical;

use crate::train::dynamic::LossRow;
use dynamic::{DragSpec, FrictionSpec, PlanetBodySpec, ScenarioSpec, ShaftSpec};
use physical::{BearingSpec, GeometrySpec, HousingSpec, OilSpec, RotorSpec, SealSpec, ToothSpec};

/// A gear of a mesh: its member, tooth count, and whether it is a ring gear.
#[derive(Clone, Debug)]
pub struct GearSpec {
    pub(crate) member: String,
    pub(crate) teeth: i64,
    pub(crate) internal: bool,
    /// The step of the planet that it meshes with, in a stepped set.
    pub(crate) planet_teeth: Option<i64>,
    /// Right side of the planet's apex, in a bevel set.
    pub(crate) right: Option<bool>,
    pub(crate) tooth: ToothSpec,
    /// Teeth of the step of the planet, in a stepped set.
    pub(crate) planet_tooth: ToothSpec,
    /// Geometry of this gear's mesh, in a stepped set.
    pub(crate) geometry: Option<GeometrySpec>,
}

impl GearSpec {
    /// An external gear.
    pub fn external(member: impl Into<String>, teeth: i64) -> Self {
        Self {
            member: member.into(),
            teeth,
            internal: false,
            planet_teeth: None,
            right: None,
            tooth: ToothSpec::default(),
            planet_tooth: ToothSpec::default(),
            geometry: None,
        }
    }

    /// Gives profile shift, tip and roughness.
    #[must_use]
    pub fn tooth(mut self, tooth: ToothSpec) -> Self {
        self.tooth = tooth;
        self
    }

    /// A ring gear.
    pub fn internal(member: impl Into<String>, teeth: i64) -> Self {
        Self { internal: true, ..Self::external(member, teeth) }
    }
}

/// Efficiency as given: one value for both directions, or one each.
#[derive(Clone, Debug)]
pub struct EfficiencySpec(pub(crate) Efficiency);

impl EfficiencySpec {
    /// By direction: the first gear driving, the second gear driving.
    ///
    /// # Panics
    /// If a value is NaN or infinite.
    pub fn directed(forward: f64, backward: f64) -> Self {
        let exact = |v| Rational::from_f64(v).expect("a finite efficiency");
        Self(Efficiency { forward: exact(forward), backward: exact(backward) })
    }
}

impl From<f64> for EfficiencySpec {
    fn from(value: f64) -> Self {
        Self::directed(value, value)
    }
}

impl From<Rational> for EfficiencySpec {
    fn from(value: Rational) -> Self {
        Self(Efficiency { forward: value.clone(), backward: value })
    }
}

/// What is known of the losses of a set.
#[derive(Clone, Debug)]
pub enum SetEfficiencySpec {
    /// Each mesh: between external gears, and with a ring gear.
    Meshes {
        /// Sun to planet, planet to planet.
        external: EfficiencySpec,
        /// Planet to ring.
        internal: EfficiencySpec,
    },
    /// From the first to the second central gear with the carrier held.
    Basic(EfficiencySpec),
}

/// A gear pair on a carrier.
#[derive(Clone, Debug)]
pub struct MeshSpec {
    pub(crate) name: Option<String>,
    pub(crate) gears: [GearSpec; 2],
    pub(crate) carrier: String,
    pub(crate) efficiency: Option<EfficiencySpec>,
    pub(crate) same_sense: Option<bool>,
    pub(crate) bevel: bool,
    pub(crate) count: i64,
    pub(crate) geometry: Option<GeometrySpec>,
    pub(crate) loss_table: Option<Vec<LossRow>>,
}

impl MeshSpec {
    /// A pair carried by the frame, with no loss given.
    pub fn new(first: GearSpec, second: GearSpec) -> Self {
        Self {
            name: None,
            gears: [first, second],
            carrier: "frame".into(),
            efficiency: None,
            same_sense: None,
            bevel: false,
            count: 1,
            geometry: None,
            loss_table: None,
        }
    }

    /// Names it; otherwise the name is built from its gears.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// Puts it on a carrier.
    #[must_use]
    pub fn carrier(mut self, member: impl Into<String>) -> Self {
        self.carrier = member.into();
        self
    }

    /// Gives its efficiency in the carrier frame.
    #[must_use]
    pub fn efficiency(mut self, efficiency: impl Into<EfficiencySpec>) -> Self {
        self.efficiency = Some(efficiency.into());
        self
    }

    /// Gives its teeth, from which the loss is computed when no efficiency is given.
    #[must_use]
    pub fn geometry(mut self, geometry: GeometrySpec) -> Self {
        self.geometry = Some(geometry);
        self
    }

    /// Identical meshes in parallel.
    #[must_use]
    pub fn count(mut self, count: i64) -> Self {
        self.count = count;
        self
    }

    /// Both gears turn in the same sense (a chain, the second side gear of a bevel set).
    #[must_use]
    pub fn same_sense(mut self) -> Self {
        self.same_sense = Some(true);
        self
    }

    /// Makes it a bevel pair.
    #[must_use]
    pub fn bevel(mut self) -> Self {
        self.bevel = true;
        self
    }
}

/// Planets of a set: teeth and number, as far as known.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlanetSpec {
    pub teeth: Option<i64>,
    pub count: Option<i64>,
    pub tooth: ToothSpec,
    pub body: PlanetBodySpec,
}

/// The parts of a set, by type.
#[derive(Clone, Debug)]
// A description lives for the length of a call; its size does not matter.
#[allow(clippy::large_enum_variant)]
pub(crate) enum Parts {
    Simple {
        sun: GearSpec,
        ring: GearSpec,
        planet: PlanetSpec,
    },
    DoublePlanet {
        sun: GearSpec,
        ring: GearSpec,
        inner: PlanetSpec,
        outer: PlanetSpec,
    },
    Stepped {
        central: Vec<GearSpec>,
        planet: PlanetSpec,
    },
    Ravigneaux {
        small_sun: Option<GearSpec>,
        large_sun: Option<GearSpec>,
        ring: Option<GearSpec>,
        short: PlanetSpec,
        long: PlanetSpec,
    },
    Bevel {
        sides: Vec<GearSpec>,
        planet: PlanetSpec,
    },
}

/// A planetary set.
///
/// Sun, ring and carrier are given as `(member, teeth)` and `member`; planets are added with
/// [`SetSpec::planet`] and [`SetSpec::second_planet`].
#[derive(Clone, Debug)]
pub struct SetSpec {
    pub(crate) name: String,
    pub(crate) carrier: String,
    pub(crate) parts: Parts,
    pub(crate) efficiency: Option<SetEfficiencySpec>,
    pub(crate) geometry: Option<GeometrySpec>,
}

impl SetSpec {
    pub(crate) fn new(name: impl Into<String>, carrier: impl Into<String>, parts: Parts) -> Self {
        Self { name: name.into(), carrier: carrier.into(), parts, efficiency: None, geometry: None }
    }

    /// Sun, planets, ring.
    pub fn simple(name: impl Into<String>, sun: (&str, i64), ring: (&str, i64), carrier: impl Into<String>) -> Self {
        Self::new(
            name,
            carrier,
            Parts::Simple {
                sun: GearSpec::external(sun.0, sun.1),
                ring: GearSpec::internal(ring.0, ring.1),
                planet: PlanetSpec::default(),
            },
        )
    }

    /// Sun, inner planets, outer planets, ring: sun and ring turn in the same sense on a held
    /// carrier.
    pub fn double_planet(
        name: impl Into<String>,
        sun: (&str, i64),
        ring: (&str, i64),
        carrier: impl Into<String>,
    ) -> Self {
        Self::new(
            name,
            carrier,
            Parts::DoublePlanet {
                sun: GearSpec::external(sun.0, sun.1),
                ring: GearSpec::internal(ring.0, ring.1),
                inner: PlanetSpec::default(),
                outer: PlanetSpec::default(),
            },
        )
    }

    /// One planet shaft with several steps; add central gears with [`SetSpec::sun`] and
    /// [`SetSpec::ring`].
    pub fn stepped(name: impl Into<String>, carrier: impl Into<String>) -> Self {
        Self::new(name, carrier, Parts::Stepped { central: Vec::new(), planet: PlanetSpec::default() })
    }

    /// A bevel set; add its gears with [`SetSpec::side`].
    pub fn bevel(name: impl Into<String>, carrier: impl Into<String>) -> Self {
        Self::new(name, carrier, Parts::Bevel { sides: Vec::new(), planet: PlanetSpec::default() })
    }

    /// Short planets on the small sun, long planets on the large sun and the ring, short and long
    /// in mesh.
    pub fn ravigneaux(
        name: impl Into<String>,
        small_sun: (&str, i64),
        large_sun: (&str, i64),
        ring: (&str, i64),
        carrier: impl Into<String>,
    ) -> Self {
        Self::new(
            name,
            carrier,
            Parts::Ravigneaux {
                small_sun: Some(GearSpec::external(small_sun.0, small_sun.1)),
                large_sun: Some(GearSpec::external(large_sun.0, large_sun.1)),
                ring: Some(GearSpec::internal(ring.0, ring.1)),
                short: PlanetSpec::default(),
                long: PlanetSpec::default(),
            },
        )
    }

    /// Adds a sun that meshes with the step of `planet_teeth` teeth (stepped sets).
    ///
    /// # Panics
    /// On a set of another type.
    #[must_use]
    pub fn sun(mut self, member: &str, teeth: i64, planet_teeth: i64) -> Self {
        let Parts::Stepped { central, .. } = &mut self.parts else { panic!("only a stepped set takes more suns") };
        central.push(GearSpec { planet_teeth: Some(planet_teeth), ..GearSpec::external(member, teeth) });
        self
    }

    /// Adds a ring that meshes with the step of `planet_teeth` teeth (stepped sets).
    ///
    /// # Panics
    /// On a set of another type.
    #[must_use]
    pub fn ring(mut self, member: &str, teeth: i64, planet_teeth: i64) -> Self {
        let Parts::Stepped { central, .. } = &mut self.parts else { panic!("only a stepped set takes more rings") };
        central.push(GearSpec { planet_teeth: Some(planet_teeth), ..GearSpec::internal(member, teeth) });
        self
    }

    /// Adds a gear of a bevel set, on the left or the right of the planet.
    ///
    /// # Panics
    /// On a set of another type.
    #[must_use]
    pub fn side(mut self, member: &str, teeth: i64, right: bool) -> Self {
        let Parts::Bevel { sides, .. } = &mut self.parts else { panic!("only a bevel set has sides") };
        sides.push(GearSpec { right: Some(right), ..GearSpec::external(member, teeth) });
        self
    }

    /// Teeth and number of the planets (the first kind, where there are two).
    #[must_use]
    pub fn planet(mut self, teeth: i64, count: i64) -> Self {
        for first in self.planets_mut().into_iter().take(1) {
            (first.teeth, first.count) = (Some(teeth), Some(count));
        }
        self
    }

    /// Teeth of the second kind of planet (outer, long), as many as of the first.
    ///
    /// # Panics
    /// On a set with one kind of planet.
    #[must_use]
    pub fn second_planet(mut self, teeth: i64) -> Self {
        match self.planets_mut().as_mut_slice() {
            [first, second] => (second.teeth, second.count) = (Some(teeth), first.count),
            _ => panic!("this set has one kind of planet"),
        }
        self
    }

    /// Gives the teeth of all its meshes, from which losses are computed when no efficiency is
    /// given.
    #[must_use]
    pub fn geometry(mut self, geometry: GeometrySpec) -> Self {
        self.geometry = Some(geometry);
        self
    }

    /// The kinds of planets, in the order in which their members are added.
    fn planets_mut(&mut self) -> Vec<&mut PlanetSpec> {
        match &mut self.parts {
            Parts::Simple { planet, .. } | Parts::Stepped { planet, .. } | Parts::Bevel { planet, .. } => vec![planet],
            Parts::DoublePlanet { inner: first, outer: second, .. }
            | Parts::Ravigneaux { short: first, long: second, .. } => vec![first, second],
        }
    }

    /// What the kinds of planets are called, and what is known of them.
    pub(crate) fn planets(&self) -> Vec<(&'static str, &PlanetSpec)> {
        match &self.parts {
            Parts::Simple { planet, .. } | Parts::Stepped { planet, .. } | Parts::Bevel { planet, .. } => {
                vec![("planet", planet)]
            }
            Parts::DoublePlanet { inner, outer, .. } => vec![("inner_planet", inner), ("outer_planet", outer)],
            Parts::Ravigneaux { short, long, .. } => vec![("short_planet", short), ("long_planet", long)],
        }
    }

    /// The efficiency of every mesh.
    #[must_use]
    pub fn mesh_efficiency(mut self, efficiency: impl Into<EfficiencySpec>) -> Self {
        let efficiency = efficiency.into();
        self.efficiency = Some(SetEfficiencySpec::Meshes { external: efficiency.clone(), internal: efficiency });
        self
    }

    /// The efficiency from the first central gear to the second with the carrier held.
    #[must_use]
    pub fn basic_efficiency(mut self, efficiency: impl Into<EfficiencySpec>) -> Self {
        self.efficiency = Some(SetEfficiencySpec::Basic(efficiency.into()));
        self
    }

    /// The losses in any of the ways that they may be known.
    #[must_use]
    pub fn efficiency(mut self, efficiency: SetEfficiencySpec) -> Self {
        self.efficiency = Some(efficiency);
        self
    }
}

/// A sweep as the train file describes it; [`study`](crate::study) reads its axes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StudySpec {
    /// What it is called.
    pub name: String,
    /// Axes, `QUANTITY=VALUES`.
    pub over: Vec<String>,
    /// The operation from which it starts.
    pub operation: Option<String>,
    /// The state of the shift table.
    pub state: Option<String>,
    /// What is held: `as-given`, `torque`, `power` or `output`.
    pub hold: Option<String>,
    /// More columns than the usual ones.
    pub columns: Vec<String>,
}

/// A clutch, brake or one-way clutch.
#[derive(Clone, Debug)]
pub struct ShiftElementSpec {
    pub(crate) name: String,
    pub(crate) kind: ShiftElementKind,
    pub(crate) members: Vec<String>,
    /// For a one-way clutch, the sign of the relative speed that it prevents; backward by default.
    pub(crate) blocks: Option<i8>,
    pub(crate) friction: FrictionSpec,
}

impl ShiftElementSpec {
    fn new(name: impl Into<String>, kind: ShiftElementKind, members: &[&str]) -> Self {
        let members = members.iter().map(|m| (*m).to_owned()).collect();
        Self { name: name.into(), kind, members, blocks: None, friction: FrictionSpec::default() }
    }

    /// Joins two members when engaged.
    pub fn clutch(name: impl Into<String>, a: &str, b: &str) -> Self {
        Self::new(name, ShiftElementKind::Clutch, &[a, b])
    }

    /// Holds a member when engaged.
    pub fn brake(name: impl Into<String>, member: &str) -> Self {
        Self::new(name, ShiftElementKind::Brake, &[member])
    }

    /// Prevents `member` from turning backward relative to `other` (use `"frame"` for the housing).
    pub fn one_way(name: impl Into<String>, member: &str, other: &str) -> Self {
        Self::new(name, ShiftElementKind::OneWay, &[member, other])
    }
}

/// A row of the shift table.
#[derive(Clone, Debug)]
pub struct StateSpec {
    pub(crate) name: String,
    pub(crate) engaged: Vec<String>,
    pub(crate) input: Option<String>,
    pub(crate) output: Option<String>,
}

impl StateSpec {
    /// A state with these elements engaged.
    pub fn new<'a>(name: impl Into<String>, engaged: impl IntoIterator<Item = &'a str>) -> Self {
        let engaged = engaged.into_iter().map(String::from).collect();
        Self { name: name.into(), engaged, input: None, output: None }
    }

    /// Input and output in this state, where they differ from the train's.
    #[must_use]
    pub fn between(mut self, input: &str, output: &str) -> Self {
        (self.input, self.output) = (Some(input.into()), Some(output.into()));
        self
    }
}

/// An operating point.
#[derive(Clone, Debug)]
pub struct OperationSpec {
    pub(crate) name: String,
    pub(crate) state: Option<String>,
    pub(crate) speeds: Vec<(String, Quantity)>,
    pub(crate) fixed: Vec<String>,
    pub(crate) loads: Vec<(String, Load)>,
    /// Oil temperature, K.
    pub(crate) temperature: Option<f64>,
}

impl OperationSpec {
    /// An operating point of the train as drawn.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), state: None, speeds: vec![], fixed: vec![], loads: vec![], temperature: None }
    }

    /// In a state of the shift table.
    #[must_use]
    pub fn state(mut self, name: &str) -> Self {
        self.state = Some(name.into());
        self
    }

    /// Prescribes a speed.
    #[must_use]
    pub fn speed(mut self, member: &str, speed: AngularSpeed) -> Self {
        self.speeds.push((member.into(), speed.0));
        self
    }

    /// Holds a member from outside.
    #[must_use]
    pub fn fixed(mut self, member: &str) -> Self {
        self.fixed.push(member.into());
        self
    }

    /// Prescribes the oil temperature, K.
    #[must_use]
    pub fn temperature(mut self, kelvin: f64) -> Self {
        self.temperature = Some(kelvin);
        self
    }

    /// Prescribes the external torque on a terminal.
    #[must_use]
    pub fn torque(mut self, member: &str, torque: Torque) -> Self {
        self.loads.push((member.into(), Load::Torque(torque.0)));
        self
    }

    /// Prescribes the external power into a terminal.
    #[must_use]
    pub fn power(mut self, member: &str, power: Power) -> Self {
        self.loads.push((member.into(), Load::Power(power.0)));
        self
    }
}

/// Collects a train's parts; [`TrainBuilder::build`] checks them all.
#[derive(Clone, Debug)]
pub struct TrainBuilder {
    pub(crate) name: String,
    pub(crate) source: Option<String>,
    pub(crate) members: Vec<String>,
    pub(crate) terminals: Vec<String>,
    pub(crate) input: Option<String>,
    pub(crate) output: Option<String>,
    pub(crate) meshes: Vec<MeshSpec>,
    pub(crate) sets: Vec<SetSpec>,
    pub(crate) shift_elements: Vec<ShiftElementSpec>,
    pub(crate) states: Vec<StateSpec>,
    pub(crate) operations: Vec<OperationSpec>,
    pub(crate) oil: Option<OilSpec>,
    pub(crate) laws: Vec<(String, String)>,
    pub(crate) friction_coefficient: Option<f64>,
    pub(crate) housing: HousingSpec,
    pub(crate) bearings: Vec<BearingSpec>,
    pub(crate) seals: Vec<SealSpec>,
    pub(crate) rotors: Vec<RotorSpec>,
    pub(crate) inertias: Vec<(String, f64)>,
    pub(crate) drags: Vec<DragSpec>,
    pub(crate) shafts: Vec<ShaftSpec>,
    pub(crate) scenarios: Vec<ScenarioSpec>,
    pub(crate) studies: Vec<StudySpec>,
}

impl TrainBuilder {
    pub(crate) fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            source: None,
            members: vec![],
            terminals: vec![],
            input: None,
            output: None,
            meshes: vec![],
            sets: vec![],
            shift_elements: vec![],
            states: vec![],
            operations: vec![],
            oil: None,
            laws: vec![],
            friction_coefficient: None,
            housing: HousingSpec::default(),
            bearings: vec![],
            seals: vec![],
            rotors: vec![],
            inertias: vec![],
            drags: vec![],
            shafts: vec![],
            scenarios: vec![],
            studies: vec![],
        }
    }

    /// Gives the lubricant.
    #[must_use]
    pub fn oil(mut self, oil: OilSpec) -> Self {
        self.oil = Some(oil);
        self
    }

    /// Chooses a law of a family by name.
    #[must_use]
    pub fn law(mut self, family: &str, law: &str) -> Self {
        self.laws.push((family.into(), law.into()));
        self
    }

    /// Gives the coefficient of the friction law `constant`.
    #[must_use]
    pub fn friction_coefficient(mut self, value: f64) -> Self {
        self.friction_coefficient = Some(value);
        self
    }

    /// Says what surrounds the gears.
    #[must_use]
    pub fn housing(mut self, housing: HousingSpec) -> Self {
        self.housing = housing;
        self
    }

    /// Adds rolling bearings between two members.
    #[must_use]
    pub fn bearing(mut self, bearing: BearingSpec) -> Self {
        self.bearings.push(bearing);
        self
    }

    /// Adds a lip seal.
    #[must_use]
    pub fn seal(mut self, seal: SealSpec) -> Self {
        self.seals.push(seal);
        self
    }

    /// Adds a carrier or drum that drags the fluid around it.
    #[must_use]
    pub fn rotor(mut self, rotor: RotorSpec) -> Self {
        self.rotors.push(rotor);
        self
    }

    /// Names the rotors (the frame and the planets of sets exist without being named).
    #[must_use]
    pub fn members<'a>(mut self, names: impl IntoIterator<Item = &'a str>) -> Self {
        self.members.extend(names.into_iter().map(String::from));
        self
    }

    /// Names the members on which an external torque may act. The first is the input and the last
    /// the output, unless a state says otherwise.
    #[must_use]
    pub fn terminals<'a>(mut self, names: impl IntoIterator<Item = &'a str>) -> Self {
        self.terminals.extend(names.into_iter().map(String::from));
        self
    }

    /// Says where the data come from.
    #[must_use]
    pub fn source(mut self, text: impl Into<String>) -> Self {
        self.source = Some(text.into());
        self
    }

    /// Adds a mesh.
    #[must_use]
    pub fn mesh(mut self, mesh: MeshSpec) -> Self {
        self.meshes.push(mesh);
        self
    }

    /// Adds a set.
    #[must_use]
    pub fn set(mut self, set: SetSpec) -> Self {
        self.sets.push(set);
        self
    }

    /// Adds a clutch or brake.
    #[must_use]
    pub fn shift_element(mut self, element: ShiftElementSpec) -> Self {
        self.shift_elements.push(element);
        self
    }

    /// Adds a row of the shift table.
    #[must_use]
    pub fn state(mut self, state: StateSpec) -> Self {
        self.states.push(state);
        self
    }

    /// Adds an operating point.
    #[must_use]
    pub fn operation(mut self, operation: OperationSpec) -> Self {
        self.operations.push(operation);
        self
    }

    /// Checks everything and makes the train.
    ///
    /// # Errors
    /// Everything that is wrong, not only the first.
    pub fn build(self) -> Result<Train, Diagnostics> {
        let mut diagnostics = Diagnostics::default();
        assemble::assemble(self, None, &mut diagnostics).ok_or(diagnostics)
    }
}
