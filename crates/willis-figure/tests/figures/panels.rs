//! Figures in panels of a screen, of every example: columns are shared, nothing is too small, marks are found.

use std::collections::BTreeSet;

use willis::analysis::Selection;
use willis::hypergraph::flows;
use willis_figure::{
    Columns, Lever, LeverLayout, LeverRequest, SankeyPaper, Stick, StickLayout, lever_panel, sankey, stick_panel,
};

use crate::trains::examples;

const WIDTHS: [f64; 4] = [360.0, 700.0, 1000.0, 1400.0];

/// Schematic and levers of every example that has both, with its name.
fn both() -> Vec<(String, Stick, Lever)> {
    let all = examples();
    let one = |(name, train): &(String, willis::train::Train)| {
        let state = train.states().first().map(|s| s.name.clone());
        let stick = StickLayout::new(train).ok()?.show(train, state.as_deref()).ok()?;
        let request = state.map_or(LeverRequest::First, LeverRequest::State);
        let lever = LeverLayout::new(train).ok()?.show(train, &request).ok()?;
        Some((name.clone(), stick, lever))
    };
    all.iter().filter_map(one).collect()
}

#[test]
fn columns_lie_side_by_side_within_the_panel() {
    let mut aligned = 0;
    for (name, stick, lever) in both() {
        for width in WIDTHS {
            let columns = Columns::new(&stick, &lever, width);
            assert!(columns.width >= width && columns.all().len() == lever.bars.len(), "{name}");
            let mut all = columns.all().to_vec();
            all.sort_by(|a, b| a.x.total_cmp(&b.x));
            for one in &all {
                assert!(one.span[0] < one.x && one.x < one.span[1], "{name}, {width}: {one:?}");
                assert!(one.span[0] >= 0.0 && one.span[1] <= columns.width + 1e-9, "{name}, {width}: {one:?}");
            }
            assert!(all.windows(2).all(|w| w[0].span[1] <= w[1].span[0] + 1e-9), "{name}, {width}: {all:?}");
            aligned += usize::from(columns.aligned());
        }
    }
    assert!(aligned > 60, "{aligned}");
}

#[test]
fn a_set_stands_above_its_lever() {
    for (name, stick, lever) in both() {
        let columns = Columns::new(&stick, &lever, 900.0);
        if !columns.aligned() {
            continue;
        }
        let drawn = stick_panel(&stick, &columns, 300.0);
        let svg = roxmltree::Document::parse(&drawn).expect("SVG");
        for (bar, column) in lever.bars.iter().zip(columns.all()) {
            // The middle of a set: its gears lie evenly on both sides of it.
            let middle = |set: &str| {
                let own = |n: &roxmltree::Node<'_, '_>| n.attribute("data-mesh") == Some(set) && n.has_tag_name("g");
                let lines =
                    svg.descendants().filter(own).flat_map(|g| g.descendants()).filter(|n| n.has_tag_name("line"));
                let ends = lines.flat_map(|l| ["x1", "x2"].map(|k| l.attribute(k).and_then(|x| x.parse::<f64>().ok())));
                let xs: Vec<f64> = ends.flatten().collect();
                Some(0.5 * (xs.iter().copied().reduce(f64::min)? + xs.iter().copied().reduce(f64::max)?))
            };
            // Of several sets on one lever it stands under the first.
            let middles: Vec<f64> = bar.sets.iter().filter_map(|s| middle(&s.name)).collect();
            let under = |x: &f64| (x - column.x).abs() <= 1.5;
            assert!(
                middles.is_empty() || middles.iter().any(under),
                "{name}, {}: {middles:?}, lever at {}",
                bar.name(),
                column.x
            );
        }
    }
}

#[test]
fn panels_have_marks_with_ids_and_no_small_text() {
    for (name, stick, lever) in both() {
        let columns = Columns::new(&stick, &lever, 640.0);
        for drawn in [stick_panel(&stick, &columns, 200.0), lever_panel(&lever, &columns, 200.0, None)] {
            let svg = roxmltree::Document::parse(&drawn).expect("SVG");
            let mut ids = BTreeSet::new();
            for node in svg.descendants() {
                if let Some(id) = node.attribute("id") {
                    assert!(ids.insert(id), "{name}: two marks are called `{id}`");
                }
                if let Some(size) = node.attribute("font-size") {
                    assert!(size.parse::<f64>().is_ok_and(|s| s >= 10.0), "{name}: {size}");
                }
            }
            assert!(!ids.is_empty(), "{name}");
        }
    }
}

#[test]
fn dots_carry_the_speeds_of_the_data() {
    for (name, stick, lever) in both() {
        let columns = Columns::new(&stick, &lever, 640.0);
        let drawn = lever_panel(&lever, &columns, 260.0, None);
        let svg = roxmltree::Document::parse(&drawn).expect("SVG");
        for bar in &lever.bars {
            for node in bar.nodes.iter().filter(|n| n.roles != [willis_figure::LeverRole::Planet]) {
                let Some(speed) = node.speeds[0] else { continue };
                let dot = svg.descendants().find(|n| {
                    n.has_tag_name("circle")
                        && n.attribute("data-member") == Some(&node.member)
                        && n.attribute("data-mesh") == Some(&bar.name())
                        && n.attribute("data-value").is_some()
                });
                let value = dot.and_then(|d| d.attribute("data-value")).map(str::parse::<f64>);
                assert_eq!(value, Some(Ok(speed)), "{name}: {} of {}", node.member, bar.name());
            }
        }
    }
}

#[test]
fn the_flow_of_power_fits_its_panel() {
    let mut fits = 0;
    let mut all = 0;
    for (name, train) in examples() {
        let Ok(report) = flows(&train, &Selection::default()) else { continue };
        let figure = sankey(&report);
        let mut paper = SankeyPaper::of_panel([&figure], [700.0, 320.0], None);
        for k in 0..figure.panels.len() {
            let Some(drawn) = paper.draw_alone(&figure, k, [700.0, 320.0]) else { continue };
            let svg = roxmltree::Document::parse(&drawn).expect("SVG");
            let size = |key: &str| svg.root_element().attribute(key).and_then(|x| x.parse::<f64>().ok());
            all += 1;
            fits += usize::from(size("height").is_some_and(|h| h <= 321.0));
            assert!(size("width").is_some_and(|w| w >= 700.0), "{name}");
        }
    }
    // What has very many parts is higher, and is scrolled.
    assert!(all > 20 && 10 * fits >= 8 * all, "{fits} of {all}");
}
