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
use crate::exact::{Rational, reduce};
use crate::kinematics::{Configuration, Element};
use crate::train::{Contact, Curve, FRAME, MemberId, Train};

use super::loss_table::{class, string};
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
fn sum<'n>(terms: impl IntoIterator<Item = (&'n Rational, &'n str)>) -> String {
    let mut text = String::new();
    for (factor, name) in terms {
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
    let redundant = c.redundant();
    if let Some(meshes) = redundant.first() {
        let names: Vec<&str> = meshes.iter().map(|m| train.meshes()[m.index()].name.as_str()).collect();
        let message = format!("{title}: the torques of {} are statically indeterminate", names.join(", "));
        return Err(unfit(message, "open a shift element, or make a shaft elastic"));
    }

    // Members that are shown, and independent speeds: those of terminals first.
    let shown: Vec<MemberId> = (1..train.members().len()).map(MemberId).filter(|m| !c.inner[m.index()]).collect();
    let names = identifiers(shown.iter().map(|m| train.member_name(*m)), &[]);
    let own = |m: MemberId| -> &str { &names[shown.iter().position(|s| *s == m).expect("a member that is shown")] };
    let order: Vec<MemberId> = train.terminals().iter().chain(&shown).copied().collect();
    let free = c.settling(&order);
    if free.is_empty() {
        return Err(unfit(format!("{title}: nothing can move"), "open a shift element"));
    }
    let transfer = c.transfer(&free);
    let speed_of = |m: MemberId| transfer.speeds[m.index()].as_deref().expect("settled by the independent ones");
    let speed = |m: MemberId| if m == FRAME { "0".to_owned() } else { format!("speed_{}", own(m)) };
    let of_free = |prefix: &str, end: &str| -> Vec<String> {
        free.iter().map(|m| format!("{prefix}speed_{}{end}", own(*m))).collect()
    };
    let (free_speeds, rates) = (of_free("", ""), of_free("der(", ")"));
    let relative = |a: MemberId, b: MemberId| match (a == FRAME, b == FRAME) {
        (_, true) => speed(a),
        (true, _) => format!("(-{})", speed(b)),
        _ => format!("({} - {})", speed(a), speed(b)),
    };
    let difference = |a: MemberId, b: MemberId| -> Vec<Rational> {
        speed_of(a).iter().zip(speed_of(b)).map(|(x, y)| x - y).collect()
    };

    // Whether every motion moves an inertia; a terminal without one may be asked for it.
    let inertias: Vec<_> = train.inertias().iter().filter(|i| i.value > 0.0).collect();
    let mut moved: Vec<Vec<Rational>> = inertias.iter().map(|i| difference(i.member, i.reference)).collect();
    let rank = |rows: &[Vec<Rational>]| reduce(&mut rows.to_vec(), free.len()).len();
    let mut missing = vec![];
    for &m in train.terminals().iter().filter(|m| inertias.iter().all(|i| i.member != **m)) {
        let before = rank(&moved);
        moved.push(speed_of(m).to_vec());
        if rank(&moved) > before {
            missing.push(m);
        } else {
            moved.pop();
        }
    }
    if rank(&moved) < free.len() {
        let names: Vec<&str> = free.iter().map(|m| train.member_name(*m)).collect();
        let message = format!("{title}: there is a motion of {} that moves no inertia", names.join(", "));
        return Err(unfit(message, "give inertias to the members that turn, or make them terminals"));
    }

    let labels: Vec<String> = c.elements.iter().map(|e| label(train, e)).collect();
    let meshes = identifiers(labels.iter().map(String::as_str), &[]);
    let shafts = identifiers(train.shafts().iter().map(|s| s.name.as_str()), &[]);
    let drags = identifiers(train.drags().iter().map(|d| d.name.as_str()), &[]);
    let slides = |d: &crate::train::DragMount| d.torque.points().iter().any(|p| p[1] > 0.0);

    let mut top = String::new();
    let mut equations = String::new();
    // What acts on the group of each member: an inertia times its acceleration, and torques.
    let mut inert: Vec<Vec<String>> = vec![vec![]; c.nodes];
    let mut acting: Vec<String> = vec![String::new(); c.nodes];
    let act = |acting: &mut Vec<String>, m: MemberId, sign: &str, torque: &str| {
        if let Some(n) = c.node(m) {
            acting[n] += &format!(" {sign} {torque}");
        }
    };
    for (k, &m) in train.terminals().iter().enumerate() {
        if m == FRAME || train.terminals()[..k].contains(&m) {
            continue;
        }
        let name = own(m);
        let about =
            string(&format!("torque on {} from outside, positive along a positive speed", train.member_name(m)));
        top += &format!("  input Real torque_{name}(unit=\"N.m\") {about};\n");
        act(&mut acting, m, "+", &format!("torque_{name}"));
    }
    for &m in &shown {
        let about = string(&format!("inertia of {}", train.member_name(m)));
        let given: f64 = inertias.iter().filter(|i| i.member == m && i.reference == FRAME).map(|i| i.value).sum();
        let value = match (given > 0.0, missing.contains(&m), train.terminals().contains(&m)) {
            (true, ..) => format!(" = {}", number(given)),
            (_, true, _) => String::new(),
            (.., true) => " = 0".to_owned(),
            _ => continue,
        };
        top += &format!("  parameter Real inertia_{}(unit=\"kg.m2\"){value} {about};\n", own(m));
        if let Some(n) = c.node(m) {
            let rate = sum(speed_of(m).iter().zip(rates.iter().map(String::as_str)));
            inert[n].push(product(&format!("inertia_{}", own(m)), &rate));
        }
    }
    for i in inertias.iter().filter(|i| i.reference != FRAME) {
        let about =
            string(&format!("inertia of {} against {}", train.member_name(i.member), train.member_name(i.reference)));
        top += &format!("  parameter Real spin_{}(unit=\"kg.m2\") = {} {about};\n", own(i.member), number(i.value));
        let by = difference(i.member, i.reference);
        let rate = sum(by.iter().zip(rates.iter().map(String::as_str)));
        for (m, sign) in [(i.member, ""), (i.reference, "-")] {
            if let Some(n) = c.node(m) {
                inert[n].push(product(&format!("{sign}spin_{}", own(i.member)), &rate));
            }
        }
    }
    for (e, (name, what)) in c.elements.iter().zip(meshes.iter().zip(&labels)) {
        let ends = [e.p, e.q].map(|m| train.member_name(m));
        for (key, value, end) in [("forward", &e.forward, ends[0]), ("backward", &e.backward, ends[1])] {
            if value.sign() <= 0 {
                let message = format!("{title}: {end} cannot drive {what}, whose efficiency is {}", value.to_f64());
                return Err(unfit(message, "export `fmu`, which has the state of rest of such a mesh"));
            }
            let about = string(&format!("efficiency of {what} where {end} drives relative to its carrier"));
            top += &format!("  parameter Real {key}_{name}(min=0) = {} {about};\n", fraction(value));
        }
    }
    if train.drags().iter().any(slides) {
        top += &format!(
            "  parameter Real slow(unit=\"rad/s\") = {} \"below this relative speed a drag grows with it\";\n",
            number(SLOW)
        );
    }
    for (m, name) in shown.iter().zip(&names) {
        let about = string(&format!("speed of {}", train.member_name(*m)));
        let start = if free.contains(m) { ", start=0, fixed=true" } else { "" };
        top += &format!("  Real speed_{name}(unit=\"rad/s\"{start}) {about};\n");
        if !free.contains(m) {
            let by = sum(speed_of(*m).iter().zip(free_speeds.iter().map(String::as_str)));
            equations += &format!("  speed_{name} = {by};\n");
        }
    }
    let mut lost: Vec<String> = vec![];
    let mut locked: Vec<&str> = vec![];
    for (e, (name, what)) in c.elements.iter().zip(meshes.iter().zip(&labels)) {
        for (end, m) in [("p", e.p), ("q", e.q)] {
            let about = string(&format!("torque of {} on {what}", train.member_name(m)));
            top += &format!("  Real {end}_{name}(unit=\"N.m\") {about};\n");
        }
        let ratio = &e.b / &e.a;
        let turns = difference(e.p, e.carrier).iter().any(|x| !x.is_zero());
        let factor = if turns {
            let power = format!("p_{name}*{}", relative(e.p, e.carrier));
            lost.push(format!("{power} + q_{name}*{}", relative(e.q, e.carrier)));
            format!("*(if {power} >= 0 then forward_{name} else 1/backward_{name})")
        } else {
            locked.push(what);
            String::new()
        };
        let torque = format!("p_{name}");
        equations += &format!("  q_{name} = {}{factor};\n", sum([(&ratio, torque.as_str())]));
        act(&mut acting, e.p, "-", &format!("p_{name}"));
        act(&mut acting, e.q, "-", &format!("q_{name}"));
        act(&mut acting, e.carrier, "+", &format!("p_{name} + q_{name}"));
    }
    for (s, name) in train.shafts().iter().zip(&shafts) {
        let [a, b] = s.members;
        let about = string(&format!("twist of {}", s.name));
        top += &format!("  Real twist_{name}(unit=\"rad\", start=0, fixed=true) {about};\n");
        top += &format!("  Real shaft_{name}(unit=\"N.m\") {};\n", string(&format!("torque of {}", s.name)));
        let rate = relative(a, b);
        equations += &format!("  der(twist_{name}) = {rate};\n");
        let [k, d] = [s.stiffness, s.damping].map(number);
        equations += &format!("  shaft_{name} = {k}*twist_{name} + {d}*{rate};\n");
        lost.push(format!("{d}*{rate}^2"));
        act(&mut acting, a, "-", &format!("shaft_{name}"));
        act(&mut acting, b, "+", &format!("shaft_{name}"));
    }
    for (d, name) in train.drags().iter().zip(&drags) {
        let [a, b] = d.members;
        top += &format!("  Real slip_{name}(unit=\"rad/s\") {};\n", string(&format!("relative speed of {}", d.name)));
        top += &format!("  Real drag_{name}(unit=\"N.m\") {};\n", string(&format!("torque of {}", d.name)));
        equations += &format!("  slip_{name} = {};\n", relative(a, b));
        let slip = format!("slip_{name}");
        let coulomb = if slides(d) {
            let amount = curve(&d.torque, &format!("abs({slip})"));
            let amount = if amount.contains(' ') { format!("({amount})") } else { amount };
            format!("{amount}*max(-1, min(1, {slip}/slow)) + ")
        } else {
            String::new()
        };
        equations += &format!("  drag_{name} = {coulomb}{}*{slip};\n", number(d.viscous));
        lost.push(format!("drag_{name}*{slip}"));
        act(&mut acting, a, "-", &format!("drag_{name}"));
        act(&mut acting, b, "+", &format!("drag_{name}"));
    }
    for n in 0..c.nodes {
        let left = if inert[n].is_empty() { "0".to_owned() } else { inert[n].join(" + ") };
        let right = acting[n].trim_start_matches(" + ").trim_start();
        let right = if right.is_empty() { "0" } else { right };
        equations += &format!("  {left} = {right};\n");
    }
    top += "  output Real loss(unit=\"W\") \"loss of meshes, shafts and drags\";\n";
    equations += &format!("  loss = {};\n", if lost.is_empty() { "0".to_owned() } else { lost.join("\n    + ") });

    tell(train, &title, &missing, &locked, notes);
    let wanted = format!("{} {}", train.name(), of_state.map_or("", |s| &s.name));
    let name = class(wanted.trim());
    let mut text = format!("model {name} {}\n", string(&super::origin(train)));
    for note in notes.iter() {
        text += &format!("  // {}\n", line(note));
    }
    text += &format!("{top}equation\n{equations}end {name};\n");
    let about = format!("{title}: {} independent speeds, {} meshes, no library needed", free.len(), c.elements.len());
    Ok(ExportedFile { name: file(train.name(), of_state.map(|s| s.name.as_str()), "mo"), text, about })
}

/// What the reader of the equations must know.
fn tell(train: &Train, title: &str, missing: &[MemberId], locked: &[&str], notes: &mut Vec<String>) {
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
        notes.push(format!("{title}: {} turns as a block and loses nothing", locked.join(", ")));
    }
    if train.drags().iter().any(|d| d.peak > 1.0) {
        notes.push("drags break away at the torque at which they slide: their `peak` is left out".to_owned());
    }
}
