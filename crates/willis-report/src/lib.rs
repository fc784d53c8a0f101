//! Figures of Willis as SVG: text stays text, colours are safe for the colour-blind, and every
//! colour also carries a letter. Power flows also as Graphviz.

mod film;
mod flow_dot;
mod flow_svg;
mod front;
mod modes_plot;
mod path;
mod regime_map;
mod style;
mod time_plot;

pub use film::film;
pub use flow_dot::flow_dot;
pub use flow_svg::flow_svg;
pub use front::front;
pub use modes_plot::modes_plot;
pub use path::path;
pub use regime_map::regime_map;
pub use time_plot::time_plot;
