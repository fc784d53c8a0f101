//! The engineering report of a train: what was asked, what was assumed, what came out, and how to do it again.

pub mod document;
mod formula;
mod gears;
pub mod html;
mod laws;
pub(crate) mod paper;
mod results;
mod scheme;
mod wheels;

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use willis::Diagnostics;
use willis::analysis::{Analysis, OperationReport, Selection, Verdict, analyze};
use willis::diagnostic::{Code, Diagnostic, Severity};
use willis::model::Model;
use willis::study::{PointAnswer, Sensitivity, UncertaintyPlan, UncertaintyRequest, sensitivity};
use willis::train::Train;
use willis::unstable;
use willis::work::{self, Cancelled, Effort, Work};

use crate::parts::markup::untitled;
use crate::parts::style::watts;
use crate::parts::words::{self, Names, spelled};
use crate::report::document::{Block, Column, Document, Level, Section, TitleBlock};
use crate::{Drawing, Figure, FigureKind, FigureRequest, draw};

/// Operations that get pictures of their own; all are told in tables.
const PICTURED: usize = 4;
/// Operations that are told one by one, and rows of a table: a report is read by people.
const TOLD: usize = 100;
/// Widths of figures, in their units: of the text of a page, and of a page for figures alone.
const WIDTHS: [u32; 2] = [770, 1180];

/// What a report is about.
#[derive(Clone, Debug, Default)]
pub struct ReportRequest {
    /// Only this operation.
    pub operation: Option<String>,
    /// Name of the train file, as the reader of the report would give it.
    pub file: String,
    /// SHA-256 of the train file, in hexadecimal digits.
    pub hash: String,
    /// The program and its version.
    pub version: String,
    /// The commands that make the results again.
    pub commands: Vec<String>,
    /// Who makes it for what.
    pub title_block: TitleBlock,
    /// Whether the train file stands at the end.
    pub appendix: bool,
}

/// Everything that a report tells.
struct Findings<'a> {
    model: &'a Model,
    request: &'a ReportRequest,
    analysis: Analysis,
    /// Where there is an operating point.
    sensitivity: Option<Result<Sensitivity, Diagnostics>>,
    /// How sure the first operating points are, by name.
    sure: Vec<(String, Option<Sure>)>,
    figures: Figures,
}

impl Findings<'_> {
    fn sure(&self, operation: &str) -> Option<&Sure> {
        self.sure.iter().find(|(name, _)| name == operation)?.1.as_ref()
    }

    fn warnings(&self) -> impl Iterator<Item = &Diagnostic> {
        self.analysis.diagnostics.iter().filter(|d| d.severity == Severity::Warning)
    }
}

/// Between which efficiencies most samples of an operating point lie.
struct Sure {
    low: f64,
    high: f64,
    samples: usize,
    /// What was uncertain, with its distribution.
    varied: Vec<String>,
}

impl Sure {
    /// Samples of an operating point: enough for its band, too few for the tails.
    const SAMPLES: usize = 128;

    /// Nothing where nothing is uncertain, or where most samples have no answer.
    fn of(model: &Model, operation: &str) -> Option<Self> {
        let operation = Some(operation.to_owned());
        let request = UncertaintyRequest { operation, samples: Self::SAMPLES, ..Default::default() };
        let plan = UncertaintyPlan::new(model, &request).ok()?;
        let samples: Vec<usize> = (0..plan.len()).filter(|k| plan.design().is_sample(*k)).collect();
        let mut trains = Default::default();
        let answers = samples.iter().map(|k| plan.answer(*k, &mut trains)).filter(PointAnswer::is_unique);
        let mut found: Vec<f64> = answers.map(|a| a.efficiency()).filter(|e| e.is_finite()).collect();
        if 2 * found.len() < samples.len() || found.is_empty() {
            return None;
        }
        found.sort_by(f64::total_cmp);
        let [low, high] = [0.05, 0.95].map(|p| unstable::quantile(&found, p));
        let varied = plan.quantities().iter().map(|q| spelled(&format!("{} {}", q.name, q.describe()))).collect();
        (high > low).then_some(Self { low, high, samples: samples.len(), varied })
    }

    fn range(&self) -> String {
        format!("{} to {}", results::exact_percent(self.low).replace(" %", ""), results::exact_percent(self.high))
    }

    fn words(&self) -> String {
        /// Quantities that are named.
        const NAMED: usize = 4;
        let more = match self.varied.len().saturating_sub(NAMED) {
            0 => String::new(),
            n => format!("; and {n} more"),
        };
        let named: Vec<&str> = self.varied.iter().take(NAMED).map(String::as_str).collect();
        format!("90 % of {} samples lie from {}, because of: {}{more}.", self.samples, self.range(), named.join("; "))
    }
}

/// A picture that was asked for: its kind, and what it is of where there are several.
struct Made {
    kind: FigureKind,
    of: Option<String>,
    picture: Picture,
}

/// What became of a picture.
enum Picture {
    /// It is there, as SVG.
    Drawn(String),
    /// The train has nothing of its kind, or it would say no more than a sentence.
    Nothing,
    /// It could not be made, for this reason.
    Failed(String),
}

/// The pictures of a report.
#[derive(Default)]
struct Figures(Vec<Made>);

impl Figures {
    /// Makes what is wanted. One that fails, or even panics, takes nothing else with it.
    fn make(
        work: &dyn Work,
        wanted: &[(FigureKind, FigureRequest)],
        make: impl Fn(FigureKind, &FigureRequest) -> Result<Figure, Diagnostics> + Sync,
    ) -> Result<Self, Cancelled> {
        work.begin("pictures", wanted.len() as u64);
        let one = |k: usize| {
            let (kind, request) = &wanted[k];
            let drawn = || {
                let figure = make(*kind, request)?;
                Ok(worth_showing(&figure).then(|| on_paper(&figure)))
            };
            // Nothing outlives a panic that it could have left half done.
            let picture = match catch_unwind(AssertUnwindSafe(drawn)) {
                Ok(Ok(Some(svg))) => Picture::Drawn(svg),
                Ok(Ok(None)) => Picture::Nothing,
                Ok(Err(wrong)) => Picture::of(&wrong),
                Err(panic) => Picture::Failed(format!("a fault of the program: {}", last_words(&*panic))),
            };
            work.advance(1);
            // Of some kinds there is one for every set or operation.
            let of = match kind {
                FigureKind::Front => request.part.clone(),
                FigureKind::Sankey | FigureKind::Lever => request.operation.clone(),
                _ => None,
            };
            Made { kind: *kind, of, picture }
        };
        Ok(Self(work::map(work, wanted.len(), one)?))
    }

    /// The picture of a kind, as a block, or that it failed; what it is of, where there are several.
    fn block(&self, kind: FigureKind, of: Option<&str>, caption: &str) -> Option<Block> {
        let made = self.0.iter().find(|f| f.kind == kind && f.of.as_deref() == of)?;
        match &made.picture {
            Picture::Drawn(svg) => Some(Block::Figure { caption: caption.to_owned(), svg: svg.clone() }),
            Picture::Nothing => None,
            Picture::Failed(why) => {
                let text = format!("{caption}: this picture could not be made. {why}");
                Some(Block::Notice { level: Level::Warning, text })
            }
        }
    }
}

impl Picture {
    /// What a refusal means: a kind that does not fit the train is nothing to tell in a report.
    fn of(wrong: &Diagnostics) -> Self {
        let errors = wrong.iter().filter(|d| d.severity == Severity::Error);
        let why: Vec<&str> = errors.filter(|d| d.code != Code::Unfit).map(|d| d.message.as_str()).collect();
        if why.is_empty() { Self::Nothing } else { Self::Failed(why.join("; ")) }
    }
}

/// What a panic says of itself.
fn last_words(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no reason is known")
}

/// A figure laid out for the text of a page; where it does not fit there, for a page of its own. Its caption is its title.
fn on_paper(figure: &Figure) -> String {
    let drawn = |width| untitled(&draw(figure, Drawing { width: Some(width), ..Drawing::default() }));
    let text = drawn(WIDTHS[0]);
    if html::fits_text(&text) { text } else { drawn(WIDTHS[1]) }
}

/// Whether a figure says more than a sentence would.
fn worth_showing(figure: &Figure) -> bool {
    match figure {
        Figure::Map(m) => m.points.iter().any(|p| p.efficiency.is_some()),
        Figure::Losses(l) => !l.series.is_empty(),
        // A band that is level everywhere is a number, which is told.
        Figure::Band(b) => {
            let known = || b.points.iter().filter_map(|p| p.efficiency);
            let first = known().next();
            known().any(|q| first.is_some_and(|f| f.iter().zip(q).any(|(a, b)| (a - b).abs() > 1e-4)))
        }
        _ => true,
    }
}

/// Writes the report of a train. A picture that fails is named in its place, with the reason.
///
/// # Errors
/// What [`analyze`] says; the work was cancelled.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::work::Serial;
/// use willis_figure::{ReportRequest, html, report};
///
/// let text = r#"
///     format = 1
///     name = "one set"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     mesh_efficiency = 0.99
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "10 N m" }
/// "#;
/// let model = Model::from_toml(text).unwrap();
/// let document = report(&model, &ReportRequest::default(), &Serial)?;
/// assert!(html(&document).contains("98.607 %"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn report(model: &Model, request: &ReportRequest, work: &dyn Work) -> Result<Document, Diagnostics> {
    let train = model.train();
    let selection = Selection { state: None, operation: request.operation.clone() };
    work.afford(&Effort::of_analysis(train, &selection))?;
    let analysis = analyze(train, &selection)?.with_loads(train).with_bands(train);
    // Only the first operation's is shown.
    let first = analysis.operations.first().map(|o| Selection { operation: Some(o.name.clone()), ..selection });
    let sensitivity = first.map(|first| sensitivity(train, &first));
    let shown: Vec<&str> = analysis.operations.iter().take(PICTURED).map(|o| o.name.as_str()).collect();
    let sure = work::map(work, shown.len(), |k| (shown[k].to_owned(), Sure::of(model, shown[k])))?;
    let wanted = wanted(model, request, &analysis);
    let figures = Figures::make(work, &wanted, |kind, request| kind.make_among_many(model, request, work))?;
    let all = Findings { model, request, analysis, sensitivity, sure, figures };
    let sections = [
        Some(summary(&all)),
        Some(scheme::section(&all)),
        results::shift_table(&all),
        results::operations(&all),
        results::losses(&all),
        results::heat(&all),
        results::maps(&all),
        results::motion(&all),
        results::formulas(&all),
        Some(laws::assumptions(&all)),
        laws::in_force(&all),
        Some(laws::again(&all)),
        request.appendix.then(|| laws::appendix(&all)),
    ];
    let sections = sections.into_iter().flatten().filter(|s| !s.blocks.is_empty());
    Ok(Document {
        format: Default::default(),
        title: train.name().to_owned(),
        subtitle: "Gear train report".to_owned(),
        title_block: request.title_block.clone(),
        facts: facts(&all),
        sections: sections.map(shortened).map(|s| in_words(train, s)).collect(),
    })
}

/// A section without keys and marks of code in its sentences.
fn in_words(train: &Train, mut section: Section) -> Section {
    let names = Names::new(
        (train.members().iter().map(|m| m.name.as_str()))
            .chain(train.meshes().iter().map(|m| m.name.as_str()))
            .chain(train.sets().iter().map(|s| s.name.as_str()))
            .chain(train.shift_elements().iter().map(|e| e.name.as_str()))
            .chain(train.variators().iter().map(|v| v.name.as_str()))
            .chain(train.states().iter().map(|s| s.name.as_str()))
            .chain(train.operations().iter().map(|o| o.name.as_str()))
            .chain(train.scenarios().iter().map(|s| s.name.as_str()))
            .chain([train.name()]),
    );
    let plain = |text: &mut String| *text = words::plain(text, &names);
    for block in &mut section.blocks {
        match block {
            Block::Text { text } | Block::Notice { text, .. } => plain(text),
            Block::List { items } => items.iter_mut().for_each(plain),
            Block::Table { caption, .. } | Block::Figure { caption, .. } => plain(caption),
            _ => {}
        }
    }
    section
}

/// That only the first of many are told.
fn and_more(count: usize, what: &str) -> Option<Block> {
    let text = || format!("These are the first {TOLD} of {count} {what}; `analyze` has all.");
    (count > TOLD).then(|| Block::Notice { level: Level::Note, text: text() })
}

/// Long tables by their first rows, with the number of all.
fn shortened(mut section: Section) -> Section {
    for block in &mut section.blocks {
        if let Block::Table { caption, rows, .. } = block
            && rows.len() > TOLD
        {
            *caption += &format!("; the first {TOLD} of {} rows, `analyze` has all", rows.len());
            rows.truncate(TOLD);
        }
    }
    section
}

/// The pictures that a report asks for.
fn wanted(model: &Model, request: &ReportRequest, analysis: &Analysis) -> Vec<(FigureKind, FigureRequest)> {
    use FigureKind::*;
    let train = model.train();
    let only = FigureRequest { operation: request.operation.clone(), ..Default::default() };
    let plain = |kind| (kind, FigureRequest::default());
    // The longest first, so that the cores end together.
    let mut all = vec![
        (Map, only.clone()),
        plain(Time),
        (Losses, only.clone()),
        (Tornado, only.clone()),
        (
            Stick,
            FigureRequest { state: analysis.operations.first().and_then(|o| o.state.clone()), ..Default::default() },
        ),
        plain(Shift),
        plain(Regimes),
        (Split, only.clone()),
        (Film, only.clone()),
        (Path, only.clone()),
    ];
    if !analysis.operations.is_empty() {
        all.push((Band, FigureRequest { samples: 128, ..only.clone() }));
    }
    if train.heat().is_some() && !analysis.operations.is_empty() {
        all.push((Heat, only.clone()));
    }
    for set in train.sets() {
        all.push((Front, FigureRequest { part: Some(set.name.clone()), ..Default::default() }));
    }
    for o in analysis.operations.iter().take(PICTURED) {
        let own = FigureRequest { operation: Some(o.name.clone()), ..Default::default() };
        all.extend([(Sankey, own.clone()), (Lever, own)]);
    }
    if analysis.operations.is_empty() {
        all.push(plain(Lever));
    }
    all
}

fn facts(all: &Findings<'_>) -> Vec<[String; 2]> {
    let mut facts = vec![];
    let mut fact = |name: &str, value: String| facts.push([name.to_owned(), value]);
    fact("Degrees of freedom", all.analysis.degrees_of_freedom.to_string());
    let sound = |v: Verdict| matches!(v, Verdict::Unique | Verdict::Unloaded);
    let without = all.analysis.operations.iter().filter(|o| !sound(o.verdict)).count();
    let count = all.analysis.operations.len();
    match (count, without) {
        (0, _) => fact("Operating points", "none in the file".to_owned()),
        (_, 0) => fact("Operating points", format!("{count}, each with a single answer")),
        _ => fact("Operating points", format!("{count}, {without} of them without a single answer")),
    }
    fact("Warnings", all.warnings().count().to_string());
    if !all.request.version.is_empty() {
        fact("Made with", all.request.version.clone());
    }
    if !all.request.hash.is_empty() {
        fact("Train file", all.request.file.clone());
    }
    facts
}

/// What was examined and what came out, on the first page.
fn summary(all: &Findings<'_>) -> Section {
    let mut blocks = vec![Block::Notice { level: Level::Note, text: scope(all) }];
    let train = all.model.train();
    blocks.extend(gears::tables(train, &all.analysis));
    let columns = ["Operating point", "Verdict"].map(Column::words).into_iter();
    let columns = columns.chain(["Efficiency", "90 % band", "Power in", "Lost"].map(Column::numbers)).collect();
    let rows: Vec<Vec<String>> = (all.analysis.operations.iter())
        .map(|o| {
            let one = results::single(o);
            let state = o.state.as_ref().map(|s| format!(", state {s}")).unwrap_or_default();
            vec![
                format!("{}{state}", o.name),
                o.verdict_words().to_owned(),
                one.map_or("–".into(), results::efficiency),
                all.sure(&o.name).filter(|_| one.is_some()).map_or("–".into(), Sure::range),
                one.map_or("–".into(), |s| watts(s.input_power_w)),
                one.map_or("–".into(), |s| watts(s.loss_w)),
            ]
        })
        .collect();
    if !rows.is_empty() {
        let mut caption = "Operating points".to_owned();
        if let Some(s) = all.analysis.operations.iter().find_map(results::single) {
            caption += &format!("; efficiency {}", results::basis(s));
            if !train.states().is_empty() {
                caption += ", not the nominal one of the shift table";
            }
        }
        blocks.push(Block::Table { caption, columns, rows });
    }
    blocks.extend(warnings(all));
    let open = || all.analysis.operations.iter().filter(|o| o.verdict != Verdict::Unique);
    blocks.extend(open().take(TOLD).map(notice));
    blocks.extend(and_more(open().count(), "operating points without a single answer"));
    let all_proved =
        |o: &OperationReport| o.verdict == Verdict::Unique && o.certificate.is_some_and(|c| c.unique_for_every_load);
    if !all.analysis.operations.is_empty() && all.analysis.operations.iter().all(all_proved) {
        let text =
            "Each operating point has exactly one equilibrium: this is proved, for any load in the same directions of rotation \
             and with these efficiencies. The accuracy of the values is stated with each point."
                .to_owned();
        blocks.push(Block::Notice { level: Level::Good, text });
    }
    if let Some(first) = all.sensitivity.as_ref().and_then(|s| s.as_ref().ok()?.operations.first())
        && let Some(q) = first.quantities.first()
    {
        let text = format!(
            "At {} the quantity that matters most is {}: a step of {} changes the losses by {}.",
            first.name,
            spelled(&q.name),
            q.step.size(),
            results::signed_watts(q.loss_change_w)
        );
        blocks.push(Block::Text { text });
    }
    Section { title: "Summary".into(), blocks }
}

/// What the report is about, and what it is not.
fn scope(all: &Findings<'_>) -> String {
    let computed = |o: &OperationReport| results::single(o).is_some_and(|s| !s.sources.is_empty());
    let bearings = |o: &OperationReport| results::single(o).is_some_and(|s| !s.bearings.0.is_empty());
    let mut examined = vec!["ratios", "speeds", "torques"];
    if all.analysis.operations.is_empty() {
        examined.push("nominal efficiencies");
    } else {
        examined.extend(["power flow", "efficiency"]);
    }
    if all.analysis.operations.iter().any(computed) {
        examined.push("losses by source");
    }
    if all.analysis.operations.iter().any(bearings) {
        examined.push("forces on bearings");
    }
    if !all.model.train().scenarios().is_empty() {
        examined.push("motion");
    }
    format!(
        "Scope. Examined: {}. Not examined: strength. Nothing is said of the load capacity of tooth flanks and roots, the life \
         of bearings, shafts and housings, or noise.",
        examined.join(", ")
    )
}

/// Warnings belong where nobody overlooks them; of many the first, and where the others are.
fn warnings(all: &Findings<'_>) -> Vec<Block> {
    const FIRST: usize = 6;
    let count = all.warnings().count();
    let notice = |text: String| Block::Notice { level: Level::Warning, text };
    let mut blocks: Vec<Block> = (all.warnings().take(FIRST)).map(|d| notice(laws::told(d))).collect();
    if count > FIRST {
        blocks.push(notice(format!("{} more stand under Assumptions and warnings.", count - FIRST)));
    }
    blocks
}

/// The verdict of an operating point in words.
fn notice(o: &OperationReport) -> Block {
    let level = match o.verdict {
        Verdict::Unique => Level::Good,
        Verdict::Unloaded => Level::Note,
        _ => Level::Stop,
    };
    let mut text = format!("{}: {}", o.name, o.verdict_words());
    if let Some(c) = &o.certificate {
        text += &format!("; {}", results::certificate(o.verdict, c));
    }
    if let Some(reason) = &o.reason {
        text += &format!(". {reason}");
    }
    Block::Notice { level, text }
}

#[cfg(test)]
mod tests {
    use willis::work::Serial;

    use super::*;

    #[test]
    fn a_picture_that_fails_is_named_with_its_reason_and_the_others_stand() {
        let wanted = [FigureKind::Map, FigureKind::Band, FigureKind::Time, FigureKind::Shift, FigureKind::Regimes]
            .map(|kind| (kind, FigureRequest::default()));
        let train = Model::from_toml(
            r#"
            format = 1
            name = "one set"
            members = ["s", "c"]
            terminals = ["s", "c"]
            [[set]]
            name = "P1"
            sun = { member = "s", teeth = 30 }
            ring = { member = "frame", teeth = 70 }
            carrier = "c"
            "#,
        )
        .expect("a good train");
        let figures = Figures::make(&Serial, &wanted, |kind, _| match kind {
            FigureKind::Map => panic!("index {} out of bounds", 7),
            FigureKind::Band => Err(Diagnostic::new(Code::BadAxis, "", "too many points").into()),
            FigureKind::Time => Err(Diagnostic::new(Code::Unfit, "", "there is no scenario").into()),
            _ => FigureKind::Stick.make(&train, &FigureRequest::default()),
        })
        .expect("nobody cancels");
        let said = |kind| figures.block(kind, None, "The caption");
        let failed = |why: &str| {
            let text = format!("The caption: this picture could not be made. {why}");
            Some(Block::Notice { level: Level::Warning, text })
        };
        assert_eq!(said(FigureKind::Map), failed("a fault of the program: index 7 out of bounds"));
        assert_eq!(said(FigureKind::Band), failed("too many points"));
        assert_eq!(said(FigureKind::Time), None);
        assert!(matches!(said(FigureKind::Shift), Some(Block::Figure { .. })));
        assert!(matches!(said(FigureKind::Regimes), Some(Block::Figure { .. })));
    }
}
