//! Sweeps: a point is what `analyze` says of it, whatever varies; verdicts are rows; words for what is wrong.

use std::fs;
use std::sync::Arc;

use willis::analysis::{Analysis, Selection, SolutionReport, analyze};
use willis::model::{Model, Target};
use willis::study::{
    Axis, ColumnValues, Hold, PointAnswer, PointAnswers, PointSetup, PointVerdict, Rows, Sweep, SweepRequest,
    TrainCache, sensitivity,
};
use willis::train::{Document, Load, Operation, Train};

use crate::common::{self, example, examples};

fn subject(text: &str) -> Model {
    let mut load = |file: &str| fs::read_to_string(common::folder().join(file)).map_err(|e| e.to_string());
    Model::read(text, &mut load).unwrap_or_else(|r| panic!("{r}"))
}

fn axes(subject: &Model, over: &[&str]) -> Vec<Axis> {
    over.iter().map(|a| Axis::parse(a, subject).unwrap_or_else(|d| panic!("{a}: {}", d.message))).collect()
}

fn sweep<'s>(subject: &'s Model, over: &[&str], columns: &[&str], hold: Hold) -> Sweep<'s> {
    let question = PointSetup::new(subject, None, None, hold).unwrap();
    let columns: Vec<String> = columns.iter().map(|c| (*c).to_owned()).collect();
    Sweep::new(question, axes(subject, over), &columns).unwrap_or_else(|d| panic!("{d}"))
}

fn all(sweep: &Sweep<'_>) -> Rows {
    sweep.rows(0, sweep.len(), &mut Default::default())
}

fn column<'r>(sweep: &Sweep<'_>, rows: &'r Rows, name: &str) -> &'r ColumnValues {
    let k = sweep.columns().position(|c| c.name == name).unwrap_or_else(|| panic!("no column {name}"));
    &rows.columns[k]
}

fn numbers<'r>(sweep: &Sweep<'_>, rows: &'r Rows, name: &str) -> &'r [f64] {
    let ColumnValues::Numbers(all) = column(sweep, rows, name) else { panic!("{name} holds texts") };
    all
}

fn texts(sweep: &Sweep<'_>, rows: &Rows, name: &str) -> Vec<String> {
    let ColumnValues::Texts(all) = column(sweep, rows, name) else { panic!("{name} holds numbers") };
    all.iter().map(|t| t.to_string()).collect()
}

fn analysis(text: &str) -> Analysis {
    let train = Train::from_toml(text).unwrap_or_else(|d| panic!("{d}\n{text}"));
    analyze(&train, &Selection::default()).unwrap_or_else(|d| panic!("{d}"))
}

/// A train file with one operation alone, written as a person would.
fn with_operation(text: &str, operation: &str) -> String {
    let mut table: toml::Table = text.parse().unwrap();
    table.remove("operation");
    table.remove("study");
    table.remove("scenario");
    format!("{table}\n[[operation]]\nname = \"point\"\n{operation}\n")
}

/// The rows of a sweep against `analyze` of a file that prescribes the same point.
fn same_bits(
    file: &str,
    over: &[&str],
    operation: &dyn Fn(&[String]) -> String,
    edit: &dyn Fn(&mut Document, &[String]),
) {
    let text = example(file);
    let subject = subject(&text);
    let sweep = sweep(&subject, over, &["members", "meshes"], Hold::AsGiven);
    let rows = all(&sweep);
    let verdicts = texts(&sweep, &rows, "verdict");
    for point in 0..sweep.len() {
        let values: Vec<String> = sweep.axes().iter().zip(sweep.place(point)).map(|(a, k)| a.setting(k)).collect();
        let mut document = Document::parse(&text).unwrap();
        edit(&mut document, &values);
        let answer = analysis(&with_operation(&document.text(), &operation(&values)));
        let own = &answer.operations[0];
        let at = point as usize;
        assert_eq!(verdicts[at], format!("{:?}", own.verdict).to_lowercase(), "{file} {values:?}");
        let Some(s) = own.solutions.first().filter(|_| verdicts[at] == "unique") else { continue };
        let bits = |name: &str, expected: Option<f64>| {
            let is = numbers(&sweep, &rows, name)[at];
            match expected {
                Some(x) => assert_eq!(is.to_bits(), x.to_bits(), "{file} {values:?} {name}: {is}, not {x}"),
                None => assert!(is.is_nan(), "{file} {values:?} {name}: {is}"),
            }
        };
        bits("efficiency", s.efficiency);
        bits("loss_w", Some(s.loss_w));
        bits("input_power_w", Some(s.input_power_w));
        bits("output_power_w", Some(s.output_power_w));
        for (name, m) in s.members.iter() {
            bits(&format!("{name}.speed_rad_s"), m.speed_rad_s);
            bits(&format!("{name}.torque_n_m"), m.torque_n_m);
            bits(&format!("{name}.power_w"), m.power_w);
        }
        for (name, m) in s.meshes.iter() {
            bits(&format!("{name}.loss_w"), Some(m.loss_w));
        }
    }
}

#[test]
fn a_point_is_what_analyze_says_of_it() {
    let nothing = |_: &mut Document, _: &[String]| {};
    // Speeds and torques, driving and coasting.
    same_bits(
        "fva-planetary-stage.toml",
        &["sun.speed=200..3000 rpm:4", "sun.torque=-700..1700 N m:5", "oil.temperature=40,80 degC"],
        &|v| {
            format!("speeds = {{ sun = \"{}\" }}\ntorques = {{ sun = \"{}\" }}\ntemperature = \"{}\"", v[0], v[1], v[2])
        },
        &nothing,
    );
    // Powers, and two freedoms.
    same_bits(
        "esmail-fig1.toml",
        &["sun1.speed=-900..1200 rpm:6", "sun4.speed=100..800 rpm:3", "sun1.torque=-20..20 N m:4"],
        &|v| format!("speeds = {{ sun1 = \"{}\", sun4 = \"{}\" }}\ntorques = {{ sun1 = \"{}\" }}", v[0], v[1], v[2]),
        &nothing,
    );
    // Every state; positive at the output drives.
    let text = example("zf-8hp70.toml");
    let states: toml::Table = text.parse().unwrap();
    assert!(states["state"].as_array().unwrap().len() > 8);
    same_bits(
        "zf-8hp70.toml",
        &["input.speed=800..6000 rpm:3", "input.torque=-100..400 N m:3", "state=all"],
        &|v| {
            format!("state = \"{}\"\nspeeds = {{ s4c1 = \"{}\" }}\ntorques = {{ s4c1 = \"{}\" }}", v[2], v[0], v[1])
                .replace("s4c1", &input_of(&text))
        },
        &nothing,
    );
    // Quantities of the file.
    same_bits(
        "fva-planetary-stage.toml",
        &["P1.planet.count=2,3,4", "P1.geometry.roughness=0.2..1.2 um:3", "sun bearing.radial_load=0,2 kN"],
        &|_| "speeds = { sun = \"1500 rpm\" }\ntorques = { sun = \"1591.549 N m\" }".into(),
        &|document, values| {
            for (path, value) in
                ["P1.planet.count", "P1.geometry.roughness", "sun bearing.radial_load"].iter().zip(values)
            {
                let key = document.find(path).unwrap();
                document.set(&key, value).unwrap();
            }
        },
    );
    // Laws.
    same_bits(
        "fva-planetary-stage.toml",
        &["law.mesh_friction=schlenk,niemann,iso-14179-1"],
        &|_| "speeds = { sun = \"1500 rpm\" }\ntorques = { sun = \"1591.549 N m\" }".into(),
        &|document, values| {
            let key = document.find("laws.mesh_friction").unwrap();
            document.set(&key, &values[0]).unwrap();
        },
    );
}

fn input_of(text: &str) -> String {
    let train = Train::from_toml(text).unwrap();
    train.member_name(train.input().unwrap()).to_owned()
}

#[test]
fn compiled_rows_are_the_same_but_for_round_off() {
    for (file, over) in [
        ("zf-8hp70.toml", &["input.speed=100..6000 rpm:7", "output.torque=-300..300 N m:9", "state=all"][..]),
        (
            "esmail-fig1.toml",
            &["sun1.speed=-900..1200 rpm:23", "sun4.speed=-300..800 rpm:12", "sun1.torque=-20..20 N m:5"],
        ),
        ("wolfrom-498-self-locking.toml", &["input.speed=-50..50 rpm:3", "output.torque=-40..40 N m:5"]),
        (
            "zf-8hp70.toml",
            &["input.speed=1000 rpm", "input.torque=10..60 N m:3", "P1.mesh_efficiency=0.9,0.98", "state=2,R"],
        ),
    ] {
        let text = example(file);
        let subject = subject(&text);
        let sweep = sweep(&subject, over, &["members"], Hold::AsGiven);
        let terminals: Vec<String> = (subject.train().terminals().iter())
            .map(|t| format!("{}.torque_n_m", subject.train().member_name(*t)))
            .collect();
        let asked: Vec<&str> = terminals.iter().map(String::as_str).collect();
        let lean = self::sweep(&subject, over, &asked, Hold::AsGiven);
        let compiled = lean.compile().unwrap_or_else(|d| panic!("{file}: {d}"));
        let mut room = Default::default();
        let fast = compiled.rows(0, lean.len(), &mut room);
        let slow = all(&sweep);
        for (k, c) in compiled.columns().enumerate() {
            match &fast.columns[k] {
                ColumnValues::Integers(_) => panic!("{} counts", c.name),
                ColumnValues::Texts(own) => {
                    let own: Vec<String> = own.iter().map(|t| t.to_string()).collect();
                    assert_eq!(own, texts(&sweep, &slow, &c.name), "{file} {}", c.name);
                }
                ColumnValues::Numbers(own) => {
                    let size = own.iter().filter(|x| !x.is_nan()).fold(0.0f64, |a, x| a.max(x.abs()));
                    for (i, (a, b)) in own.iter().zip(numbers(&sweep, &slow, &c.name)).enumerate() {
                        let near = (a - b).abs() <= 1e-12 * size || a.is_nan() && b.is_nan();
                        assert!(near, "{file} {} at {}: {a}, not {b}", c.name, sweep.describe(i as u64));
                    }
                }
            }
        }
        let summary = compiled.summary(0, lean.len(), &mut room);
        assert_eq!(summary.verdicts, slow.summary.verdicts, "{file}");
        assert_eq!(summary.best, slow.summary.best, "{file}");
        // In pieces, the rows are the same bytes.
        let group = lean.group();
        let middle = lean.len() / 2 / group * group;
        let pieces = [compiled.rows(0, middle, &mut room), compiled.rows(middle, lean.len(), &mut room)];
        for (k, whole) in fast.columns.iter().enumerate() {
            match (whole, &pieces[0].columns[k], &pieces[1].columns[k]) {
                (ColumnValues::Numbers(w), ColumnValues::Numbers(a), ColumnValues::Numbers(b)) => {
                    assert!(w.iter().zip(a.iter().chain(b)).all(|(x, y)| x.to_bits() == y.to_bits()), "{file}");
                }
                (ColumnValues::Texts(w), ColumnValues::Texts(a), ColumnValues::Texts(b)) => {
                    assert!(w.iter().eq(a.iter().chain(b)))
                }
                _ => panic!("columns change their kind"),
            }
        }
    }
}

#[test]
fn what_has_no_answer_is_a_row_with_its_verdict() {
    let locking = example("wolfrom-498-self-locking.toml");
    let subject = subject(&locking);
    let locking = sweep(&subject, &["input.speed=10 rpm", "output.torque=-40,40 N m"], &[], Hold::AsGiven);
    let rows = all(&locking);
    let verdicts = texts(&locking, &rows, "verdict");
    assert!(verdicts.contains(&"locked".to_owned()) && verdicts.contains(&"unique".to_owned()), "{verdicts:?}");
    for (k, verdict) in verdicts.iter().enumerate() {
        let reason = &texts(&locking, &rows, "reason")[k];
        assert_eq!(numbers(&locking, &rows, "efficiency")[k].is_nan(), verdict != "unique");
        assert!(verdict == "unique" || reason.contains("locks the train"), "{reason}");
    }
    // Planets that cannot be built there.
    let fva = example("fva-planetary-stage.toml");
    let subject = self::subject(&fva);
    let counts = sweep(&subject, &["P1.planet.teeth=22,23,40"], &[], Hold::AsGiven);
    let rows = all(&counts);
    let verdicts = texts(&counts, &rows, "verdict");
    assert_eq!(verdicts[2], "refused", "{verdicts:?}");
    assert!(!texts(&counts, &rows, "reason")[2].is_empty());
}

#[test]
fn what_is_held_stays() {
    let fva = example("fva-planetary-stage.toml");
    let subject = subject(&fva);
    let over = &["sun.speed=500..3000 rpm:6"];
    let constant = |x: &[f64]| x.iter().all(|v| (v - x[0]).abs() <= 1e-12 * x[0].abs());
    for (hold, column, steady) in [
        (Hold::AsGiven, "sun.torque_n_m", true),
        (Hold::Power, "sun.power_w", true),
        (Hold::Torque, "sun.torque_n_m", true),
        (Hold::Torque, "sun.power_w", false),
        (Hold::Output, "carrier.torque_n_m", true),
        (Hold::Output, "sun.torque_n_m", false),
    ] {
        let sweep = sweep(&subject, over, &["members"], hold);
        let rows = all(&sweep);
        assert_eq!(constant(numbers(&sweep, &rows, column)), steady, "{hold:?} {column}");
    }
}

/// The torque at the output drives in every state, whichever way it turns.
#[test]
fn a_held_output_drives_in_reverse_too() {
    let text = example("zf-8hp70.toml");
    let subject = subject(&text);
    let by_hold = sweep(&subject, &["state=all"], &["members"], Hold::Output);
    let rows = all(&by_hold);
    let base = analysis(&text).operations[0].solutions[0].members.get("output").unwrap().torque_n_m.unwrap();
    let by_axis = sweep(&subject, &[&format!("output.torque={} N m", -base), "state=all"], &["members"], Hold::AsGiven);
    let other = all(&by_axis);
    let of = |s: &Sweep<'_>, r: &Rows, name: &str| numbers(s, r, name).to_vec();
    assert_eq!(of(&by_hold, &rows, "efficiency"), of(&by_axis, &other, "efficiency"));
    let (power, speed) = (of(&by_hold, &rows, "output.power_w"), of(&by_hold, &rows, "output.speed_rad_s"));
    assert!(power.iter().all(|p| *p < 0.0) && speed.iter().any(|w| *w < 0.0));
}

#[test]
fn what_check_says_of_another_train_is_in_its_row() {
    let fva = example("fva-planetary-stage.toml");
    let subject = subject(&fva);
    let planets = sweep(&subject, &["P1.planet.count=3,4,8"], &[], Hold::AsGiven);
    let warnings = texts(&planets, &all(&planets), "warnings");
    assert!(!warnings[0].contains("W303") && warnings[2].contains("W303"), "{warnings:?}");
    for (axis, says) in
        [("oil.temperature=-300..20 degC:3", "none that a gearbox has"), ("temperature=400 degC", "327")]
    {
        let d = Axis::parse(axis, &subject).unwrap_err();
        assert!(format!("{} {}", d.message, d.hints.join(" ")).contains(says), "{}", d.message);
    }
    // No column twice.
    let same = sweep(&subject, &["sun.torque=50,60 N m"], &["members"], Hold::AsGiven);
    let names: Vec<&str> = same.columns().map(|c| c.name.as_str()).collect();
    assert!((1..names.len()).all(|k| !names[..k].contains(&names[k])), "{names:?}");
}

/// What `sensitivity` ranks can be swept under the same name.
#[test]
fn ranked_quantities_are_axes() {
    for file in ["fva-planetary-stage.toml", "wang-herringbone-physical.toml", "prius-p112.toml", "zf-8hp70.toml"] {
        let subject = subject(&example(file));
        for o in sensitivity(subject.train(), &Selection::default()).unwrap().operations {
            for q in &o.quantities {
                let unit = if q.unit == "-" { "" } else { &q.unit };
                axes(&subject, &[&format!("{}={} {unit}", q.name, q.value)]);
            }
        }
    }
}

/// Every quantity of every example, set to what it is, leaves the train as it is.
#[test]
fn paths_lead_to_what_they_name() {
    let mut checked = 0;
    for (file, text) in common::examples() {
        let document = Document::parse(&text).unwrap();
        assert_eq!(document.text(), text);
        let mut all = Document::parse(&text).unwrap();
        let quantities = document.quantities();
        for (k, (name, key)) in quantities.iter().enumerate() {
            assert!(!quantities[..k].iter().any(|q| q.0 == *name), "{file}: {name} twice");
            let found = document.find(name).unwrap_or_else(|d| panic!("{file}: {name}: {}", d.message));
            assert_eq!(found, *key, "{file}: {name}");
            let Some(value) = document.value(key) else { continue };
            all.set(key, &value).unwrap_or_else(|e| panic!("{file}: {name}: {e}"));
            assert_eq!(all.value(key), Some(value), "{name}");
            checked += 1;
        }
        let same: [toml::Table; 2] = [&text, &all.text()].map(|t| t.parse().unwrap());
        assert_eq!(same[0], same[1], "{file}");
    }
    assert!(checked > 800, "{checked}");
}

#[test]
fn axes_take_the_values_that_are_written() {
    let fva = example("fva-planetary-stage.toml");
    let subject = subject(&fva);
    let settings = |axis: &str| {
        let a = Axis::parse(axis, &subject).unwrap_or_else(|d| panic!("{axis}: {}", d.message));
        (0..a.len()).map(|k| a.setting(k)).collect::<Vec<_>>()
    };
    assert_eq!(settings("sun.speed=500rpm..1500rpm:3"), ["500 rpm", "1000 rpm", "1500 rpm"]);
    assert_eq!(settings("sun.torque=0.1..0.3 N m:3"), ["0.1 N m", "0.2 N m", "0.3 N m"]);
    assert_eq!(settings("sun.torque=1..100 N m:3:log"), ["1 N m", "10 N m", "100 N m"]);
    assert_eq!(settings("sun.speed=500 rpm..1600 rpm:step 500 rpm"), ["500 rpm", "1000 rpm", "1500 rpm"]);
    assert_eq!(settings("P1.planet.count=3..5"), ["3", "4", "5"]);
    assert_eq!(settings("P1.planet.count=3,4,6"), ["3", "4", "6"]);
    assert_eq!(settings("oil.temperature=20 degC, 60 degC"), ["20 degC", "60 degC"]);
    assert_eq!(settings("law.mesh_friction=schlenk,niemann"), ["schlenk", "niemann"]);
    assert!(settings("law.mesh_friction=all").len() > 5);
    assert_eq!(Axis::parse("sun.speed=1..2 rad/s:2", &subject).unwrap().column(), "sun.speed_rad_s");
    assert_eq!(Axis::parse("sun.torque=1..2 Nm:2", &subject).unwrap().column(), "sun.torque_n_m");
    assert_eq!(Axis::parse("sun.power=1..2 MW:2", &subject).unwrap().column(), "sun.power_MW");
    assert_eq!(Axis::parse("oil.viscosity_40=80..120 mm^2/s:2", &subject).unwrap().column(), "oil.viscosity_40_mm2_s");
}

/// Work that is stopped at its first piece.
struct Stopped;

impl willis::work::Work for Stopped {
    fn cancelled(&self) -> bool {
        true
    }
}

#[test]
fn a_sweep_that_is_stopped_says_so() {
    let model = subject(&example("zf-8hp70"));
    let request = SweepRequest { over: vec!["state=all".into()], ..SweepRequest::default() };
    let wrong = willis::study::sweep(&model, &request, &Stopped).unwrap_err();
    assert!(wrong.is_cancelled(), "{wrong}");
}

#[test]
fn what_is_wrong_with_an_axis_is_told() {
    let fva = example("fva-planetary-stage.toml");
    let subject = subject(&fva);
    for (axis, says) in [
        ("sun.sped=1..2 rpm:3", "did you mean `sun.speed`?"),
        ("P1.planet.cuont=3,4", "did you mean `P1.planet.count`?"),
        ("law.mesh_fricton=all", "did you mean `law.mesh_friction`?"),
        ("oil.viscosity_50=1..2 mm^2/s:3", "did you mean `oil.viscosity_40`?"),
        ("zzz=1", "there is no quantity `zzz`"),
        ("state=1", "no shift table"),
        ("sun.speed", "no `=`"),
        ("sun.speed=", "no values"),
        ("sun.speed=100 rpm..100 rpm:3", "the range is empty"),
        ("sun.speed=200 rpm..100 rpm:3", "runs backwards"),
        ("sun.speed=100 rpm..200 rpm", "how many"),
        ("sun.speed=100..200 N m:3", "not an angular speed"),
        ("sun.speed=100..200:3", "the unit is missing"),
        ("sun.speed=100 rpm..20 rad/s:3", "two units"),
        ("sun.speed=100..200 rpm:1", "at least 2"),
        ("sun.speed=100..200 rpm:many", "no number of values"),
        ("sun.speed=100..200 rpm:3:cubic", "no way to space"),
        ("sun.speed=-100..200 rpm:3:log", "above zero"),
        ("sun.speed=100..200 rpm:step 0 rpm", "above zero"),
        ("sun.speed=nan..200 rpm:3", "no number"),
        ("sun.speed=1e999..2e999 rpm:3", "no number"),
        ("P1.planet.count=3..6:3", "not whole numbers"),
        ("P1.planet.count=3.5", "not a whole number"),
        ("P1.planet.count=3,3", "twice"),
        ("law.mesh_friction=schlonk", "schlonk"),
        ("P1.geometry.module=4", "the unit is missing"),
    ] {
        let d = Axis::parse(axis, &subject).expect_err(axis);
        let told = format!("{} {}", d.message, d.hints.join(" "));
        assert!(told.contains(says), "{axis}: {told}");
    }
    // Which speed it replaces is open where two are prescribed.
    let prius = example("prius-p112.toml");
    let subject = self::subject(&prius);
    let two = sweep(&subject, &["mg1.speed=1000,2000 rpm"], &[], Hold::AsGiven);
    let rows = all(&two);
    assert_eq!(texts(&two, &rows, "verdict"), ["refused", "refused"]);
    assert!(texts(&two, &rows, "reason")[0].contains("which one that of mg1 replaces is open"));
}

/// What the paper says of its drive, as sweeps. Its own figures are pictures without numbers; see
/// `validation/wang-2020/README.md` for why the number of planets acts as it does.
#[test]
fn val_wang_trends() {
    let wang = example("wang-herringbone-physical.toml");
    let subject = subject(&wang);
    let run = |name: &str| {
        let sweep = Sweep::of_file(&subject, name).unwrap_or_else(|d| panic!("{name}: {d}"));
        let rows = all(&sweep);
        assert_eq!(rows.summary.verdicts.get(&PointVerdict::Unique), Some(&sweep.len()), "{name}");
        let get = |c: &str| numbers(&sweep, &rows, c).to_vec();
        (get("efficiency"), get("loss_w"), get("windage_loss_w"), get("mesh_loss_w"))
    };
    let falls = |x: &[f64]| x.windows(2).all(|w| w[1] < w[0]);
    let rises = |x: &[f64]| x.windows(2).all(|w| w[1] > w[0]);
    // "The power loss increases with the speed", "the efficiency decreases": windage does it.
    let (efficiency, loss, windage, _) = run("speed at constant power");
    assert!(falls(&efficiency) && rises(&loss) && rises(&windage));
    let (efficiency, loss, ..) = run("speed at constant torque");
    assert!(rises(&loss) && efficiency[0] > *efficiency.last().unwrap());
    // "The efficiency increases with the input power."
    let (efficiency, loss, ..) = run("power");
    assert!(rises(&efficiency) && rises(&loss));
    // "The efficiency decreases with the number of planets": the diagonal of the grid of both stages.
    let (efficiency, ..) = run("planets");
    let diagonal: Vec<f64> = (0..4).map(|k| efficiency[5 * k]).collect();
    assert!(falls(&diagonal), "{diagonal:?}");
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig { cases: 400, failure_persistence: None, ..Default::default() })]

    /// Any text is an axis or is refused in words.
    #[test]
    fn no_axis_panics(
        name in "(sun\\.speed|P1\\.planet\\.count|law\\.bearing|oil\\.temperature|[a-z.=0-9é]{0,12})",
        values in "[0-9.eE+\\- rpmNdegC,:solgtp/é]{0,30}",
    ) {
        static SUBJECT: std::sync::LazyLock<Model> =
            std::sync::LazyLock::new(|| subject(&example("fva-planetary-stage.toml")));
        if let Ok(axis) = Axis::parse(&format!("{name}={values}"), &SUBJECT) {
            proptest::prop_assert!(!axis.is_empty());
            for k in [0, axis.len() / 2, axis.len() - 1] {
                proptest::prop_assert!(axis.is_text() || axis.number(k).is_finite(), "{}", axis.setting(k));
            }
        }
    }
}

/// A column has one meaning: no two groups have one of the same name, of which a table could have but one.
#[test]
fn groups_of_columns_share_no_name() {
    const GROUPS: [&str; 5] = ["members", "meshes", "elements", "sources", "variators"];
    let mut files = 0;
    for (file, text) in common::examples() {
        let subject = subject(&text);
        let of = |columns: &[&str]| -> Option<Vec<String>> {
            let question = PointSetup::new(&subject, None, None, Hold::AsGiven).ok()?;
            let axis = Axis::parse("input.speed=100,200 rpm", &subject).ok()?;
            let columns: Vec<String> = columns.iter().map(|c| (*c).to_owned()).collect();
            let sweep = Sweep::new(question, vec![axis], &columns).ok()?;
            Some(sweep.columns().map(|c| c.name.clone()).collect())
        };
        let Some(usual) = of(&[]) else { continue };
        let own: Vec<Vec<String>> =
            GROUPS.map(|group| of(&[group]).expect(group).into_iter().filter(|n| !usual.contains(n)).collect()).into();
        for (k, names) in own.iter().enumerate() {
            for (j, others) in own.iter().enumerate().filter(|(j, _)| *j > k) {
                let both: Vec<&String> = names.iter().filter(|n| others.contains(n)).collect();
                assert!(both.is_empty(), "{file}: {} and {} have {both:?}", GROUPS[k], GROUPS[j]);
            }
        }
        let together = of(&GROUPS).expect("all groups").len();
        assert_eq!(together, usual.len() + own.iter().map(Vec::len).sum::<usize>(), "{file}");
        files += 1;
    }
    assert!(files > 20, "{files} files");
}

/// The operating points of a train with other speeds and loads: of both signs, at rest and without load, small and large, at
/// several temperatures where that counts.
fn varied(model: &Model) -> Vec<(Arc<Train>, Operation)> {
    let train = model.train();
    let (mut points, mut trains) = (vec![], TrainCache::default());
    let oil = Target::parse("oil.temperature", model).ok().filter(|_| train.is_physical());
    let oils: &[Option<&str>] = if oil.is_some() { &[None, Some("41 degC"), Some("95.5 degC")] } else { &[None] };
    for operation in train.operations().iter().take(4) {
        let ([(speed, w)], [(load, value)]) = (&operation.speeds[..], &operation.loads[..]) else { continue };
        let question = PointSetup::new(model, Some(&operation.name), None, Hold::AsGiven).unwrap();
        let (what, unit, value) = match value {
            Load::Torque(t) => ("torque", "N m", t.si()),
            Load::Power(p) => ("power", "W", p.si()),
        };
        let target = |member, what| Target::parse(&format!("{}.{what}", train.member_name(member)), model).unwrap();
        let (speed, load) = (target(*speed, "speed"), target(*load, what));
        for k in [1.0, 0.31, -1.0, 1e-3, 1.7, 0.0, 0.9999] {
            for l in [1.0, 1.3, -0.7, 0.013, 0.0, 2.0, 1e-6, 100.0] {
                for t in oils {
                    let rpm = w.si() * k * 30.0 / std::f64::consts::PI;
                    let mut settings = vec![(&speed, format!("{rpm} rpm")), (&load, format!("{} {unit}", value * l))];
                    settings.extend(oil.as_ref().zip(*t).map(|(oil, t)| (oil, t.to_owned())));
                    points.push(question.at(&settings, &mut trains).unwrap());
                }
            }
        }
    }
    points
}

/// A point of a series is that asked alone, to the last bit, whatever was asked before it. With laws, and, for trains that lock
/// or have several answers, with drags beside given efficiencies.
#[test]
fn points_of_a_series_are_those_asked_alone() {
    let (mut quick, mut odd) = (0, 0);
    for (file, text) in examples() {
        let given = subject(&text);
        let text = match given.train().is_physical() || text.contains("[[drag]]") {
            true => text,
            false => {
                let drag = |m: &&str| {
                    format!("\n[[drag]]\nname = \"drag of {m}\"\nmembers = [\"{m}\", \"frame\"]\ncoulomb = \"1 N m\"\n")
                };
                let terminals = given.train().terminals().iter().map(|m| given.train().member_name(*m));
                text + &terminals.collect::<Vec<_>>().iter().map(drag).collect::<String>()
            }
        };
        let points = varied(&subject(&text));
        let alone: Vec<PointAnswer> = points.iter().map(|(train, point)| PointAnswer::of(train, point)).collect();
        let places = 0..points.len();
        for order in [places.clone().collect::<Vec<_>>(), places.rev().collect()] {
            let mut places = order.iter();
            let asked = order.iter().map(|k| Ok(points[*k].clone()));
            PointAnswers::each(asked, false, |answer, asked| {
                let whole = &alone[*places.next().unwrap()];
                let at = format!("{file} {:?}", asked.unwrap().1);
                assert_eq!((answer.verdict, &answer.reason), (whole.verdict, &whole.reason), "{at}");
                assert_eq!(format!("{:?}", answer.numbers), format!("{:?}", whole.numbers), "{at}");
                assert_eq!(answer.warnings, whole.warnings, "{at}");
                assert_eq!(answer.ratio, whole.ratio, "{at}");
                quick += usize::from(answer.solution.is_none() && answer.numbers.is_some());
                odd += usize::from(!answer.is_unique());
            });
        }
    }
    // Both ways were gone often enough to mean something.
    assert!(quick > 2000 && odd > 300, "{quick} {odd}");
}

/// What friction at rest leaves open is the same whether the forces are exact, as with given efficiencies alone, or found in
/// floating point, as with drags that are as good as none.
#[test]
fn what_friction_leaves_open_is_the_same_beside_a_vanishing_drag() {
    let mut compared = 0;
    for (file, text) in examples() {
        let given = subject(&text);
        if given.train().is_physical() || text.contains("[[drag]]") {
            continue;
        }
        let terminals = given.train().terminals().iter().map(|m| given.train().member_name(*m));
        let drags = terminals.map(|m| {
            format!("\n[[drag]]\nname = \"drag of {m}\"\nmembers = [\"{m}\", \"frame\"]\ncoulomb = \"1e-9 N m\"\n")
        });
        let with = subject(&(text.clone() + &drags.collect::<String>()));
        for operation in given.train().operations() {
            let [exact, floating] = [&given, &with].map(|m| PointAnswer::of(m.train(), operation));
            let (Some(exact), Some(floating)) = (exact.solution, floating.solution) else { continue };
            let open = |s: &SolutionReport| s.stiction.iter().map(|r| r.what.clone()).collect::<Vec<_>>();
            assert_eq!(open(&exact), open(&floating), "{file} {}", operation.name);
            for (a, b) in exact.stiction.iter().zip(&floating.stiction) {
                for (a, b) in [(a.low, b.low), (a.high, b.high)] {
                    let near = a.zip(b).map_or(a == b, |(a, b)| (a - b).abs() <= 1e-6 * a.abs().max(1e-3));
                    assert!(near, "{file} {}: {a:?} {b:?}", operation.name);
                }
                compared += 1;
            }
        }
    }
    assert!(compared > 5, "{compared}");
}

/// A column has its values whatever other columns are asked for: with none beyond the numbers of a point, or with all.
#[test]
fn a_column_is_the_same_beside_any_others() {
    for file in ["fva-planetary-stage", "two-speed-wet-brake", "industrial-planetary-heat", "prius-hybrid"] {
        let model = subject(&example(file));
        let over = match model.train().operations()[0].loads.is_empty() {
            true => vec!["input.speed=-900,700,1500 rpm"],
            false => vec!["input.speed=-900,700,1500 rpm", "input.torque=-40,0,3,150 N m"],
        };
        let [few, many] = [&["members"][..], &["all"]].map(|columns| sweep(&model, &over, columns, Hold::AsGiven));
        let [a, b] = [all(&few), all(&many)];
        for column in few.columns() {
            let [x, y] = [self::column(&few, &a, &column.name), self::column(&many, &b, &column.name)];
            assert_eq!(format!("{x:?}"), format!("{y:?}"), "{file} {}", column.name);
        }
    }
}
