//! Stick diagrams: their lines join what the train joins, and nothing else.

use willis::train::{FRAME, GearSpec, MeshSpec, SetSpec, ShiftElementSpec, Specification, Train};
use willis_figure::{JointKind, Place, Stick, TerminalDirection, stick};

use crate::trains::{examples, hard};

const NEAR: f64 = 1e-6;

/// A straight line between two places.
type Span = [Place; 2];

fn spans(points: &[Place]) -> impl Iterator<Item = Span> + '_ {
    points.windows(2).map(|w| [w[0], w[1]])
}

fn on(s: &Span, p: Place) -> bool {
    let [a, b] = s;
    let cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let inside = |k: usize| p[k] >= a[k].min(b[k]) - NEAR && p[k] <= a[k].max(b[k]) + NEAR;
    cross.abs() < NEAR && inside(0) && inside(1)
}

/// An end of one lies on the other.
fn touch(a: &Span, b: &Span) -> bool {
    b.iter().any(|p| on(a, *p)) || a.iter().any(|p| on(b, *p))
}

/// The parts of a member, each in one piece: lines, gears, its half of each joint, terminals.
fn parts(s: &Stick, member: Option<usize>) -> Vec<Vec<Span>> {
    let mut all: Vec<Vec<Span>> = match member {
        Some(k) => s.members[k].pieces.iter().map(|p| spans(&p.points).collect()).collect(),
        None => s.frame.iter().map(|p| spans(p).collect()).collect(),
    };
    all.extend(
        s.gears.iter().filter(|g| g.member == member).map(|g| g.stems.iter().chain(&g.faces).copied().collect()),
    );
    for j in &s.joints {
        all.extend((0..2).filter(|&k| j.members[k] == member).map(|k| vec![[j.ends[k], j.ends[k]]]));
    }
    all.extend(s.terminals.iter().filter(|t| Some(t.member) == member).map(|t| vec![[t.at, t.at]]));
    all
}

fn pieces_apart(parts: &[Vec<Span>]) -> usize {
    let mut group: Vec<usize> = (0..parts.len()).collect();
    for a in 0..parts.len() {
        for b in 0..a {
            if parts[a].iter().any(|x| parts[b].iter().any(|y| touch(x, y))) {
                let (from, to) = (group[a], group[b]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
        }
    }
    group.sort_unstable();
    group.dedup();
    group.len()
}

/// Everything that must hold of every picture.
fn check(train: &Train, s: &Stick) {
    let name = train.name();
    // Every member hangs together.
    for (k, m) in s.members.iter().enumerate() {
        let own = parts(s, Some(k));
        assert!(!own.is_empty(), "{name}: {} is not drawn", m.name);
        assert_eq!(pieces_apart(&own), 1, "{name}: {} is drawn in pieces", m.name);
    }
    // Lines of two members cross, and never run along or touch each other.
    let lines: Vec<(Option<usize>, Span)> = s
        .members
        .iter()
        .enumerate()
        .filter(|(_, m)| !m.planet)
        .flat_map(|(k, m)| m.pieces.iter().flat_map(move |p| spans(&p.points).map(move |x| (Some(k), x))))
        .chain(s.frame.iter().flat_map(|p| spans(p).map(|x| (None, x))))
        .collect();
    let mut found = 0;
    for (i, (a, x)) in lines.iter().enumerate() {
        for (b, y) in &lines[..i] {
            if a == b {
                continue;
            }
            let level = |s: &Span| s[0][1] == s[1][1];
            assert!(!touch(x, y), "{name}: lines of two members touch: {x:?} {y:?}");
            if level(x) != level(y) {
                let (h, v) = if level(x) { (x, y) } else { (y, x) };
                let at = [v[0][0], h[0][1]];
                if on(h, at) && on(v, at) {
                    found += 1;
                    let told = s.crossings.iter().any(|c| (c[0] - at[0]).abs() + (c[1] - at[1]).abs() < NEAR);
                    assert!(told, "{name}: a crossing at {at:?} that is not told");
                }
            }
        }
    }
    assert_eq!(found, s.crossings.len(), "{name}: crossings");
    // No line of one member touches a gear of another one; planets stand on pins.
    for (k, x) in &lines {
        for g in s.gears.iter().filter(|g| g.member != *k) {
            let planet = g.member.is_some_and(|m| s.members[m].planet);
            for y in g.faces.iter().chain(g.stems.iter().filter(|_| !planet)) {
                let apart = !touch(x, y) && !meets(x, y);
                assert!(apart, "{name}: a line of {k:?} touches the gear {} of {:?}", g.teeth, g.member);
            }
        }
    }
    // Each mesh once, with its two gears touching.
    assert_eq!(s.meshes.len(), train.meshes().len());
    for mesh in train.meshes() {
        let drawn: Vec<_> = s.meshes.iter().filter(|m| m.name == mesh.name).collect();
        let [drawn] = drawn[..] else { panic!("{name}: mesh {} is drawn {} times", mesh.name, drawn.len()) };
        for k in 0..2 {
            let gear = &s.gears[drawn.gears[k]];
            let member = gear.member.map_or(train.member_name(FRAME), |m| s.members[m].name.as_str());
            assert_eq!(member, train.member_name(mesh.gears[k].member));
            assert!(gear.faces.iter().any(|f| on(f, drawn.at)), "{name}: {} does not touch", mesh.name);
        }
    }
    // Each joint once, between its two members.
    let real = train.shift_elements().len() + train.shafts().len();
    assert_eq!(s.joints.len(), real, "{name}: joints");
    for j in &s.joints {
        for k in 0..2 {
            let at = [j.ends[k], j.ends[k]];
            let found = match j.members[k] {
                Some(_) => {
                    let lines = parts(s, j.members[k]);
                    lines.iter().flatten().any(|x| x[0] != x[1] && on(x, at[0]))
                        || s.terminals.iter().any(|t| Some(t.member) == j.members[k] && t.at == at[0])
                        || s.joints.iter().filter(|o| o.name != j.name).any(|o| o.ends.contains(&at[0]))
                }
                None => s.grounds.iter().any(|g| g.at == at[0]),
            };
            assert!(found, "{name}: {} does not reach {:?}", j.name, j.members[k]);
        }
        for (k, x) in &lines {
            let own = j.members.contains(k);
            assert!(own || !touch(x, &j.ends) && !meets(x, &j.ends), "{name}: a line passes through {}", j.name);
        }
    }
    // Terminals reach the border.
    for m in train.terminals() {
        let drawn: Vec<_> = s.terminals.iter().filter(|t| s.members[t.member].name == train.member_name(*m)).collect();
        assert_eq!(drawn.len(), 1, "{name}: terminal {}", train.member_name(*m));
        assert_eq!(drawn[0].at[0], if drawn[0].left { 0.0 } else { s.width });
    }
    let finite = |p: &Place| p.iter().all(|x| x.is_finite()) && (-1.0..=s.height + 1.0).contains(&p[1]);
    assert!(lines.iter().all(|(_, x)| x.iter().all(finite)));
}

/// Two lines cross in their midst.
fn meets(x: &Span, y: &Span) -> bool {
    let side = |s: &Span, p: Place| (s[1][0] - s[0][0]) * (p[1] - s[0][1]) - (s[1][1] - s[0][1]) * (p[0] - s[0][0]);
    side(x, y[0]) * side(x, y[1]) < -NEAR && side(y, x[0]) * side(y, x[1]) < -NEAR
}

#[test]
fn every_example_is_drawn_as_it_is_joined() {
    for (_, train) in examples() {
        let plain = stick(&train, None).expect("a picture");
        check(&train, &plain);
        for state in train.states() {
            let shown = stick(&train, Some(&state.name)).expect("a picture");
            check(&train, &shown);
            let engaged: Vec<_> =
                shown.joints.iter().filter(|j| j.engaged && j.kind != JointKind::Shaft).map(|j| &j.name).collect();
            assert_eq!(engaged.len(), state.engaged.len());
        }
    }
}

#[test]
fn regress_crossings_of_the_examples() {
    let most = |name: &str| match name {
        "aisin-ab80" | "aisin-tl-80sn" | "ford-10r80" => 1,
        _ => 0,
    };
    for (name, train) in examples() {
        let found = stick(&train, None).expect("a picture").crossings.len();
        assert_eq!(found, most(&name), "{name}");
    }
}

#[test]
fn loads_of_the_8hp70_in_first_gear() {
    let (_, train) = examples().into_iter().find(|(n, _)| n == "zf-8hp70").expect("the example");
    let s = stick(&train, Some("1")).expect("a picture");
    let of = |name: &str| s.members.iter().find(|m| m.name == name).expect("a member");
    // Input, clutch C and the sun of P4 drive the output; everything else stands or idles.
    let loaded: Vec<&str> =
        s.members.iter().filter(|m| m.loaded == Some(true) && !m.planet).map(|m| m.name.as_str()).collect();
    assert_eq!(loaded, ["input", "r3s4", "output"]);
    assert_eq!(of("c1r4").speed_ratio, Some(0.0));
    // 1/(1 + 85/23)
    assert_eq!(of("output").exact_speed_ratio.as_deref(), Some("23/108"));
    assert!(of("r3s4").pieces.iter().any(|p| p.loaded) && of("r3s4").pieces.iter().any(|p| !p.loaded));
}

#[test]
fn an_unknown_state_is_told_with_the_states_that_are_known() {
    let (_, train) = examples().into_iter().find(|(n, _)| n == "zf-8hp70").expect("the example");
    let wrong = stick(&train, Some("9")).unwrap_err().to_string();
    assert!(wrong.contains("no state `9`") && wrong.contains("1, 2, 3, 4, 5, 6, 7, 8, R"), "{wrong}");
}

/// Pseudo-random numbers of a linear congruence: the same trains in every run.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n as u64) as usize
    }

    /// Some members, all different; 0 is the frame.
    fn some(&mut self, n: usize, members: usize) -> Vec<usize> {
        let mut all: Vec<usize> = Vec::new();
        while all.len() < n {
            let m = if self.below(8) == 0 { 0 } else { 1 + self.below(members) };
            if !all.contains(&m) {
                all.push(m);
            }
        }
        all
    }
}

/// A train of so many sets of any kind, with clutches and brakes; `name` names its members.
fn random(seed: u64, sets: usize, name: &dyn Fn(usize) -> String) -> Result<Train, willis::Diagnostics> {
    let mut dice = Dice(seed);
    let members = sets + 2;
    let name = |m: usize| if m == 0 { "frame".to_owned() } else { name(m) };
    let mut names: Vec<String> = (1..=members).map(name).collect();
    names.push("wheel".to_owned());
    names.sort();
    let mut b: Specification = Train::builder(format!("random {seed}")).members(names.iter().map(String::as_str));
    b = b.terminals([name(1).as_str(), name(2).as_str()]);
    for k in 0..sets {
        let set = format!("P{k}");
        let z = 20 + dice.below(20) as i64;
        let p = 15 + dice.below(10) as i64;
        let kind = dice.below(8);
        let count = if kind < 4 { 3 } else { 4.min(members) };
        let mut m: Vec<String> = dice.some(count, members).into_iter().map(name).collect();
        // A set of four on three members: two of its gears are fixed.
        m.resize(m.len().max(if kind < 4 { 3 } else { 4 }), "frame".to_owned());
        let spec = match kind {
            0 | 1 => SetSpec::simple(set, (&m[0], z), (&m[1], z + 2 * p), &m[2]).planet(p, 3),
            2 => SetSpec::double_planet(set, (&m[0], z), (&m[1], z + 4 * p), &m[2]),
            3 => SetSpec::bevel(set, &m[0]).side(&m[1], z, false).side(&m[2], z, true),
            4 => SetSpec::stepped(set, &m[0]).sun(&m[1], z, p).ring(&m[2], z + 2 * p, p).sun(&m[3], z - 3, p + 3),
            5 => SetSpec::stepped(set, &m[0]).sun(&m[1], z, p).sun(&m[2], z - 2, p + 2),
            6 => SetSpec::stepped(set, &m[0]).ring(&m[1], z + 2 * p, p).ring(&m[2], z + 2 * p + 2, p + 2),
            _ => SetSpec::ravigneaux(set, (&m[0], z), (&m[1], z + 4), (&m[2], z + 4 + 2 * p), &m[3]),
        };
        b = b.set(spec.mesh_efficiency(0.99));
    }
    if dice.below(3) == 0 {
        // A member on an axis of its own, behind an ordinary pair.
        let from = 1 + dice.below(members);
        let ring = dice.below(3) == 0;
        let wheel = if ring { GearSpec::internal("wheel", 80) } else { GearSpec::external("wheel", 40) };
        b = b.mesh(MeshSpec::new(GearSpec::external(name(from), 20), wheel).named("pair")).terminals(["wheel"]);
    }
    for k in 0..dice.below(2 * sets) {
        let m = dice.some(2, members);
        b = b.shift_element(match m.contains(&0) {
            true => ShiftElementSpec::brake(format!("J{k}"), &name(m[0].max(m[1]))),
            false => ShiftElementSpec::clutch(format!("J{k}"), &name(m[0]), &name(m[1])),
        });
    }
    b.build()
}

#[test]
fn random_trains_are_drawn_as_they_are_joined() {
    let mut drawn = 0;
    for seed in 0..60 {
        let sets = 1 + seed as usize % 5;
        let Ok(train) = random(seed, sets, &|m| format!("m{m}")) else { continue };
        check(&train, &stick(&train, None).expect("a picture"));
        drawn += 1;
    }
    assert!(drawn > 30, "{drawn}");
}

#[test]
fn other_names_give_the_same_picture() {
    for seed in 0..20 {
        let sets = 1 + seed as usize % 4;
        let other = |m: usize| format!("x{}", 90 - m);
        let (Ok(a), Ok(b)) = (random(seed, sets, &|m| format!("m{m}")), random(seed, sets, &other)) else { continue };
        let mut s = stick(&a, None).expect("a picture");
        let t = stick(&b, None).expect("a picture");
        for (m, n) in s.members.iter_mut().zip(&t.members) {
            if !m.planet && m.name != "wheel" {
                let k: usize = m.name[1..].parse().expect("a number");
                assert_eq!(n.name, other(k));
            }
            m.name.clone_from(&n.name);
            // Colours follow the order of the members, which here follows the names.
            m.colour = n.colour;
        }
        for (m, n) in s.meshes.iter_mut().zip(&t.meshes) {
            m.name.clone_from(&n.name);
        }
        assert_eq!(s, t);
    }
}

/// Ends of the picture without a state: those on which all states agree, else none.
#[test]
fn arrows_of_a_train_with_states_are_those_of_its_states() {
    let all = examples().into_iter().chain(hard().into_iter().map(|(name, m)| (name.to_owned(), m.train().clone())));
    let (mut agreed, mut open) = (0, 0);
    for (name, train) in all.filter(|(_, t)| !t.states().is_empty()) {
        let ways = |state: Option<&str>| {
            let picture = stick(&train, state).unwrap();
            let own = picture.terminals.iter().filter_map(|t| Some((picture.members[t.member].name.clone(), t.way?)));
            let mut own: Vec<_> = own.collect();
            own.sort_by(|a, b| a.0.cmp(&b.0));
            own
        };
        let own: Vec<_> = train.states().iter().map(|s| ways(Some(&s.name))).collect();
        let plain = ways(None);
        if own.iter().all(|o| *o == own[0]) {
            assert_eq!(plain, own[0], "{name}");
            agreed += usize::from(!plain.is_empty());
        } else {
            assert_eq!(plain, [], "{name}: its states disagree");
            open += 1;
        }
        // A state that names its ends shows them.
        for (s, shown) in train.states().iter().zip(&own) {
            for (end, way) in [(s.input, TerminalDirection::In), (s.output, TerminalDirection::Out)] {
                let Some(end) = end.filter(|m| train.terminals().contains(m)) else { continue };
                assert!(shown.contains(&(train.member_name(end).to_owned(), way)), "{name} {}: {shown:?}", s.name);
            }
        }
    }
    assert!(agreed >= 8 && open >= 1, "{agreed} agree, {open} do not");
}

/// Powers of lines: what enters a branch leaves it, the input brings in one, and the output takes one.
#[test]
fn powers_of_lines_balance_at_every_branch() {
    let (mut branches, mut circles) = (0, 0);
    let all = examples().into_iter().chain(hard().into_iter().map(|(name, m)| (name.to_owned(), m.train().clone())));
    for (name, train) in all {
        let states: Vec<Option<&str>> = match train.states().is_empty() {
            true => vec![None],
            false => train.states().iter().map(|s| Some(s.name.as_str())).collect(),
        };
        for state in states {
            let picture = stick(&train, state).unwrap();
            circles += usize::from(picture.members.iter().flat_map(|m| &m.pieces).any(|p| p.circulates));
            for m in &picture.members {
                for p in m.pieces.iter().filter(|p| p.power.is_some()) {
                    let power = p.power.unwrap();
                    assert!(!p.circulates || power != 0.0, "{name} {state:?} {}", m.name);
                    assert!(
                        p.loaded || power.abs() < 1e-6,
                        "{name} {state:?} {}: {power} where nothing is loaded",
                        m.name
                    );
                }
                // At a dot that is no gear, joint or terminal the powers of the lines add to zero.
                for dot in &m.dots {
                    let gear = picture.gears.iter().any(|g| g.stems.iter().any(|s| near(s[0], *dot)));
                    let joint = picture.joints.iter().any(|j| j.ends.iter().any(|e| near(*e, *dot)));
                    let end = picture.terminals.iter().any(|t| near(t.at, *dot));
                    let lines = m.pieces.iter().filter_map(|p| {
                        let power = p.power?;
                        let (first, last) = (p.points[0], *p.points.last().unwrap());
                        Some(if near(last, *dot) {
                            power
                        } else if near(first, *dot) {
                            -power
                        } else {
                            0.0
                        })
                    });
                    if !gear && !joint && !end && m.pieces.iter().all(|p| p.power.is_some()) {
                        let sum: f64 = lines.sum();
                        assert!(sum.abs() < 1e-6, "{name} {state:?} {}: {sum} is left at a branch", m.name);
                        branches += 1;
                    }
                }
            }
            for t in picture.terminals.iter().filter(|t| t.way.is_some()) {
                let m = &picture.members[t.member];
                let own: Vec<f64> = m
                    .pieces
                    .iter()
                    .filter_map(|p| match near(p.points[0], t.at) {
                        true => p.power,
                        false => near(*p.points.last().unwrap(), t.at).then(|| p.power.map(|x| -x)).flatten(),
                    })
                    .collect();
                if let [one] = own[..]
                    && one != 0.0
                {
                    let expected = if t.way == Some(TerminalDirection::In) { 1.0 } else { -1.0 };
                    assert!((one - expected).abs() < 1e-6, "{name} {state:?} {}: {one}", m.name);
                }
            }
        }
    }
    assert!(branches > 50 && circles > 10, "{branches} branches, {circles} with circles");
}

fn near(a: Place, b: Place) -> bool {
    (a[0] - b[0]).abs() < NEAR && (a[1] - b[1]).abs() < NEAR
}

/// Of an ordinary pair the gear with more teeth is the larger one, by its ratio but for room for numbers.
#[test]
fn radii_of_ordinary_pairs_are_as_their_teeth() {
    let (_, model) = hard().into_iter().find(|(name, _)| *name == "pairs").unwrap();
    let picture = stick(model.train(), None).unwrap();
    let mut compared = 0;
    for m in &picture.meshes {
        let [a, b] = m.gears.map(|g| &picture.gears[g]);
        let radius = |g: &willis_figure::StickGear| (g.stems[0][0][1] - g.stems[0][1][1]).abs();
        let teeth = |g: &willis_figure::StickGear| g.teeth.parse::<f64>().unwrap();
        let drawn = radius(a) / (radius(a) + radius(b));
        let expected = (teeth(a) / (teeth(a) + teeth(b))).clamp(0.22, 0.78);
        assert!((drawn - expected).abs() < 1e-6, "{}: {drawn}, not {expected}", m.name);
        compared += 1;
    }
    assert_eq!(compared, 3);
}

/// 33 and 72 teeth leave 19.5 for the planet: no such wheel exists, so that none is named.
#[test]
fn teeth_that_no_wheel_has_are_left_out() {
    for (name, train) in examples() {
        let picture = stick(&train, None).unwrap();
        for g in &picture.gears {
            assert!(g.teeth.is_empty() || g.teeth.parse::<u64>().is_ok(), "{name}: `{}` teeth", g.teeth);
        }
    }
    let simpson = stick(&examples().into_iter().find(|(n, _)| n == "simpson-ford-c4").unwrap().1, None).unwrap();
    let planets = simpson.gears.iter().filter(|g| g.role == willis_figure::GearRole::Planet);
    assert!(planets.clone().count() == 2 && planets.clone().all(|g| g.teeth.is_empty()));
}

/// A program keeps the picture and changes its numbers: in every state everything stands where it stood, under the same ids.
#[test]
fn no_state_moves_anything() {
    use std::collections::BTreeMap;
    use willis_figure::{LeverLayout, LeverRequest, StickLayout, draw_stick};
    let mut seen = 0;
    for (name, train) in crate::trains::examples() {
        if train.states().len() < 2 {
            continue;
        }
        let layout = StickLayout::new(&train).unwrap_or_else(|e| panic!("{name}: {e}"));
        let levers = LeverLayout::new(&train).expect("it has gears");
        let places = |state: &str| {
            let data = layout.show(&train, Some(state)).expect("a state");
            let svg = draw_stick(&data);
            let document = roxmltree::Document::parse(&svg).expect("well-formed");
            // What is closed has a ground of its own, and what is loaded lies above the rest.
            let ids = document.descendants().filter_map(|n| n.attribute("id")).filter(|id| !id.starts_with("closed-"));
            let ids: Vec<String> = ids.map(str::to_owned).collect();
            let gears: Vec<_> = data.gears.iter().map(|g| (g.faces.clone(), g.stems.clone())).collect();
            let joints: Vec<_> = data.joints.iter().map(|j| (j.name.clone(), j.ends)).collect();
            (ids, gears, joints, data.axes.clone(), data.width)
        };
        let heights = |state: &str| {
            let lever = levers.show(&train, &LeverRequest::State(state.to_owned())).ok()?;
            let nodes = lever.bars.iter().flat_map(|b| &b.nodes).map(|n| (n.member.clone(), n.position));
            Some(nodes.map(|(m, p)| (m, p.to_bits())).collect::<BTreeMap<_, _>>())
        };
        let first = places(&train.states()[0].name);
        let high: Vec<_> = train.states().iter().filter_map(|s| heights(&s.name)).collect();
        for s in &train.states()[1..] {
            assert_eq!(places(&s.name), first, "{name}, state {}", s.name);
        }
        assert!(high.windows(2).all(|w| w[0] == w[1]), "{name}");
        seen += 1;
    }
    assert!(seen > 8, "{seen}");
}
