//! Random trains with random shift elements under random loads, beside the reference.

use willis::dynamics::{Options, Outcome};

use crate::gearbox::{Gearbox, Work, faults, off};
use crate::rows::run;

/// Numbers that look random and are the same in every run.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// Torques at a few times, in whole N m, with reversals and steps.
    fn torques(&mut self, duration: f64) -> Vec<[f64; 2]> {
        let n = 1 + self.below(4);
        let torque = |dice: &mut Self| if dice.one_in(4) { 0.0 } else { dice.below(401) as f64 - 200.0 };
        let mut points = vec![[0.0, torque(self)]];
        for k in 1..=n {
            let last = points.last().expect("not empty")[1];
            points.push([duration * k as f64 / n as f64, if self.one_in(3) { last } else { torque(self) }]);
        }
        points
    }
}

/// Sets that share shafts, and elements between any two of them.
fn gearbox(dice: &mut Dice) -> Gearbox {
    let sets = 1 + dice.below(4);
    let shafts = 2 + sets;
    let mut members = vec!["frame".to_owned()];
    members.extend((0..shafts).map(|k| format!("s{k}")));
    members.extend((0..sets).map(|k| format!("p{k}")));
    let mut meshes = vec![];
    for set in 0..sets {
        // The last one of its own.
        let mut of = vec![dice.below(2 + set), 2 + set];
        while of.len() < 3 {
            let next = dice.below(2 + set);
            if !of.contains(&next) {
                of.push(next);
            }
        }
        of.rotate_left(dice.below(3));
        let [sun, ring, carrier, planet] = [of[0] + 1, of[1] + 1, of[2] + 1, 1 + shafts + set];
        let (z, p) = (20.0 + dice.below(30) as f64, 15.0 + dice.below(20) as f64);
        let lossless = dice.one_in(8);
        let mut efficiency = || if lossless { 1.0 } else { (970 + dice.below(26)) as f64 / 1000.0 };
        let eta = [[efficiency(), efficiency()], [efficiency(), efficiency()]];
        meshes.push(([sun, planet, carrier], [z, p], eta[0]));
        meshes.push(([planet, ring, carrier], [p, -(z + 2.0 * p)], eta[1]));
    }
    let elements: Vec<(String, [usize; 2])> = (0..2 + dice.below(2 + sets))
        .map(|k| {
            let first = 1 + dice.below(shafts);
            let second = if dice.one_in(2) { 0 } else { 1 + dice.below(shafts) };
            (format!("E{k}"), [first, if second == first { 0 } else { second }])
        })
        .collect();
    let one_way: Vec<i8> = elements.iter().map(|_| if dice.one_in(6) { [-1, 1][dice.below(2)] } else { 0 }).collect();
    let any = |dice: &mut Dice| {
        let first = 1 + dice.below(shafts);
        let second = if dice.one_in(2) { 0 } else { 1 + dice.below(shafts) };
        [first, if second == first { 0 } else { second }]
    };
    let drags =
        (0..dice.below(3)).map(|_| (any(dice), dice.below(4) as f64 * 5.0, dice.below(3) as f64 * 0.1)).collect();
    // Well damped: the reference damps by itself.
    let springs: Vec<([usize; 2], f64, f64)> = (0..dice.below(4) / 2)
        .map(|_| (any(dice), 100.0 + dice.below(400) as f64, 2.0 + dice.below(5) as f64))
        .collect();
    let state = |dice: &mut Dice| (0..elements.len()).filter(|k| one_way[*k] == 0 && dice.one_in(2)).collect();
    let states = vec![("a".to_owned(), state(dice)), ("b".to_owned(), state(dice))];
    Gearbox {
        planets: (0..members.len()).map(|m| m > shafts).collect(),
        one_way,
        drags,
        shafts: springs,
        ends: [1, 2],
        sets: toml::Table::new(),
        members,
        meshes,
        elements,
        states,
    }
}

/// Runs of these seeds; how many come to their end.
fn runs(seeds: std::ops::Range<u64>) {
    let mut bad = vec![];
    let (mut finished, mut compared, mut worst) = (0, 0, 0.0f64);
    for seed in seeds {
        let dice = &mut Dice(seed);
        let g = gearbox(dice);
        let rigid = dice.one_in(3);
        let capacity = if rigid { None } else { Some(20.0 + dice.below(300) as f64) };
        let duration = 1.0;
        let work = Work {
            duration,
            // What is rigid cannot be engaged between speeds.
            states: if rigid { [0, 0] } else { [0, 1] },
            input: dice.torques(duration),
            output: dice.torques(duration),
            ..Work::default()
        };
        let output = [0.02, 0.3, 10.0][dice.below(3)];
        let text = g.text(true, capacity, output, &work.text(&g).expect("it starts at rest"));
        let (rows, report) = run(&text, &Options::default());
        let mut found = faults(&g, &work, rigid, &rows, &report);
        finished += usize::from(report.outcome == Outcome::Finished);
        if report.outcome == Outcome::Finished {
            // Where friction nearly gives way the reference creeps, and follows a change late: then finer.
            let near = [1, 10, 100].into_iter().filter_map(|fine| work.reference(&g, capacity, output, fine));
            let mut near = near.map(|reference| off(&g, &report, &reference, 2e-2));
            let mut last = near.next();
            while last.as_ref().is_some_and(|(members, _)| !members.is_empty()) {
                match near.next() {
                    Some(finer) => last = Some(finer),
                    None => break,
                }
            }
            if let Some((members, most)) = last {
                compared += 1;
                found.extend(members);
                worst = worst.max(most);
            }
        }
        if !found.is_empty() {
            bad.push(format!("{seed}: {}", found.join("; ")));
        }
    }
    println!("{finished} finished, {compared} beside the reference, {worst:.1e} off at most");
    assert!(bad.is_empty(), "{} are wrong:\n{}", bad.len(), bad.join("\n"));
}

#[test]
fn random_trains_move_as_the_reference_does() {
    runs(0..100);
}

#[test]
fn random_trains_whose_elements_fall_from_a_peak_come_to_their_end() {
    let mut bad = vec![];
    for seed in 0..150 {
        let dice = &mut Dice(seed);
        let g = gearbox(dice);
        let capacity = 20.0 + dice.below(300) as f64;
        let work = Work {
            duration: 1.0,
            states: [0, 1],
            input: dice.torques(1.0),
            output: dice.torques(1.0),
            ..Work::default()
        };
        let text = g.text(true, Some(capacity), 0.3, &work.text(&g).expect("it starts at rest"));
        let text = text.replace("\ncapacity = ", "\npeak = 1.2\ncapacity = ");
        let (_, report) = run(&text, &Options::default());
        let mut ended = report.outcome == Outcome::Finished;
        if matches!(report.outcome, Outcome::SeveralSolutions(_)) && !report.unique_for_every_load {
            // A train that wedges: it may rest where it also may move, for a while before it must.
            let (_, first) = run(&text, &Options { continue_when_ambiguous: true, ..Options::default() });
            ended = first.outcome == Outcome::Finished;
        }
        if !ended {
            bad.push(format!("{seed}: {:?}", report.outcome));
        }
    }
    assert!(bad.is_empty(), "{} are wrong:\n{}", bad.len(), bad.join("\n"));
}

#[test]
#[ignore = "takes a quarter of an hour"]
fn ten_thousand_random_trains_move_as_the_reference_does() {
    runs(0..10_000);
}
