//! A gear train as data: what a person wrote, what was read from it, and other values for any of its quantities.
//!
//! A [`Model`] is what every question is asked of. It holds the checked [`Train`], the text it came from, the tables
//! that the text names, and the warnings of reading them.

mod target;

use std::collections::BTreeMap;

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{Document, Reading, Train};

pub use target::{Target, Who};
pub(crate) use target::{oil_temperature, quantity};

/// A gear train with the text that says it, any quantity of which can be set anew.
///
/// # Example
/// ```
/// use willis::model::{Model, Target};
///
/// let model = Model::from_toml(r#"
///     format = 1
///     name = "one set"
///     members = ["s", "r", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "r", teeth = 70 }
///     carrier = "c"
/// "#)?;
/// let target = Target::parse("P1.mesh_efficiency", &model).unwrap();
/// let train = model.train_with(&[(&target, "0.97".into())])?;
/// assert_eq!(train.meshes()[1].efficiency.backward.to_f64(), 0.97);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Model {
    text: String,
    document: Document,
    /// The tables that the text names, or why they cannot be read.
    files: BTreeMap<String, Result<String, String>>,
    /// Laws in force over those of the text: family and name.
    laws: Vec<(String, String)>,
    train: Train,
    /// Where everything stands in the text, and what was said when it was read.
    reading: Reading,
}

impl Model {
    /// Reads a train file that names no tables.
    ///
    /// # Errors
    /// Everything that is wrong with the text, each with its place.
    pub fn from_toml(text: &str) -> Result<Self, Diagnostics> {
        Self::read(text, &mut |file| Err(format!("`{file}`: files are not read here")))
    }

    /// Reads a train file; `load` gives the text of a table that it names, or says why it cannot.
    ///
    /// # Errors
    /// Everything that is wrong with the text, each with its place.
    pub fn read(text: &str, load: &mut dyn FnMut(&str) -> Result<String, String>) -> Result<Self, Diagnostics> {
        let mut files = BTreeMap::new();
        let mut keep = |name: &str| {
            let text = load(name);
            files.insert(name.to_owned(), text.clone());
            text
        };
        let mut reading = Train::read_toml_with(text, &mut keep);
        let Some(train) = reading.train.take() else { return Err(reading.diagnostics) };
        let document = Document::parse(text).expect("the text was read as TOML");
        Ok(Self { text: text.to_owned(), document, files, laws: vec![], train, reading })
    }

    /// Puts laws into force over those of the text: pairs of family and name.
    ///
    /// # Errors
    /// There is no such family or law, or the train lacks what the law needs.
    pub fn with_laws<F: AsRef<str>, L: AsRef<str>>(
        mut self,
        laws: impl IntoIterator<Item = (F, L)>,
    ) -> Result<Self, Diagnostics> {
        for (family, law) in laws {
            let (family, law) = (family.as_ref(), law.as_ref());
            self.train = self.train.clone().with_law(family, law).map_err(|mut wrong| {
                self.locate(&mut wrong);
                wrong
            })?;
            self.laws.push((family.to_owned(), law.to_owned()));
        }
        Ok(self)
    }

    /// The train, checked.
    pub fn train(&self) -> &Train {
        &self.train
    }

    /// The text.
    pub fn to_toml(&self) -> &str {
        &self.text
    }

    /// The text as a document whose quantities are found by path.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The tables that the text names, with their texts, as far as they could be read.
    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        self.files.iter().filter_map(|(name, text)| Some((name.as_str(), text.as_deref().ok()?)))
    }

    /// The laws in force over those of the text: pairs of family and name.
    pub fn laws(&self) -> &[(String, String)] {
        &self.laws
    }

    /// Warnings about the train itself, each with its place in the text.
    pub fn warnings(&self) -> &[Diagnostic] {
        self.train.warnings()
    }

    /// Gives diagnostics of an answer their places in the text, and puts them in the order of these.
    ///
    /// A diagnostic of the train names the key or the entry that it is about; those that have a place already keep it.
    pub fn locate(&self, diagnostics: &mut Diagnostics) {
        self.reading.locate(&self.text, diagnostics);
    }

    /// The train with other values.
    ///
    /// # Errors
    /// What is wrong with it then.
    pub fn train_with(&self, settings: &[(&Target, String)]) -> Result<Train, Diagnostics> {
        let of_file = |t: &Target| matches!(t, Target::File(_));
        let mut train = match settings.iter().any(|s| of_file(s.0)) {
            false => self.train.clone(),
            true => {
                let mut document = self.document.clone();
                for (target, value) in settings {
                    let Target::File(key) = target else { continue };
                    document.set(key, value).map_err(|what| {
                        Diagnostics::from_iter([Diagnostic::new(Code::BadAxis, "", format!("`{value}`: {what}"))])
                    })?;
                }
                let mut load = |name: &str| {
                    self.files.get(name).cloned().unwrap_or_else(|| Err(format!("`{name}` was not read before")))
                };
                let Reading { train, diagnostics, .. } = Train::read_toml_with(&document.text(), &mut load);
                // Their places are those of another text.
                let elsewhere =
                    |d: Diagnostics| d.into_iter().map(|d| Diagnostic { span: None, ..d }).collect::<Diagnostics>();
                let mut train = train.ok_or_else(|| elsewhere(diagnostics))?;
                for (family, law) in &self.laws {
                    train = train.with_law(family, law)?;
                }
                train
            }
        };
        for (target, value) in settings {
            if let Target::Law(family) = target {
                train = train.with_law(family, value)?;
            }
        }
        Ok(train)
    }
}
