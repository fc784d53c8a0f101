//! Motion against the reference trajectories of Modelica examples, and the page that shows them.
//!
//! `validation/modelica/cases.json` holds a few dozen values of every signal: before and after every event, where a
//! signal is largest, where the reference is most in error, and in between. Whole trajectories are compared where a
//! folder with them is named.

use std::collections::BTreeMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::OnceLock;

use serde_json::Value;
use willis::dynamics::{Event, ModeLabel, Options, Outcome, Recorder, Simulation};
use willis::train::Train;
use willis_casebook::Section;

use crate::{page, read};

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

/// Values of signals: their names, of which the first is the time, and the rows.
struct Values {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Values {
    /// The few dozen of a case.
    fn kept(case: &Value) -> Self {
        let number = |x: &Value| x.as_f64().expect("a number");
        let list = |x: &Value| x.as_array().expect("a list").clone();
        Self {
            names: list(&case["columns"]).iter().map(|n| n.as_str().expect("a name").to_owned()).collect(),
            rows: list(&case["values"]).iter().map(|row| list(row).iter().map(number).collect()).collect(),
        }
    }

    /// All of a reference trajectory: `First.csv` in the folder, or where the collection of reference results has it.
    fn whole(case: &Value, folder: &Path) -> Self {
        let (id, model) = (case["id"].as_str().expect("a name"), case["model"].as_str().expect("a model"));
        let there = model.split('.').fold(folder.to_owned(), |path, part| path.join(part));
        let places = [folder.join(format!("{id}.csv")), there.join(format!("{id}.csv"))];
        let path = places.iter().find(|p| p.exists()).unwrap_or_else(|| panic!("none of {places:?} exists"));
        let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut lines = text.lines();
        let head: Vec<&str> = lines.next().expect("a heading").split(',').map(|n| n.trim().trim_matches('"')).collect();
        let names = Self::kept(case).names;
        let column = |name: &str| head.iter().position(|n| *n == name).unwrap_or_else(|| panic!("{id}: no {name}"));
        let columns: Vec<usize> = names.iter().map(|name| column(name)).collect();
        let row = |line: &str| -> Vec<f64> {
            let cells: Vec<&str> = line.split(',').collect();
            columns.iter().map(|&k| cells[k].trim().parse().expect("a number")).collect()
        };
        Self { names, rows: lines.filter(|l| !l.trim().is_empty()).map(row).collect() }
    }
}

fn trajectory(case: &Value, values: &Values) -> Trajectory {
    let id = case["id"].as_str().expect("a name").to_owned();
    let text = read(&format!("modelica/{id}.toml"));
    let file: toml::Table = text.parse().expect("TOML");
    let train = Train::from_toml(&text).unwrap_or_else(|e| panic!("{id}: {e}"));
    let options = Options { tolerance: 1e-12, ..Options::default() };
    let mut run = Simulation::new(&train, "demo", &options).unwrap_or_else(|e| panic!("{id}: {e}"));

    // Speeds and angles have no jumps: of the two rows of an event, both have to fit.
    let names = &values.names[1..];
    let mut error = vec![0.0; names.len()];
    let mut events = Events::default();
    let mut outcome = None;
    for row in &values.rows {
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
    }
    let signals = (names.iter().zip(error))
        .map(|(name, error)| {
            let recorded = case["signals"][name]["max_abs_error"].as_f64().expect("an error");
            Beside { signal: name.clone(), error, recorded }
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
        rows: values.rows.len(),
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
    let all = || {
        let source = source();
        source["cases"].as_array().expect("cases").iter().map(|c| trajectory(c, &Values::kept(c))).collect()
    };
    CELL.get_or_init(all)
}

/// All signals within ten times the error of the reference, the same modes at the same times, and no
/// energy lost.
fn follows(id: &str) {
    let t = modelica().iter().find(|t| t.id == id).expect("a case");
    assert!(t.rows >= 36 && !t.signals.is_empty());
    // What is kept catches the largest error, so that a follower follows everywhere.
    for s in &t.signals {
        assert!(s.error >= 0.1 * s.recorded, "{id} {}: {:e} of {:e} is caught", s.signal, s.error, s.recorded);
    }
    compare(t);
}

fn compare(t: &Trajectory) {
    let id = &t.id;
    assert_eq!(t.outcome, Some(Outcome::Finished));
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

/// Whole trajectories, by the same bounds; the folder is named in `WILLIS_MODELICA`.
#[test]
#[ignore = "needs a folder of reference results: cargo xtask validate --modelica FOLDER"]
fn val_modelica_whole_trajectories() {
    let folder = std::env::var_os("WILLIS_MODELICA").expect("WILLIS_MODELICA names a folder");
    for case in source()["cases"].as_array().expect("cases") {
        let t = trajectory(case, &Values::whole(case, Path::new(&folder)));
        assert!(t.rows > 200, "{}: {} rows", t.id, t.rows);
        compare(&t);
        println!("{}: {} rows, {} signals follow", t.id, t.rows, t.signals.len());
    }
}

/// The power of ten that twice the number stays below, from 1e-12 on: the same on every machine.
fn bound(x: f64) -> String {
    format!("below 1e{}", (2.0 * x).max(1e-12).log10().ceil() as i32)
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
         It holds about forty values of every signal, 12 digits: before and after every event, where the signal is \
         largest, where the reference differs most, and in between. Modes are compared as events, not by rows: there a \
         locked element may turn at 1e-11 rad/s. `cargo xtask validate --modelica FOLDER` compares whole trajectories with \
         the same bounds, where that folder has the reference results.\n\n\
         The models that the train files describe are under the [BSD-3-Clause licence](LICENSE) of the Modelica Association \
         and contributors.\n",
        from("models"),
        from("models_commit"),
        from("reference_results"),
        from("reference_commit"),
    );
    let mut signals = Section::new(
        "Signals",
        &["Largest difference over all values kept, in the unit of the signal (rad, rad/s)."],
        &["example", "signal", "largest difference", "error of the reference", "ratio", "verdict"],
    );
    let mut events = Section::new(
        "Events",
        &[
            "Times, s, beside those of the independent program. Modes: 1 and -1 slip, 0 holds, 2 is open; a clutch by the speed of \
           its second side against the first.",
        ],
        &["example", "modes after it", "independent", "Willis", "difference"],
    );
    let mut runs = Section::new("Energy", &[], &["example", "times compared", "residual of the energy turned over"]);
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
