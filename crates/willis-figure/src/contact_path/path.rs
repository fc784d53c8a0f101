//! What happens along paths of contact, in panels one above the other.

use svg::node::element::{Group, Path};

use super::film::heading;
use super::{ContactPath, MeshPath, PathPoint, contact_path};
use crate::kind::{self, Ask, Drawing, Kind};
use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, LINE, PAPER, colour, digits, fit, halo, line, lines, number, page, rectangle, text, ticks,
};
use crate::parts::words::law;

pub(crate) const KIND: Kind<ContactPath> = Kind {
    title: "Contact along its path",
    takes: &[Ask::Operation, Ask::Part],
    effort: kind::of_operations,
    applies: None,
    make: |s, r| contact_path(s.train(), r.operation.as_deref(), r.part.as_deref()),
    steps: None,
    draw: draw_on,
};

const LEFT: f64 = 76.0;
const EDGE: f64 = 28.0;
const TOP: f64 = 128.0;
/// Height of a panel, and from one to the next.
const PANEL: f64 = 106.0;
const STEP: f64 = 142.0;
/// Between columns.
const GAP: f64 = 26.0;
/// The least width of a column.
const NARROWEST: f64 = 250.0;
/// Columns that are drawn.
const MOST: usize = 4;

/// A curve of a panel: how a point reads, and whether it is dashed.
type Curve = (fn(&PathPoint) -> Option<f64>, bool);

/// A quantity, with its unit.
struct Row {
    title: &'static str,
    curves: &'static [Curve],
    /// Whether the area under it means something: that is filled.
    area: bool,
}

const ROWS: [Row; 5] = [
    Row { title: "line load, N/mm", curves: &[(|p| Some(p.line_load_n_per_m / 1e3), false)], area: false },
    Row {
        title: "sliding speed (solid), rolling speed (dashed), m/s",
        curves: &[(|p| Some(p.sliding_m_s), false), (|p| Some(p.sum_speed_m_s / 2.0), true)],
        area: false,
    },
    Row { title: "film thickness, µm", curves: &[(|p| p.film_m.map(|h| h * 1e6), false)], area: false },
    Row { title: "coefficient of friction", curves: &[(|p| p.friction, false)], area: false },
    Row { title: "local power loss of one tooth pair, W", curves: &[(|p| p.loss_w, false)], area: true },
];

/// Load, speeds, film, friction and loss of a tooth pair along the path of contact: a column for
/// each mesh, four at most.
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
/// let svg = willis_figure::draw_path(&path);
/// assert!(svg.contains("coefficient of friction") && svg.contains("sliding loss"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(path: &ContactPath) -> String {
    draw_on(path, Drawing::default())
}

fn draw_on(path: &ContactPath, paper: Drawing) -> String {
    let shown = &path.meshes[..path.meshes.len().min(MOST)];
    let n = shown.len().max(1) as f64;
    let column = match shown.len() {
        0 | 1 => 640.0,
        2 => 480.0,
        3 => 390.0,
        _ => 300.0,
    };
    let beside = LEFT + (n - 1.0) * GAP + EDGE;
    let width = paper.page(beside + n * column, beside + n * NARROWEST);
    let column = (width - beside) / n;
    let ends = |k: usize| shown.iter().map(move |m| m.breakpoints_mm[k]);
    let (from, to) = (ends(0).fold(0.0, f64::min), ends(4).fold(0.0, f64::max));
    let margin = 0.04 * (to - from);
    let (from, to) = (from - margin, to + margin);
    let bottom = TOP + (ROWS.len() - 1) as f64 * STEP + PANEL;
    let mut g = Group::new();
    for (k, m) in shown.iter().enumerate() {
        let left = LEFT + k as f64 * (column + GAP);
        let x = |s: f64| left + (s - from) / (to - from) * column;
        g = g
            .add(text(left, 92.0, 13.0, Anchor::Start, &fit(&m.name, column / BOLD, 13.0)).set("font-weight", "bold"))
            .add(of(breaks(m, &x, bottom), "breaks", &[Of::Mesh(&m.name)]));
        for (r, row) in ROWS.iter().enumerate() {
            let top = TOP + r as f64 * STEP;
            g = g.add(panel(row, shown, k, top, (left, left + column), &x));
        }
        for t in ticks(from, to, (column / 45.0) as usize) {
            g = g
                .add(guide(line((x(t), bottom), (x(t), bottom + 4.0), LINE, 1.0)))
                .add(text(x(t), bottom + 17.0, 11.0, Anchor::Middle, &digits(t)).set("fill", FAINT));
        }
        let driver = format!("s, mm; {} drives, contact runs {}", m.gears[m.driver], ["A to E", "E to A"][m.driver]);
        g = g.add(text(left + column / 2.0, bottom + 36.0, 12.0, Anchor::Middle, &fit(&driver, column, 12.0)));
    }
    let mut end = bottom + 40.0;
    let mut deepest = end;
    for (k, m) in shown.iter().enumerate() {
        let left = LEFT + k as f64 * (column + GAP);
        let mut y = end;
        for row in lines(&balance(m), column, 12.0) {
            y += 17.0;
            g = g.add(text(left, y, 12.0, Anchor::Start, &row));
        }
        deepest = f64::max(deepest, y);
    }
    end = deepest + 10.0;
    for words in remarks(path, shown.len()) {
        for row in lines(&words, width - LEFT - EDGE, 12.0) {
            end += 17.0;
            g = g.add(text(LEFT, end, 12.0, Anchor::Start, &row).set("fill", FAINT));
        }
    }
    page(width, end + 22.0, &format!("Paths of contact of {}", path.title), &description(path, shown))
        .add(heading(path, width, &format!("friction: {}, film: {}", law(&path.friction_law), law(&path.film_law))))
        .add(g)
        .to_string()
}

fn description(path: &ContactPath, shown: &[MeshPath]) -> String {
    let all: Vec<String> = shown
        .iter()
        .map(|m| {
            let [a, .., e] = m.breakpoints_mm;
            let friction = m.friction.map_or(String::new(), |mu| format!(", mean friction {}", digits(mu)));
            format!(
                "{} from {} to {} mm around the pitch point{friction}, sliding loss {} W",
                m.name,
                digits(a),
                digits(e),
                digits(m.sliding_loss_w)
            )
        })
        .collect();
    format!(
        "Line load, sliding and rolling speed, film thickness, friction and local loss of a tooth pair along the path of \
         contact at operating point {}: {}.",
        path.operation,
        all.join("; ")
    )
}

/// What the local loss adds up to.
fn balance(m: &MeshPath) -> String {
    let pairs = if m.count > 1 { format!(", {} pairs in parallel", m.count) } else { String::new() };
    match m.integrated_loss_w {
        None => format!(
            "Sliding loss {} W{pairs}, by the efficiency given: no friction is computed.",
            digits(m.sliding_loss_w)
        ),
        Some(_) if m.adds_up() => {
            format!("Sliding loss {} W{pairs}: the local loss, integrated along the path.", digits(m.sliding_loss_w))
        }
        Some(own) => format!(
            "Sliding loss {} W{pairs} by the law of the loss factor, which shares the load otherwise; the local loss \
             integrates to {} W.",
            digits(m.sliding_loss_w),
            digits(own)
        ),
    }
}

fn remarks(path: &ContactPath, shown: usize) -> Vec<String> {
    let mut all = Vec::new();
    all.push(match path.local {
        true => format!("The law of {} gives friction for each place of the path.", law(&path.friction_law)),
        false => format!(
            "The law of {} gives one mean coefficient for the mesh; what friction is at each place is not known.",
            law(&path.friction_law)
        ),
    });
    all.push(
        "s: distance from the pitch point C along the line of action, positive towards the addendum of the mesh's first \
         gear. Spur teeth: single contact from B to D."
            .to_owned(),
    );
    if shown < path.meshes.len() {
        let rest: Vec<&str> = path.meshes[shown..].iter().map(|m| m.name.as_str()).collect();
        all.push(format!("{MOST} meshes are shown; name one of the others to see it: {}.", rest.join(", ")));
    }
    all.extend(path.left_out.iter().map(|words| format!("Not shown: {words}.")));
    all
}

/// The points A to E through all panels.
fn breaks(m: &MeshPath, x: &dyn Fn(f64) -> f64, bottom: f64) -> Group {
    let mut g = Group::new();
    let single = (1.0..=2.0).contains(&m.contact_ratio);
    let mut taken: Vec<f64> = Vec::new();
    for k in [2, 0, 4, 1, 3] {
        if !single && (k == 1 || k == 3) {
            continue;
        }
        let at = x(m.breakpoints_mm[k]);
        let l = line((at, TOP - 14.0), (at, bottom), if k == 2 { FAINT } else { LINE }, 0.8);
        g = g.add(l.set("stroke-dasharray", if k == 2 { "10 3 2 3" } else { "2 3" }));
        if taken.iter().all(|t| (t - at).abs() > 13.0) {
            taken.push(at);
            let letter = ["A", "B", "C", "D", "E"][k];
            g = g.add(text(at, TOP - 18.0, 12.0, Anchor::Middle, letter).set("font-weight", "bold"));
        }
    }
    g
}

/// One quantity of one mesh; its axis is that of all meshes.
fn panel(
    row: &Row,
    shown: &[MeshPath],
    k: usize,
    top: f64,
    (left, right): (f64, f64),
    x: &dyn Fn(f64) -> f64,
) -> Group {
    let values = shown.iter().flat_map(|m| m.points.iter().flat_map(|p| row.curves.iter().filter_map(|c| (c.0)(p))));
    let high = values.fold(0.0, f64::max);
    let bottom = top + PANEL;
    let mut g = Group::new();
    let scale = if high > 0.0 { high * 1.1 } else { 1.0 };
    let y = |v: f64| bottom - v / scale * PANEL;
    for t in ticks(0.0, scale, 4) {
        g = g.add(guide(line((left, y(t)), (right, y(t)), "#e4e4e4", 1.0)));
        if k == 0 {
            g = g.add(text(left - 6.0, y(t) + 4.0, 11.0, Anchor::End, &digits(t)).set("fill", FAINT));
        }
    }
    let m = &shown[k];
    let mut drawn = false;
    let mut own = of(Group::new(), "curve", &[Of::Mesh(&m.name), Of::Quantity(row.title)]);
    for (get, dashed) in row.curves {
        // Where there is no value the line breaks.
        for piece in m.points.split(|p| get(p).is_none()) {
            let all: Vec<String> =
                piece.iter().filter_map(|p| Some(format!("{} {}", number(x(p.s_mm)), number(y(get(p)?))))).collect();
            let (Some(first), Some(last)) = (piece.first(), piece.last()) else { continue };
            if all.len() < 2 {
                continue;
            }
            drawn = true;
            if row.area {
                let d = format!(
                    "M{} {} L{} L{} {}Z",
                    number(x(first.s_mm)),
                    number(bottom),
                    all.join(" L"),
                    number(x(last.s_mm)),
                    number(bottom)
                );
                own = own.add(Path::new().set("d", d).set("fill", colour(Some(k), 0.25)));
            }
            let mut line = Path::new()
                .set("d", format!("M{}", all.join(" L")))
                .set("fill", "none")
                .set("stroke", colour(Some(k), 1.0))
                .set("stroke-width", 2)
                .set("stroke-linejoin", "round");
            if *dashed {
                line = line.set("stroke-dasharray", "6 3");
            }
            own = own.add(line);
        }
    }
    g = g.add(own);
    if !drawn {
        let words = "not computed: the efficiency is given";
        let t = text((left + right) / 2.0, top + PANEL / 2.0 + 4.0, 11.0, Anchor::Middle, words);
        g = g.add(halo(t.set("fill", FAINT), PAPER, 4.0));
    }
    g = g.add(guide(rectangle(left, top, right - left, PANEL, "none").set("stroke", LINE).set("stroke-width", 1)));
    if k == 0 {
        let title = text(left, top - 5.0, 12.0, Anchor::Start, &fit(row.title, right - left, 12.0));
        g = g.add(halo(title, PAPER, 4.0));
    }
    g
}
