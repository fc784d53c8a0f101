//! Steps of fixed length: after a rehearsal none allocates, and a batch takes exactly the steps of its runs.

use std::ops::ControlFlow;

use allocation_counter::measure;
use willis::dynamics::{
    Batch, Column, FixedStep, InputKind, InputRefused, Method, Options, OutputHandle, Recorder, Sample, Simulation,
    simulate,
};
use willis::train::Train;

#[path = "../../benches/trains/mod.rs"]
pub mod trains;

/// Steps that allocate in a whole rehearsed run.
fn steps_that_allocate(train: &Train, scenario: &str, steps: usize) -> Vec<usize> {
    let mut run = FixedStep::new(train, scenario, 1e-3).unwrap();
    run.prepare_modes();
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

/// Few of those under other inputs than the rehearsed ones do: they go through the modes beside.
#[test]
fn other_inputs_meet_modes_that_are_prepared() {
    for (torque, most) in [(140.0, 0), (90.0, 3)] {
        let mut run = FixedStep::new(&trains::automatic(), "through the gears", 1e-3).unwrap();
        run.prepare_modes();
        let engine = run.input("engine").unwrap();
        // The first value takes the place of the signal that the file gives.
        run.set(engine, torque).unwrap();
        let allocates = |run: &mut FixedStep| measure(|| run.step()).count_total > 0;
        let steps: Vec<usize> = (0..16_000).filter(|_| allocates(&mut run)).collect();
        assert!(steps.len() <= most, "{torque} N m: {} steps allocate: {steps:?}", steps.len());
    }
}

/// Counting energies takes no memory, and changes no step.
#[test]
fn energies_are_counted_beside_the_steps() {
    for (train, scenario, steps) in
        [(trains::set(), "pulses", 20_000), (trains::automatic(), "through the gears", 16_000)]
    {
        let mut plain = FixedStep::new(&train, scenario, 1e-3).unwrap();
        plain.prepare_modes();
        let mut counted = plain.clone();
        counted.with_energies();
        counted.prepare_modes();
        let taken = measure(|| (0..steps).for_each(|_| counted.step()));
        assert_eq!(taken.count_total, 0, "{scenario}");
        plain.run(steps);
        let speeds =
            |run: &FixedStep| members(&train).iter().map(|m| run.speed(m).unwrap().to_bits()).collect::<Vec<_>>();
        assert_eq!(speeds(&plain), speeds(&counted), "{scenario}");
    }
}

/// Handles of everything that can be read, with their names.
fn outputs(run: &mut FixedStep) -> Vec<(String, OutputHandle)> {
    let names: Vec<String> = run.outputs().into_iter().map(|c| c.name).collect();
    names.into_iter().map(|name| (name.clone(), run.output(&name).unwrap())).collect()
}

/// To set an input and to read every output takes no memory either.
#[test]
fn inputs_and_outputs_allocate_nothing() {
    for (train, scenario, steps) in
        [(trains::set(), "pulses", 3_000), (trains::automatic(), "through the gears", 16_000)]
    {
        let mut run = FixedStep::new(&train, scenario, 1e-3).unwrap();
        let outputs = outputs(&mut run);
        run.prepare_modes();
        let mut sum = 0.0;
        let taken = measure(|| {
            for _ in 0..steps {
                run.step();
                sum += outputs.iter().map(|(_, output)| run.read(*output)).filter(|x| x.is_finite()).sum::<f64>();
            }
        });
        assert!(taken.count_total == 0 && sum != 0.0, "{scenario}: {taken:?}");
        let inputs = run.inputs();
        let torque = inputs.iter().find(|i| i.kind == InputKind::Torque).expect("a torque");
        // The first value takes the place of the signal that the file gives.
        run.set(torque.input, 0.0).unwrap();
        let taken = measure(|| (0..10).for_each(|k| run.set(torque.input, f64::from(k)).unwrap()));
        assert_eq!(taken.count_total, 0, "{scenario}");
    }
}

/// A clone is the whole state: both go on alike to the last bit, and a run comes back to it from whatever followed.
#[test]
fn a_saved_state_goes_on_to_the_same_bits() {
    for (train, scenario) in [(trains::set(), "pulses"), (trains::automatic(), "through the gears")] {
        let mut run = FixedStep::new(&train, scenario, 1e-3).unwrap();
        let outputs = outputs(&mut run);
        let bits = |run: &mut FixedStep| outputs.iter().map(|(_, o)| run.read(*o).to_bits()).collect::<Vec<_>>();
        run.run(1_234);
        let saved = run.clone();
        let mut other = run.clone();
        // Through shifts: modes are met that the saved state does not know.
        let mut trail = vec![];
        for _ in 0..30 {
            run.run(100);
            other.run(100);
            trail.push(bits(&mut run));
            assert_eq!(trail.last(), Some(&bits(&mut other)), "{scenario} at {} s", run.time());
        }
        run = saved;
        for known in &trail {
            run.run(100);
            assert_eq!(*known, bits(&mut run), "{scenario} at {} s", run.time());
        }
    }
}

/// Rows of a recorded run.
#[derive(Default)]
struct Rows(Vec<Column>, Vec<Vec<f64>>);

impl Recorder for Rows {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        self.0 = columns.to_vec();
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        self.1.push(sample.values.to_vec());
        ControlFlow::Continue(())
    }
}

/// What handles read is what the rows of a recorded run hold.
#[test]
fn outputs_are_those_of_the_rows() {
    let options = |steps: usize| Options {
        method: Method::Fixed { step_s: 1e-3 },
        energies: false,
        samples: Some(steps + 1),
        ..Options::default()
    };
    for (train, scenario) in [(trains::set(), "pulses"), (trains::automatic(), "through the gears")] {
        let duration = train.scenarios().iter().find(|s| s.name == scenario).map(|s| s.end - s.start).unwrap();
        let mut rows = Rows::default();
        simulate(&train, scenario, &options((duration / 1e-3).round() as usize), &mut rows).unwrap();
        let mut run = FixedStep::new(&train, scenario, 1e-3).unwrap();
        let outputs = outputs(&mut run);
        for row in rows.1.iter().filter(|row| row[0] > 0.0).take(5_000) {
            run.step();
            for ((name, output), theirs) in outputs.iter().zip(row) {
                let ours = run.read(*output);
                // Added up in another order.
                let same = match name.as_str() {
                    "stored_energy_j" => (ours - theirs).abs() <= 1e-12 * theirs.abs(),
                    _ => ours == *theirs || ours.is_nan() && theirs.is_nan(),
                };
                assert!(same, "{scenario}: {name} is {ours}, not {theirs}, at {} s", run.time());
            }
        }
    }
}

/// A misspelt name gets the nearest one, and what cannot be set is refused.
#[test]
fn handles_are_found_by_name() {
    let text = r#"
        format = 1
        name = "two rotors"
        members = ["a", "b"]
        inertias = { a = "0.2 kg m^2", b = "0.3 kg m^2" }
        [[shift_element]]
        name = "C"
        kind = "clutch"
        members = ["a", "b"]
        capacity = "40 N m"
        [[scenario]]
        name = "engage"
        duration = "1 s"
        source = [
            { name = "motor", member = "a", torque = "8 N m" },
            { name = "wind", member = "b", linear = { slope = "0.1 N m s/rad" } },
        ]
        engagement = [{ element = "C", value = 0 }]
    "#;
    let train = Train::from_toml(text).unwrap_or_else(|e| panic!("{e}"));
    let mut fixed = FixedStep::new(&train, "engage", 1e-4).unwrap();
    let mut exact = Simulation::new(&train, "engage", &Options::default()).unwrap();
    let names: Vec<String> = fixed.inputs().into_iter().map(|i| i.name).collect();
    assert_eq!(names, ["motor", "engagement.C"]);
    for (wrong, words) in
        [("moter", "did you mean `motor`?"), ("wind", "follows the speed"), ("C", "inputs are: motor, engagement.C")]
    {
        let (a, b) = (fixed.input(wrong).unwrap_err().to_string(), exact.input(wrong).unwrap_err().to_string());
        assert!(a.contains(words) && a == b, "{a}");
    }
    assert!(fixed.output("D.mode").unwrap_err().to_string().contains("did you mean `C.mode`?"));
    // The clutch closes: both rotors turn as one, with half of what the motor gives and without its slip.
    let (motor, clutch) = (fixed.input("motor").unwrap(), fixed.input("engagement.C").unwrap());
    assert_eq!(fixed.set(motor, f64::NAN), Err(InputRefused::NotFinite));
    for value in [4.0, 5.0] {
        fixed.set(motor, value).unwrap();
        exact.set(motor, value).unwrap();
    }
    fixed.set(clutch, 1.0).unwrap();
    exact.set(clutch, 1.0).unwrap();
    fixed.run(10_000);
    exact.advance(1.0, &mut ());
    for name in [
        "a.speed_rad_s",
        "b.speed_rad_s",
        "a.acceleration_rad_s2",
        "motor.torque_n_m",
        "b.angle_rad",
        "C.mode",
        "stored_energy",
    ] {
        let (ours, theirs) = (fixed.output(name).unwrap(), exact.output(name).unwrap());
        let (ours, theirs) = (fixed.read(ours), exact.read(theirs));
        assert!((ours - theirs).abs() <= 2e-3 * theirs.abs(), "{name}: {ours} {theirs}");
    }
    let mode = fixed.output("C.mode").unwrap();
    assert_eq!(fixed.read(mode), 0.0);
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

/// More than one block of runs has, and not as many as two.
const FACTORS: [f64; 19] =
    [1.0, 0.5, 2.0, 1.0025, 1.005, 0.9, 1.3, 0.5, 1.7, 1.0, 0.99, 0.985, 1.02, 1.4, 0.75, 0.6, 1.0, 0.97, 1.6];

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

/// While clutches fill, the inputs that are not level are frictions.
#[test]
fn a_batch_takes_the_steps_of_an_automatic_whose_clutches_fill() {
    let text = |factor: f64| {
        trains::automatic_text()
            .replace("torque = \"150 N m\"", &format!("torque = \"{} N m\"", 150.0 * factor))
            .replace("duration = \"16 s\"", "duration = \"16 s\"\nshift_time = \"0.3 s\"")
    };
    assert_equal("through the gears", "engine", &text, &FACTORS, 6000);
}

/// Rigid elements lock and open halfway while a gear changes.
#[test]
fn a_batch_takes_the_steps_of_an_automatic_whose_rigid_elements_lock_on_the_way() {
    let text = |factor: f64| {
        trains::automatic_text()
            .replace("capacity = \"2000 N m\"", "")
            .replace("torque = \"150 N m\"", &format!("torque = \"{} N m\"", 150.0 * factor))
            .replace("duration = \"16 s\"", "duration = \"16 s\"\nshift_time = \"0.3 s\"")
    };
    assert_equal("through the gears", "engine", &text, &FACTORS, 6000);
}

/// A brake opens and closes while nothing else changes: where its engagement passes zero.
#[test]
fn a_batch_takes_the_steps_of_a_brake_that_opens_on_the_way() {
    let text = |factor: f64| {
        let number = |x: f64| format!("\"{} N m\"", x * factor);
        let wave = "value = { type = \"sine\", offset = 0.3, amplitude = 0.7, frequency = \"0.7 Hz\" }";
        let set = trains::SET.replace("\"60 N m\"", &number(60.0)).replace("\"200 N m\"", &number(200.0));
        set.replace("value = 1\n", &format!("{wave}\n"))
    };
    assert_equal("pulses", "engine", &text, &FACTORS, 6000);
}

/// What a block knew of its modes no longer holds where a torque is scaled on the way.
#[test]
fn a_batch_takes_the_steps_of_runs_whose_torque_changes_on_the_way() {
    let train = trains::automatic();
    let names = members(&train);
    let factors = |part: usize, k: usize| [1.0, -0.5, 0.2, 1.5, 0.0][(part + k) % 5] + 0.01 * k as f64;
    let mut all = Batch::new(&train, "through the gears", 1e-3, FACTORS.len()).unwrap();
    let mut ones: Vec<FixedStep> =
        FACTORS.iter().map(|_| FixedStep::new(&train, "through the gears", 1e-3).unwrap()).collect();
    let engine = ones[0].input("engine").unwrap();
    for part in 0..12 {
        for (k, one) in ones.iter_mut().enumerate() {
            all.scale(k, "engine", factors(part, k)).unwrap();
            one.set(engine, 150.0 * factors(part, k)).unwrap();
        }
        all.run(433);
        for (k, one) in ones.iter_mut().enumerate() {
            one.run(433);
            for name in &names {
                let (ours, theirs) = (all.speed(k, name).unwrap(), one.speed(name).unwrap());
                assert_eq!(ours.to_bits(), theirs.to_bits(), "part {part}, run {k}, {name}: {ours:?}, not {theirs:?}");
            }
        }
    }
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

#[test]
fn a_batch_starts_from_speeds_of_its_own() {
    let starting = |w: f64| {
        let speed = format!("{w} rad/s");
        let initial = format!("duration = \"6 s\"\ninitial_speeds = {{ motor = \"{speed}\", load = \"{speed}\" }}\n");
        Train::from_toml(&shaft(1.0).replace("duration = \"6 s\"\n", &initial)).unwrap()
    };
    let speeds = [0.0, 3.0, -7.5];
    let mut all = Batch::new(&starting(0.0), "to and fro", 1e-3, speeds.len()).unwrap();
    for (run, w) in speeds.into_iter().enumerate() {
        all.set_speed(run, "motor", w).unwrap();
        all.set_speed(run, "load", w).unwrap();
    }
    all.run(2000);
    for (run, w) in speeds.into_iter().enumerate() {
        let mut alone = FixedStep::new(&starting(w), "to and fro", 1e-3).unwrap();
        alone.run(2000);
        for name in ["motor", "load"] {
            let (ours, theirs) = (all.speed(run, name).unwrap(), alone.speed(name).unwrap());
            assert_eq!(ours.to_bits(), theirs.to_bits(), "run {run}, {name}: {ours}, not {theirs}");
        }
    }
    assert!(all.set_speed(0, "shaft", 1.0).is_err() && all.set_speed(9, "motor", 1.0).is_err());
}
