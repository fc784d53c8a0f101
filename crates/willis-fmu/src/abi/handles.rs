//! Components and states that hosts hold.

use std::collections::HashMap;
use std::ffi::{CString, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, RwLock, TryLockError};

use crate::instance::{Fail, Instance, Status, error};

/// Tells the host something: status, category, message.
pub(super) type Tell = Box<dyn Fn(Status, &str, &str) + Send>;

/// A component.
pub(super) struct Component {
    pub instance: Instance,
    tell: Tell,
    /// Whether it tells of more than errors and warnings, and which categories are wanted; all if none is named.
    pub logs: bool,
    pub categories: Vec<String>,
    /// Texts that the host was given last, and reads until it asks for others.
    pub texts: Vec<CString>,
    /// How the last step ended.
    pub last: Option<crate::instance::Stepped>,
    /// Start and tolerance of the experiment, if they were given.
    pub set_up: Option<(f64, Option<f64>)>,
    /// It panicked: nothing in it is certain.
    broken: bool,
}

type List<T> = OnceLock<RwLock<HashMap<usize, T>>>;

static COMPONENTS: List<Arc<Mutex<Component>>> = OnceLock::new();
static STATES: List<Arc<Instance>> = OnceLock::new();
/// Numbers look like pointers of 16 bytes, and are never given twice.
static NEXT: AtomicUsize = AtomicUsize::new(1);

fn add<T>(list: &List<T>, item: T) -> *mut c_void {
    let number = NEXT.fetch_add(1, Ordering::Relaxed) << 4;
    let all = list.get_or_init(Default::default);
    all.write().unwrap_or_else(PoisonError::into_inner).insert(number, item);
    std::ptr::without_provenance_mut(number)
}

fn find<T: Clone>(list: &List<T>, handle: *mut c_void) -> Option<T> {
    list.get()?.read().unwrap_or_else(PoisonError::into_inner).get(&handle.addr()).cloned()
}

fn remove<T>(list: &List<T>, handle: *mut c_void) -> Option<T> {
    list.get()?.write().unwrap_or_else(PoisonError::into_inner).remove(&handle.addr())
}

/// Makes a component; null, and told why, if it cannot be.
pub(super) fn create(tell: Tell, logs: bool, make: impl FnOnce() -> Result<Instance, Fail>) -> *mut c_void {
    let made = catch_unwind(AssertUnwindSafe(make)).unwrap_or_else(|_| Err(error("an error of the runtime itself")));
    match made {
        Ok(instance) => add(
            &COMPONENTS,
            Arc::new(Mutex::new(Component {
                instance,
                tell,
                logs,
                categories: vec![],
                texts: vec![],
                last: None,
                set_up: None,
                broken: false,
            })),
        ),
        Err(fail) => {
            let _ = catch_unwind(AssertUnwindSafe(|| tell(fail.status, "logStatusError", &fail.why)));
            std::ptr::null_mut()
        }
    }
}

/// Lets a component go; one that is none is no matter.
pub(super) fn free(handle: *mut c_void) {
    let _ = catch_unwind(AssertUnwindSafe(|| drop(remove(&COMPONENTS, handle))));
}

/// Does something with a component.
pub(super) fn with(handle: *mut c_void, what: impl FnOnce(&mut Component) -> Result<(), Fail>) -> i32 {
    let done = catch_unwind(AssertUnwindSafe(|| {
        let Some(shared) = find(&COMPONENTS, handle) else { return Status::Error };
        // Two threads at once, or a call out of a call.
        let mut component = match shared.try_lock() {
            Ok(component) => component,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return Status::Error,
        };
        let component = &mut *component;
        let result = if component.broken {
            Err(error("the runtime failed in this component before; free it and make another"))
        } else {
            catch_unwind(AssertUnwindSafe(|| what(component))).unwrap_or_else(|_| {
                component.broken = true;
                Err(error("an error of the runtime itself; please report it with the train file"))
            })
        };
        let wanted =
            |c: &Component, category: &str| c.categories.is_empty() || c.categories.iter().any(|w| w == category);
        for (category, message) in std::mem::take(&mut component.instance.news) {
            if (component.logs || category != "logEvents") && wanted(component, category) {
                (component.tell)(Status::Ok, category, &message);
            }
        }
        match result {
            Ok(()) => Status::Ok,
            Err(fail) => {
                (component.tell)(fail.status, "logStatusError", &fail.why);
                fail.status
            }
        }
    }));
    done.unwrap_or(Status::Error) as i32
}

/// Keeps a state for the host.
pub(super) fn keep(state: Instance) -> *mut c_void {
    add(&STATES, Arc::new(state))
}

/// A state that is kept.
pub(super) fn kept(handle: *mut c_void) -> Result<Arc<Instance>, Fail> {
    find(&STATES, handle).ok_or_else(|| error("there is no such state; it was freed, or never given"))
}

/// Lets a state go.
pub(super) fn release(handle: *mut c_void) {
    drop(remove(&STATES, handle));
}

/// Takes over a state that was kept, of the same unit and in the same use.
pub(super) fn back(component: &mut Component, state: &Instance) -> Result<(), Fail> {
    let own = &component.instance;
    if state.token != own.token || state.exchanges() != own.exchanges() {
        return Err(error("the state is one of another unit, or of another use of it"));
    }
    component.instance = state.clone();
    component.last = None;
    Ok(())
}
