//! `report`: the engineering report.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::work::Work;
use willis_figure::report::document::{Document, TitleBlock};
use willis_figure::{ReportRequest, html};

use crate::{File, Form, Given, Question, Refusal, quoted};

/// Write the engineering report of a train: one file that explains itself, as web page or PDF.
///
/// What was examined and what not, all gears with ratio, speeds and torques, warnings; train with schematic, data sheets of the
/// wheels, results with verdict and certificate, power flow, forces on bearings, losses and what to change first, maps, regimes
/// and closed formulas, assumptions, laws with their sources, and how to do it again. No text is smaller than 7 pt. The same
/// input gives the same bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Report {
    /// Only this operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
    /// Project or customer, for the title block.
    #[cfg_attr(feature = "clap", arg(long, value_name = "WORDS"))]
    pub project: Option<String>,
    /// Who answers for the report, for the title block.
    #[cfg_attr(feature = "clap", arg(long, value_name = "WORDS"))]
    pub author: Option<String>,
    /// Date for the title block, in your own words; none is taken from a clock.
    #[cfg_attr(feature = "clap", arg(long, value_name = "WORDS"))]
    pub date: Option<String>,
    /// Revision of the report, for the title block.
    #[cfg_attr(feature = "clap", arg(long, value_name = "WORDS"))]
    pub revision: Option<String>,
    /// Add the train file as an appendix.
    #[cfg_attr(feature = "clap", arg(long))]
    pub appendix: bool,
}

impl Report {
    /// What the report says of the way in which it was made.
    fn request(&self, given: &Given) -> ReportRequest {
        let text = given.model.to_toml();
        let hash: String = Sha256::digest(text.as_bytes()).iter().map(|b| format!("{b:02x}")).collect();
        // Without its folder: the same file makes the same report anywhere.
        let name = given.name.rsplit(['/', '\\']).next().unwrap_or(&given.name);
        // What came without a file has a name to save it under.
        let name = if name.contains('.') { name } else { "train.toml" };
        let shown = quoted(name);
        let mut more: Vec<String> = given.changes.iter().map(|c| format!(" {c}")).collect();
        more.extend(self.operation.as_ref().map(|o| format!(" --operation={}", quoted(o))));
        let analyze = more.concat();
        let told = self.told().into_iter().filter(|(_, words)| !words.is_empty());
        more.extend(told.map(|(name, words)| format!(" --{name}={}", quoted(words))));
        more.extend(self.appendix.then(|| " --appendix".to_owned()));
        let more = more.concat();
        let commands =
            vec![format!("willis analyze {shown}{analyze}"), format!("willis report {shown}{more} -o report.html")];
        let version = format!("willis {}", env!("CARGO_PKG_VERSION"));
        let [project, author, date, revision] = self.told().map(|(_, words)| words.to_owned());
        ReportRequest {
            operation: self.operation.clone(),
            file: name.to_owned(),
            hash,
            version,
            commands,
            title_block: TitleBlock { project, author, date, revision },
            appendix: self.appendix,
        }
    }

    /// What the title block says, by option; empty where nothing was given.
    fn told(&self) -> [(&'static str, &str); 4] {
        [
            ("project", trimmed(&self.project)),
            ("author", trimmed(&self.author)),
            ("date", trimmed(&self.date)),
            ("revision", trimmed(&self.revision)),
        ]
    }
}

/// Longest words of a title block, in characters.
const LONGEST: usize = 200;

fn trimmed(given: &Option<String>) -> &str {
    given.as_deref().map_or("", str::trim)
}

impl Question for Report {
    const NAME: &'static str = "report";
    const FORMS: &'static [Form] = &[Form { name: "html", endings: &["html", "htm"], about: "one web page" }];
    type Answer = Document;

    fn check(&self) -> Result<(), Diagnostics> {
        for (name, words) in self.told() {
            let wrong = match words {
                w if w.chars().count() > LONGEST => format!("has more than {LONGEST} characters"),
                w if w.chars().any(char::is_control) => "is more than one line of text".to_owned(),
                _ => continue,
            };
            let d = Diagnostic::new(Code::OutOfRange, "", format!("the {name} of a report {wrong}"));
            return Err(d.hint("a title block holds a few words on one line").into());
        }
        Ok(())
    }

    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<Document, Refusal> {
        Ok(willis_figure::report(&of[0].model, &self.request(&of[0]), work)?)
    }

    fn text(&self, answer: &Document, _: &[Given]) -> String {
        let sections = answer.sections.iter().map(|s| format!("  {}\n", s.title));
        format!("{}: {}\n{}", answer.title, answer.subtitle, sections.collect::<String>())
    }

    fn natural_form(&self) -> &'static str {
        "html"
    }

    fn write(&self, answer: &Document, _: &str, _: &[Given]) -> Result<Vec<File>, Refusal> {
        Ok(vec![File::text("report.html", html(answer))])
    }
}
