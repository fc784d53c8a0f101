//! Designs: counts of whole spaces beside those of an independent program, production tooth numbers, published optima, and
//! what published counts leave open.

use std::collections::BTreeSet;

use willis::contract::Format;
use willis::exact::Rational;
use willis::work::Serial;
use willis_synthesis::schemes::{HybridWish, Known, ModeKind, Search, Wish, hybrids};
use willis_synthesis::teeth::{Design, DesignAnswer, Request};

use crate::{AcceptanceBound, Cell, Report, Section, answer, train};

const AOD: &str = include_str!("../data/design/ford-aod.toml");
const SIMPSON: &str = include_str!("../data/design/simpson.toml");
const EIGHT: &str = include_str!("../data/design/zf-8hp.toml");

/// One section of counts that must be equal.
struct Counts<'a> {
    section: Section,
    case: String,
    report: &'a mut Report,
}

impl<'a> Counts<'a> {
    fn new(report: &'a mut Report, title: &str, text: &[&str]) -> Self {
        let columns = ["space", "what", "independent", "Willis", "verdict"];
        Self { section: Section::new(title, text, &columns), case: String::new(), report }
    }

    fn of(&mut self, case: &str) {
        self.case = case.to_owned();
    }

    fn equal(&mut self, what: &str, expected: u64, ours: u64) {
        let exact = [expected as f64; 2];
        let gate = AcceptanceBound::new(format!("{}: {what}", self.case), expected.to_string(), ours as f64, exact);
        self.section.row([
            self.case.as_str().into(),
            what.into(),
            (expected as f64, 0).into(),
            (ours as f64, 0).into(),
            gate.verdict().into(),
        ]);
        self.report.gates.push(gate);
    }

    fn near(&mut self, what: &str, expected: f64, ours: Option<f64>, within: f64) {
        let ours = ours.unwrap_or(f64::NAN);
        let bounds = [expected - within, expected + within];
        let gate = AcceptanceBound::new(format!("{}: {what}", self.case), format!("{expected}"), ours, bounds);
        self.section.row([
            self.case.as_str().into(),
            what.into(),
            (expected, 9).into(),
            (ours, 9).into(),
            gate.verdict().into(),
        ]);
        self.report.gates.push(gate);
    }

    fn end(self) {
        self.report.sections.push(self.section);
    }
}

fn design(text: &str) -> Design {
    Design::from_toml(text).unwrap_or_else(|e| panic!("a design of the case book is good: {e}"))
}

fn found(design: &Design, top: usize) -> DesignAnswer {
    let request = Request { top: Some(top), recompute: Some(0), ..Request::default() };
    design.answer(&request, &Serial).unwrap_or_else(|e| panic!("a design of the case book has an answer: {e}"))
}

/// What is left after a condition: trains, or designs with so many planets.
fn left(answer: &DesignAnswer, condition: &str, planets: Option<i64>) -> u64 {
    let stage = answer.waterfall.iter().find(|s| s.condition == condition);
    let of = |s: &willis_synthesis::teeth::Stage| match planets {
        Some(n) => s.by_planets.get(&n.to_string()).copied().unwrap_or(0),
        None => s.trains,
    };
    stage.map_or(0, of)
}

fn teeth<const N: usize>(answer: &DesignAnswer, row: usize, set: &str, gears: [&str; N]) -> [i64; N] {
    let own = answer.rows.get(row).and_then(|r| r.sets.get(set));
    gears.map(|g| own.and_then(|s| s.teeth.get(g)).copied().unwrap_or(0))
}

fn simple(gears: &str, ring: i64, wish: &str) -> String {
    format!(
        "format = 1\nname = \"reducer\"\nmembers = [\"sun\", \"carrier\"]\nterminals = [\"sun\", \"carrier\"]\n\
         [design]\n{wish}\n[[set]]\nname = \"P1\"\nsun = {{ member = \"sun\", teeth = \"{gears}\" }}\n\
         planet = {{ teeth = \"{gears}\" }}\nring = {{ member = \"frame\", teeth = \"..{ring}\" }}\n\
         carrier = \"carrier\"\nmesh_efficiency = 0.99\n"
    )
}

fn wolfrom(gears: &str, ring: i64, [external, internal]: [f64; 2], wish: &str) -> String {
    format!(
        "format = 1\nname = \"3K drive\"\nmembers = [\"sun\", \"carrier\", \"ring\"]\nterminals = [\"sun\", \"ring\"]\n\
         [design]\n{wish}\n[[set]]\nname = \"P1\"\ntype = \"stepped\"\n\
         suns = [{{ member = \"sun\", teeth = \"{gears}\", planet_teeth = \"{gears}\" }}]\n\
         rings = [\n{{ member = \"frame\", teeth = \"..{ring}\", planet_teeth = \"{gears}\" }},\n\
         {{ member = \"ring\", teeth = \"..{ring}\", planet_teeth = \"{gears}\" }},\n]\n\
         carrier = \"carrier\"\nmesh_efficiency = {{ external = {external}, internal = {internal} }}\n"
    )
}

fn simple_sets(c: &mut Counts<'_>) {
    type Row = (i64, [u64; 4]);
    type Space = (&'static str, &'static str, i64, &'static str, u64, &'static [Row]);
    let cases: [Space; 2] = [
        (
            "one set, ratio 3.9 to 4.1, teeth 12 to 120, ring to 300",
            "ratio = [3.9, 4.1]",
            300,
            "planets = [3, 4, 5]\nmismatch = [0]",
            498,
            &[(3, [168, 168, 81, 0]), (4, [251, 251, 80, 0]), (5, [99, 99, 58, 0])],
        ),
        (
            "one set, ratio 4.95 to 5.05, ring to 120, one tooth off allowed",
            "ratio = [4.95, 5.05]",
            120,
            "planets = [3, 4, 5, 6]\nmismatch = [-1, 0, 1]",
            60,
            &[(3, [21, 21, 8, 3]), (4, [10, 10, 5, 0]), (5, [28, 0, 0, 0]), (6, [7, 0, 0, 0])],
        ),
    ];
    for (name, ratio, ring, more, all, planets) in cases {
        let wish = format!(
            "{more}\ngap = 0.5\nrules = [\"assembly\", \"clearance\", \"hunting\", \"in-phase\"]\ntarget = [{{ {ratio} }}]\n\
             minimize = [\"error\", \"ring_diameter\"]"
        );
        let answer = found(&design(&simple("12..120", ring, &wish)), 1);
        c.of(name);
        c.equal("coaxial, with the ratio", all, left(&answer, "ratio", None));
        for (n, counts) in planets {
            for (rule, expected) in ["assembly", "clearance", "hunting", "in-phase"].iter().zip(counts) {
                c.equal(&format!("{n} planets, after {rule}"), *expected, left(&answer, rule, Some(*n)));
            }
        }
    }
}

fn wolfrom_drives(c: &mut Counts<'_>) {
    struct Drive {
        name: &'static str,
        gears: &'static str,
        ring: i64,
        ratio: &'static str,
        more: &'static str,
        efficiencies: [f64; 2],
        all: u64,
        planets: &'static [(i64, [u64; 3])],
        designs: u64,
        trains: u64,
        front: u64,
        best: [f64; 2],
    }
    let drives = [
        Drive {
            name: "3K, ratio ±99 to ±101, gears 12 to 60, rings to 120",
            gears: "12..60",
            ring: 120,
            ratio: "[99, 101]",
            more: "planets = [3, 4, 5, 6]\nmismatch = [0]\ngap = 0",
            efficiencies: [0.98, 0.99],
            all: 130,
            planets: &[(3, [44, 43, 5]), (4, [37, 24, 2]), (5, [31, 9, 2]), (6, [26, 1, 0])],
            designs: 77,
            trains: 63,
            front: 9,
            best: [26755.0 / 31878.0, 402_241.0 / 493_659.0],
        },
        Drive {
            name: "3K, ratio ±49 to ±51, gears 12 to 40, rings to 90, one tooth off allowed",
            gears: "12..40",
            ring: 90,
            ratio: "[49, 51]",
            more: "planets = [3, 4, 5]\nmismatch = [-1, 0, 1]\ngap = 0.5",
            efficiencies: [0.99, 0.995],
            all: 1152,
            planets: &[(3, [142, 136, 22]), (4, [81, 50, 5]), (5, [65, 26, 5])],
            designs: 212,
            trains: 188,
            front: 11,
            best: [1_945_987.0 / 2_066_962.0, 612_931_209.0 / 652_896_314.0],
        },
    ];
    for d in drives {
        let wish = |rules: &str| {
            format!(
                "{}\nrules = {rules}\ntarget = [{{ ratio = {}, any_sign = true }}]\nminimize = [\"ring_diameter\"]\n\
                 maximize = [\"forward\", \"backward\"]",
                d.more, d.ratio
            )
        };
        let text = |rules: &str| wolfrom(d.gears, d.ring, d.efficiencies, &wish(rules));
        let hunting = found(&design(&text("[\"assembly\", \"clearance\", \"hunting\"]")), 1);
        c.of(d.name);
        c.equal("coaxial, with the ratio", d.all, left(&hunting, "ratio", None));
        for (n, counts) in d.planets {
            for (rule, expected) in ["assembly", "clearance", "hunting"].iter().zip(counts) {
                c.equal(&format!("{n} planets, after {rule}"), *expected, left(&hunting, rule, Some(*n)));
            }
        }
        let answer = found(&design(&text("[\"assembly\", \"clearance\"]")), 100);
        let last = answer.waterfall.last();
        c.equal("with some number of planets", d.trains, last.map_or(0, |s| s.trains));
        c.equal("with every number of planets", d.designs, last.map_or(0, |s| s.designs));
        c.equal("front of ring, forward and backward efficiency", d.front, answer.front);
        let best = answer.rows.iter().max_by(|a, b| a.forward.unwrap_or(0.0).total_cmp(&b.forward.unwrap_or(0.0)));
        c.near("largest efficiency forward", d.best[0], best.and_then(|r| r.forward), 1e-12);
        c.near("  its efficiency backward", d.best[1], best.and_then(|r| r.backward), 1e-12);
    }
}

/// Coupled sets, with what was found of the AOD and the 8HP for the production sets.
fn coupled_sets(c: &mut Counts<'_>) -> [DesignAnswer; 2] {
    let aod = found(&design(AOD), 5);
    c.of("Ravigneaux, ratios of the Ford AOD within 1 %, ring to 120");
    c.equal("tooth numbers with the ratios", 23, left(&aod, "ratio", None));
    c.equal("with 3 planets assembled", 4, left(&aod, "assembly", None));
    c.equal("that clear, too", 4, left(&aod, "clearance", None));
    c.equal("  with every short planet", 56, left(&aod, "clearance", Some(3)));
    let simpson = design(SIMPSON);
    c.of("Simpson, ratios of the Ford C4 within 1 %, rings to 120");
    c.equal("pairs of sets", 710, simpson.count().trains);
    let best = found(&simpson, 1);
    c.near("least largest deviation of a ratio", 1.0 / 2701.0, best.rows.first().map(|r| r.error), 1e-12);
    let eight = design(EIGHT);
    c.of("8HP, nine ratios within 1 %, suns 20 to 72, rings to 120");
    c.equal("combinations of four sets", 293_667, eight.count().trains);
    let answer = found(&eight, 1);
    c.near("least largest deviation of a ratio", 4.999_750_012_499_375e-5, answer.rows.first().map(|r| r.error), 1e-12);
    [aod, answer]
}

fn wish(sets: &[&str], [elements, closed, forward]: [usize; 3], ranges: [&str; 3]) -> Wish {
    let mut wish = Wish::new(sets, elements, closed, forward).expect("tooth ratios of the case book are good");
    [wish.forward_range, wish.step, wish.reverse_range] = ranges.map(|r| r.parse().expect("a range"));
    wish
}

const TWO_SETS: [&str; 2] = ["62/26", "74/42"];
const TWO_RANGES: [&str; 3] = ["1/2..5", "1.15..2.2", "1.2..5"];
const ZF: [&str; 4] = ["96/48", "96/48", "111/69", "85/23"];
const ZF_RANGES: [&str; 3] = ["1/2..6", "1.1..1.8", "1.5..6"];

fn schemes(report: &mut Report) {
    let text = [
        "Sets with different tooth ratios; a scheme is a layout with elements of which no two do the same, a state for each gear, \
         one element off and one on from gear to gear, no element too many, no shaft that leads nowhere.",
        "The space of three sets with five elements, 790 732 530 schemes of which 23 816 have six gears and reverse, is \
         counted in the tests: it takes seconds, and this page is written while one waits.",
    ];
    let mut c = Counts::new(report, "Counts of shift schemes and hybrids", &text);
    let mut eight = wish(&ZF, [5, 3, 8], ZF_RANGES);
    eight.layout = "345360678751".parse().ok();
    let cases = [
        (
            "2 sets, 2 of 4 elements closed, 3 forward gears and reverse",
            wish(&TWO_SETS, [4, 2, 3], TWO_RANGES),
            [882, 365_346, 185, 653, 361],
        ),
        (
            "2 sets, 2 of 5 elements closed, 4 forward gears and reverse",
            wish(&TWO_SETS, [5, 2, 4], TWO_RANGES),
            [882, 470_736, 75, 350, 146],
        ),
        (
            "permanent connections of the 8HP, 3 of 5 elements closed, 8 forward gears and reverse",
            eight,
            [1, 219_396, 1, 6, 2],
        ),
    ];
    for (name, wish, [layouts, choices, with, all, classes]) in cases {
        c.of(name);
        let search = Search::new(&wish).unwrap_or_else(|e| panic!("a wish of the case book is good: {e}"));
        let answer = search.run(&Serial).unwrap_or_else(|e| panic!("a wish of the case book has an answer: {e}"));
        c.equal("layouts", layouts, answer.space.examined);
        c.equal("choices of elements", choices, answer.space.choices);
        c.equal("layouts with a scheme", with, answer.found.layouts);
        c.equal("schemes", all, answer.found.schemes);
        c.equal("  that differ in what they do", classes, answer.found.classes);
    }
    c.of("hybrids of 2 sets with 3 clutches: input split, compound split, electric, fixed gear");
    let need = ["input-split", "compound-split", "electric", "fixed"];
    let wish = HybridWish::new(&["17/10", "23/10"], 3, &need).expect("the wish of the case book is good");
    let answer = hybrids(&wish, &Serial).unwrap_or_else(|e| panic!("hybrids of the case book have an answer: {e}"));
    c.equal("layouts, motors exchanged counted once", 900, answer.layouts);
    c.equal("designs that differ in what they do", 2088, answer.kinematic);
    c.equal("  with every place of their clutches", 3240, answer.designs_found);
    let modes = [
        ("modes: compound split", ModeKind::CompoundSplit, 864),
        ("modes: input split", ModeKind::InputSplit, 1224),
        ("modes: output split", ModeKind::OutputSplit, 1224),
        ("modes: electric", ModeKind::Electric, 7668),
        ("modes: fixed gear", ModeKind::Fixed, 2196),
    ];
    for (what, kind, expected) in modes {
        c.equal(what, expected, answer.modes.get(&kind).copied().unwrap_or(0));
    }
    c.end();
}

/// Transmissions that were built, looked for in the spaces around them.
fn production(report: &mut Report, [aod, eight]: &[DesignAnswer; 2]) {
    let mut s = Section::new(
        "Production tooth numbers",
        &[
            "What is built must be in its space, and one may ask how good it is there. Tooth numbers and ratios: Ford AOD, service \
             bulletin on the AOD and 440-T4; ZF 8HP70 and ZF 6HP26, Wikipedia articles on these transmissions.",
        ],
        &["transmission", "question", "as built", "Willis", "verdict"],
    );
    let mut row = |name: &str, question: &str, built: String, ours: String, holds: bool| {
        let gate = AcceptanceBound::new(format!("{name}: {question}"), &built, f64::from(u8::from(holds)), [1.0, 1.0]);
        s.row([name.into(), question.into(), built.into(), ours.into(), gate.verdict().into()]);
        report.gates.push(gate);
    };
    let list = |z: &[i64]| z.iter().map(i64::to_string).collect::<Vec<_>>().join("/");
    let built = [30, 36, 72];
    let ours = teeth(aod, 0, "R1", ["small_sun", "large_sun", "ring"]);
    row("Ford AOD", "suns and ring with the least error of the four ratios", list(&built), list(&ours), ours == built);
    let built = [[48, 96], [48, 96], [69, 111], [23, 85]];
    let own = ["P1", "P2", "P3", "P4"].map(|set| teeth(eight, 0, set, ["sun", "ring"]));
    let ratio = |z: &[i64; 2]| Rational::new(z[1], z[0].max(1)).to_string();
    let ratios = |all: &[[i64; 2]; 4]| all.iter().map(ratio).collect::<Vec<_>>().join(", ");
    let same = ratios(&own) == ratios(&built);
    row("ZF 8HP70", "basic ratios with the least error of the nine ratios", ratios(&built), ratios(&own), same);
    let one = eight.front == 1;
    row("ZF 8HP70", "how many basic ratios are as good", "1".into(), eight.front.to_string(), one);
    let spaces = [
        ("GM 440-T4", "gm-440-t4", wish(&TWO_SETS, [5, 2, 4], TWO_RANGES)),
        ("Allison 2000", "allison", wish(&["109/67", "91/49", "97/39"], [5, 2, 6], ["1/2..6", "1.1..2.2", "1.5..7"])),
        ("ZF 8HP70", "8hp", wish(&ZF, [5, 3, 8], ZF_RANGES)),
    ];
    for (name, key, wish) in spaces {
        let known = Known::named(key);
        let search = Search::new(&wish).ok();
        let is_found = known.zip(search).is_some_and(|(k, s)| k.rediscover(&s).found);
        let told = if is_found { "yes" } else { "no" };
        row(name, "its shift scheme is in the space of all of its size", "yes".into(), told.into(), is_found);
    }
    s.points.push(
        "ZF 6HP26: the rear set 31/38/85 is outside every space without profile shift, because 85 − 38 is odd. The space of \
         ratios within 1 % has 369 combinations of front and rear set there, 29 of them with a rear set that assembles."
            .into(),
    );
    report.sections.push(s);
}

/// Ratio and efficiencies of a 3K drive whose meshes lose `loss` of their power outside and half of that inside.
fn bilateral([s, p1, r1, p2, r2]: [i64; 5], loss: f64) -> [f64; 3] {
    let text = format!(
        "format = 1\nname = \"3K\"\nmembers = [\"sun\", \"carrier\", \"ring\"]\nterminals = [\"sun\", \"ring\"]\n\
         [[set]]\nname = \"P1\"\ntype = \"stepped\"\nsuns = [{{ member = \"sun\", teeth = {s}, planet_teeth = {p1} }}]\n\
         rings = [{{ member = \"frame\", teeth = {r1}, planet_teeth = {p1} }}, {{ member = \"ring\", teeth = {r2}, \
         planet_teeth = {p2} }}]\ncarrier = \"carrier\"\n\
         mesh_efficiency = {{ external = {}, internal = {} }}\nplanet = {{ count = 3 }}\n",
        1.0 - loss,
        1.0 - 0.5 * loss
    );
    let analysis = answer(&train(&text));
    let state = analysis.ratios.iter().next().map(|r| r.1.clone());
    let of = |e: Option<f64>| e.unwrap_or(0.0);
    state.map_or([0.0; 3], |r| [of(r.value), of(r.drive.efficiency), of(r.coast.efficiency)])
}

fn optima(report: &mut Report) {
    const FORWARD: f64 = 0.890;
    const BACKWARD: f64 = 0.853;
    let mut s = Section::new(
        "Published optima: bilateral 3K drives",
        &[
            "H. Matsuki, K. Nagano and Y. Fujimoto, Bilateral Drive Gear: A Highly Backdrivable Reduction Gearbox for Robotic \
             Actuators, IEEE/ASME Transactions on Mechatronics 24 (2019) 2661, doi:10.1109/TMECH.2019.2946403. Teeth and \
             profile shifts were chosen for efficiency; the prototype was measured with 89.0 % forward and 85.3 % backward \
             (abstract). Its tooth numbers were not at hand and are not compared.",
            "What can be asked: which meshes would a 3K drive of about 100:1 need for that, and what does it give backward \
             then? Internal meshes lose half of what external ones do, as in the counts above. The trains are the smallest, a \
             middle one and the best of the front of 63 in the first 3K space.",
        ],
        &[
            "teeth s/p1/r1/p2/r2",
            "ratio",
            "needed loss of the outer mesh, %",
            "forward, %",
            "backward, %",
            "measured backward, %",
        ],
    );
    let trains = [[18, 17, 52, 18, 53], [13, 32, 77, 36, 81], [12, 54, 120, 44, 110]];
    let mut backward = vec![];
    for teeth in trains {
        let (mut low, mut high) = (0.0, 0.05);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if bilateral(teeth, middle)[1] > FORWARD {
                low = middle;
            } else {
                high = middle;
            }
        }
        let loss = 0.5 * (low + high);
        let [ratio, forward, back] = bilateral(teeth, loss);
        backward.push(back);
        s.row([
            teeth.map(|z| z.to_string()).join("/").into(),
            (ratio, 3).into(),
            (100.0 * loss, 3).into(),
            (100.0 * forward, 2).into(),
            (100.0 * back, 2).into(),
            Cell::from((100.0 * BACKWARD, 1)),
        ]);
    }
    let (least, most) = (backward.iter().copied().fold(1.0, f64::min), backward.iter().copied().fold(0.0, f64::max));
    let best = bilateral(trains[2], 0.02);
    s.points = vec![
        format!(
            "With losses of the teeth alone a drive of 89.0 % forward has {:.1} to {:.1} % backward with each of these teeth. The \
             prototype has 85.3 %: {:.1} points less, which losses that do not come from the load on the teeth, such as those \
             of bearings and seals, would take away in one direction as in the other; how much of it they are is not \
             published there.",
            100.0 * least,
            100.0 * most,
            100.0 * (least - BACKWARD)
        ),
        format!(
            "The abstract names no optimum of a finished space. With external meshes of 98 % and internal ones of 99 % the best of \
             all trains of that space, the last of these rows, has {:.1} % forward and {:.1} % backward.",
            100.0 * best[1],
            100.0 * best[2]
        ),
        "Optimisers that use formulas outside their range report drives of more than 100 %. No row of the answers here does: \
         where no sign pattern of the powers agrees with itself friction locks the train, and that is said."
            .into(),
    ];
    report.sections.push(s);
    report.gates.push(AcceptanceBound::new(
        "3K, best train: efficiency forward of its train file",
        "26755/31878",
        best[1],
        [26755.0 / 31878.0 - 1e-12, 26755.0 / 31878.0 + 1e-12],
    ));
}

/// Places of clutches that differ in what they do, for so many sets that nothing joins; the output is never held.
fn clutch_places(sets: usize) -> u64 {
    // Motions are those of carrier and sun of each set; a place is the point in which two members agree.
    let k = |set: usize| Rational::new(2 * set as i64 + 17, 10);
    let mut members: Vec<Vec<Rational>> = vec![];
    for set in 0..sets {
        let at = |carrier: Rational, sun: Rational| {
            let mut v = vec![Rational::ZERO; 2 * sets];
            (v[2 * set], v[2 * set + 1]) = (carrier, sun);
            v
        };
        let over = &Rational::ONE / &k(set);
        members.push(at(Rational::ZERO, Rational::ONE));
        members.push(at(&Rational::ONE + &over, -over.clone()));
        members.push(at(Rational::ONE, Rational::ZERO));
    }
    members.push(vec![Rational::ZERO; 2 * sets]);
    let housing = members.len() - 1;
    let mut points = BTreeSet::new();
    for (a, first) in members.iter().enumerate() {
        for (b, second) in members.iter().enumerate().skip(a + 1) {
            // The first member is the output.
            if a == 0 && b == housing {
                continue;
            }
            let difference: Vec<Rational> = first.iter().zip(second).map(|(x, y)| x - y).collect();
            let Some(scale) = difference.iter().find(|x| !x.is_zero()) else { continue };
            points.insert(difference.iter().map(|x| (x / scale).to_string()).collect::<Vec<_>>().join(" "));
        }
    }
    points.len() as u64
}

fn open_counts(report: &mut Report) {
    let mut c = Counts::new(
        report,
        "Published counts: places of clutches in hybrids",
        &[
            "X. Zhang, C. Li, H. Peng and J. Sun, Journal of Dynamic Systems, Measurement, and Control 2015: of n sets, \
             C(3n, 2) + 3n − 2n − 1 places of a clutch are useful when the output is never held. Beside that formula \
             (`independent`) stands a count of this page, not of `willis schemes`: pairs of members and brakes as points in the \
             space of motions, in fractions; places that do the same are one point.",
        ],
    );
    for (sets, expected) in [(1, 3), (2, 16), (3, 38)] {
        c.of(&format!("{sets} {}", if sets == 1 { "set" } else { "sets" }));
        c.equal("useful places of a clutch", expected, clutch_places(sets));
    }
    c.end();
    let mut s = Section::new(
        "What published counts leave open",
        &[
            "Trains of one freedom as graphs, from: The Complete Set of One-Degree-of-Freedom Planetary Gear Trains With Up to \
             Nine Links, Journal of Mechanical Design 141 (2019) 043301. These are counts of other things than ours, and no \
             number of Willis stands beside them.",
        ],
        &["links", "rotation graphs", "displacement graphs"],
    );
    for (links, rotation, displacement) in [(6, 27, 81), (7, 152, 647), (8, 1070, 6360), (9, 8654, 71_837)] {
        s.row([f64::from(links), f64::from(rotation), f64::from(displacement)].map(|n| Cell::from((n, 0))));
    }
    s.points = [
        "Earlier papers give other numbers for the same links. Duplicates that look different, joints of more than two links, and \
         graphs that fall apart were counted by some and not by others: a count means nothing without its equivalence.",
        "A graph is no scheme: it has no clutches, no ratios, no shifts. How many transmissions a graph stands for, and \
         whether any is of use, these counts do not say. A count of schemes here states sets, mobility, elements, gears, \
         ranges, and when two schemes are the same.",
        "Patents claim single schemes (US 8016708 and US 8506444, eight gears of four sets and five elements; US 7549942, nine gears \
         of four sets and six elements). They do not say how many others there are in the same space. For the permanent \
         connections of the 8HP the answer is 6, which do 2 different things.",
        "What counts call feasible differs mostly in whether a scheme can be laid out, with shafts inside each other and no \
         crossing. Here it is a property of each scheme, and a rule that can be asked for.",
        "The space of four sets, 18 428 400 layouts with five elements, is not finished on this page: the bench of the crate \
         measures a stated sample.",
    ]
    .map(String::from)
    .to_vec();
    report.sections.push(s);
}

pub(crate) fn report() -> Report {
    let mut report = Report {
        format: Format::new(),
        case: "design".into(),
        title: "Designs: whole spaces counted, production and published optima in them".into(),
        source: "Counts of a second program, written for this comparison and not in the repository: exact whole numbers and fractions in Python and plain C, each count by two \
                 methods that agree (brute force and windows; two ways of elimination, and exact fractions on everything). \
                 Published numbers with their source at each table."
            .into(),
        sections: vec![],
        gates: vec![],
    };
    let text = [
        "Conditions follow one another, each on what the one before has left; windows are closed, and their ends are \
                 fractions.",
    ];
    let mut c = Counts::new(&mut report, "Counts of tooth numbers", &text);
    simple_sets(&mut c);
    wolfrom_drives(&mut c);
    let coupled = coupled_sets(&mut c);
    c.end();
    schemes(&mut report);
    production(&mut report, &coupled);
    optima(&mut report);
    open_counts(&mut report);
    report
}
