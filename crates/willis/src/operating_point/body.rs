//! Gears that turn in air or oil, rotors, seals: losses that depend on speed alone.

use crate::exact::Rational;
use crate::losses::OutsideValidity;
use crate::losses::churning::ImmersedGear;
use crate::losses::clutch_drag::OpenPack;
use crate::losses::injection::JetAtMesh;
use crate::losses::pump::PumpDuty;
use crate::losses::rotor_drag::Drum;
use crate::losses::seal::SealContact;
use crate::losses::windage::{Disc, mist};
use crate::power_flow::MeshFlow;
use crate::real::{self, Real};
use crate::train::{FRAME, Fluid, JetSide, MemberId, MemberKind, OilSupply, OpenElement, Train};

use super::numbers::{RotorNumbers, VG_100};
use super::{Extrapolation, LossKind, Physics};

/// Density of air, kg/m³, and its dynamic viscosity, Pa s, at 20 °C and 1013 hPa.
const AIR: (f64, f64) = (1.204, 18.2e-6);
/// Acceleration of free fall, m/s².
const GRAVITY: f64 = 9.806_65;

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
fn torque<R: Real>(power: R, speed: R) -> R {
    let t = power / speed;
    if t.re().is_finite() { real::max(t, R::from(0.0)) } else { R::from(0.0) }
}

/// A gear in the fluid around it.
enum Wet<R> {
    ImmersedGear(ImmersedGear<R>),
    Disc(Disc<R>),
}

impl<R: Real> Physics<'_, R> {
    /// Density and viscosity of a fluid in the housing. Gears and rotors turn in one and the same
    /// mist: of the ratio that is given, else of the one with which the law of windage was measured.
    fn fluid(&self, fluid: Fluid) -> (R, R) {
        let air = (R::from(AIR.0), R::from(AIR.1));
        let Some((_, oil)) = &self.oil else { return air };
        let parts = oil.mist.or(self.train.laws.windage.air_per_oil().map(R::from));
        match (fluid, parts) {
            (Fluid::Oil, _) => (oil.density, oil.dynamic_viscosity),
            (Fluid::Mist, Some(parts)) => (mist(oil.density, AIR.0, parts), mist(oil.dynamic_viscosity, AIR.1, parts)),
            _ => air,
        }
    }

    /// State of a gear in oil or air; none at rest.
    fn wet(&self, body: &Body, speeds: &[R]) -> Option<Wet<R>> {
        let speed = self.slip(speeds, [body.member, body.against]);
        let (Some((_, oil)), true) = (&self.oil, speed.re() > 0.0) else { return None };
        let teeth = self.numbers.teeth[body.mesh].as_ref()?;
        let (pair, gear) = (&teeth.pair, &teeth.pair.gears[body.gear]);
        // Bevel gears as discs of their size at the middle of the face width.
        let size = teeth.size(body.gear);
        let z = pair.data.wheels[body.gear].teeth * teeth.cone(body.gear);
        Some(match body.immersion {
            Some(still) => {
                let immersion = teeth.immersion[body.gear].unwrap_or(R::from(still));
                let orbit = self.train.planets.iter().zip(&self.numbers.planets).find(|(p, _)| p.member == body.member);
                // Planets run through a ring of oil that turns with their carrier.
                let spun = orbit.map_or(R::from(0.0), |(p, [radius, _])| speeds[p.carrier.0].powi(2) * *radius);
                Wet::ImmersedGear(ImmersedGear {
                    speed,
                    radius: gear.reference_radius * size,
                    tip_radius: gear.tip_radius * size,
                    root_radius: gear.root_radius * size,
                    width: pair.total_width(),
                    module: pair.data.module,
                    teeth: z,
                    helix: pair.data.helix,
                    pressure_angle: pair.transverse_pressure_angle,
                    immersion: real::min(immersion, gear.reference_radius * (2.0 * size)),
                    oil_volume: oil.volume.unwrap_or(R::from(1e-3)),
                    kinematic_viscosity: oil.kinematic_viscosity,
                    density: oil.density,
                    gravity: real::max(spun, R::from(GRAVITY)),
                })
            }
            None => {
                let (density, viscosity) = self.fluid(Fluid::Mist);
                let free = gear.reference_radius * size;
                let gap = self.numbers.axial_gap.map_or(free, |g| real::min(g, free));
                Wet::Disc(Disc {
                    speed,
                    radius: gear.reference_radius * size,
                    root_radius: gear.root_radius * size,
                    width: pair.total_width(),
                    module: pair.data.module,
                    teeth: z,
                    density,
                    viscosity,
                    axial_gaps: [gap, gap],
                    enclosure: self.numbers.enclosure.unwrap_or(R::from(1.0)),
                })
            }
        })
    }

    /// Drag of a gear (all of its count), N m.
    pub(super) fn body(&self, body: &Body, speeds: &[R]) -> R {
        let (power, speed) = match self.wet(body, speeds) {
            None => return R::from(0.0),
            Some(Wet::ImmersedGear(dip)) => (self.train.laws.churning.eval(&dip), dip.speed),
            Some(Wet::Disc(disc)) => (self.train.laws.windage.eval(&disc), disc.speed),
        };
        torque(power, speed) * f64::from(body.count)
    }

    /// State of a seal; none at rest.
    fn lip(&self, k: usize, speeds: &[R]) -> Option<SealContact<R>> {
        let seal = &self.train.seals[k];
        let speed = self.slip(speeds, seal.members);
        (speed.re() != 0.0).then(|| SealContact {
            diameter: self.numbers.seals[k],
            speed,
            temperature: self.oil.as_ref().map_or(R::from(333.15), |o| o.1.temperature),
            viscosity_40: self.oil.as_ref().map_or(R::from(VG_100), |o| o.1.viscosity_40),
            material: seal.material,
        })
    }

    /// Drag of a seal, N m.
    pub(super) fn seal(&self, k: usize, speeds: &[R]) -> R {
        let Some(lip) = self.lip(k, speeds) else { return R::from(0.0) };
        torque(self.train.laws.seal.eval(&lip), lip.speed) * f64::from(self.train.seals[k].count)
    }

    /// State of a rotor; none at rest.
    fn drum(&self, k: usize, speeds: &[R]) -> Option<Drum<R>> {
        let rotor = &self.train.rotors[k];
        let speed = self.slip(speeds, [rotor.member, FRAME]);
        let (density, viscosity) = self.fluid(rotor.fluid);
        let RotorNumbers { radius, length, radial_gap, axial_gap } = self.numbers.rotors[k];
        (speed.re() != 0.0).then_some(Drum { speed, radius, length, radial_gap, axial_gap, density, viscosity })
    }

    /// A given drag at a relative speed, all of its places, N m.
    pub(super) fn drag(&self, k: usize, speed: R) -> R {
        let (drag, own) = (&self.train.drags[k], &self.numbers.drags[k]);
        let dry = own.coulomb.unwrap_or_else(|| {
            // The curve with its slope.
            let at = speed.re();
            (speed - at) * drag.torque.slope(at) + drag.torque.at(at)
        });
        dry + own.viscous * speed
    }

    /// State of an open pack; none where the element is no pack or there is no oil.
    fn pack(&self, k: usize, speeds: &[R]) -> Option<OpenPack<R>> {
        let Some(OpenElement::Pack { surfaces, inner_radius, outer_radius, gap, flow, groove_share, groove_depth }) =
            &self.numbers.open[k]
        else {
            return None;
        };
        let (_, oil) = self.oil.as_ref()?;
        Some(OpenPack {
            speeds: self.train.shift_elements[k].members.map(|m| speeds[m.0]),
            surfaces: f64::from(*surfaces),
            inner_radius: *inner_radius,
            outer_radius: *outer_radius,
            gap: *gap,
            flow: *flow,
            groove_share: *groove_share,
            groove_depth: *groove_depth,
            density: oil.density,
            viscosity: oil.dynamic_viscosity,
        })
    }

    /// Torque of a shift element that is open, N m; none where nothing is known of it.
    pub(super) fn open(&self, k: usize, speeds: &[R]) -> Option<R> {
        let slip = self.slip(speeds, self.train.shift_elements[k].members);
        let oil = self.oil.as_ref().map(|(_, oil)| oil);
        match self.numbers.open[k].as_ref()? {
            OpenElement::Pack { .. } => Some(self.train.laws.clutch_drag.eval(&self.pack(k, speeds)?)),
            // Plane shear between drum and band.
            OpenElement::Band { radius, width, wrap, gap, wetted } => {
                Some(oil?.dynamic_viscosity * slip * radius.powi(3) * *width * *wrap * *wetted / *gap)
            }
            // By the similarity of rivulets: slip goes with the root of the viscosity, the torque at it with its power 1.5.
            OpenElement::Curve(curve, temperature) => {
                let thicker = match (oil, &self.oil) {
                    (Some(oil), Some((lubrication, _))) if lubrication.beyond(*temperature).is_none() => {
                        oil.dynamic_viscosity / lubrication.oil.curves::<f64>().dynamic_viscosity(*temperature)
                    }
                    _ => R::from(1.0),
                };
                let root = thicker.sqrt();
                let at = slip / root;
                let (x, own) = (at.re(), (at - at.re()) * curve.slope(at.re()));
                Some((own + curve.at(x)) * thicker * root)
            }
            OpenElement::Torque(torque) => Some(*torque),
        }
    }

    /// The law of a shift element that is open.
    pub(super) fn open_law(&self, k: usize) -> &'static str {
        match &self.train.shift_elements[k].open {
            Some(OpenElement::Pack { .. }) => self.train.laws.clutch_drag.meta().id,
            Some(OpenElement::Band { .. }) => "full-film",
            _ => "given",
        }
    }

    /// Torque of a pump, N m.
    pub(super) fn pump(&self, k: usize, speeds: &[R]) -> R {
        let (pump, own) = (&self.train.pumps[k], &self.numbers.pumps[k]);
        let none = R::from(0.0);
        self.train.laws.pump.eval(&PumpDuty {
            speed: self.slip(speeds, [pump.member, FRAME]),
            displacement: own.displacement,
            pressure: own.pressure,
            efficiency: own.efficiency,
            viscosity: self.oil.as_ref().map_or(none, |(_, oil)| oil.dynamic_viscosity),
        })
    }

    /// Power that the oil sprayed at a mesh takes, at all of its parallel meshes, W.
    pub(super) fn jet(&self, m: &MeshFlow<R>) -> Option<R> {
        let (teeth, (_, oil)) = (self.numbers.teeth[m.mesh.0].as_ref()?, self.oil.as_ref()?);
        let jet = teeth.jet.as_ref()?;
        let power = self.train.laws.injection.eval(&JetAtMesh {
            pitch_speed: real::abs(m.relative_speeds[0]) * teeth.pair.gears[0].operating_radius,
            jet_speed: jet.speed,
            flow: jet.flow,
            density: oil.density,
            into_mesh: jet.side == JetSide::IntoMesh,
        });
        Some(power * f64::from(self.train.meshes[m.mesh.0].count))
    }

    /// Drag of a rotor, N m.
    pub(super) fn rotor(&self, k: usize, speeds: &[R]) -> R {
        let Some(drum) = self.drum(k, speeds) else { return R::from(0.0) };
        torque(self.train.laws.rotor_drag.eval(&drum), drum.speed)
    }
}

impl Physics<'_> {
    /// Where the laws of seals, gears and rotors were used outside their ranges.
    pub(super) fn wet_extrapolations(&self, speeds: &[f64], all: &mut Vec<Extrapolation>) {
        let laws = &self.train.laws;
        let mut note = |family, law, at: &str, outside: Vec<OutsideValidity>| {
            all.extend(outside.into_iter().map(|outside| Extrapolation { family, law, at: at.to_owned(), outside }));
        };
        for (k, seal) in self.train.seals.iter().enumerate() {
            if let Some(lip) = self.lip(k, speeds) {
                note("seal", laws.seal.meta().id, &seal.name, laws.seal.outside(&lip));
            }
        }
        for body in &self.bodies {
            match self.wet(body, speeds) {
                Some(Wet::ImmersedGear(dip)) => {
                    note("churning", laws.churning.meta().id, &body.name, laws.churning.outside(&dip));
                }
                Some(Wet::Disc(disc)) => {
                    note("windage", laws.windage.meta().id, &body.name, laws.windage.outside(&disc));
                }
                None => {}
            }
        }
        for (k, element) in self.train.shift_elements.iter().enumerate() {
            if let Some(pack) = self.pack(k, speeds).filter(|p| p.speeds[0] != p.speeds[1]) {
                note("clutch_drag", laws.clutch_drag.meta().id, &element.name, laws.clutch_drag.outside(&pack));
            }
        }
        for (k, rotor) in self.train.rotors.iter().enumerate() {
            if let Some(drum) = self.drum(k, speeds) {
                note("rotor_drag", laws.rotor_drag.meta().id, &rotor.name, laws.rotor_drag.outside(&drum));
            }
        }
    }
}
