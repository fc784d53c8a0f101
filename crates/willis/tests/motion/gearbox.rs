//! A gearbox as numbers, what is done with it, and what must then be so.

use std::fmt::Write as _;

use nalgebra::{DMatrix, DVector};
use willis::dynamics::{Outcome, RunReport};
use willis::exact::Rational;
use willis::train::{MemberKind, ShiftElementKind, Train};

use crate::common::example;
use crate::reference::{Element, Mesh, Reference, Shaft};
use crate::rows::Rows;

/// A train as numbers, which owes nothing to how it was written.
pub struct Gearbox {
    /// The frame first.
    pub members: Vec<String>,
    pub planets: Vec<bool>,
    /// Gear 1, gear 2, carrier; teeth, internal below 0; efficiencies.
    pub meshes: Vec<([usize; 3], [f64; 2], [f64; 2])>,
    pub elements: Vec<(String, [usize; 2])>,
    pub one_way: Vec<i8>,
    /// Coulomb friction, N m, and N m s/rad.
    pub drags: Vec<([usize; 2], f64, f64)>,
    /// N m/rad and N m s/rad.
    pub shafts: Vec<([usize; 2], f64, f64)>,
    pub states: Vec<(String, Vec<usize>)>,
    pub ends: [usize; 2],
    /// As the example writes it, without what is to be done with it.
    pub sets: toml::Table,
}

impl Gearbox {
    pub fn new(name: &'static str) -> Self {
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
            drags: vec![],
            shafts: vec![],
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
    pub fn text(&self, mesh_by_mesh: bool, capacity: Option<f64>, output: f64, scenario: &str) -> String {
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
            if let Some(c) = capacity.filter(|_| *blocks == 0) {
                writeln!(t, "capacity = \"{c} N m\"").unwrap();
            }
        }
        let pair =
            |bodies: &[usize; 2]| format!("members = [{:?}, {:?}]", self.members[bodies[0]], self.members[bodies[1]]);
        for (k, (bodies, coulomb, viscous)) in self.drags.iter().enumerate() {
            let torques = format!("coulomb = \"{coulomb} N m\"\nviscous = \"{viscous} N m s/rad\"");
            writeln!(t, "[[drag]]\nname = \"D{k}\"\n{}\n{torques}", pair(bodies)).unwrap();
        }
        for (k, (bodies, stiffness, damping)) in self.shafts.iter().enumerate() {
            let of = format!("stiffness = \"{stiffness} N m/rad\"\ndamping = \"{damping} N m s/rad\"");
            writeln!(t, "[[shaft]]\nname = \"S{k}\"\n{}\n{of}", pair(bodies)).unwrap();
        }
        for (name, engaged) in &self.states {
            let engaged: Vec<String> = engaged.iter().map(|e| format!("{:?}", self.elements[*e].0)).collect();
            writeln!(t, "[[state]]\nname = {name:?}\nengaged = [{}]", engaged.join(", ")).unwrap();
        }
        t
    }

    /// Speeds of all members in a state for one turning rad/s of the output; none if the state does not join them all.
    pub fn speeds(&self, state: usize, output: f64) -> Option<Vec<f64>> {
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

    pub fn reference(&self, capacity: Option<f64>, output: f64, vehicle: bool) -> Reference {
        let mut inertias = self.inertias(output);
        let mut elements: Vec<Element> = (self.elements.iter().zip(&self.one_way))
            .map(|(&(_, bodies), &blocks)| Element { bodies, capacity, blocks, viscous: 0.0 })
            .chain(self.drags.iter().map(|&(bodies, coulomb, viscous)| Element {
                bodies,
                capacity: Some(coulomb),
                blocks: 0,
                viscous,
            }))
            .collect();
        if vehicle {
            let arm = RADIUS / FINAL_DRIVE;
            inertias[self.ends[1]] += MASS * arm * arm;
            let rolling = ROLLING * MASS * 9.806_65 * arm;
            elements.push(Element { bodies: [self.ends[1], 0], capacity: Some(rolling), blocks: 0, viscous: 0.0 });
        }
        let meshes =
            (self.meshes.iter()).map(|&(bodies, teeth, efficiency)| Mesh { bodies, teeth, efficiency }).collect();
        let shafts =
            (self.shafts.iter()).map(|&(bodies, stiffness, damping)| Shaft { bodies, stiffness, damping }).collect();
        Reference { inertias, meshes, elements, shafts, steep: 1e-3, soft: 1e-7 }
    }
}

const MASS: f64 = 1800.0;
const RADIUS: f64 = 0.33;
const FINAL_DRIVE: f64 = 3.2;
const ROLLING: f64 = 0.012;
const DRAG_AREA: f64 = 0.6;

/// What is done with a gearbox: times, s, and torques, N m, by points.
#[derive(Default)]
pub struct Work {
    pub duration: f64,
    /// State, and the one that follows at 0.5 s within 0.2 s.
    pub states: [usize; 2],
    /// Speed of the output at the start, rad/s.
    pub start: f64,
    pub input: Vec<[f64; 2]>,
    pub output: Vec<[f64; 2]>,
    /// Whether the output drives a vehicle.
    pub vehicle: bool,
    /// Whether the output keeps its speed.
    pub bench: bool,
}

impl Work {
    /// As a scenario of a train file; none if the state does not join all members, so that it cannot start turning.
    pub fn text(&self, g: &Gearbox) -> Option<String> {
        let [from, to] = self.states.map(|s| &g.states[s].0);
        let mut text = format!("[[scenario]]\nname = \"run\"\nduration = \"{} s\"\n", self.duration);
        if from == to {
            writeln!(text, "state = {from:?}").unwrap();
        } else {
            writeln!(text, "gears = [ [\"0 s\", {from:?}], [\"0.5 s\", {to:?}] ]\nshift_time = \"0.2 s\"").unwrap();
        }
        if self.start != 0.0 {
            text.push_str(&g.initial(self.states[0], self.start)?);
        }
        let [input, output] = g.ends.map(|m| &g.members[m]);
        for (member, points) in [(input, &self.input), (output, &self.output)] {
            let points: Vec<String> = points.iter().map(|[t, m]| format!("[\"{t} s\", \"{m} N m\"]")).collect();
            if !points.is_empty() {
                let points = points.join(", ");
                writeln!(
                    text,
                    "[[scenario.source]]\nmember = {member:?}\ntorque = {{ type = \"table\", points = [ {points} ] }}"
                )
                .unwrap();
            }
        }
        if self.vehicle {
            writeln!(
                text,
                "[[scenario.source]]\nmember = {output:?}\nvehicle = {{ mass = \"{MASS} kg\", wheel_radius = \"{RADIUS} m\", \
                 final_drive = {FINAL_DRIVE}, rolling = {ROLLING}, drag_area = \"{DRAG_AREA} m^2\" }}"
            )
            .unwrap();
        }
        if self.bench {
            writeln!(text, "[[scenario.source]]\nmember = {output:?}\nspeed = \"{} rad/s\"", self.start).unwrap();
        }
        Some(text)
    }

    /// Speeds at the end, as the reference has them, and the largest on the way; none where it has none.
    ///
    /// `fine`: by how much its steps are shorter and its friction is steeper than usual.
    pub fn reference(&self, g: &Gearbox, capacity: Option<f64>, output: f64, fine: usize) -> Option<(Vec<f64>, f64)> {
        let start =
            if self.start == 0.0 { vec![0.0; g.members.len()] } else { g.speeds(self.states[0], self.start).unwrap() };
        // What nothing can slow down keeps its speed.
        let mut reference = g.reference(capacity, if self.bench { 1e9 } else { output }, self.vehicle);
        reference.steep /= fine as f64;
        reference.soft /= fine as f64;
        let torques = |t: f64, speeds: &[f64]| {
            let mut torques = vec![0.0; g.members.len()];
            torques[g.ends[0]] += between(&self.input, t);
            let w = speeds[g.ends[1]];
            torques[g.ends[1]] += between(&self.output, t);
            if self.vehicle {
                torques[g.ends[1]] -= 0.5 * 1.2 * DRAG_AREA * w * w.abs() * (RADIUS / FINAL_DRIVE).powi(3);
            }
            torques
        };
        let engaged = |t: f64| {
            let [a, b] = self.states.map(|s| &g.states[s].1);
            let of = |s: &Vec<usize>, e| if s.contains(&e) { 1.0 } else { 0.0 };
            // Drags and rolling resistance are always there.
            let of = |e| if e < g.elements.len() { between(&[[0.5, of(a, e)], [0.7, of(b, e)]], t) } else { 1.0 };
            (0..reference.elements.len()).map(of).collect()
        };
        let steps = fine * if g.shafts.is_empty() { 1000 } else { 4000 };
        reference.run(&start, self.duration, steps, torques, engaged)
    }
}

/// A value between points; 0 if there are none.
fn between(points: &[[f64; 2]], t: f64) -> f64 {
    let Some(k) = points.iter().position(|p| p[0] > t) else { return points.last().map_or(0.0, |p| p[1]) };
    let Some([[t0, a], [t1, b]]) = k.checked_sub(1).map(|i| [points[i], points[k]]) else { return points[0][1] };
    a + (b - a) * (t - t0) / (t1 - t0)
}

/// What a run must be beside finished: its energy closes and nothing slips that is held.
pub fn faults(g: &Gearbox, work: &Work, rigid: bool, rows: &Rows, report: &RunReport) -> Vec<String> {
    let mut faults = vec![];
    if report.outcome != Outcome::Finished {
        faults.push(format!("{:?} at {}", report.outcome, report.end_s));
    }
    let energy = report.energy.as_ref().unwrap();
    if energy.residual_j.abs() > 1e-9 * (energy.turned_over_j + energy.stored_j.abs()) + 1e-30 {
        faults.push(format!("energy {} of {}", energy.residual_j, energy.turned_over_j));
    }
    faults.extend(frame_fault(g, rows));
    if rigid && work.states[0] == work.states[1] {
        let column = |m: usize| rows.names.iter().position(|n| *n == format!("{}.speed_rad_s", g.members[m]));
        for &e in &g.states[work.states[0]].1 {
            let [a, b] = g.elements[e].1.map(column);
            if g.one_way[e] != 0 {
                continue;
            }
            let of = |row: &[f64], k: Option<usize>| k.map_or(0.0, |k| row[k]);
            let slip = rows.rows.iter().map(|row| (of(row, a) - of(row, b)).abs()).fold(0.0, f64::max);
            if slip != 0.0 {
                faults.push(format!("{} slips at {slip} rad/s", g.elements[e].0));
            }
        }
    }
    faults
}

/// What the frame gives must be what the brakes, drags and shafts on it take, wherever these are determined.
fn frame_fault(g: &Gearbox, rows: &Rows) -> Option<String> {
    if g.meshes.iter().any(|(bodies, ..)| bodies.contains(&0)) {
        return None;
    }
    // What a run never engages has no column.
    let column = |name: &str| rows.names.iter().position(|n| n == name);
    let frame = column("frame.reaction_n_m").unwrap();
    let drags = g.drags.iter().enumerate().map(|(k, (bodies, ..))| (format!("D{k}.torque_n_m"), *bodies));
    let shafts = g.shafts.iter().enumerate().map(|(k, (bodies, ..))| (format!("S{k}.torque_n_m"), *bodies));
    let all =
        g.elements.iter().map(|(name, bodies)| (format!("{name}.torque_n_m"), *bodies)).chain(drags).chain(shafts);
    let borne: Vec<(usize, f64)> = all
        .filter(|(_, bodies)| bodies.contains(&0))
        .filter_map(|(name, bodies)| Some((column(&name)?, if bodies[0] == 0 { -1.0 } else { 1.0 })))
        .collect();
    let torques: Vec<usize> = (0..rows.names.len()).filter(|&k| rows.kinds[k] == "torque").collect();
    rows.rows.iter().find_map(|row| {
        let sum: f64 = borne.iter().map(|&(k, sign)| sign * row[k]).sum();
        let size = torques.iter().map(|&k| row[k].abs()).fold(0.0, f64::max);
        let off = (row[frame] - sum).abs();
        // Torques that are not determined are NaN.
        (off > 1e-9 * size).then(|| format!("at {} s the frame gives {} and takes {sum}", row[0], row[frame]))
    })
}

/// Speed, rad/s, at which what the reference holds may creep.
const CREEP: f64 = 0.01;

/// Members whose speed at the end is not that of the reference within a part of the largest, and the largest part.
pub fn off(g: &Gearbox, report: &RunReport, (speeds, most): &(Vec<f64>, f64), part: f64) -> (Vec<String>, f64) {
    let (mut found, mut worst) = (vec![], 0.0f64);
    for m in (1..g.members.len()).filter(|m| !g.planets[*m]) {
        let here = *report.final_speeds_rad_s.get(&g.members[m]).unwrap();
        // What the reference holds creeps: its friction needs a speed.
        let off = (here - speeds[m]).abs() / (most + CREEP / part);
        worst = worst.max(off);
        if off > part {
            found.push(format!("{} {here} against {}", g.members[m], speeds[m]));
        }
    }
    (found, worst)
}
