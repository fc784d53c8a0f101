//! An engine whose temperatures follow what is lost.

use crate::heat::network::Unsolved;

use super::engine::Engine;
use super::integrator::Smooth;
use super::shows::Shows;
use super::warming::Warming;

impl Engine {
    /// From now on temperatures follow what is lost, where the train says what carries heat away.
    ///
    /// # Errors
    /// The network has no temperatures at the start.
    pub fn warm(&mut self) -> Result<(), Unsolved> {
        let Some(warming) = Warming::of(&self.system, self.system.scenario.start)? else { return Ok(()) };
        self.shows.extend(warming.places().map(Shows::Temperature));
        self.warming = Some(Box::new(warming));
        self.warm_laws();
        Ok(())
    }

    /// Lets the laws see the oil as warm as it is. Whether that changes them.
    fn warm_laws(&mut self) -> bool {
        let Some(oil) = self.warming.as_ref().map(|w| w.oil()) else { return false };
        self.system.laws.as_mut().is_some_and(|laws| laws.warm_to(oil))
    }

    /// Temperatures and heats that were [saved](Warming::saved). Whether they are such.
    pub fn restore_heat(&mut self, numbers: &[f64]) -> bool {
        let restored = match &mut self.warming {
            Some(warming) => warming.restore(numbers),
            None => numbers.is_empty(),
        };
        self.warm_laws();
        restored
    }

    /// Lets the temperatures follow up to a time that was reached, where it is time to. Whether the laws have changed.
    ///
    /// # Errors
    /// In words, where the network has no temperatures there.
    pub fn follow_heat(&mut self, t: f64, x: &[f64]) -> Result<bool, String> {
        let states = self.states();
        let Some(warming) = self.warming.as_mut().filter(|w| w.is_due(t, &x[states..])) else { return Ok(false) };
        let followed = warming.follow(t, &x[states..]);
        followed.map_err(|_| format!("at t = {t} s the thermal network of [heat] has no finite temperatures"))?;
        Ok(self.warm_laws())
    }
}
