//! Gears that turn in air or oil, rotors, seals: losses that depend on speed alone.

use crate::exact::Rational;
use crate::losses::Outside;
use crate::losses::churning::Dip;
use crate::losses::rotor_drag::Drum;
use crate::losses::seal::Lip;
use crate::losses::windage::{AIR_PER_OIL, Disc, Windage, mist};
use crate::power_flow::Flow;
use crate::train::{FRAME, Fluid, MemberId, MemberKind, OilSupply, Rotor, SealMount, Train};

use super::{Extrapolation, LossKind, Physics};

/// Density of air, kg/m³, and its dynamic viscosity, Pa s, at 20 °C and 1013 hPa.
const AIR: (f64, f64) = (1.204, 18.2e-6);
/// Acceleration of free fall, m/s².
const GRAVITY: f64 = 9.806_65;
/// Viscosity of an oil at 40 °C where only the one at its temperature is known, m²/s.
const VG_100: f64 = 100e-6;

/// A gear that turns in air or oil.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub name: String,
    pub member: MemberId,
    /// What its drag acts against: the frame, or for a planet its carrier, with which the fluid
    /// turns.
    pub against: MemberId,
    /// Mesh and gear whose geometry it has.
    mesh: usize,
    gear: usize,
    count: u32,
    /// Depth of immersion at rest, m.
    immersion: Option<f64>,
}

/// Every gear with teeth that meets a fluid: each once, though it may be in several meshes.
pub(super) fn bodies(train: &Train) -> Vec<Body> {
    let Some(lubrication) = &train.lubrication else { return vec![] };
    let in_mist = matches!(lubrication.supply, Some(OilSupply::Jet | OilSupply::Mist));
    let mut seen: Vec<(MemberId, Rational, bool)> = Vec::new();
    let mut all = Vec::new();
    for (j, mesh) in train.meshes.iter().enumerate() {
        let Some(teeth) = &mesh.teeth else { continue };
        for (k, g) in mesh.gears.iter().enumerate() {
            let immersion = teeth.immersion[k].filter(|h| *h > 0.0);
            let key = (g.member, g.teeth.clone(), g.internal);
            if g.member == FRAME || seen.contains(&key) || !(in_mist || immersion.is_some()) {
                continue;
            }
            seen.push(key);
            let planet = train.members[g.member.0].kind == MemberKind::Planet
                || train.planets.iter().any(|p| p.member == g.member);
            let several =
                train.meshes.iter().flat_map(|m| &m.gears).any(|o| o.member == g.member && o.teeth != g.teeth);
            let name = train.member_name(g.member);
            all.push(Body {
                name: if several { format!("{name} ({} teeth)", g.teeth) } else { name.to_owned() },
                member: g.member,
                against: if planet { mesh.carrier } else { FRAME },
                mesh: j,
                gear: k,
                count: if planet { mesh.count } else { 1 },
                immersion,
            });
        }
    }
    all
}

impl Body {
    pub fn kind(&self, train: &Train) -> (LossKind, &'static str) {
        match self.immersion {
            Some(_) => (LossKind::Churning, train.laws.churning.meta().id),
            None => (LossKind::Windage, train.laws.windage.meta().id),
        }
    }
}

/// Torque of a power at a speed.
fn torque(power: f64, speed: f64) -> f64 {
    let t = power / speed;
    if t.is_finite() { t.max(0.0) } else { 0.0 }
}

impl Physics<'_> {
    fn note(
        &self,
        beyond: &mut Option<Vec<Extrapolation>>,
        (family, law, at): (&'static str, &'static str, &str),
        outside: impl FnOnce() -> Vec<Outside>,
    ) {
        if let Some(all) = beyond {
            all.extend(outside().into_iter().map(|outside| Extrapolation { family, law, at: at.to_owned(), outside }));
        }
    }

    /// Density and viscosity of a fluid around the gears.
    fn fluid(&self, fluid: Fluid) -> (f64, f64) {
        match (fluid, &self.oil) {
            (Fluid::Oil, Some((_, oil))) => (oil.density, oil.dynamic_viscosity),
            (Fluid::Mist, Some((l, oil))) => {
                let parts = l.mist.unwrap_or(AIR_PER_OIL);
                (mist(oil.density, AIR.0, parts), mist(oil.dynamic_viscosity, AIR.1, parts))
            }
            _ => AIR,
        }
    }

    /// Drag of a gear (all of its count), N m.
    pub(super) fn body(&self, body: &Body, flow: &Flow, beyond: &mut Option<Vec<Extrapolation>>) -> f64 {
        let speed = self.slip(flow, [body.member, body.against]);
        let (Some((lubrication, oil)), true) = (&self.oil, speed > 0.0) else { return 0.0 };
        let laws = &self.train.laws;
        let mesh = &self.train.meshes[body.mesh];
        let Some(teeth) = &mesh.teeth else { return 0.0 };
        let (pair, gear) = (&teeth.pair, &teeth.pair.gears[body.gear]);
        let z = pair.data.wheels[body.gear].teeth;
        let power = match body.immersion {
            Some(immersion) => {
                let orbit = self.train.planets.iter().find(|p| p.member == body.member);
                // Planets run through a ring of oil that turns with their carrier.
                let spun = orbit.map_or(0.0, |p| flow.speeds[p.carrier.0].powi(2) * p.orbit_radius);
                let dip = Dip {
                    speed,
                    radius: gear.reference_radius,
                    tip_radius: gear.tip_radius,
                    root_radius: gear.root_radius,
                    width: pair.total_width(),
                    module: pair.data.module,
                    teeth: z,
                    helix: pair.data.helix,
                    pressure_angle: pair.transverse_pressure_angle,
                    immersion: immersion.min(2.0 * gear.reference_radius),
                    oil_volume: lubrication.volume.unwrap_or(1e-3),
                    kinematic_viscosity: oil.kinematic_viscosity,
                    density: oil.density,
                    gravity: spun.max(GRAVITY),
                };
                let law = laws.churning;
                self.note(beyond, ("churning", law.meta().id, &body.name), || law.outside(&dip));
                law.eval(&dip)
            }
            None => {
                // The mist of 34.25 parts of air belongs to the disc formula that was fitted with it; the
                // other laws were measured in air.
                let fitted = matches!(laws.windage, Windage::AndersonLoewenthal(_));
                let fluid = if fitted || lubrication.mist.is_some() { Fluid::Mist } else { Fluid::Air };
                let (density, viscosity) = self.fluid(fluid);
                let free = gear.reference_radius;
                let gap = self.train.housing.axial_gap.map_or(free, |g| g.min(free));
                let disc = Disc {
                    speed,
                    radius: gear.reference_radius,
                    root_radius: gear.root_radius,
                    width: pair.total_width(),
                    module: pair.data.module,
                    teeth: z,
                    density,
                    viscosity,
                    axial_gaps: [gap, gap],
                    enclosure: self.train.housing.enclosure.unwrap_or(1.0),
                };
                let law = laws.windage;
                self.note(beyond, ("windage", law.meta().id, &body.name), || law.outside(&disc));
                law.eval(&disc)
            }
        };
        torque(power, speed) * f64::from(body.count)
    }

    /// Drag of a seal, N m.
    pub(super) fn seal(&self, seal: &SealMount, flow: &Flow, beyond: &mut Option<Vec<Extrapolation>>) -> f64 {
        let speed = self.slip(flow, seal.members);
        if speed == 0.0 {
            return 0.0;
        }
        let cold = |l: &crate::train::Lubrication| match l.oil.covers(313.15) {
            true => l.oil.kinematic_viscosity(313.15),
            false => VG_100,
        };
        let lip = Lip {
            diameter: seal.diameter,
            speed,
            temperature: self.oil.as_ref().map_or(333.15, |o| o.1.temperature),
            viscosity_40: self.oil.as_ref().map_or(VG_100, |o| cold(&o.0)),
            material: seal.material,
        };
        let law = self.train.laws.seal;
        self.note(beyond, ("seal", law.meta().id, &seal.name), || law.outside(&lip));
        torque(law.eval(&lip), speed) * f64::from(seal.count)
    }

    /// Drag of a rotor, N m.
    pub(super) fn rotor(&self, rotor: &Rotor, flow: &Flow, beyond: &mut Option<Vec<Extrapolation>>) -> f64 {
        let speed = self.slip(flow, [rotor.member, FRAME]);
        if speed == 0.0 {
            return 0.0;
        }
        let (density, viscosity) = self.fluid(rotor.fluid);
        let Rotor { radius, length, radial_gap, axial_gap, .. } = *rotor;
        let drum = Drum { speed, radius, length, radial_gap, axial_gap, density, viscosity };
        let law = self.train.laws.rotor_drag;
        self.note(beyond, ("rotor_drag", law.meta().id, &rotor.name), || law.outside(&drum));
        torque(law.eval(&drum), speed)
    }
}
