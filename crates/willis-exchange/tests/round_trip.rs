//! A train written as REXS and read again is the same train, as far as REXS has words for it.

use std::fs;
use std::path::Path;

use willis::analysis::{OperationReport, Verdict, operate};
use willis::model::Model;
use willis_exchange::rexs;

fn example(name: &str) -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let text = fs::read_to_string(folder.join(name)).unwrap();
    Model::read(&text, &mut |table| fs::read_to_string(folder.join(table)).map_err(|e| e.to_string())).unwrap()
}

/// Without what REXS has no words for: bodies, seals, supply of oil, heat, laws.
fn plain(model: &Model) -> Model {
    let mut spec = serde_json::to_value(model.specification()).unwrap();
    let table = spec.as_object_mut().unwrap();
    let kept = [
        "format",
        "name",
        "members",
        "terminals",
        "set",
        "mesh",
        "bearing",
        "shift_element",
        "state",
        "oil",
        "operation",
    ];
    table.retain(|key, _| kept.contains(&key.as_str()));
    if let Some(oil) = table.get_mut("oil").and_then(|o| o.as_object_mut()) {
        for key in ["supply", "volume", "mist", "base", "pressure_viscosity", "lubricant_factor"] {
            oil.remove(key);
        }
        // One viscosity for all temperatures.
        if oil.remove("viscosity").is_some() {
            oil.insert("viscosity_40".into(), "220 mm^2/s".into());
            oil.insert("viscosity_100".into(), "19 mm^2/s".into());
        }
    }
    for bearing in table.get_mut("bearing").and_then(|b| b.as_array_mut()).into_iter().flatten() {
        for key in ["radial_load", "axial_load", "supply", "level"] {
            bearing.as_object_mut().unwrap().remove(key);
        }
    }
    for element in table.get_mut("shift_element").and_then(|b| b.as_array_mut()).into_iter().flatten() {
        element.as_object_mut().unwrap().remove("open");
    }
    for set in table.get_mut("set").and_then(|b| b.as_array_mut()).into_iter().flatten() {
        let set = set.as_object_mut().unwrap();
        for planet in ["planet", "inner_planet", "outer_planet", "short_planet", "long_planet"] {
            if let Some(planet) = set.get_mut(planet).and_then(|p| p.as_object_mut()) {
                for key in ["mass", "inertia", "orbit_radius"] {
                    planet.remove(key);
                }
            }
        }
    }
    Model::new(serde_json::from_value(spec).unwrap()).unwrap_or_else(|e| panic!("{e}"))
}

fn tooth_loss(r: &OperationReport) -> f64 {
    r.solutions[0].losses_w.all().iter().sum()
}

#[test]
fn examples_with_teeth_come_back_with_their_ratios_and_efficiencies() {
    let mut operations = 0;
    for name in [
        "fva-planetary-stage.toml",
        "industrial-planetary-heat.toml",
        "nrel-5mw-stage-1.toml",
        "two-speed-wet-brake.toml",
        "wang-herringbone-physical.toml",
    ] {
        let model = plain(&example(name));
        let written = rexs::write(model.train()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let back = rexs::read("back.rexs", written.text.as_bytes())
            .unwrap_or_else(|e| panic!("{name}: {e}\n{}", written.text));
        assert!(back.report.problems.is_empty(), "{name}: {:?}", back.report.problems);
        let [a, b] = [model.train(), back.model.train()];
        assert_eq!(a.operations().len(), b.operations().len(), "{name}\n{}", back.toml);
        for (p, q) in a.operations().iter().zip(b.operations()) {
            let (p, q) = (operate(a, p).unwrap().0, operate(b, q).unwrap().0);
            for (member, speed) in p.speeds_rad_s.iter().filter(|s| !s.0.contains('.')) {
                let other = q.speeds_rad_s.get(member).unwrap_or_else(|| panic!("{name}: no {member}\n{}", back.toml));
                let close = |x: f64, y: f64| (x - y).abs() <= 1e-9 * x.abs().max(1.0);
                assert!(speed.zip(*other).is_none_or(|(x, y)| close(x, y)), "{name}: {member} {speed:?} {other:?}");
            }
            assert_eq!(p.verdict, q.verdict, "{name}: {}\n{}", p.name, back.toml);
            if p.verdict == Verdict::Unique {
                let [x, y] = [&p, &q].map(|r| r.solutions[0].efficiency.unwrap_or(0.0));
                let [lost, again] = [&p, &q].map(tooth_loss);
                assert!((x - y).abs() < 1e-6, "{name}: {}: {x} is {y}; {lost} W, {again} W\n{}", p.name, back.toml);
                operations += 1;
            }
        }
    }
    assert!(operations >= 8, "{operations}");
}

/// Trains of teeth without geometry: the ratios.
#[test]
fn other_examples_come_back_with_their_ratios() {
    for name in [
        "textbook-reverted.toml",
        "wolfrom-236.toml",
        "wolfrom-498-self-locking.toml",
        "esmail-fig1.toml",
        "zf-8hp70.toml",
    ] {
        let model = example(name);
        let written = match rexs::write(model.train()) {
            Ok(written) => written,
            // Planets of no known teeth have no gears.
            Err(wrong) if wrong.to_string().contains("have no tooth count") => continue,
            Err(wrong) => panic!("{name}: {wrong}"),
        };
        let back = rexs::read("back.rexs", written.text.as_bytes())
            .unwrap_or_else(|e| panic!("{name}: {e}\n{}", written.text));
        let [a, b] = [model.train(), back.model.train()];
        assert_eq!(a.meshes().len(), b.meshes().len(), "{name}\n{}", back.toml);
        // What is closed in the only gear is joined for good.
        if a.states().len() > 1 {
            assert!(b.states().len() >= a.states().len(), "{name}");
        }
        for (p, q) in a.operations().iter().zip(b.operations()) {
            let (p, q) = (operate(a, p).unwrap().0, operate(b, q).unwrap().0);
            for (member, speed) in p.speeds_rad_s.iter().filter(|s| !s.0.contains('.')) {
                let other = q.speeds_rad_s.get(member).copied().flatten();
                let same = speed.zip(other).is_none_or(|(x, y)| (x - y).abs() <= 1e-9 * x.abs().max(1.0));
                assert!(same, "{name}: {member}: {speed:?} {other:?}");
            }
        }
    }
}

#[test]
fn what_the_format_has_no_words_for_is_refused() {
    let wrong = rexs::write(example("bevel-differential.toml").train()).unwrap_err().to_string();
    assert!(wrong.contains("is no pair of cylindrical gears"), "{wrong}");
    let wrong = rexs::write(example("belt-ivt.toml").train()).unwrap_err().to_string();
    assert!(wrong.contains("variator"), "{wrong}");
}

/// Relations name components that are there, numbers are used once, and elements stand in the order of the XML schema
/// (`rexs-schema.xsd`: relations, components, load_spectrum; every attribute that it requires).
#[test]
fn files_are_as_the_schema_wants_them() {
    let text = rexs::write(example("fva-planetary-stage.toml").train()).unwrap().text;
    let tree = roxmltree::Document::parse(text.trim_start_matches('\u{feff}')).unwrap();
    let root = tree.root_element();
    for required in ["version", "applicationId", "applicationVersion", "date"] {
        assert!(root.has_attribute(required), "{required}");
    }
    let parts: Vec<&str> = root.children().filter(|n| n.is_element()).map(|n| n.tag_name().name()).collect();
    assert_eq!(parts, ["relations", "components", "load_spectrum"]);
    let ids = |tag: &str, parent: &str| -> Vec<&str> {
        let all = root.descendants().filter(|n| n.has_tag_name(tag));
        all.filter(|n| n.parent().is_some_and(|p| p.has_tag_name(parent))).map(|n| n.attribute("id").unwrap()).collect()
    };
    let components = ids("component", "components");
    let mut once = components.clone();
    once.sort();
    once.dedup();
    assert_eq!(once.len(), components.len());
    for id in ids("ref", "relation").into_iter().chain(ids("component", "load_case")) {
        assert!(components.contains(&id), "{id}");
    }
    for relation in root.descendants().filter(|n| n.has_tag_name("relation")) {
        assert!(relation.has_attribute("id") && relation.has_attribute("type"));
        assert!(relation.children().filter(|n| n.is_element()).all(|n| n.has_attribute("role")));
    }
}
