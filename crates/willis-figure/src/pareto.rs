//! Things to choose from, as points over two objectives: which no other one beats.

use svg::node::element::{Circle, Group};

use crate::parts::alive::{Of, guide, told};
use crate::parts::chart::{Chart, Scale};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, PAPER, colour, digits, fit, halo, line, lines, number, page, text, wide,
};

/// An objective: its title with the unit, and whether more of it is better.
#[derive(Clone, Debug, PartialEq)]
pub struct ParetoAxis {
    /// `Ring diameter, mm`.
    pub title: String,
    /// Whether more of it is better.
    pub better_high: bool,
    /// A difference that is worth seeing: the axis is at least so long.
    pub least: f64,
}

/// A thing to choose.
#[derive(Clone, Debug, PartialEq)]
pub struct ParetoPoint {
    /// What it is called in the picture: the number of its row.
    pub label: String,
    /// What it is, in a few words, for who asks.
    pub words: String,
    /// Its value in the two objectives.
    pub at: [f64; 2],
    /// Its value in the third one.
    pub third: Option<f64>,
    /// Whether it is the user's own.
    pub own: bool,
}

/// Things to choose from, over two objectives.
#[derive(Clone, Debug, PartialEq)]
pub struct Pareto {
    /// The title.
    pub title: String,
    /// One line below it.
    pub subtitle: String,
    /// The two objectives: to the right, and upwards.
    pub axes: [ParetoAxis; 2],
    /// A third one, which the darkness of the points shows.
    pub third: Option<ParetoAxis>,
    /// The things.
    pub points: Vec<ParetoPoint>,
    /// What is to be known about them.
    pub note: String,
}

const MARGIN: f64 = 28.0;
const WIDTH: f64 = 860.0;
const TOP: f64 = 108.0;
const BOTTOM: f64 = 520.0;
/// Labels up to so many points; more would be a wall of numbers.
const MOST_LABELS: usize = 60;

/// Draws them.
///
/// # Example
/// ```
/// use willis_figure::{Pareto, ParetoAxis, ParetoPoint};
///
/// let axis = |title: &str, better_high| ParetoAxis { title: title.into(), better_high, least: 0.0 };
/// let point = |label: &str, at| ParetoPoint { label: label.into(), words: label.into(), at, third: None, own: false };
/// let svg = willis_figure::draw_pareto(&Pareto {
///     title: "Joint".into(),
///     subtitle: "2 of 2 trains".into(),
///     axes: [axis("Ring diameter, mm", false), axis("Efficiency, %", true)],
///     third: None,
///     points: vec![point("1", [60.0, 70.0]), point("2", [80.0, 82.0])],
///     note: String::new(),
/// });
/// assert!(svg.starts_with("<svg"));
/// ```
pub fn draw(p: &Pareto) -> String {
    let values = |k: usize| p.points.iter().map(move |q| q.at[k]);
    let scale = |k: usize| padded(Scale::of(values(k), better(&p.axes[k])), p.axes[k].least);
    let right = WIDTH - MARGIN - if p.third.is_some() { 92.0 } else { 0.0 };
    let chart = Chart { left: 92.0, top: TOP, right, bottom: BOTTOM, x: scale(0), y: scale(1) };
    let thirds: Vec<f64> = p.points.iter().filter_map(|q| q.third).filter(|v| v.is_finite()).collect();
    let (least, most) = thirds.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let tells = p.third.as_ref().is_some_and(|third| most - least > third.least.max(0.0));
    let shade = |v: Option<f64>| match v {
        Some(v) if tells => 0.22 + 0.78 * ((v - least) / (most - least)).clamp(0.0, 1.0),
        _ => 1.0,
    };
    let inner = WIDTH - 2.0 * MARGIN;
    let mut g = Group::new()
        .add(text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&p.title, inner / BOLD, 20.0)).set("font-weight", "bold"))
        .add(text(MARGIN, 58.0, 13.0, Anchor::Start, &fit(&p.subtitle, inner, 13.0)).set("fill", FAINT))
        .add(chart.grid())
        .add(chart.frame());
    // The user's own is drawn last, above the others.
    let mut order: Vec<&ParetoPoint> = p.points.iter().filter(|q| q.at.iter().all(|v| v.is_finite())).collect();
    order.sort_by_key(|q| q.own);
    let mut taken: Vec<[f64; 4]> = vec![];
    for q in order.iter().copied() {
        let (x, y) = (chart.x(q.at[0]), chart.y(q.at[1]));
        let dot = Circle::new().set("cx", number(x)).set("cy", number(y));
        let mut one = Group::new();
        one = match q.own {
            true => one
                .add(
                    dot.clone()
                        .set("r", 9)
                        .set("fill", "none")
                        .set("stroke", colour(Some(1), 1.0))
                        .set("stroke-width", 2.5),
                )
                .add(dot.set("r", 4).set("fill", colour(Some(1), 1.0))),
            false => one.add(
                dot.set("r", 5.5)
                    .set("fill", colour(Some(0), shade(q.third)))
                    .set("stroke", colour(Some(0), 1.0))
                    .set("stroke-width", 1.2),
            ),
        };
        // A label stands at the first side with room; where there is none, the point is asked for its name.
        let (w, h) = (wide(&q.label, 11.0), 11.0);
        let sides = [(8.0, -6.0), (-8.0 - w, -6.0), (8.0, 14.0), (-8.0 - w, 14.0), (-w / 2.0, -11.0), (-w / 2.0, 20.0)];
        let free = sides.iter().map(|(dx, dy)| [x + dx, y + dy - h, x + dx + w, y + dy]).find(|b| {
            let apart = |t: &[f64; 4]| b[2] < t[0] || t[2] < b[0] || b[3] < t[1] || t[3] < b[1];
            let clear = |o: &ParetoPoint| {
                let (ox, oy) = (chart.x(o.at[0]), chart.y(o.at[1]));
                std::ptr::eq::<ParetoPoint>(o, q)
                    || ox < b[0] - 5.0
                    || ox > b[2] + 5.0
                    || oy < b[1] - 5.0
                    || oy > b[3] + 5.0
            };
            taken.iter().all(apart) && order.iter().all(|o| clear(o)) && b[0] > chart.left && b[2] < chart.right
        });
        if let Some(b) = free.filter(|_| q.own || order.len() <= MOST_LABELS) {
            taken.push(b);
            let label = text(b[0], b[3], 11.0, Anchor::Start, &q.label);
            let label = if q.own { label.set("font-weight", "bold") } else { label.set("fill", INK) };
            one = one.add(halo(label, PAPER, 3.0));
        }
        g = g.add(told(one, "point", &[Of::Quantity(&q.label)], q.words.clone()));
    }
    if let (Some(third), true) = (&p.third, tells) {
        g = g.add(legend(&better(third), [least, most], right + 28.0));
    }
    let mut y = BOTTOM + 62.0;
    for l in lines(&p.note, inner, 11.0) {
        g = g.add(text(MARGIN, y, 11.0, Anchor::Start, &l).set("fill", FAINT));
        y += 15.0;
    }
    let words: Vec<&str> = p.points.iter().map(|q| q.words.as_str()).collect();
    page(WIDTH, y + 8.0, &p.title, &words.join("; ")).add(g).to_string()
}

/// Points keep away from the frame.
fn padded(s: Scale, least: f64) -> Scale {
    let room = (0.06 * (s.high - s.low)).max((least - (s.high - s.low)) / 2.0);
    Scale { low: s.low - room, high: s.high + room, title: s.title }
}

fn better(axis: &ParetoAxis) -> String {
    format!("{} ({} is better)", axis.title, if axis.better_high { "more" } else { "less" })
}

fn legend(title: &str, [low, high]: [f64; 2], left: f64) -> Group {
    let mut g = guide(Group::new());
    let (top, step) = (TOP + 62.0, 18.0);
    let mut y = TOP + 10.0;
    for l in lines(title, 92.0, 11.0).iter().take(4) {
        g = g.add(text(left - 16.0, y, 11.0, Anchor::Start, l).set("fill", FAINT));
        y += 13.0;
    }
    for k in 0..5 {
        let part = f64::from(4 - k) / 4.0;
        let y = top + step * f64::from(k);
        let dot = Circle::new().set("cx", number(left - 8.0)).set("cy", number(y)).set("r", 5.5);
        g = g
            .add(
                dot.set("fill", colour(Some(0), 0.22 + 0.78 * part))
                    .set("stroke", colour(Some(0), 1.0))
                    .set("stroke-width", 1.2),
            )
            .add(line((left, y), (left + 4.0, y), FAINT, 1.0))
            .add(text(left + 8.0, y + 4.0, 11.0, Anchor::Start, &digits(low + part * (high - low))).set("fill", FAINT));
    }
    g
}
