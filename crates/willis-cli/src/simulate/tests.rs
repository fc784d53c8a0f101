use std::fs::File;

use serde_json::json;
use willis::dynamics::{Column, ColumnKind, Outcome, RunReport};

use super::{csv, early};

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
        "final_speeds_rad_s": { "sun": 100.0 },
        "energy": null,
        "assumptions": [],
        "notes": [],
        "scenario_end_s": 3.0,
        "event_count": 2,
    }))
    .expect("a report");
    report.outcome = outcome;
    report
}

fn columns() -> Vec<Column> {
    let column = |name: &str, kind: ColumnKind| {
        let of = name.split_once('.').map_or("", |n| n.1);
        serde_json::from_value(json!({ "name": name, "unit": kind.unit(), "kind": kind, "of": of })).expect("a column")
    };
    vec![
        column("time_s", ColumnKind::Time),
        column("sun.speed_rad_s", ColumnKind::Speed),
        column("P1,a.torque_n_m", ColumnKind::Torque),
        column("B.mode", ColumnKind::Mode),
    ]
}

/// A folder of its own for a test.
fn folder(name: &str) -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("willis-simulate-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
fn csv_is_whole_and_empty_where_nothing_is_determined() {
    let mut out = Vec::new();
    let mut rows = csv::Rows::new(&mut out);
    rows.columns(&columns()).unwrap();
    rows.row(&[0.0, -0.0, 0.0, 1.0]).unwrap();
    rows.row(&[1.0, 1e-9, f64::NAN, -1.0]).unwrap();
    rows.finish(None).unwrap();
    let text = String::from_utf8(out).unwrap();
    assert_eq!(text, "time_s,sun.speed_rad_s,\"P1,a.torque_n_m\",B.mode\n0,0,0,1\n1,1e-9,,-1\n");
}

#[test]
fn a_csv_of_a_run_that_ended_early_says_so_in_its_last_line() {
    for (outcome, last) in [
        (Outcome::Interrupted, "# interrupted at t = 1.25 s of 3 s: the run was interrupted"),
        (
            Outcome::NoSolution("two\nlines".into()),
            "# ended at t = 1.25 s of 3 s: the run jammed: no tooth forces fit the motion; two lines",
        ),
    ] {
        let mut out = Vec::new();
        let mut rows = csv::Rows::new(&mut out);
        rows.columns(&columns()).unwrap();
        rows.finish(Some(&early(&report(outcome, 1.25), 3.0))).unwrap();
        assert_eq!(String::from_utf8(out).unwrap().lines().last(), Some(last));
    }
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_reads_back_with_nulls_and_says_whether_it_is_complete() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    let folder = folder("parquet");
    let path = folder.join("run.parquet");
    // More than a row group.
    let rows = 70_000;
    for (outcome, complete) in [(Outcome::Finished, "true"), (Outcome::Interrupted, "false")] {
        let early = (outcome == Outcome::Interrupted).then_some("interrupted");
        let mut out = super::parquet::Rows::new(File::create(&path).unwrap());
        out.columns(&columns()).unwrap();
        for k in 0..rows {
            let torque = if k % 3 == 1 { f64::NAN } else { -0.1 * k as f64 };
            out.row(&[k as f64, 1.0, torque, 0.0]).unwrap();
        }
        out.finish(&report(outcome, 2.5), early).unwrap();
        let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
        let file = reader.metadata().file_metadata();
        assert_eq!((file.num_rows(), reader.num_row_groups()), (rows, 2));
        let told = file.key_value_metadata().expect("metadata");
        let value = |key: &str| told.iter().find(|k| k.key == key).and_then(|k| k.value.as_deref());
        assert_eq!((value("willis.complete"), value("willis.ended_s")), (Some(complete), Some("2.5")));
        assert!(value("willis.columns").is_some_and(|c| c.contains("rad/s")));
        assert_eq!(value("willis.outcome").is_some(), complete == "false");
        for (k, row) in reader.get_row_iter(None).unwrap().enumerate() {
            let row = row.unwrap();
            let all: Vec<_> = row.get_column_iter().map(|(name, field)| (name.as_str(), field.clone())).collect();
            assert_eq!(all[0], ("time_s", Field::Double(k as f64)));
            let torque = if k % 3 == 1 { Field::Null } else { Field::Double(-0.1 * k as f64) };
            assert_eq!(all[2], ("P1,a.torque_n_m", torque));
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}
