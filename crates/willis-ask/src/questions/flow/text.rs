//! Power flows for eyes.

use willis::analysis::Verdict;
use willis::hypergraph::{FlowReport, Hypergraph, MOST_PATHS, Node, NodeKind, OperationFlow, PowerPath, watts};

use crate::style::{
    self, assumptions, bold, dim, percent, plural, right, rpm, set_header, show, significant, table, wrap,
};

pub fn text(all: &FlowReport) -> String {
    let mut out = bold(&all.train) + "\n";
    if let Some(source) = &all.source {
        out += &dim(&wrap(&format!("Source: {source}"), ""));
        out.push('\n');
    }
    for o in &all.operations {
        out.push('\n');
        out += &operation(o);
    }
    out + "\n" + &assumptions(&all.assumptions) + "\n"
}

fn operation(o: &OperationFlow) -> String {
    let mut out = bold(&format!("Power flow: {}", o.name));
    if let Some(state) = &o.state {
        out += &format!("   state {state}");
    }
    out.push('\n');
    if let Some(unit) = &o.unit {
        let text = format!(
            "no operation of the file describes this: {unit} turns at 1 rad/s under 1 N m, and every speed, torque and \
             power is in proportion to that"
        );
        out += &wrap(&text, "  units        ");
        out.push('\n');
    }
    if o.verdict != Verdict::Unique {
        out += &format!("  verdict      {}\n", bold(o.verdict.words()));
    }
    if let Some(reason) = &o.reason {
        out += &wrap(reason, "               ");
        out.push('\n');
    }
    if o.solutions.is_empty() && o.dissipative_solutions.is_empty() {
        out += "  no power flows: there is no equilibrium to show\n";
    }
    for (k, s) in o.solutions.iter().enumerate() {
        if o.solutions.len() > 1 {
            out += &bold(&format!("  Solution {} of {}\n", k + 1, o.solutions.len()));
        }
        out += &graph(s, o);
    }
    for s in &o.dissipative_solutions {
        out += &bold("  Only when every loaded member pushes\n");
        out += &graph(s, o);
    }
    out
}

fn graph(g: &Hypergraph, o: &OperationFlow) -> String {
    let mut out = String::new();
    let efficiency = match g.efficiency {
        // A band is that of the train as it is seen from the housing.
        Some(e) if g.output_power_w > 0.0 && g.seen_from.is_none() => {
            style::efficiency(e, o.band.as_deref(), &o.outside_laws)
        }
        Some(e) if g.output_power_w > 0.0 => percent(e),
        Some(_) => "none: no power leaves, all of it is lost".into(),
        None => "none: no power enters".into(),
    };
    if let Some(member) = &g.seen_from {
        out += &format!("  seen from    {member}: speeds and powers are less by its own speed\n");
    }
    out += &(wrap(&efficiency, "  efficiency   ") + "\n");
    out += &format!(
        "  power        in {}, out {}, lost {}; balance closes to {:.1e} W\n",
        watts(g.input_power_w),
        watts(g.output_power_w),
        watts(g.loss_w),
        g.power_residual_w.abs().max(g.largest_residual_w)
    );
    let rounds = g.recirculation();
    if rounds.is_empty() {
        out += "  in circles   nothing\n";
    }
    for text in &rounds {
        out += &wrap(text, "  in circles   ");
        out.push('\n');
    }

    let mut idle: Vec<&str> = Vec::new();
    let mut t = table();
    set_header(&mut t, &["component", "speed rpm", "power through", "balance W"]);
    for n in g.nodes.iter().filter(|n| n.kind == NodeKind::Member) {
        if silent(g, n) {
            idle.push(&n.name);
            continue;
        }
        let speed = n.speed_rad_s.map_or("any".into(), |w| significant(rpm(w), 6));
        t.add_row([n.name.clone(), speed, dash(n.power_in_w), residual(n)]);
    }
    right(&mut t, 1..4);
    out += &show(&t);

    let mut t = table();
    set_header(&mut t, &["contact", "is", "in", "out", "loss", "η", "η on the carrier", "balance W"]);
    for n in g.nodes.iter().filter(|n| n.kind > NodeKind::Member && n.kind < NodeKind::Input) {
        if silent(g, n) {
            idle.push(&n.name);
            continue;
        }
        t.add_row([
            n.name.clone(),
            kind(n),
            dash(n.power_in_w),
            dash(n.power_out_w),
            dash(n.loss_w),
            n.efficiency.filter(|e| *e > 0.0).map_or("-".into(), percent),
            n.carrier_frame_efficiency.map_or(String::new(), percent),
            residual(n),
        ]);
    }
    right(&mut t, 2..8);
    out += &show(&t);
    if !idle.is_empty() {
        out += &wrap(&format!("idle: {}", idle.join(", ")), "  ");
        out.push('\n');
    }

    let mut t = table();
    set_header(&mut t, &["from", "to", "power", "in a circle", "torque N m"]);
    let name = |id: &str| g.node(id).map_or(String::new(), label);
    for e in &g.edges {
        t.add_row([
            name(&e.from),
            name(&e.to),
            dash(e.power_w),
            if e.circulating_w > 0.0 { watts(e.circulating_w) } else { String::new() },
            e.torque_n_m.map_or("?".into(), |t| significant(t, 6)),
        ]);
    }
    right(&mut t, 2..5);
    out += &show(&t);
    out + &paths(g)
}

fn paths(g: &Hypergraph) -> String {
    if g.paths.is_empty() {
        return "  no path from an input to an output\n".into();
    }
    let mut t = table();
    set_header(&mut t, &["path", "of the input", "η", "delivers"]);
    for (k, p) in g.paths.iter().enumerate() {
        t.add_row([(k + 1).to_string(), percent(p.share_of_input), percent(p.efficiency), watts(p.delivered_w)]);
    }
    right(&mut t, 0..4);
    let mut out = show(&t);
    for (k, p) in g.paths.iter().enumerate() {
        out += &wrap(&stations(g, p), &format!("  {:>4}  ", k + 1));
        out.push('\n');
    }
    let sum: f64 = g.paths.iter().map(|p| p.share_of_input * p.efficiency).sum();
    let rest = g.path_count.saturating_sub(g.paths.len() as u64);
    if rest > 0 {
        out += &format!(
            "  {} of {} paths are listed; the other {rest} deliver {}\n",
            MOST_PATHS.min(g.paths.len()),
            g.path_count,
            watts((g.output_power_w - sum * g.input_power_w).max(0.0))
        );
    } else {
        out += &format!(
            "  {} {} of the input; Σ share × η = {}, the efficiency of the train\n",
            plural(g.paths.len(), "path takes", "paths take"),
            percent(g.share_on_paths),
            percent(sum)
        );
    }
    out
}

/// `sun → P1.sun-planet 99.5 % → …`: components by name, contacts with their efficiency.
fn stations(g: &Hypergraph, p: &PowerPath) -> String {
    let one = |s: &willis::hypergraph::Station| {
        let n = g.node(&s.node)?;
        match n.kind {
            NodeKind::Input | NodeKind::Output => None,
            NodeKind::Member => Some(n.name.clone()),
            _ if s.efficiency < 1.0 - 1e-12 => Some(format!("{} ({})", n.name, percent(s.efficiency))),
            _ => Some(n.name.clone()),
        }
    };
    p.stations.iter().filter_map(one).collect::<Vec<_>>().join(" → ")
}

/// Whether neither power nor torque touches it.
fn silent(g: &Hypergraph, n: &Node) -> bool {
    g.edges.iter().all(|e| e.from != n.id && e.to != n.id)
}

fn kind(n: &Node) -> String {
    let word = match n.kind {
        NodeKind::Teeth => "teeth",
        NodeKind::Bearing => "bearing",
        NodeKind::Seal => "seal",
        NodeKind::Gear => "gear in fluid",
        NodeKind::Rotor => "rotor in fluid",
        NodeKind::Drag => "given drag",
        NodeKind::OpenElement => "open clutch or brake",
        NodeKind::Pump => "oil pump",
        NodeKind::Coupling => "coupled for good",
        NodeKind::Variator => "variator",
        _ => "clutch or brake",
    };
    if n.count > 1 { format!("{word} × {}", n.count) } else { word.into() }
}

/// What a node is called where components and ends may carry one name.
fn label(n: &Node) -> String {
    match n.kind {
        NodeKind::Input => "(input)".into(),
        NodeKind::Output => "(output)".into(),
        NodeKind::Gear => format!("{} in fluid", n.name),
        _ => n.name.clone(),
    }
}

fn dash(power: f64) -> String {
    if power == 0.0 { "-".into() } else { watts(power) }
}

fn residual(n: &Node) -> String {
    if n.residual_w == 0.0 { "0".into() } else { format!("{:.0e}", n.residual_w) }
}
