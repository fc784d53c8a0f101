//! The picture of speeds and torques says what `willis table` says, cell by cell.

use resvg::usvg::roxmltree::{Document, Node};
use willis::analysis::{ShaftTable, ShaftTableRequest, shaft_table};
use willis::exact::Rational;
use willis_figure::draw_table;

use crate::common::train as example;
use crate::trains::{examples, hard};

/// Texts of all cells that are about a member or element in a state, in the order of the sections.
fn cells(svg: &Document<'_>, state: &str, about: &str, name: &str) -> Vec<String> {
    let own = |n: &Node<'_, '_>| {
        n.has_tag_name("g") && n.attribute("data-state") == Some(state) && n.attribute(about) == Some(name)
    };
    let words = |n: Node<'_, '_>| {
        n.descendants()
            .filter(|t| t.has_tag_name("text"))
            .filter_map(|t| t.text())
            .map(str::trim)
            .collect::<Vec<_>>()
            .join(" ")
    };
    svg.descendants().filter(own).map(words).collect()
}

/// A number as the picture writes it, or nothing where it writes none.
fn read(text: &str) -> Option<f64> {
    let plain = text.replace('−', "-");
    match plain.split_once("·10") {
        None => plain.parse().ok(),
        Some((mantissa, raised)) => {
            let exponent: String = raised
                .chars()
                .map(|c| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|d| d == c).map_or("-".to_owned(), |d| d.to_string()))
                .collect();
            Some(mantissa.parse::<f64>().ok()? * 10f64.powi(exponent.parse().ok()?))
        }
    }
}

fn agrees(table: &ShaftTable) -> usize {
    let svg = draw_table(table);
    let document = Document::parse(&svg).unwrap();
    let mut compared = 0;
    for (state, s) in table.states.iter() {
        for (name, m) in s.members.iter() {
            let found = cells(&document, state, "data-member", name);
            let expected = if m.carrier.is_some() { &m.relative_speed } else { &m.speed };
            let place = format!("{} {state} {name}: {found:?}", table.train);
            match (read(&found[0]), expected.as_ref().map(Rational::to_f64)) {
                (Some(shown), Some(x)) => {
                    assert!((shown - x).abs() <= 5.1e-4 * x.abs().max(1.0), "{place}, not {x}");
                    // A number that is not zero never looks like it.
                    assert_eq!(shown == 0.0, x == 0.0, "{place}, not {x}");
                }
                (None, None) => assert_eq!(found[0], "–", "{place}"),
                _ => panic!("{place}, not {expected:?}"),
            }
            compared += 1;
        }
        for (name, e) in s.shift_elements.iter() {
            let found = cells(&document, state, "data-element", name);
            assert_eq!(found.len(), 2, "{} {state} {name}: slip and torque", table.train);
            assert_eq!(found[0].is_empty(), e.engaged, "{} {state} {name}: {found:?}", table.train);
            if let (Some(shown), Some(x)) = (read(&found[1]), e.torque) {
                assert!(
                    (shown - x).abs() <= 5.1e-4 * x.abs().max(1.0),
                    "{} {state} {name}: {shown}, not {x}",
                    table.train
                );
            }
            compared += 1;
        }
    }
    compared
}

#[test]
fn every_cell_agrees_with_the_table() {
    let mut compared = 0;
    for (_, train) in examples() {
        compared += shaft_table(&train, &ShaftTableRequest::default()).map_or(0, |t| agrees(&t));
    }
    for (_, model) in hard() {
        compared += shaft_table(model.train(), &ShaftTableRequest::default()).map_or(0, |t| agrees(&t));
    }
    assert!(compared > 2000, "{compared}");
}

/// First gear of the C4 by hand: the rear carrier is held, so the sun runs at −72/33 of the output, and of the front set
/// 72 input = (33 + 72) output − 33 sun = (105 + 72) output.
#[test]
fn the_sun_of_the_simpson_train_runs_backwards() {
    let table = shaft_table(&example("simpson-ford-c4.toml"), &ShaftTableRequest::default()).unwrap();
    let svg = draw_table(&table);
    let document = Document::parse(&svg).unwrap();
    let ratio = (105.0 + 72.0) / 72.0;
    assert_eq!(cells(&document, "1", "data-member", "output")[0], format!("{:.3}", 1.0 / ratio));
    assert_eq!(cells(&document, "1", "data-member", "sun")[0], format!("−{:.3}", 72.0 / 33.0 / ratio));
    assert_eq!(cells(&document, "1", "data-member", "rear-carrier")[0], "0");
}
