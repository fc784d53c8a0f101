//! The train of a study.

use std::collections::BTreeMap;

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{Document, Reading, Train};

use super::target::Target;

/// A train file whose quantities can be set anew.
///
/// # Example
/// ```
/// use willis::study::{Subject, Target};
///
/// let text = r#"
///     format = 1
///     name = "one set"
///     members = ["s", "r", "c"]
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     ring = { member = "r", teeth = 70 }
///     carrier = "c"
/// "#;
/// let subject = Subject::new(text, &[], &mut |file| Err(format!("no file {file}"))).unwrap();
/// let target = Target::parse("P1.mesh_efficiency", &subject).unwrap();
/// let train = subject.with(&[(&target, "0.97".into())])?;
/// assert_eq!(train.meshes()[1].efficiency.backward.to_f64(), 0.97);
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Subject {
    document: Document,
    /// The tables that the file names.
    files: BTreeMap<String, Result<String, String>>,
    laws: Vec<(String, String)>,
    train: Train,
}

impl Subject {
    /// Reads a train file. `laws` are put into force over those of the file, family and name; `load` gives the text of
    /// a file that it names.
    ///
    /// # Errors
    /// What [`Train::read_toml_with`] says, or why a law cannot be used.
    pub fn new(
        text: &str,
        laws: &[(String, String)],
        load: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Result<Self, Box<Reading>> {
        let mut files = BTreeMap::new();
        let mut keep = |name: &str| {
            let text = load(name);
            files.insert(name.to_owned(), text.clone());
            text
        };
        let mut reading = Train::read_toml_with(text, &mut keep);
        let Some(mut train) = reading.train.take() else { return Err(Box::new(reading)) };
        for (family, law) in laws {
            match train.with_law(family, law) {
                Ok(with) => train = with,
                Err(wrong) => {
                    reading.diagnostics.extend(wrong);
                    return Err(Box::new(reading));
                }
            }
        }
        let document = Document::parse(text).expect("the text was read as TOML");
        Ok(Self { document, files, laws: laws.to_vec(), train })
    }

    /// The train as the file has it.
    pub fn train(&self) -> &Train {
        &self.train
    }

    /// The text of the file.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The tables that the file names, with their texts, as far as they could be read.
    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        self.files.iter().filter_map(|(name, text)| Some((name.as_str(), text.as_deref().ok()?)))
    }

    /// The laws in force over those of the file: family and name.
    pub fn laws(&self) -> &[(String, String)] {
        &self.laws
    }

    /// The train with other values.
    ///
    /// # Errors
    /// What is wrong with it then.
    pub fn with(&self, settings: &[(&Target, String)]) -> Result<Train, Diagnostics> {
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
