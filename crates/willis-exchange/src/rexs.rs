//! REXS, the exchange format of the FVA for gearboxes: versions 1.0 to 1.6, as XML (`.rexs`), JSON (`.rexsj`) and in a
//! zip archive (`.rexsz`).
//!
//! A REXS file lists components (shafts, gears, stages, bearings) and relations between them. Reading it means to find
//! what turns together, which pairs mesh, which of them make a planetary set, and what the load cases prescribe. Signs:
//! the profile shift of a ring is positive towards its tip there (DIN 3960) and outward here; speeds and torques are
//! about the axis `u` of their shaft, and a torque is one on the shaft from outside, as here.
//!
//! Source: REXS specification 1.6, FVA, <https://spec.rexs.info/1.6/en/>; the XML schema `rexs-schema.xsd` published with
//! it; meaning of attributes in the FVA-Workbench documentation (attribute 784, addendum modification coefficient).

mod bodies;
mod gears;
mod loads;
mod sets;
mod supports;
mod write;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics, printable};
use willis::model::Model;

use crate::account::Account;
use crate::document::{Document, MOST_MIB, Value};
use crate::text::{comment, quantity, quoted};
use crate::{json, xml, zip};

pub use crate::account::{AttributeReport, Fate, Guess, Problem};
pub use loads::{Column, LoadCaseReport};
pub use supports::BearingReport;
pub use write::{Written, write, written};

/// The newest version that is read, and the one that is written.
pub const VERSION: &str = "1.6";
const VERSIONS: &[&str] = &["1.0", "1.1", "1.2", "1.3", "1.4", "1.5", "1.6"];
/// Stages beyond this are no gearbox.
const MOST_STAGES: usize = 2000;
/// Load cases at most.
const MOST_CASES: usize = 1000;
/// Load cases times what is looked at for each.
const MOST_LOOKS: usize = 20_000_000;

/// Sums of what a file has and what became of it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Counts {
    /// Components of the model.
    pub components: usize,
    /// Attributes, those of load cases too.
    pub attributes: usize,
    /// Attributes that are in the train file, or from which something in it follows.
    pub used: usize,
    /// Attributes that the train file has no place for.
    pub left_out: usize,
    /// Attributes that would have been used, with values that cannot be.
    pub unusable: usize,
    /// Supports without dimensions, which have no friction.
    pub ideal_supports: usize,
}

/// What Willis could use and the file does not have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Missing {
    /// What.
    pub what: String,
    /// What follows from that.
    pub so: String,
}

/// What was read and what was not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Report {
    /// The format: `REXS` or `gearsets`.
    #[serde(default)]
    pub kind: String,
    /// The version that the file says it has.
    pub version: String,
    /// The program that wrote it.
    pub application: String,
    /// Sums.
    pub counts: Counts,
    /// What is not in the file and had to be assumed.
    pub guessed: Vec<Guess>,
    /// What Willis could use and the file does not have.
    pub missing: Vec<Missing>,
    /// What is wrong or odd about the file, and what was done.
    pub problems: Vec<Problem>,
    /// Problems beyond those that are listed.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub more_problems: usize,
    /// Bearings with dimensions or a designation.
    pub bearings: Vec<BearingReport>,
    /// Load cases and the operations that they became.
    pub load_cases: Vec<LoadCaseReport>,
    /// Every attribute and what became of it.
    pub attributes: Vec<AttributeReport>,
}

fn is_zero(x: &usize) -> bool {
    *x == 0
}

/// A train that was read.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The text of a train file, with comments.
    pub toml: String,
    /// The train.
    pub model: Model,
    /// What became of the file.
    pub report: Report,
}

/// Whose sign the profile shifts of rings have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Convention {
    /// Positive towards the tip, inward on a ring: DIN 3960, REXS, KISSsoft.
    #[default]
    Din,
    /// Positive outward, also on a ring: programs that write it so into their files.
    Outward,
}

/// Reads a file of any of the three forms.
///
/// # Errors
/// Why it is no REXS file, is too large, or holds no train.
///
/// # Example
/// ```
/// let wrong = willis_exchange::rexs::read("x.rexs", b"<gearbox/>").unwrap_err();
/// assert!(wrong.to_string().contains("its outermost element is `gearbox`"));
/// ```
pub fn read(name: &str, bytes: &[u8]) -> Result<Imported, Diagnostics> {
    read_as(name, bytes, Convention::Din)
}

/// The same for a file whose writer has its own sign for the profile shifts of rings.
///
/// # Errors
/// The same.
pub fn read_as(name: &str, bytes: &[u8], convention: Convention) -> Result<Imported, Diagnostics> {
    let refused = |why: String| -> Diagnostics {
        let d = Diagnostic::new(Code::Unreadable, "", format!("this is no REXS file: {why}"));
        d.hint("give a file .rexs (XML), .rexsj (JSON) or .rexsz (zip) of REXS 1.0 to 1.6").into()
    };
    let document = open(bytes).map_err(refused)?;
    train(name, &document, convention)
}

/// The document of a file.
fn open(bytes: &[u8]) -> Result<Document, String> {
    let most = MOST_MIB << 20;
    if bytes.len() > most {
        return Err(format!("it is larger than {MOST_MIB} MiB"));
    }
    if zip::is_zip(bytes) {
        let (name, inner) = zip::unpack(bytes, &[".rexs", ".rexsj", ".xml", ".json"], most)?;
        if zip::is_zip(&inner) {
            return Err(format!("`{}` in the zip archive is an archive itself", printable(&name)));
        }
        return open(&inner);
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|e| format!("it is not text in UTF-8 (byte {})", e.valid_up_to()))?;
    match text.trim_start().chars().next() {
        Some('<') => xml::read(text),
        Some('{' | '[') => json::read(text),
        Some(_) => Err("it begins neither as XML nor as JSON nor as a zip archive".into()),
        None => Err("it is empty".into()),
    }
}

/// Texts that programs write, whatever component has them; `false` stands for each of them in files of a faulty writer.
fn is_text_or_vector(id: &str) -> bool {
    const PARTS: &[&str] = &[
        "determination_of",
        "designation",
        "type_of",
        "_type",
        "tolerance_series",
        "shape_of",
        "_orientation",
        "_force_absorption",
        "_evaluation_reference",
    ];
    // What is called so and is a truth value.
    let is_flag = id.starts_with("is_") || id == "radial_force_absorption";
    !is_flag && (id == "name" || id == "kind" || id.ends_with("_vector") || PARTS.iter().any(|p| id.contains(p)))
}

/// The train of a document.
fn train(name: &str, document: &Document, convention: Convention) -> Result<Imported, Diagnostics> {
    let mut account = Account::new(document);
    if !VERSIONS.contains(&document.version.as_str()) {
        let version = printable(&document.version).into_owned();
        let told = if version.is_empty() { "none".to_owned() } else { format!("`{version}`") };
        account.problem("the model", format!("its version is {told}; read as one of 1.0 to {VERSION}"));
    }
    let scopes = document.cases.iter().flat_map(|c| &c.components).chain(&document.components);
    let false_texts =
        scopes.flat_map(|c| &c.attributes).filter(|a| a.value == Value::Flag(false) && is_text_or_vector(&a.id));
    let false_texts = false_texts.count();
    if false_texts > 0 {
        let message = format!("{false_texts} texts and vectors are stored as boolean false and cannot be used");
        account.problem("the model", message);
    }
    let refusals = gears::refusals(&account);
    if !refusals.is_empty() {
        let of = |(place, why): &(String, &'static str)| {
            let d = Diagnostic::new(Code::Unfit, place.clone(), format!("{place}: {why}"));
            d.hint("trains have cylindrical stages and planetary stages; remove the other stages and import the rest")
        };
        return Err(refusals.iter().take(50).map(of).collect());
    }
    let mut bodies = bodies::Bodies::new(&mut account);
    let frame = gears::Frame::new(&mut account);
    let stages = document.relations.iter().filter(|r| r.kind == "stage").count();
    let too_large = |what: String, hint: &str| -> Result<Imported, Diagnostics> {
        Err(Diagnostic::new(Code::TooLarge, "", format!("the file has {what}")).hint(hint).into())
    };
    if stages > MOST_STAGES {
        let what = format!("{stages} stages; a gearbox has at most {MOST_STAGES}");
        return too_large(what, "export one gearbox, not a plant");
    }
    let (switched, most) = (bodies.switched, bodies::MOST_COUPLINGS);
    if switched > most {
        let what = format!("{switched} couplings that are closed in some gears only; a gearbox has at most {most}");
        return too_large(what, "export them as closed in all gears (`is_engaged`) where they are");
    }
    let cases = document.cases.len();
    if cases > MOST_CASES {
        let what = format!("{cases} load cases; at most {MOST_CASES} are read");
        return too_large(what, "join load cases that are nearly alike, and export the spectrum again");
    }
    let weight = loads::weight(document);
    if cases.saturating_mul(weight) > MOST_LOOKS {
        let what = format!(
            "{cases} load cases, for each of which {weight} shafts, loads and attributes of them would be looked at"
        );
        return too_large(what, "export fewer load cases, or the shafts of one gearbox only");
    }
    let gearing = gears::Gearing::new(&mut account, &bodies, &frame, convention == Convention::Outward);
    let mut written = sets::write(&mut account, &mut bodies, &gearing);
    if written.meshes == 0 {
        let mut wrong: Diagnostics = Diagnostics::default();
        let d = Diagnostic::new(Code::Unfit, "", "the file holds no stage of two cylindrical gears that can be read");
        wrong.push(d.hint("a stage needs a relation `stage` with `gear_1` and `gear_2`, and gears with tooth counts"));
        for problem in account.problems.iter().take(49) {
            let message = format!("{}: {}", problem.place, problem.message);
            wrong.push(Diagnostic::new(Code::Unfit, problem.place.clone(), message));
        }
        return Err(wrong);
    }
    let shifting = loads::shifting(&mut account, &mut bodies, &mut written);
    let (bearings, bearing_reports, ideal) = supports::bearings(&mut account, &mut bodies, &written, &frame);
    let oil = supports::oil(&mut account, &bodies);
    let loads = loads::Loads::new(&mut account, &mut bodies, &written);
    let title = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = title.rsplit_once('.').map_or(title, |(stem, _)| stem);
    let names = |all: &[String]| all.iter().map(|n| quoted(n)).collect::<Vec<_>>().join(", ");
    let writer = if document.application.is_empty() { "an unnamed program" } else { &document.application };
    let source = format!("REXS {} file {title}, written by {writer}, {}", document.version, document.date);
    let mut head = format!(
        "format = 1\nname = {}\nsource = {}\n\nmembers = [{}]\nterminals = [{}]\n",
        quoted(&printable(stem)),
        quoted(printable(&source).trim_end_matches([',', ' '])),
        names(&written.members),
        names(&loads.terminals)
    );
    if let Some(oil) = &oil {
        head.push_str(&format!("\n[oil]\n{}\n", oil.join("\n")));
        match loads::temperature(&mut account) {
            Some(t) => head.push_str(&format!("temperature = {}\n", quantity(t, "degC"))),
            None => account.guess("temperature of the oil", "60 degC", "the file does not give it"),
        }
    }
    let body = format!("{}{shifting}{bearings}", written.toml);
    let (bare, body) = settled(&mut account, &head, body, &bearings)?;
    let (operations, load_cases) = loads.operations(&mut account, &frame, bare.train());
    let missing = missing(oil.is_some(), ideal, &gearing, &bearing_reports, load_cases.is_empty());
    let attributes = account.attributes();
    let many = |fate: Fate| attributes.iter().filter(|a| a.fate == fate).count();
    let counts = Counts {
        components: document.components.len(),
        attributes: attributes.len(),
        used: many(Fate::Used),
        left_out: many(Fate::LeftOut),
        unusable: many(Fate::Unusable),
        ideal_supports: ideal,
    };
    let mut report = Report {
        kind: "REXS".into(),
        version: printable(&document.version).into_owned(),
        application: printable(&document.application).into_owned(),
        counts,
        guessed: account.guesses,
        missing,
        problems: account.problems,
        more_problems: account.more_problems,
        bearings: bearing_reports,
        load_cases,
        attributes,
    };
    let toml = format!("{}{head}{body}{operations}", comments(&report, title));
    let wrong = match Model::from_toml(&toml) {
        Ok(model) => return Ok(Imported { toml, model, report }),
        Err(wrong) => wrong,
    };
    // The train is sound; what the load cases prescribe is not.
    for d in wrong.iter().take(20) {
        let message = format!("the load cases are left out: {}", d.message);
        report.problems.push(Problem { place: "the train".into(), message });
    }
    report.load_cases.iter_mut().for_each(|case| case.operation = None);
    let toml = format!("{}{head}{body}", comments(&report, title));
    let model = Model::from_toml(&toml)?;
    Ok(Imported { toml, model, report })
}

/// The train without operations: as it is, or without what the file says of it and cannot be.
fn settled(
    account: &mut Account<'_>,
    head: &str,
    body: String,
    bearings: &str,
) -> Result<(Model, String), Diagnostics> {
    let wrong = match Model::from_toml(&format!("{head}{body}")) {
        Ok(model) => return Ok((model, body)),
        Err(wrong) => wrong,
    };
    // First without bearings, then without the forms of teeth.
    let without_bearings = body.replace(bearings, "");
    let is_geometry = |line: &str| line.split_once(" = ").is_some_and(|(key, _)| key == "geometry");
    let plain: String = body.lines().filter(|line| !is_geometry(line)).map(|line| format!("{line}\n")).collect();
    for (what, text) in [("the bearings", without_bearings), ("the geometry of the teeth", plain)] {
        if let Ok(model) = Model::from_toml(&format!("{head}{text}")) {
            for d in wrong.iter().take(20) {
                account.problem("the train", format!("{what} are left out: {}", d.message));
            }
            return Ok((model, text));
        }
    }
    Err(wrong)
}

/// What a user may want to add.
fn missing(
    has_oil: bool,
    ideal: usize,
    gearing: &gears::Gearing,
    bearings: &[BearingReport],
    no_operation: bool,
) -> Vec<Missing> {
    let mut all = vec![];
    let mut add = |what: String, so: &str| all.push(Missing { what, so: so.into() });
    if !has_oil {
        add("an oil".into(), "no losses are computed; add [oil]");
    }
    let rough = gearing.gears.values().filter(|g| g.roughness.is_none()).count();
    if rough > 0 {
        let many = gearing.gears.len();
        add(format!("roughness of {rough} of {many} gears"), "the default of Willis is taken for tooth friction");
    }
    if ideal > 0 {
        add(format!("dimensions of {ideal} ideal supports"), "they have no friction; add [[bearing]]");
    }
    let lacking = bearings.iter().filter(|b| !b.carried).count();
    if lacking > 0 {
        add(format!("dimensions of {lacking} bearings"), "they stand in comments and have no friction");
    }
    if bearings.is_empty() && ideal == 0 {
        add("bearings".into(), "none has friction; add [[bearing]]");
    }
    if has_oil {
        add("how the oil gets to gears and bearings".into(), "no gear churns; add `supply` to [oil]");
    }
    add("seals, and bodies that turn in air or oil".into(), "they lose nothing; add [[seal]] and [[rotor]]");
    if no_operation {
        add("a load case".into(), "ratios only; add [[operation]]");
    }
    all
}

/// The head of the train file.
fn comments(report: &Report, title: &str) -> String {
    let c = &report.counts;
    let mut out = comment(&format!("Made from {title}, REXS {}.", report.version));
    out += &comment(&format!(
        "{} of its {} attributes are used, {} left out, {} cannot be used; {} things are assumed.",
        c.used,
        c.attributes,
        c.left_out,
        c.unusable,
        report.guessed.len()
    ));
    /// Lines of each kind; the report has all.
    const MOST: usize = 40;
    let mut list = |what: &str, lines: Vec<String>| {
        if !lines.is_empty() {
            out += &format!("#\n# {what}:\n");
            lines.iter().take(MOST).for_each(|line| out += &comment(&format!("- {line}")));
            if lines.len() > MOST {
                out += &comment(&format!("- and {} more", lines.len() - MOST));
            }
        }
    };
    list("Assumed", report.guessed.iter().map(|g| format!("{}: {} ({})", g.of, g.taken, g.because)).collect());
    list("Not in the file", report.missing.iter().map(|m| format!("{}: {}", m.what, m.so)).collect());
    list("Odd about the file", report.problems.iter().map(|p| format!("{}: {}", p.place, p.message)).collect());
    out + "\n"
}
