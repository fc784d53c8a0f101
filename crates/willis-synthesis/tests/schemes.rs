//! Spaces of shift schemes that are finished, and counts that must come out.

use std::collections::BTreeMap;

use willis::Train;
use willis::work::{Serial, Work};
use willis_synthesis::schemes::{
    Harvest, HybridWish, Hybrids, KNOWN, Known, Layout, ModeKind, Order, Scheme, Schemes, Search, SetRatio, Wish,
    hybrids,
};
use willis_synthesis::teeth::{Design, Request};

fn wish(sets: &[&str], [elements, closed, forward]: [usize; 3], ranges: [&str; 3]) -> Wish {
    let mut wish = Wish::new(sets, elements, closed, forward).unwrap();
    [wish.forward_range, wish.step, wish.reverse_range] = ranges.map(|r| r.parse().unwrap());
    wish
}

const TWO_SETS: [&str; 2] = ["62/26", "74/42"];
const ALLISON: [&str; 3] = ["109/67", "91/49", "97/39"];
const ZF: [&str; 4] = ["96/48", "96/48", "111/69", "85/23"];
const TWO_SET_RANGES: [&str; 3] = ["1/2..5", "1.15..2.2", "1.2..5"];

fn counts(answer: &Schemes) -> [u64; 5] {
    let found = &answer.found;
    [answer.space.examined, answer.space.choices, found.layouts, found.schemes, found.classes]
}

fn run(wish: &Wish) -> Schemes {
    let start = std::time::Instant::now();
    let answer = Search::new(wish).unwrap().run(&Serial).unwrap();
    println!("{:?} for {}", start.elapsed(), answer.completeness.statement);
    assert!(answer.completeness.complete);
    answer
}

#[test]
fn two_sets_four_elements_three_speeds() {
    let answer = run(&wish(&TWO_SETS, [4, 2, 3], TWO_SET_RANGES));
    assert_eq!(counts(&answer), [882, 365_346, 185, 653, 361]);
    assert_eq!(answer.found.by_brakes, BTreeMap::from([(0, 111), (1, 338), (2, 204)]));
}

#[test]
fn two_sets_five_elements_four_speeds() {
    let answer = run(&wish(&TWO_SETS, [5, 2, 4], TWO_SET_RANGES));
    assert_eq!(counts(&answer), [882, 470_736, 75, 350, 146]);
    assert_eq!(answer.found.by_brakes, BTreeMap::from([(0, 37), (1, 113), (2, 174), (3, 26)]));
}

#[test]
fn three_sets_six_speeds() {
    let answer = run(&wish(&ALLISON, [5, 2, 6], ["1/2..6", "1.1..2.2", "1.5..7"]));
    assert_eq!(counts(&answer), [149_580, 790_732_530, 4246, 23_816, 11_433]);
    assert_eq!(answer.found.by_brakes, BTreeMap::from([(0, 4561), (1, 12_125), (2, 6264), (3, 866)]));
}

#[test]
fn elements_on_the_layout_of_the_8hp() {
    let wish = Wish {
        layout: Some("345360678751".parse().unwrap()),
        ..wish(&ZF, [5, 3, 8], ["1/2..6", "1.1..1.8", "1.5..6"])
    };
    let answer = run(&wish);
    assert_eq!(counts(&answer), [1, 219_396, 1, 6, 2]);
    let ids: Vec<&str> = answer.schemes.iter().map(|s| s.id.as_str()).collect();
    let expected = [
        "345360678751 07 18 23 24 67",
        "345360678751 07 18 23 24 68",
        "345360678751 07 18 23 24 78",
        "345360678751 07 23 24 58 67",
        "345360678751 07 23 24 58 68",
        "345360678751 07 23 24 58 78",
    ];
    assert_eq!(ids, expected);
    assert_eq!(answer.schemes[0].known.as_deref(), Some("ZF 8HP70"));
}

#[test]
fn hybrids_of_two_sets() {
    use ModeKind::*;
    let need = ["input-split", "compound-split", "electric", "fixed"];
    let mut wish = HybridWish::new(&["17/10", "23/10"], 3, &need).unwrap();
    wish.top = usize::MAX;
    let answer = hybrids(&wish, &Serial).unwrap();
    assert_eq!([answer.layouts, answer.kinematic, answer.designs_found], [900, 2088, 3240]);
    let expected = BTreeMap::from([
        (CompoundSplit, 864),
        (EngineGearedToOutput, 1512),
        (InputAndOutputGeared, 360),
        (InputSplit, 1224),
        (MotorsGearedTogether, 1332),
        (OneAtRest, 2628),
        (OutputSplit, 1224),
        (Charging, 2700),
        (Electric, 7668),
        (Fixed, 2196),
        (FixedWithMotor, 23_724),
        (Nothing, 5652),
    ]);
    assert_eq!(answer.modes, expected);
    assert_eq!(answer.designs.len(), 2088);
    // The second generation of the Volt: engine on ring 1, motors on the suns, output on both carriers; ring 2 is held
    // or joined to motor A, and a brake holds the engine.
    let volt = answer.designs.iter().find(|d| d.id == "301451 02 25 35").unwrap();
    let split = volt.modes.iter().find(|m| m.kind == InputSplit).unwrap();
    assert_eq!(split.closed, ["C2"]);
    // Sun 1 at rest: the engine turns (1 + k)/k times as fast as the carrier.
    assert_eq!(split.mechanical_points[0].to_string(), "27/17");
    let json = serde_json::to_string(&answer).unwrap();
    assert_eq!(serde_json::from_str::<Hybrids>(&json).unwrap(), answer);
}

#[test]
fn schemes_are_train_files_with_the_same_ratios() {
    let mut spaces = vec![wish(&ALLISON, [5, 2, 6], ["1/2..6", "1.1..2.2", "1.5..7"])];
    spaces[0].layout = Some("034546561".parse().unwrap());
    spaces.push(wish(&["1.7", "2.3"], [4, 2, 3], TWO_SET_RANGES));
    spaces[1].top = 40;
    let mut gears = 0;
    for wish in &spaces {
        for scheme in run(wish).schemes {
            let train =
                willis::Train::from_toml(&scheme.to_toml()).unwrap_or_else(|e| panic!("{}: {e}", scheme.to_toml()));
            let analysis = willis::analyze(&train, &willis::Selection::default()).unwrap();
            for gear in scheme.gears.iter().chain(&scheme.reverse) {
                assert_eq!(analysis.ratios.get(&gear.name).unwrap().exact.as_ref(), Some(&gear.ratio));
                gears += 1;
            }
        }
    }
    assert!(gears > 100);
}

#[test]
fn known_transmissions_are_found_in_their_spaces() {
    let spaces = [
        ("gm-440-t4", wish(&TWO_SETS, [5, 2, 4], TWO_SET_RANGES)),
        ("allison", wish(&ALLISON, [5, 2, 6], ["1/2..6", "1.1..2.2", "1.5..7"])),
        ("8hp", wish(&ZF, [5, 3, 8], ["1/2..6", "1.1..1.8", "1.5..6"])),
    ];
    for (name, wish) in spaces {
        let known = Known::named(name).unwrap();
        let found = known.rediscover(&Search::new(&wish).unwrap());
        assert!(found.found, "{name}");
        assert_eq!(found.scheme.unwrap().known.as_deref(), Some(known.name));
        // Steps that it does not have.
        let other = Wish { step: "1.1..1.2".parse().unwrap(), ..wish };
        assert!(!known.rediscover(&Search::new(&other).unwrap()).found);
    }
    assert!(Known::named("").is_none() && Known::named("zz").is_none());
}

/// Stops after some parts.
struct Stopping(std::sync::atomic::AtomicUsize);

impl Work for Stopping {
    fn cancelled(&self) -> bool {
        self.0.load(std::sync::atomic::Ordering::Relaxed) == 0
    }

    fn advance(&self, _: u64) {
        self.0.fetch_sub(1, std::sync::atomic::Ordering::Relaxed);
    }
}

#[test]
fn a_stopped_search_goes_on_and_gives_the_same_bytes() {
    let wish = Wish { order: Order::Torque, top: 20, ..wish(&TWO_SETS, [5, 2, 4], TWO_SET_RANGES) };
    let search = Search::new(&wish).unwrap();
    let whole = serde_json::to_string(&search.run(&Serial).unwrap()).unwrap();
    let mut harvest = Harvest::default();
    search.harvest(&Stopping(7.into()), 0..search.parts(), &mut harvest);
    assert_eq!(harvest.done(), 7);
    let part = search.answer(&harvest);
    assert!(!part.completeness.complete && part.completeness.statement.contains("% of the parts"));
    let mut harvest: Harvest = serde_json::from_str(&serde_json::to_string(&harvest).unwrap()).unwrap();
    search.harvest(&Serial, 0..search.parts(), &mut harvest);
    let answer = search.answer(&harvest);
    assert_eq!(serde_json::to_string(&answer).unwrap(), whole);
    assert_eq!(serde_json::from_str::<Schemes>(&whole).unwrap(), answer);
    assert!(answer.schemes.windows(2).all(|w| w[0].max_torque <= w[1].max_torque * (1.0 + 1e-12)));
    // Parts are given once, and to the search that they belong to.
    let again = harvest.clone();
    assert!(harvest.merge(&search, again).is_err());
}

#[test]
fn limits_are_closed_and_exact() {
    let wish = wish(&TWO_SETS, [5, 2, 4], TWO_SET_RANGES);
    let all = run(&Wish { order: Order::Torque, top: usize::MAX, ..wish.clone() });
    let middle = &all.schemes[all.schemes.len() / 2];
    let gears = middle.gears.iter().chain(&middle.reverse);
    let most = gears.flat_map(|g| &g.torques).map(|(_, t)| t.abs()).fold(0.0, f64::max);
    assert_eq!(most, middle.max_torque);
    // All torques here are fractions of small numbers, and this is one of them.
    let limit = (1..20_000).find_map(|d| {
        let n = (most * f64::from(d)).round();
        ((n / f64::from(d) - most).abs() < 1e-14).then(|| willis::exact::Rational::new(n as i64, i64::from(d)))
    });
    let limit = limit.unwrap();
    let below = &limit - &willis::exact::Rational::new(1, 1_000_000_000_000);
    let left = |limit| run(&Wish { max_torque: Some(limit), ..wish.clone() }).found.schemes;
    let at_most = all.schemes.iter().filter(|s| s.max_torque <= most + 1e-12).count() as u64;
    let touching = all.schemes.iter().filter(|s| (s.max_torque - most).abs() < 1e-12).count() as u64;
    assert!(touching > 0);
    assert_eq!([left(limit), left(below)], [at_most, at_most - touching]);
    let planar = run(&Wish { planar: true, ..wish.clone() }).found.schemes;
    assert_eq!(planar, all.schemes.iter().filter(|s| s.planar).count() as u64);
    let brakes = run(&Wish { max_brakes: Some(1), ..wish }).found.schemes;
    assert_eq!(brakes, 37 + 113);
}

#[test]
fn an_empty_answer_says_what_must_give_way() {
    let wish = wish(&TWO_SETS, [4, 2, 4], ["1/2..5", "1.15..1.2", "1.2..5"]);
    let mut answer = run(&wish);
    assert_eq!(answer.found.schemes, 0);
    answer.relax(&Serial);
    let step = answer.relaxations.iter().find(|r| r.change.starts_with("steps of any size")).unwrap();
    assert!(step.schemes.unwrap() > 0, "{:?}", answer.relaxations);
}

#[test]
fn bad_wishes_are_refused_in_words() {
    let good = wish(&TWO_SETS, [5, 2, 4], TWO_SET_RANGES);
    let say = |wish: Wish| Search::new(&wish).unwrap_err().to_string();
    assert!(say(Wish { forward: 12, ..good.clone() }).contains("in 10 ways, too few for 12 forward and 1 reverse"));
    assert!(say(Wish { closed: 7, ..good.clone() }).contains("7 closed elements"));
    assert!(say(Wish { elements: 1, closed: 2, ..good.clone() }).contains("2 of 1 elements"));
    assert!(say(Wish { sets: vec![], ..good.clone() }).contains("there are 0 sets"));
    assert!(say(Wish { layout: "333".parse().ok().or("034546561".parse().ok()), ..good.clone() }).contains("3 sets"));
    let steep = Wish { step: "2..3".parse().unwrap(), forward: 6, ..good.clone() };
    assert!(say(steep).contains("span 32.000, more than the range"));
    assert!("0.9".parse::<SetRatio>().unwrap_err().contains("not above 1"));
    // A space that takes more than an hour: its size, and how to narrow it.
    let large = wish(&["2", "16/9", "9/5", "4"], [5, 3, 8], ["1/2..6", "1.1..1.8", "1.5..6"]);
    let refused = Search::new(&large).unwrap().run(&Serial).unwrap_err().to_string();
    assert!(refused.contains("18428400 layouts") && refused.contains("minutes of one core"), "{refused}");
    assert!(refused.contains("5.1e12 choices") && refused.contains("`sample`"), "{refused}");
    let hybrid = HybridWish::new(&["2"], 3, &["split"]).unwrap_err();
    assert!(hybrid.contains("no kind of mode; there are input-split"), "{hybrid}");
    assert!(HybridWish::new(&["2"], 3, &["fixed"]).unwrap().check().is_err());
}

/// The way from a scheme to its teeth: real transmissions get back the teeth that gave their ratios.
#[test]
fn val_schemes_of_real_teeth_get_these_teeth_back() {
    for known in KNOWN {
        let base =
            wish(known.sets, [known.elements().len(), known.closed, known.forward], ["0.5..6", "1.05..2.2", "1.2..7"]);
        let wish = Wish { layout: known.layout(), ..base };
        let scheme = known.rediscover(&Search::new(&wish).unwrap()).scheme.unwrap();
        let text = scheme.to_design(&wish);
        let design = Design::from_toml(&text).unwrap_or_else(|e| panic!("{}: {e:?}\n{text}", known.name));
        let own = Some((known.name.to_owned(), scheme.to_toml()));
        let started = std::time::Instant::now();
        let answer = design.answer(&Request { own, ..Request::default() }, &Serial).unwrap();
        println!("{}: {:?} {}", known.name, started.elapsed(), answer.completeness.statement);
        assert!(answer.completeness.complete && answer.rows[0].error < 0.005, "{}", known.name);
        let own = answer.own.unwrap();
        assert!(own.fails.is_empty(), "{}: {:?}", known.name, own.fails);
        assert!(own.row.states.iter().all(|(_, s)| s.ratio == s.target), "{}", known.name);
        // Sorted by deviation: the first row has the ratios of the scheme exactly.
        assert!(answer.rows[0].states.iter().all(|(_, s)| s.ratio == s.target), "{}", known.name);
        // A row is the scheme with these teeth: the same elements in the same gears.
        let train = Train::from_toml(&design.train_file(&answer.rows[0])).unwrap();
        let (layout, _) = Layout::of_train(&train).unwrap();
        assert_eq!(layout, scheme.layout, "{}", known.name);
    }
}

/// The efficiency by which the search orders and limits, against the certified analysis of the train files.
#[test]
fn efficiencies_of_the_search_are_those_of_the_certified_solver() {
    let lowest = |scheme: &Scheme| {
        let all = scheme.gears.iter().chain(&scheme.reverse).map(|g| g.efficiency);
        all.collect::<Option<Vec<f64>>>().map(|all| all.into_iter().fold(1.0, f64::min))
    };
    for (meshes, [elements, forward]) in [(["0.98", "0.99"], [4, 3]), (["0.9", "0.85"], [5, 4]), (["1", "1"], [5, 4])] {
        let base = Wish { top: usize::MAX, ..wish(&TWO_SETS, [elements, 2, forward], TWO_SET_RANGES) };
        let mesh_efficiencies = meshes.map(|t| t.parse().unwrap());
        let wish = Wish { order: Order::Efficiency, mesh_efficiencies, ..base };
        let mut answer = run(&wish);
        answer.rate(&Serial);
        let all: Vec<Option<f64>> = answer.schemes.iter().map(lowest).collect();
        // Best first, by the numbers of the certified solver; what has none is last.
        assert!(all.windows(2).all(|w| w[0].unwrap_or(0.0) >= w[1].unwrap_or(0.0) - 1e-9), "{meshes:?} {all:?}");
        println!(
            "{meshes:?}: {:?} to {:?}, {} without",
            all[0],
            all.iter().rfind(|e| e.is_some()),
            all.iter().filter(|e| e.is_none()).count()
        );
        // A limit leaves those that reach it, counted by the certified solver; one that is just reached holds.
        for at in [0, all.len() / 3, all.len() / 2] {
            let Some(limit) = all[at] else { continue };
            let limit = limit - 1e-9;
            let left = all.iter().flatten().filter(|e| **e >= limit).count();
            let min_efficiency = willis::exact::Rational::from_f64(limit);
            let limited = run(&Wish { min_efficiency, ..wish.clone() });
            assert_eq!(limited.found.schemes, left as u64, "{meshes:?} {limit}");
        }
    }
    let all = Wish { min_efficiency: Some("0.999".parse().unwrap()), ..wish(&TWO_SETS, [5, 2, 4], TWO_SET_RANGES) };
    let mut none = run(&all);
    none.relax(&Serial);
    let way = none.relaxations.iter().find(|r| r.change.starts_with("efficiencies of any size")).unwrap();
    assert!(way.schemes == Some(350) && way.until.is_some_and(|e| e > 0.9 && e < 0.999), "{way:?}");
    let wrong = Wish { min_efficiency: Some("1.2".parse().unwrap()), ..all };
    assert!(wrong.check().unwrap_err().to_string().contains("an efficiency of"));
}
