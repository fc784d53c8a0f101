//! Power flows as a hypergraph: components, contacts, and lines as wide as their power.
//!
//! The layout is layered, inputs at the left. Lines bend only in the gaps between columns, where
//! their labels stand too, so that they never cross a node.

mod layout;
mod marks;
mod words;

use svg::node::element::Group;
use willis::analysis::Verdict;
use willis::hypergraph::{FlowReport, Hypergraph, NodeKind};

use crate::parts::alive::guide;
use crate::parts::style::{Anchor, BOLD, FAINT, LINE, fit, line, lines, number, page, text, watts, wide};
use layout::Drawing;
use marks::{Round, ground, shape, stroke};
use words::{SMALL, percent};

const MARGIN: f64 = 28.0;
/// Narrowest page.
const NARROWEST: f64 = 750.0;
/// The power flows of a train: one figure for each equilibrium, below each other.
///
/// Solid circles are components, hollow circles bearings, hollow triangles tooth contacts, hollow
/// squares seals, diamonds gears and rotors in their fluid, double bars clutches and brakes. The
/// width of a line is in proportion to the power. What leans on the frame bears a ground mark.
/// Power that runs in a circle is orange and broken.
///
/// # Example
/// ```
/// use willis::train::{OperationSpec, SetSpec, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .operation(
///         OperationSpec::new("full load")
///             .speed("s", AngularSpeed::rpm(1000.0))
///             .torque("s", Torque::n_m(10.0)),
///     )
///     .build()?;
/// let figure = willis_figure::draw_flow(&willis::hypergraph::flows(&train, &Default::default())?);
/// assert!(figure.starts_with("<svg"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(all: &FlowReport) -> String {
    let mut panels: Vec<(String, Vec<String>, Option<Drawing>)> = Vec::new();
    for o in &all.operations {
        let count = o.solutions.len();
        let state = o.state.as_ref().map(|s| format!(", state {s}")).unwrap_or_default();
        let title = format!("{}{state}", o.name);
        for (k, g) in o.solutions.iter().enumerate() {
            let number = if count > 1 { format!(", solution {} of {count}", k + 1) } else { String::new() };
            let title = format!("{title}{number}");
            let drawing = Drawing::new(g, &title);
            panels.push((title, caption(g), Some(drawing)));
        }
        for (k, g) in o.dissipative_solutions.iter().enumerate() {
            let mut words = vec!["Locked: this is what it would take if every loaded member pushed.".to_owned()];
            words.extend(caption(g));
            panels.push((title.clone(), words, Some(Drawing::new(g, &format!("{title}, locked {}", k + 1)))));
        }
        if count == 0 && o.dissipative_solutions.is_empty() {
            let word = if o.verdict == Verdict::Locked { "The train is locked" } else { "Not determined" };
            let why = o.reason.clone().map_or(String::new(), |r| format!(": {r}"));
            panels.push((title, vec![format!("{word}, no power flows{why}.")], None));
        }
    }
    let widest = panels.iter().filter_map(|p| p.2.as_ref()).fold(0.0f64, |a, d| a.max(d.width));
    let width = (widest + 2.0 * MARGIN).max(NARROWEST).ceil();
    let mut body = Group::new().add(
        text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&all.train, (width - 2.0 * MARGIN) / BOLD, 20.0))
            .set("font-weight", "bold"),
    );
    let about = "Power flow: components, the contacts between them, and the power that passes each";
    body = body.add(text(MARGIN, 60.0, 13.0, Anchor::Start, about).set("fill", FAINT));
    let mut y = 68.0;
    let mut words = Vec::new();
    let mut kinds: Vec<NodeKind> = Vec::new();
    let (mut round, mut within, mut ground, mut rest) = (false, false, false, false);
    for (title, caption, drawing) in &panels {
        y += 24.0;
        body = body.add(
            text(MARGIN, y, 14.0, Anchor::Start, &fit(title, (width - 2.0 * MARGIN) / BOLD, 14.0))
                .set("font-weight", "bold"),
        );
        for sentence in caption {
            for l in lines(sentence, width - 2.0 * MARGIN, 12.0) {
                y += 17.0;
                body = body.add(text(MARGIN, y, 12.0, Anchor::Start, &l).set("fill", FAINT));
            }
        }
        words.push(format!("{title}. {}", caption.join(" ")));
        y += 14.0;
        if let Some(d) = drawing {
            let x = (width - d.width) / 2.0;
            let at = format!("translate({} {})", number(x), number(y));
            body = body.add(d.group.clone().set("transform", at));
            y += d.height;
            kinds.extend(&d.kinds);
            round |= d.round;
            within |= d.within;
            ground |= d.ground;
            rest |= d.rest;
        }
        y += 18.0;
    }
    kinds.sort_unstable();
    kinds.dedup();
    let (key, height) = legend(&kinds, [round, within, ground, rest], y, width);
    page(width, height, &format!("Power flow of {}", all.train), &words.join(" ")).add(body).add(key).to_string()
}

/// Every equilibrium with its title.
pub fn graphs(all: &FlowReport) -> Vec<(String, &Hypergraph)> {
    let mut list = Vec::new();
    for o in &all.operations {
        let both = o.solutions.len() + o.dissipative_solutions.len();
        for (k, g) in o.solutions.iter().chain(&o.dissipative_solutions).enumerate() {
            let title = match both {
                1 => o.name.clone(),
                _ => format!("{}, solution {} of {both}", o.name, k + 1),
            };
            list.push((title, g));
        }
    }
    list
}

fn caption(g: &Hypergraph) -> Vec<String> {
    let efficiency = match g.efficiency {
        Some(e) if g.output_power_w > 0.0 => format!("η {}", percent(e)),
        Some(_) => "No power leaves, all of it is lost".to_owned(),
        None => "No power enters".to_owned(),
    };
    let power = format!(
        "{efficiency}: in {}, out {}, lost {}.",
        watts(g.input_power_w),
        watts(g.output_power_w),
        watts(g.loss_w)
    );
    let sentence = |t: String| {
        let mut letters = t.chars();
        letters.next().map_or(String::new(), |c| c.to_uppercase().chain(letters).collect::<String>()) + "."
    };
    std::iter::once(power).chain(g.recirculation().into_iter().map(sentence)).collect()
}

/// What the symbols mean, in rows; and the height of the page.
fn legend(kinds: &[NodeKind], [round, within, ground_marks, rest]: [bool; 4], top: f64, width: f64) -> (Group, f64) {
    let mut entries: Vec<(Group, &str)> = Vec::new();
    let words = |k: NodeKind| match k {
        NodeKind::Member => "component",
        NodeKind::Teeth => "tooth contact",
        NodeKind::Bearing => "bearing",
        NodeKind::Seal => "seal",
        NodeKind::Gear => "gear in oil or air",
        NodeKind::Rotor => "rotor in oil or air",
        NodeKind::Drag => "given drag",
        NodeKind::OpenElement => "open clutch or brake",
        NodeKind::Pump => "oil pump",
        NodeKind::ShiftElement => "clutch or brake",
        NodeKind::Coupling => "coupled for good",
        NodeKind::Variator => "variator",
        NodeKind::Input => "input, output",
        _ => "",
    };
    for &k in kinds.iter().filter(|k| **k != NodeKind::Output) {
        entries.push((shape(k, 11.0, 0.0), words(k)));
    }
    let sample = |round: Round| stroke("M0 0 H22", round, 5.0);
    if !kinds.is_empty() {
        entries.push((sample(Round::No), "power, the wider the more"));
    }
    if round {
        entries.push((sample(Round::Between), "runs in a circle"));
    }
    if within {
        entries.push((sample(Round::Within), "runs in a circle within one set"));
    }
    if rest {
        let dashed = line((0.0, 0.0), (22.0, 0.0), LINE, 1.0).set("stroke-dasharray", "3 3");
        entries.push((Group::new().add(dashed), "torque without power"));
    }
    if ground_marks {
        entries.push((ground(11.0, -11.0), "leans on the frame"));
    }
    if !kinds.is_empty() {
        entries.push((
            Group::new().add(text(11.0, 4.0, 12.0, Anchor::Middle, "−")),
            "loss; η: outgoing over incoming power",
        ));
    }
    let mut g = guide(Group::new());
    let (mut x, mut y) = (MARGIN, top + 14.0);
    for (mark, words) in entries {
        let room = 30.0 + wide(words, SMALL) + 18.0;
        if x + room > width - MARGIN && x > MARGIN {
            x = MARGIN;
            y += 24.0;
        }
        let at = format!("translate({} {})", number(x), number(y));
        g = g.add(
            Group::new()
                .set("transform", at)
                .add(mark)
                .add(text(30.0, 4.0, SMALL, Anchor::Start, words).set("fill", FAINT)),
        );
        x += room;
    }
    (g, (y + 24.0).ceil())
}
