//! Levers for a panel of a screen: one row, each under its set, speeds to scale across, torques as arrows at their points.

use svg::node::element::{Circle, Group, Line};

use super::draw::{RPM, ends, ground, mark, own_colour, planet, shown, spread, unit_of_torques};
use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, LINE, PAPER, digits, figures, fit, halo, line, number, page, text, ticks, wide,
};
use crate::{Column, Columns, Lever, LeverBar, LeverNode, LeverSet};

/// Names of the sets above, numbers of the scale below, px.
const ABOVE: f64 = 34.0;
const BELOW: f64 = 34.0;
/// The most that speeds take to the right of a lever, px.
const REACH: f64 = 130.0;
/// The longest arrow of a torque, px.
const ARROW: f64 = 34.0;
/// Room between a lever and the names at its left, px.
const BESIDE: f64 = 10.0;

/// The scales of the levers of a panel, all levers alike. Kept while something is dragged, marks move and nothing else does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeverScale {
    /// The least and the greatest speed, in units of the data, 0 between them.
    pub speeds: [f64; 2],
    /// The torque of the longest arrow.
    pub torque: f64,
}

impl LeverScale {
    /// What shows everything of a lever picture.
    pub fn of(lever: &Lever) -> Self {
        let nodes = lever.bars.iter().flat_map(|b| &b.nodes).filter(|n| !planet(n));
        let speeds = nodes.filter_map(|n| n.speeds.first().copied().flatten()).filter(|w| w.is_finite());
        let (low, high) = speeds.fold((0.0f64, 0.0f64), |(l, h), w| (l.min(w), h.max(w)));
        let pulls = lever.bars.iter().flat_map(|b| &b.sets).flat_map(|s| &s.pulls);
        let torque = pulls.map(|p| p.torque.abs()).filter(|t| t.is_finite()).fold(0.0, f64::max);
        Self { speeds: if low == high { [0.0, 1.0] } else { [low, high] }, torque }
    }

    /// How far a unit of speed reaches on the levers of a panel, px.
    pub fn reach(&self, columns: &Columns) -> f64 {
        let least = |room: &dyn Fn(&Column) -> f64| columns.all().iter().map(room).fold(f64::INFINITY, f64::min);
        let right = (least(&|c| c.span[1] - c.x) - 16.0).clamp(20.0, REACH);
        let left = (0.38 * least(&|c| c.x - c.span[0])).clamp(12.0, REACH);
        let [low, high] = self.speeds;
        (right / high.max(f64::MIN_POSITIVE)).min(left / (-low).max(f64::MIN_POSITIVE))
    }
}

/// The levers in columns of a panel that is so many px high: the picture is never less than 150 px high. Without a scale they have
/// their own. Dots carry the speed, arrows the torque they stand for as `data-value`, in the unit of the data.
///
/// Labels of speeds are of the class `speed`, those of torques of the class `torque`: a page shows one or the other.
pub fn draw(lever: &Lever, columns: &Columns, height: f64, scale: Option<LeverScale>) -> String {
    let view = View::new(lever, columns, height.max(150.0), scale.unwrap_or_else(|| LeverScale::of(lever)));
    let mut page = page(columns.width, view.height, &format!("Levers of {}", lever.title), &view.words());
    page = page.add(columns.zones(view.height)).add(view.links());
    for (bar, column) in lever.bars.iter().zip(columns.all()) {
        page = page.add(view.lever(bar, column));
    }
    page.to_string()
}

struct View<'a> {
    lever: &'a Lever,
    columns: &'a Columns,
    height: f64,
    scale: LeverScale,
    /// px of a unit of speed.
    per_speed: f64,
    /// Speeds are shown in this many of a unit of the data.
    factor: f64,
    torque: (f64, &'static str),
}

impl<'a> View<'a> {
    fn new(lever: &'a Lever, columns: &'a Columns, height: f64, scale: LeverScale) -> Self {
        let per_speed = scale.reach(columns);
        let factor = if lever.unit.is_some() { 1.0 } else { RPM };
        let torque = if lever.unit.is_some() { (1.0, "") } else { unit_of_torques(scale.torque) };
        Self { lever, columns, height, scale, per_speed, factor, torque }
    }

    fn y(&self, position: f64) -> f64 {
        ABOVE + (1.0 - position) * (self.height - ABOVE - BELOW)
    }

    fn x(&self, column: &Column, speed: f64) -> f64 {
        column.x + speed * self.per_speed
    }

    /// A member that stands on several levers, as a line between them.
    fn links(&self) -> Group {
        let mut g = Group::new();
        for link in &self.lever.links {
            let at = |[b, n]: [usize; 2]| {
                (self.columns.all()[b].x, self.y(self.lever.bars[b].nodes[n].position), &self.lever.bars[b].nodes[n])
            };
            let mut points: Vec<(f64, f64, &LeverNode)> = link.points.iter().map(|p| at(*p)).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let tie = |w: &[(f64, f64, &LeverNode)]| {
                line((w[0].0, w[0].1), (w[1].0, w[1].1), &own_colour(w[0].2), 1.1)
                    .set("stroke-dasharray", "5 4")
                    .set("stroke-opacity", "0.55")
            };
            let ties = points.windows(2).map(tie).fold(Group::new(), Group::add);
            g = g.add(of(ties, "link", &[Of::Member(&link.member)]));
        }
        g
    }

    fn lever(&self, bar: &LeverBar, column: &Column) -> Group {
        let name = bar.name();
        let room = column.span[1] - column.span[0] - 8.0;
        let head =
            text(column.x, 15.0, 12.0, Anchor::Middle, &fit(&name, room / BOLD, 12.0)).set("font-weight", "bold");
        let mut g = Group::new().add(of(head, "set", &[Of::Mesh(&name)])).add(self.axis(column));
        let (last, first) = ends(bar);
        let (top, bottom) = (self.y(first.position), self.y(last.position));
        g = g.add(guide(line((column.x, top), (column.x, bottom), LINE, 3.0).set("stroke-linecap", "round")));
        let at = |n: &LeverNode| Some((self.x(column, n.speeds.first().copied().flatten()?), self.y(n.position)));
        if let (Some(a), Some(b)) = (at(first), at(last)) {
            g = g.add(of(line(a, b, FAINT, 1.8), "lever", &[Of::Mesh(&name)]));
        }
        for set in &bar.sets {
            g = g.add(self.forces(bar, set, column));
        }
        g = g.add(self.names(bar, column, &name));
        for n in shown(bar).filter(|n| !planet(n)) {
            let about = [Of::Member(&n.member), Of::Mesh(&name)];
            let mut point = mark(column.x, self.y(n.position), &n.roles);
            if self.is_held(n) {
                point = point.add(ground(column.x - 6.0, self.y(n.position)));
            }
            g = g.add(of(point, "point", &about));
            if let (Some((x, y)), Some(speed)) = (at(n), n.speeds[0]) {
                let dot = Circle::new().set("cx", number(x)).set("cy", number(y)).set("r", 5);
                let dot = dot.set("fill", own_colour(n)).set("stroke", PAPER).set("stroke-width", 1.6);
                g = g.add(of(dot.set("data-value", speed.to_string()), "speed", &about));
            }
        }
        g
    }

    fn is_held(&self, n: &LeverNode) -> bool {
        self.lever.cases.first().is_some_and(|c| c.held.contains(&n.member))
    }

    /// Lines and numbers of the scale of speeds.
    fn axis(&self, column: &Column) -> Group {
        let mut g = Group::new();
        let (top, bottom) = (ABOVE - 8.0, self.height - BELOW + 8.0);
        let [low, high] = self.scale.speeds.map(|w| w * self.factor);
        let mut free = f64::NEG_INFINITY;
        for tick in ticks(low, high, if (high - low) * self.per_speed > 90.0 * self.factor { 4 } else { 2 }) {
            let x = self.x(column, tick / self.factor);
            let label = digits(tick);
            let half = wide(&label, 10.0) / 2.0;
            if x - half > free && x + half < column.span[1] + 6.0 {
                g = g.add(line((x, top), (x, bottom), GRID, 1.0));
                g = g.add(text(x, bottom + 14.0, 10.0, Anchor::Middle, &label).set("fill", FAINT));
                free = x + half + 5.0;
            }
        }
        guide(g)
    }

    fn forces(&self, bar: &LeverBar, set: &LeverSet, column: &Column) -> Group {
        let mut g = Group::new();
        let (low, high) = ends(bar);
        for pull in &set.pulls {
            let node = &bar.nodes[pull.node];
            if planet(node) || self.scale.torque <= 0.0 || pull.torque.abs() < 1e-9 * self.scale.torque {
                continue;
            }
            // Where friction moves a force out of the picture, it stands at its true point.
            let there = (low.position - 0.1..=high.position + 0.1).contains(&pull.point);
            let y = self.y(if there { pull.point } else { node.position });
            let part = (pull.torque / self.scale.torque).clamp(-1.0, 1.0);
            let length = part.signum() * 9.0 + part * (ARROW - 9.0);
            let arrow = arrow(column.x, y, length, &own_colour(node)).set("data-value", pull.torque.to_string());
            let whose = pull.mesh.as_deref().unwrap_or(&set.name);
            g = g.add(of(arrow, "torque", &[Of::Member(&node.member), Of::Mesh(whose)]));
        }
        g
    }

    /// Names with their speeds and torques, at the left of the lever.
    fn names(&self, bar: &LeverBar, column: &Column, set: &str) -> Group {
        let nodes: Vec<&LeverNode> = shown(bar).filter(|n| !planet(n)).collect();
        let turned = (-self.scale.speeds[0] * self.per_speed).max(0.0);
        let right = column.x - BESIDE - turned;
        let room = right - column.span[0] - 2.0;
        let told: Vec<[String; 2]> = nodes.iter().map(|n| [self.speed(n), self.torque(bar, n)]).collect();
        let both = |n: &LeverNode, t: &[String; 2]| {
            let value = t.iter().map(|v| wide(v, 11.0)).fold(0.0, f64::max);
            wide(&n.member, 11.0) * BOLD + 5.0 + value + if self.is_held(n) { 12.0 } else { 0.0 }
        };
        // On one line where that has room on every point, else over each other.
        let one_line = nodes.iter().zip(&told).all(|(n, t)| both(n, t) <= room);
        let gap = if one_line { 15.0 } else { 26.0 };
        // Above the point, whose own height belongs to the arrow of its torque.
        let wished: Vec<f64> = nodes.iter().map(|n| self.y(n.position) - if one_line { 9.0 } else { 16.0 }).collect();
        let at = spread(&wished, gap, (ABOVE - 12.0, self.height - BELOW + 6.0));
        let mut g = Group::new();
        for ((n, values), y) in nodes.iter().zip(&told).zip(at) {
            let right = if self.is_held(n) { right - 12.0 } else { right };
            let room = right - column.span[0] - 2.0;
            let mut own = Group::new();
            let name = |x: f64, y: f64, room: f64| {
                let name = fit(&n.member, room / BOLD, 11.0);
                halo(text(x, y, 11.0, Anchor::End, &name).set("font-weight", "bold"), PAPER, 3.0)
            };
            if one_line {
                for (value, class) in values.iter().zip(["speed", "torque"]) {
                    let value_x = right - wide(value, 11.0) - 5.0;
                    let value = text(right, y + 4.0, 11.0, Anchor::End, value).set("fill", FAINT);
                    own = own.add(Group::new().set("class", class).add(halo(value, PAPER, 3.0)).add(name(
                        value_x,
                        y + 4.0,
                        room,
                    )));
                }
            } else {
                own = own.add(name(right, y - 1.0, room));
                for (value, class) in values.iter().zip(["speed", "torque"]) {
                    let value = text(right, y + 12.0, 11.0, Anchor::End, &fit(value, room, 11.0)).set("fill", FAINT);
                    own = own.add(halo(value, PAPER, 3.0).set("class", class));
                }
            }
            g = g.add(of(own, "name", &[Of::Member(&n.member), Of::Mesh(set)]));
        }
        g
    }

    fn speed(&self, n: &LeverNode) -> String {
        match n.speeds.first().copied().flatten() {
            Some(w) => figures(rested(w * self.factor), 4),
            None => "not settled".to_owned(),
        }
    }

    /// All torques of a member on this lever together.
    fn torque(&self, bar: &LeverBar, n: &LeverNode) -> String {
        if !self.lever.torques {
            return "–".to_owned();
        }
        let own = bar.sets.iter().flat_map(|s| &s.pulls).filter(|p| bar.nodes[p.node].member == n.member);
        let sum: f64 = own.map(|p| p.torque).sum();
        let sum = if sum.abs() < 1e-9 * self.scale.torque { 0.0 } else { sum };
        format!("{} {}", figures(sum * self.torque.0, 4), self.torque.1).trim_end().to_owned()
    }

    fn words(&self) -> String {
        let one = |bar: &LeverBar| {
            let nodes = bar.nodes.iter().filter(|n| !planet(n));
            let all: Vec<String> = nodes.map(|n| format!("{} {}", n.member, self.speed(n))).collect();
            format!("{}: {}", bar.name(), all.join(", "))
        };
        self.lever.bars.iter().map(one).collect::<Vec<_>>().join(". ")
    }
}

/// The lines of a scale.
const GRID: &str = "#e2e2db";

/// A speed that is nothing but round-off is none.
fn rested(w: f64) -> f64 {
    if w.abs() < 1e-9 { 0.0 } else { w }
}

fn arrow(x: f64, y: f64, length: f64, ink: &str) -> Group {
    let tip = x + length;
    let back = tip - length.signum() * 6.0;
    let n = |x: f64, y: f64| format!("{} {}", number(x), number(y));
    let head = format!("M{} L{} L{} Z", n(tip, y), n(back, y - 3.5), n(back, y + 3.5));
    let shaft: Line = line((x, y), (back, y), ink, 2.6);
    Group::new().add(shaft).add(svg::node::element::Path::new().set("d", head).set("fill", ink))
}
