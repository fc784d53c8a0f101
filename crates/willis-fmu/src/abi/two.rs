//! Version 2.0.4: `fmi2FunctionTypes.h`.

use std::ffi::{c_char, c_int, c_void};

use crate::instance::{Fail, Instance, Phase, Status, error};
use crate::layout::Value;

use super::handles::{Tell, create, free, with};
use super::raw::{closed, folder, put, read, text};
use super::three::fmi3GetDirectionalDerivative;
use super::{Environment, Handle, Reference, completed, get, get_texts, set};

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
pub extern "C" fn fmi2Reset(c: Handle) -> c_int {
    with(c, |c| {
        c.instance.reset();
        (c.last, c.set_up) = (None, None);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(c: Handle, references: *const Reference, count: usize, values: *mut f64) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { get(c, references, values, [count, count], Instance::real) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *mut c_int,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe {
        get(c, references, values, [count, count], |instance, reference| {
            let long = instance.integer(reference)?;
            c_int::try_from(long).map_err(|_| error(format!("{long} is too large for version 2 of the interface")))
        })
    }
}

/// There are none.
fn no_booleans(count: usize) -> Result<(), Fail> {
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
    // SAFETY: handed on as it is.
    unsafe { get_texts(c, references, values, [count, count]) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *const f64,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { set(c, references, values, [count, count], Value::Real) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *const c_int,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { set(c, references, values, [count, count], |x| Value::Integer(i64::from(x))) }
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
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: Handle,
    unknowns: *const Reference,
    unknown_count: usize,
    knowns: *const Reference,
    known_count: usize,
    seed: *const f64,
    out: *mut f64,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe {
        fmi3GetDirectionalDerivative(
            c,
            unknowns,
            unknown_count,
            knowns,
            known_count,
            seed,
            known_count,
            out,
            unknown_count,
        )
    }
}

// Model exchange.

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2NewDiscreteStates(c: Handle, info: *mut EventInfo) -> c_int {
    with(c, |c| {
        let settled = c.instance.settle()?;
        let info_now = EventInfo {
            new_discrete_states_needed: 0,
            terminate_simulation: c_int::from(settled.over),
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
pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
    c: Handle,
    _: c_int,
    event: *mut c_int,
    terminate: *mut c_int,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { completed(c, event, terminate) }
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
            true => Err(Fail { status: Status::Discard, why: format!("the run ended at {} s", stepped.time) }),
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
