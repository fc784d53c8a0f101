//! The dynamic layer of a specification: drags, shafts, and the motions to simulate.

use crate::train::dynamic::Contact;
use crate::train::format::keys::{Kind, SignalKind, Table, TypedTable};
use crate::train::format::{Datum, Node};
use crate::units::{
    Angle, AngularSpeed, Area, Density, Frequency, Length, Mass, MomentOfInertia, Power, Stiffness, Time, Torque,
    TorquePerAcceleration, TorquePerSpeedSquared, ViscousCoefficient,
};

use super::field::{Field, Measured, choice, specification};

choice!(Contact { Soft = "soft", Hard = "hard" });

specification! {
    /// Friction between two members that does not depend on tooth loads; at a planet of a set, at every planet. It
    /// needs `coulomb`, `viscous` or `table`.
    DragSpec => PlainDrag {
        /// What it is called.
        must name: String,
        /// The two members, or one that turns against the frame.
        must members: Vec<String>,
        /// Torque at any speed; holds at rest.
        may coulomb: Option<Torque>,
        /// Torque over relative speed.
        may viscous: Option<ViscousCoefficient>,
        /// Torque over the amount of relative speed, instead of `coulomb`.
        may table: Option<Vec<(AngularSpeed, Torque)>>,
        /// Torque at which it breaks away over that at which it slides; at least 1. Default: 1.
        may peak: Option<f64>,
    }

    /// An elastic shaft. It needs a stiffness or a damping.
    ShaftSpec => PlainShaft {
        /// What it is called.
        must name: String,
        /// The two members it joins, or one that it ties to the frame.
        must members: Vec<String>,
        /// Torque over twist.
        may stiffness: Option<Stiffness>,
        /// Torque over the rate of twist.
        may damping: Option<ViscousCoefficient>,
        /// Whole backlash. Default: none.
        may backlash: Option<Angle>,
        /// At the ends of the backlash: `soft` damping never exceeds the spring and never pulls; with `hard` the
        /// torque may jump. Default: soft.
        may contact: Option<Contact>,
    }

    /// Mass and inertia of one planet of a set.
    PlanetBodySpec => PlainPlanetBody {
        /// Mass of one planet; its centrifugal force loads the planet bearings, and it turns with the carrier.
        may mass: Option<Mass>,
        /// Moment of inertia of one planet about its own axis.
        may inertia: Option<MomentOfInertia>,
        /// Distance of the planet's axis from the carrier's. Default: the centre distance of the geometry.
        may orbit_radius: Option<Length>,
    }

    /// Losses of a mesh at one speed.
    LossRowSpec => PlainLossRow {
        /// Amount of the first gear's speed on the carrier.
        must speed: AngularSpeed,
        /// Efficiency when the first gear drives.
        must forward: f64,
        /// Efficiency when the second gear drives.
        must backward: f64,
        /// Bearing torque at the first gear when it drives. Default: 0 N m.
        may forward_torque: Option<Torque>,
        /// Bearing torque at the first gear when the second drives. Default: 0 N m.
        may backward_torque: Option<Torque>,
    }

    /// A motion to simulate, from `start` for a `duration` (or to `end`).
    ///
    /// # Example
    /// A flywheel is braked by a clutch that closes within a tenth of a second.
    /// ```
    /// use willis::train::{ScenarioSpec, ShaftSpec, ShiftElementSpec, SignalSpec, SourceSpec, Train};
    /// use willis::units::{AngularSpeed, MomentOfInertia, Stiffness, Time, Torque, ViscousCoefficient};
    ///
    /// let train = Train::builder("flywheel and clutch")
    ///     .members(["motor", "wheel"])
    ///     .inertia("motor", MomentOfInertia::kg_m2(0.2))
    ///     .inertia("wheel", MomentOfInertia::kg_m2(1.5))
    ///     .shift_element(ShiftElementSpec::clutch("C", "motor", "wheel").capacity(Torque::n_m(80.0)))
    ///     .shaft(ShaftSpec {
    ///         name: "output shaft".into(),
    ///         members: vec!["wheel".into()],
    ///         stiffness: Some(Stiffness::n_m_rad(1e4)),
    ///         damping: Some(ViscousCoefficient::n_m_s_rad(2.0)),
    ///         ..ShaftSpec::default()
    ///     })
    ///     .scenario(
    ///         ScenarioSpec::new("start", Time::s(3.0))
    ///             .initial_speed("motor", AngularSpeed::rad_s(100.0))
    ///             .source(SourceSpec::torque("motor", Torque::n_m(40.0)))
    ///             .engagement("C", SignalSpec::ramp(0.0, 1.0, Time::s(0.5), Time::ms(100.0))),
    ///     )
    ///     .build()?;
    /// let scenario = train.scenario("start").unwrap();
    /// assert_eq!(scenario.end, 3.0);
    /// assert_eq!(scenario.sources[0].name, "torque on motor");
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    ScenarioSpec => PlainScenario {
        /// What it is called.
        must name: String,
        /// When it begins. Default: 0 s.
        may start: Option<Time>,
        /// How long it takes.
        may duration: Option<Time>,
        /// When it ends, instead of `duration`.
        may end: Option<Time>,
        /// Rows of output, evenly spaced in time. Default: 500.
        may samples: Option<i64> as Kind::Samples,
        /// Speeds at the start; those that the gears settle follow, what is left is at rest.
        may initial_speeds: Vec<(String, AngularSpeed)>,
        /// Twist of shafts at the start: how far the first of its members is turned beyond the second, so that a positive
        /// twist turns the first back. Default: none.
        may initial_twists: Vec<(String, Angle)>,
        /// Members held at rest from outside.
        may fixed: Vec<String>,
        /// State of the shift table whose elements are engaged. Default: none are.
        may state: Option<String> as Kind::Name,
        /// Times and states, instead of `state`: [ ["0 s", "1"], ["2 s", "2"] ].
        may gears: Option<Vec<(Time, String)>>,
        /// How long elements take to engage and to open when the gear changes. Default: 0 s.
        may shift_time: Option<Time>,
        /// What acts on members from outside, and what machines of variators do.
        may source: Vec<SourceSpec>,
        /// What the variators of the train do.
        may variator: Vec<ControlSpec>,
        /// Engagement of single shift elements over time.
        may engagement: Vec<EngagementSpec>,
    }

    /// How far a shift element is engaged over time; instead of what `state` or `gears` say of it.
    EngagementSpec => PlainEngagement {
        /// The shift element.
        must element: String as Kind::Name,
        /// From 0, open, to 1, fully engaged.
        must value: SignalSpec<f64>,
    }

    /// What a variator does over time. One with two members has a ratio, or a torque; of one with machines the store may
    /// be said, and the machines are sources.
    ControlSpec => PlainControl {
        /// The variator.
        must name: String as Kind::Name,
        /// Speed of its first member over that of its second.
        may ratio: Option<SignalSpec<f64>>,
        /// How fast the ratio changes, instead of `ratio`, from `initial_ratio` on: "0.1 1/s".
        may ratio_rate: Option<SignalSpec<Frequency>>,
        /// The ratio at the start, with `ratio_rate`.
        may initial_ratio: Option<f64>,
        /// true: ratios are those of the second member's speed over the first's; for a second member that stands still.
        may inverse: bool,
        /// Torque that it exerts on its first member, instead of a ratio.
        may torque: Option<SignalSpec<Torque>>,
        /// Power out of its store into the bus. Default: that of the variator; where all machines have sources, whatever
        /// balances the bus.
        may store: Option<SignalSpec<Power>>,
    }

    /// What acts on a member from outside: exactly one of torque, speed, controller, linear, quadratic, vehicle, motor.
    SourceSpec => PlainSource {
        /// What it is called. Default: after what it is, `torque on sun`.
        may name: Option<String>,
        /// The member it acts on.
        may member: Option<String> as Kind::Name,
        /// The machine of a variator that does this, instead of `member`: it acts on the member of the machine, with power
        /// from the bus.
        may machine: Option<String> as Kind::Name,
        /// A torque on the member.
        may torque: Option<SignalSpec<Torque>>,
        /// A prescribed speed; its torque is a result.
        may speed: Option<SignalSpec<AngularSpeed>>,
        /// A torque that seeks a speed.
        may controller: Option<ControllerSpec>,
        /// torque - slope (w - about).
        may linear: Option<LinearSpec>,
        /// torque - factor (w - about)^2, against the direction of w - about.
        may quadratic: Option<QuadraticSpec>,
        /// A vehicle on its wheels.
        may vehicle: Option<VehicleSpec>,
        /// A motor with its full-load curve and a throttle.
        may motor: Option<MotorSpec>,
    }

    /// A speed controller: feed_forward + proportional e + integral of e + derivative of e, where e = setpoint - w.
    ControllerSpec => PlainController {
        /// The speed wanted.
        must setpoint: SignalSpec<AngularSpeed>,
        /// Torque without any error. Default: 0 N m.
        may feed_forward: Option<SignalSpec<Torque>>,
        /// Torque over error. Default: none.
        may proportional: Option<ViscousCoefficient>,
        /// Torque over the integral of the error. Default: none.
        may integral: Option<Stiffness>,
        /// Torque over the rate of the error; acts as an added inertia. Default: none.
        may derivative: Option<TorquePerAcceleration>,
    }

    /// A torque that falls in a straight line with speed.
    LinearSpec => PlainLinear {
        /// Torque at the speed `about`. Default: 0 N m.
        may torque: Option<Torque>,
        /// Default: 0 rad/s.
        may about: Option<AngularSpeed>,
        /// Fall of the torque over speed. Default: none.
        may slope: Option<ViscousCoefficient>,
    }

    /// A torque that falls with the square of speed: fans, air.
    QuadraticSpec => PlainQuadratic {
        /// Torque at the speed `about`. Default: 0 N m.
        may torque: Option<Torque>,
        /// Default: 0 rad/s.
        may about: Option<AngularSpeed>,
        /// Fall of the torque over the square of speed. Default: none.
        may factor: Option<TorquePerSpeedSquared>,
        /// true: the torque does not follow the direction of rotation.
        may even: bool,
    }

    /// A vehicle on its wheels: mass, rolling resistance, air and slope.
    VehicleSpec => PlainVehicle {
        /// Mass of the vehicle.
        must mass: Mass,
        /// Rolling radius of the wheels.
        must wheel_radius: Length,
        /// Turns of the member to one turn of the wheels. Default: 1.
        may final_drive: Option<f64>,
        /// Rolling resistance coefficient; holds the vehicle at rest. Default: 0.
        may rolling: Option<f64>,
        /// Drag coefficient times frontal area. Default: 0 m^2.
        may drag_area: Option<Area>,
        /// Default: 1.2 kg/m^3.
        may air_density: Option<Density>,
        /// Slope of the road, rise over run. Default: 0.
        may grade: Option<SignalSpec<f64>>,
    }

    /// A motor: between the torque it drags with and its full-load torque.
    MotorSpec => PlainMotor {
        /// Torque over speed at full throttle.
        must full_load: Vec<(AngularSpeed, Torque)>,
        /// Torque over speed at closed throttle, negative for drag. Default: 0 N m.
        may closed: Option<Vec<(AngularSpeed, Torque)>>,
        /// From 0, closed, to 1, full load. Default: 1.
        may throttle: Option<SignalSpec<f64>>,
    }
}

/// A value over time: of torques, of speeds or of plain numbers.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum SignalSpec<Q> {
    /// Always the same.
    Constant(Q),
    /// A jump by `height` at a time (at 0 s unless given) from `offset` (0 unless given).
    Step { offset: Option<Q>, height: Q, at: Option<Time> },
    /// A straight rise by `height` within `duration`.
    Ramp { offset: Option<Q>, height: Q, at: Option<Time>, duration: Time },
    /// `offset + amplitude exp(-decay (t - at)) sin(2 π frequency (t - at) + phase)`; before `at` the offset.
    Sine {
        offset: Option<Q>,
        amplitude: Q,
        frequency: Frequency,
        phase: Option<Angle>,
        at: Option<Time>,
        decay: Option<Frequency>,
    },
    /// A value that comes for the part `width` (0.5 unless given) of each period and goes.
    Pulse { offset: Option<Q>, amplitude: Q, period: Time, width: Option<f64>, at: Option<Time> },
    /// Through points in time; level before the first and after the last, and with `hold` from each to the next. Two
    /// points of one time are a jump.
    Table { points: Vec<(Time, Q)>, hold: bool },
    /// Through the points of two columns of a CSV file, times in s and values in SI units.
    Csv { file: String, time: String, value: String, hold: bool },
    /// A formula of the time `t`, s, and of speeds `w_member`, rad/s; its value is in SI units.
    Expression { formula: String },
    /// A signal times a plain one.
    Product(Box<(SignalSpec<Q>, SignalSpec<f64>)>),
}

impl<Q> SignalSpec<Q> {
    /// From `offset` at a time in a straight line to `offset + height` after `duration`.
    pub fn ramp(offset: Q, height: Q, at: Time, duration: Time) -> Self {
        Self::Ramp { offset: Some(offset), height, at: Some(at), duration }
    }

    /// `offset`, and `height` more from a time on.
    pub fn step(offset: Q, height: Q, at: Time) -> Self {
        Self::Step { offset: Some(offset), height, at: Some(at) }
    }

    /// Straight lines through points in time.
    pub fn table(points: impl IntoIterator<Item = (Time, Q)>) -> Self {
        Self::Table { points: points.into_iter().collect(), hold: false }
    }

    /// A formula of the time `t`, s, and of speeds `w_member`, rad/s; its value is in SI units.
    pub fn formula(text: impl Into<String>) -> Self {
        Self::Expression { formula: text.into() }
    }

    /// The product of two signals, the second of plain numbers.
    pub fn product(first: impl Into<Self>, second: impl Into<SignalSpec<f64>>) -> Self {
        Self::Product(Box::new((first.into(), second.into())))
    }
}

impl<Q> From<Q> for SignalSpec<Q> {
    fn from(value: Q) -> Self {
        Self::Constant(value)
    }
}

macro_rules! signal_tables {
    ($($(#[doc = $doc:literal])+ $name:literal => $table:ident {
        $($(#[doc = $about:literal])+ $need:ident $field:ident: $type:ty,)*
    })+) => {$(
        /// The keys of one type of signal.
        struct $table<Q>(std::marker::PhantomData<Q>);

        impl<Q: Measured + Field + 'static> $table<Q> {
            const TYPED: TypedTable = ($name, &Table {
                doc: concat!($($doc, "\n"),+),
                groups: &[&[
                    TYPE,
                    $(crate::train::format::keys::Key {
                        name: stringify!($field),
                        kind: <$type as Field>::KIND,
                        required: super::field::specification!(@$need),
                        doc: concat!($($about, "\n"),+),
                    },)*
                ]],
            });
        }
    )+};
}

const TYPE: crate::train::format::keys::Key = crate::train::format::keys::Key {
    name: "type",
    kind: Kind::Text,
    required: true,
    doc: "How the value changes over time.",
};

signal_tables! {
    /// A jump.
    "step" => Step {
        /// Value before. Default: 0.
        may offset: Option<Q>,
        /// The jump.
        must height: Q,
        /// When. Default: 0 s.
        may at: Option<Time>,
    }
    /// A straight rise.
    "ramp" => Ramp {
        /// Value before. Default: 0.
        may offset: Option<Q>,
        /// The rise.
        must height: Q,
        /// When. Default: 0 s.
        may at: Option<Time>,
        /// How long it takes.
        must duration: Time,
    }
    /// offset + amplitude exp(-decay (t - at)) sin(2 pi frequency (t - at) + phase); before `at` the offset.
    "sine" => Sine {
        /// Mean. Default: 0.
        may offset: Option<Q>,
        /// Amplitude.
        must amplitude: Q,
        /// Frequency, "2 Hz".
        must frequency: Frequency,
        /// Default: 0 deg.
        may phase: Option<Angle>,
        /// When. Default: 0 s.
        may at: Option<Time>,
        /// How fast it fades, "0.5 1/s". Default: not.
        may decay: Option<Frequency>,
    }
    /// A value that comes and goes.
    "pulse" => Pulse {
        /// Value between pulses. Default: 0.
        may offset: Option<Q>,
        /// Height of a pulse.
        must amplitude: Q,
        /// From one pulse to the next.
        must period: Time,
        /// Part of the period that a pulse takes, 0 to 1. Default: 0.5.
        may width: Option<f64>,
        /// When. Default: 0 s.
        may at: Option<Time>,
    }
    /// Through points in time; level before the first and after the last. Two points of one time are a jump.
    "table" => Points {
        /// Times and values.
        must points: Vec<(Time, Q)>,
        /// true: level from each point to the next, instead of straight lines.
        may hold: bool,
    }
    /// Through the points of a CSV file: a header row, commas, values in SI units.
    "csv" => Csv {
        /// The file, seen from the train file.
        must file: String,
        /// Name of the column with the times, s.
        must time: String,
        /// Name of the column with the values, SI.
        must value: String,
        /// true: level from each point to the next, instead of straight lines.
        may hold: bool,
    }
    /// A formula of the time t and of speeds w_member in rad/s; its value is in SI units.
    "expression" => Expression {
        /// Such as "60 + 200*sin(4*PI*t) - 3*w_sun".
        must formula: String,
    }
    /// The product of two signals.
    "product" => Product {
        /// A signal of this kind, and one of plain numbers.
        must of: Both<Q>,
    }
}

/// The two signals of a product.
struct Both<Q>((SignalSpec<Q>, SignalSpec<f64>));

fn kind_of<Q: Measured + Field + 'static>() -> &'static SignalKind {
    const {
        &SignalKind {
            of: Q::MEASURE,
            types: &[
                Step::<Q>::TYPED,
                Ramp::<Q>::TYPED,
                Sine::<Q>::TYPED,
                Pulse::<Q>::TYPED,
                Points::<Q>::TYPED,
                Csv::<Q>::TYPED,
                Expression::<Q>::TYPED,
                Product::<Q>::TYPED,
            ],
        }
    }
}

impl<Q: Measured + Field + 'static> Field for Both<Q> {
    const KIND: Kind = Kind::Product([kind_of::<Q>, kind_of::<f64>]);
    type Plain = ();
    fn read(node: &Node) -> Self {
        match node {
            Node::Tables(two) if two.len() == 2 => {
                Self((Field::read(two[0].node("value")), Field::read(two[1].node("value"))))
            }
            node => unreachable!("a product is read as two values, here is {node:?}"),
        }
    }
    fn blank() -> Self {
        Self((Field::blank(), Field::blank()))
    }
    fn write(&self) -> Option<Datum> {
        Some(Datum::List(vec![self.0.0.write()?, self.0.1.write()?]))
    }
    fn plain(&self) {}
}

impl<Q: Measured + Field + 'static> Field for SignalSpec<Q> {
    const KIND: Kind = Kind::Signal(kind_of::<Q>);
    /// Signals are checked as they are: formulas and files need the train.
    type Plain = SignalSpec<f64>;

    fn read(node: &Node) -> Self {
        let s = match node {
            Node::Amount(amount) => return Self::Constant(Q::of(amount)),
            Node::Table(fields) => fields,
            node => unreachable!("the reader keeps to the kind of a key, here is {node:?}"),
        };
        match s.get::<String>("type").as_str() {
            "step" => Self::Step { offset: s.get("offset"), height: s.get("height"), at: s.get("at") },
            "ramp" => Self::Ramp {
                offset: s.get("offset"),
                height: s.get("height"),
                at: s.get("at"),
                duration: s.get("duration"),
            },
            "sine" => Self::Sine {
                offset: s.get("offset"),
                amplitude: s.get("amplitude"),
                frequency: s.get("frequency"),
                phase: s.get("phase"),
                at: s.get("at"),
                decay: s.get("decay"),
            },
            "pulse" => Self::Pulse {
                offset: s.get("offset"),
                amplitude: s.get("amplitude"),
                period: s.get("period"),
                width: s.get("width"),
                at: s.get("at"),
            },
            "table" => Self::Table { points: s.get("points"), hold: s.get("hold") },
            "csv" => Self::Csv { file: s.get("file"), time: s.get("time"), value: s.get("value"), hold: s.get("hold") },
            "expression" => Self::Expression { formula: s.get("formula") },
            "product" => {
                let Both(of) = s.get::<Both<Q>>("of");
                Self::Product(Box::new(of))
            }
            name => unreachable!("the reader knows the types of signals, here is {name}"),
        }
    }

    fn blank() -> Self {
        Self::Constant(Q::blank())
    }

    fn write(&self) -> Option<Datum> {
        let table = |name: &str, entries: Vec<(&str, Option<Datum>)>| {
            let name = ("type".to_owned(), Datum::Text(name.to_owned()));
            let entries = entries.into_iter().filter_map(|(key, datum)| Some((key.to_owned(), datum?)));
            Some(Datum::Table(std::iter::once(name).chain(entries).collect()))
        };
        match self {
            Self::Constant(value) => Field::write(value),
            Self::Step { offset, height, at } => {
                table("step", vec![("offset", offset.write()), ("height", height.write()), ("at", at.write())])
            }
            Self::Ramp { offset, height, at, duration } => table(
                "ramp",
                vec![
                    ("offset", offset.write()),
                    ("height", height.write()),
                    ("at", at.write()),
                    ("duration", duration.write()),
                ],
            ),
            Self::Sine { offset, amplitude, frequency, phase, at, decay } => table(
                "sine",
                vec![
                    ("offset", offset.write()),
                    ("amplitude", amplitude.write()),
                    ("frequency", frequency.write()),
                    ("phase", phase.write()),
                    ("at", at.write()),
                    ("decay", decay.write()),
                ],
            ),
            Self::Pulse { offset, amplitude, period, width, at } => table(
                "pulse",
                vec![
                    ("offset", offset.write()),
                    ("amplitude", amplitude.write()),
                    ("period", period.write()),
                    ("width", width.write()),
                    ("at", at.write()),
                ],
            ),
            Self::Table { points, hold } => table("table", vec![("points", points.write()), ("hold", hold.write())]),
            Self::Csv { file, time, value, hold } => table(
                "csv",
                vec![("file", file.write()), ("time", time.write()), ("value", value.write()), ("hold", hold.write())],
            ),
            Self::Expression { formula } => table("expression", vec![("formula", formula.write())]),
            Self::Product(of) => {
                let of = Some(Datum::List(vec![of.0.write()?, of.1.write()?]));
                table("product", vec![("of", of)])
            }
        }
    }

    fn plain(&self) -> SignalSpec<f64> {
        let si = |q: &Q| q.number();
        let maybe = |q: &Option<Q>| q.as_ref().map(si);
        let (some, copy) = (Option::<Time>::clone, Time::clone);
        match self {
            Self::Constant(value) => SignalSpec::Constant(si(value)),
            Self::Step { offset, height, at } => {
                SignalSpec::Step { offset: maybe(offset), height: si(height), at: some(at) }
            }
            Self::Ramp { offset, height, at, duration } => {
                SignalSpec::Ramp { offset: maybe(offset), height: si(height), at: some(at), duration: copy(duration) }
            }
            Self::Sine { offset, amplitude, frequency, phase, at, decay } => SignalSpec::Sine {
                offset: maybe(offset),
                amplitude: si(amplitude),
                frequency: frequency.clone(),
                phase: phase.clone(),
                at: some(at),
                decay: decay.clone(),
            },
            Self::Pulse { offset, amplitude, period, width, at } => SignalSpec::Pulse {
                offset: maybe(offset),
                amplitude: si(amplitude),
                period: copy(period),
                width: *width,
                at: some(at),
            },
            Self::Table { points, hold } => {
                SignalSpec::Table { points: points.iter().map(|(t, x)| (copy(t), si(x))).collect(), hold: *hold }
            }
            Self::Csv { file, time, value, hold } => {
                SignalSpec::Csv { file: file.clone(), time: time.clone(), value: value.clone(), hold: *hold }
            }
            Self::Expression { formula } => SignalSpec::Expression { formula: formula.clone() },
            Self::Product(of) => SignalSpec::Product(Box::new((of.0.plain(), of.1.clone()))),
        }
    }
}

impl ScenarioSpec {
    /// Rows of output unless given.
    pub(crate) const SAMPLES: i64 = 500;

    /// From time zero, for so long.
    pub fn new(name: impl Into<String>, duration: Time) -> Self {
        Self { name: name.into(), duration: Some(duration), ..Self::default() }
    }

    /// Begins at another time than zero.
    #[must_use]
    pub fn start(mut self, time: Time) -> Self {
        self.start = Some(time);
        self
    }

    /// Rows of output, evenly spaced in time; 500 unless given.
    #[must_use]
    pub fn samples(mut self, samples: i64) -> Self {
        self.samples = Some(samples);
        self
    }

    /// Speed of a member at the start.
    #[must_use]
    pub fn initial_speed(mut self, member: &str, speed: AngularSpeed) -> Self {
        self.initial_speeds.push((member.into(), speed));
        self
    }

    /// Twist of a shaft at the start.
    #[must_use]
    pub fn initial_twist(mut self, shaft: &str, twist: Angle) -> Self {
        self.initial_twists.push((shaft.into(), twist));
        self
    }

    /// Holds a member at rest from outside.
    #[must_use]
    pub fn fixed(mut self, member: &str) -> Self {
        self.fixed.push(member.into());
        self
    }

    /// Engages the elements of a state of the shift table throughout.
    #[must_use]
    pub fn state(mut self, name: &str) -> Self {
        self.state = Some(name.into());
        self
    }

    /// Engages the elements of states one after the other: at each time a state. An element takes `shift_time` to
    /// engage or to open.
    #[must_use]
    pub fn gears<'a>(mut self, gears: impl IntoIterator<Item = (Time, &'a str)>, shift_time: Time) -> Self {
        self.gears = Some(gears.into_iter().map(|(t, s)| (t, s.to_owned())).collect());
        self.shift_time = Some(shift_time);
        self
    }

    /// Adds something that acts on a member from outside.
    #[must_use]
    pub fn source(mut self, source: SourceSpec) -> Self {
        self.source.push(source);
        self
    }

    /// Says what a variator does over time.
    #[must_use]
    pub fn variator(mut self, control: ControlSpec) -> Self {
        self.variator.push(control);
        self
    }

    /// Says how far a shift element is engaged over time, 0 to 1; instead of what the state says.
    #[must_use]
    pub fn engagement(mut self, element: &str, value: impl Into<SignalSpec<f64>>) -> Self {
        self.engagement.push(EngagementSpec { element: element.into(), value: value.into() });
        self
    }
}

impl ControlSpec {
    /// Of a variator with two members: the speed of its first member over that of its second.
    pub fn ratio(name: impl Into<String>, ratio: impl Into<SignalSpec<f64>>) -> Self {
        Self { name: name.into(), ratio: Some(ratio.into()), ..Self::default() }
    }

    /// The same, changing at a rate from where it begins.
    pub fn ratio_rate(name: impl Into<String>, initial: f64, rate: impl Into<SignalSpec<Frequency>>) -> Self {
        Self { name: name.into(), ratio_rate: Some(rate.into()), initial_ratio: Some(initial), ..Self::default() }
    }

    /// Of a variator with two members: the torque that it exerts on the first.
    pub fn torque(name: impl Into<String>, torque: impl Into<SignalSpec<Torque>>) -> Self {
        Self { name: name.into(), torque: Some(torque.into()), ..Self::default() }
    }

    /// Of a variator with machines: the power out of its store.
    pub fn store(name: impl Into<String>, power: impl Into<SignalSpec<Power>>) -> Self {
        Self { name: name.into(), store: Some(power.into()), ..Self::default() }
    }
}

impl SourceSpec {
    fn on(member: impl Into<String>) -> Self {
        Self { member: Some(member.into()), ..Self::default() }
    }

    /// An external torque.
    pub fn torque(member: impl Into<String>, torque: impl Into<SignalSpec<Torque>>) -> Self {
        Self { torque: Some(torque.into()), ..Self::on(member) }
    }

    /// A prescribed speed.
    pub fn speed(member: impl Into<String>, speed: impl Into<SignalSpec<AngularSpeed>>) -> Self {
        Self { speed: Some(speed.into()), ..Self::on(member) }
    }

    /// A torque that seeks a speed.
    pub fn controller(member: impl Into<String>, controller: ControllerSpec) -> Self {
        Self { controller: Some(controller), ..Self::on(member) }
    }

    /// A torque that falls in a straight line with speed.
    pub fn linear(member: impl Into<String>, load: LinearSpec) -> Self {
        Self { linear: Some(load), ..Self::on(member) }
    }

    /// A torque that falls with the square of speed.
    pub fn quadratic(member: impl Into<String>, load: QuadraticSpec) -> Self {
        Self { quadratic: Some(load), ..Self::on(member) }
    }

    /// A vehicle on its wheels.
    pub fn vehicle(member: impl Into<String>, vehicle: VehicleSpec) -> Self {
        Self { vehicle: Some(vehicle), ..Self::on(member) }
    }

    /// A motor.
    pub fn motor(member: impl Into<String>, motor: MotorSpec) -> Self {
        Self { motor: Some(motor), ..Self::on(member) }
    }

    /// Lets a machine of a variator do it, with power from its bus.
    #[must_use]
    pub fn by_machine(mut self, machine: impl Into<String>) -> Self {
        (self.member, self.machine) = (None, Some(machine.into()));
        self
    }

    /// Names it; otherwise it is called after what it is.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }
}
