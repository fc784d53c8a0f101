//! What is asked for, read from the request; the search for it, in parts.

use std::fmt::Display;
use std::str::FromStr;

use willis::Train;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::work::{Serial, Work};
use willis_synthesis::schemes::{
    Bounds, Harvest, HybridHarvest, HybridSearch, HybridWish, KNOWN, Known, Layout, MAX_SETS, ModeKind, Order, Search,
    SetRatio, Wish, usual_ratios,
};

use super::super::parts::part;
use super::{HybridResult, SchemeResult, Schemes, SchemesAnswer};
use crate::{Attachment, Refusal};

/// The most rows that are shown: each is analysed.
const MOST_SHOWN: usize = 50_000;
/// Tooth ratios, modes and rows that a list may have.
const MOST_LISTED: usize = 1000;

/// Whether a text is the digits of a layout and no name of a file.
pub(super) fn is_digits(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit())
        && text.chars().all(|c| c.is_ascii_digit() || ('a'..='h').contains(&c))
}

/// A search that is ready, and what is to be said with its answer.
pub(super) struct Plan {
    kind: Kind,
    /// Share `k` of `n`, counted from 0.
    shard: Option<[usize; 2]>,
    assumptions: Vec<String>,
}

enum Kind {
    Schemes { search: Box<Search>, known: Option<&'static Known> },
    Hybrids(Box<HybridSearch>),
}

/// What was kept of either search.
enum Kept {
    Schemes(Harvest),
    Hybrids(HybridHarvest),
}

/// Everything that is wrong with a request.
#[derive(Default)]
struct Wrong(Diagnostics);

/// A layout, and the tooth ratios of the train file from which it comes.
type OfFile = (Layout, Option<Vec<SetRatio>>);

impl Wrong {
    fn say(&mut self, code: Code, message: impl Into<String>, hint: impl Into<String>) {
        self.0.push(Diagnostic::new(code, "", message.into()).hint(hint.into()));
    }

    /// A value, if its text is one.
    fn read<T: FromStr<Err: Display>>(&mut self, field: &str, text: Option<&String>, hint: &str) -> Option<T> {
        match text?.trim().parse() {
            Ok(value) => Some(value),
            Err(why) => {
                self.say(Code::WrongType, format!("{field} {}: {why}", shown(text?)), hint);
                None
            }
        }
    }

    /// A field that must be there.
    fn needed(&mut self, field: &str, given: Option<usize>, instead: usize, hint: &str) -> usize {
        if given.is_none() {
            self.say(Code::MissingKey, format!("`{field}` is not given"), hint);
        }
        given.unwrap_or(instead)
    }
}

/// A text that may be long, for a message.
fn shown(text: &str) -> String {
    let short: String = text.chars().take(40).collect();
    if short.len() < text.len() { short + "…" } else { short }
}

impl Schemes {
    /// Options that do not belong to what is searched for, or exclude each other.
    fn fitting(&self) -> Result<(), Diagnostics> {
        let mut wrong = Wrong::default();
        let of_schemes = [
            ("layout", self.layout.is_some()),
            ("elements", self.elements.is_some()),
            ("closed", self.closed.is_some()),
            ("forward", self.forward.is_some()),
            ("reverse", self.reverse.is_some()),
            ("forward_range", self.forward_range.is_some()),
            ("reverse_range", self.reverse_range.is_some()),
            ("step", self.step.is_some()),
            ("progressive", self.progressive),
            ("not_minimal", self.not_minimal),
            ("max_speed", self.max_speed.is_some()),
            ("max_torque", self.max_torque.is_some()),
            ("min_efficiency", self.min_efficiency.is_some()),
            ("mesh_efficiency", !self.mesh_efficiency.is_empty()),
            ("max_brakes", self.max_brakes.is_some()),
            ("planar", self.planar),
            ("order", self.order.is_some()),
            ("sample", self.sample.is_some()),
            ("rediscover", self.rediscover.is_some()),
        ];
        let of_hybrids = [
            ("clutches", self.clutches.is_some()),
            ("need", !self.need.is_empty()),
            ("mobility", self.mobility.is_some()),
        ];
        let other: &[(&str, bool)] = if self.hybrid { &of_schemes } else { &of_hybrids };
        let given: Vec<String> =
            other.iter().filter(|(_, given)| *given).map(|(name, _)| format!("`{name}`")).collect();
        if !given.is_empty() {
            let (of, instead) = match self.hybrid {
                true => (
                    "shift schemes",
                    "hybrids have `sets`, `k`, `clutches`, `need` and `mobility`; or leave out `hybrid`",
                ),
                false => ("hybrids", "say `hybrid` too, or leave them out"),
            };
            let are = if given.len() == 1 { "belongs" } else { "belong" };
            wrong.say(Code::Conflict, format!("{} {are} to the search for {of}", given.join(", ")), instead);
        }
        for (name, count) in [("k", self.k.len()), ("need", self.need.len()), ("write", self.write.len())] {
            if count > MOST_LISTED {
                wrong.say(
                    Code::OutOfRange,
                    format!("`{name}` has {count} entries"),
                    format!("give {MOST_LISTED} at most"),
                );
            }
        }
        if self.write.contains(&0) {
            wrong.say(Code::OutOfRange, "there is no row 0", "rows are counted from 1");
        }
        let most = self.write.iter().copied().max().unwrap_or(0).max(self.top.unwrap_or(0));
        if most > MOST_SHOWN {
            let message = format!("{most} rows are more than are shown at once");
            wrong.say(Code::OutOfRange, message, format!("show {MOST_SHOWN} at most; the counts are of all of them"));
        } else if let (Some(top), Some(row)) = (self.top, self.write.iter().max())
            && *row > top
        {
            let message = format!("row {row} is to be written and {top} are to be shown");
            wrong.say(Code::Conflict, message, "leave out `top`, or give more");
        }
        if wrong.0.is_empty() { Ok(()) } else { Err(wrong.0) }
    }

    /// The search, with everything that is wrong with the request.
    pub(super) fn plan(&self) -> Result<Plan, Refusal> {
        let mut wrong = Wrong(self.fitting().err().unwrap_or_default());
        let mut assumptions = vec![];
        let shard = self.shard_of(&mut wrong);
        let layout = if self.hybrid { None } else { self.layout_of(&mut wrong)? };
        let sets = self.ratios(layout.as_ref(), &mut wrong, &mut assumptions);
        let has_sets = sets.is_some();
        let sets = sets.unwrap_or_default();
        let top = self.top.unwrap_or_else(|| self.write.iter().copied().max().unwrap_or(0).max(10));
        let kind = match self.hybrid {
            true => {
                let wish = self.hybrid_wish(sets, top, &mut wrong);
                self.ready(wish.check(), has_sets, wrong)?;
                Kind::Hybrids(Box::new(HybridSearch::new(&wish)?))
            }
            false => {
                let known = self.known(&mut wrong);
                let wish = self.wish(sets, layout.as_ref(), top, &mut wrong);
                self.ready(wish.check(), has_sets, wrong)?;
                Kind::Schemes { search: Box::new(Search::new(&wish)?), known }
            }
        };
        Ok(Plan { kind, shard, assumptions })
    }

    /// All that is wrong, with what the wish itself says. Where the sets are not known it speaks of things that nobody said.
    fn ready(&self, checked: Result<(), Diagnostics>, has_sets: bool, mut wrong: Wrong) -> Result<(), Diagnostics> {
        if let (Err(more), true) = (checked, has_sets) {
            wrong.0.extend(more);
        }
        if wrong.0.is_empty() { Ok(()) } else { Err(wrong.0) }
    }

    fn shard_of(&self, wrong: &mut Wrong) -> Option<[usize; 2]> {
        match part(self.shard.as_ref()?) {
            Ok((k, n)) => Some([usize::try_from(k - 1).ok()?, usize::try_from(n).ok()?]),
            Err(d) => {
                wrong.0.push(*d);
                None
            }
        }
    }

    /// The layout, and the tooth ratios of its train file.
    fn layout_of(&self, wrong: &mut Wrong) -> Result<Option<OfFile>, Refusal> {
        let Some(file) = &self.layout else { return Ok(None) };
        if file.text.is_empty() && is_digits(&file.name) {
            let hint = "three digits for each set: the shafts of sun, ring and carrier; 0 is the input, 1 the output, 2 the \
                        housing";
            let layout = wrong.read::<Layout>("layout", Some(&file.name), hint);
            return Ok(layout.map(|layout| (layout, None)));
        }
        if file.name.is_empty() && file.text.is_empty() {
            wrong.say(Code::MissingKey, "`layout` is empty", "name a train file, or give the digits of a layout");
            return Ok(None);
        }
        let read = Train::from_toml(&file.text).and_then(|train| Layout::of_train(&train));
        match read {
            Ok((layout, ratios)) => Ok(Some((layout, Some(ratios)))),
            Err(why) => Err(Refusal::File(why, file.clone())),
        }
    }

    /// The tooth ratio of each set; none where it is not known how many there are.
    fn ratios(
        &self,
        layout: Option<&OfFile>,
        wrong: &mut Wrong,
        assumptions: &mut Vec<String>,
    ) -> Option<Vec<SetRatio>> {
        let given: Vec<Option<SetRatio>> = (self.k.iter().take(MOST_LISTED))
            .map(|text| wrong.read("k", Some(text), "give ring over sun, as in 109/67 or 1.7"))
            .collect();
        let known = [
            self.sets.map(|n| (n, "`sets`")),
            (!given.is_empty()).then_some((given.len(), "`k`")),
            layout.map(|(own, _)| (own.sets(), "`layout`")),
        ];
        let known: Vec<(usize, &str)> = known.into_iter().flatten().collect();
        let Some(&(sets, first)) = known.first() else {
            // What is wrong with a layout has been said.
            if self.layout.is_some() && !self.hybrid {
                return None;
            }
            wrong.say(Code::MissingKey, "it is not said how many sets there are", "give `sets`, `k` or `layout`");
            return None;
        };
        if let Some((other, second)) = known.iter().find(|(n, _)| *n != sets) {
            let message = format!("{first} says {}, {second} {other}", crate::style::plural(sets, "set", "sets"));
            wrong.say(
                Code::Conflict,
                message,
                "leave out one of the two, or give as many tooth ratios as there are sets",
            );
            return None;
        }
        if let Some(own) = layout.and_then(|(_, ratios)| ratios.clone()) {
            if !given.is_empty() {
                let hint = "leave out `k`, or give the digits of the layout";
                wrong.say(
                    Code::Conflict,
                    "the train of `layout` has tooth ratios of its own, and `k` gives others",
                    hint,
                );
            }
            return Some(own);
        }
        if !given.is_empty() {
            // What cannot be read has been spoken of; the rest is looked at all the same.
            let stand_in = || "2".parse().ok();
            return given.into_iter().map(|k| k.or_else(stand_in)).collect();
        }
        if !(1..=MAX_SETS).contains(&sets) {
            wrong.say(Code::OutOfRange, format!("there are {sets} sets"), format!("there can be 1 to {MAX_SETS}"));
            return None;
        }
        let usual = usual_ratios(sets);
        let of = KNOWN.iter().find(|k| k.sets == usual).map_or(String::new(), |k| format!(", those of the {}", k.name));
        assumptions.push(format!("tooth ratios (ring/sun) {}{of}: no `k` is given", usual.join(", ")));
        usual.iter().map(|text| text.parse().ok()).collect()
    }

    fn known(&self, wrong: &mut Wrong) -> Option<&'static Known> {
        let name = self.rediscover.as_ref()?;
        let known = Known::named(name.trim());
        if known.is_none() {
            let names: Vec<&str> = KNOWN.iter().map(|k| k.id).collect();
            let message = format!("no known transmission is called `{}`", shown(name));
            // A part of a name that names one alone will do.
            let parts = names.iter().flat_map(|id| id.split('-')).filter(|part| Known::named(part).is_some());
            let said = Diagnostic::new(Code::UnknownSelection, "", message);
            let mut said = said.suggest(&name.to_lowercase(), names.iter().copied().chain(parts));
            said.replacement = None;
            wrong.0.push(said.hint(format!("there are {}", names.join(", "))));
        }
        known
    }

    fn wish(
        &self,
        sets: Vec<SetRatio>,
        layout: Option<&(Layout, Option<Vec<SetRatio>>)>,
        top: usize,
        wrong: &mut Wrong,
    ) -> Wish {
        // A layout leaves one freedom with so many closed elements.
        let own = layout.and_then(|(own, _)| own.shafts().checked_sub(own.sets() + 2)).filter(|n| *n > 0);
        let own = own.or_else(|| self.layout.as_ref().filter(|_| layout.is_none()).map(|_| 2));
        let hint = "how many elements are closed in every gear, as in 2";
        let closed = wrong.needed("closed", self.closed.or(own), 2, hint);
        let hint = "how many clutches and brakes there are, as in 5";
        let elements = wrong.needed("elements", self.elements, closed.saturating_add(1).min(8), hint);
        let forward = wrong.needed("forward", self.forward, 1, "how many forward gears there are, as in 6");
        const RANGE: &str = "write a range of positive numbers: 1.1..2.2, ..3 or 1/2..";
        let mut range =
            |field, text: &Option<String>| -> Bounds { wrong.read(field, text.as_ref(), RANGE).unwrap_or_default() };
        let forward_range = range("forward_range", &self.forward_range);
        let reverse_range = range("reverse_range", &self.reverse_range);
        let step = range("step", &self.step);
        const FACTOR: &str = "give a positive number: 3.5 or 7/2";
        let mut limit = |field, text: &Option<String>| -> Option<Rational> { wrong.read(field, text.as_ref(), FACTOR) };
        let max_speed = limit("max_speed", &self.max_speed);
        let max_torque = limit("max_torque", &self.max_torque);
        const PART: &str = "give a part of 1: 0.98 or 49/50";
        let min_efficiency = wrong.read("min_efficiency", self.min_efficiency.as_ref(), PART);
        let mut meshes =
            self.mesh_efficiency.iter().take(3).map(|text| wrong.read("mesh_efficiency", Some(text), PART));
        let mesh_efficiencies: Option<[Rational; 2]> = match [meshes.next(), meshes.next(), meshes.next()] {
            [None, ..] => Some(Wish::usual_meshes()),
            [Some(both), None, _] => both.map(|x: Rational| [x.clone(), x]),
            [Some(external), Some(internal), None] => external.zip(internal).map(|(a, b)| [a, b]),
            _ => {
                drop(meshes);
                let hint = "give one for both, or two: that of sun and planet, and that of planet and ring";
                wrong.say(Code::OutOfRange, "`mesh_efficiency` has more than two entries", hint);
                None
            }
        };
        let order: Option<Order> = wrong.read("order", self.order.as_ref(), "leave it out for the order of the names");
        let reverse = self.reverse.unwrap_or(1);
        if reverse == 0 && self.reverse_range.is_some() {
            let message = "a range of reverse ratios is given, and no reverse gear is wanted";
            wrong.say(Code::Conflict, message, "leave out `reverse_range`, or want a reverse gear");
        }
        Wish {
            sets,
            elements,
            closed,
            forward,
            reverse,
            forward_range,
            reverse_range,
            step,
            progressive: self.progressive,
            minimal: !self.not_minimal,
            max_speed,
            max_torque,
            min_efficiency,
            // What cannot be read has been spoken of.
            mesh_efficiencies: mesh_efficiencies.unwrap_or([Rational::ONE, Rational::ONE]),
            max_brakes: self.max_brakes,
            planar: self.planar,
            layout: layout.map(|(own, _)| *own),
            sample: self.sample.unwrap_or(1),
            order: order.unwrap_or_default(),
            top,
        }
    }

    fn hybrid_wish(&self, sets: Vec<SetRatio>, top: usize, wrong: &mut Wrong) -> HybridWish {
        let clutches = wrong.needed("clutches", self.clutches, 1, "how many clutches and brakes there are, as in 3");
        let need = (self.need.iter().take(MOST_LISTED))
            .filter_map(|text| wrong.read("need", Some(text), "name kinds of modes with commas between"));
        let need: Vec<ModeKind> = need.collect();
        // What was named and is none has been spoken of.
        let need = if need.is_empty() && !self.need.is_empty() { vec![ModeKind::Fixed] } else { need };
        HybridWish { sets, clutches, mobility: self.mobility.unwrap_or(3), need, top }
    }
}

/// Patience as usual, whatever somebody has allowed for the search itself.
struct Usual<'a>(&'a dyn Work);

impl Work for Usual<'_> {
    fn begin(&self, what: &'static str, of: u64) {
        self.0.begin(what, of);
    }

    fn advance(&self, steps: u64) {
        self.0.advance(steps);
    }

    fn patience(&self) -> f64 {
        self.0.patience().min(Serial.patience())
    }

    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }

    fn run(&self, parts: usize, job: &(dyn Fn(usize) + Sync)) {
        self.0.run(parts, job);
    }
}

impl Plan {
    fn parts(&self) -> usize {
        match &self.kind {
            Kind::Schemes { search, .. } => search.parts(),
            Kind::Hybrids(search) => search.parts(),
        }
    }

    /// What was kept before, merged.
    fn kept(&self, resume: &[Attachment]) -> Result<Kept, Refusal> {
        let mut kept = match &self.kind {
            Kind::Schemes { .. } => Kept::Schemes(Harvest::default()),
            Kind::Hybrids(_) => Kept::Hybrids(HybridHarvest::default()),
        };
        for file in resume {
            self.add(&mut kept, &file.text).map_err(|wrong| Refusal::File(wrong, file.clone()))?;
        }
        Ok(kept)
    }

    fn add(&self, kept: &mut Kept, text: &str) -> Result<(), Diagnostics> {
        match (&self.kind, kept) {
            (Kind::Schemes { search, .. }, Kept::Schemes(whole)) => whole.merge(search, Harvest::read(text, search)?),
            (Kind::Hybrids(search), Kept::Hybrids(whole)) => whole.merge(search, HybridHarvest::read(text, search)?),
            _ => Ok(()),
        }
    }

    /// The parts that were asked for and are not there yet, and how many there will be with those that are.
    fn left(&self, kept: &Kept) -> (Vec<usize>, usize) {
        let done = match kept {
            Kept::Schemes(own) => own.parts(),
            Kept::Hybrids(own) => own.parts(),
        };
        let [k, n] = self.shard.unwrap_or([0, 1]);
        let wanted = (k..self.parts()).step_by(n);
        let left: Vec<usize> = wanted.filter(|part| done.binary_search(part).is_err()).collect();
        let asked = left.len() + done.len();
        (left, asked)
    }

    fn harvest(&self, kept: &mut Kept, parts: &[usize], work: &dyn Work) -> Result<(), Refusal> {
        match (&self.kind, kept) {
            (Kind::Schemes { search, .. }, Kept::Schemes(whole)) => {
                search.afford_parts(work, parts.len())?;
                search.harvest(work, parts.iter().copied(), whole);
            }
            (Kind::Hybrids(search), Kept::Hybrids(whole)) => {
                search.afford_parts(work, parts.len())?;
                search.harvest(work, parts.iter().copied(), whole);
            }
            _ => {}
        }
        Ok(())
    }

    /// The answer of what was found.
    fn answer(&self, kept: Kept, asked: usize, work: &dyn Work) -> SchemesAnswer {
        match (&self.kind, kept) {
            (Kind::Schemes { search, known }, Kept::Schemes(harvest)) => {
                let mut all = search.answer(&harvest);
                all.completeness.asked = asked;
                all.assumptions.clone_from(&self.assumptions);
                all.rediscovered = known.map(|known| {
                    let mut found = known.rediscover(search);
                    let id = found.scheme.as_ref().map(|scheme| scheme.id.clone());
                    found.row = all.schemes.iter().position(|s| Some(&s.id) == id.as_ref()).map(|k| k + 1);
                    found
                });
                all.rate(work);
                let whole = all.completeness.done == all.completeness.parts && search.wish().sample == 1;
                if whole && all.found.schemes == 0 {
                    all.relax(&Usual(work));
                }
                SchemesAnswer::Schemes(Box::new(SchemeResult { all, harvest }))
            }
            (Kind::Hybrids(search), Kept::Hybrids(harvest)) => {
                let mut all = search.answer(&harvest);
                all.completeness.asked = asked;
                all.assumptions.clone_from(&self.assumptions);
                SchemesAnswer::Hybrids(Box::new(HybridResult { all, harvest }))
            }
            _ => unreachable!("what is kept is of the kind that is searched"),
        }
    }

    pub(super) fn ask(&self, resume: &[Attachment], work: &dyn Work) -> Result<SchemesAnswer, Refusal> {
        let mut kept = self.kept(resume)?;
        let (left, asked) = self.left(&kept);
        self.harvest(&mut kept, &left, work)?;
        Ok(self.answer(kept, asked, work))
    }

    pub(super) fn piece(&self, resume: &[Attachment], k: usize, n: usize, work: &dyn Work) -> Result<Vec<u8>, Refusal> {
        let (left, _) = self.left(&self.kept(resume)?);
        // Every n-th part from the k-th on: parts beside each other take alike long, so that all pieces do. What is passed
        // over belongs to the other pieces; `gather` refuses an answer in which a part is missing.
        let own: Vec<usize> = left.into_iter().skip(k).step_by(n.max(1)).collect();
        let mut kept = self.kept(&[])?;
        self.harvest(&mut kept, &own, work)?;
        let (text, done) = match &kept {
            Kept::Schemes(found) => (found.to_json(), found.parts().len()),
            Kept::Hybrids(found) => (found.to_json(), found.parts().len()),
        };
        if done < own.len() { Err(Refusal::Cancelled) } else { Ok(text.into_bytes()) }
    }

    pub(super) fn gather(&self, resume: &[Attachment], pieces: &[Vec<u8>]) -> Result<SchemesAnswer, Refusal> {
        let mut kept = self.kept(resume)?;
        let (_, asked) = self.left(&kept);
        for piece in pieces {
            let text = std::str::from_utf8(piece).unwrap_or_default();
            self.add(&mut kept, text)?;
        }
        let (left, _) = self.left(&kept);
        if !left.is_empty() {
            let message = format!("{} of {asked} parts of the search are in none of the pieces", left.len());
            return Err(Diagnostic::new(Code::Unfit, "", message).hint("give every piece once").into());
        }
        Ok(self.answer(kept, asked, &Serial))
    }
}
