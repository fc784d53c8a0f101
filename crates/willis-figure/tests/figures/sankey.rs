//! Sankey diagrams: at every node what enters is what leaves with the losses, to scale; ribbons do
//! not overlap; sums are those of the power flow.

use willis::analysis::Selection;
use willis::hypergraph::{FlowReport, Hypergraph, NodeKind, flows};
use willis_figure::{Drawing, SankeyFlow, SankeyLayout, SankeyLink, SankeyPaper, sankey};

use crate::trains::{self, stepped};

fn examples() -> Vec<(String, FlowReport)> {
    let all = trains::examples().into_iter();
    all.filter_map(|(name, train)| Some((name, flows(&train, &Selection::default()).ok()?))).collect()
}

fn example(name: &str) -> FlowReport {
    flows(trains::model(name).train(), &Selection::default()).expect("it has operations")
}

/// The graphs in the order of the panels that have a flow.
fn graphs(all: &FlowReport) -> Vec<&Hypergraph> {
    let both = all.operations.iter().flat_map(|o| o.solutions.iter().chain(&o.dissipative_solutions));
    both.filter(|g| g.edges.iter().any(|e| e.power_w > 0.0)).collect()
}

/// Parts of a side, from the top: they follow each other without gap or overlap.
fn fills(at: &str, mut parts: Vec<[f64; 2]>, whole: f64, size: f64) {
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut end = 0.0;
    for [offset, width] in parts {
        assert!((offset - end).abs() <= 1e-9 * size, "{at}: a part begins at {offset}, the one before ends at {end}");
        assert!(width > 0.0, "{at}: a part without width");
        end = offset + width;
    }
    assert!((end - whole).abs() <= 1e-8 * size, "{at}: {end} W of {whole} W");
}

fn check(at: &str, f: &SankeyFlow, g: &Hypergraph) {
    let size = g.edges.iter().fold(g.input_power_w.max(1e-30), |a, e| a.max(e.power_w));
    let close = |a: f64, b: f64, what: &str| assert!((a - b).abs() <= 1e-8 * size, "{at}: {what}: {a} and {b} W");
    for (k, n) in f.nodes.iter().enumerate() {
        let at = format!("{at}, {}", n.id);
        let side = |end: fn(&SankeyLink) -> usize, offset: fn(&SankeyLink) -> f64| -> Vec<[f64; 2]> {
            f.links.iter().filter(|l| end(l) == k).map(|l| [offset(l), l.power_w]).collect()
        };
        let mut left = side(|l| l.to, |l| l.to_offset_w);
        let mut right = side(|l| l.from, |l| l.from_offset_w);
        assert!(n.input_w == 0.0 || left.is_empty(), "{at}: an input takes the whole side");
        assert!(n.output_w == 0.0 || right.is_empty(), "{at}: an output takes the whole side");
        left.extend((n.input_w > 0.0).then_some([0.0, n.input_w]));
        right.extend((n.output_w > 0.0).then_some([0.0, n.output_w]));
        right.extend(n.losses.iter().map(|l| [l.offset_w, l.power_w]));
        fills(&at, left, n.power_w, size);
        fills(&at, right, n.power_w, size);
        let round = |end: fn(&SankeyLink) -> usize| -> f64 {
            f.links.iter().filter(|l| end(l) == k).map(|l| l.circulating_w).sum()
        };
        close(round(|l| l.from), round(|l| l.to), "circulating");
        let of = |e: &willis::hypergraph::Edge| e.circulating_w;
        let theirs: f64 = g.edges.iter().filter(|e| e.to == n.id).map(of).sum();
        close(round(|l| l.to), theirs, "circulating in the hypergraph");
        assert!(n.layer < f.layers);
        assert!(!matches!(n.kind, NodeKind::Frame | NodeKind::Bearing), "{at}: {:?}", n.kind);
    }
    let losses = || f.nodes.iter().flat_map(|n| &n.losses);
    close(f.nodes.iter().map(|n| n.input_w).sum(), g.input_power_w, "input");
    close(f.nodes.iter().map(|n| n.output_w).sum(), g.output_power_w, "output");
    close(losses().map(|l| l.power_w).sum(), g.loss_w, "losses");
    for kind in [NodeKind::Teeth, NodeKind::Bearing, NodeKind::Seal, NodeKind::Gear, NodeKind::Rotor] {
        let theirs: f64 = g.nodes.iter().filter(|n| n.kind == kind).map(|n| n.loss_w).sum();
        close(losses().filter(|l| l.kind == kind).map(|l| l.power_w).sum(), theirs, "losses of a kind");
    }
    // Every contact that loses is named.
    for n in g.nodes.iter().filter(|n| n.loss_w > 0.0) {
        assert!(losses().any(|l| l.kind == n.kind && l.names.contains(&n.name)), "{at}: {} is not told", n.id);
    }
    // And so is every node that power passes.
    for e in g.edges.iter().filter(|e| e.power_w > 0.0) {
        let name = &g.node(&e.to).expect("edges join nodes").name;
        let told = f.nodes.iter().any(|n| n.name == *name)
            || f.links.iter().any(|l| l.via.contains(name))
            || losses().any(|l| l.names.contains(name));
        assert!(told, "{at}: {name} is not told");
    }
    // A place of its own for each node and each passing link.
    let mut places: Vec<(usize, usize)> = f.nodes.iter().map(|n| (n.layer, n.row)).collect();
    for l in &f.links {
        let (a, b) = (f.nodes[l.from].layer, f.nodes[l.to].layer);
        assert!(l.circulating_w <= l.power_w);
        if l.back {
            assert!(b < a && l.rows.is_empty(), "{at}: {l:?}");
            close(l.circulating_w, l.power_w, "what is led back circulates");
        } else {
            assert!(a < b && l.rows.len() == b - a - 1, "{at}: {l:?}");
        }
        places.extend(l.rows.iter().enumerate().map(|(k, row)| (a + 1 + k, *row)));
    }
    places.sort_unstable();
    for (k, p) in places.iter().enumerate() {
        let first = places.iter().position(|o| o.0 == p.0).expect("its own layer");
        assert_eq!(p.1, k - first, "{at}: rows of layer {}", p.0);
    }
    for n in &f.nodes {
        assert!(n.input_w == 0.0 || n.layer == 0);
        assert!(n.output_w == 0.0 || n.layer + 1 == f.layers);
    }
    // Loops of the hypergraph, and only they, need a way back.
    let loops: f64 = g.loops.iter().map(|l| l.power_w).sum();
    let back: f64 = f.links.iter().filter(|l| l.back).map(|l| l.power_w).sum();
    assert!(back >= loops * (1.0 - 1e-9) - 1e-8 * size, "{at}: {back} W of {loops} W are led back");
    assert!(loops > 0.0 || back <= 1e-8 * size, "{at}");
}

fn check_all(at: &str, all: &FlowReport) -> usize {
    let figure = sankey(all);
    assert_eq!(figure, sankey(all), "{at}: not the same twice");
    let mut theirs = graphs(all).into_iter();
    let mut count = 0;
    for p in &figure.panels {
        match &p.flow {
            Some(f) => check(&format!("{at}, {}", p.title), f, theirs.next().expect("a graph for each flow")),
            None => assert!(p.remark.is_some(), "{at}, {}: nothing is said", p.title),
        }
        count += 1;
    }
    assert!(theirs.next().is_none(), "{at}: a graph without a panel");
    count
}

#[test]
fn every_operation_of_every_example_is_to_scale() {
    let count: usize = examples().iter().map(|(name, all)| check_all(name, all)).sum();
    assert!(count > 40, "{count}");
}

#[test]
fn prop_random_trains_are_to_scale() {
    let (mut count, mut back) = (0, 0);
    for seed in 0..200 {
        let Some(all) = stepped(seed).and_then(|t| flows(&t, &Selection::default()).ok()) else { continue };
        count += check_all(&format!("seed {seed}"), &all);
        let led = |p: &willis_figure::SankeyPanel| p.flow.iter().any(|f| f.links.iter().any(|l| l.back));
        back += sankey(&all).panels.iter().filter(|p| led(p)).count();
    }
    assert!(count > 100 && back > 10, "{count} {back}");
}

#[test]
fn power_that_circulates_between_sets_is_led_back_once() {
    let figure = sankey(&example("compound-split.toml"));
    let flow = figure.panels[0].flow.as_ref().unwrap();
    let back: Vec<_> = flow.links.iter().filter(|l| l.back).collect();
    let circulating: f64 = back.iter().map(|l| l.circulating_w).sum();
    assert_eq!(back.len(), 1);
    assert!((circulating - 20_940.7).abs() < 0.1, "{circulating}");
    assert!(flow.circles[0].contains("20.94 kW"), "{:?}", flow.circles);
}

#[test]
fn small_losses_of_a_kind_are_gathered_and_counted() {
    let figure = sankey(&example("wang-herringbone-physical.toml"));
    let flow = figure.panels[0].flow.as_ref().unwrap();
    let output = flow.nodes.iter().find(|n| n.output_w > 0.0).unwrap();
    let bearings = output.losses.iter().find(|l| l.kind == NodeKind::Bearing).unwrap();
    assert!(bearings.names.len() > 1, "{bearings:?}");
    assert!(output.losses.iter().filter(|l| l.kind == NodeKind::Bearing).count() == 1);
}

#[test]
fn a_locked_operation_says_so_in_words() {
    let locked = sankey(&example("esmail-fig1-band.toml"));
    let panel = locked.panels.iter().find(|p| p.flow.is_none()).expect("one operation is locked");
    assert!(panel.remark.as_ref().unwrap().starts_with("The train is locked, no power flows: "), "{panel:?}");
    let pushed = sankey(&example("wolfrom-498-self-locking.toml"));
    assert!(pushed.panels.iter().any(|p| p.flow.is_some() && p.remark.as_ref().is_some_and(|r| r.contains("Locked"))));
}

/// The flows of every gear of a train: at its operating points, and of states without any at the default one.
fn gears(train: &willis::Train) -> Vec<FlowReport> {
    let alone = willis::unstable::without_operations(train);
    [flows(train, &Selection::default()), flows(&alone, &Selection::default())].into_iter().flatten().collect()
}

/// A node stands in one column and at one place among its neighbours, whatever the gear; in the mirror where the train is
/// driven from the other side.
#[test]
fn nodes_stand_at_one_place_in_every_gear() {
    use std::collections::BTreeMap;
    let (mut shared, mut mirrored) = (0, 0);
    for (name, train) in trains::examples() {
        let Ok(layout) = SankeyLayout::new(&train) else { continue };
        let mut seats: BTreeMap<String, usize> = BTreeMap::new();
        let mut pairs: BTreeMap<[String; 2], bool> = BTreeMap::new();
        for report in gears(&train) {
            let (alone, kept) = (sankey(&report), layout.show(&report));
            assert_eq!(kept, layout.show(&report), "{name}: not the same twice");
            for (own, panel) in alone.panels.iter().zip(&kept.panels) {
                let (Some(own), Some(f)) = (&own.flow, &panel.flow) else { continue };
                let at = format!("{name}, {}", panel.title);
                // Only places differ.
                assert_eq!(
                    own.links.iter().map(|l| l.power_w).sum::<f64>(),
                    f.links.iter().map(|l| l.power_w).sum::<f64>()
                );
                for l in &f.links {
                    let [a, b] = [l.from, l.to].map(|k| f.nodes[k].layer);
                    assert!(if l.back { b < a } else { a < b && l.rows.len() == b - a - 1 }, "{at}: {l:?}");
                }
                let places: std::collections::BTreeSet<_> = f.nodes.iter().map(|n| (n.layer, n.row)).collect();
                assert_eq!(places.len(), f.nodes.len(), "{at}: two nodes at one place");
                let known: Vec<_> = f.nodes.iter().filter_map(|n| Some((n.layer, *seats.get(&n.id)?))).collect();
                let turned = |layer: usize| f.layers - 1 - layer;
                let straight = known.iter().all(|(a, b)| a == b);
                assert!(straight || known.iter().all(|(a, b)| turned(*a) == *b), "{at}: {known:?}");
                mirrored += usize::from(!straight);
                shared += known.len();
                for n in &f.nodes {
                    seats.entry(n.id.clone()).or_insert(if straight { n.layer } else { turned(n.layer) });
                    for o in f.nodes.iter().filter(|o| o.layer == n.layer && o.id < n.id) {
                        let above = *pairs.entry([o.id.clone(), n.id.clone()]).or_insert(o.row < n.row);
                        assert_eq!(above, o.row < n.row, "{at}: {} and {} change places", o.id, n.id);
                    }
                }
            }
        }
    }
    assert!(shared > 1000 && mirrored > 0, "{shared} {mirrored}");
}

/// More torque: nodes stay in their columns and become higher in proportion, words stay where they were along the way.
#[test]
fn kept_paper_moves_nothing_sideways() {
    let train = |torque: f64| {
        use willis::train::{OperationSpec, SetSpec, Train};
        use willis::units::{AngularSpeed, Torque};
        let load = OperationSpec::new("load").speed("s", AngularSpeed::rpm(1000.0)).torque("s", Torque::n_m(torque));
        let set = SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99);
        let all = Train::builder("one set").members(["s", "c"]).terminals(["s", "c"]).set(set);
        all.operation(load).build().expect("a train")
    };
    let layout = SankeyLayout::new(&train(10.0)).expect("it has an operation");
    let of = |torque: f64| layout.show(&flows(&train(torque), &Selection::default()).expect("it flows"));
    let mut paper = SankeyPaper::new([&of(10.0)], Drawing::default());
    let mut places = |torque: f64| {
        let svg = paper.draw(&of(torque));
        let document = roxmltree::Document::parse(&svg).expect("well-formed");
        let number = |n: &roxmltree::Node<'_, '_>, key: &str| n.attribute(key).and_then(|v| v.parse::<f64>().ok());
        let bars = document.descendants().filter(|n| n.attribute("id").is_some_and(|id| id.starts_with("nodeMember")));
        let bar = |n: roxmltree::Node<'_, '_>| {
            let r = n.descendants().find(|d| d.has_tag_name("rect")).expect("a bar");
            (number(&r, "x").unwrap(), number(&r, "height").unwrap())
        };
        let bars: Vec<(f64, f64)> = bars.map(bar).collect();
        let words = document.descendants().filter(|n| n.has_tag_name("text") && n.attribute("aria-hidden").is_none());
        let shares = words.filter(|n| n.text().is_some_and(|t| t.trim().ends_with('%') && !t.contains('·')));
        (bars, shares.filter_map(|n| number(&n, "x")).collect::<Vec<_>>())
    };
    let [few, more] = [10.0, 12.0].map(&mut places);
    assert!(few.0.len() == 2 && !few.1.is_empty(), "{few:?}");
    // Words that end where a gap ends move by half of what they become wider.
    assert_eq!(few.1.len(), more.1.len());
    assert!(few.1.iter().zip(&more.1).all(|(a, b)| (a - b).abs() < 3.0), "{few:?} {more:?}");
    for ((x, height), (other, higher)) in few.0.iter().zip(&more.0) {
        // A bar stands out by 1.5 beyond its power at each end.
        assert_eq!(x, other);
        assert!(((higher - 3.0) / (height - 3.0) - 1.2).abs() < 1e-2, "{height} {higher}");
    }
}
