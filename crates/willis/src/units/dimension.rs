//! Which kinds of quantities there are, and the units each is written in.

/// Exponents of metre, kilogram, second, radian and kelvin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Dimension(pub(super) [i8; 5]);

impl Dimension {
    /// rad/s
    pub const ANGULAR_SPEED: Self = Self([0, 0, -1, 1, 0]);
    /// N m
    pub const TORQUE: Self = Self([2, 1, -2, 0, 0]);
    /// W
    pub const POWER: Self = Self([2, 1, -3, 1, 0]);
    /// J; torque times angle, so that a torque is no energy
    pub const ENERGY: Self = Self([2, 1, -2, 1, 0]);
    /// m
    pub const LENGTH: Self = Self([1, 0, 0, 0, 0]);
    /// rad
    pub const ANGLE: Self = Self([0, 0, 0, 1, 0]);
    /// K; on the scale of a thermometer, `"60 degC"` is 333.15 K
    pub const TEMPERATURE: Self = Self([0, 0, 0, 0, 1]);
    /// N
    pub const FORCE: Self = Self([1, 1, -2, 0, 0]);
    /// kg
    pub const MASS: Self = Self([0, 1, 0, 0, 0]);
    /// m³
    pub const VOLUME: Self = Self([3, 0, 0, 0, 0]);
    /// kg/m³
    pub const DENSITY: Self = Self([-3, 1, 0, 0, 0]);
    /// Pa
    pub const PRESSURE: Self = Self([-1, 1, -2, 0, 0]);
    /// 1/Pa
    pub const PRESSURE_COEFFICIENT: Self = Self([1, -1, 2, 0, 0]);
    /// m²/s
    pub const KINEMATIC_VISCOSITY: Self = Self([2, 0, -1, 0, 0]);
    /// Pa s
    pub const DYNAMIC_VISCOSITY: Self = Self([-1, 1, -1, 0, 0]);
    /// s
    pub const TIME: Self = Self([0, 0, 1, 0, 0]);
    /// 1/s
    pub const FREQUENCY: Self = Self([0, 0, -1, 0, 0]);
    /// m²
    pub const AREA: Self = Self([2, 0, 0, 0, 0]);
    /// kg m²
    pub const INERTIA: Self = Self([2, 1, 0, 0, 0]);
    /// N m/rad
    pub const STIFFNESS: Self = Self([2, 1, -2, -1, 0]);
    /// N m s/rad
    pub const VISCOUS: Self = Self([2, 1, -1, -1, 0]);
    /// N m s²/rad, torque over angular acceleration
    pub const TORQUE_PER_ACCELERATION: Self = Self([2, 1, 0, -1, 0]);
    /// N m s²/rad², torque over the square of angular speed
    pub const TORQUE_PER_SPEED_SQUARED: Self = Self([2, 1, 0, -2, 0]);

    /// W/K
    pub const CONDUCTANCE: Self = Self([2, 1, -3, 1, -1]);
    /// W/(m² K)
    pub const HEAT_TRANSFER: Self = Self([0, 1, -3, 1, -1]);
    /// J/K
    pub const HEAT_CAPACITY: Self = Self([2, 1, -2, 1, -1]);
    /// J/(kg K)
    pub const SPECIFIC_HEAT: Self = Self([2, 0, -2, 1, -1]);
    /// m³/s
    pub const FLOW: Self = Self([3, 0, -1, 0, 0]);
    /// m/s
    pub const SPEED: Self = Self([1, 0, -1, 0, 0]);

    /// What a person calls it, and an example that the reader accepts.
    pub fn describe(self) -> (&'static str, &'static str) {
        self.kind().map_or(("a quantity of another kind", ""), |k| (k.name, k.example))
    }

    /// Units in which it is written. Only these are suggested for it; the reader knows more.
    ///
    /// # Example
    /// ```
    /// use willis::units::Dimension;
    /// assert!(Dimension::TORQUE.units().contains(&"N m"));
    /// ```
    pub fn units(self) -> &'static [&'static str] {
        self.kind().map_or(&[], |k| k.units)
    }

    /// Exponents of metre, kilogram, second, radian and kelvin.
    ///
    /// # Example
    /// ```
    /// use willis::units::Dimension;
    /// assert_eq!(Dimension::TORQUE.exponents(), [2, 1, -2, 0, 0]);
    /// ```
    pub fn exponents(self) -> [i8; 5] {
        self.0
    }

    pub(super) fn kind(self) -> Option<&'static Kind> {
        KINDS.iter().find(|k| k.dimension == self)
    }
}

/// A kind of quantity as people meet it.
pub(super) struct Kind {
    pub dimension: Dimension,
    /// With its article, `a torque`.
    pub name: &'static str,
    /// A value that the reader accepts.
    pub example: &'static str,
    /// The units it is written in; only these are suggested for it.
    pub units: &'static [&'static str],
}

/// Every kind of quantity.
#[rustfmt::skip]
pub(super) const KINDS: &[Kind] = &[
    Kind { dimension: Dimension::ANGULAR_SPEED, name: "an angular speed", example: "1450 rpm",
           units: &["rpm", "rad/s", "rev/s", "rev/min", "deg/s", "r/min", "U/min", "tr/min", "1/min", "krpm"] },
    Kind { dimension: Dimension::TORQUE, name: "a torque", example: "350 N m",
           units: &["N m", "kN m", "MN m", "mN m", "N mm", "N cm", "daN m", "kgf m", "kgf cm", "lbf ft", "ft lbf",
                    "lbf in", "in lbf", "ozf in"] },
    Kind { dimension: Dimension::POWER, name: "a power", example: "75 kW",
           units: &["kW", "W", "MW", "mW", "hp", "PS", "J/s"] },
    Kind { dimension: Dimension::ENERGY, name: "an energy", example: "250 kJ",
           units: &["J", "kJ", "MJ", "kW h", "W h", "W s", "MW h"] },
    Kind { dimension: Dimension::LENGTH, name: "a length", example: "12.5 mm",
           units: &["mm", "m", "cm", "dm", "um", "nm", "km", "in", "ft", "uin"] },
    Kind { dimension: Dimension::ANGLE, name: "an angle", example: "20 deg",
           units: &["deg", "°", "rad", "mrad", "arcmin", "rev"] },
    Kind { dimension: Dimension::TEMPERATURE, name: "a temperature", example: "60 degC",
           units: &["degC", "°C", "K", "degF", "°F"] },
    Kind { dimension: Dimension::FORCE, name: "a force", example: "5 kN",
           units: &["N", "kN", "MN", "mN", "daN", "kgf", "lbf", "ozf"] },
    Kind { dimension: Dimension::MASS, name: "a mass", example: "2.5 kg", units: &["kg", "g", "t", "lb", "oz", "slug"] },
    Kind { dimension: Dimension::VOLUME, name: "a volume", example: "5 l",
           units: &["l", "L", "ml", "m^3", "dm^3", "cm^3", "mm^3", "in^3"] },
    Kind { dimension: Dimension::DENSITY, name: "a density", example: "890 kg/m^3",
           units: &["kg/m^3", "g/cm^3", "kg/l", "g/ml", "kg/dm^3", "lb/ft^3", "lb/in^3"] },
    Kind { dimension: Dimension::PRESSURE, name: "a pressure", example: "206 GPa",
           units: &["GPa", "MPa", "kPa", "hPa", "Pa", "bar", "mbar", "N/mm^2", "kgf/cm^2", "kgf/mm^2", "psi", "ksi",
                    "lbf/in^2"] },
    Kind { dimension: Dimension::PRESSURE_COEFFICIENT, name: "a pressure coefficient", example: "16.5 1/GPa",
           units: &["1/GPa", "1/MPa", "1/Pa", "1/bar", "mm^2/N", "1/psi"] },
    Kind { dimension: Dimension::KINEMATIC_VISCOSITY, name: "a kinematic viscosity", example: "220 mm^2/s",
           units: &["mm^2/s", "m^2/s", "cm^2/s", "cSt", "St"] },
    Kind { dimension: Dimension::DYNAMIC_VISCOSITY, name: "a dynamic viscosity", example: "80 mPa s",
           units: &["mPa s", "Pa s", "cP", "P", "N s/m^2"] },
    Kind { dimension: Dimension::TIME, name: "a time", example: "0.5 s", units: &["s", "ms", "us", "min", "h"] },
    Kind { dimension: Dimension::FREQUENCY, name: "a frequency", example: "2 Hz", units: &["Hz", "kHz", "1/s", "1/min"] },
    Kind { dimension: Dimension::AREA, name: "an area", example: "0.7 m^2",
           units: &["m^2", "dm^2", "cm^2", "mm^2", "in^2", "ft^2"] },
    Kind { dimension: Dimension::INERTIA, name: "a moment of inertia", example: "0.05 kg m^2",
           units: &["kg m^2", "kg cm^2", "kg mm^2", "g cm^2", "g m^2", "lb ft^2", "lb in^2", "slug ft^2", "lbf in s^2",
                    "lbf ft s^2", "N m s^2"] },
    Kind { dimension: Dimension::STIFFNESS, name: "a stiffness", example: "1e4 N m/rad",
           units: &["N m/rad", "kN m/rad", "MN m/rad", "N m/deg", "N m/arcmin", "lbf in/rad", "lbf ft/rad",
                    "lbf ft/deg"] },
    Kind { dimension: Dimension::VISCOUS, name: "a viscous coefficient", example: "2 N m s/rad",
           units: &["N m s/rad", "kN m s/rad", "mN m s/rad", "N m/rpm", "mN m/rpm", "lbf in s/rad"] },
    Kind { dimension: Dimension::TORQUE_PER_ACCELERATION, name: "a torque over acceleration",
           example: "0.02 N m s^2/rad", units: &["N m s^2/rad", "kN m s^2/rad", "mN m s^2/rad"] },
    Kind { dimension: Dimension::TORQUE_PER_SPEED_SQUARED, name: "a torque over speed squared",
           example: "0.05 N m s^2/rad^2", units: &["N m s^2/rad^2", "mN m s^2/rad^2", "N m/rpm^2"] },
    Kind { dimension: Dimension::CONDUCTANCE, name: "a thermal conductance", example: "45 W/K",
           units: &["W/K", "kW/K"] },
    Kind { dimension: Dimension::HEAT_TRANSFER, name: "a heat transfer coefficient", example: "15 W/(m^2 K)",
           units: &["W/(m^2 K)", "kW/(m^2 K)"] },
    Kind { dimension: Dimension::HEAT_CAPACITY, name: "a heat capacity", example: "60 kJ/K",
           units: &["kJ/K", "J/K", "MJ/K", "W h/K"] },
    Kind { dimension: Dimension::SPECIFIC_HEAT, name: "a specific heat", example: "1950 J/(kg K)",
           units: &["J/(kg K)", "kJ/(kg K)"] },
    Kind { dimension: Dimension::FLOW, name: "a volume flow", example: "6 l/min",
           units: &["l/min", "m^3/s", "l/s", "m^3/h", "l/h", "cm^3/s"] },
    Kind { dimension: Dimension::SPEED, name: "a speed", example: "1.4 m/s", units: &["m/s", "km/h", "ft/s"] },
];
