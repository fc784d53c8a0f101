//! How long whole spaces of shift schemes take on one core. `cargo bench -p willis-synthesis --bench schemes`
//!
//! Goals: 2 sets, 5 elements <= 10 ms; the layout of the 8HP <= 5 ms; 3 sets, 6 speeds <= 3 s; 4 sets, 8 speeds
//! <= 1.5 hours, extrapolated from one layout in `SAMPLE` (environment; 100 by default, a sample of 1 %; 0 leaves it out).

use std::time::Instant;

use willis::work::Work;
use willis_synthesis::schemes::{Harvest, Schemes, Search, Wish};

struct Patient;

impl Work for Patient {
    fn patience(&self) -> f64 {
        f64::INFINITY
    }
}

fn wish(sets: &[&str], counts: [usize; 3], ranges: [&str; 3]) -> Wish {
    let [elements, closed, forward] = counts;
    let mut wish = Wish::new(sets, elements, closed, forward).expect("tooth ratios");
    [wish.forward_range, wish.step, wish.reverse_range] = ranges.map(|r| r.parse().expect("a range"));
    wish
}

/// Seconds that this process has had a core, where the system tells it; else since some start.
fn core_seconds(start: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

/// The mean of some runs, in seconds of one core.
fn mean(name: &str, runs: u32, wish: &Wish) -> (f64, Schemes) {
    let search = Search::new(wish).expect("a sound wish");
    let start = Instant::now();
    let before = core_seconds(start);
    let mut harvest = Harvest::default();
    for _ in 0..runs {
        harvest = Harvest::default();
        search.harvest(&Patient, 0..search.parts(), &mut harvest);
    }
    let seconds = (core_seconds(start) - before) / f64::from(runs);
    let answer = search.answer(&harvest);
    println!("{name}: {seconds:.6} s, {} choices, {} schemes", answer.space.choices, answer.found.schemes);
    (seconds, answer)
}

fn main() {
    let two = ["62/26", "74/42"];
    let ranges = ["1/2..5", "1.15..2.2", "1.2..5"];
    mean("two sets, 4 elements, 3 speeds", 50, &wish(&two, [4, 2, 3], ranges));
    mean("two sets, 5 elements, 4 speeds", 50, &wish(&two, [5, 2, 4], ranges));
    let mut zf = wish(&["96/48", "96/48", "111/69", "85/23"], [5, 3, 8], ["1/2..6", "1.1..1.8", "1.5..6"]);
    zf.layout = "345360678751".parse().ok();
    mean("the layout of the 8HP", 500, &zf);
    let three = wish(&["109/67", "91/49", "97/39"], [5, 2, 6], ["1/2..6", "1.1..2.2", "1.5..7"]);
    mean("three sets, 5 elements, 6 speeds", 3, &three);
    let sample = std::env::var("SAMPLE").ok().and_then(|text| text.parse().ok()).unwrap_or(100);
    if sample > 0 {
        let mut four = wish(&["2", "16/9", "9/5", "4"], [5, 3, 8], ["1/2..6", "1.1..1.8", "1.5..6"]);
        four.sample = sample;
        let (seconds, answer) = mean("four sets, 5 elements, 8 speeds, a sample", 1, &four);
        // All layouts are walked, whether or not they are in the sample: that is counted once.
        four.sample = usize::MAX;
        let (walk, _) = mean("  the walk over its layouts", 1, &four);
        let each = (seconds - walk) / answer.space.examined as f64;
        println!(
            "  {} of {} layouts: {:.3} ms each, {:.2} hours for all",
            answer.space.examined,
            answer.space.layouts,
            1e3 * each,
            (walk + each * answer.space.layouts as f64) / 3600.0
        );
    }
}
