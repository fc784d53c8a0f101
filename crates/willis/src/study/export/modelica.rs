//! The train as a model of `Modelica.Mechanics.Rotational`, one class without a package.
//!
//! Sources: Modelica Standard Library 4.1.0, `Modelica/Mechanics/Rotational/Components/`: `LossyGear.mo`, `Clutch.mo`,
//! `Brake.mo`, `OneWayClutch.mo`, `Inertia.mo`, `SpringDamper.mo`, `ElastoBacklash.mo`, `ElastoBacklash2.mo`,
//! `BearingFriction.mo`, `Damper.mo`, `Fixed.mo`.
//!
//! Every mesh (or meshes in a row through planets that nothing else touches) is a `LossyGear` whose support is the
//! carrier: `(w_p - w_c) = ratio*(w_q - w_c)`, `eta_mf1` where p drives relative to the carrier, `eta_mf2` where q
//! does. That is the same statics as here, so the model also locks where the train locks. Clutches and brakes take
//! `engage_X` from 0 to 1. Terminals are flanges; every other member is a node inside.

use crate::analysis::in_force;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::Configuration;
use crate::train::{Contact, Curve, Efficiency, FRAME, MemberId, ShiftElementKind, Train};

use super::loss_table::{RESERVED, class, string};
use super::names::{file, identifiers, line, number};
use super::{Asked, Export, ExportedFile};

const ROTATIONAL: &str = "Modelica.Mechanics.Rotational";

/// `-85/23`, and an integer without a denominator.
pub(super) fn fraction(r: &Rational) -> String {
    r.to_fraction().trim_end_matches("/1").to_owned()
}

/// Rows of a table that stays level beyond its last point, as the curve does.
fn level(curve: &Curve) -> String {
    let mut points = curve.points().to_vec();
    let last = points[points.len() - 1];
    points.push([last[0] + 1.0, last[1]]);
    let rows: Vec<String> = points.iter().map(|p| p.map(number).join(", ")).collect();
    format!("[{}]", rows.join("; "))
}

/// The mesh efficiencies that laws give in the operation that was asked for; none without one, or without laws.
pub(super) fn at_the_load(
    train: &Train,
    request: &Asked,
    notes: &mut Vec<String>,
) -> Result<Option<Vec<Efficiency>>, Diagnostics> {
    if !train.has_laws() {
        return Ok(None);
    }
    let rest = "no bearings, seals or gears in oil; modelica-loss-table has the computed losses of the whole gear";
    let Some(operation) = &request.at else {
        notes.push(format!(
            "tooth losses are computed at operating points: the model has nominal efficiencies (an operation says at which \
             load to take computed ones), and {rest}"
        ));
        return Ok(None);
    };
    let name = &operation.name;
    let Some((all, _)) = in_force(train, operation) else {
        let message = format!("the operation `{name}` has no single equilibrium from which to take efficiencies");
        return Err(Diagnostic::new(Code::Unfit, "", message).hint("choose another operation, or none").into());
    };
    let told = train.meshes().iter().zip(&all).filter(|(mesh, _)| mesh.computed);
    let told: Vec<String> = told.map(|(mesh, own)| format!("{} {}", mesh.name, own.forward.to_f64())).collect();
    notes.push(format!(
        "computed tooth losses, with what bearings lose by the load of a mesh, are those at the load of operation `{name}`, \
         constant efficiencies at every other: {}; {rest}",
        told.join(", ")
    ));
    Ok(Some(all))
}

pub(super) fn write(train: &Train, request: &Asked) -> Result<Export, Diagnostics> {
    if request.state.is_some() || request.operation.is_some() {
        // The model has all states; an operation only says at which load losses are taken.
        super::map::gears(train, request)?;
    }
    let mut notes = Vec::new();
    let mut keep: Vec<MemberId> = train.inertias().iter().flat_map(|i| [i.member, i.reference]).collect();
    keep.extend(train.drags().iter().flat_map(|d| d.members));
    keep.extend(train.shafts().iter().flat_map(|s| s.members));
    for table in train.loss_tables() {
        keep.extend(train.meshes()[table.mesh.index()].gears.iter().map(|g| g.member));
    }
    let c = Configuration::new(train, &[], &[], &keep);
    let c = match at_the_load(train, request, &mut notes)? {
        Some(all) => c.with_efficiencies(all),
        None => c,
    };
    let shown: Vec<usize> = (1..train.members().len()).filter(|&m| !c.inner[m]).collect();
    let names = identifiers(shown.iter().map(|&m| train.members()[m].name.as_str()), RESERVED);
    let terminal = |m: usize| train.terminals().contains(&MemberId(m));
    let node = |m: MemberId| {
        if m == FRAME {
            return "frame.flange".to_owned();
        }
        let k = shown.iter().position(|&n| n == m.index()).expect("a member that is shown");
        if terminal(m.index()) { names[k].clone() } else { format!("node_{}", names[k]) }
    };
    let elements = identifiers(train.shift_elements().iter().map(|e| e.name.as_str()), &[]);

    let mut missing: Vec<String> = Vec::new();
    let mut top = String::new();
    let mut parts = String::new();
    let mut joints = String::new();
    let mut connect = |a: String, b: String| joints += &format!("  connect({a}, {b});\n");
    for (&m, name) in shown.iter().zip(&names).filter(|(m, _)| terminal(**m)) {
        let about = string(&train.members()[m].name);
        top += &format!("  {ROTATIONAL}.Interfaces.Flange_a {name} {about};\n");
    }
    for (e, name) in train.shift_elements().iter().zip(&elements) {
        let about = string(&format!("{} {}: 0 open, 1 closed", e.kind, e.name));
        if e.kind != ShiftElementKind::OneWay {
            top += &format!("  Modelica.Blocks.Interfaces.RealInput engage_{name} {about};\n");
            if e.friction.is_none() {
                let about =
                    string(&format!("torque that {} holds when closed: not in the train file, give it", e.name));
                top += &format!("  parameter Real capacity_{name}(unit=\"N.m\") {about};\n");
                missing.push(format!("capacity_{name}"));
            }
        }
    }
    parts += &format!("  {ROTATIONAL}.Components.Fixed frame;\n");
    for (&m, name) in shown.iter().zip(&names).filter(|(m, _)| !terminal(**m)) {
        let about = string(&train.members()[m].name);
        parts += &format!("  {ROTATIONAL}.Interfaces.Flange_a node_{name} {about};\n");
    }
    let label = |e: &crate::kinematics::Element| -> String {
        let meshes = train.meshes();
        let first = &meshes[e.links[0].mesh.index()];
        match (first.set, e.links.len()) {
            (Some(s), n) if n > 1 => train.sets()[s].name.clone(),
            _ => first.name.clone(),
        }
    };
    let labels: Vec<String> = c.elements.iter().map(label).collect();
    let gears = identifiers(labels.iter().map(String::as_str), &[]);
    for ((e, name), what) in c.elements.iter().zip(&gears).zip(&labels) {
        let ratio = -(&e.b / &e.a);
        let table = train.loss_tables().iter().find(|t| e.links.len() == 1 && t.mesh == e.links[0].mesh);
        let rows: Vec<[String; 5]> = match table {
            None => vec![["0".into(), fraction(&e.forward), fraction(&e.backward), "0".into(), "0".into()]],
            Some(t) => (t.rows.iter())
                .map(|r| [r.speed, r.forward, r.backward, r.forward_torque, r.backward_torque].map(number))
                .collect(),
        };
        let lossy: Vec<String> = rows.iter().map(|r| r.join(", ")).collect();
        let ideal: Vec<String> = rows.iter().map(|r| format!("{}, 1, 1, 0, 0", r[0])).collect();
        parts += &format!(
            "  {ROTATIONAL}.Components.LossyGear gear_{name}(ratio={}, useSupport=true,\n    lossTable=if withLosses then \
             [{}] else [{}]) {};\n",
            fraction(&ratio),
            lossy.join("; "),
            ideal.join("; "),
            string(what)
        );
        connect(format!("gear_{name}.flange_a"), node(e.p));
        connect(format!("gear_{name}.flange_b"), node(e.q));
        connect(format!("gear_{name}.support"), node(e.carrier));
    }
    for (e, name) in train.shift_elements().iter().zip(&elements) {
        let (mu, force, peak) = match &e.friction {
            Some(f) => (level(&f.torque), "1".to_owned(), f.peak),
            None => ("[0, 1]".to_owned(), format!("capacity_{name}"), 1.0),
        };
        let [a, b] = e.members;
        match e.kind {
            ShiftElementKind::OneWay => {
                // Modelica's lets flange_b run ahead of flange_a; `blocks` is the sign of a's lead that is prevented.
                let [a, b] = if e.blocks > 0 { [a, b] } else { [b, a] };
                parts += &format!(
                    "  {ROTATIONAL}.Components.OneWayClutch one_way_{name}(fn_max=1) {};\n  \
                     Modelica.Blocks.Sources.Constant open_{name}(k=0);\n",
                    string(&e.name)
                );
                connect(format!("one_way_{name}.flange_a"), node(a));
                connect(format!("one_way_{name}.flange_b"), node(b));
                connect(format!("open_{name}.y"), format!("one_way_{name}.f_normalized"));
            }
            kind => {
                let clutch = kind == ShiftElementKind::Clutch;
                let (kind, own) = if clutch { ("Clutch", "clutch") } else { ("Brake", "brake") };
                let peak = if peak == 1.0 { String::new() } else { format!(", peak={}", number(peak)) };
                parts += &format!(
                    "  {ROTATIONAL}.Components.{kind} {own}_{name}(mu_pos={mu}, fn_max={force}{peak}) {};\n",
                    string(&e.name)
                );
                connect(format!("{own}_{name}.flange_a"), node(if a == FRAME { b } else { a }));
                if clutch {
                    connect(format!("{own}_{name}.flange_b"), node(b));
                }
                connect(format!("engage_{name}"), format!("{own}_{name}.f_normalized"));
            }
        }
    }
    let mut inertias: Vec<(MemberId, f64)> = vec![];
    for i in train.inertias().iter().filter(|i| i.value > 0.0) {
        if i.reference != FRAME {
            let name = train.member_name(i.member);
            notes.push(format!("left out: the inertia of {name}, which counts its spin against its carrier"));
            continue;
        }
        // A carrier has its own and that of the masses of its planets.
        match inertias.iter_mut().find(|(m, _)| *m == i.member) {
            Some((_, sum)) => *sum += i.value,
            None => inertias.push((i.member, i.value)),
        }
    }
    for (member, value) in inertias {
        let at = node(member);
        let own = at.trim_start_matches("node_").to_owned();
        let about = string(train.member_name(member));
        parts += &format!("  {ROTATIONAL}.Components.Inertia inertia_{own}(J={}) {about};\n", number(value));
        connect(format!("inertia_{own}.flange_a"), at);
    }
    let shafts = identifiers(train.shafts().iter().map(|s| s.name.as_str()), &[]);
    for (s, name) in train.shafts().iter().zip(&shafts) {
        let (kind, backlash) = match (s.backlash > 0.0, s.contact) {
            (false, _) => ("SpringDamper", String::new()),
            (true, Contact::Soft) => ("ElastoBacklash", format!(", b={}", number(s.backlash))),
            (true, Contact::Hard) => ("ElastoBacklash2", format!(", b={}", number(s.backlash))),
        };
        let (k, d) = (number(s.stiffness), number(s.damping));
        parts +=
            &format!("  {ROTATIONAL}.Components.{kind} shaft_{name}(c={k}, d={d}{backlash}) {};\n", string(&s.name));
        connect(format!("shaft_{name}.flange_a"), node(s.members[0]));
        connect(format!("shaft_{name}.flange_b"), node(s.members[1]));
    }
    let drags = identifiers(train.drags().iter().map(|d| d.name.as_str()), &[]);
    for (d, name) in train.drags().iter().zip(&drags) {
        let [a, b] = d.members;
        if d.torque.points().iter().any(|p| p[1] > 0.0) {
            let peak = if d.peak == 1.0 { String::new() } else { format!(", peak={}", number(d.peak)) };
            parts += &format!(
                "  {ROTATIONAL}.Components.BearingFriction friction_{name}(useSupport=true, tau_pos={}{peak}) {};\n",
                level(&d.torque),
                string(&d.name)
            );
            connect(format!("friction_{name}.flange_a"), node(a));
            connect(format!("friction_{name}.support"), node(b));
        }
        if d.viscous > 0.0 {
            let viscous = number(d.viscous);
            parts += &format!("  {ROTATIONAL}.Components.Damper damper_{name}(d={viscous}) {};\n", string(&d.name));
            connect(format!("damper_{name}.flange_a"), node(a));
            connect(format!("damper_{name}.flange_b"), node(b));
        }
    }
    if !missing.is_empty() {
        notes.push(format!("not in the file, parameters without a value: {}", missing.join(", ")));
    }
    if c.elements.len() > 1 {
        notes.push(
            "where several gears stand still at once, their friction is not determined by statics and a simulator may \
             call the model singular: start it moving, or with withLosses=false"
                .into(),
        );
    }
    if train.inertias().iter().all(|i| i.value == 0.0) {
        notes.push("no inertias are given in the file: connect some to the flanges before simulating".into());
    }
    for s in train.states() {
        let engaged: Vec<&str> = s.engaged.iter().map(|e| train.shift_elements()[e.index()].name.as_str()).collect();
        notes.push(format!("state {} closes {}", s.name, engaged.join(", ")));
    }
    let name = class(train.name());
    let mut text = format!("model {name} {}\n", string(&super::origin(train)));
    for note in &notes {
        text += &format!("  // {}\n", line(note));
    }
    text += "  parameter Boolean withLosses = true \"false: teeth without friction\";\n";
    text += &top;
    text += "protected\n";
    text += &parts;
    text += "equation\n";
    text += &joints;
    text += &format!("end {name};\n");
    let about = format!("{} lossy gears, {} shift elements", c.elements.len(), train.shift_elements().len());
    Ok(Export::new(vec![ExportedFile { name: file(train.name(), None, "mo"), text, about }], notes))
}
