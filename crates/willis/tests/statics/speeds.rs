//! Speeds that are prescribed more than once: the same to the last digit that a text has, measured, or contradictory.

use willis::analysis::{OperationReport, Selection, Verdict, analyze, operate};
use willis::diagnostic::Code;
use willis::exact::Rational;
use willis::train::{MemberId, Operation, Train};
use willis::units::{Dimension, Quantity};

use crate::common::examples;

/// The operation with the speed of one more member, off by a part.
fn with_speed(operation: &Operation, member: MemberId, w: f64, part: f64) -> Operation {
    let value = Rational::from_f64(w * (1.0 + part)).unwrap();
    let mut more = operation.clone();
    more.speeds.push((member, Quantity { value, pi_power: 0, dimension: Dimension::ANGULAR_SPEED }));
    more
}

fn same(a: &OperationReport, b: &OperationReport) -> bool {
    let near = |x: f64, y: f64| (x - y).abs() <= 1e-8 * x.abs().max(y.abs()).max(1e-9);
    a.verdict == b.verdict
        && a.solutions.len() == b.solutions.len()
        && a.solutions.iter().zip(&b.solutions).all(|(a, b)| near(a.loss_w, b.loss_w))
        && a.speeds_rad_s.iter().zip(b.speeds_rad_s.iter()).all(|((_, x), (_, y))| match (x, y) {
            (Some(x), Some(y)) => near(*x, *y),
            (x, y) => x == y,
        })
}

#[test]
fn measured_speeds_are_taken_within_a_tolerance() {
    let mut tried = 0;
    for (name, text) in examples() {
        let Ok(train) = Train::from_toml(&text) else { continue };
        let measured = train.clone().with_speed_tolerance(1e-5).unwrap();
        for operation in train.operations() {
            let Ok((plain, _)) = operate(&train, operation) else { continue };
            if plain.verdict != Verdict::Unique {
                continue;
            }
            let given = |m: MemberId| operation.speeds.iter().any(|s| s.0 == m) || operation.fixed.contains(&m);
            for &m in train.terminals().iter().filter(|m| !given(**m)) {
                let Some(Some(w)) = plain.speeds_rad_s.get(train.member_name(m)).copied() else { continue };
                if w == 0.0 {
                    continue;
                }
                let place = || format!("{name}, {}, {}", operation.name, train.member_name(m));
                // What a text of so many digits says, and round-off, are the same speed.
                for part in [0.0, 1e-15, -1e-12, 1e-10, -9e-10] {
                    let (report, _) = operate(&train, &with_speed(operation, m, w, part))
                        .unwrap_or_else(|e| panic!("{}, off by {part}: {e}", place()));
                    assert!(same(&plain, &report) && report.speed_deviation.is_none(), "{}", place());
                }
                let off = with_speed(operation, m, w, 1e-6);
                let wrong = operate(&train, &off).unwrap_err();
                let message = &wrong.iter().next().unwrap().message;
                let numbers = message.split(" turns at ").nth(1).and_then(|t| t.split_once(" rpm, not at "));
                let Some((follows, given)) = numbers else { panic!("{}: {message}", place()) };
                assert_ne!(follows, given.trim_end_matches(" rpm"), "{}: {message}", place());
                assert!(wrong.to_string().contains("`speed_tolerance`"), "{wrong}");
                let (report, notes) = operate(&measured, &off).unwrap();
                let deviation = report.speed_deviation.as_ref().unwrap();
                assert!(same(&plain, &report), "{}", place());
                assert!(deviation.relative > 1e-9 && deviation.relative < 1.001e-6, "{}: {deviation:?}", place());
                assert_eq!(deviation.members.last().unwrap(), train.member_name(m));
                assert!(notes.iter().any(|d| d.code == Code::SpeedsYield), "{}", place());
                assert!(operate(&measured, &with_speed(operation, m, w, 1e-3)).is_err(), "{}", place());
                tried += 1;
            }
        }
    }
    assert!(tried > 30, "{tried}");
}

#[test]
fn a_tolerance_is_a_small_part() {
    let train = crate::common::train("zf-8hp70");
    for wrong in [-0.1, 0.2, f64::NAN, f64::INFINITY] {
        assert!(train.clone().with_speed_tolerance(wrong).unwrap_err().to_string().contains("from 0 to 0.1"));
    }
    assert_eq!(train.clone().with_speed_tolerance(0.0).unwrap().speed_tolerance(), Train::SAME_SPEED);
}

/// The part that a contradiction is said to have is that with which the tolerance is compared.
#[test]
fn the_part_that_is_told_is_enough_of_a_tolerance() {
    let mut told = 0;
    for k in 1..40 {
        let carrier = 1600.0 + 0.1 * f64::from(k * k);
        let text = format!(
            r#"
            format = 1
            name = "measured"
            members = ["sun", "ring", "carrier"]
            terminals = ["sun", "ring", "carrier"]
            set = [{{ name = "P1", sun = {{ member = "sun", teeth = 30 }}, ring = {{ member = "ring", teeth = 70 }}, carrier = "carrier" }}]
            operation = [{{ name = "o", speeds = {{ sun = "3000 rpm", ring = "1000 rpm", carrier = "{carrier} rpm" }}, torques = {{ sun = "1 N m" }} }}]
            "#
        );
        let train = Train::from_toml(&text).unwrap();
        let wrong = analyze(&train, &Selection::default()).unwrap_err().iter().next().unwrap().clone();
        let Some(hint) = wrong.hints.iter().find_map(|h| h.split_once("contradict the gears by ")) else { continue };
        let part = hint.1.split(' ').next().unwrap().parse::<f64>().unwrap() / 100.0;
        told += 1;
        // Two or three digits are told.
        let with =
            |tolerance: f64| analyze(&train.clone().with_speed_tolerance(tolerance).unwrap(), &Selection::default());
        assert!(with((1.06 * part).min(0.1)).is_ok() && with(0.94 * part).is_err(), "{carrier}: {part}");
    }
    assert!(told > 35, "{told}");
}
