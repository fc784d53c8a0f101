//! Duty cycles and load spectra: energies by hand, the same numbers as the analysis, every mistake told.

use willis::analysis::{Selection, analyze};
use willis::model::Model;
use willis::study::{Basis, ColumnValues, Cycle, CycleReport, CycleRequest, Hold, PointSetup, Profile, cycle};
use willis::work::{Serial, Work};
use willis::{Diagnostics, Train};

use crate::common::example;

/// One set, ring held: i = 10/3.
const REDUCER: &str = r#"
    format = 1
    name = "reducer"
    members = ["s", "c"]
    terminals = ["s", "c"]
    [[set]]
    name = "P1"
    sun = { member = "s", teeth = 30 }
    planet = { teeth = 20, count = 4 }
    ring = { member = "frame", teeth = 70 }
    carrier = "c"
    mesh_efficiency = 0.99
"#;

/// Basic efficiency: two meshes.
const ETA_0: f64 = 0.99 * 0.99;

/// (1 − i0 η0)/(1 − i0) with i0 = −7/3.
fn driving() -> f64 {
    (1.0 + 7.0 / 3.0 * ETA_0) / (1.0 + 7.0 / 3.0)
}

/// (1 − i0)/(1 − i0/η0)
fn coasting() -> f64 {
    (1.0 + 7.0 / 3.0) / (1.0 + 7.0 / 3.0 / ETA_0)
}

fn subject(text: &str) -> Model {
    Model::from_toml(text).unwrap_or_else(|r| panic!("{r}"))
}

fn question(subject: &Model) -> PointSetup<'_> {
    PointSetup::new(subject, None, None, Hold::AsGiven).unwrap()
}

fn report(train: &str, profile: &str) -> CycleReport {
    let subject = subject(train);
    let profile = Profile::parse(profile, &subject).unwrap_or_else(|e| panic!("{e}"));
    Cycle::new(question(&subject), &profile).run(&Serial).unwrap_or_else(|e| panic!("{e}")).report
}

fn wrong(train: &str, profile: &str) -> Diagnostics {
    Profile::parse(profile, &subject(train)).expect_err("it is wrong")
}

fn near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs().max(1e-300), "{a} is not {b}");
}

#[test]
fn energies_are_those_computed_by_hand() {
    // One hour 5 kW, three hours 1 kW, half an hour in which 2 kW arrive at the input from the output.
    let r = report(REDUCER, "hours,input.speed [rad/s],input.torque [N m]\n1,100,50\n3,100,10\n0.5,100,-20\n");
    assert_eq!((r.basis, r.rows, r.conditions, r.time_s), (Basis::Durations, 3, 3, 4.5 * 3600.0));
    let forward = (5000.0 + 3.0 * 1000.0) * 3600.0;
    let back = 0.5 * 2000.0 * 3600.0;
    near(r.energy_in_j, forward + back / coasting(), 1e-14);
    near(r.energy_out_j, forward * driving() + back, 1e-14);
    near(r.efficiency.unwrap(), r.energy_out_j / r.energy_in_j, 1e-15);
    near(r.time_mean_efficiency.unwrap(), (4.0 * driving() + 0.5 * coasting()) / 4.5, 1e-14);
    near(r.energy_lost_j, r.energy_in_j - r.energy_out_j, 1e-11);
    assert!(r.energy_residual_j.abs() < 1e-12 * r.energy_in_j, "{}", r.energy_residual_j);
    let by_source: f64 = r.sources.iter().map(|s| s.energy_j).sum();
    near(by_source, r.energy_lost_j, 1e-13);
    near(r.losses_j.get("mesh").copied().unwrap(), r.energy_lost_j, 1e-13);
    let (drive, coast) = (r.ways.get("driving").unwrap(), r.ways.get("coasting").unwrap());
    assert_eq!((drive.rows, coast.rows), (2, 1));
    near(drive.efficiency.unwrap(), driving(), 1e-14);
    near(coast.efficiency.unwrap(), coasting(), 1e-14);
    // The sun takes in what drives and gives back what is recuperated.
    let sun = r.terminals.get("s").unwrap();
    near(sun.energy_in_j, forward, 1e-14);
    near(sun.energy_out_j, back, 1e-14);
    assert_eq!((r.coverage, r.verdicts.get("unique").unwrap().rows), (1.0, 3));
    // The most energy is lost where 5 kW run for an hour, in line 2.
    assert_eq!((r.worst.energy[0].line, r.worst.loss[0].line, r.worst.efficiency[0].line), (2, 2, 4));
}

#[test]
fn a_spectrum_and_the_equivalent_trace_give_the_same() {
    let spectrum =
        report(REDUCER, "duration [s],input.speed [rpm],input.torque [N m]\n2,1000,10\n3,1500,20\n5,900,-5\n");
    // 1000 rpm from 0 to 1 and from 4 to 5, 1500 rpm from 1 to 4, 900 rpm from 5 to 10.
    let text = "# a trace\ntime [s],input.speed [rpm],input.torque [N m]\n0,1000,10\n1,1500,20\n\n4,1000,10\n5,900,-5\n10,0,0\n";
    let trace = report(REDUCER, text);
    assert_eq!((trace.basis, trace.rows, trace.conditions), (Basis::Trace, 4, 3));
    let shares = report(REDUCER, "share [%],input.speed [rpm],input.torque [N m]\n20,1000,10\n30,1500,20\n50,900,-5\n");
    assert_eq!(shares.time_s, 3600.0);
    for (what, a, b, c) in [
        ("in", spectrum.energy_in_j, trace.energy_in_j, shares.energy_in_j),
        ("out", spectrum.energy_out_j, trace.energy_out_j, shares.energy_out_j),
        ("lost", spectrum.energy_lost_j, trace.energy_lost_j, shares.energy_lost_j),
    ] {
        assert_eq!(a, b, "{what}");
        near(c, a * 360.0, 1e-14);
    }
    assert_eq!(spectrum.efficiency, trace.efficiency);
    assert_eq!(spectrum.ways, {
        let mut ways = trace.ways;
        // The same time in one row more.
        ways.0[0].1.rows -= 1;
        ways
    });
    near(shares.efficiency.unwrap(), trace.efficiency.unwrap(), 1e-15);
}

#[test]
fn a_row_is_the_analysis_of_its_point_bit_for_bit() {
    let file = example("nrel-5mw-stage-1.toml");
    let subject = subject(&file);
    let spectrum =
        "hours,carrier.speed [rpm],input.power [kW],oil.temperature [degC]\n7,12.1,5000,75\n5,8.3,1234.5,61\n";
    let profile = Profile::parse(spectrum, &subject).unwrap();
    let rows = Cycle::new(question(&subject), &profile).run(&Serial).unwrap().rows;
    let at = |name: &str, row: usize| match rows.get(name) {
        Some(ColumnValues::Numbers(all)) => all[row],
        other => panic!("{name}: {other:?}"),
    };
    for (row, (speed, power, oil)) in [("12.1", "5000", "75"), ("8.3", "1234.5", "61")].into_iter().enumerate() {
        let text = file
            .replace("carrier = \"12.1 rpm\"", &format!("carrier = \"{speed} rpm\""))
            .replace("carrier = \"5 MW\"", &format!("carrier = \"{power} kW\""))
            .replace("temperature = \"75 degC\"", &format!("temperature = \"{oil} degC\""));
        let analysis = analyze(&Train::from_toml(&text).unwrap(), &Selection::default()).unwrap();
        let s = &analysis.operations[0].solutions[0];
        assert_eq!(at("efficiency", row).to_bits(), s.efficiency.unwrap().to_bits());
        for (a, b) in [
            (at("loss_w", row), s.loss_w),
            (at("input_power_w", row), s.input_power_w),
            (at("output_power_w", row), s.output_power_w),
        ] {
            assert_eq!(a.to_bits(), b.to_bits());
        }
    }
}

#[test]
fn named_sources_add_to_the_loss_and_to_the_kinds() {
    let r = report(&example("nrel-5mw-stage-1.toml"), &example("spectrum-nrel-5mw.csv"));
    assert!(r.sources.iter().any(|s| s.law != "given"));
    near(r.sources.iter().map(|s| s.energy_j).sum(), r.energy_lost_j, 1e-12);
    near(r.losses_j.iter().map(|k| k.1).sum(), r.energy_lost_j, 1e-12);
    near(r.energy_in_j - r.energy_out_j, r.energy_lost_j, 1e-9);
    // The year without the hours above 25 m/s.
    assert!((8700.0..8760.0).contains(&(r.time_s / 3600.0)), "{}", r.time_s / 3600.0);
    assert_eq!(r.coverage, 1.0);
}

#[test]
fn states_are_told_apart() {
    let r = report(&example("zf-8hp70.toml"), &example("cycle-8hp70.csv"));
    assert_eq!(r.operation.as_deref(), Some("full-load launch"));
    assert!(r.held.is_empty(), "{:?}", r.held);
    let time: f64 = r.states.iter().map(|s| s.1.time_s).sum();
    near(time, r.covered_s, 1e-13);
    let lost: f64 = r.states.iter().map(|s| s.1.energy_lost_j).sum();
    near(lost, r.energy_lost_j, 1e-13);
    assert!(r.states.iter().count() == 8 && r.ways.get("coasting").is_some());
}

#[test]
fn what_no_column_sets_is_held_and_told() {
    let held = report(&example("zf-8hp70.toml"), "hours,input.speed [rpm]\n1,1500\n").held;
    assert_eq!(held, ["state 1", "torque on input 500 N m"]);
}

#[test]
fn locked_and_refused_rows_are_told_with_their_time_and_reason() {
    // The ring of a self-locking train cannot turn its sun: both must push.
    let train = example("wolfrom-498-self-locking.toml");
    let r = report(&train, "hours,input.speed [rpm],output.torque [N m]\n1,1000,50\n3,1000,-50\n2,1000,-40\n");
    let locked = r.verdicts.get("locked").unwrap();
    assert_eq!((locked.rows, locked.time_s, locked.share_of_time), (2, 5.0 * 3600.0, 5.0 / 6.0));
    assert_eq!((locked.reasons.len(), locked.reasons[0].line, locked.reasons[0].rows), (1, 3, 2));
    assert!(locked.reasons[0].message.contains("friction locks the train"), "{:?}", locked.reasons);
    assert_eq!((r.covered_s, r.coverage), (3600.0, 1.0 / 6.0));
    assert_eq!(r.ways.iter().map(|w| w.1.rows).sum::<u64>(), 1);

    // Two speeds that the gears tie together.
    let r = report(REDUCER, "hours,s.speed [rpm],c.speed [rpm],input.torque [N m]\n1,1000,300,5\n2,1000,200,5\n");
    let refused = r.verdicts.get("refused").unwrap();
    assert_eq!((refused.rows, refused.reasons[0].line), (1, 3), "{refused:?}");
    assert!(refused.reasons[0].message.starts_with("the gears tie s, c together"), "{refused:?}");
    near(r.energy_in_j, 1000.0 * std::f64::consts::PI / 30.0 * 5.0 * 3600.0, 1e-12);
}

#[test]
fn a_stop_costs_nothing_and_is_no_gap() {
    let r = report(REDUCER, "duration [s],input.speed [rpm],input.torque [N m]\n10,0,0\n10,1000,5\n");
    assert_eq!(r.coverage, 1.0);
    assert_eq!(r.ways.get("idle").unwrap().time_s, 10.0);
}

/// Work that does its parts from the last to the first.
struct Backwards;

impl Work for Backwards {
    fn run(&self, parts: usize, job: &(dyn Fn(usize) + Sync)) {
        (0..parts).rev().for_each(job);
    }
}

#[test]
fn parts_give_the_same_in_any_order() {
    let subject = subject(REDUCER);
    let mut text = "time [s],input.speed [rpm],input.torque [N m]\n".to_owned();
    (0..1000).for_each(|k| text += &format!("{k},{},{}\n", 500 + 7 * (k % 300), (k % 211) - 50));
    let request = CycleRequest { profile: text, ..CycleRequest::default() };
    let whole = cycle(&subject, &request, &Serial).unwrap();
    let other = cycle(&subject, &request, &Backwards).unwrap();
    // As written: a row without a value has none in both.
    assert_eq!(format!("{:?}", other.rows), format!("{:?}", whole.rows));
    assert_eq!(other.report, whole.report);
    let whole = whole.report;
    assert_eq!(whole.rows, 999);
}

#[test]
fn headers_are_read_in_every_spelling() {
    let subject = subject(&example("nrel-5mw-stage-1.toml"));
    for header in [
        "time [s],carrier.speed [rpm],output.torque [N m],oil.temperature [degC]",
        "time_s,carrier.speed_rpm,output.torque_n_m,oil.temperature_degc",
        "\u{feff}time (s), carrier.speed (rpm), \"output.torque [N m]\", temperature_degC",
    ] {
        let text = format!("# made\r\n\r\n{header}\r\n0,10,1e3,60\r\n1.5,+11,-2,61\r\n2,0,0,61\r\n");
        let text = match text.replace('\u{feff}', "") {
            plain if header.starts_with('\u{feff}') => format!("\u{feff}{plain}"),
            plain => plain,
        };
        let profile = Profile::parse(&text, &subject).unwrap_or_else(|e| panic!("{header}: {e}"));
        assert_eq!(profile.rows().iter().map(|r| r.duration_s).collect::<Vec<_>>(), [1.5, 0.5]);
        assert_eq!(profile.rows()[1].line, 5);
        let second = profile.describe(1);
        assert!(second.starts_with("carrier.speed = 11 rpm, output.torque = -2 N m, "), "{second}");
    }
}

#[test]
fn remarkable_profiles_carry_notes() {
    let mut text = "time [s],input.speed [rpm],input.torque [N m]\n".to_owned();
    (0..20).for_each(|k| text += &format!("{},1000,{}\n", if k > 11 { k + 500 } else { k }, k + 1));
    let r = report(REDUCER, &text);
    assert_eq!(r.notes, ["line 13 holds for 501 s, where the usual step is 1 s: the trace may have a gap there"]);
    let r = report(REDUCER, "share,input.speed [rpm],input.torque [N m]\n0.2,1000,5\n0.2,1000,6\n");
    assert_eq!(r.notes, ["the shares add to 0.4; they are taken as parts of that"]);
    assert_eq!(r.time_s, 3600.0);
}

/// Every mistake, with what is said of it.
#[test]
fn every_mistake_is_told_with_its_line_and_column() {
    let eight = example("zf-8hp70.toml");
    let good = "input.speed [rpm],input.torque [N m]";
    for (train, text, expected) in [
        (REDUCER, String::new(), "the profile is empty"),
        (REDUCER, "# only a comment\n".into(), "the profile is empty"),
        (REDUCER, format!("{good}\n1000,5\n"), "no column weighs the rows in time (at line 1)"),
        (REDUCER, "time [s]\n0\n1\n".into(), "no column sets a quantity"),
        (REDUCER, format!("time [s],{good}\n"), "there is no row below the header"),
        (REDUCER, format!("time [s],{good}\n0,1000,5\n"), "the profile lasts no time; a trace has a second row"),
        (REDUCER, format!("hours,{good}\n0,1000,5\n"), "the profile lasts no time"),
        (
            REDUCER,
            format!("hours,time [s],{good}\n1,0,1000,5\n"),
            "`hours` and `time [s]` both weigh the rows (at line 1, column 2)",
        ),
        (
            REDUCER,
            format!("time,{good}\n0,1000,5\n1,0,0\n"),
            "`time` has no unit; write `time [s]` (at line 1, column 1)",
        ),
        (REDUCER, format!("time [rpm],{good}\n0,1000,5\n1,0,0\n"), "`rpm` is no unit of time"),
        (REDUCER, format!("share [kg],{good}\n0,1000,5\n"), "`kg` is no unit of a share"),
        (
            REDUCER,
            "hours,input.sped [rpm]\n1,1000\n".into(),
            "there is no quantity `input.sped` to set (at line 1, column 2); did you mean `input.speed`?",
        ),
        (
            REDUCER,
            "hours,input.speed [N m]\n1,1000\n".into(),
            "the unit `N m` is not that of an angular speed: `N m` measures a torque (at line 1, column 2); write `input.speed [rpm]`",
        ),
        (REDUCER, "hours,input.speed [rpn]\n1,1000\n".into(), "`rpn` is not a unit known here"),
        (
            REDUCER,
            "hours,input.speed\n1,1000\n".into(),
            "`input.speed` has no unit (at line 1, column 2); write it in the header: `input.speed [rpm]`",
        ),
        (REDUCER, "hours,input.speed_nm\n1,1000\n".into(), "`nm` is not the unit of an angular speed"),
        (REDUCER, "hours,input.speed [rpm],\n1,1000,5\n".into(), "the column has no name"),
        (REDUCER, "hours,input.speed [rpm],input.speed [rad/s]\n1,1000,5\n".into(), "set the same quantity"),
        (REDUCER, "hours;input.speed [rpm]\n1;1.000,5\n".into(), "has marks between its digits"),
        (REDUCER, ",".repeat(100_000), "the header has 100001 columns; a table has at most 4096"),
        (REDUCER, "hours,state\n1,3\n".into(), "`state` cannot be varied: the train has no shift table"),
        (REDUCER, "hours,oil.temperature [degC]\n1,3\n".into(), "there is no oil"),
        (
            REDUCER,
            format!("hours,{good}\n1,1000,5\n1,,5\n"),
            "the cell is empty (at line 3, column `input.speed [rpm]`)",
        ),
        (
            REDUCER,
            format!("hours,{good}\n1,1000,5\n1,1000,NaN\n"),
            "`NaN` is no finite number (at line 3, column `input.torque [N m]`)",
        ),
        (REDUCER, format!("hours,{good}\n1,1000,inf\n"), "`inf` is no finite number"),
        (
            REDUCER,
            format!("hours,{good}\n1,1000 rpm,5\n"),
            "`1000 rpm` is no finite number (at line 2, column `input.speed [rpm]`)",
        ),
        (REDUCER, format!("hours,{good}\n1,1000\n"), "line 2 has 2 cells, the header has 3"),
        (REDUCER, format!("hours,{good}\n1,\"1000\",5,7\n"), "line 2 has 4 cells, the header has 3"),
        (
            REDUCER,
            format!("hours,{good}\n-1,1000,5\n"),
            "`-1` is below zero, and this weighs a row (at line 2, column `hours`)",
        ),
        (
            REDUCER,
            format!("time [s],{good}\n0,1000,5\n2,1000,5\n# note\n1,1000,5\n"),
            "the time falls: 1 s here, 2 s in line 3 (at line 5, column `time [s]`)",
        ),
        (
            REDUCER,
            format!("time [s],{good}\n0,1000,5\n0,1000,6\n1,1000,5\n"),
            "the time does not rise: 0 s here, 0 s in line 2",
        ),
        (
            &eight,
            "hours,state,input.speed [rpm]\n1,3,1000\n1,9,1000\n".into(),
            "the train has no state `9` (at line 3, column `state`); its states are: 1, 2, 3, 4, 5, 6, 7, 8, R",
        ),
    ] {
        let told = wrong(train, &text).to_string();
        assert!(told.contains(expected), "{text:?}:\n{told}\nand not: {expected}");
    }
    let oil = wrong(&example("nrel-5mw-stage-1.toml"), "hours,oil.temperature [degC]\n1,-300\n").to_string();
    assert!(oil.contains("an oil temperature of -300.0 °C is none that a gearbox has"), "{oil}");
}

#[test]
fn all_mistakes_are_told_at_once_and_underlined() {
    let text = "time [s],input.sped [rpm],input.torque [N m]\n0,x,5\n1,1000,\n1,1000,nan\n";
    let all = wrong(REDUCER, text);
    // The misspelt column, the empty cell, the number, the time; nothing is said of cells that mean nothing.
    assert_eq!(all.len(), 4, "{all}");
    let underlined: Vec<&str> = all.iter().map(|d| &text[d.span.unwrap().range()]).collect();
    assert_eq!(underlined, ["input.sped [rpm]", "1,1000,", "1", "nan"]);
    let many: String = (0..5000).map(|_| "0,x\n").collect();
    let all = wrong(REDUCER, &format!("hours,input.speed [rpm]\n{many}"));
    assert_eq!(all.len(), 50);
    assert!(all.to_string().ends_with("4951 more errors of these kinds"));
}

/// A measurement as another program wrote it: semicolons, decimal commas, channels that the train does not have.
#[test]
fn a_measurement_is_read_as_it_is() {
    use willis::study::ProfileColumns;
    let plain = "time [s],input.speed [rpm],input.torque [N m]\n0,900.5,10\n1.5,1000,12\n2,0,0\n";
    let measured = "\u{feff}# of Monday\r\ntime [s];vibration;input.speed [rpm];\"note; of a person\";input.torque [N m]\r\n\
                    0;3,1;900,5;x;10\r\n1,5;;1000;;12\r\n2;3;0;y;0\r\n";
    let subject = subject(REDUCER);
    let whole = Profile::parse(plain, &subject).unwrap();
    let wrong = Profile::parse(measured, &subject).unwrap_err().to_string();
    assert!(wrong.contains("no quantity `vibration`") && wrong.contains("`ignore_column`"), "{wrong}");
    let names = |all: &[&str]| all.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
    for columns in [
        ProfileColumns::Without(names(&["vibration", "note; of a person"])),
        ProfileColumns::Only(names(&["time", "input.speed [rpm]", "input.torque"])),
    ] {
        let read = Profile::parse_columns(measured, &subject, &columns).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((read.total_s(), read.conditions()), (whole.total_s(), whole.conditions()));
        for k in 0..read.conditions() {
            assert_eq!(read.describe(k), whole.describe(k));
        }
        assert_eq!(read.notes(), ["columns left out: vibration, note; of a person"]);
    }
    let missing = ProfileColumns::Without(names(&["vibrations"]));
    let wrong = Profile::parse_columns(measured, &subject, &missing).unwrap_err().to_string();
    assert!(wrong.contains("no column `vibrations`") && wrong.contains("did you mean `vibration`"), "{wrong}");
}
