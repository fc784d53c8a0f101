//! What a question is, and what stands in the list of them.

use std::any::Any;
use std::borrow::Borrow;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

use schemars::JsonSchema;
#[cfg(feature = "schemas")]
use schemars::{Schema, SchemaGenerator};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use willis::contract::Contract;
use willis::diagnostic::{Code, Diagnostic, Diagnostics, Severity};
use willis::model::Model;
use willis::work::Work;

use crate::Refusal;
use crate::table::Table;

/// A train with the name under which its user knows it.
#[derive(Clone, Debug)]
pub struct Given {
    /// The name of its file, or whatever tells it from others; it stands in answers.
    pub name: String,
    /// The train.
    pub model: Model,
    /// What was changed in it on the way here, as the user wrote it: `--law mesh_friction=niemann`.
    pub changes: Vec<String>,
}

impl Given {
    /// A train under a name.
    pub fn new(name: impl Into<String>, model: Model) -> Self {
        Self { name: name.into(), model, changes: vec![] }
    }

    /// Reads the text of a train file that names no tables.
    ///
    /// # Errors
    /// Everything that is wrong with the text.
    pub fn read(name: &str, text: &str) -> Result<Self, Refusal> {
        match Model::from_toml(text) {
            Ok(model) => Ok(Self::new(name, model)),
            Err(wrong) => Err(Refusal::File(wrong, Attachment { name: name.into(), text: text.into() })),
        }
    }
}

/// How many trains a question is asked of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Of {
    /// None: it is about Willis itself.
    Nothing,
    /// None or one.
    #[serde(rename = "at-most-one")]
    AtMostOne,
    /// One.
    Train,
    /// Two or more.
    Trains,
}

/// A form in which an answer can be had, beside text, JSON and tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    /// What it is called: `svg`.
    pub name: &'static str,
    /// Endings of file names that mean it.
    pub endings: &'static [&'static str],
    /// One line about it.
    pub about: &'static str,
}

/// A file of an answer: what it is called where nobody says otherwise, and what is in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name, without a folder.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
    /// One line about it; empty where there is nothing to say.
    pub about: String,
}

impl File {
    /// A file of text.
    pub fn text(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), bytes: text.into().into_bytes(), about: String::new() }
    }
}

/// Something beside the answer that can be written too, under an option of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extra {
    /// The option's name: `plot`.
    pub name: &'static str,
    /// What the option takes: `FILE.svg`, a name that ends so; or `FOLDER`.
    pub value: &'static str,
    /// One line about it.
    pub about: &'static str,
}

/// A file that a request names: a front end puts in the text.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Its name, for messages.
    pub name: String,
    /// What is in it.
    #[serde(default)]
    pub text: String,
}

/// What a file that a request names holds: how large it may be, and what its name ends with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Holds {
    /// A table (CSV).
    Table,
    /// A train file, or a design file (TOML).
    Train,
    /// What Willis itself wrote, to go on with (JSON).
    Progress,
    /// A file of another program, text or not ([`Attachment::holding`]).
    Exchange,
}

/// What the text of a file begins with that is no text in UTF-8.
const BASE64: &str = "data:;base64,";

impl Attachment {
    /// A file of any bytes. Its text is what it holds; of a file that is no text in UTF-8, a data URI in base64.
    ///
    /// ```
    /// use willis_ask::Attachment;
    ///
    /// let zip = Attachment::holding("x.zip", b"PK\x03\x04\xff");
    /// assert_eq!(zip.text, "data:;base64,UEsDBP8=");
    /// assert_eq!(*zip.bytes().unwrap(), b"PK\x03\x04\xff"[..]);
    /// assert_eq!(Attachment::holding("x.txt", b"text").text, "text");
    /// ```
    pub fn holding(name: impl Into<String>, bytes: &[u8]) -> Self {
        const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        if let Ok(text) = std::str::from_utf8(bytes) {
            return Self { name: name.into(), text: text.to_owned() };
        }
        let mut text = String::with_capacity(BASE64.len() + bytes.len().div_ceil(3) * 4);
        text.push_str(BASE64);
        for three in bytes.chunks(3) {
            let byte = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
            let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
            for k in 0..4 {
                let digit = DIGITS[(bits >> (18 - 6 * k) & 63) as usize] as char;
                text.push(if k <= three.len() { digit } else { '=' });
            }
        }
        Self { name: name.into(), text }
    }

    /// The bytes of [`Attachment::holding`].
    ///
    /// # Errors
    /// It begins as a data URI in base64 and is none.
    pub fn bytes(&self) -> Result<std::borrow::Cow<'_, [u8]>, String> {
        let Some(coded) = self.text.strip_prefix(BASE64) else { return Ok(self.text.as_bytes().into()) };
        let mut bytes = Vec::with_capacity(coded.len() / 4 * 3);
        let (mut bits, mut many) = (0u32, 0);
        for c in coded.trim_end_matches('=').bytes() {
            let digit = match c {
                b'A'..=b'Z' => c - b'A',
                b'a'..=b'z' => c - b'a' + 26,
                b'0'..=b'9' => c - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return Err("its text is no base64".into()),
            };
            bits = bits << 6 | u32::from(digit);
            many += 6;
            if many >= 8 {
                many -= 8;
                bytes.push((bits >> many) as u8);
            }
        }
        Ok(bytes.into())
    }
}

impl From<&str> for Attachment {
    fn from(name: &str) -> Self {
        Self { name: name.to_owned(), text: String::new() }
    }
}

impl std::str::FromStr for Attachment {
    type Err = std::convert::Infallible;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Ok(name.into())
    }
}

/// What a request must be to give options of a command line: `clap::Args` with the feature `clap`, nothing without it.
#[cfg(feature = "clap")]
pub trait Options: clap::Args {}
#[cfg(feature = "clap")]
impl<T: clap::Args> Options for T {}
/// What a request must be to give options of a command line: `clap::Args` with the feature `clap`, nothing without it.
#[cfg(not(feature = "clap"))]
pub trait Options {}
#[cfg(not(feature = "clap"))]
impl<T> Options for T {}

/// A question: the type is the request, its documentation the help.
///
/// Implement it in a file of its own in `questions/` and add a line to the list there; command line, completions,
/// schemas and the reference pages of the book follow.
pub trait Question:
    Options + Clone + fmt::Debug + Serialize + DeserializeOwned + JsonSchema + Send + Sync + Sized + 'static
{
    /// What it is called: `analyze`.
    const NAME: &'static str;
    /// How many trains it is asked of.
    const OF: Of = Of::Train;
    /// The tables that its answer has, by name; none where it has none. With some of them an answer can be had as CSV,
    /// JSON lines or Parquet.
    const TABLES: &'static [&'static str] = &[];
    /// Forms beside text, JSON and tables.
    const FORMS: &'static [Form] = &[];
    /// Whether warnings and notes are read before the answer, which counts them.
    const NOTES_FIRST: bool = false;
    /// What can be written beside the answer.
    const EXTRAS: &'static [Extra] = &[];
    /// The answer; its JSON is a contract.
    type Answer: Contract + Serialize + DeserializeOwned + JsonSchema + Send + Sync + 'static;

    /// Looks at the request alone, before it is asked: fields that exclude each other.
    ///
    /// # Errors
    /// All that is wrong with it.
    fn check(&self) -> Result<(), Diagnostics> {
        Ok(())
    }

    /// Answers it.
    ///
    /// # Errors
    /// Everything that is wrong with the trains or the request, or that the work was cancelled.
    fn ask(&self, of: &[Given], work: &dyn Work) -> Result<Self::Answer, Refusal>;

    /// The answer for eyes, with ANSI styles; every line ends with a line feed.
    fn text(&self, answer: &Self::Answer, of: &[Given]) -> String;

    /// The tables of the answer: those in [`Question::TABLES`] that have something to say.
    fn tables(&self, answer: &Self::Answer) -> Vec<Table> {
        let _ = answer;
        vec![]
    }

    /// Warnings and notes that belong to the answer; their places are in the first train.
    fn notes(answer: &Self::Answer) -> &[Diagnostic] {
        let _ = answer;
        &[]
    }

    /// Whether the work was stopped before its end, and the answer covers what was done until then.
    fn is_partial(answer: &Self::Answer) -> bool {
        let _ = answer;
        false
    }

    /// The answer in one of [`Question::FORMS`].
    ///
    /// # Errors
    /// Why it cannot be had in that form.
    fn write(&self, answer: &Self::Answer, form: &str, of: &[Given]) -> Result<Vec<File>, Refusal> {
        let _ = (answer, of);
        unreachable!("`{}` has no form `{form}`", Self::NAME)
    }

    /// One of [`Question::EXTRAS`].
    ///
    /// # Errors
    /// Why it cannot be had.
    fn extra(&self, answer: &Self::Answer, name: &str, of: &[Given]) -> Result<Vec<File>, Refusal> {
        let _ = (answer, of);
        unreachable!("`{}` has no `{name}` beside its answer", Self::NAME)
    }

    /// The form in which the answer comes where nobody asks for another; else text.
    fn natural_form(&self) -> &'static str {
        "text"
    }

    /// Files that the request names and whose text is still to be read, with what they hold.
    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)> {
        vec![]
    }

    /// What other questions a user may want, or what is odd about the request, to be told beside the answer.
    fn told(&self, answer: &Self::Answer) -> Vec<String> {
        let _ = answer;
        vec![]
    }

    /// Whether the work can be cut into pieces that other machines do, with [`Question::piece`] and [`Question::gather`].
    const IS_CUT: bool = false;

    /// What piece `k` of `n`, counted from 0, finds, as bytes for [`Question::gather`].
    ///
    /// # Errors
    /// The same as those of [`Question::ask`].
    fn piece(&self, of: &[Given], k: usize, n: usize, work: &dyn Work) -> Result<Vec<u8>, Refusal> {
        let _ = (of, k, n, work);
        unreachable!("`{}` is not cut", Self::NAME)
    }

    /// The answer from all pieces in their order, the same that one machine gives, bit for bit.
    ///
    /// # Errors
    /// The same as those of [`Question::ask`]; or they are not the pieces of this request.
    fn gather(&self, of: &[Given], pieces: &[Vec<u8>]) -> Result<Self::Answer, Refusal> {
        let _ = (of, pieces);
        unreachable!("`{}` is not cut", Self::NAME)
    }
}

/// A request of any question.
pub trait Request: fmt::Debug + Any + Send + Sync {
    /// What it asks.
    fn question(&self) -> &'static Entry;

    /// The request itself.
    fn as_any(&self) -> &dyn Any;

    /// As JSON.
    fn to_json(&self) -> Value;

    /// See [`Question::attachments`].
    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)>;

    /// See [`Question::natural_form`].
    fn natural_form(&self) -> &'static str;

    /// Answers it.
    ///
    /// # Errors
    /// What [`Question::ask`] says; or the number of trains is not what the question takes.
    fn ask<'a>(&'a self, of: &'a [Given], work: &dyn Work) -> Result<Box<dyn Answer + 'a>, Refusal>;

    /// The same for an answer that is kept: it goes on when request and trains are gone, on any thread.
    ///
    /// # Errors
    /// The same.
    fn ask_for_good(&self, of: Arc<[Given]>, work: &dyn Work) -> Result<Box<dyn Answer + Send + Sync>, Refusal>;

    /// See [`Question::piece`].
    ///
    /// # Errors
    /// What it says; or the question is not one that is cut, or there is no such piece.
    fn piece(&self, of: &[Given], k: usize, n: usize, work: &dyn Work) -> Result<Vec<u8>, Refusal>;

    /// See [`Question::gather`].
    ///
    /// # Errors
    /// What it says; or the question is not one that is cut.
    fn gather(&self, of: Arc<[Given]>, pieces: &[Vec<u8>]) -> Result<Box<dyn Answer + Send + Sync>, Refusal>;
}

/// An answer to any question.
pub trait Answer {
    /// See [`Question::text`].
    fn text(&self) -> String;

    /// Its contract as JSON, indented.
    fn json(&self) -> String;

    /// See [`Question::tables`].
    fn tables(&self) -> Vec<Table>;

    /// Those of [`Question::notes`], and what else is [unsaid](Self::unsaid).
    fn notes(&self) -> Vec<Diagnostic>;

    /// Warnings about the trains themselves that are not among the notes: what is asked of a train that cannot be assembled is
    /// told so, whatever the question. Those of the second train and the others have no place.
    fn unsaid(&self) -> Vec<Diagnostic>;

    /// See [`Question::is_partial`].
    fn is_partial(&self) -> bool;

    /// See [`Question::write`].
    ///
    /// # Errors
    /// Why it cannot be had in that form.
    fn write(&self, form: &str) -> Result<Vec<File>, Refusal>;

    /// See [`Question::extra`].
    ///
    /// # Errors
    /// Why it cannot be had.
    fn extra(&self, name: &str) -> Result<Vec<File>, Refusal>;

    /// See [`Question::told`].
    fn told(&self) -> Vec<String>;
}

/// An answer with what it belongs to, borrowed or kept.
struct Answered<Q, T, A> {
    question: Q,
    answer: A,
    of: T,
}

impl<Q: Question, B: Borrow<Q>, T: AsRef<[Given]>> Answer for Answered<(B, PhantomData<Q>), T, Q::Answer> {
    fn text(&self) -> String {
        self.question.0.borrow().text(&self.answer, self.of.as_ref())
    }

    fn json(&self) -> String {
        crate::json(&self.answer)
    }

    fn tables(&self) -> Vec<Table> {
        self.question.0.borrow().tables(&self.answer)
    }

    fn notes(&self) -> Vec<Diagnostic> {
        [Q::notes(&self.answer), &self.unsaid()].concat()
    }

    fn unsaid(&self) -> Vec<Diagnostic> {
        let of = self.of.as_ref();
        let said = Q::notes(&self.answer);
        let is_new = |d: &&Diagnostic| {
            d.severity == Severity::Warning && !said.iter().any(|s| s.code == d.code && s.message == d.message)
        };
        let all = of.iter().enumerate().flat_map(|(k, given)| {
            let own = given.model.warnings().iter().filter(is_new).cloned();
            own.map(move |mut d| {
                if of.len() > 1 {
                    d.message = format!("{}: {}", given.name, d.message);
                }
                if k > 0 {
                    (d.place, d.span, d.replacement) = Default::default();
                }
                d
            })
        });
        // A train may be given twice.
        all.fold(vec![], |mut kept: Vec<Diagnostic>, d| {
            if !kept.iter().any(|k| k.code == d.code && k.message == d.message) {
                kept.push(d);
            }
            kept
        })
    }

    fn is_partial(&self) -> bool {
        Q::is_partial(&self.answer)
    }

    fn write(&self, form: &str) -> Result<Vec<File>, Refusal> {
        self.question.0.borrow().write(&self.answer, form, self.of.as_ref())
    }

    fn extra(&self, name: &str) -> Result<Vec<File>, Refusal> {
        self.question.0.borrow().extra(&self.answer, name, self.of.as_ref())
    }

    fn told(&self) -> Vec<String> {
        self.question.0.borrow().told(&self.answer)
    }
}

/// Whether a question fits the number of trains and is sound by itself.
fn checked<Q: Question>(question: &Q, of: &[Given]) -> Result<(), Refusal> {
    let (fits, wanted) = match Q::OF {
        Of::Nothing => (of.is_empty(), "no train"),
        Of::AtMostOne => (of.len() <= 1, "one train at most"),
        Of::Train => (of.len() == 1, "one train"),
        Of::Trains => (of.len() >= 2, "two trains or more"),
    };
    if !fits {
        let message = format!("`{}` is asked of {wanted}, here are {}", Q::NAME, of.len());
        return Err(Diagnostic::new(Code::UnknownSelection, "", message).into());
    }
    question.check()?;
    Ok(())
}

/// Answers a question that fits the number of trains.
fn answer<Q: Question>(question: &Q, of: &[Given], work: &dyn Work) -> Result<Q::Answer, Refusal> {
    checked(question, of)?;
    question.ask(of, work)
}

/// Whether there is such a piece of a question.
fn cut<Q: Question>(question: &Q, of: &[Given], k: usize, n: usize) -> Result<(), Refusal> {
    checked(question, of)?;
    let message = match (Q::IS_CUT, k < n) {
        (false, _) => format!("the work of `{}` is not cut into pieces", Q::NAME),
        (_, false) => format!("there is no piece {} of {n}", k + 1),
        _ => return Ok(()),
    };
    Err(Diagnostic::new(Code::UnknownSelection, "", message).into())
}

impl<Q: Question> Request for Q {
    fn question(&self) -> &'static Entry {
        crate::question(Q::NAME).expect("every question is in the list")
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn to_json(&self) -> Value {
        serde_json::to_value(self).expect("plain data")
    }

    fn attachments(&mut self) -> Vec<(&mut Attachment, Holds)> {
        Question::attachments(self)
    }

    fn natural_form(&self) -> &'static str {
        Question::natural_form(self)
    }

    fn ask<'a>(&'a self, of: &'a [Given], work: &dyn Work) -> Result<Box<dyn Answer + 'a>, Refusal> {
        let answer = answer(self, of, work)?;
        Ok(Box::new(Answered { question: (self, PhantomData::<Q>), answer, of }))
    }

    fn ask_for_good(&self, of: Arc<[Given]>, work: &dyn Work) -> Result<Box<dyn Answer + Send + Sync>, Refusal> {
        let answer = answer(self, &of, work)?;
        Ok(Box::new(Answered { question: (self.clone(), PhantomData::<Q>), answer, of }))
    }

    fn piece(&self, of: &[Given], k: usize, n: usize, work: &dyn Work) -> Result<Vec<u8>, Refusal> {
        cut(self, of, k, n)?;
        Question::piece(self, of, k, n, work)
    }

    fn gather(&self, of: Arc<[Given]>, pieces: &[Vec<u8>]) -> Result<Box<dyn Answer + Send + Sync>, Refusal> {
        cut(self, &of, 0, 1)?;
        let answer = Question::gather(self, &of, pieces)?;
        Ok(Box::new(Answered { question: (self.clone(), PhantomData::<Q>), answer, of }))
    }
}

/// A line of the list of questions.
#[derive(Clone, Copy)]
pub struct Entry {
    /// What the question is called: `analyze`.
    pub name: &'static str,
    /// How many trains it is asked of.
    pub of: Of,
    /// Name and version of its usual answer: `willis-analysis-1`. `draw all`, `regimes` of a family and `validate` without
    /// a case answer with `willis-figures-1`, `willis-family-1` and `willis-cases-1`.
    pub contract: &'static str,
    /// See [`Question::TABLES`].
    pub tables: &'static [&'static str],
    /// See [`Question::FORMS`].
    pub forms: &'static [Form],
    /// See [`Question::EXTRAS`].
    pub extras: &'static [Extra],
    /// See [`Question::NOTES_FIRST`].
    pub notes_first: bool,
    /// See [`Question::IS_CUT`].
    pub is_cut: bool,
    request: fn(Value) -> Result<Box<dyn Request>, serde_json::Error>,
    #[cfg(feature = "schemas")]
    request_schema: fn(&mut SchemaGenerator) -> Schema,
    #[cfg(feature = "schemas")]
    answer_schema: fn(&mut SchemaGenerator) -> Schema,
    #[cfg(feature = "schemas")]
    reread: fn(&str) -> Result<String, serde_json::Error>,
    #[cfg(feature = "clap")]
    options: fn(clap::Command) -> clap::Command,
    #[cfg(feature = "clap")]
    of_matches: fn(&clap::ArgMatches) -> Result<Box<dyn Request>, clap::Error>,
}

impl Entry {
    /// The line of a question.
    pub(crate) const fn of<Q: Question>() -> Self {
        Self {
            name: Q::NAME,
            of: Q::OF,
            contract: <Q::Answer as Contract>::FORMAT,
            tables: Q::TABLES,
            forms: Q::FORMS,
            extras: Q::EXTRAS,
            notes_first: Q::NOTES_FIRST,
            is_cut: Q::IS_CUT,
            request: |value| Ok(Box::new(serde_json::from_value::<Q>(value)?)),
            #[cfg(feature = "schemas")]
            request_schema: |generator| generator.root_schema_for::<Q>(),
            #[cfg(feature = "schemas")]
            answer_schema: |generator| generator.root_schema_for::<Q::Answer>(),
            #[cfg(feature = "schemas")]
            reread: |text| serde_json::to_string_pretty(&serde_json::from_str::<Q::Answer>(text)?),
            #[cfg(feature = "clap")]
            options: |command| Q::augment_args(command),
            #[cfg(feature = "clap")]
            of_matches: |matches| Ok(Box::new(Q::from_arg_matches(matches)?)),
        }
    }

    /// A request from JSON; what is left out has its default.
    ///
    /// # Errors
    /// A field that the request does not have, or a value of another kind.
    ///
    /// # Example
    /// ```
    /// let analyze = willis_ask::question("analyze").unwrap();
    /// let request = analyze.request(serde_json::json!({ "state": "3" }))?;
    /// assert_eq!(request.to_json()["state"], "3");
    /// assert!(analyze.request(serde_json::json!({ "gear": "3" })).is_err());
    /// # Ok::<(), willis_ask::Refusal>(())
    /// ```
    pub fn request(&self, value: Value) -> Result<Box<dyn Request>, Refusal> {
        (self.request)(value).map_err(|e| {
            let hint = format!("the JSON Schema of the request of `{}` describes it", self.name);
            Diagnostic::new(Code::WrongType, "", format!("the request of `{}`: {e}", self.name)).hint(hint).into()
        })
    }

    /// One paragraph about it: the documentation of its request.
    #[cfg(feature = "schemas")]
    pub fn about(&self) -> String {
        let schema = self.request_schema();
        schema.get("description").and_then(Value::as_str).unwrap_or_default().to_owned()
    }

    /// What a list of questions tells of it: name, what it is asked of, what it is about, contract, tables, forms.
    #[cfg(feature = "schemas")]
    pub fn told(&self) -> Value {
        let forms: Vec<&str> = self.forms.iter().map(|f| f.name).collect();
        serde_json::json!({
            "name": self.name,
            "of": self.of,
            "about": self.about(),
            "answer": self.contract,
            "tables": self.tables,
            "forms": forms,
        })
    }

    /// JSON Schema of its request.
    #[cfg(feature = "schemas")]
    pub fn request_schema(&self) -> Schema {
        (self.request_schema)(&mut generator())
    }

    /// JSON Schema of its answer.
    #[cfg(feature = "schemas")]
    pub fn answer_schema(&self) -> Schema {
        let mut schema = (self.answer_schema)(&mut generator());
        schema.insert("title".into(), self.contract.into());
        schema
    }

    /// Reads an answer's JSON and writes it again: the same text, for an answer of this version.
    ///
    /// # Errors
    /// Why it is no answer to this question.
    #[cfg(feature = "schemas")]
    pub fn reread(&self, json: &str) -> Result<String, serde_json::Error> {
        (self.reread)(json)
    }

    /// Adds the options of its request to a command.
    #[cfg(feature = "clap")]
    pub fn options(&self, command: clap::Command) -> clap::Command {
        (self.options)(command)
    }

    /// A request from options.
    ///
    /// # Errors
    /// What clap says.
    #[cfg(feature = "clap")]
    pub fn of_matches(&self, matches: &clap::ArgMatches) -> Result<Box<dyn Request>, clap::Error> {
        (self.of_matches)(matches)
    }
}

impl fmt::Debug for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Entry").field("name", &self.name).field("contract", &self.contract).finish_non_exhaustive()
    }
}

#[cfg(feature = "schemas")]
pub(crate) fn generator() -> SchemaGenerator {
    schemars::generate::SchemaSettings::draft2020_12().into_generator()
}
