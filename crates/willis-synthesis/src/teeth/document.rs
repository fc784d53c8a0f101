//! Design files: train files in which teeth and planets are ranges, with a table `[design]`.
//!
//! ```toml
//! [design]
//! tolerance = 0.01                       # of every ratio, unless a target has its own
//! planets = "3..5"                       # of every set that does not say it
//! mismatch = [-1, 0, 1]                  # r - s - 2 p and the like; default 0
//! rules = ["assembly", "clearance", "hunting"]     # default: assembly, clearance
//! gap = "0.5"                            # between tips of planets, in modules; default 0. Ravigneaux: half between kinds
//! module = ["0.5 mm", "0.6 mm"]          # one, or a list, of sets without a geometry
//! limits = { ring_diameter = "90 mm", planet_spin = 5, member_speed = 3.0, element_torque = 2.5 }
//! require = { forward = 0.7, backward = 0.6, lock_margin = 1.5 }
//! minimize = ["ring_diameter"]
//! maximize = ["forward", "backward"]
//!
//! [[design.target]]
//! state = "1"                            # not needed where the train has no states
//! ratio = 4.70                           # or [4.6, 4.8]; `any_sign = true` takes both signs
//! step = [1.4, 1.6]                      # over the ratio of the next state; with a ratio or without
//! tolerance = 0.02
//! ```
//!
//! A set is designed when one of its tooth numbers is a text (`"18..60"`, `"18.. odd"`) or a list. Sets with sun and ring,
//! stepped sets with one sun and one or two rings or with two rings alone, and Ravigneaux sets can be; other sets keep the teeth they have.

use std::ops::Range;

use toml_edit::{DocumentMut, InlineTable, Item, Table, Value};
use willis::Model;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::units;

use super::fit::Length;
use super::layout::{Layout, SetKind};
use super::range::Counts;
use super::rule::Rule;
use super::shift::Rack;
use super::space::SetSpace;
use super::wish::{Limits, Objective, Ratio, Requirements, Step, Target};

/// A set of a design file.
#[derive(Clone, Debug)]
pub(crate) struct DesignedSet {
    /// Its position among the sets of the file.
    pub index: usize,
    pub name: String,
    pub space: SetSpace,
    /// Modules that it may have, m, ascending; none where none is given.
    pub modules: Vec<f64>,
    /// Whether the set has a table `geometry`, so that profile shifts can be written.
    pub has_geometry: bool,
    /// Whether the efficiencies of its meshes are given.
    pub has_losses: bool,
}

impl DesignedSet {
    /// The module that a set with such a ring gets: of those that are allowed and with which the ring is not above the
    /// limit, m, the smallest where the ring shall be small, else the largest, for the strength of its teeth.
    pub fn module(&self, ring: i64, limit: Option<f64>, small: bool) -> Option<f64> {
        let fits = |m: &&f64| limit.is_none_or(|l| ring as f64 * **m <= l * (1.0 + 1e-12));
        let smallest = self.modules.first();
        let found = if small { smallest } else { self.modules.iter().rev().find(fits).or(smallest) };
        found.copied()
    }

    /// Profile shifts of its gears, with the short planet of a Ravigneaux set; none where no choice is sound.
    pub fn shifts(&self, teeth: &[i64], short: Option<i64>) -> Option<Vec<f64>> {
        let all: Vec<i64> = teeth.iter().copied().chain(short).collect();
        super::shift::shifts(self.space.kind, &all, self.space.rack)
    }
}

/// A design file, read and checked: what a train must do, and what its teeth may be.
///
/// # Example
/// ```
/// use willis_synthesis::teeth::Design;
///
/// let design = Design::from_toml(r#"
///     format = 1
///     name = "reducer"
///     members = ["sun", "carrier"]
///     terminals = ["sun", "carrier"]
///     design = { tolerance = 0.01, target = [{ ratio = 4.0 }] }
///
///     [[set]]
///     name = "P1"
///     sun = { member = "sun", teeth = "15..40" }
///     planet = { teeth = "15..40", count = "3..4" }
///     ring = { member = "frame", teeth = "..100" }
///     carrier = "carrier"
///     mesh_efficiency = 0.99
/// "#)?;
/// assert_eq!(design.count().trains, 19);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Design {
    pub(crate) template: DocumentMut,
    pub(crate) text: String,
    pub(crate) name: String,
    pub(crate) sets: Vec<DesignedSet>,
    pub(crate) layout: Layout,
    /// With the number of the state in the layout.
    pub(crate) targets: Vec<(usize, Target)>,
    /// With the positions of both states among the targets.
    pub(crate) steps: Vec<([usize; 2], Step)>,
    pub(crate) limits: Limits,
    pub(crate) require: Requirements,
    /// What designs are judged by; the first one sorts rows.
    pub(crate) objectives: Vec<Objective>,
    pub(crate) rules: Vec<Rule>,
    /// Whether every designed set has a module, so that diameters are metres.
    pub(crate) metric: bool,
}

/// Keys of the table `[design]`.
const KEYS: [&str; 11] = [
    "tolerance",
    "planets",
    "mismatch",
    "rules",
    "gap",
    "module",
    "limits",
    "require",
    "minimize",
    "maximize",
    "target",
];

/// The largest difference, in teeth, from a set without profile shift.
const MOST_MISMATCH: i64 = 4;

/// What a target asks, before its state is looked for.
struct Asked {
    state: Option<String>,
    ratio: Ratio,
    step: Option<[Rational; 2]>,
    span: Option<Range<usize>>,
}

/// A number to come near to, or two ends.
enum Window {
    Aim(Rational),
    Ends([Rational; 2]),
}

/// Reads with places.
struct Reader<'t> {
    text: &'t str,
    wrong: Diagnostics,
}

impl Reader<'_> {
    fn report(&mut self, mut d: Diagnostic, place: &str, span: Option<Range<usize>>) {
        if d.place.is_empty() || !place.is_empty() {
            d.place = place.to_owned();
        }
        d.span = d.span.or(span.map(Into::into));
        self.wrong.push(d);
    }

    fn kind(&mut self, place: &str, item: &Item, what: &str) {
        let found = item.type_name();
        let d =
            Diagnostic::new(Code::WrongType, place, format!("`{place}` takes {what}, not a value of the type {found}"));
        self.report(d, place, item.span());
    }

    /// A number or a text of one, exactly.
    fn rational(&mut self, place: &str, item: &Item) -> Option<Rational> {
        let value = match item.as_value() {
            Some(Value::Integer(i)) => Some(Rational::from(*i.value())),
            // As it is written, not the nearest binary number.
            Some(Value::Float(f)) => match f.as_repr().and_then(|r| r.as_raw().as_str()) {
                Some(raw) => raw.trim().parse().ok(),
                None => Rational::from_f64(*f.value()),
            },
            Some(Value::String(s)) => s.value().trim().parse().ok(),
            _ => None,
        };
        if value.is_none() {
            self.kind(place, item, "a number such as 4.7 or \"14/3\"");
        }
        value
    }

    fn positive(&mut self, place: &str, item: &Item) -> Option<f64> {
        let value = self.rational(place, item)?;
        if value.sign() <= 0 {
            let d = Diagnostic::new(Code::OutOfRange, place, format!("`{place}` is {value}; it must be above 0"));
            self.report(d, place, item.span());
            return None;
        }
        Some(value.to_f64())
    }

    /// A number, or a list of two, the smaller one first.
    fn window(&mut self, place: &str, item: &Item) -> Option<Window> {
        let Some(ends) = item.as_array() else { return self.rational(place, item).map(Window::Aim) };
        let ends: Vec<Rational> = ends.iter().filter_map(|v| self.rational(place, &Item::Value(v.clone()))).collect();
        match <[Rational; 2]>::try_from(ends) {
            Ok([a, b]) if a <= b => return Some(Window::Ends([a, b])),
            Ok([a, b]) => {
                let message = format!("the window from {a} to {b} is empty");
                let d = Diagnostic::new(Code::OutOfRange, "", message).hint("write the smaller number first");
                self.report(d, place, item.span());
            }
            Err(_) => self.kind(place, item, "a number, or a list of two"),
        }
        None
    }

    fn counts(&mut self, place: &str, item: &Item) -> Option<Counts> {
        let read = match item.as_value() {
            Some(Value::Integer(i)) => Counts::checked(vec![*i.value()]),
            Some(Value::String(s)) => s.value().parse(),
            Some(Value::Array(a)) => {
                let list: Option<Vec<i64>> = a.iter().map(Value::as_integer).collect();
                match list {
                    Some(list) => Counts::checked(list),
                    None => {
                        self.kind(place, item, "a list of whole numbers");
                        return None;
                    }
                }
            }
            _ => {
                self.kind(place, item, "a whole number, a range such as \"18..60\", or a list");
                return None;
            }
        };
        match read {
            Ok(counts) => Some(counts),
            Err(d) => {
                self.report(*d, place, item.span());
                None
            }
        }
    }

    /// Teeth of a gear: some number of at least one.
    fn teeth(&mut self, place: &str, item: &Item) -> Option<Counts> {
        let counts = self.counts(place, item)?;
        if counts.within(1, super::range::MOST_TEETH).next().is_some() {
            return Some(counts);
        }
        let message = format!("`{counts}` contains no number of teeth: a gear has at least 1");
        self.report(Diagnostic::new(Code::OutOfRange, "", message), place, item.span());
        None
    }

    /// A gap in modules: a number, or a text of one.
    fn gap(&mut self, place: &str, item: &Item) -> Option<Length> {
        let text = item.as_str().map(|t| t.trim_end_matches("modules").trim_end_matches("module").trim());
        let modules = match text {
            Some(t) => t.parse::<Rational>().ok().or_else(|| {
                self.kind(place, item, "a number of modules, such as \"0.5\"");
                None
            }),
            None => self.rational(place, item),
        }?;
        let gap = Length::of(&modules).filter(|_| modules.sign() >= 0);
        if gap.is_none() {
            let message = format!(
                "`{place}` is {modules}; it must be at least 0, with a numerator and denominator of at most a million"
            );
            self.report(Diagnostic::new(Code::OutOfRange, "", message), place, item.span());
        }
        gap
    }

    fn names<T: std::str::FromStr<Err = Box<Diagnostic>>>(&mut self, place: &str, item: &Item) -> Vec<T> {
        let Some(list) = item.as_array() else {
            self.kind(place, item, "a list of names");
            return vec![];
        };
        let mut found = vec![];
        for value in list {
            match value.as_str().map(str::parse::<T>) {
                Some(Ok(t)) => found.push(t),
                Some(Err(mut d)) => {
                    // What replaces a text is a text.
                    d.replacement = d.replacement.map(|r| format!("\"{r}\""));
                    self.report(*d, place, value.span());
                }
                None => self.kind(place, item, "a list of names"),
            }
        }
        found
    }

    fn unknown(&mut self, place: &str, key: &str, item: &Item, known: &[&str]) {
        let path = if place.is_empty() { key.to_owned() } else { format!("{place}.{key}") };
        let d = Diagnostic::new(Code::UnknownKey, path.as_str(), format!("there is no key `{path}`"))
            .suggest(key, known.iter().copied())
            .hint(format!("its keys are: {}", known.join(", ")));
        self.report(d, &path, item.span());
    }

    /// A length or a list of lengths, ascending.
    fn lengths(&mut self, place: &str, item: &Item) -> Vec<f64> {
        let Some(list) = item.as_array() else { return self.length(place, item).into_iter().collect() };
        let mut all: Vec<f64> = list.iter().filter_map(|v| self.length(place, &Item::Value(v.clone()))).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        if list.is_empty() {
            self.kind(place, item, "a length with its unit, or a list of some,");
        }
        all
    }

    fn length(&mut self, place: &str, item: &Item) -> Option<f64> {
        let Some(text) = item.as_str() else {
            self.kind(place, item, "a length with its unit, such as \"90 mm\"");
            return None;
        };
        match units::parse(text, units::Dimension::LENGTH) {
            Ok(q) if q.si() > 0.0 && q.si().is_finite() => Some(q.si()),
            Ok(_) => {
                let d = Diagnostic::new(Code::OutOfRange, place, format!("`{place}` must be above 0"));
                self.report(d, place, item.span());
                None
            }
            Err(e) => {
                self.report(Diagnostic::from(e), place, item.span());
                None
            }
        }
    }
}

/// The gears of a set in a file: paths within the set, in the order of [`SetKind::gears`] (and the short planet).
pub(crate) fn paths(kind: SetKind) -> &'static [&'static str] {
    match kind {
        SetKind::Simple => &["sun.teeth", "planet.teeth", "ring.teeth"],
        SetKind::Wolfrom => {
            &["suns.0.teeth", "suns.0.planet_teeth", "rings.0.teeth", "rings.1.planet_teeth", "rings.1.teeth"]
        }
        SetKind::Stepped => &["suns.0.teeth", "suns.0.planet_teeth", "rings.0.planet_teeth", "rings.0.teeth"],
        SetKind::Rings => &["rings.0.teeth", "rings.0.planet_teeth", "rings.1.planet_teeth", "rings.1.teeth"],
        SetKind::Ravigneaux => {
            &["small_sun.teeth", "large_sun.teeth", "long_planet.teeth", "ring.teeth", "short_planet.teeth"]
        }
    }
}

/// The kind of a set in a file, if it is one whose teeth can be found.
pub(crate) fn set_kind(set: &Item) -> Option<SetKind> {
    match set.get("type").and_then(Item::as_str).unwrap_or("simple") {
        "simple" => Some(SetKind::Simple),
        "stepped" => Some(match (tables(set.get("suns")), tables(set.get("rings"))) {
            (1, 1) => SetKind::Stepped,
            (0, 2) => SetKind::Rings,
            // Of this kind or of none.
            _ => SetKind::Wolfrom,
        }),
        "ravigneaux" => Some(SetKind::Ravigneaux),
        _ => None,
    }
}

/// The tables that say how many planets there are.
pub(crate) fn planet_tables(kind: SetKind) -> &'static [&'static str] {
    match kind {
        SetKind::Simple | SetKind::Wolfrom | SetKind::Stepped | SetKind::Rings => &["planet"],
        SetKind::Ravigneaux => &["short_planet", "long_planet"],
    }
}

/// What stands at a path of names and positions.
pub(crate) fn at<'d>(item: &'d Item, path: &str) -> Option<&'d Item> {
    let mut now = item;
    for part in path.split('.') {
        now = match part.parse::<usize>() {
            Ok(k) => now.get(k)?,
            Err(_) => now.get(part)?,
        };
    }
    Some(now)
}

/// Tables of a list, whichever way it is written.
pub(crate) fn tables(item: Option<&Item>) -> usize {
    match item {
        Some(Item::ArrayOfTables(a)) => a.len(),
        Some(Item::Value(Value::Array(a))) => a.len(),
        _ => 0,
    }
}

/// An item of a list of tables as an item of its own.
pub(crate) fn nth(item: &Item, k: usize) -> Option<Item> {
    match item {
        Item::ArrayOfTables(a) => a.get(k).map(|t| Item::Table(t.clone())),
        Item::Value(Value::Array(a)) => a.get(k).map(|v| Item::Value(v.clone())),
        _ => None,
    }
}

impl Design {
    /// Reads a design file.
    ///
    /// # Errors
    /// Everything that is wrong with it, each with its place.
    pub fn from_toml(text: &str) -> Result<Self, Diagnostics> {
        let parsed = toml_edit::Document::parse(text.to_owned()).map_err(|e| {
            let mut d = Diagnostic::new(Code::Syntax, "", e.message().to_owned());
            d.span = e.span().map(Into::into);
            let mut all = one(d);
            all.stand_in(None, text);
            all
        })?;
        let mut reader = Reader { text, wrong: Diagnostics::default() };
        let built = Self::read(parsed.as_item(), &mut reader);
        let mut wrong = reader.wrong;
        match built {
            Some(Ok(design)) if !wrong.has_errors() => Ok(design),
            Some(Err(more)) => {
                wrong.extend(more.iter().cloned());
                wrong.stand_in(None, text);
                Err(wrong)
            }
            _ => {
                wrong.stand_in(None, text);
                Err(wrong)
            }
        }
    }

    fn read(root: &Item, r: &mut Reader<'_>) -> Option<Result<Self, Diagnostics>> {
        let nothing = Item::Table(Table::new());
        let design = root.get("design").unwrap_or(&nothing);
        let Some(table) = design.as_table_like() else {
            r.kind("design", design, "a table");
            return None;
        };
        for (key, item) in table.iter().filter(|(k, _)| !KEYS.contains(k)) {
            r.unknown("design", key, item, &KEYS);
        }
        let tolerance = match table.get("tolerance") {
            Some(item) => r.rational("design.tolerance", item).unwrap_or(Rational::new(1, 100)),
            None => Rational::new(1, 100),
        };
        let planets = table.get("planets").and_then(|i| r.counts("design.planets", i));
        let mismatch = match table.get("mismatch").map(|i| (i, r.counts("design.mismatch", i))) {
            Some((item, Some(counts))) => {
                let inside = |end: Option<i64>| end.is_some_and(|d| d.abs() <= MOST_MISMATCH);
                if !inside(counts.least()) || !inside(counts.most()) {
                    let message = format!(
                        "`{counts}` goes beyond ±{MOST_MISMATCH}: a larger mismatch cannot be closed by profile shift"
                    );
                    r.report(Diagnostic::new(Code::OutOfRange, "", message), "design.mismatch", item.span());
                }
                counts.within(-MOST_MISMATCH, MOST_MISMATCH).collect()
            }
            _ => vec![0],
        };
        let mut rules: Vec<Rule> = match table.get("rules") {
            Some(item) => r.names("design.rules", item),
            None => vec![Rule::Assembly, Rule::Clearance],
        };
        rules.sort_unstable();
        rules.dedup();
        let gap = match table.get("gap") {
            Some(item) => r.gap("design.gap", item),
            None => Some(Length::ZERO),
        };
        let modules = table.get("module").map_or(vec![], |i| r.lengths("design.module", i));
        let limits = Self::limits(table.get("limits"), r);
        let require = Self::require(table.get("require"), r);
        let mut objectives: Vec<Objective> = vec![];
        for (key, high) in [("minimize", false), ("maximize", true)] {
            let place = format!("design.{key}");
            let Some(item) = table.get(key) else { continue };
            for o in r.names::<Objective>(&place, item) {
                if o.is_better_high() != high {
                    let other = if high { "minimize" } else { "maximize" };
                    let d = Diagnostic::new(Code::Conflict, "", format!("`{o}` belongs under `{other}`"));
                    r.report(d, &place, item.span());
                }
                if !objectives.contains(&o) {
                    objectives.push(o);
                }
            }
        }
        if objectives.is_empty() {
            objectives = vec![Objective::Error, Objective::RingDiameter, Objective::Forward, Objective::Backward];
        }
        let mut raw_targets = vec![];
        if let Some(item) = table.get("target").filter(|t| !t.is_array() && !t.is_array_of_tables()) {
            r.kind("design.target", item, "a list of tables, `[[design.target]]` or `[{ ratio = 4.7 }]`,");
        }
        for k in 0..tables(table.get("target")) {
            let place = format!("design.target[{k}]");
            let Some(item) = table.get("target").and_then(|t| nth(t, k)) else { continue };
            if let Some(t) = Self::target(&item, &place, &tolerance, r) {
                raw_targets.push(t);
            }
        }
        if raw_targets.is_empty() && !r.wrong.has_errors() {
            let d = Diagnostic::new(Code::MissingKey, "design.target", "no ratio is asked for")
                .hint("add `[[design.target]]` with `ratio = 4.7`, and `state = \"1\"` where the train has states");
            r.report(d, "design.target", None);
        }
        let sets = Self::sets(root, (planets, &mismatch, gap.unwrap_or(Length::ZERO), &rules, &modules), r);
        if r.wrong.has_errors() {
            return None;
        }
        if sets.is_empty() {
            let d = Diagnostic::new(
                Code::MissingKey,
                "set",
                "no set has a range of teeth, so that nothing is to be designed",
            )
            .hint("write a range for some tooth numbers: `teeth = \"18..60\"`");
            r.report(d, "set", None);
            return None;
        }
        Some(Self::assemble(root, r, sets, raw_targets, (limits, require, objectives, rules)))
    }

    fn limits(item: Option<&Item>, r: &mut Reader<'_>) -> Limits {
        let mut limits = Limits::default();
        let Some(item) = item else { return limits };
        let Some(table) = item.as_table_like() else {
            r.kind("design.limits", item, "a table");
            return limits;
        };
        for (key, item) in table.iter() {
            let place = format!("design.limits.{key}");
            match key {
                "ring_diameter" if item.is_str() => limits.ring_diameter = r.length(&place, item),
                "ring_diameter" => limits.ring_diameter = r.positive(&place, item),
                "planet_spin" => limits.planet_spin = r.positive(&place, item),
                "member_speed" => limits.member_speed = r.positive(&place, item),
                "element_torque" => limits.element_torque = r.positive(&place, item),
                _ => r.unknown(
                    "design.limits",
                    key,
                    item,
                    &["ring_diameter", "planet_spin", "member_speed", "element_torque"],
                ),
            }
        }
        limits
    }

    fn require(item: Option<&Item>, r: &mut Reader<'_>) -> Requirements {
        let mut require = Requirements::default();
        let Some(item) = item else { return require };
        let Some(table) = item.as_table_like() else {
            r.kind("design.require", item, "a table");
            return require;
        };
        for (key, item) in table.iter() {
            let place = format!("design.require.{key}");
            let value = match key {
                "forward" => &mut require.forward,
                "backward" => &mut require.backward,
                "lock_margin" => &mut require.lock_margin,
                _ => {
                    r.unknown("design.require", key, item, &["forward", "backward", "lock_margin"]);
                    continue;
                }
            };
            *value = r.positive(&place, item);
            if let (Some(v), true) = (*value, key != "lock_margin")
                && v > 1.0
            {
                let message = format!("no efficiency is above 1: {v}");
                r.report(Diagnostic::new(Code::OutOfRange, "", message), &place, item.span());
            }
        }
        require
    }

    fn target(item: &Item, place: &str, tolerance: &Rational, r: &mut Reader<'_>) -> Option<Asked> {
        const KEYS: [&str; 5] = ["state", "ratio", "step", "tolerance", "any_sign"];
        let Some(table) = item.as_table_like() else {
            r.kind(place, item, "a table");
            return None;
        };
        for (key, value) in table.iter().filter(|(k, _)| !KEYS.contains(k)) {
            r.unknown(place, key, value, &KEYS);
        }
        let state = match table.get("state") {
            Some(i) => match i.as_str() {
                Some(s) => Some(s.to_owned()),
                None => {
                    r.kind(&format!("{place}.state"), i, "the name of a state");
                    return None;
                }
            },
            None => None,
        };
        let any_sign = match table.get("any_sign") {
            Some(i) => match i.as_bool() {
                Some(b) => b,
                None => {
                    r.kind(&format!("{place}.any_sign"), i, "true or false");
                    return None;
                }
            },
            None => false,
        };
        let own = match table.get("tolerance") {
            Some(i) => r.rational(&format!("{place}.tolerance"), i)?,
            None => tolerance.clone(),
        };
        if own.sign() < 0 || own >= Rational::ONE {
            let d = Diagnostic::new(Code::OutOfRange, "", format!("a tolerance of {own} is not from 0 to below 1"));
            r.report(d, place, table.get("tolerance").and_then(Item::span));
            return None;
        }
        let step = match table.get("step") {
            Some(item) => {
                let at = format!("{place}.step");
                let window = match r.window(&at, item)? {
                    Window::Ends(ends) => ends,
                    Window::Aim(aim) => {
                        let off = &aim.abs() * &own;
                        [&aim - &off, &aim + &off]
                    }
                };
                if window[0].sign() <= 0 {
                    let message = format!("a step of {} is not above 0", window[0]);
                    r.report(Diagnostic::new(Code::OutOfRange, "", message), &at, item.span());
                    return None;
                }
                Some(window)
            }
            None => None,
        };
        let Some(ratio) = table.get("ratio") else {
            if step.is_some() {
                return Some(Asked { state, ratio: Ratio::any(), step, span: item.span() });
            }
            r.report(Diagnostic::new(Code::MissingKey, "", "a target needs a `ratio` or a `step`"), place, item.span());
            return None;
        };
        let at = format!("{place}.ratio");
        let read = match r.window(&at, ratio)? {
            Window::Ends(ends) => Ratio::within(ends, any_sign),
            Window::Aim(aim) => Ratio::near(aim, &own, any_sign),
        };
        if read.aim.is_zero() && read.windows[0][0].is_zero() {
            r.report(Diagnostic::new(Code::OutOfRange, "", "no train has the ratio 0"), &at, ratio.span());
            return None;
        }
        Some(Asked { state, ratio: read, step, span: ratio.span() })
    }

    fn sets(
        root: &Item,
        (planets, mismatch, gap, rules, modules): (Option<Counts>, &[i64], Length, &[Rule], &[f64]),
        r: &mut Reader<'_>,
    ) -> Vec<DesignedSet> {
        let mut found = vec![];
        let Some(all) = root.get("set") else { return found };
        for index in 0..tables(Some(all)) {
            let Some(set) = nth(all, index) else { continue };
            let place = format!("set[{index}]");
            let kind = set_kind(&set);
            let ranged = |i: Option<&Item>| i.is_some_and(|i| i.is_str() || i.is_array());
            let has_ranges = |kind: SetKind| {
                paths(kind).iter().any(|p| ranged(at(&set, p)))
                    || planet_tables(kind).iter().any(|p| ranged(at(&set, &format!("{p}.count"))))
            };
            let Some(kind) = kind else { continue };
            let name = set.get("name").and_then(Item::as_str).unwrap_or("").to_owned();
            if !has_ranges(kind) {
                continue;
            }
            if kind == SetKind::Wolfrom {
                let shape = (tables(set.get("suns")), tables(set.get("rings")));
                if shape != (1, 2) {
                    let message = format!(
                        "set `{name}`: ranges are known for stepped sets with one sun and one or two rings, or two rings \
                         alone, not {} and {}",
                        shape.0, shape.1
                    );
                    r.report(Diagnostic::new(Code::Unfit, "", message), &place, set.span());
                    continue;
                }
                let same = |p: &str| at(&set, p).map(|i| i.to_string().trim().to_owned());
                if same("suns.0.planet_teeth") != same("rings.0.planet_teeth") {
                    let message = format!(
                        "set `{name}`: the first ring must mesh with the step of the sun, with the same `planet_teeth`"
                    );
                    let d = Diagnostic::new(Code::Conflict, "", message).hint("write the same range for both");
                    r.report(d, &format!("{place}.rings[0].planet_teeth"), set.span());
                    continue;
                }
            }
            let mut gears = vec![];
            for path in paths(kind) {
                let full = format!("{place}.{}", path.replace(".0.", "[0].").replace(".1.", "[1]."));
                gears.push(match at(&set, path) {
                    Some(item) => r.teeth(&full, item),
                    None if path.contains("planet") => Some(Counts::range(6, super::range::MOST_TEETH)),
                    None => {
                        let d = Diagnostic::new(Code::MissingKey, "", format!("set `{name}` needs `{path}`"));
                        r.report(d.hint("write a number or a range"), &full, set.span());
                        None
                    }
                });
            }
            let own = planet_tables(kind).iter().find_map(|p| at(&set, &format!("{p}.count")).map(|i| (*p, i)));
            let planets = match own {
                Some((p, item)) => r.counts(&format!("{place}.{p}.count"), item),
                None => Some(planets.clone().unwrap_or_else(|| Counts::range(3, 3))),
            };
            let (Some(gears), Some(planets)) = (gears.into_iter().collect::<Option<Vec<_>>>(), planets) else {
                continue;
            };
            if planets.within(1, 64).count() == 0 || planets.least().is_some_and(|n| n < 1) {
                let message = format!("`{planets}` is no number of planets from 1 to 64");
                r.report(Diagnostic::new(Code::OutOfRange, "", message), &format!("{place}.planet.count"), None);
                continue;
            }
            if planets.within(1, 64).count() > super::space::MOST_PLANETS {
                let message = format!("`{planets}` are more than {} numbers of planets", super::space::MOST_PLANETS);
                r.report(Diagnostic::new(Code::OutOfRange, "", message), &format!("{place}.planet.count"), None);
                continue;
            }
            let geometry = match kind {
                SetKind::Wolfrom => at(&set, "rings.0.geometry").or(set.get("geometry")),
                _ => set.get("geometry"),
            };
            let own_module = geometry
                .and_then(|g| g.get("module"))
                .and_then(Item::as_str)
                .and_then(|t| units::parse(t, units::Dimension::LENGTH).ok())
                .map(|q| q.si());
            let angle = geometry
                .and_then(|g| g.get("pressure_angle"))
                .and_then(Item::as_str)
                .and_then(|t| units::parse(t, units::Dimension::ANGLE).ok())
                .map(|q| q.si());
            let mut space = SetSpace::new(kind, gears, planets).rules(rules.iter().copied()).gap(gap);
            space = space.mismatch(mismatch.iter().copied());
            space.rack = Rack::with_angle(angle);
            found.push(DesignedSet {
                index,
                name,
                space,
                modules: own_module.map_or_else(|| modules.to_vec(), |m| vec![m]),
                has_geometry: geometry.is_some(),
                has_losses: set.get("mesh_efficiency").is_some(),
            });
        }
        found
    }

    fn assemble(
        root: &Item,
        r: &mut Reader<'_>,
        mut sets: Vec<DesignedSet>,
        raw: Vec<Asked>,
        (limits, require, objectives, rules): (Limits, Requirements, Vec<Objective>, Vec<Rule>),
    ) -> Result<Self, Diagnostics> {
        let metric = sets.iter().all(|s| !s.modules.is_empty());
        if let (Some(limit), false) = (limits.ring_diameter, metric) {
            // A length needs modules; a bare number is one of modules.
            let is_text = root.get("design").and_then(|d| at(d, "limits.ring_diameter")).is_some_and(Item::is_str);
            if is_text {
                let d = Diagnostic::new(
                    Code::MissingKey,
                    "design.module",
                    format!("a ring diameter of {} mm is asked for, but no module is given", limit * 1e3),
                )
                .hint(
                    "add `module = \"0.5 mm\"` to `[design]`, or a `geometry` to the set, or give the limit in modules",
                );
                return Err(one(d));
            }
        }
        if let Some(limit) = limits.ring_diameter {
            for s in &mut sets {
                let module = s.modules.first().copied().filter(|_| metric).unwrap_or(1.0);
                // The largest number of teeth whose reference diameter is not above the limit.
                s.space.ring_limit = Some((limit / module * (1.0 + 1e-12)).floor().clamp(0.0, 1e9) as i64);
            }
        }
        let mut template: DocumentMut = match r.text.parse() {
            Ok(document) => document,
            Err(_) => return Err(one(Diagnostic::new(Code::Syntax, "", "the file is not valid TOML"))),
        };
        template.remove("design");
        let name = template.get("name").and_then(Item::as_str).unwrap_or("design").to_owned();
        // Any tooth numbers that close tell what the layout is.
        let mut any = template.clone();
        let mut wrong = Diagnostics::default();
        for s in &sets {
            // Those that need no shift first.
            let mut mismatch = s.space.mismatch.clone();
            mismatch.sort_by_key(|d| d.abs());
            let plain = SetSpace { rules: vec![], ring_limit: None, ..s.space.clone() };
            let first = |d: i64| plain.clone().mismatch([d]).all().next();
            let Some(teeth) = mismatch.into_iter().find_map(first) else {
                let ranges: Vec<String> =
                    s.space.kind.gears().iter().zip(&s.space.gears).map(|(n, c)| format!("{n} {c}")).collect();
                let message =
                    format!("set `{}`: no teeth of these ranges lie on one axis: {}", s.name, ranges.join(", "));
                let d = Diagnostic::new(Code::NotCoaxial, format!("set[{}]", s.index), message);
                wrong.push(d.hint("the ring needs s + 2 p teeth; widen a range, or allow a `mismatch`"));
                continue;
            };
            let short = (s.space.kind == SetKind::Ravigneaux).then(|| teeth[2]);
            let shifts = if s.has_geometry { s.shifts(&teeth, short) } else { None };
            substitute(&mut any, s, &teeth, s.space.planets[0], short, shifts.as_deref());
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let model = Model::from_toml(&any.to_string()).map_err(|mut e| {
            // The places are those of another text.
            e = e
                .iter()
                .cloned()
                .map(|mut d| {
                    d.span = None;
                    d
                })
                .fold(Diagnostics::default(), |mut all, d| {
                    all.push(d);
                    all
                });
            e
        })?;
        let mut kinds = vec![None; model.train().sets().len()];
        for s in &sets {
            if let Some(k) = model.train().sets().iter().position(|t| t.name == s.name) {
                kinds[k] = Some(s.space.kind);
            }
        }
        let layout = Layout::new(model.train(), &kinds)?;
        let mut targets: Vec<(usize, Target)> = vec![];
        let mut raw_steps = vec![];
        for (k, Asked { state, ratio, step, span }) in raw.into_iter().enumerate() {
            let place = format!("design.target[{k}].state");
            let found = match &state {
                Some(name) => layout.states.iter().position(|s| s.name == *name),
                None if layout.states.len() == 1 => Some(0),
                None => None,
            };
            match found {
                Some(n) if targets.iter().any(|t| t.0 == n) => {
                    let message = format!("state `{}` has two targets", layout.states[n].name);
                    let mut d = Diagnostic::new(Code::Conflict, place, message).hint("keep one of them");
                    d.span = span.map(Into::into);
                    wrong.push(d);
                }
                Some(n) => {
                    if let Some(window) = step {
                        raw_steps.push((k, n, window, span));
                    }
                    targets.push((n, Target { state: layout.states[n].name.clone(), ratio }));
                }
                None => {
                    let names = layout.states.iter().map(|s| s.name.as_str());
                    let unfit = layout.unfit.iter().find(|u| state.as_ref() == Some(&u.0));
                    let mut d = match &state {
                        Some(_) if unfit.is_some() => unfit.map(|u| u.1.clone()).expect("it was just found"),
                        Some(name) => Diagnostic::missing(Code::UnknownSelection, "state", name, names),
                        None => Diagnostic::new(
                            Code::MissingKey,
                            "",
                            "the train has several states: say which one is meant",
                        ),
                    };
                    d.place = place;
                    d.span = span.map(Into::into);
                    wrong.push(d);
                }
            }
        }
        let mut steps = vec![];
        for (k, n, window, span) in raw_steps {
            let Some(next) = layout.states.get(n + 1).map(|s| s.name.clone()) else {
                let message = format!("no state follows `{}`, so that it has no step", layout.states[n].name);
                let mut d = Diagnostic::new(Code::Conflict, format!("design.target[{k}].step"), message);
                d.span = span.map(Into::into);
                wrong.push(d.hint("a step is from a state to the next one of the file"));
                continue;
            };
            let mut place = |state: usize| {
                targets.iter().position(|t| t.0 == state).unwrap_or_else(|| {
                    let name = layout.states[state].name.clone();
                    targets.push((state, Target { state: name, ratio: Ratio::any() }));
                    targets.len() - 1
                })
            };
            let ends = [place(n), place(n + 1)];
            steps.push((ends, Step { state: layout.states[n].name.clone(), next, window }));
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        Ok(Self {
            steps,
            template,
            text: r.text.to_owned(),
            name,
            sets,
            layout,
            targets,
            limits,
            require,
            objectives,
            rules,
            metric,
        })
    }

    /// The text of the design file.
    pub fn to_toml(&self) -> &str {
        &self.text
    }

    /// What designs are judged by, in the order of the file.
    pub fn objectives(&self) -> &[Objective] {
        &self.objectives
    }

    /// The ratios that are asked for.
    pub fn targets(&self) -> impl Iterator<Item = &Target> {
        self.targets.iter().map(|(_, t)| t)
    }
}

/// Writes tooth numbers, planets and profile shifts into a train file.
pub(crate) fn substitute(
    document: &mut DocumentMut,
    set: &DesignedSet,
    teeth: &[i64],
    planets: i64,
    short: Option<i64>,
    shifts: Option<&[f64]>,
) {
    let kind = set.space.kind;
    let mut put = |path: &str, value: Value| write(document, set.index, path, value);
    let all = teeth.iter().copied().chain(short);
    for (path, z) in paths(kind).iter().zip(all) {
        put(path, z.into());
    }
    if kind == SetKind::Wolfrom {
        put("rings.0.planet_teeth", teeth[1].into());
    }
    for table in planet_tables(kind) {
        put(&format!("{table}.count"), planets.into());
    }
    if let Some(x) = shifts {
        let places: &[&str] = match kind {
            SetKind::Simple => &["sun.shift", "planet.shift", "ring.shift"],
            SetKind::Wolfrom => {
                &["suns.0.shift", "suns.0.planet.shift", "rings.0.shift", "rings.1.planet.shift", "rings.1.shift"]
            }
            SetKind::Stepped => &["suns.0.shift", "suns.0.planet.shift", "rings.0.planet.shift", "rings.0.shift"],
            SetKind::Rings => &["rings.0.shift", "rings.0.planet.shift", "rings.1.planet.shift", "rings.1.shift"],
            SetKind::Ravigneaux => {
                &["small_sun.shift", "large_sun.shift", "long_planet.shift", "ring.shift", "short_planet.shift"]
            }
        };
        for (path, x) in places.iter().zip(x) {
            put(path, (*x).into());
        }
        if kind == SetKind::Wolfrom {
            put("rings.0.planet.shift", x[1].into());
        }
    }
}

/// The face width of a train file whose designer gave none, in modules: a usual one.
pub(crate) const WIDTH_IN_MODULES: i64 = 10;

/// Gives a set without a geometry its module and a face width.
pub(crate) fn give_geometry(document: &mut DocumentMut, set: &DesignedSet, module: f64) {
    let length = |x: f64| format!("{} mm", (x * 1e9).round() / 1e6);
    write(document, set.index, "geometry.module", length(module).into());
    write(document, set.index, "geometry.width", length(module * WIDTH_IN_MODULES as f64).into());
}

/// Sets a value at a path within a set, with the tables on the way.
pub(crate) fn write(document: &mut DocumentMut, set: usize, path: &str, value: Value) {
    fn within(item: &mut Item, parts: &[&str], value: Value) {
        let Some((first, rest)) = parts.split_first() else {
            let decor = item.as_value().map(|v| v.decor().clone());
            *item = Item::Value(value);
            if let (Some(decor), Some(v)) = (decor, item.as_value_mut()) {
                *v.decor_mut() = decor;
            }
            return;
        };
        if let Ok(k) = first.parse::<usize>() {
            match item {
                Item::ArrayOfTables(a) => {
                    if let Some(t) = a.get_mut(k) {
                        // A table cannot be lent as an item: it goes out and comes back.
                        let mut own = Item::Table(std::mem::take(t));
                        within(&mut own, rest, value);
                        if let Item::Table(changed) = own {
                            *t = changed;
                        }
                    }
                }
                Item::Value(Value::Array(a)) => {
                    if let Some(v) = a.get_mut(k) {
                        let mut own = Item::Value(v.clone());
                        within(&mut own, rest, value);
                        if let Item::Value(changed) = own {
                            *v = changed;
                        }
                    }
                }
                _ => {}
            }
            return;
        }
        let Some(table) = item.as_table_like_mut() else { return };
        if table.get(first).is_none() {
            let fresh = if rest.is_empty() { Item::None } else { Item::Value(InlineTable::new().into()) };
            table.insert(first, if rest.is_empty() { Item::Value(value.clone()) } else { fresh });
        }
        if let Some(next) = table.get_mut(first) {
            within(next, rest, value);
        }
        if let Item::Value(Value::InlineTable(t)) = item {
            t.fmt();
        }
    }
    let parts: Vec<&str> = path.split('.').collect();
    let number = set.to_string();
    if let Some(sets) = document.get_mut("set") {
        within(sets, &[&[number.as_str()], &parts[..]].concat(), value);
    }
}

pub(crate) fn one(d: Diagnostic) -> Diagnostics {
    let mut all = Diagnostics::default();
    all.push(d);
    all
}
