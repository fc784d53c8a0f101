//! Numbers of an independent program (rational arithmetic, sign changes closed to neighbouring numbers, Runge-Kutta)
//! for functions that are stated with each.

use std::f64::consts::PI;

use willis::heat::{
    Bounds, Certificate, HeatVerdict, Limits, Method, Segment, Source, balance, duty, time_constants, warm_up,
};
use willis::train::Train;
use willis::train::heat::Heat;

const ZERO: f64 = 273.15;

fn heat(keys: &str) -> Heat {
    let text = format!(
        r#"
        format = 1
        name = "case"
        members = ["a", "b"]
        terminals = ["a", "b"]
        mesh = [{{ gears = [{{ member = "a", teeth = 20 }}, {{ member = "b", teeth = 30 }}], efficiency = 0.99 }}]
        [oil]
        viscosity_40 = "100 mm^2/s"
        viscosity_100 = "11 mm^2/s"
        density_15 = "880 kg/m^3"
        temperature = "60 degC"
        [heat]
        {keys}
        "#
    );
    Train::from_toml(&text).unwrap_or_else(|e| panic!("{e}")).heat().unwrap().clone()
}

fn close(is: f64, wanted: f64, relative: f64, what: &str) {
    assert!((is - wanted).abs() <= relative * wanted.abs(), "{what}: {is:.15} and not {wanted:.15}");
}

/// Viscosities in mm²/s and mPa s.
fn oil(celsius: f64) -> (f64, f64) {
    let train = Train::from_toml(
        "format = 1\nname = 'x'\nmembers = ['a', 'b']\nmesh = [{ gears = [{ member = 'a', teeth = 20 }, \
         { member = 'b', teeth = 30 }], efficiency = 0.99 }]\n[oil]\nviscosity_40 = '100 mm^2/s'\n\
         viscosity_100 = '11 mm^2/s'\ndensity_15 = '880 kg/m^3'\ntemperature = '60 degC'\n",
    )
    .unwrap();
    let oil = &train.lubrication().unwrap().oil;
    (oil.kinematic_viscosity(celsius + ZERO) * 1e6, oil.dynamic_viscosity(celsius + ZERO) * 1e3)
}

/// The stage of the cases: tooth friction, planet bearings by Palmgren, seals, W, at a part of the load.
struct Stage {
    oil: willis::catalogue::oil::Oil,
    load: f64,
}

impl Stage {
    fn at(load: f64) -> Self {
        use willis::catalogue::oil::{Base, Oil};
        Self { oil: Oil::from_two_points("case", Base::Mineral, 100e-6, 11e-6, 880.0), load }
    }

    fn losses(&self, kelvin: f64) -> [f64; 3] {
        let nu = self.oil.kinematic_viscosity(kelvin) * 1e6;
        let eta = self.oil.dynamic_viscosity(kelvin) * 1e3;
        let mesh = self.load * 4052.0 * eta.powf(-0.05);
        let (n, d, f0, f1, force) = (906.469, 46.0f64, 2.0, 3e-4, 15389.0);
        let idle = match nu * n >= 2000.0 {
            true => 1e-7 * f0 * (nu * n).powf(2.0 / 3.0) * d.powi(3),
            false => 160e-7 * f0 * d.powi(3),
        };
        let bearings = 6.0 * (idle + self.load * f1 * force * d) * 1e-3 * n * PI / 30.0;
        [mesh, bearings, 53.98]
    }
}

type Never = std::convert::Infallible;

#[test]
fn val_oil_slope() {
    for (celsius, nu, eta) in [
        (20.0, 344.4091452683517, 302.2011156974247),
        (40.0, 99.99999999999979, 86.7239999999998),
        (80.0, 19.322464019508043, 16.36272627085588),
        (120.0, 6.987361674100208, 5.774411586369804),
    ] {
        close(oil(celsius).0, nu, 1e-10, "kinematic");
        close(oil(celsius).1, eta, 1e-10, "dynamic");
    }
    // β = −d ln η/dT
    let oil = &Stage::at(1.0).oil;
    for (celsius, beta) in [
        (20.0, 0.07222194455362989),
        (40.0, 0.05378042958291001),
        (80.0, 0.03214019618822949),
        (120.0, 0.021087310825496804),
    ] {
        use num_dual_of::slope;
        close(-slope(oil, celsius + ZERO), beta, 1e-10, "slope");
    }
}

/// Slope of the logarithm of the viscosity, with dual numbers.
mod num_dual_of {
    pub fn slope(oil: &willis::catalogue::oil::Oil, kelvin: f64) -> f64 {
        // Five points: the laws of the oil are smooth.
        let h = 0.05;
        let ln = |t: f64| oil.dynamic_viscosity(t).ln();
        let t = kelvin;
        let one = |h: f64| (8.0 * (ln(t + h) - ln(t - h)) - (ln(t + 2.0 * h) - ln(t - 2.0 * h))) / (12.0 * h);
        (16.0 * one(h) - one(2.0 * h)) / 15.0
    }
}

#[test]
fn val_loss_of_temperature() {
    for (celsius, total, mesh, bearings) in [
        (0.0, 3129.5474784314597, 2797.469455838338, 278.0980225931214),
        (40.0, 3438.9310528909264, 3241.622750308616, 143.32830258231024),
        (80.0, 3705.9317731651313, 3523.519289852729, 128.43248331240216),
        (120.0, 3890.6112229389337, 3711.881044896985, 124.75017804194873),
    ] {
        let [m, b, s] = Stage::at(1.0).losses(celsius + ZERO);
        close(m, mesh, 1e-10, "mesh");
        close(b, bearings, 1e-10, "bearings");
        close(m + b + s, total, 1e-10, "total");
    }
}

#[test]
fn val_one_node_constant() {
    let heat = heat("ambient = '20 degC'\nconductance = '45 W/K'\nlimit = '150 degC'");
    let all = balance(&heat, &|_: f64| Ok::<_, Never>(vec![3600.0, 0.0]), at_most(&heat, 0.0)).unwrap();
    assert_eq!(all.verdict, HeatVerdict::Unique);
    close(all.equilibria[0].at.oil, 100.0 + ZERO, 1e-14, "oil");
}

fn at_most(heat: &Heat, tolerance: f64) -> Limits {
    Limits { highest: heat.limit, tolerance }
}

#[test]
fn val_stage_with_cooler() {
    let heat = heat(
        "ambient = '20 degC'\narea = '0.62 m^2'\ncoefficient = '15 W/(m^2 K)'\n\
         cooler = { flow = '6 l/min', effectiveness = 0.55, inlet = '30 degC' }",
    );
    let stage = Stage::at(1.0);
    let source = |t: f64| Ok::<_, Never>(vec![stage.losses(t).iter().sum(), 0.0]);
    let all = balance(&heat, &source, at_most(&heat, 0.0)).unwrap();
    assert_eq!(all.verdict, HeatVerdict::Unique);
    let at = &all.equilibria[0];
    let celsius = at.at.oil - ZERO;
    close(celsius, 64.90516730451523, 1e-9, "oil");
    let [mesh, bearings, _] = stage.losses(at.at.oil);
    close(at.at.made[0], 3616.612804111709, 1e-9, "loss");
    close(mesh, 3431.083341955948, 1e-9, "mesh");
    close(bearings, 131.5494621557608, 1e-9, "bearings");
    close(heat.flow(0, at.at.oil, heat.ambient()), 417.6180559319917, 1e-9, "housing");
    close(heat.cooled(at.at.oil), 3198.9947481797185, 1e-9, "cooler");
}

/// Oil and housing with convection and radiation.
fn light() -> Heat {
    heat(
        "ambient = '20 degC'\narea = '0.62 m^2'\nheight = '0.32 m'\nemissivity = 0.9\noil_area = '0.40 m^2'\n\
         oil_coefficient = '200 W/(m^2 K)'\nheat_capacity = '18 kJ/K'\nhousing_heat_capacity = '42 kJ/K'",
    )
}

#[test]
fn val_two_node_light() {
    let (heat, stage) = (light(), Stage::at(0.05));
    let source = |t: f64| Ok::<_, Never>(vec![stage.losses(t).iter().sum(), 0.0, 0.0]);
    let all = balance(&heat, &source, at_most(&heat, 0.0)).unwrap();
    assert_eq!(all.verdict, HeatVerdict::Unique);
    let at = &all.equilibria[0].at;
    close(at.oil - ZERO, 48.25225165936507, 1e-8, "oil");
    close(at.temperatures[2] - ZERO, 45.2208070035159, 1e-8, "housing");
    close(at.made[0], 242.51557246793396, 1e-8, "loss");
    let rise = at.temperatures[2] - heat.ambient();
    let outer = heat.flow(1, at.temperatures[2], heat.ambient()) / (0.62 * rise);
    close(outer, 15.509184503386454, 1e-8, "outer coefficient");
}

#[test]
fn val_five_node() {
    let heat = heat(
        r#"
        ambient = "20 degC"
        limit = "150 degC"
        node = [{ name = "sun" }, { name = "planets" }, { name = "ring" }, { name = "housing" },
                { name = "coolant", temperature = "30 degC" }]
        path = [
            { between = ["oil", "sun"], conductance = "22 W/K" },
            { between = ["oil", "planets"], conductance = "55 W/K" },
            { between = ["oil", "ring"], conductance = "70 W/K" },
            { between = ["oil", "housing"], conductance = "80 W/K" },
            { between = ["ring", "housing"], conductance = "120 W/K" },
            { between = ["sun", "planets"], conductance = "3 W/K" },
            { between = ["planets", "ring"], conductance = "4 W/K" },
            { between = ["housing", "ambient"], conductance = "26 W/K" },
            { between = ["oil", "coolant"], conductance = "85 W/K" },
        ]
        "#,
    );
    let stage = Stage::at(1.0);
    let source = |t: f64| {
        let [mesh, bearings, seals] = stage.losses(t);
        let (sun, ring) = (mesh * 72.0 / 95.0, mesh * 23.0 / 95.0);
        Ok::<_, Never>(vec![0.0, 0.0, sun / 2.0, (sun + ring) / 2.0 + bearings, ring / 2.0, seals, 0.0])
    };
    let all = balance(&heat, &source, at_most(&heat, 0.0)).unwrap();
    assert_eq!(all.verdict, HeatVerdict::Unique);
    let at = &all.equilibria[0].at;
    for (place, celsius) in [
        (0, 61.06355522137525),
        (2, 116.55253605909749),
        (3, 93.3504342801957),
        (4, 61.08745652888061),
        (5, 56.590969916706605),
    ] {
        close(at.temperatures[place] - ZERO, celsius, 1e-8, &heat.nodes[place].name);
    }
    let line = heat.at(at.oil, &at.made).unwrap();
    close(line.slope, 402047395.0 / 3773567.0, 1e-12, "Schur complement");
    for (place, share) in [(2, 3770447.0), (3, 3747567.0), (4, 3372907.0), (5, 3126700.0)] {
        close(line.shares[place], share / 3773567.0, 1e-12, "share");
    }
}

/// Three equilibria, with bounds of each of its parts.
struct Three;

impl Three {
    fn rising(t: f64) -> f64 {
        5200.0 / (1.0 + (-(t - 105.0) / 6.0).exp())
    }
    fn falling(t: f64) -> f64 {
        700.0 * (-(t - 20.0) / 25.0).exp()
    }
}

impl Source for Three {
    type Error = Never;
    fn heat(&self, oil: f64) -> Result<Vec<f64>, Never> {
        let t = oil - ZERO;
        Ok(vec![900.0 + Self::rising(t) + Self::falling(t), 0.0])
    }
    fn bounds(&self, from: f64, to: f64) -> Option<Vec<Bounds>> {
        let (a, b) = (from - ZERO, to - ZERO);
        // A logistic curve is steepest in its middle; on either side its slope is monotone.
        let steep = |t: f64| Self::rising(t) * (1.0 - Self::rising(t) / 5200.0) / 6.0;
        let most = if (a..=b).contains(&105.0) { steep(105.0) } else { steep(a).max(steep(b)) };
        let least = steep(a).min(steep(b));
        let flat = |t: f64| -Self::falling(t) / 25.0;
        let oil = Bounds {
            heat: [900.0 + Self::rising(a) + Self::falling(b), 900.0 + Self::rising(b) + Self::falling(a)],
            slope: [least + flat(a), most + flat(b)],
        };
        Some(vec![oil, Bounds { heat: [0.0; 2], slope: [0.0; 2] }])
    }
}

#[test]
fn val_several_equilibria() {
    let heat = heat("ambient = '20 degC'\nconductance = '44 W/K'\nlimit = '300 degC'");
    let sampled = |t: f64| Three.heat(t);
    let proved = balance(&heat, &Three, at_most(&heat, 0.0)).unwrap();
    let found = balance(&heat, &sampled, at_most(&heat, 0.0)).unwrap();
    assert!(matches!(proved.certificate, Certificate { proved: true, method: Method::BranchAndBound, .. }));
    assert!(!found.certificate.proved);
    for all in [proved, found] {
        assert_eq!(all.verdict, HeatVerdict::Several);
        let wanted = [(46.06867392937333, true), (106.26723647766946, false), (158.68300143940849, true)];
        assert_eq!(all.equilibria.len(), wanted.len());
        for (e, (celsius, stable)) in all.equilibria.iter().zip(wanted) {
            close(e.at.oil - ZERO, celsius, 1e-9, "equilibrium");
            assert_eq!(e.is_stable(), stable, "at {celsius}");
        }
        close(all.from(20.0 + ZERO).unwrap().at.oil - ZERO, 46.06867392937333, 1e-9, "cold");
        close(all.from(150.0 + ZERO).unwrap().at.oil - ZERO, 158.68300143940849, 1e-9, "hot");
    }
}

#[test]
fn val_warm_up_linear() {
    let heat = heat("ambient = '20 degC'\nconductance = '45 W/K'\nheat_capacity = '60 kJ/K'");
    let source = |t: f64| Ok::<_, Never>(vec![3600.0 - 15.0 * (t - ZERO - 40.0), 0.0]);
    let start = [20.0 + ZERO; 2];
    let run = warm_up(&heat, &source, &start, &[0.0, 300.0, 900.0, 3600.0], 1e-14).unwrap();
    for (row, celsius) in run.rows[1..].iter().zip([36.84681565568834, 58.57297211686106, 83.22395804092598]) {
        close(row.temperatures[0] - ZERO, celsius, 1e-12, "oil");
    }
    assert!(run.audit() < 1e-9, "{}", run.audit());
    // τ = C/(UA − P′)
    close(time_constants(&heat, &start, &[-15.0, 0.0])[0], 60000.0 / 60.0, 1e-12, "time constant");
}

#[test]
fn val_warm_up_stage() {
    let (heat, stage) = (light(), Stage::at(0.15));
    let source = |t: f64| Ok::<_, Never>(vec![stage.losses(t).iter().sum(), 0.0, 0.0]);
    let times = [0.0, 300.0, 900.0, 1800.0, 3600.0, 10800.0];
    let run = warm_up(&heat, &source, &[20.0 + ZERO; 3], &times, 1e-10).unwrap();
    for (row, (oil, housing)) in run.rows[1..].iter().zip([
        (25.897316982636283, 21.57891131824094),
        (31.988044408552422, 26.807155044637888),
        (39.609734100280065, 34.13264898238578),
        (51.93039460159599, 45.89055089430278),
        (74.22321913784104, 66.96648133532906),
    ]) {
        close(row.temperatures[0] - ZERO, oil, 1e-5, "oil");
        close(row.temperatures[2] - ZERO, housing, 1e-5, "housing");
    }
    assert!(run.audit() < 1e-9, "{}", run.audit());
}

#[test]
fn val_duty_cycle() {
    let heat = heat("ambient = '20 degC'\nconductance = '45 W/K'\nheat_capacity = '60 kJ/K'");
    let loss = |w: f64| move |_: f64| Ok::<_, Never>(vec![w, 0.0]);
    let (on, off) = (loss(5000.0), loss(0.0));
    let segments = [Segment { duration: 600.0, source: &on }, Segment { duration: 900.0, source: &off }];
    let all = duty(&heat, &segments, 1e-14).unwrap();
    close(all.highest - 20.0 - ZERO, 59.618991352791845, 1e-12, "highest");
    close(all.lowest - 20.0 - ZERO, 30.35539223741992, 1e-12, "lowest");
    close(all.mean - 20.0 - ZERO, 44.44444444444444, 1e-12, "mean");
}

/// A step of a law under the balance: nothing agrees there, and the step is the answer.
#[test]
fn a_balance_on_a_step_of_a_law_says_so() {
    let heat = heat("ambient = '20 degC'\nconductance = '45 W/K'\nlimit = '150 degC'");
    let source = |t: f64| Ok::<_, Never>(vec![if t < 60.0 + ZERO { 2000.0 } else { 1700.0 }, 0.0]);
    let all = balance(&heat, &source, at_most(&heat, 1e-9)).unwrap();
    assert_eq!((all.verdict, all.equilibria.len()), (HeatVerdict::Unique, 1));
    let e = &all.equilibria[0];
    close(e.at.oil - ZERO, 60.0, 1e-9, "step");
    assert_eq!(e.step, Some([2000.0, 1700.0]));
}

#[test]
fn losses_too_large_have_no_balance_below_the_limit() {
    let heat = heat("ambient = '20 degC'\nconductance = '45 W/K'\nlimit = '90 degC'");
    let all = balance(&heat, &|_: f64| Ok::<_, Never>(vec![3600.0, 0.0]), at_most(&heat, 1e-9)).unwrap();
    assert_eq!(all.verdict, HeatVerdict::NoneBelowLimit);
    close(all.at_limit().carried, 45.0 * 70.0, 1e-12, "carried at the limit");
}

#[test]
fn a_train_without_losses_has_the_temperature_of_the_air() {
    let heat = heat("ambient = '20 degC'\nconductance = '45 W/K'");
    let all = balance(&heat, &|_: f64| Ok::<_, Never>(vec![0.0, 0.0]), at_most(&heat, 1e-9)).unwrap();
    assert_eq!((all.verdict, all.equilibria.len()), (HeatVerdict::Unique, 1));
    assert_eq!(all.equilibria[0].at.oil, heat.ambient());
}
