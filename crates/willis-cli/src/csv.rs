//! The tables of an analysis as CSV: SI units in the column names, one row a thing.

use clap::ValueEnum;
use willis::analysis::{Analysis, SolutionReport, Verdict};
use willis::exact::Rational;

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub enum Table {
    /// The shift table.
    States,
    /// One row an operation and solution.
    Operations,
    /// One row a member in each solution.
    Members,
    /// One row a mesh in each solution.
    Meshes,
    /// One row an engaged shift element in each solution.
    ShiftElements,
    /// One row a source of loss in each solution, where losses are computed.
    Losses,
    /// One row a tooth contact in each solution, where teeth are given.
    Contacts,
    /// One row a place with rolling bearings in each solution.
    Bearings,
    /// Warnings and notes.
    Diagnostics,
}

/// One table, or all of them under `# name` lines with an empty line between.
pub fn analysis(a: &Analysis, table: Option<Table>) -> String {
    if let Some(t) = table {
        return rows(a, t);
    }
    // The tables of computed losses are there when there are any.
    let physical = a.operations.iter().any(|o| o.solutions.iter().any(|s| s.convergence.is_some()));
    let all: Vec<String> = Table::value_variants()
        .iter()
        .filter(|t| physical || !matches!(t, Table::Losses | Table::Contacts | Table::Bearings))
        .map(|t| format!("# {}\n{}", t.to_possible_value().expect("none is hidden").get_name(), rows(a, *t)))
        .collect();
    all.join("\n")
}

fn rows(a: &Analysis, table: Table) -> String {
    let mut out = Writer::default();
    match table {
        Table::States => {
            out.row([
                "state",
                "engaged",
                "input",
                "output",
                "degrees_of_freedom",
                "ratio_exact",
                "ratio",
                "step",
                "efficiency_driving",
                "verdict_driving",
                "efficiency_coasting",
                "verdict_coasting",
                "certified_driving",
                "certified_coasting",
            ]);
            for (name, s) in a.ratios.iter() {
                let certified = |d: &willis::analysis::Direction| {
                    d.certificate.is_some_and(|c| c.unique_for_every_load).to_string()
                };
                out.row([
                    name,
                    &s.engaged.join(" "),
                    &s.input,
                    &s.output,
                    &s.degrees_of_freedom.to_string(),
                    &s.exact.as_ref().map(Rational::to_fraction).unwrap_or_default(),
                    &number(s.value),
                    &number(s.step),
                    &number(s.drive.efficiency),
                    verdict(s.drive.verdict),
                    &number(s.coast.efficiency),
                    verdict(s.coast.verdict),
                    &certified(&s.drive),
                    &certified(&s.coast),
                ]);
            }
        }
        Table::Operations => {
            out.row([
                "operation",
                "state",
                "solution",
                "verdict",
                "certificate",
                "efficiency",
                "input_power_w",
                "output_power_w",
                "loss_w",
                "power_residual_w",
                "recirculating_power_w",
            ]);
            for o in &a.operations {
                let head = |solution: &str| {
                    vec![
                        o.name.clone(),
                        o.state.clone().unwrap_or_default(),
                        solution.to_owned(),
                        verdict(o.verdict).to_owned(),
                        o.certificate.map_or(String::new(), |c| c.method.as_str().to_owned()),
                    ]
                };
                if o.solutions.is_empty() {
                    let mut row = head("");
                    row.resize(11, String::new());
                    out.row(row);
                }
                for (k, s) in o.solutions.iter().enumerate() {
                    let mut row = head(&(k + 1).to_string());
                    row.push(number(s.efficiency));
                    let circulating: f64 = s.recirculation.iter().map(|r| r.power_w).sum();
                    for x in [s.input_power_w, s.output_power_w, s.loss_w, s.power_residual_w, circulating] {
                        row.push(number(Some(x)));
                    }
                    out.row(row);
                }
            }
        }
        Table::Members => {
            out.row([
                "operation",
                "state",
                "solution",
                "member",
                "role",
                "speed_rad_s",
                "carrier",
                "relative_speed_rad_s",
                "torque_n_m",
                "power_w",
            ]);
            each(a, |head, s| {
                for (name, m) in s.members.iter() {
                    let role = serde_json::to_value(m.role).expect("plain data");
                    let tail = [
                        name.clone(),
                        role.as_str().unwrap_or_default().to_owned(),
                        number(m.speed_rad_s),
                        m.carrier.clone().unwrap_or_default(),
                        number(m.relative_speed_rad_s),
                        number(m.torque_n_m),
                        number(m.power_w),
                    ];
                    out.row(head.iter().cloned().chain(tail));
                }
            });
        }
        Table::Meshes => {
            out.row([
                "operation",
                "state",
                "solution",
                "mesh",
                "driver",
                "relative_speed_rad_s",
                "potential_power_w",
                "efficiency",
                "loss_w",
                "first_torque_n_m",
                "second_torque_n_m",
                "carrier_torque_n_m",
                "count",
            ]);
            each(a, |head, s| {
                for (name, m) in s.meshes.iter() {
                    let tail = [
                        name.clone(),
                        m.driver.clone().unwrap_or_default(),
                        number(Some(m.relative_speed_rad_s)),
                        number(Some(m.potential_power_w)),
                        number(Some(m.efficiency)),
                        number(Some(m.loss_w)),
                        number(Some(m.first_torque_n_m)),
                        number(Some(m.second_torque_n_m)),
                        number(Some(m.carrier_torque_n_m)),
                        m.count.to_string(),
                    ];
                    out.row(head.iter().cloned().chain(tail));
                }
            });
        }
        Table::ShiftElements => {
            out.row(["operation", "state", "solution", "shift_element", "kind", "member", "other", "torque_n_m"]);
            each(a, |head, s| {
                for (name, e) in s.shift_elements.iter() {
                    let [m, other] = e.members.clone();
                    let tail = [name.clone(), e.kind.to_string(), m, other, number(e.torque_n_m)];
                    out.row(head.iter().cloned().chain(tail));
                }
            });
        }
        Table::Losses => {
            out.row(["operation", "state", "solution", "source", "kind", "law", "loss_w", "share"]);
            each(a, |head, s| {
                for x in &s.sources {
                    let kind = word(&x.kind);
                    let tail = [x.name.clone(), kind, x.law.clone(), number(Some(x.loss_w)), number(Some(x.share))];
                    out.row(head.iter().cloned().chain(tail));
                }
            });
        }
        Table::Contacts => {
            out.row([
                "operation",
                "state",
                "solution",
                "mesh",
                "friction",
                "loss_factor",
                "contact_ratio",
                "overlap_ratio",
                "tangential_force_n",
                "line_load_n_per_m",
                "pitch_line_speed_m_s",
                "sum_speed_m_s",
                "sliding_speed_m_s",
                "pitch_pressure_pa",
                "pressure_pa",
                "film_m",
                "film_ratio",
                "regime",
                "sliding_loss_w",
                "rolling_loss_w",
            ]);
            each(a, |head, s| {
                for (name, c) in s.contacts.iter() {
                    let mut row: Vec<String> = head.to_vec();
                    row.extend([name.clone(), number(c.friction)]);
                    for x in [
                        c.loss_factor,
                        c.contact_ratio,
                        c.overlap_ratio,
                        c.tangential_force_n,
                        c.line_load_n_per_m,
                        c.pitch_line_speed_m_s,
                        c.sum_speed_m_s,
                        c.sliding_speed_m_s,
                        c.pitch_pressure_pa,
                        c.pressure_pa,
                    ] {
                        row.push(number(Some(x)));
                    }
                    row.extend([number(c.film_m), number(c.film_ratio), c.regime.map_or(String::new(), |r| word(&r))]);
                    row.extend([number(Some(c.sliding_loss_w)), number(Some(c.rolling_loss_w))]);
                    out.row(row);
                }
            });
        }
        Table::Bearings => {
            out.row([
                "operation",
                "state",
                "solution",
                "bearing",
                "designation",
                "member",
                "other",
                "number",
                "speed_rad_s",
                "radial_load_n",
                "axial_load_n",
                "torque_n_m",
                "law",
                "loss_w",
            ]);
            each(a, |head, s| {
                for (name, b) in s.bearings.iter() {
                    let [m, other] = b.members.clone();
                    let mut row: Vec<String> = head.to_vec();
                    row.extend([name.clone(), b.designation.clone(), m, other, b.bearings.to_string()]);
                    for x in [b.speed_rad_s, b.radial_load_n, b.axial_load_n, b.torque_n_m] {
                        row.push(number(Some(x)));
                    }
                    row.extend([b.law.clone(), number(Some(b.loss_w))]);
                    out.row(row);
                }
            });
        }
        Table::Diagnostics => {
            out.row(["code", "severity", "place", "message", "hints"]);
            for d in &a.diagnostics {
                let severity = format!("{:?}", d.severity).to_lowercase();
                out.row([d.code.as_str(), &severity, &d.place, &d.message, &d.hints.join("; ")]);
            }
        }
    }
    out.0
}

/// The word that the results contract uses.
fn word(x: &impl serde::Serialize) -> String {
    serde_json::to_value(x).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}

fn each(a: &Analysis, mut f: impl FnMut(&[String], &SolutionReport)) {
    for o in &a.operations {
        for (k, s) in o.solutions.iter().enumerate() {
            let head = [o.name.clone(), o.state.clone().unwrap_or_default(), (k + 1).to_string()];
            f(&head, s);
        }
    }
}

pub fn verdict(v: Verdict) -> &'static str {
    match v {
        Verdict::Unique => "unique",
        Verdict::Multiple => "multiple",
        Verdict::Locked => "locked",
        Verdict::Unloaded => "unloaded",
        _ => "undetermined",
    }
}

/// The shortest text that reads back as the same number.
fn number(x: Option<f64>) -> String {
    // Adding zero turns -0.0 into 0.0.
    x.map_or(String::new(), |x| format!("{:?}", x + 0.0))
}

#[derive(Default)]
pub struct Writer(pub String);

impl Writer {
    pub fn row<S: AsRef<str>>(&mut self, fields: impl IntoIterator<Item = S>) {
        for (k, field) in fields.into_iter().enumerate() {
            if k > 0 {
                self.0.push(',');
            }
            self::field(&mut self.0, field.as_ref());
        }
        self.0.push('\n');
    }
}

/// A field, in quotes where it needs them.
pub fn field(out: &mut String, text: &str) {
    if text.contains([',', '"', '\n', '\r']) {
        out.push('"');
        *out += &text.replace('"', "\"\"");
        out.push('"');
    } else {
        *out += text;
    }
}
