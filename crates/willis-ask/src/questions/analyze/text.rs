//! An analysis for eyes: what an engineer looks for first comes first.

use comfy_table::CellAlignment;
use willis::analysis::{
    Analysis, AtLoad, CertificateReport, Direction, Margin, MemberReport, OperationReport, Role, SolutionReport,
    StateReport, VariatorReport, Verdict,
};
use willis::statics::Certificate;
use willis::train::Train;

use crate::questions::{heat, losses};
use crate::style::{
    self, assumptions, bold, dim, percent, plural, right, rpm, set_header, show, significant, table, wrap,
};

pub fn analysis(train: &Train, a: &Analysis) -> String {
    let mut out = String::new();
    out += &bold(&a.train);
    out.push('\n');
    let mut facts = vec![plural(a.degrees_of_freedom, "degree of freedom", "degrees of freedom") + " as drawn"];
    facts.push(plural(train.meshes().len(), "mesh", "meshes"));
    for (n, one, many) in [
        (train.sets().len(), "set", "sets"),
        (train.variators().len(), "variator", "variators"),
        (train.shift_elements().len(), "shift element", "shift elements"),
        (train.states().len(), "state", "states"),
        (train.operations().len(), "operation", "operations"),
    ] {
        if n > 0 {
            facts.push(plural(n, one, many));
        }
    }
    out += &facts.join(" · ");
    out.push('\n');
    if let Some(source) = &a.source {
        out += &dim(&wrap(&format!("Source: {source}"), ""));
        out.push('\n');
    }
    if !a.ratios.is_empty() {
        out.push('\n');
        out += &shift_table(a);
    }
    for o in &a.operations {
        out.push('\n');
        out += &operation(o);
    }
    out.push('\n');
    out += &assumptions(&a.assumptions);
    out.push('\n');
    out
}

fn shift_table(a: &Analysis) -> String {
    let rows = &a.ratios.0;
    let ends = |s: &StateReport| (s.input.clone(), s.output.clone());
    let first = ends(&rows[0].1);
    let same = rows.iter().all(|(_, s)| ends(s) == first);
    let mut out = match same {
        true => format!("{}   {} → {}\n", bold("Ratios"), first.0, first.1),
        false => bold("Ratios") + "\n",
    };
    let engaged = rows.iter().any(|(_, s)| !s.engaged.is_empty());
    let steps = rows.iter().any(|(_, s)| s.step.is_some());
    let mut t = table();
    let mut header = vec!["state"];
    if engaged {
        header.push("engaged");
    }
    if !same {
        header.extend(["input", "output"]);
    }
    header.extend(["ratio", "exact"]);
    if steps {
        header.push("step");
    }
    header.extend(["η driving", "η coasting"]);
    let loaded = rows.iter().any(|(_, s)| s.at_load.is_some());
    if loaded {
        header.extend(["η at load", "spin loss W"]);
    }
    header.push("verdict driving / coasting");
    let columns = header.len();
    set_header(&mut t, &header);
    for (name, s) in rows {
        let mut row = vec![name.clone()];
        if engaged {
            row.push(s.engaged.join(" "));
        }
        if !same {
            row.extend([s.input.clone(), s.output.clone()]);
        }
        let exact = s.exact.as_ref().map(ToString::to_string);
        row.push(s.value.map_or("-".into(), |v| significant(v, 5)));
        row.push(exact.unwrap_or("-".into()));
        if steps {
            row.push(s.step.map_or(String::new(), |v| format!("{v:.3}")));
        }
        row.push(efficiency_cell(&s.drive));
        row.push(efficiency_cell(&s.coast));
        if loaded {
            let at = s.at_load.as_deref();
            row.push(at.map_or("-".into(), at_load_cell));
            row.push(at.and_then(|a| a.spin_loss_w).map_or("-".into(), |w| significant(w, 4)));
        }
        row.push(verdicts(s));
        t.add_row(row);
    }
    let text_columns = 1 + usize::from(engaged) + 2 * usize::from(!same);
    for k in text_columns..columns - 1 {
        t.column_mut(k).expect("it was just added").set_cell_alignment(CellAlignment::Right);
    }
    out += &show(&t);
    out += &loads(a);
    if rows.iter().any(|(_, s)| proved(&s.drive) || proved(&s.coast)) {
        out += &dim(
            "proved: exactly one equilibrium for any load, in these directions of rotation and with these efficiencies (certificate)",
        );
        out.push('\n');
    }
    for (name, s) in rows {
        for (way, d) in [("driving", &s.drive), ("coasting", &s.coast)] {
            if let (Verdict::Multiple, Some(reason)) = (d.verdict, &d.reason) {
                let all: Vec<_> = d.efficiencies.iter().map(|e| percent(*e)).collect();
                out += &format!("{name}, {way}: {reason}: η = {}\n", all.join(" or "));
            }
        }
        if let Some(why) = s.at_load.as_deref().and_then(AtLoad::without_output) {
            out += &wrap(&format!("{name}, at load: {why}"), "");
            out.push('\n');
        }
        if let Some(why) = &s.no_ratio {
            out += &wrap(&format!("{name}: {why}"), "");
            out.push('\n');
        }
    }
    out
}

/// Speed and torque of a load, and whose they are.
pub fn load(a: &AtLoad) -> String {
    a.point(|x| significant(x, 5), |operation| format!("`{operation}`"))
}

/// Efficiency at load, or why there is none, in a word; marked where there is a warning.
pub fn at_load_cell(a: &AtLoad) -> String {
    let mark = if a.warnings.is_empty() { "" } else { " *" };
    a.efficiency.map_or(a.verdict.words().to_owned(), |e| style::efficiency_cell(e, a.band.as_deref())) + mark
}

/// The warnings that the mark stands for.
pub fn starred(warnings: &[&str]) -> String {
    warnings.iter().map(|text| dim(&wrap(text, "* ")) + "\n").collect()
}

/// At which load losses were computed beside the nominal efficiencies.
fn loads(a: &Analysis) -> String {
    let all = || a.ratios.iter().filter_map(|(_, s)| s.at_load.as_deref());
    let mut told: Vec<String> = vec![];
    for a in all() {
        let oil = a.temperature_k.map_or(String::new(), |t| {
            let limit = if a.beyond_limit { " (the limit: no balance below it)" } else { "" };
            format!(", oil at {:.1} °C{limit}", t - 273.15)
        });
        let text = load(a) + &oil;
        if !told.contains(&text) {
            told.push(text);
        }
    }
    if told.is_empty() {
        return String::new();
    }
    let text = format!("at load: {}; η driving and coasting: of the teeth alone", told.join("; "));
    let warnings = match (a.warnings_at_load(), all().any(|a| !a.warnings.is_empty())) {
        (own, true) if own.is_empty() => dim("* with a warning, which stands at the operations") + "\n",
        (own, _) => starred(&own),
    };
    dim(&wrap(&text, "")) + "\n" + &warnings
}

fn efficiency_cell(d: &Direction) -> String {
    match (d.verdict, d.efficiency) {
        (_, Some(e)) => percent(e),
        (Verdict::Locked, _) => "locked".into(),
        (Verdict::Multiple, _) => "several".into(),
        _ => "-".into(),
    }
}

fn proved(d: &Direction) -> bool {
    d.verdict == Verdict::Unique && d.certificate.is_some_and(|c| c.unique_for_every_load)
}

fn verdicts(s: &StateReport) -> String {
    let word = |d: &Direction| match d.verdict {
        Verdict::Unique if proved(d) => "unique, proved".to_owned(),
        v => v.words().to_owned(),
    };
    let (drive, coast) = (word(&s.drive), word(&s.coast));
    if drive == coast { drive } else { format!("{drive} / {coast}") }
}

fn certificate(c: &CertificateReport) -> String {
    match (c.unique_for_every_load, c.method) {
        (true, Certificate::SpectralRadius) => {
            "exactly one equilibrium for any load in these directions of rotation (spectral-radius certificate)".into()
        }
        (true, _) => {
            "exactly one equilibrium for any load in these directions of rotation (all sign patterns' determinants \
                      agree)"
                .into()
        }
        (false, Certificate::Enumeration) => {
            "not unique for every load; for this one every sign pattern was tried".into()
        }
        _ => "uniqueness undecided".into(),
    }
}

fn operation(o: &OperationReport) -> String {
    let mut out = bold(&format!("Operation: {}", o.name));
    if let Some(state) = &o.state {
        out += &format!("   state {state}");
    }
    if o.degrees_of_freedom > 1 {
        out += &format!("   {} degrees of freedom", o.degrees_of_freedom);
    }
    out.push('\n');
    out += &format!("  verdict      {}", bold(o.verdict_words()));
    match (&o.certificate, o.verdict) {
        (Some(c), Verdict::Unique) if o.solutions.iter().any(|s| !s.stiction.is_empty()) => {
            out += &format!(": {}, if meshes at rest lose nothing", certificate(c));
        }
        (Some(c), Verdict::Unique | Verdict::Multiple) => out += &format!(": {}", certificate(c)),
        (Some(c), Verdict::Locked) if c.method != Certificate::Undecided => {
            out += ": proved, no equilibrium drives a load"
        }
        _ => {}
    }
    out.push('\n');
    if let Some(reason) = &o.reason {
        out += &wrap(reason, "               ");
        out.push('\n');
    }
    if let Some(heat) = &o.heat {
        out += &heat::of_report(heat);
    }
    if o.solutions.is_empty() && o.dissipative_solutions.is_empty() {
        let mut t = table();
        set_header(&mut t, &["member", "speed rpm"]);
        for (name, w) in o.speeds_rad_s.iter() {
            t.add_row([name.clone(), w.map_or("not determined".into(), |w| significant(rpm(w), 6))]);
        }
        right(&mut t, 1..2);
        out += &show(&t);
    }
    for (k, s) in o.solutions.iter().enumerate() {
        if o.solutions.len() > 1 {
            out += &bold(&format!("  Solution {} of {}", k + 1, o.solutions.len()));
            out.push('\n');
        }
        out += &solution(s, o);
    }
    for s in &o.dissipative_solutions {
        out += &bold("  Only when every loaded member pushes");
        out.push('\n');
        out += &solution(s, o);
    }
    out
}

fn solution(s: &SolutionReport, o: &OperationReport) -> String {
    let mut out = String::new();
    let (unit, scale) = power_unit(s);
    let power = |p: f64| significant(p / scale, 5);
    let exact = match &s.efficiency_exact {
        Some(e) if !e.is_integer() => e.to_string(),
        _ => String::new(),
    };
    // A longer one is for machines.
    let exact = if (1..24).contains(&exact.len()) { format!(" = {exact}") } else { String::new() };
    let efficiency = match (s.all_dissipated, s.efficiency) {
        (true, _) => "none: every loaded member is an input, all power is dissipated".into(),
        (_, Some(e)) => style::efficiency(e, o.band.as_deref(), &o.outside_laws) + &exact,
        _ => "none: nothing is loaded".into(),
    };
    out += &(wrap(&efficiency, "  efficiency   ") + "\n");
    if let Some(band) = &o.band {
        out += &(wrap(&style::band_ends(band), "               ") + "\n");
    }
    out += &format!(
        "  power        in {} {unit}, out {} {unit}, lost {} {unit}; balance closes to {:.1e} W\n",
        power(s.input_power_w),
        power(s.output_power_w),
        power(s.loss_w),
        s.power_residual_w.abs()
    );
    match s.recirculation.first() {
        None => out += "  recirculates nothing\n",
        Some(_) => {
            for r in &s.recirculation {
                let share = if r.share_of_input.is_finite() {
                    format!(" ({} of the input)", percent(r.share_of_input))
                } else {
                    String::new()
                };
                let path = r.path.iter().chain(r.path.first()).cloned().collect::<Vec<_>>().join(" → ");
                out += &format!("  recirculates {} {unit}{share}: {path}\n", power(r.power_w));
            }
        }
    }
    // Tooth power far above the input is what makes high ratios lossy; no shaft shows it.
    if let Some((name, m)) = s.meshes.iter().max_by(|a, b| a.1.potential_power_w.total_cmp(&b.1.potential_power_w)) {
        let times = m.potential_power_w / s.input_power_w;
        if times.is_finite() && times > 1.0 + 1e-9 {
            out += &format!("  tooth power  {} times the input in {name}\n", significant(times, 4));
        }
    }
    out += &margins(&s.margin);

    let mut t = table();
    let relative = s.members.iter().any(|(_, m)| m.carrier.is_some());
    let mut header = vec!["member".to_owned(), "role".into(), "speed rpm".into()];
    if relative {
        header.push("on its carrier rpm".into());
    }
    header.extend(["torque N m".into(), format!("power {unit}")]);
    set_header(&mut t, &header.iter().map(String::as_str).collect::<Vec<_>>());
    for (name, m) in s.members.iter() {
        let mut row =
            vec![name.clone(), role(m).into(), m.speed_rad_s.map_or("any".into(), |w| significant(rpm(w), 6))];
        if relative {
            row.push(match m.carrier {
                Some(_) => m.relative_speed_rad_s.map_or("any".into(), |w| significant(rpm(w), 6)),
                None => String::new(),
            });
        }
        row.push(m.torque_n_m.map_or("?".into(), |t| dash(t, significant(t, 6))));
        row.push(m.power_w.map_or("?".into(), |p| dash(p, power(p))));
        t.add_row(row);
    }
    right(&mut t, 2..header.len());
    out += &show(&t);

    let mut t = table();
    set_header(&mut t, &["mesh", "driver", "rel. speed rpm", &format!("potential power {unit}"), "η", "loss W"]);
    for (name, m) in s.meshes.iter() {
        let driver = match &m.driver {
            Some(d) => d.clone(),
            None if m.first_torque_n_m == 0.0 => "idle".into(),
            None => "no motion".into(),
        };
        t.add_row([
            name.clone(),
            driver,
            significant(rpm(m.relative_speed_rad_s), 6),
            dash(m.potential_power_w, power(m.potential_power_w)),
            if m.driver.is_some() { significant(m.efficiency, 5) } else { "-".into() },
            dash(m.loss_w, significant(m.loss_w, 5)),
        ]);
    }
    right(&mut t, 2..6);
    out += &show(&t);

    for (name, v) in s.variators.iter() {
        out += &variator(name, v, unit, scale);
    }

    if !s.shift_elements.is_empty() {
        let mut t = table();
        set_header(&mut t, &["shift element", "joins", "torque N m"]);
        for (name, e) in s.shift_elements.iter() {
            t.add_row([
                format!("{} {name}", e.kind),
                format!("{} - {}", e.members[0], e.members[1]),
                e.torque_n_m.map_or("?".into(), |t| significant(t, 6)),
            ]);
        }
        right(&mut t, 2..3);
        out += &show(&t);
    }
    out + &losses::of_solution(s)
}

/// What a variator does, side by side or machine by machine.
fn variator(name: &str, v: &VariatorReport, unit: &str, scale: f64) -> String {
    let power = |p: f64| significant(p / scale, 5);
    let mut facts = vec![match (&v.machines.0[..], v.power_w) {
        (_, 0.0) => "passes no power".to_owned(),
        ([first, second], p) => {
            let (from, to) = if v.share >= 0.0 { (&first.0, &second.0) } else { (&second.0, &first.0) };
            format!("{} {unit} from {from} to {to}, {} of the input", power(p), percent(v.share))
        }
        (_, p) => format!("{} {unit} delivered, {} of the input", power(p), percent(v.share)),
    }];
    facts.extend(v.ratio.map(|r| format!("ratio {}", significant(r, 5))));
    facts.push(format!("lost {} {unit}", power(v.loss_w)));
    match v.store_w {
        Some(p) if p > 0.0 => facts.push(format!("store gives {} {unit}", power(p))),
        Some(p) if p < 0.0 => facts.push(format!("store takes {} {unit}", power(-p))),
        _ => {}
    }
    let mut out = wrap(&format!("{name}, {}: {}", v.kind, facts.join("; ")), "  ");
    out.push('\n');
    let mut t = table();
    let (side, power_in) = (if v.store_w.is_some() { "machine" } else { "side" }, format!("power into it {unit}"));
    set_header(&mut t, &[side, "on member", "does", "speed rpm", "torque on it N m", &power_in, "η"]);
    for (name, m) in v.machines.iter() {
        let does = match (m.power_w, m.torque_n_m) {
            (p, _) if p > 0.0 => "drives",
            (p, _) if p < 0.0 => "is driven",
            (_, 0.0) => "",
            _ => "holds",
        };
        t.add_row([
            name.clone(),
            m.member.clone(),
            does.into(),
            significant(rpm(m.speed_rad_s), 6),
            dash(m.torque_n_m, significant(m.torque_n_m, 6)),
            dash(m.power_w, power(m.power_w)),
            m.efficiency.map_or("-".into(), |e| significant(e, 5)),
        ]);
    }
    right(&mut t, 3..7);
    out + &show(&t)
}

/// How far a solution is from another driving end, and from locking.
pub fn margins(margin: &Margin) -> String {
    let mut lines = Vec::new();
    if let Some(b) = &margin.torque {
        lines.push(format!(
            "load on {} vanishes when the torque on {} goes from {} to {} N m",
            b.mesh,
            b.member,
            significant(b.value, 5),
            significant(b.boundary, 5)
        ));
    }
    if let Some(b) = &margin.speed {
        lines.push(format!(
            "relative motion in {} stops when the speed of {} goes from {} to {} rpm",
            b.mesh,
            b.member,
            significant(rpm(b.value), 5),
            significant(rpm(b.boundary), 5)
        ));
    }
    if let Some(l) = &margin.lock {
        lines.push(format!(
            "locks when η of {} falls from {} to {}",
            l.meshes.join(", "),
            significant(l.efficiency, 5),
            significant(l.threshold, 5)
        ));
    }
    if let Some(f) = margin.lock_loss_factor {
        lines.push(format!("locks when the loss of each set grows {} times", significant(f, 4)));
    }
    let text: String =
        lines.iter().enumerate().map(|(k, l)| format!("  {:<12} {l}\n", if k == 0 { "margin" } else { "" })).collect();
    text
}

fn role(m: &MemberReport) -> &'static str {
    match m.role {
        Role::Input => "input",
        Role::Output => "output",
        Role::Fixed => "fixed",
        _ => "",
    }
}

fn power_unit(s: &SolutionReport) -> (&'static str, f64) {
    let most = s.members.iter().filter_map(|(_, m)| m.power_w).fold(0.0f64, |a, p| a.max(p.abs()));
    if most >= 10e6 {
        ("MW", 1e6)
    } else if most >= 1e3 {
        ("kW", 1e3)
    } else {
        ("W", 1.0)
    }
}

/// Zero as a dash: the eye looks for what is there.
fn dash(x: f64, text: String) -> String {
    if x == 0.0 { "-".into() } else { text }
}
