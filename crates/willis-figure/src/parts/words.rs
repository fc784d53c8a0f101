//! Messages and names of quantities in words: no keys, no marks of code, numbers in fitting units.

use std::collections::HashMap;
use std::sync::OnceLock;

use willis::losses::entries;
use willis::operating_point::LossKind;

use crate::parts::style::{figures, watts};

/// Names that a user gave, which stay as they are.
pub struct Names<'n> {
    all: Vec<&'n str>,
    /// Those that would not stay: only these are looked for in a sentence, or a gear `1` would part a number 1.25.
    changed: Vec<&'n str>,
}

impl<'n> Names<'n> {
    pub fn new(all: impl IntoIterator<Item = &'n str>) -> Self {
        let all: Vec<&str> = all.into_iter().collect();
        let mut changed: Vec<&str> = all.iter().copied().filter(|name| told(name) != **name).collect();
        // Of names that begin alike the longest is meant.
        changed.sort_unstable_by_key(|name| std::cmp::Reverse(name.len()));
        Self { all, changed }
    }

    fn has(&self, text: &str) -> bool {
        self.all.contains(&text)
    }

    /// Where the first of them stands as words of its own.
    fn first<'t>(&self, text: &'t str) -> Option<(usize, &'t str)> {
        let ends = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric() && c != '_');
        let stands = |at: usize, name: &str| {
            ends(text[..at].chars().next_back()) && ends(text[at + name.len()..].chars().next())
        };
        let place = |name: &&str| {
            let at = text.match_indices(*name).map(|(at, _)| at).find(|at| stands(*at, name))?;
            Some((at, &text[at..at + name.len()]))
        };
        // Of several in one place the first in the list: the longest.
        self.changed.iter().filter_map(place).min_by_key(|found| found.0)
    }
}

/// A message without marks of code. What stands between backticks is quoted; a key is written as words, a name as it is.
pub fn plain(text: &str, names: &Names<'_>) -> String {
    let mut out = String::with_capacity(text.len());
    for (k, part) in text.split('`').enumerate() {
        match k % 2 {
            0 => prose(part, names, &mut out),
            _ if part.is_empty() => {}
            _ if names.has(part) => out.push_str(&format!("“{part}”")),
            _ if by().contains_key(part) => out.push_str(&law(part)),
            _ => out.push_str(&format!("“{}”", key(part))),
        }
    }
    out
}

/// What stands between names, without keys and with numbers for people.
fn prose(mut text: &str, names: &Names<'_>, out: &mut String) {
    while let Some((at, name)) = names.first(text) {
        out.push_str(&told(&text[..at]));
        out.push_str(name);
        text = &text[at + name.len()..];
    }
    out.push_str(&told(text));
}

/// A sentence without keys, which have underscores, and with numbers for people.
fn told(text: &str) -> String {
    numbers(&by_authors(text).replace('_', " "))
}

/// Whose a law is: by the name of each law that goes by one.
fn by() -> &'static HashMap<&'static str, &'static str> {
    static BY: OnceLock<HashMap<&str, &str>> = OnceLock::new();
    BY.get_or_init(|| entries().iter().filter(|e| !e.by.is_empty()).map(|e| (e.id, e.by)).collect())
}

/// A law by its authors: `schlenk` is Schlenk, `two-pair` is two pair.
pub fn law(id: &str) -> String {
    by().get(id).map_or_else(|| id.replace(['-', '_'], " "), |by| (*by).to_owned())
}

/// A law of a family: by its authors, or, where it goes by none, what it is.
pub fn law_of(family: &str, id: &str) -> String {
    let all = entries();
    let own = all.iter().find(|e| e.family == family && e.id == id);
    match own.filter(|e| e.by.is_empty()) {
        Some(e) => format!("{family}: {}", e.title),
        None => format!("{family} = {id}"),
    }
}

/// A law that causes a loss of some kind, by its title; a law of one name stands in several families.
pub fn law_title(kind: Option<LossKind>, id: &str) -> String {
    if id == "given" {
        return if kind == Some(LossKind::Drag) { "torque given" } else { "efficiency given" }.to_owned();
    }
    let families = kind.map_or(&[][..], LossKind::families);
    let all = entries();
    let own = families.iter().find_map(|f| all.iter().find(|e| e.family == *f && e.id == id));
    own.map_or_else(|| law(id), |e| e.title.to_owned())
}

/// A sentence in which laws have the names of their authors: `friction = schlenk` is friction by Schlenk.
fn by_authors(text: &str) -> String {
    let within = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let end = rest.find(|c| !within(c)).unwrap_or(rest.len());
        let word = &rest[..end];
        if word.is_empty() {
            out.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        }
        match by().get(word) {
            Some(authors) => {
                if out.ends_with(" = ") {
                    out.truncate(out.len() - "= ".len());
                    out.push_str("by ");
                }
                out.push_str(authors);
            }
            None => out.push_str(word),
        }
        rest = &rest[end..];
    }
    out
}

/// A key as words: `mesh_friction` is mesh friction.
fn key(text: &str) -> String {
    let letters = |w: &str| w.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    let word = |w: &str| if w.contains('_') && w.split('_').all(letters) { w.replace('_', " ") } else { w.to_owned() };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// The name of a quantity and what follows it, in words: `P1.mesh_efficiency.external 0.97..0.99` is
/// P1, mesh efficiency, external 0.97 to 0.99.
pub fn spelled(quantity: &str) -> String {
    // A name may have blanks; a path ends at the first behind its first key.
    let key = |at: &usize| quantity[at + 1..].starts_with(|c: char| c.is_ascii_lowercase());
    let first = quantity.match_indices('.').map(|found| found.0).find(key).unwrap_or(0);
    let end = quantity[first..].find(' ').map_or(quantity.len(), |at| first + at);
    let (path, rest) = quantity.split_at(end);
    let mut parts = path.split('.');
    // The first is a name, which stays.
    let mut words = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        words += if part.starts_with(|c: char| c.is_ascii_lowercase()) { ", " } else { "." };
        words += &part.replace('_', " ");
    }
    let units = |word: &str| match word.trim_end_matches([',', ';']) {
        "um" => word.replace("um", "µm"),
        "degC" => word.replace("degC", "°C"),
        _ => word.split("..").map(rounded).collect::<Vec<_>>().join(" to "),
    };
    let rest = by_authors(rest);
    rest.split(' ').filter(|w| !w.is_empty()).fold(words, |all, word| all + " " + &units(word))
}

/// Decimals in a word to four figures: `lognormal(1, 1.28403)` is no more certain for its digits.
fn rounded(word: &str) -> String {
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    let mut all = String::new();
    let mut rest = word;
    while let Some(start) = rest.find(is_part) {
        let end = rest[start..].find(|c| !is_part(c)).map_or(rest.len(), |at| start + at);
        let number = &rest[start..end];
        all += &rest[..start];
        let figures = number.trim_start_matches(['0', '.']).bytes().filter(u8::is_ascii_digit).count();
        match number.parse::<f64>() {
            // A name may hold digits, and an exponent belongs to its number.
            Ok(x)
                if number.contains('.')
                    && figures > 4
                    && (all.is_empty() || all.ends_with(['(', '-', '±']))
                    && !rest[end..].starts_with(['e', 'E']) =>
            {
                let decimals = 3 - x.abs().log10().floor() as i32;
                let text = format!("{x:.*}", decimals.max(0) as usize);
                all += if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
            }
            _ => all += number,
        }
        rest = &rest[end..];
    }
    all + rest
}

/// Fields of answers, and what people call them.
const FIELDS: [(&str, &str); 5] = [
    ("event_times", "times of events"),
    ("film_ratio", "film ratio"),
    ("input_power_w", "input power"),
    ("loss_w", "loss"),
    ("power_w", "power"),
];

/// A quantity that a mark stands for, in words: `input_power_w 5 kW` is input power 5 kW. What is no field stays, because it may
/// be a name.
pub fn quantity(name: &str) -> String {
    let (first, rest) = name.split_once(' ').map_or((name, ""), |(first, rest)| (first, rest));
    match FIELDS.iter().find(|f| f.0 == first) {
        Some((_, field)) => format!("{field} {rest}").trim_end().to_owned(),
        None => name.to_owned(),
    }
}

/// What a chart runs over: `sun.speed` is speed of sun, `P1.mesh_efficiency` is P1, mesh efficiency.
pub fn along(name: &str) -> String {
    match name.rsplit_once('.') {
        Some(("oil", "temperature")) => "oil temperature".to_owned(),
        Some((who, what @ ("speed" | "torque" | "power"))) => format!("{what} of {who}"),
        _ => spelled(name),
    }
}

/// Where something stands in a train file, in words: `set[0].geometry.profile_shift` is set 1, geometry, profile shift.
pub fn place(path: &str) -> String {
    let part = |part: &str| match part.strip_suffix(']').and_then(|p| p.split_once('[')) {
        Some((name, index)) => match index.parse::<usize>() {
            Ok(k) => format!("{} {}", name.replace('_', " "), k + 1),
            Err(_) => format!("{} {index}", name.replace('_', " ")),
        },
        None => part.replace('_', " "),
    };
    path.split('.').map(part).collect::<Vec<_>>().join(", ")
}

/// A true minus sign, powers in fitting units, large and small numbers as powers of ten.
fn numbers(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    let mut before = ' ';
    while let Some(c) = rest.chars().next() {
        let number = number_at(rest).filter(|_| !(before.is_alphanumeric() || ".,_/·^−".contains(before)));
        match number.and_then(|n| Some((n, rest[..n].parse::<f64>().ok()?))) {
            Some((n, x)) => {
                let behind = &rest[n..];
                let unit = |u: &str| {
                    behind.strip_prefix(u).filter(|b| !b.starts_with(|c: char| c.is_alphanumeric() || "/·".contains(c)))
                };
                if let Some(behind) = unit(" W") {
                    out += &watts(x);
                    rest = behind;
                } else {
                    let long = rest[..n].contains('e');
                    out += &if long { figures(x, 4) } else { rest[..n].replace('-', "−") };
                    rest = behind;
                }
                before = '0';
            }
            None if rest.starts_with("- ") && before == ' ' => {
                out.push('−');
                rest = &rest[1..];
                before = '−';
            }
            None => {
                out.push(c);
                rest = &rest[c.len_utf8()..];
                before = if c == '-' { '_' } else { c };
            }
        }
    }
    out
}

/// How long the number is with which a text begins.
fn number_at(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut at = usize::from(bytes.first() == Some(&b'-'));
    let whole = digits(at);
    if whole == 0 {
        return None;
    }
    at += whole;
    if bytes.get(at) == Some(&b'.') && digits(at + 1) > 0 {
        at += 1 + digits(at + 1);
    }
    if bytes.get(at) == Some(&b'e') {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'-' | b'+')));
        match digits(at + 1 + sign) {
            0 => {}
            n => at += 1 + sign + n,
        }
    }
    Some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_code_is_left() {
        let names = Names::new(["sun_1", "1500 W at -5 N m", "1500 W", "1", "P1.2"]);
        let words = |text: &str| plain(text, &names);
        assert_eq!(words("set `mesh_friction`, not `sun_1`"), "set “mesh friction”, not “sun_1”");
        assert_eq!(words("teeth as (z_ring - z_sun)/2 of sun_1"), "teeth as (z ring − z sun)/2 of sun_1");
        assert_eq!(words("-14944 W at -3.5 N m, 12 W"), "−14.94 kW at −3.5 N m, 12 W");
        assert_eq!(words("error of 1.25e-7 of 2-4, 40-38, v1.2"), "error of 1.25·10⁻⁷ of 2-4, 40-38, v1.2");
        assert_eq!(words("in 1500 W at -5 N m, 1500 W and 1600 W"), "in 1500 W at -5 N m, 1500 W and 1.6 kW");
        assert_eq!(words("sun_12 and my_sun_1 of `1500 W`"), "sun 12 and my sun 1 of “1500 W”");
        assert_eq!(words("shift-element 8HP70, ISO VG-32, 3 W/K, P1.2"), "shift-element 8HP70, ISO VG-32, 3 W/K, P1.2");
    }

    #[test]
    fn laws_have_authors_or_plain_words() {
        let names = Names::new(["diab"]);
        assert_eq!(plain("tooth friction by `schlenk`, `diab`", &names), "tooth friction by Schlenk, “diab”");
        assert_eq!(plain("mesh_friction = niemann-winter of diab", &names), "mesh friction by Niemann–Winter of diab");
        assert_eq!(spelled("law.mesh_friction schlenk, constant"), "law, mesh friction Schlenk, constant");
        assert_eq!(law_title(Some(LossKind::Windage), "anderson-loewenthal"), "Anderson and Loewenthal 1980");
        // A law of one name in several families is the same people's.
        for e in entries() {
            assert_eq!(by().get(e.id).copied().unwrap_or_default(), e.by, "{}: {}", e.family, e.id);
        }
    }

    #[test]
    fn places_are_words() {
        assert_eq!(spelled("P4.mesh_efficiency.external 0.976..0.984"), "P4, mesh efficiency, external 0.976 to 0.984");
        assert_eq!(spelled("sun_1.speed 55..65 degC; x"), "sun_1, speed 55 to 65 °C; x");
        let rough = "P1.geometry.roughness 0.66664..0.99996 um, lognormal(1, 1.28403), 1.5e-12345, 12345 h";
        let told = "P1, geometry, roughness 0.6666 to 1 µm, lognormal(1, 1.284), 1.5e-12345, 12345 h";
        assert_eq!(spelled(rough), told);
        assert_eq!(spelled("load"), "load");
        assert_eq!(quantity("input_power_w 5 kW"), "input power 5 kW");
        assert_eq!(quantity("loss_w"), "loss");
        assert_eq!(spelled("stage 2.mesh_efficiency 0.9..0.95"), "stage 2, mesh efficiency 0.9 to 0.95");
        assert_eq!(quantity("sun_1 at rest"), "sun_1 at rest");
        assert_eq!(place("set[0].geometry.profile_shift"), "set 1, geometry, profile shift");
        assert_eq!(place("operation[11]"), "operation 12");
        assert_eq!(place("oil"), "oil");
    }
}
