//! Exported equations, evaluated: the accelerations that they give are those of `simulate`, row by row.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use willis::analysis::{Direction, Selection, Verdict, analyze};
use willis::dynamics::{Column, Event, Options, Recorder, Sample, simulate};
use willis::model::Model;
use willis::study::export::{ExportRequest, export};

use crate::common::{example, examples};

type Values = BTreeMap<String, f64>;

/// Two sets in a row, an elastic shaft, drags, a planet with an inertia: three independent speeds.
const PAIR: &str = r#"
format = 1
name = "pair"
members = ["motor", "middle", "side", "out", "load"]
terminals = ["motor", "side", "load"]
inertias = { motor = "0.002 kg m^2", side = "0.05 kg m^2", out = "0.02 kg m^2", load = "0.4 kg m^2" }
[[set]]
name = "P1"
sun = { member = "motor", teeth = 20 }
planet = { teeth = 30, count = 4, mass = "0.2 kg", inertia = "1e-4 kg m^2", orbit_radius = "50 mm" }
ring = { member = "frame", teeth = 80 }
carrier = "middle"
mesh_efficiency = 0.97
[[set]]
name = "P2"
sun = { member = "middle", teeth = 30 }
planet = { teeth = 21, count = 3 }
ring = { member = "side", teeth = 72 }
carrier = "out"
mesh_efficiency = { forward = 0.98, backward = 0.96 }
[[shaft]]
name = "half shaft"
members = ["out", "load"]
stiffness = "400 N m/rad"
damping = "3 N m s/rad"
[[drag]]
name = "seal"
members = ["motor", "frame"]
coulomb = "0.1 N m"
viscous = "0.002 N m s/rad"
[[scenario]]
name = "swing"
duration = "1 s"
initial_speeds = { motor = "60 rad/s", side = "5 rad/s", load = "5 rad/s" }
[[scenario.source]]
name = "drive"
member = "motor"
torque = { type = "step", offset = "4 N m", height = "-7 N m", at = "0.5 s" }
[[scenario.source]]
name = "hand"
member = "side"
torque = { type = "step", offset = "6 N m", height = "-9 N m", at = "0.7 s" }
[[scenario.source]]
name = "work"
member = "load"
torque = "-10 N m"
"#;

/// An expression of Modelica, evaluated as it is read: sums, products, powers, `if`, `max`, `min`, `abs`, `der`.
struct Reader<'a> {
    rest: &'a str,
    values: &'a Values,
}

impl Reader<'_> {
    fn value(text: &str, values: &Values) -> f64 {
        let mut own = Reader { rest: text, values };
        let x = own.choice();
        assert!(own.rest.trim().is_empty(), "`{}` is left of `{text}`", own.rest);
        x
    }

    fn takes(&mut self, word: &str) -> bool {
        let rest = self.rest.trim_start();
        let is_word = word.chars().all(char::is_alphabetic);
        match rest.strip_prefix(word) {
            Some(after) if !is_word || !after.starts_with(|c: char| c.is_alphanumeric() || c == '_') => {
                self.rest = after;
                true
            }
            _ => false,
        }
    }

    fn choice(&mut self) -> f64 {
        if !self.takes("if") {
            return self.sum();
        }
        let a = self.sum();
        let at_least = self.takes(">=");
        assert!(at_least || self.takes("<"), "no relation at `{}`", self.rest);
        let b = self.sum();
        let holds = if at_least { a >= b } else { a < b };
        assert!(self.takes("then"));
        let yes = self.choice();
        assert!(self.takes("else"));
        let no = self.choice();
        if holds { yes } else { no }
    }

    fn sum(&mut self) -> f64 {
        let mut x = if self.takes("-") { -self.product() } else { self.product() };
        loop {
            match () {
                () if self.takes("+") => x += self.product(),
                () if self.takes("-") => x -= self.product(),
                () => return x,
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut x = self.power();
        loop {
            match () {
                () if self.takes("*") => x *= self.power(),
                () if self.takes("/") => x /= self.power(),
                () => return x,
            }
        }
    }

    fn power(&mut self) -> f64 {
        let x = self.atom();
        if self.takes("^") { x.powf(self.atom()) } else { x }
    }

    fn atom(&mut self) -> f64 {
        if self.takes("(") {
            let x = self.choice();
            assert!(self.takes(")"), "no bracket at `{}`", self.rest);
            return x;
        }
        let rest = self.rest.trim_start();
        let is_number = rest.starts_with(|c: char| c.is_ascii_digit());
        let mut end = 0;
        for (k, c) in rest.char_indices() {
            let exponent = is_number && "+-".contains(c) && rest[..k].ends_with('e');
            if !(c.is_ascii_alphanumeric() || c == '_' || c == '.' || exponent) {
                break;
            }
            end = k + 1;
        }
        let (word, after) = rest.split_at(end);
        self.rest = after;
        if is_number {
            return word.parse().unwrap_or_else(|_| panic!("`{word}` is no number"));
        }
        if ["max", "min", "abs", "der"].contains(&word) && self.takes("(") {
            if word == "der" {
                let (name, after) = self.rest.split_once(')').expect("a bracket");
                self.rest = after;
                return self.values[&format!("der({name})")];
            }
            let a = self.choice();
            let b = if self.takes(",") { self.choice() } else { 0.0 };
            assert!(self.takes(")"));
            return match word {
                "max" => a.max(b),
                "min" => a.min(b),
                _ => a.abs(),
            };
        }
        *self.values.get(word).unwrap_or_else(|| panic!("nothing is called `{word}`"))
    }
}

/// A model that was read: what is given, and its equations.
struct Equations {
    parameters: Values,
    without_value: Vec<String>,
    inputs: Vec<String>,
    states: Vec<String>,
    equations: Vec<(String, String)>,
}

impl Equations {
    fn read(text: &str) -> Self {
        let read = moparse::parse("gear", text, moparse::SyntaxKind::StoredDefinition);
        assert!(read.errors.is_empty(), "{:?}\n{text}", read.errors);
        assert!(!text.contains("Modelica."), "a library is needed:\n{text}");
        let (top, rest) = text.split_once("\nequation\n").expect("equations");
        let mut own = Self {
            parameters: Values::new(),
            without_value: vec![],
            inputs: vec![],
            states: vec![],
            equations: vec![],
        };
        for line in top.lines().map(str::trim).filter(|l| l.ends_with("\";")) {
            let (head, _) = line.split_once(" \"").expect("a comment of its own");
            let name = head.split(" Real ").last().unwrap().trim_start_matches("Real ").split('(').next().unwrap();
            match head.split_once(") = ") {
                _ if head.starts_with("input ") => own.inputs.push(name.to_owned()),
                Some((_, value)) if head.starts_with("parameter ") => {
                    let value = Reader::value(value, &Values::new());
                    own.parameters.insert(name.to_owned(), value);
                }
                _ if head.starts_with("parameter ") => own.without_value.push(name.to_owned()),
                _ if head.contains("fixed=true") => own.states.push(name.to_owned()),
                _ => {}
            }
        }
        let (body, _) = rest.rsplit_once("end ").expect("an end");
        for equation in body.split(';').map(str::trim).filter(|e| !e.is_empty()) {
            let (left, right) = equation.split_once(" = ").unwrap_or_else(|| panic!("no equation: {equation}"));
            own.equations.push((left.to_owned(), right.to_owned()));
        }
        own
    }

    /// Everything that follows from states and inputs, if Newton's method finds it. Unknown are the rates of the speeds and one torque a mesh; what
    /// is left of the equations is linear in them while the same ends drive, so Newton's method ends after few rounds.
    fn solved(&self, given: &Values) -> Option<Values> {
        let unknown: Vec<String> =
            (self.states.iter().filter(|s| s.starts_with("speed_")).map(|s| format!("der({s})")))
                .chain(self.equations.iter().filter_map(|(left, _)| Some(format!("p_{}", left.strip_prefix("q_")?))))
                .collect();
        let at = |x: &[f64]| -> (Values, Vec<f64>) {
            let mut values: Values = self.parameters.iter().chain(given).map(|(k, v)| (k.clone(), *v)).collect();
            values.extend(unknown.iter().cloned().zip(x.iter().copied()));
            let mut left_over = vec![];
            for (left, right) in &self.equations {
                let value = Reader::value(right, &values);
                let is_name = left.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && left != "0";
                match is_name || left.starts_with("der(twist_") {
                    true => drop(values.insert(left.clone(), value)),
                    false => left_over.push(Reader::value(left, &values) - value),
                }
            }
            (values, left_over)
        };
        let n = unknown.len();
        let mut x = vec![0.0; n];
        for _ in 0..40 {
            let (values, left_over) = at(&x);
            assert_eq!(left_over.len(), n, "as many equations as unknowns");
            let most = x.iter().fold(1.0f64, |most, x| most.max(x.abs()));
            if left_over.iter().all(|r| r.abs() < 1e-10 * most) {
                return Some(values);
            }
            let mut rows: Vec<Vec<f64>> = left_over.iter().map(|r| vec![-r]).collect();
            for k in (0..n).rev() {
                let mut there = x.clone();
                // A small step does not change which end drives.
                let h = 1e-6 * most;
                there[k] += h;
                for (row, (new, old)) in rows.iter_mut().zip(at(&there).1.iter().zip(&left_over)) {
                    row.insert(0, (new - old) / h);
                }
            }
            let step = gauss(rows)?;
            x.iter_mut().zip(step).for_each(|(x, d)| *x += d);
        }
        None
    }
}

/// Solves a system whose last column is its right side; none where it is singular.
fn gauss(mut a: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = a.len();
    for k in 0..n {
        let best = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, best);
        if a[k][k] == 0.0 {
            return None;
        }
        for i in (0..n).filter(|i| *i != k) {
            let factor = a[i][k] / a[k][k];
            let pivot = a[k].clone();
            a[i].iter_mut().zip(pivot).for_each(|(x, p)| *x -= factor * p);
        }
    }
    Some((0..n).map(|k| a[k][n] / a[k][k]).collect())
}

#[derive(Default)]
struct Rows {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
    events: Vec<f64>,
}

impl Recorder for Rows {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        self.names = columns.iter().map(|c| c.name.clone()).collect();
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        self.rows.push(sample.values.to_vec());
        ControlFlow::Continue(())
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.events.push(event.time_s);
        ControlFlow::Continue(())
    }
}

fn made(model: &Model, request: &ExportRequest) -> String {
    export(model, "modelica-equations", request).unwrap_or_else(|e| panic!("{e}")).files[0].text.clone()
}

/// How many rows of a scenario were compared. `sources`: the member on which each source acts.
fn compared(model: &Model, scenario: &str, sources: &[(&str, &str)]) -> usize {
    let own = Equations::read(&made(model, &ExportRequest::default()));
    assert_eq!(own.without_value, Vec::<String>::new());
    let mut rows = Rows::default();
    simulate(model.train(), scenario, &Options::default(), &mut rows).unwrap_or_else(|e| panic!("{e}"));
    let mut count = 0;
    for row in &rows.rows {
        let of = |name: &str| {
            let at = rows.names.iter().position(|n| n == name);
            row[at.unwrap_or_else(|| panic!("no column {name} in {:?}", rows.names))]
        };
        // Teeth and drags at rest, or nearly so, are what the equations do not have.
        let modes = rows.names.iter().zip(row).filter(|(name, _)| name.ends_with(".mode"));
        // At an event a speed is zero but for rounding, and with it the sign of a power.
        let is_event = rows.events.iter().any(|t| (t - row[0]).abs() < 1e-6);
        if is_event || modes.clone().any(|(_, mode)| *mode == 0.0) {
            continue;
        }
        let mut given = Values::new();
        for state in &own.states {
            let value = match state.strip_prefix("speed_") {
                Some(member) => of(&format!("{member}.speed_rad_s")),
                None => of(&format!("{}.twist_rad", state.trim_start_matches("twist_").replace('_', " "))),
            };
            given.insert(state.clone(), value);
        }
        for input in &own.inputs {
            let member = input.trim_start_matches("torque_");
            let acts = sources.iter().filter(|s| s.1 == member).map(|s| of(&format!("{}.torque_n_m", s.0)));
            given.insert(input.clone(), acts.sum());
        }
        let slow = own.parameters.get("slow").copied().unwrap_or(0.0);
        let solved = own.solved(&given).unwrap_or_else(|| panic!("{scenario}: no solution at {} s", row[0]));
        if solved.iter().any(|(name, slip)| name.starts_with("slip_") && slip.abs() < slow) {
            continue;
        }
        for state in own.states.iter().filter_map(|s| s.strip_prefix("speed_")) {
            let (found, wanted) = (solved[&format!("der(speed_{state})")], of(&format!("{state}.acceleration_rad_s2")));
            let close = (found - wanted).abs() <= 1e-6 * wanted.abs().max(1.0);
            assert!(close, "{scenario}: {state} at {} s: {found} is not {wanted}", row[0]);
        }
        let (loss, wanted) = (solved["loss"], of("loss_w"));
        assert!((loss - wanted).abs() <= 1e-6 * wanted.abs().max(1.0), "{scenario}: {loss} W is not {wanted} W");
        count += 1;
    }
    count
}

#[test]
fn accelerations_and_losses_are_those_of_simulate() {
    let pair = Model::from_toml(PAIR).unwrap();
    assert!(compared(&pair, "swing", &[("drive", "motor"), ("hand", "side"), ("work", "load")]) > 400);
    // Planets with inertias and bearings, efficiencies by mesh and direction, two independent speeds.
    let bearings = Model::from_toml(&example("galvagno-coast-down")).unwrap();
    assert!(compared(&bearings, "coast down", &[]) > 20);
}

/// Each state of every example: read by a parser of others, as many equations as unknowns, and a solution, or a reason.
#[test]
fn equations_of_every_example_have_a_solution() {
    let (mut states, mut simple, mut refused) = (0, 0, 0);
    for (name, text) in examples() {
        let model = Model::from_toml(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        let request = ExportRequest { all_states: true, ..ExportRequest::default() };
        let files = match export(&model, "modelica-equations", &request) {
            Ok(out) => out.files,
            Err(why) => {
                let why = why.to_string();
                let reasons = ["variator", "backlash", "loss table", "indeterminate", "nothing can move", "no inertia"];
                assert!(reasons.iter().any(|r| why.contains(r)), "{name}: {why}");
                refused += 1;
                continue;
            }
        };
        for file in files {
            let mut own = Equations::read(&file.text);
            for name in std::mem::take(&mut own.without_value) {
                own.parameters.insert(name, 0.1);
            }
            let given: Values = (own.inputs.iter().enumerate().map(|(k, name)| (name.clone(), 10.0 / (k + 1) as f64)))
                .chain(own.states.iter().enumerate().map(|(k, name)| (name.clone(), 50.0 / (k + 2) as f64)))
                .collect();
            let solved = own.solved(&given);
            assert!(solved.iter().flat_map(BTreeMap::values).all(|x| x.is_finite()), "{name}");
            // A train that friction locks one way, or that has several equilibria, may have none here.
            let is_simple = |way: &Direction| way.verdict == Verdict::Unique;
            let table = analyze(model.train(), &Selection { operation: None, state: None }).unwrap().ratios;
            if table.iter().all(|(_, row)| is_simple(&row.drive) && is_simple(&row.coast)) {
                assert!(solved.is_some(), "{name}: {}", file.text);
                simple += 1;
            }
            states += 1;
        }
    }
    assert!(states > 100 && simple > 70 && refused < 12, "{states} states, {simple} simple, {refused} refused");
}

#[test]
fn the_text_says_what_it_is() {
    // By hand: 1 + 80/20 = 5; the pair sun and ring is one element with 0.97^2.
    let arm = "format = 1\nname = \"arm drive\"\nmembers = [\"motor\", \"arm\"]\nterminals = [\"motor\", \"arm\"]\n\
               inertias = { motor = \"0.0002 kg m^2\" }\n[[set]]\nname = \"P1\"\nsun = { member = \"motor\", teeth = 20 }\n\
               planet = { teeth = 30 }\nring = { member = \"frame\", teeth = 80 }\ncarrier = \"arm\"\nmesh_efficiency = 0.97\n";
    let text = made(&Model::from_toml(arm).unwrap(), &ExportRequest::default());
    for line in [
        "  input Real torque_motor(unit=\"N.m\") \"torque on motor from outside, positive along a positive speed\";",
        "  parameter Real inertia_motor(unit=\"kg.m2\") = 0.0002 \"inertia of motor\";",
        "  parameter Real inertia_arm(unit=\"kg.m2\") = 0 \"inertia of arm\";",
        "  parameter Real forward_P1(min=0) = 9409/10000 \"efficiency of P1 where motor drives relative to its carrier\";",
        "  Real speed_motor(unit=\"rad/s\", start=0, fixed=true) \"speed of motor\";",
        "  speed_arm = 1/5*speed_motor;",
        "  q_P1 = 4*p_P1*(if p_P1*(speed_motor - speed_arm) >= 0 then forward_P1 else 1/backward_P1);",
        "  inertia_motor*der(speed_motor) = torque_motor - p_P1;",
        "  inertia_arm*1/5*der(speed_motor) = torque_arm + p_P1 + q_P1;",
    ] {
        assert!(text.lines().any(|l| l == line), "{line}\n{text}");
    }
    // Without an inertia the first terminal is asked for one.
    let none = made(&Model::from_toml(&arm.replace("inertias", "# inertias")).unwrap(), &ExportRequest::default());
    assert!(none.contains("  parameter Real inertia_motor(unit=\"kg.m2\") \"inertia of motor\";"), "{none}");
    assert!(none.contains("parameters without a value: the inertias of motor"), "{none}");
}

#[test]
fn what_equations_cannot_hold_is_refused() {
    let refused = |text: &str, part: &str| {
        let wrong = export(&Model::from_toml(text).unwrap(), "modelica-equations", &ExportRequest::default());
        let wrong = wrong.unwrap_err().to_string();
        assert!(wrong.contains(part), "{wrong}");
    };
    refused(&example("launch"), "the shaft side shafts has backlash with soft contact");
    refused(&example("lossy-gear"), "the mesh pair has a loss table over speed");
    refused(&example("prius-hybrid"), "a variator");
    refused(&example("zf-8hp70"), "the train has 9 states, and none is chosen");
    // All inertias on the motor, a shaft that gives behind it, and ends that are no terminals.
    let bare = PAIR.replace(
        "inertias = { motor = \"0.002 kg m^2\", side = \"0.05 kg m^2\", out = \"0.02 kg m^2\", load = \"0.4 kg m^2\" }",
        "inertias = { motor = \"0.002 kg m^2\" }",
    );
    refused(
        bare.replace("terminals = [\"motor\", \"side\", \"load\"]", "terminals = [\"motor\"]")
            .split("[[scenario]]")
            .next()
            .unwrap(),
        "moves no inertia",
    );
}
