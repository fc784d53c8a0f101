//! `simulate`: a scenario over time.

mod text;

use std::ops::ControlFlow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::dynamics::{Column, ColumnKind, Event, Method, Options, Outcome, Recorder, RunReport, Sample, simulate};
use willis::train::{Scenario, Train};
use willis::units::Dimension;
use willis::work::Work;
#[cfg(feature = "pictures")]
use willis_figure::TimePlotBuilder;

use super::amount::values;
use super::names;
use crate::table::{Cell, Kind, Table, word};
#[cfg(feature = "pictures")]
use crate::{Extra, File};
use crate::{Given, Question, Refusal};

pub use text::MOST_EVENTS;

/// Simulate a scenario: how the train accelerates, sticks, slips and shifts, and where the energy goes.
///
/// A run that jams, has several solutions or ends otherwise before the scenario is an answer, and the outcome
/// says so. Ctrl-C ends the run where it is. In both cases Willis writes and prints what was computed.
///
/// Rows are in SI units; where a value is not determined the field is empty (CSV) or null. Modes are 1 forward, -1
/// backward, 0 stuck, 2 free. A CSV of a run that ended early has a last line that begins with `# ` and says when and
/// why, also where the disk was full; in Parquet the metadata `willis.complete` is false and `willis.ended_s` has the time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Simulate {
    /// The scenario; required if the file has several.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCENARIO"))]
    pub scenario: Option<String>,
    /// Only these columns in rows and figure, by kind (speed, torque, mode, ...) or by name.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "KIND|NAME"))]
    pub columns: Vec<String>,
    /// How many rows, evenly spaced in time; else as the scenario says.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000_000_000)))]
    pub samples: Option<u32>,
    /// Rows and events from this time on: '2 s'. The run begins at its start, and energies are those of the whole run.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME"))]
    pub from: Option<String>,
    /// End the run here instead of at the end of the scenario: '3 s'.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME"))]
    pub to: Option<String>,
    /// Relative tolerance of speeds and angles, from 1e-13 to 1e-2 [default: 1e-10].
    #[cfg_attr(feature = "clap", arg(long, value_name = "TOLERANCE", value_parser = tolerance))]
    pub tolerance: Option<f64>,
    /// Use fixed time steps of this length (real time): '1 ms'.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME", conflicts_with = "tolerance"))]
    pub fixed_step: Option<String>,
    /// Take the sign of each tooth force from the step before, as in Galvagno 2010, to show the error of that.
    #[cfg_attr(feature = "clap", arg(long, requires = "fixed_step"))]
    pub lagged_forces: bool,
    /// Where several motions are possible, continue with the first.
    #[cfg_attr(feature = "clap", arg(long))]
    pub continue_when_ambiguous: bool,
    /// Stop after so many stick-slip changes within a thousandth of the scenario [default: 1000].
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", conflicts_with = "fixed_step", value_parser = clap::value_parser!(u64).range(1..)))]
    pub most_events: Option<u64>,
}

/// A relative tolerance that the arithmetic can keep.
#[cfg(feature = "clap")]
fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (1e-13..=1e-2).contains(&x) => Ok(x),
        _ => Err("a number from 1e-13 to 1e-2, as in 1e-9".into()),
    }
}

/// Rows that are kept in memory for an answer, those at events apart.
const MOST_ROWS: usize = 1_000_000;

/// Events that an answer has.
pub const MOST_KEPT: usize = 100_000;

/// Says how many changes of mode an answer does not have.
pub fn tell_of_events_left_out(report: &mut RunReport) {
    if report.event_count > report.events.len() && report.events.len() >= MOST_KEPT {
        report.notes.push(format!("of {} changes of mode the first {MOST_KEPT} are told", report.event_count));
    }
}

fn wrong(message: impl Into<String>, hint: impl Into<String>) -> Refusal {
    Diagnostic::new(Code::UnknownSelection, "", message).hint(hint).into()
}

impl Simulate {
    /// The same for the library.
    ///
    /// # Errors
    /// A fixed step that is no time above zero.
    pub fn options(&self, work: &dyn Work) -> Result<Options, Refusal> {
        let mut options = Options {
            patience_s: work.patience(),
            samples: self.samples.map(|n| n as usize),
            continue_when_ambiguous: self.continue_when_ambiguous,
            lagged_forces: self.lagged_forces,
            ..Options::default()
        };
        options.tolerance = self.tolerance.unwrap_or(options.tolerance);
        options.most_events = self.most_events.map_or(options.most_events, |n| n as usize);
        let time = |field: &str, given: &Option<String>| {
            let given = given.as_ref().map(std::slice::from_ref).unwrap_or_default();
            Ok::<_, Refusal>(values(field, given, Dimension::TIME)?.first().map(|q| q.si()))
        };
        (options.from_s, options.to_s) = (time("from", &self.from)?, time("to", &self.to)?);
        if let Some(text) = &self.fixed_step {
            let step_s = values("fixed-step", std::slice::from_ref(text), Dimension::TIME)?[0].si();
            if step_s <= 0.0 {
                let hint = "give a time above zero, as in 1 ms";
                return Err(wrong(format!("fixed-step {text} is no time above zero"), hint));
            }
            options.method = Method::Fixed { step_s };
        }
        Ok(options)
    }

    /// The scenario that is meant: of that name, or the only one.
    ///
    /// # Errors
    /// There is none, or none is named where there are several.
    pub fn scenario<'t>(&self, train: &'t Train) -> Result<&'t Scenario, Refusal> {
        let all = train.scenarios();
        let known = || all.iter().map(|s| format!("`{}`", s.name)).collect::<Vec<_>>().join(", ");
        match (&self.scenario, all) {
            (_, []) => {
                let message = format!("`{}` has no scenario to simulate", train.name());
                Err(wrong(message, "add a [[scenario]] to its file"))
            }
            (None, [one]) => Ok(one),
            (None, _) => Err(wrong(
                "the train has several scenarios, and none is named",
                format!("name one (`scenario`): {}", known()),
            )),
            (Some(name), _) => train.find_scenario(name).map_err(|d| (*d).into()),
        }
    }

    /// Positions of the time and of the columns that are asked for, by kind or by name.
    ///
    /// # Errors
    /// A column that the run does not have.
    pub fn select(&self, columns: &[Column]) -> Result<Vec<usize>, Refusal> {
        if self.columns.is_empty() {
            return Ok((0..columns.len()).collect());
        }
        let named = |c: &Column, w: &str| c.kind.name() == w || c.is_called(w);
        for w in &self.columns {
            if !columns.iter().any(|c| named(c, w)) {
                let mut kinds: Vec<&str> = Vec::new();
                for c in columns {
                    if !kinds.contains(&c.kind.name()) {
                        kinds.push(c.kind.name());
                    }
                }
                let example = columns.iter().find(|c| c.kind != ColumnKind::Time).map_or("time_s", |c| &c.name);
                return Err(Diagnostic::new(Code::UnknownSelection, "", format!("this run has no column `{w}`"))
                    .suggest(w, columns.iter().map(|c| c.name.as_str()))
                    .hint(format!("give kinds ({}) or names such as {example}", kinds.join(", ")))
                    .into());
            }
        }
        let kept = |c: &Column| c.kind == ColumnKind::Time || self.columns.iter().any(|w| named(c, w));
        Ok((0..columns.len()).filter(|&k| kept(&columns[k])).collect())
    }
}

/// Keeps everything in memory.
struct Keeper<'a> {
    request: &'a Simulate,
    work: &'a dyn Work,
    span: [f64; 2],
    told: u64,
    kept: Vec<usize>,
    columns: Vec<Column>,
    rows: Vec<Vec<Option<f64>>>,
    events: Vec<Event>,
    wrong: Option<Refusal>,
}

/// Steps of the bar.
const STEPS: u64 = 1000;

impl Recorder for Keeper<'_> {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        match self.request.select(columns) {
            Ok(kept) => self.kept = kept,
            Err(why) => {
                self.wrong = Some(why);
                return ControlFlow::Break(());
            }
        }
        self.columns = self.kept.iter().map(|&k| columns[k].clone()).collect();
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        if self.rows.len() >= MOST_ROWS + 2 * MOST_KEPT {
            let hint = "stream them into a file: -o run.csv or -o run.parquet";
            self.wrong = Some(wrong(format!("more than {} rows are too many for one answer", self.rows.len()), hint));
            return ControlFlow::Break(());
        }
        let finite = |&k: &usize| Some(sample.values[k]).filter(|x| x.is_finite());
        self.rows.push(self.kept.iter().map(finite).collect());
        self.progress(sample.time_s)
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        if self.events.len() < MOST_KEPT {
            self.events.push(event.clone());
        }
        ControlFlow::Continue(())
    }

    fn progress(&mut self, time_s: f64) -> ControlFlow<()> {
        let [start, end] = self.span;
        let now = ((time_s - start) / (end - start) * STEPS as f64).clamp(0.0, STEPS as f64) as u64;
        if now > self.told {
            self.work.advance(now - self.told);
            self.told = now;
        }
        if self.work.cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// The run for eyes; of its events as many as are kept.
pub fn run_text(report: &RunReport) -> String {
    text::text(report)
}

impl Question for Simulate {
    const NAME: &'static str = "simulate";
    const TABLES: &'static [&'static str] = &["rows", "events"];
    #[cfg(feature = "pictures")]
    const EXTRAS: &'static [Extra] =
        &[Extra { name: "plot", value: "FILE.svg", about: "Draw the run into this SVG file" }];
    type Answer = RunReport;

    fn check(&self) -> Result<(), Diagnostics> {
        names::apart(&[
            [("fixed_step", self.fixed_step.is_some()), ("tolerance", self.tolerance.is_some())],
            [("fixed_step", self.fixed_step.is_some()), ("most_events", self.most_events.is_some())],
        ])
    }

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<RunReport, Refusal> {
        let train = of[0].model.train();
        let (scenario, options) = (self.scenario(train)?, self.options(work)?);
        let rows = options.samples.unwrap_or(scenario.samples);
        if rows > MOST_ROWS {
            let hint = "stream them into a file: -o run.csv or -o run.parquet";
            return Err(wrong(format!("{rows} rows are too many for one answer"), hint));
        }
        work.begin("thousandths of the scenario", STEPS);
        let mut keeper = Keeper {
            request: self,
            work,
            span: [scenario.start, options.to_s.unwrap_or(scenario.end)],
            told: 0,
            kept: vec![],
            columns: vec![],
            rows: vec![],
            events: vec![],
            wrong: None,
        };
        let run = simulate(train, &scenario.name, &options, &mut keeper);
        if let Some(wrong) = keeper.wrong {
            return Err(wrong);
        }
        let mut report = run?;
        report.events = keeper.events;
        tell_of_events_left_out(&mut report);
        report.columns = Some(keeper.columns);
        report.rows = Some(keeper.rows);
        Ok(report)
    }

    fn text(&self, answer: &RunReport, _: &[Given]) -> String {
        text::text(answer)
    }

    fn tables(&self, answer: &RunReport) -> Vec<Table> {
        let columns = answer.columns.as_deref().unwrap_or_default();
        let kind = |c: &Column| if c.kind == ColumnKind::Mode { Kind::Integer } else { Kind::Number };
        let mut rows = Table::new("rows", columns.iter().map(|c| (c.name.as_str(), kind(c))));
        for (column, c) in rows.columns.iter_mut().zip(columns) {
            column.unit = c.unit.symbol().to_owned();
        }
        for row in answer.rows.iter().flatten() {
            rows.row(row.iter().zip(columns).map(|(x, c)| match (x, kind(c)) {
                (Some(x), Kind::Integer) => Cell::Integer(*x as i64),
                (x, _) => Cell::from(*x),
            }));
        }
        let mut events = Table::new("events", [("time_s", Kind::Number), ("cause", Kind::Text), ("modes", Kind::Text)]);
        for e in &answer.events {
            let modes: Vec<String> = e.modes.iter().map(|(name, m)| format!("{name} {}", word(m))).collect();
            events.row([e.time_s.into(), (&e.cause).into(), modes.join("; ").into()]);
        }
        vec![rows, events]
    }

    fn is_partial(answer: &RunReport) -> bool {
        answer.outcome == Outcome::Interrupted
    }

    #[cfg(feature = "pictures")]
    fn extra(&self, answer: &RunReport, _: &str, of: &[Given]) -> Result<Vec<File>, Refusal> {
        let mut plot =
            TimePlotBuilder::new(of[0].model.train(), [answer.from_s.unwrap_or(answer.start_s), answer.scenario_end_s]);
        let _ = plot.columns(answer.columns.as_deref().unwrap_or_default());
        for row in answer.rows.iter().flatten() {
            let values: Vec<f64> = row.iter().map(|x| x.unwrap_or(f64::NAN)).collect();
            let _ = plot.sample(Sample { time_s: values[0], values: &values });
        }
        for event in &answer.events {
            let _ = plot.event(event);
        }
        Ok(vec![File::text("run.svg", willis_figure::draw_time(&plot.finish(answer)) + "\n")])
    }
}
