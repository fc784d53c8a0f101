//! `willis draw` and `willis report`: pictures and documents, whole or not at all.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use sha2::{Digest, Sha256};
use willis::Diagnostics;
use willis::diagnostic::{Diagnostic, Severity};
use willis::model::Model;
use willis_figure::report::document::Document;
use willis_figure::{Ask, Drawing, Figure, FigureKind, FigureRequest, ReportRequest, Theme, html, png, themed};

use crate::output;

/// How a figure is to look.
pub struct Look {
    pub drawing: Drawing,
    pub theme: Theme,
    pub scale: f32,
}

/// What the name of a file asks for.
#[derive(Clone, Copy)]
enum Ending {
    Svg,
    Png,
    Json,
}

impl Ending {
    fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match ending.as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            Some("json") => Ok(Self::Json),
            _ => Err(format!("{}: its ending is none of .svg, .png, .json\n", path.display())),
        }
    }
}

/// Draws one kind, or all that apply into a folder.
pub fn draw(
    model: &Model,
    kind: &str,
    request: &FigureRequest,
    look: &Look,
    out: Option<&Path>,
    failure: &dyn Fn(Diagnostics) -> String,
) -> Result<String, String> {
    if kind == "all" {
        return every(model, request, look, out);
    }
    let kind = FigureKind::named(kind).map_err(failure)?;
    heard(kind, request, look)?;
    let ending = out.map_or(Ok(Ending::Svg), Ending::of)?;
    let figure = kind.make(model, request).map_err(|wrong| failure(with_others(wrong, model, request)))?;
    let bytes = picture(&figure, look, ending)?;
    match out {
        Some(path) => output::write(path, &bytes).map(|()| String::new()),
        None => Ok(String::from_utf8(bytes).expect("SVG is text") + "\n"),
    }
}

/// Refuses what would make no difference to this kind.
fn heard(kind: FigureKind, request: &FigureRequest, look: &Look) -> Result<(), String> {
    let Some(deaf) = kind.deaf_to(request, look.drawing) else { return Ok(()) };
    let list: Vec<String> = kind.takes().iter().map(|t| format!("--{}", t.name())).collect();
    let instead =
        if list.is_empty() { "it takes no question".to_owned() } else { format!("it takes {}", list.join(", ")) };
    Err(format!("`draw {}` has no use for --{}; {instead}\n", kind.name(), deaf.name()))
}

/// Where a kind does not apply to a train at all, those that do.
fn with_others(wrong: Diagnostics, model: &Model, request: &FigureRequest) -> Diagnostics {
    let asked = request.asks().iter().any(|a| matches!(a, Ask::State | Ask::Operation | Ask::Part | Ask::Over));
    let mut all: Vec<Diagnostic> = wrong.into_iter().collect();
    if !asked && let Some(first) = all.iter_mut().find(|d| d.severity == Severity::Error) {
        let others: Vec<&str> = FigureKind::applicable(model).into_iter().map(FigureKind::name).collect();
        first.hints.push(format!("of this train can be drawn: {}", others.join(", ")));
    }
    all.into_iter().collect()
}

fn picture(figure: &Figure, look: &Look, ending: Ending) -> Result<Vec<u8>, String> {
    let svg = || themed(&willis_figure::draw(figure, look.drawing), look.theme);
    match ending {
        Ending::Json => Ok((serde_json::to_string_pretty(figure).expect("plain data") + "\n").into_bytes()),
        Ending::Svg => Ok((svg() + "\n").into_bytes()),
        Ending::Png => png(&svg(), look.scale).map_err(|e| e + "\n"),
    }
}

/// Every kind that applies, as SVG into a folder.
fn every(model: &Model, request: &FigureRequest, look: &Look, out: Option<&Path>) -> Result<String, String> {
    let Some(folder) = out else {
        return Err("`all` draws several pictures: name a folder for them with -o\n".into());
    };
    if Ending::of(folder).is_ok() || folder.exists() && !folder.is_dir() {
        return Err(format!("{}: is no folder\n", folder.display()));
    }
    let made: Vec<(&FigureKind, Result<Figure, Diagnostics>)> =
        FigureKind::ALL.iter().map(|k| (k, k.make(model, request))).collect();
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}\n", folder.display()))?;
    let mut said = String::new();
    for (kind, figure) in made {
        match figure {
            Ok(figure) => {
                let path = folder.join(format!("{}.svg", kind.name()));
                output::write(&path, &picture(&figure, look, Ending::Svg)?)?;
                said += &format!("{}: {}\n", path.display(), figure.title());
            }
            Err(why) => {
                let first = why.iter().find(|d| d.severity == Severity::Error).map_or("", |d| d.message.as_str());
                said += &format!("{}: not drawn, {first}\n", kind.name());
            }
        }
    }
    Ok(said)
}

/// What a report says of the way in which it was made.
pub fn report_request(file: &str, text: &str, operation: Option<String>, laws: &[String]) -> ReportRequest {
    let hash: String = Sha256::digest(text.as_bytes()).iter().map(|b| format!("{b:02x}")).collect();
    // Without its folder: the same file makes the same report anywhere.
    let name = match file {
        "-" => "train.toml".to_owned(),
        _ => Path::new(file).file_name().map_or_else(|| file.to_owned(), |n| n.to_string_lossy().into_owned()),
    };
    let shown = quoted(&name);
    let mut more: Vec<String> = laws.iter().map(|l| format!(" --law {}", quoted(l))).collect();
    more.extend(operation.as_ref().map(|o| format!(" --operation {}", quoted(o))));
    let more = more.concat();
    let commands = vec![format!("willis analyze {shown}{more}"), format!("willis report {shown}{more} -o report.html")];
    let version = format!("willis {}", env!("CARGO_PKG_VERSION"));
    ReportRequest { operation, file: name, hash, version, commands }
}

/// As a shell takes it.
fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}

/// Typesets a document as the name of the file asks.
pub fn deliver(document: &Document, paper: &str, out: Option<&Path>) -> Result<String, String> {
    let json = || serde_json::to_string_pretty(document).expect("plain data") + "\n";
    let Some(path) = out else { return Ok(html(document)) };
    let ending = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    let bytes = match ending.as_deref() {
        Some("html" | "htm") => html(document).into_bytes(),
        Some("json") => json().into_bytes(),
        Some("pdf") => pdf(&json(), paper)?,
        _ => return Err(format!("{}: its ending is none of .html, .pdf, .json\n", path.display())),
    };
    output::write(path, &bytes).map(|()| String::new())
}

/// Typesetting takes long to build, so that a program of its own does it.
const TYPESETTER: &str = "willis-pdf";

/// The typesetter beside this program, where it was built in the tree, or on the path.
fn typesetter() -> PathBuf {
    let name = format!("{TYPESETTER}{}", std::env::consts::EXE_SUFFIX);
    let own = std::env::current_exe().ok();
    let beside = own.as_deref().and_then(Path::parent).map(|folder| folder.join(&name));
    let built = (own.as_deref())
        .and_then(|p| p.ancestors().nth(3))
        .map(|root| root.join("crates").join(TYPESETTER).join("target/release").join(&name));
    [beside, built].into_iter().flatten().find(|p| p.is_file()).unwrap_or_else(|| name.into())
}

fn pdf(json: &str, paper: &str) -> Result<Vec<u8>, String> {
    let program = typesetter();
    let missing = |e: std::io::Error| {
        format!(
            "a PDF is set by the program {TYPESETTER}, which could not be started: {e}\n  build it once (about five \
             minutes): cargo build --release --manifest-path crates/willis-pdf/Cargo.toml\n  or install it: cargo \
             install --path crates/willis-pdf\n  or write .html and print it\n"
        )
    };
    let mut command = Command::new(&program);
    command.args(["--paper", paper]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut running = command.spawn().map_err(missing)?;
    let mut input = running.stdin.take().expect("it was piped");
    let result = std::thread::scope(|scope| {
        // It may answer before it has read everything.
        scope.spawn(move || {
            let _ = input.write_all(json.as_bytes());
        });
        running.wait_with_output()
    });
    let done = result.map_err(|e| format!("{TYPESETTER}: {e}\n"))?;
    match done.status.success() && done.stdout.starts_with(b"%PDF") {
        true => Ok(done.stdout),
        false => Err(format!("{}\n", String::from_utf8_lossy(&done.stderr).trim_end())),
    }
}
