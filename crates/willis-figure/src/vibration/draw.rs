//! Modes of vibration: a small stick diagram for each, its lines as wide as they swing, and a list of amplitudes.

use svg::node::element::{Group, Polyline};

use super::{Vibration, VibrationMode};
use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, digits, fit, halo, line, lines, number, page, rectangle, text, wide,
};
use crate::{Drawing, GearRole, JointKind, Place};

const MARGIN: f64 = 28.0;
/// Between two panels.
const GAP: f64 = 34.0;
/// Height of a row of the list.
const ROW: f64 = 18.0;
/// Width of a list, at least beside its diagram, and at most.
const LIST: f64 = 250.0;
const WIDEST_LIST: f64 = 380.0;
/// Half the length of a friction plate.
const PLATE: f64 = 7.0;
/// What swings less, relative to the largest, is drawn at rest.
const STILL: f64 = 5e-3;

/// Modes of vibration, drawn on the stick diagram of the train: a line is as wide as its member swings, broken where it swings the
/// other way.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis_figure::{draw_vibration, vibration};
///
/// let text = r#"
///     format = 1
///     name = "two discs"
///     members = ["a", "b"]
///     terminals = ["a", "b"]
///     [inertias]
///     a = "2 kg m^2"
///     b = "2 kg m^2"
///     [[shaft]]
///     name = "shaft"
///     members = ["a", "b"]
///     stiffness = "100 N m/rad"
/// "#;
/// let model = Model::from_toml(text).unwrap();
/// assert!(draw_vibration(&vibration(model.train(), None)?).contains("Mode 1: 1.59 Hz"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(data: &Vibration) -> String {
    draw_on(data, Drawing::default())
}

pub(super) fn draw_on(data: &Vibration, paper: Drawing) -> String {
    let width = paper.page(1180.0, 560.0);
    let room = width - 2.0 * MARGIN;
    let grid = [data.stick.width.max(1.0), data.stick.height.max(1.0)];
    // As many panels side by side as leave a step of the grid 20 units.
    let least = (grid[0] * 20.0 + 2.0 * PLATE + 8.0).max(250.0);
    let columns = ((room + GAP) / (least + GAP)).floor().clamp(1.0, data.modes.len().max(1) as f64) as usize;
    let cell = ((room + GAP) / columns as f64 - GAP).min(620.0);
    let unit = ((cell - 2.0 * PLATE - 8.0) / grid[0]).min(60.0);
    let rise = (200.0 / grid[1]).clamp(18.0, 40.0);
    // A single column leaves half a wide page free: there the list stands beside its diagram.
    let beside = columns == 1 && room - cell - GAP >= LIST;
    let rows: Vec<usize> = data.modes.chunks(columns).map(|c| c.iter().map(listed).max().unwrap_or(0)).collect();
    let head = 58.0;
    let mut page_body = Group::new()
        .add(text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&data.title, room / BOLD, 20.0)).set("font-weight", "bold"));
    let mut top = head + 2.0;
    for l in lines(&subtitle(data), room, 13.0) {
        page_body = page_body.add(text(MARGIN, top, 13.0, Anchor::Start, &l).set("fill", FAINT));
        top += 18.0;
    }
    top += 18.0;
    for (r, modes) in data.modes.chunks(columns).enumerate() {
        for (c, mode) in modes.iter().enumerate() {
            let left = MARGIN + c as f64 * (cell + GAP);
            let bottom = top + 30.0 + grid[1] * rise;
            let list = match beside {
                true => [left + cell + GAP, top + 12.0, (room - cell - GAP).min(WIDEST_LIST)],
                false => [left, bottom + 26.0, cell.min(WIDEST_LIST)],
            };
            let panel = Panel { data, mode, place: r * columns + c, left, top, cell, unit, rise, bottom, list };
            page_body = page_body.add(panel.draw());
        }
        let (diagram, list) = (30.0 + grid[1] * rise, rows[r] as f64 * ROW);
        top += if beside { diagram.max(12.0 + list) + 50.0 } else { diagram + 26.0 + list + 36.0 };
    }
    page(width, top, &format!("Modes of vibration of {}", data.title), &words(data)).add(page_body).to_string()
}

fn subtitle(data: &Vibration) -> String {
    let shifts = data.stick.joints.iter().any(|j| j.kind != JointKind::Shaft);
    let mut said = match (&data.stick.state, shifts) {
        (Some(state), _) => format!("State {state}. "),
        (None, true) => "As drawn, no shift element engaged. ".to_owned(),
        (None, false) => String::new(),
    };
    said += "A line is as wide as its member swings, by its angle, relative to the largest of the mode; full lines swing one way, \
             broken lines the other. Springs are as wide as their share of the strain energy.";
    match data.left_out {
        0 => said,
        n => format!("{said} {n} more modes of higher frequency are not drawn."),
    }
}

/// A mode by its number, frequency and damping ratio, which is called so.
fn heading(mode: &VibrationMode, damping: &str) -> String {
    let Some(k) = mode.number else { return "Without strain: 0 Hz".to_owned() };
    let damped = mode.damping_ratio.map_or(String::new(), |z| format!(", {damping} {}", digits(z)));
    format!("Mode {k}: {} Hz{damped}", digits(mode.frequency_hz))
}

/// The picture in words.
fn words(data: &Vibration) -> String {
    let all = data.modes.iter().map(|m| {
        let largest = m.shape.iter().max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
        let most = largest.map_or(String::new(), |p| format!("; {} swings most", p.name));
        format!("{}{most}.", heading(m, "damping ratio"))
    });
    format!("{} {}", subtitle(data), all.collect::<Vec<_>>().join(" "))
}

/// Rows of the list of a mode.
fn listed(mode: &VibrationMode) -> usize {
    mode.shape.len() + strained(mode).count() + usize::from(strained(mode).next().is_some())
}

/// What stores a part of the strain energy that can be told.
fn strained(mode: &VibrationMode) -> impl Iterator<Item = &willis::dynamics::Part> {
    mode.strain_energy.iter().filter(|p| p.value >= 5e-4)
}

/// One mode on the page.
struct Panel<'a> {
    data: &'a Vibration,
    mode: &'a VibrationMode,
    /// Which panel of the figure it is.
    place: usize,
    left: f64,
    top: f64,
    cell: f64,
    unit: f64,
    rise: f64,
    /// Of the stick diagram.
    bottom: f64,
    /// Left edge, top and width of the list.
    list: [f64; 3],
}

/// How a line is drawn.
struct Stroke {
    ink: String,
    width: f64,
    broken: bool,
}

impl Panel<'_> {
    fn draw(&self) -> Group {
        let head = fit(&heading(self.mode, "ζ"), self.cell / BOLD, 13.0);
        let title = text(self.left, self.top, 13.0, Anchor::Start, &head).set("font-weight", "bold");
        Group::new()
            .add(title)
            .add(self.frame())
            .add(self.members())
            .add(self.joints())
            .add(self.numbers())
            .add(self.list())
    }

    fn at(&self, p: Place) -> (f64, f64) {
        let x = self.left + PLATE + 4.0 + p[0] * self.unit;
        (x.round(), (self.bottom - p[1] * self.rise).round())
    }

    /// The amplitude of a member, where its motion is settled.
    fn amplitude(&self, name: &str) -> Option<f64> {
        self.mode.shape.iter().find(|p| p.name == name).map(|p| p.value)
    }

    fn stroke(&self, name: &str) -> Stroke {
        match self.amplitude(name).filter(|a| a.abs() >= STILL) {
            Some(a) => {
                let sign = usize::from(a < 0.0);
                Stroke { ink: colour(Some(sign), 1.0), width: 1.6 + 5.0 * a.abs().min(1.0), broken: a < 0.0 }
            }
            None => Stroke { ink: LINE.to_owned(), width: 1.2, broken: false },
        }
    }

    fn polyline(&self, points: &[(f64, f64)], stroke: &Stroke) -> Polyline {
        let all: Vec<String> = points.iter().map(|p| format!("{},{}", number(p.0), number(p.1))).collect();
        let line = Polyline::new()
            .set("points", all.join(" "))
            .set("fill", "none")
            .set("stroke", stroke.ink.as_str())
            .set("stroke-width", number(stroke.width))
            .set("stroke-linejoin", "round");
        if stroke.broken { line.set("stroke-dasharray", "6 3") } else { line }
    }

    /// What belongs to the picture and not to a mode: centre lines, the frame.
    fn frame(&self) -> Group {
        let stick = &self.data.stick;
        let mut g = guide(Group::new());
        for y in &stick.axes {
            let axis = line(self.at([0.0, *y]), self.at([stick.width, *y]), LINE, 1.0);
            g = g.add(axis.set("stroke-dasharray", "14 4 3 4"));
        }
        let frame = Stroke { ink: INK.to_owned(), width: 1.4, broken: false };
        for points in &stick.frame {
            let all: Vec<(f64, f64)> = points.iter().map(|p| self.at(*p)).collect();
            g = g.add(self.polyline(&all, &frame));
        }
        for ground in &stick.grounds {
            let (x, y) = self.at(ground.at);
            let [dx, dy] = ground.into.map(f64::from);
            // A bar across the direction into the frame, and three strokes behind it.
            let along = |t: f64, s: f64| (x + dx * t - dy * s, y - dy * t - dx * s);
            g = g.add(line(along(0.0, -PLATE), along(0.0, PLATE), INK, 1.4));
            for k in [-1.0, 0.0, 1.0] {
                g = g.add(line(along(0.0, 5.0 * k), along(4.0, 5.0 * k - 3.0), INK, 1.0));
            }
        }
        g
    }

    fn members(&self) -> Group {
        let stick = &self.data.stick;
        let mut g = Group::new();
        let mode = format!("mode {}", self.place + 1);
        for (k, m) in stick.members.iter().enumerate() {
            let stroke = self.stroke(&m.name);
            let mut own = Group::new();
            for piece in &m.pieces {
                let all: Vec<(f64, f64)> = piece.points.iter().map(|p| self.at(*p)).collect();
                own = own.add(self.polyline(&all, &stroke));
            }
            for gear in stick.gears.iter().filter(|gear| gear.member == Some(k)) {
                for [hub, tip] in &gear.stems {
                    own = own.add(self.polyline(&[self.at(*hub), self.at(*tip)], &stroke));
                }
                let face = Stroke { ink: stroke.ink.clone(), width: 2.4, broken: false };
                // Towards the hub, so that two rows of teeth lie side by side.
                let up = |from: Place, hub: Place| if hub[1] < from[1] { 1.6 } else { -1.6 };
                for [a, b] in &gear.faces {
                    let level = a[1] == b[1];
                    let shift = gear.stems.first().map_or(0.0, |s| if level { up(*a, s[0]) } else { 0.0 });
                    let ends = [self.at(*a), self.at(*b)].map(|p| (p.0, p.1 + shift));
                    own = own.add(self.polyline(&ends, &face));
                }
                if gear.role == GearRole::Planet {
                    for [hub, _] in &gear.stems {
                        let (x, y) = self.at(*hub);
                        let pin = rectangle(x - 2.5, y - 2.5, 5.0, 5.0, PAPER).set("rx", 2.5);
                        own = own.add(pin.set("stroke", INK).set("stroke-width", 1.2));
                    }
                }
            }
            g = g.add(of(own, "swings", &[Of::Member(&m.name), Of::Quantity(&mode)]));
        }
        // Gears of the frame stand still.
        let still = Stroke { ink: INK.to_owned(), width: 1.4, broken: false };
        let mut own = guide(Group::new());
        for gear in stick.gears.iter().filter(|gear| gear.member.is_none()) {
            for [a, b] in gear.stems.iter().chain(&gear.faces) {
                own = own.add(self.polyline(&[self.at(*a), self.at(*b)], &still));
            }
        }
        g.add(own)
    }

    /// Shift elements closed or open, one-way clutches as such; springs by their share of the strain energy.
    fn joints(&self) -> Group {
        let mut g = Group::new();
        let mode = format!("mode {}", self.place + 1);
        for j in &self.data.stick.joints {
            let [a, b] = j.ends.map(|p| self.at(p));
            let length = (b.0 - a.0).hypot(b.1 - a.1).max(1e-9);
            let (ux, uy) = ((b.0 - a.0) / length, (b.1 - a.1) / length);
            let along = |t: f64, s: f64| (a.0 + ux * t - uy * s, a.1 + uy * t + ux * s);
            let middle = length / 2.0;
            let thin = |width: f64| Stroke { ink: INK.to_owned(), width, broken: false };
            let own = match j.kind {
                JointKind::Shaft => {
                    let share = self.mode.strain_energy.iter().find(|p| p.name == j.name).map_or(0.0, |p| p.value);
                    let zigzag = [0.0, -5.0, 5.0, -5.0, 5.0, 0.0].into_iter().enumerate();
                    let points = std::iter::once(a)
                        .chain(zigzag.map(|(k, s)| along(middle - 8.0 + 3.2 * k as f64, s)))
                        .chain([b])
                        .collect::<Vec<_>>();
                    Group::new().add(self.polyline(&points, &thin(1.2 + 3.4 * share.clamp(0.0, 1.0))))
                }
                _ => {
                    let gap = if j.engaged { 1.6 } else { 3.4 };
                    let plate = if j.engaged { 3.0 } else { 1.4 };
                    [(a, -1.0), (b, 1.0)].into_iter().fold(Group::new(), |g, (end, side)| {
                        let foot = along(middle + side * gap, 0.0);
                        let [p, q] = [-PLATE, PLATE].map(|s| along(middle + side * gap, s));
                        g.add(self.polyline(&[end, foot], &thin(1.2))).add(self.polyline(&[p, q], &thin(plate)))
                    })
                }
            };
            g = g.add(of(own, "joint", &[Of::Element(&j.name), Of::Quantity(&mode)]));
        }
        g
    }

    /// The number of each member of the list, on its longest line that has room for it.
    fn numbers(&self) -> Group {
        let mut taken: Vec<(f64, f64)> = vec![];
        let mut g = Group::new();
        for (k, part) in self.mode.shape.iter().enumerate() {
            let Some(m) = self.data.stick.members.iter().find(|m| m.name == part.name) else { continue };
            let mut all: Vec<[(f64, f64); 2]> = m
                .pieces
                .iter()
                .flat_map(|p| p.points.windows(2).map(|w| [self.at(w[0]), self.at(w[1])]).collect::<Vec<_>>())
                .collect();
            let length = |l: &[(f64, f64); 2]| (l[1].0 - l[0].0).hypot(l[1].1 - l[0].1);
            all.sort_by(|a, b| length(b).total_cmp(&length(a)));
            let places = all
                .iter()
                .flat_map(|[a, b]| [0.5, 0.3, 0.7, 0.15, 0.85].map(|t| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))));
            let free = |p: &(f64, f64)| taken.iter().all(|t| (t.0 - p.0).abs() > 17.0 || (t.1 - p.1).abs() > 15.0);
            let Some(at) = places.into_iter().find(free) else { continue };
            taken.push(at);
            let name = text(at.0, at.1 + 4.0, 11.0, Anchor::Middle, &(k + 1).to_string()).set("font-weight", "bold");
            g = g.add(halo(name, PAPER, 4.0));
        }
        g
    }

    /// Amplitudes of members to the right and left of a line, then shares of the strain energy.
    fn list(&self) -> Group {
        let [left, mut y, width] = self.list;
        let longest = self.mode.shape.iter().chain(&self.mode.strain_energy).map(|p| wide(&p.name, 11.0));
        let names = (longest.fold(0.0, f64::max) + 34.0).min(0.5 * width);
        let half = (width - names) / 2.0;
        let middle = left + names + half;
        // The number stands on the free side.
        let most = half - 4.0;
        let mode = format!("mode {}", self.place + 1);
        let mut g =
            guide(Group::new()).add(line((middle, y), (middle, y + ROW * self.mode.shape.len() as f64), LINE, 1.0));
        g = Group::new().add(g);
        for (k, part) in self.mode.shape.iter().enumerate() {
            let name = format!("{} {}", k + 1, fit(&part.name, names - 28.0, 11.0));
            let value = if part.value.abs() < 1e-9 { 0.0 } else { part.value };
            let length = (most * value.abs().min(1.0)).max(0.8);
            let negative = value < 0.0;
            let from = if negative { middle - length } else { middle };
            let fill = colour(Some(usize::from(negative)), 0.75);
            let (at, anchor) = if negative { (middle + 5.0, Anchor::Start) } else { (middle - 5.0, Anchor::End) };
            let row = Group::new()
                .add(text(left, y + 13.0, 11.0, Anchor::Start, &name))
                .add(rectangle(from, y + 4.0, length, ROW - 8.0, &fill))
                .add(text(at, y + 13.0, 11.0, anchor, &digits(value)).set("fill", FAINT));
            g = g.add(of(row, "amplitude", &[Of::Member(&part.name), Of::Quantity(&mode)]));
            y += ROW;
        }
        if strained(self.mode).next().is_some() {
            g = g.add(text(left, y + 13.0, 11.0, Anchor::Start, "strain energy, %").set("fill", FAINT));
            y += ROW;
        }
        for part in strained(self.mode) {
            let share = digits((1000.0 * part.value).round() / 10.0);
            let length = ((half * 2.0 - 52.0) * part.value.min(1.0)).max(0.8);
            let row = Group::new()
                .add(text(left, y + 13.0, 11.0, Anchor::Start, &fit(&part.name, names - 10.0, 11.0)))
                .add(rectangle(left + names, y + 4.0, length, ROW - 8.0, &colour(None, 0.75)))
                .add(text(left + names + length + 5.0, y + 13.0, 11.0, Anchor::Start, &share).set("fill", FAINT));
            g = g.add(of(row, "strain", &[Of::Element(&part.name), Of::Quantity(&mode)]));
            y += ROW;
        }
        g
    }
}
