//! What a report says of its answers: that a solution is the only one, and apart from it how exact its values are.

use willis::analysis::{Selection, analyze};
use willis::diagnostic::Severity;
use willis::work::Serial;
use willis_figure::report::document::{Block, Document, Level};
use willis_figure::{ReportRequest, report};

use crate::trains::model;

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
                assert!(text.contains(&law.law), "{name} {}: {} is not named in `{text}`", o.name, law.law);
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
        for d in warnings.iter().take(6) {
            let own = |n: &&(Level, &str)| n.1.starts_with(d.code.as_str()) && n.1.contains(&d.message);
            assert_eq!(first.iter().filter(own).count(), 1, "{name}: {}", d.message);
            counted += 1;
        }
        assert!(warnings.len() <= 6 || first.iter().any(|n| n.1.contains("more stand under")), "{name}");
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
    let shift = tables("Shift table");
    let heads: Vec<&str> = shift[0].1.iter().map(|c| c.head.as_str()).filter(|h| h.contains('η')).collect();
    assert_eq!(heads, ["Nominal η driving", "Nominal η coasting"]);
    let points = tables("Question and answer");
    assert!(points[0].0.contains("not the nominal one of the shift table"), "{}", points[0].0);
}
