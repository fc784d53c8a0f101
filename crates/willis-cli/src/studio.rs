//! `willis studio`: the page on this machine alone, with a file of the user's in it.
//!
//! A browser runs pages of strangers, and every one of them may send requests to this machine. So the server listens on
//! 127.0.0.1 only, its paths begin with a token that nobody can guess, and it answers neither another host nor another
//! origin. It reads and writes one file, the one that was named, and overwrites only what the page has seen.

use std::collections::BTreeMap;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use willis::diagnostic::printable;
use willis::model::Model;
use willis_ask::{Attachment, Refusal};

use crate::interrupt::interrupted;
use crate::output::{self, Unfinished};
use crate::{Ended, input};

/// The page.
const PAGE: &str = "studio.html";

/// Where the page forbids itself every connection, and what takes its place: this server, and nothing else.
const NO_CONNECTION: &str = "connect-src 'none'";
const OWN_CONNECTION: &str = "connect-src 'self'";

/// Of a request: its head, and its body, which is a train file.
const MOST_HEAD: usize = 16 << 10;
const MOST_BODY: usize = 4 << 20;
/// Browsers open a few connections at a time.
const MOST_CONNECTIONS: usize = 64;
/// How long a request may take to arrive.
const PATIENCE: Duration = Duration::from_secs(10);
/// How long a page waits for a change of the file before it asks again, and how often the disk is looked at.
const WAIT: Duration = Duration::from_secs(15);
const LOOK: Duration = Duration::from_millis(150);

/// The command line.
pub fn command() -> Command {
    let path = |name: &'static str, value: &'static str| {
        Arg::new(name).long(name).value_name(value).value_parser(value_parser!(PathBuf))
    };
    Command::new("studio")
        .about("Serve the studio, a page for the browser, on this machine alone")
        .long_about(
            "Serve the studio, a page for the browser, on this machine alone, and print its address. With a FILE the page \
             and the file follow each other: what the page changes is written, and what an editor writes is shown. \
             Nothing is overwritten that the page has not seen. Ctrl-C ends it.",
        )
        .arg(Arg::new("file").value_name("FILE").help("Train file (TOML)"))
        .arg(
            Arg::new("port")
                .long("port")
                .value_name("PORT")
                .value_parser(value_parser!(u16))
                .default_value("0")
                .help("Port on 127.0.0.1; 0 is any that is free"),
        )
        .arg(path("page", "FILE").help("The page; else studio.html beside this program or in ../share/willis"))
        .arg(path("allow", "FOLDER").action(ArgAction::Append).help(
            "Tables that the train file names may lie in this folder too, not only in that of the file",
        ))
}

/// Serves until Ctrl-C.
pub fn run(matches: &ArgMatches) -> Result<Ended, Ended> {
    let page = page(matches.get_one::<PathBuf>("page").map(PathBuf::as_path))?;
    let allowed = matches.get_many::<PathBuf>("allow").into_iter().flatten().cloned().collect();
    let file = matches.get_one::<String>("file").map(|name| Served::new(name, allowed)).transpose()?;
    let port = *matches.get_one::<u16>("port").expect("it has a default");
    let told = |e: io::Error| Ended::from(format!("127.0.0.1:{port}: {e}\n"));
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(told)?;
    let port = listener.local_addr().map_err(told)?.port();
    let server = Arc::new(Server { port, token: token(), page, file, writing: Mutex::new(()) });
    let mut out = anstream::stdout();
    // Who started it waits for this line.
    let _ = writeln!(out, "http://127.0.0.1:{port}/{}/", server.token).and_then(|()| out.flush());
    let mut err = anstream::stderr();
    if let Some(file) = &server.file {
        let path = file.path.display().to_string();
        let _ = writeln!(err, "{}: file and page follow each other", printable(&path));
    }
    let _ = writeln!(err, "open the address in a browser on this machine; Ctrl-C ends the studio");
    std::thread::spawn(move || accept(&listener, &server));
    while !interrupted() {
        std::thread::sleep(Duration::from_millis(50));
    }
    output::clear();
    Ok(Ended::Interrupted { out: String::new(), told: String::new() })
}

/// The page: the one that was named, or where it is put.
fn page(named: Option<&Path>) -> Result<PathBuf, String> {
    let program = std::env::current_exe().ok();
    let up = |n: usize| program.as_deref().and_then(|p| p.ancestors().nth(n));
    let places = match named {
        Some(path) => vec![path.to_owned()],
        None => [
            up(1).map(|folder| folder.join(PAGE)),
            up(2).map(|folder| folder.join("share/willis").join(PAGE)),
            // `target/release/willis` beside `target/studio.html`.
            up(2).map(|target| target.join(PAGE)),
        ]
        .into_iter()
        .flatten()
        .collect(),
    };
    match (places.iter().find(|path| path.is_file()), named) {
        (Some(path), _) => read_page(path).map(|_| path.clone()),
        (None, Some(path)) => Err(format!("{}: there is no such file\n", path.display())),
        (None, None) => Err(format!(
            "the studio is one page, {PAGE}, which is neither beside this program nor in ../share/willis\n  build it in a \
             checkout: cargo xtask studio --no-tests\n  or name it: --page FILE\n"
        )),
    }
}

/// The page as text, which may connect to where it came from.
fn read_page(path: &Path) -> Result<String, String> {
    let told = |why: String| format!("{}: {why}\n", path.display());
    let text = String::from_utf8(input::whole(path).map_err(told)?).map_err(|e| told(e.to_string()))?;
    // The first of each: what stands further down is the page's own script.
    match text.contains("<head>") && text.contains(NO_CONNECTION) {
        true => Ok(text.replacen(NO_CONNECTION, OWN_CONNECTION, 1)),
        false => Err(told("is not the page of the studio".into())),
    }
}

/// Random enough that nobody guesses it: from the system, by the seed of a hash where it has no file of random bytes.
fn token() -> String {
    let mut bytes = [0; 16];
    let read = std::fs::File::open("/dev/urandom").and_then(|mut file| file.read_exact(&mut bytes));
    if read.is_err() {
        for half in bytes.chunks_mut(8) {
            half.copy_from_slice(&RandomState::new().build_hasher().finish().to_le_bytes());
        }
    }
    hex(&bytes)
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

/// Names a text: equal texts, equal tags.
fn tag(text: &str) -> String {
    format!("\"{}\"", hex(&Sha256::digest(text)))
}

/// The file of the user's.
struct Served {
    /// As it was named.
    name: String,
    /// Where it is, through all links: it is written there, and no link is replaced.
    path: PathBuf,
    allowed: Vec<PathBuf>,
}

impl Served {
    /// It must be readable; that it is a train is not asked: the page is there to mend it.
    fn new(name: &str, allowed: Vec<PathBuf>) -> Result<Self, Ended> {
        if name == "-" {
            return Err("a page follows a file, not standard input: name a train file\n".to_owned().into());
        }
        if let Err(wrong) = input::train_text(name) {
            let refusal = Refusal::File(wrong, Attachment { name: printable(name).into_owned(), text: String::new() });
            return Err(Ended::Refused { out: String::new(), told: refusal.render(&[], true) });
        }
        let path = Path::new(name).canonicalize().map_err(output::told(Path::new(name)))?;
        Ok(Self { name: name.to_owned(), path, allowed })
    }

    fn text(&self) -> Result<String, String> {
        let path = self.path.to_str().ok_or("its path is no text")?;
        input::train_text(path).map_err(|wrong| wrong.to_string())
    }

    /// Everything that the page shows of it. Tables are read as the command line would read them.
    fn told(&self, text: &str) -> Value {
        let mut files = BTreeMap::new();
        let allowed: Vec<&Path> = self.allowed.iter().map(PathBuf::as_path).collect();
        let mut tables = input::tables_of(&self.name, &allowed);
        // What is wrong with the train, the page finds itself.
        let _ = Model::read(text, &mut |name: &str| {
            let table = tables(name)?;
            files.insert(name.to_owned(), table.clone());
            Ok(table)
        });
        let own = self.path.file_name().unwrap_or_default().to_string_lossy();
        json!({ "name": own, "text": text, "files": files, "etag": tag(text) })
    }

    /// What changes when the file does; cheaper than its text.
    fn mark(&self) -> Option<(SystemTime, u64)> {
        let data = self.path.metadata().ok()?;
        Some((data.modified().ok()?, data.len()))
    }
}

/// What all connections share.
struct Server {
    port: u16,
    token: String,
    page: PathBuf,
    file: Option<Served>,
    /// One writes at a time.
    writing: Mutex<()>,
}

/// A thread a connection.
fn accept(listener: &TcpListener, server: &Arc<Server>) {
    static OPEN: AtomicUsize = AtomicUsize::new(0);
    struct Counted;
    impl Drop for Counted {
        fn drop(&mut self) {
            OPEN.fetch_sub(1, Ordering::Relaxed);
        }
    }
    loop {
        let Ok((stream, _)) = listener.accept() else {
            // Too many files are open, say; it passes.
            std::thread::sleep(LOOK);
            continue;
        };
        let counted = Counted;
        if OPEN.fetch_add(1, Ordering::Relaxed) >= MOST_CONNECTIONS {
            let _ = Reply::told(503, "too many connections").send(&stream);
            continue;
        }
        let server = server.clone();
        std::thread::spawn(move || {
            let _counted = counted;
            let _ = serve(&stream, &server);
        });
    }
}

fn serve(mut stream: &TcpStream, server: &Server) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let reply = match Request::read(stream, |request| server.admits(request)) {
        Ok(request) => server.answer(&request),
        Err(reply) => reply,
    };
    reply.send(stream)?;
    // What was refused unread is read to its end, at most for a while: else the answer would be lost on its way.
    stream.shutdown(Shutdown::Write)?;
    stream.set_read_timeout(Some(Duration::from_millis(500)))?;
    let (begin, mut rest) = (Instant::now(), [0; 1 << 14]);
    while begin.elapsed() < PATIENCE && stream.read(&mut rest).is_ok_and(|n| n > 0) {}
    Ok(())
}

struct Request {
    method: String,
    path: String,
    /// By name in lower case; one that came twice is refused.
    headers: BTreeMap<String, String>,
    body: Vec<u8>,
}

impl Request {
    /// Reads a request; its body only if its head is admitted.
    fn read(mut stream: &TcpStream, admitted: impl Fn(&Self) -> Result<(), Reply>) -> Result<Self, Reply> {
        let bad = || Reply::told(400, "that is no request");
        let begin = Instant::now();
        let (mut bytes, mut part) = (vec![], [0; 1 << 13]);
        let end = loop {
            match bytes.windows(4).position(|w| w == b"\r\n\r\n") {
                Some(end) if end <= MOST_HEAD => break end,
                None if bytes.len() <= MOST_HEAD => {}
                _ => return Err(Reply::told(431, "the head of the request is too long")),
            }
            if begin.elapsed() > PATIENCE {
                return Err(Reply::told(408, "the request took too long"));
            }
            match stream.read(&mut part) {
                Ok(n) if n > 0 => bytes.extend_from_slice(&part[..n]),
                _ => return Err(bad()),
            }
        };
        let head = std::str::from_utf8(&bytes[..end]).map_err(|_| bad())?;
        let mut lines = head.split("\r\n");
        let first: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
        let [method, path, "HTTP/1.1" | "HTTP/1.0"] = first[..] else { return Err(bad()) };
        let mut request =
            Self { method: method.to_owned(), path: path.to_owned(), headers: BTreeMap::new(), body: vec![] };
        for line in lines {
            let (name, value) = line.split_once(':').ok_or_else(bad)?;
            if request.headers.insert(name.to_ascii_lowercase(), value.trim().to_owned()).is_some() {
                return Err(bad());
            }
        }
        admitted(&request)?;
        if request.headers.contains_key("transfer-encoding") {
            return Err(Reply::told(411, "the length of the body must be said"));
        }
        let length = request.header("content-length").map_or(Ok(0), str::parse::<u64>).map_err(|_| bad())?;
        if length > MOST_BODY as u64 {
            return Err(Reply::told(413, "a train file has at most 4 MiB"));
        }
        if request.header("expect").is_some_and(|e| e.eq_ignore_ascii_case("100-continue")) {
            stream.write_all(b"HTTP/1.1 100 Continue\r\n\r\n").map_err(|_| bad())?;
        }
        request.body = bytes.split_off(end + 4);
        while request.body.len() < length as usize {
            if begin.elapsed() > PATIENCE {
                return Err(Reply::told(408, "the request took too long"));
            }
            match stream.read(&mut part) {
                Ok(n) if n > 0 => request.body.extend_from_slice(&part[..n]),
                _ => return Err(bad()),
            }
        }
        request.body.truncate(length as usize);
        Ok(request)
    }

    fn header(&self, name: &str) -> Option<&str> {
        self.headers.get(name).map(String::as_str)
    }
}

struct Reply {
    status: u16,
    kind: &'static str,
    tag: Option<String>,
    body: Vec<u8>,
}

impl Reply {
    fn new(kind: &'static str, tag: Option<String>, body: impl Into<Vec<u8>>) -> Self {
        Self { status: 200, kind, tag, body: body.into() }
    }

    /// In plain words.
    fn told(status: u16, why: &str) -> Self {
        Self { status, ..Self::new("text/plain", None, format!("{why}\n")) }
    }

    fn send(&self, mut stream: &TcpStream) -> io::Result<()> {
        let reason = match self.status {
            200 => "OK",
            204 => "No Content",
            400 => "Bad Request",
            403 => "Forbidden",
            404 => "Not Found",
            405 => "Method Not Allowed",
            408 => "Request Timeout",
            411 => "Length Required",
            412 => "Precondition Failed",
            413 => "Content Too Large",
            428 => "Precondition Required",
            431 => "Request Header Fields Too Large",
            503 => "Service Unavailable",
            _ => "Internal Server Error",
        };
        let mut head = format!(
            "HTTP/1.1 {} {reason}\r\nContent-Type: {}; charset=utf-8\r\nConnection: close\r\nCache-Control: no-store\r\n\
             X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
             Cross-Origin-Opener-Policy: same-origin\r\nContent-Security-Policy: frame-ancestors 'none'\r\n",
            self.status, self.kind
        );
        if self.status != 204 {
            head += &format!("Content-Length: {}\r\n", self.body.len());
        }
        if let Some(tag) = &self.tag {
            head += &format!("ETag: {tag}\r\n");
        }
        head += "\r\n";
        stream.write_all(head.as_bytes())?;
        if self.status != 204 {
            stream.write_all(&self.body)?;
        }
        stream.flush()
    }
}

impl Server {
    /// Whether a request comes from the page, or from who was told the address: before anything of its body is read.
    fn admits(&self, request: &Request) -> Result<(), Reply> {
        // A name of a stranger's may lead to this machine; the browser then says that name.
        let host = request.header("host").unwrap_or_default();
        let own = [format!("127.0.0.1:{}", self.port), format!("localhost:{}", self.port)];
        if !own.iter().any(|own| own == host) {
            return Err(Reply::told(403, "this host is not served"));
        }
        if request.header("origin").is_some_and(|origin| origin != format!("http://{host}")) {
            return Err(Reply::told(403, "other pages are not served"));
        }
        match self.place(request) {
            Some(_) => Ok(()),
            None => Err(Reply::told(404, "there is nothing here")),
        }
    }

    /// What a path says behind the token. The comparison takes as long whatever is guessed.
    fn place<'a>(&self, request: &'a Request) -> Option<&'a str> {
        let (token, place) = request.path.strip_prefix('/')?.split_once('/')?;
        let differ = token.bytes().zip(self.token.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
        (token.len() == self.token.len() && differ == 0).then_some(place)
    }

    fn answer(&self, request: &Request) -> Reply {
        let place = self.place(request).unwrap_or("nothing");
        let (place, query) = place.split_once('?').unwrap_or((place, ""));
        let known = match (place, &self.file) {
            ("", _) => None,
            ("file" | "changes", Some(file)) => Some(file),
            ("file" | "changes", None) => return Reply::told(404, "no file was named"),
            _ => return Reply::told(404, "there is nothing here"),
        };
        match (request.method.as_str(), place, known) {
            ("GET", "file", Some(file)) => match file.text() {
                Ok(text) => Reply::new("text/plain", Some(tag(&text)), text),
                Err(why) => Reply::told(404, &why),
            },
            ("PUT", "file", Some(file)) => self.write(file, request).unwrap_or_else(|reply| reply),
            ("GET", "changes", Some(file)) => changes(file, query),
            ("GET", "", _) => self.whole_page(),
            _ => Reply::told(405, "nothing here is asked in that way"),
        }
    }

    /// The page with the file in it.
    fn whole_page(&self) -> Reply {
        let page = match read_page(&self.page) {
            Ok(page) => page,
            Err(why) => return Reply::told(500, why.trim_end()),
        };
        let Some(file) = &self.file else { return Reply::new("text/html", None, page) };
        let held = match file.text() {
            Ok(text) => file.told(&text),
            Err(why) => json!({ "name": file.name, "text": "", "files": {}, "error": why }),
        };
        // As data: a browser runs no script of this type, and nothing in it can end it.
        let data = held.to_string().replace('<', "\\u003c");
        let script = format!("<head>\n<script type=\"application/json\" id=\"willis-file\">{data}</script>");
        Reply::new("text/html", None, page.replacen("<head>", &script, 1))
    }

    /// Writes the file back if what is on the disk is what the page has seen.
    fn write(&self, file: &Served, request: &Request) -> Result<Reply, Reply> {
        let seen = request.header("if-match").ok_or_else(|| Reply::told(428, "say what is replaced: If-Match"))?;
        let text = std::str::from_utf8(&request.body).map_err(|_| Reply::told(400, "a train file is text in UTF-8"))?;
        let failed = |why: String| Reply::told(500, why.trim_end());
        let _one = self.writing.lock().unwrap_or_else(PoisonError::into_inner);
        output::possible(&file.path).map_err(failed)?;
        let unfinished = Unfinished::new(&file.path, true).map_err(failed)?;
        unfinished.file().write_all(text.as_bytes()).map_err(output::told(&file.path)).map_err(failed)?;
        // At the last moment: an editor may have written meanwhile.
        let there = file.text().map_err(|why| Reply::told(412, &format!("the file is gone: {why}")))?;
        if tag(&there) != seen {
            let stale = Reply::told(412, "the file has changed on the disk; nothing was written");
            return Err(Reply { tag: Some(tag(&there)), ..stale });
        }
        unfinished.complete().map_err(failed)?;
        Ok(Reply { status: 204, ..Reply::new("text/plain", Some(tag(text)), "") })
    }
}

/// Waits until the file is another one than the page has, and tells it; after a while that it is still the same.
fn changes(file: &Served, query: &str) -> Reply {
    let Some(since) = query.split('&').find_map(|part| part.strip_prefix("since=")) else {
        return Reply::told(400, "say what is known: changes?since=ETAG");
    };
    let since = format!("\"{}\"", since.replace("%22", "").replace('"', ""));
    let (begin, mut mark) = (Instant::now(), None);
    let mut read = Err(String::new());
    while begin.elapsed() < WAIT {
        let now = file.mark();
        // A time on the disk may be coarse: once in a while the text is read all the same.
        if now.is_none() || now != mark || read.is_err() {
            mark = now;
            read = file.text();
            if let Ok(text) = &read
                && tag(text) != since
            {
                return Reply::new("application/json", Some(tag(text)), file.told(text).to_string());
            }
        }
        std::thread::sleep(LOOK);
    }
    match read.and_then(|_| file.text()) {
        Ok(text) if tag(&text) == since => Reply { status: 204, ..Reply::new("application/json", Some(since), "") },
        Ok(text) => Reply::new("application/json", Some(tag(&text)), file.told(&text).to_string()),
        // An editor that replaces a file takes it away for a moment; this was longer.
        Err(why) => Reply::told(404, &why),
    }
}
