//! Losses of a physical train in motion.
//!
//! At every state the laws of an [operating point](crate::operating_point) are asked at its speeds and tooth
//! forces. What grows in proportion to the load of a mesh becomes the slope of that element's loss; the rest
//! are friction elements. Losses depend on forces and forces on losses: both are repeated until they agree, from
//! those of the state before. A loss of a few percent that depends on force with a power of about 0.2 changes
//! by less than a hundredth of what the force was wrong, so that a few rounds do.

use std::sync::Arc;

use crate::operating_point::{LEAST_SPEED, LossKind, Physics, Place, Step};
use crate::power_flow::{Flow, MeshFlow};
use crate::train::{MeshId, Train};

use super::engine::Engine;
use super::mode::{Map, Mode, Side, dot, slope};
use super::report::EnergyLossKind;
use super::system::{Loss, MOST_LOST, Rubs};

/// Change in a round that counts as none, over the sum of the losses as torques.
const AGREEMENT: f64 = 1e-11;
/// The same over the size of the forces, where the losses themselves are round-off.
const ROUND_OFF: f64 = 1e-13;
/// Most rounds at a state.
const MOST_ROUNDS: usize = 100;

/// The laws of a train, and what they gave last.
#[derive(Clone)]
pub(super) struct Laws {
    physics: Arc<Physics<'static>>,
    pub places: Vec<Place>,
    /// The friction element of the first place; those of the others follow.
    pub first: usize,
    flow: Flow,
    step: Step,
    /// Torque by place, N m.
    torques: Vec<f64>,
}

impl Laws {
    /// Those of a train with losses to compute.
    pub fn of(train: &Train) -> Option<Self> {
        let physics = train.is_physical().then(|| Physics::in_motion(train))?;
        let places = physics.places();
        let meshes = (0..train.meshes().len()).map(|k| MeshFlow {
            mesh: MeshId(k),
            torques: [0.0; 3],
            relative_speeds: [LEAST_SPEED; 2],
            driver: Some(0),
            potential_power: 0.0,
            efficiency: 1.0,
            loss: 0.0,
        });
        let flow = Flow { speeds: vec![0.0; train.members().len()], meshes: meshes.collect(), ..Flow::default() };
        let step = physics.follow(&flow);
        let torques = places.iter().map(|p| step.drag(p)).collect();
        Some(Self { physics: Arc::new(physics), places, first: 0, flow, step, torques })
    }

    /// Amount of torque at a place, N m.
    pub fn torque(&self, place: usize) -> f64 {
        self.torques[place]
    }

    /// What was found last.
    pub fn found(&self) -> (Step, Vec<f64>) {
        (self.step.clone(), self.torques.clone())
    }

    /// Goes back to it.
    pub fn recall(&mut self, (step, torques): (Step, Vec<f64>)) {
        (self.step, self.torques) = (step, torques);
    }

    /// Parts of a mesh's loss that belong to friction elements.
    pub fn bearing_parts(&self, mesh: MeshId) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.step.bearing_parts(mesh, &self.places).map(|(place, part)| (self.first + place, part))
    }

    /// The loss of a mesh in proportion to its load.
    fn loss(&self, mesh: MeshId) -> Loss {
        let lost = self.step.lost(mesh);
        Loss { drive: lost, coast: 1.0 - 1.0 / (1.0 - lost), drive_torque: 0.0, coast_torque: 0.0 }
    }

    /// What is followed, and what is not.
    pub fn assumptions(&self, train: &Train) -> Vec<String> {
        let mut all: Vec<String> = Vec::new();
        if train.meshes().iter().any(|m| m.computed) {
            all.push(format!("tooth friction `{}`", self.physics.friction_law()));
        }
        for place in &self.places {
            let kind = place.loss_kind().to_string();
            if !all.contains(&kind) {
                all.push(kind);
            }
        }
        let oil = match self.physics.temperature() {
            Some(t) => format!("with oil of constant {:.0} °C", t - 273.15),
            None => "without oil".to_owned(),
        };
        vec![
            format!("losses follow the laws of operating points at every speed and load, {oil}: {}", all.join(", ")),
            format!(
                "relative speeds below {LEAST_SPEED} rad/s count as that in a law, whose range is not watched in motion; planets \
                 load their bearings by tooth and centrifugal forces only; that forces are unique is proved for meshes that lose \
                 up to {:.0} %",
                100.0 * MOST_LOST
            ),
        ]
    }
}

impl Place {
    /// What it is called among the energies.
    pub(super) fn loss_kind(&self) -> EnergyLossKind {
        match self.kind {
            LossKind::Sliding => EnergyLossKind::Mesh,
            LossKind::Rolling => EnergyLossKind::Rolling,
            LossKind::Bearing => EnergyLossKind::Bearing,
            LossKind::Windage => EnergyLossKind::Windage,
            LossKind::Churning => EnergyLossKind::Churning,
            LossKind::Seal => EnergyLossKind::Seal,
        }
    }
}

impl Engine {
    /// Loss of an element at the speeds looked at; where it follows a law, as the forces found last have it.
    pub fn loss(&self, j: usize) -> Loss {
        self.loss_at(j, dot(&self.system.elements[j].row, &self.speed).abs())
    }

    /// The same where only tables take another speed.
    pub fn loss_at(&self, j: usize, speed: f64) -> Loss {
        let e = &self.system.elements[j];
        match (e.law, &self.system.laws) {
            (Some(mesh), Some(laws)) => laws.loss(mesh),
            _ => e.loss(speed),
        }
    }

    /// Brings forces and laws into agreement at the state looked at, in the present mode.
    pub fn agree(&mut self, t: f64, x: &[f64]) {
        let mode = self.mode.clone();
        self.agrees = false;
        for _ in 0..MOST_ROUNDS {
            let Some(map) = self.map.clone() else { return };
            let tau = std::mem::take(&mut self.tau);
            self.agrees = self.ask(&mode, &map, &tau);
            self.tau = tau;
            if self.agrees {
                return;
            }
            self.load(t, x);
            self.map = self.map_of(&mode);
        }
    }

    /// The map of a mode tried at the state looked at, with laws that agree with it; `tau` is made that of the mode.
    pub fn agreed_map(&mut self, mode: &Mode, t: f64, tau: &mut [f64]) -> Option<Arc<Map>> {
        for _ in 0..MOST_ROUNDS {
            for k in 0..self.system.frictions.len() {
                if matches!(self.system.frictions[k].what, Rubs::Law(_)) {
                    tau[self.system.frictions[k].port] = self.friction_torque(k, mode, true, t);
                }
            }
            let map = self.map_of(mode)?;
            if self.system.laws.is_none() || self.ask(mode, &map, tau) {
                return Some(map);
            }
        }
        None
    }

    /// Asks the laws at the forces of a map. True if the answer is that of the last time, which then stands.
    fn ask(&mut self, mode: &Mode, map: &Map, tau: &[f64]) -> bool {
        let Some(mut laws) = self.system.laws.take() else { return true };
        for (speed, row) in laws.flow.speeds.iter_mut().zip(&self.system.speeds) {
            *speed = dot(row, &self.speed);
        }
        let (mut lost, mut size) = (0.0, 0.0);
        for (j, e) in self.system.elements.iter().enumerate() {
            let [link] = &e.links[..] else { continue };
            let [a, b] = e.factors;
            let row = self.system.all() + j;
            let torque = a * map.unknown(row, tau);
            let sign = mode.element_slip(&self.system, j);
            let side = mode.side[j];
            let own = match e.law {
                Some(mesh) if sign != 0 => {
                    size += a.abs() * map.size(row, tau);
                    slope(laws.loss(mesh), side) * torque
                }
                _ => 0.0,
            };
            lost += own.abs();
            let flow = &mut laws.flow.meshes[link.mesh.index()];
            // Of the second gear by the Willis equation: relative to the carrier a ω_p + b ω_q = 0.
            let other = b / a * (torque - own);
            flow.torques = [torque, other, -torque - other];
            let speed = dot(&e.row, &self.speed);
            flow.relative_speeds = [speed, a / b * speed].map(|w| w.abs().max(LEAST_SPEED));
            let driver = usize::from(side == Side::Coast);
            flow.driver = Some(driver);
            flow.potential_power = (flow.torques[driver] * flow.relative_speeds[driver]).abs();
        }
        let next = laws.physics.follow(&laws.flow);
        let torques: Vec<f64> = laws.places.iter().map(|p| next.drag(p)).collect();
        let mut change = 0.0;
        for e in &self.system.elements {
            if let Some(mesh) = e.law {
                change +=
                    (next.lost(mesh) - laws.step.lost(mesh)).abs() * laws.flow.meshes[mesh.index()].torques[0].abs();
            }
        }
        for (new, old) in torques.iter().zip(&laws.torques) {
            change += (new - old).abs();
            lost += new;
        }
        let agrees = change <= AGREEMENT * lost + ROUND_OFF * size;
        if !agrees {
            laws.step = next;
            laws.torques = torques;
        }
        self.system.laws = Some(laws);
        agrees
    }
}
