//! A train that exists, as a row among those that were found: what it fails, and how many are better.

use toml_edit::{DocumentMut, Item};
use willis::Model;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};

use super::answer::{DesignAnswer, DesignRow, OwnTrain, Ranking, Recomputed};
use super::document::{Design, DesignedSet, at, paths, planet_tables, set_kind, tables};
use super::front::beats;
use super::laws::Lawful;
use super::layout::SetKind;
use super::range::{Counts, MOST_TEETH};
use super::search::{Judged, Needs, Teeth};
use super::space::SetSpace;

/// The largest mismatch for which a set that exists is recognised.
const MOST_MISMATCH: i64 = 4;

/// Teeth of a set of a train file, its short planet where it has one, and its number of planets.
struct Own {
    teeth: Vec<i64>,
    short: Option<i64>,
    planets: i64,
}

impl Design {
    /// A train as a row of the answer, with the meshes of this design: what it fails, and how many of a front are better.
    ///
    /// # Errors
    /// The file cannot be read as a train, or has no sets like those that are designed.
    pub(crate) fn own(
        &self,
        name: &str,
        text: &str,
        front: &[Vec<f64>],
        ranking: &Ranking,
    ) -> Result<OwnTrain, Diagnostics> {
        let model = Model::from_toml(text)?;
        let document: DocumentMut = text.parse().map_err(|_| Diagnostic::new(Code::Syntax, "", "is not valid TOML"))?;
        let all: Vec<Own> = (self.sets.iter().enumerate())
            .map(|(k, set)| own_set(&document, set, k, self.sets.len()))
            .collect::<Result<_, _>>()?;
        let mut fails = vec![];
        let mut here = self.clone();
        for (set, own) in here.sets.iter_mut().zip(&all) {
            self.failures(set, own, &mut fails);
            set.space = alone(&set.space, own);
            set.space.planets = vec![own.planets];
            set.space.mismatch = (-MOST_MISMATCH..=MOST_MISMATCH).collect();
            // What it fails is said; here it is taken as it is.
            set.space.rules = vec![];
        }
        let teeth: Teeth = all.iter().map(|o| o.teeth.clone()).collect();
        let Some(judged) = here.judge(&teeth, Needs::ALL) else {
            let message = format!("`{name}` has no ratio in a state for which one is asked");
            return Err(Diagnostic::new(Code::Unfit, "", message).into());
        };
        let mut row = here.row(0, &teeth, &judged);
        let laws = Lawful::of(model.train(), &self.operation_names(), &self.target_states());
        let value;
        (value, row.laws) = self.with_own_laws(&judged, &laws, ranking);
        row.operations = laws.operations;
        // Where laws rank all trains, they decide about demands.
        let decides = if ranking.recomputed == Recomputed::All { &value } else { &judged };
        here.missed(&teeth, &row, decides, &mut fails);
        let point = self.point(&value, &teeth);
        let better = |other: &&Vec<f64>| beats(other, &point);
        let better = front.iter().filter(better).count() as u64;
        Ok(OwnTrain { name: name.to_owned(), fails, better, row })
    }

    /// Targets, limits and demands that a train does not keep; the targets before what is known already.
    fn missed(&self, teeth: &Teeth, row: &DesignRow, decides: &Judged, fails: &mut Vec<String>) {
        for (k, (state, target)) in self.targets.iter().enumerate() {
            let inside = target.ratio.is_any()
                || match row.states.get(&target.state).and_then(|s| s.ratio.as_ref()) {
                    Some(exact) => target.ratio.windows.iter().any(|[a, b]| a <= exact && exact <= b),
                    None => {
                        target.ratio.deviation(self.layout.states[*state].ratio.at(&self.variables(teeth))) <= 1e-12
                    }
                };
            if !inside {
                fails.insert(k.min(fails.len()), format!("ratio of state {}", target.state));
            }
        }
        let ring = self.limits.ring_diameter.is_some_and(|limit| self.ring(teeth) > limit * (1.0 + 1e-12));
        fails.extend(ring.then(|| "ring_diameter".to_owned()));
        let later = self.conditions_of_motion();
        fails.extend(later.into_iter().zip(self.meets(decides)).filter(|(_, met)| !met).map(|(name, _)| name));
    }

    /// The answer for tooth numbers that are given: one row, as a search would show it, and no search. One text a set, in the
    /// order of the file, with teeth in the order of a row; the short planet of a Ravigneaux set may be left out.
    ///
    /// # Errors
    /// Texts that are no tooth numbers of the sets, or teeth that are not in the space.
    ///
    /// # Example
    /// ```
    /// use willis_synthesis::teeth::{Design, Start, StartKind};
    ///
    /// let start = Start { ratio: Some("100".into()), ..Start::new(StartKind::Wolfrom) };
    /// let design = Design::from_toml(&start.to_toml())?;
    /// let answer = design.answer_for(&["12/54/120/44/110".into()])?;
    /// assert_eq!(answer.rows[0].states.get("as drawn").unwrap().value, 99.0);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn answer_for(&self, teeth: &[String]) -> Result<DesignAnswer, Diagnostics> {
        let refused = |message: String, hint: String| Diagnostic::new(Code::Unfit, "teeth", message).hint(hint).into();
        let asked = |set: &DesignedSet| {
            let gears: Vec<String> = set.space.kind.gears().iter().map(|g| g.replace('_', " ")).collect();
            format!("{}: {}", set.name, gears.join("/"))
        };
        let order = || self.sets.iter().map(asked).collect::<Vec<_>>().join("; ");
        if teeth.len() != self.sets.len() {
            let many = |n: usize| if n == 1 { "1 set".to_owned() } else { format!("{n} sets") };
            let message =
                format!("teeth of {} are given, but {} is designed", many(teeth.len()), many(self.sets.len()));
            return Err(refused(message, format!("give the teeth of every set, such as 20/12/44: {}", order())));
        }
        let mut here = self.clone();
        let mut own_sets: Vec<Own> = vec![];
        for (set, text) in here.sets.iter_mut().zip(teeth) {
            let numbers: Option<Vec<i64>> = text.split('/').map(|z| z.trim().parse().ok()).collect();
            let gears = set.space.kind.gears().len();
            let fits = |z: &Vec<i64>| {
                let more = usize::from(set.space.kind == SetKind::Ravigneaux);
                (gears..=gears + more).contains(&z.len()) && z.iter().all(|z| (1..=MOST_TEETH).contains(z))
            };
            let Some(mut z) = numbers.filter(fits) else {
                let message = format!("`{text}` is not the teeth of set `{}`", set.name);
                return Err(refused(message, format!("give them with strokes, in this order: {}", asked(set))));
            };
            let short = if z.len() > gears { z.pop() } else { None };
            let own = Own { teeth: z, short, planets: 0 };
            let narrow = SetSpace { ring_limit: set.space.ring_limit, ..alone(&set.space, &own) };
            let within = set.space.gears.iter().zip(own.teeth.iter().copied().chain(short)).all(|(g, z)| g.contains(z));
            let free = SetSpace { rules: vec![], ring_limit: None, ..narrow.clone() };
            if !within || free.all().next().is_none() {
                let message = format!("the teeth {text} of set `{}` are not in the space of the design", set.name);
                let hint = "they must lie in the ranges and on one axis, with a mismatch that is allowed".to_owned();
                return Err(refused(message, hint));
            }
            set.space = narrow;
            own_sets.push(own);
        }
        let all: Teeth = own_sets.iter().map(|o| o.teeth.clone()).collect();
        let Some(judged) = here.judge(&all, Needs::ALL) else {
            return Err(refused("these teeth have no ratio in a state for which one is asked".into(), order()));
        };
        let mut row = here.row(1, &all, &judged);
        (row.laws, row.operations) = here.row_with_laws(&all, &judged);
        let mut fails = vec![];
        for (set, mut own) in self.sets.iter().zip(own_sets) {
            own.planets = row.sets.get(&set.name).map_or(0, |s| s.chosen);
            self.failures(set, &own, &mut fails);
        }
        here.missed(&all, &row, &judged, &mut fails);
        Ok(here.unsearched(row, &fails))
    }

    /// What of the ranges and rules a set that exists does not keep.
    fn failures(&self, set: &DesignedSet, own: &Own, fails: &mut Vec<String>) {
        let outside = |fails: &mut Vec<String>, what: &str| fails.push(format!("range of {}.{what}", set.name));
        for ((gear, range), z) in set.space.kind.gears().iter().zip(&set.space.gears).zip(&own.teeth) {
            if !range.contains(*z) {
                outside(fails, gear);
            }
        }
        if !set.space.planets.contains(&own.planets) {
            outside(fails, "planets");
        }
        let mut space = alone(&set.space, own);
        space.rules = vec![];
        if space.all().next().is_none() {
            outside(fails, "mismatch");
        }
        space.planets = vec![own.planets];
        for rule in &set.space.rules {
            let judged = space.clone().rules([*rule]).item(own.teeth.clone());
            if !judged.is_admissible() {
                fails.push(format!("{rule} of {}", set.name));
            }
        }
    }
}

/// The space that has only these teeth.
fn alone(space: &SetSpace, own: &Own) -> SetSpace {
    let mut only = space.clone();
    only.ring_limit = None;
    for (k, z) in own.teeth.iter().copied().chain(own.short).enumerate() {
        only.gears[k] = Counts::list([z]);
    }
    only
}

/// The set of a train file that stands for a designed set: that of its name, or the only one of its kind, or, where both
/// have as many, the one at its place.
fn own_set(document: &DocumentMut, set: &DesignedSet, place: usize, designed: usize) -> Result<Own, Diagnostics> {
    let root = document.as_item();
    let all: Vec<Item> = match root.get("set") {
        Some(sets) => (0..tables(Some(sets))).filter_map(|k| super::document::nth(sets, k)).collect(),
        None => vec![],
    };
    let alike: Vec<&Item> = all.iter().filter(|s| set_kind(s) == Some(set.space.kind)).collect();
    let named = alike.iter().find(|s| s.get("name").and_then(Item::as_str) == Some(&set.name));
    let found = named.or_else(|| match alike.len() {
        1 => alike.first(),
        n if n == designed => alike.get(place),
        _ => None,
    });
    let Some(found) = found else {
        let message = format!("there is no set like `{}` of the design", set.name);
        let names: Vec<&str> = all.iter().filter_map(|s| s.get("name").and_then(Item::as_str)).collect();
        let hint = format!("name a set `{}` and give it the same type; there are: {}", set.name, names.join(", "));
        return Err(Diagnostic::new(Code::Unfit, "set", message).hint(hint).into());
    };
    let whole = |path: &str| at(found, path).and_then(Item::as_integer);
    let mut teeth: Vec<Option<i64>> = paths(set.space.kind).iter().map(|p| whole(p)).collect();
    // Planets that nobody gave: those that fit, as everywhere.
    match (set.space.kind, &teeth[..]) {
        (SetKind::Simple, [Some(sun), None, Some(ring)]) => teeth[1] = Some((ring - sun) / 2),
        (SetKind::Ravigneaux, [_, Some(sun), None, Some(ring), _]) => teeth[2] = Some((ring - sun) / 2),
        _ => {}
    }
    let short = if set.space.kind == SetKind::Ravigneaux { teeth.pop().flatten() } else { None };
    let teeth: Option<Vec<i64>> = teeth.into_iter().collect();
    let Some(teeth) = teeth.filter(|t| t.iter().all(|z| *z > 0)) else {
        let message = format!("set `{}` does not give all its tooth numbers", set.name);
        return Err(Diagnostic::new(Code::MissingKey, "set", message).hint("give the teeth of every gear").into());
    };
    let count = planet_tables(set.space.kind).iter().find_map(|p| whole(&format!("{p}.count")));
    // Of numbers that nobody gave, one with which all rules hold.
    let holds = |n: &&i64| {
        let space = SetSpace { planets: vec![**n], ring_limit: None, ..set.space.clone() };
        space.item(teeth.clone()).is_admissible()
    };
    let all = &set.space.planets;
    let planets = count.or(all.iter().rev().find(holds).copied()).or(all.first().copied()).unwrap_or(3);
    Ok(Own { teeth, short, planets })
}
