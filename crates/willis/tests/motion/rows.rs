//! A run and all that it gave.

use std::ops::ControlFlow;

use willis::dynamics::{Column, Event, Options, Recorder, RunReport, Sample, simulate};
use willis::train::Train;

/// What a run gave.
#[derive(Default)]
pub struct Rows {
    pub names: Vec<String>,
    pub rows: Vec<Vec<f64>>,
    pub events: Vec<Event>,
}

impl Rows {
    /// All values of the columns that begin so.
    pub fn of<'a>(&'a self, prefix: &'a str) -> impl Iterator<Item = f64> + 'a {
        let columns: Vec<usize> = (0..self.names.len()).filter(|&k| self.names[k].starts_with(prefix)).collect();
        self.rows.iter().flat_map(move |row| columns.iter().map(|&k| row[k]).collect::<Vec<_>>())
    }

    pub fn greatest(&self, prefix: &str) -> f64 {
        self.of(prefix).fold(0.0, |most, x| most.max(x.abs()))
    }
}

impl Recorder for Rows {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        self.names = columns.iter().map(|c| c.name.clone()).collect();
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        self.rows.push(sample.values.to_vec());
        ControlFlow::Continue(())
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.events.push(event.clone());
        ControlFlow::Continue(())
    }
}

pub fn train(text: &str) -> Train {
    Train::from_toml(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

pub fn run(text: &str, options: &Options) -> (Rows, RunReport) {
    let mut rows = Rows::default();
    let report = simulate(&train(text), "run", options, &mut rows).unwrap_or_else(|e| panic!("{e}\n{text}"));
    (rows, report)
}
