//! Friction of rolling and plain bearings in an operating point, under what they carry.

use num_dual::Dual;
use serde::{Deserialize, Serialize};

use crate::catalogue::bearing::Kind;
use crate::losses::OutsideValidity;
use crate::losses::bearing::{BearingDuty, BearingTorque, Palmgren, Supply, Turning};
use crate::losses::plain_bearing::{Journal, PlainBearing};
use crate::real::{self, Real};
use crate::train::{BearingMount, OilSupply, Train};

use super::forces::Carried;
use super::{Extrapolation, Physics};

/// A place with bearings in an operating point.
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
    /// Axial load of one bearing, N; mean of those that share it.
    pub axial_load_n: f64,
    /// Frictional torque of one bearing, mean of all, N m.
    pub torque_n_m: f64,
    /// Name of the law.
    pub law: String,
    /// Loss of all of them, W.
    pub loss_w: f64,
}

/// The numbers of a [`BearingReport`]; units as there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BearingState {
    pub speed: f64,
    pub radial_load: f64,
    pub axial_load: f64,
    pub torque: f64,
    pub loss: f64,
}

/// One bearing under load, as its law sees it, with derivatives by a factor on the tooth forces.
#[expect(clippy::large_enum_variant, reason = "one at a time on the stack; a box would allocate at every point")]
pub(super) enum Duty<R: Real> {
    Rolling(BearingTorque, BearingDuty<Dual<R>>),
    Plain(PlainBearing, Journal<Dual<R>>),
}

impl<R: Real> Duty<R> {
    /// Frictional torque, N m.
    fn torque(&self, turning: Option<&Turning<Dual<R>>>) -> Dual<R> {
        match self {
            Self::Rolling(law, duty) => law.eval_turning(duty, turning),
            Self::Plain(law, journal) => law.eval(journal),
        }
    }
}

impl Duty<f64> {
    /// Family, law, and what lies outside its range.
    fn outside(&self) -> (&'static str, &'static str, Vec<OutsideValidity>) {
        match self {
            Self::Rolling(law, d) => {
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
                (BearingTorque::FAMILY, law.meta().id, law.outside(&plain))
            }
            Self::Plain(law, j) => {
                let plain = Journal {
                    speed: j.speed.re,
                    diameter: j.diameter.re,
                    width: j.width.re,
                    clearance: j.clearance.re,
                    load: j.load.re,
                    viscosity: j.viscosity.re,
                    friction: j.friction.re,
                };
                (PlainBearing::FAMILY, law.meta().id, law.outside(&plain))
            }
        }
    }
}

/// Friction of the bearings of a mount.
pub(super) struct Friction<R> {
    /// Speed of one ring relative to the other, rad/s.
    pub speed: R,
    /// Torque of all of them, N m.
    pub torque: R,
    /// The part of it that grows in proportion to the tooth loads, N m.
    pub proportional: R,
}

impl<R: Real> Physics<'_, R> {
    /// One bearing of a mount under its loads.
    fn duty(&self, k: usize, speed: R, radial: Dual<R>, axial: Dual<R>) -> Duty<R> {
        let (mount, numbers) = (&self.train.bearings[k], &self.numbers.bearings[k]);
        let fixed = Dual::from_re;
        let (lubrication, oil) = self.oil.as_ref().expect("bearings are computed with an oil");
        let kind = mount.bearing.kind;
        if kind == Kind::Plain {
            let journal = Journal {
                speed: fixed(speed),
                diameter: fixed(numbers.data.bore),
                width: fixed(numbers.data.width),
                clearance: fixed(numbers.clearance),
                load: radial,
                viscosity: fixed(oil.dynamic_viscosity),
                friction: fixed(numbers.friction),
            };
            return Duty::Plain(self.train.laws.plain_bearing, journal);
        }
        let duty = BearingDuty {
            bearing: numbers.data,
            speed: fixed(speed),
            radial_load: radial,
            axial_load: axial,
            kinematic_viscosity: fixed(oil.kinematic_viscosity),
            base: lubrication.oil.base,
            sliding_friction: match kind.is_ball() {
                true => lubrication.oil.sliding_ball,
                // Measured on cylindrical rollers.
                false => lubrication.oil.sliding_roller.filter(|_| {
                    use Kind::{
                        AxialCylindricalRoller, CylindricalRoller, FullComplementCylindricalRoller, NeedleRoller,
                    };
                    matches!(
                        kind,
                        CylindricalRoller | FullComplementCylindricalRoller | AxialCylindricalRoller | NeedleRoller
                    )
                }),
            },
            supply: self.supply(k),
        };
        Duty::Rolling(self.bearing_law(mount), duty)
    }

    /// What of the friction of a bearing of a mount no load changes.
    pub(super) fn turning(&self, k: usize, speeds: &[R]) -> Option<Turning<Dual<R>>> {
        let speed = self.slip(speeds, self.train.bearings[k].members);
        let none = Dual::from_re(R::from(0.0));
        match self.duty(k, speed, none, none) {
            Duty::Rolling(law, duty) if speed.re() > 0.0 => law.turning(&duty),
            _ => None,
        }
    }

    /// Axial load on each bearing of a mount.
    fn thrust(&self, k: usize, carried: &Carried<R>) -> Dual<R> {
        let count = f64::from(self.train.bearings[k].count);
        carried.axial / count + Dual::from_re(self.numbers.bearings[k].axial_load / count)
    }

    /// Radial and axial load of the bearing of a mount that is loaded most.
    fn hardest(&self, k: usize, carried: &Carried<R>) -> [Dual<R>; 2] {
        let (mount, numbers) = (&self.train.bearings[k], &self.numbers.bearings[k]);
        // What the teeth make of the load, of the planet that is loaded most; of a load that is not all theirs to first order.
        let beyond_mean = self.load_sharing(mount, &carried.loading) - 1.0;
        let hardest = |load: &Dual<R>| *load + Dual::from_re(load.eps * beyond_mean);
        let given = Dual::from_re(numbers.radial_load / f64::from(mount.count));
        let mut worst = Dual::from_re(R::from(0.0));
        for own in &carried.radial {
            let own = hardest(&(*own + given));
            if own.re.re() >= worst.re.re() {
                worst = own;
            }
        }
        [worst, hardest(&self.thrust(k, carried))]
    }

    /// Friction of the bearings of a mount under what they carry.
    pub(super) fn bearing(
        &self,
        k: usize,
        speeds: &[R],
        carried: &Carried<R>,
        turning: Option<&Turning<Dual<R>>>,
    ) -> Friction<R> {
        let (mount, numbers) = (&self.train.bearings[k], &self.numbers.bearings[k]);
        let speed = self.slip(speeds, mount.members);
        let none = R::from(0.0);
        let fixed = Dual::from_re;
        let axial = self.thrust(k, carried);
        let given = fixed(numbers.radial_load / f64::from(mount.count));
        let mut torque = fixed(none);
        // Bearings side by side mostly carry the same. Derivatives are no part of what `==` compares.
        let mut last = None::<(Dual<R>, Dual<R>)>;
        let same = |a: &Dual<R>, b: &Dual<R>| R::NDERIV == 0 && a.re == b.re && a.eps == b.eps;
        for own in carried.radial.iter().filter(|_| speed.re() > 0.0) {
            let own = *own + given;
            let known = last.filter(|(load, _)| same(load, &own));
            let (_, each) =
                *last.insert(known.unwrap_or_else(|| (own, self.duty(k, speed, own, axial).torque(turning))));
            torque += each * (1.0 / carried.radial.len() as f64);
        }
        let number = mount.count * mount.places;
        let [all, proportional] = [torque.re, torque.eps].map(|x| if x.re().is_finite() { x } else { none });
        let all = real::max(all, none) * f64::from(number);
        let proportional = real::clamp(proportional * f64::from(number), none, all);
        Friction { speed, torque: all, proportional }
    }

    /// Load of the planet that is loaded most over the mean, at the bearings of planets; else 1.
    fn load_sharing(&self, mount: &BearingMount, loading: &[(usize, R)]) -> f64 {
        let planet = self.train.planets.iter().any(|p| mount.members.contains(&p.member));
        let factors = loading.iter().map(|(j, _)| self.train.meshes[*j].sharing());
        factors.filter(|_| planet).fold(1.0, f64::max)
    }

    /// The law for a bearing: the SKF model has no constants for some kinds; Palmgren has.
    pub(super) fn bearing_law(&self, mount: &BearingMount) -> BearingTorque {
        let chosen = self.train.laws.bearing;
        let skf = matches!(chosen, BearingTorque::Skf(_) | BearingTorque::Skf6000(_));
        if skf && mount.bearing.skf.is_none() { BearingTorque::Palmgren(Palmgren::DEFAULT) } else { chosen }
    }

    /// Its name, of plain bearings as of others.
    pub(super) fn bearing_law_name(&self, mount: &BearingMount) -> &'static str {
        match mount.bearing.kind {
            Kind::Plain => self.train.laws.plain_bearing.meta().id,
            _ => self.bearing_law(mount).meta().id,
        }
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
}

impl Physics<'_> {
    /// The bearings of a mount under what they carry, with this torque of each and this loss of all, and where their law is
    /// used outside its range.
    pub(super) fn bearing_state(
        &self,
        k: usize,
        speeds: &[f64],
        carried: &Carried<f64>,
        [torque, loss]: [f64; 2],
        beyond: &mut Vec<Extrapolation>,
    ) -> BearingState {
        let mount = &self.train.bearings[k];
        let speed = self.slip(speeds, mount.members);
        let [radial, axial] = self.hardest(k, carried);
        if speed > 0.0 {
            let (family, law, outside) = self.duty(k, speed, radial, axial).outside();
            let own = |outside| Extrapolation { family, law, at: mount.name.clone(), outside };
            beyond.extend(outside.into_iter().map(own));
        }
        BearingState { speed, radial_load: radial.re, axial_load: axial.re, torque, loss }
    }

    /// The same for people.
    pub(super) fn bearing_report(&self, train: &Train, k: usize, state: &BearingState) -> BearingReport {
        let mount = &train.bearings[k];
        BearingReport {
            designation: mount.bearing.designation.clone(),
            members: mount.members.map(|m| train.member_name(m).to_owned()),
            bearings: mount.count * mount.places,
            speed_rad_s: state.speed,
            radial_load_n: state.radial_load,
            axial_load_n: state.axial_load,
            torque_n_m: state.torque,
            law: self.bearing_law_name(mount).to_owned(),
            loss_w: state.loss,
        }
    }
}
