//! Python environments that tasks make for themselves under `target`.

use std::path::PathBuf;
use std::process::Command;

use crate::context::{Context, passes};

/// An environment in a folder under `target`, and the packages in it.
pub(crate) struct Environment {
    folder: PathBuf,
    packages: &'static str,
}

impl Environment {
    /// `packages`: as `pip` is given them, with spaces between.
    pub(crate) fn new(context: &Context, folder: &str, packages: &'static str) -> Self {
        Self { folder: context.target.join(folder), packages }
    }

    /// What makes it, and what fills it. Both do nothing where that is done.
    pub(crate) fn commands(&self, context: &Context) -> [Command; 2] {
        let mut make = context.words("python3 -m venv");
        make.arg(&self.folder);
        let mut pip = self.program(context, "pip");
        pip.args(["install", "--quiet", "--disable-pip-version-check"]).args(self.packages.split_whitespace());
        [make, pip]
    }

    /// Makes and fills it.
    pub(crate) fn install(&self, context: &Context) -> Result<(), String> {
        let [mut make, mut pip] = self.commands(context);
        passes(&mut make, "python3 -m venv")?;
        passes(&mut pip, "pip install").map_err(|why| format!("packages cannot be had: {why}"))
    }

    /// Its interpreter.
    pub(crate) fn python(&self) -> PathBuf {
        self.folder.join("bin/python")
    }

    /// One of its programs, run in the root of the repository.
    pub(crate) fn program(&self, context: &Context, name: &str) -> Command {
        let mut command = context.command(self.folder.join("bin").join(name));
        command.env_remove("PYTHONPATH");
        command
    }
}
