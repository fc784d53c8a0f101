//! A gear train as data: what a person wrote, what was read from it, and other values for any of its quantities.
//!
//! A [`Model`] is what every question is asked of. It holds the checked [`Train`], the text it came from, the tables
//! that the text names, and the warnings of reading them.

mod target;

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{Document, Key, Reading, Specification, Train};

pub use target::{ShaftRef, Target};
pub(crate) use target::{oil_temperature, quantity, shaft};

/// A gear train as data, any quantity of which can be read and set anew.
///
/// It comes from the text of a train file ([`Model::from_toml`]) or from a [`Specification`] that code made
/// ([`Model::new`]); what can be done with it is the same. It always has a text: what a person wrote stays as it is,
/// with comments and order, but for what [`Model::set`] changes.
///
/// # Example
/// ```
/// use willis::Model;
/// use willis::train::{SetSpec, Specification};
///
/// let mut model = Model::new(
///     Specification::new("reducer")
///         .members(["s", "c"])
///         .terminals(["s", "c"])
///         .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99)),
/// )?;
/// assert_eq!(model.get("P1.sun.teeth")?.as_deref(), Some("30"));
/// model.set("P1.planet.count", "3")?;
/// assert_eq!(model.train().meshes()[0].count, 3);
/// let better = model.with([("P1.mesh_efficiency", "0.995")])?;
/// assert!(better.to_toml().contains("mesh_efficiency = 0.995"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Model {
    text: String,
    /// The text as a document, once somebody asks for a path.
    document: OnceLock<Document>,
    /// The tables that the text names, or why they cannot be read.
    files: BTreeMap<String, Result<String, String>>,
    /// Laws in force over those of the text: family and name.
    laws: Vec<(String, String)>,
    /// See [`Train::with_speed_tolerance`].
    speed_tolerance: f64,
    train: Train,
    specification: Specification,
    /// Where everything stands in the text, and what was said when it was read.
    reading: Reading,
    /// The train without its questions, and the keys from which nothing else of it follows, each with its place among its
    /// inputs.
    alone: OnceLock<(Train, Vec<(Key, usize)>)>,
}

impl Model {
    /// Checks a specification that names no tables.
    ///
    /// # Errors
    /// Everything that is wrong with it, by its place in the specification.
    pub fn new(specification: Specification) -> Result<Self, Diagnostics> {
        Self::new_with(specification, &mut |file| Err(format!("`{file}`: files are not read here")))
    }

    /// Checks a specification; `load` gives the text of a table that it names, or says why it cannot.
    ///
    /// # Errors
    /// Everything that is wrong with it, by its place in the specification.
    pub fn new_with(
        specification: Specification,
        load: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Result<Self, Diagnostics> {
        specification.build_with(load)?;
        Self::read(&specification.to_toml(), load).map_err(elsewhere)
    }

    /// Reads a train file that names no tables.
    ///
    /// # Errors
    /// Everything that is wrong with the text, each with its place.
    ///
    /// # Example
    /// ```
    /// use willis::Model;
    ///
    /// let text = "format = 1\nname = 'clutch'  # the one on the bench\nmembers = ['a', 'b']\nterminals = ['a', 'b']\n\
    ///     shift_element = [{ name = 'C', kind = 'clutch', members = ['a', 'b'], capacity = '80 N m' }]\n";
    /// let mut model = Model::from_toml(text)?;
    /// assert_eq!(model.to_toml(), text);
    /// model.set("C.capacity", "95 N m")?;
    /// assert!(model.to_toml().contains("# the one on the bench") && model.to_toml().contains("95 N m"));
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
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
        let (Some(train), Some(specification)) = (reading.train.take(), reading.specification.take()) else {
            return Err(reading.diagnostics);
        };
        Ok(Self {
            text: text.to_owned(),
            document: OnceLock::new(),
            files,
            laws: vec![],
            speed_tolerance: Train::SAME_SPEED,
            train,
            specification,
            reading,
            alone: OnceLock::new(),
        })
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

    /// Lets prescribed speeds contradict the gears by this part: see [`Train::with_speed_tolerance`].
    ///
    /// # Errors
    /// A number that is not from 0 to 0.1.
    pub fn with_speed_tolerance(mut self, tolerance: f64) -> Result<Self, Diagnostics> {
        self.train = self.train.with_speed_tolerance(tolerance)?;
        self.speed_tolerance = tolerance;
        Ok(self)
    }

    /// The train, checked.
    pub fn train(&self) -> &Train {
        &self.train
    }

    /// All that the text says, as data.
    pub fn specification(&self) -> &Specification {
        &self.specification
    }

    /// The value of a quantity by its path, as written; none where it is not given.
    ///
    /// Paths are those of [`Document`]: `P1.planet.count`, `oil.viscosity_40`, `C.capacity`; [`Document::quantities`] lists
    /// them all.
    ///
    /// # Errors
    /// There is no such quantity; with the nearest.
    pub fn get(&self, path: &str) -> Result<Option<String>, Diagnostics> {
        let key = self.document().find(&of_file(path)).map_err(one)?;
        Ok(self.document().value(&key))
    }

    /// Sets a quantity by its path: `"23"`, `"12 mm"`, `"mineral"`. All else stays as written.
    ///
    /// # Errors
    /// There is no such quantity, the text is no such value, or the train is wrong with it; nothing has changed then.
    pub fn set(&mut self, path: &str, value: &str) -> Result<(), Diagnostics> {
        *self = self.with([(path, value)])?;
        Ok(())
    }

    /// The same model with other values of some quantities.
    ///
    /// # Errors
    /// As of [`Model::set`]; the train is checked when all are set.
    pub fn with<P: AsRef<str>, V: AsRef<str>>(
        &self,
        settings: impl IntoIterator<Item = (P, V)>,
    ) -> Result<Self, Diagnostics> {
        let mut settings = settings.into_iter().peekable();
        if settings.peek().is_none() {
            return Ok(self.clone());
        }
        let mut document = self.document().clone();
        let mut laws = self.laws.clone();
        for (path, value) in settings {
            let path = of_file(path.as_ref());
            let key = document.find(&path).map_err(one)?;
            document.set(&key, value.as_ref()).map_err(|what| one(bad_value(&path, &what)))?;
            // What is set later holds.
            laws.retain(|(family, _)| path.strip_prefix("laws.") != Some(family));
        }
        let read = Self::read(&document.text(), &mut |name| self.table(name)).map_err(elsewhere)?;
        read.with_laws(laws)?.with_speed_tolerance(self.speed_tolerance)
    }

    /// The text of a table that was read before.
    fn table(&self, name: &str) -> Result<String, String> {
        self.files.get(name).cloned().unwrap_or_else(|| Err(format!("`{name}` was not read before")))
    }

    /// The text.
    pub fn to_toml(&self) -> &str {
        &self.text
    }

    /// The text as a document whose quantities are found by path.
    pub fn document(&self) -> &Document {
        self.document.get_or_init(|| Document::parse(&self.text).expect("the text was read as TOML"))
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

    /// The train of a document with other values and laws.
    ///
    /// # Errors
    /// What is wrong with it then.
    pub(crate) fn train_with(&self, document: &Document, settings: &[(&Target, String)]) -> Result<Train, Diagnostics> {
        let mut document = document.clone();
        for (target, value) in settings {
            let Target::File(key) = target else { continue };
            document.set(key, value).map_err(|what| one(bad_value(value, &what)))?;
        }
        let Reading { train, diagnostics, .. } = Train::read_toml_with(&document.text(), &mut |name| self.table(name));
        let mut train = train.ok_or_else(|| elsewhere(diagnostics))?;
        for (family, law) in &self.laws {
            train.set_law(family, law)?;
        }
        train = train.with_speed_tolerance(self.speed_tolerance)?;
        for (target, value) in settings {
            if let Target::Law(family) = target {
                train.set_law(family, value)?;
            }
        }
        Ok(train)
    }

    /// The train without its questions, with other values of its file and laws, and without a reading of the text; none where
    /// more of it follows from them.
    pub(crate) fn with_numbers(&self, settings: &[(&Target, String)]) -> Option<Train> {
        let mut train = self.alone().0.clone();
        self.set_numbers(&mut train, settings)?;
        Some(train)
    }

    /// The same in the place of a train of which nobody else knows, and that differs from this one in the values of the same
    /// settings alone.
    pub(crate) fn with_other_numbers(
        &self,
        mut spare: Arc<Train>,
        settings: &[(&Target, String)],
    ) -> Option<Arc<Train>> {
        let own = Arc::get_mut(&mut spare)?;
        own.laws = self.alone().0.laws;
        self.set_numbers(own, settings)?;
        Some(spare)
    }

    fn set_numbers(&self, train: &mut Train, settings: &[(&Target, String)]) -> Option<()> {
        for (target, value) in settings {
            match target {
                Target::File(key) => {
                    let (_, input) = self.alone().1.iter().find(|(own, _)| own == key)?;
                    train.set_input(*input, key.measure, value)?;
                }
                Target::Law(family) => train.set_law(family, value).ok()?,
                _ => {}
            }
        }
        Some(())
    }

    fn alone(&self) -> &(Train, Vec<(Key, usize)>) {
        self.alone.get_or_init(|| {
            let mut train = self.train.clone().without_questions();
            let inputs = train.inputs_alone().into_iter();
            let keys = inputs.filter_map(|k| Some((self.document().find(&train.inputs[k].path).ok()?, k))).collect();
            (train, keys)
        })
    }
}

/// Laws are called in the singular where a study varies them.
fn of_file(path: &str) -> String {
    path.strip_prefix("law.").map_or_else(|| path.to_owned(), |family| format!("laws.{family}"))
}

// As the finders of keys give it.
#[allow(clippy::boxed_local)]
fn one(d: Box<Diagnostic>) -> Diagnostics {
    Diagnostics::from_iter([*d])
}

fn bad_value(what: &str, why: &str) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(Code::BadAxis, "", format!("`{what}`: {why}")))
}

/// Diagnostics of another text than the one that a person sees: their places are not told.
fn elsewhere(all: Diagnostics) -> Diagnostics {
    all.into_iter().map(|d| Diagnostic { span: None, ..d }).collect()
}
