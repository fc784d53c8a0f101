//! Text → train → analysis, regimes and formulas. Whatever the text, nothing panics and no number is
//! undefined.

#![no_main]

use libfuzzer_sys::fuzz_target;
use serde_json::Value;
use willis::analysis::{Direction, SolutionReport, Verdict, analyze};
use willis::regimes::{FormulaRequest, RegimeSelection, formulas, regimes};
use willis::symbolic::Notation;
use willis::train::Train;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let reading = Train::read_toml(text);
    let _ = reading.diagnostics.render("train.toml", text, false);
    let _ = reading.diagnostics.to_string();
    assert!(reading.train.is_some() != reading.diagnostics.has_errors(), "a train, or else an error");
    let Some(train) = &reading.train else { return };
    // Larger trains take longer than a fuzzer waits; their limits have tests of their own.
    if train.meshes().len() <= 6 && train.states().len() <= 4 {
        if let Ok(all) = regimes(train, &RegimeSelection::default()) {
            for r in all.states.iter().flat_map(|a| &a.regimes) {
                assert!(is_efficiency(r.example.efficiency), "efficiency {} in {}", r.example.efficiency, r.id);
            }
        }
        if let Ok(sheet) = formulas(train, &FormulaRequest::default()) {
            sheet.emit(Notation::Python, true);
        }
    }
    match analyze(train, &Default::default()) {
        Err(mut diagnostics) => {
            assert!(diagnostics.has_errors(), "refused without a reason");
            reading.locate(text, &mut diagnostics);
            let _ = diagnostics.render("train.toml", text, true);
        }
        Ok(analysis) => {
            for (name, row) in analysis.ratios.iter() {
                direction(&row.drive, name);
                direction(&row.coast, name);
                assert!(row.value.is_none_or(|v| !v.is_nan()), "ratio of {name}");
            }
            for operation in &analysis.operations {
                for s in &operation.solutions {
                    solution(s, operation.verdict == Verdict::Unique, &operation.name);
                }
            }
            no_null(&serde_json::to_value(&analysis).expect("an analysis is plain data"), "analysis");
        }
    }
});

fn direction(d: &Direction, name: &str) {
    for e in d.efficiency.iter().chain(&d.efficiencies) {
        assert!(is_efficiency(*e), "efficiency {e} in {name}");
    }
}

fn solution(s: &SolutionReport, unique: bool, name: &str) {
    assert!(!unique || s.efficiency.is_none_or(is_efficiency), "efficiency {:?} in {name}", s.efficiency);
    assert!(s.power_residual_w.is_finite(), "residual {} in {name}", s.power_residual_w);
}

fn is_efficiency(e: f64) -> bool {
    (0.0..=1.0 + 1e-12).contains(&e)
}

/// Undefined and infinite numbers are `null` in JSON: these keys always have a number, but for a range of a law, which
/// may have one end only.
fn no_null(value: &Value, place: &str) {
    const NUMBERS: &[&str] = &[
        "potential_power_w",
        "loss_w",
        "input_power_w",
        "output_power_w",
        "power_residual_w",
        "first_torque_n_m",
        "second_torque_n_m",
        "carrier_torque_n_m",
        "share_of_input",
        "boundary",
        "threshold",
        "low",
        "share",
        "error",
        "contraction",
        "loss_factor",
        "contact_ratio",
        "tangential_force_n",
        "line_load_n_per_m",
        "pitch_line_speed_m_s",
        "sum_speed_m_s",
        "sliding_speed_m_s",
        "pitch_pressure_pa",
        "pressure_pa",
        "sliding_loss_w",
        "rolling_loss_w",
        "radial_load_n",
        "axial_load_n",
        "high",
    ];
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                let needed = NUMBERS.contains(&key.as_str()) && place != "outside_laws";
                assert!(!needed || !value.is_null(), "{place}.{key} is no number");
                no_null(value, key);
            }
        }
        Value::Array(list) => list.iter().for_each(|v| no_null(v, place)),
        _ => {}
    }
}
