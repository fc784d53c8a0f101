//! Closed formulas as text, LaTeX and source code.
//!
//! Emitted code checks the conditions of the regime first. Called outside, it says so (an
//! exception, an error, a status, a failed assertion) instead of returning a number.

use std::fmt::Write;

use crate::symbolic::Notation;

use super::closed::{ClosedFormula, FormulaSheet};
use super::formula::escape;

impl FormulaSheet {
    /// All formulas in a notation: a page of text, a piece of LaTeX, or a source file. With
    /// `derivatives`, also the derivatives of each efficiency.
    pub fn emit(&self, notation: Notation, derivatives: bool) -> String {
        let mut out = String::new();
        match notation {
            Notation::Text => {}
            Notation::Latex => {
                let _ = writeln!(out, "% Closed formulas of {}. Needs amsmath.", self.train.replace('\n', " "));
            }
            _ => {
                let (open, close) = match notation {
                    Notation::Python => ("# ", ""),
                    Notation::C => ("/* ", " */"),
                    _ => ("// ", ""),
                };
                let _ = writeln!(
                    out,
                    "{open}Closed formulas of {}, written by Willis. Speeds in rad/s, torques in N m, both on the \
                     member.{close}",
                    comment(&self.train)
                );
            }
        }
        for (state, why) in &self.without {
            match notation {
                Notation::Text => {
                    let _ = writeln!(out, "{}: no formula: {why}\n", self.heading(state));
                }
                Notation::Latex => {
                    let _ = writeln!(out, "% {state}: no formula: {why}");
                }
                Notation::Python => {
                    let _ = writeln!(out, "# {}: no formula: {}", comment(state), comment(why));
                }
                Notation::C => {
                    let _ = writeln!(out, "/* {}: no formula: {} */", comment(state), comment(why));
                }
                _ => {
                    let _ = writeln!(out, "// {}: no formula: {}", comment(state), comment(why));
                }
            }
        }
        match notation {
            Notation::Python if !self.formulas.is_empty() => {
                out += "\n\nclass OutsideRegime(ValueError):\n    \"\"\"The arguments lie outside the regime in which a \
                        formula holds.\"\"\"\n";
            }
            Notation::Rust if !self.formulas.is_empty() => {
                out += "\n/// The arguments lie outside the regime in which a formula holds; the text says what is not \
                        the case.\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct OutsideRegime(pub &'static str);\n";
            }
            Notation::C if !self.formulas.is_empty() => {
                out += "/* Every function returns 0, or the number of the first condition that does not hold; the \
                        result is then untouched. */\n";
            }
            _ => {}
        }
        for f in &self.formulas {
            let heading = self.heading(&f.state);
            match notation {
                Notation::Text => text(&mut out, f, &heading, derivatives),
                Notation::Latex => latex(&mut out, f, &heading, derivatives),
                Notation::Python => python(&mut out, f, &heading, derivatives),
                Notation::Rust => rust(&mut out, f, &heading, derivatives),
                Notation::C => c(&mut out, f, &heading, derivatives),
                Notation::Modelica => modelica(&mut out, f, &heading, derivatives),
            }
        }
        out
    }

    fn heading(&self, state: &str) -> String {
        match state == crate::analysis::AS_DRAWN {
            true => self.train.clone(),
            false => format!("{}, state {state}", self.train),
        }
    }
}

/// Text that ends no comment or string and begins no line.
fn comment(text: &str) -> String {
    let mut clean: String = text.chars().map(|c| if c.is_control() || c == '\\' { ' ' } else { c }).collect();
    while clean.contains("*/") || clean.contains("/*") || clean.contains("\"\"\"") {
        clean = clean.replace("*/", "* ").replace("/*", " *").replace("\"\"\"", "'''");
    }
    clean
}

/// Text within double quotes.
fn quoted(text: &str) -> String {
    comment(text).replace('"', "'")
}

/// Names and expressions of all results, in order.
fn results(f: &ClosedFormula, notation: Notation, derivatives: bool) -> Vec<(String, String, String)> {
    let mut all = vec![("efficiency".to_owned(), f.efficiency(notation), "output over input power".to_owned())];
    if let Some([speed, torque]) = f.ratios(notation) {
        let (a, b) = (&f.inputs[0], &f.outputs[0]);
        all.push(("speed_ratio".to_owned(), speed, format!("speed of {a} over that of {b}")));
        all.push(("torque_ratio".to_owned(), torque, format!("torque on {b} over that on {a}")));
    }
    for t in &f.terminals {
        for (symbol, function, given) in
            [(t.speed_symbol, &t.speed, t.given_speed), (t.torque_symbol, &t.torque, t.given_torque)]
        {
            if !given {
                let info = f.names.info(symbol);
                all.push((info.name.clone(), f.names.show(notation, function), info.meaning.clone()));
            }
        }
    }
    if derivatives {
        for a in f.arguments.iter().filter(|a| a.efficiency) {
            let d = f.names.show(notation, &f.efficiency.derivative(a.symbol));
            all.push((format!("d_efficiency_d_{}", a.name), d, format!("derivative of the efficiency by {}", a.name)));
        }
    }
    all
}

/// Expression and refusal of every guard.
fn guards(f: &ClosedFormula, notation: Notation) -> Vec<(String, String)> {
    f.conditions(notation)
}

fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-4..1e7).contains(&size) {
        let text = format!("{value:.6}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.5e}")
    }
}

fn rows(out: &mut String, label: &str, lines: impl IntoIterator<Item = String>) {
    for (k, line) in lines.into_iter().enumerate() {
        let _ = writeln!(out, "  {:<13} {line}", if k == 0 { label } else { "" });
    }
}

/// Columns of equal width.
fn columns(rows: Vec<Vec<String>>) -> Vec<String> {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| rows.iter().filter_map(|r| r.get(c)).map(|s| s.chars().count()).max().unwrap_or(0);
    // A column of formulas may be long; beyond this it is not padded.
    let widths: Vec<usize> = (0..count).map(|c| width(c).min(56)).collect();
    rows.into_iter()
        .map(|r| {
            let padded = r.iter().zip(&widths).map(|(s, w)| {
                let blanks = w.saturating_sub(s.chars().count());
                format!("{s}{}", " ".repeat(blanks))
            });
            padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        })
        .collect()
}

fn text(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let _ = writeln!(out, "{heading}: {}", f.title);
    if !f.regimes.is_empty() {
        rows(out, "regimes", [f.regimes.join(", ")]);
    }
    let drivers: Vec<String> =
        f.drivers.iter().filter_map(|(e, d)| d.as_ref().map(|d| format!("{d} in {e}"))).collect();
    if !drivers.is_empty() {
        rows(out, "drives", [drivers.join(", ")]);
    }
    let value = f.value().map_or(String::new(), |v| format!("= {}", number(v.to_f64())));
    let mut lines = vec![vec!["efficiency".to_owned(), f.efficiency(Notation::Text), value]];
    if let Some([speed, torque]) = f.ratios(Notation::Text) {
        let (a, b) = (&f.inputs[0], &f.outputs[0]);
        let ratios = f.ratio_values();
        let shown = |k: usize| ratios.as_ref().map_or(String::new(), |r| format!("= {}", number(r[k])));
        lines.push(vec![format!("w_{a}/w_{b}"), speed, shown(0)]);
        lines.push(vec![format!("T_{b}/T_{a}"), torque, shown(1)]);
    }
    for t in &f.terminals {
        for (symbol, function, given) in
            [(t.speed_symbol, &t.speed, t.given_speed), (t.torque_symbol, &t.torque, t.given_torque)]
        {
            if !given {
                lines.push(vec![
                    f.names.info(symbol).name.clone(),
                    f.names.show(Notation::Text, function),
                    String::new(),
                ]);
            }
        }
    }
    for line in columns(lines) {
        let _ = writeln!(out, "  {line}");
    }
    let conditions = guards(f, Notation::Text).into_iter().map(|(c, text)| vec![format!("{c} > 0"), text]).collect();
    rows(out, "holds where", columns(conditions));
    let arguments = f.arguments.iter().map(|a| {
        let value =
            if a.exact.ends_with("/1") { number(a.value) } else { format!("{} = {}", a.exact, number(a.value)) };
        let value = if a.fixed { format!("= {value}") } else { "given".to_owned() };
        vec![a.name.clone(), value, a.meaning.clone()]
    });
    rows(out, "with", columns(arguments.collect()));
    if derivatives {
        let all = f.derivatives();
        let lines = all.iter().map(|d| {
            vec![
                format!("d eta/d {}", d.of),
                d.formula.clone(),
                format!("= {}", number(d.value)),
                format!("costs {} % points", number(100.0 * d.share)),
            ]
        });
        rows(out, "what matters", columns(lines.collect()));
    }
    out.push('\n');
}

fn latex(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let n = Notation::Latex;
    let _ = writeln!(out, "\n% {}: {}", comment(heading), comment(&f.title));
    let _ = writeln!(out, "\\begin{{align}}");
    let mut lines = vec![format!("\\eta &= {}", f.efficiency(n))];
    let index = |name: &str| format!("\\mathrm{{{}}}", escape(name));
    if let Some([speed, torque]) = f.ratios(n) {
        let (a, b) = (index(&f.inputs[0]), index(&f.outputs[0]));
        lines.push(format!("\\frac{{\\omega_{{{a}}}}}{{\\omega_{{{b}}}}} &= {speed}"));
        lines.push(format!("\\frac{{T_{{{b}}}}}{{T_{{{a}}}}} &= {torque}"));
    }
    for t in &f.terminals {
        for (symbol, function, given) in
            [(t.speed_symbol, &t.speed, t.given_speed), (t.torque_symbol, &t.torque, t.given_torque)]
        {
            if !given {
                lines.push(format!("{} &= {}", f.names.info(symbol).latex, f.names.show(n, function)));
            }
        }
    }
    if derivatives {
        for a in f.arguments.iter().filter(|a| a.efficiency) {
            let d = f.names.show(n, &f.efficiency.derivative(a.symbol));
            lines.push(format!("\\frac{{\\partial \\eta}}{{\\partial {}}} &= {d}", a.latex));
        }
    }
    let _ = writeln!(out, "{}", lines.join(" \\\\\n"));
    let _ = writeln!(out, "\\end{{align}}");
    let conditions: Vec<String> = guards(f, n).into_iter().map(|(c, _)| format!("\\({c} > 0\\)")).collect();
    if !conditions.is_empty() {
        let _ = writeln!(out, "valid where {};", conditions.join(", "));
    }
    let arguments: Vec<String> = f
        .arguments
        .iter()
        .map(|a| match a.fixed {
            true => format!("\\({} = {}\\) ({})", a.latex, number(a.value), plain(&a.meaning)),
            false => format!("\\({}\\) ({})", a.latex, plain(&a.meaning)),
        })
        .collect();
    let _ = writeln!(out, "with {}.", arguments.join(", "));
}

/// Words within LaTeX text.
fn plain(text: &str) -> String {
    escape(text)
        .replace("\\backslash ", "\\textbackslash{}")
        .replace("\\hat{}", "\\textasciicircum{}")
        .replace("\\sim ", "\\textasciitilde{}")
}

/// Those that must be given first, then those that the train fixes.
fn ordered(f: &ClosedFormula) -> Vec<&super::Argument> {
    f.arguments.iter().filter(|a| !a.fixed).chain(f.arguments.iter().filter(|a| a.fixed)).collect()
}

fn fraction(a: &super::Argument) -> String {
    a.exact.strip_suffix("/1").unwrap_or(&a.exact).to_owned()
}

/// Quantities that conditions need and that follow from the arguments.
fn derived(f: &ClosedFormula, notation: Notation) -> Vec<(String, String)> {
    f.terminals
        .iter()
        .flat_map(|t| [(t.speed_symbol, &t.speed, t.given_speed), (t.torque_symbol, &t.torque, t.given_torque)])
        .filter(|(_, _, given)| !given)
        .map(|(s, function, _)| (f.names.info(s).name.clone(), f.names.show(notation, function)))
        .collect()
}

/// Results that are not derived before the guards.
fn remaining(f: &ClosedFormula, notation: Notation, derivatives: bool) -> Vec<(String, String, String)> {
    let before: Vec<String> = derived(f, notation).into_iter().map(|(n, _)| n).collect();
    results(f, notation, derivatives).into_iter().filter(|(n, _, _)| !before.contains(n)).collect()
}

fn python(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let n = Notation::Python;
    let arguments: Vec<String> = ordered(f)
        .iter()
        .map(|a| if a.fixed { format!("{}={}", a.name, fraction(a)) } else { a.name.clone() })
        .collect();
    let _ = writeln!(out, "\n\ndef {}({}):", f.name, arguments.join(", "));
    let _ = writeln!(out, "    \"\"\"{}: {}.\n", comment(heading), comment(&f.title));
    for a in ordered(f) {
        let _ = writeln!(out, "    {}: {}", a.name, comment(&a.meaning));
    }
    let _ = writeln!(out, "\n    Raises OutsideRegime where the formula does not hold.\n    \"\"\"");
    for a in f.arguments.iter().filter(|a| a.efficiency) {
        let _ = writeln!(out, "    if not 0 < {0} <= 1:", a.name);
        let _ = writeln!(out, "        raise OutsideRegime(f\"{0} = {{{0}}} is not above 0 and at most 1\")", a.name);
    }
    for (name, expression) in derived(f, n) {
        let _ = writeln!(out, "    {name} = {expression}");
    }
    for (expression, meaning) in guards(f, n) {
        let _ = writeln!(out, "    if not {expression} > 0:");
        let _ = writeln!(out, "        raise OutsideRegime(\"not true that {}\")", quoted(&meaning));
    }
    let _ = writeln!(out, "    return {{");
    for (name, _) in derived(f, n) {
        let _ = writeln!(out, "        \"{name}\": {name},");
    }
    for (name, expression, _) in remaining(f, n, derivatives) {
        let _ = writeln!(out, "        \"{name}\": {expression},");
    }
    let _ = writeln!(out, "    }}");
}

fn camel(name: &str) -> String {
    name.split('_')
        .map(|w| {
            let mut c = w.chars();
            c.next().map_or(String::new(), |first| first.to_ascii_uppercase().to_string() + c.as_str())
        })
        .collect()
}

fn rust(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let n = Notation::Rust;
    let kind = camel(&f.name);
    let _ = writeln!(out, "\n/// What [`{}`] answers.", f.name);
    let _ = writeln!(out, "#[allow(non_snake_case)]\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct {kind} {{");
    for (name, _, meaning) in results(f, n, derivatives) {
        let _ = writeln!(out, "    /// {}\n    pub {name}: f64,", comment(&meaning));
    }
    let _ = writeln!(out, "}}\n\n/// {}: {}.\n///", comment(heading), comment(&f.title));
    for a in ordered(f) {
        let value = if a.fixed { format!(" ({} in this train)", fraction(a)) } else { String::new() };
        let _ = writeln!(out, "/// * `{}`: {}{value}", a.name, comment(&a.meaning));
    }
    let arguments: Vec<String> = ordered(f).iter().map(|a| format!("{}: f64", a.name)).collect();
    let _ = writeln!(out, "#[allow(non_snake_case, clippy::all)]");
    let _ = writeln!(out, "pub fn {}({}) -> Result<{kind}, OutsideRegime> {{", f.name, arguments.join(", "));
    for a in f.arguments.iter().filter(|a| a.efficiency) {
        let _ = writeln!(out, "    if !({0} > 0.0 && {0} <= 1.0) {{", a.name);
        let _ =
            writeln!(out, "        return Err(OutsideRegime(\"{} is not above 0 and at most 1\"));\n    }}", a.name);
    }
    for (name, expression) in derived(f, n) {
        let _ = writeln!(out, "    let {name} = {expression};");
    }
    for (expression, meaning) in guards(f, n) {
        let _ = writeln!(out, "    if !({expression} > 0.0) {{");
        let _ = writeln!(out, "        return Err(OutsideRegime(\"not true that {}\"));\n    }}", quoted(&meaning));
    }
    let _ = writeln!(out, "    Ok({kind} {{");
    for (name, _) in derived(f, n) {
        let _ = writeln!(out, "        {name},");
    }
    for (name, expression, _) in remaining(f, n, derivatives) {
        let _ = writeln!(out, "        {name}: {expression},");
    }
    let _ = writeln!(out, "    }})\n}}");
}

fn c(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let n = Notation::C;
    let _ = writeln!(out, "\ntypedef struct {{");
    for (name, _, meaning) in results(f, n, derivatives) {
        let _ = writeln!(out, "    double {name}; /* {} */", comment(&meaning));
    }
    let _ = writeln!(out, "}} {}_result;\n\n/* {}: {}.", f.name, comment(heading), comment(&f.title));
    for a in ordered(f) {
        let value = if a.fixed { format!(" ({} in this train)", fraction(a)) } else { String::new() };
        let _ = writeln!(out, "   {}: {}{value}", a.name, comment(&a.meaning));
    }
    let mut number = 0;
    for a in f.arguments.iter().filter(|a| a.efficiency) {
        number += 1;
        let _ = writeln!(out, "   returns {number}: {} is not above 0 and at most 1", a.name);
    }
    for (_, meaning) in guards(f, n) {
        number += 1;
        let _ = writeln!(out, "   returns {number}: not true that {}", comment(&meaning));
    }
    let arguments: Vec<String> = ordered(f).iter().map(|a| format!("double {}", a.name)).collect();
    let separator = if arguments.is_empty() { "" } else { ", " };
    let _ = writeln!(out, "*/\nstatic int {0}({1}{separator}{0}_result *result)\n{{", f.name, arguments.join(", "));
    let mut number = 0;
    // C89 compilers want declarations first.
    for (name, expression) in derived(f, n) {
        let _ = writeln!(out, "    const double {name} = {expression};");
    }
    for a in f.arguments.iter().filter(|a| a.efficiency) {
        number += 1;
        let _ = writeln!(out, "    if (!({0} > 0.0 && {0} <= 1.0)) return {number};", a.name);
    }
    for (expression, _) in guards(f, n) {
        number += 1;
        let _ = writeln!(out, "    if (!({expression} > 0.0)) return {number};");
    }
    for (name, _) in derived(f, n) {
        let _ = writeln!(out, "    result->{name} = {name};");
    }
    for (name, expression, _) in remaining(f, n, derivatives) {
        let _ = writeln!(out, "    result->{name} = {expression};");
    }
    let _ = writeln!(out, "    return 0;\n}}");
}

fn modelica(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let n = Notation::Modelica;
    let _ = writeln!(out, "\nfunction {} \"{}: {}\"", f.name, quoted(heading), quoted(&f.title));
    for a in ordered(f) {
        let value = if a.fixed { format!(" = {}", fraction(a)) } else { String::new() };
        let _ = writeln!(out, "  input Real {}{value} \"{}\";", a.name, quoted(&a.meaning));
    }
    for (name, _, meaning) in results(f, n, derivatives) {
        let _ = writeln!(out, "  output Real {name} \"{}\";", quoted(&meaning));
    }
    let _ = writeln!(out, "algorithm");
    for a in f.arguments.iter().filter(|a| a.efficiency) {
        let _ = writeln!(out, "  assert({0} > 0 and {0} <= 1, \"{0} is not above 0 and at most 1\");", a.name);
    }
    for (name, expression) in derived(f, n) {
        let _ = writeln!(out, "  {name} := {expression};");
    }
    for (expression, meaning) in guards(f, n) {
        let _ =
            writeln!(out, "  assert({expression} > 0, \"outside the regime: not true that {}\");", quoted(&meaning));
    }
    for (name, expression, _) in remaining(f, n, derivatives) {
        let _ = writeln!(out, "  {name} := {expression};");
    }
    let _ = writeln!(out, "end {};", f.name);
}
