//! Messages and names of quantities in words: no keys, no marks of code, numbers in fitting units.

use crate::parts::style::{figures, watts};

/// A message without marks of code. What stands between backticks is quoted; a key is written as words, a name as it is.
pub fn plain(text: &str, is_name: &dyn Fn(&str) -> bool) -> String {
    let mut out = String::with_capacity(text.len());
    for (k, part) in text.split('`').enumerate() {
        match k % 2 {
            0 => out.push_str(&numbers(&sentence(part, is_name))),
            _ if part.is_empty() => {}
            _ if is_name(part) => out.push_str(&format!("“{part}”")),
            _ => out.push_str(&format!("“{}”", key(part))),
        }
    }
    out
}

/// A sentence without keys: what has underscores and is no name.
fn sentence(text: &str, is_name: &dyn Fn(&str) -> bool) -> String {
    let inside = |c: char| c.is_alphanumeric() || c == '_' || c == '.' || c == '-';
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let end = rest.find(|c| !inside(c)).unwrap_or(rest.len()).max(if inside(c) { 0 } else { c.len_utf8() });
        let (word, behind) = rest.split_at(end);
        let part = |name: &str| is_name(name) || name.split('.').any(is_name);
        match word.contains('_') && !part(word) {
            true => out.push_str(&word.replace('_', " ")),
            false => out.push_str(word),
        }
        rest = behind;
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
    let (path, rest) = quantity.split_once(' ').map_or((quantity, ""), |(path, rest)| (path, rest));
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
        _ => word.replace("..", " to "),
    };
    rest.split(' ').filter(|w| !w.is_empty()).fold(words, |all, word| all + " " + &units(word))
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
        let names = |name: &str| name == "sun_1";
        let words = |text: &str| plain(text, &names);
        assert_eq!(words("set `mesh_friction`, not `sun_1`"), "set “mesh friction”, not “sun_1”");
        assert_eq!(words("teeth as (z_ring - z_sun)/2 of sun_1"), "teeth as (z ring − z sun)/2 of sun_1");
        assert_eq!(words("-14944 W at -3.5 N m, 12 W"), "−14.94 kW at −3.5 N m, 12 W");
        assert_eq!(words("error of 1.25e-7 of 2-4, 40-38, v1.2"), "error of 1.25·10⁻⁷ of 2-4, 40-38, v1.2");
        assert_eq!(words("shift-element 8HP70, ISO VG-32, 3 W/K, P1.2"), "shift-element 8HP70, ISO VG-32, 3 W/K, P1.2");
    }

    #[test]
    fn places_are_words() {
        assert_eq!(spelled("P4.mesh_efficiency.external 0.976..0.984"), "P4, mesh efficiency, external 0.976 to 0.984");
        assert_eq!(spelled("sun_1.speed 55..65 degC; x"), "sun_1, speed 55 to 65 °C; x");
        assert_eq!(spelled("load"), "load");
        assert_eq!(place("set[0].geometry.profile_shift"), "set 1, geometry, profile shift");
        assert_eq!(place("operation[11]"), "operation 12");
        assert_eq!(place("oil"), "oil");
    }
}
