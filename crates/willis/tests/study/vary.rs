//! Trains that differ in values of their file: however they come about, one by one or one after the other, their answers are
//! the same to the last bit.

use std::sync::Arc;

use willis::analysis;
use willis::diagnostic::Code;
use willis::losses;
use willis::model::{Model, Target};
use willis::study::{Axis, Hold, PointAnswer, PointAnswers, PointSetup, TrainCache};
use willis::train::{Measure, Operation, Train};

use crate::common::examples;

/// Every digit of an answer.
fn all(answer: &PointAnswer) -> String {
    format!("{answer:?}")
}

/// The numbers, verdict and warnings of an answer.
fn numbers(answer: &PointAnswer) -> String {
    format!("{:?} {} {:?} {:?} {:?}", answer.verdict, answer.reason, answer.numbers, answer.warnings, answer.ratio)
}

/// The number and the unit of a value as written.
fn parts(text: &str) -> Option<(f64, &str)> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).unwrap_or(text.len());
    Some((text[..end].trim().parse().ok()?, text[end..].trim()))
}

/// A few values of every number of every example, each set alone: as a study sets it, and written into the file. Beside, all
/// these trains one after the other.
#[test]
fn a_value_set_is_the_value_written() {
    let mut set = 0;
    for (name, text) in examples() {
        // What no example gives.
        let text = match text.contains("\n[heat]\n") && !text.contains("\nfactor = ") {
            true => text.replace("\n[heat]\n", "\n[heat]\nfactor = 1.1\n"),
            false => text,
        };
        let text = match text.contains("\n[oil]\n") && !text.contains("\n[losses") {
            true => text + "\n[losses]\nfactor = { teeth = 1.1 }\n",
            false => text,
        };
        let Ok(model) = Model::from_toml(&text) else { continue };
        let Ok(question) = PointSetup::new(&model, None, None, Hold::AsGiven) else { continue };
        if question.base().loads.is_empty() {
            continue;
        }
        let quantities = model.document().quantities();
        let given: Vec<_> = (quantities.iter())
            .filter(|(path, key)| {
                let question = ["operation", "scenario", "study"].iter().any(|list| path.starts_with(list));
                matches!(key.measure, Measure::Number | Measure::Quantity(_)) && !question
            })
            .filter_map(|(path, key)| Some((path, model.document().value(key)?)))
            .collect();
        // Long files repeat themselves, but for what a study may set without reading them again.
        let every = given.len().div_ceil(24).max(1);
        let alone = ["efficiency", "roughness", "radial_load", "axial_load", "factor"];
        let is_chosen = |k: usize, path: &str| k.is_multiple_of(every) || alone.iter().any(|key| path.contains(key));
        let mut trains: Vec<(Arc<Train>, Operation)> = vec![];
        for (_, (path, value)) in given.iter().enumerate().filter(|(k, (path, _))| is_chosen(*k, path)) {
            let Some((number, unit)) = parts(value) else { continue };
            for factor in [0.97, 1.004, 0.0, -1.0] {
                let text = format!("{:.6} {unit}", number * factor).trim().to_owned();
                let target = Target::parse(path, &model).unwrap();
                if !target.is_of_train() {
                    continue;
                }
                let quick = question.at(&[(&target, text.clone())], &mut TrainCache::default());
                let slow = model.with([(path, &text)]);
                match (quick, slow) {
                    (Ok((train, operation)), Ok(written)) => {
                        let [own, other] = [&*train, written.train()].map(|t| PointAnswer::of(t, &operation));
                        assert_eq!(all(&own), all(&other), "{name}: {path} = {text}");
                        // What planets weigh matters to scenarios, which a study leaves out.
                        let assumed = |t: &Train| {
                            let all = analysis::assumptions(t).into_iter();
                            all.filter(|line| !line.contains("resist acceleration")).collect::<Vec<_>>()
                        };
                        assert_eq!(assumed(&train), assumed(written.train()), "{name}: {path} = {text}");
                        trains.push((train, operation));
                        set += 1;
                    }
                    (Err(_), Err(_)) => {}
                    // What a study does not ask of the file may be wrong there.
                    (Ok(_), Err(wrong)) => {
                        let aside = ["operation", "scenario", "study"];
                        let told = wrong.to_string();
                        assert!(aside.iter().any(|list| told.contains(list)), "{name}: {path} = {text}: {told}");
                    }
                    (Err(wrong), Ok(_)) => panic!("{name}: {path} = {text}: {wrong}"),
                }
            }
        }
        // Laws change which losses there are.
        for entry in losses::entries() {
            let target = Target::parse(&format!("law.{}", entry.family), &model).unwrap();
            trains.extend(question.at(&[(&target, entry.id.to_owned())], &mut TrainCache::default()).ok());
        }
        one_after_the_other(&name, &trains);
    }
    assert!(set > 1000, "{set} values");
}

/// The trains in their order, then in turns with the first.
fn one_after_the_other(name: &str, trains: &[(Arc<Train>, Operation)]) {
    let turns = trains.iter().flat_map(|t| [t, &trains[0]]);
    let points: Vec<_> = trains.iter().chain(turns).cloned().collect();
    let mut k = 0;
    PointAnswers::each(points.iter().cloned().map(Ok), false, |answer, _| {
        let (train, operation) = &points[k];
        assert_eq!(numbers(&answer), numbers(&PointAnswer::of(train, operation)), "{name}, train {k}");
        k += 1;
    });
    assert_eq!(k, points.len());
}

/// More trains than are kept, in values that are set where others were before: each as if it were the only one.
#[test]
fn a_train_given_other_numbers_is_a_new_one() {
    let mut compared = 0;
    for (name, text) in examples().into_iter().filter(|(_, text)| text.contains("roughness") || text.contains("[heat]"))
    {
        let Ok(model) = Model::from_toml(&text) else { continue };
        let Ok(question) = PointSetup::new(&model, None, None, Hold::AsGiven) else { continue };
        let alone = ["roughness", "radial_load", "axial_load", "efficiency"];
        let quantities = model.document().quantities();
        let given: Vec<(Target, f64, String)> = (quantities.iter())
            .filter(|(path, _)| alone.iter().any(|key| path.contains(key)))
            .filter_map(|(path, key)| {
                let value = model.document().value(key)?;
                let (number, unit) = parts(&value)?;
                Some((Target::parse(path, &model).ok()?, number, unit.to_owned()))
            })
            .take(5)
            .collect();
        if given.len() < 2 || question.base().loads.is_empty() {
            continue;
        }
        let law = Target::parse("law.film", &model).unwrap();
        let laws: Vec<&str> = losses::entries().iter().filter(|e| e.family == "film").map(|e| e.id).collect();
        // Now and then a value that the file may not have, fewer values than before, and laws in turns.
        let settings = |k: usize| -> Vec<(&Target, String)> {
            let factor =
                |j: usize| if k % 31 == 30 && j == 1 { -1.0 } else { 1.0 - 0.0003 * ((k * (j + 3)) % 101) as f64 };
            let own = given.iter().enumerate().take(if k % 17 == 5 { 1 } else { given.len() });
            own.map(|(j, (target, number, unit))| {
                (target, format!("{:.9} {unit}", number * factor(j)).trim().to_owned())
            })
            .chain((k % 13 > 3).then(|| (&law, laws[k % laws.len()].to_owned())))
            .collect()
        };
        let (mut trains, mut k) = (TrainCache::default(), 0);
        PointAnswers::each((0..200).map(|k| question.at(&settings(k), &mut trains)), false, |answer, asked| {
            match question.at(&settings(k), &mut TrainCache::default()) {
                Ok((train, operation)) => {
                    assert!(asked.is_some(), "{name} {k}");
                    assert_eq!(numbers(&answer), numbers(&PointAnswer::of(&train, &operation)), "{name} {k}");
                    compared += 1;
                }
                Err(_) => assert!(asked.is_none(), "{name} {k}"),
            }
            k += 1;
        });
        assert_eq!(k, 200);
    }
    assert!(compared > 500, "{compared}");
}

/// A member called `output` that is not the output of its train: neither is taken for the other.
#[test]
fn a_role_and_a_member_of_that_name_are_not_mixed_up() {
    let text = |terminals: &str| {
        format!(
            r#"
            format = 1
            name = "pair"
            members = ["input", "output", "third"]
            terminals = {terminals}
            mesh = [{{ gears = [{{ member = "input", teeth = 20 }}, {{ member = "output", teeth = 40 }}] }},
                    {{ gears = [{{ member = "output", teeth = 20 }}, {{ member = "third", teeth = 40 }}] }}]
            "#
        )
    };
    for (terminals, good) in [
        (r#"["input", "output"]"#, [true, true]),
        (r#"["output", "input"]"#, [false, false]),
        (r#"["input", "third"]"#, [true, false]),
        (r#"["third", "output"]"#, [false, true]),
    ] {
        let model = Model::from_toml(&text(terminals)).unwrap_or_else(|wrong| panic!("{wrong}"));
        for (name, good) in ["input", "output"].into_iter().zip(good) {
            for (what, values) in [("speed", "10..20 rpm:2"), ("torque", "1..2 N m:2"), ("power", "1..2 kW:2")] {
                let axis = Axis::parse(&format!("{name}.{what}={values}"), &model);
                assert_eq!(axis.is_ok(), good, "{terminals} {name}.{what}");
                let told = axis.err().map(|d| (d.code, d.message.contains("two meanings")));
                assert!(told.is_none_or(|told| told == (Code::DuplicateName, true)));
            }
        }
        assert!(Axis::parse("third.torque=1..2 N m:2", &model).is_ok());
    }
}
