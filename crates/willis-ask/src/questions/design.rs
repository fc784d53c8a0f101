//! `design`: trains by what they must do.

#[cfg(feature = "pictures")]
mod picture;
mod tables;
mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::Contract;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::work::Work;
use willis_synthesis::teeth::{self, Around, DesignAnswer, Objective, Progress, Start, StartKind};

use super::names;
use super::parts::{part, parts};
use crate::table::Table;
use crate::{Attachment, Extra, File, Form, Given, Holds, Of, Question, Refusal};

/// Find every train that does what is wanted: tooth numbers, numbers of planets, modules.
///
/// The file is a train file in which teeth and planets are ranges ("18..60", "18.. odd", [23, 29]) with a table `[design]`:
/// ratios of the states with tolerances, rules, limits, demands, and what is to be small or large. The whole space is
/// searched: the answer says how many trains satisfy the wish, that there are no others, and which of them no other one
/// beats. For an empty answer it says which wish must give, and how far.
///
/// Without a file, a kind of drive with its ratio will do: --kind with --ratio, perhaps --ring. With --like a train of your
/// own is marked among the rows; without a file it is also where the search begins. With --write rows are train files for
/// every other command; with --teeth so are tooth numbers, without a search.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Design {
    /// The design file (TOML), or - for standard input.
    #[cfg_attr(feature = "clap", arg(value_name = "FILE"))]
    pub file: Option<Attachment>,
    /// A train that exists: a row of its own. Without FILE, trains with its connections, ratios and rings are searched.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TRAIN.toml"))]
    pub like: Option<Attachment>,
    /// Without a file: the kind of drive, simple, two-stage, 3k, stepped, two-rings or ravigneaux.
    #[cfg_attr(feature = "clap", arg(long, value_name = "KIND", conflicts_with_all = ["file", "like"]))]
    pub kind: Option<String>,
    /// Of --kind: the ratio, a number or low..high.
    #[cfg_attr(feature = "clap", arg(long, value_name = "RATIO", conflicts_with = "file"))]
    pub ratio: Option<String>,
    /// Of --kind and --like: how far a ratio may be off, as a part. Default: 0.01.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PART", conflicts_with = "file"))]
    pub tolerance: Option<String>,
    /// Of --kind and --like: the largest reference diameter of a ring: 90mm.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LENGTH", conflicts_with = "file"))]
    pub ring: Option<String>,
    /// Of --kind: modules that are allowed: 0.5mm,0.6mm. Default where the ring is limited: those of DIN 780 to 8 mm.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "LENGTH", conflicts_with = "file"))]
    pub module: Vec<String>,
    /// Of --kind: numbers of planets. Default: 3..5.
    #[cfg_attr(feature = "clap", arg(long, value_name = "RANGE", conflicts_with = "file"))]
    pub planets: Option<String>,
    /// Of --kind and --like: the least efficiency from input to output.
    #[cfg_attr(feature = "clap", arg(long, value_name = "EFFICIENCY", conflicts_with = "file"))]
    pub forward: Option<String>,
    /// Of --kind and --like: the least efficiency from output to input: a drive that can be driven back.
    #[cfg_attr(feature = "clap", arg(long, value_name = "EFFICIENCY", conflicts_with = "file"))]
    pub backward: Option<String>,
    /// Show so many rows. Default: 20.
    #[cfg_attr(feature = "clap", arg(long, value_name = "ROWS"))]
    pub top: Option<usize>,
    /// Sort by error, ring_diameter, forward, backward, lock_margin, planet_spin, member_speed or element_torque.
    /// Default: the first objective of the file.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OBJECTIVE"))]
    pub sort: Option<String>,
    /// Rows of all trains that satisfy the wish, not only of those that no other one beats.
    #[cfg_attr(feature = "clap", arg(long))]
    pub all: bool,
    /// Compute so many trains at most with the laws of friction of the file, in its operations, so that these laws rank them:
    /// all trains where there are no more, else those that no other one beats. With 0 mesh efficiencies rank. Default: 500.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TRAINS"))]
    pub recompute: Option<u64>,
    /// Write the train files of these rows: 3, or 1,2,5 into a folder.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "ROWS"))]
    pub write: Vec<u64>,
    /// Give the train with these teeth as a train file, without a search: 12/47/105/40/99 as in a row, of several sets
    /// 20/12/44,22/13/48.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_delimiter = ',', value_name = "TEETH", conflicts_with_all = ["write", "shard", "all", "resume"])
    )]
    pub teeth: Vec<String>,
    /// Only this part of the work: 3/16 is the third of sixteen.
    #[cfg_attr(feature = "clap", arg(long, value_name = "K/N"))]
    pub shard: Option<String>,
    /// Go on from what --progress kept; several times to put parts together.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.json"))]
    pub resume: Vec<Attachment>,
}

/// What was found, and how far the search is.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct DesignFound {
    /// `willis-design-1`.
    pub report: DesignAnswer,
    /// The design, with which rows become train files.
    #[serde(skip)]
    pub design: Option<teeth::Design>,
    /// How far the search is, to go on with.
    #[serde(skip)]
    pub progress: Progress,
    /// Whether the work was stopped before what was asked for was done.
    #[serde(skip)]
    pub stopped: bool,
}

impl Contract for DesignFound {
    const FORMAT: &'static str = DesignAnswer::FORMAT;
}

impl Design {
    /// The design with the file in which its places are.
    fn read(&self) -> Result<(teeth::Design, Attachment), Refusal> {
        let file = match (&self.file, &self.kind, &self.like) {
            (Some(file), _, _) => file.clone(),
            (None, Some(kind), _) => {
                let kind: StartKind = kind.parse().map_err(|d: Box<Diagnostic>| Refusal::from(*d))?;
                let start = Start {
                    ratio: self.ratio.clone(),
                    tolerance: self.tolerance.clone(),
                    ring: self.ring.clone(),
                    modules: self.module.clone(),
                    planets: self.planets.clone(),
                    forward: self.forward.clone(),
                    backward: self.backward.clone(),
                    ..Start::new(kind)
                };
                Attachment { name: "the design that the options make".into(), text: start.to_toml() }
            }
            (None, None, Some(like)) => {
                let tolerance = self.tolerance.as_deref().unwrap_or("0.01");
                let around = Around {
                    ring: self.ring.clone(),
                    forward: self.forward.clone(),
                    backward: self.backward.clone(),
                    ..Around::new(tolerance)
                };
                let text = around.to_toml(&like.text).map_err(|w| Refusal::File(w, like.clone()))?;
                Attachment { name: format!("the design around {}", like.name), text }
            }
            (None, None, None) => {
                let d = Diagnostic::new(Code::MissingKey, "file", "nothing says what is to be designed");
                let hint =
                    "name a design file; or a `kind` of drive with its `ratio`; or a train that it shall be `like`";
                return Err(d.hint(hint).into());
            }
        };
        match teeth::Design::from_toml(&file.text) {
            Ok(design) => Ok((design, file)),
            Err(wrong) => Err(Refusal::File(wrong, file)),
        }
    }

    /// What is known from earlier parts of the search.
    fn resumed(&self, design: &teeth::Design) -> Result<Progress, Refusal> {
        let mut whole = Progress::default();
        for file in &self.resume {
            let refused = |wrong: Diagnostics| Refusal::File(wrong, Attachment { text: String::new(), ..file.clone() });
            let part: Progress = serde_json::from_str(&file.text).map_err(|e| {
                let d = Diagnostic::new(Code::Syntax, "", format!("is not the progress of a search: {e}"));
                refused(d.hint("give a file of progress that this question has written").into())
            })?;
            whole = design.merge(whole, part).map_err(refused)?;
        }
        Ok(whole)
    }

    fn request(&self) -> Result<teeth::Request, Refusal> {
        let mut wrong = Diagnostics::default();
        let mut request =
            teeth::Request { top: self.top, all: self.all, recompute: self.recompute, ..teeth::Request::default() };
        if let Some(sort) = &self.sort {
            match sort.parse::<Objective>() {
                Ok(sort) => request.sort = Some(sort),
                Err(mut d) => {
                    d.place = "sort".into();
                    wrong.push(*d);
                }
            }
        }
        if let Some(shard) = &self.shard {
            match part(shard) {
                Ok(shard) => request.shard = Some(shard),
                Err(d) => wrong.push(*d),
            }
        }
        // Rows that are written are among those that are shown.
        if let Some(last) = self.write.iter().max() {
            let least = usize::try_from(*last).unwrap_or(usize::MAX);
            request.top = Some(self.top.unwrap_or(20).max(least.min(100_000)));
        }
        request.own = self.like.as_ref().map(|f| (f.name.clone(), f.text.clone()));
        if wrong.is_empty() { Ok(request) } else { Err(wrong.into()) }
    }

    fn found(
        &self,
        design: teeth::Design,
        file: &Attachment,
        progress: Progress,
        work: &dyn Work,
    ) -> Result<DesignFound, Refusal> {
        let request = self.request()?;
        if !self.teeth.is_empty() {
            let report = design.answer_for(&self.teeth)?;
            return Ok(DesignFound { report, design: Some(design), progress, stopped: false });
        }
        let report = design.answer_of(progress.clone(), &request, work).map_err(|w| Refusal::File(w, file.clone()))?;
        // Rows are worked out after the search, and may be what was stopped.
        Ok(DesignFound { report, design: Some(design), progress, stopped: work.cancelled() })
    }
}

impl Question for Design {
    const NAME: &'static str = "design";
    const OF: Of = Of::Nothing;
    const TABLES: &'static [&'static str] = &["trains", "waterfall", "relaxations"];
    const FORMS: &'static [Form] = &[
        Form { name: "train", endings: &["toml"], about: "the rows to write as train files" },
        Form { name: "design-file", endings: &[], about: "the design file that a kind of drive or a train stands for" },
    ];
    const EXTRAS: &'static [Extra] = &[
        #[cfg(feature = "pictures")]
        Extra {
            name: "plot",
            value: "FILE.svg",
            about: "Draw the rows as points over two objectives into this SVG file",
        },
        Extra { name: "progress", value: "FILE.json", about: "Keep what is finished in this file, to go on with it" },
    ];
    const IS_CUT: bool = true;
    type Answer = DesignFound;

    fn check(&self) -> Result<(), Diagnostics> {
        let kind_only =
            [("ratio", self.ratio.is_some()), ("module", !self.module.is_empty()), ("planets", self.planets.is_some())];
        let begun = [
            ("tolerance", self.tolerance.is_some()),
            ("ring", self.ring.is_some()),
            ("forward", self.forward.is_some()),
            ("backward", self.backward.is_some()),
        ];
        let mut wrong = Diagnostics::default();
        for (name, is_given) in kind_only {
            if is_given && self.kind.is_none() {
                let d = Diagnostic::new(Code::Conflict, name, format!("`{name}` belongs to `kind`"));
                wrong.push(d.hint("write it into the table [design] of the file"));
            }
        }
        for (name, is_given) in begun {
            if is_given && (self.file.is_some() || self.kind.is_none() && self.like.is_none()) {
                let d = Diagnostic::new(Code::Conflict, name, format!("`{name}` belongs to `kind` and `like`"));
                wrong.push(d.hint("write it into the table [design] of the file"));
            }
        }
        if self.kind.is_some() && self.ratio.is_none() {
            let d = Diagnostic::new(Code::MissingKey, "ratio", "`kind` needs a ratio");
            wrong.push(d.hint("give a number or a range: 100, or 95..105"));
        }
        if self.write.contains(&0) {
            let d = Diagnostic::new(Code::OutOfRange, "write", "rows are counted from 1");
            wrong.push(d);
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        names::apart(&[
            [("kind", self.kind.is_some()), ("file", self.file.is_some())],
            [("kind", self.kind.is_some()), ("like", self.like.is_some())],
            [("shard", self.shard.is_some()), ("all", self.all)],
            [("teeth", !self.teeth.is_empty()), ("write", !self.write.is_empty())],
            [("teeth", !self.teeth.is_empty()), ("shard", self.shard.is_some())],
            [("teeth", !self.teeth.is_empty()), ("all", self.all)],
            [("teeth", !self.teeth.is_empty()), ("resume", !self.resume.is_empty())],
        ])
    }

    fn ask(&self, _: &[Given], work: &dyn Work) -> Result<DesignFound, Refusal> {
        let request = self.request()?;
        let (design, file) = self.read()?;
        if !self.teeth.is_empty() {
            return self.found(design, &file, Progress::default(), work);
        }
        let before = self.resumed(&design)?;
        let progress = design.search(before, request.shard, work).map_err(|w| Refusal::File(w, file.clone()))?;
        self.found(design, &file, progress, work)
    }

    fn text(&self, answer: &DesignFound, _: &[Given]) -> String {
        text::text(&answer.report)
    }

    fn tables(&self, answer: &DesignFound) -> Vec<Table> {
        tables::tables(&answer.report)
    }

    fn notes(answer: &DesignFound) -> &[Diagnostic] {
        &answer.report.diagnostics
    }

    fn is_partial(answer: &DesignFound) -> bool {
        answer.stopped
    }

    fn natural_form(&self) -> &'static str {
        if self.write.is_empty() && self.teeth.is_empty() { "text" } else { "train" }
    }

    fn write(&self, answer: &DesignFound, form: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        let design = match &answer.design {
            Some(design) => design.clone(),
            None => self.read()?.0,
        };
        if form == "design-file" {
            return Ok(vec![File::text("design.toml", design.to_toml())]);
        }
        let numbers = if self.write.is_empty() { &[1][..] } else { &self.write };
        let row = |n: &u64| {
            let found = answer.report.rows.iter().find(|r| r.number == *n);
            found.map(|r| File::text(format!("design-{n}.toml"), design.train_file(r))).ok_or_else(|| {
                let d = Diagnostic::new(Code::UnknownSelection, "write", format!("there is no row {n}"));
                let many = answer.report.rows.len();
                let hint = if many == 0 {
                    "no train satisfies the wish".into()
                } else {
                    format!("there are rows 1 to {many}")
                };
                Refusal::from(d.hint(hint))
            })
        };
        numbers.iter().map(row).collect()
    }

    fn extra(&self, answer: &DesignFound, name: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        #[cfg(feature = "pictures")]
        if name == "plot" {
            return Ok(vec![File::text("design.svg", picture::picture(&answer.report)?)]);
        }
        let _ = name;
        let text = serde_json::to_string(&answer.progress).expect("plain data") + "\n";
        Ok(vec![File::text("progress.json", text)])
    }

    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)> {
        let trains = self.file.iter_mut().chain(&mut self.like).map(|f| (f, Holds::Train));
        trains.chain(self.resume.iter_mut().map(|f| (f, Holds::Progress))).collect()
    }

    fn told(&self, answer: &DesignFound) -> Vec<String> {
        match (&answer.report.rows[..], self.write.is_empty() && self.teeth.is_empty()) {
            ([_, ..], true) => vec!["note: `write` gives a row as a train file".to_owned()],
            _ => vec![],
        }
    }

    fn piece(&self, _: &[Given], k: usize, n: usize, work: &dyn Work) -> Result<Vec<u8>, Refusal> {
        if !self.teeth.is_empty() {
            return Ok(serde_json::to_vec(&Progress::default()).expect("plain data"));
        }
        let (design, file) = self.read()?;
        let shard = Some((k as u64 + 1, n as u64));
        let part = design.search(Progress::default(), shard, work).map_err(|w| Refusal::File(w, file))?;
        if work.cancelled() {
            return Err(Refusal::Cancelled);
        }
        Ok(serde_json::to_vec(&part).expect("plain data"))
    }

    fn gather(&self, _: &[Given], pieces: &[Vec<u8>]) -> Result<DesignFound, Refusal> {
        let (design, file) = self.read()?;
        let progress = parts(pieces, |a: Progress, b| design.merge(a, b))?.unwrap_or_default();
        self.found(design, &file, progress, &willis::work::Serial)
    }
}
