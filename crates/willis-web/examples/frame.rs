//! How long a frame of the studio takes on this machine, without a browser:
//! `cargo run --release -p willis-web --example frame -- examples/zf-8hp70.toml`.

use std::time::Instant;

use willis_web::Session;

fn main() {
    let file = std::env::args().nth(1).unwrap_or_else(|| "examples/zf-8hp70.toml".into());
    let text = std::fs::read_to_string(&file).expect("a train file");
    let mut session = Session::new(&file, &text, "{}").expect("a train");
    let all = r#"{"width":700,"stick":300,"lever":300,"power":[640,300],"scale":[0,300,500]}"#;
    let panels = [
        ("nothing", r#"{"width":700,"scale":[0,300,500]}"#),
        ("schematic and levers", r#"{"width":700,"stick":300,"lever":300,"scale":[0,300,500]}"#),
        ("all", all),
    ];
    for (what, boxes) in panels {
        let mut best = f64::INFINITY;
        for k in 0..200 {
            let point =
                format!(r#"{{"state":"3","speeds":{{"input":"{} rpm"}},"torques":{{"input":"300 N m"}}}}"#, 1000 + k);
            let start = Instant::now();
            session.show(&point, boxes).expect("a frame");
            best = best.min(1e3 * start.elapsed().as_secs_f64());
        }
        println!("{what}: {best:.2} ms");
    }
}
