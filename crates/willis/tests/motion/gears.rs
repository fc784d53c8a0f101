//! The ordinary work of a transmission, with each automatic of the examples: every gear drives away, runs on a test
//! bench, holds, lets go, shifts and reverses.

use std::fmt::Write as _;

use nalgebra::{DMatrix, DVector};
use willis::dynamics::{Options, Outcome};
use willis::exact::Rational;
use willis::train::{MemberKind, ShiftElementKind, Train};

use crate::common::example;
use crate::reference::{Element, Mesh, Reference};
use crate::rows::run;

/// Every example with a shift table of an automatic.
const AUTOMATICS: [&str; 12] = [
    "aisin-ab80",
    "aisin-tl-80sn",
    "ford-10r80",
    "ford-aod",
    "mercedes-9g-tronic",
    "mercedes-w5a580",
    "simpson-ford-c4",
    "zf-4hp22",
    "zf-5hp24",
    "zf-6hp26",
    "zf-8hp-gen4",
    "zf-8hp70",
];

/// A train as numbers, which owes nothing to how it was written.
struct Gearbox {
    name: &'static str,
    /// The frame first.
    members: Vec<String>,
    planets: Vec<bool>,
    /// Gear 1, gear 2, carrier; teeth, internal below 0; efficiencies.
    meshes: Vec<([usize; 3], [f64; 2], [f64; 2])>,
    elements: Vec<(String, [usize; 2])>,
    one_way: Vec<i8>,
    states: Vec<(String, Vec<usize>)>,
    ends: [usize; 2],
    /// As the example writes it, without what is to be done with it.
    sets: toml::Table,
}

impl Gearbox {
    fn new(name: &'static str) -> Self {
        let text = example(name);
        let train = Train::from_toml(&text).unwrap();
        let mut sets: toml::Table = toml::from_str(&text).unwrap();
        for part in ["operation", "scenario", "study", "inertias", "rotor"] {
            sets.remove(part);
        }
        // Planets of which only the suns and rings are known have parts of a tooth; only ratios matter.
        let scale = 12;
        let teeth = |g: &willis::train::Gear| {
            (&g.teeth * &Rational::from(scale)).to_f64() * if g.internal { -1.0 } else { 1.0 }
        };
        Self {
            name,
            members: train.members().iter().map(|m| m.name.replace('.', "-")).collect(),
            planets: train.members().iter().map(|m| m.kind == MemberKind::Planet).collect(),
            meshes: (train.meshes().iter())
                .map(|m| {
                    assert!(m.same_sense == m.gears.iter().any(|g| g.internal) && !m.bevel, "{name}");
                    let [a, b] = &m.gears;
                    let eta = [m.efficiency.forward.to_f64(), m.efficiency.backward.to_f64()];
                    ([a.member.index(), b.member.index(), m.carrier.index()], [teeth(a), teeth(b)], eta)
                })
                .collect(),
            elements: train.shift_elements().iter().map(|e| (e.name.clone(), e.members.map(|m| m.index()))).collect(),
            one_way: (train.shift_elements().iter())
                .map(|e| if e.kind == ShiftElementKind::OneWay { e.blocks } else { 0 })
                .collect(),
            states: (train.states().iter())
                .map(|s| (s.name.clone(), s.engaged.iter().map(|e| e.index()).collect()))
                .collect(),
            ends: [train.input().unwrap().index(), train.output().unwrap().index()],
            sets,
        }
    }

    /// Inertias of all members, kg m²; planets have none.
    fn inertias(&self, output: f64) -> Vec<f64> {
        let of = |m: usize| match m {
            0 => 0.0,
            m if m == self.ends[0] => 0.1,
            m if m == self.ends[1] => output,
            m if self.planets[m] => 0.0,
            _ => 0.02,
        };
        (0..self.members.len()).map(of).collect()
    }

    /// The train as a file; the capacity of every shift element, N m, none if rigid.
    fn text(&self, mesh_by_mesh: bool, capacity: Option<f64>, output: f64, scenario: &str) -> String {
        let inertias: toml::Table = (self.members.iter().zip(self.inertias(output)))
            .filter(|(_, j)| *j > 0.0)
            .map(|(m, j)| (m.clone(), format!("{j} kg m^2").into()))
            .collect();
        let head = toml::to_string(&toml::Table::from_iter([("inertias".to_owned(), inertias.into())])).unwrap();
        let mut text = if mesh_by_mesh { self.core(capacity) } else { self.as_sets(capacity) };
        text.push_str(&head);
        text.push_str(scenario);
        text
    }

    fn as_sets(&self, capacity: Option<f64>) -> String {
        let mut sets = self.sets.clone();
        for element in sets["shift_element"].as_array_mut().unwrap() {
            let element = element.as_table_mut().unwrap();
            element.remove("capacity");
            if let Some(c) = capacity {
                element.insert("capacity".into(), format!("{c} N m").into());
            }
        }
        toml::to_string(&sets).unwrap()
    }

    fn core(&self, capacity: Option<f64>) -> String {
        let mut t = String::from("format = 1\nname = \"mesh by mesh\"\n");
        let names: Vec<String> = self.members[1..].iter().map(|m| format!("{m:?}")).collect();
        writeln!(t, "members = [{}]", names.join(", ")).unwrap();
        writeln!(t, "terminals = [{:?}, {:?}]", self.members[self.ends[0]], self.members[self.ends[1]]).unwrap();
        for (bodies, teeth, eta) in &self.meshes {
            let gear = |k: usize| {
                let internal = if teeth[k] < 0.0 { ", internal = true" } else { "" };
                format!("{{ member = {:?}, teeth = {}{internal} }}", self.members[bodies[k]], teeth[k].abs())
            };
            writeln!(t, "[[mesh]]\ngears = [ {}, {} ]", gear(0), gear(1)).unwrap();
            if bodies[2] != 0 {
                writeln!(t, "carrier = {:?}", self.members[bodies[2]]).unwrap();
            }
            writeln!(t, "efficiency = {{ forward = {}, backward = {} }}", eta[0], eta[1]).unwrap();
        }
        for ((name, bodies), blocks) in self.elements.iter().zip(&self.one_way) {
            let members: Vec<String> =
                bodies.iter().filter(|m| **m != 0).map(|m| format!("{:?}", self.members[*m])).collect();
            let kind = match (blocks, members.len()) {
                (0, 1) => "brake",
                (0, _) => "clutch",
                _ => "one-way",
            };
            writeln!(t, "[[shift_element]]\nname = {name:?}\nkind = {kind:?}\nmembers = [{}]", members.join(", "))
                .unwrap();
            if *blocks != 0 {
                let sense = if *blocks > 0 { "forward" } else { "backward" };
                writeln!(t, "blocks = {sense:?}").unwrap();
            }
            if let Some(c) = capacity {
                writeln!(t, "capacity = \"{c} N m\"").unwrap();
            }
        }
        for (name, engaged) in &self.states {
            let engaged: Vec<String> = engaged.iter().map(|e| format!("{:?}", self.elements[*e].0)).collect();
            writeln!(t, "[[state]]\nname = {name:?}\nengaged = [{}]", engaged.join(", ")).unwrap();
        }
        t
    }

    /// Speeds of all members in a state for one turning rad/s of the output; none if the state does not join them all.
    fn speeds(&self, state: usize, output: f64) -> Option<Vec<f64>> {
        let n = self.members.len();
        let mut rows: Vec<Vec<(usize, f64)>> = vec![vec![(0, 1.0)]];
        for (bodies, teeth, _) in &self.meshes {
            let [a, b, c] = *bodies;
            rows.push(vec![(a, teeth[0]), (b, teeth[1]), (c, -teeth[0] - teeth[1])]);
        }
        for &e in &self.states[state].1 {
            let [a, b] = self.elements[e].1;
            rows.push(vec![(a, 1.0), (b, -1.0)]);
        }
        rows.push(vec![(self.ends[1], 1.0)]);
        let mut m = DMatrix::zeros(rows.len(), n);
        for (i, row) in rows.iter().enumerate() {
            row.iter().for_each(|(k, x)| m[(i, *k)] += x);
        }
        let mut right = DVector::zeros(rows.len());
        right[rows.len() - 1] = output;
        let svd = m.clone().svd(true, true);
        let mut x = DVector::zeros(n);
        for _ in 0..3 {
            x += svd.solve(&(&right - &m * &x), 1e-9).unwrap();
        }
        (svd.rank(1e-9) == n).then(|| x.iter().copied().collect())
    }

    fn initial(&self, state: usize, output: f64) -> Option<String> {
        let speeds = self.speeds(state, output)?;
        let list: Vec<String> = (1..self.members.len())
            .filter(|m| !self.planets[*m])
            .map(|m| {
                format!("{:?} = \"{} rad/s\"", self.members[m], if speeds[m].abs() < 1e-9 { 0.0 } else { speeds[m] })
            })
            .collect();
        Some(format!("initial_speeds = {{ {} }}\n", list.join(", ")))
    }

    fn end(&self, k: usize) -> &str {
        &self.members[self.ends[k]]
    }
}

/// What each run of a kind gave, for all automatics, states, capacities, ways to write them, and output inertias.
fn every(kind: &str, scenario: impl Fn(&Gearbox, usize) -> Option<String>) {
    let mut bad = vec![];
    let mut runs = 0;
    let clock = std::time::Instant::now();
    for name in AUTOMATICS {
        let train = Gearbox::new(name);
        for state in 0..train.states.len() {
            let Some(scenario) = scenario(&train, state) else { continue };
            let state = &train.states[state].0;
            for capacity in [None, Some(20_000.0), Some(3000.0)] {
                for mesh_by_mesh in [false, true] {
                    for output in [0.02, 1.0, 200.0] {
                        let text = train.text(mesh_by_mesh, capacity, output, &scenario);
                        let (_, report) = run(&text, &Options::default());
                        runs += 1;
                        if report.outcome != Outcome::Finished {
                            bad.push(format!(
                                "{name} {state} {capacity:?} {mesh_by_mesh} {output}: {:?} at {}",
                                report.outcome, report.end_s
                            ));
                        }
                    }
                }
            }
        }
        eprintln!("{name} {:.1} s", clock.elapsed().as_secs_f64());
    }
    assert!(bad.is_empty(), "{kind}: {} of {runs} end early:\n{}", bad.len(), bad.join("\n"));
}

/// A source of torque, N m, by points.
fn torque(member: &str, points: &[[f64; 2]]) -> String {
    let points: Vec<String> = points.iter().map(|[t, m]| format!("[\"{t} s\", \"{m} N m\"]")).collect();
    format!(
        "[[scenario.source]]\nmember = {member:?}\ntorque = {{ type = \"table\", points = [ {} ] }}\n",
        points.join(", ")
    )
}

fn vehicle(member: &str) -> String {
    format!(
        "[[scenario.source]]\nmember = {member:?}\nvehicle = {{ mass = \"1800 kg\", wheel_radius = \"0.33 m\", final_drive = 3.2, \
         rolling = 0.012, drag_area = \"0.6 m^2\" }}\n"
    )
}

fn head(g: &Gearbox, state: usize, duration: f64) -> String {
    format!("[[scenario]]\nname = \"run\"\nduration = \"{duration} s\"\nstate = {:?}\n", g.states[state].0)
}

#[test]
fn every_gear_drives_away() {
    every("drive away", |g, state| Some(head(g, state, 1.0) + &torque(g.end(0), &[[0.0, 0.0], [1.0, 300.0]])));
}

#[test]
fn every_gear_stops_and_goes() {
    let points =
        [[0.0, 0.0], [1.0, 250.0], [2.0, 250.0], [2.2, -200.0], [3.0, -200.0], [4.0, 0.0], [5.0, 0.0], [6.0, 200.0]];
    every("stop and go", |g, state| Some(head(g, state, 6.0) + &torque(g.end(0), &points) + &vehicle(g.end(1))));
}

#[test]
fn every_gear_holds_on_a_hill_and_rolls_when_let_go() {
    every("hill hold", |g, state| {
        let hill = torque(g.end(1), &[[0.0, -100.0], [2.0, -100.0]]);
        Some(head(g, state, 2.0) + &hill + &torque(g.end(0), &[[0.0, 200.0], [0.5, 200.0], [1.0, 0.0], [2.0, 0.0]]))
    });
}

#[test]
fn every_gear_coasts_to_rest_and_reverses() {
    every("coast", |g, state| {
        Some(
            head(g, state, 3.0)
                + &g.initial(state, 40.0)?
                + &torque(g.end(0), &[[0.0, 0.0], [0.5, -200.0], [3.0, -200.0]]),
        )
    });
}

#[test]
fn every_gear_runs_on_a_test_bench() {
    every("bench", |g, state| {
        let speed = 100.0;
        let brake = format!("[[scenario.source]]\nmember = {:?}\nspeed = \"{speed} rad/s\"\n", g.end(1));
        Some(
            head(g, state, 0.1) + &g.initial(state, speed)? + &torque(g.end(0), &[[0.0, 300.0], [0.1, 300.0]]) + &brake,
        )
    });
}

/// A value between points.
fn between(points: &[[f64; 2]], t: f64) -> f64 {
    let Some(k) = points.iter().position(|p| p[0] > t) else { return points.last().map_or(0.0, |p| p[1]) };
    let Some([[t0, a], [t1, b]]) = k.checked_sub(1).map(|i| [points[i], points[k]]) else { return points[0][1] };
    a + (b - a) * (t - t0) / (t1 - t0)
}

impl Gearbox {
    fn reference(&self, capacity: Option<f64>, output: f64) -> Reference {
        Reference {
            inertias: self.inertias(output),
            meshes: (self.meshes.iter())
                .map(|&(bodies, teeth, efficiency)| Mesh { bodies, teeth, efficiency })
                .collect(),
            elements: self.elements.iter().map(|&(_, bodies)| Element { bodies, capacity }).collect(),
        }
    }
}

#[test]
fn every_swap_of_one_element_comes_to_its_end() {
    let mut bad = vec![];
    let mut runs = 0;
    let mut worst = 0.0f64;
    let clock = std::time::Instant::now();
    let points = [[0.0, 150.0], [2.0, 150.0]];
    for name in AUTOMATICS {
        let g = Gearbox::new(name);
        for from in 0..g.states.len() {
            let Some(unit) = g.speeds(from, 1.0) else { continue };
            let ratio = unit[g.ends[0]];
            let start = if ratio == 0.0 { 0.0 } else { 200.0 / ratio };
            let Some(initial) = g.initial(from, start) else { continue };
            let speeds = g.speeds(from, start).unwrap();
            for to in 0..g.states.len() {
                let swapped = g.states[from].1.iter().filter(|e| !g.states[to].1.contains(e)).count();
                if from == to || swapped != 1 {
                    continue;
                }
                for capacity in [20_000.0, 3000.0] {
                    let output = 20.0;
                    let reference = g.reference(Some(capacity), output).run(
                        &speeds,
                        2.0,
                        1000,
                        |t| {
                            (0..g.members.len())
                                .map(|m| if m == g.ends[0] { between(&points, t) } else { 0.0 })
                                .collect()
                        },
                        |t| {
                            let [a, b] = [from, to].map(|s| &g.states[s].1);
                            (0..g.elements.len())
                                .map(|e| {
                                    let of = |s: &Vec<usize>| f64::from(u8::from(s.contains(&e)));
                                    between(&[[0.5, of(a)], [0.7, of(b)]], t)
                                })
                                .collect()
                        },
                    );
                    for mesh_by_mesh in [false, true] {
                        let scenario = format!(
                            "[[scenario]]\nname = \"run\"\nduration = \"2 s\"\ngears = [ [\"0 s\", {:?}], [\"0.5 s\", {:?}] ]\n\
                             shift_time = \"0.2 s\"\n{initial}",
                            g.states[from].0, g.states[to].0
                        ) + &torque(g.end(0), &points);
                        let text = g.text(mesh_by_mesh, Some(capacity), output, &scenario);
                        let (rows, report) = run(&text, &Options::default());
                        if let Ok(w) = std::env::var("WHICH")
                            && w == format!(
                                "{name} {} to {} {capacity} {mesh_by_mesh}",
                                g.states[from].0, g.states[to].0
                            )
                        {
                            std::fs::write("/tmp/which.toml", &text).unwrap();
                            for e in &rows.events {
                                eprintln!("{e:?}");
                            }
                        }
                        runs += 1;
                        let what =
                            format!("{name} {} to {} {capacity} {mesh_by_mesh}", g.states[from].0, g.states[to].0);
                        if report.outcome != Outcome::Finished {
                            bad.push(format!("{what}: {:?} at {}", report.outcome, report.end_s));
                        }
                        let most = reference.iter().fold(0.0f64, |m, w| m.max(w.abs()));
                        for (m, name) in g.members.iter().enumerate().filter(|(m, _)| *m > 0 && !g.planets[*m]) {
                            let found = *report.final_speeds_rad_s.get(name).unwrap();
                            let off = (found - reference[m]).abs() / most;
                            worst = worst.max(off);
                            if off > 1e-2 {
                                bad.push(format!("{what}: {name} {found} against {}", reference[m]));
                            }
                        }
                    }
                }
            }
        }
        eprintln!("{name} {:.1} s {runs} {worst:.2e}", clock.elapsed().as_secs_f64());
    }
    assert!(bad.is_empty(), "{} of {runs} end early:\n{}", bad.len(), bad.join("\n"));
}
