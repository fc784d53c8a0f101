//! A run in the hands of another program that keeps the time: it asks for steps and sets inputs in between, or it integrates
//! the states itself and asks for their rates and for what tells of events.

use std::ops::ControlFlow;

use crate::diagnostic::Diagnostics;
use crate::dynamics::event::Why;
use crate::dynamics::handles::{InputHandle, InputRefused};
use crate::dynamics::integrator::Smooth;
use crate::dynamics::margins::Margin;
use crate::dynamics::report::{ColumnUnit, EnergyLossKind, Event, Outcome, Recorder};
use crate::dynamics::stretch::Watch;
use crate::train::Signal;

use super::Simulation;

/// How long a line goes on that has no end, s.
const LONG: f64 = 1e6;

/// A continuous state of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct StateInfo {
    /// `sun.speed`, `sun.angle`, or `integral.0` of a controller or variator.
    pub name: String,
    /// In what its value is.
    pub unit: ColumnUnit,
    /// In what its rate is, where that has a unit of its own.
    pub rate_unit: ColumnUnit,
}

/// What loses power in a run.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LossCause {
    /// Mesh, drag, shift element, shaft; place of a loss that follows a law.
    pub name: String,
    /// What it is.
    pub kind: EnergyLossKind,
}

/// Stops at the first change of mode after a time.
struct First {
    after: f64,
}

impl Recorder for First {
    fn wants_row(&self, _: f64) -> bool {
        false
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        if event.time_s > self.after { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Simulation {
    /// Goes back to the start with inputs that have these values from there on, prescribed speeds among them.
    ///
    /// # Errors
    /// A value that is not finite, speeds at the start that contradict each other.
    ///
    /// # Example
    /// ```
    /// # use willis::dynamics::{Options, Simulation};
    /// # use willis::train::Train;
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "a rotor starts"
    ///     members = ["rotor"]
    ///     inertias = { rotor = "2 kg m^2" }
    ///     [[scenario]]
    ///     name = "start"
    ///     duration = "10 s"
    ///     [[scenario.source]]
    ///     name = "motor"
    ///     member = "rotor"
    ///     torque = "4 N m"
    /// "#)?;
    /// let run = Simulation::new(&train, "start", &Options { energies: false, ..Options::default() })?;
    /// let motor = run.input("motor")?;
    /// let mut run = run.again_with(&[(motor, 6.0)])?;
    /// // Another program integrates.
    /// run.settle().unwrap();
    /// let (mut state, mut rates) = (run.state().to_vec(), vec![0.0; 2]);
    /// for k in 0..1000 {
    ///     run.look_at(1e-3 * f64::from(k), &state);
    ///     run.rates(&mut rates);
    ///     state.iter_mut().zip(&rates).for_each(|(x, rate)| *x += 1e-3 * rate);
    /// }
    /// assert_eq!(run.states()[0].name, "rotor.speed");
    /// assert!((state[0] - 3.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn again_with(mut self, inputs: &[(InputHandle, f64)]) -> Result<Self, Diagnostics> {
        for (input, value) in inputs {
            self.engine.system.set(*input, *value)?;
        }
        self.again()
    }

    /// What an input is worth at the time reached.
    pub fn worth(&mut self, input: InputHandle) -> f64 {
        let (t, inside) = (self.t, self.engine.inside);
        let signal = self.engine.system.signal_of(input).clone();
        signal.value(t, inside, &|m| self.engine.member_speed(m))
    }

    /// Leads an input from what it is worth now in a straight line to a value, which it reaches at a time, s, and keeps. So a
    /// prescribed speed changes between two steps of another program.
    ///
    /// # Errors
    /// If the value is not finite, or the time not ahead.
    pub fn lead(&mut self, input: InputHandle, value: f64, until: f64) -> Result<(), InputRefused> {
        let from = self.worth(input);
        if !(value.is_finite() && until.is_finite() && until > self.t) {
            return Err(InputRefused::NotFinite);
        }
        // Its break is at that time to the last bit.
        let points = vec![[self.t, from], [until, value]];
        *self.engine.system.signal_of(input) = Signal::Table { points, hold: false };
        self.changed();
        Ok(())
    }

    /// Sets an input together with its rate, for a program that integrates the states itself: from now on it goes on in that
    /// direction.
    ///
    /// # Errors
    /// If one of them is not finite.
    pub fn set_moving(&mut self, input: InputHandle, value: f64, rate: f64) -> Result<(), InputRefused> {
        if !(value.is_finite() && rate.is_finite()) {
            return Err(InputRefused::NotFinite);
        }
        // In the piece that is looked at, and without a break ahead.
        let at = self.engine.inside.min(self.t);
        let offset = value - rate * (self.t - at);
        *self.engine.system.signal_of(input) = Signal::Ramp { offset, height: rate * LONG, at, duration: LONG };
        self.changed();
        Ok(())
    }

    fn changed(&mut self) {
        self.engine.forget_stretches();
        (self.rolling, self.row_is_present) = (false, false);
    }

    /// Goes on to a time, s, as [`Simulation::advance`] does, also beyond the end of the scenario, whose inputs then go on
    /// as they ended.
    pub fn go_on(&mut self, until: f64) -> Option<Outcome> {
        self.hosted = true;
        self.extend(until);
        let outcome = self.advance(until, &mut ());
        self.pause();
        outcome
    }

    /// The same up to the first change of mode, if there is one: the time reached tells.
    pub fn go_on_to_event(&mut self, until: f64) -> Option<Outcome> {
        self.hosted = true;
        self.extend(until);
        let outcome = self.advance(until, &mut First { after: self.t });
        self.pause();
        if outcome == Some(Outcome::Interrupted) {
            self.outcome = None;
            return None;
        }
        outcome
    }

    /// What goes on depends on the state alone, not on how it was reached.
    pub(super) fn pause(&mut self) {
        (self.rolling, self.start_is_known, self.row_is_present) = (false, false, false);
    }

    /// Puts the end of the scenario off where it would be reached.
    fn extend(&mut self, until: f64) {
        let length = {
            let s = &self.engine.system;
            s.train.find_scenario(&s.scenario.name).map_or(1.0, |s| s.end - s.start)
        };
        let end = &mut self.engine.system.scenario.end;
        if until.is_finite() && until >= *end {
            *end = until + length;
        }
    }

    /// The continuous states.
    pub fn states(&self) -> Vec<StateInfo> {
        let s = &self.engine.system;
        let name = |k: usize| s.train.member_name(s.coordinates[k]);
        let speeds = (0..s.free).map(|k| StateInfo {
            name: format!("{}.speed", name(k)),
            unit: ColumnUnit::RadianPerSecond,
            rate_unit: ColumnUnit::RadianPerSecondSquared,
        });
        let angles = (0..s.all()).map(|k| StateInfo {
            name: format!("{}.angle", name(k)),
            unit: ColumnUnit::Radian,
            rate_unit: ColumnUnit::RadianPerSecond,
        });
        let none = ColumnUnit::None;
        let integrals =
            (0..s.integrals).map(|k| StateInfo { name: format!("integral.{k}"), unit: none, rate_unit: none });
        speeds.chain(angles).chain(integrals).collect()
    }

    /// Their values at the time reached.
    pub fn state(&self) -> &[f64] {
        &self.x[..self.engine.states()]
    }

    /// Takes over a time, s, and the states there, of a program that integrates them itself.
    pub fn look_at(&mut self, time: f64, state: &[f64]) {
        let states = self.engine.states().min(state.len());
        if time != self.t || self.x[..states] != state[..states] {
            self.rested.0 = f64::NAN;
        }
        self.t = time;
        self.x[..states].copy_from_slice(&state[..states]);
        (self.rolling, self.row_is_present) = (false, false);
        let x = std::mem::take(&mut self.x);
        self.engine.look(time, &x);
        self.x = x;
    }

    /// Rates of the states at the time reached, in the present mode.
    pub fn rates(&mut self, out: &mut [f64]) {
        let x = std::mem::take(&mut self.x);
        let mut all = vec![0.0; x.len()];
        self.engine.rate(self.t, &x, &mut all);
        out.iter_mut().zip(&all).for_each(|(out, rate)| *out = *rate);
        self.x = x;
    }

    /// How many indicators there are.
    pub fn indicator_count(&self) -> usize {
        let s = &self.engine.system;
        2 * s.groups.len() + 1 + s.elements.len() + s.elastic.len() + s.paths.len() + s.frictions.len()
    }

    /// Indicators of events at the time reached: the present mode ends where one becomes negative. One that watches nothing
    /// in this mode is 1.
    pub fn indicators(&mut self, out: &mut [f64]) {
        self.look_at_margins();
        out.fill(1.0);
        for margin in &self.margins {
            if let Some(out) = out.get_mut(self.place(margin.watch)) {
                *out = margin.spare();
            }
        }
    }

    fn place(&self, watch: Watch) -> usize {
        let s = &self.engine.system;
        let rest = 2 * s.groups.len();
        let elements = rest + 1;
        let shafts = elements + s.elements.len();
        let paths = shafts + s.elastic.len();
        let frictions = paths + s.paths.len();
        match watch {
            Watch::Slip(g) => 2 * g,
            Watch::Hold(g, sign) => 2 * g + usize::from(sign < 0),
            Watch::Rest => rest,
            Watch::Side(j) => elements + j,
            Watch::Touch(k) => shafts + k,
            Watch::End(k) => paths + k,
            Watch::Engage(k) => frictions + k,
        }
    }

    fn look_at_margins(&mut self) {
        let x = std::mem::take(&mut self.x);
        self.engine.margins(self.t, &x, &mut self.margins);
        self.x = x;
    }

    /// Whether the present mode no longer holds at the time reached, or the piece of the inputs has ended.
    pub fn is_over(&mut self) -> bool {
        self.look_at_margins();
        self.t >= self.segment
            || self.margins.iter().any(Margin::is_broken)
            || !self.engine.certified && !self.options.continue_when_ambiguous && {
                let x = std::mem::take(&mut self.x);
                self.engine.solve(self.t, &x);
                self.x = x;
                !self.engine.is_single(self.t)
            }
    }

    /// Chooses the mode at the time reached, for a program that integrates the states itself: at the start, where an
    /// indicator became negative, where inputs break or were set to another value. True if the states changed: what comes
    /// to rest does so exactly.
    ///
    /// # Errors
    /// Why there is no mode to go on in.
    pub fn settle(&mut self) -> Result<bool, Outcome> {
        if let Some(outcome) = &self.outcome {
            return Err(outcome.clone());
        }
        self.hosted = true;
        self.extend(self.t);
        if !matches!(self.why, Some(Why::Start)) {
            self.look_at_margins();
            let part = |m: &Margin| m.value / m.noise.max(1e-300);
            let broken = self.margins.iter().filter(|m| m.is_broken());
            let first = broken.clone().min_by(|a, b| part(a).total_cmp(&part(b)));
            self.why = first.map(|m| Why::Watch(m.watch)).or((self.t >= self.segment).then_some(Why::Input));
            for margin in broken {
                if let Watch::Slip(g) = margin.watch {
                    self.at_rest[g] = true;
                }
            }
        }
        let before = self.x.clone();
        if let Err(outcome) = self.choose(&mut ()) {
            self.outcome = Some(outcome.clone());
            return Err(outcome);
        }
        self.pause();
        Ok(before != self.x)
    }

    /// Where the inputs break next, s: the mode is to be [chosen](Self::settle) there.
    pub fn next_break(&self) -> f64 {
        self.segment
    }

    /// Whether it has ended, and how.
    pub fn outcome(&self) -> Option<&Outcome> {
        self.outcome.as_ref()
    }

    /// Changes of mode so far, the start among them.
    pub fn event_count(&self) -> usize {
        self.events
    }

    /// The last change of mode, in words.
    pub fn last_event(&self) -> &str {
        &self.told
    }

    /// Whatever loses power, in the order of [`Simulation::losses`].
    pub fn loss_causes(&self) -> Vec<LossCause> {
        self.engine.causes().into_iter().map(|(name, kind, _)| LossCause { name, kind }).collect()
    }

    /// Power lost at the time reached, by cause, W.
    pub fn losses(&mut self, out: &mut Vec<f64>) {
        self.row();
        let mut powers = vec![0.0; self.engine.powers_count()];
        let x = std::mem::take(&mut self.x);
        self.engine.powers(self.t, &x, &mut powers);
        self.x = x;
        out.clear();
        out.extend(self.engine.causes().iter().map(|(_, _, of)| of.iter().map(|&k| powers[k]).sum::<f64>()));
    }
}
