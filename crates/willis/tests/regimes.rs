//! Regimes and closed formulas against independent enumerations, the solver, and bad input.
//!
//! The set of Esmail 2018, Fig. 1 (suns 1 and 4 on stepped planets, carrier 2) obeys
//! `R = (ω4 − ω2)/(ω1 − ω2)`, `T4 = −ρ T1/R` and `T2 = T1 (ρ/R − 1)`, where ρ is the efficiency from 1
//! to 4 if `T1 (ω1 − ω2) > 0` ("1 drives"), and the inverse of that from 4 to 1 otherwise. So
//! everything about it follows in a few exact multiplications, without any of the library's code.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use willis::analysis::Role;
use willis::exact::Rational;
use willis::regimes::{
    Atlas, ClosedFormula, Efficiencies, FormulaRequest, Outside, Ratios, RegimeReport, RegimeSelection, RegionReport,
    formulas, regimes,
};
use willis::symbolic::Notation;
use willis::train::{EfficiencySpec, SetSpec, ShiftElementSpec, StateSpec, Train, TrainBuilder};

fn q(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator, denominator)
}

fn exact(text: &str) -> Rational {
    text.parse().unwrap()
}

struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) % n
    }
    fn whole(&mut self, low: i64, high: i64) -> i64 {
        low + self.below((high - low + 1) as u64) as i64
    }
    /// A positive fraction.
    fn fraction(&mut self) -> Rational {
        q(self.whole(1, 999), self.whole(1, 99))
    }
}

fn as_drawn(train: &Train) -> Atlas {
    state(train, "as drawn")
}

fn request_as_drawn() -> FormulaRequest {
    FormulaRequest { state: Some("as drawn".into()), ..Default::default() }
}

fn state(train: &Train, name: &str) -> Atlas {
    let selection = RegimeSelection { state: Some(name.into()), ..Default::default() };
    let mut all = regimes(train, &selection).unwrap();
    assert_eq!(all.states.len(), 1);
    all.states.remove(0)
}

/// What a formula asks for, told by what the arguments mean.
enum Source {
    Fixed(Rational),
    Speed(String),
    Torque(String),
}

fn sources(f: &ClosedFormula) -> Vec<(String, Source)> {
    let source =
        |a: &willis::regimes::Argument| match (a.fixed, a.meaning.split_once(" of "), a.meaning.split_once(" on ")) {
            (true, ..) => Source::Fixed(exact(&a.exact)),
            (_, Some(("speed", member)), _) => Source::Speed(member.into()),
            (_, _, Some(("torque", member))) => Source::Torque(member.into()),
            _ => panic!("{a:?}"),
        };
    f.arguments.iter().map(|a| (a.name.clone(), source(a))).collect()
}

/// The formula at speeds and torques by member.
fn evaluate(
    f: &ClosedFormula,
    sources: &[(String, Source)],
    speed: &dyn Fn(&str) -> Rational,
    torque: &dyn Fn(&str) -> Rational,
) -> Result<Rational, Outside> {
    f.evaluate(&|name| {
        let (_, source) = sources.iter().find(|(n, _)| n == name)?;
        Some(match source {
            Source::Fixed(value) => value.clone(),
            Source::Speed(member) => speed(member),
            Source::Torque(member) => torque(member),
        })
    })
}

// ---------------------------------------------------------------------------------------------
// The set of Fig. 1

const LINKS: [&str; 3] = ["1", "2", "4"];

/// Name of the case, teeth of sun 1, its planets, sun 4, its planets (a simple set without), R.
type Shape = (&'static str, Option<[i64; 4]>, (i64, i64));

const SHAPES: [Shape; 5] = [
    ("R>1", Some([40, 20, 24, 36]), (3, 1)),
    ("0<R<1", Some([20, 20, 40, 20]), (1, 2)),
    ("1<R<1/eta (band)", Some([51, 25, 50, 25]), (51, 50)),
    ("eta<R<1 (band)", Some([49, 25, 50, 25]), (49, 50)),
    ("R<0", None, (-30, 78)),
];

/// 1 drives, 4 drives; equal and different.
const ETAS: [[i64; 2]; 2] = [[950, 950], [960, 930]];

fn fig1(shape: &Shape, eta: [i64; 2], order: [&str; 3]) -> TrainBuilder {
    let set = match shape.1 {
        Some([z1, p1, z4, p4]) => SetSpec::stepped("P", "2").sun("1", z1, p1).sun("4", z4, p4),
        None => SetSpec::simple("P", ("1", 30), ("4", 78), "2"),
    };
    let [a, b] = eta.map(|e| e as f64 / 1000.0);
    let mut builder = Train::builder("Fig. 1")
        .members(order)
        .terminals(order)
        .set(set.basic_efficiency(EfficiencySpec::directed(a, b)));
    for link in LINKS {
        let others: Vec<&str> = LINKS.into_iter().filter(|l| *l != link).collect();
        builder = builder
            .shift_element(ShiftElementSpec::brake(format!("B{link}"), link))
            .state(StateSpec::new(format!("{link} held"), [format!("B{link}").as_str()]).between(others[0], others[1]));
    }
    builder
}

/// Basic ratio and the efficiencies from 1 to 4 and from 4 to 1.
#[derive(Clone, Debug)]
struct Set {
    r: Rational,
    eta: [Rational; 2],
}

/// An operating point of the set, links 1, 2, 4.
#[derive(Clone, Debug)]
struct Point {
    w: [Rational; 3],
    t: [Rational; 3],
    driver: &'static str,
    powers: [i8; 3],
    efficiency: Rational,
}

impl Set {
    fn new(shape: &Shape, eta: [i64; 2]) -> Self {
        Self { r: q(shape.2.0, shape.2.1), eta: eta.map(|e| q(e, 1000)) }
    }

    fn lossless(&self) -> Self {
        Self { eta: [Rational::ONE, Rational::ONE], ..self.clone() }
    }

    fn at(&self, w1: &Rational, w2: &Rational, t1: &Rational) -> Point {
        let r = &self.r;
        let w4 = w2 + &(r * &(w1 - w2));
        let one_drives = (w1 - w2).sign() * t1.sign() > 0;
        let rho = if one_drives { self.eta[0].clone() } else { self.eta[1].recip() };
        let t4 = -(&(&rho * t1) / r);
        let t2 = t1 * &(&(&rho / r) - &Rational::ONE);
        let (w, t) = ([w1.clone(), w2.clone(), w4], [t1.clone(), t2, t4]);
        let power = |k: usize| &w[k] * &t[k];
        let powers = [0, 1, 2].map(|k| power(k).sign());
        let sum = |sign: i8| (0..3).filter(|&k| powers[k] == sign).fold(Rational::ZERO, |sum, k| sum + power(k));
        let efficiency = -(&sum(-1) / &sum(1));
        Point { w, t, driver: if one_drives { "1" } else { "4" }, powers, efficiency }
    }

    /// The twelve formulas of Table 1, loss over input power (negative), and the thirteenth case.
    fn table(&self, p: &Point) -> Rational {
        let one_drives = p.driver == "1";
        let e = &self.eta[usize::from(!one_drives)];
        let one = Rational::ONE;
        let [w1, w2, w4] = &p.w;
        let seen = |i: &Rational, j: &Rational| &(i - j) / i;
        let (r42, r12, r21, r24) = (seen(w4, w2), seen(w1, w2), seen(w2, w1), seen(w2, w4));
        let de = e - &one;
        // What both rows of the table are made of: x for 1 driving and for 4 driving.
        let pick = |x: Rational, y: Rational| if one_drives { x } else { y };
        let inverse = |x: Rational| (&one - &x).recip() - one.clone();
        let on_4 = pick(&(&de * &r42) / e, -(&de * &r42));
        let on_1 = pick(-(&de * &r12), &(&de * &r12) / e);
        let on_2 = || pick(&(&de * &r21) / &(&(e / &self.r) - &one), &(&de * &r24) / &(&(e * &self.r) - &one));
        match p.powers {
            [1, 1, -1] => inverse(on_4),
            [-1, 1, 1] => inverse(on_1),
            [1, -1, 1] => inverse(on_2()),
            [-1, -1, 1] => -on_4,
            [-1, 1, -1] => -on_2(),
            [1, -1, -1] => -on_1,
            [1, 1, 1] => -one,
            other => panic!("{other:?}"),
        }
    }

    /// The eight directions `(ω1, ω2)` that bound the regions, counterclockwise.
    fn rays(&self) -> Vec<[Rational; 2]> {
        let one = Rational::ONE;
        let four_at_rest = [&self.r - &one, self.r.clone()];
        let mut all =
            vec![[one.clone(), Rational::ZERO], [Rational::ZERO, one.clone()], [one.clone(), one], four_at_rest];
        all.extend(all.clone().into_iter().map(|v| v.map(|x| -x)));
        all.sort_by(|u, v| {
            f64::atan2(u[1].to_f64(), u[0].to_f64()).total_cmp(&f64::atan2(v[1].to_f64(), v[0].to_f64()))
        });
        all.dedup_by(|u, v| {
            (&(&u[0] * &v[1]) - &(&u[1] * &v[0])).is_zero() && u[0].sign() == v[0].sign() && u[1].sign() == v[1].sign()
        });
        all
    }
}

fn combination(u: &[Rational; 2], x: &Rational, v: &[Rational; 2], y: &Rational) -> [Rational; 2] {
    [0, 1].map(|k| &(x * &u[k]) + &(y * &v[k]))
}

/// Signs of ω1, ω2, ω4 and ω1 − ω2.
fn side(w: &[Rational; 3]) -> [i8; 4] {
    [w[0].sign(), w[1].sign(), w[2].sign(), (&w[0] - &w[1]).sign()]
}

fn region_of<'a>(atlas: &'a Atlas, w: &[Rational; 3]) -> &'a RegionReport {
    let wanted = side(w);
    let mut fits = atlas.regions.iter().filter(|r| {
        let speed = |link: &str| *r.example.get(link).unwrap();
        let sign = |x: f64| if x > 0.0 { 1 } else { -i8::from(x < 0.0) };
        [sign(speed("1")), sign(speed("2")), sign(speed("4")), sign(speed("1") - speed("2"))] == wanted
    });
    let found = fits.next().unwrap_or_else(|| panic!("no region for {w:?}"));
    assert!(fits.next().is_none(), "two regions for {w:?}");
    found
}

fn regime_of<'a>(atlas: &'a Atlas, region: usize, t1: i8) -> &'a RegimeReport {
    let mut fits = atlas.regimes.iter().filter(|r| r.region == region && *r.torque_signs.get("1").unwrap() == t1);
    let found = fits.next().unwrap_or_else(|| panic!("no regime in region {region} with T1 of sign {t1}"));
    assert!(fits.next().is_none(), "two regimes in region {region} with T1 of sign {t1}");
    found
}

fn names_where(powers: &[i8; 3], order: [&str; 3], sign: i8) -> Vec<String> {
    let at = |link: &str| LINKS.iter().position(|l| *l == link).unwrap();
    order.iter().filter(|l| powers[at(l)] == sign).map(|l| (*l).to_owned()).collect()
}

/// `w_4 > w_1 > 0 > w_2`.
fn chain(w: &[Rational; 3]) -> String {
    let mut all: Vec<(&Rational, String)> = w.iter().zip(LINKS).map(|(w, l)| (w, format!("w_{l}"))).collect();
    all.push((&Rational::ZERO, "0".into()));
    all.sort_by(|a, b| b.0.cmp(a.0));
    all.into_iter().map(|x| x.1).collect::<Vec<_>>().join(" > ")
}

/// All that the report says of one regime, against an operating point inside it.
fn compare_regime(atlas: &Atlas, regime: &RegimeReport, p: &Point, set: &Set, order: [&str; 3]) {
    let what = format!("{regime:?}\n{p:?}");
    for (k, link) in LINKS.iter().enumerate() {
        assert_eq!(*regime.torque_signs.get(link).unwrap(), p.t[k].sign(), "{link}: {what}");
        let role = if p.powers[k] > 0 { Role::Input } else { Role::Output };
        assert_eq!(*regime.roles.get(link).unwrap(), role, "{link}: {what}");
    }
    assert_eq!(regime.inputs, names_where(&p.powers, order, 1), "{what}");
    assert_eq!(regime.outputs, names_where(&p.powers, order, -1), "{what}");
    assert_eq!(regime.drivers.0, [("P".to_owned(), Some(p.driver.to_owned()))], "{what}");
    assert_eq!(regime.all_dissipated, p.powers == [1, 1, 1], "{what}");
    let ideal = set.lossless().at(&p.w[0], &p.w[1], &p.t[0]);
    let turned = ideal.t.iter().zip(&p.t).any(|(x, y)| x.sign() != y.sign());
    assert_eq!(regime.by_friction_only, turned, "{what}");
    let (low, high) = (regime.efficiency_range.unwrap()[0], regime.efficiency_range.unwrap()[1]);
    let efficiency = p.efficiency.to_f64();
    assert!(low - 1e-14 <= efficiency && efficiency <= high + 1e-14, "{low} {efficiency} {high}: {what}");

    let mirror = atlas.regimes.iter().find(|m| m.id == regime.mirror).unwrap();
    let opposite = atlas.regions[regime.region - 1].opposite;
    assert_eq!((mirror.region, &mirror.mirror), (opposite, &regime.id), "{what}");
    assert_eq!((&mirror.roles, &mirror.drivers, &mirror.formula), (&regime.roles, &regime.drivers, &regime.formula));
    assert!(mirror.torque_signs.iter().zip(regime.torque_signs.iter()).all(|(x, y)| x.1 == -y.1), "{what}");

    let speed = |link: &str| Rational::from_f64(*regime.example.speeds.get(link).unwrap()).unwrap();
    let torque = |link: &str| *regime.example.torques.get(link).unwrap();
    let t1 = Rational::from_f64(torque("1")).unwrap();
    let own = set.at(&speed("1"), &speed("2"), &t1);
    assert_eq!((side(&own.w), own.powers, own.driver), (side(&p.w), p.powers, p.driver), "{what}");
    for (k, link) in LINKS.iter().enumerate() {
        assert!((torque(link) / own.t[k].to_f64() - 1.0).abs() < 1e-12, "{link}: {what}");
    }
    assert!((regime.example.efficiency - own.efficiency.to_f64()).abs() < 1e-12, "{what}");
    assert!((exact(&regime.example.efficiency_exact).to_f64() - own.efficiency.to_f64()).abs() < 1e-12, "{what}");
}

/// The intervals of `i0 = 1/R` and of the driver's efficiency in which the torques keep their
/// signs: `T4/T1 = −ρ i0` and `T2/T1 = ρ i0 − 1`.
fn compare_thresholds(atlas: &Atlas, regime: &RegimeReport, p: &Point, set: &Set) {
    let one_drives = p.driver == "1";
    let e = &set.eta[usize::from(!one_drives)];
    let rho = if one_drives { e.clone() } else { e.recip() };
    let i = set.r.recip();
    let bounds = |value: &Rational, cuts: &[Rational]| {
        let low = cuts.iter().filter(|c| *c < value).max().map(Rational::to_f64);
        let high = cuts.iter().filter(|c| *c > value).min().map(Rational::to_f64);
        (low, high)
    };
    let f = atlas.formulas.iter().find(|f| f.id == regime.formula).unwrap();
    let found = |symbol: &str| f.holds_for.iter().find(|h| h.symbol == symbol).map(|h| (h.value, h.low, h.high));
    let near = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-14,
        (a, b) => a == b,
    };
    let (low, high) = bounds(&i, &[Rational::ZERO, rho.recip()]);
    let ratio = found("i0").unwrap();
    assert!(ratio.0 == i.to_f64() && near(ratio.1, low) && near(ratio.2, high), "{ratio:?} {low:?} {high:?}");
    let turn = if one_drives { set.r.clone() } else { i.clone() };
    let (low, high) = bounds(e, &[Rational::ZERO, turn, Rational::ONE]);
    let efficiency = found("eta0").unwrap();
    assert!(
        efficiency.0 == e.to_f64() && near(efficiency.1, low) && near(efficiency.2, high),
        "{efficiency:?} {low:?} {high:?}"
    );
}

#[test]
fn val_all_80_regimes_of_one_set_with_two_freedoms() {
    let mut random = Random(1);
    for eta in ETAS {
        let mut total = 0;
        for shape in &SHAPES {
            for order in [["1", "2", "4"], ["2", "4", "1"], ["4", "1", "2"]] {
                let set = Set::new(shape, eta);
                let train = fig1(shape, eta, order).build().unwrap();
                let atlas = as_drawn(&train);
                assert_eq!(atlas.terminals, order);
                assert_eq!(atlas.base_speeds, &order[..2]);
                assert_eq!((atlas.degrees_of_freedom, atlas.independent_torques), (2, 1));
                assert_eq!((atlas.regions.len(), atlas.regimes.len()), (8, 16), "{}", shape.0);
                let ids: BTreeSet<&str> = atlas.regimes.iter().map(|r| r.id.as_str()).collect();
                assert_eq!(ids.len(), 16);
                if order == LINKS {
                    total += atlas.regimes.len();
                }
                let mut pairs: BTreeMap<([i8; 3], &str), BTreeSet<&str>> = BTreeMap::new();
                let mut lossless_roles: BTreeSet<[i8; 3]> = BTreeSet::new();
                let mut unturned: BTreeSet<[i8; 3]> = BTreeSet::new();
                let sheet = formulas(&train, &request_as_drawn()).unwrap();
                assert!(sheet.without.is_empty());
                let rays = set.rays();
                assert_eq!(rays.len(), 8);
                for (k, from) in rays.iter().enumerate() {
                    let to = &rays[(k + 1) % 8];
                    let middle = combination(from, &Rational::ONE, to, &Rational::ONE);
                    let w = set.at(&middle[0], &middle[1], &Rational::ONE).w;
                    let region = region_of(&atlas, &w);
                    assert_eq!(region.order, [chain(&w)]);
                    for s in [1i8, -1] {
                        let t = |random: &mut Random| random.fraction() * Rational::from(i64::from(s));
                        let regime = regime_of(&atlas, region.number, s);
                        let own: Vec<_> = sheet.formulas.iter().filter(|f| f.regimes.contains(&regime.id)).collect();
                        let [formula] = own[..] else { panic!("{:?}", regime.id) };
                        assert!(formula.regimes.contains(&regime.mirror));
                        assert_eq!((&formula.inputs, &formula.outputs), (&regime.inputs, &regime.outputs));
                        let sources = sources(formula);
                        for n in 0..12 {
                            let [x, y] = [random.fraction(), random.fraction()];
                            let v = combination(from, &x, to, &y);
                            let p = set.at(&v[0], &v[1], &t(&mut random));
                            if n == 0 {
                                compare_regime(&atlas, regime, &p, &set, order);
                                compare_thresholds(&atlas, regime, &p, &set);
                                pairs.entry((p.powers, p.driver)).or_default().insert(&regime.id);
                                let ideal = set.lossless().at(&v[0], &v[1], &p.t[0]).powers;
                                lossless_roles.insert(ideal);
                                if ideal == p.powers {
                                    unturned.insert(ideal);
                                }
                                if let Some(ratio) = region.ratio.as_ref() {
                                    let of = |base: usize| {
                                        p.w[LINKS.iter().position(|l| *l == order[base]).unwrap()].to_f64()
                                    };
                                    let now = of(1) / of(0);
                                    assert!(ratio.low.is_none_or(|l| l < now) && ratio.high.is_none_or(|h| now < h));
                                    assert_eq!(of(0).signum(), f64::from(ratio.denominator_sign));
                                }
                            }
                            let at = |values: &[Rational; 3], link: &str| {
                                values[LINKS.iter().position(|l| *l == link).unwrap()].clone()
                            };
                            let found = evaluate(formula, &sources, &|l| at(&p.w, l), &|l| at(&p.t, l));
                            let efficiency = if p.powers == [1, 1, 1] { Rational::ZERO } else { p.efficiency.clone() };
                            assert_eq!(set.table(&p), &efficiency - &Rational::ONE, "the table itself: {p:?}");
                            assert_eq!(found, Ok(efficiency), "{} {p:?}", formula.efficiency(Notation::Text));
                            // The same with everything reversed, and not with the torque alone.
                            let back = |v: &[Rational; 3]| v.clone().map(|x| -x);
                            let (w, t) = (back(&p.w), back(&p.t));
                            assert_eq!(evaluate(formula, &sources, &|l| at(&w, l), &|l| at(&t, l)), found);
                            let wrong = evaluate(formula, &sources, &|l| at(&p.w, l), &|l| at(&t, l));
                            assert!(matches!(wrong, Err(Outside::Condition(_))), "{wrong:?} {p:?}");
                        }
                        // The bounds of the efficiency are its limits at the bounding directions.
                        let mut ends = [(from, to), (to, from)].map(|(near, far)| {
                            let v = combination(near, &Rational::ONE, far, &q(1, 1_000_000_000));
                            set.at(&v[0], &v[1], &Rational::from(i64::from(s))).efficiency.to_f64()
                        });
                        ends.sort_by(f64::total_cmp);
                        let range = regime.efficiency_range.unwrap();
                        assert!(
                            ends.iter().zip(range).all(|(x, y)| (x - y).abs() < 1e-6),
                            "{} {}: {ends:?} {range:?}",
                            shape.0,
                            regime.id
                        );
                    }
                    // Which regimes answer a prescribed torque.
                    for prescribed in &region.prescribed {
                        for (sign, listed) in [(1, &prescribed.positive), (-1, &prescribed.negative)] {
                            let own: Vec<&String> = atlas
                                .regimes
                                .iter()
                                .filter(|r| {
                                    r.region == region.number
                                        && *r.torque_signs.get(&prescribed.terminal).unwrap() == sign
                                })
                                .map(|r| &r.id)
                                .collect();
                            assert_eq!(listed.iter().collect::<Vec<_>>(), own);
                        }
                    }
                }
                // One formula for each pair of roles and driver.
                assert_eq!(atlas.formulas.len(), pairs.len());
                for own in pairs.values() {
                    let ids: BTreeSet<&str> = atlas
                        .formulas
                        .iter()
                        .find(|f| own.contains(f.regimes[0].as_str()))
                        .unwrap()
                        .regimes
                        .iter()
                        .map(String::as_str)
                        .collect();
                    assert_eq!(ids, *own);
                }
                // All seven assignments, and what is said of each.
                assert_eq!(atlas.assignments.len(), 7);
                for a in &atlas.assignments {
                    let powers = LINKS.map(|l| if a.inputs.iter().any(|i| i == l) { 1i8 } else { -1 });
                    assert_eq!(a.outputs, names_where(&powers, order, -1));
                    let own: BTreeSet<&str> = pairs
                        .iter()
                        .filter(|((p, _), _)| *p == powers)
                        .flat_map(|(_, ids)| ids.iter().copied())
                        .collect();
                    assert_eq!(a.regimes.iter().map(String::as_str).collect::<BTreeSet<_>>(), own, "{a:?}");
                    let ideal = lossless_roles.contains(&powers);
                    let expected = match (own.is_empty(), powers == [1, 1, 1]) {
                        (false, true) => "reached: friction takes everything",
                        (true, true) => "cannot be reached: friction never takes everything",
                        (false, _) if unturned.contains(&powers) => "reached",
                        (false, _) if ideal => "reached where friction turns a torque round",
                        (false, _) => "only because friction",
                        (true, _) if ideal => "cannot be reached: friction prevents it",
                        (true, _) => "cannot be reached: speeds and torques never",
                    };
                    let told = if expected == "reached" { a.reach == expected } else { a.reach.starts_with(expected) };
                    assert!(told, "{}: {a:?}, expected {expected}", shape.0);
                }
                // Friction alone makes half of the regimes in the band, and two of them heaters.
                let band = shape.0.contains("band");
                let turned = atlas.regimes.iter().filter(|r| r.by_friction_only).count();
                let heaters = atlas.regimes.iter().filter(|r| r.all_dissipated).count();
                assert_eq!((turned, heaters), if band { (8, 2) } else { (0, 0) }, "{}", shape.0);
            }
        }
        assert_eq!(total, 80);
    }
}

/// With direction-dependent efficiency one of the two decides whether there is a band.
#[test]
fn val_the_band_needs_the_efficiency_of_the_right_direction() {
    let band = |z: [i64; 2], eta: [i64; 2]| {
        let shape = ("", Some([z[0], 25, z[1], 25]), (z[0], z[1]));
        let atlas = as_drawn(&fig1(&shape, eta, LINKS).build().unwrap());
        atlas.regimes.iter().filter(|r| r.by_friction_only).count()
    };
    // R = 26/25: T2 turns round if 4 drives and b R < 1; the other direction does not matter.
    assert_eq!(band([26, 25], [900, 970]), 0);
    assert_eq!(band([26, 25], [970, 900]), 8);
    // R = 25/26: if 1 drives and a < R.
    assert_eq!(band([25, 26], [970, 900]), 0);
    assert_eq!(band([25, 26], [900, 970]), 8);
    // Exactly on the threshold, b R = 1 with R = 25/24: the carrier feels nothing if 4 drives.
    let shape = ("", Some([25, 25, 24, 25]), (25, 24));
    let atlas = as_drawn(&fig1(&shape, [970, 960], LINKS).build().unwrap());
    let idle = atlas.regimes.iter().filter(|r| *r.roles.get("2").unwrap() == Role::Idle).count();
    assert_eq!((atlas.regimes.len(), idle), (16, 8));
    for r in &atlas.regimes {
        let driver = r.drivers.0[0].1.as_deref().unwrap();
        assert_eq!(*r.torque_signs.get("2").unwrap() == 0, driver == "4", "{r:?}");
    }
}

/// Two examples of the theory, in exact numbers.
#[test]
fn val_the_worked_examples_in_the_band() {
    let shape = ("", Some([51, 25, 50, 25]), (51, 50));
    let set = Set { r: q(51, 50), eta: [q(9409, 10000), q(9409, 10000)] };
    let train = Train::builder("band")
        .members(LINKS)
        .terminals(LINKS)
        .set(SetSpec::stepped("P", "2").sun("1", 51, 25).sun("4", 50, 25).basic_efficiency(0.9409))
        .build()
        .unwrap();
    let atlas = as_drawn(&train);
    assert_eq!(set.r, q(shape.2.0, shape.2.1));
    for (w, inputs, printed) in [
        // The paper: 1,4 -> 2 with -2.08.
        ([q(1, 100), q(101, 100), q(-1, 100)], vec!["1", "2", "4"], None),
        // The paper: 1 -> 2,4 with 0.97906.
        ([q(3, 1), q(4, 1), q(298, 100)], vec!["1", "2"], Some(0.98017)),
    ] {
        let p = set.at(&w[0], &w[1], &Rational::ONE);
        assert_eq!(p.w, w);
        let region = region_of(&atlas, &w);
        let regime = regime_of(&atlas, region.number, 1);
        assert_eq!(regime.inputs, inputs);
        let request = FormulaRequest { regime: Some(regime.id.clone()), ..Default::default() };
        let sheet = formulas(&train, &request).unwrap();
        let formula = &sheet.formulas[0];
        let at = |values: &[Rational; 3], link: &str| values[LINKS.iter().position(|l| *l == link).unwrap()].clone();
        let found = evaluate(formula, &sources(formula), &|l| at(&w, l), &|l| at(&p.t, l)).unwrap();
        match printed {
            Some(printed) => assert!((found.to_f64() - printed).abs() < 0.5e-5, "{found}"),
            None => assert_eq!(found, Rational::ZERO),
        }
    }
}

#[test]
fn val_the_ten_entries_of_the_reference() {
    let path = format!("{}/../../validation/reference/regimes.json", env!("CARGO_MANIFEST_DIR"));
    let reference: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let entries = reference["regimes"].as_array().unwrap();
    assert_eq!(entries.len(), 10);
    for entry in entries {
        let text = |key: &str| entry[key].as_str().unwrap();
        let shape = SHAPES.iter().find(|s| s.0 == text("case")).unwrap();
        let set = Set::new(shape, ETAS[0]);
        let train = fig1(shape, ETAS[0], LINKS).build().unwrap();
        let atlas = as_drawn(&train);
        let order = text("speeds").replace('w', "w_");
        let region = atlas.regions.iter().find(|r| r.order == [order.as_str()]).unwrap();
        let signs: Vec<i8> = ["T1", "T2", "T4"].map(|t| entry["torque_signs"][t].as_i64().unwrap() as i8).to_vec();
        let regime = regime_of(&atlas, region.number, signs[0]);
        assert_eq!(regime.torque_signs.iter().map(|x| x.1).collect::<Vec<_>>(), signs, "{entry}");
        let driver = entry["driver"].as_i64().unwrap().to_string();
        assert_eq!(regime.drivers.0[0].1.as_ref(), Some(&driver), "{entry}");
        let role = format!("{}->{}", regime.inputs.join(","), regime.outputs.join(","));
        assert_eq!(role, text("role"));
        assert_eq!(format!("{role}|d{driver}"), text("formula"));
        let sheet = formulas(
            &train,
            &FormulaRequest { regime: Some(regime.id.clone()), state: Some("as drawn".into()), ..Default::default() },
        )
        .unwrap();
        let formula = &sheet.formulas[0];
        let speed = |l: &str| Rational::from_f64(*region.example.get(l).unwrap()).unwrap();
        let p = set.at(&speed("1"), &speed("2"), &Rational::from(i64::from(signs[0])));
        let at = |values: &[Rational; 3], link: &str| values[LINKS.iter().position(|l| *l == link).unwrap()].clone();
        let found = evaluate(formula, &sources(formula), &|l| at(&p.w, l), &|l| at(&p.t, l)).unwrap();
        assert_eq!(&found - &Rational::ONE, set.table(&p), "{entry}");
    }
}

/// Ratios and efficiencies in symbols, teeth, meshes or numbers: always the same value.
#[test]
fn prop_every_way_of_writing_gives_the_same_value() {
    let mut random = Random(2);
    for shape in &SHAPES {
        let base = fig1(shape, ETAS[1], LINKS);
        let by_meshes = {
            let meshes = willis::train::SetEfficiencySpec::Meshes {
                external: EfficiencySpec::directed(0.98, 0.97),
                internal: EfficiencySpec::directed(0.99, 0.96),
            };
            let set = match shape.1 {
                Some([z1, p1, z4, p4]) => SetSpec::stepped("P", "2").sun("1", z1, p1).sun("4", z4, p4),
                None => SetSpec::simple("P", ("1", 30), ("4", 78), "2").planet(24, 3),
            };
            Train::builder("Fig. 1").members(LINKS).terminals(LINKS).set(set.efficiency(meshes))
        };
        for (builder, eta) in [
            (base, ETAS[1].map(|e| q(e, 1000))),
            (
                by_meshes,
                match shape.1 {
                    // The second mesh is driven by the planet if sun 1 drives.
                    Some(_) => [q(98 * 97, 10000), q(98 * 97, 10000)],
                    None => [q(98 * 99, 10000), q(96 * 97, 10000)],
                },
            ),
        ] {
            let set = Set { r: q(shape.2.0, shape.2.1), eta };
            let train = builder.build().unwrap();
            let atlas = as_drawn(&train);
            for ratios in [Ratios::Basic, Ratios::Teeth, Ratios::Numbers] {
                for efficiencies in [Efficiencies::Basic, Efficiencies::Meshes, Efficiencies::Numbers] {
                    let request = FormulaRequest { ratios, efficiencies, ..request_as_drawn() };
                    let sheet = formulas(&train, &request).unwrap();
                    for regime in &atlas.regimes {
                        let region = &atlas.regions[regime.region - 1];
                        let speed = |l: &str| Rational::from_f64(*region.example.get(l).unwrap()).unwrap();
                        let t1 = random.fraction() * Rational::from(i64::from(*regime.torque_signs.get("1").unwrap()));
                        let p = set.at(&speed("1"), &speed("2"), &t1);
                        let f = sheet.formulas.iter().find(|f| f.regimes.contains(&regime.id)).unwrap();
                        let at =
                            |v: &[Rational; 3], link: &str| v[LINKS.iter().position(|l| *l == link).unwrap()].clone();
                        let found = evaluate(f, &sources(f), &|l| at(&p.w, l), &|l| at(&p.t, l));
                        let expected = if regime.all_dissipated { Rational::ZERO } else { p.efficiency.clone() };
                        assert_eq!(found, Ok(expected), "{ratios:?} {efficiencies:?} {} {p:?}", shape.0);
                        let numbers = (ratios, efficiencies) == (Ratios::Numbers, Efficiencies::Numbers);
                        assert!(!numbers || f.arguments.iter().all(|a| !a.fixed), "{:?}", f.arguments);
                    }
                }
            }
        }
    }
}

// ---------------------------------------------------------------------------------------------
// One freedom: the six inversions

/// Efficiency of the drive and which of the suns drives, by the table of the theory; the ratio of
/// the speeds of input and output.
fn inversion(r: &Rational, [a, b]: [&Rational; 2], input: &str, output: &str) -> (Rational, &'static str, Rational) {
    let one = Rational::ONE;
    let above = *r > one;
    let below = r.sign() < 0;
    let x = &one - r;
    match (input, output) {
        ("1", "4") => (a.clone(), "1", r.recip()),
        ("4", "1") => (b.clone(), "4", r.clone()),
        ("1", "2") => {
            let ratio = -(&x / r);
            if above { (&(&(b * r) - &one) / &-(b * &x), "4", ratio) } else { (&(a - r) / &x, "1", ratio) }
        }
        ("2", "1") => {
            let ratio = -(r / &x);
            if above { (&-x / &(r - a), "1", ratio) } else { (&(b * &x) / &(&one - &(b * r)), "4", ratio) }
        }
        ("4", "2") => match (below, above) {
            (true, _) => (&(&one - &(b * r)) / &x, "4", x),
            (_, false) => (&(a - r) / &(a * &x), "1", x),
            _ => (&(&(b * r) - &one) / &-x.clone(), "4", x),
        },
        ("2", "4") => match (below, above) {
            (true, _) => (&(a * &x) / &(a - r), "1", x.recip()),
            (_, false) => (&x / &(&one - &(b * r)), "4", x.recip()),
            _ => (&-(a * &x) / &(r - a), "1", x.recip()),
        },
        _ => panic!(),
    }
}

const DRIVES: [[&str; 2]; 6] = [["1", "4"], ["4", "1"], ["1", "2"], ["2", "1"], ["4", "2"], ["2", "4"]];

fn held([input, output]: [&str; 2]) -> String {
    let held = LINKS.into_iter().find(|l| *l != input && *l != output).unwrap();
    format!("{held} held")
}

/// All that is said of the six inversions; the number of locked ones.
fn compare_inversions(shape: &Shape, eta: [i64; 2], random: &mut Random) -> usize {
    let set = Set::new(shape, eta);
    let train = fig1(shape, eta, LINKS).build().unwrap();
    let [a, b] = &set.eta;
    let mut locked = 0;
    for drive in DRIVES {
        let what = format!("R = {}, {eta:?}, {drive:?}", set.r);
        let [input, output] = drive;
        let (expected, driver, ratio) = inversion(&set.r, [a, b], input, output);
        let atlas = state(&train, &held(drive));
        assert_eq!((atlas.degrees_of_freedom, atlas.regions.len()), (1, 2), "{what}");
        assert_eq!(atlas.held, [held(drive)[..1].to_owned()], "{what}");
        // Two rays in each sense of motion, with the sun 1 driving and with the sun 4 driving.
        let forward: Vec<&RegimeReport> =
            atlas.regimes.iter().filter(|r| r.inputs == [input] && r.outputs == [output]).collect();
        assert_eq!(forward.len(), if expected.sign() > 0 { 2 } else { 0 }, "{what}");
        let request = FormulaRequest {
            state: Some(held(drive)),
            from: vec![input.into()],
            to: vec![output.into()],
            ..Default::default()
        };
        let sheet = formulas(&train, &request).unwrap();
        if expected.sign() <= 0 {
            locked += 1;
            assert!(sheet.formulas.is_empty(), "{what}");
            let [(state, why)] = &sheet.without[..] else { panic!("{what}: {:?}", sheet.without) };
            assert!(*state == held(drive) && why.contains("locked"), "{what}: {why}");
            continue;
        }
        for r in forward {
            assert_eq!(exact(&r.example.efficiency_exact), expected, "{what}");
            assert_eq!(r.efficiency_range, Some([expected.to_f64(); 2]), "{what}");
            assert_eq!(r.drivers.0[0].1.as_deref(), Some(driver), "{what}");
            let w = |l: &str| *r.example.speeds.get(l).unwrap();
            assert!((w(input) / w(output) / ratio.to_f64() - 1.0).abs() < 1e-13, "{what}");
        }
        assert!(sheet.without.is_empty());
        let [f] = &sheet.formulas[..] else { panic!("{what}: {} formulas", sheet.formulas.len()) };
        assert_eq!(f.value(), Some(expected.clone()), "{what}");
        assert_eq!(f.drivers.0[0].1.as_deref(), Some(driver), "{what}");
        let number = |ratio: &Rational, eta: &Rational| {
            f.evaluate(&|name| match name {
                "i0" => Some(ratio.recip()),
                "eta0" => Some(eta.clone()),
                other => panic!("{other}"),
            })
        };
        assert_eq!(number(&set.r, &set.eta[usize::from(driver == "4")]), Ok(expected.clone()), "{what}");
        // In numbers: speed ratio, torque ratio and efficiency.
        let numbers = FormulaRequest { ratios: Ratios::Numbers, efficiencies: Efficiencies::Numbers, ..request };
        let sheet = formulas(&train, &numbers).unwrap();
        let own = &sheet.formulas[0];
        assert_eq!(exact(&own.efficiency(Notation::Text)), expected, "{what}");
        let [speeds, torques] = own.ratios(Notation::Text).unwrap();
        assert_eq!((exact(&speeds), exact(&torques)), (ratio.clone(), -(&expected * &ratio)), "{what}");
        // The guard: another basic ratio and efficiency are accepted if, and only if, the same sun
        // drives and the drive is not locked there.
        for _ in 0..60 {
            let r = match random.below(4) {
                0 => q(random.whole(900, 1100), 1000),
                _ => q(random.whole(-400, 400), 100),
            };
            if r.is_zero() || r == Rational::ONE {
                continue;
            }
            let e = q(random.whole(500, 999), 1000);
            let (value, own, _) = inversion(&r, [&e, &e], input, output);
            let found = number(&r, &e);
            match own == driver && value.sign() > 0 {
                true => assert_eq!(found, Ok(value), "{what} at R = {r}, {e}"),
                false => assert!(found.is_err(), "{what} at R = {r}, {e}: {found:?}, expected {own} drives, {value}"),
            }
        }
        for wrong in [Rational::ZERO, q(-1, 2), q(1001, 1000)] {
            assert!(matches!(number(&set.r, &wrong), Err(Outside::NoEfficiency(_))), "{what}");
        }
        assert_eq!(f.evaluate(&|_| None), Err(Outside::Missing(f.arguments[0].name.clone())));
    }
    locked
}

#[test]
fn val_six_inversions_in_every_range() {
    let mut random = Random(3);
    let mut locked = 0;
    for eta in ETAS {
        for shape in &SHAPES {
            locked += compare_inversions(shape, eta, &mut random);
        }
    }
    for _ in 0..40 {
        let (z1, z4) = (random.whole(15, 60), random.whole(15, 60));
        if z1 == z4 {
            continue;
        }
        let eta = [random.whole(600, 999), random.whole(600, 999)];
        locked += compare_inversions(&("random", Some([z1, 20, z4, 20]), (z1, z4)), eta, &mut random);
    }
    assert!(locked > 20, "{locked}");
}

/// The printed check values: 1→4, 4→1, 1→2, 2→1, 4→2, 2→4; locked as 0.
#[test]
fn val_the_table_of_check_values() {
    for (teeth, eta, printed) in [
        ([-30, 78], 0.9702, [0.970200, 0.970200, 0.978478, 0.978298, 0.991722, 0.991540]),
        ([-30, 60], 0.95, [0.95, 0.95, 0.966667, 0.966102, 0.983333, 0.982759]),
        ([60, 20], 0.95, [0.95, 0.95, 0.973684, 0.975610, 0.925000, 0.926829]),
        ([20, 40], 0.95, [0.95, 0.95, 0.900000, 0.904762, 0.947368, 0.952381]),
        ([51, 50], 0.95, [0.95, 0.95, 0.0, 0.285714, 0.0, 0.271429]),
        ([21, 20], 0.95, [0.95, 0.95, 0.0, 0.500000, 0.0, 0.475000]),
    ] {
        let set = match teeth {
            [z1, z4] if z1 < 0 => SetSpec::simple("P", ("1", -z1), ("4", z4), "2"),
            [z1, z4] => SetSpec::stepped("P", "2").sun("1", z1, 20).sun("4", z4, 20),
        };
        for (drive, printed) in DRIVES.into_iter().zip(printed) {
            let held = &held(drive)[..1];
            let train = Train::builder("set")
                .members(LINKS)
                .terminals(LINKS)
                .set(set.clone().basic_efficiency(eta))
                .shift_element(ShiftElementSpec::brake("B", held))
                .state(StateSpec::new("held", ["B"]).between(drive[0], drive[1]))
                .build()
                .unwrap();
            let sheet = formulas(&train, &FormulaRequest { state: Some("held".into()), ..Default::default() }).unwrap();
            match printed > 0.0 {
                true => {
                    let found = sheet.formulas[0].value().unwrap().to_f64();
                    assert!((found - printed).abs() <= 0.5e-6 + 1e-12, "{teeth:?} {drive:?}: {found} {printed}");
                }
                false => {
                    assert!(sheet.formulas.is_empty());
                    assert!(sheet.without[0].1.contains("locked"), "{:?}", sheet.without);
                }
            }
            // The fourth kind: everything that goes in becomes heat.
            let heaters = state(&train, "held").regimes.iter().filter(|r| r.all_dissipated).count();
            let self_locking = matches!(teeth, [51, 50] | [21, 20]) && held != "2";
            assert_eq!(heaters, if self_locking { 2 } else { 0 }, "{teeth:?} {drive:?}");
        }
    }
}

// ---------------------------------------------------------------------------------------------
// R = 1

#[test]
fn val_basic_ratio_one_is_pure_friction() {
    let mut random = Random(4);
    let shape = ("R=1", Some([25, 20, 25, 20]), (1, 1));
    for eta in ETAS {
        for order in [["1", "2", "4"], ["2", "4", "1"], ["1", "4", "2"], ["4", "2", "1"]] {
            let set = Set::new(&shape, eta);
            let train = fig1(&shape, eta, order).build().unwrap();
            let atlas = as_drawn(&train);
            assert!(atlas.reason.is_none());
            assert!((1..=2).contains(&atlas.notes.len()), "{:?}", atlas.notes);
            assert!(atlas.notes[0].contains("basic ratio") && atlas.notes[0].contains("is 1"), "{:?}", atlas.notes);
            let sheets = [
                (Ratios::Basic, Efficiencies::Basic),
                (Ratios::Numbers, Efficiencies::Numbers),
                (Ratios::Teeth, Efficiencies::Meshes),
            ]
            .map(|(ratios, efficiencies)| {
                formulas(&train, &FormulaRequest { ratios, efficiencies, ..request_as_drawn() }).unwrap()
            });
            // w1 = w4 at rest, w2 at rest, all alike: six sectors, two regimes in each.
            let rays = set.rays();
            assert_eq!((rays.len(), atlas.regions.len(), atlas.regimes.len()), (6, 6, 12));
            for (k, from) in rays.iter().enumerate() {
                let to = &rays[(k + 1) % 6];
                for s in [1i8, -1] {
                    let p = |x: &Rational, y: &Rational, t: Rational| {
                        let v = combination(from, x, to, y);
                        set.at(&v[0], &v[1], &(t * Rational::from(i64::from(s))))
                    };
                    let first = p(&Rational::ONE, &Rational::ONE, Rational::ONE);
                    let region = region_of(&atlas, &first.w);
                    let regime = regime_of(&atlas, region.number, s);
                    compare_regime(&atlas, regime, &first, &set, order);
                    // T2 = (ρ - 1) T1.
                    let rho = if first.driver == "1" { set.eta[0].clone() } else { set.eta[1].recip() };
                    let expected = ((&rho - &Rational::ONE) * first.t[0].clone()).sign();
                    assert_eq!(*regime.torque_signs.get("2").unwrap(), expected);
                    for sheet in &sheets {
                        let f = sheet.formulas.iter().find(|f| f.regimes.contains(&regime.id)).unwrap();
                        let sources = sources(f);
                        for _ in 0..5 {
                            let p = p(&random.fraction(), &random.fraction(), random.fraction());
                            let at = |v: &[Rational; 3], link: &str| {
                                v[LINKS.iter().position(|l| *l == link).unwrap()].clone()
                            };
                            let expected = if regime.all_dissipated { Rational::ZERO } else { p.efficiency.clone() };
                            let found = evaluate(f, &sources, &|l| at(&p.w, l), &|l| at(&p.t, l));
                            assert_eq!(found, Ok(expected), "{order:?} {p:?}");
                        }
                    }
                }
            }
            // Without loss the carrier feels nothing at all, whatever the order.
            let bare = Train::builder("R = 1")
                .members(order)
                .terminals(order)
                .set(SetSpec::stepped("P", "2").sun("1", 25, 20).sun("4", 25, 20))
                .build()
                .unwrap();
            let atlas = as_drawn(&bare);
            for r in &atlas.regimes {
                assert_eq!(*r.roles.get("2").unwrap(), Role::Idle, "{r:?}");
                assert_eq!(r.example.efficiency, 1.0);
            }
            assert!(formulas(&bare, &FormulaRequest::default()).is_ok());
        }
    }
    // The inversions: carrier held 1:1; with a sun held the other sun stands and the carrier is free.
    let train = fig1(&shape, ETAS[0], LINKS).build().unwrap();
    for link in LINKS {
        let sheet =
            formulas(&train, &FormulaRequest { state: Some(format!("{link} held")), ..Default::default() }).unwrap();
        match link {
            "2" => assert_eq!(sheet.formulas[0].value(), Some(q(95, 100))),
            _ => assert!(sheet.formulas.is_empty() && sheet.without.len() == 1, "{link}: {:?}", sheet.without),
        }
        let atlas = state(&train, &format!("{link} held"));
        assert!(
            atlas.reason.is_some() || atlas.regimes.iter().all(|r| link == "2" || r.outputs.is_empty()),
            "{atlas:?}"
        );
    }
}
