//! The ordinary work of a transmission, with each automatic of the examples: every gear drives away, runs on a test
//! bench, holds, lets go, shifts and reverses.

use willis::dynamics::{Method, Options, Outcome};

use crate::common::example;
use crate::gearbox::{Gearbox, Work, faults, off};
use crate::rows::run;

/// Every example with a shift table of an automatic.
const AUTOMATICS: [&str; 12] = [
    "aisin-ab80",
    "aisin-tl-80sn",
    "ford-10r80",
    "ford-aod",
    "mercedes-9g-tronic",
    "mercedes-w5a580",
    "simpson-ford-c4",
    "zf-4hp22",
    "zf-5hp24",
    "zf-6hp26",
    "zf-8hp-gen4",
    "zf-8hp70",
];

/// Runs of a kind, for all automatics, states, capacities, ways to write them and output inertias: they come to their
/// end, and for one inertia each with the speeds that the reference gives.
fn every(kind: &str, outputs: &[f64], capacities: &[Option<f64>], works: impl Fn(&Gearbox) -> Vec<Work>) {
    let mut bad = vec![];
    let (mut runs, mut compared, mut worst) = (0, 0, 0.0f64);
    for name in AUTOMATICS {
        let g = Gearbox::new(name);
        for (k, work) in works(&g).iter().enumerate() {
            let Some(scenario) = work.text(&g) else { continue };
            for &capacity in capacities {
                for (o, &output) in outputs.iter().enumerate() {
                    let reference = ((o + k) % outputs.len() == 0 && capacity != Some(20_000.0)
                        || capacities.len() == 2)
                        .then(|| work.reference(&g, capacity, output, 1).expect("the reference converges"));
                    for mesh_by_mesh in [false, true] {
                        let text = g.text(mesh_by_mesh, capacity, output, &scenario);
                        let (rows, report) = run(&text, &Options::default());
                        runs += 1;
                        let [from, to] = work.states.map(|s| &g.states[s].0);
                        let mut found = faults(&g, work, capacity.is_none(), &rows, &report);
                        if let Some(reference) = &reference {
                            compared += 1;
                            let (members, most) = off(&g, &report, reference, 1e-2);
                            found.extend(members);
                            worst = worst.max(most);
                        }
                        if !found.is_empty() {
                            bad.push(format!(
                                "{name} {from} to {to}, capacity {capacity:?}, mesh by mesh {mesh_by_mesh}, output {output}: {}",
                                found.join("; ")
                            ));
                        }
                    }
                }
            }
        }
    }
    println!("{kind}: {runs} runs, {compared} beside the reference, {worst:.1e} off at most");
    assert!(bad.is_empty(), "{kind}: {} of {runs} are wrong:\n{}", bad.len(), bad.join("\n"));
}

/// One state each.
fn each_state(kind: &str, work: impl Fn(&Gearbox, usize) -> Work) {
    let works = |g: &Gearbox| {
        let of = |state| Work { states: [state; 2], ..work(g, state) };
        (0..g.states.len()).map(of).collect()
    };
    every(kind, &[0.02, 1.0, 200.0], &[None, Some(20_000.0), Some(3000.0)], works);
}

#[test]
fn every_gear_drives_away() {
    each_state("drive away", |_, _| Work { duration: 1.0, input: vec![[0.0, 0.0], [1.0, 300.0]], ..Work::default() });
}

#[test]
fn every_gear_stops_and_goes() {
    each_state("stop and go", |_, _| Work {
        duration: 6.0,
        input: vec![
            [0.0, 0.0],
            [1.0, 250.0],
            [2.0, 250.0],
            [2.2, -200.0],
            [3.0, -200.0],
            [4.0, 0.0],
            [5.0, 0.0],
            [6.0, 200.0],
        ],
        vehicle: true,
        ..Work::default()
    });
}

#[test]
fn every_gear_holds_on_a_hill_and_rolls_when_let_go() {
    each_state("hill hold", |_, _| Work {
        duration: 2.0,
        input: vec![[0.0, 200.0], [0.5, 200.0], [1.0, 0.0], [2.0, 0.0]],
        output: vec![[0.0, -100.0], [2.0, -100.0]],
        ..Work::default()
    });
}

#[test]
fn every_gear_coasts_to_rest_and_reverses() {
    each_state("coast", |_, _| Work {
        duration: 3.0,
        start: 40.0,
        input: vec![[0.0, 0.0], [0.5, -200.0], [3.0, -200.0]],
        ..Work::default()
    });
}

#[test]
fn every_gear_runs_on_a_test_bench() {
    each_state("bench", |_, _| Work {
        duration: 0.1,
        start: 100.0,
        input: vec![[0.0, 300.0], [0.1, 300.0]],
        bench: true,
        ..Work::default()
    });
}

#[test]
fn every_swap_of_one_element_comes_to_its_end() {
    every("swaps", &[20.0], &[Some(20_000.0), Some(3000.0)], |g| {
        let swapped = |from: usize, to: usize| g.states[from].1.iter().filter(|e| !g.states[to].1.contains(e)).count();
        let n = g.states.len();
        let pairs = (0..n).flat_map(|from| (0..n).map(move |to| [from, to]));
        let work = |states: [usize; 2]| {
            let ratio = g.speeds(states[0], 1.0)?[g.ends[0]];
            let start = if ratio == 0.0 { 0.0 } else { 200.0 / ratio };
            Some(Work { duration: 2.0, states, start, input: vec![[0.0, 150.0], [2.0, 150.0]], ..Work::default() })
        };
        pairs.filter(|[a, b]| a != b && swapped(*a, *b) == 1).filter_map(work).collect()
    });
}

/// Steps of fixed length go through the same motions: the speeds at the end are those of the adaptive
/// method to the order of the step.
#[test]
fn every_gear_does_the_same_in_steps_of_fixed_length() {
    let works = |state: usize| {
        let ramp = |points: &[[f64; 2]]| points.to_vec();
        [
            ("drive away", Work { duration: 1.0, input: ramp(&[[0.0, 0.0], [1.0, 300.0]]), ..Work::default() }),
            (
                "hill hold",
                Work {
                    duration: 2.0,
                    input: ramp(&[[0.0, 200.0], [0.5, 200.0], [1.0, 0.0], [2.0, 0.0]]),
                    output: ramp(&[[0.0, -100.0], [2.0, -100.0]]),
                    ..Work::default()
                },
            ),
            (
                "coast",
                Work {
                    duration: 2.0,
                    start: 40.0,
                    input: ramp(&[[0.0, 0.0], [0.5, -200.0], [2.0, -200.0]]),
                    ..Work::default()
                },
            ),
        ]
        .map(|(kind, work)| (kind, Work { states: [state; 2], ..work }))
    };
    let mut bad = vec![];
    let (mut runs, mut worst) = (0, 0.0f64);
    for name in AUTOMATICS {
        let g = Gearbox::new(name);
        for (state, (kind, work)) in (0..g.states.len()).flat_map(|state| works(state).map(|work| (state, work))) {
            let Some(scenario) = work.text(&g) else { continue };
            for capacity in [None, Some(3000.0)] {
                for mesh_by_mesh in [false, true] {
                    let text = g.text(mesh_by_mesh, capacity, 1.0, &scenario);
                    let (_, exact) = run(&text, &Options::default());
                    let (_, steps) =
                        run(&text, &Options { method: Method::Fixed { step_s: 1e-3 }, ..Options::default() });
                    runs += 1;
                    let fastest = exact.final_speeds_rad_s.iter().map(|(_, w)| w.abs()).fold(1.0, f64::max);
                    let most = (exact.final_speeds_rad_s.iter().zip(steps.final_speeds_rad_s.iter()))
                        .map(|((_, a), (_, b))| (a - b).abs() / fastest)
                        .fold(0.0, f64::max);
                    worst = worst.max(most);
                    if steps.outcome != Outcome::Finished || most > 1e-3 {
                        let state = &g.states[state].0;
                        bad.push(format!(
                            "{name} {state} {kind} {capacity:?} mesh by mesh {mesh_by_mesh}: {:?}, {most:.1e} off",
                            steps.outcome
                        ));
                    }
                }
            }
        }
    }
    println!("{runs} runs in steps, {worst:.1e} off at most");
    assert!(bad.is_empty(), "{} of {runs} are wrong:\n{}", bad.len(), bad.join("\n"));
}

/// Input torque that moves the Ford C4 in second gear against 20 N m at the output: both sets at rest bear by the friction
/// of their teeth. By a linear programme; inertias do not matter.
const C4_MOVES_AT: f64 = 13.843_944_139_685_4;

#[test]
fn val_the_ford_c4_breaks_away_where_a_linear_programme_says() {
    let g = Gearbox::new("simpson-ford-c4");
    let state = g.states.iter().position(|s| s.0 == "2").unwrap();
    let work =
        Work { duration: 0.5, states: [state; 2], input: vec![[0.0, 0.0], [0.2, 0.0], [0.5, 60.0]], ..Work::default() };
    let road = "[[drag]]\nname = \"road\"\nmembers = [\"output\"]\ncoulomb = \"20 N m\"\n";
    let scenario = work.text(&g).unwrap() + road;
    for capacity in [None, Some(20_000.0), Some(3000.0)] {
        for output in [0.02, 0.2, 2.0, 20.0, 200.0] {
            for mesh_by_mesh in [false, true] {
                let (rows, report) = run(&g.text(mesh_by_mesh, capacity, output, &scenario), &Options::default());
                assert_eq!(report.outcome, Outcome::Finished);
                let of = |name: &str| rows.names.iter().position(|n| n == name).unwrap();
                let (time, speed) = (of("time_s"), of("output.speed_rad_s"));
                let moves = rows.rows.iter().find(|row| row[speed] != 0.0).unwrap()[time];
                // The event is a row; the one after it moves.
                let at = rows.rows.iter().rev().find(|row| row[time] < moves).unwrap()[time];
                let expected = 0.2 + C4_MOVES_AT / 200.0;
                assert!((at - expected).abs() < 1e-9, "{capacity:?} {output} {mesh_by_mesh}: {at} for {expected}");
            }
        }
    }
}

#[test]
fn a_wolfrom_drive_closes_its_energy_from_either_side() {
    let text = example("wolfrom-236") + "\n[[scenario]]\nname = \"run\"\nduration = \"2 s\"\n";
    let inertias = "inertias = { sun = \"1e-4 kg m^2\", carrier = \"1e-3 kg m^2\", ring = \"0.05 kg m^2\" }\n";
    let text = text.replacen("[[set]]", &format!("{inertias}[[set]]"), 1);
    for (member, torque) in [("ring", 50.0), ("ring", -300.0), ("sun", 0.5), ("sun", -0.5)] {
        let source = format!("[[scenario.source]]\nmember = {member:?}\ntorque = \"{torque} N m\"\n");
        let (_, report) = run(&format!("{text}{source}"), &Options::default());
        assert_eq!(report.outcome, Outcome::Finished);
        let energy = report.energy.as_ref().unwrap();
        let part = energy.residual_j / (energy.turned_over_j + energy.stored_j.abs());
        assert!(part.abs() < 1e-9, "{member} {torque}: {part}");
    }
}
