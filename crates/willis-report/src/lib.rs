//! Figures of Willis as SVG: text stays text, colours are safe for the colour-blind, and every
//! colour also carries a letter. Power flows also as Graphviz.

mod flow_dot;
mod flow_svg;
mod lever;
mod modes_plot;
mod regime_map;
mod shift;
mod style;
mod time_plot;
mod tornado;

pub use flow_dot::flow_dot;
pub use flow_svg::flow_svg;
pub use lever::lever;
pub use modes_plot::modes_plot;
pub use regime_map::regime_map;
pub use shift::shift;
pub use time_plot::time_plot;
pub use tornado::tornado;
