//! Quantities as text that reads back as exactly the same quantity.

use crate::exact::Rational;
use crate::units::{self, Dimension, Quantity};

/// In which units people write what; the first is taken where several are as short.
const UNITS: &[(Dimension, &[&str])] = &[
    (Dimension::ANGULAR_SPEED, &["rpm", "rad/s"]),
    (Dimension::TORQUE, &["N m", "kN m"]),
    (Dimension::POWER, &["kW", "W", "MW"]),
    (Dimension::LENGTH, &["mm", "um", "m"]),
    (Dimension::ANGLE, &["deg", "rad"]),
    (Dimension::TEMPERATURE, &["degC", "K"]),
    (Dimension::FORCE, &["N", "kN"]),
    (Dimension::MASS, &["kg", "g", "t"]),
    (Dimension::VOLUME, &["l", "m^3", "ml"]),
    (Dimension::DENSITY, &["kg/m^3", "g/cm^3"]),
    (Dimension::PRESSURE, &["GPa", "MPa", "Pa"]),
    (Dimension::PRESSURE_COEFFICIENT, &["1/GPa", "1/Pa"]),
    (Dimension::KINEMATIC_VISCOSITY, &["mm^2/s", "m^2/s"]),
    (Dimension::DYNAMIC_VISCOSITY, &["mPa s", "Pa s"]),
    (Dimension::TIME, &["s", "ms", "min", "h"]),
    (Dimension::FREQUENCY, &["Hz", "kHz"]),
    (Dimension::AREA, &["m^2", "mm^2"]),
    (Dimension::INERTIA, &["kg m^2", "g cm^2"]),
    (Dimension::STIFFNESS, &["N m/rad", "N m/deg"]),
    (Dimension::VISCOUS, &["N m s/rad", "N m/rpm", "N m s/deg"]),
    (Dimension::TORQUE_PER_ACCELERATION, &["N m s^2/rad", "N m s^2/deg"]),
    (Dimension::TORQUE_PER_SPEED_SQUARED, &["N m s^2/rad^2", "N m s^2/deg^2", "N m s^2/rad deg"]),
    (Dimension::CONDUCTANCE, &["W/K", "kW/K"]),
    (Dimension::HEAT_TRANSFER, &["W/(m^2 K)"]),
    (Dimension::HEAT_CAPACITY, &["kJ/K", "J/K"]),
    (Dimension::SPECIFIC_HEAT, &["J/(kg K)"]),
    (Dimension::FLOW, &["l/min", "m^3/s"]),
    (Dimension::SPEED, &["m/s"]),
];

/// The number before a unit. Decimals where they are exact, else a fraction.
pub(crate) fn number(value: &Rational) -> String {
    let decimal = value.to_f64();
    match Rational::from_f64(decimal) {
        Some(same) if same == *value => {
            let long = format!("{decimal}");
            let short = format!("{decimal:e}");
            if long.len() > 12 && short.len() < long.len() { short } else { long }
        }
        _ => value.to_string(),
    }
}

/// The shortest text, in units that people use, which reads back as this quantity.
pub(crate) fn written(quantity: &Quantity) -> String {
    let units = UNITS.iter().find(|u| u.0 == quantity.dimension).map_or(&[][..], |u| u.1);
    let scale = |number: &str, unit: &str| units::parse(&format!("{number} {unit}"), quantity.dimension).ok();
    let in_unit = |unit: &&str| {
        let (zero, one) = (scale("0", unit)?, scale("1", unit)?);
        let same_power = one.pi_power == quantity.pi_power;
        let value = &(&quantity.value - &zero.value) / &(&one.value - &zero.value);
        same_power.then(|| format!("{} {unit}", number(&value)))
    };
    let shortest = units.iter().filter_map(in_unit).min_by_key(|text| length(text));
    // A power of π that no unit here has: units of angle divided by others of angle.
    shortest.unwrap_or_else(|| {
        let nearest = Rational::from_f64(quantity.si()).unwrap_or(Rational::ZERO);
        let unit = units.iter().find(|u| scale("1", u).is_some_and(|q| q.pi_power == 0));
        format!("{} {}", number(&nearest), unit.unwrap_or(&""))
    })
}

/// Fractions are the last choice.
fn length(text: &str) -> (bool, usize) {
    let number = text.split(' ').next().unwrap_or(text);
    (number.contains('/'), number.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        for (text, dimension) in [
            ("4920 rpm", Dimension::ANGULAR_SPEED),
            ("82 rev/s", Dimension::ANGULAR_SPEED),
            ("100 rad/s", Dimension::ANGULAR_SPEED),
            ("1/3 rad/s", Dimension::ANGULAR_SPEED),
            ("150 lbf ft", Dimension::TORQUE),
            ("350 N m", Dimension::TORQUE),
            ("75 kW", Dimension::POWER),
            ("0.4 um", Dimension::LENGTH),
            ("12.5 mm", Dimension::LENGTH),
            ("20 deg", Dimension::ANGLE),
            ("0.1 rad", Dimension::ANGLE),
            ("60 degC", Dimension::TEMPERATURE),
            ("333.15 K", Dimension::TEMPERATURE),
            ("16.5 1/GPa", Dimension::PRESSURE_COEFFICIENT),
            ("220 mm^2/s", Dimension::KINEMATIC_VISCOSITY),
            ("180 N m/deg", Dimension::STIFFNESS),
            ("2 Nm/rpm", Dimension::VISCOUS),
            ("0.05 N m s^2/rad^2", Dimension::TORQUE_PER_SPEED_SQUARED),
            ("6e-5 kg m^2", Dimension::INERTIA),
            ("0 rpm", Dimension::ANGULAR_SPEED),
        ] {
            let quantity = units::parse(text, dimension).unwrap();
            let again = written(&quantity);
            let read = units::parse(&again, dimension).unwrap();
            assert_eq!((&read.value, read.si()), (&quantity.value, quantity.si()), "{text}: {again}");
        }
        let shown = |text: &str, dimension| written(&units::parse(text, dimension).unwrap());
        assert_eq!(shown("0.02 m", Dimension::LENGTH), "20 mm");
        assert_eq!(shown("82 rev/s", Dimension::ANGULAR_SPEED), "4920 rpm");
        assert_eq!(shown("333.15 K", Dimension::TEMPERATURE), "60 degC");
    }
}
