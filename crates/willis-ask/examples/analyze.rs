//! Asks for the analysis of a train file on standard input and prints the answer as JSON: a front end in a few lines. It
//! uses no file, clock or thread, so it runs wherever WebAssembly does.

use std::io::{Read, Write};

use willis::work::Serial;
use willis_ask::{Given, Refusal, question};

fn main() -> Result<(), Refusal> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).expect("a text");
    let given = [Given::read("train.toml", &text)?];
    let request = question("analyze").expect("in the list").request(serde_json::json!({}))?;
    let json = request.ask(&given, &Serial)?.json();
    std::io::stdout().write_all(json.as_bytes()).expect("somebody reads");
    Ok(())
}
