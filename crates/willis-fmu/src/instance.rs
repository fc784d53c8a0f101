//! A run in the hands of a host: what may be called when, values by reference, steps, events.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use willis::diagnostic::Diagnostics;
use willis::dynamics::{InputHandle, Outcome, OutputHandle, Simulation};
use willis::model::Model;

use crate::layout::{Interface, Kind, Layout, Role, TOLERANCE, Value, Variable, options, verdict, written};
use crate::resources::{Resources, order};

/// How a call ended, by the numbers of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    Ok = 0,
    Discard = 2,
    Error = 3,
}

/// Why a call did not do what was asked, and what to do.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fail {
    pub status: Status,
    pub why: String,
}

/// An error of the host: nothing was done.
pub(crate) fn error(why: impl Into<String>) -> Fail {
    Fail { status: Status::Error, why: why.into() }
}

fn told(wrong: &Diagnostics) -> String {
    let all: Vec<String> = wrong
        .iter()
        .map(|d| {
            let place = if d.place.is_empty() { String::new() } else { format!("{}: ", d.place) };
            let hints: String = d.hints.iter().map(|h| format!("; {h}")).collect();
            format!("{place}{}{hints}", d.message)
        })
        .collect();
    all.join(". ")
}

/// Where an instance stands in the order that the standard prescribes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    Instantiated,
    Initialization,
    Step,
    Event,
    Continuous,
    Terminated,
}

/// What a host gave an input.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Given {
    pub value: Option<f64>,
    pub rate: f64,
    /// A prescribed speed that is to be reached with the next step.
    pub pending: bool,
}

/// What a step came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stepped {
    pub time: f64,
    /// Whether it ended before its time because the mode changed.
    pub early: bool,
    /// Whether there is no motion to go on with.
    pub ended: bool,
}

/// What comes after an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Settled {
    pub states_changed: bool,
    pub next: Option<f64>,
    /// Whether there is no motion to go on with.
    pub over: bool,
}

/// All that an instance is, but for whom it tells of it. A clone is its state.
#[derive(Clone)]
pub(crate) struct Instance {
    pub layout: Arc<Layout>,
    model: Arc<Model>,
    scenario: Arc<str>,
    pub token: Arc<str>,
    pub interface: Interface,
    /// Whether the host wants to be told of events in co-simulation, by steps that end early.
    stops_at_events: bool,
    /// Whether it may end steps early for that.
    pub returns_early: bool,
    pub phase: Phase,
    /// Parameters that were set, by reference.
    pub changed: BTreeMap<usize, Value>,
    pub inputs: Vec<Given>,
    /// Time of the host less that of the scenario, s.
    pub offset: f64,
    pub run: Option<Simulation>,
    handles: Vec<InputHandle>,
    outputs: Vec<OutputHandle>,
    losses: Vec<f64>,
    losses_at: Option<f64>,
    /// What is to be told, by category.
    pub news: Vec<(&'static str, String)>,
    told_events: usize,
    told_end: bool,
}

/// Where a host that integrates sets time and states.
const IN_MOTION: [Phase; 3] = [Phase::Initialization, Phase::Event, Phase::Continuous];
/// Where it reads states and what follows from them.
const WITH_STATES: [Phase; 4] = [Phase::Initialization, Phase::Event, Phase::Continuous, Phase::Terminated];
/// Where it reads what does not depend on them.
const ALWAYS: [Phase; 5] =
    [Phase::Instantiated, Phase::Initialization, Phase::Event, Phase::Continuous, Phase::Terminated];

/// Work of a derivative: relative step of a central difference, before it is halved once.
const PART: f64 = 1e-3;

impl Instance {
    /// An instance of the unit whose resources are in a folder.
    ///
    /// # Errors
    /// What is wrong with them, or why they are not those of the host's description.
    pub fn new(folder: &Path, token: &str, exchanges: bool, stops_at_events: bool) -> Result<Self, Fail> {
        let resources = Resources::read(folder).map_err(error)?;
        let index = &resources.index;
        if token != index.token {
            return Err(error(format!(
                "the model description has the token {token} and the unit {}: they do not belong together",
                index.token
            )));
        }
        let interface = index.interface();
        let offered = if exchanges { interface.exchanges() } else { interface.steps() };
        if !offered {
            let [wanted, has] =
                if exchanges { ["model exchange", "co-simulation"] } else { ["co-simulation", "model exchange"] };
            return Err(error(format!("the unit was exported for {has}; export it for {wanted}")));
        }
        let model = resources.model().map_err(|wrong| error(told(&wrong)))?;
        let layout = Layout::of(&model, &index.scenario, interface).map_err(|wrong| error(told(&wrong)))?;
        // References are places in the list of variables, which this runtime made anew.
        if order(&layout) != index.variables {
            return Err(error(
                "the runtime has other variables than the description; build willis-fmu of the same version and export anew",
            ));
        }
        Ok(Self {
            inputs: vec![Given::default(); layout.inputs.len()],
            layout: Arc::new(layout),
            model: Arc::new(model),
            scenario: index.scenario.as_str().into(),
            token: index.token.as_str().into(),
            interface: if exchanges { Interface::ModelExchange } else { Interface::CoSimulation },
            stops_at_events,
            returns_early: false,
            phase: Phase::Instantiated,
            changed: BTreeMap::new(),
            offset: 0.0,
            run: None,
            handles: vec![],
            outputs: vec![],
            losses: vec![],
            losses_at: None,
            news: vec![],
            told_events: 0,
            told_end: false,
        })
    }

    /// As if it were new.
    pub fn reset(&mut self) {
        self.phase = Phase::Instantiated;
        self.changed.clear();
        self.inputs.fill(Given::default());
        self.offset = 0.0;
        (self.run, self.losses_at, self.told_events, self.told_end) = (None, None, 0, false);
    }

    /// Whether the host integrates.
    pub fn exchanges(&self) -> bool {
        self.interface == Interface::ModelExchange
    }

    /// Refuses what is not allowed where the instance stands.
    pub fn expect(&self, what: &str, phases: &[Phase]) -> Result<(), Fail> {
        if phases.contains(&self.phase) {
            return Ok(());
        }
        let name = |phase: &Phase| match phase {
            Phase::Instantiated => "before initialization",
            Phase::Initialization => "in initialization",
            Phase::Step => "between steps",
            Phase::Event => "in event mode",
            Phase::Continuous => "in continuous-time mode",
            Phase::Terminated => "after the end",
        };
        let allowed: Vec<&str> = phases.iter().map(name).collect();
        Err(error(format!("{what} is not allowed {}; it is allowed {}", name(&self.phase), allowed.join(", "))))
    }

    fn variable(&self, reference: u32) -> Result<(usize, &Variable), Fail> {
        let place = reference as usize;
        let variable = self.layout.variables.get(place);
        variable.map(|v| (place, v)).ok_or_else(|| {
            error(format!(
                "there is no variable with the reference {reference}; there are {}",
                self.layout.variables.len()
            ))
        })
    }

    pub fn enter_initialization(&mut self, start: f64, tolerance: Option<f64>) -> Result<(), Fail> {
        self.expect("initialization", &[Phase::Instantiated])?;
        if !start.is_finite() {
            return Err(error(format!("an experiment cannot start at {start} s")));
        }
        if let Some(tolerance) = tolerance.filter(|_| !self.exchanges())
            && let Some(place) = self.layout.places(|r| *r == Role::Tolerance).first()
            && !self.changed.contains_key(place)
            // A host's tolerance is for the whole; ours is never worse than what changes of mode need.
            && tolerance > 0.0
            && tolerance < TOLERANCE
        {
            self.changed.insert(*place, Value::Real(tolerance.max(1e-13)));
        }
        // The scenario begins when the experiment does.
        self.offset = start - self.layout.span[0];
        self.run = None;
        self.phase = Phase::Initialization;
        Ok(())
    }

    pub fn exit_initialization(&mut self) -> Result<(), Fail> {
        self.expect("the end of initialization", &[Phase::Initialization])?;
        self.ready()?;
        self.phase = if self.exchanges() || self.stops_at_events { Phase::Event } else { Phase::Step };
        self.tell_events();
        self.tell_end();
        Ok(())
    }

    pub fn terminate(&mut self) -> Result<(), Fail> {
        self.expect("the end", &[Phase::Step, Phase::Event, Phase::Continuous])?;
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// Makes the run with the parameters and inputs that are set, and brings it to its start.
    pub fn ready(&mut self) -> Result<&mut Simulation, Fail> {
        if self.run.is_none() {
            let run = self.fresh()?;
            self.run = Some(run);
        }
        self.run.as_mut().ok_or_else(|| error("there is no run"))
    }

    /// A run at its start.
    fn fresh(&mut self) -> Result<Simulation, Fail> {
        let wrong = |wrong: Diagnostics| error(told(&wrong));
        let mut tolerance = TOLERANCE;
        let mut settings = vec![];
        for (&place, value) in &self.changed {
            let variable = &self.layout.variables[place];
            match (&variable.role, value) {
                (Role::Tolerance, Value::Real(x)) => tolerance = *x,
                (Role::Parameter(path), value) if variable.start.as_ref() != Some(value) => {
                    settings.push((path.clone(), written(value, variable.kind)));
                }
                _ => {}
            }
        }
        let changed;
        let model = if settings.is_empty() {
            &*self.model
        } else {
            changed = self.model.with(settings).map_err(wrong)?;
            &changed
        };
        let options = options(tolerance, !self.exchanges());
        let run = Simulation::new(model.train(), &self.scenario, &options).map_err(wrong)?;
        if !self.layout.fits(&run) {
            return Err(error(
                "with these parameters the train has other inputs, outputs or states than the unit was exported with; export it \
                 anew with them",
            ));
        }
        self.handles = run.inputs().iter().map(|i| i.input).collect();
        let outputs: Result<Vec<OutputHandle>, Diagnostics> =
            self.layout.columns.iter().map(|c| run.output(c)).collect();
        self.outputs = outputs.map_err(wrong)?;
        let given: Vec<(InputHandle, f64)> =
            self.handles.iter().zip(&self.inputs).filter_map(|(h, given)| Some((*h, given.value?))).collect();
        let mut run = run.again_with(&given).map_err(wrong)?;
        self.inputs.iter_mut().for_each(|given| given.pending = false);
        (self.losses_at, self.told_end) = (None, false);
        if self.exchanges() {
            self.turn_speeds(&mut run)?;
            // Why it does not go on is an output.
            let _ = run.settle();
        } else {
            let start = run.time();
            let _ = run.go_on(start);
        }
        Ok(run)
    }

    /// Prescribed speeds with their rates.
    fn turn_speeds(&self, run: &mut Simulation) -> Result<(), Fail> {
        for (k, given) in self.inputs.iter().enumerate() {
            if let (Some(value), true) = (given.value, self.layout.inputs[k].1) {
                run.set_moving(self.handles[k], value, given.rate).map_err(|e| error(e.to_string()))?;
            }
        }
        Ok(())
    }

    /// Changes of mode since the last call become news.
    fn tell_events(&mut self) {
        let Some(run) = &self.run else { return };
        if run.event_count() != self.told_events {
            self.told_events = run.event_count();
            self.news.push(("logEvents", format!("at {} s: {}", run.time() + self.offset, run.last_event())));
        }
    }

    /// That there is no motion to go on with becomes news, once. Whether it is so.
    fn tell_end(&mut self) -> bool {
        let Some(outcome) = self.run.as_ref().and_then(Simulation::outcome) else { return false };
        if !self.told_end {
            self.told_end = true;
            self.news.push(("logStatusWarning", in_words(outcome)));
        }
        true
    }

    /// A value that is a number.
    pub fn real(&mut self, reference: u32) -> Result<f64, Fail> {
        let (place, variable) = self.variable(reference)?;
        let (role, kind, start) = (variable.role.clone(), variable.kind, variable.start.clone());
        if !matches!(kind, Kind::Real(_)) {
            return Err(self.of_another_kind(reference, "a real number"));
        }
        match role {
            Role::Input(k) if self.inputs[k].pending || self.run.is_none() => {
                let of_start = if let Some(Value::Real(x)) = start { x } else { 0.0 };
                return Ok(self.inputs[k].value.unwrap_or(of_start));
            }
            Role::InputRate(k) => return Ok(self.inputs[k].rate),
            Role::Parameter(_) | Role::Tolerance => {
                return match self.changed.get(&place).or(start.as_ref()) {
                    Some(Value::Real(x)) => Ok(*x),
                    _ => Err(error("a parameter without a value")),
                };
            }
            _ => {}
        }
        self.computed()?;
        self.ready()?;
        let offset = self.offset;
        let outputs = if let Role::Output(k) = role { self.outputs.get(k).copied() } else { None };
        let handle = if let Role::Input(k) = role { self.handles.get(k).copied() } else { None };
        let run = self.ready()?;
        match (role, outputs, handle) {
            (Role::Time, ..) => Ok(run.time() + offset),
            (Role::Input(_), _, Some(handle)) => Ok(run.worth(handle)),
            (Role::Output(_), Some(output), _) => Ok(run.read(output)),
            (Role::State(k), ..) => run.state().get(k).copied().ok_or_else(|| error("no such state")),
            (Role::Rate(k), ..) => {
                let mut rates = vec![0.0; run.state().len()];
                run.rates(&mut rates);
                rates.get(k).copied().ok_or_else(|| error("no such state"))
            }
            (Role::Indicator(k), ..) => {
                let mut all = vec![0.0; run.indicator_count()];
                run.indicators(&mut all);
                all.get(k).copied().ok_or_else(|| error("no such indicator"))
            }
            (Role::Loss(k), ..) => self.loss(k),
            _ => Err(error("this variable has no value")),
        }
    }

    fn loss(&mut self, k: usize) -> Result<f64, Fail> {
        let mut losses = std::mem::take(&mut self.losses);
        let known = self.losses_at;
        let run = self.ready()?;
        let now = run.time();
        if known != Some(now) {
            run.losses(&mut losses);
        }
        (self.losses, self.losses_at) = (losses, Some(now));
        self.losses.get(k).copied().ok_or_else(|| error("no such loss"))
    }

    /// What follows from the run is there from initialization on.
    fn computed(&self) -> Result<(), Fail> {
        let all = [Phase::Initialization, Phase::Step, Phase::Event, Phase::Continuous, Phase::Terminated];
        self.expect("reading a result", &all)
    }

    fn of_another_kind(&self, reference: u32, wanted: &str) -> Fail {
        match self.variable(reference) {
            Ok((_, variable)) => error(format!("the variable `{}` is not {wanted}", variable.name)),
            Err(fail) => fail,
        }
    }

    /// A value that is a whole number.
    pub fn integer(&mut self, reference: u32) -> Result<i64, Fail> {
        let (place, variable) = self.variable(reference)?;
        let (role, kind) = (variable.role.clone(), variable.kind);
        if let (Role::Parameter(_), Kind::Integer) = (&role, kind) {
            return match self.changed.get(&place).or(variable.start.as_ref()) {
                Some(Value::Integer(x)) => Ok(*x),
                _ => Err(error("a parameter without a value")),
            };
        }
        if !matches!(kind, Kind::Integer | Kind::Mode | Kind::Verdict) {
            return Err(self.of_another_kind(reference, "a whole number"));
        }
        self.computed()?;
        self.ready()?;
        let output = if let Role::Output(k) = role { self.outputs.get(k).copied() } else { None };
        let run = self.ready()?;
        match (role, output) {
            (Role::Output(_), Some(output)) => Ok(run.read(output) as i64),
            (Role::Verdict, _) => Ok(verdict(run.outcome())),
            (Role::Events, _) => Ok(run.event_count() as i64),
            _ => Err(error("this variable has no value")),
        }
    }

    /// A value that is a text.
    pub fn text(&mut self, reference: u32) -> Result<String, Fail> {
        let (_, variable) = self.variable(reference)?;
        let (role, kind) = (variable.role.clone(), variable.kind);
        if kind != Kind::Text {
            return Err(self.of_another_kind(reference, "a text"));
        }
        self.computed()?;
        let run = self.ready()?;
        match role {
            Role::Why => Ok(run.outcome().map_or(String::new(), |o| o.why().to_owned())),
            Role::LastEvent => Ok(run.last_event().to_owned()),
            _ => Err(error("this variable has no value")),
        }
    }

    /// Sets an input or a parameter.
    pub fn set(&mut self, reference: u32, value: &Value) -> Result<(), Fail> {
        let (place, variable) = self.variable(reference)?;
        let (name, role, kind) = (variable.name.clone(), variable.role.clone(), variable.kind);
        match (kind, value) {
            (Kind::Real(_), Value::Real(x)) if !x.is_finite() => {
                return Err(error(format!("`{name}` cannot be {x}; it takes a finite number")));
            }
            (Kind::Real(_), Value::Real(_)) | (Kind::Integer, Value::Integer(_)) => {}
            (Kind::Mode | Kind::Verdict | Kind::Text, _) => {
                return Err(error(format!("`{name}` is a result and cannot be set")));
            }
            _ => return Err(self.of_another_kind(reference, "of the kind that is set")),
        }
        let early = [Phase::Instantiated, Phase::Initialization];
        match (role, value) {
            (Role::Parameter(_) | Role::Tolerance, value) => {
                self.expect(&format!("setting the parameter `{name}`"), &early)?;
                if let (Role::Tolerance, Value::Real(x)) = (&self.layout.variables[place].role, value)
                    && !(1e-13..=1e-2).contains(x)
                {
                    return Err(error(format!("a tolerance of {x} cannot be kept; from 1e-13 to 1e-2")));
                }
                self.changed.insert(place, value.clone());
                self.run = None;
                Ok(())
            }
            (Role::Input(k), Value::Real(x)) => self.set_input(k, &name, Some(*x), None),
            (Role::InputRate(k), Value::Real(x)) => self.set_input(k, &name, None, Some(*x)),
            _ => Err(error(format!("`{name}` is a result and cannot be set"))),
        }
    }

    fn set_input(&mut self, k: usize, name: &str, value: Option<f64>, rate: Option<f64>) -> Result<(), Fail> {
        let all = [Phase::Instantiated, Phase::Initialization, Phase::Step, Phase::Event, Phase::Continuous];
        self.expect(&format!("setting `{name}`"), &all)?;
        self.losses_at = None;
        let is_speed = self.layout.inputs[k].1;
        if matches!(self.phase, Phase::Instantiated | Phase::Initialization) {
            self.inputs[k].value = value.or(self.inputs[k].value);
            self.inputs[k].rate = rate.unwrap_or(self.inputs[k].rate);
            self.run = None;
            return Ok(());
        }
        let exchanges = self.exchanges();
        let handle = self.handles[k];
        let mut given = self.inputs[k];
        given.rate = rate.unwrap_or(given.rate);
        let run = self.ready()?;
        let done = match (is_speed, exchanges) {
            (true, true) => {
                let value = value.or(given.value).unwrap_or_else(|| run.worth(handle));
                given.value = Some(value);
                run.set_moving(handle, value, given.rate)
            }
            (true, false) => {
                given.value = value.or(given.value);
                given.pending = true;
                Ok(())
            }
            (false, _) => {
                let value = value.unwrap_or_default();
                // A host sets every input before every step; what stays the same is no change.
                let same = given.value == Some(value);
                given.value = Some(value);
                if same { Ok(()) } else { run.set(handle, value) }
            }
        };
        done.map_err(|e| error(format!("`{name}`: {e}")))?;
        self.inputs[k] = given;
        Ok(())
    }

    /// A step of co-simulation.
    pub fn step(&mut self, time: f64, length: f64) -> Result<Stepped, Fail> {
        self.expect("a step", &[Phase::Step])?;
        if !(length.is_finite() && length > 0.0) {
            return Err(error(format!("a step of {length} s leads nowhere; it takes a time above zero")));
        }
        let (offset, stops) = (self.offset, self.stops_at_events && self.returns_early);
        let now = self.ready()?.time() + offset;
        // Times are sums of steps.
        if time.is_nan() || (time - now).abs() > 1e-6 * length + 1e-9 * now.abs() {
            return Err(error(format!("a step from {time} s is asked for, and the run stands at {now} s")));
        }
        let until = time + length - offset;
        let moving: Vec<(InputHandle, f64)> = (self.handles.iter().zip(&self.inputs))
            .filter_map(|(h, given)| Some((*h, given.value.filter(|_| given.pending)?)))
            .collect();
        let run = self.ready()?;
        let steady = run.outcome().is_none();
        for (handle, value) in moving.into_iter().filter(|_| steady) {
            run.lead(handle, value, until).map_err(|e| error(e.to_string()))?;
        }
        let outcome = if stops { run.go_on_to_event(until) } else { run.go_on(until) };
        let reached = run.time();
        let early = stops && outcome.is_none() && reached < until;
        // What was not reached is led there once more.
        self.inputs.iter_mut().for_each(|given| given.pending &= early);
        self.losses_at = None;
        self.tell_events();
        let ended = self.tell_end();
        Ok(Stepped { time: reached + offset, early, ended })
    }

    pub fn enter_event_mode(&mut self) -> Result<(), Fail> {
        let from = if self.exchanges() { Phase::Continuous } else { Phase::Step };
        if !self.exchanges() && !self.stops_at_events {
            return Err(error("the unit was not told at its instantiation that event mode is used"));
        }
        self.expect("event mode", &[from])?;
        self.phase = Phase::Event;
        Ok(())
    }

    pub fn enter_continuous_time_mode(&mut self) -> Result<(), Fail> {
        if !self.exchanges() {
            return Err(error("continuous-time mode belongs to model exchange"));
        }
        self.expect("continuous-time mode", &[Phase::Event])?;
        self.phase = Phase::Continuous;
        Ok(())
    }

    pub fn enter_step_mode(&mut self) -> Result<(), Fail> {
        if self.exchanges() {
            return Err(error("step mode belongs to co-simulation"));
        }
        self.expect("step mode", &[Phase::Event])?;
        self.phase = Phase::Step;
        Ok(())
    }

    /// The mode after an event.
    pub fn settle(&mut self) -> Result<Settled, Fail> {
        self.expect("an event", &[Phase::Event])?;
        let (offset, exchanges) = (self.offset, self.exchanges());
        self.losses_at = None;
        let run = self.ready()?;
        let (mut states_changed, mut next) = (false, None);
        if exchanges {
            // Why it does not go on is an output.
            states_changed = run.settle().unwrap_or(false);
            next = Some(run.next_break() + offset).filter(|t| t.is_finite());
        } else if run.outcome().is_none() {
            // Inputs act at the time at which they were set.
            let now = run.time();
            let _ = run.go_on(now);
        }
        self.tell_events();
        let over = self.tell_end();
        Ok(Settled { states_changed, next: next.filter(|_| !over), over })
    }

    fn exchanging(&self, what: &str, phases: &[Phase]) -> Result<(), Fail> {
        if !self.exchanges() {
            return Err(error(format!("{what} belongs to model exchange")));
        }
        self.expect(what, phases)
    }

    pub fn set_time(&mut self, time: f64) -> Result<(), Fail> {
        self.exchanging("setting the time", &IN_MOTION)?;
        if !time.is_finite() {
            return Err(error(format!("a time of {time} s is none")));
        }
        self.losses_at = None;
        let time = time - self.offset;
        let run = self.ready()?;
        let state = run.state().to_vec();
        run.look_at(time, &state);
        Ok(())
    }

    pub fn set_states(&mut self, state: &[f64]) -> Result<(), Fail> {
        self.exchanging("setting states", &IN_MOTION)?;
        self.counted(state.len(), self.layout.states.len(), "states")?;
        if let Some(k) = state.iter().position(|x| !x.is_finite()) {
            let why = format!("the state `{}` cannot be {}", self.layout.states[k], state[k]);
            return Err(Fail { status: Status::Discard, why });
        }
        self.losses_at = None;
        let run = self.ready()?;
        let time = run.time();
        run.look_at(time, state);
        Ok(())
    }

    fn counted(&self, is: usize, has: usize, what: &str) -> Result<(), Fail> {
        if is == has { Ok(()) } else { Err(error(format!("there are {has} {what}, not {is}"))) }
    }

    pub fn states(&mut self, out: &mut [f64]) -> Result<(), Fail> {
        self.exchanging("reading states", &WITH_STATES)?;
        self.counted(out.len(), self.layout.states.len(), "states")?;
        out.copy_from_slice(self.ready()?.state());
        Ok(())
    }

    pub fn rates(&mut self, out: &mut [f64]) -> Result<(), Fail> {
        self.exchanging("reading rates", &WITH_STATES)?;
        self.counted(out.len(), self.layout.states.len(), "states")?;
        let run = self.ready()?;
        if let Some(outcome) = run.outcome() {
            return Err(error(in_words(outcome)));
        }
        run.rates(out);
        if out.iter().any(|x| !x.is_finite()) {
            let time = run.time() + self.offset;
            let why = format!("accelerations are not finite at {time} s in the present mode; a shorter step may help");
            return Err(Fail { status: Status::Discard, why });
        }
        Ok(())
    }

    pub fn indicators(&mut self, out: &mut [f64]) -> Result<(), Fail> {
        self.exchanging("reading indicators", &WITH_STATES)?;
        self.counted(out.len(), self.layout.indicators, "indicators")?;
        self.ready()?.indicators(out);
        Ok(())
    }

    pub fn nominals(&mut self, out: &mut [f64]) -> Result<(), Fail> {
        self.exchanging("reading nominal values", &ALWAYS)?;
        self.counted(out.len(), self.layout.states.len(), "states")?;
        out.fill(1.0);
        Ok(())
    }

    /// Whether the host has to look for an event at the end of its step, and whether there is no motion to go on with.
    pub fn completed(&mut self) -> Result<[bool; 2], Fail> {
        if !self.exchanges() {
            return Err(error("the end of a step belongs to model exchange"));
        }
        self.expect("the end of a step", &[Phase::Continuous])?;
        let run = self.ready()?;
        if run.outcome().is_some() { Ok([false, true]) } else { Ok([run.is_over(), false]) }
    }

    /// Derivatives of variables along a direction in others, in the present mode: central differences at two step lengths,
    /// whose leading error cancels. Exact but for rounding wherever the equations are linear, as within a mode they mostly are.
    pub fn directional(&mut self, unknowns: &[u32], knowns: &[u32], seed: &[f64], out: &mut [f64]) -> Result<(), Fail> {
        self.exchanging("a directional derivative", &WITH_STATES)?;
        self.counted(seed.len(), knowns.len(), "known variables")?;
        self.counted(out.len(), unknowns.len(), "unknown variables")?;
        for &reference in unknowns {
            let (_, variable) = self.variable(reference)?;
            if !matches!(variable.role, Role::Output(_) | Role::Loss(_) | Role::Rate(_) | Role::Indicator(_))
                || !matches!(variable.kind, Kind::Real(_))
            {
                return Err(error(format!("`{}` has no derivative: it is no continuous result", variable.name)));
            }
        }
        out.fill(0.0);
        if !seed.iter().any(|x| *x != 0.0) {
            return Ok(());
        }
        self.ready()?;
        let kept = self.clone();
        // Inputs act on the run as it stands, also where they would make it anew or could no longer be set.
        self.phase = Phase::Continuous;
        let done = self.differences(unknowns, knowns, seed, out);
        *self = kept;
        done
    }

    /// The same, with the run left where it was looked at last.
    fn differences(&mut self, unknowns: &[u32], knowns: &[u32], seed: &[f64], out: &mut [f64]) -> Result<(), Fail> {
        let run = self.ready()?;
        let (time, states) = (run.time(), run.state().to_vec());
        let mut size: f64 = 0.0;
        let (mut of_inputs, mut of_states) = (vec![], vec![]);
        for (&reference, &by) in knowns.iter().zip(seed) {
            let (_, variable) = self.variable(reference)?;
            let state = match variable.role {
                Role::State(k) => Some(k),
                Role::Input(_) | Role::InputRate(_) => None,
                _ => return Err(error(format!("`{}` is neither a state nor an input", variable.name))),
            };
            let value = self.real(reference)?;
            size = size.max(by.abs() / value.abs().max(1.0));
            match state {
                Some(k) => of_states.push((k, by)),
                None => of_inputs.push((reference, value, by)),
            }
        }
        let step = PART / size;
        let mut sums = vec![vec![0.0; out.len()]; 2];
        for (sum, h) in sums.iter_mut().zip([step, 0.5 * step]) {
            for sign in [1.0, -1.0] {
                for &(reference, value, by) in &of_inputs {
                    self.set(reference, &Value::Real(value + sign * h * by))?;
                }
                // After the inputs: what they change must not take the states along.
                let mut there = states.clone();
                of_states.iter().for_each(|&(k, by)| there[k] += sign * h * by);
                self.ready()?.look_at(time, &there);
                self.losses_at = None;
                for (sum, &reference) in sum.iter_mut().zip(unknowns) {
                    *sum += sign * self.real(reference)? / (2.0 * h);
                }
            }
        }
        for (k, out) in out.iter_mut().enumerate() {
            *out = (4.0 * sums[1][k] - sums[0][k]) / 3.0;
        }
        Ok(())
    }

    /// A run with the parameters of this instance, for a state that is read back.
    pub fn blank(&mut self) -> Result<Simulation, Fail> {
        self.fresh()
    }

    /// Takes over a run that was read back.
    pub fn take(&mut self, run: Option<Simulation>) {
        self.told_events = run.as_ref().map_or(0, Simulation::event_count);
        self.told_end = run.as_ref().is_some_and(|run| run.outcome().is_some());
        (self.run, self.losses_at) = (run, None);
    }
}

fn in_words(outcome: &Outcome) -> String {
    format!("the run {}: {}", outcome.words(), outcome.why())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::resources::INDEX;

    /// A library that was left behind from an older version, and lists its variables otherwise.
    #[test]
    fn a_runtime_with_other_variables_is_refused() {
        let model = Model::from_toml(
            "format = 1\nname = 'rotor'\nmembers = ['rotor']\ninertias = { rotor = '2 kg m^2' }\n\
             [[scenario]]\nname = 'coast'\nduration = '1 s'\ninitial_speeds = { rotor = '3 rad/s' }\n",
        )
        .unwrap();
        let folder = std::env::temp_dir().join(format!("willis fmu variables {}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let made = |layout: &Layout| {
            let resources = Resources::of(&model, "coast", Interface::Both, layout);
            fs::write(folder.join(INDEX), serde_json::to_string(&resources.index).unwrap()).unwrap();
            for (name, text) in &resources.files {
                fs::write(folder.join(name), text).unwrap();
            }
            Instance::new(&folder, &resources.index.token, true, false).map(drop)
        };
        let own = Layout::of(&model, "coast", Interface::Both).unwrap();
        assert_eq!(made(&own), Ok(()));
        let change = |what: fn(&mut Vec<Variable>)| {
            let mut layout = own.clone();
            what(&mut layout.variables);
            layout
        };
        for other in [
            change(|all| all.swap(1, 2)),
            change(|all| drop(all.pop())),
            change(|all| all[1].name.push('s')),
            change(|all| all[1].role = Role::Tolerance),
            change(|all| all[1].kind = Kind::Integer),
        ] {
            let why = made(&other).unwrap_err().why;
            assert!(why.contains("the runtime has other variables than the description"), "{why}");
        }
        fs::remove_dir_all(&folder).unwrap();
    }
}
