//! Checks the dynamic layer: inertias, drags, shafts, friction of shift elements, loss tables, and
//! the motions to simulate.

use std::collections::HashSet;

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::train::assembler::{Assembler, check_name};
use crate::train::csv;
use crate::train::described::{GivenFriction, GivenMesh, GivenSet, Parts};
use crate::train::dynamic::{
    Control, ControlKind, Curve, DragMount, Engagement, Friction, Inertia, LossRow, Scenario, Shaft, Signal, Source,
    SourceKind,
};
use crate::train::formula::Formula;
use crate::train::physical::PlanetBody;
use crate::train::specification::field::Field;
use crate::train::specification::{
    EfficiencySpec, PlainControl, PlainController, PlainDrag, PlainScenario, PlainShaft, PlainSource, ScenarioSpec,
    SignalSpec,
};
use crate::train::variator::Variator;
use crate::train::words::clip;
use crate::train::{Efficiency, FRAME, MemberId, MemberKind, Set, ShiftElementId, ShiftElementKind, State};
use crate::units::Time;

const MOST_SAMPLES: i64 = 10_000_000;
/// A longer formula is no formula.
const MOST_FORMULA: usize = 2000;
/// How far a given orbit may differ from the centre distance of the teeth.
const SAME_ORBIT: f64 = 0.01;

/// What scenarios refer to.
pub(super) struct Scene<'a> {
    pub states: &'a [State],
    /// Name and kind of each shift element.
    pub elements: Vec<(&'a str, ShiftElementKind)>,
    pub shafts: Vec<&'a str>,
    pub variators: &'a [Variator],
}

impl Assembler<'_> {
    fn refuse(&mut self, code: Code, place: &str, message: impl Into<String>, hint: &str) {
        let d = Diagnostic::new(code, place, message);
        self.report(if hint.is_empty() { d } else { d.hint(hint) });
    }

    /// Reports numbers that are not finite.
    fn finite(&mut self, values: &[(&str, f64)], place: &str) -> bool {
        let wrong: Vec<_> = values.iter().filter(|v| !v.1.is_finite()).collect();
        for (key, value) in &wrong {
            let place = if key.is_empty() { place.to_owned() } else { format!("{place}.{key}") };
            self.refuse(Code::OutOfRange, &place, format!("a value of {value}: it is a finite number"), "");
        }
        wrong.is_empty()
    }

    fn peak(&mut self, peak: Option<f64>, place: &str) -> Option<f64> {
        let peak = peak.unwrap_or(1.0);
        if peak.is_finite() && peak >= 1.0 {
            return Some(peak);
        }
        let message =
            format!("a peak of {peak}: breaking away takes at least the torque of sliding, so it is 1 or more");
        self.refuse(Code::OutOfRange, &format!("{place}.peak"), message, "");
        None
    }

    /// A curve through points of rising abscissa.
    fn curve(&mut self, points: &[[f64; 2]], unit: &str, place: &str) -> Option<Curve> {
        let curve = Curve::new(points.to_vec());
        if curve.is_none() {
            self.bad_points(points, |a, b| a < b, unit, place);
        }
        curve
    }

    /// A curve over the amount of something, of values that are not negative.
    pub fn curve_of_amounts(&mut self, points: &[[f64; 2]], place: &str) -> Option<Curve> {
        let curve = self.curve(points, "rad/s", place)?;
        match points.iter().position(|p| p.iter().any(|x| *x < 0.0)) {
            None => Some(curve),
            Some(k) => {
                let [x, y] = points[k].map(shown);
                let message = format!("point {} ({x}, {y}): speed and value are amounts, not negative", k + 1);
                self.refuse(Code::BadTable, &format!("{place}[{k}]"), message, "");
                None
            }
        }
    }

    /// Says what is wrong with points.
    fn bad_points(&mut self, points: &[[f64; 2]], rises: impl Fn(f64, f64) -> bool, unit: &str, place: &str) {
        if points.is_empty() {
            self.refuse(Code::BadTable, place, "the table has no points", "give one or more");
        }
        if let Some(k) = points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            let message = format!("point {} has a value that is no finite number", k + 1);
            self.refuse(Code::BadTable, &format!("{place}[{k}]"), message, "");
        } else if let Some(k) = points.windows(2).position(|w| !rises(w[0][0], w[1][0])) {
            let [before, after] = [points[k][0], points[k + 1][0]].map(shown);
            let message =
                format!("point {} at {after} {unit} does not lie beyond point {} at {before} {unit}", k + 2, k + 1);
            self.refuse(Code::BadTable, &format!("{place}[{}]", k + 1), message, "the first column rises");
        }
    }

    // ---- What moves -----------------------------------------------------------------------

    pub fn inertias(&mut self, given: &[(String, f64)]) -> Vec<Inertia> {
        let mut all: Vec<Inertia> = Vec::new();
        for (name, value) in given {
            let place = format!("inertias.{name}");
            let good = self.positive(*value, true, "a moment of inertia", "kg m²", &place);
            let Some(member) = self.resolve(name, &place) else { continue };
            if member == FRAME {
                self.refuse(Code::BadName, &place, "the frame does not turn and has no inertia", "leave it out");
            } else if all.iter().any(|i| i.member == member) {
                let message = format!("the inertia of `{}` is given twice", clip(name));
                self.refuse(Code::Conflict, &place, message, "give it once");
            } else if good {
                all.push(Inertia { member, reference: self.reference(member), value: *value });
            }
        }
        all
    }

    /// What the speed of a member is measured against in its kinetic energy.
    fn reference(&mut self, member: MemberId) -> MemberId {
        let own: Vec<_> = self.meshes.iter().filter(|m| m.gears.iter().any(|g| g.member == member)).collect();
        let Some(carrier) = own.first().map(|m| m.carrier).filter(|c| *c != FRAME) else { return FRAME };
        if !own.iter().all(|m| m.bevel && m.carrier == carrier) {
            return FRAME;
        }
        if self.members[member.0].kind == MemberKind::Planet {
            return carrier;
        }
        // Written mesh by mesh, a bevel planet is a shaft that meshes with two or more on its carrier.
        let moves = self.meshes.iter().any(|m| m.carrier == member);
        if own.len() < 2 || moves {
            return FRAME;
        }
        let (name, carrier_name) = (self.members[member.0].name.clone(), &self.members[carrier.0].name);
        let text = format!("taken as a bevel planet: its inertia turns with its spin on `{carrier_name}`");
        self.assume(&name, text);
        carrier
    }

    /// Inertias of the planets of sets, about their own axes and with the carrier.
    pub fn planet_inertias(
        &mut self,
        sets: &[(&GivenSet, Vec<MemberId>)],
        resolved: &[Option<Set>],
        orbits: &[PlanetBody],
        given: &[Inertia],
        moving: bool,
    ) -> Vec<Inertia> {
        let mut all = Vec::new();
        for (k, ((set, members), resolved)) in sets.iter().zip(resolved).enumerate() {
            let carrier = self.by_name.get(&set.carrier).copied();
            for ((role, planet), member) in set.planets().into_iter().zip(members) {
                let place = format!("set[{k}].{role}");
                let name = format!("{}.{role}", set.name);
                let body = &planet.body;
                let mut good = true;
                for (value, zero, what, unit, key) in [
                    (body.mass, true, "a mass", "kg", "mass"),
                    (body.inertia, true, "a moment of inertia", "kg m²", "inertia"),
                    (body.orbit_radius.map(|r| r * 1e3), false, "an orbit radius", "mm", "orbit_radius"),
                ] {
                    good &= value.is_none_or(|v| self.positive(v, zero, what, unit, &format!("{place}.{key}")));
                }
                let teeth = orbits.iter().find(|o| o.member == *member).map(|o| o.orbit_radius);
                if let (Some(here), Some(there), true) = (body.orbit_radius, teeth, good)
                    && (here - there).abs() > SAME_ORBIT * there
                {
                    let (here, there) = (here * 1e3, there * 1e3);
                    let message = format!(
                        "`{}`: an orbit radius of {here:.3} mm, but the teeth have a centre distance of {there:.3} mm",
                        clip(&name)
                    );
                    self.refuse(Code::Conflict, &format!("{place}.orbit_radius"), message, "leave it out");
                }
                let own = given.iter().any(|i| i.member == *member);
                if own && body.inertia.is_some() {
                    let message = format!("the inertia of `{}` is given here and in [inertias]", clip(&name));
                    self.refuse(Code::Conflict, &format!("{place}.inertia"), message, "give it once");
                    continue;
                }
                if body.mass.is_none() && body.inertia.is_none() {
                    if moving && !own {
                        self.assume(&name, "neither its `mass` nor its `inertia` is given: what it weighs does not resist acceleration");
                    }
                    continue;
                }
                let (Some(carrier), true) = (carrier, good) else { continue };
                let count = resolved.as_ref().and_then(|s| s.planets);
                if count.is_none() {
                    self.assume(&name, "number of planets not given, mass and inertia taken as of one");
                }
                let count = f64::from(count.unwrap_or(1));
                let bevel = matches!(set.parts, Parts::Bevel { .. });
                all.extend(body.inertia.map(|j| Inertia {
                    member: *member,
                    reference: if bevel { carrier } else { FRAME },
                    value: count * j,
                }));
                let Some(mass) = body.mass.filter(|_| carrier != FRAME) else { continue };
                match body.orbit_radius.or(teeth) {
                    Some(r) => all.push(Inertia { member: carrier, reference: FRAME, value: count * mass * r * r }),
                    None => {
                        self.unplaced_masses.push(name.clone());
                        if moving {
                            let text = "orbit not known, its mass is left out of motions (give orbit_radius)";
                            self.assume(&name, text);
                        }
                    }
                }
            }
        }
        all
    }

    pub fn drag(&mut self, spec: &PlainDrag, place: &str) -> Option<DragMount> {
        let members = self.two_members(&spec.members, "drag", place);
        let mut good = true;
        for (value, what, unit, key) in [
            (spec.coulomb, "a torque", "N m", "coulomb"),
            (spec.viscous, "a viscous coefficient", "N m s/rad", "viscous"),
        ] {
            good &= value.is_none_or(|v| self.positive(v, true, what, unit, &format!("{place}.{key}")));
        }
        let at = format!("{place}.table");
        let table = spec.table.as_ref().map(|t| self.curve_of_amounts(t, &at));
        let peak = self.peak(spec.peak, place);
        if spec.coulomb.is_some() && table.is_some() {
            let message = "`coulomb` and `table` both say what it exerts";
            self.refuse(Code::Conflict, &at, message, "keep the one that is known");
            good = false;
        }
        if spec.coulomb.is_none() && spec.viscous.is_none() && table.is_none() {
            let message = format!("drag `{}` exerts nothing", clip(&spec.name));
            self.refuse(Code::MissingKey, place, message, "give `coulomb`, `viscous` or `table`");
            good = false;
        }
        let torque = table.unwrap_or_else(|| Some(Curve::constant(spec.coulomb.unwrap_or(0.0))))?;
        let (members, peak) = (members.filter(|_| good)?, peak?);
        let count = self.planets_at(members);
        let places = f64::from(count);
        let torque = Curve::new(torque.points().iter().map(|[x, y]| [*x, y * places]).collect())?;
        let viscous = spec.viscous.unwrap_or(0.0) * places;
        Some(DragMount { name: spec.name.clone(), members, torque, viscous, places: count, peak })
    }

    /// How many planets of a set stand behind one of these members.
    fn planets_at(&self, members: [MemberId; 2]) -> u32 {
        let planet = members.into_iter().find(|m| self.members[m.0].kind == MemberKind::Planet);
        let of = |m: MemberId| self.meshes.iter().find(|x| x.gears.iter().any(|g| g.member == m));
        planet.and_then(of).map_or(1, |mesh| mesh.count)
    }

    pub fn shaft(&mut self, spec: &PlainShaft, place: &str) -> Option<Shaft> {
        let members = self.two_members(&spec.members, "shaft", place);
        let mut good = true;
        for (value, what, unit, key) in [
            (spec.stiffness, "a stiffness", "N m/rad", "stiffness"),
            (spec.damping, "a damping", "N m s/rad", "damping"),
            (spec.backlash, "a backlash", "rad", "backlash"),
        ] {
            good &= value.is_none_or(|v| self.positive(v, true, what, unit, &format!("{place}.{key}")));
        }
        let [stiffness, damping, backlash] =
            [spec.stiffness, spec.damping, spec.backlash].map(Option::unwrap_or_default);
        if good && stiffness == 0.0 && (damping == 0.0 || backlash > 0.0) {
            let name = clip(&spec.name);
            let (message, hint) = match damping == 0.0 {
                true => (format!("shaft `{name}` has neither stiffness nor damping"), "give one of them, above zero"),
                false => (format!("shaft `{name}` has a backlash and no stiffness"), "give `stiffness`"),
            };
            self.refuse(Code::MissingKey, &format!("{place}.stiffness"), message, hint);
            good = false;
        }
        let members = members.filter(|_| good)?;
        Some(Shaft {
            name: spec.name.clone(),
            members,
            stiffness,
            damping,
            backlash,
            contact: spec.contact.unwrap_or_default(),
        })
    }

    pub fn friction(&mut self, spec: &GivenFriction, place: &str) -> Option<Friction> {
        if spec.is_open() {
            return None;
        }
        let at = |key: &str| format!("{place}.{key}");
        let mut good = true;
        for (value, what, unit, key) in [
            (spec.capacity, "a capacity", "N m", "capacity"),
            (spec.normal_force, "a force", "N", "normal_force"),
            (spec.effective_radius.map(|r| r * 1e3), "an effective radius", "mm", "effective_radius"),
        ] {
            good &= value.is_none_or(|v| self.positive(v, false, what, unit, &at(key)));
        }
        let peak = self.peak(spec.peak, place);
        let curve = spec.coefficient.as_ref().map(|c| self.friction_curve(c, &at("friction")));
        let pressed = [("normal_force", spec.normal_force), ("effective_radius", spec.effective_radius)];
        let scale = match (spec.capacity, &curve) {
            (Some(_), _) if pressed.iter().any(|p| p.1.is_some()) => {
                let message = "`capacity` and `normal_force` with `effective_radius` both say what it can hold";
                self.refuse(Code::Conflict, &at("capacity"), message, "keep the one that is known");
                return None;
            }
            (Some(capacity), _) => capacity,
            (None, None) => {
                let hint = "give `capacity`, or `friction` with `normal_force` and `effective_radius`";
                self.refuse(Code::MissingKey, &at("capacity"), "what it can hold is given half", hint);
                return None;
            }
            (None, Some(_)) => {
                for (key, _) in pressed.iter().filter(|p| p.1.is_none()) {
                    let message = format!("a coefficient of friction needs `{key}` to tell what the element can hold");
                    self.refuse(Code::MissingKey, &at(key), message, "or give `capacity`");
                }
                spec.normal_force? * spec.effective_radius?
            }
        };
        let curve = curve.unwrap_or_else(|| Some(Curve::constant(1.0))).filter(|_| good)?;
        let torque = Curve::new(curve.points().iter().map(|[x, y]| [*x, y * scale]).collect())?;
        Some(Friction { torque, peak: peak? })
    }

    fn friction_curve(&mut self, points: &[[f64; 2]], place: &str) -> Option<Curve> {
        let [[_, mu]] = points else { return self.curve_of_amounts(points, place) };
        self.positive(*mu, false, "a friction", "", place).then(|| Curve::constant(*mu))
    }

    /// Checks a loss table; its first row is the efficiency of operating points.
    pub fn loss_table(&mut self, spec: &GivenMesh, name: &str, place: &str) -> Option<(Efficiency, Vec<LossRow>)> {
        let rows: Vec<LossRow> = (spec.loss_table.as_ref()?.iter())
            .map(|r| LossRow {
                speed: r.speed,
                forward: r.forward,
                backward: r.backward,
                forward_torque: r.forward_torque.unwrap_or(0.0),
                backward_torque: r.backward_torque.unwrap_or(0.0),
            })
            .collect();
        let at = format!("{place}.loss_table");
        let others = [("efficiency", spec.efficiency.is_some()), ("geometry", spec.geometry.is_some())];
        for (key, _) in others.iter().filter(|o| o.1) {
            let message = format!("{}: `loss_table` and `{key}` both say what the mesh loses", clip(name));
            self.refuse(Code::Conflict, &format!("{place}.{key}"), message, "keep the one that is known");
        }
        let speeds: Vec<[f64; 2]> = rows.iter().map(|r| [r.speed, 0.0]).collect();
        let mut good = self.curve_of_amounts(&speeds, &at).is_some();
        let mut efficiencies = Vec::with_capacity(rows.len());
        for (k, row) in rows.iter().enumerate() {
            let at = format!("{at}[{k}]");
            for (value, key) in [(row.forward_torque, "forward_torque"), (row.backward_torque, "backward_torque")] {
                good &= self.positive(value, true, "a bearing torque", "N m", &format!("{at}.{key}"));
            }
            if self.finite(&[("forward", row.forward), ("backward", row.backward)], &at) {
                for (value, key) in [(row.forward, "forward"), (row.backward, "backward")] {
                    self.efficiency(&EfficiencySpec::from(value), &format_args!("{at}.{key}"));
                }
                let exact = |x: f64| Rational::from_f64(x).unwrap_or(Rational::ONE);
                efficiencies.push(Efficiency { forward: exact(row.forward), backward: exact(row.backward) });
            }
        }
        self.assume(name, "loss table given; operating points use the efficiencies of its first row");
        Some((efficiencies.into_iter().next().filter(|_| good)?, rows))
    }

    // ---- What happens ---------------------------------------------------------------------

    pub(super) fn scenario(&mut self, spec: &PlainScenario, scene: &Scene<'_>, place: String) -> Option<Scenario> {
        let end = self.end(spec, &place);
        let samples = spec.samples.unwrap_or(ScenarioSpec::SAMPLES);
        if !(2..=MOST_SAMPLES).contains(&samples) {
            let message = format!("{samples} samples: a motion has 2 to {MOST_SAMPLES} rows of output");
            self.refuse(Code::OutOfRange, &format!("{place}.samples"), message, "");
        }
        let fixed = self.held(&spec.fixed, &place);
        let initial_speeds = self.initial_speeds(spec, &fixed, &place);
        let mut initial_twists = Vec::new();
        for (name, twist) in &spec.initial_twists {
            let at = format!("{place}.initial_twists.{name}");
            self.finite(&[("", *twist)], &at);
            let found = self.position("shaft", "shaft", name, at.clone(), &scene.shafts);
            if found.is_some_and(|k| initial_twists.iter().any(|(j, _)| *j == k)) {
                let message = format!("the twist of `{}` is given twice", clip(name));
                self.refuse(Code::Conflict, &at, message, "give it once");
            }
            initial_twists.extend(found.map(|k| (k, *twist)));
        }
        let sources = self.sources(&spec.source, &fixed, scene.variators, &place);
        let controls = self.controls(&spec.variator, scene.variators, &sources, &place);
        let mut engagements = self.given_engagements(spec, scene, &place);
        let scheduled = self.scheduled(spec, scene, &place);
        let own: HashSet<_> = engagements.iter().map(|e| e.element).collect();
        engagements.extend(scheduled.into_iter().filter(|e| !own.contains(&e.element)));
        Some(Scenario {
            name: spec.name.clone(),
            start: spec.start.unwrap_or(0.0),
            end: end?,
            initial_speeds,
            initial_twists,
            fixed,
            sources,
            engagements,
            controls,
            samples: usize::try_from(samples).ok()?,
            place,
        })
    }

    fn end(&mut self, spec: &PlainScenario, place: &str) -> Option<f64> {
        let start = spec.start.unwrap_or(0.0);
        let given = [("start", Some(start)), ("duration", spec.duration), ("end", spec.end)];
        let given: Vec<_> = given.iter().filter_map(|(key, v)| Some((*key, (*v)?))).collect();
        if !self.finite(&given, place) {
            return None;
        }
        match (spec.duration, spec.end) {
            (Some(_), Some(_)) => {
                let message = "`duration` and `end` both say when it ends";
                self.refuse(Code::Conflict, &format!("{place}.end"), message, "keep one of the two");
                None
            }
            (None, None) => {
                let message = format!("scenario `{}` does not say how long it takes", clip(&spec.name));
                self.refuse(Code::MissingKey, &format!("{place}.duration"), message, "give `duration` or `end`");
                None
            }
            (Some(duration), None) => {
                let good = self.positive(duration, false, "a duration", "s", &format!("{place}.duration"));
                good.then_some(start + duration)
            }
            (None, Some(end)) if end <= start => {
                let message = format!("it ends at {end} s, which is not after its start at {start} s");
                self.refuse(Code::OutOfRange, &format!("{place}.end"), message, "are the two swapped?");
                None
            }
            (None, end) => end,
        }
    }

    fn held(&mut self, names: &[String], place: &str) -> Vec<MemberId> {
        let mut fixed = Vec::new();
        for (k, name) in names.iter().enumerate() {
            let place = format!("{place}.fixed[{k}]");
            let Some(id) = self.resolve(name, &place) else { continue };
            if fixed.contains(&id) {
                let message = format!("`{}` is held twice", clip(name));
                self.refuse(Code::HeldAndDriven, &place, message, "name it once");
            } else if id != FRAME {
                fixed.push(id);
            }
        }
        fixed
    }

    fn initial_speeds(&mut self, spec: &PlainScenario, fixed: &[MemberId], place: &str) -> Vec<(MemberId, f64)> {
        let mut all: Vec<(MemberId, f64)> = Vec::new();
        for (name, speed) in &spec.initial_speeds {
            let place = format!("{place}.initial_speeds.{name}");
            let good = self.finite(&[("", *speed)], &place);
            let Some(id) = self.resolve(name, &place).filter(|_| good) else { continue };
            let at_rest = id == FRAME || fixed.contains(&id);
            if at_rest && *speed != 0.0 {
                let message = format!("`{}` is held and cannot turn with {speed} rad/s at the start", clip(name));
                self.refuse(Code::HeldAndDriven, &place, message, "keep one of the two");
            } else if all.iter().any(|(m, _)| *m == id) {
                let message = format!("the speed of `{}` is given twice", clip(name));
                self.refuse(Code::HeldAndDriven, &place, message, "keep one of the two");
            } else if !at_rest {
                all.push((id, *speed));
            }
        }
        all
    }

    fn sources(
        &mut self,
        specs: &[PlainSource],
        fixed: &[MemberId],
        variators: &[Variator],
        place: &str,
    ) -> Vec<Source> {
        let mut names: HashSet<String> = specs.iter().filter_map(|s| s.name.clone()).collect();
        let mut given = HashSet::new();
        let mut prescribed: HashSet<MemberId> = HashSet::new();
        let mut all = Vec::new();
        for (k, spec) in specs.iter().enumerate() {
            let place = format!("{place}.source[{k}]");
            if let Some(name) = &spec.name {
                check_name(self, name, &format!("{place}.name"), false);
                if !given.insert(name) {
                    let message = format!("a second source of this scenario is called `{}`", clip(name));
                    self.refuse(Code::DuplicateName, &format!("{place}.name"), message, "give it another name");
                }
            }
            let at = format!("{place}.member");
            let machine = spec.machine.as_ref().map(|name| {
                let at = format!("{place}.machine");
                let found = self.driving(name, variators, &at);
                if found.is_some() && all.iter().any(|s: &Source| s.machine == found) {
                    let message = format!("two sources of this scenario are the machine `{}`", clip(name));
                    self.refuse(Code::Conflict, &at, message, "a machine does one thing; add up the torques");
                }
                found
            });
            let named = match (&spec.member, &machine) {
                (Some(name), None) => name.as_str(),
                (None, Some(_)) => "",
                (Some(_), Some(_)) => {
                    let message = "`member` and `machine` both say where it acts";
                    self.refuse(Code::Conflict, &at, message, "keep `machine` for what has its power from a bus");
                    continue;
                }
                (None, None) => {
                    let message = "this source does not say where it acts";
                    self.refuse(Code::MissingKey, &at, message, "give `member`, or `machine` for one of a variator");
                    continue;
                }
            };
            let (machine, member) = match machine {
                None => (None, self.resolve(named, &at)),
                Some(found) => (found, found.map(|[v, k]| variators[v].machines()[k].member)),
            };
            if member == Some(FRAME) {
                let message = "the frame is at rest; nothing drives it";
                self.refuse(Code::HeldAndDriven, &at, message, "name a member that turns");
            }
            if let (Some(_), Some(id)) = (&spec.speed, member.filter(|m| *m != FRAME)) {
                let name = clip(&self.members[id.0].name);
                let message = match fixed.contains(&id) {
                    true => Some(format!("`{name}` is held and has a prescribed speed")),
                    false if !prescribed.insert(id) => Some(format!("the speed of `{name}` is prescribed twice")),
                    false => None,
                };
                if let Some(message) = message {
                    self.refuse(Code::HeldAndDriven, &format!("{place}.speed"), message, "keep one of the two");
                }
            }
            let kind = self.source_kind(spec, &place);
            let name = spec.name.clone().unwrap_or_else(|| {
                let base = match &spec.machine {
                    Some(machine) => machine.clone(),
                    None => format!("{} {named}", title(spec)),
                };
                let numbered = (2..).map(|k| format!("{base} {k}"));
                let mut free = std::iter::once(base.clone()).chain(numbered).filter(|n| !names.contains(n));
                free.next().expect("numbers do not end")
            });
            names.insert(name.clone());
            if let (Some(member), Some(kind)) = (member, kind) {
                if machine.is_some() && matches!(kind, SourceKind::Vehicle { .. }) {
                    let at = format!("{place}.vehicle");
                    self.refuse(Code::Variator, &at, "a machine is no vehicle", "let the vehicle act on `member`");
                }
                all.push(Source { name, member, machine, kind, place });
            }
        }
        all
    }

    /// The machine of a name.
    fn driving(&mut self, name: &str, variators: &[Variator], place: &str) -> Option<[usize; 2]> {
        let machines =
            || variators.iter().enumerate().flat_map(|(v, of)| of.machines().iter().enumerate().map(move |m| (v, m)));
        if let Some((v, (k, _))) = machines().find(|(_, (_, m))| m.name == name) {
            return Some([v, k]);
        }
        let message = format!("no variator has a machine `{}`", clip(name));
        let d = Diagnostic::new(Code::UnknownName, place, message);
        self.report(d.suggest(name, machines().map(|(_, (_, m))| m.name.as_str())));
        None
    }

    /// What variators do.
    fn controls(
        &mut self,
        specs: &[PlainControl],
        variators: &[Variator],
        sources: &[Source],
        place: &str,
    ) -> Vec<Control> {
        let known: Vec<&str> = variators.iter().map(|v| v.name.as_str()).collect();
        let mut all: Vec<Control> = Vec::new();
        for (k, spec) in specs.iter().enumerate() {
            let place = format!("{place}.variator[{k}]");
            let at = format!("{place}.name");
            let found = self.position("variator", "variator", &spec.name, at.clone(), &known);
            let has_bus = found.is_some_and(|v| variators[v].has_bus());
            let kind = self.control(spec, found.map(|_| has_bus), &place);
            let Some(variator) = found else { continue };
            let name = clip(&spec.name);
            if all.iter().any(|c| c.variator == variator) {
                let message = format!("what `{name}` does is said twice");
                self.refuse(Code::Conflict, &at, message, "say it once");
                continue;
            }
            let driven = sources.iter().filter(|s| s.machine.is_some_and(|[v, _]| v == variator)).count();
            if has_bus && driven == variators[variator].machines().len() {
                let message = format!("all machines of `{name}` are sources, and its store is given beside them");
                let hint = "leave out the source of one machine, which then balances the bus, or leave out `store`";
                self.refuse(Code::Variator, &format!("{place}.store"), message, hint);
                continue;
            }
            all.extend(kind.map(|kind| Control { variator, kind, place }));
        }
        all
    }

    /// The one thing that is said of a variator; `has_bus`: if it is known, what it is.
    fn control(&mut self, spec: &PlainControl, has_bus: Option<bool>, place: &str) -> Option<ControlKind> {
        let key = |name: &str| format!("{place}.{name}");
        let given = [
            (spec.ratio.is_some(), "ratio", false),
            (spec.ratio_rate.is_some(), "ratio_rate", false),
            (spec.torque.is_some(), "torque", false),
            (spec.store.is_some(), "store", true),
        ];
        let given: Vec<_> = given.into_iter().filter(|k| k.0).map(|(_, name, of_bus)| (name, of_bus)).collect();
        let wants = match has_bus {
            Some(true) => "`store`; what its machines do is said by sources with `machine`",
            _ => "one of `ratio`, `ratio_rate` and `torque`",
        };
        match given[..] {
            [] => {
                let message = format!("what the variator `{}` does is not said", clip(&spec.name));
                self.refuse(Code::MissingKey, place, message, &format!("give {wants}"));
                return None;
            }
            [(first, _), (second, _), ..] => {
                let message = format!("`{first}` and `{second}` of one variator: one of them follows from the other");
                self.refuse(Code::Conflict, &key(second), message, &format!("give {wants}"));
                return None;
            }
            [(name, of_bus)] if has_bus.is_some_and(|has_bus| has_bus != of_bus) => {
                let message = match of_bus {
                    true => "`store` belongs to a bus, and this variator has none".to_owned(),
                    false => format!("`{name}` is of a variator with two members, and this one has machines on a bus"),
                };
                self.refuse(Code::Variator, &key(name), message, &format!("give {wants}"));
                return None;
            }
            [_] => {}
        }
        let stray = [
            (spec.initial_ratio.is_some() && spec.ratio_rate.is_none(), "initial_ratio", "`ratio_rate`"),
            (spec.inverse && spec.ratio.is_none() && spec.ratio_rate.is_none(), "inverse", "`ratio` or `ratio_rate`"),
        ];
        for (_, name, beside) in stray.into_iter().filter(|s| s.0) {
            let message = format!("`{name}` says something of {beside}, which is not given");
            self.refuse(Code::Variator, &key(name), message, "leave it out");
        }
        let inverse = spec.inverse;
        if let Some(s) = &spec.ratio {
            return Some(ControlKind::Ratio { ratio: self.signal(s, &key("ratio"))?, inverse });
        }
        if let Some(s) = &spec.ratio_rate {
            let rate = self.signal(s, &key("ratio_rate"));
            let Some(initial) = spec.initial_ratio else {
                let message = "the ratio changes at a rate, and where it begins is not given";
                self.refuse(Code::MissingKey, &key("initial_ratio"), message, "give `initial_ratio`");
                return None;
            };
            self.finite(&[("initial_ratio", initial)], place).then_some(())?;
            return Some(ControlKind::Rate { initial, rate: rate?, inverse });
        }
        if let Some(s) = &spec.torque {
            return Some(ControlKind::Torque(self.signal(s, &key("torque"))?));
        }
        let s = spec.store.as_ref()?;
        Some(ControlKind::Store(self.signal(s, &key("store"))?))
    }

    /// The one thing that a source is.
    fn source_kind(&mut self, spec: &PlainSource, place: &str) -> Option<SourceKind> {
        let given = given(spec);
        let hint = |verb: &str| format!("{verb} one of torque, speed, controller, linear, quadratic, vehicle, motor");
        match given.as_slice() {
            [_] => {}
            [] => {
                let message = "this source does not say what acts on its member";
                self.refuse(Code::MissingKey, place, message, &hint("give"));
                return None;
            }
            [first, second, ..] => {
                let message = format!("`{first}` and `{second}` in one source: a source is one thing");
                let hint = "keep one; a second [[scenario.source]] may act on the same member";
                self.refuse(Code::Conflict, &format!("{place}.{second}"), message, hint);
                return None;
            }
        }
        let at = format!("{place}.{}", given[0]);
        let or = |x: Option<f64>, usual: f64| x.unwrap_or(usual);
        if let Some(s) = &spec.torque {
            return Some(SourceKind::Torque(self.signal(s, &at)?));
        }
        if let Some(s) = &spec.speed {
            return Some(SourceKind::Speed(self.signal(s, &at)?));
        }
        if let Some(c) = &spec.controller {
            return self.controller(c, &at);
        }
        if let Some(l) = &spec.linear {
            let (torque, about, slope) = (or(l.torque, 0.0), or(l.about, 0.0), or(l.slope, 0.0));
            self.finite(&[("torque", torque), ("about", about), ("slope", slope)], &at);
            return Some(SourceKind::Linear { torque, about, slope });
        }
        if let Some(q) = &spec.quadratic {
            let (torque, about, factor) = (or(q.torque, 0.0), or(q.about, 0.0), or(q.factor, 0.0));
            self.finite(&[("torque", torque), ("about", about), ("factor", factor)], &at);
            return Some(SourceKind::Quadratic { torque, about, factor, even: q.even });
        }
        if let Some(v) = &spec.vehicle {
            let (final_drive, rolling) = (or(v.final_drive, 1.0), or(v.rolling, 0.0));
            let (drag_area, air_density) = (or(v.drag_area, 0.0), or(v.air_density, AIR));
            for (value, zero, what, unit, key) in [
                (v.mass, false, "a mass", "kg", "mass"),
                (v.wheel_radius * 1e3, false, "a wheel radius", "mm", "wheel_radius"),
                (rolling, true, "a rolling resistance", "", "rolling"),
                (drag_area, true, "a drag area", "m²", "drag_area"),
                (air_density, true, "a density", "kg/m³", "air_density"),
            ] {
                self.positive(value, zero, what, unit, &format!("{at}.{key}"));
            }
            if final_drive == 0.0 || !final_drive.is_finite() {
                let message = format!("a final drive of {final_drive}: it is a finite number, not zero");
                self.refuse(Code::OutOfRange, &format!("{at}.final_drive"), message, "");
            }
            let grade = self.signal_or(v.grade.as_ref(), 0.0, &format!("{at}.grade"))?;
            let (mass, wheel_radius) = (v.mass, v.wheel_radius);
            return Some(SourceKind::Vehicle {
                mass,
                wheel_radius,
                final_drive,
                rolling,
                drag_area,
                air_density,
                grade,
            });
        }
        let m = spec.motor.as_ref()?;
        let idle = vec![[0.0, 0.0]];
        let full_load = self.curve(&m.full_load, "rad/s", &format!("{at}.full_load"));
        let closed = self.curve(m.closed.as_ref().unwrap_or(&idle), "rad/s", &format!("{at}.closed"));
        let at = format!("{at}.throttle");
        let throttle = self.signal_or(m.throttle.as_ref(), 1.0, &at);
        if let Some(signal) = &throttle {
            self.within(signal, [0.0, 1.0], "a throttle", &at);
        }
        Some(SourceKind::Motor { full_load: full_load?, closed: closed?, throttle: throttle? })
    }

    fn controller(&mut self, c: &PlainController, place: &str) -> Option<SourceKind> {
        let [proportional, integral, derivative] =
            [c.proportional, c.integral, c.derivative].map(Option::unwrap_or_default);
        for (value, unit, key) in [
            (proportional, "N m s/rad", "proportional"),
            (integral, "N m/rad", "integral"),
            (derivative, "N m s²/rad", "derivative"),
        ] {
            self.positive(value, true, "a gain", unit, &format!("{place}.{key}"));
        }
        let setpoint = self.signal(&c.setpoint, &format!("{place}.setpoint"));
        let feed_forward = self.signal_or(c.feed_forward.as_ref(), 0.0, &format!("{place}.feed_forward"));
        Some(SourceKind::Controller {
            setpoint: setpoint?,
            feed_forward: feed_forward?,
            proportional,
            integral,
            derivative,
        })
    }

    /// Reports a signal that leaves its bounds, where that can be told.
    fn within(&mut self, signal: &Signal, [least, most]: [f64; 2], what: &str, place: &str) {
        let Some([low, high]) = range(signal) else { return };
        let out = if low < least { low } else { high };
        if low < least || high > most {
            let message = match least.is_finite() {
                true => format!("{what} of {out}: it lies from {least} to {most}"),
                false => format!("{what} of {out}: it is at most {most}"),
            };
            self.refuse(Code::OutOfRange, place, message, "");
        }
    }

    // ---- Shift elements over time ---------------------------------------------------------

    fn given_engagements(&mut self, spec: &PlainScenario, scene: &Scene<'_>, place: &str) -> Vec<Engagement> {
        let known: Vec<&str> = scene.elements.iter().map(|e| e.0).collect();
        let mut all: Vec<Engagement> = Vec::new();
        for (k, e) in spec.engagement.iter().enumerate() {
            let place = format!("{place}.engagement[{k}]");
            let at = format!("{place}.element");
            let signal = self.signal(&e.value, &format!("{place}.value"));
            if let Some(signal) = &signal {
                self.within(signal, [f64::NEG_INFINITY, 1.0], "an engagement", &format!("{place}.value"));
            }
            let name = clip(&e.element);
            let Some(id) = self.position("shift element", "shift_element", &e.element, at.clone(), &known) else {
                continue;
            };
            let element = ShiftElementId(id);
            if scene.elements[id].1 == ShiftElementKind::OneWay {
                let message = format!("`{name}` is a one-way clutch: it acts by itself, always");
                self.refuse(Code::ShiftElement, &at, message, "leave it out");
            } else if all.iter().any(|e| e.element == element) {
                let message = format!("the engagement of `{name}` is given twice");
                self.refuse(Code::Conflict, &at, message, "give it once");
            } else {
                all.extend(signal.map(|signal| Engagement { element, signal, place }));
            }
        }
        all
    }

    /// Engagements that follow from `state` or `gears`; one-way clutches act by themselves.
    fn scheduled(&mut self, spec: &PlainScenario, scene: &Scene<'_>, place: &str) -> Vec<Engagement> {
        let at = format!("{place}.gears");
        if spec.state.is_some() && spec.gears.is_some() {
            let message = "`state` and `gears` both say which elements are engaged";
            self.refuse(Code::Conflict, &at, message, "keep one of the two");
        }
        let shift = spec.shift_time.unwrap_or(0.0);
        if self.positive(shift, true, "a shift time", "s", &format!("{place}.shift_time"))
            && spec.shift_time.is_some()
            && spec.gears.is_none()
        {
            let message = "a shift time is given, but no gears to shift";
            self.refuse(Code::MissingKey, &at, message, "give `gears`, or leave out `shift_time`");
        }
        let known: Vec<&str> = scene.states.iter().map(|s| s.name.as_str()).collect();
        let in_state = spec.state.as_ref().map(|name| (0.0, name.clone(), format!("{place}.state")));
        let gears = spec.gears.iter().flatten().enumerate().map(|(k, (t, s))| (*t, s.clone(), format!("{at}[{k}][1]")));
        let mut schedule: Vec<(f64, usize)> = Vec::new();
        for (time, name, place) in in_state.into_iter().chain(gears) {
            schedule.extend(self.position("state", "state", &name, place, &known).map(|k| (time, k)));
        }
        if let Some(gears) = &spec.gears {
            let points: Vec<[f64; 2]> = gears.iter().map(|g| [g.0, 0.0]).collect();
            self.curve(&points, "s", &at);
            // The first is where it begins; only the others shift.
            let changes: Vec<f64> = points.iter().skip(1).map(|p| p[0]).collect();
            if let Some(k) = changes.windows(2).position(|w| w[0] < w[1] && w[0] + shift > w[1]) {
                let (now, next) = (changes[k], changes[k + 1]);
                let message = format!(
                    "a shift of {shift} s that begins at {now} s is not over at {next} s, when the next begins"
                );
                self.refuse(Code::OutOfRange, &format!("{at}[{}]", k + 2), message, "shorten `shift_time`");
            }
        }
        let place = if spec.gears.is_some() { at } else { format!("{place}.state") };
        let shifted = scene.elements.iter().enumerate().filter(|(_, e)| e.1 != ShiftElementKind::OneWay);
        let engaged = |state: usize, id| scene.states[state].engaged.contains(&id);
        shifted
            .map(|(k, _)| ShiftElementId(k))
            .filter(|id| schedule.iter().any(|(_, s)| engaged(*s, *id)))
            .map(|element| {
                let steps: Vec<(f64, bool)> = schedule.iter().map(|(t, s)| (*t, engaged(*s, element))).collect();
                Engagement { element, signal: shifting(&steps, shift), place: place.clone() }
            })
            .collect()
    }

    // ---- Values over time -----------------------------------------------------------------

    /// A signal, or a constant where none is given.
    fn signal_or(&mut self, spec: Option<&SignalSpec<f64>>, usual: f64, place: &str) -> Option<Signal> {
        match spec {
            Some(spec) => self.signal(spec, place),
            None => Some(Signal::Constant(usual)),
        }
    }

    fn signal(&mut self, spec: &SignalSpec<f64>, place: &str) -> Option<Signal> {
        let key = |key: &str| format!("{place}.{key}");
        let time = |at: &Option<Time>| at.plain().unwrap_or(0.0);
        match spec {
            SignalSpec::Constant(value) => self.finite(&[("", *value)], place).then_some(Signal::Constant(*value)),
            SignalSpec::Step { offset, height, at } => {
                let (offset, height, at) = (offset.unwrap_or(0.0), *height, time(at));
                let good = self.finite(&[("offset", offset), ("height", height), ("at", at)], place);
                good.then_some(Signal::Step { offset, height, at })
            }
            SignalSpec::Ramp { offset, height, at, duration } => {
                let (offset, height, at, duration) = (offset.unwrap_or(0.0), *height, time(at), duration.si());
                let good = self.finite(&[("offset", offset), ("height", height), ("at", at)], place)
                    & self.positive(duration, false, "the duration of a ramp", "s", &key("duration"));
                good.then_some(Signal::Ramp { offset, height, at, duration })
            }
            SignalSpec::Sine { offset, amplitude, frequency, phase, at, decay } => {
                let (offset, amplitude, at) = (offset.unwrap_or(0.0), *amplitude, time(at));
                let (frequency, phase) = (frequency.si(), phase.plain().unwrap_or(0.0));
                let decay = decay.plain().unwrap_or(0.0);
                let values = [("offset", offset), ("amplitude", amplitude), ("phase", phase), ("at", at)];
                let good = self.finite(&values, place)
                    & self.positive(frequency, true, "a frequency", "Hz", &key("frequency"))
                    & self.positive(decay, true, "a decay", "1/s", &key("decay"));
                good.then_some(Signal::Sine { offset, amplitude, frequency, phase, at, decay })
            }
            SignalSpec::Pulse { offset, amplitude, period, width, at } => {
                let (offset, amplitude, at) = (offset.unwrap_or(0.0), *amplitude, time(at));
                let (period, width) = (period.si(), width.unwrap_or(0.5));
                let inside = (0.0..=1.0).contains(&width);
                if !inside {
                    let message = format!("a width of {width}: it is the part of the period, from 0 to 1");
                    self.refuse(Code::OutOfRange, &key("width"), message, "");
                }
                let good = self.finite(&[("offset", offset), ("amplitude", amplitude), ("at", at)], place)
                    & self.positive(period, false, "a period", "s", &key("period"))
                    & inside;
                good.then_some(Signal::Pulse { offset, amplitude, period, width, at })
            }
            SignalSpec::Table { points, hold } => self.table(points.plain(), *hold, &key("points")),
            SignalSpec::Csv { file, time, value, hold } => {
                let points = self.columns(file, [time, value], &key("file"))?;
                self.table(points, *hold, &key("points"))
            }
            SignalSpec::Expression { formula } => self.formula(formula, place),
            SignalSpec::Product(of) => {
                let first = self.signal(&of.0, &format!("{place}.of[0]"));
                let second = self.signal(&of.1, &format!("{place}.of[1]"));
                Some(Signal::Product(Box::new([first?, second?])))
            }
        }
    }

    /// A table over time: of the same time are the two points of a jump.
    fn table(&mut self, points: Vec<[f64; 2]>, hold: bool, place: &str) -> Option<Signal> {
        let finite = points.iter().flatten().all(|x| x.is_finite());
        let rising = points.windows(2).all(|w| w[0][0] <= w[1][0]);
        if points.is_empty() || !finite || !rising {
            self.bad_points(&points, |a, b| a <= b, "s", place);
            return None;
        }
        Some(Signal::Table { points, hold })
    }

    /// The points of two columns of a table that the train names.
    fn columns(&mut self, file: &str, columns: [&str; 2], place: &str) -> Option<Vec<[f64; 2]>> {
        if !self.files.contains_key(file) {
            let text = (self.load)(file);
            self.files.insert(file.to_owned(), text);
        }
        let wrong = match &self.files[file] {
            Ok(text) => match csv::points(text, columns) {
                Ok(points) => return Some(points),
                Err(wrong) => wrong,
            },
            Err(why) => {
                let why = why.clone();
                self.refuse(Code::Unreadable, place, why, "");
                return None;
            }
        };
        for message in wrong {
            let hint = "a header row, then numbers; times in s that rise";
            self.refuse(Code::BadTable, place, format!("{}: {message}", clip(file)), hint);
        }
        None
    }

    fn formula(&mut self, text: &str, place: &str) -> Option<Signal> {
        let place = format!("{place}.formula");
        let parsed = match text.len() > MOST_FORMULA {
            true => Err(format!("it has {} characters, at most {MOST_FORMULA} are read", text.len())),
            false => Formula::parse(text),
        };
        match parsed {
            Err(why) => {
                let message = format!("\"{}\" is no formula: {}", clip(text), clip_line(&why));
                let hint = "it takes the time t, speeds such as w_sun or {w_P1.planet}, + - * / ^, PI, sin, exp, …";
                self.refuse(Code::BadFormula, &place, message, hint);
                None
            }
            Ok((formula, names)) => {
                if let Some(jump) = formula.jumps_with_speed() {
                    let message = format!(
                        "\"{}\" jumps at a speed, in `{}`: when that will be is not known beforehand",
                        clip(text),
                        clip(&jump)
                    );
                    let hint = "for a jump in time, let its argument be of `t` only, or take a table or a pulse; for one in speed, take a smooth step such as tanh(w_sun/0.1)";
                    self.refuse(Code::BadFormula, &place, message, hint);
                }
                let speeds: Vec<_> = names.iter().map(|name| self.resolve_in_text(name, &place)).collect();
                Some(Signal::Expression { formula, speeds: speeds.into_iter().collect::<Option<_>>()? })
            }
        }
    }

    /// The member of a name that stands within a text, where a suggestion cannot replace it.
    fn resolve_in_text(&mut self, name: &str, place: &str) -> Option<MemberId> {
        let before = self.diagnostics.len();
        let found = self.resolve(name, &place);
        // `w_mg-1` reads as the speed of `mg`, less one.
        let cut = |m: &&str| m.strip_prefix(name).is_some_and(|rest| rest.starts_with(|c: char| !c.is_alphanumeric()));
        let meant = self.members.iter().map(|m| m.name.as_str()).find(cut).map(str::to_owned);
        for d in self.diagnostics.iter_mut().skip(before) {
            d.replacement = None;
            d.hints.extend(meant.iter().map(|m| format!("if `{m}` is meant, write {{w_{m}}}")));
        }
        found
    }
}

/// Density of air unless given, kg/m³.
const AIR: f64 = 1.2;

/// What a source says of which it has exactly one, by the keys.
fn given(spec: &PlainSource) -> Vec<&'static str> {
    let all = [
        (spec.torque.is_some(), "torque"),
        (spec.speed.is_some(), "speed"),
        (spec.controller.is_some(), "controller"),
        (spec.linear.is_some(), "linear"),
        (spec.quadratic.is_some(), "quadratic"),
        (spec.vehicle.is_some(), "vehicle"),
        (spec.motor.is_some(), "motor"),
    ];
    all.into_iter().filter(|k| k.0).map(|k| k.1).collect()
}

/// What a source is called that was given no name, before its member.
fn title(spec: &PlainSource) -> &'static str {
    match given(spec).first() {
        Some(&"speed") => "speed of",
        Some(&"controller") => "controller on",
        Some(&"linear" | &"quadratic") => "load on",
        Some(&"vehicle") => "vehicle on",
        Some(&"motor") => "motor on",
        _ => "torque on",
    }
}

/// Engagement of an element that is closed or open from each time on, and takes `shift` to change.
fn shifting(steps: &[(f64, bool)], shift: f64) -> Signal {
    let value = |closed: bool| if closed { 1.0 } else { 0.0 };
    let mut points = Vec::new();
    for pair in steps.windows(2).filter(|w| w[0].1 != w[1].1) {
        let [(_, before), (time, after)] = [pair[0], pair[1]];
        points.extend([[time, value(before)], [time + shift, value(after)]]);
    }
    match points.is_empty() {
        true => Signal::Constant(value(steps.first().is_some_and(|s| s.1))),
        false => Signal::Table { points, hold: false },
    }
}

/// The least and the greatest value of a signal, where its form tells them.
fn range(signal: &Signal) -> Option<[f64; 2]> {
    let between = |a: f64, b: f64| [a.min(b), a.max(b)];
    Some(match signal {
        Signal::Constant(value) => [*value; 2],
        Signal::Step { offset, height, .. } | Signal::Ramp { offset, height, .. } => between(*offset, offset + height),
        Signal::Sine { offset, amplitude, .. } => between(offset - amplitude, offset + amplitude),
        Signal::Pulse { offset, amplitude, .. } => between(*offset, offset + amplitude),
        Signal::Table { points, .. } => {
            let of = |f: fn(f64, f64) -> f64| points.iter().map(|p| p[1]).reduce(f);
            [of(f64::min)?, of(f64::max)?]
        }
        Signal::Product(_) | Signal::Expression { .. } => return None,
    })
}

/// A number for a message: it may have come from other units.
fn shown(x: f64) -> f64 {
    let rounded = (x * 1e6).round() / 1e6;
    if rounded.is_finite() { rounded } else { x }
}

/// A parser's words on one line.
fn clip_line(text: &str) -> String {
    const MOST: usize = 160;
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() > MOST { line.chars().take(MOST).chain(['…']).collect() } else { line }
}
