//! What the user reads when something is wrong: at least one input for every code, and the text
//! that it gives, under `snapshots/`.
//!
//! A change of a message is reviewed here as its reader would: does it say where, what is wrong
//! with the numbers, and what to do? `INSTA_UPDATE=always cargo test` rewrites the snapshots.

use willis::analysis::{Selection, analyze};
use willis::diagnostic::{Code, Diagnostics};
use willis::regimes::{LocateRequest, RegimeSelection, family, locate};
use willis::train::Train;

/// A good train; the cases below spoil it.
const REDUCER: &str = r#"format = 1
name = "reducer"
members = ["sun", "carrier"]
terminals = ["sun", "carrier"]

[[set]]
name = "P1"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "frame", teeth = 70 }
carrier = "carrier"
mesh_efficiency = 0.99

[[operation]]
name = "full load"
speeds = { sun = "1000 rpm" }
torques = { sun = "10 N m" }
"#;

/// A power split with its second path.
const SPLIT: &str = r#"format = 1
name = "split"
members = ["mg1", "engine", "ring"]
terminals = ["engine", "ring"]

[[set]]
name = "P1"
sun = { member = "mg1", teeth = 30 }
planet = { teeth = 24, count = 4 }
ring = { member = "ring", teeth = 78 }
carrier = "engine"
mesh_efficiency = 0.99

[[variator]]
name = "path"
members = ["mg1", "ring"]
efficiency = 0.9
ratio = { min = 0.1, max = 3 }

[[operation]]
name = "cruise"
speeds = { engine = "2000 rpm", ring = "1500 rpm" }
torques = { engine = "100 N m" }
"#;

/// A set with teeth and an oil.
const TOOTHED: &str = r#"format = 1
name = "toothed"
members = ["sun", "carrier"]
terminals = ["sun", "carrier"]

[oil]
name = "ISO VG 220"
temperature = "60 degC"

[[set]]
name = "P1"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "frame", teeth = 70 }
carrier = "carrier"
geometry = { module = "2 mm", width = "20 mm" }

[[operation]]
name = "full load"
speeds = { sun = "1000 rpm" }
torques = { sun = "10 N m" }
"#;

/// A set with three free members, a brake, a clutch and a shift table.
const TWO_SPEED: &str = r#"format = 1
name = "two speeds"
members = ["sun", "ring", "carrier"]
terminals = ["sun", "carrier"]

[[set]]
name = "P1"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "ring", teeth = 70 }
carrier = "carrier"
mesh_efficiency = 0.99

[[shift_element]]
name = "B"
kind = "brake"
members = ["ring"]

[[shift_element]]
name = "C"
kind = "clutch"
members = ["sun", "ring"]

[[state]]
name = "low"
engaged = ["B"]

[[state]]
name = "high"
engaged = ["C"]
"#;

/// Two external gears on the frame, and an operation.
const PAIR: &str = r#"format = 1
name = "pair"
members = ["a", "b"]
terminals = ["a", "b"]

[[mesh]]
gears = [ { member = "a", teeth = 20 }, { member = "b", teeth = 40 } ]
efficiency = 0.98

[[operation]]
name = "load"
speeds = { a = "100 rpm" }
torques = { a = "1 N m" }
"#;

/// Two sets on a free carrier; with these losses they lock or have two equilibria
/// (`examples/two-efficiencies.toml`, `examples/wolfrom-498-self-locking.toml`).
const TWO_EFFICIENCIES: &str = include_str!("../../../../examples/two-efficiencies.toml");
/// Three terminals: with some loads power enters at all of them.
const BAND: &str = include_str!("../../../../examples/esmail-fig1-band.toml");
const WOLFROM: &str = include_str!("../../../../examples/wolfrom-498-self-locking.toml");

/// The text with one part replaced, which must stand there exactly once.
fn with(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "{old:?} in\n{text}");
    text.replace(old, new)
}

/// The text with lines put at its end.
fn and(text: &str, more: &str) -> String {
    format!("{text}\n{more}\n")
}

/// A scenario with a source of these keys.
fn scenario(source: &str) -> String {
    let head = "[[scenario]]\nname = \"start\"\nduration = \"3 s\"\nstate = \"low\"";
    and(TWO_SPEED, &format!("{head}\n\n[[scenario.source]]\nmember = \"sun\"\n{source}"))
}

/// Everything the library has to say about a text.
fn diagnose(text: &str, selection: &Selection) -> Diagnostics {
    let reading = Train::read_toml(text);
    let Some(train) = &reading.train else { return reading.diagnostics };
    let mut all = match analyze(train, selection) {
        Err(errors) => errors,
        Ok(analysis) => {
            let mut all = Diagnostics::default();
            all.extend(analysis.diagnostics);
            all
        }
    };
    reading.locate(text, &mut all);
    all
}

fn check(name: &str, code: Code, text: &str, selection: &Selection) {
    let all = diagnose(text, selection);
    assert!(all.iter().any(|d| d.code == code), "{code} is not among\n{all}");
    for d in all.iter() {
        assert_eq!(d.severity, d.code.severity());
        if let Some(span) = &d.span {
            assert!(text.get(span.range()).is_some(), "{} spans {span:?}, not a piece of the text", d.code);
        }
    }
    insta::with_settings!({ omit_expression => true }, {
        insta::assert_snapshot!(name, all.render("train.toml", text, false));
    });
}

macro_rules! cases {
    ($($name:ident: $code:ident, $text:expr $(, $key:ident = $value:literal)*;)+) => {
        $(
            #[test]
            fn $name() {
                #[allow(unused_mut)]
                let mut selection = Selection::default();
                $(selection.$key = Some($value.to_owned());)*
                check(stringify!($name), Code::$code, &$text, &selection);
            }
        )+

        const COVERED: &[Code] = &[$(Code::$code),+];
    };
}

#[test]
fn regress_every_code_has_a_case() {
    // E002 is about files, which the library never touches: crates/willis-cli/tests/cli.rs has it.
    // E208 to E210 are about questions other than `analyze`: `regress_e208` and `regress_e209` below; axes of studies
    // have `what_is_wrong_with_an_axis_is_told` in study.rs, E211 has `a_sweep_that_is_stopped_says_so` there, E212
    // `what_would_take_long_is_refused_before_it_begins` in tests/study.
    // W320 needs a table: `a_map_is_read_where_the_machine_runs` in tests/statics/variators.rs.
    // W322 has `what_cannot_be_right_is_said_with_its_numbers` in tests/statics.
    // W331 needs laws: `several_temperatures_are_told` in tests/heat.
    // W318 needs a tolerance: `measured_speeds_are_taken_within_a_tolerance` in tests/statics.
    let elsewhere = [
        Code::Unreadable,
        Code::Unfit,
        Code::NoInertia,
        Code::BadAxis,
        Code::Cancelled,
        Code::TooLong,
        Code::SpeedsYield,
        Code::OutsideMap,
        Code::SeveralTemperatures,
        Code::Implausible,
    ];
    let missing: Vec<_> =
        Code::ALL.iter().filter(|c| !elsewhere.contains(c) && !COVERED.contains(c)).map(|c| c.as_str()).collect();
    assert!(missing.is_empty(), "no case for {missing:?}");
}

#[test]
fn regress_e208() {
    let train = Train::from_toml(REDUCER).unwrap();
    let all = RegimeSelection::default();
    let wrong = [
        ("a table over all ratios", family(&train, &all).unwrap_err()),
        ("a place without speeds", locate(&train, &LocateRequest::default()).unwrap_err()),
    ];
    let mut text = String::new();
    for (what, wrong) in wrong {
        assert!(wrong.iter().all(|d| d.code == Code::Unfit), "{what}: {wrong}");
        text += &format!("{what}\n{}\n", wrong.render("train.toml", REDUCER, false));
    }
    insta::with_settings!({ omit_expression => true }, {
        insta::assert_snapshot!(text);
    });
}

/// Motions need inertia and speeds that agree: what `simulate` says before it starts.
#[test]
fn regress_e209() {
    let motion = |inertias: &str, more: &str| {
        let scenario = "[[scenario]]\nname = \"start\"\nduration = \"3 s\"\nstate = \"low\"";
        let text = with(TWO_SPEED, "terminals =", &format!("inertias = {{ {inertias} }}\nterminals ="));
        and(&text, &format!("{scenario}\n{more}"))
    };
    let light = motion("ring = \"1 kg m^2\"", "");
    let neutral = motion("sun = \"1 kg m^2\"", "").replace("state = \"low\"", "");
    let speeds = motion(
        "sun = \"1 kg m^2\", ring = \"1 kg m^2\"",
        "initial_speeds = { sun = \"10 rad/s\", ring = \"0 rad/s\", carrier = \"10 rad/s\" }",
    );
    let mut text = String::new();
    for (train, code) in [(light, Code::NoInertia), (neutral, Code::NoInertia), (speeds, Code::ContradictorySpeeds)] {
        let reading = Train::read_toml(&train);
        let own = reading.train.as_ref().expect("a good train");
        let mut all = willis::dynamics::simulate(own, "start", &Default::default(), &mut ()).expect_err("refused");
        reading.locate(&train, &mut all);
        assert!(all.iter().any(|d| d.code == code), "{all}");
        text += &all.render("train.toml", &train, false);
        text.push('\n');
    }
    insta::with_settings!({ omit_expression => true }, {
        insta::assert_snapshot!(text);
    });
}

#[test]
fn regress_a_long_list_is_cut() {
    let keys: String = (0..60).map(|k| format!("key_{k} = 1\n")).collect();
    let text = format!("format = 1\nname = \"x\"\nmembers = [\"a\"]\n{keys}");
    let shown = diagnose(&text, &Selection::default()).render("train.toml", &text, false);
    assert_eq!(shown.matches("error[E004]").count(), 50);
    assert!(shown.contains("and 10 more"), "{shown}");
}

cases! {
    // E001 Syntax
    regress_e001_unquoted_text: Syntax, with(REDUCER, r#"carrier = "carrier""#, "carrier = carrier");
    regress_e001_unclosed_table: Syntax, with(REDUCER, "teeth = 70 }", "teeth = 70");
    regress_e001_key_twice: Syntax, with(REDUCER, "mesh_efficiency = 0.99", "mesh_efficiency = 0.99\nmesh_efficiency = 0.98");
    regress_e001_decimal_comma: Syntax, with(REDUCER, "0.99", "0,99");
    regress_e001_crlf: Syntax, with(REDUCER, "0.99", "0,99").replace('\n', "\r\n");
    regress_e001_not_toml: Syntax, "<?xml version=\"1.0\"?>\n<train/>\n";

    // E003 Format
    regress_e003_unknown: Format, with(REDUCER, "format = 1", "format = 2");
    regress_e003_text: Format, with(REDUCER, "format = 1", "format = \"1\"");

    // E004 UnknownKey
    regress_e004_misspelt: UnknownKey, with(REDUCER, "mesh_efficiency", "mesh_eficiency");
    regress_e004_misspelt_required: UnknownKey, with(REDUCER, "members =", "membres =");
    regress_e004_no_such_key: UnknownKey, with(REDUCER, "mesh_efficiency = 0.99", "module = 2.5");
    regress_e004_key_of_another_type: UnknownKey, with(REDUCER, "ring = {", "rings = {");
    regress_e004_in_a_gear: UnknownKey, with(PAIR, "\"a\", teeth = 20", "\"a\", tooth = 20");
    regress_e004_in_an_efficiency: UnknownKey, with(PAIR, "0.98", "{ forward = 0.98, backwards = 0.97 }");
    regress_e004_unicode: UnknownKey, with(REDUCER, "mesh_efficiency = 0.99", "\"Wirkungsgrad η\" = 0.99");

    // E005 MissingKey
    regress_e005_empty_file: MissingKey, "";
    regress_e005_format: MissingKey, with(REDUCER, "format = 1\n", "");
    regress_e005_ring: MissingKey, with(REDUCER, "ring = { member = \"frame\", teeth = 70 }\n", "");
    regress_e005_teeth: MissingKey, with(PAIR, "\"a\", teeth = 20", "\"a\"");
    regress_e005_one_direction: MissingKey, with(PAIR, "0.98", "{ forward = 0.98 }");
    regress_e005_no_members: MissingKey, "format = 1\nname = \"nothing\"\nmembers = []\n";
    regress_e005_long_planet: MissingKey, RAVIGNEAUX.replace("LONG", "count = 3").replace("MORE", "");

    // E006 WrongType
    regress_e006_number_for_text: WrongType, with(REDUCER, "name = \"reducer\"", "name = 1");
    regress_e006_text_for_list: WrongType, with(REDUCER, "members = [\"sun\", \"carrier\"]", "members = \"sun, carrier\"");
    regress_e006_number_in_list: WrongType, with(REDUCER, "members = [\"sun\", \"carrier\"]", "members = [\"sun\", \"carrier\", 3]");
    regress_e006_text_for_teeth: WrongType, with(REDUCER, "teeth = 30", "teeth = \"30\"");
    regress_e006_fraction_of_a_tooth: WrongType, with(REDUCER, "teeth = 30", "teeth = 30.5");
    regress_e006_text_for_table: WrongType, with(REDUCER, "sun = { member = \"sun\", teeth = 30 }", "sun = \"sun\"");
    regress_e006_single_brackets: WrongType, with(REDUCER, "[[set]]", "[set]");
    regress_e006_efficiency_in_quotes: WrongType, with(REDUCER, "0.99", "\"99 %\"");
    regress_e006_three_gears: WrongType,
        with(PAIR, "teeth = 40 } ]", "teeth = 40 }, { member = \"c\", teeth = 40 } ]");
    regress_e006_flag: WrongType, with(PAIR, "teeth = 40 }", "teeth = 40, internal = 1 }");
    regress_e006_choice: WrongType, with(PAIR, "efficiency = 0.98", "sense = true");
    regress_e006_speeds: WrongType, with(PAIR, "speeds = { a = \"100 rpm\" }", "speeds = \"100 rpm\"");

    // E007 Quantity
    regress_e007_bare_number: Quantity, with(PAIR, "\"100 rpm\"", "100");
    regress_e007_no_unit: Quantity, with(PAIR, "100 rpm", "100");
    regress_e007_wrong_dimension: Quantity, with(PAIR, "100 rpm", "100 N m");
    regress_e007_misspelt_unit: Quantity, with(PAIR, "1 N m", "1 kNM");
    regress_e007_unit_of_the_workshop: Quantity, with(PAIR, "100 rpm", "100 U/mn");
    regress_e007_energy_for_torque: Quantity, with(PAIR, "1 N m", "350 J");
    regress_e001_decimal_comma_inside: Syntax, with(PAIR, "\"100 rpm\"", "1450,5");
    regress_e007_hertz: Quantity, with(PAIR, "100 rpm", "100 Hz");
    regress_e007_per_second: Quantity, with(PAIR, "100 rpm", "157 1/s");
    regress_e007_decimal_comma: Quantity, with(PAIR, "100 rpm", "1450,5 rpm");
    regress_e007_thousands: Quantity, with(PAIR, "100 rpm", "1 450 rpm");
    regress_e007_not_a_number: Quantity, with(PAIR, "100 rpm", "nan rpm");
    regress_e007_infinite: Quantity, with(PAIR, "100 rpm", "inf rpm");
    regress_e007_exponent: Quantity, with(PAIR, "100 rpm", "1e999 rpm");
    regress_e007_planet_without_quotes: Quantity, with(REDUCER, "{ sun = \"1000 rpm\" }", "{ P1.planet = \"1000 rpm\" }");
    regress_e007_list: Quantity, with(PAIR, "\"100 rpm\"", "[\"100 rpm\"]");

    // E008 OutOfRange
    regress_e008_negative_teeth: OutOfRange, with(PAIR, "teeth = 40", "teeth = -40");
    regress_e008_no_teeth: OutOfRange, with(PAIR, "teeth = 40", "teeth = 0");
    regress_e008_too_many_teeth: OutOfRange, with(PAIR, "teeth = 40", "teeth = 1_000_000_000");
    regress_e008_number_too_large: OutOfRange, with(PAIR, "teeth = 40", "teeth = 99999999999999999999");
    regress_e008_count: OutOfRange, with(REDUCER, "count = 4", "count = 0");
    regress_e008_percent: OutOfRange, with(REDUCER, "0.99", "99");
    regress_e008_above_one: OutOfRange, with(REDUCER, "0.99", "1.02");
    regress_e008_barely_above_one: OutOfRange, with(REDUCER, "0.99", "1.0000000000000000001");
    regress_e008_negative_efficiency: OutOfRange, with(REDUCER, "0.99", "-0.99");
    regress_e008_nan: OutOfRange, with(REDUCER, "0.99", "nan");
    regress_e008_one_direction: OutOfRange, with(PAIR, "0.98", "{ forward = 0.98, backward = 97 }");

    // E101 UnknownName
    regress_e101_misspelt: UnknownName, with(REDUCER, "carrier = \"carrier\"", "carrier = \"carier\"");
    regress_e101_upper_case: UnknownName, with(REDUCER, "carrier = \"carrier\"", "carrier = \"Carrier\"");
    regress_e101_nothing_like_it: UnknownName, with(REDUCER, "carrier = \"carrier\"", "carrier = \"spider\"");
    regress_e101_one_letter: UnknownName, with(PAIR, "member = \"a\"", "member = \"x\"");
    regress_e101_terminal: UnknownName, with(REDUCER, "terminals = [\"sun\", \"carrier\"]", "terminals = [\"sun\", \"output\"]");
    regress_e101_speed: UnknownName, with(REDUCER, "speeds = { sun", "speeds = { sum");
    regress_e101_planet: UnknownName, with(REDUCER, "speeds = { sun", "speeds = { \"P1.plannet\"");
    regress_e101_shift_element: UnknownName, with(TWO_SPEED, "engaged = [\"B\"]", "engaged = [\"Brake\"]");
    regress_e101_no_shift_elements: UnknownName, and(REDUCER, "[[state]]\nname = \"1\"\nengaged = [\"B\"]");
    regress_e101_state: UnknownName, and(TWO_SPEED, "[[operation]]\nname = \"o\"\nstate = \"third\"");
    regress_e101_choice: UnknownName, with(REDUCER, "name = \"P1\"", "name = \"P1\"\ntype = \"simpel\"");
    regress_e101_choice_nothing_like_it: UnknownName, with(TWO_SPEED, "kind = \"brake\"", "kind = \"dog\"");

    // E102 DuplicateName
    regress_e102_member: DuplicateName, with(PAIR, "members = [\"a\", \"b\"]", "members = [\"a\", \"b\", \"a\"]");
    regress_e102_terminal: DuplicateName, with(PAIR, "terminals = [\"a\", \"b\"]", "terminals = [\"a\", \"a\"]");
    regress_e102_state: DuplicateName, with(TWO_SPEED, "\"high\"", "\"low\"");
    regress_e102_shift_element: DuplicateName, with(TWO_SPEED, "name = \"C\"", "name = \"B\"");
    regress_e102_engaged_twice: DuplicateName, with(TWO_SPEED, "engaged = [\"B\"]", "engaged = [\"B\", \"B\"]");
    regress_e102_set: DuplicateName, and(REDUCER, "[[set]]\nname = \"P1\"\nsun = { member = \"sun\", teeth = 30 }\nring = { member = \"frame\", teeth = 70 }\ncarrier = \"carrier\"");

    // E103 BadName
    regress_e103_empty: BadName, with(PAIR, "members = [\"a\", \"b\"]", "members = [\"a\", \"b\", \"\"]");
    regress_e103_dot: BadName, with(PAIR, "members = [\"a\", \"b\"]", "members = [\"a\", \"b\", \"P1.planet\"]");
    regress_e103_frame: BadName, with(PAIR, "members = [\"a\", \"b\"]", "members = [\"frame\", \"a\", \"b\"]");
    regress_e103_long: BadName, with(PAIR, "members = [\"a\", \"b\"]", &format!("members = [\"a\", \"b\", \"{}\"]", "long ".repeat(14)));
    regress_e103_control: BadName, with(PAIR, "members = [\"a\", \"b\"]", "members = [\"a\", \"b\", \"\\u001b[31mred\"]");
    regress_e103_frame_terminal: BadName, with(REDUCER, "terminals = [\"sun\", \"carrier\"]", "terminals = [\"sun\", \"carrier\", \"frame\"]");
    regress_e103_frame_output: BadName, with(PAIR, "terminals = [\"a\", \"b\"]", "terminals = [\"a\", \"b\"]\noutput = \"frame\"");
    regress_e103_frame_output_of_a_state: BadName, with(TWO_SPEED, "engaged = [\"C\"]", "engaged = [\"C\"]\noutput = \"frame\"");

    // E104 ImpossibleMesh
    regress_e104_itself: ImpossibleMesh, with(PAIR, "member = \"b\"", "member = \"a\"");
    regress_e104_two_internal: ImpossibleMesh,
        with(&with(PAIR, "teeth = 20", "teeth = 20, internal = true"), "teeth = 40", "teeth = 40, internal = true");
    regress_e104_own_carrier: ImpossibleMesh, with(PAIR, "efficiency = 0.98", "carrier = \"a\"");
    regress_e104_sun_is_carrier: ImpossibleMesh, with(REDUCER, "member = \"sun\"", "member = \"carrier\"");
    regress_e104_planet_is_carrier: ImpossibleMesh, with(REDUCER, "carrier = \"carrier\"", "carrier = \"P1.planet\"");
    regress_e104_own_planet: ImpossibleMesh, with(REDUCER, "member = \"sun\"", "member = \"P1.planet\"");

    // E105 IncompleteSet
    regress_e105_stepped: IncompleteSet, STEPPED.replace("RINGS", "");
    regress_e105_bevel: IncompleteSet,
        "format = 1\nname = \"differential\"\nmembers = [\"left\", \"case\"]\n\n[[set]]\nname = \"D\"\ntype = \"bevel\"\nsides = [ { member = \"left\", teeth = 16 } ]\ncarrier = \"case\"\n";
    regress_e105_ravigneaux: IncompleteSet,
        with(&RAVIGNEAUX.replace("LONG", "teeth = 20, count = 3").replace("MORE", ""), "large_sun = { member = \"large\", teeth = 30 }\n", "");

    // E106 NotCoaxial
    regress_e106_planet: NotCoaxial, with(REDUCER, "teeth = 20", "teeth = 25");
    regress_e106_ring: NotCoaxial, with(REDUCER, "teeth = 70", "teeth = 80");
    regress_e106_ring_smaller_than_sun: NotCoaxial,
        with(&with(REDUCER, "planet = { teeth = 20, count = 4 }\n", ""), "teeth = 70", "teeth = 24");
    regress_e106_ring_as_large_as_sun: NotCoaxial,
        with(&with(REDUCER, "planet = { teeth = 20, count = 4 }\n", ""), "teeth = 70", "teeth = 30");
    regress_e106_ravigneaux: NotCoaxial,
        RAVIGNEAUX.replace("LONG", "teeth = 25, count = 3").replace("MORE", "ring = { member = \"ring\", teeth = 70 }");

    // E107 ShiftElement
    regress_e107_clutch_of_one: ShiftElement, with(TWO_SPEED, "[\"sun\", \"ring\"]\n\n[[state]]\nname = \"low\"", "[\"sun\"]\n\n[[state]]\nname = \"low\"");
    regress_e107_brake_of_two: ShiftElement, with(TWO_SPEED, "members = [\"ring\"]", "members = [\"ring\", \"frame\"]");
    regress_e107_itself: ShiftElement, with(TWO_SPEED, "[\"sun\", \"ring\"]\n\n[[state]]\nname = \"low\"", "[\"sun\", \"sun\"]\n\n[[state]]\nname = \"low\"");
    regress_e107_brake_on_the_frame: ShiftElement, with(TWO_SPEED, "members = [\"ring\"]", "members = [\"frame\"]");

    // E108 TooLarge
    regress_e108_meshes: TooLarge,
        and(PAIR, &"[[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]\n".repeat(10_000));
    regress_e108_members: TooLarge,
        with(PAIR, "members = [\"a\", \"b\"]", &format!("members = [\"a\", \"b\"{}]", (0..1200).map(|k| format!(", \"m{k}\"")).collect::<String>()));

    // E109 Conflict
    regress_e109_sense: Conflict, with(PAIR, "teeth = 40 } ]", "teeth = 40, internal = true } ]\nsense = \"opposite\"");
    regress_e109_load_twice: Conflict, and(PAIR, "powers = { a = \"1 kW\" }");
    regress_e109_two_efficiencies: Conflict, with(REDUCER, "mesh_efficiency = 0.99", "mesh_efficiency = 0.99\nbasic_efficiency = 0.98");
    regress_e109_basic_efficiency_of_three: Conflict,
        STEPPED.replace("RINGS", "rings = [ { member = \"ring\", teeth = 60, planet_teeth = 20 }, { member = \"out\", teeth = 58, planet_teeth = 18 } ]\nbasic_efficiency = 0.98");

    // E112 BadTable
    regress_e112_falling_speeds: BadTable, and(TWO_SPEED, "[[drag]]\nname = \"bearing\"\nmembers = [\"sun\"]\ntable = [ [\"0 rpm\", \"1 N m\"], [\"-10 rpm\", \"1 N m\"] ]");
    regress_e112_falling_times: BadTable, scenario("torque = { type = \"table\", points = [ [\"0 s\", \"1 N m\"], [\"2 s\", \"3 N m\"], [\"1 s\", \"5 N m\"] ] }");

    // E113 BadFormula
    regress_e113_bracket: BadFormula, scenario("torque = { type = \"expression\", formula = \"60 + 200*sin(4*PI*t\" }");
    regress_e113_variable: BadFormula, scenario("torque = { type = \"expression\", formula = \"60 - 3*sun\" }");

    // The same codes in the dynamic layer
    regress_motion_signal_type: UnknownName, scenario("torque = { type = \"sin\", amplitude = \"1 N m\" }");
    regress_motion_signal_keys: MissingKey, scenario("torque = { type = \"sine\", amplitude = \"1 N m\", freq = \"2 Hz\" }");
    regress_motion_formula_member: UnknownName, scenario("torque = { type = \"expression\", formula = \"5 - 0.1*w_carier\" }");
    regress_motion_formula_hyphen: UnknownName, scenario("torque = { type = \"expression\", formula = \"w_mg-1\" }").replace("\"sun\"", "\"mg-1\"");
    regress_motion_two_kinds: Conflict, scenario("torque = \"5 N m\"\nspeed = \"100 rpm\"");
    regress_motion_no_kind: MissingKey, scenario("name = \"engine\"");
    regress_motion_frame: HeldAndDriven, scenario("torque = \"5 N m\"").replace("member = \"sun\"\ntorque = ", "member = \"frame\"\ntorque = ");
    regress_motion_end_before_start: OutOfRange, scenario("torque = \"5 N m\"").replace("duration = \"3 s\"", "start = \"5 s\"\nend = \"3 s\"");
    regress_motion_no_file: Unreadable, scenario("torque = { type = \"csv\", file = \"load.csv\", time = \"t\", value = \"torque\" }");
    regress_motion_shaft: MissingKey, and(TWO_SPEED, "[[shaft]]\nname = \"output\"\nmembers = [\"carrier\"]\nbacklash = \"1 deg\"");
    regress_motion_capacity: MissingKey, with(TWO_SPEED, "members = [\"ring\"]", "members = [\"ring\"]\nfriction = 0.12");
    regress_motion_loss_table: Conflict, with(PAIR, "efficiency = 0.98", "efficiency = 0.98\nloss_table = [ { speed = \"0 rpm\", forward = 0.9, backward = 98 } ]");

    regress_motion_stiffness: OutOfRange, and(TWO_SPEED, "[[shaft]]\nname = \"output\"\nmembers = [\"carrier\"]\nstiffness = \"-1 N m/rad\"");
    regress_oil_thin: OutOfRange, with(TOOTHED, "name = \"ISO VG 220\"", "viscosity_40 = \"220 mm^2/s\"\nviscosity_100 = \"1e-60 mm^2/s\"");
    regress_oil_thick: OutOfRange, with(TOOTHED, "name = \"ISO VG 220\"", "viscosity = \"1e9 Pa s\"");

    // E201 ContradictorySpeeds
    regress_e201_two_speeds: ContradictorySpeeds, with(PAIR, "{ a = \"100 rpm\" }", "{ a = \"100 rpm\", b = \"100 rpm\" }");
    regress_e201_three_speeds: ContradictorySpeeds, with(REDUCER, "{ sun = \"1000 rpm\" }", "{ sun = \"1000 rpm\", carrier = \"1 rpm\", \"P1.planet\" = \"2 rpm\" }");
    regress_e201_locked: ContradictorySpeeds,
        and(TWO_SPEED, "[[state]]\nname = \"both\"\nengaged = [\"B\", \"C\"]\n[[operation]]\nname = \"o\"\nstate = \"both\"\nspeeds = { sun = \"1000 rpm\" }");
    regress_e201_redundant_meshes: ContradictorySpeeds,
        and(&with(PAIR, "{ a = \"100 rpm\" }", "{ a = \"100 rpm\", b = \"100 rpm\" }"), "[[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]");

    // E202 MissingTorque
    regress_e202_none: MissingTorque, with(PAIR, "torques = { a = \"1 N m\" }\n", "");
    regress_e202_one_of_three: MissingTorque,
        with(&with(REDUCER, "terminals = [\"sun\", \"carrier\"]", "terminals = [\"sun\", \"carrier\", \"P1.planet\"]"), "torques = { sun = \"10 N m\" }\n", "");
    regress_e202_turn_as_one: MissingTorque,
        and(TWO_SPEED, "[[operation]]\nname = \"o\"\nstate = \"high\"\nspeeds = { sun = \"1000 rpm\" }");

    regress_e202_same_shaft: MissingTorque,
        and(&with(TWO_SPEED, "[\"sun\", \"ring\"]\n\n[[state]]", "[\"sun\", \"carrier\"]\n\n[[state]]"), "[[operation]]\nname = \"o\"\nstate = \"high\"\nspeeds = { sun = \"1000 rpm\" }");

    regress_e202_a_freedom_without_a_terminal: MissingTorque,
        and(&with(TWO_SPEED, "members = [\"sun\", \"ring\", \"carrier\"]", "members = [\"sun\", \"ring\", \"carrier\", \"loose\"]"), "[[operation]]\nname = \"o\"\nstate = \"high\"\nspeeds = { sun = \"1000 rpm\", loose = \"3 rpm\" }");

    // E203 TooManyTorques
    regress_e203_both: TooManyTorques, with(PAIR, "{ a = \"1 N m\" }", "{ a = \"1 N m\", b = \"-2 N m\" }");

    // E204 NotATerminal
    regress_e204_torque: NotATerminal, with(REDUCER, "torques = { sun", "torques = { \"P1.planet\"");
    regress_e204_power: NotATerminal, with(REDUCER, "torques = { sun = \"10 N m\" }", "powers = { \"P1.planet\" = \"10 W\" }");

    // E205 HeldAndDriven
    regress_e205_speed: HeldAndDriven, and(REDUCER, "fixed = [\"sun\"]");
    regress_e205_twice: HeldAndDriven, and(REDUCER, "fixed = [\"carrier\", \"carrier\"]");
    regress_e205_torque: HeldAndDriven, with(REDUCER, "speeds = { sun = \"1000 rpm\" }", "fixed = [\"sun\"]");
    regress_e205_frame: HeldAndDriven, with(REDUCER, "{ sun = \"1000 rpm\" }", "{ frame = \"0 rpm\" }");

    // E206 PowerAtRest
    regress_e206_at_rest: PowerAtRest,
        and(TWO_SPEED, "[[operation]]\nname = \"hill hold\"\nspeeds = { sun = \"0 rpm\", carrier = \"300 rpm\" }\npowers = { sun = \"5 kW\" }");
    regress_e206_undetermined: PowerAtRest,
        and(TWO_SPEED, "[[operation]]\nname = \"o\"\nspeeds = { sun = \"100 rpm\" }\npowers = { carrier = \"5 kW\" }");

    // E207 UnknownSelection
    regress_e207_state: UnknownSelection, TWO_SPEED, state = "lo";
    regress_e207_no_states: UnknownSelection, REDUCER, state = "1";
    regress_e207_operation: UnknownSelection, REDUCER, operation = "full laod";

    // W301 NearlyCoaxial
    regress_w301_simple: NearlyCoaxial, with(REDUCER, "teeth = 20", "teeth = 19");
    regress_w301_stepped: NearlyCoaxial,
        STEPPED.replace("RINGS", "rings = [ { member = \"ring\", teeth = 60, planet_teeth = 18 } ]");
    regress_w301_stepped_modules: NearlyCoaxial,
        STEPPED.replace("RINGS", "rings = [ { member = \"ring\", teeth = 99, planet_teeth = 20 } ]");

    // W302 UnequalSpacing
    regress_w302_simple: UnequalSpacing, with(REDUCER, "count = 4", "count = 3");
    regress_w302_prime: UnequalSpacing,
        with(&with(&with(REDUCER, "teeth = 30", "teeth = 31"), "teeth = 70", "teeth = 72"), "planet = { teeth = 20, count = 4 }", "planet = { count = 4 }");
    regress_w302_stepped: UnequalSpacing,
        STEPPED.replace("RINGS", "rings = [ { member = \"ring\", teeth = 61, planet_teeth = 19 } ]\nplanet = { count = 3 }");

    // W303 PlanetsTouch
    regress_w303_simple: PlanetsTouch, with(REDUCER, "count = 4", "count = 10");

    // W304 NominalPlanet
    regress_w304_simple: NominalPlanet, with(&with(REDUCER, "teeth = 20, ", ""), "teeth = 70", "teeth = 71");

    // W305 Unconnected
    regress_w305_member: Unconnected, with(PAIR, "members = [\"a\", \"b\"]", "members = [\"a\", \"b\", \"oil pump\"]");

    // W306 Undetermined
    regress_w306_state: Undetermined, and(TWO_SPEED, "[[state]]\nname = \"neutral\"\nengaged = []");
    regress_w306_speed_missing: Undetermined,
        and(TWO_SPEED, "[[operation]]\nname = \"o\"\nspeeds = { sun = \"1000 rpm\" }\ntorques = { sun = \"10 N m\" }");
    regress_w306_idle: Undetermined, LOOSE;

    // W307 KinematicallyLocked
    regress_w307_state: KinematicallyLocked, and(TWO_SPEED, "[[state]]\nname = \"park\"\nengaged = [\"B\", \"C\"]");
    regress_w307_operation: KinematicallyLocked, with(PAIR, "speeds = { a = \"100 rpm\" }\ntorques = { a = \"1 N m\" }", "fixed = [\"a\"]");
    regress_w307_output_at_rest: KinematicallyLocked,
        with(TWO_SPEED, "engaged = [\"B\"]", "engaged = [\"B\"]\noutput = \"ring\"");

    // W308 Indeterminate
    regress_w308_two_meshes: Indeterminate,
        and(PAIR, "[[mesh]]\ngears = [ { member = \"a\", teeth = 20 }, { member = \"b\", teeth = 40 } ]");

    // W309 SelfLocking
    regress_w309_wolfrom: SelfLocking, WOLFROM;
    regress_w309_long_chain: SelfLocking, long_chain();

    // W310 SeveralSolutions
    regress_w310_two_efficiencies: SeveralSolutions, TWO_EFFICIENCIES;

    // W311 AllDissipated
    regress_w311_band: AllDissipated, BAND;

    // W312 OneWay
    regress_w312_speed: OneWay, ONE_WAY;
    regress_w312_torque: OneWay, and(ONE_WAY, "[[operation]]\nname = \"coast\"\nstate = \"low\"\nspeeds = { sun = \"1000 rpm\" }\ntorques = { sun = \"-10 N m\" }");

    // W313 NotEnumerated
    regress_w313_many_wedges: NotEnumerated, many_wedges();

    // E110 ImpossibleGeometry
    regress_e110_pointed_tip: ImpossibleGeometry, with(TOOTHED, "teeth = 30", "teeth = 30, addendum = 2.4");
    regress_e110_no_contact: ImpossibleGeometry, with(TOOTHED, "width = \"20 mm\"", "width = \"20 mm\", centre_distance = \"60 mm\"");
    regress_w314_tip_below_base: DoubtfulGeometry, with(TOOTHED, "teeth = 70", "teeth = 70, tip_diameter = \"120 mm\"");
    regress_e110_two_circles: ImpossibleGeometry, with(TOOTHED, "teeth = 30", "teeth = 30, shift = 0.4");

    // E111 ImpossibleBearing
    regress_e111_shaft: ImpossibleBearing, and(TOOTHED, "[[bearing]]\nname = \"b\"\nmembers = [\"sun\"]\ndesignation = \"6210\"\nshaft_diameter = \"40 mm\"");
    regress_e111_ring_inside_out: ImpossibleBearing,
        and(TOOTHED, "[[bearing]]\nname = \"b\"\nmembers = [\"sun\"]\nkind = \"cylindrical-roller\"\nbore = \"90 mm\"\noutside_diameter = \"50 mm\"\nwidth = \"20 mm\"");

    // The physical layer, by codes that others have too.
    regress_e005_law_without_oil: MissingKey,
        and(&with(TOOTHED, "[oil]\nname = \"ISO VG 220\"\ntemperature = \"60 degC\"\n", ""), "[laws]\nmesh_friction = \"schlenk\"");
    regress_e005_bearing_without_oil: MissingKey,
        and(&with(TOOTHED, "[oil]\nname = \"ISO VG 220\"\ntemperature = \"60 degC\"\n", ""), "[[bearing]]\nname = \"b\"\nmembers = [\"sun\"]\ndesignation = \"6210\"");
    regress_e005_temperature_without_oil: MissingKey, and(REDUCER, "temperature = \"60 degC\"");
    regress_e005_churning_without_volume: MissingKey, with(TOOTHED, "teeth = 30", "teeth = 30, immersion = \"10 mm\"");
    regress_e007_module_without_unit: Quantity, with(TOOTHED, "module = \"2 mm\"", "module = 2");
    regress_e008_physical: OutOfRange,
        with(&with(TOOTHED, "width = \"20 mm\"", "width = \"0 mm\", roughness = \"-0.4 um\", poisson_ratio = 0.7"), "60 degC", "700 degC");
    regress_e101_law: UnknownName, and(TOOTHED, "[laws]\nmesh_friction = \"schlenck\"");
    regress_e101_oil: UnknownName, with(TOOTHED, "ISO VG 220", "ISO VG 221");
    regress_e101_bearing: UnknownName, and(TOOTHED, "[[bearing]]\nname = \"b\"\nmembers = [\"sun\"]\ndesignation = \"62010\"");
    regress_e107_planets_of_two_sets: ShiftElement,
        and(TOOTHED, "[[set]]\nname = \"P2\"\nsun = { member = \"sun\", teeth = 30 }\nplanet = { teeth = 20, count = 2 }\nring = { member = \"frame\", teeth = 70 }\ncarrier = \"carrier\"\n\n[[drag]]\nname = \"d\"\nmembers = [\"P1.planet\", \"P2.planet\"]\ncoulomb = \"1 N m\"");
    regress_e107_bearing: ShiftElement, and(TOOTHED, "[[bearing]]\nname = \"b\"\nmembers = []\ndesignation = \"6210\"");
    regress_e109_oil_twice: Conflict, with(TOOTHED, "temperature =", "viscosity_40 = \"220 mm^2/s\"\ntemperature =");

    // W314 DoubtfulGeometry
    regress_e114_itself: Variator, with(SPLIT, "[\"mg1\", \"ring\"]", "[\"mg1\", \"mg1\"]");
    regress_e114_three: Variator, with(SPLIT, "[\"mg1\", \"ring\"]", "[\"mg1\", \"ring\", \"engine\"]");
    regress_e114_store_without_bus: Variator, with(SPLIT, "efficiency = 0.9\n", "efficiency = 0.9\nstore = \"5 kW\"\n");
    regress_e114_ratio: Variator, with(SPLIT, "min = 0.1, max = 3", "min = 3, max = 0.1");
    regress_e202_beside_a_variator: MissingTorque, with(SPLIT, "torques = { engine = \"100 N m\" }", "");
    regress_w319_ratio: BeyondLimit, with(SPLIT, "max = 3", "max = 2");
    regress_w321_standing: VariatorAtRest,
        with(&with(SPLIT, "engine = \"2000 rpm\", ring = \"1500 rpm\"", "mg1 = \"0 rpm\", ring = \"0 rpm\""), "terminals = [", "terminals = [\"mg1\", ");
    regress_w314_undercut: DoubtfulGeometry,
        with(&with(&with(TOOTHED, "teeth = 30", "teeth = 12"), "teeth = 20", "teeth = 29"), "teeth = 70", "teeth = 70");

    // W315 DoubtfulBearing
    regress_w315_bore: DoubtfulBearing,
        and(TOOTHED, "[[bearing]]\nname = \"b\"\nmembers = [\"sun\"]\ndesignation = \"6210\"\noutside_diameter = \"95 mm\"");

    // W316 OutsideLaw
    regress_w316_cold_oil: OutsideLaw, with(TOOTHED, "60 degC", "-40 degC");
    regress_w316_load: OutsideLaw, with(TOOTHED, "10 N m", "0.1 N m");

    // W317 NotConverged
    regress_w317_no_agreement: NotConverged, RESTLESS;

    // N404 GivenEfficiency
    regress_w330: NoHeatBalance, and(REDUCER, "[heat]\nambient = \"20 degC\"\nconductance = \"0.1 W/K\"");
    regress_n405: HeatStep, and(REDUCER, "[heat]\nambient = \"20 degC\"\nconductance = \"0.2 W/K\"\n[heat.cooler]\ninlet = \"20 degC\"\nconductance = \"1 W/K\"\nopens = \"60 degC\"\nopen = \"333.1500000001 K\"");
    regress_n404_set: GivenEfficiency, with(TOOTHED, "carrier = \"carrier\"", "carrier = \"carrier\"\nmesh_efficiency = 0.99");
    regress_n404_mesh: GivenEfficiency, with(PAIR, "efficiency = 0.98", "efficiency = 0.98\ngeometry = { module = \"2 mm\", width = \"20 mm\" }");

    // N401 Stiction
    regress_n401_mesh_at_rest: Stiction, STICTION;

    // N402 NearBoundary
    regress_n402_speed: NearBoundary,
        and(TWO_SPEED, "[[operation]]\nname = \"o\"\nspeeds = { sun = \"1000 rpm\", carrier = \"1005 rpm\" }\ntorques = { sun = \"10 N m\" }")
            .replace("terminals = [\"sun\", \"carrier\"]", "terminals = [\"sun\", \"carrier\", \"ring\"]");

    regress_n402_torque: NearBoundary, THREE_SHAFTS;

    // N403 NothingAsked
    regress_n403_no_terminals: NothingAsked, with(REDUCER.split("[[operation]]").next().unwrap(), "terminals = [\"sun\", \"carrier\"]\n", "");
    regress_n403_state: NothingAsked, and(TWO_SPEED, "[[state]]\nname = \"odd\"\nengaged = []\noutput = \"sun\"");

    // Several at once.
    regress_several_at_once: UnknownName,
        with(&with(&with(REDUCER, "teeth = 30", "teeth = 0"), "carrier = \"carrier\"", "carrier = \"carier\""), "\"1000 rpm\"", "1000");
    regress_non_ascii: UnknownName,
        PAIR.replace("\"b\"", "\"Hohlrad ü\"").replace("member = \"a\"", "member = \"Sonnenrad Größe µ\"");
}

/// Thrust of helical teeth on a bearing whose friction is larger than what makes the thrust.
const RESTLESS: &str = r#"format = 1
name = "restless"
members = ["sun", "carrier"]
terminals = ["sun", "carrier"]

[oil]
name = "ISO VG 220"
temperature = "60 degC"

[laws]
bearing = "palmgren"

[[set]]
name = "P1"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "frame", teeth = 70 }
carrier = "carrier"
geometry = { module = "2 mm", width = "20 mm", helix = "30 deg" }

[[bearing]]
name = "thrust bearing"
members = ["sun"]
kind = "deep-groove-ball"
bore = "1000 mm"
outside_diameter = "1220 mm"
width = "100 mm"
static_rating = "1 N"

[[operation]]
name = "full load"
speeds = { sun = "10 rpm" }
torques = { sun = "1000 N m" }
"#;

const STEPPED: &str = r#"format = 1
name = "stepped"
members = ["sun", "ring", "out", "carrier"]
terminals = ["sun", "ring"]

[[set]]
name = "P1"
type = "stepped"
suns = [ { member = "sun", teeth = 20, planet_teeth = 20 } ]
RINGS
carrier = "carrier"
"#;

const RAVIGNEAUX: &str = r#"format = 1
name = "ravigneaux"
members = ["small", "large", "ring", "carrier"]
terminals = ["small", "carrier"]

[[set]]
name = "R"
type = "ravigneaux"
small_sun = { member = "small", teeth = 28 }
large_sun = { member = "large", teeth = 30 }
MORE
long_planet = { LONG }
carrier = "carrier"
"#;

/// A set that nothing loads hangs on the shaft `b`.
const LOOSE: &str = r#"format = 1
name = "loose set"
members = ["a", "b", "ring", "carrier"]
terminals = ["a", "b"]

[[mesh]]
gears = [ { member = "a", teeth = 20 }, { member = "b", teeth = 40 } ]
efficiency = 0.98

[[set]]
name = "P1"
sun = { member = "b", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "ring", teeth = 70 }
carrier = "carrier"
mesh_efficiency = 0.99

[[operation]]
name = "load"
speeds = { a = "100 rpm" }
torques = { a = "1 N m" }
"#;

/// What the first mesh brings to `b` is almost all taken there.
const THREE_SHAFTS: &str = r#"format = 1
name = "three shafts"
members = ["a", "b", "c"]
terminals = ["a", "b", "c"]

[[mesh]]
gears = [ { member = "a", teeth = 20 }, { member = "b", teeth = 40 } ]
efficiency = 0.98

[[mesh]]
gears = [ { member = "b", teeth = 20 }, { member = "c", teeth = 40 } ]
efficiency = 0.98

[[operation]]
name = "load"
speeds = { a = "100 rpm" }
torques = { a = "10 N m", b = "19.5 N m" }
"#;

const ONE_WAY: &str = r#"format = 1
name = "one way"
members = ["sun", "ring", "carrier"]
terminals = ["sun", "carrier"]

[[set]]
name = "P1"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "ring", teeth = 70 }
carrier = "carrier"
mesh_efficiency = 0.99

[[shift_element]]
name = "F"
kind = "one-way"
members = ["ring"]

[[shift_element]]
name = "G"
kind = "one-way"
members = ["carrier"]
blocks = "forward"

[[state]]
name = "low"
engaged = ["F"]
"#;

/// The train turns as a block: no tooth slides, and the load still passes through the teeth.
const STICTION: &str = r#"format = 1
name = "block"
members = ["sun", "ring", "carrier"]
terminals = ["sun", "ring", "carrier"]

[[set]]
name = "P1"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4 }
ring = { member = "ring", teeth = 70 }
carrier = "carrier"
mesh_efficiency = 0.98

[[operation]]
name = "synchronous"
speeds = { sun = "1000 rpm", ring = "1000 rpm" }
torques = { sun = "10 N m" }
"#;

/// A self-locking drive with a row of almost lossless sets behind it: too many interacting
/// elements to try every sign pattern.
fn long_chain() -> String {
    const SETS: usize = 18;
    let members: String = (0..=SETS).map(|k| format!(", \"m{k}\"")).collect();
    let mut text = format!(
        "format = 1\nname = \"long chain\"\nmembers = [\"sun\", \"carrier\"{members}]\nterminals = [\"sun\", \"m{SETS}\"]\n\n\
         [[set]]\nname = \"W\"\ntype = \"stepped\"\nsuns = [ {{ member = \"sun\", teeth = 12, planet_teeth = 36 }} ]\n\
         rings = [\n  {{ member = \"frame\", teeth = 84, planet_teeth = 36 }},\n  {{ member = \"m0\", teeth = 83, planet_teeth = 35 }},\n]\n\
         carrier = \"carrier\"\nmesh_efficiency = {{ external = 0.98, internal = 0.99 }}\n"
    );
    for k in 0..SETS {
        text += &format!(
            "\n[[set]]\nname = \"P{k}\"\nsun = {{ member = \"m{k}\", teeth = 30 }}\nring = {{ member = \"frame\", teeth = 70 }}\n\
             carrier = \"m{}\"\nmesh_efficiency = 0.9999\n",
            k + 1
        );
    }
    text
}

/// Stages on one output, each with a load of its own that it carries in two ways: more equilibria than anybody wants told.
fn many_wedges() -> String {
    let members = (0..17).map(|k| format!("c{k}")).chain(["out".to_owned()]).collect::<Vec<_>>();
    let mut text = format!("format = 1\nname = \"many wedges\"\nmembers = {members:?}\nterminals = {members:?}\n");
    for k in 0..17 {
        text += &format!(
            "\n[[set]]\nname = \"P{k}\"\ntype = \"stepped\"\nsuns = [\n  \
             {{ member = \"frame\", teeth = 50, planet_teeth = 20 }},\n  \
             {{ member = \"out\", teeth = 49, planet_teeth = 21 }},\n]\ncarrier = \"c{k}\"\nbasic_efficiency = 0.9\n"
        );
    }
    let loads: Vec<String> = (0..17).map(|k| format!("c{k} = \"-1 N m\"")).collect();
    and(
        &text,
        &format!(
            "[[operation]]\nname = \"all\"\nspeeds = {{ out = \"100 rpm\" }}\ntorques = {{ {} }}",
            loads.join(", ")
        ),
    )
}

/// Whatever text of a file has a character that cannot be shown is refused, wherever it stands.
#[test]
fn no_text_of_a_file_hides_anything() {
    let mut tried = 0;
    for (name, text) in crate::common::examples() {
        let marks: Vec<usize> = text.match_indices('"').map(|m| m.0).collect();
        // Not those of comments.
        let is_text = |at: &usize| !text[..*at].rsplit('\n').next().unwrap_or_default().contains('#');
        let pairs = marks.chunks_exact(2).filter(|m| !text[m[0]..m[1]].contains('\n'));
        for at in pairs.map(|m| m[0] + 1).filter(is_text).step_by(3) {
            for escape in ["\\u009B31m", "\\u202E", "\\uFFFF", "\\u001B[31m"] {
                let spoiled = format!("{}{escape}{}", &text[..at], &text[at..]);
                let reading = Train::read_toml(&spoiled);
                assert!(
                    reading.train.is_none(),
                    "{name}: {escape} at {at}: {}",
                    &spoiled[at.saturating_sub(40)..at + 20]
                );
                let told = reading.diagnostics.render("train.toml", &spoiled, false);
                assert!(told.chars().all(|c| c == '\n' || willis::diagnostic::is_printable(c)), "{name}: {told}");
                tried += 1;
            }
        }
    }
    assert!(tried > 1000, "{tried}");
}
