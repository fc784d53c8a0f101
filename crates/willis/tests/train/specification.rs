//! A train as data: what is written reads back, what is set is got, and a train made in code is the one of a text.

use std::path::{Path, PathBuf};

use proptest::prelude::*;
use willis::analysis::{Selection, analyze};
use willis::diagnostic::Code;
use willis::train::{
    BearingSpec, EfficiencySpec, GearSpec, GeometrySpec, LawsSpec, MeshSpec, OilSpec, OilSupply, OperationSpec,
    SetSpec, ShiftElementSpec, SignalSpec, Specification, StateSpec, ToothSpec, Train,
};
use willis::units::{
    Angle, AngularSpeed, Force, KinematicViscosity, Length, MomentOfInertia, Power, Temperature, Time, Torque,
};
use willis::{Model, exact::Rational};

fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let files = std::fs::read_dir(folder).expect("the examples").map(|e| e.expect("an entry").path());
    let mut all: Vec<PathBuf> = files.filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    all.sort();
    assert!(all.len() > 10);
    all
}

fn beside(path: &Path) -> impl FnMut(&str) -> Result<String, String> {
    let folder = path.parent().expect("a folder").to_owned();
    move |file| std::fs::read_to_string(folder.join(file)).map_err(|e| e.to_string())
}

fn model(path: &Path) -> Model {
    let text = std::fs::read_to_string(path).expect("an example");
    Model::read(&text, &mut beside(path)).unwrap_or_else(|wrong| panic!("{}: {wrong}", path.display()))
}

fn json(train: &Train) -> serde_json::Value {
    let analysis = analyze(train, &Selection::default()).unwrap_or_else(|wrong| panic!("{wrong}"));
    serde_json::to_value(analysis).expect("plain data")
}

/// The answer without the warnings' places in a text, which another text does not have.
fn answer(train: &Train) -> serde_json::Value {
    let mut all = json(train);
    if let Some(list) = all["diagnostics"].as_array_mut() {
        list.iter_mut().for_each(|d| drop(d.as_object_mut().map(|d| d.remove("span"))));
        list.sort_by_key(|d| d.to_string());
    }
    all
}

/// What a specification says, written and read by every way there is.
fn reads_back(specification: &Specification, load: &mut dyn FnMut(&str) -> Result<String, String>, name: &str) {
    let text = specification.to_toml();
    let again = Model::read(&text, load).unwrap_or_else(|wrong| panic!("{name}: {wrong}\n{text}"));
    assert_eq!(again.specification(), specification, "{name}:\n{text}");
    assert_eq!(again.specification().to_toml(), text, "{name}");
    let json = serde_json::to_string(specification).expect("plain data");
    let from_json: Specification = serde_json::from_str(&json).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_eq!(&from_json, specification, "{name}");
}

#[test]
fn every_example_reads_back_from_what_is_written() {
    for path in examples() {
        let model = model(&path);
        let name = path.display().to_string();
        reads_back(model.specification(), &mut beside(&path), &name);
        // Built without a text it is the same train.
        let built = model.specification().build_with(&mut beside(&path)).unwrap_or_else(|wrong| panic!("{wrong}"));
        assert_eq!(answer(&built), answer(model.train()), "{name}");
        // And so it is as a model of its own.
        let new = Model::new_with(model.specification().clone(), &mut beside(&path));
        let new = new.unwrap_or_else(|wrong| panic!("{name}: {wrong}"));
        assert_eq!(answer(new.train()), answer(model.train()), "{name}");
    }
}

#[test]
fn the_text_of_a_person_stays() {
    for path in examples() {
        let text = std::fs::read_to_string(&path).expect("an example");
        let mut model = model(&path);
        assert_eq!(model.to_toml(), text);
        let Some(set) = model.specification().set.first().map(|s| s.name.clone()) else { continue };
        let before = text.lines().count();
        let quantity = format!("{set}.carrier");
        let carrier = model.get(&quantity).expect("a set has a carrier").expect("it is given");
        model.set(&quantity, &carrier).unwrap_or_else(|wrong| panic!("{}: {wrong}", path.display()));
        assert_eq!(model.to_toml().lines().count(), before);
        for comment in text.lines().filter(|l| l.trim_start().starts_with('#')) {
            assert!(model.to_toml().contains(comment), "{}: {comment} is lost", path.display());
        }
    }
}

#[test]
fn a_file_may_name_its_schema() {
    let text = "#:schema https://example.org/willis-1.schema.json\nformat = 1\nname = \"x\"\nmembers = [\"a\", \"b\"]\n\
                terminals = [\"a\", \"b\"] # both\n[[mesh]]\nname = \"ab\"\n\
                gears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]\n";
    let mut model = Model::from_toml(text).unwrap();
    model.set("ab.efficiency", "0.98").unwrap();
    assert!(model.to_toml().starts_with("#:schema https://example.org/willis-1.schema.json\n"));
    assert!(model.to_toml().contains("# both"));
    assert_eq!(model.get("ab.efficiency").unwrap().as_deref(), Some("0.98"));
}

/// A train with something of everything.
fn full() -> Specification {
    Specification::new("of \"everything\" \\ 1")
        .source("worked out\tby hand")
        .members(["s", "r", "c", "out", "w-1"])
        .terminals(["s", "out"])
        .oil(OilSpec {
            viscosity_40: Some(KinematicViscosity::mm2_s(220.0)),
            viscosity_100: Some(KinematicViscosity::mm2_s(19.4)),
            temperature: Some(Temperature::deg_c(72.5)),
            supply: Some(OilSupply::Bath),
            ..OilSpec::default()
        })
        .laws(LawsSpec { mesh_friction: Some("schlenk".into()), ..LawsSpec::default() })
        .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4).geometry(GeometrySpec {
            helix: Some(Angle::deg(12.5)),
            pressure_angle: Some(Angle::rad(0.35)),
            roughness: Some(Length::um(0.8)),
            ..GeometrySpec::new(Length::mm(2.5), Length::exact(Rational::new(1, 30)))
        }))
        .mesh(
            MeshSpec::new(
                GearSpec::external("c", 31),
                GearSpec::external("out", 47).tooth(ToothSpec { shift: Some(0.1 + 0.2), ..ToothSpec::default() }),
            )
            .efficiency(EfficiencySpec::exact(Rational::new(96, 97), Rational::new(1, 3))),
        )
        .bearing(BearingSpec {
            name: "B1".into(),
            members: vec!["out".into()],
            designation: Some("6210".into()),
            radial_load: Some(Force::kn(1.5)),
            ..BearingSpec::default()
        })
        .shift_element(ShiftElementSpec::brake("B", "r").capacity(Torque::parse("150 lbf ft").unwrap()).friction(0.11))
        .state(StateSpec::new("1", ["B"]).between("s", "out"))
        .operation(
            OperationSpec::new("rated")
                .state("1")
                .speed("s", AngularSpeed::rpm(1450.5))
                .power("s", Power::kw(12.25))
                .temperature(Temperature::deg_c(60.0)),
        )
        .inertia("w-1", MomentOfInertia::kg_m2(0.05))
        .scenario(
            willis::train::ScenarioSpec::new("go", Time::s(2.0))
                .initial_speed("s", AngularSpeed::rad_s(10.0))
                .source(willis::train::SourceSpec::torque(
                    "s",
                    SignalSpec::product(Torque::n_m(3.0), SignalSpec::formula("exp(-t)")),
                ))
                .source(willis::train::SourceSpec::speed(
                    "w-1",
                    SignalSpec::table([
                        (Time::ms(0.0), AngularSpeed::rpm(0.0)),
                        (Time::s(1.0), AngularSpeed::rpm(9.0)),
                    ]),
                ))
                .engagement("B", SignalSpec::ramp(0.0, 1.0, Time::s(0.5), Time::ms(100.0))),
        )
}

#[test]
fn a_train_made_in_code_reads_back() {
    let specification = full();
    reads_back(&specification, &mut |f| Err(f.to_owned()), "full");
    let model =
        Model::new(specification.clone()).unwrap_or_else(|wrong| panic!("{wrong}\n{}", specification.to_toml()));
    let built = specification.build().unwrap_or_else(|wrong| panic!("{wrong}"));
    assert_eq!(answer(model.train()), answer(&built));
    // Exactly: no number went through another.
    let mesh = model.train().meshes().iter().find(|m| m.name == "c-out").expect("a mesh");
    assert_eq!(mesh.efficiency.forward, Rational::new(96, 97));
}

#[test]
fn set_and_get_agree() {
    let mut model = Model::new(full()).unwrap();
    for (path, value) in [
        ("P1.planet.count", "3"),
        ("P1.sun.roughness", "0.6 um"),
        ("P1.geometry.module", "2.25 mm"),
        ("oil.temperature", "80 degC"),
        ("laws.mesh_friction", "niemann"),
        ("B.capacity", "95 N m"),
        ("rated.speeds.s", "900 rpm"),
        ("B1.radial_load", "2 kN"),
    ] {
        model.set(path, value).unwrap_or_else(|wrong| panic!("{path}: {wrong}"));
        assert_eq!(model.get(path).unwrap().as_deref(), Some(value), "{path}");
    }
    assert_eq!(model.train().meshes()[1].count, 3);
    // The specification follows the text.
    assert_eq!(model.specification().set[0].geometry.as_ref().unwrap().module, Length::mm(2.25));
    reads_back(model.specification(), &mut |f| Err(f.to_owned()), "after set");
    // What is refused changes nothing.
    let text = model.to_toml().to_owned();
    assert!(model.set("P1.planet.cuont", "3").unwrap_err().to_string().contains("P1.planet.count"));
    assert!(model.set("P1.planet.count", "many").unwrap_err().iter().any(|d| d.code == Code::BadAxis));
    assert!(model.set("P1.sun.teeth", "-3").is_err());
    assert_eq!(model.to_toml(), text);
    // Laws over those of the text, until the text says otherwise.
    let other = model.clone().with_laws([("mesh_friction", "constant")]).unwrap();
    assert_eq!(other.train().laws().mesh_friction.expect("chosen").meta().id, "constant");
    let set = other.with([("law.mesh_friction", "schlenk")]).unwrap();
    assert_eq!(set.train().laws().mesh_friction.expect("chosen").meta().id, "schlenk");
}

#[test]
fn a_builders_mistakes_are_told_together() {
    let wrong = Specification::new("x")
        .members(["s", "r", "c"])
        .set(
            SetSpec::simple("P1", ("s", 30), ("r", 70), "c")
                .sun("s", 20, 20)
                .second_planet(12)
                .mesh_efficiency(f64::NAN),
        )
        .set(SetSpec::stepped("P2", "c").side("s", 20, true).mesh_efficiency(0.99).basic_efficiency(0.98))
        .build()
        .unwrap_err();
    let text = wrong.to_string();
    for part in ["more suns", "one kind of planet", "has sides", "no finite number", "both say", "two or more central"]
    {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
}

#[test]
fn an_operating_point_needs_no_text() {
    let model = Model::new(full()).unwrap();
    let train = model.train();
    let asked =
        OperationSpec::new("20 N m").state("1").speed("s", AngularSpeed::rpm(900.0)).torque("s", Torque::n_m(20.0));
    let point = train.operation(&asked).unwrap_or_else(|wrong| panic!("{wrong}"));
    let (report, _) = willis::analysis::operate(train, &point).unwrap_or_else(|wrong| panic!("{wrong}"));
    assert_eq!(report.name, "20 N m");
    assert!((report.solutions[0].members.get("s").unwrap().torque_n_m.unwrap() - 20.0).abs() < 1e-9);
    let wrong = train.operation(&asked.state("3").torque("sn", Torque::n_m(1.0))).unwrap_err().to_string();
    assert!(wrong.contains("`3`") && wrong.contains("did you mean `s`?"), "{wrong}");
}

#[test]
fn the_parts_of_a_specification_are_data_too() {
    let set: SetSpec = serde_json::from_value(serde_json::json!({
        "name": "P1", "type": "stepped", "carrier": "c", "mesh_efficiency": 0.99, "geometry": null,
        "suns": [{ "member": "s", "teeth": 30, "planet_teeth": 20 }],
        "rings": [{ "member": "r", "teeth": 70, "planet_teeth": 18 }],
    }))
    .unwrap();
    assert_eq!(set, SetSpec::stepped("P1", "c").sun("s", 30, 20).ring("r", 70, 18).mesh_efficiency(0.99));
    let wrong = serde_json::from_str::<OilSpec>(r#"{ "temprature": "60 degC" }"#).unwrap_err().to_string();
    assert!(wrong.contains("did you mean `temperature`?"), "{wrong}");
    let wrong = serde_json::from_str::<OilSpec>(r#"{ "temperature": 60 }"#).unwrap_err().to_string();
    assert!(wrong.contains("has no unit"), "{wrong}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Random trains with random quantities read back from what is written.
    #[test]
    fn prop_what_is_written_reads_back(
        teeth in proptest::collection::vec((12i64..90, 12i64..60), 1..5),
        eta in 0.5f64..1.0,
        speed in -1e4f64..1e4,
        torque in proptest::num::f64::NORMAL.prop_filter("sensible", |x| x.abs() > 1e-30 && x.abs() < 1e30),
        fraction in (1i64..1000, 1i64..1000),
        name in "[^\\p{Cc}\\p{Cf}\\p{Cn}\\u{2028}\\u{2029}]{1,20}",
    ) {
        let names: Vec<String> = (0..teeth.len() + 2).map(|k| format!("m{k}")).collect();
        let mut spec = Specification::new(name).members(names.iter().map(String::as_str)).terminals(["m0", "m1"]);
        for (k, (sun, planet)) in teeth.iter().enumerate() {
            let (ring, set) = (sun + 2 * planet, format!("P{k}"));
            let set = SetSpec::simple(set, (&names[k], *sun), (&names[k + 1], ring), "frame").planet(*planet, 1);
            spec = spec.set(match k % 3 {
                0 => set.mesh_efficiency(eta),
                1 => set.basic_efficiency(EfficiencySpec::exact(Rational::new(fraction.0, 1000), Rational::ONE)),
                _ => set.mesh_efficiencies(eta, EfficiencySpec::directed(0.9, 0.8)),
            });
        }
        let spec = spec.operation(
            OperationSpec::new("o")
                .speed("m0", AngularSpeed::rpm(speed))
                .torque("m1", Torque::exact(Rational::new(fraction.0, fraction.1) + Rational::from_f64(torque).unwrap())),
        );
        let text = spec.to_toml();
        let reading = Train::read_toml(&text);
        prop_assert_eq!(reading.specification.as_ref(), Some(&spec), "{}\n{}", reading.diagnostics, text);
        let read = reading.train.expect("a specification has a train");
        let built = spec.build().expect("what reads is built");
        prop_assert_eq!(
            format!("{:?}", read.operations()).replace("operation[0]", ""),
            format!("{:?}", built.operations()).replace("operation[0]", "")
        );
    }
}
