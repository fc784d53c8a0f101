//! A picture as TikZ for papers in LaTeX: the same marks in the same places as in the SVG, text as text of the document.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use svg::node::Attributes;
use svg::node::element::tag::Type;
use svg::parser::{Event, Parser};

/// A unit of a picture in points of PDF: the smallest text has 11 units and 7 pt.
const UNIT: f64 = 7.0 / 11.0;

/// A picture in its light form, as [`draw`](crate::draw) makes it, as a `tikzpicture`. It needs the package `tikz` and nothing else;
/// letters that pdfLaTeX does not know, such as Chinese names, need LuaLaTeX or XeLaTeX with a font that has them.
///
/// Sizes are those of print: the smallest text has 7 pt. Rims of texts are white boxes, and nothing moves.
///
/// # Example
/// ```
/// use willis_figure::{Drawing, Figure, draw, stick, tikz};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("50 % of a_b")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4))
///     .build()?;
/// let svg = draw(&Figure::Stick(stick(&train, None)?), Drawing::default());
/// let picture = tikz(&svg);
/// assert!(picture.contains(r"50 \% of a\_b") && picture.trim_end().ends_with(r"\end{tikzpicture}"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn tikz(svg: &str) -> String {
    let mut scene = Scene::default();
    for event in Parser::new(svg) {
        match event {
            Event::Tag(name, Type::Start, own) => {
                scene.mark(name, &own);
                scene.open(name, &own);
            }
            Event::Tag(name, Type::Empty, own) => scene.mark(name, &own),
            Event::Tag(name, Type::End, _) => scene.close(name),
            Event::Text(words) => scene.words(words),
            _ => {}
        }
    }
    let mut out = String::new();
    if !scene.title.is_empty() {
        let _ = writeln!(out, "% {}", scene.title);
    }
    for hex in &scene.colours {
        let _ = writeln!(out, "\\definecolor{{willis{hex}}}{{HTML}}{{{}}}", hex.to_uppercase());
    }
    out += "\\begin{tikzpicture}[x=1bp,y=-1bp]\n";
    out += &scene.body;
    out += "\\end{tikzpicture}\n";
    out
}

/// Where a place of a group lies on the page: x' = a x + c y + e, y' = b x + d y + f.
#[derive(Clone, Copy)]
struct Map([f64; 6]);

impl Map {
    fn at(self, x: f64, y: f64) -> (f64, f64) {
        let [a, b, c, d, e, f] = self.0;
        (a * x + c * y + e, b * x + d * y + f)
    }

    /// First the other, then this one.
    fn of(self, other: Self) -> Self {
        let [a, b, c, d, e, f] = other.0;
        let turn = |x: f64, y: f64| (self.0[0] * x + self.0[2] * y, self.0[1] * x + self.0[3] * y);
        let ((a, b), (c, d), (e, f)) = (turn(a, b), turn(c, d), self.at(e, f));
        Self([a, b, c, d, e, f])
    }

    /// By how much lengths grow.
    fn scale(self) -> f64 {
        (self.0[0] * self.0[3] - self.0[1] * self.0[2]).abs().sqrt()
    }
}

/// What a group hands on to what is in it.
#[derive(Clone)]
struct Style {
    map: Map,
    all: BTreeMap<String, String>,
    /// Groups of TikZ that end with this one.
    scopes: usize,
    /// What is here is no mark: a definition.
    hidden: bool,
}

impl Style {
    fn get(&self, name: &str) -> Option<&str> {
        self.all.get(name).map(String::as_str)
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.parse().ok()
    }
}

/// What was drawn so far.
struct Scene {
    body: String,
    title: String,
    colours: BTreeSet<String>,
    /// The page, then the groups that are open.
    stack: Vec<Style>,
    /// What is open, by name: texts and titles hold words.
    names: Vec<String>,
    /// Paths to clip with, by their id.
    clips: BTreeMap<String, String>,
    clip: Option<String>,
    marks: usize,
}

impl Default for Scene {
    fn default() -> Self {
        let page = Style { map: Map([UNIT, 0.0, 0.0, UNIT, 0.0, 0.0]), all: BTreeMap::new(), scopes: 0, hidden: false };
        Self {
            body: String::new(),
            title: String::new(),
            colours: BTreeSet::new(),
            stack: vec![page],
            names: vec![],
            clips: BTreeMap::new(),
            clip: None,
            marks: 0,
        }
    }
}

/// Attributes that a group hands on.
const INHERITED: [&str; 14] = [
    "fill",
    "stroke",
    "stroke-width",
    "stroke-dasharray",
    "stroke-linejoin",
    "stroke-linecap",
    "stroke-opacity",
    "fill-opacity",
    "fill-rule",
    "font-size",
    "font-weight",
    "font-style",
    "text-anchor",
    "aria-hidden",
];

impl Scene {
    /// The style of an element within what is open.
    fn style(&self, own: &Attributes) -> Style {
        let mut style = self.stack.last().cloned().expect("the page is never closed");
        style.scopes = 0;
        for (name, value) in own {
            if INHERITED.contains(&name.as_str()) || matches!(name.as_str(), "x" | "y") {
                style.all.insert(name.clone(), value.to_string());
            }
        }
        if let Some(transform) = own.get("transform") {
            style.map = style.map.of(transformed(transform));
        }
        style
    }

    fn open(&mut self, name: &str, own: &Attributes) {
        let mut style = self.style(own);
        style.hidden |= matches!(name, "defs" | "clipPath");
        if name == "clipPath" {
            self.clip = own.get("id").map(|id| id.to_string());
        }
        // A shape has its own around itself.
        if name == "g" && self.clipped(own) {
            style.scopes = 2;
        }
        self.names.push(name.to_owned());
        self.stack.push(style);
    }

    /// Begins a scope in which a mark is cut off, if it says so.
    fn clipped(&mut self, own: &Attributes) -> bool {
        let path = own.get("clip-path").and_then(|url| {
            let id = url.strip_prefix("url(#")?.strip_suffix(')')?;
            self.clips.get(id)
        });
        if let Some(path) = path {
            // TikZ takes no rule at the path itself, and what is cut off keeps its own.
            self.body += "\\begin{scope}[even odd rule]\n";
            let _ = writeln!(self.body, "\\path[clip] {path};");
            self.body += "\\begin{scope}[nonzero rule]\n";
        }
        path.is_some()
    }

    fn close(&mut self, name: &str) {
        if self.stack.len() > 1
            && let Some(style) = self.stack.pop()
        {
            self.names.pop();
            (0..style.scopes).for_each(|_| self.body += "\\end{scope}\n");
        }
        if name == "clipPath" {
            self.clip = None;
        }
    }

    /// A shape, where the element is one.
    fn mark(&mut self, name: &str, own: &Attributes) {
        let style = self.style(own);
        let number = |name: &str| own.get(name).and_then(|v| v.parse::<f64>().ok()).unwrap_or(0.0);
        let point = |x: f64, y: f64| place(style.map.at(x, y));
        let mut options = vec![];
        let path = match name {
            "line" => format!("{} -- {}", point(number("x1"), number("y1")), point(number("x2"), number("y2"))),
            "rect" => {
                let [x, y, w, h] = ["x", "y", "width", "height"].map(number);
                let corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)].map(|(x, y)| point(x, y));
                if number("rx") > 0.0 {
                    options.push(format!("rounded corners={}bp", short(number("rx") * style.map.scale())));
                }
                format!("{} -- cycle", corners.join(" -- "))
            }
            "circle" => {
                let radius = short(number("r") * style.map.scale());
                format!("{} circle[radius={radius}bp]", point(number("cx"), number("cy")))
            }
            "polyline" | "polygon" => {
                let all: Vec<f64> = numbers(own.get("points").map_or("", |p| p));
                let corners: Vec<String> = all.chunks_exact(2).map(|p| point(p[0], p[1])).collect();
                let end = if name == "polygon" { " -- cycle" } else { "" };
                format!("{}{end}", corners.join(" -- "))
            }
            "path" => curves(own.get("d").map_or("", |d| d), style.map),
            _ => return,
        };
        if path.is_empty() {
            return;
        }
        if style.hidden {
            if let Some(id) = &self.clip {
                self.clips.insert(id.clone(), path);
            }
            return;
        }
        self.marks += 1;
        // The first mark is the paper.
        if self.marks > 1 {
            let clipped = self.clipped(own);
            self.painted(&style, name, options, &path);
            if clipped {
                self.body += "\\end{scope}\n\\end{scope}\n";
            }
        }
    }

    /// A path with its paint.
    fn painted(&mut self, style: &Style, name: &str, mut options: Vec<String>, path: &str) {
        let fill = if name == "line" { None } else { style.get("fill").or(Some("#000000")) };
        let mut seen = false;
        if let Some(ink) = fill.and_then(|f| self.colour(f)) {
            options.push(format!("fill={ink}"));
            seen = true;
            if style.get("fill-rule") == Some("evenodd") {
                options.push("even odd rule".to_owned());
            }
            if let Some(part) = style.number("fill-opacity") {
                options.push(format!("fill opacity={}", short(part)));
            }
        }
        if let Some(ink) = style.get("stroke").and_then(|s| self.colour(s)) {
            options.push(format!("draw={ink}"));
            seen = true;
            let width = style.number("stroke-width").unwrap_or(1.0) * style.map.scale();
            options.push(format!("line width={}bp", short(width)));
            let dashes = numbers(style.get("stroke-dasharray").unwrap_or(""));
            if !dashes.is_empty() {
                // An odd count is gone through twice.
                let twice = if dashes.len() % 2 == 1 { 2 } else { 1 };
                let all = dashes.iter().cycle().take(dashes.len() * twice).enumerate();
                let words: Vec<String> = all
                    .map(|(k, d)| {
                        format!("{} {}bp", if k % 2 == 0 { "on" } else { "off" }, short(d * style.map.scale()))
                    })
                    .collect();
                options.push(format!("dash pattern={}", words.join(" ")));
            }
            if style.get("stroke-linejoin") == Some("round") {
                options.push("line join=round".to_owned());
            }
            match style.get("stroke-linecap") {
                Some("round") => options.push("line cap=round".to_owned()),
                Some("square") => options.push("line cap=rect".to_owned()),
                _ => {}
            }
            if let Some(part) = style.number("stroke-opacity") {
                options.push(format!("draw opacity={}", short(part)));
            }
        }
        if seen {
            let _ = writeln!(self.body, "\\path[{}] {path};", options.join(","));
        }
    }

    /// The name of a colour, which is defined at the head; none where nothing is painted.
    fn colour(&mut self, hex: &str) -> Option<String> {
        let digits = hex.strip_prefix('#').filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit()))?;
        let digits = digits.to_lowercase();
        let name = format!("willis{digits}");
        self.colours.insert(digits);
        Some(name)
    }

    /// Words of a text or of the title.
    fn words(&mut self, words: &str) {
        let words = unescaped(words.trim());
        let Some(name) = self.names.last().filter(|_| !words.is_empty()) else { return };
        let Some(style) = self.stack.last().cloned() else { return };
        if name == "title" && self.names.len() == 2 && self.title.is_empty() {
            // One line, whatever the name holds.
            self.title = words.split_whitespace().collect::<Vec<_>>().join(" ");
        }
        if name != "text" || style.hidden {
            return;
        }
        let anchor = match style.get("text-anchor") {
            Some("middle") => "base",
            Some("end") => "base east",
            _ => "base west",
        };
        let at = style.map.at(style.number("x").unwrap_or(0.0), style.number("y").unwrap_or(0.0));
        let size = style.number("font-size").unwrap_or(11.0) * style.map.scale();
        let mut options = vec![format!("anchor={anchor}"), "inner sep=0".to_owned()];
        let [a, b, ..] = style.map.0;
        let turn = b.atan2(a).to_degrees();
        if turn.abs() > 1e-9 {
            // TikZ turns the other way round, because its y runs upwards.
            options.push(format!("rotate={}", short(-turn)));
        }
        let mut set = latex(&words);
        if style.get("font-weight") == Some("bold") {
            set = format!("\\bfseries {set}");
        }
        if style.get("font-style") == Some("italic") {
            set = format!("\\itshape {set}");
        }
        let size = format!("\\fontsize{{{}bp}}{{{}bp}}\\selectfont\\sffamily", short(size), short(1.2 * size));
        if style.get("aria-hidden") == Some("true") {
            // The rim of the text that follows.
            if let Some(ground) = style.get("fill").and_then(|f| self.colour(f)) {
                options[1] = "inner sep=0.6bp".to_owned();
                options.push(format!("fill={ground}"));
            }
            set = format!("\\phantom{{{set}}}");
        } else if let Some(ink) = style.get("fill").and_then(|f| self.colour(f)) {
            options.push(format!("text={ink}"));
        }
        let _ = writeln!(self.body, "\\node[{}] at {} {{{size} {set}}};", options.join(","), place(at));
    }
}

/// A number with three decimals at most.
fn short(x: f64) -> String {
    let text = format!("{x:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn place((x, y): (f64, f64)) -> String {
    format!("({},{})", short(x), short(y))
}

/// The numbers of a list, whatever stands between them.
fn numbers(list: &str) -> Vec<f64> {
    list.split(|c: char| c == ',' || c.is_whitespace()).filter_map(|n| n.parse().ok()).collect()
}

/// `translate`, `rotate`, `scale` and `matrix`, one after the other.
fn transformed(list: &str) -> Map {
    let mut all = Map([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    for one in list.split(')') {
        let Some((name, values)) = one.split_once('(') else { continue };
        let v = numbers(values);
        let get = |k: usize| v.get(k).copied().unwrap_or(0.0);
        let moved = |x: f64, y: f64| Map([1.0, 0.0, 0.0, 1.0, x, y]);
        let next = match name.trim().trim_start_matches(',').trim() {
            "translate" => moved(get(0), get(1)),
            "scale" => Map([get(0), 0.0, 0.0, if v.len() > 1 { get(1) } else { get(0) }, 0.0, 0.0]),
            "rotate" => {
                let (sin, cos) = get(0).to_radians().sin_cos();
                moved(get(1), get(2)).of(Map([cos, sin, -sin, cos, 0.0, 0.0])).of(moved(-get(1), -get(2)))
            }
            "matrix" if v.len() == 6 => Map([v[0], v[1], v[2], v[3], v[4], v[5]]),
            _ => continue,
        };
        all = all.of(next);
    }
    all
}

/// The data of a path as a path of TikZ.
fn curves(d: &str, map: Map) -> String {
    let mut out = String::new();
    let (mut at, mut start) = ((0.0, 0.0), (0.0, 0.0));
    let commands = d.char_indices().filter(|(_, c)| c.is_ascii_alphabetic() && *c != 'e');
    let commands: Vec<(usize, char)> = commands.collect();
    for (n, (from, command)) in commands.iter().enumerate() {
        let to = commands.get(n + 1).map_or(d.len(), |c| c.0);
        let v = numbers(&d[from + 1..to]);
        let relative = command.is_ascii_lowercase();
        let takes = match command.to_ascii_uppercase() {
            'M' | 'L' => 2,
            'H' | 'V' => 1,
            'C' => 6,
            'Q' => 4,
            'A' => 7,
            'Z' => {
                out += " -- cycle";
                at = start;
                continue;
            }
            _ => continue,
        };
        for (k, own) in v.chunks_exact(takes).enumerate() {
            let (x, y) = if relative { at } else { (0.0, 0.0) };
            let point = |k: usize| (own[k] + x, own[k + 1] + y);
            let on = |p: (f64, f64)| place(map.at(p.0, p.1));
            match command.to_ascii_uppercase() {
                'M' if k == 0 => {
                    (at, start) = (point(0), point(0));
                    let _ = write!(out, "{}{}", if out.is_empty() { "" } else { " " }, on(at));
                }
                'M' | 'L' => {
                    at = point(0);
                    let _ = write!(out, " -- {}", on(at));
                }
                'H' => {
                    at = (own[0] + x, at.1);
                    let _ = write!(out, " -- {}", on(at));
                }
                'V' => {
                    at = (at.0, own[0] + y);
                    let _ = write!(out, " -- {}", on(at));
                }
                'C' => {
                    at = point(4);
                    let _ = write!(out, " .. controls {} and {} .. {}", on(point(0)), on(point(2)), on(at));
                }
                'Q' => {
                    let (q, end) = (point(0), point(2));
                    let towards = |p: (f64, f64)| (p.0 + 2.0 / 3.0 * (q.0 - p.0), p.1 + 2.0 / 3.0 * (q.1 - p.1));
                    let _ = write!(out, " .. controls {} and {} .. {}", on(towards(at)), on(towards(end)), on(end));
                    at = end;
                }
                _ => {
                    let end = point(5);
                    for [a, b, c] in arc(at, [own[0], own[1]], own[2], [own[3] != 0.0, own[4] != 0.0], end) {
                        let _ = write!(out, " .. controls {} and {} .. {}", on(a), on(b), on(c));
                    }
                    at = end;
                }
            }
        }
    }
    out
}

/// An arc of an ellipse as cubic curves of a quarter turn at most, by the end points, radii, tilt and flags of SVG (its
/// implementation notes, section B.2.4: from end points to the centre).
fn arc(
    from: (f64, f64),
    radii: [f64; 2],
    tilt: f64,
    [large, sweep]: [bool; 2],
    to: (f64, f64),
) -> Vec<[(f64, f64); 3]> {
    let [mut rx, mut ry] = radii.map(f64::abs);
    if rx == 0.0 || ry == 0.0 || from == to {
        return vec![[from, to, to]];
    }
    let (sin, cos) = tilt.to_radians().sin_cos();
    let (dx, dy) = ((from.0 - to.0) / 2.0, (from.1 - to.1) / 2.0);
    let (x, y) = (cos * dx + sin * dy, cos * dy - sin * dx);
    // Radii that do not reach are made as large as they must be.
    let reach = (x / rx).powi(2) + (y / ry).powi(2);
    if reach > 1.0 {
        (rx, ry) = (rx * reach.sqrt(), ry * reach.sqrt());
    }
    let below = (rx * y).powi(2) + (ry * x).powi(2);
    let factor = ((rx * ry).powi(2) / below - 1.0).max(0.0).sqrt() * if large == sweep { -1.0 } else { 1.0 };
    let (cx, cy) = (factor * rx * y / ry, -factor * ry * x / rx);
    let angle = |x: f64, y: f64| (y / ry).atan2(x / rx);
    let start = angle(x - cx, y - cy);
    let mut turn = angle(-x - cx, -y - cy) - start;
    if sweep && turn < 0.0 {
        turn += std::f64::consts::TAU;
    } else if !sweep && turn > 0.0 {
        turn -= std::f64::consts::TAU;
    }
    let middle = ((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0);
    let on = |u: f64, v: f64| {
        let (x, y) = (cx + rx * u, cy + ry * v);
        (middle.0 + cos * x - sin * y, middle.1 + sin * x + cos * y)
    };
    let count = (turn.abs() / std::f64::consts::FRAC_PI_2 - 1e-9).ceil().max(1.0);
    let step = turn / count;
    let k = 4.0 / 3.0 * (step / 4.0).tan();
    (0..count as usize)
        .map(|n| {
            let (a, b) = (start + step * n as f64, start + step * (n + 1) as f64);
            let ((sa, ca), (sb, cb)) = (a.sin_cos(), b.sin_cos());
            [on(ca - k * sa, sa + k * ca), on(cb + k * sb, sb - k * cb), on(cb, sb)]
        })
        .collect()
}

/// A text of SVG without its entities.
fn unescaped(text: &str) -> String {
    const ENTITIES: [(&str, char); 5] = [("lt;", '<'), ("gt;", '>'), ("quot;", '"'), ("apos;", '\''), ("amp;", '&')];
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('&') {
        out.push_str(&rest[..at]);
        rest = &rest[at + 1..];
        let known = ENTITIES.iter().find_map(|(name, c)| rest.strip_prefix(name).map(|behind| (*c, behind)));
        let numbered = || {
            let (digits, behind) = rest.strip_prefix('#')?.split_once(';')?;
            let code = match digits.strip_prefix(['x', 'X']) {
                Some(hex) => u32::from_str_radix(hex, 16).ok()?,
                None => digits.parse().ok()?,
            };
            Some((char::from_u32(code)?, behind))
        };
        match known.or_else(numbered) {
            Some((c, behind)) => {
                out.push(c);
                rest = behind;
            }
            None => out.push('&'),
        }
    }
    out + rest
}

/// A text as LaTeX sets it: nothing in it is a command, and signs of mathematics are set as such.
fn latex(text: &str) -> String {
    const SIGNS: [(char, &str); 65] = [
        ('\\', "\\textbackslash{}"),
        ('{', "\\{"),
        ('}', "\\}"),
        ('$', "\\$"),
        ('&', "\\&"),
        ('#', "\\#"),
        ('%', "\\%"),
        ('_', "\\_"),
        ('^', "\\textasciicircum{}"),
        ('~', "\\textasciitilde{}"),
        ('<', "\\textless{}"),
        ('>', "\\textgreater{}"),
        // The command for straight ones is missing in the encoding that LaTeX begins with.
        ('"', "''"),
        ('−', "$-$"),
        ('±', "$\\pm$"),
        ('·', "$\\cdot$"),
        ('×', "$\\times$"),
        ('≤', "$\\leq$"),
        ('≥', "$\\geq$"),
        ('≈', "$\\approx$"),
        ('→', "$\\rightarrow$"),
        ('←', "$\\leftarrow$"),
        ('↔', "$\\leftrightarrow$"),
        ('°', "$^\\circ$"),
        ('µ', "$\\mu$"),
        ('α', "$\\alpha$"),
        ('β', "$\\beta$"),
        ('γ', "$\\gamma$"),
        ('δ', "$\\delta$"),
        ('ε', "$\\varepsilon$"),
        ('ζ', "$\\zeta$"),
        ('η', "$\\eta$"),
        ('θ', "$\\theta$"),
        ('κ', "$\\kappa$"),
        ('λ', "$\\lambda$"),
        ('μ', "$\\mu$"),
        ('ν', "$\\nu$"),
        ('π', "$\\pi$"),
        ('ρ', "$\\rho$"),
        ('σ', "$\\sigma$"),
        ('τ', "$\\tau$"),
        ('φ', "$\\varphi$"),
        ('ψ', "$\\psi$"),
        ('ω', "$\\omega$"),
        ('Δ', "$\\Delta$"),
        ('Σ', "$\\Sigma$"),
        ('Ω', "$\\Omega$"),
        ('√', "$\\surd$"),
        ('∞', "$\\infty$"),
        ('∫', "$\\int$"),
        ('′', "$'$"),
        ('✓', "$\\surd$"),
        ('ₙ', "$_n$"),
        ('ₜ', "$_t$"),
        ('…', "\\ldots{}"),
        ('–', "--"),
        ('—', "---"),
        ('“', "``"),
        ('”', "''"),
        ('²', "$^2$"),
        ('³', "$^3$"),
        ('¹', "$^1$"),
        ('⁻', "$^-$"),
        ('\u{2009}', "\\,"),
        ('\u{a0}', "~"),
    ];
    const HIGH: [char; 8] = ['⁰', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹', '⁺'];
    /// The digits below the line stand in order.
    const LOW: std::ops::RangeInclusive<char> = '₀'..='₉';
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match SIGNS.iter().find(|s| s.0 == c) {
            Some((_, set)) => out.push_str(set),
            None => match HIGH.iter().position(|h| *h == c) {
                Some(0) => out.push_str("$^0$"),
                Some(7) => out.push_str("$^+$"),
                Some(k) => {
                    let _ = write!(out, "$^{}$", k + 3);
                }
                None if LOW.contains(&c) => {
                    let _ = write!(out, "$_{}$", c as u32 - *LOW.start() as u32);
                }
                None => out.push(c),
            },
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_never_a_command() {
        assert_eq!(
            latex(r"\input{a_b} 50 % & $x^2$ #~"),
            r"\textbackslash{}input\{a\_b\} 50 \% \& \$x\textasciicircum{}2\$ \#\textasciitilde{}"
        );
        assert_eq!(latex("−1.5·10⁻⁴ → η"), r"$-$1.5$\cdot$10$^-$$^4$ $\rightarrow$ $\eta$");
        assert_eq!(latex("i₀ = Δφ, \"x\""), r"i$_0$ = $\Delta$$\varphi$, ''x''");
        assert_eq!(unescaped("a &lt;b&gt; &amp;lt; &#955; &x"), "a <b> &lt; λ &x");
    }

    #[test]
    fn arcs_keep_to_their_circle_and_end_where_they_should() {
        for flags in [[false, false], [false, true], [true, false], [true, true]] {
            let all = arc((10.0, 0.0), [10.0, 10.0], 0.0, flags, (0.0, 10.0));
            let end = all.last().unwrap()[2];
            assert!((end.0 - 0.0).hypot(end.1 - 10.0) < 1e-9);
            // A quarter, or three of them.
            assert_eq!(all.len(), if flags[0] { 3 } else { 1 });
            // Its centre is the origin or the opposite corner of the square.
            let centre = if flags[0] == flags[1] { (10.0, 10.0) } else { (0.0, 0.0) };
            let off = |p: (f64, f64)| ((p.0 - centre.0).hypot(p.1 - centre.1) - 10.0).abs();
            assert!(all.iter().all(|c| off(c[2]) < 1e-9), "{flags:?} {all:?}");
        }
    }

    #[test]
    fn groups_move_what_is_in_them() {
        let map = transformed("translate(10 20) rotate(90)");
        let (x, y) = map.at(1.0, 0.0);
        assert!((x - 10.0).abs() < 1e-12 && (y - 21.0).abs() < 1e-12);
        let (x, y) = transformed("rotate(180 5 5)").at(0.0, 0.0);
        assert!((x - 10.0).abs() < 1e-12 && (y - 10.0).abs() < 1e-12);
    }

    #[test]
    fn a_mark_with_a_clip_of_its_own_is_cut_off() {
        let svg = concat!(
            r##"<svg><rect width="100" height="100" fill="#ffffff"/><defs><clipPath id="c"><path d="M0 0 H11 V11 Z"/></clipPath>"##,
            r##"</defs><path d="M0 0 L22 22" clip-path="url(#c)" stroke="#1a1a1a" fill="none"><title>t</title></path></svg>"##
        );
        let cut = concat!(
            "\\begin{scope}[even odd rule]\n\\path[clip] (0,0) -- (7,0) -- (7,7) -- cycle;\n\\begin{scope}[nonzero rule]\n",
            "\\path[draw=willis1a1a1a,line width=0.636bp] (0,0) -- (14,14);\n\\end{scope}\n\\end{scope}\n"
        );
        assert!(tikz(svg).contains(cut), "{}", tikz(svg));
    }

    #[test]
    fn marks_become_paths() {
        let svg = concat!(
            r##"<svg width="100" height="100"><title>a % b</title><rect width="100" height="100" fill="#ffffff"/>"##,
            r##"<defs><clipPath id="c"><path d="M0 0 H11 V11 Z"/></clipPath></defs><g clip-path="url(#c)">"##,
            r##"<line x1="0" y1="0" x2="11" y2="22" stroke="#1a1a1a" stroke-dasharray="11 5.5"/></g>"##,
            r##"<text x="11" y="11" font-size="11" text-anchor="end" fill="#1a1a1a">x_1 &lt; 2</text></svg>"##
        );
        let expected = concat!(
            "% a % b\n\\definecolor{willis1a1a1a}{HTML}{1A1A1A}\n\\begin{tikzpicture}[x=1bp,y=-1bp]\n",
            "\\begin{scope}[even odd rule]\n\\path[clip] (0,0) -- (7,0) -- (7,7) -- cycle;\n\\begin{scope}[nonzero rule]\n",
            "\\path[draw=willis1a1a1a,line width=0.636bp,dash pattern=on 7bp off 3.5bp] (0,0) -- (7,14);\n",
            "\\end{scope}\n\\end{scope}\n",
            "\\node[anchor=base east,inner sep=0,text=willis1a1a1a] at (7,7) ",
            "{\\fontsize{7bp}{8.4bp}\\selectfont\\sffamily x\\_1 \\textless{} 2};\n\\end{tikzpicture}\n"
        );
        assert_eq!(tikz(svg), expected);
    }
}
