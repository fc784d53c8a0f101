//! The wheel of regimes.

use svg::node::element::{Group, Path};

use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, FAINT, INK, LINE, PAPER, badge, colour, digits, halo, line, number, page, rectangle, text, ticks, wide,
};
use crate::{MapCell, MapSector, RegimeMap};

const WIDTH: f64 = 1180.0;
const CENTRE: (f64, f64) = (362.0, 410.0);
/// Hub, between the rings, rim.
const RADII: [f64; 3] = [68.0, 160.0, 252.0];
const LEGEND: f64 = 732.0;

/// The regimes of a train with two freedoms: the speed plane as a wheel, coloured by inputs and
/// outputs and shaded by loss, and the efficiency over its unrolled half.
///
/// # Example
/// ```
/// use willis_figure::regime_map;
/// use willis::regimes::RegimeSelection;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("power split")
///     .members(["engine", "mg1", "ring"])
///     .terminals(["engine", "mg1", "ring"])
///     .set(SetSpec::simple("P1", ("mg1", 30), ("ring", 78), "engine").planet(24, 4).mesh_efficiency(0.99))
///     .build()?;
/// let map = regime_map(&train, &RegimeSelection::default())?;
/// assert!(willis_figure::draw_regimes(&map).starts_with("<svg"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(map: &RegimeMap) -> String {
    let rows = map.patterns.len() + map.boundaries.len();
    let chart_top = (150.0 + 21.0 * rows as f64 + 75.0).max(485.0);
    let height = chart_top + 300.0;
    let words = format!(
        "Wheel of {} speed regions with {} regimes. {}",
        map.sectors.len(),
        map.sectors.iter().map(|s| s.cells.len()).sum::<usize>(),
        map.patterns.iter().map(|p| format!("{}: {}", p.letter, p.label)).collect::<Vec<_>>().join("; ")
    );
    let document = page(WIDTH, height, &format!("Regimes of {}", map.title), &words)
        .add(text(28.0, 38.0, 20.0, Anchor::Start, &map.title).set("font-weight", "bold"))
        .add(text(28.0, 60.0, 13.0, Anchor::Start, &caption(map)).set("fill", FAINT))
        .add(text(28.0, 78.0, 13.0, Anchor::Start, &remarks(map)).set("fill", FAINT))
        .add(wheel(map))
        .add(legend(map))
        .add(chart(map, chart_top, height));
    document.to_string()
}

fn caption(map: &RegimeMap) -> String {
    format!(
        "Directions of the speeds. Outer ring: torque on {0} positive; inner ring: negative. Deeper colour: more loss.",
        short(&map.torque, 20)
    )
}

fn remarks(map: &RegimeMap) -> String {
    let mut all = Vec::new();
    if let Some([a, b]) = &map.balance {
        all.push(format!("The powers of {} and {} add to zero.", short(a, 20), short(b, 20)));
    }
    if map.widened {
        all.push("Narrow sectors are widened.".to_owned());
    }
    all.join(" ")
}

fn at(radius: f64, degrees: f64) -> (f64, f64) {
    let a = degrees.to_radians();
    (CENTRE.0 + radius * a.cos(), CENTRE.1 - radius * a.sin())
}

/// The part of a ring between two angles.
fn piece(inner: f64, outer: f64, from: f64, to: f64) -> String {
    let [a, b, c, d] = [at(outer, from), at(outer, to), at(inner, to), at(inner, from)];
    let n = |p: (f64, f64)| format!("{} {}", number(p.0), number(p.1));
    let large = i32::from(to - from > 180.0);
    let (outer, inner) = (number(outer), number(inner));
    format!("M{} A{outer} {outer} 0 {large} 0 {} L{} A{inner} {inner} 0 {large} 1 {} Z", n(a), n(b), n(c), n(d))
}

/// Radii of a regime's cell; several of one ring share it.
fn band(cell: &MapCell) -> (f64, f64) {
    let (inner, outer) = if cell.ring == 0 { (RADII[1], RADII[2]) } else { (RADII[0], RADII[1]) };
    let step = (outer - inner) / cell.slot[1] as f64;
    (inner + step * cell.slot[0] as f64, inner + step * (cell.slot[0] + 1) as f64)
}

fn strength(map: &RegimeMap, efficiency: f64) -> f64 {
    let most = (1.0 - map.least_efficiency).max(1e-9);
    0.22 + 0.78 * ((1.0 - efficiency) / most).clamp(0.0, 1.0)
}

fn category(map: &RegimeMap, pattern: usize) -> Option<usize> {
    (!map.patterns[pattern].dissipated).then_some(pattern)
}

fn wheel(map: &RegimeMap) -> Group {
    let mut g = Group::new();
    for s in &map.sectors {
        for ring in [0, 1] {
            if s.cells.iter().all(|c| c.ring != ring) {
                let (inner, outer) = if ring == 0 { (RADII[1], RADII[2]) } else { (RADII[0], RADII[1]) };
                g = g.add(guide(Path::new().set("d", piece(inner, outer, s.from, s.to)).set("fill", "#f2f2f2")));
                let (x, y) = at((inner + outer) / 2.0, (s.from + s.to) / 2.0);
                g = g.add(text(x, y + 4.0, 11.0, Anchor::Middle, "none").set("fill", FAINT));
            }
        }
        for c in &s.cells {
            g = g.add(of(shades(map, s, c), "cell", &[Of::State(&c.regime), Of::Quantity("efficiency")]));
        }
    }
    // Lines over the shades.
    for s in &map.sectors {
        for c in &s.cells {
            let (inner, outer) = band(c);
            g = g.add(guide(
                Path::new()
                    .set("d", piece(inner, outer, s.from, s.to))
                    .set("fill", "none")
                    .set("stroke", PAPER)
                    .set("stroke-width", 1.2),
            ));
        }
    }
    for b in &map.boundaries {
        let mut own = Group::new();
        for a in b.angles {
            let (colour, width) = if b.locked_up { (INK, 2.4) } else { (INK, 1.1) };
            let mut l = line(at(RADII[0], a), at(RADII[2] + 10.0, a), colour, width);
            if !b.at_rest && !b.locked_up {
                l = l.set("stroke-dasharray", "4 3");
            }
            let (x, y) = at(RADII[2] + 20.0, a);
            own = own.add(l).add(badge(x, y, &b.letter));
        }
        g = g.add(of(own, &format!("boundary-{}", b.letter), &[Of::Quantity(&b.label)]));
    }
    for s in &map.sectors {
        for c in &s.cells {
            g = g.add(label(map, s, c));
        }
    }
    // The directions of the two speeds.
    for (k, name) in map.base_speeds.iter().enumerate() {
        for (sign, turn) in [("> 0", 0.0), ("< 0", 180.0)] {
            let a = turn + if k == 0 { 0.0 } else { map.half[1] };
            // Beside the badge at the end of the axis: above it on the level axis, behind it else.
            let (x, y, anchor) = if k == 0 {
                let (x, y) = at(RADII[2] + 5.0, a);
                (x, y - 15.0, if a == 0.0 { Anchor::Start } else { Anchor::End })
            } else {
                let (x, y) = at(RADII[2] + 42.0, a);
                (x, y + 4.0, Anchor::Middle)
            };
            let shown = short(name, 14);
            g = g.add(text(x, y, 11.0, anchor, &format!("ω {shown} {sign}")).set("fill", FAINT));
        }
    }
    g.add(text(CENTRE.0, CENTRE.1 - 4.0, 11.0, Anchor::Middle, "T < 0 inside").set("fill", FAINT))
        .add(text(CENTRE.0, CENTRE.1 + 12.0, 11.0, Anchor::Middle, "T > 0 outside").set("fill", FAINT))
}

/// A cell in slices, each with the colour of its efficiency.
fn shades(map: &RegimeMap, s: &MapSector, c: &MapCell) -> Group {
    let (inner, outer) = band(c);
    let steps = c.efficiency.len() - 1;
    let slices = if s.to - s.from > 40.0 { steps } else { steps / 2 };
    let mut g = Group::new();
    for k in 0..slices {
        let t = |k: usize| s.from + (s.to - s.from) * k as f64 / slices as f64;
        let middle = c.efficiency[(2 * k + 1) * steps / (2 * slices)];
        let fill = match category(map, c.pattern) {
            None => colour(None, 0.85),
            own => colour(own, strength(map, middle)),
        };
        // A hairline of the same colour closes the seam to the next slice.
        let path = Path::new().set("d", piece(inner, outer, t(k), t(k + 1))).set("fill", fill.clone());
        g = g.add(path.set("stroke", fill).set("stroke-width", 0.6));
    }
    g
}

fn label(map: &RegimeMap, s: &MapSector, c: &MapCell) -> Group {
    let (inner, outer) = band(c);
    // Towards the rim, where a sector is wider.
    let (x, y) = at(inner + (outer - inner) * 0.58, (s.from + s.to) / 2.0);
    let thin = c.slot[1] > 1;
    let (size, gap) = if thin { (13.0, 5.0) } else { (16.0, 1.0) };
    let letter = text(x, y + gap, size, Anchor::Middle, &map.patterns[c.pattern].letter).set("font-weight", "bold");
    let g = Group::new().add(halo(letter, PAPER, 3.0));
    if thin { g } else { g.add(halo(text(x, y + 14.0, 11.0, Anchor::Middle, &c.regime), PAPER, 3.0)) }
}

fn legend(map: &RegimeMap) -> Group {
    let mut g =
        Group::new().add(text(LEGEND, 106.0, 13.0, Anchor::Start, "Inputs → outputs").set("font-weight", "bold"));
    let mut y = 128.0;
    for (k, p) in map.patterns.iter().enumerate() {
        let mut own = Group::new()
            .add(rectangle(LEGEND, y - 12.0, 26.0, 16.0, &colour(category(map, k), 0.75)))
            .add(halo(
                text(LEGEND + 13.0, y + 1.0, 13.0, Anchor::Middle, &p.letter).set("font-weight", "bold"),
                PAPER,
                3.0,
            ))
            .add(text(LEGEND + 36.0, y, 13.0, Anchor::Start, &short(&p.label.replace("->", "→"), 44)));
        let range = match (p.dissipated, p.efficiency) {
            (false, Some([least, most])) => format!("{} … {} %", percent(least), percent(most)),
            _ => "no output".to_owned(),
        };
        own = own.add(text(WIDTH - 28.0, y, 12.0, Anchor::End, &range).set("fill", FAINT));
        g = g.add(of(own, &format!("key-{}", p.letter), &[Of::State(&p.label)]));
        y += 21.0;
    }
    y += 18.0;
    let head = format!("Boundaries (at ω {} / ω {})", short(&map.base_speeds[1], 14), short(&map.base_speeds[0], 14));
    g = g.add(text(LEGEND, y, 13.0, Anchor::Start, &head).set("font-weight", "bold"));
    y += 24.0;
    for b in &map.boundaries {
        let ratio = b.ratio.map_or("∞".to_owned(), digits);
        let own = Group::new()
            .add(badge(LEGEND + 13.0, y - 4.0, &b.letter))
            .add(text(LEGEND + 36.0, y, 13.0, Anchor::Start, &short(&b.label, 54)))
            .add(text(WIDTH - 28.0, y, 12.0, Anchor::End, &ratio).set("fill", FAINT));
        g = g.add(of(own, &format!("key-{}", b.letter), &[Of::Quantity(&b.label)]));
        y += 21.0;
    }
    g
}

/// Efficiency over the unrolled half of the wheel.
fn chart(map: &RegimeMap, top: f64, height: f64) -> Group {
    let (left, right, bottom) = (LEGEND + 44.0, WIDTH - 28.0, height - 76.0);
    let top = top + 44.0;
    let floor = {
        let spread = (1.0 - map.least_efficiency).max(1e-4);
        (map.least_efficiency - 0.08 * spread).max(0.0)
    };
    let x = |angle: f64| left + (angle - map.half[0]) / (map.half[1] - map.half[0]) * (right - left);
    let y = |eta: f64| bottom - (eta.max(floor) - floor) / (1.0 - floor) * (bottom - top);
    let head = format!("Efficiency where ω {} > 0", short(&map.base_speeds[0], 18));
    let key = format!("solid: T {0} > 0, dashed: T {0} < 0", short(&map.torque, 14));
    let mut g = Group::new()
        .add(text(LEGEND, top - 34.0, 13.0, Anchor::Start, &head).set("font-weight", "bold"))
        .add(text(LEGEND, top - 16.0, 12.0, Anchor::Start, &key).set("fill", FAINT))
        .add(guide(
            rectangle(left, top, right - left, bottom - top, "none").set("stroke", LINE).set("stroke-width", 1),
        ));
    for t in ticks(floor, 1.0, 4) {
        g = g
            .add(guide(line((left, y(t)), (right, y(t)), "#e4e4e4", 1.0)))
            .add(text(left - 6.0, y(t) + 4.0, 11.0, Anchor::End, &format!("{} %", percent(t))).set("fill", FAINT));
    }
    let mut numbered: Vec<(f64, f64)> = vec![];
    for b in &map.boundaries {
        for a in b.angles.iter().flat_map(|a| [*a, a - 360.0]) {
            if a < map.half[0] - 1e-6 || a > map.half[1] + 1e-6 {
                continue;
            }
            let mut l = line((x(a), top), (x(a), bottom), if b.locked_up { INK } else { LINE }, 1.0);
            if !b.at_rest && !b.locked_up {
                l = l.set("stroke-dasharray", "4 3");
            }
            let ratio = b.ratio.map_or(if a > map.half[0] + 90.0 { "∞" } else { "−∞" }.to_owned(), digits);
            let mut own = Group::new().add(l).add(badge(x(a), bottom + 32.0, &b.letter));
            // The list has every ratio: here none runs into another.
            let half = wide(&ratio, 11.0) / 2.0 + 2.0;
            if numbered.iter().all(|(at, other)| (x(a) - at).abs() >= half + other) {
                numbered.push((x(a), half));
                own = own.add(text(x(a), bottom + 16.0, 11.0, Anchor::Middle, &ratio).set("fill", FAINT));
            }
            let word = format!("limit-{}{}", b.letter, if a > map.half[0] + 90.0 { "" } else { "-first" });
            g = g.add(of(own, &word, &[Of::Quantity(&b.label)]));
        }
    }
    for (k, c) in map.curves.iter().enumerate() {
        let own = category(map, c.pattern);
        let points: Vec<String> =
            c.points.iter().map(|[a, eta]| format!("{} {}", number(x(*a)), number(y(*eta)))).collect();
        let mut path = Path::new()
            .set("d", format!("M{}", points.join(" L")))
            .set("fill", "none")
            .set("stroke", colour(own, 1.0))
            .set("stroke-width", 2.4);
        if c.ring == 1 {
            path = path.set("stroke-dasharray", "7 4");
        }
        let label = &map.patterns[c.pattern].label;
        g = g.add(of(path, &format!("curve{k}"), &[Of::State(label), Of::Quantity("efficiency")]));
    }
    // Letters last, above the solid and below the dashed curves.
    let mut taken: Vec<(f64, f64)> = vec![];
    for c in &map.curves {
        // Several curves of one ring carry their letters at different places, apart from all others.
        let [slot, of] = c.slot;
        let shift = if c.ring == 0 { -7.0 } else { 16.0 };
        let place = |part: f64| {
            let [a, eta] = c.points[((c.points.len() - 1) as f64 * part) as usize];
            (a, (y(eta) + shift).clamp(top + 12.0, bottom - 3.0))
        };
        let own = (slot + 1) as f64 / (of + 1) as f64;
        let free = |p: &(f64, f64)| taken.iter().all(|t| (t.0 - x(p.0)).abs() > 11.0 || (t.1 - p.1).abs() > 13.0);
        let tries = [own, own - 0.15, own + 0.15, own - 0.3, own + 0.3].map(|p| place(p.clamp(0.05, 0.95)));
        let Some((a, label_y)) = tries.into_iter().find(free) else { continue };
        taken.push((x(a), label_y));
        let letter = text(x(a), label_y, 12.0, Anchor::Middle, &map.patterns[c.pattern].letter);
        g = g.add(halo(letter.set("font-weight", "bold"), PAPER, 3.0));
    }
    let axis = format!(
        "ω {} / ω {}, boundaries only, not to scale",
        short(&map.base_speeds[1], 18),
        short(&map.base_speeds[0], 18)
    );
    g.add(text((left + right) / 2.0, height - 20.0, 12.0, Anchor::Middle, &axis).set("fill", FAINT))
}

/// A fraction as per cent, with the digits that matter.
fn percent(x: f64) -> String {
    let text = format!("{:.2}", 100.0 * x);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A name that fits.
fn short(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    name.chars().take(most - 1).chain(['…']).collect()
}
