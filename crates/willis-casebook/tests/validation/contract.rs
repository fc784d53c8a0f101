//! Every report reads back, and the copies of the examples are what they are copies of.

use std::fs;
use std::path::Path;

use willis_casebook::{CASES, Report};

#[test]
fn every_report_reads_back() {
    for case in CASES {
        let report = willis_casebook::run(case.name).expect("a case");
        let text = serde_json::to_string(&report).expect("plain data");
        assert!(text.starts_with(r#"{"format":"willis-validation-1","case":"#), "{}", case.name);
        let back: Report = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        assert_eq!(back, report);
        assert_eq!(serde_json::to_string(&back).expect("plain data"), text);
    }
}

/// A crate can only hold what lies inside it; `cargo xtask generate` copies them again.
#[test]
fn copies_of_examples_are_true() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for copy in fs::read_dir(here.join("data/examples")).expect("copies") {
        let name = copy.expect("a file").file_name();
        let text = |folder: &str| fs::read_to_string(here.join(folder).join(&name)).expect("a train");
        let same = text("data/examples") == text("../../examples");
        assert!(same, "{} is not what the example is: run `cargo xtask generate`", name.display());
        count += 1;
    }
    assert_eq!(count, 3);
}
