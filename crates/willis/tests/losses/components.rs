//! Laws of bearings, windage, churning, seals and rotor drag, and the catalogues they read.
//! `val_` compares with numbers of others (printed, measured, or worked out independently of this
//! library), `regress_` holds formulas whose constants stand as recalled, `prop_` holds what any
//! physical law must obey.

use std::f64::consts::PI;

use num_dual::Dual64;
use proptest::prelude::*;
use willis::catalogue::Trust;
use willis::catalogue::bearing::{self, Bearing, Kind, Mismatch};
use willis::catalogue::oil::{self, Base, Oil};
use willis::losses::bearing::{BearingDuty, BearingTorque, Palmgren, Skf, Skf6000, Supply};
use willis::losses::churning::{self, Changenet2011, Churning, ImmersedGear};
use willis::losses::rotor_drag::{Drum, RotorDrag};
use willis::losses::seal::{Material, SealContact, SealLoss};
use willis::losses::windage::{self, AndersonLoewenthal, Dawson1984, Diab, Disc, Windage};

#[track_caller]
fn close(what: &str, ours: f64, theirs: f64, relative: f64) {
    let off = (ours / theirs - 1.0).abs();
    assert!(off <= relative, "{what}: {ours} instead of {theirs}, {:.3} % off", 100.0 * off);
}

fn rpm(n: f64) -> f64 {
    n * PI / 30.0
}

// ---------------------------------------------------------------- oils

/// ASTM D341 with the constant 0.7, evaluated independently.
#[test]
fn val_oil_astm_d341() {
    let cases = [
        ("VG 100", 100.0, 11.0, [344.4091, 39.49703, 19.32246, 14.34843, 6.987362]),
        ("N100", 97.9, 8.61, [412.6413, 34.40007, 15.72814, 11.42249, 5.3472]),
        ("EV oil", 30.8, 5.9, [75.22988, 15.54672, 9.086752, 7.240793, 4.138892]),
    ];
    for (name, nu_40, nu_100, values) in cases {
        let oil = Oil::from_two_points(name, Base::Mineral, nu_40 * 1e-6, nu_100 * 1e-6, 880.0);
        for (celsius, nu) in [20.0, 60.0, 80.0, 90.0, 120.0].into_iter().zip(values) {
            close(name, oil.kinematic_viscosity(celsius + 273.15) * 1e6, nu, 1e-5);
        }
    }
    // the fit and a point of another implementation of the same law
    let oil = Oil::from_two_points("150/15", Base::Mineral, 150e-6, 15e-6, 880.0);
    let oil::Viscosity::Walther { a, b } = oil.viscosity else { panic!("two points give Walther's law") };
    close("A", a, 8.87413053940712, 1e-9);
    close("B", b, 3.4202311203406692, 1e-9);
    close("nu at 20 °C", oil.kinematic_viscosity(293.15) * 1e6, 535.9452055436727, 1e-9);
}

/// A printed table of an axle oil for electric vehicles, 80 and 90 °C; it was made with the constant
/// 0.8 of DIN 51563, which makes 0.4 %.
#[test]
fn val_oil_printed_ev_oil() {
    let oil = oil::find("70w-75w ev axle oil").unwrap();
    close("80 °C", oil.kinematic_viscosity(353.15) * 1e6, 9.12, 0.004);
    close("90 °C", oil.kinematic_viscosity(363.15) * 1e6, 7.25, 0.003);
}

/// Viscosity, density, conductivity, slope and Gold's coefficient of gear oils in the public program
/// GEARpie (its own α exchanges the two constants of Gold; the values here are the corrected ones).
#[test]
fn val_oil_gearpie() {
    // base, °C, ν mm²/s, ρ g/cm³, k mW/(m K), β 1/K, α 1/GPa
    let rows = [
        (Base::Pao, 80.0, 60.180736, 0.828291, 142.944974, 12.756502),
        (Base::Mineral, 80.0, 43.677937, 0.867995, 136.406379, 16.74199),
        (Base::Ester, 80.0, 55.863955, 0.866825, 136.590391, 11.415179),
        (Base::Mineral, 70.0, 37.412124, 0.873226, 135.818188, 16.385487),
        (Base::Pao, 90.0, 13.753687, 0.823566, 143.522151, 10.474975),
        (Base::Mineral, 60.0, 39.235425, 0.878458, 135.237003, 16.494225),
        (Base::Mineral, 60.0, 28.158723, 0.878458, 135.237003, 15.750953),
    ];
    for (base, celsius, nu, rho, k, alpha) in rows {
        close("α", base.gold_pressure_viscosity(nu * 1e-6) * 1e9, alpha, 1e-6);
        let density = rho * 1e3 / (1.0 + base.expansion() * (celsius - 15.0));
        let oil = Oil::from_two_points("", base, 100e-6, 11e-6, density);
        close("ρ15 is whole", density, density.round(), 1e-5);
        close("k", oil.conductivity(celsius + 273.15) * 1e3, k, 2e-5);
    }
    let m320 = oil::find("MINR").unwrap();
    close("ν MINR", m320.kinematic_viscosity(353.15) * 1e6, 43.677937, 1e-5);
    close("η MINR", m320.dynamic_viscosity(353.15) * 1e3, 37.912213, 1e-5);
    let p320 = oil::find("PAOR").unwrap();
    close("ν PAOR", p320.kinematic_viscosity(353.15) * 1e6, 60.180736, 1e-5);
    close("η PAOR", p320.dynamic_viscosity(353.15) * 1e3, 49.847147, 1e-5);
    close("ν ESTR", oil::find("ESTR").unwrap().kinematic_viscosity(353.15) * 1e6, 55.863955, 1e-5);
}

#[test]
fn oil_slope_is_the_derivative() {
    for oil in oil::all() {
        let t = 340.0;
        let slope = -oil.dynamic_viscosity(Dual64::new(t, 1.0)).eps / oil.dynamic_viscosity(t);
        if !matches!(oil.viscosity, oil::Viscosity::Fixed { .. }) {
            close(&oil.name, oil.viscosity_slope(t), slope, 1e-9);
            assert!((0.015..0.06).contains(&slope), "{}: {slope}", oil.name);
        }
    }
}

#[test]
fn oil_under_pressure() {
    assert_eq!(oil::barus(0.08, 2e-8, 0.0), 0.08);
    close("barus", oil::barus(0.08, 2e-8, 1e8), 0.08 * 2f64.exp(), 1e-12);
    assert_eq!(oil::roelands(0.08, 2e-8, 0.0), 0.08);
    let slope = oil::roelands(Dual64::from(0.08), Dual64::from(2e-8), Dual64::new(0.0, 1.0)).eps / 0.08;
    close("slope of Roelands at no pressure", slope, 2e-8, 1e-12);
    assert!(oil::roelands(0.08, 2e-8, 1e9) < oil::barus(0.08, 2e-8, 1e9));
}

#[test]
fn oil_catalogue() {
    assert!(oil::all().len() >= 30);
    let wang = Oil::fixed("Wang 2020", Base::Mineral, 0.08, 870.0);
    assert_eq!((wang.dynamic_viscosity(323.0), wang.density(323.0)), (0.08, 870.0));
    close("ν", wang.kinematic_viscosity(323.0), 0.08 / 870.0, 1e-12);
    assert!(wang.covers(323.0));
    let fva3 = oil::find("fva 3").unwrap();
    close("FVA3 by Vogel, 50 °C", fva3.dynamic_viscosity(323.15) * 1e3, 0.062 * (1021.7f64 / 151.55).exp(), 1e-9);
    assert_eq!(fva3.trust, Trust::Seen);
    assert_eq!(oil::find("ISO VG 320").unwrap().trust, Trust::Typical);
    assert!(!oil::find("ISO VG 320").unwrap().covers(473.0));
    assert!(oil::find("no such oil").is_none());
    for (k, oil) in oil::all().iter().enumerate() {
        assert!(oil::all()[..k].iter().all(|o| o.name != oil.name), "{} twice", oil.name);
        let t = oil.temperature_range().into_iter().sum::<f64>().clamp(0.0, 700.0) / 2.0;
        let t = if oil.covers(t) && t > 100.0 { t } else { 340.0 };
        let (nu, rho) = (oil.kinematic_viscosity(t), oil.density(t));
        assert!((1e-6..2e-3).contains(&nu) && (700.0..1200.0).contains(&rho), "{}: {nu} {rho}", oil.name);
        assert!((5e-9..30e-9).contains(&oil.pressure_viscosity(t)), "{}", oil.name);
        assert!((0.1..0.2).contains(&oil.conductivity(t)) && !oil.source.is_empty(), "{}", oil.name);
    }
    let measured = oil::find("75W90 at 110 C").unwrap();
    assert_eq!(format!("{:.2}", measured.pressure_viscosity(383.15) * 1e9), "9.68");
}

// ---------------------------------------------------------------- bearings: catalogue

#[test]
fn bearing_designations() {
    let row = |name: &str| {
        let b = bearing::find(name).unwrap_or_else(|| panic!("{name}"));
        assert_eq!(b.check(), vec![], "{name}");
        [b.bore, b.outside_diameter, b.width].map(|x| (x * 1e6).round() / 1e3)
    };
    assert_eq!(row("NU 1022 ECP"), [110.0, 170.0, 28.0]);
    assert_eq!(row("nj2210"), [50.0, 90.0, 23.0]);
    assert_eq!(row("NU 2322"), [110.0, 240.0, 80.0]);
    assert_eq!(row("6205-2RS1"), [25.0, 52.0, 15.0]);
    assert_eq!(row("61811-2RS1"), [55.0, 72.0, 9.0]);
    assert_eq!(row("6302"), [15.0, 42.0, 13.0]);
    assert_eq!(row("32216 J2"), [80.0, 140.0, 35.25]);
    assert_eq!(row("32022 X"), [110.0, 170.0, 38.0]);
    assert_eq!(row("30306"), [30.0, 72.0, 20.75]);
    assert_eq!(row("22216 E"), [80.0, 140.0, 33.0]);
    assert_eq!(row("7208 BECBP"), [40.0, 80.0, 18.0]);
    assert_eq!(bearing::find("6205 2rs").unwrap().seal.unwrap().lips, 2);
    assert_eq!(bearing::find("6205-RS1").unwrap().seal.unwrap().lips, 1);
    assert!(bearing::find("6205-2Z").unwrap().seal.is_none());
    assert!(bearing::find("6205-2RZ").unwrap().seal.is_none());
    assert_ne!(bearing::find("22216 E").unwrap().skf, bearing::find("22216").unwrap().skf);
    assert_ne!(bearing::find("7208 B").unwrap().skf, bearing::find("7208 AC").unwrap().skf);
    let cage = bearing::find("K 20x24x10").unwrap();
    assert_eq!((cage.kind, cage.bore, cage.width), (Kind::NeedleRoller, 0.020, 0.010));
    assert!(matches!(cage.check()[..], [Mismatch::NoConstants { .. }]));
    for nonsense in ["", "NU", "6", "62", "62xx", "6299", "hello 6205", "K 20x24", "ß6205", "NU 99999999999999"] {
        assert!(bearing::find(nonsense).is_none(), "{nonsense}");
    }
}

#[test]
fn bearing_catalogue() {
    assert!(bearing::all().len() > 500);
    for (k, b) in bearing::all().iter().enumerate() {
        assert_eq!(bearing::find(&b.designation).as_ref().map(|f| f.width), Some(b.width), "{}", b.designation);
        assert!(bearing::all()[..k].iter().all(|o| o.designation != b.designation), "{} twice", b.designation);
        let constants = if b.kind == Kind::NeedleRoller { 1 } else { 0 };
        assert_eq!(b.check().len(), constants, "{}: {:?}", b.designation, b.check());
        // section of the ring between a third of the width and five times of it
        let section = (b.outside_diameter - b.bore) / 2.0;
        assert!((0.3..6.0).contains(&(b.width / section)), "{}", b.designation);
        if let (Some(c), Some(c0)) = (b.dynamic_rating, b.static_rating) {
            let likely = match b.kind {
                Kind::NeedleRoller => 1.1..3.3,
                Kind::AxialCylindricalRoller => 2.0..4.6,
                _ if b.bore > 0.15 => 0.9..1.7,
                _ => 0.4..1.4,
            };
            assert!(likely.contains(&(c0 / c)), "{}: {}", b.designation, c0 / c);
        }
        if let Some(speed) = b.limiting_speed {
            let mean = (b.bore + b.outside_diameter) / 2.0;
            let speed_factor = speed * 30.0 / PI * mean * 1e3;
            assert!((0.2e6..1.2e6).contains(&speed_factor), "{}: {speed_factor:e}", b.designation);
        }
        if let Some(element) = b.element_diameter {
            assert!(element < 0.6 * b.width && element < section, "{}", b.designation);
        }
    }
    // Every kind that has constants can be had by a designation.
    for (name, kind) in Kind::NAMES {
        let absent = matches!(kind, Kind::DoubleRowAngularContactBall | Kind::FourPointContactBall | Kind::Plain);
        assert_eq!(bearing::all().iter().any(|b| b.kind == *kind), !absent, "{name}");
    }
    assert!(bearing::all().iter().any(|b| b.bore >= 0.38));
}

/// Rows of the catalogues of makers, read a second time.
#[test]
fn val_ratings_of_makers() {
    for (name, envelope, ratings, rpm_limit) in [
        ("6064", [320.0, 480.0, 74.0], [371e3, 540e3], 2200.0),
        ("61876", [380.0, 480.0, 46.0], [242e3, 390e3], 2000.0),
        ("16052", [260.0, 400.0, 44.0], [238e3, 310e3], 2000.0),
        ("NA 4906", [30.0, 47.0, 17.0], [23e3, 34e3], 12350.0),
        ("NA 4876", [380.0, 480.0, 100.0], [950e3, 2700e3], 1045.0),
        ("81120", [100.0, 135.0, 25.0], [197e3, 649.8e3], 2400.0),
        ("81272", [360.0, 500.0, 110.0], [2690.6e3, 10_595e3], 600.0),
    ] {
        let b = bearing::find(name).unwrap_or_else(|| panic!("{name}"));
        assert_eq!([b.bore, b.outside_diameter, b.width].map(|x| (x * 1e6).round() / 1e3), envelope, "{name}");
        assert_eq!([b.dynamic_rating, b.static_rating].map(|x| x.map(f64::round)), ratings.map(Some), "{name}");
        close(name, b.limiting_speed.unwrap(), rpm(rpm_limit), 1e-12);
    }
    for (name, envelope) in [
        ("NU 1076", [380.0, 560.0, 82.0]),
        ("NCF 1840", [200.0, 250.0, 24.0]),
        ("C 2210", [50.0, 90.0, 23.0]),
        ("51120", [100.0, 135.0, 25.0]),
    ] {
        let b = bearing::find(name).unwrap_or_else(|| panic!("{name}"));
        assert_eq!([b.bore, b.outside_diameter, b.width].map(|x| (x * 1e6).round() / 1e3), envelope, "{name}");
    }
}

/// The bearing of Wang et al. 2020: bore 110, outside diameter 170, width 38 mm, constants of series
/// 23. NU 2322 is 240 × 80 mm, NU 1022 is 28 mm wide, 38 mm is the width of the tapered 32022 X.
#[test]
fn val_bearing_of_wang_2020_is_inconsistent() {
    let bearing = Bearing::new("planet bearing", Kind::CylindricalRoller, "23", 0.110, 0.170, 0.038);
    let said: Vec<_> = bearing.check().iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "series 23 has an outside diameter of 240 mm at this bore, given are 170 mm",
            "series 23 is 80 mm wide at this bore, given are 38 mm",
            "bore and outside diameter are those of NU 1022, which is 28 mm wide, given are 38 mm",
            "the envelope is that of 32022 X, a tapered roller bearing",
        ]
    );
    let wrong_bore = Bearing::new("NU 1022", Kind::CylindricalRoller, "10", 0.100, 0.150, 0.024);
    assert_eq!(wrong_bore.check().first(), Some(&Mismatch::Bore { designated: 0.110, given: 0.100 }));
    let inside_out = Bearing::new("", Kind::CylindricalRoller, "10", 0.100, 0.090, 0.024);
    assert!(matches!(inside_out.check()[..], [Mismatch::NotABearing { .. }]));
}

// ---------------------------------------------------------------- bearings: torque

fn duty(bearing: &Bearing) -> BearingDuty<f64> {
    BearingDuty { bearing: bearing.data(), ..BearingDuty::typical() }
}

/// Hand calculation of another project for 30306 (Y = 1.6 as taken there), rounded in its steps.
#[test]
fn val_skf_30306_by_hand() {
    let bearing = Bearing { axial_factor: Some(1.6), ..bearing::find("30306").unwrap() };
    let state = BearingDuty {
        speed: rpm(1500.0),
        radial_load: 5000.0,
        axial_load: 2000.0,
        kinematic_viscosity: 22e-6,
        supply: Supply::Bath { level: 0.0 },
        ..duty(&bearing)
    };
    let parts = Skf::DEFAULT.parts(&state).unwrap();
    let rolling = parts.inlet_heating * parts.replenishment * parts.rolling;
    close("factors", parts.inlet_heating * parts.replenishment, 0.951, 0.001);
    close("M_rr", rolling * 1e3, 256.0, 0.015);
    close("M_rr, recomputed", rolling * 1e3, 255.5, 0.0005);
    close("M_sl", parts.sliding * 1e3, 44.0, 0.015);
    close("M_sl, recomputed", parts.sliding * 1e3, 44.4, 0.002);
    close("M", parts.total() * 1e3, 300.0, 0.015);
}

/// Caged NU 308 of series 3, evaluated independently.
#[test]
fn val_skf_nu_308() {
    let law = Skf { starvation: Some(0.0), ..Skf::DEFAULT };
    let state = BearingDuty { supply: Supply::Bath { level: 0.0 }, ..BearingDuty::typical() };
    let parts = law.parts(&state).unwrap();
    close("phi_ish", parts.inlet_heating, 0.9547168, 1e-6);
    close("phi_rs M_rr", parts.inlet_heating * parts.replenishment * parts.rolling * 1e3, 251.185, 1e-6);
    close("phi_bl", parts.boundary_share, 0.0002570967, 1e-6);
    close("M_sl", parts.sliding * 1e3, 9.762533, 1e-6);
    close("M", parts.total() * 1e3, 260.9475, 1e-6);
}

/// Drag of the same bearing in an oil bath of 6.5 mm with V_M = 1e-4, evaluated independently.
#[test]
fn val_skf_drag() {
    let law = Skf { drag_loss_factor: Some(1e-4), ..Skf::DEFAULT };
    close("M_drag", law.parts(&BearingDuty::typical()).unwrap().drag * 1e3, 4.725296, 1e-6);
    // two oils of measured sliding: the coefficients are used
    let measured = BearingDuty { sliding_friction: Some([0.0354, 0.0177]), ..BearingDuty::typical() };
    let ratio = law.parts(&measured).unwrap().sliding / law.parts(&BearingDuty::typical()).unwrap().sliding;
    close("sliding", ratio, (0.0177 + 0.0002570967 * 0.0177) / 0.02002571, 1e-5);
}

/// The bearing of Wang et al. 2020 with the drag of the old catalogue, evaluated independently with
/// every factor on the way.
#[test]
fn val_skf_6000_wang_2020() {
    let bearing = Bearing::new("", Kind::CylindricalRoller, "23", 0.110, 0.170, 0.038);
    let state = BearingDuty { speed: rpm(4920.0), radial_load: 2445.0, kinematic_viscosity: 92e-6, ..duty(&bearing) };
    let law = Skf6000 { starvation: Some(6e-8), drag_loss_factor: Some(1.2e-4) };
    let parts = law.parts(&state).unwrap();
    close("phi_ish", parts.inlet_heating, 0.5032228550982959, 1e-9);
    close("phi_rs", parts.replenishment, 0.2085289652105592, 1e-9);
    close("phi_bl", parts.boundary_share, 1.258793874432471e-131, 1e-6);
    // the reference counts both factors into M_rr
    let rolling = parts.inlet_heating * parts.replenishment * parts.rolling;
    close("M_rr", parts.rolling * 1e3, 2.470567528552759 * (92.0f64 * 4920.0).powf(0.6), 1e-9);
    close("M_rr reduced", rolling * 1e3, 641.4683492497527, 1e-9);
    close("M_sl", parts.sliding * 1e3, 10.268999999999998, 1e-9);
    close("M_drag", parts.drag * 1e3, 6559.904314349567, 1e-9);
    close("M", parts.total() * 1e3, 7211.64166359932, 1e-9);
    close("P, with 1.047e-4 printed for π/30 000", parts.total() * state.speed, 3715.5906371924543, 3e-4);
    // the first term of the new drag is 3.8 times smaller
    let new = Skf { drag_loss_factor: Some(1.2e-4), ..Skf::DEFAULT };
    let bath = BearingDuty { kinematic_viscosity: 1e-12, supply: Supply::Bath { level: 0.02 }, ..state };
    close("old over new", parts.drag / new.parts(&bath).unwrap().drag, 10.0 / (4.0 * 0.6608849860664544), 1e-3);
}

/// Free run of two 61811-2RS1: the part of the torque that does not depend on speed, fitted to the
/// measured power, is 0.387 ± 0.025 N m; seals of 197 N mm each make nearly all of it.
#[test]
fn val_skf_seal_of_61811() {
    let mut bearing = bearing::find("61811-2RS1").unwrap();
    bearing.seal.as_mut().unwrap().diameter = Some(59.5e-3);
    let state = BearingDuty {
        speed: rpm(1869.0),
        radial_load: 6.51,
        kinematic_viscosity: 30e-6,
        supply: Supply::Grease,
        ..duty(&bearing)
    };
    let parts = Skf::DEFAULT.parts(&state).unwrap();
    close("seal", parts.seals * 1e3, 0.018 * 59.5f64.powf(2.25) + 20.0, 1e-9);
    close("seal, printed", parts.seals * 1e3, 197.0, 0.002);
    close("two bearings", 2.0 * parts.total(), 0.387, 0.065);
    // the estimate of the counterface from the envelope
    bearing.seal.as_mut().unwrap().diameter = None;
    let estimate = Skf::DEFAULT.parts(&duty(&bearing)).unwrap().seals;
    close("estimated counterface", estimate * 1e3, 197.0, 0.06);
}

/// 32216 in FVA3, measured torque read from figures (±8 %): the catalogue model is 1.3 to 2.1 times
/// too high there.
#[test]
fn val_skf_32216_is_conservative() {
    let bearing = Bearing { element_diameter: Some(17e-3), ..bearing::find("32216").unwrap() };
    let nu = oil::find("FVA3").unwrap().kinematic_viscosity(323.15);
    // r/min, mean of the readings, and the model without drag evaluated independently, N mm
    for (n, read, model) in [(500.0, 1250.0, 2603.0), (2000.0, 2850.0, 4546.0), (4000.0, 3800.0, 4749.0)] {
        let state = BearingDuty {
            speed: rpm(n),
            radial_load: 0.0,
            axial_load: 6000.0,
            kinematic_viscosity: nu,
            supply: Supply::Bath { level: 8.5e-3 },
            ..duty(&bearing)
        };
        let parts = Skf::DEFAULT.parts(&state).unwrap();
        close("without drag", (parts.total() - parts.drag) * 1e3, model, 0.002);
        let ratio = parts.total() * 1e3 / read;
        assert!((1.1..2.4).contains(&ratio), "{n} r/min: {ratio}");
    }
}

#[test]
fn skf_at_rest_is_the_starting_torque() {
    let rest = BearingDuty { speed: 0.0, ..BearingDuty::typical() };
    close("NU 308", BearingTorque::default().eval(&rest) * 1e3, 0.0015 * 65.0 * 5000.0 * 0.15, 1e-12);
    let dual = BearingTorque::default().eval(&with_speed(&rest, Dual64::new(0.0, 1.0)));
    assert!(dual.eps.is_finite());
}

#[test]
fn regress_palmgren_and_drag_factor() {
    let nu308 = BearingDuty::typical();
    close("Palmgren", BearingTorque::named("palmgren").unwrap().eval(&nu308), 0.18168, 1e-4);
    let needle = duty(&bearing::find("NA 4906").unwrap());
    assert!(needle.bearing.skf.is_none());
    let palmgren = BearingTorque::Palmgren(Palmgren::DEFAULT);
    assert_eq!(BearingTorque::default().eval(&needle), palmgren.eval(&needle));
    // ends and a middle of the digitised diagrams
    for (kind, at, v_m) in [
        (Kind::DeepGrooveBall, 0.5, 5.6581e-4),
        (Kind::DeepGrooveBall, 1.2, 1.24e-3),
        (Kind::CylindricalRoller, 0.1, 1.158e-4),
        (Kind::CylindricalRoller, 1.2, 1.435e-3),
    ] {
        let drag = bearing::skf_constants(kind, if kind.is_ball() { "62" } else { "2" }).unwrap().drag;
        assert!(drag.windows(2).all(|w| w[0][0] < w[1][0] && w[0][1] < w[1][1]));
        let k = drag.partition_point(|p| p[0] < at);
        let [[x0, y0], [x1, y1]] = [drag[k - 1], drag[k]];
        close("V_M", y0 + (y1 - y0) * (at - x0) / (x1 - x0), v_m, 0.01);
    }
}

fn with_speed<D: willis::Real<Constant = f64>>(s: &BearingDuty<f64>, speed: D) -> BearingDuty<D> {
    BearingDuty {
        bearing: s.bearing,
        speed,
        radial_load: D::from(s.radial_load),
        axial_load: D::from(s.axial_load),
        kinematic_viscosity: D::from(s.kinematic_viscosity),
        base: s.base,
        sliding_friction: s.sliding_friction,
        supply: s.supply,
    }
}

fn supplies() -> impl Strategy<Value = Supply> {
    prop_oneof![
        (0.0..0.2).prop_map(|level| Supply::Bath { level }),
        Just(Supply::Jet),
        Just(Supply::Mist),
        Just(Supply::Grease),
    ]
}

/// Any bearing of the catalogue and some kinds it does not hold, in any state.
fn duties() -> impl Strategy<Value = BearingDuty<f64>> {
    let extra = [
        (Kind::FullComplementCylindricalRoller, "22"),
        (Kind::FourPointContactBall, "2"),
        (Kind::DoubleRowAngularContactBall, "32 A"),
        (Kind::ToroidalRoller, "22"),
        (Kind::AxialBall, "512"),
        (Kind::AxialCylindricalRoller, "811"),
        (Kind::NeedleRoller, "K"),
        (Kind::SphericalRoller, "222 E"),
    ];
    let pick = 0..bearing::all().len() + extra.len();
    let of = move |k: usize| match bearing::all().get(k) {
        Some(b) => b.data(),
        None => {
            let (kind, series) = extra[k - bearing::all().len()];
            Bearing::new("", kind, series, 0.05, 0.09, 0.023).data()
        }
    };
    let bases = prop_oneof![Just(Base::Mineral), Just(Base::Pao), Just(Base::Traction)];
    (pick, 0.0..2000.0, 0.0..2e5, prop_oneof![Just(0.0), 0.0..1e5], 2e-6..1e-3, bases, supplies()).prop_map(
        move |(k, speed, radial_load, axial_load, kinematic_viscosity, base, supply)| BearingDuty {
            bearing: of(k),
            speed,
            radial_load,
            axial_load,
            kinematic_viscosity,
            base,
            sliding_friction: None,
            supply,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn prop_bearing_torque_is_finite_and_rises_with_load(state in duties(), more in 1.01..3.0) {
        for law in BearingTorque::ALL {
            let torque = law.eval(&state);
            prop_assert!(torque.is_finite() && torque >= 0.0, "{}: {torque}", law.meta().id);
            // Palmgren's P1 falls with the radial load where the axial load rules
            let heavier = BearingDuty { radial_load: state.radial_load * more, ..state };
            let of_heavier = law.eval(&heavier);
            let rises = of_heavier >= torque * (1.0 - 1e-12);
            let palmgren_on_axial = state.axial_load > 0.0 && matches!(law.meta().id, "palmgren" | "harris");
            prop_assert!(rises || palmgren_on_axial, "{}: {torque} to {of_heavier}", law.meta().id);
        }
    }

    #[test]
    fn prop_bearing_torque_derivative(state in duties()) {
        let speed = state.speed.max(1.0);
        for law in BearingTorque::ALL {
            let slope = law.eval(&with_speed(&state, Dual64::new(speed, 1.0))).eps;
            let at = |w: f64| law.eval(&with_speed(&state, w));
            let h = 1e-5 * speed;
            let difference = (at(speed + h) - at(speed - h)) / (2.0 * h);
            // Palmgren's M0 has a kink at ν n = 2000
            let nu_n = state.kinematic_viscosity * 1e6 * speed * 30.0 / PI;
            if (nu_n - 2000.0).abs() > 1.0 {
                let scale = difference.abs() + 1e-4 * at(speed) / speed;
                prop_assert!((slope - difference).abs() <= 1e-3 * scale, "{}: {slope} {difference}", law.meta().id);
            }
        }
    }

    #[test]
    fn prop_bearing_drag_rises_with_the_level(state in duties(), level in 0.0..0.2, more in 1.0..2.0) {
        if state.speed > 0.0 && state.bearing.skf.is_some() {
            let drag = |level| {
                let state = BearingDuty { supply: Supply::Bath { level }, ..state };
                Skf::DEFAULT.parts(&state).unwrap().drag
            };
            prop_assert!(drag(level * more) >= drag(level) * 0.999);
        }
    }
}

// ---------------------------------------------------------------- windage

#[test]
fn val_windage_dawson_1984() {
    let disc = Disc { root_radius: 0.1, ..Disc::typical() };
    close("P", Windage::Dawson1984(Dawson1984::DEFAULT).eval(&disc), 2844.017, 1e-6);
    assert_eq!(Windage::named("dawson-1984").unwrap().outside(&disc).len(), 1, "0.2 m is below its range");
}

/// Windage and mist of the herringbone gearbox of Wang et al. 2020, evaluated independently.
#[test]
fn val_windage_anderson_loewenthal() {
    close("mist", windage::mist(870.0, 1.2, windage::AIR_PER_OIL), 25.846808510638297, 1e-12);
    let disc = Disc {
        speed: rpm(4920.0),
        radius: 0.13212,
        width: 0.08,
        density: 25.85,
        viscosity: 2.2879999999999997e-3,
        ..Disc::typical()
    };
    let law = Windage::AndersonLoewenthal(AndersonLoewenthal::DEFAULT);
    close("T", law.eval(&disc) / disc.speed, 2.9648290712594494, 1e-9);
    close("P with the rounded factor 2.04e-8", law.eval(&disc), 1528.7304089093676, 1e-3);
    // with the atmosphere that NASA TP-1622 builds in, printed with rounded constants
    let built_in = Disc {
        density: windage::mist(900.0, 1.2, windage::AIR_PER_OIL),
        viscosity: windage::mist(80e-3, 0.0195e-3, windage::AIR_PER_OIL),
        ..disc
    };
    close("TP-1622", law.eval(&built_in), 1562.692218576306, 0.005);
}

#[test]
fn regress_windage_diab_is_near_dawson() {
    let disc = Disc { root_radius: 0.1, ..Disc::typical() };
    let diab = Windage::Diab(Diab::DEFAULT).eval(&disc);
    let dawson = Windage::Dawson1984(Dawson1984::DEFAULT).eval(&disc);
    assert!((0.8..1.25).contains(&(diab / dawson)), "{diab} {dawson}");
    close("Diab", diab, 3315.0, 1e-3);
}

// ---------------------------------------------------------------- churning

/// Two points of the four regimes, evaluated independently.
#[test]
fn val_churning_changenet_2011() {
    let at = |n: f64| Churning::default().eval(&ImmersedGear { speed: rpm(n), ..ImmersedGear::typical() });
    close("1000 r/min", at(1000.0), 22.13245, 1e-6);
    close("7000 r/min", at(7000.0), 1077.23, 1e-6);
}

#[test]
fn churning_is_continuous() {
    let law = Changenet2011::DEFAULT;
    let jump = |state: ImmersedGear<f64>, speed: f64| {
        let at = |w: f64| churning::Law::eval(&law, &ImmersedGear { speed: w, ..state });
        (at(speed * (1.0 + 1e-9)) / at(speed * (1.0 - 1e-9)) - 1.0).abs()
    };
    let typical = ImmersedGear::typical();
    // at Re = 4000 as far as the printed digits go, in both regimes of γ
    for speed in [60.0, 500.0] {
        let state = ImmersedGear { kinematic_viscosity: speed * typical.radius * typical.width / 4000.0, ..typical };
        assert!(jump(state, speed) < 0.003, "Re, {}", jump(state, speed));
    }
    // at both ends of the interpolation in γ
    let size = (typical.radius * typical.width * typical.module).cbrt();
    for gamma in [750.0, 1250.0] {
        assert!(jump(typical, f64::sqrt(gamma / size)) < 1e-6);
    }
}

#[test]
fn regress_churning_iso_14179_1() {
    let law = Churning::named("iso-14179-1").unwrap();
    close("P", law.eval(&ImmersedGear::typical()), 37.8, 0.005);
    assert_eq!(law.eval(&ImmersedGear { immersion: -0.01, ..ImmersedGear::typical() }), 0.0);
}

// ---------------------------------------------------------------- seals, drum

#[test]
fn val_seal_iso_14179_2() {
    close("P", SealLoss::default().eval(&SealContact::typical()), 28.8375, 1e-9);
}

#[test]
fn regress_seals() {
    let iso = SealLoss::named("iso-14179-1").unwrap();
    close("FKM", iso.eval(&SealContact::typical()), 29.35124, 1e-4);
    close("NBR", iso.eval(&SealContact { material: Material::Nbr, ..SealContact::typical() }), 19.07791, 1e-4);
    close("Simrit", SealLoss::named("simrit").unwrap().eval(&SealContact::typical()), 58.0, 0.002);
}

#[test]
fn regress_rotor_drag() {
    let law = RotorDrag::default();
    close("carrier in air", law.eval(&Drum::typical()), 0.2584 + 0.3880, 1e-3);
    // the formulas of neighbouring regimes of the rim meet within 6 %
    let re = |speed: f64| speed * 1.2 * 0.15 * 0.015 / 18e-6;
    for border in [64.0, 500.0, 1e4] {
        let speed = border / re(1.0);
        let at = |w: f64| law.eval(&Drum { speed: w, ..Drum::typical() });
        close("border", at(speed * 1.000001), at(speed * 0.999999), 0.06);
    }
}

#[test]
fn nothing_is_lost_at_rest() {
    for law in Windage::ALL {
        assert_eq!(law.eval(&Disc { speed: 0.0, ..Disc::typical() }), 0.0);
    }
    for law in Churning::ALL {
        assert_eq!(law.eval(&ImmersedGear { speed: 0.0, ..ImmersedGear::typical() }), 0.0);
    }
    for law in SealLoss::ALL {
        assert_eq!(law.eval(&SealContact { speed: 0.0, ..SealContact::typical() }), 0.0);
    }
    for law in RotorDrag::ALL {
        assert_eq!(law.eval(&Drum { speed: 0.0, ..Drum::typical() }), 0.0);
    }
}

/// A derivative by dual numbers against a central difference.
#[track_caller]
fn same_slope(name: &str, dual: Dual64, at: impl Fn(f64) -> f64, x: f64) -> Result<(), TestCaseError> {
    let h = 1e-5 * x;
    let difference = (at(x + h) - at(x - h)) / (2.0 * h);
    prop_assert!(dual.re.is_finite() && dual.re >= 0.0, "{name}: {}", dual.re);
    // a regime border inside the step is seen by the difference only
    let value = at(x);
    let smooth = (at(x + h) - value) * 0.9 <= 1.1 * (value - at(x - h)) + 1e-7 * value
        && (value - at(x - h)) * 0.9 <= 1.1 * (at(x + h) - value) + 1e-7 * value;
    prop_assert!(!smooth || (dual.eps - difference).abs() <= 1e-3 * (difference.abs() + value / x));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn prop_power_is_finite_with_its_derivative(
        w in 0.1..2000.0, r in 0.02..0.6, b in 0.005..0.3, m in 1e-3..0.02, beta in 0.0..0.6,
        density in 1.0..1000.0, nu in 2e-6..1e-3, dip in -0.2..2.5, gap in 0.0..0.3,
    ) {
        let w_d = Dual64::new(w, 1.0);
        let disc = |speed| Disc {
            speed, radius: r, root_radius: 0.95 * r, width: b, module: m, teeth: 2.0 * r / m, density,
            viscosity: nu * density, axial_gaps: [gap, 0.0], enclosure: 0.7,
        };
        for law in Windage::ALL {
            let dual = law.eval(&Disc { speed: w_d, ..disc_dual(&disc(w)) });
            same_slope(law.meta().id, dual, |w| law.eval(&disc(w)), w)?;
        }
        let bath = |speed| ImmersedGear {
            speed, radius: r, tip_radius: 1.05 * r, root_radius: 0.95 * r, width: b, module: m,
            teeth: 2.0 * r / m, helix: beta, pressure_angle: 0.36, immersion: dip * r, oil_volume: 1e-3,
            kinematic_viscosity: nu, density, gravity: 9.81,
        };
        for law in Churning::ALL {
            let s = bath(w);
            let fixed = Dual64::from_re;
            let dual = law.eval(&ImmersedGear {
                speed: w_d, kinematic_viscosity: fixed(nu), density: fixed(density), radius: fixed(s.radius),
                tip_radius: fixed(s.tip_radius), root_radius: fixed(s.root_radius), width: fixed(s.width),
                module: fixed(s.module), teeth: s.teeth, helix: fixed(s.helix),
                pressure_angle: fixed(s.pressure_angle), immersion: fixed(s.immersion),
                oil_volume: fixed(s.oil_volume), gravity: fixed(s.gravity),
            });
            same_slope(law.meta().id, dual, |w| law.eval(&bath(w)), w)?;
        }
        let drum = |speed| Drum {
            speed, radius: r, length: b, radial_gap: gap, axial_gap: gap, density, viscosity: nu * density,
        };
        for law in RotorDrag::ALL {
            let s = drum(w);
            let fixed = Dual64::from_re;
            let dual = law.eval(&Drum {
                speed: w_d, radius: fixed(s.radius), length: fixed(s.length), radial_gap: fixed(s.radial_gap),
                axial_gap: fixed(s.axial_gap), density: fixed(s.density), viscosity: fixed(s.viscosity),
            });
            same_slope(law.meta().id, dual, |w| law.eval(&drum(w)), w)?;
        }
        let lip = |temperature| SealContact {
            diameter: r, speed: w, temperature, viscosity_40: nu, material: Material::Nbr,
        };
        for law in SealLoss::ALL {
            let dual = law.eval(&SealContact {
                diameter: Dual64::from(r), speed: Dual64::from(w), temperature: Dual64::new(340.0, 1.0),
                viscosity_40: Dual64::from(nu), material: Material::Nbr,
            });
            same_slope(law.meta().id, dual, |t| law.eval(&lip(t)), 340.0)?;
        }
    }
}

fn disc_dual(s: &Disc<f64>) -> Disc<Dual64> {
    Disc {
        speed: Dual64::from_re(s.speed),
        radius: Dual64::from_re(s.radius),
        root_radius: Dual64::from_re(s.root_radius),
        width: Dual64::from_re(s.width),
        module: Dual64::from_re(s.module),
        teeth: s.teeth,
        density: Dual64::from_re(s.density),
        viscosity: Dual64::from_re(s.viscosity),
        axial_gaps: s.axial_gaps.map(Dual64::from_re),
        enclosure: Dual64::from_re(s.enclosure),
    }
}

/// The row of angular contact and self-aligning bearings in SKF's table of seals, two lips:
/// 7210 with a counterface of 62.8 mm, 0.014 · 62.8² + 10 = 65 N mm.
#[test]
fn val_seals_of_angular_contact_bearings_have_their_own_row() {
    use willis::losses::bearing::Skf;
    let mut bearing = willis::catalogue::bearing::find("7210 BE-2RS1").expect("in the catalogue");
    if let Some(seal) = &mut bearing.seal {
        seal.diameter = Some(62.8e-3);
    }
    let duty = BearingDuty { bearing: bearing.data(), ..BearingDuty::typical() };
    let seals = Skf::DEFAULT.parts(&duty).expect("constants are known").seals;
    assert!((seals - 65.2e-3).abs() < 0.2e-3, "{seals}");
}

/// In an oil ring the regimes change where they do under gravity, scaled: no jump with speed.
#[test]
fn churning_in_an_oil_ring_keeps_its_regime() {
    use willis::losses::churning::{Churning, ImmersedGear};
    let at = |speed: f64| {
        // The acceleration goes with the square of the speed, as on a carrier.
        let state = ImmersedGear { speed, gravity: 0.005 * speed * speed, ..ImmersedGear::typical() };
        Churning::default().eval(&state) / speed.powi(3)
    };
    let (slow, fast) = (at(300.0), at(1200.0));
    assert!((slow / fast - 1.0).abs() < 0.5, "{slow} against {fast}");
}

// ---- Open elements, pumps, jets, plain bearings ------------------------------------------------------

/// Closed forms of an open pack with one side at rest, computed apart: critical speed, peak, six speeds by three laws.
#[test]
fn val_open_pack_by_three_laws() {
    use willis::losses::clutch_drag::{ClutchDrag, OpenPack};
    let at = |law: &str, rpm: f64| {
        let pack = OpenPack { speeds: [rpm * std::f64::consts::PI / 30.0, 0.0], ..OpenPack::typical() };
        ClutchDrag::named(law).unwrap().eval(&pack)
    };
    for (rpm, full, rivulets, radius) in [
        (100.0, 0.09015709134013983, 0.09015709134013983, 0.09015709134013983),
        (300.0, 0.27047127402041954, 0.27047127402041954, 0.27047127402041954),
        (470.0, 0.42373832929865735, 0.3931068865778369, 0.22631961007124846),
        (500.0, 0.4507854567006992, 0.3695204733831668, 0.0),
        (1000.0, 0.9015709134013984, 0.1847602366915834, 0.0),
        (3000.0, 2.7047127402041955, 0.061586745563861116, 0.0),
    ] {
        close("full film", at("full-film", rpm), full, 1e-9);
        close("rivulets", at("rivulets", rpm), rivulets, 1e-9);
        assert!((at("equivalent-radius", rpm) - radius).abs() < 1e-9, "{rpm}");
    }
    close("peak", at("rivulets", 452.6935523762163), 0.40813533950634096, 1e-9);
    // Plates that turn against each other keep their oil; those that turn together throw it out.
    let two = |a: f64, b: f64| {
        let pack = OpenPack { speeds: [a, b], ..OpenPack::typical() };
        ClutchDrag::default().eval(&pack)
    };
    assert!(two(50.0, -50.0) > 3.0 * two(200.0, 100.0));
    assert_eq!(two(70.0, 70.0), 0.0);
    // Grooves take part of the shear and drain the gap.
    let grooved = OpenPack { groove_share: 0.4, groove_depth: 0.4e-3, ..OpenPack::typical() };
    let plain = OpenPack { ..OpenPack::typical() };
    let shear = ClutchDrag::named("full-film").unwrap();
    close("grooves", shear.eval(&grooved) / shear.eval(&plain), 0.6 + 0.4 / 3.0, 1e-12);
}

/// The theory of short bearings goes over into Petroff's without load, and never beyond the friction of a dry bush.
#[test]
fn plain_bearings_go_from_petroff_to_dry_friction() {
    use willis::losses::plain_bearing::{Journal, PlainBearing};
    let law = |name: &str, s: &Journal<f64>| PlainBearing::named(name).unwrap().eval(s);
    let light = Journal { load: 1e-6, ..Journal::typical() };
    close("light", law("ocvirk", &light), law("petroff", &light), 1e-6);
    let mut last = 0.0;
    for load in [1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 1e8] {
        let s = Journal { load, ..Journal::typical() };
        let m = law("ocvirk", &s);
        assert!(
            m.is_finite() && m >= last && m <= law("boundary-friction", &s).max(4.0 * law("petroff", &s)),
            "{load} {m}"
        );
        last = m;
    }
    // The derivative by the load is that of the torque.
    let slope = |f: f64| {
        let s = |load| Journal { load, ..Journal::typical() };
        let h = 1e-4 * f;
        let numeric = (law("ocvirk", &s(f + h)) - law("ocvirk", &s(f - h))) / (2.0 * h);
        let c = num_dual::Dual64::from;
        let t = Journal::typical();
        let dual = Journal {
            speed: c(t.speed),
            diameter: c(t.diameter),
            width: c(t.width),
            clearance: c(t.clearance),
            load: num_dual::Dual64::new(f, 1.0),
            viscosity: c(t.viscosity),
            friction: c(t.friction),
        };
        (numeric, PlainBearing::default().eval(&dual).eps)
    };
    for f in [10.0, 500.0, 5000.0] {
        let (numeric, exact) = slope(f);
        assert!((numeric - exact).abs() < 1e-4 * exact.abs(), "{f}: {numeric} {exact}");
    }
}

/// Groups are read one by one; each designation leads to the first bearing of its kind, series and bore among all.
#[test]
fn every_designation_leads_to_its_row() {
    let all = bearing::all();
    for b in all {
        let like = |r: &&Bearing| (r.kind, &r.series) == (b.kind, &b.series) && r.bore == b.bore;
        let row = all.iter().find(like).unwrap();
        let found = bearing::find(&b.designation).unwrap_or_else(|| panic!("{}", b.designation));
        let numbers = |b: &Bearing| [b.bore, b.outside_diameter, b.width, b.static_rating.unwrap_or(0.0)];
        assert_eq!(
            (found.kind, numbers(&found), &found.source),
            (row.kind, numbers(row), &row.source),
            "{}",
            b.designation
        );
    }
    assert!(all.len() > 800, "{}", all.len());
}
