//! Quantities and unit strings at the boundary; inside, everything is SI.
//!
//! A value keeps its exact rational and its power of π (`1 rpm = π/30 rad/s`), because whether two
//! shafts turn at the same speed is decided exactly, and π would spoil that. [`AngularSpeed`],
//! [`Torque`] and [`Power`] are what the library takes; their limit: the types do not know which
//! shaft a torque acts on.

use std::fmt;

use crate::exact::Rational;

/// Exponents of metre, kilogram, second, radian and kelvin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Dimension([i8; 5]);

impl Dimension {
    /// rad/s
    pub const ANGULAR_SPEED: Self = Self([0, 0, -1, 1, 0]);
    /// N m
    pub const TORQUE: Self = Self([2, 1, -2, 0, 0]);
    /// W
    pub const POWER: Self = Self([2, 1, -3, 0, 0]);
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

    /// What a person calls it, and an example that the reader accepts.
    pub fn describe(self) -> (&'static str, &'static str) {
        match self {
            Self::ANGULAR_SPEED => ("an angular speed", "1450 rpm"),
            Self::TORQUE => ("a torque", "350 N m"),
            Self::POWER => ("a power", "75 kW"),
            Self::LENGTH => ("a length", "12.5 mm"),
            Self::ANGLE => ("an angle", "20 deg"),
            Self::TEMPERATURE => ("a temperature", "60 degC"),
            Self::FORCE => ("a force", "5 kN"),
            Self::MASS => ("a mass", "2.5 kg"),
            Self::VOLUME => ("a volume", "5 l"),
            Self::DENSITY => ("a density", "890 kg/m^3"),
            Self::PRESSURE => ("a pressure", "206 GPa"),
            Self::PRESSURE_COEFFICIENT => ("a pressure coefficient", "16.5 1/GPa"),
            Self::KINEMATIC_VISCOSITY => ("a kinematic viscosity", "220 mm^2/s"),
            Self::DYNAMIC_VISCOSITY => ("a dynamic viscosity", "80 mPa s"),
            Self::TIME => ("a time", "0.5 s"),
            Self::FREQUENCY => ("a frequency", "2 Hz"),
            Self::AREA => ("an area", "0.7 m^2"),
            Self::INERTIA => ("a moment of inertia", "0.05 kg m^2"),
            Self::STIFFNESS => ("a stiffness", "1e4 N m/rad"),
            Self::VISCOUS => ("a viscous coefficient", "2 N m s/rad"),
            Self::TORQUE_PER_ACCELERATION => ("a torque over acceleration", "0.02 N m s^2/rad"),
            Self::TORQUE_PER_SPEED_SQUARED => ("a torque over speed squared", "0.05 N m s^2/rad^2"),
            _ => ("a quantity of another kind", ""),
        }
    }
}

/// An exact value `value · π^pi_power` in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// The rational factor.
    pub value: Rational,
    /// The exponent of π.
    pub pi_power: i8,
    /// What kind of quantity it is.
    pub dimension: Dimension,
}

impl Quantity {
    /// The SI value in floating point.
    pub fn si(&self) -> f64 {
        self.value.to_f64() * std::f64::consts::PI.powi(self.pi_power.into())
    }
}

/// Symbol, factor (exact), power of π, exponents of m, kg, s, rad, K.
type Unit = (&'static str, &'static str, i8, [i8; 5]);

/// Every unit the reader knows. The first of a kind is the one suggested in messages.
#[rustfmt::skip]
const UNITS: &[Unit] = &[
    // BIPM, The International System of Units, 9th ed.; 1 rev = 2π rad.
    ("rpm",   "1/30",  1, [0, 0, -1, 1, 0]),
    ("1/min", "1/30",  1, [0, 0, -1, 1, 0]),
    ("min^-1","1/30",  1, [0, 0, -1, 1, 0]),
    ("rad",   "1",     0, [0, 0, 0, 1, 0]),
    ("deg",   "1/180", 1, [0, 0, 0, 1, 0]),
    ("°",     "1/180", 1, [0, 0, 0, 1, 0]),
    ("rev",   "2",     1, [0, 0, 0, 1, 0]),
    ("s",     "1",     0, [0, 0, 1, 0, 0]),
    ("ms",    "1/1000",0, [0, 0, 1, 0, 0]),
    ("min",   "60",    0, [0, 0, 1, 0, 0]),
    ("h",     "3600",  0, [0, 0, 1, 0, 0]),
    ("Hz",    "1",     0, [0, 0, -1, 0, 0]),
    ("kHz",   "1000",  0, [0, 0, -1, 0, 0]),
    ("N",     "1",     0, [1, 1, -2, 0, 0]),
    ("kN",    "1000",  0, [1, 1, -2, 0, 0]),
    ("MN",    "1e6",   0, [1, 1, -2, 0, 0]),
    ("m",     "1",     0, [1, 0, 0, 0, 0]),
    ("mm",    "1/1000",0, [1, 0, 0, 0, 0]),
    ("cm",    "1/100", 0, [1, 0, 0, 0, 0]),
    ("Nm",    "1",     0, [2, 1, -2, 0, 0]),
    ("kNm",   "1000",  0, [2, 1, -2, 0, 0]),
    ("MNm",   "1e6",   0, [2, 1, -2, 0, 0]),
    ("mNm",   "1/1000",0, [2, 1, -2, 0, 0]),
    ("Nmm",   "1/1000",0, [2, 1, -2, 0, 0]),
    ("J",     "1",     0, [2, 1, -2, 0, 0]),
    ("W",     "1",     0, [2, 1, -3, 0, 0]),
    ("mW",    "1/1000",0, [2, 1, -3, 0, 0]),
    ("kW",    "1000",  0, [2, 1, -3, 0, 0]),
    ("MW",    "1e6",   0, [2, 1, -3, 0, 0]),
    // NIST SP 811, appendix B: kgf = 9.80665 N and lbf, ft, in exact by definition; hp = 550 ft lbf/s.
    ("kgf",   "9.80665",           0, [1, 1, -2, 0, 0]),
    ("lbf",   "4.4482216152605",   0, [1, 1, -2, 0, 0]),
    ("ft",    "0.3048",            0, [1, 0, 0, 0, 0]),
    ("in",    "0.0254",            0, [1, 0, 0, 0, 0]),
    ("hp",    "745.69987158227022",0, [2, 1, -3, 0, 0]),
    ("PS",    "735.49875",         0, [2, 1, -3, 0, 0]),
    ("um",    "1e-6",  0, [1, 0, 0, 0, 0]),
    ("µm",    "1e-6",  0, [1, 0, 0, 0, 0]),
    ("μm",    "1e-6",  0, [1, 0, 0, 0, 0]),
    ("kg",    "1",     0, [0, 1, 0, 0, 0]),
    ("g",     "1/1000",0, [0, 1, 0, 0, 0]),
    ("t",     "1000",  0, [0, 1, 0, 0, 0]),
    ("l",     "1/1000",0, [3, 0, 0, 0, 0]),
    ("L",     "1/1000",0, [3, 0, 0, 0, 0]),
    ("ml",    "1e-6",  0, [3, 0, 0, 0, 0]),
    ("dm",    "1/10",  0, [1, 0, 0, 0, 0]),
    ("Pa",    "1",     0, [-1, 1, -2, 0, 0]),
    ("kPa",   "1000",  0, [-1, 1, -2, 0, 0]),
    ("MPa",   "1e6",   0, [-1, 1, -2, 0, 0]),
    ("GPa",   "1e9",   0, [-1, 1, -2, 0, 0]),
    ("bar",   "1e5",   0, [-1, 1, -2, 0, 0]),
    ("mPa",   "1/1000",0, [-1, 1, -2, 0, 0]),
    ("cP",    "1/1000",0, [-1, 1, -1, 0, 0]),
    ("St",    "1e-4",  0, [2, 0, -1, 0, 0]),
    ("cSt",   "1e-6",  0, [2, 0, -1, 0, 0]),
    ("K",     "1",     0, [0, 0, 0, 0, 1]),
    ("degC",  "1",     0, [0, 0, 0, 0, 1]),
    ("°C",    "1",     0, [0, 0, 0, 0, 1]),
];

/// Every symbol of a unit that the reader knows.
pub(crate) fn symbols() -> impl Iterator<Item = &'static str> {
    UNITS.iter().map(|u| u.0)
}

/// Why a quantity string was refused; the text says what to write instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum QuantityError {
    /// The text does not begin with a number.
    NoNumber,
    /// The number is fine, the unit is missing.
    NoUnit,
    /// A unit symbol is not known; with the nearest known one.
    UnknownUnit(String, Option<&'static str>),
    /// The unit measures something else.
    WrongDimension,
}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNumber => f.write_str("it does not begin with a finite number of sensible size"),
            Self::NoUnit => f.write_str("the unit is missing"),
            Self::UnknownUnit(unit, _) => write!(f, "`{unit}` is not a unit known here"),
            Self::WrongDimension => f.write_str("its unit measures something else"),
        }
    }
}

impl std::error::Error for QuantityError {}

/// Reads a number with a unit: `4920 rpm`, `-12.5 N·m`, `150 lbf ft`, `424kW`, `3/4 N m`.
///
/// # Errors
/// What is wrong with the text, see [`QuantityError`].
///
/// # Example
/// ```
/// use willis::units::{parse, Dimension};
/// let w = parse("30 rpm", Dimension::ANGULAR_SPEED).unwrap();
/// assert_eq!((w.value.to_string().as_str(), w.pi_power), ("1", 1));   // π rad/s
/// assert!(parse("30 N", Dimension::TORQUE).is_err());
/// ```
pub fn parse(text: &str, expected: Dimension) -> Result<Quantity, QuantityError> {
    if text.len() > 200 {
        return Err(QuantityError::NoNumber);
    }
    let text = text.trim().replace('\u{2212}', "-");
    // The number ends where a unit begins: a letter that is not an exponent, or white space.
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let exponent = matches!(bytes[end], b'e' | b'E')
            && end > 0
            && text[end + 1..].trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit());
        let after_exponent = end > 0 && matches!(bytes[end - 1], b'e' | b'E');
        let sign = matches!(bytes[end], b'+' | b'-') && (end == 0 || after_exponent);
        if bytes[end].is_ascii_digit() || matches!(bytes[end], b'.' | b'_' | b'/') || sign || exponent {
            end += 1;
        } else {
            break;
        }
    }
    let value: Rational = text[..end].parse().map_err(|_| QuantityError::NoNumber)?;
    let unit = text[end..].trim();
    if unit.is_empty() {
        return Err(QuantityError::NoUnit);
    }
    let (factor, pi_power, dimension) = parse_unit(unit, expected)?;
    if dimension != expected.0 {
        return Err(QuantityError::WrongDimension);
    }
    // A thermometer's zero: as a temperature, degrees Celsius count from 273.15 K.
    let zero = match (expected, unit) {
        (Dimension::TEMPERATURE, "degC" | "°C") => Rational::new(27315, 100),
        _ => Rational::ZERO,
    };
    let quantity = Quantity { value: value * factor + zero, pi_power, dimension: expected };
    if quantity.si().is_finite() { Ok(quantity) } else { Err(QuantityError::NoNumber) }
}

/// Products and quotients of known symbols: `N m`, `N·m`, `N*m`, `rad/s`, `kg m^2`.
fn parse_unit(text: &str, expected: Dimension) -> Result<(Rational, i8, [i8; 5]), QuantityError> {
    let one = |symbol: &str| UNITS.iter().find(|u| u.0 == symbol);
    let factor = |u: &Unit| u.1.parse::<Rational>().expect("the table holds numbers");
    if let Some(u) = one(text) {
        return Ok((factor(u), u.2, u.3));
    }
    let unknown = |symbol: &str| {
        let near = UNITS
            .iter()
            .map(|u| {
                let distance = strsim::damerau_levenshtein(&u.0.to_lowercase(), &symbol.to_lowercase());
                // Among equally near ones, a unit of the kind that is wanted.
                (distance, u.3 != expected.0, u.0)
            })
            .filter(|(distance, _, known)| *distance <= known.len().div_ceil(3))
            .min()
            .map(|(.., known)| known);
        QuantityError::UnknownUnit(symbol.chars().take(40).collect(), near)
    };
    let mut value = Rational::ONE;
    let (mut pi_power, mut dimension) = (0i8, [0i8; 5]);
    let mut divide = false;
    if text.len() > 40 {
        return Err(unknown(text));
    }
    for (k, part) in text.split('/').enumerate() {
        if k > 1 || part.trim().is_empty() {
            return Err(unknown(text));
        }
        for symbol in part.split([' ', '·', '*', '⋅', '.']).filter(|s| !s.is_empty()) {
            // m^2, m2, m²
            let (name, power) = match symbol.split_once('^') {
                Some((name, power)) => (name, power.parse::<i8>().map_err(|_| unknown(symbol))?),
                None => match symbol.char_indices().next_back() {
                    Some((at, '2' | '²')) if at > 0 => (&symbol[..at], 2),
                    Some((at, '3' | '³')) if at > 0 => (&symbol[..at], 3),
                    _ => (symbol, 1),
                },
            };
            if name == "1" && !divide {
                continue;
            }
            let unit = one(name).ok_or_else(|| unknown(name))?;
            if !(-4..=4).contains(&power) {
                return Err(unknown(symbol));
            }
            let power = if divide { -power } else { power };
            for _ in 0..power.unsigned_abs() {
                let f = factor(unit);
                value = if power > 0 { value * f } else { value / f };
            }
            pi_power = pi_power.saturating_add(unit.2 * power).clamp(-9, 9);
            for (d, u) in dimension.iter_mut().zip(unit.3) {
                *d = d.saturating_add(u * power).clamp(-99, 99);
            }
        }
        divide = true;
    }
    Ok((value, pi_power, dimension))
}

macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $dimension:ident, $($(#[$cdoc:meta])* $constructor:ident = $unit:literal),+) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name(pub(crate) Quantity);

        impl $name {
            $(
                $(#[$cdoc])*
                ///
                /// # Panics
                /// If `value` is NaN or infinite.
                pub fn $constructor(value: f64) -> Self {
                    let (factor, pi_power, _) = parse_unit($unit, Dimension::$dimension).expect("a known unit");
                    let value = Rational::from_f64(value).expect("a finite value") * factor;
                    Self(Quantity { value, pi_power, dimension: Dimension::$dimension })
                }
            )+

            /// Reads a number with a unit.
            ///
            /// # Errors
            /// See [`parse`].
            pub fn parse(text: &str) -> Result<Self, QuantityError> {
                parse(text, Dimension::$dimension).map(Self)
            }

            /// An exact SI value.
            pub fn exact(value: Rational) -> Self {
                Self(Quantity { value, pi_power: 0, dimension: Dimension::$dimension })
            }

            /// The SI value.
            pub fn si(&self) -> f64 {
                self.0.si()
            }
        }
    };
}

quantity!(
    /// Angular speed of a member, positive in the one axis direction of the whole train.
    AngularSpeed, ANGULAR_SPEED,
    /// From revolutions per minute.
    rpm = "rpm",
    /// From radians per second.
    rad_s = "rad/s"
);
quantity!(
    /// Torque on a member about the train's axis.
    Torque, TORQUE,
    /// From newton metres.
    n_m = "N m"
);
quantity!(
    /// Power into the train.
    Power, POWER,
    /// From watts.
    w = "W",
    /// From kilowatts.
    kw = "kW"
);
quantity!(
    /// A temperature on the scale of a thermometer: `"60 degC"` is 333.15 K.
    Temperature, TEMPERATURE,
    /// From kelvins.
    k = "K"
);
quantity!(
    /// A length.
    Length, LENGTH,
    /// From metres.
    m = "m",
    /// From millimetres.
    mm = "mm",
    /// From micrometres.
    um = "um"
);
quantity!(
    /// An angle.
    Angle, ANGLE,
    /// From radians.
    rad = "rad",
    /// From degrees.
    deg = "deg"
);
quantity!(
    /// A force.
    Force, FORCE,
    /// From newtons.
    n = "N",
    /// From kilonewtons.
    kn = "kN"
);
quantity!(
    /// A mass.
    Mass, MASS,
    /// From kilograms.
    kg = "kg"
);
quantity!(
    /// A volume.
    Volume, VOLUME,
    /// From cubic metres.
    m3 = "m^3",
    /// From litres.
    l = "l"
);
quantity!(
    /// A density.
    Density, DENSITY,
    /// From kilograms per cubic metre.
    kg_m3 = "kg/m^3"
);
quantity!(
    /// A pressure, or a modulus of elasticity.
    Pressure, PRESSURE,
    /// From pascals.
    pa = "Pa",
    /// From gigapascals.
    gpa = "GPa"
);
quantity!(
    /// A pressure-viscosity coefficient.
    PressureCoefficient, PRESSURE_COEFFICIENT,
    /// From 1/Pa.
    per_pa = "1/Pa",
    /// From 1/GPa.
    per_gpa = "1/GPa"
);
quantity!(
    /// A kinematic viscosity.
    KinematicViscosity, KINEMATIC_VISCOSITY,
    /// From m²/s.
    m2_s = "m^2/s",
    /// From mm²/s, which is centistokes.
    mm2_s = "mm^2/s"
);
quantity!(
    /// A dynamic viscosity.
    DynamicViscosity, DYNAMIC_VISCOSITY,
    /// From pascal seconds.
    pa_s = "Pa s",
    /// From millipascal seconds, which is centipoise.
    mpa_s = "mPa s"
);
quantity!(
    /// A time.
    Time, TIME,
    /// From seconds.
    s = "s",
    /// From milliseconds.
    ms = "ms"
);
quantity!(
    /// A frequency, or a rate of decay.
    Frequency, FREQUENCY,
    /// From hertz, 1/s.
    hz = "Hz"
);
quantity!(
    /// An area.
    Area, AREA,
    /// From square metres.
    m2 = "m^2"
);
quantity!(
    /// A moment of inertia.
    MomentOfInertia, INERTIA,
    /// From kg m².
    kg_m2 = "kg m^2"
);
quantity!(
    /// A torsional stiffness.
    Stiffness, STIFFNESS,
    /// From N m/rad.
    n_m_rad = "N m/rad"
);
quantity!(
    /// A torque over an angular speed.
    ViscousCoefficient, VISCOUS,
    /// From N m s/rad.
    n_m_s_rad = "N m s/rad"
);
quantity!(
    /// A torque over an angular acceleration.
    TorquePerAcceleration, TORQUE_PER_ACCELERATION,
    /// From N m s²/rad.
    n_m_s2_rad = "N m s^2/rad"
);
quantity!(
    /// A torque over the square of an angular speed.
    TorquePerSpeedSquared, TORQUE_PER_SPEED_SQUARED,
    /// From N m s²/rad².
    n_m_s2_rad2 = "N m s^2/rad^2"
);

impl Temperature {
    /// From degrees Celsius.
    ///
    /// # Panics
    /// If `value` is NaN or infinite.
    pub fn deg_c(value: f64) -> Self {
        let Self(mut celsius) = Self::k(value);
        celsius.value = celsius.value + Rational::new(27315, 100);
        Self(celsius)
    }
}

/// A value in SI units in the unit that people use for its size: mm for m, rpm for rad/s, °C for K. Units that people
/// use as they are stay, and `-` becomes nothing.
///
/// # Example
/// ```
/// assert_eq!(willis::units::for_people(0.045, "m"), (45.0, "mm"));
/// assert_eq!(willis::units::for_people(0.5e-6, "m"), (0.5, "µm"));
/// assert_eq!(willis::units::for_people(2.0, "N m"), (2.0, "N m"));
/// ```
pub fn for_people(x: f64, unit: &str) -> (f64, &str) {
    match unit {
        "m" if x.abs() < 1e-4 && x != 0.0 => (x * 1e6, "µm"),
        "m" => (x * 1e3, "mm"),
        "rad" => (x.to_degrees(), "°"),
        "K" => (x - 273.15, "°C"),
        "Pa" => (x / 1e9, "GPa"),
        "1/Pa" => (x * 1e9, "1/GPa"),
        "m^2/s" => (x * 1e6, "mm²/s"),
        "Pa s" => (x * 1e3, "mPa s"),
        "m^3" => (x * 1e3, "l"),
        "kg/m^3" => (x, "kg/m³"),
        "rad/s" => (x * 30.0 / std::f64::consts::PI, "rpm"),
        "W" if x.abs() >= 1e3 => (x / 1e3, "kW"),
        "-" => (x, ""),
        _ => (x, unit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_engineering_notation() {
        let si = |t: &str, d| parse(t, d).map(|q| q.si());
        let close = |a: Result<f64, _>, b: f64| assert!((a.as_ref().unwrap() - b).abs() < 1e-12 * b.abs(), "{a:?}");
        close(si("4920 rpm", Dimension::ANGULAR_SPEED), 4920.0 * std::f64::consts::PI / 30.0);
        close(si("82 rev/s", Dimension::ANGULAR_SPEED), 82.0 * std::f64::consts::TAU);
        close(si("1450 1/min", Dimension::ANGULAR_SPEED), 1450.0 * std::f64::consts::PI / 30.0);
        close(si("150Nm", Dimension::TORQUE), 150.0);
        close(si("-1.5e-1 kN·m", Dimension::TORQUE), -150.0);
        close(si("8 kgf m", Dimension::TORQUE), 78.4532);
        close(si("100 lbf ft", Dimension::TORQUE), 135.581_794_833_140_04);
        close(si("424 kW", Dimension::POWER), 424e3);
        close(si("1 hp", Dimension::POWER), 745.699_871_582_270_2);
        close(si("0.4 µm", Dimension::LENGTH), 0.4e-6);
        close(si("20 deg", Dimension::ANGLE), std::f64::consts::PI / 9.0);
        close(si("60 degC", Dimension::TEMPERATURE), 333.15);
        close(si("-10 °C", Dimension::TEMPERATURE), 263.15);
        close(si("300 K", Dimension::TEMPERATURE), 300.0);
        for nu in ["220 mm2/s", "220 mm^2/s", "220 mm²/s", "220 cSt"] {
            close(si(nu, Dimension::KINEMATIC_VISCOSITY), 220e-6);
        }
        close(si("80 mPa s", Dimension::DYNAMIC_VISCOSITY), 0.08);
        close(si("80 cP", Dimension::DYNAMIC_VISCOSITY), 0.08);
        close(si("0.89 kg/dm3", Dimension::DENSITY), 890.0);
        close(si("16.5 1/GPa", Dimension::PRESSURE_COEFFICIENT), 16.5e-9);
        close(si("206 GPa", Dimension::PRESSURE), 206e9);
        close(si("5 l", Dimension::VOLUME), 5e-3);
        close(si("2 t", Dimension::MASS), 2000.0);
        close(si("500 ms", Dimension::TIME), 0.5);
        for f in ["2 Hz", "2 1/s", "2 s^-1", "0.002 kHz"] {
            close(si(f, Dimension::FREQUENCY), 2.0);
        }
        close(si("0.7 m^2", Dimension::AREA), 0.7);
        close(si("6e-5 kg m^2", Dimension::INERTIA), 6e-5);
        close(si("500 g cm²", Dimension::INERTIA), 5e-5);
        close(si("1e4 N m/rad", Dimension::STIFFNESS), 1e4);
        close(si("180 N m/deg", Dimension::STIFFNESS), 180.0 * 180.0 / std::f64::consts::PI);
        close(si("2 N m s/rad", Dimension::VISCOUS), 2.0);
        close(si("2 Nm/rpm", Dimension::VISCOUS), 60.0 / std::f64::consts::PI);
        close(si("0.02 N m s^2/rad", Dimension::TORQUE_PER_ACCELERATION), 0.02);
        close(si("0.05 N m s^2/rad^2", Dimension::TORQUE_PER_SPEED_SQUARED), 0.05);
    }

    #[test]
    fn says_what_is_wrong() {
        use QuantityError::*;
        let err = |t: &str| parse(t, Dimension::TORQUE).unwrap_err();
        assert_eq!(err("ten N m"), NoNumber);
        assert_eq!(err("nan N m"), NoNumber);
        assert_eq!(err(""), NoNumber);
        assert_eq!(err("10"), NoUnit);
        assert_eq!(err("10 rpm"), WrongDimension);
        assert_eq!(err("10 Nn"), UnknownUnit("Nn".into(), Some("Nm")));
        assert_eq!(err("10 N m/s/s"), UnknownUnit("N m/s/s".into(), None));
        assert!(parse("1e999 N m", Dimension::TORQUE).is_err());
        assert!(parse(&"9".repeat(10_000), Dimension::TORQUE).is_err());
    }
}
