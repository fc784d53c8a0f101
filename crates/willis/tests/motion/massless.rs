//! Members without inertia follow the shafts, dampers and clutches on them, as their balance of torques says.

use willis::dynamics::{Method, Options, Outcome, RunReport, simulate};

use crate::rows::{self, Rows, train};

fn run_as(text: &str, method: Method) -> (RunReport, Rows) {
    let (rows, report) = rows::run(text, &Options { method, ..Options::default() });
    assert_eq!(report.outcome, Outcome::Finished);
    let energy = report.energy.as_ref().expect("counted");
    let most = if method == Method::Adaptive { 1e-9 } else { 1e-3 };
    assert!(energy.residual_j.abs() < most * energy.turned_over_j, "{energy:?}");
    (report, rows)
}

fn run(text: &str) -> (RunReport, Rows) {
    run_as(text, Method::Adaptive)
}

const HEAD: &str = "format = 1\nname = \"without inertia\"\n";

/// Between a spring and a damper: `J ω̇ = −k θ`, `θ̇ = ω − k θ / d`, overdamped.
#[test]
fn between_a_spring_and_a_damper() {
    let text = format!(
        "{HEAD}members = [\"rotor\", \"hub\"]\ninertias = {{ rotor = \"2 kg m^2\" }}\n\
         [[shaft]]\nname = \"spring\"\nmembers = [\"rotor\", \"hub\"]\nstiffness = \"50 N m/rad\"\n\
         [[drag]]\nname = \"oil\"\nmembers = [\"hub\"]\nviscous = \"3 N m s/rad\"\n\
         [[scenario]]\nname = \"run\"\nduration = \"4 s\"\ninitial_speeds = {{ rotor = \"10 rad/s\" }}\n"
    );
    let [j, k, d, start]: [f64; 4] = [2.0, 50.0, 3.0, 10.0];
    let (middle, root) = (k / (2.0 * d), ((k / (2.0 * d)).powi(2) - k / j).sqrt());
    let [slow, fast] = [middle - root, middle + root];
    let theta = |t: f64| start * ((-slow * t).exp() - (-fast * t).exp()) / (fast - slow);
    let rate = |t: f64| start * (fast * (-fast * t).exp() - slow * (-slow * t).exp()) / (fast - slow);
    for (method, within) in [(Method::Adaptive, 2e-5), (Method::Fixed { step_s: 1e-4 }, 2e-3)] {
        let (report, rows) = run_as(&text, method);
        let (rotor, hub, times) = (rows.of("rotor.speed_rad_s"), rows.of("hub.speed_rad_s"), rows.of("time_s"));
        for ((t, rotor), hub) in times.zip(rotor).zip(hub).skip(1) {
            let of_hub = k * theta(t) / d;
            let of_rotor = rate(t) + of_hub;
            assert!((rotor - of_rotor).abs() < within * start, "{method:?} at {t}: rotor {rotor}, not {of_rotor}");
            assert!((hub - of_hub).abs() < within * start, "{method:?} at {t}: hub {hub}, not {of_hub}");
        }
        assert!(
            report.assumptions.iter().any(|a| a.starts_with("without inertia") && a.ends_with(": hub")),
            "{:?}",
            report.assumptions
        );
    }
}

/// Two springs in series through members without inertia are one: the chain, and one shaft in its place.
#[test]
fn springs_in_series_are_one() {
    let run_with = |members: &str, shafts: &[(&str, &str, f64)]| {
        let shafts: String = (shafts.iter().enumerate())
            .map(|(k, (a, b, s))| {
                format!("[[shaft]]\nname = \"s{k}\"\nmembers = [\"{a}\", \"{b}\"]\nstiffness = \"{s} N m/rad\"\n")
            })
            .collect();
        run(&format!(
            "{HEAD}members = [\"rotor\", \"wheel\"{members}]\ninertias = {{ rotor = \"0.1 kg m^2\", wheel = \"0.5 kg m^2\" }}\n\
             {shafts}[[scenario]]\nname = \"run\"\nduration = \"2 s\"\ninitial_speeds = {{ rotor = \"10 rad/s\" }}\n\
             source = [{{ name = \"engine\", member = \"rotor\", torque = {{ type = \"sine\", offset = \"3 N m\", amplitude = \"2 N m\", frequency = \"3 Hz\" }} }}]\n"
        ))
        .1
    };
    let one = run_with("", &[("rotor", "wheel", 12.0)]);
    let chain = run_with(
        ", \"a\", \"b\"",
        &[("rotor", "a", 1e6), ("a", "b", 1.0 / (1.0 / 12.0 - 1e-6 - 1.0 / 40.0)), ("b", "wheel", 40.0)],
    );
    for name in ["rotor.speed_rad_s", "wheel.speed_rad_s"] {
        let most = one.of(name).zip(chain.of(name)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most < 1e-4, "{name}: {most}");
    }
}

/// The disc of a clutch at the end of a spring: the spring carries what the clutch rubs with, then all that comes.
#[test]
fn between_a_spring_and_a_clutch() {
    let (_, rows) = run(&format!(
        "{HEAD}members = [\"engine\", \"disc\", \"car\"]\ninertias = {{ engine = \"0.2 kg m^2\", car = \"3 kg m^2\" }}\n\
         [[shift_element]]\nkind = \"clutch\"\nname = \"C\"\nmembers = [\"engine\", \"disc\"]\ncapacity = \"80 N m\"\n\
         [[shaft]]\nname = \"damper spring\"\nmembers = [\"disc\", \"car\"]\nstiffness = \"900 N m/rad\"\ndamping = \"4 N m s/rad\"\n\
         [[scenario]]\nname = \"run\"\nduration = \"6 s\"\ninitial_speeds = {{ engine = \"100 rad/s\" }}\n\
         engagement = [{{ element = \"C\", value = 1 }}]\n"
    ));
    // Both sides under 80 N m: the clutch closes once 100 = (80/0.2 + 80/3) t, and the spring adds its swing.
    let closes = rows.events.iter().find(|e| e.cause.contains("C comes to rest")).expect("it closes");
    assert!((closes.time_s - 100.0 / (80.0 / 0.2 + 80.0 / 3.0)).abs() < 0.01, "{closes:?}");
    let spring: Vec<f64> = rows.of("damper spring.torque_n_m").collect();
    for (t, torque) in rows.of("time_s").zip(&spring).filter(|(t, _)| *t > 0.05 && *t < 0.9 * closes.time_s) {
        assert!((torque.abs() - 80.0).abs() < 1e-3, "{t}: {torque}");
    }
    let at_end: Vec<f64> = ["engine.speed_rad_s", "car.speed_rad_s"].map(|n| rows.of(n).last().expect("rows")).to_vec();
    let together = 0.2 * 100.0 / 3.2;
    assert!(at_end.iter().all(|w| (w - together).abs() < 1e-4), "{at_end:?}, not {together}");
}

/// The ring of a set without inertia, in a brake that slips: the brake decides all torques.
#[test]
fn a_ring_in_a_brake_that_slips() {
    let (_, rows) = run(&format!(
        "{HEAD}members = [\"sun\", \"carrier\", \"ring\"]\ninertias = {{ sun = \"0.05 kg m^2\", carrier = \"2 kg m^2\" }}\n\
         [[set]]\nname = \"set\"\nsun = {{ member = \"sun\", teeth = 30 }}\nring = {{ member = \"ring\", teeth = 90 }}\n\
         carrier = \"carrier\"\n\
         [[shift_element]]\nkind = \"brake\"\nname = \"B\"\nmembers = [\"ring\"]\ncapacity = \"60 N m\"\n\
         [[scenario]]\nname = \"run\"\nduration = \"0.5 s\"\ninitial_speeds = {{ sun = \"300 rad/s\", carrier = \"0 rad/s\" }}\n\
         source = [{{ name = \"motor\", member = \"sun\", torque = \"25 N m\" }}]\n\
         engagement = [{{ element = \"B\", value = 1 }}]\n"
    ));
    // Ring 60, sun 20, carrier 80 N m while it slips; it closes when the sun is four times as fast as the carrier.
    let (rise, gain) = ((25.0 - 20.0) / 0.05, 80.0 / 2.0);
    let closes = 300.0 / (4.0 * gain - rise);
    let rows: Vec<[f64; 3]> = rows
        .of("time_s")
        .zip(rows.of("sun.speed_rad_s"))
        .zip(rows.of("carrier.speed_rad_s"))
        .map(|((t, s), c)| [t, s, c])
        .collect();
    assert!(closes > 0.5, "it slips all the time");
    for [t, sun, carrier] in rows {
        assert!((sun - 300.0 - rise * t).abs() < 1e-3, "{t}: {sun}");
        assert!((carrier - gain * t).abs() < 1e-3, "{t}: {carrier}");
    }
}

/// The same between two clutches, of which the weaker one slips.
#[test]
fn between_two_clutches() {
    let (_, rows) = run(&format!(
        "{HEAD}members = [\"engine\", \"drum\", \"car\"]\ninertias = {{ engine = \"0.2 kg m^2\", car = \"3 kg m^2\" }}\n\
         [[shift_element]]\nkind = \"clutch\"\nname = \"C\"\nmembers = [\"engine\", \"drum\"]\ncapacity = \"80 N m\"\n\
         [[shift_element]]\nkind = \"clutch\"\nname = \"D\"\nmembers = [\"drum\", \"car\"]\ncapacity = \"30 N m\"\n\
         [[scenario]]\nname = \"run\"\nduration = \"0.4 s\"\ninitial_speeds = {{ engine = \"100 rad/s\" }}\n\
         engagement = [{{ element = \"C\", value = 1 }}, {{ element = \"D\", value = 1 }}]\n"
    ));
    for ((t, engine), car) in rows.of("time_s").zip(rows.of("engine.speed_rad_s")).zip(rows.of("car.speed_rad_s")) {
        assert!((engine - 100.0 + 150.0 * t).abs() < 1e-3 && (car - 10.0 * t).abs() < 1e-3, "{t}: {engine}, {car}");
    }
    // To the last bit once C holds, which a trace of inertia puts off.
    let held = rows.events.iter().find(|e| e.cause.contains("C comes to rest")).expect("C holds").time_s;
    assert!(held < 1e-5, "C holds at {held}");
    let drum = rows.of("drum.speed_rad_s").zip(rows.of("engine.speed_rad_s"));
    for (_, (drum, engine)) in rows.of("time_s").zip(drum).filter(|(t, _)| *t > held) {
        assert_eq!(drum, engine);
    }
}

/// A hub on two shafts that turn fast and for long swings with them, in few steps, and starts as they turn.
#[test]
fn a_hub_that_turns_fast_and_long() {
    for method in [Method::Adaptive, Method::Fixed { step_s: 1e-3 }] {
        let (report, rows) = run_as(
            &format!(
                "{HEAD}members = [\"rotor\", \"hub\", \"wheel\"]\ninertias = {{ rotor = \"0.1 kg m^2\", wheel = \"0.5 kg m^2\" }}\n\
                 [[shaft]]\nname = \"s1\"\nmembers = [\"rotor\", \"hub\"]\nstiffness = \"900 N m/rad\"\n\
                 [[shaft]]\nname = \"s2\"\nmembers = [\"hub\", \"wheel\"]\nstiffness = \"20000 N m/rad\"\ndamping = \"0.5 N m s/rad\"\n\
                 [[scenario]]\nname = \"run\"\nduration = \"100 s\"\ninitial_speeds = {{ rotor = \"600 rad/s\", wheel = \"600 rad/s\" }}\n\
                 source = [{{ name = \"engine\", member = \"rotor\", torque = \"0.6 N m\" }}]\n"
            ),
            method,
        );
        for name in ["rotor.speed_rad_s", "hub.speed_rad_s", "wheel.speed_rad_s"] {
            let speeds: Vec<f64> = rows.of(name).collect();
            assert!((speeds[0] - 600.0).abs() < 1e-9, "{method:?} {name}: {}", speeds[0]);
            let last = speeds.last().expect("rows");
            assert!((last - 700.0).abs() < 0.02, "{method:?} {name}: {last}");
        }
        assert!(report.steps < 200_000, "{method:?}: {} steps", report.steps);
    }
}

/// What nothing resists has no acceleration that follows.
#[test]
fn what_nothing_resists_is_refused() {
    let text = format!(
        "{HEAD}members = [\"rotor\", \"hub\"]\ninertias = {{ rotor = \"2 kg m^2\" }}\n\
         [[shift_element]]\nkind = \"clutch\"\nname = \"C\"\nmembers = [\"rotor\", \"hub\"]\n\
         [[scenario]]\nname = \"run\"\nduration = \"1 s\"\n"
    );
    let error = simulate(&train(&text), "run", &Options::default(), &mut ()).expect_err("refused");
    assert!(error.to_string().contains("`hub` has no inertia"), "{error}");
}
