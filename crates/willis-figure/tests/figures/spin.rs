//! Losses without load: every gear is in balance by itself.

use willis::analysis::{AskedLoad, ShaftTableRequest, shaft_table};
use willis::study::PointVerdict;
use willis_figure::{draw_spin, spin_losses};

use crate::trains::{examples, model};

/// What the input brings is lost, and all of it has a source.
#[test]
fn what_the_input_brings_is_lost() {
    let mut lossy = 0;
    for (name, train) in examples() {
        let Ok(spin) = spin_losses(&train, None, None) else { continue };
        assert_eq!(spin.gears.len(), train.states().len().max(1), "{name}");
        for gear in &spin.gears {
            let (Some(loss), Some(torque)) = (gear.loss_w, gear.torque_n_m) else { continue };
            let power = torque * spin.speed_rpm * std::f64::consts::PI / 30.0;
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * a.abs().max(1e-6);
            // Variators may take power from elsewhere while they stand by.
            if train.variators().is_empty() {
                assert!(close(power, loss), "{name} {}: {power} W come in, {loss} W are lost", gear.state);
            }
            if !gear.sources.is_empty() {
                let sum: f64 = gear.sources.iter().map(|s| s.loss_w).sum();
                assert!(close(sum, loss), "{name} {}: {sum} W of {loss} W", gear.state);
                lossy += 1;
            }
            assert!(gear.sources.windows(2).all(|w| w[0].loss_w >= w[1].loss_w), "{name}");
            assert_eq!(gear.verdict == PointVerdict::Unloaded, loss == 0.0, "{name} {}", gear.state);
        }
    }
    // Few examples give what such losses need.
    assert!(lossy >= 2, "{lossy}");
}

/// The picture and the shift table say the same of a gear: spin loss, sources and oil.
#[test]
fn the_table_says_the_same() {
    let mut compared = 0;
    for (name, train) in examples() {
        let Ok(spin) = spin_losses(&train, None, None) else { continue };
        let request = ShaftTableRequest { load: Some(AskedLoad::default()), ..ShaftTableRequest::default() };
        let table = shaft_table(&train, &request).expect("it has gears");
        for gear in &spin.gears {
            let Some(at) = table.states.get(&gear.state).and_then(|s| s.at_load.as_deref()) else { continue };
            if (at.speed_rad_s * 30.0 / std::f64::consts::PI - spin.speed_rpm).abs() > 1e-9 * spin.speed_rpm.abs() {
                continue;
            }
            assert_eq!(gear.oil_k, at.temperature_k, "{name} {}", gear.state);
            assert_eq!(gear.loss_w, at.spin_loss_w, "{name} {}", gear.state);
            let losing = at.spin_sources.iter().filter(|s| s.loss_w > 0.0).count();
            assert_eq!(gear.sources.len(), losing, "{name} {}", gear.state);
            compared += 1;
        }
    }
    assert!(compared > 5, "{compared}");
}

#[test]
fn a_train_without_such_losses_gets_a_sentence() {
    let spin = spin_losses(model("zf-8hp70").train(), None, None).expect("it has gears");
    assert!(draw_spin(&spin).contains("loses nothing that can be computed"));
    let one = spin_losses(model("zf-8hp70").train(), Some("3"), None).expect("a gear");
    assert_eq!(one.gears.len(), 1);
    assert!(spin_losses(model("zf-8hp70").train(), Some("30"), None).is_err());
}
