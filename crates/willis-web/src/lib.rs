//! Willis in a browser: what the studio calls.
//!
//! A [`Session`] is a train with its layouts. Everything goes in and out as text: requests, answers and refusals are JSON, and
//! pictures are SVG. Answers have the bytes that the command line writes.

mod point;
mod session;
mod surroundings;

use serde_json::json;
use wasm_bindgen::prelude::wasm_bindgen;
use willis_ask::Refusal;

pub use point::Point;
pub use session::{Session, Shown};

/// The version of Willis.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// The JSON Schema of train files: an editor completes with it.
#[wasm_bindgen(js_name = fileSchema)]
pub fn file_schema() -> String {
    willis::train::schema().to_string()
}

/// A train file to start from, by the kinds of `willis new`.
///
/// # Errors
/// There is no such kind, as JSON.
#[wasm_bindgen(js_name = newTrain)]
pub fn new_train(kind: &str) -> Result<String, String> {
    let ask = || -> Result<String, Refusal> {
        let entry = willis_ask::question("new").expect("in the list");
        let request = entry.request(json!({ "kind": kind }))?;
        let answer = request.ask(&[], &surroundings::Browser)?;
        Ok(answer
            .write("toml")?
            .into_iter()
            .next()
            .map(|f| String::from_utf8_lossy(&f.bytes).into_owned())
            .unwrap_or_default())
    };
    ask().map_err(|refusal| refused(&refusal, &[]))
}

/// A refusal as JSON.
fn refused(refusal: &Refusal, of: &[willis_ask::Given]) -> String {
    willis_ask::json(&refusal.report(of))
}
