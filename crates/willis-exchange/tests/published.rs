//! What `export rexs` writes is in the published lists of REXS 1.6, and has the structure of its XML Schema.
//!
//! Sources, read in November 2026 in the repository fva-net/rexs-api-java of the FVA: component types in
//! `rexs_schema_1.6.xml` (released on 24 January 2024); attributes with their units in `RexsStandardAttributeIds.java`;
//! relations with their roles in `RexsStandardRelationTypes.java`; the structure in `rexs-file.xsd`. Which component has an attribute
//! is that of files which the FVA-Workbench wrote (1.1 to 1.6).

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use willis::model::Model;
use willis_exchange::rexs;

/// Components, and the attributes that Willis gives them, with their units.
const COMPONENTS: &[(&str, &[(&str, &str)])] = &[
    ("gear_unit", &[("number_of_gears", "none"), ("gear_shift_index", "none")]),
    ("gear_casing", &[("temperature_lubricant", "C")]),
    (
        "lubricant",
        &[
            ("name", "none"),
            ("viscosity_at_40_degree_celsius", "mm^2 / s"),
            ("viscosity_at_100_degree_celsius", "mm^2 / s"),
            ("density_at_15_degree_celsius", "kg / dm^3"),
        ],
    ),
    ("shaft", &[("defines_speed", "none"), ("rotational_speed", "1 / min")]),
    ("coupling", &[]),
    ("planetary_stage", &[]),
    ("planet_carrier", &[]),
    ("cylindrical_stage", &[("center_distance", "mm"), ("common_face_width", "mm")]),
    ("cylindrical_gear", GEAR),
    ("ring_gear", GEAR),
    ("cylindrical_gear_flank", &[("normal_pressure_angle", "deg"), ("addendum_modification_coefficient", "none")]),
    ("material", &[("elastic_modulus", "N / mm^2"), ("poisson_ratio", "none")]),
    (
        "rolling_bearing_with_catalog_geometry",
        &[
            ("catalogue_designation", "none"),
            ("bearing_type", "none"),
            ("inner_diameter", "mm"),
            ("outer_diameter", "mm"),
            ("width", "mm"),
            ("axial_force_absorption", "none"),
            ("u_coordinate_on_shaft_inner_side", "mm"),
        ],
    ),
    ("switchable_coupling", &[("is_engaged", "none")]),
    (
        "external_load",
        &[("transmits_torque", "none"), ("defines_torque", "none"), ("torque_around_u_axis", "N m"), ("power", "kW")],
    ),
];

const GEAR: &[(&str, &str)] = &[
    ("number_of_teeth", "none"),
    ("normal_module", "mm"),
    ("face_width", "mm"),
    ("helix_angle_reference_diameter", "deg"),
    ("arithmetic_average_roughness_flank", "mum"),
    ("tip_diameter", "mm"),
    ("u_coordinate_on_shaft", "mm"),
];

/// Where a component is, which any may say.
const PLACE: &[(&str, &str)] = &[
    ("reference_component_for_position", "none"),
    ("support_vector", "mm"),
    ("u_axis_vector", "mm"),
    ("w_axis_vector", "mm"),
];

/// Relations with their roles.
const RELATIONS: &[(&str, &[&str])] = &[
    ("assembly", &["assembly", "part"]),
    ("central_shaft", &["planetary_stage", "shaft"]),
    ("flank", &["gear", "left", "right"]),
    ("planet_carrier_shaft", &["planetary_stage", "shaft"]),
    ("planet_shaft", &["planetary_stage", "shaft"]),
    ("reference", &["origin", "referenced"]),
    ("side", &["assembly", "inner_part", "outer_part"]),
    ("stage", &["gear_1", "gear_2", "stage"]),
];

/// Checks a file; adds the attributes that it has.
fn check(name: &str, text: &str, met: &mut BTreeSet<(String, String)>) {
    let document =
        roxmltree::Document::parse(text.trim_start_matches('\u{feff}')).unwrap_or_else(|e| panic!("{name}: {e}"));
    let of = |n: roxmltree::Node<'_, '_>, key: &str| {
        n.attribute(key).unwrap_or_else(|| panic!("{name}: {n:?} has no {key}")).to_owned()
    };
    let elements = |n: roxmltree::Node<'_, '_>| {
        n.children().filter(roxmltree::Node::is_element).map(|c| c.id()).collect::<Vec<_>>()
    };
    let node = |id| document.get_node(id).unwrap();
    let root = document.root_element();
    assert_eq!(root.tag_name().name(), "model");
    for key in ["version", "applicationId", "applicationVersion", "date"] {
        of(root, key);
    }
    let parts: Vec<&str> = root.children().filter(|c| c.is_element()).map(|c| c.tag_name().name()).collect();
    assert!(parts[..2] == ["relations", "components"] && parts[2..].iter().all(|p| *p == "load_spectrum"), "{parts:?}");
    let whole = |text: &str| text.parse::<i32>().unwrap_or_else(|_| panic!("{name}: `{text}` is no xsd:int"));
    let mut kinds: BTreeMap<i32, String> = BTreeMap::new();
    let mut attributes = |component: roxmltree::Node<'_, '_>, kind: &str| {
        let known = COMPONENTS.iter().find(|c| c.0 == kind);
        let (_, known) = known.unwrap_or_else(|| panic!("{name}: there is no component {kind} in REXS"));
        for id in elements(component) {
            let attribute = node(id);
            assert_eq!(attribute.tag_name().name(), "attribute", "{name}");
            let (id, unit) = (of(attribute, "id"), of(attribute, "unit"));
            let is_known = known.iter().chain(PLACE).any(|k| *k == (&*id, &*unit));
            assert!(is_known, "{name}: {kind} has no {id} in {unit}");
            met.insert((kind.to_owned(), id));
        }
    };
    let parts = elements(root);
    let [relations, components, spectra @ ..] = &parts[..] else { unreachable!("as asserted above") };
    for id in elements(node(*components)) {
        let component = node(id);
        let kind = of(component, "type");
        attributes(component, &kind);
        assert!(kinds.insert(whole(&of(component, "id")), kind).is_none(), "{name}: a number of a component twice");
    }
    let mut numbers = BTreeSet::new();
    for id in elements(node(*relations)) {
        let relation = node(id);
        assert!(numbers.insert(whole(&of(relation, "id"))), "{name}: a number of a relation twice");
        let kind = of(relation, "type");
        let mut roles = vec![];
        for id in elements(relation) {
            let reference = node(id);
            roles.push(of(reference, "role"));
            let kind = kinds
                .get(&whole(&of(reference, "id")))
                .unwrap_or_else(|| panic!("{name}: {reference:?} refers to nothing"));
            assert_eq!(*kind, of(reference, "hint"));
        }
        roles.sort();
        assert!(
            RELATIONS.iter().any(|r| r.0 == kind && r.1 == roles),
            "{name}: there is no relation {kind} of {roles:?}"
        );
    }
    for spectrum in spectra {
        whole(&of(node(*spectrum), "id"));
        for case in elements(node(*spectrum)) {
            assert_eq!(node(case).tag_name().name(), "load_case");
            whole(&of(node(case), "id"));
            for id in elements(node(case)) {
                let component = node(id);
                let kind = of(component, "type");
                assert_eq!(kinds.get(&whole(&of(component, "id"))), Some(&kind), "{name}");
                attributes(component, &kind);
            }
        }
    }
}

#[test]
fn exported_examples_are_within_the_published_lists() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let (mut written, mut met) = (0, BTreeSet::new());
    for entry in fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let table = &mut |table: &str| fs::read_to_string(folder.join(table)).map_err(|e| e.to_string());
        let model = Model::read(&text, table).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        if let Ok(done) = rexs::written(model.train(), false) {
            check(&path.display().to_string(), &done.text, &mut met);
            written += 1;
        }
    }
    // Operations with a power, gears with a place and a tip, bearings that hold an axial force.
    let own = Model::from_toml(OWN).unwrap_or_else(|e| panic!("{e}"));
    check("own", &rexs::write(own.train()).unwrap().text, &mut met);
    assert!(written > 30, "{written}");
    let all: BTreeSet<_> = (COMPONENTS.iter())
        .flat_map(|(kind, all)| all.iter().map(|a| ((*kind).to_owned(), a.0.to_owned())))
        .filter(|(kind, id)| (kind.as_str(), id.as_str()) != ("ring_gear", "u_coordinate_on_shaft"))
        .collect();
    let unmet: Vec<_> = all.difference(&met).collect();
    assert!(unmet.is_empty(), "no file has {unmet:?}");
}

const OWN: &str = r#"
format = 1
name = "own"
members = ["sun", "ring", "carrier"]
terminals = ["sun", "carrier"]
[oil]
name = "own"
viscosity_40 = "100 mm^2/s"
viscosity_100 = "11 mm^2/s"
density_15 = "880 kg/m^3"
temperature = "60 degC"
[[set]]
name = "P1"
sun = { member = "sun", teeth = 17 }
planet = { teeth = 22, count = 3 }
ring = { member = "ring", teeth = 61 }
carrier = "carrier"
geometry = { module = "4 mm", width = "50 mm", position = "10 mm" }
[[bearing]]
name = "main"
members = ["carrier"]
designation = "6210"
position = "80 mm"
locates = true
[[shift_element]]
name = "B"
kind = "brake"
members = ["ring"]
[[state]]
name = "1"
engaged = ["B"]
[[operation]]
name = "a"
state = "1"
speeds = { sun = "1000 rpm" }
torques = { sun = "10 N m" }
[[operation]]
name = "b"
state = "1"
speeds = { sun = "-500 rpm" }
powers = { sun = "1 kW" }
"#;
