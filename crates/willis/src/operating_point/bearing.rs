//! Loads and friction of rolling bearings in an operating point.

use num_dual::{Dual64, DualNum};
use serde::Serialize;

use crate::losses::bearing::{BearingDuty, BearingTorque, Palmgren, Supply};
use crate::power_flow::Flow;
use crate::train::{BearingMount, FRAME, MemberId, OilSupply, PlanetBody};

use super::{Extrapolation, OilState, Physics};

/// A place with rolling bearings in an operating point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BearingReport {
    /// Designation.
    pub designation: String,
    /// The members it joins.
    pub members: [String; 2],
    /// Bearings in all: side by side, at every planet.
    pub bearings: u32,
    /// Speed of one ring relative to the other, rad/s.
    pub speed_rad_s: f64,
    /// Radial load of one bearing, the most loaded, N.
    pub radial_load_n: f64,
    /// Axial load of one bearing, N.
    pub axial_load_n: f64,
    /// Frictional torque of one bearing, mean of all, N m.
    pub torque_n_m: f64,
    /// Name of the law.
    pub law: &'static str,
    /// Loss of all of them, W.
    pub loss_w: f64,
}

/// A force that has a part in proportion to the tooth forces and a part that has not.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    /// Along the direction of travel, from the teeth, N.
    tangential: f64,
    /// Along the radius outward, from the teeth, N.
    radial: f64,
    /// Along the radius outward, centrifugal, N.
    centrifugal: f64,
    /// Axial, from the teeth, N.
    axial: f64,
    /// Tilting moment in the plane of radius and axis, from the teeth, N m.
    tilting: f64,
}

impl Physics<'_> {
    /// Friction of the bearings of a mount: report, torque of all of them, the part of it that grows
    /// in proportion to the tooth loads, and the meshes that make the load with their weights.
    pub(super) fn bearing(
        &self,
        mount: &BearingMount,
        flow: &Flow,
        oil: &OilState,
        beyond: &mut Option<Vec<Extrapolation>>,
    ) -> (BearingReport, f64, f64, Vec<(usize, f64)>) {
        let train = &self.train;
        let [a, b] = mount.members;
        let speed = self.slip(flow, mount.members);
        let planet = train.planets.iter().find(|p| mount.members.contains(&p.member));
        let (load, loading) = match planet {
            Some(planet) => self.planet_load(planet, flow),
            // Of two shafts, the one that has gears.
            None => match self.central_load(a, flow) {
                (_, none) if a == FRAME || none.is_empty() && b != FRAME => self.central_load(b, flow),
                found => found,
            },
        };
        let count = f64::from(mount.count);
        // A pair takes the tilting moment by unequal radial loads.
        let face = |j: &(usize, f64)| train.meshes[j.0].teeth.as_ref().map_or(0.0, |t| t.pair.total_width());
        let span = mount.span.unwrap_or_else(|| loading.iter().map(face).fold(0.0, f64::max));
        let couple = if mount.count > 1 && span > 0.0 { load.tilting / span } else { 0.0 };
        // The load of one bearing at scale 1 of the tooth forces, with its derivative by that scale.
        let scale = Dual64::new(1.0, 1.0);
        let one = |side: f64| {
            let tangential = scale * (load.tangential / count);
            let radial = scale * (load.radial / count + side * couple) + load.centrifugal / count;
            let size = tangential * tangential + radial * radial;
            let size = if size.re > 0.0 { size.sqrt() } else { Dual64::from_re(0.0) };
            size + mount.radial_load / count
        };
        let axial = scale * (load.axial / count) + mount.axial_load / count;
        let law = self.bearing_law(mount);
        let (lubrication, _) = self.oil.as_ref().expect("bearings are computed with an oil");
        let duty = |radial: Dual64| BearingDuty {
            bearing: mount.bearing.data(),
            speed: Dual64::from_re(speed),
            radial_load: radial,
            axial_load: axial,
            kinematic_viscosity: Dual64::from_re(oil.kinematic_viscosity),
            base: lubrication.oil.base,
            sliding_friction: match mount.bearing.kind.is_ball() {
                true => lubrication.oil.sliding_ball,
                // Measured on cylindrical rollers.
                false => lubrication.oil.sliding_roller.filter(|_| {
                    use crate::catalogue::bearing::Kind::{
                        AxialCylindricalRoller, CylindricalRoller, FullComplementCylindricalRoller, NeedleRoller,
                    };
                    let kind = mount.bearing.kind;
                    matches!(
                        kind,
                        CylindricalRoller | FullComplementCylindricalRoller | AxialCylindricalRoller | NeedleRoller
                    )
                }),
            },
            supply: self.supply(mount),
        };
        let sides = if couple != 0.0 { [1.0, -1.0] } else { [0.0, 0.0] };
        let mut torque = Dual64::from_re(0.0);
        let mut radial = 0.0f64;
        for side in sides {
            let own = one(side);
            radial = radial.max(own.re);
            if speed > 0.0 {
                torque += law.eval(&duty(own)) * 0.5;
            }
        }
        if let (Some(all), true) = (beyond, speed > 0.0) {
            let d = duty(one(sides[0]));
            let plain = BearingDuty {
                bearing: d.bearing,
                speed: d.speed.re,
                radial_load: d.radial_load.re,
                axial_load: d.axial_load.re,
                kinematic_viscosity: d.kinematic_viscosity.re,
                base: d.base,
                sliding_friction: d.sliding_friction,
                supply: d.supply,
            };
            for outside in law.outside(&plain) {
                all.push(Extrapolation { family: "bearing", law: law.meta().id, at: mount.name.clone(), outside });
            }
        }
        let number = mount.count * mount.places;
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        let all = finite(torque.re).max(0.0) * f64::from(number);
        let proportional = (finite(torque.eps) * f64::from(number)).clamp(0.0, all);
        let report = BearingReport {
            designation: mount.bearing.designation.clone(),
            members: mount.members.map(|m| train.member_name(m).to_owned()),
            bearings: number,
            speed_rad_s: speed,
            radial_load_n: radial,
            axial_load_n: axial.re,
            torque_n_m: all / f64::from(number),
            law: law.meta().id,
            loss_w: 0.0,
        };
        (report, all, proportional, loading)
    }

    /// The law for a bearing: the SKF model has no constants for some kinds; Palmgren has.
    fn bearing_law(&self, mount: &BearingMount) -> BearingTorque {
        let chosen = self.train.laws.bearing;
        let skf = matches!(chosen, BearingTorque::Skf(_) | BearingTorque::Skf6000(_));
        if skf && mount.bearing.skf.is_none() { BearingTorque::Palmgren(Palmgren::DEFAULT) } else { chosen }
    }

    fn supply(&self, mount: &BearingMount) -> Supply {
        let train = self.oil.as_ref().and_then(|(l, _)| l.supply);
        match mount.supply.or(train) {
            Some(OilSupply::Jet) => Supply::Jet,
            Some(OilSupply::Mist) => Supply::Mist,
            Some(OilSupply::Grease) => Supply::Grease,
            Some(OilSupply::Bath) | None => Supply::Bath { level: mount.level.unwrap_or(0.0) },
        }
    }

    /// Load of one planet's bearings: the tangential forces of its meshes add up, the radial ones
    /// cancel as far as the pressure angles agree, and the planet itself pulls outward.
    fn planet_load(&self, planet: &PlanetBody, flow: &Flow) -> (Load, Vec<(usize, f64)>) {
        let train = &self.train;
        let mut load = Load {
            centrifugal: planet.mass * flow.speeds[planet.carrier.0].powi(2) * planet.orbit_radius,
            ..Load::default()
        };
        let mut loading = Vec::new();
        let (mut between_planets, mut between_tilts) = (0.0f64, 0.0f64);
        for (j, m) in flow.meshes.iter().enumerate() {
            let mesh = &train.meshes[m.mesh.0];
            let Some(k) = mesh.gears.iter().position(|g| g.member == planet.member) else { continue };
            let Some(teeth) = &mesh.teeth else { continue };
            let pair = &teeth.pair;
            // Torque of the mesh on one planet.
            let moment = -m.torques[k] / f64::from(mesh.count);
            let radius = pair.gears[k].operating_radius;
            let force = moment / radius;
            loading.push((j, force.abs()));
            // On one helicoid the axial force is in proportion to the moment, wherever the contact is.
            let axial = if pair.data.double_helical { 0.0 } else { force * pair.operating_helix.tan() };
            load.axial += axial;
            let other = mesh.gears[1 - k].member;
            if train.planets.iter().any(|p| p.member == other)
                || train.members[other.0].kind == crate::train::MemberKind::Planet
            {
                // Where the other planet sits is not known: the whole force, in the worst direction.
                between_planets += force.abs() / pair.operating_pressure_angle.cos();
                between_tilts += axial.abs() * radius;
                continue;
            }
            // Contact on the far side of a ring, pressing inward; on the near side of a sun.
            let side = if pair.internal() { 1.0 } else { -1.0 };
            load.tangential += side * force;
            load.radial -= side * force.abs() * pair.operating_pressure_angle.tan();
            load.tilting -= side * axial * radius;
        }
        load.tangential = load.tangential.abs() + between_planets;
        load.tilting = load.tilting.abs() + between_tilts;
        load.axial = load.axial.abs();
        (load, loading)
    }

    /// Load of a central shaft: nothing radial from equally spaced planets, the whole tooth force
    /// from a single pair; axial forces of single helices. Forces of several pairs on one shaft are
    /// added as if they pointed in one direction.
    fn central_load(&self, member: MemberId, flow: &Flow) -> (Load, Vec<(usize, f64)>) {
        let train = &self.train;
        let mut load = Load::default();
        let mut loading = Vec::new();
        for (j, m) in flow.meshes.iter().enumerate() {
            let mesh = &train.meshes[m.mesh.0];
            let Some(k) = mesh.gears.iter().position(|g| g.member == member) else { continue };
            let Some(teeth) = &mesh.teeth else { continue };
            let pair = &teeth.pair;
            let force = m.torques[k].abs() / pair.gears[k].operating_radius;
            let axial = if pair.data.double_helical { 0.0 } else { force * pair.operating_helix.tan() };
            load.axial += axial;
            // A set whose number of planets is not told is taken as balanced.
            let single = mesh.count == 1 && mesh.set.is_none_or(|s| train.sets[s].planets.is_some());
            if single {
                load.tangential += force / pair.operating_pressure_angle.cos();
            }
            if single || axial > 0.0 {
                loading.push((j, force));
            }
        }
        (load, loading)
    }
}
