//! Files of other programs: REXS in its three forms, gearsets JSON with its schedule behind a zero byte. Whatever they hold,
//! nothing panics, what is read is a train that its own text gives again, and what is refused has a reason.

#![no_main]

use libfuzzer_sys::fuzz_target;
use willis::diagnostic::{Diagnostics, is_printable};
use willis::model::Model;
use willis_exchange::gearsets;
use willis_exchange::rexs::{self, Convention, Imported};

fn looked_at(done: Result<Imported, Diagnostics>) {
    match done {
        Err(wrong) => {
            assert!(wrong.has_errors(), "refused without a reason");
            let told = wrong.render("file", "", false);
            assert!(told.chars().all(|c| c == '\n' || is_printable(c)), "a terminal would obey {told:?}");
        }
        Ok(read) => {
            let again = Model::from_toml(&read.toml).unwrap_or_else(|e| panic!("{e}\n{}", read.toml));
            assert_eq!(again.train().meshes().len(), read.model.train().meshes().len());
            serde_json::to_string(&read.report).expect("a report");
            // Solving takes longer than reading.
            if read.model.train().meshes().len() <= 6 {
                let _ = rexs::write(read.model.train());
            }
        }
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut parts = bytes.splitn(2, |b| *b == 0);
    let spec = parts.next().unwrap_or_default();
    if gearsets::is_gearsets(spec) {
        looked_at(gearsets::read("file.json", spec, parts.next()));
        return;
    }
    for convention in [Convention::Din, Convention::Outward] {
        looked_at(rexs::read_as("file.rexs", bytes, convention));
    }
});
