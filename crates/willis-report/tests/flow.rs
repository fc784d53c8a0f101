//! Figures of power flows: no label on another, nothing beyond the page, for every example.

use std::fs;
use std::path::Path;

use willis::analysis::Selection;
use willis::hypergraph::flows;
use willis::train::Train;

/// A text on the page: what it says, left, right, top, bottom.
type Label = (String, [f64; 4]);

fn attribute(tag: &str, name: &str) -> Option<f64> {
    let rest = tag.split(&format!(" {name}=\"")).nth(1)?;
    rest.split('"').next()?.parse().ok()
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
        } else if tag.starts_with("text ") {
            let get = |n: &str| attribute(tag, n).expect("an attribute");
            let (dx, dy) = shifts.iter().fold((0.0, 0.0), |a, s| (a.0 + s.0, a.1 + s.1));
            let content = content.trim();
            let width = 0.55 * get("font-size") * content.chars().count() as f64;
            let x = get("x") + dx;
            let left = if tag.contains("\"middle\"") { x - width / 2.0 } else { x };
            let y = get("y") + dy;
            let size = get("font-size");
            all.push((content.to_owned(), [left, left + width, y - 0.75 * size, y + 0.15 * size]));
        }
    }
    assert!(shifts.is_empty());
    (all, page)
}

#[test]
fn labels_keep_apart_and_stay_on_the_page() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    let mut count = 0;
    for file in files.iter().filter(|f| f.extension().is_some_and(|e| e == "toml")) {
        let train = Train::from_toml(&fs::read_to_string(file).unwrap()).unwrap();
        let Ok(all) = flows(&train, &Selection::default()) else { continue };
        let figure = willis_report::flow_svg(&all);
        assert_eq!(figure, willis_report::flow_svg(&all), "{}: not the same twice", file.display());
        let (labels, [width, height]) = labels(&figure);
        for (k, (a, [left, right, top, bottom])) in labels.iter().enumerate() {
            let at = file.display();
            assert!(*left >= 0.0 && *right <= width && *top >= 0.0 && *bottom <= height, "{at}: `{a}` is off the page");
            for (b, [l, r, t, u]) in &labels[..k] {
                let apart = left >= r || l >= right || top >= u || t >= bottom;
                assert!(apart, "{at}: `{a}` lies on `{b}`: {:?} {:?}", [left, right, top, bottom], [l, r, t, u]);
            }
        }
        assert!(figure.contains("<title>") && figure.contains("<desc>"));
        count += 1;
    }
    assert!(count > 10, "{count}");
}
