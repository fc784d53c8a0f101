//! Steps of fixed length: after a rehearsal none allocates, and a batch takes exactly the steps of its runs.

use allocation_counter::measure;
use willis::dynamics::{Batch, FixedStep};
use willis::train::Train;

#[path = "../../benches/trains/mod.rs"]
mod trains;

/// Steps that allocate in a whole rehearsed run.
fn steps_that_allocate(train: &Train, scenario: &str, steps: usize) -> Vec<usize> {
    let mut run = FixedStep::new(train, scenario, 1e-3).unwrap();
    run.rehearse();
    run.reset();
    (0..steps)
        .filter(|_| {
            let count = measure(|| {
                run.step();
            });
            count.count_total > 0
        })
        .collect()
}

#[test]
fn no_step_allocates_after_a_rehearsal() {
    assert_eq!(steps_that_allocate(&trains::set(), "pulses", 20_000), [0usize; 0]);
    assert_eq!(steps_that_allocate(&trains::automatic(), "through the gears", 16_000), [0usize; 0]);
}

/// Names of a train's members.
fn members(train: &Train) -> Vec<String> {
    train.members().iter().map(|m| m.name.clone()).collect()
}

/// Runs a batch of these factors of a source beside each run by itself; those of 0.5, 1 and 2 also beside steps of
/// the train whose text says so, the other ones beside a batch of one.
fn assert_equal(scenario: &str, source: &str, text: &dyn Fn(f64) -> String, factors: &[f64], steps: u64) {
    const PART: u64 = 250;
    let train = |factor: f64| Train::from_toml(&text(factor)).unwrap_or_else(|e| panic!("{e}\n{}", text(factor)));
    let plain = train(1.0);
    let names = members(&plain);
    let mut all = Batch::new(&plain, scenario, 1e-3, factors.len()).unwrap();
    let mut ones: Vec<Batch> = factors.iter().map(|_| Batch::new(&plain, scenario, 1e-3, 1).unwrap()).collect();
    for (k, factor) in factors.iter().enumerate() {
        all.scale(k, source, *factor).unwrap();
        ones[k].scale(0, source, *factor).unwrap();
    }
    let exact = |factor: &f64| [0.5, 1.0, 2.0].contains(factor);
    let mut steppers: Vec<Option<FixedStep>> =
        (factors.iter()).map(|f| exact(f).then(|| FixedStep::new(&train(*f), scenario, 1e-3).unwrap())).collect();
    // Without angles a run is the same.
    steppers.iter_mut().flatten().skip(1).for_each(FixedStep::without_angles);
    for part in 1..=steps / PART {
        all.run(PART);
        for (k, (one, stepper)) in ones.iter_mut().zip(&mut steppers).enumerate() {
            one.run(PART);
            if let Some(stepper) = stepper.as_mut() {
                stepper.run(PART);
            }
            for name in &names {
                let speed = all.speed(k, name).unwrap();
                let place = format!("{scenario}, run {k}, {name} after {} steps", part * PART);
                assert_eq!(speed.to_bits(), one.speed(0, name).unwrap().to_bits(), "alone: {place}: {speed:?}");
                if let Some(stepper) = stepper.as_ref() {
                    let alone = stepper.speed(name).unwrap();
                    assert_eq!(speed.to_bits(), alone.to_bits(), "steps: {place}: {speed:?}, not {alone:?}");
                }
            }
        }
    }
}

const FACTORS: [f64; 11] = [1.0, 0.5, 2.0, 1.0025, 1.005, 0.9, 1.3, 0.5, 1.7, 1.0, 0.99];

#[test]
fn a_batch_takes_the_steps_of_the_set() {
    let text = |factor: f64| {
        let number = |x: f64| format!("\"{} N m\"", x * factor);
        trains::SET.replace("\"60 N m\"", &number(60.0)).replace("\"200 N m\"", &number(200.0))
    };
    assert_equal("pulses", "engine", &text, &FACTORS, 20_000);
}

#[test]
fn a_batch_takes_the_steps_of_the_automatic() {
    let text = |factor: f64| {
        trains::automatic_text().replace("torque = \"150 N m\"", &format!("torque = \"{} N m\"", 150.0 * factor))
    };
    assert_equal("through the gears", "engine", &text, &FACTORS, 16_000);
}

/// A motor drives a load through a shaft with backlash; the load is braked for a while.
fn shaft(factor: f64) -> String {
    format!(
        r#"
format = 1
name = "a load behind a shaft"
members = ["motor", "load"]
terminals = ["motor", "load"]
inertias = {{ motor = "0.05 kg m^2", load = "0.4 kg m^2" }}

[[shaft]]
name = "shaft"
members = ["motor", "load"]
stiffness = "300 N m/rad"
damping = "1 N m s/rad"
backlash = "2 deg"

[[drag]]
name = "bearing"
members = ["load"]
coulomb = "4 N m"
viscous = "0.1 N m s/rad"

[[scenario]]
name = "to and fro"
duration = "6 s"

[[scenario.source]]
name = "motor"
member = "motor"
torque = {{ type = "sine", offset = "{} N m", amplitude = "{} N m", frequency = "0.7 Hz" }}
"#,
        2.0 * factor,
        12.0 * factor
    )
}

#[test]
fn a_batch_takes_the_steps_of_a_train_with_an_elastic_shaft() {
    assert_equal("to and fro", "motor", &shaft, &FACTORS, 6000);
}

#[test]
fn a_batch_takes_the_steps_of_a_train_with_controllers() {
    let text = |factor: f64| {
        include_str!("../../../../examples/galvagno.toml")
            .replace("torque = \"-68 N m\", about", &format!("torque = \"{} N m\", about", -68.0 * factor))
            .replace("factor = \"0.05 ", &format!("factor = \"{} ", 0.05 * factor))
    };
    assert_equal("two controllers and a load", "load", &text, &FACTORS, 3000);
}
