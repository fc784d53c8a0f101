//! Symbols and lines of a power flow.

use svg::node::element::{Circle, Group, Path, Polygon};
use willis::hypergraph::{Hypergraph, Node, NodeKind};

use super::words::{GROUND, R, ROW, SMALL, name, values};
use crate::parts::alive::{Of, of, part, told};
use crate::parts::style::{Anchor, FAINT, INK, LINE, PAPER, colour, halo, line, number, rectangle, text, watts};

/// Whether power runs in a circle.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Round {
    No,
    /// Between sets.
    Between,
    /// Within one set.
    Within,
}

impl Round {
    fn colour(self) -> String {
        match self {
            Self::No => colour(Some(0), 0.8),
            Self::Between => colour(Some(1), 0.9),
            Self::Within => colour(Some(4), 1.0),
        }
    }
}

/// A line; what runs in a circle is broken by its centre line, in dashes between sets and in dots within one.
pub fn stroke(path: &str, round: Round, width: f64) -> Group {
    let one = |colour: &str, width: f64| {
        Path::new().set("d", path).set("fill", "none").set("stroke", colour).set("stroke-width", number(width))
    };
    let main = one(&round.colour(), width);
    let dashes = match round {
        Round::No => return Group::new().add(main),
        Round::Between => "9 4",
        Round::Within => "2 4",
    };
    if width < 2.5 {
        // Too narrow for a centre line: the line itself is broken.
        return Group::new().add(main.set("stroke-dasharray", if round == Round::Between { "12 2" } else { "5 2" }));
    }
    let centre = one(PAPER, (0.3 * width).clamp(0.9, 2.0)).set("stroke-dasharray", dashes);
    Group::new().add(main).add(centre)
}

/// A line of the picture, from column to column.
pub struct Line {
    pub edge: usize,
    /// From left to right.
    pub places: Vec<usize>,
    /// Whether the power runs from right to left.
    pub backwards: bool,
    pub width: f64,
    /// Widths of what circulates between sets, and within one.
    pub round: [f64; 2],
    /// Distance from the middle where it leaves its left end and where it enters its right end.
    pub ports: [f64; 2],
    pub points: Vec<(f64, f64)>,
}

/// A line with its arrow head, and its words for a pointer.
pub fn draw(l: &Line, g: &Hypergraph, panel: &str) -> Group {
    let e = &g.edges[l.edge];
    let p = &l.points;
    let name = |id: &str| g.node(id).map_or(String::new(), |n| n.name.clone());
    let words = format!("{} to {}: {}", name(&e.from), name(&e.to), watts(e.power_w));
    let link = format!("power_w {} to {}", e.from, e.to);
    let own = [Of::Quantity(&link), Of::State(panel)];
    let mut group = told(Group::new(), &format!("line{}", l.edge), &own, words);
    // Where a symbol's outline is met.
    let reach = |y: f64| (R * R - y * y).max(0.0).sqrt().max(R * 0.5);
    let last = p.len() - 1;
    let mut points = p.clone();
    let head = (3.0 + 0.75 * l.width).min(9.5);
    let long = if l.width > 0.0 { 1.5 * head } else { 0.0 };
    let (left, right) = (points[0].0 + reach(l.ports[0]), points[last].0 - reach(l.ports[1]));
    points[0].0 = left + if l.backwards { long } else { -2.0 };
    points[last].0 = right - if l.backwards { -2.0 } else { long };
    let n = |p: (f64, f64)| format!("{} {}", number(p.0), number(p.1));
    let mut d = format!("M{}", n(points[0]));
    for (k, w) in points.windows(2).enumerate() {
        if k % 2 == 0 {
            d += &format!(" L{}", n(w[1]));
        } else {
            let m = (w[0].0 + w[1].0) / 2.0;
            d += &format!(" C{} {} {}", n((m, w[0].1)), n((m, w[1].1)), n(w[1]));
        }
    }
    if l.width == 0.0 {
        let path = Path::new().set("d", d).set("fill", "none").set("stroke", LINE).set("stroke-width", 1);
        return group.add(path.set("stroke-dasharray", "3 3"));
    }
    let whole = e.circulating_w >= e.power_w * (1.0 - 1e-6);
    let main = match (whole, l.round[0] > 0.0) {
        (true, true) => Round::Between,
        (true, false) => Round::Within,
        _ => Round::No,
    };
    group = group.add(stroke(&d, main, l.width));
    if l.round[1] > 0.0 && !whole {
        group = group.add(stroke(&d, Round::Within, l.round[0] + l.round[1]));
    }
    if l.round[0] > 0.0 && !whole {
        group = group.add(stroke(&d, Round::Between, l.round[0]));
    }
    let head_colour = match e.circulating_w > 0.5 * e.power_w {
        true if l.round[0] >= l.round[1] => Round::Between.colour(),
        true => Round::Within.colour(),
        false => Round::No.colour(),
    };
    let (tip, base, y) = match l.backwards {
        true => (left, left + long, points[0].1),
        false => (right, right - long, points[last].1),
    };
    group.add(
        Polygon::new()
            .set(
                "points",
                format!(
                    "{},{} {},{} {},{}",
                    number(tip),
                    number(y),
                    number(base),
                    number(y - head),
                    number(base),
                    number(y + head)
                ),
            )
            .set("fill", head_colour),
    )
}

/// The shape of a kind of node.
pub fn shape(kind: NodeKind, x: f64, y: f64) -> Group {
    let ring = |fill: &str, r: f64| {
        Circle::new()
            .set("cx", number(x))
            .set("cy", number(y))
            .set("r", number(r))
            .set("fill", fill)
            .set("stroke", INK)
            .set("stroke-width", 1.6)
    };
    let polygon = |corners: &[(f64, f64)]| {
        let points: Vec<String> = corners.iter().map(|c| format!("{},{}", number(x + c.0), number(y + c.1))).collect();
        Polygon::new()
            .set("points", points.join(" "))
            .set("fill", PAPER)
            .set("stroke", INK)
            .set("stroke-width", 1.6)
            .set("stroke-linejoin", "round")
    };
    let s = R - 1.5;
    let g = Group::new();
    match kind {
        NodeKind::Member => g.add(ring(INK, R - 1.0)),
        NodeKind::Bearing => g.add(ring(PAPER, R - 1.0)),
        NodeKind::Teeth => g.add(polygon(&[(0.0, -R - 1.0), (R + 1.0, R - 2.0), (-R - 1.0, R - 2.0)])),
        NodeKind::Seal => g.add(polygon(&[(-s, -s), (s, -s), (s, s), (-s, s)])),
        NodeKind::Gear => g.add(polygon(&[(0.0, -R), (R, 0.0), (0.0, R), (-R, 0.0)])),
        NodeKind::Drag | NodeKind::OpenElement | NodeKind::Pump | NodeKind::Rotor => {
            g.add(polygon(&[(0.0, -R), (R, 0.0), (0.0, R), (-R, 0.0)])).add(ring(INK, 1.4))
        }
        NodeKind::ShiftElement => g
            .add(rectangle(x - R, y - R, 2.0 * R, 2.0 * R, PAPER))
            .add(line((x - 3.5, y - R - 1.0), (x - 3.5, y + R + 1.0), INK, 3.0))
            .add(line((x + 3.5, y - R - 1.0), (x + 3.5, y + R + 1.0), INK, 3.0)),
        NodeKind::Coupling => g
            .add(rectangle(x - R, y - R, 2.0 * R, 2.0 * R, PAPER))
            .add(line((x - R, y - 2.5), (x + R, y - 2.5), INK, 2.0))
            .add(line((x - R, y + 2.5), (x + R, y + 2.5), INK, 2.0)),
        // A box with a slanting stroke: what is adjustable.
        NodeKind::Variator => g.add(polygon(&[(-s, -s), (s, -s), (s, s), (-s, s)])).add(line(
            (x - R - 2.0, y + R + 2.0),
            (x + R + 2.0, y - R - 2.0),
            INK,
            1.8,
        )),
        _ => g.add(
            rectangle(x - 7.0, y - R, 14.0, 2.0 * R, &colour(Some(0), 0.25))
                .set("rx", 4)
                .set("stroke", INK)
                .set("stroke-width", 1.2),
        ),
    }
}

/// The mark of the frame, hanging from a symbol.
pub fn ground(x: f64, y: f64) -> Group {
    let y = y + R - 1.0;
    let mut g = Group::new().add(line((x, y), (x, y + 5.0), INK, 1.2)).add(line(
        (x - 8.0, y + 5.0),
        (x + 8.0, y + 5.0),
        INK,
        1.4,
    ));
    for k in 0..4 {
        let at = x - 6.0 + 4.0 * f64::from(k);
        g = g.add(line((at, y + 5.0), (at - 3.0, y + 9.0), INK, 0.9));
    }
    g
}

pub fn symbol(n: &Node, (x, y): (f64, f64), leans: bool, more: f64, panel: &str) -> Group {
    let word = if n.kind == NodeKind::Input || n.kind == NodeKind::Output { "end" } else { "node" };
    let mut g = of(Group::new(), &format!("{word}{:?}", n.kind), &[part(n.kind, &n.name), Of::State(panel)]);
    if leans {
        g = g.add(ground(x, y));
    }
    let below = y + R + 12.0 + if leans { (GROUND - 2.0).max(more) } else { more };
    g = g.add(shape(n.kind, x, y));
    let bold = matches!(n.kind, NodeKind::Member | NodeKind::Input | NodeKind::Output);
    let mut title = text(x, y - R - 6.0 - more, SMALL, Anchor::Middle, &name(n));
    if bold {
        title = title.set("font-weight", "bold");
    }
    g = g.add(halo(title, PAPER, 3.0));
    for (row, words) in values(n).iter().enumerate() {
        let t = text(x, below + ROW * row as f64, SMALL, Anchor::Middle, words).set("fill", FAINT);
        g = g.add(halo(t, PAPER, 3.0));
    }
    g
}
