//! Levers: speeds on straight lines, forces in balance at the points that friction displaces.

use willis::Train;
use willis::train::SetSpec;
use willis_figure::{Lever, LeverBar, LeverRequest, LeverRole, lever};

use crate::common::train as example;
use crate::trains::examples;

/// Every lever that an example has.
fn levers() -> Vec<(String, Lever)> {
    let mut all = Vec::new();
    for (name, train) in examples() {
        let operations = train.operations().iter().map(|o| LeverRequest::Operation(o.name.clone()));
        let states = train.states().iter().map(|s| LeverRequest::State(s.name.clone()));
        for request in operations.chain(states).chain([LeverRequest::First, LeverRequest::EveryState]) {
            if let Ok(l) = lever(&train, &request) {
                all.push((format!("{name}, {request:?}"), l));
            }
        }
    }
    assert!(all.len() > 150, "{}", all.len());
    all
}

fn size(all: impl Iterator<Item = f64>) -> f64 {
    all.fold(0.0, |a: f64, x| a.max(x.abs()))
}

/// How far the points of a case are from one line, over the largest speed.
fn bend(bar: &LeverBar, case: usize) -> f64 {
    let points: Vec<[f64; 2]> = bar.nodes.iter().filter_map(|n| n.speeds[case].map(|w| [n.position, w])).collect();
    let Some(low) = points.iter().min_by(|a, b| a[0].total_cmp(&b[0])) else { return 0.0 };
    let high = points.iter().max_by(|a, b| a[0].total_cmp(&b[0])).unwrap();
    let largest = size(points.iter().map(|p| p[1])).max(1e-300);
    let length = high[0] - low[0];
    size(points.iter().map(|p| {
        let along = if length == 0.0 { 0.0 } else { (p[0] - low[0]) / length };
        p[1] - (low[1] + (high[1] - low[1]) * along)
    })) / largest
}

#[test]
fn speeds_of_a_lever_lie_on_a_straight_line() {
    for (what, l) in levers() {
        for bar in &l.bars {
            for case in 0..l.cases.len() {
                let bend = bend(bar, case);
                assert!(bend < 1e-9, "{what}: {} is bent by {bend:e}", bar.sets[0].name);
            }
        }
    }
}

#[test]
fn torques_of_a_set_balance_at_the_displaced_points() {
    let (mut seen, mut friction) = (0, 0);
    for (what, l) in levers() {
        for set in l.bars.iter().flat_map(|b| &b.sets) {
            let largest = size(set.pulls.iter().map(|p| p.torque)).max(1e-300);
            let sum: f64 = set.pulls.iter().map(|p| p.torque).sum();
            assert!(sum.abs() < 1e-9 * largest, "{what}: torques on {} add up to {sum:e}", set.name);
            let arm = size(set.pulls.iter().map(|p| p.point)).max(1.0);
            let moment: f64 = set.pulls.iter().map(|p| p.torque * p.point).sum();
            assert!(moment.abs() < 1e-9 * largest * arm, "{what}: moments on {} add up to {moment:e}", set.name);
            seen += set.pulls.len();
            friction += set.pulls.iter().filter(|p| (p.displacement - 1.0).abs() > 1e-9).count();
        }
    }
    assert!(seen > 500 && friction > 200, "{seen} {friction}");
}

fn reducer(efficiency: f64) -> Train {
    Train::builder("reducer")
        .members(["sun", "ring", "carrier"])
        .terminals(["sun", "carrier"])
        .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").planet(20, 4).mesh_efficiency(efficiency))
        .shift_element(willis::train::ShiftElementSpec::brake("B", "ring"))
        .state(willis::train::StateSpec::new("1", ["B"]))
        .build()
        .unwrap()
}

#[test]
fn without_losses_forces_act_at_the_true_points() {
    let l = lever(&reducer(1.0), &LeverRequest::First).unwrap();
    let bar = &l.bars[0];
    let moment: f64 = bar.sets[0].pulls.iter().map(|p| p.torque * bar.nodes[p.node].position).sum();
    assert!(moment.abs() < 1e-12);
    assert!(bar.sets[0].pulls.iter().all(|p| (p.displacement - 1.0).abs() < 1e-12));
    assert_eq!((&l.unit, l.cases[0].held.as_slice()), (&Some("sun".into()), &["frame".into(), "ring".into()][..]));
}

#[test]
fn a_driving_gear_moves_towards_the_carrier_and_a_driven_one_away() {
    let l = lever(&reducer(0.98), &LeverRequest::First).unwrap();
    let bar = &l.bars[0];
    let of = |role: LeverRole| {
        let p = bar.sets[0].pulls.iter().find(|p| bar.nodes[p.node].roles == [role]).unwrap();
        (p.displacement, p.torque)
    };
    assert!((of(LeverRole::Sun).0 - 0.98).abs() < 1e-12);
    assert!((of(LeverRole::Ring).0 - 1.0 / 0.98).abs() < 1e-12);
    assert!((of(LeverRole::Sun).1 - 1.0).abs() < 1e-12);
    // T_ring/T_sun = η² z_ring/z_sun, and the carrier takes both.
    let ring = 0.98 * 0.98 * 70.0 / 30.0;
    assert!((of(LeverRole::Ring).1 - ring).abs() < 1e-12);
    assert!((of(LeverRole::Carrier).1 + 1.0 + ring).abs() < 1e-12);
}

#[test]
fn distances_are_as_the_basic_ratio() {
    // i0 = −z_ring/z_sun: the distance from carrier to sun over that from carrier to ring.
    let train = example("zf-8hp70");
    let l = lever(&train, &LeverRequest::EveryState).unwrap();
    for (set, ratio) in [("P1", 96.0 / 48.0), ("P2", 96.0 / 48.0), ("P3", 111.0 / 69.0), ("P4", 85.0 / 23.0)] {
        let bar = l.bars.iter().find(|b| b.sets[0].name == set).unwrap();
        let at = |role| bar.nodes.iter().find(|n| n.roles == [role]).unwrap().position;
        let carrier = at(LeverRole::Carrier);
        let [sun, ring] = [LeverRole::Sun, LeverRole::Ring].map(|r| at(r) - carrier);
        assert!((sun / ring + ratio).abs() < 1e-9, "{set}: {sun} {ring}");
    }
}

#[test]
fn linked_nodes_move_alike_and_stand_level() {
    let mut links = 0;
    for (what, l) in levers() {
        for link in &l.links {
            let nodes: Vec<_> = link.points.iter().map(|[b, n]| &l.bars[*b].nodes[*n]).collect();
            for n in &nodes[1..] {
                assert_eq!(n.speeds, nodes[0].speeds, "{what}: {}", link.member);
                assert!(!l.level || (n.position - nodes[0].position).abs() < 1e-9, "{what}: {}", link.member);
            }
            links += 1;
        }
    }
    assert!(links > 20);
}

#[test]
fn two_sets_that_share_two_members_are_one_lever() {
    let simpson = lever(&example("simpson-ford-c4"), &LeverRequest::EveryState).unwrap();
    assert_eq!(simpson.bars.len(), 1);
    let bar = &simpson.bars[0];
    assert_eq!(bar.sets.len(), 2);
    assert_eq!(bar.nodes.iter().filter(|n| n.roles != [LeverRole::Planet]).count(), 4);
    // Sets that share one member each stay apart.
    assert_eq!(lever(&example("zf-8hp70"), &LeverRequest::EveryState).unwrap().bars.len(), 4);
}

#[test]
fn a_train_with_two_freedoms_is_shown_in_its_first_operation_or_asks_for_one() {
    let prius = lever(&example("prius-p112"), &LeverRequest::First).unwrap();
    assert!(prius.title.ends_with("acceleration, mg1 generates"), "{}", prius.title);
    let free = Train::builder("free")
        .members(["s", "r", "c"])
        .terminals(["s", "c"])
        .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4))
        .build()
        .unwrap();
    let why = lever(&free, &LeverRequest::First).unwrap_err().to_string();
    assert!(why.contains("2 degrees of freedom") && why.contains("[[operation]]"), "{why}");
    let why = lever(&free, &LeverRequest::EveryState).unwrap_err().to_string();
    assert!(why.contains("no states"), "{why}");
    let why = lever(&free, &LeverRequest::Operation("x".into())).unwrap_err().to_string();
    assert!(why.contains("no operation `x`"), "{why}");
}

#[test]
fn every_example_has_levers() {
    for (name, train) in examples() {
        let l = match lever(&train, &LeverRequest::First) {
            Ok(l) => l,
            // Speeds that only a run settles.
            Err(e) if train.operations().is_empty() => {
                assert!(e.to_string().contains("2 degrees of freedom"), "{name}: {e}");
                continue;
            }
            Err(e) => panic!("{name}: {e}"),
        };
        for n in l.bars.iter().flat_map(|b| &b.nodes) {
            assert!(n.position.is_finite() && n.number.is_finite(), "{name}: {}", n.member);
            if n.roles != [LeverRole::Planet] {
                assert!((-1e-9..=1.0 + 1e-9).contains(&n.position), "{name}: {} at {}", n.member, n.position);
            }
        }
    }
}

/// Two rings of 60 and 59 teeth stand 0.3 % of the lever apart: their marks cover each other, and only enlarged they are two.
#[test]
fn points_that_cover_each_other_are_drawn_apart_as_well() {
    use std::collections::BTreeMap;
    let (mut apart, mut enlarged) = (0, 0);
    for (name, train) in examples() {
        let Ok(l) = lever(&train, &LeverRequest::First) else { continue };
        let svg = willis_figure::draw_lever(&l);
        let document = roxmltree::Document::parse(&svg).expect("well-formed");
        // The heights of marks, by lever and word.
        let heights = |word: &str| {
            let mut all: BTreeMap<String, Vec<f64>> = BTreeMap::new();
            let marks = document.descendants().filter(|n| n.attribute("id").is_some_and(|id| id.starts_with(word)));
            for m in marks {
                let number = |n: roxmltree::Node<'_, '_>, key: &str| n.attribute(key)?.parse::<f64>().ok();
                let round = m.descendants().find_map(|d| number(d, "cy"));
                let square = m.descendants().find_map(|d| Some(number(d, "y")? + number(d, "height")? / 2.0));
                let mesh = m.attribute("data-mesh").expect("whose").to_owned();
                all.entry(mesh).or_default().extend(round.or(square));
            }
            all.values_mut().for_each(|v| v.sort_by(f64::total_cmp));
            all
        };
        let details = heights("detail-speed");
        for (mesh, all) in heights("speed") {
            let bar =
                l.bars.iter().find(|b| b.sets.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(" + ") == mesh);
            let mut places: Vec<f64> = bar
                .expect("its lever")
                .nodes
                .iter()
                .filter(|n| n.roles != [LeverRole::Planet])
                .map(|n| n.position)
                .collect();
            places.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
            let covered = all.windows(2).any(|w| w[1] - w[0] < 8.0) && places.len() > 1;
            let close = places.windows(2).any(|w| (w[0] - w[1]).abs() < 0.02);
            if covered && close {
                let own = details.get(&mesh).unwrap_or_else(|| panic!("{name}: {mesh} covers points of its own"));
                assert!(own.len() >= 2, "{name}: {mesh}");
                assert!(own.last().unwrap() - own[0] > 25.0, "{name}: {mesh}: {own:?}");
                enlarged += 1;
            } else {
                apart += 1;
            }
        }
    }
    assert!(enlarged >= 3 && apart > 40, "{enlarged} {apart}");
}
