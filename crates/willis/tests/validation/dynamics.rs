//! Motion against the numbers of others: every gate of the case `galvagno`, and the reference trajectories of
//! Modelica examples; and the pages that show them.

use std::collections::BTreeMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde_json::Value;
use willis::casebook::{self, Report, Section};
use willis::dynamics::{Event, ModeLabel, Options, Outcome, Recorder, Simulation};
use willis::train::Train;

fn validation() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation")
}

fn read(name: &str) -> String {
    let path = validation().join(name);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn galvagno() -> &'static Report {
    static CELL: OnceLock<Report> = OnceLock::new();
    CELL.get_or_init(|| casebook::run("galvagno").expect("a case"))
}

/// Every gate whose name begins so holds.
fn hold(begin: &str, count: usize) {
    let gates: Vec<_> = galvagno().gates.iter().filter(|g| g.what.starts_with(begin)).collect();
    let wrong: Vec<_> = (gates.iter().filter(|g| !g.holds))
        .map(|g| format!("{}: {:e}, not {:e} to {:e}", g.what, g.ours, g.low, g.high))
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert_eq!(gates.len(), count, "gates of {begin}");
}

#[test]
fn val_galvagno_flows() {
    hold("flows", 3);
}

#[test]
fn val_galvagno_steady_states() {
    hold("steady", 5);
}

#[test]
fn val_galvagno_transients() {
    hold("transient", 18);
}

#[test]
fn val_galvagno_offsets() {
    hold("offsets", 1);
}

#[test]
fn val_galvagno_jamming() {
    hold("jamming", 1);
}

/// Every gate of the case is one of those above.
#[test]
fn val_galvagno_all() {
    hold("", 28);
}

/// The events of a run.
#[derive(Default)]
struct Events(Vec<Event>);

impl Recorder for Events {
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.0.push(event.clone());
        ControlFlow::Continue(())
    }
}

/// A signal beside that of the reference.
struct Beside {
    signal: String,
    /// Largest difference.
    error: f64,
    /// The same of an independent program, at a tolerance at which it is the error of the reference.
    recorded: f64,
}

/// Modes after a time, by element.
type Modes = (f64, BTreeMap<String, i64>);

/// A reference trajectory beside ours.
struct Trajectory {
    id: String,
    rows: usize,
    signals: Vec<Beside>,
    theirs: Vec<Modes>,
    ours: Vec<Modes>,
    residual: f64,
    outcome: Option<Outcome>,
}

const FREE: i64 = 2;

/// Members of a clutch, brake, shaft or drag; what the second lacks is the frame.
fn ends(file: &toml::Table, name: &str) -> Option<(String, Option<String>)> {
    let all = ["shift_element", "shaft", "drag"].iter().filter_map(|k| file.get(*k)?.as_array()).flatten();
    let element = all.into_iter().find(|t| t["name"].as_str() == Some(name))?;
    let members: Vec<&str> = element["members"].as_array()?.iter().filter_map(toml::Value::as_str).collect();
    Some((members[0].to_owned(), members.get(1).map(|m| (*m).to_owned())))
}

/// Without those that repeat the modes before.
fn changes(all: Vec<Modes>) -> Vec<Modes> {
    let mut kept: Vec<Modes> = vec![];
    for modes in all {
        if kept.last().is_none_or(|last| last.1 != modes.1) {
            kept.push(modes);
        }
    }
    kept
}

fn trajectory(case: &Value) -> Trajectory {
    let id = case["id"].as_str().expect("a name").to_owned();
    let text = read(&format!("modelica/{id}.toml"));
    let file: toml::Table = text.parse().expect("TOML");
    let train = Train::from_toml(&text).unwrap_or_else(|e| panic!("{id}: {e}"));
    let options = Options { tolerance: 1e-12, ..Options::default() };
    let mut run = Simulation::new(&train, "demo", &options).unwrap_or_else(|e| panic!("{id}: {e}"));

    // Speeds and angles have no jumps: of the two rows of an event, both have to fit.
    let csv = read(&format!("modelica/{id}.csv"));
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().expect("a heading").split(',').skip(1).collect();
    let mut error = vec![0.0; names.len()];
    let mut events = Events::default();
    let mut outcome = None;
    let mut rows = 0;
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
        outcome = run.advance(row[0], &mut events).or(outcome);
        let value = |member: &str, angle: bool| {
            if angle { run.angle(member) } else { run.speed(member) }.unwrap_or_else(|| panic!("{id}: no {member}"))
        };
        for (k, name) in names.iter().enumerate() {
            let (of, what) = name.split_once('.').expect("component.variable");
            let angle = what.starts_with("phi");
            let ours = if what.ends_with("_rel") {
                let (a, b) = ends(&file, of).unwrap_or_else(|| panic!("{id}: no {of}"));
                b.map_or(0.0, |b| value(&b, angle)) - value(&a, angle)
            } else {
                value(of, angle)
            };
            error[k] = f64::max(error[k], (ours - row[k + 1]).abs());
            assert!(ours.is_finite());
        }
        rows += 1;
    }
    let signals = (names.iter().zip(error))
        .map(|(name, error)| {
            let recorded = case["signals"][*name]["max_abs_error"].as_f64().expect("an error");
            Beside { signal: (*name).to_owned(), error, recorded }
        })
        .collect();

    let theirs: Vec<Modes> = (case["events"].as_array().expect("events").iter())
        .map(|e| {
            let modes = e[1].as_object().expect("modes").iter();
            (e[0].as_f64().expect("a time"), modes.map(|(k, m)| (k.clone(), m.as_i64().unwrap_or(FREE))).collect())
        })
        .collect();
    let mut modes: BTreeMap<String, i64> = theirs[0].1.keys().map(|k| (k.clone(), FREE)).collect();
    let mut ours = vec![];
    for event in &events.0 {
        for (name, label) in &event.modes {
            let Some(mode) = modes.get_mut(name) else { continue };
            // There the speed of a clutch is that of its second side against the first.
            let turned = matches!(ends(&file, name), Some((_, Some(_))));
            *mode = match label {
                ModeLabel::Free => FREE,
                ModeLabel::Stuck => 0,
                l if (*l == ModeLabel::Forward) != turned => 1,
                _ => -1,
            };
        }
        ours.push((event.time_s, modes.clone()));
    }
    let energy = run.report().energy.expect("counted");
    Trajectory {
        id,
        rows,
        signals,
        theirs: changes(theirs),
        ours: changes(ours),
        residual: energy.residual_j.abs() / energy.turned_over_j,
        outcome,
    }
}

/// `advance` stops where it is asked to, also when something happens later in the same step; rotors that stop
/// together do so in one event.
#[test]
fn regress_advance_stops_before_an_event() {
    let train = Train::from_toml(
        r#"
        format = 1
        name = "two rotors coast"
        members = ["a", "b"]
        inertias = { a = "1 kg m^2", b = "1 kg m^2" }
        [[mesh]]
        name = "gear"
        gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 30 }]
        efficiency = 0.9
        [[drag]]
        name = "bearing a"
        members = ["a"]
        coulomb = "1 N m"
        [[drag]]
        name = "bearing b"
        members = ["b"]
        coulomb = "2 N m"
        [[scenario]]
        name = "coast"
        duration = "100 s"
        initial_speeds = { a = "10 rad/s" }
        "#,
    )
    .expect("a train");
    let mut run = Simulation::new(&train, "coast", &Options::default()).expect("a scenario");
    let mut events = Events::default();
    for k in 1..=40 {
        let t = 0.1 * f64::from(k);
        run.advance(t, &mut events);
        assert_eq!(run.time(), t);
    }
    let early = run.speed("a").expect("a rotor");
    assert!(early > 0.0 && early < 10.0);
    run.advance(100.0, &mut events);
    assert_eq!((run.speed("a"), run.speed("b")), (Some(0.0), Some(0.0)));
    let stop = &events.0[1..];
    assert!(stop.len() == 1 && stop[0].modes.iter().all(|(_, mode)| *mode == ModeLabel::Stuck), "{stop:?}");
}

fn source() -> Value {
    serde_json::from_str(&read("modelica/cases.json")).expect("JSON")
}

fn modelica() -> &'static [Trajectory] {
    static CELL: OnceLock<Vec<Trajectory>> = OnceLock::new();
    CELL.get_or_init(|| source()["cases"].as_array().expect("cases").iter().map(trajectory).collect())
}

/// All signals within ten times the error of the reference, the same modes at the same times, and no
/// energy lost.
fn follows(id: &str) {
    let t = modelica().iter().find(|t| t.id == id).expect("a case");
    assert_eq!(t.outcome, Some(Outcome::Finished));
    assert!(t.rows > 200 && !t.signals.is_empty());
    for s in &t.signals {
        assert!(s.error <= 10.0 * s.recorded, "{id} {}: {:e}, reference {:e}", s.signal, s.error, s.recorded);
    }
    let modes = |all: &[Modes]| all.iter().map(|m| m.1.clone()).collect::<Vec<_>>();
    assert_eq!(modes(&t.ours), modes(&t.theirs), "{id}: ours {:?}, theirs {:?}", t.ours, t.theirs);
    for (ours, theirs) in t.ours.iter().zip(&t.theirs) {
        assert!((ours.0 - theirs.0).abs() < 1e-8, "{id}: event at {}, theirs at {}", ours.0, theirs.0);
    }
    assert!(t.residual <= 1e-9, "{id}: {:e} of the energy", t.residual);
}

#[test]
fn val_modelica_lossy_gear_demo_1() {
    follows("LossyGearDemo1");
}

#[test]
fn val_modelica_lossy_gear_demo_3() {
    follows("LossyGearDemo3");
}

#[test]
fn val_modelica_simple_gear_shift() {
    follows("SimpleGearShift");
}

#[test]
fn val_modelica_coupled_clutches() {
    follows("CoupledClutches");
}

#[test]
fn val_modelica_friction() {
    follows("Friction");
}

#[test]
fn val_modelica_first() {
    follows("First");
}

/// What a page of `validation` holds; written with `WILLIS_WRITE=1`, else compared.
fn page(name: &str, text: &str) {
    let path = validation().join(name);
    if std::env::var_os("WILLIS_WRITE").is_some() {
        fs::write(path, text).expect("a page");
    } else {
        let committed = fs::read_to_string(path).unwrap_or_default();
        assert!(committed == text, "validation/{name} is out of date: run `cargo xtask generate`");
    }
}

#[test]
fn write_page_galvagno() {
    let text = galvagno().to_string();
    let (title, rest) = text.split_once('\n').expect("a title");
    let head =
        format!("{title}\n\nGenerated by `cargo xtask generate`; the same as `willis validate galvagno`.\n{rest}");
    page("galvagno/README.md", &head);
}

/// The power of ten that twice the number stays below, from 1e-12 on: the same on every machine.
fn bound(x: f64) -> String {
    format!("below 1e{}", (2.0 * x).max(1e-12).log10().ceil() as i32)
}

fn section(title: &str, text: &[&str], columns: &[&str]) -> Section {
    let owned = |all: &[&str]| all.iter().map(|t| (*t).to_owned()).collect();
    Section { title: title.into(), text: owned(text), columns: owned(columns), ..Section::default() }
}

#[test]
fn write_page_modelica() {
    let json = source();
    let from = |key: &str| json["source"][key].as_str().expect("a source").to_owned();
    let mut text = format!(
        "# Motion beside Modelica\n\nGenerated by `cargo xtask generate`.\n\n\
         Six examples of the {} (models at commit `{}`) as train files, beside the reference results of {} (commit `{}`), made \
         by Dymola 2020x with DASSL at a tolerance of 1e-6. `cases.json` holds, signal by signal, the largest difference of \
         an independent program from them; as that does not change at a tolerance of 1e-12, it is the error of the reference. \
         A signal follows if ours differs by no more than ten times as much.\n\n\
         The CSV files are thinned copies: the time and the signals compared, 12 digits; every second to eighth row, the \
         rows before and after every event (two rows of one time), and the row of the largest amount of each signal. \
         Modes are compared as events, not by rows: there a locked element may turn at 1e-11 rad/s.\n\n\
         The CSV files, and the models that the train files describe, are under the [BSD-3-Clause licence](LICENSE) of the \
         Modelica Association and contributors.\n",
        from("models"),
        from("models_commit"),
        from("reference_results"),
        from("reference_commit"),
    );
    let mut signals = section(
        "Signals",
        &["Largest difference over all rows, in the unit of the signal (rad, rad/s)."],
        &["example", "signal", "largest difference", "error of the reference", "ratio", "verdict"],
    );
    let mut events = section(
        "Events",
        &[
            "Times, s, beside those of the independent program. Modes: 1 and -1 slip, 0 holds, 2 is open; a clutch by the speed of \
           its second side against the first.",
        ],
        &["example", "modes after it", "independent", "Willis", "difference"],
    );
    let mut runs = section("Energy", &[], &["example", "rows compared", "residual of the energy turned over"]);
    for t in modelica() {
        for s in &t.signals {
            let ratio = s.error / s.recorded;
            signals.rows.push(vec![
                t.id.as_str().into(),
                s.signal.as_str().into(),
                format!("{:.1e}", s.error).into(),
                format!("{:.1e}", s.recorded).into(),
                format!("{ratio:.1}").into(),
                if ratio <= 10.0 { "follows" } else { "**misses**" }.into(),
            ]);
        }
        for (ours, theirs) in t.ours.iter().zip(&t.theirs) {
            let modes: Vec<String> = ours.1.iter().map(|(k, m)| format!("{k} {m}")).collect();
            events.rows.push(vec![
                t.id.as_str().into(),
                modes.join(", ").into(),
                (theirs.0, 9).into(),
                (ours.0, 9).into(),
                bound((ours.0 - theirs.0).abs()).into(),
            ]);
        }
        runs.rows.push(vec![t.id.as_str().into(), (t.rows as f64, 0).into(), bound(t.residual).into()]);
    }
    for s in [signals, events, runs] {
        text += &s.to_string();
    }
    page("modelica/README.md", &text);
}
