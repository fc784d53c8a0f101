//! All schemes as an answer.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::Diagnostics;
use willis::exact::Rational;
use willis::work::{Effort, Work};

use super::harvest::Harvest;
use super::known::{Known, Rediscovered};
use super::scheme::Scheme;
use super::search::Search;
use super::wish::{Bounds, Order, Wish};

/// The space that was searched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SchemeSpace {
    /// Sets of the train.
    pub sets: usize,
    /// Shafts besides the housing.
    pub shafts: usize,
    /// Layouts of the space, whether or not they were reached.
    pub layouts: u64,
    /// Layouts that were examined.
    pub examined: u64,
    /// Choices of elements in these layouts, no two elements kinematically the same: each was examined, or excluded by
    /// the number of its states that can be gears.
    pub choices: u64,
}

/// How much of the space the answer covers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SchemeCompleteness {
    /// Whether it is all of it.
    pub complete: bool,
    /// Parts of the work.
    pub parts: usize,
    /// Parts that were asked for: all, or those of a share.
    pub asked: usize,
    /// Parts that are done.
    pub done: usize,
    /// The share of the parts that is done.
    pub share: f64,
    /// One of so many layouts was examined.
    pub sample: usize,
    /// All of this in words.
    pub statement: String,
}

/// How many choices of elements are left after a rule.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SchemeStage {
    /// The rule: `choices`, `states`, `chain`, `reverse`, `attached`, `minimal`, `limits`, `planar`.
    pub rule: String,
    /// What it asks, in words.
    pub about: String,
    /// What is left.
    pub left: u64,
}

/// How many schemes there are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FoundSchemes {
    /// Layouts that have a scheme.
    pub layouts: u64,
    /// Schemes.
    pub schemes: u64,
    /// Schemes that differ in more than the place of an element that does the same to all speeds.
    pub classes: u64,
    /// Schemes by their number of brakes.
    pub by_brakes: BTreeMap<usize, u64>,
}

/// What there would be if one rule gave way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SchemeRelaxation {
    /// What gives way, in words.
    pub change: String,
    /// How many schemes there are then; absent where that was not searched.
    pub schemes: Option<u64>,
    /// How far it must give way for the first of them: the smallest largest step, speed or torque, or the largest smallest
    /// efficiency that there is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<f64>,
    /// Why it was not searched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// All shift schemes that do what is wanted. Serialised it is the contract `willis-schemes-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Schemes {
    /// `willis-schemes-1`.
    pub format: Format<Self>,
    /// What was wanted.
    pub wish: Wish,
    /// What was searched.
    pub space: SchemeSpace,
    /// How much of it.
    pub completeness: SchemeCompleteness,
    /// What each rule left, in the order in which they are applied.
    pub waterfall: Vec<SchemeStage>,
    /// What was found.
    pub found: FoundSchemes,
    /// The first schemes in the order of the wish, confirmed by rational arithmetic.
    pub schemes: Vec<Scheme>,
    /// If nothing was found: what there is where one rule gives way.
    pub relaxations: Vec<SchemeRelaxation>,
    /// The known transmission that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rediscovered: Option<Rediscovered>,
    /// What was taken where nothing was said.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumptions: Vec<String>,
}

impl Contract for Schemes {
    const FORMAT: &'static str = "willis-schemes-1";
}

impl Search {
    /// Searches the whole space.
    ///
    /// # Errors
    /// It would take longer than the [patience](Work::patience) of the surroundings: with the size of the space, and how
    /// to narrow it.
    pub fn run(&self, work: &dyn Work) -> Result<Schemes, Diagnostics> {
        self.afford(work)?;
        let mut harvest = Harvest::default();
        self.harvest(work, 0..self.parts(), &mut harvest);
        Ok(self.answer(&harvest))
    }

    /// The answer that parts give.
    pub fn answer(&self, harvest: &Harvest) -> Schemes {
        Schemes::of(self, harvest)
    }
}

impl Schemes {
    fn of(search: &Search, harvest: &Harvest) -> Self {
        let wish = search.wish();
        let tally = harvest.tally();
        let stage = |rule: &str, about: String, left: u64| SchemeStage { rule: rule.into(), about, left };
        let states = super::table::binomial(wish.elements, wish.closed);
        let mut waterfall = vec![
            stage("choices", "elements of which no two do the same".into(), tally.choices),
            stage(
                "states",
                format!(
                    "enough of the {states} states have a ratio for {} forward and {} reverse gears",
                    wish.forward, wish.reverse
                ),
                tally.enough,
            ),
            stage("chain", format!("{} gears in a row, one element off and one on", wish.forward), tally.chain),
            stage("reverse", format!("{} reverse", wish.reverse), tally.reverse),
            stage("attached", "no shaft dangles".into(), tally.attached),
        ];
        if wish.minimal {
            waterfall.push(stage("minimal", "no element can be left out".into(), tally.minimal));
        }
        if wish.min_efficiency.is_some() {
            let about = "speeds, torques, brakes and efficiencies within their limits";
            waterfall.push(stage("limits", about.into(), tally.limits));
        } else if wish.max_speed.is_some() || wish.max_torque.is_some() || wish.max_brakes.is_some() {
            waterfall.push(stage("limits", "speeds, torques and brakes within their limits".into(), tally.limits));
        }
        if wish.planar {
            waterfall.push(stage("planar", "can be drawn without a crossing".into(), tally.schemes));
        }
        let rows = harvest.rows().iter().filter_map(|row| {
            let mut scheme = Scheme::new(wish, row.layout, &row.elements)?;
            scheme.known = Known::of(&row.layout, &row.elements).map(str::to_owned);
            Some(scheme)
        });
        let schemes: Vec<Scheme> = rows.collect();
        // Rational numbers do not confirm these: the counts are not to be trusted then.
        let unconfirmed = harvest.rows().len() - schemes.len();
        let (parts, done) = (search.parts(), harvest.done());
        let complete = done == parts && wish.sample == 1 && unconfirmed == 0;
        let share = if parts == 0 { 1.0 } else { done as f64 / parts as f64 };
        let space = SchemeSpace {
            sets: wish.sets.len(),
            shafts: wish.shafts(),
            layouts: search.layouts(),
            examined: tally.layouts,
            choices: tally.choices,
        };
        let mut statement = statement(wish, &space, tally.schemes, complete, share);
        if unconfirmed > 0 {
            statement += &format!(
                " Rational arithmetic does not confirm {unconfirmed} of the {} schemes to be shown: they are left out, and \
                 the counts are not certain.",
                harvest.rows().len()
            );
        }
        Self {
            format: Format::new(),
            wish: wish.clone(),
            completeness: SchemeCompleteness {
                complete,
                parts,
                asked: parts,
                done,
                share,
                sample: wish.sample,
                statement,
            },
            space,
            waterfall,
            found: FoundSchemes {
                layouts: tally.layouts_with_scheme,
                schemes: tally.schemes,
                classes: tally.classes,
                by_brakes: tally.by_brakes.clone(),
            },
            schemes,
            relaxations: vec![],
            rediscovered: None,
            assumptions: vec![],
        }
    }

    /// For an empty answer: what there is where one rule of the wish gives way, each found by a search of its own. What
    /// is not searched, because all of them would take too long for the surroundings or were stopped, is listed with the
    /// reason.
    pub fn relax(&mut self, work: &dyn Work) {
        let mut seconds = 0.0;
        for (change, wish) in relaxed(&self.wish) {
            self.relaxations.push(match relaxation(&wish, work, &mut seconds) {
                Ok((schemes, until)) => SchemeRelaxation { change, schemes: Some(schemes), until, reason: None },
                Err(why) => SchemeRelaxation { change, schemes: None, until: None, reason: Some(why) },
            });
        }
    }
}

/// How many schemes there are, and how far the first goes in what the wish orders by.
fn relaxation(wish: &Wish, work: &dyn Work, seconds: &mut f64) -> Result<(u64, Option<f64>), String> {
    let first = |wrong: Diagnostics| wrong.iter().next().map_or_else(String::new, |d| d.message.clone());
    let search = Search::new(wish).map_err(first)?;
    // All of them together.
    let effort = search.effort();
    work.afford(&Effort { seconds: *seconds + effort.seconds, ..effort })
        .map_err(|why| format!("not searched, {why}"))?;
    *seconds += effort.seconds;
    let mut harvest = Harvest::default();
    search.harvest(work, 0..search.parts(), &mut harvest);
    if harvest.done() < search.parts() {
        return Err("the search was stopped".into());
    }
    let until = harvest.rows().first().filter(|_| wish.order != Order::Found).map(|row| row.key.abs());
    Ok((harvest.tally().schemes, until))
}

/// Wishes with one rule less, and what it is. They are ordered by what the rule limits, where that has an order.
fn relaxed(wish: &Wish) -> Vec<(String, Wish)> {
    let mut all = vec![];
    let base = Wish { top: 0, order: Order::Found, ..wish.clone() };
    if wish.forward > 1 {
        let forward = wish.forward - 1;
        all.push((format!("{forward} forward gears instead of {}", wish.forward), Wish { forward, ..base.clone() }));
    }
    if wish.reverse > 0 {
        let reverse = wish.reverse - 1;
        all.push((format!("{reverse} reverse gears instead of {}", wish.reverse), Wish { reverse, ..base.clone() }));
    }
    if wish.step != Bounds::default() {
        let free = Bounds::default();
        all.push((
            format!("steps of any size instead of {}", decimals(&wish.step)),
            Wish { step: free, ..base.clone() },
        ));
    }
    if let Bounds { min: Some(min), max: Some(max) } = &wish.step {
        let upward = Bounds { min: Some(min.clone()), max: None };
        let change = format!("steps of {} and more, without an upper end", significant(min));
        all.push((change, Wish { step: upward, order: Order::Step, top: 1, ..base.clone() }));
        let downward = Bounds { min: None, max: Some(max.clone()) };
        let change = format!("steps of up to {}, without a lower end", significant(max));
        all.push((change, Wish { step: downward, ..base.clone() }));
    }
    if wish.forward_range != Bounds::default() {
        let change = format!("forward ratios of any size instead of {}", decimals(&wish.forward_range));
        all.push((change, Wish { forward_range: Bounds::default(), ..base.clone() }));
    }
    if wish.reverse > 0 && wish.reverse_range != Bounds::default() {
        let change = format!("reverse ratios of any size instead of {}", decimals(&wish.reverse_range));
        all.push((change, Wish { reverse_range: Bounds::default(), ..base.clone() }));
    }
    if wish.progressive {
        all.push(("steps that may grow".into(), Wish { progressive: false, ..base.clone() }));
    }
    if wish.minimal {
        all.push(("elements that can be left out".into(), Wish { minimal: false, ..base.clone() }));
    }
    if let Some(limit) = &wish.max_speed {
        let change = format!("no limit on speeds instead of {}", significant(limit));
        all.push((change, Wish { max_speed: None, order: Order::Speed, top: 1, ..base.clone() }));
    }
    if let Some(limit) = &wish.max_torque {
        let change = format!("no limit on torques instead of {}", significant(limit));
        all.push((change, Wish { max_torque: None, order: Order::Torque, top: 1, ..base.clone() }));
    }
    if let Some(limit) = &wish.min_efficiency {
        let change = format!("efficiencies of any size instead of {} and more", significant(limit));
        all.push((change, Wish { min_efficiency: None, order: Order::Efficiency, top: 1, ..base.clone() }));
    }
    if let Some(most) = wish.max_brakes {
        all.push((format!("any number of brakes instead of {most}"), Wish { max_brakes: None, ..base.clone() }));
    }
    if wish.planar {
        all.push(("drawings that cross".into(), Wish { planar: false, ..base.clone() }));
    }
    all
}

/// A number as a decimal for words.
fn significant(x: &Rational) -> String {
    let text = format!("{:.4}", x.to_f64());
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A range in decimals for words.
fn decimals(range: &Bounds) -> String {
    let end = |end: &Option<Rational>| end.as_ref().map_or_else(String::new, significant);
    format!("{}..{}", end(&range.min), end(&range.max))
}

fn statement(wish: &Wish, space: &SchemeSpace, schemes: u64, complete: bool, share: f64) -> String {
    let what = match &wish.layout {
        Some(layout) => format!("The layout {layout}"),
        None => format!("All layouts of {} simple sets with {} shafts besides the housing", space.sets, space.shafts),
    };
    let ratios: Vec<String> = wish.sets.iter().map(ToString::to_string).collect();
    let mut text = format!(
        "{what}, tooth ratios {}, {} of {} elements closed in every gear: {}, {} choices of elements that differ \
         in what they do, ",
        ratios.join(", "),
        wish.closed,
        wish.elements,
        if space.examined == 1 { "1 layout".to_owned() } else { format!("{} layouts", space.examined) },
        space.choices,
    );
    if complete {
        text += &format!(
            "all examined or excluded by bounds with a margin for rounding; {schemes} satisfy; nothing else exists in this space."
        );
    } else if wish.sample > 1 {
        text +=
            &format!("a sample of one in {} layouts; {schemes} satisfy; others exist outside the sample", wish.sample);
        text += if share < 1.0 { ", and the search of it was not finished." } else { "." };
    } else {
        text += &format!(
            "{:.1} % of the parts of the space are finished; {schemes} satisfy there; the rest was not examined.",
            100.0 * share
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use willis::work::Serial;

    /// A scheme that rational numbers do not confirm is not left out without a word.
    #[test]
    fn an_unconfirmed_scheme_is_spoken_of() {
        let mut wish = Wish::new(&["62/26", "74/42"], 4, 2, 3).unwrap();
        [wish.forward_range, wish.step, wish.reverse_range] =
            ["1/2..5", "1.15..2.2", "1.2..5"].map(|b| b.parse().unwrap());
        let search = Search::new(&wish).unwrap();
        let mut harvest = Harvest::default();
        search.harvest(&Serial, 0..search.parts(), &mut harvest);
        let sound = search.answer(&harvest);
        assert!(sound.completeness.complete && sound.completeness.statement.contains("with a margin for rounding"));
        // Four times the same element: no scheme at all.
        let mut kept = serde_json::to_value(&harvest).unwrap();
        let elements = &mut kept["rows"][0]["elements"];
        let first = elements[0].clone();
        elements.as_array_mut().unwrap().fill(first);
        let answer = search.answer(&serde_json::from_value(kept).unwrap());
        assert_eq!(answer.schemes.len() + 1, sound.schemes.len());
        assert!(!answer.completeness.complete);
        assert!(
            answer.completeness.statement.contains("does not confirm 1 of the"),
            "{}",
            answer.completeness.statement
        );
    }
}
