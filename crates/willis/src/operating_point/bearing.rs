//! Loads and friction of rolling bearings in an operating point.

use num_dual::{Dual, DualNum};
use serde::{Deserialize, Serialize};

use crate::losses::bearing::{BearingDuty, BearingTorque, Palmgren, Supply};
use crate::power_flow::MeshFlow;
use crate::real::{self, Real};
use crate::train::{BearingMount, FRAME, MemberId, OilSupply};

use super::{Extrapolation, Physics};

/// A place with rolling bearings in an operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
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
    pub law: String,
    /// Loss of all of them, W.
    pub loss_w: f64,
}

/// A force that has a part in proportion to the tooth forces and a part that has not.
#[derive(Clone, Copy, Debug)]
struct Load<R> {
    /// Along the direction of travel, from the teeth, N.
    tangential: R,
    /// Along the radius outward, from the teeth, N.
    radial: R,
    /// Along the radius outward, centrifugal, N.
    centrifugal: R,
    /// Axial, from the teeth, N.
    axial: R,
    /// Tilting moment in the plane of radius and axis, from the teeth, N m.
    tilting: R,
}

impl<R: Real> Load<R> {
    fn none() -> Self {
        let none = R::from(0.0);
        Self { tangential: none, radial: none, centrifugal: none, axial: none, tilting: none }
    }
}

/// A load and the meshes that make it, with their weights.
type Loading<R> = (Load<R>, Vec<(usize, R)>);

/// Friction of the bearings of a mount.
pub(super) struct Friction<R> {
    pub report: BearingReport,
    /// Speed of one ring relative to the other, rad/s.
    pub speed: R,
    /// Torque of all of them, N m.
    pub torque: R,
    /// The part of it that grows in proportion to the tooth loads, N m.
    pub proportional: R,
    /// The meshes that make the load, with their weights.
    pub loading: Vec<(usize, R)>,
}

impl<R: Real> Physics<'_, R> {
    /// Friction of the bearings of a mount; `duties` is told the law and the state of one of them.
    pub(super) fn bearing(
        &self,
        k: usize,
        speeds: &[R],
        meshes: &[MeshFlow<R>],
        duties: &mut dyn FnMut(&BearingTorque, &BearingDuty<Dual<R>>),
    ) -> Friction<R> {
        let train = &self.train;
        let (mount, numbers) = (&train.bearings[k], &self.numbers.bearings[k]);
        let [a, b] = mount.members;
        let speed = self.slip(speeds, mount.members);
        let planet = train.planets.iter().position(|p| mount.members.contains(&p.member));
        let (load, loading) = match planet {
            Some(planet) => self.planet_load(planet, speeds, meshes),
            // Of two shafts, the one that has gears.
            None => match self.central_load(a, meshes) {
                (_, none) if a == FRAME || none.is_empty() && b != FRAME => self.central_load(b, meshes),
                found => found,
            },
        };
        let none = R::from(0.0);
        let count = f64::from(mount.count);
        // A pair takes the tilting moment by unequal radial loads.
        let face =
            |j: &(usize, R)| self.numbers.teeth[meshes[j.0].mesh.0].as_ref().map_or(none, |t| t.pair.total_width());
        let span = numbers.span.unwrap_or_else(|| loading.iter().map(face).fold(none, real::max));
        let couple = if mount.count > 1 && span.re() > 0.0 { load.tilting / span } else { none };
        // The load of one bearing at scale 1 of the tooth forces, with its derivative by that scale.
        let scale = |x: R| Dual::new(x, x);
        let fixed = Dual::from_re;
        let one = |side: f64| {
            let tangential = scale(load.tangential / count);
            let radial = scale(load.radial / count + couple * side) + fixed(load.centrifugal / count);
            let size = tangential * tangential + radial * radial;
            let size = if size.re.re() > 0.0 { size.sqrt() } else { fixed(none) };
            size + fixed(numbers.radial_load / count)
        };
        let axial = scale(load.axial / count) + fixed(numbers.axial_load / count);
        let law = self.bearing_law(mount);
        let (lubrication, oil) = self.oil.as_ref().expect("bearings are computed with an oil");
        let duty = |radial: Dual<R>| BearingDuty {
            bearing: numbers.data,
            speed: fixed(speed),
            radial_load: radial,
            axial_load: axial,
            kinematic_viscosity: fixed(oil.kinematic_viscosity),
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
            supply: self.supply(k),
        };
        let sides = if couple.re() != 0.0 { [1.0, -1.0] } else { [0.0, 0.0] };
        let mut torque = fixed(none);
        let mut radial = 0.0f64;
        for side in sides {
            let own = one(side);
            radial = radial.max(own.re.re());
            if speed.re() > 0.0 {
                torque += law.eval(&duty(own)) * 0.5;
            }
        }
        if speed.re() > 0.0 {
            duties(&law, &duty(one(sides[0])));
        }
        let number = mount.count * mount.places;
        let finite = |x: R| if x.re().is_finite() { x } else { none };
        let all = real::max(finite(torque.re), none) * f64::from(number);
        let proportional = real::clamp(finite(torque.eps) * f64::from(number), none, all);
        let report = BearingReport {
            designation: mount.bearing.designation.clone(),
            members: mount.members.map(|m| train.member_name(m).to_owned()),
            bearings: number,
            speed_rad_s: speed.re(),
            radial_load_n: radial,
            axial_load_n: axial.re.re(),
            torque_n_m: all.re() / f64::from(number),
            law: law.meta().id.to_owned(),
            loss_w: 0.0,
        };
        Friction { report, speed, torque: all, proportional, loading }
    }

    /// The law for a bearing: the SKF model has no constants for some kinds; Palmgren has.
    pub(super) fn bearing_law(&self, mount: &BearingMount) -> BearingTorque {
        let chosen = self.train.laws.bearing;
        let skf = matches!(chosen, BearingTorque::Skf(_) | BearingTorque::Skf6000(_));
        if skf && mount.bearing.skf.is_none() { BearingTorque::Palmgren(Palmgren::DEFAULT) } else { chosen }
    }

    fn supply(&self, k: usize) -> Supply<R> {
        let train = self.oil.as_ref().and_then(|(l, _)| l.supply);
        match self.train.bearings[k].supply.or(train) {
            Some(OilSupply::Jet) => Supply::Jet,
            Some(OilSupply::Mist) => Supply::Mist,
            Some(OilSupply::Grease) => Supply::Grease,
            Some(OilSupply::Bath) | None => {
                Supply::Bath { level: self.numbers.bearings[k].level.unwrap_or(R::from(0.0)) }
            }
        }
    }

    /// Load of one planet's bearings: the tangential forces of its meshes add up, the radial ones
    /// cancel as far as the pressure angles agree, and the planet itself pulls outward.
    fn planet_load(&self, planet: usize, speeds: &[R], meshes: &[MeshFlow<R>]) -> Loading<R> {
        let train = &self.train;
        let [orbit_radius, mass] = self.numbers.planets[planet];
        let planet = &train.planets[planet];
        let none = R::from(0.0);
        let mut load = Load { centrifugal: mass * speeds[planet.carrier.0].powi(2) * orbit_radius, ..Load::none() };
        let mut loading = Vec::new();
        let (mut between_planets, mut between_tilts) = (none, none);
        for (j, m) in meshes.iter().enumerate() {
            let mesh = &train.meshes[m.mesh.0];
            let Some(k) = mesh.gears.iter().position(|g| g.member == planet.member) else { continue };
            let Some(teeth) = &self.numbers.teeth[m.mesh.0] else { continue };
            let pair = &teeth.pair;
            // Torque of the mesh on one planet.
            let moment = -m.torques[k] / f64::from(mesh.count);
            let radius = pair.gears[k].operating_radius;
            let force = moment / radius;
            let size = real::abs(force);
            loading.push((j, size));
            // On one helicoid the axial force is in proportion to the moment, wherever the contact is.
            let axial = if pair.data.double_helical { none } else { force * pair.operating_helix.tan() };
            load.axial += axial;
            let other = mesh.gears[1 - k].member;
            if train.planets.iter().any(|p| p.member == other)
                || train.members[other.0].kind == crate::train::MemberKind::Planet
            {
                // Where the other planet sits is not known: the whole force, in the worst direction.
                between_planets += size / pair.operating_pressure_angle.cos();
                between_tilts += real::abs(axial) * radius;
                continue;
            }
            // Contact on the far side of a ring, pressing inward; on the near side of a sun.
            let side = if pair.internal() { 1.0 } else { -1.0 };
            load.tangential += force * side;
            load.radial -= size * side * pair.operating_pressure_angle.tan();
            load.tilting -= axial * side * radius;
        }
        load.tangential = real::abs(load.tangential) + between_planets;
        load.tilting = real::abs(load.tilting) + between_tilts;
        load.axial = real::abs(load.axial);
        (load, loading)
    }

    /// Load of a central shaft: nothing radial from equally spaced planets, the whole tooth force
    /// from a single pair; axial forces of single helices. Forces of several pairs on one shaft are
    /// added as if they pointed in one direction.
    fn central_load(&self, member: MemberId, meshes: &[MeshFlow<R>]) -> Loading<R> {
        let train = &self.train;
        let mut load = Load::none();
        let mut loading = Vec::new();
        for (j, m) in meshes.iter().enumerate() {
            let mesh = &train.meshes[m.mesh.0];
            let Some(k) = mesh.gears.iter().position(|g| g.member == member) else { continue };
            let Some(teeth) = &self.numbers.teeth[m.mesh.0] else { continue };
            let pair = &teeth.pair;
            let force = real::abs(m.torques[k]) / pair.gears[k].operating_radius;
            let none = R::from(0.0);
            let axial = if pair.data.double_helical { none } else { force * pair.operating_helix.tan() };
            load.axial += axial;
            // A set whose number of planets is not told is taken as balanced.
            let single = mesh.count == 1 && mesh.set.is_none_or(|s| train.sets[s].planets.is_some());
            if single {
                load.tangential += force / pair.operating_pressure_angle.cos();
            }
            if single || axial.re() > 0.0 {
                loading.push((j, force));
            }
        }
        (load, loading)
    }
}

impl Physics<'_> {
    /// Where the law of a bearing was used outside its range.
    pub(super) fn bearing_extrapolations(
        &self,
        k: usize,
        speeds: &[f64],
        meshes: &[MeshFlow],
        all: &mut Vec<Extrapolation>,
    ) {
        let name = &self.train.bearings[k].name;
        self.bearing(k, speeds, meshes, &mut |law, d| {
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
                all.push(Extrapolation { family: "bearing", law: law.meta().id, at: name.clone(), outside });
            }
        });
    }
}
