//! What assembly of a train knows so far, and the checks that all its parts share.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt;

use crate::diagnostic::{Code, Diagnostic, Diagnostics, is_printable};
use crate::exact::Rational;
use crate::losses::Laws;

use super::described::MOST_TEETH;
use super::specification::EfficiencySpec;
use super::words::{clip, list};
use super::{Efficiency, LossTable, Member, MemberId, MemberKind, Mesh};

/// Gives the text of a table that a train file names, or says why it cannot.
pub(super) type Load<'l> = dyn FnMut(&str) -> Result<String, String> + 'l;

const MOST_COUNT: i64 = 1000;

/// Where expansion of the sets and resolution of names put what they find.
pub(super) struct Assembler<'a> {
    pub diagnostics: &'a mut Diagnostics,
    pub members: Vec<Member>,
    pub meshes: Vec<Mesh>,
    /// What it is about, and what was assumed of it.
    pub assumptions: Vec<(String, String)>,
    /// Planets with a mass and without an orbit.
    pub unplaced_masses: Vec<String>,
    pub laws: Laws,
    /// The coefficient of friction where nothing better is known.
    pub friction_coefficient: f64,
    pub loss_tables: Vec<LossTable>,
    pub by_name: HashMap<String, MemberId>,
    pub mesh_names: HashSet<String>,
    /// Reads the tables that the train names.
    pub load: &'a mut Load<'a>,
    /// Those read so far.
    pub files: BTreeMap<String, Result<String, String>>,
}

impl Assembler<'_> {
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Whether it is still worth looking for what a wrong name may have meant: the search compares
    /// it with every known name, and nobody reads hundreds of hints.
    pub fn hints_are_read(&self) -> bool {
        self.diagnostics.len() < 100
    }

    /// The member of that name, or an error at `place`.
    pub fn resolve(&mut self, name: &str, place: &dyn fmt::Display) -> Option<MemberId> {
        let found = self.by_name.get(name).copied();
        if found.is_none() && !self.hints_are_read() {
            self.report(Diagnostic::new(
                Code::UnknownName,
                place.to_string(),
                format!("there is no member `{}`", clip(name)),
            ));
        } else if found.is_none() {
            let known: Vec<&str> = self.members.iter().map(|m| m.name.as_str()).collect();
            let mut d =
                Diagnostic::new(Code::UnknownName, place.to_string(), format!("there is no member `{}`", clip(name)));
            d = d.suggest(name, known.iter().copied());
            if d.hints.is_empty() {
                d = d.hint(format!("name it in `members`, or use one of: {}", list(known)));
            }
            self.report(d);
        }
        found
    }

    /// The position of a name among those known of its kind (`key` in the file), or an error.
    pub fn position(&mut self, what: &str, key: &str, name: &str, place: String, known: &[&str]) -> Option<usize> {
        let found = known.iter().position(|k| *k == name);
        if found.is_none() {
            let mut d = Diagnostic::new(Code::UnknownName, place, format!("there is no {what} `{}`", clip(name)));
            if self.hints_are_read() {
                d = d.suggest(name, known.iter().copied());
            }
            if self.hints_are_read() && d.hints.is_empty() {
                d = d.hint(match known.len() {
                    0 => format!("add it as a [[{key}]]"),
                    _ => format!("the {what}s are: {}", list(known.to_vec())),
                });
            }
            self.report(d);
        }
        found
    }

    pub fn assume(&mut self, about: &str, what: impl Into<String>) {
        self.assumptions.push((about.to_owned(), what.into()));
    }

    /// The assumptions as sentences, one for all parts of which the same is assumed.
    pub fn assumptions(&self) -> Vec<String> {
        let mut all: Vec<(Vec<&str>, &str)> = Vec::new();
        for (about, what) in &self.assumptions {
            match all.iter_mut().find(|(_, w)| w == what) {
                Some((list, _)) => list.push(about),
                None => all.push((vec![about], what)),
            }
        }
        all.into_iter().map(|(about, what)| format!("{}: {what}", about.join(", "))).collect()
    }

    pub fn add_planet(&mut self, name: String) -> MemberId {
        let id = MemberId(self.members.len());
        self.by_name.insert(name.clone(), id);
        self.members.push(Member { name, kind: MemberKind::Planet });
        id
    }

    /// The name of a mesh that was given none: names given by the user stay theirs, and further
    /// meshes between the same members get a number.
    pub fn default_mesh_name(&mut self, base: String) -> String {
        let numbered = (2..).map(|k| format!("{base}-{k}"));
        let mut names = std::iter::once(base.clone()).chain(numbered);
        let name = names.find(|n| !self.mesh_names.contains(n)).expect("numbers do not end");
        self.mesh_names.insert(name.clone());
        name
    }

    /// A tooth count as a number to calculate with; out of range is reported once, here.
    pub fn teeth(&mut self, teeth: i64, place: &dyn fmt::Display) -> Rational {
        if !(1..=MOST_TEETH).contains(&teeth) {
            let message = format!("{teeth} teeth: a tooth count is an integer from 1 to {MOST_TEETH}");
            let mut d = Diagnostic::new(Code::OutOfRange, place.to_string(), message);
            if teeth < 0 {
                d = d.hint("a ring gear has `internal = true` (or is the `ring` of a set), not a negative tooth count");
            }
            self.report(d);
        }
        Rational::from(teeth.clamp(1, MOST_TEETH))
    }

    pub fn count(&mut self, count: i64, place: &dyn fmt::Display) -> u32 {
        if !(1..=MOST_COUNT).contains(&count) {
            let message = format!("a count of {count}: it is an integer from 1 to {MOST_COUNT}");
            self.report(Diagnostic::new(Code::OutOfRange, place.to_string(), message));
        }
        count.clamp(1, MOST_COUNT) as u32
    }

    pub fn efficiency(&mut self, spec: &EfficiencySpec, place: &dyn fmt::Display) -> Efficiency {
        let (Some(forward), Some(backward)) = (spec.forward(), spec.backward()) else {
            let message = "an efficiency that is no finite number: it is above 0 and at most 1";
            self.report(Diagnostic::new(Code::OutOfRange, place.to_string(), message));
            return Efficiency::lossless();
        };
        for value in [forward, backward] {
            if value.sign() <= 0 || *value > Rational::ONE {
                let shown = value.to_f64();
                let mut d = Diagnostic::new(
                    Code::OutOfRange,
                    place.to_string(),
                    format!("an efficiency of {shown}: it is above 0 and at most 1"),
                );
                if (1.0..=100.0).contains(&shown) {
                    d = d.hint(format!("if {shown} % is meant, write {}", shown / 100.0));
                }
                // The meshes of a set share one value, and its fault is told once.
                if !self.diagnostics.iter().rev().take(4).any(|e| *e == d) {
                    self.report(d);
                }
                return Efficiency::lossless();
            }
        }
        Efficiency { forward: forward.clone(), backward: backward.clone() }
    }
}

pub(super) fn check_name(a: &mut Assembler<'_>, name: &str, place: &str, reserve: bool) {
    let why = if name.trim().is_empty() {
        "a name cannot be empty"
    } else if name.chars().count() > 64 {
        "a name has at most 64 characters"
    } else if name.contains('.') && reserve {
        "a name has no dot (it separates a set from its planet)"
    } else {
        return check_text(a, "a name", name, place);
    };
    bad_name(a, name, place, why);
}

/// Refuses what cannot be shown.
pub(super) fn check_text(a: &mut Assembler<'_>, what: &str, text: &str, place: &str) {
    if let Some(c) = text.chars().find(|c| !is_printable(*c)) {
        let kind = if c.is_control() { "a control character" } else { "a character that cannot be shown" };
        bad_name(a, text, place, &format!("{what} has no U+{:04X}, {kind}", c as u32));
    }
}

pub(super) fn bad_name(a: &mut Assembler<'_>, name: &str, place: &str, why: &str) {
    a.report(Diagnostic::new(Code::BadName, place, format!("`{}`: {why}", clip(name))));
}

pub(super) fn unique<'n>(a: &mut Assembler<'_>, what: &str, path: &str, names: impl Iterator<Item = &'n str>) {
    let mut seen = HashSet::new();
    for (k, name) in names.enumerate() {
        let place = format!("{path}[{k}].name");
        check_name(a, name, &place, what == "set");
        if !seen.insert(name) {
            let message = format!("a second {what} is called `{}`", clip(name));
            a.report(Diagnostic::new(Code::DuplicateName, place, message).hint("give it another name"));
        }
    }
}
