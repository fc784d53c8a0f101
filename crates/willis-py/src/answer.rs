//! Questions and their answers.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::{Value, json};
use willis::diagnostic::Diagnostics;
use willis_ask::{Given, QUESTIONS, Refusal, Request, style};

use crate::interpreter::Interpreter;
use crate::refused::refused;
use crate::table::Table;
use crate::train::Train;

/// An answer, kept as what the library gave.
#[pyclass(frozen, module = "willis._willis", name = "Answer")]
pub struct Answer {
    answer: Box<dyn willis_ask::Answer + Send + Sync>,
    request: Box<dyn Request>,
    of: Arc<[Given]>,
}

/// The answer to a question that is given by name, its request as JSON.
#[pyfunction]
#[pyo3(signature = (question, request, trains, threads=0, patience=60.0, progress=None))]
pub fn ask(
    py: Python<'_>,
    question: &str,
    request: &str,
    trains: Vec<PyRef<'_, Train>>,
    threads: usize,
    patience: f64,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let of: Arc<[Given]> = trains.iter().map(|t| t.given.clone()).collect();
    let work = Interpreter::new(threads, patience, progress);
    let asked = py.detach(|| -> Result<_, Refusal> {
        let request = read(question, request)?;
        let answer = request.ask_for_good(of.clone(), &work)?;
        work.finish();
        Ok((request, answer))
    });
    if let Some(error) = work.raised() {
        return Err(error);
    }
    let (request, answer) = asked.map_err(|refusal| refused(py, &refusal, &of))?;
    Ok(Answer { answer, request, of })
}

/// A request from JSON, with the files that it names.
fn read(question: &str, request: &str) -> Result<Box<dyn Request>, Refusal> {
    let entry = willis_ask::question(question).expect("the package asks what is in the list");
    let request: Value = serde_json::from_str(request).expect("the package writes JSON");
    let mut request = entry.request(request)?;
    for (file, holds) in request.attachments() {
        if file.text.is_empty() {
            file.text = willis_cli::input::attached(&file.name, holds).map_err(|w| Refusal::File(w, file.clone()))?;
        }
    }
    Ok(request)
}

/// What piece `k` of `n`, counted from 0, of a question finds; on one thread, however long it takes.
#[pyfunction]
pub fn piece<'py>(
    py: Python<'py>,
    question: &str,
    request: &str,
    train: PyRef<'_, Train>,
    k: usize,
    n: usize,
) -> PyResult<Bound<'py, PyBytes>> {
    let of = [train.given.clone()];
    let work = Interpreter::new(1, f64::INFINITY, None);
    let found = py.detach(|| read(question, request)?.piece(&of, k, n, &work));
    if let Some(error) = work.raised() {
        return Err(error);
    }
    Ok(PyBytes::new(py, &found.map_err(|refusal| refused(py, &refusal, &of))?))
}

/// The answer from all pieces of a question, in their order.
#[pyfunction]
pub fn gather(
    py: Python<'_>,
    question: &str,
    request: &str,
    train: PyRef<'_, Train>,
    pieces: Vec<Vec<u8>>,
) -> PyResult<Answer> {
    let of: Arc<[Given]> = Arc::new([train.given.clone()]);
    let gathered = py.detach(|| -> Result<_, Refusal> {
        let request = read(question, request)?;
        let answer = request.gather(of.clone(), &pieces)?;
        Ok((request, answer))
    });
    let (request, answer) = gathered.map_err(|refusal| refused(py, &refusal, &of))?;
    Ok(Answer { answer, request, of })
}

#[pymethods]
impl Answer {
    #[getter]
    fn question(&self) -> &'static str {
        self.request.question().name
    }

    fn request(&self) -> String {
        self.request.to_json().to_string()
    }

    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| self.answer.json())
    }

    #[pyo3(signature = (color=false))]
    fn text(&self, color: bool) -> String {
        let text = self.answer.text();
        if color { text } else { style::plain(&text) }
    }

    /// Warnings and notes, as JSON, each at its place in the first train; and for eyes.
    fn notes(&self) -> (String, String) {
        let mut all: Diagnostics = self.answer.notes().into_iter().collect();
        let mut told = String::new();
        if let Some(given) = self.of.first() {
            given.model.locate(&mut all);
            told = all.render(&given.name, given.model.to_toml(), false);
        }
        (willis_ask::json(&all.iter().collect::<Vec<_>>()), told)
    }

    fn told(&self) -> Vec<String> {
        self.answer.told()
    }

    #[getter]
    fn is_partial(&self) -> bool {
        self.answer.is_partial()
    }

    fn tables(&self, py: Python<'_>) -> Vec<Table> {
        py.detach(|| self.answer.tables().into_iter().map(Table::of).collect())
    }

    /// Files of a form: name and bytes.
    fn write<'py>(&self, py: Python<'py>, form: &str) -> PyResult<Vec<(String, Bound<'py, PyBytes>)>> {
        let files = py.detach(|| self.answer.write(form)).map_err(|refusal| refused(py, &refusal, &self.of))?;
        Ok(files.into_iter().map(|f| (f.name, PyBytes::new(py, &f.bytes))).collect())
    }

    fn extra<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Vec<(String, Bound<'py, PyBytes>)>> {
        let files = py.detach(|| self.answer.extra(name)).map_err(|refusal| refused(py, &refusal, &self.of))?;
        Ok(files.into_iter().map(|f| (f.name, PyBytes::new(py, &f.bytes))).collect())
    }
}

/// All questions as JSON: names, trains, contracts, tables, forms, schemas of request and answer.
#[pyfunction]
pub fn questions() -> String {
    let of = |q: &willis_ask::Entry| {
        let forms: Vec<&str> = q.forms.iter().map(|f| f.name).collect();
        let extras: Vec<&str> = q.extras.iter().map(|e| e.name).collect();
        json!({
            "name": q.name, "of": q.of, "contract": q.contract, "tables": q.tables, "forms": forms, "extras": extras,
            "request": q.request_schema(), "answer": q.answer_schema(),
        })
    };
    Value::Array(QUESTIONS.iter().map(of).collect()).to_string()
}
