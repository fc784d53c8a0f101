use super::*;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::record::Field;
use serde_json::{Value, json};
use willis::train::SetSpec;

fn train() -> Train {
    Train::builder("reducer")
        .members(["sun", "ring", "carrier"])
        .terminals(["sun", "ring", "carrier"])
        .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
        .build()
        .expect("a train")
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("willis-simulate-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn files(folder: &Path) -> Vec<String> {
    let names = std::fs::read_dir(folder).expect("the folder").map(|e| e.expect("a file").file_name());
    let mut names: Vec<_> = names.map(|n| n.into_string().expect("text")).collect();
    names.sort();
    names
}

fn request(out: Option<PathBuf>) -> Request {
    Request { scenario: None, out, plot: None, columns: vec![], options: Options::default(), json: false }
}

fn report(outcome: Outcome, end: f64) -> RunReport {
    let mut report: RunReport = serde_json::from_value(json!({
        "format": "willis-simulation-1",
        "train": "reducer",
        "scenario": "launch",
        "outcome": { "verdict": "finished" },
        "start_s": 0.0,
        "end_s": end,
        "coordinates": ["sun"],
        "unique_for_every_load": true,
        "steps": 120,
        "events": [],
        "final_speeds_rad_s": { "sun": 100.0, "ring": 1e-14 },
        "energy": {
            "sources": [{ "name": "motor", "member": "sun", "energy_j": 1000.0, "in_j": 1000.0, "out_j": 0.0 }],
            "stored_j": 950.0,
            "losses": [
                { "name": "P1.sun-planet", "kind": "mesh", "energy_j": 20.0 },
                { "name": "B", "kind": "shift-element", "energy_j": 30.0 },
            ],
            "turned_over_j": 1000.0,
            "residual_j": 1e-7,
            "efficiency": null,
        },
        "assumptions": ["oil is warm"],
        "notes": [],
        "scenario_end_s": 3.0,
        "event_count": 2,
    }))
    .expect("a report");
    report.outcome = outcome;
    report
}

fn column(name: &str, kind: ColumnKind) -> Column {
    let of = name.split_once('.').map_or("", |n| n.1);
    serde_json::from_value(json!({ "name": name, "unit": kind.unit(), "kind": kind, "of": of })).expect("a column")
}

/// Rows up to some time of a run of 3 s; what breaks ends it.
fn feed(recorder: &mut dyn Recorder, rows: usize, end: f64) -> ControlFlow<()> {
    recorder.columns(&[
        column("time_s", ColumnKind::Time),
        column("speed.sun", ColumnKind::Speed),
        column("torque.P1,a", ColumnKind::Torque),
        column("mode.B", ColumnKind::Mode),
    ])?;
    for k in 0..rows {
        let t = end * k as f64 / (rows - 1) as f64;
        if k == rows / 2 {
            let event = json!({ "time_s": t, "cause": "brake B comes to rest", "modes": { "B": "stuck" } });
            recorder.event(&serde_json::from_value(event).expect("an event"))?;
        }
        let torque = if k % 3 == 1 { f64::NAN } else { -0.1 * k as f64 };
        let mode = if k < rows / 2 { 1.0 } else { 0.0 };
        recorder.sample(Sample { time_s: t, values: &[t, 1e-9 * k as f64, torque, mode] })?;
        recorder.progress(t)?;
    }
    ControlFlow::Continue(())
}

fn recorded(request: &Request, rows: usize, outcome: Outcome, end: f64) -> Result<Run, String> {
    let target = request.out.as_deref().map(Target::of).transpose()?;
    let engine = |r: &mut dyn Recorder| {
        let _ = feed(r, rows, end);
        Ok(report(outcome, end))
    };
    record(&train(), [0.0, 3.0], target, request, engine).map_err(|e| match e {
        Failure::Told(text) => text,
        Failure::Input(_) => "input".into(),
    })
}

#[test]
fn csv_is_streamed_and_whole() {
    let folder = folder("csv");
    let path = folder.join("run.csv");
    recorded(&request(Some(path.clone())), 4, Outcome::Finished, 3.0).expect("a run");
    let text = std::fs::read_to_string(&path).expect("written");
    let expected = "time_s,speed.sun,\"torque.P1,a\",mode.B\n0,0,0,1\n1,1e-9,,1\n2,2e-9,-0.2,0\n3,3.0000000000000004e-9,-0.30000000000000004,0\n";
    assert_eq!(text, expected);
    assert_eq!(files(&folder), ["run.csv"]);
}

#[test]
fn a_csv_of_a_run_that_ended_early_says_so_in_its_last_line() {
    let folder = folder("early");
    let path = folder.join("run.csv");
    std::fs::write(&path, "of yesterday").expect("written");
    recorded(&request(Some(path.clone())), 4, Outcome::Interrupted, 1.25).expect("a run");
    let text = std::fs::read_to_string(&path).expect("written");
    assert_eq!(text.lines().count(), 6);
    assert_eq!(text.lines().last(), Some("# interrupted at t = 1.25 s of 3 s: the run was interrupted"));
    recorded(&request(Some(path.clone())), 4, Outcome::NoSolution("two\nlines".into()), 1.25).expect("a run");
    let text = std::fs::read_to_string(&path).expect("written");
    let last = "# ended at t = 1.25 s of 3 s: the run jammed: no tooth forces fit the motion; two lines";
    assert_eq!(text.lines().last(), Some(last));
    assert_eq!(files(&folder), ["run.csv"]);
}

#[test]
fn parquet_reads_back_with_nulls_and_says_whether_it_is_complete() {
    let folder = folder("parquet");
    let path = folder.join("run.parquet");
    // More than a row group.
    let rows = 70_000;
    for (outcome, complete) in [(Outcome::Finished, "true"), (Outcome::Interrupted, "false")] {
        recorded(&request(Some(path.clone())), rows, outcome, 2.5).expect("a run");
        let reader = SerializedFileReader::new(File::open(&path).expect("written")).expect("parquet");
        let file = reader.metadata().file_metadata();
        assert_eq!((file.num_rows(), reader.num_row_groups()), (rows as i64, 2));
        let told = file.key_value_metadata().expect("metadata");
        let value = |key: &str| told.iter().find(|k| k.key == key).and_then(|k| k.value.as_deref());
        assert_eq!(value("willis.complete"), Some(complete));
        assert_eq!(value("willis.ended_s"), Some("2.5"));
        assert!(value("willis.columns").is_some_and(|c| c.contains("rad/s")));
        assert_eq!(value("willis.outcome").is_some(), complete == "false");
        for (k, row) in reader.get_row_iter(None).expect("rows").enumerate() {
            let row = row.expect("a row");
            let all: Vec<_> = row.get_column_iter().map(|(name, field)| (name.as_str(), field.clone())).collect();
            assert_eq!(all[0], ("time_s", Field::Double(2.5 * k as f64 / (rows - 1) as f64)));
            let torque = if k % 3 == 1 { Field::Null } else { Field::Double(-0.1 * k as f64) };
            assert_eq!(all[2], ("torque.P1,a", torque));
        }
    }
    assert_eq!(files(&folder), ["run.parquet"]);
}

#[test]
fn an_error_leaves_nothing_behind() {
    let folder = folder("error");
    for name in ["run.csv", "run.parquet"] {
        let out = request(Some(folder.join(name)));
        let target = Target::of(out.out.as_deref().expect("a file")).ok();
        let wrong = |r: &mut dyn Recorder| {
            let _ = feed(r, 10, 1.0);
            Err(Failure::Told("inertia is missing".into()))
        };
        assert!(record(&train(), [0.0, 3.0], target, &out, wrong).is_err());
        let unknown = Request { columns: vec!["velocity".into()], ..request(Some(folder.join(name))) };
        let told = recorded(&unknown, 4, Outcome::Interrupted, 0.0).err().expect("refused");
        assert!(told.contains("kinds (time, speed, torque, mode)") && told.contains("speed.sun"), "{told}");
        assert!(!told.contains("run."), "{told}");
    }
    assert!(files(&folder).is_empty(), "{:?}", files(&folder));
}

#[test]
fn only_csv_and_parquet_are_written() {
    for name in ["run.xlsx", "run", "run.csv.gz"] {
        let told = Target::of(Path::new(name)).err().expect("refused");
        assert!(told.contains(".csv or .parquet") && told.starts_with(name), "{told}");
    }
    assert!(Target::of(&std::env::temp_dir()).is_err());
}

#[test]
fn a_scenario_is_named_where_there_are_several() {
    assert_eq!(choose("reducer", &["launch"], None), Ok(0));
    assert_eq!(choose("reducer", &["launch", "stop"], Some("stop")), Ok(1));
    let several = choose("reducer", &["launch", "stop"], None).expect_err("refused");
    assert_eq!(several, "name one of the scenarios with --scenario: `launch`, `stop`\n");
    let unknown = choose("reducer", &["launch", "stop"], Some("brake")).expect_err("refused");
    assert_eq!(unknown, "there is no scenario `brake`; the scenarios are: `launch`, `stop`\n");
    assert!(choose("reducer", &[], None).expect_err("refused").contains("[[scenario]]"));
}

#[test]
fn columns_are_chosen_by_kind_and_by_name() {
    let folder = folder("columns");
    let path = folder.join("run.csv");
    let request = Request { columns: vec!["mode".into(), "speed.sun".into()], ..request(Some(path.clone())) };
    recorded(&request, 4, Outcome::Finished, 3.0).expect("a run");
    let text = std::fs::read_to_string(&path).expect("written");
    assert_eq!(text.lines().next(), Some("time_s,speed.sun,mode.B"));
    assert_eq!(text.lines().nth(2), Some("1,1e-9,1"));
}

#[test]
fn a_figure_is_drawn_beside_the_rows() {
    let folder = folder("figure");
    let path = folder.join("run.svg");
    let request = Request { plot: Some(path.clone()), ..request(Some(folder.join("run.csv"))) };
    recorded(&request, 400, Outcome::Finished, 3.0).expect("a run");
    let svg = std::fs::read_to_string(&path).expect("written");
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && svg.contains("Speed, rad/s"));
    assert_eq!(files(&folder), ["run.csv", "run.svg"]);
}

#[test]
fn json_has_rows_events_and_null_where_nothing_is_determined() {
    let run = recorded(&Request { json: true, ..request(None) }, 4, Outcome::Finished, 3.0).expect("a run");
    let all: Value = serde_json::from_str(&json(&run)).expect("json");
    assert_eq!(all["format"], "willis-simulation-1");
    assert_eq!(all["events"][0]["cause"], "brake B comes to rest");
    assert_eq!((&all["event_count"], &all["outcome"]["verdict"]), (&json!(2), &json!("finished")));
    assert_eq!(all["columns"][2]["name"], "torque.P1,a");
    assert_eq!(all["rows"][1], json!([1.0, 1e-9, null, 1.0]));
    let short = recorded(&request(None), 4, Outcome::Finished, 3.0).expect("a run");
    assert!(serde_json::from_str::<Value>(&json(&short)).expect("json").get("rows").is_none());
}

#[test]
fn the_text_has_the_answer_first_and_the_events_in_bounds() {
    let mut run = recorded(&request(None), 4, Outcome::NoSolution("both drive".into()), 1.5).expect("a run");
    run.report.events = vec![run.report.events[0].clone(); 50];
    run.report.event_count = 1234;
    let text = anstream::adapter::strip_str(&text(&run)).to_string();
    for words in [
        "Scenario: launch   0 to 3 s",
        "jammed: no tooth forces fit the motion, at t = 1.5 s of 3 s",
        "why          both drive",
        "an elastic [[shaft]]",
        "120 steps, 1233 changes of mode",
        "… and 1194 more, all in --format json",
        "closes to 1.0e-10 of the 1 kJ that came in",
        "oil is warm",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    assert!(text.lines().count() < 80);
    // By size.
    let places: Vec<_> =
        ["motor at sun", "stored in", "loss, shift element", "loss, mesh"].map(|w| text.find(w)).to_vec();
    assert!(places.windows(2).all(|w| w[0].is_some() && w[0] < w[1]), "{text}");
    assert!(text.lines().all(|l| l == l.trim_end()));
}
