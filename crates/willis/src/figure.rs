//! Charts and diagrams as data: what stands where, in which role, with which words. No pixels, no
//! fonts; front ends draw.

mod lever;
mod regime_map;
mod shift;
mod time_plot;
mod tornado;

pub use lever::{
    Lever, LeverBar, LeverCase, LeverLink, LeverNode, LeverPull, LeverRequest, LeverRole, LeverSet, lever,
};
pub use regime_map::{Curve, MapBoundary, MapCell, MapPattern, MapSector, RegimeMap, regime_map};
pub use shift::{ShiftChange, ShiftColumn, ShiftEfficiency, ShiftRow, ShiftSpread, ShiftTable, shift};
pub use time_plot::{ModeRow, ModeSegment, TimeLine, TimeMark, TimePanel, TimePlot, TimePlotBuilder, outcome_in_words};
pub use tornado::{Tornado, TornadoBar, tornado};
