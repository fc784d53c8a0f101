//! Sets in series, from one to many: their ratio, efficiency and acceleration have closed forms, set after set.

use willis::analysis::{Selection, analyze};
use willis::dynamics::{Options, Outcome, simulate};
use willis::exact::Rational;
use willis::regimes::{RegimeSelection, regimes};
use willis::train::Train;

use crate::steps::trains::chain;

/// Teeth of sun and ring of each set of the chain.
fn teeth(sets: usize) -> Vec<[f64; 2]> {
    let of = |k: usize| if k.is_multiple_of(2) { [40, 41 + k % 5] } else { [30, 61 + k % 7] };
    (0..sets).map(|k| of(k).map(|z| z as f64)).collect()
}

/// Basic efficiency of each set, of two meshes.
const BASIC: f64 = 0.985 * 0.99;

/// Sets of which the equations are solved together, and many more.
const LENGTHS: [usize; 8] = [1, 2, 3, 8, 16, 17, 33, 64];

#[test]
fn the_efficiency_is_the_product_of_those_of_the_sets() {
    for sets in LENGTHS {
        let train = Train::from_toml(&chain(sets)).unwrap();
        let report = analyze(&train, &Selection::default()).unwrap();
        // With its ring held a set has (1 + z_r/z_s η₀)/(1 + z_r/z_s), and (1 + z_r/z_s)/(1 + z_r/(z_s η₀)) the other way.
        let product = |of: &dyn Fn(f64) -> f64| teeth(sets).iter().map(|[sun, ring]| of(ring / sun)).product::<f64>();
        let ratio = product(&|i| 1.0 + i);
        let driven = product(&|i| (1.0 + i * BASIC) / (1.0 + i));
        let back = product(&|i| (1.0 + i) / (1.0 + i / BASIC));
        let (_, row) = &report.ratios.0[0];
        let exact = row.exact.as_ref().map(Rational::to_f64).unwrap();
        let ways = [(exact, ratio), (row.drive.efficiency.unwrap(), driven), (row.coast.efficiency.unwrap(), back)];
        for (found, expected) in ways {
            assert!((found / expected - 1.0).abs() < 1e-12, "{sets}: {found}, not {expected}");
        }
        let [solution] = &report.operations[0].solutions[..] else { panic!("one equilibrium") };
        assert!((solution.efficiency.unwrap() / driven - 1.0).abs() < 1e-12, "{sets}");
        assert!(solution.power_residual_w.abs() < 1e-9 * solution.input_power_w, "{sets}");
        // Losses at which it locks: none, however large, as long as efficiencies are above zero.
        assert_eq!(solution.margin.lock_loss_factor, None, "{sets}");
    }
}

#[test]
fn the_acceleration_is_that_of_the_inertia_seen_through_the_sets() {
    for sets in LENGTHS {
        let train = Train::from_toml(&chain(sets)).unwrap();
        let report = simulate(&train, "run up", &Options::default(), &mut ()).unwrap();
        assert_eq!(report.outcome, Outcome::Finished, "{sets}");
        // From the last shaft to the first: each sun drives the carrier behind it.
        let inertia = |k: usize| 0.01 + 0.002 * k as f64;
        let seen = teeth(sets).iter().enumerate().rev().fold(inertia(sets), |behind, (k, [sun, ring])| {
            let i = ring / sun;
            inertia(k) + behind / ((1.0 + i) * (1.0 + i * BASIC))
        });
        let expected = 100.0 + 10.0 / seen;
        let (_, first) = report.final_speeds_rad_s.0.iter().find(|(name, _)| name == "s0").unwrap();
        assert!((first / expected - 1.0).abs() < 1e-9, "{sets}: {first}, not {expected}");
        let energy = report.energy.as_ref().expect("counted");
        assert!(energy.residual_j.abs() < 1e-9 * energy.turned_over_j, "{sets}: {energy:?}");
    }
}

/// Driving and coasting, with a formula each, which names every set.
#[test]
fn the_regimes_are_two_ways_of_one_chain() {
    for sets in [1, 5, 24, 64] {
        let train = Train::from_toml(&chain(sets)).unwrap();
        let all = regimes(&train, &RegimeSelection::default()).unwrap();
        let [atlas] = &all.states[..] else { panic!("one state") };
        assert_eq!((atlas.reason.as_deref(), atlas.regimes.len()), (None, 4), "{sets}");
        for formula in &atlas.formulas {
            let named = (0..sets).filter(|k| formula.efficiency.contains(&format!("eta_P{k}"))).count();
            assert!(
                named == sets || sets == 1 && formula.efficiency.contains("eta0"),
                "{sets}: {}",
                formula.efficiency
            );
        }
    }
}
