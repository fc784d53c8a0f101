//! Emitted code against the formulas it was emitted from: the same numbers inside the regime, no
//! number outside.
//!
//! Python, C and Rust are run on the same points; the functions in Modelica are parsed by a parser
//! of the language and interpreted here, exactly. The numbers to be met come from exact arithmetic.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use willis::exact::Rational;
use willis::regimes::{ClosedFormula, Efficiencies, FormulaRequest, FormulaSheet, Ratios, formulas};
use willis::symbolic::Notation;
use willis::train::Train;

use crate::common::{Dice, example};

// ---------------------------------------------------------------- trains

fn sheet(toml: &str, request: &FormulaRequest) -> FormulaSheet {
    let train = Train::from_toml(toml).unwrap_or_else(|e| panic!("{e}\n{toml}"));
    let sheet = formulas(&train, request).unwrap_or_else(|e| panic!("{}: {e}", train.name()));
    assert!(!sheet.formulas.is_empty(), "{}: {:?}", train.name(), sheet.without);
    sheet
}

/// A simple set with each of its members held in turn, driven from either side.
fn inversions() -> String {
    let mut text = String::from(
        r#"format = 1
name = "Simple set"
members = ["sun", "ring", "arm"]
terminals = ["sun", "ring", "arm"]
[[set]]
name = "P1"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20 }
ring = { member = "ring", teeth = 70 }
carrier = "arm"
mesh_efficiency = { external = 0.97, internal = 0.99 }
"#,
    );
    for held in ["sun", "ring", "arm"] {
        let [a, b]: [&str; 2] =
            ["sun", "ring", "arm"].into_iter().filter(|m| *m != held).collect::<Vec<_>>().try_into().unwrap();
        let _ = writeln!(text, "[[shift_element]]\nname = 'brake {held}'\nkind = 'brake'\nmembers = ['{held}']");
        for (from, to) in [(a, b), (b, a)] {
            let _ = writeln!(
                text,
                "[[state]]\nname = '{from} to {to}'\nengaged = ['brake {held}']\ninput = '{from}'\noutput = '{to}'"
            );
        }
    }
    text
}

/// Names that end comments and strings, look like escapes, hide themselves or coincide once only
/// letters are left.
const HOSTILE: &str = r#"format = 1
name = "3 coding: latin-1 */ /* \"\"\" \\ \"π\" ??/ {x} \\N{x} class for end"
members = ["a b", "a_b", "\"\"\" ring??/", "end\\*/"]
terminals = ["a b", "a_b", "\"\"\" ring??/", "end\\*/"]
input = "a b"
output = "\"\"\" ring??/"
[[set]]
name = "fn */"
sun = { member = "a b", teeth = 30 }
planet = { teeth = 20 }
ring = { member = "\"\"\" ring??/", teeth = 70 }
carrier = "end\\*/"
mesh_efficiency = { external = 0.97, internal = 0.99 }
[[set]]
name = "fn_*/"
sun = { member = "a_b", teeth = 24 }
planet = { teeth = 18 }
ring = { member = "end\\*/", teeth = 60 }
carrier = "\"\"\" ring??/"
mesh_efficiency = { external = 0.98, internal = 0.99 }
[[shift_element]]
name = "\\"
kind = "brake"
members = ["a_b"]
[[shift_element]]
name = "//"
kind = "brake"
members = ["end\\*/"]
[[state]]
name = "1 2"
engaged = ["\\"]
[[state]]
name = "12"
engaged = ["//"]
[[state]]
name = "S\"\\"
engaged = ["\\"]
[[state]]
name = "s%\\"
engaged = ["//"]
"#;

/// Names that are words of the languages.
const KEYWORDS: &str = r#"format = 1
name = "class"
members = ["fn", "for", "end"]
terminals = ["fn", "for", "end"]
[[set]]
name = "def"
sun = { member = "fn", teeth = 30 }
planet = { teeth = 20 }
ring = { member = "for", teeth = 70 }
carrier = "end"
mesh_efficiency = { external = 0.97, internal = 0.99 }
[[shift_element]]
name = "struct"
kind = "brake"
members = ["end"]
[[state]]
name = "return"
engaged = ["struct"]
input = "fn"
output = "for"
"#;

/// Names without a letter that code could use.
const UNICODE: &str = r#"format = 1
name = "行星"
members = ["太陽", "環", "架"]
terminals = ["太陽", "環", "架"]
[[set]]
name = "組"
sun = { member = "太陽", teeth = 30 }
planet = { teeth = 20 }
ring = { member = "環", teeth = 70 }
carrier = "架"
mesh_efficiency = { external = 0.97, internal = 0.99 }
"#;

fn sheets() -> Vec<FormulaSheet> {
    let all = FormulaRequest::default();
    let named = |toml: &str, name: &str| {
        let old = toml.lines().find(|l| l.starts_with("name = ")).expect("the train's name");
        toml.replacen(old, &format!("name = {name:?}"), 1)
    };
    let mut sheets = vec![
        sheet(&inversions(), &all),
        sheet(&example("esmail-fig1.toml"), &all),
        sheet(&named(&example("esmail-fig1-band.toml"), "Esmail, band"), &all),
        sheet(&example("compound-split.toml"), &all),
        sheet(
            &named(&example("compound-split.toml"), "Idle battery"),
            &FormulaRequest { balance: Some(["mg_a".into(), "mg_b".into()]), ..all.clone() },
        ),
    ];
    let shifted = named(&example("zf-8hp70.toml"), "8HP70");
    for state in ["1", "2", "3", "4"] {
        sheets.push(sheet(&shifted, &FormulaRequest { state: Some(state.into()), ..all.clone() }));
    }
    let ways = [Ratios::Basic, Ratios::Teeth, Ratios::Numbers]
        .into_iter()
        .flat_map(|r| [Efficiencies::Basic, Efficiencies::Meshes, Efficiencies::Numbers].map(|e| (r, e)));
    for (ratios, efficiencies) in ways {
        let request = FormulaRequest { ratios, efficiencies, ..all.clone() };
        sheets.push(sheet(&named(&example("prius-p112.toml"), &format!("P112 {ratios:?} {efficiencies:?}")), &request));
    }
    let spelt = FormulaRequest { ratios: Ratios::Teeth, efficiencies: Efficiencies::Meshes, ..all.clone() };
    sheets.push(sheet(HOSTILE, &all));
    sheets.push(sheet(&HOSTILE.replacen("3 coding", "4 coding", 1), &spelt));
    sheets.push(sheet(KEYWORDS, &all));
    sheets.push(sheet(UNICODE, &all));
    sheets.push(sheet(&UNICODE.replacen("行星", "Ünï", 1), &spelt));
    sheets
}

// ---------------------------------------------------------------- exact arithmetic on text

/// Reads an expression in text or Modelica and evaluates it exactly.
struct Exact<'a> {
    text: &'a [u8],
    at: usize,
    value: &'a dyn Fn(&str) -> Rational,
    /// The worst cancellation met: a sum over the sum of the sizes of its terms.
    left: f64,
}

/// `None` on a pole; with the worst cancellation on the way, 1 if there is none.
fn exact(text: &str, value: &dyn Fn(&str) -> Rational) -> (Option<Rational>, f64) {
    let mut e = Exact { text: text.as_bytes(), at: 0, value, left: 1.0 };
    let result = e.sum();
    if result.is_some() {
        assert_eq!(e.at, e.text.len(), "read only a part of {text}");
    }
    (result, e.left)
}

impl Exact<'_> {
    fn next(&mut self) -> u8 {
        while self.text.get(self.at) == Some(&b' ') {
            self.at += 1;
        }
        self.text.get(self.at).copied().unwrap_or(b';')
    }

    fn take(&mut self, c: u8) -> bool {
        let found = self.next() == c;
        self.at += usize::from(found);
        found
    }

    fn sum(&mut self) -> Option<Rational> {
        let mut negative = self.take(b'-');
        let (mut sum, mut size) = (Rational::ZERO, Rational::ZERO);
        loop {
            let term = self.term()?;
            size += term.abs();
            sum = if negative { sum - term } else { sum + term };
            negative = match self.next() {
                b'+' => false,
                b'-' => true,
                _ => break,
            };
            self.at += 1;
        }
        // An exact zero is met by floating point, too, where the numbers are short.
        if !sum.is_zero() {
            self.left = self.left.min((sum.abs() / size).to_f64());
        }
        Some(sum)
    }

    fn term(&mut self) -> Option<Rational> {
        let mut product = self.power()?;
        loop {
            if self.take(b'*') {
                product = product * self.power()?;
            } else if self.take(b'/') {
                let below = self.power()?;
                if below.is_zero() {
                    return None;
                }
                product = product / below;
            } else {
                return Some(product);
            }
        }
    }

    fn power(&mut self) -> Option<Rational> {
        let base = self.primary()?;
        if !self.take(b'^') {
            return Some(base);
        }
        let exponent: usize = self.word().parse().expect("a whole exponent");
        Some((0..exponent).fold(Rational::ONE, |product, _| product * &base))
    }

    fn word(&mut self) -> String {
        self.next();
        let rest = &self.text[self.at..];
        let end = rest.iter().position(|c| !c.is_ascii_alphanumeric() && !b"_.".contains(c)).unwrap_or(rest.len());
        self.at += end;
        String::from_utf8(rest[..end].to_vec()).unwrap()
    }

    fn primary(&mut self) -> Option<Rational> {
        if self.take(b'(') {
            let inner = self.sum();
            assert!(inner.is_none() || self.take(b')'));
            return inner;
        }
        let word = self.word();
        assert!(!word.is_empty(), "{} at {}", String::from_utf8_lossy(self.text), self.at);
        if word == "abs" {
            return self.primary().map(|x| x.abs());
        }
        Some(if word.starts_with(|c: char| c.is_ascii_digit()) { word.parse().unwrap() } else { (self.value)(&word) })
    }
}

// ---------------------------------------------------------------- points

/// A number that is the same as a fraction and in floating point.
fn short(value: f64) -> Rational {
    Rational::new((value * f64::from(1 << 20)).round() as i64, 1 << 20)
}

/// Arguments of one call.
struct Point {
    formula: usize,
    arguments: Vec<f64>,
    kind: Kind,
}

enum Kind {
    /// Exact arguments, and all results where the formula holds.
    Exact(Vec<Rational>, Option<Vec<Rational>>),
    /// Not a number, or infinite.
    NotFinite,
    /// So large or small that either answer is right, if it is finite.
    Large,
}

impl Point {
    /// All results, where the formula holds.
    fn expected(&self) -> Option<Vec<f64>> {
        match &self.kind {
            Kind::Exact(_, Some(results)) => Some(results.iter().map(Rational::to_f64).collect()),
            _ => None,
        }
    }
}

/// A formula with the names of what it takes and gives.
struct Function {
    sheet: usize,
    formula: ClosedFormula,
    /// Those that must be given first, as in emitted code.
    arguments: Vec<String>,
    own: Vec<Rational>,
    given: usize,
    /// Name and text.
    results: Vec<(String, String)>,
    conditions: Vec<String>,
    /// Whether emitted code counts the equilibria.
    counts: bool,
}

impl Function {
    fn new(sheet: usize, f: &ClosedFormula) -> Self {
        let mut arguments: Vec<_> = f.arguments.iter().collect();
        arguments.sort_by_key(|a| a.fixed);
        Self {
            sheet,
            formula: f.clone(),
            own: arguments.iter().map(|a| a.exact.clone()).collect(),
            given: arguments.iter().filter(|a| !a.fixed).count(),
            arguments: arguments.iter().map(|a| a.name.clone()).collect(),
            results: f.results(Notation::Text, true).into_iter().map(|(name, text, _)| (name, text)).collect(),
            conditions: f.conditions(Notation::Text).into_iter().map(|(text, _)| text).collect(),
            counts: f.ratios(Notation::Text).is_none(),
        }
    }

    fn is(&self, k: usize, letters: &str) -> bool {
        self.arguments[k].starts_with(letters)
    }

    fn evaluate(&self, at: &[Rational]) -> Option<Rational> {
        let of = |name: &str| self.arguments.iter().position(|a| a == name).map(|k| at[k].clone());
        self.formula.evaluate(&of).ok()
    }

    /// All results where the formula holds, and the worst cancellation on the way to them.
    fn exact(&self, at: &[Rational]) -> (Option<Vec<Rational>>, f64) {
        let mut known: HashMap<String, Rational> = self.arguments.iter().cloned().zip(at.iter().cloned()).collect();
        let mut left = 1.0_f64;
        let mut see = |text: &str, known: &HashMap<String, Rational>| {
            let (value, least) = exact(text, &|name| known[name].clone());
            left = left.min(least);
            value
        };
        // Dependent speeds and torques first, for the others need them.
        let mut complete = true;
        for (name, text) in self.results.iter().filter(|(name, _)| name.starts_with(['T', 'w'])) {
            let Some(value) = see(text, &known) else {
                complete = false;
                break;
            };
            known.insert(name.clone(), value);
        }
        let holds = complete && self.conditions.iter().all(|c| see(c, &known).is_some_and(|v| v.sign() > 0));
        let mut results = || self.results.iter().map(|(_, text)| see(text, &known)).collect::<Option<Vec<_>>>();
        let results = if holds { results() } else { None };
        let truth = self.evaluate(at);
        // What is printed is what the library evaluates.
        if let Some(efficiency) = &truth {
            assert!(holds, "{}: the printed conditions fail at {at:?}", self.formula.name);
            if let Some(printed) = &results {
                assert_eq!(printed[0], *efficiency, "{}: the printed efficiency", self.formula.name);
            }
        }
        (truth.and(results), left)
    }
}

/// Points near the own values of each formula, all inside its regime.
const INSIDE: usize = 12;

/// Points of all kinds for a formula. Sums that all but cancel are left out: there floating point
/// has neither the digits nor the sign.
fn points(k: usize, f: &Function, noise: &mut Dice) -> Vec<Point> {
    let n = f.arguments.len();
    let mut all: Vec<Point> = Vec::new();
    let floats = |at: &[Rational]| at.iter().map(Rational::to_f64).collect::<Vec<f64>>();
    let add = |all: &mut Vec<Point>, at: &[Rational]| -> bool {
        let (results, left) = f.exact(at);
        if left < 1e-3 {
            return false;
        }
        let inside = results.is_some();
        all.push(Point { formula: k, arguments: floats(at), kind: Kind::Exact(at.to_vec(), results) });
        inside
    };
    assert!(add(&mut all, &f.own), "{}: not inside at its own values", f.formula.name);
    if n == 0 {
        return all;
    }
    // Near its own values.
    let mut inside: Vec<Vec<Rational>> = Vec::new();
    for attempt in 0..4000 {
        let scale = [0.2, 0.1, 0.03, 0.01][attempt % 4];
        let at: Vec<Rational> = (0..n)
            .map(|a| {
                let own = f.own[a].to_f64();
                let near = own * (1.0 + scale * noise.unit());
                short(if f.is(a, "eta") { near.min(1.0) } else { near })
            })
            .collect();
        if add(&mut all, &at) {
            inside.push(at);
        }
        if inside.len() == INSIDE {
            break;
        }
    }
    assert_eq!(inside.len(), INSIDE, "{}: too few points inside", f.formula.name);
    // Anywhere.
    for _ in 0..20 {
        let at: Vec<Rational> = (0..n)
            .map(|a| short(if f.is(a, "eta") { 0.55 + 0.5 * noise.unit() } else { 8.0 * noise.unit() }))
            .collect();
        add(&mut all, &at);
    }
    // On boundaries and poles: numbers so short that sums are exactly zero.
    for _ in 0..30 {
        let near = noise.of(&[true, false]);
        let at: Vec<Rational> = (0..n)
            .map(|a| {
                let value = match f.is(a, "eta") {
                    true => noise.of(&[0.5, 0.5, 1.0, 1.0, 1.0, 0.25, 0.0, 1.5, -0.5]),
                    false => noise.of(&[0.0, 0.5, 1.0, 2.0, 4.0, -0.5, -1.0, -2.0]),
                };
                if near && noise.of(&[true, true, false]) { inside[0][a].clone() } else { short(value) }
            })
            .collect();
        add(&mut all, &at);
    }
    // One argument after the other without sense.
    for a in 0..n {
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut arguments = floats(&inside[a % INSIDE]);
            arguments[a] = wrong;
            all.push(Point { formula: k, arguments, kind: Kind::NotFinite });
        }
        let wrong: &[f64] = match f.arguments[a].as_bytes()[0] {
            b'e' => &[0.0, -0.5, 1.0 + 1.0 / 1024.0],
            b'z' => &[0.0, -30.0],
            b'i' => &[0.0],
            _ => &[],
        };
        for wrong in wrong {
            let mut at = inside[a % INSIDE].clone();
            at[a] = short(*wrong);
            assert!(!add(&mut all, &at), "{} with {} = {wrong}", f.formula.name, f.arguments[a]);
        }
        for factor in [1e300, -1e300, 1e-320] {
            let mut arguments = floats(&inside[a % INSIDE]);
            arguments[a] *= factor;
            all.push(Point { formula: k, arguments, kind: Kind::Large });
        }
    }
    all
}

// ---------------------------------------------------------------- languages

/// A folder that goes when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        let path = std::env::temp_dir().join(format!("willis-emitted-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, text).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Runs a program with text as its input; it must be there and succeed.
fn run(command: &mut Command, input: &str) -> String {
    let program = command.get_program().to_string_lossy().into_owned();
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap_or_else(|e| panic!("this test needs `{program}`, which cannot be started: {e}"));
    let mut pipe = child.stdin.take().unwrap();
    let text = input.to_owned();
    let feeder = std::thread::spawn(move || {
        let _ = pipe.write_all(text.as_bytes());
    });
    let output = child.wait_with_output().unwrap();
    feeder.join().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{program}: {}\n{}", output.status, said.chars().take(4000).collect::<String>());
    String::from_utf8(output.stdout).unwrap()
}

/// A line for each point: the number of the function and its arguments.
fn input<'p>(points: impl IntoIterator<Item = &'p Point>) -> String {
    let mut text = String::new();
    for p in points {
        let _ = write!(text, "{}", p.formula);
        text.extend(p.arguments.iter().map(|a| format!(" {a:?}")));
        text.push('\n');
    }
    text
}

/// How many formulas of a state hold at a point of one of them; each is an equilibrium. What another takes beside the
/// arguments of the point is the train's.
fn equilibria(functions: &[Function], p: &Point) -> usize {
    let f = &functions[p.formula];
    let Kind::Exact(at, _) = &p.kind else { unreachable!("only those are compared") };
    let alike = |g: &&Function| g.sheet == f.sheet && g.formula.state == f.formula.state;
    let holds = |g: &&Function| {
        let of = |name: &str| {
            let given = f.arguments.iter().position(|a| a == name).map(|k| at[k].clone());
            given.or_else(|| g.arguments.iter().position(|a| a == name).map(|k| g.own[k].clone()))
        };
        g.formula.evaluate(&of).is_ok()
    };
    functions.iter().filter(alike).filter(holds).count()
}

/// Compares what a program answered, a line for each point, with what is right.
fn compare(language: &str, functions: &[Function], points: &[&Point], answers: &str) -> [usize; 2] {
    let mut counts = [0; 2];
    let answers: Vec<&str> = answers.lines().collect();
    assert_eq!(answers.len(), points.len(), "{language}: answers");
    for (p, answer) in points.iter().zip(answers) {
        let f = &functions[p.formula];
        let place = || format!("{language}: {}{:?} answers {answer}", f.formula.name, p.arguments);
        let expected = p.expected();
        if answer.starts_with("refused") {
            assert!(expected.is_none(), "{} instead of {expected:?}", place());
            counts[1] += 1;
            continue;
        }
        let mut got: Vec<f64> =
            answer.split(' ').map(|x| x.parse().unwrap_or_else(|_| panic!("{}", place()))).collect();
        assert_eq!(got.len(), f.results.len() + usize::from(f.counts), "{}", place());
        let counted = if f.counts { got.pop() } else { None };
        if matches!(p.kind, Kind::Large) {
            assert!(got.iter().all(|x| x.is_finite()), "{}", place());
            continue;
        }
        let Some(expected) = expected else { panic!("{} where it does not hold", place()) };
        for (k, (got, right)) in got.iter().zip(&expected).enumerate() {
            let close = (got - right).abs() <= 1e-12 * right.abs();
            assert!(close, "{}: {} = {got}, not {right}", place(), f.results[k].0);
        }
        if let Some(counted) = counted {
            assert_eq!(counted, equilibria(functions, p) as f64, "{}: equilibria", place());
        }
        counts[0] += 1;
    }
    counts
}

fn python(folder: &Folder, sheets: &[FormulaSheet], functions: &[Function], points: &[Point]) -> [usize; 2] {
    let mut driver = String::from("import sys\n");
    for (k, sheet) in sheets.iter().enumerate() {
        folder.write(&format!("sheet{k}.py"), &sheet.emit(Notation::Python, true));
        let _ = writeln!(driver, "import sheet{k}");
    }
    driver += "functions = [\n";
    for f in functions {
        let mut keys: Vec<String> = f.results.iter().map(|(name, _)| format!("{name:?}")).collect();
        keys.extend(f.counts.then(|| "\"equilibria\"".to_owned()));
        let _ = writeln!(driver, "    (sheet{0}, sheet{0}.{1}, [{2}]),", f.sheet, f.formula.name, keys.join(", "));
    }
    driver += r#"]
for line in sys.stdin:
    number, *arguments = line.split()
    module, function, keys = functions[int(number)]
    try:
        results = function(*map(float, arguments))
    except module.OutsideRegime as why:
        print("refused", repr(str(why)))
    else:
        assert list(results) == keys, (results, keys)
        print(*[repr(float(results[key])) for key in keys])
"#;
    let main = folder.write("main.py", &driver);
    // And once without what the train fixes.
    let short: Vec<Point> = functions
        .iter()
        .enumerate()
        .map(|(k, f)| {
            let own = points.iter().find(|p| p.formula == k).unwrap();
            let Kind::Exact(at, results) = &own.kind else { unreachable!("the first point is the train's own") };
            let kind = Kind::Exact(at.clone(), results.clone());
            Point { formula: k, arguments: own.arguments[..f.given].to_vec(), kind }
        })
        .collect();
    let all: Vec<&Point> = points.iter().chain(&short).collect();
    let answers = run(Command::new("python3").args(["-B", "-W", "error"]).arg(main), &input(all.iter().copied()));
    compare("Python", functions, &all, &answers)
}

fn c(folder: &Folder, sheets: &[FormulaSheet], functions: &[Function], points: &[Point]) -> [usize; 2] {
    // All sheets in one file, as if pasted.
    let mut text: String = sheets.iter().map(|s| s.emit(Notation::C, true) + "\n").collect();
    text += r#"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(void)
{
    static char line[4096];
    while (fgets(line, sizeof line, stdin)) {
        double a[64];
        char *at = line;
        const long number = strtol(at, &at, 10);
        for (int k = 0; k < 64; k++) a[k] = strtod(at, &at);
        switch (number) {
"#;
    for (k, f) in functions.iter().enumerate() {
        let name = &f.formula.name;
        let arguments: String = (0..f.arguments.len()).map(|a| format!("a[{a}], ")).collect();
        let mut fields: Vec<String> = f.results.iter().map(|(field, _)| format!("r.{field}")).collect();
        fields.extend(f.counts.then(|| "(double)r.equilibria".to_owned()));
        let _ = writeln!(
            text,
            "        case {k}: {{\n            struct {name} r, before;\n            memset(&r, 90, sizeof r);\n            \
             before = r;\n            const int status = {name}({arguments}&r);\n            if (status == 0) \
             printf(\"{}\\n\", {});\n            else if (memcmp(&r, &before, sizeof r) == 0) printf(\"refused %d\\n\", \
             status);\n            else return 3;\n            break;\n        }}",
            vec!["%.17g"; fields.len()].join(" "),
            fields.join(", ")
        );
    }
    text += "        default: return 2;\n        }\n    }\n    return 0;\n}\n";
    let source = folder.write("main.c", &text);
    let program = folder.0.join("c-program");
    let flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off", "-o"];
    run(Command::new("cc").args(flags).arg(&program).arg(source).arg("-lm"), "");
    let all: Vec<&Point> = points.iter().collect();
    compare("C", functions, &all, &run(&mut Command::new(program), &input(points)))
}

fn rust(folder: &Folder, sheets: &[FormulaSheet], functions: &[Function], points: &[Point]) -> [usize; 2] {
    let mut text = String::new();
    for (k, sheet) in sheets.iter().enumerate() {
        let _ = writeln!(text, "mod sheet{k} {{\n{}\n}}", sheet.emit(Notation::Rust, true));
    }
    text += "fn main() {\n    for line in std::io::stdin().lines() {\n        let line = line.unwrap();\n        let mut \
             words = line.split(' ');\n        let number: usize = words.next().unwrap().parse().unwrap();\n        let a: \
             Vec<f64> = words.map(|w| w.parse().unwrap()).collect();\n        match number {\n";
    for (k, f) in functions.iter().enumerate() {
        let arguments: Vec<String> = (0..f.arguments.len()).map(|a| format!("a[{a}]")).collect();
        let mut fields: Vec<String> = f.results.iter().map(|(field, _)| format!("r.{field}")).collect();
        fields.extend(f.counts.then(|| "r.equilibria".to_owned()));
        let _ = writeln!(
            text,
            "            {k} => match sheet{}::{}({}) {{\n                Ok(r) => println!(\"{}\", {}),\n                \
             Err(e) => println!(\"refused {{}}\", e.0),\n            }},",
            f.sheet,
            f.formula.name,
            arguments.join(", "),
            vec!["{:?}"; fields.len()].join(" "),
            fields.join(", ")
        );
    }
    text += "            _ => unreachable!(),\n        }\n    }\n}\n";
    let source = folder.write("main.rs", &text);
    let program = folder.0.join("rust-program");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    run(Command::new(rustc).args(["--edition", "2024", "-D", "warnings", "-o"]).arg(&program).arg(source), "");
    let all: Vec<&Point> = points.iter().collect();
    compare("Rust", functions, &all, &run(&mut Command::new(program), &input(points)))
}

// ---------------------------------------------------------------- Modelica

/// Interprets an emitted function: its inputs, assertions and assignments.
struct Modelica {
    name: String,
    inputs: Vec<String>,
    outputs: Vec<String>,
    lines: Vec<String>,
}

impl Modelica {
    fn read(source: &str) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for line in source.lines().filter(|l| !l.is_empty() && !l.starts_with("//")) {
            if let Some(rest) = line.strip_prefix("function ") {
                let name = rest.split(' ').next().unwrap().to_owned();
                all.push(Self { name, inputs: vec![], outputs: vec![], lines: vec![] });
                continue;
            }
            let f = all.last_mut().expect("a function");
            let word = |rest: &str| rest.split(' ').next().unwrap().to_owned();
            if let Some(rest) = line.strip_prefix("  input Real ") {
                f.inputs.push(word(rest));
            } else if let Some(rest) = line.strip_prefix("  output Real ") {
                f.outputs.push(word(rest));
            } else if let Some(rest) = line.strip_prefix("end ") {
                assert_eq!(rest, format!("{};", f.name));
            } else if line.strip_prefix("  Real ").is_none() && !["algorithm", "protected"].contains(&line) {
                f.lines.push(line.trim().to_owned());
            }
        }
        all
    }

    /// `beside` are the functions of the file that it may call.
    fn call(&self, at: &[Rational], beside: &[&Self]) -> Option<Vec<Rational>> {
        let mut known: HashMap<&str, Rational> =
            self.inputs.iter().map(String::as_str).zip(at.iter().cloned()).collect();
        for line in &self.lines {
            if let Some(rest) = line.strip_prefix("assert(") {
                let (condition, _) = rest.split_once(", \"").unwrap();
                for part in condition.split(" and ") {
                    let words: Vec<&str> = part.rsplitn(3, ' ').collect();
                    let left = exact(words[2], &|n| known[n].clone()).0?;
                    let right: Rational =
                        if words[0] == "1e300" { "1e60".parse().unwrap() } else { words[0].parse().unwrap() };
                    let holds = match words[1] {
                        ">" => left > right,
                        "<" => left < right,
                        "<=" => left <= right,
                        other => panic!("{other}"),
                    };
                    if !holds {
                        return None;
                    }
                }
            } else {
                let (name, expression) = line.strip_suffix(';').unwrap().split_once(" := ").unwrap();
                let of = |text: &str| exact(text, &|n| known[n].clone()).0;
                let called = beside.iter().find(|m| expression.starts_with(&format!("{}(", m.name)));
                let value = if let Some(m) = called {
                    let arguments = &expression[m.name.len() + 1..expression.len() - 1];
                    let at: Option<Vec<Rational>> = arguments.split(", ").map(of).collect();
                    m.call(&at?, &[])?.swap_remove(0)
                } else if let Some(condition) = expression.strip_prefix("if ") {
                    let condition = condition.strip_suffix(" then 1 else 0").expect("a truth as a number");
                    let holds = |part: &str| {
                        part == "true" || of(part.strip_suffix(" > 0").unwrap()).is_some_and(|v| v.sign() > 0)
                    };
                    Rational::from(i64::from(condition.split(" and ").all(holds)))
                } else {
                    of(expression)?
                };
                known.insert(name, value);
            }
        }
        Some(self.outputs.iter().map(|n| known[n.as_str()].clone()).collect())
    }
}

// ---------------------------------------------------------------- the tests

/// Every sheet, every function and its points; made once for all tests.
static ALL: LazyLock<(Vec<FormulaSheet>, Vec<Function>, Vec<Point>)> = LazyLock::new(|| {
    let sheets = sheets();
    let own = |(k, s): (usize, &FormulaSheet)| s.formulas.iter().map(|f| Function::new(k, f)).collect::<Vec<_>>();
    let functions: Vec<Function> = sheets.iter().enumerate().flat_map(own).collect();
    let mut noise = Dice(20260);
    let points = functions.iter().enumerate().flat_map(|(k, f)| points(k, f, &mut noise)).collect();
    (sheets, functions, points)
});

#[test]
fn code_answers_inside_and_refuses_outside() {
    let (sheets, functions, points) = &*ALL;
    for (k, f) in functions.iter().enumerate().filter(|(_, f)| !f.arguments.is_empty()) {
        let own = || points.iter().filter(|p| p.formula == k && !matches!(p.kind, Kind::Large));
        let inside = own().filter(|p| p.expected().is_some()).count();
        let outside = own().count() - inside;
        assert!(inside > INSIDE && outside > 3, "{}: {inside} points inside, {outside} outside", f.formula.name);
    }
    let folder = Folder::new();
    for (language, [inside, outside]) in [
        ("Python", python(&folder, sheets, functions, points)),
        ("C", c(&folder, sheets, functions, points)),
        ("Rust", rust(&folder, sheets, functions, points)),
    ] {
        println!("{language}: {} functions, {inside} answers, {outside} refusals", functions.len());
    }
}

#[test]
fn modelica_is_read_by_a_parser_and_answers_the_same() {
    let (sheets, functions, points) = &*ALL;
    let mut read: Vec<Modelica> = Vec::new();
    for sheet in sheets {
        let source = sheet.emit(Notation::Modelica, true);
        let parsed = moparse::parse(&sheet.train, &source, moparse::SyntaxKind::StoredDefinition);
        assert!(parsed.errors.is_empty(), "{:?}\n{source}", parsed.errors);
        read.extend(Modelica::read(&source));
    }
    let (read, beside): (Vec<Modelica>, Vec<Modelica>) =
        read.into_iter().partition(|m| functions.iter().any(|f| f.formula.name == m.name));
    let beside: Vec<&Modelica> = beside.iter().collect();
    assert_eq!(read.len(), functions.len());
    let count = "equilibria".to_owned();
    for (m, f) in read.iter().zip(functions) {
        assert_eq!((&m.name, &m.inputs), (&f.formula.name, &f.arguments));
        let results = f.results.iter().map(|(name, _)| name).chain(f.counts.then_some(&count));
        assert!(m.outputs.iter().eq(results), "{:?}", m.outputs);
    }
    let (mut counts, mut several) = ([0, 0], 0);
    for p in points {
        let Kind::Exact(at, results) = &p.kind else { continue };
        let m = &read[p.formula];
        let mut answer = m.call(at, &beside);
        if let Some(all) = answer.as_mut().filter(|_| functions[p.formula].counts) {
            let counted = all.pop().expect("the last result");
            let expected = Rational::from(equilibria(functions, p) as i64);
            assert_eq!(counted, expected, "{}{at:?}: equilibria", m.name);
            several += usize::from(counted > Rational::ONE);
        }
        assert_eq!(answer, *results, "{}{at:?}", m.name);
        counts[usize::from(results.is_none())] += 1;
    }
    assert!(several > 10, "{several} points with several equilibria");
    println!("Modelica: {} functions, {} answers, {} refusals", functions.len(), counts[0], counts[1]);
}

#[test]
fn the_parser_of_modelica_is_a_strict_one() {
    let errors = |text: &str| moparse::parse("", text, moparse::SyntaxKind::StoredDefinition).errors.len();
    let good = "function f \"it's\"\n  input Real x = -1/2 \"x\";\n  output Real y;\nalgorithm\n  assert(x > 0, \"x\");\n  y := -x^2/(1 - x);\nend f;\n";
    assert_eq!(errors(good), 0);
    for (from, to) in [("f ", "1f "), ("x)", "x"), ("-x^2", "*x^2"), ("input Real x", "input Real end"), ("it's", "\"")]
    {
        assert_ne!(errors(&good.replacen(from, to, 1)), 0, "{from} as {to}");
    }
}

/// Derivatives against difference quotients, powers against the efficiency; all exact.
#[test]
fn results_agree_with_each_other() {
    let (_, functions, _) = &*ALL;
    let h = Rational::new(1, 1 << 26);
    let mut derivatives = 0;
    for f in functions {
        let at: Vec<Rational> = (0..f.own.len())
            .map(|k| if f.is(k, "eta") { &f.own[k] * &Rational::new(999, 1000) } else { f.own[k].clone() })
            .collect();
        let results = f.exact(&at).0.unwrap_or_else(|| panic!("{} at its own values", f.formula.name));
        let value = |name: &str| {
            let result = f.results.iter().position(|(n, _)| n == name).map(|k| &results[k]);
            result.or_else(|| f.arguments.iter().position(|a| a == name).map(|k| &at[k])).unwrap()
        };
        let efficiency = value("efficiency");
        // Output over input power.
        if f.formula.ratios(Notation::Text).is_some() {
            assert_eq!(value("torque_ratio") / value("speed_ratio"), -efficiency.clone(), "{}", f.formula.name);
        } else {
            let names = f.arguments.iter().chain(f.results.iter().map(|(name, _)| name));
            let powers: Vec<Rational> = names
                .filter_map(|n| n.strip_prefix("T_"))
                // Terminals that are linked within the train are neither.
                .filter(|m| {
                    f.formula.name.starts_with("idle_battery").then_some(*m).is_none_or(|m| !m.starts_with("mg"))
                })
                .map(|m| value(&format!("T_{m}")) * value(&format!("w_{m}")))
                .collect();
            assert!(powers.len() > 1, "{}", f.formula.name);
            let sum = |sign: i8| powers.iter().filter(|p| p.sign() == sign).fold(Rational::ZERO, |sum, p| sum + p);
            assert_eq!(sum(-1), -(efficiency * &sum(1)), "{}", f.formula.name);
        }
        for (k, name) in f.arguments.iter().enumerate().filter(|(k, _)| f.is(*k, "eta")) {
            let beside = |step: Rational| {
                let mut at = at.clone();
                at[k] = &at[k] + &step;
                f.evaluate(&at).unwrap_or_else(|| panic!("{} beside its own {name}", f.formula.name))
            };
            let slope = ((beside(h.clone()) - beside(-h.clone())) / (&h + &h)).to_f64();
            let given = value(&format!("d_efficiency_d_{name}")).to_f64();
            assert!(
                (slope - given).abs() <= 1e-9 * (1.0 + given.abs()),
                "{} by {name}: {given}, {slope}",
                f.formula.name
            );
            derivatives += 1;
        }
        // The library's own list, at the values of the train.
        let own = f.exact(&f.own).0.unwrap();
        for d in f.formula.derivatives() {
            let k = f.results.iter().position(|(n, _)| *n == format!("d_efficiency_d_{}", d.of)).unwrap();
            assert_eq!((&d.formula, d.value), (&f.results[k].1, own[k].to_f64()), "{} by {}", f.formula.name, d.of);
        }
    }
    assert!(derivatives > 100, "{derivatives}");
}

/// No two names of a sheet are the same, be it in the spelling of Rust's types.
#[test]
fn names_are_short_and_apart() {
    let reserved = ["class", "fn", "for", "end", "def", "struct", "return", "int", "model", "result", "math"];
    for sheet in &ALL.0 {
        let mut names: Vec<String> = sheet.formulas.iter().map(|f| f.name.replace('_', "")).collect();
        names.sort();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
        for f in &sheet.formulas {
            let code = |name: &str| {
                let mut c = name.chars();
                c.next().is_some_and(|c| c.is_ascii_alphabetic())
                    && c.all(|c| c.is_ascii_alphanumeric() || c == '_')
                    && !reserved.contains(&name)
            };
            assert!(code(&f.name) && !f.name.contains("__") && f.name.len() < 100, "{}", f.name);
            let results = f.results(Notation::Text, true);
            let mut own: Vec<&str> =
                f.arguments.iter().map(|a| a.name.as_str()).chain(results.iter().map(|(n, _, _)| n.as_str())).collect();
            assert!(own.iter().all(|name| code(name)), "{own:?}");
            own.sort_unstable();
            assert!(own.windows(2).all(|pair| pair[0] != pair[1]), "{own:?}");
        }
    }
    let prius = sheet(&example("prius-p112.toml"), &FormulaRequest::default());
    assert_eq!(prius.formulas[0].name, "toyota_prius_p112_power_f1");
    let states = sheet(HOSTILE, &FormulaRequest::default());
    let names: Vec<&str> = states.formulas.iter().map(|f| f.name.as_str()).filter(|n| n.contains("state")).collect();
    let begin = "train_3_coding_latin_1_x_n_x_state";
    let ends = ["1_2_a_b_to_ring", "12_a_b_to_ring_2", "s_a_b_to_ring", "s_a_b_to_ring_2"];
    assert_eq!(names, ends.map(|end| format!("{begin}_{end}")));
}
