//! The oil temperature that follows moves with everything: its derivative, and what that does to powers and losses.
//!
//! At an oil temperature `T` that follows, `R(T, x) = 0`: heat that leaves the oil less heat that reaches it. So
//! `dT/dx = −R_x/R_T`. The temperatures of all other places follow from their own equations `F = 0`; with `φ` the part of
//! the heat of each place that reaches the oil, `R_x = F_x,oil + Σ φ F_x`, and the same for `T`.

use num_dual::Dual64;

use crate::analysis::{HeatBasis, HeatReport, Point, heat_placed};
use crate::heat::Linearised;
use crate::heat::network::imbalance;
use crate::train::heat::Heat;
use crate::train::{HeatNumber, Operation, Slot, Train};

use super::balance::{Powers, powers};
use super::lanes::{Asked, Moved};

/// How an operating point follows its oil temperature.
pub(super) struct Following<'t> {
    train: &'t Train,
    heat: &'t Heat,
    at: Linearised,
    /// Powers with their derivative by the temperature.
    by_temperature: Powers,
    /// `R_T`, W/K.
    slope: f64,
}

impl<'t> Following<'t> {
    /// `None` where the temperature is given, or nothing follows.
    pub fn new(train: &'t Train, operation: &Operation, point: &Point<'_>, report: &HeatReport) -> Option<Self> {
        let heat = train.heat().filter(|_| report.basis == HeatBasis::Balance)?;
        let asked = Asked { slots: &[(Slot::Temperature, 1.0)], moved: Moved::Train };
        let by_temperature = powers(train, operation, point, &[asked]).pop()??;
        let made: Vec<f64> = heat_made(train, heat, &by_temperature).iter().map(|p| p.re).collect();
        let at = heat.at(report.oil_k, &made).ok()?;
        let mut following = Self { train, heat, at, by_temperature, slope: 0.0 };
        following.slope = following.at.slope - following.reaching(&following.by_temperature);
        (following.slope > 0.0).then_some(following)
    }

    /// Derivative of the heat that reaches the oil, from those of the losses.
    fn reaching(&self, found: &Powers) -> f64 {
        heat_made(self.train, self.heat, found).iter().zip(&self.at.shares).map(|(p, share)| p.eps * share).sum()
    }

    /// `dT/dx` for a quantity; its powers get what the temperature adds.
    pub fn follow(&self, slots: &[(Slot, f64)], found: &mut Powers) -> f64 {
        let seeded = self.heat.map(&|number, x| {
            let slot = match number {
                HeatNumber::Density => Slot::Density15,
                other => Slot::Heat(other),
            };
            Dual64::new(x, slots.iter().find(|(own, _)| *own == slot).map_or(0.0, |(_, rate)| *rate))
        });
        let places = seeded.nodes.iter().zip(&self.at.temperatures);
        let t: Vec<Dual64> = places.map(|(n, t)| n.fixed.unwrap_or(Dual64::from(*t))).collect();
        let left = imbalance(&seeded, &t, &vec![0.0; t.len()]);
        let carried: f64 = left.iter().zip(&self.at.shares).map(|(f, share)| f.eps * share).sum();
        let by = (self.reaching(found) - carried) / self.slope;
        let hot = &self.by_temperature;
        for (own, other) in
            [(&mut found.input, hot.input), (&mut found.output, hot.output), (&mut found.loss, hot.loss)]
        {
            own.eps += other.eps * by;
        }
        for (name, kind, law, loss) in &hot.sources {
            let same = |s: &&mut (String, crate::operating_point::LossKind, &'static str, Dual64)| {
                s.0 == *name && s.1 == *kind && s.2 == *law
            };
            if let Some(own) = found.sources.iter_mut().find(same) {
                own.3.eps += loss.eps * by;
            }
        }
        by
    }
}

/// Heat made at each place, with its derivative.
fn heat_made(train: &Train, heat: &Heat, found: &Powers) -> Vec<Dual64> {
    heat_placed(train, heat, found.sources.iter().map(|s| (s.0.as_str(), s.1, s.3))).0
}
