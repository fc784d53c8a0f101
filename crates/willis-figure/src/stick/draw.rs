//! The kinematic schematic (stick diagram).

mod labels;
mod sheet;

use svg::Document;
use svg::node::element::{Circle, Group, Path, Polyline};

use self::labels::Labels;
use self::sheet::{PLATE, ROW, Sheet, role};
use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, digits, fit, line, lines, number, page, rectangle, text, wide,
};
use crate::{Columns, Drawing, GearRole, JointKind, Place, Stick, StickJoint, StickPiece, TerminalDirection};

/// Length of a terminal's arrow.
const ARROW: f64 = 40.0;
const THIN: f64 = 2.0;
const THICK: f64 = 6.0;

/// The schematic of a train as transmission textbooks draw it: half section above each centre line, gears
/// as lines with their tooth counts, members as coloured lines with their names, clutches, brakes and the
/// frame; in a state the closed elements and, drawn thick, the way of the power.
///
/// # Example
/// ```
/// use willis_figure::stick;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4))
///     .build()?;
/// let picture = willis_figure::draw_stick(&stick(&train, None)?);
/// assert!(picture.starts_with("<svg"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(data: &Stick) -> String {
    draw_on(data, Drawing::default())
}

pub(super) fn draw_on(data: &Stick, paper: Drawing) -> String {
    let sheet = Sheet::new(data, paper);
    let mut page = page(sheet.width, sheet.height, &format!("Stick diagram of {}", data.title), &words(data)).add(
        text(28.0, 38.0, 20.0, Anchor::Start, &fit(&data.title, (sheet.width - 56.0) / BOLD, 20.0))
            .set("font-weight", "bold"),
    );
    for (k, l) in lines(&subtitle(data), sheet.width - 56.0, 13.0).iter().take(2).enumerate() {
        page = page.add(text(28.0, 60.0 + 18.0 * k as f64, 13.0, Anchor::Start, l).set("fill", FAINT));
    }
    sheet.scheme(true).into_iter().fold(page, Document::add).add(sheet.list()).add(sheet.key()).to_string()
}

/// The schematic alone for a panel of a screen that is so many px high, its sets in columns. Texts have 11 and 12 px. Where the
/// height does not suffice it is drawn higher.
pub fn in_columns(data: &Stick, columns: &Columns, height: f64) -> String {
    let sheet = Sheet::in_columns(data, columns, height);
    let mut page = page(sheet.width, sheet.height, &format!("Stick diagram of {}", data.title), &words(data));
    if columns.aligned() {
        page = page.add(columns.zones(sheet.height));
    }
    sheet.scheme(false).into_iter().fold(page, Document::add).to_string()
}

/// The same with the names of its sets, to be put on a sheet; its width and height.
pub(crate) fn scheme_of(data: &Stick, columns: &Columns, height: f64) -> (Group, [f64; 2]) {
    let sheet = Sheet::in_columns(data, columns, height);
    (sheet.scheme(true).into_iter().fold(Group::new(), Group::add), [sheet.width, sheet.height])
}

fn subtitle(data: &Stick) -> String {
    let shown = data.members.iter().any(|m| m.loaded == Some(true));
    let circle = data.members.iter().flat_map(|m| &m.pieces).any(|p| p.circulates);
    let path = match (shown, circle) {
        (true, true) => " Thick: the power path, driving, without losses; broken: power that circulates between sets.",
        (true, false) => " Thick: the power path, driving, without losses.",
        _ => "",
    };
    let closed: Vec<&str> =
        data.joints.iter().filter(|j| j.engaged && j.kind != JointKind::Shaft).map(|j| j.name.as_str()).collect();
    match &data.state {
        Some(s) if closed.is_empty() => format!("State {s}: nothing closed.{path}"),
        Some(s) => format!("State {s}: closed {}.{path}", closed.join(", ")),
        None if data.states.is_empty() => format!("Half section above the axis.{path}"),
        None => "Half section above the axis; no shift element closed.".to_owned(),
    }
}

/// The picture in words.
fn words(data: &Stick) -> String {
    let joints = data.joints.iter().map(|j| {
        let name = |m: Option<usize>| m.map_or("frame", |k| data.members[k].name.as_str());
        format!("{} joins {} and {}", j.name, name(j.members[0]), name(j.members[1]))
    });
    let blocks = data.blocks.iter().enumerate().map(|(b, block)| {
        let gears = data.gears.iter().filter(|g| g.block == b);
        let all: Vec<String> = gears.map(|g| format!("{} {}", role(g), g.teeth).trim_end().to_owned()).collect();
        format!("{}: {}", block.name, all.join(", "))
    });
    let mut all: Vec<String> = blocks.chain(joints).collect();
    all.push(subtitle(data));
    all.join(". ")
}

impl Sheet<'_> {
    /// Everything but the words around it; sets with their names where these do not stand elsewhere.
    fn scheme(&self, named: bool) -> Vec<Group> {
        let mut labels = Labels::default();
        let mut all = vec![
            self.axes(),
            self.highlights(),
            self.member_lines(&mut labels),
            self.gears(&mut labels),
            self.joints(&mut labels),
            self.grounds(&mut labels),
            self.terminals(&mut labels),
        ];
        all.extend(named.then(|| self.block_names()));
        all.extend([self.joint_names(&mut labels), self.teeth(&mut labels), self.member_names(&mut labels)]);
        all
    }

    fn axes(&self) -> Group {
        let mut g = guide(Group::new());
        for y in &self.data.axes {
            let (from, to) = (self.at([0.0, *y]), self.at([self.data.width, *y]));
            g = g
                .add(line((from.0 - 26.0, from.1), (to.0 + 26.0, to.1), LINE, 1.0).set("stroke-dasharray", "14 4 3 4"));
        }
        g
    }

    /// A light ground under what is closed.
    fn highlights(&self) -> Group {
        let mut g = Group::new();
        for j in self.data.joints.iter().filter(|j| j.engaged && j.kind != JointKind::Shaft) {
            let [a, b] = j.ends.map(|p| self.at(p));
            let (x, y) = ((a.0 + b.0) / 2.0, (a.1 + b.1) / 2.0);
            let r = PLATE + 5.0;
            let ground = rectangle(x - r, y - r, 2.0 * r, 2.0 * r, &colour(Some(4), 0.45)).set("rx", 4);
            g = g.add(of(ground, "closed", &[Of::Element(&j.name)]));
        }
        g
    }

    fn member_lines(&self, labels: &mut Labels) -> Group {
        let mut g = Group::new();
        let frame = self.data.frame.iter().map(|l| self.polyline(l, INK, THIN + 0.6, labels));
        g = g.add(of(frame.fold(Group::new(), Group::add), "line", &[Of::Member("frame")]));
        for loaded in [false, true] {
            for (k, m) in self.data.members.iter().enumerate().filter(|(k, _)| self.category[*k].is_some()) {
                let ink = self.ink(Some(k));
                let mut lines = Group::new();
                for p in m.pieces.iter().filter(|p| p.loaded == loaded) {
                    lines = lines.add(self.polyline(&p.points, &ink, if loaded { THICK } else { THIN }, labels));
                    if p.circulates {
                        let broken = self.polyline(&p.points, PAPER, 2.0, &mut Labels::default());
                        lines = lines.add(broken.set("stroke-dasharray", "7 5").set("stroke-linecap", "butt"));
                    }
                    lines = lines.add(self.direction(p, &ink));
                }
                for d in m.dots.iter().filter(|_| loaded) {
                    let (x, y) = self.at(*d);
                    lines = lines.add(
                        Circle::new().set("cx", number(x)).set("cy", number(y)).set("r", 3).set("fill", ink.as_str()),
                    );
                }
                // What carries power lies above what does not, so a member may have two groups.
                g = g.add(of(lines, if loaded { "power" } else { "line" }, &[Of::Member(&m.name)]));
            }
        }
        g
    }

    /// An arrowhead where the power of a line runs level or upright for the longest time.
    fn direction(&self, piece: &StickPiece, ink: &str) -> Group {
        const LONG: f64 = 13.0;
        const HALF: f64 = 7.5;
        let g = Group::new();
        let Some(power) = piece.power.filter(|p| piece.loaded && p.abs() > 1e-9) else { return g };
        let all: Vec<(f64, f64)> = piece.points.iter().map(|p| self.at(*p)).collect();
        let length = |w: &[(f64, f64)]| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1);
        let Some(longest) = all.windows(2).max_by(|a, b| length(a).total_cmp(&length(b))) else { return g };
        if length(longest) < 1.6 * LONG {
            return g;
        }
        let [from, to] = if power > 0.0 { [longest[0], longest[1]] } else { [longest[1], longest[0]] };
        let (ux, uy) = ((to.0 - from.0) / length(longest), (to.1 - from.1) / length(longest));
        let middle = ((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0);
        let point = |along: f64, aside: f64| {
            let (x, y) = (middle.0 + ux * along - uy * aside, middle.1 + uy * along + ux * aside);
            format!("{} {}", number(x), number(y))
        };
        let d = format!("M{} L{} L{} Z", point(LONG / 2.0, 0.0), point(-LONG / 2.0, HALF), point(-LONG / 2.0, -HALF));
        g.add(Path::new().set("d", d).set("fill", ink))
    }

    fn polyline(&self, points: &[Place], ink: &str, width: f64, labels: &mut Labels) -> Polyline {
        let all: Vec<(f64, f64)> = points.iter().map(|p| self.at(*p)).collect();
        all.windows(2).for_each(|w| labels.mark(w[0], w[1], width / 2.0 + 1.0));
        let text: Vec<String> = all.iter().map(|p| format!("{},{}", number(p.0), number(p.1))).collect();
        Polyline::new()
            .set("points", text.join(" "))
            .set("fill", "none")
            .set("stroke", ink)
            .set("stroke-width", number(width))
            .set("stroke-linejoin", "round")
            .set("stroke-linecap", "square")
    }

    fn gears(&self, labels: &mut Labels) -> Group {
        let mut g = Group::new();
        for (nth, gear) in self.data.gears.iter().enumerate() {
            let mut body_of = Group::new();
            let planet = gear.role == GearRole::Planet;
            let ink = if planet { INK.to_owned() } else { self.ink(gear.member) };
            let body = if gear.loaded { THICK } else { THIN };
            for [hub, tip] in &gear.stems {
                let (a, b) = (self.at(*hub), self.near(*tip, *hub));
                labels.mark(a, b, body / 2.0 + 1.0);
                body_of = body_of.add(line(a, b, &ink, body));
            }
            for face in &gear.faces {
                let stem = gear.stems.iter().find(|s| on(face, s[1])).or(gear.stems.first());
                let Some(&[hub, tip]) = stem else { continue };
                let middle = [(face[0][0] + face[1][0]) / 2.0, (face[0][1] + face[1][1]) / 2.0];
                let (shifted, from) = (self.near(middle, hub), self.at(middle));
                // Towards the hub, so that two rows of teeth lie side by side.
                let upright = hub[1] == tip[1];
                let (dx, dy) = if upright { (shifted.0 - from.0, 0.0) } else { (0.0, shifted.1 - from.1) };
                let [a, b] = face.map(|p| self.at(p)).map(|p| (p.0 + dx, p.1 + dy));
                labels.mark(a, b, 3.0);
                body_of = body_of.add(line(a, b, &ink, 3.0));
            }
            let name = gear.member.map_or("frame", |k| self.data.members[k].name.as_str());
            let about = [Of::Member(name), Of::Mesh(&self.data.blocks[gear.block].name)];
            g = g.add(of(body_of, &format!("gear{nth}"), &about));
        }
        // Stepped planets are one body; each turns on its pin.
        for (k, m) in self.data.members.iter().enumerate() {
            let mut hubs: Vec<Place> = self
                .data
                .gears
                .iter()
                .filter(|g| g.role == GearRole::Planet && g.member == Some(k))
                .flat_map(|g| g.stems.iter().map(|s| s[0]))
                .collect();
            hubs.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
            hubs.dedup();
            let (Some(first), Some(last)) = (hubs.first(), hubs.last()) else { continue };
            let mut own = Group::new();
            if first != last {
                let width = if m.loaded == Some(true) { 8.0 } else { 5.0 };
                own = own.add(line(self.at(*first), self.at(*last), INK, width));
                labels.mark(self.at(*first), self.at(*last), width / 2.0);
            }
            for h in hubs {
                let (x, y) = self.at(h);
                labels.mark((x, y), (x, y), 6.0);
                own = own.add(
                    Circle::new()
                        .set("cx", number(x))
                        .set("cy", number(y))
                        .set("r", 5)
                        .set("fill", PAPER)
                        .set("stroke", INK)
                        .set("stroke-width", 1.6),
                );
            }
            g = g.add(of(own, "pin", &[Of::Member(&m.name)]));
        }
        g
    }

    /// A point a little towards another one.
    fn near(&self, p: Place, to: Place) -> (f64, f64) {
        let (a, b) = (self.at(p), self.at(to));
        let length = (b.0 - a.0).hypot(b.1 - a.1).max(1e-9);
        (a.0 + (b.0 - a.0) / length * 2.4, a.1 + (b.1 - a.1) / length * 2.4)
    }

    fn joints(&self, labels: &mut Labels) -> Group {
        let mut g = Group::new();
        for j in &self.data.joints {
            g = g.add(of(self.joint(j, labels), "joint", &[Of::Element(&j.name)]));
        }
        g
    }

    fn joint(&self, j: &StickJoint, labels: &mut Labels) -> Group {
        self.symbol(j, j.ends.map(|p| self.at(p)), labels)
    }

    /// A joint between two points of the page.
    fn symbol(&self, j: &StickJoint, [a, b]: [(f64, f64); 2], labels: &mut Labels) -> Group {
        let length = (b.0 - a.0).hypot(b.1 - a.1).max(1e-9);
        let (ux, uy) = ((b.0 - a.0) / length, (b.1 - a.1) / length);
        let middle = length / 2.0;
        let along = |t: f64, s: f64| (a.0 + ux * t - uy * s, a.1 + uy * t + ux * s);
        let inks = j.members.map(|m| self.ink(m));
        let lead = if j.loaded { THICK } else { THIN };
        labels.mark(a, b, 2.0);
        labels.mark(along(middle - 5.0, -PLATE), along(middle + 5.0, PLATE), 1.5);
        let mut g = Group::new();
        let path = |d: String, ink: &str, width: f64| {
            Path::new().set("d", d).set("fill", "none").set("stroke", ink).set("stroke-width", number(width))
        };
        let point = |p: (f64, f64)| format!("{} {}", number(p.0), number(p.1));
        match j.kind {
            JointKind::OneWay => {
                let r = 8.0;
                g = g.add(line(a, along(middle - r, 0.0), &inks[0], lead));
                g = g.add(line(along(middle + r, 0.0), b, &inks[1], lead));
                // It locks in one direction only: a triangle against a bar.
                let [p, q, tip] = [along(middle - r, -r), along(middle - r, r), along(middle + r - 1.0, 0.0)];
                let body = format!("M{} L{} L{} Z", point(p), point(q), point(tip));
                g = g.add(path(body, INK, 1.6).set("fill", if j.engaged { INK } else { PAPER }));
                g = g.add(line(along(middle + r, -r), along(middle + r, r), INK, if j.engaged { 3.4 } else { 2.0 }));
            }
            JointKind::Shaft => {
                // A spring.
                let mut d = format!("M{}", point(a));
                for (k, s) in [0.0, -6.0, 6.0, -6.0, 6.0, 0.0].into_iter().enumerate() {
                    d.push_str(&format!(" L{}", point(along(middle - 10.0 + 4.0 * k as f64, s))));
                }
                d.push_str(&format!(" L{}", point(b)));
                g = g.add(path(d, INK, lead));
            }
            _ => {
                let gap = if j.engaged { 2.2 } else { 3.6 };
                let plate = if j.engaged { 3.6 } else { 2.0 };
                for (ink, end, side) in [(&inks[0], a, -1.0), (&inks[1], b, 1.0)] {
                    g = g.add(line(end, along(middle + side * gap, 0.0), ink, lead));
                    let [p, q] = [-PLATE, PLATE].map(|s| along(middle + side * gap, s));
                    g = g.add(line(p, q, ink, plate));
                }
            }
        }
        g
    }

    fn grounds(&self, labels: &mut Labels) -> Group {
        let mut g = Group::new();
        for mark in &self.data.grounds {
            let (x, y) = self.at(mark.at);
            let (ix, iy) = (f64::from(mark.into[0]), -f64::from(mark.into[1]));
            let along = |s: f64, t: f64| (x - iy * s + ix * t, y + ix * s + iy * t);
            labels.mark(along(-PLATE - 1.0, 0.0), along(PLATE + 1.0, 7.0), 1.0);
            g = g.add(hatch((x, y), (ix, iy)));
        }
        of(g, "ground", &[Of::Member("frame")])
    }

    fn terminals(&self, labels: &mut Labels) -> Group {
        let mut all = Group::new();
        for (nth, t) in self.data.terminals.iter().enumerate() {
            let mut g = Group::new();
            let m = &self.data.members[t.member];
            let ink = self.ink(Some(t.member));
            let (x, y) = self.at(t.at);
            let side = if t.left { -1.0 } else { 1.0 };
            let tip = x + side * ARROW;
            let loaded = m.pieces.iter().any(|p| p.loaded && p.points.contains(&t.at));
            let width = if loaded { THICK } else { THIN };
            labels.mark((x, y), (tip, y), 8.0);
            if t.open {
                let out = t.way == Some(TerminalDirection::Out);
                let (end, back) = match t.way {
                    Some(TerminalDirection::Out) => (tip, x),
                    Some(TerminalDirection::In) => (x + side * 4.0, tip),
                    None => (x, tip),
                };
                let head = if t.way.is_some() { 14.0 * (end - back).signum() } else { 0.0 };
                g = g.add(line((if out { x } else { tip }, y), (end - head, y), &ink, width));
                if t.way.is_some() {
                    let d = format!(
                        "M{} {} L{} {} L{} {} Z",
                        number(end),
                        number(y),
                        number(end - head),
                        number(y - 8.0),
                        number(end - head),
                        number(y + 8.0)
                    );
                    g = g.add(Path::new().set("d", d).set("fill", ink.as_str()));
                    if !out {
                        g = g.add(line((end, y), (x, y), &ink, width));
                    }
                } else {
                    // Which way the power runs is open.
                    g = g.add(
                        Circle::new()
                            .set("cx", number(tip))
                            .set("cy", number(y))
                            .set("r", 4)
                            .set("fill", PAPER)
                            .set("stroke", ink.as_str())
                            .set("stroke-width", 2),
                    );
                }
            }
            if !t.open {
                g = g.add(line((x, y), (tip, y), &ink, width));
            }
            let name = fit(&m.name, (self.margin - ARROW - 18.0) / BOLD, 12.0);
            let (tx, anchor) = (tip + side * 10.0, if t.left { Anchor::End } else { Anchor::Start });
            labels.texts.push(Labels::bounds(tx, y + 4.0, 12.0, anchor, wide(&name, 12.0) * BOLD));
            g = g.add(text(tx, y + 4.0, 12.0, anchor, &name).set("font-weight", "bold"));
            all = all.add(of(g, &format!("terminal{nth}"), &[Of::Member(&m.name)]));
        }
        all
    }

    /// Under the lowest axis: no line runs there.
    fn block_names(&self) -> Group {
        let mut g = Group::new();
        let mut order: Vec<usize> = (0..self.data.blocks.len()).collect();
        let middle = |b: usize| (self.data.blocks[b].span[0] + self.data.blocks[b].span[1]) / 2.0;
        order.sort_by(|a, b| middle(*a).total_cmp(&middle(*b)));
        for (k, &b) in order.iter().enumerate() {
            let block = &self.data.blocks[b];
            let gap = |other: Option<&usize>| other.map_or(3.0, |o| (middle(*o) - middle(b)).abs());
            let room = gap(k.checked_sub(1).and_then(|j| order.get(j))).min(gap(order.get(k + 1))) * self.unit - 8.0;
            let (x, y) = (self.at([middle(b), 0.0]).0, self.bottom() + 40.0);
            let [from, to] = block.span.map(|x| self.at([x, 0.0]).0);
            let tick = y - 15.0;
            let own = Group::new()
                .add(line((from, tick), (to, tick), LINE, 1.0))
                .add(line((from, tick - 4.0), (from, tick), LINE, 1.0))
                .add(line((to, tick - 4.0), (to, tick), LINE, 1.0))
                .add(text(x, y, 12.0, Anchor::Middle, &fit(&block.name, room / BOLD, 12.0)).set("font-weight", "bold"));
            g = g.add(of(own, "set", &[Of::Mesh(&block.name)]));
        }
        g
    }

    /// Every member with its colour, its parts, and in a state its speed.
    fn list(&self) -> Group {
        let mut g = Group::new();
        let top = self.list_top();
        let speeds = self.speeds();
        let parts = self.parts_at();
        let columns = self.list_of_members();
        let left = |column: usize| 28.0 + self.list * column as f64;
        for x in (0..columns.len()).map(left) {
            g = g.add(text(x + 54.0, top, 11.0, Anchor::Start, "member").set("fill", FAINT));
            g = g.add(text(x + parts, top, 11.0, Anchor::Start, "its parts").set("fill", FAINT));
            if speeds {
                g = g.add(text(x + self.list - 24.0, top, 11.0, Anchor::End, "speed / input").set("fill", FAINT));
            }
        }
        for (column, members) in columns.into_iter().enumerate() {
            let (x, mut row) = (left(column), 0);
            for (k, lines) in members {
                let y = top + ROW * (row + 1) as f64;
                let m = &self.data.members[k];
                let width = if m.loaded == Some(true) { THICK } else { THIN };
                let number = self.category[k].map_or(0, |c| c + 1);
                let mut own = Group::new()
                    .add(text(x + 14.0, y, 11.0, Anchor::End, &number.to_string()).set("fill", FAINT))
                    .add(line((x + 20.0, y - 4.0), (x + 46.0, y - 4.0), &self.ink(Some(k)), width))
                    .add(text(x + 54.0, y, 12.0, Anchor::Start, &fit(&m.name, parts - 62.0, 12.0)));
                for (nth, part) in lines.iter().enumerate() {
                    let y = y + ROW * nth as f64;
                    own = own.add(text(x + parts, y, 11.0, Anchor::Start, part).set("fill", FAINT));
                }
                row += lines.len();
                if let Some(speed) = m.speed_ratio.filter(|_| speeds) {
                    let shown = if speed == 0.0 { "stands still".to_owned() } else { digits(speed) };
                    own = own.add(text(x + self.list - 24.0, y, 11.0, Anchor::End, &shown));
                }
                g = g.add(of(own, "row", &[Of::Member(&m.name)]));
            }
        }
        g
    }

    /// The symbols that occur.
    fn key(&self) -> Group {
        let y = self.height - 24.0;
        let mut x = 36.0;
        let mut g = guide(Group::new());
        let kinds = [
            (JointKind::Clutch, "clutch"),
            (JointKind::Brake, "brake"),
            (JointKind::OneWay, "one-way clutch"),
            (JointKind::Shaft, "elastic shaft"),
        ];
        for (kind, name) in kinds {
            if self.data.joints.iter().all(|j| j.kind != kind) {
                continue;
            }
            let plain = StickJoint {
                name: name.to_owned(),
                kind,
                members: [None, None],
                ends: [[0.0; 2]; 2],
                engaged: false,
                loaded: false,
            };
            let end = (x + 40.0, y - 4.0);
            g = g.add(self.symbol(&plain, [(x, y - 4.0), end], &mut Labels::default()));
            if kind == JointKind::Brake {
                g = g.add(hatch(end, (1.0, 0.0)));
            }
            g = g.add(text(x + 54.0, y, 11.0, Anchor::Start, name).set("fill", FAINT));
            x += 54.0 + wide(name, 11.0) + 28.0;
        }
        if !self.data.grounds.is_empty() {
            g = g.add(hatch((x + 12.0, y - 6.0), (0.0, 1.0)));
            g = g.add(text(x + 30.0, y, 11.0, Anchor::Start, "frame").set("fill", FAINT));
        }
        g
    }
}

/// Whether a point lies on a line of teeth.
fn on(face: &[Place; 2], p: Place) -> bool {
    (0..2).all(|k| p[k] >= face[0][k].min(face[1][k]) - 1e-9 && p[k] <= face[0][k].max(face[1][k]) + 1e-9)
}

/// The frame begins here and lies that way.
fn hatch((x, y): (f64, f64), (ix, iy): (f64, f64)) -> Group {
    let along = |s: f64, t: f64| (x - iy * s + ix * t, y + ix * s + iy * t);
    let mut g = Group::new().add(line(along(-PLATE, 0.0), along(PLATE, 0.0), INK, 2.2));
    for k in 0..4 {
        let s = -PLATE + 2.0 + 5.0 * f64::from(k);
        g = g.add(line(along(s, 0.0), along(s - 4.0, 6.0), INK, 1.1));
    }
    g
}
