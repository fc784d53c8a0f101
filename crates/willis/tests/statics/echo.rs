//! What an operating point prescribes stands in its answer as it was prescribed, to the last bit.

use willis::analysis::{Role, SolutionReport, operate};
use willis::hypergraph::{NodeKind, hypergraph};
use willis::model::Model;
use willis::regimes::{LocateRequest, locate};
use willis::study::{Axis, ColumnValues, Hold, PointSetup, Sweep, SweepWorkspace, TrainCache};
use willis::train::{Load, MemberId, Operation, Store, Train};
use willis::units::{Dimension, Quantity, parse};

use super::common::{Dice, example, examples, train};

/// A number as people write it, of three to six digits.
fn amount(dice: &mut Dice) -> String {
    let digits = dice.whole(0, 3) as u32;
    let number = dice.whole(100, 99_999) as f64 / 10f64.powi(digits as i32);
    format!("{number}")
}

fn quantity(dice: &mut Dice, units: &[&str], dimension: Dimension, sign: i64) -> Quantity {
    let text = format!("{}{} {}", if sign < 0 { "-" } else { "" }, amount(dice), dice.of(units));
    parse(&text, dimension).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

const TORQUES: [&str; 3] = ["N m", "kN m", "lbf ft"];
const POWERS: [&str; 3] = ["kW", "W", "hp"];
const SPEEDS: [&str; 2] = ["rpm", "rad/s"];

/// The same operating point with other numbers: torques and powers change places now and then.
fn varied(dice: &mut Dice, o: &Operation) -> Operation {
    let mut o = o.clone();
    // Speeds that the gears tie to each other stay as they are.
    if o.speeds.len() == 1 {
        o.speeds[0].1 = quantity(dice, &SPEEDS, Dimension::ANGULAR_SPEED, 1);
    }
    for (_, load) in &mut o.loads {
        let value = match load {
            Load::Torque(q) | Load::Power(q) => q.si(),
        };
        let sign = if value < 0.0 { -1 } else { 1 };
        *load = match dice.below(2) {
            0 => Load::Torque(quantity(dice, &TORQUES, Dimension::TORQUE, sign)),
            _ => Load::Power(quantity(dice, &POWERS, Dimension::POWER, sign)),
        };
    }
    o
}

/// Compares an answer with what was prescribed; returns how many values were.
fn compare(what: &str, train: &Train, o: &Operation, s: &SolutionReport) -> usize {
    let member = |m: MemberId| s.members.get(train.member_name(m)).unwrap();
    let mut compared = 0;
    let mut same = |which: &str, m: MemberId, found: f64, given: f64| {
        let name = train.member_name(m);
        assert!(found == given, "{what}: {which} of {name} is {found:e}, prescribed {given:e}");
        compared += 1;
    };
    for (m, w) in &o.speeds {
        same("speed", *m, member(*m).speed_rad_s.unwrap(), w.si());
    }
    for (m, load) in o.loads.iter().filter(|(m, _)| member(*m).role != Role::Fixed) {
        match load {
            Load::Torque(t) => same("torque", *m, member(*m).torque_n_m.unwrap(), t.si()),
            Load::Power(p) => same("power", *m, member(*m).power_w.unwrap(), p.si()),
        }
    }
    compared
}

/// Every operating point of every example as it stands in its file, then with other numbers; so do its place among the
/// regimes and its power flow.
#[test]
fn prop_what_is_prescribed_is_answered_to_the_last_bit() {
    let mut dice = Dice(7);
    let (mut compared, mut located, mut edges) = (0, 0, 0);
    for (name, text) in examples() {
        let train = Train::from_toml(&text).unwrap();
        let times = if train.bearings().is_empty() && train.lubrication().is_none() { 12 } else { 1 };
        for own in train.operations() {
            for k in 0..times {
                let o = if k == 0 { own.clone() } else { varied(&mut dice, own) };
                let what = format!("{name}, {}, {k}", own.name);
                let Ok((report, _)) = operate(&train, &o) else { continue };
                if report.speed_deviation.is_some() {
                    continue;
                }
                for s in report.solutions.iter().chain(&report.dissipative_solutions) {
                    compared += compare(&what, &train, &o, s);
                    // A power that enters or leaves is that of the answer.
                    let graph = hypergraph(&train, s);
                    for (m, load) in &o.loads {
                        let Load::Power(p) = load else { continue };
                        let end = |n: &&willis::hypergraph::Node| {
                            n.name == train.member_name(*m) && matches!(n.kind, NodeKind::Input | NodeKind::Output)
                        };
                        let Some(end) = graph.nodes.iter().find(end) else { continue };
                        let power = if end.kind == NodeKind::Input { end.power_out_w } else { end.power_in_w };
                        assert!(power == p.si().abs(), "{what}: {power:e} at {}", end.id);
                        edges += 1;
                    }
                }
                if k < 3 {
                    located += place(&what, &train, &o);
                }
            }
        }
    }
    assert!(compared > 1500 && located > 100 && edges > 200, "{compared} values, {located} places, {edges} edges");
}

/// The same of `locate`.
fn place(what: &str, train: &Train, o: &Operation) -> usize {
    let named = |(m, q): &(MemberId, Quantity)| (train.member_name(*m).to_owned(), q.clone());
    let of = |power: bool| {
        let load = o.loads.iter().filter_map(move |(m, load)| match load {
            Load::Torque(q) if !power => Some((*m, q.clone())),
            Load::Power(q) if power => Some((*m, q.clone())),
            _ => None,
        });
        load.map(|x| named(&x)).collect::<Vec<_>>()
    };
    if !o.fixed.is_empty() {
        return 0;
    }
    let request = LocateRequest {
        state: o.state.map(|k| train.states()[k].name.clone()),
        speeds: o.speeds.iter().map(named).collect(),
        torques: of(false),
        powers: of(true),
        ..LocateRequest::default()
    };
    let Ok(found) = locate(train, &request) else { return 0 };
    let mut compared = 0;
    for regime in &found.regimes {
        for (name, q) in &request.torques {
            let Some(t) = regime.torques_n_m.get(name) else { continue };
            assert!(*t == q.si(), "{what}: locate has {t:e} on {name}, prescribed {:e}", q.si());
            compared += 1;
        }
        for (name, q) in &request.powers {
            let Some(p) = regime.powers_w.get(name) else { continue };
            assert!(*p == q.si(), "{what}: locate has {p:e} at {name}, prescribed {:e}", q.si());
            compared += 1;
        }
    }
    for (name, q) in &request.speeds {
        let Some(w) = found.speeds_rad_s.get(name) else { continue };
        assert!(*w == q.si(), "{what}: locate has {w:e} of {name}, prescribed {:e}", q.si());
    }
    compared
}

/// Powers of stores, and torques and powers of machines.
#[test]
fn prop_stores_and_machines_have_what_is_prescribed() {
    let mut dice = Dice(11);
    let mut compared = 0;
    for name in ["prius-hybrid", "voltec", "two-mode-split", "tractor-hydrostat"] {
        let train = train(name);
        for own in train.operations() {
            for _ in 0..30 {
                let mut o = own.clone();
                for (k, v) in train.variators().iter().enumerate() {
                    if v.machines().is_empty() {
                        continue;
                    }
                    let power = quantity(&mut dice, &POWERS, Dimension::POWER, 1);
                    if o.machines.is_empty() {
                        o.stores = vec![(k, Store::Power(power))];
                    } else {
                        for (_, load) in &mut o.machines {
                            *load = match dice.below(2) {
                                0 => Load::Torque(quantity(&mut dice, &TORQUES, Dimension::TORQUE, 1)),
                                _ => Load::Power(quantity(&mut dice, &POWERS, Dimension::POWER, 1)),
                            };
                        }
                    }
                }
                let Ok((report, _)) = operate(&train, &o) else { continue };
                for s in &report.solutions {
                    compared += compare(name, &train, &o, s);
                    for (k, store) in &o.stores {
                        let Store::Power(p) = store else { continue };
                        let found = s.variators.get(&train.variators()[*k].name).unwrap().store_w;
                        assert_eq!(found, Some(p.si()), "{name}: store");
                        compared += 1;
                    }
                    for ([v, m], load) in &o.machines {
                        let v = &train.variators()[*v];
                        let machine = s.variators.get(&v.name).unwrap().machines.get(&v.machines()[*m].name).unwrap();
                        match load {
                            Load::Torque(t) => assert_eq!(machine.torque_n_m, t.si(), "{name}"),
                            Load::Power(p) => assert_eq!(machine.power_w, p.si(), "{name}"),
                        }
                        compared += 1;
                    }
                }
            }
        }
    }
    assert!(compared > 300, "{compared} values");
}

/// An axis of a sweep and the columns of the same quantity are one number, and so it is through the compiled train.
#[test]
fn prop_sweeps_have_the_values_of_their_axes() {
    let mut compared = 0;
    for (name, load) in [("zf-8hp70", "torque=7.3..431 N m:11"), ("zf-8hp70", "power=3.3..97.1 kW:11")] {
        let model = Model::read(&example(name), &mut |path| Err(path.to_owned())).unwrap();
        let input = model.train().member_name(model.train().input().unwrap()).to_owned();
        let over = [format!("{input}.speed=103..6007 rpm:13"), format!("{input}.{load}")];
        let axes: Vec<Axis> = over.iter().map(|text| Axis::parse(text, &model).unwrap()).collect();
        let (unit, column) = match load.starts_with("torque") {
            true => (Dimension::TORQUE, format!("{input}.torque_n_m")),
            false => (Dimension::POWER, format!("{input}.power_w")),
        };
        let columns = [format!("{input}.speed_rad_s"), column.clone(), format!("{input}.speed_rpm")];
        let question = || PointSetup::new(&model, None, None, Hold::AsGiven).unwrap();
        let sweep = Sweep::new(question(), axes.clone(), &columns).unwrap();
        let mut found = vec![sweep.rows(0, sweep.len(), &mut TrainCache::default())];
        let mut names: Vec<Vec<String>> = vec![sweep.columns().map(|c| c.name.clone()).collect()];
        if load.starts_with("torque") {
            let sweep = Sweep::new(question(), axes.clone(), &columns[..2]).unwrap();
            let compiled = sweep.compile().unwrap();
            found.push(compiled.rows(0, sweep.len(), &mut SweepWorkspace::default()));
            names.push(compiled.columns().map(|c| c.name.clone()).collect());
        }
        for (rows, names) in found.iter().zip(&names) {
            let cells = |name: &str| {
                let at = names.iter().position(|n| n == name).unwrap_or_else(|| panic!("{name} of {names:?}"));
                match &rows.columns[at] {
                    ColumnValues::Numbers(all) => all.clone(),
                    _ => panic!("{name} has numbers"),
                }
            };
            let given = |axis: &Axis, dimension| {
                let si = |x: &f64| parse(&format!("{x} {}", axis.unit), dimension).unwrap().si();
                cells(&axis.column()).iter().map(si).collect::<Vec<f64>>()
            };
            assert_eq!(cells(&columns[0]), given(&axes[0], Dimension::ANGULAR_SPEED), "{name} {load}");
            assert_eq!(cells(&column), given(&axes[1], unit), "{name} {load}");
            if names.contains(&columns[2]) {
                assert_eq!(cells(&columns[2]), cells(&axes[0].column()), "{name} {load}");
            }
            compared += cells(&column).len();
        }
    }
    assert_eq!(compared, 3 * 11 * 13);
}
