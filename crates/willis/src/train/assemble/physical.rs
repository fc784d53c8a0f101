//! Checks the physical layer: teeth that exist, an oil with a viscosity, bearings that fit.

use crate::catalogue::bearing::{self, Bearing};
use crate::catalogue::oil::{self, Base, Oil};
use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::geometry::hypoid::Hypoid;
use crate::geometry::{Pair, PairData, Tip, Wheel};
use crate::losses::loss_factor::PathOfContact;
use crate::losses::seal::Material;
use crate::train::assembler::Assembler;
use crate::train::physical::{
    BEVEL_WIDTH, BearingMount, Jet, Known, LossFactors, LossPart, Lubrication, OpenElement, PlanetBody, Pump, Rotor,
    SealMount, Teeth, TipRelief, steel_mass,
};
use crate::train::specification::{
    Fluid, JetSide, LawsSpec, MeshStiffness, PlainBearing, PlainGeometry, PlainHousing, PlainLossFactor, PlainLosses,
    PlainOil, PlainOpen, PlainPump, PlainRotor, PlainSeal, PlainTooth,
};
use crate::train::words::{clip, list};
use crate::train::{Efficiency, FRAME, MemberId, MemberKind, MeshId, ShiftElement};

/// Assumed roughness `Ra` of ground flanks, m.
const ROUGHNESS: f64 = 0.4e-6;
/// Assumed operating temperature, K.
const TEMPERATURE: f64 = 333.15;
/// Temperature at which oils are classed, K.
const COLD: f64 = 313.15;
/// Assumed clearance of plain bearings, over the bore.
const CLEARANCE: f64 = 1.5e-3;
/// Assumed oil temperature of measured curves of drag, K.
const CURVE_TEMPERATURE: f64 = 353.15;
/// Assumed oil through one gap of an open pack, m³/s: 0.1 l/min (0.05 to 0.3 in automatic transmissions).
const PACK_FLOW: f64 = 1e-4 / 60.0;

/// Operating pressure angles of teeth in use, rad: 12 to 40 degrees.
const USUAL_ANGLES: std::ops::RangeInclusive<f64> = 0.209..=0.699;
/// Backlash beyond which shifts and centre distance do not belong together, in modules.
const USUAL_BACKLASH: f64 = 0.5;
/// Largest spiral angle, rad: 80 degrees.
const MOST_SPIRAL: f64 = 1.397;
/// How far a given offset may be from the one that follows from the spiral angles: what rounded angles and other cones make of it.
const OFFSET: f64 = 0.1;

/// Pitch cones of bevel or hypoid gears, as the virtual pair sees them.
struct Cones {
    /// How many times as fast the virtual gears turn.
    factors: [f64; 2],
    helix: f64,
    hypoid: Option<Hypoid>,
}

/// The gear with more teeth: face widths of hypoid pairs are that gear's.
fn wheel_of(gears: [(f64, bool, &PlainTooth); 2]) -> usize {
    usize::from(gears[1].0 >= gears[0].0)
}

/// Whether operating angle and backlash are those of teeth in use.
fn usual(pair: &Pair) -> bool {
    USUAL_ANGLES.contains(&pair.operating_pressure_angle) && pair.backlash.abs() <= USUAL_BACKLASH * pair.data.module
}

/// The mean stiffness of a mesh over its width as far as it is given, N/m for each m.
fn given_stiffness(g: &PlainGeometry, pair: &Pair) -> Option<f64> {
    match pair.data.wheels.iter().any(|w| w.internal) {
        true => g.internal_mesh_stiffness,
        false => g.external_mesh_stiffness,
    }
}

impl Assembler<'_> {
    /// A number that must be finite and above (or at) zero; reported and replaced where it is not.
    pub fn positive(&mut self, value: f64, zero_too: bool, what: &str, unit: &str, place: &str) -> bool {
        let good = value.is_finite() && (value > 0.0 || zero_too && value == 0.0);
        if !good {
            let bound = if zero_too { "not negative" } else { "above zero" };
            // As it was written, before it was turned into SI.
            let shown = if (value * 1e9).is_finite() { (value * 1e9).round() / 1e9 } else { value };
            let message = format!("{what} of {shown} {unit}: it is a finite number, {bound}").replace(" :", ":");
            self.report_once(Diagnostic::new(Code::OutOfRange, place, message));
        }
        good
    }

    /// Reports what several meshes of a set share only once.
    fn report_once(&mut self, d: Diagnostic) {
        if !self.diagnostics.iter().rev().take(16).any(|e| *e == d) {
            self.report(d);
        }
    }

    /// The involute pair of two gears, each with tooth count, whether internal, and teeth.
    pub fn tooth_pair(
        &mut self,
        g: &PlainGeometry,
        gears: [(f64, bool, &PlainTooth); 2],
        bevel: bool,
        title: &str,
        place: &str,
    ) -> Option<Teeth> {
        let at = format!("{place}.geometry");
        for (_, _, t) in gears.iter().filter(|_| !bevel) {
            if t.spiral_angle.is_some() {
                let message = format!("{}: a spiral angle, but the gears are cylindrical", clip(title));
                let d = Diagnostic::new(Code::Conflict, place, message);
                self.report_once(d.hint("give `helix` in the geometry, or make it a bevel pair"));
                return None;
            }
        }
        if g.offset.is_some() && !bevel {
            let message = format!("{}: an offset, but the axes of cylindrical gears are parallel", clip(title));
            let d = Diagnostic::new(Code::Conflict, format!("{at}.offset"), message);
            self.report_once(d.hint("give `centre_distance`, or make it a bevel pair"));
            return None;
        }
        let (cones, helix, hypoid) = match (bevel, g.shaft_angle) {
            (true, _) => {
                let own = self.cones(g, gears, title, place)?;
                (Some(own.factors), own.helix, own.hypoid)
            }
            (false, Some(_)) => {
                let message = format!("{}: a shaft angle, but the axes of cylindrical gears are parallel", clip(title));
                let d = Diagnostic::new(Code::Conflict, format!("{at}.shaft_angle"), message);
                self.report_once(d.hint("leave it out, or make it a bevel pair"));
                return None;
            }
            (false, None) => (None, g.helix(), None),
        };
        let mut good = true;
        for (value, zero, what, unit, key) in [
            (g.module * 1e3, false, "a module", "mm", "module"),
            (g.jet_flow.unwrap_or(1.0), false, "a flow", "m³/s", "jet_flow"),
            (g.jet_speed.unwrap_or(0.0), true, "a speed", "m/s", "jet_speed"),
            (g.width * 1e3, false, "a face width", "mm", "width"),
            (g.youngs_modulus() / 1e9, false, "a modulus", "GPa", "youngs_modulus"),
            (g.roughness.unwrap_or(0.0) * 1e6, true, "a roughness", "µm", "roughness"),
            (
                g.external_mesh_stiffness.unwrap_or(1e9) / 1e9,
                false,
                "a stiffness",
                "N/(mm µm)",
                "external_mesh_stiffness",
            ),
            (
                g.internal_mesh_stiffness.unwrap_or(1e9) / 1e9,
                false,
                "a stiffness",
                "N/(mm µm)",
                "internal_mesh_stiffness",
            ),
        ] {
            good &= self.positive(value, zero, what, unit, &format!("{at}.{key}"));
        }
        if let Some(k) = g.load_sharing_factor.filter(|k| !(1.0..=10.0).contains(k)) {
            let message =
                format!("a load sharing factor of {k}: the planet that is loaded most bears 1 to 10 times the mean");
            let d = Diagnostic::new(Code::OutOfRange, format!("{at}.load_sharing_factor"), message);
            self.report_once(
                d.hint("1 to 1.4 is usual; ABS takes 1 up to three planets, 1.2 for four, 1.3 for five, 1.4 for more"),
            );
            good = false;
        }
        if !(0.0..0.5).contains(&g.poisson_ratio()) {
            let message = format!("a Poisson's ratio of {}: it lies from 0 to below 0.5", g.poisson_ratio());
            self.report_once(Diagnostic::new(Code::OutOfRange, format!("{at}.poisson_ratio"), message));
            good = false;
        }
        for (_, _, t) in &gears {
            good &= self.positive(t.roughness.unwrap_or(0.0) * 1e6, true, "a roughness", "µm", place);
            good &= self.positive(t.immersion.unwrap_or(0.0) * 1e3, true, "an immersion", "mm", place);
            good &= self.positive(t.tip_relief.unwrap_or(0.0) * 1e6, true, "a tip relief", "µm", place);
            let length = t.tip_relief_length.unwrap_or(0.0) * 1e3;
            good &= self.positive(length, true, "a length of tip relief", "mm", place);
        }
        if !good {
            return None;
        }
        let wheel = |k: usize, (teeth, internal, t): &(f64, bool, &PlainTooth)| Wheel {
            teeth: cones.map_or(*teeth, |c: [f64; 2]| teeth / c[k]),
            internal: *internal,
            shift: t.shift.unwrap_or(0.0),
            tip: match t.tip_diameter {
                Some(d) => Tip::Radius(match &hypoid {
                    Some(h) => {
                        let addendum = (d / 2.0 - g.module * teeth / (2.0 * h.spiral[k].cos())) / h.cones[k].cos();
                        g.module * teeth / (2.0 * h.speed_factor(k) * helix.cos()) + addendum
                    }
                    None => d / (2.0 * cones.map_or(1.0, |c| c[k])),
                }),
                None => Tip::Addendum {
                    coefficient: t.addendum.unwrap_or(g.addendum()),
                    alteration: t.tip_alteration.unwrap_or(0.0),
                },
            },
            dedendum: t.dedendum.unwrap_or(g.dedendum()),
        };
        let data = PairData {
            module: g.module,
            pressure_angle: g.pressure_angle(),
            helix,
            double_helical: g.double_helical,
            width: g.width
                * if bevel { BEVEL_WIDTH } else { 1.0 }
                * hypoid.as_ref().map_or(1.0, |h| h.width_factor(wheel_of(gears))),
            centre_distance: g.centre_distance,
            wheels: [wheel(0, &gears[0]), wheel(1, &gears[1])],
        };
        // With the other sign of the ring's shift, as DIN has it, the teeth may fit.
        let turned = |remarks: usize| {
            let ring = data.wheels.iter().position(|w| w.internal && w.shift != 0.0)?;
            let mut other = data.clone();
            other.wheels[ring].shift = -other.wheels[ring].shift;
            let fits = Pair::new(&other).is_ok_and(|p| p.remarks().len() < remarks && usual(&p));
            fits.then(|| {
                format!(
                    "with a shift of {} on the ring they fit: DIN counts it the other way",
                    other.wheels[ring].shift
                )
            })
        };
        let pair = match Pair::new(&data) {
            Ok(pair) => pair,
            Err(faults) => {
                for fault in faults {
                    let message = format!("{}: {fault}", clip(title));
                    let d = Diagnostic::new(Code::ImpossibleGeometry, at.as_str(), message);
                    self.report(match turned(usize::MAX) {
                        Some(hint) => d.hint(hint),
                        None => d,
                    });
                }
                return None;
            }
        };
        let mut remarks: Vec<String> = pair.remarks().iter().map(ToString::to_string).collect();
        if !usual(&pair) {
            let [angle, backlash] = [pair.operating_pressure_angle.to_degrees(), pair.backlash / pair.data.module];
            remarks.push(match USUAL_ANGLES.contains(&pair.operating_pressure_angle) {
                true => {
                    format!("a backlash of {backlash:.2} modules: shifts and centre distance do not belong together")
                }
                false => format!("an operating pressure angle of {angle:.1}°: teeth in use have 12 to 40°"),
            });
        }
        let hint = turned(remarks.len());
        for remark in remarks {
            let message = format!("{}: {remark}", clip(title));
            let d = Diagnostic::new(Code::DoubtfulGeometry, at.as_str(), message);
            self.report(match &hint {
                Some(hint) => d.hint(hint.as_str()),
                None => d,
            });
        }
        let roughness = gears.map(|(_, _, t)| t.roughness.or(g.roughness));
        if roughness.iter().any(Option::is_none) {
            self.assume(title, "roughness not given, taken as Ra 0.4 µm (ground)");
        }
        let stiffness = self.mesh_stiffness(g, &pair, title, &at);
        let relief = self.tip_relief(g, &pair, gears.map(|(_, _, t)| t), title, place);
        Some(Teeth {
            pair,
            cones,
            hypoid,
            roughness: roughness.map(|r| r.unwrap_or(ROUGHNESS)),
            immersion: gears.map(|(_, _, t)| t.immersion),
            hand: 0.0,
            position: g.position,
            jet: g.jet_flow.map(|flow| Jet {
                flow,
                speed: g.jet_speed.unwrap_or(0.0),
                side: g.jet_side.unwrap_or(JetSide::IntoMesh),
            }),
            sharing: g.load_sharing_factor.unwrap_or(1.0),
            youngs_modulus: g.youngs_modulus(),
            poisson_ratio: g.poisson_ratio(),
            stiffness,
            stiffness_by_standard: g.mesh_stiffness == Some(MeshStiffness::Iso6336),
            relief,
        })
    }

    /// The pitch cones of bevel gears: `tan δ₁ = sin Σ/(z₂/z₁ + cos Σ)`, `δ₂ = Σ − δ₁`, or of hypoid gears. None where they cannot
    /// be, or where something is said of them that holds for cylindrical gears only.
    fn cones(
        &mut self,
        g: &PlainGeometry,
        gears: [(f64, bool, &PlainTooth); 2],
        title: &str,
        place: &str,
    ) -> Option<Cones> {
        let at = format!("{place}.geometry");
        let helix = self.spiral_angles(g, gears, title, place)?;
        let before = self.diagnostics.len();
        let mut wrong = |code, key: &str, message: String, hint: &str| {
            let d = Diagnostic::new(code, format!("{at}.{key}"), format!("{}: {message}", clip(title)));
            self.report_once(d.hint(hint));
        };
        let angle = g.shaft_angle.unwrap_or(std::f64::consts::FRAC_PI_2);
        let (z1, z2) = (gears[0].0, gears[1].0);
        let first = angle.sin().atan2(z2 / z1 + angle.cos());
        let all = [first, angle - first];
        let possible = angle > 0.0 && angle < std::f64::consts::PI;
        let hypoid = match helix[0] == helix[1] {
            true => None,
            false if possible && g.module > 0.0 && g.module.is_finite() => {
                let found = Hypoid::new(g.module, [z1, z2], helix, angle);
                if found.is_none() {
                    let message = format!(
                        "axes at {:.2}° with {z1} and {z2} teeth at spiral angles of {:.2}° and {:.2}°: no pitch cones below 87° touch so",
                        angle.to_degrees(),
                        helix[0].to_degrees(),
                        helix[1].to_degrees()
                    );
                    wrong(
                        Code::ImpossibleGeometry,
                        "shaft_angle",
                        message,
                        "spiral angles that differ less are possible",
                    );
                }
                found
            }
            false => None,
        };
        if let (Some(_), None, true) = (g.offset.filter(|a| *a != 0.0), &hypoid, helix[0] == helix[1]) {
            let message = "an offset, but both gears have one spiral angle".into();
            wrong(Code::Conflict, "offset", message, "give each gear its own `spiral_angle`");
        }
        if !(possible && (hypoid.is_some() || all.iter().all(|d| d.cos() > 0.05))) {
            let message = format!(
                "axes at {:.2}° with {z1} and {z2} teeth give pitch cones of {:.2}° and {:.2}°: both are below 87°",
                angle.to_degrees(),
                all[0].to_degrees(),
                all[1].to_degrees()
            );
            wrong(Code::ImpossibleGeometry, "shaft_angle", message, "90 deg is usual");
        }
        if gears.iter().any(|g| g.1) {
            wrong(Code::Conflict, "module", "internal bevel gears are not computed".into(), "give `efficiency`");
        }
        for (is, key) in [
            (g.centre_distance.is_some(), "centre_distance"),
            (g.double_helical, "double_helical"),
            (g.hand.is_some(), "hand"),
            (g.position.is_some(), "position"),
            (g.external_mesh_stiffness.is_some(), "external_mesh_stiffness"),
            (g.internal_mesh_stiffness.is_some(), "internal_mesh_stiffness"),
            (g.mesh_stiffness.is_some(), "mesh_stiffness"),
        ] {
            if is {
                wrong(
                    Code::Conflict,
                    key,
                    format!("`{key}` is of cylindrical gears"),
                    "leave it out: this is a bevel pair",
                );
            }
        }
        let shifts = gears.map(|g| g.2.shift.unwrap_or(0.0));
        if (shifts[0] + shifts[1]).abs() > 1e-9 {
            let message =
                format!("profile shifts of {} and {}: those of bevel gears are opposite", shifts[0], shifts[1]);
            wrong(Code::ImpossibleGeometry, "module", message, "give `shift` with the other sign to one of the two");
        }
        if self.diagnostics.len() > before {
            return None;
        }
        if let Some(hypoid) = hypoid {
            self.hypoid_said(g, &hypoid, title, &at);
            let factors = [0, 1].map(|k| hypoid.speed_factor(k));
            return Some(Cones { factors, helix: hypoid.helix(), hypoid: Some(hypoid) });
        }
        self.assume(
            title,
            "bevel teeth, as the virtual cylindrical pair at the middle of the face width on 85 % of it; their module is the normal one \
             there, and their forces load no bearing",
        );
        Some(Cones { factors: all.map(f64::cos), helix: helix[0], hypoid: None })
    }

    /// The mean spiral angle of each gear of a bevel pair.
    fn spiral_angles(
        &mut self,
        g: &PlainGeometry,
        gears: [(f64, bool, &PlainTooth); 2],
        title: &str,
        place: &str,
    ) -> Option<[f64; 2]> {
        let [first, second] = gears.map(|gear| gear.2.spiral_angle);
        let (Some(first), Some(second)) = (first, second) else {
            if first.is_some() || second.is_some() {
                let message = format!("{}: a spiral angle on one gear of the pair only", clip(title));
                let d = Diagnostic::new(Code::MissingKey, place, message);
                self.report_once(d.hint("give `spiral_angle` on both gears, or `helix` in the geometry for both"));
                return None;
            }
            return Some([g.helix(); 2]);
        };
        if g.helix.is_some() {
            let message = format!("{}: `helix` beside the spiral angles of both gears", clip(title));
            self.report_once(
                Diagnostic::new(Code::Conflict, format!("{place}.geometry.helix"), message).hint("leave it out"),
            );
            return None;
        }
        for angle in [first, second] {
            if !(0.0..=MOST_SPIRAL).contains(&angle) {
                let degrees = angle.to_degrees();
                let message = format!("{}: a spiral angle of {degrees:.2}°: it is 0 to 80°", clip(title));
                let hint = "both hands follow from each other; angles have no sign";
                self.report_once(Diagnostic::new(Code::OutOfRange, place, message).hint(hint));
                return None;
            }
        }
        Some([first, second])
    }

    /// What is assumed of a hypoid pair, and whether the offset that is given is its own.
    fn hypoid_said(&mut self, g: &PlainGeometry, hypoid: &Hypoid, title: &str, at: &str) {
        let follows = hypoid.offset * 1e3;
        if let Some(given) = g.offset.map(|a| a * 1e3)
            && self.positive(given, false, "an offset", "mm", &format!("{at}.offset"))
            && (given / follows - 1.0).abs() > OFFSET
        {
            let [first, second] = hypoid.spiral.map(f64::to_degrees);
            let message = format!(
                "{}: an offset of {given:.2} mm, but spiral angles of {first:.2}° and {second:.2}° at this module belong to one of \
                 {follows:.2} mm",
                clip(title)
            );
            let d = Diagnostic::new(Code::DoubtfulGeometry, format!("{at}.offset"), message);
            self.report_once(
                d.hint("`module` is the normal one at the middle of the face width, the angles are those there"),
            );
        }
        self.assume(
            title,
            format!(
                "hypoid teeth: they slide along each other, which each direction pays for differently, and across each other as \
                 the virtual cylindrical pair does whose normal section is theirs at the middle of the face width, on 85 % of it; \
                 both losses as if each were alone, with one coefficient of friction; axes {follows:.1} mm apart; pressure \
                 angles of both flanks alike; their forces load no bearing"
            ),
        );
    }

    /// Tip relief of the gears of a pair.
    fn tip_relief(
        &mut self,
        g: &PlainGeometry,
        pair: &Pair,
        teeth: [&PlainTooth; 2],
        title: &str,
        place: &str,
    ) -> Option<TipRelief> {
        let mut relief = TipRelief { amount: [0.0; 2], length: [0.0; 2], stiffness: given_stiffness(g, pair) };
        let path = pair.contact_ratio * pair.base_pitch;
        for (k, t) in teeth.into_iter().enumerate() {
            let (amount, length) = match (t.tip_relief, t.tip_relief_length) {
                (None, None) => continue,
                (Some(amount), Some(length)) => (amount, length),
                (amount, _) => {
                    let (has, misses) = match amount {
                        Some(_) => ("tip_relief", "tip_relief_length"),
                        None => ("tip_relief_length", "tip_relief"),
                    };
                    let message = format!("{}: a gear has `{has}` but no `{misses}`", clip(title));
                    let hint = "amount at the tip and length along the path of contact belong together";
                    self.report_once(Diagnostic::new(Code::MissingKey, place, message).hint(hint));
                    continue;
                }
            };
            // Without one of the two the teeth are unmodified.
            if amount == 0.0 || length == 0.0 {
                continue;
            }
            if length > path {
                let [length, path] = [length, path].map(|x| (x * 1e6).round() / 1e3);
                let message = format!(
                    "{}: a tip relief {length} mm long, on a path of contact of {path} mm: it is measured along the path, from the tip",
                    clip(title)
                );
                self.report_once(Diagnostic::new(Code::OutOfRange, place, message));
                continue;
            }
            (relief.amount[k], relief.length[k]) = (amount, length);
        }
        if relief.amount == [0.0; 2] {
            return None;
        }
        if pair.data.helix != 0.0 {
            self.assume(
                title,
                "tip relief of helical teeth: slices across the face width that do not support each other, amounts in the transverse section",
            );
        }
        if relief.stiffness.is_none()
            && let Some(how) = pair.beyond_stiffness()
        {
            let message = format!("{}: the stiffness by ISO 6336-1 is a guess for {how}", clip(title));
            self.report_once(Diagnostic::new(Code::DoubtfulGeometry, format!("{place}.geometry"), message));
        }
        Some(relief)
    }

    /// Stiffness of a pair along the line of action, N/m.
    fn mesh_stiffness(&mut self, g: &PlainGeometry, pair: &Pair, title: &str, at: &str) -> Option<f64> {
        let given = given_stiffness(g, pair);
        let width = pair.data.width * if pair.data.double_helical { 2.0 } else { 1.0 };
        if let Some(over_width) = given {
            return Some(over_width * width);
        }
        if g.mesh_stiffness != Some(MeshStiffness::Iso6336) {
            return None;
        }
        if let Some(how) = pair.beyond_stiffness() {
            let message = format!("{}: the stiffness by ISO 6336-1 is a guess for {how}", clip(title));
            self.report_once(Diagnostic::new(Code::DoubtfulGeometry, at, message));
        }
        Some(pair.mesh_stiffness(g.youngs_modulus()) * width)
    }

    /// The efficiency of a mesh under the nominal coefficient of friction, to six decimals, so that
    /// exact results stay readable.
    pub fn nominal_efficiency(&mut self, teeth: &Teeth) -> Efficiency {
        let loss = self.friction_coefficient * self.laws.loss_factor.eval(&PathOfContact::of(&teeth.pair));
        let along = teeth.hypoid.as_ref().map_or([1.0; 2], |hypoid| {
            hypoid.lengthwise_efficiency(teeth.pair.data.pressure_angle, self.friction_coefficient)
        });
        let [forward, backward] =
            along.map(|own| Rational::new((((1.0 - loss) * own).clamp(0.01, 1.0) * 1e6).round() as i64, 1_000_000));
        Efficiency { forward, backward }
    }

    /// Says which gear of a hypoid pair cannot drive at the nominal coefficient of friction: a nominal efficiency is never zero.
    pub fn hypoid_lock(&mut self, teeth: &Teeth, name: &str, place: &str) {
        let Some(hypoid) = &teeth.hypoid else { return };
        let mu = self.friction_coefficient;
        let along = hypoid.lengthwise_efficiency(teeth.pair.data.pressure_angle, mu);
        let Some(held) = along.iter().position(|eta| *eta <= 0.0) else { return };
        let message = format!(
            "{}: at a coefficient of friction of {mu} the friction along the teeth holds gear {} where it should drive; \
             nominal efficiencies say 1 % there, and only operations say that it locks",
            clip(name),
            held + 1
        );
        self.report_once(Diagnostic::new(Code::SelfLocking, format!("{place}.gears"), message));
    }

    /// Says that an efficiency stands beside teeth that would give one.
    pub fn given_efficiency(&mut self, name: &str, place: &str) {
        let message = format!("{}: its efficiency is given and used; the teeth tell speeds and pressures", clip(name));
        let d = Diagnostic::new(Code::GivenEfficiency, format!("{place}.geometry"), message);
        self.report(d.hint("leave out the efficiency to have the loss computed from the teeth"));
    }

    pub fn choose_laws(&mut self, spec: Option<&LawsSpec>) {
        let Some(spec) = spec else { return };
        for (family, law) in spec.choices() {
            if let Err(mut d) = self.laws.choose(family, &law) {
                d.place = format!("laws.{family}");
                self.report(*d);
            }
        }
        if let (Some(given), Some(law)) = (&spec.loss_factor, self.laws.mesh_friction) {
            let (own, friction) = (self.laws.loss_factor(&law).meta().id, law.meta().id);
            if self.laws.loss_factor.meta().id != own {
                let message = format!("the tooth friction `{friction}` has its own loss factor, not `{}`", clip(given));
                let hint = format!("leave it out, or choose `mesh_friction = \"{friction}-friction\"`");
                self.report(Diagnostic::new(Code::Conflict, "laws.loss_factor", message).hint(hint));
            }
        }
        const PLACE: &str = "laws.friction_coefficient";
        let Some(mu) = spec.friction_coefficient else { return };
        if self.positive(mu, true, "a coefficient of friction", "", PLACE) {
            self.friction_coefficient = mu;
            self.laws.friction_coefficient = Some(mu);
        }
        if mu > 0.5 && mu.is_finite() {
            let message = format!("a coefficient of friction of {mu}: oiled teeth have 0.005 to 0.15");
            self.report(Diagnostic::new(Code::OutOfRange, PLACE, message));
        }
    }

    pub fn oil(&mut self, spec: &PlainOil) -> Option<Lubrication> {
        let mut good = true;
        for (value, what, unit, key) in [
            (spec.viscosity_40.map(|v| v * 1e6), "a viscosity", "mm²/s", "viscosity_40"),
            (spec.viscosity_100.map(|v| v * 1e6), "a viscosity", "mm²/s", "viscosity_100"),
            (spec.viscosity.map(|v| v * 1e3), "a viscosity", "mPa s", "viscosity"),
            (spec.density_15, "a density", "kg/m³", "density_15"),
            (spec.pressure_viscosity.map(|v| v * 1e9), "a pressure coefficient", "1/GPa", "pressure_viscosity"),
            (spec.lubricant_factor, "a lubricant factor", "", "lubricant_factor"),
            (spec.temperature, "an absolute temperature", "K", "temperature"),
            (spec.volume.map(|v| v * 1e3), "a volume", "l", "volume"),
            (spec.mist, "an air-oil ratio", "", "mist"),
        ] {
            if let Some(value) = value {
                good &= self.positive(value, false, what, unit, &format!("oil.{key}"));
            }
        }
        // Walther's double logarithm ends at 0.3 mm²/s; petrol has 0.5, a gas 0.01 mPa s, pitch is no lubricant.
        for (value, [least, most], unit, key) in [
            (spec.viscosity_40.map(|v| v * 1e6), [0.31, 1e6], "mm²/s", "viscosity_40"),
            (spec.viscosity_100.map(|v| v * 1e6), [0.31, 1e6], "mm²/s", "viscosity_100"),
            (spec.viscosity.map(|v| v * 1e3), [0.01, 1e6], "mPa s", "viscosity"),
        ] {
            if let Some(value) = value.filter(|v| good && !(least..=most).contains(v)) {
                let message = format!("a viscosity of {value:?} {unit}: lubricants have {least} to {most} {unit}");
                self.report(Diagnostic::new(Code::OutOfRange, format!("oil.{key}"), message));
                good = false;
            }
        }
        let base = spec.base.unwrap_or(Base::Mineral);
        let density = spec.density_15.unwrap_or(match base {
            Base::Pao => 845.0,
            Base::Ester => 915.0,
            Base::Pag => 1050.0,
            Base::PhosphateEster => 1130.0,
            Base::Mineral | Base::Traction => 885.0,
        });
        let name = spec.name.clone().unwrap_or_else(|| "oil".into());
        let own = match (spec.viscosity_40, spec.viscosity_100, spec.viscosity) {
            (Some(cold), Some(hot), None) => {
                if hot >= cold {
                    let message = format!(
                        "a viscosity of {} mm²/s at 100 °C is not below the {} mm²/s at 40 °C",
                        hot * 1e6,
                        cold * 1e6
                    );
                    let d = Diagnostic::new(Code::OutOfRange, "oil.viscosity_100", message);
                    self.report(d.hint("are the two swapped?"));
                    return None;
                }
                good.then(|| Oil::from_two_points(&name, base, cold, hot, density))
            }
            (None, None, Some(eta)) => good.then(|| Oil::fixed(&name, base, eta, density)),
            (None, None, None) => {
                let Some(name) = &spec.name else {
                    let d = Diagnostic::new(Code::MissingKey, "oil", "the oil has neither a name nor a viscosity");
                    self.report(d.hint(
                        "name one of the catalogue, `name = \"ISO VG 220\"`, or give viscosity_40 and viscosity_100",
                    ));
                    return None;
                };
                let found = oil::find(name).cloned();
                if found.is_none() {
                    let known: Vec<&str> = oil::all().iter().map(|o| o.name.as_str()).collect();
                    let message = format!("there is no oil `{}` in the catalogue", clip(name));
                    let mut d =
                        Diagnostic::new(Code::UnknownName, "oil.name", message).suggest(name, known.iter().copied());
                    d = d.hint(format!("give its viscosity_40 and viscosity_100, or use one of: {}", list(known)));
                    self.report(d);
                }
                found
            }
            _ => {
                let message = "the viscosity is given half, or twice";
                let d = Diagnostic::new(Code::Conflict, "oil", message);
                self.report(d.hint("give viscosity_40 and viscosity_100, or viscosity at the operating temperature"));
                None
            }
        };
        let mut oil = own?;
        if !good {
            return None;
        }
        if matches!(oil.viscosity, oil::Viscosity::Fixed { .. }) && spec.viscosity.is_none() {
            self.assume(&oil.name, "its viscosity is known at one temperature, and taken at the operating temperature");
        }
        if let Some(x) = spec.lubricant_factor {
            oil.lubricant_factor = Some(x);
        }
        if let Some(alpha) = spec.pressure_viscosity {
            oil.measured_pressure_viscosity = Some(alpha);
        }
        if spec.density_15.is_none() && (spec.viscosity_40.is_some() || spec.viscosity.is_some()) {
            self.assume(&name, format!("density not given, taken as {density} kg/m³"));
        }
        let temperature = spec.temperature.unwrap_or_else(|| {
            self.assume(&oil.name, "temperature not given, taken as 60 °C");
            TEMPERATURE
        });
        let lubrication = Lubrication { oil, temperature, supply: spec.supply, volume: spec.volume, mist: spec.mist };
        self.temperature(&lubrication, temperature, "oil.temperature");
        Some(lubrication)
    }

    /// Says when a temperature lies outside what is known of the oil.
    pub fn temperature(&mut self, lubrication: &Lubrication, temperature: f64, place: &str) {
        if !(200.0..=600.0).contains(&temperature) {
            let message = format!("an oil temperature of {:.1} °C is none that a gearbox has", temperature - 273.15);
            self.report(Diagnostic::new(Code::OutOfRange, place, message).hint("from -73 to 327 °C is computed"));
        } else if let Some(beyond) = lubrication.beyond(temperature) {
            let hint = match beyond.known {
                Known::At(_) => "give viscosity_40 and viscosity_100, and it follows the temperature",
                Known::Between(_) => "the viscosity is extrapolated",
            };
            self.report(Diagnostic::new(Code::OutsideLaw, place, beyond.to_string()).hint(hint));
        }
    }

    /// One or two members; one means against the frame.
    pub fn two_members(&mut self, names: &[String], what: &str, place: &str) -> Option<[MemberId; 2]> {
        let place = format!("{place}.members");
        let ids: Vec<_> =
            names.iter().enumerate().map(|(k, m)| self.resolve(m, &format_args!("{place}[{k}]"))).collect();
        if !(1..=2).contains(&ids.len()) {
            let message = format!("a {what} joins two members (or one and the frame), here are {}", ids.len());
            self.report(Diagnostic::new(Code::ShiftElement, place, message));
            return None;
        }
        let members = [ids[0]?, ids.get(1).copied().unwrap_or(Some(FRAME))?];
        if members[0] == members[1] {
            let message = format!("this {what} joins `{}` to itself", clip(&names[0]));
            self.report(Diagnostic::new(Code::ShiftElement, place, message).hint("name the two members it joins"));
            return None;
        }
        let set = |m: MemberId| {
            let mesh = self.meshes.iter().find(|x| x.gears.iter().any(|g| g.member == m));
            mesh.filter(|_| self.members[m.0].kind == MemberKind::Planet).and_then(|x| x.set)
        };
        if let [Some(a), Some(b)] = members.map(set)
            && a != b
        {
            let message = format!("`{}` and `{}` are planets of different sets", clip(&names[0]), clip(&names[1]));
            let hint = format!(
                "they do not turn side by side: a {what} joins a planet to its carrier or to another of its set"
            );
            self.report(Diagnostic::new(Code::ShiftElement, place, message).hint(hint));
            return None;
        }
        Some(members)
    }

    pub fn bearing(&mut self, spec: &PlainBearing, place: &str) -> Option<BearingMount> {
        let members = self.two_members(&spec.members, "bearing", place);
        let mut good = true;
        for (value, zero, what, unit, key) in [
            (spec.bore.map(|v| v * 1e3), false, "a bore", "mm", "bore"),
            (spec.outside_diameter.map(|v| v * 1e3), false, "an outside diameter", "mm", "outside_diameter"),
            (spec.width.map(|v| v * 1e3), false, "a width", "mm", "width"),
            (spec.static_rating, false, "a load rating", "N", "static_rating"),
            (spec.axial_factor, false, "an axial factor", "", "axial_factor"),
            (spec.shaft_diameter.map(|v| v * 1e3), false, "a shaft diameter", "mm", "shaft_diameter"),
            (spec.span.map(|v| v * 1e3), false, "a span", "mm", "span"),
            (spec.radial_load, true, "a load", "N", "radial_load"),
            (spec.axial_load, true, "a load", "N", "axial_load"),
            (spec.level.map(|v| v * 1e3), true, "an oil level", "mm", "level"),
        ] {
            if let Some(value) = value {
                good &= self.positive(value, zero, what, unit, &format!("{place}.{key}"));
            }
        }
        if spec.kind == Some(bearing::Kind::Plain) {
            return self.plain_bearing(spec, members.filter(|_| good), place);
        }
        let found = spec.designation.as_ref().and_then(|d| bearing::find(d));
        let bearing = match (found, spec.kind, spec.bore, spec.outside_diameter, spec.width) {
            (Some(found), kind, bore, outside, width) => {
                // What the user gives wins, and is checked against the designation below.
                let mut b = found;
                if let Some(kind) = kind.filter(|k| *k != b.kind) {
                    let message = format!("`{}` is a {}, not a {}", b.designation, b.kind, kind);
                    self.report(Diagnostic::new(Code::Conflict, format!("{place}.kind"), message));
                }
                b.bore = bore.unwrap_or(b.bore);
                b.outside_diameter = outside.unwrap_or(b.outside_diameter);
                b.width = width.unwrap_or(b.width);
                if let Some(series) = &spec.series {
                    b.series = series.clone();
                    b.skf = bearing::skf_constants(b.kind, series);
                }
                b
            }
            (None, Some(kind), Some(bore), Some(outside), Some(width)) => {
                let name = spec.designation.as_deref().unwrap_or(&spec.name);
                Bearing::new(name, kind, spec.series.as_deref().unwrap_or(""), bore, outside, width)
            }
            (None, ..) => {
                let mut hint = "give kind, series, bore, outside_diameter and width".to_owned();
                let d = match &spec.designation {
                    Some(name) => {
                        let message = format!("there is no bearing `{}` in the catalogue", clip(name));
                        let d = Diagnostic::new(Code::UnknownName, format!("{place}.designation"), message);
                        // A bearing of another size is not what was meant, however alike the names are.
                        let digits = |text: &str| text.chars().filter(char::is_ascii_digit).collect::<String>();
                        let alike = |b: &&Bearing| digits(&b.designation) == digits(name);
                        let d = d.suggest(name, bearing::all().iter().filter(alike).map(|b| b.designation.as_str()));
                        if let Some((kind, series)) = bearing::kind_of(name) {
                            let word = bearing::Kind::NAMES.iter().find(|n| n.1 == kind).map_or("", |n| n.0);
                            hint = format!(
                                "by its name it is a {kind}: give kind = \"{word}\", series = \"{series}\", bore, \
                                 outside_diameter and width"
                            );
                        }
                        d
                    }
                    None => {
                        let message = format!("bearing `{}` has no designation and no dimensions", clip(&spec.name));
                        Diagnostic::new(Code::MissingKey, format!("{place}.designation"), message)
                    }
                };
                self.report(d.hint(hint));
                return None;
            }
        };
        if !good {
            return None;
        }
        let mut bearing = bearing;
        bearing.static_rating = spec.static_rating.or(bearing.static_rating);
        bearing.axial_factor = spec.axial_factor.or(bearing.axial_factor);
        for mismatch in bearing.check() {
            let code = match mismatch.is_impossible() {
                true => Code::ImpossibleBearing,
                false => Code::DoubtfulBearing,
            };
            let message = format!("bearing `{}`: {mismatch}", clip(&spec.name));
            self.report(Diagnostic::new(code, place, message));
        }
        if let Some(shaft) = spec.shaft_diameter
            && (shaft - bearing.bore).abs() > 0.1e-3
        {
            let message = format!(
                "bearing `{}`: a bore of {:.1} mm does not fit a shaft of {:.1} mm",
                clip(&spec.name),
                bearing.bore * 1e3,
                shaft * 1e3
            );
            self.report(
                Diagnostic::new(Code::ImpossibleBearing, format!("{place}.shaft_diameter"), message)
                    .hint("choose a bearing with that bore, or give the diameter of its own seat"),
            );
        }
        let count = self.count(spec.count.unwrap_or(1), &format_args!("{place}.count"));
        if spec.locates == Some(true) && !bearing.takes_thrust() {
            let message = format!(
                "bearing `{}`: a {} of designation `{}` holds no shaft along its axis",
                clip(&spec.name),
                bearing.kind,
                clip(&bearing.designation)
            );
            let d = Diagnostic::new(Code::DoubtfulBearing, format!("{place}.locates"), message);
            self.report(d.hint("leave out `locates`, or choose a bearing with flanges (NJ, NUP) or a ball bearing"));
        }
        Some(BearingMount {
            name: spec.name.clone(),
            members: members?,
            bearing,
            count,
            places: 1,
            span: spec.span,
            position: spec.position,
            clearance: 0.0,
            friction: 0.0,
            locates: spec.locates,
            radial_load: spec.radial_load.unwrap_or(0.0),
            axial_load: spec.axial_load.unwrap_or(0.0),
            supply: spec.supply,
            level: spec.level,
        })
    }

    /// A plain bearing: bore and width, and what of clearance and friction is not given.
    fn plain_bearing(
        &mut self,
        spec: &PlainBearing,
        members: Option<[MemberId; 2]>,
        place: &str,
    ) -> Option<BearingMount> {
        let (Some(bore), Some(width)) = (spec.bore, spec.width) else {
            let message = format!("plain bearing `{}` has no bore or no width", clip(&spec.name));
            let d = Diagnostic::new(Code::MissingKey, place, message);
            self.report(d.hint("give `bore` and `width`; `clearance` and `friction` may follow"));
            return None;
        };
        let clearance = spec.clearance.unwrap_or_else(|| {
            self.assume(&spec.name, "clearance of the plain bearing not given, taken as 0.0015 of the bore");
            CLEARANCE * bore
        });
        let friction = spec.friction.unwrap_or(0.08);
        let good = self.positive(clearance * 1e3, false, "a clearance", "mm", &format!("{place}.clearance"))
            & self.positive(friction, false, "a coefficient of friction", "", &format!("{place}.friction"));
        // A bush without a size of its own: a wall of a tenth of the bore.
        let outside = spec.outside_diameter.unwrap_or(1.2 * bore);
        let name = spec.designation.as_deref().unwrap_or(&spec.name);
        let count = self.count(spec.count.unwrap_or(1), &format_args!("{place}.count"));
        Some(BearingMount {
            name: spec.name.clone(),
            members: members.filter(|_| good)?,
            bearing: Bearing::new(name, bearing::Kind::Plain, "", bore, outside, width),
            count,
            places: 1,
            span: spec.span,
            position: spec.position,
            clearance,
            friction,
            locates: spec.locates,
            radial_load: spec.radial_load.unwrap_or(0.0),
            axial_load: spec.axial_load.unwrap_or(0.0),
            supply: spec.supply,
            level: spec.level,
        })
    }

    /// What a shift element does while it is open: one of a curve, a pack, a band, a torque.
    pub fn open_element(&mut self, spec: &PlainOpen, place: &str) -> Option<OpenElement> {
        let pack = [spec.inner_radius, spec.outer_radius].iter().any(Option::is_some) || spec.surfaces.is_some();
        let forms = [
            ("curve", spec.curve.is_some()),
            ("surfaces", pack),
            ("drum_radius", spec.drum_radius.is_some()),
            ("torque", spec.torque.is_some()),
        ];
        let given: Vec<&str> = forms.iter().filter(|f| f.1).map(|f| f.0).collect();
        const HINT: &str = "give `curve`; or surfaces, inner_radius, outer_radius and gap; or drum_radius, width, wrap and \
                            gap; or `torque`";
        if given.len() != 1 {
            let (code, message) = match given.len() {
                0 => (Code::MissingKey, "it is not said what drags".to_owned()),
                _ => (Code::Conflict, format!("the drag is given more than once: {}", list(given))),
            };
            self.report(Diagnostic::new(code, place, message).hint(HINT));
            return None;
        }
        let mut good = true;
        for (value, zero, what, unit, key) in [
            (spec.inner_radius.map(|v| v * 1e3), false, "a radius", "mm", "inner_radius"),
            (spec.outer_radius.map(|v| v * 1e3), false, "a radius", "mm", "outer_radius"),
            (spec.gap.map(|v| v * 1e3), false, "a gap", "mm", "gap"),
            (spec.flow.map(|v| v * 6e4), false, "a flow", "l/min", "flow"),
            (spec.groove_share, true, "a share", "", "groove_share"),
            (spec.groove_depth.map(|v| v * 1e3), true, "a depth", "mm", "groove_depth"),
            (spec.drum_radius.map(|v| v * 1e3), false, "a radius", "mm", "drum_radius"),
            (spec.width.map(|v| v * 1e3), false, "a width", "mm", "width"),
            (spec.wrap, false, "an angle", "rad", "wrap"),
            (spec.wetted, true, "a share", "", "wetted"),
            (spec.torque, true, "a torque", "N m", "torque"),
            (spec.temperature, false, "an absolute temperature", "K", "temperature"),
        ] {
            if let Some(value) = value {
                good &= self.positive(value, zero, what, unit, &format!("{place}.{key}"));
            }
        }
        for (value, key) in [(spec.groove_share, "groove_share"), (spec.wetted, "wetted")] {
            if let Some(share) = value.filter(|x| *x > 1.0 || key == "groove_share" && *x >= 1.0) {
                let message = format!("a share of {share}: it is a part of the surface, up to 1");
                self.report(Diagnostic::new(Code::OutOfRange, format!("{place}.{key}"), message));
                good = false;
            }
        }
        let mut need = |value: Option<f64>, key: &str| {
            if value.is_none() {
                let message = format!("the drag of an open element needs `{key}`");
                self.report(Diagnostic::new(Code::MissingKey, format!("{place}.{key}"), message).hint(HINT));
            }
            value
        };
        let element = match given[0] {
            "curve" => {
                let curve =
                    self.curve_of_amounts(spec.curve.as_deref().unwrap_or_default(), &format!("{place}.curve"))?;
                OpenElement::Curve(curve, spec.temperature.unwrap_or(CURVE_TEMPERATURE))
            }
            "surfaces" => {
                let [inner, outer] = [need(spec.inner_radius, "inner_radius"), need(spec.outer_radius, "outer_radius")];
                let gap = need(spec.gap, "gap");
                let surfaces = need(spec.surfaces.map(|n| n as f64), "surfaces");
                let (inner_radius, outer_radius, gap, _) = (inner?, outer?, gap?, surfaces?);
                if outer_radius <= inner_radius {
                    let message = format!(
                        "an outer radius of {} mm is not above the inner one of {} mm",
                        outer_radius * 1e3,
                        inner_radius * 1e3
                    );
                    self.report(Diagnostic::new(Code::OutOfRange, format!("{place}.outer_radius"), message));
                    good = false;
                }
                if spec.flow.is_none() {
                    let name = place.split('.').next().unwrap_or(place);
                    self.assume(name, "oil through the gaps of open packs not given, taken as 0.1 l/min each");
                }
                OpenElement::Pack {
                    surfaces: self.count(spec.surfaces.unwrap_or(1), &format_args!("{place}.surfaces")),
                    inner_radius,
                    outer_radius,
                    gap,
                    flow: spec.flow.unwrap_or(PACK_FLOW),
                    groove_share: spec.groove_share.unwrap_or(0.0),
                    groove_depth: spec.groove_depth.unwrap_or(0.0),
                }
            }
            "drum_radius" => {
                let all = [need(spec.drum_radius, "drum_radius"), need(spec.width, "width"), need(spec.wrap, "wrap")];
                let gap = need(spec.gap, "gap");
                let [radius, width, wrap] = all;
                OpenElement::Band {
                    radius: radius?,
                    width: width?,
                    wrap: wrap?,
                    gap: gap?,
                    wetted: spec.wetted.unwrap_or(1.0),
                }
            }
            _ => OpenElement::Torque(spec.torque?),
        };
        good.then_some(element)
    }

    pub fn pump(&mut self, spec: &PlainPump, place: &str) -> Option<Pump> {
        let member = self.resolve(&spec.member, &format_args!("{place}.member"));
        let mut good = true;
        for (value, what, unit, key) in [
            (spec.displacement * 1e6, "a displacement", "cm³", "displacement"),
            (spec.pressure * 1e-5, "a pressure", "bar", "pressure"),
            (spec.efficiency.unwrap_or(1.0), "an efficiency", "", "efficiency"),
        ] {
            good &= self.positive(value, false, what, unit, &format!("{place}.{key}"));
        }
        if let Some(eta) = spec.efficiency.filter(|x| *x > 1.0) {
            let message = format!("an efficiency of {eta}: a pump takes more than it delivers");
            self.report(Diagnostic::new(Code::OutOfRange, format!("{place}.efficiency"), message));
            good = false;
        }
        if member == Some(FRAME) {
            let message = "the frame does not turn and drives nothing";
            self.report(Diagnostic::new(Code::BadName, format!("{place}.member"), message));
            good = false;
        }
        let member = member.filter(|_| good)?;
        let PlainPump { name, displacement, pressure, efficiency, .. } = spec.clone();
        Some(Pump { name, member, displacement, pressure, efficiency })
    }

    pub fn seal(&mut self, spec: &PlainSeal, place: &str) -> Option<SealMount> {
        let members = self.two_members(&spec.members, "seal", place);
        let good = self.positive(spec.diameter * 1e3, false, "a diameter", "mm", &format!("{place}.diameter"));
        let count = self.count(spec.count.unwrap_or(1), &format_args!("{place}.count"));
        let members = members.filter(|_| good)?;
        let material = spec.material.unwrap_or(Material::Fkm);
        Some(SealMount { name: spec.name.clone(), members, diameter: spec.diameter, material, count })
    }

    /// Says what oil seals are taken to run in, where it is not known.
    pub fn oil_of_seals(&mut self, lubrication: &Option<Lubrication>, seals: &[SealMount]) {
        let reads_oil = self.laws.seal.meta().id == "simrit";
        let Some(first) = seals.first().filter(|_| reads_oil) else { return };
        match lubrication {
            None => self.assume(&first.name, "no oil given, taken as ISO VG 100 at 60 °C"),
            Some(l) if !l.oil.covers(COLD) => {
                self.assume(&first.name, "viscosity of the oil at 40 °C not known, taken as 100 mm²/s");
            }
            Some(_) => {}
        }
    }

    pub fn rotor(&mut self, spec: &PlainRotor, place: &str) -> Option<Rotor> {
        let member = self.resolve(&spec.member, &format_args!("{place}.member"));
        let axial_gap = spec.axial_gap.unwrap_or(spec.radial_gap);
        let mut good = true;
        for (value, what, key) in [
            (spec.radius, "a radius", "radius"),
            (spec.length, "a length", "length"),
            (spec.radial_gap, "a gap", "radial_gap"),
            (axial_gap, "a gap", "axial_gap"),
        ] {
            good &= self.positive(value * 1e3, false, what, "mm", &format!("{place}.{key}"));
        }
        if member == Some(FRAME) {
            let message = "the frame does not turn and drags nothing";
            self.report(Diagnostic::new(Code::BadName, format!("{place}.member"), message));
            good = false;
        }
        let member = member.filter(|_| good)?;
        let PlainRotor { name, radius, length, radial_gap, fluid, .. } = spec.clone();
        Some(Rotor { name, member, radius, length, radial_gap, axial_gap, fluid: fluid.unwrap_or_default() })
    }

    /// Planets that revolve, with their orbit and mass, where the geometry tells them; and the
    /// number of places of the bearings on them.
    pub fn planet_bodies(
        &mut self,
        masses: &[(MemberId, f64)],
        bearings: &mut [BearingMount],
        central: &[MemberId],
    ) -> Vec<PlanetBody> {
        // Planets of sets; and shafts that mesh twice or more on one carrier, carried by a bearing on it.
        let is_planet = |m: MemberId| {
            if self.members[m.0].kind == MemberKind::Planet {
                return true;
            }
            let own: Vec<_> = self.meshes.iter().filter(|x| x.gears.iter().any(|g| g.member == m)).collect();
            let Some(carrier) = own.first().map(|x| x.carrier).filter(|c| *c != FRAME) else { return false };
            let carried = |b: &BearingMount| b.members == [m, carrier] || b.members == [carrier, m];
            own.len() > 1
                && own.iter().all(|x| x.carrier == carrier && x.set.is_none())
                && m != FRAME
                && !central.contains(&m)
                && self.meshes.iter().all(|x| x.carrier != m)
                && bearings.iter().any(carried)
        };
        let planets: Vec<bool> = (0..self.members.len()).map(|m| is_planet(MemberId(m))).collect();
        let mut all: Vec<PlanetBody> = Vec::new();
        let mut too_large: Vec<Diagnostic> = Vec::new();
        for (j, mesh) in self.meshes.iter().enumerate() {
            for k in 0..2 {
                let member = mesh.gears[k].member;
                let other = mesh.gears[1 - k].member;
                let revolves = planets[member.0] && !planets[other.0];
                let Some(teeth) = mesh.teeth.as_ref().filter(|t| revolves && t.cones.is_none()) else { continue };
                if all.iter().any(|p| p.member == member) {
                    continue;
                }
                all.push(PlanetBody {
                    member,
                    carrier: mesh.carrier,
                    count: mesh.count,
                    orbit_radius: teeth.pair.centre_distance,
                    mass: 0.0,
                    mesh: MeshId(j),
                    estimated: true,
                });
            }
        }
        for body in &mut all {
            let bearing = bearings.iter().find(|b| b.members.contains(&body.member));
            let hole = bearing.map_or(0.0, |b| b.bearing.outside_diameter / 2.0);
            let root = (self.meshes.iter())
                .flat_map(|m| {
                    m.teeth.iter().filter(|t| t.cones.is_none()).flat_map(|t| m.gears.iter().zip(&t.pair.gears))
                })
                .filter(|(g, _)| g.member == body.member && !g.internal)
                .map(|(_, own)| own.root_radius)
                .fold(f64::INFINITY, f64::min);
            if let Some(b) = bearing.filter(|_| hole >= root) {
                let message = format!(
                    "bearing `{}`: its outside diameter of {:.1} mm does not fit into a planet with a root circle of {:.1} mm",
                    clip(&b.name),
                    hole * 2e3,
                    root * 2e3
                );
                let at = bearings.iter().position(|x| std::ptr::eq(x, b)).unwrap_or(0);
                let place = format!("bearing[{at}]");
                too_large.push(Diagnostic::new(Code::DoubtfulBearing, place, message));
            }
            let teeth = |j: usize| self.meshes[j].teeth.as_deref().cloned();
            let estimate = || steel_mass(&self.meshes, body.member, hole, &teeth);
            let given = masses.iter().find(|(m, _)| *m == body.member).map(|(_, mass)| *mass);
            body.mass = given.unwrap_or_else(estimate);
            body.estimated = given.is_none();
            if given.is_none() && bearing.is_some() && body.carrier != FRAME {
                let name = self.members[body.member.0].name.clone();
                let text = format!(
                    "mass not given, taken as {:.3} kg (steel cylinder of the pitch circle around the bearing)",
                    body.mass
                );
                self.assumptions.push((name, text));
            }
        }
        too_large.into_iter().for_each(|d| self.report(d));
        for b in bearings {
            let planets = |m: MemberId| {
                let of = |x: &&crate::train::Mesh| x.gears.iter().any(|g| g.member == m);
                planets[m.0].then(|| self.meshes.iter().find(of).map_or(1, |x| x.count))
            };
            b.places = b.members.iter().find_map(|m| planets(*m)).unwrap_or(1);
        }
        all
    }

    /// Factors that tests gave.
    pub fn loss_factors(&mut self, spec: Option<&PlainLosses>) -> LossFactors {
        let Some(spec) = spec else { return LossFactors::default() };
        let of = |all: &Option<PlainLossFactor>| all.as_ref().map_or([None; LossPart::COUNT], PlainLossFactor::values);
        let (given, spreads) = (of(&spec.factor), of(&spec.spread));
        for (part, (factor, spread)) in LossPart::ALL.into_iter().zip(given.into_iter().zip(spreads)) {
            let key = part.key();
            if let Some(x) = factor {
                self.positive(x, false, "a factor", "", &format!("losses.factor.{key}"));
            }
            if let Some(x) = spread {
                self.positive(x, true, "a standard deviation", "", &format!("losses.spread.{key}"));
            }
        }
        let named: Vec<String> = LossPart::ALL
            .into_iter()
            .zip(given)
            .filter_map(|(part, x)| Some(format!("{} {}", part.words(), x?)))
            .collect();
        if !named.is_empty() {
            let rests =
                spec.calibrated.as_ref().map_or("factors of the file".to_owned(), |c| format!("calibrated, {c}"));
            self.assume("losses", format!("{rests}: {}", named.join(", ")));
        }
        LossFactors { factors: given.map(|x| x.unwrap_or(1.0)), spreads, calibrated: spec.calibrated.clone() }
    }

    pub fn housing(&mut self, spec: &PlainHousing) {
        if let Some(x) = spec.enclosure
            && self.positive(x, false, "an enclosure factor", "", "housing.enclosure")
            && x > 1.0
        {
            let message = format!("an enclosure factor of {x}: free is 1, a case makes it smaller");
            self.report(Diagnostic::new(Code::OutOfRange, "housing.enclosure", message));
        }
        if let Some(x) = spec.axial_gap {
            self.positive(x * 1e3, false, "a gap", "mm", "housing.axial_gap");
        }
    }

    /// What cannot be computed without more data: an error where it was asked for, an assumption
    /// where it follows from what is there.
    pub fn missing_for_losses(
        &mut self,
        lubrication: &Option<Lubrication>,
        bearings: &[BearingMount],
        rotors: &[Rotor],
        elements: &[ShiftElement],
        pumps: &[Pump],
    ) {
        let in_oil = |e: &&ShiftElement| matches!(e.open, Some(OpenElement::Pack { .. } | OpenElement::Band { .. }));
        let sprayed = self.meshes.iter().find(|m| m.teeth.as_ref().is_some_and(|t| t.jet.is_some()));
        let viscous = pumps.first().filter(|_| self.laws.pump.meta().id == "wilson");
        let needs_oil = [
            ("the friction of bearing", bearings.first().map(|b| b.name.clone())),
            ("the friction of rotor", rotors.iter().find(|r| r.fluid != Fluid::Air).map(|r| r.name.clone())),
            ("the drag of open element", elements.iter().find(in_oil).map(|e| e.name.clone())),
            ("the friction of pump", viscous.map(|p| p.name.clone())),
            ("what a jet takes at", sprayed.map(|m| m.name.clone())),
        ];
        if lubrication.is_none()
            && self.meshes.iter().any(|m| m.computed)
            && let Some(d) = self.laws.without_oil()
        {
            self.report(d);
        }
        for (what, name) in needs_oil {
            if let (Some(name), None) = (name, lubrication) {
                let message = format!("{what} `{}` depends on an oil, and none is given", clip(&name));
                let d = Diagnostic::new(Code::MissingKey, "oil", message);
                self.report(d.hint("add [oil] with a name of the catalogue, or its viscosities"));
            }
        }
        let dips: Vec<String> = (self.meshes.iter())
            .filter(|m| m.teeth.as_ref().is_some_and(|t| t.immersion.iter().any(Option::is_some)))
            .map(|m| m.name.clone())
            .collect();
        if let Some(first) = dips.first()
            && lubrication.as_ref().is_none_or(|l| l.volume.is_none())
        {
            let message = format!("a gear of {} is immersed; churning needs the volume of oil", clip(first));
            self.report(Diagnostic::new(Code::MissingKey, "oil.volume", message).hint("give `volume` in [oil]"));
        }
    }
}
