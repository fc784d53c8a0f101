//! The picture of a run, collected while it runs. Without the feature `pictures` there is none, and no option asks for it.

use willis::dynamics::{Recorder, RunReport};
use willis::train::Train;

#[cfg(feature = "pictures")]
pub struct Plot(willis_figure::TimePlotBuilder);
#[cfg(not(feature = "pictures"))]
pub enum Plot {}

#[cfg(feature = "pictures")]
impl Plot {
    pub fn new(train: &Train, span: [f64; 2]) -> Option<Self> {
        Some(Self(willis_figure::TimePlotBuilder::new(train, span)))
    }

    pub fn listener(&mut self) -> &mut dyn Recorder {
        &mut self.0
    }

    pub fn svg(self, report: &RunReport) -> String {
        willis_figure::draw_time(&self.0.finish(report)) + "\n"
    }
}

#[cfg(not(feature = "pictures"))]
impl Plot {
    pub fn new(_: &Train, _: [f64; 2]) -> Option<Self> {
        None
    }

    pub fn listener(&mut self) -> &mut dyn Recorder {
        match *self {}
    }

    pub fn svg(self, _: &RunReport) -> String {
        match self {}
    }
}
