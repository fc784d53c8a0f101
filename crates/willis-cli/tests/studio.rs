//! `willis studio` as a browser and a stranger meet it.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

/// As much of the page as the server looks at.
const PAGE: &str = "<!doctype html>\n<html><head>\n<meta http-equiv=\"Content-Security-Policy\" content=\"default-src \
                    'none'; connect-src 'none'\" />\n</head><body><script>const own = \"connect-src 'none' <head>\";\
                    </script></body></html>\n";

fn train() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    fs::read_to_string(root.join("examples/zf-8hp70.toml")).unwrap()
}

fn command() -> Command {
    let mut c = Command::new(env!("CARGO_BIN_EXE_willis"));
    c.env("NO_COLOR", "1").stdin(Stdio::null()).arg("studio");
    c
}

/// A folder with the page, a train file and a server for them.
struct Studio {
    folder: PathBuf,
    child: Child,
    port: u16,
    token: String,
}

impl Studio {
    fn new(name: &str, train: Option<&str>) -> Self {
        let folder = std::env::temp_dir().join(format!("willis-studio-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("studio.html"), PAGE).unwrap();
        let mut program = command();
        program.current_dir(&folder).args(["--page", "studio.html"]).stdout(Stdio::piped()).stderr(Stdio::piped());
        if let Some(text) = train {
            fs::write(folder.join("train.toml"), text).unwrap();
            program.arg("train.toml");
        }
        let mut child = program.spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("http://127.0.0.1:").expect("an address").to_owned();
        let (port, token) = address.split_once('/').unwrap();
        let token = token.trim_end_matches('/').to_owned();
        Self { folder, child, port: port.parse().unwrap(), token }
    }

    fn file(&self) -> PathBuf {
        self.folder.join("train.toml")
    }

    /// Sends a request, as it is, and reads the answer to its end.
    fn raw(&self, request: &[u8]) -> Reply {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        // It may be refused before it is read.
        let _ = stream.write_all(request);
        let mut bytes = vec![];
        stream.read_to_end(&mut bytes).unwrap();
        Reply(String::from_utf8(bytes).unwrap())
    }

    fn ask(&self, method: &str, place: &str, headers: &[(&str, &str)], body: &str) -> Reply {
        let mut head = format!("{method} /{}/{place} HTTP/1.1\r\n", self.token);
        if headers.iter().all(|(name, _)| *name != "Host") {
            head += &format!("Host: 127.0.0.1:{}\r\n", self.port);
        }
        for (name, value) in headers {
            head += &format!("{name}: {value}\r\n");
        }
        if !body.is_empty() {
            head += &format!("Content-Length: {}\r\n", body.len());
        }
        self.raw(format!("{head}\r\n{body}").as_bytes())
    }

    fn get(&self, place: &str) -> Reply {
        self.ask("GET", place, &[], "")
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = fs::remove_dir_all(&self.folder);
    }
}

struct Reply(String);

impl Reply {
    fn status(&self) -> u16 {
        self.0.strip_prefix("HTTP/1.1 ").and_then(|rest| rest[..3].parse().ok()).expect("a status")
    }

    fn header(&self, name: &str) -> Option<&str> {
        let head = self.0.split("\r\n\r\n").next().unwrap();
        head.lines().find_map(|l| l.strip_prefix(name)?.strip_prefix(": "))
    }

    fn body(&self) -> &str {
        self.0.split_once("\r\n\r\n").unwrap().1
    }
}

fn refused(output: &Output, status: i32) -> String {
    assert_eq!(output.status.code(), Some(status));
    assert!(output.stdout.is_empty());
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn the_page_has_the_file_in_it_and_may_connect_to_its_server_alone() {
    let hostile = "# </script><img src=x onerror=alert(1)>\n";
    let studio = Studio::new("page", Some(hostile));
    assert!(studio.token.len() == 32 && studio.token.bytes().all(|b| b.is_ascii_hexdigit()));
    let page = studio.get("");
    assert_eq!(page.status(), 200);
    assert_eq!(page.header("Content-Type"), Some("text/html; charset=utf-8"));
    assert_eq!(page.header("Cache-Control"), Some("no-store"));
    let body = page.body();
    // The policy is another one; what the page's own script says is as it was.
    assert_eq!(body.matches("connect-src 'self'").count(), 1);
    assert_eq!(body.matches("connect-src 'none'").count(), 1);
    let begin = "<script type=\"application/json\" id=\"willis-file\">";
    let data = body.split_once(begin).unwrap().1.split_once("</script>").unwrap().0;
    assert!(!data.contains('<'), "{data}");
    let data: Value = serde_json::from_str(data).unwrap();
    assert_eq!((data["name"].as_str(), data["text"].as_str()), (Some("train.toml"), Some(hostile)));
    assert_eq!(data["etag"].as_str(), studio.get("file").header("ETag"));
    // Every start has a token of its own.
    let other = Studio::new("page-other", None);
    assert_ne!(studio.token, other.token);
    assert!(!other.get("").body().contains("willis-file"));
    assert_eq!(other.get("file").status(), 404);
    assert_eq!(other.get("changes?since=x").status(), 404);
}

#[test]
fn tables_come_with_the_train_that_names_them() {
    let studio = Studio::new("tables", Some(&train()));
    let data = |body: &str| -> Value { serde_json::from_str(body).unwrap() };
    let told = data(studio.get("changes?since=other").body());
    assert_eq!((told["text"].as_str(), told["files"].as_object().map(|f| f.len())), (Some(&*train()), Some(0)));
}

#[test]
fn strangers_are_refused() {
    let studio = Studio::new("strangers", Some(&train()));
    let port = studio.port;
    let own = format!("http://127.0.0.1:{port}");
    // A name that leads to this machine, another port, no name.
    for host in ["willis.example", "127.0.0.1:1", "localhost", &format!("127.0.0.1.example:{port}")] {
        assert_eq!(studio.ask("GET", "", &[("Host", host)], "").status(), 403, "{host}");
    }
    assert_eq!(studio.raw(format!("GET /{}/ HTTP/1.0\r\n\r\n", studio.token).as_bytes()).status(), 403);
    assert_eq!(studio.ask("GET", "", &[("Host", &format!("localhost:{port}"))], "").status(), 200);
    // A page of somebody else, which must not even learn whether it guessed the token.
    for origin in ["https://willis.example", "null", &format!("http://localhost:{port}"), "http://127.0.0.1"] {
        assert_eq!(studio.ask("GET", "file", &[("Origin", origin)], "").status(), 403, "{origin}");
        let stale = [("Origin", origin), ("If-Match", "\"x\"")];
        assert_eq!(studio.ask("PUT", "file", &stale, "x").status(), 403, "{origin}");
    }
    assert_eq!(studio.ask("GET", "file", &[("Origin", &own)], "").status(), 200);
    for path in ["/", "/file", "//", "/0/file", &format!("/{}", studio.token), &format!("/{}0/", studio.token)] {
        let request = format!("GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n");
        assert_eq!(studio.raw(request.as_bytes()).status(), 404, "{path}");
    }
    for place in ["../", "studio.html", "file/../file", "..%2ftrain.toml", "train.toml"] {
        assert_eq!(studio.get(place).status(), 404, "{place}");
    }
    for (method, place) in [("DELETE", "file"), ("POST", "file"), ("PUT", ""), ("PUT", "changes"), ("OPTIONS", "file")]
    {
        assert_eq!(studio.ask(method, place, &[], "").status(), 405, "{method} {place}");
    }
}

#[test]
fn what_is_no_request_is_refused() {
    let studio = Studio::new("requests", Some(&train()));
    let (port, token) = (studio.port, &studio.token);
    let host = format!("Host: 127.0.0.1:{port}\r\n");
    for bad in ["\r\n\r\n", "GET\r\n\r\n", "GET / FTP\r\n\r\n", "\u{e9} / HTTP/1.1\r\nno colon\r\n\r\n"] {
        assert_eq!(studio.raw(bad.as_bytes()).status(), 400, "{bad:?}");
    }
    // Two hosts: who reads the first and who reads the second would not agree.
    let two = format!("GET /{token}/ HTTP/1.1\r\n{host}{host}\r\n");
    assert_eq!(studio.raw(two.as_bytes()).status(), 400);
    let long = format!("GET /{token}/ HTTP/1.1\r\n{host}X: {}\r\n\r\n", "x".repeat(20_000));
    assert_eq!(studio.raw(long.as_bytes()).status(), 431);
    let chunked = format!("PUT /{token}/file HTTP/1.1\r\n{host}Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n");
    assert_eq!(studio.raw(chunked.as_bytes()).status(), 411);
    let body = "#".repeat((4 << 20) + 1);
    assert_eq!(studio.ask("PUT", "file", &[("If-Match", "\"x\"")], &body).status(), 413);
    // It goes on.
    assert_eq!(studio.get("file").body(), train());
}

#[test]
fn the_page_writes_only_over_what_it_has_seen() {
    let studio = Studio::new("write", Some(&train()));
    let put = |tag: &str, text: &str| studio.ask("PUT", "file", &[("If-Match", tag)], text);
    let read = || fs::read_to_string(studio.file()).unwrap();
    let first = studio.get("file");
    assert_eq!(first.body(), train());
    let tag = first.header("ETag").unwrap();
    assert_eq!(studio.ask("PUT", "file", &[], "new").status(), 428);
    assert_eq!(put("\"stale\"", "new").status(), 412);
    assert_eq!(put("*", "new").status(), 412);
    assert_eq!(read(), train());
    let written = put(tag, "# from the page\n");
    assert_eq!((written.status(), read().as_str()), (204, "# from the page\n"));
    // An editor writes; the page has not seen it.
    fs::write(studio.file(), "# from an editor\n").unwrap();
    let tag = written.header("ETag").unwrap();
    let stale = put(tag, "# from the page, later\n");
    assert_eq!((stale.status(), read().as_str()), (412, "# from an editor\n"));
    // It learns what is there.
    assert_eq!(stale.header("ETag"), studio.get("file").header("ETag"));
    assert_eq!(put(stale.header("ETag").unwrap(), "").status(), 204);
    assert_eq!(read(), "");
    fs::remove_file(studio.file()).unwrap();
    assert_eq!(put(tag, "x").status(), 412);
    let mut left: Vec<_> = fs::read_dir(&studio.folder).unwrap().map(|e| e.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["studio.html"]);
}

#[test]
fn one_of_two_pages_writes() {
    let studio = Studio::new("race", Some(&train()));
    let tag = studio.get("file").header("ETag").unwrap().to_owned();
    let all: Vec<u16> = std::thread::scope(|scope| {
        let one = |k: usize| {
            let (studio, tag) = (&studio, &tag);
            scope.spawn(move || studio.ask("PUT", "file", &[("If-Match", tag)], &format!("# {k}\n")).status())
        };
        let threads: Vec<_> = (0..8).map(one).collect();
        threads.into_iter().map(|t| t.join().unwrap()).collect()
    });
    assert_eq!(all.iter().filter(|s| **s == 204).count(), 1, "{all:?}");
    assert_eq!(all.iter().filter(|s| **s == 412).count(), 7, "{all:?}");
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link() {
    let studio = Studio::new("link", Some(&train()));
    let real = studio.folder.join("real.toml");
    // Of a server that was started on it.
    fs::rename(studio.file(), &real).unwrap();
    std::os::unix::fs::symlink(&real, studio.file()).unwrap();
    let mut child = command()
        .current_dir(&studio.folder)
        .args(["--page", "studio.html", "train.toml"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    let (port, token) = line.trim().trim_start_matches("http://127.0.0.1:").split_once('/').unwrap();
    let other = Studio {
        folder: studio.folder.clone(),
        child,
        port: port.parse().unwrap(),
        token: token.trim_end_matches('/').into(),
    };
    let tag = other.get("file").header("ETag").unwrap().to_owned();
    assert_eq!(other.ask("PUT", "file", &[("If-Match", &tag)], "# new\n").status(), 204);
    assert!(fs::symlink_metadata(studio.file()).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(real).unwrap(), "# new\n");
}

#[test]
fn the_page_follows_the_disk() {
    let studio = Studio::new("follow", Some(&train()));
    let tag = studio.get("file").header("ETag").unwrap().replace('"', "%22");
    assert_eq!(studio.get("changes").status(), 400);
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| studio.get(&format!("changes?since={tag}")));
        std::thread::sleep(Duration::from_millis(600));
        assert!(!waiting.is_finished());
        // As editors do: under another name, then in its place.
        let new = studio.folder.join("new");
        fs::write(&new, "# from an editor\n").unwrap();
        fs::rename(new, studio.file()).unwrap();
        let told = waiting.join().unwrap();
        let told: Value = serde_json::from_str(told.body()).unwrap();
        assert_eq!(told["text"], "# from an editor\n");
        assert_eq!(told["etag"].as_str(), studio.get("file").header("ETag"));
        // What it has seen already is no change; that is said before it would think that nobody is there.
        let tag = told["etag"].as_str().unwrap().to_owned();
        let begin = Instant::now();
        assert_eq!(studio.get(&format!("changes?since={}", tag.replace('"', ""))).status(), 204);
        assert!(begin.elapsed() > Duration::from_secs(2));
    });
}

#[test]
fn where_it_cannot_begin_it_says_why() {
    let folder = std::env::temp_dir().join(format!("willis-studio-wrong-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("studio.html"), PAGE).unwrap();
    fs::write(folder.join("other.html"), "<html></html>").unwrap();
    let run = |words: &[&str]| command().current_dir(&folder).args(words).output().unwrap();
    let page = ["--page", "studio.html"];
    assert!(refused(&run(&[page[0], page[1], "nowhere.toml"]), 1).contains("E002"));
    assert!(refused(&run(&[page[0], page[1], "."]), 1).contains("E002"));
    assert!(refused(&run(&[page[0], page[1], "-"]), 1).contains("standard input"));
    assert!(refused(&run(&["--page", "nowhere.html"]), 1).contains("nowhere.html"));
    assert!(refused(&run(&["--page", "other.html"]), 1).contains("is not the page"));
    refused(&run(&["--port", "70000"]), 2);
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    assert!(refused(&run(&[page[0], page[1], "--port", &port]), 1).contains(&format!("127.0.0.1:{port}")));
    fs::remove_dir_all(folder).unwrap();
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it() {
    let mut studio = Studio::new("end", Some(&train()));
    // While a page waits.
    let tag = studio.get("file").header("ETag").unwrap().replace('"', "");
    let mut waiting = TcpStream::connect(("127.0.0.1", studio.port)).unwrap();
    let (token, port) = (&studio.token, studio.port);
    write!(waiting, "GET /{token}/changes?since={tag} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n").unwrap();
    let id = studio.child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let mut err = String::new();
    studio.child.stderr.take().unwrap().read_to_string(&mut err).unwrap();
    assert_eq!(studio.child.wait().unwrap().code(), Some(130), "{err}");
    assert!(err.contains("Ctrl-C"));
    assert!(!err.contains("panicked"));
}
