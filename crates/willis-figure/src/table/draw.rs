//! The table of speeds and torques: a column a state, a row a shaft, under every number a bar as long as it says.

use svg::node::element::{Circle, Group};
use willis::analysis::{AtLoad, ShaftElement, ShaftState, ShaftTable};
use willis::exact::Rational;
use willis::train::ShiftElementKind;

use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, colour, figures, fit, line, lines, number, page, rectangle, text, titled, wide,
};

const MARGIN: f64 = 28.0;
const ROW: f64 = 22.0;
/// From the last row of a section to the first of the next.
const HEAD: f64 = 40.0;
const NAMES: (f64, f64) = (90.0, 230.0);
const COLUMN: (f64, f64) = (62.0, 150.0);
/// States beside each other; more stand below.
const BESIDE: usize = 16;
const BAND: &str = "#f6f6f6";
/// What is not determined.
const UNKNOWN: &str = "–";
/// What carries no torque, or rests.
const NOTHING: &str = "0";
/// Torques below this part of the input's are round-off.
const ROUND_OFF: f64 = 5e-12;

/// What a cell says.
enum Cell {
    /// A number with its words.
    Number(f64),
    /// The element is closed.
    Closed,
    /// Not determined.
    Unknown,
    /// Words in its place.
    Words(String),
}

/// What a row is about, and its name.
type About = (for<'n> fn(&'n str) -> Of<'n>, String);

/// A row: what it is about, and a cell for each state.
struct Row {
    name: String,
    /// What its cells stand for, beside the state.
    about: About,
    cells: Vec<Cell>,
}

/// Rows of one quantity, with one scale of bars and one number of decimals.
struct Section {
    head: String,
    /// Whether a bar stands under each number.
    bars: bool,
    rows: Vec<Row>,
}

/// Speeds of all shafts, slips of open shift elements and torques in all states, over speed and torque of the input.
///
/// # Example
/// ```
/// use willis::analysis::{ShaftTableRequest, shaft_table};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.98))
///     .build()?;
/// let picture = willis_figure::draw_table(&shaft_table(&train, &ShaftTableRequest::default())?);
/// assert!(picture.contains(r#"data-member="carrier""#) && picture.contains("0.300"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(table: &ShaftTable) -> String {
    let all = &table.states.0;
    // Blocks of states as even as can be.
    let blocks = all.len().div_ceil(BESIDE).max(1);
    let beside = all.len().div_ceil(blocks).max(1);
    let blocks: Vec<&[(String, ShaftState)]> = all.chunks(beside).collect();
    let sections: Vec<Vec<Section>> = blocks.iter().map(|b| sections(table, b)).collect();

    let longest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, f64::max);
    let names = longest(&mut sections.iter().flatten().flat_map(|s| &s.rows).map(|r| wide(&r.name, 12.0)));
    let names = names.clamp(NAMES.0, NAMES.1) + 14.0;
    let cells = sections.iter().flatten().flat_map(|s| s.rows.iter().flat_map(|r| &r.cells).map(|c| room(s, c)));
    let heads = all.iter().map(|(name, _)| wide(name, 13.0) * BOLD);
    let column = longest(&mut cells.chain(heads)).clamp(COLUMN.0 - 12.0, COLUMN.1) + 12.0;
    let content = names + column * beside.min(all.len()) as f64;
    let title = (wide(&table.train, 20.0) * BOLD).min(900.0);
    let width = content.max(title).max(440.0) + 2.0 * MARGIN;
    let inner = width - 2.0 * MARGIN;

    let mut g = Group::new();
    let mut y = 60.0;
    for words in lines(&caption(table), inner, 13.0) {
        g = g.add(text(MARGIN, y, 13.0, Anchor::Start, &words).set("fill", FAINT));
        y += 18.0;
    }
    for (block, sections) in blocks.iter().zip(&sections) {
        let x = |k: usize| MARGIN + names + column * k as f64;
        let right = x(block.len());
        y += 22.0;
        g = g.add(text(MARGIN, y, 12.0, Anchor::Start, "state").set("font-weight", "bold"));
        for (k, (name, _)) in block.iter().enumerate() {
            let head = text(x(k + 1) - 6.0, y, 13.0, Anchor::End, &fit(name, (column - 8.0) / BOLD, 13.0));
            g = g.add(titled(of(head.set("font-weight", "bold"), "head", &[Of::State(name)]), name));
        }
        y += 8.0;
        g = g.add(guide(line((MARGIN - 8.0, y), (right, y), INK, 1.2)));
        for (nth, s) in sections.iter().enumerate() {
            if !s.head.is_empty() {
                y += HEAD - ROW + 4.0;
                let own = lines(&s.head, inner / BOLD, 12.0);
                for (k, words) in own.iter().enumerate() {
                    y += if k > 0 { 15.0 } else { 0.0 };
                    g = g.add(text(MARGIN, y, 12.0, Anchor::Start, words).set("font-weight", "bold"));
                }
                y += 6.0;
                g = g.add(guide(line((MARGIN - 8.0, y), (right, y), LINE, 1.0)));
            }
            let most =
                s.rows.iter().flat_map(|r| &r.cells).filter_map(Cell::number).fold(0.0, |a: f64, x| a.max(x.abs()));
            for (line_of, row) in s.rows.iter().enumerate() {
                if line_of % 2 == 0 {
                    g = g.add(guide(rectangle(MARGIN - 8.0, y, right - MARGIN + 8.0, ROW, BAND)));
                }
                let name = text(MARGIN, y + 15.0, 12.0, Anchor::Start, &fit(&row.name, names - 10.0, 12.0));
                g = g.add(titled(name, &row.name));
                // The same shaft has a row in several sections.
                let word = format!("cell{nth}-{line_of}");
                for (k, cell) in row.cells.iter().enumerate() {
                    let own = drawn(s, cell, [x(k), x(k + 1)], y, most);
                    g = g.add(of(own, &word, &[(row.about.0)(&row.about.1), Of::State(&block[k].0)]));
                }
                y += ROW;
            }
        }
        y += 4.0;
        for (name, s) in block.iter() {
            for words in s.reason.iter().flat_map(|why| lines(&format!("{name}: {why}."), inner, 12.0)) {
                y += 17.0;
                g = g.add(text(MARGIN, y, 12.0, Anchor::Start, &words));
            }
        }
    }
    page(width, y + 24.0, &format!("Speeds and torques of {}", table.train), &words(table))
        .add(text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&table.train, inner / BOLD, 20.0)).set("font-weight", "bold"))
        .add(g)
        .to_string()
}

impl Cell {
    fn number(&self) -> Option<f64> {
        match self {
            Self::Number(x) => Some(*x),
            _ => None,
        }
    }

    fn exact(x: Option<&Rational>) -> Self {
        x.map_or(Self::Unknown, |x| Self::Number(x.to_f64()))
    }

    fn torque(x: Option<f64>) -> Self {
        x.map_or(Self::Unknown, |x| Self::Number(if x.abs() < ROUND_OFF { 0.0 } else { x }))
    }
}

/// How a number of a section is written: its columns line up where nothing is very small.
fn written(s: &Section, x: f64) -> String {
    if x == 0.0 {
        return NOTHING.to_owned();
    }
    let sizes = || s.rows.iter().flat_map(|r| &r.cells).filter_map(Cell::number).map(f64::abs).filter(|x| *x > 0.0);
    let (least, most) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    match least >= 0.01 && most < 1e4 {
        true => format!("{x:.3}").replace('-', "−"),
        false => figures(x, 4),
    }
}

/// The width that a cell takes.
fn room(s: &Section, cell: &Cell) -> f64 {
    match cell {
        Cell::Number(x) => wide(&written(s, *x), 11.0),
        Cell::Words(words) => wide(words, 11.0),
        Cell::Closed | Cell::Unknown => 12.0,
    }
}

fn drawn(s: &Section, cell: &Cell, [left, right]: [f64; 2], y: f64, most: f64) -> Group {
    let g = Group::new();
    let end = right - 6.0;
    match cell {
        Cell::Unknown => g.add(text(end, y + 14.0, 11.0, Anchor::End, UNKNOWN).set("fill", FAINT)),
        Cell::Words(words) => {
            let shown = fit(words, right - left - 8.0, 11.0);
            g.add(titled(text(end, y + 14.0, 11.0, Anchor::End, &shown).set("fill", FAINT), words))
        }
        Cell::Closed => {
            let dot = Circle::new().set("cx", number(end - 6.0)).set("cy", number(y + ROW / 2.0)).set("r", 4.5);
            g.add(dot.set("fill", INK))
        }
        Cell::Number(x) => {
            let label = text(end, y + 13.5, 11.0, Anchor::End, &written(s, *x));
            let g = g.add(if *x == 0.0 { label.set("fill", FAINT) } else { label });
            let half = (right - left - 12.0) / 2.0;
            let length = if most > 0.0 { x.abs() / most * half } else { 0.0 };
            if !s.bars || length < 0.4 {
                return g;
            }
            // From the middle of the cell: to the right where it turns or drives as the input does.
            let middle = end - half;
            let from = if *x < 0.0 { middle - length } else { middle };
            let fill = colour(Some(usize::from(*x < 0.0)), 0.7);
            g.add(rectangle(from, y + ROW - 5.0, length, 2.6, &fill))
        }
    }
}

/// Names in the order in which the states have them.
fn names(states: &[(String, ShaftState)], of: impl Fn(&ShaftState) -> Vec<String>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in states.iter().flat_map(|(_, s)| of(s)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn sections(table: &ShaftTable, states: &[(String, ShaftState)]) -> Vec<Section> {
    let row = |name: String, about: About, cell: &dyn Fn(&ShaftState) -> Cell| Row {
        cells: states.iter().map(|(_, s)| cell(s)).collect(),
        name,
        about,
    };
    let quantity = |name: &str, cell: &dyn Fn(&ShaftState) -> Cell| {
        row(name.to_owned(), (|n| Of::Quantity(n), name.to_owned()), cell)
    };
    let mut first = vec![
        quantity("ratio", &|s| Cell::exact(s.ratio.as_ref())),
        quantity("exact ratio", &|s| {
            s.ratio
                .as_ref()
                .map_or(Cell::Unknown, |r| Cell::Words(r.to_fraction().trim_end_matches("/1").replace('-', "−")))
        }),
        quantity("efficiency of the teeth, %", &|s| s.efficiency.map_or(Cell::Unknown, |e| Cell::Words(percent(e)))),
    ];
    if ends(table).is_none() {
        first.push(quantity("input", &|s| Cell::Words(s.input.clone())));
        first.push(quantity("output", &|s| Cell::Words(s.output.clone())));
    }
    let mut all = vec![Section { head: String::new(), bars: false, rows: first }];
    all.extend(losses(states));

    let of_kind = |planet: bool| {
        names(states, |s| {
            let own = s.members.iter().filter(|(_, m)| m.carrier.is_some() == planet);
            own.map(|(name, _)| name.to_owned()).collect()
        })
    };
    let member = |name: &String| -> About { (|n| Of::Member(n), name.clone()) };
    let elements = names(states, |s| s.shift_elements.iter().map(|(name, _)| name.to_owned()).collect());
    let element = |name: &String| -> About { (|n| Of::Element(n), name.clone()) };
    // What it is stands behind the name.
    let called = |name: &String| {
        let kind = states.iter().find_map(|(_, s)| s.shift_elements.get(name)).map_or("", |e| match e.kind {
            ShiftElementKind::Clutch => "clutch",
            ShiftElementKind::Brake => "brake",
            ShiftElementKind::OneWay => "one-way clutch",
        });
        format!("{name}, {kind}")
    };
    all.push(Section {
        head: "Speeds, over that of the input".into(),
        bars: true,
        rows: of_kind(false)
            .iter()
            .map(|n| row(n.clone(), member(n), &|s| Cell::exact(s.members.get(n).and_then(|m| m.speed.as_ref()))))
            .collect(),
    });
    all.push(Section {
        head: "Planets relative to their carriers, over the speed of the input".into(),
        bars: true,
        rows: of_kind(true)
            .iter()
            .map(|n| {
                row(n.clone(), member(n), &|s| Cell::exact(s.members.get(n).and_then(|m| m.relative_speed.as_ref())))
            })
            .collect(),
    });
    let slip = |e: &ShaftElement| if e.engaged { Cell::Closed } else { Cell::exact(e.slip.as_ref()) };
    all.push(Section {
        head: "Shift elements: a dot where closed, else the slip, over the speed of the input".into(),
        bars: true,
        rows: elements
            .iter()
            .map(|n| row(called(n), element(n), &|s| s.shift_elements.get(n).map_or(Cell::Unknown, slip)))
            .collect(),
    });
    let outside = names(states, |s| vec![s.input.clone(), s.output.clone()]);
    let torques =
        outside.iter().map(|n| row(n.clone(), member(n), &|s| Cell::torque(s.members.get(n).and_then(|m| m.torque))));
    let reactions = elements
        .iter()
        .map(|n| row(called(n), element(n), &|s| Cell::torque(s.shift_elements.get(n).and_then(|e| e.torque))));
    all.push(Section {
        head: "Torques from outside and of shift elements, over that of the input".into(),
        bars: true,
        rows: torques.chain(reactions).collect(),
    });
    let mut of_sets: Vec<[String; 2]> = Vec::new();
    for (set, members) in states.iter().flat_map(|(_, s)| s.sets.iter()) {
        for (name, _) in members.iter() {
            let own = [set.to_owned(), name.to_owned()];
            if !of_sets.contains(&own) {
                of_sets.push(own);
            }
        }
    }
    all.push(Section {
        head: "Torques that shafts put into sets, over that of the input".into(),
        bars: true,
        rows: of_sets
            .iter()
            .map(|[set, name]| {
                row(format!("{set}: {name}"), member(name), &|s| {
                    let found = s.sets.iter().find(|(own, _)| own == set).and_then(|(_, all)| all.get(name).copied());
                    // A set that is left out of a state with torques carries none.
                    Cell::torque(found.or(s.efficiency.map(|_| 0.0)))
                })
            })
            .collect(),
    });
    all.retain(|s| !s.rows.is_empty());
    all
}

/// Losses at a load and without one, where they depend on that.
fn losses(states: &[(String, ShaftState)]) -> Vec<Section> {
    let at = |s: &ShaftState| s.at_load.as_deref().cloned();
    let Some(first) = states.iter().find_map(|(_, s)| at(s)) else { return vec![] };
    let same =
        |s: &ShaftState| at(s).is_none_or(|a| (a.speed_rad_s, a.torque_n_m) == (first.speed_rad_s, first.torque_n_m));
    let point = match states.iter().all(|(_, s)| same(s)) {
        true => first.point(|x| figures(x, 4), |operation| format!("“{operation}”")),
        false => "the load of each input in the file".to_owned(),
    };
    let row = |name: &str, cell: &dyn Fn(&AtLoad) -> Cell| Row {
        cells: states.iter().map(|(_, s)| at(s).map_or(Cell::Unknown, |a| cell(&a))).collect(),
        name: name.to_owned(),
        about: (|n| Of::Quantity(n), name.to_owned()),
    };
    let watts = |w: Option<f64>| w.map_or(Cell::Unknown, |w| Cell::Words(figures(w, 4)));
    let mut rows = vec![
        row("efficiency at load, %", &|a| {
            let mark = if a.warnings.is_empty() { "" } else { " *" };
            a.efficiency.map_or(Cell::Unknown, |e| Cell::Words(percent(e) + mark))
        }),
        row("loss at load, W", &|a| watts(a.loss_w)),
        row("spin loss, W", &|a| watts(a.spin_loss_w)),
    ];
    if states.iter().any(|(_, s)| at(s).is_some_and(|a| a.temperature_k.is_some())) {
        let more = |a: &AtLoad| if a.beyond_limit { "> " } else { "" };
        let celsius = |a: &AtLoad| a.temperature_k.map(|t| Cell::Words(format!("{}{:.0}", more(a), t - 273.15)));
        rows.push(row("oil, °C", &|a| celsius(a).unwrap_or(Cell::Unknown)));
    }
    vec![Section { head: format!("Losses at {point}; spin loss: nothing at the output"), bars: false, rows }]
}

/// Input and output, where they are the same in all states.
fn ends(table: &ShaftTable) -> Option<[&str; 2]> {
    let mut all = table.states.iter().map(|(_, s)| [s.input.as_str(), s.output.as_str()]);
    let first = all.next()?;
    all.all(|e| e == first).then_some(first)
}

/// Two decimals, three where less than a thousandth is lost.
fn percent(efficiency: f64) -> String {
    let x = 100.0 * efficiency;
    if x > 99.9 && x < 100.0 { format!("{x:.3}") } else { format!("{x:.2}") }
}

fn caption(table: &ShaftTable) -> String {
    let path = ends(table).map_or(String::new(), |[from, to]| format!("From {from} to {to}. "));
    let losses = match table.lossless {
        true => "without losses",
        false => "with the losses of the teeth",
    };
    let warned = table.states.iter().any(|(_, s)| s.at_load.as_ref().is_some_and(|a| !a.warnings.is_empty()));
    let mark = if warned { " * With a warning, which the table of losses names." } else { "" };
    format!("{path}The input drives, {losses}. Bars to the left are negative; {UNKNOWN} is not determined.{mark}")
}

fn words(table: &ShaftTable) -> String {
    let states = table.states.iter().map(|(name, s)| {
        let ratio = s.ratio.as_ref().map_or("no ratio".to_owned(), |r| format!("ratio {}", figures(r.to_f64(), 4)));
        let speeds = s.members.iter().filter(|(_, m)| m.carrier.is_none());
        let speeds = speeds.filter_map(|(n, m)| m.speed.as_ref().map(|w| format!("{n} {}", figures(w.to_f64(), 4))));
        format!("{name}: {ratio}; {}.", speeds.collect::<Vec<_>>().join(", "))
    });
    format!("{} {}", caption(table), states.collect::<Vec<_>>().join(" "))
}
