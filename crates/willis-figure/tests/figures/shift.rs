//! Shift tables as pictures: dots, ratios, steps and changes agree with each other.

use willis::Train;
use willis::train::{SetSpec, ShiftElementSpec, StateSpec};
use willis_figure::{ShiftTable, shift};

use crate::common::train as example;

fn ratios(table: &ShiftTable) -> Vec<f64> {
    table.rows.iter().map(|r| (r.ratio.unwrap() * 1000.0).round() / 1000.0).collect()
}

#[test]
fn val_ratios_of_the_8hp70_are_the_published_ones() {
    let table = shift(&example("zf-8hp70.toml")).unwrap();
    assert_eq!(ratios(&table), [4.696, 3.13, 2.104, 1.667, 1.285, 1.0, 0.839, 0.667, -3.297]);
    assert_eq!(table.elements.iter().map(|e| e.name.as_str()).collect::<Vec<_>>(), ["A", "B", "C", "D", "E"]);
    // Three of five elements are closed in every gear, and neighbours differ by one pair.
    assert!(table.rows.iter().all(|r| r.closed.iter().filter(|c| **c).count() == 3));
    for c in &table.changes[..7] {
        assert_eq!((c.opens.len(), c.closes.len(), c.several), (1, 1, false));
    }
    assert_eq!(table.changes[0].opens, ["C"]);
    assert_eq!(table.changes[0].closes, ["E"]);
}

#[test]
fn steps_multiply_to_the_spread() {
    let table = shift(&example("zf-8hp70.toml")).unwrap();
    let product: f64 = table.changes[..7].iter().map(|c| c.step.unwrap()).product();
    let spread = table.spread.unwrap();
    assert!((product / spread.value - 1.0).abs() < 1e-12);
    assert_eq!((spread.largest.as_str(), spread.smallest.as_str()), ("1", "8"));
    // From the last forward gear to reverse there is no step.
    assert_eq!(table.changes[7].step, None);
}

#[test]
fn a_shift_that_changes_two_pairs_is_marked() {
    let train = |second: [&str; 2]| {
        Train::builder("two sets")
            .members(["in", "r", "x", "y", "out"])
            .terminals(["in", "out"])
            .set(SetSpec::simple("P1", ("in", 30), ("r", 70), "x").planet(20, 4))
            .set(SetSpec::simple("P2", ("x", 30), ("y", 70), "out").planet(20, 4))
            .shift_element(ShiftElementSpec::brake("A", "r"))
            .shift_element(ShiftElementSpec::brake("B", "y"))
            .shift_element(ShiftElementSpec::clutch("C", "in", "x"))
            .shift_element(ShiftElementSpec::clutch("D", "x", "out"))
            .state(StateSpec::new("1", ["A", "B"]))
            .state(StateSpec::new("2", second))
            .build()
            .unwrap()
    };
    assert!(!shift(&train(["C", "B"])).unwrap().changes[0].several);
    let both = shift(&train(["C", "D"])).unwrap();
    assert!(both.changes[0].several);
    assert_eq!((both.changes[0].opens.join(""), both.changes[0].closes.join("")), ("AB".into(), "CD".into()));
}

#[test]
fn a_state_without_a_ratio_says_why() {
    let train = Train::builder("neutral")
        .members(["s", "r", "c"])
        .terminals(["s", "c"])
        .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4))
        .shift_element(ShiftElementSpec::brake("B", "r"))
        .state(StateSpec::new("N", [] as [&str; 0]))
        .state(StateSpec::new("1", ["B"]))
        .build()
        .unwrap();
    let table = shift(&train).unwrap();
    let neutral = &table.rows[0];
    assert_eq!((neutral.ratio, neutral.drive.value), (None, None));
    assert!(neutral.note.as_ref().unwrap().contains("2 degrees of freedom"), "{:?}", neutral.note);
    assert_eq!((table.changes[0].step, table.spread), (None, None));
}

#[test]
fn a_train_without_states_has_no_table_and_is_told_so() {
    let why = shift(&example("galvagno.toml")).unwrap_err().to_string();
    assert!(why.contains("no states") && why.contains("[[state]]"), "{why}");
}

#[test]
fn efficiencies_lie_between_nothing_and_one() {
    for file in ["ford-10r80.toml", "mercedes-9g-tronic.toml", "prius-p112.toml", "zf-6hp26.toml"] {
        let table = shift(&example(file)).unwrap();
        for r in &table.rows {
            for e in [&r.drive, &r.coast] {
                assert!(e.value.is_none_or(|e| e > 0.0 && e <= 1.0), "{file}: {r:?}");
                assert_eq!(e.value.is_none(), !e.words.is_empty());
            }
        }
    }
    assert!(!shift(&example("prius-p112.toml")).unwrap().one_path);
}

/// Nobody shifts from eighth to reverse: the picture says nothing of a change between gears of opposite sign.
#[test]
fn no_change_is_drawn_across_a_sign() {
    let mut across = 0;
    for (name, train) in crate::trains::examples() {
        let Ok(table) = shift(&train) else { continue };
        let svg = willis_figure::draw_shift(&table);
        let drawn = svg.matches('→').count();
        let mut expected = usize::from(table.changes.iter().any(|c| !c.opens.is_empty() || !c.closes.is_empty()));
        for (k, c) in table.changes.iter().enumerate() {
            let ratios = [k, k + 1].map(|r| table.rows[r].ratio);
            let turns = matches!(ratios, [Some(a), Some(b)] if a * b < 0.0);
            across += usize::from(turns);
            expected += usize::from(!turns && !c.opens.is_empty() && !c.closes.is_empty());
        }
        // The key has one arrow of its own.
        if table.one_path {
            assert_eq!(drawn, expected.max(1), "{name}");
        }
    }
    assert!(across >= 5, "{across}");
}

/// Bars of losses end within the rows of the table, on a screen and on paper.
#[test]
fn no_bar_sticks_out_of_the_table() {
    use willis_figure::{Drawing, Figure, draw};
    let mut bars = 0;
    for (name, train) in crate::trains::examples() {
        let Ok(table) = shift(&train) else { continue };
        let figure = Figure::Shift(table);
        for width in [None, Some(770)] {
            let svg = draw(&figure, Drawing { width, ..Drawing::default() });
            let document = roxmltree::Document::parse(&svg).expect("well-formed");
            let number = |n: &roxmltree::Node<'_, '_>, key: &str| n.attribute(key).and_then(|v| v.parse::<f64>().ok());
            let end = |n: roxmltree::Node<'_, '_>| number(&n, "x").unwrap_or(0.0) + number(&n, "width").unwrap_or(0.0);
            let of = |wanted: fn(&roxmltree::Node<'_, '_>) -> bool| document.descendants().filter(wanted).map(end);
            let rows = of(|n| n.attribute("fill") == Some("#f6f6f6")).fold(0.0, f64::max);
            for bar in of(|n| n.has_tag_name("rect") && n.attribute("height") == Some("10")) {
                assert!(bar <= rows, "{name}: a bar ends at {bar}, the rows at {rows}");
                bars += 1;
            }
        }
    }
    assert!(bars > 100, "{bars}");
}
