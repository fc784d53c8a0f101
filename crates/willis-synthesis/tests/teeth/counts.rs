//! The counts of `counts.json`.

use serde_json::Value;
use willis::exact::Rational;
use willis::work::Serial;
use willis_synthesis::teeth::{Design, DesignAnswer, Request};

use crate::layouts::{example, simple, wolfrom};

fn problem(id: &str) -> Value {
    let all: Value = serde_json::from_str(include_str!("counts.json")).unwrap();
    all["problems"].as_array().unwrap().iter().find(|p| p["id"] == id).unwrap().clone()
}

pub fn read(text: &str) -> Design {
    Design::from_toml(text).unwrap_or_else(|e| panic!("{}", e.render("design.toml", text, false)))
}

fn answer(design: &Design) -> DesignAnswer {
    design.answer(&Request::default(), &Serial).unwrap()
}

/// The ratio wanted in each state.
fn targets(parameters: &Value, states: &[&str]) -> String {
    let ratios = parameters["targets"].as_array().unwrap().iter().map(|t| t.as_str().unwrap());
    let all: Vec<String> =
        ratios.zip(states).map(|(ratio, state)| format!("{{ state = \"{state}\", ratio = {ratio} }}")).collect();
    all.join(", ")
}

fn number(v: &Value) -> u64 {
    v.as_u64().unwrap_or_else(|| panic!("{v} is no number"))
}

/// What is left after a condition.
fn left(answer: &DesignAnswer, condition: &str, planets: Option<&str>) -> u64 {
    let stage = answer.waterfall.iter().find(|s| s.condition == condition).unwrap();
    match planets {
        Some(n) => *stage.by_planets.get(n).unwrap(),
        None => stage.trains,
    }
}

#[test]
fn simple_sets() {
    for id in ["simple-4", "simple-5"] {
        let p = problem(id);
        let (a, r) = (&p["parameters"], &p["results"]);
        let list = |v: &Value| v.as_array().unwrap().iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
        let design = format!(
            "planets = [{}]\nmismatch = [{}]\ngap = {}\nrules = [\"assembly\", \"clearance\", \"hunting\", \"in-phase\"]\n\
             target = [{{ ratio = [{}, {}] }}]\nminimize = [\"error\", \"ring_diameter\"]",
            list(&a["planets"]),
            list(&a["mismatch"]),
            a["gap"],
            a["ratio"][0],
            a["ratio"][1]
        );
        let gear = format!("{}..{}", a["gear"][0], a["gear"][1]);
        let found = answer(&read(&simple(&gear, &format!("..{}", a["ring_max"]), &design)));
        assert_eq!(left(&found, "ratio", None), number(&r["coaxial_and_ratio"]), "{id}");
        for (n, counts) in r["per_planet_number"].as_object().unwrap() {
            let of = |c: &str| left(&found, c, Some(n));
            assert_eq!(of("assembly"), number(&counts["assembly"]), "{id} {n}");
            assert_eq!(of("clearance"), number(&counts["and_clearance"]), "{id} {n}");
            assert_eq!(of("hunting"), number(&counts["and_hunting"]), "{id} {n}");
            assert_eq!(of("in-phase"), number(&counts["and_hunting_in_phase"]), "{id} {n}");
        }
        // The nearest hunting ratio for each number of planets.
        for (n, best) in r["best_hunting"].as_object().unwrap() {
            let design = design.replace(&format!("planets = [{}]", list(&a["planets"])), &format!("planets = {n}"));
            let design = design.replace(", \"in-phase\"", "").replace("[\"error\", \"ring_diameter\"]", "[\"error\"]");
            let found = answer(&read(&simple(&gear, &format!("..{}", a["ring_max"]), &design)));
            if best.is_null() {
                assert!(found.rows.is_empty(), "{id} {n}");
                continue;
            }
            let target: Rational = a["target"].as_str().unwrap().parse().unwrap();
            let ratio = found.rows[0].states.iter().next().unwrap().1.ratio.clone().unwrap();
            assert_eq!((&ratio - &target).abs().to_string(), best["error"].as_str().unwrap(), "{id} {n}");
            assert_eq!(found.front, number(&best["number_with_that_error"]), "{id} {n}");
            let smallest: Vec<i64> = found
                .rows
                .iter()
                .min_by_key(|r| r.ring_teeth)
                .map(|r| r.sets.iter().next().unwrap().1.teeth.iter().map(|t| t.1).collect())
                .unwrap();
            let expected: Vec<i64> = serde_json::from_value(best["smallest_ring"][0].clone()).unwrap();
            assert_eq!(smallest, expected, "{id} {n}");
        }
    }
}

fn wolfrom_problem(id: &str, rules: &str) -> (Value, Design) {
    let p = problem(id);
    let a = &p["parameters"];
    let list = |v: &Value| v.as_array().unwrap().iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
    let design = format!(
        "planets = [{}]\nmismatch = [{}]\ngap = {}\nrules = {rules}\n\
         target = [{{ ratio = [{}, {}], any_sign = true }}]\nminimize = [\"ring_diameter\"]\nmaximize = [\"forward\", \"backward\"]",
        list(&a["planets"]),
        list(&a["mismatch"]),
        a["gap"],
        a["abs_ratio"][0],
        a["abs_ratio"][1]
    );
    let eta = |k: &str| a[k].as_str().unwrap().parse::<Rational>().unwrap().to_f64();
    let efficiency = format!("{{ external = {}, internal = {} }}", eta("eta_external"), eta("eta_internal"));
    let gear = format!("{}..{}", a["gear"][0], a["gear"][1]);
    let text = wolfrom(&gear, &format!("..{}", a["ring_max"]), &efficiency, &design);
    let design = read(&text);
    (p, design)
}

#[test]
fn wolfrom_drives() {
    for id in ["3k-100-small", "3k-50-shifted"] {
        let (p, design) = wolfrom_problem(id, r#"["assembly", "clearance", "hunting"]"#);
        let r = &p["results"];
        let found = answer(&design);
        assert_eq!(left(&found, "ratio", None), number(&r["coaxial_and_ratio"]), "{id}");
        for (n, counts) in r["per_planet_number"].as_object().unwrap() {
            let of = |c: &str| left(&found, c, Some(n));
            assert_eq!(of("assembly"), number(&counts["assembly"]), "{id} {n}");
            assert_eq!(of("clearance"), number(&counts["and_clearance"]), "{id} {n}");
            assert_eq!(of("hunting"), number(&counts["and_hunting"]), "{id} {n}");
        }
        let (_, design) = wolfrom_problem(id, r#"["assembly", "clearance"]"#);
        let found = design.answer(&Request { top: Some(1000), ..Request::default() }, &Serial).unwrap();
        let last = found.waterfall.last().unwrap();
        assert_eq!(last.designs, number(&r["designs_train_and_planet_number"]), "{id}");
        assert_eq!(last.trains, number(&r["distinct_trains_buildable"]), "{id}");
        assert_eq!(design.count().trains, last.trains);
        assert_eq!(design.count().designs, last.designs);
        // The front, with efficiencies of the certified solver.
        let front = &r["pareto_ring_forward_backward"];
        assert_eq!(found.front, number(&front["count_trains"]), "{id}");
        for (row, expected) in found.rows.iter().zip(front["front"].as_array().unwrap()) {
            assert_eq!(row.ring_teeth, expected[0].as_i64().unwrap());
            for (value, k) in [(row.forward, 1), (row.backward, 2)] {
                assert!((value.unwrap() - expected[k].as_f64().unwrap()).abs() < 1e-9, "{id} {row:?}");
            }
            let z = &row.sets.get("P1").unwrap().teeth;
            let teeth = ["sun", "planet_1", "planet_2", "ring_1", "ring_2"].map(|g| *z.get(g).unwrap());
            assert_eq!(serde_json::json!(teeth), expected[3], "{id}");
            assert!(row.certified && !row.self_locking);
        }
        let best = found.rows.iter().max_by(|a, b| a.forward.unwrap().total_cmp(&b.forward.unwrap())).unwrap();
        let state = &best.states.iter().next().unwrap().1;
        let exact = |v: &Option<Rational>| v.as_ref().unwrap().to_string();
        assert_eq!(exact(&state.forward_exact), r["best_forward"]["forward_exact"].as_str().unwrap());
        assert_eq!(exact(&state.backward_exact), r["best_forward"]["backward_exact"].as_str().unwrap());
        // Both signs.
        let mut negative = 0;
        let (_, design) = wolfrom_problem(id, "[]");
        design.for_each(|t| {
            let [_, p1, r1, p2, r2] = *t[0] else { panic!() };
            negative += u64::from(p1 * r2 < r1 * p2);
        });
        assert_eq!(negative, number(&r["of_these_ratio_negative"]), "{id}");
    }
}

pub const AOD: &str = r#"
format = 1
name = "Ravigneaux"
members = ["small", "large", "carrier", "ring"]
terminals = ["small", "large", "carrier", "ring"]
[[set]]
name = "P1"
type = "ravigneaux"
small_sun = { member = "small", teeth = 30 }
large_sun = { member = "large", teeth = 36 }
ring = { member = "ring", teeth = 72 }
carrier = "carrier"
mesh_efficiency = { external = 0.98, internal = 0.99 }
[[shift_element]]
name = "C"
kind = "brake"
members = ["carrier"]
[[shift_element]]
name = "L"
kind = "brake"
members = ["large"]
[[state]]
name = "1"
engaged = ["C"]
[[state]]
name = "2"
engaged = ["L"]
[[state]]
name = "O"
engaged = ["L"]
input = "carrier"
[[state]]
name = "R"
engaged = ["C"]
input = "large"
"#;

#[test]
fn ravigneaux() {
    let p = problem("ravigneaux-aod");
    let (a, r) = (&p["parameters"], &p["results"]);
    let t: Vec<&str> = a["targets"].as_array().unwrap().iter().map(|t| t.as_str().unwrap()).collect();
    let target = |state: &str, ratio: &str| format!("{{ state = \"{state}\", ratio = {ratio} }}");
    let design = format!(
        "[design]\ntolerance = 0.01\nplanets = 3\ngap = 0.5\ntarget = [{}]\nminimize = [\"error\"]",
        [target("1", t[0]), target("2", t[1]), target("O", t[2]), target("R", t[3])].join(", ")
    );
    let teeth = [
        ("P1.small_sun.teeth", "12.."),
        ("P1.large_sun.teeth", "12.."),
        ("P1.long_planet.teeth", "12.."),
        ("P1.short_planet.teeth", "12.."),
        ("P1.ring.teeth", "..120"),
    ];
    let design = read(&example(AOD, &design, &teeth));
    let found = answer(&design);
    assert_eq!(left(&found, "ratio", None), number(&r["ratio_solutions_s1_s2_pL"]));
    assert_eq!(left(&found, "assembly", None), number(&r["and_assembly"]));
    assert_eq!(left(&found, "clearance", None), number(&r["distinct_s1_s2_pL_buildable"]));
    assert_eq!(left(&found, "clearance", Some("3")), number(&r["with_short_planet_and_clearance"]));
    // The production set is the best.
    let z = &found.rows[0].sets.get("P1").unwrap().teeth;
    assert_eq!(["small_sun", "large_sun", "ring"].map(|g| *z.get(g).unwrap()), [30, 36, 72]);
}

#[test]
fn simpson() {
    let p = problem("simpson-c4");
    let (a, r) = (&p["parameters"], &p["results"]);
    let t: Vec<&str> = a["targets"].as_array().unwrap().iter().map(|t| t.as_str().unwrap()).collect();
    let layout = include_str!("../../../../examples/simpson-ford-c4.toml");
    let design = format!(
        "[design]\ntolerance = 0.01\nplanets = [3, 4]\ngap = 0.5\nminimize = [\"error\"]\n\
         target = [{{ state = \"1\", ratio = {} }}, {{ state = \"2\", ratio = {} }}, {{ state = \"R\", ratio = {} }}]",
        t[0], t[1], t[2]
    );
    let mut teeth = vec![];
    for set in ["front", "rear"] {
        teeth.push((format!("{set}.sun.teeth"), "15..60"));
        teeth.push((format!("{set}.planet.teeth"), "12.."));
        teeth.push((format!("{set}.ring.teeth"), "..120"));
    }
    let teeth: Vec<(&str, &str)> = teeth.iter().map(|(p, r)| (p.as_str(), *r)).collect();
    let design = read(&example(layout, &design, &teeth));
    assert_eq!(design.count().trains, number(&r["solutions"]));
    let found = answer(&design);
    assert_eq!(found.waterfall.last().unwrap().trains, number(&r["solutions"]));
    let mut equal = 0;
    design.for_each(|t| equal += u64::from(t[0][0] == t[1][0]));
    assert_eq!(equal, number(&r["solutions_with_equal_suns"]));
    let best: Rational = r["best_max_deviation"].as_str().unwrap().parse().unwrap();
    assert!((found.rows[0].error - best.to_f64()).abs() < 1e-12);
}

#[test]
fn lepelletier() {
    let p = problem("lepelletier-6hp26");
    let (a, r) = (&p["parameters"], &p["results"]);
    let targets = targets(a, &["1", "2", "3", "4", "5", "6", "R"]);
    let layout = include_str!("../../../../examples/zf-6hp26.toml");
    let rules = |rules: &str| {
        let design = format!(
            "[design]\ntolerance = 0.01\ngap = 0.25\nrules = {rules}\nminimize = [\"error\"]\ntarget = [{}]",
            targets
        );
        let teeth = [
            ("front.sun.teeth", "20..60"),
            ("front.planet.teeth", "12.."),
            ("front.ring.teeth", "..100"),
            ("front.planet.count", "3, 4"),
            ("rear.small_sun.teeth", "15.."),
            ("rear.large_sun.teeth", "15.."),
            ("rear.long_planet.teeth", "15.."),
            ("rear.short_planet.teeth", "15.."),
            ("rear.ring.teeth", "..100"),
            ("rear.short_planet.count", "3"),
        ];
        read(&example(layout, &design, &teeth))
    };
    // The count of the case has only fronts that can be built.
    let mut buildable = std::collections::HashSet::new();
    let (mut solutions, mut assembled, mut fronts_and_rears) = (0, 0, std::collections::HashSet::new());
    let space = willis_synthesis::teeth::SetSpace::new(
        willis_synthesis::teeth::SetKind::Simple,
        ["20..60", "12..", "..100"].map(|t| t.parse().unwrap()).to_vec(),
        willis_synthesis::teeth::Counts::range(3, 4),
    )
    .rules([willis_synthesis::teeth::Rule::Assembly, willis_synthesis::teeth::Rule::Clearance])
    .gap(willis_synthesis::teeth::fit::Length::new(1, 4).unwrap());
    buildable.extend(space.all());
    assert_eq!(buildable.len() as u64, number(&r["admissible_front_sets"]));
    rules("[]").for_each(|t| {
        if buildable.contains(t[0]) {
            solutions += 1;
            let [s1, s2, _, ring] = *t[1] else { panic!() };
            assembled += u64::from((s2 + ring) % 3 == 0 && (ring - s1) % 3 == 0);
        }
    });
    assert_eq!(solutions, number(&r["solutions_front_set_and_s1_s2_pL"]));
    assert_eq!(assembled, number(&r["and_rear_assembly"]));
    let design = rules(r#"["assembly", "clearance"]"#);
    let mut with_short = 0;
    let half = willis_synthesis::teeth::fit::Length::new(1, 4).unwrap();
    design.for_each(|t| {
        let [s1, s2, long, ring] = *t[1] else { panic!() };
        let set = willis_synthesis::teeth::fit::Ravigneaux { small_sun: s1, large_sun: s2, long, ring };
        with_short += (15..=ring).filter(|p| set.short_fits(*p, 3, half)).count() as u64;
        let front = Rational::new(t[0][2], t[0][0]).to_string();
        fronts_and_rears.insert((front, t[1].to_vec()));
    });
    assert_eq!(with_short, number(&r["with_short_planet_and_clearance"]));
    assert_eq!(fronts_and_rears.len() as u64, number(&r["distinct_front_ratio_and_rear_buildable"]));
    let found = answer(&design);
    let best: Rational = r["best_max_deviation"].as_str().unwrap().parse().unwrap();
    assert!((found.rows[0].error - best.to_f64()).abs() < 1e-12);
    let z = &found.rows[0].sets.get("rear").unwrap().teeth;
    assert_eq!(["small_sun", "large_sun", "long_planet", "ring"].map(|g| *z.get(g).unwrap()), [35, 43, 26, 95]);
}

fn eight_speeds(id: &str, suns: &str, planet: &str, ring: &str, planets: &str) -> (Value, Design) {
    let p = problem(id);
    let a = &p["parameters"];
    let targets = targets(a, &["1", "2", "3", "4", "5", "6", "7", "8", "R"]);
    let layout = include_str!("../../../../examples/zf-8hp70.toml");
    let tolerance = a["tolerance"].as_str().unwrap();
    let design = format!(
        "[design]\ntolerance = \"{tolerance}\"\nplanets = \"{planets}\"\ngap = 0.5\nminimize = [\"error\"]\ntarget = [{}]",
        targets
    );
    let mut teeth = vec![];
    for set in ["P1", "P2", "P3", "P4"] {
        teeth.push((format!("{set}.sun.teeth"), suns));
        teeth.push((format!("{set}.planet.teeth"), planet));
        teeth.push((format!("{set}.ring.teeth"), ring));
    }
    let teeth: Vec<(&str, &str)> = teeth.iter().map(|(p, r)| (p.as_str(), *r)).collect();
    let design = read(&example(layout, &design, &teeth));
    (p, design)
}

#[test]
fn eight_speeds_of_four_sets() {
    let (p, design) = eight_speeds("8hp70", "20..72", "15..", "..120", "3..5");
    let r = &p["results"];
    assert_eq!(design.count().trains, number(&r["tooth_combinations"]));
    // Every one of them by itself: distinct basic ratios, and the least largest deviation.
    let ratio = |z: &[i64]| {
        let g = willis_synthesis::teeth::fit::gcd(z[2], z[0]);
        (z[2] / g, z[0] / g)
    };
    let mut distinct = std::collections::HashSet::new();
    let mut trains = 0;
    design.for_each(|t| {
        trains += 1;
        distinct.insert([0, 1, 2, 3].map(|k| ratio(t[k])));
    });
    assert_eq!(trains, number(&r["tooth_combinations"]));
    assert_eq!(distinct.len() as u64, number(&r["distinct_ratio_quadruples"]));
    let found = answer(&design);
    assert_eq!((found.front, found.waterfall.last().unwrap().trains), (1, trains));
    let best: Vec<String> = found.rows[0]
        .sets
        .iter()
        .map(|(_, s)| Rational::new(*s.teeth.get("ring").unwrap(), *s.teeth.get("sun").unwrap()).to_string())
        .collect();
    assert_eq!(serde_json::json!(best), r["best_k1_k2_k3_k4"]);
    assert!((found.rows[0].error - r["best_max_deviation"].as_f64().unwrap()).abs() < 1e-12);
}

#[test]
fn eight_speeds_of_few_suns_are_those_of_brute_force() {
    let (p, design) = eight_speeds("8hp-brute", "23, 24, 28, 48, 60, 69", "18..", "..112", "3");
    let r = &p["results"];
    let found = answer(&design);
    assert_eq!(found.waterfall.last().unwrap().trains, number(&r["tooth_combinations"]));
    let best = &found.rows[0];
    assert_eq!(found.front, 1);
    assert!((best.error - r["best_max_deviation"].as_f64().unwrap()).abs() < 1e-12);
    for ((_, state), expected) in best.states.iter().zip(r["best_ratios"].as_array().unwrap()) {
        assert_eq!(state.ratio.as_ref().unwrap().to_string(), expected.as_str().unwrap());
        assert!(state.forward.unwrap() <= 1.0);
    }
    for (row, expected) in best.sets.iter().zip(r["best_tooth_sets"].as_array().unwrap()) {
        let teeth: Vec<i64> = row.1.teeth.iter().map(|t| t.1).collect();
        assert_eq!(serde_json::json!(teeth), expected[0]);
    }
}
