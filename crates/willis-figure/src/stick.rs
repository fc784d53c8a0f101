//! The kinematic schematic (stick diagram): the train as transmission textbooks draw it.
//!
//! Each planet carrier with its planets is a *block* of a few columns: sun below, planets, ring
//! above, seen as half section above the axis. A member is a *net* that joins its gears, webs, shift
//! elements and its terminal by lines on a grid. Blocks are ordered and nets routed so that few
//! lines of different members cross; they never run along each other.
//!
//! Source of the symbols: VDI 2157 (planetary gear trains: terms, symbols) and the schematics that
//! transmission makers print.

pub mod draw;
mod blocks;
mod drawing;
mod grid;
mod layout;
mod load;
mod members;
mod shapes;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::train::Train;

use crate::kind::{self, Ask, Kind};

pub(crate) const KIND: Kind<Stick> = Kind {
    title: "Kinematic schematic",
    takes: &[Ask::State],
    effort: kind::of_file,
    applies: None,
    make: |s, r| stick(s.train(), r.state.as_deref()),
    steps: None,
    draw: draw::draw_on,
};

/// A point of the picture: x along the axis, y outward; the unit is a step of the grid.
pub type Place = [f64; 2];

/// The schematic of a train, perhaps in a state of its shift table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Stick {
    /// Name of the train.
    pub title: String,
    /// The state whose closed elements and power path are shown.
    pub state: Option<String>,
    /// Names of all states, in the order of the shift table.
    pub states: Vec<String>,
    /// Width of the grid: every x is from 0 to this.
    pub width: f64,
    /// Height of the grid: every y is from 0 to this.
    pub height: f64,
    /// Heights of the centre lines, the lowest first; ordinary gear pairs stand between two of them.
    pub axes: Vec<f64>,
    /// The blocks: planets on one carrier with their gears, or one ordinary pair.
    pub blocks: Vec<StickBlock>,
    /// Every member but the frame, planets included.
    pub members: Vec<StickMember>,
    /// Every gear.
    pub gears: Vec<StickGear>,
    /// Every tooth contact.
    pub meshes: Vec<StickMesh>,
    /// Clutches, brakes, one-way clutches and elastic shafts.
    pub joints: Vec<StickJoint>,
    /// Where something is fixed to the frame.
    pub grounds: Vec<StickGround>,
    /// Where members leave the picture.
    pub terminals: Vec<StickTerminal>,
    /// Pins and webs of carriers that belong to the frame.
    pub frame: Vec<Vec<Place>>,
    /// Where lines of two members cross without touching.
    pub crossings: Vec<Place>,
}

/// Planets on one carrier with their gears, or one ordinary pair.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StickBlock {
    /// Name of the set, or of the first mesh.
    pub name: String,
    /// Least and greatest x.
    pub span: [f64; 2],
    /// The highest y of its gears.
    pub top: f64,
}

/// A member and its lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StickMember {
    /// Its name.
    pub name: String,
    /// Number of its colour: its place among the members of the train.
    #[serde(default)]
    pub colour: usize,
    /// A planet: its gears stand on a pin of a carrier.
    pub planet: bool,
    /// The blocks whose planets it carries, positions in [`Stick::blocks`].
    pub carries: Vec<usize>,
    /// Its lines; of a stepped planet what joins its steps, along the pin.
    pub pieces: Vec<StickPiece>,
    /// Where three or more of its lines meet.
    pub dots: Vec<Place>,
    /// It carries power in the state: unit torque at the input, no losses, driving. Absent where statics
    /// cannot say, or where no state is shown.
    pub loaded: Option<bool>,
    /// Its speed over that of the input in the state, where defined.
    pub speed_ratio: Option<f64>,
    /// The same as an exact fraction.
    pub exact_speed_ratio: Option<String>,
}

/// A line of a member, between two of its branches or ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StickPiece {
    /// Corners, the ends included.
    pub points: Vec<Place>,
    /// The power of the state passes it.
    pub loaded: bool,
    /// Power from its first corner to its last, over that of the input, lossless; negative where it runs the other way,
    /// absent where statics does not settle it or no state is shown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub power: Option<f64>,
    /// That power is part of a circle from set to set.
    #[serde(default)]
    pub circulates: bool,
}

/// What a gear is in its block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum GearRole {
    /// A central external gear.
    Sun,
    /// Its axis moves with the carrier.
    Planet,
    /// An internal gear.
    Ring,
    /// A central bevel gear.
    Side,
    /// A gear of an ordinary pair.
    Wheel,
}

/// A gear: its body and the lines of its teeth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StickGear {
    /// Position in [`Stick::members`]; absent for the frame.
    pub member: Option<usize>,
    /// Position in [`Stick::blocks`].
    pub block: usize,
    /// Number of teeth; empty where the file does not give it and no whole number follows from the others.
    pub teeth: String,
    /// What it is.
    pub role: GearRole,
    /// Lines from its hub (or pin) to its teeth.
    pub stems: Vec<[Place; 2]>,
    /// Lines of teeth.
    pub faces: Vec<[Place; 2]>,
    /// It carries power in the state.
    pub loaded: bool,
}

/// A tooth contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StickMesh {
    /// Its name.
    pub name: String,
    /// The two gears, positions in [`Stick::gears`].
    pub gears: [usize; 2],
    /// Where they touch.
    pub at: Place,
    /// A bevel pair.
    pub bevel: bool,
}

/// What joins two members, or a member and the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum JointKind {
    /// A clutch.
    Clutch,
    /// A brake.
    Brake,
    /// A one-way clutch between two members, or a member and the frame.
    OneWay,
    /// An elastic shaft.
    Shaft,
}

/// A shift element, or an elastic shaft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StickJoint {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: JointKind,
    /// The two members; absent for the frame.
    pub members: [Option<usize>; 2],
    /// The ends of its symbol: the first on the first member, the second on the second one.
    pub ends: [Place; 2],
    /// Closed in the state.
    pub engaged: bool,
    /// It carries power in the state.
    pub loaded: bool,
}

/// A mark of the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StickGround {
    /// Where the frame begins.
    pub at: Place,
    /// The direction into the frame.
    pub into: [i8; 2],
}

/// Direction of power at a terminal, driving.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
// The schema keeps the name that is published.
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Way"))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum TerminalDirection {
    /// Power enters.
    In,
    /// Power leaves.
    Out,
}

/// The end of a member at the border.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StickTerminal {
    /// The member.
    pub member: usize,
    /// Where it leaves.
    pub at: Place,
    /// At the left border; else the right one.
    pub left: bool,
    /// The direction of power, where the state or the train says it.
    pub way: Option<TerminalDirection>,
    /// An external torque may act here; else the line only names a member that has no gear.
    pub open: bool,
}

/// The schematic of a train; with a state also what is closed and loaded in it.
///
/// A train without states is shown as drawn, with the power from its input to its output.
///
/// # Errors
/// An unknown state, and a train without any member to draw.
///
/// # Example
/// ```
/// use willis_figure::stick;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4))
///     .build()?;
/// let picture = stick(&train, None)?;
/// assert_eq!((picture.gears.len(), picture.meshes.len(), picture.crossings.len()), (3, 2, 0));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn stick(train: &Train, state: Option<&str>) -> Result<Stick, Diagnostics> {
    // A state that there is not takes no layout.
    state.map(|name| train.find_state(name)).transpose()?;
    StickLayout::new(train)?.show(train, state)
}

/// Where everything of a stick diagram stands, whatever the state: laid out once, it shows every state in the same place.
///
/// ```
/// use willis_figure::StickLayout;
/// use willis::train::{SetSpec, ShiftElementSpec, StateSpec, Train};
///
/// let train = Train::builder("two speeds")
///     .members(["s", "r", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4))
///     .shift_element(ShiftElementSpec::brake("B", "r"))
///     .shift_element(ShiftElementSpec::clutch("C", "s", "c"))
///     .state(StateSpec::new("low", ["B"]))
///     .state(StateSpec::new("direct", ["C"]))
///     .build()?;
/// let layout = StickLayout::new(&train)?;
/// let [low, direct] = ["low", "direct"].map(|state| layout.show(&train, Some(state)).unwrap());
/// assert!(low.gears.iter().zip(&direct.gears).all(|(a, b)| a.faces == b.faces));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub struct StickLayout {
    members: members::Members,
    plan: blocks::Plan,
    layout: layout::Layout,
}

impl StickLayout {
    /// Lays out a train.
    ///
    /// # Errors
    /// A train without any member to draw, or one whose lines find no way past each other.
    pub fn new(train: &Train) -> Result<Self, Diagnostics> {
        let (members, plan, layout) = laid_out(train)?;
        Ok(Self { members, plan, layout })
    }

    /// The schematic of the train in a state: what is closed, loaded, and how fast it turns. The train must be the one that was
    /// laid out, perhaps with other numbers.
    ///
    /// # Errors
    /// An unknown state.
    pub fn show(&self, train: &Train, state: Option<&str>) -> Result<Stick, Diagnostics> {
        let shown = state.map(|name| train.find_state(name)).transpose()?;
        let plan = self.plan.in_state(train, &self.members, shown);
        let load = load::Load::new(train, shown);
        Ok(drawing::Drawing::new(train, &self.members, &plan, self.layout.clone(), &load).stick(shown))
    }
}

fn laid_out(train: &Train) -> Result<(members::Members, blocks::Plan, layout::Layout), Diagnostics> {
    let wrong = |d: Diagnostic| Err([d].into_iter().collect::<Diagnostics>());
    let members = members::Members::new(train);
    if members.order.is_empty() {
        let d = Diagnostic::new(Code::Unfit, "", "no stick diagram: the train has no member beside the frame");
        return wrong(d.hint("name its rotors in `members`, and give them gears"));
    }
    let plan = blocks::Plan::new(train, &members);
    let Some(best) = layout::best(&plan) else {
        let d = Diagnostic::new(Code::Unfit, "", "no stick diagram: its lines find no way past each other");
        return wrong(d.hint("draw a part of the train"));
    };
    Ok((members, plan, best))
}
