//! A set or a pair of gears seen along its axis.

mod clip;
mod enlarged;
mod view;

use std::f64::consts::{FRAC_PI_4, TAU};

use svg::node::element::{Group, Path, Polygon, Style};

use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, badge, colour, digits, fit, halo, line, lines, number, page, rectangle, text, wide,
};
use crate::{Drawing, Front, FrontMesh, FrontPlane, FrontWheel};
use enlarged::{ENLARGED, enlarged, window};
use view::{DASH_DOT, View, circle, own};

/// Edge of the page, and where the panels begin.
const EDGE: f64 = 28.0;
const TOP: f64 = 84.0;
/// Around the wheels of a panel: arrows and badges.
const MARGIN: f64 = 30.0;
/// Table of wheels beside the panels.
const SIDE: f64 = 420.0;
/// The numbers, and a train that can still be seen.
const NARROWEST: f64 = 920.0;
/// Seconds in which one tooth of the first wheel passes, in the animated picture.
const PASSING: f64 = 0.8;
/// How far a drawn outline may leave the true one, px.
const ACCURACY: f64 = 0.06;

/// A set seen along its axis with its true teeth, one mesh enlarged, and its numbers. Where
/// `animated`, the wheels turn as they do relative to the carrier; a reader that does not move
/// pictures shows the still one.
///
/// # Example
/// ```
/// use willis_figure::front;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4))
///     .build()?;
/// let view = front(&train, None, true)?;
/// let svg = willis_figure::draw_front(&view, false);
/// assert!(svg.contains("z = 30") && !svg.contains("animation"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(view: &Front, animated: bool) -> String {
    draw_on(view, Drawing { animated, ..Drawing::default() })
}

pub(super) fn draw_on(view: &Front, how: Drawing) -> String {
    let reach = view
        .wheels
        .iter()
        .flat_map(|w| w.bodies.iter().map(|b| b.centre_mm[0].hypot(b.centre_mm[1]) + w.outer_radius_mm()))
        .fold(0.0, f64::max);
    // One plane has its numbers beside it, several have them below.
    let several = view.planes.len() > 1;
    let (columns, size) = match view.planes.len() {
        1 => (1, 860.0),
        2 => (2, 610.0),
        n => (n.min(3), 440.0),
    };
    let beside = if several { 2.0 * EDGE } else { 2.0 * EDGE + 32.0 + SIDE };
    let size = (how.page(beside + columns as f64 * size, NARROWEST) - beside) / columns as f64;
    let pair = view.kind == "pair";
    // A pair stands off the middle.
    let (middle, reach) = if pair { extent(view) } else { ([0.0, 0.0], reach) };
    let scale = (size - 2.0 * MARGIN) / (2.0 * reach);
    let rows = view.planes.len().div_ceil(columns);
    let label = if several { 22.0 } else { 0.0 };
    let panels = (columns as f64 * size, rows as f64 * (size + label));
    let width = if several { (2.0 * EDGE + panels.0).max(920.0) } else { beside + size };
    let mut page_body = Group::new();
    for (k, plane) in view.planes.iter().enumerate() {
        let corner = (EDGE + (k % columns) as f64 * size, TOP + (k / columns) as f64 * (size + label));
        let centre = (corner.0 + size / 2.0 - middle[0] * scale, corner.1 + label + size / 2.0 + middle[1] * scale);
        let at = View { centre, scale };
        if several {
            let names: Vec<&str> = plane.wheels.iter().map(|&w| own(view, &view.wheels[w].name)).collect();
            let words = fit(&format!("Plane {}: {}", k + 1, names.join(", ")), (size - 12.0) / BOLD, 13.0);
            page_body = page_body
                .add(text(corner.0 + 4.0, corner.1 + 14.0, 13.0, Anchor::Start, &words).set("font-weight", "bold"));
        }
        page_body = page_body.add(panel(view, plane, &at, k == 0, how.animated));
    }
    let (x, y) = if several { (EDGE, TOP + panels.1 + 16.0) } else { (EDGE + size + 32.0, TOP) };
    let mut bottom = y;
    if let Some(mesh) = view.planes.first().and_then(|p| p.meshes.first()).map(|&m| &view.meshes[m]) {
        page_body = page_body.add(of(enlarged(view, mesh, x, y), "enlarged", &[Of::Mesh(&mesh.name)]));
        bottom = y + ENLARGED + 62.0;
    }
    let (x, y, room) =
        if several { (EDGE + ENLARGED + 40.0, y, width - EDGE - x - ENLARGED - 40.0) } else { (x, bottom, SIDE) };
    let (numbers, end) = numbers(view, x, y, room);
    page_body = page_body.add(numbers);
    let height = end.max(bottom).max(TOP + panels.1) + 20.0;
    let title = match pair {
        true => format!("{}, {}", view.title, view.set),
        false => format!("{}, set {}", view.title, view.set),
    };
    let caption = match (pair, view.assumed) {
        (true, false) => format!("Seen along the axes, which stand in {}.", view.carrier),
        (false, false) => format!("Seen along the axis. Carrier: {}; the wheels turn relative to it.", view.carrier),
        (_, true) => format!("Seen along the axis. Carrier: {}. The teeth are ASSUMED: see the notes.", view.carrier),
    };
    let document = page(width, height, &format!("Front view of {title}"), &description(view))
        .add(
            text(EDGE, 38.0, 20.0, Anchor::Start, &fit(&title, (width - 2.0 * EDGE) / BOLD, 20.0))
                .set("font-weight", "bold"),
        )
        .add(text(EDGE, 60.0, 13.0, Anchor::Start, &fit(&caption, width - 2.0 * EDGE, 13.0)).set("fill", FAINT))
        .add(page_body);
    if how.animated { document.add(Style::new(TURNING)).to_string() } else { document.to_string() }
}

/// Middle of all wheels, and half of the larger side of their box.
fn extent(view: &Front) -> ([f64; 2], f64) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for w in &view.wheels {
        for b in &w.bodies {
            for k in 0..2 {
                low[k] = low[k].min(b.centre_mm[k] - w.outer_radius_mm());
                high[k] = high[k].max(b.centre_mm[k] + w.outer_radius_mm());
            }
        }
    }
    let middle = [0, 1].map(|k| (low[k] + high[k]) / 2.0);
    (middle, (high[0] - low[0]).max(high[1] - low[1]) / 2.0)
}

fn description(view: &Front) -> String {
    let wheels: Vec<String> = view
        .wheels
        .iter()
        .map(|w| {
            let many = if w.bodies.len() > 1 { format!("{} times ", w.bodies.len()) } else { String::new() };
            let ring = if w.internal { ", a ring gear" } else { "" };
            format!("{many}{} with {} teeth{ring}", w.name, w.teeth)
        })
        .collect();
    let spacing = match (view.spacing.planets, view.spacing.equal) {
        (1, _) => "",
        (_, true) => " The planets are spaced equally.",
        (_, false) => " The planets cannot be spaced equally and are not.",
    };
    let assumed = if view.assumed { " The teeth are assumed, not given." } else { "" };
    format!("Gears in mesh, seen along the axis, with the teeth of the train: {}.{spacing}{assumed}", wheels.join("; "))
}

/// The wheels of one plane.
fn panel(view: &Front, plane: &FrontPlane, at: &View, first: bool, animated: bool) -> Group {
    let mut g = Group::new();
    let set = Of::Mesh(&view.set);
    // Rings behind, suns before their planets.
    let mut order = plane.wheels.clone();
    order.sort_by_key(|&w| (!view.wheels[w].internal, view.wheels[w].planet, w));
    for &k in &order {
        let w = &view.wheels[k];
        let weight = (w.module_mm * at.scale * 0.1).clamp(0.3, 1.1);
        for (body, _) in w.bodies.iter().enumerate() {
            let mut path = Path::new()
                .set("d", outline(w, body, at))
                .set("fill", colour(w.colour, 0.24))
                .set("fill-rule", "evenodd")
                .set("stroke", INK)
                .set("stroke-width", number(weight))
                .set("stroke-linejoin", "round");
            if animated && w.turns != 0.0 {
                path = turning(path, view, w, at.at(w.bodies[body].centre_mm));
            }
            g = g.add(of(path, &format!("wheel{body}"), &[Of::Member(&w.name), set]));
        }
    }
    let word = |name: &str| format!("{name}{}", plane.wheels.first().copied().unwrap_or(0));
    let carried = of(carrier(view, plane, at), &word("carrier"), &[Of::Member(&view.carrier), set]);
    g = g.add(guide(circles(view, plane, at))).add(carried);
    if let Some(mesh) = plane.meshes.first().map(|&m| &view.meshes[m]) {
        g = g.add(of(action(mesh, at), "action", &[Of::Mesh(&mesh.name)]));
        if first {
            let half = window(view, mesh) * at.scale;
            let (x, y) = at.at(mesh.pitch_point_mm);
            g = g.add(guide(
                rectangle(x - half, y - half, 2.0 * half, 2.0 * half, "none")
                    .set("stroke", INK)
                    .set("stroke-width", 0.8)
                    .set("stroke-dasharray", "3 2"),
            ));
        }
    }
    for &k in &order {
        g = g.add(of(marks(view, k, at), "mark", &[Of::Member(&view.wheels[k].name), set]));
    }
    g
}

/// The wheel whose turns those of the others are for one of.
fn root(view: &Front) -> usize {
    view.wheels.iter().position(|w| w.turns == 1.0).unwrap_or(0)
}

/// What wheels that turn refer to. Style sheets, unlike animations in the picture itself, know readers who want none.
const TURNING: &str = "@keyframes turn { to { transform: rotate(360deg) } }\n\
                       @media (prefers-reduced-motion: reduce) { .turns { animation: none !important } }";

/// Turns a wheel about its axis for ever.
fn turning(path: Path, view: &Front, w: &FrontWheel, centre: (f64, f64)) -> Path {
    let once = PASSING * f64::from(view.wheels[root(view)].teeth) / w.turns.abs();
    // The page's second axis points downward: counterclockwise is backwards.
    let way = if w.turns > 0.0 { " reverse" } else { "" };
    let style = format!(
        "transform-origin: {}px {}px; animation: turn {once:.6}s linear infinite{way}",
        number(centre.0),
        number(centre.1)
    );
    path.set("class", "turns").set("style", style)
}

/// The whole wheel as one path; a ring with its rim.
fn outline(w: &FrontWheel, body: usize, at: &View) -> String {
    let b = w.bodies[body];
    let tooth = thin(&w.outline_mm, ACCURACY / at.scale);
    let mut d = String::new();
    for k in 0..w.teeth {
        let (sin, cos) = (b.phase + TAU * f64::from(k) / f64::from(w.teeth)).sin_cos();
        // The last point of a tooth is the first of the next.
        for p in &tooth[..tooth.len() - 1] {
            let (x, y) = at.at([b.centre_mm[0] + p[0] * cos - p[1] * sin, b.centre_mm[1] + p[0] * sin + p[1] * cos]);
            d.push(if d.is_empty() { 'M' } else { ' ' });
            d.push_str(&number(x));
            d.push(' ');
            d.push_str(&number(y));
        }
    }
    d.push('Z');
    if w.internal {
        let (x, y) = at.at(b.centre_mm);
        let r = w.outer_radius_mm() * at.scale;
        let (left, right, r, y) = (number(x - r), number(x + r), number(r), number(y));
        d.push_str(&format!("M{left} {y} A{r} {r} 0 1 0 {right} {y} A{r} {r} 0 1 0 {left} {y}Z"));
    }
    d
}

/// The points without which a line would leave the given one by more than that (Douglas and Peucker).
fn thin(points: &[[f64; 2]], most: f64) -> Vec<[f64; 2]> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let (a, b) = (points[0], points[points.len() - 1]);
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
    let off = |p: &[f64; 2]| ((p[0] - a[0]) * dy - (p[1] - a[1]) * dx).abs() / length;
    let (k, far) = points.iter().map(off).enumerate().fold((0, 0.0), |m, x| if x.1 > m.1 { x } else { m });
    if far <= most || k == 0 || k == points.len() - 1 {
        return vec![a, b];
    }
    let mut all = thin(&points[..=k], most);
    all.pop();
    all.extend(thin(&points[k..], most));
    all
}

/// Operating pitch circles, and the tip and root circles of central gears and the first planet.
fn circles(view: &Front, plane: &FrontPlane, at: &View) -> Group {
    let mut g = Group::new();
    for &k in &plane.wheels {
        let w = &view.wheels[k];
        let c = at.at(w.bodies[0].centre_mm);
        for r in [w.tip_radius_mm, w.root_radius_mm] {
            g = g.add(circle(c, r * at.scale, FAINT, 0.4).set("stroke-dasharray", "2 2"));
        }
        let mut drawn: Vec<f64> = Vec::new();
        for m in plane.meshes.iter().map(|&m| &view.meshes[m]) {
            let Some(side) = m.wheels.iter().position(|&o| o == k) else { continue };
            let r = m.pitch_radii_mm[side] * at.scale;
            if drawn.iter().any(|d| (d - r).abs() < 0.6) {
                continue;
            }
            drawn.push(r);
            for b in &w.bodies {
                g = g.add(circle(at.at(b.centre_mm), r, FAINT, 0.8).set("stroke-dasharray", DASH_DOT));
            }
        }
    }
    g
}

/// The planets' axes joined: triangle, square or arm.
fn carrier(view: &Front, plane: &FrontPlane, at: &View) -> Group {
    let mut g = Group::new();
    for w in plane.wheels.iter().map(|&k| &view.wheels[k]).filter(|w| w.planet) {
        let points: Vec<(f64, f64)> = w.bodies.iter().map(|b| at.at(b.centre_mm)).collect();
        match points.as_slice() {
            [one] => g = g.add(line(at.centre, *one, FAINT, 1.2)),
            [a, b] => {
                g = g.add(line(at.centre, *a, FAINT, 1.2)).add(line(at.centre, *b, FAINT, 1.2));
            }
            all => {
                let words: Vec<String> = all.iter().map(|p| format!("{},{}", number(p.0), number(p.1))).collect();
                g = g.add(
                    Polygon::new()
                        .set("points", words.join(" "))
                        .set("fill", "none")
                        .set("stroke", FAINT)
                        .set("stroke-width", 1.2),
                );
            }
        }
    }
    g
}

/// The line of action, and on it the path of contact.
fn action(mesh: &FrontMesh, at: &View) -> Group {
    let [a, b] = mesh.base_points_mm.map(|s| at.at(mesh.point(s)));
    let [from, to] = [mesh.path_mm[0], mesh.path_mm[4]].map(|s| at.at(mesh.point(s)));
    Group::new().add(line(a, b, INK, 0.8)).add(line(from, to, INK, 2.4))
}

/// Number of a wheel in the table, and the sense in which it turns.
fn marks(view: &Front, k: usize, at: &View) -> Group {
    let w = &view.wheels[k];
    let mut g = Group::new();
    let key = (k + 1).to_string();
    if w.internal {
        let c = at.at(w.bodies[0].centre_mm);
        let r = w.outer_radius_mm() * at.scale;
        let away = r + 13.0;
        let (x, y) = (c.0 + away * FRAC_PI_4.cos(), c.1 - away * FRAC_PI_4.sin());
        let room = (r * (1.0 - FRAC_PI_4.cos()) - 4.0).max(30.0);
        g = g
            .add(badge(x, y, &key))
            .add(text(x + 14.0, y - 3.0, 12.0, Anchor::Start, &fit(own(view, &w.name), room, 12.0)))
            .add(text(x + 14.0, y + 11.0, 12.0, Anchor::Start, &format!("z = {}", w.teeth)));
        return g.add(arrow(c, r + 9.0, [2.0, 2.45], w.turns));
    }
    for (body, b) in w.bodies.iter().enumerate() {
        let c = at.at(b.centre_mm);
        let r = w.root_radius_mm * at.scale;
        g = g.add(badge(c.0, c.1, &key));
        if body == 0 && r > 46.0 {
            let over = |t| halo(t, &colour(w.colour, 0.24), 3.0);
            g = g
                .add(over(text(c.0, c.1 - 28.0, 12.0, Anchor::Middle, &fit(own(view, &w.name), 1.5 * r, 12.0))))
                .add(over(text(c.0, c.1 - 14.0, 12.0, Anchor::Middle, &format!("z = {}", w.teeth))));
        }
        if r > 24.0 {
            g = g.add(arrow(c, (0.55 * r).clamp(16.0, 60.0), [3.6, 5.2], w.turns));
        }
    }
    g
}

/// An arc with a head at the end to which it turns; angles counterclockwise.
fn arrow(centre: (f64, f64), radius: f64, [from, to]: [f64; 2], turns: f64) -> Group {
    let g = Group::new();
    if turns == 0.0 {
        return g;
    }
    let (start, end) = if turns > 0.0 { (from, to) } else { (to, from) };
    let at = |r: f64, angle: f64| (centre.0 + r * angle.cos(), centre.1 - r * angle.sin());
    let (a, b) = (at(radius, start), at(radius, end));
    let sweep = i32::from(turns < 0.0);
    let d = format!(
        "M{} {} A{r} {r} 0 0 {sweep} {} {}",
        number(a.0),
        number(a.1),
        number(b.0),
        number(b.1),
        r = number(radius)
    );
    // The head lies along the arc.
    let back = end - turns.signum() * 7.0 / radius;
    let points = [at(radius, end + turns.signum() * 3.0 / radius), at(radius - 3.6, back), at(radius + 3.6, back)];
    let words: Vec<String> = points.iter().map(|p| format!("{},{}", number(p.0), number(p.1))).collect();
    g.add(Path::new().set("d", d).set("fill", "none").set("stroke", INK).set("stroke-width", 1.6))
        .add(Polygon::new().set("points", words.join(" ")).set("fill", INK))
}

/// Tables and sentences; and where they end.
fn numbers(view: &Front, x: f64, y: f64, room: f64) -> (Group, f64) {
    let mut g = Group::new();
    let mut y = y + 14.0;
    let right = x + room.min(SIDE + 120.0);
    // Right edges of the columns.
    let columns =
        [("turns", 0.0), ("root mm", 62.0), ("tip mm", 124.0), ("ref. mm", 180.0), ("x", 234.0), ("z", 288.0)];
    let name_room = right - 322.0 - (x + 26.0);
    g = g.add(text(x + 26.0, y, 12.0, Anchor::Start, "wheel").set("fill", FAINT));
    for (head, from) in columns {
        g = g.add(text(right - from, y, 12.0, Anchor::End, head).set("fill", FAINT));
    }
    y += 6.0;
    g = g.add(guide(line((x, y), (right, y), LINE, 1.0)));
    for (k, w) in view.wheels.iter().enumerate() {
        y += 22.0;
        let mut row = Group::new()
            .add(rectangle(x + 12.0, y - 13.0, 22.0, 18.0, &colour(w.colour, 0.24)))
            .add(badge(x + 10.0, y - 4.0, &(k + 1).to_string()))
            .add(text(x + 40.0, y, 12.0, Anchor::Start, &fit(own(view, &w.name), name_room - 16.0, 12.0)));
        let turns = w.ratio.replace('-', "−");
        let turns = if wide(&turns, 12.0) > 54.0 { digits(w.turns) } else { turns };
        let cells = [
            turns,
            digits4(2.0 * w.root_radius_mm),
            digits4(2.0 * w.tip_radius_mm),
            digits4(2.0 * w.reference_radius_mm),
            digits(if w.shift.abs() < 1e-9 { 0.0 } else { w.shift }),
            w.teeth.to_string(),
        ];
        for (cell, (_, from)) in cells.iter().zip(columns) {
            row = row.add(text(right - from, y, 12.0, Anchor::End, cell));
        }
        g = g.add(of(row, "row", &[Of::Member(&w.name)]));
    }
    y += 12.0;
    g = g.add(guide(line((x, y), (right, y), LINE, 1.0)));
    let mut say = |g: Group, words: &str, ink: &str| {
        let mut g = g;
        for row in lines(words, room, 12.0) {
            y += 17.0;
            g = g.add(text(x, y, 12.0, Anchor::Start, &row).set("fill", ink));
        }
        y += 5.0;
        g
    };
    for m in &view.meshes {
        let words = format!(
            "{}: centre distance {} mm, operating pressure angle {}°, contact ratio {}, backlash {} mm",
            own(view, &m.name),
            digits4(m.centre_distance_mm),
            digits4(m.pressure_angle.to_degrees()),
            digits(m.contact_ratio),
            digits4(if m.backlash_mm.abs() < 5e-5 { 0.0 } else { m.backlash_mm })
        );
        g = say(g, &words, INK);
    }
    if let Some(words) = spacing(view) {
        g = say(g, &words, INK);
    }
    for note in &view.notes {
        g = say(g, note, INK);
    }
    let circles = format!(
        "Dash-dot: operating pitch circles. Dashed: tip and root circles. Straight grey lines: carrier. Diameters: reference, \
         tip, root. Arrows and turns: relative to the carrier, for one turn of wheel {}.",
        root(view) + 1
    );
    g = say(g, &circles, FAINT);
    let roots = "Flanks are involutes. Fillets: as a rack with a tip radius of 0.38 modules cuts them; of rings, rounded by 0.2 modules. The \
                 rim of a ring is not known.";
    g = say(g, roots, FAINT);
    (g, y)
}

/// How the planets stand, in words.
fn spacing(view: &Front) -> Option<String> {
    let s = &view.spacing;
    if view.kind == "pair" {
        return None;
    }
    let mut words = match (s.planets, s.equal) {
        (1, _) => "One planet.".to_owned(),
        (n, true) => format!("{n} planets, equally spaced."),
        (n, false) => {
            let all: Vec<String> = s.angles.iter().map(|a| format!("{}°", digits4(a.to_degrees()))).collect();
            format!("{n} planets do not fit at equal angles; drawn at {}.", all.join(", "))
        }
    };
    if let Some(least) = s.least_angle.filter(|_| s.planets > 1) {
        words.push_str(&format!(" Every angle is a multiple of {}°.", digits4(least.to_degrees())));
    }
    if let Some(gap) = s.clearance_mm {
        words.push_str(&match gap > 0.0 {
            true => format!(" Tips of neighbours are {} mm apart.", digits(gap)),
            false => format!(" Neighbours COLLIDE: their tips overlap by {} mm.", digits(-gap)),
        });
    }
    Some(words)
}

/// Five digits, as a drawing has them.
fn digits4(x: f64) -> String {
    let decimals = (4 - x.abs().max(1e-9).log10().floor() as i32).clamp(0, 4) as usize;
    let text = format!("{x:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.replace('-', "−")
}
