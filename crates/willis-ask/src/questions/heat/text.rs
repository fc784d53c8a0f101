//! How warm a gearbox gets, for eyes.

use willis::analysis::{HeatBasis, HeatReport};
use willis::heat::Method;
use willis::study::{DutyHeat, HeatStudy, OperationHeat, RatingStatus, ThermalRating, WarmUp};

use crate::style::{assumptions, bar, bold, dim, percent, plural, right, set_header, show, significant, table, wrap};

/// For eyes.
pub fn text(all: &HeatStudy) -> String {
    let mut out = bold(&all.train) + "\n";
    for o in &all.operations {
        out += &format!("\n{}", bold(&format!("Operation: {}", o.name)));
        if let Some(state) = &o.state {
            out += &format!("   state {state}");
        }
        out.push('\n');
        out += &operation(o);
    }
    if let Some(duty) = &all.duty {
        out += &format!("\n{}\n", bold("Duty cycle, repeated until it returns to its start"));
        out += &of_duty(duty);
    }
    out + "\n" + &assumptions(&all.assumptions)
}

/// Degrees Celsius.
fn celsius(kelvin: f64) -> String {
    format!("{:.1}", kelvin - 273.15)
}

/// A power, W.
fn watts(w: f64) -> String {
    significant(w, 4)
}

/// A time in a unit that suits it.
fn time(s: f64) -> String {
    match s {
        s if s >= 7200.0 => format!("{} h", significant(s / 3600.0, 3)),
        s if s >= 120.0 => format!("{} min", significant(s / 60.0, 3)),
        s => format!("{} s", significant(s, 3)),
    }
}

fn operation(o: &OperationHeat) -> String {
    let Some(heat) = &o.heat else {
        let reason = o.reason.clone().unwrap_or_else(|| format!("the operating point is {}", o.verdict.words()));
        return wrap(&format!("no oil temperature follows: {reason}"), "  ") + "\n";
    };
    let mut out = of_report(heat);
    if let (Some(power), Some(loss)) = (o.input_power_w, o.loss_w) {
        let efficiency = o.efficiency.map_or(String::new(), |e| format!(", efficiency {}", percent(e)));
        out += &format!("  losses       {} W of {} W in{efficiency}\n", watts(loss), watts(power));
    }
    if let Some(r) = &o.rating {
        out += &rating(r, heat);
    }
    out += &places(heat);
    out += &paths(heat);
    if let Some(why) = o.no_warm_up {
        out += &format!("  warm-up      none: {}\n", why.words());
    }
    if let Some(w) = &o.warm_up {
        out += &warming(w, heat);
    }
    out
}

/// The oil temperature, where it comes from and what holds it: lines that an analysis shows too.
pub fn of_report(h: &HeatReport) -> String {
    let mut out = String::new();
    let from = match h.basis {
        HeatBasis::Balance => "losses and heat flow agree",
        HeatBasis::Given => "given",
        HeatBasis::Limit => "no balance below it: the limit",
        _ => "",
    };
    let margin = match h.margin_k {
        _ if h.basis == HeatBasis::Limit => format!("{} W more reach the oil there than leave it", watts(h.residual_w)),
        m if m >= 0.0 => format!("{m:.1} K below the limit of {} °C", celsius(h.limit_k)),
        m => format!("{:.1} K above the limit of {} °C", -m, celsius(h.limit_k)),
    };
    out += &format!("  oil          {} °C, {from}; {margin}\n", bold(&celsius(h.oil_k)));
    if h.basis == HeatBasis::Given {
        out += &match h.residual_w {
            q if q > 0.0 => format!("  heat         {} W more reach the oil than leave it: it warms\n", watts(q)),
            q => format!("  heat         {} W more leave the oil than reach it: it cools\n", watts(-q)),
        };
    }
    if let (Some(verdict), Some(c)) = (h.verdict, h.certificate) {
        let how = match c.method {
            Method::Elasticity => {
                let e = c.largest_elasticity.map_or(String::new(), |e| format!(", {e:.2} at most"));
                format!("elasticity of the losses below 1{e}")
            }
            _ => "intervals excluded one by one".to_owned(),
        };
        let rests = match c.proved {
            true => "proved".to_owned(),
            false => format!(
                "from losses at {} temperatures, {} K apart at most",
                c.temperatures,
                significant(c.widest_k, 2)
            ),
        };
        out += &(wrap(&format!("{}: {how} ({rests})", verdict.words()), "  balance      ") + "\n");
    }
    if h.equilibria.len() > 1 {
        for e in &h.equilibria {
            let word = if e.stable { "stable" } else { "not stable: parts what is reached from below and above" };
            out += &format!("               {} °C, {} W, {word}\n", celsius(e.oil_k), watts(e.heat_w));
        }
    }
    if !h.time_constants_s.is_empty() {
        let all: Vec<String> = h.time_constants_s.iter().map(|t| time(*t)).collect();
        out += &format!("  constants    {}\n", all.join(", "));
    }
    if h.drivers_change {
        out += "  note         cold, other gears drive than hot\n";
    }
    out
}

fn rating(r: &ThermalRating, h: &HeatReport) -> String {
    let at = format!("at {} °C", celsius(h.limit_k));
    let text = match (r.status, r.load_factor, r.input_power_w) {
        (RatingStatus::Found, Some(factor), Some(power)) => format!(
            "{} kW in {at}: {} of this load, {} W of heat",
            significant(power / 1e3, 4),
            significant(factor, 3),
            watts(r.heat_w.unwrap_or(f64::NAN))
        ),
        (RatingStatus::TooHotWithoutLoad, ..) => {
            format!("none: without load it is too hot, {} W are carried away {at}", watts(r.carried_w))
        }
        (RatingStatus::NoLimit, ..) => "heat is no limit up to 1024 times this load".to_owned(),
        _ => "not known: at some load the operating point has no one answer".to_owned(),
    };
    wrap(&text, "  rating       ") + "\n"
}

fn places(h: &HeatReport) -> String {
    let mut t = table();
    set_header(&mut t, &["place", "°C", "heat W", "of it to the oil"]);
    for (name, p) in h.places.iter() {
        let share = if p.heat_w > 0.0 { percent(p.share_to_oil) } else { "-".into() };
        let heat = if p.given { "-".into() } else { watts(p.heat_w) };
        t.add_row([name.clone(), celsius(p.temperature_k), heat, share]);
    }
    right(&mut t, 1..4);
    show(&t)
}

fn paths(h: &HeatReport) -> String {
    let mut t = table();
    set_header(&mut t, &["way of the heat", "W", ""]);
    let mut all: Vec<(String, f64)> =
        h.paths.iter().map(|p| (format!("{} → {}", p.between[0], p.between[1]), p.heat_w)).collect();
    all.extend(h.cooler_w.map(|q| ("oil → cooler".to_owned(), q)));
    let most = all.iter().fold(0.0f64, |a, p| a.max(p.1.abs()));
    for (name, q) in &all {
        t.add_row([name.clone(), watts(*q), if most > 0.0 { bar(q.abs() / most) } else { String::new() }]);
    }
    right(&mut t, 1..2);
    show(&t)
}

fn warming(w: &WarmUp, h: &HeatReport) -> String {
    let mut out = format!("  warm-up      from {} °C", celsius(w.start_k));
    match (w.settled_s, w.limit_after_s) {
        (_, Some(t)) => out += &format!(": passes the limit of {} °C after {}", celsius(h.limit_k), time(t)),
        (Some(t), None) => out += &format!(": within 1 K of its end after {}", time(t)),
        _ => out += ": not settled in the time shown",
    }
    out.push('\n');
    let shown: Vec<usize> = {
        let n = w.rows.len();
        let mut all: Vec<usize> = (0..=6).map(|k| k * (n - 1) / 6).collect();
        all.dedup();
        all
    };
    let mut t = table();
    let mut header = vec!["time".to_owned()];
    // The air and other given temperatures do not change.
    let moving: Vec<usize> =
        (0..w.places.len()).filter(|&k| !h.places.get(&w.places[k]).is_some_and(|p| p.given)).collect();
    header.extend(moving.iter().map(|k| format!("{} °C", w.places[*k])));
    header.push("heat W".into());
    let names: Vec<&str> = header.iter().map(String::as_str).collect();
    set_header(&mut t, &names);
    for k in shown {
        let r = &w.rows[k];
        let mut row = vec![time(r.time_s)];
        row.extend(moving.iter().map(|j| celsius(r.temperatures_k[*j])));
        row.push(watts(r.heat_w));
        t.add_row(row);
    }
    right(&mut t, 0..names.len());
    out += &show(&t);
    let audit = format!(
        "  {} kJ made, {} kJ carried away, {} kJ stored; closes to {:.0e}; losses between temperatures within {:.0e}",
        significant(w.made_j / 1e3, 4),
        significant(w.carried_j / 1e3, 4),
        significant(w.stored_j / 1e3, 4),
        w.audit,
        w.interpolation
    );
    out + &dim(&audit) + "\n"
}

fn of_duty(d: &DutyHeat) -> String {
    let mut out = format!(
        "  oil          {} °C on average, {} to {} °C; at its hottest {:.1} K below the limit\n",
        bold(&celsius(d.mean_k)),
        celsius(d.lowest_k),
        celsius(d.highest_k),
        d.margin_k
    );
    out += &format!(
        "  heat         {} W on average over {} of {}\n",
        watts(d.mean_heat_w),
        plural(d.rows_of_profile as usize, "row", "rows"),
        time(d.period_s)
    );
    if d.without_answer_s > 0.0 {
        out += &format!("  no answer    {} of it, which make no heat here\n", bold(&time(d.without_answer_s)));
    }
    if d.passes == 0 {
        out += "  order        that of shares is not known: one mean heat\n";
    } else {
        let text = format!(
            "  start and end differ by {:.0e} K after {}; heat closes to {:.0e}",
            d.left_k,
            plural(d.passes as usize, "pass", "passes"),
            d.audit
        );
        out += &(dim(&text) + "\n");
    }
    out
}
