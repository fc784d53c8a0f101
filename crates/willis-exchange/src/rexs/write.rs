//! A train as a REXS file, XML, version 1.6.
//!
//! By the published XML schema: relations first, then components, then load cases. Gears of a set stand on shafts of
//! their own for each planet; a set whose carrier or gear is held in the housing gets a shaft that a coupling joins to it.

use std::collections::{HashMap, VecDeque};
use std::f64::consts::PI;
use std::fmt::Write as _;

use willis::analysis::{OperationReport, Verdict, operate};
use willis::diagnostic::{Code, Diagnostic, Diagnostics, is_printable};
use willis::geometry::Tip;
use willis::train::{Load, MemberId, MemberKind, Mesh, ShiftElementKind, Train};

use crate::account::rounded;

use super::supports::type_of;

/// A written file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Written {
    /// Its text.
    pub text: String,
    /// What a reader must know.
    pub notes: Vec<String>,
}

/// A component to be.
struct Component {
    kind: &'static str,
    name: String,
    attributes: Vec<(&'static str, &'static str, String)>,
}

/// Attributes of one component in a load case.
type Varied = Vec<(usize, Vec<(&'static str, &'static str, String)>)>;

#[derive(Default)]
struct File {
    components: Vec<Component>,
    relations: Vec<(&'static str, Vec<(&'static str, usize)>)>,
    notes: Vec<String>,
}

impl File {
    /// Adds a component; its number is its position, from 1.
    fn add(&mut self, kind: &'static str, name: impl Into<String>) -> usize {
        self.components.push(Component { kind, name: name.into(), attributes: vec![] });
        self.components.len()
    }

    fn set(&mut self, id: usize, attribute: &'static str, unit: &'static str, value: impl ToString) {
        self.components[id - 1].attributes.push((attribute, unit, value.to_string()));
    }

    /// A number; digits in which units leave their traces are dropped.
    fn number(&mut self, id: usize, attribute: &'static str, unit: &'static str, value: f64) {
        self.set(id, attribute, unit, rounded(value) + 0.0);
    }

    fn relate(&mut self, kind: &'static str, refs: &[(&'static str, usize)]) {
        self.relations.push((kind, refs.to_vec()));
    }

    fn vector(&mut self, id: usize, attribute: &'static str, p: [f64; 3]) {
        let p = p.map(|x| format!("<c>{}</c>", rounded(x) + 0.0)).concat();
        self.set(id, attribute, "mm", format!("<array>{p}</array>"));
    }

    /// Where it is, and which way it points.
    fn place(&mut self, id: usize, p: [f64; 3]) {
        self.set(id, "reference_component_for_position", "none", GEAR_UNIT);
        self.vector(id, "support_vector", p);
        self.vector(id, "u_axis_vector", [1.0, 0.0, 0.0]);
        self.vector(id, "w_axis_vector", [0.0, 0.0, 1.0]);
    }
}

const GEAR_UNIT: usize = 1;
const CASING: usize = 2;
/// mm in a metre.
const MM: f64 = 1000.0;

struct Writer<'t> {
    train: &'t Train,
    file: File,
    /// Shafts of members, and of the planets of each by their number.
    shafts: HashMap<MemberId, usize>,
    planets: HashMap<MemberId, Vec<usize>>,
    /// Where axes are across the main one, mm.
    axes: HashMap<MemberId, [f64; 2]>,
    held: Option<usize>,
    /// Gears that are there: their shaft and what they are.
    gears: HashMap<(usize, String), Vec<usize>>,
    materials: Vec<([f64; 2], usize)>,
}

/// Writes a train.
///
/// # Errors
/// What a REXS file has no words for and without which it would be another train: bevel gears and chains, variators,
/// planets without a tooth count, planets that no set names.
pub fn write(train: &Train) -> Result<Written, Diagnostics> {
    written(train, true)
}

/// The same; without what only an equilibrium tells, it is quick.
pub fn written(train: &Train, solved: bool) -> Result<Written, Diagnostics> {
    possible(train)?;
    let mut w = Writer {
        train,
        file: File::default(),
        shafts: HashMap::new(),
        planets: HashMap::new(),
        axes: axes(train),
        held: None,
        gears: HashMap::new(),
        materials: vec![],
    };
    w.unit();
    w.members();
    w.meshes();
    w.bearings();
    w.elements();
    let cases = w.loads(solved);
    w.file.notes.extend(left_out(train));
    Ok(Written { text: w.text(&cases), notes: w.file.notes })
}

/// What of a train a reader of the file does not find.
fn left_out(train: &Train) -> Option<String> {
    let loses =
        |m: &&Mesh| !m.computed && (m.efficiency.forward.to_f64() < 1.0 || m.efficiency.backward.to_f64() < 1.0);
    let given = train.meshes().iter().filter(loses).count();
    let parts = [
        ("given mesh efficiency", "given mesh efficiencies", given),
        ("seal", "seals", train.seals().len()),
        ("oil pump", "oil pumps", train.pumps().len()),
        ("rotor", "rotors", train.rotors().len()),
        ("drag", "drags", train.drags().len()),
        ("loss table", "loss tables", train.loss_tables().len()),
        ("inertia", "inertias", train.inertias().iter().filter(|i| i.value > 0.0).count()),
        ("compliant shaft", "compliant shafts", train.shafts().len()),
        ("scenario", "scenarios", train.scenarios().len()),
        ("thermal network", "thermal networks", usize::from(train.heat().is_some())),
    ];
    let some = parts.into_iter().filter(|p| p.2 > 0);
    let words = some.map(|(one, many, n)| format!("{n} {}", if n == 1 { one } else { many }));
    let words = words.collect::<Vec<_>>().join(", ");
    (!words.is_empty()).then(|| format!("not carried over: {words}"))
}

/// Refuses what cannot be said.
fn possible(train: &Train) -> Result<(), Diagnostics> {
    let mut wrong = Diagnostics::default();
    let mut refuse = |message: String, hint: &str| {
        wrong.push(Diagnostic::new(Code::Unfit, "", message).hint(hint));
    };
    const REMOVE: &str = "remove it to export the rest";
    for mesh in train.meshes() {
        let planets =
            mesh.gears.iter().filter(|g| train.members()[g.member.index()].kind == MemberKind::Planet).count();
        let on_carrier = train.members()[mesh.carrier.index()].kind != MemberKind::Frame;
        let internal = mesh.gears.iter().any(|g| g.internal);
        if mesh.bevel || mesh.same_sense != internal {
            refuse(format!("`{}` is no pair of cylindrical gears, and this format has no other", mesh.name), REMOVE);
        } else if on_carrier && planets == 0 {
            let hint = "write its gears as a set: only there it is said which of them is the planet";
            refuse(format!("nothing says which gear of `{}` is the planet", mesh.name), hint);
        } else if mesh.gears.iter().any(|g| g.teeth.to_f64().fract() != 0.0) {
            let hint = "give the teeth of the planets";
            refuse(format!("the planets of `{}` have no tooth count", mesh.name), hint);
        }
    }
    for variator in train.variators() {
        refuse(format!("the variator `{}` has no place in this format", variator.name), REMOVE);
    }
    if wrong.has_errors() { Err(wrong) } else { Ok(()) }
}

/// Gears of the gearbox: the states, and one with nothing closed if an operation runs so.
fn gears(train: &Train) -> usize {
    let states = train.states().len();
    let as_drawn = states > 0 && train.operations().iter().any(|o| o.state.is_none());
    states + usize::from(as_drawn)
}

/// Where axes lie, as far as the angles between them are given: members of a set share one.
fn axes(train: &Train) -> HashMap<MemberId, [f64; 2]> {
    let is_planet = |m: MemberId| train.members()[m.index()].kind == MemberKind::Planet;
    let is_frame = |m: MemberId| train.members()[m.index()].kind == MemberKind::Frame;
    let mut edges: HashMap<MemberId, Vec<(MemberId, [f64; 2])>> = HashMap::new();
    let mut join = |a: MemberId, b: MemberId, d: [f64; 2]| {
        if !is_frame(a) && !is_frame(b) && !is_planet(a) && !is_planet(b) {
            edges.entry(a).or_default().push((b, d));
            edges.entry(b).or_default().push((a, [-d[0], -d[1]]));
        }
    };
    let mut first_of_set: HashMap<usize, MemberId> = HashMap::new();
    for mesh in train.meshes() {
        let [a, b] = [mesh.gears[0].member, mesh.gears[1].member];
        if let Some(set) = mesh.set {
            for member in [a, b, mesh.carrier].into_iter().filter(|m| !is_planet(*m) && !is_frame(*m)) {
                let first = *first_of_set.entry(set).or_insert(member);
                join(first, member, [0.0, 0.0]);
            }
        } else if let (Some(angle), Some(teeth)) = (mesh.angle, &mesh.teeth) {
            let a_mm = teeth.pair.centre_distance * MM;
            join(a, b, [a_mm * angle.cos(), a_mm * angle.sin()]);
        }
    }
    let mut all: HashMap<MemberId, [f64; 2]> = HashMap::new();
    let mut starts: Vec<MemberId> = edges.keys().copied().collect();
    starts.sort_by_key(|m| m.index());
    for start in starts {
        if all.contains_key(&start) {
            continue;
        }
        all.insert(start, [0.0, 0.0]);
        let mut next = VecDeque::from([start]);
        while let Some(from) = next.pop_front() {
            let at = all[&from];
            for (to, d) in &edges[&from] {
                if !all.contains_key(to) {
                    all.insert(*to, [at[0] + d[0], at[1] + d[1]]);
                    next.push_back(*to);
                }
            }
        }
    }
    all
}

impl Writer<'_> {
    fn kind(&self, m: MemberId) -> MemberKind {
        self.train.members()[m.index()].kind
    }

    fn unit(&mut self) {
        let unit = self.file.add("gear_unit", self.train.name());
        let states = gears(self.train).max(1);
        self.file.set(unit, "number_of_gears", "none", states);
        let casing = self.file.add("gear_casing", "housing");
        self.file.relate("assembly", &[("assembly", unit), ("part", casing)]);
        debug_assert_eq!([unit, casing], [GEAR_UNIT, CASING]);
        if let Some(lubrication) = self.train.lubrication() {
            let oil = &lubrication.oil;
            let id = self.file.add("lubricant", &*oil.name);
            let nu = |celsius: f64| oil.kinematic_viscosity(celsius + 273.15) * 1e6;
            if nu(100.0) < nu(40.0) {
                self.file.number(id, "viscosity_at_40_degree_celsius", "mm^2 / s", nu(40.0));
                self.file.number(id, "viscosity_at_100_degree_celsius", "mm^2 / s", nu(100.0));
            } else {
                let told =
                    "the oil has one viscosity at all temperatures, which is left out: this format wants it at two";
                self.file.notes.push(told.into());
            }
            self.file.number(id, "density_at_15_degree_celsius", "kg / dm^3", oil.density_15 / 1000.0);
            self.file.set(id, "name", "none", escaped(&oil.name));
            self.file.relate("reference", &[("origin", CASING), ("referenced", id)]);
        }
    }

    fn members(&mut self) {
        for (k, member) in self.train.members().iter().enumerate() {
            if member.kind != MemberKind::Shaft {
                continue;
            }
            let Some(id) = self.train.member(&member.name) else { continue };
            debug_assert_eq!(id.index(), k);
            let shaft = self.shaft(&member.name, self.axes.get(&id).copied());
            self.shafts.insert(id, shaft);
        }
    }

    fn shaft(&mut self, name: &str, axis: Option<[f64; 2]>) -> usize {
        let shaft = self.file.add("shaft", name);
        self.file.relate("assembly", &[("assembly", GEAR_UNIT), ("part", shaft)]);
        if let Some([v, w]) = axis {
            self.file.place(shaft, [0.0, v, w]);
        }
        shaft
    }

    /// The shaft of a member; one that is held in the housing for the housing.
    fn shaft_of(&mut self, m: MemberId) -> usize {
        if self.kind(m) != MemberKind::Frame {
            return self.shafts[&m];
        }
        if let Some(held) = self.held {
            return held;
        }
        let held = self.shaft("held in the housing", Some([0.0, 0.0]));
        let coupling = self.file.add("coupling", "held in the housing");
        self.file.relate("assembly", &[("assembly", GEAR_UNIT), ("part", coupling)]);
        self.file.relate("side", &[("assembly", coupling), ("inner_part", held), ("outer_part", CASING)]);
        self.held = Some(held);
        held
    }

    fn meshes(&mut self) {
        let train = self.train;
        let mut stages: HashMap<usize, usize> = HashMap::new();
        for mesh in train.meshes() {
            match mesh.set {
                None => {
                    let shafts = mesh.gears.each_ref().map(|g| self.shaft_of(g.member));
                    for _ in 0..mesh.count {
                        self.stage(mesh, shafts, None, &mesh.name);
                    }
                }
                Some(set) => {
                    let stage = match stages.get(&set) {
                        Some(stage) => *stage,
                        None => {
                            let stage = self.planetary(set, mesh.carrier);
                            stages.insert(set, stage);
                            stage
                        }
                    };
                    self.of_set(mesh, stage);
                }
            }
        }
    }

    fn planetary(&mut self, set: usize, carrier: MemberId) -> usize {
        let name = self.train.sets()[set].name.clone();
        let stage = self.file.add("planetary_stage", &*name);
        self.file.relate("assembly", &[("assembly", GEAR_UNIT), ("part", stage)]);
        let shaft = self.shaft_of(carrier);
        // What reads it may call the carrier by this.
        let called = match self.kind(carrier) {
            MemberKind::Frame => format!("carrier of {name}"),
            _ => self.train.member_name(carrier).to_owned(),
        };
        let body = self.file.add("planet_carrier", called);
        self.file.relate("assembly", &[("assembly", stage), ("part", body)]);
        self.file.relate("assembly", &[("assembly", body), ("part", shaft)]);
        self.file.relate("planet_carrier_shaft", &[("planetary_stage", stage), ("shaft", shaft)]);
        stage
    }

    /// A mesh of a set: once for each planet.
    fn of_set(&mut self, mesh: &Mesh, stage: usize) {
        let count = mesh.count as usize;
        let mut sides: [Vec<usize>; 2] = [vec![], vec![]];
        for k in [0, 1] {
            let member = mesh.gears[k].member;
            if self.kind(member) == MemberKind::Planet {
                let distance = mesh.teeth.as_ref().map(|t| t.pair.centre_distance * MM);
                sides[k] = self.planet_shafts(member, mesh.carrier, count, distance, stage);
            } else {
                let shaft = self.shaft_of(member);
                let central = ("central_shaft", vec![("planetary_stage", stage), ("shaft", shaft)]);
                if !self.file.relations.contains(&central) {
                    self.file.relations.push(central);
                }
                sides[k] = vec![shaft; count];
            }
        }
        for planet in 0..count {
            let shafts = [sides[0][planet.min(sides[0].len() - 1)], sides[1][planet.min(sides[1].len() - 1)]];
            self.stage(mesh, shafts, Some(stage), &format!("{} {}", mesh.name, planet + 1));
        }
    }

    fn planet_shafts(
        &mut self,
        member: MemberId,
        carrier: MemberId,
        count: usize,
        distance: Option<f64>,
        stage: usize,
    ) -> Vec<usize> {
        if let Some(known) = self.planets.get(&member) {
            return known.clone();
        }
        let centre = self.axes.get(&carrier).copied().unwrap_or([0.0, 0.0]);
        let name = self.train.member_name(member).replace('.', " ");
        let mut all = vec![];
        for k in 0..count {
            let turn = 2.0 * PI * k as f64 / count as f64;
            let axis = distance.map(|a| [centre[0] + a * turn.cos(), centre[1] + a * turn.sin()]);
            let shaft = self.shaft(&format!("{name} {}", k + 1), axis);
            self.file.relate("planet_shaft", &[("planetary_stage", stage), ("shaft", shaft)]);
            all.push(shaft);
        }
        self.planets.insert(member, all.clone());
        all
    }

    /// One pair of gears; two halves of a double helical one.
    fn stage(&mut self, mesh: &Mesh, shafts: [usize; 2], planetary: Option<usize>, name: &str) {
        let gears = [self.gear(mesh, 0, shafts[0], name), self.gear(mesh, 1, shafts[1], name)];
        for half in 0..gears[0].len().min(gears[1].len()) {
            let stage = self.file.add("cylindrical_stage", name);
            if let Some(teeth) = &mesh.teeth {
                self.file.number(stage, "center_distance", "mm", teeth.pair.centre_distance * MM);
                self.file.number(stage, "common_face_width", "mm", teeth.pair.data.width * MM);
            }
            self.file.relate("assembly", &[("assembly", planetary.unwrap_or(GEAR_UNIT)), ("part", stage)]);
            self.file.relate("stage", &[("stage", stage), ("gear_1", gears[0][half]), ("gear_2", gears[1][half])]);
        }
    }

    /// A gear of a mesh on a shaft: one, or two of opposite hand. The same gear in two meshes is one.
    fn gear(&mut self, mesh: &Mesh, k: usize, shaft: usize, name: &str) -> Vec<usize> {
        let gear = &mesh.gears[k];
        let count = gear.teeth.to_f64();
        let data = mesh.teeth.as_ref().map(|t| (&t.pair.data, &t.pair.data.wheels[k], t));
        // Gears of a planet mesh with several others; elsewhere a gear may as well be two.
        let shape = data.map(|(d, w, _)| format!("{} {} {:?}", d.module, d.helix, (w.shift, w.tip)));
        let key = (shaft, format!("{count} {} {shape:?}", gear.internal));
        let is_in_set = mesh.set.is_some();
        if let Some(known) = self.gears.get(&key).filter(|_| is_in_set) {
            return known.clone();
        }
        let halves = if data.is_some_and(|(d, ..)| d.double_helical) { 2 } else { 1 };
        let mut all = vec![];
        for half in 0..halves {
            let kind = if gear.internal { "ring_gear" } else { "cylindrical_gear" };
            let id =
                self.file.add(kind, format!("{} of {name}", self.train.member_name(gear.member).replace('.', " ")));
            self.file.relate("assembly", &[("assembly", shaft), ("part", id)]);
            self.file.set(id, "number_of_teeth", "none", count);
            if let Some((d, wheel, teeth)) = data {
                // A double helical pair has no hand of its own: suns begin with a right-hand half.
                let is_second =
                    gear.internal || self.kind(gear.member) == MemberKind::Planet || mesh.set.is_none() && k == 1;
                let own = if is_second { -1.0 } else { 1.0 };
                let first = if d.double_helical || teeth.hand == 0.0 { own } else { teeth.hand_of(k) };
                let hand = if half == 0 { first } else { -first };
                self.file.number(id, "normal_module", "mm", d.module * MM);
                self.file.number(id, "face_width", "mm", d.width * MM);
                self.file.number(id, "helix_angle_reference_diameter", "deg", hand * d.helix.to_degrees());
                self.file.number(id, "arithmetic_average_roughness_flank", "mum", teeth.roughness[k] * 1e6);
                // The usual tip follows from the rest.
                if !matches!(wheel.tip, Tip::Addendum { coefficient: 1.0, alteration: 0.0 }) {
                    self.file.number(id, "tip_diameter", "mm", 2.0 * MM * teeth.pair.gears[k].tip_radius);
                }
                if let Some(position) = teeth.position {
                    let off = if halves == 2 { (half as f64 - 0.5) * d.width } else { 0.0 };
                    let u = (position + off) * MM;
                    self.file.number(id, "u_coordinate_on_shaft", "mm", u);
                    self.place_on(id, shaft, u);
                } else if mesh.set.is_none() && mesh.angle.is_some() {
                    self.place_on(id, shaft, 0.0);
                }
                let flanks = [0, 1].map(|_| {
                    let flank = self.file.add("cylindrical_gear_flank", "");
                    let angle = d.pressure_angle.to_degrees();
                    self.file.number(flank, "normal_pressure_angle", "deg", angle);
                    // DIN 3960 counts towards the tip, inward on a ring.
                    let shift = if gear.internal { -wheel.shift } else { wheel.shift };
                    self.file.number(flank, "addendum_modification_coefficient", "none", shift);
                    flank
                });
                self.file.relate("flank", &[("gear", id), ("left", flanks[0]), ("right", flanks[1])]);
                let material = self.material([teeth.youngs_modulus, teeth.poisson_ratio]);
                self.file.relate("reference", &[("origin", id), ("referenced", material)]);
            }
            all.push(id);
        }
        self.gears.insert(key, all.clone());
        all
    }

    /// A part on a shaft, at that position along the axis.
    fn place_on(&mut self, id: usize, shaft: usize, u: f64) {
        let axis = self.file.components[shaft - 1].attributes.iter().find(|a| a.0 == "support_vector");
        let across = axis.map(|a| {
            let all: Vec<f64> = a.2.split(['<', '>']).filter_map(|t| t.parse().ok()).collect();
            [all[1], all[2]]
        });
        if let Some([v, w]) = across {
            self.file.place(id, [u, v, w]);
        }
    }

    fn material(&mut self, [modulus, ratio]: [f64; 2]) -> usize {
        if let Some((_, id)) = self.materials.iter().find(|m| m.0 == [modulus, ratio]) {
            return *id;
        }
        let id = self.file.add("material", "gears");
        self.file.number(id, "elastic_modulus", "N / mm^2", modulus / 1e6);
        self.file.number(id, "poisson_ratio", "none", ratio);
        self.materials.push(([modulus, ratio], id));
        id
    }

    fn bearings(&mut self) {
        let train = self.train;
        for mount in train.bearings() {
            let Some(kind) = type_of(mount.bearing.kind) else {
                self.file.notes.push(format!(
                    "`{}`, a {}, is left out: this format has no such bearing",
                    mount.name, mount.bearing.kind
                ));
                continue;
            };
            let sides = mount.members.map(|m| match self.kind(m) {
                MemberKind::Frame => vec![CASING],
                MemberKind::Planet => self.planets.get(&m).cloned().unwrap_or_default(),
                MemberKind::Shaft => vec![self.shafts[&m]],
            });
            let places = sides[0].len().max(sides[1].len());
            if sides.iter().any(Vec::is_empty) {
                continue;
            }
            for place in 0..places {
                let at = |k: usize| sides[k][place.min(sides[k].len() - 1)];
                // Planets turn around what carries them, shafts in the housing.
                let outer_first = self.kind(mount.members[0]) == MemberKind::Planet;
                let (inner, outer) = if outer_first { (at(1), at(0)) } else { (at(0), at(1)) };
                for n in 0..mount.count {
                    let id = self.file.add("rolling_bearing_with_catalog_geometry", &*mount.name);
                    self.file.relate("assembly", &[("assembly", GEAR_UNIT), ("part", id)]);
                    self.file.relate("side", &[("assembly", id), ("inner_part", inner), ("outer_part", outer)]);
                    let b = &mount.bearing;
                    self.file.set(id, "catalogue_designation", "none", escaped(&b.designation));
                    self.file.set(id, "bearing_type", "none", kind);
                    self.file.number(id, "inner_diameter", "mm", b.bore * MM);
                    self.file.number(id, "outer_diameter", "mm", b.outside_diameter * MM);
                    self.file.number(id, "width", "mm", b.width * MM);
                    if let Some(locates) = mount.locates {
                        let word = if locates { "both_directions" } else { "no_direction" };
                        self.file.set(id, "axial_force_absorption", "none", word);
                    }
                    let part = if mount.count > 1 { f64::from(n) / f64::from(mount.count - 1) - 0.5 } else { 0.0 };
                    let u = match (mount.position, mount.span) {
                        (None, None) => continue,
                        (middle, span) => (middle.unwrap_or(0.0) + part * span.unwrap_or(0.0)) * MM,
                    };
                    self.file.number(id, "u_coordinate_on_shaft_inner_side", "mm", u);
                    let shaft = if outer_first { outer } else { inner };
                    self.place_on(id, shaft, u);
                }
            }
        }
    }

    fn elements(&mut self) {
        let train = self.train;
        for (k, element) in train.shift_elements().iter().enumerate() {
            let [a, b] = element.members;
            let sides = [a, b].map(|m| if self.kind(m) == MemberKind::Frame { CASING } else { self.shafts[&m] });
            let (inner, outer) = if sides[0] == CASING { (sides[1], sides[0]) } else { (sides[0], sides[1]) };
            let id = self.file.add("switchable_coupling", &*element.name);
            self.file.relate("assembly", &[("assembly", GEAR_UNIT), ("part", id)]);
            self.file.relate("side", &[("assembly", id), ("inner_part", inner), ("outer_part", outer)]);
            let closed = |s: &willis::train::State| s.engaged.iter().any(|e| e.index() == k);
            let mut flags: Vec<bool> = train.states().iter().map(closed).collect();
            flags.resize(gears(train).max(1), false);
            let flags: String = flags.iter().map(|f| format!("<c>{f}</c>")).collect();
            self.file.set(id, "is_engaged", "none", format!("<array>{flags}</array>"));
            if element.kind == ShiftElementKind::OneWay {
                let told = format!(
                    "`{}` is a one-way clutch and becomes a coupling: this format has no such part",
                    element.name
                );
                self.file.notes.push(told);
            }
        }
        if !train.states().is_empty() {
            let names: Vec<String> =
                train.states().iter().enumerate().map(|(k, s)| format!("{} is {}", k + 1, s.name)).collect();
            self.file.notes.push(format!("gears have numbers in this format: {}", names.join(", ")));
        }
    }

    /// Loads, speeds and temperatures: in the model itself for one operation, in load cases for several.
    fn loads(&mut self, solved: bool) -> Vec<Varied> {
        let train = self.train;
        let mut loads: Vec<(MemberId, usize)> = vec![];
        for terminal in train.terminals() {
            if self.kind(*terminal) != MemberKind::Shaft {
                continue;
            }
            let id = self.file.add("external_load", format!("on {}", train.member_name(*terminal)));
            self.file.relate("assembly", &[("assembly", self.shafts[terminal]), ("part", id)]);
            self.file.set(id, "transmits_torque", "none", true);
            loads.push((*terminal, id));
        }
        let base = train.lubrication().map(|l| l.temperature);
        let mut cases: Vec<Varied> = vec![];
        for operation in train.operations() {
            let report: Option<OperationReport> =
                if solved { operate(train, operation).ok().map(|(report, _)| report) } else { None };
            let unique = report.as_ref().filter(|r| r.verdict == Verdict::Unique).and_then(|r| r.solutions.first());
            let mut case: Varied = vec![];
            if !train.states().is_empty() {
                let gear = operation.state.map_or(gears(train), |state| state + 1);
                case.push((GEAR_UNIT, vec![("gear_shift_index", "none", gear.to_string())]));
            }
            for (k, member) in train.members().iter().enumerate() {
                let Some(id) = train.member(&member.name).filter(|id| self.shafts.contains_key(id)) else { continue };
                debug_assert_eq!(id.index(), k);
                let given = operation.speeds.iter().find(|s| s.0 == id).map(|s| s.1.si());
                let given = given.or_else(|| operation.fixed.contains(&id).then_some(0.0));
                let follows = report.as_ref().and_then(|r| *r.speeds_rad_s.get(&member.name)?);
                let Some(speed) = given.or(follows) else { continue };
                case.push((
                    self.shafts[&id],
                    vec![
                        ("defines_speed", "none", given.is_some().to_string()),
                        ("rotational_speed", "1 / min", text(speed * 30.0 / PI)),
                    ],
                ));
            }
            for (member, id) in &loads {
                let given = operation.loads.iter().find(|l| l.0 == *member).map(|l| &l.1);
                let defines = ("defines_torque", "none", given.is_some().to_string());
                let value = match given {
                    Some(Load::Torque(t)) => Some(("torque_around_u_axis", "N m", text(t.si()))),
                    Some(Load::Power(p)) => Some(("power", "kW", text(p.si() / 1000.0))),
                    None => {
                        let found = unique.and_then(|s| s.members.get(train.member_name(*member))?.torque_n_m);
                        found.map(|t| ("torque_around_u_axis", "N m", text(t)))
                    }
                };
                case.push((*id, [Some(defines), value].into_iter().flatten().collect()));
            }
            if let Some(t) = operation.temperature.or(base) {
                case.push((CASING, vec![("temperature_lubricant", "C", text(t - 273.15))]));
            }
            if !operation.stores.is_empty() || !operation.machines.is_empty() {
                self.file.notes.push(format!("what variators do in `{}` is left out", operation.name));
            }
            cases.push(case);
        }
        if cases.len() == 1 {
            for (id, attributes) in cases.remove(0) {
                self.file.components[id - 1].attributes.extend(attributes);
            }
        } else if cases.is_empty()
            && let Some(t) = base
        {
            self.file.number(CASING, "temperature_lubricant", "C", t - 273.15);
        } else {
            let names = train.operations().iter().enumerate().map(|(k, o)| format!("{} is {}", k + 1, o.name));
            let names: Vec<String> = names.collect();
            if !names.is_empty() {
                self.file.notes.push(format!("load cases have numbers in this format: {}", names.join(", ")));
            }
        }
        cases
    }

    fn text(&self, cases: &[Varied]) -> String {
        let mut out = String::from("\u{feff}<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?>\n");
        // The crate has no clock.
        let _ = writeln!(
            out,
            "<model version=\"{}\" applicationId=\"Willis\" applicationVersion=\"{}\" date=\"1970-01-01T00:00:00+00:00\">",
            super::VERSION,
            env!("CARGO_PKG_VERSION")
        );
        out.push_str("  <relations>\n");
        for (k, (kind, refs)) in self.file.relations.iter().enumerate() {
            let _ = writeln!(out, "    <relation id=\"{}\" type=\"{kind}\">", k + 1);
            for (role, id) in refs {
                let hint = self.file.components[id - 1].kind;
                let _ = writeln!(out, "      <ref hint=\"{hint}\" id=\"{id}\" role=\"{role}\" />");
            }
            out.push_str("    </relation>\n");
        }
        out.push_str("  </relations>\n  <components>\n");
        for (k, c) in self.file.components.iter().enumerate() {
            let name = if c.name.is_empty() { String::new() } else { format!(" name=\"{}\"", escaped(&c.name)) };
            let head = format!("<component id=\"{}\"{name} type=\"{}\"", k + 1, c.kind);
            component(&mut out, "    ", &head, &c.attributes);
        }
        out.push_str("  </components>\n");
        if !cases.is_empty() {
            out.push_str("  <load_spectrum id=\"1\">\n");
            for (k, case) in cases.iter().enumerate() {
                let _ = writeln!(out, "    <load_case id=\"{}\">", k + 1);
                for (id, attributes) in case {
                    let head = format!("<component id=\"{id}\" type=\"{}\"", self.file.components[id - 1].kind);
                    component(&mut out, "      ", &head, attributes);
                }
                out.push_str("    </load_case>\n");
            }
            out.push_str("  </load_spectrum>\n");
        }
        out + "</model>\n"
    }
}

fn component(out: &mut String, indent: &str, head: &str, attributes: &[(&'static str, &'static str, String)]) {
    if attributes.is_empty() {
        let _ = writeln!(out, "{indent}{head} />");
        return;
    }
    let _ = writeln!(out, "{indent}{head}>");
    for (id, unit, value) in attributes {
        let _ = writeln!(out, "{indent}  <attribute id=\"{id}\" unit=\"{unit}\">{value}</attribute>");
    }
    let _ = writeln!(out, "{indent}</component>");
}

/// A number of a load case.
fn text(x: f64) -> String {
    (rounded(x) + 0.0).to_string()
}

/// A text inside XML.
fn escaped(text: &str) -> String {
    let plain: String = text.chars().map(|c| if is_printable(c) { c } else { ' ' }).collect();
    plain.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
