//! What parts of a search have found: kept, read back, merged.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};

use super::layout::Layout;

/// How many layouts and choices of elements came how far.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Tally {
    /// Layouts that were walked.
    pub(crate) layouts: u64,
    /// Of these, those that are an earlier one with sets of one ratio exchanged.
    pub(crate) exchanged: u64,
    /// Of the others, those whose equations depend on each other or whose input or output cannot turn.
    pub(crate) dependent: u64,
    /// Choices of elements, no two of them kinematically the same.
    pub(crate) choices: u64,
    /// Of these, those with enough states that can be gears.
    pub(crate) enough: u64,
    /// With a chain of forward gears.
    pub(crate) chain: u64,
    /// With reverse gears.
    pub(crate) reverse: u64,
    /// With no shaft that dangles.
    pub(crate) attached: u64,
    /// With no element that can be left out.
    pub(crate) minimal: u64,
    /// With speeds, torques and brakes within their limits.
    pub(crate) limits: u64,
    /// All that is wanted.
    pub(crate) schemes: u64,
    pub(crate) classes: u64,
    pub(crate) layouts_with_scheme: u64,
    pub(crate) by_brakes: BTreeMap<usize, u64>,
}

impl Tally {
    pub(crate) fn add(&mut self, other: &Self) {
        let sum = |own: &mut u64, more: u64| *own = own.saturating_add(more);
        sum(&mut self.layouts, other.layouts);
        sum(&mut self.exchanged, other.exchanged);
        sum(&mut self.dependent, other.dependent);
        sum(&mut self.choices, other.choices);
        sum(&mut self.enough, other.enough);
        sum(&mut self.chain, other.chain);
        sum(&mut self.reverse, other.reverse);
        sum(&mut self.attached, other.attached);
        sum(&mut self.minimal, other.minimal);
        sum(&mut self.limits, other.limits);
        sum(&mut self.schemes, other.schemes);
        sum(&mut self.classes, other.classes);
        sum(&mut self.layouts_with_scheme, other.layouts_with_scheme);
        for (brakes, count) in &other.by_brakes {
            sum(self.by_brakes.entry(*brakes).or_default(), *count);
        }
    }
}

/// A scheme by its name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Row {
    /// What it is ordered by; the smallest comes first.
    pub(crate) key: f64,
    pub(crate) layout: Layout,
    pub(crate) elements: Vec<[u8; 2]>,
}

impl Row {
    pub(crate) fn order(&self, other: &Self) -> std::cmp::Ordering {
        let by_key = self.key.total_cmp(&other.key);
        by_key.then_with(|| self.layout.cmp(&other.layout)).then_with(|| self.elements.cmp(&other.elements))
    }
}

/// What the parts that are done have found. It can be kept, read back, gone on with, and merged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Harvest {
    /// `willis-schemes-progress-1`.
    format: Format<Self>,
    /// What it belongs to: the wish as JSON.
    pub(crate) wish: String,
    /// Parts that are done, growing.
    pub(crate) done: Vec<usize>,
    pub(crate) tally: Tally,
    /// The best of them.
    pub(crate) rows: Vec<Row>,
}

impl Contract for Harvest {
    const FORMAT: &'static str = "willis-schemes-progress-1";
}

impl Harvest {
    /// How many parts are done.
    pub fn done(&self) -> usize {
        self.done.len()
    }

    /// The parts that are done, growing.
    pub fn parts(&self) -> &[usize] {
        &self.done
    }

    pub(crate) fn tally(&self) -> &Tally {
        &self.tally
    }

    pub(crate) fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// As JSON, for [`Harvest::read`].
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("plain data") + "\n"
    }
}

/// Reads what was kept.
pub(crate) fn parse<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, Diagnostics> {
    serde_json::from_str(text).map_err(|why| {
        let message = format!("this is no progress of such a search: {why}");
        Diagnostic::new(Code::Unfit, "", message).hint("give a file that `--progress` wrote for the same wish").into()
    })
}

/// What was changed by somebody else.
pub(crate) fn spoilt() -> Diagnostics {
    let message = "the numbers of this progress contradict each other: it was changed or damaged";
    Diagnostic::new(Code::Unfit, "", message).hint("search these parts again").into()
}

/// Whether results belong to a search with so many parts.
pub(crate) fn fits(wish: &str, own: &str, done: &[usize], parts: usize) -> Result<(), Diagnostics> {
    if !wish.is_empty() && wish != own {
        let mut message = "results of a search with another wish cannot be added to this one".to_owned();
        let fields = |text: &str| serde_json::from_str::<serde_json::Map<String, serde_json::Value>>(text).ok();
        if let (Some(theirs), Some(ours)) = (fields(wish), fields(own)) {
            let all: std::collections::BTreeSet<&String> = theirs.keys().chain(ours.keys()).collect();
            let other: Vec<&str> =
                all.into_iter().filter(|key| theirs.get(*key) != ours.get(*key)).map(String::as_str).collect();
            message += &format!("; {} differs", other.join(", "));
        }
        return Err(Diagnostic::new(Code::Unfit, "", message).hint("ask with the wish of that search").into());
    }
    let is_kept = !wish.is_empty() || done.is_empty();
    if !is_kept || !done.is_sorted_by(|a, b| a < b) || done.last().is_some_and(|last| *last >= parts) {
        let message = "a part that the search does not have, or one twice, is given as done";
        return Err(Diagnostic::new(Code::Unfit, "", message).hint("search these parts again").into());
    }
    Ok(())
}

/// Whether no part is in two results.
pub(crate) fn apart(one: &[usize], other: &[usize]) -> Result<(), Diagnostics> {
    let Some(part) = other.iter().find(|part| one.binary_search(part).is_ok()) else { return Ok(()) };
    let message = format!("part {part} of the search is in both results");
    Err(Diagnostic::new(Code::Conflict, "", message).hint("give every part once").into())
}

/// Those of some parts that there are and that are not done, each once, in order.
pub(super) fn missing(parts: impl IntoIterator<Item = usize>, of: usize, done: &[usize]) -> Vec<usize> {
    let mut all: Vec<usize> =
        parts.into_iter().filter(|part| *part < of && done.binary_search(part).is_err()).collect();
    all.sort_unstable();
    all.dedup();
    all
}
