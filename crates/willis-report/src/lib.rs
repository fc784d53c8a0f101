//! Figures of Willis as SVG and PNG: text stays text, colours are safe for the colour-blind, and every
//! colour also carries a letter. Power flows also as Graphviz. Reports as documents and as web pages.

mod band;
mod chart;
pub mod document;
mod draw;
mod flow_dot;
mod flow_svg;
mod formula;
mod html;
mod lever;
mod losses;
mod map;
mod markup;
mod modes_plot;
#[cfg(feature = "png")]
mod png;
mod film;
mod front;
mod path;
mod regime_map;
mod report;
mod sankey;
mod shift;
mod stick;
mod style;
mod theme;
mod time_plot;
mod tornado;

pub use band::bands;
pub use draw::{Drawing, draw};
pub use film::film;
pub use flow_dot::flow_dot;
pub use flow_svg::flow_svg;
pub use front::front;
pub use html::html;
pub use lever::lever;
pub use losses::losses;
pub use map::map;
pub use modes_plot::modes_plot;
pub use path::path;
#[cfg(feature = "png")]
pub use png::png;
pub use regime_map::regime_map;
pub use report::{ReportRequest, report};
pub use sankey::sankey;
pub use shift::shift;
pub use stick::stick;
pub use theme::{Theme, themed};
pub use time_plot::time_plot;
pub use tornado::tornado;
