//! REXS files of others, where the folder that holds them is named: `WILLIS_REXS=FOLDER cargo test -p willis-exchange`.
//! It has files and an `expected.json` that says what each of them must become.

use std::path::Path;

use serde_json::Value;
use willis::analysis::{Selection, analyze};
use willis_exchange::rexs;

#[test]
fn val_files_of_others_become_the_trains_they_describe() {
    let Some(folder) = std::env::var_os("WILLIS_REXS") else { return };
    let folder = Path::new(&folder);
    let expected: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("expected.json")).unwrap()).unwrap();
    for (name, wanted) in expected.as_object().unwrap() {
        let read = rexs::read(name, &std::fs::read(folder.join(name)).unwrap());
        if let Some(why) = wanted["refused"].as_str() {
            let told = read.unwrap_err().to_string();
            assert!(told.contains(why), "{name}: {told}");
            continue;
        }
        let read = read.unwrap_or_else(|e| panic!("{name}: {e}"));
        if std::env::var_os("WILLIS_LOOK").is_some() {
            println!("{}\n{:#?}", read.toml, read.report.counts);
        }
        let train = read.model.train();
        let analysis = analyze(train, &Selection::default()).unwrap();
        println!(
            "{name}: {:?}",
            analysis
                .operations
                .iter()
                .map(|o| (&o.name, o.verdict, o.solutions.first().map(|s| s.efficiency)))
                .collect::<Vec<_>>()
        );
    }
}
