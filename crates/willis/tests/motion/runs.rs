//! Whole runs: verdicts where the motion is not determined, energy that closes, and symmetries that no
//! implementation may break.

use proptest::prelude::*;
use willis::dynamics::{ColumnKind, Method, Options, Outcome, RunReport, simulate};
use willis::named::NameMap;

use crate::common::{example, examples};
use crate::rows::{Rows, run, train};

/// What does not close, as a part of all that came in, also from the store.
fn open_part(report: &RunReport) -> f64 {
    let e = report.energy.as_ref().expect("counted");
    let came_in = e.sources.iter().map(|s| s.in_j).sum::<f64>() + (-e.stored_j).max(0.0);
    e.residual_j.abs() / came_in.max(1e-300)
}

/// Two suns on stepped planets with a light carrier: whether tooth forces exist, and how many sets of them, depends
/// on the direction of motion (validation/galvagno, the gear form of Painlevé's paradox).
fn two_suns(carrier_inertia: f64, carrier_speed: f64) -> String {
    format!(
        r#"format = 1
        name = "two suns"
        members = ["a", "b", "carrier"]
        terminals = ["a", "b"]
        inertias = {{ a = "1 kg m^2", carrier = "{carrier_inertia} kg m^2" }}
        [[set]]
        name = "P"
        type = "stepped"
        carrier = "carrier"
        basic_efficiency = 0.9
        suns = [
          {{ member = "a", teeth = 20, planet_teeth = 20 }},
          {{ member = "b", teeth = 21, planet_teeth = 20 }},
        ]
        [[scenario]]
        name = "run"
        duration = "0.01 s"
        fixed = ["b"]
        initial_speeds = {{ carrier = "{carrier_speed} rad/s" }}
        [[scenario.source]]
        member = "a"
        torque = "1 N m"
        "#
    )
}

#[test]
fn every_scenario_of_the_examples_comes_to_its_end() {
    for (name, text) in examples() {
        let train = train(&text);
        for scenario in train.scenarios() {
            let report = simulate(&train, &scenario.name, &Options::default(), &mut ()).expect("it begins");
            assert_eq!(report.outcome, Outcome::Finished, "{name}, {}", scenario.name);
        }
    }
}

/// What happens to something is told once, not just before it and where it does.
#[test]
fn nothing_happens_twice_at_one_time() {
    for (name, text) in examples() {
        let train = train(&text);
        for scenario in train.scenarios() {
            let mut rows = Rows::default();
            simulate(&train, &scenario.name, &Options::default(), &mut rows).expect("it begins");
            for pair in rows.events.windows(2) {
                let apart = pair[1].time_s - pair[0].time_s > 1e-9 * (scenario.end - scenario.start);
                let of = |k: usize| pair[k].happenings.iter().flat_map(|h| &h.of).collect::<Vec<_>>();
                let again = of(0).iter().any(|name| of(1).contains(name));
                assert!(apart || !again, "{name}, {}: {pair:?}", scenario.name);
            }
        }
    }
}

#[test]
fn a_part_of_a_run_has_its_rows_and_events() {
    let text = example("shift-8hp70");
    let train = train(&text);
    let of = |options: &Options| {
        let mut rows = Rows::default();
        let report = simulate(&train, "1 to 2, handed over", options, &mut rows).expect("it begins");
        (rows, report)
    };
    for method in [Method::Adaptive, Method::Fixed { step_s: 1e-3 }] {
        let whole = Options { method, samples: Some(11), ..Options::default() };
        let end = of(&whole).1.end_s;
        let options = |from: f64, to: f64| Options { from_s: Some(from), to_s: Some(to), ..whole.clone() };
        let (rows, report) = of(&options(0.2 * end, 0.8 * end));
        assert_eq!(report.outcome, Outcome::Finished);
        assert!(
            (report.end_s - 0.8 * end).abs() < 1e-9
                && (report.from_s, report.scenario_end_s) == (Some(0.2 * end), 0.8 * end)
        );
        let times: Vec<f64> = rows.rows.iter().map(|row| row[0]).collect();
        assert!((times[0] - 0.2 * end).abs() < 1e-9 && (times[times.len() - 1] - 0.8 * end).abs() < 1e-9);
        assert!(times.windows(2).all(|w| w[0] <= w[1]) && times.len() >= 11);
        assert!(rows.events.iter().all(|e| e.time_s >= 0.2 * end - 1e-9 && e.time_s <= 0.8 * end + 1e-9));
        // The motion is that of the whole run.
        let (all, _) = of(&Options { samples: Some(11), ..whole.clone() });
        let at = |rows: &Rows, t: f64| rows.rows.iter().rev().find(|row| (row[0] - t).abs() < 1e-9).unwrap().clone();
        let speeds = rows.kinds.iter().filter(|kind| **kind == "speed").count();
        for (a, b) in at(&rows, 0.8 * end).iter().zip(&at(&all, 0.8 * end)).skip(1).take(speeds) {
            assert!((a - b).abs() < 1e-6 * (1.0 + a.abs()), "{a} {b}");
        }
        for (from, to) in [(-1.0, end), (0.0, 2.0 * end), (end, end), (0.5 * end, 0.2 * end), (f64::NAN, end)] {
            let refused = simulate(&train, "1 to 2, handed over", &options(from, to), &mut ());
            assert!(refused.is_err(), "{from} {to}");
        }
    }
}

#[test]
fn several_motions_none_or_one_are_told_apart() {
    let end = |inertia, speed| run(&two_suns(inertia, speed), &Options::default()).1;
    let several = end(0.001, 10.0);
    assert!(matches!(several.outcome, Outcome::SeveralSolutions(_)), "{:?}", several.outcome);
    // Formula: 1/D for D = -1.75 and 28/3, against the torque of 1 N m seen at the sun.
    assert!(several.outcome.why().starts_with("2 sets of tooth forces"), "{}", several.outcome.why());
    let none = end(0.001, -10.0);
    assert!(matches!(none.outcome, Outcome::NoSolution(_)), "{:?}", none.outcome);
    assert!(none.outcome.why().contains("friction grows with the force it causes"), "{}", none.outcome.why());
    for report in [&several, &none] {
        assert!(!report.unique_for_every_load && report.end_s == 0.0);
    }
    for speed in [10.0, -10.0] {
        let one = end(0.1, speed);
        assert_eq!(one.outcome, Outcome::Finished);
    }
}

#[test]
fn one_of_several_motions_is_gone_on_with_when_asked() {
    let options = Options { continue_when_ambiguous: true, ..Options::default() };
    let (_, report) = run(&two_suns(0.001, 10.0), &options);
    assert_eq!(report.outcome, Outcome::Finished);
    let told = report.notes.iter().find(|n| n.starts_with("at t = 0 s")).expect("a note");
    assert!(told.contains("the first was taken"), "{told}");
}

/// Two rotors on a shaft, the first driven.
fn two_rotors(shaft: &str, scenario: &str) -> String {
    format!(
        r#"format = 1
        name = "two rotors"
        members = ["a", "b"]
        terminals = ["a", "b"]
        inertias = {{ a = "0.01 kg m^2", b = "1 kg m^2" }}
        [[shaft]]
        name = "shaft"
        members = ["a", "b"]
        {shaft}
        [[scenario]]
        name = "run"
        {scenario}
        "#
    )
}

#[test]
fn a_stiff_shaft_is_run_implicitly_and_its_energy_closes() {
    let text = two_rotors(
        "stiffness = \"1e7 N m/rad\"\ndamping = \"3000 N m s/rad\"",
        "duration = \"2 s\"\n[[scenario.source]]\nmember = \"a\"\ntorque = \"5 N m\"",
    );
    let (_, report) = run(&text, &Options::default());
    assert_eq!(report.outcome, Outcome::Finished);
    assert!(report.notes.iter().any(|n| n.contains("implicit")), "{:?}", report.notes);
    assert!(report.steps < 5000, "{} steps", report.steps);
    // As one body once the shaft is wound up: ω = T t / (J1 + J2), less the ripple of the start.
    let speed = report.final_speeds_rad_s.get("b").expect("a rotor");
    assert!((speed - 10.0 / 1.01).abs() < 1e-4 * speed, "{speed}");
    assert!(open_part(&report) <= 1e-9, "{:.2e}", open_part(&report));
}

/// A rotor falls onto an elastic stop again and again, each time less high: ever more changes in ever less time.
fn bounce() -> String {
    two_rotors(
        "stiffness = \"1e6 N m/rad\"\ndamping = \"60 N m s/rad\"\nbacklash = \"0.2 rad\"",
        "duration = \"20 s\"\nfixed = [\"b\"]\n[[scenario.source]]\nmember = \"a\"\ntorque = \"-0.01 N m\"",
    )
}

#[test]
fn a_bounce_comes_to_its_end() {
    let (rows, report) = run(&bounce(), &Options::default());
    assert_eq!(report.outcome, Outcome::Finished);
    assert!(rows.events.len() > 20 && rows.events.len() < 5000, "{} events", rows.events.len());
    assert!(report.final_speeds_rad_s.get("a").expect("a rotor").abs() < 1e-9);
    assert!(rows.events.windows(2).all(|e| e[0].time_s <= e[1].time_s));
}

#[test]
fn too_many_changes_of_mode_are_told_and_not_waited_for() {
    let options = Options { most_events: 3, ..Options::default() };
    let (_, report) = run(&bounce(), &options);
    let Outcome::TooManyEvents(why) = &report.outcome else { panic!("{:?}", report.outcome) };
    assert!(why.starts_with("4 changes of mode within") && why.contains("shaft"), "{why}");
    assert!(report.end_s < 20.0);
}

#[test]
fn a_prescribed_speed_that_jumps_is_refused_with_the_state_before_it() {
    let jump =
        r#"speed = { type = "table", points = [["0 s", "1 rad/s"], ["0.5 s", "1 rad/s"], ["0.5 s", "9 rad/s"]] }"#;
    let text = two_rotors(
        "stiffness = \"1e3 N m/rad\"\ndamping = \"1 N m s/rad\"",
        &format!("duration = \"1 s\"\n[[scenario.source]]\nmember = \"a\"\n{jump}"),
    );
    let (_, report) = run(&text, &Options::default());
    let Outcome::Impact(why) = &report.outcome else { panic!("{:?}", report.outcome) };
    assert!(why.starts_with("the speed prescribed for a jumps from 1 to 9 rad/s"), "{why}");
    assert_eq!(report.end_s, 0.5);
    assert_eq!(report.final_speeds_rad_s.get("a"), Some(&1.0));
    assert!(open_part(&report) <= 1e-9, "{:.2e}", open_part(&report));
}

/// A planetary set with losses, a slipping brake on the ring, a bearing and a load: what a random run is made of.
#[derive(Clone, Debug)]
struct Contraption {
    teeth: [u32; 2],
    efficiency: [f64; 2],
    inertias: [f64; 3],
    brake: f64,
    bearing: f64,
    speeds: [f64; 2],
    torques: [f64; 2],
    swing: f64,
}

impl Contraption {
    fn any() -> impl Strategy<Value = Self> {
        let f = |from: f64, to: f64| from..to;
        (
            [18u32..40, 18u32..32],
            [f(0.85, 1.0), f(0.85, 1.0)],
            [f(0.01, 0.5), f(0.01, 0.5), f(0.01, 0.5)],
            (f(1.0, 30.0), f(0.1, 5.0)),
            [f(-60.0, 60.0), f(-60.0, 60.0)],
            [f(-20.0, 20.0), f(-20.0, 20.0)],
            f(0.5, 3.0),
        )
            .prop_map(|(teeth, efficiency, inertias, (brake, bearing), speeds, torques, swing)| Self {
                teeth,
                efficiency,
                inertias,
                brake,
                bearing,
                speeds,
                torques,
                swing,
            })
    }

    /// The train file; `sense` is -1 for all speeds and torques reversed, `names` are those of sun, ring, carrier in the
    /// order in which they are listed.
    fn text(&self, sense: f64, names: [&str; 3]) -> String {
        let [sun, planet] = self.teeth;
        let ring = sun + 2 * planet;
        let [forward, backward] = self.efficiency;
        let [js, jr, jc] = self.inertias;
        let [ws, wr] = self.speeds.map(|w| sense * w);
        let [ts, tc] = self.torques.map(|t| sense * t);
        let (brake, bearing, swing) = (self.brake, self.bearing, self.swing);
        let members = names.map(|n| format!("\"{n}\"")).join(", ");
        format!(
            r#"format = 1
            name = "contraption"
            members = [{members}]
            terminals = ["s", "c"]
            inertias = {{ s = "{js} kg m^2", r = "{jr} kg m^2", c = "{jc} kg m^2" }}
            [[set]]
            name = "P"
            sun = {{ member = "s", teeth = {sun} }}
            planet = {{ teeth = {planet}, count = 1 }}
            ring = {{ member = "r", teeth = {ring} }}
            carrier = "c"
            mesh_efficiency = {{ external = {{ forward = {forward}, backward = {backward} }}, internal = 0.99 }}
            [[drag]]
            name = "brake"
            members = ["r"]
            coulomb = "{brake} N m"
            peak = 1.2
            [[drag]]
            name = "bearing"
            members = ["c"]
            coulomb = "{bearing} N m"
            viscous = "0.05 N m s/rad"
            [[scenario]]
            name = "run"
            duration = "1 s"
            samples = 201
            initial_speeds = {{ s = "{ws} rad/s", r = "{wr} rad/s" }}
            [[scenario.source]]
            name = "motor"
            member = "s"
            torque = {{ type = "sine", amplitude = "{ts} N m", frequency = "{swing} Hz" }}
            [[scenario.source]]
            name = "load"
            member = "c"
            torque = "{tc} N m"
            "#
        )
    }
}

const LISTED: [&str; 3] = ["s", "r", "c"];

fn speeds_differ(a: &NameMap<f64>, b: &NameMap<f64>, sense: f64) -> f64 {
    a.iter().map(|(name, w)| (w - sense * b.get(name).expect("the same members")).abs()).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn energy_closes_and_mirrored_or_relabelled_trains_move_alike(what in Contraption::any()) {
        let options = Options { tolerance: 1e-12, ..Options::default() };
        let (rows, report) = run(&what.text(1.0, LISTED), &options);
        prop_assert_eq!(&report.outcome, &Outcome::Finished);
        prop_assert!(open_part(&report) <= 1e-9, "{:.2e}", open_part(&report));
        let size = rows.greatest("speed").max(1.0);
        let (mirrored, turned) = run(&what.text(-1.0, LISTED), &options);
        prop_assert!(speeds_differ(&report.final_speeds_rad_s, &turned.final_speeds_rad_s, -1.0) <= 1e-8 * size);
        prop_assert_eq!(rows.events.len(), mirrored.events.len());
        let (_, listed) = run(&what.text(1.0, ["c", "s", "r"]), &options);
        prop_assert!(speeds_differ(&report.final_speeds_rad_s, &listed.final_speeds_rad_s, 1.0) <= 1e-8 * size);
    }

    #[test]
    fn fixed_steps_are_right_to_first_order(what in Contraption::any()) {
        let text = what.text(1.0, LISTED);
        let (rows, exact) = run(&text, &Options::default());
        let fixed = |h: f64| {
            let (_, report) = run(&text, &Options { method: Method::Fixed { step_s: h }, ..Options::default() });
            speeds_differ(&exact.final_speeds_rad_s, &report.final_speeds_rad_s, 1.0)
        };
        // A change of mode that is late by a step changes the speed by an acceleration times that step.
        let change = rows.greatest("acceleration") * rows.events.len() as f64;
        for h in [2e-3, 2e-4] {
            let error = fixed(h);
            prop_assert!(error <= 3.0 * h * change, "{error:.2e} at {h} s, {:.2e} allowed", 3.0 * h * change);
        }
    }
}

/// A rotor of 0.5 kg m² in a bearing of 3 N m, driven by a torque.
fn rotor(torque: &str) -> String {
    format!(
        r#"format = 1
        name = "rotor"
        members = ["a"]
        inertias = {{ a = "0.5 kg m^2" }}
        [[drag]]
        name = "bearing"
        members = ["a"]
        coulomb = "3 N m"
        [[scenario]]
        name = "run"
        duration = "2 s"
        [[scenario.source]]
        name = "motor"
        member = "a"
        torque = {torque}
        "#
    )
}

/// Where all is held nothing limits a step but what the signals do.
#[test]
fn a_short_excess_breaks_away() {
    for amplitude in [3.001, 3.01, 3.2, 4.4] {
        let sine = format!(r#"{{ type = "sine", amplitude = "{amplitude} N m", frequency = "1 Hz" }}"#);
        let (rows, _) = run(&rotor(&sine), &Options::default());
        let expected = (3.0f64 / amplitude).asin() / std::f64::consts::TAU;
        let first = &rows.events[1];
        assert!((first.time_s - expected).abs() < 1e-9, "{amplitude}: {first:?}, not {expected}");
        assert!(rows.events.len() >= 8, "{amplitude}: {:?}", rows.events);
    }
    let pulse = r#"{ type = "expression", formula = "4/(1+((t-1.3)/0.05)^2)" }"#;
    let (rows, _) = run(&rotor(pulse), &Options::default());
    let expected = 1.3 - 0.05 * (1.0f64 / 3.0).sqrt();
    assert!((rows.events[1].time_s - expected).abs() < 1e-9, "{:?}", rows.events);
    let product = r#"{ type = "product", of = [
        { type = "ramp", height = "12.8 N m", at = "0 s", duration = "1 s" },
        { type = "ramp", offset = 1, height = -1, at = "0 s", duration = "1 s" } ] }"#;
    let (rows, _) = run(&rotor(&product.replace('\n', " ")), &Options::default());
    let expected = 0.5 - (0.25f64 - 3.0 / 12.8).sqrt();
    assert!((rows.events[1].time_s - expected).abs() < 1e-9, "{:?}", rows.events);
}

/// The work of a torque over time is controlled like a state: t² on 0.5 kg m² alone does 64/9 J in 2 s.
#[test]
fn work_is_as_exact_as_motion() {
    let text = rotor(r#"{ type = "expression", formula = "t^2" }"#).replace("3 N m", "0 N m");
    let (_, report) = run(&text, &Options::default());
    let work = report.energy.as_ref().expect("counted").sources[0].energy_j;
    assert!((work - 64.0 / 9.0).abs() < 1e-8, "{work}");
    assert!(open_part(&report) < 1e-9);
}

/// A speed told by a formula has its derivative, also late.
#[test]
fn a_prescribed_formula_has_its_acceleration() {
    let text = rotor("\"0 N m\"")
        .replace("3 N m", "0 N m")
        .replace("torque = \"0 N m\"", r#"speed = { type = "expression", formula = "100+sin(100*t)" }"#)
        .replace("duration = \"2 s\"", "start = \"1000 s\"\nend = \"1000.1 s\"");
    let (rows, report) = run(&text, &Options::default());
    let torque = rows.of("motor.torque_n_m").next().unwrap();
    let expected = 0.5 * 100.0 * (100.0 * 1000.0f64).cos();
    assert!((torque - expected).abs() < 1e-6 * expected.abs(), "{torque}, not {expected}");
    assert!(open_part(&report) < 1e-9, "{}", open_part(&report));
}

/// A pair of 60 % with a drag that holds more than it slides with: both hold it, and it breaks away at
/// `3/(3 · 0.6) + 1.3` N m.
#[test]
fn teeth_and_friction_hold_together_in_fixed_steps() {
    let text = r#"format = 1
        name = "pair"
        members = ["a", "b"]
        terminals = ["a", "b"]
        inertias = { a = "0.01 kg m^2", b = "0.05 kg m^2" }
        [[mesh]]
        name = "m"
        gears = [ { member = "a", teeth = 20 }, { member = "b", teeth = 60 } ]
        efficiency = 0.6
        [[drag]]
        name = "d"
        members = ["a"]
        coulomb = "1 N m"
        peak = 1.3
        [[scenario]]
        name = "run"
        duration = "4 s"
        [[scenario.source]]
        member = "a"
        torque = { type = "ramp", height = "4 N m", at = "0 s", duration = "4 s" }
        [[scenario.source]]
        member = "b"
        torque = "3 N m"
        "#;
    let expected = 3.0 / (3.0 * 0.6) + 1.3;
    for (method, within) in
        [(Method::Adaptive, 1e-9), (Method::Fixed { step_s: 1e-3 }, 2e-3), (Method::Fixed { step_s: 1e-4 }, 2e-4)]
    {
        let (rows, _) = run(text, &Options { method, ..Options::default() });
        let first = &rows.events[1];
        assert!((first.time_s - expected).abs() < within, "{method:?}: {first:?}, not {expected}");
    }
}

/// Where prescribed speeds alone move a friction, it turns round with them.
#[test]
fn friction_follows_a_prescribed_speed_in_fixed_steps() {
    let text = r#"format = 1
        name = "driven set"
        members = ["s", "c"]
        terminals = ["s", "c"]
        inertias = { c = "0.4 kg m^2" }
        [[set]]
        name = "P"
        sun = { member = "s", teeth = 30 }
        planet = { teeth = 20 }
        ring = { member = "frame", teeth = 70 }
        carrier = "c"
        mesh_efficiency = 0.9
        [[drag]]
        name = "seal"
        members = ["c"]
        coulomb = "2 N m"
        [[scenario]]
        name = "run"
        duration = "2 s"
        [[scenario.source]]
        member = "s"
        speed = { type = "table", points = [["0 s", "10 rad/s"], ["1 s", "-10 rad/s"], ["2 s", "-10 rad/s"]] }
        [[scenario.source]]
        member = "c"
        torque = "30 N m"
        "#;
    let (_, exact) = run(text, &Options::default());
    let (_, steps) = run(text, &Options { method: Method::Fixed { step_s: 1e-4 }, ..Options::default() });
    for (a, b) in
        exact.energy.as_ref().expect("counted").losses.iter().zip(&steps.energy.as_ref().expect("counted").losses)
    {
        assert_eq!(a.name, b.name);
        assert!((a.energy_j - b.energy_j).abs() < 2e-3 * a.energy_j, "{}: {} and {} J", a.name, a.energy_j, b.energy_j);
    }
}

#[test]
fn what_cannot_move_is_refused() {
    let text = rotor("\"4 N m\"").replace("duration = \"2 s\"", "duration = \"2 s\"\nfixed = [\"a\"]");
    let error = simulate(&train(&text), "run", &Options::default(), &mut ()).unwrap_err();
    assert!(error.to_string().contains("nothing can move"), "{error}");
}

/// What lies beyond a formula's domain, and what signals may not follow.
#[test]
fn formulas_beyond_their_domain_end_the_run() {
    let root = r#"{ type = "expression", formula = "sqrt(0.5 - t)" }"#;
    let motor = format!(
        "{}\n[[scenario.source]]\nmember = \"a\"\nlinear = {{ torque = \"0 N m\", slope = \"1 N m s/rad\" }}",
        rotor(root)
    );
    for method in [Method::Adaptive, Method::Fixed { step_s: 1e-3 }] {
        let (_, report) = run(&motor, &Options { method, ..Options::default() });
        assert!(matches!(report.outcome, Outcome::NotConverged(_)), "{method:?}: {:?}", report.outcome);
    }
    let cases = [
        ("sqrt(0.5 - t)", "not a number", 0.5),
        ("ln(t - 1)", "not a number", 0.0),
        ("ln(1 - t)", "", 1.0),
        ("4/0", "inf", 0.0),
        ("asin(2*t)", "not a number", 0.5),
        ("4 + floor(t)*ln(1.5 - t)", "", 1.5),
    ];
    for (formula, value, at) in cases {
        let text = rotor(&format!(r#"{{ type = "expression", formula = "{formula}" }}"#)).replace("3 N m", "0 N m");
        for method in [Method::Adaptive, Method::Fixed { step_s: 1e-3 }] {
            let (_, report) = run(&text, &Options { method, ..Options::default() });
            let Outcome::NotConverged(why) = &report.outcome else { panic!("{formula}: {:?}", report.outcome) };
            let told = format!("`motor`: the formula \"{formula}\" is {value}");
            assert!(why.contains(&told), "{method:?}: {why}");
            let time = why.rsplit_once("at t = ").and_then(|(_, t)| t.split(' ').next()?.parse::<f64>().ok());
            assert!(time.is_some_and(|t| (t - at).abs() < 2e-3), "{formula}, {method:?}: {why}");
        }
    }
    let follows =
        rotor("\"0 N m\"").replace("torque = \"0 N m\"", r#"speed = { type = "expression", formula = "10 + w_a" }"#);
    let error = simulate(&train(&follows), "run", &Options::default(), &mut ()).unwrap_err();
    assert!(error.to_string().contains("cannot follow the speeds"), "{error}");
}

/// A torque that a formula turns on and off: what it does over time is known in closed form, at any frequency.
#[test]
fn val_formulas_that_jump_act_as_they_say() {
    // Formula, and its integral from 0 to 2 s.
    let cases = [
        ("25*floor(2*fract(t))".to_owned(), 25.0),
        ("25*floor(2*fract(100*t))".to_owned(), 25.0),
        ("12.5*(1 + signum(sin(200*PI*t)))".to_owned(), 25.0),
        ("25*floor(2*fract(10000*t))".to_owned(), 25.0),
        ("25*t*floor(2*fract(10*t + 0.3))".to_owned(), 25.0 * shifted()),
        ("floor(floor(3*t)/2)".to_owned(), (4.0 - 2.0) / 3.0 + 2.0 * (2.0 - 4.0 / 3.0)),
        ("signum(t^2 - 2)".to_owned(), 2.0 - 2.0 * std::f64::consts::SQRT_2),
        ("fract(50*t)".to_owned(), 1.0),
    ];
    for (formula, integral) in cases {
        let text = rotor(&format!(r#"{{ type = "expression", formula = "{formula}" }}"#)).replace("3 N m", "0 N m");
        let (rows, report) = run(&text, &Options { energies: false, ..Options::default() });
        assert_eq!(report.outcome, Outcome::Finished, "{formula}");
        let speed = rows.of("speed").last().unwrap();
        assert!((speed - integral / 0.5).abs() < 1e-7, "{formula}: {speed}, not {}", integral / 0.5);
    }
    // What does not fit between two looks is refused, and so is what hangs on speeds.
    for (formula, why) in
        [("25*floor(2*fract(1e8*t))", "jumps too often"), ("floor(2*t - fract(2*t))", "jumps too often")]
    {
        let text = rotor(&format!(r#"{{ type = "expression", formula = "{formula}" }}"#));
        let error = simulate(&train(&text), "run", &Options::default(), &mut ()).unwrap_err();
        assert!(error.to_string().contains(why), "{error}");
    }
    let text = rotor(r#"{ type = "expression", formula = "5*floor(t) - 2*signum(w_a - 3)" }"#);
    let error = willis::train::Train::from_toml(&text).unwrap_err();
    assert!(error.to_string().contains("`signum(w_a-3)`"), "{error}");
}

/// ∫ t dt over what of 2 s is on: from 0.02 s to 0.07 s of each tenth of a second.
fn shifted() -> f64 {
    (0..20).map(|k| f64::from(k) * 0.1).map(|t| 0.5 * ((t + 0.07).powi(2) - (t + 0.02).powi(2))).sum()
}

/// The lost energy of the rows is that of the report.
#[test]
fn the_rows_end_with_the_losses_of_the_report() {
    let (rows, report) =
        run(&rotor(r#"{ type = "sine", amplitude = "9 N m", frequency = "1 Hz" }"#), &Options::default());
    let lost: f64 = report.energy.as_ref().expect("counted").losses.iter().map(|l| l.energy_j).sum();
    let last = rows.of("lost_energy").last().unwrap();
    assert!(lost > 1.0 && (last - lost).abs() < 1e-9 * lost, "{last} and {lost}");
    let quiet = Options { energies: false, method: Method::Fixed { step_s: 1e-3 }, ..Options::default() };
    let (_, report) = run(&rotor("\"4 N m\""), &quiet);
    assert!(report.energy.is_none() && report.outcome == Outcome::Finished);
}

/// A run and its vibrations read back as they were written; another contract does not.
#[test]
fn answers_read_back() {
    let text = rotor("\"4 N m\"");
    let (rows, mut report) = run(&text, &Options::default());
    report.event_count = rows.events.len();
    report.events = rows.events;
    assert!(report.events[0].is_start() && report.events.iter().skip(1).all(|e| !e.is_start()));
    report.rows = Some(vec![vec![Some(0.0), None]]);
    let written = serde_json::to_string(&report).expect("plain data");
    assert_eq!(serde_json::from_str::<RunReport>(&written).expect("a run"), report);
    let vibrations = willis::dynamics::modes(&train(&text), None, &[]).expect("an inertia");
    let written_modes = serde_json::to_string(&vibrations).expect("plain data");
    let read: willis::dynamics::ModesReport = serde_json::from_str(&written_modes).expect("vibrations");
    assert_eq!(read, vibrations);
    assert!(serde_json::from_str::<willis::dynamics::ModesReport>(&written).is_err());
    // Names in code are those of the contract.
    for kind in ["time", "speed", "angle", "acceleration", "torque", "power", "mode", "twist", "efficiency", "energy"] {
        let read: ColumnKind = serde_json::from_value(kind.into()).expect("a kind");
        assert_eq!(read.name(), kind);
        assert_eq!(serde_json::to_value(read.unit()).expect("plain data"), read.unit().symbol());
    }
}

/// Nothing acts on it: there is no torque in the equations at all, and the speed stays.
#[test]
fn a_rotor_that_nothing_acts_on_keeps_its_speed() {
    let text = r#"
        format = 1
        name = "lone rotor"
        members = ["rotor"]
        inertias = { rotor = "2 kg m^2" }
        [[scenario]]
        name = "run"
        duration = "3 s"
        initial_speeds = { rotor = "10 rad/s" }
    "#;
    for method in [Method::Adaptive, Method::Fixed { step_s: 1e-2 }] {
        let (rows, report) = run(text, &Options { method, ..Options::default() });
        assert_eq!(report.outcome, Outcome::Finished);
        assert!(rows.of("speed").all(|w| (w - 10.0).abs() < 1e-12));
        assert_eq!(report.energy.expect("counted").residual_j, 0.0);
    }
}

/// A wheel on a spring, with this source.
fn wheel(source: &str, duration: &str) -> String {
    format!(
        "format = 1\nname = \"wheel\"\nmembers = [\"a\", \"b\"]\ninertias = {{ a = \"0.1 kg m^2\", b = \"1 kg m^2\" }}\n\
         [[shaft]]\nname = \"S\"\nmembers = [\"a\", \"b\"]\nstiffness = \"1000 N m/rad\"\ndamping = \"1 N m s/rad\"\n\
         [[scenario]]\nname = \"run\"\nduration = {duration:?}\n[[scenario.source]]\nmember = \"a\"\n{source}\n"
    )
}

#[test]
fn a_run_without_end_is_not_gone_on_with() {
    let sine = "torque = { type = \"sine\", amplitude = \"10 N m\", frequency = \"1e7 Hz\" }";
    let gain = "controller = { setpoint = \"10 rad/s\", proportional = \"1 N m s/rad\", integral = \"1e30 N m/rad\" }";
    for (text, what) in
        [(wheel(sine, "1 s"), "minutes of one core"), (wheel(gain, "1 s"), "does not end in a lifetime")]
    {
        let (rows, report) = run(&text, &Options::default());
        let Outcome::TooLong(why) = &report.outcome else { panic!("{:?}", report.outcome) };
        assert!(why.contains(what), "{why}");
        assert!(!rows.rows.is_empty() && report.end_s > 0.0);
    }
    // As long as it takes, if that is allowed: as much work as the run that ended above had, and more.
    let options = Options { patience_s: f64::INFINITY, ..Options::default() };
    let (_, report) = run(&wheel(sine, "0.01 s"), &options);
    assert_eq!(report.outcome, Outcome::Finished);
}

/// What a formula does is seen however quickly its waves turn; what takes too many steps for that is not begun.
#[test]
fn val_waves_of_formulas_are_not_stepped_over() {
    // ∫ sin(1000 t²) from 0 to 2: Simpson's rule with 4e6 points.
    let chirp = rotor(r#"{ type = "expression", formula = "60*sin(1000*t^2)" }"#).replace("3 N m", "0 N m");
    let (rows, _) = run(&chirp, &Options::default());
    let speed = rows.of("speed").last().expect("rows");
    assert!((speed - 120.0 * 0.019_999_144_578_852).abs() < 1e-7, "{speed}");
    // Held but for an eighth of a millisecond every 2 ms: at every thousandth of the run it is zero.
    let peaks = rotor(r#"{ type = "expression", formula = "3.1*sin(500*PI*t)" }"#);
    let (rows, _) = run(&peaks, &Options::default());
    let expected = (3.0f64 / 3.1).asin() / (500.0 * std::f64::consts::PI);
    assert!((rows.events[1].time_s - expected).abs() < 1e-9, "{:?}", rows.events[1]);
    let quick = |formula: &str| {
        run(&rotor(&format!("{{ type = \"expression\", formula = \"{formula}\" }}")), &Options::default()).1.outcome
    };
    // It breaks away in each of its waves.
    let outcome = quick("10*sin(PI*t*1e9)");
    assert!(matches!(outcome, Outcome::TooManyEvents(_)), "{outcome:?}");
    let outcome = quick("10+10*sin(PI*t*1e9)");
    assert!(matches!(outcome, Outcome::TooLong(_)), "{outcome:?}");
    // Its poles are not stepped over either.
    let outcome = quick("10*tan(PI*t*1e9)");
    assert!(matches!(outcome, Outcome::NotConverged(_)), "{outcome:?}");
}

#[test]
fn too_many_steps_of_fixed_length_are_not_begun() {
    let method = Method::Fixed { step_s: 1e-9 };
    let (rows, report) = run(&wheel("torque = \"10 N m\"", "10 s"), &Options { method, ..Options::default() });
    assert!(matches!(report.outcome, Outcome::TooLong(_)), "{:?}", report.outcome);
    assert!(rows.rows.is_empty() && report.steps == 0);
}

#[test]
fn shafts_stiffer_than_a_fixed_step_stay_bounded_and_right_in_the_mean() {
    for (stiffness, damping, backlash) in [(1e6, 0.0, 0.0), (1e6, 20.0, 0.0), (1e6, 20.0, 2e-3), (1e9, 0.0, 0.0)] {
        let text = format!(
            "format = 1\nname = \"stiff\"\nmembers = [\"a\", \"b\"]\ninertias = {{ a = \"1e-3 kg m^2\", b = \"0.2 kg m^2\" }}\n\
             [[shaft]]\nname = \"S\"\nmembers = [\"a\", \"b\"]\nstiffness = \"{stiffness} N m/rad\"\n\
             damping = \"{damping} N m s/rad\"\nbacklash = \"{backlash} rad\"\n\
             [[scenario]]\nname = \"run\"\nduration = \"2 s\"\n[[scenario.source]]\nmember = \"a\"\ntorque = \"20 N m\"\n\
             [[scenario.source]]\nmember = \"b\"\ntorque = \"-10 N m\"\n"
        );
        let method = Method::Fixed { step_s: 1e-3 };
        let (rows, report) = run(&text, &Options { method, samples: Some(1001), ..Options::default() });
        assert_eq!(report.outcome, Outcome::Finished);
        // Both go on as one: (20 − 10) N m on 0.201 kg m², 20 − 0.001·α on the shaft.
        let rate = 10.0 / 0.201;
        let end = *report.final_speeds_rad_s.get("b").unwrap();
        assert!((end / (2.0 * rate) - 1.0).abs() < 2e-3, "{stiffness} {damping} {backlash}: {end}");
        let torque = rows.names.iter().position(|n| n == "S.torque_n_m").unwrap();
        let last = &rows.rows[rows.rows.len() / 2..];
        let mean = last.iter().map(|row| row[torque]).sum::<f64>() / last.len() as f64;
        assert!((mean.abs() / (20.0 - 1e-3 * rate) - 1.0).abs() < 2e-2, "{stiffness} {damping} {backlash}: {mean}");
        assert!(rows.greatest("S.torque_n_m") < 2e4, "{}", rows.greatest("S.torque_n_m"));
    }
}

#[test]
fn fixed_steps_that_diverge_end_with_a_verdict() {
    let gain = "controller = { setpoint = \"10 rad/s\", proportional = \"1e4 N m s/rad\", integral = \"1e9 N m/rad\" }";
    let domain = "torque = { type = \"expression\", formula = \"sqrt(0.5 - t)\" }";
    for source in [gain, domain] {
        let method = Method::Fixed { step_s: 1e-3 };
        let (rows, report) = run(&wheel(source, "1 s"), &Options { method, ..Options::default() });
        let Outcome::NotConverged(why) = &report.outcome else { panic!("{source}: {:?}", report.outcome) };
        assert!(why.contains("at t = "), "{why}");
        // An efficiency may be undetermined.
        for column in ["speed", "angle", "torque", "acceleration"] {
            assert!(rows.of(column).all(|x| x.is_finite()), "{source}: {column}");
        }
    }
}

/// A rigid clutch joins what turns alike to within what is known of the speeds, and nothing else.
#[test]
fn what_turns_alike_can_be_joined() {
    for (apart, joins) in [(0.0, true), (4e-10, true), (1e-7, false), (1e-4, false)] {
        let text = format!(
            r#"
            format = 1
            name = "two rotors"
            members = ["a", "b"]
            inertias = {{ a = "1 kg m^2", b = "3 kg m^2" }}

            [[shift_element]]
            name = "C"
            kind = "clutch"
            members = ["a", "b"]

            [[scenario]]
            name = "join"
            duration = "2 s"
            initial_speeds = {{ a = "178.023584 rad/s", b = "{} rad/s" }}
            engagement = [{{ element = "C", value = {{ type = "step", at = "1 s", height = 1 }} }}]
            "#,
            178.023584 * (1.0 + apart)
        );
        let train = train(&text);
        let report = simulate(&train, "join", &Options::default(), &mut ()).expect("a run");
        match report.outcome {
            Outcome::Finished => assert!(joins, "{apart:e}"),
            Outcome::Impact(why) => {
                assert!(!joins, "{apart:e}: {why}");
                // The amount is told, however small.
                assert!(!why.contains("of 0 rad/s") && !why.contains("of -0 rad/s"), "{why}");
            }
            other => panic!("{apart:e}: {other:?}"),
        }
    }
}
