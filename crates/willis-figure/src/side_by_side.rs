//! Trains side by side: a stick diagram each, a table under it.

use svg::node::element::Group;
use willis::Diagnostics;
use willis::train::Train;

use crate::parts::alive::guide;
use crate::parts::style::{Anchor, BOLD, FAINT, LINE, fit, line, lines, page, text};
use crate::stick::draw::scheme_of;
use crate::{Columns, Lever, LeverRequest, lever, stick};

/// Margin of the sheet and gap between panels.
const MARGIN: f64 = 28.0;
const GAP: f64 = 24.0;
/// A panel is as wide; a stick diagram that needs more is made smaller.
const PANEL: f64 = 400.0;
const STICK: f64 = 240.0;
const ROW: f64 = 19.0;
/// Panels in a row of the sheet.
const ACROSS: usize = 3;

/// A train with what is to be said of it.
#[derive(Clone, Debug)]
pub struct SidePanel {
    /// What it is called.
    pub title: String,
    /// A line under it.
    pub subtitle: String,
    /// The train.
    pub train: Train,
    /// Heads of the columns of its table.
    pub head: Vec<String>,
    /// The rows of its table, with a cell for each column.
    pub rows: Vec<Vec<String>>,
}

/// Stick diagrams of trains side by side, each with its table.
///
/// # Errors
/// A train that cannot be drawn.
///
/// # Example
/// ```
/// use willis_figure::{SidePanel, draw_side_by_side};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c"))
///     .build()?;
/// let panel = SidePanel {
///     title: "first".into(),
///     subtitle: String::new(),
///     train,
///     head: vec!["gear".into(), "ratio".into()],
///     rows: vec![vec!["1".into(), "3.333".into()]],
/// };
/// let picture = draw_side_by_side("Two trains", "the same twice", &[panel.clone(), panel])?;
/// assert!(picture.starts_with("<svg") && picture.contains("3.333"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw_side_by_side(title: &str, subtitle: &str, panels: &[SidePanel]) -> Result<String, Diagnostics> {
    let across = panels.len().clamp(1, ACROSS);
    let width = 2.0 * MARGIN + across as f64 * PANEL + (across - 1) as f64 * GAP;
    let mut body = Group::new().add(
        text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(title, (width - 2.0 * MARGIN) / BOLD, 20.0))
            .set("font-weight", "bold"),
    );
    let mut top = 62.0;
    for l in lines(subtitle, width - 2.0 * MARGIN, 13.0) {
        body = body.add(text(MARGIN, top, 13.0, Anchor::Start, &l).set("fill", FAINT));
        top += 18.0;
    }
    for row in panels.chunks(ACROSS) {
        let mut lowest = top;
        for (k, panel) in row.iter().enumerate() {
            let left = MARGIN + k as f64 * (PANEL + GAP);
            let (drawn, bottom) = draw(panel, left, top + 18.0)?;
            body = body.add(drawn);
            lowest = lowest.max(bottom);
        }
        top = lowest + 12.0;
    }
    let words: Vec<String> = panels.iter().map(words).collect();
    Ok(page(width, top + 12.0, title, &words.join("; ")).add(body).to_string() + "\n")
}

/// A panel in words.
fn words(panel: &SidePanel) -> String {
    let rows: Vec<String> = panel.rows.iter().map(|row| row.join(" ")).collect();
    format!("{}: {}", panel.title, rows.join(", "))
}

/// Levers give the sets their places across a panel: those of the first state that has any.
fn any_lever(train: &Train) -> Result<Lever, Diagnostics> {
    let states = train.states().iter().map(|state| LeverRequest::State(state.name.clone()));
    let first = lever(train, &LeverRequest::First);
    match first {
        Ok(levers) => Ok(levers),
        Err(why) => states.into_iter().find_map(|request| lever(train, &request).ok()).ok_or(why),
    }
}

/// A panel, and where it ends.
fn draw(panel: &SidePanel, left: f64, top: f64) -> Result<(Group, f64), Diagnostics> {
    let mut g = Group::new()
        .add(text(left, top, 15.0, Anchor::Start, &fit(&panel.title, PANEL / BOLD, 15.0)).set("font-weight", "bold"));
    let mut y = top + 17.0;
    for l in lines(&panel.subtitle, PANEL, 12.0) {
        g = g.add(text(left, y, 12.0, Anchor::Start, &l).set("fill", FAINT));
        y += 16.0;
    }
    let data = stick(&panel.train, None)?;
    let levers = any_lever(&panel.train)?;
    let columns = Columns::new(&data, &levers, PANEL);
    let (scheme, [width, height]) = scheme_of(&data, &columns, STICK);
    let scale = (PANEL / width).min(1.0);
    let (x, room) = (left + (PANEL - width * scale) / 2.0, height * scale);
    let place = format!("translate({x:.1} {:.1}) scale({scale:.4})", y + 4.0);
    g = g.add(Group::new().set("transform", place).add(scheme));
    // The names of the sets stand below the schematic.
    y += room.max(STICK * scale) + 54.0;
    let column = |k: usize| left + PANEL * (k as f64 + 0.5) / panel.head.len().max(1) as f64;
    for (k, head) in panel.head.iter().enumerate() {
        g = g.add(text(column(k), y, 12.0, Anchor::Middle, head).set("fill", FAINT));
    }
    g = g.add(guide(line((left, y + 6.0), (left + PANEL, y + 6.0), LINE, 1.0)));
    for row in &panel.rows {
        y += ROW;
        for (k, cell) in row.iter().enumerate() {
            g = g.add(text(column(k), y + 2.0, 12.0, Anchor::Middle, cell));
        }
    }
    Ok((g, y + 10.0))
}
