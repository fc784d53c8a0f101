//! Charts and diagrams as data: what stands where, in which role, with which words. No pixels, no
//! fonts; front ends draw.

mod contact_path;
mod front;
mod regime_map;
mod time_plot;

pub use contact_path::{ContactPath, MeshPath, PathPoint, contact_path};
pub use front::{Front, FrontBody, FrontMesh, FrontPlane, FrontSpacing, FrontWheel, front};
pub use regime_map::{Curve, MapBoundary, MapCell, MapPattern, MapSector, RegimeMap, regime_map};
pub use time_plot::{ModeRow, ModeSegment, TimeLine, TimeMark, TimePanel, TimePlot, TimePlotBuilder, outcome_in_words};
