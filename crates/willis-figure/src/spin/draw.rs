//! Losses without load as stacked bars: a bar a gear, a layer a source.

use svg::node::element::Group;
use willis::operating_point::LossKind;

use super::{SpinGear, SpinLosses, SpinSource};
use crate::Drawing;
use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, LINE, PAPER, colour, digits, fit, line, lines, page, power_unit, rectangle, text, ticks, wide,
};

const MARGIN: f64 = 28.0;
const ROW: f64 = 30.0;
/// Sources that are shown by name; the others are one.
const NAMED: usize = 8;

/// Losses without load of every gear, stacked by source; a sentence where there are none.
///
/// # Example
/// ```
/// use willis_figure::{draw_spin, spin_losses};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4))
///     .build()?;
/// assert!(draw_spin(&spin_losses(&train, None, None)?).contains("nothing"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(data: &SpinLosses) -> String {
    draw_on(data, Drawing::default())
}

/// A layer of the bars.
struct Layer<'a> {
    name: &'a str,
    kind: Option<LossKind>,
    /// How many sources it stands for.
    sources: usize,
    /// W of each gear.
    loss_w: Vec<f64>,
}

pub(super) fn draw_on(data: &SpinLosses, paper: Drawing) -> String {
    let width = paper.page(1000.0, 560.0);
    let room = width - 2.0 * MARGIN;
    let mut g = Group::new()
        .add(text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&data.title, room / BOLD, 20.0)).set("font-weight", "bold"));
    let mut y = 60.0;
    for l in lines(&basis(data), room, 13.0) {
        g = g.add(text(MARGIN, y, 13.0, Anchor::Start, &l).set("fill", FAINT));
        y += 18.0;
    }
    let head = format!("Losses without load of {}", data.title);
    let layers = layers(data);
    let said = sentence(data, &layers);
    if let Some(said) = &said {
        for l in lines(said, room, 15.0) {
            y += 21.0;
            g = g.add(text(MARGIN, y, 15.0, Anchor::Start, &l));
        }
        return page(width, y + 28.0, &head, &words(data, said)).add(g).to_string();
    }
    y += 14.0;
    // The largest sum gives the scale, and the unit of all numbers.
    let most = data.gears.iter().filter_map(|g| g.loss_w).fold(0.0f64, f64::max);
    let (size, unit) = power_unit(most);
    let value = |gear: &SpinGear| match (gear.loss_w, gear.torque_n_m) {
        (Some(w), Some(t)) => format!("{} {unit}, {} N m", digits(w / size), digits(t)),
        (Some(w), None) => format!("{} {unit}", digits(w / size)),
        _ => gear.verdict.name().to_owned(),
    };
    let longest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, f64::max);
    let names = longest(&mut data.gears.iter().map(|g| wide(&g.state, 12.0) * BOLD)).min(0.25 * room);
    let values = longest(&mut data.gears.iter().map(|g| wide(&value(g), 12.0)));
    let left = MARGIN + names + 12.0;
    let right = width - MARGIN - values - 12.0;
    let marks: Vec<f64> = ticks(0.0, most / size, 5);
    let full = marks.last().copied().unwrap_or(0.0).max(most / size);
    let x = |w: f64| left + (right - left) * w / size / full;
    let bottom = y + 18.0 + ROW * data.gears.len() as f64;
    g = g.add(
        text(left, y + 4.0, 12.0, Anchor::Start, &format!("Losses, {unit}; torque at the input, N m"))
            .set("fill", FAINT),
    );
    y += 18.0;
    for tick in &marks {
        let at = x(tick * size);
        g = g.add(guide(line((at, y), (at, bottom), "#e4e4e4", 1.0)));
        g = g.add(text(at, bottom + 15.0, 11.0, Anchor::Middle, &digits(*tick)).set("fill", FAINT));
    }
    for (k, gear) in data.gears.iter().enumerate() {
        let mid = y + ROW / 2.0;
        let name = text(left - 10.0, mid + 4.0, 12.0, Anchor::End, &fit(&gear.state, names / BOLD, 12.0));
        let mut from = left;
        for (n, layer) in layers.iter().enumerate().filter(|(_, l)| l.loss_w[k] > 0.0) {
            let long = x(layer.loss_w[k]) - left;
            let bar = rectangle(from, mid - 9.0, long.max(0.4), 18.0, &fill(n, layer));
            let mut own = Group::new().add(bar.set("stroke", PAPER).set("stroke-width", 0.6));
            if long > 14.0 {
                own = own.add(text(from + long / 2.0, mid + 4.0, 11.0, Anchor::Middle, &letter(n)));
            }
            let about = [Of::State(&gear.state), Of::Element(layer.name), Of::Quantity(quantity(layer.kind))];
            g = g.add(of(own, &format!("bar{n}"), &about));
            from += long;
        }
        g = g.add(name.set("font-weight", "bold"));
        g = g.add(text(from + 8.0, mid + 4.0, 12.0, Anchor::Start, &value(gear)));
        y += ROW;
    }
    g = g.add(guide(line((left, bottom - ROW * data.gears.len() as f64), (left, bottom), LINE, 1.0)));
    y = bottom + 36.0;
    // The key, in as many columns as have room.
    let label = |layer: &Layer<'_>| match layer.kind {
        Some(kind) if layer.name.contains(kind.words()) => layer.name.to_owned(),
        Some(kind) => format!("{}, {}", layer.name, kind.words()),
        None => format!("{} others", layer.sources),
    };
    let column = longest(&mut layers.iter().map(|l| wide(&label(l), 12.0))).min(room - 40.0) + 54.0;
    let columns = ((room / column).floor() as usize).max(1);
    for (n, layer) in layers.iter().enumerate() {
        let (at, row) = (MARGIN + column * (n % columns) as f64, y + 22.0 * (n / columns) as f64);
        let own = Group::new()
            .add(rectangle(at, row - 11.0, 22.0, 15.0, &fill(n, layer)))
            .add(text(at + 11.0, row + 1.0, 11.0, Anchor::Middle, &letter(n)))
            .add(text(at + 30.0, row + 1.0, 12.0, Anchor::Start, &fit(&label(layer), column - 40.0, 12.0)));
        g = g.add(of(own, &format!("key{n}"), &[Of::Element(layer.name), Of::Quantity(quantity(layer.kind))]));
    }
    y += 22.0 * layers.len().div_ceil(columns) as f64;
    page(width, y + 6.0, &head, &words(data, "")).add(g).to_string()
}

fn basis(data: &SpinLosses) -> String {
    let input = data.gears.first().map_or("the input", |g| g.input.as_str());
    let from = match &data.of_operation {
        Some(name) => format!("the speed of operating point {name}"),
        None => "a speed that was chosen here".to_owned(),
    };
    let oil = data.gears.iter().filter_map(|g| g.oil_k).map(|t| t - 273.15);
    let [low, high] = oil.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], t| [l.min(t), h.max(t)]);
    let oil = match high - low {
        d if d.is_nan() || high < low => String::new(),
        d if d < 0.5 => format!(", the oil as warm as under load, {high:.0} °C"),
        _ => format!(", the oil as warm as under load, {low:.0} to {high:.0} °C"),
    };
    format!("{input} turns at {} rpm, {from}; no torque acts on the output{oil}.", digits(data.speed_rpm))
}

/// Why there is nothing to draw.
fn sentence(data: &SpinLosses, layers: &[Layer<'_>]) -> Option<String> {
    if !layers.is_empty() {
        return None;
    }
    let known = data.gears.iter().any(|g| g.loss_w.is_some());
    Some(match known {
        true => "Without load the train loses nothing that can be computed: the file gives no bearing, seal or rotor, and no gear \
                 runs in air or oil by its data."
            .to_owned(),
        false => "Without load there is no single answer in any gear of this train, so that no losses can be told here.".to_owned(),
    })
}

/// The picture in words.
fn words(data: &SpinLosses, said: &str) -> String {
    let gear = |g: &SpinGear| match (g.loss_w, g.sources.first()) {
        (Some(w), Some(most)) => {
            format!("{}: {} W, the most by {} ({})", g.state, digits(w), most.name, most.kind.words())
        }
        (Some(w), None) => format!("{}: {} W", g.state, digits(w)),
        (None, _) => format!("{}: {}", g.state, g.verdict.name()),
    };
    let all: Vec<String> = data.gears.iter().map(gear).collect();
    format!("{} {said} {}.", basis(data), all.join("; "))
}

/// The sources of all gears, the largest sum first; what is beyond the named ones is one layer.
fn layers(data: &SpinLosses) -> Vec<Layer<'_>> {
    let mut all: Vec<Layer<'_>> = vec![];
    for (k, gear) in data.gears.iter().enumerate() {
        for SpinSource { name, kind, loss_w } in &gear.sources {
            let at = all.iter().position(|l| l.name == name && l.kind == Some(*kind)).unwrap_or_else(|| {
                all.push(Layer { name, kind: Some(*kind), sources: 1, loss_w: vec![0.0; data.gears.len()] });
                all.len() - 1
            });
            all[at].loss_w[k] += loss_w;
        }
    }
    let sum = |l: &Layer<'_>| l.loss_w.iter().sum::<f64>();
    all.sort_by(|a, b| sum(b).total_cmp(&sum(a)));
    if all.len() > NAMED {
        let rest = all.split_off(NAMED - 1);
        let loss_w = (0..data.gears.len()).map(|k| rest.iter().map(|l| l.loss_w[k]).sum()).collect();
        all.push(Layer { name: "others", kind: None, sources: rest.len(), loss_w });
    }
    all
}

fn quantity(kind: Option<LossKind>) -> &'static str {
    match kind {
        Some(LossKind::Sliding) => "loss_w sliding",
        Some(LossKind::Rolling) => "loss_w rolling",
        Some(LossKind::Bearing) => "loss_w bearing",
        Some(LossKind::Windage) => "loss_w windage",
        Some(LossKind::Churning) => "loss_w churning",
        Some(LossKind::Seal) => "loss_w seal",
        Some(LossKind::Drag) => "loss_w drag",
        Some(LossKind::ShiftElement) => "loss_w shift-element",
        Some(LossKind::Injection) => "loss_w injection",
        Some(LossKind::Pump) => "loss_w pump",
        _ => "loss_w other",
    }
}

fn fill(n: usize, layer: &Layer<'_>) -> String {
    match layer.kind {
        None => colour(None, 0.35),
        Some(_) => colour(Some(n), 0.5),
    }
}

fn letter(n: usize) -> String {
    char::from(b'A' + n as u8).to_string()
}
