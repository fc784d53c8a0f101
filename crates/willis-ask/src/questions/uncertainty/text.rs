//! How sure a number is, for eyes.

use comfy_table::CellAlignment;
use willis::diagnostic::Code;
use willis::study::{
    PointVerdict, Statistics, UncertainResult, UncertainValue, Uncertainty, WarningCount, WarningKind,
};

use crate::style::{bar, bold, dim, right, set_header, show, significant, table, wrap};

/// How an output is shown: its name, and numbers with as many decimals as its spread deserves.
struct Shown<'a> {
    of: &'a UncertainResult,
    scale: f64,
    unit: &'static str,
    decimals: usize,
}

impl<'a> Shown<'a> {
    fn new(of: &'a UncertainResult) -> Self {
        let (scale, unit) = match of.unit.as_str() {
            "" => (100.0, " %"),
            _ => (1.0, " W"),
        };
        let spread = of.statistics.map_or(0.0, |s| (s.p95 - s.p05).abs() * scale);
        let decimals = if spread > 0.0 { (2.0 - spread.log10().floor()).clamp(0.0, 8.0) as usize } else { 2 };
        Self { of, scale, unit, decimals }
    }

    fn name(&self) -> String {
        match self.of.name.as_str() {
            "efficiency" => "efficiency".into(),
            "loss_w" => "loss".into(),
            name => match name.strip_suffix(".total_loss_w") {
                Some(source) => format!("  {source}"),
                None => match name.strip_suffix("_loss_w") {
                    Some(kind) => kind.replace('_', " ") + " loss",
                    None => name.to_owned(),
                },
            },
        }
    }

    fn number(&self, x: f64) -> String {
        let text = format!("{:.*}", self.decimals, x * self.scale);
        if text.starts_with('-') && text.chars().all(|c| "-0.".contains(c)) { text[1..].to_owned() } else { text }
    }

    fn full(&self, x: f64) -> String {
        self.number(x) + self.unit
    }
}

/// For eyes.
pub fn text(u: &Uncertainty) -> String {
    let mut out = bold(&u.train) + "\n";
    let state = u.state.as_ref().map_or(String::new(), |s| format!("   state {s}"));
    out += &format!("{}{state}\n", bold(&format!("Operation: {}", u.operation)));
    for output in u.outputs.iter().take(2) {
        out += &wrap(&sentence(output), "  ");
        out.push('\n');
    }
    out += &verdicts(u);
    out.push('\n');
    out += &results(u);
    out.push('\n');
    out += &dominance(u);
    out += &choices(u);
    out += &quantities(u);
    out.push('\n');
    out += &bold("Assumptions in force");
    out.push('\n');
    for line in &u.assumptions {
        out += &wrap(line, "  · ");
        out.push('\n');
    }
    out += &wrap(
        &format!(
            "{} samples in {} scramblings of a Sobol sequence, seed {}; {} operating points computed",
            u.samples, u.replicates, u.seed, u.evaluations
        ),
        "  · ",
    );
    out.push('\n');
    if !u.model_assumptions.is_empty() {
        out += "Of the file as written\n";
    }
    for line in &u.model_assumptions {
        out += &(wrap(line, "  · ") + "\n");
    }
    for line in &u.warnings {
        out += &dim(&wrap(line, "  * "));
        out.push('\n');
    }
    for (kind, seen) in &u.seen {
        if let WarningKind::Warning { code, .. } = kind {
            out += &dim(&wrap(&warning(u, *code, seen), "  * "));
            out.push('\n');
        }
    }
    out
}

fn warning(u: &Uncertainty, code: Code, seen: &WarningCount) -> String {
    format!("{code} at {}, first: {}", share(seen.count as usize, u.samples), seen.message)
}

fn share(count: usize, of: usize) -> String {
    match count == of {
        true => "every sample".into(),
        false => format!("{count} of {of} samples"),
    }
}

fn sentence(o: &UncertainResult) -> String {
    let shown = Shown::new(o);
    let name = shown.name();
    let written = match o.nominal {
        Some(x) => format!("{} as written", shown.full(x)),
        None => "as written without a unique answer".into(),
    };
    let Some(s) = &o.statistics else {
        return format!("{name}: {written}; too few samples have an answer to tell its distribution");
    };
    // What rounding makes is no difference.
    if s.most - s.least <= Statistics::SAME * s.most.abs().max(s.least.abs()) {
        return format!("{name}: {written}; no sample differs");
    }
    let below = o.below_nominal.map_or(String::new(), |b| {
        format!("; {} % of the samples lie below the file's value", significant(100.0 * b, 2))
    });
    format!(
        "{name}: {written}; 90 % of the samples lie from {} to {}, half of them below {}{below}",
        shown.full(s.p05),
        shown.full(s.p95),
        shown.full(s.median)
    )
}

fn verdicts(u: &Uncertainty) -> String {
    let good = u.verdicts.get(&PointVerdict::Unique).copied().unwrap_or(0);
    if good == u.samples {
        return "  every sample has exactly one equilibrium\n".into();
    }
    let percent = significant(100.0 * (u.samples - good) as f64 / u.samples as f64, 3);
    let line = format!("{percent} % of the samples have no unique answer, and no part in what follows:");
    let mut out = bold(&wrap(&line, "  ")) + "\n";
    for (verdict, count) in u.verdicts.iter().filter(|v| *v.0 != PointVerdict::Unique) {
        let word = match verdict {
            PointVerdict::Multiple => "have several equilibria",
            PointVerdict::Locked => "lock",
            PointVerdict::Unloaded => "carry no load",
            PointVerdict::Refused => "are refused: no such train or operating point is possible",
            _ => "are not determined",
        };
        let why = u.seen.get(&WarningKind::Reason(*verdict)).map_or(String::new(), |s| format!("; {}", s.message));
        out += &wrap(&format!("{count} {word}{why}"), "    ");
        out.push('\n');
    }
    out
}

fn results(u: &Uncertainty) -> String {
    let mut t = table();
    let header =
        ["result", "", "as written", "median", "5 %", "95 %", "2.5 %", "97.5 %", "mean", "std dev", "least", "most"];
    set_header(&mut t, &header);
    for (k, o) in u.outputs.iter().enumerate() {
        let shown = Shown::new(o);
        let mut row =
            vec![shown.name(), shown.unit.trim().to_owned(), o.nominal.map_or("-".into(), |x| shown.number(x))];
        let Some(s) = &o.statistics else {
            t.add_row(row);
            continue;
        };
        let all = [s.median, s.p05, s.p95, s.p025, s.p975, s.mean, s.standard_deviation, s.least, s.most];
        row.extend(all.map(|x| shown.number(x)));
        t.add_row(row);
        if k < 2 && s.least != s.most {
            let e = &s.sampling_error;
            let mut row = vec!["  ± sampling".to_owned(), shown.unit.trim().to_owned(), String::new()];
            // One more digit than the values, or the errors of a good sample would all be nought.
            let finer = Shown { decimals: shown.decimals + 1, ..shown };
            row.extend([e.median, e.p05, e.p95, e.p025, e.p975, e.mean].map(|x| finer.number(x)));
            t.add_row(row);
        }
    }
    right(&mut t, 2..header.len());
    show(&t)
}

fn dominance(u: &Uncertainty) -> String {
    let [efficiency, loss, ..] = &u.outputs[..] else { return String::new() };
    if u.quantities.len() == 1 {
        return String::new();
    }
    let ranked = |o: &UncertainResult| -> Vec<String> {
        o.influences.iter().filter(|i| i.index.total > 0.05).map(|i| i.quantity.clone()).collect()
    };
    let mut out = String::new();
    let same = ranked(efficiency) == ranked(loss);
    for o in [efficiency, loss].into_iter().take(if same { 1 } else { 2 }) {
        if o.influences.is_empty() {
            continue;
        }
        let beside = if same { "; the loss in the same order" } else { "" };
        out += &format!("{}{beside}\n", bold(&format!("What dominates the {}", Shown::new(o).name())));
        let mut t = table();
        set_header(&mut t, &["share of the variance", "first order %", "±", "total %", "±", ""]);
        for i in &o.influences {
            // Adding zero turns -0 into 0.
            let percent = |x: f64| format!("{:.1}", (1000.0 * x).round() / 10.0 + 0.0);
            t.add_row([
                i.quantity.clone(),
                percent(i.index.first),
                percent(i.index.first_error),
                percent(i.index.total),
                percent(i.index.total_error),
                bar(i.index.total.clamp(0.0, 1.0)),
            ]);
        }
        right(&mut t, 1..5);
        out += &show(&t);
        let alone: f64 = o.influences.iter().map(|i| i.index.first).sum();
        let rest = 100.0 * (1.0 - alone);
        let error: f64 = o.influences.iter().map(|i| i.index.first_error.powi(2)).sum::<f64>().sqrt();
        if rest > 1.0 && rest > 100.0 * error {
            let line = format!("{rest:.0} % come of quantities acting together: `in all` counts them for each");
            out += &dim(&wrap(&line, "  "));
            out.push('\n');
        }
        out.push('\n');
    }
    out
}

fn choices(u: &Uncertainty) -> String {
    let mut out = String::new();
    for q in u.quantities.iter().filter(|q| matches!(q.likely, UncertainValue::Each(_))) {
        let what = match q.name.strip_prefix("law.") {
            Some(family) => format!("Law beside law: {family}"),
            None => format!("Value beside value: {}", q.name),
        };
        out += &format!("{}\n", bold(&what));
        let mut t = table();
        let header = ["value", "samples", "loss median W", "5 % W", "95 % W", "η median", ""];
        set_header(&mut t, &header);
        let own: Vec<_> = u.choices.iter().filter(|c| c.quantity == q.name).collect();
        let most = own.iter().filter_map(|c| c.loss_median_w).fold(0.0f64, f64::max);
        for c in own {
            let watts = |x: Option<f64>| x.map_or("-".into(), |x| significant(x, 4));
            let samples = if c.answered == c.samples {
                c.samples.to_string()
            } else {
                format!("{} of {}", c.answered, c.samples)
            };
            let mark = if c.is_nominal { " (as written)" } else { "" };
            t.add_row([
                format!("{}{mark}", c.value),
                samples,
                watts(c.loss_median_w),
                watts(c.loss_p05_w),
                watts(c.loss_p95_w),
                c.efficiency_median.map_or("-".into(), |e| format!("{:.3} %", 100.0 * e)),
                bar(c.loss_median_w.filter(|_| most > 0.0).map_or(0.0, |l| (l / most).max(0.0))),
            ]);
        }
        right(&mut t, 1..6);
        out += &show(&t);
        out.push('\n');
    }
    out
}

fn quantities(u: &Uncertainty) -> String {
    let mut t = table();
    set_header(&mut t, &["uncertain", "as written", "taken as"]);
    t.column_mut(1).expect("it was just added").set_cell_alignment(CellAlignment::Right);
    for q in &u.quantities {
        let taken = match &q.likely {
            // They stand above, each in a line.
            UncertainValue::Each(all) => format!("{} values, equally likely", all.len()),
            UncertainValue::Between(_) => q.distribution.clone(),
        };
        t.add_row([q.name.clone(), q.nominal.clone().unwrap_or("-".into()), taken]);
    }
    show(&t)
}
