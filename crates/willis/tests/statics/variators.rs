//! Power splits: variators by members and by machines on a bus, beside exact results of an enumeration in fractions (every
//! sign pattern tried; each figure is that fraction as it was printed there).

use willis::analysis::{Analysis, LimitedQuantity, OperationReport, Role, Selection, SolutionReport, Verdict, analyze};
use willis::compiled::{CompileRequest, CompiledOutput};
use willis::diagnostic::{Code, Diagnostics};
use willis::model::Model;
use willis::study::{Axis, Hold, PointSetup, Sweep, sensitivity};
use willis::train::{Document, Train};

fn read(text: &str) -> Train {
    Train::from_toml(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn answer(train: &Train) -> Analysis {
    analyze(train, &Selection::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn only(o: &OperationReport) -> &SolutionReport {
    let [s] = &o.solutions[..] else { panic!("{:?}: {:?}", o.verdict, o.reason) };
    s
}

fn fraction(text: &str) -> f64 {
    let (n, d) = text.split_once('/').unwrap_or((text, "1"));
    n.parse::<f64>().unwrap() / d.parse::<f64>().unwrap()
}

fn near(what: &str, found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs() + 1e-12, "{what}: {found}, not {expected}");
}

fn torque(s: &SolutionReport, member: &str) -> f64 {
    s.members.get(member).unwrap().torque_n_m.unwrap()
}

/// Power balances, over the terminals and over the variator by itself.
fn balances(s: &SolutionReport) {
    assert!(s.power_residual_w.abs() <= 1e-11 * s.input_power_w, "{} of {}", s.power_residual_w, s.input_power_w);
    for (name, v) in s.variators.iter() {
        let out: f64 = v.machines.iter().map(|(_, m)| m.power_w).sum();
        let lost = v.store_w.unwrap_or(0.0) - out - v.loss_w;
        assert!(lost.abs() <= 1e-11 * s.input_power_w, "{name}: {lost}");
    }
}

const PRIUS: &str = "format = 1\nname = \"Prius set\"\nmembers = [\"mg1\", \"engine\", \"ring\"]\n\
    terminals = [\"engine\", \"ring\"]\n[[set]]\nname = \"P1\"\nsun = { member = \"mg1\", teeth = 30 }\n\
    planet = { teeth = 24 }\nring = { member = \"ring\", teeth = 78 }\ncarrier = \"engine\"\nmesh_efficiency = 0.985\n";

fn prius(ring: &str, variator: &str) -> Train {
    read(&format!(
        "{PRIUS}[[variator]]\nname = \"path\"\n{variator}\n[[operation]]\nname = \"o\"\n\
         speeds = {{ engine = \"2000 rpm\", {ring} }}\ntorques = {{ engine = \"100 N m\" }}\n"
    ))
}

#[test]
fn val_input_split_with_one_efficiency() {
    let path = |eta: &str| format!("members = [\"mg1\", \"ring\"]\nefficiency = {eta}");
    for (ring, eta, efficiency, external, mg1, on_ring) in [
        ("ring = \"500 rpm\"", "0.85", "16441809/19041200", "-16441809/47603", "-3880900/142809", "38925427/142809"),
        ("ring = \"1500 rpm\"", "1", "946899/952060", "-6312660/47603", "-3880900/142809", "8537980/142809"),
        // The mechanical point: ring at 36000/13 rpm.
        ("mg1 = \"0 rpm\"", "0.85", "232854/234839", "-50451700/704517", "-20000000/704517", "0"),
        ("ring = \"4000 rpm\"", "1", "229678/234839", "-11483900/234839", "-20000000/704517", "-16000000/704517"),
    ] {
        let o = &answer(&prius(ring, &path(eta))).operations[0];
        let s = only(o);
        assert_eq!(o.verdict, Verdict::Unique);
        near(ring, s.efficiency.unwrap(), fraction(efficiency));
        near(ring, torque(s, "ring"), fraction(external));
        let v = s.variators.get("path").unwrap();
        near(ring, v.machines.get("mg1").unwrap().torque_n_m, fraction(mg1));
        near(ring, v.machines.get("ring").unwrap().torque_n_m, fraction(on_ring));
        balances(s);
    }
}

#[test]
fn val_input_split_with_two_machines_and_a_store() {
    let rpm = std::f64::consts::PI / 30.0;
    for (ring, store, efficiency, external, mg1, on_ring) in [
        ("1500 rpm", 0.0, "1111477819/1190075000", "-2222955638/17851125", "-3880900/142809", "922955638/17851125"),
        (
            "4000 rpm",
            20_000.0 * rpm,
            "7717852090/8377411647",
            "-38589260450/761582877",
            "-20000000/704517",
            "-15949027250/761582877",
        ),
    ] {
        let bus = format!(
            "machines = [{{ name = \"mg1\", efficiency = 0.92 }}, {{ name = \"mg2\", member = \"ring\", efficiency = 0.94 }}]\n\
             store = \"{store} W\""
        );
        let train = prius(&format!("ring = \"{ring}\""), &bus);
        let s = only(&answer(&train).operations[0]).clone();
        near(ring, s.efficiency.unwrap(), fraction(efficiency));
        near(ring, torque(&s, "ring"), fraction(external));
        let v = s.variators.get("path").unwrap();
        near(ring, v.machines.get("mg1").unwrap().torque_n_m, fraction(mg1));
        near(ring, v.machines.get("mg2").unwrap().torque_n_m, fraction(on_ring));
        near(ring, v.store_w.unwrap(), store);
        balances(&s);
    }
}

const COMPOUND: &str = "format = 1\nname = \"Two-set compound split\"\nmembers = [\"engine\", \"wheels\", \"mga\", \"mgb\"]\n\
    terminals = [\"engine\", \"wheels\"]\n[[set]]\nname = \"P1\"\nsun = { member = \"mga\", teeth = 37 }\n\
    ring = { member = \"engine\", teeth = 83 }\ncarrier = \"wheels\"\nmesh_efficiency = 0.9925\n\
    [[set]]\nname = \"P2\"\nsun = { member = \"mgb\", teeth = 37 }\nring = { member = \"mga\", teeth = 83 }\n\
    carrier = \"wheels\"\nmesh_efficiency = 0.9925\n\
    [[variator]]\nname = \"path\"\nmembers = [\"mga\", \"mgb\"]\nefficiency = 0.85\n";

fn compound(wheels: &str) -> Analysis {
    answer(&read(&format!(
        "{COMPOUND}[[operation]]\nname = \"o\"\nspeeds = {{ engine = \"2000 rpm\", wheels = \"{wheels}\" }}\n\
         torques = {{ engine = \"286.5 N m\" }}\n"
    )))
}

#[test]
fn val_compound_split() {
    for (wheels, efficiency, external, mga, mgb) in [
        (
            "900 rpm",
            "188222284359/211561392769",
            "-119834854375230/211561392769",
            "49063894472150/211561392769",
            "20317241749523/423122785538",
        ),
        (
            "2400 rpm",
            "1996827675685722/2020407063071435",
            "-190697043027986451/808162825228574",
            "20375574400000000/3636732713528583",
            "-204162803200000000/3636732713528583",
        ),
    ] {
        let a = compound(wheels);
        let s = only(&a.operations[0]);
        near(wheels, s.efficiency.unwrap(), fraction(efficiency));
        near(wheels, torque(s, "wheels"), fraction(external));
        let v = s.variators.get("path").unwrap();
        near(wheels, v.machines.get("mga").unwrap().torque_n_m, fraction(mga));
        near(wheels, v.machines.get("mgb").unwrap().torque_n_m, fraction(mgb));
        balances(s);
    }
}

/// Where power recirculates through a lossy path, there are two equilibria: one drives with 20.7 % (59.8 %), in the other
/// everything is dissipated (`variator.md`, section 4).
#[test]
fn val_recirculation_through_a_lossy_path_has_two_equilibria() {
    for (wheels, efficiency) in [("100 rpm", 0.207), ("400 rpm", 0.598)] {
        let a = compound(wheels);
        let o = &a.operations[0];
        assert_eq!(o.verdict, Verdict::Multiple, "{wheels}: {:?}", o.reason);
        let mut all: Vec<f64> =
            o.solutions.iter().map(|s| if s.all_dissipated { 0.0 } else { s.efficiency.unwrap() }).collect();
        all.sort_by(f64::total_cmp);
        assert_eq!(all.len(), 2, "{all:?}");
        assert!(all[0] == 0.0 && (all[1] - efficiency).abs() < 5e-4, "{wheels}: {all:?}");
        o.solutions.iter().for_each(balances);
    }
}

#[test]
fn val_output_coupled_tractor_drive() {
    let train = read(
        "format = 1\nname = \"tractor\"\nmembers = [\"engine\", \"pump_ring\", \"pump\", \"motor\", \"sun\", \"output\"]\n\
         terminals = [\"engine\", \"output\"]\n[[set]]\nname = \"P1\"\nsun = { member = \"sun\", teeth = 27 }\n\
         ring = { member = \"pump_ring\", teeth = 81 }\ncarrier = \"engine\"\nmesh_efficiency = 0.99\n\
         [[mesh]]\ngears = [{ member = \"pump_ring\", teeth = 81 }, { member = \"pump\", teeth = 40 }]\nefficiency = 0.99\n\
         [[mesh]]\ngears = [{ member = \"motor\", teeth = 30 }, { member = \"output\", teeth = 45 }]\nefficiency = 0.99\n\
         [[mesh]]\ngears = [{ member = \"sun\", teeth = 40 }, { member = \"output\", teeth = 40 }]\nefficiency = 0.99\n\
         [[variator]]\nname = \"hydrostat\"\nkind = \"hydrostatic\"\nmembers = [\"pump\", \"motor\"]\nefficiency = 0.8\n\
         [[operation]]\nname = \"field\"\nspeeds = { engine = \"1900 rpm\", output = \"1500 rpm\" }\n\
         torques = { engine = \"500 N m\" }\n",
    );
    let a = answer(&train);
    let s = only(&a.operations[0]);
    near("efficiency", s.efficiency.unwrap(), fraction("225966981803/308821012500"));
    near("output", torque(s, "output"), fraction("-225966981803/487612125"));
    let v = s.variators.get("hydrostat").unwrap();
    near("pump", v.machines.get("pump").unwrap().torque_n_m, fraction("7187400/39403"));
    near("motor", v.machines.get("motor").unwrap().torque_n_m, fraction("-862488/2165"));
    balances(s);
}

/// Two machines without a store lose what one path of the product of their efficiencies does.
#[test]
fn two_machines_without_a_store_are_a_path() {
    let bus = "machines = [{ name = \"mg1\", efficiency = { motoring = 0.9, generating = 0.93 } }, \
               { name = \"mg2\", member = \"ring\", efficiency = { motoring = 0.95, generating = 0.88 } }]";
    let path = "members = [\"mg1\", \"ring\"]\nefficiency = { forward = 0.8835, backward = 0.792 }";
    for ring in ["ring = \"500 rpm\"", "ring = \"4000 rpm\"", "mg1 = \"0 rpm\"", "ring = \"-700 rpm\""] {
        let [a, b] = [bus, path].map(|v| answer(&prius(ring, v)));
        let (a, b) = (only(&a.operations[0]), only(&b.operations[0]));
        near(ring, a.efficiency.unwrap(), b.efficiency.unwrap());
        near(ring, torque(a, "ring"), torque(b, "ring"));
        balances(a);
        balances(b);
        let [a, b] = [a, b].map(|s| s.variators.get("path").unwrap());
        near(ring, a.share, b.share);
        near(ring, a.power_w, b.power_w);
    }
}

/// A lossless path changes no torque of the train, and the torques of its machines are those that a train without it
/// needs at these members.
#[test]
fn a_lossless_path_reproduces_the_train_without_it() {
    let with = answer(&prius("ring = \"1500 rpm\"", "members = [\"mg1\", \"ring\"]\nefficiency = 1.0"));
    let s = only(&with.operations[0]);
    let without = answer(&read(&format!(
        "{}[[operation]]\nname = \"o\"\nspeeds = {{ engine = \"2000 rpm\", ring = \"1500 rpm\" }}\n\
         torques = {{ engine = \"100 N m\" }}\n",
        PRIUS.replace("terminals = [", "terminals = [\"mg1\", ")
    )));
    let plain = only(&without.operations[0]);
    let v = s.variators.get("path").unwrap();
    near("mg1", v.machines.get("mg1").unwrap().torque_n_m, torque(plain, "mg1"));
    near("ring", v.machines.get("ring").unwrap().torque_n_m + torque(s, "ring"), torque(plain, "ring"));
    near("loss", s.loss_w, plain.loss_w);
}

/// One machine and a store are a plain terminal.
#[test]
fn a_machine_on_a_store_is_a_terminal() {
    let bus = "machines = [{ name = \"m\", member = \"mg1\", efficiency = 1.0 }]\nstore = \"free\"";
    let with = answer(&prius("ring = \"1500 rpm\"", bus));
    let s = only(&with.operations[0]);
    let v = s.variators.get("path").unwrap();
    let m = v.machines.get("m").unwrap();
    near("mg1", m.torque_n_m, -100.0 * 0.0 + m.torque_n_m);
    assert!(v.store_w.unwrap() < 0.0, "the battery is charged: {v:?}");
    near("store", v.store_w.unwrap(), m.power_w);
    balances(s);
}

/// The store gives what balances the bus; and given that power, the load follows.
#[test]
fn a_free_store_and_a_given_one_agree() {
    let machines =
        "machines = [{ name = \"mg1\", efficiency = 0.92 }, { name = \"mg2\", member = \"ring\", efficiency = 0.94 }]";
    let text = |store: &str, torques: &str| {
        format!(
            "{PRIUS}[[variator]]\nname = \"path\"\n{machines}\n[[operation]]\nname = \"o\"\n\
             speeds = {{ engine = \"2000 rpm\", ring = \"1500 rpm\" }}\ntorques = {{ {torques} }}\nstore = {store}\n"
        )
    };
    let a = answer(&read(&text("\"free\"", "engine = \"100 N m\", ring = \"-200 N m\"")));
    let s = only(&a.operations[0]);
    let store = s.variators.get("path").unwrap().store_w.unwrap();
    assert!(store > 0.0);
    balances(s);
    for store in [format!("\"{store} W\""), format!("{{ path = \"{store} W\" }}")] {
        let b = answer(&read(&text(&store, "engine = \"100 N m\"")));
        assert!((torque(only(&b.operations[0]), "ring") + 200.0).abs() < 1e-9);
    }
    // The torque of a machine may be prescribed as well.
    let mg2 = s.variators.get("path").unwrap().machines.get("mg2").unwrap().torque_n_m;
    let c = answer(&read(&text("\"free\"", &format!("engine = \"100 N m\", mg2 = \"{mg2} N m\""))));
    let c = only(&c.operations[0]);
    assert!((torque(c, "ring") + 200.0).abs() < 1e-9, "{}", torque(c, "ring"));
    assert!((c.variators.get("path").unwrap().store_w.unwrap() - store).abs() < 1e-7);
    balances(c);
}

fn with_map(map: &str, machine: &str) -> Result<Train, Diagnostics> {
    let text = format!(
        "{PRIUS}[[variator]]\nname = \"path\"\nmachines = [{{ name = \"mg1\", efficiency = {{ map = \"mg1.csv\" }}{machine} }}, \
         {{ name = \"mg2\", member = \"ring\", efficiency = 0.94 }}]\nstandby = \"200 W\"\n[[operation]]\nname = \"o\"\n\
         speeds = {{ engine = \"2000 rpm\", ring = \"1500 rpm\" }}\ntorques = {{ engine = \"100 N m\" }}\n"
    );
    let reading = Train::read_toml_with(&text, &mut |_| Ok(map.to_owned()));
    reading.train.ok_or(reading.diagnostics)
}

#[test]
fn a_map_is_read_where_the_machine_runs() {
    // η = 0.8 + 0.001 T, whatever the speed; mg1 generates with 27.1755 N m at 3300 rpm.
    let map = "speed [rpm],torque [N m],efficiency\n0,0,0.8\n0,100,0.9\n6000,0,0.8\n6000,100,0.9\n";
    let a = answer(&with_map(map, "").unwrap());
    let s = only(&a.operations[0]);
    let v = s.variators.get("path").unwrap();
    let (mg1, mg2) = (v.machines.get("mg1").unwrap(), v.machines.get("mg2").unwrap());
    let t = 3_880_900.0 / 142_809.0;
    assert!((mg1.torque_n_m + t).abs() < 1e-9);
    let eta = 0.8 + 0.001 * t;
    assert!((mg1.efficiency.unwrap() - eta).abs() < 1e-12);
    let expected = (-mg1.power_w * eta - 200.0) * 0.94;
    assert!((mg2.power_w - expected).abs() < 1e-6 * expected, "{} {expected}", mg2.power_w);
    assert!(s.convergence.unwrap().converged);
    assert!((s.losses_w.variator - v.loss_w).abs() < 1e-9 * v.loss_w, "{:?}", s.losses_w);
    assert!((s.losses_w.mesh + s.losses_w.variator - s.loss_w).abs() < 1e-9 * s.loss_w);
    balances(s);
    // Beyond the map its edge is taken, and that is said.
    let a = answer(
        &with_map("speed [rpm],torque [N m],efficiency\n0,0,0.8\n0,10,0.9\n6000,0,0.8\n6000,10,0.9\n", "").unwrap(),
    );
    assert!(a.diagnostics.iter().any(|d| d.code == Code::OutsideMap), "{:?}", a.diagnostics);
}

#[test]
fn a_map_with_holes_and_other_faults_are_told() {
    let head = "speed [rpm],torque [N m],efficiency\n";
    for (map, told) in [
        (format!("{head}0,0,0.8\n0,100,0.9\n6000,0,0.8\n"), "the map has holes"),
        (format!("{head}0,0,0.8\n0,0,0.9\n"), "same speed and torque"),
        (format!("{head}0,0,1.8\n"), "line 2: an efficiency is above 0"),
        (format!("{head}-1,0,0.8\n"), "line 2: a speed is an amount"),
        (format!("{head}x,0,0.8\n"), "line 2: a cell is no finite number"),
        (head.to_owned(), "no row below the header"),
        (String::new(), "the file is empty"),
        ("speed,torque [N m],efficiency\n".into(), "has no unit"),
        ("speed [kg],torque [N m],eta\n1,2,3".into(), "there is no column `efficiency`"),
    ] {
        let wrong = with_map(&map, "").unwrap_err();
        assert!(wrong.iter().any(|d| d.code == Code::BadTable && d.message.contains(told)), "{map:?}: {wrong}");
    }
}

#[test]
fn limits_are_told_with_their_excess_and_the_answer_stands() {
    let map = "speed [rpm],torque [N m],efficiency\n0,0,0.9\n";
    let a = answer(&with_map(map, ", torque = \"20 N m\", power = \"5 kW\", speed = \"3000 rpm\"").unwrap());
    let s = only(&a.operations[0]);
    let quantities: Vec<_> = s.beyond_limits.iter().map(|b| b.quantity).collect();
    assert_eq!(quantities, [LimitedQuantity::Torque, LimitedQuantity::Power, LimitedQuantity::Speed]);
    let told: Vec<&str> =
        a.diagnostics.iter().filter(|d| d.code == Code::BeyondLimit).map(|d| d.message.as_str()).collect();
    assert_eq!(told.len(), 3, "{told:?}");
    assert!(told[2].contains("3300.0000 rpm, 10.0 % above its limit of 3000.0000 rpm"), "{told:?}");

    let path = "members = [\"mg1\", \"ring\"]\nefficiency = 0.85\nratio = { min = 0.5, max = 2 }";
    let a = answer(&prius("ring = \"1500 rpm\"", path));
    let [beyond] = &only(&a.operations[0]).beyond_limits[..] else { panic!() };
    assert_eq!((beyond.quantity, beyond.limit), (LimitedQuantity::Ratio, 2.0));
    near("ratio", beyond.value, 2.2);
}

#[test]
fn both_sides_at_rest_are_said_to_couple_nothing() {
    let train = read(&format!(
        "{PRIUS}[[variator]]\nname = \"path\"\nmembers = [\"mg1\", \"ring\"]\nefficiency = 0.9\n[[operation]]\nname = \"o\"\n\
         speeds = {{ mg1 = \"0 rpm\", ring = \"0 rpm\" }}\ntorques = {{ engine = \"100 N m\" }}\n"
    ));
    let wrong = analyze(&train, &Selection::default()).unwrap_err();
    assert!(wrong.to_string().contains("path passes no power"), "{wrong}");
}

/// With the wheels held by the electric path alone there is nowhere for the power of the engine to go.
#[test]
fn the_receiving_side_at_rest_takes_no_power() {
    let a = answer(&prius("ring = \"0 rpm\"", "members = [\"mg1\", \"ring\"]\nefficiency = 0.9"));
    let o = &a.operations[0];
    assert_eq!(o.verdict, Verdict::Undetermined);
    assert!(o.reason.as_ref().unwrap().contains("ring stands still"), "{:?}", o.reason);
}

#[test]
fn what_cannot_be_built_is_refused() {
    for (variator, told) in [
        ("members = [\"mg1\", \"mg1\"]\nefficiency = 0.9", "passes nothing on"),
        ("members = [\"mg1\", \"ring\", \"engine\"]\nefficiency = 0.9", "here are 3"),
        ("members = [\"mg1\"]\nefficiency = 0.9", "here is one"),
        ("efficiency = 0.9", "here is neither"),
        ("members = [\"mg1\", \"ring\"]\nefficiency = 1.2", "an efficiency of 1.2"),
        ("members = [\"mg1\", \"rong\"]\nefficiency = 0.9", "there is no member `rong`"),
        ("members = [\"mg1\", \"frame\"]\nefficiency = 0.9", "the frame is at rest"),
        ("members = [\"mg1\", \"ring\"]\nratio = { min = 2, max = 1 }", "the least ratio is 2"),
        ("members = [\"mg1\", \"ring\"]\nstore = \"5 kW\"", "`store` belongs to a bus"),
        ("machines = [{ name = \"a\", member = \"mg1\" }]", "one machine on a bus without a store"),
        ("machines = [{ name = \"a\", member = \"mg1\" }, { name = \"a\", member = \"ring\" }]", "a second machine"),
        (
            "members = [\"mg1\", \"ring\"]\nmachines = [{ name = \"mg1\" }, { name = \"ring\" }]",
            "describes a variator as a whole",
        ),
        ("machines = [{ name = \"mg1\", torque = \"-5 N m\" }, { name = \"ring\" }]", "a limit of -5"),
        ("kind = \"magic\"\nmembers = [\"mg1\", \"ring\"]", "not a known `kind`"),
    ] {
        let wrong = Train::from_toml(&format!("{PRIUS}[[variator]]\nname = \"path\"\n{variator}\n")).unwrap_err();
        assert!(wrong.to_string().contains(told), "{variator}: {wrong}");
    }
}

/// Derivatives by every quantity of train and operation are difference quotients.
#[test]
fn derivatives_with_a_variator_are_difference_quotients() {
    let bus = "machines = [{ name = \"MG1\", member = \"mg1\", efficiency = { motoring = 0.9, generating = 0.93 } }, \
               { name = \"MG2\", member = \"ring\", efficiency = 0.95 }]\nstore = \"3 kW\"";
    let path = "members = [\"mg1\", \"ring\"]\nefficiency = { forward = 0.85, backward = 0.8 }";
    let map = "machines = [{ name = \"MG1\", member = \"mg1\", efficiency = { map = \"m.csv\" } }, \
               { name = \"MG2\", member = \"ring\", efficiency = 0.94 }]\nstandby = \"200 W\"";
    let table = "speed [rpm],torque [N m],efficiency\n0,0,0.8\n0,100,0.9\n6000,0,0.85\n6000,100,0.93\n";
    let mut compared = 0;
    for (variator, ring) in [(bus, 1500), (bus, 3500), (path, 1500), (path, 3500), (map, 1500)] {
        let text = format!(
            "{PRIUS}[[variator]]\nname = \"path\"\n{variator}\n[[operation]]\nname = \"o\"\n\
             speeds = {{ engine = \"2000 rpm\", ring = \"{ring} rpm\" }}\ntorques = {{ engine = \"100 N m\" }}\n"
        );
        let read = |text: &str| Train::read_toml_with(text, &mut |_| Ok(table.to_owned())).train.expect("a train");
        let all = sensitivity(&read(&text), &Selection::default()).unwrap();
        let o = &all.operations[0];
        assert!(o.reason.is_none() && o.without_derivative.is_empty(), "{:?} {:?}", o.reason, o.without_derivative);
        let document = Document::parse(&text).unwrap();
        let loss = |path: &str, value: f64, unit: &str| {
            let mut document = document.clone();
            let path = match path.rsplit_once('.') {
                Some((member, what @ ("speed" | "torque"))) => format!("operation.o.{what}s.{member}"),
                _ => path.to_owned(),
            };
            let key = document.find(&path).unwrap_or_else(|d| panic!("{path}: {}", d.message));
            let value = if unit == "-" { format!("{value}") } else { format!("{value} {unit}") };
            document.set(&key, &value).unwrap();
            answer(&read(&document.text())).operations[0].solutions[0].loss_w
        };
        for q in &o.quantities {
            // Once in each direction, so that a curve leaves little.
            let step = 1e-5 * q.value.abs();
            let unit = q.unit.as_str();
            let quotient = (loss(&q.name, q.value + step, unit) - loss(&q.name, q.value - step, unit)) / (2.0 * step);
            let size = quotient.abs().max(1e-6 * o.loss_w / q.value.abs());
            assert!(
                (q.loss_derivative_w - quotient).abs() < 1e-5 * size,
                "{}: {} {quotient}",
                q.name,
                q.loss_derivative_w
            );
            compared += 1;
        }
        let sum: f64 = o.checks.map_or(0.0, |c| c.balance_residual);
        assert!(sum < 1e-9, "{sum}");
    }
    assert!(compared >= 25, "{compared}");
}

/// The ratio is an axis: the output follows the input, and what is held is the power of the engine.
#[test]
fn the_ratio_is_an_axis() {
    let train = format!(
        "{PRIUS}[[variator]]\nname = \"path\"\nmembers = [\"mg1\", \"ring\"]\nefficiency = 0.85\n[[operation]]\n\
         name = \"o\"\nspeeds = {{ engine = \"2000 rpm\", ring = \"1500 rpm\" }}\ntorques = {{ engine = \"100 N m\" }}\n"
    );
    let model = Model::from_toml(&train).unwrap();
    let question = PointSetup::new(&model, None, None, Hold::Power).unwrap();
    let axis = Axis::parse("ratio=0.5,1,4", &model).unwrap();
    let sweep =
        Sweep::new(question, vec![axis], &["variators".into(), "ratio".into(), "ring.speed_rpm".into()]).unwrap();
    let names: Vec<&str> = sweep.columns().map(|c| c.name.as_str()).collect();
    for name in ["path.share", "path.power_w", "path.mg1.torque_n_m", "variator_loss_w", "ring.speed_rpm"] {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    let mut trains = Default::default();
    for (k, ratio) in [0.5, 1.0, 4.0].into_iter().enumerate() {
        let answer = sweep.answer(k as u64, &mut trains);
        assert_eq!(answer.ratio, Some(ratio));
        let s = answer.solution.unwrap();
        let speed = |m: &str| s.members.get(m).unwrap().speed_rad_s.unwrap();
        near("engine", speed("engine"), 2000.0 * std::f64::consts::PI / 30.0);
        near("ring", speed("ring"), speed("engine") / ratio);
        balances(&s);
    }
    // What the gears tie needs no operating point.
    let plain = Model::from_toml(
        "format = 1\nname = \"r\"\nmembers = [\"s\", \"c\"]\nterminals = [\"s\", \"c\"]\n[[set]]\nname = \"P1\"\n\
         sun = { member = \"s\", teeth = 30 }\nring = { member = \"frame\", teeth = 70 }\ncarrier = \"c\"\n",
    )
    .unwrap();
    let axis = Axis::parse("P1.ring.teeth=60,70,90", &plain).unwrap();
    let question = PointSetup::new(&plain, None, None, Hold::AsGiven).unwrap();
    let sweep = Sweep::new(question, vec![axis], &["ratio".into()]).unwrap();
    let found: Vec<f64> = (0..3).map(|k| sweep.answer(k, &mut Default::default()).ratio.unwrap()).collect();
    found.iter().zip([3.0, 10.0 / 3.0, 4.0]).for_each(|(a, b)| near("teeth", *a, b));
}

/// A variator is left out of nothing without a word.
#[test]
fn what_does_not_know_variators_says_so() {
    let train = prius("ring = \"1500 rpm\"", "members = [\"mg1\", \"ring\"]\nefficiency = 0.9");
    let wrong = train
        .compile(&CompileRequest::new(["engine", "ring"], ["engine"]).output(CompiledOutput::Efficiency))
        .unwrap_err();
    assert!(wrong.to_string().contains("variator"), "{wrong}");
}

/// A terminal on a member that has another name, and terminals that a clutch joins, stay torques of their own.
#[test]
fn several_machines_on_one_shaft_stay_apart() {
    let train = read(&format!(
        "{}[[operation]]\nname = \"o\"\nspeeds = {{ engine = \"2000 rpm\", ring = \"1500 rpm\" }}\n\
         torques = {{ engine = \"100 N m\", mg2 = \"50 N m\" }}\n",
        PRIUS.replace(
            "terminals = [\"engine\", \"ring\"]",
            "terminals = [\"mg1\", \"engine\", { name = \"mg2\", member = \"ring\" }, \"ring\"]"
        )
    ));
    let a = answer(&train);
    let s = only(&a.operations[0]);
    near("mg2", torque(s, "mg2"), 50.0);
    let plain = answer(&read(&format!(
        "{}[[operation]]\nname = \"o\"\nspeeds = {{ engine = \"2000 rpm\", ring = \"1500 rpm\" }}\n\
         torques = {{ engine = \"100 N m\" }}\n",
        PRIUS.replace("terminals = [", "terminals = [\"mg1\", ")
    )));
    near("ring", torque(s, "ring") + 50.0, torque(only(&plain.operations[0]), "ring"));
    let mg2 = s.members.get("mg2").unwrap();
    assert_eq!(mg2.role, Role::Input);
    near("speed", mg2.speed_rad_s.unwrap(), s.members.get("ring").unwrap().speed_rad_s.unwrap());
    balances(s);
}
