//! Tables by columns.

use numpy::ndarray::ArrayView1;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use serde::{Deserialize, Serialize};
use willis_ask::table::{Cell, Kind};

use crate::arrow;

/// Cells of a column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum CellValues {
    /// Real numbers; NaN where there is none. In JSON it is null.
    Numbers(#[serde(with = "numbers")] Vec<f64>),
    Integers(Vec<Option<i64>>),
    Texts(Vec<Option<String>>),
    Flags(Vec<Option<bool>>),
}

/// Numbers in JSON, which has no NaN.
mod numbers {
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(all: &[f64], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(all.iter().map(|x| (!x.is_nan()).then_some(*x)))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
        let all = Vec::<Option<f64>>::deserialize(from)?;
        Ok(all.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    pub name: String,
    /// Empty where there is none.
    pub unit: String,
    pub cells: CellValues,
}

/// A table, by columns.
#[pyclass(frozen, module = "willis._willis")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    pub name: String,
    pub rows: usize,
    pub columns: Vec<Column>,
}

impl Table {
    pub fn of(table: willis_ask::table::Table) -> Self {
        let rows = table.rows.len();
        let mut columns: Vec<Column> = table
            .columns
            .into_iter()
            .map(|c| {
                let cells = match c.kind {
                    Kind::Text => CellValues::Texts(Vec::with_capacity(rows)),
                    Kind::Number => CellValues::Numbers(Vec::with_capacity(rows)),
                    Kind::Integer => CellValues::Integers(Vec::with_capacity(rows)),
                    Kind::Flag => CellValues::Flags(Vec::with_capacity(rows)),
                };
                Column { name: c.name, unit: c.unit, cells }
            })
            .collect();
        for row in table.rows {
            for (column, cell) in columns.iter_mut().zip(row) {
                column.cells.push(cell);
            }
        }
        Self { name: table.name, rows, columns }
    }

    fn column(&self, name: &str) -> PyResult<&Column> {
        self.columns.iter().find(|c| c.name == name).ok_or_else(|| PyKeyError::new_err(name.to_owned()))
    }
}

impl CellValues {
    fn push(&mut self, cell: Cell) {
        match (self, cell) {
            (Self::Numbers(all), Cell::Number(x)) => all.push(x),
            (Self::Numbers(all), Cell::Integer(x)) => all.push(x as f64),
            (Self::Numbers(all), _) => all.push(f64::NAN),
            (Self::Integers(all), Cell::Integer(x)) => all.push(Some(x)),
            (Self::Integers(all), _) => all.push(None),
            (Self::Texts(all), Cell::Text(x)) => all.push(Some(x)),
            (Self::Texts(all), _) => all.push(None),
            (Self::Flags(all), Cell::Flag(x)) => all.push(Some(x)),
            (Self::Flags(all), _) => all.push(None),
        }
    }
}

#[pymethods]
impl Table {
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn columns(&self) -> Vec<String> {
        self.columns.iter().map(|c| c.name.clone()).collect()
    }

    #[getter]
    fn units(&self) -> Vec<String> {
        self.columns.iter().map(|c| c.unit.clone()).collect()
    }

    fn __len__(&self) -> usize {
        self.rows
    }

    /// The cells of a column: an array of numbers, not copied, or a list.
    fn column_of<'py>(this: Bound<'py, Self>, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let table = this.get();
        Ok(match &table.column(name)?.cells {
            CellValues::Numbers(all) => numbers_of(all, this.clone().into_any()).into_any(),
            CellValues::Integers(all) if all.iter().all(Option::is_some) => {
                PyArray1::from_iter(py, all.iter().flatten().copied()).into_any()
            }
            CellValues::Integers(all) => all.clone().into_pyobject(py)?.into_any(),
            CellValues::Texts(all) => all.clone().into_pyobject(py)?.into_any(),
            CellValues::Flags(all) => all.clone().into_pyobject(py)?.into_any(),
        })
    }

    /// The table as JSON, from which [`Table::again`] makes it.
    fn packed(&self) -> String {
        serde_json::to_string(self).expect("plain data")
    }

    #[staticmethod]
    fn again(packed: &str) -> PyResult<Self> {
        serde_json::from_str(packed).map_err(|e| PyValueError::new_err(e.to_string()))
    }

    /// The stream of the Arrow C interface: one batch.
    fn arrow_stream<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        arrow::stream(py, self)
    }
}

/// Numbers of a table as an array that cannot be written to and keeps the table alive.
#[allow(unsafe_code)]
fn numbers_of<'py>(all: &[f64], owner: Bound<'py, PyAny>) -> Bound<'py, PyArray1<f64>> {
    // SAFETY: the table is frozen, so its numbers neither move nor change while it lives, and the array holds it.
    let array = unsafe { PyArray1::borrow_from_array(&ArrayView1::from(all), owner) };
    let _ = array.readwrite().make_nonwriteable();
    array
}
