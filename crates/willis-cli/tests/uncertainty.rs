//! `willis uncertainty` as its user meets it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace")
}

fn run(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_willis"));
    command.arg("uncertainty").args(arguments).current_dir(root()).env("NO_COLOR", "1").env_remove("CLICOLOR_FORCE");
    command.output().expect("the binary runs")
}

fn answered(arguments: &[&str]) -> String {
    let output = run(arguments);
    let told = String::from_utf8(output.stderr).expect("text");
    assert_eq!((output.status.code(), told.as_str()), (Some(0), ""), "{arguments:?}");
    String::from_utf8(output.stdout).expect("text")
}

fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    assert!(output.stdout.is_empty());
    String::from_utf8(output.stderr).expect("text")
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&answered(arguments)).expect("JSON")
}

macro_rules! snapshot {
    ($text:expr) => {
        insta::with_settings!({ omit_expression => true }, { insta::assert_snapshot!($text); });
    };
}

const FVA: &str = "examples/fva-planetary-stage.toml";
const UTS: &str = "examples/uts-60-1161.toml";

#[test]
fn regress_uncertainty_alone() {
    snapshot!(answered(&[FVA, "--samples", "256"]));
}

#[test]
fn regress_uncertainty_of_given_efficiencies() {
    let vary = ["--vary", "P1.mesh_efficiency.external=normal(0.995, 0.001)", "--vary", "input.torque=+-5%"];
    snapshot!(answered(&[&[UTS], &vary[..], &["--samples", "256"]].concat()));
}

#[test]
fn regress_uncertainty_with_impossible_samples() {
    let vary = ["--vary", "P1.mesh_efficiency.external=0.98..1.005", "--vary", "P1.planet.count=3,4"];
    snapshot!(answered(&[&[UTS], &vary[..], &["--samples", "128"]].concat()));
}

#[test]
fn regress_uncertainty_wrong_questions() {
    let told: Vec<String> = [
        &[UTS, "--vary", "P1.mesh_eficiency=0.98..0.99"][..],
        &[UTS, "--vary", "P1.mesh_efficiency.external=norml(0.99, 0.001)"],
        &[UTS, "--vary", "P1.mesh_efficiency.external=0.99..0.98", "--vary", "input.torque=1..2 rpm"],
        &[UTS, "--laws", "mesh_fricton"],
        &[UTS, "--samples", "5"],
        &[UTS, "--operation", "none"],
        &[UTS, "--samples-out", "samples.txt"],
        &["examples/lossy-gear.toml", "--state", "x"],
    ]
    .iter()
    .map(|arguments| format!("$ willis uncertainty {}\n{}", arguments.join(" "), refused(arguments)))
    .collect();
    snapshot!(told.join("\n"));
}

#[test]
fn uncertainty_as_json_has_the_contract() {
    let all = json(&[FVA, "--samples", "128", "--format", "json"]);
    assert_eq!(all["format"], "willis-uncertainty-1");
    for key in ["train", "operation", "seed", "samples", "evaluations", "replicates", "verdicts", "seen", "warnings"] {
        assert!(!all[key].is_null(), "{key}");
    }
    let first = &all["outputs"][0];
    assert_eq!(first["name"], "efficiency");
    for key in ["mean", "standard_deviation", "median", "p025", "p05", "p95", "p975", "least", "most"] {
        let value = first["statistics"][key].as_f64().expect(key);
        assert!(value > 0.0 && value < 1.0, "{key}: {value}");
    }
    assert!(first["statistics"]["sampling_error"]["p95"].is_f64());
    let influence = &first["influences"][0];
    assert_eq!(influence["quantity"], "law.mesh_friction");
    for key in ["first", "first_error", "total", "total_error"] {
        assert!(influence[key].is_f64(), "{key}");
    }
    assert_eq!(all["quantities"][0]["likely"]["kind"], "uniform");
    assert!(all["choices"].as_array().expect("a list").len() > 3);
}

#[test]
fn uncertainty_is_the_same_for_the_same_seed() {
    let with = |seed: &str| answered(&[FVA, "--samples", "128", "--seed", seed, "--format", "csv"]);
    assert_eq!(with("3"), with("3"));
    assert_ne!(with("3"), with("4"));
    for table in ["# results\n", "# influences\n", "# choices\n", "# verdicts\n"] {
        assert!(with("3").contains(table), "{table}");
    }
}

#[test]
fn samples_are_written_and_not_over_others() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("uncertainty-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("samples.csv");
    let path = file.to_str().expect("text");
    let ask = [UTS, "--samples", "128", "--samples-out", path];
    answered(&ask);
    let text = std::fs::read_to_string(&file).expect("it was written");
    assert_eq!(text.lines().count(), 129);
    assert!(text.starts_with("sample,replicate,P1.mesh_efficiency.external,"), "{text}");
    assert!(refused(&ask).contains("--force"));
    answered(&[&ask[..], &["--force"]].concat());
    std::fs::remove_dir_all(&folder).expect("it goes");
}
