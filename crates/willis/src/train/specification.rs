//! The train as a person describes it: names, numbers and quantities with their units, complete, not yet checked.
//!
//! Each table of the train file is a type here, and each of its keys one line of a declaration. The reader, its
//! suggestions, the JSON Schema, the writer and both ways of serde follow from these lines.

mod dynamic;
pub(super) mod field;
mod heat;
mod physical;
mod set;
mod variator;
mod written;

use crate::exact::Rational;
use crate::train::ShiftElementKind;
use crate::train::format::keys::{Kind, Table};
use crate::train::format::{Datum, Directed, Node};
use crate::units::{Angle, AngularSpeed, Force, Length, MomentOfInertia, Power, Temperature, Torque};

use field::{Field, Tabular, choice, specification};

pub use dynamic::{
    ControlSpec, ControllerSpec, DragSpec, EngagementSpec, LinearSpec, LossRowSpec, MotorSpec, PlanetBodySpec,
    QuadraticSpec, ScenarioSpec, ShaftSpec, SignalSpec, SourceSpec, VehicleSpec,
};
pub(super) use dynamic::{
    PlainControl, PlainController, PlainDrag, PlainLossRow, PlainPlanetBody, PlainScenario, PlainShaft, PlainSource,
};
pub use heat::{CoolerSpec, HeatNodeSpec, HeatPathSpec, HeatSpec, SurfaceSpec};
pub(super) use heat::{PlainCooler, PlainHeat, PlainSurface};
pub use physical::{
    BearingSpec, Fluid, GeometrySpec, Hand, HousingSpec, JetSide, LawsSpec, LossFactorSpec, LossesSpec, MeshStiffness,
    OilSpec, OilSupply, OpenSpec, PumpSpec, RotorSpec, SealSpec, ToothSpec,
};
pub(super) use physical::{
    PlainBearing, PlainGeometry, PlainHousing, PlainLossFactor, PlainLosses, PlainOil, PlainOpen, PlainPump,
    PlainRotor, PlainSeal, PlainTooth,
};
pub use set::{
    BevelSpec, CentralSpec, DoublePlanetSpec, PlanetSpec, RavigneauxSpec, SetParts, SetSpec, Side, SideSpec,
    SimpleSpec, StepSpec, SteppedPlanetSpec, SteppedSpec,
};
pub use variator::{MachineEfficiencySpec, MachineSpec, RatioSpec, StoreSpec, VariatorSpec};

choice!(ShiftElementKind { Clutch = "clutch", Brake = "brake", OneWay = "one-way" });

/// A direction of rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Negative speeds.
    Backward,
    /// Positive speeds.
    Forward,
}
choice!(Direction { Backward = "backward", Forward = "forward" });

/// How two gears turn relative to their carrier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// In opposite senses.
    Opposite,
    /// In the same sense.
    Same,
}
choice!(Sense { Opposite = "opposite", Same = "same" });

/// What kind of teeth a pair has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairKind {
    /// Axes in parallel.
    Cylindrical,
    /// Axes that meet.
    Bevel,
}
choice!(PairKind { Cylindrical = "cylindrical", Bevel = "bevel" });

/// What stays the same when a study varies something.
const HOLDS: &[&str] = &["as-given", "torque", "power", "output"];

/// The number of the format of a train file: 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FormatNumber;

impl Field for FormatNumber {
    const KIND: Kind = Kind::Format;
    type Plain = Self;
    fn read(_: &Node) -> Self {
        Self
    }
    fn blank() -> Self {
        Self
    }
    fn write(&self) -> Option<Datum> {
        Some(Datum::Integer(1))
    }
    fn plain(&self) -> Self {
        Self
    }
}

/// Efficiency as given: one value for both directions, or one each. Values stay exact.
#[derive(Clone, Debug, PartialEq)]
pub struct EfficiencySpec {
    /// `None`: no finite number.
    pub(super) forward: Option<Rational>,
    /// One of its own.
    pub(super) backward: Option<Option<Rational>>,
}

impl EfficiencySpec {
    /// By direction: the first gear driving, the second gear driving.
    pub fn directed(forward: f64, backward: f64) -> Self {
        Self { forward: Rational::from_f64(forward), backward: Some(Rational::from_f64(backward)) }
    }

    /// By direction, exactly.
    pub fn exact(forward: Rational, backward: Rational) -> Self {
        Self { forward: Some(forward), backward: Some(Some(backward)) }
    }

    /// Whether each direction has a value of its own.
    pub fn is_directed(&self) -> bool {
        self.backward.is_some()
    }

    /// When the first gear drives; none where no finite number was given.
    pub fn forward(&self) -> Option<&Rational> {
        self.forward.as_ref()
    }

    /// When the second gear drives; none where no finite number was given.
    pub fn backward(&self) -> Option<&Rational> {
        self.backward.as_ref().unwrap_or(&self.forward).as_ref()
    }

    fn of(node: &Directed) -> Self {
        Self { forward: Some(node.forward.clone()), backward: node.backward.clone().map(Some) }
    }

    fn datum(&self) -> Datum {
        let number = |x: &Option<Rational>| x.as_ref().map_or(Datum::Number(f64::NAN), Datum::exact);
        match &self.backward {
            None => number(&self.forward),
            Some(backward) => {
                Datum::Table(vec![("forward".into(), number(&self.forward)), ("backward".into(), number(backward))])
            }
        }
    }
}

impl From<f64> for EfficiencySpec {
    fn from(value: f64) -> Self {
        Self { forward: Rational::from_f64(value), backward: None }
    }
}

impl From<Rational> for EfficiencySpec {
    fn from(value: Rational) -> Self {
        Self { forward: Some(value), backward: None }
    }
}

impl Field for EfficiencySpec {
    const KIND: Kind = Kind::Efficiency;
    type Plain = Self;
    fn read(node: &Node) -> Self {
        match node {
            Node::Efficiency(e) => Self::of(e),
            node => unreachable!("the reader keeps to the kind of a key, here is {node:?}"),
        }
    }
    fn blank() -> Self {
        Self::from(Rational::ONE)
    }
    fn write(&self) -> Option<Datum> {
        Some(self.datum())
    }
    fn plain(&self) -> Self {
        self.clone()
    }
}

/// Efficiencies of the meshes of a set: of all, or of those between external gears and of those with a ring gear.
#[derive(Clone, Debug, PartialEq)]
pub enum SetEfficiencySpec {
    /// Of every mesh.
    All(EfficiencySpec),
    /// By kind of mesh.
    ByKind {
        /// Sun to planet, planet to planet.
        external: EfficiencySpec,
        /// Planet to ring.
        internal: EfficiencySpec,
    },
}

impl Field for SetEfficiencySpec {
    const KIND: Kind = Kind::SetEfficiency;
    type Plain = Self;
    fn read(node: &Node) -> Self {
        match node {
            Node::SetEfficiency(all, None) => Self::All(EfficiencySpec::of(all)),
            Node::SetEfficiency(external, Some(internal)) => {
                Self::ByKind { external: EfficiencySpec::of(external), internal: EfficiencySpec::of(internal) }
            }
            node => unreachable!("the reader keeps to the kind of a key, here is {node:?}"),
        }
    }
    fn blank() -> Self {
        Self::All(EfficiencySpec::blank())
    }
    fn write(&self) -> Option<Datum> {
        Some(match self {
            Self::All(e) => e.datum(),
            Self::ByKind { external, internal } => {
                Datum::Table(vec![("external".into(), external.datum()), ("internal".into(), internal.datum())])
            }
        })
    }
    fn plain(&self) -> Self {
        self.clone()
    }
}

/// A coefficient of friction: one number, or points of it over the amount of slip.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionSpec(pub Vec<(AngularSpeed, f64)>);

impl From<f64> for FrictionSpec {
    fn from(value: f64) -> Self {
        Self(vec![(AngularSpeed::blank(), value)])
    }
}

impl Field for FrictionSpec {
    const KIND: Kind = Kind::NumberOrPoints(crate::units::Dimension::ANGULAR_SPEED);
    type Plain = Vec<[f64; 2]>;
    fn read(node: &Node) -> Self {
        match node {
            Node::Amount(_) => Self::from(f64::read(node)),
            node => Self(Field::read(node)),
        }
    }
    fn blank() -> Self {
        Self(vec![])
    }
    fn write(&self) -> Option<Datum> {
        match &self.0[..] {
            [(slip, value)] if *slip == AngularSpeed::blank() => Some(Datum::Number(*value)),
            points => points.to_vec().write(),
        }
    }
    fn plain(&self) -> Self::Plain {
        self.0.plain()
    }
}

/// Where an external torque may act: on the member of its name, or on another, beside other torques perhaps.
#[derive(Clone, Debug, PartialEq)]
pub struct TerminalSpec {
    /// What it is called.
    pub name: String,
    /// The member that it sits on, where that has another name.
    pub member: Option<String>,
}

impl From<&str> for TerminalSpec {
    fn from(name: &str) -> Self {
        Self { name: name.into(), member: None }
    }
}

impl Field for Vec<TerminalSpec> {
    const KIND: Kind = Kind::Terminals;
    type Plain = Self;
    fn read(node: &Node) -> Self {
        match node {
            Node::Terminals(all) => {
                all.iter().map(|(name, member)| TerminalSpec { name: name.clone(), member: member.clone() }).collect()
            }
            node => unreachable!("the reader keeps to the kind of a key, here is {node:?}"),
        }
    }
    fn blank() -> Self {
        vec![]
    }
    fn write(&self) -> Option<Datum> {
        let one = |t: &TerminalSpec| match &t.member {
            None => Datum::Text(t.name.clone()),
            Some(member) => Datum::Table(vec![
                ("name".into(), Datum::Text(t.name.clone())),
                ("member".into(), Datum::Text(member.clone())),
            ]),
        };
        (!self.is_empty()).then(|| Datum::List(self.iter().map(one).collect()))
    }
    fn plain(&self) -> Self {
        self.clone()
    }
}

/// The two gears of a mesh.
impl Field for [GearSpec; 2] {
    const KIND: Kind = Kind::Tables(GearSpec::TABLE, 2);
    type Plain = [PlainGear; 2];
    fn read(node: &Node) -> Self {
        let mut all = <Vec<GearSpec> as Field>::read(node).into_iter();
        [all.next().unwrap_or_default(), all.next().unwrap_or_default()]
    }
    fn blank() -> Self {
        Default::default()
    }
    fn write(&self) -> Option<Datum> {
        self.to_vec().write()
    }
    fn plain(&self) -> Self::Plain {
        [self[0].twin(), self[1].twin()]
    }
}

specification! {
    /// A gear of a mesh.
    GearSpec => PlainGear {
        /// The rotor it sits on.
        must member: String as Kind::Name,
        /// Tooth count.
        must teeth: i64,
        /// true for a ring gear.
        may internal: bool,
        ..tooth: ToothSpec,
    }

    /// A gear pair on a carrier.
    MeshSpec => PlainMesh {
        /// Default: built from its gears.
        may name: Option<String>,
        /// The two gears. They turn in opposite senses relative to the carrier unless one is internal or `sense` says
        /// otherwise.
        must gears: [GearSpec; 2],
        /// The member that carries the axes. Default: frame.
        may carrier: Option<String> as Kind::Name,
        /// In the carrier frame; or { forward, backward }: forward = the first gear drives. Default: lossless, listed
        /// as an assumption.
        may efficiency: Option<EfficiencySpec>,
        /// Identical meshes in parallel. Default: 1.
        may count: Option<i64>,
        /// The teeth: module, width, angles. With an oil, losses are computed.
        may geometry: Option<Box<GeometrySpec>>,
        /// Direction from the axis of the first gear to that of the second, seen along the axes, from any direction that
        /// all angles share. Default: not known, so forces of several meshes on a shaft are added by amount.
        may angle: Option<Angle>,
        /// Efficiency and bearing torque over speed, instead of an efficiency; operating points use its first row.
        may loss_table: Option<Vec<LossRowSpec>>,
        /// Relative to the carrier. `same` for chains and for the second side gear of a bevel set.
        may sense: Option<Sense>,
        /// On a bevel pair the planet's speed is that of the carrier plus its spin.
        may kind: Option<PairKind>,
    }

    /// A clutch, brake or one-way clutch.
    ShiftElementSpec => PlainShiftElement {
        /// Its letter in the shift table.
        must name: String,
        /// What it is.
        must kind: ShiftElementKind,
        /// The two members a clutch joins; the one a brake holds; one (against the frame) or two for a one-way clutch.
        must members: Vec<String>,
        /// For a one-way clutch: the direction of the first member relative to the second that it prevents. Default:
        /// backward.
        may blocks: Option<Direction>,
        /// Torque that it transmits when fully engaged and sliding, in motion. Default: unlimited.
        may capacity: Option<Torque>,
        /// Coefficient of friction, or points of it over slip, with `normal_force` and `effective_radius`. With
        /// `capacity`: a factor on it. Default: 1.
        may friction: Option<FrictionSpec>,
        /// Force on the friction surfaces when fully engaged.
        may normal_force: Option<Force>,
        /// Mean radius times the number of friction surfaces.
        may effective_radius: Option<Length>,
        /// Torque at which it breaks away over that at which it slides; at least 1. Default: 1.
        may peak: Option<f64>,
        /// What it does while it is open: drag by its plates, or by a measured curve. Default: nothing.
        may open: Option<Box<OpenSpec>>,
    }

    /// A row of the shift table.
    StateSpec => PlainState {
        /// The gear: 1, 2, R, …
        must name: String,
        /// The shift elements that are closed.
        must engaged: Vec<String>,
        /// Where power enters in this state.
        may input: Option<String> as Kind::Name,
        /// Where power leaves in this state.
        may output: Option<String> as Kind::Name,
    }

    /// An operating point. As many speeds as the train has degrees of freedom; a torque or power on every terminal but
    /// as many as that.
    OperationSpec => PlainOperation {
        /// What it is called.
        must name: String,
        /// The state of the shift table it runs in. Default: as drawn.
        may state: Option<String> as Kind::Name,
        /// Prescribed speeds, positive in one axis direction for the whole train.
        may speeds: Vec<(String, AngularSpeed)>,
        /// Members held at rest from outside.
        may fixed: Vec<String>,
        /// External torques ON terminals.
        may torques: Vec<(String, Torque)>,
        /// External powers INTO the train at terminals.
        may powers: Vec<(String, Power)>,
        /// Power out of the store of a variator into its bus, or "free" for whatever balances it; of several variators by
        /// their names. Default: that of the variator.
        may store: StoreSpec,
        /// Oil temperature in this operating point. Default: that of the oil.
        may temperature: Option<Temperature>,
    }

    /// A sweep over many operating points.
    StudySpec => PlainStudy {
        /// What it is called.
        must name: String,
        /// Axes, QUANTITY=VALUES: "input.speed=500 rpm..12000 rpm:100", "state=all", "P1.planet.count=3,4,6".
        must over: Vec<String>,
        /// The operation from which it starts. Default: the first.
        may operation: Option<String> as Kind::Name,
        /// The state of the shift table. Default: that of the operation.
        may state: Option<String> as Kind::Name,
        /// What stays the same: the loads as given (the default), their torques, their powers, or the torque at the
        /// output.
        may hold: Option<String> as Kind::Choice(HOLDS),
        /// More columns: members, meshes, elements, sources, all, or single ones.
        may columns: Vec<String>,
    }

    /// A Willis gear train, format 1. Quantities are texts with a unit ("4920 rpm", "350 N m", "75 kW").
    ///
    /// It is all that a train file can say, as data. It is written as a train file by [`Specification::to_toml`], and by
    /// serde in the same shape; [`Specification::build`] checks it and makes a [`Train`](crate::Train).
    ///
    /// # Example
    /// ```
    /// use willis::train::{SetSpec, Specification};
    ///
    /// let specification = Specification::new("reducer")
    ///     .members(["s", "c"])
    ///     .terminals(["s", "c"])
    ///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99));
    /// assert!(specification.to_toml().contains("mesh_efficiency = 0.99"));
    /// assert_eq!(specification.build()?.meshes().len(), 2);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    Specification => PlainSpecification {
        /// Format of this file; 1.
        must format: FormatNumber,
        /// What the train is called.
        must name: String,
        /// Where the data come from.
        may source: Option<String>,
        /// Anything else worth keeping with the train.
        may notes: Option<String>,
        /// Every rotor. `frame` always exists and is at rest; planets of sets need no entry.
        must members: Vec<String>,
        /// Members on which an external torque may act, or { name, member } for one of several torques on a member. The
        /// first is the input and the last the output, unless `input` and `output` or a state say otherwise.
        may terminals: Vec<TerminalSpec>,
        /// Where power enters when driving.
        may input: Option<String> as Kind::Name,
        /// Where power leaves when driving.
        may output: Option<String> as Kind::Name,
        /// Gear pairs on a carrier.
        may mesh: Vec<MeshSpec>,
        /// Planetary sets; each expands into its meshes.
        may set: Vec<SetSpec>,
        /// Clutches, brakes and one-way clutches.
        may shift_element: Vec<ShiftElementSpec>,
        /// Second paths of power splits: machines on a bus, pumps and motors, belts.
        may variator: Vec<VariatorSpec>,
        /// The shift table. Without it the train is as drawn.
        may state: Vec<StateSpec>,
        /// Operating points to analyse.
        may operation: Vec<OperationSpec>,
        /// The lubricant: from the catalogue, or by its data.
        may oil: Option<OilSpec>,
        /// Which law of each family is used; `willis laws` lists them.
        may laws: Option<LawsSpec>,
        /// What tests say of the losses that the laws give.
        may losses: Option<LossesSpec>,
        /// What surrounds the gears.
        may housing: Option<HousingSpec>,
        /// What carries the heat of the losses away: operations without a temperature run at the oil temperature that
        /// follows.
        may heat: Option<HeatSpec>,
        /// Rolling bearings.
        may bearing: Vec<BearingSpec>,
        /// Radial lip seals.
        may seal: Vec<SealSpec>,
        /// Carriers and drums that drag the fluid around them.
        may rotor: Vec<RotorSpec>,
        /// Oil pumps.
        may pump: Vec<PumpSpec>,
        /// Moments of inertia of members about their axes; of planets, all of them together. Planets of sets may have
        /// theirs in the set.
        may inertias: Vec<(String, MomentOfInertia)>,
        /// Friction that does not depend on tooth loads, in motion.
        may drag: Vec<DragSpec>,
        /// Elastic shafts.
        may shaft: Vec<ShaftSpec>,
        /// Motions to simulate.
        may scenario: Vec<ScenarioSpec>,
        /// Sweeps over many operating points: `willis sweep FILE --study NAME`.
        may study: Vec<StudySpec>,
    }
}

/// The keys of a train file.
pub(super) const FILE: &Table = Specification::TABLE;

/// What a key takes, by the keys that lead to it; positions in lists are left out.
pub(crate) fn kind_of(steps: &[&str]) -> Option<Kind> {
    fn within(table: &Table, steps: &[&str]) -> Option<Kind> {
        let (first, rest) = steps.split_first()?;
        let kind = table.key(first)?.kind;
        match kind {
            Kind::Table(of) | Kind::Tables(of, _) if !rest.is_empty() => within(of, rest),
            Kind::Variants(all) if !rest.is_empty() => all.iter().find_map(|(_, of)| within(of, rest)),
            // Below it stand names and directions.
            kind => Some(kind),
        }
    }
    within(FILE, steps)
}

impl Specification {
    /// Begins a train.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// As a train file, TOML. What is exact stays exact, and reading it gives the same specification.
    pub fn to_toml(&self) -> String {
        let mut keys = vec![];
        self.write_fields(&mut keys);
        crate::train::format::document(&keys)
    }

    /// Names the rotors (the frame and the planets of sets exist without being named).
    #[must_use]
    pub fn members<'a>(mut self, names: impl IntoIterator<Item = &'a str>) -> Self {
        self.members.extend(names.into_iter().map(String::from));
        self
    }

    /// Names the members on which an external torque may act. The first is the input and the last the output, unless a
    /// state says otherwise.
    #[must_use]
    pub fn terminals<'a>(mut self, names: impl IntoIterator<Item = &'a str>) -> Self {
        self.terminals.extend(names.into_iter().map(TerminalSpec::from));
        self
    }

    /// Names an external torque that sits on a member, beside others perhaps: a machine on the shaft of the wheels.
    #[must_use]
    pub fn terminal_on(mut self, name: impl Into<String>, member: impl Into<String>) -> Self {
        self.terminals.push(TerminalSpec { name: name.into(), member: Some(member.into()) });
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
        self.mesh.push(mesh);
        self
    }

    /// Adds a set.
    #[must_use]
    pub fn set(mut self, set: SetSpec) -> Self {
        self.set.push(set);
        self
    }

    /// Adds a clutch or brake.
    #[must_use]
    pub fn shift_element(mut self, element: ShiftElementSpec) -> Self {
        self.shift_element.push(element);
        self
    }

    /// Adds a way for power beside the gears.
    #[must_use]
    pub fn variator(mut self, variator: VariatorSpec) -> Self {
        self.variator.push(variator);
        self
    }

    /// Adds a row of the shift table.
    #[must_use]
    pub fn state(mut self, state: StateSpec) -> Self {
        self.state.push(state);
        self
    }

    /// Adds an operating point.
    #[must_use]
    pub fn operation(mut self, operation: OperationSpec) -> Self {
        self.operation.push(operation);
        self
    }

    /// Gives the lubricant.
    #[must_use]
    pub fn oil(mut self, oil: OilSpec) -> Self {
        self.oil = Some(oil);
        self
    }

    /// Chooses laws.
    #[must_use]
    pub fn laws(mut self, laws: LawsSpec) -> Self {
        self.laws = Some(laws);
        self
    }

    /// Says what surrounds the gears.
    #[must_use]
    pub fn housing(mut self, housing: HousingSpec) -> Self {
        self.housing = Some(housing);
        self
    }

    /// Says what carries the heat of the losses away.
    #[must_use]
    pub fn heat(mut self, heat: HeatSpec) -> Self {
        self.heat = Some(heat);
        self
    }

    /// Adds rolling bearings between two members.
    #[must_use]
    pub fn bearing(mut self, bearing: BearingSpec) -> Self {
        self.bearing.push(bearing);
        self
    }

    /// Adds a lip seal.
    #[must_use]
    pub fn seal(mut self, seal: SealSpec) -> Self {
        self.seal.push(seal);
        self
    }

    /// Adds an oil pump that a member drives.
    #[must_use]
    pub fn pump(mut self, pump: PumpSpec) -> Self {
        self.pump.push(pump);
        self
    }

    /// Adds a carrier or drum that drags the fluid around it.
    #[must_use]
    pub fn rotor(mut self, rotor: RotorSpec) -> Self {
        self.rotor.push(rotor);
        self
    }

    /// Gives the moment of inertia of a member about its axis; of planets, of all of them together.
    #[must_use]
    pub fn inertia(mut self, member: &str, value: MomentOfInertia) -> Self {
        self.inertias.push((member.into(), value));
        self
    }

    /// Adds friction that does not depend on tooth loads.
    #[must_use]
    pub fn drag(mut self, drag: DragSpec) -> Self {
        self.drag.push(drag);
        self
    }

    /// Adds an elastic shaft.
    #[must_use]
    pub fn shaft(mut self, shaft: ShaftSpec) -> Self {
        self.shaft.push(shaft);
        self
    }

    /// Adds a motion to simulate.
    #[must_use]
    pub fn scenario(mut self, scenario: ScenarioSpec) -> Self {
        self.scenario.push(scenario);
        self
    }

    /// Adds a sweep.
    #[must_use]
    pub fn study(mut self, study: StudySpec) -> Self {
        self.study.push(study);
        self
    }
}

impl GearSpec {
    /// An external gear.
    pub fn external(member: impl Into<String>, teeth: i64) -> Self {
        Self { member: member.into(), teeth, ..Self::default() }
    }

    /// A ring gear.
    pub fn internal(member: impl Into<String>, teeth: i64) -> Self {
        Self { internal: true, ..Self::external(member, teeth) }
    }

    /// Gives profile shift, tip and roughness.
    #[must_use]
    pub fn tooth(mut self, tooth: ToothSpec) -> Self {
        self.tooth = tooth;
        self
    }
}

impl MeshSpec {
    /// A pair carried by the frame, with no loss given.
    pub fn new(first: GearSpec, second: GearSpec) -> Self {
        Self { gears: [first, second], ..Self::default() }
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
        self.carrier = Some(member.into());
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
        self.geometry = Some(Box::new(geometry));
        self
    }

    /// Gives efficiency and bearing torque over speed, instead of an efficiency.
    #[must_use]
    pub fn loss_table(mut self, rows: Vec<LossRowSpec>) -> Self {
        self.loss_table = Some(rows);
        self
    }

    /// Identical meshes in parallel.
    #[must_use]
    pub fn count(mut self, count: i64) -> Self {
        self.count = Some(count);
        self
    }

    /// Both gears turn in the same sense (a chain, the second side gear of a bevel set).
    #[must_use]
    pub fn same_sense(mut self) -> Self {
        self.sense = Some(Sense::Same);
        self
    }

    /// Makes it a bevel pair.
    #[must_use]
    pub fn bevel(mut self) -> Self {
        self.kind = Some(PairKind::Bevel);
        self
    }
}

impl ShiftElementSpec {
    fn of(name: impl Into<String>, kind: ShiftElementKind, members: &[&str]) -> Self {
        let members = members.iter().map(|m| (*m).to_owned()).collect();
        Self { name: name.into(), kind, members, ..Self::default() }
    }

    /// Joins two members when engaged.
    pub fn clutch(name: impl Into<String>, a: &str, b: &str) -> Self {
        Self::of(name, ShiftElementKind::Clutch, &[a, b])
    }

    /// Holds a member when engaged.
    pub fn brake(name: impl Into<String>, member: &str) -> Self {
        Self::of(name, ShiftElementKind::Brake, &[member])
    }

    /// Prevents `member` from turning backward relative to `other` (use `"frame"` for the housing).
    pub fn one_way(name: impl Into<String>, member: &str, other: &str) -> Self {
        Self::of(name, ShiftElementKind::OneWay, &[member, other])
    }

    /// Torque that it transmits when fully engaged and sliding; unlimited unless given.
    #[must_use]
    pub fn capacity(mut self, torque: Torque) -> Self {
        self.capacity = Some(torque);
        self
    }

    /// Coefficient of friction; with [`Self::pressed`]. With [`Self::capacity`] a factor on it.
    #[must_use]
    pub fn friction(mut self, friction: impl Into<FrictionSpec>) -> Self {
        self.friction = Some(friction.into());
        self
    }

    /// Force on the friction surfaces when fully engaged, and mean radius times number of surfaces.
    #[must_use]
    pub fn pressed(mut self, normal_force: Force, effective_radius: Length) -> Self {
        self.normal_force = Some(normal_force);
        self.effective_radius = Some(effective_radius);
        self
    }

    /// Torque at which it breaks away over that at which it slides; 1 unless given.
    #[must_use]
    pub fn peak(mut self, factor: f64) -> Self {
        self.peak = Some(factor);
        self
    }
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

impl OperationSpec {
    /// An operating point of the train as drawn.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
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
        self.speeds.push((member.into(), speed));
        self
    }

    /// Holds a member from outside.
    #[must_use]
    pub fn fixed(mut self, member: &str) -> Self {
        self.fixed.push(member.into());
        self
    }

    /// Prescribes the oil temperature.
    #[must_use]
    pub fn temperature(mut self, temperature: Temperature) -> Self {
        self.temperature = Some(temperature);
        self
    }

    /// Prescribes the external torque on a terminal.
    #[must_use]
    pub fn torque(mut self, member: &str, torque: Torque) -> Self {
        self.torques.push((member.into(), torque));
        self
    }

    /// Prescribes the external power into a terminal.
    #[must_use]
    pub fn power(mut self, member: &str, power: Power) -> Self {
        self.powers.push((member.into(), power));
        self
    }
}
