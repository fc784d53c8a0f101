//! From millimetres to the page, and what all pictures of a front view draw alike.

use svg::node::element::Circle;

use crate::Front;
use crate::parts::style::number;

pub const DASH_DOT: &str = "10 3 2 3";

/// Millimetres to the page.
pub struct View {
    pub centre: (f64, f64),
    pub scale: f64,
}

impl View {
    pub fn at(&self, p: [f64; 2]) -> (f64, f64) {
        (self.centre.0 + p[0] * self.scale, self.centre.1 - p[1] * self.scale)
    }
}

pub fn circle(at: (f64, f64), radius: f64, stroke: &str, width: f64) -> Circle {
    Circle::new()
        .set("cx", number(at.0))
        .set("cy", number(at.1))
        .set("r", number(radius))
        .set("fill", "none")
        .set("stroke", stroke)
        .set("stroke-width", number(width))
}

/// A name without that of its set, which stands above.
pub fn own<'a>(view: &Front, name: &'a str) -> &'a str {
    name.strip_prefix(view.set.as_str()).and_then(|rest| rest.strip_prefix('.')).unwrap_or(name)
}
