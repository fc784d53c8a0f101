//! What was assumed, which laws were in force with their sources and ranges, and how to do it all again.

use willis::diagnostic::{Code, Diagnostic, Severity};
use willis::losses::{LawSummary, Tag, Trust, entries};
use willis::units::for_people;

use super::Findings;
use super::results::{significant, single};
use crate::parts::words::{self, Names};
use crate::report::document::{Block, Column, Level, Section};

pub fn assumptions(all: &Findings<'_>) -> Section {
    let mut blocks = vec![];
    match all.analysis.assumptions.is_empty() {
        true => blocks.push(Block::Text { text: "Nothing stands in for data that were not given.".into() }),
        false => blocks.push(Block::List { items: all.analysis.assumptions.clone() }),
    }
    // What friction at rest leaves open stands at its operating point.
    for d in all.analysis.diagnostics.iter().filter(|d| d.code != Code::Stiction) {
        let level = match d.severity {
            Severity::Warning | Severity::Error => Level::Warning,
            _ => Level::Note,
        };
        blocks.push(Block::Notice { level, text: told(d) });
    }
    if all.analysis.diagnostics.is_empty() {
        blocks.push(Block::Text { text: "There are no warnings.".into() });
    }
    Section { title: "Assumptions and warnings".into(), blocks }
}

/// A warning or note, where it comes from, and the code under which it is explained.
pub fn told(d: &Diagnostic) -> String {
    let place = if d.place.is_empty() { String::new() } else { format!("{}; ", words::place(&d.place)) };
    format!("{} ({place}{})", d.message, d.code.as_str())
}

/// Laws that computed a loss in an operating point.
pub fn in_force(all: &Findings<'_>) -> Option<Section> {
    let solutions = || all.analysis.operations.iter().filter_map(single);
    let mut used: Vec<&str> = solutions().flat_map(|s| s.sources.iter().map(|x| x.law.as_str())).collect();
    used.sort_unstable();
    used.dedup();
    let catalogue = entries();
    let laws: Vec<&LawSummary> = catalogue.iter().filter(|e| used.contains(&e.id)).collect();
    let columns = ["Family", "Law", "Source", "Holds for", "Checked"].map(Column::words).into();
    let rows: Vec<Vec<String>> = laws.iter().map(|e| row(e)).collect();
    let mut blocks = vec![];
    if !rows.is_empty() {
        blocks.push(Block::Table { caption: "Laws of loss in force".into(), columns, rows });
    }
    let text = "Ratios are exact: speeds follow from whole numbers of teeth by elimination. Torques with friction are \
                solved with the driving end of every mesh as unknown, and the answer carries its certificate. Published \
                ratios, efficiencies and power flows, measured losses and trajectories of other programs are compared \
                with this program's in every run of its tests; the validation pages of Willis list each with its source, \
                disagreements included.";
    blocks.push(Block::Text { text: text.into() });
    Some(Section { title: "Laws and validation".into(), blocks })
}

/// A source as it is cited in words: `niemann_winter2003` is Niemann and Winter 2003, `isotr14179_2` is ISO/TR 14179-2.
fn cited(key: &str) -> String {
    const NAMES: [(&str, &str); 6] = [
        ("isotr", "ISO/TR"),
        ("isots", "ISO/TS"),
        ("agma", "AGMA"),
        ("skf", "SKF"),
        ("bilgenboulos", "Bilgen and Boulos"),
        ("wilsonsheu", "Wilson and Sheu"),
    ];
    let Some(at) = key.find(|c: char| c.is_ascii_digit()) else { return key.replace('_', " ") };
    let (letters, number) = key.split_at(at);
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
    };
    let name = match NAMES.iter().find(|(key, _)| *key == letters) {
        Some((_, name)) => (*name).to_owned(),
        None => letters.split('_').filter(|w| !w.is_empty()).map(capital).collect::<Vec<String>>().join(" and "),
    };
    format!("{name} {}", number.replace('_', "-"))
}

fn row(e: &LawSummary) -> Vec<String> {
    let number = |x: f64| if x.is_finite() { significant(x, 4) } else { String::new() };
    let range = |r: &(&str, &str, f64, f64)| {
        let (symbol, unit, low, high) = *r;
        let symbol = symbol.replace('_', "");
        // Each end in the unit that people use for it.
        let end = |x: f64| {
            let (x, unit) = match unit {
                "N/m" => (x / 1e3, "N/mm"),
                unit => for_people(x, unit),
            };
            format!("{} {unit}", number(x)).trim().to_owned()
        };
        match (low.is_finite(), high.is_finite()) {
            (true, true) => format!("{} ≤ {symbol} ≤ {}", end(low), end(high)),
            (true, false) => format!("{symbol} ≥ {}", end(low)),
            (false, true) => format!("{symbol} ≤ {}", end(high)),
            (false, false) => String::new(),
        }
    };
    let valid: Vec<String> = e.valid.iter().map(range).filter(|t| !t.is_empty()).collect();
    let mut checked = match e.trust {
        Trust::Seen => "seen in its source".to_owned(),
        Trust::Derived => "derived, and checked numerically".to_owned(),
        Trust::Confirm(what) => format!("to be confirmed: {what}"),
    };
    for tag in e.tags {
        match tag {
            Tag::Estimate => checked += "; an estimate, good to about half its value",
            Tag::Compatibility => checked += "; reproduces a published number that follows from an error",
            _ => {}
        }
    }
    let source = format!("{}, {}", cited(e.source.0), e.source.1);
    let valid = if valid.is_empty() { "not stated by the source".to_owned() } else { valid.join("; ") };
    let checked = words::plain(&checked, &Names::new([]));
    vec![e.family.replace('_', " "), e.title.to_owned(), source, valid, checked]
}

pub fn again(all: &Findings<'_>) -> Section {
    let mut blocks = vec![];
    if !all.request.commands.is_empty() {
        blocks.push(Block::Text { text: "These commands give the same numbers and the same bytes:".into() });
        blocks.push(Block::Code { text: all.request.commands.join("\n") });
    }
    let file = if all.request.file.is_empty() { "the train file" } else { &all.request.file };
    if !all.request.hash.is_empty() {
        let place = if all.request.appendix { ", which is the appendix" } else { "" };
        let text = format!("They read {file}{place}. Its SHA-256 is {}.", all.request.hash);
        blocks.push(Block::Text { text });
    }
    for (name, text) in all.model.files() {
        let lines = text.lines().count();
        blocks.push(Block::Text { text: format!("The train file names {name}, a table of {lines} lines.") });
    }
    Section { title: "Reproduce this report".into(), blocks }
}

/// The train file.
pub fn appendix(all: &Findings<'_>) -> Section {
    let file = if all.request.file.is_empty() { "train file" } else { &all.request.file };
    let blocks = vec![Block::Code { text: all.model.document().text() }];
    Section { title: format!("Appendix: {file}"), blocks }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_source_is_cited_in_words() {
        let of = |key| cited(key);
        assert_eq!(of("niemann_winter2003"), "Niemann and Winter 2003");
        assert_eq!([of("isotr14179_2"), of("isots6336_22")], ["ISO/TR 14179-2", "ISO/TS 6336-22"]);
        assert_eq!(of("practice"), "practice");
        for e in entries() {
            let words = cited(e.source.0);
            assert!(!words.contains('_') && !words.is_empty(), "{words}");
        }
    }
}
