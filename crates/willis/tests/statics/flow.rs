//! Power flows: every node balances, the paths add up to the train's efficiency, loops agree with
//! the analysis; for every example, for trains with computed losses, and for random trains.

use willis::analysis::{Selection, SolutionReport, Verdict, analyze};
use willis::hypergraph::{FlowReport, Hypergraph, NodeKind, flows, flows_seen_from, hypergraph};
use willis::train::{OperationSpec, SetSpec, Train};
use willis::units::{AngularSpeed, Torque};

use crate::common::{self, Dice};

/// A stage with bearings, a seal, gears in mist and a drum.
const STAGE: &str = r#"
format = 1
name = "stage"
members = ["sun", "carrier"]
terminals = ["sun", "carrier"]
[oil]
name = "VG 100"
viscosity_40 = "100 mm^2/s"
viscosity_100 = "11 mm^2/s"
density_15 = "880 kg/m^3"
temperature = "60 degC"
supply = "jet"
[[set]]
name = "P1"
sun = { member = "sun", teeth = 17 }
planet = { teeth = 22, count = 3 }
ring = { member = "frame", teeth = 61 }
carrier = "carrier"
geometry = { module = "4 mm", width = "50 mm", roughness = "0.6 um" }
[[bearing]]
name = "planet bearings"
members = ["P1.planet", "carrier"]
designation = "NU 206"
count = 2
level = "0 mm"
[[bearing]]
name = "input bearing"
members = ["sun"]
designation = "6210"
[[seal]]
name = "input seal"
members = ["sun"]
diameter = "50 mm"
[[rotor]]
name = "carrier drum"
member = "carrier"
radius = "110 mm"
length = "90 mm"
radial_gap = "10 mm"
[[operation]]
name = "rated"
speeds = { sun = "1500 rpm" }
torques = { sun = "1591.549 N m" }
[[operation]]
name = "backwards"
speeds = { sun = "-1500 rpm" }
torques = { sun = "-500 N m" }
[[operation]]
name = "coasting"
speeds = { sun = "3000 rpm" }
torques = { sun = "-50 N m" }
[[operation]]
name = "nothing at the output"
speeds = { sun = "3000 rpm" }
torques = { carrier = "0 N m" }
"#;

fn examples() -> Vec<(String, Train)> {
    let read = |text: &str| Train::from_toml(text).unwrap();
    common::examples().into_iter().map(|(name, text)| (name, read(&text))).collect()
}

/// Everything that holds for any graph.
fn check(at: &str, g: &Hypergraph) {
    let size = g.edges.iter().fold(g.input_power_w.max(1e-30), |a, e| a.max(e.power_w));
    let close = |a: f64, b: f64, what: &str| {
        assert!((a - b).abs() <= 1e-9 * size, "{at}: {what}: {a} and {b} of {size} W");
    };
    assert!(g.largest_residual_w <= 1e-9 * size, "{at}: residual {} of {size} W", g.largest_residual_w);
    let sum = |of: fn(&willis::hypergraph::Node) -> f64| g.nodes.iter().map(of).sum::<f64>();
    close(sum(|n| n.loss_w), g.loss_w, "loss");
    for n in &g.nodes {
        assert!(n.loss_w >= -1e-12 * size, "{at}: {} loses {}", n.id, n.loss_w);
        assert_eq!(g.nodes.iter().filter(|o| o.id == n.id).count(), 1, "{at}: {}", n.id);
        let edge = |end: fn(&willis::hypergraph::Edge) -> &String| -> f64 {
            g.edges.iter().filter(|e| *end(e) == n.id).map(|e| e.power_w).sum()
        };
        close(edge(|e| &e.to), n.power_in_w, &n.id);
        close(edge(|e| &e.from), n.power_out_w, &n.id);
        match n.kind {
            NodeKind::Input => assert_eq!(n.power_in_w, 0.0),
            NodeKind::Output => assert_eq!(n.power_out_w, 0.0),
            NodeKind::Frame if g.seen_from.is_none() => {
                assert_eq!((n.power_in_w, n.power_out_w), (0.0, 0.0), "{at}: the frame takes power");
            }
            _ => close(n.power_in_w - n.power_out_w, n.loss_w, &n.id),
        }
        if n.kind == NodeKind::Member {
            assert_eq!(n.loss_w, 0.0);
        }
    }
    for e in &g.edges {
        assert!(e.power_w >= 0.0 && e.circulating_w <= e.power_w * (1.0 + 1e-9), "{at}: {e:?}");
        assert!(g.node(&e.from).is_some() && g.node(&e.to).is_some(), "{at}: {e:?}");
    }
    for l in &g.loops {
        for k in 0..l.nodes.len() {
            let (from, to) = (&l.nodes[k], &l.nodes[(k + 1) % l.nodes.len()]);
            assert!(g.edges.iter().any(|e| e.from == *from && e.to == *to && e.power_w > 0.0), "{at}: {l:?}");
        }
    }
    for p in &g.paths {
        let product: f64 = p.stations.iter().map(|s| s.efficiency).product();
        assert!((product - p.efficiency).abs() < 1e-9, "{at}: {p:?}");
        assert_eq!(g.node(&p.stations[0].node).unwrap().kind, NodeKind::Input);
        assert_eq!(g.node(&p.stations.last().unwrap().node).unwrap().kind, NodeKind::Output);
    }
    if g.path_count == g.paths.len() as u64 {
        let sum: f64 = g.paths.iter().map(|p| p.share_of_input * p.efficiency).sum();
        if let Some(e) = g.efficiency {
            let tolerance = 1e-9 * (size / g.input_power_w).max(1.0);
            assert!((sum - e).abs() <= tolerance, "{at}: paths make {sum}, the efficiency is {e}");
        }
        let shares: f64 = g.paths.iter().map(|p| p.share_of_input).sum();
        assert!((shares - g.share_on_paths).abs() < 1e-9, "{at}");
    }
    assert!((0.0..=1.0 + 1e-9).contains(&g.share_on_paths), "{at}");
}

fn check_all(at: &str, all: &FlowReport) -> usize {
    let mut count = 0;
    for o in &all.operations {
        for g in o.solutions.iter().chain(&o.dissipative_solutions) {
            check(&format!("{at}, {}", o.name), g);
            count += 1;
        }
    }
    count
}

fn flow_of(text: &str, operation: &str) -> Hypergraph {
    let selection = Selection { operation: Some(operation.into()), state: None };
    let mut all = flows(&Train::from_toml(text).unwrap(), &selection).unwrap();
    all.operations.remove(0).solutions.remove(0)
}

#[test]
fn every_example_balances() {
    let mut count = 0;
    for (name, train) in examples() {
        match flows(&train, &Selection::default()) {
            Ok(all) => count += check_all(&name, &all),
            Err(wrong) => {
                assert!(train.operations().is_empty(), "{name}: {wrong}");
                assert!(wrong.to_string().contains("[[operation]]"), "{wrong}");
            }
        }
    }
    assert!(count > 30, "{count}");
}

/// Torques that meet add to zero, so nothing is lost or won by who looks: nodes balance, and losses are what they were.
#[test]
fn every_example_balances_as_seen_from_every_member() {
    let mut count = 0;
    for (name, train) in examples() {
        let Ok(housing) = flows(&train, &Selection::default()) else { continue };
        // From the frame, which is the first, it is the same graph.
        for seen_from in train.members().iter().skip(1) {
            let at = format!("{name} seen from {}", seen_from.name);
            let all = match flows_seen_from(&train, &Selection::default(), Some(&seen_from.name)) {
                Ok(all) => all,
                Err(wrong) => {
                    assert!(wrong.to_string().contains("not determined"), "{at}: {wrong}");
                    continue;
                }
            };
            count += check_all(&at, &all);
            for (there, here) in all.operations.iter().zip(&housing.operations) {
                for (there, here) in there.solutions.iter().zip(&here.solutions) {
                    for (a, b) in there
                        .nodes
                        .iter()
                        .filter(|n| n.loss_w != 0.0)
                        .zip(here.nodes.iter().filter(|n| n.loss_w != 0.0))
                    {
                        assert_eq!((&a.id, a.loss_w), (&b.id, b.loss_w), "{at}");
                    }
                    let own = there.node(&format!("member:{}", seen_from.name)).unwrap();
                    assert_eq!(own.speed_rad_s, Some(0.0), "{at}");
                    assert_eq!((own.power_in_w, own.power_out_w), (0.0, 0.0), "{at}");
                }
            }
        }
    }
    assert!(count > 300, "{count}");
}

#[test]
fn every_state_of_every_example_balances() {
    let mut count = 0;
    for (name, text) in common::examples() {
        let train = Train::from_toml(&text).unwrap();
        for state in train.states() {
            let Some(input) = state.input.or(train.input()).or(train.terminals().first().copied()) else { continue };
            let input = train.member_name(input);
            let more = format!(
                "\n[[operation]]\nname = \"added\"\nstate = \"{}\"\nspeeds = {{ {input} = \"1000 rpm\" }}\ntorques = {{ \
                 {input} = \"100 N m\" }}\n",
                state.name
            );
            let Ok(train) = Train::from_toml(&(text.clone() + &more)) else { continue };
            let added = Selection { operation: Some("added".into()), state: None };
            if let Ok(all) = flows(&train, &added) {
                count += check_all(&format!("{name}, state {}", state.name), &all);
            }
        }
    }
    assert!(count > 60, "{count}");
}

/// Shafts and sets seen from afar: what circulates there circulates here.
#[test]
fn loops_agree_with_the_analysis() {
    let mut found = 0;
    for (name, train) in examples() {
        let analysis = analyze(&train, &Selection::default()).unwrap();
        for o in &analysis.operations {
            for s in &o.solutions {
                let g = hypergraph(&train, s);
                let between: f64 = g.loops.iter().filter(|l| l.within.is_none()).map(|l| l.power_w).sum();
                let theirs: f64 = s.recirculation.iter().map(|r| r.power_w).sum();
                let size = s.input_power_w.max(theirs);
                assert!(
                    (between - theirs).abs() <= 1e-6 * size,
                    "{name}, {}: {between} {theirs} {:#?}",
                    o.name,
                    g.loops
                );
                found += usize::from(theirs > 0.0);
            }
        }
    }
    assert!(found > 0);
}

#[test]
fn computed_losses_stand_where_they_arise() {
    let train = Train::from_toml(STAGE).unwrap();
    let analysis = analyze(&train, &Selection::default()).unwrap();
    for o in &analysis.operations {
        for s in &o.solutions {
            let g = hypergraph(&train, s);
            check(&o.name, &g);
            // The bearings lose here what the list of losses says, friction by load included.
            for (name, b) in s.bearings.iter() {
                let node = g.node(&format!("bearing:{name}")).unwrap();
                assert!((node.loss_w - b.loss_w).abs() < 1e-9, "{name}");
            }
            let of = |g: &Hypergraph, kind| g.nodes.iter().filter(|n| n.kind == kind).map(|n| n.loss_w).sum::<f64>();
            assert!((of(&g, NodeKind::Teeth) - s.losses_w.mesh).abs() < 1e-9);
            assert!((of(&g, NodeKind::Seal) - s.losses_w.seal).abs() < 1e-9);
        }
    }
    let rated = flow_of(STAGE, "rated");
    assert!(rated.node("bearing:planet bearings").unwrap().loss_w > 10.0);
    assert_eq!(rated.node("bearing:planet bearings").unwrap().count, 6);
    assert_eq!(rated.node("teeth:P1.sun-planet").unwrap().count, 3);
    assert!(rated.share_on_paths < 1.0);
}

#[test]
fn an_input_without_an_output_has_no_path() {
    let g = flow_of(STAGE, "nothing at the output");
    check("idling", &g);
    assert_eq!((g.paths.len(), g.path_count), (0, 0));
    assert!(g.input_power_w > 0.0 && g.output_power_w == 0.0);
}

/// Reversing everything turns no power round.
#[test]
fn prop_reversal_keeps_the_flow() {
    let text = STAGE.replace("-500 N m", "-1591.549 N m");
    let (a, b) = (flow_of(&text, "rated"), flow_of(&text, "backwards"));
    for (x, y) in a.edges.iter().zip(&b.edges) {
        assert_eq!((&x.from, &x.to), (&y.from, &y.to));
        assert!((x.power_w - y.power_w).abs() < 1e-6 * a.input_power_w);
    }
}

/// The split of the two-stage drive of Wang et al.: without loss the carrier of stage 1 takes
/// (1 + i0)/(1 + i0 + i0²) of the power, with i0 = 97/35, one half from each tooth contact.
#[test]
fn the_herringbone_drive_splits_as_it_must() {
    let text = common::example("wang-herringbone");
    let lossless = text.replace("mesh_efficiency = { external = 0.9963, internal = 0.9974 }", "mesh_efficiency = 1");
    let g = flow_of(&lossless, "424 kW at 4920 rpm");
    let i0 = 97.0 / 35.0;
    let all = 1.0 + i0 + i0 * i0;
    let mut shares: Vec<f64> = g.paths.iter().map(|p| p.share_of_input).collect();
    shares.sort_by(f64::total_cmp);
    let carrier = (1.0 + i0) / all;
    for (share, expected) in shares.iter().zip([carrier / 2.0, carrier / 2.0, i0 * i0 / all]) {
        assert!((share - expected).abs() < 1e-12, "{share} {expected}");
    }
    assert!(g.paths.iter().all(|p| (p.efficiency - 1.0).abs() < 1e-12));
}

#[test]
fn every_solution_has_its_graph() {
    let train = common::train("two-efficiencies");
    let all = flows(&train, &Selection::default()).unwrap();
    assert_eq!(all.operations[0].verdict, Verdict::Multiple);
    assert_eq!(all.operations[0].solutions.len(), 2);
    check_all("two", &all);
}

#[test]
fn a_locked_train_says_so() {
    let train = common::train("wolfrom-498-self-locking");
    let all = flows(&train, &Selection::default()).unwrap();
    let locked = all.operations.iter().find(|o| o.verdict == Verdict::Locked).expect("it locks");
    assert!(locked.reason.as_ref().unwrap().contains("locks"));
    assert!(locked.solutions.is_empty());
    check_all("locked", &all);
}

#[test]
fn without_a_load_nothing_flows() {
    let train = Train::builder("idle")
        .members(["s", "c"])
        .terminals(["s", "c"])
        .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
        .operation(OperationSpec::new("none").speed("s", AngularSpeed::rpm(1000.0)).torque("s", Torque::n_m(0.0)))
        .build()
        .unwrap();
    let all = flows(&train, &Selection::default()).unwrap();
    let g = &all.operations[0].solutions[0];
    check("idle", g);
    assert!(g.edges.is_empty() && g.paths.is_empty() && g.loops.is_empty());
}

#[test]
fn wrong_questions_are_answered_with_a_hint() {
    let with = |operation: &str| {
        let selection = Selection { operation: Some(operation.into()), state: None };
        flows(&Train::from_toml(STAGE).unwrap(), &selection).unwrap_err().to_string()
    };
    assert!(with("ratd").contains("did you mean `rated`?"), "{}", with("ratd"));
}

/// Per unit of speed and torque at the input: the same graph as that of an operation with any other speed and torque, in
/// proportion.
#[test]
fn a_state_without_an_operation_is_shown_per_unit_of_its_input() {
    let text = common::example("zf-8hp70");
    let bare = text.split("[[operation]]").next().unwrap();
    let train = Train::from_toml(bare).unwrap();
    let of_state = |state: &str| Selection { operation: None, state: Some(state.into()) };
    let unit = &flows(&train, &of_state("3")).unwrap().operations[0];
    assert_eq!((unit.unit.as_deref(), unit.state.as_deref()), (Some("input"), Some("3")));
    check("unit", &unit.solutions[0]);
    let with = format!(
        "{bare}\n[[operation]]\nname = 'x'\nstate = '3'\nspeeds = {{ input = '10 rad/s' }}\ntorques = {{ input = '20 N m' }}\n"
    );
    let same = &flows(&Train::from_toml(&with).unwrap(), &of_state("3")).unwrap().operations[0];
    assert_eq!(same.unit, None);
    let (a, b) = (&unit.solutions[0], &same.solutions[0]);
    assert_eq!(a.efficiency_exact, b.efficiency_exact);
    assert!(a.efficiency_exact.is_some() && a.input_power_w == 1.0 && b.input_power_w == 200.0);
    assert_eq!(a.edges.len(), b.edges.len());
    for (x, y) in a.edges.iter().zip(&b.edges) {
        assert!((200.0 * x.power_w - y.power_w).abs() < 1e-9, "{} to {}", x.from, x.to);
    }
    // Every state where none is named.
    let all = flows(&train, &Selection::default()).unwrap();
    assert_eq!(all.operations.len(), train.states().len());
    assert!(all.operations.iter().all(|o| o.unit.is_some()));
}

/// With two freedoms one speed settles nothing, and the refusal says what would.
#[test]
fn a_state_with_two_freedoms_needs_an_operation() {
    let text = common::example("esmail-fig1");
    let bare = text.split("[[shift_element]]").next().unwrap();
    let wrong = flows(&Train::from_toml(bare).unwrap(), &Selection::default()).unwrap_err().to_string();
    assert!(wrong.contains("2 degrees of freedom"), "{wrong}");
    assert!(wrong.contains("2 independent speeds and 1 torque or power"), "{wrong}");
}

/// A small generator of numbers, so that every run has the same trains.
/// `k` stepped sets on `k + 2` members, one of them held; renamed and reordered on demand.
fn random(seed: u64, names: &dyn Fn(usize) -> String, sort: bool) -> Option<Train> {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
    let k = 1 + dice.below(4) as usize;
    let all: Vec<String> = (0..k + 2).map(names).collect();
    let mut listed: Vec<&str> = all.iter().map(String::as_str).collect();
    if sort {
        listed.sort_unstable();
    }
    let mut b = Train::builder("random").members(listed.iter().copied()).terminals([all[0].as_str(), all[1].as_str()]);
    for j in 0..k {
        let mut own: Vec<usize> = (0..k + 2).collect();
        let mut draw = || own.remove(dice.below(own.len() as u64) as usize);
        let [x, y, c] = [draw(), draw(), draw()];
        let mut teeth = |low: u64, high: u64| (low + dice.below(high - low)) as i64;
        let [zx, zy, p, q] = [teeth(12, 90), teeth(12, 90), teeth(12, 60), teeth(12, 60)];
        let eta = 0.9 + dice.below(100) as f64 / 1000.0;
        let set = SetSpec::stepped(format!("P{j}"), &all[c]).sun(&all[x], zx, p);
        let set = if dice.below(2) == 0 { set.ring(&all[y], zy + q, q) } else { set.sun(&all[y], zy, q) };
        b = b.set(set.mesh_efficiency(eta));
    }
    let operation = OperationSpec::new("load")
        .speed(&all[0], AngularSpeed::rpm(1000.0))
        .torque(&all[0], Torque::n_m(100.0))
        .fixed(&all[k + 1]);
    b.operation(operation).build().ok()
}

fn solutions(train: &Train) -> Vec<SolutionReport> {
    let Ok(analysis) = analyze(train, &Selection::default()) else { return vec![] };
    let o = &analysis.operations[0];
    o.solutions.iter().chain(&o.dissipative_solutions).cloned().collect()
}

#[test]
fn prop_random_trains_balance_and_names_do_not_matter() {
    let (mut count, mut rounds) = (0, 0);
    for seed in 0..300 {
        let plain = |m: usize| format!("m{m}");
        let Some(train) = random(seed, &plain, false) else { continue };
        let renamed = |m: usize| format!("{}{m}", ['q', 'c', 'x', 'a', 'k', 'f'][m % 6]);
        let other = random(seed, &renamed, true).expect("the same train");
        for (a, b) in solutions(&train).iter().zip(&solutions(&other)) {
            let (a, b) = (hypergraph(&train, a), hypergraph(&other, b));
            check(&format!("seed {seed}"), &a);
            check(&format!("seed {seed}, renamed"), &b);
            let size = a.edges.iter().fold(1e-30f64, |x, e| x.max(e.power_w));
            let powers = |g: &Hypergraph| {
                let mut all: Vec<f64> = g.edges.iter().map(|e| e.power_w).collect();
                all.sort_by(f64::total_cmp);
                all
            };
            let (x, y) = (powers(&a), powers(&b));
            assert_eq!(x.len(), y.len(), "seed {seed}");
            assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() <= 1e-9 * size), "seed {seed}");
            count += 1;
            rounds += usize::from(!a.loops.is_empty());
        }
    }
    assert!(count > 100 && rounds > 10, "{count} {rounds}");
}

/// Bearings of an ordinary pair carry its tooth forces, and one sits between two turning shafts: what their
/// friction takes from the mesh leaves every node in balance.
#[test]
fn bearings_that_the_teeth_load_balance_on_central_shafts() {
    let text = r#"
format = 1
name = "pair with bearings"
members = ["a", "b"]
terminals = ["a", "b"]
[oil]
name = "VG 100"
viscosity_40 = "100 mm^2/s"
viscosity_100 = "11 mm^2/s"
density_15 = "880 kg/m^3"
temperature = "60 degC"
supply = "jet"
[[mesh]]
name = "M"
gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 60 }]
geometry = { module = "4 mm", width = "50 mm", helix = "15 deg", roughness = "0.6 um" }
[[bearing]]
name = "A"
members = ["a"]
designation = "NU 206"
count = 2
[[bearing]]
name = "B"
members = ["b", "a"]
designation = "6210"
[[operation]]
name = "load"
speeds = { a = "1500 rpm" }
torques = { a = "100 N m" }
"#;
    let g = flow_of(text, "load");
    check("pair", &g);
    let a = g.node("bearing:A").unwrap();
    assert!(a.loss_w > 1.0 && a.power_out_w == 0.0);
    // Between two shafts: power in at one, out at the other or lost.
    assert!(g.node("bearing:B").unwrap().loss_w > 0.0);
    let contained = analyze(&Train::from_toml(text).unwrap(), &Selection::default()).unwrap().operations[0].solutions
        [0]
    .drags
    .iter()
    .filter(|d| d.contained_in.is_some())
    .count();
    // The bearing between a gear and the carrier of its mesh, the frame here; the one between the shafts is a drag.
    assert!(contained >= 1, "{contained}");
}
