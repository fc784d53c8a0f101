//! Charts and diagrams as data: what stands where, in which role, with which words. No pixels, no
//! fonts; front ends draw.

mod axes;
mod band;
mod losses;
mod map;
mod regime_map;
mod stick;
mod sankey;
mod time_plot;

pub use axes::ChartAxis;
pub use band::{BandPoint, Bands, QUANTILES, bands};
pub use losses::{LossChart, LossSeries, loss_chart};
pub use map::{EfficiencyMap, MapMark, MapPoint, efficiency_map};
pub use regime_map::{Curve, MapBoundary, MapCell, MapPattern, MapSector, RegimeMap, regime_map};
pub use stick::{
    GearRole, JointKind, Place, Stick, StickBlock, StickGear, StickGround, StickJoint, StickMember, StickMesh,
    StickPiece, StickTerminal, Way, stick,
};
pub use sankey::{Sankey, SankeyFlow, SankeyLink, SankeyLoss, SankeyNode, SankeyPanel, sankey};
mod lever;
mod regime_map;
mod shift;
mod time_plot;

pub use lever::{
    Lever, LeverBar, LeverCase, LeverLink, LeverNode, LeverPull, LeverRequest, LeverRole, LeverSet, lever,
};
pub use regime_map::{Curve, MapBoundary, MapCell, MapPattern, MapSector, RegimeMap, regime_map};
pub use shift::{ShiftChange, ShiftColumn, ShiftEfficiency, ShiftRow, ShiftSpread, ShiftTable, shift};
pub use time_plot::{ModeRow, ModeSegment, TimeLine, TimeMark, TimePanel, TimePlot, TimePlotBuilder, outcome_in_words};
