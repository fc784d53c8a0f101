//! Figures on dark paper.
//!
//! A figure is drawn for light paper, with every colour as `#rrggbb` in an attribute. Colours of categories have a dark
//! counterpart that was chosen with them, since the same hues are not the best ones on black; tints mix it with the dark
//! paper. Of all others lightness is turned round in OKLab (Ottosson 2020), where equal steps look equal; hue and chroma
//! stay.

use std::collections::BTreeSet;

use crate::parts::markup::{is_colour, rewrite};
use crate::parts::style::{COLOURS, INK, category, mixed};

/// The counterpart of white.
const NIGHT: [u8; 3] = [0x0d, 0x0d, 0x0d];

/// On which paper a figure stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theme {
    /// Dark on white, for print.
    Light,
    /// Light on near-black.
    Dark,
    /// As the reader's screen is set.
    Auto,
}

/// A figure for a paper. Light leaves it as it is.
///
/// # Example
/// ```
/// use willis_figure::{Theme, themed};
///
/// let light = r##"<svg xmlns="http://www.w3.org/2000/svg"><path fill="#ffffff"/></svg>"##;
/// assert_eq!(themed(light, Theme::Light), light);
/// assert!(!themed(light, Theme::Dark).contains("#ffffff"));
/// assert!(themed(light, Theme::Auto).contains("prefers-color-scheme: dark"));
/// ```
pub fn themed(svg: &str, theme: Theme) -> String {
    match theme {
        Theme::Light => svg.to_owned(),
        Theme::Dark => rewrite(svg, |name, value| is_colour(name, value).then(|| dark(value))),
        Theme::Auto => {
            let rules = rules(&colours(svg), "");
            let style = format!("<style>@media (prefers-color-scheme: dark) {{\n{rules}}}</style>");
            // Behind the root's own tag.
            let open = svg.find("<svg").and_then(|at| svg[at..].find('>').map(|end| at + end + 1));
            let (head, rest) = svg.split_at(open.unwrap_or(0));
            format!("{head}\n{style}{rest}")
        }
    }
}

/// Attribute and colour of everything that has a colour.
pub(crate) fn colours(svg: &str) -> BTreeSet<(String, String)> {
    let mut all = BTreeSet::new();
    rewrite(svg, |name, value| {
        if is_colour(name, value) {
            all.insert((name.to_owned(), value.to_owned()));
        }
        None
    });
    all
}

/// Rules that give everything with a colour its dark colour, each below a selector.
pub(crate) fn rules(colours: &BTreeSet<(String, String)>, below: &str) -> String {
    colours.iter().map(|(name, value)| format!("{below}[{name}=\"{value}\"] {{ {name}: {} }}\n", dark(value))).collect()
}

/// The counterpart of a light colour on dark paper.
pub(crate) fn dark(light: &str) -> String {
    if let Some((k, strength)) = category(light) {
        // A tint is as faint on black as on white only if it covers a little more.
        return mixed(NIGHT, COLOURS[k][1], strength.powf(0.85));
    }
    let [lightness, a, b] = oklab(rgb(light));
    let ink = oklab(rgb(INK))[0];
    let chroma = a.hypot(b);
    // 0 for paper, 1 for ink.
    let depth = ((1.0 - lightness) / (1.0 - ink)).clamp(0.0, 1.0);
    let vivid = (chroma / 0.1).min(1.0);
    let turned = 0.16 + 0.8 * depth.powf(1.0 - 0.5 * vivid);
    // As much chroma as a screen can show at that lightness.
    let shown = (0..=50).map(|k| 1.0 - f64::from(k) / 50.0).map(|part| linear([turned, part * a, part * b]));
    let fits = |c: &[f64; 3]| c.iter().all(|x| (-1e-4..=1.0001).contains(x));
    let colour = shown.into_iter().find(fits).expect("greys can be shown");
    let [r, g, b] = colour.map(|x| (255.0 * encoded(x)).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Linear red, green and blue of `#rrggbb`.
fn rgb(hex: &str) -> [f64; 3] {
    [1, 3, 5].map(|at| {
        let byte = u8::from_str_radix(&hex[at..at + 2], 16).expect("checked to be #rrggbb");
        let x = f64::from(byte) / 255.0;
        if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    })
}

/// What a screen is sent for a linear part.
fn encoded(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

fn times(matrix: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn oklab(rgb: [f64; 3]) -> [f64; 3] {
    const CONES: [[f64; 3]; 3] = [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ];
    const LAB: [[f64; 3]; 3] = [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ];
    times(LAB, times(CONES, rgb).map(f64::cbrt))
}

fn linear(lab: [f64; 3]) -> [f64; 3] {
    const CONES: [[f64; 3]; 3] =
        [[1.0, 0.3963377774, 0.2158037573], [1.0, -0.1055613458, -0.0638541728], [1.0, -0.0894841775, -1.2914855480]];
    const RGB: [[f64; 3]; 3] = [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ];
    times(RGB, times(CONES, lab).map(|x| x * x * x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::style::{FAINT, LINE, PAPER, colour};

    fn luminance(hex: &str) -> f64 {
        let [r, g, b] = rgb(hex);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    /// As the Web Content Accessibility Guidelines define it.
    fn contrast(one: &str, other: &str) -> f64 {
        let (one, other) = (luminance(one) + 0.05, luminance(other) + 0.05);
        one.max(other) / one.min(other)
    }

    #[test]
    fn what_is_read_is_readable_on_dark_paper() {
        let paper = dark(PAPER);
        assert!(contrast(&dark(INK), &paper) >= 12.0);
        assert!(contrast(&dark(FAINT), &paper) >= 4.5);
        assert!(contrast(&dark(LINE), &paper) >= 2.5);
        assert!(contrast(LINE, PAPER) >= 3.0);
        for category in (0..14).map(Some).chain([None]) {
            let full = dark(&colour(category, 1.0));
            assert!(contrast(&full, &paper) >= 3.0, "{category:?}: {full}");
            let light = colour(category, 1.0);
            assert!(contrast(&light, PAPER) >= 3.0, "{category:?}: {light}");
            let tint = dark(&colour(category, 0.25));
            assert!(contrast(&dark(INK), &tint) >= 7.0, "{category:?}: {tint}");
        }
    }

    #[test]
    fn more_colour_stays_more_colour() {
        for category in (0..14).map(Some).chain([None]) {
            let steps: Vec<f64> = (0..=20).map(|k| luminance(&dark(&colour(category, f64::from(k) / 20.0)))).collect();
            assert!(steps.windows(2).all(|w| w[0] < w[1]), "{category:?}: {steps:?}");
        }
    }

    /// What eyes without one kind of cone see of linear red, green and blue (Machado, Oliveira, Fernandes 2009).
    const VISION: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    ];

    #[test]
    fn no_two_categories_look_alike_to_anybody_on_either_paper() {
        let seen = |hex: &str, eye: usize| oklab(times(VISION[eye], rgb(hex)).map(|x| x.clamp(0.0, 1.0)));
        for paper in [Theme::Light, Theme::Dark] {
            let all: Vec<String> = (0..14)
                .map(|k| colour(Some(k), 1.0))
                .map(|c| if paper == Theme::Dark { dark(&c) } else { c })
                .collect();
            for (k, one) in all.iter().enumerate() {
                for other in &all[..k] {
                    for eye in 0..VISION.len() {
                        let [a, b] = [one, other].map(|c| seen(c, eye));
                        let apart = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
                        assert!(apart >= 0.06, "{paper:?} {one} and {other}, eye {eye}: {apart}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_colour_is_known_by_its_category_and_strength() {
        for k in 0..14 {
            for strength in [0.3, 0.42, 0.62, 0.8, 1.0] {
                let (found, part) = category(&colour(Some(k), strength)).expect("one of them");
                assert!(found == k && (part - strength).abs() < 0.01, "{k} {strength}: {found} {part}");
            }
        }
        assert_eq!([PAPER, INK, FAINT, LINE].map(category), [None; 4]);
    }

    #[test]
    fn only_colours_change() {
        let svg = r##"<svg><!-- #ffffff --><title>a > #ffffff</title><text id="#ffffff" fill='#ffffff' stroke="none">#1a1a1a</text></svg>"##;
        let white = dark("#ffffff");
        let expected = format!(
            "<svg><!-- #ffffff --><title>a > #ffffff</title><text id=\"#ffffff\" fill='{white}' stroke=\"none\">#1a1a1a</text></svg>"
        );
        assert_eq!(themed(svg, Theme::Dark), expected);
        assert_eq!(themed(svg, Theme::Auto).matches("[fill=").count(), 1);
    }

    #[test]
    fn black_and_white_are_the_ends() {
        assert_eq!(dark("#000000"), dark(INK));
        assert_eq!([dark("#ffffff"), dark("#1a1a1a")], ["#0d0d0d", "#f2f2f2"]);
    }
}
