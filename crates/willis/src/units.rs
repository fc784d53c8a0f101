//! Quantities and unit strings at the boundary; inside, everything is SI.
//!
//! A value keeps its exact rational and its power of π (`1 rpm = π/30 rad/s`), because whether two
//! shafts turn at the same speed is decided exactly, and π would spoil that. Types such as
//! [`AngularSpeed`], [`Torque`] and [`Power`] are what the library takes. They do not know which shaft a torque acts on.
//!
//! An angle has a dimension of its own. Work is torque times angle, so `350 J` is no torque, `N m/rad` is a stiffness
//! and no torque, and torque times angular speed is a power.
//!
//! What is read: the symbols of the SI and of the workshop in any common spelling (`N m`, `N·m`, `Nm`, `N*m`, `ft-lb`,
//! `min⁻¹`, `U/min`), as long as it has one meaning for the quantity that is asked for. What is not read is answered
//! with the right spelling ([`QuantityError::instead`]).

mod dimension;
mod grammar;
mod symbols;

use std::fmt;

use crate::exact::Rational;

use grammar::{MassAs, Scale};
use symbols::WORDS;

pub use dimension::Dimension;

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

/// Every symbol of a unit that the reader knows.
pub(crate) fn symbols() -> impl Iterator<Item = &'static str> {
    symbols::UNITS.iter().flat_map(|u| u.0).copied().chain(symbols::TOGETHER.iter().map(|t| t.0))
}

/// Why a quantity string was refused, and what would be read instead.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct QuantityError {
    /// What is wrong with the text.
    pub fault: QuantityFault,
    /// What was asked for.
    pub expected: Dimension,
    /// Texts that would be read and may be meant: one, or two where a comma leaves it open.
    pub instead: Vec<String>,
}

/// What is wrong with a quantity string.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum QuantityFault {
    /// The text does not begin with a number.
    NoNumber,
    /// The number is written with a decimal comma.
    DecimalComma,
    /// The digits of the number stand in groups.
    Grouped,
    /// The number is fine, the unit is missing.
    NoUnit,
    /// A unit symbol is not known.
    UnknownUnit(String),
    /// The unit measures something else.
    WrongDimension {
        /// The unit as written.
        unit: String,
        /// What it measures.
        measures: Dimension,
    },
}

impl QuantityError {
    /// What to do: the text that may be meant, or an example.
    ///
    /// # Example
    /// ```
    /// use willis::units::Torque;
    /// assert_eq!(Torque::parse("20,5 N m").unwrap_err().hint(), "write \"20.5 N m\"");
    /// assert_eq!(Torque::parse("20").unwrap_err().hint(), "write \"20 N m\" if that is the unit meant");
    /// assert_eq!(Torque::parse("20 J").unwrap_err().hint(), "did you mean \"20 N m\"?");
    /// assert_eq!(Torque::parse("20 kW").unwrap_err().hint(), "a torque looks like \"350 N m\"");
    /// ```
    pub fn hint(&self) -> String {
        let (kind, example) = self.expected.describe();
        match (&self.fault, self.instead.as_slice()) {
            (_, []) => format!("{kind} looks like \"{example}\""),
            (QuantityFault::NoUnit, [one]) => format!("write \"{one}\" if that is the unit meant"),
            (QuantityFault::UnknownUnit(_) | QuantityFault::WrongDimension { .. }, [one]) => {
                format!("did you mean \"{one}\"?")
            }
            (_, all) => {
                let all: Vec<String> = all.iter().map(|text| format!("\"{text}\"")).collect();
                format!("write {}", all.join(" or "))
            }
        }
    }
}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.fault {
            QuantityFault::NoNumber => f.write_str("it does not begin with a finite number of sensible size"),
            QuantityFault::DecimalComma => f.write_str("the decimal sign is a decimal point, not a comma"),
            QuantityFault::Grouped => f.write_str("the digits of a number stand together"),
            QuantityFault::NoUnit => f.write_str("the unit is missing"),
            QuantityFault::UnknownUnit(unit) => write!(f, "`{unit}` is not a unit known here"),
            QuantityFault::WrongDimension { unit, measures } => match measures.kind() {
                Some(kind) => write!(f, "`{unit}` measures {}", kind.name),
                None => write!(f, "`{unit}` measures something else"),
            },
        }
    }
}

impl std::error::Error for QuantityError {}

/// Reads a number with a unit: `4920 rpm`, `-12.5 N·m`, `150 ft-lb`, `424kW`, `3/4 N m`.
///
/// # Errors
/// What is wrong with the text, see [`QuantityError`].
///
/// # Example
/// ```
/// use willis::units::{parse, Dimension};
/// let w = parse("30 rpm", Dimension::ANGULAR_SPEED).unwrap();
/// assert_eq!((w.value.to_string().as_str(), w.pi_power), ("1", 1));   // π rad/s
/// assert!(parse("350 J", Dimension::TORQUE).is_err());
/// assert!(parse("350 N m", Dimension::ENERGY).is_err());
/// ```
pub fn parse(text: &str, expected: Dimension) -> Result<Quantity, QuantityError> {
    read(text, expected).map_err(|fault| QuantityError { instead: instead(text, &fault, expected), fault, expected })
}

/// Number and unit of a text.
fn split(text: &str) -> (&str, &str) {
    // The number ends where a unit begins: a letter that is not an exponent, or white space.
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let mut end = 0;
    while end < bytes.len() {
        let goes_on = match bytes[end] {
            b'e' | b'E' => {
                end > 0 && text[end + 1..].trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit())
            }
            b'+' | b'-' => end == 0 || matches!(bytes[end - 1], b'e' | b'E'),
            // `3/4 N m`, but `1450/min`.
            b'/' => digit(end + 1),
            b'.' | b'_' => true,
            c => c.is_ascii_digit(),
        };
        if !goes_on {
            break;
        }
        end += 1;
    }
    (&text[..end], text[end..].trim())
}

fn read(text: &str, expected: Dimension) -> Result<Quantity, QuantityFault> {
    if text.len() > 200 {
        return Err(QuantityFault::NoNumber);
    }
    let text = text.trim().replace('\u{2212}', "-");
    let (number, unit) = split(&text);
    if let Some((fault, ..)) = mend(&text) {
        return Err(fault);
    }
    let value: Rational = number.parse().map_err(|_| QuantityFault::NoNumber)?;
    if unit.is_empty() {
        return Err(QuantityFault::NoUnit);
    }
    // `60 ° C`
    let gapless: String = unit.split_whitespace().collect();
    let unit = if expected == Dimension::TEMPERATURE { &gapless } else { unit };
    let scale = scale(unit, expected)?;
    // A thermometer's zero: as a temperature, 0 °C is 273.15 K and 0 °F is 459.67 K · 5/9.
    let zero = match expected {
        Dimension::TEMPERATURE if CELSIUS.contains(&unit) => Rational::new(27315, 100),
        Dimension::TEMPERATURE if FAHRENHEIT.contains(&unit) => Rational::new(45967 * 5, 900),
        _ => Rational::ZERO,
    };
    let quantity = Quantity { value: value * scale.factor + zero, pi_power: scale.pi_power, dimension: expected };
    if quantity.si().is_finite() { Ok(quantity) } else { Err(QuantityFault::NoNumber) }
}

/// Signs of a thermometer's degrees, which count from a zero of their own.
const CELSIUS: [&str; 4] = ["degC", "°C", "ºC", "℃"];
const FAHRENHEIT: [&str; 4] = ["degF", "°F", "ºF", "℉"];

/// What a unit amounts to as that kind of quantity.
fn scale(unit: &str, expected: Dimension) -> Result<Scale, QuantityFault> {
    let plain = grammar::read(unit, MassAs::Mass).map_err(|unknown| QuantityFault::UnknownUnit(unknown.0))?;
    let measures = Dimension(plain.exponents);
    if let Some(found) = taken_as(plain, expected) {
        return Ok(found);
    }
    // Pounds and ounces are forces too, where nothing else fits: `ft-lb`.
    let force = grammar::read(unit, MassAs::PoundForce).ok().and_then(|force| taken_as(force, expected));
    force.ok_or_else(|| QuantityFault::WrongDimension { unit: clip(unit), measures })
}

/// A unit, if it is one of that kind of quantity.
fn taken_as(found: Scale, expected: Dimension) -> Option<Scale> {
    let per_minute = found.factor == Rational::new(1, 60) && found.exponents == Dimension::FREQUENCY.0;
    if expected == Dimension::ANGULAR_SPEED && per_minute {
        // Of shafts, `1/min` counts turns. `1/s` does not say what it counts.
        return Some(Scale { factor: Rational::new(1, 30), pi_power: 1, exponents: expected.0 });
    }
    // A force times a speed is a power, written without an angle.
    let power = expected == Dimension::POWER && found.exponents == [2, 1, -3, 0, 0];
    (power || found.exponents == expected.0).then_some(Scale { exponents: expected.0, ..found })
}

fn clip(unit: &str) -> String {
    unit.chars().filter(|c| !c.is_control()).take(40).collect()
}

/// Texts that would be read, and may be meant by one that is not.
fn instead(text: &str, fault: &QuantityFault, expected: Dimension) -> Vec<String> {
    let text = text.trim();
    let (number, unit) = split(text);
    let with = |unit: &str| format!("{} {unit}", number.trim());
    match fault {
        QuantityFault::NoNumber => vec![],
        QuantityFault::NoUnit => {
            let example = expected.describe().1;
            example.split_once(' ').map(|(_, unit)| with(unit)).into_iter().collect()
        }
        QuantityFault::DecimalComma | QuantityFault::Grouped => {
            let (numbers, rest) = mend(text).map_or((vec![], ""), |(_, numbers, rest)| (numbers, rest));
            let texts = numbers.into_iter().map(|number| format!("{number}{rest}"));
            // With a unit that is wrong too, what is put right there.
            texts.flat_map(|text| parse(&text, expected).map_or_else(|e| e.instead, |_| vec![text])).collect()
        }
        QuantityFault::WrongDimension { measures, .. }
            if (expected, *measures) == (Dimension::ANGULAR_SPEED, Dimension::FREQUENCY) =>
        {
            match grammar::read(unit, MassAs::Mass) {
                Ok(hertz) if hertz.factor == Rational::ONE => vec![with("rev/s"), with("rad/s")],
                _ => vec![],
            }
        }
        QuantityFault::UnknownUnit(_) | QuantityFault::WrongDimension { .. } => {
            nearest(unit, fault, expected).map(|unit| with(&unit)).into_iter().collect()
        }
    }
}

/// The unit of a kind of quantity that another text most likely stands for.
fn nearest(unit: &str, fault: &QuantityFault, expected: Dimension) -> Option<String> {
    let spelled: Vec<&str> = unit.split_whitespace().map(word).collect();
    let spelled = spelled.join(" ");
    if spelled != unit && scale(&spelled, expected).is_ok() {
        return Some(spelled);
    }
    let known = expected.units().iter().copied();
    if let QuantityFault::WrongDimension { .. } = fault {
        // The same letters; a kilogram for the force; the same unit but for an angle.
        let same = |u: &&str| letters(u) == letters(unit);
        let [mass, force] = [MassAs::Mass, MassAs::KilogramForce].map(|mass| grammar::read(unit, mass).ok());
        let is = |u: &&str, found: &Option<Scale>, angle: bool| {
            let known = scale(u, expected).ok();
            found.as_ref().zip(known).is_some_and(|(a, b)| {
                let differ = (0..5).find(|&k| a.exponents[k] != b.exponents[k] && !(angle && k == 3));
                (a.pi_power, differ) == (b.pi_power, None) && a.factor == b.factor
            })
        };
        let mut tries = known.clone().filter(same).chain(known.clone().filter(|u| is(u, &force, false)));
        return tries.next().or_else(|| known.clone().find(|u| is(u, &mass, true))).map(str::to_owned);
    }
    let written = letters(unit);
    let by_distance = known.filter_map(|u| {
        let spelling = letters(u);
        let distance = strsim::damerau_levenshtein(&spelling, &written);
        let length = spelling.chars().count();
        // One letter for another is no misspelling of a one-letter unit.
        let near = distance <= length.div_ceil(3) && distance < length.max(written.chars().count());
        // `mW` and `MW` are the same letters.
        near.then(|| (distance, strsim::damerau_levenshtein(u, unit), u))
    });
    // The first of equals: units stand in the order in which they are used.
    by_distance.min_by_key(|&(distance, exact, _)| (distance, exact)).map(|(.., u)| u.to_owned())
}

/// The symbol that a word stands for.
fn word(word: &str) -> &str {
    let lower = word.to_lowercase();
    let found = |name: &str| WORDS.iter().find(|w| w.0 == name).map(|w| w.1);
    found(&lower).or_else(|| found(lower.strip_suffix('s')?)).unwrap_or(word)
}

/// The letters of a unit, without capitals, gaps and signs.
fn letters(unit: &str) -> String {
    let digit = |c| match c {
        '²' => '2',
        '³' => '3',
        'µ' | 'μ' => 'u',
        c => c,
    };
    unit.to_lowercase().chars().map(digit).filter(|c| c.is_alphanumeric() || matches!(c, '/' | '°')).collect()
}

/// The number that a text with a decimal comma stands for.
pub(crate) fn decimal_point(text: &str) -> Option<String> {
    match mend(text.trim())? {
        (QuantityFault::DecimalComma, numbers, "") => numbers.into_iter().next(),
        _ => None,
    }
}

/// What numbers a text may begin with that has a decimal comma or its digits in groups, and what follows them.
fn mend(text: &str) -> Option<(QuantityFault, Vec<String>, &str)> {
    let (sign, digits) = match text.strip_prefix(['+', '-', '\u{2212}']) {
        Some(rest) => (if text.starts_with('+') { "" } else { "-" }, rest),
        None => ("", text),
    };
    // Groups of digits, and what stands before each but the first.
    let mut groups: Vec<&str> = vec![];
    let mut gaps: Vec<char> = vec![];
    let mut rest = digits;
    loop {
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let (group, after) = rest.split_at(end);
        if group.is_empty() {
            return None;
        }
        groups.push(group);
        rest = after;
        let mut letters = after.chars();
        let Some(gap) = letters.next() else { break };
        let next: String = letters.as_str().chars().take_while(char::is_ascii_digit).collect();
        let three = next.len() == 3;
        let joins = match gap {
            ',' | '.' => !next.is_empty(),
            '\'' | '’' => three,
            // `1 450 rpm`, but `1450 1/min`.
            c => c.is_whitespace() && three && group.len() <= 3,
        };
        if !joins {
            break;
        }
        gaps.push(if gap.is_whitespace() { ' ' } else { gap });
        rest = letters.as_str();
    }
    let (&last, others) = gaps.split_last()?;
    let in_threes = |groups: &[&str]| groups[0].len() <= 3 && groups[1..].iter().all(|g| g.len() == 3);
    let alike = |gaps: &[char]| gaps.iter().all(|g| *g == gaps[0]);
    let (whole, part) = groups.split_at(groups.len() - 1);
    let decimal = || format!("{sign}{}.{}", whole.concat(), part[0]);
    let together = || format!("{sign}{}", groups.concat());
    let found = match (last, others) {
        ('.', []) => return None,
        // Three digits after a comma may be thousands.
        (',', []) if in_threes(&groups) && groups[0] != "0" => {
            (QuantityFault::DecimalComma, vec![decimal(), together()])
        }
        (',', []) => (QuantityFault::DecimalComma, vec![decimal()]),
        (_, _) if alike(&gaps) && in_threes(&groups) => (QuantityFault::Grouped, vec![together()]),
        (',', others) if others[0] != ',' && alike(others) && in_threes(whole) => {
            (QuantityFault::DecimalComma, vec![decimal()])
        }
        ('.', others) if others[0] != '.' && alike(others) && in_threes(whole) => {
            (QuantityFault::Grouped, vec![decimal()])
        }
        _ => return None,
    };
    Some((found.0, found.1, rest))
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
                    let unit = scale($unit, Dimension::$dimension).expect("a known unit");
                    let value = Rational::from_f64(value).expect("a finite value") * unit.factor;
                    Self(Quantity { value, pi_power: unit.pi_power, dimension: Dimension::$dimension })
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

        impl From<$name> for Quantity {
            fn from(value: $name) -> Self {
                value.0
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
        celsius.value += Rational::new(27315, 100);
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
/// assert_eq!(willis::units::for_people(6e5, "Pa"), (6.0, "bar"));
/// assert_eq!(willis::units::for_people(2.0, "N m"), (2.0, "N m"));
/// ```
pub fn for_people(x: f64, unit: &str) -> (f64, &str) {
    match unit {
        "m" if x.abs() < 1e-4 && x != 0.0 => (x * 1e6, "µm"),
        "m" => (x * 1e3, "mm"),
        "rad" => (x.to_degrees(), "°"),
        "K" => (x - 273.15, "°C"),
        "Pa" if x.abs() < 1e8 => (x / 1e5, "bar"),
        "Pa" => (x / 1e9, "GPa"),
        "1/Pa" => (x * 1e9, "1/GPa"),
        "m^2/s" => (x * 1e6, "mm²/s"),
        "Pa s" => (x * 1e3, "mPa s"),
        "m^3" if x.abs() < 1e-4 => (x * 1e6, "cm³"),
        "m^3" => (x * 1e3, "l"),
        "m^3/s" => (x * 6e4, "l/min"),
        "kg/m^3" => (x, "kg/m³"),
        "rad/s" => (x * 30.0 / std::f64::consts::PI, "rpm"),
        "W" if x.abs() >= 1e3 => (x / 1e3, "kW"),
        "-" => (x, ""),
        _ => (x, unit),
    }
}

/// A name with the unit at its end, as columns are called: `sun.speed_rpm`; without a unit the name alone.
pub(crate) fn with_unit(name: &str, unit: &str) -> String {
    // `Nm` is the same unit as `N m`; of letters only M keeps its size, mega is not milli.
    let unit = unit.replace("Nm", "N m").replace('^', "");
    let mega = unit.starts_with('M');
    let unit: String = unit.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
    let unit = if mega { unit } else { unit.to_lowercase() };
    match unit.trim_matches('_') {
        "" => name.to_owned(),
        unit => format!("{name}_{}", unit.replace("__", "_")),
    }
}

/// The name of a column without its unit: `sun.speed`.
pub(crate) fn without_unit<'a>(name: &'a str, unit: &str) -> &'a str {
    let ending = with_unit("", unit);
    name.strip_suffix(ending.as_str()).filter(|bare| !bare.is_empty()).unwrap_or(name)
}
quantity!(
    /// A thermal conductance: heat flow over a difference of temperatures.
    Conductance, CONDUCTANCE,
    /// From watts per kelvin.
    w_k = "W/K"
);
quantity!(
    /// A heat transfer coefficient: conductance over area.
    HeatTransfer, HEAT_TRANSFER,
    /// From W/(m² K).
    w_m2_k = "W/(m^2 K)"
);
quantity!(
    /// A heat capacity.
    HeatCapacity, HEAT_CAPACITY,
    /// From joules per kelvin.
    j_k = "J/K",
    /// From kilojoules per kelvin.
    kj_k = "kJ/K"
);
quantity!(
    /// A heat capacity over mass.
    SpecificHeat, SPECIFIC_HEAT,
    /// From J/(kg K).
    j_kg_k = "J/(kg K)"
);
quantity!(
    /// A flow of volume.
    VolumeFlow, FLOW,
    /// From cubic metres per second.
    m3_s = "m^3/s",
    /// From litres per minute.
    l_min = "l/min"
);
quantity!(
    /// A speed along a line.
    Speed, SPEED,
    /// From metres per second.
    m_s = "m/s"
);

#[cfg(test)]
mod tests;
