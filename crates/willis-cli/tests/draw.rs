//! Pictures and reports as a user asks for them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name);
    path.to_str().expect("a path of letters").to_owned()
}

fn willis(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_willis")).args(arguments).output().expect("the program starts")
}

fn refused(arguments: &[&str]) -> String {
    let out = willis(arguments);
    assert_eq!(out.status.code(), Some(1), "{arguments:?}");
    assert!(out.stdout.is_empty(), "{arguments:?}");
    String::from_utf8(out.stderr).expect("text")
}

/// An empty folder of its own.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).expect("a folder");
    path
}

#[test]
fn a_figure_is_svg_png_and_data() {
    let train = example("prius-p112.toml");
    let svg = willis(&["draw", "lever", &train]);
    assert!(svg.status.success());
    assert!(svg.stdout.starts_with(b"<svg"));
    let folder = folder("draw-forms");
    for (name, start) in [("l.svg", &b"<svg"[..]), ("l.png", b"\x89PNG\r\n"), ("l.json", b"{")] {
        let path = folder.join(name);
        let out = willis(&["draw", "lever", &train, "-o", path.to_str().expect("letters")]);
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        assert!(std::fs::read(&path).expect("it was written").starts_with(start), "{name}");
    }
    let data = std::fs::read_to_string(folder.join("l.json")).expect("text");
    assert!(data.contains("\"figure\": \"lever\""));
    let dark = willis(&["draw", "lever", &train, "--theme", "dark"]).stdout;
    assert!(dark != svg.stdout && !String::from_utf8_lossy(&dark).contains("#ffffff"));
}

#[test]
fn all_that_applies_goes_into_a_folder() {
    let folder = folder("draw-all");
    let out = willis(&["draw", "all", &example("galvagno.toml"), "-o", folder.to_str().expect("letters")]);
    let said = String::from_utf8(out.stderr).expect("text");
    assert!(folder.join("stick.svg").is_file() && folder.join("sankey.svg").is_file());
    assert!(said.contains("front: not drawn"), "{said}");
    assert!(refused(&["draw", "all", &example("galvagno.toml")]).contains("name a folder"));
}

#[test]
fn what_does_not_apply_says_why_and_what_does() {
    let said = refused(&["draw", "shift", &example("galvagno.toml")]);
    assert!(
        said.contains("the train has no states") && said.contains("of this train can be drawn: stick, lever"),
        "{said}"
    );
    let said = refused(&["draw", "front", &example("zf-8hp70.toml")]);
    assert!(said.contains("geometry") && said.contains("`nominal`"), "{said}");
    let said = refused(&["draw", "time", &example("zf-8hp70.toml")]);
    assert!(said.contains("no scenario"), "{said}");
    let said = refused(&["draw", "stik", &example("zf-8hp70.toml")]);
    assert!(said.contains("no figure `stik`") && said.contains("stick"), "{said}");
    let said = refused(&["draw", "stick", &example("zf-8hp70.toml"), "--state", "9"]);
    assert!(said.contains("no state `9`"), "{said}");
    let said = refused(&["draw", "map", &example("zf-8hp70.toml"), "--over", "input.speed=1..2 rpm:3"]);
    assert!(said.contains("two quantities, not 1"), "{said}");
    let said = refused(&["draw", "losses", &example("prius-p112.toml"), "--over", "engine.speed=2..1 rpm:3"]);
    assert!(said.contains("runs backwards"), "{said}");
}

#[test]
fn files_are_written_whole_or_not_at_all() {
    let folder = folder("draw-files");
    let train = folder.join("train.toml");
    std::fs::copy(example("galvagno.toml"), &train).expect("a copy");
    let train = train.to_str().expect("letters");
    let bad = folder.join("x.bmp");
    assert!(refused(&["draw", "stick", train, "-o", bad.to_str().expect("letters")]).contains("none of .svg"));
    assert!(refused(&["report", train, "-o", bad.to_str().expect("letters")]).contains("none of .html"));
    let over = folder.join("nowhere/x.svg");
    assert!(refused(&["draw", "stick", train, "-o", over.to_str().expect("letters")]).contains("nowhere"));
    // What is read is not written over, whatever its name.
    let link = folder.join("train.svg");
    std::fs::copy(train, &link).expect("a copy");
    let link = link.to_str().expect("letters");
    assert!(refused(&["draw", "stick", link, "-o", link]).contains("cannot be written over"));
    let left: Vec<_> =
        std::fs::read_dir(&folder).expect("readable").map(|e| e.expect("readable").file_name()).collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

#[test]
fn the_same_train_makes_the_same_report() {
    let train = example("fva-planetary-stage.toml");
    let one = willis(&["report", &train]).stdout;
    assert_eq!(one, willis(&["report", &train]).stdout);
    let page = String::from_utf8(one).expect("text");
    for part in
        ["Summary", "proved", "SHA-256", "Closed formulas", "<math", "Schlenk", "What to change first", "</html>"]
    {
        assert!(page.contains(part), "{part}");
    }
    // It needs nothing from anywhere.
    for load in ["src=\"http", "href=\"http", "url(http", "<script"] {
        assert!(!page.contains(load), "{load}");
    }
    // A law that is put into force is told, and how to do it again with it.
    let other = willis(&["report", &train, "--law", "mesh_friction=niemann"]).stdout;
    assert!(String::from_utf8_lossy(&other).contains("--law mesh_friction=niemann"));
    let locked = willis(&["report", &example("wolfrom-498-self-locking.toml")]).stdout;
    assert!(String::from_utf8_lossy(&locked).contains("locked"));
}

#[test]
fn what_makes_no_difference_is_refused() {
    let said = refused(&["draw", "shift", &example("zf-8hp70.toml"), "--operation", "coasting"]);
    assert!(said.contains("no use for `operation`"), "{said}");
    let said = refused(&["draw", "stick", &example("zf-8hp70.toml"), "--animated"]);
    assert!(said.contains("no use for `animated`"), "{said}");
    let balanced = willis(&[
        "draw",
        "regimes",
        &example("compound-split.toml"),
        "--terminals",
        "engine,wheels,mg_a,mg_b",
        "--balance",
        "mg_a,mg_b",
    ]);
    assert!(balanced.stdout.starts_with(b"<svg"), "{}", String::from_utf8_lossy(&balanced.stderr));
}
