//! Regimes and formulas of trains whose losses laws compute: efficiencies of a stated load.

use willis::analysis::{Verdict, operate};
use willis::named::NameMap;
use willis::regimes::{
    EfficiencyBasis, FormulaRequest, LocateRequest, NoBasis, RegimeSelection, family, formulas, locate, regimes,
};
use willis::train::Train;

use crate::common::{example, examples};

/// A train without its bearings: what the analysis tells of a mesh is its teeth alone, and what bearings lose by its load
/// stands beside it.
fn without_bearings(text: &str) -> String {
    let mut written: toml::Table = text.parse().unwrap();
    written.remove("bearing");
    written.to_string()
}

/// A train without its operations.
fn without_operations(text: &str) -> String {
    let mut written: toml::Table = text.parse().unwrap();
    written.remove("operation");
    written.to_string()
}

/// The efficiencies of meshes that the analysis of an operation of the file tells.
fn analysed(train: &Train, operation: &str) -> NameMap<f64> {
    let operation = train.operations().iter().find(|o| o.name == operation).unwrap();
    let (report, _) = operate(train, operation).unwrap();
    assert_eq!(report.verdict, Verdict::Unique, "{}", operation.name);
    report.solutions[0].meshes.iter().map(|(name, mesh)| (name.clone(), mesh.efficiency)).collect()
}

fn assert_alike(basis: &EfficiencyBasis, analysed: &NameMap<f64>) {
    for (name, eta) in basis.efficiencies.iter().filter(|(name, _)| !basis.nominal.contains(name)) {
        let there = analysed.get(name).unwrap();
        // To six decimals.
        assert!((eta - there).abs() <= 0.501e-6, "{name}: {eta} and {there}");
    }
}

#[test]
fn efficiencies_are_those_of_the_analysis_at_the_load_that_is_named() {
    let mut compared = 0;
    for (name, text) in examples() {
        let train = Train::from_toml(&text).unwrap();
        if train.meshes().iter().all(|m| !m.computed) {
            continue;
        }
        // A thermal network names bearings.
        let bare = Train::from_toml(&without_bearings(&text));
        let train = bare.unwrap_or(train);
        let all = regimes(&train, &RegimeSelection::default()).unwrap();
        for state in &all.states {
            let basis = state.efficiency_basis.as_ref().unwrap();
            // Turning as one, no mesh of the train is loaded.
            if basis.reason == Some(NoBasis::NoOperation) {
                assert!(state.reason.is_some(), "{name}, {}: {basis}", state.state);
                continue;
            }
            assert!(basis.is_at_load(), "{name}, {}: {basis}", state.state);
            let Some(operation) = &basis.operation else { panic!("{name}: the file gives the load") };
            let own = train.operations().iter().find(|o| o.name == *operation).unwrap();
            let drawn = own.state.map_or("as drawn", |k| train.states()[k].name.as_str());
            if drawn == state.state && train.bearings().is_empty() {
                assert_alike(basis, &analysed(&train, operation));
                compared += 1;
            }
            // What the words name is what the fields hold.
            let words = basis.to_string();
            assert!(words.contains(operation) && words.contains("°C"), "{words}");
        }
    }
    assert!(compared >= 2, "{compared}");
}

#[test]
fn without_an_operation_efficiencies_are_nominal_and_said_to_be() {
    let text = example("fva-planetary-stage");
    let train = Train::from_toml(&without_operations(&text)).unwrap();
    let all = regimes(&train, &RegimeSelection::default()).unwrap();
    let basis = all.states[0].efficiency_basis.as_ref().unwrap();
    assert_eq!(basis.reason, Some(NoBasis::NoOperation));
    for mesh in train.meshes() {
        assert_eq!(basis.efficiencies.get(&mesh.name), Some(&mesh.efficiency.forward.to_f64()));
    }
    assert!(basis.to_string().contains("nominal, from a coefficient of friction of 0.05"), "{basis}");
    // A train with given efficiencies has nothing to say.
    let given = Train::from_toml(&example("prius-p112")).unwrap();
    let all = regimes(&given, &RegimeSelection::default()).unwrap();
    assert!(all.states.iter().all(|state| state.efficiency_basis.is_none()));
}

#[test]
fn an_operation_without_a_load_is_none_to_take_efficiencies_from() {
    let text = without_operations(&example("fva-planetary-stage"))
        + "\n[[operation]]\nname = \"nothing acts\"\nspeeds = { sun = \"1500 rpm\" }\ntorques = { sun = \"0 N m\" }\n";
    for text in [text.clone(), text.replace("1500 rpm", "0 rpm").replace("0 N m", "100 N m")] {
        let train = Train::from_toml(&text).unwrap();
        let all = regimes(&train, &RegimeSelection::default()).unwrap();
        let basis = all.states[0].efficiency_basis.as_ref().unwrap();
        assert_eq!(basis.reason, Some(NoBasis::NoOperation), "{text}");
    }
}

/// A drive that friction locks when it is driven back has no efficiency there to take over.
#[test]
fn an_operation_that_is_not_unique_is_none_to_take_efficiencies_from() {
    let text = r#"
        format = 1
        name = "locks"
        members = ["sun", "carrier", "ring"]
        terminals = ["sun", "ring"]
        [oil]
        name = "ISO VG 220"
        temperature = "70 degC"
        [laws]
        mesh_friction = "constant"
        friction_coefficient = 0.3
        [[set]]
        name = "P1"
        type = "stepped"
        suns = [{ member = "sun", teeth = 12, planet_teeth = 51 }]
        rings = [
            { member = "frame", teeth = 114, planet_teeth = 51 },
            { member = "ring", teeth = 113, planet_teeth = 50 },
        ]
        carrier = "carrier"
        planet = { count = 3 }
        geometry = { module = "0.7 mm", width = "20 mm", roughness = "0.4 um" }
        [[operation]]
        name = "driven back"
        speeds = { ring = "10 rpm" }
        torques = { ring = "10 N m" }
    "#;
    let train = Train::from_toml(text).unwrap();
    assert_ne!(operate(&train, &train.operations()[0]).unwrap().0.verdict, Verdict::Unique);
    let all = regimes(&train, &RegimeSelection::default()).unwrap();
    let basis = all.states[0].efficiency_basis.as_ref().unwrap();
    assert_eq!(basis.reason, Some(NoBasis::NotUnique(vec!["driven back".into()])));
    assert!(basis.to_string().contains("not exactly one equilibrium at the load of driven back"), "{basis}");
}

#[test]
fn what_bearings_lose_by_the_load_is_in_the_efficiencies() {
    let text = example("fva-planetary-stage");
    let all = |text: &str| {
        let train = Train::from_toml(text).unwrap();
        regimes(&train, &RegimeSelection::default()).unwrap().states[0].efficiency_basis.clone().unwrap()
    };
    let (with, without) = (all(&text), all(&without_bearings(&text)));
    for ((name, eta), (_, teeth)) in with.efficiencies.iter().zip(without.efficiencies.iter()) {
        assert!(eta < teeth, "{name}: {eta} and {teeth}");
    }
}

#[test]
fn formulas_and_regimes_have_one_value() {
    let train = Train::from_toml(&example("fva-planetary-stage")).unwrap();
    let sheet = formulas(&train, &FormulaRequest::default()).unwrap();
    let all = regimes(&train, &RegimeSelection::default()).unwrap();
    let formula = &sheet.formulas[0];
    let basis = formula.basis.as_ref().unwrap();
    assert_eq!(Some(basis), all.states[0].efficiency_basis.as_ref());
    let value = formula.value().unwrap().to_f64();
    let same = all.states[0].regimes.iter().any(|r| (r.example.efficiency - value).abs() < 1e-12);
    assert!(same, "{value}");
    // Sun drives, ring held: (1 - i0 η0)/(1 - i0), with i0 = -z_ring/z_sun and the efficiencies of both meshes.
    let teeth = |k: usize| train.meshes()[k].gears.iter().map(|g| g.teeth.to_f64()).collect::<Vec<_>>();
    let i0 = -(teeth(1)[1] / teeth(0)[0]);
    let eta: f64 = basis.efficiencies.iter().map(|(_, eta)| eta).product();
    assert!((value - (1.0 - i0 * eta) / (1.0 - i0)).abs() < 1e-12, "{value} {i0} {eta}");
    let text = sheet.emit(willis::symbolic::Notation::Python, false);
    assert!(
        text.contains("# as drawn: mesh efficiencies are those of the loss laws at the load of operation"),
        "{text}"
    );
}

#[test]
fn a_point_that_is_located_has_its_own_efficiencies() {
    let train = Train::from_toml(&without_bearings(&example("fva-planetary-stage"))).unwrap();
    for operation in train.operations() {
        let request = LocateRequest { operation: Some(operation.name.clone()), ..LocateRequest::default() };
        let found = locate(&train, &request).unwrap();
        let basis = found.efficiency_basis.as_ref().unwrap();
        assert_alike(basis, &analysed(&train, &operation.name));
        assert!(basis.to_string().contains("at this point"), "{basis}");
    }
}

#[test]
fn a_family_names_the_load_of_its_efficiencies() {
    let mut text = example("fva-planetary-stage");
    text = text.replace("ring = { member = \"frame\"", "ring = { member = \"ring\"");
    text = text.replacen("members = [", "members = [\"ring\", ", 1).replacen(
        "terminals = [",
        "terminals = [\"ring\", ",
        1,
    );
    let text = without_operations(&text)
        + "\n[[operation]]\nname = \"held\"\nfixed = [\"ring\"]\nspeeds = { sun = \"1500 rpm\" }\ntorques = { sun = \"1000 N m\" }\n";
    let train = Train::from_toml(&text).unwrap();
    let all = family(&train, &RegimeSelection::default()).unwrap();
    let basis = all.efficiency_basis.as_ref().unwrap();
    assert_eq!(basis.operation.as_deref(), Some("held"));
    let eta: f64 = basis.efficiencies.iter().map(|(_, eta)| eta).product();
    assert!((all.efficiencies[0] - eta).abs() < 1e-12);
}
