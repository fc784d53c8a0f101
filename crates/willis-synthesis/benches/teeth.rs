//! How long searches for tooth numbers take on one core. `cargo bench -p willis-synthesis --bench teeth`
//!
//! Goals: a Wolfrom drive of 5,180,116 candidates counted in 0.2 ms, with the efficiencies of all that are left and the front
//! in 20 ms; the 293,667 tooth combinations of the 8HP within 1 % counted in 5 ms.

use std::time::Instant;

use serde_json::Value;
use willis::work::Serial;
use willis_synthesis::teeth::{Design, Progress, Request};

#[path = "../tests/teeth/layouts.rs"]
#[expect(dead_code, reason = "tests ask for more of them")]
mod layouts;

/// The least time of some runs.
fn least<T>(what: &str, runs: usize, job: impl Fn() -> T) -> T {
    let timed = || {
        let start = Instant::now();
        let result = job();
        (start.elapsed().as_secs_f64(), result)
    };
    let first = timed();
    let (seconds, result) = (1..runs).map(|_| timed()).fold(first, |best, own| if own.0 < best.0 { own } else { best });
    println!("{what}: {:.3} ms", 1e3 * seconds);
    result
}

fn read(text: &str) -> Design {
    Design::from_toml(text).unwrap_or_else(|e| panic!("{}", e.render("design.toml", text, false)))
}

fn whole(design: &Design) -> Progress {
    design.search(Progress::default(), None, &Serial).expect("nobody cancels it")
}

fn wolfrom() {
    let wish = "planets = \"3..6\"\ntarget = [{ ratio = [99.005, 100.995], any_sign = true }]\n\
                minimize = [\"ring_diameter\"]\nmaximize = [\"forward\", \"backward\"]";
    let text = layouts::wolfrom("12..120", "..10000", "{ external = 0.98, internal = 0.99 }", wish);
    let design = least("Wolfrom drive: read the design file", 5, || read(&text));
    assert_eq!(least("  count 5,180,116 candidates", 50, || design.count()).designs, 1329);
    let progress = least("  with efficiencies of all and the front", 10, || whole(&design));
    least("  20 rows with certificates", 3, || {
        design.answer_of(progress.clone(), &Request::default(), &Serial).expect("it is its own progress")
    });
}

fn eight_speeds() {
    let cases: Value = serde_json::from_str(include_str!("../tests/teeth/counts.json")).expect("the cases");
    let case = cases["problems"].as_array().into_iter().flatten().find(|p| p["id"] == "8hp70").expect("its case");
    let ratios = case["parameters"]["targets"].as_array().expect("nine ratios").iter().filter_map(Value::as_str);
    let states = ["1", "2", "3", "4", "5", "6", "7", "8", "R"];
    let targets: Vec<String> =
        ratios.zip(states).map(|(ratio, state)| format!("{{ state = \"{state}\", ratio = {ratio} }}")).collect();
    let wish = format!(
        "[design]\ntolerance = 0.01\nplanets = \"3..5\"\ngap = 0.5\nminimize = [\"error\"]\ntarget = [{}]",
        targets.join(", ")
    );
    let gears = [("sun", "20..72"), ("planet", "15.."), ("ring", "..120")];
    let paths: Vec<(String, &str)> = ["P1", "P2", "P3", "P4"]
        .iter()
        .flat_map(|set| gears.map(|(gear, range)| (format!("{set}.{gear}.teeth"), range)))
        .collect();
    let teeth: Vec<(&str, &str)> = paths.iter().map(|(path, range)| (path.as_str(), *range)).collect();
    let layout = include_str!("../../../examples/zf-8hp70.toml");
    let design = read(&layouts::example(layout, &wish, &teeth));
    assert_eq!(least("8HP: count 293,667 combinations", 20, || design.count()).trains, 293_667);
    least("  waterfall and the front by error", 1, || whole(&design));
}

fn main() {
    wolfrom();
    eight_speeds();
}
