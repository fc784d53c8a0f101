//! The nomograph of a train: levers side by side.

mod detail;

use svg::node::element::{Circle, Group, Path};

use crate::parts::alive::{Of, guide, of};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, digits, figures, fit, halo, line, lines, number, page, rectangle,
    text, ticks, wide,
};
use crate::{Drawing, Lever, LeverBar, LeverCase, LeverNode, LeverPull, LeverRole, LeverSet};

const MARGIN: f64 = 28.0;
const WIDEST: f64 = 1400.0;
/// One lever takes so much.
const NARROWEST: f64 = 640.0;
/// Column of names and speeds.
const NAMES: f64 = 100.0;
/// Least width of the column of forces, one for each set.
const FORCES: f64 = 106.0;
const GAP: f64 = 10.0;
/// Room beside the speeds: signs of held members, dots.
const PAD: f64 = 19.0;
const LONGEST_ARROW: f64 = 44.0;
/// Height of a name with its speed.
const BLOCK: f64 = 30.0;
/// Room above and below the levers: planets, letters, scales.
const ABOVE: f64 = 62.0;
const BELOW: f64 = 88.0;
/// Planets are drawn this far beyond the ends of their lever, in parts of the picture.
const BEYOND: f64 = 0.06;
const MOST_CASES: usize = 14;
pub(super) const RPM: f64 = 30.0 / std::f64::consts::PI;
const GUIDE: &str = "#ececec";
const DASHES: [&str; 7] = ["none", "8 3", "3 3", "10 3 3 3", "14 4", "6 2 2 2 2 2", "2 5"];

/// What all levers of a picture share.
struct View<'a> {
    lever: &'a Lever,
    /// The widest page.
    widest: f64,
    /// Number of cases drawn.
    cases: usize,
    /// Units of the picture in one of the data.
    factor: f64,
    low: f64,
    high: f64,
    speeds: f64,
    height: f64,
    largest: f64,
    /// The unit of all torques: how many of it are one of the data, and its name.
    torque: (f64, &'static str),
    /// Width of a column of forces.
    forces: f64,
    /// Room for the name of a case above its line.
    letters: f64,
}

/// The levers of a train: height by tooth numbers, speeds as displacements, torques as arrows at the
/// points to which friction moves them.
///
/// # Example
/// ```
/// use willis_figure::{LeverRequest, lever};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
///     .build()?;
/// let picture = willis_figure::draw_lever(&lever(&train, &LeverRequest::First)?);
/// assert!(picture.starts_with("<svg"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(lever: &Lever) -> String {
    draw_on(lever, Drawing::default())
}

pub(super) fn draw_on(lever: &Lever, paper: Drawing) -> String {
    let v = View::new(lever, paper.page(WIDEST, NARROWEST));
    let rows = rows(&v);
    let content =
        rows.iter().map(|r| r.iter().map(|k| v.width(&lever.bars[*k]) + GAP).sum::<f64>()).fold(0.0, f64::max);
    // A long title may widen the page somewhat.
    let title = wide(&lever.title, 20.0) * BOLD;
    let width = (content.max(title.min(1000.0).min(v.widest - 2.0 * MARGIN)) + 2.0 * MARGIN).max(720.0);
    let inner = width - 2.0 * MARGIN;

    let mut g = Group::new();
    let mut y = 60.0;
    for (k, row) in caption(&v).iter().flat_map(|c| lines(c, inner, 13.0)).enumerate() {
        g = g.add(text(MARGIN, y, 13.0, Anchor::Start, &row).set("fill", FAINT));
        y = 60.0 + 18.0 * (k + 1) as f64;
    }
    let mut top = y + 2.0;
    g = g.add(across(&v, &rows, top, content));
    for row in &rows {
        g = g.add(levers(&v, row, top));
        top += ABOVE + v.height + BELOW;
    }
    let (key, bottom) = key(&v, top, inner);
    let height = bottom + 16.0;
    page(width, height, &format!("Levers of {}", lever.title), &words(&v))
        .add(text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&lever.title, inner / BOLD, 20.0)).set("font-weight", "bold"))
        .add(g)
        .add(key)
        .to_string()
}

/// The levers in rows, about equally many in each.
fn rows(v: &View<'_>) -> Vec<Vec<usize>> {
    let broken = |room: f64| {
        let mut rows: Vec<Vec<usize>> = vec![vec![]];
        let mut used = 0.0;
        for (k, bar) in v.lever.bars.iter().enumerate() {
            let width = v.width(bar) + GAP;
            if used > 0.0 && used + width > room {
                rows.push(vec![]);
                used = 0.0;
            }
            used += width;
            rows.last_mut().expect("never empty").push(k);
        }
        rows
    };
    let widest = v.widest - 2.0 * MARGIN;
    let first = broken(widest);
    // The narrowest page that needs no row more.
    (1..=20).map(|k| broken(widest * f64::from(k) / 20.0)).find(|r| r.len() == first.len()).unwrap_or(first)
}

impl<'a> View<'a> {
    fn new(lever: &'a Lever, widest: f64) -> Self {
        let cases = lever.cases.len().min(MOST_CASES);
        let factor = if lever.unit.is_some() { 1.0 } else { RPM };
        let nodes = lever.bars.iter().flat_map(|b| &b.nodes).filter(|n| n.roles != [LeverRole::Planet]);
        let speeds = nodes.flat_map(|n| &n.speeds[..cases]).flatten();
        let (low, high) = speeds.fold((0.0f64, 0.0f64), |(l, h), w| (l.min(w * factor), h.max(w * factor)));
        let high = if low == high { low + 1.0 } else { high };
        let most = lever.bars.iter().map(|b| shown(b).count()).max().unwrap_or(0);
        // Few levers have wide scales, many have narrow ones.
        let columns: usize = lever.bars.iter().map(|b| if lever.torques { b.sets.len() } else { 0 }).sum();
        let pulls = || lever.bars.iter().flat_map(|b| &b.sets).flat_map(|s| &s.pulls);
        let largest = pulls().fold(0.0f64, |a, p| a.max(p.torque.abs()));
        let torque = if lever.unit.is_some() { (1.0, "") } else { unit_of_torques(largest) };
        // Values stand on both sides of the lever.
        let values = pulls().map(|p| wide(&figures(p.torque * torque.0, 4), 11.0) + 9.0);
        let forces = values.fold(FORCES / 2.0, f64::max) * 2.0;
        // No higher on narrow paper than it is wide.
        let height = (BLOCK * most as f64).max((0.23 * widest).min(360.0));
        let details = |b: &LeverBar| near(b, height).len();
        let height = lever.bars.iter().map(|b| detail::height(details(b))).fold(height, f64::max);
        let detailed = lever.bars.iter().filter(|b| details(b) > 0).count() as f64 * detail::ROOM;
        let fixed = lever.bars.len() as f64 * (NAMES + 2.0 * PAD + GAP) + columns as f64 * forces + detailed;
        let letters = lever.cases[..cases].iter().map(|c| wide(&c.letter, 12.0) * BOLD + 4.0).fold(14.0, f64::max);
        let least = if cases > 1 { f64::max(letters * cases as f64, 150.0) } else { 80.0 };
        let room = (widest - 2.0 * MARGIN - fixed) / lever.bars.len() as f64;
        let speeds = room.clamp(least, f64::max(least, if cases > 1 { 340.0 } else { 260.0 }));
        Self { lever, widest, cases, factor, low, high, speeds, height, largest, torque, forces, letters }
    }

    fn width(&self, bar: &LeverBar) -> f64 {
        let detail = if near(bar, self.height).is_empty() { 0.0 } else { detail::ROOM };
        self.plain_width(bar) + detail
    }

    /// Without details.
    fn plain_width(&self, bar: &LeverBar) -> f64 {
        NAMES + 2.0 * PAD + self.speeds + if self.lever.torques { self.forces * bar.sets.len() as f64 } else { 0.0 }
    }

    /// From the left edge of a lever's panel.
    fn x(&self, bar: &LeverBar, speed: f64) -> f64 {
        let (low, high) = self.range(bar);
        NAMES + PAD + (speed - low) / (high - low) * self.speeds
    }

    /// The scale of speeds of a lever: that of the picture, or its own where nothing of it could be seen there.
    fn range(&self, bar: &LeverBar) -> (f64, f64) {
        /// How much of the common scale is enough.
        const SEEN: f64 = 0.12;
        let nodes = bar.nodes.iter().filter(|n| !planet(n));
        let own = nodes.flat_map(|n| &n.speeds[..self.cases]).flatten().map(|w| w * self.factor);
        let (low, high) = own.fold((0.0f64, 0.0f64), |(l, h), w| (l.min(w), h.max(w)));
        match high - low {
            spread if spread > 1e-9 * (self.high - self.low) && spread < SEEN * (self.high - self.low) => (low, high),
            _ => (self.low, self.high),
        }
    }

    fn own_scale(&self, bar: &LeverBar) -> bool {
        self.range(bar) != (self.low, self.high)
    }

    fn y(&self, position: f64) -> f64 {
        ABOVE + (1.0 - position) * self.height
    }

    fn readable(&self, speed: f64) -> String {
        match self.lever.unit {
            Some(_) => exactly(speed),
            None => format!("{} rpm", digits(speed)),
        }
    }

    /// A torque in the unit of the picture; round-off is none.
    fn pull(&self, p: &LeverPull) -> String {
        if p.torque.abs() > 1e-9 * self.largest { figures(p.torque * self.torque.0, 4) } else { "0".to_owned() }
    }

    fn speed(&self, node: &LeverNode, case: usize) -> Option<f64> {
        node.speeds[case].map(|w| w * self.factor)
    }
}

/// One unit for all torques of a picture, by the largest of them in N m.
pub(super) fn unit_of_torques(largest: f64) -> (f64, &'static str) {
    match largest {
        x if x >= 1e7 => (1e-6, "MN m"),
        x if x >= 1e4 => (1e-3, "kN m"),
        x if x > 0.0 && x < 0.1 => (1e3, "mN m"),
        _ => (1.0, "N m"),
    }
}

/// Points that are drawn: planets only where they stand about where the others do.
pub(super) fn shown(bar: &LeverBar) -> impl Iterator<Item = &LeverNode> {
    let (low, high) = ends(bar);
    let range = low.position - BEYOND..=high.position + BEYOND;
    bar.nodes.iter().filter(move |n| !planet(n) || range.contains(&n.position))
}

/// Lowest and highest point of a lever.
pub(super) fn ends(bar: &LeverBar) -> (&LeverNode, &LeverNode) {
    let mut own = bar.nodes.iter().filter(|n| !planet(n));
    let high = own.next().expect("a lever has a carrier");
    (own.next_back().unwrap_or(high), high)
}

pub(super) fn planet(node: &LeverNode) -> bool {
    node.roles == [LeverRole::Planet]
}

/// Numbers as near as can be to the wished ones, at least so far apart, within limits.
pub(super) fn spread(wished: &[f64], gap: f64, limits: (f64, f64)) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wished.len()).collect();
    order.sort_by(|a, b| wished[*a].total_cmp(&wished[*b]));
    // Groups that touch move as one: their mean stays.
    let mut groups: Vec<(f64, usize)> = Vec::new();
    for (rank, &k) in order.iter().enumerate() {
        let mut new = (wished[k] - gap * rank as f64, 1);
        while let Some(last) = groups.last().copied().filter(|l| l.0 >= new.0) {
            groups.pop();
            let n = last.1 + new.1;
            new = ((last.0 * last.1 as f64 + new.0 * new.1 as f64) / n as f64, n);
        }
        groups.push(new);
    }
    let last = gap * wished.len().saturating_sub(1) as f64;
    let flat = groups.iter().flat_map(|(z, n)| std::iter::repeat_n(*z, *n));
    let mut found = vec![0.0; wished.len()];
    for (rank, (k, z)) in order.into_iter().zip(flat).enumerate() {
        found[k] = z.min(limits.1 - last).max(limits.0) + gap * rank as f64;
    }
    found
}

/// Of one case members have their colours, of several each case has one.
fn case_colour(v: &View<'_>, k: usize) -> String {
    if v.cases > 1 { colour(Some(k), 1.0) } else { FAINT.to_owned() }
}

/// The colour of a member in every kind of figure.
pub(super) fn own_colour(n: &LeverNode) -> String {
    n.colour.map_or(INK.to_owned(), |c| colour(Some(c), 1.0))
}

fn dashed(l: svg::node::element::Line, k: usize) -> svg::node::element::Line {
    if k.is_multiple_of(DASHES.len()) { l } else { l.set("stroke-dasharray", DASHES[k % DASHES.len()]) }
}

/// A row of levers and the links between them.
fn levers(v: &View<'_>, row: &[usize], top: f64) -> Group {
    let mut at = vec![None; v.lever.bars.len()];
    lefts(v, row).into_iter().for_each(|(k, left)| at[k] = Some(left));
    let lefts = at;
    let mut under = Group::new();
    for &k in row {
        let bar = &v.lever.bars[k];
        let left = lefts[k].expect("just placed");
        for n in shown(bar) {
            let y = top + v.y(n.position);
            under = under.add(guide(line((left + NAMES, y), (left + v.plain_width(bar), y), GUIDE, 1.0)));
        }
    }
    for (nth, link) in v.lever.links.iter().enumerate() {
        let here: Vec<(f64, f64)> = link
            .points
            .iter()
            .filter_map(|[b, n]| {
                Some((lefts[*b]? + v.x(&v.lever.bars[*b], 0.0), top + v.y(v.lever.bars[*b].nodes[*n].position)))
            })
            .collect();
        let own = here.windows(2).map(|w| line(w[0], w[1], FAINT, 1.2).set("stroke-dasharray", "6 4"));
        let word = format!("link{nth}-{}", row.first().copied().unwrap_or(0));
        under = under.add(of(own.fold(Group::new(), Group::add), &word, &[Of::Member(&link.member)]));
    }
    row.iter().fold(under, |g, &k| {
        let left = lefts[k].expect("just placed");
        g.add(panel(v, &v.lever.bars[k]).set("transform", format!("translate({} {})", number(left), number(top))))
    })
}

/// The left edge of each lever of a row.
fn lefts(v: &View<'_>, row: &[usize]) -> Vec<(usize, f64)> {
    let mut at = MARGIN;
    let mut all = Vec::with_capacity(row.len());
    for &k in row {
        all.push((k, at));
        at += v.width(&v.lever.bars[k]) + GAP;
    }
    all
}

/// Links from a row of levers to the next: round their ends, each on a way of its own.
fn across(v: &View<'_>, rows: &[Vec<usize>], top: f64, content: f64) -> Group {
    let mut g = Group::new();
    let tall = ABOVE + v.height + BELOW;
    let places: Vec<Vec<(usize, f64)>> = rows.iter().map(|row| lefts(v, row)).collect();
    let place = |[b, n]: [usize; 2]| {
        let (row, left) = places.iter().enumerate().find_map(|(r, all)| Some((r, all.iter().find(|p| p.0 == b)?.1)))?;
        Some((row, left + v.x(&v.lever.bars[b], 0.0), top + tall * row as f64 + v.y(v.lever.bars[b].nodes[n].position)))
    };
    let mut used = 0;
    for link in &v.lever.links {
        let all: Vec<(usize, f64, f64)> = link.points.iter().filter_map(|p| place(*p)).collect();
        for pair in all.windows(2).filter(|w| w[0].0 != w[1].0) {
            let [(row, x, y), (_, x_end, y_end)] = [pair[0], pair[1]];
            // Beside the rows and between them nothing stands.
            let aside = 4.0 + 4.0 * f64::from(used % 5);
            let right = MARGIN + content - GAP + aside;
            let between = top + tall * (row + 1) as f64 - 2.0 - aside / 2.0;
            let left = MARGIN - aside;
            let n = |x: f64, y: f64| format!("{} {}", number(x), number(y));
            let d = format!(
                "M{} L{} L{} L{} L{} L{}",
                n(x, y),
                n(right, y),
                n(right, between),
                n(left, between),
                n(left, y_end),
                n(x_end, y_end)
            );
            let way = Path::new().set("d", d).set("fill", "none").set("stroke", FAINT).set("stroke-width", 1.2);
            let way = way.set("stroke-dasharray", "6 4");
            g = g.add(of(way, &format!("across{used}"), &[Of::Member(&link.member)]));
            used += 1;
        }
    }
    g
}

fn panel(v: &View<'_>, bar: &LeverBar) -> Group {
    let width = v.width(bar);
    let name = bar.name();
    let head = fit(&name, (width - 8.0) / BOLD, 14.0);
    let mut g = Group::new()
        .add(
            text(NAMES + PAD - 14.0, 16.0, 14.0, Anchor::Start, &fit(&head, (width - NAMES - 12.0) / BOLD, 14.0))
                .set("font-weight", "bold"),
        )
        .add(guide(scale(v, bar)));
    let (last, first) = ends(bar);
    let rest = v.x(bar, 0.0);
    g = g.add(guide(line((rest, v.y(first.position)), (rest, v.y(last.position)), LINE, 3.5)));
    for case in 0..v.cases {
        if let (Some(a), Some(b)) = (v.speed(first, case), v.speed(last, case)) {
            let l =
                line((v.x(bar, a), v.y(first.position)), (v.x(bar, b), v.y(last.position)), &case_colour(v, case), 2.2);
            let about = [Of::Mesh(&name), Of::State(&v.lever.cases[case].name)];
            g = g.add(of(dashed(l, case), "lever", &about));
        }
    }
    let (low, high) = v.range(bar);
    for n in shown(bar) {
        for case in 0..v.cases {
            let Some(w) = v.speed(n, case).filter(|w| (low..=high).contains(w)) else { continue };
            if planet(n) && v.cases > 1 {
                continue;
            }
            let dot = Circle::new().set("cx", number(v.x(bar, w))).set("cy", number(v.y(n.position)));
            let ink = if v.cases > 1 { case_colour(v, case) } else { own_colour(n) };
            let dot = match planet(n) {
                true => dot.set("r", 2.6).set("fill", PAPER).set("stroke", ink).set("stroke-width", 1.2),
                false => dot.set("r", if v.cases > 1 { 3.4 } else { 4.2 }).set("fill", ink),
            };
            let about = [Of::Member(&n.member), Of::Mesh(&name), Of::State(&v.lever.cases[case].name)];
            g = g.add(of(dot, "speed", &about));
        }
        let own = [Of::Member(&n.member), Of::Mesh(&name)];
        let mut point = mark(rest, v.y(n.position), &n.roles);
        let held = |c: &LeverCase| c.held.contains(&n.member);
        if v.lever.cases[..v.cases].iter().any(held) {
            point = point.add(ground(rest - 6.0, v.y(n.position)));
        }
        g = g.add(of(point, "point", &own));
    }
    if v.cases > 1 {
        g = g.add(letters(v, bar, first));
    }
    g = g.add(names(v, bar));
    if v.lever.torques {
        for (k, set) in bar.sets.iter().enumerate() {
            let centre = NAMES + 2.0 * PAD + v.speeds + v.forces * (k as f64 + 0.5);
            g = g.add(forces(v, bar, set, centre, bar.sets.len() > 1));
        }
    }
    let near = near(bar, v.height);
    if near.is_empty() {
        return g;
    }
    let detailed = detail::Lever {
        name: &name,
        cases: &v.lever.cases[..v.cases],
        height: v.height,
        offset: &|n, case| Some(v.x(bar, v.speed(n, case)?) - rest),
        rest,
        y: &|position| v.y(position),
        case_colour: &|case| case_colour(v, case),
        own_colour,
        dashed,
        mark,
        spread,
    };
    g.add(detail::draw(&detailed, &near, v.plain_width(bar) + 8.0))
}

/// Groups of points of a lever that would cover each other.
fn near(bar: &LeverBar, height: f64) -> Vec<Vec<&LeverNode>> {
    detail::groups(shown(bar).filter(|n| !planet(n)), height)
}

/// The scale of speeds below a lever.
fn scale(v: &View<'_>, bar: &LeverBar) -> Group {
    let y = v.y(-BEYOND) + 8.0;
    let (low, high) = v.range(bar);
    let x = |w: f64| v.x(bar, w);
    let mut g = Group::new().add(line((x(low), y), (x(high), y), FAINT, 1.0));
    // A number must not run into the next.
    let mut free = f64::NEG_INFINITY;
    for t in ticks(low, high, 5) {
        let label = digits(t);
        let half = wide(&label, 11.0) / 2.0;
        g = g.add(line((x(t), y), (x(t), y + 4.0), FAINT, 1.0));
        if x(t) - half > free {
            g = g.add(text(x(t), y + 15.0, 11.0, Anchor::Middle, &label).set("fill", FAINT));
            free = x(t) + half + 4.0;
        }
    }
    let middle = (x(low) + x(high)) / 2.0;
    let caption = match &v.lever.unit {
        None => "ω, rpm".to_owned(),
        Some(input) => format!("ω / ω {}", fit(input, v.speeds + PAD - 30.0, 11.0)),
    };
    g = g.add(text(middle, y + 30.0, 11.0, Anchor::Middle, &caption).set("fill", FAINT));
    if v.own_scale(bar) {
        g = g.add(text(middle, y + 44.0, 11.0, Anchor::Middle, "own scale").set("font-weight", "bold"));
    }
    g
}

/// What a point is, by its shape: disc sun, circle ring, square carrier.
pub(super) fn mark(x: f64, y: f64, roles: &[LeverRole]) -> Group {
    let circle = |r: f64, fill: &str, stroke: f64| {
        let c = Circle::new().set("cx", number(x)).set("cy", number(y)).set("r", number(r)).set("fill", fill);
        c.set("stroke", INK).set("stroke-width", number(stroke))
    };
    let has = |role| roles.contains(&role);
    let mut g = Group::new();
    let carrier = has(LeverRole::Carrier);
    if carrier {
        let square = rectangle(x - 5.0, y - 5.0, 10.0, 10.0, PAPER);
        g = g.add(square.set("stroke", INK).set("stroke-width", 1.4));
    }
    if has(LeverRole::Ring) {
        g = g.add(circle(if carrier { 2.9 } else { 4.3 }, PAPER, if carrier { 1.2 } else { 1.8 }));
    }
    if has(LeverRole::Sun) || has(LeverRole::Gear) {
        g = g.add(circle(if carrier || has(LeverRole::Ring) { 1.8 } else { 4.2 }, INK, 0.8));
    }
    if roles == [LeverRole::Planet] {
        g = g.add(circle(2.4, PAPER, 1.0).set("stroke", FAINT));
    }
    g
}

/// The sign of a member at rest, its tip at the point.
pub(super) fn ground(x: f64, y: f64) -> Group {
    let n = |x: f64, y: f64| format!("{} {}", number(x), number(y));
    let triangle = format!("M{} L{} L{} Z", n(x, y), n(x - 8.0, y - 5.0), n(x - 8.0, y + 5.0));
    Group::new()
        .add(Path::new().set("d", triangle).set("fill", PAPER).set("stroke", INK).set("stroke-width", 1.2))
        .add(line((x - 9.0, y - 7.0), (x - 9.0, y + 7.0), INK, 2.0))
}

/// Letters of the cases above a lever, each led to its line.
fn letters(v: &View<'_>, bar: &LeverBar, first: &LeverNode) -> Group {
    let drawn: Vec<(usize, f64)> = (0..v.cases).filter_map(|c| Some((c, v.x(bar, v.speed(first, c)?)))).collect();
    let wished: Vec<f64> = drawn.iter().map(|d| d.1).collect();
    let at = spread(&wished, v.letters, (NAMES + 8.0, NAMES + 2.0 * PAD + v.speeds - 8.0));
    let end = v.y(first.position);
    let y = end - 17.0;
    let mut g = Group::new();
    for ((case, x), place) in drawn.into_iter().zip(at) {
        let letter = text(place, y, 12.0, Anchor::Middle, &v.lever.cases[case].letter).set("font-weight", "bold");
        let own = Group::new().add(line((place, y + 3.0), (x, end - 4.0), &case_colour(v, case), 0.8)).add(halo(
            letter.set("fill", case_colour(v, case)),
            PAPER,
            3.0,
        ));
        let name = bar.name();
        g = g.add(of(own, "letter", &[Of::Mesh(&name), Of::State(&v.lever.cases[case].name)]));
    }
    g
}

/// Names of the points, and their speeds where there is one case.
fn names(v: &View<'_>, bar: &LeverBar) -> Group {
    let nodes: Vec<&LeverNode> = shown(bar).collect();
    let wished: Vec<f64> = nodes.iter().map(|n| v.y(n.position)).collect();
    let at = spread(&wished, BLOCK, (v.y(1.0 + BEYOND) - 8.0, v.y(-BEYOND) + 8.0));
    let mut g = Group::new();
    for ((n, y), wished) in nodes.iter().zip(&at).zip(&wished) {
        let right = NAMES - 10.0;
        let (size, weight) = if planet(n) { (11.0, 1.0) } else { (12.0, BOLD) };
        let name = fit(&n.member, (right - 2.0) / weight, size);
        let mut label = text(right, y - 5.0, size, Anchor::End, &name);
        label = if planet(n) { label.set("fill", FAINT) } else { label.set("font-weight", "bold") };
        g = g.add(guide(line((right + 2.0, *y), (NAMES + 4.0, *wished), LINE, 0.8))).add(halo(label, PAPER, 3.0));
        let speed = match (v.cases, n.speeds[0].map(|w| w * v.factor)) {
            (1, Some(w)) => v.readable(w),
            (1, None) => "not settled".to_owned(),
            _ => continue,
        };
        let speed = text(right, y + 11.0, 11.0, Anchor::End, &fit(&speed, right - 2.0, 11.0)).set("fill", FAINT);
        g = g.add(halo(speed, PAPER, 3.0));
    }
    g
}

/// The forces of a set: arrows at the displaced points, true points as circles.
fn forces(v: &View<'_>, bar: &LeverBar, set: &LeverSet, centre: f64, named: bool) -> Group {
    let mut g = Group::new();
    let y = v.y(-BEYOND) + 8.0;
    let caption = match &v.lever.unit {
        None => format!("T, {}", v.torque.1),
        Some(input) => format!("T / T {}", fit(input, v.forces - 42.0, 11.0)),
    };
    g = g.add(text(centre, y + 30.0, 11.0, Anchor::Middle, &caption).set("fill", FAINT));
    if named {
        let name = fit(&set.name, v.forces - 12.0, 11.0);
        g = g.add(text(centre, y + 14.0, 11.0, Anchor::Middle, &name));
    }
    let (low, high) = ends(bar);
    let range = low.position - 2.0 * BEYOND..=high.position + 2.0 * BEYOND;
    let (near, far): (Vec<&LeverPull>, Vec<&LeverPull>) = set.pulls.iter().partition(|p| range.contains(&p.point));
    for (k, p) in far.iter().enumerate() {
        let value = format!(": {}", v.pull(p));
        let name = fit(&bar.nodes[p.node].member, v.forces - 6.0 - wide(&value, 11.0), 11.0);
        let label = format!("{name}{value}");
        g = g.add(text(centre, y + 44.0 + 13.0 * k as f64, 11.0, Anchor::Middle, &label).set("fill", FAINT));
    }
    if set.pulls.is_empty() || v.largest == 0.0 {
        return g.add(text(centre, v.y(0.5), 11.0, Anchor::Middle, "no torque").set("fill", FAINT));
    }
    let own = near.iter().map(|p| bar.nodes[p.node].position);
    let (low, high) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    g = g.add(guide(line((centre, v.y(high)), (centre, v.y(low)), LINE, 3.5)));
    let part = |p: &LeverPull| p.torque.abs() / v.largest;
    let side = |p: &LeverPull| if p.torque < 0.0 { -1.0 } else { 1.0 };
    let loaded: Vec<&LeverPull> = near.iter().copied().filter(|p| part(p) > 1e-9).collect();
    for p in &loaded {
        let n = &bar.nodes[p.node];
        let one = arrow(centre, v.y(p.point), side(p) * (LONGEST_ARROW * part(p)).max(7.0), &own_colour(n));
        g = g.add(of(one, "torque", &whose(bar, set, p)));
    }
    // Values stand on the side that their arrow leaves free, clear of the arrows of others.
    let mut placed: Vec<(f64, f64)> = Vec::new();
    for p in &near {
        let (side, y) = (side(p), v.y(p.point));
        let clear = |at: f64| {
            loaded.iter().all(|o| opposed(o, side) || (v.y(o.point) - at).abs() > 8.0)
                && placed.iter().all(|(s, y)| *s != side || (y - at).abs() > 12.0)
        };
        let tried = (0..120).flat_map(|k| [y - f64::from(k), y + f64::from(k)]);
        let at = tried.into_iter().find(|at| clear(*at)).unwrap_or(y);
        placed.push((side, at));
        let x = centre - side * 7.0;
        let anchor = if side > 0.0 { Anchor::End } else { Anchor::Start };
        if (at - y).abs() > 3.0 {
            g = g.add(guide(line((centre - side * 3.0, y), (x + side, at), LINE, 0.8)));
        }
        g = g.add(halo(text(x, at + 3.5, 11.0, anchor, &v.pull(p)), PAPER, 5.0));
    }
    for p in &near {
        let n = &bar.nodes[p.node];
        let dot = Circle::new().set("cx", number(centre)).set("cy", number(v.y(n.position))).set("r", 2.6);
        let dot = dot.set("fill", PAPER).set("stroke", INK).set("stroke-width", 1);
        g = g.add(of(dot, "arm", &whose(bar, set, p)));
    }
    for p in &near {
        let dot = Circle::new().set("cx", number(centre)).set("cy", number(v.y(p.point))).set("r", 1.6);
        g = g.add(of(dot.set("fill", own_colour(&bar.nodes[p.node])), "attack", &whose(bar, set, p)));
    }
    g
}

/// What a force stands for.
fn whose<'b>(bar: &'b LeverBar, set: &'b LeverSet, p: &'b LeverPull) -> [Of<'b>; 2] {
    [Of::Member(&bar.nodes[p.node].member), Of::Mesh(p.mesh.as_deref().unwrap_or(&set.name))]
}

/// Whether an arrow points away from where the values of this side stand.
fn opposed(pull: &LeverPull, side: f64) -> bool {
    (pull.torque < 0.0) == (side < 0.0)
}

fn arrow(x: f64, y: f64, length: f64, ink: &str) -> Group {
    let sign = length.signum();
    let tip = x + length;
    let back = tip - sign * 6.0;
    let n = |x: f64, y: f64| format!("{} {}", number(x), number(y));
    let head = format!("M{} L{} L{} Z", n(tip, y), n(back, y - 3.5), n(back, y + 3.5));
    Group::new().add(line((x, y), (back, y), ink, 2.2)).add(Path::new().set("d", head).set("fill", ink))
}

/// What is seen, and what is special.
fn caption(v: &View<'_>) -> Vec<String> {
    let l = v.lever;
    let mut first = "Heights come from tooth numbers, displacements from the rest line are speeds.".to_owned();
    if l.torques {
        first.push_str(" Arrows: torques on a set, at points that friction displaces.");
    }
    let mut all = vec![first];
    let mut second = Vec::new();
    if let [only] = &l.cases[..] {
        if !only.engaged.is_empty() {
            second.push(format!("Closed: {}.", only.engaged.join(", ")));
        }
        if let Some(ratio) = only.ratio {
            second.push(format!("Ratio {}.", exactly(ratio)));
        }
        if let Some(note) = &only.note {
            second.push(format!("Note: {note}."));
        }
    } else if l.cases.len() > v.cases {
        second.push(format!("The first {} of {} states.", v.cases, l.cases.len()));
    }
    if !l.level {
        second.push("Every lever has its own scale of places.".to_owned());
    }
    if !second.is_empty() {
        all.push(second.join(" "));
    }
    all
}

/// Shapes, and the letters of the cases.
fn key(v: &View<'_>, top: f64, width: f64) -> (Group, f64) {
    let mut g = guide(Group::new());
    let mut y = top + 8.0;
    let nodes = || v.lever.bars.iter().flat_map(shown);
    let mut x = MARGIN;
    let entries = [
        (LeverRole::Sun, "sun"),
        (LeverRole::Ring, "ring"),
        (LeverRole::Carrier, "carrier"),
        (LeverRole::Gear, "gear"),
        (LeverRole::Planet, "planet"),
    ];
    for (role, name) in entries {
        if nodes().any(|n| n.roles.contains(&role)) {
            g = g.add(mark(x + 6.0, y - 4.0, &[role])).add(text(x + 18.0, y, 12.0, Anchor::Start, name));
            x += 18.0 + wide(name, 12.0) + 20.0;
        }
    }
    if v.lever.cases[..v.cases].iter().any(|c| nodes().any(|n| c.held.contains(&n.member))) {
        let name = if v.cases > 1 { "held, at least in some states" } else { "held" };
        g = g.add(ground(x + 10.0, y - 4.0)).add(text(x + 18.0, y, 12.0, Anchor::Start, name));
        x += 18.0 + wide(name, 12.0) + 20.0;
    }
    if !v.lever.links.is_empty() {
        let l = line((x, y - 4.0), (x + 30.0, y - 4.0), FAINT, 1.2).set("stroke-dasharray", "6 4");
        g = g.add(l).add(text(x + 36.0, y, 12.0, Anchor::Start, "one member"));
    }
    if v.cases > 1 {
        let entry = |case: &LeverCase| {
            let what = match (&case.note, case.ratio) {
                (Some(note), _) => note.clone(),
                (None, Some(ratio)) => format!("ratio {}", exactly(ratio)),
                (None, None) => "output at rest".to_owned(),
            };
            let name = if case.letter == case.name { String::new() } else { format!("{}: ", case.name) };
            match case.engaged.is_empty() {
                true => format!("{name}{what}"),
                false => format!("{name}{what}; closed {}", case.engaged.join(", ")),
            }
        };
        let drawn = &v.lever.cases[..v.cases];
        let broadest = drawn.iter().map(|c| wide(&entry(c), 12.0) + 74.0 + v.letters).fold(220.0, f64::max);
        let columns = ((width / broadest).floor() as usize).clamp(1, 4);
        let column = width / columns as f64;
        let rows = v.cases.div_ceil(columns);
        for (k, case) in drawn.iter().enumerate() {
            let x = MARGIN + column * (k / rows) as f64;
            let y = y + 26.0 + 20.0 * (k % rows) as f64;
            let sample = line((x, y - 4.0), (x + 40.0, y - 4.0), &case_colour(v, k), 2.2);
            if case.note.is_none() {
                g = g.add(dashed(sample, k));
            }
            let after = x + 48.0 + v.letters;
            g = g.add(text(x + 46.0, y, 12.0, Anchor::Start, &case.letter).set("font-weight", "bold")).add(text(
                after,
                y,
                12.0,
                Anchor::Start,
                &fit(&entry(case), column - (after - x) - 12.0, 12.0),
            ));
        }
        y += 26.0 + 20.0 * (rows - 1) as f64;
    }
    (g, y + 6.0)
}

/// For those who do not see it.
fn words(v: &View<'_>) -> String {
    let l = v.lever;
    let mut all = vec![format!("{} of {}.", count(l.bars.len(), "lever"), l.title)];
    for bar in l.bars.iter().take(6) {
        let name = bar.sets.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(" and ");
        let points = bar.nodes.iter().filter(|n| !planet(n)).map(|n| match (v.cases, v.speed(n, 0)) {
            (1, Some(w)) => format!("{} {}", n.member, v.readable(w)),
            _ => n.member.clone(),
        });
        all.push(format!("{name}, from above: {}.", points.collect::<Vec<_>>().join(", ")));
    }
    if v.cases > 1 {
        let ratios = l.cases.iter().filter_map(|c| c.ratio.map(|r| format!("{} {}", c.name, digits(r))));
        all.push(format!("Ratios: {}.", ratios.collect::<Vec<_>>().join(", ")));
    }
    all.join(" ")
}

fn count(n: usize, what: &str) -> String {
    if n == 1 { format!("One {what}") } else { format!("{n} {what}s") }
}

/// A ratio with three decimals.
fn exactly(ratio: f64) -> String {
    if !(0.1..1e4).contains(&ratio.abs()) {
        return digits(ratio);
    }
    format!("{ratio:.3}").replace('-', "−")
}
