//! How a motion looks: angles of members, and who holds its energy.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::coordinates::{Coordinates, Felt};
use super::damping::Damped;
use super::normal::{Normal, Vibration};
use super::oscillator::Oscillator;
use super::report::{Mode, Part, RigidMode};

/// Shows motions of a train.
pub(super) struct Shapes<'a> {
    oscillator: &'a Oscillator<'a>,
    coordinates: &'a Coordinates,
    felt: &'a Felt,
    /// Angles of all members over the coordinates.
    members: DMatrix<f64>,
}

impl<'a> Shapes<'a> {
    pub fn new(oscillator: &'a Oscillator<'a>, coordinates: &'a Coordinates, felt: &'a Felt) -> Self {
        Self { oscillator, coordinates, felt, members: coordinates.of_members() }
    }

    /// A motion x without strain.
    pub fn rigid(&self, x: &DVector<f64>) -> RigidMode {
        RigidMode { shape: self.angles(x), kinetic_energy: self.kinetic_energy(x) }
    }

    pub fn vibration(&self, vibration: &Vibration, damped: Damped, normal: &Normal<'_>) -> Mode {
        let w = vibration.frequency;
        let x = normal.coordinates(&vibration.shape);
        let (damping_ratio, damped_frequency_hz) = match damped {
            Damped::None => (None, Some(w / TAU)),
            Damped::Vibrates { ratio, frequency } => (Some(ratio), Some(frequency / TAU)),
            Damped::Over(ratio) => (Some(ratio), None),
        };
        Mode {
            frequency_hz: w / TAU,
            angular_frequency_rad_s: w,
            damping_ratio,
            damped_frequency_hz,
            shape: self.angles(&x),
            kinetic_energy: self.kinetic_energy(&x),
            strain_energy: self.strain_energy(&(&normal.strain * &vibration.shape)),
        }
    }

    /// Angle of each member whose motion is settled; the largest is 1.
    fn angles(&self, x: &DVector<f64>) -> Vec<Part> {
        let members = &self.oscillator.train.members;
        let angles = &self.members * x;
        let largest = angles.amax();
        let sign = angles.iter().find(|a| a.abs() >= largest * (1.0 - 1e-9)).map_or(1.0, |a| a.signum());
        (1..members.len())
            .filter(|&m| self.coordinates.speeds[m].is_some())
            .map(|m| Part { name: members[m].name.clone(), value: sign * angles[m] / largest })
            .collect()
    }

    /// Share of the kinetic energy by member.
    fn kinetic_energy(&self, x: &DVector<f64>) -> Vec<Part> {
        let rotors = &self.oscillator.rotors;
        let turns = &self.felt.turns.rounded * x;
        let energies: Vec<f64> = turns.iter().zip(rotors).map(|(w, j)| j.value * w * w).collect();
        let total: f64 = energies.iter().sum();
        let mut kinetic: Vec<Part> = Vec::new();
        for (j, e) in rotors.iter().zip(energies) {
            let name = self.oscillator.train.member_name(j.member);
            match kinetic.iter_mut().find(|p| p.name == name) {
                Some(part) => part.value += e / total,
                None => kinetic.push(Part { name: name.to_owned(), value: e / total }),
            }
        }
        kinetic
    }

    /// Share of the strain energy by shaft, from the strain of each.
    fn strain_energy(&self, strain: &DVector<f64>) -> Vec<Part> {
        let total = strain.norm_squared();
        (self.oscillator.springs.iter().zip(strain.iter()))
            .map(|(s, t)| Part { name: s.name.to_owned(), value: t * t / total })
            .collect()
    }
}
