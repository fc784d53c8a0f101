//! From names and numbers to a checked [`Train`]: everything that is wrong is found in one pass.

mod dynamic;
mod hands;
mod heat;
mod physical;
mod variator;

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::losses::Laws;

use super::assembler::{Assembler, Load, check_name, check_text, unique};
use super::described::{GivenFriction, GivenMesh, GivenSet, sign};
use super::input::{Assembled, inputs};
use super::physical::{BearingMount, Housing, Lubrication, Rotor, SealMount, Teeth};
use super::specification::field::{Field, Tabular};
use super::specification::{Hand, OperationSpec, ShiftElementSpec, Specification, StateSpec, TerminalSpec};
use super::words::clip;
use super::{
    Efficiency, FRAME, Gear, Load as Prescribed, LossTable, Member, MemberId, MemberKind, Mesh, MeshId, Operation,
    ShiftElement, ShiftElementId, ShiftElementKind, State, Train, Variator, expand,
};

/// Largest train that is analysed; beyond it exact elimination is no longer bounded in time.
const MOST_MESHES: usize = 128;
const MOST_MEMBERS: usize = 1024;
const MOST_STATES: usize = 256;
const MOST_OPERATIONS: usize = 4096;
const MOST_SCENARIOS: usize = 256;
const MOST_VARIATORS: usize = 16;

impl Assembler<'_> {
    fn mesh(&mut self, spec: &GivenMesh, place: &str) {
        let carrier = self.resolve(&spec.carrier, &format_args!("{place}.carrier"));
        let mut gears = Vec::with_capacity(2);
        for (k, g) in spec.gears.iter().enumerate() {
            let place = format!("{place}.gears[{k}]");
            let teeth = self.teeth(g.teeth, &format_args!("{place}.teeth"));
            if let Some(member) = self.resolve(&g.member, &format_args!("{place}.member")) {
                gears.push(Gear { member, teeth, internal: g.internal });
            }
        }
        let given = spec.efficiency.as_ref().map(|e| self.efficiency(e, &format_args!("{place}.efficiency")));
        let count = self.count(spec.count, &format_args!("{place}.count"));
        let any_internal = spec.gears.iter().any(|g| g.internal);
        if any_internal && spec.same_sense == Some(false) {
            self.report(
                Diagnostic::new(
                    Code::Conflict,
                    format!("{place}.sense"),
                    "a pair with an internal gear turns in the same sense, not in opposite senses",
                )
                .hint("leave out `sense`, or `internal`"),
            );
        }
        let name = spec
            .name
            .clone()
            .unwrap_or_else(|| self.default_mesh_name(format!("{}-{}", spec.gears[0].member, spec.gears[1].member)));
        let gears_of_pair = [0, 1].map(|k| {
            let g = &spec.gears[k];
            (g.z() as f64, g.internal, &g.tooth)
        });
        let alike = spec.same_sense == Some(true) && !any_internal;
        if spec.geometry.is_some() && alike && !spec.bevel {
            let message = "two external gears in mesh turn in opposite senses; a chain or belt has no tooth geometry";
            let d = Diagnostic::new(Code::Conflict, format!("{place}.geometry"), message);
            self.report(d.hint("give `efficiency`, or leave out `sense`"));
        }
        let table = self.loss_table(spec, &name, place);
        let efficiency = table.as_ref().map(|(first, _)| first.clone()).or(given);
        let geometry = spec.geometry.as_ref().filter(|_| (spec.bevel || !alike) && spec.loss_table.is_none());
        let hand = geometry.and_then(|g| g.hand).map_or(0.0, Hand::sign);
        let teeth = geometry.and_then(|g| self.tooth_pair(g, gears_of_pair, spec.bevel, &name, place));
        let teeth = teeth.map(|t| Teeth { hand, ..t });
        let computed = efficiency.is_none() && teeth.is_some();
        if efficiency.is_some() && teeth.is_some() {
            self.given_efficiency(&name, place);
        }
        let efficiency = match (efficiency, &teeth) {
            (None, Some(teeth)) => {
                self.hypoid_lock(teeth, &name, place);
                Some(self.nominal_efficiency(teeth))
            }
            (given, _) => given,
        };
        if efficiency.is_none() && spec.loss_table.is_none() {
            self.assume(&name, "no efficiency given, taken as lossless");
        }
        let (Some(carrier), Ok([first, second])) = (carrier, <[Gear; 2]>::try_from(gears)) else { return };
        let mut wrong = |m: String, hint: &str| {
            self.diagnostics.push(Diagnostic::new(Code::ImpossibleMesh, place, m).hint(hint));
        };
        if first.member == second.member {
            wrong(format!("`{}` cannot mesh with itself", spec.gears[0].member), "name two different members");
        }
        if first.internal && second.internal {
            wrong("two internal gears cannot mesh".into(), "only the ring gear is internal");
        }
        for g in [&first, &second] {
            if g.member == carrier && g.member != FRAME {
                let name = &self.members[carrier.0].name;
                let m = format!("`{name}` is both a gear and the carrier of this mesh");
                self.diagnostics.push(
                    Diagnostic::new(Code::ImpossibleMesh, place, m)
                        .hint("the carrier is the member that carries the planet's axis"),
                );
            }
        }
        let mesh = MeshId(self.meshes.len());
        self.loss_tables.extend(table.map(|(_, rows)| LossTable { mesh, rows }));
        self.meshes.push(Mesh {
            name,
            same_sense: spec.same_sense.unwrap_or(any_internal),
            gears: [first, second],
            carrier,
            efficiency: efficiency.unwrap_or_else(Efficiency::lossless),
            bevel: spec.bevel,
            count,
            angle: spec.angle,
            set: None,
            computed,
            teeth: teeth.map(Box::new),
        });
    }

    fn shift_element(&mut self, spec: &ShiftElementSpec, place: &str) -> Option<ShiftElement> {
        if spec.blocks.is_some() && spec.kind != ShiftElementKind::OneWay {
            let message = format!("a {} has no direction that it blocks", spec.kind);
            self.report(
                Diagnostic::new(Code::Conflict, format!("{place}.blocks"), message)
                    .hint("leave out `blocks`, or make it a one-way clutch: kind = \"one-way\""),
            );
        }
        let friction = self.friction(&GivenFriction::from(spec), place);
        let at = place;
        let place = format!("{place}.members");
        let ids: Vec<_> =
            spec.members.iter().enumerate().map(|(k, m)| self.resolve(m, &format_args!("{place}[{k}]"))).collect();
        let need: &[usize] = match spec.kind {
            ShiftElementKind::Clutch => &[2],
            ShiftElementKind::Brake => &[1],
            ShiftElementKind::OneWay => &[1, 2],
        };
        if !need.contains(&ids.len()) {
            let text = match spec.kind {
                ShiftElementKind::Clutch => "joins two members",
                ShiftElementKind::Brake => "holds one member (the other side is the frame)",
                ShiftElementKind::OneWay => "has one member (against the frame) or two",
            };
            let message = format!("a {} {text}, here are {}", spec.kind, ids.len());
            self.report(Diagnostic::new(Code::ShiftElement, place, message));
            return None;
        }
        let members = [ids[0]?, ids.get(1).copied().unwrap_or(Some(FRAME))?];
        if members[0] == members[1] {
            let message = match spec.kind {
                ShiftElementKind::Brake => "a brake on the frame holds nothing".into(),
                kind => format!("this {kind} joins `{}` to itself", spec.members[0]),
            };
            self.report(Diagnostic::new(Code::ShiftElement, place, message).hint("name the two members it joins"));
            return None;
        }
        Some(ShiftElement {
            name: spec.name.clone(),
            kind: spec.kind,
            members,
            blocks: spec.blocks.map_or(-1, sign),
            friction,
            open: spec.open.as_ref().and_then(|o| self.open_element(&o.twin(), &format!("{at}.open"))),
        })
    }

    fn state(&mut self, spec: &StateSpec, elements: &[ShiftElementSpec], place: &str) -> State {
        let known: Vec<&str> = elements.iter().map(|e| e.name.as_str()).collect();
        let mut engaged = Vec::new();
        for (k, name) in spec.engaged.iter().enumerate() {
            let place = format!("{place}.engaged[{k}]");
            let Some(id) = self.position("shift element", "shift_element", name, place.clone(), &known) else {
                continue;
            };
            if engaged.contains(&ShiftElementId(id)) {
                let message = format!("`{}` is engaged twice in this state", clip(name));
                self.report(Diagnostic::new(Code::DuplicateName, place, message).hint("name it once"));
            } else {
                engaged.push(ShiftElementId(id));
            }
        }
        let input = spec.input.as_ref().and_then(|n| self.resolve(n, &format_args!("{place}.input")));
        let output = spec.output.as_ref().and_then(|n| self.resolve(n, &format_args!("{place}.output")));
        State { name: spec.name.clone(), engaged, input, output }
    }

    /// Names in studies; their axes are read where they are used.
    fn studies(&mut self, spec: &Specification) {
        let states: Vec<&str> = spec.state.iter().map(|s| s.name.as_str()).collect();
        let operations: Vec<&str> = spec.operation.iter().map(|o| o.name.as_str()).collect();
        for (k, study) in spec.study.iter().enumerate() {
            if let Some(name) = &study.state {
                self.position("state", "state", name, format!("study[{k}].state"), &states);
            }
            if let Some(name) = &study.operation {
                self.position("operation", "operation", name, format!("study[{k}].operation"), &operations);
            }
        }
    }

    fn operation(&mut self, spec: &OperationSpec, within: &Within<'_>, place: String) -> Operation {
        let Within { states, variators, terminals } = within;
        let known: Vec<&str> = states.iter().map(|s| s.name.as_str()).collect();
        let of = |name: &String| self.position("state", "state", name, format!("{place}.state"), &known);
        let state = spec.state.as_ref().and_then(of);
        let mut seen = HashSet::new();
        let mut operation = Operation {
            name: spec.name.clone(),
            state,
            speeds: vec![],
            fixed: vec![],
            loads: vec![],
            stores: self.stores(&spec.store, variators, &place),
            machines: vec![],
            temperature: spec.temperature.plain(),
            place: place.clone(),
        };
        for (k, name) in spec.fixed.iter().enumerate() {
            let place = format!("{place}.fixed[{k}]");
            let Some(id) = self.resolve(name, &place) else { continue };
            if !seen.insert(id) {
                let message = format!("`{name}` is held twice");
                self.report(Diagnostic::new(Code::HeldAndDriven, place, message).hint("name it once"));
            } else if id != FRAME {
                operation.fixed.push(id);
            }
        }
        for (name, speed) in &spec.speeds {
            let place = format!("{place}.speeds.{name}");
            let Some(id) = self.resolve(name, &place) else { continue };
            if id == FRAME {
                let message = "the frame is at rest; its speed is not prescribed";
                self.report(Diagnostic::new(Code::HeldAndDriven, place, message));
            } else if seen.contains(&id) {
                let message = format!("`{name}` is held and has a prescribed speed");
                self.report(Diagnostic::new(Code::HeldAndDriven, place, message).hint("keep one of the two"));
            } else if operation.speeds.iter().any(|(m, _)| *m == id) {
                let message = format!("the speed of `{name}` is given twice");
                self.report(Diagnostic::new(Code::HeldAndDriven, place, message).hint("keep one of the two"));
            } else {
                operation.speeds.push((id, speed.clone().into()));
            }
        }
        let torques = spec.torques.iter().map(|(m, t)| (m, "torques", Prescribed::Torque(t.clone().into())));
        let powers = spec.powers.iter().map(|(m, p)| (m, "powers", Prescribed::Power(p.clone().into())));
        for (name, table, load) in torques.chain(powers) {
            let place = format!("{place}.{table}.{name}");
            // The torque of a machine within the train, unless one from outside has its name.
            let machine = variators
                .iter()
                .enumerate()
                .find_map(|(v, variator)| Some([v, variator.machines().iter().position(|m| m.name == *name)?]));
            if let Some(machine) = machine.filter(|_| !terminals.iter().any(|t| t.name == *name)) {
                if operation.machines.iter().any(|(m, _)| *m == machine) {
                    let message = format!("the load on `{name}` is given twice");
                    self.report(Diagnostic::new(Code::Conflict, place, message).hint("give a torque or a power, once"));
                } else {
                    operation.machines.push((machine, load));
                }
                continue;
            }
            let Some(id) = self.resolve(name, &place) else { continue };
            if operation.loads.iter().any(|(m, _)| *m == id) {
                let message = format!("the load on `{name}` is given twice");
                self.report(Diagnostic::new(Code::Conflict, place, message).hint("give a torque or a power, once"));
            } else if seen.contains(&id) {
                let message = format!("`{name}` is held, so its torque is a result");
                self.report(Diagnostic::new(Code::HeldAndDriven, place, message).hint("leave out one of the two"));
            } else {
                operation.loads.push((id, load));
            }
        }
        operation
    }
}

/// What an operation may name.
struct Within<'a> {
    states: &'a [StateSpec],
    variators: &'a [Variator],
    terminals: &'a [TerminalSpec],
}

/// Reports what is too large to be analysed in bounded time.
fn too_large(spec: &Specification, diagnostics: &mut Diagnostics) {
    for (what, is, most) in [
        ("meshes", spec.mesh.len() + 2 * spec.set.len(), MOST_MESHES),
        ("members", spec.members.len() + spec.set.len(), MOST_MEMBERS),
        ("shift elements", spec.shift_element.len(), MOST_MEMBERS),
        ("states", spec.state.len(), MOST_STATES),
        ("operations", spec.operation.len(), MOST_OPERATIONS),
        ("bearings, seals and rotors", spec.bearing.len() + spec.seal.len() + spec.rotor.len(), MOST_MEMBERS),
        ("drags and shafts", spec.drag.len() + spec.shaft.len(), MOST_MEMBERS),
        ("variators", spec.variator.len(), MOST_VARIATORS),
        ("terminals", spec.terminals.len(), MOST_MEMBERS),
        ("scenarios", spec.scenario.len(), MOST_SCENARIOS),
        ("sources of a scenario", spec.scenario.iter().map(|s| s.source.len()).max().unwrap_or(0), MOST_MEMBERS),
    ] {
        if is > most {
            let message = format!("{is} {what}: at most {most} are analysed");
            diagnostics.push(Diagnostic::new(Code::TooLarge, "", message).hint("split the train at a shaft"));
        }
    }
}

/// Checks the whole description. `None` when an error was reported.
pub(super) fn assemble<'a>(
    spec: &Specification,
    load: &'a mut Load<'a>,
    diagnostics: &'a mut Diagnostics,
) -> Option<Train> {
    let before = diagnostics.len();
    too_large(spec, diagnostics);
    if diagnostics.len() > before {
        return None;
    }
    let frame = Member { name: "frame".into(), kind: MemberKind::Frame };
    let mut a = Assembler {
        diagnostics,
        members: vec![frame],
        meshes: vec![],
        assumptions: vec![],
        unplaced_masses: vec![],
        laws: Laws::default(),
        friction_coefficient: crate::losses::mesh_friction::Constant::DEFAULT.mu,
        loss_tables: vec![],
        by_name: HashMap::from([("frame".into(), FRAME)]),
        mesh_names: spec.mesh.iter().filter_map(|m| m.name.clone()).collect(),
        load,
        files: BTreeMap::new(),
    };
    a.name_members(spec);
    let joints = a.name_terminals(spec);
    a.choose_laws(spec.laws.as_ref());
    let lubrication = spec.oil.as_ref().and_then(|o| a.oil(&o.twin()));

    // Planets exist before anything can refer to them.
    let given: Vec<GivenSet> = spec.set.iter().map(GivenSet::from).collect();
    a.check_sets(spec);
    let sets: Vec<_> = given.iter().map(|s| (s, expand::planets(&mut a, s))).collect();
    let meshes: Vec<GivenMesh> = spec.mesh.iter().map(GivenMesh::from).collect();
    for (k, mesh) in meshes.iter().enumerate() {
        a.mesh(mesh, &format!("mesh[{k}]"));
    }
    let resolved_sets: Vec<_> =
        (sets.iter().enumerate()).map(|(k, (set, planets))| expand::expand(&mut a, set, planets, k)).collect();
    unique(&mut a, "mesh", "mesh", spec.mesh.iter().filter_map(|m| m.name.as_deref()));

    let variators = a.variators(&spec.variator);
    let (shift_elements, states, operations) = a.shifting(spec, &variators);
    let (mut bearings, seals, rotors) = a.machinery(spec, &lubrication);
    let pumps = a.each(&spec.pump, "pump", |a, p, place| a.pump(&p.twin(), place));
    a.surroundings(spec, &lubrication);
    let makers = heat::Makers {
        bearings: bearings.iter().map(|b| b.name.as_str()).collect(),
        seals: seals.iter().map(|s| s.name.as_str()).collect(),
        rotors: rotors.iter().map(|r| r.name.as_str()).collect(),
        variators: variators.iter().map(|v| v.name.as_str()).collect(),
    };
    let loss_factors = a.loss_factors(spec.losses.as_ref().map(Tabular::twin).as_ref());
    check_text(
        &mut a,
        "a text",
        spec.losses.as_ref().and_then(|l| l.calibrated.as_deref()).unwrap_or(""),
        "losses.calibrated",
    );
    let network = a.heat(spec.heat.as_ref(), lubrication.as_ref(), &makers);
    // An oil that is wrong was reported; it is not missing as well.
    if lubrication.is_some() || spec.oil.is_none() {
        a.missing_for_losses(&lubrication, &bearings, &rotors, &shift_elements, &pumps);
    }
    let (terminals, input, output) = a.terminals(spec, &states, &variators);
    let masses: Vec<(MemberId, f64)> = (sets.iter())
        .flat_map(|(set, planets)| planets.iter().copied().zip(set.planets().into_iter().map(|(_, p)| p.body.mass)))
        .filter_map(|(planet, mass)| Some((planet, mass?)))
        .collect();
    let shifting = shift_elements.iter().flat_map(|e| e.members);
    let central: Vec<MemberId> = terminals.iter().copied().chain(shifting).collect();
    let planets = a.planet_bodies(&masses, &mut bearings, &central);
    a.hands(!bearings.is_empty());
    a.positions(&bearings);

    let mut inertias = a.inertias(&spec.inertias.plain());
    let of_planets = a.planet_inertias(&sets, &resolved_sets, &planets, &inertias, !spec.scenario.is_empty());
    inertias.extend(of_planets);
    a.names_of_motion(spec);
    let drags = a.each(&spec.drag, "drag", |a, d, place| a.drag(&d.twin(), place));
    let shafts = a.each(&spec.shaft, "shaft", |a, s, place| a.shaft(&s.twin(), place));
    let scene = dynamic::Scene {
        states: &states,
        elements: spec.shift_element.iter().map(|e| (e.name.as_str(), e.kind)).collect(),
        shafts: spec.shaft.iter().map(|s| s.name.as_str()).collect(),
        variators: &variators,
    };
    let scenarios = a.each(&spec.scenario, "scenario", |a, s, place| a.scenario(&s.twin(), &scene, place.to_owned()));
    a.loads_on_terminals(&operations, &terminals);
    a.is_a_train(spec, before);
    if a.diagnostics.len() == before || !a.diagnostics.has_errors() {
        let touched = (shift_elements.iter().flat_map(|e| e.members))
            .chain(variators.iter().flat_map(Variator::members))
            .chain(joints.iter().copied().flatten())
            .chain(inertias.iter().map(|i| i.member))
            .chain(drags.iter().flat_map(|d| d.members))
            .chain(shafts.iter().flat_map(|s| s.members))
            .chain(scenarios.iter().flat_map(|s| s.sources.iter().map(|x| x.member)))
            .collect();
        loose_members(&mut a, touched);
    }

    if a.diagnostics.has_errors_since(before) {
        return None;
    }
    let assumptions = a.assumptions();
    let set_planets: Vec<Vec<MemberId>> = sets.iter().map(|(_, planets)| planets.clone()).collect();
    let Assembler { diagnostics, members, meshes: assembled, laws, loss_tables, unplaced_masses, .. } = a;
    let inputs = {
        let lubrication = lubrication.as_ref();
        let (bearings, planets, set_planets) = (&bearings[..], &planets[..], &set_planets[..]);
        inputs(spec, &meshes, &given, &Assembled { meshes: &assembled, lubrication, bearings, planets, set_planets })
    };
    let around = spec.housing.clone().unwrap_or_default().twin();
    let housing = Housing { enclosure: around.enclosure, axial_gap: around.axial_gap };
    Some(Train {
        name: spec.name.clone(),
        source: spec.source.clone(),
        members,
        meshes: assembled,
        sets: resolved_sets.into_iter().flatten().collect(),
        shift_elements,
        states,
        operations,
        terminals,
        input,
        output,
        warnings: diagnostics.iter().skip(before).cloned().collect(),
        unplaced_masses,
        speed_tolerance: Train::SAME_SPEED,
        assumptions,
        lubrication,
        laws,
        housing,
        heat: network,
        loss_factors,
        bearings,
        seals,
        rotors,
        pumps,
        planets,
        inertias,
        drags,
        shafts,
        loss_tables,
        scenarios,
        variators,
        joints,
        studies: spec.study.clone(),
        inputs,
    })
}

/// An operating point of a train that is there, by names; what is wrong with it where it is.
pub(super) fn operating_point(train: &Train, spec: &OperationSpec) -> Result<Operation, Diagnostics> {
    let mut diagnostics = Diagnostics::default();
    let mut no_files = |file: &str| Err(format!("`{file}`: an operating point names no tables"));
    let mut a = Assembler {
        diagnostics: &mut diagnostics,
        members: train.members.clone(),
        meshes: vec![],
        assumptions: vec![],
        unplaced_masses: vec![],
        laws: train.laws,
        friction_coefficient: 0.0,
        loss_tables: vec![],
        by_name: (train.members.iter().enumerate()).map(|(k, m)| (m.name.clone(), MemberId(k))).collect(),
        mesh_names: HashSet::new(),
        load: &mut no_files,
        files: BTreeMap::new(),
    };
    let states: Vec<StateSpec> = train.states.iter().map(|s| StateSpec::new(s.name.as_str(), [])).collect();
    let named = |m: &MemberId| TerminalSpec { name: train.member_name(*m).to_owned(), member: None };
    let terminals: Vec<TerminalSpec> = train.terminals.iter().map(named).collect();
    let within = Within { states: &states, variators: &train.variators, terminals: &terminals };
    let operation = a.operation(spec, &within, "operation".to_owned());
    a.loads_on_terminals(std::slice::from_ref(&operation), &train.terminals);
    match (operation.temperature, &train.lubrication) {
        (Some(t), Some(l)) => a.temperature(l, t, "operation.temperature"),
        (Some(_), None) => a.report(no_oil("operation.temperature".to_owned())),
        (None, _) => {}
    }
    if diagnostics.has_errors() { Err(diagnostics) } else { Ok(operation) }
}

fn no_oil(place: String) -> Diagnostic {
    Diagnostic::new(Code::MissingKey, place, "a temperature is given, but the train has no oil")
        .hint("add [oil] with a name of the catalogue, or its viscosities")
}

impl Assembler<'_> {
    fn name_members(&mut self, spec: &Specification) {
        check_text(self, "a name", &spec.name, "name");
        for (text, place) in [(&spec.source, "source"), (&spec.notes, "notes")] {
            // These may have lines.
            let plain = text.as_deref().unwrap_or_default().replace(['\n', '\r', '\t'], " ");
            check_text(self, "a text", &plain, place);
        }
        for (k, name) in spec.members.iter().enumerate() {
            let place = format!("members[{k}]");
            if name == "frame" {
                let d = Diagnostic::new(Code::BadName, place, "`frame` always exists and needs no entry");
                self.report(d.hint("leave it out"));
                continue;
            }
            check_name(self, name, &place, true);
            if self.by_name.contains_key(name) {
                let message = format!("the member `{}` is named twice", clip(name));
                let d = Diagnostic::new(Code::DuplicateName, place, message);
                self.report(d.hint("members have different names"));
                continue;
            }
            self.by_name.insert(name.clone(), MemberId(self.members.len()));
            self.members.push(Member { name: name.clone(), kind: MemberKind::Shaft });
        }
    }

    /// What can be wrong with sets before their gears are looked at.
    fn check_sets(&mut self, spec: &Specification) {
        unique(self, "set", "set", spec.set.iter().map(|s| s.name.as_str()));
        for (k, set) in spec.set.iter().enumerate() {
            for misuse in &set.misuse {
                let message = format!("set `{}`: {misuse}", clip(&set.name));
                let d = Diagnostic::new(Code::Conflict, format!("set[{k}]"), message);
                self.report(d.hint(format!("its type is {}", set.kind())));
            }
            if set.mesh_efficiency.is_some() && set.basic_efficiency.is_some() {
                let message = "`mesh_efficiency` and `basic_efficiency` both say what the set loses";
                let d = Diagnostic::new(Code::Conflict, format!("set[{k}].basic_efficiency"), message);
                self.report(d.hint("keep the one that is known"));
            }
        }
    }

    /// Each entry of a list at its place; those that are wrong were reported.
    fn each<S, T>(&mut self, all: &[S], key: &str, mut check: impl FnMut(&mut Self, &S, &str) -> Option<T>) -> Vec<T> {
        (all.iter().enumerate()).filter_map(|(k, one)| check(self, one, &format!("{key}[{k}]"))).collect()
    }

    /// A terminal with a name of its own is a shaft of its own, for good coupled with the member that it sits on.
    fn name_terminals(&mut self, spec: &Specification) -> Vec<[MemberId; 2]> {
        let mut joints = Vec::new();
        for (k, terminal) in spec.terminals.iter().enumerate() {
            let Some(on) = terminal.member.as_ref().filter(|on| **on != terminal.name) else { continue };
            let place = format!("terminals[{k}].name");
            check_name(self, &terminal.name, &place, true);
            if self.by_name.contains_key(&terminal.name) {
                let message = format!("a member is called `{}` already", clip(&terminal.name));
                let d = Diagnostic::new(Code::DuplicateName, place, message);
                self.report(d.hint("give the terminal a name of its own"));
                continue;
            }
            let Some(on) = self.resolve(on, &format_args!("terminals[{k}].member")) else { continue };
            let own = MemberId(self.members.len());
            self.by_name.insert(terminal.name.clone(), own);
            self.members.push(Member { name: terminal.name.clone(), kind: MemberKind::Shaft });
            joints.push([own, on]);
        }
        joints
    }

    fn shifting(
        &mut self,
        spec: &Specification,
        variators: &[Variator],
    ) -> (Vec<ShiftElement>, Vec<State>, Vec<Operation>) {
        unique(self, "shift element", "shift_element", spec.shift_element.iter().map(|e| e.name.as_str()));
        unique(self, "state", "state", spec.state.iter().map(|s| s.name.as_str()));
        unique(self, "operation", "operation", spec.operation.iter().map(|o| o.name.as_str()));
        let shift_elements = self.each(&spec.shift_element, "shift_element", |a, e, place| a.shift_element(e, place));
        let states = self.each(&spec.state, "state", |a, s, place| Some(a.state(s, &spec.shift_element, place)));
        let within = Within { states: &spec.state, variators, terminals: &spec.terminals };
        let operations =
            self.each(&spec.operation, "operation", |a, o, place| Some(a.operation(o, &within, place.to_owned())));
        (shift_elements, states, operations)
    }

    fn machinery(
        &mut self,
        spec: &Specification,
        lubrication: &Option<Lubrication>,
    ) -> (Vec<BearingMount>, Vec<SealMount>, Vec<Rotor>) {
        unique(self, "bearing", "bearing", spec.bearing.iter().map(|b| b.name.as_str()));
        unique(self, "seal", "seal", spec.seal.iter().map(|s| s.name.as_str()));
        unique(self, "rotor", "rotor", spec.rotor.iter().map(|r| r.name.as_str()));
        let bearings = self.each(&spec.bearing, "bearing", |a, b, place| a.bearing(&b.twin(), place));
        let seals = self.each(&spec.seal, "seal", |a, s, place| a.seal(&s.twin(), place));
        let rotors = self.each(&spec.rotor, "rotor", |a, r, place| a.rotor(&r.twin(), place));
        unique(self, "pump", "pump", spec.pump.iter().map(|r| r.name.as_str()));
        self.oil_of_seals(lubrication, &seals);
        (bearings, seals, rotors)
    }

    /// The housing, and oil temperatures of operations.
    fn surroundings(&mut self, spec: &Specification, lubrication: &Option<Lubrication>) {
        self.housing(&spec.housing.clone().unwrap_or_default().twin());
        for (k, o) in spec.operation.iter().enumerate() {
            let place = format!("operation[{k}].temperature");
            match (&o.temperature, lubrication) {
                (Some(t), Some(l)) => self.temperature(l, t.si(), &place),
                (Some(_), None) if spec.oil.is_none() => self.report(no_oil(place)),
                _ => {}
            }
        }
    }

    /// Where external torques act, and where power enters and leaves when driving.
    fn terminals(
        &mut self,
        spec: &Specification,
        states: &[State],
        variators: &[Variator],
    ) -> (Vec<MemberId>, Option<MemberId>, Option<MemberId>) {
        let mut terminals: Vec<MemberId> = Vec::new();
        for (k, TerminalSpec { name, member }) in spec.terminals.iter().enumerate() {
            let place = format!("terminals[{k}]");
            // What is wrong with the name of one on another member was told.
            let own = member.as_ref().is_some_and(|on| on != name);
            let found = if own { self.by_name.get(name).copied() } else { self.resolve(name, &place) };
            let Some(id) = found else { continue };
            if id == FRAME {
                self.report(Diagnostic::new(Code::BadName, place, "the frame is no terminal").hint("leave it out"));
            } else if terminals.contains(&id) {
                let message = format!("the terminal `{name}` is named twice");
                self.report(Diagnostic::new(Code::DuplicateName, place, message).hint("name it once"));
            } else {
                terminals.push(id);
            }
        }
        let input = spec.input.as_ref().and_then(|n| self.resolve(n, &"input")).or(terminals.first().copied());
        let output = spec.output.as_ref().and_then(|n| self.resolve(n, &"output")).or(terminals.last().copied());
        // Inputs and outputs are terminals without being listed a second time; but what a machine of a variator drives is
        // driven from within.
        let within: Vec<MemberId> = variators.iter().flat_map(Variator::members).collect();
        let named = [(input, "input".to_owned()), (output, "output".to_owned())].into_iter();
        let in_states = states
            .iter()
            .enumerate()
            .flat_map(|(k, s)| [(s.input, format!("state[{k}].input")), (s.output, format!("state[{k}].output"))]);
        for (end, place) in named.chain(in_states).filter_map(|(end, place)| Some((end?, place))) {
            if end == FRAME {
                let d = Diagnostic::new(Code::BadName, place, "the frame is at rest: it is neither input nor output");
                self.report(d.hint("name a member that turns"));
            } else if !terminals.contains(&end) && !within.contains(&end) {
                terminals.push(end);
            }
        }
        (terminals, input, output)
    }

    fn names_of_motion(&mut self, spec: &Specification) {
        unique(self, "drag", "drag", spec.drag.iter().map(|d| d.name.as_str()));
        unique(self, "shaft", "shaft", spec.shaft.iter().map(|s| s.name.as_str()));
        unique(self, "scenario", "scenario", spec.scenario.iter().map(|s| s.name.as_str()));
        unique(self, "study", "study", spec.study.iter().map(|s| s.name.as_str()));
        for (k, study) in spec.study.iter().enumerate() {
            for (text, key) in
                study.over.iter().map(|t| (t, "over")).chain(study.columns.iter().map(|t| (t, "columns")))
            {
                check_text(self, "a text", text, &format!("study[{k}].{key}"));
            }
        }
        self.studies(spec);
    }

    fn loads_on_terminals(&mut self, operations: &[Operation], terminals: &[MemberId]) {
        for operation in operations {
            for (member, load) in operation.loads.iter().filter(|l| !terminals.contains(&l.0)) {
                let name = self.members[member.0].name.clone();
                let table = if matches!(load, Prescribed::Torque(_)) { "torques" } else { "powers" };
                let message = format!("`{name}` carries an external load here and is not a terminal");
                self.report(
                    Diagnostic::new(Code::NotATerminal, format!("{}.{table}.{name}", operation.place), message)
                        .hint(format!("add \"{name}\" to `terminals`")),
                );
            }
        }
    }

    /// Whether there is a train at all, and none too large.
    fn is_a_train(&mut self, spec: &Specification, before: usize) {
        if self.meshes.len() > MOST_MESHES || self.members.len() > MOST_MEMBERS {
            let message = format!(
                "{} meshes and {} members: at most {MOST_MESHES} and {MOST_MEMBERS} are analysed",
                self.meshes.len(),
                self.members.len()
            );
            self.report(Diagnostic::new(Code::TooLarge, "", message).hint("split the train at a shaft"));
        }
        if spec.members.is_empty() && self.diagnostics.len() == before {
            self.report(
                Diagnostic::new(Code::MissingKey, "members", "the train has no members")
                    .hint("name every rotor: members = [\"sun\", \"ring\", \"carrier\"]"),
            );
        }
    }
}

/// Warns of members that mesh with nothing and are not `touched` by anything else.
fn loose_members(a: &mut Assembler<'_>, touched: HashSet<MemberId>) {
    let mut used = touched;
    used.extend(a.meshes.iter().flat_map(|m| [m.gears[0].member, m.gears[1].member, m.carrier]));
    let loose: Vec<_> = (1..a.members.len())
        .filter(|&k| a.members[k].kind == MemberKind::Shaft && !used.contains(&MemberId(k)))
        .collect();
    for k in loose {
        let name = a.members[k].name.clone();
        let message = format!("`{name}` meshes with nothing and no shift element touches it");
        let place = format!("members[{}]", k - 1);
        a.report(Diagnostic::new(Code::Unconnected, place, message).hint("remove it, or check the names of the gears"));
    }
}
