//! Points of a lever that stand so close together that they cover each other, enlarged beside it.

use svg::node::element::{Circle, Group, Line};

use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{Anchor, FAINT, LINE, PAPER, digits, fit, halo, line, number, rectangle, text};
use crate::{LeverCase, LeverNode, LeverRole};

/// Points nearer than this cover each other.
const NEAR: f64 = 9.0;
/// Width and height of a detail, and the room that it takes beside the lever.
const WIDTH: f64 = 132.0;
const HEIGHT: f64 = 110.0;
pub const ROOM: f64 = WIDTH + 14.0;
/// Room for its heading, and below its lowest point.
const HEAD: f64 = 28.0;
const FOOT: f64 = 14.0;

/// Groups of points that cover each other on a picture of that height, the highest first. What stands at one place exactly
/// is one point, however much it is enlarged.
pub fn groups<'n>(nodes: impl Iterator<Item = &'n LeverNode>, height: f64) -> Vec<Vec<&'n LeverNode>> {
    let mut all: Vec<Vec<&LeverNode>> = vec![];
    for n in nodes {
        match all.last_mut().filter(|g| (g[g.len() - 1].position - n.position).abs() * height < NEAR) {
            Some(group) => group.push(n),
            None => all.push(vec![n]),
        }
    }
    all.retain(|g| span(g) > 1e-12);
    all
}

fn span(group: &[&LeverNode]) -> f64 {
    group.first().zip(group.last()).map_or(0.0, |(high, low)| high.position - low.position)
}

/// The height that details of a lever need, which stand below each other.
pub fn height(count: usize) -> f64 {
    (HEIGHT + 12.0) * count as f64 - 12.0
}

/// The largest round factor by which a group fits.
fn factor(group: &[&LeverNode], height: f64) -> f64 {
    let most = (HEIGHT - HEAD - FOOT) / (span(group) * height);
    let size = 10f64.powf(most.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|s| s * size).find(|f| *f <= most * (1.0 + 1e-12)).unwrap_or(size)
}

/// Numbers as near as can be to the wished ones, at least so far apart, within limits.
type Spread = fn(&[f64], f64, (f64, f64)) -> Vec<f64>;

/// What a detail takes over from its lever.
pub struct Lever<'a> {
    /// Its sets.
    pub name: &'a str,
    /// The cases drawn.
    pub cases: &'a [LeverCase],
    /// Height of the picture.
    pub height: f64,
    /// Where the speed of a point in a case lies right of the rest line, and where that is.
    pub offset: &'a dyn Fn(&LeverNode, usize) -> Option<f64>,
    pub rest: f64,
    /// The height of a position.
    pub y: &'a dyn Fn(f64) -> f64,
    pub case_colour: &'a dyn Fn(usize) -> String,
    pub own_colour: fn(&LeverNode) -> String,
    pub dashed: fn(Line, usize) -> Line,
    pub mark: fn(f64, f64, &[LeverRole]) -> Group,
    pub spread: Spread,
}

/// The details of a lever, at the right end of its panel: heights and speeds are enlarged alike, so that lines keep their slope.
pub fn draw(v: &Lever<'_>, all: &[Vec<&LeverNode>], left: f64) -> Group {
    let middle = |g: &Vec<&LeverNode>| (v.y)((g[0].position + g[g.len() - 1].position) / 2.0);
    let wished: Vec<f64> = all.iter().map(middle).collect();
    let limits = ((v.y)(1.0) + HEIGHT / 2.0 - 30.0, (v.y)(0.0) - HEIGHT / 2.0 + 30.0);
    let at = (v.spread)(&wished, HEIGHT + 12.0, limits);
    let mut drawing = Group::new();
    for ((group, y), from) in all.iter().zip(at).zip(wished) {
        drawing = drawing.add(one(v, group, [left, y - HEIGHT / 2.0], from));
    }
    drawing
}

fn one(v: &Lever<'_>, group: &[&LeverNode], [left, top]: [f64; 2], from: f64) -> Group {
    let name = v.name;
    let times = factor(group, v.height);
    let frame = rectangle(left, top, WIDTH, HEIGHT, PAPER).set("stroke", LINE).set("stroke-width", 0.8);
    let rest = v.rest;
    let circle = Circle::new().set("cx", number(rest)).set("cy", number(from)).set("r", 10.5);
    let lead = line((left - 8.0, from), (left, top + HEIGHT / 2.0), LINE, 0.8);
    let mut g = Group::new()
        .add(guide(circle.set("fill", "none").set("stroke", FAINT).set("stroke-width", 0.8)))
        .add(guide(Group::new().add(frame).add(lead)));
    let heading = format!("{} times larger", digits(times));
    g = g.add(text(left + 6.0, top + 15.0, 11.0, Anchor::Start, &heading).set("fill", FAINT));

    // The rest line where the points of the one case are seen with it, else the points alone.
    let (a, b) = (left + 16.0, left + WIDTH - 6.0);
    let low = group[group.len() - 1].position;
    let bottom = top + HEIGHT - FOOT;
    let height_of = |n: &LeverNode| bottom - (n.position - low) * v.height * times;
    let offsets = |n: &LeverNode| -> Vec<(usize, f64)> {
        (0..v.cases.len()).filter_map(|k| Some((k, (v.offset)(n, k)? * times))).collect()
    };
    let far = |o: f64| !(-10.0..=b - a - 48.0).contains(&o);
    let with_rest = v.cases.len() > 1 || group.iter().all(|n| offsets(n).iter().all(|(_, o)| !far(*o)));
    let centre = match with_rest {
        true => 0.0,
        false => {
            let all: Vec<f64> = group.iter().flat_map(|n| offsets(n)).map(|o| o.1).collect();
            all.iter().copied().fold(f64::INFINITY, f64::min)
        }
    };
    let place = |offset: f64| a + 10.0 + offset - centre;
    let inside = |x: f64| (a..=b).contains(&x);
    if with_rest {
        let ends = [group[0], group[group.len() - 1]].map(height_of);
        g = g.add(guide(line((place(0.0), ends[0]), (place(0.0), ends[1]), LINE, 3.5)));
    }
    for case in 0..v.cases.len() {
        let points: Vec<(f64, f64)> = group
            .iter()
            .filter_map(|n| {
                let offset = offsets(n).into_iter().find(|o| o.0 == case)?.1;
                Some((place(offset), height_of(n)))
            })
            .filter(|p| inside(p.0))
            .collect();
        if let (Some(p), Some(q), true) = (points.first(), points.last(), points.len() == group.len()) {
            let about = [Of::Mesh(name), Of::State(&v.cases[case].name)];
            let l = (v.dashed)(line(*p, *q, &(v.case_colour)(case), 2.2), case);
            g = g.add(of(l, &format!("detail-lever-{}", group[0].member), &about));
        }
    }
    for n in group {
        let y = height_of(n);
        let mut end = place(0.0);
        for (case, offset) in offsets(n) {
            let x = place(offset);
            if inside(x) {
                let ink = if v.cases.len() > 1 { (v.case_colour)(case) } else { (v.own_colour)(n) };
                let dot = Circle::new().set("cx", number(x)).set("cy", number(y)).set("r", 3.4).set("fill", ink);
                let about = [Of::Member(&n.member), Of::Mesh(name), Of::State(&v.cases[case].name)];
                g = g.add(of(dot, "detail-speed", &about));
                end = if v.cases.len() > 1 { end } else { end.max(x) };
            }
        }
        if with_rest {
            g = g.add(of((v.mark)(place(0.0), y, &n.roles), "detail-point", &[Of::Member(&n.member), Of::Mesh(name)]));
        }
        let words = fit(&n.member, b - end - 9.0, 11.0);
        g = g.add(halo(text(end + 9.0, y + 3.5, 11.0, Anchor::Start, &words), PAPER, 3.0));
    }
    g
}
