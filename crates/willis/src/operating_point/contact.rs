//! A tooth contact under load: speeds, pressure, film, friction.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::geometry::Pair;
use crate::losses::film::FilmContact;
use crate::losses::film_reduction::Inlet;
use crate::losses::load_sharing::{LoadSharing, Relief, ToothLoad};
use crate::losses::loss_factor::{LossFactor, PathOfContact};
use crate::losses::mesh_friction::{MeshContact, MeshFriction};
use crate::losses::rolling::RollingContact;
use crate::losses::{OutsideValidity, Tag};
use crate::power_flow::MeshFlow;
use crate::real::{self, Real};
use crate::train::{Mesh, Teeth};

use super::{Extrapolation, OilState, Physics};

/// Lubrication of a contact by its film thickness ratio λ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
// The schema keeps the name that is published.
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Regime"))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum LubricationRegime {
    /// λ < 1: the load is carried by asperities.
    Boundary,
    /// 1 ≤ λ < 3: asperities and film share it.
    Mixed,
    /// λ ≥ 3: the film carries it.
    Full,
}

impl LubricationRegime {
    /// For people: `mixed`.
    pub fn words(self) -> &'static str {
        match self {
            Self::Boundary => "boundary",
            Self::Mixed => "mixed",
            Self::Full => "full",
        }
    }

    /// Film thickness ratios at which mixed and full lubrication begin.
    pub const LIMITS: [f64; 2] = [1.0, 3.0];

    /// The regime of a film thickness ratio.
    pub fn of(film_ratio: f64) -> Self {
        let [mixed, full] = Self::LIMITS;
        match film_ratio {
            x if x < mixed => Self::Boundary,
            x if x < full => Self::Mixed,
            _ => Self::Full,
        }
    }
}

/// A tooth contact in an operating point. Loads are the mean of the pairs in parallel, pressures and films those of the
/// pair that is loaded most (`load_sharing_factor`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ContactReport {
    /// Mean coefficient of friction; absent when the efficiency is given, or nothing is loaded.
    pub friction: Option<f64>,
    /// Loss factor `H_V`.
    pub loss_factor: f64,
    /// Transverse contact ratio `ε_α`.
    pub contact_ratio: f64,
    /// Overlap ratio `ε_β` of one helix.
    pub overlap_ratio: f64,
    /// Operating pressure angle in the transverse section, rad.
    pub operating_pressure_angle_rad: f64,
    /// Transverse circumferential backlash at the operating circles, m; 0 where the centre distance follows from the
    /// shifts.
    #[serde(default)]
    pub backlash_m: f64,
    /// Tangential force at the operating pitch circle, N.
    pub tangential_force_n: f64,
    /// Load at the base circle over the face width, N/m.
    pub line_load_n_per_m: f64,
    /// Pitch line speed relative to the carrier, m/s.
    pub pitch_line_speed_m_s: f64,
    /// Sum of the surface speeds at the pitch point, m/s.
    pub sum_speed_m_s: f64,
    /// Largest sliding speed, m/s.
    pub sliding_speed_m_s: f64,
    /// Hertzian pressure at the pitch point, Pa.
    pub pitch_pressure_pa: f64,
    /// Largest Hertzian pressure on the path of contact, Pa.
    pub pressure_pa: f64,
    /// Film thickness at the pitch point, thermal reduction included, m; absent without an oil.
    pub pitch_film_m: Option<f64>,
    /// Smallest film thickness on the path of contact, m.
    pub film_m: Option<f64>,
    /// Smallest film thickness over the composite rms roughness, `λ`.
    pub film_ratio: Option<f64>,
    /// Lubrication by `λ`.
    pub regime: Option<LubricationRegime>,
    /// Loss by sliding, all pairs in parallel, W.
    pub sliding_loss_w: f64,
    /// The part of it by sliding along the teeth of hypoid gears, W.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lengthwise_loss_w: Option<f64>,
    /// The efficiency of that sliding alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lengthwise_efficiency: Option<f64>,
    /// Loss by rolling where it is computed apart, all pairs in parallel, W.
    pub rolling_loss_w: f64,
}

/// Nodes and weights of Gauss and Legendre, 8 points on −1 to 1, one half.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// Nodes and weights of the rule of Gauss between two places; none where the second lies before the first.
fn gauss<R: Real>(from: R, to: R) -> impl Iterator<Item = (R, R)> {
    let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
    let nodes = GAUSS.into_iter().flat_map(|(node, w)| [(node, w), (-node, w)]);
    nodes.filter(move |_| half.re() > 0.0).map(move |(node, w)| (middle + half * node, half * w))
}

/// Most tooth pairs in contact whose exchange is looked at.
const MOST_PAIRS: usize = 5;

/// rms over arithmetic mean roughness of a ground flank.
const RMS: f64 = 1.25;
/// Peak-to-valley height over arithmetic mean roughness of a ground flank.
const PEAK: f64 = 6.0;

/// One point of the path of contact.
#[derive(Clone, Copy)]
struct Point<R> {
    line_load: R,
    /// Speed of sliding, and what of it is along the profiles.
    sliding: R,
    profile: R,
    sum: R,
    radius: R,
    pressure: R,
}

/// One place of the path of contact of one pair in parallel, as the laws see it.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// Distance from C, m.
    pub s: f64,
    /// Load per length of contact line, N/m.
    pub line_load: f64,
    /// Sliding speed, m/s.
    pub sliding: f64,
    /// Sum of the surface speeds, m/s.
    pub sum: f64,
    /// Hertzian pressure, Pa.
    pub pressure: f64,
    /// Film thickness, m; none without load or oil.
    pub film: Option<f64>,
    /// Film thickness over the composite roughness; none without roughness either.
    pub film_ratio: Option<f64>,
    /// Coefficient of friction.
    pub friction: Option<f64>,
    /// The power that the tooth pair here turns into heat, W.
    pub loss: Option<f64>,
}

/// The path of contact of a mesh.
pub(crate) struct Along {
    /// From A to E, on both sides of every jump of the load.
    pub stations: Vec<Station>,
    /// Sliding loss of all pairs in parallel, W: the local loss integrated by the rule that averages friction.
    pub loss: Option<f64>,
    /// Whether the law of friction gives a value for each place.
    pub local: bool,
}

/// What the laws give for the teeth of a mesh.
pub(super) struct Tooth<R> {
    /// Mean coefficient of friction; none when the efficiency is given, or nothing is loaded.
    pub friction: Option<R>,
    pub loss_factor: R,
    /// Rolling loss of all pairs in parallel, W.
    pub rolling: R,
}

/// A place of the path of contact: what follows from the geometry alone.
#[derive(Clone, Copy, Debug)]
struct Place<R> {
    /// From A, in base pitches.
    position: R,
    /// Part of the load of the mesh that a tooth pair carries here, without tip relief.
    share: R,
    /// Reduced radius of curvature, m.
    radius: R,
    /// Sliding speed, and the sum of the surface speeds, over the speed of the first gear relative to the carrier, m.
    sliding: R,
    sum: R,
}

/// What [`Fixed`] follows from: the teeth, and the laws that are looked at along them.
#[derive(Clone, Debug, PartialEq)]
struct Origin<R> {
    pair: Pair<R>,
    relief: Option<[R; 2]>,
    loss_factor: LossFactor,
    load_sharing: LoadSharing,
    /// Whether friction is averaged along the path, and the loss by rolling.
    averaged: [bool; 2],
}

/// What of a mesh follows from its geometry alone; worked out once.
#[derive(Clone, Debug)]
pub(super) struct Fixed<R> {
    origin: Origin<R>,
    loss_factor: R,
    pitch: Place<R>,
    /// Sine of the operating pressure angle; radii of curvature at the pitch point, m; shortest length of the lines of contact
    /// over the face width.
    sine: R,
    radius_transverse: R,
    radius: R,
    contact_length_ratio: R,
    /// Where friction that differs from place to place is averaged, with weights; empty for other laws.
    friction: Vec<(Place<R>, R)>,
    /// Where the rolling loss is averaged, with weights whose sum is one; empty without such a law.
    rolling: Vec<(Place<R>, R)>,
    /// The ends of each part of the path with as many tooth pairs, just inside.
    ends: Vec<Place<R>>,
    /// Seven tenths of the way from C to the end and to the start.
    flanks: [Place<R>; 2],
}

/// One mesh at one load.
struct Loaded<'a, R: Real> {
    physics: &'a Physics<'a, R>,
    teeth: &'a Teeth<R>,
    fixed: &'a Fixed<R>,
    /// Torque of the driving gear of one pair in parallel, N m, and what follows from it at the base circle, N.
    torque: R,
    base_force: R,
    /// Normal force of one pair in parallel, N.
    normal_force: R,
    /// Speed at the operating pitch circle relative to the carrier, m/s.
    pitch_line_speed: R,
    /// Speed of the first gear relative to the carrier, ≥ 0, rad/s.
    speed: R,
    /// Speed of hypoid teeth along each other, m/s.
    along: Option<R>,
    /// Tip relief under this load.
    relief: Relief<R>,
}

impl<R: Real> Loaded<'_, R> {
    /// Whether the teeth are pressed together and move.
    fn works(&self) -> bool {
        self.base_force.re() > 0.0 && self.pitch_line_speed.re() > 0.0
    }

    fn point(&self, s: R) -> Point<R> {
        self.at(&self.physics.place(&self.teeth.pair, s))
    }

    /// Load per length of contact line, N/m, and Hertzian pressure, Pa.
    fn pressed(&self, place: &Place<R>) -> [R; 2] {
        let pair = &self.teeth.pair;
        let share = match self.relief.any() {
            true => self.physics.tooth_share(pair, place.position, self.relief),
            false => place.share,
        };
        let line_load = share * self.normal_force * pair.cos_base_helix() / pair.total_width();
        let modulus = self.teeth.reduced_modulus();
        [line_load, root(line_load * modulus / (place.radius * std::f64::consts::TAU))]
    }

    fn at(&self, place: &Place<R>) -> Point<R> {
        let [line_load, pressure] = self.pressed(place);
        let radius = place.radius;
        let [profile, sum] = [place.sliding, place.sum].map(|per_speed| per_speed * self.speed);
        let sliding = self.along.map_or(profile, |along| root(profile * profile + along * along));
        Point { line_load, sliding, profile, sum, radius, pressure }
    }

    /// The film there, m; zero without a load, a speed or an oil.
    fn film(&self, p: &Point<R>) -> R {
        let Some((_, oil)) = &self.physics.oil else { return R::from(0.0) };
        if p.line_load.re() <= 0.0 || p.sum.re() <= 0.0 {
            return R::from(0.0);
        }
        let laws = &self.physics.train.laws;
        laws.film.eval(&self.film_contact(oil, p)) * laws.film_reduction.eval(&self.inlet(oil, p))
    }

    /// The film for the law of friction: most read none, and it costs more than all else at a point.
    fn film_read(&self, p: &Point<R>) -> R {
        match self.physics.friction.meta().tags.contains(&Tag::Film) {
            true => self.film(p),
            false => R::from(0.0),
        }
    }

    /// The loss factor under this load.
    fn loss_factor(&self, fixed: &Fixed<R>) -> R {
        match self.relief.any() {
            true => self.physics.train.laws.loss_factor(&self.physics.friction).eval(&self.path()),
            false => fixed.loss_factor,
        }
    }

    /// The path of contact with the relief under this load.
    fn path(&self) -> PathOfContact<R> {
        PathOfContact { relief: self.relief, ..PathOfContact::of(&self.teeth.pair) }
    }

    fn inlet(&self, oil: &OilState<R>, p: &Point<R>) -> Inlet<R> {
        let Point { sliding, sum, pressure, .. } = *p;
        Inlet {
            dynamic_viscosity: oil.dynamic_viscosity,
            viscosity_slope: oil.viscosity_slope,
            mean_speed: sum / 2.0,
            slide_ratio: if sum.re() > 0.0 { sliding * 2.0 / sum } else { R::from(0.0) },
            conductivity: oil.conductivity,
            hertz_pressure: pressure,
            reduced_modulus: self.teeth.reduced_modulus(),
        }
    }

    fn rolling_contact(&self, oil: &OilState<R>, p: &Point<R>) -> RollingContact<R> {
        let pair = &self.teeth.pair;
        RollingContact {
            sum_speed: p.sum,
            radius: p.radius,
            normal_force: self.normal_force / pair.contact_ratio,
            length: pair.total_width() / pair.cos_base_helix(),
            dynamic_viscosity: oil.dynamic_viscosity,
            pressure_viscosity: oil.pressure_viscosity,
            reduced_modulus: self.teeth.reduced_modulus(),
            film_reduction: self.physics.train.laws.film_reduction.eval(&self.inlet(oil, p)),
        }
    }

    fn film_contact(&self, oil: &OilState<R>, p: &Point<R>) -> FilmContact<R> {
        FilmContact {
            radius: p.radius,
            mean_speed: p.sum / 2.0,
            line_load: p.line_load,
            dynamic_viscosity: oil.dynamic_viscosity,
            pressure_viscosity: oil.pressure_viscosity,
            reduced_modulus: self.teeth.reduced_modulus(),
        }
    }
}

/// Places between which loads and speeds are smooth: C, whole base pitches from both ends, and those from where tip relief
/// ends.
type Breaks<R> = [R; 4 * MOST_PAIRS + 1];

fn breaks<R: Real>(teeth: &Teeth<R>) -> Breaks<R> {
    let pair = &teeth.pair;
    let [start, end] = pair.path();
    let mut breaks = [R::from(0.0); 4 * MOST_PAIRS + 1];
    let lengths = teeth.relief.map_or([R::from(0.0); 2], |relief| relief.length);
    for k in 0..MOST_PAIRS {
        breaks[2 * k] = real::min(pair.base_pitch * k as f64 + start, end);
        breaks[2 * k + 1] = real::max(-(pair.base_pitch * k as f64) + end, start);
        let [first, second] = lengths.map(|l| pair.base_pitch * k as f64 + l);
        breaks[2 * (MOST_PAIRS + k) + 1] = real::min(second + start, end);
        breaks[2 * (MOST_PAIRS + k) + 2] = real::max(-first + end, start);
    }
    breaks.sort_by(|a, b| a.re().total_cmp(&b.re()));
    breaks
}

/// The parts of the path of contact between those, within its ends.
fn parts<R: Real>(teeth: &Teeth<R>) -> impl Iterator<Item = [R; 2]> {
    let ([start, end], breaks) = (teeth.pair.path(), breaks(teeth));
    (0..breaks.len() - 1).map(move |k| [real::max(breaks[k], start), real::min(breaks[k + 1], end)])
}

/// Rms roughness of both flanks together.
fn composite<R: Real>(teeth: &Teeth<R>) -> R {
    root(teeth.roughness[0].powi(2) + teeth.roughness[1].powi(2)) * RMS
}

/// The square root of a number ≥ 0, without a slope at 0.
fn root<R: Real>(x: R) -> R {
    if x.re() == 0.0 { R::from(0.0) } else { x.sqrt() }
}

impl<R: Real> Physics<'_, R> {
    /// The mean of the pairs in parallel.
    fn loaded<'a>(&'a self, mesh: &Mesh, teeth: &'a Teeth<R>, flow: &MeshFlow<R>) -> Loaded<'a, R> {
        self.loaded_by(1.0, mesh, teeth, flow)
    }

    /// A pair that bears so many times the mean of those in parallel.
    fn loaded_by<'a>(&'a self, times: f64, mesh: &Mesh, teeth: &'a Teeth<R>, flow: &MeshFlow<R>) -> Loaded<'a, R> {
        let pair = &teeth.pair;
        let driver = flow.driver.unwrap_or(0);
        // Of bevel gears those of the virtual pair, which turns more slowly: the power is the same.
        let torque = real::abs(flow.torques[driver]) / (f64::from(mesh.count) * teeth.cone(driver)) * times;
        let base_force = torque / pair.gears[driver].base_radius;
        let speed = real::abs(flow.relative_speeds[0]) * teeth.cone(0);
        Loaded {
            physics: self,
            teeth,
            fixed: self.fixed(teeth, flow),
            torque,
            base_force,
            normal_force: base_force / pair.cos_base_helix(),
            pitch_line_speed: real::abs(flow.relative_speeds[driver])
                * teeth.cone(driver)
                * pair.gears[driver].operating_radius,
            speed,
            along: teeth.hypoid.as_ref().map(|_| teeth.lengthwise_per_speed() * speed),
            relief: teeth.relief(base_force),
        }
    }

    /// What of a mesh follows from its geometry alone: integrals over the path of contact among it, worked out once.
    fn fixed(&self, teeth: &Teeth<R>, flow: &MeshFlow<R>) -> &Fixed<R> {
        self.fixed[flow.mesh.0].get_or_init(|| {
            let origin = self.origin(teeth);
            let [local, rolling] = origin.averaged;
            let pair = &teeth.pair;
            let none = R::from(0.0);
            let [start, end] = pair.path();
            let place = |(s, w): (R, R)| (self.place(pair, s), w);
            // Away from the pitch point sliding heats the inlet and thins the film, on both sides alike, so the film has a
            // kink there.
            let pitch = real::min(real::max(none, start), end);
            let both = gauss(start, pitch).chain(gauss(pitch, end)).map(|(s, w)| (s, w / (end - start)));
            let inside = |[from, to]: [R; 2]| [from + (to - from) * 1e-9, to - (to - from) * 1e-9];
            let ends = parts(teeth).filter(|[from, to]| to.re() > from.re()).flat_map(inside);
            let loss_factor = origin.loss_factor.eval(&PathOfContact::of(pair));
            Arc::new(Fixed {
                origin,
                loss_factor,
                pitch: self.place(pair, none),
                sine: pair.operating_pressure_angle.sin(),
                radius_transverse: pair.reduced_radius_transverse(none),
                radius: pair.reduced_radius(none),
                contact_length_ratio: pair.shortest_contact_length_ratio(),
                friction: parts(teeth).flat_map(|[from, to]| gauss(from, to)).map(place).filter(|_| local).collect(),
                rolling: both.map(place).filter(|_| rolling).collect(),
                ends: ends.map(|s| self.place(pair, s)).collect(),
                flanks: [end, start].map(|s| self.place(pair, s * 0.7)),
            })
        })
    }

    fn origin(&self, teeth: &Teeth<R>) -> Origin<R> {
        Origin {
            pair: teeth.pair.clone(),
            relief: teeth.relief.map(|relief| relief.length),
            loss_factor: self.train.laws.loss_factor(&self.friction),
            load_sharing: self.train.laws.load_sharing,
            averaged: [self.friction.meta().tags.contains(&Tag::Local), self.rolling.is_some()],
        }
    }

    /// The share of a tooth pair in the load of its mesh.
    fn tooth_share(&self, pair: &Pair<R>, position: R, relief: Relief<R>) -> R {
        let (contact_ratio, overlap_ratio) = (pair.contact_ratio, pair.overlap_ratio);
        self.train.laws.load_sharing.eval(&ToothLoad { position, contact_ratio, overlap_ratio, relief })
    }

    fn place(&self, pair: &Pair<R>, s: R) -> Place<R> {
        let position = pair.position(s);
        Place {
            position,
            share: self.tooth_share(pair, position, Relief::none()),
            radius: real::max(pair.reduced_radius(s), R::from(1e-9)),
            sliding: pair.sliding_per_speed(s),
            sum: pair.sum_speed_per_speed(s),
        }
    }

    /// Friction and rolling loss of a mesh.
    pub(super) fn tooth(&self, mesh: &Mesh, teeth: &Teeth<R>, flow: &MeshFlow<R>) -> Tooth<R> {
        let fixed = self.fixed(teeth, flow);
        let loaded = self.loaded(mesh, teeth, flow);
        let loss_factor = loaded.loss_factor(fixed);
        let none = R::from(0.0);
        let mut tooth = Tooth { friction: None, loss_factor, rolling: none };
        if !loaded.works() || !mesh.computed {
            return tooth;
        }
        let p = loaded.at(&fixed.pitch);
        let pitch = self.state(mesh, &loaded, loss_factor).at(&p, loaded.film_read(&p));
        let mu = if self.friction.meta().tags.contains(&Tag::Local) {
            let (mut friction, mut weight) = (none, none);
            for (place, w) in &fixed.friction {
                let p = loaded.at(place);
                let own = *w * p.line_load * p.sliding;
                weight += own;
                friction += own * self.coefficient(&pitch.at(&p, loaded.film_read(&p)));
            }
            if weight.re() > 0.0 { friction / weight } else { none }
        } else {
            self.coefficient(&pitch)
        };
        if mu.re().is_finite() {
            tooth.friction = Some(real::max(mu, none));
        }

        if let (Some(law), Some((_, oil))) = (&self.rolling, &self.oil) {
            let rolling = fixed
                .rolling
                .iter()
                .fold(none, |sum, (place, w)| sum + law.eval(&loaded.rolling_contact(oil, &loaded.at(place))) * *w);
            let rolling = rolling * teeth.pair.contact_ratio * f64::from(mesh.count);
            tooth.rolling = if rolling.re().is_finite() { real::max(rolling, none) } else { none };
        }
        tooth
    }

    /// The coefficient of friction that the law in force gives.
    fn coefficient(&self, state: &MeshContact<R>) -> R {
        match self.friction {
            MeshFriction::Constant(_) => self.numbers.friction_coefficient,
            law => law.eval(state),
        }
    }

    /// What is the same all along the path; the rest is zero.
    fn state(&self, mesh: &Mesh, loaded: &Loaded<'_, R>, loss_factor: R) -> MeshContact<R> {
        let Loaded { teeth, fixed, base_force, normal_force, pitch_line_speed, .. } = *loaded;
        let pair = &teeth.pair;
        // The smaller wheel first.
        let small = usize::from(pair.data.wheels[1].teeth < pair.data.wheels[0].teeth);
        let teeth_of = |k: usize| pair.data.wheels[k].teeth;
        let (z_1, z_2) = (teeth_of(small), teeth_of(1 - small));
        let sum = if pair.internal() { z_2 - z_1 } else { z_2 + z_1 };
        let pinion = &pair.gears[small];
        let tangential = base_force * pinion.base_radius / pinion.operating_radius;
        let width = pair.total_width();
        // Laws that read the oil are in force only where there is one.
        let oil = |get: fn(&OilState<R>) -> R| self.oil.as_ref().map_or(R::from(f64::NAN), |o| get(&o.1));
        let zero = R::from(0.0);
        MeshContact {
            line_load: base_force / width,
            normal_force,
            pitch_sum_speed: pitch_line_speed * 2.0 * fixed.sine,
            pitch_line_speed,
            pitch_radius_transverse: fixed.radius_transverse,
            pitch_radius: fixed.radius,
            local_line_load: zero,
            sliding_speed: zero,
            sum_speed: zero,
            radius: zero,
            hertz_pressure: zero,
            film: zero,
            film_ratio: zero,
            dynamic_viscosity: oil(|o| o.dynamic_viscosity),
            kinematic_viscosity: oil(|o| o.kinematic_viscosity),
            pressure_viscosity: oil(|o| o.pressure_viscosity),
            roughness: (teeth.roughness[0] + teeth.roughness[1]) / 2.0,
            composite_roughness: composite(teeth),
            peak_roughness: (teeth.roughness[0] + teeth.roughness[1]) * PEAK,
            base: self.oil.as_ref().map_or(crate::catalogue::oil::Base::Mineral, |o| o.0.oil.base),
            lubricant_factor: self.oil.as_ref().and_then(|o| o.1.lubricant_factor),
            k_factor: tangential / (width * 2.0 * pinion.operating_radius) * sum / z_2,
            teeth: [z_1, z_2],
            internal: pair.internal(),
            normal_pressure_angle: pair.data.pressure_angle,
            helix: pair.operating_helix,
            pinion_diameter: pinion.reference_radius * 2.0,
            width,
            contact_length_ratio: fixed.contact_length_ratio,
            loss_factor,
            parallel: f64::from(mesh.count),
        }
    }
}

impl<R: Real> MeshContact<R> {
    /// The same at a point of the path, with the film there.
    fn at(self, p: &Point<R>, film: R) -> Self {
        let rough = self.composite_roughness;
        Self {
            local_line_load: p.line_load,
            sliding_speed: p.sliding,
            sum_speed: p.sum,
            radius: p.radius,
            hertz_pressure: p.pressure,
            film,
            film_ratio: if rough.re() > 0.0 { film / rough } else { R::from(f64::INFINITY) },
            ..self
        }
    }
}

/// What was worked out along the teeth of trains before, by mesh.
#[derive(Debug, Default)]
pub(crate) struct KnownPaths(Vec<Vec<Arc<Fixed<f64>>>>);

/// Most paths that are kept of a mesh, the last ones: about as many as laws of friction may ask for with the same teeth.
const MOST_PATHS: usize = 16;

impl KnownPaths {
    /// Keeps those of a train.
    pub fn keep(&mut self, physics: &Physics<'_>) {
        self.0.resize(self.0.len().max(physics.fixed.len()), vec![]);
        for (known, own) in self.0.iter_mut().zip(&physics.fixed) {
            let Some(own) = own.get() else { continue };
            if known.iter().any(|old| Arc::ptr_eq(old, own) || old.origin == own.origin) {
                continue;
            }
            if known.len() == MOST_PATHS {
                known.remove(0);
            }
            known.push(own.clone());
        }
    }

    /// Gives a train those that follow from the same teeth and laws as its own.
    pub fn give(&self, physics: &Physics<'_>) {
        for ((known, own), teeth) in self.0.iter().zip(&physics.fixed).zip(&physics.numbers.teeth) {
            let Some(teeth) = teeth.as_ref().filter(|_| !known.is_empty()) else { continue };
            let origin = physics.origin(teeth);
            if let Some(same) = known.iter().find(|old| old.origin == origin) {
                // One that is there already is the same.
                let _ = own.set(same.clone());
            }
        }
    }
}

impl Physics<'_> {
    /// The path of contact of a loaded mesh, `steps` places in each part of it; none when it is idle.
    pub(crate) fn along(&self, mesh: &Mesh, teeth: &Teeth, flow: &MeshFlow, steps: usize) -> Option<Along> {
        let pair = &teeth.pair;
        let loaded = self.loaded(mesh, teeth, flow);
        if !loaded.works() {
            return None;
        }
        let loss_factor = loaded.loss_factor(self.fixed(teeth, flow));
        let hardest = self.loaded_by(mesh.sharing(), mesh, teeth, flow);
        let local = self.friction.meta().tags.contains(&Tag::Local);
        let mean = self.tooth(mesh, teeth, flow).friction;
        let composite = composite(teeth);
        let state = self.state(mesh, &loaded, loss_factor);
        let station = |s: f64| {
            let p = loaded.point(s);
            let friction = match (mesh.computed, local) {
                (false, _) => None,
                (true, false) => mean,
                // Where nothing slides or presses a law may have no value; nothing is lost there.
                (true, true) => Some(self.coefficient(&state.at(&p, loaded.film_read(&p)))),
            };
            let friction = friction.filter(|mu| mu.is_finite());
            // Normal force of the pair here: line load times the length of its lines of contact.
            let force = p.line_load * pair.total_width() / pair.base_helix.cos();
            let hard = hardest.point(s);
            let film = hardest.film(&hard);
            let film = (self.oil.is_some() && film > 0.0 && film.is_finite()).then_some(film);
            Station {
                s,
                line_load: p.line_load,
                sliding: p.sliding,
                sum: p.sum,
                pressure: hard.pressure,
                film,
                film_ratio: film.filter(|_| composite > 0.0).map(|h| h / composite),
                friction,
                // Along hypoid teeth as if alone, as in the whole.
                loss: friction.map(|mu| mu * force * (p.profile + loaded.along.unwrap_or(0.0))),
            }
        };
        let [start, end] = pair.path();
        let (mut stations, mut work) = (Vec::new(), 0.0);
        for [from, to] in parts(teeth) {
            if to - from <= 1e-9 * (end - start) {
                continue;
            }
            // Just inside, so that a jump of the load has a value on either side.
            let (from, to) = (from + 1e-9 * (to - from), to - 1e-9 * (to - from));
            stations.extend((0..=steps).map(|i| station(from + (to - from) * i as f64 / steps as f64)));
            work += gauss(from, to).map(|(s, w)| w * station(s).loss.unwrap_or(0.0)).sum::<f64>();
        }
        let loss = mesh.computed.then(|| work / pair.base_pitch * f64::from(mesh.count));
        Some(Along { stations, loss, local })
    }

    /// The largest Hertzian pressure on the path of contact of a mesh, Pa.
    pub(super) fn largest_pressure(&self, mesh: &Mesh, teeth: &Teeth, flow: &MeshFlow) -> f64 {
        let fixed = self.fixed(teeth, flow);
        let hardest = self.loaded_by(mesh.sharing(), mesh, teeth, flow);
        let places = fixed.ends.iter().chain([&fixed.pitch]);
        places.map(|place| hardest.pressed(place)[1]).fold(f64::NAN, f64::max)
    }

    /// The contact of a mesh.
    pub(super) fn contact(&self, mesh: &Mesh, teeth: &Teeth, flow: &MeshFlow) -> ContactReport {
        let pair = &teeth.pair;
        let fixed = self.fixed(teeth, flow);
        let loaded = self.loaded(mesh, teeth, flow);
        let loss_factor = loaded.loss_factor(fixed);
        let driver = flow.driver.unwrap_or(0);
        let pitch = loaded.at(&fixed.pitch);
        let hardest = self.loaded_by(mesh.sharing(), mesh, teeth, flow);
        let hard = hardest.at(&fixed.pitch);

        // Extremes: at the ends of each part of the path, just inside.
        let hard_film = hardest.film(&hard);
        let (mut worst, mut worst_film) = (hard, f64::INFINITY);
        for place in &fixed.ends {
            let p = hardest.at(place);
            worst.pressure = worst.pressure.max(p.pressure);
            worst.sliding = worst.sliding.max(p.sliding);
            worst_film = worst_film.min(hardest.film(&p));
        }
        let film = self.oil.is_some().then_some(if worst_film.is_finite() { worst_film } else { hard_film });
        let composite = composite(teeth);
        let film_ratio = film.filter(|_| composite > 0.0 && loaded.base_force > 0.0).map(|h| h / composite);

        ContactReport {
            friction: None,
            loss_factor,
            contact_ratio: pair.contact_ratio,
            overlap_ratio: pair.overlap_ratio,
            operating_pressure_angle_rad: pair.operating_pressure_angle,
            backlash_m: pair.backlash,
            tangential_force_n: loaded.torque / pair.gears[driver].operating_radius,
            line_load_n_per_m: loaded.base_force / pair.total_width(),
            pitch_line_speed_m_s: loaded.pitch_line_speed,
            sum_speed_m_s: pitch.sum,
            sliding_speed_m_s: worst.sliding,
            pitch_pressure_pa: hard.pressure,
            pressure_pa: worst.pressure,
            pitch_film_m: film.map(|_| hard_film),
            film_m: film,
            film_ratio,
            regime: film_ratio.map(LubricationRegime::of),
            sliding_loss_w: 0.0,
            lengthwise_loss_w: None,
            lengthwise_efficiency: None,
            rolling_loss_w: 0.0,
        }
    }

    /// Where the laws of a contact are used outside their ranges.
    pub(super) fn contact_extrapolations(
        &self,
        mesh: &Mesh,
        teeth: &Teeth,
        flow: &MeshFlow,
        all: &mut Vec<Extrapolation>,
    ) {
        if !mesh.computed {
            return;
        }
        let pair = &teeth.pair;
        let laws = &self.train.laws;
        let fixed = self.fixed(teeth, flow);
        let loaded = self.loaded(mesh, teeth, flow);
        let mut note = |family, law, outside: Vec<OutsideValidity>| {
            all.extend(outside.into_iter().map(|outside| Extrapolation {
                family,
                law,
                at: mesh.name.clone(),
                outside,
            }));
        };
        let factor = laws.loss_factor(&self.friction);
        note("loss_factor", factor.meta().id, factor.outside(&loaded.path()));
        let place = ToothLoad {
            position: pair.position(0.0),
            contact_ratio: pair.contact_ratio,
            overlap_ratio: pair.overlap_ratio,
            relief: loaded.relief,
        };
        note("load_sharing", laws.load_sharing.meta().id, laws.load_sharing.outside(&place));
        if !loaded.works() {
            return;
        }
        let pitch = loaded.at(&fixed.pitch);
        if let Some((_, oil)) = &self.oil {
            note("film", laws.film.meta().id, laws.film.outside(&loaded.film_contact(oil, &pitch)));
            let reduction = laws.film_reduction;
            note("film_reduction", reduction.meta().id, reduction.outside(&loaded.inlet(oil, &pitch)));
        }
        let anywhere = self.state(mesh, &loaded, loaded.loss_factor(fixed));
        let state = |p: &Point<f64>| anywhere.at(p, loaded.film_read(p));
        let outside = match self.friction.meta().tags.contains(&Tag::Local) {
            false => self.friction.outside(&state(&pitch)),
            // Away from the pitch point, where it slides.
            true => {
                let [receding, approaching] = fixed.flanks.map(|place| state(&loaded.at(&place)));
                let mut outside = self.friction.outside(&receding);
                outside.extend(self.friction.outside(&approaching));
                outside.dedup_by_key(|o| o.symbol);
                outside.sort_by_key(|o| o.symbol);
                outside.dedup_by_key(|o| o.symbol);
                outside
            }
        };
        note("mesh_friction", self.friction.meta().id, outside);
        if let (Some(law), Some((_, oil))) = (&self.rolling, &self.oil) {
            note("rolling", law.meta().id, law.outside(&loaded.rolling_contact(oil, &pitch)));
        }
    }
}
