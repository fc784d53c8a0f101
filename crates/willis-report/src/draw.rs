//! A figure of any kind as a picture.

use willis::figure::Figure;

use crate::{
    bands, film, flow_svg, front, lever, losses, map, path, regime_map, sankey, shift, stick, time_plot, tornado,
};

/// How a figure is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drawing {
    /// Wheels turn, where the kind has wheels.
    pub animated: bool,
}

/// A figure as SVG in its light form, text as text.
pub fn draw(figure: &Figure, how: Drawing) -> String {
    match figure {
        Figure::Stick(data) => stick(data),
        Figure::Lever(data) => lever(data),
        Figure::Sankey(data) => sankey(data),
        Figure::Flow(data) => flow_svg(data),
        Figure::Front(data) => front(data, how.animated),
        Figure::Regimes(data) => regime_map(data),
        Figure::Map(data) => map(data),
        Figure::Losses(data) => losses(data),
        Figure::Film(data) => film(data),
        Figure::Path(data) => path(data),
        Figure::Time(data) => time_plot(data),
        Figure::Shift(data) => shift(data),
        Figure::Tornado(data) => tornado(data),
        Figure::Band(data) => bands(data),
    }
}
