//! Closed formulas as text, LaTeX and source code.
//!
//! Emitted code checks the conditions of the regime first. Called outside, it says so (an
//! exception, an error, a status, a failed assertion) instead of returning a number. With two or more freedoms it also
//! counts the equilibria: a function for each state says which of all its formulas hold at a point, none or several, and
//! each formula returns how many.

use std::fmt::Write;

use crate::diagnostic::is_printable;
use crate::symbolic::{Notation, RationalFunction, Symbol};

use super::closed::{Argument, ClosedFormula, FormulaSheet, Holds, Together};
use super::formula::{Names, SymbolKind, escape, upright};

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
        let mut counted: Vec<&str> = Vec::new();
        let mut said: Option<&str> = None;
        for f in &self.formulas {
            let heading = self.heading(&f.state);
            if let Some(basis) = f.basis.as_ref().filter(|_| said != Some(&f.state)) {
                let state = if notation == Notation::Text { &heading } else { &f.state };
                out += &format!("\n{}\n", remark(notation, &format!("{state}: {basis}.")));
                said = Some(&f.state);
            }
            if let Some(together) = f.together.as_deref().filter(|own| !counted.contains(&own.name.as_str())) {
                Count::new(together, notation).write(&mut out, &heading);
                counted.push(&together.name);
            }
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
    if !f.beside.is_empty() {
        let text = format!("in this train regimes {} are further equilibria where this one holds", f.beside.join(", "));
        rows(out, "not alone", [text]);
    }
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
            let meaning =
                a.made_of.as_ref().map_or_else(|| plain(&a.meaning), |speeds| format!("basic ratio \\({speeds}\\)"));
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
    /// More freedoms: the call that counts the equilibria.
    count: Option<String>,
}

/// What emitted code returns beside the results of a formula.
const COUNTED: &str =
    "number of equilibria at these speeds and torques: above 1 friction leaves a choice, and this is one of them";

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
        let conditions = f.conditions(notation);
        let count = f.together.as_deref().map(|own| Count::new(own, notation).call(f));
        Self { notation, arguments, numbers, ranges, dependent, conditions, others, results, count }
    }

    /// The value that the train gives an argument, where it does, within a pattern such as `=@`.
    fn value(&self, a: &Argument, pattern: &str) -> String {
        let value = || self.notation.function(&RationalFunction::from(a.exact.clone()), &|_| String::new());
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
    if code.count.is_some() {
        let _ = writeln!(out, "\n    Returns as `equilibria` the {COUNTED}.");
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
    let count = code.count.as_ref().map_or(String::new(), |count| format!(",\n        \"equilibria\": len({count})"));
    let _ = writeln!(out, "    return {{\n        {}{count},\n    }}", code.each("\"@\": @", ",\n        "));
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
    if code.count.is_some() {
        let _ = writeln!(out, "    /// {COUNTED}\n    pub equilibria: usize,");
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
    let mut fields = code.each("@", ", ");
    if let Some(count) = &code.count {
        let _ = writeln!(out, "    let equilibria = {count}?.iter().filter(|holds| **holds).count();");
        fields += ", equilibria";
    }
    let _ = writeln!(out, "    Ok({kind} {{ {fields} }})\n}}");
}

fn c(out: &mut String, f: &ClosedFormula, heading: &str, derivatives: bool) {
    let code = Code::new(f, Notation::C, derivatives);
    let _ = writeln!(out, "\nstruct {} {{", f.name);
    for (name, meaning) in &code.results {
        let _ = writeln!(out, "    double {name}; /* {} */", comment(meaning));
    }
    if code.count.is_some() {
        let _ = writeln!(out, "    int equilibria; /* {COUNTED} */");
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
    let counted = f.together.as_deref().zip(code.count.as_deref());
    if let Some((together, count)) = counted {
        let _ = writeln!(out, "    unsigned char holds[{}];", together.all.len());
        let count = count.strip_suffix(')').expect("a call");
        let _ = writeln!(out, "    const int equilibria = {count}, holds);\n    if (equilibria < 1) return 1;");
    }
    let _ = writeln!(out, "    {}", code.each("result->@ = @;", "\n    "));
    if counted.is_some() {
        let _ = writeln!(out, "    result->equilibria = equilibria;");
    }
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
    if code.count.is_some() {
        let _ = writeln!(out, "  output Real equilibria \"{COUNTED}\";");
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
    if let Some(count) = &code.count {
        let _ = writeln!(out, "  equilibria := {count};");
    }
    let _ = writeln!(out, "end {};", f.name);
}

/// The function that says which formulas of a state hold, in the order of code.
struct Count<'f> {
    notation: Notation,
    together: &'f Together,
    arguments: Vec<&'f Argument>,
    numbers: Vec<&'f str>,
    ranges: Vec<(String, String)>,
    /// Name and expression of the speeds that follow.
    speeds: Vec<(String, String)>,
    /// By formula: the conditions under which it holds.
    holds: Vec<Vec<String>>,
}

/// What it is for, on every language's first line.
const SEVERAL: &str = "several where friction leaves a choice, none where it locks the train (or on a boundary)";

impl<'f> Count<'f> {
    fn new(together: &'f Together, notation: Notation) -> Self {
        let mut arguments: Vec<&Argument> = together.arguments.iter().collect();
        arguments.sort_by_key(|a| a.fixed);
        let conditions = |h: &Holds| h.conditions.iter().map(|c| h.names.show(notation, c)).collect();
        let speed =
            |(s, f, names): &(Symbol, RationalFunction, Names)| (names.info(*s).name.clone(), names.show(notation, f));
        Self {
            notation,
            numbers: arguments.iter().filter(|a| !a.efficiency).map(|a| a.name.as_str()).collect(),
            ranges: arguments.iter().filter_map(|a| range(notation, a)).collect(),
            speeds: together.speeds.iter().map(speed).collect(),
            holds: together.all.iter().map(conditions).collect(),
            arguments,
            together,
        }
    }

    fn arguments(&self, entry: impl Fn(&Argument) -> String) -> String {
        self.arguments.iter().map(|a| entry(a)).collect::<Vec<_>>().join(", ")
    }

    /// The conditions of a formula, each within a pattern such as `@ > 0`.
    fn condition(&self, k: usize, pattern: &str, and: &str, always: &str) -> String {
        match &self.holds[k][..] {
            [] => always.to_owned(),
            all => each(all.iter().map(String::as_str), pattern, and),
        }
    }

    fn value(&self, a: &Argument, pattern: &str) -> String {
        let value = || self.notation.function(&RationalFunction::from(a.exact.clone()), &|_| String::new());
        if a.fixed { pattern.replace('@', &value()) } else { String::new() }
    }

    /// What formula `k` is.
    fn what(&self, k: usize) -> String {
        let own = &self.together.all[k];
        comment(&format!("{}, {}, regimes {}", own.id, own.title, own.regimes.join(", ")))
    }

    /// The call from a formula, which passes what it has and what the train fixes of the rest.
    fn call(&self, f: &ClosedFormula) -> String {
        let pass = |a: &Argument| match f.arguments.iter().any(|own| own.name == a.name) {
            true => a.name.clone(),
            false => self.value(a, "@"),
        };
        format!("{}({})", self.together.name, self.arguments(pass))
    }

    fn write(&self, out: &mut String, heading: &str) {
        match self.notation {
            Notation::Python => self.python(out, heading),
            Notation::C => self.c(out, heading),
            Notation::Rust => self.rust(out, heading),
            Notation::Modelica => self.modelica(out, heading),
            Notation::Text | Notation::Latex => {}
        }
    }

    fn python(&self, out: &mut String, heading: &str) {
        let arguments = self.arguments(|a| a.name.clone() + &self.value(a, "=@"));
        let _ = writeln!(out, "\n\ndef {}({arguments}):", self.together.name);
        let _ = writeln!(
            out,
            "    \"\"\"{}: the formulas that hold at these speeds and torques, by name.\n",
            comment(heading)
        );
        let _ = writeln!(out, "    Each is an equilibrium: {SEVERAL}.\n");
        for k in 0..self.holds.len() {
            let _ = writeln!(out, "    {}", self.what(k));
        }
        let _ = writeln!(out, "    \"\"\"\n    try:");
        if !self.numbers.is_empty() {
            let _ = writeln!(out, "        if not all(map(math.isfinite, [{}])):", self.numbers.join(", "));
            let _ = writeln!(out, "            raise OutsideRegime(\"an argument is not finite\")");
        }
        for (condition, why) in &self.ranges {
            let _ = writeln!(out, "        if not {condition}:\n            raise OutsideRegime(\"{why}\")");
        }
        for (name, expression) in &self.speeds {
            let _ = writeln!(out, "        {name} = {expression}");
        }
        let _ = writeln!(out, "        holds = {{");
        for (k, own) in self.together.all.iter().enumerate() {
            let _ = writeln!(out, "            \"{}\": {},", own.id, self.condition(k, "@ > 0", " and ", "True"));
        }
        let _ = writeln!(out, "        }}\n    except ArithmeticError:");
        let _ = writeln!(out, "        raise OutsideRegime(\"a denominator is zero or a number too large\") from None");
        let _ = writeln!(out, "    return [name for name, does in holds.items() if does]");
    }

    fn c(&self, out: &mut String, heading: &str) {
        let (name, n) = (&self.together.name, self.holds.len());
        let _ = writeln!(
            out,
            "\n/* {}: how many formulas hold at these speeds and torques, and in holds which.",
            comment(heading)
        );
        let _ = writeln!(out, "   Each is an equilibrium: {SEVERAL}.");
        let _ = writeln!(out, "   Returns -1 if an argument can have no such value.");
        for k in 0..n {
            let _ = writeln!(out, "   holds[{k}]: {}", self.what(k));
        }
        let arguments: String = self.arguments.iter().map(|a| format!("double {}, ", a.name)).collect();
        let _ = writeln!(out, "*/\nstatic inline int {name}({arguments}unsigned char holds[{n}])\n{{");
        if !self.numbers.is_empty() {
            let finite = each(self.numbers.iter().copied(), "isfinite(@)", " && ");
            let _ = writeln!(out, "    if (!({finite})) return -1;");
        }
        for (condition, _) in &self.ranges {
            let _ = writeln!(out, "    if (!({condition})) return -1;");
        }
        for (name, expression) in &self.speeds {
            let _ = writeln!(out, "    const double {name} = {expression};");
        }
        for k in 0..n {
            let _ = writeln!(out, "    holds[{k}] = {};", self.condition(k, "@ > 0.0", " && ", "1"));
        }
        let sum = (0..n).map(|k| format!("holds[{k}]")).collect::<Vec<_>>().join(" + ");
        let _ = writeln!(out, "    return {sum};\n}}");
    }

    fn rust(&self, out: &mut String, heading: &str) {
        let n = self.holds.len();
        let _ = writeln!(out, "\n/// {}: which formulas hold at these speeds and torques.\n///", comment(heading));
        let _ = writeln!(out, "/// Each is an equilibrium: {SEVERAL}.\n///");
        for k in 0..n {
            let _ = writeln!(out, "/// * {k}: {}", self.what(k));
        }
        let arguments = self.arguments(|a| format!("{}: f64", a.name));
        let _ = writeln!(out, "#[allow(non_snake_case, unused_variables, clippy::all)]");
        let _ = writeln!(out, "pub fn {}({arguments}) -> Result<[bool; {n}], OutsideRegime> {{", self.together.name);
        let refuse = |condition: &str, why: &str| {
            format!("    if !({condition}) {{\n        return Err(OutsideRegime(\"{why}\"));\n    }}\n")
        };
        if !self.numbers.is_empty() {
            *out += &refuse(&each(self.numbers.iter().copied(), "@.is_finite()", " && "), "an argument is not finite");
        }
        for (condition, why) in &self.ranges {
            *out += &refuse(condition, why);
        }
        for (name, expression) in &self.speeds {
            let _ = writeln!(out, "    let {name}: f64 = {expression};");
        }
        let _ = writeln!(out, "    Ok([");
        for k in 0..n {
            let _ = writeln!(out, "        {},", self.condition(k, "@ > 0.0", " && ", "true"));
        }
        let _ = writeln!(out, "    ])\n}}");
    }

    fn modelica(&self, out: &mut String, heading: &str) {
        let what = format!("{}: how many formulas hold at these speeds and torques", quoted(heading));
        let _ = writeln!(out, "\nfunction {} \"{what}; {SEVERAL}\"", self.together.name);
        for a in &self.arguments {
            let _ = writeln!(out, "  input Real {}{} \"{}\";", a.name, self.value(a, " = @"), quoted(&a.meaning));
        }
        let _ = writeln!(out, "  output Real equilibria \"their number\";");
        for (k, own) in self.together.all.iter().enumerate() {
            let _ = writeln!(out, "  output Real holds_{} \"1 where it does: {}\";", own.id, quoted(&self.what(k)));
        }
        if !self.speeds.is_empty() {
            let _ = writeln!(out, "protected");
        }
        for (name, _) in &self.speeds {
            let _ = writeln!(out, "  Real {name};");
        }
        let _ = writeln!(out, "algorithm");
        for name in &self.numbers {
            let _ = writeln!(out, "  assert(abs({name}) < 1e300, \"{name} is not finite\");");
        }
        for (condition, why) in &self.ranges {
            let _ = writeln!(out, "  assert({condition}, \"{why}\");");
        }
        for (name, expression) in &self.speeds {
            let _ = writeln!(out, "  {name} := {expression};");
        }
        for (k, own) in self.together.all.iter().enumerate() {
            let condition = self.condition(k, "@ > 0", " and ", "true");
            let _ = writeln!(out, "  holds_{} := if {condition} then 1 else 0;", own.id);
        }
        let sum = self.together.all.iter().map(|own| format!("holds_{}", own.id)).collect::<Vec<_>>().join(" + ");
        let _ = writeln!(out, "  equilibria := {sum};\nend {};", self.together.name);
    }
}
