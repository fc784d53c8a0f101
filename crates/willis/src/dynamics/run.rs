//! From start to end: smooth motion, changes of mode, rows and events.

mod hosted;
mod locate;
mod pace;
mod saved;

use std::collections::VecDeque;
use std::ops::ControlFlow;

use crate::contract::Format;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{MemberId, Train};

use super::choose::Trouble;
use super::engine::Engine;
use super::event::{Why, event};
use super::handles::{InputHandle, InputInfo, InputRefused, OutputHandle};
use super::integrator::{Dopri5, Implicit, Smooth, StepError, Stepper};
use super::margins::{Margin, NOISE};
use super::report::{Column, Method, ModeLabel, Options, Outcome, Recorder, RunReport, Sample};
use super::rounding::short;
use super::start::{AS_WRITTEN, initial_state};
use super::stretch::Watch;
use super::system::System;
use super::window::Window;
use pace::Pace;

pub use hosted::{LossCause, StateInfo};
pub use saved::NotSaved;

/// How often in a run what a formula does to a held element is looked at, at least.
const LOOKS: f64 = 1000.0;

/// Slip that is none, over the speeds of which it is the difference.
const ROUND_OFF: f64 = 1e-11;

/// A scenario that is being run.
///
/// # Example
/// ```
/// use willis::dynamics::{Options, Outcome, Simulation};
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "a rotor coasts"
///     members = ["rotor"]
///     inertias = { rotor = "2 kg m^2" }
///
///     [[drag]]
///     name = "bearing"
///     members = ["rotor"]
///     coulomb = "4 N m"
///
///     [[scenario]]
///     name = "coast"
///     duration = "10 s"
///     initial_speeds = { rotor = "12 rad/s" }
/// "#)?;
/// let mut run = Simulation::new(&train, "coast", &Options::default())?;
/// assert_eq!(run.advance(3.0, &mut ()), None);
/// assert!((run.speed("rotor").unwrap() - 6.0).abs() < 1e-9);
/// assert_eq!(run.advance(10.0, &mut ()), Some(Outcome::Finished));
/// assert_eq!(run.speed("rotor"), Some(0.0));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
///
/// Inputs and outputs have handles, as in [`FixedStep`](super::FixedStep); a clone is the whole state.
#[derive(Clone)]
pub struct Simulation {
    pub(super) engine: Engine,
    options: Options,
    explicit: Dopri5,
    implicit: Implicit,
    stiff: bool,
    /// Whether the integrator stands at the present state in the present mode.
    rolling: bool,
    pub(super) t: f64,
    /// States and energies.
    pub(super) x: Vec<f64>,
    /// Of the energies of the sources what came in, in steps that are over.
    pub(super) came_in: Vec<f64>,
    segment: f64,
    /// From when on there are rows.
    pub(super) from: f64,
    /// The longest step that sees what the signals do.
    longest: f64,
    at_rest: Vec<bool>,
    /// In the hands of another program: what was at rest where the mode was chosen last, and when that was. A choice that is
    /// made once more at the same state is then the same.
    hosted: bool,
    rested: (f64, Vec<bool>),
    pub(super) labels: Vec<ModeLabel>,
    /// Why the mode is chosen anew.
    why: Option<Why>,
    /// The last event.
    told: String,
    pub(super) columns: Vec<Column>,
    pub(super) row: Vec<f64>,
    /// Whether the row is that of the time reached.
    row_is_present: bool,
    pub(super) next_sample: usize,
    samples: usize,
    recent: VecDeque<f64>,
    pace: Pace,
    last_step: Option<f64>,
    pub(super) steps: usize,
    pub(super) events: usize,
    stored_at_start: f64,
    pub(super) outcome: Option<Outcome>,
    pub(super) notes: Vec<String>,
    /// The first of several solutions was taken: why the first time, and how often.
    ambiguous: Option<(String, usize)>,
    margins: Vec<Margin>,
    /// Margins at the start, in the middle and at the end of the last step, and whether the first are known.
    at_start: Vec<Margin>,
    start_is_known: bool,
    at_middle: Vec<Margin>,
    at_end: Vec<Margin>,
    state: Vec<f64>,
}

/// How the present stretch ended.
enum Stretch {
    /// An event or a break of the inputs: the mode is chosen anew.
    Again,
    /// The time asked for was reached.
    Reached,
    /// It cannot go on.
    Ended(Outcome),
}

impl Simulation {
    /// Prepares a scenario of a train.
    ///
    /// # Errors
    /// An unknown scenario, contradictory speeds, inertia that is missing.
    pub fn new(train: &Train, scenario: &str, options: &Options) -> Result<Self, Diagnostics> {
        options.check()?;
        let system = System::new(train, scenario, 0.0, warms(options))?;
        let mut engine = Engine::new(system);
        let [from, to] = options.window(&engine.system.scenario)?;
        engine.system.scenario.end = to;
        engine.counts = options.energies;
        engine.slack = (0.1 * options.tolerance / NOISE).max(1.0);
        if warms(options) {
            warm(&mut engine)?;
        }
        let columns = engine.columns();
        Self::at_start(engine, columns, options.clone(), from)
    }

    /// Goes back to the start. What was learned about modes stays, so that the same run takes a fraction of the time; so do
    /// inputs that were [set](Self::set).
    ///
    /// ```
    /// # use willis::dynamics::{Options, Simulation};
    /// # use willis::train::Train;
    /// # let train = Train::from_toml(r#"
    /// #     format = 1
    /// #     name = "a rotor starts"
    /// #     members = ["rotor"]
    /// #     inertias = { rotor = "2 kg m^2" }
    /// #     [[scenario]]
    /// #     name = "start"
    /// #     duration = "10 s"
    /// #     [[scenario.source]]
    /// #     name = "motor"
    /// #     member = "rotor"
    /// #     torque = "4 N m"
    /// # "#)?;
    /// let mut run = Simulation::new(&train, "start", &Options::default())?;
    /// let motor = run.input("motor")?;
    /// let mut speeds = vec![];
    /// for torque in [4.0, 5.0, 6.0] {
    ///     run.set(motor, torque).unwrap();
    ///     run.advance(10.0, &mut ());
    ///     speeds.push(run.speed("rotor").unwrap().round());
    ///     run = run.again()?;
    /// }
    /// assert_eq!(speeds, [20.0, 25.0, 30.0]);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    ///
    /// # Errors
    /// Speeds at the start that contradict each other under inputs that were set.
    pub fn again(self) -> Result<Self, Diagnostics> {
        let mut engine = self.engine.anew();
        if warms(&self.options) {
            warm(&mut engine)?;
        }
        Self::at_start(engine, self.columns, self.options, self.from)
    }

    fn at_start(mut engine: Engine, columns: Vec<Column>, options: Options, from: f64) -> Result<Self, Diagnostics> {
        let start = engine.system.scenario.start;
        let x = initial_state(&mut engine)?;
        let stored_at_start = engine.stored(&x);
        engine.energy_scale = engine.energy_scale.max(stored_at_start);
        let samples = options.samples.unwrap_or(engine.system.scenario.samples).max(2);
        let (states, quadratures) = (engine.states(), engine.quadratures());
        let (groups, accounts) = (engine.system.groups.len(), engine.system.accounts());
        let notes = uniqueness(&engine, options.method).into_iter().collect();
        Ok(Self {
            explicit: Dopri5::new(states, quadratures),
            implicit: Implicit::new(states, quadratures),
            stiff: false,
            rolling: false,
            t: start,
            x,
            came_in: vec![0.0; if engine.counts { accounts } else { 0 }],
            segment: start,
            from,
            longest: f64::INFINITY,
            at_rest: vec![false; groups],
            hosted: false,
            rested: (f64::NAN, vec![false; groups]),
            labels: vec![],
            why: Some(Why::Start),
            told: String::new(),
            columns,
            row: vec![],
            row_is_present: false,
            next_sample: 0,
            samples,
            recent: VecDeque::new(),
            pace: Pace::new([engine.system.all(), engine.system.nodes], start, options.patience_s),
            options,
            last_step: None,
            steps: 0,
            events: 0,
            stored_at_start,
            outcome: None,
            notes,
            ambiguous: None,
            margins: vec![],
            at_start: vec![],
            start_is_known: false,
            at_middle: vec![],
            at_end: vec![],
            state: vec![0.0; states + quadratures],
            engine,
        })
    }

    /// The columns of a row.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// Speed of a member, rad/s.
    pub fn speed(&self, member: &str) -> Option<f64> {
        let m = self.engine.system.train.member(member)?;
        Some(self.engine.member_speed(m))
    }

    /// Angle that a member has turned through since the start, rad.
    pub fn angle(&self, member: &str) -> Option<f64> {
        let s = &self.engine.system;
        let m = s.train.member(member)?;
        Some(super::mode::dot(&s.speeds[m.index()], &self.x[s.free..s.free + s.all()]))
    }

    /// The inputs that can be set.
    pub fn inputs(&self) -> Vec<InputInfo> {
        self.engine.system.inputs()
    }

    /// The input of that name: that of a source, or `engagement.` and the name of a shift element that the scenario
    /// engages.
    ///
    /// # Errors
    /// If there is none, with the nearest name; if it is a load that follows the speed.
    pub fn input(&self, name: &str) -> Result<InputHandle, Diagnostics> {
        self.engine.system.input(name)
    }

    /// Sets an input: from now on it has this value.
    ///
    /// # Errors
    /// If the value is not finite, or if a prescribed speed would jump.
    pub fn set(&mut self, input: InputHandle, value: f64) -> Result<(), InputRefused> {
        let s = &self.engine.system;
        if let Some(i) = s.prescribed_by(input) {
            let now = self.engine.speed[s.free + i];
            if (value - now).abs() > 1e-9 * (value.abs() + now.abs()) {
                return Err(InputRefused::Jump { from_rad_s: now, to_rad_s: value });
            }
        }
        self.engine.system.set(input, value)?;
        self.engine.forget_stretches();
        (self.rolling, self.row_is_present) = (false, false);
        Ok(())
    }

    /// The output of that name, which is that of its column.
    ///
    /// # Errors
    /// If there is none, with the nearest name.
    pub fn output(&self, name: &str) -> Result<OutputHandle, Diagnostics> {
        OutputHandle::of(&self.columns, name)
    }

    /// The value of an output at the time reached, in the unit of its column; NaN where it is not determined.
    pub fn read(&mut self, output: OutputHandle) -> f64 {
        if !self.row_is_present {
            self.row();
            self.row_is_present = true;
        }
        output.in_row(&self.row)
    }

    /// The present row, in the order of the columns. The run goes on as if nobody had looked.
    pub fn row(&mut self) -> &[f64] {
        let (t, x) = (self.t, std::mem::take(&mut self.x));
        let mut row = std::mem::take(&mut self.row);
        let found = self.engine.system.laws.as_ref().map(|laws| laws.found());
        self.engine.row(t, &x, &mut row);
        if let (Some(laws), Some(found)) = (&mut self.engine.system.laws, found) {
            laws.recall(found);
        }
        self.x = x;
        self.row = row;
        &self.row
    }

    /// Goes on to a time, s, or to the end of the scenario, whichever comes first. `None` if the scenario is
    /// not at its end.
    pub fn advance(&mut self, until: f64, recorder: &mut dyn Recorder) -> Option<Outcome> {
        if self.outcome.is_some() {
            return self.outcome.clone();
        }
        self.row_is_present = false;
        let recorder = &mut Window::new(self.from, recorder);
        let end = self.engine.system.scenario.end;
        let target = if until.is_nan() { self.t } else { until.min(end) };
        let outcome = loop {
            if !self.rolling
                && let Err(trouble) = self.choose(recorder)
            {
                break Some(trouble);
            }
            let start = self.engine.system.scenario.start;
            if let Some(why) = self.pace.is_too_long([start, self.t, end]) {
                break Some(Outcome::TooLong(why));
            }
            if self.t >= target {
                break (self.t >= end).then_some(Outcome::Finished);
            }
            match self.stretch(target, recorder) {
                Stretch::Again => {}
                Stretch::Reached => break (self.t >= end).then_some(Outcome::Finished),
                Stretch::Ended(outcome) => break Some(outcome),
            }
        };
        if let Some(outcome) = &outcome {
            if *outcome == Outcome::Finished {
                let _ = self.emit_samples(f64::INFINITY, recorder);
            }
            self.outcome = Some(outcome.clone());
        }
        let x = std::mem::take(&mut self.x);
        self.engine.look(self.t, &x);
        self.x = x;
        outcome
    }

    /// Chooses the mode at the present state and tells of the change.
    pub(super) fn choose(&mut self, recorder: &mut dyn Recorder) -> Result<(), Outcome> {
        self.pace.choice();
        self.start_is_known = false;
        self.engine.leave_stretch();
        let end = self.engine.system.scenario.end;
        let inside = self.engine.inside;
        let next = self.engine.system.signals().map(|s| s.next_break(self.t)).fold(f64::INFINITY, f64::min);
        self.segment = next.min(end);
        self.engine.inside = if self.segment > self.t { 0.5 * (self.t + self.segment) } else { self.t };
        let mut x = std::mem::take(&mut self.x);
        let free = self.engine.system.free;
        let ahead = std::mem::replace(&mut self.engine.inside, inside);
        self.engine.look(self.t, &x);
        let before: Vec<f64> = self.engine.speed[free..].to_vec();
        let ratios: Vec<f64> = self.engine.path_states.iter().map(|p| p.ratio).collect();
        self.engine.inside = ahead;
        self.engine.look(self.t, &x);
        let jump = (before.iter().zip(&self.engine.speed[free..]).enumerate())
            .find(|(_, (a, b))| (*a - *b).abs() > 1e-9 * (a.abs() + b.abs()))
            .filter(|_| self.events > 0);
        if let Some((k, (from, to))) = jump {
            let s = &self.engine.system;
            let name = s.train.member_name(s.coordinates[free + k]);
            let why = format!(
                "the speed prescribed for {name} jumps from {} to {} rad/s, which takes an infinite torque; use a ramp",
                short(*from),
                short(*to)
            );
            // What is told is the state before.
            self.engine.inside = inside;
            self.x = x;
            return Err(Outcome::Impact(why));
        }
        if let Some(why) = self.engine.ratio_that_jumps(&ratios).filter(|_| self.events > 0) {
            self.engine.inside = inside;
            self.x = x;
            return Err(Outcome::Impact(why));
        }
        let within = if matches!(self.why, Some(Why::Start)) { AS_WRITTEN } else { ROUND_OFF };
        for (rest, now) in self.at_rest.iter_mut().zip(self.engine.at_rest(within)) {
            *rest |= now;
        }
        if self.hosted && self.rested.0 == self.t {
            self.at_rest.iter_mut().zip(&self.rested.1).for_each(|(rest, before)| *rest |= before);
        }
        let known = AS_WRITTEN.max(10.0 * self.options.tolerance);
        self.engine.rest_where_joined(self.t, known, &mut self.at_rest);
        self.engine.bring_to_rest(&mut x, &mut self.at_rest);
        self.engine.look(self.t, &x);
        if let Some(why) = self.engine.out_of_domain(self.t) {
            self.x = x;
            return Err(Outcome::NotConverged(why));
        }
        self.engine.still = None;
        let at_rest = std::mem::take(&mut self.at_rest);
        if self.hosted {
            self.rested.0 = self.t;
            self.rested.1.clone_from(&at_rest);
        }
        let mut guess = self.engine.mode.clone();
        for (slip, rest) in guess.slip.iter_mut().zip(&at_rest) {
            if *rest {
                *slip = 0;
            }
        }
        if matches!(self.why, Some(Why::Start)) {
            self.engine.settle_paths(self.t, &mut x, &at_rest);
        }
        let touch = self.engine.touch.clone();
        let ends = self.engine.path_ends.clone();
        let mode = match self.engine.choose(self.t, &x, &at_rest, &guess) {
            // Where the drive of a mesh reverses, both sides agree to within what the integrator leaves open: the other
            // one goes on.
            Ok(mut mode) => {
                if let Some(Why::Watch(Watch::Side(j))) = self.why
                    && mode == guess
                    && self.engine.is_between_sides(j)
                {
                    mode.side[j] = mode.side[j].other();
                }
                mode
            }
            Err(Trouble::Several(why, first)) if self.options.continue_when_ambiguous => {
                let (_, times) = self.ambiguous.get_or_insert((format!("at t = {} s {why}", self.t), 0));
                *times += 1;
                first
            }
            Err(trouble) => {
                self.at_rest = at_rest;
                self.x = x;
                return Err(match trouble {
                    Trouble::Impact(why) => Outcome::Impact(why),
                    Trouble::None(why) => Outcome::NoSolution(why),
                    Trouble::NotFound(why) => Outcome::NotConverged(why),
                    Trouble::Several(why, _) => Outcome::SeveralSolutions(why),
                });
            }
        };
        // Just before its limit everything is as it was; what happens is told once, where it does.
        let happened = match self.why {
            Some(Why::Watch(Watch::Side(j))) => mode.side[j] != guess.side[j],
            Some(Why::Watch(Watch::Touch(k))) => self.engine.touch[k] != touch[k],
            Some(Why::Watch(Watch::End(k))) => self.engine.path_ends[k] != ends[k],
            _ => true,
        };
        if !happened {
            self.why = None;
        }
        self.at_rest = mode.slip.iter().map(|s| *s == 0).collect();
        self.engine.enter(&mode);
        self.engine.stand_still(&mode, &mut x);
        self.engine.settle_down(self.segment);
        let labels = self.engine.labels();
        if let Some(event) = event(&self.engine, self.t, self.why.take(), &self.labels, &labels) {
            self.labels = labels;
            self.events += 1;
            let mut flow = ControlFlow::Continue(());
            if self.events > 1 || self.next_sample > 0 {
                flow = tell_row(&mut self.engine, self.t, &x, &mut self.row, recorder);
            }
            if flow.is_break() || recorder.event(&event).is_break() {
                self.x = x;
                return Err(Outcome::Interrupted);
            }
            self.told = event.cause;
        }
        self.longest = f64::INFINITY;
        self.look_ahead();
        let tolerance = self.options.tolerance;
        let (t, segment, hint) = (self.t, self.segment, self.last_step);
        if segment > t {
            if self.stiff {
                self.implicit.restart(&mut self.engine, t, &x, tolerance, segment, hint);
            } else {
                self.explicit.restart(&mut self.engine, t, &x, tolerance, segment, hint);
            }
        }
        self.x = x;
        self.rolling = true;
        Ok(())
    }

    /// How far the next step sees what the signals do, at most twice as far as the last one.
    fn look_ahead(&mut self) {
        let engine = &self.engine;
        let s = &engine.system;
        let most = ((s.scenario.end - s.scenario.start) / LOOKS).min(2.0 * self.longest);
        let speed = |m| engine.member_speed(m);
        let each = s.signals().map(|signal| signal.longest_step(self.t, engine.inside, most, &speed));
        self.longest = each.fold(f64::INFINITY, f64::min);
    }

    /// Steps until something happens.
    fn stretch(&mut self, target: f64, recorder: &mut dyn Recorder) -> Stretch {
        let waves = self.engine.system.signals().any(|s| s.waves());
        loop {
            if waves {
                self.engine.look(self.t, &self.x);
                self.look_ahead();
            }
            let horizon = self.engine.warming.as_ref().map_or(f64::INFINITY, |w| w.horizon() - self.t);
            let longest = self.longest.min(horizon);
            // What is left of a stretch is not tiny.
            let goal = self.t + longest;
            let goal = if goal + 0.01 * longest < self.segment { goal } else { self.segment };
            let taken = if self.stiff {
                self.implicit.step(&mut self.engine, goal)
            } else {
                self.explicit.step(&mut self.engine, goal)
            };
            if let Err(error) = taken {
                if !self.stiff && matches!(error, StepError::StepTooSmall) {
                    self.stiff = true;
                    self.rolling = false;
                    return Stretch::Again;
                }
                let formula =
                    if matches!(error, StepError::NotFinite) { self.out_of_domain_before(goal) } else { None };
                return Stretch::Ended(Outcome::NotConverged(match error {
                    StepError::NotFinite if formula.is_some() => formula.unwrap_or_default(),
                    StepError::NotFinite if !self.engine.agrees => {
                        format!(
                            "at t = {} s losses and forces do not agree: friction grows with the force it causes",
                            self.t
                        )
                    }
                    StepError::NotFinite => format!(
                        "accelerations are not finite at t = {} s: the equations lose their unique solution",
                        self.t
                    ),
                    _ => format!("at t = {} s the tolerance cannot be kept with any step", self.t),
                }));
            }
            self.steps += 1;
            self.pace.step();
            let (t_old, t_new) = self.span();
            self.last_step = Some(t_new - t_old);
            // One beyond the time asked for is found again when it is reached.
            let found = self.find_event(t_old, t_new).filter(|(t, _)| *t <= target);
            if let Some((t, watch)) = found {
                if let ControlFlow::Break(last) = self.emit_samples(t, recorder) {
                    return self.stop(last);
                }
                self.shorten(t);
                return self.event(t, watch, recorder);
            }
            if t_new >= target && target < self.segment {
                // Stop inside the step; what lies beyond is stepped again.
                if let ControlFlow::Break(last) = self.emit_samples(target, recorder) {
                    return self.stop(last);
                }
                self.shorten(target);
                self.take_state(target);
                self.rolling = false;
                self.why = None;
                return match self.engine.follow_heat(self.t, &self.x) {
                    Ok(_) => Stretch::Reached,
                    Err(why) => Stretch::Ended(Outcome::NotConverged(why)),
                };
            }
            if let ControlFlow::Break(last) = self.emit_samples(t_new, recorder) {
                return self.stop(last);
            }
            self.take_state(t_new);
            if recorder.progress(self.t).is_break() {
                return Stretch::Ended(Outcome::Interrupted);
            }
            let whole = &self.engine.system.scenario;
            if let Some(why) = self.pace.is_too_long([whole.start, self.t, whole.end]) {
                return Stretch::Ended(Outcome::TooLong(why));
            }
            if !self.engine.certified && !self.still_single() {
                return Stretch::Again;
            }
            match self.engine.follow_heat(self.t, &self.x) {
                // The laws are others than those that the integrator begins its next step with.
                Ok(true) if self.t < self.segment => {
                    (self.rolling, self.why) = (false, None);
                    return Stretch::Again;
                }
                Ok(_) => {}
                Err(why) => return Stretch::Ended(Outcome::NotConverged(why)),
            }
            if self.t >= self.segment {
                self.rolling = false;
                self.why = Some(Why::Input);
                return if self.t >= target { Stretch::Reached } else { self.before_break(recorder) };
            }
            if !self.stiff && self.explicit.is_stiff() {
                self.stiff = true;
                self.rolling = false;
                self.why = None;
                self.last_step = None;
                return Stretch::Again;
            }
        }
    }

    /// A formula that leaves its domain at the present state, or soonest after it, in words.
    fn out_of_domain_before(&mut self, goal: f64) -> Option<String> {
        /// Times that are looked at, each twice as far ahead as the one before.
        const LOOKS: i32 = 50;
        let x = std::mem::take(&mut self.x);
        self.engine.look(self.t, &x);
        self.x = x;
        let ahead = (0..=LOOKS).rev().map(|k| self.t + (goal - self.t) * 0.5f64.powi(k));
        std::iter::once(self.t).chain(ahead).find_map(|t| self.engine.out_of_domain(t))
    }

    /// Without a certificate: whether the present solution is the only one. If not, the mode is chosen anew,
    /// which says so.
    fn still_single(&mut self) -> bool {
        if self.options.continue_when_ambiguous {
            return true;
        }
        let x = std::mem::take(&mut self.x);
        self.engine.solve(self.t, &x);
        let single = self.engine.is_single(self.t);
        self.x = x;
        if !single {
            self.rolling = false;
            self.why = None;
        }
        single
    }

    fn before_break(&mut self, recorder: &mut dyn Recorder) -> Stretch {
        // The row before a jump of the inputs.
        match tell_row(&mut self.engine, self.t, &self.x, &mut self.row, recorder) {
            ControlFlow::Break(()) => Stretch::Ended(Outcome::Interrupted),
            ControlFlow::Continue(()) => Stretch::Again,
        }
    }

    fn span(&self) -> (f64, f64) {
        if self.stiff { (self.implicit.t_old(), self.implicit.t()) } else { (self.explicit.t_old(), self.explicit.t()) }
    }

    fn shorten(&mut self, t: f64) {
        if self.stiff {
            self.implicit.shorten(&mut self.engine, t);
        } else {
            self.explicit.shorten(&mut self.engine, t);
        }
    }

    /// The end where the recorder wants no more, within the last step.
    fn stop(&mut self, t: f64) -> Stretch {
        if t > self.t {
            self.shorten(t);
            self.take_state(t);
        }
        Stretch::Ended(Outcome::Interrupted)
    }

    fn take_state(&mut self, t: f64) {
        let states = self.engine.states();
        if self.stiff {
            take_in(&self.implicit, states, &mut self.came_in);
            self.x.copy_from_slice(self.implicit.x());
        } else {
            take_in(&self.explicit, states, &mut self.came_in);
            self.x.copy_from_slice(self.explicit.x());
        }
        self.engine.rescale(&self.x);
        self.t = t;
        if !self.engine.system.paths.is_empty() {
            let x = std::mem::take(&mut self.x);
            self.engine.solve(t, &x);
            self.engine.note_limits(t, &x);
            self.x = x;
        }
    }

    fn interpolate(&mut self, t: f64) {
        if self.stiff {
            self.implicit.interpolate(t, &mut self.state);
        } else {
            self.explicit.interpolate(t, &mut self.state);
        }
    }

    fn event(&mut self, t: f64, watch: Watch, recorder: &mut dyn Recorder) -> Stretch {
        self.take_state(t);
        self.rolling = false;
        self.why = Some(Why::Watch(watch));
        if let Watch::Slip(g) = watch {
            self.at_rest[g] = true;
        }
        let s = &self.engine.system;
        // Bounded in time, and in number where time stands still.
        let window = (s.scenario.end - s.scenario.start) / 1000.0;
        self.recent.push_back(t);
        while self.recent.front().is_some_and(|f| *f < t - window) {
            self.recent.pop_front();
        }
        let still = self.recent.iter().rev().take_while(|e| t - **e <= 1e-13 * t.abs().max(window)).count();
        if self.recent.len() > self.options.most_events || still > 50 {
            return Stretch::Ended(Outcome::TooManyEvents(format!(
                "{} changes of mode within {:.3e} s before t = {t} s; the last: {}",
                self.recent.len(),
                t - self.recent[0],
                self.told,
            )));
        }
        if matches!(watch, Watch::Side(_)) {
            return if recorder.progress(t).is_break() { Stretch::Ended(Outcome::Interrupted) } else { Stretch::Again };
        }
        self.before_break(recorder)
    }

    fn sample_time(&self, k: usize) -> f64 {
        let (from, end) = (self.from, self.engine.system.scenario.end);
        if k + 1 == self.samples { end } else { from + (end - from) * k as f64 / (self.samples - 1) as f64 }
    }

    /// Rows of the grid up to a time in the last step; breaks with the time of the last one that was wanted.
    fn emit_samples(&mut self, until: f64, recorder: &mut dyn Recorder) -> ControlFlow<f64> {
        while self.next_sample < self.samples {
            let t = self.sample_time(self.next_sample);
            if t > until || (until.is_infinite() && t > self.t) {
                break;
            }
            self.next_sample += 1;
            let here = t <= self.t || until.is_infinite();
            if !here {
                self.interpolate(t);
            }
            let x = if here { &self.x } else { &self.state };
            if tell_row(&mut self.engine, t, x, &mut self.row, recorder).is_break() {
                return ControlFlow::Break(t);
            }
        }
        ControlFlow::Continue(())
    }

    /// Whether a row is due at the end of a step of length `h`, at `t`; rows of the grid up to there count as one.
    pub(super) fn is_row_due(&mut self, t: f64, h: f64) -> bool {
        let before = self.next_sample;
        while t >= self.next_row(h) {
            self.next_sample += 1;
        }
        self.next_sample > before
    }

    /// From when on a row is due in steps of length `h`.
    pub(super) fn next_row(&self, h: f64) -> f64 {
        if self.next_sample < self.samples { self.sample_time(self.next_sample) - 0.5 * h } else { f64::INFINITY }
    }

    /// What there is to say about the run so far.
    pub fn report(&self) -> RunReport {
        let s = &self.engine.system;
        let states = self.engine.states();
        let final_speeds = (s.train.members().iter().enumerate().skip(1))
            .map(|(m, member)| (member.name.clone(), self.engine.member_speed(MemberId(m))))
            .filter(|(_, speed)| speed.is_finite());
        let mut notes = self.notes.clone();
        if self.engine.unproved > 0 {
            notes.push(format!(
                "{} times it was not proved that the motion taken is the only one: too many things were at rest to search for \
                 others",
                self.engine.unproved
            ));
        }
        if let Some((why, times)) = &self.ambiguous {
            let again = if *times > 1 { format!("; so {} times more", times - 1) } else { String::new() };
            notes.push(format!("{why}; the first was taken{again}"));
        }
        if self.stiff {
            notes.push("stiff: an implicit integrator was used".into());
        }
        for (machine, t) in &self.engine.left_maps {
            notes.push(format!(
                "{machine} runs outside the map of its efficiency, at {} s for the first time; the value at its edge was taken",
                short(*t)
            ));
        }
        for (machine, t) in &self.engine.fell_short {
            notes.push(format!(
                "{machine} balances its bus and comes to its limit of torque, at {} s for the first time: below the speed at which \
                 that would be passed its torque falls with the speed, and the store gives or takes the rest",
                short(*t)
            ));
        }
        RunReport {
            format: Format::new(),
            train: s.train.name().to_owned(),
            scenario: s.scenario.name.clone(),
            outcome: self.outcome.clone().unwrap_or(Outcome::Interrupted),
            start_s: s.scenario.start,
            from_s: self.options.from_s,
            end_s: self.t,
            coordinates: s.coordinates.iter().map(|m| s.train.member_name(*m).to_owned()).collect(),
            unique_for_every_load: self.engine.certified,
            steps: self.steps,
            events: vec![],
            final_speeds_rad_s: final_speeds.collect(),
            energy: self.engine.energy_report(
                [self.stored_at_start, self.engine.stored(&self.x)],
                &self.x[states..],
                &self.came_in,
            ),
            heat: self.engine.warming.as_ref().and_then(|w| w.report(self.t, &self.x[states..])),
            beyond_limits: self.engine.beyond.clone(),
            assumptions: s.assumptions.clone(),
            notes,
            scenario_end_s: s.scenario.end,
            event_count: self.events,
            columns: None,
            rows: None,
        }
    }
}

/// Whether temperatures follow what is lost, which must be counted for that.
fn warms(options: &Options) -> bool {
    options.method == Method::Adaptive && options.energies
}

/// Lets temperatures follow what is lost.
fn warm(engine: &mut Engine) -> Result<(), Diagnostics> {
    engine.warm().map_err(|why| {
        Diagnostic::new(Code::Unfit, "heat", format!("at the temperature of the oil {why}"))
            .hint("what is made at each place of [heat] needs a way to the air around it")
            .into()
    })
}

/// What there is to know where no certificate says that the forces are unique.
fn uniqueness(engine: &Engine, method: Method) -> Option<String> {
    let what = match engine.certificate {
        Some(true) => return None,
        Some(false) => "there may be several motions, or none, in some states of this train",
        None => {
            return Some("too many meshes and friction elements for a certificate that the motion is unique".into());
        }
    };
    let done = match method {
        Method::Adaptive => "every change of mode was searched for all of them",
        Method::Fixed { .. } => {
            "steps of fixed length go on with what they find first, and do not notice where there is none"
        }
    };
    Some(format!("{what}: {done}"))
}

/// Hands a row to a recorder that wants it.
pub(super) fn tell_row(
    engine: &mut Engine,
    t: f64,
    x: &[f64],
    row: &mut Vec<f64>,
    recorder: &mut dyn Recorder,
) -> ControlFlow<()> {
    if !recorder.wants_row(t) {
        return ControlFlow::Continue(());
    }
    engine.row(t, x, row);
    recorder.sample(Sample { time_s: t, values: row })
}

/// Adds what the sources put in during the last step. A power that changes its sign is parted where it does.
fn take_in(stepper: &impl Stepper, states: usize, came_in: &mut [f64]) {
    let (t_old, t) = (stepper.t_old(), stepper.t());
    for (k, sum) in came_in.iter_mut().enumerate() {
        let at = states + k;
        let (from, to) = (stepper.x_old()[at], stepper.x()[at]);
        let (first, last) = (stepper.rate_old()[at], stepper.rate()[at]);
        if first * last >= 0.0 {
            *sum += (to - from).max(0.0);
            continue;
        }
        // The work has an extreme within the step: golden sections.
        const RATIO: f64 = 0.618_033_988_749_894_8;
        let value = |t: f64| {
            if first > 0.0 { stepper.interpolate_component(t, at) } else { -stepper.interpolate_component(t, at) }
        };
        let (mut low, mut high) = (t_old, t);
        for _ in 0..40 {
            let (a, b) = (high - RATIO * (high - low), low + RATIO * (high - low));
            if value(a) < value(b) { low = a } else { high = b }
        }
        let turn = stepper.interpolate_component(0.5 * (low + high), at);
        *sum += (turn - from).max(0.0) + (to - turn).max(0.0);
    }
}
