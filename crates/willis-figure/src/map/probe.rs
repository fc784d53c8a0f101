//! What holds at any place of a map, between the points of its grid too.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use willis::diagnostic::Diagnostics;
use willis::model::Target;
use willis::study::{Axis, PointAnswer, PointAnswers, PointSetup, PointVerdict, TrainCache};
use willis::train::{MemberId, Operation, Train};
use willis::work::{self, Cancelled, Work};

use super::compiled::CompiledProbe;
use super::told::{PowerRole, Told};
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

/// Parts of a map that are worked off side by side.
const PARTS: usize = 8;

/// The limits, and the states between which the choice is, with their ratios where these are known.
pub type ShiftChoice = (Limits, Vec<(String, Option<f64>)>);

/// Answers at places of a map.
pub struct Probe<'q, 's> {
    question: &'q PointSetup<'s>,
    /// The quantities along the axes, with their units.
    axes: [(Target, String); 2],
    /// Of an automatic transmission: what limits the choice.
    choice: Option<ShiftChoice>,
    trains: TrainCache,
    /// Answers where all places are points of the train of the file.
    answers: Option<PointAnswers<'s>>,
    /// Compiled trains by state and quadrant of the map, and how often none was possible.
    compiled: HashMap<(Option<usize>, [bool; 2]), Result<CompiledProbe, usize>>,
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
    ways: Vec<PowerRole>,
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
    pub fn new(
        question: &'q PointSetup<'s>,
        axes: [&Axis; 2],
        choice: Option<ShiftChoice>,
    ) -> Result<Self, Diagnostics> {
        let target = |a: &Axis| Target::parse(&a.name, question.model()).map(|t| (t, a.unit.clone()));
        let targets = axes.map(target);
        let [x, y] = targets.map(|t| t.map_err(|d| Diagnostics::from_iter([*d])));
        let (trains, compiled, zones, loosest, seen) = Default::default();
        let axes = [x?, y?];
        let varies = axes.iter().any(|(target, _)| target.is_of_train());
        let answers = (!varies).then(|| PointAnswers::new(question.model().train()));
        Ok(Self { question, axes, choice, trains, answers, compiled, zones, loosest, seen })
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

    /// What holds at places, row by row. Where each takes long, rows are shared out by `work`.
    pub fn at_all(&mut self, rows: &[Vec<[f64; 2]>], work: &dyn Work) -> Result<Vec<Found>, Cancelled> {
        let train = self.question.model().train();
        let never_compiled = train.is_physical() || !train.variators().is_empty();
        if self.choice.is_none() && never_compiled {
            let (question, axes, seen) = (self.question, &self.axes, &self.seen);
            let unseen = |row: &[[f64; 2]]| -> Vec<[f64; 2]> {
                row.iter().filter(|place| !seen.contains_key(&place.map(f64::to_bits))).copied().collect()
            };
            let rows_unseen: Vec<Vec<[f64; 2]>> = rows.iter().map(|row| unseen(row)).collect();
            // Rows that lie side by side have much in common.
            let parts: Vec<&[Vec<[f64; 2]>]> = rows_unseen.chunks(rows_unseen.len().div_ceil(PARTS).max(1)).collect();
            let told = work::map(work, parts.len(), |k| {
                let mut trains = TrainCache::default();
                let mut part: Vec<Told> = vec![];
                let places = parts[k].iter().flatten().take_while(|_| !work.cancelled());
                let points = places.map(|place| asked(question, axes, *place, None, &mut trains));
                PointAnswers::each(points, false, |answer, _| {
                    part.push(Told::of(&answer, None));
                    work.advance(1);
                });
                part
            })?;
            if work.cancelled() {
                return Err(Cancelled);
            }
            // In their order, so that zones have the same numbers however the work was shared.
            for (place, told) in rows_unseen.iter().flatten().zip(told.into_iter().flatten()) {
                let found = self.noted(MapPoint::of(&told, None), told.ways);
                self.seen.insert(place.map(f64::to_bits), found);
            }
            work.advance(
                (rows.iter().map(Vec::len).sum::<usize>() - rows_unseen.iter().map(Vec::len).sum::<usize>()) as u64,
            );
            return Ok(rows.iter().flatten().map(|place| self.at(*place)).collect());
        }
        let mut all = vec![];
        for row in rows {
            if work.cancelled() {
                return Err(Cancelled);
            }
            all.extend(row.iter().map(|place| self.at(*place)));
            work.advance(row.len() as u64);
        }
        Ok(all)
    }

    fn ask(&mut self, place: [f64; 2]) -> Found {
        let (point, ways) = match self.choice.take() {
            None => {
                let told = self.told(place, None, None);
                (MapPoint::of(&told, None), told.ways)
            }
            Some(choice) => {
                let best = self.best(place, &choice);
                self.choice = Some(choice);
                best
            }
        };
        self.noted(point, ways)
    }

    /// A point with its zone.
    fn noted(&mut self, point: MapPoint, ways: Vec<PowerRole>) -> Found {
        let idle = ways.iter().filter(|w| **w == PowerRole::Idle).count();
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
    fn best(&mut self, place: [f64; 2], (limits, states): &ShiftChoice) -> (MapPoint, Vec<PowerRole>) {
        /// Efficiencies that differ by less are the same: the first state stays.
        const SAME: f64 = 1e-12;
        let mut best = (MapPoint::beyond(), vec![]);
        for (k, (state, ratio)) in states.iter().enumerate() {
            // Without any loss the input needs the least torque.
            let within = |r: f64| limits.hold(place[0] * r, place[1] / r);
            if !ratio.is_none_or(within) {
                continue;
            }
            let told = self.told(place, Some((k, state)), Some(limits.input));
            let Some([speed, torque]) = told.input else { continue };
            let new = MapPoint::of(&told, Some(k));
            if limits.hold(speed / RPM, torque) && new.efficiency > best.0.efficiency.map(|e| e + SAME) {
                best = (new, told.ways);
            }
        }
        best
    }

    /// Where the input of each state has its largest torque at its largest and at its least speed. Efficiencies are those
    /// near a place.
    pub fn corners(&mut self, near: [f64; 2]) -> Vec<[f64; 2]> {
        let Some((limits, states)) = self.choice.clone() else { return vec![] };
        let mut all = vec![];
        for (k, (state, _)) in states.iter().enumerate() {
            let told = self.told(near, Some((k, state)), Some(limits.input));
            let Some([speed, torque]) = told.input.map(|[w, t]| [w / RPM, t]) else { continue };
            if speed > 0.0 && torque > 0.0 {
                let at = |w: f64| [near[0] * w / speed, near[1] * limits.torque / torque];
                all.extend(limits.speed.map(at));
            }
        }
        all
    }

    /// What is to be known of a place in a state, and of that input.
    fn told(&mut self, place: [f64; 2], state: Option<(usize, &str)>, input: Option<MemberId>) -> Told {
        /// Places at which it is tried to compile: the first may lie on a border.
        const TRIES: usize = 3;
        let key = (state.map(|s| s.0), place.map(|x| x > 0.0));
        let plain = place.iter().all(|x| *x != 0.0);
        let tries = match self.compiled.get_mut(&key) {
            Some(Ok(compiled)) if plain => match compiled.at(&place) {
                Some(told) => return told,
                None => TRIES,
            },
            Some(Err(tries)) if plain => *tries,
            None if plain => 0,
            _ => TRIES,
        };
        let (train, operation) = match asked(self.question, &self.axes, place, state.map(|s| s.1), &mut self.trains) {
            Ok(asked) => asked,
            Err(wrong) => return Told::of(&PointAnswer::refused(wrong), input),
        };
        let answer = match &mut self.answers {
            Some(answers) => answers.numbers(&operation),
            None => PointAnswer::of(&train, &operation),
        };
        if tries < TRIES && answer.solution.is_some() && answer.is_unique() {
            let axes = self.axes.each_ref().map(|a| &a.0);
            let compiled = CompiledProbe::new(&train, &operation, &axes, &place, &answer, input);
            self.compiled.insert(key, compiled.ok_or(tries + 1));
        }
        Told::of(&answer, input)
    }
}

/// What is asked at a place of these axes, in a state where one is given.
fn asked(
    question: &PointSetup<'_>,
    axes: &[(Target, String); 2],
    place: [f64; 2],
    state: Option<&str>,
    trains: &mut TrainCache,
) -> Result<(Arc<Train>, Operation), Diagnostics> {
    let along = axes.iter().zip(place).map(|((target, unit), value)| (target, format!("{value} {unit}")));
    let mut settings: Vec<(&Target, String)> = along.map(|(t, v)| (t, v.trim_end().to_owned())).collect();
    settings.extend(state.map(|s| (&Target::State, s.to_owned())));
    question.at(&settings, trains)
}

impl MapPoint {
    fn beyond() -> Self {
        let none = None;
        Self { verdict: MapVerdict::Beyond, efficiency: none, input_power_w: none, loss_w: none, best: None, zone: 0 }
    }

    fn of(told: &Told, best: Option<usize>) -> Self {
        Self {
            verdict: MapVerdict::Point(told.verdict),
            efficiency: told.efficiency,
            input_power_w: told.input_power_w,
            loss_w: told.loss_w,
            best,
            zone: 0,
        }
    }
}
