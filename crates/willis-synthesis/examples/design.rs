//! Answers a design file: `cargo run --release -p willis-synthesis --example design -- FILE.toml [ROW]`.
//!
//! With the number of a row it prints that row as a train file instead.

use std::process::ExitCode;

use willis::work::Serial;
use willis_synthesis::teeth::{Design, Request};

fn main() -> ExitCode {
    // The first is the name of the program.
    let mut arguments = std::env::args().skip(1);
    let (Some(file), row) = (arguments.next(), arguments.next().and_then(|r| r.parse::<usize>().ok())) else {
        eprintln!("design FILE.toml [ROW]");
        return ExitCode::from(2);
    };
    let text = match std::fs::read_to_string(&file) {
        Ok(text) => text,
        Err(e) => {
            eprintln!("{file}: {e}");
            return ExitCode::from(2);
        }
    };
    let answered = Design::from_toml(&text).and_then(|d| d.answer(&Request::default(), &Serial).map(|a| (d, a)));
    let (design, answer) = match answered {
        Ok(both) => both,
        Err(wrong) => {
            eprint!("{}", wrong.render(&file, &text, false));
            return ExitCode::FAILURE;
        }
    };
    if let Some(row) = row.and_then(|r| answer.rows.get(r.wrapping_sub(1))) {
        print!("{}", design.train_file(row));
        return ExitCode::SUCCESS;
    }
    println!("{}\n", answer.wish);
    for stage in &answer.waterfall {
        println!("{:>12} {:>12}  {}", stage.trains, stage.designs, stage.condition);
    }
    println!("\n{} on the front", answer.front);
    let percent = |x: Option<f64>| x.map_or("-".into(), |x| format!("{:.2} %", 100.0 * x));
    for row in &answer.rows {
        let teeth: Vec<String> = (row.sets.iter())
            .map(|(_, s)| s.teeth.iter().map(|(_, z)| z.to_string()).collect::<Vec<_>>().join("/"))
            .collect();
        let ratios: Vec<String> = row.states.iter().map(|(_, s)| format!("{:.4}", s.value)).collect();
        println!(
            "{:>3}  {}  ratio {}  ring {}  forward {}  backward {}  lock {}",
            row.number,
            teeth.join(" "),
            ratios.join(" "),
            row.ring_diameter_m.map_or(format!("{} teeth", row.ring_teeth), |d| format!("{:.1} mm", 1e3 * d)),
            percent(row.forward),
            percent(row.backward),
            row.lock_margin.map_or("never".into(), |m| format!("{m:.2}")),
        );
    }
    for relaxation in &answer.relaxations {
        println!("must give: {}", relaxation.words);
    }
    for d in &answer.diagnostics {
        println!("{}: {}", d.code, d.message);
    }
    println!("\n{}", answer.completeness.statement);
    ExitCode::SUCCESS
}
