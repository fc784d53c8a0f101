//! Losses by source: stacked over a quantity, and as bars at the operating point.

use svg::node::element::Group;
use willis::operating_point::LossKind;
use willis::study::PointVerdict;

use crate::parts::alive::{Of, guide, of, told};
use crate::parts::chart::{Chart, Scale, title};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, badge, colour, digits, fit, halo, line, lines, page, power_unit, rectangle,
    text, titled, watts, wide,
};
use crate::parts::words::{along, law_title};
use crate::{Drawing, LossChart, LossSeries};

const WIDTH: f64 = 980.0;
const NARROWEST: f64 = 680.0;
const LEFT: f64 = 100.0;
const HEIGHT: f64 = 340.0;

/// Losses by source: stacked areas over a quantity, each with its letter, and bars with watts and shares at the operating
/// point.
pub fn draw(chart: &LossChart) -> String {
    draw_on(chart, Drawing::default())
}

pub(super) fn draw_on(chart: &LossChart, paper: Drawing) -> String {
    let width = paper.page(WIDTH, NARROWEST);
    let mut top = 60.0;
    let mut body = Group::new().add(
        text(28.0, 38.0, 20.0, Anchor::Start, &fit(&chart.title, (width - 56.0) / BOLD, 20.0))
            .set("font-weight", "bold"),
    );
    for l in lines(&chart.basis, width - 56.0, 13.0) {
        body = body.add(text(28.0, top, 13.0, Anchor::Start, &l).set("fill", FAINT));
        top += 17.0;
    }
    top += 18.0;
    let (stack, stack_bottom) = stacked(chart, top, width);
    body = body.add(stack);
    let (bars, bottom) = bars(chart, stack_bottom + 30.0, width);
    body = body.add(bars);
    page(width, bottom + 18.0, &format!("Losses of {}", chart.title), &words(chart)).add(body).to_string()
}

fn words(chart: &LossChart) -> String {
    let mut out = format!("{}. ", chart.basis);
    match (chart.loss_w, chart.input_power_w) {
        (Some(loss), Some(input)) => {
            out += &format!("At the operating point {} of {} are lost. ", watts(loss), watts(input));
            for s in &chart.series {
                if let Some(w) = s.at_operation_w {
                    out += &format!("{}: {}. ", name(s), watts(w));
                }
            }
        }
        _ => out += &format!("The operating point itself is {}. ", chart.verdict),
    }
    let missing = chart.verdicts.iter().filter(|v| **v != PointVerdict::Unique).count();
    if missing > 0 {
        out += &format!("{missing} of {} values have no single answer.", chart.verdicts.len());
    }
    out.trim_end().to_owned()
}

/// A source and its kind in words.
fn name(s: &LossSeries) -> String {
    let kind = match s.kind {
        None => return format!("{} others", s.sources),
        Some(LossKind::ShiftElement) => "open",
        Some(kind) => kind.name(),
    };
    match s.name.contains(kind) {
        true => s.name.clone(),
        false => format!("{}, {kind}", s.name),
    }
}

/// What a series stands for: the teeth of a mesh, or another part that loses power.
fn source(s: &LossSeries) -> [Of<'_>; 2] {
    let (part, what) = match s.kind {
        Some(LossKind::Sliding) => (Of::Mesh(&s.name), "loss_w sliding"),
        Some(LossKind::Rolling) => (Of::Mesh(&s.name), "loss_w rolling"),
        Some(LossKind::Bearing) => (Of::Element(&s.name), "loss_w bearing"),
        Some(LossKind::Windage) => (Of::Element(&s.name), "loss_w windage"),
        Some(LossKind::Churning) => (Of::Element(&s.name), "loss_w churning"),
        Some(LossKind::Seal) => (Of::Element(&s.name), "loss_w seal"),
        Some(LossKind::Drag) => (Of::Element(&s.name), "loss_w drag"),
        Some(LossKind::ShiftElement) => (Of::Element(&s.name), "loss_w shift-element"),
        Some(LossKind::Injection) => (Of::Mesh(&s.name), "loss_w injection"),
        Some(LossKind::Pump) => (Of::Element(&s.name), "loss_w pump"),
        _ => (Of::Element(&s.name), "loss_w other"),
    };
    [part, Of::Quantity(what)]
}

fn letter(k: usize) -> String {
    char::from(b'A' + k as u8).to_string()
}

fn fill(k: usize, s: &LossSeries) -> String {
    match s.kind {
        None => colour(None, 0.35),
        Some(_) => colour(Some(k), 0.62),
    }
}

/// One unit for all losses of the picture: its watts, and its name.
fn unit(chart: &LossChart) -> (f64, &'static str) {
    let totals = (0..chart.x.values.len()).map(|k| chart.series.iter().filter_map(|s| s.loss_w[k]).sum());
    power_unit(totals.chain(chart.loss_w).fold(0.0f64, f64::max))
}

/// A law by its title rather than its name in files.
fn law(s: &LossSeries) -> Option<String> {
    let id = s.law.as_ref().filter(|_| s.kind.is_some())?;
    Some(law_title(s.kind, id))
}

fn stacked(chart: &LossChart, top: f64, width: f64) -> (Group, f64) {
    // The legend beside the chart.
    let key = width - (0.32 * width).clamp(260.0, 312.0);
    let right = key - 28.0;
    let count = chart.x.values.len();
    let mut total = vec![Some(0.0); count];
    let mut layers = vec![];
    for s in &chart.series {
        let below = total.clone();
        for (t, w) in total.iter_mut().zip(&s.loss_w) {
            *t = t.zip(*w).map(|(t, w)| t + w);
        }
        layers.push((below, total.clone()));
    }
    // Where nothing is known, nothing is stacked.
    let known = |k: usize| chart.verdicts[k] == PointVerdict::Unique;
    let most = (0..count).filter(|k| known(*k)).filter_map(|k| total[k]).fold(0.0f64, f64::max);
    let (size, unit) = unit(chart);
    let values = [0.0, if most > 0.0 { most * 1.06 / size } else { 1.0 }];
    let axes = Chart {
        left: LEFT,
        top,
        right,
        bottom: top + HEIGHT * (width / WIDTH).powi(2),
        x: Scale::of(chart.x.values.iter().copied(), title(&chart.x)),
        y: Scale::of(values.into_iter(), format!("Losses, {unit}")).rounded(),
    };
    let mut g = Group::new().add(axes.grid());
    for (k, (s, (below, above))) in chart.series.iter().zip(&layers).enumerate() {
        let points: Vec<(f64, Option<[f64; 2]>)> = (0..count)
            .map(|j| {
                let y = below[j].zip(above[j]).filter(|_| known(j)).map(|(b, a)| [b / size, a / size]);
                (chart.x.values[j], y)
            })
            .collect();
        for (run, area) in axes.areas(&points).into_iter().enumerate() {
            let area = area.set("fill", fill(k, s)).set("stroke", PAPER).set("stroke-width", 0.8);
            g = g.add(of(area, &format!("area{run}"), &source(s)));
        }
    }
    let outline = (0..count).map(|j| (chart.x.values[j], total[j].filter(|_| known(j)).map(|t| t / size)));
    if let Some(outline) = axes.path(outline) {
        g = g.add(of(outline.set("stroke", INK).set("stroke-width", 1.6), "curve", &[Of::Quantity("loss_w")]));
    }
    // Letters where a layer is thickest, if they fit.
    for (k, (below, above)) in layers.iter().enumerate() {
        let thick = |j: usize| {
            let room = below[j].zip(above[j]).filter(|_| known(j)).map_or(0.0, |(b, a)| a - b);
            // Not at the very edge.
            if j < count / 16 || j + 1 + count / 16 >= count { 0.0 } else { room }
        };
        let Some(j) = (0..count).max_by(|a, b| thick(*a).total_cmp(&thick(*b)).then(b.cmp(a))) else { continue };
        let (Some(b), Some(a)) = (below[j], above[j]) else { continue };
        if axes.y(b / size) - axes.y(a / size) > 15.0 && thick(j) > 0.0 {
            let x = axes.x(chart.x.values[j]).clamp(LEFT + 12.0, right - 12.0);
            let y = axes.y((a + b) / 2.0 / size) + 4.0;
            g = g.add(text(x, y, 12.0, Anchor::Middle, &letter(k)).set("font-weight", "bold"));
        }
    }
    if let Some(at) = chart.at {
        let x = axes.x(at);
        let mark = line((x, axes.top), (x, axes.bottom), INK, 1.0).set("stroke-dasharray", "5 4");
        g = g.add(told(mark, "at", &[Of::Quantity(&chart.x.name)], along(&chart.x.name)));
        let (place, anchor) = if x > (LEFT + right) / 2.0 { (x - 5.0, Anchor::End) } else { (x + 5.0, Anchor::Start) };
        let label = text(place, axes.top + 14.0, 11.0, anchor, "operating point");
        g = g.add(halo(label, PAPER, 3.0));
    }
    if let Some(k) = (0..count).find(|k| !known(*k)) {
        let run = (k..count).take_while(|j| !known(*j)).count();
        let x = (axes.x(chart.x.values[k]) + axes.x(chart.x.values[k + run - 1])) / 2.0;
        let word = chart.verdicts[k].name();
        let half = wide(word, 11.0) / 2.0 + 3.0;
        let x = x.clamp(LEFT + half, right - half);
        g = g.add(text(x, (axes.top + axes.bottom) / 2.0, 11.0, Anchor::Middle, word).set("fill", FAINT));
    }
    g = g.add(axes.frame());
    let mut y = top + 8.0;
    for (k, s) in chart.series.iter().enumerate().rev() {
        let label = fit(&name(s), width - key - 60.0, 12.0);
        let entry = Group::new()
            .add(rectangle(key, y, 22.0, 15.0, &fill(k, s)))
            .add(text(key + 11.0, y + 12.0, 11.0, Anchor::Middle, &letter(k)).set("font-weight", "bold"))
            .add(text(key + 32.0, y + 12.0, 12.0, Anchor::Start, &label));
        g = g.add(of(entry, "key", &source(s)));
        y += 22.0;
    }
    // Efficiency as a small chart of its own below the legend.
    let known = || (0..count).filter_map(|k| chart.efficiency[k]);
    let axis_bottom = axes.bottom;
    if known().count() > 1 && axis_bottom - y > 130.0 {
        let small = Chart {
            left: key + 56.0,
            top: y + 34.0,
            right: width - 28.0,
            bottom: axis_bottom,
            x: Scale::of(chart.x.values.iter().copied(), title(&chart.x)),
            y: Scale::efficiency(known().map(|e| 100.0 * e)),
        };
        let points = (0..count).map(|k| (chart.x.values[k], chart.efficiency[k].map(|e| 100.0 * e)));
        g = g.add(small.grid());
        if let Some(curve) = small.path(points) {
            let curve = curve.set("stroke", colour(Some(0), 1.0)).set("stroke-width", 2);
            g = g.add(of(curve, "curve", &[Of::Quantity("efficiency")]));
        }
        g = g.add(small.frame());
    }
    (g, axis_bottom + 40.0)
}

fn bars(chart: &LossChart, top: f64, width: f64) -> (Group, f64) {
    let mut g = Group::new();
    let Some(loss) = chart.loss_w else {
        let told = format!("The operating point itself is {}: it has no losses to show.", chart.verdict);
        return (g.add(text(28.0, top + 10.0, 13.0, Anchor::Start, &told)), top + 14.0);
    };
    let (size, unit) = unit(chart);
    let power = |w: f64| format!("{} {unit}", digits(w / size));
    let head = match chart.input_power_w {
        Some(p) if p > 0.0 => {
            format!("At the operating point: {} of {} lost, {} %", power(loss), watts(p), digits(100.0 * loss / p))
        }
        _ => format!("At the operating point: {} lost", power(loss)),
    };
    g = g.add(text(28.0, top + 10.0, 13.0, Anchor::Start, &head).set("font-weight", "bold"));
    let mut y = top + 24.0;
    let (start, most) =
        (f64::min(330.0, 0.34 * width), chart.series.iter().filter_map(|s| s.at_operation_w).fold(0.0f64, f64::max));
    for (k, s) in chart.series.iter().enumerate() {
        let Some(w) = s.at_operation_w else { continue };
        let length = if most > 0.0 { (width - start - f64::min(290.0, 0.3 * width)) * w / most } else { 0.0 };
        let said = match loss > 0.0 {
            true => format!("{}, {} %", power(w), digits(100.0 * w / loss)),
            false => power(w),
        };
        let mut bar = Group::new()
            .add(badge(37.0, y + 9.0, &letter(k)))
            .add(text(54.0, y + 13.0, 12.0, Anchor::Start, &fit(&name(s), start - 66.0, 12.0)))
            .add(rectangle(start, y + 1.0, length.max(0.8), 16.0, &fill(k, s)))
            .add(text(start + length + 8.0, y + 13.0, 12.0, Anchor::Start, &said));
        let from = start + length + 8.0 + wide(&said, 12.0);
        if let Some(law) = law(s) {
            let shown = fit(&law, width - 28.0 - from - 8.0, 11.0);
            let label = text(from + 8.0, y + 13.0, 11.0, Anchor::Start, &shown).set("fill", FAINT);
            bar = bar.add(titled(label, &law));
        }
        g = g.add(of(bar, "bar", &source(s)));
        y += 22.0;
    }
    (g.add(guide(line((start, top + 20.0), (start, y), LINE, 1.0))), y)
}
