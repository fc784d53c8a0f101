//! Charts and diagrams as data: what stands where, in which role, with which words. No pixels, no
//! fonts; front ends draw. A kind is a file here, a line in `kind.rs`, and a file and a line where it is drawn.

mod axes;
mod band;
mod kind;
mod lever;
mod losses;
mod map;
mod contact_path;
mod front;
mod regime_map;
mod sankey;
mod shift;
mod stick;
mod time_plot;
mod tornado;

pub use axes::ChartAxis;
pub use band::{BandPoint, Bands, QUANTILES, bands};
pub use contact_path::{ContactPath, MeshPath, PathPoint, contact_path};
pub use front::{Front, FrontBody, FrontMesh, FrontPlane, FrontSpacing, FrontWheel, front};
pub use kind::{Figure, FigureKind, FigureRequest};
pub use lever::{
    Lever, LeverBar, LeverCase, LeverLink, LeverNode, LeverPull, LeverRequest, LeverRole, LeverSet, lever,
};
pub use losses::{LossChart, LossSeries, loss_chart};
pub use map::{EfficiencyMap, MapMark, MapPoint, efficiency_map};
pub use regime_map::{Curve, MapBoundary, MapCell, MapPattern, MapSector, RegimeMap, regime_map};
pub use sankey::{Sankey, SankeyFlow, SankeyLink, SankeyLoss, SankeyNode, SankeyPanel, sankey};
pub use shift::{ShiftChange, ShiftColumn, ShiftEfficiency, ShiftRow, ShiftSpread, ShiftTable, shift};
pub use stick::{
    GearRole, JointKind, Place, Stick, StickBlock, StickGear, StickGround, StickJoint, StickMember, StickMesh,
    StickPiece, StickTerminal, Way, stick,
};
pub use time_plot::{ModeRow, ModeSegment, TimeLine, TimeMark, TimePanel, TimePlot, TimePlotBuilder, outcome_in_words};
pub use tornado::{Tornado, TornadoBar, tornado};
