//! Motion as differential equations: states with their rates, energies beside them.

use crate::train::SourceKind;

use super::engine::Engine;
use super::integrator::Smooth;

impl Smooth for Engine {
    fn states(&self) -> usize {
        self.integrals() + self.system.integrals
    }

    fn quadratures(&self) -> usize {
        self.energies()
    }

    fn rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        if self.rates_by_ports() {
            self.solve(t, x);
        } else {
            self.solve_affinely(t, x);
        }
        if !self.agrees {
            rate.fill(f64::NAN);
            return;
        }
        let (free, all) = (self.system.free, self.system.all());
        rate[..free].copy_from_slice(&self.acceleration[..free]);
        rate[free..free + all].copy_from_slice(&self.speed);
        if self.quadratures() == 0 && rate.len() == free + all {
            return;
        }
        let integrals = self.integrals();
        for (k, driver) in self.system.drivers.iter().enumerate() {
            if let (Some(i), SourceKind::Controller { setpoint, .. }) =
                (driver.integral, &self.system.scenario.sources[k].kind)
            {
                let set = setpoint.value(t, self.inside, &|m| self.member_speed(m));
                rate[integrals + i] = set - self.member_speed(driver.member);
            }
        }
        let states = self.states();
        self.path_rates(t, &mut rate[integrals..states]);
        self.powers(t, x, &mut rate[states..]);
    }

    fn scale(&self, state: usize) -> f64 {
        self.scales.get(state).copied().unwrap_or(self.energy_scale)
    }
}
