//! What the test programs share: the example trains, and numbers at random that are the same in every run.
#![allow(dead_code, reason = "each program uses a part")]

use std::fs;
use std::path::{Path, PathBuf};

use willis::exact::Rational;
use willis::train::Train;

/// The folder of example trains.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

/// Text of a file of that folder, `.toml` where no other ending is given.
pub fn example(name: &str) -> String {
    let path = folder().join(if name.contains('.') { name.to_owned() } else { format!("{name}.toml") });
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The train of an example.
pub fn train(name: &str) -> Train {
    Train::from_toml(&example(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Name and text of every example, by name.
pub fn examples() -> Vec<(String, String)> {
    let mut files: Vec<_> = fs::read_dir(folder()).unwrap().map(|e| e.unwrap().path()).collect();
    files.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    files.sort();
    assert!(files.len() >= 29, "{} examples", files.len());
    files
        .iter()
        .map(|p| (p.file_stem().unwrap().to_str().unwrap().to_owned(), fs::read_to_string(p).unwrap()))
        .collect()
}

/// Whole numbers at random: the linear congruence of Knuth's MMIX, its upper bits.
pub struct Dice(pub u64);

impl Dice {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    /// From 0 to below `n`.
    pub fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// From `low` to `high`, both included.
    pub fn whole(&mut self, low: i64, high: i64) -> i64 {
        low + self.below((high - low + 1) as u64) as i64
    }

    /// A positive fraction.
    pub fn fraction(&mut self) -> Rational {
        Rational::new(self.whole(1, 999), self.whole(1, 99))
    }

    /// Between −1 and 1.
    pub fn unit(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 30) as f64 - 1.0
    }

    /// One of a list.
    pub fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len() as u64) as usize]
    }
}

/// Numbers at random between 0 and 1: xorshift64 of Marsaglia (2003).
pub struct Uniform(pub u64);

impl Uniform {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + self.next() * (high - low)
    }
}
