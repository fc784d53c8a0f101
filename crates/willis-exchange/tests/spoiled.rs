//! Spoiled files of other programs do no harm: no panic, no train that its own text does not give again, no refusal without a
//! reason. The seeds are those of the fuzz target `imports`; `WILLIS_SPOILED=N` spoils each N times.

use std::fs;
use std::path::Path;

use willis::Diagnostics;
use willis::diagnostic::is_printable;
use willis::model::Model;
use willis_exchange::gearsets;
use willis_exchange::rexs::{self, Convention, Imported};

/// A generator of numbers: the same every time.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n.max(1)
    }
}

/// Texts that files rather do not have where they are put.
const ODD: &[&str] = &[
    "",
    "-1",
    "0",
    "NaN",
    "1e999",
    "99999999999999999999",
    "1e-320",
    "-0.0",
    "none",
    "true",
    "null",
    "[]",
    "{}",
    "<array><c>1</c></array>",
    "\u{202e}\u{0}",
    "&amp;",
    "]]>",
    "\"",
];

/// Spoils a file in one of several ways.
fn spoil(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let n = bytes.len();
    match random.below(9) {
        0 => bytes.truncate(random.below(n)),
        1 => {
            let at = random.below(n);
            if let Some(byte) = bytes.get_mut(at) {
                *byte = random.below(256) as u8;
            }
        }
        2 => {
            let (from, length) = (random.below(n), random.below(80));
            bytes.drain(from..(from + length).min(n));
        }
        3 => {
            let (from, length, to) = (random.below(n), random.below(200), random.below(n));
            let piece = bytes[from..(from + length).min(n)].to_vec();
            bytes.splice(to..to, piece);
        }
        4 => {
            let (from, length, to) = (random.below(other.len()), random.below(400), random.below(n));
            let piece = &other[from..(from + length).min(other.len())];
            bytes.splice(to..to, piece.iter().copied());
        }
        // A value between quotes or tags, a number.
        way => {
            let is_edge = |b: &u8| b"\"<>,:[]{}= ".contains(b);
            let start = random.below(n);
            let Some(from) = bytes[start..].iter().position(is_edge).map(|k| start + k + 1) else { return };
            let Some(to) = bytes[from..].iter().position(is_edge).map(|k| from + k) else { return };
            let new: Vec<u8> = match way {
                5 | 6 => ODD[random.below(ODD.len())].into(),
                // Another value of the same file.
                7 => {
                    let at = random.below(n);
                    let begin = bytes[at..].iter().position(is_edge).map_or(at, |k| at + k + 1);
                    bytes[begin..].split(is_edge).next().unwrap_or_default().to_vec()
                }
                _ => (random.below(40) as i64 - 3).to_string().into(),
            };
            bytes.splice(from..to, new);
        }
    }
}

fn looked_at(done: Result<Imported, Diagnostics>) -> bool {
    match done {
        Err(wrong) => {
            assert!(wrong.has_errors(), "refused without a reason");
            let told = wrong.render("file", "", false);
            assert!(told.chars().all(|c| c == '\n' || is_printable(c)), "a terminal would obey {told:?}");
            false
        }
        Ok(read) => {
            let again = Model::from_toml(&read.toml).unwrap_or_else(|e| panic!("{e}\n{}", read.toml));
            assert_eq!(again.train().meshes().len(), read.model.train().meshes().len());
            serde_json::to_string(&read.report).expect("a report");
            let _ = rexs::written(read.model.train(), false);
            true
        }
    }
}

fn read(bytes: &[u8]) -> bool {
    // A schedule stands behind a zero byte.
    let mut parts = bytes.splitn(2, |b| *b == 0);
    let spec = parts.next().unwrap_or_default();
    if gearsets::is_gearsets(spec) {
        return looked_at(gearsets::read("file.json", spec, parts.next()));
    }
    let [din, _] = [Convention::Din, Convention::Outward].map(|c| looked_at(rexs::read_as("file.rexs", bytes, c)));
    din
}

#[test]
fn spoiled_files_do_no_harm() {
    let times: usize = std::env::var("WILLIS_SPOILED").ok().and_then(|n| n.parse().ok()).unwrap_or(150);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/imports");
    let mut seeds: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    seeds.sort();
    let files: Vec<Vec<u8>> = seeds.iter().map(|p| fs::read(p).unwrap()).collect();
    let (mut random, mut trains, mut all) = (Random(1841), 0, 0);
    for (path, sound) in seeds.iter().zip(&files) {
        assert_eq!(read(sound), !path.ends_with("stored.rexsz"), "{}", path.display());
        for k in 0..times {
            let mut bytes = sound.clone();
            for _ in 0..=random.below(3) {
                let other = &files[random.below(files.len())];
                spoil(&mut bytes, other, &mut random);
            }
            let done = std::panic::catch_unwind(|| read(&bytes));
            let Ok(is_train) = done else {
                let at = std::env::temp_dir().join(format!("willis-spoiled-{k}"));
                fs::write(&at, &bytes).unwrap();
                panic!("{} spoiled: {}", path.display(), at.display());
            };
            trains += usize::from(is_train);
            all += 1;
        }
    }
    // Neither all are read nor all refused.
    assert!(trains > all / 50 && trains < all, "{trains} of {all}");
}
