//! Power flows as Sankey diagrams.

mod layout;
mod ribbon;
mod words;

use std::collections::BTreeMap;

use svg::node::element::{Group, Path, Polygon};
use willis::hypergraph::NodeKind;

use crate::parts::alive::{Of, guide, of, part, told};
use crate::parts::style::{
    Anchor, BOLD, FAINT, INK, PAPER, colour, fit, halo, line, lines, number, page, rectangle, text, watts, wide,
};
use crate::{Drawing, Sankey, SankeyFlow, SankeyLink, SankeyNode};
use layout::{BAR, Frame, LINE_HEIGHT, Layout};
use ribbon::Ribbon;
use words::{SMALL, losers, percent};

const MARGIN: f64 = 28.0;
/// Narrowest page.
const NARROWEST: f64 = 750.0;

/// What a ribbon carries.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Carries {
    Input,
    Power,
    Circle,
    /// In a circle only in the frame of the housing.
    Framed,
    Loss,
}

impl Carries {
    /// Dashes and hatching over what goes round.
    fn rounds(self) -> Option<String> {
        match self {
            Self::Circle => Some(colour(Some(1), 1.0)),
            Self::Framed => Some(colour(None, 0.7)),
            _ => None,
        }
    }

    fn colour(self) -> String {
        match self {
            Self::Input => colour(Some(2), 0.75),
            Self::Power => colour(Some(0), 0.42),
            Self::Circle => colour(Some(4), 0.55),
            Self::Framed => colour(None, 0.13),
            Self::Loss => colour(Some(6), 0.8),
        }
    }
}

/// The power flows of a train as Sankey diagrams: one for each equilibrium, below each other.
///
/// Ribbons run from the inputs at the left to the outputs at the right and are as wide as their
/// power. Losses turn down and end in an arrow head. Power that runs in a circle is hatched and led
/// back above. Solid bars are components, hollow bars tooth contacts, double bars clutches and brakes.
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
/// let flows = willis::hypergraph::flows(&train, &Default::default())?;
/// assert!(willis_figure::draw_sankey(&willis_figure::sankey(&flows)).starts_with("<svg"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn draw(data: &Sankey) -> String {
    draw_on(data, Drawing::default())
}

pub(super) fn draw_on(data: &Sankey, paper: Drawing) -> String {
    let room = paper.page(f64::INFINITY, NARROWEST) - 2.0 * MARGIN;
    let drawings = data.panels.iter().map(|p| p.flow.as_ref().map(|flow| Layout::new(flow, room))).collect();
    drawn(data, drawings)
}

/// Paper that is kept while powers change: scales and columns stay, nodes grow and move in their column, and words stay at their
/// place along the ribbons. Made anew, it settles to what there is then.
///
/// Scale and columns suit every flow that it is made for, such as those of all gears; larger powers later become wider than that.
///
/// ```
/// use willis::analysis::Selection;
/// use willis::hypergraph::flows;
/// use willis::train::{SetSpec, Train};
/// use willis_figure::{Drawing, SankeyLayout, SankeyPaper};
///
/// let train = Train::builder("one set")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .build()?;
/// let figure = SankeyLayout::new(&train)?.show(&flows(&train, &Selection::default())?);
/// let mut paper = SankeyPaper::new([&figure], Drawing::default());
/// assert_eq!(paper.draw(&figure), paper.draw(&figure));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct SankeyPaper {
    frame: Frame,
    spots: BTreeMap<(String, String), layout::Spot>,
}

impl SankeyPaper {
    /// For all of these.
    pub fn new<'d>(all: impl IntoIterator<Item = &'d Sankey>, paper: Drawing) -> Self {
        let room = paper.page(f64::INFINITY, NARROWEST) - 2.0 * MARGIN;
        let flows: Vec<&SankeyFlow> = all.into_iter().flat_map(|s| &s.panels).filter_map(|p| p.flow.as_ref()).collect();
        Self { frame: Frame::of(&flows, room), spots: BTreeMap::new() }
    }

    /// For a panel of a screen that is so many px wide and high: the flow alone with names, losses and what goes round. Other
    /// powers are the titles of their ribbons. Losses are drawn so many times wider than power; without a number, as wide as
    /// they can be seen.
    pub fn of_panel<'d>(all: impl IntoIterator<Item = &'d Sankey>, size: [f64; 2], losses: Option<f64>) -> Self {
        let flows: Vec<&SankeyFlow> = all.into_iter().flat_map(|s| &s.panels).filter_map(|p| p.flow.as_ref()).collect();
        Self { frame: Frame::of_panel(&flows, size, losses), spots: BTreeMap::new() }
    }

    /// One of the flows alone in its panel, of at least that size; none where no power flows.
    pub fn draw_alone(&mut self, data: &Sankey, panel: usize, [width, height]: [f64; 2]) -> Option<String> {
        let told = data.panels.get(panel)?;
        let flow = Layout::within(told.flow.as_ref()?, &self.frame, &mut self.spots);
        let (width, height) = (width.max(flow.width + 8.0), height.max(flow.height + 8.0));
        let at = format!("translate({} {})", number((width - flow.width) / 2.0), number((height - flow.height) / 2.0));
        let words = caption(flow.flow).join(" ");
        let page = page(width, height, &format!("Power flow of {}", data.train), &words);
        Some(page.add(picture(&flow, &told.title).set("transform", at)).to_string())
    }

    /// How many times wider losses are drawn than power.
    pub fn widened(&self) -> f64 {
        self.frame.widened()
    }

    /// The power flows as SVG, like [`draw_sankey`](crate::draw_sankey).
    pub fn draw(&mut self, data: &Sankey) -> String {
        let Self { frame, spots } = self;
        let panels = data.panels.iter().map(|p| p.flow.as_ref().map(|flow| Layout::within(flow, frame, spots)));
        drawn(data, panels.collect())
    }
}

fn drawn(data: &Sankey, drawings: Vec<Option<Layout<'_>>>) -> String {
    let widest = drawings.iter().flatten().fold(0.0f64, |a, d| a.max(d.width));
    let width = (widest + 2.0 * MARGIN).max(NARROWEST).ceil();
    let room = width - 2.0 * MARGIN;
    let mut body = Group::new()
        .add(text(MARGIN, 38.0, 20.0, Anchor::Start, &fit(&data.train, room / BOLD, 20.0)).set("font-weight", "bold"))
        .add(
            text(
                MARGIN,
                60.0,
                13.0,
                Anchor::Start,
                "Power from inputs to outputs, widths to scale in each picture; losses have a scale of their own",
            )
            .set("fill", FAINT),
        );
    let mut y = 68.0;
    let mut told = Vec::new();
    let mut legend = Legend::default();
    for (panel, drawing) in data.panels.iter().zip(&drawings) {
        y += 26.0;
        body = body.add(
            text(MARGIN, y, 14.0, Anchor::Start, &fit(&panel.title, room / BOLD, 14.0)).set("font-weight", "bold"),
        );
        let sentences: Vec<String> = panel.remark.iter().cloned().chain(panel.flow.iter().flat_map(caption)).collect();
        for l in sentences.iter().flat_map(|s| lines(s, room, 12.0)) {
            y += 17.0;
            body = body.add(text(MARGIN, y, 12.0, Anchor::Start, &l).set("fill", FAINT));
        }
        told.push(format!("{}. {}", panel.title, sentences.join(" ")));
        if let Some(d) = drawing {
            y += 20.0;
            body = body.add(guide(scale_marks(y, d)));
            y += 10.0;
            let at = format!("translate({} {})", number((width - d.width) / 2.0), number(y));
            body = body.add(picture(d, &panel.title).set("transform", at));
            y += d.height;
            legend.see(d.flow);
        }
        y += 12.0;
    }
    let (key, height) = legend.draw(y, width);
    page(width, height, &format!("Sankey diagram of {}", data.train), &told.join(" ")).add(body).add(key).to_string()
}

fn caption(f: &SankeyFlow) -> Vec<String> {
    let efficiency = match f.efficiency {
        Some(e) if f.output_w > 0.0 => format!("η {}", efficiency(e)),
        Some(_) => "No power leaves, all of it is lost".to_owned(),
        None => "No power enters".to_owned(),
    };
    let mut kinds: Vec<(NodeKind, f64)> = Vec::new();
    for l in f.nodes.iter().flat_map(|n| &n.losses) {
        match kinds.iter_mut().find(|k| k.0 == l.kind) {
            Some(k) => k.1 += l.power_w,
            None => kinds.push((l.kind, l.power_w)),
        }
    }
    kinds.sort_by(|a, b| b.1.total_cmp(&a.1));
    let list: Vec<String> =
        kinds.iter().map(|(k, p)| format!("{} {} ({})", losers(*k), watts(*p), percent(*p, f.input_w))).collect();
    let lost = if list.is_empty() { String::new() } else { format!(" by {}", list.join(", ")) };
    let seen = f.seen_from.as_ref().map(|member| format!("As seen from {member}, ")).unwrap_or_default();
    let power = format!(
        "{seen}{efficiency}: in {}, out {}, lost {}{lost}.",
        watts(f.input_w),
        watts(f.output_w),
        watts(f.loss_w)
    );
    let sentence = |t: &String| {
        let mut letters = t.chars();
        letters.next().map_or(String::new(), |c| c.to_uppercase().chain(letters).collect::<String>()) + "."
    };
    std::iter::once(power).chain(f.circles.iter().map(sentence)).collect()
}

/// Two digits behind the point, more where a loss is tiny.
fn efficiency(x: f64) -> String {
    let p = 100.0 * x;
    if (99.995..100.0).contains(&p) || (0.0 < p && p < 0.1) { format!("{p:.4} %") } else { format!("{p:.2} %") }
}

/// How wide powers of round numbers are, and losses, if these have a scale of their own.
fn scale_marks(y: f64, d: &Layout<'_>) -> Group {
    let (power, end) = scale_mark(MARGIN, y, d.scale, "scale", Carries::Power);
    if d.widened == 1.0 || d.flow.nodes.iter().all(|n| n.losses.is_empty()) {
        return power;
    }
    let name = format!("losses {} times wider", number(d.widened));
    power.add(scale_mark(end + 26.0, y, d.scale * d.widened, &name, Carries::Loss).0)
}

/// How wide a power of a round number is; and where the mark ends.
fn scale_mark(x: f64, y: f64, scale: f64, name: &str, carries: Carries) -> (Group, f64) {
    let raw = 30.0 / scale;
    let size = 10f64.powf(raw.log10().floor());
    let power = [1.0, 2.0, 5.0].into_iter().rev().map(|s| s * size).find(|p| *p <= raw).unwrap_or(size);
    let long = power * scale;
    let from = x + wide(name, SMALL) + 8.0;
    let end = from + long + 7.0;
    let mark = Group::new()
        .add(text(x, y, SMALL, Anchor::Start, name).set("fill", FAINT))
        .add(rectangle(from, y - 8.0, long, 8.0, &carries.colour()))
        .add(line((from, y - 9.5), (from, y + 1.5), INK, 1.2))
        .add(line((from + long, y - 9.5), (from + long, y + 1.5), INK, 1.2))
        .add(text(end, y, SMALL, Anchor::Start, &watts(power)).set("fill", FAINT));
    (mark, end + wide(&watts(power), SMALL))
}

fn picture(d: &Layout<'_>, panel: &str) -> Group {
    let mut g = Group::new();
    // What is led back lies above what it crosses; its paper rim shows that nothing mixes there.
    for back in [false, true] {
        for (k, l) in d.flow.links.iter().enumerate().filter(|(_, l)| l.back == back) {
            g = g.add(link(d, k, l, panel));
        }
    }
    for (k, n) in d.flow.nodes.iter().enumerate() {
        let own = [part(n.kind, &n.name), Of::State(panel)];
        if !n.losses.is_empty() {
            let [name, panel] = own;
            g = g.add(of(losses(d, k, n), &format!("loss{:?}", n.kind), &[name, Of::Quantity("loss_w"), panel]));
        }
        g = g.add(of(node(d, k, n), &format!("node{:?}", n.kind), &own));
    }
    for label in &d.labels {
        let power = &d.flow.links[label.link];
        for (row, words) in d.words.link(power).iter().enumerate() {
            let y = label.y[0] + LINE_HEIGHT * row as f64 + 0.82 * SMALL;
            let t = text(label.middle(), y, SMALL, Anchor::Middle, words);
            g = g.add(if label.clear { Group::new().add(t) } else { halo(t, PAPER, 3.0) });
        }
    }
    g
}

fn filled(path: String, fill: &str) -> Path {
    Path::new().set("d", path).set("fill", fill)
}

/// A ribbon, its circulating part hatched.
fn link(d: &Layout<'_>, k: usize, l: &SankeyLink, panel: &str) -> Group {
    let name = |k: usize| &d.flow.nodes[k].name;
    let mut words = format!("{} to {}: {}", name(l.from), name(l.to), watts(l.power_w));
    if !l.via.is_empty() {
        words += &format!(", via {}", l.via.join(", "));
    }
    if l.circulating_w > 0.0 {
        words += &format!(", {} of it in a circle", watts(l.circulating_w));
    }
    let [from, to] = [l.from, l.to].map(|k| &d.flow.nodes[k]);
    let link = format!("power_w {:?} {} to {:?} {} {}", from.kind, from.name, to.kind, to.name, l.via.join(" "));
    let mut g = told(Group::new(), "ribbon", &[Of::Quantity(link.trim_end()), Of::State(panel)], words);
    let whole = d.ribbon(k, [0.0, l.power_w]);
    if l.back {
        g = g.add(
            Path::new()
                .set("d", whole.outline())
                .set("fill", PAPER)
                .set("stroke", PAPER)
                .set("stroke-width", 3)
                .set("stroke-linejoin", "round"),
        );
    }
    let round = l.circulating_w.min(l.power_w);
    if l.power_w - round > 1e-9 * l.power_w {
        g = g.add(band(&d.ribbon(k, [round, l.power_w]), Carries::Power));
    }
    if round > 1e-9 * l.power_w {
        let carries = if l.framed { Carries::Framed } else { Carries::Circle };
        g = g.add(band(&d.ribbon(k, [0.0, round]), carries));
    }
    if l.back {
        for (x, y) in whole.on_the_way_back() {
            let s = (0.45 * whole.width()).clamp(3.5, 8.0);
            g = g.add(triangle([(x - s, y), (x + s, y - s), (x + s, y + s)], INK));
        }
    }
    g
}

fn band(ribbon: &Ribbon, carries: Carries) -> Group {
    let fill = carries.colour();
    // One too narrow to be seen is a hairline.
    if ribbon.width() < 1.0 {
        let path = Path::new().set("d", ribbon.spine()).set("fill", "none").set("stroke-width", 1);
        return Group::new().add(match carries.rounds() {
            Some(ink) => path.set("stroke", ink).set("stroke-dasharray", "6 4"),
            None => path.set("stroke", colour(Some(0), 0.8)),
        });
    }
    let g = Group::new().add(filled(ribbon.outline(), &fill));
    let Some(ink) = carries.rounds() else { return g };
    let path = Path::new().set("fill", "none").set("stroke", ink);
    g.add(match ribbon.width() < 5.0 {
        // Too narrow for hatching.
        true => path.set("d", ribbon.spine()).set("stroke-width", 1.2).set("stroke-dasharray", "6 4"),
        false => {
            path.set("d", ribbon.hatching()).set("stroke-width", if carries == Carries::Framed { 0.6 } else { 1.0 })
        }
    })
}

fn triangle(corners: [(f64, f64); 3], fill: &str) -> Polygon {
    let points: Vec<String> = corners.iter().map(|p| format!("{},{}", number(p.0), number(p.1))).collect();
    Polygon::new().set("points", points.join(" ")).set("fill", fill)
}

/// Losses turn down and end in one arrow head; below it stands what they are.
fn losses(d: &Layout<'_>, k: usize, n: &SankeyNode) -> Group {
    let mut g = Group::new();
    let Some(first) = n.losses.first() else { return g };
    let fill = Carries::Loss.colour();
    let x = d.middle(n.layer) + BAR / 2.0;
    let [top, bottom] = [d.top[k] + first.offset_w * d.scale, d.top[k] + n.power_w * d.scale];
    let (width, r) = ((bottom - top) * d.widened, layout::TURN);
    let (inner, low) = (x + r, bottom + r);
    let p = |x: f64, y: f64| format!("{} {}", number(x), number(y));
    if width < 1.0 {
        let middle = (top + bottom) / 2.0;
        let path = format!("M{} Q{} {} V{}", p(x, middle), p(inner, middle), p(inner, low), number(low + 5.0));
        g = g.add(Path::new().set("d", path).set("fill", "none").set("stroke", fill.clone()).set("stroke-width", 1));
    } else {
        // From its true width at the node to that of its own scale.
        let path = format!(
            "M{} Q{} {} V{} H{} V{} Q{} {} Z",
            p(x, top),
            p(inner + width, top),
            p(inner + width, low),
            number(low + 5.0),
            number(inner),
            number(low),
            p(inner, bottom),
            p(x, bottom)
        );
        g = g.add(filled(path, &fill));
        // Kinds of loss side by side.
        for l in &n.losses[1..] {
            let to = (n.power_w - l.offset_w) * d.scale;
            let wide = to * d.widened;
            if wide > 1.0 && width - wide > 1.0 {
                let at = inner + wide;
                let path =
                    format!("M{} Q{} {} V{}", p(x, bottom - to), p(at, bottom - to), p(at, low), number(low + 5.0));
                g = g.add(Path::new().set("d", path).set("fill", "none").set("stroke", PAPER).set("stroke-width", 0.8));
            }
        }
    }
    let (middle, half) = (inner + width.max(0.0) / 2.0, layout::head_of(width));
    let tip = low + 4.0 + half;
    g = g.add(triangle([(middle - half, low + 4.0), (middle + half, low + 4.0), (middle, tip)], &fill));
    for (row, words) in d.words.foot(n).iter().enumerate() {
        let y = tip + LINE_HEIGHT * (row as f64 + 0.95);
        g = g.add(text(d.middle(n.layer), y, SMALL, Anchor::Middle, words));
    }
    g
}

/// The mark of a kind of node.
fn bar(kind: NodeKind, x: f64, top: f64, height: f64) -> Group {
    let whole =
        |fill: &str| rectangle(x - BAR / 2.0, top, BAR, height, fill).set("stroke", INK).set("stroke-width", 1.4);
    let g = Group::new();
    match kind {
        NodeKind::Member | NodeKind::Input | NodeKind::Output => g.add(whole(INK)),
        NodeKind::ShiftElement => g
            .add(rectangle(x - BAR / 2.0, top, BAR, height, PAPER))
            .add(line((x - 3.0, top), (x - 3.0, top + height), INK, 3.0))
            .add(line((x + 3.0, top), (x + 3.0, top + height), INK, 3.0)),
        // What is adjustable has a slanting stroke.
        NodeKind::Variator => g.add(whole(PAPER)).add(line(
            (x - BAR, top + height / 2.0 + BAR),
            (x + BAR, top + height / 2.0 - BAR),
            INK,
            1.8,
        )),
        _ => g.add(whole(PAPER)),
    }
}

/// External power: a tail that enters a node, or a head that leaves it.
fn end(x: f64, [top, bottom]: [f64; 2], long: f64, entering: bool) -> Polygon {
    let middle = (top + bottom) / 2.0;
    let (fill, mut corners) = if entering {
        let notch = (0.3 * (bottom - top)).clamp(1.0, 9.0);
        let left = x - long;
        (Carries::Input.colour(), vec![(left, top), (x, top), (x, bottom), (left, bottom), (left + notch, middle)])
    } else {
        let half = (bottom - top) / 2.0 + 5.0;
        let neck = x + long - (0.5 * half).clamp(6.0, 16.0);
        let tip = x + long;
        let head = [(neck, middle - half), (tip, middle), (neck, middle + half)];
        let mut all = vec![(x, top), (neck, top)];
        all.extend(head);
        all.extend([(neck, bottom), (x, bottom)]);
        (colour(Some(0), 0.75), all)
    };
    // One too narrow to be seen is a hairline.
    if bottom - top < 1.0 {
        corners.iter_mut().filter(|c| (c.1 - middle).abs() < 0.5).for_each(|c| {
            c.1 = middle + if c.1 < middle { -0.5 } else { 0.5 };
        });
    }
    let points: Vec<String> = corners.iter().map(|p| format!("{},{}", number(p.0), number(p.1))).collect();
    Polygon::new().set("points", points.join(" ")).set("fill", fill)
}

fn node(d: &Layout<'_>, k: usize, n: &SankeyNode) -> Group {
    let x = d.middle(n.layer);
    let (top, height) = (d.top[k], n.power_w * d.scale);
    let mut g = Group::new();
    if n.input_w > 0.0 {
        g = g.add(end(x - BAR / 2.0, [top, top + height], layout::END, true));
    }
    if n.output_w > 0.0 {
        g = g.add(end(x + BAR / 2.0, [top, top + n.output_w * d.scale], layout::END, false));
    }
    let pad = layout::pad(height);
    g = g.add(bar(n.kind, x, top - pad, height + 2.0 * pad));
    let head = d.words.head(n);
    for (row, words) in head.iter().enumerate() {
        let y = top - pad - 5.0 - LINE_HEIGHT * (head.len() - 1 - row) as f64;
        let t = text(x, y, SMALL, Anchor::Middle, words);
        g = g.add(if row == 0 { t.set("font-weight", "bold") } else { t.set("fill", FAINT) });
    }
    g
}

/// What occurs in the pictures.
#[derive(Default)]
struct Legend {
    kinds: Vec<NodeKind>,
    circle: bool,
    framed: bool,
    loss: bool,
}

impl Legend {
    fn see(&mut self, f: &SankeyFlow) {
        self.kinds.extend(f.nodes.iter().map(|n| n.kind));
        self.circle |= f.links.iter().any(|l| l.circulating_w > 0.0 && !l.framed);
        self.framed |= f.links.iter().any(|l| l.framed);
        self.loss |= f.nodes.iter().any(|n| !n.losses.is_empty());
    }

    /// In rows; and the height of the page.
    fn draw(mut self, top: f64, width: f64) -> (Group, f64) {
        self.kinds.sort_unstable();
        self.kinds.dedup();
        if self.kinds.is_empty() {
            return (Group::new(), top + 12.0);
        }
        let sample = |carries: Carries| band(&Ribbon::straight(0.0, 24.0, [-5.0, 5.0]), carries);
        let mut entries: Vec<(Option<Group>, &str)> = vec![
            (Some(Group::new().add(end(24.0, [-5.0, 5.0], 24.0, true))), "external power enters"),
            (Some(sample(Carries::Power)), "power, the wider the more"),
            (Some(Group::new().add(end(0.0, [-4.0, 4.0], 24.0, false))), "external power leaves"),
        ];
        if self.circle {
            entries.push((Some(sample(Carries::Circle)), "runs in a circle"));
        }
        if self.framed {
            entries.push((Some(sample(Carries::Framed)), "runs in a circle only as seen from the housing"));
        }
        if self.loss {
            let arrow = triangle([(5.0, -4.0), (19.0, -4.0), (12.0, 6.0)], &Carries::Loss.colour());
            entries.push((Some(Group::new().add(arrow)), "loss"));
        }
        for k in self.kinds {
            let words = match k {
                NodeKind::Member => "component",
                NodeKind::Teeth => "tooth contact",
                NodeKind::ShiftElement => "clutch or brake",
                NodeKind::Variator => "variator",
                _ => continue,
            };
            entries.push((Some(bar(k, 12.0, -8.0, 16.0)), words));
        }
        entries.push((None, "%: of the external power that enters"));
        let mut g = guide(Group::new());
        let (mut x, mut y) = (MARGIN, top + 14.0);
        for (mark, words) in entries {
            let indent = if mark.is_some() { 32.0 } else { 0.0 };
            let room = indent + wide(words, SMALL) + 20.0;
            if x + room > width - MARGIN && x > MARGIN {
                x = MARGIN;
                y += 24.0;
            }
            let at = format!("translate({} {})", number(x), number(y));
            let t = text(indent, 4.0, SMALL, Anchor::Start, words).set("fill", FAINT);
            g = g.add(Group::new().set("transform", at).add(mark.unwrap_or_default()).add(t));
            x += room;
        }
        (g, (y + 24.0).ceil())
    }
}
