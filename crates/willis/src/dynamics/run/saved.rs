//! The state of a run as bytes, for a program that goes on with it elsewhere.

use std::fmt;

use crate::dynamics::engine::Touch;
use crate::dynamics::integrator::Smooth;
use crate::dynamics::mode::Side;
use crate::dynamics::report::{ModeLabel, Outcome};
use crate::train::Signal;

use super::Simulation;

/// What such bytes begin with.
const MARK: &[u8; 8] = b"willis 1";

/// Why bytes are not the state of this run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotSaved;

impl fmt::Display for NotSaved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("these bytes are not a state that was saved from a run of this scenario")
    }
}

impl std::error::Error for NotSaved {}

/// Numbers, one after the other.
struct Written(Vec<u8>);

impl Written {
    fn number(&mut self, x: f64) {
        self.0.extend(x.to_bits().to_le_bytes());
    }

    fn numbers(&mut self, all: impl ExactSizeIterator<Item = f64>) {
        self.number(all.len() as f64);
        all.for_each(|x| self.number(x));
    }

    fn text(&mut self, text: &str) {
        self.number(text.len() as f64);
        self.0.extend(text.bytes());
    }
}

struct Read<'a>(&'a [u8]);

impl Read<'_> {
    fn bytes(&mut self, count: usize) -> Result<&[u8], NotSaved> {
        let (first, rest) = self.0.split_at_checked(count).ok_or(NotSaved)?;
        self.0 = rest;
        Ok(first)
    }

    fn number(&mut self) -> Result<f64, NotSaved> {
        let bytes = self.bytes(8)?.try_into().map_err(|_| NotSaved)?;
        Ok(f64::from_bits(u64::from_le_bytes(bytes)))
    }

    fn count(&mut self) -> Result<usize, NotSaved> {
        let x = self.number()?;
        // Exact, and no more than memory has.
        if x >= 0.0 && x.fract() == 0.0 && x < 1e12 { Ok(x as usize) } else { Err(NotSaved) }
    }

    /// As many numbers as there have to be; any number where that is not known.
    fn numbers(&mut self, expected: Option<usize>) -> Result<Vec<f64>, NotSaved> {
        let count = self.count()?;
        if expected.is_some_and(|n| n != count) || count > self.0.len() / 8 {
            return Err(NotSaved);
        }
        (0..count).map(|_| self.number()).collect()
    }

    fn text(&mut self) -> Result<String, NotSaved> {
        let count = self.count()?;
        String::from_utf8(self.bytes(count)?.to_vec()).map_err(|_| NotSaved)
    }
}

fn flags(of: &[bool]) -> impl ExactSizeIterator<Item = f64> {
    of.iter().map(|x| f64::from(u8::from(*x)))
}

fn touch_number(touch: Touch) -> f64 {
    match touch {
        Touch::Gap => 0.0,
        Touch::On(side) => f64::from(side),
        Touch::Limited(side) => 2.0 * f64::from(side),
        Touch::Parting(side) => 3.0 * f64::from(side),
    }
}

fn touch_of(x: f64) -> Touch {
    let side = if x < 0.0 { -1 } else { 1 };
    match x.abs() as u8 {
        0 => Touch::Gap,
        1 => Touch::On(side),
        2 => Touch::Limited(side),
        _ => Touch::Parting(side),
    }
}

impl Simulation {
    /// The whole state as bytes, inputs that were set among it. A run of the same scenario of the same train that
    /// [restores](Self::restore) it goes on as this one does, to the last bit; where losses follow laws, whose forces are found
    /// by rounds, to within what these leave open.
    ///
    /// # Example
    /// ```
    /// # use willis::dynamics::{Options, Simulation};
    /// # use willis::train::Train;
    /// # let train = Train::from_toml("format = 1\nname = 'a rotor coasts'\nmembers = ['rotor']\n\
    /// #     inertias = { rotor = '2 kg m^2' }\ndrag = [{ name = 'b', members = ['rotor'], coulomb = '4 N m' }]\n\
    /// #     scenario = [{ name = 'coast', duration = '10 s', initial_speeds = { rotor = '12 rad/s' } }]")?;
    /// let mut run = Simulation::new(&train, "coast", &Options::default())?;
    /// run.go_on(3.0);
    /// let bytes = run.save();
    /// let mut other = Simulation::new(&train, "coast", &Options::default())?;
    /// other.restore(&bytes).unwrap();
    /// run.go_on(7.0);
    /// other.go_on(7.0);
    /// assert_eq!(run.state(), other.state());
    /// assert!(other.restore(&bytes[1..]).is_err());
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn save(&mut self) -> Vec<u8> {
        let mut to = Written(MARK.to_vec());
        for input in self.inputs() {
            // What the scenario has itself is there already.
            match self.engine.system.signal_of(input.input) {
                Signal::Constant(x) => to.numbers([*x].into_iter()),
                Signal::Ramp { offset, height, at, duration } => {
                    to.numbers([*offset, *height, *at, *duration].into_iter());
                }
                Signal::Table { points, hold: false } if points.len() == 2 => {
                    to.numbers([points[0][0], points[0][1], points[1][0], points[1][1], 0.0].into_iter());
                }
                _ => to.numbers([].into_iter()),
            }
        }
        let (engine, s) = (&self.engine, &self.engine.system);
        to.numbers(self.x.iter().copied());
        to.numbers(self.came_in.iter().copied());
        to.numbers(flags(&self.at_rest));
        to.numbers(flags(&self.rested.1));
        to.number(self.rested.0);
        to.numbers(self.labels.iter().map(|l| l.value()));
        to.numbers(self.recent.iter().copied());
        to.numbers(engine.mode.slip.iter().map(|x| f64::from(*x)));
        to.numbers(engine.mode.side.iter().map(|x| f64::from(u8::from(*x == Side::Coast))));
        to.numbers(engine.touch.iter().map(|x| touch_number(*x)));
        to.numbers(flags(&engine.engaged));
        to.numbers(engine.path_ends.iter().map(|x| f64::from(*x)));
        to.numbers(engine.scales.iter().copied());
        to.numbers(engine.speed.iter().copied());
        to.numbers(engine.acceleration.iter().copied());
        let last_step = self.last_step.unwrap_or(f64::NAN);
        let counts = [self.next_sample, self.steps, self.events, usize::from(self.stiff), engine.unproved];
        let times = [self.t, self.segment, s.scenario.end, engine.inside, last_step];
        let others = [self.stored_at_start, engine.energy_scale];
        to.numbers(counts.map(|x| x as f64).into_iter());
        to.numbers(times.into_iter());
        to.numbers(others.into_iter());
        to.numbers(engine.warming.iter().flat_map(|w| w.saved()).collect::<Vec<f64>>().into_iter());
        to.text(&self.told);
        to.text(&self.outcome.as_ref().map_or(String::new(), |o| serde_json::to_string(o).unwrap_or_default()));
        to.0
    }

    /// Goes back, or ahead, to a state that was [saved](Self::save).
    ///
    /// # Errors
    /// If it is none of this scenario; nothing has changed then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), NotSaved> {
        let mut new = self.clone();
        let mut from = Read(bytes);
        if from.bytes(MARK.len())? != MARK {
            return Err(NotSaved);
        }
        let own = {
            let s = &new.engine.system;
            s.train.find_scenario(&s.scenario.name).map_err(|_| NotSaved)?.clone()
        };
        new.engine.system.scenario = own;
        for input in new.inputs() {
            let signal = match from.numbers(None)?[..] {
                [] => continue,
                [x] => Signal::Constant(x),
                [offset, height, at, duration] => Signal::Ramp { offset, height, at, duration },
                [t0, y0, t1, y1, _] if t1 > t0 => Signal::Table { points: vec![[t0, y0], [t1, y1]], hold: false },
                _ => return Err(NotSaved),
            };
            *new.engine.system.signal_of(input.input) = signal;
        }
        let fill = |to: &mut Vec<f64>, from: &mut Read<'_>| -> Result<(), NotSaved> {
            *to = from.numbers(Some(to.len()))?;
            Ok(())
        };
        fill(&mut new.x, &mut from)?;
        fill(&mut new.came_in, &mut from)?;
        new.at_rest = from.numbers(Some(new.at_rest.len()))?.iter().map(|x| *x != 0.0).collect();
        new.rested.1 = from.numbers(Some(new.rested.1.len()))?.iter().map(|x| *x != 0.0).collect();
        new.rested.0 = from.number()?;
        new.hosted = true;
        let labels = from.numbers(None)?;
        new.labels = labels.iter().map(|x| ModeLabel::of_value(*x).ok_or(NotSaved)).collect::<Result<_, _>>()?;
        new.recent = from.numbers(None)?.into();
        let mut mode = new.engine.mode.clone();
        mode.slip = from.numbers(Some(mode.slip.len()))?.iter().map(|x| *x as i8).collect();
        let side = |x: &f64| if *x == 0.0 { Side::Drive } else { Side::Coast };
        mode.side = from.numbers(Some(mode.side.len()))?.iter().map(side).collect();
        let engine = &mut new.engine;
        engine.touch = from.numbers(Some(engine.touch.len()))?.iter().map(|x| touch_of(*x)).collect();
        engine.engaged = from.numbers(Some(engine.engaged.len()))?.iter().map(|x| *x != 0.0).collect();
        engine.path_ends = from.numbers(Some(engine.path_ends.len()))?.iter().map(|x| *x as i8).collect();
        fill(&mut engine.scales, &mut from)?;
        fill(&mut engine.speed, &mut from)?;
        fill(&mut engine.acceleration, &mut from)?;
        let [next_sample, steps, events, stiff, unproved] = from.numbers(Some(5))?[..] else { return Err(NotSaved) };
        let [t, segment, end, inside, last_step] = from.numbers(Some(5))?[..] else { return Err(NotSaved) };
        let [stored_at_start, energy_scale] = from.numbers(Some(2))?[..] else { return Err(NotSaved) };
        if !engine.restore_heat(&from.numbers(None)?) {
            return Err(NotSaved);
        }
        new.told = from.text()?;
        let outcome = from.text()?;
        if !from.0.is_empty() || !t.is_finite() {
            return Err(NotSaved);
        }
        new.outcome = match &*outcome {
            "" => None,
            text => Some(serde_json::from_str::<Outcome>(text).map_err(|_| NotSaved)?),
        };
        (new.next_sample, new.steps, new.events) = (next_sample as usize, steps as usize, events as usize);
        (new.stiff, new.last_step) = (stiff != 0.0, (!last_step.is_nan()).then_some(last_step));
        (new.t, new.segment, new.stored_at_start) = (t, segment, stored_at_start);
        let engine = &mut new.engine;
        (engine.inside, engine.energy_scale, engine.unproved) = (inside, energy_scale, unproved as usize);
        engine.system.scenario.end = end;
        engine.forget_stretches();
        if events > 0.0 {
            new.why = None;
            engine.still = None;
            if !engine.enter(&mode) {
                return Err(NotSaved);
            }
            let mut x = std::mem::take(&mut new.x);
            engine.stand_still(&mode, &mut x);
            let states = engine.states();
            if x[..states].iter().all(|x| x.is_finite()) {
                engine.solve(t, &x);
            }
            new.x = x;
        }
        new.pause();
        *self = new;
        Ok(())
    }
}
