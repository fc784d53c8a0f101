//! Figures of Willis: charts and diagrams as data, and drawn as SVG and PNG. Reports as documents and as web pages.
//!
//! A figure is data first: what stands where, in which role, with which words; no pixels, no fonts. [`draw`]
//! makes SVG of it: text stays text, colours are safe for the colour-blind, and every colour also
//! carries a letter. A kind of figure is a file with its data and a folder with its drawing.

mod band;
mod columns;
mod contact_path;
mod flow;
mod front;
mod heat;
mod kind;
mod lever;
mod losses;
mod map;
mod modes;
mod pareto;
mod parts;
mod regimes;
mod registry;
pub mod report;
mod sankey;
mod shift;
mod side_by_side;
mod spin;
mod split;
mod stick;
mod table;
mod tikz;
mod time;
mod tornado;
mod vibration;
mod wolf;

// `report::document` looks for it here.
use willis::contract;

pub use band::draw::draw as draw_band;
pub use band::{BandPoint, Bands, QUANTILES, bands};
pub use columns::{Column, Columns};
pub use contact_path::film::draw as draw_film;
pub use contact_path::path::draw as draw_path;
pub use contact_path::{ContactPath, MeshPath, PathPoint, contact_path};
pub use flow::dot::flow_dot;
pub use flow::draw::draw as draw_flow;
pub use front::draw::draw as draw_front;
pub use front::dxf::front_dxf;
pub use front::{Front, FrontBody, FrontMesh, FrontPlane, FrontSpacing, FrontWheel, front};
pub use heat::draw::draw as draw_heat;
pub use heat::{HeatPicture, heat_picture};
pub use kind::{Ask, Drawing, FigureRequest};
pub use lever::draw::draw as draw_lever;
pub use lever::panel::{LeverScale, draw as lever_panel};
pub use lever::{
    Lever, LeverBar, LeverCase, LeverLayout, LeverLink, LeverNode, LeverPull, LeverRequest, LeverRole, LeverSet, lever,
};
pub use losses::draw::draw as draw_losses;
pub use losses::{LossChart, LossSeries, loss_chart};
pub use map::draw::draw as draw_map;
pub use map::{EfficiencyMap, MapBorder, MapJoint, MapMark, MapPoint, MapVerdict, efficiency_map};
pub use modes::draw as draw_modes;
pub use pareto::{Pareto, ParetoAxis, ParetoPoint, draw as draw_pareto};
pub use parts::axes::ChartAxis;
#[cfg(feature = "png")]
pub use parts::png::png;
pub use parts::theme::{Theme, themed};
pub use regimes::draw::draw as draw_regimes;
pub use regimes::{Curve, MapBoundary, MapCell, MapPattern, MapSector, RegimeMap, regime_map};
pub use registry::{Figure, FigureKind, draw};
pub use report::html::html;
pub use report::{ReportRequest, report};
pub use sankey::draw::{SankeyPaper, draw as draw_sankey};
pub use sankey::{Sankey, SankeyFlow, SankeyLayout, SankeyLink, SankeyLoss, SankeyNode, SankeyPanel, sankey};
pub use shift::draw::draw as draw_shift;
pub use shift::{ShiftChange, ShiftColumn, ShiftEfficiency, ShiftRow, ShiftSpread, ShiftTable, shift};
pub use side_by_side::{SidePanel, draw_side_by_side};
pub use spin::draw::draw as draw_spin;
pub use spin::{SpinGear, SpinLosses, SpinSource, spin_losses};
pub use split::draw::draw as draw_split;
pub use split::{MechanicalPoint, Split, SplitGear, SplitMode, SplitPoint, split};
pub use stick::draw::{draw as draw_stick, in_columns as stick_panel};
pub use stick::{
    GearRole, JointKind, Place, Stick, StickBlock, StickGear, StickGround, StickJoint, StickLayout, StickMember,
    StickMesh, StickPiece, StickTerminal, TerminalDirection, stick,
};
pub use table::draw::draw as draw_table;
pub use tikz::tikz;
pub use time::draw::draw as draw_time;
pub use time::{ModeRow, ModeSegment, TimeLine, TimeMark, TimePanel, TimePlot, TimePlotBuilder, TimeShift};
pub use tornado::draw::draw as draw_tornado;
pub use tornado::{Tornado, TornadoBar, tornado};
pub use vibration::draw::draw as draw_vibration;
pub use vibration::{Vibration, VibrationMode, vibration};
pub use wolf::draw::draw as draw_wolf;
pub use wolf::{Wolf, WolfMember, WolfSet, WolfShaft, WolfTie, WolfVariator, wolf};

/// The code of the page of this crate runs as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
