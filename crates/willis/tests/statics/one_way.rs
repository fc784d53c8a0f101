//! What a one-way clutch does not allow is no answer, whoever asks.

use willis::analysis::Verdict;
use willis::diagnostic::{Code, Diagnostic};
use willis::model::Model;
use willis::study::{Axis, Hold, PointAnswer, PointSetup, PointVerdict, Sweep};
use willis::{Selection, Train, analyze};

/// A set whose ring is held by F, or turns with the carrier by C; F and G block as told.
fn train_of(blocks: [&str; 2], engaged: &str, speed: f64, torque: f64, physical: bool) -> String {
    let drag = if physical { "[[drag]]\nname = \"d\"\nmembers = [\"sun\"]\ncoulomb = \"0.1 N m\"\n" } else { "" };
    format!(
        r#"
        format = 1
        name = "one-way"
        members = ["sun", "ring", "carrier"]
        terminals = ["sun", "carrier"]
        set = [{{ name = "P1", sun = {{ member = "sun", teeth = 30 }}, planet = {{ teeth = 20, count = 4 }},
                 ring = {{ member = "ring", teeth = 70 }}, carrier = "carrier", mesh_efficiency = 0.99 }}]
        {drag}
        [[shift_element]]
        name = "F"
        kind = "one-way"
        members = ["ring"]
        blocks = "{}"
        [[shift_element]]
        name = "G"
        kind = "one-way"
        members = ["sun", "ring"]
        blocks = "{}"
        [[shift_element]]
        name = "C"
        kind = "clutch"
        members = ["ring", "carrier"]
        [[state]]
        name = "asked"
        engaged = ["{engaged}"]
        [[operation]]
        name = "o"
        state = "asked"
        speeds = {{ sun = "{speed} rpm" }}
        torques = {{ sun = "{torque} N m" }}
        "#,
        blocks[0], blocks[1]
    )
}

/// By hand. With F engaged the ring stands: it holds what the sun puts on it, -70/30 of its torque but for friction, and
/// G turns as the sun does. With C all turn as the sun does: F turns with it, and G not at all.
fn is_allowed([f, g]: [&str; 2], engaged: &str, speed: f64, torque: f64) -> bool {
    let sign = |blocks: &str| if blocks == "forward" { 1.0 } else { -1.0 };
    match engaged {
        // A clutch that blocks the ring forward pushes it backward.
        "F" => torque * 70.0 / 30.0 * sign(f) <= 0.0 && speed * sign(g) <= 0.0,
        _ => speed * sign(f) <= 0.0,
    }
}

#[test]
fn what_a_one_way_clutch_does_not_allow_is_no_answer() {
    let ways = ["forward", "backward"];
    let (mut allowed, mut refused) = (0, 0);
    for case in 0..64 {
        let bit = |k: usize| case >> k & 1;
        let blocks = [ways[bit(0)], ways[bit(1)]];
        let engaged = ["F", "C"][bit(2)];
        let (speed, torque) = ([1000.0, -700.0][bit(3)], [100.0, -60.0][bit(4)]);
        let text = train_of(blocks, engaged, speed, torque, bit(5) == 1);
        let train = Train::from_toml(&text).unwrap_or_else(|wrong| panic!("{wrong}"));
        let analysis = analyze(&train, &Selection::default()).unwrap_or_else(|wrong| panic!("{wrong}"));
        let wanted = is_allowed(blocks, engaged, speed, torque);
        *if wanted { &mut allowed } else { &mut refused } += 1;
        let report = &analysis.operations[0];
        let told = |d: &&Diagnostic| d.code == Code::OneWay && d.message.starts_with("operation");
        assert_eq!(report.verdict, if wanted { Verdict::Unique } else { Verdict::Undetermined }, "{text}");
        assert_eq!(analysis.diagnostics.iter().find(told).is_none(), wanted, "{text}");
        assert!(wanted || report.reason.as_ref().is_some_and(|r| r.contains("one-way clutch")), "{report:?}");
        // A point of a study, and one of many along an axis.
        let point = PointAnswer::of(&train, &train.operations()[0]);
        assert_eq!(point.verdict == PointVerdict::Unique, wanted, "{text}");
        let model = Model::from_toml(&text).unwrap_or_else(|wrong| panic!("{wrong}"));
        let speeds = format!("sun.speed={speed} rpm, {} rpm, {} rpm", 2.0 * speed, -speed);
        let axis = Axis::parse(&speeds, &model).unwrap_or_else(|wrong| panic!("{wrong:?}"));
        let setup = PointSetup::new(&model, Some("o"), None, Hold::AsGiven).unwrap_or_else(|wrong| panic!("{wrong}"));
        let sweep = Sweep::new(setup, vec![axis], &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
        let unique = sweep.rows(0, 3, &mut Default::default()).summary.verdicts.get(&PointVerdict::Unique).copied();
        let all = [speed, 2.0 * speed, -speed].map(|speed| u64::from(is_allowed(blocks, engaged, speed, torque)));
        assert_eq!(unique.unwrap_or(0), all.iter().sum::<u64>(), "{text}");
        assert!(sweep.compile().is_err(), "numbers without a look at the clutches");
    }
    assert!(allowed >= 12 && refused >= 24, "{allowed} {refused}");
}
