//! A run and all that it gave.

use std::ops::ControlFlow;

use willis::dynamics::{Column, Event, Options, Recorder, RunReport, Sample, simulate};
use willis::train::Train;

/// What a run gave.
#[derive(Default)]
pub struct Rows {
    pub names: Vec<String>,
    pub kinds: Vec<&'static str>,
    pub rows: Vec<Vec<f64>>,
    pub events: Vec<Event>,
}

impl Rows {
    /// All values of the columns of a kind, or that begin so.
    pub fn of<'a>(&'a self, what: &'a str) -> impl Iterator<Item = f64> + 'a {
        let is_meant = |k: &usize| self.kinds[*k] == what || self.names[*k].starts_with(what);
        let columns: Vec<usize> = (0..self.names.len()).filter(is_meant).collect();
        self.rows.iter().flat_map(move |row| columns.iter().map(|&k| row[k]).collect::<Vec<_>>())
    }

    pub fn greatest(&self, what: &str) -> f64 {
        self.of(what).fold(0.0, |most, x| most.max(x.abs()))
    }
}

impl Recorder for Rows {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        self.names = columns.iter().map(|c| c.name.clone()).collect();
        self.kinds = columns.iter().map(|c| c.kind.name()).collect();
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
