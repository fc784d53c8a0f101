//! The film thickness ratio along paths of contact.

use svg::node::element::{Circle, Group, Path};

use super::{ContactPath, MeshPath, contact_path};
use crate::kind::{self, Ask, Drawing, Kind};
use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, digits, fit, halo, line, lines, number, page, rectangle, text,
    ticks, wide,
};
use crate::parts::words::{law, spelled};

pub(crate) const KIND: Kind<ContactPath> = Kind {
    title: "Oil film along the path of contact",
    takes: &[Ask::Operation, Ask::Part],
    effort: kind::of_operations,
    applies: None,
    make: |s, r| contact_path(s.train(), r.operation.as_deref(), r.part.as_deref()),
    steps: None,
    draw: draw_on,
};

const WIDTH: f64 = 1080.0;
const NARROWEST: f64 = 640.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 112.0;
/// Distance of two labels at the curves.
const LABEL: f64 = 34.0;
/// Lines of several meshes are told apart by these, beside their colour.
pub(crate) const DASHES: [&str; 4] = ["none", "8 3", "3 2", "10 3 2 3"];

/// The film thickness ratio λ along the path of contact of every mesh, with the regimes of
/// lubrication behind it.
///
/// # Example
/// ```
/// # use willis::train::{GeometrySpec, OilSpec, OperationSpec, SetSpec, Train};
/// # use willis::units::{AngularSpeed, Length, Torque};
/// # let geometry = GeometrySpec::new(Length::mm(4.0), Length::mm(50.0));
/// # let train = Train::builder("stage")
/// #     .members(["s", "c"])
/// #     .terminals(["s", "c"])
/// #     .oil(OilSpec { name: Some("ISO VG 100".into()), ..OilSpec::default() })
/// #     .set(SetSpec::simple("P1", ("s", 17), ("frame", 61), "c").planet(22, 3).geometry(geometry))
/// #     .operation(
/// #         OperationSpec::new("rated")
/// #             .speed("s", AngularSpeed::rpm(1500.0))
/// #             .torque("s", Torque::n_m(1500.0)),
/// #     )
/// #     .build()?;
/// let path = willis_figure::contact_path(&train, None, None)?;
/// let svg = willis_figure::draw_film(&path);
/// assert!(svg.contains("mixed") && svg.contains("P1.sun-planet"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(path: &ContactPath) -> String {
    draw_on(path, Drawing::default())
}

fn draw_on(path: &ContactPath, paper: Drawing) -> String {
    let width = paper.page(WIDTH, NARROWEST);
    // Beside the chart: the names of the meshes.
    let right = width - (0.26 * width).max(210.0);
    let count = path.meshes.len() as f64;
    let bottom = TOP + (LABEL * count).max(400.0);
    let ratios = || path.meshes.iter().flat_map(|m| m.points.iter().filter_map(|p| p.film_ratio));
    let low = ratios().fold(f64::INFINITY, f64::min).min(path.limits[0]) / 2.0;
    let high = ratios().fold(0.0, f64::max).max(path.limits[1]) * 1.6;
    let ends = |k: usize| path.meshes.iter().map(move |m| m.breakpoints_mm[k]);
    let (from, to) = (ends(0).fold(0.0, f64::min), ends(4).fold(0.0, f64::max));
    let margin = 0.04 * (to - from);
    let (from, to) = (from - margin, to + margin);
    let x = |s: f64| LEFT + (s - from) / (to - from) * (right - LEFT);
    let y = |ratio: f64| bottom - (ratio / low).ln() / (high / low).ln() * (bottom - TOP);

    let mut g = Group::new();
    let [mixed, full] = path.limits;
    let bands = [
        (low, mixed, 0.30, "boundary: asperities carry the load"),
        (mixed, full, 0.16, "mixed: asperities and film share it"),
        (full, high, 0.05, "full film"),
    ];
    for (a, b, strength, words) in bands {
        let band = rectangle(LEFT, y(b), right - LEFT, y(a) - y(b), &colour(None, strength));
        g = g.add(of(band, "band", &[Of::Quantity(&format!("film_ratio {words}"))]));
    }
    for t in log_ticks(low, high) {
        g = g
            .add(guide(line((LEFT - 4.0, y(t)), (LEFT, y(t)), LINE, 1.0)))
            .add(text(LEFT - 8.0, y(t) + 4.0, 11.0, Anchor::End, &digits(t)).set("fill", FAINT));
    }
    for t in ticks(from, to, 9) {
        g = g
            .add(guide(line((x(t), bottom), (x(t), bottom + 4.0), LINE, 1.0)))
            .add(text(x(t), bottom + 17.0, 11.0, Anchor::Middle, &digits(t)).set("fill", FAINT));
    }
    for limit in path.limits {
        g = g.add(guide(line((LEFT, y(limit)), (right, y(limit)), INK, 1.2)));
    }
    g = g
        .add(guide(line((x(0.0), TOP), (x(0.0), bottom), FAINT, 1.0).set("stroke-dasharray", "10 3 2 3")))
        .add(text(x(0.0), TOP - 6.0, 12.0, Anchor::Middle, "C").set("font-weight", "bold"));
    for (k, m) in path.meshes.iter().enumerate() {
        g = g.add(of(curve(m, k, &x, &y), "curve", &[Of::Mesh(&m.name), Of::Quantity("film_ratio")]));
    }
    // Words of the bands over the curves, where none should be.
    for (a, b, _, words) in bands {
        let at = if a == full {
            y(b) + 16.0
        } else if b == mixed {
            y(a) - 7.0
        } else {
            y(b) + 16.0
        };
        g = g.add(halo(text(LEFT + 8.0, at, 12.0, Anchor::Start, words).set("fill", FAINT), PAPER, 3.0));
    }
    g = g
        .add(guide(rectangle(LEFT, TOP, right - LEFT, bottom - TOP, "none").set("stroke", LINE).set("stroke-width", 1)))
        .add(labels(path, &x, &y, [right, width, bottom]))
        .add(text(LEFT, TOP - 24.0, 12.0, Anchor::Start, "film thickness over composite roughness λ"));
    let along =
        "distance s from the pitch point C along the line of action, mm; s > 0: addendum of the mesh's first gear";
    let mut end = bottom + 22.0;
    for row in lines(along, (right - LEFT).max(width - 2.0 * LEFT).min(716.0), 12.0) {
        end += 16.0;
        g = g.add(text((LEFT + right) / 2.0, end, 12.0, Anchor::Middle, &row));
    }
    for words in &path.left_out {
        for row in lines(&format!("Not shown: {words}."), width - 56.0, 12.0) {
            end += 18.0;
            g = g.add(text(28.0, end, 12.0, Anchor::Start, &row).set("fill", FAINT));
        }
    }
    page(width, end + 22.0, &format!("Oil film of {}", path.title), &description(path))
        .add(heading(path, width, &format!("law of the film: {}", law(&path.film_law))))
        .add(g)
        .to_string()
}

/// Title and subtitle.
pub(crate) fn heading(path: &ContactPath, width: f64, laws: &str) -> Group {
    let title = format!("{}: {}", path.title, path.operation);
    let caption = format!("oil {}; temperature {} °C; {laws}", spelled(&path.oil), digits(path.temperature_celsius));
    Group::new()
        .add(
            text(28.0, 38.0, 20.0, Anchor::Start, &fit(&title, (width - 56.0) / BOLD, 20.0)).set("font-weight", "bold"),
        )
        .add(text(28.0, 60.0, 13.0, Anchor::Start, &fit(&caption, width - 56.0, 13.0)).set("fill", FAINT))
}

fn regime(path: &ContactPath, ratio: f64) -> &'static str {
    match ratio {
        r if r < path.limits[0] => "boundary",
        r if r < path.limits[1] => "mixed",
        _ => "full film",
    }
}

fn description(path: &ContactPath) -> String {
    let all: Vec<String> = path
        .meshes
        .iter()
        .filter_map(|m| {
            let least = m.least_film_ratio()?;
            Some(format!("{} at least {} ({})", m.name, digits(least), regime(path, least)))
        })
        .collect();
    format!(
        "Film thickness over roughness along the path of contact at operating point {}: {}.",
        path.operation,
        all.join("; ")
    )
}

fn curve(m: &MeshPath, k: usize, x: &dyn Fn(f64) -> f64, y: &dyn Fn(f64) -> f64) -> Group {
    let mut g = Group::new();
    let points: Vec<String> =
        m.points.iter().filter_map(|p| Some(format!("{} {}", number(x(p.s_mm)), number(y(p.film_ratio?))))).collect();
    if points.len() < 2 {
        return g;
    }
    g = g.add(
        Path::new()
            .set("d", format!("M{}", points.join(" L")))
            .set("fill", "none")
            .set("stroke", colour(Some(k), 1.0))
            .set("stroke-width", 2.4)
            .set("stroke-linejoin", "round")
            .set("stroke-dasharray", DASHES[k % DASHES.len()]),
    );
    let least = m.points.iter().filter_map(|p| Some((p.s_mm, p.film_ratio?))).min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((s, ratio)) = least {
        g = g.add(
            Circle::new()
                .set("cx", number(x(s)))
                .set("cy", number(y(ratio)))
                .set("r", 4)
                .set("fill", PAPER)
                .set("stroke", colour(Some(k), 1.0))
                .set("stroke-width", 2),
        );
    }
    g
}

/// Names at the ends of the curves, spread so that none covers another.
fn labels(
    path: &ContactPath,
    x: &dyn Fn(f64) -> f64,
    y: &dyn Fn(f64) -> f64,
    [right, width, bottom]: [f64; 3],
) -> Group {
    let mut g = Group::new();
    let mut all: Vec<(usize, f64, f64)> = path
        .meshes
        .iter()
        .enumerate()
        .filter_map(|(k, m)| {
            let p = m.points.iter().rev().find(|p| p.film_ratio.is_some())?;
            Some((k, x(p.s_mm), y(p.film_ratio?)))
        })
        .collect();
    all.sort_by(|a, b| a.2.total_cmp(&b.2).then(a.0.cmp(&b.0)));
    // From above, each below the one before; then the last ones back up.
    let mut places: Vec<f64> = Vec::new();
    for (_, _, at) in &all {
        places.push(places.last().map_or(at.max(TOP + 8.0), |last: &f64| at.max(last + LABEL)));
    }
    let mut most = bottom - 16.0;
    for p in places.iter_mut().rev() {
        *p = p.min(most);
        most = *p - LABEL;
    }
    for ((k, end, at), place) in all.into_iter().zip(places) {
        let m = &path.meshes[k];
        let x = right + 24.0;
        let least = m.least_film_ratio().unwrap_or(0.0);
        let words = format!("least λ {}: {}", digits(least), regime(path, least));
        let own = Group::new()
            .add(line((end, at), (x - 4.0, place), colour(Some(k), 1.0).as_str(), 0.8))
            .add(
                text(x, place + 4.0, 13.0, Anchor::Start, &fit(&m.name, (width - 14.0 - x) / BOLD, 13.0))
                    .set("font-weight", "bold"),
            )
            .add(text(x, place + 19.0, 11.0, Anchor::Start, &words).set("fill", FAINT));
        g = g.add(of(own, "name", &[Of::Mesh(&m.name)]));
        debug_assert!(wide(&words, 11.0) < width - x);
    }
    g
}

/// 1, 2, 3 and 5 times powers of ten.
fn log_ticks(low: f64, high: f64) -> Vec<f64> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let steps: &[f64] = if last - first > 3 { &[1.0] } else { &[1.0, 2.0, 3.0, 5.0] };
    (first..=last)
        .flat_map(|e| steps.iter().map(move |s| s * 10f64.powi(e)))
        .filter(|t| *t >= low * 0.999 && *t <= high * 1.001)
        .collect()
}
