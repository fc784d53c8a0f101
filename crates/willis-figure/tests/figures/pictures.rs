//! Every kind of figure of every example train is looked at by a machine: words that touch, words off the page,
//! marks that nobody can see, empty pictures, numbers that are none.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use resvg::usvg::{self, Options, Tree, fontdb, roxmltree};
use willis::model::Model;
use willis_figure::{Drawing, Figure, FigureKind, FigureRequest, draw, tikz};

use crate::common::examples;
use crate::trains::{code_in, hard, model, names};

/// Only the face that every machine has, so that the same boxes are measured everywhere.
fn faces() -> Arc<fontdb::Database> {
    let mut faces = fontdb::Database::new();
    faces.load_font_data(dejavu::sans::regular().to_vec());
    faces.load_font_data(dejavu::sans::bold().to_vec());
    faces.set_sans_serif_family("DejaVu Sans");
    Arc::new(faces)
}

/// Boxes of the inked parts of all texts, with their words.
fn texts(group: &usvg::Group, into: &mut Vec<(String, usvg::Rect)>) {
    for node in group.children() {
        match node {
            usvg::Node::Text(t) => {
                let words: String = t.chunks().iter().map(|c| c.text()).collect();
                into.push((words, t.flattened().abs_bounding_box()));
            }
            usvg::Node::Group(g) => texts(g, into),
            _ => {}
        }
    }
}

/// Whether the last thing before an ellipsis is a number, or a part of one: nobody can tell which.
fn cuts_a_number(words: &str) -> bool {
    // What stands behind the last ellipsis was not cut.
    words.split('…').rev().skip(1).any(|before| {
        let last = before.rsplit([' ', '(', '=', ':']).next().unwrap_or("");
        let last = last.trim_start_matches(['−', '-', '+', '±']);
        // `stage 1.` begins a name; `fit` parts no number at its point.
        let number = |c: char| c.is_ascii_digit() || ".,/·⁻".contains(c);
        last.starts_with(|c: char| c.is_ascii_digit()) && last.chars().all(number) && !last.ends_with('.')
    })
}

/// Contrast with white, as the Web Content Accessibility Guidelines define it.
fn contrast(hex: &str) -> f64 {
    let part = |at: usize| {
        let x = f64::from(u8::from_str_radix(&hex[at..at + 2], 16).expect("#rrggbb")) / 255.0;
        if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    };
    1.05 / (0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5) + 0.05)
}

/// Lines that only guide the eye, and rims in the colour of the paper.
const GUIDES: [&str; 5] = ["#ffffff", "#ececec", "#e4e4e4", "#dcdcdc", "#c8c8c8"];

/// What is wrong with a picture.
fn faults(svg: &str, faces: &Arc<fontdb::Database>) -> Vec<String> {
    let mut wrong = vec![];
    for none in ["NaN", "inf"] {
        let bad = |v: &str| v.split([' ', ',', '(', ')']).any(|w| w.trim_start_matches('-') == none);
        let document = roxmltree::Document::parse(svg).expect("well-formed");
        if document.descendants().flat_map(|n| n.attributes()).any(|a| bad(a.value())) {
            wrong.push(format!("a coordinate is {none}"));
        }
    }
    let document = roxmltree::Document::parse(svg).expect("well-formed");
    let root = document.root_element();
    let child = |name: &str| root.children().find(|n| n.has_tag_name(name)).and_then(|n| n.text()).unwrap_or("");
    if child("title").is_empty() || child("desc").trim().len() < 20 {
        wrong.push(format!("no title, or no description: {:?}", child("desc")));
    }
    let painted = |n: &roxmltree::Node<'_, '_>, what: &str| {
        let own = n.ancestors().find_map(|a| a.attribute(what));
        own.map_or(what == "fill", |v| v != "none")
    };
    for n in document.descendants().filter(|n| n.has_tag_name("text")) {
        let size = n.ancestors().find_map(|a| a.attribute("font-size")).and_then(|s| s.parse::<f64>().ok());
        if size.is_none_or(|s| s < Drawing::SMALLEST_TEXT) {
            wrong.push(format!("a text of size {size:?}: {:?}", n.text()));
        }
    }
    let mut marks = 0;
    for n in document.descendants() {
        let number = |name: &str| n.attribute(name).and_then(|v| v.parse::<f64>().ok());
        let shape = ["path", "rect", "circle", "line", "polygon", "polyline", "ellipse"].contains(&n.tag_name().name());
        let defined = n.ancestors().any(|a| ["defs", "clipPath", "pattern", "marker"].contains(&a.tag_name().name()));
        if !shape || defined {
            continue;
        }
        marks += 1;
        // Every mark says what it stands for, or that it only guides the eye; the first is the paper.
        let says = |a: roxmltree::Node<'_, '_>| {
            let alive = ["member", "mesh", "element", "state", "quantity"]
                .iter()
                .any(|d| a.has_attribute(&*format!("data-{d}")));
            alive && a.has_attribute("id") || a.attribute("class") == Some("guide")
        };
        if marks > 1 && !n.ancestors().any(says) {
            wrong.push(format!("a mark of nothing: {}", &svg[n.range()].chars().take(120).collect::<String>()));
        }
        let line = n.has_tag_name("line");
        let stroke = n.ancestors().find_map(|a| a.attribute("stroke")).filter(|c| c.starts_with('#'));
        // Fills may have a rim of their own colour, which closes the seam to the next.
        let own = n.attribute("fill");
        if let Some(ink) = stroke.filter(|c| !GUIDES.contains(c) && Some(*c) != own && contrast(c) < 3.0) {
            wrong.push(format!("a line in {ink} has a contrast of {:.2} on white", contrast(ink)));
        }
        if !(painted(&n, "stroke") || painted(&n, "fill") && !line) {
            wrong.push(format!("invisible: {}", &svg[n.range()].chars().take(120).collect::<String>()));
        }
        let flat = match n.tag_name().name() {
            "rect" => number("width") <= Some(0.0) || number("height") <= Some(0.0),
            "circle" => number("r") <= Some(0.0),
            "path" => n.attribute("d").is_none_or(str::is_empty),
            "line" => number("x1") == number("x2") && number("y1") == number("y2"),
            _ => false,
        };
        if flat {
            wrong.push(format!("no size: {}", &svg[n.range()].chars().take(120).collect::<String>()));
        }
    }
    let mut ids = std::collections::BTreeSet::new();
    for n in document.descendants() {
        if n.attribute("id").is_some_and(|id| !ids.insert(id.to_owned()) || id.contains(' ')) {
            wrong.push(format!("an id that is not one mark's: {:?}", n.attribute("id")));
        }
    }
    let options = Options { fontdb: faces.clone(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).expect("proper SVG");
    let mut words = vec![];
    texts(tree.root(), &mut words);
    // Where there is nothing to draw, a sentence says why.
    let said = words.iter().any(|w| w.0.split_whitespace().count() >= 12);
    if words.len() < 3 || marks < 3 && !said {
        wrong.push(format!("empty: {marks} marks, {} texts", words.len()));
    }
    // The rim of a text is a text of its own, in the same place.
    let own: Vec<_> = words.clone();
    let rim = |k: usize| k > 0 && own[k - 1].0 == own[k].0 && own[k - 1].1 == own[k].1;
    let words: Vec<_> = (0..own.len()).filter(|k| !rim(*k)).map(|k| own[k].clone()).collect();
    if svg.contains("paint-order") {
        wrong.push("a rim by `paint-order`, which other programs paint over the words".to_owned());
    }
    for n in document.descendants().filter(|n| n.has_tag_name("text")) {
        let rim = n.attribute("aria-hidden").is_some();
        let rests = n.parent().into_iter().flat_map(|p| p.children()).filter(|c| c.has_tag_name("text"));
        if rim && rests.filter(|t| t.attribute("aria-hidden").is_none() && t.text() == n.text()).count() != 1 {
            wrong.push(format!("a rim without its words: {:?}", n.text()));
        }
    }
    let machine = |w: &str| {
        let all: Vec<char> = w.chars().collect();
        let exponent = |k: usize| all[k + 1..].first().is_some_and(|c| c.is_ascii_digit() || "+-−".contains(*c));
        (1..all.len()).any(|k| all[k] == 'e' && all[k - 1].is_ascii_digit() && exponent(k))
    };
    wrong.extend(words.iter().filter(|w| machine(&w.0)).map(|w| format!("a number of a machine: `{}`", w.0)));
    wrong.extend(words.iter().filter(|w| cuts_a_number(&w.0)).map(|w| format!("a number is cut: `{}`", w.0)));
    let page = tree.size();
    for (k, (word, b)) in words.iter().enumerate() {
        if b.left() < 0.0 || b.top() < 0.0 || b.right() > page.width() || b.bottom() > page.height() {
            wrong.push(format!("off the page: `{word}` at {:.0} {:.0}", b.left(), b.top()));
        }
        for (other, o) in &words[..k] {
            // Half a unit may be shared by what is antialiased.
            let apart = b.right() < o.left() + 0.5
                || o.right() < b.left() + 0.5
                || b.bottom() < o.top() + 0.5
                || o.bottom() < b.top() + 0.5;
            if !apart {
                wrong.push(format!("touch: `{other}` and `{word}` at {:.0} {:.0}", b.left(), b.top()));
            }
        }
    }
    wrong
}

/// Words of a picture that are keys of files or answers: what is seen, what a pointer is told, what is read aloud.
fn keys(svg: &str, model: &Model) -> Vec<String> {
    let names = names(model.train());
    let document = roxmltree::Document::parse(svg).expect("well-formed");
    let said = document.descendants().filter(|n| ["text", "tspan", "title", "desc"].contains(&n.tag_name().name()));
    let found = said.filter_map(|n| n.text().and_then(|t| Some((t, code_in(t, &names)?))));
    found.map(|(text, key)| format!("a reader sees `{key}` in `{text}`")).collect()
}

/// What of a picture LaTeX would not set: groups that stay open, statements without an end, text that would be a command.
fn misset(picture: &str) -> Vec<String> {
    /// What a picture may say beside text.
    const COMMANDS: [&str; 66] = [
        "definecolor",
        "begin",
        "end",
        "path",
        "node",
        "fontsize",
        "selectfont",
        "sffamily",
        "bfseries",
        "itshape",
        "phantom",
        "textbackslash",
        "textasciicircum",
        "textasciitilde",
        "textless",
        "textgreater",
        "pm",
        "cdot",
        "times",
        "leq",
        "geq",
        "approx",
        "rightarrow",
        "leftarrow",
        "leftrightarrow",
        "circ",
        "mu",
        "eta",
        "omega",
        "zeta",
        "lambda",
        "Sigma",
        "surd",
        "Delta",
        "Omega",
        "Sigma",
        "alpha",
        "beta",
        "delta",
        "eta",
        "gamma",
        "int",
        "kappa",
        "lambda",
        "mu",
        "nu",
        "omega",
        "pi",
        "psi",
        "rho",
        "sigma",
        "tau",
        "theta",
        "varepsilon",
        "varphi",
        "zeta",
        "infty",
        "ldots",
        "{",
        "}",
        "$",
        "&",
        "#",
        "%",
        "_",
        ",",
    ];
    let mut wrong = vec![];
    let mut open = vec![];
    let statements = picture.lines().filter(|l| !l.starts_with('%'));
    for line in statements {
        let (mut depth, mut maths) = (0i32, 0);
        let mut rest = line;
        while let Some(c) = rest.chars().next() {
            rest = &rest[c.len_utf8()..];
            match c {
                '\\' => {
                    let letters = rest.chars().take_while(char::is_ascii_alphabetic).count();
                    let length = if letters > 0 { letters } else { rest.chars().next().map_or(0, char::len_utf8) };
                    let name = &rest[..length];
                    if !COMMANDS.contains(&name) {
                        wrong.push(format!("a command `{name}` in `{line}`"));
                    }
                    rest = &rest[length..];
                }
                // Names may have letters of any language; signs and Greek letters are ours, and LaTeX does not know them as such.
                c if !c.is_ascii() && (!c.is_alphabetic() || ('Ͱ'..='Ͽ').contains(&c)) => {
                    wrong.push(format!("a bare `{c}` in `{line}`"));
                }
                '{' => depth += 1,
                '}' => depth -= 1,
                '$' => maths += 1,
                '%' | '#' | '&' => wrong.push(format!("a bare `{c}` in `{line}`")),
                '_' | '^' if maths % 2 == 0 => wrong.push(format!("a bare `{c}` in `{line}`")),
                _ => {}
            }
            if depth < 0 {
                wrong.push(format!("more closed than opened in `{line}`"));
            }
        }
        if depth != 0 || maths % 2 != 0 {
            wrong.push(format!("a group stays open in `{line}`"));
        }
        let name = |command: &str| line.strip_prefix(command).and_then(|l| l.split('}').next());
        if let Some(begun) = name("\\begin{") {
            open.push(begun);
        } else if let Some(ended) = name("\\end{") {
            if open.pop() != Some(ended) {
                wrong.push(format!("`{ended}` ends and did not begin"));
            }
        } else if !(line.starts_with("\\definecolor{") || open.last().is_some() && line.ends_with(';')) {
            wrong.push(format!("no statement: `{line}`"));
        }
        if line.contains("[clip,") {
            wrong.push(format!("TikZ takes no option beside `clip`: `{line}`"));
        }
        if line.contains("NaN") || line.contains("inf,") {
            wrong.push(format!("a place that is none: `{line}`"));
        }
    }
    if !open.is_empty() {
        wrong.push(format!("{open:?} does not end"));
    }
    wrong.truncate(3);
    wrong
}

/// Writes a picture as PNG into the folder `WILLIS_LOOK`, where somebody wants to look at all of them.
fn keep(name: &str, svg: &str, faces: &Arc<fontdb::Database>) {
    let Some(folder) = std::env::var_os("WILLIS_LOOK") else { return };
    let options = Options { fontdb: faces.clone(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).expect("proper SVG");
    let size = tree.size().to_int_size();
    let mut pixels = resvg::tiny_skia::Pixmap::new(size.width(), size.height()).expect("a size");
    resvg::render(&tree, Default::default(), &mut pixels.as_mut());
    let file = Path::new(&folder).join(name.replace(' ', "-"));
    std::fs::write(file.with_added_extension("svg"), svg).expect("a folder to look at");
    pixels.save_png(file.with_added_extension("png")).expect("a folder to look at");
}

#[test]
fn every_kind_of_every_example_is_fit_to_print() {
    let faces = faces();
    let (mut wrong, mut drawn) = (String::new(), BTreeMap::new());
    let own = examples().into_iter().map(|(name, _)| (model(&name), name));
    for (model, name) in own.chain(hard().into_iter().map(|(name, model)| (model, name.to_owned()))) {
        let applicable = FigureKind::applicable(&model);
        for kind in FigureKind::ALL {
            let request = FigureRequest { samples: 128, ..Default::default() };
            let quick = kind.effort(&model, &request).seconds < 1.0;
            let figure = match kind.make(&model, &request) {
                Ok(figure) => figure,
                Err(why) => {
                    // A kind that does not apply says why, and is not offered.
                    assert!(!applicable.contains(kind), "{name}: {} is offered: {why}", kind.name());
                    assert!(why.iter().all(|d| d.message.len() > 15), "{}: {}", name, kind.name());
                    continue;
                }
            };
            assert!(!quick || applicable.contains(kind), "{name}: {} is not offered", kind.name());
            *drawn.entry(kind.name()).or_insert(0) += 1;
            let text = serde_json::to_string(&figure).expect("plain data");
            let back: Figure = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{name} {}: {e}", kind.name()));
            assert_eq!(back, figure, "{name} {}: another figure is read back", kind.name());
            let svg = draw(&figure, Drawing::default());
            assert_eq!(svg, draw(&figure, Drawing::default()), "the same figure, the same bytes");
            keep(&format!("{name}.{}", kind.name()), &svg, &faces);
            let set = tikz(&svg);
            for fault in misset(&set) {
                let _ = writeln!(wrong, "{} {} as TikZ: {fault}", name, kind.name());
            }
            let cut = [svg.matches("clip-path=").count(), set.matches("\\path[clip").count()];
            assert_eq!(cut[0], cut[1], "{name} {}: what is cut off in the picture is so in TikZ", kind.name());
            // On a screen, on a page, on a page for figures alone.
            for width in [None, Some(770), Some(1180)] {
                let svg = draw(&figure, Drawing { width, ..Drawing::default() });
                let found = faults(&svg, &faces).into_iter().chain(keys(&svg, &model));
                for fault in found.take(5) {
                    let _ = writeln!(wrong, "{} {} {width:?}: {fault}", name, kind.name());
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
    // Each applies to several trains.
    for kind in FigureKind::ALL {
        assert!(drawn.get(kind.name()).copied().unwrap_or(0) >= 2, "{}: {drawn:?}", kind.name());
    }
}

/// A member has one colour, in every kind that gives colours to members: its place in the train.
#[test]
fn a_member_has_one_colour_in_all_kinds() {
    let mut seen = BTreeMap::new();
    for (name, _) in examples() {
        let model = model(&name);
        let train = model.train();
        for kind in ["stick", "lever", "front", "time"].map(|k| FigureKind::named(k).expect("a kind")) {
            let Ok(figure) = kind.make(&model, &FigureRequest { nominal: true, ..Default::default() }) else {
                continue;
            };
            let given: Vec<(&str, Option<usize>)> = match &figure {
                Figure::Stick(s) => s.members.iter().map(|m| (&*m.name, Some(m.colour))).collect(),
                Figure::Lever(l) => l.bars.iter().flat_map(|b| &b.nodes).map(|n| (&*n.member, n.colour)).collect(),
                Figure::Front(f) => f.wheels.iter().map(|w| (&*w.name, w.colour)).collect(),
                Figure::Time(t) => {
                    let speeds = t.panels.iter().filter(|p| p.quantity == "Speed");
                    speeds.flat_map(|p| &p.lines).map(|l| (&*l.names[0], l.colour)).collect()
                }
                _ => vec![],
            };
            for (member, colour) in given {
                let place = train.members().iter().position(|m| m.name == member).and_then(|k| k.checked_sub(1));
                assert_eq!(colour, place, "{name} {}: {member}", kind.name());
                *seen.entry(kind.name()).or_insert(0) += 1;
            }
        }
    }
    assert!(seen.len() == 4 && seen.values().all(|n| *n > 5), "{seen:?}");
}

/// Names that nobody expects: long, foreign, and full of markup.
#[test]
fn any_name_finds_its_place() {
    let long = "planet-carrier-of-the-second-intermediate-reduction-stage-2b";
    let text = |names: [&str; 4]| {
        let [s, r, c, train] = names;
        format!(
            r#"
            format = 1
            name = '{train}'
            members = ['{s}', '{r}', '{c}']
            terminals = ['{s}', '{c}']
            [[set]]
            name = 'P & <1>'
            sun = {{ member = '{s}', teeth = 30 }}
            planet = {{ teeth = 20, count = 4 }}
            ring = {{ member = '{r}', teeth = 70 }}
            carrier = '{c}'
            mesh_efficiency = 0.99
            geometry = {{ module = "2 mm", width = "20 mm" }}
            [[shift_element]]
            name = 'brake "B" & <b>'
            kind = "brake"
            members = ['{r}']
            [[state]]
            name = 'первая <1>'
            engaged = ['brake "B" & <b>']
            [[operation]]
            name = '满载 & <full>'
            state = 'первая <1>'
            speeds = {{ '{s}' = "1000 rpm" }}
            torques = {{ '{s}' = "10 N m" }}
            "#
        )
    };
    let faces = faces();
    let names = [["太阳轮", "齿圈", "行星架", "行星齿轮系 <1>"], ["sun & \"co\"", "<ring>", long, long]];
    for names in names {
        let text = text(names);
        let model = Model::from_toml(&text).unwrap_or_else(|r| panic!("{r}"));
        let mut drawn = 0;
        for kind in FigureKind::ALL {
            if let Ok(figure) = kind.make(&model, &FigureRequest { samples: 128, ..Default::default() }) {
                let found = faults(&draw(&figure, Drawing::default()), &faces);
                // Letters that the face lacks have no box there; all others do.
                assert!(found.is_empty(), "{} {names:?}: {found:#?}", kind.name());
                drawn += 1;
            }
        }
        assert!(drawn >= 6, "{names:?}: {drawn}");
    }
}

/// A few pictures as they were when somebody looked at them: words the same, places within a unit.
#[test]
fn regress_pictures() {
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/figures/pictures");
    let update = std::env::var_os("WILLIS_UPDATE").is_some();
    let chosen = [
        ("zf-8hp70", "stick"),
        ("zf-8hp70", "shift"),
        ("zf-8hp70", "lever"),
        ("prius-p112", "lever"),
        ("prius-p112", "regimes"),
        ("prius-p112", "sankey"),
        ("wang-herringbone-physical", "stick"),
        ("wang-herringbone-physical", "sankey"),
        ("wang-herringbone-physical", "flow"),
        ("wang-herringbone-physical", "losses"),
        ("fva-planetary-stage", "film"),
        ("fva-planetary-stage", "tornado"),
        ("fva-planetary-stage", "band"),
        ("galvagno", "stick"),
        ("simpson-ford-c4", "table"),
        ("launch", "modes"),
        ("fva-planetary-stage", "spin"),
    ];
    let mut changed = vec![];
    for (train, kind) in chosen {
        let kind = FigureKind::named(kind).expect("a kind of that name");
        let request = FigureRequest { samples: 128, ..Default::default() };
        let figure = kind.make(&model(train), &request).expect("it applies");
        let svg = draw(&figure, Drawing::default());
        let file = stored.join(format!("{train}.{}.svg", kind.name()));
        if update {
            std::fs::create_dir_all(&stored).expect("a folder for pictures");
            std::fs::write(&file, &svg).expect("a picture can be written");
            continue;
        }
        let before = std::fs::read_to_string(&file).unwrap_or_default();
        if let Some(what) = difference(&before, &svg) {
            changed.push(format!("{train} {}: {what}", kind.name()));
        }
    }
    assert!(changed.is_empty(), "look at them, then set WILLIS_UPDATE=1: {changed:#?}");
}

/// The first place where two pictures differ by more than a unit, or in words.
fn difference(before: &str, after: &str) -> Option<String> {
    let pieces = |text: &str| -> Vec<String> {
        let number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
        let mut all: Vec<String> = vec![];
        let mut last = None;
        for c in text.chars() {
            match (last == Some(number(c)), all.last_mut()) {
                (true, Some(piece)) => piece.push(c),
                _ => all.push(c.to_string()),
            }
            last = Some(number(c));
        }
        all
    };
    let (a, b) = (pieces(before), pieces(after));
    let at = a.iter().zip(&b).position(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(x), Ok(y)) => (x - y).abs() > 1.0 + 1e-6 * x.abs(),
        _ => a != b,
    });
    let around = |all: &[String], at: usize| all[at.saturating_sub(12)..(at + 6).min(all.len())].concat();
    match at {
        Some(at) => Some(format!("`{}` became `{}`", around(&a, at), around(&b, at))),
        None if a.len() != b.len() => Some(format!("{} pieces became {}", a.len(), b.len())),
        None => None,
    }
}
