//! Bands of uncertainty over a quantity.

use svg::node::element::Group;

use crate::parts::alive::{Of, guide, of};
use crate::parts::chart::{Chart, Scale, title};
use crate::parts::style::{Anchor, BOLD, FAINT, INK, colour, digits, fit, line, lines, page, rectangle, text};
use crate::parts::words::spelled;
use crate::{BandPoint, Bands, Drawing};

const WIDTH: f64 = 900.0;
/// The legend takes so much.
const NARROWEST: f64 = 640.0;
const LEFT: f64 = 100.0;
const HEIGHT: f64 = 240.0;

/// Efficiency and loss over a quantity: the middle half of the samples dark, nine tenths light, the median, and the file
/// as written.
pub fn draw(all: &Bands) -> String {
    draw_on(all, Drawing::default())
}

pub(super) fn draw_on(all: &Bands, paper: Drawing) -> String {
    let width = paper.page(WIDTH, NARROWEST);
    let tall = HEIGHT * width / WIDTH;
    let mut top = 60.0;
    let mut body = Group::new().add(
        text(28.0, 38.0, 20.0, Anchor::Start, &fit(&all.title, (width - 56.0) / BOLD, 20.0)).set("font-weight", "bold"),
    );
    for l in lines(&all.basis, width - 56.0, 13.0) {
        body = body.add(text(28.0, top, 13.0, Anchor::Start, &l).set("fill", FAINT));
        top += 17.0;
    }
    let (key, bottom) = legend(top + 4.0, width);
    body = body.add(key);
    top = bottom + 16.0;
    let most = all.points.iter().filter_map(|p| p.loss_w).fold(0.0f64, |a, q| a.max(q[4]));
    let (size, unit) = if most >= 5000.0 { (1e3, "kW") } else { (1.0, "W") };
    let efficiency =
        |p: &BandPoint| (p.efficiency.map(|q| q.map(|e| 100.0 * e)), p.nominal_efficiency.map(|e| 100.0 * e));
    let loss = |p: &BandPoint| (p.loss_w.map(|q| q.map(|w| w / size)), p.nominal_loss_w.map(|w| w / size));
    body = body.add(panel(all, [top, top + tall, width - 28.0], String::new(), &efficiency));
    top += tall + 64.0;
    body = body.add(panel(all, [top, top + tall, width - 28.0], format!("Losses, {unit}"), &loss));
    top += tall + 62.0;
    let head = format!("Uncertain ({} samples at each of {} values)", all.samples, all.points.len());
    body = body.add(text(28.0, top, 13.0, Anchor::Start, &head).set("font-weight", "bold"));
    for q in &all.quantities {
        for l in lines(&spelled(q), width - 56.0, 11.0) {
            top += 16.0;
            body = body.add(text(28.0, top, 11.0, Anchor::Start, &l).set("fill", FAINT));
        }
    }
    page(width, top + 24.0, &format!("Uncertainty of {}", all.title), &words(all)).add(body).to_string()
}

fn words(all: &Bands) -> String {
    let mut out = format!("{}. ", all.basis);
    for (p, x) in all.points.iter().zip(&all.x.values) {
        if let Some(q) = p.efficiency {
            out += &format!(
                "At {} {}: efficiency {} to {} % in nine of ten samples, median {} %. ",
                digits(*x),
                all.x.unit,
                digits(100.0 * q[0]),
                digits(100.0 * q[4]),
                digits(100.0 * q[2])
            );
        }
    }
    out.trim_end().to_owned()
}

fn legend(y: f64, width: f64) -> (Group, f64) {
    let entries = ["5 % to 95 %", "25 % to 75 %", "median", "as the file says"];
    let mut g = guide(Group::new());
    for (k, entry) in entries.iter().enumerate() {
        let x = 28.0 + f64::min(170.0, (width - 56.0) / 4.0) * k as f64;
        g = match k {
            0 => g.add(rectangle(x, y, 26.0, 14.0, &colour(Some(0), 0.2))),
            1 => g.add(rectangle(x, y, 26.0, 14.0, &colour(Some(0), 0.45))),
            2 => g.add(line((x, y + 7.0), (x + 26.0, y + 7.0), &colour(Some(0), 1.0), 2.4)),
            _ => g.add(line((x, y + 7.0), (x + 26.0, y + 7.0), INK, 1.4).set("stroke-dasharray", "6 4")),
        };
        g = g.add(text(x + 34.0, y + 11.0, 12.0, Anchor::Start, entry));
    }
    (g, y + 14.0)
}

type Reading<'a> = &'a dyn Fn(&BandPoint) -> (Option<[f64; 5]>, Option<f64>);

fn panel(all: &Bands, [top, bottom, right]: [f64; 3], name: String, reading: Reading<'_>) -> Group {
    let what = if name.is_empty() { "efficiency" } else { "loss_w" };
    let values = all.points.iter().flat_map(|p| {
        let (band, nominal) = reading(p);
        band.into_iter().flatten().chain(nominal)
    });
    let chart = Chart {
        left: LEFT,
        top,
        right,
        bottom,
        x: Scale::of(all.x.values.iter().copied(), title(&all.x)),
        y: if name.is_empty() { Scale::efficiency(values) } else { Scale::of(values, name).rounded() },
    };
    let mut g = Group::new().add(chart.grid());
    for ([low, high], strength) in [([0, 4], 0.2), ([1, 3], 0.45)] {
        let points: Vec<_> = (all.x.values.iter().zip(&all.points))
            .map(|(x, p)| (*x, reading(p).0.map(|q| [q[low], q[high]])))
            .collect();
        for (run, area) in chart.areas(&points).into_iter().enumerate() {
            let word = format!("band{run}-{}", if low == 0 { 90 } else { 50 });
            g = g.add(of(area.set("fill", colour(Some(0), strength)), &word, &[Of::Quantity(what)]));
        }
    }
    let over = |y: &dyn Fn(&BandPoint) -> Option<f64>| -> Vec<(f64, Option<f64>)> {
        all.x.values.iter().zip(&all.points).map(|(x, p)| (*x, y(p))).collect()
    };
    if let Some(median) = chart.path(over(&|p| reading(p).0.map(|q| q[2]))) {
        let median = median.set("stroke", colour(Some(0), 1.0)).set("stroke-width", 2.4);
        g = g.add(of(median, "median", &[Of::Quantity(what)]));
    }
    if let Some(nominal) = chart.path(over(&|p| reading(p).1)) {
        let nominal = nominal.set("stroke", INK).set("stroke-width", 1.4).set("stroke-dasharray", "6 4");
        g = g.add(of(nominal, "nominal", &[Of::Quantity(what)]));
    }
    g.add(chart.frame())
}
