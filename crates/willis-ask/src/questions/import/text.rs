//! The account of an import, for eyes.

use std::collections::BTreeMap;

use willis_exchange::rexs::{Fate, Report};

use crate::style::{bold, plural, wrap};

/// How much was read, in one sentence.
pub fn sums(r: &Report) -> String {
    let c = &r.counts;
    format!(
        "{}, {}: {} of {} attributes used, {} left out, {} unusable; {}, {}",
        format!("{} {}", r.kind, r.version).trim(),
        plural(c.components, "component", "components"),
        c.used,
        c.attributes,
        c.left_out,
        c.unusable,
        plural(r.guessed.len(), "assumption", "assumptions"),
        plural(r.problems.len() + r.more_problems, "problem", "problems"),
    )
}

pub fn text(file: &str, r: &Report) -> String {
    let mut out = format!("{}\n", wrap(&sums(r), &format!("{file}: ")));
    let mut list = |title: &str, lines: Vec<String>| {
        if !lines.is_empty() {
            out.push_str(&format!("\n{}\n", bold(title)));
            lines.iter().for_each(|line| out.push_str(&format!("{}\n", wrap(line, "  "))));
        }
    };
    list("Problems", r.problems.iter().map(|p| format!("{}: {}", p.place, p.message)).collect());
    list("Assumed", r.guessed.iter().map(|g| format!("{}: {} ({})", g.of, g.taken, g.because)).collect());
    list("Not in the file", r.missing.iter().map(|m| format!("{}: {}", m.what, m.so)).collect());
    let bearing = |b: &willis_exchange::rexs::BearingReport| {
        let how = if b.carried { "" } else { ", without dimensions: in a comment" };
        format!("{} x {}{how}", b.count, b.designation.as_deref().unwrap_or(&b.name))
    };
    list("Bearings", r.bearings.iter().map(bearing).collect());
    let case = |c: &willis_exchange::rexs::LoadCaseReport| {
        let columns: Vec<String> = c.columns.iter().map(|c| format!("{} {}", c.name, c.value)).collect();
        let name = c.operation.as_deref().unwrap_or("left out");
        format!("{name}: {}", columns.join(", "))
    };
    list("Load cases", r.load_cases.iter().map(case).collect());
    for (title, fate) in [("Used", Fate::Used), ("Left out", Fate::LeftOut), ("Unusable", Fate::Unusable)] {
        let mut many: BTreeMap<(&str, &str), usize> = BTreeMap::new();
        for a in r.attributes.iter().filter(|a| a.fate == fate) {
            *many.entry((&a.kind, &a.attribute)).or_default() += 1;
        }
        list(title, many.iter().map(|((kind, id), n)| format!("{n} x {kind}: {id}")).collect());
    }
    out
}
