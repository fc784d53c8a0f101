//! Reading a train file, or saying why it cannot be read.

use std::io::Read;

use willis::diagnostic::{Code, Diagnostic, Diagnostics};

/// Larger files are no train files; reading them would only cost memory.
const MOST_BYTES: u64 = 4 << 20;

pub fn read(file: &str) -> Result<String, Diagnostics> {
    let name = if file == "-" { "standard input" } else { file };
    let refuse = |message: String, hint: &str| {
        let mut all = Diagnostics::default();
        all.push(Diagnostic::new(Code::Unreadable, "", message).hint(hint));
        all
    };
    let io = |e: std::io::Error| refuse(format!("{name}: {e}"), "check the path and its permissions");
    let mut bytes = Vec::new();
    if file == "-" {
        std::io::stdin().take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(io)?;
    } else {
        let handle = std::fs::File::open(file).map_err(io)?;
        if handle.metadata().map_err(io)?.is_dir() {
            return Err(refuse(format!("{name} is a directory"), "name a train file in it"));
        }
        handle.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(io)?;
    }
    if bytes.len() as u64 > MOST_BYTES {
        return Err(refuse(
            format!("{name} is larger than {} MiB", MOST_BYTES >> 20),
            "a train file is a few kilobytes",
        ));
    }
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        refuse(format!("{name} is not text in UTF-8 (byte {at})"), "a train file is TOML text")
    })
}
