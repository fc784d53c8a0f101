//! A train: its text, and what was changed in it.

use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use willis::Diagnostics;
use willis::model::Model;
use willis::train::Train as Checked;
use willis_ask::{Attachment, Given, Refusal, quoted};

use crate::compiled::{CompileArguments, Compiled};
use crate::refused::{refused, wrong};

/// A train under its name.
#[pyclass(frozen, eq, hash, module = "willis._willis", name = "Train")]
pub struct Train {
    pub given: Given,
    tolerance: Option<f64>,
}

/// What a train is made of again: name, text, tables, laws, tolerance of speeds, changes.
type Parts = (String, String, BTreeMap<String, String>, Vec<(String, String)>, Option<f64>, Vec<String>);

impl Train {
    fn key(&self) -> Parts {
        let model = &self.given.model;
        let files = model.files().map(|(name, text)| (name.to_owned(), text.to_owned())).collect();
        (
            self.given.name.clone(),
            model.to_toml().to_owned(),
            files,
            model.laws().to_vec(),
            self.tolerance,
            self.given.changes.clone(),
        )
    }

    /// The same train as another model, with what was changed as the command line would say it.
    fn changed(
        &self,
        py: Python<'_>,
        model: Result<Model, Diagnostics>,
        option: &str,
        values: &[(String, String)],
    ) -> PyResult<Self> {
        let of = std::slice::from_ref(&self.given);
        let model = model.map_err(|wrong| refused(py, &Refusal::Wrong(wrong, 0), of))?;
        let said = |(name, value): &(String, String)| format!("--{option} {}", quoted(&format!("{name}={value}")));
        let changes = self.given.changes.iter().cloned().chain(values.iter().map(said)).collect();
        Ok(Self { given: Given { name: self.given.name.clone(), model, changes }, tolerance: self.tolerance })
    }

    fn train(&self) -> &Checked {
        self.given.model.train()
    }
}

impl PartialEq for Train {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Hash for Train {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.given.model.to_toml().hash(state);
    }
}

#[pymethods]
impl Train {
    #[staticmethod]
    #[pyo3(signature = (path, allow=vec![]))]
    fn read(py: Python<'_>, path: &str, allow: Vec<PathBuf>) -> PyResult<Self> {
        let allowed: Vec<&Path> = allow.iter().map(PathBuf::as_path).collect();
        let given = py.detach(|| willis_cli::input::read(path, &allowed));
        Ok(Self { given: given.map_err(|refusal| refused(py, &refusal, &[]))?, tolerance: None })
    }

    /// From text; tables that it names are looked up among these.
    #[staticmethod]
    #[pyo3(signature = (name, text, files=None, laws=vec![], tolerance=None, changes=vec![]))]
    fn of(
        py: Python<'_>,
        name: &str,
        text: &str,
        files: Option<BTreeMap<String, String>>,
        laws: Vec<(String, String)>,
        tolerance: Option<f64>,
        changes: Vec<String>,
    ) -> PyResult<Self> {
        let files = files.unwrap_or_default();
        let made = py.detach(|| {
            let load = &mut |file: &str| files.get(file).cloned().ok_or_else(|| format!("{file}: is not given"));
            let model = Model::read(text, load).and_then(|model| model.with_laws(laws));
            let model = model.and_then(|m| tolerance.map_or(Ok(m.clone()), |t| m.with_speed_tolerance(t)));
            let file = || Attachment { name: name.into(), text: text.into() };
            model.map_err(|wrong| Refusal::File(wrong, file()))
        });
        let model = made.map_err(|refusal| refused(py, &refusal, &[]))?;
        Ok(Self { given: Given { name: name.into(), model, changes }, tolerance })
    }

    fn parts(&self) -> Parts {
        self.key()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.given.name
    }

    #[getter]
    fn title(&self) -> &str {
        self.train().name()
    }

    #[getter]
    fn text(&self) -> &str {
        self.given.model.to_toml()
    }

    #[getter]
    fn members(&self) -> Vec<String> {
        self.train().members().iter().map(|m| m.name.clone()).collect()
    }

    #[getter]
    fn states(&self) -> Vec<String> {
        self.train().states().iter().map(|s| s.name.clone()).collect()
    }

    #[getter]
    fn operations(&self) -> Vec<String> {
        self.train().operations().iter().map(|o| o.name.clone()).collect()
    }

    #[getter]
    fn scenarios(&self) -> Vec<String> {
        self.train().scenarios().iter().map(|s| s.name.clone()).collect()
    }

    #[getter]
    fn terminals(&self) -> Vec<String> {
        self.train().terminals().iter().map(|m| self.train().member_name(*m).to_owned()).collect()
    }

    /// Warnings about the train itself, as JSON, each at its place.
    fn warnings(&self) -> String {
        let mut all = self.given.model.warnings().iter().cloned().collect();
        self.given.model.locate(&mut all);
        willis_ask::json(&all.iter().collect::<Vec<_>>())
    }

    /// Input and output of a state, or of the train.
    #[pyo3(signature = (state=None))]
    fn ends(&self, py: Python<'_>, state: Option<&str>) -> PyResult<[Option<String>; 2]> {
        let train = self.train();
        let state = state.map(|name| train.find_state(name)).transpose().map_err(|d| wrong(py, (*d).into()))?;
        Ok(train.ends(state).map(|m| m.map(|m| train.member_name(m).to_owned())))
    }

    fn get(&self, py: Python<'_>, path: &str) -> PyResult<Option<String>> {
        self.given.model.get(path).map_err(|w| wrong(py, w))
    }

    fn with_values(&self, py: Python<'_>, values: Vec<(String, String)>) -> PyResult<Self> {
        let model = py.detach(|| self.given.model.with(values.iter().map(|(path, value)| (path, value))));
        self.changed(py, model, "set", &values)
    }

    fn with_laws(&self, py: Python<'_>, laws: Vec<(String, String)>) -> PyResult<Self> {
        let model = self.given.model.clone().with_laws(laws.iter().map(|(family, law)| (family, law)));
        self.changed(py, model, "law", &laws)
    }

    fn compile(&self, py: Python<'_>, duty: CompileArguments) -> PyResult<Compiled> {
        Compiled::new(py, self.train(), duty)
    }
}
