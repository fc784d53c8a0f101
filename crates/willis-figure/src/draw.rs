//! A figure of any kind as a picture.

use crate::*;

/// How a figure is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drawing {
    /// Wheels turn, where the kind has wheels.
    pub animated: bool,
}

/// A figure as SVG in its light form, text as text.
pub fn draw(figure: &Figure, how: Drawing) -> String {
    match figure {
        Figure::Stick(data) => draw_stick(data),
        Figure::Lever(data) => draw_lever(data),
        Figure::Sankey(data) => draw_sankey(data),
        Figure::Flow(data) => draw_flow(data),
        Figure::Front(data) => draw_front(data, how.animated),
        Figure::Regimes(data) => draw_regimes(data),
        Figure::Map(data) => draw_map(data),
        Figure::Losses(data) => draw_losses(data),
        Figure::Film(data) => draw_film(data),
        Figure::Path(data) => draw_path(data),
        Figure::Time(data) => draw_time(data),
        Figure::Shift(data) => draw_shift(data),
        Figure::Tornado(data) => draw_tornado(data),
        Figure::Band(data) => draw_band(data),
    }
}
