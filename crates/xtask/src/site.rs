//! `cargo xtask site`: the book, the gallery, the validation pages, the studio and the references of the library and of the Python
//! package as one folder of static files. It works from a folder without a network; every link is checked.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Component, Path, PathBuf};

use toml::Value;

use crate::book::mdbook;
use crate::context::{Context, passes, said};
use crate::examples::example_files;
use crate::program::build_willis;
use crate::reference::about;
use crate::step::Outcome;
use crate::studio::studio_page;

/// What cannot be had makes the task skipped, everything else makes it fail.
pub(crate) fn site(context: &Context) -> Outcome {
    let program = match mdbook(context) {
        Ok(program) => program,
        Err(why) => return Outcome::Skipped(why),
    };
    let site = context.target.join("site");
    match build_site(context, &program, &context.target.join("site-source"), &site) {
        Ok(told) => {
            println!("{told}");
            Outcome::Passed
        }
        Err(why) => Outcome::Failed(why),
    }
}

/// Writes the source of the pages and the site into two folders, which are emptied before.
pub(crate) fn build_site(context: &Context, program: &Path, source: &Path, site: &Path) -> Result<String, String> {
    build_willis(context)?;
    let studio = match &context.options.studio {
        Some(file) => file.clone(),
        None => studio_page(context)?,
    };
    for folder in [source, site] {
        let _ = fs::remove_dir_all(folder);
    }
    let pages = source.join("src");
    let trains = assemble(context, &pages)?;
    write(&source.join("book.toml"), BOOK)?;
    write(&source.join("search.js"), SEARCH)?;
    write(&source.join("search.css"), STYLE)?;
    write(&source.join("search-index.js"), &index(&pages)?)?;
    let mut build = context.command(program);
    build.arg("build").arg(source).arg("--dest-dir").arg(site);
    let words = said(&build);
    passes(&mut build, &words)?;
    copy(&studio, &site.join("studio.html"))?;
    copy_folder(&context.root.join("schema"), &site.join("schema"), &|_| true)?;
    if !context.options.no_api {
        context.run("cargo doc --workspace --no-deps --quiet")?;
        let kept = |path: &Path| !path.ends_with("src") && !path.ends_with("help.html");
        copy_folder(&context.target.join("doc"), &site.join("api"), &kept)?;
    }
    let links = check(site, !context.options.no_api)?;
    Ok(format!("{}: {trains} trains in the gallery, {links} links checked", site.join("index.html").display()))
}

pub(crate) fn write(path: &Path, text: &str) -> Result<(), String> {
    let fail = |e: std::io::Error| format!("{}: {e}", path.display());
    fs::create_dir_all(path.parent().expect("a folder")).map_err(fail)?;
    fs::write(path, text).map_err(fail)
}

pub(crate) fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

pub(crate) fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let fail = |e: std::io::Error| format!("{}: {e}", from.display());
    fs::create_dir_all(to.parent().expect("a folder")).map_err(fail)?;
    fs::copy(from, to).map(drop).map_err(fail)
}

/// Copies a folder with all that is in it and kept.
pub(crate) fn copy_folder(from: &Path, to: &Path, kept: &dyn Fn(&Path) -> bool) -> Result<(), String> {
    for path in entries(from)? {
        let to = to.join(path.file_name().expect("an entry has a name"));
        match (kept(&path), path.is_dir()) {
            (false, _) => {}
            (true, true) => copy_folder(&path, &to, kept)?,
            (true, false) => copy(&path, &to)?,
        }
    }
    Ok(())
}

// The pages

/// Pages of the repository that stand in the site beside the book: title, file.
const MORE: &[(&str, &str)] = &[
    ("Symbols in the code", "NOMENCLATURE.md"),
    ("Reasons: why it is so", "DESIGN.md"),
    ("Where to find what", "ARCHITECTURE.md"),
    ("How to add something", "CONTRIBUTING.md"),
    ("What is new", "CHANGELOG.md"),
];

/// Validation pages: title, file.
const VALIDATION: &[(&str, &str)] = &[
    ("Published and enumerated numbers", "validation/README.md"),
    ("Esmail 2018, Table 1", "validation/esmail-2018-table-1/README.md"),
    ("Losses", "validation/losses/README.md"),
    ("Wang and others 2020", "validation/wang-2020/README.md"),
    ("Wang 2020, table by table", "validation/wang-2020/report.md"),
    ("Galvagno 2010", "validation/galvagno/README.md"),
    ("Modelica", "validation/modelica/README.md"),
    ("Searches for trains", "validation/design/README.md"),
    ("How the enumerations were made", "validation/reference/README.md"),
];

/// Writes the source of all pages. How many trains the gallery has.
fn assemble(context: &Context, pages: &Path) -> Result<usize, String> {
    let root = &context.root;
    copy_folder(&root.join("book/src"), pages, &|_| true)?;
    dark_pictures(&pages.join("figures"))?;
    link_validation(pages)?;
    copy_folder(&root.join("validation"), &pages.join("validation"), &|_| true)?;
    copy_folder(&root.join("examples"), &pages.join("examples"), &|_| true)?;
    let mut summary =
        read(&root.join("book/src/SUMMARY.md"))?.replace("# Summary\n", "# Summary\n\n[Willis](start.md)\n");
    let trains = gallery(context, pages, &mut summary)?;
    summary += "\n# Validation\n\n";
    for (title, file) in VALIDATION {
        writeln!(summary, "- [{title}]({})", as_index(file)).expect("to a text");
    }
    summary += "\n# Programs\n\n- [The Rust library](api-pages.md)\n- [The Python package](python-pages.md)\n";
    let api = "# The Rust library\n\n[Using the library](library.md) begins with a program. [Every item with its documentation](api/willis/index.html).\n\n\
               | crate | what it is for |\n|---|---|\n| [willis](api/willis/index.html) | ratios, torques, losses, regimes, motion |\n\
               | [willis_synthesis](api/willis_synthesis/index.html) | searches for tooth numbers and shift schemes |\n\
               | [willis_figure](api/willis_figure/index.html) | figures and reports |\n\
               | [willis_ask](api/willis_ask/index.html) | all questions as data |\n";
    let api = if context.options.no_api { "# The Rust library\n\n[Using the library](library.md)\n" } else { api };
    write(&pages.join("api-pages.md"), api)?;
    write(&pages.join("python-pages.md"), &python(context)?)?;
    summary += "\n# The project\n\n";
    for (title, file) in MORE {
        copy(&root.join(file), &pages.join(file))?;
        writeln!(summary, "- [{title}]({file})").expect("to a text");
    }
    write(&pages.join("start.md"), &START.replace("TRAINS", &trains.to_string()))?;
    write(&pages.join("SUMMARY.md"), &summary)?;
    for (_, file) in VALIDATION.iter().chain(MORE) {
        let path = pages.join(file);
        let text = without_lost_links(&read(&path)?, path.parent().expect("a folder"));
        fs::remove_file(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        write(&pages.join(as_index(file)), &as_index(&text))?;
    }
    Ok(trains)
}

/// Pictures that were drawn for paper alone get a dark look of their own, which keeps their hues.
fn dark_pictures(folder: &Path) -> Result<(), String> {
    const DARK: &str =
        "<style>@media (prefers-color-scheme: dark) { :root { filter: invert(0.93) hue-rotate(180deg); } }</style>";
    for path in entries(folder)? {
        if path.extension().is_none_or(|e| e != "svg") {
            continue;
        }
        let text = read(&path)?;
        let open = text.find("<svg").and_then(|at| Some(at + text[at..].find('>')? + 1));
        if let (Some(open), false) = (open, text.contains("prefers-color-scheme")) {
            write(&path, &format!("{}\n{DARK}{}", &text[..open], &text[open..]))?;
        }
    }
    Ok(())
}

/// In the repository chapters name the validation pages by their files; in the site they are links.
fn link_validation(pages: &Path) -> Result<(), String> {
    for path in entries(pages)? {
        if path.extension().is_none_or(|e| e != "md") {
            continue;
        }
        let text = read(&path)?;
        let linked = VALIDATION.iter().fold(text.clone(), |text, (title, file)| {
            text.replace(&format!("`{file}`"), &format!("[{title}]({})", as_index(file)))
        });
        if linked != text {
            write(&path, &linked)?;
        }
    }
    Ok(())
}

/// What is in a folder.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let fail = |e: std::io::Error| format!("{}: {e}", folder.display());
    fs::read_dir(folder).map_err(fail)?.map(|e| Ok(e.map_err(fail)?.path())).collect()
}

/// Names and links of pages: a page of a folder is its index.
fn as_index(text: &str) -> String {
    match text.ends_with("README.md") {
        true => text.replace("README.md", "index.md"),
        false => text.replace("README.md)", "index.md)"),
    }
}

/// Text whose links to files that the site does not have are words only.
fn without_lost_links(text: &str, folder: &Path) -> String {
    let mut all = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find("](") {
        let (before, after) = rest.split_at(at);
        let end = after.find(')').unwrap_or(after.len() - 1);
        let target = after[2..].split(')').next().unwrap_or_default();
        let file = target.split('#').next().unwrap_or_default();
        let lost = !file.is_empty() && !file.contains("://") && !file.contains(char::is_whitespace) && {
            let path = folder.join(file);
            !path.is_file()
        };
        if let (true, Some(open)) = (lost, before.rfind('[')) {
            all += &before[..open];
            all += &before[open + 1..];
        } else {
            all += before;
            all += &after[..=end];
        }
        rest = &after[end + 1..];
    }
    all + rest
}

const START: &str = "# Willis

Planetary gear trains: exact ratios and speeds, torques with tooth friction, power flow, losses, motion, and whether the answer is the
only one.

![Stick diagram of the 8HP70 in third gear with the power path](figures/8hp70-stick.svg)

| | |
|---|---|
| [The first train](first-train.md) | install, one file, one answer |
| [The studio](studio.html) | a train in the browser: drag a speed, close a clutch, change teeth |
| [Gallery](gallery/index.md) | TRAINS trains with pictures, file and report; each opens in the studio |
| [Guides](shift-tables.md) | one job each: shift table, losses, maps, power split, shifting, design, report |
| [How it works](verdict.md) | uniqueness, regimes, motion, and what is proved, checked and uncertain |
| [Reference](reference-keys.md) | train file, commands, formats, diagnostics, loss laws |
| [Validation](validation/index.md) | every number that is compared, with its source |
| [For teachers](teachers.md) | ten exercises with solutions |

All pages work without a network. The field at the top searches them; the key `/` goes there.
";

/// Pages of all examples.
fn gallery(context: &Context, pages: &Path, summary: &mut String) -> Result<usize, String> {
    *summary += "\n# Gallery\n\n- [All trains](gallery/index.md)\n";
    let mut overview =
        "# Gallery\n\nEvery example with its pictures, file and report. *Studio* opens it in the browser.\n\n\
                        <div class=\"gallery\">\n"
            .to_owned();
    let files = example_files(context)?;
    for file in &files {
        let short = file.trim_start_matches("examples/").trim_end_matches(".toml");
        let (name, source) = about(context, file)?;
        let folder = pages.join("gallery").join(short);
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let run = |words: &[&str], target: &Path| {
            let mut command = context.willis();
            command.args(words).arg(file).args(["--force", "-o"]).arg(target);
            context.output(&mut command)
        };
        let drawn = run(&["draw", "all", "--coarse", "--theme", "auto"], &folder)?;
        run(&["report"], &folder.join("report.html"))?;
        let answer = context.output(context.willis().arg("analyze").arg(file))?.stdout;
        let text = read(&context.root.join(file))?;
        let studio = studio_link(&text, &format!("{short}.toml"))?;
        let mut page = format!("# {name}\n\n");
        if !source.is_empty() {
            write!(page, "Source: {source}\n\n").expect("to a text");
        }
        write!(
            page,
            "[Open in the studio](../studio.html{studio}) · [Report]({short}/report.html) · [Train file](../examples/{short}.toml)\n\n"
        )
        .expect("to a text");
        let drawn = String::from_utf8_lossy(&drawn.stdout).into_owned();
        let mut figures = Vec::new();
        for line in drawn.lines() {
            let Some((path, title)) = line.split_once(": ") else { continue };
            if let Some(figure) = Path::new(path).file_name().and_then(|n| n.to_str()).filter(|n| n.ends_with(".svg")) {
                figures.push(figure.to_owned());
                write!(page, "![{title} of the train {name}]({short}/{figure})\n\n").expect("to a text");
            }
        }
        write!(
            page,
            "## Answer\n\n```text\n$ willis analyze {file}\n{}\n```\n\n## File\n\n```toml\n{}\n```\n",
            String::from_utf8_lossy(&answer).trim_end(),
            text.trim_end()
        )
        .expect("to a text");
        write(&pages.join("gallery").join(format!("{short}.md")), &page)?;
        writeln!(summary, "  - [{name}](gallery/{short}.md)").expect("to a text");
        let first =
            ["stick.svg", "lever.svg", "flow.svg", "front.svg"].into_iter().find(|f| figures.iter().any(|g| g == f));
        let picture = first.or(figures.first().map(String::as_str));
        let picture = picture.map_or(String::new(), |f| {
            format!(
                "<a href=\"{short}.html\"><img loading=\"lazy\" src=\"{short}/{f}\" alt=\"{} of this train\"></a>",
                words(f)
            )
        });
        writeln!(
            overview,
            "<div>{picture}<br><a href=\"{short}.html\">{}</a><br><a href=\"../studio.html{studio}\">Studio</a> · <a \
             href=\"{short}/report.html\">Report</a></div>",
            html(&name)
        )
        .expect("to a text");
    }
    overview += "</div>\n";
    write(&pages.join("gallery/index.md"), &overview)?;
    Ok(files.len())
}

/// What a file of a figure shows.
fn words(figure: &str) -> &'static str {
    match figure {
        "stick.svg" => "Stick diagram",
        "lever.svg" => "Levers",
        "flow.svg" => "Power flow",
        _ => "Picture",
    }
}

fn html(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The end of an address that opens an example in the studio at its first operating point: what `link.ts` of the studio reads.
fn studio_link(text: &str, name: &str) -> Result<String, String> {
    let train: toml::Table = text.parse().map_err(|e| format!("{name}: {e}"))?;
    let first = |key: &str| train.get(key).and_then(Value::as_array).and_then(|a| a.first()).and_then(Value::as_table);
    let json = |value: Option<&Value>, default: &str| value.map_or(Ok(default.to_owned()), |v| to_json(v, name));
    let point = match (first("operation"), first("state")) {
        (Some(of), _) => {
            let more: Vec<String> = ["store", "temperature"]
                .into_iter()
                .filter_map(|key| Some(to_json(of.get(key)?, name).map(|v| format!("\"{key}\":{v}"))))
                .collect::<Result<_, _>>()?;
            format!(
                "{{\"state\":{},\"speeds\":{},\"torques\":{},\"powers\":{},\"fixed\":{},\"more\":{{{}}}}}",
                json(of.get("state"), "null")?,
                json(of.get("speeds"), "{}")?,
                json(of.get("torques"), "{}")?,
                json(of.get("powers"), "{}")?,
                json(of.get("fixed"), "[]")?,
                more.join(",")
            )
        }
        (None, state) => {
            let input =
                train.get("input").or_else(|| train.get("terminals")?.as_array()?.first()).and_then(Value::as_str);
            let at = |value: &str| input.map_or("{}".into(), |i| format!("{{\"{i}\":\"{value}\"}}"));
            format!(
                "{{\"state\":{},\"speeds\":{},\"torques\":{}}}",
                json(state.and_then(|s| s.get("name")), "null")?,
                at("1000 rpm"),
                at("100 N m")
            )
        }
    };
    let held = format!("{{\"t\":\"{name}\",\"p\":{point},\"v\":{{}},\"w\":\"{}\"}}", env!("CARGO_PKG_VERSION"));
    Ok(format!("#1.{}", base64(&stored(held.as_bytes()))))
}

fn to_json(value: &Value, name: &str) -> Result<String, String> {
    serde_json::to_string(value).map_err(|e| format!("{name}: {e}"))
}

/// Bytes as a stream of *deflate* with blocks that are not compressed.
fn stored(bytes: &[u8]) -> Vec<u8> {
    const MOST: usize = 0xffff;
    let mut all = Vec::with_capacity(bytes.len() + 5);
    let blocks = bytes.chunks(MOST).count().max(1);
    for k in 0..blocks {
        let block = bytes.chunks(MOST).nth(k).unwrap_or_default();
        let length = u16::try_from(block.len()).expect("a block is no longer");
        all.push(u8::from(k + 1 == blocks));
        all.extend(length.to_le_bytes());
        all.extend((!length).to_le_bytes());
        all.extend(block);
    }
    all
}

/// Base 64 for addresses, without padding.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
    let mut all = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|k| u32::from(chunk.get(k).copied().unwrap_or(0)));
        let number = a << 16 | b << 8 | c;
        for k in 0..=chunk.len() {
            all.push(char::from(DIGITS[(number >> (18 - 6 * k) & 63) as usize]));
        }
    }
    all
}

/// The methods of the Python package with what they say of themselves.
fn python(context: &Context) -> Result<String, String> {
    let folder = context.root.join("crates/willis-py");
    let mut page = read(&folder.join("README.md"))?.replacen("# willis", "# The Python package", 1);
    page = page.split("\n## Build").next().unwrap_or_default().to_owned();
    page += "\n\n[Willis in Python](python.md) is a chapter with examples.\n\n# Methods and functions\n\n";
    for file in ["_train.py", "_questions.py", "_compiled.py"] {
        for (signature, about) in python_items(&read(&folder.join("python/willis").join(file))?) {
            let name = signature.split('(').next().unwrap_or_default().trim_start_matches("def ").to_owned();
            // Parameters and examples stand in lines of their own there.
            let (about, more) = about.split_once("\n\nParameters\n").unwrap_or((&about, ""));
            write!(page, "## {name}\n\n```python\n{signature}\n```\n\n{about}\n\n").expect("to a text");
            if !more.is_empty() {
                write!(page, "```text\nParameters\n{more}\n```\n\n").expect("to a text");
            }
        }
    }
    Ok(page.trim_end().to_owned() + "\n")
}

/// Public functions and methods of a Python file that say what they do.
fn python_items(text: &str) -> Vec<(String, String)> {
    let mut all = Vec::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let Some(start) = line.trim_start().strip_prefix("def ").filter(|d| !d.starts_with('_')) else { continue };
        let mut signature = vec![format!("def {start}")];
        let mut last = line;
        while !last.trim_end().ends_with(':') {
            let Some(next) = lines.next() else { return all };
            signature.push(next.strip_prefix("    ").unwrap_or(next).to_owned());
            last = next;
        }
        let Some(first) = lines.peek().and_then(|l| l.trim_start().strip_prefix("\"\"\"")) else { continue };
        let mut about = vec![first.to_owned()];
        lines.next();
        while !about.last().is_some_and(|l| l.ends_with("\"\"\"")) {
            let Some(next) = lines.next() else { break };
            about.push(next.trim().to_owned());
        }
        let about = about.join("\n");
        all.push((signature.join("\n"), about.trim_end_matches("\"\"\"").trim().to_owned()));
    }
    all
}

// What is added to every page

const BOOK: &str = r#"[book]
title = "Willis"
description = "Planetary gear trains: exact ratios, lossy torques, and whether the answer is the only one"
language = "en"
src = "src"

[output.html]
no-section-label = true
additional-css = ["search.css"]
additional-js = ["search-index.js", "search.js"]

[output.html.playground]
runnable = false

[output.html.fold]
enable = true
level = 0

[output.html.print]
enable = false
"#;

const STYLE: &str = "
#find { align-self: center; width: 14em; max-width: 38vw; margin: 0 .5em; padding: .2em .5em; font-size: 1.4rem; border: 1px solid var(--icons);
  border-radius: 4px; background: var(--bg); color: var(--fg); }
#found { position: absolute; right: 1em; top: 100%; width: min(36em, 92vw); max-height: 70vh; overflow: auto; z-index: 200;
  background: var(--bg); color: var(--fg); border: 1px solid var(--icons); font-size: 1.4rem; }
#found a { display: block; padding: .4em .8em; color: var(--links); text-decoration: none; }
#found a:hover, #found a:focus { background: var(--theme-hover); }
#found small { display: block; opacity: .75; color: var(--fg); }
#mdbook-menu-bar, #menu-bar { position: relative; }
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(15em, 1fr)); gap: 1.5em; }
.gallery img { width: 100%; height: 11em; object-fit: contain; object-position: left bottom; }
.content img { max-width: 100%; }
/* Pictures, outputs and tables are wide; lines of text are not. */
:root { --content-max-width: 1000px; }
.content main > :is(p, ul, ol, blockquote, .footnote-definition):not(:has(img)) { max-width: 46em; }
.content pre code { font-size: .82em; }
.content table { display: block; overflow-x: auto; font-size: .94em; }
html.navy, html.coal, html.ayu { --links: #6db8e3; --sidebar-active: #6db8e3; }
html.rust { --links: #1d5c80; --inline-code-color: #65650a; }
html.coal { --table-header-bg: hsl(0, 0%, 20%); }
.menu-title { color: var(--fg); }
.content thead:not(:has(th:not(:empty))) { display: none; }
/* The arrows beside the text only where there is room for them. */
@media (max-width: 1560px) { .nav-wide-wrapper { display: none; } .nav-wrapper { display: block; } }
@media (max-width: 600px) {
  .menu-title { display: none; }
  #find { width: 34vw; }
  .content pre code { font-size: .72em; }
  .content table { font-size: .85em; }
  .content table :is(td, th) { padding: .2em .6em; }
}
";

/// A search over headings and texts, and pictures that open alone, where a phone shows them too small. The index is a script,
/// because a page from a folder may not fetch a file.
const SEARCH: &str = r##""use strict";
for (const picture of document.querySelectorAll(".content img")) {
  if (picture.closest("a")) continue;
  const link = Object.assign(document.createElement("a"), { href: picture.src, title: "This picture alone, to enlarge it" });
  picture.replaceWith(link);
  link.append(picture);
}
(() => {
  const bar = document.querySelector(".right-buttons");
  const index = window.willisIndex;
  if (!bar || !index) return;
  const root = typeof path_to_root === "string" ? path_to_root : "";
  const find = Object.assign(document.createElement("input"), { id: "find", type: "search", placeholder: "Search ( / )" });
  find.setAttribute("aria-label", "Search all pages");
  const found = Object.assign(document.createElement("div"), { id: "found", hidden: true });
  bar.before(find);
  bar.after(found);
  const small = index.map(([title, page, , text]) => [(title + " " + page).toLowerCase(), text.toLowerCase()]);
  find.addEventListener("input", () => {
    const words = find.value.toLowerCase().split(/\s+/).filter(Boolean);
    const hits = [];
    if (words.join("").length > 1) {
      small.forEach(([head, text], k) => {
        let score = 0;
        for (const word of words) {
          const here = (head.includes(word) ? 4 : 0) + (text.includes(word) ? 1 : 0);
          if (!here) return;
          score += here;
        }
        hits.push([score, k]);
      });
    }
    hits.sort((a, b) => b[0] - a[0] || a[1] - b[1]);
    found.replaceChildren(...hits.slice(0, 20).map(([, k]) => {
      const [title, page, url, text] = index[k];
      const link = Object.assign(document.createElement("a"), { href: root + url, textContent: title });
      const at = Math.max(0, text.toLowerCase().indexOf(words[0]) - 40);
      link.append(Object.assign(document.createElement("small"), { textContent: page + ": " + text.slice(at, at + 120) }));
      return link;
    }));
    if (words.length && !hits.length) found.textContent = "Nothing found.";
    found.hidden = !words.length;
  });
  find.addEventListener("keydown", (e) => {
    e.stopPropagation();
    if (e.key === "Enter") found.querySelector("a")?.click();
    if (e.key === "Escape") { find.value = ""; found.hidden = true; find.blur(); }
  });
  document.addEventListener("keydown", (e) => {
    if (e.key === "/" && !/^(INPUT|TEXTAREA)$/.test(document.activeElement?.tagName ?? "")) { e.preventDefault(); find.focus(); }
  });
})();
"##;

/// The script with heading, page, address and text of every section.
fn index(pages: &Path) -> Result<String, String> {
    let summary = read(&pages.join("SUMMARY.md"))?;
    let mut all = Vec::new();
    for line in summary.lines() {
        let Some((title, file)) =
            line.split_once("](").and_then(|(t, f)| Some((t.split('[').nth(1)?, f.strip_suffix(')')?)))
        else {
            continue;
        };
        let address = file.trim_end_matches(".md").to_owned() + ".html";
        let mut used: BTreeMap<String, usize> = BTreeMap::new();
        let mut inside = false;
        let mut section: Option<(String, String, String)> = None;
        for line in read(&pages.join(file))?.lines() {
            inside ^= line.trim_start().starts_with("```");
            if let (false, true) = (inside, line.starts_with('#')) {
                all.extend(section.take());
                let heading = line.trim_start_matches('#').trim();
                let anchor = anchor(heading);
                let again = used.entry(anchor.clone()).or_default();
                let anchor = if *again == 0 { anchor } else { format!("{anchor}-{again}") };
                *again += 1;
                section = Some((heading.replace('`', ""), format!("{address}#{anchor}"), String::new()));
            } else if let Some((.., text)) = section.as_mut().filter(|s| s.2.len() < 1500)
                && !["```", "|---", "!["].iter().any(|mark| line.starts_with(mark))
            {
                *text += &without_marks(line.trim());
                text.push(' ');
            }
        }
        all.extend(section.take());
        let from = all.len() - all.iter().rev().take_while(|s| s.1.starts_with(&address)).count();
        for found in &mut all[from..] {
            found.2 = format!("{title}\u{1}{}", found.2);
        }
    }
    let rows: Vec<[String; 4]> = all
        .into_iter()
        .map(|(heading, address, text)| {
            let (title, text) = text.split_once('\u{1}').map(|(t, x)| (t.to_owned(), x.to_owned())).unwrap_or_default();
            [heading, title, address, text]
        })
        .collect();
    let json = serde_json::to_string(&rows).map_err(|e| format!("the index of the search: {e}"))?;
    Ok(format!("window.willisIndex = {json};\n"))
}

/// A line without what marks links and code.
fn without_marks(line: &str) -> String {
    let mut all = String::with_capacity(line.len());
    let mut rest = line;
    while let Some((before, after)) = rest.split_once("](") {
        all += before;
        rest = after.split_once(')').map_or("", |(_, rest)| rest);
    }
    all += rest;
    all.replace(['[', '`', '|', '*'], "")
}

/// The anchor of a heading, as mdBook makes it.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter_map(|c| match c {
        c if c.is_alphanumeric() || c == '_' || c == '-' => Some(c.to_ascii_lowercase()),
        c if c.is_whitespace() => Some('-'),
        _ => None,
    });
    kept.collect()
}

// Links

/// Checks that whatever the pages name is there; how many links that are.
fn check(site: &Path, api: bool) -> Result<usize, String> {
    let mut files = Vec::new();
    html_files(site, &mut files)?;
    let mut texts: BTreeMap<PathBuf, String> = BTreeMap::new();
    for file in &files {
        texts.insert(file.clone(), read(file)?);
    }
    let (mut count, mut wrong) = (0, Vec::new());
    for (file, text) in &texts {
        for target in targets(text) {
            count += 1;
            let (address, fragment) = target.split_once('#').unwrap_or((&target, ""));
            let address = address.split('?').next().unwrap_or_default();
            let to =
                if address.is_empty() { file.clone() } else { plain(&file.parent().expect("a folder").join(address)) };
            let to = if to.is_dir() { to.join("index.html") } else { to };
            let of_api = to.starts_with(site.join("api"));
            if !to.is_file() && (api || !of_api) {
                wrong.push(format!("{}: {target} does not exist", file.display()));
            } else if let (Some(text), false) = (texts.get(&to), fragment.is_empty() || fragment.starts_with("1.")) {
                let named = [format!("id=\"{fragment}\""), format!("id={fragment}"), format!("name=\"{fragment}\"")];
                if !named.iter().any(|n| text.contains(n)) {
                    wrong.push(format!("{}: {target}: there is no such place", file.display()));
                }
            }
        }
        for image in text.split("<img ").skip(1) {
            let tag = image.split('>').next().unwrap_or_default();
            if !tag.contains("alt=\"") || tag.contains("alt=\"\"") {
                wrong.push(format!("{}: a picture without a text: <img {tag}>", file.display()));
            }
        }
    }
    match wrong.is_empty() {
        true => Ok(count),
        false => Err(format!("{} links are wrong:\n{}", wrong.len(), wrong.join("\n"))),
    }
}

/// Pages of ours: those of the library's documentation are checked by their own tool, and the studio is a program.
fn html_files(folder: &Path, all: &mut Vec<PathBuf>) -> Result<(), String> {
    for path in entries(folder)? {
        let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default().to_owned();
        if path.is_dir() && name != "api" {
            html_files(&path, all)?;
        } else if name.ends_with(".html") && !["studio.html", "404.html"].contains(&name.as_str()) {
            all.push(path);
        }
    }
    Ok(())
}

/// What a page links to or shows, of this site.
fn targets(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    for attribute in ["href=\"", "src=\""] {
        for piece in text.split(attribute).skip(1) {
            let target = piece.split('"').next().unwrap_or_default().replace("&amp;", "&");
            let outside = ["http:", "https:", "data:", "mailto:", "javascript:"].iter().any(|s| target.starts_with(s));
            if !outside && !target.is_empty() && target != "#" {
                all.push(percent_decoded(&target));
            }
        }
    }
    all
}

fn percent_decoded(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut all = Vec::with_capacity(bytes.len());
    let mut k = 0;
    while k < bytes.len() {
        let coded = (bytes[k] == b'%').then(|| text.get(k + 1..k + 3)).flatten();
        match coded.and_then(|c| u8::from_str_radix(c, 16).ok()) {
            Some(byte) => {
                all.push(byte);
                k += 3;
            }
            None => {
                all.push(bytes[k]);
                k += 1;
            }
        }
    }
    String::from_utf8_lossy(&all).into_owned()
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut all = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(all.pop()),
            Component::CurDir => {}
            part => all.push(part),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_hold_what_the_studio_reads() {
        // As `btoa` has it, without padding.
        assert_eq!(["", "a", "ab", "abc"].map(|t| base64(t.as_bytes())), ["", "YQ", "YWI", "YWJj"]);
        assert_eq!(base64(&[0xfb, 0xff]), "-_8");
        assert_eq!(stored(b"ab"), [1, 2, 0, 0xfd, 0xff, b'a', b'b']);
        let text = "terminals = ['a', 'b']\n[[operation]]\nname = 'x'\nstate = '1'\nspeeds = { a = '10 rpm' }\n";
        assert!(studio_link(text, "x.toml").unwrap().starts_with("#1.A"));
    }

    #[test]
    fn links_to_what_the_site_lacks_become_words() {
        let text = "see [one](nowhere/one.rs) and [two](https://example.org), [three](#three)";
        assert_eq!(without_lost_links(text, Path::new("/")), "see one and [two](https://example.org), [three](#three)");
    }

    #[test]
    fn texts_of_the_search_have_no_marks() {
        assert_eq!(without_marks("see [one](a.md#b) and `two`, *three*"), "see one and two, three");
    }

    #[test]
    fn targets_of_a_page_are_found() {
        let text = "<a href=\"a%20b.html#c\">x</a><img src=\"d.svg\" alt=\"d\"><a href=\"https://example.org\">y</a>";
        assert_eq!(targets(text), ["a b.html#c", "d.svg"]);
        assert_eq!(plain(Path::new("/a/b/../c/./d")), Path::new("/a/c/d"));
    }

    #[test]
    fn python_says_what_its_methods_do() {
        let text = "class A:\n    def _no(self):\n        \"\"\"No.\"\"\"\n    def ask(\n        self,\n    ) -> int:\n        \"\"\"Ask.\n\n        More.\n        \"\"\"\n";
        let all = python_items(text);
        assert_eq!(all.len(), 1);
        assert!(all[0].0.starts_with("def ask(") && all[0].1.starts_with("Ask.") && all[0].1.ends_with("More."));
    }
}
