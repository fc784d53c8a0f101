//! Regimes for typesetting.

use willis::regimes::{Family, Regimes};

/// The regimes as a LaTeX table, and their formulas.
pub fn latex(all: &Regimes) -> String {
    let mut out = format!("% Regimes of {}. Needs amsmath, array and longtable.\n", all.train);
    for a in &all.states {
        if let Some(why) = &a.reason {
            out += &format!("% {}: {why}\n", a.state);
            continue;
        }
        if let Some(basis) = &a.efficiency_basis {
            out += &format!("% {}: {basis}.\n", a.state);
        }
        // Columns that break their lines, for trains with many terminals.
        let column = |width: &str| format!(">{{\\raggedright\\arraybackslash}}p{{{width}\\linewidth}}");
        let (speeds, torques, roles) = (column("0.34"), column("0.21"), column("0.2"));
        out += &format!("{{\\footnotesize\n\\begin{{longtable}}{{l{speeds}{torques}{roles}l}}\n");
        out += "regime & speeds & torques & inputs $\\to$ outputs & formula \\\\ \\hline \\endhead\n";
        for r in &a.regimes {
            let chain = |text: &str| {
                let speed = |name: &str| match name.strip_prefix("w_") {
                    Some(name) => format!("\\omega_{{{}}}", index(name)),
                    None => name.to_owned(),
                };
                let same = |part: &str| part.split(" = ").map(speed).collect::<Vec<_>>().join(" = ");
                format!("${}$", text.split(" > ").map(same).collect::<Vec<_>>().join(" > "))
            };
            let speeds: Vec<String> = a.regions[r.region - 1].order.iter().map(|c| chain(c)).collect();
            let torques: Vec<String> = r
                .torque_signs
                .iter()
                .map(|(n, s)| match s {
                    1 => format!("$T_{{{}}} > 0$", index(n)),
                    -1 => format!("$T_{{{}}} < 0$", index(n)),
                    _ => format!("$T_{{{}}} = 0$", index(n)),
                })
                .collect();
            let names = |list: &[String]| list.iter().map(|n| escape(n)).collect::<Vec<_>>().join(", ");
            let to = if r.outputs.is_empty() { "heat".to_owned() } else { names(&r.outputs) };
            let mark = if r.by_friction_only { "$^{*}$" } else { "" };
            out += &format!(
                "{}{mark} & {} & {} & {} $\\to$ {to} & {} \\\\[2pt]\n",
                r.id.replace('-', "$-$").replace('+', "$+$"),
                speeds.join("; "),
                torques.join(", "),
                names(&r.inputs),
                r.formula
            );
        }
        out += "\\end{longtable}}\n";
        if a.regimes.iter().any(|r| r.by_friction_only) {
            out += "$^{*}$ torque signs that exist only because of friction.\n";
        }
        out += "{\\allowdisplaybreaks\n\\begin{align*}\n";
        let lines: Vec<String> =
            a.formulas.iter().map(|f| format!("\\text{{{}}}\\quad \\eta &= {}", f.id, f.efficiency_latex)).collect();
        out += &lines.join(" \\\\[4pt]\n");
        out += "\n\\end{align*}}\n";
    }
    out
}

/// A name as an index in a formula.
fn index(name: &str) -> String {
    if name.chars().count() == 1 || name.chars().all(|c| c.is_ascii_digit()) {
        return escape(name);
    }
    format!("\\mathrm{{{}}}", escape(name).replace('-', "\\text{-}").replace(' ', "\\ "))
}

fn escape(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '_' | '%' | '&' | '#' | '$' | '{' | '}' => format!("\\{c}"),
            '\\' => "\\textbackslash{}".to_owned(),
            '^' => "\\textasciicircum{}".to_owned(),
            '~' => "\\textasciitilde{}".to_owned(),
            _ => c.to_string(),
        })
        .collect()
}
/// Esmail's Table 1 with his columns, and the ranges of R that it lacks beside them.
pub fn family_latex(f: &Family) -> String {
    let mut out =
        format!("% {}: tooth friction loss for every operating condition, after Esmail 2018, Table 1.\n", f.train);
    out += "% Needs amsmath and longtable. Ranges marked * lie between 1 and a self-locking limit.\n";
    // A line and a mirror image: T_4 > 0, ... : omega_4 > omega_1 > 0 > omega_2.
    let sub = |name: &str| index(name);
    for (k, case) in f.cases.iter().enumerate() {
        let star = if case.band { "$^{*}$" } else { "" };
        out += &format!(
            "\n\\begin{{longtable}}{{lllll}}\n\\multicolumn{{5}}{{l}}{{${}${star}}} \\\\ \\hline\n",
            case.latex
        );
        out += "input & output & torques & speeds & loss \\\\ \\hline\n";
        for row in &f.rows {
            for group in &row.cells[k] {
                for (n, range) in group.ranges.iter().enumerate() {
                    let torques: Vec<String> = range
                        .torque_signs
                        .iter()
                        .map(|(n, s)| format!("T_{{{}}} {} 0", sub(n), if *s > 0 { ">" } else { "<" }))
                        .collect();
                    let speeds: Vec<String> = range
                        .order
                        .iter()
                        .map(|n| if n == "0" { n.clone() } else { format!("\\omega_{{{}}}", sub(n)) })
                        .collect();
                    let names = |l: &[String]| l.iter().map(|n| escape(n)).collect::<Vec<_>>().join(",");
                    let links = |l: &[String]| l.iter().map(|n| sub(n)).collect::<Vec<_>>().join(",");
                    let (inputs, outputs, loss) = match n {
                        0 => (
                            names(&row.inputs),
                            if row.outputs.is_empty() { "heat".to_owned() } else { names(&row.outputs) },
                            match row.outputs.is_empty() {
                                true => format!("$l = {}$", group.loss_latex),
                                false => format!(
                                    "$\\displaystyle l_{{({}-{})}} = {}$",
                                    links(&row.inputs),
                                    links(&row.outputs),
                                    group.loss_latex
                                ),
                            },
                        ),
                        _ => Default::default(),
                    };
                    let end = if n + 1 == group.ranges.len() { "[6pt]" } else { "" };
                    out += &format!(
                        "{inputs} & {outputs} & ${}$ & ${}$ & {loss} \\\\{end}\n",
                        torques.join(", "),
                        speeds.join(" > ")
                    );
                }
            }
        }
        out += "\\end{longtable}\n";
    }
    out
}
