//! `report`: the engineering report.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use willis::work::Work;
use willis_figure::report::document::Document;
use willis_figure::{ReportRequest, html};

use crate::{File, Form, Given, Question, Refusal, quoted};

/// Write the engineering report of a train: one file that explains itself, as web page or PDF.
///
/// Question, train with schematic and teeth, results with verdict and certificate, power flow, losses and what to change
/// first, maps, regimes and closed formulas, assumptions, warnings, laws with their sources, and how to do it again. The
/// same input gives the same bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Report {
    /// Only this operation.
    #[cfg_attr(feature = "clap", arg(long, value_name = "OPERATION"))]
    pub operation: Option<String>,
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
        more.extend(self.operation.as_ref().map(|o| format!(" --operation {}", quoted(o))));
        let more = more.concat();
        let commands =
            vec![format!("willis analyze {shown}{more}"), format!("willis report {shown}{more} -o report.html")];
        let version = format!("willis {}", env!("CARGO_PKG_VERSION"));
        ReportRequest { operation: self.operation.clone(), file: name.to_owned(), hash, version, commands }
    }
}

impl Question for Report {
    const NAME: &'static str = "report";
    const FORMS: &'static [Form] = &[Form { name: "html", endings: &["html", "htm"], about: "one web page" }];
    type Answer = Document;

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
