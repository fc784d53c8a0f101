//! Friction elements: drags, shift elements, and what the laws of losses add between members.

use crate::dynamics::laws::Laws;
use crate::train::{Curve, DragMount, Engagement, MemberId, Scenario, ShiftElementKind, Train};

use super::ports::{Between, Ports};

/// What rubs without regard to tooth loads.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::dynamics) enum Rubs {
    /// A drag of the train.
    Drag(usize),
    /// A shift element.
    Shift(usize),
    /// Rolling resistance of the vehicle that a source describes.
    Rolling(usize),
    /// A place of the laws.
    Law(usize),
    /// What a variator loses, at the member that follows its ratio; a position among the paths.
    Variator(usize),
    /// The swing of a member that has but a trace of inertia.
    Trace,
}

/// A friction element between two members.
#[derive(Clone)]
pub(in crate::dynamics) struct Friction {
    pub what: Rubs,
    pub name: String,
    pub members: [MemberId; 2],
    /// Torque over the amount of slip, at full engagement.
    pub torque: Curve,
    pub peak: f64,
    /// Torque per unit of speed beside it.
    pub viscous: f64,
    /// Holds any torque when engaged.
    pub rigid: bool,
    /// For a one-way clutch the direction it prevents.
    pub blocks: Option<i8>,
    /// Position in the scenario's engagements; `None`: always engaged.
    pub engagement: Option<usize>,
    /// Never engaged in this scenario.
    pub open: bool,
    /// The vehicle among the sources that presses on it by its weight.
    pub rolls: Option<usize>,
    /// Slip over the coordinates.
    pub row: Vec<f64>,
    pub group: Option<(usize, f64)>,
    pub port: usize,
}

impl Friction {
    /// One that is always engaged, between two members.
    pub(super) fn new(what: Rubs, name: &str, torque: Curve, between: Between) -> Self {
        Self {
            what,
            name: name.to_owned(),
            members: between.members,
            torque,
            peak: 1.0,
            viscous: 0.0,
            rigid: false,
            blocks: None,
            engagement: None,
            open: false,
            rolls: None,
            row: between.row,
            group: None,
            port: between.port,
        }
    }
}

/// The drags of a train.
pub(super) fn drags(train: &Train, ports: &mut Ports<'_>) -> Vec<Friction> {
    let drag = |(k, d): (usize, &DragMount)| Friction {
        peak: d.peak,
        viscous: d.viscous,
        ..Friction::new(Rubs::Drag(k), &d.name, d.torque.clone(), ports.between(d.members))
    };
    train.drags().iter().enumerate().map(drag).collect()
}

/// The shift elements of a train as a scenario engages them.
pub(super) fn shift_elements(train: &Train, scenario: &Scenario, ports: &mut Ports<'_>) -> Vec<Friction> {
    let mut frictions = Vec::new();
    for (k, e) in train.shift_elements().iter().enumerate() {
        let one_way = e.kind == ShiftElementKind::OneWay;
        let engagement = if one_way { None } else { engagement(scenario, k) };
        let (torque, peak) = match &e.friction {
            Some(f) => (f.torque.clone(), f.peak),
            None => (Curve::constant(0.0), 1.0),
        };
        frictions.push(Friction {
            peak,
            rigid: e.friction.is_none() || one_way,
            blocks: one_way.then_some(e.blocks),
            engagement,
            open: !one_way && engagement.is_none(),
            ..Friction::new(Rubs::Shift(k), &e.name, torque, ports.between(e.members))
        });
    }
    frictions
}

/// The signal of how far a shift element is engaged.
fn engagement(scenario: &Scenario, element: usize) -> Option<usize> {
    scenario.engagements.iter().position(|e: &Engagement| e.element.index() == element)
}

/// The places of the laws, whose torques follow from speeds and loads as the train moves.
pub(super) fn law_places(laws: &Laws, ports: &mut Ports<'_>) -> Vec<Friction> {
    let places = laws.places.iter().enumerate();
    places.map(|(k, p)| Friction::new(Rubs::Law(k), &p.name, Curve::constant(0.0), ports.between(p.members))).collect()
}
