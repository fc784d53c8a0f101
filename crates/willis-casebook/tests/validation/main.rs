//! Numbers of others beside ours: the gates of every case, the pages and curves that show them.

use std::fs;
use std::path::{Path, PathBuf};

mod contract;
mod design;
mod galvagno;
mod losses;
mod modelica;

fn validation() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation")
}

fn read(name: &str) -> String {
    let path = validation().join(name);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// What a page of `validation` holds; written with `WILLIS_WRITE=1`, else compared.
fn page(name: &str, text: &str) {
    let path = validation().join(name);
    if std::env::var_os("WILLIS_WRITE").is_some() {
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("a page");
    } else {
        let committed = fs::read_to_string(path).unwrap_or_default();
        assert!(committed == text, "validation/{name} is out of date: run `cargo xtask generate`");
    }
}
