//! What moves the losses of an operating point most, as bars about a middle line.

use svg::node::element::Group;
use willis::units;

use crate::parts::alive::{Of, guide, told};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, digits, fit, halo, line, lines, number, page, rectangle, text,
    ticks, watts, wide,
};
use crate::parts::words::spelled;
use crate::{Drawing, Tornado, TornadoBar};

const MARGIN: f64 = 28.0;
const ROW: f64 = 30.0;
/// The longest bar, and the least room for it.
const HALF: [f64; 2] = [200.0, 70.0];
const EFFECT: f64 = 130.0;
const TOP: f64 = 122.0;

/// The quantities that move the loss of an operating point most: a dark bar is the step up, its
/// light mirror the step down.
///
/// # Example
/// ```
/// use willis::Selection;
/// use willis_figure::tornado;
/// use willis::study::sensitivity;
/// use willis::train::{OperationSpec, SetSpec, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
///     .operation(
///         OperationSpec::new("rated")
///             .speed("sun", AngularSpeed::rpm(1000.0))
///             .torque("sun", Torque::n_m(100.0)),
///     )
///     .build()?;
/// let all = sensitivity(&train, &Selection::default())?;
/// assert!(willis_figure::draw_tornado(&tornado(&all, None, 10)?).starts_with("<svg"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(t: &Tornado) -> String {
    draw_on(t, Drawing::default())
}

pub(super) fn draw_on(t: &Tornado, paper: Drawing) -> String {
    let longest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, f64::max);
    let names = longest(&mut t.bars.iter().map(|b| wide(&name(b), 12.0) * BOLD))
        .clamp(110.0, (0.3 * paper.page(1000.0, 440.0)).min(290.0));
    let values = longest(&mut t.bars.iter().map(|b| wide(&value(b), 11.0).max(wide(b.step.label(), 11.0)))).max(60.0);
    // The change stands at the end of the bar, on both sides.
    let room = longest(&mut t.bars.iter().map(|b| wide(&signed(b.loss_change_w), 11.0))) + 10.0;
    let columns = [MARGIN, MARGIN + names + 12.0, MARGIN + names + values + 24.0];
    let left = columns[2] + wide("+0.1 mm", 11.0) + room;
    let beside = left + room + EFFECT + MARGIN;
    let half = (paper.page(beside + 2.0 * HALF[0], beside + 2.0 * HALF[1]) - beside) / 2.0;
    let middle = left + half;
    let right = middle + half + room;
    // A long title may widen the page somewhat.
    let width =
        (right + EFFECT + MARGIN).max((wide(&t.title, 20.0) * BOLD + 2.0 * MARGIN).min(paper.page(1200.0, 0.0)));
    let bottom = TOP + ROW * t.bars.len() as f64;

    let inner = width - 2.0 * MARGIN;
    let most = longest(&mut t.bars.iter().map(|b| b.loss_change_w.abs())).max(f64::MIN_POSITIVE);
    let x = |change: f64| middle + change / most * half;
    let mut g = Group::new();
    for tick in ticks(-most, most, ((half / 33.0) as usize).clamp(2, 6)) {
        let label = digits(tick);
        g = g
            .add(guide(line((x(tick), TOP), (x(tick), bottom), "#e4e4e4", 1.0)))
            .add(text(x(tick), bottom + 16.0, 11.0, Anchor::Middle, &label).set("fill", FAINT));
    }
    for (k, words) in [(0, "quantity"), (1, "value"), (2, "step")] {
        g = g.add(head(columns[k], Anchor::Start, words));
    }
    g = g.add(head(middle, Anchor::Middle, "change of the loss, W")).add(head(
        width - MARGIN,
        Anchor::End,
        "efficiency, points",
    ));
    for (k, b) in t.bars.iter().enumerate() {
        let y = TOP + ROW * (k as f64 + 0.5);
        let mut row = Group::new()
            .add(
                text(columns[0], y + 4.0, 12.0, Anchor::Start, &fit(&name(b), names / BOLD, 12.0))
                    .set("font-weight", "bold"),
            )
            .add(text(columns[1], y + 4.0, 11.0, Anchor::Start, &value(b)))
            .add(text(columns[2], y + 4.0, 11.0, Anchor::Start, b.step.label()).set("fill", FAINT))
            .add(bar(x(0.0), x(-b.loss_change_w), y, &colour(Some(0), 0.25)))
            .add(bar(x(0.0), x(b.loss_change_w), y, &colour(Some(0), 1.0)));
        let up = b.loss_change_w > 0.0;
        let (at, anchor) =
            if up { (x(b.loss_change_w) + 6.0, Anchor::Start) } else { (x(b.loss_change_w) - 6.0, Anchor::End) };
        let change = text(at, y + 4.0, 11.0, anchor, &signed(b.loss_change_w));
        row = row.add(halo(change, PAPER, 3.0));
        if let Some(eta) = b.efficiency_change {
            // Round-off is no effect.
            let points = if eta.abs() < 1e-10 { 0.0 } else { 100.0 * eta };
            row = row.add(text(width - MARGIN, y + 4.0, 11.0, Anchor::End, &signed(points)));
        }
        g = g.add(told(row, "row", &[Of::Quantity(&b.name)], spelled(&b.name)));
    }
    g = g.add(guide(line((middle, TOP - 4.0), (middle, bottom), INK, 1.2))).add(guide(line(
        (left - room, bottom),
        (right, bottom),
        LINE,
        1.0,
    )));

    let mut notes =
        vec!["Dark: the step up, with its value; light: the step down. Derivatives times the step: exact for small effects, a direction for large ones.".to_owned()];
    if t.bars.iter().any(|b| b.assumed) {
        notes.push("* not given: what is taken instead.".to_owned());
    }
    if t.left_out > 0 {
        let (what, verb) = if t.left_out == 1 { ("quantity", "moves") } else { ("quantities", "move") };
        notes.push(format!("{} more {what} {verb} the loss less.", t.left_out));
    }
    let notes = lines(&notes.join(" "), inner, 12.0);
    for (k, n) in notes.iter().enumerate() {
        g = g.add(text(MARGIN, bottom + 46.0 + 17.0 * k as f64, 12.0, Anchor::Start, n).set("fill", FAINT));
    }
    let height = bottom + 46.0 + 17.0 * notes.len() as f64 + 4.0;
    page(width, height, &format!("What moves the losses of {}", t.title), &words(t))
        .add(text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&t.title, inner / BOLD, 20.0)).set("font-weight", "bold"))
        .add(text(MARGIN, 60.0, 13.0, Anchor::Start, &fit(&caption(t), inner, 13.0)).set("fill", FAINT))
        .add(g)
        .to_string()
}

fn head(x: f64, anchor: Anchor, words: &str) -> svg::node::element::Text {
    text(x, TOP - 14.0, 12.0, anchor, words).set("font-weight", "bold")
}

fn bar(from: f64, to: f64, y: f64, fill: &str) -> Group {
    let width = (to - from).abs();
    if width < 0.2 {
        return Group::new();
    }
    Group::new().add(rectangle(from.min(to), y - 8.0, width, 16.0, fill))
}

fn caption(t: &Tornado) -> String {
    let efficiency = t.efficiency.map_or(String::new(), |e| format!("Efficiency {} %, ", number(100.0 * e)));
    format!("{efficiency}{} of {} lost.", watts(t.loss_w), watts(t.input_power_w))
}

fn name(b: &TornadoBar) -> String {
    let name = spelled(&b.name);
    if b.assumed { format!("{name} *") } else { name }
}

/// With a sign and three digits.
fn signed(x: f64) -> String {
    let text = digits(x);
    if x > 0.0 { format!("+{text}") } else { text }
}

/// In a unit that people use.
fn value(b: &TornadoBar) -> String {
    let (x, unit) = units::for_people(b.value, &b.unit);
    let size = x.abs();
    // Four digits, at least those of the integer part.
    let text = if size == 0.0 || !(1e-3..1e6).contains(&size) {
        digits(x)
    } else {
        let decimals = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        let text = format!("{x:.decimals$}").replace('-', "−");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    };
    format!("{text} {unit}").trim_end().to_owned()
}

fn words(t: &Tornado) -> String {
    let first = t
        .bars
        .iter()
        .take(5)
        .map(|b| format!("{} {}: {} W", spelled(&b.name), b.step.label(), signed(b.loss_change_w)));
    format!("{} Largest effects on the loss: {}.", caption(t), first.collect::<Vec<_>>().join("; "))
}
