//! The laws of friction of a design file: what its operations make of a train, and which trains they rank.
//!
//! A search ranks with the mesh efficiencies, which are the same at every load and speed. Where the file has teeth with a
//! geometry and operations, the laws say what each train really loses there, at a cost of some milliseconds a train. The
//! front under the laws need not lie within the front of the search, and no bound is known that would exclude the others. So
//! all trains are computed where there are few enough, and the answer holds for all of them; else only the front of the search
//! is, and the answer says so.

use willis::Model;
use willis::analysis::{OperationReport, Verdict, operate};
use willis::named::NameMap;
use willis::train::{FRAME, Load, Operation, Train};
use willis::work::Work;

use super::answer::{LawRow, OperationRow, RankedBy, Ranking, Recomputed, Stage};
use super::document::{Design, nth, tables};
use super::front::Front;
use super::search::{Judged, Needs, Progress, Teeth};
use super::wish::Objective;

/// So many trains are computed with the laws unless another number is asked for.
pub(crate) const MOST: u64 = 500;

/// What is known of one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// The least efficiency; 0 where friction locks or all power is lost.
    Least(f64),
    /// Nobody can tell.
    Open,
}

/// What laws make of a train.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Lawful {
    forward: Option<Way>,
    backward: Option<Way>,
    /// Operations that stand for either direction.
    names: [Vec<String>; 2],
    self_locking: bool,
    pub operations: NameMap<OperationRow>,
}

/// A train with both rankings.
#[derive(Clone, Debug)]
pub(crate) struct Ranked {
    pub teeth: Teeth,
    /// By the mesh efficiencies.
    pub judged: Judged,
    pub laws: Option<LawRow>,
    pub operations: NameMap<OperationRow>,
    /// By what ranks.
    pub value: Judged,
}

/// The trains of an answer and what ranked them.
pub(crate) struct Order {
    pub ranking: Ranking,
    /// Those that no other one beats, or all that satisfy the wish where these were asked for.
    pub trains: Vec<Ranked>,
    /// Points of those that no other one beats.
    pub front: Vec<Vec<f64>>,
    pub of_all: bool,
    pub interrupted: bool,
    /// What may be wished of efficiencies under the laws where nothing satisfies the demands: the objective, the demand, the
    /// best there is with the other one, how many there are.
    pub most: Vec<(Objective, f64, f64, u64)>,
    /// Where all trains were judged by the laws: how many satisfy each demand on efficiency and those before it.
    pub demands: Vec<(Objective, u64)>,
    /// Where demands were judged by mesh efficiencies that the laws may contradict: how many trains satisfy everything else.
    pub nominal: Option<u64>,
}

impl Lawful {
    /// What a train does in these operations. `targets` are the states whose efficiencies count.
    pub fn of(train: &Train, names: &[String], targets: &[&str]) -> Self {
        let mut found = Self::default();
        for operation in train.operations().iter().filter(|o| names.contains(&o.name)) {
            let report = operate(train, operation).ok().map(|(report, _)| report);
            let Some(report) = report else { continue };
            let only = match &report.solutions[..] {
                [one] if report.verdict == Verdict::Unique => Some(one),
                _ => None,
            };
            let row = OperationRow {
                verdict: report.verdict,
                efficiency: only.and_then(|s| s.efficiency),
                loss_w: only.map(|s| s.loss_w),
            };
            found.operations.0.push((operation.name.clone(), row));
            let state = operation.state.map_or("as drawn", |k| train.states()[k].name.as_str());
            if !train.is_physical() || !targets.contains(&state) {
                continue;
            }
            let Some(forward) = goes_forward(train, operation, &report) else { continue };
            let way = match report.verdict {
                Verdict::Unique => Way::Least(only.and_then(|s| s.efficiency).unwrap_or(0.0)),
                // The worst that may happen.
                Verdict::Multiple => {
                    let all = report.solutions.iter().map(|s| s.efficiency.unwrap_or(0.0));
                    Way::Least(all.fold(1.0, f64::min))
                }
                Verdict::Locked => Way::Least(0.0),
                _ => Way::Open,
            };
            found.self_locking |= !forward && report.verdict == Verdict::Locked;
            found.names[usize::from(!forward)].push(operation.name.clone());
            let own = if forward { &mut found.forward } else { &mut found.backward };
            *own = Some(match (*own, way) {
                (None, way) => way,
                (Some(Way::Least(a)), Way::Least(b)) => Way::Least(a.min(b)),
                _ => Way::Open,
            });
        }
        found
    }

    /// The train by the laws in the place of the mesh efficiencies, for the directions that the laws rank; none where nobody
    /// can tell one of them.
    fn value(&self, judged: &Judged, ranks: [bool; 2]) -> Option<Judged> {
        let mut value = judged.clone();
        let of = |way: Option<Way>| match way {
            Some(Way::Least(e)) => Some(e),
            _ => None,
        };
        if ranks[0] {
            value.forward = of(self.forward)?;
        }
        if ranks[1] {
            value.backward = of(self.backward)?;
            value.self_locking = self.self_locking;
        }
        Some(value)
    }

    fn row(&self, fails: Vec<String>) -> LawRow {
        let of = |way: Option<Way>| match way {
            Some(Way::Least(e)) if e > 0.0 => Some(e),
            _ => None,
        };
        LawRow { forward: of(self.forward), backward: of(self.backward), self_locking: self.self_locking, fails }
    }
}

/// Whether an operation sends power from the input of its state to its output; none where it does neither. What is
/// prescribed decides, so that it is known of a train that locks, too.
fn goes_forward(train: &Train, operation: &Operation, report: &OperationReport) -> Option<bool> {
    let [input, output] = train.ends(operation.state);
    let speed = |m: usize| report.speeds_rad_s.get(&train.members()[m].name).copied().flatten();
    let mut found = None;
    for (member, load) in operation.loads.iter().filter(|l| l.0 != FRAME) {
        let power = match load {
            Load::Power(p) => p.si(),
            Load::Torque(t) => t.si() * speed(member.index())?,
        };
        let is_input = Some(*member) == input;
        if power == 0.0 || !is_input && Some(*member) != output {
            continue;
        }
        let forward = (power > 0.0) == is_input;
        if found.is_some_and(|f| f != forward) {
            return None;
        }
        found = Some(forward);
    }
    found
}

impl Design {
    /// The operations of the file.
    pub(crate) fn operation_names(&self) -> Vec<String> {
        let all = self.template.get("operation");
        let name = |k: usize| nth(all?, k)?.get("name").and_then(toml_edit::Item::as_str).map(str::to_owned);
        (0..tables(all)).filter_map(name).collect()
    }

    /// The states whose efficiencies count.
    pub(crate) fn target_states(&self) -> Vec<&str> {
        self.targets.iter().map(|t| t.1.state.as_str()).collect()
    }

    /// The operations of the file at tooth numbers, with its laws.
    fn lawful(&self, teeth: &Teeth, names: &[String]) -> Lawful {
        if names.is_empty() {
            return Lawful::default();
        }
        match Model::from_toml(&self.text_of(teeth, None)) {
            Ok(model) => Lawful::of(model.train(), names, &self.target_states()),
            Err(_) => Lawful::default(),
        }
    }

    /// Trains with what the laws make of each; none where the work was cancelled.
    fn with_laws(&self, trains: Vec<(Teeth, Judged)>, work: &dyn Work) -> Option<Vec<(Teeth, Judged, Lawful)>> {
        let names = self.operation_names();
        work.begin("trains with the laws", trains.len() as u64);
        let laws = willis::work::map(work, trains.len(), |k| {
            let laws = self.lawful(&trains[k].0, &names);
            work.advance(1);
            laws
        });
        Some(trains.into_iter().zip(laws.ok()?).map(|((teeth, judged), laws)| (teeth, judged, laws)).collect())
    }

    /// The train of the user, ranked like the others.
    pub(crate) fn with_own_laws(&self, judged: &Judged, laws: &Lawful, ranking: &Ranking) -> (Judged, Option<LawRow>) {
        let ranks = [!ranking.forward.is_empty(), !ranking.backward.is_empty()];
        if ranks == [false; 2] {
            return (judged.clone(), None);
        }
        let value = laws.value(judged, ranks).unwrap_or_else(|| judged.clone());
        let row = laws.row(self.demands_missed(&value));
        (if ranking.by == RankedBy::Laws { value } else { judged.clone() }, Some(row))
    }

    /// What the laws make of one train, and its operations.
    pub(crate) fn row_with_laws(&self, teeth: &Teeth, judged: &Judged) -> (Option<LawRow>, NameMap<OperationRow>) {
        let laws = self.lawful(teeth, &self.operation_names());
        let ranks = [laws.forward.is_some(), laws.backward.is_some()];
        let value = laws.value(judged, ranks).unwrap_or_else(|| judged.clone());
        let row = (ranks != [false; 2]).then(|| laws.row(self.demands_missed(&value)));
        (row, laws.operations)
    }

    /// What ranks where nothing was ranked.
    pub(crate) fn unranked(&self) -> Ranking {
        let mut ranking = Ranking {
            by: RankedBy::MeshEfficiencies,
            forward: vec![],
            backward: vec![],
            recomputed: Recomputed::None,
            trains: 0,
            satisfy: None,
            open: 0,
            front_before: 0,
            words: String::new(),
        };
        ranking.words = self.words(&ranking);
        ranking
    }

    fn demands_missed(&self, value: &Judged) -> Vec<String> {
        let demands =
            [("forward", self.require.forward, value.forward), ("backward", self.require.backward, value.backward)];
        demands.into_iter().filter(|(_, least, own)| least.is_some_and(|l| *own < l)).map(|d| d.0.to_owned()).collect()
    }

    /// How many trains satisfy everything but demands on efficiency, at most.
    fn before_demands(&self, progress: &Progress) -> u64 {
        let stage = match progress.waterfall.iter().position(Stage::is_demand) {
            Some(0) | None => progress.waterfall.last(),
            Some(k) => progress.waterfall.get(k - 1),
        };
        stage.map_or(0, |s| s.trains)
    }

    /// Which trains are the best, and by which losses: all of them with the laws where there are at most so many.
    pub(crate) fn order(
        &self,
        progress: &Progress,
        asked: (Objective, usize, bool),
        most: u64,
        work: &dyn Work,
    ) -> Order {
        let (sort, top, all) = asked;
        let complete = progress.is_complete();
        let judged = |teeth: &Teeth| Some((teeth.clone(), self.judge(teeth, Needs::ALL)?));
        let names = self.operation_names();
        let lies_before = self.before_demands(progress);
        let few = complete && most > 0 && !names.is_empty() && (1..=most).contains(&lies_before);
        let ranks = |teeth: Option<&Teeth>| {
            let laws = teeth.map(|t| self.lawful(t, &names));
            laws.map_or([false; 2], |l| [l.forward.is_some(), l.backward.is_some()])
        };
        let demanded = self.require.forward.is_some() || self.require.backward.is_some();
        let is_nominal = demanded && !names.is_empty() && self.is_computed();
        let mut ranked = ranks(progress.front.first());
        if few && (ranked != [false; 2] || progress.front.is_empty()) {
            let mut open = self.clone();
            open.require.forward = None;
            open.require.backward = None;
            let mut trains = vec![];
            if open.for_each_that_meets(Needs::ALL, work, &mut |teeth, judged| trains.push((teeth, judged))) {
                ranked = ranks(trains.first().map(|t| &t.0));
                if ranked != [false; 2]
                    && let Some(found) = self.with_laws(trains, work)
                {
                    return self.by_laws(found, ranked, (sort, all), progress);
                }
            }
        }
        let ranks = ranked;
        let has_laws = most > 0 && ranks != [false; 2];
        let best = if all && complete { self.best(sort, top, work) } else { None };
        let of_all = best.is_some();
        let interrupted = all && complete && !of_all;
        let shown = best.unwrap_or_else(|| progress.front.clone());
        let mut trains: Vec<(Teeth, Judged)> = shown.iter().filter_map(judged).collect();
        self.sort(&mut trains, sort, |t| &t.1, |t| &t.0);
        let points = |list: &[(Teeth, Judged)]| list.iter().map(|t| self.point(&t.1, &t.0)).collect::<Vec<_>>();
        let front = if of_all {
            points(&progress.front.iter().filter_map(judged).collect::<Vec<_>>())
        } else {
            points(&trains)
        };
        let is_front = has_laws && !of_all && trains.len() as u64 <= most;
        if !is_front {
            trains.truncate(top);
        }
        let count = trains.len() as u64;
        let all: Vec<(Teeth, Judged, Lawful)> = match self.with_laws(trains.clone(), work) {
            Some(all) => all,
            None => trains.into_iter().map(|(t, j)| (t, j, Lawful::default())).collect(),
        };
        let stopped = all.iter().any(|t| t.2.operations.0.is_empty()) && work.cancelled();
        let mut ranking = Ranking {
            by: RankedBy::MeshEfficiencies,
            forward: vec![],
            backward: vec![],
            recomputed: if has_laws { Recomputed::Shown } else { Recomputed::None },
            trains: if has_laws { count } else { 0 },
            satisfy: None,
            open: 0,
            front_before: progress.front.len() as u64,
            words: String::new(),
        };
        if has_laws {
            self.name_operations(&all, &mut ranking);
        }
        let by_laws = is_front && !stopped && count > 0;
        if by_laws {
            (ranking.by, ranking.recomputed) = (RankedBy::Laws, Recomputed::Front);
        }
        let mut trains: Vec<Ranked> = all
            .into_iter()
            .map(|(teeth, judged, laws)| {
                let value = if has_laws { laws.value(&judged, ranks) } else { None };
                ranking.open += u64::from(by_laws && value.is_none());
                let row = has_laws.then(|| laws.row(value.as_ref().map_or(vec![], |v| self.demands_missed(v))));
                let value = match value {
                    Some(value) if by_laws => value,
                    // Of these the laws say nothing: they come last.
                    None if by_laws => Judged { forward: 0.0, backward: 0.0, ..judged.clone() },
                    _ => judged.clone(),
                };
                Ranked { teeth, judged, laws: row, operations: laws.operations, value }
            })
            .collect();
        if by_laws {
            let met = trains.iter().filter(|t| t.laws.as_ref().is_some_and(|l| l.fails.is_empty())).count() as u64;
            ranking.satisfy = Some(met - ranking.open.min(met));
            self.sort(&mut trains, sort, |t| &t.value, |t| &t.teeth);
        }
        ranking.words = self.words(&ranking);
        let front = if by_laws { trains.iter().map(|t| self.point(&t.value, &t.teeth)).collect() } else { front };
        let nominal = is_nominal.then_some(lies_before);
        Order { ranking, trains, front, of_all, interrupted, most: vec![], demands: vec![], nominal }
    }

    /// All trains by the laws.
    fn by_laws(
        &self,
        found: Vec<(Teeth, Judged, Lawful)>,
        ranks: [bool; 2],
        (sort, all): (Objective, bool),
        progress: &Progress,
    ) -> Order {
        let mut ranking = Ranking {
            by: RankedBy::Laws,
            forward: vec![],
            backward: vec![],
            recomputed: Recomputed::All,
            trains: found.len() as u64,
            satisfy: None,
            open: 0,
            front_before: progress.front.len() as u64,
            words: String::new(),
        };
        self.name_operations(&found, &mut ranking);
        let mut settled: Vec<Ranked> = vec![];
        for (teeth, judged, laws) in found {
            let Some(value) = laws.value(&judged, ranks) else {
                ranking.open += 1;
                continue;
            };
            let laws_row = laws.row(self.demands_missed(&value));
            settled.push(Ranked { teeth, judged, laws: Some(laws_row), operations: laws.operations, value });
        }
        // How far each demand would have to give, the other one unchanged.
        let demands = [(Objective::Forward, self.require.forward), (Objective::Backward, self.require.backward)];
        let mut most = vec![];
        if settled.iter().all(|t| !self.demands_missed(&t.value).is_empty()) {
            for (objective, least) in demands {
                let Some(least) = least else { continue };
                let others =
                    settled.iter().filter(|t| self.demands_missed(&t.value).iter().all(|d| d == objective.name()));
                let values: Vec<f64> = others.map(|t| self.value(objective, &t.value, &t.teeth)).collect();
                if let Some(best) = values.iter().copied().reduce(f64::max) {
                    most.push((objective, least, best, values.len() as u64));
                }
            }
        }
        let mut counts = vec![];
        let mut left: Vec<&Ranked> = settled.iter().collect();
        for (objective, _) in demands.into_iter().filter(|d| d.1.is_some()) {
            left.retain(|t| !self.demands_missed(&t.value).iter().any(|d| d == objective.name()));
            counts.push((objective, left.len() as u64));
        }
        settled.retain(|t| t.laws.as_ref().is_some_and(|l| l.fails.is_empty()));
        ranking.satisfy = Some(settled.len() as u64);
        let mut front = Front::default();
        for (k, t) in settled.iter().enumerate() {
            front.offer(self.point(&t.value, &t.teeth), k);
        }
        let front = front.into_sorted();
        let points: Vec<Vec<f64>> = front.iter().map(|f| f.0.clone()).collect();
        let mut trains: Vec<Ranked> =
            if all { settled } else { front.iter().map(|(_, k)| settled[*k].clone()).collect() };
        self.sort(&mut trains, sort, |t| &t.value, |t| &t.teeth);
        ranking.words = self.words(&ranking);
        Order { ranking, trains, front: points, of_all: all, interrupted: false, most, demands: counts, nominal: None }
    }

    fn name_operations(&self, all: &[(Teeth, Judged, Lawful)], ranking: &mut Ranking) {
        let names = self.operation_names();
        let of = |k: usize| {
            let is_used = |n: &&String| all.iter().any(|t| t.2.names[k].contains(n));
            names.iter().filter(is_used).cloned().collect()
        };
        (ranking.forward, ranking.backward) = (of(0), of(1));
    }

    /// By an objective, then by teeth.
    fn sort<T>(&self, all: &mut [T], sort: Objective, judged: impl Fn(&T) -> &Judged, teeth: impl Fn(&T) -> &Teeth) {
        let value = |t: &T| {
            let value = self.value(sort, judged(t), teeth(t));
            if sort.is_better_high() { -value } else { value }
        };
        all.sort_by(|a, b| value(a).total_cmp(&value(b)).then_with(|| teeth(a).cmp(teeth(b))));
    }

    /// Whether laws compute tooth friction of a train of this design.
    fn is_computed(&self) -> bool {
        self.sets.iter().any(|s| s.has_geometry && !s.has_losses)
    }

    /// Which losses ranked, in words.
    fn words(&self, ranking: &Ranking) -> String {
        let given = if self.is_computed() {
            "nominal mesh efficiencies, those of one choice of teeth, whatever the load and speed are (the columns of a row are those \
             of its own teeth)"
        } else {
            "the mesh efficiencies of the file, whatever the load and speed are"
        };
        let list = |names: &[String]| names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
        let ways: Vec<String> = [("forward", &ranking.forward), ("backward", &ranking.backward)]
            .into_iter()
            .filter(|w| !w.1.is_empty())
            .map(|(way, names)| format!("{way} the least of {}", list(names)))
            .collect();
        let ways = ways.join("; ");
        let kept = match (ranking.forward.is_empty(), ranking.backward.is_empty()) {
            (false, false) => "",
            (true, _) => "; forward efficiencies remain those of the meshes",
            (_, true) => "; backward efficiencies remain those of the meshes",
        };
        let open = match ranking.open {
            0 => String::new(),
            1 => "; of 1 the laws give no single answer".to_owned(),
            n => format!("; of {n} the laws give no single answer"),
        };
        match (ranking.by, ranking.recomputed) {
            (RankedBy::Laws, Recomputed::All) => {
                let many = match ranking.trains {
                    1 => "the one train that satisfies".to_owned(),
                    n => format!("all {n} trains that satisfy"),
                };
                format!(
                    "the laws of friction of the file in its operations ({ways}{kept}), for {many} every wish that does not \
                     depend on them{open}; so the rows are the best under the laws, too"
                )
            }
            (RankedBy::Laws, _) => format!(
                "the laws of friction of the file in its operations ({ways}{kept}), for the {} trains that no other one beats \
                 with {given}{open}; trains that were beaten there were not computed with the laws and may be better under them",
                ranking.trains
            ),
            (RankedBy::MeshEfficiencies, Recomputed::Shown) => {
                format!("{given}; the laws of friction were computed for the rows that are shown, and rank nothing")
            }
            (RankedBy::MeshEfficiencies, _) => given.to_owned(),
        }
    }
}
