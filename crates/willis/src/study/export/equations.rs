//! A gear in motion as equations: one class of Modelica that needs no library.
//!
//! Sources: Modelica Language Specification 3.7, chapters 4 (`input`, `parameter`, `fixed`) and 8.5 (events of relations).
//! The loss of a mesh is that of `LossyGear` in the Modelica Standard Library 4.1.0, without its modes of rest.
//!
//! The speeds that are independent in a state are the only states. All others are their combinations, with fractions, so
//! that no tool has to find constraints between inertias. With the ends `p` and `q` of a mesh, its carrier `c`,
//! `a (ω_p − ω_c) + b (ω_q − ω_c) = 0` and the torques `T_p`, `T_q` of both shafts on the mesh,
//!
//! ```text
//! T_q = b/a T_p η_pq     where p drives: T_p (ω_p − ω_c) ≥ 0
//! T_q = b/a T_p / η_qp   where q drives
//! ```
//!
//! Each group of members that turn as one has an equation of motion. Together they are linear while the same ends drive.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::{self, Rational};
use crate::kinematics::{Configuration, Element, Transfer};
use crate::train::{Contact, Curve, DragMount, FRAME, Inertia, MemberId, Train};

use super::loss_table::string;
use super::map::chosen;
use super::modelica::{at_the_load, fraction};
use super::names::{file, identifiers, line, number};
use super::{Asked, Export, ExportedFile};

/// A drag of Coulomb's kind grows in a straight line up to this relative speed, rad/s: a parameter of the model.
const SLOW: f64 = 1e-3;

fn unfit(message: String, hint: &str) -> Diagnostics {
    Diagnostic::new(Code::Unfit, "", message).hint(hint).into()
}

/// A sum of multiples: `1/5*x - 4*y`; `0` where nothing is left.
fn sum(factors: &[Rational], of: &[String]) -> String {
    let mut text = String::new();
    for (factor, name) in factors.iter().zip(of) {
        if factor.is_zero() {
            continue;
        }
        text += match (text.is_empty(), factor.sign() < 0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let amount = factor.abs();
        if amount != Rational::ONE {
            text += &format!("{}*", fraction(&amount));
        }
        text += name;
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

/// A product; the second factor in brackets where it is a sum or begins with a sign.
fn product(factor: &str, sum: &str) -> String {
    if sum.contains(' ') || sum.starts_with('-') { format!("{factor}*({sum})") } else { format!("{factor}*{sum}") }
}

/// The value of a curve at `x`, which is not negative.
fn curve(curve: &Curve, x: &str) -> String {
    let points = curve.points();
    let mut text = String::new();
    if points.len() > 1 && points[0][0] > 0.0 {
        text += &format!("if {x} < {} then {} else ", number(points[0][0]), number(points[0][1]));
    }
    for w in points.windows(2).filter(|w| w[1][0] > 0.0) {
        let [[x0, y0], [x1, y1]] = [w[0], w[1]];
        let [at, from, rise] = [x0, y0, (y1 - y0) / (x1 - x0)].map(number);
        text += &format!("if {x} < {} then {from} + ({rise})*({x} - ({at})) else ", number(x1));
    }
    text + &number(points[points.len() - 1][1])
}

/// What an element is called: its mesh, or its set where it has all of it.
fn label(train: &Train, e: &Element) -> String {
    let first = &train.meshes()[e.links[0].mesh.index()];
    match (first.set, e.links.len()) {
        (Some(s), n) if n > 1 => train.sets()[s].name.clone(),
        _ => first.name.clone(),
    }
}

pub(super) fn write(train: &Train, request: &Asked) -> Result<Export, Diagnostics> {
    let mut notes = vec![];
    let mut files = vec![];
    let mut wrong = Diagnostics::default();
    for state in chosen(train, request)? {
        let mut own = vec![];
        match one(train, request, state, &mut own) {
            Ok(file) => {
                files.push(file);
                notes.extend(own);
            }
            Err(d) => {
                notes.extend(d.iter().map(|d| format!("left out: {}", d.message)));
                wrong.extend(d);
            }
        }
    }
    if files.is_empty() {
        return Err(wrong);
    }
    if [&request.speeds, &request.torques].into_iter().any(|all| !all.is_empty()) || !request.temperatures.is_empty() {
        notes.push("ranges of speed, torque and temperature have no part in equations".to_owned());
    }
    Ok(Export::new(files, notes))
}

/// Refuses what sliding teeth and rigid shafts in one state are not enough for.
fn check(train: &Train, title: &str) -> Result<(), Diagnostics> {
    if !train.variators().is_empty() {
        return Err(unfit(format!("{title} has a variator, for which this format has no equations"), "export `fmu`"));
    }
    if let Some(s) = train.shafts().iter().find(|s| s.backlash > 0.0) {
        let contact = if s.contact == Contact::Hard { "hard" } else { "soft" };
        let message =
            format!("the shaft {} has backlash with {contact} contact, for which there are no equations", s.name);
        return Err(unfit(message, "export `modelica` or `fmu`, or leave out the backlash"));
    }
    if let Some(table) = train.loss_tables().first() {
        let message = format!(
            "the mesh {} has a loss table over speed, and this format has constant efficiencies",
            train.meshes()[table.mesh.index()].name
        );
        return Err(unfit(message, "export `modelica` or `fmu`"));
    }
    Ok(())
}

/// The class of one state.
fn one(
    train: &Train,
    request: &Asked,
    state: Option<usize>,
    notes: &mut Vec<String>,
) -> Result<ExportedFile, Diagnostics> {
    let of_state = state.map(|k| &train.states()[k]);
    let title = of_state.map_or_else(|| "the train".to_owned(), |s| format!("state {}", s.name));
    check(train, &title)?;
    let mut keep: Vec<MemberId> = train.inertias().iter().flat_map(|i| [i.member, i.reference]).collect();
    keep.extend(train.drags().iter().flat_map(|d| d.members));
    keep.extend(train.shafts().iter().flat_map(|s| s.members));
    let engaged = of_state.map_or(&[][..], |s| &s.engaged);
    let c = Configuration::new(train, engaged, &[], &keep);
    let c = match at_the_load(train, request, notes)? {
        Some(all) => c.with_efficiencies(all),
        None => c,
    };
    let mut class = Class::new(&c, &title)?;
    let missing = class.without_inertia()?;
    class.torques();
    class.inertias(&missing);
    class.efficiencies()?;
    class.speeds();
    let locked = class.meshes();
    class.shafts();
    class.drags();
    class.balances();

    tell(train, &title, &missing, &locked, notes);
    let wanted = format!("{} {}", train.name(), of_state.map_or("", |s| &s.name));
    let name = super::loss_table::class(wanted.trim());
    let mut text = format!("model {name} {}\n", string(&super::origin(train)));
    for note in notes.iter() {
        text += &format!("  // {}\n", line(note));
    }
    text += &format!("{}equation\n{}end {name};\n", class.declarations, class.equations);
    let speeds = count(class.free.len(), "independent speed");
    let about = format!("{title}: {speeds}, {}, no library needed", count(c.elements.len(), "mesh"));
    Ok(ExportedFile { name: file(train.name(), of_state.map(|s| s.name.as_str()), "mo"), text, about })
}

/// How many, and of what.
fn count(n: usize, what: &str) -> String {
    match (n, what.ends_with("sh")) {
        (1, _) => format!("1 {what}"),
        (_, true) => format!("{n} {what}es"),
        (_, false) => format!("{n} {what}s"),
    }
}

/// What a class is made of, as it grows.
struct Class<'c, 't> {
    c: &'c Configuration<'t>,
    title: &'c str,
    /// Members that are shown, and what they are called in the text.
    shown: Vec<MemberId>,
    names: Vec<String>,
    /// Members whose speeds are independent, those speeds and their rates in the text.
    free: Vec<MemberId>,
    free_speeds: Vec<String>,
    rates: Vec<String>,
    /// Speed of each member over the independent ones.
    transfer: Transfer,
    /// What the elements of the train are called by a reader, and in the text.
    labels: Vec<String>,
    elements: Vec<String>,
    declarations: String,
    equations: String,
    /// What acts on each group of members that turn as one: inertias times accelerations, and torques.
    inert: Vec<Vec<String>>,
    acting: Vec<String>,
    /// Terms of the lost power.
    lost: Vec<String>,
}

impl<'c, 't> Class<'c, 't> {
    /// Which members are shown and which speeds are independent: those of terminals first.
    fn new(c: &'c Configuration<'t>, title: &'c str) -> Result<Self, Diagnostics> {
        let train = c.train;
        if let Some(meshes) = c.redundant().first() {
            let names: Vec<&str> = meshes.iter().map(|m| train.meshes()[m.index()].name.as_str()).collect();
            let message = format!("{title}: the torques of {} are statically indeterminate", names.join(", "));
            return Err(unfit(message, "open a shift element, or make a shaft elastic"));
        }
        let shown: Vec<MemberId> = (1..train.members().len()).map(MemberId).filter(|m| !c.inner[m.index()]).collect();
        let names = identifiers(shown.iter().map(|m| train.member_name(*m)), &[]);
        let order: Vec<MemberId> = train.terminals().iter().chain(&shown).copied().collect();
        let free = c.settling(&order);
        if free.is_empty() {
            return Err(unfit(format!("{title}: nothing can move"), "open a shift element"));
        }
        let labels: Vec<String> = c.elements.iter().map(|e| label(train, e)).collect();
        let mut class = Self {
            c,
            title,
            transfer: c.transfer(&free),
            free_speeds: vec![],
            rates: vec![],
            elements: identifiers(labels.iter().map(String::as_str), &[]),
            declarations: String::new(),
            equations: String::new(),
            inert: vec![vec![]; c.nodes],
            acting: vec![String::new(); c.nodes],
            lost: vec![],
            shown,
            names,
            free,
            labels,
        };
        class.free_speeds = class.free.iter().map(|m| class.speed(*m)).collect();
        class.rates = class.free_speeds.iter().map(|w| format!("der({w})")).collect();
        Ok(class)
    }

    fn train(&self) -> &'t Train {
        self.c.train
    }

    /// What a member that is shown is called in the text.
    fn name(&self, m: MemberId) -> &str {
        &self.names[self.shown.iter().position(|s| *s == m).expect("a member that is shown")]
    }

    fn speed(&self, m: MemberId) -> String {
        if m == FRAME { "0".to_owned() } else { format!("speed_{}", self.name(m)) }
    }

    /// Speed of one member relative to another, in the text.
    fn relative(&self, a: MemberId, b: MemberId) -> String {
        match (a == FRAME, b == FRAME) {
            (_, true) => self.speed(a),
            (true, _) => format!("(-{})", self.speed(b)),
            _ => format!("({} - {})", self.speed(a), self.speed(b)),
        }
    }

    /// Factors of the independent speeds in that of a member.
    fn factors(&self, m: MemberId) -> &[Rational] {
        self.transfer.speeds[m.index()].as_deref().expect("settled by the independent ones")
    }

    /// The same in the speed of one member relative to another.
    fn difference(&self, a: MemberId, b: MemberId) -> Vec<Rational> {
        self.factors(a).iter().zip(self.factors(b)).map(|(x, y)| x - y).collect()
    }

    /// Inertias that are not zero.
    fn masses(&self) -> impl Iterator<Item = &'t Inertia> + use<'t> {
        self.train().inertias().iter().filter(|i| i.value > 0.0)
    }

    fn declare(&mut self, what: &str, about: &str) {
        self.declarations += &format!("  {what} {};\n", string(about));
    }

    /// Puts a torque on a member; on the frame it does nothing.
    fn act(&mut self, m: MemberId, sign: &str, torque: &str) {
        if let Some(n) = self.c.node(m) {
            self.acting[n] += &format!(" {sign} {torque}");
        }
    }

    /// Terminals that need an inertia which the file does not have; an error where a motion moves none all the same.
    fn without_inertia(&self) -> Result<Vec<MemberId>, Diagnostics> {
        let train = self.train();
        let mut moved: Vec<Vec<Rational>> = self.masses().map(|i| self.difference(i.member, i.reference)).collect();
        let rank = |rows: &[Vec<Rational>]| exact::rank(rows.to_vec(), self.free.len());
        let mut missing = vec![];
        for &m in train.terminals().iter().filter(|m| self.masses().all(|i| i.member != **m)) {
            let before = rank(&moved);
            moved.push(self.factors(m).to_vec());
            if rank(&moved) > before {
                missing.push(m);
            } else {
                moved.pop();
            }
        }
        if rank(&moved) < self.free.len() {
            let names: Vec<&str> = self.free.iter().map(|m| train.member_name(*m)).collect();
            let message = format!("{}: there is a motion of {} that moves no inertia", self.title, names.join(", "));
            return Err(unfit(message, "give inertias to the members that turn, or make them terminals"));
        }
        Ok(missing)
    }

    /// Torques on the terminals, each once.
    fn torques(&mut self) {
        let terminals = self.train().terminals();
        for (k, &m) in terminals.iter().enumerate() {
            if m == FRAME || terminals[..k].contains(&m) {
                continue;
            }
            let torque = format!("torque_{}", self.name(m));
            let about =
                format!("torque on {} from outside, positive along a positive speed", self.train().member_name(m));
            self.declare(&format!("input Real {torque}(unit=\"N.m\")"), &about);
            self.act(m, "+", &torque);
        }
    }

    /// Inertias against the frame, then those of members against others.
    fn inertias(&mut self, missing: &[MemberId]) {
        let train = self.train();
        for m in self.shown.clone() {
            let given: f64 = self.masses().filter(|i| i.member == m && i.reference == FRAME).map(|i| i.value).sum();
            let value = match (given > 0.0, missing.contains(&m), train.terminals().contains(&m)) {
                (true, ..) => format!(" = {}", number(given)),
                (_, true, _) => String::new(),
                (.., true) => " = 0".to_owned(),
                _ => continue,
            };
            let inertia = format!("inertia_{}", self.name(m));
            let about = format!("inertia of {}", train.member_name(m));
            self.declare(&format!("parameter Real {inertia}(unit=\"kg.m2\"){value}"), &about);
            if let Some(n) = self.c.node(m) {
                let term = product(&inertia, &sum(self.factors(m), &self.rates));
                self.inert[n].push(term);
            }
        }
        for i in self.masses().filter(|i| i.reference != FRAME) {
            let spin = format!("spin_{}", self.name(i.member));
            let [own, other] = [i.member, i.reference].map(|m| train.member_name(m));
            let value = number(i.value);
            self.declare(
                &format!("parameter Real {spin}(unit=\"kg.m2\") = {value}"),
                &format!("inertia of {own} against {other}"),
            );
            let rate = sum(&self.difference(i.member, i.reference), &self.rates);
            for (m, sign) in [(i.member, ""), (i.reference, "-")] {
                if let Some(n) = self.c.node(m) {
                    self.inert[n].push(product(&format!("{sign}{spin}"), &rate));
                }
            }
        }
    }

    /// Efficiencies of the elements and the width of the friction of drags, as parameters.
    fn efficiencies(&mut self) -> Result<(), Diagnostics> {
        let (c, train) = (self.c, self.train());
        for (k, e) in c.elements.iter().enumerate() {
            let what = self.labels[k].clone();
            for (key, value, end) in [("forward", &e.forward, e.p), ("backward", &e.backward, e.q)] {
                let end = train.member_name(end);
                if value.sign() <= 0 {
                    let value = value.to_f64();
                    let message = format!("{}: {end} cannot drive {what}, whose efficiency is {value}", self.title);
                    return Err(unfit(message, "export `fmu`, which has the state of rest of such a mesh"));
                }
                let parameter = format!("parameter Real {key}_{}(min=0) = {}", self.elements[k], fraction(value));
                self.declare(&parameter, &format!("efficiency of {what} where {end} drives relative to its carrier"));
            }
        }
        if train.drags().iter().any(slides) {
            self.declare(
                &format!("parameter Real slow(unit=\"rad/s\") = {}", number(SLOW)),
                "below this relative speed a drag grows with it",
            );
        }
        Ok(())
    }

    /// Speeds: the independent ones are states, the others their combinations.
    fn speeds(&mut self) {
        for m in self.shown.clone() {
            let speed = self.speed(m);
            let is_free = self.free.contains(&m);
            let start = if is_free { ", start=0, fixed=true" } else { "" };
            let about = format!("speed of {}", self.train().member_name(m));
            self.declare(&format!("Real {speed}(unit=\"rad/s\"{start})"), &about);
            if !is_free {
                self.equations += &format!("  {speed} = {};\n", sum(self.factors(m), &self.free_speeds));
            }
        }
    }

    /// Torques of the elements; those that turn as a block are returned.
    fn meshes(&mut self) -> Vec<String> {
        let c = self.c;
        let mut locked = vec![];
        for (k, e) in c.elements.iter().enumerate() {
            let (name, what) = (self.elements[k].clone(), self.labels[k].clone());
            let [p, q] = ["p", "q"].map(|end| format!("{end}_{name}"));
            for (torque, m) in [(&p, e.p), (&q, e.q)] {
                let about = format!("torque of {} on {what}", self.train().member_name(m));
                self.declare(&format!("Real {torque}(unit=\"N.m\")"), &about);
            }
            let factor = if self.difference(e.p, e.carrier).iter().any(|x| !x.is_zero()) {
                let power = format!("{p}*{}", self.relative(e.p, e.carrier));
                self.lost.push(format!("{power} + {q}*{}", self.relative(e.q, e.carrier)));
                format!("*(if {power} >= 0 then forward_{name} else 1/backward_{name})")
            } else {
                locked.push(what);
                String::new()
            };
            self.equations += &format!("  {q} = {}{factor};\n", sum(&[&e.b / &e.a], std::slice::from_ref(&p)));
            self.act(e.p, "-", &p);
            self.act(e.q, "-", &q);
            self.act(e.carrier, "+", &format!("{p} + {q}"));
        }
        locked
    }

    /// Elastic shafts: their twists are states.
    fn shafts(&mut self) {
        let shafts = self.train().shafts();
        for (s, name) in shafts.iter().zip(identifiers(shafts.iter().map(|s| s.name.as_str()), &[])) {
            let [a, b] = s.members;
            self.declare(
                &format!("Real twist_{name}(unit=\"rad\", start=0, fixed=true)"),
                &format!("twist of {}", s.name),
            );
            self.declare(&format!("Real shaft_{name}(unit=\"N.m\")"), &format!("torque of {}", s.name));
            let rate = self.relative(a, b);
            let [k, d] = [s.stiffness, s.damping].map(number);
            self.equations += &format!("  der(twist_{name}) = {rate};\n");
            self.equations += &format!("  shaft_{name} = {k}*twist_{name} + {d}*{rate};\n");
            self.lost.push(format!("{d}*{rate}^2"));
            self.act(a, "-", &format!("shaft_{name}"));
            self.act(b, "+", &format!("shaft_{name}"));
        }
    }

    /// Drags: friction that changes its sign within the width `slow`, and a viscous part.
    fn drags(&mut self) {
        let drags = self.train().drags();
        for (d, name) in drags.iter().zip(identifiers(drags.iter().map(|d| d.name.as_str()), &[])) {
            let [a, b] = d.members;
            let slip = format!("slip_{name}");
            self.declare(&format!("Real {slip}(unit=\"rad/s\")"), &format!("relative speed of {}", d.name));
            self.declare(&format!("Real drag_{name}(unit=\"N.m\")"), &format!("torque of {}", d.name));
            self.equations += &format!("  {slip} = {};\n", self.relative(a, b));
            let coulomb = if slides(d) {
                let amount = curve(&d.torque, &format!("abs({slip})"));
                let amount = if amount.contains(' ') { format!("({amount})") } else { amount };
                format!("{amount}*max(-1, min(1, {slip}/slow)) + ")
            } else {
                String::new()
            };
            self.equations += &format!("  drag_{name} = {coulomb}{}*{slip};\n", number(d.viscous));
            self.lost.push(format!("drag_{name}*{slip}"));
            self.act(a, "-", &format!("drag_{name}"));
            self.act(b, "+", &format!("drag_{name}"));
        }
    }

    /// The equation of motion of each group, and the loss.
    fn balances(&mut self) {
        for (inert, acting) in self.inert.iter().zip(&self.acting) {
            let left = if inert.is_empty() { "0".to_owned() } else { inert.join(" + ") };
            let right = acting.trim_start_matches(" + ").trim_start();
            let right = if right.is_empty() { "0" } else { right };
            self.equations += &format!("  {left} = {right};\n");
        }
        self.declare("output Real loss(unit=\"W\")", "loss of meshes, shafts and drags");
        let lost = if self.lost.is_empty() { "0".to_owned() } else { self.lost.join("\n    + ") };
        self.equations += &format!("  loss = {lost};\n");
    }
}

/// Whether a drag has friction that does not vanish with the speed.
fn slides(drag: &DragMount) -> bool {
    drag.torque.points().iter().any(|p| p[1] > 0.0)
}

/// What the reader of the equations must know.
fn tell(train: &Train, title: &str, missing: &[MemberId], locked: &[String], notes: &mut Vec<String>) {
    let elements = if train.shift_elements().is_empty() {
        String::new()
    } else {
        "; engaged elements are rigid and open ones carry nothing, one-way clutches too".to_owned()
    };
    notes.push(format!("{title}: teeth always slide{elements}: no shift, no stick-slip, no rest under load"));
    notes.push(
        "torques act along positive speed; p_ and q_ are torques of the two ends on a mesh. Where friction locks the train at rest \
         the equations have no solution, and a simulator fails or comes to no end"
            .to_owned(),
    );
    if !missing.is_empty() {
        let names: Vec<&str> = missing.iter().map(|m| train.member_name(*m)).collect();
        notes.push(format!("not in the file, parameters without a value: the inertias of {}", names.join(", ")));
    }
    if !locked.is_empty() {
        let does = if locked.len() == 1 { "turns as a block and loses" } else { "turn as a block and lose" };
        notes.push(format!("{title}: {} {does} nothing", locked.join(", ")));
    }
    if train.drags().iter().any(|d| d.peak > 1.0) {
        notes.push("drags break away at the torque at which they slide: their `peak` is left out".to_owned());
    }
}
