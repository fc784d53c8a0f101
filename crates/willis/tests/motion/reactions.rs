//! What holds a train from outside: the torques of the frame.

use crate::rows::{Rows, run};
use willis::dynamics::Options;

/// A set with a ring that is held and losses on both sides of it.
const SET: &str = r#"
    format = 1
    name = "a set"
    members = ["sun", "ring", "carrier"]
    inertias = { sun = "0.02 kg m^2", carrier = "0.3 kg m^2", ring = "0.1 kg m^2" }
    [[set]]
    name = "P"
    sun = { member = "sun", teeth = 30 }
    ring = { member = "ring", teeth = 72 }
    carrier = "carrier"
    mesh_efficiency = { external = 0.97, internal = 0.98 }
    [[drag]]
    name = "bearing"
    members = ["carrier"]
    viscous = "0.2 N m s/rad"
    [[drag]]
    name = "seal"
    members = ["ring", "sun"]
    viscous = "0.05 N m s/rad"
"#;

const LOADS: &str = r#"
    [[scenario]]
    name = "run"
    duration = "2 s"
    initial_speeds = { sun = "100 rad/s", ring = "0 rad/s" }
    samples = 41
    source = [
      { name = "motor", member = "sun", torque = { type = "sine", amplitude = "30 N m", frequency = "1 Hz", offset = "20 N m" } },
      { name = "load", member = "carrier", torque = "-60 N m" },
    ]
"#;

/// A column at the times of the scenario; rows at events are left out.
fn column(rows: &Rows, name: &str) -> Vec<f64> {
    let k = rows.names.iter().position(|n| n == name).unwrap_or_else(|| panic!("{name} of {:?}", rows.names));
    let mut last = -1.0;
    let new = |row: &&Vec<f64>| (row[0] * 20.0).fract() == 0.0 && std::mem::replace(&mut last, row[0]) < row[0];
    rows.rows.iter().filter(new).map(|row| row[k]).collect()
}

fn assert_same(a: &[f64], b: &[f64]) {
    assert!(a.len() == b.len() && !a.is_empty());
    // Between the steps of two runs the tolerance of speeds is that of torques by drags.
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() <= 1e-7 * (1.0 + a.abs()), "{a} {b}");
    }
}

/// Held in `fixed`, and by a brake that is engaged: the same torque from the outside and from the inside.
#[test]
fn a_member_in_fixed_is_held_with_the_torque_of_a_brake() {
    let held = SET.to_owned() + LOADS + "    fixed = [\"ring\"]\n";
    let brake = "    [[shift_element]]\n    name = \"B\"\n    kind = \"brake\"\n    members = [\"ring\"]\n";
    let braked = SET.to_owned() + brake + LOADS + "    engagement = [{ element = \"B\", value = 1 }]\n";
    let (held, _) = run(&held, &Options::default());
    let (braked, _) = run(&braked, &Options::default());
    assert_same(&column(&held, "ring.reaction_n_m"), &column(&braked, "B.torque_n_m"));
    assert_same(&column(&held, "frame.reaction_n_m"), &column(&braked, "frame.reaction_n_m"));
    // What the frame gives in all is what it gives to the ring and to the bearing.
    let parts: Vec<f64> = column(&held, "ring.reaction_n_m")
        .iter()
        .zip(column(&held, "bearing.torque_n_m"))
        .map(|(a, b)| a + b)
        .collect();
    assert_same(&column(&held, "frame.reaction_n_m"), &parts);
}

/// Newton for the whole: the rate of all angular momentum is what comes from outside.
#[test]
fn val_the_frame_gives_the_rate_of_angular_momentum_less_the_sources() {
    let (rows, _) = run(&(SET.to_owned() + LOADS + "    fixed = [\"ring\"]\n"), &Options::default());
    let [sun, carrier] = ["sun.acceleration_rad_s2", "carrier.acceleration_rad_s2"].map(|n| column(&rows, n));
    let [motor, load] = ["motor.torque_n_m", "load.torque_n_m"].map(|n| column(&rows, n));
    let expected: Vec<f64> = (0..sun.len()).map(|k| 0.02 * sun[k] + 0.3 * carrier[k] - motor[k] - load[k]).collect();
    assert_same(&column(&rows, "frame.reaction_n_m"), &expected);
}

/// Steady and without losses the ring bears `z_r/z_s` times the torque of the sun; a vehicle and a speed from outside
/// are sources as others are.
#[test]
fn val_a_steady_ring_bears_the_ratio_of_the_teeth() {
    let text = r#"
        format = 1
        name = "a set"
        members = ["sun", "ring", "carrier"]
        [[set]]
        name = "P"
    sun = { member = "sun", teeth = 30 }
    ring = { member = "ring", teeth = 72 }
    carrier = "carrier"
        [[scenario]]
        name = "run"
        duration = "1 s"
        fixed = ["ring"]
        initial_speeds = { sun = "34 rad/s" }
        source = [
          { name = "motor", member = "sun", torque = "50 N m" },
          { name = "brake", member = "carrier", speed = "10 rad/s" },
        ]
    "#;
    let (rows, report) = run(text, &Options::default());
    assert!(report.energy.is_some());
    assert!(column(&rows, "ring.reaction_n_m").iter().all(|x| (x - 120.0).abs() < 1e-9));
    assert!(column(&rows, "frame.reaction_n_m").iter().all(|x| (x - 120.0).abs() < 1e-9));
}

/// Two brakes of one set hold it together: how they share is open, and so is what lies between them. What the frame
/// gives in all is not.
#[test]
fn what_two_brakes_share_is_open_and_their_sum_is_not() {
    let lossless = SET.replace("mesh_efficiency = { external = 0.97, internal = 0.98 }", "");
    let brakes: String = ["sun", "ring"]
        .map(|m| {
            format!("    [[shift_element]]\n    name = \"B {m}\"\n    kind = \"brake\"\n    members = [\"{m}\"]\n")
        })
        .concat();
    let loads = LOADS.replace("100 rad/s", "0 rad/s") + "    fixed = [\"carrier\"]\n";
    for set in [SET, &lossless] {
        let closed = ["sun", "ring"].map(|m| format!("{{ element = \"B {m}\", value = 1 }}"));
        let text = format!("{set}{brakes}{loads}    engagement = [{}]\n", closed.join(", "));
        let (rows, _) = run(&text, &Options::default());
        for open in ["B sun.torque_n_m", "B ring.torque_n_m", "P.sun-planet.torque_n_m", "carrier.reaction_n_m"] {
            assert!(column(&rows, open).iter().all(|x| x.is_nan()), "{open}");
        }
        let expected: Vec<f64> = column(&rows, "motor.torque_n_m")
            .iter()
            .zip(column(&rows, "load.torque_n_m"))
            .map(|(a, b)| -a - b)
            .collect();
        assert_same(&column(&rows, "frame.reaction_n_m"), &expected);
    }
}
