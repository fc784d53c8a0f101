//! Where the power runs in an operating point, as a graph: components, the contacts between them,
//! and the power that passes each.
//!
//! A *component* is a rotor. A *contact* joins components: teeth (a gear, another gear and their
//! carrier), a bearing, a seal, a gear or drum in its fluid, a closed clutch or brake. A contact with three
//! components is a hyperedge; it is written here as a node, with an edge to each component. The
//! edge carries the absolute power `τ ω`: torque that the component puts into the contact times the
//! component's own speed. It points the way the power runs. The frame stands still, so what leans
//! on it carries torque and no power.
//!
//! In every node power in less power out less loss is zero, up to round-off; the remainder is
//! printed. Bearing friction that grows with the load of the teeth is part of a mesh's efficiency
//! while the train is solved ([operating point](crate::operating_point)); here it stands at the
//! bearing, as a torque between the bearing's two members, and the torques of the mesh are less by
//! that much.
//!
//! *Paths*: at each component and contact what enters mixes and leaves in proportion. A path from an
//! input to an output then has a share of the input power (its part at each fork, multiplied) and
//! an efficiency (that of each node on it, multiplied), and
//!
//! ```text
//! Σ share × efficiency = output power / input power
//! ```
//!
//! over all paths, exactly. Shares add up to less than one by what runs into bearings and seals that pass
//! nothing on. *Loops*, power that runs in circles, are taken out first; an efficiency on a
//! path is that of the power that is left, and so below that of the contact as a whole.
//!
//! *Seen from a member*, such as a carrier, every speed is less by that of the member, and so is that of the frame, which now
//! turns and takes and gives power like any component: `τ (ω - ω₀)`. Torques that meet in a node add to zero, so balances and
//! losses stay as they are; circles within a set appear or vanish, what enters and leaves changes with what holds the frame.
//!
//! Source: the hypergraph of Wang et al., Appl. Sci. 2020, 10, 5849, with torques that balance.

use std::collections::{BTreeMap, BinaryHeap};

use serde::{Deserialize, Serialize};

use crate::analysis::{
    Analysis, LawBand, OperationReport, OutsideLaw, Role, Selection, SolutionReport, UnitPoint, Verdict, analyze,
    assumptions, law_band,
};
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::operating_point::DragSource;
use crate::power_flow::{families, take_out_cycles};
use crate::train::{FRAME, MemberId, MemberKind, Train};

/// How the name of an end begins that is the store of a variator.
pub const STORE: &str = "store";

/// Most paths that are listed, those that deliver most first.
pub const MOST_PATHS: usize = 32;
/// Powers below this part of the largest are round-off.
const ROUND_OFF: f64 = 1e-12;
/// Loops below this part of the input are not told.
const SMALLEST_LOOP: f64 = 1e-9;

/// What a node of the graph is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NodeKind {
    /// The frame: takes torques, never power.
    Frame,
    /// A component: a rotor.
    Member,
    /// A tooth contact, all its pairs in parallel together.
    Teeth,
    /// Rolling bearings.
    Bearing,
    /// Lip seals.
    Seal,
    /// A gear in oil or air.
    Gear,
    /// A carrier or drum in oil or air.
    Rotor,
    /// A drag that is given as a torque.
    Drag,
    /// An open clutch or brake that drags.
    OpenElement,
    /// An oil pump.
    Pump,
    /// A closed clutch or brake, or several that share one load.
    ShiftElement,
    /// A shaft that is for good coupled with a member: a terminal with a name of its own.
    Coupling,
    /// A variator: electric machines, pump and motor, belt.
    Variator,
    /// Where external power enters.
    Input,
    /// Where external power leaves.
    Output,
}

/// A component, a contact, or an end of the graph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Node {
    /// Unique: kind and name, as in `member:sun`, `teeth:P1.sun-planet`, `input:sun`; or `frame`.
    pub id: String,
    /// What it is.
    pub kind: NodeKind,
    /// Its name in the train.
    pub name: String,
    /// Speed of a component, rad/s; absent when not determined.
    pub speed_rad_s: Option<f64>,
    /// Identical ones in parallel: tooth pairs, bearings.
    pub count: u32,
    /// Power that enters, W.
    pub power_in_w: f64,
    /// Power that leaves, W.
    pub power_out_w: f64,
    /// Loss in it, W.
    pub loss_w: f64,
    /// Outgoing over incoming absolute power; absent where none passes.
    pub efficiency: Option<f64>,
    /// Of a tooth contact: efficiency of sliding seen from the carrier.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub carrier_frame_efficiency: Option<f64>,
    /// Power in less power out less loss, W: round-off.
    pub residual_w: f64,
}

/// Power, or only torque, between two nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Edge {
    /// The node that the power leaves.
    pub from: String,
    /// The node that it enters.
    pub to: String,
    /// The component at one end, whose speed times the torque is the power.
    pub member: String,
    /// Torque that the component puts into the contact (at an input or output: external torque on
    /// the component), N m; absent where statics cannot divide it.
    pub torque_n_m: Option<f64>,
    /// Power, W; 0 where the component stands still.
    pub power_w: f64,
    /// The part of it that runs in loops, W.
    pub circulating_w: f64,
}

/// Power that runs in a circle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Loop {
    /// The power, W.
    pub power_w: f64,
    /// Over the input power.
    pub share_of_input: f64,
    /// Identifiers of the nodes it passes, in order; from the last it returns to the first.
    pub nodes: Vec<String>,
    /// The same seen from afar: names of shafts, sets and clutches.
    pub passes: Vec<String>,
    /// The set, or ordinary pair, that it never leaves; or the sets it passes although none of them
    /// takes part in a circle as a whole ([`SolutionReport::recirculation`], which counts set by set). Such a
    /// loop depends on the frame in which powers are counted, not on how the train is coupled.
    pub within: Option<String>,
}

/// A node on a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Station {
    /// Identifier of the node.
    pub node: String,
    /// Its efficiency for the power on paths: out over in, loops taken out; 1 for a component.
    pub efficiency: f64,
}

/// A way from an input to an output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
// The schema keeps the name that is published.
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Path"))]
#[non_exhaustive]
pub struct PowerPath {
    /// Part of the input power that takes it.
    pub share_of_input: f64,
    /// Product of the efficiencies along it.
    pub efficiency: f64,
    /// What arrives, W.
    pub delivered_w: f64,
    /// The nodes along it, input and output included.
    pub stations: Vec<Station>,
}

/// The power flow of one equilibrium.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Hypergraph {
    /// The member from which speeds and powers are seen; absent where that is the housing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seen_from: Option<String>,
    /// Output over input power; 0 when everything is dissipated, absent when nothing is loaded.
    pub efficiency: Option<f64>,
    /// The efficiency exactly, where [`SolutionReport::efficiency_exact`] is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_exact: Option<Rational>,
    /// Power in, W.
    pub input_power_w: f64,
    /// Power out, W.
    pub output_power_w: f64,
    /// All losses, W.
    pub loss_w: f64,
    /// Input less output less losses, W.
    pub power_residual_w: f64,
    /// The largest residual of a node, W.
    pub largest_residual_w: f64,
    /// Frame, components, contacts, inputs and outputs.
    pub nodes: Vec<Node>,
    /// Powers between them.
    pub edges: Vec<Edge>,
    /// Power that runs in circles, largest first.
    pub loops: Vec<Loop>,
    /// Ways from inputs to outputs, those that deliver most first, at most [`MOST_PATHS`].
    pub paths: Vec<PowerPath>,
    /// How many there are.
    pub path_count: u64,
    /// Part of the input power that takes any of them; the rest is lost on its way where nothing is passed on.
    pub share_on_paths: f64,
}

/// The power flow of an operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OperationFlow {
    /// Its name.
    pub name: String,
    /// The state of the shift table.
    pub state: Option<String>,
    /// Where no operation describes the state: the member whose speed and torque are the units, 1 rad/s and 1 N m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// What can be said of it.
    pub verdict: Verdict,
    /// One sentence that explains the verdict.
    pub reason: Option<String>,
    /// Between which values other laws put the efficiency, where [`FlowReport::with_bands`] asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Box<LawBand>>,
    /// Laws that were used outside their ranges.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside_laws: Vec<OutsideLaw>,
    /// Every equilibrium.
    pub solutions: Vec<Hypergraph>,
    /// Of a locked train: equilibria in which every loaded member must push.
    pub dissipative_solutions: Vec<Hypergraph>,
}

/// Power flows of a train: the results contract `willis-flow-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FlowReport {
    /// `willis-flow-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// Source of its data.
    pub source: Option<String>,
    /// The operating points.
    pub operations: Vec<OperationFlow>,
    /// What stands in for data that were not given, and what the model leaves out.
    pub assumptions: Vec<String>,
    /// Warnings and notes.
    pub diagnostics: Vec<Diagnostic>,
}

impl FlowReport {
    /// The same with what other laws of loss make of every efficiency that laws compute: [`OperationFlow::band`].
    ///
    /// # Example
    /// ```
    /// use willis::Selection;
    /// use willis::hypergraph::flows_seen_from;
    /// use willis::train::Train;
    ///
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "one set"
    ///     members = ["s", "c"]
    ///     terminals = ["s", "c"]
    ///     [oil]
    ///     name = "ISO VG 220"
    ///     temperature = "70 degC"
    ///     [[set]]
    ///     name = "P1"
    ///     sun = { member = "s", teeth = 30 }
    ///     planet = { teeth = 20, count = 4 }
    ///     ring = { member = "frame", teeth = 70 }
    ///     carrier = "c"
    ///     geometry = { module = "2 mm", width = "25 mm", roughness = "0.4 um" }
    ///     [[operation]]
    ///     name = "full load"
    ///     speeds = { s = "1000 rpm" }
    ///     torques = { s = "200 N m" }
    /// "#)?;
    /// let report = flows_seen_from(&train, &Selection::default(), None)?.with_bands(&train);
    /// assert!(report.operations[0].band.is_some());
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn with_bands(mut self, train: &Train) -> Self {
        for flow in self.operations.iter_mut().filter(|flow| flow.unit.is_none()) {
            let operation = train.find_operation(&flow.name).ok();
            flow.band = operation.and_then(|o| law_band(train, o)).map(Box::new);
        }
        self
    }

    /// The report of power flows that were made from an analysis with [`flow_of`].
    pub fn of(analysis: &Analysis, operations: Vec<OperationFlow>) -> Self {
        Self {
            format: Format::new(),
            train: analysis.train.clone(),
            source: analysis.source.clone(),
            operations,
            assumptions: analysis.assumptions.clone(),
            diagnostics: analysis.diagnostics.clone(),
        }
    }
}

impl Contract for FlowReport {
    const FORMAT: &'static str = "willis-flow-1";
}

/// The power flow of every operating point, or of one. A state that no operation describes is shown with the speed and the
/// torque of its input as units; so is every state of a train without operations.
///
/// # Errors
/// What [`analyze`] refuses; a state without an operation that the speed of its input does not settle.
///
/// # Example
/// ```
/// use willis::analysis::Selection;
/// use willis::hypergraph::flows;
/// use willis::train::{OperationSpec, SetSpec, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .operation(
///         OperationSpec::new("full load")
///             .speed("s", AngularSpeed::rpm(1000.0))
///             .torque("s", Torque::n_m(10.0)),
///     )
///     .build()?;
/// let flow = &flows(&train, &Selection::default())?.operations[0].solutions[0];
/// assert!(flow.largest_residual_w < 1e-9);
/// // The carrier takes its share from both tooth contacts.
/// let into_carrier: Vec<_> = flow.edges.iter().filter(|e| e.to == "member:c").map(|e| e.from.as_str()).collect();
/// assert_eq!(into_carrier, ["teeth:P1.sun-planet", "teeth:P1.planet-ring"]);
/// // Shares and efficiencies of the paths make the efficiency of the train.
/// let sum: f64 = flow.paths.iter().map(|p| p.share_of_input * p.efficiency).sum();
/// assert!((sum - flow.efficiency.unwrap()).abs() < 1e-12);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn flows(train: &Train, selection: &Selection) -> Result<FlowReport, Diagnostics> {
    flows_seen_from(train, selection, None)
}

/// The same with speeds and powers as they are seen from a member, such as a carrier; without one from the frame, as [`flows`].
///
/// # Errors
/// What [`flows`] refuses; there is no such member; its speed is not determined.
///
/// # Example
/// ```
/// use willis::analysis::Selection;
/// use willis::hypergraph::{flows, flows_seen_from};
/// use willis::train::{OperationSpec, SetSpec, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .operation(
///         OperationSpec::new("full load")
///             .speed("s", AngularSpeed::rpm(1000.0))
///             .torque("s", Torque::n_m(10.0)),
///     )
///     .build()?;
/// let of = |seen_from| flows_seen_from(&train, &Selection::default(), seen_from);
/// let from_carrier = of(Some("c"))?;
/// let graph = &from_carrier.operations[0].solutions[0];
/// // The carrier rests, and the ring, which the housing holds, takes what the sun gives: 0.7 of the power, less the loss.
/// assert!((graph.input_power_w - 0.7 * 1000.0 * std::f64::consts::PI / 30.0 * 10.0).abs() < 1e-9);
/// assert!((graph.efficiency.unwrap() - 0.99 * 0.99).abs() < 1e-12);
/// assert_eq!(graph.loss_w, flows(&train, &Selection::default())?.operations[0].solutions[0].loss_w);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn flows_seen_from(
    train: &Train,
    selection: &Selection,
    seen_from: Option<&str>,
) -> Result<FlowReport, Diagnostics> {
    let place = place(train, seen_from)?;
    let analysis = analyze(train, selection)?;
    let operations = analysis.operations.iter().map(|o| flow(train, o, place)).collect::<Result<_, _>>()?;
    let mut report = FlowReport::of(&analysis, operations);
    if report.operations.is_empty() {
        report.operations = per_unit(train, selection, place)?;
        if train.is_physical() {
            report.assumptions = assumptions(&train.without_laws());
            let nominal = "without an operating point teeth lose what a nominal coefficient of friction says, and bearings, \
                           oil and seals nothing";
            report.assumptions.push(nominal.to_owned());
        }
    }
    Ok(report)
}

/// The power flow of an operating point that is analyzed already, as it is seen from a member, else from the frame.
///
/// # Errors
/// There is no such member; its speed is not determined.
pub fn flow_of(train: &Train, o: &OperationReport, seen_from: Option<&str>) -> Result<OperationFlow, Diagnostics> {
    flow(train, o, place(train, seen_from)?)
}

/// From where a flow is seen.
fn place(train: &Train, seen_from: Option<&str>) -> Result<MemberId, Diagnostics> {
    Ok(seen_from.map_or(Ok(FRAME), |name| train.find_member(name))?)
}

fn flow(train: &Train, o: &OperationReport, seen_from: MemberId) -> Result<OperationFlow, Diagnostics> {
    let graphs = |all: &[SolutionReport]| all.iter().map(|s| graph(train, s, seen_from)).collect::<Result<_, _>>();
    Ok(OperationFlow {
        name: o.name.clone(),
        state: o.state.clone(),
        unit: None,
        verdict: o.verdict,
        reason: o.reason.clone(),
        band: o.band.clone(),
        outside_laws: o.outside_laws.clone(),
        solutions: graphs(&o.solutions)?,
        dissipative_solutions: graphs(&o.dissipative_solutions)?,
    })
}

/// The state that is selected, else every one, per unit of speed and torque at its input.
fn per_unit(train: &Train, selection: &Selection, seen_from: MemberId) -> Result<Vec<OperationFlow>, Diagnostics> {
    let of = |state: Option<usize>| -> Result<OperationFlow, Diagnostics> {
        let point = UnitPoint::new(train, state)?;
        let mut flow = flow(&point.train, &point.report, seen_from)?;
        flow.unit = Some(train.member_name(point.input).to_owned());
        // Nominal efficiencies are rounded.
        if train.meshes.iter().any(|m| m.computed) {
            flow.solutions.iter_mut().for_each(|g| g.efficiency_exact = None);
        }
        Ok(flow)
    };
    if let Some(name) = &selection.state {
        return Ok(vec![of(Some(train.find_state(name)?))?]);
    }
    if train.states.is_empty() {
        return Ok(vec![of(None)?]);
    }
    // Of all states those that make no question say why; if none does, that is the answer.
    let (mut all, mut first) = (Vec::new(), None);
    for (k, state) in train.states.iter().enumerate() {
        match of(Some(k)) {
            Ok(flow) => all.push(flow),
            Err(why) => {
                let reason = why.iter().next().map(|d| d.message.clone());
                let (name, state) = (state.name.clone(), Some(state.name.clone()));
                let verdict = Verdict::Undetermined;
                let (solutions, dissipative_solutions) = (vec![], vec![]);
                let (band, outside_laws) = (None, vec![]);
                all.push(OperationFlow {
                    name,
                    state,
                    unit: None,
                    verdict,
                    reason,
                    band,
                    outside_laws,
                    solutions,
                    dissipative_solutions,
                });
                first.get_or_insert(why);
            }
        }
    }
    match first {
        Some(why) if all.iter().all(|flow| flow.unit.is_none()) => Err(why),
        _ => Ok(all),
    }
}

/// A graph while it is built: torques of components in contacts.
struct Sketch<'t> {
    train: &'t Train,
    nodes: Vec<Node>,
    /// Speed by member as it is seen, rad/s; 0 where not determined, since nothing flows there.
    speeds: Vec<f64>,
    /// Whether the frame moves, as it is seen.
    moving: bool,
    /// By contact and member: the torque that the member puts in.
    torques: BTreeMap<(usize, usize), Option<f64>>,
}

impl Sketch<'_> {
    /// The node of that kind and name.
    fn node(&mut self, kind: NodeKind, name: &str, count: u32) -> usize {
        let word = match kind {
            NodeKind::Frame => "frame",
            NodeKind::Member => "member",
            NodeKind::Teeth => "teeth",
            NodeKind::Bearing => "bearing",
            NodeKind::Seal => "seal",
            NodeKind::Gear => "gear",
            NodeKind::Rotor => "rotor",
            NodeKind::Drag => "drag",
            NodeKind::OpenElement => "open-element",
            NodeKind::Pump => "pump",
            NodeKind::ShiftElement => "shift-element",
            NodeKind::Coupling => "coupling",
            NodeKind::Variator => "variator",
            NodeKind::Input => "input",
            NodeKind::Output => "output",
        };
        let id = if kind == NodeKind::Frame { word.to_owned() } else { format!("{word}:{name}") };
        if let Some(k) = self.nodes.iter().position(|n| n.id == id) {
            return k;
        }
        self.nodes.push(Node {
            id,
            kind,
            name: name.to_owned(),
            speed_rad_s: None,
            count,
            power_in_w: 0.0,
            power_out_w: 0.0,
            loss_w: 0.0,
            efficiency: None,
            carrier_frame_efficiency: None,
            residual_w: 0.0,
        });
        self.nodes.len() - 1
    }

    fn add(&mut self, contact: usize, member: usize, torque: f64) {
        if let Some(t) = self.torques.entry((contact, member)).or_insert(Some(0.0)) {
            *t += torque;
        }
    }

    fn index(&self, name: &str) -> usize {
        self.train.member(name).map_or(0, MemberId::index)
    }

    /// Torque that a member puts into all contacts so far.
    fn given(&self, member: usize) -> f64 {
        self.torques.iter().filter(|((_, m), _)| *m == member).filter_map(|(_, t)| *t).sum()
    }
}

/// The graph of one equilibrium of a train.
///
/// # Example
/// ```
/// use willis::analysis::{Selection, analyze};
/// use willis::hypergraph::{NodeKind, hypergraph};
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "ordinary pair"
///     members = ["a", "b"]
///     terminals = ["a", "b"]
///     [[mesh]]
///     name = "M"
///     gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 60 }]
///     efficiency = 0.98
///     [[operation]]
///     name = "1 kW"
///     speeds = { a = "1000 rpm" }
///     powers = { a = "1 kW" }
/// "#)?;
/// let analysis = analyze(&train, &Selection::default())?;
/// let graph = hypergraph(&train, &analysis.operations[0].solutions[0]);
/// let teeth = graph.nodes.iter().find(|n| n.kind == NodeKind::Teeth).unwrap();
/// assert!((teeth.loss_w - 20.0).abs() < 1e-9);
/// assert_eq!(graph.paths.len(), 1);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn hypergraph(train: &Train, solution: &SolutionReport) -> Hypergraph {
    seen(train, solution, 0.0)
}

/// The same as it is seen from a member.
fn graph(train: &Train, solution: &SolutionReport, seen_from: MemberId) -> Result<Hypergraph, Diagnostics> {
    if seen_from == FRAME {
        return Ok(hypergraph(train, solution));
    }
    let name = train.member_name(seen_from);
    let Some(speed) = solution.members.get(name).and_then(|m| m.speed_rad_s) else {
        let message = format!("powers cannot be seen from `{name}`: its speed is not determined");
        return Err(Diagnostic::new(Code::Unfit, "", message)
            .hint("count them from the housing, or give one more speed")
            .into());
    };
    Ok(Hypergraph { seen_from: Some(name.to_owned()), ..seen(train, solution, speed) })
}

/// The graph as it is seen by someone who turns at a speed.
fn seen(train: &Train, solution: &SolutionReport, own: f64) -> Hypergraph {
    let members = train.members().len();
    let moving = own != 0.0;
    let mut g = Sketch { train, nodes: Vec::new(), speeds: vec![0.0; members], moving, torques: BTreeMap::new() };
    // The frame is node 0, and a member's node has the member's number.
    g.node(NodeKind::Frame, &train.members()[0].name, 1);
    if moving {
        g.speeds[FRAME.index()] = -own;
        g.nodes[FRAME.index()].speed_rad_s = Some(-own);
    }
    for (name, m) in solution.members.iter() {
        let k = g.node(NodeKind::Member, name, 1);
        g.nodes[k].speed_rad_s = m.speed_rad_s.map(|w| if moving { w - own } else { w });
        g.speeds[k] = g.nodes[k].speed_rad_s.unwrap_or(0.0);
    }
    let mut contacts_of_mesh = vec![0; train.meshes().len()];
    for (j, mesh) in train.meshes().iter().enumerate() {
        let k = g.node(NodeKind::Teeth, &mesh.name, mesh.count);
        contacts_of_mesh[j] = k;
        let Some(m) = solution.meshes.get(&mesh.name) else { continue };
        let torques = [m.first_torque_n_m, m.second_torque_n_m, m.carrier_torque_n_m];
        for (member, torque) in [mesh.gears[0].member, mesh.gears[1].member, mesh.carrier].into_iter().zip(torques) {
            g.add(k, member.index(), torque);
        }
        g.nodes[k].loss_w = m.loss_w;
        g.nodes[k].carrier_frame_efficiency = m.driver.is_some().then_some(m.efficiency);
    }
    for d in &solution.drags {
        let kind = match d.source {
            DragSource::Rolling => NodeKind::Teeth,
            DragSource::Bearing => NodeKind::Bearing,
            DragSource::Seal => NodeKind::Seal,
            DragSource::Gear => NodeKind::Gear,
            DragSource::Rotor => NodeKind::Rotor,
            DragSource::Drag => NodeKind::Drag,
            DragSource::ShiftElement => NodeKind::OpenElement,
            DragSource::Injection => NodeKind::Teeth,
            DragSource::Pump => NodeKind::Pump,
        };
        let count = match kind {
            NodeKind::Bearing => solution.bearings.get(&d.name).map_or(1, |b| b.bearings),
            NodeKind::Seal => train.seals().iter().find(|s| s.name == d.name).map_or(1, |s| s.count),
            _ => 1,
        };
        let k = g.node(kind, &d.name, count);
        let [a, b] = d.members.each_ref().map(|name| g.index(name));
        // What pushes a member takes that torque out of the contact.
        g.add(k, a, -d.torque_n_m);
        g.add(k, b, d.torque_n_m);
        g.nodes[k].loss_w += d.loss_w;
        if let Some(mesh) = d.contained_in.as_deref().and_then(|name| train.mesh(name)) {
            let mesh = contacts_of_mesh[mesh.index()];
            g.add(mesh, a, d.torque_n_m);
            g.add(mesh, b, -d.torque_n_m);
        }
    }
    for (name, v) in solution.variators.iter() {
        let k = g.node(NodeKind::Variator, name, 1);
        for (_, m) in v.machines.iter() {
            let member = g.index(&m.member);
            g.add(k, member, -m.torque_n_m);
            // What its housing takes.
            if moving {
                g.add(k, FRAME.index(), m.torque_n_m);
            }
        }
        g.nodes[k].loss_w = v.loss_w;
    }
    let external = externals(&mut g, solution);
    shift_elements(&mut g, solution, &external);
    for [own, on] in &train.joints {
        let [own, on] = [own.index(), on.index()];
        let torque = external[own].map(|x| x - g.given(own));
        let k = g.node(NodeKind::Coupling, &train.members()[own].name, 1);
        g.torques.insert((k, own), torque);
        g.torques.insert((k, on), torque.map(|t| -t));
    }
    finish(g, solution, &external)
}

/// External torque on each member, without what brakes exert; `None` where that is not known.
fn externals(g: &mut Sketch<'_>, solution: &SolutionReport) -> Vec<Option<f64>> {
    let mut external: Vec<Option<f64>> = vec![Some(0.0); g.train.members().len()];
    for (name, m) in solution.members.iter() {
        external[g.index(name)] = m.torque_n_m;
    }
    for (_, e) in solution.shift_elements.iter() {
        let [a, b] = e.members.each_ref().map(|name| g.index(name));
        for (member, other, sign) in [(a, b, 1.0), (b, a, -1.0)] {
            if other == FRAME.index() {
                external[member] = match (external[member], e.torque_n_m) {
                    (Some(x), Some(t)) => Some(x - sign * t),
                    _ => None,
                };
            }
        }
    }
    external
}

/// Clutches and brakes; those whose torques statics cannot divide become one node.
fn shift_elements(g: &mut Sketch<'_>, solution: &SolutionReport, external: &[Option<f64>]) {
    let mut open: Vec<(Vec<&str>, Vec<usize>)> = Vec::new();
    for (name, e) in solution.shift_elements.iter() {
        let members = e.members.each_ref().map(|name| g.index(name));
        let Some(t) = e.torque_n_m else {
            let (mut names, mut ends) = (vec![name.as_str()], members.to_vec());
            let shares = |o: &(Vec<&str>, Vec<usize>)| o.1.iter().any(|m| *m != 0 && members.contains(m));
            while let Some(k) = open.iter().position(shares) {
                let (more, others) = open.remove(k);
                names.splice(0..0, more);
                ends.extend(others);
            }
            ends.sort_unstable();
            ends.dedup();
            open.push((names, ends));
            continue;
        };
        let k = g.node(NodeKind::ShiftElement, name, 1);
        g.add(k, members[0], -t);
        g.add(k, members[1], t);
    }
    for (names, ends) in open {
        let torques: Vec<Option<f64>> =
            ends.iter().map(|&m| external[m].filter(|_| m != FRAME.index()).map(|x| x - g.given(m))).collect();
        let k = g.node(NodeKind::ShiftElement, &names.join(", "), 1);
        // Together they put nothing in: the frame takes the rest.
        let rest =
            ends.iter().zip(&torques).filter(|(m, _)| **m != FRAME.index()).map(|(_, t)| *t).sum::<Option<f64>>();
        for (m, torque) in ends.into_iter().zip(torques) {
            let torque = if g.moving && m == FRAME.index() { rest.map(|t| -t) } else { torque };
            g.torques.insert((k, m), torque);
        }
    }
}

/// Edges, balances, loops and paths.
fn finish(mut g: Sketch<'_>, solution: &SolutionReport, external: &[Option<f64>]) -> Hypergraph {
    struct Line {
        from: usize,
        to: usize,
        member: usize,
        torque: Option<f64>,
        power: f64,
    }
    let members = external.len();
    let mut lines: Vec<Line> = Vec::new();
    let mut balance: Vec<f64> = vec![0.0; members];
    for (name, m) in solution.members.iter() {
        let member = g.index(name);
        let torque = external[member];
        let power = match g.moving {
            true => torque.unwrap_or(0.0) * g.speeds[member],
            false => m.power_w.unwrap_or(0.0),
        };
        balance[member] += power;
        let (from, to) = match m.role {
            Role::Input | Role::Output if g.moving && power > 0.0 => (g.node(NodeKind::Input, name, 1), member),
            Role::Input | Role::Output if g.moving => (member, g.node(NodeKind::Output, name, 1)),
            Role::Input => (g.node(NodeKind::Input, name, 1), member),
            Role::Output => (member, g.node(NodeKind::Output, name, 1)),
            // Something outside holds it.
            _ if power > 0.0 && g.moving => (FRAME.index(), member),
            _ => (member, FRAME.index()),
        };
        if g.moving && (from == FRAME.index() || to == FRAME.index()) {
            balance[FRAME.index()] -= power;
        }
        let power = if to == FRAME.index() && !g.moving { 0.0 } else { power.abs() };
        lines.push(Line { from, to, member, torque, power });
    }
    let stores = solution.variators.iter().filter_map(|(name, v)| Some((name, v.store_w.filter(|p| *p != 0.0)?)));
    let mut stored = Vec::new();
    for (name, power) in stores {
        let variator = g.node(NodeKind::Variator, name, 1);
        stored.push((variator, power));
        let store = match solution.variators.iter().filter(|(_, v)| v.store_w.is_some()).count() {
            1 => STORE.to_owned(),
            _ => format!("{STORE} of {name}"),
        };
        let (from, to) = match power > 0.0 {
            true => (g.node(NodeKind::Input, &store, 1), variator),
            false => (variator, g.node(NodeKind::Output, &store, 1)),
        };
        lines.push(Line { from, to, member: variator, torque: None, power: power.abs() });
    }
    balance.resize(g.nodes.len(), 0.0);
    stored.into_iter().for_each(|(variator, power)| balance[variator] += power);
    for (&(contact, member), &torque) in &g.torques {
        let power = torque.unwrap_or(0.0) * g.speeds[member];
        balance[member] -= power;
        balance[contact] += power;
        let leans = member == FRAME.index() && power <= 0.0;
        let (from, to) = if power < 0.0 || leans || (member == FRAME.index() && !g.moving) {
            (contact, member)
        } else {
            (member, contact)
        };
        lines.push(Line { from, to, member, torque, power: power.abs() });
    }
    if g.moving {
        // What holds the housing does work on it.
        let power = -balance[FRAME.index()];
        let torque = Some(power / g.speeds[FRAME.index()]);
        let name = g.train.members()[FRAME.index()].name.clone();
        let (from, to) = match power > 0.0 {
            true => (g.node(NodeKind::Input, &name, 1), FRAME.index()),
            false => (FRAME.index(), g.node(NodeKind::Output, &name, 1)),
        };
        balance.resize(g.nodes.len(), 0.0);
        lines.push(Line { from, to, member: FRAME.index(), torque, power: power.abs() });
    }
    let largest = lines.iter().fold(0.0f64, |a, l| a.max(l.power));
    let strongest = lines.iter().fold(0.0f64, |a, l| a.max(l.torque.unwrap_or(0.0).abs()));
    for l in &mut lines {
        if l.power <= ROUND_OFF * largest {
            l.power = 0.0;
        }
    }
    lines.retain(|l| l.power > 0.0 || l.torque.is_none_or(|t| t.abs() > ROUND_OFF * strongest));
    // Loads first, then as the train lists its contacts.
    lines.sort_by_key(|l| (g.nodes[l.from.max(l.to)].kind < NodeKind::Input, l.from.max(l.to), l.member));

    let mut residual = 0.0f64;
    for (k, node) in g.nodes.iter_mut().enumerate() {
        node.power_in_w = lines.iter().filter(|l| l.to == k).map(|l| l.power).sum::<f64>() + 0.0;
        node.power_out_w = lines.iter().filter(|l| l.from == k).map(|l| l.power).sum::<f64>() + 0.0;
        node.loss_w += 0.0;
        if !matches!(node.kind, NodeKind::Frame | NodeKind::Input | NodeKind::Output) {
            node.residual_w = balance[k] - node.loss_w + 0.0;
            residual = residual.max(node.residual_w.abs());
            if node.power_in_w > 0.0 {
                node.efficiency = Some(match node.loss_w == 0.0 {
                    true => 1.0,
                    false => (node.power_out_w / node.power_in_w).clamp(0.0, 1.0),
                });
            }
        }
    }

    let train = g.train;
    let ends = |kind: NodeKind, end: fn(&Line) -> usize| -> f64 {
        lines.iter().filter(|l| g.nodes[end(l)].kind == kind).map(|l| l.power).sum()
    };
    let [input, output] = match g.moving {
        true => [ends(NodeKind::Input, |l| l.from), ends(NodeKind::Output, |l| l.to)],
        false => [solution.input_power_w, solution.output_power_w],
    };
    let mut powers: Vec<(usize, usize, f64)> =
        lines.iter().filter(|l| l.power > 0.0).map(|l| (l.from, l.to, l.power)).collect();
    powers.sort_by_key(|e| (e.0, e.1));
    let taken = loops(&g, &mut powers);
    let mut edges: Vec<Edge> = Vec::with_capacity(lines.len());
    for l in &lines {
        let round = |e: &&(usize, usize)| **e == (l.from, l.to);
        let circulating: f64 = taken.iter().map(|t| t.power * t.edges.iter().filter(round).count() as f64).sum();
        edges.push(Edge {
            from: g.nodes[l.from].id.clone(),
            to: g.nodes[l.to].id.clone(),
            member: g.nodes[l.member].name.clone(),
            torque_n_m: l.torque.map(|t| t + 0.0),
            power_w: l.power,
            circulating_w: circulating + 0.0,
        });
    }
    // The same round found more than once is one loop.
    let mut told: Vec<Loop> = Vec::new();
    for t in taken {
        let nodes: Vec<String> = t.edges.iter().map(|e| g.nodes[e.0].id.clone()).collect();
        match told.iter_mut().find(|l| l.nodes == nodes) {
            Some(l) => l.power_w += t.power,
            None => {
                let passes = from_afar(&g, &t.edges);
                let sets = |n: &&String| train.sets().iter().any(|s| s.name == **n);
                let counted = || passes.iter().filter(sets).cloned().collect::<Vec<_>>().join(", ");
                let within = t.within.or_else(|| solution.recirculation.is_empty().then(counted));
                told.push(Loop { power_w: t.power, share_of_input: 0.0, nodes, passes, within });
            }
        }
    }
    told.retain(|l| l.power_w > SMALLEST_LOOP * input);
    for l in &mut told {
        l.share_of_input = if input > 0.0 { l.power_w / input } else { 0.0 };
    }
    told.sort_by(|a, b| b.power_w.total_cmp(&a.power_w));

    let ways = Ways::new(&g.nodes, &powers);
    let (paths, path_count, share_on_paths) = ways.list(&g.nodes, input);
    let (efficiency, efficiency_exact, power_residual_w) = match g.moving {
        true => ((input > 0.0).then(|| output / input), None, input - output - solution.loss_w),
        false => (solution.efficiency, solution.efficiency_exact.clone(), solution.power_residual_w),
    };
    Hypergraph {
        seen_from: None,
        efficiency,
        efficiency_exact,
        input_power_w: input,
        output_power_w: output,
        loss_w: solution.loss_w,
        power_residual_w,
        largest_residual_w: residual,
        nodes: g.nodes,
        edges,
        loops: told,
        paths,
        path_count,
        share_on_paths,
    }
}

/// A cycle that was taken out.
struct Taken {
    power: f64,
    edges: Vec<(usize, usize)>,
    within: Option<String>,
}

/// Takes the cycles out of the powers: first those that stay within one set.
fn loops(g: &Sketch<'_>, powers: &mut Vec<(usize, usize, f64)>) -> Vec<Taken> {
    let train = g.train;
    let family = families(train);
    // Meshes of each set, and the components they touch.
    let mut sets: BTreeMap<usize, (String, Vec<usize>, Vec<usize>)> = BTreeMap::new();
    for (j, mesh) in train.meshes().iter().enumerate() {
        let contact = g.nodes.iter().position(|n| n.kind == NodeKind::Teeth && n.name == mesh.name);
        let name = mesh.set.map_or(&mesh.name, |s| &train.sets()[s].name);
        let (_, contacts, members) = sets.entry(family[j]).or_insert_with(|| (name.clone(), vec![], vec![]));
        contacts.extend(contact);
        members.extend([mesh.gears[0].member, mesh.gears[1].member, mesh.carrier].map(MemberId::index));
    }
    let mut taken = Vec::new();
    for (name, contacts, members) in sets.values_mut() {
        // Bearings and the like between the set's own components, one of them a planet.
        for k in train.members().len()..g.nodes.len() {
            let mut ends = g.torques.range((k, 0)..(k + 1, 0)).map(|((_, m), _)| *m);
            let planet = |m: usize| train.members()[m].kind == MemberKind::Planet;
            let drag = matches!(g.nodes[k].kind, NodeKind::Bearing | NodeKind::Seal | NodeKind::Gear);
            if drag && ends.clone().any(planet) && ends.all(|m| members.contains(&m)) {
                contacts.push(k);
            }
        }
        let own = |e: &(usize, usize, f64)| contacts.contains(&e.0) || contacts.contains(&e.1);
        let mut inside: Vec<_> = powers.iter().copied().filter(own).collect();
        powers.retain(|e| !own(e));
        for (power, edges) in take_out_cycles(&mut inside, 0.0) {
            taken.push(Taken { power, edges, within: Some(name.clone()) });
        }
        powers.extend(inside);
        powers.sort_by_key(|e| (e.0, e.1));
    }
    for (power, edges) in take_out_cycles(powers, 0.0) {
        taken.push(Taken { power, edges, within: None });
    }
    taken
}

/// The shafts and sets of a cycle: planets and single contacts of a set are the set.
fn from_afar(g: &Sketch<'_>, cycle: &[(usize, usize)]) -> Vec<String> {
    let train = g.train;
    let family = families(train);
    let set = |j: usize| {
        let first = family.iter().position(|f| *f == family[j]).unwrap_or(j);
        let mesh = &train.meshes()[first];
        mesh.set.map_or(&mesh.name, |s| &train.sets()[s].name).clone()
    };
    let mut all: Vec<(bool, String)> = Vec::new();
    for (k, _) in cycle {
        let node = &g.nodes[*k];
        let station = match node.kind {
            NodeKind::Member if train.members()[*k].kind == MemberKind::Planet => {
                let of = |m: &crate::train::Mesh| m.gears.iter().any(|x| x.member.index() == *k);
                train.meshes().iter().position(of).map_or(node.name.clone(), set)
            }
            NodeKind::Teeth => train.mesh(&node.name).map_or(node.name.clone(), |m| set(m.index())),
            _ => node.name.clone(),
        };
        let station = (node.kind == NodeKind::Member && train.members()[*k].kind != MemberKind::Planet, station);
        if all.last() != Some(&station) {
            all.push(station);
        }
    }
    if all.len() > 1 && all.first() == all.last() {
        all.pop();
    }
    // It begins at the shaft that the train lists first.
    let place =
        |s: &(bool, String)| if s.0 { train.member(&s.1).map_or(usize::MAX, MemberId::index) } else { usize::MAX };
    let first = (0..all.len()).min_by_key(|&i| place(&all[i])).unwrap_or(0);
    all.rotate_left(first);
    all.into_iter().map(|s| s.1).collect()
}

/// The powers without cycles: what leaves each node, and where.
struct Ways {
    /// By node: target and power.
    out: Vec<Vec<(usize, f64)>>,
    power_in: Vec<f64>,
    power_out: Vec<f64>,
    /// Nodes, each after all that feed it.
    order: Vec<usize>,
}

impl Ways {
    fn new(nodes: &[Node], powers: &[(usize, usize, f64)]) -> Self {
        let n = nodes.len();
        let mut ways = Self {
            out: vec![vec![]; n],
            power_in: vec![0.0; n],
            power_out: vec![0.0; n],
            order: Vec::with_capacity(n),
        };
        let mut waiting = vec![0usize; n];
        for &(from, to, power) in powers {
            ways.out[from].push((to, power));
            ways.power_out[from] += power;
            ways.power_in[to] += power;
            waiting[to] += 1;
        }
        let mut ready: Vec<usize> = (0..n).rev().filter(|&k| waiting[k] == 0).collect();
        while let Some(k) = ready.pop() {
            ways.order.push(k);
            for &(to, _) in &ways.out[k] {
                waiting[to] -= 1;
                if waiting[to] == 0 {
                    ready.push(to);
                }
            }
        }
        ways
    }

    /// Outgoing over incoming power; above one only by round-off.
    fn efficiency(&self, k: usize) -> f64 {
        if self.power_in[k] > 0.0 { self.power_out[k] / self.power_in[k] } else { 1.0 }
    }

    /// The paths that deliver most, their number, and the share of all.
    fn list(&self, nodes: &[Node], input: f64) -> (Vec<PowerPath>, u64, f64) {
        let n = nodes.len();
        let is = |k: usize, kind: NodeKind| nodes[k].kind == kind;
        // From each node on: the best way to an output, and the number of ways.
        let (mut best, mut count) = (vec![0.0f64; n], vec![0u64; n]);
        let passed = |k: usize, power: f64| power / self.power_out[k] * self.efficiency(k);
        for &k in self.order.iter().rev() {
            if is(k, NodeKind::Output) {
                (best[k], count[k]) = (1.0, 1);
            }
            for &(to, power) in &self.out[k] {
                best[k] = best[k].max(passed(k, power) * best[to]);
                count[k] = count[k].saturating_add(count[to]);
            }
        }
        let starts: Vec<usize> = (0..n).filter(|&k| is(k, NodeKind::Input)).collect();
        let entering: f64 = starts.iter().map(|&k| self.power_out[k]).sum();
        if entering <= 0.0 || input <= 0.0 {
            return (vec![], 0, 0.0);
        }
        let number = starts.iter().fold(0u64, |a, &k| a.saturating_add(count[k]));
        let mut share = vec![0.0; n];
        starts.iter().for_each(|&k| share[k] = self.power_out[k] / entering);
        for &k in &self.order {
            for &(to, power) in &self.out[k] {
                share[to] += share[k] * power / self.power_out[k];
            }
        }
        let on_paths = (0..n).filter(|&k| is(k, NodeKind::Output)).map(|k| share[k]).sum::<f64>() + 0.0;

        let mut heap = BinaryHeap::new();
        for &k in starts.iter().filter(|&&k| count[k] > 0) {
            let share = self.power_out[k] / entering;
            heap.push(Partial { bound: share * best[k], share, efficiency: 1.0, nodes: vec![k] });
        }
        let mut paths = Vec::new();
        while let Some(p) = heap.pop() {
            let last = *p.nodes.last().expect("a path begins somewhere");
            if is(last, NodeKind::Output) {
                let station = |&k: &usize| Station {
                    node: nodes[k].id.clone(),
                    efficiency: match nodes[k].kind {
                        NodeKind::Input | NodeKind::Output | NodeKind::Member => 1.0,
                        _ => self.efficiency(k),
                    },
                };
                paths.push(PowerPath {
                    share_of_input: p.share,
                    efficiency: p.efficiency,
                    delivered_w: p.share * p.efficiency * input,
                    stations: p.nodes.iter().map(station).collect(),
                });
                if paths.len() == MOST_PATHS {
                    break;
                }
                continue;
            }
            for &(to, power) in self.out[last].iter().filter(|(to, _)| count[*to] > 0) {
                let share = p.share * power / self.power_out[last];
                let efficiency = p.efficiency * self.efficiency(last);
                let nodes = p.nodes.iter().copied().chain([to]).collect();
                heap.push(Partial { bound: share * efficiency * best[to], share, efficiency, nodes });
            }
        }
        (paths, number, on_paths)
    }
}

/// The beginning of a path, by the power that its best continuation delivers.
struct Partial {
    bound: f64,
    share: f64,
    efficiency: f64,
    nodes: Vec<usize>,
}

impl PartialEq for Partial {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Partial {}

impl PartialOrd for Partial {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Partial {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.bound.total_cmp(&other.bound).then_with(|| other.nodes.cmp(&self.nodes))
    }
}

impl Hypergraph {
    /// The node of that identifier.
    pub fn node(&self, id: &str) -> Option<&Node> {
        self.nodes.iter().find(|n| n.id == id)
    }

    /// Recirculation in words, one sentence each; empty when no power runs in a circle.
    ///
    /// Loops that pass the same shafts and sets are told as one.
    pub fn recirculation(&self) -> Vec<String> {
        let mut rounds: Vec<(&Loop, f64)> = Vec::new();
        for l in &self.loops {
            let same = |o: &Loop| match (&o.within, &l.within) {
                (None, None) => o.passes == l.passes,
                (a, b) => a == b,
            };
            match rounds.iter_mut().find(|(o, _)| same(o)) {
                Some((_, power)) => *power += l.power_w,
                None => rounds.push((l, l.power_w)),
            }
        }
        rounds.sort_by_key(|(l, _)| l.within.is_some());
        let name = |id: &String| self.nodes.iter().find(|n| n.id == *id).map_or("", |n| n.name.as_str());
        let sentence = |(l, power): &(&Loop, f64)| {
            let share = share(if self.input_power_w > 0.0 { power / self.input_power_w } else { 0.0 });
            match &l.within {
                None => {
                    let path: Vec<&str> = l.passes.iter().chain(l.passes.first()).map(String::as_str).collect();
                    format!("{} run in a circle{share}: {}", watts(*power), path.join(" → "))
                }
                Some(set) => {
                    let path: Vec<&str> = l.nodes.iter().chain(l.nodes.first()).map(name).collect();
                    let counted = match &self.seen_from {
                        None => "in the frame of the housing".to_owned(),
                        Some(member) => format!("as seen from {member}"),
                    };
                    format!(
                        "within {set} {}{share} run in a circle as powers are counted {counted}, not through the train: {}",
                        watts(*power),
                        path.join(" → ")
                    )
                }
            }
        };
        rounds.iter().map(sentence).collect()
    }
}

fn share(of_input: f64) -> String {
    if of_input > 0.0 { format!(" ({} % of the input)", digits(100.0 * of_input)) } else { String::new() }
}

/// A power for people: four digits, in W, kW or MW.
///
/// ```
/// use willis::hypergraph::watts;
/// assert_eq!([watts(0.0), watts(12.345), watts(423_870.0), watts(-2.5e6)], ["0 W", "12.35 W", "423.9 kW", "-2.5 MW"]);
/// ```
pub fn watts(power: f64) -> String {
    let (scale, unit) = match power.abs() {
        p if p >= 999.95e3 => (1e6, "MW"),
        p if p >= 999.95 => (1e3, "kW"),
        _ => (1.0, "W"),
    };
    format!("{} {unit}", digits(power / scale))
}

/// Four digits.
fn digits(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    let size = x.abs().log10().floor() as i32;
    if size < -4 {
        return format!("{x:.1e}");
    }
    let text = format!("{x:.*}", (3 - size).clamp(0, 7) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
