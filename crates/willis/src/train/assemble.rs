//! From names and numbers to a checked [`Train`]: everything that is wrong is found in one pass.

mod dynamic;
mod physical;

use std::collections::{HashMap, HashSet};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::losses::Laws;

use super::describe::{EfficiencySpec, GearSpec, MeshSpec, OperationSpec, ShiftElementSpec, StateSpec, TrainBuilder};
use super::input::{Assembled, Has, inputs};
use super::{
    Efficiency, FRAME, Gear, LossTable, Member, MemberId, MemberKind, Mesh, MeshId, Operation, ShiftElement,
    ShiftElementId, ShiftElementKind, State, Train, expand,
};

/// Largest train that is analysed; beyond it exact elimination is no longer bounded in time.
pub(super) const MOST_MESHES: usize = 128;
const MOST_MEMBERS: usize = 1024;
const MOST_STATES: usize = 256;
const MOST_OPERATIONS: usize = 4096;
const MOST_SCENARIOS: usize = 256;
const MOST_TEETH: i64 = 100_000;
const MOST_COUNT: i64 = 1000;

/// Where expansion of the sets and resolution of names put what they find.
pub(super) struct Assembler<'a> {
    pub diagnostics: &'a mut Diagnostics,
    pub members: Vec<Member>,
    pub meshes: Vec<Mesh>,
    /// What it is about, and what was assumed of it.
    pub assumptions: Vec<(String, String)>,
    pub laws: Laws,
    /// The coefficient of friction where nothing better is known.
    pub friction_coefficient: f64,
    loss_tables: Vec<LossTable>,
    by_name: HashMap<String, MemberId>,
    mesh_names: HashSet<String>,
}

impl Assembler<'_> {
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Whether it is still worth looking for what a wrong name may have meant: the search compares
    /// it with every known name, and nobody reads hundreds of hints.
    fn hints_are_read(&self) -> bool {
        self.diagnostics.len() < 100
    }

    /// The member of that name, or an error at `place`.
    pub fn resolve(&mut self, name: &str, place: &str) -> Option<MemberId> {
        let found = self.by_name.get(name).copied();
        if found.is_none() && !self.hints_are_read() {
            self.report(Diagnostic::new(Code::UnknownName, place, format!("there is no member `{}`", clip(name))));
        } else if found.is_none() {
            let known: Vec<&str> = self.members.iter().map(|m| m.name.as_str()).collect();
            let mut d = Diagnostic::new(Code::UnknownName, place, format!("there is no member `{}`", clip(name)));
            d = d.suggest(name, known.iter().copied());
            if d.hints.is_empty() {
                d = d.hint(format!("name it in `members`, or use one of: {}", list(known)));
            }
            self.report(d);
        }
        found
    }

    /// The position of a name among those known of its kind (`key` in the file), or an error.
    fn position(&mut self, what: &str, key: &str, name: &str, place: String, known: &[&str]) -> Option<usize> {
        let found = known.iter().position(|k| *k == name);
        if found.is_none() {
            let mut d = Diagnostic::new(Code::UnknownName, place, format!("there is no {what} `{}`", clip(name)));
            if self.hints_are_read() {
                d = d.suggest(name, known.iter().copied());
            }
            if self.hints_are_read() && d.hints.is_empty() {
                d = d.hint(match known.len() {
                    0 => format!("add it as a [[{key}]]"),
                    _ => format!("the {what}s are: {}", list(known.to_vec())),
                });
            }
            self.report(d);
        }
        found
    }

    pub fn assume(&mut self, about: &str, what: impl Into<String>) {
        self.assumptions.push((about.to_owned(), what.into()));
    }

    /// The assumptions as sentences, one for all parts of which the same is assumed.
    fn assumptions(&self) -> Vec<String> {
        let mut all: Vec<(Vec<&str>, &str)> = Vec::new();
        for (about, what) in &self.assumptions {
            match all.iter_mut().find(|(_, w)| w == what) {
                Some((list, _)) => list.push(about),
                None => all.push((vec![about], what)),
            }
        }
        all.into_iter().map(|(about, what)| format!("{}: {what}", about.join(", "))).collect()
    }

    pub fn add_planet(&mut self, name: String) -> MemberId {
        let id = MemberId(self.members.len());
        self.by_name.insert(name.clone(), id);
        self.members.push(Member { name, kind: MemberKind::Planet });
        id
    }

    /// The name of a mesh that was given none: names given by the user stay theirs, and further
    /// meshes between the same members get a number.
    pub fn default_mesh_name(&mut self, base: String) -> String {
        let numbered = (2..).map(|k| format!("{base}-{k}"));
        let mut names = std::iter::once(base.clone()).chain(numbered);
        let name = names.find(|n| !self.mesh_names.contains(n)).expect("numbers do not end");
        self.mesh_names.insert(name.clone());
        name
    }

    /// A tooth count as a number to calculate with; out of range is reported once, here.
    pub fn teeth(&mut self, teeth: i64, place: &str) -> Rational {
        if !(1..=MOST_TEETH).contains(&teeth) {
            let message = format!("{teeth} teeth: a tooth count is an integer from 1 to {MOST_TEETH}");
            let mut d = Diagnostic::new(Code::OutOfRange, place, message);
            if teeth < 0 {
                d = d.hint("a ring gear has `internal = true` (or is the `ring` of a set), not a negative tooth count");
            }
            self.report(d);
        }
        Rational::from(teeth.clamp(1, MOST_TEETH))
    }

    pub fn count(&mut self, count: i64, place: &str) -> u32 {
        if !(1..=MOST_COUNT).contains(&count) {
            let message = format!("a count of {count}: it is an integer from 1 to {MOST_COUNT}");
            self.report(Diagnostic::new(Code::OutOfRange, place, message));
        }
        count.clamp(1, MOST_COUNT) as u32
    }

    pub fn efficiency(&mut self, spec: &EfficiencySpec, place: &str) -> Efficiency {
        for value in [&spec.0.forward, &spec.0.backward] {
            if value.sign() <= 0 || *value > Rational::ONE {
                let shown = value.to_f64();
                let mut d = Diagnostic::new(
                    Code::OutOfRange,
                    place,
                    format!("an efficiency of {shown}: it is above 0 and at most 1"),
                );
                if (1.0..=100.0).contains(&shown) {
                    d = d.hint(format!("if {shown} % is meant, write {}", shown / 100.0));
                }
                // The meshes of a set share one value, and its fault is told once.
                if !self.diagnostics.iter().rev().take(4).any(|e| *e == d) {
                    self.report(d);
                }
                return Efficiency::lossless();
            }
        }
        spec.0.clone()
    }

    fn mesh(&mut self, spec: &MeshSpec, place: &str) {
        let carrier = self.resolve(&spec.carrier, &format!("{place}.carrier"));
        let mut gears = Vec::with_capacity(2);
        for (k, g) in spec.gears.iter().enumerate() {
            let place = format!("{place}.gears[{k}]");
            let teeth = self.teeth(g.teeth, &format!("{place}.teeth"));
            if let Some(member) = self.resolve(&g.member, &format!("{place}.member")) {
                gears.push(Gear { member, teeth, internal: g.internal });
            }
        }
        let given = spec.efficiency.as_ref().map(|e| self.efficiency(e, &format!("{place}.efficiency")));
        let count = self.count(spec.count, &format!("{place}.count"));
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
            (g.z() as f64, g.internal, g.tooth)
        });
        let alike = spec.same_sense == Some(true) && !any_internal;
        if spec.geometry.is_some() && (spec.bevel || alike) {
            let (message, hint) = match spec.bevel {
                true => ("bevel teeth are not computed: a geometry describes cylindrical gears", "give `efficiency`"),
                false => (
                    "two external gears in mesh turn in opposite senses; a chain or belt has no tooth geometry",
                    "give `efficiency`, or leave out `sense`",
                ),
            };
            self.report(Diagnostic::new(Code::Conflict, format!("{place}.geometry"), message).hint(hint));
        }
        let table = self.loss_table(spec, &name, place);
        let efficiency = table.as_ref().map(|(first, _)| first.clone()).or(given);
        let geometry = spec.geometry.as_ref().filter(|_| !spec.bevel && !alike && spec.loss_table.is_none());
        let teeth = geometry.and_then(|g| self.tooth_pair(g, gears_of_pair, &name, place));
        let computed = efficiency.is_none() && teeth.is_some();
        if efficiency.is_some() && teeth.is_some() {
            self.given_efficiency(&name, place);
        }
        let efficiency = match (efficiency, &teeth) {
            (None, Some(teeth)) => Some(self.nominal_efficiency(teeth)),
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
        let friction = self.friction(&spec.friction, place);
        let place = format!("{place}.members");
        let ids: Vec<_> =
            spec.members.iter().enumerate().map(|(k, m)| self.resolve(m, &format!("{place}[{k}]"))).collect();
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
            blocks: spec.blocks.unwrap_or(-1),
            friction,
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
        let input = spec.input.as_ref().and_then(|n| self.resolve(n, &format!("{place}.input")));
        let output = spec.output.as_ref().and_then(|n| self.resolve(n, &format!("{place}.output")));
        State { name: spec.name.clone(), engaged, input, output }
    }

    /// Names in studies; their axes are read where they are used.
    fn studies(&mut self, spec: &TrainBuilder) {
        let states: Vec<&str> = spec.states.iter().map(|s| s.name.as_str()).collect();
        let operations: Vec<&str> = spec.operations.iter().map(|o| o.name.as_str()).collect();
        for (k, study) in spec.studies.iter().enumerate() {
            if let Some(name) = &study.state {
                self.position("state", "state", name, format!("study[{k}].state"), &states);
            }
            if let Some(name) = &study.operation {
                self.position("operation", "operation", name, format!("study[{k}].operation"), &operations);
            }
        }
    }

    fn operation(&mut self, spec: &OperationSpec, states: &[StateSpec], place: String) -> Operation {
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
            temperature: spec.temperature,
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
                operation.speeds.push((id, speed.clone()));
            }
        }
        for (name, load) in &spec.loads {
            let table = if matches!(load, super::Load::Torque(_)) { "torques" } else { "powers" };
            let place = format!("{place}.{table}.{name}");
            let Some(id) = self.resolve(name, &place) else { continue };
            if operation.loads.iter().any(|(m, _)| *m == id) {
                let message = format!("the load on `{name}` is given twice");
                self.report(Diagnostic::new(Code::Conflict, place, message).hint("give a torque or a power, once"));
            } else if seen.contains(&id) {
                let message = format!("`{name}` is held, so its torque is a result");
                self.report(Diagnostic::new(Code::HeldAndDriven, place, message).hint("leave out one of the two"));
            } else {
                operation.loads.push((id, load.clone()));
            }
        }
        operation
    }
}

/// Checks the whole description. `None` when an error was reported.
pub(super) fn assemble(spec: TrainBuilder, has: Has<'_>, diagnostics: &mut Diagnostics) -> Option<Train> {
    let before = diagnostics.len();
    for (what, is, most) in [
        ("meshes", spec.meshes.len() + 2 * spec.sets.len(), MOST_MESHES),
        ("members", spec.members.len() + spec.sets.len(), MOST_MEMBERS),
        ("shift elements", spec.shift_elements.len(), MOST_MEMBERS),
        ("states", spec.states.len(), MOST_STATES),
        ("operations", spec.operations.len(), MOST_OPERATIONS),
        ("bearings, seals and rotors", spec.bearings.len() + spec.seals.len() + spec.rotors.len(), MOST_MEMBERS),
        ("drags and shafts", spec.drags.len() + spec.shafts.len(), MOST_MEMBERS),
        ("scenarios", spec.scenarios.len(), MOST_SCENARIOS),
        ("sources of a scenario", spec.scenarios.iter().map(|s| s.sources.len()).max().unwrap_or(0), MOST_MEMBERS),
    ] {
        if is > most {
            let message = format!("{is} {what}: at most {most} are analysed");
            diagnostics.push(Diagnostic::new(Code::TooLarge, "", message).hint("split the train at a shaft"));
        }
    }
    if diagnostics.len() > before {
        return None;
    }

    let frame = Member { name: "frame".into(), kind: MemberKind::Frame };
    let mut a = Assembler {
        diagnostics,
        members: vec![frame],
        meshes: vec![],
        assumptions: vec![],
        laws: Laws::default(),
        friction_coefficient: crate::losses::mesh_friction::Constant::DEFAULT.mu,
        loss_tables: vec![],
        by_name: HashMap::from([("frame".into(), FRAME)]),
        mesh_names: spec.meshes.iter().filter_map(|m| m.name.clone()).collect(),
    };
    if spec.name.chars().any(char::is_control) {
        bad_name(&mut a, &spec.name, "name", NO_CONTROLS);
    }
    for (k, name) in spec.members.iter().enumerate() {
        let place = format!("members[{k}]");
        if name == "frame" {
            a.report(
                Diagnostic::new(Code::BadName, place, "`frame` always exists and needs no entry").hint("leave it out"),
            );
            continue;
        }
        check_name(&mut a, name, &place, true);
        if a.by_name.contains_key(name) {
            let message = format!("the member `{}` is named twice", clip(name));
            a.report(Diagnostic::new(Code::DuplicateName, place, message).hint("members have different names"));
            continue;
        }
        a.by_name.insert(name.clone(), MemberId(a.members.len()));
        a.members.push(Member { name: name.clone(), kind: MemberKind::Shaft });
    }

    a.choose_laws(&spec.laws, spec.friction_coefficient);
    let lubrication = spec.oil.as_ref().and_then(|o| a.oil(o));
    unique(&mut a, "set", "set", spec.sets.iter().map(|s| s.name.as_str()));
    // Planets exist before anything can refer to them.
    let sets: Vec<_> = spec.sets.iter().map(|s| (s, expand::planets(&mut a, s))).collect();
    for (k, mesh) in spec.meshes.iter().enumerate() {
        a.mesh(mesh, &format!("mesh[{k}]"));
    }
    let mut resolved_sets = Vec::new();
    for (k, (set, planets)) in sets.iter().enumerate() {
        resolved_sets.push(expand::expand(&mut a, set, planets, k));
    }
    let given = spec.meshes.iter().filter_map(|m| m.name.as_deref());
    unique(&mut a, "mesh", "mesh", given);

    unique(&mut a, "shift element", "shift_element", spec.shift_elements.iter().map(|e| e.name.as_str()));
    unique(&mut a, "state", "state", spec.states.iter().map(|s| s.name.as_str()));
    unique(&mut a, "operation", "operation", spec.operations.iter().map(|o| o.name.as_str()));
    let shift_elements: Vec<_> = spec
        .shift_elements
        .iter()
        .enumerate()
        .filter_map(|(k, e)| a.shift_element(e, &format!("shift_element[{k}]")))
        .collect();
    let states: Vec<_> =
        spec.states.iter().enumerate().map(|(k, s)| a.state(s, &spec.shift_elements, &format!("state[{k}]"))).collect();
    let operations: Vec<_> = spec
        .operations
        .iter()
        .enumerate()
        .map(|(k, o)| a.operation(o, &spec.states, format!("operation[{k}]")))
        .collect();

    unique(&mut a, "bearing", "bearing", spec.bearings.iter().map(|b| b.name.as_str()));
    unique(&mut a, "seal", "seal", spec.seals.iter().map(|s| s.name.as_str()));
    unique(&mut a, "rotor", "rotor", spec.rotors.iter().map(|r| r.name.as_str()));
    let mut bearings: Vec<_> =
        (spec.bearings.iter().enumerate()).filter_map(|(k, b)| a.bearing(b, &format!("bearing[{k}]"))).collect();
    let seals: Vec<_> = spec.seals.iter().enumerate().filter_map(|(k, s)| a.seal(s, &format!("seal[{k}]"))).collect();
    let rotors: Vec<_> =
        spec.rotors.iter().enumerate().filter_map(|(k, r)| a.rotor(r, &format!("rotor[{k}]"))).collect();
    a.oil_of_seals(&lubrication, &seals);
    let masses: Vec<(MemberId, f64)> = (sets.iter())
        .flat_map(|(set, planets)| planets.iter().copied().zip(set.planets().into_iter().map(|(_, p)| p.body.mass)))
        .filter_map(|(planet, mass)| Some((planet, mass?)))
        .collect();
    a.housing(&spec.housing);
    for (k, o) in spec.operations.iter().enumerate() {
        let place = format!("operation[{k}].temperature");
        match (o.temperature, &lubrication) {
            (Some(t), Some(l)) => a.temperature(l, t, &place),
            (Some(_), None) if spec.oil.is_none() => a.report(
                Diagnostic::new(Code::MissingKey, place, "a temperature is given, but the train has no oil")
                    .hint("add [oil] with a name of the catalogue, or its viscosities"),
            ),
            _ => {}
        }
    }
    // An oil that is wrong was reported; it is not missing as well.
    if lubrication.is_some() || spec.oil.is_none() {
        a.missing_for_losses(&lubrication, &bearings, &rotors);
    }

    let mut terminals: Vec<MemberId> = Vec::new();
    for (k, name) in spec.terminals.iter().enumerate() {
        let place = format!("terminals[{k}]");
        let Some(id) = a.resolve(name, &place) else { continue };
        if id == FRAME {
            a.report(Diagnostic::new(Code::BadName, place, "the frame is no terminal").hint("leave it out"));
        } else if terminals.contains(&id) {
            let message = format!("the terminal `{name}` is named twice");
            a.report(Diagnostic::new(Code::DuplicateName, place, message).hint("name it once"));
        } else {
            terminals.push(id);
        }
    }
    let input = spec.input.as_ref().and_then(|n| a.resolve(n, "input")).or(terminals.first().copied());
    let output = spec.output.as_ref().and_then(|n| a.resolve(n, "output")).or(terminals.last().copied());
    // Inputs and outputs are terminals without being listed a second time.
    let named = [(input, "input".to_owned()), (output, "output".to_owned())].into_iter();
    let in_states = states
        .iter()
        .enumerate()
        .flat_map(|(k, s)| [(s.input, format!("state[{k}].input")), (s.output, format!("state[{k}].output"))]);
    for (end, place) in named.chain(in_states).filter_map(|(end, place)| Some((end?, place))) {
        if end == FRAME {
            let d = Diagnostic::new(Code::BadName, place, "the frame is at rest: it is neither input nor output");
            a.report(d.hint("name a member that turns"));
        } else if !terminals.contains(&end) {
            terminals.push(end);
        }
    }
    let shifting = shift_elements.iter().flat_map(|e| e.members);
    let central: Vec<MemberId> = terminals.iter().copied().chain(shifting).collect();
    let planets = a.planet_bodies(&masses, &mut bearings, &central);
    let mut inertias = a.inertias(&spec.inertias);
    let moving = !spec.scenarios.is_empty();
    let of_planets = a.planet_inertias(&sets, &resolved_sets, &planets, &inertias, moving);
    inertias.extend(of_planets);
    unique(&mut a, "drag", "drag", spec.drags.iter().map(|d| d.name.as_str()));
    unique(&mut a, "shaft", "shaft", spec.shafts.iter().map(|s| s.name.as_str()));
    unique(&mut a, "scenario", "scenario", spec.scenarios.iter().map(|s| s.name.as_str()));
    unique(&mut a, "study", "study", spec.studies.iter().map(|s| s.name.as_str()));
    a.studies(&spec);
    let drags: Vec<_> = spec.drags.iter().enumerate().filter_map(|(k, d)| a.drag(d, &format!("drag[{k}]"))).collect();
    let shafts: Vec<_> =
        spec.shafts.iter().enumerate().filter_map(|(k, s)| a.shaft(s, &format!("shaft[{k}]"))).collect();
    let scene = dynamic::Scene {
        states: &states,
        elements: spec.shift_elements.iter().map(|e| (e.name.as_str(), e.kind)).collect(),
        shafts: spec.shafts.iter().map(|s| s.name.as_str()).collect(),
    };
    let scenarios: Vec<_> = (spec.scenarios.iter().enumerate())
        .filter_map(|(k, s)| a.scenario(s, &scene, format!("scenario[{k}]")))
        .collect();
    for operation in &operations {
        for (member, load) in &operation.loads {
            if !terminals.contains(member) {
                let name = a.members[member.0].name.clone();
                let table = if matches!(load, super::Load::Torque(_)) { "torques" } else { "powers" };
                let message = format!("`{name}` carries an external load here and is not a terminal");
                a.report(
                    Diagnostic::new(Code::NotATerminal, format!("{}.{table}.{name}", operation.place), message)
                        .hint(format!("add \"{name}\" to `terminals`")),
                );
            }
        }
    }
    if a.meshes.len() > MOST_MESHES || a.members.len() > MOST_MEMBERS {
        let message = format!(
            "{} meshes and {} members: at most {MOST_MESHES} and {MOST_MEMBERS} are analysed",
            a.meshes.len(),
            a.members.len()
        );
        a.report(Diagnostic::new(Code::TooLarge, "", message).hint("split the train at a shaft"));
    }
    if spec.members.is_empty() && a.diagnostics.len() == before {
        a.report(
            Diagnostic::new(Code::MissingKey, "members", "the train has no members")
                .hint("name every rotor: members = [\"sun\", \"ring\", \"carrier\"]"),
        );
    }
    if a.diagnostics.len() == before || !a.diagnostics.has_errors() {
        let touched = (shift_elements.iter().flat_map(|e| e.members))
            .chain(inertias.iter().map(|i| i.member))
            .chain(drags.iter().flat_map(|d| d.members))
            .chain(shafts.iter().flat_map(|s| s.members))
            .chain(scenarios.iter().flat_map(|s| s.sources.iter().map(|x| x.member)))
            .collect();
        loose_members(&mut a, touched);
    }

    let failed = a.diagnostics.iter().skip(before).any(|d| d.severity == crate::diagnostic::Severity::Error);
    let assumptions = a.assumptions();
    let set_planets: Vec<Vec<MemberId>> = sets.iter().map(|(_, planets)| planets.clone()).collect();
    let Assembler { diagnostics, members, meshes, laws, loss_tables, .. } = a;
    let inputs = match failed {
        true => vec![],
        false => {
            let lubrication = lubrication.as_ref();
            let (bearings, planets, set_planets) = (&bearings[..], &planets[..], &set_planets[..]);
            inputs(&spec, &Assembled { meshes: &meshes, lubrication, bearings, planets, set_planets }, has)
        }
    };
    (!failed).then(|| Train {
        name: spec.name,
        source: spec.source,
        members,
        meshes,
        sets: resolved_sets.into_iter().flatten().collect(),
        shift_elements,
        states,
        operations,
        terminals,
        input,
        output,
        warnings: diagnostics.iter().skip(before).cloned().collect(),
        assumptions,
        lubrication,
        laws,
        housing: spec.housing,
        bearings,
        seals,
        rotors,
        planets,
        inertias,
        drags,
        shafts,
        loss_tables,
        scenarios,
        studies: spec.studies,
        inputs,
    })
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

fn check_name(a: &mut Assembler<'_>, name: &str, place: &str, reserve: bool) {
    let why = if name.trim().is_empty() {
        "a name cannot be empty"
    } else if name.chars().count() > 64 {
        "a name has at most 64 characters"
    } else if name.contains('.') && reserve {
        "a name has no dot (it separates a set from its planet)"
    } else if name.chars().any(char::is_control) {
        NO_CONTROLS
    } else {
        return;
    };
    bad_name(a, name, place, why);
}

const NO_CONTROLS: &str = "a name has no control characters";

fn bad_name(a: &mut Assembler<'_>, name: &str, place: &str, why: &str) {
    a.report(Diagnostic::new(Code::BadName, place, format!("`{}`: {why}", clip(&name.escape_debug().to_string()))));
}

fn unique<'n>(a: &mut Assembler<'_>, what: &str, path: &str, names: impl Iterator<Item = &'n str>) {
    let mut seen = HashSet::new();
    for (k, name) in names.enumerate() {
        let place = format!("{path}[{k}].name");
        check_name(a, name, &place, what == "set");
        if !seen.insert(name) {
            let message = format!("a second {what} is called `{}`", clip(name));
            a.report(Diagnostic::new(Code::DuplicateName, place, message).hint("give it another name"));
        }
    }
}

/// Text from the user, short enough for a message.
pub(super) fn clip(text: &str) -> String {
    // What a terminal would obey is shown instead.
    let text: String =
        text.chars().flat_map(|c| if c.is_control() { c.escape_debug().collect() } else { vec![c] }).collect();
    let text = text.as_str();
    if text.chars().count() > 64 { text.chars().take(64).chain(['…']).collect() } else { text.into() }
}

/// Names for a hint, not more than fit a line.
fn list(names: Vec<&str>) -> String {
    const MOST: usize = 12;
    let mut text = names.iter().take(MOST).copied().collect::<Vec<_>>().join(", ");
    if names.len() > MOST {
        text += ", …";
    }
    text
}

impl GearSpec {
    /// Teeth within the bounds that [`Assembler::teeth`] enforces: safe to calculate with.
    pub(super) fn z(&self) -> i64 {
        self.teeth.clamp(1, MOST_TEETH)
    }

    /// What people call this gear's role in a set.
    pub(super) fn role(&self) -> &'static str {
        if self.internal { "ring" } else { "sun" }
    }
}
