//! What lies around an operating point: the planes that cut the speeds, and the region between them.

use crate::exact::Rational;
use crate::regimes::arrangement::dot;
use crate::regimes::atlas::{plane, regime_name};
use crate::regimes::cells::{Cells, enumerate};

use super::equilibria::State;
use super::point::Point;

/// Planes and regions around an operating point.
pub(super) struct Surroundings {
    pub planes: Vec<Vec<Rational>>,
    /// What is the case on each plane.
    pub labels: Vec<String>,
    /// Planes on which the point lies exactly.
    pub on: Vec<String>,
    /// All regions and their regimes, or why they are not listed.
    pub cells: Result<Cells, String>,
    /// The region around the point, where it is inside one.
    pub region: Option<usize>,
}

impl Surroundings {
    pub fn of(point: &Point<'_>) -> Self {
        let setup = &point.setup;
        let planes = setup.planes();
        let label = |f: &Vec<Rational>| {
            let label = plane(setup, f).label;
            if label.is_empty() { "a torque vanishes".to_owned() } else { label }
        };
        let labels: Vec<String> = planes.iter().map(label).collect();
        let signs: Vec<i8> = planes.iter().map(|f| dot(f, &point.base).sign()).collect();
        let on = signs.iter().zip(&labels).filter(|(s, _)| **s == 0).map(|(_, l)| l.clone()).collect();
        let cells = enumerate(setup);
        let region = cells.as_ref().ok().and_then(|cells| cells.region(&signs));
        Self { planes, labels, on, cells, region }
    }

    /// The name of a regime as it is listed.
    pub fn regime(&self, point: &Point<'_>, state: &State) -> Option<String> {
        let (cells, k) = (self.cells.as_ref().ok()?, self.region?);
        let signs: Vec<i8> = state.torques.iter().map(Rational::sign).collect();
        let list = &cells.torques[k];
        let n = list.iter().position(|x| x.pattern == state.pattern && x.signs == signs)?;
        Some(regime_name(&point.setup, k, list, n))
    }
}
