//! `draw`: figures.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Code, Diagnostic, Diagnostics, Severity};
use willis::units::Dimension;
use willis::work::Work;
use willis_figure::report::document::Plate;
use willis_figure::{Ask, Drawing, Figure, FigureKind, FigureRequest, Theme, draw, themed};

use super::amount::{pair, values};
use super::names;
#[cfg(feature = "clap")]
use super::names::Known;
use crate::{File, Form, Given, Question, Refusal};

/// Draw a train: its scheme, levers, power flow, teeth, regimes, maps, losses.
///
/// A kind that does not apply to a train says why, and which do. `all` draws whatever applies. `--format json` gives the
/// figure as data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Draw {
    /// What to draw; `all` draws whatever applies into a folder.
    #[cfg_attr(feature = "clap", arg(help = kinds_help(), value_parser = Known(names::figures), hide_possible_values = true))]
    #[schemars(extend("enum" = names::figures()))]
    pub kind: String,
    /// A state of the shift table.
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// An operation; else the file's first, or all where a figure shows several.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// The set, mesh or scenario to draw.
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub part: Option<String>,
    /// A quantity along an axis, as `sweep` takes it: "sun.speed=500..3000 rpm:40".
    #[cfg_attr(feature = "clap", arg(long, value_name = "AXIS"))]
    pub over: Vec<String>,
    /// Members on which torque may act, with commas between (regimes); else the train's terminals.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ','))]
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero (regimes).
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "A,B"))]
    pub balance: Option<Vec<String>>,
    /// Show powers as they are seen from this member, such as a carrier (sankey, flow); else from the housing.
    #[cfg_attr(feature = "clap", arg(long, value_name = "MEMBER"))]
    pub seen_from: Option<String>,
    /// Draw teeth without geometry as nominal ones of module 1.
    #[cfg_attr(feature = "clap", arg(long))]
    pub nominal: bool,
    /// From when a scenario is shown (time): "3 s".
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME"))]
    pub from: Option<String>,
    /// Until when a scenario is shown (time): "3500 ms".
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME"))]
    pub to: Option<String>,
    /// Fewer points and samples, for a first look at what takes long (map, band).
    #[cfg_attr(feature = "clap", arg(long))]
    pub coarse: bool,
    /// Wheels turn (front, in SVG).
    #[cfg_attr(feature = "clap", arg(long))]
    pub animated: bool,
    /// Light or dark, or as the reader's screen is set.
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value_t = Look::Light))]
    pub theme: Look,
    /// Pixels of a PNG to a unit of the figure, from 0.1 to 10.
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 2.0, value_parser = scale))]
    pub scale: f32,
    /// Lay the figure out for paper so many mm wide, with no text below 7 pt; what cannot be so narrow is wider.
    #[cfg_attr(feature = "clap", arg(long, value_name = "MM", value_parser = paper))]
    pub width: Option<f64>,
}

impl Default for Draw {
    fn default() -> Self {
        Self {
            kind: "stick".into(),
            state: None,
            operation: None,
            part: None,
            over: vec![],
            terminals: None,
            balance: None,
            seen_from: None,
            nominal: false,
            from: None,
            to: None,
            coarse: false,
            animated: false,
            theme: Look::Light,
            scale: 2.0,
            width: None,
        }
    }
}

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Look {
    /// For paper.
    #[default]
    Light,
    /// For dark screens.
    Dark,
    /// As the screen is set, where the viewer tells.
    Auto,
}

/// Help of the kind: the list of them.
#[cfg(feature = "clap")]
fn kinds_help() -> String {
    let kinds = FigureKind::ALL.iter().map(|k| format!("\n  {:<10}{}", k.name(), k.about()));
    format!("What to draw; `all` draws whatever applies into a folder{}", kinds.collect::<String>())
}

/// Scales at which pictures are drawn.
const SCALES: std::ops::RangeInclusive<f32> = 0.1..=10.0;

/// A scale of pictures.
#[cfg(feature = "clap")]
fn scale(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(x) if SCALES.contains(&x) => Ok(x),
        _ => Err("a number from 0.1 to 10".into()),
    }
}

/// Widths of paper for figures, in mm.
const PAPERS: std::ops::RangeInclusive<f64> = 30.0..=2000.0;

/// A width of paper.
#[cfg(feature = "clap")]
fn paper(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if PAPERS.contains(&x) => Ok(x),
        _ => Err("a number of millimetres from 30 to 2000".into()),
    }
}

/// A figure, or all that apply.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum DrawAnswer {
    /// `willis-figures-1`.
    All(Figures),
    /// One figure as data, by its kind.
    One(Box<Figure>),
}

/// All figures that apply to a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Figures {
    /// `willis-figures-1`.
    pub format: Format<Self>,
    /// The figures, as data.
    pub figures: Vec<Figure>,
    /// Kinds that do not apply, and why.
    pub missing: Vec<Missing>,
}

/// A kind of figure that does not apply to a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Missing {
    /// The kind.
    pub kind: FigureKind,
    /// Why.
    pub why: String,
}

impl Contract for Figures {
    const FORMAT: &'static str = "willis-figures-1";
}

impl Contract for DrawAnswer {
    const FORMAT: &'static str = "willis-figure-1";
}

impl Draw {
    fn request(&self) -> Result<FigureRequest, Refusal> {
        Ok(FigureRequest {
            state: self.state.clone(),
            operation: self.operation.clone(),
            part: self.part.clone(),
            over: self.over.clone(),
            terminals: self.terminals.clone(),
            balance: pair(self.balance.as_deref())?,
            seen_from: self.seen_from.clone(),
            nominal: self.nominal,
            window: self.window()?,
            samples: 0,
        })
    }

    /// From when to when a scenario is shown.
    fn window(&self) -> Result<Option<[f64; 2]>, Diagnostics> {
        let time = |field: &str, given: &Option<String>| match given {
            None => Ok(None),
            Some(text) => {
                values(field, std::slice::from_ref(text), Dimension::TIME).map(|all| all.first().map(|q| q.si()))
            }
        };
        let (from, to) = (time("from", &self.from)?, time("to", &self.to)?);
        let asked = from.is_some() || to.is_some();
        Ok(asked.then(|| [from.unwrap_or(f64::NEG_INFINITY), to.unwrap_or(f64::INFINITY)]))
    }

    fn drawing(&self) -> Drawing {
        Drawing { animated: self.animated, width: self.width.map(Drawing::units) }
    }

    /// Refuses what would make no difference to this kind.
    fn heard(&self, kind: FigureKind, request: &FigureRequest) -> Result<(), Refusal> {
        let Some(deaf) = kind.deaf_to(request, self.drawing()) else { return Ok(()) };
        let list: Vec<String> = kind.takes().iter().map(|t| format!("`{}`", t.name())).collect();
        let instead =
            if list.is_empty() { "it takes none of these".to_owned() } else { format!("it takes {}", list.join(", ")) };
        let message = format!("`draw {}` has no use for `{}`", kind.name(), deaf.name());
        Err(Diagnostic::new(Code::UnknownSelection, "", message).hint(instead).into())
    }

    fn svg(&self, figure: &Figure) -> String {
        let theme = match self.theme {
            Look::Light => Theme::Light,
            Look::Dark => Theme::Dark,
            Look::Auto => Theme::Auto,
        };
        themed(&draw(figure, self.drawing()), theme)
    }
}

/// Outlines and dimensions of what has a true size.
const DXF: Form = Form { name: "dxf", endings: &["dxf"], about: "outlines and dimensions for CAD (front)" };

fn no_drawing(kind: FigureKind) -> Diagnostic {
    let message = format!("`draw {}` has no DXF: nothing in it has a true size", kind.name());
    Diagnostic::new(Code::Unfit, "", message).hint("`draw front` has one; other pictures are SVG or PNG")
}

/// A picture for papers in LaTeX.
const TIKZ: Form = Form { name: "tex", endings: &["tex"], about: "a TikZ picture for papers in LaTeX" };

/// The form of which a typesetter makes a page.
const PLATE: Form = Form { name: "plate", endings: &[], about: "a picture with its paper, which willis-pdf sets" };

impl Question for Draw {
    const NAME: &'static str = "draw";
    #[cfg(feature = "png")]
    const FORMS: &'static [Form] = &[
        Form { name: "svg", endings: &["svg"], about: "a picture that stays sharp" },
        Form { name: "png", endings: &["png"], about: "a picture of pixels" },
        DXF,
        TIKZ,
        PLATE,
    ];
    #[cfg(not(feature = "png"))]
    const FORMS: &'static [Form] =
        &[Form { name: "svg", endings: &["svg"], about: "a picture that stays sharp" }, DXF, TIKZ, PLATE];
    type Answer = DrawAnswer;

    fn check(&self) -> Result<(), Diagnostics> {
        if let Some(width) = self.width.filter(|w| !PAPERS.contains(w)) {
            let d = Diagnostic::new(Code::OutOfRange, "", format!("a picture is not laid out for {width} mm of paper"));
            return Err(d.hint(format!("from {} to {} mm", PAPERS.start(), PAPERS.end())).into());
        }
        if SCALES.contains(&self.scale) {
            return Ok(());
        }
        let d = Diagnostic::new(Code::OutOfRange, "", format!("a picture is not drawn at a scale of {}", self.scale));
        Err(d.hint(format!("from {} to {}", SCALES.start(), SCALES.end())).into())
    }

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<DrawAnswer, Refusal> {
        let (model, request) = (&of[0].model, self.request()?);
        if self.kind == "all" {
            let one = |k: usize| FigureKind::ALL[k].make_among_many(model, &request, work);
            let made = willis::work::map(work, FigureKind::ALL.len(), one)?;
            let (mut figures, mut missing) = (vec![], vec![]);
            for (kind, made) in FigureKind::ALL.iter().zip(made) {
                match made {
                    Ok(figure) => figures.push(figure),
                    Err(why) => {
                        let first = why.iter().find(|d| d.severity == Severity::Error);
                        missing.push(Missing { kind: *kind, why: first.map_or("", |d| &d.message).to_owned() });
                    }
                }
            }
            return Ok(DrawAnswer::All(Figures { format: Format::new(), figures, missing }));
        }
        let kind = FigureKind::named(&self.kind)?;
        self.heard(kind, &request)?;
        let narrows = |a: &Ask| matches!(a, Ask::State | Ask::Operation | Ask::Part | Ask::Over);
        let asked = request.asks().iter().any(narrows);
        work.afford(&kind.effort(model, &request))?;
        let coarse = if self.coarse { kind.make_coarse(model, &request, work) } else { None };
        match coarse.unwrap_or_else(|| kind.make_within(model, &request, work)) {
            Ok(figure) => Ok(DrawAnswer::One(Box::new(figure))),
            // Where a kind does not apply to a train at all, those that do are told.
            Err(wrong) if !asked => {
                let mut all: Vec<Diagnostic> = wrong.into_iter().collect();
                if let Some(first) = all.iter_mut().find(|d| d.severity == Severity::Error) {
                    let others: Vec<&str> = FigureKind::applicable(model).into_iter().map(FigureKind::name).collect();
                    first.hints.push(format!("of this train can be drawn: {}", others.join(", ")));
                }
                Err(Refusal::from(all.into_iter().collect::<willis::Diagnostics>()))
            }
            Err(wrong) => Err(wrong.into()),
        }
    }

    fn text(&self, answer: &DrawAnswer, _: &[Given]) -> String {
        match answer {
            DrawAnswer::One(figure) => format!("{}\n", figure.title()),
            DrawAnswer::All(all) => all.figures.iter().map(|f| format!("{}\n", f.title())).collect(),
        }
    }

    fn natural_form(&self) -> &'static str {
        "svg"
    }

    fn write(&self, answer: &DrawAnswer, form: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        let figures: Vec<&Figure> = match answer {
            DrawAnswer::One(figure) => vec![figure],
            // Of all figures those that have the form.
            DrawAnswer::All(all) if form == DXF.name => {
                let own: Vec<&Figure> = all.figures.iter().filter(|f| matches!(f, Figure::Front(_))).collect();
                if own.is_empty() {
                    return Err(no_drawing(FigureKind::Stick).into());
                }
                own
            }
            DrawAnswer::All(all) => all.figures.iter().collect(),
        };
        let picture = |figure: &Figure| -> Result<File, Refusal> {
            if form == PLATE.name {
                // Paper is light.
                let svg = draw(figure, self.drawing());
                let plate = Plate { format: Format::new(), svg, width_mm: self.width };
                let name = format!("{}.plate.json", figure.kind().name());
                let file = File::text(name, crate::json(&plate));
                return Ok(File { about: figure.title().to_owned(), ..file });
            }
            let name = format!("{}.{form}", figure.kind().name());
            if form == DXF.name {
                let bytes = match figure {
                    Figure::Front(view) => willis_figure::front_dxf(view).into_bytes(),
                    _ => return Err(no_drawing(figure.kind()).into()),
                };
                return Ok(File { name, bytes, about: figure.title().to_owned() });
            }
            if form == TIKZ.name {
                // Paper is light, and nothing on it moves.
                let still = Drawing { animated: false, ..self.drawing() };
                let bytes = willis_figure::tikz(&draw(figure, still)).into_bytes();
                return Ok(File { name, bytes, about: figure.title().to_owned() });
            }
            let svg = self.svg(figure);
            let bytes = match form {
                #[cfg(feature = "png")]
                "png" => willis_figure::png(&svg, self.scale)
                    .map_err(|why| Refusal::from(Diagnostic::new(Code::Unfit, "", why)))?,
                _ => (svg + "\n").into_bytes(),
            };
            Ok(File { name, bytes, about: figure.title().to_owned() })
        };
        figures.into_iter().map(picture).collect()
    }

    fn told(&self, answer: &DrawAnswer) -> Vec<String> {
        match answer {
            DrawAnswer::One(_) => vec![],
            DrawAnswer::All(all) => {
                all.missing.iter().map(|m| format!("{}: not drawn, {}", m.kind.name(), m.why)).collect()
            }
        }
    }
}
