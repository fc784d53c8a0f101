//! The dynamic layer of a train as a person describes it: inertias, drags, shafts, friction of
//! shift elements, and the motions to simulate. All quantities SI; members, states and elements by
//! name.

use crate::train::dynamic::{Contact, LossRow, Signal, SourceKind};

use super::{MeshSpec, PlanetSpec, SetSpec, ShiftElementSpec, TrainBuilder};

/// Points of a curve: abscissa and value.
pub(crate) type Points = Vec<[f64; 2]>;

/// Friction between two members that does not depend on tooth loads. It has a `coulomb` torque, a
/// `viscous` coefficient or a `table`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DragSpec {
    /// What it is called.
    pub name: String,
    /// The members; one means against the frame. At a planet of a set it stands for every planet.
    pub members: Vec<String>,
    /// Torque at any speed, N m.
    pub coulomb: Option<f64>,
    /// Torque over relative speed, N m s/rad.
    pub viscous: Option<f64>,
    /// Torque over the amount of relative speed, rad/s to N m, instead of `coulomb`.
    pub table: Option<Vec<[f64; 2]>>,
    /// Torque at which it breaks away over that at which it slides; 1 unless given.
    pub peak: Option<f64>,
}

/// An elastic shaft. It has a stiffness or a damping.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaftSpec {
    /// What it is called.
    pub name: String,
    /// The members it joins; one means to the frame.
    pub members: Vec<String>,
    /// Torque over twist, N m/rad.
    pub stiffness: Option<f64>,
    /// Torque over the rate of twist, N m s/rad.
    pub damping: Option<f64>,
    /// Whole backlash, rad.
    pub backlash: Option<f64>,
    /// What happens at its ends.
    pub contact: Contact,
}

/// What a shift element can hold, as far as given.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FrictionSpec {
    /// N m
    pub capacity: Option<f64>,
    /// Coefficient, or factor on the capacity, over slip.
    pub coefficient: Option<Points>,
    /// N
    pub normal_force: Option<f64>,
    /// Mean radius times the number of surfaces, m.
    pub effective_radius: Option<f64>,
    pub peak: Option<f64>,
}

/// A value over time, before the names in it are looked up.
#[derive(Clone, Debug, PartialEq)]
pub enum SignalSpec {
    /// As given.
    Given(Signal),
    /// A formula of the time `t` and of speeds `w_member`, rad/s.
    Formula(String),
    /// The product of two.
    Product(Box<[SignalSpec; 2]>),
}

impl SignalSpec {
    /// A formula of the time `t` and of speeds `w_member`, rad/s; its value is in SI units.
    pub fn formula(text: impl Into<String>) -> Self {
        Self::Formula(text.into())
    }

    /// The product of two signals.
    pub fn product(first: impl Into<Self>, second: impl Into<Self>) -> Self {
        Self::Product(Box::new([first.into(), second.into()]))
    }
}

impl From<f64> for SignalSpec {
    fn from(value: f64) -> Self {
        Self::Given(Signal::Constant(value))
    }
}

impl From<Signal> for SignalSpec {
    fn from(signal: Signal) -> Self {
        Self::Given(signal)
    }
}

/// What acts on a member, before it is checked: signals by [`SignalSpec`], curves by their points.
pub type SourceKindSpec = SourceKind<SignalSpec, Vec<[f64; 2]>>;

/// Something that acts on a member from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceSpec {
    pub(crate) name: Option<String>,
    pub(crate) member: String,
    pub(crate) kind: SourceKindSpec,
}

impl SourceSpec {
    /// Anything that acts on a member.
    pub fn new(member: impl Into<String>, kind: SourceKindSpec) -> Self {
        Self { name: None, member: member.into(), kind }
    }

    /// An external torque, N m.
    pub fn torque(member: impl Into<String>, torque: impl Into<SignalSpec>) -> Self {
        Self::new(member, SourceKind::Torque(torque.into()))
    }

    /// A prescribed speed, rad/s.
    pub fn speed(member: impl Into<String>, speed: impl Into<SignalSpec>) -> Self {
        Self::new(member, SourceKind::Speed(speed.into()))
    }

    /// Names it; otherwise it is called after what it is.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }
}

/// How the shift elements are engaged in a scenario.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EngagementSpec {
    pub element: String,
    pub value: SignalSpec,
}

/// A motion to simulate.
///
/// # Example
/// A flywheel is braked by a clutch that closes within a tenth of a second.
/// ```
/// use willis::train::{ScenarioSpec, ShaftSpec, ShiftElementSpec, Signal, SourceSpec, Train};
///
/// let train = Train::builder("flywheel and clutch")
///     .members(["motor", "wheel"])
///     .inertia("motor", 0.2)
///     .inertia("wheel", 1.5)
///     .shift_element(ShiftElementSpec::clutch("C", "motor", "wheel").capacity(80.0))
///     .shaft(ShaftSpec {
///         name: "output shaft".into(),
///         members: vec!["wheel".into()],
///         stiffness: Some(1e4),
///         damping: Some(2.0),
///         ..ShaftSpec::default()
///     })
///     .scenario(
///         ScenarioSpec::new("start", 3.0)
///             .initial_speed("motor", 100.0)
///             .source(SourceSpec::torque("motor", 40.0))
///             .engagement("C", Signal::Ramp { offset: 0.0, height: 1.0, at: 0.5, duration: 0.1 }),
///     )
///     .build()?;
/// let scenario = train.scenario("start").unwrap();
/// assert_eq!(scenario.end, 3.0);
/// assert_eq!(scenario.sources[0].name, "torque on motor");
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioSpec {
    pub(crate) name: String,
    pub(crate) start: f64,
    pub(crate) duration: Option<f64>,
    pub(crate) end: Option<f64>,
    pub(crate) samples: i64,
    pub(crate) initial_speeds: Vec<(String, f64)>,
    pub(crate) initial_twists: Vec<(String, f64)>,
    pub(crate) fixed: Vec<String>,
    pub(crate) state: Option<String>,
    pub(crate) gears: Option<Vec<(f64, String)>>,
    pub(crate) shift_time: Option<f64>,
    pub(crate) sources: Vec<SourceSpec>,
    pub(crate) engagements: Vec<EngagementSpec>,
}

impl ScenarioSpec {
    /// Rows of output unless given.
    pub(crate) const SAMPLES: i64 = 500;

    /// From time zero, for so many seconds.
    pub fn new(name: impl Into<String>, duration: f64) -> Self {
        Self { duration: Some(duration), ..Self::empty(name) }
    }

    pub(crate) fn empty(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            start: 0.0,
            duration: None,
            end: None,
            samples: Self::SAMPLES,
            initial_speeds: vec![],
            initial_twists: vec![],
            fixed: vec![],
            state: None,
            gears: None,
            shift_time: None,
            sources: vec![],
            engagements: vec![],
        }
    }

    /// Begins at another time than zero, s.
    #[must_use]
    pub fn start(mut self, time: f64) -> Self {
        self.start = time;
        self
    }

    /// Rows of output, evenly spaced in time; 500 unless given.
    #[must_use]
    pub fn samples(mut self, samples: i64) -> Self {
        self.samples = samples;
        self
    }

    /// Speed of a member at the start, rad/s.
    #[must_use]
    pub fn initial_speed(mut self, member: &str, speed: f64) -> Self {
        self.initial_speeds.push((member.into(), speed));
        self
    }

    /// Twist of a shaft at the start, rad.
    #[must_use]
    pub fn initial_twist(mut self, shaft: &str, twist: f64) -> Self {
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

    /// Engages the elements of states one after the other: at each time, s, a state. An element
    /// takes `shift_time`, s, to engage or to open.
    #[must_use]
    pub fn gears<'a>(mut self, gears: impl IntoIterator<Item = (f64, &'a str)>, shift_time: f64) -> Self {
        self.gears = Some(gears.into_iter().map(|(t, s)| (t, s.to_owned())).collect());
        self.shift_time = Some(shift_time);
        self
    }

    /// Adds something that acts on a member from outside.
    #[must_use]
    pub fn source(mut self, source: SourceSpec) -> Self {
        self.sources.push(source);
        self
    }

    /// Says how far a shift element is engaged over time, 0 to 1; instead of what the state says.
    #[must_use]
    pub fn engagement(mut self, element: &str, value: impl Into<SignalSpec>) -> Self {
        self.engagements.push(EngagementSpec { element: element.into(), value: value.into() });
        self
    }
}

impl ShiftElementSpec {
    /// Torque that it transmits when fully engaged and sliding, N m; unlimited unless given.
    #[must_use]
    pub fn capacity(mut self, torque: f64) -> Self {
        self.friction.capacity = Some(torque);
        self
    }

    /// Coefficient of friction over slip, rad/s; with [`Self::pressed`]. With [`Self::capacity`] a
    /// factor on it.
    #[must_use]
    pub fn friction(mut self, points: Vec<[f64; 2]>) -> Self {
        self.friction.coefficient = Some(points);
        self
    }

    /// Force on the friction surfaces when fully engaged, N, and mean radius times number of
    /// surfaces, m.
    #[must_use]
    pub fn pressed(mut self, normal_force: f64, effective_radius: f64) -> Self {
        self.friction.normal_force = Some(normal_force);
        self.friction.effective_radius = Some(effective_radius);
        self
    }

    /// Torque at which it breaks away over that at which it slides; 1 unless given.
    #[must_use]
    pub fn peak(mut self, factor: f64) -> Self {
        self.friction.peak = Some(factor);
        self
    }
}

impl MeshSpec {
    /// Gives efficiency and bearing torque over speed, instead of an efficiency.
    #[must_use]
    pub fn loss_table(mut self, rows: Vec<LossRow>) -> Self {
        self.loss_table = Some(rows);
        self
    }
}

/// Mass and inertia of one planet of a set.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanetBodySpec {
    /// Mass, kg.
    pub mass: Option<f64>,
    /// Moment of inertia about its own axis, kg m².
    pub inertia: Option<f64>,
    /// Distance of its axis from the carrier's, m; `None`: as the geometry gives it.
    pub orbit_radius: Option<f64>,
}

impl SetSpec {
    /// Mass and inertia of each planet (of the first kind, where there are two).
    #[must_use]
    pub fn planet_body(self, body: PlanetBodySpec) -> Self {
        self.body_of(0, body)
    }

    /// Mass and inertia of each planet of the second kind (outer, long).
    ///
    /// # Panics
    /// On a set with one kind of planet.
    #[must_use]
    pub fn second_planet_body(self, body: PlanetBodySpec) -> Self {
        self.body_of(1, body)
    }

    fn body_of(mut self, kind: usize, body: PlanetBodySpec) -> Self {
        let mut planets = self.planets_mut();
        let planet: &mut PlanetSpec = planets.get_mut(kind).expect("this set has one kind of planet");
        planet.body = body;
        self
    }
}

impl TrainBuilder {
    /// Gives the moment of inertia of a member about its axis, kg m²; of planets, of all of them
    /// together.
    #[must_use]
    pub fn inertia(mut self, member: &str, value: f64) -> Self {
        self.inertias.push((member.into(), value));
        self
    }

    /// Adds friction that does not depend on tooth loads.
    #[must_use]
    pub fn drag(mut self, drag: DragSpec) -> Self {
        self.drags.push(drag);
        self
    }

    /// Adds an elastic shaft.
    #[must_use]
    pub fn shaft(mut self, shaft: ShaftSpec) -> Self {
        self.shafts.push(shaft);
        self
    }

    /// Adds a motion to simulate.
    #[must_use]
    pub fn scenario(mut self, scenario: ScenarioSpec) -> Self {
        self.scenarios.push(scenario);
        self
    }
}
