//! Regimes at their edges: boundaries, balanced powers, trains that are large, odd or wrong.

use willis::analysis::{Selection, analyze};
use willis::diagnostic::Diagnostics;
use willis::regimes::{
    Atlas, FormulaRequest, LocateRequest, RegimeSelection, Regimes, family, formulas, locate, regimes,
};
use willis::symbolic::Notation;
use willis::train::Train;
use willis::units::{self, Dimension, Quantity};

use crate::common::{example, examples};

fn all(text: &str, selection: &RegimeSelection) -> Regimes {
    regimes(&Train::from_toml(text).unwrap(), selection).unwrap()
}

fn as_drawn(text: &str) -> Atlas {
    let selection = RegimeSelection { state: Some("as drawn".into()), ..Default::default() };
    all(text, &selection).states.remove(0)
}

/// An operation at given speeds and torques (numbers without unit), analysed: loss over input power
/// of each equilibrium, and the torques.
fn losses(text: &str, speeds: &[(String, f64)], torques: &[(String, f64)]) -> Vec<(f64, Vec<(String, f64)>)> {
    let list = |all: &[(String, f64)], unit: &str| {
        all.iter().map(|(m, x)| format!("\"{m}\" = \"{x:?} {unit}\"")).collect::<Vec<_>>().join(", ")
    };
    let text = format!(
        "{text}\n[[operation]]\nname = \"edge\"\nspeeds = {{ {} }}\ntorques = {{ {} }}\n",
        list(speeds, "rad/s"),
        list(torques, "N m")
    );
    let train = Train::from_toml(&text).unwrap();
    let selection = Selection { operation: Some("edge".into()), ..Default::default() };
    let analysis = analyze(&train, &selection).unwrap();
    let torque = |s: &willis::analysis::SolutionReport| {
        s.members.iter().filter_map(|(n, m)| Some((n.clone(), m.torque_n_m?))).collect::<Vec<_>>()
    };
    analysis.operations[0].solutions.iter().map(|s| (s.loss_w, torque(s))).collect()
}

/// Base speeds of a direction a little to one side of a boundary.
fn beside(atlas: &Atlas, region: usize, direction: [f64; 2], step: f64) -> Vec<(String, f64)> {
    let inside = &atlas.regions[region - 1].example;
    atlas
        .base_speeds
        .iter()
        .enumerate()
        .map(|(k, name)| {
            let own = inside.get(name).copied().unwrap();
            (name.clone(), direction[k] + step * (own - direction[k]))
        })
        .collect()
}

#[test]
fn val_loss_is_continuous_across_every_boundary() {
    let mut compared = 0;
    for name in ["esmail-fig1", "esmail-fig1-band", "prius-p112", "bevel-differential", "uts-60-1161"] {
        let text = example(name);
        let atlas = as_drawn(&text);
        if atlas.reason.is_some() || atlas.base_speeds.len() != 2 {
            continue;
        }
        for b in &atlas.boundaries {
            let plane = atlas.planes.iter().find(|p| p.label == b.label).unwrap();
            let slides = plane.without_relative_motion.is_empty();
            for c in &b.crossings {
                let (before, after) = (c.efficiency_before.unwrap(), c.efficiency_after.unwrap());
                assert!((before - after).abs() < 1e-12, "{name}: {}: {before} {after}", b.label);
                // By the solver, on both sides, with the same torque on a terminal whose sign settles the rest.
                let [from, to] = [&c.from, &c.to].map(|id| atlas.regimes.iter().find(|r| r.id == *id).unwrap());
                let (terminal, load) = from.example.torques.iter().find(|(_, t)| *t != 0.0).unwrap();
                let load = [(terminal.clone(), load.signum())];
                let step = 1e-7;
                let one = losses(&text, &beside(&atlas, b.between[0], b.direction, step), &load);
                let other = losses(&text, &beside(&atlas, b.between[1], b.direction, step), &load);
                let [loss] = &one[..] else { panic!("{name}: {} equilibria", one.len()) };
                let [next] = &other[..] else { panic!("{name}: {} equilibria", other.len()) };
                assert!((loss.0 - next.0).abs() < 1e-5, "{name}: {}: {} {}", b.label, loss.0, next.0);
                if slides {
                    assert_eq!(from.drivers, to.drivers, "{name}: {}", b.label);
                    for ((_, x), (_, y)) in loss.1.iter().zip(&next.1) {
                        assert!((x - y).abs() < 1e-9, "{name}: {}: torque {x} {y}", b.label);
                    }
                } else {
                    // Where the teeth stop sliding nothing is lost, and the torques jump.
                    assert!(loss.0.abs() < 1e-5 && (before - 1.0).abs() < 1e-12);
                    assert_ne!(from.drivers, to.drivers);
                }
                compared += 1;
            }
        }
    }
    assert!(compared >= 64, "only {compared} crossings");
}

#[test]
fn val_balanced_powers_add_to_zero_and_are_in_equilibrium() {
    let text = example("compound-split");
    let balance = Some(["mg_a".to_owned(), "mg_b".to_owned()]);
    let atlas = all(&text, &RegimeSelection { balance, ..Default::default() }).states.remove(0);
    assert_eq!(atlas.independent_torques, 1);
    let mut checked = 0;
    for r in &atlas.regimes {
        let region = &atlas.regions[r.region - 1];
        for weight in [0.02, 0.3, 0.5, 0.8, 0.97] {
            let (from, to) = (region.from.unwrap(), region.to.unwrap());
            let unit = |v: [f64; 2]| v.map(|x| x / v[0].hypot(v[1]));
            let (a, b) = (unit(from), unit(to));
            let speeds: Vec<(String, f64)> = atlas
                .base_speeds
                .iter()
                .enumerate()
                .map(|(k, n)| (n.clone(), 100.0 * ((1.0 - weight) * a[k] + weight * b[k])))
                .collect();
            let speed = |x: f64| units::parse(&format!("{x:?} rad/s"), Dimension::ANGULAR_SPEED).unwrap();
            let lead = r.torque_signs.0[0].1;
            let found = locate(
                &Train::from_toml(&text).unwrap(),
                &LocateRequest {
                    balance: Some(["mg_a".into(), "mg_b".into()]),
                    speeds: speeds.iter().map(|(n, w)| (n.clone(), speed(*w))).collect(),
                    torques: vec![(
                        r.torque_signs.0[0].0.clone(),
                        units::parse(&format!("{lead} N m"), Dimension::TORQUE).unwrap(),
                    )],
                    ..Default::default()
                },
            )
            .unwrap();
            let here = found.regimes.iter().find(|x| x.regime.as_deref() == Some(&r.id));
            let here = here.unwrap_or_else(|| panic!("{} not found at {weight}: {found:?}", r.id));
            let power = |n: &str| *here.powers_w.get(n).unwrap();
            assert!((power("mg_a") + power("mg_b")).abs() < 1e-9 * power("engine").abs().max(1.0));
            assert_eq!(here.roles, r.roles, "{}", r.id);
            let [low, high] = r.efficiency_range.unwrap();
            assert!((low - 1e-9..=high + 1e-9).contains(&here.efficiency), "{}: {}", r.id, here.efficiency);
            // Two of its torques prescribed, the solver finds the others.
            let torque = |n: &str| (n.to_owned(), *here.torques_n_m.get(n).unwrap());
            let solved = losses(&text, &speeds, &[torque("engine"), torque("mg_a")]);
            let agrees = solved.iter().any(|(_, all)| {
                all.iter().all(|(n, t)| here.torques_n_m.get(n).is_none_or(|own| (own - t).abs() < 1e-8))
            });
            assert!(agrees, "{} at {weight}: {:?} {solved:?}", r.id, here.torques_n_m);
            checked += 1;
        }
    }
    assert!(checked >= 150);
}

/// A row of coupled sets with two freedoms: sun k, ring k + 1, carrier k + 2.
fn row(sets: usize, efficiency: f64, terminals: &[usize]) -> String {
    let names =
        |list: &mut dyn Iterator<Item = usize>| list.map(|k| format!("\"m{k}\"")).collect::<Vec<_>>().join(", ");
    let mut text = format!(
        "format = 1\nname = \"row\"\nmembers = [{}]\nterminals = [{}]\n",
        names(&mut (0..sets + 2)),
        names(&mut terminals.iter().copied())
    );
    for k in 0..sets {
        text += &format!(
            "[[set]]\nname = \"P{k}\"\nsun = {{ member = \"m{k}\", teeth = {} }}\nring = {{ member = \"m{}\", teeth = {} }}\n\
             carrier = \"m{}\"\nmesh_efficiency = {efficiency}\n",
            20 + 3 * k,
            k + 1,
            70 + 3 * k + 2 * (k % 2),
            k + 2
        );
    }
    text
}

#[test]
fn regress_five_sets_with_two_freedoms_take_seconds() {
    for efficiency in [0.99, 0.8] {
        let atlas = as_drawn(&row(5, efficiency, &[0, 1, 6]));
        assert!(atlas.reason.is_none() && atlas.regimes.len() >= 16 && !atlas.formulas.is_empty());
    }
    // Four terminals: two independent torques.
    let atlas = as_drawn(&row(5, 0.95, &[0, 1, 3, 6]));
    assert!(!atlas.regimes.is_empty() || atlas.reason.is_some_and(|r| r.contains("willis locate")));
}

#[test]
fn regress_too_large_says_how_large_and_offers_a_place() {
    let terminals: Vec<usize> = (0..14).collect();
    let text = row(12, 0.9, &terminals);
    let reason = as_drawn(&text).reason.expect("too large");
    assert!(reason.contains("regions") && reason.contains("willis locate"), "{reason}");
    // Which answers.
    let train = Train::from_toml(&row(12, 0.99, &[0, 1, 13])).unwrap();
    let speed = |text| units::parse(text, Dimension::ANGULAR_SPEED).unwrap();
    let request = LocateRequest {
        speeds: vec![("m0".into(), speed("100 rpm")), ("m1".into(), speed("-35 rpm"))],
        torques: vec![("m0".into(), units::parse("1 N m", Dimension::TORQUE).unwrap())],
        ..Default::default()
    };
    let place = locate(&train, &request).unwrap();
    assert_eq!(place.regimes.len(), 1, "{place:?}");
}

/// Simple sets in series, each with its ring held, and behind them planets between the frame and the last shaft whose carrier
/// is driven: nearly locked by themselves.
fn behind_sets(sets: usize) -> String {
    let shafts: Vec<String> = (0..sets + 2).map(|k| format!("s{k}")).collect();
    let last = &shafts[sets + 1];
    let mut text = format!("format = 1\nname = \"long\"\nmembers = {shafts:?}\nterminals = [\"s0\", \"{last}\"]\n");
    for k in 0..sets {
        text += &format!(
            "[[set]]\nname = \"P{k}\"\ntype = \"simple\"\nsun = {{ member = \"s{k}\", teeth = 30 }}\n\
             ring = {{ member = \"frame\", teeth = {} }}\ncarrier = \"s{}\"\nbasic_efficiency = 0.98\n",
            60 + 2 * (k % 7),
            k + 1
        );
    }
    text + &format!(
        "[[set]]\nname = \"B\"\ntype = \"stepped\"\nsuns = [ {{ member = \"frame\", teeth = 50, planet_teeth = 20 }}, \
         {{ member = \"{last}\", teeth = 51, planet_teeth = 21 }} ]\ncarrier = \"s{sets}\"\nbasic_efficiency = 0.9\n"
    )
}

/// A train may be longer than all its drivers could be tried: its stages are, one after the other.
#[test]
fn a_long_train_is_decided_as_its_stages_are() {
    // With the frame driving: T_last/T_carrier = −ρ i/(1 − ρ i) with i = 34/35 and ρ = 9/10, over the ratio of the speeds.
    let stage = 0.9 * (1.0 - 34.0 / 35.0) / (1.0 - 0.9 * 34.0 / 35.0);
    for sets in [1, 5, 11, 12, 13, 15, 16, 40] {
        let text = behind_sets(sets);
        let product: f64 =
            (0..sets).map(|k| (60 + 2 * (k % 7)) as f64 / 30.0).map(|i| (1.0 + 0.98 * i) / (1.0 + i)).product();
        let atlas = as_drawn(&text);
        assert_eq!(atlas.reason, None, "{sets}");
        let [through, heat] = [["s0"].as_slice(), &["s0", &format!("s{}", sets + 1)]].map(|inputs| {
            let all: Vec<_> = atlas.regimes.iter().filter(|r| r.inputs == inputs).collect();
            assert_eq!(all.len(), 2, "{sets}: there and back");
            all[0]
        });
        assert!(heat.all_dissipated && heat.efficiency_range == Some([0.0; 2]), "{sets}");
        let [efficiency, same] = through.efficiency_range.unwrap();
        assert!(efficiency == same && (efficiency / (product * stage) - 1.0).abs() < 1e-12, "{sets}: {efficiency}");
        assert_eq!((atlas.regimes.len(), atlas.formulas.len()), (4, 2), "{sets}");
        // One torque is carried in two ways, and the other in none.
        let speed = [("s0".to_owned(), 100.0)];
        let of = |torque: f64| losses(&text, &speed, &[("s0".to_owned(), torque)]);
        let found = [of(1.0), of(-1.0)];
        let mut numbers = [found[0].len(), found[1].len()];
        numbers.sort_unstable();
        assert_eq!(numbers, [0, 2], "{sets}");
    }
}

/// Two rows of sets that a differential joins: its formulas are sums of two long products.
#[test]
fn formulas_that_would_be_too_long_are_not_begun() {
    let joined = |sets: usize| {
        let members: Vec<String> =
            ["a", "b"].iter().flat_map(|row| (0..=sets).map(move |k| format!("{row}{k}"))).collect();
        let mut text = format!(
            "format = 1\nname = \"joined\"\nmembers = {:?}\nterminals = [\"a0\", \"b0\", \"out\"]\n",
            [members, vec!["out".to_owned()]].concat()
        );
        for (row, k) in ["a", "b"].iter().flat_map(|row| (0..sets).map(move |k| (row, k))) {
            text += &format!(
                "[[set]]\nname = \"{row}{k}\"\ntype = \"simple\"\nsun = {{ member = \"{row}{k}\", teeth = 30 }}\n\
                 ring = {{ member = \"frame\", teeth = 70 }}\ncarrier = \"{row}{}\"\nbasic_efficiency = 0.98\n",
                k + 1
            );
        }
        text + &format!(
            "[[set]]\nname = \"D\"\ntype = \"simple\"\nsun = {{ member = \"a{sets}\", teeth = 30 }}\n\
             ring = {{ member = \"b{sets}\", teeth = 60 }}\ncarrier = \"out\"\nbasic_efficiency = 0.98\n"
        )
    };
    for sets in [2, 20] {
        let atlas = as_drawn(&joined(sets));
        assert_eq!((atlas.reason.as_deref(), atlas.regimes.len()), (None, 16), "{sets}");
        let is_told = atlas.notes.iter().any(|n| n.contains("no closed formula") && n.contains("terms"));
        assert_eq!((atlas.formulas.is_empty(), is_told), (sets > 2, sets > 2), "{sets}: {:?}", atlas.notes);
    }
}

fn rpm(text: &str) -> Quantity {
    units::parse(text, Dimension::ANGULAR_SPEED).unwrap()
}

fn nm(text: &str) -> Quantity {
    units::parse(text, Dimension::TORQUE).unwrap()
}

/// Everything that can be asked about the regimes of a train; no panic.
fn everything(text: &str) -> Vec<String> {
    let train = Train::from_toml(text).unwrap_or_else(|e| panic!("{e}"));
    let mut words: Vec<String> = Vec::new();
    let mut note = |d: Diagnostics| words.push(d.to_string());
    let selection = RegimeSelection::default();
    let mut reasons: Vec<String> = Vec::new();
    match regimes(&train, &selection) {
        Ok(all) => {
            serde_json::to_string(&all).unwrap();
            reasons.extend(all.states.into_iter().filter_map(|a| a.reason));
        }
        Err(d) => note(d),
    }
    match formulas(&train, &FormulaRequest::default()) {
        Ok(sheet) => {
            for notation in
                [Notation::Text, Notation::Latex, Notation::Python, Notation::Rust, Notation::C, Notation::Modelica]
            {
                sheet.emit(notation, true);
            }
            reasons.extend(sheet.without.into_iter().map(|(_, why)| why));
        }
        Err(d) => note(d),
    }
    let _ = family(&train, &selection).map_err(&mut note);
    let members: Vec<String> = train.members().iter().skip(1).map(|m| m.name.clone()).collect();
    for n in 0..3 {
        let speeds = members.iter().take(n).map(|m| (m.clone(), rpm("10 rpm"))).collect();
        let torques = members.iter().take(n).map(|m| (m.clone(), nm("1 N m"))).collect();
        let request = LocateRequest { speeds, torques, ..Default::default() };
        if let Err(d) = locate(&train, &request) {
            note(d);
        }
    }
    words.extend(reasons);
    words
}

#[test]
fn regress_odd_trains_are_answered_in_words() {
    let one = |terminals: &str, rest: &str| {
        format!(
            "format = 1\nname = \"odd\"\nmembers = [\"a\", \"b\", \"c\", \"d\"]\nterminals = [{terminals}]\n\
             [[set]]\nname = \"P\"\nsun = {{ member = \"a\", teeth = 30 }}\nring = {{ member = \"b\", teeth = 71 }}\n\
             carrier = \"c\"\nmesh_efficiency = 0.97\n{rest}"
        )
    };
    let pair =
        "[[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"d\", teeth = 40 } ]\nefficiency = 0.98\n";
    let twice = "[[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]\n\
                 [[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]\n";
    let clutch = "[[shift_element]]\nname = \"K\"\nkind = \"clutch\"\nmembers = [\"a\", \"b\"]\n\
                  [[shift_element]]\nname = \"B\"\nkind = \"brake\"\nmembers = [\"c\"]\n\
                  [[state]]\nname = \"block\"\nengaged = [\"K\"]\n[[state]]\nname = \"held\"\nengaged = [\"K\", \"B\"]\n\
                  [[state]]\nname = \"low\"\nengaged = [\"B\"]\n";
    let lossless = "[[set]]\nname = \"Q\"\nsun = { member = \"b\", teeth = 20 }\nring = { member = \"c\", teeth = 61 }\ncarrier = \"d\"\n";
    let cases: Vec<(String, &str)> = vec![
        (one("", ""), "no terminal"),
        (one("\"a\"", ""), "only terminal"),
        (one("\"a\", \"b\"", ""), "degrees of freedom"),
        (one("\"a\", \"b\", \"c\"", ""), ""),
        (one("\"a\", \"b\", \"c\", \"d\"", ""), ""),
        (one("\"a\", \"b\", \"c\", \"d\"", pair), ""),
        (one("\"a\", \"b\"", twice), "indeterminate"),
        (one("\"a\", \"b\", \"c\"", clutch), "direct drive"),
        (one("\"a\", \"c\"", clutch), ""),
        (one("\"a\", \"b\", \"c\", \"d\"", lossless), ""),
        (one("\"a\", \"d\"", lossless), ""),
        ("format = 1\nname = \"bare\"\nmembers = [\"a\"]\nterminals = [\"a\"]\n".to_owned(), "only terminal"),
    ];
    for (text, expected) in cases {
        let words = everything(&text);
        assert!(words.iter().any(|w| w.contains(expected)) || expected.is_empty(), "{expected}: {words:#?}\n{text}");
    }
}

#[test]
fn regress_every_example_can_be_asked_everything() {
    for (_, text) in examples() {
        everything(&text);
    }
}

#[test]
fn regress_locate_refuses_with_reasons() {
    let train = Train::from_toml(&example("prius-p112")).unwrap();
    let ask = |speeds: &[(&str, &str)], torques: &[(&str, &str)]| {
        locate(
            &train,
            &LocateRequest {
                speeds: speeds.iter().map(|(m, x)| ((*m).to_owned(), rpm(x))).collect(),
                torques: torques.iter().map(|(m, x)| ((*m).to_owned(), nm(x))).collect(),
                ..Default::default()
            },
        )
    };
    let two = [("engine", "1000 rpm"), ("ring", "500 rpm")];
    let says = |result: Result<willis::regimes::Location, Diagnostics>, words: &str| {
        let text = result.unwrap_err().to_string();
        assert!(text.contains(words), "{text}");
    };
    says(ask(&[], &[("engine", "1 N m")]), "no speed is given");
    says(ask(&two[..1], &[("engine", "1 N m")]), "one speed is given");
    says(ask(&two, &[]), "no torque is given");
    says(ask(&two, &[("engine", "1 N m"), ("ring", "1 N m")]), "2 torques are given");
    says(ask(&two, &[("P1.planet", "1 N m")]), "carries no torque");
    says(ask(&[("engine", "0 rpm"), ("ring", "0 rpm")], &[("engine", "1 N m")]), "stands still");
    says(
        ask(&[("engine", "1 rpm"), ("ring", "1 rpm"), ("mg1", "2 rpm")], &[("engine", "1 N m")]),
        "contradict each other",
    );
    // The planet's speed is as good as another.
    assert!(ask(&[("engine", "1000 rpm"), ("P1.planet", "500 rpm")], &[("engine", "1 N m")]).is_ok());
    let none = ask(&two, &[("engine", "0 N m")]).unwrap();
    assert!(none.regimes.is_empty() && none.reason.unwrap().contains("no torque acts"));
}
