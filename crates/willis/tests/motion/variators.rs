//! Variators in motion: beside the rigid equations, the statics, closed forms, and balances that must hold.

use willis::analysis::{LimitedQuantity, Selection, Verdict, analyze};
use willis::diagnostic::Code;
use willis::dynamics::{EnergyLossKind, FixedStep, Options, Outcome, RunReport, Simulation};
use willis::train::Train;

use crate::common::example;
use crate::rows::{self, Rows, train};

fn run(text: &str) -> (Rows, RunReport) {
    let (rows, report) = rows::run(text, &Options::default());
    assert_eq!(report.outcome, Outcome::Finished, "{:?}", report.notes);
    let e = report.energy.as_ref().expect("counted");
    assert!(e.residual_j.abs() <= 1e-8 * e.turned_over_j, "{} of {}", e.residual_j, e.turned_over_j);
    (rows, report)
}

fn last(rows: &Rows, column: &str) -> f64 {
    rows.of(column).last().unwrap_or_else(|| panic!("a column {column}"))
}

/// Two rotors and a belt.
fn belt(rest: &str) -> String {
    format!(
        "format = 1\nname = \"belt\"\nmembers = [\"a\", \"b\"]\nterminals = [\"a\", \"b\"]\n\
         inertias = {{ a = \"0.1 kg m^2\", b = \"0.4 kg m^2\" }}\n[[variator]]\nname = \"belt\"\nkind = \"belt\"\n\
         members = [\"a\", \"b\"]\nefficiency = {{ forward = 0.9, backward = 0.85 }}\n[[scenario]]\nname = \"run\"\n{rest}"
    )
}

/// `J_a ω̇_a = M − T`, `J_b ω̇_b = r T η − L`, `ω_a = r ω_b`, in steps of Runge and Kutta; η by the direction of power.
fn rigid(motor: impl Fn(f64) -> f64, load: f64, ratio: impl Fn(f64) -> [f64; 2], start: f64, end: f64) -> f64 {
    let [ja, jb] = [0.1, 0.4];
    let rate = |t: f64, b: f64| {
        let [r, change] = ratio(t);
        let accelerates = |eta: f64| {
            // T from the first equation, into the second.
            let b_dot = (r * eta * (motor(t) - ja * change * b) - load) / (jb + ja * r * r * eta);
            (b_dot, motor(t) - ja * (r * b_dot + change * b))
        };
        let (forward, torque) = accelerates(0.9);
        if torque * b >= 0.0 { forward } else { accelerates(1.0 / 0.85).0 }
    };
    let steps = 200_000;
    let h = (end - start) / f64::from(steps);
    let mut b = 50.0;
    for k in 0..steps {
        let t = start + h * f64::from(k);
        let k1 = rate(t, b);
        let k2 = rate(t + h / 2.0, b + h / 2.0 * k1);
        let k3 = rate(t + h / 2.0, b + h / 2.0 * k2);
        let k4 = rate(t + h, b + h * k3);
        b += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    b
}

/// A ratio that waves, with power one way and the other: as the rigid equations have it.
#[test]
fn val_a_belt_follows_the_rigid_equations() {
    let tau = std::f64::consts::TAU;
    for (motor, load) in [(10.0, 15.0), (-4.0, -20.0), (3.0, 2.0)] {
        let text = belt(&format!(
            "duration = \"2 s\"\ninitial_speeds = {{ b = \"50 rad/s\" }}\n\
             variator = [{{ name = \"belt\", ratio = {{ type = \"sine\", offset = 1.5, amplitude = 0.5, frequency = \"0.5 Hz\" }} }}]\n\
             source = [{{ member = \"a\", torque = \"{motor} N m\" }}, {{ member = \"b\", torque = \"{} N m\" }}]\n",
            -load
        ));
        let (rows, report) = run(&text);
        let ratio = |t: f64| [1.5 + 0.5 * (tau * 0.5 * t).sin(), 0.5 * tau * 0.5 * (tau * 0.5 * t).cos()];
        let expected = rigid(|_| motor, load, ratio, 0.0, 2.0);
        let found = last(&rows, "b.speed_rad_s");
        assert!((found - expected).abs() < 2e-5 * expected.abs(), "{motor}, {load}: {found}, not {expected}");
        assert!(report.energy.unwrap().losses.iter().any(|l| l.kind == EnergyLossKind::Variator && l.energy_j > 0.0));
        // What the housing holds is what both shafts take from the belt.
        for ((a, b), frame) in
            rows.of("belt.a.torque_n_m").zip(rows.of("belt.b.torque_n_m")).zip(rows.of("frame.reaction_n_m"))
        {
            assert!((a + b - frame).abs() < 1e-7 * (a.abs() + b.abs()), "{a} + {b}, not {frame}");
        }
    }
}

/// The same ratio given by its rate, and the other way round, is the same motion.
#[test]
fn a_ratio_is_what_its_rate_makes_of_it() {
    let scenario = |control: &str| {
        let (rows, _) = run(&belt(&format!(
            "duration = \"1 s\"\ninitial_speeds = {{ b = \"50 rad/s\" }}\nvariator = [{{ name = \"belt\", {control} }}]\n\
             source = [{{ member = \"a\", torque = \"10 N m\" }}, {{ member = \"b\", torque = \"-15 N m\" }}]\n"
        )));
        (last(&rows, "a.speed_rad_s"), last(&rows, "b.speed_rad_s"))
    };
    let (a, b) = scenario("ratio = { type = \"ramp\", offset = 2.0, height = -0.5, duration = \"1 s\" }");
    assert!((a - 1.5 * b).abs() < 1e-6 * a);
    for control in [
        "initial_ratio = 2.0, ratio_rate = \"-0.5 1/s\"",
        "ratio = { type = \"expression\", formula = \"2 - 0.5*t\" }",
        "inverse = true, ratio = { type = \"expression\", formula = \"1/(2 - 0.5*t)\" }",
    ] {
        let (x, y) = scenario(control);
        assert!((x - a).abs() < 1e-5 * a && (y - b).abs() < 1e-5 * b, "{control}: {x}, {y}, not {a}, {b}");
    }
}

/// At rest a lossy variator holds: between `M r η_f = L` and `M r / η_b = L` nothing moves.
#[test]
fn val_it_breaks_away_where_its_friction_says() {
    let text = belt(
        "duration = \"2 s\"\nsamples = 2001\nvariator = [{ name = \"belt\", ratio = 2.0 }]\n\
         source = [{ member = \"a\", torque = { type = \"ramp\", offset = \"7 N m\", height = \"4 N m\", duration = \"2 s\" } }, \
         { member = \"b\", torque = \"-15 N m\" }]\n",
    );
    let (rows, _) = run(&text);
    // 15 / (2 · 0.9) = 8.333 N m, reached at 2/3 s; the sum of inertias there is 0.4 + 0.1 · 4 · 0.9.
    let breaks = 2.0 / 3.0;
    for (t, w) in rows.of("time_s").zip(rows.of("b.speed_rad_s")) {
        let expected = if t < breaks { 0.0 } else { (t - breaks).powi(2) * 2.0 * 1.8 / 2.0 / 0.76 };
        assert!((w - expected).abs() < 1e-3 * (1.0 + expected), "at {t}: {w}, not {expected}");
    }
    let first = rows.of("belt.b.torque_n_m").next().unwrap();
    assert!((first - 15.0).abs() < 1e-6, "it holds the load: {first}");
}

/// Every operation of the examples as a steady motion: the torques behind the prescribed speeds, and those of the
/// machines, are those of the statics.
#[test]
fn val_steady_motion_is_what_the_statics_say() {
    let mut seen = 0;
    for name in ["prius-hybrid", "voltec", "two-mode-split", "tractor-hydrostat", "belt-ivt"] {
        let text = example(name);
        let plain = train(&text);
        for o in analyze(&plain, &Selection::default()).expect("it answers").operations {
            let ([s], Verdict::Unique) = (&o.solutions[..], o.verdict) else { continue };
            let Some((path, v)) = s.variators.iter().next() else { continue };
            // In motion a ratio ends at its limit.
            if s.beyond_limits.iter().any(|b| b.quantity == LimitedQuantity::Ratio) {
                continue;
            }
            let speed = |m: &str| s.members.get(m).and_then(|m| m.speed_rad_s).unwrap_or(0.0);
            let ends: Vec<(&str, f64)> = s
                .members
                .iter()
                .filter_map(|(m, of)| of.torque_n_m.filter(|t| *t != 0.0).map(|t| (m.as_str(), t)))
                .collect();
            let inertias: String = plain
                .members()
                .iter()
                // The frame comes first, and has no inertia.
                .skip(1)
                .filter(|m| !m.name.contains('.'))
                .map(|m| format!("\"{}\" = \"0.1 kg m^2\"\n", m.name))
                .collect();
            let initial: String = plain
                .members()
                .iter()
                // The frame comes first, and has no inertia.
                .skip(1)
                .filter(|m| !m.name.contains('.'))
                .map(|m| format!("\"{}\" = \"{:e} rad/s\", ", m.name, speed(&m.name)))
                .collect();
            let machines: Vec<_> = v.machines.iter().collect();
            let mut sources: Vec<String> = Vec::new();
            let control;
            let mut checks = Vec::new();
            if plain.variators()[0].machines().is_empty() {
                let Some(ratio) = v.ratio.filter(|r| r.is_finite() && *r != 0.0) else { continue };
                control = format!("[[scenario.variator]]\nname = \"{path}\"\nratio = {ratio:e}\n");
                // One speed, one torque: the other torque follows.
                sources.push(format!(
                    "{{ name = \"driven\", member = \"{}\", speed = \"{:e} rad/s\" }}",
                    ends[0].0,
                    speed(ends[0].0)
                ));
                sources.push(format!(
                    "{{ name = \"load\", member = \"{}\", torque = \"{:e} N m\" }}",
                    ends[1].0, ends[1].1
                ));
                checks.push(("driven.torque_n_m".to_owned(), ends[0].1));
                checks.extend(machines.iter().map(|(m, of)| (format!("{path}.{m}.torque_n_m"), of.torque_n_m)));
            } else {
                // One speed, one torque, and that of a machine: the other torques follow.
                let ([(driven, behind), (loaded, load)], rest) = (&ends[..2], &ends[2..]) else { continue };
                sources.push(format!(
                    "{{ name = \"driven\", member = \"{driven}\", speed = \"{:e} rad/s\" }}",
                    speed(driven)
                ));
                for (member, torque) in [(loaded, load)].into_iter().chain(rest.iter().map(|(m, t)| (m, t))) {
                    sources.push(format!(
                        "{{ name = \"load on {member}\", member = \"{member}\", torque = \"{torque:e} N m\" }}"
                    ));
                }
                checks.push(("driven.torque_n_m".to_owned(), *behind));
                // The first machine is driven, the second balances: not where that one stands still.
                if machines[1].1.speed_rad_s == 0.0 {
                    continue;
                }
                sources.push(format!(
                    "{{ machine = \"{}\", torque = \"{:e} N m\" }}",
                    machines[0].0, machines[0].1.torque_n_m
                ));
                control =
                    format!("[[scenario.variator]]\nname = \"{path}\"\nstore = \"{:e} W\"\n", v.store_w.unwrap_or(0.0));
                checks.push((format!("{}.torque_n_m", machines[1].0), machines[1].1.torque_n_m));
                checks.push((format!("{path}.store_w"), v.store_w.unwrap_or(0.0)));
            }
            let state = o.state.as_ref().map_or(String::new(), |s| format!("state = \"{s}\"\n"));
            let moving = format!(
                "{text}\n[inertias]\n{inertias}[[scenario]]\nname = \"steady\"\nduration = \"0.1 s\"\nsamples = 2\n{state}\
                 initial_speeds = {{ {} }}\nsource = [{}]\n{control}",
                initial.trim_end_matches(", "),
                sources.join(", ")
            );
            let mut rows = Rows::default();
            let moved = train(&moving);
            let report = willis::dynamics::simulate(&moved, "steady", &Options::default(), &mut rows)
                .unwrap_or_else(|e| panic!("{name}, {}: {e}\n{moving}", o.name));
            if report.outcome != Outcome::Finished {
                panic!("{name}, {}: {:?}", o.name, report.outcome);
            }
            for (column, expected) in checks {
                let found = last(&rows, &column);
                assert!(
                    (found - expected).abs() <= 1e-6 * s.input_power_w.max(expected.abs()) / 1e2,
                    "{name}, {}: {column} is {found}, not {expected}",
                    o.name
                );
            }
            seen += 1;
        }
    }
    assert!(seen >= 10, "{seen}");
}

/// What is said wrongly is refused before anything moves.
#[test]
fn what_does_not_fit_is_refused() {
    let scenario = "duration = \"1 s\"\n";
    for (rest, code, words) in [
        ("", Code::Unfit, "does not say what ratio or torque"),
        ("variator = [{ name = \"bolt\", ratio = 1 }]\n", Code::UnknownName, "bolt"),
        ("variator = [{ name = \"belt\" }]\n", Code::MissingKey, "is not said"),
        ("variator = [{ name = \"belt\", ratio = 1, torque = \"1 N m\" }]\n", Code::Conflict, "follows from the other"),
        ("variator = [{ name = \"belt\", store = \"1 kW\" }]\n", Code::Variator, "belongs to a bus"),
        ("variator = [{ name = \"belt\", ratio_rate = \"1 1/s\" }]\n", Code::MissingKey, "where it begins"),
        ("variator = [{ name = \"belt\", ratio = 1 }, { name = \"belt\", ratio = 2 }]\n", Code::Conflict, "twice"),
        (
            "variator = [{ name = \"belt\", ratio = { type = \"expression\", formula = \"1 + floor(t)\" } }]\n",
            Code::Unfit,
            "jumps",
        ),
        (
            "variator = [{ name = \"belt\", ratio = 1 }]\nsource = [{ member = \"a\", speed = \"1 rad/s\" }, { member = \"b\", speed = \"1 rad/s\" }]\n",
            Code::Unfit,
            "give its members one already",
        ),
        (
            "variator = [{ name = \"belt\", ratio = 2 }]\ninitial_speeds = { a = \"1 rad/s\", b = \"1 rad/s\" }\n",
            Code::ContradictorySpeeds,
            "cannot start with its ratio of 2",
        ),
        (
            "variator = [{ name = \"belt\", ratio = 1 }]\nsource = [{ torque = \"1 N m\" }]\n",
            Code::MissingKey,
            "where it acts",
        ),
        (
            "variator = [{ name = \"belt\", ratio = 1 }]\nsource = [{ machine = \"mg1\", torque = \"1 N m\" }]\n",
            Code::UnknownName,
            "mg1",
        ),
    ] {
        let text = belt(&format!("{scenario}{rest}"));
        let wrong = Train::from_toml(&text)
            .and_then(|t| Simulation::new(&t, "run", &Options::default()).map(|_| ()))
            .expect_err(rest);
        let told = wrong.to_string();
        assert!(wrong.iter().any(|d| d.code == code) && told.contains(words), "{rest}: {told}");
    }
    let text = belt(&format!("{scenario}variator = [{{ name = \"belt\", ratio = 1 }}]\n"));
    let wrong = FixedStep::new(&train(&text), "run", 1e-3).err().expect("no fixed steps");
    assert!(wrong.to_string().contains("is a variator"), "{wrong}");
}

/// A ratio that jumps takes an infinite torque.
#[test]
fn a_jump_of_the_ratio_ends_the_run() {
    let text = belt(
        "duration = \"1 s\"\ninitial_speeds = { a = \"10 rad/s\" }\n\
         variator = [{ name = \"belt\", ratio = { type = \"step\", offset = 1.0, height = 1.0, at = \"0.5 s\" } }]\n",
    );
    let (_, report) = rows::run(&text, &Options::default());
    let Outcome::Impact(why) = &report.outcome else { panic!("{:?}", report.outcome) };
    assert!(why.contains("the ratio of belt jumps from 1 to 2") && (report.end_s - 0.5).abs() < 1e-12, "{why}");
}

/// A hybrid: one machine holds the speed of the engine, the other drives; the store balances, or one machine does.
fn hybrid(bus: &str, sources: &str) -> String {
    format!(
        "format = 1\nname = \"hybrid\"\nmembers = [\"mg1\", \"engine\", \"ring\"]\nterminals = [\"engine\", \"ring\"]\n\
         inertias = {{ mg1 = \"0.02 kg m^2\", engine = \"0.15 kg m^2\", ring = \"2 kg m^2\" }}\n\
         [[set]]\nname = \"P1\"\nsun = {{ member = \"mg1\", teeth = 30 }}\nplanet = {{ teeth = 24 }}\n\
         ring = {{ member = \"ring\", teeth = 78 }}\ncarrier = \"engine\"\nmesh_efficiency = 0.985\n\
         [[variator]]\nname = \"path\"\nmachines = [{{ name = \"A\", member = \"mg1\", efficiency = 0.9 }}, \
         {{ name = \"B\", member = \"ring\", efficiency = {{ motoring = 0.92, generating = 0.88 }}, torque = \"200 N m\" }}]\n\
         standby = \"50 W\"\n{bus}[[scenario]]\nname = \"run\"\nduration = \"4 s\"\n\
         initial_speeds = {{ engine = \"150 rad/s\", ring = \"20 rad/s\" }}\n{sources}"
    )
}

#[test]
fn a_hybrid_accelerates_and_its_books_close() {
    let control = "{ machine = \"A\", controller = { setpoint = { type = \"expression\", formula = \"3.6*150 - 2.6*w_ring\" }, proportional = \"1 N m s/rad\", integral = \"3 N m/rad\" } }";
    let engine =
        "{ member = \"engine\", torque = \"80 N m\" }, { name = \"road\", member = \"ring\", torque = \"-60 N m\" }";
    // Both machines say what they do: the battery gives the rest.
    let (rows, report) =
        run(&hybrid("", &format!("source = [{engine}, {control}, {{ machine = \"B\", torque = \"100 N m\" }}]\n")));
    let e = report.energy.as_ref().expect("counted");
    let store = e.sources.iter().find(|s| s.name == "store of path").expect("it is counted");
    let b = e.machines.iter().find(|s| s.name == "B").expect("it is told");
    assert!(store.energy_j > 0.0 && b.energy_j > 0.0 && e.machines.len() == 2, "{e:?}");
    assert!(report.assumptions.iter().any(|a| a.contains("store gives or takes")), "{:?}", report.assumptions);
    assert!((last(&rows, "engine.speed_rad_s") - 150.0).abs() < 1.0);
    // Power from the store at every instant, by hand.
    let torques = rows.of("A.torque_n_m").zip(rows.of("B.torque_n_m"));
    let speeds = rows.of("mg1.speed_rad_s").zip(rows.of("ring.speed_rad_s"));
    for ((torques, speeds), store) in torques.zip(speeds).zip(rows.of("path.store_w")) {
        let taken = |p: f64, motoring: f64, generating: f64| if p > 0.0 { p / motoring } else { p * generating };
        let by_hand = 50.0 + taken(torques.0 * speeds.0, 0.9, 0.9) + taken(torques.1 * speeds.1, 0.92, 0.88);
        assert!((by_hand - store).abs() < 1e-9 * by_hand.abs().max(1e3), "{by_hand}, not {store}");
    }
    // Without a battery the second machine takes what the first gives, within its limit of torque.
    let rolling = |text: String| text.replace("ring = \"20 rad/s\"", "ring = \"100 rad/s\"");
    let comes_to_its_limit =
        |notes: &[String]| notes.iter().any(|n| n.contains("B balances its bus and comes to its limit"));
    let (rows, report) = run(&rolling(hybrid("", &format!("source = [{engine}, {control}]\n"))));
    assert!(rows.of("path.store_w").all(|p| p.abs() < 1e-6));
    assert!(!comes_to_its_limit(&report.notes), "{:?}", report.notes);
    assert!(last(&rows, "B.torque_n_m") > 0.0);
    // With 5 kW from a battery in place of nothing.
    let (rows, report) = run(&rolling(hybrid(
        "",
        &format!("source = [{engine}, {control}]\nvariator = [{{ name = \"path\", store = \"5 kW\" }}]\n"),
    )));
    assert!(!comes_to_its_limit(&report.notes), "{:?}", report.notes);
    assert!(rows.of("path.store_w").all(|p| (p - 5e3).abs() < 1e-6 * 5e3), "5 kW");
}

/// At standstill no torque passes power: the machine that balances stays within its limit, and the store takes the rest.
#[test]
fn the_machine_that_balances_is_bounded_at_standstill() {
    let text = hybrid(
        "",
        "source = [{ member = \"engine\", speed = \"150 rad/s\" }, { machine = \"A\", torque = \"-20 N m\" }, \
         { member = \"ring\", torque = \"-30 N m\" }]\n",
    )
    .replace("ring = \"20 rad/s\"", "ring = \"0 rad/s\"");
    let (rows, report) = run(&text);
    assert!(report.notes.iter().any(|n| n.contains("B balances its bus and comes to its limit of torque")));
    assert!(rows.of("B.torque_n_m").all(|t| t.abs() <= 200.0 * (1.0 + 1e-12)));
    let store: Vec<f64> = rows.of("path.store_w").collect();
    assert!(store[0] < -1e3, "what A generates at the start goes into the store: {}", store[0]);
}

/// Of a bus that leaves two torques open, or none, the scenario is refused in words.
#[test]
fn a_bus_needs_as_many_torques_as_it_leaves_open() {
    let engine = "source = [{ member = \"engine\", torque = \"1 N m\" }";
    for (bus, rest, words) in [
        ("", format!("{engine}]\n"), "the torques of A and B are not determined"),
        ("store = \"free\"\n", format!("{engine}, {{ machine = \"A\", torque = \"1 N m\" }}]\n"), "is free"),
        ("", format!("{engine}, {{ machine = \"A\", speed = \"1 rad/s\" }}]\n"), "follows from accelerations"),
        (
            "",
            format!(
                "{engine}, {{ machine = \"A\", torque = \"1 N m\" }}, {{ machine = \"B\", torque = \"1 N m\" }}]\nvariator = [{{ name = \"path\", store = \"0 W\" }}]\n"
            ),
            "all machines of `path` are sources",
        ),
        (
            "",
            format!(
                "{engine}, {{ machine = \"A\", torque = \"1 N m\" }}, {{ machine = \"A\", torque = \"1 N m\" }}]\n"
            ),
            "two sources of this scenario are the machine `A`",
        ),
        (
            "",
            format!("{engine}, {{ member = \"mg1\", machine = \"A\", torque = \"1 N m\" }}]\n"),
            "both say where it acts",
        ),
    ] {
        let text = hybrid(bus, &rest).replace("initial_speeds", "# initial_speeds");
        let wrong = Train::from_toml(&text)
            .and_then(|t| Simulation::new(&t, "run", &Options::default()).map(|_| ()))
            .expect_err(&rest);
        assert!(wrong.to_string().contains(words), "{rest}: {wrong}");
    }
}

/// A torque on the first member: the second takes the power, less what is lost.
#[test]
fn val_a_given_torque_passes_its_power() {
    let text = belt(
        "duration = \"1 s\"\ninitial_speeds = { a = \"100 rad/s\", b = \"40 rad/s\" }\n\
         variator = [{ name = \"belt\", torque = { type = \"sine\", offset = \"-5 N m\", amplitude = \"8 N m\", frequency = \"2 Hz\" } }]\n",
    );
    let (rows, _) = run(&text);
    let torques = rows.of("belt.a.torque_n_m").zip(rows.of("belt.b.torque_n_m"));
    let speeds = rows.of("a.speed_rad_s").zip(rows.of("b.speed_rad_s"));
    for (torques, speeds) in torques.zip(speeds) {
        let (out, into) = (-torques.0 * speeds.0, torques.1 * speeds.1);
        let expected = if out > 0.0 { 0.9 * out } else { out / 0.85 };
        assert!((into - expected).abs() < 1e-9 * out.abs().max(1.0), "{into}, not {expected}");
    }
}

/// A limit is one of the first side over the second, also where the scenario gives the inverse.
#[test]
fn limits_of_a_ratio_are_told_as_the_train_has_them() {
    let limited = |control: &str| {
        belt(&format!("duration = \"0.1 s\"\ninitial_speeds = {{ a = \"100 rad/s\" }}\nvariator = [{{ name = \"belt\", {control} }}]\n"))
            .replace("backward = 0.85 }", "backward = 0.85 }\nratio = { min = 0.5, max = 2.5 }")
    };
    let ramp = |to: &str| format!("ratio = {{ type = \"ramp\", offset = 1, height = {to}, duration = \"0.1 s\" }}");
    for (control, told) in [
        (ramp("2"), "a ratio of 3.0000, 0.5000 above its greatest of 2.5000"),
        // To 1/4, which is a ratio of 4.
        (ramp("-0.75") + ", inverse = true", "a ratio of 4.0000, 1.5000 above its greatest of 2.5000"),
        (ramp("3") + ", inverse = true", "a ratio of 0.2500, 0.2500 below its least of 0.5000"),
    ] {
        let (_, report) = run(&limited(&control));
        let [beyond] = &report.beyond_limits[..] else { panic!("{control}: {:?}", report.beyond_limits) };
        assert!(beyond.limit.to_string().contains(told), "{control}: {}", beyond.limit);
    }
    let wrong = Train::from_toml(&limited("initial_ratio = 4, ratio_rate = \"0 1/s\""))
        .and_then(|t| Simulation::new(&t, "run", &Options::default()).map(|_| ()))
        .expect_err("outside its limits");
    assert!(wrong.iter().any(|d| d.code == Code::OutOfRange && d.place.ends_with("initial_ratio")), "{wrong}");
    assert!(wrong.to_string().contains("a ratio of 4: it lies between 0.5 and 2.5"), "{wrong}");
}

/// A machine that runs outside its map takes the value at its edge, and the report says so.
#[test]
fn a_machine_that_leaves_its_map_is_told() {
    let text = hybrid(
        "store = \"free\"\n",
        "source = [{ member = \"engine\", torque = \"50 N m\" }, { machine = \"A\", torque = \"-5 N m\" }, \
         { machine = \"B\", torque = \"40 N m\" }]\n",
    );
    let text = text.replace("member = \"mg1\", efficiency = 0.9", "member = \"mg1\", efficiency = { map = \"a.csv\" }");
    let notes = |most: &str| {
        let map = format!("speed [rpm],torque [N m],efficiency\n0,0,0.9\n0,100,0.9\n{most},0,0.9\n{most},100,0.9\n");
        let reading = Train::read_toml_with(&text, &mut |_| Ok(map.clone()));
        let train = reading.train.unwrap_or_else(|| panic!("{}", reading.diagnostics));
        let report = willis::dynamics::simulate(&train, "run", &Options::default(), &mut ()).expect("it runs");
        assert_eq!(report.outcome, Outcome::Finished);
        report.notes
    };
    let told = |notes: &[String]| notes.iter().any(|n| n.contains("A runs outside the map of its efficiency"));
    assert!(told(&notes("1000")));
    assert!(!told(&notes("1000000")));
}
