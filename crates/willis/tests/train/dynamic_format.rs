//! The dynamic layer of the train file: what a complete file reads to, and what is said of a wrong one.

use std::f64::consts::PI;

use proptest::prelude::*;
use willis::diagnostic::{Code, Diagnostics, Severity};
use willis::train::{
    Contact, DragSpec, FRAME, GearSpec, LossRow, LossRowSpec, MeshSpec, PlanetBodySpec, Reading, ScenarioSpec, SetSpec,
    ShaftSpec, ShiftElementSpec, Signal, SignalSpec, SourceKind, SourceSpec, StateSpec, Train,
};
use willis::units::{Angle, AngularSpeed, Force, Length, Mass, MomentOfInertia, Time, Torque, ViscousCoefficient};

/// One of everything.
const FULL: &str = r#"format = 1
name = "everything that moves"
members = ["sun", "ring", "c", "a", "b", "cage", "left", "right"]
terminals = ["sun", "c"]

[inertias]
sun = "0.05 kg m^2"
ring = "500 g cm^2"
"D.planet" = "1e-4 kg m^2"

[[set]]
name = "P"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4, mass = "0.25 kg", inertia = "6e-5 kg m^2", orbit_radius = "51 mm" }
ring = { member = "ring", teeth = 70 }
carrier = "c"
mesh_efficiency = 0.99

[[set]]
name = "Q"
sun = { member = "sun", teeth = 30 }
planet = { teeth = 20, count = 4, mass = "0.5 kg" }
ring = { member = "frame", teeth = 70 }
carrier = "c"
geometry = { module = "2 mm", width = "20 mm" }

[[set]]
name = "D"
type = "bevel"
sides = [ { member = "left", teeth = 16 }, { member = "right", teeth = 16 } ]
planet = { teeth = 10, count = 2 }
carrier = "cage"
mesh_efficiency = 0.98

[[mesh]]
name = "final"
gears = [ { member = "a", teeth = 20 }, { member = "b", teeth = 40 } ]
loss_table = [
  { speed = "0 rad/s", forward = 0.5, backward = 0.4, forward_torque = "0.1 N m" },
  { speed = "100 rad/s", forward = 0.9, backward = 0.8, forward_torque = "0.2 N m", backward_torque = "0.3 N m" },
]

[[drag]]
name = "carrier bearing"
members = ["c"]
coulomb = "0.5 N m"
viscous = "3 N m s/rad"
peak = 1.1

[[drag]]
name = "planet bearings"
members = ["P.planet", "c"]
table = [ ["0 rpm", "0.5 N m"], ["1000 rpm", "0.8 N m"] ]
viscous = "0.01 N m s/rad"

[[shaft]]
name = "output shaft"
members = ["a", "c"]
stiffness = "1e4 N m/rad"
damping = "2 N m s/rad"
backlash = "0.5 deg"
contact = "hard"

[[shift_element]]
name = "A"
kind = "brake"
members = ["ring"]
capacity = "2000 N m"
friction = [ ["0 rad/s", 1.0], ["50 rad/s", 0.8] ]
peak = 1.2

[[shift_element]]
name = "B"
kind = "clutch"
members = ["sun", "c"]
friction = 0.12
normal_force = "20 kN"
effective_radius = "80 mm"

[[shift_element]]
name = "C"
kind = "clutch"
members = ["left", "right"]

[[shift_element]]
name = "F"
kind = "one-way"
members = ["ring"]

[[state]]
name = "1"
engaged = ["A", "C", "F"]

[[state]]
name = "2"
engaged = ["B", "C"]

[[scenario]]
name = "start"
start = "1 s"
duration = "3 s"
samples = 100
initial_speeds = { sun = "100 rad/s" }
initial_twists = { "output shaft" = "1 deg" }
gears = [ ["0 s", "1"], ["2 s", "2"], ["3 s", "1"] ]
shift_time = "0.3 s"
fixed = ["ring", "frame"]

[[scenario.source]]
name = "engine"
member = "sun"
torque = { type = "step", height = "10 N m", at = "0.5 s" }

[[scenario.source]]
member = "sun"
torque = "5 N m"

[[scenario.source]]
member = "sun"
torque = { type = "ramp", offset = "1 N m", height = "10 N m", at = "500 ms", duration = "2 s" }

[[scenario.source]]
member = "b"
speed = { type = "sine", amplitude = "10 rad/s", frequency = "2 Hz", phase = "90 deg", decay = "0.5 1/s" }

[[scenario.source]]
member = "c"
[scenario.source.controller]
setpoint = { type = "pulse", amplitude = "60 rpm", period = "2 s", width = 0.25 }
feed_forward = { type = "product", of = [ "2 N m", { type = "table", points = [ ["0 s", 0.0], ["1 s", 1.0] ], hold = true } ] }
proportional = "4 N m s/rad"
integral = "30 N m/rad"
derivative = "0.02 N m s^2/rad"

[[scenario.source]]
member = "c"
linear = { torque = "5 N m", about = "10 rad/s", slope = "3 N m s/rad" }

[[scenario.source]]
member = "c"
quadratic = { torque = "-68 N m", about = "82 rad/s", factor = "0.05 N m s^2/rad^2", even = true }

[[scenario.source]]
member = "cage"
vehicle = { mass = "1500 kg", wheel_radius = "0.3 m", final_drive = 3.5, rolling = 0.012, drag_area = "0.7 m^2", grade = 0.05 }

[[scenario.source]]
member = "left"
motor = { full_load = [ ["0 rpm", "200 N m"], ["3000 rpm", "150 N m"] ], throttle = { type = "ramp", height = 1, duration = "1 s" } }

[[scenario.source]]
member = "right"
torque = { type = "csv", file = "load.csv", time = "t", value = "torque" }

[[scenario.source]]
member = "right"
torque = { type = "expression", formula = "60 + 200*sin(4*PI*t) - 3*w_c - {w_P.planet}" }

[[scenario.engagement]]
element = "C"
value = { type = "table", points = [ ["0 s", 0.0], ["1 s", 1.0] ] }

[[scenario]]
name = "held"
end = "5 s"
state = "2"
"#;

fn read(text: &str) -> Reading {
    Train::read_toml_with(text, &mut |file| match file {
        "load.csv" => Ok("\u{feff}t, n ,\"torque\"\r\n0,1,5\r\n\r\n0.5,1,-7e0\r\n0.5,1,8\r\n".to_owned()),
        _ => Err(format!("{file}: no such file")),
    })
}

fn good(text: &str) -> Train {
    let Reading { train, diagnostics, .. } = read(text);
    train.unwrap_or_else(|| panic!("{diagnostics}"))
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b.abs().max(1e-3), "{a} is not {b}");
}

#[test]
fn what_moves() {
    let train = good(FULL);
    let id = |name: &str| train.member(name).unwrap();
    let inertias: Vec<_> = train.inertias().iter().map(|i| (i.member, i.reference, i.value)).collect();
    let expected = [
        (id("D.planet"), id("cage"), 1e-4),
        (id("ring"), FRAME, 5e-5),
        (id("sun"), FRAME, 0.05),
        (id("P.planet"), FRAME, 4.0 * 6e-5),
        (id("c"), FRAME, 4.0 * 0.25 * 0.051 * 0.051),
        // The orbit of the second set follows from its teeth.
        (id("c"), FRAME, 4.0 * 0.5 * 0.05 * 0.05),
    ];
    assert_eq!(inertias.len(), expected.len(), "{inertias:?}");
    for (expected, found) in expected.iter().zip(&inertias) {
        assert_eq!((expected.0, expected.1), (found.0, found.1), "{inertias:?}");
        close(found.2, expected.2);
    }

    let [bearing, planets] = train.drags() else { panic!("two drags") };
    assert_eq!(
        (bearing.members, bearing.torque.at(7.0), bearing.viscous, bearing.peak),
        ([id("c"), FRAME], 0.5, 3.0, 1.1)
    );
    assert_eq!(planets.members, [id("P.planet"), id("c")]);
    close(planets.torque.at(0.0), 4.0 * 0.5);
    close(planets.torque.at(1000.0 * PI / 30.0), 4.0 * 0.8);
    close(planets.viscous, 0.04);
    assert_eq!(planets.peak, 1.0);

    let [shaft] = train.shafts() else { panic!("one shaft") };
    assert_eq!((shaft.members, shaft.stiffness, shaft.damping), ([id("a"), id("c")], 1e4, 2.0));
    close(shaft.backlash, 0.5 * PI / 180.0);
    assert_eq!(shaft.contact, Contact::Hard);

    let friction: Vec<_> = train.shift_elements().iter().map(|e| e.friction.clone()).collect();
    let a = friction[0].as_ref().unwrap();
    assert_eq!((a.torque.at(0.0), a.torque.at(50.0), a.peak), (2000.0, 1600.0, 1.2));
    let b = friction[1].as_ref().unwrap();
    close(b.torque.at(3.0), 0.12 * 20e3 * 0.08);
    assert!(friction[2].is_none() && friction[3].is_none());

    let [table] = train.loss_tables() else { panic!("one loss table") };
    assert_eq!(table.mesh, train.mesh("final").unwrap());
    let first = LossRow { speed: 0.0, forward: 0.5, backward: 0.4, forward_torque: 0.1, backward_torque: 0.0 };
    assert_eq!(table.rows[0], first);
    assert_eq!(table.rows[1].backward_torque, 0.3);
    let mesh = &train.meshes()[table.mesh.index()];
    assert_eq!((mesh.efficiency.forward.to_f64(), mesh.efficiency.backward.to_f64()), (0.5, 0.4));
    let assumed = |words: &str| train.assumptions().iter().any(|a| a.contains(words));
    assert!(assumed("first row"), "{:?}", train.assumptions());
    // Nothing dangles: every member is used.
    assert!(train.warnings().iter().all(|w| w.code != Code::Unconnected), "{:?}", train.warnings());
}

#[test]
fn what_happens() {
    let train = good(FULL);
    let id = |name: &str| train.member(name).unwrap();
    let s = train.scenario("start").unwrap();
    assert_eq!((s.start, s.end, s.samples), (1.0, 4.0, 100));
    assert_eq!(s.initial_speeds, [(id("sun"), 100.0)]);
    assert_eq!((s.initial_twists[0].0, s.fixed.as_slice()), (0, &[id("ring")][..]));
    close(s.initial_twists[0].1, PI / 180.0);
    let names: Vec<&str> = s.sources.iter().map(|x| x.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "engine",
            "torque on sun",
            "torque on sun 2",
            "speed of b",
            "controller on c",
            "load on c",
            "load on c 2",
            "vehicle on cage",
            "motor on left",
            "torque on right",
            "torque on right 2",
        ]
    );
    let kind = |k: usize| &s.sources[k].kind;
    assert_eq!(*kind(0), SourceKind::Torque(Signal::Step { offset: 0.0, height: 10.0, at: 0.5 }));
    assert_eq!(*kind(1), SourceKind::Torque(Signal::Constant(5.0)));
    assert_eq!(*kind(2), SourceKind::Torque(Signal::Ramp { offset: 1.0, height: 10.0, at: 0.5, duration: 2.0 }));
    let sine = Signal::Sine { offset: 0.0, amplitude: 10.0, frequency: 2.0, phase: PI / 2.0, at: 0.0, decay: 0.5 };
    assert_eq!(*kind(3), SourceKind::Speed(sine));
    let SourceKind::Controller { setpoint, feed_forward, proportional, integral, derivative } = kind(4) else {
        panic!("a controller")
    };
    assert_eq!(*setpoint, Signal::Pulse { offset: 0.0, amplitude: 2.0 * PI, period: 2.0, width: 0.25, at: 0.0 });
    let table = Signal::Table { points: vec![[0.0, 0.0], [1.0, 1.0]], hold: true };
    assert_eq!(*feed_forward, Signal::Product(Box::new([Signal::Constant(2.0), table])));
    assert_eq!((*proportional, *integral, *derivative), (4.0, 30.0, 0.02));
    assert_eq!(*kind(5), SourceKind::Linear { torque: 5.0, about: 10.0, slope: 3.0 });
    assert_eq!(*kind(6), SourceKind::Quadratic { torque: -68.0, about: 82.0, factor: 0.05, even: true });
    let vehicle = SourceKind::Vehicle {
        mass: 1500.0,
        wheel_radius: 0.3,
        final_drive: 3.5,
        rolling: 0.012,
        drag_area: 0.7,
        air_density: 1.2,
        grade: Signal::Constant(0.05),
    };
    assert_eq!(*kind(7), vehicle);
    let SourceKind::Motor { full_load, closed, throttle } = kind(8) else { panic!("a motor") };
    assert_eq!((full_load.at(0.0), closed.at(100.0)), (200.0, 0.0));
    assert_eq!(*throttle, Signal::Ramp { offset: 0.0, height: 1.0, at: 0.0, duration: 1.0 });
    let file = Signal::Table { points: vec![[0.0, 5.0], [0.5, -7.0], [0.5, 8.0]], hold: false };
    assert_eq!(*kind(9), SourceKind::Torque(file));
    let SourceKind::Torque(Signal::Expression { formula, speeds }) = kind(10) else { panic!("a formula") };
    assert!(formula.depends_on_time());
    let at: Vec<f64> = speeds.iter().map(|m| if *m == id("c") { 4.0 } else { 1.0 }).collect();
    assert_eq!(speeds.len(), 2);
    assert!(speeds.contains(&id("P.planet")));
    close(formula.value(0.0, &at), 47.0);

    // C has its own schedule, F acts by itself; A and B follow the gears.
    let element = |k: usize| &s.engagements.iter().find(|e| e.element.index() == k).unwrap().signal;
    assert_eq!(s.engagements.len(), 3);
    assert_eq!(*element(2), Signal::Table { points: vec![[0.0, 0.0], [1.0, 1.0]], hold: false });
    let ramps = |first: f64| {
        let last = 1.0 - first;
        Signal::Table { points: vec![[2.0, first], [2.3, last], [3.0, last], [3.3, first]], hold: false }
    };
    assert_eq!((element(0), element(1)), (&ramps(1.0), &ramps(0.0)));
    let held = train.scenario("held").unwrap();
    assert_eq!((held.start, held.end, held.samples), (0.0, 5.0, 500));
    let engaged: Vec<_> = held.engagements.iter().map(|e| (e.element.index(), &e.signal)).collect();
    assert_eq!(engaged, [(1, &Signal::Constant(1.0)), (2, &Signal::Constant(1.0))]);
}

#[test]
fn gears_without_a_shift_time_are_steps() {
    let train = good(&with("shift_time = \"0.3 s\"\n", ""));
    let first = &train.scenarios()[0].engagements.iter().find(|e| e.element.index() == 0).unwrap().signal;
    assert_eq!(*first, Signal::Table { points: vec![[2.0, 1.0], [2.0, 0.0], [3.0, 0.0], [3.0, 1.0]], hold: false });
}

#[test]
fn a_train_without_meshes_moves_too() {
    let text = r#"format = 1
name = "two discs"
members = ["a", "b", "free"]
inertias = { a = "1 kg m^2", b = "2 kg m^2" }
[[shaft]]
name = "spring"
members = ["a"]
stiffness = "100 N m/rad"
[[shift_element]]
name = "C"
kind = "clutch"
members = ["a", "b"]
capacity = "10 N m"
[[scenario]]
name = "slip"
duration = "1 s"
[[scenario.source]]
member = "free"
torque = "1 N m"
"#;
    let reading = read(text);
    assert!(reading.diagnostics.is_empty(), "{}", reading.diagnostics);
    assert!(reading.train.unwrap().meshes().is_empty());
}

#[test]
fn what_is_assumed_of_planets_is_told() {
    let text = with(
        "planet = { teeth = 20, count = 4, mass = \"0.25 kg\", inertia = \"6e-5 kg m^2\", orbit_radius = \"51 mm\" }",
        "planet = { mass = \"0.25 kg\" }",
    );
    let train = good(&text);
    let told =
        |words: &str| assert!(train.assumptions().iter().any(|a| a.contains(words)), "{:?}", train.assumptions());
    told("mass and inertia taken as of one");
    told("P.planet: orbit not known, its mass is left out of motions (give orbit_radius)");
    // The planet of the bevel set has an inertia in [inertias]; those of no set are without any.
    let bare = good(&with("\"D.planet\" = \"1e-4 kg m^2\"\n", ""));
    assert!(bare.assumptions().iter().any(|a| a.contains("D.planet: neither its `mass` nor its `inertia` is given")));
    assert!(!train.assumptions().iter().any(|a| a.contains("neither mass nor inertia")), "{:?}", train.assumptions());
}

#[test]
fn a_bevel_planet_written_as_a_member_spins_on_its_carrier() {
    let bevel = |other: &str, sense: &str| {
        format!(
            "[[mesh]]\ngears = [ {{ member = \"{other}\", teeth = 16 }}, {{ member = \"planet\", teeth = 10 }} ]\n\
             carrier = \"cage\"\nkind = \"bevel\"\nsense = \"{sense}\"\nefficiency = 0.98\n"
        )
    };
    let text = format!(
        "format = 1\nname = \"differential\"\nmembers = [\"cage\", \"left\", \"right\", \"planet\"]\n\
         inertias = {{ planet = \"1 kg m^2\", left = \"1 kg m^2\" }}\n{}{}",
        bevel("left", "opposite"),
        bevel("right", "same")
    );
    let train = good(&text);
    let references: Vec<_> = train.inertias().iter().map(|i| (i.member, i.reference)).collect();
    let id = |name: &str| train.member(name).unwrap();
    assert_eq!(references, [(id("left"), FRAME), (id("planet"), id("cage"))]);
    assert!(train.assumptions().iter().any(|a| a.starts_with("planet: taken as a bevel planet")));
}

#[test]
fn the_builder_says_the_same() {
    let built = Train::builder("small")
        .members(["sun", "ring", "c", "d"])
        .inertia("sun", MomentOfInertia::kg_m2(0.05))
        .set(
            SetSpec::double_planet("P", ("sun", 36), ("ring", 84), "c")
                .planet_body(PlanetBodySpec {
                    mass: Some(Mass::kg(0.1)),
                    inertia: Some(MomentOfInertia::kg_m2(1e-5)),
                    orbit_radius: Some(Length::m(0.04)),
                })
                .planet(16, 3)
                .second_planet(16)
                .second_planet_body(PlanetBodySpec {
                    inertia: Some(MomentOfInertia::kg_m2(2e-5)),
                    ..PlanetBodySpec::default()
                })
                .mesh_efficiency(0.99),
        )
        .mesh(MeshSpec::new(GearSpec::external("c", 20), GearSpec::external("d", 40)).loss_table(vec![LossRowSpec {
            forward: 0.98,
            backward: 0.97,
            ..LossRowSpec::default()
        }]))
        .drag(DragSpec {
            name: "seal".into(),
            members: vec!["c".into()],
            coulomb: Some(Torque::n_m(0.5)),
            ..DragSpec::default()
        })
        .shaft(ShaftSpec {
            name: "s".into(),
            members: vec!["c".into()],
            damping: Some(ViscousCoefficient::n_m_s_rad(1.0)),
            ..ShaftSpec::default()
        })
        .shift_element(
            ShiftElementSpec::brake("B", "ring").pressed(Force::kn(1.0), Length::mm(100.0)).friction(0.1).peak(1.5),
        )
        .state(StateSpec::new("1", ["B"]))
        .scenario(
            ScenarioSpec::new("go", Time::s(2.0))
                .start(Time::s(-1.0))
                .samples(10)
                .gears([(Time::s(0.0), "1")], Time::s(0.1))
                .initial_speed("sun", AngularSpeed::rad_s(3.0))
                .initial_twist("s", Angle::rad(0.1))
                .source(
                    SourceSpec::torque("sun", SignalSpec::product(Torque::n_m(2.0), SignalSpec::formula("w_c")))
                        .named("x"),
                )
                .source(SourceSpec::speed(
                    "d",
                    SignalSpec::step(AngularSpeed::rad_s(0.0), AngularSpeed::rad_s(1.0), Time::s(0.0)),
                )),
        )
        .build()
        .unwrap_or_else(|e| panic!("{e}"));
    let read = good(
        r#"format = 1
name = "small"
members = ["sun", "ring", "c", "d"]
inertias = { sun = "0.05 kg m^2" }
[[set]]
name = "P"
type = "double-planet"
sun = { member = "sun", teeth = 36 }
inner_planet = { teeth = 16, count = 3, mass = "100 g", inertia = "1e-5 kg m^2", orbit_radius = "40 mm" }
outer_planet = { teeth = 16, count = 3, inertia = "2e-5 kg m^2" }
ring = { member = "ring", teeth = 84 }
carrier = "c"
mesh_efficiency = 0.99
[[mesh]]
gears = [ { member = "c", teeth = 20 }, { member = "d", teeth = 40 } ]
loss_table = [ { speed = "0 rad/s", forward = 0.98, backward = 0.97 } ]
[[drag]]
name = "seal"
members = ["c"]
coulomb = "0.5 N m"
[[shaft]]
name = "s"
members = ["c"]
damping = "1 N m s/rad"
[[shift_element]]
name = "B"
kind = "brake"
members = ["ring"]
friction = 0.1
normal_force = "1 kN"
effective_radius = "100 mm"
peak = 1.5
[[state]]
name = "1"
engaged = ["B"]
[[scenario]]
name = "go"
start = "-1 s"
duration = "2 s"
samples = 10
gears = [ ["0 s", "1"] ]
shift_time = "0.1 s"
initial_speeds = { sun = "3 rad/s" }
initial_twists = { s = "0.1 rad" }
[[scenario.source]]
name = "x"
member = "sun"
torque = { type = "product", of = [ "2 N m", { type = "expression", formula = "w_c" } ] }
[[scenario.source]]
member = "d"
speed = { type = "step", height = "1 rad/s" }
"#,
    );
    assert_eq!(built.inertias(), read.inertias());
    assert_eq!(built.inertias().len(), 4);
    assert_eq!(built.drags(), read.drags());
    assert_eq!(built.shafts(), read.shafts());
    assert_eq!(built.loss_tables(), read.loss_tables());
    assert_eq!(built.scenarios(), read.scenarios());
    assert_eq!(built.shift_elements()[0].friction, read.shift_elements()[0].friction);
}

// ---- What is wrong -----------------------------------------------------------------------------

/// The full file with one part replaced, which must stand there exactly once.
fn with(old: &str, new: &str) -> String {
    assert_eq!(FULL.matches(old).count(), 1, "{old:?}");
    FULL.replace(old, new)
}

fn errors(text: &str) -> Diagnostics {
    let reading = read(text);
    assert!(reading.train.is_none(), "no error in\n{text}");
    reading.diagnostics.render("train.toml", text, false);
    reading.diagnostics
}

/// What is put in place of what, the code and the place of the only error.
type Case = (&'static str, &'static str, Code, &'static str);

#[rustfmt::skip]
const WRONG: &[Case] = &[
    // Inertias
    ("ring = \"500 g cm^2\"", "rink = \"500 g cm^2\"", Code::UnknownName, "inertias.rink"),
    ("ring = \"500 g cm^2\"", "ring = \"-500 g cm^2\"", Code::OutOfRange, "inertias.ring"),
    ("ring = \"500 g cm^2\"", "ring = \"500 g cm\"", Code::Quantity, "inertias.ring"),
    ("ring = \"500 g cm^2\"", "frame = \"500 g cm^2\"", Code::BadName, "inertias.frame"),
    ("\"D.planet\"", "\"P.planet\"", Code::Conflict, "set[0].planet.inertia"),
    ("mass = \"0.25 kg\"", "mass = \"-0.25 kg\"", Code::OutOfRange, "set[0].planet.mass"),
    ("orbit_radius = \"51 mm\"", "orbit_radius = \"0 mm\"", Code::OutOfRange, "set[0].planet.orbit_radius"),
    ("mass = \"0.5 kg\"", "mass = \"0.5 kg\", orbit_radius = \"60 mm\"", Code::Conflict, "set[1].planet.orbit_radius"),
    ("mass = \"0.5 kg\"", "inertia = \"-1 kg m^2\"", Code::OutOfRange, "set[1].planet.inertia"),
    // Drags
    ("coulomb = \"0.5 N m\"", "coulomb = \"-0.5 N m\"", Code::OutOfRange, "drag[0].coulomb"),
    ("viscous = \"3 N m s/rad\"", "viscous = \"3 N m s\"", Code::Quantity, "drag[0].viscous"),
    ("viscous = \"3 N m s/rad\"", "viscous = \"-3 N m s/rad\"", Code::OutOfRange, "drag[0].viscous"),
    ("coulomb = \"0.5 N m\"\nviscous = \"3 N m s/rad\"\n", "", Code::MissingKey, "drag[0]"),
    ("peak = 1.1", "peak = 0.9", Code::OutOfRange, "drag[0].peak"),
    ("name = \"planet bearings\"", "name = \"carrier bearing\"", Code::DuplicateName, "drag[1].name"),
    ("viscous = \"0.01 N m s/rad\"", "coulomb = \"1 N m\"", Code::Conflict, "drag[1].table"),
    ("[\"1000 rpm\", \"0.8 N m\"]", "[\"0 rpm\", \"0.8 N m\"]", Code::BadTable, "drag[1].table[1]"),
    ("[\"1000 rpm\", \"0.8 N m\"]", "[\"1000 rpm\", \"-0.8 N m\"]", Code::BadTable, "drag[1].table[1]"),
    ("[\"1000 rpm\", \"0.8 N m\"]", "[\"1000 rpm\"]", Code::WrongType, "drag[1].table[1]"),
    ("[\"1000 rpm\", \"0.8 N m\"]", "[\"1000 rpm\", 0.8]", Code::Quantity, "drag[1].table[1][1]"),
    ("table = [ [\"0 rpm\", \"0.5 N m\"], [\"1000 rpm\", \"0.8 N m\"] ]", "table = []", Code::BadTable, "drag[1].table"),
    ("[\"P.planet\", \"c\"]", "[\"c\", \"c\"]", Code::ShiftElement, "drag[1].members"),
    ("[\"P.planet\", \"c\"]", "[\"P.planets\", \"c\"]", Code::UnknownName, "drag[1].members[0]"),
    // Shafts
    ("stiffness = \"1e4 N m/rad\"", "stiffness = \"-1e4 N m/rad\"", Code::OutOfRange, "shaft[0].stiffness"),
    ("stiffness = \"1e4 N m/rad\"\n", "", Code::MissingKey, "shaft[0].stiffness"),
    ("stiffness = \"1e4 N m/rad\"\ndamping = \"2 N m s/rad\"\nbacklash = \"0.5 deg\"\n", "", Code::MissingKey, "shaft[0].stiffness"),
    ("damping = \"2 N m s/rad\"", "damping = \"-2 N m s/rad\"", Code::OutOfRange, "shaft[0].damping"),
    ("backlash = \"0.5 deg\"", "backlash = \"-0.5 deg\"", Code::OutOfRange, "shaft[0].backlash"),
    ("contact = \"hard\"", "contact = \"heard\"", Code::UnknownName, "shaft[0].contact"),
    // Shift elements
    ("capacity = \"2000 N m\"", "capacity = \"0 N m\"", Code::OutOfRange, "shift_element[0].capacity"),
    ("capacity = \"2000 N m\"", "normal_force = \"1 N\"", Code::MissingKey, "shift_element[0].effective_radius"),
    ("peak = 1.2", "peak = 0.5", Code::OutOfRange, "shift_element[0].peak"),
    ("[\"50 rad/s\", 0.8]", "[\"50 rad/s\", -0.8]", Code::BadTable, "shift_element[0].friction[1]"),
    ("friction = 0.12", "friction = -0.12", Code::OutOfRange, "shift_element[1].friction"),
    ("friction = 0.12", "friction = \"0.12\"", Code::WrongType, "shift_element[1].friction"),
    ("friction = 0.12", "capacity = \"1 N m\"", Code::Conflict, "shift_element[1].capacity"),
    ("friction = 0.12\n", "", Code::MissingKey, "shift_element[1].capacity"),
    // Loss tables
    ("forward = 0.5, backward = 0.4", "forward = 1.5, backward = 0.4", Code::OutOfRange, "mesh[0].loss_table[0].forward"),
    ("forward = 0.5, backward = 0.4", "backward = 0.4", Code::MissingKey, "mesh[0].loss_table[0].forward"),
    ("speed = \"100 rad/s\"", "speed = \"0 rad/s\"", Code::BadTable, "mesh[0].loss_table[1]"),
    ("backward_torque = \"0.3 N m\"", "backward_torque = \"-0.3 N m\"", Code::OutOfRange, "mesh[0].loss_table[1].backward_torque"),
    ("name = \"final\"", "name = \"final\"\nefficiency = 0.98", Code::Conflict, "mesh[0].efficiency"),
    ("name = \"final\"", "name = \"final\"\ngeometry = { module = \"2 mm\", width = \"20 mm\" }", Code::Conflict, "mesh[0].geometry"),
    // Scenarios
    ("name = \"held\"", "name = \"start\"", Code::DuplicateName, "scenario[1].name"),
    ("duration = \"3 s\"", "duration = \"0 s\"", Code::OutOfRange, "scenario[0].duration"),
    ("duration = \"3 s\"", "duration = \"3 s\"\nend = \"4 s\"", Code::Conflict, "scenario[0].end"),
    ("duration = \"3 s\"", "end = \"0.5 s\"", Code::OutOfRange, "scenario[0].end"),
    ("duration = \"3 s\"\n", "", Code::MissingKey, "scenario[0].duration"),
    ("samples = 100", "samples = 1", Code::OutOfRange, "scenario[0].samples"),
    ("samples = 100", "samples = 10_000_001", Code::OutOfRange, "scenario[0].samples"),
    ("samples = 100", "samples = 100.5", Code::WrongType, "scenario[0].samples"),
    ("{ sun = \"100 rad/s\" }", "{ sung = \"100 rad/s\" }", Code::UnknownName, "scenario[0].initial_speeds.sung"),
    ("{ sun = \"100 rad/s\" }", "{ ring = \"100 rad/s\" }", Code::HeldAndDriven, "scenario[0].initial_speeds.ring"),
    ("{ \"output shaft\" = \"1 deg\" }", "{ \"output\" = \"1 deg\" }", Code::UnknownName, "scenario[0].initial_twists.output"),
    ("fixed = [\"ring\", \"frame\"]", "fixed = [\"ring\", \"ring\"]", Code::HeldAndDriven, "scenario[0].fixed[1]"),
    ("fixed = [\"ring\", \"frame\"]", "fixed = [\"ring\", \"b\"]", Code::HeldAndDriven, "scenario[0].source[3].speed"),
    ("state = \"2\"", "state = \"22\"", Code::UnknownName, "scenario[1].state"),
    ("state = \"2\"", "state = \"2\"\ngears = [ [\"0 s\", \"1\"] ]", Code::Conflict, "scenario[1].gears"),
    ("state = \"2\"", "shift_time = \"1 s\"", Code::MissingKey, "scenario[1].gears"),
    ("[\"2 s\", \"2\"]", "[\"2 s\", \"5\"]", Code::UnknownName, "scenario[0].gears[1][1]"),
    ("[\"2 s\", \"2\"]", "[\"2 s\", 2]", Code::WrongType, "scenario[0].gears[1][1]"),
    ("[\"2 s\", \"2\"]", "[\"0 s\", \"2\"]", Code::BadTable, "scenario[0].gears[1]"),
    ("[\"2 s\", \"2\"]", "[\"2.9 s\", \"2\"]", Code::OutOfRange, "scenario[0].gears[2]"),
    ("shift_time = \"0.3 s\"", "shift_time = \"-0.3 s\"", Code::OutOfRange, "scenario[0].shift_time"),
    ("element = \"C\"", "element = \"K\"", Code::UnknownName, "scenario[0].engagement[0].element"),
    ("element = \"C\"", "element = \"F\"", Code::ShiftElement, "scenario[0].engagement[0].element"),
    ("[\"1 s\", 1.0] ] }\n", "[\"1 s\", 1.5] ] }\n", Code::OutOfRange, "scenario[0].engagement[0].value"),
    // Sources
    ("name = \"engine\"\nmember = \"sun\"", "name = \"engine\"\nmember = \"frame\"", Code::HeldAndDriven, "scenario[0].source[0].member"),
    ("name = \"engine\"\nmember = \"sun\"", "name = \"engine\"\nmember = \"son\"", Code::UnknownName, "scenario[0].source[0].member"),
    ("member = \"sun\"\ntorque = \"5 N m\"", "name = \"engine\"\nmember = \"sun\"\ntorque = \"5 N m\"", Code::DuplicateName, "scenario[0].source[1].name"),
    ("torque = \"5 N m\"\n", "", Code::MissingKey, "scenario[0].source[1]"),
    ("torque = \"5 N m\"\n", "torque = \"5 N m\"\nspeed = \"1 rpm\"\n", Code::Conflict, "scenario[0].source[1].speed"),
    ("torque = \"5 N m\"\n", "torque = 5\n", Code::Quantity, "scenario[0].source[1].torque"),
    ("torque = \"5 N m\"\n", "torque = [5]\n", Code::Quantity, "scenario[0].source[1].torque"),
    ("member = \"left\"\nmotor", "member = \"b\"\nspeed = \"1 rpm\"\n\n[[scenario.source]]\nmember = \"left\"\nmotor", Code::HeldAndDriven, "scenario[0].source[8].speed"),
    ("proportional = \"4 N m s/rad\"", "proportional = \"-4 N m s/rad\"", Code::OutOfRange, "scenario[0].source[4].controller.proportional"),
    ("mass = \"1500 kg\"", "mass = \"0 kg\"", Code::OutOfRange, "scenario[0].source[7].vehicle.mass"),
    ("mass = \"1500 kg\", ", "", Code::MissingKey, "scenario[0].source[7].vehicle.mass"),
    ("final_drive = 3.5", "final_drive = 0", Code::OutOfRange, "scenario[0].source[7].vehicle.final_drive"),
    ("rolling = 0.012", "rolling = -0.012", Code::OutOfRange, "scenario[0].source[7].vehicle.rolling"),
    ("[\"3000 rpm\", \"150 N m\"]", "[\"0 rpm\", \"150 N m\"]", Code::BadTable, "scenario[0].source[8].motor.full_load[1]"),
    ("height = 1, duration", "height = 2, duration", Code::OutOfRange, "scenario[0].source[8].motor.throttle"),
    // Signals
    ("{ type = \"step\", height = \"10 N m\", at = \"0.5 s\" }", "{ height = \"10 N m\" }", Code::MissingKey, "scenario[0].source[0].torque.type"),
    ("type = \"step\"", "type = \"stop\"", Code::UnknownName, "scenario[0].source[0].torque.type"),
    ("type = \"step\"", "type = 1", Code::WrongType, "scenario[0].source[0].torque.type"),
    ("height = \"10 N m\", at = \"0.5 s\" }", "at = \"0.5 s\" }", Code::MissingKey, "scenario[0].source[0].torque.height"),
    ("height = \"10 N m\", at = \"0.5 s\" }", "height = \"10 N m\", period = \"0.5 s\" }", Code::UnknownKey, "scenario[0].source[0].torque.period"),
    ("height = \"10 N m\", at = \"0.5 s\" }", "height = \"10 rpm\", at = \"0.5 s\" }", Code::Quantity, "scenario[0].source[0].torque.height"),
    ("duration = \"2 s\" }", "duration = \"0 s\" }", Code::OutOfRange, "scenario[0].source[2].torque.duration"),
    ("frequency = \"2 Hz\"", "frequency = \"-2 Hz\"", Code::OutOfRange, "scenario[0].source[3].speed.frequency"),
    ("frequency = \"2 Hz\"", "frequency = \"2 s\"", Code::Quantity, "scenario[0].source[3].speed.frequency"),
    ("period = \"2 s\"", "period = \"0 s\"", Code::OutOfRange, "scenario[0].source[4].controller.setpoint.period"),
    ("width = 0.25", "width = 1.25", Code::OutOfRange, "scenario[0].source[4].controller.setpoint.width"),
    ("[\"1 s\", 1.0] ], hold", "[\"-1 s\", 1.0] ], hold", Code::BadTable, "scenario[0].source[4].controller.feed_forward.of[1].points[1]"),
    ("of = [ \"2 N m\",", "of = [ \"2 N m\", 1.0,", Code::WrongType, "scenario[0].source[4].controller.feed_forward.of"),
    ("of = [ \"2 N m\",", "of = [ 2,", Code::Quantity, "scenario[0].source[4].controller.feed_forward.of[0]"),
    ("file = \"load.csv\"", "file = \"lead.csv\"", Code::Unreadable, "scenario[0].source[9].torque.file"),
    ("value = \"torque\"", "value = \"torq\"", Code::BadTable, "scenario[0].source[9].torque.file"),
    ("- 3*w_c", "- 3*w_d", Code::UnknownName, "scenario[0].source[10].torque.formula"),
    ("- 3*w_c", "- 3*(w_c", Code::BadFormula, "scenario[0].source[10].torque.formula"),
    ("- 3*w_c", "- 3*x", Code::BadFormula, "scenario[0].source[10].torque.formula"),
];

#[test]
fn each_fault_has_its_code_and_its_place() {
    for (old, new, code, place) in WRONG {
        let all = errors(&with(old, new));
        let errors: Vec<_> = all.iter().filter(|d| d.code.as_str().starts_with('E')).collect();
        let found: Vec<_> = errors.iter().map(|d| (d.code, d.place.as_str())).collect();
        assert_eq!(found, [(*code, *place)], "{old} -> {new}\n{all}");
        let hints = errors[0].hints.len();
        assert!(errors[0].span.is_some() && hints < 4, "{old} -> {new}\n{all}");
    }
}

#[test]
fn all_at_once() {
    let text = FULL
        .replace("backlash = \"0.5 deg\"", "backlash = \"-0.5 deg\"")
        .replace("peak = 1.1", "peak = 0.9")
        .replace("type = \"step\"", "type = \"stop\"")
        .replace("ring = \"500 g cm^2\"", "rink = \"500 g cm^2\"")
        .replace("width = 0.25", "width = 1.25");
    assert_eq!(errors(&text).iter().filter(|d| d.code.as_str().starts_with('E')).count(), 5, "{}", errors(&text));
}

#[test]
fn what_a_type_of_signal_takes_is_told() {
    let all = errors(&with("height = \"10 N m\", at = \"0.5 s\" }", "heigth = \"10 N m\" }"));
    assert!(all.to_string().contains("did you mean `height`?"), "{all}");
    assert!(all.to_string().contains("`step` takes: type, offset, height, at"), "{all}");
}

#[test]
fn a_csv_file_is_told_apart_line_by_line() {
    let text = |file: &str| {
        let load = |_: &str| Ok(file.to_owned());
        let wheel = "format = 1\nname = \"x\"\nmembers = [\"a\"]\n[[scenario]]\nname = \"s\"\nduration = \"1 s\"\n\
                     [[scenario.source]]\nmember = \"a\"\n\
                     torque = { type = \"csv\", file = \"f.csv\", time = \"t\", value = \"T\", hold = true }\n";
        let Reading { train, diagnostics, .. } = Train::read_toml_with(wheel, &mut { load });
        train.map(|_| ()).ok_or(diagnostics.to_string())
    };
    assert_eq!(text("t,T\n0,1\n1,2\n"), Ok(()));
    assert_eq!(text("t;T\n0,5;1\n1;2,5\n"), Ok(()));
    for (file, says) in [
        ("", "the file is empty"),
        ("t,T\n", "no row below the header"),
        ("t,T\n0,1\n1\n", "line 3 has 1 cells, the header has 2"),
        ("t,T\n0,1\n1,\n", "line 3, column `T`: the cell is empty"),
        ("t,T\n0,1\n1,x\n", "line 3, column `T`: the cell is no finite number"),
        ("t,T\n0,1\n1,nan\n", "line 3, column `T`: the cell is no finite number"),
        ("t,T\n0,1\n\n-1,2\n", "line 4: the time lies before that of the row above"),
        ("time,T\n0,1\n", "no column `t` among the 2 columns of line 1"),
    ] {
        let wrong = text(file).unwrap_err();
        assert!(wrong.contains(says) && wrong.contains("f.csv"), "{wrong}");
    }
    // Without a way to read files, that is said.
    let wrong = Train::from_toml(FULL).unwrap_err();
    let errors: Vec<_> = wrong.iter().filter(|d| d.severity == Severity::Error).collect();
    assert!(errors.iter().all(|d| d.code == Code::Unreadable) && wrong.to_string().contains("load.csv"), "{wrong}");
}

#[test]
fn the_builder_is_checked_too() {
    let nan = f64::NAN;
    let minus = || Torque::n_m(-1.0);
    let built = Train::builder("bad")
        .members(["a"])
        .inertia("a", MomentOfInertia::kg_m2(-1.0))
        .inertia("a", MomentOfInertia::kg_m2(1.0))
        .inertia("a", MomentOfInertia::kg_m2(2.0))
        .drag(DragSpec { name: "d".into(), members: vec!["a".into()], coulomb: Some(minus()), ..DragSpec::default() })
        .mesh(MeshSpec::new(GearSpec::external("a", 20), GearSpec::external("frame", 40)).loss_table(vec![]))
        .mesh(MeshSpec::new(GearSpec::external("a", 20), GearSpec::external("frame", 40)).loss_table(vec![
            LossRowSpec { forward: nan, backward: 1.0, forward_torque: Some(minus()), ..LossRowSpec::default() },
        ]))
        .scenario(
            ScenarioSpec::new("s", Time::s(0.0))
                .engagement("C", nan)
                .source(SourceSpec::torque("a", SignalSpec::product(minus(), nan)))
                .source(SourceSpec::torque("a", SignalSpec::table([])))
                .source(SourceSpec::torque("a", SignalSpec::formula("w_b")))
                .source(SourceSpec { member: Some("a".into()), ..SourceSpec::default() }),
        )
        .build()
        .unwrap_err();
    let places: Vec<&str> = built.iter().map(|d| d.place.as_str()).collect();
    for place in [
        "inertias.a",
        "drag[0].coulomb",
        "mesh[0].loss_table",
        "mesh[1].loss_table[0].forward",
        "mesh[1].loss_table[0].forward_torque",
        "scenario[0].duration",
        "scenario[0].engagement[0].value",
        "scenario[0].source[0].torque.of[1]",
        "scenario[0].source[1].torque.points",
        "scenario[0].source[2].torque.formula",
        "scenario[0].source[3]",
    ] {
        assert!(places.contains(&place), "{place} is not among\n{built}");
    }
}

#[test]
fn a_hostile_formula_is_refused_or_read() {
    let long = "1+".repeat(5000) + "1";
    let deep = "(".repeat(900) + "1" + &")".repeat(900);
    let open = "(".repeat(1900);
    let minus = "-".repeat(1900) + "t";
    for formula in [
        "", " ", "{", "}", "{}", "{w_a", "t t", "()", "w_", "1/0", "π", "ü", "{w_ü}", "t^", ")(", &long, &deep, &open,
        &minus,
    ] {
        read(&with("60 + 200*sin(4*PI*t) - 3*w_c - {w_P.planet}", formula));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any text in place of a value gives a train or errors.
    #[test]
    fn no_formula_panics(formula in "[tw_cPIsinexplog0-9+*/^(){}., -]{0,40}") {
        read(&with("60 + 200*sin(4*PI*t) - 3*w_c - {w_P.planet}", &formula));
    }

    /// A line less, or a line twice.
    #[test]
    fn no_lost_line_panics(line in 0usize..200, twice in any::<bool>()) {
        let mut lines: Vec<&str> = FULL.lines().collect();
        let k = line % lines.len();
        if twice { lines.insert(k, lines[k]) } else { lines.remove(k); }
        read(&lines.join("\n"));
    }

    /// A token exchanged for another one of the file.
    #[test]
    fn no_exchanged_token_panics(from in 0usize..400, to in 0usize..400) {
        let tokens: Vec<&str> = FULL.split(' ').collect();
        let mut changed = tokens.clone();
        changed[from % tokens.len()] = tokens[to % tokens.len()];
        read(&changed.join(" "));
    }
}
