//! Figures of Willis as SVG: text stays text, colours are safe for the colour-blind, and every
//! colour also carries a letter.

mod regime_map;
mod style;

pub use regime_map::regime_map;
