//! The shift table with its ratios as steps.

use svg::node::element::{Circle, Group, Path, Rectangle};
use willis::train::ShiftElementKind;

use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, digits, fit, halo, line, lines, number, page, rectangle, text, wide,
};
use crate::{Drawing, ShiftChange, ShiftEfficiency, ShiftRow, ShiftTable};

const MARGIN: f64 = 28.0;
const ROW: f64 = 40.0;
/// Widths on a screen, and the least.
const RATIO: [f64; 2] = [96.0, 78.0];
const STEPS: [f64; 2] = [230.0, 136.0];
const EFFICIENCY: [f64; 2] = [128.0, 80.0];
/// Room for the letters of a vertical name.
const TALLEST: f64 = 104.0;
const BAND: &str = "#f6f6f6";

/// Where the columns stand.
struct Columns {
    names: f64,
    paths: f64,
    element: f64,
    elements: f64,
    ratio: f64,
    steps: f64,
    drive: f64,
    coast: f64,
    changes: f64,
    width: f64,
    top: f64,
    upright: bool,
}

/// The shift table of a train: dots where an element is closed, ratios as a stepped line, losses as
/// bars, and what changes from gear to gear.
///
/// # Example
/// ```
/// use willis_figure::shift;
/// use willis::train::{SetSpec, ShiftElementSpec, StateSpec, Train};
///
/// let train = Train::builder("two speeds")
///     .members(["s", "r", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .shift_element(ShiftElementSpec::brake("B", "r"))
///     .shift_element(ShiftElementSpec::clutch("C", "s", "c"))
///     .state(StateSpec::new("low", ["B"]))
///     .state(StateSpec::new("direct", ["C"]))
///     .build()?;
/// assert!(willis_figure::draw_shift(&shift(&train)?).starts_with("<svg"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(table: &ShiftTable) -> String {
    draw_on(table, Drawing::default())
}

pub(super) fn draw_on(table: &ShiftTable, paper: Drawing) -> String {
    let c = Columns::of(table, paper);
    let bottom = c.top + ROW * table.rows.len() as f64;
    let foot = foot(table);
    let foot: Vec<String> = foot.iter().flat_map(|f| lines(f, c.width - 2.0 * MARGIN, 13.0)).collect();
    let height = bottom + 34.0 + 19.0 * (foot.len() + 1) as f64 + 8.0;
    let mut g = Group::new().add(head(table, &c));
    for k in 0..table.rows.len() {
        let y = c.top + ROW * k as f64;
        if k % 2 == 0 {
            g = g.add(guide(rectangle(MARGIN - 8.0, y, c.changes - MARGIN, ROW, BAND)));
        }
    }
    g = g.add(grid(table, &c, bottom)).add(staircase(table, &c));
    for (k, row) in table.rows.iter().enumerate() {
        let own = cells(table, &c, row, c.top + ROW * (k as f64 + 0.5));
        g = g.add(of(own, "row", &[Of::State(&row.state)]));
    }
    for (k, change) in table.changes.iter().enumerate().filter(|(k, _)| !turns(table, *k)) {
        let own = changes(&c, change, c.top + ROW * (k + 1) as f64);
        g = g.add(of(own, "change", &[Of::State(&table.rows[k].state)]));
    }
    g = g.add(key(table, bottom + 34.0 + 19.0 * foot.len() as f64));
    for (k, row) in foot.iter().enumerate() {
        g = g.add(text(MARGIN, bottom + 34.0 + 19.0 * k as f64, 13.0, Anchor::Start, row));
    }
    page(c.width, height, &format!("Shift table of {}", table.title), &words(table))
        .add(
            text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&table.title, (c.width - 2.0 * MARGIN) / BOLD, 20.0))
                .set("font-weight", "bold"),
        )
        .add(
            text(MARGIN, 60.0, 13.0, Anchor::Start, &fit(&caption(table), c.width - 2.0 * MARGIN, 13.0))
                .set("fill", FAINT),
        )
        .add(g)
        .to_string()
}

impl Columns {
    fn of(table: &ShiftTable, paper: Drawing) -> Self {
        let whole = Self::so_wide(table, 1.0);
        let narrow = Self::so_wide(table, 0.0);
        let width = paper.page(whole.width, narrow.width);
        Self::so_wide(table, (width - narrow.width) / (whole.width - narrow.width))
    }

    /// With columns as wide as on a screen (1), as narrow as can be (0), or between.
    fn so_wide(table: &ShiftTable, part: f64) -> Self {
        let between = |[wide, narrow]: [f64; 2]| narrow + part * (wide - narrow);
        let longest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, f64::max);
        let names = longest(&mut table.rows.iter().map(|r| wide(&r.state, 14.0) * BOLD)).clamp(40.0, 180.0) + 16.0;
        let path = |r: &ShiftRow| r.path.as_ref().map_or(0.0, |p| wide(&arrow(p), 11.0));
        let paths = match table.one_path {
            true => 0.0,
            false => longest(&mut table.rows.iter().map(path)).clamp(60.0, 170.0) + 14.0,
        };
        let broadest = longest(&mut table.elements.iter().map(|e| wide(&e.name, 12.0) * BOLD));
        // Long names stand upright, and short ones where there are many.
        let element = between(if table.elements.len() > 8 { [36.0, 24.0] } else { [48.0, 28.0] });
        let upright = broadest > element - 4.0;
        let top = 60.0 + 44.0 + if upright { broadest.min(TALLEST) + 20.0 } else { 34.0 };
        let mut at = MARGIN + names;
        let mut next = |width: f64| {
            let here = at;
            at += width;
            here
        };
        let paths = next(paths);
        let elements = next(element * table.elements.len() as f64 + 10.0);
        let ratio = next(between(RATIO));
        let steps = next(between(STEPS));
        let drive = next(between(EFFICIENCY));
        let coast = next(between(EFFICIENCY));
        let widest = longest(&mut table.changes.iter().map(|c| wide(&exchange(c), 12.0) * BOLD)).clamp(90.0, 300.0);
        let changes = next(widest + 34.0);
        Self { names, paths, element, elements, ratio, steps, drive, coast, changes, width: at + MARGIN, top, upright }
    }

    fn element(&self, k: usize) -> f64 {
        self.elements + self.element * (k as f64 + 0.5)
    }
}

fn arrow([from, to]: &[String; 2]) -> String {
    format!("{from} → {to}")
}

/// Half the height of a symbol.
const PLATE: f64 = 5.0;

/// A shift element as schematics draw it: a clutch joins two shafts, a brake a shaft and the hatched frame, a one-way clutch
/// is a triangle against a bar.
fn symbol(kind: ShiftElementKind, x: f64, y: f64) -> Group {
    let upright = |x: f64, width: f64| line((x, y - PLATE), (x, y + PLATE), INK, width);
    let level = |from: f64, to: f64| line((from, y), (to, y), INK, 1.2);
    let g = Group::new();
    match kind {
        ShiftElementKind::OneWay => {
            let n = |x: f64, y: f64| format!("{} {}", number(x), number(y));
            let body = format!("M{} L{} L{} Z", n(x - 5.0, y - PLATE), n(x - 5.0, y + PLATE), n(x + 3.0, y));
            g.add(level(x - 9.0, x - 5.0))
                .add(Path::new().set("d", body).set("fill", PAPER).set("stroke", INK).set("stroke-width", 1.2))
                .add(upright(x + 4.0, 1.8))
                .add(level(x + 4.0, x + 9.0))
        }
        ShiftElementKind::Brake => {
            let g = g.add(level(x - 8.0, x - 2.0)).add(upright(x - 2.0, 1.8)).add(upright(x + 2.0, 1.8));
            (0..3).fold(g, |g, k| {
                let at = y - PLATE + 1.0 + 4.0 * f64::from(k);
                g.add(line((x + 2.6, at), (x + 6.6, at - 3.0), INK, 0.9))
            })
        }
        ShiftElementKind::Clutch => g
            .add(level(x - 8.0, x - 2.0))
            .add(upright(x - 2.0, 1.8))
            .add(upright(x + 2.0, 1.8))
            .add(level(x + 2.0, x + 8.0)),
    }
}

/// The symbols that occur, with their names.
fn key(table: &ShiftTable, y: f64) -> Group {
    let kinds = [
        (ShiftElementKind::Clutch, "clutch"),
        (ShiftElementKind::Brake, "brake"),
        (ShiftElementKind::OneWay, "one-way clutch"),
    ];
    let mut x = MARGIN + 10.0;
    let mut g = guide(Group::new());
    for (kind, name) in kinds.into_iter().filter(|(kind, _)| table.elements.iter().any(|e| e.kind == *kind)) {
        g = g.add(symbol(kind, x, y - 4.0)).add(text(x + 16.0, y, 13.0, Anchor::Start, name));
        x += 16.0 + wide(name, 13.0) + 30.0;
    }
    g
}

/// Whether the output turns the other way in the next row: nobody shifts there, so that nothing is said of it.
fn turns(table: &ShiftTable, k: usize) -> bool {
    let ratio = |k: usize| table.rows.get(k).and_then(|r| r.ratio);
    ratio(k).zip(ratio(k + 1)).is_some_and(|(a, b)| a * b < 0.0)
}

fn head(table: &ShiftTable, c: &Columns) -> Group {
    let y = c.top - 12.0;
    let bold = |x: f64, anchor: Anchor, words: &str| text(x, y, 12.0, anchor, words).set("font-weight", "bold");
    let mut g = Group::new().add(bold(MARGIN, Anchor::Start, "state"));
    if !table.one_path {
        g = g.add(bold(c.paths, Anchor::Start, "path"));
    }
    for (k, e) in table.elements.iter().enumerate() {
        let x = c.element(k);
        g = g.add(of(symbol(e.kind, x, y - 4.0), "column", &[Of::Element(&e.name)]));
        g = g.add(if c.upright {
            let name = fit(&e.name, TALLEST / BOLD, 12.0);
            text(x + 4.0, y - 14.0, 12.0, Anchor::Start, &name)
                .set("font-weight", "bold")
                .set("transform", format!("rotate(-90 {} {})", number(x + 4.0), number(y - 14.0)))
        } else {
            text(x, y - 15.0, 12.0, Anchor::Middle, &e.name).set("font-weight", "bold")
        });
    }
    g = g
        .add(bold(c.steps - 14.0, Anchor::End, "ratio"))
        .add(bold(c.steps + 8.0, Anchor::Start, "step to the next"))
        .add(bold(c.drive + 8.0, Anchor::Start, "driving"))
        .add(bold(c.coast + 8.0, Anchor::Start, "coasting"))
        .add(bold(c.changes + 22.0, Anchor::Start, "change"))
        .add(text(c.drive + 8.0, y - 15.0, 11.0, Anchor::Start, "nominal efficiency; bars: loss").set("fill", FAINT));
    g.add(guide(line((MARGIN - 8.0, c.top), (c.changes - 8.0, c.top), INK, 1.2)))
}

/// Thin lines between columns and the places of the dots.
fn grid(table: &ShiftTable, c: &Columns, bottom: f64) -> Group {
    let mut g = guide(Group::new());
    for (k, _) in table.rows.iter().enumerate() {
        for e in 0..table.elements.len() {
            let y = c.top + ROW * (k as f64 + 0.5);
            let place = Circle::new().set("cx", number(c.element(e))).set("cy", number(y)).set("r", 1.4);
            g = g.add(place.set("fill", LINE));
        }
    }
    for x in [c.elements - 6.0, c.ratio - 2.0, c.steps - 4.0, c.drive, c.coast] {
        g = g.add(line((x, c.top), (x, bottom), "#dcdcdc", 1.0));
    }
    g.add(line((MARGIN - 8.0, bottom), (c.changes - 8.0, bottom), INK, 1.2))
}

fn cells(table: &ShiftTable, c: &Columns, row: &ShiftRow, y: f64) -> Group {
    let name = fit(&row.state, (c.names - 14.0) / BOLD, 14.0);
    let mut g = Group::new().add(text(MARGIN, y + 5.0, 14.0, Anchor::Start, &name).set("font-weight", "bold"));
    if let (false, Some(path)) = (table.one_path, &row.path) {
        g = g.add(text(c.paths, y + 4.0, 11.0, Anchor::Start, &fit(&arrow(path), c.elements - c.paths - 14.0, 11.0)));
    }
    for (k, _) in row.closed.iter().enumerate().filter(|(_, closed)| **closed) {
        let dot = Circle::new().set("cx", number(c.element(k))).set("cy", number(y)).set("r", 8);
        let own = [Of::Element(&table.elements[k].name), Of::State(&row.state)];
        g = g.add(of(dot.set("fill", INK), "closed", &own));
    }
    let end = c.steps - 14.0;
    let Some(ratio) = row.ratio else {
        let note = row.note.clone().unwrap_or_default();
        let room = c.changes - c.ratio - 16.0;
        let all = lines(&note, room, 11.0);
        let shown: Vec<String> = match &all[..] {
            [first, second, _, ..] => vec![first.clone(), fit(&format!("{second} …"), room, 11.0)],
            few => few.to_vec(),
        };
        for (k, words) in shown.iter().enumerate() {
            let y = y + 4.0 + 14.0 * k as f64 - 7.0 * (shown.len() - 1) as f64;
            g = g.add(halo(text(c.ratio + 6.0, y, 11.0, Anchor::Start, words), PAPER, 3.0));
        }
        return g;
    };
    let exact = row
        .exact
        .clone()
        .filter(|e| e.contains('/') && wide(e, 11.0) < c.steps - c.ratio - 16.0)
        .map(|e| e.replace('-', "−"));
    let up = if exact.is_some() { 2.0 } else { -4.0 };
    g = g.add(text(end, y - up, 13.0, Anchor::End, &decimals(ratio)).set("font-weight", "bold"));
    if let Some(exact) = exact {
        g = g.add(text(end, y + 13.0, 11.0, Anchor::End, &exact).set("fill", FAINT));
    }
    let most = worst(table);
    g.add(efficiency(c, y, &row.drive, most, 0)).add(efficiency(c, y, &row.coast, most, 1))
}

fn worst(table: &ShiftTable) -> f64 {
    let all = table.rows.iter().flat_map(|r| [r.drive.value, r.coast.value]).flatten();
    all.fold(0.0, |a, e| a.max(1.0 - e))
}

fn efficiency(c: &Columns, y: f64, e: &ShiftEfficiency, worst: f64, way: usize) -> Group {
    let (x, room) = ([c.drive, c.coast][way] + 8.0, c.coast - c.drive);
    let g = Group::new();
    let Some(value) = e.value else {
        return g.add(text(x, y + 4.0, 11.0, Anchor::Start, &fit(&e.words, room - 14.0, 11.0)).set("fill", FAINT));
    };
    let g = g.add(text(x + 52.0, y + 4.0, 12.0, Anchor::End, &percent(value)));
    let length = if worst > 0.0 { (1.0 - value) / worst * (room - 74.0) } else { 0.0 };
    if length < 0.3 {
        return g;
    }
    let bar: Rectangle = rectangle(x + 56.0, y - 5.0, length, 10.0, &colour(Some(1 - way), 0.8));
    g.add(bar)
}

/// Ratios on a logarithmic scale, each a step from the one before.
fn staircase(table: &ShiftTable, c: &Columns) -> Group {
    let sizes: Vec<Option<f64>> = table.rows.iter().map(|r| r.ratio.map(|i| i.abs().ln())).collect();
    let (low, high) =
        sizes.iter().flatten().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    let mut g = Group::new();
    if low > high {
        return g;
    }
    let (left, right) = (c.steps + 14.0, c.drive - 58.0);
    let x = |size: f64| match high - low > 1e-9 {
        true => left + (size - low) / (high - low) * (right - left),
        false => (left + right) / 2.0,
    };
    let middle = |k: usize| c.top + ROW * (k as f64 + 0.5);
    if low < 0.0 && high > 0.0 {
        let bottom = c.top + ROW * table.rows.len() as f64;
        g = g.add(guide(line((x(0.0), c.top), (x(0.0), bottom), LINE, 1.0).set("stroke-dasharray", "2 4")));
    }
    let ink = colour(Some(0), 1.0);
    for (k, change) in table.changes.iter().enumerate() {
        let (Some(a), Some(b), Some(step)) = (sizes[k], sizes[k + 1], change.step) else { continue };
        let y = c.top + ROW * (k + 1) as f64;
        let mut own = Group::new();
        for (from, to) in [((x(a), middle(k)), (x(a), y)), ((x(a), y), (x(b), y)), ((x(b), y), (x(b), middle(k + 1)))] {
            own = own.add(line(from, to, &ink, 2.2).set("stroke-linecap", "square"));
        }
        own = own.add(text(x(a.max(b)) + 7.0, y + 4.0, 11.0, Anchor::Start, &decimals(step)));
        g = g.add(of(own, "step", &[Of::State(&table.rows[k].state)]));
    }
    for (k, size) in sizes.iter().enumerate() {
        let Some(size) = size else { continue };
        let backward = table.rows[k].ratio.is_some_and(|i| i < 0.0);
        let dot = Circle::new().set("cx", number(x(*size))).set("cy", number(middle(k))).set("r", 4.6);
        let dot = match backward {
            true => dot.set("fill", PAPER).set("stroke", ink.as_str()).set("stroke-width", 1.8),
            false => dot.set("fill", ink.as_str()),
        };
        g = g.add(of(dot, "ratio", &[Of::State(&table.rows[k].state), Of::Quantity("ratio")]));
    }
    g
}

/// What opens and what closes.
fn exchange(change: &ShiftChange) -> String {
    match (&change.opens[..], &change.closes[..]) {
        ([], []) => "none".to_owned(),
        ([], closes) => format!("+ {}", closes.join(", ")),
        (opens, []) => format!("− {}", opens.join(", ")),
        (opens, closes) => format!("{} → {}", opens.join(", "), closes.join(", ")),
    }
}

fn changes(c: &Columns, change: &ShiftChange, y: f64) -> Group {
    let x = c.changes;
    // A bracket from row to row, heavy where several elements change at once.
    let (ink, weight) = if change.several { (colour(Some(1), 1.0), 3.0) } else { (LINE.to_owned(), 1.2) };
    let half = ROW / 2.0 - 5.0;
    let mut g = Group::new();
    for (from, to) in [
        ((x, y - half), (x + 8.0, y - half)),
        ((x + 8.0, y - half), (x + 8.0, y + half)),
        ((x + 8.0, y + half), (x, y + half)),
    ] {
        g = g.add(line(from, to, &ink, weight));
    }
    let words = fit(&exchange(change), (c.width - MARGIN - x - 20.0) / BOLD, 12.0);
    let mut label = text(x + 22.0, y + 4.0, 12.0, Anchor::Start, &words);
    if change.several {
        label = label.set("font-weight", "bold");
    }
    g.add(label)
}

fn caption(table: &ShiftTable) -> String {
    let dots = "A dot: the shift element is closed.";
    match table.rows.iter().find_map(|r| r.path.as_ref()).filter(|_| table.one_path) {
        Some([input, output]) => format!("{dots} Ratio ω {input} / ω {output}, on a logarithmic scale."),
        None => format!("{dots} Ratio ω in / ω out, on a logarithmic scale."),
    }
}

fn foot(table: &ShiftTable) -> Vec<String> {
    let mut all = Vec::new();
    if let Some(s) = &table.spread {
        all.push(format!("Total spread {}, from {} to {}.", decimals(s.value), s.largest, s.smallest));
    }
    let mut key = "Change X → Y: X opens, Y closes.".to_owned();
    let mut several = table.changes.iter().enumerate().filter(|(k, c)| c.several && !turns(table, *k));
    if several.next().is_some() {
        key.push_str(" Bold: more than one element opens or closes.");
    }
    if table.rows.iter().any(|r| r.ratio.is_some_and(|i| i < 0.0)) {
        key.push_str(" Open circle: the output turns backward.");
    }
    all.push(key);
    all
}

fn words(table: &ShiftTable) -> String {
    let rows = table.rows.iter().map(|r| {
        let closed: Vec<&str> =
            table.elements.iter().zip(&r.closed).filter(|(_, c)| **c).map(|(e, _)| e.name.as_str()).collect();
        let ratio = r.ratio.map_or_else(|| "no ratio".to_owned(), |i| format!("ratio {}", decimals(i)));
        format!("{}: {ratio}, closed {}", r.state, if closed.is_empty() { "none".to_owned() } else { closed.join(" ") })
    });
    let spread = table.spread.as_ref().map_or(String::new(), |s| format!(" Spread {}.", decimals(s.value)));
    format!("{} states. {}.{spread}", table.rows.len(), rows.collect::<Vec<_>>().join("; "))
}

/// With three decimals, where that says enough.
fn decimals(x: f64) -> String {
    if !(0.1..1e4).contains(&x.abs()) {
        return digits(x);
    }
    format!("{x:.3}").replace('-', "−")
}

fn percent(x: f64) -> String {
    format!("{:.1} %", 100.0 * x)
}
