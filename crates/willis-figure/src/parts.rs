//! What figures share: colours and type, frames of charts, dark paper, pixels, words.

pub mod alive;
pub mod axes;
pub mod chart;
pub mod markup;
#[cfg(feature = "png")]
pub mod png;
pub mod point;
pub mod style;
pub mod theme;
pub mod words;
