//! What is read, what is refused, and what is said then: by table.

use super::dimension::KINDS;
use super::*;

/// Number, unit or text; the kind; the exact value as a product, and its power of π.
#[rustfmt::skip]
const READ: &[(&[&str], Dimension, &str, i8)] = &[
    (&["30 rpm", "30 RPM", "30 Rpm", "30rpm", "30 1/min", "30 min^-1", "30 min⁻¹", "30 min-1", "30 min−1", "30 /min", "30/min",
       "30 r/min", "30 rev/min", "30 U/min", "30 tr/min", "0.03 krpm", "0.5 rev/s", "1/2 U/s", "0.5 rps", "3e1 rpm", "180 deg/s",
       "180 °/s"],
     Dimension::ANGULAR_SPEED, "1", 1),
    (&["157 rad/s", "157 rad/sec", "157 rad·s⁻¹", "157 rad s^-1", "157rad/s", "0.157 rad/ms"], Dimension::ANGULAR_SPEED, "157", 0),
    (&["-12.5 N m", "-12.5Nm", "−12.5 N·m", "-12.5 N*m", "-12.5 N⋅m", "-12.5 N.m", "-12.5 N-m", "-12.5 N\u{a0}m", "-12.5 m N",
       "-0.0125 kNm", "-0.0125 kN m", "-12500 N mm", "-12500 Nmm", "-1250 N cm", "-1250 Ncm", "-12500 mNm", "-1.25 daN m",
       "-25/2 N m", "-12.5 J/rad", "-12.5 W s/rad"],
     Dimension::TORQUE, "-25/2", 0),
    (&["10 kgf m", "10 kgf·m", "10 kgf-m", "10 kgfm", "10 kp m", "1000 kgf cm"], Dimension::TORQUE, "10*9.80665", 0),
    (&["150 ft-lb", "150 lb-ft", "150 lb ft", "150 ft·lb", "150 ft lbs", "150 ftlb", "150 lbft", "150 lbf ft", "150 lbf·ft",
       "150 ft-lbf", "150 ftlbf", "1800 in-lb", "1800 lb in", "1800 in lbf", "1800 lbf-in", "28800 oz-in", "28800 ozf in",
       "28800 ozin", "150 ft–lb"],
     Dimension::TORQUE, "150*0.3048*4.4482216152605", 0),
    (&["75 kW", "75 KW", "75000 W", "0.075 MW", "75 kJ/s", "75000 N m/s", "75000 N m rad/s", "75kW"], Dimension::POWER, "75000", 0),
    (&["1 hp", "1 HP", "550 ft lbf/s", "550 ft-lb/s"], Dimension::POWER, "550*0.3048*4.4482216152605", 0),
    (&["1 PS", "1 cv", "1 CV", "1 ch", "75 kgf m/s"], Dimension::POWER, "75*9.80665", 0),
    (&["9 kJ", "9000 J", "2.5 W h", "2.5 Wh", "0.0025 kWh", "9000 W s", "9000 N m rad"], Dimension::ENERGY, "9000", 0),
    (&["2 mm", "2mm", "0.002 m", "2000 um", "2000 µm", "2000 μm", "0.2 cm", "2e6 nm"], Dimension::LENGTH, "1/500", 0),
    (&["1 in", "1/12 ft", "1e6 uin", "1e6 µin"], Dimension::LENGTH, "127/5000", 0),
    (&["20 deg", "20 °", "20°", "1200 arcmin", "1/18 rev"], Dimension::ANGLE, "1/9", 1),
    (&["60 degC", "60 °C", "60°C", "60 ºC", "60 ℃", "60 ° C", "60 deg C", "333.15 K", "140 degF", "140 °F"],
     Dimension::TEMPERATURE, "6663/20", 0),
    (&["-10 °C", "14 °F"], Dimension::TEMPERATURE, "5263/20", 0),
    (&["5 kN", "5000 N", "500 daN", "5e6 mN", "0.005 MN"], Dimension::FORCE, "5000", 0),
    (&["10 lbf", "10 lb", "160 ozf"], Dimension::FORCE, "10*4.4482216152605", 0),
    (&["10 lb", "10 lbs", "10 lbm", "160 oz"], Dimension::MASS, "10*0.45359237", 0),
    (&["2.5 kg", "2500 g", "0.0025 t"], Dimension::MASS, "5/2", 0),
    (&["5 l", "5 L", "5000 ml", "5 dm^3", "5 dm3", "5 dm³", "0.005 m³", "5000 cm**3"], Dimension::VOLUME, "1/200", 0),
    (&["890 kg/m^3", "890 kg/m³", "890 kg m^-3", "0.89 kg/dm3", "0.89 g/cm³", "0.89 kg/l"], Dimension::DENSITY, "890", 0),
    (&["2 bar", "200 kPa", "2000 mbar", "2000 hPa", "0.2 MPa", "0.2 N/mm²", "0.2 N/mm2"], Dimension::PRESSURE, "200000", 0),
    (&["1000 psi", "1 ksi", "1000 lbf/in^2", "1000 lb/in²"], Dimension::PRESSURE, "4448.2216152605/0.00064516", 0),
    (&["16.5 1/GPa", "16.5 GPa^-1", "16.5 GPa⁻¹", "16.5 /GPa"], Dimension::PRESSURE_COEFFICIENT, "33/2000000000", 0),
    (&["220 mm^2/s", "220 mm2/s", "220 mm²/s", "220 mm²·s⁻¹", "220 cSt", "2.2 St", "220 mm**2/s", "2.2 cm²/s"],
     Dimension::KINEMATIC_VISCOSITY, "11/50000", 0),
    (&["80 mPa s", "80 mPa·s", "80 mPas", "80 cP", "0.08 Pa s", "0.8 P", "0.08 N s/m^2", "0.08 kg/(m s)", "0.08 kg m^-1 s^-1"],
     Dimension::DYNAMIC_VISCOSITY, "2/25", 0),
    (&["500 ms", "0.5 s", "0.5 sec", "500000 us", "500000 µs", "1/120 min", "1/7200 h", "1/7200 hr"], Dimension::TIME, "1/2", 0),
    (&["2 Hz", "2 1/s", "2 s^-1", "2 s⁻¹", "2 s-1", "0.002 kHz", "120 1/min", "2/s"], Dimension::FREQUENCY, "2", 0),
    (&["0.7 m^2", "0.7 m²", "7000 cm2"], Dimension::AREA, "7/10", 0),
    (&["0.05 kg m^2", "0.05 kgm²", "0.05 kg·m²", "0.05 kg-m^2", "500 kg cm²", "500 kgcm2", "500000 g cm²", "500000 gcm^2",
       "0.05 N m s²", "0.05 Nms²"],
     Dimension::INERTIA, "1/20", 0),
    (&["1 slug ft^2", "1 lbf ft s^2", "1 ft-lb-s^2", "12 lbf in s²", "192 oz-in-s²"], Dimension::INERTIA, "0.3048*4.4482216152605", 0),
    (&["2 lb ft²", "288 lb-in^2", "4608 oz-in²"], Dimension::INERTIA, "2*0.45359237*0.09290304", 0),
    (&["1e4 N m/rad", "1e4 Nm/rad", "10 kNm/rad", "1e4 N·m·rad⁻¹"], Dimension::STIFFNESS, "10000", 0),
    (&["1 N m/deg", "1 Nm/°", "1/60 N m/arcmin"], Dimension::STIFFNESS, "180", -1),
    (&["2 N m s/rad", "2 Nms/rad", "2 N m/(rad/s)", "2 Nm/(rad/s)"], Dimension::VISCOUS, "2", 0),
    (&["2 Nm/rpm", "2 N m/rpm"], Dimension::VISCOUS, "60", -1),
    (&["0.02 N m s^2/rad", "0.02 Nms²/rad"], Dimension::TORQUE_PER_ACCELERATION, "1/50", 0),
    (&["0.05 N m s^2/rad^2", "0.05 N m s²/rad²"], Dimension::TORQUE_PER_SPEED_SQUARED, "1/20", 0),
];

#[test]
fn common_spellings_are_read_exactly() {
    for (texts, dimension, value, pi_power) in READ {
        for text in *texts {
            let found = parse(text, *dimension).unwrap_or_else(|e| panic!("{text}: {e}; {}", e.hint()));
            let value =
                value.split('*').map(|f| f.parse().unwrap()).fold(Rational::ONE, |a: Rational, f: Rational| a * f);
            assert_eq!((found.value, found.pi_power), (value, *pi_power), "{text}");
        }
    }
}

/// Text, kind, what is wrong, what to do.
#[rustfmt::skip]
const REFUSED: &[(&str, Dimension, &str, &str)] = &[
    // A torque is not an energy.
    ("350 J", Dimension::TORQUE, "`J` measures an energy", "did you mean \"350 N m\"?"),
    ("9 kJ", Dimension::TORQUE, "`kJ` measures an energy", "did you mean \"9 kN m\"?"),
    ("2 kWh", Dimension::TORQUE, "`kWh` measures an energy", "a torque looks like \"350 N m\""),
    ("350 N m", Dimension::ENERGY, "`N m` measures a torque", "did you mean \"350 J\"?"),
    ("150 ft-lb", Dimension::ENERGY, "`ft-lb` measures something else", "an energy looks like \"250 kJ\""),
    ("350 N m/rad", Dimension::TORQUE, "`N m/rad` measures a stiffness", "did you mean \"350 N m\"?"),
    ("1e4 N m", Dimension::STIFFNESS, "`N m` measures a torque", "did you mean \"1e4 N m/rad\"?"),
    ("2 N m s", Dimension::VISCOUS, "`N m s` measures something else", "did you mean \"2 N m s/rad\"?"),
    ("30 N", Dimension::TORQUE, "`N` measures a force", "a torque looks like \"350 N m\""),
    ("10 rpm", Dimension::TORQUE, "`rpm` measures an angular speed", "a torque looks like \"350 N m\""),
    // A kilogram is a mass.
    ("8 kg m", Dimension::TORQUE, "`kg m` measures something else", "did you mean \"8 kgf m\"?"),
    ("8 kg-cm", Dimension::TORQUE, "`kg-cm` measures something else", "did you mean \"8 kgf cm\"?"),
    ("2 kg/cm2", Dimension::PRESSURE, "`kg/cm2` measures something else", "did you mean \"2 kgf/cm^2\"?"),
    ("5 kg", Dimension::FORCE, "`kg` measures a mass", "did you mean \"5 kgf\"?"),
    // Turns or radians?
    ("50 Hz", Dimension::ANGULAR_SPEED, "`Hz` measures a frequency", "write \"50 rev/s\" or \"50 rad/s\""),
    ("157 1/s", Dimension::ANGULAR_SPEED, "`1/s` measures a frequency", "write \"157 rev/s\" or \"157 rad/s\""),
    ("157 s⁻¹", Dimension::ANGULAR_SPEED, "`s⁻¹` measures a frequency", "write \"157 rev/s\" or \"157 rad/s\""),
    // Only units of the quantity that is asked for.
    ("10 Nn", Dimension::TORQUE, "`Nn` is not a unit known here", "did you mean \"10 N m\"?"),
    ("1 kNM", Dimension::TORQUE, "`kNM` is not a unit known here", "did you mean \"1 kN m\"?"),
    ("350 nm", Dimension::TORQUE, "`nm` measures a length", "did you mean \"350 N m\"?"),
    ("350 NM", Dimension::TORQUE, "`NM` is not a unit known here", "did you mean \"350 N m\"?"),
    ("100 rmp", Dimension::ANGULAR_SPEED, "`rmp` is not a unit known here", "did you mean \"100 rpm\"?"),
    ("100 U/mn", Dimension::ANGULAR_SPEED, "`mn` is not a unit known here", "did you mean \"100 U/min\"?"),
    ("100 giri/min", Dimension::ANGULAR_SPEED, "`giri` is not a unit known here", "an angular speed looks like \"1450 rpm\""),
    ("5 Mw", Dimension::POWER, "`Mw` is not a unit known here", "did you mean \"5 MW\"?"),
    ("5 kw", Dimension::POWER, "`kw` is not a unit known here", "did you mean \"5 kW\"?"),
    ("206 Gpa", Dimension::PRESSURE, "`Gpa` is not a unit known here", "did you mean \"206 GPa\"?"),
    ("5 X", Dimension::MASS, "`X` is not a unit known here", "a mass looks like \"2.5 kg\""),
    ("60 C", Dimension::TEMPERATURE, "`C` is not a unit known here", "did you mean \"60 degC\"?"),
    ("60 Celsius", Dimension::TEMPERATURE, "`Celsius` is not a unit known here", "did you mean \"60 degC\"?"),
    ("20 degrees", Dimension::ANGLE, "`degrees` is not a unit known here", "did you mean \"20 deg\"?"),
    ("5 newton metres", Dimension::TORQUE, "`newton` is not a unit known here", "did you mean \"5 N m\"?"),
    ("3 inches", Dimension::LENGTH, "`inches` is not a unit known here", "did you mean \"3 in\"?"),
    ("10 N m/s/s", Dimension::TORQUE, "`N·m/s/s` is not a unit known here", "a torque looks like \"350 N m\""),
    ("10 N m^9", Dimension::TORQUE, "`m^9` is not a unit known here", "did you mean \"10 N m\"?"),
    ("10 (N m", Dimension::TORQUE, "`(N·m` is not a unit known here", "did you mean \"10 N m\"?"),
    ("10 N m)", Dimension::TORQUE, "`N m)` is not a unit known here", "did you mean \"10 N m\"?"),
    ("10 /", Dimension::TORQUE, "`/` is not a unit known here", "a torque looks like \"350 N m\""),
    // Numbers.
    ("10", Dimension::TORQUE, "the unit is missing", "write \"10 N m\" if that is the unit meant"),
    ("", Dimension::TORQUE, "it does not begin with a finite number of sensible size", "a torque looks like \"350 N m\""),
    ("ten N m", Dimension::TORQUE, "it does not begin with a finite number of sensible size", "a torque looks like \"350 N m\""),
    ("nan N m", Dimension::TORQUE, "it does not begin with a finite number of sensible size", "a torque looks like \"350 N m\""),
    ("1e999 N m", Dimension::TORQUE, "it does not begin with a finite number of sensible size", "a torque looks like \"350 N m\""),
    ("20,5 mm", Dimension::LENGTH, "the decimal sign is a decimal point, not a comma", "write \"20.5 mm\""),
    ("-20,5mm", Dimension::LENGTH, "the decimal sign is a decimal point, not a comma", "write \"-20.5mm\""),
    ("20,5", Dimension::LENGTH, "the decimal sign is a decimal point, not a comma", "write \"20.5 mm\""),
    ("1,5e-3 m", Dimension::LENGTH, "the decimal sign is a decimal point, not a comma", "write \"1.5e-3 m\""),
    ("0,125 mm", Dimension::LENGTH, "the decimal sign is a decimal point, not a comma", "write \"0.125 mm\""),
    ("1,450 rpm", Dimension::ANGULAR_SPEED, "the decimal sign is a decimal point, not a comma", "write \"1.450 rpm\" or \"1450 rpm\""),
    ("1450,5 rpm", Dimension::ANGULAR_SPEED, "the decimal sign is a decimal point, not a comma", "write \"1450.5 rpm\""),
    ("1450,5 RMP", Dimension::ANGULAR_SPEED, "the decimal sign is a decimal point, not a comma", "write \"1450.5 rpm\""),
    ("1 450 rpm", Dimension::ANGULAR_SPEED, "the digits of a number stand together", "write \"1450 rpm\""),
    ("1\u{202f}450,5 rpm", Dimension::ANGULAR_SPEED, "the decimal sign is a decimal point, not a comma", "write \"1450.5 rpm\""),
    ("1.450,5 rpm", Dimension::ANGULAR_SPEED, "the decimal sign is a decimal point, not a comma", "write \"1450.5 rpm\""),
    ("1,450.5 rpm", Dimension::ANGULAR_SPEED, "the digits of a number stand together", "write \"1450.5 rpm\""),
    ("12'500 N", Dimension::FORCE, "the digits of a number stand together", "write \"12500 N\""),
    ("1,234,567 N", Dimension::FORCE, "the digits of a number stand together", "write \"1234567 N\""),
    ("1.234.567 N", Dimension::FORCE, "the digits of a number stand together", "write \"1234567 N\""),
];

#[test]
fn refusals_say_what_is_wrong_and_what_to_write() {
    for (text, dimension, fault, hint) in REFUSED {
        let error = parse(text, *dimension).unwrap_err();
        assert_eq!((error.to_string().as_str(), error.hint().as_str()), (*fault, *hint), "{text}");
        for instead in &error.instead {
            assert!(parse(instead, *dimension).is_ok(), "{text}: {instead}");
        }
    }
}

#[test]
fn units_that_are_suggested_are_read() {
    for kind in KINDS {
        assert!(parse(kind.example, kind.dimension).is_ok(), "{}", kind.example);
        for unit in kind.units {
            assert!(parse(&format!("1 {unit}"), kind.dimension).is_ok(), "{unit} of {}", kind.name);
        }
    }
}

#[test]
fn a_symbol_has_one_meaning() {
    let all: Vec<&str> =
        symbols::UNITS.iter().flat_map(|u| u.0).chain(symbols::TOGETHER.iter().map(|t| &t.0)).copied().collect();
    for (k, symbol) in all.iter().enumerate() {
        assert!(!all[..k].contains(symbol), "{symbol}");
    }
    for (name, parts) in symbols::TOGETHER {
        assert_eq!(parts.concat(), *name);
        assert!(parts.iter().all(|part| symbols::UNITS.iter().any(|u| u.0.contains(part))), "{name}");
    }
}

#[test]
fn long_and_wild_texts_are_refused_quickly() {
    for text in [
        "9".repeat(10_000),
        format!("1 {}", "(".repeat(60)),
        format!("1 {}", "km^4 ".repeat(12)),
        "1 \u{0}\u{7f}".into(),
    ] {
        assert!(parse(&text, Dimension::TORQUE).is_err());
    }
}
