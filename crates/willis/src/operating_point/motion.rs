//! The laws for a train in motion: the same evaluation as at an operating point, at any state, with torques
//! instead of powers, so that nothing needs to turn.

use std::borrow::Cow;

use crate::power_flow::Flow;
use crate::train::heat::HeatPart;
use crate::train::{FRAME, Fluid, MemberId, MeshId, Train};

use super::{LossKind, Physics, Source, Step};

/// Amount of relative speed below which a law is taken at it, rad/s: many hold no longer there, and grow without
/// bound.
pub(crate) const LEAST_SPEED: f64 = 0.1;

/// Where a law exerts a drag, and on what.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    source: Source,
    pub members: [MemberId; 2],
    pub name: String,
    pub kind: LossKind,
}

impl Place {
    /// What makes the heat; none where it is made in the oil.
    pub fn heat_part(&self) -> Option<HeatPart> {
        match self.source {
            Source::Rolling(_) => Some(HeatPart::Member(self.members[0])),
            Source::Bearing(k) => Some(HeatPart::Bearing(k)),
            Source::Seal(k) => Some(HeatPart::Seal(k)),
            Source::Rotor(k) => Some(HeatPart::Rotor(k)),
            _ => None,
        }
    }
}

impl Physics<'static> {
    /// For a train that moves, at the temperature of its oil.
    pub fn in_motion(train: &Train) -> Self {
        Self { least_speed: LEAST_SPEED, drags: None, ..Self::at(Cow::Owned(train.clone()), None) }
    }

    /// Every place of a drag.
    pub fn places(&self) -> Vec<Place> {
        let train = &self.train;
        let mut all = Vec::new();
        let mut add = |source: Source, members: [MemberId; 2], name: String, kind: LossKind| {
            all.push(Place { source, members, name, kind });
        };
        for (k, mesh) in train.meshes.iter().enumerate().filter(|(_, m)| m.computed && self.rolling.is_some()) {
            for gear in &mesh.gears {
                let name = format!("{} rolling on {}", mesh.name, train.member_name(gear.member));
                add(Source::Rolling(k), [gear.member, mesh.carrier], name, LossKind::Rolling);
            }
        }
        for (k, b) in train.bearings.iter().enumerate().filter(|_| self.oil.is_some()) {
            add(Source::Bearing(k), b.members, b.name.clone(), LossKind::Bearing);
        }
        for (k, s) in train.seals.iter().enumerate() {
            add(Source::Seal(k), s.members, s.name.clone(), LossKind::Seal);
        }
        for (k, b) in self.bodies.iter().enumerate() {
            let (kind, _) = b.kind(train);
            let what = if kind == LossKind::Churning { "churning" } else { "windage" };
            add(Source::Body(k), [b.member, b.against], format!("{} {what}", b.name), kind);
        }
        for (k, r) in train.rotors.iter().enumerate() {
            let kind = if r.fluid == Fluid::Oil { LossKind::Churning } else { LossKind::Windage };
            add(Source::Rotor(k), [r.member, FRAME], r.name.clone(), kind);
        }
        all
    }

    /// Losses at the speeds and torques of a flow.
    pub fn follow(&self, flow: &Flow) -> Step {
        self.evaluate(&flow.speeds, &flow.meshes, &|_| true)
    }

    /// Name of the law of tooth friction in force.
    pub fn friction_law(&self) -> &'static str {
        self.friction.meta().id
    }
}

impl Step {
    /// Amount of the drag at a place, N m.
    pub fn drag(&self, place: &Place) -> f64 {
        let found =
            self.sources.iter().zip(&self.drags).find(|(s, d)| **s == place.source && d.members == place.members);
        found.map_or(0.0, |(_, d)| d.torque.abs())
    }

    /// Part of a mesh's power that is lost in proportion to its load, first gear driving and second gear driving.
    pub fn lost(&self, mesh: MeshId) -> [f64; 2] {
        [0, 1].map(|driver| self.meshes[mesh.0].lost(driver).min(super::MOST_LOST))
    }

    /// How much of that each bearing takes: its place and its part of the whole.
    pub fn bearing_parts<'a>(&'a self, mesh: MeshId, places: &'a [Place]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let own = &self.meshes[mesh.0];
        own.bearings.iter().filter_map(move |&(k, part)| {
            let place = places.iter().position(|p| p.source == Source::Bearing(k))?;
            Some((place, part / own.total()))
        })
    }
}
