//! What moves efficiency and losses most, for eyes and as a table.

use willis::operating_point::LossKind;
use willis::study::{OperationSensitivity, QuantitySensitivity, Sensitivity};

use crate::questions::analyze::margins;
use crate::style::{assumptions, bold, dim, percent, plural, right, set_header, show, significant, table, wrap};
use crate::table::Kind::{Flag, Number, Text};
use crate::table::{Table, word};

/// For eyes.
pub fn text(all: &Sensitivity) -> String {
    let mut out = bold(&all.train) + "\n";
    for o in &all.operations {
        out += &format!("\n{}", bold(&format!("Operation: {}", o.name)));
        if let Some(state) = &o.state {
            out += &format!(" (state {state})");
        }
        out.push('\n');
        out += &operation(o);
    }
    out + "\n" + &assumptions(&all.assumptions)
}

fn operation(o: &OperationSensitivity) -> String {
    let mut out = format!("  {:<12} {}\n", "verdict", o.verdict.words());
    if let Some(reason) = &o.reason {
        return out + &wrap(reason, "  ") + "\n";
    }
    let efficiency = o.efficiency.map_or("-".to_owned(), percent);
    let loss = format!("{} W of {} W", significant(o.loss_w, 5), significant(o.input_power_w, 6));
    out += &format!("  {:<12} {efficiency}, {loss} lost\n", "efficiency");
    if let Some(oil) = o.oil_k {
        out += &format!("  {:<12} {:.1} °C\n", "oil", oil - 273.15);
    }
    if let Some(margin) = &o.margin {
        let near = margins(margin);
        let none = format!("  {:<12} no other regime and no locking was found near\n", "margin");
        out += if near.is_empty() { &none } else { &near };
    }
    if o.quantities.is_empty() {
        out += "  nothing that the file gives moves a loss here: the train is lossless, or unloaded\n";
    } else {
        let mut t = table();
        let follows = o.quantities.iter().any(|q| q.oil_change_k.is_some());
        let mut header = vec!["quantity", "value", "step", "η points", "loss W", "% per %"];
        header.extend(follows.then_some("oil K"));
        header.push("moves most");
        set_header(&mut t, &header);
        for q in &o.quantities {
            let mut row = vec![
                q.name.clone() + if q.assumed { " *" } else { "" },
                value(q),
                q.step.label().into(),
                q.efficiency_change.map_or("-".into(), |x| change(100.0 * x)),
                change(q.loss_change_w),
                q.loss_elasticity.map_or("-".into(), change),
            ];
            row.extend(follows.then(|| q.oil_change_k.map_or("-".into(), change)));
            row.push(moves(q));
            t.add_row(row);
        }
        right(&mut t, 1..header.len() - 1);
        out += &show(&t);
    }
    if o.quantities.iter().any(|q| q.assumed) {
        out += &dim("  * not given: what is taken instead");
        out.push('\n');
    }
    for q in o.quantities.iter().filter(|q| !q.together.is_empty() || !q.opposite.is_empty()) {
        let with = q.together.join(", ");
        let text = match (&q.opposite[..], &with[..]) {
            ([], with) => format!("{} moves in proportion with {with}: alone it would contradict them", q.name),
            (others, with) => {
                let with = if with.is_empty() { String::new() } else { format!("with {with}, and ") };
                format!("{} moves {with}against {}: their sum is settled", q.name, others.join(", "))
            }
        };
        out += &dim(&wrap(&text, "  "));
        out.push('\n');
    }
    if !o.without_effect.is_empty() {
        let text = format!("no loss here depends on {}", o.without_effect.join(", "));
        out += &dim(&wrap(&text, "  "));
        out.push('\n');
    }
    for (name, why) in &o.without_derivative {
        out += &dim(&wrap(&format!("{name}: no derivative, {why}"), "  "));
        out.push('\n');
    }
    for note in &o.notes {
        out += &dim(&wrap(note, "  "));
        out.push('\n');
    }
    if let Some(c) = o.checks.filter(|_| !o.quantities.is_empty()) {
        let mut text = format!(
            "check: input less output less losses closes to {:.0e} of the largest derivative",
            c.balance_residual
        );
        if c.rounds > 1 {
            let within = if c.error <= 1e-11 { "10⁻¹¹".to_owned() } else { format!("{:.0e}", c.error) };
            text +=
                &format!("; derivatives agree within {within} after {} at most", plural(c.rounds, "round", "rounds"));
        }
        out += &dim(&wrap(&text, "  "));
        out.push('\n');
    }
    out
}

/// With a sign, three digits; round-off is nothing.
fn change(x: f64) -> String {
    if x.abs() < 1e-10 {
        return "0".into();
    }
    let text = significant(x, 3);
    if x > 0.0 && text != "0" { format!("+{text}") } else { text }
}

/// The value in a unit that people use.
fn value(q: &QuantitySensitivity) -> String {
    let (x, unit) = willis::units::for_people(q.value, &q.unit);
    format!("{} {unit}", significant(x, 6)).trim_end().to_owned()
}

/// The losses that it moves most.
fn moves(q: &QuantitySensitivity) -> String {
    let most = q.sources.first().map_or(0.0, |s| s.change_w.abs());
    let worth = q.sources.iter().filter(|s| s.change_w.abs() >= 0.1 * most && most > 0.0);
    let named = worth.take(2).map(|s| {
        let what = match s.kind {
            LossKind::Sliding => format!("{} sliding", s.name),
            LossKind::Rolling => format!("{} rolling", s.name),
            LossKind::Windage | LossKind::Churning => format!("{} {}", s.name, s.kind.words()),
            _ => s.name.clone(),
        };
        format!("{what} {}", change(s.change_w))
    });
    named.collect::<Vec<_>>().join(", ")
}

/// One row a quantity; SI.
pub fn table_of(all: &Sensitivity) -> Table {
    let mut t = Table::new(
        "quantities",
        [
            ("operation", Text),
            ("verdict", Text),
            ("quantity", Text),
            ("value", Number),
            ("unit", Text),
            ("assumed", Flag),
            ("step", Text),
            ("step_size", Number),
            ("efficiency_derivative", Number),
            ("loss_derivative_w", Number),
            ("efficiency_change", Number),
            ("loss_change_w", Number),
            ("loss_elasticity", Number),
            ("sources", Text),
        ],
    );
    for o in &all.operations {
        for q in &o.quantities {
            let sources: Vec<String> =
                q.sources.iter().map(|s| format!("{} ({}) {}", s.name, s.kind.words(), s.change_w)).collect();
            t.row([
                (&o.name).into(),
                word(&o.verdict).into(),
                (&q.name).into(),
                q.value.into(),
                q.unit.to_string().into(),
                q.assumed.into(),
                q.step.label().into(),
                q.step_size.into(),
                q.efficiency_derivative.into(),
                q.loss_derivative_w.into(),
                q.efficiency_change.into(),
                q.loss_change_w.into(),
                q.loss_elasticity.into(),
                sources.join("; ").into(),
            ]);
        }
    }
    t
}
