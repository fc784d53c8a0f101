//! What holds at any place of a map, between the points of its grid too.

use std::collections::{BTreeMap, HashMap};

use willis::analysis::Role;
use willis::diagnostic::Diagnostics;
use willis::model::Target;
use willis::study::{Axis, PointAnswer, PointVerdict, Question, Trains};
use willis::train::MemberId;

use crate::parts::axes::RPM;
use crate::{MapPoint, MapVerdict};

/// Within what the input of an automatic transmission stays.
#[derive(Clone, Copy)]
pub struct Limits {
    /// The input.
    pub input: MemberId,
    /// Its least and its largest speed, rpm.
    pub speed: [f64; 2],
    /// Its largest torque, N m.
    pub torque: f64,
}

impl Limits {
    fn hold(&self, speed: f64, torque: f64) -> bool {
        let [least, most] = self.speed;
        let turns = speed > 0.0 && speed >= least * (1.0 - 1e-9) && speed <= most * (1.0 + 1e-9);
        turns && torque <= self.torque * (1.0 + 1e-9)
    }
}

/// The limits, and the states between which the choice is, with their ratios where these are known.
pub type Choice = (Limits, Vec<(String, Option<f64>)>);

/// Answers at places of a map.
pub struct Probe<'q, 's> {
    question: &'q Question<'s>,
    /// The quantities along the axes, with their units.
    axes: [(Target, String); 2],
    /// Of an automatic transmission: what limits the choice.
    choice: Option<Choice>,
    trains: Trains,
    /// The zones that were met; a zone's number is its place here.
    zones: Vec<Zone>,
    loosest: Loosest,
    /// Answers by the bits of their places: lines that are added to a grid leave most of it as it was.
    seen: HashMap<[u64; 2], Found>,
}

/// What all points of a zone have in common.
#[derive(PartialEq)]
struct Zone {
    verdict: MapVerdict,
    best: Option<usize>,
    /// Empty where there is no efficiency: there power goes nowhere.
    ways: Vec<Way>,
}

/// Which way power goes through a part.
#[derive(PartialEq)]
enum Way {
    /// It neither gives nor takes power.
    Idle,
    /// A member at which power comes in.
    Input,
    /// A member at which power goes out.
    Output,
    /// A member that only passes power on, or is held.
    Passes,
    /// A mesh that this member drives.
    Driver(String),
    /// A machine of a variator that gives power.
    Motors,
    /// A machine of a variator that takes power.
    Generates,
}

/// A point of a map as it was found.
#[derive(Clone)]
pub struct Found {
    pub point: MapPoint,
    /// How many parts neither give nor take power.
    idle: usize,
}

/// In how few idle parts each state was seen, by its position.
#[derive(Clone, Default)]
pub struct Loosest(BTreeMap<Option<usize>, usize>);

impl Loosest {
    /// Whether a point lies exactly where a part changes the direction of its power: more is idle than elsewhere.
    pub fn on_border(&self, found: &Found) -> bool {
        match found.point.verdict {
            MapVerdict::Point(PointVerdict::Unloaded) => true,
            MapVerdict::Point(PointVerdict::Unique) => {
                self.0.get(&found.point.best).is_some_and(|least| found.idle > *least)
            }
            _ => false,
        }
    }
}

impl<'q, 's> Probe<'q, 's> {
    pub fn new(question: &'q Question<'s>, axes: [&Axis; 2], choice: Option<Choice>) -> Result<Self, Diagnostics> {
        let target = |a: &Axis| Target::parse(&a.name, question.model()).map(|t| (t, a.unit.clone()));
        let targets = axes.map(target);
        let [x, y] = targets.map(|t| t.map_err(|d| Diagnostics::from_iter([*d])));
        let (trains, zones, loosest, seen) = Default::default();
        Ok(Self { question, axes: [x?, y?], choice, trains, zones, loosest, seen })
    }

    /// The least count of idle parts in what was found so far.
    pub fn loosest(&self) -> Loosest {
        self.loosest.clone()
    }

    /// What holds at a place.
    pub fn at(&mut self, place: [f64; 2]) -> Found {
        let key = place.map(f64::to_bits);
        if let Some(found) = self.seen.get(&key) {
            return found.clone();
        }
        let found = self.ask(place);
        self.seen.insert(key, found.clone());
        found
    }

    fn ask(&mut self, place: [f64; 2]) -> Found {
        let (point, ways) = match self.choice.take() {
            None => {
                let answer = self.answer(place, None);
                (MapPoint::of(&answer, None), ways(&answer))
            }
            Some(choice) => {
                let best = self.best(place, &choice);
                self.choice = Some(choice);
                best
            }
        };
        let idle = ways.iter().filter(|w| **w == Way::Idle).count();
        if point.verdict == MapVerdict::Point(PointVerdict::Unique) {
            let least = self.loosest.0.entry(point.best).or_insert(idle);
            *least = idle.min(*least);
        }
        let ways = if point.efficiency.is_some() { ways } else { vec![] };
        let own = Zone { verdict: point.verdict, best: point.best, ways };
        let zone = self.zones.iter().position(|z| *z == own).unwrap_or_else(|| {
            self.zones.push(own);
            self.zones.len() - 1
        });
        Found { point: MapPoint { zone, ..point }, idle }
    }

    /// The state that loses least of those within the limits.
    fn best(&mut self, place: [f64; 2], (limits, states): &Choice) -> (MapPoint, Vec<Way>) {
        /// Efficiencies that differ by less are the same: the first state stays.
        const SAME: f64 = 1e-12;
        let mut best = (MapPoint::beyond(), vec![]);
        for (k, (state, ratio)) in states.iter().enumerate() {
            // Without any loss the input needs the least torque.
            let within = |r: f64| limits.hold(place[0] * r, place[1] / r);
            if !ratio.is_none_or(within) {
                continue;
            }
            let answer = self.answer(place, Some(state));
            let Some([speed, torque]) = self.input(&answer, limits.input) else { continue };
            let new = MapPoint::of(&answer, Some(k));
            if limits.hold(speed, torque) && new.efficiency > best.0.efficiency.map(|e| e + SAME) {
                best = (new, ways(&answer));
            }
        }
        best
    }

    /// Where the input of each state has its largest torque at its largest and at its least speed. Efficiencies are those
    /// near a place.
    pub fn corners(&mut self, near: [f64; 2]) -> Vec<[f64; 2]> {
        let Some((limits, states)) = self.choice.clone() else { return vec![] };
        let mut all = vec![];
        for (state, _) in &states {
            let answer = self.answer(near, Some(state));
            let Some([speed, torque]) = self.input(&answer, limits.input) else { continue };
            if speed > 0.0 && torque > 0.0 {
                let at = |w: f64| [near[0] * w / speed, near[1] * limits.torque / torque];
                all.extend(limits.speed.map(at));
            }
        }
        all
    }

    /// Speed and torque of the input, rpm and N m.
    fn input(&self, answer: &PointAnswer, input: MemberId) -> Option<[f64; 2]> {
        let name = self.question.model().train().member_name(input);
        let m = answer.solution.as_ref()?.members.get(name)?;
        Some([m.speed_rad_s? / RPM, m.torque_n_m?])
    }

    fn answer(&mut self, place: [f64; 2], state: Option<&str>) -> PointAnswer {
        let along = self.axes.iter().zip(place).map(|((target, unit), value)| (target, format!("{value} {unit}")));
        let mut settings: Vec<(&Target, String)> = along.map(|(t, v)| (t, v.trim_end().to_owned())).collect();
        settings.extend(state.map(|s| (&Target::State, s.to_owned())));
        match self.question.at(&settings, &mut self.trains) {
            Ok((train, operation)) => PointAnswer::of(&train, &operation),
            Err(wrong) => PointAnswer::refused(wrong),
        }
    }
}

impl MapPoint {
    fn beyond() -> Self {
        let none = None;
        Self { verdict: MapVerdict::Beyond, efficiency: none, input_power_w: none, loss_w: none, best: None, zone: 0 }
    }

    fn of(answer: &PointAnswer, best: Option<usize>) -> Self {
        let s = answer.solution.as_ref().filter(|_| answer.is_unique());
        Self {
            verdict: MapVerdict::Point(answer.verdict),
            efficiency: s.and_then(|s| s.efficiency),
            input_power_w: s.map(|s| s.input_power_w),
            loss_w: s.map(|s| s.loss_w),
            best,
            zone: 0,
        }
    }
}

/// Which way power goes through every part that can change it.
fn ways(answer: &PointAnswer) -> Vec<Way> {
    let Some(s) = &answer.solution else { return vec![] };
    let members = s.members.iter().map(|(_, m)| match m.role {
        Role::Input => Way::Input,
        Role::Output => Way::Output,
        Role::Idle => Way::Idle,
        _ => Way::Passes,
    });
    let meshes = s.meshes.iter().map(|(_, m)| m.driver.clone().map_or(Way::Idle, Way::Driver));
    let machines = s.variators.iter().flat_map(|(_, v)| v.machines.iter()).map(|(_, m)| match m.power_w {
        w if w > 0.0 => Way::Motors,
        w if w < 0.0 => Way::Generates,
        _ => Way::Idle,
    });
    members.chain(meshes).chain(machines).collect()
}
