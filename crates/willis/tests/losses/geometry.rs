//! Geometry of gear pairs, load sharing and loss factors, against numbers of others.
//!
//! `val_…` holds the numbers of other programs or authors, within the printed digits or with the
//! reason why not; `regress_…` our own; `prop_…` what holds for every pair.

use proptest::prelude::*;
use willis::geometry::{
    Fault, Pair, PairData, Remark, SimpleSetGeometry, Tip, Wheel, conjugate_shifts, inverse_involute, involute,
    least_mesh_angle, neighbour_clearance,
};
use willis::losses::load_sharing::{self, LoadSharing, Relief, ToothLoad};
use willis::losses::loss_factor::{Integrated, LossFactor, PathOfContact};

fn addendum(coefficient: f64, alteration: f64) -> Tip {
    Tip::Addendum { coefficient, alteration }
}

fn external(teeth: f64, shift: f64, tip: Tip) -> Wheel {
    Wheel { teeth, internal: false, shift, tip, dedendum: 1.25 }
}

fn ring(teeth: f64, shift: f64, tip: Tip) -> Wheel {
    Wheel { internal: true, ..external(teeth, shift, tip) }
}

/// Spur or helical pair, mm and degrees.
fn data(m_n: f64, alpha_n: f64, beta: f64, b: f64, a: Option<f64>, wheels: [Wheel; 2]) -> PairData {
    PairData {
        module: m_n * 1e-3,
        pressure_angle: alpha_n.to_radians(),
        helix: beta.to_radians(),
        double_helical: false,
        width: b * 1e-3,
        centre_distance: a.map(|a| a * 1e-3),
        wheels,
    }
}

fn h(law: &str, pair: &Pair) -> f64 {
    LossFactor::named(law).unwrap().eval(&PathOfContact::of(pair))
}

/// Equal within half a unit of the last printed digit.
fn printed(what: &str, ours: f64, theirs: &str) {
    let value: f64 = theirs.parse().unwrap();
    let digits = theirs.split_once('.').map_or(0, |(_, d)| d.len());
    let half = 0.500_001 * 10f64.powi(-(digits as i32));
    assert!((ours - value).abs() <= half, "{what}: {ours}, printed {theirs}");
}

fn near(what: &str, ours: f64, theirs: f64, tolerance: f64) {
    assert!((ours - theirs).abs() <= tolerance, "{what}: {ours}, not {theirs}");
}

/// One pair of the public program GEARpie (C. Fernandes), run without its prompt: what it gives
/// for a geometry, with all digits that were kept.
struct Peer {
    name: &'static str,
    data: PairData,
    a: &'static str,
    angles: [&'static str; 3],
    d: [&'static str; 2],
    db: [&'static str; 2],
    dw: [&'static str; 2],
    da: [&'static str; 2],
    df: [&'static str; 2],
    p_bt: &'static str,
    e: [&'static str; 2],
    ratios: [&'static str; 2],
    g_alpha: &'static str,
    path: [&'static str; 6],
    rho: &'static str,
    h_ohlendorf: &'static str,
    h_uniform: &'static str,
    h_wimmer: f64,
    shortest: f64,
}

fn peers() -> Vec<Peer> {
    let unit = addendum(1.0, 0.0);
    let pj = |teeth| Wheel {
        dedendum: 1.487_068_965_517_239_5,
        ..external(teeth, 0.0, addendum(0.678_879_310_344_828_8, 0.0))
    };
    vec![
        Peer {
            name: "C40",
            data: data(4.5, 20.0, 0.0, 40.0, None, [external(16.0, 0.1817, unit), external(24.0, 0.1715, unit)]),
            a: "91.500079",
            angles: ["20.0", "22.43891", "0.0"],
            d: ["72.0", "108.0"],
            db: ["67.657869", "101.486803"],
            dw: ["73.200063", "109.800094"],
            da: ["82.6353", "118.5435"],
            df: ["62.3853", "98.2935"],
            p_bt: "13.284591",
            e: ["0.7341", "0.728331"],
            ratios: ["1.462431", "0.0"],
            g_alpha: "19.427797",
            path: ["4.294585", "6.143205", "9.67558", "13.284591", "19.427797", "34.925412"],
            rho: "8.382099",
            h_ohlendorf: "0.19862",
            h_uniform: "0.239293",
            h_wimmer: 0.19837,
            shortest: 1.0,
        },
        Peer {
            name: "H501",
            data: data(3.5, 20.0, 15.0, 23.0, None, [external(20.0, 0.1809, unit), external(30.0, 0.0891, unit)]),
            a: "91.500258",
            angles: ["20.646896", "22.115327", "14.076095"],
            d: ["72.469333", "108.703999"],
            db: ["67.814717", "101.722076"],
            dw: ["73.200206", "109.800309"],
            da: ["80.735633", "116.327699"],
            df: ["64.985633", "100.577699"],
            p_bt: "10.652311",
            e: ["0.762895", "0.708619"],
            ratios: ["1.471514", "0.541385"],
            g_alpha: "15.675029",
            path: ["6.230487", "5.022718", "7.548431", "10.652311", "15.675029", "34.447294"],
            rho: "8.267351",
            h_ohlendorf: "0.165353",
            h_uniform: "0.198854",
            h_wimmer: 0.188845,
            shortest: 1.05552,
        },
        Peer {
            name: "PJ40",
            data: data(2.32, 28.0, 0.0, 26.7, Some(91.5), [pj(40.0), pj(40.0)]),
            a: "91.5",
            angles: ["28.0", "26.428278", "0.0"],
            d: ["92.8", "92.8"],
            db: ["81.937537", "81.937537"],
            dw: ["91.5", "91.5"],
            da: ["95.95", "95.95"],
            df: ["85.9", "85.9"],
            p_bt: "6.435359",
            e: ["0.714941", "0.714941"],
            ratios: ["1.429883", "0.0"],
            g_alpha: "9.201808",
            path: ["15.761378", "2.766449", "4.600904", "6.435359", "9.201808", "40.724564"],
            rho: "10.181141",
            h_ohlendorf: "0.093054",
            h_uniform: "0.112303",
            h_wimmer: 0.092873,
            shortest: 1.0,
        },
        Peer {
            name: "FVA_SP",
            data: data(4.0, 20.0, 0.0, 50.0, None, [external(17.0, 0.0, unit), external(22.0, 0.0, unit)]),
            a: "78.0",
            angles: ["20.0", "20.0", "0.0"],
            d: ["68.0", "88.0"],
            db: ["63.899098", "82.692951"],
            dw: ["68.0", "88.0"],
            da: ["76.0", "96.0"],
            df: ["58.0", "78.0"],
            p_bt: "11.808526",
            e: ["0.7574", "0.790348"],
            ratios: ["1.547749", "0.0"],
            g_alpha: "18.276628",
            path: ["2.295837", "6.468103", "9.332848", "11.808526", "18.276628", "26.677571"],
            rho: "6.559771",
            h_ohlendorf: "0.213122",
            h_uniform: "0.253636",
            h_wimmer: 0.212749,
            shortest: 1.0,
        },
        Peer {
            name: "S2540",
            data: data(2.0, 20.0, 0.0, 20.0, None, [external(25.0, 0.15539, unit), external(40.0, -0.15539, unit)]),
            a: "65.0",
            angles: ["20.0", "20.0", "0.0"],
            d: ["50.0", "80.0"],
            db: ["46.984631", "75.17541"],
            dw: ["50.0", "80.0"],
            da: ["54.62156", "83.37844"],
            df: ["45.62156", "74.37844"],
            p_bt: "5.904263",
            e: ["0.910786", "0.73697"],
            ratios: ["1.647756", "0.0"],
            g_alpha: "9.728782",
            path: ["4.19924", "3.824519", "4.351263", "5.904263", "9.728782", "22.231309"],
            rho: "5.261848",
            h_ohlendorf: "0.148027",
            h_uniform: "0.170111",
            h_wimmer: 0.147747,
            shortest: 1.0,
        },
    ]
}

/// The peer drops trailing zeros of its six decimals.
fn six(what: &str, ours: f64, theirs: &str) {
    near(what, ours, theirs.parse().unwrap(), 0.500_001e-6);
}

#[test]
fn val_gearpie_geometry() {
    for peer in peers() {
        let pair = Pair::new(&peer.data).unwrap_or_else(|f| panic!("{}: {f:?}", peer.name));
        let at = |what: &str| format!("{} {what}", peer.name);
        six(&at("a"), pair.centre_distance * 1e3, peer.a);
        let angles = [pair.transverse_pressure_angle, pair.operating_pressure_angle, pair.base_helix];
        for k in 0..3 {
            six(&at("angle"), angles[k].to_degrees(), peer.angles[k]);
        }
        for k in 0..2 {
            let g = &pair.gears[k];
            six(&at("d"), g.reference_radius * 2e3, peer.d[k]);
            six(&at("db"), g.base_radius * 2e3, peer.db[k]);
            six(&at("dw"), g.operating_radius * 2e3, peer.dw[k]);
            six(&at("da"), g.tip_radius * 2e3, peer.da[k]);
            six(&at("df"), g.root_radius * 2e3, peer.df[k]);
            six(&at("e"), pair.addendum_contact_ratios[k], peer.e[k]);
        }
        six(&at("p_bt"), pair.base_pitch * 1e3, peer.p_bt);
        six(&at("eps_alpha"), pair.contact_ratio, peer.ratios[0]);
        six(&at("eps_beta"), pair.overlap_ratio, peer.ratios[1]);
        let [a, b, c, d, e] = pair.breakpoints();
        six(&at("g_alpha"), (e - a) * 1e3, peer.g_alpha);
        let ours =
            [pair.curvature_radii(a)[0], b - a, c - a, d - a, e - a, pair.curvature_radii(0.0).iter().sum::<f64>()];
        for k in 0..6 {
            six(&at("path"), ours[k] * 1e3, peer.path[k]);
        }
        // of the helical gear the peer prints the radius of the transverse section
        six(&at("rho"), pair.reduced_radius_transverse(0.0) * 1e3, peer.rho);
        near(&at("l_min/b"), pair.shortest_contact_length_ratio(), peer.shortest, 0.6e-5);
    }
}

#[test]
fn val_gearpie_loss_factors() {
    for peer in peers() {
        let pair = Pair::new(&peer.data).unwrap();
        let at = |what: &str| format!("{} {what}", peer.name);
        six(&at("H_V Ohlendorf"), h("ohlendorf", &pair), peer.h_ohlendorf);
        six(&at("H_V uniform"), h("uniform", &pair), peer.h_uniform);
        // On the grid of the peer our law of sharing gives its number. The grid has 1000 points over
        // ε_α + ε_β and is cut before E: the last step is missing, up to 0.2 % of H_V.
        let [e_1, e_2] = pair.addendum_contact_ratios;
        let step = (pair.contact_ratio + pair.overlap_ratio) / 999.0;
        let moments: Vec<f64> = (0..1000)
            .map(|k| f64::from(k) * step)
            .take_while(|x| *x < e_1 + e_2 - 1e-9)
            .map(|x| {
                // at a step of the load the peer takes the side of E
                let (contact_ratio, overlap_ratio) = (pair.contact_ratio - 1e-9, pair.overlap_ratio);
                let place = ToothLoad { position: x, contact_ratio, overlap_ratio, relief: Relief::none() };
                LoadSharing::default().eval(&place) * (x - e_2).abs()
            })
            .collect();
        let sum: f64 = moments.windows(2).map(|m| (m[0] + m[1]) / 2.0 * step).sum();
        let width_steps = if pair.overlap_ratio > 0.0 { 1e-5 } else { 0.0 };
        near(&at("H_VL on the grid"), 2.0 * pair.factor() * sum, peer.h_wimmer, 0.6e-6 + width_steps);
        near(&at("H_VL"), h("integrated", &pair), peer.h_wimmer, 2.2e-3 * peer.h_wimmer);
    }
}

/// FVA Workbench, public file of a planetary stage 17/22/61, m 4 mm: inputs of FVA, closed forms
/// recomputed independently.
#[test]
fn val_fva_planetary_stage() {
    let unit = addendum(1.0, 0.0);
    let wheel = |z| external(z, 0.0, unit);
    let sun = Pair::new(&data(4.0, 20.0, 0.0, 50.0, Some(78.0), [wheel(17.0), wheel(22.0)])).unwrap();
    let inner = Pair::new(&data(4.0, 20.0, 0.0, 50.0, Some(78.0), [wheel(22.0), ring(61.0, 0.0, unit)])).unwrap();
    printed("eps_alpha sun", sun.contact_ratio, "1.54775");
    for law in ["integrated", "two-pair", "ohlendorf"] {
        printed(law, h(law, &sun), "0.213122");
    }
    printed("eps_1", inner.addendum_contact_ratios[0], "0.79035");
    printed("eps_2", inner.addendum_contact_ratios[1], "1.16681");
    printed("eps_alpha ring", inner.contact_ratio, "1.95716");
    for law in ["integrated", "two-pair"] {
        // 0.09139995 in closed form; theirs is a numerical integral, lower by 1.6e-6 of it
        near(law, h(law, &inner), 0.0913998, 2e-7);
    }
    // not valid there, and says so
    printed("Ohlendorf", h("ohlendorf", &inner), "0.09394");
    let outside = LossFactor::named("ohlendorf").unwrap().outside(&PathOfContact::of(&inner));
    assert!(outside.iter().any(|o| o.symbol == "e_2"), "{outside:?}");
    assert!(LossFactor::default().outside(&PathOfContact::of(&inner)).is_empty());
}

/// Wang et al. 2020, herringbone 35/31/97, m_n 7 mm, helix 22°, 80 mm: geometry recomputed in
/// double precision by others.
#[test]
fn val_herringbone() {
    let unit = addendum(1.0, 0.0);
    let wheel = |z| external(z, 0.0, unit);
    let outer = PairData { double_helical: true, ..data(7.0, 20.0, 22.0, 80.0, None, [wheel(35.0), wheel(31.0)]) };
    let inner = PairData { wheels: [wheel(31.0), ring(97.0, 0.0, unit)], ..outer.clone() };
    let [outer, inner] = [outer, inner].map(|d| Pair::new(&d).unwrap());
    let mut all = vec![
        ("m_t", outer.transverse_module * 1e3, 7.549743198743084),
        ("alpha_t", outer.transverse_pressure_angle.to_degrees(), 21.432715162173178),
        ("beta_b", outer.base_helix.to_degrees(), 20.61061429628295),
        ("p_bt", outer.base_pitch * 1e3, 22.07803954310193),
        ("a", outer.centre_distance * 1e3, 249.14152555852178),
        ("a inner", inner.centre_distance * 1e3, 249.14152555852178),
        ("l_1", outer.path()[1] * 1e3, 16.756256570971736),
        ("l_2", -outer.path()[0] * 1e3, 16.53331122618149),
        ("eps_alpha", outer.contact_ratio, 1.5078135779294874),
        ("eps_beta", outer.overlap_ratio, 1.3627540813019028),
        ("eps_1", outer.addendum_contact_ratios[0], 0.7589558184393717),
        ("eps_2", outer.addendum_contact_ratios[1], 0.7488577594901157),
        ("rho_red_t", outer.reduced_radius_transverse(0.0) * 1e3, 22.676000028741708),
        ("rho_red_n", outer.reduced_radius(0.0) * 1e3, 24.22664226996586),
        ("H_V 50/50", h("two-pair", &outer), 0.12842022162689296),
        ("total width", outer.total_width(), 0.16),
        ("gap", neighbour_clearance(outer.centre_distance, 3, outer.gears[1].tip_radius) * 1e3, 183.48374138154404),
    ];
    let radii = [
        [132.12050597800396, 122.9840194472051, 139.12050597800396],
        [117.0210195805178, 108.9287029389531, 124.0210195805178],
    ];
    for k in 0..2 {
        let g = &outer.gears[k];
        let ours = [g.reference_radius, g.base_radius, g.tip_radius];
        all.extend((0..3).map(|j| ("radius", ours[j] * 1e3, radii[k][j])));
    }
    for (what, ours, theirs) in all {
        near(what, ours, theirs, 1e-11 * theirs);
    }
    // the table of the corrected sheet
    printed("l_1 ring", inner.path()[1] * 1e3, "16.533");
    printed("l_2 ring", -inner.path()[0] * 1e3, "20.552");
    printed("eps_alpha ring", inner.contact_ratio, "1.6797");
    printed("H_V 50/50 ring", h("two-pair", &inner), "0.0551");
    printed("H_V helical", h("uniform", &outer), "0.1539");
    printed("H_V helical ring", h("uniform", &inner), "0.0626");
    // "-0.6 % at eps_b = 1.363 by brute force"
    printed("brute force", 100.0 * (h("integrated", &outer) / h("uniform", &outer) - 1.0), "-0.6");
    for (planets, gap) in [(4, "104"), (5, "45"), (6, "1.1")] {
        printed("gap", neighbour_clearance(outer.centre_distance, planets, outer.gears[1].tip_radius) * 1e3, gap);
    }
}

/// Sliding and surface speeds of the same sheet: 470.234 and 530.909 rad/s relative to the carrier.
#[test]
fn val_herringbone_speeds() {
    let wheel = |z| external(z, 0.0, addendum(1.0, 0.0));
    let pair = Pair::new(&data(7.0, 20.0, 22.0, 80.0, None, [wheel(35.0), wheel(31.0)])).unwrap();
    let sum = pair.sum_speed_per_speed(-10e-3) * 470.234;
    // 530.909 is rounded; the exact speed of the planet is 470.234 · 35/31 = 530.9094
    near("v_R", sum, 46.01058831312885, 2e-4);
    let slide = pair.sliding_per_speed(-10e-3) * 470.234;
    near("v_S", slide, (470.234 + 530.909) * 10e-3, 1e-5);
}

/// UTS program 60-1161, manual: 17/24|25/67 of diametral pitch 8/in, angles and diameters of
/// changed centre distances.
#[test]
fn val_uts_60_1161() {
    let inch = 25.4;
    // The angles do not depend on the addendum. With 1 module the teeth of 17/24 would not reach
    // each other at 2.65 in: the contact ratio is 0.94.
    let tip = addendum(1.2, 0.0);
    for (planet, a, outer, inner) in
        [(25.0, 2.625, "20.0000", "20.0000"), (24.0, 2.625, "23.4628", "15.8319"), (24.0, 2.65, "24.6785", "17.638")]
    {
        let chain = SimpleSetGeometry {
            module: inch / 8.0 * 1e-3,
            pressure_angle: 20f64.to_radians(),
            helix: 0.0,
            teeth: [17.0, planet, 67.0],
            shifts: [0.0; 3],
        };
        let angles = chain.coaxial_operating_angles(a * inch * 1e-3).unwrap();
        printed("external", angles[0].to_degrees(), outer);
        printed("internal", angles[1].to_degrees(), inner);
        let m = inch / 8.0;
        let wheels = [external(17.0, 0.0, tip), external(planet, 0.0, tip)];
        let outside = Pair::new(&data(m, 20.0, 0.0, 20.0, Some(a * inch), wheels)).unwrap();
        let wheels = [external(planet, 0.0, tip), ring(67.0, 0.0, tip)];
        let inside = Pair::new(&data(m, 20.0, 0.0, 20.0, Some(a * inch), wheels)).unwrap();
        near("external", outside.operating_pressure_angle, angles[0], 1e-14);
        near("internal", inside.operating_pressure_angle, angles[1], 1e-14);
        if a == 2.65 {
            let d = |p: &Pair, k: usize| p.gears[k].operating_radius * 2e3 / inch;
            printed("ring", d(&inside, 1), "8.258");
            printed("planet with ring", d(&inside, 0), "2.958");
            printed("planet with sun", d(&outside, 1), "3.102");
            printed("sun", d(&outside, 0), "2.198");
        }
    }
    printed("least mesh angle", least_mesh_angle(17.0, 67.0).to_degrees(), "4.2857");
    // four planets of 18/68: 0, 87.907, 180, 267.907
    let steps = 87.907 / least_mesh_angle(18.0, 68.0).to_degrees();
    near("steps", steps, 21.0, 5e-4);
}

/// NREL 5 MW reference gearbox, KISSsoft 03/2017A, stage 1 planetary and stage 3 helical. KISSsoft
/// prints the shift of the ring for z < 0, x = -0.5013: here +0.5013.
#[test]
fn val_nrel_kisssoft() {
    let sun = external(19.0, 0.6170, addendum(1.0, -10.861e-3));
    let planet = external(17.0, 0.8021, addendum(1.0, -10.861e-3));
    let annulus = ring(56.0, 0.5013, addendum(1.0, 0.0));
    let outer = Pair::new(&data(45.0, 20.0, 0.0, 491.0, Some(863.0), [sun, planet.clone()])).unwrap();
    let inner = Pair::new(&data(45.0, 20.0, 0.0, 491.0, Some(863.0), [planet, annulus])).unwrap();
    // da to what a shift of four digits leaves: 45 mm · 2 · 0.00005 = 0.0045 mm
    near("da sun", outer.gears[0].tip_radius * 2e3, 978.808, 0.005);
    near("da planet", outer.gears[1].tip_radius * 2e3, 905.470, 0.005);
    near("da ring", inner.gears[1].tip_radius * 2e3, 2475.118, 0.005);
    printed("db sun", outer.gears[0].base_radius * 2e3, "803.437");
    printed("db planet", outer.gears[1].base_radius * 2e3, "718.865");
    printed("db ring", inner.gears[1].base_radius * 2e3, "2368.025");
    printed("alpha_wt", outer.operating_pressure_angle.to_degrees(), "28.118");
    printed("alpha_wt ring", inner.operating_pressure_angle.to_degrees(), "17.161");
    printed("eps_alpha", outer.contact_ratio, "1.115");
    printed("eps_alpha ring", inner.contact_ratio, "1.278");
    printed("HV", h("ohlendorf", &outer), ".181");
    printed("HV ring", h("ohlendorf", &inner), ".161");

    let helical = |z, x| external(z, x, addendum(1.0, -0.938e-3));
    let pair =
        Pair::new(&data(14.0, 20.0, 10.0, 360.0, Some(861.0), [helical(24.0, 0.48), helical(95.0, 0.6691)])).unwrap();
    printed("alpha_t", pair.transverse_pressure_angle.to_degrees(), "20.284");
    printed("da pinion", pair.gears[0].tip_radius * 2e3, "380.747");
    printed("da wheel", pair.gears[1].tip_radius * 2e3, "1395.376");
    printed("alpha_wt", pair.operating_pressure_angle.to_degrees(), "22.856");
    printed("eps_alpha", pair.contact_ratio, "1.463");
    printed("eps_beta", pair.overlap_ratio, "1.421");
    printed("HV", h("ohlendorf", &pair), ".106");
}

/// Reports of GEARpie for gears with their tips shortened, by tip radius.
#[test]
fn val_gearpie_reports() {
    let wheel = |z, x, ra: f64| external(z, x, Tip::Radius(ra * 1e-3));
    let c40 = data(4.5, 20.0, 0.0, 40.0, Some(91.5), [wheel(16.0, 0.1817, 41.318), wheel(24.0, 0.1715, 59.272)]);
    let c40 = Pair::new(&c40).unwrap();
    let h501 = data(3.5, 20.0, 15.0, 23.0, Some(91.5), [wheel(20.0, 0.1809, 40.336), wheel(30.0, 0.0891, 58.132)]);
    let h501 = Pair::new(&h501).unwrap();
    printed("eps_a C40", c40.contact_ratio, "1.46");
    printed("HV C40", h("ohlendorf", &c40), ".1986");
    printed("eps_a H501", h501.contact_ratio, "1.46");
    printed("eps_b H501", h501.overlap_ratio, ".54");
    printed("HV H501", h("ohlendorf", &h501), ".1639");
    // the grid of the peer misses a step, see `val_gearpie_loss_factors`
    near("HVL C40", h("integrated", &c40), 0.1984, 2.2e-3 * 0.1984);
    near("HVL H501", h("integrated", &h501), 0.1869, 2.2e-3 * 0.1869);
}

/// Petry-Johnson, Kahraman, Anderson, Chase 2008: 40/40, m 2.32 mm, 28°, 91.5 mm; contact ratio and
/// loss factor derived by others from the printed diameters, the base diameter among them.
#[test]
fn val_petry_johnson() {
    let wheel = Wheel { dedendum: 1.487, ..external(40.0, 0.0, Tip::Radius(95.95e-3 / 2.0)) };
    // The module 2.32 mm is rounded: it gives a base diameter of 81.94 mm where 81.89 mm is printed,
    // the base diameter from which the angle was derived.
    let module = 81.89 / (40.0 * 28f64.to_radians().cos());
    let pair = Pair::new(&data(module, 28.0, 0.0, 26.7, Some(91.5), [wheel.clone(), wheel])).unwrap();
    near("d", pair.gears[0].reference_radius * 2e3, 92.74, 0.01);
    printed("alpha_w", pair.operating_pressure_angle.to_degrees(), "26.495");
    printed("eps_alpha", pair.contact_ratio, "1.428");
    printed("H_V", h("integrated", &pair), "0.0929");
}

#[test]
fn regress_remarks() {
    let unit = addendum(1.0, 0.0);
    let c14 = data(4.5, 20.0, 0.0, 14.0, None, [external(16.0, 0.1817, unit), external(24.0, 0.1715, unit)]);
    assert_eq!(Pair::new(&c14).unwrap().remarks(), []);
    let has = |d: &PairData, f: fn(&Remark) -> bool| {
        let remarks = Pair::new(d).unwrap_or_else(|f| panic!("{f:?}")).remarks();
        assert!(remarks.iter().any(f), "{remarks:?}");
        for r in remarks {
            assert!(!r.to_string().contains("NaN"), "{r}");
        }
    };
    let spur = |wheels| data(4.0, 20.0, 0.0, 20.0, None, wheels);
    has(&spur([external(9.0, 0.0, unit), external(40.0, 0.0, unit)]), |r| {
        matches!(r, Remark::Undercut { wheel: 0, .. })
    });
    has(&spur([external(9.0, 0.0, unit), external(90.0, 0.0, unit)]), |r| {
        matches!(r, Remark::PathShortened { wheel: 1, .. })
    });
    has(&spur([external(20.0, 0.0, unit), ring(28.0, 0.0, unit)]), |r| {
        matches!(r, Remark::RingTipInsideBase { wheel: 1, .. })
    });
    has(&spur([external(40.0, 0.0, unit), ring(44.0, 0.0, unit)]), |r| matches!(r, Remark::TipInterference { .. }));
    has(&spur([external(14.0, 0.9, unit), external(40.0, 0.0, unit)]), |r| {
        matches!(r, Remark::ThinTip { wheel: 0, .. })
    });
    has(&spur([external(20.0, 0.0, addendum(0.7, 0.0)), external(40.0, 0.0, addendum(0.7, 0.0))]), |r| {
        matches!(r, Remark::LowContactRatio { .. })
    });
    has(&spur([external(20.0, 0.0, addendum(1.3, 0.0)), external(40.0, 0.0, unit)]), |r| {
        matches!(r, Remark::NoClearance { wheel: 0, .. })
    });
    has(&data(4.0, 20.0, 0.0, 20.0, Some(119.0), [external(20.0, 0.0, unit), external(40.0, 0.0, unit)]), |r| {
        matches!(r, Remark::NegativeBacklash { .. })
    });
    // The full addendum of a ring reaches below the form circle of an unshifted planet; a shorter
    // one does not.
    has(&spur([external(22.0, 0.0, unit), ring(61.0, 0.0, unit)]), |r| matches!(r, Remark::BelowForm { wheel: 1, .. }));
    let shorter = addendum(1.0, -0.9e-3);
    assert_eq!(Pair::new(&spur([external(22.0, 0.0, unit), ring(61.0, 0.0, shorter)])).unwrap().remarks(), []);
}

#[test]
fn regress_faults() {
    let unit = addendum(1.0, 0.0);
    let spur = |a, wheels| data(4.0, 20.0, 0.0, 20.0, a, wheels);
    let has = |d: &PairData, f: fn(&Fault) -> bool| {
        let faults = Pair::new(d).unwrap_err();
        assert!(faults.iter().any(f), "{faults:?}");
    };
    let w = |z| external(z, 0.0, unit);
    has(&spur(Some(100.0), [w(20.0), w(40.0)]), |f| matches!(f, Fault::CentreDistanceTooSmall { .. }));
    has(&spur(None, [external(20.0, -1.0, unit), external(40.0, -1.0, unit)]), |f| {
        matches!(f, Fault::NoOperatingAngle { .. })
    });
    has(&spur(None, [w(20.0), ring(20.0, 0.0, unit)]), |f| matches!(f, Fault::RingNotLarger { .. }));
    has(&spur(None, [ring(30.0, 0.0, unit), ring(20.0, 0.0, unit)]), |f| matches!(f, Fault::BothInternal));
    has(&spur(None, [w(20.0), external(40.0, 0.0, Tip::Radius(0.07))]), |f| {
        matches!(f, Fault::TipInsideBase { wheel: 1, .. })
    });
    has(&spur(None, [w(20.0), ring(60.0, 0.0, Tip::Radius(0.13))]), |f| matches!(f, Fault::NoHeight { wheel: 1, .. }));
    has(&spur(None, [external(14.0, 1.5, unit), w(40.0)]), |f| matches!(f, Fault::Pointed { wheel: 0, .. }));
    has(&spur(Some(129.0), [w(20.0), w(40.0)]), |f| matches!(f, Fault::NoContact { .. }));
    has(&spur(Some(123.5), [w(20.0), w(40.0)]), |f| matches!(f, Fault::Gap { .. }));
    // overlap closes the gap
    let helical = PairData {
        helix: 20f64.to_radians(),
        width: 0.1,
        ..spur(Some(123.5 / 20f64.to_radians().cos()), [w(20.0), w(40.0)])
    };
    assert!(Pair::new(&helical).unwrap().contact_ratio < 1.0);
    has(&spur(None, [external(3.0, -2.0, unit), external(40.0, 2.0, unit)]), |f| {
        matches!(f, Fault::NoRoot { wheel: 0, .. })
    });
}

#[test]
fn regress_texts() {
    let unit = addendum(1.0, 0.0);
    let d = data(4.0, 20.0, 0.0, 20.0, Some(100.0), [external(20.0, 0.0, unit), external(40.0, 0.0, unit)]);
    assert_eq!(
        Pair::new(&d).unwrap_err()[0].to_string(),
        "centre distance 100 mm: the base circles need at least 112.763 mm; enlarge the centre distance, or lower module or teeth"
    );
    let d = PairData { helix: 61f64.to_radians(), width: f64::NAN, ..d };
    let texts: Vec<_> = Pair::new(&d).unwrap_err().iter().map(ToString::to_string).collect();
    assert_eq!(
        texts,
        ["helix angle 61°: give a number from 0 to 60°", "face width NaN mm: give a number from 0.000001 to 100000 mm"]
    );
}

/// The published stiffness values of the peer come from a finite element file that is not public;
/// ours is the trapezoid.
#[test]
fn regress_stiffness_sharing() {
    let pair = Pair::new(&peers()[0].data).unwrap();
    let sharing = LoadSharing::Stiffness(load_sharing::Stiffness::DEFAULT);
    let value = LossFactor::Integrated(Integrated { sharing }).eval(&PathOfContact::of(&pair));
    assert!(value < h("integrated", &pair) && value > 0.9 * h("integrated", &pair), "{value}");
}

#[test]
fn regress_loss_factors_have_derivatives() {
    use num_dual::Dual64;
    let base = PathOfContact { e: [0.76, 1.1], overlap_ratio: 0.54, ..PathOfContact::typical() };
    for law in LossFactor::ALL {
        for k in 0..3 {
            let at = |d: f64| {
                let mut path = base;
                match k {
                    2 => path.overlap_ratio += d,
                    k => path.e[k] += d,
                }
                law.eval(&path)
            };
            let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
            let seed = |value: f64, j: usize| Dual64::new(value, f64::from(u8::from(j == k)));
            let path = PathOfContact {
                teeth: base.teeth,
                internal: base.internal,
                base_helix: Dual64::from(base.base_helix),
                operating_helix: Dual64::from(base.operating_helix),
                e: [seed(0.76, 0), seed(1.1, 1)],
                overlap_ratio: seed(0.54, 2),
                relief: Relief::none(),
            };
            let dual = law.eval(&path);
            assert_eq!(dual.re, at(0.0));
            near(law.meta().id, dual.eps, difference, 1e-7);
        }
    }
}

/// FZG type C gears, 16/24 teeth of 4.5 mm.
fn type_c() -> Pair {
    let tip = addendum(1.0, 0.0);
    Pair::new(&data(4.5, 20.0, 0.0, 14.0, Some(91.5), [external(16.0, 0.1817, tip), external(24.0, 0.1715, tip)]))
        .unwrap()
}

/// Arana, Larranaga and Ulacia 2019 print a local loss factor of 0.1680 for type C gears with 35 um of relief at 183 N m.
/// The length is not known to us: here the relief reaches down to single contact, as is usual for that much. Their load
/// distribution knows how teeth bend; ours is that of equal springs: 5 %.
#[test]
fn val_arana_2019_tip_relief_of_type_c_gears() {
    let pair = type_c();
    let force = 183.0 / pair.gears[0].base_radius;
    let depth = 35e-6 * pair.pair_stiffness(206e9) * pair.total_width() / force;
    near("depth", depth, 1.114, 1e-3);
    let relief = Relief { depth: [depth; 2], length: [pair.contact_ratio - 1.0; 2] };
    let path = PathOfContact { relief, ..PathOfContact::of(&pair) };
    let ours = LossFactor::default().eval(&path);
    near("H_VL", ours, 0.1680, 0.05 * 0.1680);
    near("H_VL without relief", h("integrated", &pair), 0.1986, 5e-4);
}

/// From no relief, bit for bit, to single contact all the way: 2 K integrated over one base pitch.
#[test]
fn regress_limits_of_tip_relief() {
    let path = PathOfContact::of(&type_c());
    let law = LossFactor::default();
    for relief in [
        Relief { depth: [0.0; 2], length: [0.4; 2] },
        Relief { depth: [1.0; 2], length: [0.0; 2] },
        Relief { depth: [1e-300; 2], length: [0.4; 2] },
    ] {
        let with = law.eval(&PathOfContact { relief, ..path });
        if relief.any() {
            near("the least relief", with, law.eval(&path), 1e-12);
        } else {
            assert_eq!(with.to_bits(), law.eval(&path).to_bits());
        }
    }
    let long = path.contact_ratio() - 1.0;
    let relief = Relief { depth: [1e6; 2], length: [long; 2] };
    let [from, to] = [path.e[1] - long / 2.0, 1.0 + long / 2.0 - path.e[1]];
    let single = path.factor() * (from * from + to * to);
    near("single contact", law.eval(&PathOfContact { relief, ..path }), single, 1e-5 * single);
    // the load is handed over linearly at a depth of 1
    let linear = long * path.contact_ratio() / 2.0 - 2.0 * long * long / 3.0
        + ((path.e[1] - long).powi(2) + (1.0 - path.e[1]).powi(2)) / 2.0;
    let relief = Relief { depth: [1.0; 2], length: [long; 2] };
    near("linear", law.eval(&PathOfContact { relief, ..path }), 2.0 * path.factor() * linear, 1e-12);
    let mut last = law.eval(&path);
    for depth in 1..40 {
        let relief = Relief { depth: [f64::from(depth) * 0.1; 2], length: [long; 2] };
        let own = law.eval(&PathOfContact { relief, ..path });
        assert!(own < last && own > single, "{depth}: {own}");
        last = own;
    }
}

#[test]
fn regress_tip_relief_has_derivatives() {
    use num_dual::Dual64;
    let path = PathOfContact::typical();
    for sharing in [LoadSharing::default(), LoadSharing::Stiffness(load_sharing::Stiffness::DEFAULT)] {
        let law = LossFactor::Integrated(Integrated { sharing });
        for k in 0..4 {
            let numbers = [0.7, 1.3, 0.41, 0.52];
            let at = |d: f64| {
                let mut n = numbers;
                n[k] += d;
                law.eval(&PathOfContact { relief: Relief { depth: [n[0], n[1]], length: [n[2], n[3]] }, ..path })
            };
            let n: Vec<Dual64> = (0..4).map(|j| Dual64::new(numbers[j], f64::from(u8::from(j == k)))).collect();
            let dual = law.eval(&PathOfContact {
                teeth: path.teeth,
                internal: path.internal,
                base_helix: Dual64::from(path.base_helix),
                operating_helix: Dual64::from(path.operating_helix),
                e: path.e.map(Dual64::from),
                overlap_ratio: Dual64::from(path.overlap_ratio),
                relief: Relief { depth: [n[0], n[1]], length: [n[2], n[3]] },
            });
            near("value", dual.re, at(0.0), 1e-15);
            near("slope", dual.eps, (at(1e-5) - at(-1e-5)) / 2e-5, 2e-5);
        }
    }
}

fn any_wheel() -> impl Strategy<Value = Wheel> {
    let tip = prop_oneof![
        (0.8f64..1.2, -0.2e-3f64..0.1e-3)
            .prop_map(|(coefficient, alteration)| Tip::Addendum { coefficient, alteration }),
        (0.001f64..0.4).prop_map(Tip::Radius),
    ];
    (5.0f64..120.0, any::<bool>(), -0.8f64..1.0, tip, 0.9f64..1.5)
        .prop_map(|(z, internal, shift, tip, dedendum)| Wheel { teeth: z.round(), internal, shift, tip, dedendum })
}

/// Pairs that nearly all exist.
fn good() -> impl Strategy<Value = PairData> {
    let wheel = |z: std::ops::Range<i32>| {
        (z, -0.2f64..0.5, 0.8f64..1.0).prop_map(|(z, x, c)| external(f64::from(z), x, addendum(c, 0.0)))
    };
    (wheel(17..40), wheel(17..60), 20i32..80, any::<bool>(), 0.5f64..10.0, 15.0f64..25.0, 0.0f64..30.0, 1.0f64..20.0)
        .prop_map(|(first, mut second, more, internal, m, alpha, beta, widths)| {
            if internal {
                second.teeth = first.teeth + f64::from(more);
                second.internal = true;
                second.shift = first.shift;
            }
            data(m, alpha, beta, widths * m, None, [first, second])
        })
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -10.0f64..200.0,
        1 => any::<f64>(),
        1 => prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e-300, 1e300, 1.0]),
    ]
}

fn finite(pair: &Pair) {
    let mut all = vec![
        pair.transverse_module,
        pair.transverse_pressure_angle,
        pair.base_helix,
        pair.operating_pressure_angle,
        pair.operating_helix,
        pair.centre_distance,
        pair.base_pitch,
        pair.backlash,
        pair.contact_ratio,
        pair.overlap_ratio,
        pair.factor(),
        pair.total_width(),
        pair.shortest_contact_length_ratio(),
    ];
    all.extend(pair.addendum_contact_ratios);
    all.extend(pair.breakpoints());
    for g in &pair.gears {
        all.extend([
            g.reference_radius,
            g.base_radius,
            g.operating_radius,
            g.tip_radius,
            g.root_radius,
            g.tip_thickness,
        ]);
    }
    for s in pair.breakpoints() {
        all.extend(pair.curvature_radii(s));
        all.extend([pair.sliding_per_speed(s), pair.sum_speed_per_speed(s)]);
    }
    let path = PathOfContact::of(pair);
    all.extend(LossFactor::ALL.iter().map(|l| l.eval(&path)));
    assert!(all.iter().all(|x| x.is_finite()), "{pair:?}\n{all:?}");
    assert!(pair.contact_ratio > 0.0);
    for text in pair.remarks() {
        assert!(!text.to_string().contains("NaN"), "{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn prop_bad_input_neither_panics_nor_gives_nan(
        scalars in prop::array::uniform5(any_number()), given in any::<bool>(), double in any::<bool>(),
        numbers in prop::array::uniform8(any_number()), internal in any::<[bool; 2]>(), by_radius in any::<[bool; 2]>(),
    ) {
        let wheel = |k: usize| {
            let n = &numbers[4 * k..];
            let tip = if by_radius[k] { Tip::Radius(n[2]) } else { addendum(n[2], n[3]) };
            Wheel { teeth: n[0], internal: internal[k], shift: n[1], tip, dedendum: n[2] }
        };
        let [module, pressure_angle, helix, width, a] = scalars;
        let data = PairData {
            module, pressure_angle, helix, double_helical: double, width, centre_distance: given.then_some(a), wheels: [wheel(0), wheel(1)],
        };
        let _ = conjugate_shifts(&data);
        match Pair::new(&data) {
            Ok(pair) => finite(&pair),
            Err(faults) => {
                prop_assert!(!faults.is_empty());
                for f in faults { let _ = f.to_string(); }
            }
        }
    }

    #[test]
    fn prop_plausible_input_neither_panics_nor_gives_nan(
        m in 0.0005f64..0.01, alpha in 0.08f64..0.8, beta in prop_oneof![Just(0.0), 0.0f64..1.1], b in 0.0f64..0.2,
        a in prop::option::of(0.0f64..0.6), wheels in prop::array::uniform2(any_wheel()),
    ) {
        let data = PairData {
            module: m, pressure_angle: alpha, helix: beta, double_helical: false, width: b, centre_distance: a, wheels,
        };
        match Pair::new(&data) {
            Ok(pair) => finite(&pair),
            Err(faults) => for f in faults { prop_assert!(!f.to_string().contains("NaN"), "{f}") },
        }
    }

    #[test]
    fn prop_path_and_motion(data in good()) {
        let Ok(pair) = Pair::new(&data) else { return Ok(()) };
        finite(&pair);
        let [start, end] = pair.path();
        let [e_1, e_2] = pair.addendum_contact_ratios;
        prop_assert!((e_1 + e_2 - (end - start) / pair.base_pitch).abs() < 1e-12);
        prop_assert_eq!(pair.sliding_per_speed(0.0), 0.0);
        // the ends of the path lie on the tip circles
        for (k, s) in [(0, end), (1, start)] {
            let shortened = pair.remarks().iter().any(|r| matches!(r, Remark::PathShortened { wheel, .. } if *wheel == k));
            let g = &pair.gears[k];
            let radius = pair.curvature_radii(s)[k].hypot(g.base_radius);
            prop_assert!(shortened || (radius - g.tip_radius).abs() < 1e-12, "{} {}", radius, g.tip_radius);
        }
        for s in [start, end, start / 3.0, end / 3.0] {
            let [r_1, r_2] = pair.curvature_radii(s);
            prop_assert!(r_1 >= -1e-12 && r_2 >= -1e-12);
            // surface speeds per speed of wheel 0
            let u = data.wheels[0].teeth / data.wheels[1].teeth;
            prop_assert!((pair.sliding_per_speed(s) - (r_1 - u * r_2).abs()).abs() < 1e-12);
            prop_assert!((pair.sum_speed_per_speed(s) - (r_1 + u * r_2)).abs() < 1e-12);
        }
        prop_assert!((pair.position(start)).abs() < 1e-12);
        let shifts = conjugate_shifts(&PairData { centre_distance: Some(pair.centre_distance), ..data.clone() }).unwrap();
        prop_assert!((shifts[1] - data.wheels[1].shift).abs() < 1e-9, "{:?}", shifts);
        let given = Pair::new(&PairData { centre_distance: Some(pair.centre_distance), ..data }).unwrap();
        prop_assert!(given.backlash.abs() < 1e-12);
    }

    #[test]
    fn prop_loss_factors(data in good()) {
        let Ok(pair) = Pair::new(&data) else { return Ok(()) };
        let path = PathOfContact::of(&pair);
        for law in LossFactor::ALL {
            let value = law.eval(&path);
            prop_assert!(value >= 0.0 || law.meta().id == "ohlendorf", "{} {value}", law.meta().id);
        }
        // exchanging the wheels changes nothing
        let mut exchanged = data.clone();
        exchanged.wheels.reverse();
        let exchanged = PathOfContact::of(&Pair::new(&exchanged).unwrap());
        for law in LossFactor::ALL {
            prop_assert!((law.eval(&path) - law.eval(&exchanged)).abs() < 1e-12, "{}", law.meta().id);
        }
        // helix 0: the integral is the closed form
        let spur = Pair::new(&PairData { helix: 0.0, ..data.clone() });
        if let Ok(spur) = spur && (1.0..=2.0).contains(&spur.contact_ratio) {
            prop_assert!((h("integrated", &spur) - h("two-pair", &spur)).abs() < 1e-12);
            // continuous towards it
            let nearly = Pair::new(&PairData { helix: 1e-7, ..data.clone() }).unwrap();
            prop_assert!((h("integrated", &nearly) - h("integrated", &spur)).abs() < 1e-6);
        }
        // a whole overlap ratio: uniform
        let whole = PathOfContact { overlap_ratio: 2.0, ..path };
        prop_assert!((LossFactor::default().eval(&whole) - h("uniform", &pair)).abs() < 1e-12);
        // between them it agrees with the sharing `uniform`, integrated
        let sharing = LoadSharing::Uniform(load_sharing::Uniform::DEFAULT);
        let uniform = LossFactor::Integrated(Integrated { sharing }).eval(&path);
        prop_assert!((uniform - h("uniform", &pair)).abs() < 1e-12);
    }

    #[test]
    fn prop_shares_carry_the_load(e_a in 1.0f64..3.0, x in 0.0f64..1.0, e_b in prop_oneof![Just(0.0), 0.0f64..3.0]) {
        for law in LoadSharing::ALL {
            let share = |position| law.eval(&ToothLoad {
                position, contact_ratio: e_a, overlap_ratio: e_b, relief: Relief::none(),
            });
            // the pairs in contact at one phase carry the whole load, where sections are apart
            let sum: f64 = (0..4).map(|k| share(x + f64::from(k))).sum();
            match law {
                LoadSharing::Stiffness(_) => prop_assert!((sum - 1.0).abs() < 1e-12, "{sum}"),
                LoadSharing::Equal(_) if e_b == 0.0 => prop_assert!((sum - 1.0).abs() < 1e-12, "{sum}"),
                _ => {}
            }
            // on average over the mesh they all do
            let n = 4000;
            let mean = (0..n).map(|k| share(e_a * (f64::from(k) + 0.5) / f64::from(n))).sum::<f64>() * e_a / f64::from(n);
            prop_assert!((mean - 1.0).abs() < 2e-3, "{} {mean}", law.meta().id);
            prop_assert!(share(-0.01) == 0.0 && share(e_a + 0.01) == 0.0);
        }
    }

    #[test]
    fn prop_relieved_pairs_carry_the_load(
        e_a in 1.0f64..3.0,
        x in 0.0f64..1.0,
        depth in [0.0f64..5.0, 0.0f64..5.0],
        length in [0.0f64..1.5, 0.0f64..1.5],
    ) {
        let relief = Relief { depth, length };
        for law in [LoadSharing::default(), LoadSharing::Stiffness(load_sharing::Stiffness::DEFAULT)] {
            let share = |position| {
                law.eval(&ToothLoad { position, contact_ratio: e_a, overlap_ratio: 0.0, relief })
            };
            let all: Vec<f64> = (0..4).map(|k| share(x + f64::from(k))).collect();
            prop_assert!((all.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{all:?}");
            prop_assert!(all.iter().all(|s| (0.0..=1.0 + 1e-12).contains(s)), "{all:?}");
            // the integral is the sum over a fine grid
            let path = PathOfContact { e: [e_a * 0.4, e_a * 0.6], relief, ..PathOfContact::typical() };
            let n = 4000;
            let place = |k: i32| e_a * (f64::from(k) + 0.5) / f64::from(n);
            let sum: f64 = (0..n).map(|k| share(place(k)) * (place(k) - e_a * 0.6).abs()).sum();
            let grid = 2.0 * path.factor() * sum * e_a / f64::from(n);
            let own = LossFactor::Integrated(Integrated { sharing: law }).eval(&path);
            prop_assert!((own - grid).abs() < 1e-3 * grid, "{own} {grid}");
        }
    }

    #[test]
    fn prop_involute_round_trip(angle in 0.01f64..1.5) {
        let back = inverse_involute(involute(angle)).unwrap();
        prop_assert!((back - angle).abs() < 1e-12 / angle, "{back} {angle}");
    }

    #[test]
    fn prop_coaxial(z_s in 15i32..60, z_p in 15i32..60, more in -2i32..3, x_s in -0.2f64..0.5, x_p in -0.2f64..0.5) {
        let teeth = [z_s, z_p, z_s + 2 * z_p + more].map(f64::from);
        let mut chain = SimpleSetGeometry { module: 2e-3, pressure_angle: 20f64.to_radians(), helix: 0.3, teeth, shifts: [x_s, x_p, 0.0] };
        if let Some(x_r) = chain.coaxial_ring_shift() {
            chain.shifts[2] = x_r;
            let [outer, inner] = chain.centre_distances().unwrap();
            prop_assert!((outer - inner).abs() < 1e-12, "{outer} {inner}");
        }
    }
}
