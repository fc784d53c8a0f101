//! What a gear train is: members, meshes, sets, shift elements, states and operations.
//!
//! A [`Train`] is valid by construction. It comes from a file's text ([`Train::from_toml`]) or from
//! a builder ([`Train::builder`]); both go through the same checks. Sets (simple, stepped,
//! Ravigneaux, …) are expanded into their meshes, so that everything downstream knows only
//! members and meshes.

mod assemble;
mod assembler;
pub(crate) mod csv;
mod described;
mod dynamic;
mod edit;
mod expand;
mod find;
mod format;
mod formula;
pub mod heat;
mod input;
mod physical;
mod reading;
mod schema;
mod specification;
mod variator;
mod words;

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::losses::Laws;
use crate::units::{AngularSpeed, Power, Quantity, Temperature, Torque};

pub use dynamic::{
    Contact, Control, ControlKind, Curve, DragMount, Engagement, Friction, Inertia, LossRow, LossTable, Scenario,
    Shaft, Signal, Source, SourceKind,
};
pub use edit::{Document, Key, Measure, Ramp};
pub use find::AS_DRAWN;
pub(crate) use format::keys::Kind as KeyKind;
pub use formula::Formula;
pub(crate) use heat::HeatNumber;
pub(crate) use input::{BearingNumber, Input, PumpNumber, RotorNumber, Slot};
pub(crate) use physical::steel_mass;
pub(crate) use physical::{BEVEL_WIDTH, OpenNumber};
pub use physical::{
    BearingMount, Housing, Jet, LossFactors, LossPart, Lubrication, OpenElement, PlanetBody, Pump, Rotor, SealMount,
    Teeth, TipRelief,
};
pub use reading::Reading;
pub use schema::schema;
pub(crate) use specification::kind_of;
pub use specification::{
    BearingSpec, BevelSpec, CentralSpec, ControlSpec, ControllerSpec, CoolerSpec, Direction, DoublePlanetSpec,
    DragSpec, EfficiencySpec, EngagementSpec, Fluid, FormatNumber, FrictionSpec, GearSpec, GeometrySpec, Hand,
    HeatNodeSpec, HeatPathSpec, HeatSpec, HousingSpec, JetSide, LawsSpec, LinearSpec, LossFactorSpec, LossRowSpec,
    LossesSpec, MachineEfficiencySpec, MachineSpec, MeshSpec, MeshStiffness, MotorSpec, OilSpec, OilSupply, OpenSpec,
    OperationSpec, PairKind, PlanetBodySpec, PlanetSpec, PumpSpec, QuadraticSpec, RatioSpec, RavigneauxSpec, RotorSpec,
    ScenarioSpec, SealSpec, Sense, SetEfficiencySpec, SetParts, SetSpec, ShaftSpec, ShiftElementSpec, Side, SideSpec,
    SignalSpec, SimpleSpec, SourceSpec, Specification, StateSpec, StepSpec, SteppedPlanetSpec, SteppedSpec, StoreSpec,
    StudySpec, SurfaceSpec, TerminalSpec, ToothSpec, VariatorSpec, VehicleSpec,
};
pub use variator::{EfficiencyMap, Machine, MachineEfficiency, Store, Variator, VariatorKind, VariatorPath};

/// A member's number within its train. The frame is number 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MemberId(pub(crate) usize);

/// A mesh's number within its train.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MeshId(pub(crate) usize);

/// A shift element's number within its train.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ShiftElementId(pub(crate) usize);

/// The frame: always there, always at rest.
pub const FRAME: MemberId = MemberId(0);

impl MemberId {
    /// Position in [`Train::members`].
    pub fn index(self) -> usize {
        self.0
    }
}

impl MeshId {
    /// Position in [`Train::meshes`].
    pub fn index(self) -> usize {
        self.0
    }
}

impl ShiftElementId {
    /// Position in [`Train::shift_elements`].
    pub fn index(self) -> usize {
        self.0
    }
}

/// What a member is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemberKind {
    /// The housing.
    Frame,
    /// A rotor that the user named.
    Shaft,
    /// A planet that a set brought along.
    Planet,
}

/// A rotor, or the frame.
#[derive(Clone, Debug)]
pub struct Member {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: MemberKind,
}

/// One gear of a mesh.
#[derive(Clone, Debug)]
pub struct Gear {
    /// The rotor it sits on.
    pub member: MemberId,
    /// Tooth count; a fraction only where a set's planet is nominal.
    pub teeth: Rational,
    /// Whether it is a ring gear.
    pub internal: bool,
}

/// Efficiency of a mesh or set in its carrier frame, by driving direction; `0 < η ≤ 1`.
#[derive(Clone, Debug, PartialEq)]
pub struct Efficiency {
    /// When the first gear drives.
    pub forward: Rational,
    /// When the second gear drives.
    pub backward: Rational,
}

impl Efficiency {
    /// No loss.
    pub fn lossless() -> Self {
        Self { forward: Rational::ONE, backward: Rational::ONE }
    }
}

/// A gear pair on a carrier, or `count` identical ones in parallel.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Its name.
    pub name: String,
    /// The two gears; the efficiency's "forward" is the first one driving.
    pub gears: [Gear; 2],
    /// The member that carries the axes.
    pub carrier: MemberId,
    /// Efficiency in the carrier frame.
    pub efficiency: Efficiency,
    /// Whether both gears turn in the same sense relative to the carrier.
    pub same_sense: bool,
    /// Whether the axes intersect: a planet's speed is then that of the carrier plus its spin.
    pub bevel: bool,
    /// Identical meshes in parallel.
    pub count: u32,
    /// Direction from the axis of the first gear to that of the second, rad, where it is known.
    pub angle: Option<f64>,
    /// The set that it belongs to.
    pub set: Option<usize>,
    /// Whether [`Mesh::efficiency`] is a nominal one: at operating points the loss is computed from
    /// the teeth.
    pub computed: bool,
    /// Its teeth, where the geometry is given.
    pub teeth: Option<Box<Teeth>>,
}

impl Mesh {
    /// Load of the parallel mesh that is loaded most over the mean of all, K_γ; 1 where there is one alone.
    pub(crate) fn sharing(&self) -> f64 {
        self.teeth.as_ref().filter(|_| self.count > 1).map_or(1.0, |teeth| teeth.sharing)
    }
}

/// A set as its writer named it; its gears are among the train's meshes.
#[derive(Clone, Debug)]
pub struct Set {
    /// Its name.
    pub name: String,
    /// The type, as in the file: `simple`, `stepped`, …
    pub kind: &'static str,
    /// Number of (first) planets, when given.
    pub planets: Option<u32>,
}

/// Kind of shift element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ShiftElementKind {
    /// Joins two members.
    Clutch,
    /// Holds a member.
    Brake,
    /// Joins two members (or holds one) against turning in one direction.
    OneWay,
}

impl fmt::Display for ShiftElementKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Clutch => "clutch",
            Self::Brake => "brake",
            Self::OneWay => "one-way clutch",
        })
    }
}

/// A clutch, brake or one-way clutch.
#[derive(Clone, Debug)]
pub struct ShiftElement {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: ShiftElementKind,
    /// The member it acts on and the one it joins it to (the frame for a brake).
    pub members: [MemberId; 2],
    /// For a one-way clutch: the sign of the relative speed of the first member that it prevents.
    pub blocks: i8,
    /// What it can hold, where that is limited and known.
    pub friction: Option<Friction>,
    /// What it does while it is open, where that is known.
    pub open: Option<OpenElement>,
}

/// A row of the shift table.
#[derive(Clone, Debug)]
pub struct State {
    /// Its name.
    pub name: String,
    /// The shift elements that are closed.
    pub engaged: Vec<ShiftElementId>,
    /// Where power enters when driving.
    pub input: Option<MemberId>,
    /// Where power leaves when driving.
    pub output: Option<MemberId>,
}

/// What an operation prescribes on a terminal.
#[derive(Clone, Debug)]
pub enum Load {
    /// External torque on the member.
    Torque(Quantity),
    /// External power into the train.
    Power(Quantity),
}

impl Load {
    /// The power, where that is what is prescribed.
    pub(crate) fn power(&self) -> Option<&Quantity> {
        match self {
            Self::Power(power) => Some(power),
            Self::Torque(_) => None,
        }
    }
}

/// An operating point to analyse.
#[derive(Clone, Debug)]
pub struct Operation {
    /// Its name.
    pub name: String,
    /// The state of the shift table (position in [`Train::states`]), if not as drawn.
    pub state: Option<usize>,
    /// Prescribed speeds.
    pub speeds: Vec<(MemberId, Quantity)>,
    /// Members held at rest from outside.
    pub fixed: Vec<MemberId>,
    /// Prescribed torques and powers.
    pub loads: Vec<(MemberId, Load)>,
    /// Powers out of the stores of variators (positions in [`Train::variators`]), where they differ from the train's.
    pub stores: Vec<(usize, Store)>,
    /// Torques that machines exert on their members, or their mechanical powers: variator and machine by position.
    pub machines: Vec<([usize; 2], Load)>,
    /// Oil temperature, K, where it differs from that of the oil.
    pub temperature: Option<f64>,
    pub(crate) place: String,
}

impl Operation {
    /// An operating point of the train as drawn, in which nothing is prescribed yet.
    ///
    /// By the names of members and states it is made with [`Train::operation`].
    ///
    /// # Example
    /// ```
    /// use willis::train::{Operation, SetSpec, Train};
    /// use willis::units::{AngularSpeed, Torque};
    ///
    /// let train = Train::builder("reducer")
    ///     .members(["s", "c"])
    ///     .terminals(["s", "c"])
    ///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
    ///     .build()?;
    /// let sun = train.member("s").unwrap();
    /// let point = Operation::new("20 N m").speed(sun, AngularSpeed::rpm(1000.0)).load(sun, Torque::n_m(20.0));
    /// let (report, _) = willis::analysis::operate(&train, &point)?;
    /// assert!(report.solutions[0].efficiency.unwrap() > 0.98);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            state: None,
            speeds: vec![],
            fixed: vec![],
            loads: vec![],
            stores: vec![],
            machines: vec![],
            temperature: None,
            place: String::new(),
        }
    }

    /// In a state of the shift table, by its position in [`Train::states`].
    #[must_use]
    pub fn state(mut self, state: usize) -> Self {
        self.state = Some(state);
        self
    }

    /// Prescribes a speed.
    #[must_use]
    pub fn speed(mut self, member: MemberId, speed: AngularSpeed) -> Self {
        self.speeds.push((member, speed.into()));
        self
    }

    /// Holds a member at rest from outside.
    #[must_use]
    pub fn fixed(mut self, member: MemberId) -> Self {
        self.fixed.push(member);
        self
    }

    /// Prescribes an external torque, or a power into the train.
    #[must_use]
    pub fn load(mut self, member: MemberId, load: impl Into<Load>) -> Self {
        self.loads.push((member, load.into()));
        self
    }

    /// Prescribes the oil temperature.
    #[must_use]
    pub fn temperature(mut self, temperature: Temperature) -> Self {
        self.temperature = Some(temperature.si());
        self
    }
}

impl From<Torque> for Load {
    fn from(torque: Torque) -> Self {
        Self::Torque(torque.into())
    }
}

impl From<Power> for Load {
    fn from(power: Power) -> Self {
        Self::Power(power.into())
    }
}

/// A gear train that passed every check.
///
/// # Example
/// ```
/// use willis::train::{SetSpec, ShiftElementSpec, StateSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["s", "r", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .shift_element(ShiftElementSpec::brake("B", "r"))
///     .state(StateSpec::new("1", ["B"]))
///     .build()?;
/// assert_eq!(train.meshes().len(), 2);
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Train {
    pub(crate) name: String,
    pub(crate) source: Option<String>,
    pub(crate) members: Vec<Member>,
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) sets: Vec<Set>,
    pub(crate) shift_elements: Vec<ShiftElement>,
    pub(crate) states: Vec<State>,
    pub(crate) operations: Vec<Operation>,
    pub(crate) terminals: Vec<MemberId>,
    pub(crate) input: Option<MemberId>,
    pub(crate) output: Option<MemberId>,
    pub(crate) studies: Vec<StudySpec>,
    pub(crate) warnings: Vec<Diagnostic>,
    /// See [`Train::unplaced_masses`].
    pub(crate) unplaced_masses: Vec<String>,
    /// See [`Train::speed_tolerance`].
    pub(crate) speed_tolerance: f64,
    pub(crate) assumptions: Vec<String>,
    pub(crate) lubrication: Option<Lubrication>,
    pub(crate) laws: Laws,
    pub(crate) housing: Housing,
    /// What tests say of the laws.
    pub(crate) loss_factors: LossFactors,
    /// What carries heat away.
    pub(crate) heat: Option<heat::Heat>,
    pub(crate) bearings: Vec<BearingMount>,
    pub(crate) seals: Vec<SealMount>,
    pub(crate) rotors: Vec<Rotor>,
    pub(crate) pumps: Vec<Pump>,
    pub(crate) planets: Vec<PlanetBody>,
    pub(crate) inertias: Vec<Inertia>,
    pub(crate) drags: Vec<DragMount>,
    pub(crate) shafts: Vec<Shaft>,
    pub(crate) loss_tables: Vec<LossTable>,
    pub(crate) scenarios: Vec<Scenario>,
    pub(crate) variators: Vec<Variator>,
    /// Named terminals and the members that they sit on: shafts of their own, for good coupled with those.
    pub(crate) joints: Vec<[MemberId; 2]>,
    pub(crate) inputs: Vec<Input>,
}

impl Train {
    /// Starts a train.
    pub fn builder(name: impl Into<String>) -> Specification {
        Specification::new(name)
    }

    /// Reads the text of a train file (TOML, format 1). No file is touched.
    ///
    /// # Errors
    /// Everything that is wrong with the text, each with its place.
    ///
    /// # Example
    /// ```
    /// let wrong = willis::train::Train::from_toml("format = 1\nname = 'x'\nmembres = []").unwrap_err();
    /// assert!(wrong.to_string().contains("did you mean `members`?"));
    /// ```
    pub fn from_toml(text: &str) -> Result<Self, Diagnostics> {
        let Reading { train, diagnostics, .. } = Self::read_toml(text);
        train.ok_or(diagnostics)
    }

    /// Like [`Train::from_toml`], and tells the warnings about a good train too.
    ///
    /// A text that names CSV files is read by [`Train::read_toml_with`].
    pub fn read_toml(text: &str) -> Reading {
        Self::read_toml_with(text, &mut |file| Err(format!("`{file}`: files are not read here")))
    }

    /// Like [`Train::read_toml`]; `load` gives the text of a file that the train file names, or says
    /// why it cannot.
    ///
    /// # Example
    /// ```
    /// let text = r#"
    ///     format = 1
    ///     name = "wheel"
    ///     members = ["wheel"]
    ///     inertias = { wheel = "2 kg m^2" }
    ///     [[scenario]]
    ///     name = "measured load"
    ///     duration = "1 s"
    ///     [[scenario.source]]
    ///     member = "wheel"
    ///     torque = { type = "csv", file = "load.csv", time = "t", value = "torque" }
    /// "#;
    /// let mut load = |_: &str| Ok("t,torque\n0,5\n1,7".to_owned());
    /// let train = willis::train::Train::read_toml_with(text, &mut load).train.unwrap();
    /// assert_eq!(train.scenarios()[0].sources[0].name, "torque on wheel");
    /// ```
    pub fn read_toml_with(text: &str, load: &mut dyn FnMut(&str) -> Result<String, String>) -> Reading {
        reading::read(text, load)
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Planets whose mass is given and whose orbit is not known, by the names of their members: what they add to the
    /// inertia of their carrier is missing.
    pub fn unplaced_masses(&self) -> &[String] {
        &self.unplaced_masses
    }

    /// Prescribed speeds are those that the gears allow when they differ from these by no more than this part of the
    /// largest speed that they are tied to: a text has few digits, and the speeds of a train follow each other exactly.
    pub const SAME_SPEED: f64 = 1e-9;

    /// The largest [tolerance](Self::with_speed_tolerance).
    pub const MOST_SPEED_TOLERANCE: f64 = 0.1;

    /// By which part prescribed speeds may contradict the gears; [`SAME_SPEED`](Self::SAME_SPEED) where nobody says
    /// more.
    pub fn speed_tolerance(&self) -> f64 {
        self.speed_tolerance
    }

    /// The same train, whose prescribed speeds may be measured ones: they may contradict the gears by this part of the
    /// largest speed that they are tied to. The speeds that come last among those given then yield, and a warning
    /// ([`Code::SpeedsYield`]) tells by how much.
    ///
    /// # Errors
    /// A number that is not from 0 to 0.1.
    ///
    /// # Example
    /// ```
    /// use willis::analysis::{Selection, analyze};
    ///
    /// // 1000 rpm of the sun make 300 rpm of the carrier; 300.5 were measured.
    /// let text = r#"
    ///     format = 1
    ///     name = "measured"
    ///     members = ["s", "c"]
    ///     terminals = ["s", "c"]
    ///     set = [{ name = "P1", sun = { member = "s", teeth = 30 }, ring = { member = "frame", teeth = 70 }, carrier = "c" }]
    ///     operation = [{ name = "a", speeds = { s = "1000 rpm", c = "300.5 rpm" }, torques = { s = "10 N m" } }]
    /// "#;
    /// let train = willis::Train::from_toml(text)?;
    /// assert!(analyze(&train, &Selection::default()).is_err());
    /// let analysis = analyze(&train.with_speed_tolerance(0.01)?, &Selection::default())?;
    /// let deviation = analysis.operations[0].speed_deviation.as_ref().unwrap();
    /// assert!((deviation.relative - 0.5 / 300.5).abs() < 1e-4);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn with_speed_tolerance(mut self, tolerance: f64) -> Result<Self, Diagnostics> {
        if !(0.0..=Self::MOST_SPEED_TOLERANCE).contains(&tolerance) {
            let message =
                format!("a speed tolerance of {tolerance}: it is a part from 0 to {}", Self::MOST_SPEED_TOLERANCE);
            return Err(Diagnostic::new(Code::OutOfRange, "", message).hint("0.005 and 0.5 % are the same").into());
        }
        self.speed_tolerance = tolerance.max(Self::SAME_SPEED);
        Ok(self)
    }

    /// Where its data come from, in the writer's words.
    pub fn source(&self) -> Option<&str> {
        self.source.as_deref()
    }

    /// The frame, then every rotor: the named ones, then the planets of the sets.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Every gear pair.
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }

    /// Every set.
    pub fn sets(&self) -> &[Set] {
        &self.sets
    }

    /// Every clutch and brake.
    pub fn shift_elements(&self) -> &[ShiftElement] {
        &self.shift_elements
    }

    /// The shift table.
    pub fn states(&self) -> &[State] {
        &self.states
    }

    /// The operating points of the file.
    pub fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// An operating point of this train, by the names of members and states.
    ///
    /// # Errors
    /// A name that the train does not have; a member that is held and driven; a load where no torque may act.
    ///
    /// # Example
    /// ```
    /// use willis::train::{OperationSpec, SetSpec, Train};
    /// use willis::units::{AngularSpeed, Torque};
    ///
    /// let train = Train::builder("reducer")
    ///     .members(["s", "c"])
    ///     .terminals(["s", "c"])
    ///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
    ///     .build()?;
    /// let asked = OperationSpec::new("20 N m").speed("s", AngularSpeed::rpm(1000.0)).torque("s", Torque::n_m(20.0));
    /// let (report, _) = willis::analysis::operate(&train, &train.operation(&asked)?)?;
    /// assert!(report.solutions[0].efficiency.unwrap() > 0.98);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn operation(&self, spec: &OperationSpec) -> Result<Operation, Diagnostics> {
        assemble::operating_point(self, spec)
    }

    /// Members on which an external torque may act.
    pub fn terminals(&self) -> &[MemberId] {
        &self.terminals
    }

    /// Where power enters when driving, if the state does not say otherwise.
    pub fn input(&self) -> Option<MemberId> {
        self.input
    }

    /// Where power leaves when driving, if the state does not say otherwise.
    pub fn output(&self) -> Option<MemberId> {
        self.output
    }

    /// Where power enters and leaves in a state when driving: as it says itself, else as the train does. Without a state,
    /// those of the train.
    ///
    /// # Panics
    /// If there is no state at that position.
    ///
    /// ```
    /// use willis::train::Train;
    ///
    /// let text = "format = 1\nname = \"pair\"\nmembers = [\"a\", \"b\"]\nterminals = [\"a\", \"b\"]\n\
    ///             [[mesh]]\ngears = [{ member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 }]\n";
    /// let train = Train::from_toml(text)?;
    /// assert_eq!(train.ends(None), [train.input(), train.output()]);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    pub fn ends(&self, state: Option<usize>) -> [Option<MemberId>; 2] {
        let own = state.map(|k| &self.states[k]);
        [own.and_then(|s| s.input).or(self.input), own.and_then(|s| s.output).or(self.output)]
    }

    /// Sweeps that the file describes.
    pub fn studies(&self) -> &[StudySpec] {
        &self.studies
    }

    /// Warnings about the train itself: assembly conditions, nominal planets, loose members.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// What stands in for data that were not given.
    pub fn assumptions(&self) -> &[String] {
        &self.assumptions
    }

    /// The oil and how it gets around.
    pub fn lubrication(&self) -> Option<&Lubrication> {
        self.lubrication.as_ref()
    }

    /// The laws in force.
    pub fn laws(&self) -> &Laws {
        &self.laws
    }

    /// What surrounds the gears.
    pub fn housing(&self) -> Housing {
        self.housing
    }

    /// Every rolling bearing.
    pub fn bearings(&self) -> &[BearingMount] {
        &self.bearings
    }

    /// Every lip seal.
    pub fn seals(&self) -> &[SealMount] {
        &self.seals
    }

    /// Every oil pump.
    pub fn pumps(&self) -> &[Pump] {
        &self.pumps
    }

    /// Every carrier or drum that drags the fluid around it.
    pub fn rotors(&self) -> &[Rotor] {
        &self.rotors
    }

    /// Planets whose orbit is known.
    pub fn planets(&self) -> &[PlanetBody] {
        &self.planets
    }

    /// Every moment of inertia.
    pub fn inertias(&self) -> &[Inertia] {
        &self.inertias
    }

    /// Friction that does not depend on tooth loads.
    pub fn drags(&self) -> &[DragMount] {
        &self.drags
    }

    /// Every elastic shaft.
    pub fn shafts(&self) -> &[Shaft] {
        &self.shafts
    }

    /// Loss tables of meshes.
    pub fn loss_tables(&self) -> &[LossTable] {
        &self.loss_tables
    }

    /// The motions of the file.
    pub fn scenarios(&self) -> &[Scenario] {
        &self.scenarios
    }

    /// The motion of that name.
    pub fn scenario(&self, name: &str) -> Option<&Scenario> {
        self.scenarios.iter().find(|s| s.name == name)
    }

    /// Second paths of power splits.
    pub fn variators(&self) -> &[Variator] {
        &self.variators
    }

    /// What carries the heat of the losses away.
    pub fn heat(&self) -> Option<&heat::Heat> {
        self.heat.as_ref()
    }

    /// Whether operating points have losses beside those of given mesh efficiencies: computed ones, or given drags.
    pub fn is_physical(&self) -> bool {
        self.has_laws()
            || !(self.drags.is_empty() && self.pumps.is_empty())
            || self.shift_elements.iter().any(|e| e.open.is_some())
            || self.meshes.iter().any(|m| m.teeth.as_ref().is_some_and(|t| t.jet.is_some()))
    }

    /// Whether an operating point knows of a member: it is a gear, a carrier, a terminal, or joined to one by a shift
    /// element or a variator. What hangs on an elastic shaft alone is a matter of motion.
    pub(crate) fn is_within(&self, member: MemberId) -> bool {
        let at = |m: MemberId| m == member;
        member == FRAME
            || self.meshes.iter().any(|m| at(m.carrier) || m.gears.iter().any(|g| at(g.member)))
            || self.shift_elements.iter().any(|e| e.members.iter().any(|m| at(*m)))
            || self.variators.iter().any(|v| v.members().iter().any(|m| at(*m)))
            || self.joints.iter().flatten().any(|m| at(*m))
            || self.terminals.iter().any(|m| at(*m))
    }

    /// Whether laws compute losses at operating points.
    pub(crate) fn has_laws(&self) -> bool {
        self.meshes.iter().any(|m| m.computed)
            || !(self.bearings.is_empty() && self.seals.is_empty() && self.rotors.is_empty())
            || self.lubrication.as_ref().is_some_and(|l| l.supply.is_some())
                && self.meshes.iter().any(|m| m.teeth.is_some())
    }

    /// Whether losses and torques of operating points must be brought into agreement: losses are computed, or those of a
    /// variator depend on its load.
    pub(crate) fn depends_on_load(&self) -> bool {
        self.is_physical() || self.variators.iter().any(Variator::is_computed)
    }

    /// The train with its nominal efficiencies only.
    pub(crate) fn without_laws(&self) -> Self {
        let mut plain = self.clone();
        plain.meshes.iter_mut().for_each(|m| m.computed = false);
        plain.bearings.clear();
        plain.seals.clear();
        plain.rotors.clear();
        plain.drags.clear();
        plain.pumps.clear();
        plain.shift_elements.iter_mut().for_each(|e| e.open = None);
        plain.lubrication = None;
        plain
    }

    /// The law of a family that this train uses.
    pub(crate) fn law_in_force(&self, family: &str) -> Option<&'static str> {
        let friction = self.laws.mesh_friction(self.lubrication.is_some());
        match family {
            "mesh_friction" => Some(friction.meta().id),
            "rolling" => self.laws.rolling(&friction).map(|r| r.meta().id),
            _ => {
                let own = crate::losses::entries().into_iter().filter(|e| e.family == family);
                let is_in_force = |id: &str| {
                    let mut laws = self.laws;
                    laws.choose(family, id).is_ok() && laws == self.laws
                };
                own.map(|e| e.id).find(|id| is_in_force(id))
            }
        }
    }

    /// The same train with another law in one family.
    ///
    /// # Errors
    /// If there is no such family or law, or if teeth are computed and the law needs an oil that the
    /// train does not have.
    pub fn with_law(mut self, family: &str, law: &str) -> Result<Self, Diagnostics> {
        self.set_law(family, law)?;
        Ok(self)
    }

    /// The same in place: nothing else changes.
    pub(crate) fn set_law(&mut self, family: &str, law: &str) -> Result<(), Diagnostics> {
        self.laws.choose(family, law).map_err(|d| [*d].into_iter().collect::<Diagnostics>())?;
        let dry = self.lubrication.is_none() && self.meshes.iter().any(|m| m.computed);
        self.laws.without_oil().filter(|_| dry).map_or(Ok(()), |d| Err([d].into_iter().collect()))
    }

    /// The train alone, without what its file asks of it.
    pub(crate) fn without_questions(self) -> Self {
        Self { operations: vec![], scenarios: vec![], studies: vec![], ..self }
    }

    /// The member of that name.
    pub fn member(&self, name: &str) -> Option<MemberId> {
        self.members.iter().position(|m| m.name == name).map(MemberId)
    }

    /// The name of a member.
    pub fn member_name(&self, id: MemberId) -> &str {
        &self.members[id.0].name
    }

    /// The mesh of that name.
    pub fn mesh(&self, name: &str) -> Option<MeshId> {
        self.meshes.iter().position(|m| m.name == name).map(MeshId)
    }

    /// The state of that name.
    pub fn state(&self, name: &str) -> Option<&State> {
        self.states.iter().find(|s| s.name == name)
    }
}
