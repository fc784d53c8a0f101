//! A question from the command line to its answer on the screen or in files.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ArgMatches;
use willis::Diagnostics;
use willis::diagnostic::Diagnostic;
use willis_ask::table::{self, Table};
use willis_ask::{Answer, Entry, Extra, File, Given, Refusal, style};

use crate::form::{CSV, JSON, JSON_LINES, PARQUET, PDF, TEXT, forms};
use crate::work::{Terminal, cores};
use crate::{Ended, input, output, pdf};

/// What the shared options say.
pub struct Asked<'a> {
    pub entry: &'static Entry,
    pub matches: &'a ArgMatches,
    /// Where the answer goes.
    pub output: Option<&'a Path>,
    pub force: bool,
    /// In which form.
    pub form: &'static str,
}

impl<'a> Asked<'a> {
    /// Reads the shared options; `natural` is the form where nothing says another.
    pub fn new(entry: &'static Entry, matches: &'a ArgMatches, natural: &'static str) -> Result<Self, Ended> {
        let output = matches.get_one::<PathBuf>("output").map(PathBuf::as_path);
        let known = forms(entry);
        let named = matches.get_one::<String>("format");
        let form = match (named, output) {
            (Some(name), _) => known.into_iter().find(|f| f == name).expect("clap knows the forms"),
            (None, None) => natural,
            (None, Some(path)) => promised(entry, &known, path, natural)?,
        };
        let table = matches.try_get_one::<String>("table").ok().flatten();
        if table.is_some() && ![CSV, JSON_LINES, PARQUET].contains(&form) {
            let told = format!("--table belongs to --format {CSV}, {JSON_LINES} or {PARQUET}");
            return Err(Ended::Misused(told));
        }
        if [PARQUET, PDF].contains(&form) && output.is_none() {
            return Err(format!("{form} is not for the screen: name a file with -o\n").into());
        }
        Ok(Self { entry, matches, output, force: matches.get_flag("force"), form })
    }

    /// Of an answer that is told on the screen in this form, whatever is written beside it.
    pub fn screen(entry: &'static Entry, matches: &'a ArgMatches, form: &'static str) -> Self {
        Self { entry, matches, output: None, force: matches.get_flag("force"), form }
    }

    /// The trains of the question.
    pub fn trains(&self) -> Result<Vec<Given>, Ended> {
        let files = self.matches.try_get_many::<String>("file").ok().flatten();
        let files: Vec<&String> = files.into_iter().flatten().collect();
        let read: Result<Vec<Given>, Refusal> = files.iter().map(|f| input::train(f, self.matches)).collect();
        read.map_err(|refusal| self.refused(&refusal, &[]))
    }

    /// A refusal as the form asks for it.
    pub fn refused(&self, refusal: &Refusal, of: &[Given]) -> Ended {
        if *refusal == Refusal::Cancelled {
            return Ended::Interrupted { out: String::new(), told: "interrupted: there is no answer\n".into() };
        }
        let json = || willis_ask::json(&refusal.report(of));
        Ended::Refused { out: if self.form == JSON { json() } else { String::new() }, told: refusal.render(of, true) }
    }

    /// Refuses to write over what is read, or over what is there.
    pub fn guard(&self, path: &Path, files: &[&str]) -> Result<(), Ended> {
        let read: Vec<&Path> = files.iter().map(Path::new).collect();
        output::apart(path, &read)?;
        output::free(path, self.force)?;
        Ok(())
    }

    /// The same for something beside the answer, which says how its name ends or that it is a folder.
    pub fn guard_extra(&self, extra: &Extra, path: &Path, files: &[&str]) -> Result<(), Ended> {
        let wrong = |why: String| Err(format!("{}: {why}\n", path.display()).into());
        match Path::new(extra.value).extension() {
            None if path.exists() && !path.is_dir() => wrong("is no folder".into()),
            None => Ok(()),
            Some(ending) if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case(ending)) => {
                wrong(format!("--{} writes {1}; end the name with .{1}", extra.name, ending.to_string_lossy()))
            }
            Some(_) => self.guard(path, files),
        }
    }
}

/// The form that the name of a file promises.
fn promised(entry: &Entry, known: &[&'static str], path: &Path, natural: &'static str) -> Result<&'static str, Ended> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let own = |e: &str| entry.forms.iter().find(|f| f.endings.contains(&e)).map(|f| f.name);
    let shared = |e: &str| match e {
        "txt" => Some(TEXT),
        "json" => Some(JSON),
        "csv" => Some(CSV),
        "jsonl" | "ndjson" => Some(JSON_LINES),
        "parquet" => Some(PARQUET),
        "pdf" => Some(PDF),
        _ => None,
    };
    // What writes files of any name does so whatever the ending.
    if own("*").is_some_and(|f| f == natural) {
        return Ok(natural);
    }
    match &ending {
        // A folder, for an answer of several files.
        None if entry.forms.iter().any(|f| f.name == natural) => Ok(natural),
        Some(e) if own(e).or(shared(e)).is_some_and(|f| known.contains(&f)) => {
            Ok(own(e).or(shared(e)).expect("it was just found"))
        }
        _ => {
            let own = entry.forms.iter().flat_map(|f| f.endings.iter().copied());
            let shared = known.iter().filter(|form| entry.forms.iter().all(|f| f.name != **form));
            let endings = own.chain(shared.map(|form| if *form == TEXT { "txt" } else { form }));
            let list = endings.map(|e| format!(".{e}")).collect::<Vec<_>>().join(", ");
            Err(format!("{}: its ending is none of {list}; name one of them, or give --format\n", path.display())
                .into())
        }
    }
}

/// Asks a question and hands out the answer.
pub fn run(entry: &'static Entry, matches: &ArgMatches) -> Result<Ended, Ended> {
    run_on(cores(), entry, matches)
}

/// The same with so many threads.
pub fn run_on(threads: usize, entry: &'static Entry, matches: &ArgMatches) -> Result<Ended, Ended> {
    let mut request = entry.of_matches(matches).unwrap_or_else(|e| e.exit());
    let asked = Asked::new(entry, matches, request.natural_form())?;
    let names: Vec<String> = request.attachments().iter().map(|(a, _)| a.name.clone()).collect();
    let files: Vec<&String> = matches.try_get_many("file").ok().flatten().into_iter().flatten().collect();
    let read: Vec<&str> = files.iter().map(|f| f.as_str()).chain(names.iter().map(String::as_str)).collect();
    if read.iter().filter(|f| **f == "-").count() > 1 {
        return Err("standard input is either the train file or the profile\n".to_owned().into());
    }
    let extras: Vec<(&Extra, &PathBuf)> =
        entry.extras.iter().filter_map(|e| Some((e, matches.get_one(e.name)?))).collect();
    let several = asked.output.is_some_and(|p| p.is_dir() || p.extension().is_none());
    if let (Some(path), false) = (asked.output, several) {
        asked.guard(path, &read)?;
    }
    for (extra, path) in &extras {
        asked.guard_extra(extra, path, &read)?;
    }
    // Before anything is computed for it.
    let typesetter = (asked.form == PDF).then(pdf::Typesetter::find).transpose()?;
    for (file, holds) in request.attachments() {
        match input::attached(&file.name, holds) {
            Ok(text) => file.text = text,
            Err(wrong) => return Err(asked.refused(&Refusal::File(wrong, file.clone()), &[])),
        }
    }
    let of = asked.trains()?;
    let terminal = Terminal::new(threads, matches!(matches.try_get_one("yes"), Ok(Some(true))));
    let answer = request.ask(&of, &terminal).map_err(|refusal| asked.refused(&refusal, &of))?;
    terminal.finish();
    for (extra, path) in extras {
        let files = answer.extra(extra.name).map_err(|refusal| asked.refused(&refusal, &of))?;
        deliver(files, Some(path), asked.force)?;
    }
    let said = hand_out(&asked, typesetter.as_ref(), &*answer, &of)?;
    Ok(match answer.is_partial() {
        true => Ended::Interrupted { out: said, told: String::new() },
        false => Ended::Answered(said),
    })
}

/// The answer in the form that was asked for, at the place that was named.
fn hand_out(
    asked: &Asked<'_>,
    typesetter: Option<&pdf::Typesetter>,
    answer: &dyn Answer,
    of: &[Given],
) -> Result<String, Ended> {
    let file = match asked.form {
        TEXT => {
            let notes = notes(&answer.notes(), of);
            let text = match asked.entry.notes_first {
                true => notes + &answer.text(),
                false => answer.text() + &notes,
            };
            if asked.output.is_none() {
                tell(&answer.told());
                return Ok(text);
            }
            // A file takes no colours.
            vec![File::text(format!("{}.txt", asked.entry.name), style::plain(&text))]
        }
        JSON => vec![File::text(format!("{}.json", asked.entry.name), answer.json())],
        CSV | JSON_LINES | PARQUET => vec![tables(asked, &answer.tables())?],
        PDF => {
            let typesetter = typesetter.expect("it was found before the question was asked");
            let paper = pdf::paper(asked.matches);
            if asked.entry.forms.iter().any(|f| f.name == pdf::PLATE) {
                let plates = answer.write(pdf::PLATE).map_err(|refusal| asked.refused(&refusal, of))?;
                let set = |plate: File| {
                    let name = plate.name.replace(pdf::PLATE_ENDING, ".pdf");
                    Ok(File { name, bytes: typesetter.set(&plate.bytes, paper)?, about: plate.about })
                };
                plates.into_iter().map(set).collect::<Result<Vec<_>, String>>()?
            } else {
                let bytes = typesetter.set(answer.json().as_bytes(), paper)?;
                vec![File { name: format!("{}.pdf", asked.entry.name), bytes, about: String::new() }]
            }
        }
        other => answer.write(other).map_err(|refusal| asked.refused(&refusal, of))?,
    };
    let said = deliver(file, asked.output, asked.force)?;
    tell(&answer.told());
    // Text has them in it; what machines read comes alone.
    let unsaid = if [TEXT, JSON, CSV, JSON_LINES, PARQUET].contains(&asked.form) { vec![] } else { answer.unsaid() };
    if !unsaid.is_empty() {
        tell(&[notes(&unsaid, of).trim_end().to_owned()]);
    }
    Ok(said)
}

/// Tables of an answer as a file.
fn tables(asked: &Asked<'_>, all: &[Table]) -> Result<File, Ended> {
    let wanted = asked.matches.try_get_one::<String>("table").ok().flatten();
    let named = |t: &&Table| wanted.map_or(!t.is_aside, |w| *w == t.name);
    let chosen: Vec<Table> = all.iter().filter(named).cloned().collect();
    let list = || all.iter().map(|t| t.name.as_str()).collect::<Vec<_>>().join(", ");
    if chosen.is_empty() {
        let name = wanted.map_or("", String::as_str);
        return Err(format!("this answer has no table `{name}`; it has: {}\n", list()).into());
    }
    let name = format!("{}.{}", asked.entry.name, asked.form);
    if asked.form == CSV {
        return Ok(File::text(name, table::csv(&chosen)));
    }
    let [one] = chosen.as_slice() else {
        return Err(format!("{} takes one table: name it with --table, one of {}\n", asked.form, list()).into());
    };
    if asked.form == JSON_LINES {
        return Ok(File::text(name, one.json_lines()));
    }
    #[cfg(feature = "parquet")]
    return Ok(File { name, bytes: crate::parquet::of(one)?, about: String::new() });
    #[cfg(not(feature = "parquet"))]
    unreachable!("clap does not know the form")
}

/// Warnings and notes, each at its place in the first train's file.
pub fn notes(all: &[Diagnostic], of: &[Given]) -> String {
    let mut told: Diagnostics = all.iter().cloned().collect();
    let Some(given) = of.first() else { return told.render("", "", true) };
    given.model.locate(&mut told);
    told.render(&given.name, given.model.to_toml(), true)
}

/// Lines for standard error.
pub fn tell(lines: &[String]) {
    let text: String = lines.iter().map(|l| format!("{l}\n")).collect();
    let _ = anstream::stderr().write_all(text.as_bytes());
}

/// Writes files where they are to be, or gives the only one back where no place is named. Says what was written.
pub fn deliver(files: Vec<File>, place: Option<&Path>, force: bool) -> Result<String, Ended> {
    let Some(place) = place else {
        let count = files.len();
        let Ok([one]) = <[File; 1]>::try_from(files) else {
            return Err(format!("this makes {count} files: name a folder for them with -o\n").into());
        };
        return String::from_utf8(one.bytes)
            .map_err(|_| format!("{} is not for the screen: name a file with -o\n", one.name).into());
    };
    let folder = files.len() != 1 || place.is_dir() || place.as_os_str().to_string_lossy().ends_with(['/', '\\']);
    if folder && (place.exists() && !place.is_dir() || place.extension().is_some() && !place.is_dir()) {
        return Err(format!("{}: is no folder, and there are several files\n", place.display()).into());
    }
    let paths: Vec<PathBuf> = match folder {
        true => files.iter().map(|f| place.join(&f.name)).collect(),
        false => vec![place.to_owned()],
    };
    if let Some(k) = (1..paths.len()).find(|&k| paths[..k].contains(&paths[k])) {
        let told = format!("{}: two files have this name; ask for them one by one\n", paths[k].display());
        return Err(told.into());
    }
    if folder {
        std::fs::create_dir_all(place).map_err(output::told(place))?;
    }
    paths.iter().try_for_each(|path| output::free(path, force))?;
    let whole: Vec<(&Path, &[u8])> = paths.iter().zip(&files).map(|(p, f)| (p.as_path(), &*f.bytes)).collect();
    output::write_all(&whole, force)?;
    let said = paths.iter().zip(&files).filter(|(_, f)| !f.about.is_empty());
    Ok(said.map(|(path, f)| format!("{}: {}\n", path.display(), f.about)).collect())
}
