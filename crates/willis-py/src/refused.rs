//! Refusals as exceptions of Python.

use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use willis::diagnostic::Diagnostics;
use willis_ask::{Given, Refusal};

/// The exception `willis.TrainError` with the diagnostics of a refusal, each at its place.
pub fn refused(py: Python<'_>, refusal: &Refusal, of: &[Given]) -> PyErr {
    if *refusal == Refusal::Cancelled {
        return PyKeyboardInterrupt::new_err(());
    }
    let (text, json) = (refusal.render(of, false), willis_ask::json(&refusal.report(of)));
    let made = py.import("willis._errors").and_then(|m| m.getattr("TrainError")?.call_method1("_of", (&text, json)));
    match made {
        Ok(error) => PyErr::from_value(error),
        Err(_) => PyRuntimeError::new_err(text),
    }
}

/// The same for a request alone.
pub fn wrong(py: Python<'_>, wrong: Diagnostics) -> PyErr {
    refused(py, &Refusal::from(wrong), &[])
}
