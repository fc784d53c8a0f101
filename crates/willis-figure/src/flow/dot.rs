//! Power flows for Graphviz.

use willis::hypergraph::{FlowReport, Hypergraph, Node, NodeKind, watts};

/// The power flows of a train as a Graphviz graph: one cluster for each equilibrium.
///
/// Solid circles are components, hollow circles bearings, triangles tooth contacts; the width of a
/// line is in proportion to the power.
///
/// # Example
/// ```
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
/// let dot = willis_figure::flow_dot(&willis::hypergraph::flows(&train, &Default::default())?);
/// assert!(dot.starts_with("digraph"));
/// assert!(dot.contains("-> \"0.teeth:P1.sun-planet\""));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn flow_dot(all: &FlowReport) -> String {
    let mut out = format!("digraph {} {{\n", quoted(&all.train));
    out +=
        "  rankdir=LR;\n  node [fontname=\"Helvetica\", fontsize=10];\n  edge [fontname=\"Helvetica\", fontsize=9];\n";
    for (k, (title, g)) in super::draw::graphs(all).into_iter().enumerate() {
        out += &format!("  subgraph cluster_{k} {{\n    label={};\n", quoted(&title));
        out += &graph(k, g);
        out += "  }\n";
    }
    out + "}\n"
}

fn graph(number: usize, g: &Hypergraph) -> String {
    let mut out = String::new();
    let name = |id: &str| quoted(&format!("{number}.{id}"));
    let largest = g.edges.iter().fold(f64::MIN_POSITIVE, |a, e| a.max(e.power_w));
    for n in &g.nodes {
        if g.edges.iter().any(|e| e.from == n.id || e.to == n.id) {
            out += &format!("    {} [{}, label={}];\n", name(&n.id), shape(n), quoted(&label(n)));
        }
    }
    for e in &g.edges {
        let mut how = match e.power_w > 0.0 {
            true => {
                let width = 1.0 + 7.0 * e.power_w / largest;
                format!("label={}, penwidth={width:.2}", quoted(&watts(e.power_w)))
            }
            false => "style=dashed, arrowhead=none, color=\"#9a9a9a\"".to_owned(),
        };
        if e.circulating_w > 0.0 {
            how += ", color=\"#d55e00\"";
        }
        out += &format!("    {} -> {} [{how}];\n", name(&e.from), name(&e.to));
    }
    out
}

fn shape(n: &Node) -> &'static str {
    match n.kind {
        NodeKind::Member => "shape=circle, style=filled, fillcolor=black, fontcolor=white",
        NodeKind::Frame => "shape=box, style=filled, fillcolor=\"#dddddd\"",
        NodeKind::Teeth => "shape=triangle",
        NodeKind::Bearing => "shape=circle",
        NodeKind::Seal => "shape=square",
        NodeKind::Gear | NodeKind::Rotor | NodeKind::Drag | NodeKind::OpenElement | NodeKind::Pump => "shape=diamond",
        NodeKind::Input | NodeKind::Output => "shape=plaintext",
        _ => "shape=box, peripheries=2",
    }
}

fn label(n: &Node) -> String {
    let mut text = match n.kind {
        NodeKind::Input => format!("in {}", watts(n.power_out_w)),
        NodeKind::Output => format!("out {}", watts(n.power_in_w)),
        _ => n.name.clone(),
    };
    if n.count > 1 {
        text += &format!(" × {}", n.count);
    }
    if n.loss_w > 0.0 {
        text += &format!("\nloss {}", watts(n.loss_w));
    }
    text
}

/// A string that Graphviz reads as it is; control characters become blanks.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out += "\\\"",
            '\\' => out += "\\\\",
            '\n' => out += "\\n",
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out + "\""
}
