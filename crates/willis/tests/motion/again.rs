//! A run that starts again, with what it learned about modes, is the same run to the last bit.

use std::path::Path;

use willis::dynamics::{FixedStep, Options, Outcome, Recorder, RunReport, Simulation};
use willis::train::Train;

use crate::rows::Rows;
use crate::steps::trains;

fn advance(run: &mut Simulation) -> (Rows, RunReport) {
    let mut rows = Rows::default();
    let _ = rows.columns(run.columns());
    run.advance(f64::INFINITY, &mut rows);
    let report = run.report();
    (rows, report)
}

/// The examples with scenarios, and the trains of the benchmarks.
fn moving() -> Vec<Train> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut files: Vec<_> = std::fs::read_dir(folder).expect("a folder").map(|f| f.expect("a file").path()).collect();
    files.sort();
    let texts = files.iter().filter(|f| f.extension().is_some_and(|e| e == "toml")).map(std::fs::read_to_string);
    let trains = texts.map(|text| Train::from_toml(&text.expect("text")).expect("a train"));
    trains.filter(|train| !train.scenarios().is_empty()).chain([trains::set(), trains::automatic()]).collect()
}

#[test]
fn a_run_again_is_the_same_run() {
    let mut runs = 0;
    for train in moving() {
        for scenario in train.scenarios() {
            for energies in [true, false] {
                let options = Options { energies, samples: Some(50), ..Options::default() };
                let Ok(mut run) = Simulation::new(&train, &scenario.name, &options) else { continue };
                let names: Vec<&str> = run.columns().iter().map(|c| c.name.as_str()).collect();
                assert!((1..names.len()).all(|k| !names[..k].contains(&names[k])), "a name twice: {names:?}");
                let (first, report) = advance(&mut run);
                run = run.again().expect("it started before");
                let (second, again) = advance(&mut run);
                let bits = |rows: &Rows| rows.rows.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
                let what = format!("{}, {}", train.name(), scenario.name);
                assert_eq!(first.rows.len(), second.rows.len(), "{what}");
                assert!(bits(&first) == bits(&second), "{what}: other numbers");
                assert_eq!(first.events, second.events, "{what}");
                assert_eq!(report, again, "{what}");
                runs += 1;
            }
        }
    }
    assert!(runs > 20, "{runs} runs");
}

/// Nobody who does not look changes what happens.
#[test]
fn a_run_without_rows_ends_alike() {
    for train in moving() {
        for scenario in train.scenarios() {
            let options = Options { samples: Some(50), ..Options::default() };
            let run = || Simulation::new(&train, &scenario.name, &options);
            let (Ok(mut seen), Ok(mut unseen)) = (run(), run()) else { continue };
            advance(&mut seen);
            unseen.advance(f64::INFINITY, &mut ());
            assert_eq!(seen.report(), unseen.report(), "{}, {}", train.name(), scenario.name);
        }
    }
}

/// Steps that start their search with a mode found before take the steps of those that do not.
#[test]
fn a_rehearsed_run_takes_the_same_steps() {
    for (train, scenario, steps) in
        [(trains::set(), "pulses", 20_000), (trains::automatic(), "through the gears", 16_000)]
    {
        let mut first = FixedStep::new(&train, scenario, 1e-3).expect("a run");
        let mut rehearsed = first.clone();
        rehearsed.prepare_modes();
        for step in 0..steps {
            first.step();
            rehearsed.step();
            for member in train.members() {
                let [a, b] = [&first, &rehearsed].map(|run| run.speed(&member.name).map(f64::to_bits));
                assert_eq!(a, b, "step {step}, {}", member.name);
            }
        }
        assert_eq!(first.verdict(), None);
    }
}

/// The speed at the end of many periods of a sine is right to about the tolerance, also where that is wide: steps see the
/// sine. The true speed is that at a tolerance of 1e-12.
#[test]
fn regress_a_wide_tolerance_still_sees_a_sine() {
    const END: f64 = 13.158790432;
    for (tolerance, most) in [(1e-2, 1e-5), (1e-3, 1e-5), (1e-4, 1e-5), (1e-6, 1e-6), (1e-8, 1e-8)] {
        for energies in [false, true] {
            let options = Options { energies, tolerance, ..Options::default() };
            let mut run = Simulation::new(&trains::set(), "pulses", &options).expect("a run");
            assert_eq!(run.advance(f64::INFINITY, &mut ()), Some(Outcome::Finished));
            let error = run.speed("carrier").expect("a member") / END - 1.0;
            assert!(error.abs() <= most, "at {tolerance}: {error:.1e}");
        }
    }
}

/// Rates by the affine map of a stretch, which are those of runs without energies, and rates by the torques of the ports, from
/// which energies follow, are two ways to one motion.
#[test]
fn both_ways_to_the_rates_lead_to_one_end() {
    let mut runs = 0;
    for train in moving() {
        for scenario in train.scenarios() {
            let run = |energies: bool| {
                let options = Options { energies, tolerance: 1e-9, samples: Some(2), ..Options::default() };
                let mut run = Simulation::new(&train, &scenario.name, &options).ok()?;
                let outcome = run.advance(f64::INFINITY, &mut ())?;
                let speeds = train.members().iter().filter_map(|m| run.speed(&m.name)).collect::<Vec<_>>();
                Some((outcome, speeds))
            };
            let (Some((a, by_ports)), Some((b, by_map))) = (run(true), run(false)) else { continue };
            let what = format!("{}, {}", train.name(), scenario.name);
            assert_eq!(a, b, "{what}");
            let size = by_ports.iter().fold(1.0, |most: f64, w| most.max(w.abs()));
            for (a, b) in by_ports.iter().zip(&by_map) {
                assert!((a - b).abs() <= 1e-6 * size, "{what}: {by_ports:?} and {by_map:?}");
            }
            runs += 1;
        }
    }
    assert!(runs > 15, "{runs} runs");
}
