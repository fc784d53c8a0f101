//! Bad input, odd input and hostile input: each gives diagnostics or a sound analysis. Never a
//! panic, never a number that is none, and all of it in bounded time and memory.

use std::io::{Read, Write};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use proptest::prelude::*;
use serde_json::Value;
use willis::analysis::{Analysis, Selection, Verdict, analyze};
use willis::diagnostic::{Code, Diagnostics};
use willis::exact::Rational;
use willis::statics::Certificate;
use willis::train::Train;

use crate::common::{Dice, examples};

const SET: &str = r#"format = 1
name = "set"
members = ["sun", "ring", "carrier"]
terminals = ["sun", "carrier"]

[[set]]
name = "P1"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "ring", teeth = 70 }
carrier = "carrier"
mesh_efficiency = 0.99

[[operation]]
name = "load"
fixed = ["ring"]
speeds = { sun = "1000 rpm" }
torques = { sun = "10 N m" }
"#;

/// The text with one part replaced, which must stand there exactly once.
fn with(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "{old:?} in\n{text}");
    text.replace(old, new)
}

// ---- What every answer must keep ----------------------------------------------------------

/// Reads and analyses a text as a front end does; an analysis is checked.
fn answer(text: &str) -> Result<Analysis, Diagnostics> {
    let reading = Train::read_toml(text);
    reading.diagnostics.render("train.toml", text, text.len() < 10_000);
    let Some(train) = &reading.train else {
        assert!(reading.diagnostics.has_errors(), "no train and no error");
        return Err(reading.diagnostics);
    };
    assert!(!reading.diagnostics.has_errors(), "a train in spite of errors");
    match analyze(train, &Selection::default()) {
        Ok(analysis) => {
            sound(&analysis);
            let mut all = Diagnostics::default();
            all.extend(analysis.diagnostics.iter().cloned());
            reading.locate(text, &mut all);
            all.render("train.toml", text, false);
            Ok(analysis)
        }
        Err(mut errors) => {
            assert!(errors.has_errors(), "no analysis and no error");
            reading.locate(text, &mut errors);
            errors.render("train.toml", text, false);
            Err(errors)
        }
    }
}

/// Numbers are numbers, powers close, verdicts and solutions agree.
fn sound(a: &Analysis) {
    if let Some(x) = numbers(&format!("{a:?}")).into_iter().next() {
        panic!("{x} in the analysis of `{}`", a.train);
    }
    let json = serde_json::to_value(a).expect("plain data");
    for (state, row) in json["ratios"].as_object().expect("an object") {
        // A fraction beyond floating point has no decimal.
        let long = row["exact"].as_str().is_some_and(|e| e.len() > 300);
        let value = !row["value"].is_null();
        assert!(!value || row["exact"].is_string(), "state {state}: a ratio without its fraction");
        assert!(value || long || row["exact"].is_null(), "state {state}: a fraction without its ratio");
        for way in ["drive", "coast"] {
            let d = &row[way];
            let count = d["efficiencies"].as_array().expect("a list").len();
            match d["verdict"].as_str() {
                Some("unique") => {
                    let e = d["efficiency"].as_f64().unwrap_or_else(|| panic!("state {state}, {way}: no efficiency"));
                    assert!((0.0..=1.0 + 1e-12).contains(&e), "state {state}, {way}: efficiency {e}");
                    assert_eq!(count, 1, "state {state}, {way}");
                }
                Some("multiple") => assert!(count > 0, "state {state}, {way}"),
                // Undecided: what was found is listed, and claims nothing.
                Some("undetermined") => assert!(d["efficiency"].is_null(), "state {state}, {way}"),
                _ => assert!(d["efficiency"].is_null() && count == 0, "state {state}, {way}"),
            }
        }
    }
    for (o, operation) in json["operations"].as_array().expect("a list").iter().enumerate() {
        let name = operation["name"].as_str().expect("a name");
        let solutions = operation["solutions"].as_array().expect("a list");
        let dissipative = operation["dissipative_solutions"].as_array().expect("a list");
        for s in solutions.iter().chain(dissipative) {
            solution(name, s);
        }
        match a.operations[o].verdict {
            Verdict::Unique => {
                assert_eq!(solutions.len(), 1, "operation {name}: unique");
                let s = &solutions[0];
                if number(name, s, "input_power_w") > 0.0 {
                    number(name, s, "efficiency");
                }
                // Clutches and brakes in a ring share a load as statics cannot tell.
                let shared =
                    s["shift_elements"].as_object().expect("an object").values().any(|e| e["torque_n_m"].is_null());
                for (member, m) in s["members"].as_object().expect("an object") {
                    // Without a determined speed a member is idle.
                    let loose = m["speed_rad_s"].is_null() && m["torque_n_m"] == 0.0;
                    for key in ["speed_rad_s", "torque_n_m", "power_w"] {
                        let known = loose || shared && key == "torque_n_m" || m[key].is_f64();
                        assert!(known, "operation {name}: {member}.{key} is {}", m[key]);
                    }
                }
            }
            Verdict::Multiple => assert!(!solutions.is_empty(), "operation {name}: several"),
            Verdict::Locked => {
                assert!(solutions.is_empty(), "operation {name}: locked and moving");
                // A certificate promises one equilibrium for every load, if only a dissipative one.
                let promised = a.operations[o].certificate.is_some_and(|c| c.unique_for_every_load);
                assert!(!promised || !dissipative.is_empty(), "operation {name}: certified and without a solution");
                let undecided = a.operations[o].certificate.is_some_and(|c| c.method == Certificate::Undecided);
                assert!(!undecided || !dissipative.is_empty(), "operation {name}: called locked, and undecided");
            }
            _ => {}
        }
    }
}

/// One solution as JSON.
fn solution(name: &str, s: &Value) {
    let powers = ["input_power_w", "output_power_w", "loss_w"].map(|key| number(name, s, key));
    let largest = s["meshes"]
        .as_object()
        .expect("an object")
        .values()
        .map(|m| {
            for key in
                ["relative_speed_rad_s", "efficiency", "first_torque_n_m", "second_torque_n_m", "carrier_torque_n_m"]
            {
                number(name, m, key);
            }
            assert!(number(name, m, "loss_w") >= 0.0, "operation {name}: a mesh makes power");
            number(name, m, "potential_power_w").abs()
        })
        .chain(powers)
        .fold(0.0, f64::max);
    for key in ["mesh", "bearing", "windage", "churning", "seal"] {
        number(name, &s["losses_w"], key);
    }
    let residual = number(name, s, "power_residual_w");
    assert!(residual.abs() <= 1e-9 * largest, "operation {name}: powers do not close: {residual} of {largest} W");
    if let Some(e) = s["efficiency"].as_f64() {
        assert!((0.0..=1.0).contains(&e), "operation {name}: efficiency {e}");
    }
}

fn number(name: &str, of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap_or_else(|| panic!("operation {name}: {key} is {}", of[key]))
}

/// The words `NaN`, `inf` and `-inf` outside quotes in a debug text.
fn numbers(debug: &str) -> Vec<&str> {
    let outside = debug.split('"').step_by(2);
    outside.flat_map(|t| t.split(|c: char| !c.is_alphanumeric())).filter(|w| matches!(*w, "NaN" | "inf")).collect()
}

fn refused(text: &str, code: Code) {
    match answer(text) {
        Err(d) => assert!(d.iter().any(|d| d.code == code), "{code} is not among\n{d}"),
        Ok(a) => panic!("{code} expected, answered: {a:?}"),
    }
}

/// Answered, and the verdicts of its operations are these.
fn answered(text: &str, verdicts: &[Verdict]) -> Analysis {
    let a = answer(text).unwrap_or_else(|e| panic!("refused: {e}"));
    let found: Vec<_> = a.operations.iter().map(|o| o.verdict).collect();
    assert_eq!(found, verdicts);
    a
}

// ---- Time and memory -------------------------------------------------------------------------

/// Allocations within which bad input is refused, and a train of ordinary size answered. Work is counted, not timed: a
/// busy machine counts the same. Each limit is three times what the longest of its inputs takes.
const SHORT: u64 = 1_500_000;
/// Allocations for the most hostile file of 4 MiB.
const HOSTILE: u64 = 120_000_000;
/// Allocations within which the largest trains that are accepted are answered.
const LONG: u64 = 9_000_000;
/// What has not ended by then never will.
const HANGS: Duration = Duration::from_secs(900);
/// Memory that the process may ever have held.
const MOST_MIB: u64 = 1024;

/// Answers in a process of its own, which is ended when it takes too long.
fn bounded(text: &str, limit: u64) {
    let mut child = Command::new(std::env::current_exe().expect("this test"))
        .args(["--exact", "bad_input::regress_in_a_process_of_its_own", "--ignored", "--nocapture"])
        .env("WILLIS_BAD_INPUT", limit.to_string())
        .env("RUST_BACKTRACE", "0")
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("this test starts");
    child.stdin.take().expect("piped").write_all(text.as_bytes()).expect("it reads all");
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child") {
            break status;
        }
        if start.elapsed() > HANGS {
            child.kill().expect("it runs");
            child.wait().expect("it ended");
            panic!("no answer within {HANGS:?}");
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let mut errors = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut errors).expect("text");
    assert!(status.success(), "{status}: {errors}");
}

/// The other side of [`bounded`].
#[test]
#[ignore = "run by the other tests, with a train on standard input"]
fn regress_in_a_process_of_its_own() {
    let Some(limit) = std::env::var("WILLIS_BAD_INPUT").ok().and_then(|l| l.parse::<u64>().ok()) else { return };
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).expect("a text");
    let work = allocation_counter::measure(|| drop(answer(&text)));
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|l| l.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse::<u64>().ok());
    let mib = peak.unwrap_or(0) >> 10;
    eprintln!("{} allocations, {mib} MiB", work.count_total);
    assert!(work.count_total <= limit, "{} allocations, not {limit}", work.count_total);
    assert!(mib <= MOST_MIB, "{mib} MiB of memory");
}

/// A file as large as the command line accepts.
const FOUR_MIB: usize = 4 << 20;

/// Numbers at random below a limit.
fn noise(seed: u64) -> impl FnMut(usize) -> usize {
    let mut dice = Dice(seed);
    move |below| dice.next() as usize % below
}

fn members(count: usize) -> String {
    (0..count).map(|k| format!("\"m{k}\", ")).collect()
}

/// A row of gear pairs on the frame.
fn row_of_pairs(count: usize, teeth: (u32, u32), efficiency: f64) -> String {
    let mut text =
        format!("format = 1\nname = \"row\"\nmembers = [{}]\nterminals = [\"m0\", \"m{count}\"]\n", members(count + 1));
    for k in 0..count {
        text += &format!(
            "[[mesh]]\ngears = [ {{ member = \"m{k}\", teeth = {} }}, {{ member = \"m{}\", teeth = {} }} ]\nefficiency = {efficiency}\n",
            teeth.0,
            k + 1,
            teeth.1
        );
    }
    text + "[[operation]]\nname = \"o\"\nspeeds = { m0 = \"1000 rpm\" }\ntorques = { m0 = \"10 N m\" }\n"
}

/// A row of sets with held rings, each carrier on the next sun; a self-locking drive may come first.
fn row_of_sets(count: usize, efficiency: f64, locking: bool) -> String {
    let mut text = format!(
        "format = 1\nname = \"row\"\nmembers = [\"s\", \"c\", {}]\nterminals = [\"{}\", \"m{count}\"]\n",
        members(count + 1),
        if locking { "s" } else { "m0" }
    );
    if locking {
        text += "[[set]]\nname = \"W\"\ntype = \"stepped\"\nsuns = [ { member = \"s\", teeth = 12, planet_teeth = 36 } ]\n\
                 rings = [ { member = \"frame\", teeth = 84, planet_teeth = 36 }, { member = \"m0\", teeth = 83, planet_teeth = 35 } ]\n\
                 carrier = \"c\"\nmesh_efficiency = { external = 0.98, internal = 0.99 }\n";
    }
    for k in 0..count {
        text += &format!(
            "[[set]]\nname = \"P{k}\"\nsun = {{ member = \"m{k}\", teeth = 30 }}\nring = {{ member = \"frame\", teeth = 70 }}\n\
             carrier = \"m{}\"\nmesh_efficiency = {efficiency}\n",
            k + 1
        );
    }
    text + &format!(
        "[[operation]]\nname = \"o\"\nspeeds = {{ m{count} = \"1 rpm\" }}\ntorques = {{ m{count} = \"-10 N m\" }}\n"
    )
}

/// Meshes between random members on random carriers.
fn tangle(meshes: usize, rotors: usize) -> String {
    let mut random = noise(7);
    let mut text =
        format!("format = 1\nname = \"tangle\"\nmembers = [{}]\nterminals = [\"m0\", \"m1\"]\n", members(rotors));
    for _ in 0..meshes {
        let a = random(rotors);
        let b = (a + 1 + random(rotors - 2)) % rotors;
        let c = (0..).map(|_| random(rotors)).find(|c| *c != a && *c != b).expect("a third one");
        text += &format!(
            "[[mesh]]\ngears = [ {{ member = \"m{a}\", teeth = {} }}, {{ member = \"m{b}\", teeth = {} }} ]\ncarrier = \"m{c}\"\nefficiency = 0.99\n",
            17 + random(99_000),
            17 + random(99_000)
        );
    }
    text
}

macro_rules! bounded {
    ($($name:ident: $limit:ident, $text:expr;)+) => {
        $(
            #[test]
            fn $name() {
                bounded(&$text, $limit);
            }
        )+
    };
}

bounded! {
    // Garbage as large as a file can be.
    regress_garbage_of_brackets: HOSTILE, "[".repeat(FOUR_MIB);
    regress_garbage_of_lists: HOSTILE, format!("a = {}", "[".repeat(FOUR_MIB - 4));
    regress_garbage_of_tables: HOSTILE, "a = {".repeat(FOUR_MIB / 5);
    regress_garbage_of_quotes: HOSTILE, "\"".repeat(FOUR_MIB);
    regress_garbage_of_equal_signs: HOSTILE, "=\n".repeat(FOUR_MIB / 2);
    regress_garbage_of_dots: HOSTILE, format!("a{} = 1", ".a".repeat(FOUR_MIB / 2 - 4));
    regress_garbage_of_zeros: HOSTILE, "\0".repeat(FOUR_MIB);
    regress_garbage_of_punctuation: HOSTILE, {
        let mut random = noise(1);
        (0..FOUR_MIB).map(|_| b"abc=[]{}\"'\n#., 0123"[random(19)] as char).collect::<String>()
    };
    regress_garbage_of_letters: HOSTILE, {
        let mut random = noise(2);
        (0..FOUR_MIB / 4).map(|_| char::from_u32(random(0x11_0000) as u32).unwrap_or('\u{fffd}')).collect::<String>()
    };
    regress_comment_of_four_mib: HOSTILE, "#".repeat(FOUR_MIB);
    regress_newlines_of_four_mib: HOSTILE, "\r\n".repeat(FOUR_MIB / 2);
    regress_number_of_four_mib: HOSTILE, format!("format = {}", "9".repeat(FOUR_MIB - 9));
    regress_text_of_four_mib: HOSTILE, with(SET, "name = \"set\"", &format!("name = \"{}\"", "x".repeat(FOUR_MIB - 1000)));
    regress_keys_of_four_mib: HOSTILE, (0..300_000).map(|k| format!("key{k} = 1\n")).collect::<String>();
    regress_tables_of_four_mib: HOSTILE, "[[mesh]]\n".repeat(FOUR_MIB / 9);
    regress_states_of_four_mib: HOSTILE, "[[state]]\n".repeat(FOUR_MIB / 10);

    // Names that nothing carries, by the thousand.
    regress_unknown_terminals: HOSTILE, format!(
        "format = 1\nname = \"x\"\nmembers = [{}]\nterminals = [{}]\n",
        (0..1000).map(|k| format!("\"member with a rather long name {k:030}\", ")).collect::<String>(),
        (0..40_000).map(|k| format!("\"terminal with a rather long name {k:030}\", ")).collect::<String>()
    );
    regress_unknown_shift_elements: HOSTILE, format!(
        "format = 1\nname = \"x\"\nmembers = [\"a\"]\n{}[[state]]\nname = \"1\"\nengaged = [{}]\n",
        (0..1000).map(|k| format!("[[shift_element]]\nname = \"clutch with a long name {k:040}\"\nkind = \"brake\"\nmembers = [\"a\"]\n")).collect::<String>(),
        (0..40_000).map(|k| format!("\"klutch with a long name {k:040}\", ")).collect::<String>()
    );
    regress_wrong_and_unknown_names: HOSTILE, format!(
        "format = 1\nname = \"x\"\nmembers = [\"a\"]\nterminals = [{}{}]\n",
        "1, ".repeat(200_000),
        "\"b\", ".repeat(200_000)
    );

    // Quantities that cost.
    regress_unit_of_many_factors: HOSTILE, with(SET, "1000 rpm", &format!("1000 rpm{}", " ms".repeat(100_000)));
    regress_number_of_many_digits: HOSTILE, with(SET, "1000 rpm", &format!("{} rpm", "9".repeat(1_000_000)));
    regress_unit_of_many_letters: HOSTILE, with(SET, "1000 rpm", &format!("1000 {}", "x".repeat(1_000_000)));

    // Trains beyond the limit, at the limit, and of a size that a person may draw.
    regress_ten_thousand_meshes: SHORT, row_of_pairs(10_000, (20, 40), 0.99);
    regress_ten_thousand_members: SHORT, format!("format = 1\nname = \"x\"\nmembers = [{}]\n", members(10_000));
    regress_ten_thousand_sets: SHORT, row_of_sets(10_000, 0.99, false);
    regress_row_of_250_pairs: SHORT, row_of_pairs(250, (20, 40), 0.99);
    regress_row_of_120_pairs: LONG, row_of_pairs(120, (20, 40), 0.99);
    regress_row_of_20_lossy_sets: SHORT, row_of_sets(20, 0.9, false);
    regress_row_of_60_lossy_sets: LONG, row_of_sets(60, 0.9, false);
    regress_row_of_60_good_sets: LONG, row_of_sets(60, 0.999, false);
    regress_locking_row_of_10_sets: SHORT, row_of_sets(10, 0.98, true);
    regress_locking_row_of_17_sets: LONG, row_of_sets(17, 0.98, true);
    regress_locking_row_of_25_sets: LONG, row_of_sets(25, 0.98, true);
    regress_locking_row_of_40_sets: LONG, row_of_sets(40, 0.98, true);
    regress_locking_row_of_60_sets: LONG, row_of_sets(60, 0.98, true);
    regress_tangle_of_60_meshes: LONG, tangle(60, 61);
    regress_tangle_of_100_meshes: LONG, tangle(100, 101);
    regress_loose_tangle_of_120_meshes: LONG, tangle(120, 180);
    regress_redundant_tangle_of_120_meshes: LONG, tangle(120, 40);
    regress_four_thousand_operations: LONG, {
        let at = SET.find("[[operation]]").expect("one");
        let more: String = (0..4000).map(|k| SET[at..].replace("load", &format!("load {k}"))).collect();
        format!("{}{more}", &SET[..at])
    };
    regress_all_states_and_clutches: LONG, {
        let clutches: String = (0..1000).map(|k| format!("[[shift_element]]\nname = \"C{k}\"\nkind = \"clutch\"\nmembers = [\"sun\", \"ring\"]\n")).collect();
        let engaged: String = (0..1000).map(|k| format!("\"C{k}\", ")).collect();
        let states: String = (0..256).map(|k| format!("[[state]]\nname = \"{k}\"\nengaged = [{engaged}]\n")).collect();
        format!("{SET}{clutches}{states}")
    };
}

// ---- Bad input ---------------------------------------------------------------------------------

#[test]
fn regress_empty() {
    for text in ["", " ", "\n\n", "\u{feff}", "# nothing\n"] {
        refused(text, Code::MissingKey);
    }
}

#[test]
fn regress_wrong_unit() {
    for unit in ["N m", "rad", "1/s", "kg", "rpm^2", "rpm/", "/rpm", "rpm rpm", "", "µ", "rpm\u{0}", "\u{2212}"] {
        let text = with(SET, "1000 rpm", &format!("1000 {}", unit.replace('\u{0}', "\\u0000")));
        assert!(answer(&text).is_err(), "{unit:?} taken for an angular speed");
        refused(&text, Code::Quantity);
    }
}

#[test]
fn regress_numbers_that_are_none() {
    for number in [
        "nan",
        "inf",
        "-inf",
        "1e400",
        "1e61",
        "1e-400",
        "1e99999999999",
        "",
        "-",
        ".",
        "+",
        "e5",
        "0x10",
        "1/0",
        "1/2/3",
        "--1",
        "½",
        "١",
    ] {
        refused(&with(SET, "1000 rpm", &format!("{number} rpm")), Code::Quantity);
    }
    for number in ["nan", "inf", "-inf", "1e-400", "1e61", "1e-9999999999"] {
        refused(&with(SET, "0.99", number), Code::OutOfRange);
    }
    refused(&with(SET, "\"10 N m\"", "nan"), Code::Quantity);
    refused(&with(SET, "teeth = 30", "teeth = nan"), Code::WrongType);
}

#[test]
fn regress_huge_and_tiny_quantities() {
    for (speed, torque) in [("1e60", "1e60"), ("1e-60", "1e-60"), ("1e60", "1e-60"), ("-1e60", "1e60")] {
        let text = with(&with(SET, "1000 rpm", &format!("{speed} rpm")), "10 N m", &format!("{torque} N m"));
        answered(&text, &[Verdict::Unique]);
    }
}

#[test]
fn regress_fractions_of_fractions() {
    // 1e480: exact arithmetic can, floating point cannot.
    let number = ["1e60"; 2].join("/1e-60/") + "/1e-60/1e60/1e-60";
    let text = with(SET, "1000 rpm", &format!("{number}/1e60/1e-60 rpm"));
    match answer(&text) {
        Ok(_) => {}
        Err(d) => assert!(d.iter().any(|d| d.code == Code::Quantity), "{d}"),
    }
}

#[test]
fn regress_powers_of_pi() {
    // Dimensions cancel, the powers of π do not.
    let speed = format!("1 {}rad/s {}", "rev^4 ".repeat(25), "rad^4 ".repeat(25));
    let power = format!("1 W {}/{}", "rad^4 ".repeat(25), "rev^4 ".repeat(25));
    let text = with(
        &with(SET, "1000 rpm", &speed),
        "torques = { sun = \"10 N m\" }",
        &format!("powers = {{ sun = \"{power}\" }}"),
    );
    let _ = answer(&text);
}

#[test]
fn regress_dimensions_beyond_eight_bits() {
    // m^200 is not m^127, whatever an 8-bit exponent says.
    let unit = format!("rpm{}/{}", " m".repeat(200), "m ".repeat(127));
    refused(&with(SET, "1000 rpm", &format!("1000 {unit}")), Code::Quantity);
}

#[test]
fn regress_teeth_out_of_range() {
    for teeth in [
        "0",
        "-1",
        "-20",
        "-21",
        "-30",
        "-70",
        "100001",
        "1000000000",
        "-1000000000",
        "9223372036854775807",
        "-9223372036854775808",
    ] {
        for (gear, old) in
            [("sun", "teeth = 30"), ("planet", "teeth = 20"), ("ring", "teeth = 70"), ("planets", "count = 4")]
        {
            let key = old.split_once('=').expect("a key").0;
            let text = with(SET, old, &format!("{key}= {teeth}"));
            let found = answer(&text).err().unwrap_or_else(|| panic!("{gear} {teeth}: answered"));
            assert!(found.iter().any(|d| d.code == Code::OutOfRange), "{gear} {teeth}: {found}");
        }
        let both =
            with(&with(SET, "teeth = 30", &format!("teeth = {teeth}")), "teeth = 70", &format!("teeth = {teeth}"));
        refused(&both, Code::OutOfRange);
    }
    refused(&with(SET, "teeth = 30", "teeth = 99999999999999999999"), Code::OutOfRange);
}

#[test]
fn regress_teeth_out_of_range_in_other_sets() {
    let sets = [
        "type = \"double-planet\"\nsun = { member = \"sun\", teeth = A }\nring = { member = \"ring\", teeth = B }\ninner_planet = { count = 3 }",
        "type = \"double-planet\"\nsun = { member = \"sun\", teeth = A }\nring = { member = \"ring\", teeth = B }\ninner_planet = { teeth = B, count = 3 }\nouter_planet = { teeth = A }",
        "type = \"stepped\"\nsuns = [ { member = \"sun\", teeth = A, planet_teeth = B } ]\nrings = [ { member = \"ring\", teeth = B, planet_teeth = A } ]\nplanet = { count = 3 }",
        "type = \"stepped\"\nsuns = [ { member = \"sun\", teeth = A, planet_teeth = A }, { member = \"ring\", teeth = B, planet_teeth = B } ]\nplanet = { count = 3 }",
        "type = \"ravigneaux\"\nsmall_sun = { member = \"sun\", teeth = A }\nlarge_sun = { member = \"sun\", teeth = B }\nring = { member = \"ring\", teeth = A }\nlong_planet = { count = 3 }",
        "type = \"bevel\"\nsides = [ { member = \"sun\", teeth = A }, { member = \"ring\", teeth = B } ]\nplanet = { count = 3 }",
    ];
    let teeth = ["-9223372036854775808", "-30", "-1", "0", "1", "100001", "9223372036854775807"];
    for set in sets {
        for a in teeth {
            for b in teeth {
                let parts = set.replace('A', a).replace('B', b);
                let text = format!(
                    "format = 1\nname = \"x\"\nmembers = [\"sun\", \"ring\", \"carrier\"]\nterminals = [\"sun\", \"carrier\"]\n\
                     [[set]]\nname = \"P\"\ncarrier = \"carrier\"\n{parts}\n"
                );
                let found = answer(&text);
                assert!(found.is_err() || (a, b) == ("1", "1"), "{a} {b} accepted in {set}");
            }
        }
    }
}

#[test]
fn regress_unknown_and_duplicate_names() {
    refused(&with(SET, "terminals = [\"sun\", \"carrier\"]", "terminals = [\"sun\", \"x\"]"), Code::UnknownName);
    refused(&with(SET, "carrier = \"carrier\"", "carrier = \"\""), Code::UnknownName);
    refused(&with(SET, "fixed = [\"ring\"]", "fixed = [\"Ring\"]"), Code::UnknownName);
    refused(&with(SET, "members = [\"sun\", ", "members = [\"sun\", \"sun\", "), Code::DuplicateName);
    refused(&format!("{SET}\n[[operation]]\nname = \"load\"\n"), Code::DuplicateName);
}

#[test]
fn regress_contradictions_and_omissions() {
    refused(
        &with(SET, "{ sun = \"1000 rpm\" }", "{ sun = \"1000 rpm\", carrier = \"1000 rpm\" }"),
        Code::ContradictorySpeeds,
    );
    refused(&with(SET, "{ sun = \"1000 rpm\" }", "{ ring = \"1000 rpm\" }"), Code::HeldAndDriven);
    refused(&with(SET, "torques = { sun = \"10 N m\" }\n", ""), Code::MissingTorque);
    refused(
        &with(SET, "torques = { sun = \"10 N m\" }", "torques = { sun = \"10 N m\", carrier = \"10 N m\" }"),
        Code::TooManyTorques,
    );
    refused(&with(SET, "torques = { sun = \"10 N m\" }", "torques = { ring = \"10 N m\" }"), Code::HeldAndDriven);
    refused(&with(SET, "mesh_efficiency = 0.99", "mesh_efficiency = 0.99\nbasic_efficiency = 0.98"), Code::Conflict);
}

#[test]
fn regress_nothing_is_dropped_in_silence() {
    // Two counts of planets that turn in pairs.
    let double = "[[set]]\nname = \"D\"\ntype = \"double-planet\"\nsun = { member = \"a\", teeth = 30 }\n\
                  inner_planet = { teeth = 12, count = 3 }\nouter_planet = { teeth = 12, count = 4 }\n\
                  ring = { member = \"b\", teeth = 78 }\ncarrier = \"c\"\n";
    refused(&train("\"a\", \"b\", \"c\"", "\"a\", \"c\"", double), Code::Conflict);
    let ravigneaux = "[[set]]\nname = \"R\"\ntype = \"ravigneaux\"\nsmall_sun = { member = \"a\", teeth = 30 }\n\
                      short_planet = { teeth = 20, count = 3 }\nlong_planet = { teeth = 20, count = 4 }\n\
                      ring = { member = \"b\", teeth = 78 }\ncarrier = \"c\"\n";
    refused(&train("\"a\", \"b\", \"c\"", "\"a\", \"c\"", ravigneaux), Code::Conflict);
    // Clutches and brakes block no direction.
    for (kind, members, blocks) in [("clutch", "\"a\", \"b\"", "forward"), ("brake", "\"b\"", "backward")] {
        let element = format!(
            "[[shift_element]]\nname = \"K\"\nkind = \"{kind}\"\nmembers = [{members}]\nblocks = \"{blocks}\"\n"
        );
        let rest = set("a", "b", "c") + &element;
        refused(&train("\"a\", \"b\", \"c\"", "\"a\", \"c\"", &rest), Code::Conflict);
        let free = element.replace(&format!("blocks = \"{blocks}\"\n"), "");
        answered(&train("\"a\", \"b\", \"c\"", "\"a\", \"c\"", &(set("a", "b", "c") + &free)), &[]);
    }
}

#[test]
fn regress_names_of_meshes_stay() {
    // The first mesh has no name; the one that it would get belongs to the second.
    let rest = "[[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]\n\
                [[mesh]]\nname = \"a-b\"\ngears = [ { member = \"b\", teeth = 20 }, { member = \"c\", teeth = 50 } ]\n\
                [[operation]]\nname = \"o\"\nspeeds = { a = \"100 rpm\" }\ntorques = { a = \"10 N m\" }\n";
    let a = answered(&train("\"a\", \"b\", \"c\"", "\"a\", \"c\"", rest), &[Verdict::Unique]);
    let mesh = a.operations[0].solutions[0].meshes.get("a-b").expect("the mesh of that name");
    assert_eq!(mesh.driver.as_deref(), Some("b"), "another mesh carries the name");
}

#[test]
fn regress_load_on_a_shaft_of_any_speed() {
    // Clutched shafts push against each other; no speed is known, so no power is.
    let rest = format!(
        "{}{CLUTCHES}\n[[state]]\nname = \"1\"\nengaged = [\"AB\"]\n[[operation]]\nname = \"o\"\nstate = \"1\"\ntorques = {{ a = \"10 N m\" }}\n",
        "[[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"c\", teeth = 40 } ]\ncarrier = \"b\"\n"
    );
    answered(&train("\"a\", \"b\", \"c\"", "\"a\", \"b\"", &rest), &[Verdict::Undetermined]);
}

#[test]
fn regress_speeds_in_two_units() {
    // 1000 rpm at the sun make 300 rpm = 31.41592653589793 rad/s at the carrier, to the last digit.
    answered(
        &with(SET, "{ sun = \"1000 rpm\" }", "{ sun = \"1000 rpm\", carrier = \"31.41592653589793 rad/s\" }"),
        &[Verdict::Unique],
    );
    answered(&with(SET, "{ sun = \"1000 rpm\" }", "{ sun = \"1000 rpm\", carrier = \"5 rev/s\" }"), &[Verdict::Unique]);
}

#[test]
fn regress_redundant_meshes_and_speeds() {
    // Six equal meshes, two freedoms, three speeds that agree.
    let meshes =
        "[[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]\ncarrier = \"c\"\n"
            .repeat(6);
    let text = format!(
        "format = 1\nname = \"x\"\nmembers = [\"a\", \"b\", \"c\"]\nterminals = [\"a\", \"b\"]\n{meshes}[[operation]]\nname = \"o\"\n\
         speeds = {{ a = \"100 rpm\", b = \"-50 rpm\", c = \"0 rpm\" }}\ntorques = {{ a = \"1 N m\" }}\n"
    );
    answered(&text, &[Verdict::Undetermined]);
    // The same contradiction is told once.
    let wrong = answer(&with(&text, "-50 rpm", "-60 rpm")).expect_err("a contradiction");
    assert_eq!(wrong.iter().filter(|d| d.code == Code::ContradictorySpeeds).count(), 1, "{wrong}");
}

#[test]
fn regress_deep_nesting() {
    for depth in [10, 70, 100, 1000, 100_000] {
        for (open, close) in [("[", "]"), ("{ a = ", "}")] {
            let text = format!("members = {}1{}", open.repeat(depth), close.repeat(depth));
            assert!(answer(&text).is_err());
        }
        assert!(answer(&format!("[a{}]\n", ".a".repeat(depth))).is_err());
        assert!(answer(&format!("[[set{}]]\n", ".a".repeat(depth))).is_err());
        assert!(answer(&"[[set]]\n[[set.a]]\n".repeat(depth)).is_err());
    }
}

#[test]
fn regress_line_ends_and_byte_order_marks() {
    for text in [
        SET.replace('\n', "\r\n"),
        format!("\u{feff}{SET}"),
        format!("\u{feff}{}", SET.replace('\n', "\r\n")),
        SET.trim_end().to_owned(),
    ] {
        answered(&text, &[Verdict::Unique]);
    }
    assert!(answer(&SET.replace('\n', "\r")).is_err());
    // What is underlined is what is meant.
    for text in [SET.to_owned(), SET.replace('\n', "\r\n"), format!("\u{feff}{SET}"), format!("# µ — 行星\n{SET}")]
    {
        let text = with(&text, "carrier = \"carrier\"", "carrier = \"spider\"");
        let wrong = answer(&text).expect_err("a wrong name");
        let d = wrong.iter().find(|d| d.code == Code::UnknownName).expect("it is told");
        assert_eq!(&text[d.span.expect("a span").range()], "\"spider\"");
    }
}

#[test]
fn regress_names_of_every_kind() {
    for name in [
        "Größe",
        "行星架",
        "🦀",
        "e\u{301}",
        "\u{202e}rtl",
        "a b",
        "a\tb".trim(),
        "'",
        "\\\"",
        "[0]",
        "P1[0]",
        "#",
        "=",
        "\u{a0}",
    ] {
        let escaped = name.replace('\t', "\\t");
        let _ = answer(&SET.replace("\"carrier\"", &format!("\"{escaped}\"")));
    }
    for name in ["行星架", "Größe µ", "a-b", "a_b", "1", "true", "frame2"] {
        answered(&SET.replace("\"carrier\"", &format!("\"{name}\"")), &[Verdict::Unique]);
        answered(&SET.replace("P1", name), &[Verdict::Unique]);
    }
    answered(&SET.replace("\"carrier\"", &format!("\"{}\"", "ü".repeat(64))), &[Verdict::Unique]);
    for length in [65, 1000, 100_000] {
        refused(&SET.replace("\"carrier\"", &format!("\"{}\"", "ü".repeat(length))), Code::BadName);
        refused(&SET.replace("P1", &"x".repeat(length)), Code::BadName);
    }
    // Messages stay short whatever the name.
    let long = with(SET, "carrier = \"carrier\"", &format!("carrier = \"{}\"", "x".repeat(100_000)));
    let wrong = answer(&long).expect_err("an unknown name");
    assert!(wrong.iter().all(|d| d.message.chars().count() < 300), "{wrong}");
}

#[test]
fn regress_no_control_characters_reach_the_terminal() {
    for text in [
        with(SET, "carrier = \"carrier\"", "carrier = \"\\u001b[31m\\u0007\""),
        with(SET, "name = \"set\"", "name = \"\\u001b[31m\""),
        with(SET, "name = \"P1\"", "name = \"\\u001b[31m\""),
        with(SET, "name = \"load\"", "name = \"\\u001b[31m\""),
        with(SET, "mesh_efficiency", "\"\\u001b[31m\""),
        with(SET, "1000 rpm", "1000 \\u001b[31m"),
        with(SET, "fixed = [\"ring\"]", "state = \"\\u001b[31m\""),
    ] {
        let wrong = answer(&text).expect_err("a wrong name");
        assert!(!wrong.render("train.toml", &text, false).contains('\u{1b}'), "{wrong:?}");
    }
}

// ---- Odd trains --------------------------------------------------------------------------------

fn train(members: &str, terminals: &str, rest: &str) -> String {
    format!("format = 1\nname = \"odd\"\nmembers = [{members}]\nterminals = [{terminals}]\n{rest}\n")
}

fn set(sun: &str, ring: &str, carrier: &str) -> String {
    format!(
        "[[set]]\nname = \"P1\"\nsun = {{ member = \"{sun}\", teeth = 30 }}\nplanet = {{ teeth = 20, count = 4 }}\n\
         ring = {{ member = \"{ring}\", teeth = 70 }}\ncarrier = \"{carrier}\"\nmesh_efficiency = 0.99\n"
    )
}

const CLUTCHES: &str = r#"
[[shift_element]]
name = "AB"
kind = "clutch"
members = ["a", "b"]

[[shift_element]]
name = "BC"
kind = "clutch"
members = ["b", "c"]

[[shift_element]]
name = "CA"
kind = "clutch"
members = ["c", "a"]

[[state]]
name = "all"
engaged = ["AB", "BC", "CA"]
"#;

#[test]
fn regress_cyclic_clutches() {
    // Statics cannot divide the torque between three clutches in a ring; everything else is known.
    let rest = format!(
        "{}{CLUTCHES}\n[[operation]]\nname = \"o\"\nstate = \"all\"\nspeeds = {{ a = \"100 rpm\" }}\ntorques = {{ a = \"10 N m\" }}\n",
        set("a", "b", "c")
    );
    let a = answer(&train("\"a\", \"b\", \"c\"", "\"a\", \"c\"", &rest)).expect("answered");
    let o = &a.operations[0];
    for s in &o.solutions {
        assert!(s.shift_elements.iter().all(|(_, e)| e.torque_n_m.is_none()), "{s:?}");
    }
}

#[test]
fn regress_two_brakes_on_one_member() {
    // How the brakes share it is unknown; what the frame exerts on the member is not.
    let rest = format!(
        "{}\n[[shift_element]]\nname = \"B1\"\nkind = \"brake\"\nmembers = [\"b\"]\n[[shift_element]]\nname = \"B2\"\nkind = \"brake\"\nmembers = [\"b\"]\n\
         [[state]]\nname = \"1\"\nengaged = [\"B1\", \"B2\"]\n[[operation]]\nname = \"o\"\nstate = \"1\"\nspeeds = {{ a = \"100 rpm\" }}\ntorques = {{ a = \"10 N m\" }}\n",
        set("a", "b", "c")
    );
    let a = answered(&train("\"a\", \"b\", \"c\"", "\"a\", \"c\"", &rest), &[Verdict::Unique]);
    let s = &a.operations[0].solutions[0];
    assert!(s.shift_elements.iter().all(|(_, e)| e.torque_n_m.is_none()), "{s:?}");
    let torque = s.members.get("b").expect("a member").torque_n_m.expect("the reaction of the frame");
    assert!((torque - 10.0 * 7.0 / 3.0 * 0.99 * 0.99).abs() < 1e-9, "{torque}");
}

#[test]
fn regress_clutch_to_itself() {
    for members in ["\"a\", \"a\"", "\"a\"", "", "\"frame\", \"frame\"", "\"a\", \"b\", \"c\""] {
        let rest = format!(
            "{}\n[[shift_element]]\nname = \"C\"\nkind = \"clutch\"\nmembers = [{members}]\n",
            set("a", "b", "c")
        );
        refused(&train("\"a\", \"b\", \"c\"", "\"a\", \"c\"", &rest), Code::ShiftElement);
    }
}

#[test]
fn regress_ring_smaller_than_sun() {
    for ring in [1, 24, 29, 30, 31, 32] {
        let text =
            with(&with(SET, "teeth = 70", &format!("teeth = {ring}")), "planet = { teeth = 20, count = 4 }\n", "");
        let found = answer(&text);
        assert_eq!(found.is_err(), ring <= 30, "ring {ring}: {found:?}");
        refused(&with(SET, "teeth = 70", &format!("teeth = {ring}")), Code::NotCoaxial);
    }
}

#[test]
fn regress_every_part_on_the_frame_or_shared() {
    let parts = ["frame", "a", "b", "c"];
    for sun in parts {
        for ring in parts {
            for carrier in parts {
                for terminals in ["", "\"a\"", "\"a\", \"b\"", "\"a\", \"b\", \"c\""] {
                    for operation in [
                        "",
                        "[[operation]]\nname = \"o\"\n",
                        "[[operation]]\nname = \"o\"\nspeeds = { a = \"100 rpm\" }\n",
                        "[[operation]]\nname = \"o\"\nspeeds = { a = \"100 rpm\" }\nfixed = [\"b\"]\n",
                        "[[operation]]\nname = \"o\"\nspeeds = { a = \"0 rpm\", b = \"0 rpm\" }\ntorques = { a = \"1 N m\" }\n",
                        "[[operation]]\nname = \"o\"\nspeeds = { a = \"0 rpm\" }\npowers = { a = \"1 W\" }\n",
                        "[[operation]]\nname = \"o\"\nspeeds = { \"P1.planet\" = \"9 rpm\", c = \"9 rpm\" }\ntorques = { a = \"0 N m\" }\n",
                    ] {
                        let _ = answer(&train(
                            "\"a\", \"b\", \"c\"",
                            terminals,
                            &format!("{}{operation}", set(sun, ring, carrier)),
                        ));
                    }
                }
            }
        }
    }
}

#[test]
fn regress_set_on_a_fixed_carrier() {
    // An ordinary train: -30/70, both meshes lose.
    let rest = format!(
        "{}[[operation]]\nname = \"o\"\nspeeds = {{ a = \"700 rpm\" }}\ntorques = {{ a = \"10 N m\" }}\n",
        set("a", "b", "frame")
    );
    let a = answered(&train("\"a\", \"b\"", "\"a\", \"b\"", &rest), &[Verdict::Unique]);
    assert_eq!(a.ratios.get("as drawn").expect("a row").exact, Some(Rational::new(-7, 3)));
    assert!((a.operations[0].solutions[0].efficiency.expect("loaded") - 0.99 * 0.99).abs() < 1e-12);
}

#[test]
fn regress_members_that_only_carry() {
    let rest = format!(
        "{}[[operation]]\nname = \"o\"\nspeeds = {{ c = \"100 rpm\" }}\ntorques = {{ c = \"10 N m\" }}\n",
        set("frame", "frame", "c")
    );
    // Sun and ring held: the carrier cannot turn.
    refused(&train("\"c\"", "\"c\"", &rest), Code::ContradictorySpeeds);
    // A carrier that nothing else touches, its set driven from sun and ring.
    let rest =
        format!("{}[[operation]]\nname = \"o\"\nspeeds = {{ a = \"100 rpm\", b = \"50 rpm\" }}\n", set("a", "b", "c"));
    answered(&train("\"a\", \"b\", \"c\"", "\"a\", \"b\"", &rest), &[Verdict::Unloaded]);
}

#[test]
fn regress_input_is_output() {
    let text = with(SET, "terminals = [\"sun\", \"carrier\"]", "terminals = [\"sun\"]\noutput = \"sun\"");
    let _ = answer(&text);
    let at = SET.find("[[operation]]").expect("one");
    let a =
        answer(&format!("{}[[state]]\nname = \"1\"\nengaged = []\noutput = \"sun\"\n", &SET[..at])).expect("answered");
    // The row is in the table, or something says why it is not.
    assert!(a.ratios.get("1").is_some() || a.diagnostics.iter().any(|d| d.message.contains("state")), "{a:?}");
}

#[test]
fn regress_no_terminals() {
    let at = SET.find("[[operation]]").expect("one");
    let text = with(&SET[..at], "terminals = [\"sun\", \"carrier\"]\n", "");
    let a = answer(&text).expect("answered");
    assert!(!a.ratios.is_empty() || a.diagnostics.iter().any(|d| d.message.contains("terminal")), "silence: {a:?}");
}

#[test]
fn regress_terminals_held() {
    for (fixed, brake) in [("\"a\"", "b"), ("\"c\"", "a"), ("\"a\", \"b\", \"c\"", "c"), ("", "a"), ("\"b\"", "b")] {
        for torques in ["", "b = \"1 N m\"", "b = \"0 N m\", c = \"1 N m\""] {
            for speeds in ["", "a = \"0 rpm\"", "c = \"100 rpm\""] {
                let rest = format!(
                    "{}[[shift_element]]\nname = \"B\"\nkind = \"brake\"\nmembers = [\"{brake}\"]\n[[state]]\nname = \"1\"\nengaged = [\"B\"]\n\
                     [[operation]]\nname = \"o\"\nstate = \"1\"\nfixed = [{fixed}]\ntorques = {{ {torques} }}\nspeeds = {{ {speeds} }}\n",
                    set("a", "b", "c")
                );
                let _ = answer(&train("\"a\", \"b\", \"c\"", "\"a\", \"b\", \"c\"", &rest));
            }
        }
    }
}

#[test]
fn regress_nothing_moves_or_loads() {
    answered(&with(SET, "10 N m", "0 N m"), &[Verdict::Unloaded]);
    let at_rest = with(SET, "1000 rpm", "0 rpm");
    let a = answer(&at_rest).expect("answered");
    assert_ne!(a.operations[0].verdict, Verdict::Locked, "a load at rest is carried");
    answered(&with(&at_rest, "10 N m", "0 N m"), &[Verdict::Unloaded]);
    answered(&with(SET, "torques = { sun = \"10 N m\" }", "powers = { sun = \"0 W\" }"), &[Verdict::Unloaded]);
    refused(&with(&at_rest, "torques = { sun = \"10 N m\" }", "powers = { sun = \"1 W\" }"), Code::PowerAtRest);
    answered(&with(&at_rest, "torques = { sun = \"10 N m\" }", "powers = { sun = \"0 W\" }"), &[Verdict::Unloaded]);
}

#[test]
fn regress_efficiencies_at_the_ends() {
    for efficiency in ["1", "1.0", "0.999999999999", "0.5", "1e-3", "1e-12", "1e-60"] {
        let a = answer(&with(SET, "0.99", efficiency)).expect("answered");
        assert_eq!(a.operations[0].verdict, Verdict::Unique, "{efficiency}");
    }
}

#[test]
fn regress_ratios_beyond_floating_point() {
    // 1e5^100: the ratio is a fraction that floating point cannot hold. The fraction is told; a torque
    // beyond 1e308 is an error, not an infinity.
    for teeth in [(1, 100_000), (100_000, 1)] {
        let text = row_of_pairs(100, teeth, 0.99);
        refused(&text, Code::TooLarge);
        let a = answer(text.split("[[operation]]").next().unwrap()).expect("answered");
        let row = a.ratios.get("as drawn").expect("a row");
        assert!(row.exact.as_ref().is_some_and(|e| e.to_fraction().len() > 400) && row.value.is_none());
        assert_eq!((row.drive.verdict, row.coast.verdict), (Verdict::Undetermined, Verdict::Undetermined));
    }
}

#[test]
fn regress_ordinary_rows_do_not_lock() {
    // Sets with held rings never lock, whatever stands before and behind.
    for (count, efficiency) in [(5, 0.3), (16, 0.9), (16, 0.3), (25, 0.99), (40, 0.3)] {
        let a = answer(&row_of_sets(count, efficiency, false)).expect("answered");
        let row = a.ratios.get("as drawn").expect("a row");
        for verdict in [row.drive.verdict, row.coast.verdict, a.operations[0].verdict] {
            // A longer row may stay undecided; wrong it may not be.
            let right = verdict == Verdict::Unique || count > 16 && verdict == Verdict::Undetermined;
            assert!(right, "{count} sets of {efficiency}: {verdict:?}");
        }
    }
}

// ---- Files with damage ---------------------------------------------------------------------------

/// Something that a hand or a disk may do to a file.
#[derive(Clone, Debug)]
enum Damage {
    Delete(usize),
    Duplicate(usize),
    SwapLines(usize, usize),
    SwapCharacters(usize, usize),
    Insert(usize, char),
    Cut(usize),
    Number(usize, usize),
}

/// What numbers become.
const NUMBERS: &[&str] = &[
    "0",
    "1",
    "-1",
    "-30",
    "2",
    "3",
    "100000",
    "100001",
    "-9223372036854775808",
    "9223372036854775807",
    "1e60",
    "-1e60",
    "1e-60",
    "0.5",
    "0.999999999999999999",
    "nan",
    "inf",
    "1_0",
    "0x1F",
    "true",
    "\"\"",
    "[]",
    "{}",
    "1000 rpm",
    "0 N m",
];

fn damage(text: &str, how: &[Damage]) -> String {
    let mut text = text.to_owned();
    for d in how {
        let mut lines: Vec<&str> = text.lines().collect();
        let mut characters: Vec<char> = text.chars().collect();
        if lines.is_empty() {
            break;
        }
        let (l, c) = (lines.len(), characters.len());
        text = match *d {
            Damage::Delete(k) => {
                lines.remove(k % l);
                lines.join("\n")
            }
            Damage::Duplicate(k) => {
                lines.insert(k % l, lines[k % l]);
                lines.join("\n")
            }
            Damage::SwapLines(i, j) => {
                lines.swap(i % l, j % l);
                lines.join("\n")
            }
            Damage::SwapCharacters(i, j) => {
                characters.swap(i % c, j % c);
                characters.into_iter().collect()
            }
            Damage::Insert(k, x) => {
                characters.insert(k % c, x);
                characters.into_iter().collect()
            }
            Damage::Cut(k) => characters[..k % c].iter().collect(),
            Damage::Number(k, n) => {
                let digit = |c: &char| c.is_ascii_digit() || *c == '.';
                let starts: Vec<usize> = (0..c)
                    .filter(|&i| characters[i].is_ascii_digit() && (i == 0 || !digit(&characters[i - 1])))
                    .collect();
                let Some(&at) = starts.get(k % starts.len().max(1)) else { continue };
                let end = (at..c).find(|&i| !digit(&characters[i])).unwrap_or(c);
                characters[..at]
                    .iter()
                    .copied()
                    .chain(NUMBERS[n % NUMBERS.len()].chars())
                    .chain(characters[end..].iter().copied())
                    .collect()
            }
        };
    }
    text
}

fn any_damage() -> impl Strategy<Value = Damage> {
    let k = || any::<prop::sample::Index>().prop_map(|i| i.index(1 << 20));
    prop_oneof![
        3 => k().prop_map(Damage::Delete),
        2 => k().prop_map(Damage::Duplicate),
        1 => (k(), k()).prop_map(|(i, j)| Damage::SwapLines(i, j)),
        2 => (k(), k()).prop_map(|(i, j)| Damage::SwapCharacters(i, j)),
        1 => (k(), prop::sample::select(vec!['"', '\'', '[', ']', '{', '}', '=', ',', '.', '#', '\n', '\r', '-', '\u{0}', 'é', '\u{feff}'])).prop_map(|(i, c)| Damage::Insert(i, c)),
        1 => k().prop_map(Damage::Cut),
        4 => (k(), k()).prop_map(|(i, j)| Damage::Number(i, j)),
    ]
}

/// A train with every kind of physical data.
const PHYSICAL: &str = r#"format = 1
name = "physical"
members = ["sun", "carrier", "out"]
terminals = ["sun", "out"]

[oil]
name = "own"
base = "mineral"
viscosity_40 = "220 mm^2/s"
viscosity_100 = "19 mm^2/s"
density_15 = "890 kg/m^3"
pressure_viscosity = "20 1/GPa"
lubricant_factor = 1.0
temperature = "70 degC"
supply = "bath"
volume = "5 l"
mist = 34.25

[laws]
mesh_friction = "benedict-kelley"
friction_coefficient = 0.05
rolling = "anderson-loewenthal"
bearing = "palmgren"

[housing]
enclosure = 0.7
axial_gap = "30 mm"

[[set]]
name = "P1"
sun = { member = "sun", teeth = 17, shift = 0.3, addendum = 0.9, dedendum = 1.2, roughness = "0.3 um" }
planet = { teeth = 22, count = 3, mass = "0.5 kg", tip_alteration = "-0.1 mm", immersion = "5 mm" }
ring = { member = "frame", teeth = 61 }
carrier = "carrier"
geometry = { module = "4 mm", width = "50 mm", pressure_angle = "20 deg", helix = "12 deg", double_helical = false, centre_distance = "80.5 mm", roughness = "0.6 um", youngs_modulus = "206 GPa", poisson_ratio = 0.3 }

[[mesh]]
name = "pair"
gears = [ { member = "carrier", teeth = 20, immersion = "10 mm" }, { member = "out", teeth = 41, tip_diameter = "174 mm" } ]
geometry = { module = "4 mm", width = "60 mm", helix = "10 deg", double_helical = true }

[[bearing]]
name = "planet bearings"
members = ["P1.planet", "carrier"]
designation = "NU 206"
count = 2
span = "30 mm"

[[bearing]]
name = "own"
members = ["out"]
kind = "tapered-roller"
series = "322"
bore = "50 mm"
outside_diameter = "90 mm"
width = "24.75 mm"
static_rating = "100 kN"
axial_factor = 1.4
radial_load = "400 N"
axial_load = "300 N"
shaft_diameter = "50 mm"
level = "3 mm"

[[seal]]
name = "seal"
members = ["sun"]
diameter = "50 mm"
material = "nbr"
count = 2

[[rotor]]
name = "drum"
member = "carrier"
radius = "130 mm"
length = "110 mm"
radial_gap = "12 mm"
axial_gap = "15 mm"
fluid = "oil"

[[operation]]
name = "hot"
speeds = { sun = "1500 rpm" }
torques = { sun = "300 N m" }
temperature = "90 degC"
"#;

#[test]
fn regress_the_physical_train_is_good() {
    let all = answer(PHYSICAL).unwrap_or_else(|d| panic!("{d}"));
    assert_eq!(all.operations[0].verdict, Verdict::Unique, "{:?}", all.operations[0].reason);
    assert!(all.operations[0].solutions[0].sources.len() > 8);
}

#[test]
fn regress_physical_errors_all_at_once() {
    let mut text = PHYSICAL.to_owned();
    for (old, new) in [
        ("\"0.3 um\"", "\"-0.3 um\""),
        ("[\"sun\"]\ndiameter = \"50 mm\"", "[\"sun\"]\ndiameter = \"0 mm\""),
        ("tip_diameter = \"174 mm\"", "tip_diameter = \"100 mm\""),
        ("shaft_diameter = \"50 mm\"", "shaft_diameter = \"55 mm\""),
        ("NU 206", "NU 2060"),
        ("benedict-kelley", "benedict"),
        ("member = \"carrier\"\nradius", "member = \"arm\"\nradius"),
        ("90 degC", "900 degC"),
        ("enclosure = 0.7", "enclosure = 7"),
        ("length = \"110 mm\"", "length = \"nan mm\""),
    ] {
        text = with(&text, old, new);
    }
    let errors = answer(&text).unwrap_err().to_string();
    // A value that cannot be read stops before the meaning is looked at.
    assert!(errors.contains("nan"), "{errors}");
    let errors = answer(&with(&text, "nan mm", "-110 mm")).unwrap_err().to_string();
    for part in
        ["-0.3", "diameter of 0", "tip", "55.0 mm", "NU 2060", "benedict", "arm", "900.0 °C", "factor of 7", "-110"]
    {
        assert!(errors.contains(part), "{part} is missing in\n{errors}");
    }
}

/// A drag beyond what the statics can take is refused, not dropped.
#[test]
fn regress_a_drag_beyond_all_bounds() {
    let text = with(PHYSICAL, "diameter = \"50 mm\"\nmaterial", "diameter = \"1e60 mm\"\nmaterial");
    let wrong = answer(&text).unwrap_err();
    assert!(wrong.iter().any(|d| d.code == Code::TooLarge), "{wrong}");
    // And one that is next to nothing is nothing.
    let text = with(PHYSICAL, "diameter = \"50 mm\"\nmaterial", "diameter = \"1e-40 mm\"\nmaterial");
    assert_eq!(answer(&text).unwrap().operations[0].solutions[0].losses_w.seal, 0.0);
}

/// Numbers that a builder, unlike a file, lets through.
#[test]
fn regress_physical_numbers_of_a_builder() {
    use willis::train::{BearingSpec, GeometrySpec, OilSpec, RotorSpec, SetSpec};
    use willis::units::{Angle, DynamicViscosity, Force, Length, Pressure, Temperature, Volume};
    let good = || GeometrySpec::new(Length::mm(2.0), Length::mm(20.0));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1e300] {
        for g in [GeometrySpec { addendum: Some(bad), ..good() }, GeometrySpec { poisson_ratio: Some(bad), ..good() }] {
            let set = SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).geometry(g);
            let train = Train::builder("x").members(["s", "c"]).terminals(["s", "c"]).set(set).build();
            if let Ok(train) = train {
                sound(&analyze(&train, &Selection::default()).expect("nothing to analyse"));
            }
        }
    }
    for bad in [-1.0, 0.0, -1e50, 1e50] {
        for g in [
            GeometrySpec { module: Length::m(bad), ..good() },
            GeometrySpec { width: Length::m(bad), ..good() },
            GeometrySpec { helix: Some(Angle::rad(bad)), ..good() },
            GeometrySpec { pressure_angle: Some(Angle::rad(bad)), ..good() },
            GeometrySpec { centre_distance: Some(Length::m(bad)), ..good() },
            GeometrySpec { dedendum: Some(bad), ..good() },
            GeometrySpec { youngs_modulus: Some(Pressure::pa(bad)), ..good() },
        ] {
            let set = SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).geometry(g);
            let train = Train::builder("x").members(["s", "c"]).terminals(["s", "c"]).set(set).build();
            if let Ok(train) = train {
                sound(&analyze(&train, &Selection::default()).expect("nothing to analyse"));
            }
        }
        let set = || SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).geometry(good());
        let oil = OilSpec {
            viscosity: Some(DynamicViscosity::pa_s(bad)),
            temperature: Some(Temperature::k(bad)),
            volume: Some(Volume::m3(bad)),
            ..OilSpec::default()
        };
        let bearing = BearingSpec {
            name: "b".into(),
            members: vec!["s".into()],
            designation: Some("6210".into()),
            radial_load: Some(Force::n(bad)),
            bore: Some(Length::m(bad)),
            ..BearingSpec::default()
        };
        let rotor = RotorSpec {
            name: "r".into(),
            member: "s".into(),
            radius: Length::m(bad),
            length: Length::m(bad),
            radial_gap: Length::m(bad),
            ..RotorSpec::default()
        };
        let all = Train::builder("x")
            .members(["s", "c"])
            .terminals(["s", "c"])
            .set(set())
            .oil(oil)
            .bearing(bearing)
            .rotor(rotor)
            .build();
        assert!(all.is_err(), "{bad}");
    }
}

// ---- Trains that nobody would build ----------------------------------------------------------

/// A train from a list of numbers: sets, meshes, shift elements and operations between few members,
/// mostly of a shape that is accepted.
fn contraption(numbers: &[usize]) -> String {
    const ROTORS: usize = 6;
    const EFFICIENCIES: [&str; 6] = ["1", "0.99", "0.9", "0.5", "{ forward = 0.98, backward = 0.9 }", "1e-3"];
    let mut numbers = numbers.iter().copied().chain(std::iter::repeat(0));
    let mut pick = |below: usize| numbers.next().unwrap_or(0) % below;
    let rotors = 2 + pick(ROTORS - 1);
    // Different members, the frame among them.
    let several = |pick: &mut dyn FnMut(usize) -> usize, count: usize| -> Vec<String> {
        let mut all: Vec<usize> = (0..=rotors).collect();
        let chosen = (0..count.min(rotors + 1)).map(|_| all.swap_remove(pick(all.len())));
        chosen.map(|k| if k == rotors { "frame".to_owned() } else { format!("m{k}") }).collect()
    };
    let quoted = |names: &[String]| names.iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ");
    let all: Vec<String> = (0..rotors).map(|k| format!("m{k}")).collect();
    let mut text = format!("format = 1\nname = \"contraption\"\nmembers = [{}]\n", quoted(&all));
    let mut terminals = several(&mut pick, 2 + rotors.min(3) / 2);
    terminals.retain(|t| t != "frame");
    text += &format!("terminals = [{}]\n", quoted(&terminals));
    for k in 0..pick(4) {
        let parts = several(&mut pick, 4);
        let [c, a, b] = [0, 1, 2].map(|k| parts[k].clone());
        let d = parts.get(3).cloned().unwrap_or_else(|| a.clone());
        let (x, y, z) = (12 + pick(40), 12 + pick(40), 60 + pick(60));
        text += &format!("[[set]]\nname = \"P{k}\"\ncarrier = \"{c}\"\nmesh_efficiency = {}\n", EFFICIENCIES[pick(6)]);
        text += &match pick(6) {
            0 => format!(
                "type = \"double-planet\"\nsun = {{ member = \"{a}\", teeth = {x} }}\nring = {{ member = \"{b}\", teeth = {z} }}\n"
            ),
            1 => format!(
                "type = \"stepped\"\nsuns = [ {{ member = \"{a}\", teeth = {x}, planet_teeth = {y} }}, {{ member = \"{d}\", teeth = {y}, planet_teeth = {x} }} ]\nrings = [ {{ member = \"{b}\", teeth = {z}, planet_teeth = {y} }} ]\n"
            ),
            2 => format!(
                "type = \"bevel\"\nsides = [ {{ member = \"{a}\", teeth = {x} }}, {{ member = \"{b}\", teeth = {y} }} ]\n"
            ),
            3 => format!(
                "type = \"ravigneaux\"\nsmall_sun = {{ member = \"{a}\", teeth = {x} }}\nlarge_sun = {{ member = \"{d}\", teeth = {y} }}\nring = {{ member = \"{b}\", teeth = {} }}\n",
                y + 2 * x
            ),
            _ => format!("sun = {{ member = \"{a}\", teeth = {x} }}\nring = {{ member = \"{b}\", teeth = {z} }}\n"),
        };
    }
    for _ in 0..pick(3) {
        let parts = several(&mut pick, 3);
        let (x, y) = (12 + pick(40), 12 + pick(40));
        text += &format!(
            "[[mesh]]\ngears = [ {{ member = \"{}\", teeth = {x} }}, {{ member = \"{}\", teeth = {y}, internal = {} }} ]\ncarrier = \"{}\"\nefficiency = {}\n",
            parts[1],
            parts[2],
            pick(2) == 0,
            parts[0],
            EFFICIENCIES[pick(6)]
        );
    }
    let elements = pick(4);
    for k in 0..elements {
        let mut pair = several(&mut pick, 2);
        let kind = ["clutch", "brake", "one-way", "clutch"][pick(4)];
        if kind == "brake" {
            pair.retain(|m| m != "frame");
            pair.truncate(1);
        }
        text += &format!("[[shift_element]]\nname = \"E{k}\"\nkind = \"{kind}\"\nmembers = [{}]\n", quoted(&pair));
    }
    let engaged: Vec<_> = (0..elements).filter(|_| pick(3) > 0).map(|k| format!("E{k}")).collect();
    text += &format!("[[state]]\nname = \"1\"\nengaged = [{}]\n", quoted(&engaged));
    for o in 0..1 + pick(2) {
        text += &format!("[[operation]]\nname = \"o{o}\"\n{}", ["", "state = \"1\"\n"][pick(2)]);
        let mut free = several(&mut pick, ROTORS + 1);
        free.retain(|m| m != "frame");
        let fixed = free.split_off(free.len() - pick(3).min(free.len() - 1));
        let speeds: Vec<_> = (0..(1 + usize::from(pick(4) == 0)).min(free.len()))
            .map(|k| format!("{} = \"{}\"", free[k], ["1000 rpm", "-300 rpm", "0 rpm", "1000 rpm"][pick(4)]))
            .collect();
        let open = terminals.iter().filter(|t| !fixed.contains(t));
        let mut loads: Vec<_> =
            open.map(|t| format!("{t} = \"{}\"", ["10 N m", "-25 N m", "0 N m"][pick(3)])).collect();
        loads.truncate(loads.len().saturating_sub(1 + pick(2)));
        text += &format!(
            "speeds = {{ {} }}\ntorques = {{ {} }}\nfixed = [{}]\n",
            speeds.join(", "),
            loads.join(", "),
            quoted(&fixed)
        );
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if cfg!(debug_assertions) { 400 } else { 4000 },
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn regress_damaged_examples(which in any::<prop::sample::Index>(), how in prop::collection::vec(any_damage(), 1..5)) {
        let all: Vec<String> = examples().into_iter().map(|(_, text)| text).collect();
        let text = damage(&all[which.index(all.len())], &how);
        let _ = answer(&text);
    }

    #[test]
    fn regress_damaged_physical_trains(how in prop::collection::vec(any_damage(), 1..4)) {
        let _ = answer(&damage(PHYSICAL, &how));
    }

    #[test]
    fn regress_contraptions(numbers in prop::collection::vec(any::<usize>(), 0..160)) {
        let _ = answer(&contraption(&numbers));
    }
}
