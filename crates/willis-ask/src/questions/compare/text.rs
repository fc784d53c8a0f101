//! Variants side by side, differences first, for eyes.

use willis::diagnostic::is_printable;
use willis::study::{
    Compared, ComparedUnit, ComparedValue, Comparison, Difference, MapDifference, MapPair, TextDifference,
};

use crate::style::{assumptions, bold, dim, plural, right, rpm, set_header, show, significant, table, wrap};

/// Results of a state or operation that are shown; the contract has all.
const MOST_ROWS: usize = 20;
/// A longer value of a key is cut.
const MOST_LETTERS: usize = 48;

/// The comparison for eyes.
pub fn text(c: &Comparison) -> String {
    let mut out = bold("Variants") + "\n";
    for v in &c.variants {
        out += &format!("  {}  {}: {}\n", bold(&v.label), v.file, v.train);
    }
    out.push('\n');
    if c.identical {
        out += "The files say the same, so every result is the same.\n";
    } else {
        out += &(bold("What the files differ in") + "\n");
        out += &texts(c, "key", &c.files);
    }
    let (differ, same): (Vec<&Compared>, Vec<&Compared>) = c.states.iter().partition(|s| !s.is_equal());
    if !differ.is_empty() {
        out += &format!("\n{}\n", bold("Shift table, the largest difference first"));
        out += &results(c, &differ, "state");
    }
    let (operations, others): (Vec<&Compared>, Vec<&Compared>) = c.operations.iter().partition(|o| !o.is_equal());
    let alone = |o: &&&Compared| o.differences.is_empty() && o.prescribed.is_empty() && o.equal == 0;
    let lonely: Vec<String> = (operations.iter().filter(alone))
        .map(|o| {
            let with: Vec<&str> =
                c.variants.iter().map(|v| v.label.as_str()).filter(|l| !o.missing_in.iter().any(|m| m == l)).collect();
            format!("{} ({})", o.name, with.join(", "))
        })
        .collect();
    if !lonely.is_empty() {
        let count = plural(lonely.len(), "operation is", "operations are");
        out += &format!("\n{}\n", wrap(&lonely.join("; "), &format!("{count} in one file only: ")));
    }
    for o in operations.iter().filter(|o| !alone(o)) {
        out += &format!("\n{}\n", bold(&format!("Operation: {}", o.name)));
        out += &compared(c, o);
    }
    if let Some(m) = &c.map {
        let over = m.over.iter().map(|o| format!("`{o}`")).collect::<Vec<_>>().join(" and ");
        out += &format!("\n{}\n", bold(&format!("Over {over}: {}", plural(m.points as usize, "point", "points"))));
        if !m.prescribed.is_empty() {
            out += &(wrap("the variants start from different points:", "  ! ") + "\n");
            out += &texts(c, "prescribed", &m.prescribed);
        }
        for pair in &m.pairs {
            out += &map_pair(pair);
        }
    }
    let names = |all: &[&Compared]| all.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(", ");
    let mut equal = vec![];
    if !same.is_empty() {
        equal.push(format!("{} {}", if same.len() == 1 { "state" } else { "states" }, names(&same)));
    }
    if !others.is_empty() {
        equal.push(format!("{} {}", if others.len() == 1 { "operation" } else { "operations" }, names(&others)));
    }
    let count: usize = differ.iter().chain(&operations).map(|x| x.equal).sum();
    if count > 0 {
        equal.push(format!("{} of the states and operations above", plural(count, "result", "results")));
    }
    if !equal.is_empty() {
        out += &format!("\n{}\n", wrap(&equal.join("; "), "equal: "));
    }
    out + "\n" + &assumed(c)
}

/// What is assumed of all variants, then of one.
fn assumed(c: &Comparison) -> String {
    let [first, others @ ..] = &c.variants[..] else { return String::new() };
    let (shared, _): (Vec<String>, Vec<String>) =
        first.assumptions.iter().cloned().partition(|a| others.iter().all(|v| v.assumptions.contains(a)));
    let own = c.variants.iter().flat_map(|v| {
        let own = v.assumptions.iter().filter(|a| !shared.contains(a));
        own.map(|a| format!("{}: {a}", v.label)).collect::<Vec<_>>()
    });
    assumptions(&shared.iter().cloned().chain(own).collect::<Vec<_>>())
}

fn clipped(text: &str) -> String {
    let shown: String = text.chars().map(|c| if is_printable(c) { c } else { ' ' }).collect();
    match shown.chars().count() > MOST_LETTERS {
        true => shown.chars().take(MOST_LETTERS - 1).chain(['…']).collect(),
        false => shown,
    }
}

/// Texts of each variant side by side.
fn texts(c: &Comparison, head: &str, all: &[TextDifference]) -> String {
    let mut t = table();
    let mut header = vec![head];
    header.extend(c.variants.iter().map(|v| v.label.as_str()));
    header.push("");
    set_header(&mut t, &header);
    for d in all {
        let with: Vec<&str> = (c.variants.iter().zip(&d.values))
            .filter(|(_, v)| v.is_some())
            .map(|(variant, _)| variant.label.as_str())
            .collect();
        let mut row = vec![d.path.clone()];
        row.extend(d.values.iter().map(|v| v.as_deref().map_or("-".into(), clipped)));
        row.push(match with.len() == d.values.len() {
            true => String::new(),
            false => format!("only in {}", with.join(", ")),
        });
        t.add_row(row);
    }
    show(&t)
}

/// An operation in which variants differ.
fn compared(c: &Comparison, x: &Compared) -> String {
    let mut out = String::new();
    if !x.prescribed.is_empty() {
        let text = "the variants prescribe different points, so the results below are not of the same one:";
        out += &(wrap(text, "  ! ") + "\n");
        out += &texts(c, "prescribed", &x.prescribed);
    }
    out + &results(c, &[x], "")
}

/// Results that differ; of several things with their names in front, under `head`.
fn results(c: &Comparison, all: &[&Compared], head: &str) -> String {
    let mut t = table();
    let first = &c.variants[0].label;
    let more: Vec<String> = c.variants[1..].iter().map(|v| format!("{} − {first}", v.label)).collect();
    let mut header = if head.is_empty() { vec![] } else { vec![head] };
    header.push("result");
    let texts = header.len();
    header.extend(c.variants.iter().map(|v| v.label.as_str()));
    for m in &more {
        header.extend([m.as_str(), ""]);
    }
    set_header(&mut t, &header);
    let (mut told, mut rest) = (String::new(), 0);
    for x in all {
        let mut name = x.name.clone();
        for d in x.differences.iter().take(MOST_ROWS) {
            let (quantity, scale) = shown_unit(d);
            let mut row = if head.is_empty() { vec![] } else { vec![std::mem::take(&mut name)] };
            row.push(quantity);
            row.extend(d.values.iter().map(|v| value(v, d.unit, scale)));
            for k in 1..d.values.len() {
                row.extend([difference(d, k, scale), relative(d, k)]);
            }
            t.add_row(row);
        }
        rest += x.differences.len().saturating_sub(MOST_ROWS);
        let of = if head.is_empty() { String::new() } else { format!("{head} {}, ", x.name) };
        if !x.missing_in.is_empty() {
            let do_not = if x.missing_in.len() > 1 { "do not" } else { "does not" };
            told += &format!("  ! {of}{} {do_not} have it\n", x.missing_in.join(", "));
        }
        for (label, reason) in &x.reasons {
            told += &(wrap(reason, &format!("  {of}{label}: ")) + "\n");
        }
    }
    right(&mut t, texts..header.len());
    let mut out = if t.is_empty() { String::new() } else { show(&t) };
    if rest > 0 {
        let text =
            format!("  and {}; the JSON answer has all", plural(rest, "smaller difference", "smaller differences"));
        out += &(dim(&text) + "\n");
    }
    out + &told
}

/// Name with the unit in which it is shown, and how large that is in SI.
fn shown_unit(d: &Difference) -> (String, f64) {
    match d.unit {
        ComparedUnit::Efficiency | ComparedUnit::None => (d.quantity.clone(), 1.0),
        ComparedUnit::RadianPerSecond => (format!("{} rpm", d.quantity), 1.0 / rpm(1.0)),
        ComparedUnit::Pascal => (format!("{} MPa", d.quantity), 1e6),
        unit => (format!("{} {}", d.quantity, unit.name()), 1.0),
    }
}

fn value(v: &ComparedValue, unit: ComparedUnit, scale: f64) -> String {
    match v {
        ComparedValue::None => "-".into(),
        ComparedValue::Word(w) => w.clone(),
        // More digits than elsewhere: small differences are what this is about.
        ComparedValue::Number(x) if unit == ComparedUnit::Efficiency => format!("{:.3} %", 100.0 * x),
        ComparedValue::Number(x) => significant(x / scale, 6),
    }
}

fn difference(d: &Difference, k: usize, scale: f64) -> String {
    match d.differences[k] {
        None => String::new(),
        Some(x) if same_as_nothing(x, d) => "=".into(),
        Some(x) if d.unit == ComparedUnit::Efficiency => points(x),
        Some(x) => signed(x / scale, 4),
    }
}

/// Whether a difference is round-off beside the values.
fn same_as_nothing(x: f64, d: &Difference) -> bool {
    let most = d.values.iter().filter_map(|v| if let ComparedValue::Number(x) = v { Some(x.abs()) } else { None });
    x.abs() <= 1e-9 * most.fold(0.0, f64::max)
}

/// A difference of efficiencies in percentage points.
fn points(x: f64) -> String {
    format!("{} pp", signed(100.0 * x, 3))
}

fn signed(x: f64, digits: i32) -> String {
    let text = significant(x, digits);
    if x > 0.0 { format!("+{text}") } else { text.replace('-', "−") }
}

fn relative(d: &Difference, k: usize) -> String {
    match d.relative[k] {
        // Of an efficiency the difference in points says it.
        Some(r) if d.unit != ComparedUnit::Efficiency && !same_as_nothing(d.differences[k].unwrap_or(0.0), d) => {
            format!("{} %", signed(100.0 * r, 3))
        }
        _ => String::new(),
    }
}

fn map_pair(p: &MapPair) -> String {
    let MapPair { first, other, .. } = p;
    let mut out = format!(
        "  {other} against {first}: {} have one answer in both",
        plural(p.compared as usize, "point", "points")
    );
    for (n, who) in [(p.only_first, format!("only in {first}")), (p.only_other, format!("only in {other}"))] {
        if n > 0 {
            out += &format!(", {n} {who}");
        }
    }
    if p.neither > 0 {
        out += &format!(", {} in neither", p.neither);
    }
    out.push('\n');
    if p.compared == 0 {
        return out;
    }
    let mut t = table();
    set_header(
        &mut t,
        &[
            "",
            &format!("{other} better"),
            &format!("{first} better"),
            "equal",
            &format!("mean {other} − {first}"),
            "largest",
            "where",
        ],
    );
    type Show = fn(f64) -> String;
    let watts: Show = |x| format!("{} W", signed(x, 4));
    for (name, d, show) in [("efficiency", &p.efficiency, points as Show), ("loss", &p.loss_w, watts)] {
        map_rows(&mut t, name, d, show);
    }
    right(&mut t, 1..6);
    out += &show(&t);
    let mut t = table();
    set_header(
        &mut t,
        &["along", "from", "to", &format!("{other} better"), &format!("{first} better"), "equal", "mean η"],
    );
    let mut last = "";
    for b in &p.bands {
        let name = if b.axis == last { String::new() } else { b.axis.clone() };
        last = &b.axis;
        let to = if b.to == b.from { String::new() } else { b.to.clone() };
        t.add_row([
            name,
            b.from.clone(),
            to,
            b.better.to_string(),
            b.worse.to_string(),
            b.equal.to_string(),
            b.mean.map_or("-".into(), points),
        ]);
    }
    right(&mut t, 1..7);
    out + &show(&t)
}

fn map_rows(t: &mut comfy_table::Table, name: &str, d: &MapDifference, show: fn(f64) -> String) {
    let head = [
        name.to_owned(),
        d.better.to_string(),
        d.worse.to_string(),
        d.equal.to_string(),
        d.mean.map_or("-".into(), show),
    ];
    let places: Vec<_> = d.most_better.iter().chain(&d.most_worse).collect();
    for (k, place) in places.iter().enumerate() {
        let front = if k == 0 { head.clone() } else { Default::default() };
        t.add_row(front.into_iter().chain([show(place.difference), place.place.clone()]));
    }
    if places.is_empty() {
        t.add_row(head.into_iter().chain([String::new(), String::new()]));
    }
}
