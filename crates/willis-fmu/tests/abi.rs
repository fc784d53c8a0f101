//! The functions of C, called as a host calls them: rightly, wrongly and at the wrong time.

#![allow(unsafe_code, clippy::undocumented_unsafe_blocks)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::fs;
use std::path::{Path, PathBuf};
use std::ptr::{null, null_mut, without_provenance_mut};
use std::sync::Mutex;

use willis::dynamics::{Options, Simulation};
use willis::model::Model;
use willis_fmu::{Interface, Request, Version, pack};

type Handle = *mut c_void;
type Logger = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

unsafe extern "C" {
    fn fmi2GetVersion() -> *const c_char;
    fn fmi2Instantiate(
        name: *const c_char,
        kind: c_int,
        guid: *const c_char,
        resources: *const c_char,
        callbacks: *const c_void,
        visible: c_int,
        logging: c_int,
    ) -> Handle;
    fn fmi2SetupExperiment(c: Handle, has: c_int, tolerance: f64, start: f64, has_stop: c_int, stop: f64) -> c_int;
    fn fmi2EnterInitializationMode(c: Handle) -> c_int;
    fn fmi2ExitInitializationMode(c: Handle) -> c_int;
    fn fmi2GetReal(c: Handle, references: *const u32, count: usize, values: *mut f64) -> c_int;
    fn fmi2SetReal(c: Handle, references: *const u32, count: usize, values: *const f64) -> c_int;
    fn fmi2GetBoolean(c: Handle, references: *const u32, count: usize, values: *mut c_int) -> c_int;
    fn fmi2GetInteger(c: Handle, references: *const u32, count: usize, values: *mut c_int) -> c_int;
    fn fmi2GetString(c: Handle, references: *const u32, count: usize, values: *mut *const c_char) -> c_int;
    fn fmi2DoStep(c: Handle, time: f64, length: f64, keeps: c_int) -> c_int;
    fn fmi2Reset(c: Handle) -> c_int;
    fn fmi2Terminate(c: Handle) -> c_int;
    fn fmi2FreeInstance(c: Handle);
    fn fmi2GetFMUstate(c: Handle, state: *mut Handle) -> c_int;
    fn fmi2SetFMUstate(c: Handle, state: Handle) -> c_int;
    fn fmi2FreeFMUstate(c: Handle, state: *mut Handle) -> c_int;
    fn fmi2SerializedFMUstateSize(c: Handle, state: Handle, size: *mut usize) -> c_int;
    fn fmi2SerializeFMUstate(c: Handle, state: Handle, to: *mut u8, size: usize) -> c_int;
    fn fmi2DeSerializeFMUstate(c: Handle, from: *const u8, size: usize, state: *mut Handle) -> c_int;
    fn fmi2EnterEventMode(c: Handle) -> c_int;
    fn fmi2NewDiscreteStates(c: Handle, info: *mut EventInfo) -> c_int;
    fn fmi2EnterContinuousTimeMode(c: Handle) -> c_int;
    fn fmi2CompletedIntegratorStep(c: Handle, keeps: c_int, event: *mut c_int, terminate: *mut c_int) -> c_int;
    fn fmi2SetTime(c: Handle, time: f64) -> c_int;
    fn fmi2SetContinuousStates(c: Handle, states: *const f64, count: usize) -> c_int;
    fn fmi2GetContinuousStates(c: Handle, states: *mut f64, count: usize) -> c_int;
    fn fmi2GetDerivatives(c: Handle, rates: *mut f64, count: usize) -> c_int;
    fn fmi2GetEventIndicators(c: Handle, indicators: *mut f64, count: usize) -> c_int;
    fn fmi2GetNominalsOfContinuousStates(c: Handle, nominals: *mut f64, count: usize) -> c_int;
    fn fmi2GetDirectionalDerivative(
        c: Handle,
        unknowns: *const u32,
        unknown_count: usize,
        knowns: *const u32,
        known_count: usize,
        seed: *const f64,
        out: *mut f64,
    ) -> c_int;
    fn fmi3InstantiateModelExchange(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: u8,
        logging: u8,
        environment: *mut c_void,
        logger: Option<Logger>,
    ) -> Handle;
    fn fmi3EnterInitializationMode(c: Handle, has: u8, tolerance: f64, start: f64, has_stop: u8, stop: f64) -> c_int;
    fn fmi3ExitInitializationMode(c: Handle) -> c_int;
    fn fmi3EnterEventMode(c: Handle) -> c_int;
    fn fmi3EnterContinuousTimeMode(c: Handle) -> c_int;
    fn fmi3Terminate(c: Handle) -> c_int;
    fn fmi3UpdateDiscreteStates(
        c: Handle,
        again: *mut u8,
        terminate: *mut u8,
        nominals: *mut u8,
        values: *mut u8,
        has_next: *mut u8,
        next: *mut f64,
    ) -> c_int;
    fn fmi3CompletedIntegratorStep(c: Handle, keeps: u8, event: *mut u8, terminate: *mut u8) -> c_int;
    fn fmi3SetTime(c: Handle, time: f64) -> c_int;
    fn fmi3GetEventIndicators(c: Handle, indicators: *mut f64, count: usize) -> c_int;
    fn fmi3GetNominalsOfContinuousStates(c: Handle, nominals: *mut f64, count: usize) -> c_int;
    fn fmi3GetNumberOfEventIndicators(c: Handle, count: *mut usize) -> c_int;
    fn fmi3GetFloat64(c: Handle, references: *const u32, count: usize, values: *mut f64, values_count: usize) -> c_int;
    fn fmi3GetInt64(c: Handle, references: *const u32, count: usize, values: *mut i64, values_count: usize) -> c_int;
    fn fmi3GetString(
        c: Handle,
        references: *const u32,
        count: usize,
        values: *mut *const c_char,
        values_count: usize,
    ) -> c_int;
    fn fmi3GetFMUState(c: Handle, state: *mut Handle) -> c_int;
    fn fmi3SetFMUState(c: Handle, state: Handle) -> c_int;
    fn fmi3FreeFMUState(c: Handle, state: *mut Handle) -> c_int;
    fn fmi3SerializedFMUStateSize(c: Handle, state: Handle, size: *mut usize) -> c_int;
    fn fmi3SerializeFMUState(c: Handle, state: Handle, to: *mut u8, size: usize) -> c_int;
    fn fmi3DeserializeFMUState(c: Handle, from: *const u8, size: usize, state: *mut Handle) -> c_int;
    fn fmi3GetContinuousStates(c: Handle, states: *mut f64, count: usize) -> c_int;
    fn fmi3SetContinuousStates(c: Handle, states: *const f64, count: usize) -> c_int;
    fn fmi3GetContinuousStateDerivatives(c: Handle, rates: *mut f64, count: usize) -> c_int;
    fn fmi3GetNumberOfContinuousStates(c: Handle, count: *mut usize) -> c_int;
    fn fmi3GetDirectionalDerivative(
        c: Handle,
        unknowns: *const u32,
        unknown_count: usize,
        knowns: *const u32,
        known_count: usize,
        seed: *const f64,
        seed_count: usize,
        out: *mut f64,
        out_count: usize,
    ) -> c_int;
    fn fmi3FreeInstance(c: Handle);
}

/// `fmi2EventInfo`
#[repr(C)]
#[derive(Debug, Default)]
struct EventInfo {
    again: c_int,
    terminate: c_int,
    nominals: c_int,
    values: c_int,
    has_next: c_int,
    next: f64,
}

const OK: c_int = 0;
const DISCARD: c_int = 2;
const ERROR: c_int = 3;

/// A motor, a set that loses, a brake that slips and holds, and a load that follows the speed.
const TRAIN: &str = include_str!("winch.toml");

/// A flywheel on a shaft, whose other end is turned at a speed that jumps.
const JUMP: &str = r#"
format = 1
name = "jump"
members = ["a", "b"]
terminals = ["a", "b"]
inertias = { b = "2 kg m^2" }

[[shaft]]
name = "s"
members = ["a", "b"]
stiffness = "1000 N m/rad"
damping = "1 N m s/rad"

[[scenario]]
name = "jump"
duration = "1 s"
initial_speeds = { b = "1 rad/s" }

[[scenario.source]]
name = "motor"
member = "a"
speed = { type = "table", points = [["0 s", "1 rad/s"], ["0.5 s", "1 rad/s"], ["0.5 s", "9 rad/s"]] }
"#;

/// A unit that was unpacked.
struct Unit {
    folder: PathBuf,
    token: CString,
    resources: CString,
    description: String,
}

impl Drop for Unit {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Files of an archive.
fn unpacked(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let number = |at: usize, count: usize| bytes[at..at + count].iter().rev().fold(0, |x, b| x << 8 | usize::from(*b));
    let (mut all, mut at) = (vec![], 0);
    while bytes[at..].starts_with(b"PK\x03\x04") {
        let (method, size, name) = (number(at + 8, 2), number(at + 18, 4), number(at + 26, 2));
        let from = at + 30 + name;
        let body = &bytes[from..from + size];
        let body = match method {
            0 => body.to_vec(),
            _ => miniz_oxide::inflate::decompress_to_vec(body).unwrap(),
        };
        assert_eq!(body.len(), number(at + 22, 4));
        all.push((String::from_utf8(bytes[at + 30..from].to_vec()).unwrap(), body));
        at = from + size;
    }
    all
}

fn packed(version: Version, interface: Interface) -> Vec<u8> {
    packed_of(TRAIN, version, interface)
}

fn packed_of(train: &str, version: Version, interface: Interface) -> Vec<u8> {
    let model = Model::from_toml(train).unwrap();
    let request = Request { scenario: None, version, interface, library: b"the runtime" };
    pack(&model, &request).unwrap().bytes
}

impl Unit {
    fn new(name: &str, version: Version, interface: Interface) -> Self {
        Self::of_train(TRAIN, name, version, interface)
    }

    fn of_train(train: &str, name: &str, version: Version, interface: Interface) -> Self {
        let folder = std::env::temp_dir().join(format!("willis fmu {name} {}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        let mut description = String::new();
        for (file, bytes) in unpacked(&packed_of(train, version, interface)) {
            if file == "modelDescription.xml" {
                description = String::from_utf8(bytes.clone()).unwrap();
            }
            let path = folder.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
        let after =
            |mark: &str| description.split(mark).nth(1).and_then(|rest| rest.split('"').next()).unwrap().to_owned();
        let mark = if version == Version::Two { "guid=\"" } else { "instantiationToken=\"" };
        let resources = folder.join("resources").to_str().unwrap().to_owned();
        let resources =
            if version == Version::Two { format!("file://{}", resources.replace(' ', "%20")) } else { resources };
        Self {
            token: CString::new(after(mark)).unwrap(),
            resources: CString::new(resources).unwrap(),
            folder,
            description,
        }
    }

    /// The reference of a variable.
    fn of(&self, name: &str) -> u32 {
        let document = roxmltree::Document::parse(&self.description).unwrap();
        let found =
            document.descendants().find(|n| n.attribute("name") == Some(name) && n.has_attribute("valueReference"));
        found.unwrap_or_else(|| panic!("{name}")).attribute("valueReference").unwrap().parse().unwrap()
    }

    fn two(&self, kind: c_int) -> Handle {
        unsafe { fmi2Instantiate(c"one".as_ptr(), kind, self.token.as_ptr(), self.resources.as_ptr(), null(), 0, 0) }
    }

    /// One for a host that integrates and listens.
    fn three(&self, told: &Told) -> Handle {
        let (name, environment) = (c"one".as_ptr(), std::ptr::from_ref(told).cast_mut().cast());
        let (token, resources) = (self.token.as_ptr(), self.resources.as_ptr());
        unsafe { fmi3InstantiateModelExchange(name, token, resources, 0, 1, environment, Some(listen)) }
    }

    /// One that is at its start.
    fn started(&self) -> Handle {
        let c = self.two(1);
        assert!(!c.is_null());
        unsafe {
            assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), OK);
            assert_eq!(fmi2EnterInitializationMode(c), OK);
            assert_eq!(fmi2ExitInitializationMode(c), OK);
        }
        c
    }
}

fn real(c: Handle, reference: u32) -> f64 {
    let mut value = f64::NAN;
    assert_eq!(unsafe { fmi2GetReal(c, &raw const reference, 1, &raw mut value) }, OK);
    value
}

fn steps(c: Handle, from: usize, to: usize) {
    for k in from..to {
        assert_eq!(unsafe { fmi2DoStep(c, 0.01 * k as f64, 0.01, 1) }, OK);
    }
}

#[test]
fn a_unit_is_the_same_bytes_every_time() {
    for version in [Version::Two, Version::Three] {
        assert_eq!(packed(version, Interface::Both), packed(version, Interface::Both));
    }
}

#[test]
fn descriptions_point_to_what_they_mean() {
    for (version, interface) in
        [Version::Two, Version::Three].into_iter().flat_map(|v| [(v, Interface::CoSimulation), (v, Interface::Both)])
    {
        let files = unpacked(&packed(version, interface));
        let text = String::from_utf8(files[0].1.clone()).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let tag = |name: &str| document.descendants().filter(|n| n.has_tag_name(name)).collect::<Vec<_>>();
        let variables: Vec<_> = document.descendants().filter(|n| n.has_attribute("causality")).collect();
        let mut names: Vec<_> = variables.iter().map(|v| v.attribute("name").unwrap()).collect();
        for (k, v) in variables.iter().enumerate() {
            let first = usize::from(version == Version::Two);
            assert_eq!(v.attribute("valueReference").unwrap(), (k + first).to_string());
        }
        for name in [
            "P1.sun.teeth",
            "initial_speeds.drum",
            "drive",
            "engagement.B",
            "drum.speed",
            "B.mode",
            "P1.sun-planet.loss",
            "verdict",
        ] {
            assert!(names.contains(&name), "{name} is not among {names:?}");
        }
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), variables.len());
        let rates: Vec<String> = match version {
            Version::Two => tag("Derivatives")
                .iter()
                .flat_map(|d| d.children())
                .filter_map(|u| u.attribute("index"))
                .map(str::to_owned)
                .collect(),
            Version::Three => tag("ContinuousStateDerivative")
                .iter()
                .filter_map(|u| u.attribute("valueReference"))
                .map(str::to_owned)
                .collect(),
        };
        // Two speeds and two angles are the motion of a set.
        assert_eq!(rates.len(), if interface == Interface::Both { 4 } else { 0 });
        assert_eq!(tag("ModelExchange").len(), usize::from(interface == Interface::Both));
    }
}

#[test]
fn steps_are_those_of_the_library() {
    let unit = Unit::new("steps", Version::Two, Interface::Both);
    let (drum, mode, angle) = (unit.of("drum.speed"), unit.of("P1.planet-ring.torque"), unit.of("motor.angle"));
    let c = unit.started();
    let model = Model::from_toml(TRAIN).unwrap();
    let mut run = Simulation::new(model.train(), "lift", &Options::default()).unwrap();
    for k in 0..200 {
        steps(c, k, k + 1);
        run.advance(0.01 * (k + 1) as f64, &mut ());
        assert!((real(c, drum) - run.speed("drum").unwrap()).abs() < 1e-8, "step {k}");
        assert!((real(c, angle) - run.angle("motor").unwrap()).abs() < 1e-8);
        assert!(real(c, mode).is_finite());
    }
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn a_state_that_was_saved_goes_on_to_the_last_bit() {
    let unit = Unit::new("state", Version::Two, Interface::CoSimulation);
    let drum = unit.of("drum.speed");
    let c = unit.started();
    steps(c, 0, 37);
    let (mut state, mut size) = (null_mut(), 0);
    let mut bytes;
    unsafe {
        assert_eq!(fmi2GetFMUstate(c, &raw mut state), OK);
        assert_eq!(fmi2SerializedFMUstateSize(c, state, &raw mut size), OK);
        bytes = vec![0u8; size];
        assert_eq!(fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr(), size - 1), ERROR);
        assert_eq!(fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr(), size), OK);
    }
    steps(c, 37, 200);
    let end = real(c, drum);
    unsafe {
        // Back in the same one.
        assert_eq!(fmi2SetFMUstate(c, state), OK);
        steps(c, 37, 200);
        assert_eq!(real(c, drum).to_bits(), end.to_bits());
        assert_eq!(fmi2FreeFMUstate(c, &raw mut state), OK);
        assert!(state.is_null());
        fmi2FreeInstance(c);
        // In one that was made anew, and never began.
        let c = unit.two(1);
        assert_eq!(fmi2DeSerializeFMUstate(c, bytes.as_ptr(), size, &raw mut state), OK);
        assert_eq!(fmi2SetFMUstate(c, state), OK);
        steps(c, 37, 200);
        assert_eq!(real(c, drum).to_bits(), end.to_bits());
        // No byte of it may be another without being noticed or harmless.
        for k in (0..size).step_by(size / 60) {
            let mut wrong = bytes.clone();
            wrong[k] ^= 0x55;
            let mut other = null_mut();
            if fmi2DeSerializeFMUstate(c, wrong.as_ptr(), size, &raw mut other) == OK {
                assert_eq!(fmi2SetFMUstate(c, other), OK);
                let status = fmi2DoStep(c, 0.37, 0.01, 1);
                assert!([OK, DISCARD, ERROR].contains(&status));
                fmi2FreeFMUstate(c, &raw mut other);
            }
        }
        for cut in [0, 1, 9, size / 2, size - 1] {
            let mut other = null_mut();
            assert_eq!(fmi2DeSerializeFMUstate(c, bytes.as_ptr(), cut, &raw mut other), ERROR);
        }
        fmi2FreeInstance(c);
    }
}

#[test]
fn inputs_and_parameters_have_their_time() {
    let unit = Unit::new("inputs", Version::Two, Interface::CoSimulation);
    let (drive, teeth, inertia) = (unit.of("drive"), unit.of("P1.sun.teeth"), unit.of("inertias.drum"));
    let drum = unit.of("drum.speed");
    let set = |c, reference: u32, value: f64| unsafe { fmi2SetReal(c, &raw const reference, 1, &raw const value) };
    let c = unit.two(1);
    assert_eq!(real(c, inertia), 1.5);
    assert_eq!(set(c, inertia, 3.0), OK);
    assert_eq!(set(c, inertia, f64::NAN), ERROR);
    assert_eq!(set(c, teeth, 20.0), ERROR, "a number of teeth is a whole number");
    assert_eq!(set(c, drum, 1.0), ERROR, "a result cannot be set");
    unsafe {
        assert_eq!(fmi2DoStep(c, 0.0, 0.1, 1), ERROR, "not before initialization");
        let mut value = 0.0;
        assert_eq!(fmi2GetReal(c, &raw const drum, 1, &raw mut value), ERROR, "nor a result");
        assert_eq!(fmi2EnterInitializationMode(c), OK);
        assert_eq!(fmi2EnterInitializationMode(c), ERROR);
        assert_eq!(real(c, drum), 2.0);
        assert_eq!(set(c, drive, 5.0), OK);
        assert_eq!(fmi2ExitInitializationMode(c), OK);
        assert_eq!(set(c, inertia, 2.0), ERROR, "a parameter is fixed from here on");
        assert_eq!(set(c, drive, 7.0), OK);
        assert_eq!(real(c, drive), 7.0);
        for (time, length) in
            [(0.0, 0.0), (0.0, -1.0), (0.0, f64::NAN), (f64::NAN, 0.1), (0.5, 0.1), (0.0, f64::INFINITY)]
        {
            assert_eq!(fmi2DoStep(c, time, length, 1), ERROR, "{time} {length}");
        }
        steps(c, 0, 3);
        let heavy = real(c, drum);
        assert_eq!(fmi2Reset(c), OK);
        assert_eq!(real(c, inertia), 1.5);
        assert_eq!(fmi2EnterInitializationMode(c), OK);
        assert_eq!(set(c, drive, 5.0), OK);
        assert_eq!(fmi2ExitInitializationMode(c), OK);
        assert_eq!(set(c, drive, 7.0), OK);
        steps(c, 0, 3);
        assert!((real(c, drum) - heavy).abs() > 1e-3);
        assert_eq!(fmi2Terminate(c), OK);
        assert_eq!(fmi2DoStep(c, 0.03, 0.01, 1), ERROR);
        fmi2FreeInstance(c);
        // Freed: an error, and no crash.
        assert_eq!(fmi2DoStep(c, 0.03, 0.01, 1), ERROR);
        fmi2FreeInstance(c);
    }
}

#[test]
fn what_leads_nowhere_is_an_error() {
    let unit = Unit::new("nowhere", Version::Two, Interface::CoSimulation);
    let c = unit.started();
    let mut value = 0.0;
    unsafe {
        for handle in [null_mut(), without_provenance_mut(8), without_provenance_mut(usize::MAX)] {
            assert_eq!(fmi2DoStep(handle, 0.0, 0.1, 1), ERROR);
            assert_eq!(fmi2SetFMUstate(c, handle), ERROR);
            fmi2FreeInstance(handle);
        }
        assert_eq!(fmi2GetReal(c, null(), 1, &raw mut value), ERROR);
        assert_eq!(fmi2GetReal(c, &1, 1, null_mut()), ERROR);
        assert_eq!(fmi2GetReal(c, null(), 0, null_mut()), OK);
        assert_eq!(fmi2GetReal(c, &u32::MAX, 1, &raw mut value), ERROR);
        assert_eq!(fmi2GetReal(c, &1, usize::MAX, &raw mut value), ERROR);
        assert_eq!(fmi2GetBoolean(c, &1, 1, null_mut()), ERROR);
        assert_eq!(fmi2GetFMUstate(c, null_mut()), ERROR);
        assert_eq!(fmi2SerializedFMUstateSize(c, null_mut(), null_mut()), ERROR);
        let why = unit.of("verdict.why");
        let mut text = null();
        assert_eq!(fmi2GetString(c, &raw const why, 1, &raw mut text), OK);
        assert_eq!(CStr::from_ptr(text), c"");
        assert_eq!(CStr::from_ptr(fmi2GetVersion()), c"2.0");
        for (name, kind, guid, resources) in [
            (null(), 1, unit.token.as_ptr(), unit.resources.as_ptr()),
            (c"a".as_ptr(), 7, unit.token.as_ptr(), unit.resources.as_ptr()),
            (c"a".as_ptr(), 1, c"{wrong}".as_ptr(), unit.resources.as_ptr()),
            (c"a".as_ptr(), 1, null(), unit.resources.as_ptr()),
            (c"a".as_ptr(), 1, unit.token.as_ptr(), null()),
            (c"a".as_ptr(), 1, unit.token.as_ptr(), c"file:///nowhere/at/all".as_ptr()),
            // The unit is for co-simulation only.
            (c"a".as_ptr(), 0, unit.token.as_ptr(), unit.resources.as_ptr()),
        ] {
            assert!(fmi2Instantiate(name, kind, guid, resources, null(), 0, 0).is_null());
        }
        fmi2FreeInstance(c);
    }
}

/// What was told.
type Told = Mutex<Vec<String>>;

unsafe extern "C" fn listen(environment: *mut c_void, status: c_int, category: *const c_char, message: *const c_char) {
    let told: &Told = unsafe { &*environment.cast() };
    let [category, message] = [category, message].map(|text| unsafe { CStr::from_ptr(text) }.to_str().unwrap());
    told.lock().unwrap().push(format!("{status} {category} {message}"));
}

#[test]
fn changed_resources_are_told_and_refused() {
    let unit = Unit::new("changed", Version::Three, Interface::Both);
    let all = Told::default();
    let make = || unit.three(&all);
    let of = |name: &str| Path::new(unit.resources.to_str().unwrap()).join(name);
    let told = |part: &str| {
        let told = std::mem::take(&mut *all.lock().unwrap());
        assert!(told.iter().any(|t| t.contains(part)), "{part}: {told:?}");
    };
    let c = make();
    assert!(!c.is_null());
    unsafe { fmi3FreeInstance(c) };
    for (file, text, part) in [
        ("train.toml", TRAIN.replace("0.98", "0.97"), "not those that the unit was exported with"),
        ("train.toml", String::new(), "not those"),
        ("unit.json", "{".to_owned(), "export the unit anew"),
        ("unit.json", "{\"format\": \"willis-fmu-9\"}".to_owned(), "export the unit anew"),
    ] {
        let before = fs::read(of(file)).unwrap();
        fs::write(of(file), text).unwrap();
        assert!(make().is_null());
        told(part);
        fs::write(of(file), [0xff, 0xfe, 0]).unwrap();
        assert!(make().is_null());
        fs::remove_file(of(file)).unwrap();
        assert!(make().is_null());
        fs::write(of(file), before).unwrap();
    }
    assert!(!make().is_null());
}

#[test]
fn a_host_that_integrates_gets_rates_and_derivatives() {
    let unit = Unit::new("rates", Version::Three, Interface::Both);
    unsafe {
        let c = fmi3InstantiateModelExchange(
            c"one".as_ptr(),
            unit.token.as_ptr(),
            unit.resources.as_ptr(),
            0,
            0,
            null_mut(),
            None,
        );
        assert_eq!(fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0), OK);
        assert_eq!(fmi3ExitInitializationMode(c), OK);
        assert_eq!(fmi3EnterContinuousTimeMode(c), OK);
        assert_eq!(fmi3EnterContinuousTimeMode(c), ERROR);
        let mut count = 0;
        assert_eq!(fmi3GetNumberOfContinuousStates(c, &raw mut count), OK);
        let (mut states, mut rates) = (vec![0.0; count], vec![0.0; count]);
        assert_eq!(fmi3GetContinuousStates(c, states.as_mut_ptr(), count), OK);
        assert_eq!(fmi3GetContinuousStates(c, states.as_mut_ptr(), count - 1), ERROR);
        assert_eq!(fmi3GetContinuousStateDerivatives(c, rates.as_mut_ptr(), count), OK);
        assert!(rates.iter().all(|x| x.is_finite()));
        // Twice the torque of the drive, by its derivative and at once: within the mode that is linear.
        let (drive, rate) = (unit.of("drive"), unit.of("der(state.motor.speed)"));
        let mut by = [0.0];
        assert_eq!(
            fmi3GetDirectionalDerivative(c, &raw const rate, 1, &raw const drive, 1, &2.0, 1, by.as_mut_ptr(), 1),
            OK
        );
        let mut again = vec![0.0; count];
        assert_eq!(fmi3GetContinuousStateDerivatives(c, again.as_mut_ptr(), count), OK);
        assert_eq!(rates, again, "nothing has changed by it");
        assert!(by[0].abs() > 1.0, "{by:?}");
        let wrong = [unit.of("verdict"), u32::MAX];
        assert_eq!(
            fmi3GetDirectionalDerivative(c, wrong.as_ptr(), 1, &raw const drive, 1, &2.0, 1, by.as_mut_ptr(), 1),
            ERROR
        );
        assert_eq!(
            fmi3GetDirectionalDerivative(c, wrong[1..].as_ptr(), 1, &raw const drive, 1, &2.0, 1, by.as_mut_ptr(), 1),
            ERROR
        );
        states[0] = f64::INFINITY;
        assert_eq!(fmi3SetContinuousStates(c, states.as_ptr(), count), DISCARD);
        fmi3FreeInstance(c);
    }
}

/// Instances are as many as a host likes, each in a thread of its own; one in two threads at once is refused or done, and
/// never mixed up.
#[test]
fn many_instances_in_many_threads() {
    let unit = Unit::new("many", Version::Two, Interface::CoSimulation);
    let drum = unit.of("drum.speed");
    let one = unit.started();
    steps(one, 0, 20);
    let wanted = real(one, drum).to_bits();
    let shared = one as usize;
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..25 {
                    let c = unit.started();
                    steps(c, 0, 20);
                    assert_eq!(real(c, drum).to_bits(), wanted);
                    let status = unsafe { fmi2DoStep(shared as Handle, 0.2, 0.01, 1) };
                    assert!([OK, ERROR].contains(&status));
                    unsafe { fmi2FreeInstance(c) };
                }
            });
        }
    });
    unsafe { fmi2FreeInstance(one) };
}

/// The states of one that integrates, and references.
fn states_of(c: Handle) -> Vec<f64> {
    let mut count = 0;
    assert_eq!(unsafe { fmi3GetNumberOfContinuousStates(c, &raw mut count) }, OK);
    let mut states = vec![0.0; count];
    assert_eq!(unsafe { fmi3GetContinuousStates(c, states.as_mut_ptr(), count) }, OK);
    states
}

fn derivative(c: Handle, unknown: u32, knowns: &[u32], seed: &[f64]) -> Result<f64, c_int> {
    let mut out = 0.0;
    let (count, by) = (knowns.len(), seed.as_ptr());
    let known = knowns.as_ptr();
    match unsafe {
        fmi3GetDirectionalDerivative(c, &raw const unknown, 1, known, count, by, seed.len(), &raw mut out, 1)
    } {
        OK => Ok(out),
        status => Err(status),
    }
}

#[test]
fn a_derivative_takes_states_and_inputs_in_any_order_and_changes_nothing() {
    let unit = Unit::new("directions", Version::Three, Interface::ModelExchange);
    let (speed, drive) = (unit.of("state.motor.speed"), unit.of("drive"));
    let (turning, faster) = (unit.of("der(state.motor.angle)"), unit.of("der(state.motor.speed)"));
    let told = Told::default();
    let c = unit.three(&told);
    let all = || {
        let of_input = derivative(c, faster, &[drive], &[2.0]).unwrap();
        assert!(of_input.abs() > 1.0, "{of_input}");
        for knowns in [[speed, drive], [drive, speed]] {
            let seed = |of_speed: f64, of_drive: f64| {
                if knowns[0] == speed { [of_speed, of_drive] } else { [of_drive, of_speed] }
            };
            let turns = derivative(c, turning, &knowns, &seed(1.0, 1.0)).unwrap();
            assert!((turns - 1.0).abs() < 1e-9, "the rate of an angle is a speed: {turns}");
            let both = derivative(c, faster, &knowns, &seed(0.0, 2.0)).unwrap();
            assert!((both - of_input).abs() < 1e-9 * of_input.abs(), "{both} {of_input}");
            // A direction that is none.
            let before = states_of(c);
            assert_eq!(derivative(c, faster, &knowns, &seed(1.0, f64::NAN)), Err(ERROR));
            assert_eq!(states_of(c), before, "what went wrong leaves nothing behind");
        }
    };
    unsafe {
        assert_eq!(fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0), OK);
        all();
        // States that a host gave are not lost by that.
        let mut given = states_of(c);
        given[0] += 0.25;
        assert_eq!(fmi3SetContinuousStates(c, given.as_ptr(), given.len()), OK);
        all();
        assert_eq!(states_of(c), given);
        assert_eq!(fmi3ExitInitializationMode(c), OK);
        all();
        assert_eq!(fmi3EnterContinuousTimeMode(c), OK);
        all();
        assert_eq!(fmi3Terminate(c), OK);
        all();
        fmi3FreeInstance(c);
    }
}

#[test]
fn states_are_read_after_the_end_and_set_no_more() {
    let unit = Unit::new("after", Version::Two, Interface::Both);
    let c = unit.two(0);
    let (mut count, mut indicators) = (0, 0);
    unsafe {
        assert_eq!(fmi3GetNumberOfContinuousStates(c, &raw mut count), OK);
        assert_eq!(fmi3GetNumberOfEventIndicators(c, &raw mut indicators), OK);
    }
    let read = || unsafe {
        let (mut of_states, mut of_indicators) = (vec![0.0; count], vec![0.0; indicators]);
        let x = of_states.as_mut_ptr();
        [
            fmi2GetContinuousStates(c, x, count),
            fmi2GetDerivatives(c, x, count),
            fmi2GetEventIndicators(c, of_indicators.as_mut_ptr(), indicators),
            fmi2GetNominalsOfContinuousStates(c, x, count),
        ]
    };
    let (unknown, known, mut out) = (unit.of("der(state.motor.speed)"), unit.of("drive"), 0.0);
    unsafe {
        assert_eq!(read(), [ERROR, ERROR, ERROR, OK], "before initialization there are nominal values alone");
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), OK);
        assert_eq!(fmi2EnterInitializationMode(c), OK);
        assert_eq!(fmi2ExitInitializationMode(c), OK);
        assert_eq!(fmi2NewDiscreteStates(c, &mut EventInfo::default()), OK);
        assert_eq!(fmi2EnterContinuousTimeMode(c), OK);
        let states = states_of(c);
        assert_eq!(fmi2SetTime(c, 0.001), OK);
        assert_eq!(fmi2SetContinuousStates(c, states.as_ptr(), count), OK);
        assert_eq!(fmi2Terminate(c), OK);
        assert_eq!(read(), [OK; 4]);
        assert_eq!(states_of(c), states);
        let (unknown, known) = (&raw const unknown, &raw const known);
        assert_eq!(fmi2GetDirectionalDerivative(c, unknown, 1, known, 1, &2.0, &raw mut out), OK);
        assert!(out.abs() > 1.0, "{out}");
        assert_eq!(fmi2SetContinuousStates(c, states.as_ptr(), count), ERROR);
        assert_eq!(fmi2SetTime(c, 0.002), ERROR);
        assert_eq!(fmi2NewDiscreteStates(c, &mut EventInfo::default()), ERROR);
        assert_eq!(fmi2Terminate(c), ERROR);
        fmi2FreeInstance(c);
    }
}

/// The host is told to end, and why is there to be read.
#[test]
fn a_motion_that_cannot_go_on_ends_the_run_of_the_host() {
    let unit = Unit::of_train(JUMP, "jump three", Version::Three, Interface::Both);
    let told = Told::default();
    let c = unit.three(&told);
    let warnings = || told.lock().unwrap().iter().filter(|t| t.contains("logStatusWarning")).count();
    let [mut again, mut terminate, mut nominals, mut values, mut has_next, mut event] = [9; 6];
    let mut next = 0.0;
    let mut update = || unsafe {
        let [a, t, n, v, h] =
            [&raw mut again, &raw mut terminate, &raw mut nominals, &raw mut values, &raw mut has_next];
        (fmi3UpdateDiscreteStates(c, a, t, n, v, h, &raw mut next), *t, *h, next)
    };
    unsafe {
        assert_eq!(fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0), OK);
        assert_eq!(fmi3ExitInitializationMode(c), OK);
        assert_eq!(update(), (OK, 0, 1, 0.5));
        assert_eq!(fmi3EnterContinuousTimeMode(c), OK);
        assert_eq!(fmi3SetTime(c, 0.5), OK);
        let mut terminate = 9;
        assert_eq!(fmi3CompletedIntegratorStep(c, 1, &raw mut event, &raw mut terminate), OK);
        assert_eq!((event, terminate), (1, 0));
        assert_eq!(fmi3EnterEventMode(c), OK);
        assert_eq!(warnings(), 0);
        assert_eq!(update(), (OK, 1, 0, 0.0));
        assert_eq!(update(), (OK, 1, 0, 0.0));
        assert_eq!(warnings(), 1, "{:?}", told.lock().unwrap());
        assert!(told.lock().unwrap().iter().any(|t| t.contains("the run stopped at an impact")));
        let (verdict, why) = (unit.of("verdict"), unit.of("verdict.why"));
        let (mut number, mut text) = (0, null());
        assert_eq!(fmi3GetInt64(c, &raw const verdict, 1, &raw mut number, 1), OK);
        assert_eq!(number, 6);
        assert_eq!(fmi3GetString(c, &raw const why, 1, &raw mut text, 1), OK);
        let words = CStr::from_ptr(text).to_str().unwrap();
        assert!(words.starts_with("the speed prescribed for a jumps from 1 to 9 rad/s"), "{words}");
        // A host that goes on all the same is told again.
        assert_eq!(fmi3EnterContinuousTimeMode(c), OK);
        assert_eq!(fmi3CompletedIntegratorStep(c, 1, &raw mut event, &raw mut terminate), OK);
        assert_eq!((event, terminate), (0, 1));
        let mut indicators = 0;
        assert_eq!(fmi3GetNumberOfEventIndicators(c, &raw mut indicators), OK);
        assert_eq!(fmi3GetEventIndicators(c, vec![0.0; indicators].as_mut_ptr(), indicators), OK);
        assert_eq!(fmi3Terminate(c), OK);
        assert_eq!(fmi3GetInt64(c, &raw const verdict, 1, &raw mut number, 1), OK);
        assert_eq!(number, 6);
        fmi3FreeInstance(c);
    }
    let unit = Unit::of_train(JUMP, "jump two", Version::Two, Interface::Both);
    let c = unit.two(0);
    let (mut info, verdict, mut number) = (EventInfo::default(), unit.of("verdict"), 0);
    let [mut event, mut terminate] = [9; 2];
    unsafe {
        assert_eq!(fmi2EnterInitializationMode(c), OK);
        assert_eq!(fmi2ExitInitializationMode(c), OK);
        assert_eq!(fmi2NewDiscreteStates(c, &raw mut info), OK);
        assert_eq!((info.terminate, info.has_next, info.next), (0, 1, 0.5));
        assert_eq!(fmi2EnterContinuousTimeMode(c), OK);
        assert_eq!(fmi2SetTime(c, 0.5), OK);
        assert_eq!(fmi2CompletedIntegratorStep(c, 1, &raw mut event, &raw mut terminate), OK);
        assert_eq!((event, terminate), (1, 0));
        assert_eq!(fmi2EnterEventMode(c), OK);
        assert_eq!(fmi2NewDiscreteStates(c, &raw mut info), OK);
        assert_eq!((info.again, info.terminate, info.has_next), (0, 1, 0));
        assert_eq!(fmi2GetInteger(c, &raw const verdict, 1, &raw mut number), OK);
        assert_eq!(number, 6);
        assert_eq!(fmi2EnterContinuousTimeMode(c), OK);
        assert_eq!(fmi2CompletedIntegratorStep(c, 1, &raw mut event, &raw mut terminate), OK);
        assert_eq!((event, terminate), (0, 1));
        fmi2FreeInstance(c);
    }
}

/// What both versions have does the same under both names.
#[test]
fn states_and_values_of_version_three() {
    let unit = Unit::new("both", Version::Two, Interface::CoSimulation);
    let drum = unit.of("drum.speed");
    let c = unit.started();
    steps(c, 0, 20);
    let (mut state, mut other, mut size, mut value) = (null_mut(), null_mut(), 0, 0.0);
    unsafe {
        assert_eq!(fmi3GetFMUState(c, &raw mut state), OK);
        assert_eq!(fmi3SerializedFMUStateSize(c, state, &raw mut size), OK);
        let mut bytes = [vec![0; size], vec![0; size]];
        assert_eq!(fmi3SerializeFMUState(c, state, bytes[0].as_mut_ptr(), size), OK);
        assert_eq!(fmi2SerializeFMUstate(c, state, bytes[1].as_mut_ptr(), size), OK);
        assert_eq!(bytes[0], bytes[1]);
        let before = real(c, drum);
        steps(c, 20, 30);
        assert_eq!(fmi3DeserializeFMUState(c, bytes[0].as_ptr(), size, &raw mut other), OK);
        assert_eq!(fmi3SetFMUState(c, other), OK);
        assert_eq!(fmi3GetFloat64(c, &raw const drum, 1, &raw mut value, 2), ERROR, "no variable is an array");
        assert_eq!(fmi3GetFloat64(c, &raw const drum, 1, &raw mut value, 1), OK);
        assert_eq!(value.to_bits(), before.to_bits());
        for state in [&raw mut state, &raw mut other, null_mut()] {
            assert_eq!(fmi3FreeFMUState(c, state), OK);
        }
        assert_eq!(fmi3SetFMUState(c, other), ERROR);
        assert_eq!(fmi3GetNominalsOfContinuousStates(c, &raw mut value, 1), ERROR, "the unit advances itself");
        assert_eq!(fmi3Terminate(c), OK);
        fmi2FreeInstance(c);
    }
}
