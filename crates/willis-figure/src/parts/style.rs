//! One look for all figures: type sizes, line weights, colours, and the few shapes built of them.

use svg::Node;
use svg::node::element::{self, Element};

pub const INK: &str = "#1a1a1a";
pub const FAINT: &str = "#6b6b6b";
pub const LINE: &str = "#8f8f8f";
pub const PAPER: &str = "#ffffff";

/// The colours of categories on light and on dark paper, found by a search: contrast above 3 on their paper, and as far apart
/// as can be for normal, protan, deutan and tritan vision, from ink too. The first eight are chosen for eight members; the
/// others are the farthest from what is there already.
pub const COLOURS: [[[u8; 3]; 2]; 14] = [
    [[0x25, 0x4a, 0x91], [0x6e, 0x99, 0xee]],
    [[0xa5, 0x58, 0x35], [0xe7, 0x59, 0x08]],
    [[0x12, 0x91, 0x71], [0x1f, 0x9a, 0x6d]],
    [[0xdd, 0x50, 0xa5], [0xdd, 0x66, 0xb7]],
    [[0xcf, 0x7f, 0x1f], [0xf5, 0x9e, 0x03]],
    [[0x0b, 0x9b, 0xcd], [0x7f, 0xd6, 0xfb]],
    [[0x99, 0x26, 0x60], [0xfb, 0xa9, 0xb4]],
    [[0x53, 0x4f, 0x00], [0xcc, 0xe1, 0x76]],
    [[0x4b, 0x00, 0x5a], [0xc3, 0x2d, 0xb4]],
    [[0xb4, 0x2d, 0xff], [0x96, 0x3c, 0xff]],
    [[0x00, 0x00, 0x96], [0x69, 0x69, 0xd2]],
    [[0x87, 0x00, 0xd2], [0x78, 0xc3, 0x78]],
    [[0x69, 0x1e, 0x3c], [0xb4, 0xff, 0x1e]],
    [[0xa5, 0x78, 0xff], [0x3c, 0xff, 0xb4]],
];
const HEAT: [u8; 3] = [0x4d, 0x4d, 0x4d];

/// The colour of a category, mixed with paper: strength 1 is the full colour.
pub fn colour(category: Option<usize>, strength: f64) -> String {
    let own = category.map_or(HEAT, |k| COLOURS[k % COLOURS.len()][0]);
    mixed([255; 3], own, strength)
}

/// A colour that covers its paper with that strength, as `#rrggbb`.
pub fn mixed(paper: [u8; 3], own: [u8; 3], strength: f64) -> String {
    let one = |k: usize| {
        let (p, c) = (f64::from(paper[k]), f64::from(own[k]));
        (p + (c - p) * strength.clamp(0.0, 1.0)).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", one(0), one(1), one(2))
}

/// The category and strength of which a colour is made, where it is one of [`colour`].
pub fn category(hex: &str) -> Option<(usize, f64)> {
    let byte = |at: usize| u8::from_str_radix(hex.get(at..at + 2)?, 16).ok();
    let shown = [byte(1)?, byte(3)?, byte(5)?];
    let tried = COLOURS.iter().enumerate().filter_map(|(k, [own, _])| {
        // The strength that fits all channels best; rounding may leave one step in each.
        let away = |c: [u8; 3]| c.map(|c| 255.0 - f64::from(c));
        let (full, part) = (away(*own), away(shown));
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let strength = dot(full, part) / dot(full, full);
        let off = full.iter().zip(part).map(|(f, p)| (f * strength - p).abs()).fold(0.0, f64::max);
        (strength > 0.0 && strength < 1.002 && off <= 1.0).then_some((k, strength.min(1.0), off))
    });
    // Faint tints may belong to several: then it does not matter which.
    tried.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(k, strength, _)| (k, strength))
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

/// A text with a rim in the colour of its ground, so that it can be read over lines. The rim is a text of its own beneath:
/// `paint-order` would do with one, but LibreOffice, CairoSVG and others ignore it and paint the rim over the words.
pub fn halo(t: element::Text, ground: &str, width: f64) -> element::Group {
    let rim = t
        .clone()
        .set("fill", ground)
        .set("stroke", ground)
        .set("stroke-width", number(width))
        .set("stroke-linejoin", "round")
        .set("aria-hidden", "true")
        .set("pointer-events", "none");
    element::Group::new().add(rim).add(t)
}

/// An element with its full name, which a pointer that rests on it shows.
pub fn titled(t: element::Text, name: &str) -> element::Group {
    let mut title = Element::new("title");
    title.append(svg::node::Text::new(name));
    element::Group::new().add(title).add(t)
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
        '⁰' | '⁴'..='⁹' | '¹' | '⁻' => 0.53,
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

/// A text that fits into a width, cut if need be, but never within a number: half a number is a wrong one. A text that is
/// nothing but a number stays whole, so that room for it is the business of the layout.
pub fn fit(content: &str, width: f64, size: f64) -> String {
    if wide(content, size) <= width {
        return content.to_owned();
    }
    let all: Vec<char> = content.chars().collect();
    if all.len() <= LONGEST_NUMBER && content_is_number(&all) {
        return content.to_owned();
    }
    let mut used = size;
    let fits = |c: &&char| {
        used += wide(&c.to_string(), size);
        used <= width
    };
    let mut kept = all.iter().take_while(fits).count();
    if let Some(number) = number_across(&all, kept) {
        kept = number;
    }
    kept = before_numbers(&all[..kept]);
    let mut shown: String = all[..kept].iter().collect();
    shown.truncate(shown.trim_end().len());
    shown.push('…');
    shown
}

/// What numbers are written with.
fn numeric(c: char) -> bool {
    c.is_ascii_digit() || matches!(c, '.' | '/' | '·' | '⁰' | '¹' | '²' | '³' | '⁴'..='⁹' | '⁻')
}

fn sign(c: char) -> bool {
    matches!(c, '−' | '-' | '+' | '±')
}

/// The longest number that figures print, signs included; what is longer is a name of digits.
const LONGEST_NUMBER: usize = 24;

/// Where the number begins that a cut before that place would part; digits within a name are none.
fn number_across(all: &[char], cut: usize) -> Option<usize> {
    let inside = *all.get(cut)?;
    if !numeric(inside) || cut == 0 || !(numeric(all[cut - 1]) || sign(all[cut - 1])) {
        return None;
    }
    let mut from = cut;
    while from > 0 && numeric(all[from - 1]) {
        from -= 1;
    }
    if from > 0 && sign(all[from - 1]) {
        from -= 1;
    }
    let to = cut + all[cut..].iter().take_while(|c| numeric(**c)).count();
    let free = from == 0 || all[from - 1].is_whitespace() || matches!(all[from - 1], '(' | '[' | '=' | '≈' | ':');
    (free && to - from <= LONGEST_NUMBER).then_some(from)
}

/// How much is left without numbers at the end: whether they are whole is not to be seen before an ellipsis.
fn before_numbers(all: &[char]) -> usize {
    let mut end = all.len();
    loop {
        let trimmed = all[..end].iter().rposition(|c| !c.is_whitespace()).map_or(0, |k| k + 1);
        let from = all[..trimmed].iter().rposition(|c| c.is_whitespace() || "(=:".contains(*c)).map_or(0, |k| k + 1);
        let token = &all[from..trimmed];
        let digits = token.iter().skip_while(|c| sign(**c));
        if from == 0 || token.len() > LONGEST_NUMBER || digits.clone().next().is_none() {
            return end;
        }
        if !digits.clone().next().is_some_and(char::is_ascii_digit) || !digits.clone().all(|c| numeric(*c) || *c == ',')
        {
            return end;
        }
        end = from;
    }
}

fn content_is_number(all: &[char]) -> bool {
    all.iter().enumerate().all(|(k, c)| numeric(*c) || k == 0 && sign(*c))
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
    figures(x, 3)
}

/// So many digits, or as many as the integer part has; very large and very small numbers as powers of ten.
pub fn figures(x: f64, count: i32) -> String {
    let size = x.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !size.is_finite() {
        return if x.is_nan() {
            "–"
        } else if x > 0.0 {
            "∞"
        } else {
            "−∞"
        }
        .to_owned();
    }
    let trimmed = |text: String| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').replace('-', "−"),
        false => text.replace('-', "−"),
    };
    if !(1e-3..1e6).contains(&size) {
        let precision = (count - 1).max(0) as usize;
        let text = format!("{x:.precision$e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let raised = exponent.chars().map(|c| match c {
            '-' => '⁻',
            c => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][c.to_digit(10).unwrap_or(0) as usize],
        });
        return format!("{}·10{}", trimmed(mantissa.to_owned()), raised.collect::<String>());
    }
    let decimals = (count - 1 - size.log10().floor() as i32).clamp(0, count + 2) as usize;
    trimmed(format!("{x:.decimals$}"))
}

/// One unit for all powers of a picture, by the largest of them: its watts, and its name.
pub fn power_unit(most: f64) -> (f64, &'static str) {
    match most {
        w if w >= 5e6 => (1e6, "MW"),
        w if w >= 5e3 => (1e3, "kW"),
        w if w > 0.0 && w < 0.05 => (1e-3, "mW"),
        _ => (1.0, "W"),
    }
}

/// A power: four digits, in the unit that suits it.
pub fn watts(power: f64) -> String {
    let (scale, unit) = match power.abs() {
        p if p >= 999.95e3 => (1e6, "MW"),
        p if p >= 999.95 => (1e3, "kW"),
        p if p >= 1e-3 || p == 0.0 => (1.0, "W"),
        p if p >= 1e-6 => (1e-3, "mW"),
        _ => (1e-6, "µW"),
    };
    format!("{} {unit}", figures(power / scale, 4))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_is_cut() {
        for x in [-984_812.3, 9848.0, -0.00123, 1.2345e9, -7.5e-9, 123_456.0, 1e6 - 0.4] {
            for size in [9.0, 10.0, 11.0] {
                for room in [0.0, 5.0, 20.0, 40.0] {
                    let whole = figures(x, 4);
                    assert_eq!(fit(&whole, room, size), whole);
                    let shown = fit(&format!("sun: {whole} N m"), room, size);
                    let rest = shown.trim_end_matches('…').trim_end();
                    assert!(!rest.contains(|c: char| c.is_ascii_digit()) || rest.contains(&whole), "{shown}");
                }
            }
        }
        // Digits of a name may go, and a name of a hundred digits is none of a figure's numbers.
        assert_eq!(fit("carrier-of-stage-2222b", 105.0, 10.0), "carrier-of-stage-22…");
        assert!(fit(&"7".repeat(100), 60.0, 10.0).ends_with('…'));
        assert_eq!(fit("97/35", 10.0, 10.0), "97/35");
        assert_eq!(fit("Wolfrom drive 236:1, at 3000 rpm", 165.0, 10.0), "Wolfrom drive 236:1, at…");
    }

    #[test]
    fn numbers_keep_their_figures_however_large() {
        assert_eq!(digits(0.5), "0.5");
        assert_eq!(digits(-123.4), "−123");
        assert_eq!(digits(123_456.7), "123457");
        assert_eq!(digits(1_234_567.0), "1.23·10⁶");
        assert_eq!(figures(-9_848_123.0, 4), "−9.848·10⁶");
        assert_eq!(figures(4.5678e-5, 4), "4.568·10⁻⁵");
        assert_eq!([figures(f64::INFINITY, 3), figures(f64::NAN, 3)], ["∞", "–"]);
    }
}
