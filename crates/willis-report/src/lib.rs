//! Figures of Willis as SVG: text stays text, colours are safe for the colour-blind, and every
//! colour also carries a letter. Power flows also as Graphviz.

mod band;
mod chart;
pub mod document;
mod flow_dot;
mod flow_svg;
mod losses;
mod map;
mod lever;
mod modes_plot;
#[cfg(feature = "png")]
mod png;
mod regime_map;
mod stick;
mod sankey;
mod shift;
mod style;
mod time_plot;

pub use band::bands;
pub use flow_dot::flow_dot;
pub use flow_svg::flow_svg;
pub use losses::losses;
pub use map::map;
pub use lever::lever;
pub use modes_plot::modes_plot;
#[cfg(feature = "png")]
pub use png::png;
pub use regime_map::regime_map;
pub use stick::stick;
pub use sankey::sankey;
pub use shift::shift;
pub use time_plot::time_plot;
