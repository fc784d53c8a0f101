//! Version 3.0: `fmi3FunctionTypes.h`.

use std::ffi::{c_char, c_int, c_void};

use crate::instance::{Fail, Instance, Status, Stepped, error};
use crate::layout::Value;

use super::handles::{Tell, create, free, with};
use super::raw::{closed, put, read, room, text};
use super::{Environment, Handle, Reference, completed, get, get_texts, set};

/// `fmi3Boolean` is C's bool; as a byte, so that one that is neither 0 nor 1 is no undefined behaviour.
type Boolean = u8;

type Logger = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

fn teller(logger: Option<Logger>, environment: *mut c_void) -> Tell {
    let Some(logger) = logger else { return Box::new(|_, _, _| {}) };
    let environment = Environment(environment);
    Box::new(move |status, category, message| {
        let (category, message) = (closed(category), closed(message));
        // SAFETY: the host's own function with its own environment; the texts live during the call.
        unsafe { logger(environment.pointer(), status as c_int, category.as_ptr(), message.as_ptr()) }
    })
}

/// The instance of these texts.
///
/// # Safety
/// They are texts of the host.
unsafe fn instance(
    [name, token, resources]: [*const c_char; 3],
    exchanges: bool,
    stops_at_events: bool,
) -> Result<Instance, Fail> {
    // SAFETY: as above.
    let (name, token, resources) = unsafe { (text(name), text(token), text(resources)) };
    if name.as_deref().is_none_or(str::is_empty) {
        return Err(error("an instance needs a name"));
    }
    let token = token.ok_or_else(|| error("no instantiation token is given"))?;
    let resources = resources.ok_or_else(|| error("the path of the resources is not given"))?;
    Instance::new(resources.as_ref(), &token, exchanges, stops_at_events)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    c: Handle,
    on: Boolean,
    count: usize,
    categories: *const *const c_char,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { super::two::fmi2SetDebugLogging(c, c_int::from(on), count, categories) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: Boolean,
    logging: Boolean,
    environment: *mut c_void,
    logger: Option<Logger>,
) -> Handle {
    create(teller(logger, environment), logging != 0, || {
        // SAFETY: texts of the host.
        unsafe { instance([name, token, resources], true, false) }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: Boolean,
    logging: Boolean,
    event_mode: Boolean,
    early_return: Boolean,
    _required: *const Reference,
    _required_count: usize,
    environment: *mut c_void,
    logger: Option<Logger>,
    _intermediate: *const c_void,
) -> Handle {
    create(teller(logger, environment), logging != 0, || {
        // SAFETY: texts of the host.
        let mut instance = unsafe { instance([name, token, resources], false, event_mode != 0) }?;
        instance.returns_early = early_return != 0;
        Ok(instance)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: Boolean,
    logging: Boolean,
    environment: *mut c_void,
    logger: Option<Logger>,
    _clock: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> Handle {
    create(teller(logger, environment), logging != 0, || Err(error("the unit has no clocks to be scheduled by")))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(c: Handle) {
    free(c);
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    c: Handle,
    has_tolerance: Boolean,
    tolerance: f64,
    start: f64,
    has_stop: Boolean,
    stop: f64,
) -> c_int {
    with(c, |c| {
        if has_stop != 0 && (stop < start || stop.is_nan()) {
            return Err(error(format!("an experiment from {start} s to {stop} s is none")));
        }
        c.instance.enter_initialization(start, (has_tolerance != 0).then_some(tolerance))
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(c: Handle) -> c_int {
    with(c, |c| {
        c.instance.reset();
        c.last = None;
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { get(c, references, values, [count, value_count], Instance::real) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { set(c, references, values, [count, value_count], Value::Real) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt64(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *mut i64,
    value_count: usize,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { get(c, references, values, [count, value_count], Instance::integer) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt64(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *const i64,
    value_count: usize,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { set(c, references, values, [count, value_count], Value::Integer) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetString(
    c: Handle,
    references: *const Reference,
    count: usize,
    values: *mut *const c_char,
    value_count: usize,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { get_texts(c, references, values, [count, value_count]) }
}

/// Functions for kinds of values that no variable has: what they take behind the references, and their names.
macro_rules! absent {
    ($($name:ident($($kind:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: Handle, _: *const Reference, count: usize $(, _: $kind)*) -> c_int {
            with(c, |_| match count {
                0 => Ok(()),
                _ => Err(error(concat!("no variable of the unit is of the kind of ", stringify!($name)))),
            })
        }
    )*};
}

absent! {
    fmi3GetFloat32(*mut f32, usize);
    fmi3SetFloat32(*const f32, usize);
    fmi3GetInt8(*mut i8, usize);
    fmi3SetInt8(*const i8, usize);
    fmi3GetUInt8(*mut u8, usize);
    fmi3SetUInt8(*const u8, usize);
    fmi3GetInt16(*mut i16, usize);
    fmi3SetInt16(*const i16, usize);
    fmi3GetUInt16(*mut u16, usize);
    fmi3SetUInt16(*const u16, usize);
    fmi3GetInt32(*mut i32, usize);
    fmi3SetInt32(*const i32, usize);
    fmi3GetUInt32(*mut u32, usize);
    fmi3SetUInt32(*const u32, usize);
    fmi3GetUInt64(*mut u64, usize);
    fmi3SetUInt64(*const u64, usize);
    fmi3GetBoolean(*mut u8, usize);
    fmi3SetBoolean(*const u8, usize);
    fmi3SetString(*const *const c_char, usize);
    fmi3GetBinary(*mut usize, *mut *const u8, usize);
    fmi3SetBinary(*const usize, *const *const u8, usize);
    fmi3GetClock(*mut u8);
    fmi3SetClock(*const u8);
    fmi3GetIntervalDecimal(*mut f64, *mut c_int);
    fmi3GetIntervalFraction(*mut u64, *mut u64, *mut c_int);
    fmi3GetShiftDecimal(*mut f64);
    fmi3GetShiftFraction(*mut u64, *mut u64);
    fmi3SetIntervalDecimal(*const f64);
    fmi3SetIntervalFraction(*const u64, *const u64);
    fmi3SetShiftDecimal(*const f64);
    fmi3SetShiftFraction(*const u64, *const u64);
    fmi3GetOutputDerivatives(*const i32, *mut f64, usize);
}

/// Functions that the description says are not there.
macro_rules! refused {
    ($($name:ident($($kind:ty),*) $why:literal;)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: Handle $(, _: $kind)*) -> c_int {
            with(c, |_| Err(error($why)))
        }
    )*};
}

refused! {
    fmi3GetNumberOfVariableDependencies(Reference, *mut usize) "every result may depend on every state and input";
    fmi3GetVariableDependencies(Reference, *mut usize, *mut Reference, *mut usize, *mut c_int, usize)
        "every result may depend on every state and input";
    fmi3GetAdjointDerivative(*const Reference, usize, *const Reference, usize, *const f64, usize, *mut f64, usize)
        "there are directional derivatives, and no adjoint ones";
    fmi3EnterConfigurationMode() "the unit has no structural parameters";
    fmi3ExitConfigurationMode() "the unit has no structural parameters";
    fmi3ActivateModelPartition(Reference, f64) "the unit has no clocks to be scheduled by";
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    c: Handle,
    unknowns: *const Reference,
    unknown_count: usize,
    knowns: *const Reference,
    known_count: usize,
    seed: *const f64,
    seed_count: usize,
    out: *mut f64,
    out_count: usize,
) -> c_int {
    with(c, |c| {
        // SAFETY: as long as the host says.
        let (unknowns, knowns, seed, out) = unsafe {
            (
                read(unknowns, unknown_count, "unknowns")?,
                read(knowns, known_count, "knowns")?,
                read(seed, seed_count, "the direction")?,
                room(out, out_count, "derivatives")?,
            )
        };
        c.instance.directional(unknowns, knowns, seed, out)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EvaluateDiscreteStates(c: Handle) -> c_int {
    with(c, |c| c.instance.settle().map(drop))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    c: Handle,
    again: *mut Boolean,
    terminate: *mut Boolean,
    nominals: *mut Boolean,
    values: *mut Boolean,
    has_next: *mut Boolean,
    next: *mut f64,
) -> c_int {
    with(c, |c| {
        let settled = c.instance.settle()?;
        // SAFETY: places for one value each.
        unsafe {
            put(again, 0, "whether to go on")?;
            put(terminate, Boolean::from(settled.over), "the end")?;
            put(nominals, 0, "nominal values")?;
            put(values, Boolean::from(settled.states_changed), "changed states")?;
            put(has_next, Boolean::from(settled.next.is_some()), "the next event")?;
            put(next, settled.next.unwrap_or(0.0), "the next event")
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3CompletedIntegratorStep(
    c: Handle,
    _: Boolean,
    event: *mut Boolean,
    terminate: *mut Boolean,
) -> c_int {
    // SAFETY: handed on as it is.
    unsafe { completed(c, event, terminate) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfEventIndicators(c: Handle, count: *mut usize) -> c_int {
    // SAFETY: a place for one number.
    with(c, |c| unsafe { put(count, c.instance.layout.indicators, "the number") })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfContinuousStates(c: Handle, count: *mut usize) -> c_int {
    // SAFETY: a place for one number.
    with(c, |c| unsafe { put(count, c.instance.layout.states.len(), "the number") })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterStepMode(c: Handle) -> c_int {
    with(c, |c| c.instance.enter_step_mode())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    c: Handle,
    time: f64,
    length: f64,
    _: Boolean,
    event: *mut Boolean,
    terminate: *mut Boolean,
    early: *mut Boolean,
    last_time: *mut f64,
) -> c_int {
    with(c, |c| {
        let Stepped { time: reached, early: at_event, ended } = c.instance.step(time, length)?;
        // SAFETY: places for one value each.
        unsafe {
            put(event, Boolean::from(at_event), "the event")?;
            put(terminate, Boolean::from(ended), "the end")?;
            put(early, Boolean::from(at_event), "the early return")?;
            put(last_time, reached, "the time reached")?;
        }
        match ended && reached < time + length {
            false => Ok(()),
            true => Err(Fail { status: Status::Discard, why: format!("the run ended at {reached} s") }),
        }
    })
}
