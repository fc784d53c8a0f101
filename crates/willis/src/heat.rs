//! The temperature at which losses and dissipation agree, and how it is reached.
//!
//! The laws see one temperature, that of the oil `θ`. All other places of the thermal network follow from it and from the
//! heat that is made at them: their equations are those of a convex potential (every flow rises with the difference of
//! its two temperatures), so they have one solution. What is left is one equation in `θ`:
//!
//! ```text
//! Q(θ) = P(θ)      Q: heat that leaves the oil if nothing is made elsewhere
//!                  P: heat made in the oil, and of what is made elsewhere the part that reaches the oil
//! ```
//!
//! - [`network`]: the temperatures of the other places, for an oil temperature;
//! - [`balance()`]: every oil temperature at which the two agree, with the reason why there is no other;
//! - [`transient`]: temperatures over time: warm-up, duty cycles, time constants.
//!
//! What makes the heat is a function of the oil temperature, so that a train, a table and a formula are treated alike.
//!
//! Sources: W. Funck, Wärmeabführung bei Getrieben unter quasistationären Betriebsbedingungen, diss. TU München 1985;
//! C. Changenet, X. Oviedo-Marlot, P. Velex, J. Mech. Des. 128 (2006); the criteria of uniqueness are derived in the
//! modules.

pub mod balance;
pub mod network;
pub mod transient;

pub use balance::{Balance, Bounds, Certificate, Equilibrium, HeatVerdict, Limits, Method, Sample, balance};
pub use network::{Linearised, Unsolved};
pub use transient::{PeriodicDuty, Row, Run, Segment, duty, time_constants, warm_up};

/// What makes heat, as a function of the oil temperature.
pub trait Source {
    /// Why there is no heat at some temperature.
    type Error;

    /// Heat made at each place of the network, W, at an oil temperature, K. The heat that a network has beside the losses
    /// ([`Heat::extra_heat`](crate::train::heat::Heat)) is not part of it.
    ///
    /// # Errors
    /// There is no answer at this temperature.
    fn heat(&self, oil: f64) -> Result<Vec<f64>, Self::Error>;

    /// What the heats and their slopes are within over a whole interval of oil temperatures, where that is known for
    /// sure. Without it, bounds are taken from samples.
    fn bounds(&self, from: f64, to: f64) -> Option<Vec<Bounds>> {
        let _ = (from, to);
        None
    }
}

/// A formula of the oil temperature as a source.
impl<E, F: Fn(f64) -> Result<Vec<f64>, E>> Source for F {
    type Error = E;

    fn heat(&self, oil: f64) -> Result<Vec<f64>, E> {
        self(oil)
    }
}
