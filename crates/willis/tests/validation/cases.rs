//! Every number of `validation/*/case.toml`, printed by others or found by an independent method,
//! against ours; and the page that shows them side by side.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};
use willis::analysis::{Analysis, Direction, Selection, SolutionReport, Verdict, analyze};
use willis::exact::Rational;
use willis::train::Train;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn cases() -> Vec<PathBuf> {
    let mut all: Vec<_> = fs::read_dir(root().join("validation"))
        .unwrap()
        .map(|e| e.unwrap().path().join("case.toml"))
        .filter(|p| p.is_file())
        .collect();
    all.sort();
    all
}

fn text<'v>(t: &'v Table, key: &str) -> Option<&'v str> {
    t.get(key).map(|v| v.as_str().unwrap_or_else(|| panic!("`{key}` is a text")))
}

/// The model, with the losses of every set replaced when the case says so.
fn model(case: &Path, t: &Table, basic_efficiency: Option<f64>) -> Analysis {
    let path = case.parent().unwrap().join(text(t, "model").expect("a case names its model"));
    let mut source = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    if let Some(eta) = basic_efficiency {
        let mut file: Table = source.parse().unwrap();
        for set in file["set"].as_array_mut().unwrap() {
            let set = set.as_table_mut().unwrap();
            set.remove("mesh_efficiency");
            set.insert("basic_efficiency".into(), Value::Float(eta));
        }
        source = toml::to_string(&file).unwrap();
    }
    let train = Train::from_toml(&source).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    analyze(&train, &Selection::default()).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

enum Ours {
    Number(f64, Option<Rational>),
    Text(String),
}

fn verdict(v: Verdict) -> Ours {
    Ours::Text(serde_json::to_value(v).unwrap().as_str().unwrap().to_owned())
}

fn direction(d: &Direction, what: &str) -> Ours {
    match what {
        "verdict" => verdict(d.verdict),
        _ => Ours::Number(d.efficiency.unwrap_or(f64::NAN), None),
    }
}

fn ours(a: &Analysis, value: &Table, what: &str) -> Ours {
    if let Some(state) = text(value, "state") {
        if (state, what) == ("as drawn", "degrees_of_freedom") {
            return Ours::Number(a.degrees_of_freedom as f64, None);
        }
        let row = a.ratios.get(state).unwrap_or_else(|| panic!("{}: no state {state}", a.train));
        return match what {
            "ratio" => Ours::Number(row.value.unwrap_or(f64::NAN), row.exact.clone()),
            "efficiency_drive" => direction(&row.drive, "efficiency"),
            "efficiency_coast" => direction(&row.coast, "efficiency"),
            "verdict_drive" => direction(&row.drive, "verdict"),
            "verdict_coast" => direction(&row.coast, "verdict"),
            "degrees_of_freedom" => Ours::Number(row.degrees_of_freedom as f64, None),
            _ => panic!("unknown quantity {what} of a state"),
        };
    }
    let name = text(value, "operation").expect("a value has a state or an operation");
    let o = a.operations.iter().find(|o| o.name == name).unwrap_or_else(|| panic!("{}: no operation {name}", a.train));
    if what == "verdict" {
        return verdict(o.verdict);
    }
    let (what, of) = what.split_once(':').unwrap_or((what, ""));
    if what == "speed" {
        let w = o.speeds_rad_s.get(of).unwrap_or_else(|| panic!("no member {of}"));
        return Ours::Number(w.unwrap_or(f64::NAN) * 30.0 / std::f64::consts::PI, None);
    }
    let s: &SolutionReport = match &o.solutions[..] {
        [one] => one,
        all => panic!("{} / {name}: {} solutions, {what} is not one number", a.train, all.len()),
    };
    let member = || s.members.get(of).unwrap_or_else(|| panic!("{}: no member {of}", a.train));
    match what {
        "torque" => Ours::Number(member().torque_n_m.unwrap_or(f64::NAN), None),
        "power" => Ours::Number(member().power_w.unwrap_or(f64::NAN), None),
        "mesh_driver" => Ours::Text(s.meshes.get(of).unwrap().driver.clone().unwrap_or("idle".into())),
        "element_torque" => Ours::Number(s.shift_elements.get(of).unwrap().torque_n_m.unwrap_or(f64::NAN), None),
        "efficiency" => Ours::Number(s.efficiency.unwrap_or(f64::NAN), None),
        "loss" => Ours::Number(s.loss_w, None),
        _ => panic!("unknown quantity {what} of an operation"),
    }
}

/// Half a unit of the last printed digit.
fn printed_tolerance(printed: &str) -> f64 {
    let mantissa = printed.split(['e', 'E']).next().unwrap();
    let exponent: i32 = printed.split(['e', 'E']).nth(1).map_or(0, |e| e.parse().unwrap());
    let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len() as i32);
    0.500_000_1 * 10f64.powi(exponent - decimals)
}

struct Line {
    row: String,
    what: String,
    printed: String,
    ours: String,
    agrees: bool,
    mismatch: Option<String>,
}

fn check(case: &Path) -> (Table, Vec<Line>) {
    let t: Table = fs::read_to_string(case).unwrap().parse().unwrap_or_else(|e| panic!("{}: {e}", case.display()));
    let mut models: Vec<(Option<f64>, Analysis)> = Vec::new();
    let mut lines = Vec::new();
    for value in t["value"].as_array().unwrap() {
        let value = value.as_table().unwrap();
        for key in value.keys() {
            let known =
                ["state", "operation", "what", "basic_efficiency", "printed", "tolerance", "reason", "mismatch"];
            assert!(known.contains(&key.as_str()), "{}: unknown key {key}", case.display());
        }
        let eta = value.get("basic_efficiency").and_then(Value::as_float);
        if !models.iter().any(|m| m.0 == eta) {
            models.push((eta, model(case, &t, eta)));
        }
        let a = &models.iter().find(|m| m.0 == eta).unwrap().1;
        let what = text(value, "what").unwrap();
        let printed = text(value, "printed").unwrap();
        let (shown, agrees) = match ours(a, value, what) {
            Ours::Text(t) => (t.clone(), t == printed),
            Ours::Number(x, exact) if printed.contains('/') => {
                let exact = exact.expect("a fraction is compared with an exact number");
                let shown = exact.to_string();
                assert!(x.is_finite());
                (shown, exact == printed.parse::<Rational>().unwrap())
            }
            Ours::Number(x, _) => {
                let p: f64 = printed.parse().unwrap_or_else(|_| panic!("{printed} is no number"));
                let tolerance = match value.get("tolerance") {
                    None => printed_tolerance(printed),
                    Some(Value::String(s)) if s == "printed" => printed_tolerance(printed),
                    Some(t) => {
                        assert!(value.contains_key("reason"), "{}: a tolerance needs a reason", case.display());
                        t.as_float().expect("a tolerance is a number")
                    }
                };
                // Binary rounding of the printed number itself is not the printer's fault.
                (format!("{x:.8}"), (x - p).abs() <= tolerance + 1e-14 * p.abs())
            }
        };
        let row = text(value, "state").or(text(value, "operation")).unwrap();
        let row = match eta {
            Some(eta) => format!("{row} (η₀ {eta})"),
            None => row.to_owned(),
        };
        lines.push(Line {
            row,
            what: what.to_owned(),
            printed: printed.to_owned(),
            ours: shown,
            agrees,
            mismatch: text(value, "mismatch").map(String::from),
        });
    }
    (t, lines)
}

#[test]
fn val_every_case() {
    let mut wrong = String::new();
    let mut count = 0;
    for case in cases() {
        let (_, lines) = check(&case);
        for l in lines {
            count += 1;
            let key = case.parent().unwrap().file_name().unwrap().to_str().unwrap();
            if l.agrees == l.mismatch.is_some() {
                let what = if l.agrees { "agrees, and is marked as a mismatch" } else { "differs" };
                writeln!(wrong, "{key}: {} {}: printed {}, ours {}: {what}", l.row, l.what, l.printed, l.ours).unwrap();
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
    assert!(count > 500, "only {count} values were compared");
}

/// `WILLIS_WRITE=1 cargo test -p willis --test validation write_page` writes `validation/README.md`;
/// otherwise it must be up to date.
#[test]
fn write_page() {
    let mut page = String::from(
        "# Validation\n\nGenerated by `cargo xtask generate` from `validation/*/case.toml`; every run of the tests \
         compares these numbers again.\nThe tolerance is half a unit of the last printed digit unless the case gives \
         another with its reason. A row marked **differs** is a printed number that\nis known to be wrong; the test \
         fails if we ever start to agree with it.\n\n",
    );
    let all: Vec<_> = cases().into_iter().map(|c| (c.clone(), check(&c))).collect();
    let total: usize = all.iter().map(|(_, (_, l))| l.len()).sum();
    let differs: usize = all.iter().flat_map(|(_, (_, l))| l).filter(|l| l.mismatch.is_some()).count();
    writeln!(page, "{} cases, {total} values, {} agree, {differs} known mismatches.\n", all.len(), total - differs)
        .unwrap();
    page += "Beside these cases, a table of formulas: [Esmail 2018, Table 1, cell by cell]\
             (esmail-2018-table-1/README.md); computed losses: [measurements, other programs, worked examples]\
             (losses/README.md), with the misses; a paper: [Wang 2020, a herringbone gearbox]\
             (wang-2020/README.md); motion: [Galvagno 2010, every power flow and transients](galvagno/README.md), \
             [six Modelica examples](modelica/README.md); designs: [whole spaces counted, production and published optima]\
             (design/README.md).\n\n";
    for (case, (t, lines)) in &all {
        let key = case.parent().unwrap().file_name().unwrap().to_str().unwrap();
        writeln!(page, "## {key}\n\nSource: {}\n", text(t, "source").unwrap().trim()).unwrap();
        if let Some(checked) = text(t, "checked") {
            writeln!(page, "Transcription: {}\n", checked.trim()).unwrap();
        }
        let model = text(t, "model").unwrap();
        let name = model.rsplit('/').next().unwrap();
        writeln!(page, "Model: [{name}](../examples/{name})\n").unwrap();
        page += "| row | quantity | printed | Willis | |\n|---|---|---|---|---|\n";
        for l in lines {
            let mark = l.mismatch.as_ref().map_or("agrees".to_owned(), |m| format!("**differs**: {m}"));
            writeln!(page, "| {} | {} | {} | {} | {mark} |", l.row, l.what, l.printed, l.ours).unwrap();
        }
        page.push('\n');
    }
    let path = root().join("validation/README.md");
    if std::env::var_os("WILLIS_WRITE").is_some() {
        fs::write(path, page).unwrap();
    } else {
        let committed = fs::read_to_string(path).unwrap_or_default();
        assert!(committed == page, "validation/README.md is out of date: run `cargo xtask generate`");
    }
}
