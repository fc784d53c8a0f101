//! Elastic shafts.

use crate::train::{Scenario, Train};

use super::ports::Ports;

/// An elastic shaft.
#[derive(Clone)]
pub(in crate::dynamics) struct Elastic {
    pub row: Vec<f64>,
    pub port: usize,
    /// Twist at the start.
    pub twist: f64,
}

/// The shafts of a train, twisted as a scenario starts.
pub(super) fn shafts(train: &Train, scenario: &Scenario, ports: &mut Ports<'_>) -> Vec<Elastic> {
    (train.shafts().iter().enumerate())
        .map(|(k, s)| {
            let between = ports.between(s.members);
            let twist = scenario.initial_twists.iter().find(|t| t.0 == k).map_or(0.0, |t| t.1);
            Elastic { row: between.row, port: between.port, twist }
        })
        .collect()
}
