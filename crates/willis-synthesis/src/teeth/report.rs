//! From a finished search to the answer: rows with certificates, words, and train files.

use willis::Model;
use willis::analysis::{Selection, StateReport, Verdict, analyze};
use willis::contract::Format;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::named::NameMap;
use willis::work::Work;

use super::answer::{
    Completeness, DesignAnswer, DesignRow, Ranking, Recomputed, Relaxation, SetRange, SetRow, Space, Stage, StateRow,
};
use super::document::{Design, WIDTH_IN_MODULES, give_geometry, substitute};
use super::fit::Phase;
use super::search::{Judged, Progress, Teeth};
use super::wish::Objective;

/// What of an answer is wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Request {
    /// So many rows at most; 20 where it is none.
    pub top: Option<usize>,
    /// What rows are sorted by; the first objective where it is none.
    pub sort: Option<Objective>,
    /// Only a part of the space: its number from 1, of how many.
    pub shard: Option<(u64, u64)>,
    /// Rows of all trains that satisfy the wish, not only of the front.
    pub all: bool,
    /// A train that exists: the name of its file and its text.
    pub own: Option<(String, String)>,
    /// So many trains at most are computed with the laws of friction of the file, so that these rank them; 500 where it is
    /// none, and with 0 only mesh efficiencies rank.
    pub recompute: Option<u64>,
}

impl Design {
    /// Searches the whole space and answers.
    ///
    /// # Errors
    /// The space is too large, or takes longer than the work's patience.
    ///
    /// # Example
    /// A ratio of 100 from a Wolfrom drive: no other train of this space has it within 1 %.
    /// ```
    /// use willis::work::Serial;
    /// use willis_synthesis::teeth::{Design, Request};
    ///
    /// let design = Design::from_toml(r#"
    ///     format = 1
    ///     name = "robot"
    ///     members = ["sun", "carrier", "ring"]
    ///     terminals = ["sun", "ring"]
    ///     design = { planets = "3", target = [{ ratio = 100, any_sign = true }], minimize = ["ring_diameter"], maximize = ["forward"] }
    ///
    ///     [[set]]
    ///     name = "P1"
    ///     type = "stepped"
    ///     suns = [{ member = "sun", teeth = "12..20", planet_teeth = "12..30" }]
    ///     rings = [
    ///         { member = "frame", teeth = "..70", planet_teeth = "12..30" },
    ///         { member = "ring", teeth = "..70", planet_teeth = "12..30" },
    ///     ]
    ///     carrier = "carrier"
    ///     mesh_efficiency = { external = 0.98, internal = 0.99 }
    /// "#)?;
    /// let answer = design.answer(&Request::default(), &Serial)?;
    /// assert!(answer.completeness.complete);
    /// assert!(answer.rows.iter().all(|r| r.certified && r.forward.unwrap() < 0.75));
    /// let train = willis::Model::from_toml(&design.train_file(&answer.rows[0]))?;
    /// assert_eq!(train.train().sets().len(), 1);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn answer(&self, request: &Request, work: &dyn Work) -> Result<DesignAnswer, Diagnostics> {
        let progress = self.search(Progress::default(), request.shard, work)?;
        self.answer_of(progress, request, work)
    }

    /// The answer of a search, finished or not. An empty one is searched for what must give, as far as the work allows.
    ///
    /// # Errors
    /// The progress is that of another design.
    pub fn answer_of(
        &self,
        progress: Progress,
        request: &Request,
        work: &dyn Work,
    ) -> Result<DesignAnswer, Diagnostics> {
        self.owns(&progress)?;
        let sort = request.sort.or(self.objectives.first().copied()).unwrap_or(Objective::Error);
        let (done, complete) = (progress.steps_done(), progress.is_complete());
        let top = request.top.unwrap_or(20);
        let most = request.recompute.unwrap_or(super::laws::MOST);
        // What was found is not lost because looking for more was interrupted.
        let mut order = self.order(&progress, (sort, top, request.all), most, work);
        order.trains.truncate(top);
        let chosen = &order.trains;
        work.begin("certificates", chosen.len() as u64);
        let rows = willis::work::map(work, chosen.len(), |k| {
            let train = &chosen[k];
            let mut row = self.row(k as u64 + 1, &train.teeth, &train.judged);
            (row.laws, row.operations) = (train.laws.clone(), train.operations.clone());
            work.advance(1);
            row
        });
        // Without a certificate there is no row; the counts stand all the same.
        let interrupted = rows.is_err() || order.interrupted;
        let rows: Vec<DesignRow> = rows.unwrap_or_default();
        let own = match &request.own {
            Some((name, text)) => Some(self.own(name, text, &order.front, &order.ranking)?),
            None => None,
        };
        let space = self.space();
        let by_all = order.ranking.recomputed == Recomputed::All;
        let mut waterfall = progress.waterfall;
        if by_all {
            under_laws_in_stages(&mut waterfall, order.ranking.trains, &order.demands);
        }
        let left = waterfall.last().map_or(0, |s| s.trains);
        let mut diagnostics = vec![];
        for k in self.impossible() {
            let (state, target) = &self.targets[k];
            let q = &self.layout.states[*state].ratio;
            let always = willis::exact::Rational::new(q.numerator.0[0], q.denominator.0[0]);
            let message = format!(
                "state `{}` has the ratio {always} whatever the teeth are; {} cannot be reached",
                target.state, target.ratio.aim
            );
            let mut d = Diagnostic::new(Code::Implausible, format!("design.target[{k}].ratio"), message);
            d = d.hint("change its shift elements, or drop the target");
            diagnostics.push(d);
        }
        if complete && waterfall.first().is_some_and(|s| s.trains == 0) && diagnostics.is_empty() {
            diagnostics.extend(self.contradictions());
        }
        if rows.iter().any(|r| !r.certified) {
            let message = "the efficiency of some rows is not proved to be the only one; see their verdicts";
            diagnostics.push(Diagnostic::new(Code::NotEnumerated, "", message));
        }
        let mut relaxations = match complete && left == 0 {
            true if by_all => order.most.iter().map(|m| under_laws(*m)).collect(),
            true => super::relax::relaxations(self, work),
            false => vec![],
        };
        let mut statement = self.statement(&space, complete, done, progress.of, left, order.nominal);
        if order.nominal.is_some_and(|n| n > 0) {
            // The other wishes need not give: the laws may find trains that satisfy all of them.
            relaxations.retain(|r| ["forward", "backward"].contains(&r.wish.as_str()));
        }
        if interrupted {
            statement += " Rows are missing: working them out was interrupted.";
        }
        if let (true, Some(satisfy)) = (by_all, order.ranking.satisfy) {
            statement += &under_laws_in_words(&order.ranking, satisfy);
        }
        Ok(DesignAnswer {
            format: Format::new(),
            name: self.name.clone(),
            wish: self.wish(),
            space,
            completeness: Completeness { complete, done, of: progress.of, statement },
            waterfall,
            objectives: self.objectives.clone(),
            front: if by_all { order.front.len() } else { progress.front.len() } as u64,
            ranked_by: order.ranking,
            sorted_by: sort,
            of_all: order.of_all,
            rows,
            own,
            relaxations,
            diagnostics,
        })
    }

    /// The answer of tooth numbers that were given.
    pub(crate) fn unsearched(&self, row: DesignRow, fails: &[String]) -> DesignAnswer {
        let mut diagnostics = vec![];
        if !fails.is_empty() {
            let message = format!("these teeth do not keep the wish: {}", fails.join(", "));
            let d = Diagnostic::new(Code::Implausible, "teeth", message);
            diagnostics.push(d.hint("the row and its train file are those of the teeth all the same"));
        }
        let statement = "These tooth numbers were given; nothing was searched.".to_owned();
        DesignAnswer {
            format: Format::new(),
            name: self.name.clone(),
            wish: self.wish(),
            space: self.space(),
            completeness: Completeness { complete: false, done: 0, of: 0, statement },
            waterfall: vec![],
            objectives: self.objectives.clone(),
            ranked_by: self.unranked(),
            front: 0,
            sorted_by: self.objectives.first().copied().unwrap_or(Objective::Error),
            of_all: true,
            rows: vec![row],
            own: None,
            relaxations: vec![],
            diagnostics,
        }
    }

    /// Ratios that no basic ratios of these ranges reach together: single ones, else pairs, else all.
    fn contradictions(&self) -> Option<Diagnostic> {
        let mut bounds = vec![[1.0, 1.0]; self.layout.variables];
        for (k, name) in self.layout.sets.iter().enumerate() {
            if let Some(s) = self.sets.iter().find(|s| s.name == *name) {
                bounds[self.layout.first[k]..][..s.space.kind.variables()].copy_from_slice(&s.space.bounds()?);
            }
        }
        let all: Vec<usize> = (0..self.targets.len()).filter(|k| !self.targets[*k].1.ratio.is_any()).collect();
        let mut groups: Vec<Vec<usize>> = all.iter().map(|k| vec![*k]).collect();
        groups.extend(all.iter().enumerate().flat_map(|(k, a)| all[k + 1..].iter().map(|b| vec![*a, *b])));
        groups.push(all.clone());
        let excluded = |group: &Vec<usize>| {
            let of = |k: &usize| (&self.layout.states[self.targets[*k].0].ratio, &self.targets[*k].1.ratio);
            super::contradiction::excluded(&group.iter().map(of).collect::<Vec<_>>(), &bounds)
        };
        let group = groups.iter().find(|g| excluded(g))?;
        let names: Vec<String> = group.iter().map(|k| format!("`{}`", self.targets[*k].1.state)).collect();
        let message = match names.len() {
            1 => format!("the ratio of state {} cannot be reached with teeth of these ranges", names[0]),
            _ => format!("the ratios of the states {} contradict each other, whatever the teeth are", names.join(", ")),
        };
        let place = format!("design.target[{}].ratio", group[group.len() - 1]);
        let hint = "widen a window, or drop one of the ratios: each basic ratio of a set fixes only one of them";
        Some(Diagnostic::new(Code::Implausible, place, message).hint(hint))
    }

    fn statement(&self, space: &Space, complete: bool, done: u64, of: u64, left: u64, nominal: Option<u64>) -> String {
        let sets: Vec<String> = space
            .sets
            .iter()
            .map(|(name, r)| {
                let teeth: Vec<String> = r.teeth.iter().map(|(g, t)| format!("{g} {t}")).collect();
                let list = |l: &[i64]| l.iter().map(i64::to_string).collect::<Vec<_>>().join(", ");
                format!("{name}: {}; planets {}; mismatch {}", teeth.join(", "), list(&r.planets), list(&r.mismatch))
            })
            .collect();
        let many = |n: f64| if n < 1e15 { grouped(n as u64) } else { format!("{n:.2e}") };
        let sets_left = match left {
            1 => "1 set of tooth numbers satisfies".to_owned(),
            n => format!("{} sets of tooth numbers satisfy", grouped(n)),
        };
        let what = format!("{}. {} candidates", sets.join(". "), many(space.candidates));
        if let (true, Some(others)) = (complete, nominal) {
            format!(
                "{what}, all examined or excluded by bounds with a margin for rounding; {sets_left} the wish, the demands on \
                 efficiency judged by nominal mesh efficiencies. The laws of friction may judge otherwise: {} satisfy all other \
                 wishes, and if so many may be recomputed, the laws judge every one of them.",
                grouped(others)
            )
        } else if complete {
            format!(
                "{what}, all examined or excluded by bounds with a margin for rounding; {sets_left} the wish; nothing else \
                 exists in this space."
            )
        } else {
            let share = if of == 0 { 0.0 } else { 100.0 * done as f64 / of as f64 };
            format!("{what}; {share:.1} % of the space is done; {sets_left} the wish so far. There may be more.")
        }
    }

    /// The wish in words.
    pub fn wish(&self) -> String {
        let mut parts: Vec<String> = self
            .targets
            .iter()
            .filter(|t| !t.1.ratio.is_any())
            .map(|(_, t)| {
                let windows: Vec<String> =
                    t.ratio.windows.iter().map(|[a, b]| format!("{} to {}", short(a), short(b))).collect();
                format!("state {}: ratio {}", t.state, windows.join(" or "))
            })
            .collect();
        parts.extend(self.steps.iter().map(|(_, s)| {
            let [a, b] = &s.window;
            format!("step from {} to {}: {} to {}", s.state, s.next, short(a), short(b))
        }));
        if !self.rules.is_empty() {
            parts.push(format!("rules: {}", self.rules.iter().map(|r| r.name()).collect::<Vec<_>>().join(", ")));
        }
        let unit = if self.metric { "mm" } else { "modules" };
        if let Some(d) = self.limits.ring_diameter {
            parts.push(format!("ring at most {} {unit}", if self.metric { d * 1e3 } else { d }));
        }
        let more = [
            ("planet speed at most", self.limits.planet_spin, "times the input's"),
            ("member speed at most", self.limits.member_speed, "times the input's"),
            ("element torque at most", self.limits.element_torque, "times the input's"),
            ("efficiency at least", self.require.forward, "forward"),
            ("efficiency at least", self.require.backward, "backward"),
            ("margin to self-locking at least", self.require.lock_margin, ""),
        ];
        parts.extend(more.iter().filter_map(|(a, v, b)| v.map(|v| format!("{a} {v} {b}").trim_end().to_owned())));
        parts.join("; ")
    }

    fn space(&self) -> Space {
        let mut candidates = 1.0;
        let sets = self
            .sets
            .iter()
            .map(|s| {
                let trains = s.space.size();
                candidates *= trains * s.space.planets.len() as f64;
                let names = s.space.kind.gears().iter().copied().chain(["short_planet"]);
                let range = SetRange {
                    teeth: names.zip(&s.space.gears).map(|(n, c)| (n.to_owned(), c.to_string())).collect(),
                    planets: s.space.planets.clone(),
                    mismatch: s.space.mismatch.clone(),
                    trains,
                };
                (s.name.clone(), range)
            })
            .collect();
        Space { sets, candidates }
    }

    /// The states of a train as the certified solver sees them.
    pub(crate) fn certified(&self, teeth: &Teeth) -> Option<NameMap<StateReport>> {
        let text = self.text_of(teeth, None);
        let model = Model::from_toml(&text).ok()?;
        let train = willis::unstable::without_operations(model.train());
        let analysis = analyze(&train, &Selection::default()).ok()?;
        Some(analysis.ratios)
    }

    /// What the certified solver says of one state.
    pub(crate) fn certified_ways(&self, teeth: &Teeth, state: &str, judged: &mut Judged) {
        let Some(states) = self.certified(teeth) else { return };
        let Some(row) = states.get(state) else { return };
        let value = |d: &willis::analysis::Direction| match d.verdict {
            Verdict::Unique => d.efficiency.unwrap_or(0.0),
            Verdict::Multiple => d.efficiencies.iter().copied().fold(1.0, f64::min),
            _ => 0.0,
        };
        judged.forward = judged.forward.min(value(&row.drive));
        judged.backward = judged.backward.min(value(&row.coast));
        judged.self_locking |= row.coast.verdict == Verdict::Locked;
    }

    pub(crate) fn row(&self, number: u64, teeth: &Teeth, judged: &Judged) -> DesignRow {
        let certified = self.certified(teeth);
        let y = self.variables(teeth);
        let mut all_unique = certified.is_some();
        let states: NameMap<StateRow> = self
            .targets
            .iter()
            .map(|(k, target)| {
                let report = certified.as_ref().and_then(|c| c.get(&target.state));
                let value = self.layout.states[*k].ratio.at(&y);
                let direction = |of: &dyn Fn(&StateReport) -> willis::analysis::Direction| report.map(of);
                let (drive, coast) = (direction(&|r| r.drive.clone()), direction(&|r| r.coast.clone()));
                for d in [&drive, &coast] {
                    all_unique &= d.as_ref().is_some_and(|d| match d.verdict {
                        Verdict::Unique => {
                            d.certificate.is_none_or(|c| c.unique_for_every_load || d.efficiency.is_some())
                        }
                        Verdict::Locked => true,
                        _ => false,
                    });
                }
                let row = StateRow {
                    ratio: report.and_then(|r| r.exact.clone()),
                    value,
                    target: (!target.ratio.is_any()).then(|| target.ratio.aim.clone()),
                    error: target.ratio.deviation(value),
                    forward: drive.as_ref().and_then(|d| d.efficiency),
                    forward_exact: drive.as_ref().and_then(|d| d.efficiency_exact.clone()),
                    forward_verdict: drive.as_ref().map_or(Verdict::Undetermined, |d| d.verdict),
                    backward: coast.as_ref().and_then(|d| d.efficiency),
                    backward_exact: coast.as_ref().and_then(|d| d.efficiency_exact.clone()),
                    backward_verdict: coast.as_ref().map_or(Verdict::Undetermined, |d| d.verdict),
                };
                (target.state.clone(), row)
            })
            .collect();
        let least = |of: fn(&StateRow) -> Option<f64>| {
            states.iter().map(|(_, s)| of(s)).try_fold(1.0f64, |a, e| e.map(|e| a.min(e)))
        };
        let sets: NameMap<SetRow> = self
            .sets
            .iter()
            .zip(teeth)
            .map(|(s, z)| {
                let space = &s.space;
                let item = space.item(z.clone());
                let bits = item.passed.last().copied().unwrap_or(0);
                let planets: Vec<i64> =
                    space.planets.iter().enumerate().filter(|(k, _)| bits >> k & 1 == 1).map(|(_, n)| *n).collect();
                let chosen = planets.last().copied().unwrap_or(3);
                let mut named: Vec<(String, i64)> =
                    space.kind.gears().iter().map(|n| n.to_string()).zip(z.iter().copied()).collect();
                let short = space.short(z, chosen);
                if let Some(short) = short {
                    named.push(("short_planet".into(), short));
                }
                let all: Vec<i64> = z.iter().copied().chain(short).collect();
                let hunting = space.kind.hunts(&all);
                let phase: Phase = item.phase(0, chosen);
                let shifts =
                    s.shifts(z, short).map(|x| named.iter().map(|(n, _)| n.clone()).zip(x).collect::<NameMap<f64>>());
                let module_m = self.module(s, space.ring(z));
                (s.name.clone(), SetRow { teeth: NameMap(named), planets, chosen, hunting, phase, module_m, shifts })
            })
            .collect();
        let lock_margin = judged.lock_margin.is_finite().then_some(judged.lock_margin);
        DesignRow {
            number,
            sets,
            error: judged.error,
            ring_diameter_m: self.metric.then(|| self.ring(teeth)),
            ring_teeth: self.sets.iter().zip(teeth).map(|(s, z)| s.space.ring(z)).max().unwrap_or(0),
            forward: least(|s| s.forward),
            backward: least(|s| s.backward),
            self_locking: states.iter().any(|(_, s)| s.backward_verdict == Verdict::Locked),
            states,
            lock_margin,
            planet_spin: judged.planet_spin,
            member_speed: judged.member_speed,
            element_torque: judged.element_torque,
            certified: all_unique,
            laws: None,
            operations: NameMap::default(),
        }
    }

    /// The train of a row as the text of a train file, with the wish in its notes.
    pub fn train_file(&self, row: &DesignRow) -> String {
        let teeth: Teeth = self
            .sets
            .iter()
            .map(|s| {
                let own = row.sets.get(&s.name);
                let of = |gear: &&str| own.and_then(|o| o.teeth.get(gear)).copied().unwrap_or(1);
                s.space.kind.gears().iter().map(of).collect()
            })
            .collect();
        self.text_of(&teeth, Some(row))
    }

    pub(crate) fn text_of(&self, teeth: &Teeth, row: Option<&DesignRow>) -> String {
        let mut document = self.template.clone();
        let mut assumed = false;
        for (s, z) in self.sets.iter().zip(teeth) {
            let own = row.and_then(|r| r.sets.get(&s.name));
            let item = s.space.item(z.clone());
            let bits = item.passed.last().copied().unwrap_or(0);
            let last = (0..s.space.planets.len()).rev().find(|k| bits >> k & 1 == 1).map(|k| s.space.planets[k]);
            let planets = own.map(|o| o.chosen).or(last).unwrap_or(s.space.planets[0]);
            let short = match own {
                Some(o) => o.teeth.get("short_planet").copied(),
                None => s.space.short(z, planets),
            };
            let shifts: Option<Vec<f64>> = match own {
                Some(o) => o.shifts.as_ref().map(|x| x.iter().map(|(_, v)| *v).collect()),
                None if s.has_geometry => s.shifts(z, short),
                None => None,
            };
            // Teeth whose losses are given may have a geometry: it changes none of them.
            let module = own.and_then(|o| o.module_m).filter(|_| shifts.is_some() && !s.has_geometry && s.has_losses);
            if let Some(module) = module {
                give_geometry(&mut document, s, module);
                assumed = true;
            }
            let shifts = shifts.filter(|_| s.has_geometry || module.is_some());
            substitute(&mut document, s, z, planets, short, shifts.as_deref());
        }
        if let Some(row) = row {
            let title: Vec<String> = row
                .sets
                .iter()
                .map(|(_, s)| s.teeth.iter().map(|(_, z)| z.to_string()).collect::<Vec<_>>().join("/"))
                .collect();
            document["name"] = toml_edit::value(format!("{}, {}", self.name, title.join(" ")));
            let before = document.get("notes").and_then(toml_edit::Item::as_str).unwrap_or("").trim().to_owned();
            let mut notes = format!("{before}\nTooth numbers for this wish: {}.", self.wish());
            if assumed {
                notes += &format!(" Teeth are {WIDTH_IN_MODULES} modules wide, which is assumed.");
            }
            document["notes"] = toml_edit::value(notes.trim());
        }
        document.to_string()
    }
}

/// A count with its digits in groups of three.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(|c| String::from_utf8_lossy(c).into_owned());
    groups.collect::<Vec<_>>().join("\u{a0}")
}

/// A number in six digits or fewer.
fn short(x: &willis::exact::Rational) -> String {
    let x = x.to_f64();
    let decimals = (5 - x.abs().max(1e-9).log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// What is left under the laws, in words.
fn under_laws_in_words(ranking: &Ranking, satisfy: u64) -> String {
    let open = match ranking.open {
        0 => String::new(),
        1 => "; of 1 they give no single answer".to_owned(),
        n => format!("; of {} they give no single answer", grouped(n)),
    };
    let many = |n: u64| if n == 1 { "1 train".to_owned() } else { format!("{} trains", grouped(n)) };
    format!(
        " Under the laws of friction {} of {} that satisfy the other wishes {} the demands on efficiency, too{open}.",
        grouped(satisfy),
        many(ranking.trains),
        if satisfy == 1 { "satisfies" } else { "satisfy" }
    )
}

/// The stages with demands on efficiency as the laws judge them: all `trains` satisfy the other wishes.
fn under_laws_in_stages(waterfall: &mut Vec<Stage>, trains: u64, demands: &[(Objective, u64)]) {
    let Some(first) = waterfall.iter().position(Stage::is_demand) else { return };
    let stage = |condition: &str, trains: u64| Stage {
        condition: condition.to_owned(),
        trains,
        designs: trains,
        by_planets: NameMap::default(),
    };
    let others: Vec<Stage> =
        waterfall.drain(first..).filter(|s| !s.is_demand()).map(|s| stage(&s.condition, trains)).collect();
    waterfall.extend(others);
    waterfall.extend(demands.iter().map(|(objective, left)| stage(objective.name(), *left)));
}

/// A demand that keeps a result empty under the laws.
fn under_laws((objective, now, best, trains): (Objective, f64, f64, u64)) -> Relaxation {
    let words = format!(
        "`{objective}` is {now}; under the laws of friction the other wishes leave at most {best:.4}, and {}",
        if trains == 1 { "1 train satisfies them".to_owned() } else { format!("{trains} trains satisfy them") }
    );
    Relaxation { wish: objective.name().into(), now: Some(now), needed: Some(best), trains, words }
}
