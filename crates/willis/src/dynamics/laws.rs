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

use super::element::{Loss, MOST_LOST};
use super::report::EnergyLossKind;

/// The laws of a train, and what they gave last.
#[derive(Clone)]
pub(super) struct Laws {
    pub physics: Arc<Physics<'static>>,
    pub places: Vec<Place>,
    /// The friction element of the first place; those of the others follow.
    pub first: usize,
    pub flow: Flow,
    pub step: Step,
    /// Torque by place, N m.
    pub torques: Vec<f64>,
    /// Both without load.
    at_rest: Box<(Flow, Step)>,
}

impl Laws {
    /// Those of a train with losses to compute.
    pub fn of(train: &Train) -> Option<Self> {
        let physics = train.has_laws().then(|| Physics::in_motion(train))?;
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
        let at_rest = Box::new((flow.clone(), step.clone()));
        Some(Self { physics: Arc::new(physics), places, first: 0, flow, step, torques, at_rest })
    }

    /// Brings the oil to another temperature, K. Whether that is one.
    pub fn warm_to(&mut self, oil: f64) -> bool {
        if self.physics.temperature().is_none_or(|now| now == oil) {
            return false;
        }
        Arc::make_mut(&mut self.physics).warm_to(oil);
        let flow = &self.at_rest.0;
        self.at_rest.1 = self.physics.follow(flow);
        self.step = self.physics.follow(&self.flow);
        self.torques = self.places.iter().map(|p| self.step.drag(p)).collect();
        true
    }

    /// As before a run.
    pub fn begin(&mut self) {
        (self.flow, self.step) = (*self.at_rest).clone();
        self.torques = self.places.iter().map(|p| self.step.drag(p)).collect();
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
    pub fn loss(&self, mesh: MeshId) -> Loss {
        let [drive, lost] = self.step.lost(mesh);
        Loss { drive, coast: 1.0 - 1.0 / (1.0 - lost), drive_torque: 0.0, coast_torque: 0.0 }
    }

    /// What is followed, and what is not; `warms` where the temperature of the oil follows the losses.
    pub fn assumptions(&self, train: &Train, warms: bool) -> Vec<String> {
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
            Some(t) if warms => {
                format!("with oil that has {:.0} °C at the start and warms with what is lost", t - 273.15)
            }
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
            LossKind::Drag | LossKind::Pump | LossKind::Injection => EnergyLossKind::Drag,
            LossKind::ShiftElement => EnergyLossKind::ShiftElement,
            LossKind::Variator => EnergyLossKind::Variator,
        }
    }
}
