//! Power flow as a Sankey diagram: nodes in layers, links as wide as their power, losses that
//! branch off, and power that runs in circles led back above.
//!
//! The graph is that of [`willis::hypergraph`], made easy to read without losing a watt:
//!
//! * A bearing, seal, gear or rotor in its fluid is no node. What it loses leaves at the component
//!   that drives it; what it passes on is a link from that component to the other.
//! * A planet or shift element that only passes on what it takes is a name on a link
//!   ([`SankeyLink::via`]).
//! * External power is the whole left or right side of its component, unless that component also
//!   takes or gives power otherwise; then the input or output is a node of its own.

pub mod draw;
mod layers;
mod seats;

use serde::{Deserialize, Serialize};
use willis::analysis::{Selection, Verdict};
use willis::diagnostic::Diagnostics;
use willis::hypergraph::{Edge, FlowReport, Hypergraph, Loop, Node, NodeKind, flows};
use willis::train::Train;

use crate::flow::powers;
use crate::kind::{self, Ask, Kind};
use crate::parts::point::pointed;

pub(crate) const KIND: Kind<Sankey> = Kind {
    title: "Power flow to scale",
    takes: &[Ask::State, Ask::Operation, Ask::SeenFrom],
    effort: kind::of_operations,
    applies: None,
    make: |s, r| Ok(sankey(&powers(s, r)?)),
    steps: None,
    draw: draw::draw_on,
};

/// Losses of one kind at one node that are below this part of the input are gathered.
const SMALL_LOSS: f64 = 0.01;

/// The power flows of a train, one panel for each equilibrium.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Sankey {
    /// Name of the train.
    pub train: String,
    /// One for each equilibrium, and one for each operation without any.
    pub panels: Vec<SankeyPanel>,
}

/// One equilibrium, or why there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SankeyPanel {
    /// The operation, its state, and which of several solutions.
    pub title: String,
    /// What has to be said before the numbers: why the train is locked or not determined, or that nothing is loaded.
    pub remark: Option<String>,
    /// The flow; absent where no power runs.
    pub flow: Option<SankeyFlow>,
}

/// The flow of one equilibrium in layers.
///
/// At every node `Σ links in + input = Σ links out + output + Σ losses` up to round-off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SankeyFlow {
    /// The member from which speeds and powers are seen; absent where that is the housing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seen_from: Option<String>,
    /// Power in, W.
    pub input_w: f64,
    /// Power out, W.
    pub output_w: f64,
    /// All losses, W.
    pub loss_w: f64,
    /// Output over input power.
    pub efficiency: Option<f64>,
    /// Power that runs in circles, in words ([`Hypergraph::recirculation`]).
    pub circles: Vec<String>,
    /// Ends, components and contacts.
    pub nodes: Vec<SankeyNode>,
    /// The power between them.
    pub links: Vec<SankeyLink>,
    /// Number of layers.
    pub layers: usize,
}

/// A component, a tooth contact, a shift element, or an end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SankeyNode {
    /// Its identifier in the hypergraph.
    pub id: String,
    /// What it is.
    pub kind: NodeKind,
    /// Its name in the train.
    pub name: String,
    /// Speed of a component, rad/s.
    pub speed_rad_s: Option<f64>,
    /// Identical ones in parallel: tooth pairs.
    pub count: u32,
    /// Power through it, W: what enters, and what leaves with the losses.
    pub power_w: f64,
    /// External power that enters here, W; it takes the whole left side.
    pub input_w: f64,
    /// External power that leaves here, W; it takes the right side above the losses.
    pub output_w: f64,
    /// What is lost here, largest first, stacked below everything that leaves.
    pub losses: Vec<SankeyLoss>,
    /// Its layer, from the left; every link that is not led back runs to a later layer.
    pub layer: usize,
    /// Its place in the layer, from the top, among nodes and passing links.
    pub row: usize,
}

/// Power that turns into heat.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SankeyLoss {
    /// What loses it: teeth, bearings, seals, gears or rotors in their fluid.
    pub kind: NodeKind,
    /// The contacts that lose it; several where small ones are gathered.
    pub names: Vec<String>,
    /// The loss, W.
    pub power_w: f64,
    /// From the top of the node's right side to the top of the loss, W.
    pub offset_w: f64,
}

/// Power from one node to another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SankeyLink {
    /// Index of the node that the power leaves, at its right side.
    pub from: usize,
    /// Index of the node that it enters, at its left side.
    pub to: usize,
    /// What it passes on the way, unchanged: planets, clutches, bearings.
    pub via: Vec<String>,
    /// The power, W.
    pub power_w: f64,
    /// The part of it that runs in circles, W; the upper part of the ribbon.
    pub circulating_w: f64,
    /// That part goes round only as powers are counted in the frame of the housing: it never leaves its set.
    #[serde(default)]
    pub framed: bool,
    /// Whether it is led back to an earlier layer, above all nodes.
    pub back: bool,
    /// From the top of the right side of `from` to its upper edge, W.
    pub from_offset_w: f64,
    /// From the top of the left side of `to` to its upper edge, W.
    pub to_offset_w: f64,
    /// Its rows in the layers that it passes on its way, from the left; empty when led back.
    pub rows: Vec<usize>,
}

/// The power flows of a train as Sankey diagrams.
///
/// # Example
/// ```
/// use willis_figure::sankey;
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
/// let diagram = sankey(&flows(&train, &Default::default())?);
/// let flow = diagram.panels[0].flow.as_ref().unwrap();
/// // The sun, its contact with the planets, theirs with the ring, and the carrier.
/// assert_eq!(flow.nodes.len(), 4);
/// let lost: f64 = flow.nodes.iter().flat_map(|n| &n.losses).map(|l| l.power_w).sum();
/// assert!((flow.input_w - flow.output_w - lost).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn sankey(report: &FlowReport) -> Sankey {
    shown(report, &layers::arrange)
}

fn shown(report: &FlowReport, arrange: &dyn Fn(&mut [SankeyNode], &mut [SankeyLink]) -> usize) -> Sankey {
    let flow = |g: &Hypergraph| {
        let mut flow = flow(g)?;
        flow.layers = arrange(&mut flow.nodes, &mut flow.links);
        Some(flow)
    };
    let mut panels = Vec::new();
    for o in &report.operations {
        let state = o.state.as_ref().map(|s| format!(", state {s}")).unwrap_or_default();
        let title = format!("{}{state}", o.name);
        let count = o.solutions.len();
        for (k, g) in o.solutions.iter().enumerate() {
            let number = if count > 1 { format!(", solution {} of {count}", k + 1) } else { String::new() };
            let flow = flow(g);
            let remark =
                flow.is_none().then(|| "No power flows: what is loaded stands still, or nothing is loaded.".to_owned());
            panels.push(SankeyPanel { title: format!("{title}{number}"), remark, flow });
        }
        for g in &o.dissipative_solutions {
            let remark = Some("Locked: this is what it would take if every loaded member pushed.".to_owned());
            panels.push(SankeyPanel { title: title.clone(), remark, flow: flow(g) });
        }
        if count == 0 && o.dissipative_solutions.is_empty() {
            let word = if o.verdict == Verdict::Locked { "The train is locked" } else { "Not determined" };
            let why = o.reason.as_ref().map(|r| format!(": {r}")).unwrap_or_default();
            panels.push(SankeyPanel { title, remark: Some(format!("{word}, no power flows{why}.")), flow: None });
        }
    }
    Sankey { train: report.train.clone(), panels }
}

/// Where every node of a train stands in its Sankey diagrams, whatever the gear: found once from the flows of all gears and
/// operating points, so that powers change without moving a node to another column, or past another node of its own.
///
/// A gear in which most of the power runs the other way, as when the vehicle drives the engine, stands in the mirror. Where
/// a part of the power runs against the order of the train it is led back above.
///
/// ```
/// use willis::analysis::Selection;
/// use willis::hypergraph::flows;
/// use willis::train::{SetSpec, ShiftElementSpec, StateSpec, Train};
/// use willis_figure::SankeyLayout;
///
/// let train = Train::builder("two speeds")
///     .members(["s", "r", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .shift_element(ShiftElementSpec::brake("B", "r"))
///     .shift_element(ShiftElementSpec::clutch("C", "s", "c"))
///     .state(StateSpec::new("low", ["B"]))
///     .state(StateSpec::new("direct", ["C"]))
///     .build()?;
/// let layout = SankeyLayout::new(&train)?;
/// let all = layout.show(&flows(&train, &Selection::default())?);
/// let column = |k: usize| all.panels[k].flow.as_ref().unwrap().nodes.iter().find(|n| n.id == "member:c").unwrap().layer;
/// assert_eq!(column(0), column(1));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SankeyLayout {
    seats: seats::Seats,
}

impl SankeyLayout {
    /// Lays out a train: its operating points, and of states without any the default one.
    ///
    /// # Errors
    /// No power flows, in no operation and no state.
    pub fn new(train: &Train) -> Result<Self, Diagnostics> {
        let of = |state: Option<String>| {
            let selection = Selection { state, operation: None };
            flows(&pointed(train, &selection), &selection)
        };
        let first = of(None);
        let told = |k: usize| train.operations().iter().any(|o| o.state == Some(k));
        let silent = train.states().iter().enumerate().filter(|(k, _)| !told(*k));
        let others: Vec<FlowReport> = silent.filter_map(|(_, s)| of(Some(s.name.clone())).ok()).collect();
        match first {
            Err(why) if others.is_empty() => Err(why),
            first => Ok(Self::of(first.iter().chain(&others))),
        }
    }

    /// Lays out what all of these show together.
    pub fn of<'r>(reports: impl IntoIterator<Item = &'r FlowReport>) -> Self {
        let operations = reports.into_iter().flat_map(|r| &r.operations);
        let graphs = operations.flat_map(|o| o.solutions.iter().chain(&o.dissipative_solutions));
        Self { seats: seats::Seats::of(&graphs.filter_map(flow).collect::<Vec<_>>()) }
    }

    /// The power flows, with their nodes where they stand in every gear. The train must be the one that was laid out, perhaps
    /// with other numbers.
    pub fn show(&self, report: &FlowReport) -> Sankey {
        shown(report, &|nodes, links| self.seats.arrange(nodes, links))
    }
}

/// A node of the hypergraph while the graph is simplified.
struct Stop<'g> {
    node: &'g Node,
    input: f64,
    output: f64,
    losses: Vec<SankeyLoss>,
    gone: bool,
}

/// A power between two of them.
#[derive(Clone)]
struct Arc {
    from: usize,
    to: usize,
    via: Vec<String>,
    power: f64,
    circulating: f64,
    /// Of that, what passes from set to set, W.
    coupled: f64,
}

/// The flow, not laid out yet.
fn flow(g: &Hypergraph) -> Option<SankeyFlow> {
    let coupled = |e: &Edge| {
        let next = |l: &Loop, k: usize| (k + 1) % l.nodes.len();
        let passes = |l: &&Loop| (0..l.nodes.len()).any(|k| l.nodes[k] == e.from && l.nodes[next(l, k)] == e.to);
        g.loops.iter().filter(|l| l.within.is_none()).filter(passes).map(|l| l.power_w).sum()
    };
    let index = |id: &str| g.nodes.iter().position(|n| n.id == id).expect("edges join nodes of the graph");
    let mut arcs: Vec<Arc> = g
        .edges
        .iter()
        .filter(|e| e.power_w > 0.0)
        .map(|e| Arc {
            from: index(&e.from),
            to: index(&e.to),
            via: vec![],
            power: e.power_w,
            circulating: e.circulating_w.min(e.power_w),
            coupled: coupled(e),
        })
        .collect();
    let touched = |k: usize| arcs.iter().any(|a| a.from == k || a.to == k);
    let mut stops: Vec<Stop<'_>> = g
        .nodes
        .iter()
        .enumerate()
        .map(|(k, node)| Stop { node, input: 0.0, output: 0.0, losses: vec![], gone: !touched(k) })
        .collect();
    if arcs.is_empty() {
        return None;
    }
    fold_drags(&mut stops, &mut arcs);
    pass_through(&mut stops, &mut arcs);
    join_ends(&mut stops, &mut arcs);
    for s in &mut stops {
        gather(&mut s.losses, SMALL_LOSS * g.input_power_w);
    }

    let kept: Vec<usize> = (0..stops.len()).filter(|&k| !stops[k].gone).collect();
    let place = |k: usize| kept.iter().position(|o| *o == k).expect("links join what is kept");
    let mut nodes: Vec<SankeyNode> = Vec::with_capacity(kept.len());
    for &k in &kept {
        let s = &mut stops[k];
        let entering: f64 = arcs.iter().filter(|a| a.to == k).map(|a| a.power).sum();
        nodes.push(SankeyNode {
            id: s.node.id.clone(),
            kind: s.node.kind,
            name: s.node.name.clone(),
            speed_rad_s: s.node.speed_rad_s,
            count: s.node.count,
            power_w: entering + s.input,
            input_w: s.input,
            output_w: s.output,
            losses: std::mem::take(&mut s.losses),
            layer: 0,
            row: 0,
        });
    }
    let links: Vec<SankeyLink> = arcs
        .into_iter()
        .map(|a| SankeyLink {
            from: place(a.from),
            to: place(a.to),
            via: a.via,
            power_w: a.power,
            circulating_w: a.circulating,
            framed: a.circulating > 0.0 && a.coupled <= 1e-9 * a.power,
            back: false,
            from_offset_w: 0.0,
            to_offset_w: 0.0,
            rows: vec![],
        })
        .collect();
    Some(SankeyFlow {
        seen_from: g.seen_from.clone(),
        input_w: g.input_power_w,
        output_w: g.output_power_w,
        loss_w: g.loss_w,
        efficiency: g.efficiency,
        circles: g.recirculation(),
        nodes,
        links,
        layers: 0,
    })
}

/// What friction in bearings, seals and fluids takes leaves at the component that drives it.
fn fold_drags(stops: &mut [Stop<'_>], arcs: &mut Vec<Arc>) {
    for k in 0..stops.len() {
        let node = stops[k].node;
        use NodeKind::{Bearing, Drag, Gear, OpenElement, Pump, Rotor, Seal};
        if !matches!(node.kind, Bearing | Seal | Gear | Rotor | Drag | OpenElement | Pump) {
            continue;
        }
        let into: Vec<Arc> = arcs.iter().filter(|a| a.to == k).cloned().collect();
        let out = arcs.iter().filter(|a| a.from == k).count();
        let Some(driver) = into.first().map(|a| a.from).filter(|_| out == 0 || into.len() == 1) else { continue };
        for a in &into {
            let power_w = if out == 0 { a.power } else { node.loss_w };
            if power_w > 0.0 {
                let names = vec![node.name.clone()];
                stops[a.from].losses.push(SankeyLoss { kind: node.kind, names, power_w, offset_w: 0.0 });
            }
        }
        arcs.retain(|a| a.to != k);
        for a in arcs.iter_mut().filter(|a| a.from == k) {
            a.from = driver;
            a.via.insert(0, node.name.clone());
        }
        stops[k].gone = true;
    }
    for s in stops.iter_mut().filter(|s| !s.gone && s.node.kind > NodeKind::Member && s.node.loss_w > 0.0) {
        let names = vec![s.node.name.clone()];
        s.losses.push(SankeyLoss { kind: s.node.kind, names, power_w: s.node.loss_w, offset_w: 0.0 });
    }
}

/// Planets and shift elements that take from one and give to one become names on a link.
fn pass_through(stops: &mut [Stop<'_>], arcs: &mut Vec<Arc>) {
    for k in 0..stops.len() {
        let s = &stops[k];
        // Only a planet, called after its set, has a dot in its name.
        let plain = match s.node.kind {
            NodeKind::ShiftElement | NodeKind::Coupling => true,
            NodeKind::Member => s.node.name.contains('.'),
            _ => false,
        };
        let only = |end: fn(&Arc) -> usize| {
            let mut all = (0..arcs.len()).filter(|&j| end(&arcs[j]) == k);
            all.next().filter(|_| all.next().is_none())
        };
        let (Some(into), Some(out)) = (only(|a| a.to), only(|a| a.from)) else { continue };
        if !plain || s.gone || !s.losses.is_empty() || arcs[into].from == arcs[out].to {
            continue;
        }
        let after = arcs[out].clone();
        arcs[into].to = after.to;
        arcs[into].via.push(s.node.name.clone());
        arcs[into].via.extend(after.via);
        arcs.remove(out);
        stops[k].gone = true;
    }
}

/// An input that alone feeds its component is that component's left side; an output likewise.
fn join_ends(stops: &mut [Stop<'_>], arcs: &mut Vec<Arc>) {
    for k in 0..stops.len() {
        if stops[k].gone || !matches!(stops[k].node.kind, NodeKind::Input | NodeKind::Output) {
            continue;
        }
        let entering = stops[k].node.kind == NodeKind::Input;
        let ends = |a: &Arc| if entering { (a.from, a.to) } else { (a.to, a.from) };
        let Some(j) = arcs.iter().position(|a| ends(a).0 == k) else { continue };
        let (member, power) = (ends(&arcs[j]).1, arcs[j].power);
        let alone = arcs.iter().filter(|a| ends(a).1 == member).count() == 1;
        let whole = matches!(stops[member].node.kind, NodeKind::Member | NodeKind::Frame);
        let target = if alone && stops[member].input == 0.0 && whole {
            arcs.remove(j);
            stops[k].gone = true;
            member
        } else {
            k
        };
        if entering {
            stops[target].input = power;
        } else {
            stops[target].output = power;
        }
    }
}

/// Small losses of a kind become one; the largest stands first.
fn gather(losses: &mut Vec<SankeyLoss>, small: f64) {
    let mut all: Vec<SankeyLoss> = Vec::new();
    for l in losses.drain(..) {
        match all.iter_mut().find(|o| o.kind == l.kind && o.power_w < small && l.power_w < small) {
            Some(same) => {
                same.power_w += l.power_w;
                same.names.extend(l.names);
            }
            None => all.push(l),
        }
    }
    all.sort_by(|a, b| b.power_w.total_cmp(&a.power_w));
    *losses = all;
}
