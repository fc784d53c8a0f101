//! What a report says of its answers: that a solution is the only one, and apart from it how exact its values are.

use willis::analysis::{Selection, analyze};
use willis::diagnostic::Severity;
use willis::work::Serial;
use willis_figure::report::document::{Block, Document, Level, TitleBlock};
use willis_figure::{ReportRequest, html, report};

use crate::common::examples;
use crate::trains::{code_in, model, names};

/// The only operating point, several of them, laws outside their ranges, computed losses, given efficiencies, locked.
const TRAINS: [&str; 6] = [
    "fva-planetary-stage",
    "nrel-5mw-stage-1",
    "zf-8hp70",
    "prius-hybrid",
    "wolfrom-498-self-locking",
    "textbook-reverted",
];

fn notices(blocks: &[Block]) -> impl Iterator<Item = (Level, &str)> {
    blocks.iter().filter_map(|b| match b {
        Block::Notice { level, text } => Some((*level, text.as_str())),
        _ => None,
    })
}

fn section<'a>(document: &'a Document, title: &str) -> &'a [Block] {
    document.sections.iter().find(|s| s.title == title).map_or(&[], |s| &s.blocks)
}

#[test]
fn a_value_out_of_range_is_never_under_the_sign_of_a_proof() {
    let (mut outside, mut banded) = (0, 0);
    for name in TRAINS {
        let model = model(name);
        let analysis = analyze(model.train(), &Selection::default()).unwrap();
        let document = report(&model, &ReportRequest::default(), &Serial).unwrap();
        let points = section(&document, "Operating points");
        for (level, text) in document.sections.iter().flat_map(|s| notices(&s.blocks)) {
            assert!(level != Level::Good || !text.contains('%'), "{name}: a value under a proof: {text}");
        }
        for o in analysis.operations.iter().filter(|o| o.solutions.len() == 1) {
            let heads = points.iter().position(|b| matches!(b, Block::Heading { text } if text.starts_with(&o.name)));
            let own = &points[heads.unwrap()..];
            let values: Vec<_> = notices(own).filter(|(_, text)| text.starts_with("Value: efficiency")).collect();
            let Some((level, text)) = values.first() else { panic!("{name} {}: nothing about its value", o.name) };
            assert_eq!(*level == Level::Warning, !o.outside_laws.is_empty(), "{name} {}: {text}", o.name);
            for law in &o.outside_laws {
                // By its authors, not by its name in files.
                let said = text.to_lowercase();
                let named = law.law.split(['-', '_']).all(|part| said.contains(part));
                assert!(named, "{name} {}: {} is not named in `{text}`", o.name, law.law);
                outside += 1;
            }
            banded += usize::from(text.contains("90 % of"));
        }
    }
    assert!(outside >= 2 && banded >= 5, "{outside} outside, {banded} with a band");
}

#[test]
fn warnings_stand_on_the_first_page() {
    let mut counted = 0;
    for name in TRAINS {
        let model = model(name);
        let analysis = analyze(model.train(), &Selection::default()).unwrap();
        let document = report(&model, &ReportRequest::default(), &Serial).unwrap();
        let first: Vec<_> = notices(&document.sections[0].blocks).filter(|n| n.0 == Level::Warning).collect();
        let warnings: Vec<_> = analysis.diagnostics.iter().filter(|d| d.severity == Severity::Warning).collect();
        for code in warnings.iter().take(6).map(|d| d.code.as_str()) {
            let expected = warnings.iter().take(6).filter(|d| d.code.as_str() == code).count();
            let own = first.iter().filter(|n| n.1.ends_with(&format!("{code})"))).count();
            assert_eq!(own, expected, "{name}: {code}");
            counted += 1;
        }
        assert!(warnings.len() <= 6 || first.iter().any(|n| n.1.contains("more stand under")), "{name}");
        assert!(notices(&document.sections[0].blocks).any(|n| n.1.contains("Not examined: strength")), "{name}");
    }
    assert!(counted >= 4, "{counted}");
}

/// A nominal efficiency and one of an operating point are different numbers, and each says at its head which it is.
#[test]
fn two_efficiencies_are_told_apart() {
    let document = report(&model("zf-8hp70"), &ReportRequest::default(), &Serial).unwrap();
    let tables = |title: &str| {
        let own = section(&document, title).iter().filter_map(|b| match b {
            Block::Table { caption, columns, .. } => Some((caption.clone(), columns.clone())),
            _ => None,
        });
        own.collect::<Vec<_>>()
    };
    let first = tables("Summary");
    assert!(first[0].0.contains("with the nominal efficiencies"), "{}", first[0].0);
    assert!(first[1].0.contains("not the nominal one of the shift table"), "{}", first[1].0);
    let shift = section(&document, "Shift table");
    let caption = shift.iter().find_map(|b| match b {
        Block::Figure { caption, .. } => Some(caption.as_str()),
        _ => None,
    });
    assert_eq!(caption, Some("States, ratios, steps and nominal efficiencies"));
}

#[test]
fn all_gears_stand_in_the_first_table() {
    for (name, gears) in [("zf-8hp70", 9), ("aisin-tl-80sn", 10), ("wolfrom-498-self-locking", 1)] {
        let model = model(name);
        let document = report(&model, &ReportRequest::default(), &Serial).unwrap();
        let first = document.sections[0].blocks.iter().find_map(|b| match b {
            Block::Table { columns, rows, .. } => Some((columns, rows)),
            _ => None,
        });
        let (columns, rows) = first.unwrap();
        assert_eq!(columns.len(), 2 + gears, "{name}");
        for quantity in ["Ratio", "Efficiency", "Speed", "Torque"] {
            assert!(
                // Before the gears stand the quantity and what it is of.
                rows.iter().any(|r| r[0] == quantity && r[2..].iter().any(|gear| !gear.is_empty())),
                "{name} {quantity}"
            );
        }
        for state in model.train().states() {
            assert!(columns.iter().any(|c| c.head == state.name), "{name}: {}", state.name);
        }
    }
}

/// Every word of a report but commands and the train file.
fn words(document: &Document) -> Vec<&str> {
    let mut all = vec![];
    for block in document.sections.iter().flat_map(|s| &s.blocks) {
        match block {
            Block::Heading { text } | Block::Text { text } | Block::Notice { text, .. } => all.push(text.as_str()),
            Block::List { items } => all.extend(items.iter().map(String::as_str)),
            Block::Table { caption, columns, rows } => {
                all.push(caption);
                all.extend(columns.iter().map(|c| c.head.as_str()));
                all.extend(rows.iter().flatten().map(String::as_str));
            }
            Block::Figure { caption, .. } => all.push(caption),
            Block::Formula { note, .. } => all.push(note),
            Block::Terms { items, .. } => all.extend(items.iter().map(|t| t.text.as_str())),
            _ => {}
        }
    }
    all
}

#[test]
fn words_are_no_code_and_numbers_are_for_people() {
    for (name, _) in examples() {
        let model = model(&name);
        let train = model.train();
        let names = names(train);
        let document = report(&model, &ReportRequest::default(), &Serial).unwrap();
        for block in document.sections.iter().flat_map(|s| &s.blocks) {
            let Block::Figure { caption, svg } = block else { continue };
            let picture = roxmltree::Document::parse(svg).expect("well-formed");
            for text in picture.descendants().filter_map(|n| n.text()) {
                assert_eq!(code_in(text, &names), None, "{name}, {caption}: code in `{text}`");
            }
        }
        for text in words(&document) {
            assert_eq!(code_in(text, &names), None, "{name}: code in `{text}`");
            for word in text.split(|c: char| c.is_whitespace() || "()[],;:=“”/".contains(c)) {
                let number = word.trim_end_matches('.');
                // The name of an operating point may hold one, and so may the file's source.
                let mut own = names.iter().copied().chain(train.source());
                let named = own.any(|n| n.split_whitespace().any(|own| own.contains(number)));
                let machine = number.parse::<f64>().is_ok() && (number.starts_with('-') || number.contains('e'));
                let machine = machine && !named;
                assert!(!machine, "{name}: a number of a machine in `{text}`");
            }
            // Powers of more than a thousand watts are kilowatts.
            let all: Vec<&str> = text.split_whitespace().collect();
            for pair in all.windows(2).filter(|w| w[1].trim_end_matches(['.', ',', ';']) == "W") {
                let power: f64 = pair[0].trim_start_matches(['−', '+', '(']).parse().unwrap_or(0.0);
                assert!(power < 1000.0, "{name}: {} W in `{text}`", pair[0]);
            }
        }
    }
}

#[test]
fn the_title_block_and_the_appendix_are_as_asked() {
    let model = model("textbook-reverted");
    let plain = report(&model, &ReportRequest::default(), &Serial).unwrap();
    assert_eq!(plain.title_block.entries().count(), 0);
    assert!(!plain.sections.iter().any(|s| s.title.starts_with("Appendix")));
    let title_block = TitleBlock { project: "<b>P</b>".into(), date: "May".into(), ..Default::default() };
    let request = ReportRequest { title_block, appendix: true, ..Default::default() };
    let asked = report(&model, &request, &Serial).unwrap();
    assert!(asked.sections.last().unwrap().title.starts_with("Appendix"));
    let page = html(&asked);
    assert!(page.contains("&lt;b&gt;P&lt;&#x2f;b&gt;") || page.contains("&lt;b&gt;P&lt;/b&gt;"), "escaped");
    assert!(!page.contains("Author"));
}
