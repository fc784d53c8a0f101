//! Figures of power flows and Sankey diagrams: no label on another, nothing beyond the page, for every example.

// Words are measured here as the figures measure them. Their measure is not public, and of the rest of its file this
// test has no use.
#[allow(dead_code)]
#[path = "../../src/parts/style.rs"]
mod style;

use willis::analysis::Selection;
use willis::hypergraph::flows;
use willis::train::{OperationSpec, SetSpec, Train};
use willis::units::{AngularSpeed, Torque};

use crate::trains::{self, stepped};

/// A text on the page: what it says, left, right, top, bottom.
type Label = (String, [f64; 4]);

fn attribute_text<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    tag.split(&format!(" {name}=\"")).nth(1)?.split('"').next()
}

fn attribute(tag: &str, name: &str) -> Option<f64> {
    attribute_text(tag, name)?.parse().ok()
}

/// A text as it is read.
fn plain(content: &str) -> String {
    content.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}

/// Every text of a figure, with the shifts of the groups around it.
fn labels(svg: &str) -> (Vec<Label>, [f64; 2]) {
    let mut shifts: Vec<(f64, f64)> = vec![];
    let mut all = Vec::new();
    let mut page = [0.0; 2];
    for piece in svg.split('<').skip(1) {
        let (tag, content) = piece.split_once('>').expect("tags are closed");
        if tag.starts_with("svg") {
            page = ["width", "height"].map(|n| attribute(&format!(" {tag}"), n).expect("a size"));
        } else if tag.starts_with("g") && (tag.len() == 1 || tag.starts_with("g ")) && !tag.ends_with('/') {
            let shift = tag.split("translate(").nth(1).and_then(|t| t.split(')').next()).map(|t| {
                let mut n = t.split(' ').map(|x| x.parse::<f64>().expect("a number"));
                (n.next().expect("x"), n.next().expect("y"))
            });
            shifts.push(shift.unwrap_or((0.0, 0.0)));
        } else if tag == "/g" {
            shifts.pop();
        } else if tag.starts_with("text ") && attribute_text(tag, "aria-hidden").is_some() {
            // The rim of the text that follows.
        } else if tag.starts_with("text ") {
            let get = |n: &str| attribute(tag, n).expect("an attribute");
            let (dx, dy) = shifts.iter().fold((0.0, 0.0), |a, s| (a.0 + s.0, a.1 + s.1));
            let content = content.trim();
            let size = get("font-size");
            let bold = if tag.contains("\"bold\"") { style::BOLD } else { 1.0 };
            let width = bold * style::wide(&plain(content), size);
            let x = get("x") + dx;
            let left = match attribute_text(tag, "text-anchor") {
                Some("middle") => x - width / 2.0,
                Some("end") => x - width,
                _ => x,
            };
            let y = get("y") + dy;
            all.push((content.to_owned(), [left, left + width, y - 0.93 * size, y + 0.24 * size]));
        }
    }
    assert!(shifts.is_empty());
    (all, page)
}

fn check(at: &str, figure: &str) {
    assert!(!figure.contains("NaN") && !figure.contains("inf "), "{at}");
    let (labels, [width, height]) = labels(figure);
    for (k, (a, [left, right, top, bottom])) in labels.iter().enumerate() {
        assert!(*left >= 0.0 && *right <= width && *top >= 0.0 && *bottom <= height, "{at}: `{a}` is off the page");
        for (b, [l, r, t, u]) in &labels[..k] {
            let apart = *left >= r + 1.0 || *l >= right + 1.0 || *top >= u + 1.0 || *t >= bottom + 1.0;
            assert!(apart, "{at}: `{a}` lies on `{b}`: {:?} {:?}", [left, right, top, bottom], [l, r, t, u]);
        }
    }
    assert!(figure.contains("<title>") && figure.contains("<desc>"));
}

fn check_all(at: &str, train: &Train) -> bool {
    let Ok(all) = flows(train, &Selection::default()) else { return false };
    let figure = willis_figure::draw_flow(&all);
    assert_eq!(figure, willis_figure::draw_flow(&all), "{at}: not the same twice");
    check(&format!("{at}, flow"), &figure);
    let figure = willis_figure::draw_sankey(&willis_figure::sankey(&all));
    assert_eq!(figure, willis_figure::draw_sankey(&willis_figure::sankey(&all)), "{at}: not the same twice");
    check(&format!("{at}, sankey"), &figure);
    true
}

#[test]
fn labels_keep_apart_and_stay_on_the_page() {
    let count = trains::examples().iter().filter(|(name, train)| check_all(name, train)).count();
    assert!(count > 10, "{count}");
}

/// Names as users give them: the longest there may be, in other scripts, with signs of XML.
#[test]
fn any_names_fit() {
    let long = "a very long name of a shaft that somebody typed in full, 1 < 2";
    for [sun, carrier, set] in [
        [long, "carrier of the slow stage, which is long as well, \"b\"", "P1"],
        ["太阳轮", "行星架", "第一级"],
        ["солнце & <ko>", "водило", "ступень быстроходная первая"],
    ] {
        let train = Train::builder(long)
            .members([sun, carrier])
            .terminals([sun, carrier])
            .set(SetSpec::simple(set, (sun, 30), ("frame", 70), carrier).planet(20, 4).mesh_efficiency(0.99))
            .operation(OperationSpec::new(long).speed(sun, AngularSpeed::rpm(1000.0)).torque(sun, Torque::n_m(10.0)))
            .build()
            .unwrap();
        assert!(check_all(sun, &train));
    }
}

#[test]
fn prop_labels_of_random_trains_keep_apart() {
    let drawn = |seed: &u64| stepped(*seed).is_some_and(|train| check_all(&format!("seed {seed}"), &train));
    let count = (0..60).filter(drawn).count();
    assert!(count > 20, "{count}");
}
