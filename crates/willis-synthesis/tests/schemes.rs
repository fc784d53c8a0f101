//! Spaces of shift schemes that are finished, and counts that must come out.

use std::collections::BTreeMap;

use willis::work::Serial;
use willis_synthesis::schemes::{Schemes, Search, Wish};

fn wish(sets: &[&str], [elements, closed, forward]: [usize; 3], ranges: [&str; 3]) -> Wish {
    let mut wish = Wish::new(sets, elements, closed, forward).unwrap();
    [wish.forward_range, wish.step, wish.reverse_range] = ranges.map(|r| r.parse().unwrap());
    wish
}

const TWO_SETS: [&str; 2] = ["62/26", "74/42"];
const ALLISON: [&str; 3] = ["109/67", "91/49", "97/39"];
const ZF: [&str; 4] = ["96/48", "96/48", "111/69", "85/23"];
const TWO_SET_RANGES: [&str; 3] = ["1/2..5", "1.15..2.2", "1.2..5"];

fn counts(answer: &Schemes) -> [u64; 5] {
    let found = &answer.found;
    [answer.space.examined, answer.space.choices, found.layouts, found.schemes, found.classes]
}

fn run(wish: &Wish) -> Schemes {
    let start = std::time::Instant::now();
    let answer = Search::new(wish).unwrap().run(&Serial).unwrap();
    println!("{:?} for {}", start.elapsed(), answer.completeness.statement);
    assert!(answer.completeness.complete);
    answer
}

#[test]
fn two_sets_four_elements_three_speeds() {
    let answer = run(&wish(&TWO_SETS, [4, 2, 3], TWO_SET_RANGES));
    assert_eq!(counts(&answer), [882, 365_346, 185, 653, 361]);
    assert_eq!(answer.found.by_brakes, BTreeMap::from([(0, 111), (1, 338), (2, 204)]));
}

#[test]
fn two_sets_five_elements_four_speeds() {
    let answer = run(&wish(&TWO_SETS, [5, 2, 4], TWO_SET_RANGES));
    assert_eq!(counts(&answer), [882, 470_736, 75, 350, 146]);
    assert_eq!(answer.found.by_brakes, BTreeMap::from([(0, 37), (1, 113), (2, 174), (3, 26)]));
}

#[test]
fn three_sets_six_speeds() {
    let answer = run(&wish(&ALLISON, [5, 2, 6], ["1/2..6", "1.1..2.2", "1.5..7"]));
    assert_eq!(counts(&answer), [149_580, 790_732_530, 4246, 23_816, 11_433]);
    assert_eq!(answer.found.by_brakes, BTreeMap::from([(0, 4561), (1, 12_125), (2, 6264), (3, 866)]));
}

#[test]
fn elements_on_the_layout_of_the_8hp() {
    let wish = Wish {
        layout: Some("345360678751".parse().unwrap()),
        ..wish(&ZF, [5, 3, 8], ["1/2..6", "1.1..1.8", "1.5..6"])
    };
    let answer = run(&wish);
    assert_eq!(counts(&answer), [1, 219_396, 1, 6, 2]);
    let ids: Vec<&str> = answer.schemes.iter().map(|s| s.id.as_str()).collect();
    let expected = [
        "345360678751 07 18 23 24 67",
        "345360678751 07 18 23 24 68",
        "345360678751 07 18 23 24 78",
        "345360678751 07 23 24 58 67",
        "345360678751 07 23 24 58 68",
        "345360678751 07 23 24 58 78",
    ];
    assert_eq!(ids, expected);
    assert_eq!(answer.schemes[0].known.as_deref(), Some("ZF 8HP70"));
}
