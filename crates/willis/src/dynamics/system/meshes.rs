//! Mesh elements: their forces in the equations of motion, and what they lose.

use nalgebra::DMatrix;

use crate::dynamics::decision::Mesh;
use crate::dynamics::element::{Element, MOST_LOST, Pass, shares};
use crate::exact::Rational;
use crate::kinematics::{self, Configuration, Link};
use crate::train::{LossRow, MeshId, Train};

use super::coordinates::Coordinates;
use super::ports::{Ports, on_nodes};

/// The mesh elements of a train.
pub(super) struct Meshes {
    pub elements: Vec<Element>,
    /// Torques of a unit of each force variable on the nodes, the columns g.
    pub gear: DMatrix<f64>,
    /// Torques of a unit of each loss, the columns h.
    pub loss: DMatrix<f64>,
}

impl Meshes {
    /// Gives the loss of each a port; `under_laws` if the train has laws of losses.
    pub fn of(c: &Configuration<'_>, coordinates: &Coordinates, under_laws: bool, ports: &mut Ports<'_>) -> Self {
        let train = c.train;
        let m = c.elements.len();
        let mut gear = DMatrix::zeros(c.nodes, m);
        let mut loss = DMatrix::zeros(c.nodes, m);
        let mut elements: Vec<Element> = Vec::with_capacity(m);
        for (j, e) in c.elements.iter().enumerate() {
            let (a, b) = (e.a.to_f64(), e.b.to_f64());
            let g = on_nodes(c, [(e.p, a), (e.q, b), (e.carrier, -(a + b))]);
            let h = on_nodes(c, [(e.q, -b / a), (e.carrier, b / a)]);
            gear.set_column(j, &g);
            loss.set_column(j, &h);
            let port = ports.add(-h);
            let law = law(train, e, under_laws);
            elements.push(Element {
                links: e.links.clone(),
                factors: [a, b],
                rows: loss_rows(train, e, law.is_some()),
                law,
                row: coordinates.slip([e.p, e.carrier]),
                group: None,
                port,
                shares: shares(train, &e.links),
                passes: Pass::of(train, &e.links),
            });
        }
        Self { elements, gear, loss }
    }
}

/// The same as contacts, at rest, with constant efficiencies; none is lost where nothing can move.
pub(super) fn contacts(c: &Configuration<'_>, elements: &[Element]) -> Vec<Mesh> {
    (c.elements.iter().zip(elements))
        .map(|(e, made)| Mesh {
            bodies: [e.p, e.q, e.carrier].map(|m| c.node(m)),
            factors: [e.a.clone(), e.b.clone()],
            efficiency: match made.group {
                None => [Rational::ONE; 2],
                Some(_) => [e.forward.clone(), e.backward.clone()],
            },
            slip: 0,
        })
        .collect()
}

/// The mesh of an element if its loss follows a law.
fn law(train: &Train, e: &kinematics::Element, under_laws: bool) -> Option<MeshId> {
    match e.links[..] {
        [Link { mesh, .. }] => Some(mesh).filter(|m| under_laws && train.meshes()[m.index()].computed),
        _ => None,
    }
}

/// Losses of an element by speed: those of its table, or constant ones. A law is not in them: they are then the
/// most that it may lose.
fn loss_rows(train: &Train, e: &kinematics::Element, follows_law: bool) -> Vec<LossRow> {
    let table = match e.links[..] {
        [Link { mesh, .. }] => train.loss_tables().iter().find(|t| t.mesh == mesh),
        _ => None,
    };
    let nominal = |efficiency: &Rational| if follows_law { 1.0 - MOST_LOST } else { efficiency.to_f64() };
    let constant = LossRow {
        speed: 0.0,
        forward: nominal(&e.forward),
        backward: nominal(&e.backward),
        forward_torque: 0.0,
        backward_torque: 0.0,
    };
    table.map_or_else(|| vec![constant], |t| t.rows.clone())
}
