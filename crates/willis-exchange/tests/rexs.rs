//! REXS: small files of our own, sound and broken, and the way back.

use std::fmt::Write as _;

use willis::Diagnostics;
use willis::model::Model;
use willis_exchange::rexs::{self, Convention, Fate, Imported};

/// A component to be: type, name, attributes with units.
#[derive(Clone)]
struct Component {
    kind: &'static str,
    name: String,
    attributes: Vec<(&'static str, &'static str, String)>,
}

/// A file to be. Numbers of components are positions, from 1.
#[derive(Clone, Default)]
struct Rexs {
    components: Vec<Component>,
    relations: Vec<(&'static str, Vec<(&'static str, usize)>)>,
}

impl Rexs {
    fn add(&mut self, kind: &'static str, name: &str, attributes: &[(&'static str, &'static str, &str)]) -> usize {
        let attributes = attributes.iter().map(|(a, u, v)| (*a, *u, (*v).to_owned())).collect();
        self.components.push(Component { kind, name: name.into(), attributes });
        self.components.len()
    }

    fn relate(&mut self, kind: &'static str, refs: &[(&'static str, usize)]) {
        self.relations.push((kind, refs.to_vec()));
    }

    fn gear(&mut self, kind: &'static str, shaft: usize, teeth: &str, x: Option<&str>) -> usize {
        let gear = self.add(
            kind,
            "",
            &[("number_of_teeth", "none", teeth), ("normal_module", "mm", "4.0"), ("face_width", "mm", "50.0")],
        );
        self.relate("assembly", &[("assembly", shaft), ("part", gear)]);
        let flank = self.add("cylindrical_gear_flank", "", &[("normal_pressure_angle", "deg", "20.0")]);
        if let Some(x) = x {
            self.components[flank - 1].attributes.push(("addendum_modification_coefficient", "none", x.into()));
        }
        self.relate("flank", &[("gear", gear), ("left", flank), ("right", flank)]);
        gear
    }

    fn xml(&self) -> String {
        let mut out = String::from(
            "<?xml version=\"1.0\"?>\n<model version=\"1.6\" applicationId=\"test\" applicationVersion=\"1\" date=\"2026-01-01T00:00:00+00:00\">\n<relations>\n",
        );
        for (k, (kind, refs)) in self.relations.iter().enumerate() {
            let refs: String = refs.iter().map(|(role, id)| format!("<ref role=\"{role}\" id=\"{id}\"/>")).collect();
            let _ = writeln!(out, "<relation id=\"{}\" type=\"{kind}\">{refs}</relation>", k + 1);
        }
        out.push_str("</relations>\n<components>\n");
        for (k, c) in self.components.iter().enumerate() {
            let _ = writeln!(out, "<component id=\"{}\" type=\"{}\" name=\"{}\">", k + 1, c.kind, c.name);
            for (id, unit, value) in &c.attributes {
                let _ = writeln!(out, "<attribute id=\"{id}\" unit=\"{unit}\">{value}</attribute>");
            }
            out.push_str("</component>\n");
        }
        out + "</components>\n</model>\n"
    }

    fn json(&self) -> String {
        let value = |v: &str| match (v.parse::<f64>(), v) {
            (Ok(x), _) => serde_json::json!({ "floating_point": x }),
            (_, "true" | "false") => serde_json::json!({ "boolean": v == "true" }),
            _ => serde_json::json!({ "string": v }),
        };
        let components: Vec<_> = (self.components.iter().enumerate())
            .map(|(k, c)| {
                let attributes: Vec<_> = (c.attributes.iter())
                    .map(|(id, unit, v)| {
                        let mut a = value(v);
                        a["id"] = (*id).into();
                        a["unit"] = (*unit).into();
                        a
                    })
                    .collect();
                serde_json::json!({ "id": k + 1, "type": c.kind, "name": c.name, "attributes": attributes })
            })
            .collect();
        let relations: Vec<_> = (self.relations.iter().enumerate())
            .map(|(k, (kind, refs))| {
                let refs: Vec<_> = refs.iter().map(|(r, id)| serde_json::json!({ "role": r, "id": id })).collect();
                serde_json::json!({ "id": k + 1, "type": kind, "refs": refs })
            })
            .collect();
        let model = serde_json::json!({
            "version": "1.6", "applicationId": "test", "applicationVersion": "1", "date": "",
            "relations": relations, "components": components
        });
        serde_json::json!({ "model": model }).to_string()
    }
}

/// A planetary stage 17/22/61 with its ring in the housing, torque on the sun.
fn planetary(ring_shift: Option<&str>, centre: &str) -> Rexs {
    let mut r = Rexs::default();
    r.add("gear_unit", "gearbox", &[]);
    let casing = r.add("gear_casing", "casing", &[("temperature_lubricant", "C", "80.0")]);
    let oil = r.add(
        "lubricant",
        "VG 100",
        &[
            ("viscosity_at_40_degree_celsius", "mm^2 / s", "100.0"),
            ("viscosity_at_100_degree_celsius", "mm^2 / s", "11.0"),
            ("density_at_15_degree_celsius", "kg / dm^3", "0.88"),
        ],
    );
    r.relate("reference", &[("origin", casing), ("referenced", oil)]);
    let sun = r.add(
        "shaft",
        "sun shaft [4]",
        &[("rotational_speed", "1 / min", "1500.0"), ("defines_speed", "none", "true")],
    );
    let arm = r.add("shaft", "arm", &[]);
    let ring = r.add("shaft", "ring", &[]);
    let stage = r.add("planetary_stage", "stage", &[]);
    let coupling = r.add("switchable_coupling", "brake", &[("is_engaged", "none", "true")]);
    r.relate("side", &[("assembly", coupling), ("inner_part", ring), ("outer_part", casing)]);
    r.relate("central_shaft", &[("planetary_stage", stage), ("shaft", sun)]);
    r.relate("central_shaft", &[("planetary_stage", stage), ("shaft", ring)]);
    r.relate("planet_carrier_shaft", &[("planetary_stage", stage), ("shaft", arm)]);
    let sun_gear = r.gear("cylindrical_gear", sun, "17", Some("0.0"));
    let ring_gear = r.gear("ring_gear", ring, "61", ring_shift);
    for _ in 0..3 {
        let shaft = r.add("shaft", "planet", &[]);
        r.relate("planet_shaft", &[("planetary_stage", stage), ("shaft", shaft)]);
        let planet = r.gear("cylindrical_gear", shaft, "22", Some("0.0"));
        for (gears, distance) in [([sun_gear, planet], centre), ([planet, ring_gear], centre)] {
            let mesh = r.add("cylindrical_stage", "", &[("center_distance", "mm", distance)]);
            r.relate("assembly", &[("assembly", stage), ("part", mesh)]);
            r.relate("stage", &[("stage", mesh), ("gear_1", gears[0]), ("gear_2", gears[1])]);
        }
        let bearing = r.add(
            "rolling_bearing_with_catalog_geometry",
            "pin bearing",
            &[("catalogue_designation", "none", "NU 206")],
        );
        r.relate("side", &[("assembly", bearing), ("inner_part", arm), ("outer_part", shaft)]);
    }
    let load = r.add(
        "external_load",
        "motor",
        &[
            ("torque_around_u_axis", "N m", "159.15"),
            ("transmits_torque", "none", "true"),
            ("defines_torque", "none", "true"),
        ],
    );
    r.relate("assembly", &[("assembly", sun), ("part", load)]);
    let out = r.add("external_load", "machine", &[("transmits_torque", "none", "true")]);
    r.relate("assembly", &[("assembly", arm), ("part", out)]);
    r
}

fn read(text: &str) -> Imported {
    rexs::read("x.rexs", text.as_bytes()).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(bytes: &[u8]) -> Diagnostics {
    rexs::read("x.rexs", bytes).unwrap_err()
}

fn told(read: &Imported, what: &str) -> bool {
    read.report.problems.iter().any(|p| format!("{}: {}", p.place, p.message).contains(what))
}

fn shift_of_ring(model: &Model) -> f64 {
    let wheels = model.train().meshes().iter().filter_map(|m| m.teeth.as_ref()).flat_map(|t| &t.pair.data.wheels);
    wheels.filter(|w| w.internal).map(|w| w.shift).next().unwrap()
}

#[test]
fn a_planetary_stage_becomes_a_set() {
    let read = read(&planetary(Some("0.0"), "78.0").xml());
    assert!(read.toml.contains("sun = { member = \"sun shaft\", teeth = 17 }"), "{}", read.toml);
    assert!(read.toml.contains("planet = { teeth = 22, count = 3 }"), "{}", read.toml);
    assert!(read.toml.contains("ring = { member = \"frame\", teeth = 61 }"), "{}", read.toml);
    assert!(read.toml.contains("members = [\"stage.planet\", \"arm\"]"), "{}", read.toml);
    assert!(read.toml.contains("temperature = \"80 degC\""), "{}", read.toml);
    let train = read.model.train();
    assert_eq!((train.bearings().len(), train.bearings()[0].places), (1, 3));
    let operation = &train.operations()[0];
    let (report, _) = willis::analysis::operate(train, operation).unwrap();
    let speeds = ["sun shaft", "arm"].map(|m| report.speeds_rad_s.get(m).unwrap().unwrap());
    assert!((speeds[0] / speeds[1] - 78.0 / 17.0).abs() < 1e-12);
    assert!(report.solutions[0].efficiency.unwrap() > 0.97);
    let c = &read.report.counts;
    assert_eq!(c.used + c.left_out + c.unusable, c.attributes);
    assert_eq!(c.attributes, read.report.attributes.len());
}

#[test]
fn all_three_forms_say_the_same() {
    let file = planetary(Some("0.0"), "78.0");
    let body = |toml: &str| toml[toml.find("members").unwrap()..].to_owned();
    let xml = read(&file.xml());
    let json = read(&file.json());
    let zip = rexs::read("x.rexsz", &stored("model.rexs", file.xml().as_bytes())).unwrap();
    assert_eq!(body(&xml.toml), body(&json.toml));
    assert_eq!(body(&xml.toml), body(&zip.toml));
    // As the specification wants it, with a byte order mark.
    assert_eq!(body(&read(&format!("\u{feff}{}", file.xml())).toml), body(&xml.toml));
}

/// The ring of a 5 MW stage: x = -0.5013 in the KISSsoft report (sign of DIN 3960), sun 0.6170, planets 0.8021, module 45 mm,
/// centre distance 863 mm. The centre distance alone gives the same shift, and the same sign.
#[test]
fn val_shift_of_a_ring_has_the_sign_of_din() {
    let mut file = planetary(Some("-0.5013"), "863.0");
    for c in &mut file.components {
        for (id, _, value) in &mut c.attributes {
            let new = match (*id, value.as_str()) {
                ("normal_module", _) => "45.0",
                ("number_of_teeth", "17") => "19",
                ("number_of_teeth", "22") => "17",
                ("number_of_teeth", "61") => "56",
                _ => continue,
            };
            *value = new.into();
        }
    }
    let shifts: Vec<usize> = (0..file.components.len())
        .filter(|&k| file.components[k].attributes.iter().any(|a| a.0 == "addendum_modification_coefficient"))
        .collect();
    for (n, k) in shifts.iter().enumerate() {
        let x = ["0.6170", "-0.5013"].get(n).unwrap_or(&"0.8021");
        file.components[*k].attributes[1].2 = (*x).into();
    }
    assert_eq!(shift_of_ring(&read(&file.xml()).model), 0.5013);
    let outward = rexs::read_as("x", file.xml().as_bytes(), Convention::Outward).unwrap();
    assert_eq!(shift_of_ring(&outward.model), -0.5013);
    file.components[shifts[1]].attributes.truncate(1);
    let followed = read(&file.xml());
    assert!((shift_of_ring(&followed.model) - 0.5013).abs() < 0.02, "{}", shift_of_ring(&followed.model));
    assert!(followed.report.guessed.iter().any(|g| g.because.contains("centre distance")));
}

#[test]
fn shift_elements_and_load_cases() {
    let mut file = planetary(Some("0.0"), "78.0");
    file.components[0].attributes.push(("number_of_gears", "none", "2".into()));
    let brake = file.components.iter_mut().find(|c| c.name == "brake").unwrap();
    brake.attributes[0].2 = "<array><c>true</c><c>false</c></array>".into();
    let clutch =
        file.add("switchable_coupling", "clutch", &[("is_engaged", "none", "<array><c>false</c><c>true</c></array>")]);
    file.relate("side", &[("assembly", clutch), ("inner_part", 4), ("outer_part", 5)]);
    let spectrum = "<load_spectrum id=\"1\">\
        <load_case id=\"1\"><component id=\"1\" type=\"gear_unit\"><attribute id=\"operating_time_fraction\" unit=\"%\">30</attribute>\
        <attribute id=\"gear_shift_index\" unit=\"none\">1</attribute></component></load_case>\
        <load_case id=\"2\"><component id=\"1\" type=\"gear_unit\"><attribute id=\"operating_time_fraction\" unit=\"%\">70</attribute>\
        <attribute id=\"gear_shift_index\" unit=\"none\">2</attribute></component></load_case></load_spectrum></model>";
    let read = read(&file.xml().replace("</model>", spectrum));
    let train = read.model.train();
    assert_eq!((train.shift_elements().len(), train.states().len(), train.operations().len()), (2, 2, 2));
    assert_eq!(train.operations()[1].state, Some(1));
    assert_eq!(read.report.load_cases.iter().map(|c| c.share.unwrap()).collect::<Vec<_>>(), [0.3, 0.7]);
    let (report, _) = willis::analysis::operate(train, &train.operations()[1]).unwrap();
    let speeds = ["sun shaft", "arm"].map(|m| report.speeds_rad_s.get(m).unwrap().unwrap());
    assert_eq!(speeds[0], speeds[1]);
}

#[test]
fn broken_files_are_read_as_far_as_they_go() {
    let sound = planetary(Some("0.0"), "78.0");
    // Texts and vectors as `false`.
    let mut file = sound.clone();
    file.components[3].attributes.push(("u_axis_vector", "mm", "false".into()));
    file.components[2].attributes.push(("name", "none", "false".into()));
    let json = read(&file.json());
    assert!(told(&json, "2 texts and vectors are stored as boolean false"), "{:?}", json.report.problems);
    assert_eq!(json.model.train().meshes().len(), 2);
    // A version that nobody knows.
    assert!(told(&read(&sound.xml().replace("\"1.6\"", "\"7.3\"")), "its version is `7.3`"));
    // Tooth counts with a point.
    assert_eq!(read(&sound.xml().replace(">22<", ">22.0<")).model.train().meshes().len(), 2);
    // A tip circle inside the base circle.
    let mut file = sound.clone();
    let gear = file.components.iter_mut().find(|c| c.kind == "cylindrical_gear").unwrap();
    gear.attributes.push(("tip_diameter", "mm", "1.0".into()));
    let tip = read(&file.xml());
    assert!(told(&tip, "tip_diameter: 1 mm is impossible for 17 teeth"), "{:?}", tip.report.problems);
    assert!(tip.report.attributes.iter().any(|a| a.attribute == "tip_diameter" && a.fate == Fate::Unusable));
    // No number, no unit of a length, nothing at all.
    for (value, unit, what) in [
        ("NaN", "mm", "no finite number"),
        ("inf", "mm", "no finite number"),
        ("wide", "mm", "`wide` is no number"),
        ("50.0", "s", "`s` is no unit for it; mm would be"),
        ("", "mm", "has no value"),
        ("-3", "mm", "-3 is not positive"),
    ] {
        let mut file = sound.clone();
        for c in file.components.iter_mut().filter(|c| c.kind.ends_with("_gear")) {
            c.attributes[2] = ("face_width", unit, value.into());
        }
        let read = read(&file.xml());
        assert!(told(&read, what), "{value} {unit}: {:?}", read.report.problems);
        assert!(told(&read, "no gear has a width"));
    }
    // A relation to a component that is not there, and numbers that two components have.
    let mut file = sound.clone();
    file.relate("assembly", &[("assembly", 4), ("part", 999)]);
    assert!(told(&read(&file.xml()), "component 999 (part) is not in the file"));
    let twice = sound.xml().replacen("component id=\"3\"", "component id=\"2\"", 1);
    assert!(told(&read(&twice), "another component has this number"));
    // Parts of each other.
    let mut file = sound.clone();
    file.relate("assembly", &[("assembly", 5), ("part", 5)]);
    let (a, b) = (file.add("shaft", "a", &[]), file.add("shaft", "b", &[]));
    file.relate("assembly", &[("assembly", a), ("part", b)]);
    file.relate("assembly", &[("assembly", b), ("part", a)]);
    assert_eq!(read(&file.xml()).model.train().members().len(), 4);
    // One planet has lost its ring.
    let mut file = sound.clone();
    let last = file.relations.iter().rposition(|r| r.0 == "stage").unwrap();
    file.relations.remove(last);
    assert!(told(&read(&file.xml()), "no relation `stage` says which gears mesh in it"));
    // Without stages there is no train; everything that is wrong is said at once.
    let mut file = sound.clone();
    file.relations.retain(|r| r.0 != "stage");
    let wrong = refused(file.xml().as_bytes());
    assert_eq!(wrong.len(), 7, "{wrong}");
}

#[test]
fn what_is_no_gearbox_is_refused_with_a_reason() {
    let mut worm = planetary(Some("0.0"), "78.0");
    worm.add("worm_stage", "worm", &[]);
    let wrong = refused(worm.xml().as_bytes()).to_string();
    assert!(wrong.contains("worm_stage: a worm and its wheel are no train of Willis"), "{wrong}");
    let mut bevel = planetary(Some("0.0"), "78.0");
    bevel.add("bevel_stage", "bevel", &[]);
    let wrong = refused(bevel.xml().as_bytes()).to_string();
    assert!(wrong.contains("bevel_stage: bevel stages are not read yet"), "{wrong}");
    assert!(wrong.contains("`type = \"bevel\"`"), "{wrong}");
    let entity = "<!DOCTYPE m [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]><model version=\"1.6\">&b;</model>";
    for (bytes, why) in [
        (&b""[..], "it is empty"),
        (b"gearbox", "it begins neither as XML nor as JSON nor as a zip archive"),
        (b"<model", "it is no XML"),
        (b"<gearbox/>", "in a REXS file it is `model`"),
        (b"{\"model\": 3}", "it has no object `model`"),
        (b"{", "it is no JSON"),
        (b"\xff\xfe<", "it is not text in UTF-8 (byte 0)"),
        (entity.as_bytes(), "it is no XML"),
        (b"<model version=\"1.6\"/>", "holds no stage"),
        (b"PK\x03\x04", "the zip archive is broken"),
    ] {
        let wrong = refused(bytes).to_string();
        assert!(wrong.contains(why), "{why}: {wrong}");
    }
    let deep = "[".repeat(100_000);
    assert!(refused(deep.as_bytes()).to_string().contains("it is no JSON"));
    let text = planetary(Some("0.0"), "78.0").xml();
    // Cut anywhere, and bytes that are others.
    for k in (0..text.len()).step_by(97) {
        assert!(rexs::read("x", &text.as_bytes()[..k]).is_err());
        let mut bytes = text.clone().into_bytes();
        bytes[k] ^= 1 << (k % 7);
        let _ = rexs::read("x", &bytes);
    }
    let many: String = (0..100_001).map(|k| format!("<component id=\"{k}\" type=\"shaft\"/>")).collect();
    let many = format!("<model version=\"1.6\"><components>{many}</components></model>");
    assert!(refused(many.as_bytes()).to_string().contains("more than 100000 components"));
}

#[test]
fn thousands_of_components_are_read_in_bounded_time() {
    let mut file = planetary(Some("0.0"), "78.0");
    let mut last = file.add("shaft", "chain", &[]);
    for _ in 0..20_000 {
        let next = file.add("shaft", "chain", &[("mean_operating_temperature", "C", "20")]);
        file.relate("assembly", &[("assembly", next), ("part", last)]);
        last = next;
    }
    let read = read(&file.xml());
    assert_eq!(read.model.train().meshes().len(), 2);
    assert!(read.report.counts.left_out >= 20_000);
}

#[test]
fn xml_that_takes_more_than_linear_time_is_refused_before_it_is_parsed() {
    let text = planetary(Some("0.0"), "78.0").xml();
    let pairs = |n: usize, name: &str| (0..n).map(|k| format!(" {name}{k}=\"v\"")).collect::<String>();
    let told = |text: &str, what: &str| {
        let wrong = refused(text.as_bytes()).to_string();
        assert!(wrong.contains(what), "{what}: {wrong}");
    };
    let root = |more: &str| text.replacen("<model", &format!("<model{more}"), 1);
    let many = "an element has more than 64 XML attributes";
    told(&root(&pairs(100, "a")), &format!("line 2: {many}"));
    told(&root(&pairs(100_000, "a")), many);
    told(&root(&pairs(65, "xmlns:a")), "line 2: it declares more than 64 namespaces (`xmlns`)");
    let nested = format!("<model>\n{}{}</model>", "<a\nxmlns:b = 'v'>".repeat(65), "</a>".repeat(65));
    told(&nested, "line 67: it declares more than 64 namespaces (`xmlns`)");
    told(&nested.replace("xmlns:b", "b:xmlns"), "it declares more than 64 namespaces (`xmlns`)");
    // Nothing hides them.
    let long = format!("<model{}/>", pairs(65, "a"));
    for before in [
        "<?xml version=\"?><!--\"?>",
        "<!--'--><?p \"?>",
        "<!---->",
        "<?p <!-- ?>",
        "<m a='\"'><![CDATA['<!--]]>",
        "<m a='>'></m >",
        "<m a='<!--'/>",
        "<m> text ' \" ",
    ] {
        told(&format!("{before}{long}"), many);
    }
    // What only looks like them is none.
    let looks = format!("<a{}/>", pairs(100, "xmlns:a"));
    for there in [
        format!("<!-- {looks} -->"),
        format!("<?p {looks} ?>"),
        format!("<component id=\"900\" type=\"note\"><attribute id=\"n\"><![CDATA[{looks}]]></attribute></component>"),
        format!("<component id=\"900\" type=\"note\" name='{}'/>", pairs(100, "xmlns:a")),
    ] {
        read(&text.replace("</components>", &format!("{there}</components>")));
    }
    read(&root(&pairs(60, "a")));
    read(&root(&pairs(60, "xmlns:a")));
    let sections = |n: usize| {
        let text = "<![CDATA[a]]>".repeat(n);
        format!("<component id=\"900\" type=\"note\"><attribute id=\"n\">{text}</attribute></component></components>")
    };
    told(&text.replace("</components>", &sections(65)), "more than 64 sections `<![CDATA[`");
    let some = sections(64).replace("</components>", &sections(64).replace("900", "901"));
    read(&text.replace("</components>", &some));
    // Memory for each of these is set aside before anything is read.
    told(&format!("<model>{}", "=".repeat(4_000_001)), "more than 4000000 values");
    told(&format!("<model>{}", "<".repeat(4_000_001)), "more than 4000000 elements");
    // Deep is not long.
    told(&format!("<model>{}{}</model>", "<a>".repeat(100_000), "</a>".repeat(100_000)), "holds no stage");
}

#[test]
fn references_messages_and_texts_are_bounded() {
    let file = planetary(Some("0.0"), "78.0");
    let what = "it has more than 1000000 attributes and references";
    let refs = "<ref/>".repeat(1_000_001);
    let xml = format!("<model><relations><relation>{refs}</relation></relations></model>");
    assert!(refused(xml.as_bytes()).to_string().contains(what));
    let refs = "{},".repeat(1_000_000);
    let json = format!("{{\"model\": {{\"relations\": [{{\"refs\": [{refs}{{}}]}}]}}}}");
    let wrong = refused(json.as_bytes()).to_string();
    assert!(wrong.contains(&format!("this is no REXS file: {what}")), "{wrong}");
    let entries = "{},".repeat(100_000);
    let json = format!("{{\"model\": {{\"components\": [{entries}{{}}]}}}}");
    assert!(refused(json.as_bytes()).to_string().contains("it has more than 100000 components"));
    // Messages beyond 500 are counted, each line is told.
    let refs = "<ref/>\n".repeat(700);
    let xml = file.xml().replace("</relations>", &format!("<relation>\n{refs}</relation>\n</relations>"));
    let xml = read(&xml);
    assert_eq!((xml.report.problems.len(), xml.report.more_problems >= 200), (500, true));
    let lines: Vec<usize> =
        xml.report.problems.iter().map(|p| p.place.strip_prefix("line ").unwrap().parse().unwrap()).collect();
    assert!(lines.windows(2).all(|w| w[1] == w[0] + 1), "{lines:?}");
    let refs = vec!["{}"; 700].join(",");
    let json = file.json().replace("\"relations\":[", &format!("\"relations\":[{{\"id\":900,\"refs\":[{refs}]}},"));
    let json = read(&json);
    assert_eq!((json.report.problems.len(), json.report.more_problems >= 200), (500, true));
    assert_eq!(json.report.problems[0].place, "model.relations[0]");
    // Lists and names that nobody reads to their ends.
    let numbers = vec!["1"; 1001].join("</c><c>");
    let long = "x".repeat(100_000);
    let mut file = file;
    file.add("note", &long, &[("list", "none", &format!("<array><c>{numbers}</c></array>")), ("text", "none", &long)]);
    let shown = |read: &Imported, id: &str| {
        read.report.attributes.iter().find(|a| a.attribute == id).map(|a| a.value.clone()).unwrap()
    };
    let xml = read(&file.xml());
    assert_eq!(shown(&xml, "list"), "a list of more than 1000 values");
    assert!(shown(&xml, "text").len() < 100);
    let mut wide = file.clone();
    let note = wide.components.last_mut().unwrap();
    note.attributes[1].1 = Box::leak(long.into_boxed_str());
    let xml = read(&wide.xml());
    assert!(xml.report.attributes.iter().all(|a| a.unit.len() < 1000));
    let list = |n: usize| {
        format!(
            "{{\"model\":{{\"components\":[{{\"id\":900,\"attributes\":[{{\"id\":\"list\",\"floating_point_array\":[{}]}}]}},",
            vec!["1"; n].join(",")
        )
    };
    let sound = planetary(Some("0.0"), "78.0").json();
    let rest = |text: &str| {
        let model: serde_json::Value = serde_json::from_str(text).unwrap();
        let components = model["model"]["components"].to_string();
        format!("{},\"relations\":{}}}}}", &components[1..], model["model"]["relations"])
    };
    assert_eq!(shown(&read(&(list(1001) + &rest(&sound))), "list"), "a list of more than 1000 values");
    assert!(shown(&read(&(list(1000) + &rest(&sound))), "list").starts_with("1, 1, 1"));
}

#[test]
fn json_is_read_by_the_keys_that_are_known() {
    let sound = planetary(Some("0.0"), "78.0").json();
    let body = |toml: &str| toml[toml.find("members").unwrap()..].to_owned();
    let wanted = body(&read(&sound).toml);
    // Deeper than any tree of values is read: it is skipped.
    let deep = format!("{}{}", "[".repeat(5000), "]".repeat(5000));
    for key in ["\"model\":{", "\"refs\":", "\"attributes\":"] {
        let more = match key {
            "\"model\":{" => format!("\"other\":{deep},{key}\"other\":{deep},"),
            _ => format!("\"other\":{deep},{key}"),
        };
        assert_eq!(body(&read(&sound.replacen(key, &more, 1)).toml), wanted, "{key}");
    }
    // Values of other types count as empty, numbers may be texts.
    assert_eq!(body(&read(&sound.replacen("\"id\":1,", "\"id\":\"1\",", 1)).toml), wanted);
    assert_eq!(body(&read(&sound.replacen("\"id\":1,", "\"id\":1.0,", 1)).toml), wanted);
    for (text, why) in [
        (
            "{\"model\": {\"components\": 7, \"relations\": {\"a\": []}, \"load_spectrum\": [[], 3, null]}}",
            "holds no stage",
        ),
        ("{\"model\": {\"components\": [1, null, \"a\", [], true, {\"id\": {}}]}}", "no number (`id`)"),
        ("{\"model\": []}", "it has no object `model`"),
        ("{\"model\": {}} 7", "it is no JSON"),
        ("[{}]", "it has no object `model`"),
    ] {
        let wrong = refused(text.as_bytes()).to_string();
        assert!(wrong.contains(why), "{why}: {wrong}");
    }
    // Load cases in one spectrum and in two.
    let case = |id: usize| {
        format!(
            "{{\"load_cases\":[{{\"id\":{id},\"components\":[{{\"id\":1,\"attributes\":[{{\"id\":\"operating_time_fraction\",\
             \"unit\":\"%\",\"floating_point\":50}}]}}]}}]}}"
        )
    };
    for (spectrum, many) in [(case(1), 1), (format!("[{},{}]", case(1), case(2)), 2)] {
        let read = read(&sound.replacen("\"model\":{", &format!("\"model\":{{\"load_spectrum\":{spectrum},"), 1));
        assert_eq!(read.report.load_cases.iter().map(|c| c.share).collect::<Vec<_>>(), vec![Some(0.5); many]);
    }
}

#[test]
fn couplings_and_load_cases_are_bounded() {
    let couplings = |n: usize, engaged: &str| {
        let mut file = planetary(Some("0.0"), "78.0");
        file.components[0].attributes.push(("number_of_gears", "none", "2".into()));
        for _ in 0..n {
            let clutch = file.add("switchable_coupling", "clutch", &[("is_engaged", "none", engaged)]);
            file.relate("side", &[("assembly", clutch), ("inner_part", 4), ("outer_part", 5)]);
        }
        file.xml()
    };
    let some = "<array><c>false</c><c>true</c></array>";
    let too_large = |text: &str, what: &str, hint: &str| {
        let wrong = refused(text.as_bytes());
        let d = wrong.iter().next().unwrap();
        assert_eq!(d.code, willis::diagnostic::Code::TooLarge);
        assert!(d.message.contains(what), "{wrong}");
        assert!(wrong.to_string().contains(hint), "{wrong}");
    };
    too_large(&couplings(201, some), "201 couplings that are closed in some gears only", "is_engaged");
    let names: Vec<String> =
        read(&couplings(3, some)).model.train().shift_elements().iter().map(|e| e.name.clone()).collect();
    assert_eq!(names, ["clutch", "clutch 2", "clutch 3"]);
    assert_eq!(
        refused(couplings(201, "true").as_bytes())
            .iter()
            .filter(|d| d.code == willis::diagnostic::Code::TooLarge)
            .count(),
        0
    );
    let cases = |file: &Rexs, n: usize| {
        let cases: String = (0..n).map(|k| format!("<load_case id=\"{k}\"/>")).collect();
        file.xml().replace("</model>", &format!("<load_spectrum>{cases}</load_spectrum></model>"))
    };
    let mut file = planetary(Some("0.0"), "78.0");
    too_large(&cases(&file, 1001), "1001 load cases; at most 1000 are read", "join load cases");
    assert_eq!(read(&cases(&file, 1000)).report.load_cases.len(), 1000);
    for _ in 0..20_000 {
        file.add("shaft", "", &[]);
    }
    too_large(&cases(&file, 1000), "1000 load cases, for each of which 20", "export fewer load cases");
    read(&cases(&file, 10));
}

#[test]
fn thousands_of_bearings_of_one_name_get_names_of_their_own() {
    let mut file = planetary(Some("0.0"), "78.0");
    for _ in 0..3000 {
        let bearing = file.add("rolling_bearing", "bearing", &[]);
        file.relate("side", &[("assembly", bearing), ("inner_part", 4), ("outer_part", 2)]);
    }
    let read = read(&file.xml());
    let names: std::collections::HashSet<&str> = read.report.bearings.iter().map(|b| b.name.as_str()).collect();
    assert_eq!((names.len(), read.report.bearings.len()), (3001, 3001));
    assert!(names.contains("bearing") && names.contains("bearing 3000"));
}

/// An archive of one file that is not packed.
fn stored(name: &str, bytes: &[u8]) -> Vec<u8> {
    archive(name, bytes, 0, bytes.len(), crc32(bytes))
}

/// CRC-32, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let bit = |x: u32, _| if x & 1 == 1 { x >> 1 ^ 0xedb8_8320 } else { x >> 1 };
    !bytes.iter().fold(!0, |crc, b| (0..8).fold(crc ^ u32::from(*b), bit))
}

fn archive(name: &str, data: &[u8], method: u8, whole: usize, sum: u32) -> Vec<u8> {
    let n = |x: usize| (x as u32).to_le_bytes();
    let mut out = b"PK\x03\x04\x14\0\0\0".to_vec();
    out.extend([method, 0, 0, 0, 0, 0]);
    out.extend(sum.to_le_bytes());
    out.extend([n(data.len()), n(whole)].concat());
    out.extend([name.len() as u8, 0, 0, 0]);
    out.extend(name.as_bytes());
    out.extend(data);
    let directory = out.len();
    out.extend(b"PK\x01\x02\x14\0\x14\0\0\0");
    out.extend([method, 0, 0, 0, 0, 0]);
    out.extend(sum.to_le_bytes());
    out.extend([n(data.len()), n(whole)].concat());
    out.extend([name.len() as u8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    out.extend(n(0));
    out.extend(name.as_bytes());
    let size = out.len() - directory;
    out.extend(b"PK\x05\x06\0\0\0\0\x01\0\x01\0");
    out.extend([n(size), n(directory)].concat());
    out.extend([0, 0]);
    out
}

#[test]
fn archives_are_bounded() {
    let text = planetary(Some("0.0"), "78.0").xml();
    let refused = |bytes: Vec<u8>| refused(&bytes).to_string();
    assert!(refused(stored("readme.txt", b"text")).contains("has no file that ends with .rexs"));
    assert!(refused(archive("m.rexs", text.as_bytes(), 12, text.len(), 0)).contains("packed by method 12"));
    // It says that it is small, and would unpack to 100 MiB; it says what it is.
    let bomb = miniz_oxide::deflate::compress_to_vec(&vec![b' '; 100 << 20], 1);
    assert!(refused(archive("m.rexs", &bomb, 8, 1000, 0)).contains("larger than 64 MiB"));
    assert!(refused(archive("m.rexs", &bomb, 8, 100 << 20, 0)).contains("larger than 64 MiB"));
    assert!(refused(stored("m.rexs", &stored("m.rexs", text.as_bytes()))).contains("is an archive itself"));
    let packed = miniz_oxide::deflate::compress_to_vec(text.as_bytes(), 6);
    let whole = archive("m.rexs", &packed, 8, text.len(), crc32(text.as_bytes()));
    assert_eq!(rexs::read("x", &whole).unwrap().model.train().meshes().len(), 2);
    // A digit that is another, in an archive of the same size.
    assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    let other = text.replace(">17<", ">19<");
    for (data, method) in
        [(other.clone().into_bytes(), 0), (miniz_oxide::deflate::compress_to_vec(other.as_bytes(), 6), 8)]
    {
        let damaged = refused(archive("m.rexs", &data, method, text.len(), crc32(text.as_bytes())));
        assert!(damaged.contains("`m.rexs` in the zip archive is damaged"), "{damaged}");
    }
    for k in 0..whole.len() {
        let mut spoiled = whole.clone();
        spoiled[k] ^= 0x41;
        if k % 11 == 0 || k + 200 > whole.len() {
            let _ = rexs::read("x", &spoiled);
            let _ = rexs::read("x", &whole[..k]);
        }
    }
}
