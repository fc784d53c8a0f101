//! Wolf diagrams: boxes below, a line for each member above them.

use svg::node::element::{Circle, Group, Path};

use crate::lever::LeverRole;
use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{Anchor, BOLD, FAINT, INK, PAPER, colour, fit, line, number, page, rectangle, text, wide};
use crate::{Wolf, WolfSet, WolfTie, WolfVariator};

const MARGIN: f64 = 28.0;
const TOP: f64 = 96.0;
/// Between the lines of two members, and between two shafts of a box.
const LANE: f64 = 30.0;
const SHAFT: f64 = 34.0;
const BOX: f64 = 58.0;
const GAP: f64 = 40.0;
/// Least room of a shift element or a variator, and the most that its name gets.
const TIE: [f64; 2] = [46.0, 120.0];
const PLATE: f64 = 8.0;

/// Boxes with their shafts, the sum shaft a double line; a line for each member, a dot where a shaft is coupled to it; shift
/// elements between the lines.
pub fn draw(data: &Wolf) -> String {
    let names = data.members.iter().map(|m| wide(&m.name, 12.0) * BOLD).fold(40.0, f64::max).min(150.0);
    let left = MARGIN + names + 26.0;
    let lane = |k: usize| TOP + LANE * k as f64;
    let boxes = TOP + LANE * data.members.len() as f64 + 18.0;
    let ground = boxes + BOX + 34.0;
    // Where every shaft and every element stands.
    let mut x = left + GAP / 2.0;
    let starts: Vec<f64> = (data.sets.iter())
        .map(|s| {
            let own = x;
            x += width(s) + GAP;
            own
        })
        .collect();
    let mut room = |name: &str| {
        let own = (wide(name, 11.0) + 8.0).clamp(TIE[0], TIE[1]);
        x += own;
        x - own / 2.0
    };
    let ties: Vec<f64> = data.ties.iter().map(|t| room(&t.name)).collect();
    let variators: Vec<f64> = data.variators.iter().map(|v| room(&v.name)).collect();
    let right = x + 10.0;
    let state = match &data.state {
        Some(state) => format!("; state {state}"),
        None if data.ties.is_empty() => String::new(),
        None => "; no shift element closed".to_owned(),
    };
    let caption = format!("Sets as boxes with their shafts, a line for each member{state}.");
    let signs = signs(data);
    let widest = signs.iter().map(|words| wide(words, 12.0)).fold(wide(&caption, 13.0), f64::max);
    let head = (wide(&data.title, 20.0) * BOLD).max(widest).min(900.0);
    let page_width = right.max(MARGIN + head) + MARGIN;

    let mut body = Group::new();
    for (k, m) in data.members.iter().enumerate() {
        let own = colour(Some(m.colour), 1.0);
        let name = fit(&m.name, names / BOLD, 12.0);
        let y = lane(k);
        let mut g = Group::new()
            .add(line((left, y), (right, y), &own, 2.0))
            .add(text(left - 22.0, y + 4.0, 12.0, Anchor::End, &name).set("font-weight", "bold"));
        if m.terminal {
            let end = Circle::new().set("cx", number(left - 8.0)).set("cy", number(y)).set("r", 4);
            g = g
                .add(line((left - 4.0, y), (left, y), &own, 2.0))
                .add(end.set("fill", PAPER).set("stroke", own.as_str()).set("stroke-width", 2));
        }
        body = body.add(of(g, "line", &[Of::Member(&m.name)]));
    }
    for (s, from) in data.sets.iter().zip(&starts) {
        body = body.add(set(data, s, *from, boxes, ground, &lane));
    }
    for (t, at) in data.ties.iter().zip(&ties) {
        body = body.add(of(tie(data, t, *at, ground, &lane), "tie", &[Of::Element(&t.name)]));
    }
    for (v, at) in data.variators.iter().zip(&variators) {
        body = body.add(of(variator(data, v, *at, ground, &lane), "variator", &[Of::Element(&v.name)]));
    }
    let (key, bottom) = key(&signs, ground + 46.0);
    page(page_width, bottom, &format!("Wolf diagram of {}", data.title), &words(data))
        .add(
            text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&data.title, (page_width - 2.0 * MARGIN) / BOLD, 20.0))
                .set("font-weight", "bold"),
        )
        .add(
            text(MARGIN, 60.0, 13.0, Anchor::Start, &fit(&caption, page_width - 2.0 * MARGIN, 13.0)).set("fill", FAINT),
        )
        .add(body)
        .add(key)
        .to_string()
}

fn width(s: &WolfSet) -> f64 {
    let words = (wide(&s.name, 12.0) * BOLD).min(150.0).max(ratio(s).map_or(0.0, |r| wide(&r, 11.0)));
    (SHAFT * s.shafts.len() as f64).max(words + 14.0)
}

fn ratio(s: &WolfSet) -> Option<String> {
    s.basic_ratio.as_ref().map(|r| format!("i₀ = {}", r.replace('-', "−")))
}

fn letter(role: LeverRole) -> &'static str {
    match role {
        LeverRole::Carrier => "c",
        LeverRole::Sun => "s",
        LeverRole::Ring => "r",
        _ => "g",
    }
}

/// A box, and its shafts up to the lines of their members or down to the frame.
fn set(data: &Wolf, s: &WolfSet, from: f64, top: f64, ground: f64, lane: &dyn Fn(usize) -> f64) -> Group {
    let broad = width(s);
    let mut shafts = Group::new();
    for (k, shaft) in s.shafts.iter().enumerate() {
        let x = from + broad * (k as f64 + 0.5) / s.shafts.len() as f64;
        let (name, ink) = match shaft.member {
            Some(m) => (data.members[m].name.as_str(), colour(Some(data.members[m].colour), 1.0)),
            None => ("frame", INK.to_owned()),
        };
        let (y, end) = match shaft.member {
            Some(m) => (top, lane(m)),
            None => (top + BOX, ground),
        };
        let mut own = Group::new();
        for side in if shaft.sum { &[-2.4, 2.4][..] } else { &[0.0] } {
            own = own.add(line((x + side, y), (x + side, end), &ink, 2.0));
        }
        own = match shaft.member {
            Some(_) => own.add(dot(x, end, &ink)),
            None => own.add(frame(x, ground)),
        };
        let inside = if shaft.member.is_some() { top + 14.0 } else { top + BOX - 6.0 };
        own = own.add(text(x, inside, 11.0, Anchor::Middle, letter(shaft.role)).set("fill", FAINT));
        shafts = shafts.add(of(own, &format!("shaft{k}"), &[Of::Member(name), Of::Mesh(&s.name)]));
    }
    let middle = from + broad / 2.0;
    let name = fit(&s.name, 150.0 / BOLD, 12.0);
    let frame = rectangle(from, top, broad, BOX, PAPER).set("rx", 5).set("stroke", INK).set("stroke-width", 1.8);
    let mut own =
        Group::new().add(frame).add(text(middle, top + 29.0, 12.0, Anchor::Middle, &name).set("font-weight", "bold"));
    if let Some(ratio) = ratio(s) {
        own = own.add(text(middle, top + 43.0, 11.0, Anchor::Middle, &ratio));
    }
    Group::new().add(of(own, "box", &[Of::Mesh(&s.name)])).add(shafts)
}

fn dot(x: f64, y: f64, ink: &str) -> Circle {
    Circle::new().set("cx", number(x)).set("cy", number(y)).set("r", 4).set("fill", ink)
}

/// The frame begins here.
fn frame(x: f64, y: f64) -> Group {
    let strokes = (0..4).map(|k| x - 7.0 + 5.0 * f64::from(k));
    let ground = Group::new().add(line((x - 9.0, y), (x + 9.0, y), INK, 2.0));
    strokes.fold(ground, |g, at| g.add(line((at, y), (at - 4.0, y + 6.0), INK, 1.1)))
}

/// A clutch between two lines, a brake between a line and the frame.
fn tie(data: &Wolf, t: &WolfTie, x: f64, ground: f64, lane: &dyn Fn(usize) -> f64) -> Group {
    let end = |m: Option<usize>| m.map_or(ground, lane);
    let ink = |m: Option<usize>| m.map_or(INK.to_owned(), |k| colour(Some(data.members[k].colour), 1.0));
    let [upper, lower] = if end(t.members[0]) <= end(t.members[1]) { t.members } else { [t.members[1], t.members[0]] };
    let (from, to) = (end(upper), end(lower));
    let middle = if lower.is_none() { ground - 22.0 } else { from + LANE / 2.0 };
    let (gap, plate) = if t.engaged { (1.8, 3.6) } else { (3.4, 1.8) };
    let mut g = Group::new();
    if t.engaged {
        let r = PLATE + 4.0;
        g = g.add(rectangle(x - r, middle - r, 2.0 * r, 2.0 * r, &colour(Some(4), 0.45)).set("rx", 4));
    }
    g = g
        .add(line((x, from), (x, middle - gap), &ink(upper), 2.0))
        .add(line((x, middle + gap), (x, to), &ink(lower), 2.0))
        .add(line((x - PLATE, middle - gap), (x + PLATE, middle - gap), &ink(upper), plate))
        .add(line((x - PLATE, middle + gap), (x + PLATE, middle + gap), &ink(lower), plate));
    if t.one_way {
        let d = format!("M{} {} l6 -8 h-12 Z", number(x), number(middle - gap - 1.0));
        g = g.add(Path::new().set("d", d).set("fill", INK));
    }
    for m in [upper, lower].into_iter().flatten() {
        g = g.add(dot(x, lane(m), &ink(Some(m))));
    }
    g = match lower {
        None => g.add(frame(x, ground)),
        // Down to its name.
        Some(_) => Group::new().add(guide(line((x, to), (x, ground + 8.0), "#dcdcdc", 1.0))).add(g),
    };
    let name = fit(&t.name, TIE[1] - 4.0, 11.0);
    g.add(text(x, ground + 22.0, 11.0, Anchor::Middle, &name))
}

/// Members that a variator couples at a ratio that is free: a dashed line, a box with an arrow across.
fn variator(data: &Wolf, v: &WolfVariator, x: f64, ground: f64, lane: &dyn Fn(usize) -> f64) -> Group {
    let ends = v.members.iter().map(|m| lane(*m));
    let (top, end) = ends.fold((f64::MAX, f64::MIN), |(a, b), y| (a.min(y), b.max(y)));
    let mut g = Group::new();
    if top < end {
        let middle = top + LANE / 2.0;
        let r = PLATE + 1.0;
        let d = format!("M{} {} l{} {} m-6 0.5 l6 -0.5 l-0.5 6", number(x - r), number(middle + r), 2.0 * r, -2.0 * r);
        g = g
            .add(line((x, top), (x, end), INK, 1.6).set("stroke-dasharray", "6 3"))
            .add(rectangle(x - r, middle - r, 2.0 * r, 2.0 * r, PAPER).set("stroke", INK).set("stroke-width", 1.6))
            .add(Path::new().set("d", d).set("fill", "none").set("stroke", INK).set("stroke-width", 1.4));
    }
    for m in &v.members {
        g = g.add(dot(x, lane(*m), &colour(Some(data.members[*m].colour), 1.0)));
    }
    let below = if top < end { end } else { ground - 30.0 };
    Group::new().add(guide(line((x, below), (x, ground + 8.0), "#dcdcdc", 1.0))).add(g).add(text(
        x,
        ground + 22.0,
        11.0,
        Anchor::Middle,
        &fit(&v.name, TIE[1] - 4.0, 11.0),
    ))
}

/// What the signs mean.
fn signs(data: &Wolf) -> Vec<&'static str> {
    let mut entries = vec!["s sun, r ring, c carrier, g gear of a pair"];
    if data.sets.iter().flat_map(|s| &s.shafts).any(|s| s.sum) {
        entries.push("double line: sum shaft, its torque balances the other two");
    }
    if data.sets.iter().any(|s| s.basic_ratio.is_some()) {
        entries.push("i₀: speed of the first over that of the second shaft, relative to the carrier");
    }
    if !data.variators.is_empty() {
        entries.push("box with an arrow: variator, whose ratio is free");
    }
    entries
}

/// That below the picture; and where the page ends.
fn key(entries: &[&str], y: f64) -> (Group, f64) {
    let mut g = guide(Group::new());
    for (k, words) in entries.iter().enumerate() {
        g = g.add(text(MARGIN, y + 17.0 * k as f64, 12.0, Anchor::Start, words).set("fill", FAINT));
    }
    (g, y + 17.0 * entries.len() as f64 + 8.0)
}

fn words(data: &Wolf) -> String {
    let set = |s: &WolfSet| {
        let shaft = |m: Option<usize>| m.map_or("frame", |k| data.members[k].name.as_str());
        let all: Vec<String> = s
            .shafts
            .iter()
            .map(|x| format!("{}{}", shaft(x.member), if x.sum { " (sum shaft)" } else { "" }))
            .collect();
        format!("Set {} has the shafts {}", s.name, all.join(", "))
    };
    let variator = |v: &WolfVariator| {
        let all: Vec<&str> = v.members.iter().map(|m| data.members[*m].name.as_str()).collect();
        format!("The variator {} couples {}", v.name, all.join(" and "))
    };
    data.sets.iter().map(set).chain(data.variators.iter().map(variator)).collect::<Vec<_>>().join(". ") + "."
}
