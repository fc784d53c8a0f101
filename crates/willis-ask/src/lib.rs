//! Every question that Willis answers, in one list: what a front end is built on.
//!
//! A question has a name, a request with documented fields and defaults, an answer that is a versioned contract, tables
//! and words. [`QUESTIONS`] lists all of them; every front end (today the command line) asks the same list and brings what
//! differs: files, threads and screens. This crate has none of these: it touches no file, no clock and starts no
//! thread.
//!
//! ```
//! use willis::work::Serial;
//! use willis_ask::{Given, question};
//!
//! let given = Given::read("reducer", r#"
//!     format = 1
//!     name = "reducer"
//!     members = ["sun", "carrier"]
//!     terminals = ["sun", "carrier"]
//!     [[set]]
//!     name = "P1"
//!     sun = { member = "sun", teeth = 30 }
//!     ring = { member = "frame", teeth = 70 }
//!     carrier = "carrier"
//!     mesh_efficiency = 0.99
//! "#)?;
//! let request = question("analyze").unwrap().request(serde_json::json!({}))?;
//! let given = [given];
//! let answer = request.ask(&given, &Serial)?;
//! assert!(answer.text().contains("10/3"));
//! assert!(answer.json().contains("willis-analysis-1"));
//! assert_eq!(answer.tables()[0].name, "states");
//! # Ok::<(), willis_ask::Refusal>(())
//! ```
//!
//! A question can be asked without the list, with its types:
//!
//! ```
//! # use willis::work::Serial;
//! # use willis_ask::{Given, Question, Refusal, questions::Analyze};
//! # fn state(given: &[Given]) -> Result<(), Refusal> {
//! let request = Analyze { state: Some("3".into()), ..Default::default() };
//! let analysis = request.ask(given, &Serial)?;
//! println!("{:?}", analysis.ratios.get("3").and_then(|s| s.drive.efficiency));
//! # Ok(())
//! # }
//! ```

mod question;
pub mod questions;
mod refusal;
pub mod style;
pub mod table;

pub use question::{Answer, Attachment, Entry, Extra, File, Form, Given, Holds, Of, Options, Question, Request};
pub use questions::{QUESTIONS, question};
pub use refusal::{Refusal, RefusalReport};
pub use style::quoted;

/// An answer or a refusal as JSON, indented. What a terminal would obey is written as an escape, which means the same.
pub fn json(contract: &impl serde::Serialize) -> String {
    let plain = serde_json::to_string_pretty(contract).expect("plain data") + "\n";
    let is_safe = |c: char| c == '\n' || willis::diagnostic::is_printable(c);
    if plain.chars().all(is_safe) {
        return plain;
    }
    let mut out = String::with_capacity(plain.len() + 64);
    for c in plain.chars() {
        match is_safe(c) {
            true => out.push(c),
            // Beyond texts there is nothing of the kind.
            false => c.encode_utf16(&mut [0; 2]).iter().for_each(|u| out += &format!("\\u{u:04x}")),
        }
    }
    out
}

/// The code of the page of this crate runs as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
