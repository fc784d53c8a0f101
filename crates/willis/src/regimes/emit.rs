//! Closed formulas as text, LaTeX and source code.
//!
//! Emitted code checks the conditions of the regime first. Called outside, it says so (an
//! exception, an error, a status, a failed assertion) instead of returning a number.

use std::fmt::Write;

use crate::diagnostic::is_printable;
use crate::symbolic::{Function, Notation};

use super::closed::{Argument, ClosedFormula, FormulaSheet};
use super::formula::{SymbolKind, escape, upright};

impl FormulaSheet {
    /// All formulas in a notation: a page of text, a piece of LaTeX, or a source file. With
    /// `derivatives`, also the derivatives of each efficiency.
    pub fn emit(&self, notation: Notation, derivatives: bool) -> String {
        let mut out = self.head(notation);
        for (state, why) in &self.without {
            let state = if notation == Notation::Text { &self.heading(state) } else { state };
            out += &remark(notation, &format!("{state}: no formula: {why}"));
            out += if notation == Notation::Text { "\n\n" } else { "\n" };
        }
        if !self.formulas.is_empty() {
            out += prelude(notation);
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

    /// What a file begins with.
    fn head(&self, notation: Notation) -> String {
        let what = format!("Closed formulas of {}", self.train);
        let units = "Speeds in rad/s, torques in N m, both on the member.";
        match notation {
            Notation::Text => String::new(),
            Notation::Latex => remark(notation, &format!("{what}. Needs amsmath; fits a text 16 cm wide.")) + "\n",
            // No comment: Python would obey one that names an encoding.
            Notation::Python => {
                format!("\"\"\"{}, written by Willis.\n\n{units}\n\"\"\"\n", comment(&what))
            }
            _ => remark(notation, &format!("{what}, written by Willis. {units}")) + "\n",
        }
    }

    fn heading(&self, state: &str) -> String {
        match state == crate::train::AS_DRAWN {
            true => self.train.clone(),
            false => format!("{}, state {state}", self.train),
        }
    }
}

/// What the functions of a file share.
fn prelude(notation: Notation) -> &'static str {
    match notation {
        Notation::Python => {
            "\nimport math\n\n\nclass OutsideRegime(ValueError):\n    \
             \"\"\"The arguments lie outside the regime in which a formula holds.\"\"\"\n"
        }
        Notation::Rust => {
            "\n/// The arguments lie outside the regime in which a formula holds; the text says what is not the \
             case.\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct OutsideRegime(pub &'static str);\n"
        }
        Notation::C => {
            "/* Every function returns 0, or the number of the first condition that does not hold; the result is \
             then untouched. */\n\n#include <math.h>\n"
        }
        _ => "",
    }
}

/// A comment of one line.
fn remark(notation: Notation, text: &str) -> String {
    match notation {
        Notation::Text => text.to_owned(),
        Notation::Latex => format!("% {}", comment(text)),
        Notation::Python => format!("# {}", comment(text)),
        Notation::C => format!("/* {} */", comment(text)),
        Notation::Rust | Notation::Modelica => format!("// {}", comment(text)),
    }
}

/// Text that ends no comment or string, begins no line and hides nothing.
fn comment(text: &str) -> String {
    let harmless = |c: char| match c {
        // Compilers refuse marks of the writing direction.
        '\\' => ' ',
        c if !is_printable(c) => ' ',
        c => c,
    };
    let mut clean: String = text.chars().map(harmless).collect();
    // The last is how C once wrote a backslash.
    for (bad, good) in [("\"\"\"", "'''"), ("/*", "/ *"), ("*/", "* /"), ("??", "? ?")] {
        while clean.contains(bad) {
            clean = clean.replace(bad, good);
        }
    }
    clean
}

/// Text within double quotes.
fn quoted(text: &str) -> String {
    comment(text).replace('"', "'")
}

impl ClosedFormula {
    /// What emitted code returns: name, expression in a notation and meaning of the efficiency, of
    /// the ratios or the dependent speeds and torques, and, with `derivatives`, of the derivatives
    /// of the efficiency.
    pub fn results(&self, notation: Notation, derivatives: bool) -> Vec<(String, String, String)> {
        let mut all = vec![("efficiency".to_owned(), self.efficiency(notation), "output over input power".to_owned())];
        if let Some([speed, torque]) = self.ratios(notation) {
            let (a, b) = (&self.inputs[0], &self.outputs[0]);
            all.push(("speed_ratio".to_owned(), speed, format!("speed of {a} over that of {b}")));
            all.push(("torque_ratio".to_owned(), torque, format!("torque on {b} over that on {a}")));
        }
        for (symbol, function) in self.dependent() {
            let info = self.names.info(symbol);
            all.push((info.name.clone(), self.names.show(notation, function), info.meaning.clone()));
        }
        if derivatives {
            for a in self.arguments.iter().filter(|a| a.efficiency) {
                let d = self.names.show(notation, &self.efficiency.derivative(a.symbol));
                let meaning = format!("derivative of the efficiency by {}", a.name);
                all.push((format!("d_efficiency_d_{}", a.name), d, meaning));
            }
        }
        all
    }
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
    for (symbol, function) in f.dependent() {
        lines.push(vec![f.names.info(symbol).name.clone(), f.names.show(Notation::Text, function), String::new()]);
    }
    for line in columns(lines) {
        let _ = writeln!(out, "  {line}");
    }
    let conditions = f.conditions(Notation::Text).into_iter().map(|(c, text)| vec![format!("{c} > 0"), text]).collect();
    rows(out, "holds where", columns(conditions));
    let arguments = f.arguments.iter().map(|a| {
        let value = if a.exact.is_integer() { number(a.value) } else { format!("{} = {}", a.exact, number(a.value)) };
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
    let _ = writeln!(out, "\n\\paragraph{{{}: {}.}}", plain(heading), plain(&f.title).replace("->", "\\(\\to\\)"));
    let _ = writeln!(out, "\\begin{{align}}");
    let mut lines = vec![format!("\\eta &= {}", f.efficiency(n))];
    if let Some([speed, torque]) = f.ratios(n) {
        let (a, b) = (upright(&f.inputs[0]), upright(&f.outputs[0]));
        lines.push(format!("\\frac{{\\omega_{{{a}}}}}{{\\omega_{{{b}}}}} &= {speed}"));
        lines.push(format!("\\frac{{T_{{{b}}}}}{{T_{{{a}}}}} &= {torque}"));
    }
    for (symbol, function) in f.dependent() {
        lines.push(format!("{} &= {}", f.names.info(symbol).latex, f.names.show(n, function)));
    }
    if derivatives {
        for a in f.arguments.iter().filter(|a| a.efficiency) {
            let d = f.names.show(n, &f.efficiency.derivative(a.symbol));
            lines.push(format!("\\frac{{\\partial \\eta}}{{\\partial {}}} &= {d}", a.latex));
        }
    }
    let _ = writeln!(out, "{}", lines.join(" \\\\\n"));
    let _ = writeln!(out, "\\end{{align}}");
    let conditions: Vec<String> = f.conditions(n).into_iter().map(|(c, _)| format!("{c} > 0")).collect();
    if !conditions.is_empty() {
        let _ = writeln!(out, "valid where\n\\begin{{gather*}}\n{}\n\\end{{gather*}}", conditions.join(", \\\\\n"));
    }
    let arguments: Vec<String> = f
        .arguments
        .iter()
        .map(|a| {
            let value = if a.fixed { format!(" = {}", number(a.value)) } else { String::new() };
            let meaning = a.meaning_latex.clone().unwrap_or_else(|| plain(&a.meaning));
            format!("\\({}{value}\\) ({meaning})", a.latex)
        })
        .collect();
    if !arguments.is_empty() {
        let _ = writeln!(out, "with {}.", arguments.join(", "));
    }
}

/// Words within LaTeX text.
fn plain(text: &str) -> String {
    escape(&comment(text))
        .replace("\\backslash{}", "\\textbackslash{}")
        .replace("\\hat{}", "\\textasciicircum{}")
        .replace("\\sim{}", "\\textasciitilde{}")
}

/// The parts of a function, in the order in which code needs them.
struct Code<'f> {
    notation: Notation,
    /// Those that must be given come first.
    arguments: Vec<&'f Argument>,
    /// Arguments that are no efficiencies: they must be finite.
    numbers: Vec<&'f str>,
    /// Condition and refusal of arguments that cannot have every value.
    ranges: Vec<(String, String)>,
    /// Name and expression of what the conditions need beside the arguments.
    dependent: Vec<(String, String)>,
    /// Expression that must be positive, and what that ensures.
    conditions: Vec<(String, String)>,
    /// Name and expression of the other results.
    others: Vec<(String, String)>,
    /// Name and meaning of all results.
    results: Vec<(String, String)>,
}

impl<'f> Code<'f> {
    fn new(f: &'f ClosedFormula, notation: Notation, derivatives: bool) -> Self {
        let mut arguments: Vec<&Argument> = f.arguments.iter().collect();
        arguments.sort_by_key(|a| a.fixed);
        let numbers = arguments.iter().filter(|a| !a.efficiency).map(|a| a.name.as_str()).collect();
        let ranges = arguments.iter().filter_map(|a| range(notation, a)).collect();
        let before: Vec<&str> = f.dependent().map(|(s, _)| f.names.info(s).name.as_str()).collect();
        let (mut dependent, mut others, mut results) = (vec![], vec![], vec![]);
        for (name, expression, meaning) in f.results(notation, derivatives) {
            results.push((name.clone(), meaning));
            let list = if before.contains(&name.as_str()) { &mut dependent } else { &mut others };
            list.push((name, expression));
        }
        Self { notation, arguments, numbers, ranges, dependent, conditions: f.conditions(notation), others, results }
    }

    /// The value that the train gives an argument, where it does, within a pattern such as `=@`.
    fn value(&self, a: &Argument, pattern: &str) -> String {
        let value = || self.notation.function(&Function::from(a.exact.clone()), &|_| String::new());
        if a.fixed { pattern.replace('@', &value()) } else { String::new() }
    }

    /// The same for readers.
    fn remark(&self, a: &Argument) -> String {
        let value = if a.fixed { format!(" ({} in this train)", fraction(a)) } else { String::new() };
        comment(&a.meaning) + &value
    }

    fn arguments(&self, entry: impl Fn(&Argument) -> String) -> String {
        self.arguments.iter().map(|a| entry(a)).collect::<Vec<_>>().join(", ")
    }

    /// The names of all results, each within a pattern such as `isfinite(@)`.
    fn each(&self, pattern: &str, separator: &str) -> String {
        each(self.results.iter().map(|(name, _)| name.as_str()), pattern, separator)
    }
}

/// The condition that an argument makes sense at all, and its refusal.
fn range(notation: Notation, a: &Argument) -> Option<(String, String)> {
    let (name, outside) = (&a.name, a.range()?);
    let condition = match (a.kind, notation) {
        (SymbolKind::Efficiency, Notation::Python) => format!("0 < {name} <= 1"),
        (SymbolKind::Efficiency, Notation::Modelica) => format!("{name} > 0 and {name} <= 1"),
        (SymbolKind::Efficiency, _) => format!("{name} > 0.0 && {name} <= 1.0"),
        (SymbolKind::Teeth, Notation::Python | Notation::Modelica) => format!("{name} > 0"),
        (SymbolKind::Teeth, _) => format!("{name} > 0.0"),
        // Comparing for equality is what some compilers warn of.
        (_, Notation::Python | Notation::Modelica) => format!("abs({name}) > 0"),
        (_, Notation::Rust) => format!("{name}.abs() > 0.0"),
        (_, _) => format!("fabs({name}) > 0.0"),
    };
    Some((condition, outside.to_string()))
}

fn fraction(a: &Argument) -> String {
    a.exact.to_string()
}

fn each<'n>(names: impl IntoIterator<Item = &'n str>, pattern: &str, separator: &str) -> String {
    names.into_iter().map(|name| pattern.replace('@', name)).collect::<Vec<_>>().join(separator)
}

fn python(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let code = Code::new(f, Notation::Python, derivatives);
    let arguments = code.arguments(|a| a.name.clone() + &code.value(a, "=@"));
    let _ = writeln!(out, "\n\ndef {}({arguments}):", f.name);
    let _ = writeln!(out, "    \"\"\"{}: {}.\n", comment(heading), comment(&f.title));
    for a in &code.arguments {
        let _ = writeln!(out, "    {}: {}", a.name, comment(&a.meaning));
    }
    let _ = writeln!(out, "\n    Raises OutsideRegime where the formula does not hold.\n    \"\"\"\n    try:");
    let refuse =
        |condition: &str, why: &str| format!("        if not {condition}:\n            raise OutsideRegime({why})\n");
    if !code.numbers.is_empty() {
        let condition = format!("all(map(math.isfinite, [{}]))", code.numbers.join(", "));
        *out += &refuse(&condition, "\"an argument is not finite\"");
    }
    for (condition, why) in &code.ranges {
        *out += &refuse(condition, &format!("\"{why}\""));
    }
    for (name, expression) in &code.dependent {
        let _ = writeln!(out, "        {name} = {expression}");
    }
    for (expression, meaning) in &code.conditions {
        *out += &refuse(&format!("{expression} > 0"), &format!("\"not true that {}\"", quoted(meaning)));
    }
    for (name, expression) in &code.others {
        let _ = writeln!(out, "        {name} = {expression}");
    }
    let condition = format!("all(map(math.isfinite, [{}]))", code.each("@", ", "));
    *out += &refuse(&condition, "\"a result is not finite\"");
    let _ = writeln!(out, "    except ArithmeticError:");
    let _ = writeln!(out, "        raise OutsideRegime(\"a denominator is zero or a number too large\") from None");
    let _ = writeln!(out, "    return {{\n        {},\n    }}", code.each("\"@\": @", ",\n        "));
}

/// The name of a Rust type.
fn camel(name: &str) -> String {
    let capital = |word: &str| word[..1].to_ascii_uppercase() + &word[1..];
    name.split('_').filter(|word| !word.is_empty()).map(capital).collect()
}

fn rust(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let code = Code::new(f, Notation::Rust, derivatives);
    let kind = camel(&f.name);
    let _ = writeln!(out, "\n/// What [`{}`] answers.", f.name);
    let _ = writeln!(out, "#[allow(non_snake_case)]\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct {kind} {{");
    for (name, meaning) in &code.results {
        let _ = writeln!(out, "    /// {}\n    pub {name}: f64,", comment(meaning));
    }
    let _ = writeln!(out, "}}\n\n/// {}: {}.\n///", comment(heading), comment(&f.title));
    for a in &code.arguments {
        let _ = writeln!(out, "/// * `{}`: {}", a.name, code.remark(a));
    }
    let arguments = code.arguments(|a| format!("{}: f64", a.name));
    let _ = writeln!(out, "#[allow(non_snake_case, clippy::all)]");
    let _ = writeln!(out, "pub fn {}({arguments}) -> Result<{kind}, OutsideRegime> {{", f.name);
    let refuse = |condition: &str, why: &str| {
        format!("    if !({condition}) {{\n        return Err(OutsideRegime(\"{why}\"));\n    }}\n")
    };
    if !code.numbers.is_empty() {
        *out += &refuse(&each(code.numbers.iter().copied(), "@.is_finite()", " && "), "an argument is not finite");
    }
    for (condition, why) in &code.ranges {
        *out += &refuse(condition, why);
    }
    for (name, expression) in &code.dependent {
        let _ = writeln!(out, "    let {name}: f64 = {expression};");
    }
    for (expression, meaning) in &code.conditions {
        *out += &refuse(&format!("{expression} > 0.0"), &format!("not true that {}", quoted(meaning)));
    }
    for (name, expression) in &code.others {
        let _ = writeln!(out, "    let {name}: f64 = {expression};");
    }
    *out += &refuse(&code.each("@.is_finite()", " && "), "a result is not finite");
    let _ = writeln!(out, "    Ok({kind} {{ {} }})\n}}", code.each("@", ", "));
}

fn c(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let code = Code::new(f, Notation::C, derivatives);
    let _ = writeln!(out, "\nstruct {} {{", f.name);
    for (name, meaning) in &code.results {
        let _ = writeln!(out, "    double {name}; /* {} */", comment(meaning));
    }
    let _ = writeln!(out, "}};\n\n/* {}: {}.", comment(heading), comment(&f.title));
    for a in &code.arguments {
        let _ = writeln!(out, "   {}: {}", a.name, code.remark(a));
    }
    let conditions =
        code.conditions.iter().map(|(e, meaning)| (format!("{e} > 0.0"), format!("not true that {meaning}")));
    // By the status that the function returns.
    let checks: Vec<(usize, (String, String))> = (2..).zip(code.ranges.iter().cloned().chain(conditions)).collect();
    let _ = writeln!(out, "   returns 1: an argument or a result is not finite");
    for (status, (_, meaning)) in &checks {
        let _ = writeln!(out, "   returns {status}: {}", comment(meaning));
    }
    let arguments: String = code.arguments.iter().map(|a| format!("double {}, ", a.name)).collect();
    let _ = writeln!(out, "*/\nstatic inline int {0}({arguments}struct {0} *result)\n{{", f.name);
    if !code.numbers.is_empty() {
        let finite = each(code.numbers.iter().copied(), "isfinite(@)", " && ");
        let _ = writeln!(out, "    if (!({finite})) return 1;");
    }
    for (name, expression) in &code.dependent {
        let _ = writeln!(out, "    const double {name} = {expression};");
    }
    for (status, (condition, _)) in &checks {
        let _ = writeln!(out, "    if (!({condition})) return {status};");
    }
    for (name, expression) in &code.others {
        let _ = writeln!(out, "    const double {name} = {expression};");
    }
    let _ = writeln!(out, "    if (!({})) return 1;", code.each("isfinite(@)", " && "));
    let _ = writeln!(out, "    {}", code.each("result->@ = @;", "\n    "));
    let _ = writeln!(out, "    return 0;\n}}");
}

fn modelica(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let code = Code::new(f, Notation::Modelica, derivatives);
    let _ = writeln!(out, "\nfunction {} \"{}: {}\"", f.name, quoted(heading), quoted(&f.title));
    for a in &code.arguments {
        let _ = writeln!(out, "  input Real {}{} \"{}\";", a.name, code.value(a, " = @"), quoted(&a.meaning));
    }
    for (name, meaning) in &code.results {
        let _ = writeln!(out, "  output Real {name} \"{}\";", quoted(meaning));
    }
    let _ = writeln!(out, "algorithm");
    for name in &code.numbers {
        let _ = writeln!(out, "  assert(abs({name}) < 1e300, \"{name} is not finite\");");
    }
    for (condition, why) in &code.ranges {
        let _ = writeln!(out, "  assert({condition}, \"{why}\");");
    }
    for (name, expression) in &code.dependent {
        let _ = writeln!(out, "  {name} := {expression};");
    }
    for (expression, meaning) in &code.conditions {
        let _ = writeln!(out, "  assert({expression} > 0, \"outside the regime: not true that {}\");", quoted(meaning));
    }
    for (name, expression) in &code.others {
        let _ = writeln!(out, "  {name} := {expression};");
    }
    let _ = writeln!(out, "end {};", f.name);
}
