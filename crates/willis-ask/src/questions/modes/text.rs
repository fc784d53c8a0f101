//! Natural frequencies for eyes.

use willis::dynamics::{Mode, ModesReport, Part};

use crate::style::{bold, percent, plural, right, set_header, show, significant, table, wrap};

/// Columns of the tables of shapes.
const MOST: usize = 8;

pub fn text(all: &ModesReport) -> String {
    let mut out = bold(&all.train) + "\n";
    out += &format!("{}   state {}", bold("Natural frequencies"), all.state);
    if !all.fixed.is_empty() {
        out += &format!(", held: {}", all.fixed.join(", "));
    }
    out.push('\n');
    let rigid = plural(all.rigid_body_modes.len(), "motion without strain (0 Hz)", "motions without strain (0 Hz)");
    out += &format!("  {rigid}, {}\n", plural(all.modes.len(), "vibration", "vibrations"));
    if !all.modes.is_empty() {
        let mut t = table();
        set_header(&mut t, &["mode", "f Hz", "ω rad/s", "damping ζ", "damped Hz", "swings most", "strains most"]);
        for (k, m) in all.modes.iter().enumerate() {
            let damped = match (m.damping_ratio, m.damped_frequency_hz) {
                (None, _) => "-".into(),
                (_, None) => "does not vibrate".into(),
                (_, Some(f)) => significant(f, 6),
            };
            t.add_row([
                (k + 1).to_string(),
                significant(m.frequency_hz, 6),
                significant(m.angular_frequency_rad_s, 6),
                m.damping_ratio.map_or("-".into(), |z| significant(z, 3)),
                damped,
                most(&m.kinetic_energy),
                most(&m.strain_energy),
            ]);
        }
        right(&mut t, 0..5);
        out += &show(&t);
    }
    if !all.planet_modes.is_empty() {
        out += &format!("\n{}\n", bold("Planets against each other, all else at rest"));
        let mut t = table();
        set_header(&mut t, &["set", "f Hz", "ω rad/s", "damping ζ", "such vibrations", "strains most"]);
        for p in &all.planet_modes {
            t.add_row([
                p.set.clone(),
                significant(p.mode.frequency_hz, 6),
                significant(p.mode.angular_frequency_rad_s, 6),
                p.mode.damping_ratio.map_or("-".into(), |z| significant(z, 3)),
                p.multiplicity.to_string(),
                most(&p.mode.strain_energy),
            ]);
        }
        right(&mut t, 1..5);
        out += &show(&t);
    }
    let rigid: Vec<(String, &[Part])> =
        all.rigid_body_modes.iter().enumerate().map(|(k, m)| (format!("0 Hz, {}", k + 1), &m.shape[..])).collect();
    let shapes: Vec<_> = rigid.into_iter().chain(columns(&all.modes, |m| &m.shape)).collect();
    out += &matrix("Shapes: angle amplitudes, the largest 1", "member", &shapes, |x| significant(x, 3));
    let energy = columns(&all.modes, |m| &m.kinetic_energy);
    out += &matrix("Kinetic energy", "member", &energy, percent);
    let energy = columns(&all.modes, |m| &m.strain_energy);
    out += &matrix("Strain energy", "shaft or mesh", &energy, percent);
    for (head, lines) in [("Assumptions in force", &all.assumptions), ("Notes", &all.notes)] {
        if lines.is_empty() {
            continue;
        }
        out += &format!("\n{}\n", bold(head));
        for line in lines {
            out += &wrap(line, "  · ");
            out.push('\n');
        }
    }
    out + "\n"
}

fn columns<'a>(modes: &'a [Mode], of: impl Fn(&'a Mode) -> &'a [Part]) -> Vec<(String, &'a [Part])> {
    modes.iter().enumerate().map(|(k, m)| (format!("mode {}", k + 1), of(m))).collect()
}

/// Whose share is the largest.
fn most(parts: &[Part]) -> String {
    let top = parts.iter().max_by(|a, b| a.value.total_cmp(&b.value)).filter(|p| p.value > 0.0);
    top.map_or("-".into(), |p| format!("{} {:.0} %", p.name, 100.0 * p.value))
}

/// A row a part, a column a mode.
fn matrix(head: &str, of: &str, all: &[(String, &[Part])], show_value: impl Fn(f64) -> String) -> String {
    let mut names: Vec<&str> = Vec::new();
    for p in all.iter().flat_map(|m| m.1) {
        if !names.contains(&p.name.as_str()) {
            names.push(&p.name);
        }
    }
    if names.is_empty() {
        return String::new();
    }
    let shown = &all[..all.len().min(MOST)];
    let mut t = table();
    let header: Vec<&str> = std::iter::once(of).chain(shown.iter().map(|m| m.0.as_str())).collect();
    set_header(&mut t, &header);
    for name in names {
        let value = |parts: &[Part]| match parts.iter().find(|p| p.name == name) {
            // Round-off is no motion.
            Some(p) if p.value.abs() < 1e-9 => "0".into(),
            Some(p) => show_value(p.value),
            None => "-".into(),
        };
        t.add_row(std::iter::once(name.to_owned()).chain(shown.iter().map(|m| value(m.1))));
    }
    right(&mut t, 1..header.len());
    let mut out = format!("\n{}\n{}", bold(head), show(&t));
    if all.len() > MOST {
        out += &format!("  … and {} more modes, all in the JSON answer\n", all.len() - MOST);
    }
    out
}
