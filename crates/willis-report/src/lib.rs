//! Figures of Willis as SVG: text stays text, colours are safe for the colour-blind, and every
//! colour also carries a letter. Power flows also as Graphviz. Reports as web pages.

pub mod document;
mod flow_dot;
mod flow_svg;
mod formula;
mod html;
mod markup;
mod modes_plot;
mod regime_map;
mod style;
mod theme;
mod time_plot;

pub use flow_dot::flow_dot;
pub use flow_svg::flow_svg;
pub use html::html;
pub use modes_plot::modes_plot;
pub use regime_map::regime_map;
pub use theme::{Theme, themed};
pub use time_plot::time_plot;
