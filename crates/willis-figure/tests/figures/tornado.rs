//! Rankings of what moves the losses agree with the sensitivity that they show.

use willis::Selection;
use willis::study::sensitivity;
use willis_figure::tornado;

use crate::common::train as example;

#[test]
fn bars_are_the_largest_changes_in_their_order() {
    let all = sensitivity(&example("wang-herringbone-physical.toml"), &Selection::default()).unwrap();
    let operation = &all.operations[0];
    let t = tornado(&all, None, 8).unwrap();
    assert_eq!((t.bars.len(), t.left_out), (8, operation.quantities.len() - 8));
    assert!(t.bars.windows(2).all(|w| w[0].loss_change_w.abs() >= w[1].loss_change_w.abs()));
    let least = t.bars[7].loss_change_w.abs();
    let smaller = operation.quantities.iter().filter(|q| q.loss_change_w.abs() <= least).count();
    assert!(smaller > t.left_out);
    for b in &t.bars {
        let q = operation.quantities.iter().find(|q| q.name == b.name).unwrap();
        assert_eq!((b.loss_change_w, b.efficiency_change), (q.loss_change_w, q.efficiency_change));
    }
}

#[test]
fn without_losses_or_without_an_equilibrium_there_is_no_ranking() {
    let lossless = sensitivity(&example("textbook-reverted.toml"), &Selection::default()).unwrap();
    for o in &lossless.operations {
        match tornado(&lossless, Some(&o.name), 10) {
            Ok(t) => assert!(!t.bars.is_empty()),
            Err(why) => assert!(why.to_string().contains("moves"), "{why}"),
        }
    }
    let locked = sensitivity(&example("wolfrom-498-self-locking.toml"), &Selection::default()).unwrap();
    let refused = locked.operations.iter().filter(|o| o.reason.is_some());
    assert!(refused.clone().count() > 0);
    assert!(tornado(&locked, Some("x"), 10).unwrap_err().to_string().contains("`x`"));
    for o in refused {
        let why = tornado(&locked, Some(&o.name), 10).unwrap_err().to_string();
        assert!(why.contains(o.reason.as_ref().unwrap()), "{why}");
    }
}
