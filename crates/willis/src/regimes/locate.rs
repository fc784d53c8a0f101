//! In which regime an operating point lies, how far it is to each boundary, and what changes there.

mod equilibria;
mod point;
mod range;
mod request;
mod surroundings;

use serde::{Deserialize, Serialize};

use crate::analysis::{NameMap, Role, SolutionReport, StictionRange, operate_unnamed};
use crate::contract::{Contract, Format};
use crate::diagnostic::Diagnostics;
use crate::exact::Rational;
use crate::symbolic::Notation;
use crate::train::Train;

use super::atlas::{drivers, order, role};
use super::basis::EfficiencyBasis;
use super::cells::efficiency_at;
use super::formula::{Efficiencies, Ratios, Shape, element_label};

use equilibria::{Equilibria, State, equilibria};
use point::Point;
use range::{speed_axes, speed_range, torque_range};
use surroundings::Surroundings;

pub use range::{Edge, PrescribedRange, Prescribes};
use request::Given;

pub use request::LocateRequest;

/// Where an operating point lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Location {
    /// `willis-location-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// The state.
    pub state: String,
    /// Speeds by terminal, rad/s.
    pub speeds_rad_s: NameMap<f64>,
    /// The order of the speeds.
    pub order: Vec<String>,
    /// Planes on which the point lies exactly: on the boundary between regions.
    pub on: Vec<String>,
    /// Number of the region, where the regions were enumerated and the point is inside one.
    pub region: Option<usize>,
    /// Whether every equilibrium was found.
    pub complete: bool,
    /// Why there is none, or what else must be known.
    pub reason: Option<String>,
    /// The equilibria; more than one where friction leaves a choice.
    pub regimes: Vec<Located>,
    /// Where mesh efficiencies come from whose losses laws compute: this point, where it has exactly one equilibrium.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_basis: Option<EfficiencyBasis>,
}

impl Contract for Location {
    const FORMAT: &'static str = "willis-location-1";
}

/// An equilibrium and its surroundings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Located {
    /// Name of the regime as `willis regimes` lists it, where that list was made.
    pub regime: Option<String>,
    /// Torques by terminal, N m.
    pub torques_n_m: NameMap<f64>,
    /// Powers into the train by terminal, W.
    pub powers_w: NameMap<f64>,
    /// What each terminal does.
    pub roles: NameMap<Role>,
    /// Which end drives each element.
    pub drivers: NameMap<Option<String>>,
    /// Output over input power; zero when all is dissipated.
    pub efficiency: f64,
    /// The same, exactly.
    pub efficiency_exact: Rational,
    /// The closed formula, where the train is small enough.
    pub formula: Option<String>,
    /// For each prescribed value the range within which the regime lasts, all others fixed.
    pub ranges: Vec<PrescribedRange>,
    /// Loaded meshes, or sets, without relative motion: their friction may be anything up to its limit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub at_rest: Vec<String>,
    /// What that leaves open, where [`analyze`](crate::analyze) tells it. The torques above are those in which these
    /// meshes lose nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stiction: Vec<StictionRange>,
}

/// Finds the regime of an operating point.
///
/// # Errors
/// Names that the train does not have; speeds that contradict each other; too few or too many speeds
/// or torques.
///
/// # Example
/// ```
/// use willis::regimes::{LocateRequest, locate};
/// use willis::train::{SetSpec, Train};
/// use willis::units::{self, Dimension};
///
/// let train = Train::builder("power split")
///     .members(["engine", "mg1", "ring"])
///     .terminals(["engine", "mg1", "ring"])
///     .set(SetSpec::simple("P1", ("mg1", 30), ("ring", 78), "engine").planet(24, 4).mesh_efficiency(0.99))
///     .build()?;
/// let speed = |text| units::parse(text, Dimension::ANGULAR_SPEED).unwrap();
/// let found = locate(&train, &LocateRequest {
///     speeds: vec![("engine".into(), speed("2000 rpm")), ("ring".into(), speed("1000 rpm"))],
///     torques: vec![("engine".into(), units::parse("100 N m", Dimension::TORQUE).unwrap())],
///     ..LocateRequest::default()
/// })?;
/// let here = &found.regimes[0];
/// assert_eq!(here.regime.as_deref(), Some("2+"));
/// // As fast as the engine the ring turns with it, and behind that another gear drives.
/// let ring = here.ranges.iter().find(|r| r.member == "ring").unwrap();
/// let limit = ring.above.as_ref().unwrap();
/// assert!((limit.at * 30.0 / std::f64::consts::PI - 2000.0).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn locate(train: &Train, request: &LocateRequest) -> Result<Location, Diagnostics> {
    let (given, mut choice) = request::read(train, request)?;
    let efficiency_basis = choice.basis.take();
    let point = Point::new(train, choice, &given)?;
    let Equilibria { states, complete, reason } = equilibria(&point.setup, &point.base, &point.loads);
    let around = Surroundings::of(&point);
    let mut regimes = located(&point, &around, &states);
    if regimes.iter().any(|r| !r.at_rest.is_empty()) {
        friction_at_rest(train, &point, &given, &mut regimes);
    }
    Ok(Location {
        format: Format::new(),
        train: train.name.clone(),
        speeds_rad_s: point.setup.by_terminal(|t| point.speed(t).to_f64() * point.speed_unit),
        order: order(&point.setup, &point.base),
        state: point.state,
        on: around.on,
        region: around.region.map(|k| k + 1),
        complete,
        reason: reason.or(around.cells.err()),
        regimes,
        efficiency_basis,
    })
}

/// What friction at rest leaves open in each equilibrium: as the analysis of the point says, where it makes one of it.
fn friction_at_rest(train: &Train, point: &Point<'_>, given: &Given, regimes: &mut [Located]) {
    let operation = given.operation(train.states().iter().position(|s| s.name == point.state));
    let Ok((report, _)) = operate_unnamed(train, &operation) else { return };
    for regime in regimes {
        let alike = |s: &&SolutionReport| {
            regime.torques_n_m.iter().all(|(name, torque)| {
                let there = s.members.get(name).and_then(|m| m.torque_n_m);
                there.is_none_or(|t| (t - torque).abs() <= 1e-9 * (t.abs() + torque.abs()))
            })
        };
        if let Some(s) = report.solutions.iter().find(alike) {
            regime.stiction.clone_from(&s.stiction);
        }
    }
}

/// Each equilibrium: what every terminal does, its formula, and how far each prescribed value can change.
fn located(point: &Point<'_>, around: &Surroundings, states: &[State]) -> Vec<Located> {
    let setup = &point.setup;
    let shape = Shape::new(setup, &[]).ok();
    let axes = speed_axes(point);
    let mut all = Vec::new();
    for s in states {
        let powers: Vec<Rational> = (0..setup.terminals.len()).map(|t| &s.torques[t] * &point.speed(t)).collect();
        let sign = |t: usize| if setup.is_end(t) { 0 } else { powers[t].sign() };
        let signs: Vec<i8> = (0..powers.len()).map(sign).collect();
        let efficiency = efficiency_at(setup, &point.base, &s.torques);
        let formula = shape.as_ref().and_then(|shape| {
            let f = shape.formula(&s.pattern, &signs, Ratios::Basic, Efficiencies::Basic).ok()?;
            Some(f.by_loss(Notation::Text).unwrap_or_else(|| f.names.show(Notation::Text, &f.efficiency)))
        });
        let speeds = axes.iter().map(|axis| speed_range(point, around, s, axis));
        let torques = (0..point.loads.len()).map(|n| torque_range(point, s, n));
        all.push(Located {
            regime: around.regime(point, s),
            torques_n_m: setup.by_terminal(|t| s.torques[t].to_f64() * point.torque_unit),
            powers_w: setup.by_terminal(|t| {
                let prescribed = point.powers.iter().find(|(own, _)| *own == t);
                prescribed.map_or(powers[t].to_f64() * point.power_unit, |(_, power)| *power)
            }),
            roles: setup.by_terminal(|t| role(signs[t])),
            drivers: NameMap(drivers(setup, &s.pattern)),
            efficiency: efficiency.to_f64(),
            efficiency_exact: efficiency,
            formula,
            ranges: speeds.chain(torques).collect(),
            at_rest: s.at_rest.iter().map(|&j| element_label(setup, j)).collect(),
            stiction: vec![],
        });
    }
    all
}
