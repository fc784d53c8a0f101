//! What other laws of loss make of an efficiency, against whole analyses with these laws.

use willis::analysis::{LawBand, LossRequest, Selection, Verdict, analyze, losses, operate};
use willis::train::{Operation, Train};

use super::common::{example, examples};

/// The efficiency with other laws, asked the long way; and whether one of them is outside its range.
fn with_laws(train: &Train, operation: &Operation, laws: &[(&str, &str)]) -> Option<(f64, bool)> {
    let mut train = train.clone();
    for (family, law) in laws {
        train = train.with_law(family, law).expect("a law that the band names");
    }
    let (report, _) = operate(&train, operation).expect("an answer");
    let outside = report.outside_laws.iter().any(|o| laws.contains(&(&o.family, &o.law)));
    let efficiency = report.solutions.first().filter(|_| report.verdict == Verdict::Unique)?.efficiency?;
    Some((efficiency, outside))
}

fn is_close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

/// Everything that a band says of a point is what an analysis with these laws says.
fn checked(what: &str, train: &Train, operation: &Operation, efficiency: f64, band: &LawBand) {
    assert!(band.low.efficiency < band.high.efficiency, "{what}");
    for end in [&band.low, &band.high] {
        let laws: Vec<(&str, &str)> = end.laws.iter().map(|(family, law)| (family.as_str(), law.as_str())).collect();
        let (found, _) = with_laws(train, operation, &laws).expect("an end of a band is an answer");
        assert!(is_close(found, end.efficiency), "{what}, {laws:?}: {} against {found}", end.efficiency);
    }
    for (family, own) in band.families.iter() {
        for (law, given) in own.efficiencies.iter() {
            let (found, outside) = with_laws(train, operation, &[(family, law)]).expect("it counts");
            assert!(is_close(found, *given), "{what}, {family} = {law}: {given} against {found}");
            assert!(!outside || own.beyond_ranges, "{what}, {family} = {law} is outside its range");
            assert!(band.low.efficiency <= *given && *given <= band.high.efficiency, "{what}, {family} = {law}");
            assert!(*law != own.law || is_close(*given, efficiency), "{what}: the law in force");
        }
        for law in &own.left_out {
            let found =
                train.clone().with_law(family, law).ok().and_then(|_| with_laws(train, operation, &[(family, law)]));
            assert!(found.is_none_or(|(_, outside)| outside), "{what}, {family} = {law} is left out");
        }
    }
    // Two digits of the width are told, and no more.
    let unit = 10f64.powi(-(band.decimals() as i32));
    let width = 100.0 * (band.high.efficiency - band.low.efficiency);
    assert!(band.decimals() == 0 || (10.0..100.0).contains(&(width / unit * 1.000_001)), "{what}: {width}");
}

#[test]
fn bands_of_every_example_are_what_analyses_with_these_laws_say() {
    let (mut bands, mut families) = (0, 0);
    for (name, text) in examples() {
        let Ok(train) = Train::from_toml(&text) else { continue };
        let Ok(plain) = analyze(&train, &Selection::default()) else { continue };
        assert!(plain.operations.iter().all(|o| o.band.is_none()), "nobody asked");
        let all = plain.with_bands(&train);
        for o in &all.operations {
            let computed = o.solutions.iter().any(|s| s.sources.iter().any(|x| x.law != "given"));
            assert!(computed || o.band.is_none(), "{name}, {}: given efficiencies have no band", o.name);
            let Some(band) = &o.band else { continue };
            bands += 1;
            families = families.max(band.families.iter().count());
            let own = train.operations().iter().find(|own| own.name == o.name).expect("it is in the file");
            let mut warm = own.clone();
            warm.temperature = o.oil_k(&train, own);
            let efficiency = o.solutions[0].efficiency.expect("it has a band");
            checked(&format!("{name}, {}", o.name), &train, &warm, efficiency, band);
        }
    }
    assert!(bands >= 6 && families >= 2, "{bands} bands of {families} families at most");
}

/// A gear at a load has the band of the operation that has this load in this gear.
#[test]
fn a_gear_at_a_load_has_the_band_of_its_operation() {
    let mut compared = 0;
    for name in ["fva-planetary-stage", "two-speed-wet-brake", "wang-herringbone-physical"] {
        let train = Train::from_toml(&example(name)).expect("an example");
        let all = analyze(&train, &Selection::default()).expect("an answer").with_loads(&train).with_bands(&train);
        for (state, row) in all.ratios.iter() {
            let Some(at) = &row.at_load else { continue };
            let same = |o: &&willis::analysis::OperationReport| {
                o.state.as_deref().unwrap_or("as drawn") == state && at.operation.as_ref() == Some(&o.name)
            };
            let Some(o) = all.operations.iter().find(same) else { continue };
            let (here, there) = (at.band.as_ref().expect("a band"), o.band.as_ref().expect("a band"));
            assert!(is_close(here.low.efficiency, there.low.efficiency), "{name} {state}");
            assert!(is_close(here.high.efficiency, there.high.efficiency), "{name} {state}");
            compared += 1;
        }
    }
    assert!(compared >= 2, "{compared}");
}

/// The friction of a band is that of the comparison of laws.
#[test]
fn friction_in_a_band_spreads_as_the_comparison_of_laws_does() {
    let train = Train::from_toml(&example("fva-planetary-stage")).expect("an example");
    let compare = LossRequest { compare: Some("mesh_friction".into()), ..LossRequest::default() };
    let table = losses(&train, &compare).expect("a comparison");
    let all = analyze(&train, &Selection::default()).expect("an answer").with_bands(&train);
    assert_eq!(table.spreads.len(), all.operations.len());
    for (spread, o) in table.spreads.iter().zip(&all.operations) {
        let friction = o.band.as_ref().expect("a band").families.get("mesh_friction").expect("teeth rub");
        let all: Vec<f64> = friction.efficiencies.iter().map(|(_, e)| *e).collect();
        let input = o.solutions[0].input_power_w;
        let [low, high] = [f64::min, f64::max].map(|by| all.iter().copied().reduce(by).expect("laws"));
        assert!(is_close(low, 1.0 - spread.most_w.0 / input), "{}: {low}", o.name);
        assert!(is_close(high, 1.0 - spread.least_w.0 / input), "{}: {high}", o.name);
        assert_eq!(friction.efficiencies.iter().count(), spread.inside, "{}", o.name);
    }
}

/// Tests say which friction there is, whatever the law: then laws do not spread it any more.
#[test]
fn what_tests_have_settled_has_no_band() {
    let text = example("fva-planetary-stage");
    let tested = "[losses]\ncalibrated = 'tests'\n[losses.factor]\nteeth = 1.1\n[losses.spread]\nteeth = 0.05\n";
    let train = Train::from_toml(&format!("{text}\n{tested}")).expect("a train with tests");
    let all = analyze(&train, &Selection::default()).expect("an answer").with_bands(&train);
    for o in &all.operations {
        let families = o.band.as_ref().map(|b| b.families.iter().map(|(f, _)| f.clone()).collect::<Vec<_>>());
        assert!(!families.unwrap_or_default().iter().any(|f| f == "mesh_friction"), "{}", o.name);
    }
}

/// Bands come with `losses` only where they are asked for, and there they are those of `analyze`.
#[test]
fn losses_have_the_same_bands() {
    let train = Train::from_toml(&example("fva-planetary-stage")).expect("an example");
    let plain = losses(&train, &LossRequest::default()).expect("losses");
    assert!(plain.points.iter().all(|p| p.band.is_none()));
    let asked = losses(&train, &LossRequest { bands: true, ..LossRequest::default() }).expect("losses");
    let all = analyze(&train, &Selection::default()).expect("an answer").with_bands(&train);
    for (p, o) in asked.points.iter().zip(&all.operations) {
        assert_eq!(p.band, o.band, "{}", o.name);
        assert!(p.band.is_some());
    }
}
