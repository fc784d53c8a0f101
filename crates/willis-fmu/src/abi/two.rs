//! Version 2.0.4: `fmi2FunctionTypes.h`.

use std::ffi::{c_char, c_int, c_void};

use crate::instance::{Instance, Phase, Status, error};
use crate::layout::Value;

use super::handles::{Component, Tell, back, create, free, keep, kept, release, with};
use super::raw::{closed, folder, put, read, room, text};

type Handle = *mut c_void;
type Reference = u32;

type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi2CallbackFunctions`
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Callbacks {
    logger: Option<Logger>,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// `fmi2EventInfo`
#[repr(C)]
pub struct EventInfo {
    new_discrete_states_needed: c_int,
    terminate_simulation: c_int,
    nominals_changed: c_int,
    values_changed: c_int,
    next_event_time_defined: c_int,
    next_event_time: f64,
}

/// What belongs to the host, and goes back to it.
struct Environment(*mut c_void);
// SAFETY: it is never followed here, only handed back to the host's own function.
unsafe impl Send for Environment {}

impl Environment {
    fn pointer(&self) -> *mut c_void {
        self.0
    }
}

/// What the last step can be asked for.
const DO_STEP: c_int = 0;
const LAST_SUCCESSFUL_TIME: c_int = 2;
const TERMINATED: c_int = 3;

fn teller(callbacks: Option<&Callbacks>, name: &str) -> Tell {
    let Some(Callbacks { logger: Some(logger), environment, .. }) = callbacks.copied() else {
        return Box::new(|_, _, _| {});
    };
    let (environment, name) = (Environment(environment), closed(name));
    Box::new(move |status, category, message| {
        // The message is a format of C.
        let (category, message) = (closed(category), closed(&message.replace('%', "%%")));
        // SAFETY: the host's own function with its own environment; the texts live during the call.
        unsafe { logger(environment.pointer(), name.as_ptr(), status as c_int, category.as_ptr(), message.as_ptr()) }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    logging: c_int,
) -> Handle {
    // SAFETY: texts of the host.
    let (name, guid, resources) = unsafe { (text(name), text(guid), text(resources)) };
    // SAFETY: one structure of the host, if any.
    let callbacks = unsafe { callbacks.as_ref() };
    let tell = teller(callbacks, name.as_deref().unwrap_or_default());
    create(tell, logging != 0, || {
        if name.as_deref().is_none_or(str::is_empty) {
            return Err(error("an instance needs a name"));
        }
        let guid = guid.ok_or_else(|| error("no GUID is given"))?;
        let resources = resources.ok_or_else(|| error("the address of the resources is not given"))?;
        let exchanges = match kind {
            0 => true,
            1 => false,
            other => return Err(error(format!("an instance is of type 0 or 1, not {other}"))),
        };
        Instance::new(&folder(&resources)?, &guid, exchanges, false)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(c: Handle) {
    free(c);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: Handle,
    on: c_int,
    count: usize,
    categories: *const *const c_char,
) -> c_int {
    with(c, |c| {
        // SAFETY: so many texts of the host.
        let names = unsafe { read(categories, count, "categories") }?;
        c.logs = on != 0;
        // SAFETY: each is a text of the host.
        c.categories = names.iter().filter_map(|at| unsafe { text(*at) }).collect();
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    c: Handle,
    has_tolerance: c_int,
    tolerance: f64,
    start: f64,
    has_stop: c_int,
    stop: f64,
) -> c_int {
    with(c, |c| {
        c.instance.expect("the setup of an experiment", &[Phase::Instantiated])?;
        if !start.is_finite() || has_stop != 0 && (stop < start || stop.is_nan()) {
            return Err(error(format!("an experiment from {start} s to {stop} s is none")));
        }
        c.set_up = Some((start, (has_tolerance != 0).then_some(tolerance)));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(c: Handle) -> c_int {
    with(c, |c| {
        let start = c.instance.layout.span[0];
        let (start, tolerance) = c.set_up.unwrap_or((start, None));
        c.instance.enter_initialization(start, tolerance)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(c: Handle) -> c_int {
    with(c, |c| c.instance.exit_initialization())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(c: Handle) -> c_int {
    with(c, |c| c.instance.terminate())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(c: Handle) -> c_int {
    with(c, |c| {
        c.instance.reset();
        (c.last, c.set_up) = (None, None);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(c: Handle, references: *const Reference, count: usize, values: *mut f64) -> c_int {
    with(c, |c| {
        // SAFETY: both as long as the host says.
        let (references, values) = unsafe { (read(references, count, "references")?, room(values, count, "values")?) };
        for (value, reference) in values.iter_mut().zip(references) {
            *value = c.instance.real(*reference)?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *mut c_int,
) -> c_int {
    with(c, |c| {
        // SAFETY: both as long as the host says.
        let (references, values) = unsafe { (read(references, count, "references")?, room(values, count, "values")?) };
        for (value, reference) in values.iter_mut().zip(references) {
            let long = c.instance.integer(*reference)?;
            *value = c_int::try_from(long)
                .map_err(|_| error(format!("{long} is too large for version 2 of the interface")))?;
        }
        Ok(())
    })
}

/// There are none.
fn no_booleans(count: usize) -> Result<(), crate::instance::Fail> {
    if count == 0 { Ok(()) } else { Err(error("the unit has no variable that is true or false")) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetBoolean(c: Handle, _: *const Reference, count: usize, _: *mut c_int) -> c_int {
    with(c, |_| no_booleans(count))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *mut *const c_char,
) -> c_int {
    with(c, |c| {
        // SAFETY: both as long as the host says.
        let (references, values) = unsafe { (read(references, count, "references")?, room(values, count, "values")?) };
        give_texts(c, references, values)
    })
}

/// Texts that live until others are asked for.
pub(super) fn give_texts(
    c: &mut Component,
    references: &[u32],
    values: &mut [*const c_char],
) -> Result<(), crate::instance::Fail> {
    let texts: Result<Vec<_>, _> = references.iter().map(|r| Ok(closed(&c.instance.text(*r)?))).collect();
    c.texts = texts?;
    values.iter_mut().zip(&c.texts).for_each(|(value, text)| *value = text.as_ptr());
    Ok(())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *const f64,
) -> c_int {
    with(c, |c| {
        // SAFETY: both as long as the host says.
        let (references, values) = unsafe { (read(references, count, "references")?, read(values, count, "values")?) };
        references.iter().zip(values).try_for_each(|(r, x)| c.instance.set(*r, &Value::Real(*x)))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *const c_int,
) -> c_int {
    with(c, |c| {
        // SAFETY: both as long as the host says.
        let (references, values) = unsafe { (read(references, count, "references")?, read(values, count, "values")?) };
        references.iter().zip(values).try_for_each(|(r, x)| c.instance.set(*r, &Value::Integer(i64::from(*x))))
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetBoolean(c: Handle, _: *const Reference, count: usize, _: *const c_int) -> c_int {
    with(c, |_| no_booleans(count))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetString(c: Handle, _: *const Reference, count: usize, _: *const *const c_char) -> c_int {
    with(c, |_| if count == 0 { Ok(()) } else { Err(error("the unit has no text that can be set")) })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: Handle, state: *mut Handle) -> c_int {
    with(c, |c| {
        // SAFETY: a place for one pointer, null or that of a state given before.
        let before = *unsafe { room(state, 1, "the state") }?.first().unwrap_or(&std::ptr::null_mut());
        release(before);
        // SAFETY: the same place.
        unsafe { put(state, keep(c.instance.clone()), "the state") }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(c: Handle, state: Handle) -> c_int {
    with(c, |c| back(c, &*kept(state)?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: Handle, state: *mut Handle) -> c_int {
    with(c, |_| {
        if state.is_null() {
            return Ok(());
        }
        // SAFETY: a place for one pointer.
        let room = unsafe { room(state, 1, "the state") }?;
        release(room[0]);
        room[0] = std::ptr::null_mut();
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(c: Handle, state: Handle, size: *mut usize) -> c_int {
    with(c, |_| {
        let bytes = Instance::clone(&*kept(state)?).bytes();
        // SAFETY: a place for one number.
        unsafe { put(size, bytes.len(), "the size") }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(c: Handle, state: Handle, to: *mut u8, size: usize) -> c_int {
    with(c, |_| {
        let bytes = Instance::clone(&*kept(state)?).bytes();
        if size < bytes.len() {
            return Err(error(format!("a state takes {} bytes, and there is room for {size}", bytes.len())));
        }
        // SAFETY: as many bytes as the host says.
        unsafe { room(to, size, "the bytes") }?[..bytes.len()].copy_from_slice(&bytes);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(c: Handle, from: *const u8, size: usize, state: *mut Handle) -> c_int {
    with(c, |c| {
        // SAFETY: as many bytes as the host says.
        let bytes = unsafe { read(from, size, "the bytes") }?;
        let instance = c.instance.of_bytes(bytes)?;
        // SAFETY: a place for one pointer.
        unsafe { put(state, keep(instance), "the state") }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: Handle,
    unknowns: *const Reference,
    unknown_count: usize,
    knowns: *const Reference,
    known_count: usize,
    seed: *const f64,
    out: *mut f64,
) -> c_int {
    with(c, |c| {
        // SAFETY: as long as the host says.
        let (unknowns, knowns, seed, out) = unsafe {
            (
                read(unknowns, unknown_count, "unknowns")?,
                read(knowns, known_count, "knowns")?,
                read(seed, known_count, "the direction")?,
                room(out, unknown_count, "derivatives")?,
            )
        };
        c.instance.directional(unknowns, knowns, seed, out)
    })
}

// Model exchange.

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterEventMode(c: Handle) -> c_int {
    with(c, |c| c.instance.enter_event_mode())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2NewDiscreteStates(c: Handle, info: *mut EventInfo) -> c_int {
    with(c, |c| {
        let settled = c.instance.settle()?;
        let info_now = EventInfo {
            new_discrete_states_needed: 0,
            terminate_simulation: 0,
            nominals_changed: 0,
            values_changed: c_int::from(settled.states_changed),
            next_event_time_defined: c_int::from(settled.next.is_some()),
            next_event_time: settled.next.unwrap_or(0.0),
        };
        // SAFETY: a place for one structure.
        unsafe { put(info, info_now, "the event") }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterContinuousTimeMode(c: Handle) -> c_int {
    with(c, |c| c.instance.enter_continuous_time_mode())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
    c: Handle,
    _: c_int,
    event: *mut c_int,
    terminate: *mut c_int,
) -> c_int {
    with(c, |c| {
        let over = c.instance.completed()?;
        // SAFETY: places for one value each.
        unsafe {
            put(event, c_int::from(over), "the event")?;
            put(terminate, 0, "the end")
        }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetTime(c: Handle, time: f64) -> c_int {
    with(c, |c| c.instance.set_time(time))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetContinuousStates(c: Handle, states: *const f64, count: usize) -> c_int {
    // SAFETY: as long as the host says.
    with(c, |c| c.instance.set_states(unsafe { read(states, count, "states") }?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDerivatives(c: Handle, rates: *mut f64, count: usize) -> c_int {
    // SAFETY: as long as the host says.
    with(c, |c| c.instance.rates(unsafe { room(rates, count, "rates") }?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetEventIndicators(c: Handle, indicators: *mut f64, count: usize) -> c_int {
    // SAFETY: as long as the host says.
    with(c, |c| c.instance.indicators(unsafe { room(indicators, count, "indicators") }?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetContinuousStates(c: Handle, states: *mut f64, count: usize) -> c_int {
    // SAFETY: as long as the host says.
    with(c, |c| c.instance.states(unsafe { room(states, count, "states") }?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetNominalsOfContinuousStates(c: Handle, nominals: *mut f64, count: usize) -> c_int {
    // SAFETY: as long as the host says.
    with(c, |c| c.instance.nominals(unsafe { room(nominals, count, "nominal values") }?))
}

// Co-simulation.

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetRealInputDerivatives(
    c: Handle,
    _: *const Reference,
    count: usize,
    _: *const c_int,
    _: *const f64,
) -> c_int {
    with(c, |_| if count == 0 { Ok(()) } else { Err(error("inputs are not interpolated")) })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetRealOutputDerivatives(
    c: Handle,
    _: *const Reference,
    count: usize,
    _: *const c_int,
    _: *mut f64,
) -> c_int {
    with(c, |_| if count == 0 { Ok(()) } else { Err(error("outputs have no derivatives; accelerations are outputs")) })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(c: Handle, time: f64, length: f64, _: c_int) -> c_int {
    with(c, |c| {
        let stepped = c.instance.step(time, length)?;
        c.last = Some(stepped);
        match stepped.ended {
            false => Ok(()),
            // The host asks whether it is the end.
            true => Err(crate::instance::Fail {
                status: Status::Discard,
                why: format!("the run ended at {} s", stepped.time),
            }),
        }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(c: Handle) -> c_int {
    with(c, |_| Err(error("no step is under way")))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(c: Handle, kind: c_int, value: *mut c_int) -> c_int {
    with(c, |c| match (kind, c.last) {
        (DO_STEP, Some(last)) => {
            let status = if last.ended { Status::Discard } else { Status::Ok };
            // SAFETY: a place for one number.
            unsafe { put(value, status as c_int, "the status") }
        }
        _ => Err(error("there is no such status")),
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: Handle, kind: c_int, value: *mut f64) -> c_int {
    with(c, |c| match (kind, c.last) {
        // SAFETY: a place for one number.
        (LAST_SUCCESSFUL_TIME, Some(last)) => unsafe { put(value, last.time, "the status") },
        _ => Err(error("there is no such status")),
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetIntegerStatus(c: Handle, _: c_int, _: *mut c_int) -> c_int {
    with(c, |_| Err(error("there is no such status")))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(c: Handle, kind: c_int, value: *mut c_int) -> c_int {
    with(c, |c| match (kind, c.last) {
        // SAFETY: a place for one number.
        (TERMINATED, Some(last)) => unsafe { put(value, c_int::from(last.ended), "the status") },
        _ => Err(error("there is no such status")),
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStringStatus(c: Handle, _: c_int, _: *mut *const c_char) -> c_int {
    with(c, |_| Err(error("there is no such status")))
}
