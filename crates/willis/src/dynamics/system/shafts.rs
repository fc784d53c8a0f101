//! Elastic shafts.

use crate::dynamics::decision::Body;
use crate::kinematics::Configuration;
use crate::train::{Scenario, Train};

use super::ports::Ports;

/// An elastic shaft.
#[derive(Clone)]
pub(in crate::dynamics) struct Elastic {
    pub row: Vec<f64>,
    /// What it joins.
    pub bodies: [Body; 2],
    pub port: usize,
    /// Twist at the start.
    pub twist: f64,
}

/// The shafts of a train, twisted as a scenario starts.
pub(super) fn shafts(c: &Configuration<'_>, scenario: &Scenario, ports: &mut Ports<'_>) -> Vec<Elastic> {
    let train: &Train = c.train;
    (train.shafts().iter().enumerate())
        .map(|(k, s)| {
            let between = ports.between(s.members);
            let twist = scenario.initial_twists.iter().find(|t| t.0 == k).map_or(0.0, |t| t.1);
            Elastic { row: between.row, bodies: s.members.map(|m| c.node(m)), port: between.port, twist }
        })
        .collect()
}
