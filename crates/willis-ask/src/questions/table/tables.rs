//! Speeds and torques of a shift table, as tables.

use willis::analysis::{Losses, ShaftTable};
use willis::exact::Rational;

use crate::table::Kind::{Flag, Number, Text};
use crate::table::{Cell, Table, word};

/// `speed`: of the input, rad/s; speeds in rad/s then stand beside those over the speed of the input.
pub fn tables(all: &ShaftTable, speed: Option<f64>) -> Vec<Table> {
    let mut states = Table::new(
        "states",
        [
            ("state", Text),
            ("engaged", Text),
            ("input", Text),
            ("output", Text),
            ("ratio", Number),
            ("ratio_exact", Text),
            ("efficiency", Number),
            ("reason", Text),
        ],
    );
    let mut members = Table::new(
        "members",
        [
            ("state", Text),
            ("member", Text),
            ("carrier", Text),
            ("speed_over_input", Number),
            ("speed_over_input_exact", Text),
            ("relative_speed_over_input", Number),
            ("torque_over_input", Number),
            ("speed_rad_s", Number),
            ("relative_speed_rad_s", Number),
        ],
    );
    let mut elements = Table::new(
        "shift-elements",
        [
            ("state", Text),
            ("shift_element", Text),
            ("kind", Text),
            ("engaged", Flag),
            ("slip_over_input", Number),
            ("slip_over_input_exact", Text),
            ("torque_over_input", Number),
            ("slip_rad_s", Number),
        ],
    );
    let mut sets =
        Table::new("sets", [("state", Text), ("set", Text), ("member", Text), ("torque_over_input", Number)]);
    let mut losses = Table::new(
        "losses",
        [
            ("state", Text),
            ("operation", Text),
            ("speed_rad_s", Number),
            ("torque_n_m", Number),
            ("temperature_k", Number),
            ("beyond_limit", Flag),
            ("load", Flag),
            ("verdict", Text),
            ("efficiency", Number),
            ("kind", Text),
            ("loss_w", Number),
            ("reason", Text),
            ("warnings", Text),
        ],
    );
    let number = |x: &Option<Rational>| Cell::from(x.as_ref().map(Rational::to_f64));
    let exact = |x: &Option<Rational>| Cell::from(x.as_ref().map(ToString::to_string));
    let rad_s = |x: &Option<Rational>| Cell::from(x.as_ref().zip(speed).map(|(x, w)| x.to_f64() * w));
    for (name, s) in all.states.iter() {
        states.row([
            name.into(),
            s.engaged.join(" ").into(),
            (&s.input).into(),
            (&s.output).into(),
            number(&s.ratio),
            exact(&s.ratio),
            s.efficiency.into(),
            s.reason.clone().into(),
        ]);
        for (member, m) in s.members.iter() {
            members.row([
                name.into(),
                member.into(),
                m.carrier.clone().into(),
                number(&m.speed),
                exact(&m.speed),
                number(&m.relative_speed),
                m.torque.into(),
                rad_s(&m.speed),
                rad_s(&m.relative_speed),
            ]);
        }
        for (element, e) in s.shift_elements.iter() {
            elements.row([
                name.into(),
                element.into(),
                word(&e.kind).into(),
                e.engaged.into(),
                number(&e.slip),
                exact(&e.slip),
                e.torque.into(),
                rad_s(&e.slip),
            ]);
        }
        let Some(at) = &s.at_load else { continue };
        let all = [(true, at.loss_w, at.losses_w.as_ref()), (false, at.spin_loss_w, at.spin_losses_w.as_ref())];
        for (load, total, of) in all {
            let kinds = of.map(|all| Losses::NAMES.into_iter().zip(all.all()).filter(|(_, w)| *w != 0.0));
            let kinds = kinds.into_iter().flatten().map(|(kind, w)| (kind, Some(w)));
            for (kind, loss) in std::iter::once(("all", total)).chain(kinds) {
                losses.row([
                    name.into(),
                    at.operation.clone().into(),
                    at.speed_rad_s.into(),
                    if load { at.torque_n_m.into() } else { Cell::from(None::<f64>) },
                    at.temperature_k.into(),
                    at.beyond_limit.into(),
                    load.into(),
                    // What can be said under load says nothing of no load.
                    load.then(|| word(&at.verdict)).into(),
                    at.efficiency.filter(|_| load).into(),
                    kind.into(),
                    loss.into(),
                    at.reason.clone().filter(|_| load).into(),
                    load.then(|| at.warnings.join("; ")).into(),
                ]);
            }
        }
    }
    for (name, s) in all.states.iter() {
        for (set, of) in s.sets.iter() {
            for (member, torque) in of.iter() {
                sets.row([name.into(), set.into(), member.into(), (*torque).into()]);
            }
        }
    }
    vec![states, members, elements, sets, losses]
}
