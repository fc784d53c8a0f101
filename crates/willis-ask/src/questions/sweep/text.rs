//! A sweep in a few lines.

use willis::study::{AxisValue, Extreme, Hold, MinMaxSum, SweepMethod, SweepPlace, SweepReport, WarningKind};

use crate::style::{assumptions, bold, dim, percent, right, set_header, show, significant, table, wrap};

/// `10 million points`, `12,345 points`.
pub fn points(n: u64) -> String {
    let mut digits = n.to_string();
    let mut at = digits.len();
    while at > 3 {
        at -= 3;
        digits.insert(at, ',');
    }
    format!("{digits} point{}", if n == 1 { "" } else { "s" })
}

/// Seconds in the unit that suits.
pub fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 120.0 => (s, "s"),
        s if s < 7200.0 => (s / 60.0, "min"),
        s if s < 172_800.0 => (s / 3600.0, "h"),
        s if s < 63_115_200.0 => (s / 86_400.0, "days"),
        s => (s / 31_557_600.0, "years"),
    };
    format!("{} {unit}", significant(value, 2))
}

/// Bytes in the unit that suits.
pub fn bytes(n: f64) -> String {
    let (value, unit) = match n {
        n if n < 1e6 => (n / 1e3, "kB"),
        n if n < 1e9 => (n / 1e6, "MB"),
        n if n < 1e12 => (n / 1e9, "GB"),
        n => (n / 1e12, "TB"),
    };
    format!("{} {unit}", significant(value, 2))
}

pub fn text(report: &SweepReport) -> String {
    let (study, all) = (&report.study, &report.summary);
    let mut out = format!("{}: {}", bold(&study.train), points(report.rows));
    if report.rows == 0 {
        return out + "  so small a sweep has fewer pieces than shards, and none falls into this one\n";
    }
    if let Some(shard) = &report.shard {
        out += &format!(" (shard {shard} of {})", points(study.points));
    }
    out += "\n";
    let mut t = table();
    set_header(&mut t, &["axis", "values", "from", "to"]);
    for a in &study.axes {
        t.add_row([a.quantity.clone(), a.count.to_string(), a.first.clone(), a.last.clone()]);
    }
    right(&mut t, 1..2);
    out += &show(&t);
    let held = match study.held {
        Hold::Torque => "torques",
        Hold::Power => "powers",
        Hold::Output => "the torque at the output",
        _ => "what the operation prescribes and no axis varies",
    };
    let state = study.state.as_ref().map_or(String::new(), |s| format!(", state {s}"));
    let method = match study.method {
        SweepMethod::Compiled => "compiled: within a part in 10^12 of `analyze`",
        _ => "every point is that of `analyze`",
    };
    out += &dim(&wrap(&format!("from operation `{}`{state}; held: {held}; {method}", study.operation), "  "));
    out += "\n\n";

    let mut t = table();
    set_header(&mut t, &["", "least", "mean", "most"]);
    let row = |name: &str, e: &MinMaxSum, show: &dyn Fn(f64) -> String| {
        let [least, most] = [e.least, e.most].map(|x| x.map_or("-".into(), |x| show(x.value)));
        [name.to_owned(), least, e.mean().map_or("-".into(), show), most]
    };
    if all.efficiency.count > 0 {
        t.add_row(row("efficiency", &all.efficiency, &|x| percent(x)));
    }
    if all.loss_w.count > 0 {
        t.add_row(row("loss W", &all.loss_w, &|x| significant(x, 5)));
    }
    right(&mut t, 1..4);
    if all.efficiency.count + all.loss_w.count > 0 {
        out += &show(&t);
        for (key, what) in [(SweepPlace::MostEfficiency, "best"), (SweepPlace::LeastEfficiency, "worst")] {
            if let Some(place) = report.places.get(&key) {
                out += &dim(&wrap(&format!("{what} efficiency at {place}"), "  "));
                out += "\n";
            }
        }
    }
    if !all.by_text.is_empty() {
        let mut t = table();
        let mut header = vec!["", "with an answer", "least", "mean", "most"];
        if !all.best.is_empty() {
            header.push("best at");
        }
        set_header(&mut t, &header);
        for (name, e) in ordered(report) {
            let best = Some(&name.value).filter(|_| name.axis == "state").and_then(|s| all.best.get(s));
            let best = best.map_or(String::new(), |n| plural_points(*n));
            let or_dash = |x: Option<Extreme>| x.map_or("-".into(), |x| percent(x.value));
            let mut row = vec![
                name.to_string(),
                e.count.to_string(),
                or_dash(e.least),
                e.mean().map_or("-".into(), percent),
                or_dash(e.most),
            ];
            if !all.best.is_empty() {
                row.push(best);
            }
            t.add_row(row);
        }
        right(&mut t, 1..header.len());
        out += "\n";
        out += &show(&t);
    }
    let counts: Vec<String> = all.verdicts.iter().map(|(v, n)| format!("{} {v}", points_only(*n))).collect();
    out += &format!("\nverdicts: {}\n", counts.join(", "));
    for (kind, seen) in &all.seen {
        let place = report.places.get(&SweepPlace::First(kind.clone()));
        let place = place.map_or(String::new(), |p| format!(" (first at {p})"));
        let what = match kind {
            WarningKind::Reason(verdict) => verdict.to_string(),
            warning => warning.to_string(),
        };
        out += &wrap(&format!("{}: {what}: {}{place}", plural_points(seen.count), seen.message), "  ");
        out += "\n";
    }
    out + "\n" + &assumptions(&study.assumptions)
}

/// Text values in the order of their axis; as far as they are known, that of the states.
fn ordered(report: &SweepReport) -> Vec<(&AxisValue, &MinMaxSum)> {
    let mut all: Vec<_> = report.summary.by_text.iter().collect();
    // Numbers among the names by their size.
    let key = |name: &AxisValue| (name.value.parse::<f64>().unwrap_or(f64::MAX), name.value.clone());
    all.sort_by(|a, b| key(a.0).partial_cmp(&key(b.0)).unwrap_or(std::cmp::Ordering::Equal));
    all
}

fn points_only(n: u64) -> String {
    points(n).split(' ').next().unwrap_or_default().to_owned()
}

fn plural_points(n: u64) -> String {
    points(n)
}
