//! The functions of C that a host calls. The only unsafe code of the project's runtime is here: reading and writing where the
//! host's pointers lead.
//!
//! A component that a host holds is a number dressed as a pointer, looked up in a list and never followed: one that was freed,
//! or never was, is an error and no crash. The same holds for states. Every call catches panics.
//!
//! What both versions have with the same parameters is here, under both names; the rest is in the module of its version.

#![allow(unsafe_code)]
// Every function here has the contract of the standard of its name; what a pointer must be is said where it is followed.
#![allow(clippy::missing_safety_doc, clippy::too_many_arguments)]

use std::ffi::{c_char, c_int, c_void};

use crate::instance::{Fail, Instance, error};
use crate::layout::Value;

use handles::{back, keep, kept, release, with};
use raw::{closed, put, read, room};

mod handles;
mod raw;
mod three;
mod two;

type Handle = *mut c_void;
type Reference = u32;

/// What belongs to the host, and goes back to it.
struct Environment(*mut c_void);
// SAFETY: it is never followed here, only handed back to the host's own function.
unsafe impl Send for Environment {}

impl Environment {
    fn pointer(&self) -> *mut c_void {
        self.0
    }
}

/// Functions of both versions: two names and one body, which is given the component. Before the names stands `[unsafe]` where
/// pointers are followed.
macro_rules! both {
    ($($([$word:tt])? $two:ident, $three:ident($c:pat $(, $name:ident: $kind:ty)*) $body:expr;)*) => {$(
        #[unsafe(no_mangle)]
        pub $($word)? extern "C" fn $two(component: Handle $(, $name: $kind)*) -> c_int {
            with(component, |$c| $body)
        }

        #[unsafe(no_mangle)]
        pub $($word)? extern "C" fn $three(component: Handle $(, $name: $kind)*) -> c_int {
            with(component, |$c| $body)
        }
    )*};
}

both! {
    fmi2ExitInitializationMode, fmi3ExitInitializationMode(c) c.instance.exit_initialization();
    fmi2Terminate, fmi3Terminate(c) c.instance.terminate();
    fmi2EnterEventMode, fmi3EnterEventMode(c) c.instance.enter_event_mode();
    fmi2EnterContinuousTimeMode, fmi3EnterContinuousTimeMode(c) c.instance.enter_continuous_time_mode();
    fmi2SetTime, fmi3SetTime(c, time: f64) c.instance.set_time(time);

    [unsafe] fmi2SetContinuousStates, fmi3SetContinuousStates(c, states: *const f64, count: usize)
        // SAFETY: as long as the host says.
        c.instance.set_states(unsafe { read(states, count, "states") }?);
    [unsafe] fmi2GetContinuousStates, fmi3GetContinuousStates(c, states: *mut f64, count: usize)
        // SAFETY: as long as the host says.
        c.instance.states(unsafe { room(states, count, "states") }?);
    [unsafe] fmi2GetDerivatives, fmi3GetContinuousStateDerivatives(c, rates: *mut f64, count: usize)
        // SAFETY: as long as the host says.
        c.instance.rates(unsafe { room(rates, count, "rates") }?);
    [unsafe] fmi2GetEventIndicators, fmi3GetEventIndicators(c, indicators: *mut f64, count: usize)
        // SAFETY: as long as the host says.
        c.instance.indicators(unsafe { room(indicators, count, "indicators") }?);
    [unsafe] fmi2GetNominalsOfContinuousStates, fmi3GetNominalsOfContinuousStates(c, nominals: *mut f64, count: usize)
        // SAFETY: as long as the host says.
        c.instance.nominals(unsafe { room(nominals, count, "nominal values") }?);

    [unsafe] fmi2GetFMUstate, fmi3GetFMUState(c, state: *mut Handle) {
        // SAFETY: a place for one pointer, null or that of a state given before.
        let before = *unsafe { room(state, 1, "the state") }?.first().unwrap_or(&std::ptr::null_mut());
        release(before);
        // SAFETY: the same place.
        unsafe { put(state, keep(c.instance.clone()), "the state") }
    };
    fmi2SetFMUstate, fmi3SetFMUState(c, state: Handle) back(c, &*kept(state)?);
    [unsafe] fmi2FreeFMUstate, fmi3FreeFMUState(_, state: *mut Handle) {
        if state.is_null() {
            return Ok(());
        }
        // SAFETY: a place for one pointer.
        let room = unsafe { room(state, 1, "the state") }?;
        release(room[0]);
        room[0] = std::ptr::null_mut();
        Ok(())
    };
    [unsafe] fmi2SerializedFMUstateSize, fmi3SerializedFMUStateSize(_, state: Handle, size: *mut usize) {
        let bytes = Instance::clone(&*kept(state)?).bytes();
        // SAFETY: a place for one number.
        unsafe { put(size, bytes.len(), "the size") }
    };
    [unsafe] fmi2SerializeFMUstate, fmi3SerializeFMUState(_, state: Handle, to: *mut u8, size: usize) {
        let bytes = Instance::clone(&*kept(state)?).bytes();
        if size < bytes.len() {
            return Err(error(format!("a state takes {} bytes, and there is room for {size}", bytes.len())));
        }
        // SAFETY: as many bytes as the host says.
        unsafe { room(to, size, "the bytes") }?[..bytes.len()].copy_from_slice(&bytes);
        Ok(())
    };
    [unsafe] fmi2DeSerializeFMUstate, fmi3DeserializeFMUState(c, from: *const u8, size: usize, state: *mut Handle) {
        // SAFETY: as many bytes as the host says.
        let bytes = unsafe { read(from, size, "the bytes") }?;
        let instance = c.instance.of_bytes(bytes)?;
        // SAFETY: a place for one pointer.
        unsafe { put(state, keep(instance), "the state") }
    };
}

/// What is asked of variables: how many references and values there are.
type Counts = [usize; 2];

/// No variable is an array.
fn as_many([references, values]: Counts) -> Result<usize, Fail> {
    if references == values {
        return Ok(references);
    }
    Err(error(format!("{references} variables have as many values, not {values}")))
}

/// Reads variables, one after another.
///
/// # Safety
/// References and values are as many as the host says, or null.
unsafe fn get<T>(
    c: Handle,
    references: *const Reference,
    values: *mut T,
    counts: Counts,
    one: impl Fn(&mut Instance, Reference) -> Result<T, Fail>,
) -> c_int {
    with(c, |c| {
        let count = as_many(counts)?;
        // SAFETY: both as long as the host says.
        let (references, values) = unsafe { (read(references, count, "references")?, room(values, count, "values")?) };
        for (value, reference) in values.iter_mut().zip(references) {
            *value = one(&mut c.instance, *reference)?;
        }
        Ok(())
    })
}

/// Reads variables that are texts. They live until others are asked for.
///
/// # Safety
/// As above.
unsafe fn get_texts(c: Handle, references: *const Reference, values: *mut *const c_char, counts: Counts) -> c_int {
    with(c, |c| {
        let count = as_many(counts)?;
        // SAFETY: both as long as the host says.
        let (references, values) = unsafe { (read(references, count, "references")?, room(values, count, "values")?) };
        let texts: Result<Vec<_>, Fail> = references.iter().map(|r| Ok(closed(&c.instance.text(*r)?))).collect();
        c.texts = texts?;
        values.iter_mut().zip(&c.texts).for_each(|(value, text)| *value = text.as_ptr());
        Ok(())
    })
}

/// Sets variables, one after another.
///
/// # Safety
/// As above.
unsafe fn set<T: Copy>(
    c: Handle,
    references: *const Reference,
    values: *const T,
    counts: Counts,
    value: impl Fn(T) -> Value,
) -> c_int {
    with(c, |c| {
        let count = as_many(counts)?;
        // SAFETY: both as long as the host says.
        let (references, values) = unsafe { (read(references, count, "references")?, read(values, count, "values")?) };
        references.iter().zip(values).try_for_each(|(r, x)| c.instance.set(*r, &value(*x)))
    })
}

/// The end of a step of a host that integrates. The versions differ in what is true or false.
///
/// # Safety
/// There are places for one value each, or null.
unsafe fn completed<B: From<bool>>(c: Handle, event: *mut B, terminate: *mut B) -> c_int {
    with(c, |c| {
        let [looks, ended] = c.instance.completed()?;
        // SAFETY: as above.
        unsafe {
            put(event, B::from(looks), "the event")?;
            put(terminate, B::from(ended), "the end")
        }
    })
}
