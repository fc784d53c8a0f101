//! PDF of reports: the same bytes every time, words as they were said, no page too many.

use std::process::{Command, Stdio};
use std::{fs, io::Write};

use typst::layout::{Frame, FrameItem};
use typst_layout::PagedDocument;
use willis_pdf::document::{Block, Column, Document, Level, Plate, Section, Term, TitleBlock};
use willis_pdf::{Measured, Paper, Work, pages, pdf, read};

/// Words that would be markup, code or maths to typst.
const EVIL: &str = "#panic(\"no\") $x^2$ *bold* _it_ = @ref <a> `raw` \\u{41} // gone /* #eval(\"1\") [ { 太阳轮";

fn svg() -> String {
    let words = "<title>A &lt;set&gt;</title><desc>Two gears.</desc>";
    let text = "<text x=\"10\" y=\"40\" font-family=\"Inter, Arial, 'DejaVu Sans', sans-serif\">sun 太</text>";
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"900\" height=\"600\" viewBox=\"0 0 900 600\">{words}{text}</svg>"
    )
}

fn document(rows: usize) -> Document {
    let text = || EVIL.to_owned();
    let formula = |latex: &str| Block::Formula { latex: latex.into(), note: text() };
    let mut blocks = vec![
        Block::Heading { text: text() },
        Block::Text { text: text() },
        Block::List { items: vec![text()] },
        Block::Figure { caption: text(), svg: svg() },
        Block::Table {
            caption: text(),
            columns: vec![Column::words(EVIL), Column::numbers("Ratio")],
            rows: vec![vec![text(), "−2.5".into()]; rows],
        },
        formula(r"\eta = -\frac{\left(1 - i_{\mathrm{P1\_a\&b\text{-}c}}\right)^{2}}{3 \omega_{太}} \sqrt[3]{x}"),
        formula(r"\eta = \begin{cases} 1 & P \ge 0 \\ \eta_{0}^{-1} & \text{#panic()} \end{cases}"),
        formula(r"\begin{aligned}&a + b \\ &{}- \frac{1}{2}\end{aligned}"),
        formula(r"\nosuch #panic()"),
        Block::Terms {
            head: text(),
            items: vec![
                Term { latex: "i_{0} > 0".into(), text: text() },
                Term { latex: r"\nosuch".into(), text: text() },
            ],
        },
        Block::Code { text: text() },
    ];
    blocks.extend(
        [Level::Good, Level::Note, Level::Warning, Level::Stop].map(|level| Block::Notice { level, text: text() }),
    );
    let sections = vec![Section { title: text(), blocks }, Section { title: text(), blocks: vec![] }];
    let facts = vec![[text(), text()]];
    let title_block = TitleBlock { project: text(), author: text(), date: text(), revision: text() };
    Document { format: Default::default(), title: text(), subtitle: text(), title_block, facts, sections }
}

fn report(document: &Document) -> Work {
    Work::Report(Box::new(document.clone()))
}

fn words(document: &PagedDocument) -> String {
    fn collect(frame: &Frame, out: &mut String) {
        for (_, item) in frame.items() {
            match item {
                FrameItem::Group(group) => collect(&group.frame, out),
                FrameItem::Text(text) => out.push_str(&text.text),
                _ => {}
            }
        }
    }
    let mut out = String::new();
    document.pages().iter().for_each(|page| collect(&page.frame, &mut out));
    // Where long words may break.
    out.replace('\u{200b}', "")
}

#[test]
fn the_same_document_gives_the_same_bytes() {
    let document = report(&document(5));
    let bytes = pdf(&document, Paper::A4).unwrap();
    assert!(bytes.starts_with(b"%PDF-"));
    assert_eq!(bytes, pdf(&document, Paper::A4).unwrap());
    assert_ne!(bytes, pdf(&document, Paper::UsLetter).unwrap());
    assert!(!String::from_utf8_lossy(&bytes).contains("CreationDate"));
}

#[test]
fn words_stay_words() {
    let set = words(&pages(&report(&document(1)), Paper::A4).unwrap()).replace(char::is_whitespace, "");
    let said = EVIL.replace(char::is_whitespace, "");
    // Title, fact, section and its entry, heading, text, item, captions, head, cell, notes, code, notices.
    assert!(set.matches(&said).count() >= 18, "{}", set.matches(&said).count());
}

#[test]
fn tables_go_on_over_pages_with_their_heads() {
    let column = |words: &str| Column::words(words);
    let rows = (0..900).map(|k| vec![k.to_string(), "x".into()]).collect();
    let table = Block::Table { caption: "Long".into(), columns: vec![column("State"), column("Head of all")], rows };
    let mut document = document(1);
    document.sections = vec![Section { title: "One".into(), blocks: vec![table] }];
    let set = pages(&report(&document), Paper::A4).unwrap();
    let count = set.pages().len();
    assert!((11..=30).contains(&count), "{count}");
    let heads = words(&set).replace(' ', "").matches("Headofall").count();
    assert!((count - 1..=count).contains(&heads), "{heads} on {count}");
    assert!(words(&set).contains("Contents"));
}

#[test]
fn a_short_report_is_one_page_without_contents() {
    let mut document = document(1);
    document.sections = vec![Section { title: "One".into(), blocks: vec![Block::Text { text: "Short.".into() }] }];
    let set = pages(&report(&document), Paper::UsLetter).unwrap();
    assert_eq!(set.pages().len(), 1);
    assert!(!words(&set).contains("Contents"));
}

#[test]
fn empty_parts_do_no_harm() {
    let empty = Document {
        format: Default::default(),
        title: String::new(),
        subtitle: String::new(),
        title_block: TitleBlock::default(),
        facts: vec![],
        sections: vec![],
    };
    assert_eq!(pages(&report(&empty), Paper::A4).unwrap().pages().len(), 1);
    let mut document = document(0);
    document.sections[0].blocks.push(Block::Table { caption: String::new(), columns: vec![], rows: vec![] });
    document.sections[0].blocks.push(Block::List { items: vec![] });
    document.sections[0].blocks.push(Block::Formula { latex: String::new(), note: String::new() });
    pages(&report(&document), Paper::A4).unwrap();
}

#[test]
fn what_is_no_report_is_refused_in_words() {
    assert!(read("{").unwrap_err().starts_with("not JSON"));
    assert!(read("[1]").unwrap_err().contains("willis-report-1"));
    assert!(read(r#"{"format": "willis-report-9"}"#).unwrap_err().contains("willis-report-9"));
    assert!(read(r#"{"format": "willis-report-1"}"#).unwrap_err().contains("title"));
    let mut document = document(1);
    document.sections[0].blocks.push(Block::Figure { caption: String::new(), svg: "<svg".into() });
    assert!(pdf(&report(&document), Paper::A4).unwrap_err().starts_with("figure 2 is no SVG"));
}

/// A figure of that size with text of 11 units.
fn figure(width: u32, height: u32) -> String {
    let text = "<text x=\"10\" y=\"40\" font-family=\"'DejaVu Sans', sans-serif\" font-size=\"11\">sun</text>";
    let size = format!("width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\"");
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {size}><title>A</title>{text}</svg>")
}

#[test]
fn no_text_is_smaller_than_seven_points() {
    for paper in [Paper::A4, Paper::UsLetter] {
        let mut document = document(3);
        let wide = (1..14).map(|k| Column::numbers(format!("A long head {k}"))).collect();
        let rows = vec![(1..14).map(|k| format!("{k}00 000.123")).collect()];
        let blocks = &mut document.sections[0].blocks;
        blocks.push(Block::Table { caption: "Wide".into(), columns: wide, rows });
        let long = (0..40).map(|k| format!("a_{{{k}}}^{{2}}")).collect::<Vec<_>>().join(" + ");
        blocks.push(Block::Formula { latex: long, note: "Long".into() });
        let sizes = [(300, 200), (770, 500), (900, 600), (1180, 700), (700, 1300), (2600, 900), (9000, 7000)];
        for (width, height) in sizes {
            blocks.push(Block::Figure { caption: format!("{width} x {height}"), svg: figure(width, height) });
        }
        let set = pages(&report(&document), paper).unwrap();
        let found = Measured::of(&set);
        assert!((6.999..7.1).contains(&found.smallest), "{found:?}");
        // Pages of their own are as large as they need be, and no larger.
        let plates = set.pages().iter().filter(|p| p.frame.width() > p.frame.height()).count();
        assert!(plates >= 3, "{plates}");
    }
}

#[test]
fn a_figure_alone_is_a_page_of_its_size() {
    let plate = |width_mm| Plate { format: Default::default(), svg: figure(770, 300), width_mm };
    for (asked, points) in [(None, 577.5), (Some(174.0), 493.2), (Some(300.0), 850.4), (Some(50.0), 490.0)] {
        let json = serde_json::to_string(&plate(asked)).unwrap();
        let work = read(&json).unwrap();
        let set = pages(&work, Paper::A4).unwrap();
        assert_eq!(set.pages().len(), 1);
        let wide = set.pages()[0].frame.width().to_pt();
        assert!((wide - points).abs() < 0.1, "{asked:?}: {wide}");
        assert!(Measured::of(&set).smallest >= 6.999);
        assert!(pdf(&work, Paper::A4).unwrap().starts_with(b"%PDF-"));
    }
}

#[test]
fn a_failure_leaves_the_old_file() {
    let folder = std::env::temp_dir().join(format!("willis-pdf-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("x.pdf");
    let run = |input: &str| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_willis-pdf"))
            .args(["--paper", "us-letter", "-o"])
            .arg(&path)
            .stdin(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
        child.wait_with_output().unwrap()
    };
    assert!(run(&serde_json::to_string(&document(1)).unwrap()).status.success());
    let written = fs::read(&path).unwrap();
    assert!(written.starts_with(b"%PDF-"));
    let failed = run("{}");
    assert_eq!(failed.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&failed.stderr).starts_with("willis-pdf: no report"));
    assert_eq!(fs::read(&path).unwrap(), written);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    fs::remove_dir_all(&folder).unwrap();
}
