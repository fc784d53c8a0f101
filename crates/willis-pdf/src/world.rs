//! What typst sees: a template, a report or a figure, fonts. No files, no network, no clock.

use std::fmt::Write;
use std::sync::LazyLock;

use typst::diag::{FileError, FileResult, SourceDiagnostic};
use typst::foundations::{Bytes, Datetime, Dict, Duration, IntoValue};
use typst::syntax::{FileId, RootedPath, Source, VirtualPath, VirtualRoot};
use typst::text::{Font, FontBook};
use typst::utils::LazyHash;
use typst::{Library, LibraryExt, World};
use typst_kit::fonts::{self, FontStore};

/// Fonts carried along: the sans serif of figures, then typst's own for text, maths and code.
fn carried() -> impl Iterator<Item = Font> {
    use dejavu::{sans, sans_condensed};
    let files: [&'static [u8]; 5] =
        [sans::regular(), sans::bold(), sans::oblique(), sans_condensed::regular(), sans_condensed::bold()];
    let own = files.into_iter().flat_map(|file| Font::iter(Bytes::new(file)));
    own.chain(fonts::embedded().map(|(font, _)| font))
}

static REPORT: LazyLock<Source> =
    LazyLock::new(|| Source::new(file("report.typ"), include_str!("report.typ").to_owned()));
static PLATE: LazyLock<Source> = LazyLock::new(|| Source::new(file("plate.typ"), include_str!("plate.typ").to_owned()));
static DATA: LazyLock<FileId> = LazyLock::new(|| file("report.json"));

fn file(name: &str) -> FileId {
    FileId::new(RootedPath::new(VirtualRoot::Project, VirtualPath::new(name).expect("a plain name")))
}

/// What is set.
#[derive(Clone, Copy)]
pub enum Template {
    Report,
    Plate,
}

/// A desk with one report on it, or one figure.
pub struct Desk {
    template: &'static Source,
    library: LazyHash<Library>,
    fonts: FontStore,
    data: Bytes,
}

impl Desk {
    pub fn new(template: Template, data: String, paper: &str) -> Self {
        let mut inputs = Dict::new();
        inputs.insert("paper".into(), paper.into_value());
        let mut store = FontStore::new();
        let mut known = Vec::new();
        for font in carried() {
            let info = font.info().clone();
            known.push(info.coverage.clone());
            store.push((font, info));
        }
        // Chinese and other letters that no font here has: then those of the machine. Only then, so
        // that all other reports are the same everywhere.
        let strange = |c: char| !c.is_control() && !known.iter().any(|coverage| coverage.contains(c as u32));
        if data.chars().filter(|c| !c.is_ascii()).any(strange) {
            store.extend(fonts::system());
        }
        let library = Library::builder().with_inputs(inputs).build();
        let template = match template {
            Template::Report => &*REPORT,
            Template::Plate => &*PLATE,
        };
        Self { template, library: LazyHash::new(library), fonts: store, data: Bytes::from_string(data) }
    }
}

impl World for Desk {
    fn library(&self) -> &LazyHash<Library> {
        &self.library
    }

    fn book(&self) -> &LazyHash<FontBook> {
        self.fonts.book()
    }

    fn main(&self) -> FileId {
        self.template.id()
    }

    fn source(&self, id: FileId) -> FileResult<Source> {
        if id == self.template.id() { Ok(self.template.clone()) } else { Err(FileError::AccessDenied) }
    }

    fn file(&self, id: FileId) -> FileResult<Bytes> {
        if id == *DATA { Ok(self.data.clone()) } else { Err(FileError::AccessDenied) }
    }

    fn font(&self, index: usize) -> Option<Font> {
        self.fonts.font(index)
    }

    fn today(&self, _: Option<Duration>) -> Option<Datetime> {
        None
    }
}

/// What typst says, in lines.
pub fn words(all: &[SourceDiagnostic]) -> String {
    all.iter().fold(String::new(), |mut out, one| {
        let _ = write!(out, "{}{}", if out.is_empty() { "" } else { "\n" }, one.message);
        one.hints.iter().for_each(|hint| {
            let _ = write!(out, " ({})", hint.v);
        });
        out
    })
}
