//! One look for all figures: type sizes, line weights, colours, and the few shapes built of them.

use svg::Node;
use svg::node::element::{self, Element};

pub const INK: &str = "#1a1a1a";
pub const FAINT: &str = "#6b6b6b";
pub const LINE: &str = "#9a9a9a";
pub const PAPER: &str = "#ffffff";

/// Distinguishable with every kind of colour vision (Okabe and Ito 2008, then Tol's muted scheme).
const COLOURS: [[u8; 3]; 14] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
    [0x88, 0x22, 0x55],
    [0x99, 0x99, 0x33],
    [0x33, 0x22, 0x88],
    [0x44, 0xaa, 0x99],
    [0xaa, 0x44, 0x99],
    [0x11, 0x77, 0x33],
    [0xdd, 0xcc, 0x77],
    [0x66, 0x11, 0x00],
];
const HEAT: [u8; 3] = [0x4d, 0x4d, 0x4d];

/// The colour of a category, mixed with paper: strength 1 is the full colour.
pub fn colour(category: Option<usize>, strength: f64) -> String {
    let own = category.map_or(HEAT, |k| COLOURS[k % COLOURS.len()]);
    let mix = |c: u8| (255.0 + (f64::from(c) - 255.0) * strength.clamp(0.0, 1.0)).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(own[0]), mix(own[1]), mix(own[2]))
}

#[derive(Clone, Copy)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// Text, its baseline at y.
pub fn text(x: f64, y: f64, size: f64, anchor: Anchor, content: &str) -> element::Text {
    let anchor = match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    element::Text::new(content)
        .set("x", number(x))
        .set("y", number(y))
        .set("font-size", number(size))
        .set("text-anchor", anchor)
        .set("fill", INK)
}

/// Advance widths of DejaVu Sans from U+0020 to U+007E in thousandths of the size: the widest of the
/// faces that a figure names, so that what fits in it fits in all.
const WIDTHS: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636, 636, 636, 636, 636,
    636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863,
    748, 787, 603, 787, 695, 635, 611, 732, 684, 989, 685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635,
    615, 352, 635, 634, 278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636,
    337, 636, 838,
];

/// How wide a text is, at most.
pub fn wide(content: &str, size: f64) -> f64 {
    let one = |c: char| match c {
        ' '..='~' => f64::from(WIDTHS[c as usize - 32]) / 1000.0,
        '·' => 0.32,
        '°' => 0.5,
        '²' | '³' => 0.41,
        // Marks that stand on the letter before.
        '\u{0300}'..='\u{036f}' => 0.0,
        '→' | '−' | '×' | '≤' | '≥' => 0.84,
        '\u{00a1}'..='\u{04ff}' => 0.7,
        // Chinese, Japanese, Korean and the rest: a square.
        _ => 1.0,
    };
    size * content.chars().map(one).sum::<f64>()
}

/// Bold text is wider.
pub const BOLD: f64 = 1.1;

/// A text that fits into a width, cut if need be.
pub fn fit(content: &str, width: f64, size: f64) -> String {
    if wide(content, size) <= width {
        return content.to_owned();
    }
    let mut kept = String::new();
    for c in content.chars() {
        kept.push(c);
        if wide(&kept, size) + size > width {
            kept.pop();
            break;
        }
    }
    kept.push('…');
    kept
}

/// A sentence in lines that fit.
pub fn lines(content: &str, width: f64, size: f64) -> Vec<String> {
    let mut all = vec![String::new()];
    for word in content.split_whitespace() {
        let last = all.last_mut().expect("never empty");
        if last.is_empty() {
            *last = fit(word, width, size);
        } else if wide(last, size) + wide(" ", size) + wide(word, size) > width {
            all.push(fit(word, width, size));
        } else {
            last.push(' ');
            last.push_str(word);
        }
    }
    all
}

/// Three digits, or as many as the integer part has.
pub fn digits(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{x:.1e}").replace('-', "−");
    }
    let decimals = (2 - size.log10().floor() as i32).clamp(0, 5) as usize;
    let text = format!("{x:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.replace('-', "−")
}

/// A letter in a circle.
pub fn badge(x: f64, y: f64, content: &str) -> element::Group {
    element::Group::new()
        .add(
            element::Circle::new()
                .set("cx", number(x))
                .set("cy", number(y))
                .set("r", 9)
                .set("fill", PAPER)
                .set("stroke", INK)
                .set("stroke-width", 1),
        )
        .add(text(x, y + 4.0, 12.0, Anchor::Middle, content))
}

pub fn line(from: (f64, f64), to: (f64, f64), colour: &str, width: f64) -> element::Line {
    element::Line::new()
        .set("x1", number(from.0))
        .set("y1", number(from.1))
        .set("x2", number(to.0))
        .set("y2", number(to.1))
        .set("stroke", colour)
        .set("stroke-width", number(width))
}

pub fn rectangle(x: f64, y: f64, width: f64, height: f64, fill: &str) -> element::Rectangle {
    element::Rectangle::new()
        .set("x", number(x))
        .set("y", number(y))
        .set("width", number(width))
        .set("height", number(height))
        .set("fill", fill)
}

/// A page with its title and description.
pub fn page(width: f64, height: f64, title: &str, description: &str) -> svg::Document {
    let mut head = Element::new("title");
    head.append(svg::node::Text::new(title));
    let mut words = Element::new("desc");
    words.append(svg::node::Text::new(description));
    svg::Document::new()
        .set("viewBox", (0, 0, width as i32, height as i32))
        .set("width", width as i32)
        .set("height", height as i32)
        .set("role", "img")
        .set("font-family", "Inter, 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif")
        .add(head)
        .add(words)
        .add(rectangle(0.0, 0.0, width, height, PAPER))
}

/// A coordinate with as many digits as a picture can show.
pub fn number(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Numbers at even steps within a range, about so many.
pub fn ticks(low: f64, high: f64, about: usize) -> Vec<f64> {
    let raw = (high - low) / about as f64;
    let size = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * size).find(|s| *s >= raw).unwrap_or(raw);
    let first = (low / step).ceil() as i64;
    (first..).map(|k| k as f64 * step).take_while(|x| *x <= high + step * 1e-9).collect()
}
