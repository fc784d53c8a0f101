//! Wheels of regimes: of which trains there is one.

use willis::diagnostic::Code;
use willis::regimes::RegimeSelection;
use willis::train::{SetSpec, Train};
use willis_figure::regime_map;

#[test]
fn a_train_without_two_freedoms_has_no_wheel_and_is_told_why() {
    let reducer = Train::builder("reducer")
        .members(["sun", "carrier"])
        .terminals(["sun", "carrier"])
        .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
        .build()
        .expect("a good train");
    let wrong = regime_map(&reducer, &RegimeSelection::default()).expect_err("one freedom");
    assert!(wrong.iter().all(|d| d.code == Code::Unfit));
    let text = wrong.to_string();
    assert!(text.contains("independent speeds 1, independent torques 1"), "{text}");
    assert!(text.contains("name three `terminals`"), "{text}");
}
