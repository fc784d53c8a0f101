//! REXS files of others, where the folder that holds them is named: `WILLIS_REXS=FOLDER cargo test -p willis-exchange`.
//! It has files and an `expected.json` that says what each of them must become.

use std::path::Path;

use serde_json::Value;
use willis::analysis::{Verdict, operate};
use willis::train::Load;
use willis_exchange::rexs::{self, Imported};

#[test]
fn val_files_of_others_become_the_trains_they_describe() {
    let Some(folder) = std::env::var_os("WILLIS_REXS") else { return };
    let folder = Path::new(&folder);
    let expected: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("expected.json")).unwrap()).unwrap();
    for (name, wanted) in expected.as_object().unwrap() {
        let read = rexs::read(name, &std::fs::read(folder.join(name)).unwrap());
        if let Some(why) = wanted["refused"].as_str() {
            let told = read.unwrap_err().to_string();
            assert!(told.contains(why), "{name}: {told}");
            continue;
        }
        let read = read.unwrap_or_else(|e| panic!("{name}: {e}"));
        if std::env::var_os("WILLIS_LOOK").is_some() {
            println!("{}\n{:#?}", read.toml, read.report.counts);
        }
        compare(name, wanted, &read);
    }
}

fn near(name: &str, what: &str, found: f64, wanted: &Value) {
    let wanted = wanted.as_f64().unwrap_or_else(|| panic!("{name}: {what}"));
    assert!((found - wanted).abs() <= 1e-9 * wanted.abs().max(1.0), "{name}: {what} is {found}, not {wanted}");
}

fn compare(name: &str, wanted: &Value, read: &Imported) {
    let train = read.model.train();
    let list = |of: &Value| of.as_array().cloned().unwrap_or_default();
    // A set is two meshes: sun and planet, planet and ring.
    let mut pairs = vec![];
    for set in list(&wanted["sets"]) {
        let shift = |k: usize| set["shifts"][k].clone();
        pairs.push((set.clone(), [set["sun"].clone(), set["planet"].clone()], [shift(0), shift(1)]));
        pairs.push((set.clone(), [set["planet"].clone(), set["ring"].clone()], [shift(1), shift(2)]));
        assert_eq!(u64::from(train.sets()[0].planets.unwrap()), set["planets"].as_u64().unwrap(), "{name}");
        assert_eq!(set["ring_member"], "frame");
        let ring = train.meshes().iter().flat_map(|m| &m.gears).find(|g| g.internal).unwrap();
        assert_eq!(train.member_name(ring.member), "frame", "{name}");
    }
    for mesh in list(&wanted["meshes"]) {
        let of = |key: &str| [mesh[key][0].clone(), mesh[key][1].clone()];
        pairs.push((mesh.clone(), of("teeth"), of("shift")));
    }
    assert_eq!(train.meshes().len(), pairs.len(), "{name}");
    for (mesh, (of, teeth, shifts)) in train.meshes().iter().zip(&pairs) {
        let data = &mesh.teeth.as_ref().unwrap().pair.data;
        for k in [0, 1] {
            near(name, "teeth", mesh.gears[k].teeth.to_f64(), &teeth[k]);
            near(name, "shift", data.wheels[k].shift, &shifts[k]);
        }
        near(name, "module", data.module * 1e3, &of["module_mm"]);
        near(name, "width", data.width * 1e3, &of["width_mm"]);
        near(name, "helix", data.helix.to_degrees(), &of["helix_deg"]);
        near(name, "centre distance", data.centre_distance.unwrap() * 1e3, &of["centre_distance_mm"]);
        if !of["pressure_angle_deg"].is_null() {
            near(name, "pressure angle", data.pressure_angle.to_degrees(), &of["pressure_angle_deg"]);
        }
        if let Some(ra) = wanted.get("roughness_Ra_um") {
            near(name, "roughness", mesh.teeth.as_ref().unwrap().roughness[0] * 1e6, ra);
        }
    }
    let lubrication = train.lubrication().unwrap();
    let nu = |celsius: f64| lubrication.oil.kinematic_viscosity(celsius + 273.15) * 1e6;
    near(name, "viscosity at 40", nu(40.0), &wanted["oil"]["nu40"]);
    near(name, "viscosity at 100", nu(100.0), &wanted["oil"]["nu100"]);
    near(name, "density", lubrication.oil.density_15, &wanted["oil"]["density_15_kg_m3"]);
    near(name, "oil temperature", lubrication.temperature - 273.15, &wanted["oil_C"]);
    near(name, "ideal supports", read.report.counts.ideal_supports as f64, &wanted["ideal_supports"]);
    let names: Vec<Value> = read.report.bearings.iter().map(|b| b.designation.clone().into()).collect();
    assert_eq!(names, list(&wanted["bearings"]), "{name}");
    // The one operation of a file, or its load cases.
    let cases = match wanted.get("operation") {
        Some(one) => vec![(Value::Null, one["sun_rpm"].clone(), one["sun_torque_N_m"].clone())],
        None => {
            let of = |c: &Value| (c["share"].clone(), c["rpm"].clone(), c["torque_N_m"].clone());
            list(&wanted["load_cases"]).iter().map(of).collect()
        }
    };
    assert_eq!(read.report.load_cases.len(), cases.len(), "{name}");
    for ((case, operation), (share, rpm, torque)) in read.report.load_cases.iter().zip(train.operations()).zip(&cases) {
        if !share.is_null() {
            near(name, "share", case.share.unwrap(), share);
        }
        near(name, "speed", operation.speeds[0].1.si() * 30.0 / std::f64::consts::PI, rpm);
        match &operation.loads[0].1 {
            Load::Torque(t) => near(name, "torque", t.si(), torque),
            // The second form of the planetary stage has a power, 100 kW, and no torque; the list of what is expected
            // repeats the torque of the first.
            Load::Power(p) => assert_eq!((name, p.si()), ("fva-planetary-stage-1.1-v2.rexsj", 100e3)),
        }
        let (report, _) = operate(train, operation).unwrap();
        assert_eq!(report.verdict, Verdict::Unique, "{name}");
        let ends = train.terminals().iter().map(|m| report.speeds_rad_s.get(train.member_name(*m)).unwrap().unwrap());
        let ends: Vec<f64> = ends.collect();
        let ratio = wanted.get("ratio_sun_to_carrier").or(wanted.get("ratio")).and_then(Value::as_str).unwrap();
        let (top, bottom) = ratio.split_once('/').unwrap();
        let ratio: f64 = top.parse::<f64>().unwrap() / bottom.parse::<f64>().unwrap();
        assert!((ends[0] / ends[1] - ratio).abs() < 1e-9, "{name}: {}", ends[0] / ends[1]);
    }
    let told: Vec<String> = read.report.problems.iter().map(|p| p.message.clone()).collect();
    for warning in list(&wanted["warnings"]) {
        let (subject, what) = warning.as_str().unwrap().split_once(' ').unwrap();
        let what = if what.contains("impossible") { "impossible" } else { what };
        assert!(told.iter().any(|t| t.contains(subject) && t.contains(what)), "{name}: {warning}: {told:?}");
    }
}
