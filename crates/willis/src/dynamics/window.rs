//! A part of a run: what lies before a time is not told.

use std::ops::ControlFlow;

use super::report::{Column, Event, Recorder, Sample};

/// Hands on rows and events from a time on.
pub(super) struct Window<'a> {
    from: f64,
    to: &'a mut dyn Recorder,
}

impl<'a> Window<'a> {
    pub fn new(from: f64, to: &'a mut dyn Recorder) -> Self {
        Self { from, to }
    }
}

impl Recorder for Window<'_> {
    fn columns(&mut self, columns: &[Column]) -> ControlFlow<()> {
        self.to.columns(columns)
    }

    fn wants_row(&self, time: f64) -> bool {
        time >= self.from && self.to.wants_row(time)
    }

    fn sample(&mut self, sample: Sample<'_>) -> ControlFlow<()> {
        if sample.time_s < self.from { ControlFlow::Continue(()) } else { self.to.sample(sample) }
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        if event.time_s < self.from { ControlFlow::Continue(()) } else { self.to.event(event) }
    }

    fn progress(&mut self, time: f64) -> ControlFlow<()> {
        self.to.progress(time)
    }
}
