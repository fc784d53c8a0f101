//! An empty place to run a release in: a root of its own with nothing but the release and the system's libraries that the program asks
//! for, without a network; where that cannot be had, a folder and an empty environment.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::context::Context;
use crate::site::copy;

/// Where a release is installed in the root.
const PREFIX: &str = "usr/local";

pub(super) struct Room {
    root: PathBuf,
    /// What goes before the program; empty without a root of its own.
    launcher: Vec<String>,
    /// In words: what it is.
    pub(super) told: String,
}

impl Room {
    /// Installs an archive in an empty folder.
    pub(super) fn install(context: &Context, archive: &Path, root: &Path) -> Result<Self, String> {
        let prefix = root.join(PREFIX);
        fs::create_dir_all(&prefix).map_err(|e| format!("{}: {e}", prefix.display()))?;
        let mut tar = context.words("tar --strip-components=1 -xzf");
        tar.arg(archive).arg("-C").arg(&prefix);
        context.output(&mut tar)?;
        let mut room = Self { root: root.to_owned(), launcher: vec![], told: String::new() };
        let libraries = libraries(context, &room.outside("bin/willis"));
        for library in &libraries {
            copy(library, &root.join(library.strip_prefix("/").unwrap_or(library)))?;
        }
        let names: Vec<_> = libraries.iter().filter_map(|l| l.file_name()?.to_str()).collect();
        // As whoever this is, else with the rights of root.
        for how in [&["--user", "--map-root-user", "--net"][..], &["--mount", "--net"]] {
            let mut launcher: Vec<String> =
                std::iter::once("unshare").chain(how.iter().copied()).map(str::to_owned).collect();
            launcher.push(format!("--root={}", root.display()));
            launcher.push(format!("--wd=/{PREFIX}/share/willis"));
            room.launcher = launcher;
            if room.willis().arg("--version").output().is_ok_and(|o| o.status.success()) {
                room.told = format!(
                    "a root of its own without a network, with the archive and {}",
                    if names.is_empty() { "nothing else".into() } else { names.join(", ") }
                );
                return Ok(room);
            }
        }
        room.launcher.clear();
        room.told = "a new folder with an empty environment (a root of its own cannot be had here)".into();
        Ok(room)
    }

    /// A file of the installed release, seen from outside.
    pub(super) fn outside(&self, file: &str) -> PathBuf {
        self.root.join(PREFIX).join(file)
    }

    /// The program, run beside the examples of the release.
    pub(super) fn willis(&self) -> Command {
        let mut command = match self.launcher.split_first() {
            Some((program, rest)) => {
                let mut command = Command::new(program);
                command.args(rest).arg(format!("/{PREFIX}/bin/willis"));
                command
            }
            None => Command::new(self.outside("bin/willis")),
        };
        command.env_clear().current_dir(self.outside("share/willis")).stdin(std::process::Stdio::null());
        command
    }
}

/// Libraries of the system that a program asks for; none where nobody can tell, or where it needs none.
fn libraries(context: &Context, program: &Path) -> Vec<PathBuf> {
    let Ok(output) = context.output(context.command("ldd").arg(program)) else { return vec![] };
    named(&String::from_utf8_lossy(&output.stdout))
}

/// Files in the output of `ldd`: `name => /file (address)` or `/file (address)`.
fn named(told: &str) -> Vec<PathBuf> {
    let files = told.lines().filter_map(|l| l.split("=>").last()?.split_whitespace().next());
    files.filter(|f| f.starts_with('/')).map(PathBuf::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_are_found() {
        let told = "\tlinux-vdso.so.1 (0x1)\n\tlibc.so.6 => /lib/libc.so.6 (0x2)\n\t/lib64/ld-linux.so.2 (0x3)\n";
        assert_eq!(named(told), ["/lib/libc.so.6", "/lib64/ld-linux.so.2"].map(PathBuf::from));
        assert!(named("\tstatically linked\n").is_empty());
    }
}
