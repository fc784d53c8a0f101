//! Reports as web pages: well-formed, on their own, and nothing in them but what was said.

use std::collections::BTreeSet;

use roxmltree::{Document as Xml, Node, ParsingOptions};
use willis_figure::html;
use willis_figure::report::document::{Block, Column, Document, Level, Section, Term, TitleBlock};

const EVIL: &str = "太阳轮 <b onload=\"x\">&amp;</b> {{ 7 * 7 }} {% if %} ]]> --> </style> 'q'";

fn figure() -> String {
    concat!(
        "<?xml version=\"1.0\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 8 8\" role=\"img\">",
        "<title>A set</title><defs><clipPath id=\"a\"><path d=\"M0 0h8v8z\"/></clipPath></defs>",
        "<path clip-path=\"url(#a)\" fill=\"#0072b2\" stroke=\"#1a1a1a\" d=\"M0 0h8v8z\"/></svg>"
    )
    .to_owned()
}

fn document() -> Document {
    let text = || EVIL.to_owned();
    let formula = |latex: &str| Block::Formula { latex: latex.into(), note: text() };
    let blocks = vec![
        Block::Heading { text: text() },
        Block::Text { text: text() },
        Block::List { items: vec![text(), String::new()] },
        Block::Table {
            caption: text(),
            columns: vec![Column::words(EVIL), Column::numbers("Ratio")],
            rows: vec![vec![text(), "−2.5".into()]; 3],
        },
        Block::Figure { caption: text(), svg: figure() },
        Block::Figure { caption: text(), svg: figure() },
        formula(r"\eta = -\frac{\left(1 - i_{\mathrm{P1\_a\&b\text{-}c}}\right)^{2}}{3 \omega_{太}}"),
        formula(r"\begin{aligned}&a + b \\ &{}- \frac{1}{2}\end{aligned}"),
        formula(r"a < b > c \text{ <b> } \mathrm{<\&>} \left\langle x \right\rangle"),
        formula(r"\text{<b>&} \nosuch{<i>}"),
        Block::Terms { head: text(), items: vec![Term { latex: "i_{0} < 0".into(), text: text() }] },
        Block::Terms { head: text(), items: vec![Term { latex: r"\nosuch{<i>}".into(), text: text() }] },
        Block::Code { text: text() },
    ];
    let notices =
        [Level::Good, Level::Note, Level::Warning, Level::Stop].map(|level| Block::Notice { level, text: text() });
    let sections = [blocks, notices.to_vec(), vec![]].map(|blocks| Section { title: text(), blocks });
    let facts = vec![[text(), text()]];
    let title_block = TitleBlock { project: text(), author: text(), date: text(), revision: text() };
    let sections = sections.to_vec();
    Document { format: Default::default(), title: text(), subtitle: text(), title_block, facts, sections }
}

fn with_page(look: impl FnOnce(&str, &Xml<'_>)) {
    let page = html(&document());
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let xml = Xml::parse_with_options(&page, options).expect("well-formed");
    look(&page, &xml);
}

fn named<'a>(xml: &'a Xml<'_>, name: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    xml.descendants().filter(move |n| n.tag_name().name() == name)
}

#[test]
fn names_stay_text() {
    with_page(|_, xml| {
        assert_eq!(named(xml, "b").count() + named(xml, "i").count() + named(xml, "script").count(), 0);
        for place in ["h1", "h3", "p", "li", "td", "th", "figcaption", "dt", "dd", "code", "a"] {
            let says = |n: Node<'_, '_>| n.descendants().filter_map(|d| d.text()).collect::<String>().contains(EVIL);
            assert!(named(xml, place).any(says), "{place}");
        }
        let attributes = xml.descendants().flat_map(|n| n.attributes());
        assert!(!attributes.into_iter().any(|a| a.name().starts_with("on")));
    });
}

#[test]
fn ids_are_unique_and_links_lead_somewhere() {
    with_page(|_, xml| {
        let mut ids = BTreeSet::new();
        for node in xml.descendants() {
            assert!(node.attribute("id").is_none_or(|id| ids.insert(id)), "{:?}", node.attribute("id"));
        }
        let links: Vec<&str> = named(xml, "a").filter_map(|a| a.attribute("href")).collect();
        assert_eq!(links.len(), 3);
        assert!(links.iter().all(|l| ids.contains(l.strip_prefix('#').expect("on this page"))));
        let clips: Vec<&str> = xml.descendants().filter_map(|n| n.attribute("clip-path")).collect();
        assert_eq!(clips, ["url(#figure-1-a)", "url(#figure-2-a)"]);
    });
}

#[test]
fn nothing_is_loaded() {
    with_page(|page, xml| {
        let spaces =
            ["http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg", "http://www.w3.org/1998/Math/MathML"];
        let rest = spaces.iter().fold(page.to_owned(), |rest, space| rest.replace(&format!("xmlns=\"{space}\""), ""));
        assert!(!rest.contains("http://") && !rest.contains("https://") && !rest.contains("@import"));
        assert!(rest.match_indices("url(").all(|(at, _)| rest[at..].starts_with("url(#")));
        for node in xml.descendants() {
            assert!(node.attribute("src").is_none());
            assert!(node.attribute("href").is_none_or(|to| to.starts_with('#')));
        }
    });
}

#[test]
fn formulas_are_set_or_shown_as_written() {
    with_page(|_, xml| {
        assert_eq!(named(xml, "math").count(), 4);
        assert!(named(xml, "code").any(|c| c.text() == Some(r"\text{<b>&} \nosuch{<i>}")));
    });
}

#[test]
fn every_colour_of_a_figure_has_a_dark_one() {
    with_page(|page, xml| {
        for node in xml.descendants().filter(|n| n.ancestors().any(|a| a.tag_name().name() == "svg")) {
            for name in ["fill", "stroke"] {
                let Some(colour) = node.attribute(name) else { continue };
                assert!(page.contains(&format!(".picture [{name}=\"{colour}\"] {{")), "{name} {colour}");
            }
        }
    });
}

#[test]
fn one_document_is_always_the_same_page() {
    assert_eq!(html(&document()), html(&document()));
}

#[test]
fn a_document_survives_its_journey_as_json() {
    let json = serde_json::to_string(&document()).expect("plain data");
    assert_eq!(serde_json::from_str::<Document>(&json).expect("as written"), document());
}
