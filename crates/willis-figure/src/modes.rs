//! Shapes of vibration: a column a mode, a row a member or shaft.

use svg::node::element::Group;
use willis::dynamics::{ModesReport, Part};

use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{Anchor, BOLD, FAINT, LINE, colour, digits, fit, line, page, rectangle, text};

const LEFT: f64 = 190.0;
const COLUMN: f64 = 104.0;
const ROW: f64 = 22.0;
const TOP: f64 = 150.0;
/// Modes that find room.
const MOST: usize = 10;

/// A mode as the figure shows it.
struct Shown<'a> {
    heads: [String; 3],
    shape: &'a [Part],
    strain: &'a [Part],
}

/// Natural frequencies with their shapes (amplitude of every member, to the right and to the left of
/// a middle line) and the share of the strain energy of every shaft.
pub fn draw(all: &ModesReport) -> String {
    let rigid = all.rigid_body_modes.iter().map(|m| Shown {
        heads: ["rigid".to_owned(), "0 Hz".to_owned(), String::new()],
        shape: &m.shape,
        strain: &[],
    });
    let elastic = all.modes.iter().enumerate().map(|(k, m)| Shown {
        heads: [
            format!("mode {}", k + 1),
            format!("{} Hz", digits(m.frequency_hz)),
            m.damping_ratio.map_or(String::new(), |z| format!("ζ {}", digits(z))),
        ],
        shape: &m.shape,
        strain: &m.strain_energy,
    });
    let every: Vec<Shown<'_>> = rigid.chain(elastic).collect();
    let shown = &every[..every.len().min(MOST)];
    let members = names(shown.iter().flat_map(|m| m.shape));
    let shafts = names(shown.iter().flat_map(|m| m.strain));
    let width = (LEFT + COLUMN * shown.len().max(4) as f64 + 28.0).max(640.0);
    let mut subtitle = format!("State {}", all.state);
    if !all.fixed.is_empty() {
        subtitle += &format!(", held: {}", all.fixed.join(", "));
    }
    if every.len() > shown.len() {
        subtitle += &format!("; {} more modes are not drawn", every.len() - shown.len());
    }
    let title = format!("Natural frequencies of {}", all.train);
    let words: Vec<String> = every.iter().map(|m| format!("{}: {}", m.heads[0], m.heads[1])).collect();
    let mut body = Group::new()
        .add(
            text(28.0, 38.0, 20.0, Anchor::Start, &fit(&title, (width - 56.0) / BOLD, 20.0)).set("font-weight", "bold"),
        )
        .add(text(28.0, 58.0, 13.0, Anchor::Start, &fit(&subtitle, width - 56.0, 13.0)).set("fill", FAINT));
    for (k, m) in shown.iter().enumerate() {
        let x = middle(k);
        for (j, head) in m.heads.iter().enumerate() {
            let t = text(x, 88.0 + 17.0 * j as f64, if j == 1 { 13.0 } else { 11.0 }, Anchor::Middle, head);
            body = body.add(if j == 1 { t.set("font-weight", "bold") } else { t.set("fill", FAINT) });
        }
    }
    let mut y = TOP;
    body = body.add(table("Shape", "amplitude, the largest 1", &members, shown, |m| m.shape, y));
    y += ROW * members.len() as f64;
    if !shafts.is_empty() {
        y += 50.0;
        body = body.add(table("Strain energy", "share of each shaft", &shafts, shown, |m| m.strain, y));
        y += ROW * shafts.len() as f64;
    }
    page(width, y + 30.0, &title, &words.join("; ")).add(body).to_string()
}

fn middle(k: usize) -> f64 {
    LEFT + COLUMN * (k as f64 + 0.5)
}

fn names<'a>(parts: impl Iterator<Item = &'a Part>) -> Vec<&'a str> {
    let mut all: Vec<&str> = Vec::new();
    for p in parts {
        if !all.contains(&p.name.as_str()) {
            all.push(&p.name);
        }
    }
    all
}

fn table<'a>(
    head: &str,
    key: &str,
    names: &[&str],
    shown: &'a [Shown<'a>],
    parts: impl Fn(&'a Shown<'a>) -> &'a [Part],
    top: f64,
) -> Group {
    let bottom = top + ROW * names.len() as f64;
    let right = LEFT + COLUMN * shown.len() as f64;
    let mut g = Group::new()
        .add(text(28.0, top - 10.0, 13.0, Anchor::Start, head).set("font-weight", "bold"))
        .add(text(34.0 + 8.0 * head.chars().count() as f64, top - 10.0, 11.0, Anchor::Start, key).set("fill", FAINT))
        .add(guide(line((28.0, top), (right, top), LINE, 1.0)));
    for (j, name) in names.iter().enumerate() {
        let y = top + ROW * j as f64;
        let rule = line((28.0, y + ROW), (right, y + ROW), "#e4e4e4", 1.0);
        g = g.add(text(28.0, y + 15.0, 12.0, Anchor::Start, &fit(name, LEFT - 40.0, 12.0))).add(guide(rule));
    }
    for (k, m) in shown.iter().enumerate() {
        let (x, parts) = (middle(k), parts(m));
        for (j, name) in names.iter().enumerate() {
            let Some(p) = parts.iter().find(|p| p.name == *name) else { continue };
            let y = top + ROW * j as f64;
            let length = 26.0 * p.value.abs().min(1.0);
            let from = if p.value < 0.0 { x - length } else { x };
            let fill = colour(Some(usize::from(p.value < 0.0)), 0.75);
            let bar = rectangle(from, y + 5.0, length, ROW - 10.0, &fill);
            let part = if head == "Shape" { Of::Member(name) } else { Of::Element(name) };
            g = g.add(of(bar, &format!("mode{k}"), &[part, Of::Quantity(&m.heads[1])]));
            // The number stands on the free side.
            let value = digits(if p.value.abs() < 1e-9 { 0.0 } else { p.value });
            let (at, anchor) = if p.value < 0.0 { (x + 4.0, Anchor::Start) } else { (x - 4.0, Anchor::End) };
            g = g.add(text(at, y + 15.0, 11.0, anchor, &value).set("fill", FAINT));
        }
        g = g.add(guide(line((x, top), (x, bottom), LINE, 1.0)));
    }
    g
}
