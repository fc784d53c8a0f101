//! `willis export fmu`: a train in motion for other simulators. The unit holds the runtime, a library that is built beside this
//! program.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Command, value_parser};
use willis_ask::questions::FMU;
use willis_ask::{Entry, File};
use willis_fmu::{Interface, LIBRARY, Request, Version, pack};

use crate::Ended;
use crate::run::{Asked, deliver};

/// How this kind of export is asked for, and what it is.
const KIND: &str = FMU.0;
const ABOUT: &str = FMU.1;
/// The place of the runtime, if it is not where it is looked for.
const PLACE: &str = "WILLIS_FMU_LIBRARY";

/// Options of this kind alone.
const OWN: [&str; 4] = ["scenario", "fmi", "interface", "library"];
/// Options of the other kinds.
const OTHER: [&str; 6] = ["state", "all_states", "operation", "speeds", "torques", "temperature"];

/// The options of a unit.
pub fn options(command: Command) -> Command {
    let own = |name: &'static str, long: &'static str, value: &'static str| Arg::new(name).long(long).value_name(value);
    command
        .arg(own("scenario", "scenario", "SCENARIO").help("fmu: this scenario of the file, if there are several"))
        .arg(
            own("fmi", "fmi", "VERSION")
                .value_parser(["2", "3"])
                .help("fmu: version of the interface, 2.0 (the default) or 3.0"),
        )
        .arg(own("interface", "kind", "KIND").value_parser(["cs", "me", "both"]).help(
            "fmu: cs, the unit advances itself (co-simulation); me, the other program integrates (model exchange); both (the default)",
        ))
        .arg(
            own("library", "library", "FILE")
                .value_parser(value_parser!(PathBuf))
                .help("fmu: the runtime, if it is not beside this program"),
        )
        .after_help(format!("`willis export {KIND} FILE -o x.fmu` packs {ABOUT}; it has options of its own."))
}

/// Whether that is asked.
pub fn is_asked(matches: &ArgMatches) -> bool {
    matches.get_one::<String>("kind").is_some_and(|kind| kind == KIND)
}

/// Options of units are refused to the other kinds.
///
/// # Errors
/// An option of units that is given to another kind.
pub fn beside(matches: &ArgMatches, answered: impl FnOnce() -> Result<Ended, Ended>) -> Result<Ended, Ended> {
    if let Some(name) = OWN.iter().find(|name| matches.contains_id(name)) {
        let name = if *name == "interface" { "kind" } else { name };
        return Err(Ended::Misused(format!("--{name} belongs to `export {KIND}`")));
    }
    answered()
}

/// Packs a unit.
pub fn run(entry: &'static Entry, matches: &ArgMatches) -> Result<Ended, Ended> {
    if let Some(name) = OTHER.iter().find(|name| {
        let source = matches.value_source(name);
        source.is_some_and(|s| s == clap::parser::ValueSource::CommandLine)
    }) {
        let told = format!("--{} belongs to the other kinds of export; an FMU has a scenario", name.replace('_', "-"));
        return Err(Ended::Misused(told));
    }
    let asked = Asked::new(entry, matches, "files")?;
    if asked.form != "files" {
        return Err(Ended::Misused(format!("an FMU has no form `{}`", asked.form)));
    }
    let Some(file) = matches.get_one::<String>("file") else {
        return Err(
            format!("no train is named to export as `{KIND}`\n  name a train file after the kind of export\n").into()
        );
    };
    let Some(out) = asked.output else {
        return Err("an FMU is not for the screen: name a file with -o, as in -o x.fmu\n".to_owned().into());
    };
    if !out.is_dir() {
        asked.guard(out, &[file])?;
    }
    let library = library(matches.get_one::<PathBuf>("library").map(PathBuf::as_path))?;
    let of = asked.trains()?;
    let option = |name: &str| matches.get_one::<String>(name).map(String::as_str);
    let request = Request {
        scenario: option("scenario"),
        version: if option("fmi") == Some("3") { Version::Three } else { Version::Two },
        interface: match option("interface") {
            Some("cs") => Interface::CoSimulation,
            Some("me") => Interface::ModelExchange,
            _ => Interface::Both,
        },
        library: &library,
    };
    let unit = pack(&of[0].model, &request).map_err(|wrong| asked.refused(&wrong.into(), &of))?;
    let [inputs, parameters, outputs, states] = unit.counts;
    let about = format!(
        "scenario `{}`, FMI {}, {inputs} inputs, {parameters} parameters, {outputs} outputs, {states} states",
        unit.scenario,
        if request.version == Version::Three { "3.0" } else { "2.0" },
    );
    let name = Path::new(file).file_stem().map_or("train".into(), |s| s.to_string_lossy());
    let file = File { name: format!("{name}.fmu"), bytes: unit.bytes, about };
    Ok(Ended::Answered(deliver(vec![file], Some(out), asked.force)?))
}

/// The runtime: as named, or beside this program, or where libraries are installed.
fn library(named: Option<&Path>) -> Result<Vec<u8>, String> {
    let file = format!("{}{LIBRARY}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let read = |path: &Path| {
        let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}\n", path.display()))?;
        if is_runtime(&bytes) {
            return Ok(bytes);
        }
        Err(format!("{} is no runtime of an FMU; build it: cargo build --release -p willis-fmu\n", path.display()))
    };
    if let Some(path) = named.map(Path::to_owned).or(std::env::var_os(PLACE).map(PathBuf::from)) {
        return read(&path);
    }
    let own = std::env::current_exe().ok();
    let folder = own.as_deref().and_then(Path::parent);
    let places = folder.map(|f| [f.join(&file), f.join("../lib/willis").join(&file), f.join("deps").join(&file)]);
    match places.into_iter().flatten().find(|p| p.is_file()) {
        Some(path) => read(&path),
        None => Err(format!(
            "the runtime of an FMU, {file}, is not beside this program\n  build it once: cargo build --release -p willis-fmu; \
             then name it with --library or in {PLACE}\n"
        )),
    }
}

/// Whether bytes are a library of this platform that has what a host calls first.
fn is_runtime(bytes: &[u8]) -> bool {
    let begins: &[&[u8]] = match std::env::consts::OS {
        "windows" => &[b"MZ"],
        // For one kind of machine, or for several.
        "macos" => &[&[0xcf, 0xfa, 0xed, 0xfe], &[0xca, 0xfe, 0xba, 0xbe]],
        _ => &[b"\x7fELF"],
    };
    begins.iter().any(|mark| bytes.starts_with(mark))
        && bytes.split(|b| *b == b'f').any(|rest| rest.starts_with(b"mi2Instantiate"))
}
