//! What carries the heat of a train away, and what stores it, as checked data.

use crate::real::{self, Real};

use super::MemberId;

/// Stefan-Boltzmann constant, W/(m² K⁴).
const SIGMA: f64 = 5.670374419e-8;
/// Conductivity of iron, W/(m K): fins.
const IRON: f64 = 50.0;

/// What is around a gearbox, as ISO/TR 14179-1 tells it apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surroundings {
    /// A small confined space, air at rest.
    Confined,
    /// A large indoor space.
    Hall,
    /// A large indoor space with moving air, or outdoors.
    MovingAir,
}

impl Surroundings {
    /// Heat transfer coefficient, W/(m² K): the middle of 10 to 14, 17 to 20, 20 to 30.
    pub fn coefficient(self) -> f64 {
        match self {
            Self::Confined => 12.0,
            Self::Hall => 18.5,
            Self::MovingAir => 25.0,
        }
    }
}

/// What makes heat at a place of the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeatPart {
    /// Half of the tooth friction of each mesh of its gears.
    Member(MemberId),
    /// A bearing, by its place in the train.
    Bearing(usize),
    /// A seal.
    Seal(usize),
    /// A rotor.
    Rotor(usize),
    /// A variator.
    Variator(usize),
}

/// A place with one temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatNode<R = f64> {
    /// Its name; `oil` and `ambient` are always there.
    pub name: String,
    /// Its temperature, K, where it is given.
    pub fixed: Option<R>,
    /// Its heat capacity, J/K; 0 follows at once.
    pub capacity: R,
    /// What makes heat here.
    pub parts: Vec<HeatPart>,
}

/// A surface that gives heat by convection and radiation, and its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface<R = f64> {
    /// Area, m².
    pub area: R,
    /// Height, m.
    pub height: R,
    /// Emissivity.
    pub emissivity: R,
    /// Speed of air, m/s; 0 at rest.
    pub air_speed: R,
    /// Length along the air, m.
    pub flow_length: R,
    /// Part of the area that the air reaches.
    pub air_share: R,
    /// Area, height and thickness of fins, m², m, m.
    pub fins: Option<[R; 3]>,
}

/// How heat passes between two places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathLaw<R = f64> {
    /// Conductance, W/K.
    Conductance(R),
    /// Heat transfer coefficient, W/(m² K), and area, m².
    Coefficient(R, R),
    /// Convection and radiation; the second place is the air.
    Surface(Surface<R>),
}

/// A way for heat.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatPath<R = f64> {
    /// The two places.
    pub between: [usize; 2],
    /// How it passes.
    pub law: PathLaw<R>,
}

/// A cooler of the oil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cooler<R = f64> {
    /// Temperature of what cools, K.
    pub inlet: R,
    /// Oil flow, m³/s, and effectiveness; or a conductance, W/K.
    pub exchange: Exchange<R>,
    /// Where the thermostat begins to open and where it is open, K.
    pub thermostat: Option<[f64; 2]>,
}

/// What a cooler takes over the difference of temperatures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exchange<R = f64> {
    /// Oil flow, m³/s, and effectiveness.
    Flow(R, R),
    /// Conductance, W/K.
    Conductance(R),
}

/// Density of the oil over its temperature, as a cooler needs it: `ρ15 (1 + a (T − 288.15 K))`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OilHeat<R = f64> {
    /// Density at 15 °C, kg/m³.
    pub density_15: R,
    /// Relative change with temperature a, 1/K; negative.
    pub expansion: f64,
    /// Specific heat, J/(kg K).
    pub specific_heat: R,
}

/// What carries heat away: a network whose first place is the oil and whose second is the air.
#[derive(Clone, Debug, PartialEq)]
pub struct Heat<R = f64> {
    /// The places: 0 is the oil, 1 the air.
    pub nodes: Vec<HeatNode<R>>,
    /// The ways between them.
    pub paths: Vec<HeatPath<R>>,
    /// A cooler of the oil.
    pub cooler: Option<Cooler<R>>,
    /// What the oil is, for the cooler.
    pub oil: OilHeat<R>,
    /// Heat into the oil beside the losses, W.
    pub extra_heat: R,
    /// Factor on all that leaves.
    pub factor: R,
    /// Highest oil temperature allowed, K.
    pub limit: f64,
    /// Oil temperature at the start of a warm-up, K.
    pub start: f64,
}

/// The place of the oil.
pub const OIL: usize = 0;
/// The place of the air.
pub const AMBIENT: usize = 1;

/// Which number of [`Heat`] it is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub(crate) enum HeatNumber {
    Fixed(usize),
    Capacity(usize),
    Conductance(usize),
    Coefficient(usize),
    Area(usize),
    Height(usize),
    Emissivity(usize),
    AirSpeed(usize),
    FlowLength(usize),
    AirShare(usize),
    FinArea(usize),
    FinHeight(usize),
    FinThickness(usize),
    Inlet,
    Flow,
    Effectiveness,
    CoolerConductance,
    SpecificHeat,
    Density,
    ExtraHeat,
    Factor,
}

impl Heat {
    /// Whether the oil stores heat, so that its temperature can follow what is lost.
    pub fn is_stored(&self) -> bool {
        self.nodes[OIL].capacity > 0.0
    }

    /// Where the heat of something is made; none where no place names it.
    pub fn place(&self, part: HeatPart) -> Option<usize> {
        self.nodes.iter().position(|n| n.parts.contains(&part))
    }

    /// Temperature of the air, K.
    pub fn ambient(&self) -> f64 {
        self.nodes[AMBIENT].fixed.unwrap_or(f64::NAN)
    }

    /// The same with every number made by `of`, which is told which it is.
    pub(crate) fn map<S: Real>(&self, of: &dyn Fn(HeatNumber, f64) -> S) -> Heat<S> {
        use HeatNumber as H;
        let nodes = self.nodes.iter().enumerate().map(|(k, n)| HeatNode {
            name: n.name.clone(),
            fixed: n.fixed.map(|t| of(H::Fixed(k), t)),
            capacity: of(H::Capacity(k), n.capacity),
            parts: n.parts.clone(),
        });
        let paths = self.paths.iter().enumerate().map(|(k, p)| HeatPath {
            between: p.between,
            law: match &p.law {
                PathLaw::Conductance(g) => PathLaw::Conductance(of(H::Conductance(k), *g)),
                PathLaw::Coefficient(c, a) => PathLaw::Coefficient(of(H::Coefficient(k), *c), of(H::Area(k), *a)),
                PathLaw::Surface(s) => PathLaw::Surface(Surface {
                    area: of(H::Area(k), s.area),
                    height: of(H::Height(k), s.height),
                    emissivity: of(H::Emissivity(k), s.emissivity),
                    air_speed: of(H::AirSpeed(k), s.air_speed),
                    flow_length: of(H::FlowLength(k), s.flow_length),
                    air_share: of(H::AirShare(k), s.air_share),
                    fins: s
                        .fins
                        .map(|[a, h, d]| [of(H::FinArea(k), a), of(H::FinHeight(k), h), of(H::FinThickness(k), d)]),
                }),
            },
        });
        Heat {
            nodes: nodes.collect(),
            paths: paths.collect(),
            cooler: self.cooler.map(|c| Cooler {
                inlet: of(H::Inlet, c.inlet),
                exchange: match c.exchange {
                    Exchange::Flow(v, e) => Exchange::Flow(of(H::Flow, v), of(H::Effectiveness, e)),
                    Exchange::Conductance(g) => Exchange::Conductance(of(H::CoolerConductance, g)),
                },
                thermostat: c.thermostat,
            }),
            oil: OilHeat {
                density_15: of(H::Density, self.oil.density_15),
                expansion: self.oil.expansion,
                specific_heat: of(H::SpecificHeat, self.oil.specific_heat),
            },
            extra_heat: of(H::ExtraHeat, self.extra_heat),
            factor: of(H::Factor, self.factor),
            limit: self.limit,
            start: self.start,
        }
    }
}

impl<R: Real> Heat<R> {
    /// Heat through a path from its first place to its second, W, at their temperatures, K. What leads to a place of
    /// given temperature is multiplied by the factor.
    pub fn flow(&self, path: usize, from: R, to: R) -> R {
        let p = &self.paths[path];
        let outside = p.between.iter().any(|k| self.nodes[*k].fixed.is_some());
        let flow = p.law.flow(from, to);
        if outside { flow * self.factor } else { flow }
    }

    /// Heat that the cooler takes from the oil, W.
    pub fn cooled(&self, oil: R) -> R {
        self.cooler.as_ref().map_or(R::from(0.0), |cooler| cooler.cooled(&self.oil, oil))
    }
}

impl<R: Real> PathLaw<R> {
    /// Heat from one temperature to another, K, in W.
    pub(crate) fn flow(&self, from: R, to: R) -> R {
        match self {
            Self::Conductance(g) => *g * (from - to),
            Self::Coefficient(c, a) => *c * *a * (from - to),
            Self::Surface(s) => s.flow(from, to),
        }
    }

    /// The same in other numbers.
    pub(crate) fn map<S>(&self, of: impl Fn(R) -> S) -> PathLaw<S> {
        match self {
            Self::Conductance(g) => PathLaw::Conductance(of(*g)),
            Self::Coefficient(c, a) => PathLaw::Coefficient(of(*c), of(*a)),
            Self::Surface(s) => PathLaw::Surface(Surface {
                area: of(s.area),
                height: of(s.height),
                emissivity: of(s.emissivity),
                air_speed: of(s.air_speed),
                flow_length: of(s.flow_length),
                air_share: of(s.air_share),
                fins: s.fins.map(|all| all.map(&of)),
            }),
        }
    }
}

impl<R: Real> Cooler<R> {
    /// Heat that it takes from oil of a temperature, W.
    pub(crate) fn cooled(&self, oil: &OilHeat<R>, temperature: R) -> R {
        let open = match self.thermostat {
            None => R::from(1.0),
            Some([from, to]) => real::clamp((temperature - from) / (to - from), R::from(0.0), R::from(1.0)),
        };
        let conductance = match self.exchange {
            Exchange::Conductance(g) => g,
            Exchange::Flow(v, e) => oil.volumetric(temperature) * v * e,
        };
        open * conductance * (temperature - self.inlet)
    }

    /// The same in other numbers.
    pub(crate) fn map<S>(&self, of: impl Fn(R) -> S) -> Cooler<S> {
        Cooler {
            inlet: of(self.inlet),
            exchange: match self.exchange {
                Exchange::Flow(v, e) => Exchange::Flow(of(v), of(e)),
                Exchange::Conductance(g) => Exchange::Conductance(of(g)),
            },
            thermostat: self.thermostat,
        }
    }
}

impl<R: Real> OilHeat<R> {
    /// Heat capacity of a volume at a temperature, J/(m³ K).
    pub fn volumetric(&self, temperature: R) -> R {
        self.density_15 * ((temperature - 288.15) * self.expansion + 1.0) * self.specific_heat
    }
}

impl<R: Real> Surface<R> {
    /// Heat from a wall to the air, W; both temperatures in K.
    ///
    /// ```text
    /// Q = α_con (A + η_f A_f) (T_w − T_a) + ε σ A (T_w⁴ − T_a⁴)
    /// α_con   = α_free (1 − s) + max(α_free, α_forced) s
    /// α_free  = 18 H^−0.1 (|T_w − T_a|/T_a)^0.3          W/(m² K)
    /// α_forced = 0.0086 Re^0.64/l,  Re = v l/ν_air
    /// η_f = tanh(m h)/(m h),  m = √(2 α_con/(λ d))
    /// ```
    ///
    /// | symbol | unit | |
    /// |---|---|---|
    /// | A, A_f | m² | area without fins, area of the fins |
    /// | H | m | height of the box |
    /// | ε, σ | -, W/(m² K⁴) | emissivity, Stefan-Boltzmann constant |
    /// | v, l, s | m/s, m, - | speed of the air, length along it, part of the area that it reaches |
    /// | h, d, λ | m, m, W/(m K) | height, thickness and conductivity of the fins: iron, 50 |
    ///
    /// Where the air hardly moves, what rises by itself carries more; the larger of the two counts, so that more air never
    /// makes a box hotter. The flow is odd: a wall that is colder takes as much. Source: ISO/TR 14179-2 after Funck 1985, recalled;
    /// radiation is exact.
    pub fn flow(&self, wall: R, air: R) -> R {
        let rise = wall - air;
        let free = self.height.powf(-0.1) * 18.0 * real::power(real::abs(rise) / air, 0.3);
        let convection = if self.air_speed.re() > 0.0 {
            let reynolds = self.air_speed * self.flow_length / kinematic_viscosity_of_air(air);
            let forced = reynolds.powf(0.64) * 0.0086 / self.flow_length;
            free * (-self.air_share + 1.0) + real::max(free, forced) * self.air_share
        } else {
            free
        };
        let area = match self.fins {
            None => self.area,
            Some([fins, height, thickness]) => {
                let square = convection * 2.0 / (thickness * IRON) * height * height;
                // Short fins have the temperature of the wall.
                let efficiency = match square.re() > 1e-12 {
                    true => square.sqrt().tanh() / square.sqrt(),
                    false => R::from(1.0),
                };
                self.area + efficiency * fins
            }
        };
        convection * area * rise + self.emissivity * self.area * SIGMA * (wall.powi(4) - air.powi(4))
    }
}

/// Kinematic viscosity of air at 1.013 bar, m²/s: Sutherland's law over the density of an ideal gas.
fn kinematic_viscosity_of_air<R: Real>(temperature: R) -> R {
    let dynamic = temperature.powf(1.5) * 1.458e-6 / (temperature + 110.4);
    dynamic * 287.05 * temperature / 101_325.0
}
