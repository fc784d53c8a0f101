//! Speeds and torques of a shift table, as tables.

use willis::analysis::ShaftTable;
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
        for (set, of) in s.sets.iter() {
            for (member, torque) in of.iter() {
                sets.row([name.into(), set.into(), member.into(), (*torque).into()]);
            }
        }
    }
    vec![states, members, elements, sets]
}
