//! How long it takes: `cargo test --release -p willis-synthesis --test teeth -- --ignored --nocapture speed`.
//!
//! Nothing here passes or fails by time.

use std::time::Instant;

use willis::work::Serial;
use willis_synthesis::teeth::{Progress, Request};

use crate::counts::{eight_speeds, read};
use crate::layouts::wolfrom;

fn best<T>(what: &str, runs: usize, job: impl Fn() -> T) -> T {
    let mut least = f64::INFINITY;
    let mut result = None;
    for _ in 0..runs {
        let start = Instant::now();
        result = Some(job());
        least = least.min(start.elapsed().as_secs_f64());
    }
    println!("{what}: {:.3} ms", 1e3 * least);
    result.unwrap()
}

#[test]
#[ignore = "prints times"]
fn speed_of_a_wolfrom_drive() {
    let design = "planets = \"3..6\"\ntarget = [{ ratio = [99.005, 100.995], any_sign = true }]\n\
                  minimize = [\"ring_diameter\"]\nmaximize = [\"forward\", \"backward\"]";
    let text = wolfrom("12..120", "..10000", "{ external = 0.98, internal = 0.99 }", design);
    let design = best("read the design file", 5, || read(&text));
    let found = best("count 5,180,116 candidates", 20, || design.count());
    assert_eq!(found.designs, 1329);
    let progress = best("with efficiencies of all and the front", 10, || {
        design.search(Progress::default(), None, &Serial).unwrap()
    });
    println!("front: {}", progress.front.len());
    best("20 rows with certificates", 3, || design.answer_of(progress.clone(), &Request::default()));
}

#[test]
#[ignore = "prints times"]
fn speed_of_eight_speeds() {
    let (_, design) = eight_speeds("8hp70", "20..72", "15..", "..120", "3..5");
    assert_eq!(best("count 293,667 combinations", 20, || design.count()).trains, 293_667);
    let progress =
        best("waterfall and the front by error", 1, || design.search(Progress::default(), None, &Serial).unwrap());
    assert_eq!(progress.waterfall.last().unwrap().trains, 293_667);
    assert_eq!(progress.front.len(), 1);
}
