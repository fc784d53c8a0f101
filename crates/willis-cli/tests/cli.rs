//! The command line as its user meets it: what it prints, and the exit status: 0 answered (also
//! when the train locks or jams), 1 wrong input, 2 wrong usage, 130 Ctrl-C.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace")
}

/// The binary, run in the folder of the workspace, without colours.
fn command(arguments: &[&str]) -> Command {
    let mut c = Command::new(env!("CARGO_BIN_EXE_willis"));
    c.args(arguments).current_dir(root()).stdin(Stdio::null()).env("NO_COLOR", "1").env_remove("CLICOLOR_FORCE");
    c
}

fn run(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the binary runs")
}

fn piped(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = command(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary runs");
    let mut stdin = child.stdin.take().expect("piped");
    let input = input.to_vec();
    // It may stop reading early; that is its right.
    let writer = std::thread::spawn(move || drop(stdin.write_all(&input)));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("no panic");
    output
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

/// Standard output of a run that answers, with nothing on standard error.
fn answered(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    assert_eq!(text(&output.stderr), "", "{arguments:?}");
    text(&output.stdout)
}

/// Standard error of a run that ends with `status`, with nothing on standard output.
fn refused(output: &Output, status: i32) -> String {
    assert_eq!(output.status.code(), Some(status), "{}{}", text(&output.stdout), text(&output.stderr));
    assert_eq!(text(&output.stdout), "");
    let message = text(&output.stderr);
    assert!(!message.trim().is_empty(), "silence");
    assert!(!message.contains("panicked"), "{message}");
    message
}

/// The residual of the power balance is round-off: its digits are not ours to promise.
fn mask_residual(text: &str) -> String {
    const BEFORE: &str = "balance closes to ";
    let mut parts = text.split(BEFORE);
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (number, rest) = part.split_once(" W\n").expect("a power ends the line");
        let residual: f64 = number.parse().expect("a number");
        assert!(residual < 1e-6, "the powers do not close: {residual} W");
        out += &format!("{BEFORE}[residual] W\n{rest}");
    }
    out
}

/// Whether a word is a number that is nothing but round-off.
fn round_off(word: &str) -> bool {
    word.contains("e-") && word.trim_matches([',', ';', '(', ')']).parse::<f64>().is_ok_and(|x| x.abs() < 1e-9)
}

/// A text for a snapshot, without digits that another machine may round otherwise.
fn mask(text: &str) -> String {
    let masked = |line: &str| {
        line.split(' ').map(|w| if round_off(w) { "[round-off]" } else { w }).collect::<Vec<_>>().join(" ")
    };
    mask_residual(text).lines().map(|l| masked(l) + "\n").collect()
}

/// Decimal numbers of more than twelve digits, rounded to twelve.
fn round(text: &str) -> String {
    let rounded = |word: &str| match word.parse::<f64>() {
        Ok(x) if word.contains('.') && word.len() > 13 => {
            let x: f64 = format!("{x:.11e}").parse().expect("a number");
            format!("{x:?}")
        }
        _ => word.to_owned(),
    };
    text.lines().map(|l| l.split(',').map(rounded).collect::<Vec<_>>().join(",") + "\n").collect()
}

macro_rules! snapshot {
    ($text:expr) => {
        insta::with_settings!({ omit_expression => true }, { insta::assert_snapshot!($text); });
    };
}

/// A folder for files that a test writes.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn path(p: &Path) -> &str {
    p.to_str().expect("text")
}

// ---- analyze, for eyes -----------------------------------------------------------------------

#[test]
fn regress_analyze_prius() {
    snapshot!(mask(&answered(&["analyze", "examples/prius-p112.toml"])));
}

#[test]
fn regress_analyze_zf_8hp70() {
    snapshot!(mask(&answered(&["analyze", "examples/zf-8hp70.toml"])));
}

#[test]
fn regress_analyze_wolfrom() {
    snapshot!(mask(&answered(&["analyze", "examples/wolfrom-498-self-locking.toml"])));
}

#[test]
fn regress_analyze_two_efficiencies() {
    snapshot!(mask(&answered(&["analyze", "examples/two-efficiencies.toml"])));
}

#[test]
fn regress_analyze_one_operation_of_one_state() {
    let all = ["analyze", "examples/zf-8hp70.toml", "--state", "8", "--operation", "motorway cruise"];
    snapshot!(mask(&answered(&all)));
}

#[test]
fn regress_no_round_off_but_the_residual() {
    for entry in std::fs::read_dir(root().join("examples")).expect("examples") {
        let file = entry.expect("an entry").path();
        if file.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let shown = mask_residual(&answered(&["analyze", path(&file)]));
        let found = shown.split_whitespace().find(|w| round_off(w));
        assert_eq!(found, None, "{}", file.display());
    }
}

#[test]
fn regress_analyze_with_losses() {
    let args = ["analyze", "examples/fva-planetary-stage.toml", "--operation", "rated"];
    snapshot!(mask(&answered(&args)));
}

#[test]
fn regress_losses_over_speed_and_temperature() {
    let shown = answered(&[
        "losses",
        "examples/fva-planetary-stage.toml",
        "--operation",
        "rated",
        "--speeds",
        "500rpm,3000rpm",
        "--temperature",
        "40degC,90degC",
    ]);
    snapshot!(shown);
}

#[test]
fn regress_losses_law_beside_law() {
    let file = "examples/fva-planetary-stage.toml";
    snapshot!(answered(&["losses", file, "--operation", "rated", "--compare", "mesh_friction"]));
}

#[test]
fn regress_sensitivity_of_a_stage() {
    let args = ["sensitivity", "examples/fva-planetary-stage.toml", "--operation", "rated"];
    snapshot!(mask(&answered(&args)));
}

#[test]
fn regress_sensitivity_of_a_power_split_as_a_table() {
    let file = "examples/prius-p112.toml";
    let args = ["sensitivity", file, "--operation", "overdrive, mg1 motors", "--format", "csv"];
    let shown = answered(&args);
    let rows: Vec<&str> = shown.lines().collect();
    assert!(rows[0].starts_with("operation,verdict,quantity,value,unit,assumed,step,step_size,efficiency_derivative"));
    assert_eq!(rows.len(), 6);
    assert!(rows[1].starts_with("\"overdrive, mg1 motors\",unique,P1.mesh_efficiency.external,0.98,-,false,+1 %,"));
}

#[test]
fn regress_sensitivity_without_one_equilibrium() {
    snapshot!(mask(&answered(&["sensitivity", "examples/two-efficiencies.toml"])));
}

#[test]
fn sensitivity_answers_machines_and_refuses_what_is_not_there() {
    let file = "examples/fva-planetary-stage.toml";
    let all = parsed(&["sensitivity", file, "--law", "bearing=palmgren", "--format", "json"]);
    assert_eq!(all["format"], "willis-sensitivity-1");
    assert_eq!(all["operations"].as_array().map(Vec::len), Some(3));
    let first = &all["operations"][0]["quantities"][0];
    assert_eq!(first["name"], "P1.geometry.pressure_angle");
    assert_eq!(first["unit"], "rad");
    assert_eq!(first["step"], "degree");
    assert!(first["loss_derivative_w"].as_f64().is_some_and(|x| x < 0.0));
    assert!(wrong(&["sensitivity", file, "--operation", "ratd"]).contains("did you mean `rated`?"));
    assert!(wrong(&["sensitivity", file, "--state", "1"]).contains("has no state `1`"));
    assert!(wrong(&["sensitivity", "examples/zf-4hp22.toml"]).contains("sensitivities belong to an operating point"));
}

/// Answers of a command in JSON.
fn parsed(arguments: &[&str]) -> Value {
    serde_json::from_str(&answered(arguments)).expect("JSON")
}

/// Standard error of a command that is refused.
fn wrong(arguments: &[&str]) -> String {
    refused(&run(arguments), 1)
}

#[test]
fn a_point_of_the_loss_table_equals_the_analysis_bit_for_bit() {
    let file = "examples/fva-planetary-stage.toml";
    let table = parsed(&["losses", file, "--operation", "rated", "--speeds", "1500rpm", "--format", "json"]);
    let analysis = parsed(&["analyze", file, "--operation", "rated", "--format", "json"]);
    let point = &table["points"][0];
    let solution = &analysis["operations"][0]["solutions"][0];
    for key in ["efficiency", "loss_w", "losses_w", "sources"] {
        assert_eq!(point[key], solution[key], "{key}");
    }
}

#[test]
fn a_law_is_chosen_by_name() {
    let file = "examples/fva-planetary-stage.toml";
    let of = |law: &str| {
        let law = format!("mesh_friction={law}");
        let all = parsed(&["analyze", file, "--operation", "rated", "--law", &law, "--format", "json"]);
        all["operations"][0]["solutions"][0]["sources"][0]["law"].as_str().expect("a law").to_owned()
    };
    for law in ["schlenk", "niemann", "xu-kahraman"] {
        assert_eq!(of(law), law);
    }
    let told = wrong(&["analyze", file, "--law", "mesh_friction=schlenck"]);
    assert!(told.contains("did you mean `schlenk`?"), "{told}");
    let told = wrong(&["analyze", file, "--law", "mesh_fricton=schlenk"]);
    assert!(told.contains("did you mean `mesh_friction`?"), "{told}");
    assert!(wrong(&["analyze", file, "--law", "schlenk"]).contains("family=law"));
}

#[test]
fn losses_refuse_what_makes_no_question() {
    let file = "examples/fva-planetary-stage.toml";
    for (args, said) in [
        (vec!["--operation", "ratd"], "did you mean `rated`?"),
        (vec!["--speeds", "1500"], "unit is missing"),
        (vec!["--speeds", "10 N m"], "measures a torque"),
        (vec!["--temperature", "9000 degC"], "none that a gearbox has"),
        (vec!["--compare", "mesh_frictions"], "did you mean `mesh_friction`?"),
    ] {
        let told = wrong(&[&["losses", file][..], &args].concat());
        assert!(told.contains(said), "{args:?}: {told}");
    }
    let none = wrong(&["losses", "examples/ford-aod.toml"]);
    assert!(none.contains("there is none"), "{none}");
    let dry = wrong(&["losses", "examples/zf-8hp70.toml", "--temperature", "60degC"]);
    assert!(dry.contains("no oil"), "{dry}");
}

#[test]
fn every_law_and_every_oil_is_listed() {
    let all = answered(&["laws"]);
    for name in ["schlenk (default)", "benedict-kelley", "skf (default)", "changenet-2011", "confirm:"] {
        assert!(all.contains(name), "{name}");
    }
    let one = answered(&["laws", "--family", "seal"]);
    assert!(one.contains("simrit") && !one.contains("schlenk"));
    assert!(wrong(&["laws", "--family", "seals"]).contains("the families are"));
    let listed = parsed(&["laws", "--format", "json"]);
    assert_eq!(listed["format"], "willis-laws-1");
    assert!(listed["laws"].as_array().expect("a list").len() > 40);
    assert!(answered(&["laws", "--oils"]).contains("ISO VG 220"));
    assert!(answered(&["laws", "--bearings"]).contains("NU 1022"));
    assert!(answered(&["laws", "--format", "csv"]).starts_with("family,law,"));
}

#[test]
fn regress_no_blanks_at_line_ends() {
    for file in ["prius-p112", "zf-8hp70", "two-efficiencies", "fva-planetary-stage"] {
        let shown = answered(&["analyze", &format!("examples/{file}.toml")]);
        let trailing = shown.lines().find(|l| l.ends_with([' ', '\t']));
        assert_eq!(trailing, None, "blanks at the end of a line");
    }
}

#[test]
fn regress_colours() {
    let colour = |when: &str| {
        let output =
            command(&["analyze", "examples/textbook-reverted.toml", "--color", when]).env_remove("NO_COLOR").output();
        text(&output.expect("the binary runs").stdout).contains('\u{1b}')
    };
    assert!(colour("always"));
    assert!(!colour("never"));
    assert!(!colour("auto"), "a pipe is no terminal");
}

#[test]
fn regress_the_file_paints_nothing() {
    // Escape sequences in the free texts of a file do not reach the terminal.
    let train = "format = 1\nname = \"\\u001b[31mred\"\nsource = \"\\u001b[32mgreen\"\nmembers = [\"a\", \"b\"]\nterminals = [\"a\", \"b\"]\n\
                 [[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]\n";
    let output = piped(&["analyze", "-", "--color", "always"], train.as_bytes());
    let shown = text(&output.stdout) + &text(&output.stderr);
    assert!(!shown.contains("\u{1b}[31m") && !shown.contains("\u{1b}[32m"), "{shown:?}");
}

// ---- regimes, formulas, places ----------------------------------------------------------------

#[test]
fn regress_regimes_prius() {
    snapshot!(answered(&["regimes", "examples/prius-p112.toml"]));
}

#[test]
fn regress_regimes_band() {
    snapshot!(answered(&["regimes", "examples/esmail-fig1-band.toml", "--state", "as drawn"]));
}

#[test]
fn regress_regimes_automatic() {
    snapshot!(answered(&["regimes", "examples/zf-4hp22.toml"]));
}

#[test]
fn regress_regimes_family() {
    snapshot!(answered(&["regimes", "examples/esmail-table-1.toml", "--family"]));
}

#[test]
fn regress_regimes_balance() {
    snapshot!(answered(&["regimes", "examples/compound-split.toml", "--balance", "mg_a,mg_b"]));
}

#[test]
fn regress_regimes_for_machines() {
    for extra in [&["--format", "json"][..], &["--family", "--format", "json"], &["--format", "map-json"]] {
        let arguments = [&["regimes", "examples/esmail-table-1.toml"][..], extra].concat();
        let value: Value = serde_json::from_str(&answered(&arguments)).expect("JSON");
        assert!(value.is_object());
    }
    let json: Value =
        serde_json::from_str(&answered(&["regimes", "examples/esmail-fig1.toml", "--format", "json"])).expect("JSON");
    assert_eq!(json["format"], "willis-regimes-1");
    assert_eq!(json["states"][0]["regimes"].as_array().map(Vec::len), Some(16));
    let csv = answered(&["regimes", "examples/esmail-fig1.toml", "--state", "as drawn", "--format", "csv"]);
    assert_eq!(csv.lines().count(), 17);
    let width = csv.lines().next().map(|l| l.split(',').count());
    assert!(csv.lines().all(|l| !l.contains('"') || l.len() > 20), "{csv}");
    assert_eq!(width, Some(17));
}

#[test]
fn regress_formula_text() {
    snapshot!(answered(&["formula", "examples/zf-8hp70.toml", "--state", "2", "--derivatives"]));
}

#[test]
fn regress_formula_teeth() {
    let text = answered(&["formula", "examples/wolfrom-236.toml", "--ratios", "teeth", "--efficiencies", "meshes"]);
    snapshot!(text);
}

#[test]
fn regress_formula_locked() {
    let text = answered(&[
        "formula",
        "examples/esmail-fig1-band.toml",
        "--state",
        "link 4 held",
        "--from",
        "sun1",
        "--to",
        "carrier2",
    ]);
    assert!(text.contains("locked: friction lets sun1 drive no load at carrier2"), "{text}");
}

#[test]
fn regress_locate() {
    let point = ["--speeds", "engine=2000rpm,ring=1000 rpm", "--torques", "engine=100 N m"];
    snapshot!(answered(&[&["locate", "examples/prius-p112.toml"][..], &point].concat()));
}

#[test]
fn regress_locate_several() {
    let point = ["--speeds", "sun1=100rpm,sun4=98rpm", "--torques", "carrier2=1Nm"];
    snapshot!(answered(&[&["locate", "examples/esmail-fig1-band.toml"][..], &point].concat()));
}

#[test]
fn regress_locate_on_a_boundary() {
    snapshot!(answered(&["locate", "examples/prius-p112.toml", "--operation", "block rotation at 1500 rpm"]));
}

#[test]
fn regress_wrong_questions() {
    let prius = "examples/prius-p112.toml";
    let questions: [&[&str]; 12] = [
        &["regimes", prius, "--state", "mg1 hold"],
        &["regimes", prius, "--terminals", "mg1,mg1,engin,frame"],
        &["regimes", prius, "--balance", "mg1"],
        &["regimes", "examples/zf-8hp70.toml", "--map", "nowhere.svg"],
        &["regimes", "examples/zf-8hp70.toml", "--family"],
        &["formula", prius, "--from", "wheel"],
        &["formula", prius, "--regime", "99+"],
        &["locate", prius],
        &["locate", prius, "--speeds", "engine=1000rpm,mg1=0rpm,ring=0rpm", "--torques", "engine=1Nm"],
        &["locate", prius, "--speeds", "engine=1000,mg1:2rpm", "--torques", "engine=1Nm"],
        &["locate", prius, "--speeds", "engine=1000rpm,mg1=5rpm"],
        &["locate", prius, "--operation", "acceleration, mg1 generates", "--torques", "ring=5Nm"],
    ];
    let mut all = String::new();
    for question in questions {
        let message = refused(&run(question), 1);
        all += &format!("willis {}\n{message}\n", question.join(" "));
    }
    snapshot!(all);
}

#[test]
fn regress_map_is_whole_or_not_there() {
    let folder = folder("map");
    let file = folder.join("wheel.svg");
    let map = ["regimes", "examples/prius-p112.toml", "--map", path(&file)];
    assert!(answered(&map).contains("16 regimes"));
    let svg = std::fs::read_to_string(&file).expect("written");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    let missing = folder.join("missing").join("wheel.svg");
    refused(&run(&["regimes", "examples/prius-p112.toml", "--map", path(&missing)]), 1);
    refused(&run(&["regimes", "examples/prius-p112.toml", "--map", path(&folder)]), 1);
    let left: Vec<_> = std::fs::read_dir(&folder).expect("the folder").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

// ---- analyze, for machines -----------------------------------------------------------------

#[test]
fn regress_csv_states() {
    snapshot!(round(&answered(&["analyze", "examples/zf-8hp70.toml", "--format", "csv", "--table", "states"])));
}

#[test]
fn regress_csv_all_tables() {
    let all = answered(&["analyze", "examples/zf-8hp70.toml", "--format", "csv"]);
    let headings: Vec<_> = all.lines().filter(|l| l.starts_with("# ")).collect();
    assert_eq!(headings, ["# states", "# operations", "# members", "# meshes", "# shift-elements", "# diagnostics"]);
    for heading in headings {
        let name = heading.trim_start_matches("# ");
        let one = answered(&["analyze", "examples/zf-8hp70.toml", "--format", "csv", "--table", name]);
        assert!(all.contains(&format!("{heading}\n{one}")), "{name}");
        // Every row has as many fields as the header; quoted fields hold commas.
        let fields = |line: &str| line.split('"').step_by(2).map(|p| p.matches(',').count()).sum::<usize>();
        let mut lines = one.lines();
        let header = fields(lines.next().expect("a header"));
        assert!(lines.all(|l| fields(l) == header), "{one}");
    }
}

#[test]
fn regress_csv_quotes() {
    let train = "format = 1\nname = \"x\"\nmembers = [\"a, \\\"b\\\"\", \"c\"]\nterminals = [\"a, \\\"b\\\"\", \"c\"]\n\
                 [[mesh]]\ngears = [ { member = \"a, \\\"b\\\"\", teeth = 20 }, { member = \"c\", teeth = 40 } ]\n";
    let output = piped(&["analyze", "-", "--format", "csv", "--table", "states"], train.as_bytes());
    assert!(text(&output.stdout).contains("as drawn,,\"a, \"\"b\"\"\",c,1,-2/1,-2,"), "{}", text(&output.stdout));
}

fn json(arguments: &[&str]) -> Value {
    let mut all = vec!["analyze"];
    all.extend(arguments);
    all.extend(["--format", "json"]);
    serde_json::from_str(&answered(&all)).expect("JSON")
}

fn has(value: &Value, keys: &[&str]) {
    let object = value.as_object().expect("an object");
    for key in keys {
        assert!(object.contains_key(*key), "no `{key}` in {:?}", object.keys().collect::<Vec<_>>());
    }
}

/// The contract of section 4 of the design: names exactly, additions allowed.
#[test]
fn regress_json_contract() {
    for file in ["zf-8hp70", "prius-p112", "wolfrom-498-self-locking", "two-efficiencies", "locked-both-ways"] {
        let a = json(&[&format!("examples/{file}.toml")]);
        has(&a, &["format", "train", "degrees_of_freedom", "ratios", "operations", "diagnostics"]);
        assert_eq!(a["format"], "willis-analysis-1");
        assert!(a["train"].is_string() && a["degrees_of_freedom"].is_u64());
        for row in a["ratios"].as_object().expect("an object").values() {
            has(row, &["input", "output", "exact", "value"]);
            let exact = row["exact"].as_str().expect("every state of these has a ratio");
            let (p, q) = exact.split_once('/').expect("p/q");
            let ratio = p.parse::<f64>().expect("an integer") / q.parse::<f64>().expect("an integer");
            assert!((ratio - row["value"].as_f64().expect("a number")).abs() <= 1e-12 * ratio.abs());
        }
        for o in a["operations"].as_array().expect("a list") {
            has(o, &["name", "state", "verdict", "certificate", "solutions"]);
            let verdict = o["verdict"].as_str().expect("a text");
            assert!(["unique", "multiple", "locked", "unloaded", "undetermined"].contains(&verdict), "{verdict}");
            has(&o["certificate"], &["unique_for_every_load", "method"]);
            assert!(o["certificate"]["unique_for_every_load"].is_boolean());
            let method = o["certificate"]["method"].as_str().expect("a text");
            assert!(["spectral-radius", "determinants", "enumeration", "undecided"].contains(&method), "{method}");
            for s in o["solutions"].as_array().expect("a list") {
                has(
                    s,
                    &[
                        "efficiency",
                        "input_power_w",
                        "output_power_w",
                        "loss_w",
                        "power_residual_w",
                        "members",
                        "meshes",
                        "losses_w",
                    ],
                );
                has(&s["losses_w"], &["mesh", "bearing", "windage", "churning", "seal"]);
                for m in s["members"].as_object().expect("an object").values() {
                    has(m, &["speed_rad_s", "torque_n_m", "power_w", "role"]);
                    let role = m["role"].as_str().expect("a text");
                    assert!(["input", "output", "fixed", "idle"].contains(&role), "{role}");
                }
                for m in s["meshes"].as_object().expect("an object").values() {
                    has(m, &["driver", "relative_speed_rad_s", "potential_power_w", "efficiency", "loss_w"]);
                }
            }
        }
        for d in a["diagnostics"].as_array().expect("a list") {
            has(d, &["code", "severity", "place", "message", "hints"]);
            assert!(d["hints"].is_array());
            assert!(["error", "warning", "note"].contains(&d["severity"].as_str().expect("a text")));
        }
    }
}

#[test]
fn regress_json_verdicts() {
    let verdicts = |file: &str| -> Vec<String> {
        let a = json(&[&format!("examples/{file}.toml")]);
        a["operations"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|o| o["verdict"].as_str().expect("a text").to_owned())
            .collect()
    };
    assert_eq!(verdicts("wolfrom-498-self-locking"), ["unique", "locked"]);
    assert_eq!(verdicts("two-efficiencies"), ["multiple"]);
    let null = json(&["examples/two-efficiencies.toml"]);
    assert!(null["operations"][0]["state"].is_null());
    assert_eq!(null["ratios"]["as drawn"]["exact"], "157/120");
}

// ---- The other commands ----------------------------------------------------------------------

#[test]
fn regress_validate() {
    snapshot!(answered(&["validate"]));
}

#[test]
fn regress_validate_wang_2020() {
    snapshot!(answered(&["validate", "wang-2020"]));
}

#[test]
fn regress_validate_json() {
    let json = |arguments: &[&str]| -> Value {
        let all = [&["validate", "--format", "json"], arguments].concat();
        serde_json::from_str(&answered(&all)).expect("JSON")
    };
    let listed = json(&[]);
    assert_eq!(listed["format"], "willis-cases-1");
    let names: Vec<_> = listed["cases"].as_array().unwrap().iter().map(|c| c["name"].clone()).collect();
    assert_eq!(names, ["wang-2020", "losses", "galvagno", "design"]);
    for case in ["wang-2020", "losses", "galvagno", "design"] {
        let report = json(&[case]);
        assert_eq!(report["format"], "willis-validation-1");
        has(&report["sections"][0], &["title", "text", "columns", "rows", "points"]);
        has(&report["gates"][0], &["what", "printed", "ours", "low", "high", "holds", "cause"]);
    }
}

#[test]
fn regress_validate_data() {
    let folder = folder("curves");
    assert!(answered(&["validate", "wang-2020", "--data", path(&folder)]).contains("Wang"));
    let files = std::fs::read_dir(&folder).expect("the folder").count();
    assert_eq!(files, 6);
}

#[test]
fn regress_validate_unknown() {
    let said = refused(&command(&["validate", "wang-2021"]).output().expect("the binary runs"), 1);
    assert!(said.contains("wang-2020, losses, galvagno, design"), "{said}");
    let said = refused(&command(&["validate", "losses", "--data", "."]).output().expect("the binary runs"), 1);
    assert!(said.contains("has no curves"), "{said}");
}

#[test]
fn regress_check_good() {
    snapshot!(answered(&["check", "examples/zf-8hp70.toml"]));
}

#[test]
fn regress_check_counts_one() {
    let shown = answered(&["check", "examples/two-efficiencies.toml"]);
    assert!(!shown.contains("1 operations"), "{shown}");
}

#[test]
fn regress_check_bad() {
    let folder = folder("check");
    let mut train = std::fs::read_to_string(root().join("examples/prius-p112.toml")).expect("an example");
    for (old, new) in
        [("ring = {", "rong = {"), ("\"hold-ring\"]", "\"hold-rong\"]"), ("members = [\"mg1\"]", "members = [\"mg2\"]")]
    {
        assert_eq!(train.matches(old).count(), 1, "{old}");
        train = train.replace(old, new);
    }
    std::fs::write(folder.join("bad.toml"), train).expect("written");
    let output = command(&["check", "bad.toml"]).current_dir(&folder).output().expect("the binary runs");
    snapshot!(refused(&output, 1));
}

// ---- export ---------------------------------------------------------------------------------

#[test]
fn regress_export_list() {
    let list = answered(&["export", "list"]);
    assert_eq!(list, answered(&["export"]));
    snapshot!(list);
}

#[test]
fn every_way_to_ask_names_the_same_exports() {
    let list = answered(&["export", "list"]);
    let told: Vec<&str> = list.lines().filter_map(|l| l.split_whitespace().next()).collect();
    let words = |value: &Value| -> Vec<String> {
        value.as_array().into_iter().flatten().filter_map(|v| v.as_str().map(str::to_owned)).collect()
    };
    let json: Value = serde_json::from_str(&answered(&["export", "list", "--format", "json"])).expect("JSON");
    let kinds = json["kinds"].as_array().expect("kinds");
    let named: Vec<&str> = kinds.iter().map(|k| k["name"].as_str().expect("a name")).collect();
    assert_eq!(named, told);
    // One of them packs a library, which only the program can.
    let only: Vec<&str> =
        kinds.iter().filter(|k| k["program_only"] == true).filter_map(|k| k["name"].as_str()).collect();
    assert_eq!(only, ["fmu"]);
    let request: Value = serde_json::from_str(&answered(&["schema", "export", "--request"])).expect("a schema");
    let with_list: Vec<&str> = told.iter().copied().chain(["list"]).collect();
    assert_eq!(words(&request["properties"]["kind"]["enum"]), with_list);
    let hint = refused(&run(&["export", "vekto", "examples/zf-8hp70.toml"]), 1);
    assert!(hint.contains(&format!("the exports are: {}", told.join(", "))), "{hint}");
    let completions = answered(&["completions", "bash"]);
    assert!(told.iter().all(|k| completions.contains(k)));
    // The types of Python.
    let python = std::fs::read_to_string(root().join("crates/willis-py/python/willis/_questions.py")).expect("a file");
    let names: Vec<String> = with_list.iter().map(|k| format!("\"{k}\"")).collect();
    assert!(python.contains(&format!("kind: Literal[{}] | None", names.join(", "))), "{names:?}");
}

/// Standard output and notes of an export that answers.
fn exported(arguments: &[&str]) -> String {
    let output = run(&[&["export"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    let told = text(&output.stderr);
    assert!(told.lines().all(|l| l.starts_with("note: ") || l.starts_with("      ")), "{told}");
    format!("{}---\n{told}", text(&output.stdout))
}

#[test]
fn regress_export_vecto() {
    let grid = ["--speeds", "500rpm..1000rpm:2", "--torques=-100 N m..200 N m:4"];
    snapshot!(exported(&[&["vecto", "examples/zf-8hp70.toml", "--state", "1"][..], &grid].concat()));
}

#[test]
fn regress_export_loss_table() {
    snapshot!(exported(&["modelica-loss-table", "examples/zf-8hp70.toml", "--all-states"]));
}

#[test]
fn regress_export_blocks() {
    let all = ["mujoco", "drake", "openfast", "simscape"].map(|kind| exported(&[kind, "examples/wolfrom-236.toml"]));
    snapshot!(all.join("\n"));
    snapshot!(exported(&["mujoco", "examples/wolfrom-498-self-locking.toml"]));
}

#[test]
fn regress_export_modelica() {
    snapshot!(exported(&["modelica", "examples/zf-8hp70.toml"]));
}

#[test]
fn regress_export_csv() {
    let grid = ["--speeds", "1000rpm,3000rpm", "--torques=-1 N m..1 N m:3"];
    snapshot!(exported(&[&["csv", "examples/wolfrom-498-self-locking.toml"][..], &grid].concat()));
}

#[test]
fn units_hold_a_library_that_is_named() {
    let folder = folder("fmu");
    let (library, unit) = (folder.join("library.so"), folder.join("launch.fmu"));
    let other = folder.join("other.fmu");
    let all = ["export", "fmu", "examples/launch.toml", "--library", path(&library), "-o", path(&unit)];
    let mark: &[u8] = match std::env::consts::OS {
        "windows" => b"MZ",
        "macos" => &[0xcf, 0xfa, 0xed, 0xfe],
        _ => b"\x7fELF",
    };
    // What begins as no library does, or has not what a host calls first.
    for (begin, name) in [(&b"root:x:0:0"[..], "fmi2Instantiate"), (mark, "fmi2Initiate"), (&[], "")] {
        std::fs::write(&library, [begin, name.as_bytes()].concat()).expect("written");
        let told = refused(&run(&all), 1);
        let wanted = format!("{} is no runtime of an FMU; build it: cargo build --release", path(&library));
        assert!(told.contains(&wanted), "{told}");
        assert!(!unit.exists());
    }
    std::fs::write(&library, [mark, b"not a library, but bytes: fffmi2Instantiate"].concat()).expect("written");
    let output = run(&all);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(
        text(&output.stdout).contains("scenario `start and lift off`, FMI 2.0, 2 inputs"),
        "{}",
        text(&output.stdout)
    );
    assert!(std::fs::read(&unit).expect("a file").starts_with(b"PK"));
    assert!(refused(&run(&all), 1).contains("--force replaces it"));
    let three = run(&[&all[..], &["--fmi", "3", "--kind", "me", "--force"]].concat());
    assert!(text(&three.stdout).contains("FMI 3.0"), "{}", text(&three.stdout));
    let missing = [&all[..4], &["nowhere.so", "-o", path(&other)]].concat();
    assert!(refused(&run(&missing), 1).contains("nowhere.so"));
    assert!(refused(&run(&all[..3]), 1).contains("name a file with -o"));
    let still = ["export", "fmu", "examples/zf-8hp70.toml", "--library", path(&library), "-o", path(&other)];
    assert!(refused(&run(&still), 1).contains("no scenario"));
    let several = [&["export", "fmu", "examples/shift-8hp70.toml"], &still[3..]].concat();
    assert!(refused(&run(&several), 1).contains("name one of them"));
    refused(&run(&["export", "csv", "examples/zf-8hp70.toml", "--fmi", "2"]), 2);
    refused(&run(&[&all[..], &["--speeds", "1000rpm"]].concat()), 2);
}

#[test]
fn exports_are_whole_and_do_not_overwrite() {
    let folder = folder("export");
    let gears = folder.join("gears");
    let all = ["export", "vecto", "examples/zf-8hp70.toml", "--all-states"];
    let many = refused(&run(&all), 1);
    assert!(many.contains("this makes 8 files"), "{many}");
    let into = [&all[..], &["-o", path(&gears)]].concat();
    let output = run(&into);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(text(&output.stdout).lines().count(), 8);
    assert!(text(&output.stdout).contains("zf-8hp70-1.vtlm: state 1, gear ratio 4.69565"), "{}", text(&output.stdout));
    assert_eq!(std::fs::read_dir(&gears).expect("the folder").count(), 8);
    let there = refused(&run(&into), 1);
    assert!(there.contains("is there already; --force replaces it"), "{there}");
    assert_eq!(run(&[&into[..], &["--force"]].concat()).status.code(), Some(0));
    let file = folder.join("gear.xml");
    let one = ["export", "mujoco", "examples/wolfrom-236.toml", "-o", path(&file)];
    assert_eq!(run(&one).status.code(), Some(0));
    assert_eq!(std::fs::read_to_string(&file).expect("written"), text(&run(&one[..3]).stdout));
    refused(&run(&one), 1);
    let missing = folder.join("missing").join("gear.xml");
    refused(&run(&[&one[..3], &["-o", path(&missing)]].concat()), 1);
    assert!(!missing.exists());
}

#[test]
fn regress_export_wrong_questions() {
    let zf = "examples/zf-8hp70.toml";
    let questions: [&[&str]; 12] = [
        &["export", "vekto", zf, "--state", "1"],
        &["export", "vecto", zf],
        &["export", "vecto", zf, "--state", "9"],
        &["export", "vecto", zf, "--state", "R"],
        &["export", "vecto", "examples/wolfrom-498-self-locking.toml"],
        &["export", "csv", "examples/galvagno.toml"],
        &["export", "csv", zf, "--state", "1", "--speeds", "500..2000:4"],
        &["export", "csv", zf, "--state", "1", "--speeds", "500rpm..2000rpm"],
        &["export", "csv", zf, "--state", "1", "--speeds", "2000rpm..500rpm:4"],
        &["export", "csv", zf, "--state", "1", "--torques", "1Nm..2Nm:1"],
        &["export", "csv", zf, "--state", "1", "--torques", "2Nm,1Nm"],
        &["export", "csv", zf, "--state", "1", "--temperature", "60degC"],
    ];
    let mut all = String::new();
    for question in questions {
        let message = refused(&run(question), 1);
        all += &format!("willis {}\n{message}\n", question.join(" "));
    }
    snapshot!(all);
    let usage = refused(&run(&["export", "vecto"]), 1);
    assert!(usage.contains("name a train file after the kind of export"), "{usage}");
}

#[test]
fn regress_explain() {
    snapshot!(answered(&["explain", "E106"]));
    assert_eq!(answered(&["explain", "e106"]), answered(&["explain", "E106"]));
}

#[test]
fn regress_explain_all() {
    let list = answered(&["explain"]);
    for code in willis::diagnostic::Code::ALL {
        assert!(list.lines().any(|l| l.starts_with(code.as_str()) && l.ends_with(code.title())), "{code}");
        let long = answered(&["explain", code.as_str()]);
        // Below the title stands what it means or what to do.
        assert!(long.starts_with(code.as_str()) && long.lines().skip(1).any(|l| l.trim().len() > 20), "{long}");
    }
}

#[test]
fn regress_explain_unknown() {
    refused(&run(&["explain", "E999"]), 1);
}

#[test]
fn regress_schema() {
    let schema = answered(&["schema"]);
    assert_eq!(schema, answered(&["schema"]));
    let schema: Value = serde_json::from_str(&schema).expect("JSON");
    assert_eq!(schema, willis::train::schema());
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    for key in ["format", "name", "members", "terminals", "mesh", "set", "shift_element", "state", "operation"] {
        assert!(schema["properties"][key]["description"].is_string(), "{key}");
    }
}

#[test]
fn regress_completions() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        assert!(answered(&["completions", shell]).contains("analyze"), "{shell}");
    }
}

#[test]
fn regress_man() {
    let page = answered(&["man"]);
    assert!(page.contains(".TH willis 1") && page.contains("analyze"), "{page}");
    let folder = folder("man");
    answered(&["man", path(&folder)]);
    let pages = std::fs::read_dir(&folder).expect("the folder").count();
    assert!(pages >= 6, "{pages} pages");
    assert!(refused(&run(&["man", path(&folder)]), 1).contains("--force"));
    answered(&["man", path(&folder), "--force"]);
}

#[test]
fn regress_help_and_version() {
    assert!(answered(&["--help"]).contains("Usage: willis"));
    assert!(answered(&["analyze", "--help"]).contains("--operation"));
    assert_eq!(answered(&["--version"]), concat!("willis ", env!("CARGO_PKG_VERSION"), "\n"));
}

// ---- Standard input and output ---------------------------------------------------------------

#[test]
fn regress_standard_input() {
    let file = root().join("examples/two-efficiencies.toml");
    let train = std::fs::read(&file).expect("an example");
    let output = piped(&["analyze", "-"], &train);
    assert_eq!(output.status.code(), Some(0));
    let shown = text(&output.stdout).replace("standard input", "examples/two-efficiencies.toml");
    // The gutter of a snippet does not depend on the name.
    assert_eq!(shown, answered(&["analyze", "examples/two-efficiencies.toml"]));
    let wrong = refused(&piped(&["check", "-"], b"format = 2\nname = \"x\"\nmembers = [\"a\"]\n"), 1);
    assert!(wrong.contains("--> standard input:1:10"), "{wrong}");
    refused(&piped(&["check", "-"], b""), 1);
}

#[test]
fn regress_standard_input_is_called_so() {
    for input in [&b"\xff\xfe"[..], &vec![b'#'; (4 << 20) + 1]] {
        let wrong = refused(&piped(&["check", "-"], input), 1);
        assert!(wrong.contains("standard input"), "{wrong}");
    }
}

#[test]
fn regress_reader_that_leaves() {
    let mut child = command(&["analyze", "examples/zf-8hp70.toml", "--format", "json"])
        .stdout(Stdio::piped())
        .spawn()
        .expect("it runs");
    drop(child.stdout.take());
    assert_eq!(child.wait().expect("it ends").code(), Some(0));
}

#[cfg(target_os = "linux")]
#[test]
fn regress_full_disk() {
    // An answer that was not written is no answer.
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    let output =
        command(&["analyze", "examples/zf-8hp70.toml", "--format", "json"]).stdout(full).output().expect("it runs");
    refused(&output, 1);
}

// ---- Exit status 1: the input is wrong -----------------------------------------------------------

#[test]
fn regress_e002_missing_file() {
    let wrong = refused(&run(&["analyze", "no such file.toml"]), 1);
    assert!(wrong.contains("E002") && wrong.contains("no such file.toml"), "{wrong}");
    refused(&run(&["check", ""]), 1);
}

#[test]
fn regress_e002_directory() {
    snapshot!(refused(&run(&["analyze", "examples"]), 1));
}

#[test]
fn regress_e002_binary() {
    let folder = folder("binary");
    std::fs::write(folder.join("train.toml"), b"\x7fELF\x02\x01\x01\0\xff\xfe").expect("written");
    let output = command(&["check", "train.toml"]).current_dir(&folder).output().expect("the binary runs");
    snapshot!(refused(&output, 1));
}

#[test]
fn regress_e002_oversized() {
    let folder = folder("oversized");
    let file = folder.join("train.toml");
    std::fs::write(&file, vec![b'#'; (4 << 20) + 1]).expect("written");
    let output = command(&["check", "train.toml"]).current_dir(&folder).output().expect("the binary runs");
    snapshot!(refused(&output, 1));
    // As large as allowed: read, and wrong for another reason.
    std::fs::write(&file, vec![b'#'; 4 << 20]).expect("written");
    let wrong = refused(&run(&["check", path(&file)]), 1);
    assert!(wrong.contains("E005") && !wrong.contains("E002"), "{wrong}");
    assert!(wrong.len() < 10_000, "{} bytes of message", wrong.len());
}

#[test]
fn regress_tables_stand_beside_the_train_file() {
    let folder = folder("tables");
    let train = "format = 1\nname = \"wheel\"\nmembers = [\"a\"]\n[[scenario]]\nname = \"s\"\nduration = \"1 s\"\n\
                 [[scenario.source]]\nmember = \"a\"\n\
                 torque = { type = \"csv\", file = \"load.csv\", time = \"t\", value = \"T\" }\n";
    std::fs::write(folder.join("train.toml"), train).expect("written");
    let check = || run(&["check", path(&folder.join("train.toml"))]);
    let wrong = refused(&check(), 1);
    assert!(wrong.contains("E002") && wrong.contains("load.csv"), "{wrong}");
    std::fs::write(folder.join("load.csv"), "t,T\n0,1\n1,x\n").expect("written");
    let wrong = refused(&check(), 1);
    assert!(wrong.contains("E112") && wrong.contains("line 3, column `T`"), "{wrong}");
    std::fs::write(folder.join("load.csv"), "t,T\n0,1\n1,2\n").expect("written");
    let output = check();
    assert!(output.status.success(), "{output:?}");
}

#[cfg(unix)]
#[test]
fn regress_e002_no_permission() {
    use std::os::unix::fs::PermissionsExt;
    let file = folder("permission").join("train.toml");
    std::fs::write(&file, "format = 1\n").expect("written");
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o000)).expect("allowed");
    if std::fs::read(&file).is_ok() {
        return; // The superuser reads everything.
    }
    let wrong = refused(&run(&["check", path(&file)]), 1);
    assert!(wrong.contains("E002"), "{wrong}");
}

#[cfg(target_os = "linux")]
#[test]
fn regress_e002_endless_device() {
    let wrong = refused(&run(&["check", "/dev/zero"]), 1);
    assert!(wrong.contains("E002"), "{wrong}");
}

#[cfg(unix)]
#[test]
fn regress_e002_name_that_is_no_text() {
    use std::os::unix::ffi::OsStrExt;
    let output = command(&["check"]).arg(std::ffi::OsStr::from_bytes(b"\xff.toml")).output().expect("it runs");
    assert!(matches!(output.status.code(), Some(1 | 2)), "{output:?}");
    assert!(!text(&output.stderr).contains("panicked"));
}

#[test]
fn regress_wrong_train() {
    // For machines too: on standard output, with places and replacements.
    let output = piped(&["analyze", "-", "--format", "json"], b"format = 1\n");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("standard input: 2 errors"), "{}", text(&output.stderr));
    let refusal: Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
    assert_eq!(
        (refusal["format"].as_str(), refusal["file"].as_str()),
        (Some("willis-refusal-1"), Some("standard input"))
    );
    assert_eq!(refusal["diagnostics"][0]["code"], "E005");
    assert_eq!(refusal["diagnostics"][0]["span"]["start"], 0);
}

#[test]
fn regress_wrong_selection() {
    snapshot!(refused(&run(&["analyze", "examples/zf-8hp70.toml", "--state", "9", "--operation", "cruise"]), 1));
}

#[test]
fn regress_selection_that_leaves_nothing() {
    // Each exists; the operation runs in another state.
    let output = run(&["analyze", "examples/zf-8hp70.toml", "--state", "1", "--operation", "motorway cruise"]);
    let shown = text(&output.stdout) + &text(&output.stderr);
    assert!(output.status.code() == Some(1) || shown.contains("motorway cruise"), "{shown}");
}

// ---- Exit status 2: usage ------------------------------------------------------------------------

#[test]
fn regress_usage() {
    for arguments in [
        &[][..],
        &["analyse", "examples/zf-8hp70.toml"],
        &["analyze"],
        &["analyze", "examples/zf-8hp70.toml", "examples/prius-p112.toml"],
        &["analyze", "examples/zf-8hp70.toml", "--format", "xml"],
        &["analyze", "examples/zf-8hp70.toml", "--format", "csv", "--table", "gears"],
        &["analyze", "examples/zf-8hp70.toml", "--state"],
        &["analyze", "examples/zf-8hp70.toml", "--color", "pink"],
        &["completions", "tcsh"],
        &["--nonsense"],
    ] {
        refused(&run(arguments), 2);
    }
}

#[test]
fn regress_table_without_csv() {
    // An option that does nothing is not ignored in silence.
    refused(&run(&["analyze", "examples/zf-8hp70.toml", "--table", "states"]), 2);
}

// ---- flow ------------------------------------------------------------------------------------

/// The last column of its tables is round-off.
fn mask_balance(text: &str) -> String {
    let masked = |line: &str| {
        let cut = line.rfind(' ').map(|k| line.split_at(k + 1));
        match cut {
            Some((head, "[round-off]")) => format!("{} [round-off]", head.trim_end()),
            Some((head, last)) if last.contains('e') && last.parse::<f64>().is_ok_and(|x| x.abs() < 1e-3) => {
                format!("{} [round-off]", head.trim_end())
            }
            Some((head, "0")) => format!("{} [round-off]", head.trim_end()),
            _ => line.to_owned(),
        }
    };
    mask(text).lines().map(|l| masked(l) + "\n").collect()
}

#[test]
fn regress_flow_herringbone() {
    snapshot!(mask_balance(&answered(&["flow", "examples/wang-herringbone.toml"])));
}

#[test]
fn regress_flow_compound_split() {
    snapshot!(mask_balance(&answered(&["flow", "examples/compound-split.toml"])));
}

#[test]
fn regress_flow_locked() {
    let arguments = ["flow", "examples/wolfrom-498-self-locking.toml", "--operation", "ring helps by 50 N m"];
    snapshot!(mask_balance(&answered(&arguments)));
}

#[test]
fn flow_as_json_has_the_contract() {
    let json: Value =
        serde_json::from_str(&answered(&["flow", "examples/two-efficiencies.toml", "--format", "json"])).expect("JSON");
    assert_eq!(json["format"], "willis-flow-1");
    assert_eq!(json["operations"][0]["solutions"].as_array().map(Vec::len), Some(2));
    let graph = &json["operations"][0]["solutions"][0];
    for list in ["nodes", "edges", "loops", "paths"] {
        assert!(graph[list].as_array().is_some_and(|a| !a.is_empty()), "{list}");
    }
    assert!(graph["nodes"][0]["power_in_w"].is_number());
}

#[test]
fn flow_writes_what_the_file_name_says() {
    let folder = folder("flow");
    for (name, begins) in [("f.svg", "<svg"), ("f.dot", "digraph"), ("f.json", "{"), ("f.txt", "Two-stage")] {
        let file = folder.join(name);
        assert_eq!(answered(&["flow", "examples/wang-herringbone.toml", "-o", path(&file)]), "");
        let text = std::fs::read_to_string(&file).expect("a file");
        assert!(text.starts_with(begins), "{name}: {text}");
        assert!(!text.contains('\u{1b}'), "{name} has colours");
    }
}

/// Strings closed, braces paired, every statement ended: what Graphviz asks for.
#[test]
fn flow_as_dot_is_well_formed() {
    for file in ["examples/zf-8hp70.toml", "examples/two-efficiencies.toml", "examples/esmail-fig1.toml"] {
        let dot = answered(&["flow", file, "--format", "dot"]);
        let (mut depth, mut string, mut escaped) = (0i32, false, false);
        let mut bare = String::new();
        for c in dot.chars() {
            match (string, c) {
                (true, _) if escaped => escaped = false,
                (true, '\\') => escaped = true,
                (_, '"') => string = !string,
                (false, '{' | '[') => depth += 1,
                (false, '}' | ']') => depth -= 1,
                _ => {}
            }
            assert!(depth >= 0, "{file}");
            if !string && c != '"' {
                bare.push(c);
            }
        }
        assert!(depth == 0 && !string, "{file}");
        for line in bare.lines().map(str::trim).filter(|l| !l.is_empty()) {
            assert!(line.ends_with([';', '{', '}']), "{file}: {line}");
        }
    }
}

#[test]
fn regress_flow_wrong_questions() {
    let mut all = refused(&run(&["flow", "examples/prius-p112.toml", "--operation", "acceleration"]), 1);
    all += &refused(&run(&["flow", "examples/hybrid-drive-away.toml"]), 1);
    snapshot!(all);
}

// ---- simulate --------------------------------------------------------------------------------

#[test]
fn regress_simulate_wrong_questions() {
    let prius = "examples/prius-p112.toml";
    let questions: [&[&str]; 7] = [
        &["simulate", prius],
        &["simulate", prius, "--out", "run.xlsx"],
        &["simulate", prius, "--out", "run"],
        &["simulate", prius, "--plot", "run.png"],
        &["simulate", prius, "--plot", "nowhere/run.svg"],
        &["simulate", prius, "--fixed-step", "1 rpm"],
        &["simulate", prius, "--fixed-step", "0 s"],
    ];
    let mut all = String::new();
    for question in questions {
        let message = refused(&run(question), 1);
        all += &format!("willis {}\n{message}\n", question.join(" "));
    }
    snapshot!(all);
}

#[test]
fn regress_simulate_usage() {
    let prius = "examples/prius-p112.toml";
    for arguments in [
        &["simulate"][..],
        &["simulate", prius, "--tolerance", "5"],
        &["simulate", prius, "--samples", "1"],
        &["simulate", prius, "--lagged-forces"],
        &["simulate", prius, "--fixed-step", "1 ms", "--tolerance", "1e-6"],
    ] {
        refused(&run(arguments), 2);
    }
}

/// A set that a brake brings to rest while a motor swings.
const BRAKED: &str = r#"format = 1
name = "braked"
members = ["sun", "ring", "carrier"]
terminals = ["sun", "carrier"]
inertias = { sun = "0.02 kg m^2", ring = "0.05 kg m^2", carrier = "0.1 kg m^2" }

[[set]]
name = "P"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "ring", teeth = 70 }
carrier = "carrier"
mesh_efficiency = 0.99

[[shift_element]]
name = "B"
kind = "brake"
members = ["ring"]
capacity = "40 N m"

[[scenario]]
name = "stop the ring"
duration = "2 s"
samples = 5
initial_speeds = { sun = "50 rad/s", ring = "20 rad/s" }

[[scenario.source]]
name = "motor"
member = "sun"
torque = { type = "sine", amplitude = "4 N m", frequency = "1 Hz" }

[[scenario.engagement]]
element = "B"
value = { type = "table", points = [ ["0.1 s", 0], ["0.5 s", 1] ] }
"#;

/// Two suns on stepped planets with a light carrier: the tooth forces have two solutions or none, as it turns.
fn jamming(carrier_speed: &str) -> String {
    format!(
        r#"format = 1
name = "two suns"
members = ["a", "b", "carrier"]
terminals = ["a", "b"]
inertias = {{ a = "1 kg m^2", carrier = "0.001 kg m^2" }}

[[set]]
name = "P"
type = "stepped"
carrier = "carrier"
basic_efficiency = 0.9
suns = [ {{ member = "a", teeth = 20, planet_teeth = 20 }}, {{ member = "b", teeth = 21, planet_teeth = 20 }} ]

[[scenario]]
name = "run"
duration = "0.01 s"
fixed = ["b"]
initial_speeds = {{ carrier = "{carrier_speed}" }}

[[scenario.source]]
name = "motor"
member = "a"
torque = "1 N m"
"#
    )
}

/// Two rotors, a clutch without limit between them, and what a scenario of 1 s has beside.
fn clutched(scenario: &str) -> String {
    format!(
        r#"format = 1
name = "two rotors"
members = ["a", "b"]
terminals = ["a", "b"]
inertias = {{ a = "1 kg m^2", b = "2 kg m^2" }}

[[shift_element]]
name = "C"
kind = "clutch"
members = ["a", "b"]

[[scenario]]
name = "run"
duration = "1 s"
{scenario}
"#
    )
}

const LOCKED_ON_THE_WAY: &str = r#"initial_speeds = { a = "10 rad/s" }
[[scenario.engagement]]
element = "C"
value = { type = "table", points = [ ["0 s", 0], ["0.5 s", 0], ["0.5 s", 1] ] }"#;

const JUMP: &str = r#"[[scenario.source]]
name = "drive"
member = "a"
speed = { type = "table", points = [ ["0 s", "0 rad/s"], ["0.5 s", "0 rad/s"], ["0.5 s", "10 rad/s"] ] }"#;

/// How well the energies close is round-off.
fn mask_energy(text: &str) -> String {
    let mask = |line: &str| match line.split_once("closes to ") {
        Some((before, after)) => {
            let (part, rest) = after.split_once(" of the ").expect("a part of the energy");
            assert!(part.parse::<f64>().expect("a number") < 1e-9, "{line}");
            format!("{before}closes to [part] of the {rest}\n")
        }
        None => format!("{line}\n"),
    };
    text.lines().map(mask).collect()
}

#[test]
fn regress_simulate_text() {
    let output = piped(&["simulate", "-"], BRAKED.as_bytes());
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
    snapshot!(mask_energy(&text(&output.stdout)));
}

#[test]
fn regress_simulate_verdicts() {
    let mut all = String::new();
    for (train, verdict) in [
        (jamming("10 rad/s"), "several-solutions"),
        (jamming("-10 rad/s"), "no-solution"),
        (clutched(LOCKED_ON_THE_WAY), "impact"),
        (clutched(JUMP), "impact"),
    ] {
        let output = piped(&["simulate", "-", "--format", "json"], train.as_bytes());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(answer["outcome"]["verdict"], verdict);
        assert!(!answer["outcome"]["why"].as_str().expect("words").is_empty());
        let output = piped(&["simulate", "-"], train.as_bytes());
        assert_eq!(output.status.code(), Some(0));
        all += &mask_energy(&text(&output.stdout));
    }
    snapshot!(all);
    let on = piped(&["simulate", "-", "--continue-when-ambiguous"], jamming("10 rad/s").as_bytes());
    assert_eq!(on.status.code(), Some(0), "{}", text(&on.stderr));
    assert!(text(&on.stdout).contains("the first was taken"));
    let impact = piped(&["simulate", "-", "--fixed-step", "1 ms"], clutched(LOCKED_ON_THE_WAY).as_bytes());
    assert_eq!(impact.status.code(), Some(0), "{}", text(&impact.stderr));
    assert!(text(&impact.stdout).contains("in one step parts of different speed were joined at once"));
}

/// `willis-simulation-1`: objects by name, units in the names, rows beside their columns.
#[test]
fn regress_simulate_contract() {
    let output = piped(&["simulate", "-", "--format", "json", "--columns", "speed,B.mode"], BRAKED.as_bytes());
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    has(
        &answer,
        &[
            "format",
            "train",
            "scenario",
            "outcome",
            "start_s",
            "end_s",
            "scenario_end_s",
            "coordinates",
            "unique_for_every_load",
            "steps",
            "event_count",
            "events",
            "final_speeds_rad_s",
            "energy",
            "assumptions",
            "notes",
            "columns",
            "rows",
        ],
    );
    let energy = &answer["energy"];
    has(energy, &["sources", "stored_j", "losses", "turned_over_j", "residual_j", "efficiency"]);
    has(&energy["sources"][0], &["name", "member", "energy_j", "in_j", "out_j"]);
    has(&energy["losses"][0], &["name", "kind", "energy_j"]);
    assert_eq!(answer["format"], "willis-simulation-1");
    let speeds = answer["final_speeds_rad_s"].as_object().expect("speeds by name");
    assert!(["sun", "ring", "carrier", "P.planet"].iter().all(|m| speeds[*m].is_f64()));
    let events = answer["events"].as_array().expect("events");
    assert_eq!(answer["event_count"], events.len());
    for event in events {
        has(event, &["time_s", "cause", "modes"]);
        for (_, mode) in event["modes"].as_object().expect("modes by name") {
            assert!(["forward", "backward", "stuck", "free"].contains(&mode.as_str().expect("a word")));
        }
    }
    assert_eq!((&events[0]["cause"], &events[0]["modes"]["B"]), (&"start".into(), &"free".into()));
    assert!(events.iter().any(|e| e["cause"] == "B comes to rest" && e["modes"]["B"] == "stuck"), "{events:?}");
    let columns = answer["columns"].as_array().expect("columns");
    columns.iter().for_each(|c| has(c, &["name", "unit", "kind", "of"]));
    let names: Vec<&str> = columns.iter().map(|c| c["name"].as_str().expect("a name")).collect();
    assert_eq!(
        names,
        ["time_s", "sun.speed_rad_s", "ring.speed_rad_s", "carrier.speed_rad_s", "P.planet.speed_rad_s", "B.mode"]
    );
    let rows = answer["rows"].as_array().expect("rows");
    assert!(rows.iter().all(|r| r.as_array().expect("a row").len() == names.len()));
    let last: Vec<f64> = rows[rows.len() - 1].as_array().expect("a row")[1..5].iter().flat_map(Value::as_f64).collect();
    assert_eq!(last, ["sun", "ring", "carrier", "P.planet"].map(|m| speeds[m].as_f64().expect("a speed")));
}

#[test]
fn regress_simulate_wrong_trains() {
    let light = BRAKED.replace("sun = \"0.02 kg m^2\", ", "").replace(", carrier = \"0.1 kg m^2\"", "");
    let fast = BRAKED.replace("ring = \"20 rad/s\"", "ring = \"20 rad/s\", carrier = \"50 rad/s\"");
    let still = BRAKED.replace("\"2 s\"", "\"0 s\"");
    let mut all = String::new();
    for train in [light, fast, still] {
        all += &refused(&piped(&["simulate", "-"], train.as_bytes()), 1);
        all.push('\n');
    }
    let rows = ["simulate", "-", "--samples", "1000000000"];
    all += &refused(&piped(&rows, BRAKED.as_bytes()), 1);
    snapshot!(all);
}

/// Ctrl-C, a request to end or a terminal that is closed in the middle of a run with very many rows: a whole file that says so.
#[cfg(unix)]
#[test]
fn regress_simulate_interrupted() {
    let folder = folder("interrupted");
    let train = folder.join("braked.toml");
    std::fs::write(&train, BRAKED).expect("written");
    for (name, signal) in [("run.csv", "-INT"), ("run.parquet", "-TERM"), ("other.csv", "-HUP")] {
        let (train, out) = (train.to_str().expect("text"), folder.join(name));
        let entries = || std::fs::read_dir(&folder).expect("the folder").filter_map(Result::ok);
        let before: Vec<_> = entries().map(|e| e.path()).collect();
        let arguments = ["simulate", train, "--samples", "1000000000", "--out", out.to_str().expect("text")];
        let child = command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
        // Rows are on their way: the file that will take the name has some.
        let begun = || entries().any(|e| !before.contains(&e.path()) && e.metadata().is_ok_and(|m| m.len() > 4096));
        while !begun() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let pid = child.id().to_string();
        assert!(Command::new("kill").args([signal, &pid]).status().expect("a signal").success());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
        assert!(text(&output.stdout).contains("the run was interrupted, at t = "));
        let written = std::fs::read(&out).expect("rows");
        if name.ends_with(".csv") {
            let told = text(&written);
            let last = told.lines().last().expect("lines");
            assert!(last.starts_with("# interrupted at t = ") && last.ends_with("the run was interrupted"), "{last}");
            let rows: Vec<&str> = told.lines().skip(1).filter(|l| !l.starts_with('#')).collect();
            assert!(!rows.is_empty() && rows.iter().all(|r| r.matches(',').count() == rows[0].matches(',').count()));
        } else {
            assert!(written.starts_with(b"PAR1") && written.ends_with(b"PAR1"));
        }
    }
    std::fs::remove_dir_all(&folder).expect("removed");
}

#[cfg(target_os = "linux")]
#[test]
fn regress_simulate_to_a_full_disk() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has one");
    let mut child = command(&["simulate", "-"]);
    let mut child = child.stdin(Stdio::piped()).stdout(full).stderr(Stdio::piped()).spawn().expect("it runs");
    child.stdin.take().expect("piped").write_all(BRAKED.as_bytes()).expect("read");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("No space left on device"), "{}", text(&output.stderr));
}

/// Rows that were written before the disk was full stay, and the last line says so.
#[cfg(target_os = "linux")]
#[test]
fn rows_written_before_a_full_disk_stay() {
    let folder = folder("full");
    std::fs::write(folder.join("braked.toml"), BRAKED).expect("written");
    for name in ["run.csv", "run.parquet"] {
        // A limit on the size of files stands for the end of the disk.
        let line = format!(
            "ulimit -f 100; trap '' XFSZ; exec {} simulate braked.toml --samples 1000000 -o {name}",
            env!("CARGO_BIN_EXE_willis")
        );
        let output = Command::new("bash").current_dir(&folder).args(["-c", &line]).output().expect("it runs");
        assert_eq!(output.status.code(), Some(1));
        let told = text(&output.stderr);
        if name == "run.parquet" {
            // Its index comes last, so there is nothing to read before.
            assert!(!folder.join(name).exists(), "{told}");
            continue;
        }
        let rows = std::fs::read_to_string(folder.join(name)).expect("rows");
        let lines: Vec<&str> = rows.lines().collect();
        let (last, table) = lines.split_last().expect("lines");
        let time = table.last().and_then(|row| row.split(',').next()).expect("a row");
        assert!(last.starts_with(&format!("# ended at t = {time} s of ")) && rows.ends_with('\n'), "{last}");
        assert!(told.contains(&format!("it has the rows up to t = {time} s")), "{told}");
        assert!(table.len() > 100 && table.iter().all(|r| r.matches(',').count() == table[0].matches(',').count()));
    }
    std::fs::remove_dir_all(&folder).expect("removed");
}

// ---- schemes ---------------------------------------------------------------------------------

#[test]
fn schemes_are_found_written_and_gone_on_with() {
    let folder = folder("schemes");
    let file = |name: &str| folder.join(name).to_str().expect("text").to_owned();
    let wish = "--k 62/26,74/42 --elements 5 --closed 2 --forward 4 --forward-range 0.5..5 --step 1.15..2.2 --reverse-range 1.2..5";
    let ask = |more: &[&str]| -> Vec<String> {
        ["schemes"].into_iter().chain(wish.split(' ')).chain(more.iter().copied()).map(str::to_owned).collect()
    };
    let run = |more: &[&str]| run(&ask(more).iter().map(String::as_str).collect::<Vec<_>>());
    let whole = text(&run(&[]).stdout);
    assert!(whole.contains("  schemes      350 in 146 classes"), "{whole}");
    assert!(whole.contains("nothing else") && whole.contains("●"), "{whole}");
    // Two machines, and one that puts together what they keep.
    for k in ["1", "2"] {
        let (shard, kept) = (format!("{k}/2"), file(&format!("{k}.json")));
        let output = run(&["--shard", &shard, "--progress", &kept]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
    let output = run(&["--resume", &file("1.json"), "--resume", &file("2.json")]);
    assert_eq!(text(&output.stdout), whole);
    let twice = run(&["--resume", &file("1.json"), "--resume", &file("1.json")]);
    assert!(refused(&twice, 1).contains("is in both results"));
    // Rows as files, which another command takes; a picture beside the answer.
    let output = run(&["--write", "1,3", "-o", &file("rows"), "--plot", &file("rows.svg")]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for row in [1, 3] {
        let analysis = answered(&["analyze", &file(&format!("rows/scheme-{row}.toml"))]);
        assert!(analysis.contains("unique, proved"), "{analysis}");
    }
    assert!(std::fs::read_to_string(file("rows.svg")).expect("written").contains("Row 3"));
    assert!(refused(&run(&["--write", "1,3"]), 1).contains("name a folder"));
    assert!(refused(&run(&["--layout", "nowhere.toml"]), 1).contains("nowhere.toml"));
    let large = run_large();
    assert!(large.contains("18428400 layouts") && large.contains("`yes`"), "{large}");
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// A space that takes hours.
fn run_large() -> String {
    refused(&run(&["schemes", "--sets", "4", "--elements", "5", "--closed", "3", "--forward", "8"]), 1)
}

// ---- modes -----------------------------------------------------------------------------------

/// Two rotors, one geared to a third, on an elastic shaft.
const ROTORS: &str = r#"format = 1
name = "three rotors"
members = ["motor", "pinion", "wheel"]
terminals = ["motor", "wheel"]
inertias = { motor = "0.02 kg m^2", pinion = "0.004 kg m^2", wheel = "0.3 kg m^2" }

[[mesh]]
name = "pair"
gears = [ { member = "pinion", teeth = 20 }, { member = "wheel", teeth = 60 } ]

[[shaft]]
name = "coupling"
members = ["motor", "pinion"]
stiffness = "900 N m/rad"
damping = "0.3 N m s/rad"
"#;

#[test]
fn regress_modes_text() {
    let output = piped(&["modes", "-"], ROTORS.as_bytes());
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
    snapshot!(text(&output.stdout));
}

/// Formula: ω² = k (1/J1 + 1/J2), J2 = J_pinion + J_wheel (z1/z2)²; ζ = c ω / (2 k).
#[test]
fn formula_modes_of_two_bodies() {
    let output = piped(&["modes", "-", "--format", "json"], ROTORS.as_bytes());
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["format"], "willis-modes-1");
    let mode = &answer["modes"][0];
    let second = 0.004 + 0.3 / 9.0;
    let w = f64::sqrt(900.0 * (1.0 / 0.02 + 1.0 / second));
    let close = |key: &str, expected: f64| {
        let is = mode[key].as_f64().expect("a number");
        assert!((is - expected).abs() < 1e-9 * expected, "{key}: {is}, {expected}");
    };
    close("angular_frequency_rad_s", w);
    close("frequency_hz", w / std::f64::consts::TAU);
    close("damping_ratio", 0.3 * w / 1800.0);
    assert_eq!(answer["rigid_body_modes"].as_array().map(Vec::len), Some(1));
    let none = ROTORS.split("[[shaft]]").next().expect("a train").replace("inertias", "# inertias");
    assert!(refused(&piped(&["modes", "-"], none.as_bytes()), 1).contains("moments of inertia"));
}

// ---- duty cycles -----------------------------------------------------------------------------

const CYCLE: [&str; 4] = ["cycle", "examples/zf-8hp70.toml", "--profile", "examples/cycle-8hp70.csv"];

#[test]
fn regress_cycle_of_a_car() {
    snapshot!(mask(&answered(&CYCLE)));
}

#[test]
fn regress_cycle_of_a_wind_turbine() {
    let spectrum = "examples/spectrum-nrel-5mw.csv";
    snapshot!(mask(&answered(&["cycle", "examples/nrel-5mw-stage-1.toml", "--profile", spectrum])));
}

#[test]
fn regress_cycle_with_rows_that_have_no_answer() {
    let folder = folder("cycle");
    let profile = folder.join("profile.csv");
    let text = "hours,input.speed [rpm],output.torque [N m]\n1,1000,50\n3,1000,-50\n2,1000,-40\n0.5,0,0\n";
    std::fs::write(&profile, text).expect("written");
    let shown = answered(&["cycle", "examples/wolfrom-498-self-locking.toml", "--profile", path(&profile)]);
    snapshot!(mask(&shown.replace(path(&profile), "profile.csv")));
}

#[test]
fn regress_cycle_wrong_profile() {
    let folder = folder("cycle-wrong");
    let profile = folder.join("profile.csv");
    let text = "time [s],input.sped [rpm],input.torque [N m],state\n0,900,5,1\n2,900,,9\n1,900,nan,1\n";
    std::fs::write(&profile, text).expect("written");
    let told = wrong(&["cycle", "examples/zf-8hp70.toml", "--profile", path(&profile)]);
    snapshot!(told.replace(path(&profile), "profile.csv"));
}

#[test]
fn every_format_of_a_cycle_says_the_same() {
    let all = parsed(&[&CYCLE[..], &["--format", "json"]].concat());
    assert_eq!(all["format"], "willis-cycle-1");
    let csv = answered(&[&CYCLE[..], &["--format", "csv"]].concat());
    let efficiency = format!("\nefficiency,{}\n", all["efficiency"]);
    assert!(csv.contains(&efficiency), "{csv}");
    for table in ["cycle", "directions", "states", "sources", "terminals", "verdicts", "worst"] {
        assert!(csv.contains(&format!("# {table}\n")), "{table}");
    }
}

#[test]
fn rows_of_a_cycle_are_written_once_and_replaced_only_by_force() {
    let folder = folder("cycle-rows");
    let (rows, report) = (folder.join("rows.csv"), folder.join("report.json"));
    let arguments = [&CYCLE[..], &["--rows", path(&rows), "--format", "json", "-o", path(&report)]].concat();
    assert_eq!(answered(&arguments), "");
    let text = std::fs::read_to_string(&rows).expect("rows");
    let all: Vec<Vec<&str>> = text.lines().map(|l| l.split(',').collect()).collect();
    // A header, and a row a line without the one that ends the trace.
    assert_eq!(all.len(), 542);
    let at = |name: &str| all[0].iter().position(|h| *h == name).unwrap_or_else(|| panic!("{name}: {:?}", all[0]));
    let sum: f64 = all[1..].iter().map(|r| r[at("energy_lost_j")].parse::<f64>().unwrap_or(0.0)).sum();
    let json: Value = serde_json::from_str(&std::fs::read_to_string(&report).expect("a report")).expect("JSON");
    let lost = json["energy_lost_j"].as_f64().expect("a number");
    assert!((sum / lost - 1.0).abs() < 1e-12, "{sum} {lost}");
    assert_eq!((all[1][at("line")], all[1][at("verdict")], all[1][at("in_state")]), ("5", "unloaded", "1"));
    let told = wrong(&arguments);
    assert!(told.contains("report.json: is there already; --force replaces it"), "{told}");
    assert_eq!(answered(&[&arguments[..], &["--force"]].concat()), "");
}

#[test]
fn wrong_questions_about_a_cycle_are_refused() {
    let train = "examples/zf-8hp70.toml";
    for (arguments, expected) in [
        (&["cycle", train, "--profile", "no-such.csv"][..], "no-such.csv"),
        (&["cycle", train, "--profile", "examples"], "examples is a directory"),
        (&["cycle", "-", "--profile", "-"], "either the train file or the profile"),
        (&[&CYCLE[..], &["--operation", "launch"]].concat(), "no operation `launch`"),
        (&[&CYCLE[..], &["--state", "9"]].concat(), "no state `9`"),
        (&[&CYCLE[..], &["--law", "niemann"]].concat(), "write family=law"),
    ] {
        let told = wrong(arguments);
        assert!(told.contains(expected), "{arguments:?}: {told}");
    }
}

// ---- variants --------------------------------------------------------------------------------

/// A variant of the 8HP70: better external meshes, another sun, one operation more and one of another load.
fn variant(name: &str) -> (PathBuf, PathBuf) {
    let folder = folder(name);
    let text = std::fs::read_to_string(root().join("examples/zf-8hp70.toml")).expect("an example");
    let text = text
        .replace("external = 0.98", "external = 0.985")
        .replace("teeth = 23", "teeth = 24")
        .replace("{ input = \"150 N m\" }", "{ input = \"120 N m\" }");
    let more = "\n[[operation]]\nname = \"reverse\"\nstate = \"R\"\nspeeds = { input = \"1000 rpm\" }\n\
                torques = { input = \"100 N m\" }\n";
    let file = folder.join("variant.toml");
    std::fs::write(&file, text + more).expect("written");
    (folder, file)
}

#[test]
fn regress_compare_two_variants() {
    let (_folder, file) = variant("compare");
    let shown = answered(&["compare", "examples/zf-8hp70.toml", path(&file)]);
    snapshot!(mask(&shown.replace(path(&file), "variant.toml")));
}

#[test]
fn regress_compare_over_axes() {
    let (_folder, file) = variant("compare-over");
    let over = ["--over", "input.speed=500 rpm..5000 rpm:10", "--over", "state=1,2,8"];
    let operation = ["--operation", "motorway cruise", "--state", "8"];
    let shown = answered(&[&["compare", "examples/zf-8hp70.toml", path(&file)], &over[..], &operation[..]].concat());
    snapshot!(mask(&shown.replace(path(&file), "variant.toml")));
}

#[test]
fn equal_files_are_said_to_be_equal() {
    let file = "examples/prius-p112.toml";
    let shown = answered(&["compare", file, file, file]);
    assert!(shown.contains("The files say the same"), "{shown}");
    let json = parsed(&["compare", file, file, "--format", "json"]);
    assert_eq!((&json["format"], &json["identical"]), (&Value::from("willis-compare-1"), &Value::from(true)));
}

#[test]
fn variants_are_compared_as_tables_too() {
    let (_folder, file) = variant("compare-csv");
    let csv = answered(&["compare", "examples/zf-8hp70.toml", path(&file), "--format", "csv"]);
    assert!(csv.contains("\nP4.sun.teeth,23,24\n"), "{csv}");
    assert!(csv.contains("\nreverse,missing in A,"), "{csv}");
}

#[test]
fn wrong_questions_about_variants_are_refused() {
    let file = "examples/zf-8hp70.toml";
    assert_eq!(run(&["compare", file]).status.code(), Some(2));
    for (arguments, expected) in [
        (&["compare", file, "no-such.toml"][..], "no-such.toml"),
        (&["compare", file, file, "--operation", "launch"], "no variant has the operation `launch`"),
        (
            &["compare", file, "examples/prius-p112.toml", "--over", "state=all"],
            "`state` takes other values in B than in A",
        ),
    ] {
        let told = wrong(arguments);
        assert!(told.contains(expected), "{arguments:?}: {told}");
    }
}

// ---- help ------------------------------------------------------------------------------------

/// Names below `Commands:`.
fn commands() -> Vec<String> {
    let help = answered(&["help"]);
    // Behind the title, up to the first empty line.
    let lines = help.lines().skip_while(|l| *l != "Commands:").skip(1).take_while(|l| !l.is_empty());
    let named = lines.filter(|l| l.starts_with("  ") && !l.starts_with("   "));
    named.map(|l| l.split_whitespace().next().expect("a name").to_owned()).collect()
}

/// Words as a shell would split them, up to what it would do with the output.
fn words(line: &str) -> Vec<String> {
    let pieces = line.split('"').enumerate();
    let mut all: Vec<String> = vec![];
    for (k, piece) in pieces {
        match k % 2 {
            1 => all.push(piece.to_owned()),
            _ => all.extend(piece.split_whitespace().map(str::to_owned)),
        }
    }
    let end = all.iter().position(|w| w == ">").unwrap_or(all.len());
    all.truncate(end);
    all
}

/// A folder with the examples, where a reader begins.
fn reader(name: &str) -> PathBuf {
    fn copied(from: &Path, to: &Path) {
        std::fs::create_dir_all(to).expect("a folder");
        for entry in std::fs::read_dir(from).expect("a folder").flatten() {
            let to = to.join(entry.file_name());
            if entry.path().is_dir() {
                copied(&entry.path(), &to);
            } else {
                std::fs::copy(entry.path(), to).expect("a copy");
            }
        }
    }
    let folder = folder(name);
    copied(&root().join("examples"), &folder.join("examples"));
    folder
}

/// Runs a line of a help text.
fn answers(line: &str, folder: &Path) {
    let words = words(line);
    let mut c = command(&words[1..].iter().map(String::as_str).collect::<Vec<_>>());
    let output = c.current_dir(folder).output().expect("the binary runs");
    assert_eq!(output.status.code(), Some(0), "{line}: {}", text(&output.stderr));
}

#[test]
fn every_help_has_an_example_that_is_a_command() {
    let commands = commands();
    assert!(commands.len() > 30, "{commands:?}");
    let folder = reader("help");
    for name in &commands {
        let help = answered(&[name, "--help"]);
        assert!(answered(&["help", name]).starts_with(&help), "{name}");
        assert_eq!(help.matches("\nExample:").count(), 1, "{name}: {help}");
        let shown = help.split("\nExample:").nth(1).and_then(|e| e.split_once('\n')).expect("lines").1;
        let line = shown.trim().replace("\\\n", "");
        assert!(line.starts_with(&format!("willis {name} ")) && !line.contains('\n'), "{name}: {line}");
        // The studio would wait for Ctrl-C, and shards are not there.
        if !["studio", "merge"].contains(&name.as_str()) {
            answers(&line, &folder);
        }
    }
}

#[test]
fn topics_are_listed_found_and_have_examples() {
    let help = answered(&["help"]);
    let topics = help.split("Topics of `willis help TOPIC`: ").nth(1).and_then(|t| t.split("\n\n").next()).unwrap();
    let topics: Vec<&str> = topics.split([',', '\n']).map(str::trim).collect();
    assert!(["units", "signs", "verdicts", "files", "exit-status"].iter().all(|t| topics.contains(t)), "{topics:?}");
    let (mut pages, folder) = (String::new(), reader("topics"));
    for topic in topics {
        let page = answered(&["help", topic]);
        assert!(!page.contains("](") && !page.contains("|--"), "{page}");
        for line in page.lines().filter_map(|l| l.strip_prefix("    $ ")) {
            answers(line, &folder);
        }
        pages += &page;
    }
    assert!(pages.contains("0.98..0.99") && pages.contains("self-locking"));
    // A word that is a command and a topic is answered with both.
    let laws = answered(&["help", "laws"]);
    assert!(laws.contains("Usage: willis laws") && laws.contains("Outside its range"), "{laws}");
    assert_eq!(answered(&["help", "unit"]), answered(&["help", "Units"]));
    let wrong = refused(&run(&["help", "unist"]), 2);
    assert!(
        wrong.contains("did you mean `units`?") && wrong.contains("exit-status") && wrong.contains("analyze"),
        "{wrong}"
    );
    refused(&run(&["help", "units", "signs"]), 2);
}
