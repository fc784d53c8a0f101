//! What tests say of the laws, for eyes.

use willis::study::{BlindDirection, Calibration};

use crate::style::{assumptions, bold, dim, percent, plural, right, set_header, show, significant, table, wrap};

/// Rows of tests that are shown.
const MOST_TESTS: usize = 40;

/// For eyes.
pub fn text(c: &Calibration) -> String {
    let mut out = format!("{} by {}", bold(&c.train), plural(c.tests as usize, "test", "tests"));
    if c.groups > 1 {
        out += &format!(" in {} groups", c.groups);
    }
    out += "\n\n";
    out += &format!(
        "  learnt       {} of {}; the rest is prior: how far published laws lie apart\n",
        bold(&c.learnt.to_string()),
        plural(c.combinations as usize, "combination of parameters", "combinations of parameters")
    );
    for b in &c.blind {
        out += &(wrap(&format!("not told apart: {}", direction(b)), "               ") + "\n");
    }
    let fits = match c.inflation > 1.0 {
        true => "the laws do not fit within the stated noise, which is taken as larger",
        false => "the laws fit within the stated noise",
    };
    out += &(wrap(&format!("{} for 1 expected: {fits}", significant(c.misfit, 3)), "  misfit       ") + "\n");
    out += &format!(
        "  left out     {} of {} tests inside the 90 % band of the others; groups miss {} of the loss\n",
        c.inside_band,
        c.tests,
        percent(c.group_misfit)
    );
    let mut t = table();
    set_header(&mut t, &["loss", "key", "factor", "90 % band", "spread", "before", "learnt"]);
    for p in &c.parts {
        let [low, high] = p.band.map(|x| significant(x, 3));
        t.add_row([
            p.name.clone(),
            p.key.clone(),
            significant(p.factor, 4) + if p.at_bound { " !" } else { "" },
            format!("{low} to {high}"),
            percent(p.spread),
            percent(p.prior),
            percent(p.learnt),
        ]);
    }
    right(&mut t, 2..7);
    out += &format!("\n{}", show(&t));
    if !c.without_effect.is_empty() {
        out += &(dim(&wrap(&format!("not in any test: {}", c.without_effect.join(", ")), "  ")) + "\n");
    }
    if !c.offsets.is_empty() {
        let mut t = table();
        set_header(&mut t, &["meter", "group", "offset N m", "spread", "before"]);
        for o in &c.offsets {
            t.add_row([
                o.member.clone(),
                o.group.clone(),
                significant(o.offset_n_m, 3),
                significant(o.spread_n_m, 2),
                significant(o.prior_n_m, 2),
            ]);
        }
        right(&mut t, 2..5);
        out += &format!("\n{}", show(&t));
    }
    let mut t = table();
    set_header(&mut t, &["line", "test", "measured W", "laws W", "fitted W", "residual σ", "left out σ", ""]);
    for r in c.residuals.iter().take(MOST_TESTS) {
        t.add_row([
            r.line.to_string(),
            r.condition.clone(),
            significant(r.measured_w, 4),
            significant(r.before_w, 4),
            significant(r.predicted_w, 4),
            format!("{:+.1}", r.residual),
            format!("{:+.1}", r.left_out),
            if r.outlier { "outlier".into() } else { String::new() },
        ]);
    }
    right(&mut t, 2..7);
    out += &format!("\n{}", show(&t));
    let more = c.residuals.len().saturating_sub(MOST_TESTS);
    if more > 0 {
        out += &(dim(&format!("  and {}", plural(more, "more test", "more tests"))) + "\n");
    }
    if !c.predictions.is_empty() {
        let mut t = table();
        set_header(&mut t, &["operation", "laws W", "calibrated W", "90 % band W", ""]);
        for p in &c.predictions {
            let outside: Vec<&str> = p.outside.iter().map(|o| o.0.as_str()).collect();
            t.add_row([
                p.operation.clone(),
                significant(p.before_w, 4),
                significant(p.loss_w, 4),
                format!("{} to {}", significant(p.band_w[0], 3), significant(p.band_w[1], 3)),
                if outside.is_empty() { String::new() } else { format!("not tested: {}", outside.join(", ")) },
            ]);
        }
        right(&mut t, 1..4);
        out += &format!("\n{}", show(&t));
    }
    if !c.next.is_empty() {
        let mut t = table();
        set_header(&mut t, &["test that teaches most", "lowers the variance of the operations by", "gain"]);
        for n in &c.next {
            t.add_row([n.condition.clone(), percent(n.lowers_variance), significant(n.gain, 3)]);
        }
        right(&mut t, 1..3);
        out += &format!("\n{}", show(&t));
    }
    for note in &c.notes {
        out += &(dim(&wrap(note, "  · ")) + "\n");
    }
    out + "\n" + &assumptions(&c.assumptions)
}

/// `tooth friction up 24 %, bearings, by load, down 30 %`.
fn direction(b: &BlindDirection) -> String {
    let parts: Vec<String> = b
        .changes
        .iter()
        .map(|c| {
            let way = if c.change >= 0.0 { "up" } else { "down" };
            let (size, unit) = if c.meter { (c.change, "N m") } else { (100.0 * c.change, "%") };
            format!("{} {way} {} {unit}", c.name, significant(size.abs(), 2))
        })
        .collect();
    parts.join("; ")
}
