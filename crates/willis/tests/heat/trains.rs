//! Heat of whole trains: what an operating point, a study and a file make of it, and what is refused.

use willis::analysis::{HeatBasis, HeatReport, Selection, analyze};
use willis::diagnostic::Code;
use willis::heat::HeatVerdict;
use willis::model::Model;
use willis::study::{CalibrateRequest, CycleRequest, HeatRequest, calibrate, cycle, heat, sensitivity};
use willis::train::Train;
use willis::work::Serial;

use crate::common::{Dice, example, examples};

const ZERO: f64 = 273.15;

fn industrial() -> Model {
    Model::from_toml(&example("industrial-planetary-heat.toml")).unwrap()
}

fn report(train: &Train, operation: &str) -> HeatReport {
    let selection = Selection { operation: Some(operation.into()), ..Selection::default() };
    *analyze(train, &selection).unwrap().operations[0].heat.clone().unwrap()
}

/// All heat that is made leaves through the paths to places of given temperature and the cooler.
#[test]
fn heat_is_made_and_leaves() {
    let model = industrial();
    let h = report(model.train(), "rated");
    assert_eq!((h.basis, h.verdict), (HeatBasis::Balance, Some(HeatVerdict::Unique)));
    let given = |name: &str| h.places.get(name).unwrap().given;
    let leaves: f64 = h.paths.iter().filter(|p| given(&p.between[1])).map(|p| p.heat_w).sum();
    let leaves = leaves + h.cooler_w.unwrap();
    assert!((leaves - h.heat_w).abs() < 1e-5 * h.heat_w, "{leaves} of {}", h.heat_w);
    assert!(h.residual_w.abs() < 1e-5 * h.heat_w);
    let solution = &analyze(model.train(), &Selection::default()).unwrap().operations[0].solutions[0];
    assert!((solution.loss_w - h.heat_w).abs() < 1e-9 * h.heat_w);
    // The sun is the hottest, the housing cooler than the oil.
    let t = |name: &str| h.places.get(name).unwrap().temperature_k;
    assert!(t("sun gear") > t("planets") && t("planets") > t("oil") && t("oil") > t("housing"));
}

/// A temperature that is given wins; the oil that is hotter than in balance cools.
#[test]
fn a_given_temperature_stays_and_the_rest_is_told() {
    let model = industrial();
    let balance = report(model.train(), "rated").oil_k;
    for (k, warms) in [(balance - 10.0, true), (balance, false), (balance + 10.0, false)] {
        let text = example("industrial-planetary-heat.toml")
            .replace("name = \"rated\"\n", &format!("name = \"rated\"\ntemperature = \"{k} K\"\n"));
        let h = report(Model::from_toml(&text).unwrap().train(), "rated");
        assert_eq!((h.basis, h.oil_k), (HeatBasis::Given, k));
        assert_eq!(h.residual_w > 1.0, warms, "{}", h.residual_w);
    }
}

/// Derivatives through the balance are those of differences.
#[test]
fn what_moves_the_oil_temperature_is_what_a_difference_says() {
    let model = industrial();
    let all =
        sensitivity(model.train(), &Selection { operation: Some("rated".into()), ..Selection::default() }).unwrap();
    let o = &all.operations[0];
    assert!(o.quantities.iter().all(|q| q.name != "oil.temperature"));
    for (name, path, unit, scale) in [
        ("heat.ambient", "heat.ambient", "K", 1.0),
        ("heat.cooler.flow", "heat.cooler.flow", "m^3/s", 1.0),
        ("heat.cooler.effectiveness", "heat.cooler.effectiveness", "", 1.0),
        ("heat.path.7.area", "heat.path.7.area", "m^2", 1.0),
        ("heat.path.1.conductance", "heat.path.1.conductance", "W/K", 1.0),
        ("oil.viscosity_40", "oil.viscosity_40", "mm^2/s", 1e6),
        ("P1.geometry.width", "P1.geometry.width", "mm", 1e3),
    ] {
        let q = o.quantities.iter().find(|q| q.name == name).unwrap_or_else(|| panic!("no {name}"));
        let h = 1e-4 * q.value;
        let at = |x: f64| {
            let with = model.with([(path, format!("{} {unit}", x * scale).trim().to_owned())]).unwrap();
            let a =
                analyze(with.train(), &Selection { operation: Some("rated".into()), ..Selection::default() }).unwrap();
            let o = &a.operations[0];
            (o.heat.as_ref().unwrap().oil_k, o.solutions[0].loss_w)
        };
        let (low, high) = (at(q.value - h), at(q.value + h));
        let (oil, loss) = ((high.0 - low.0) / (2.0 * h), (high.1 - low.1) / (2.0 * h));
        let near = |is: f64, wanted: f64, what: &str| {
            assert!((is - wanted).abs() <= 2e-3 * wanted.abs() + 1e-9, "{name}, {what}: {is} and not {wanted}");
        };
        near(q.oil_derivative.unwrap(), oil, "oil");
        near(q.loss_derivative_w, loss, "loss");
    }
}

/// At the thermal rating the oil has its limit; the warm-up ends where the balance is.
#[test]
fn rating_and_warm_up_agree_with_the_balance() {
    let model = industrial();
    let all =
        heat(&model, &HeatRequest { operation: Some("rated".into()), ..HeatRequest::default() }, &Serial).unwrap();
    let o = &all.operations[0];
    let h = o.heat.as_ref().unwrap();
    let factor = o.rating.unwrap().load_factor.unwrap();
    assert!(factor > 1.0);
    let torque = 1591.549 * factor;
    let text =
        example("industrial-planetary-heat.toml").replace("sun = \"1591.549 N m\"", &format!("sun = \"{torque} N m\""));
    let hot = report(Model::from_toml(&text).unwrap().train(), "rated");
    assert!((hot.oil_k - hot.limit_k).abs() < 1e-3, "{} K", hot.oil_k - hot.limit_k);
    let w = o.warm_up.as_ref().unwrap();
    let last = w.rows.last().unwrap();
    assert!((last.temperatures_k[0] - h.oil_k).abs() < 0.5, "{} {}", last.temperatures_k[0], h.oil_k);
    assert!(w.audit < 1e-9 && w.interpolation < 1e-3, "{} {}", w.audit, w.interpolation);
    assert!(w.settled_s.is_some());
}

/// A duty cycle lies between its rows, and `cycle` runs at its mean.
#[test]
fn a_duty_cycle_repeats_itself() {
    let model = industrial();
    let profile = "duration [min],input.torque [N m]\n20,1591.549\n40,400\n".to_owned();
    let request = HeatRequest { profile: profile.clone(), ..HeatRequest::default() };
    let duty = heat(&model, &request, &Serial).unwrap().duty.unwrap();
    assert!(duty.lowest_k < duty.mean_k && duty.mean_k < duty.highest_k);
    assert!(duty.highest_k < report(model.train(), "rated").oil_k + 1e-6);
    assert!(duty.left_k < 1e-6 && duty.audit < 1e-9);
    let answer = cycle(&model, &CycleRequest { profile, ..CycleRequest::default() }, &Serial).unwrap();
    let oil = answer.report.oil.unwrap();
    assert!((oil.mean_k.unwrap() - duty.mean_k).abs() < 1e-9);
}

/// Losses of one law rise faster with temperature than the heat that leaves into very cold air: three temperatures hold, and
/// the one in the middle parts what a cold start reaches from what a hot one does.
#[test]
fn several_temperatures_are_told() {
    let base = example("fva-planetary-stage.toml").replace("roughness = \"0.833 um\"", "roughness = \"0.3 um\"");
    let text = |conductance: f64| {
        format!(
            "{base}\n[laws]\nmesh_friction = \"fernandes\"\n[heat]\nambient = \"-70 degC\"\nlimit = \"200 degC\"\n\
             conductance = \"{conductance} W/K\"\n[[operation]]\nname = \"slow\"\nspeeds = {{ sun = \"500 rpm\" }}\n\
             torques = {{ sun = \"300 N m\" }}\n"
        )
    };
    let mut seen = vec![];
    for conductance in [1.3, 1.46, 1.48, 1.485, 1.49, 1.495, 1.5, 1.505, 1.51, 1.52, 2.0] {
        let model = Model::from_toml(&text(conductance)).unwrap();
        let selection = Selection { operation: Some("slow".into()), ..Selection::default() };
        let a = analyze(model.train(), &selection).unwrap();
        let h = a.operations[0].heat.as_ref().unwrap();
        let told = a.diagnostics.iter().any(|d| d.code == Code::SeveralTemperatures);
        assert_eq!(told, matches!(h.verdict, Some(HeatVerdict::Several | HeatVerdict::Undecided)));
        if h.verdict == Some(HeatVerdict::Several) {
            // Stable and unstable alternate, and a cold start reaches the coldest.
            assert_eq!(h.equilibria.iter().map(|e| e.stable).collect::<Vec<_>>(), [true, false, true]);
            assert_eq!(h.oil_k, h.equilibria[0].oil_k);
        }
        seen.push(h.verdict.unwrap());
    }
    assert!(seen.contains(&HeatVerdict::Unique) && seen.contains(&HeatVerdict::Several), "{seen:?}");
}

#[test]
fn bad_heat_is_refused_with_its_place() {
    let base = example("fva-planetary-stage.toml");
    for (keys, code, place) in [
        ("ambient = '100 degC'\nconductance = '45 W/K'", Code::OutOfRange, "heat.ambient"),
        ("ambient = '20 degC'", Code::MissingKey, "heat"),
        ("ambient = '20 degC'\narea = '0.6 m^2'", Code::MissingKey, "heat.area"),
        ("ambient = '20 degC'\ncoefficient = '15 W/(m^2 K)'", Code::MissingKey, "heat.area"),
        ("ambient = '20 degC'\narea = '0 m^2'\nheight = '1 m'", Code::OutOfRange, "heat.area"),
        (
            "ambient = '20 degC'\nconductance = '45 W/K'\nheat_capacity = '-1 kJ/K'",
            Code::OutOfRange,
            "heat.heat_capacity",
        ),
        ("ambient = '20 degC'\nconductance = '-45 W/K'", Code::OutOfRange, "heat.conductance"),
        ("ambient = '20 degC'\nconductance = '45 W'", Code::Quantity, "heat.conductance"),
        (
            "ambient = '20 degC'\nconductance = '45 W/K'\narea = '1 m^2'\ncoefficient = '15 W/(m^2 K)'",
            Code::Conflict,
            "heat",
        ),
        ("ambient = '20 degC'\nconductance = '45 W/K'\nstart = '99 degC'", Code::OutOfRange, "heat.start"),
        (
            "ambient = '20 degC'\ncooler = { inlet = '98 degC', conductance = '9 W/K' }",
            Code::OutOfRange,
            "heat.cooler.inlet",
        ),
        ("ambient = '20 degC'\ncooler = { inlet = '30 degC', flow = '6 l/min' }", Code::Conflict, "heat.cooler"),
        (
            "ambient = '20 degC'\ncooler = { inlet = '30 degC', flow = '6 l/min', effectiveness = 1.2 }",
            Code::OutOfRange,
            "heat.cooler.effectiveness",
        ),
        (
            "ambient = '20 degC'\nnode = [{ name = 'ring' }]\npath = [{ between = ['oil', 'ambient'], conductance = '9 W/K' }]",
            Code::MissingKey,
            "heat",
        ),
        (
            "ambient = '20 degC'\npath = [{ between = ['oil', 'ambience'], conductance = '9 W/K' }]",
            Code::UnknownName,
            "heat.path[0].between[1]",
        ),
        (
            "ambient = '20 degC'\nnode = [{ name = 'gear', parts = ['sum'] }]\n\
             path = [{ between = ['oil', 'ambient'], conductance = '9 W/K' }]",
            Code::UnknownName,
            "heat.node[0].parts[0]",
        ),
        (
            "ambient = '20 degC'\nnode = [{ name = 'oil' }]\npath = [{ between = ['oil', 'ambient'], conductance = '9 W/K' }]",
            Code::DuplicateName,
            "heat.node[0].name",
        ),
    ] {
        let Err(wrong) = Train::from_toml(&format!("{base}\n[heat]\n{keys}\n")) else { panic!("{keys} is taken") };
        assert!(wrong.iter().any(|d| d.code == code && d.place == place), "{keys}\n{wrong}");
    }
}

/// Losses of a stage whose laws are off by known factors, at speeds, loads and temperatures.
fn rig(hidden: &[(&str, &str)], noise: f64) -> String {
    let truth = Model::from_toml(&example("fva-planetary-stage.toml")).unwrap();
    let truth = truth.with(hidden.iter().copied()).unwrap();
    let mut text =
        "# made\ninput.speed [rpm],input.torque [N m],oil.temperature [degC],loss [W],sigma [W],group,note\n"
            .to_owned();
    let mut k = 0;
    for (group, rpm) in [("a", 500.0), ("b", 1000.0), ("c", 1500.0)] {
        for torque in [50.0, 500.0, 1000.0, 1500.0] {
            for celsius in [50.0, 85.0] {
                let at = truth
                    .with([
                        ("rated.speeds.sun".to_owned(), format!("{rpm} rpm")),
                        ("rated.torques.sun".to_owned(), format!("{torque} N m")),
                        ("rated.temperature".to_owned(), format!("{celsius} degC")),
                    ])
                    .unwrap();
                let a = analyze(at.train(), &Selection { operation: Some("rated".into()), ..Selection::default() })
                    .unwrap();
                let loss = a.operations[0].solutions[0].loss_w;
                // Digits that look like noise, and are the same in every run.
                let off = ((k * 37 % 11) as f64 - 5.0) / 3.3 * noise * loss;
                text += &format!("{rpm},{torque},{celsius},{:.3},{:.3},{group},\n", loss + off, 0.01 * loss);
                k += 1;
            }
        }
    }
    text
}

#[test]
fn hidden_factors_are_found_and_every_command_has_them() {
    let hidden =
        [("losses.factor.teeth", "1.25"), ("losses.factor.bearing_no_load", "0.7"), ("losses.factor.seal", "1.1")];
    let model = Model::from_toml(&example("fva-planetary-stage.toml")).unwrap();
    let request = CalibrateRequest { data: rig(&hidden, 0.003), name: "rig.csv".into(), ..CalibrateRequest::default() };
    let c = calibrate(&model, &request, &Serial).unwrap();
    assert!(c.converged && c.groups == 3 && c.tests == 24);
    assert!(c.learnt < c.combinations && !c.blind.is_empty());
    let part = |key: &str| c.parts.iter().find(|p| p.key == key).unwrap();
    for (path, value) in hidden {
        let p = part(path.rsplit('.').next().unwrap());
        let truth: f64 = value.parse().unwrap();
        assert!(p.band[0] < truth && truth < p.band[1], "{path}: {truth} is outside {:?}", p.band);
    }
    assert!((part("teeth").factor - 1.25).abs() < 0.05, "{}", part("teeth").factor);
    // The file that results predicts what the answer says.
    let after = Model::from_toml(&c.train_file).unwrap();
    let a = analyze(after.train(), &Selection::default()).unwrap();
    for p in &c.predictions {
        let o = a.operations.iter().find(|o| o.name == p.operation).unwrap();
        assert!((o.solutions[0].loss_w - p.loss_w).abs() < 1e-4 * p.loss_w);
        assert!(p.band_w[0] < p.loss_w && p.loss_w < p.band_w[1]);
    }
    assert!(a.assumptions.iter().any(|l| l.contains("calibrated, 24 tests of rig.csv")), "{:?}", a.assumptions);
    assert!(c.predictions.iter().any(|p| p.operation == "rated" && p.outside.iter().any(|o| o.0.contains("torque"))));
    assert!(!c.next.is_empty() && c.next.windows(2).all(|w| w[0].lowers_variance >= w[1].lowers_variance));
}

/// A meter that shows too much in one group is found as an offset of that group.
#[test]
fn the_offset_of_a_meter_is_found() {
    let model = Model::from_toml(&example("fva-planetary-stage.toml")).unwrap();
    let plain = rig(&[], 0.0);
    let shifted: Vec<String> = plain
        .lines()
        .map(|l| {
            let mut cells: Vec<String> = l.split(',').map(str::to_owned).collect();
            if cells.get(5).is_some_and(|g| g == "b") {
                let loss: f64 = cells[3].parse().unwrap();
                cells[3] = format!("{:.3}", loss + 2.0 * 1000.0 * std::f64::consts::PI / 30.0);
            }
            cells.join(",")
        })
        .collect();
    let request = CalibrateRequest {
        data: shifted.join("\n"),
        offsets: vec![("input".into(), 3.0)],
        ..CalibrateRequest::default()
    };
    let c = calibrate(&model, &request, &Serial).unwrap();
    for o in &c.offsets {
        let wanted = if o.group == "b" { 2.0 } else { 0.0 };
        assert!((o.offset_n_m - wanted).abs() < 3.0 * o.spread_n_m.max(0.05), "{}: {}", o.group, o.offset_n_m);
    }
}

#[test]
fn bad_tests_are_refused() {
    let model = Model::from_toml(&example("fva-planetary-stage.toml")).unwrap();
    for (data, said) in [
        ("", "the data are empty"),
        ("input.speed [rpm],loss [W]\n", "no test"),
        ("input.speed [rpm],loss [W]\n1000,900\n", "one test cannot"),
        ("input.speed [rpm],power [W]\n1000,900\n1500,1000\n", "measured loss"),
        ("input.speed [rpm],loss [N m]\n1000,900\n1500,1000\n", "no unit of power"),
        ("input.speed [rpm],loss\n1000,900\n1500,1000\n", "has no unit"),
        ("input.speed [rpm],loss [W]\n1000,nan\n1500,1000\n", "line 2"),
        ("input.speed [rpm],loss [W]\n1000,-5\n1500,1000\n", "line 2"),
        ("input.speed [rpm],loss [W],sigma [W]\n1000,900,0\n1500,1000,5\n", "line 2"),
        ("input.speed [rpm],loss [W]\n1000\n1500,1000\n", "line 2"),
        ("input.sped [rpm],loss [W]\n1000,900\n1500,1000\n", "sped"),
        ("input.speed [N],loss [W]\n1000,900\n1500,1000\n", "N"),
    ] {
        let request = CalibrateRequest { data: data.into(), ..CalibrateRequest::default() };
        let Err(wrong) = calibrate(&model, &request, &Serial) else { panic!("{data:?} is taken") };
        assert!(wrong.to_string().contains(said), "{data:?}\n{wrong}");
    }
    // A column that never changes is told, and is no error.
    let data = "input.speed [rpm],oil.temperature [degC],loss [W]\n1000,60,2600\n1500,60,3700\n".to_owned();
    let c = calibrate(&model, &CalibrateRequest { data, ..CalibrateRequest::default() }, &Serial).unwrap();
    assert!(c.notes.iter().any(|n| n.contains("oil.temperature") && n.contains("same in every test")), "{:?}", c.notes);
    let given = Model::from_toml(&example("textbook-reverted.toml")).unwrap();
    let data = "loss [W]\n1\n2\n".to_owned();
    let wrong = calibrate(&given, &CalibrateRequest { data, ..CalibrateRequest::default() }, &Serial).unwrap_err();
    assert!(wrong.iter().any(|d| d.code == Code::Unfit), "{wrong}");
}

/// Without [heat] nothing is said of it, and the question tells what is missing.
#[test]
fn without_heat_there_is_no_answer() {
    let model = Model::from_toml(&example("fva-planetary-stage.toml")).unwrap();
    let wrong = heat(&model, &HeatRequest::default(), &Serial).unwrap_err();
    assert!(wrong.iter().any(|d| d.code == Code::MissingKey && d.place == "heat"), "{wrong}");
    let h = report(industrial().train(), "half load");
    assert!(h.oil_k > 20.0 + ZERO && h.margin_k > 0.0);
}

/// A worm box of a textbook: 0.30 m² at 23 W/(m² K) with a fan, 50 K above the air, lead 6°, µ 0.05 at 22°: efficiency
/// `tan 6°/tan(6° + 3.087°) = 0.6572`, thermal power `345 W/(1 − 0.6572) = 1.006 kW`.
#[test]
fn val_thermal_rating_of_a_worm_box() {
    let friction = (0.05 / 22f64.to_radians().cos()).atan();
    let efficiency = 6f64.to_radians().tan() / (6f64.to_radians() + friction).tan();
    assert!((efficiency - 0.6572).abs() < 5e-5);
    let model = Model::from_toml(&format!(
        "format = 1\nname = \"worm\"\nmembers = [\"a\", \"b\"]\nterminals = [\"a\", \"b\"]\n\
         mesh = [{{ gears = [{{ member = \"a\", teeth = 2 }}, {{ member = \"b\", teeth = 40 }}], efficiency = {efficiency} }}]\n\
         [heat]\nambient = \"20 degC\"\nlimit = \"70 degC\"\narea = \"0.30 m^2\"\ncoefficient = \"23 W/(m^2 K)\"\n\
         [[operation]]\nname = \"x\"\nspeeds = {{ a = \"150 rad/s\" }}\ntorques = {{ a = \"3 N m\" }}\n"
    ))
    .unwrap();
    let all = heat(&model, &HeatRequest::default(), &Serial).unwrap();
    let rating = all.operations[0].rating.unwrap();
    assert!((rating.heat_w.unwrap() - 345.0).abs() < 1e-3);
    assert!((rating.input_power_w.unwrap() - 1006.0).abs() < 0.5, "{:?}", rating.input_power_w);
}

/// Catalogues of makers: what an ambient of 10, 20, 30, 40 °C leaves of the thermal power. A linear balance with 95 °C gives
/// 1.13, 1, 0.87, 0.73.
#[test]
fn val_thermal_rating_over_the_air_around() {
    let at = |celsius: f64| {
        let model = Model::from_toml(&format!(
            "format = 1\nname = \"box\"\nmembers = [\"a\", \"b\"]\nterminals = [\"a\", \"b\"]\n\
             mesh = [{{ gears = [{{ member = \"a\", teeth = 20 }}, {{ member = \"b\", teeth = 40 }}], efficiency = 0.98 }}]\n\
             [heat]\nambient = \"{celsius} degC\"\nlimit = \"95 degC\"\nconductance = \"10 W/K\"\n\
             [[operation]]\nname = \"x\"\nspeeds = {{ a = \"150 rad/s\" }}\ntorques = {{ a = \"30 N m\" }}\n"
        ))
        .unwrap();
        heat(&model, &HeatRequest::default(), &Serial).unwrap().operations[0].rating.unwrap().input_power_w.unwrap()
    };
    for (celsius, factor) in [(10.0, 1.13), (20.0, 1.0), (30.0, 0.87), (40.0, 0.73)] {
        assert!((at(celsius) / at(20.0) - factor).abs() < 0.005);
    }
}

/// The more air moves along a box, the colder it is: also where it hardly moves.
#[test]
fn more_air_never_heats() {
    let text = |air: f64| {
        format!(
            "format = 1\nname = \"box\"\nmembers = [\"a\", \"b\"]\nterminals = [\"a\", \"b\"]\nmesh = [{{ gears = [{{ member = \
             \"a\", teeth = 20 }}, {{ member = \"b\", teeth = 30 }}], efficiency = 0.99 }}]\n[heat]\nambient = \"20 degC\"\nlength = \
             \"0.6 m\"\nwidth = \"0.4 m\"\nheight = \"0.4 m\"\nair_speed = \"{air} m/s\"\n[[operation]]\nname = \"o\"\nspeeds = {{ \
             a = \"100 rad/s\" }}\ntorques = {{ a = \"400 N m\" }}\n"
        )
    };
    let mut last = f64::INFINITY;
    for air in [0.0, 0.01, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0] {
        let oil = report(Model::from_toml(&text(air)).unwrap().train(), "o").oil_k;
        assert!(oil <= last + 1e-9 && oil > 293.15, "{air} m/s: {oil} after {last}");
        last = oil;
    }
}

/// The balance is looked for in floating point, from one temperature to the next; where it is found, everything is solved
/// exactly: there the heat must leave that is made, for every train with laws and at any warmth.
#[test]
fn a_balance_found_in_floating_point_is_one_of_exact_numbers() {
    let mut dice = Dice(0x4ea7);
    let mut seen = 0;
    for (name, text) in examples() {
        let model = Model::from_toml(&text).unwrap();
        if !model.train().is_physical() || model.train().heat().is_some() {
            continue;
        }
        let all = analyze(model.train(), &Selection::default()).unwrap().operations;
        let all = all.into_iter().map(|o| (o.name, o.solutions.first().map_or(0.0, |s| s.loss_w)));
        for (operation, loss) in all.filter(|o| o.1 > 0.0) {
            for _ in 0..6 {
                // From a few kelvin above the air to beyond the limit.
                let conductance = loss / (60.0 + 55.0 * dice.unit());
                let heat = format!(
                    "\n[heat]\nambient = \"{} degC\"\nlimit = \"110 degC\"\nconductance = \"{conductance} W/K\"\n",
                    dice.whole(-20, 40)
                );
                let heated = Model::from_toml(&(text.clone() + &heat)).unwrap();
                let selection = Selection { operation: Some(operation.clone()), ..Selection::default() };
                let all = analyze(heated.train(), &selection).unwrap().operations;
                let Some(h) = all[0].heat.as_ref().filter(|h| h.basis == HeatBasis::Balance) else { continue };
                let left = h.residual_w.abs() / h.heat_w;
                assert!(left < 3e-8, "{name}, {operation}: {left:e} of {} W", h.heat_w);
                seen += 1;
            }
        }
    }
    assert!(seen > 20, "{seen}");
}

/// A cooler that is colder than the air takes the oil below it, and the warm-up goes there, too.
#[test]
fn a_warm_up_ends_where_the_balance_is() {
    let text = example("industrial-planetary-heat.toml")
        .replace("inlet = \"30 degC\"", "inlet = \"-25 degC\"")
        .replace("opens = \"50 degC\"\nopen = \"60 degC\"\n", "")
        .replace("effectiveness = 0.55", "effectiveness = 0.95");
    let model = Model::from_toml(&text).unwrap();
    let all =
        heat(&model, &HeatRequest { operation: Some("rated".into()), ..HeatRequest::default() }, &Serial).unwrap();
    let o = &all.operations[0];
    let (oil, w) = (o.heat.as_ref().unwrap().oil_k, o.warm_up.as_ref().unwrap());
    assert!(oil < 293.15, "{oil}");
    assert!((w.rows.last().unwrap().temperatures_k[0] - oil).abs() < 0.5, "{:?} {oil}", w.rows.last());
}

/// A run that meets the limit ends there: what it says of heat is up to there.
#[test]
fn a_warm_up_that_meets_the_limit_ends_there() {
    let text = "format = 1\nname = \"hot\"\nmembers = [\"a\", \"b\"]\nterminals = [\"a\", \"b\"]\nmesh = [{ gears = [{ member = \"a\", \
                teeth = 20 }, { member = \"b\", teeth = 30 }], efficiency = 0.99 }]\n[heat]\nambient = \"20 degC\"\nconductance = \"1 \
                W/K\"\nheat_capacity = \"10 kJ/K\"\n[[operation]]\nname = \"o\"\nspeeds = { a = \"100 rad/s\" }\ntorques = { a = \
                \"300 N m\" }\n";
    let model = Model::from_toml(text).unwrap();
    let all = heat(&model, &HeatRequest::default(), &Serial).unwrap();
    let w = all.operations[0].warm_up.as_ref().unwrap();
    let end = w.limit_after_s.unwrap();
    // 300 W, 1 W/K, 10 kJ/K: 75 of 300 K after C/UA ln(300/225).
    assert!((end - 1e4 * (300.0f64 / 225.0).ln()).abs() < 5.0, "{end}");
    assert!((w.made_j - 300.0 * end).abs() < 1e-3 * w.made_j && w.audit < 1e-9, "{w:?}");
    assert!((w.rows.last().unwrap().time_s - end).abs() < 1e-9);
}

/// What a profile cannot change, and what a duty cycle finds by itself, is refused.
#[test]
fn a_profile_changes_the_load_and_nothing_around_it() {
    let model = industrial();
    for (column, value, said) in
        [("heat.ambient [degC]", "30", "a key of [heat]"), ("oil.temperature [degC]", "60", "finds it")]
    {
        let profile = format!("duration [min],{column}\n20,{value}\n40,20\n");
        let wrong = heat(&model, &HeatRequest { profile, ..HeatRequest::default() }, &Serial).unwrap_err();
        assert!(wrong.to_string().contains(said), "{wrong}");
    }
}

/// Tests that contradict each other have no factors; a group whose meters are wrong is told, and widens what is predicted.
#[test]
fn tests_that_do_not_fit_are_told() {
    let model = Model::from_toml(&example("fva-planetary-stage.toml")).unwrap();
    let ask = |data: String| calibrate(&model, &CalibrateRequest { data, ..CalibrateRequest::default() }, &Serial);
    let csv = std::fs::read_to_string(
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/tests-fva-planetary-stage.csv"),
    )
    .unwrap();
    let good = ask(csv.clone()).unwrap();
    let header: Vec<&str> = csv.lines().find(|l| l.contains("loss [W]")).unwrap().split(',').collect();
    let [loss, group] = ["loss [W]", "group"].map(|name| header.iter().position(|h| h.trim() == name).unwrap());
    let last = csv.lines().last().unwrap().split(',').nth(group).unwrap().to_owned();
    let wrong: String = csv
        .lines()
        .map(|line| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if cells.get(group) == Some(&last) {
                cells[loss] = format!("{}", 1.3 * cells[loss].trim().parse::<f64>().unwrap());
            }
            cells.join(",") + "\n"
        })
        .collect();
    let bad = ask(wrong).unwrap();
    assert!(bad.group_misfit > 2.0 * good.group_misfit, "{} {}", bad.group_misfit, good.group_misfit);
    let width = |c: &willis::study::Calibration| c.predictions[0].band_w[1] - c.predictions[0].band_w[0];
    assert!(width(&bad) > 1.5 * width(&good));
}
