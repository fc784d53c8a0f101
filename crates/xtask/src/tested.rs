//! Tests are run with their output passed through, and counted.

use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Write};
use std::process::Stdio;

use crate::context::Context;

/// The count of a test run.
#[derive(Default)]
pub(crate) struct Tests {
    pub(crate) passed: u64,
    pub(crate) failed: u64,
    pub(crate) ignored: u64,
    /// `test result: …` of each binary that ran any.
    pub(crate) lines: Vec<String>,
}

impl Tests {
    /// Counts a line such as `test result: ok. 3 passed; 0 failed; 1 ignored; …`.
    fn read(&mut self, line: &str) {
        // A test that prints without a line end may stand before it.
        let Some(at) = line.find("test result: ") else { return };
        let line = &line[at..];
        let count = |word: &str| -> u64 {
            let words: Vec<&str> = line.split([' ', ';', '.']).filter(|w| !w.is_empty()).collect();
            words.windows(2).find(|w| w[1] == word).and_then(|w| w[0].parse().ok()).unwrap_or(0)
        };
        let (passed, failed, ignored) = (count("passed"), count("failed"), count("ignored"));
        self.passed += passed;
        self.failed += failed;
        self.ignored += ignored;
        if passed + failed > 0 {
            self.lines.push(line.to_owned());
        }
    }
}

/// Runs tests, passes their output through and reads the result lines.
///
/// The random trains are the same in every run, so that a run can be repeated and tells of the
/// change that was made; `PROPTEST_RNG_SEED` in the environment looks at others.
pub(crate) fn test(context: &Context, words: &str) -> Result<Tests, String> {
    test_with(context, words, &[])
}

/// The same with more in the environment.
pub(crate) fn test_with(context: &Context, words: &str, env: &[(&str, &OsStr)]) -> Result<Tests, String> {
    let mut command = context.words(words);
    command.envs(env.iter().copied());
    if std::env::var_os("PROPTEST_RNG_SEED").is_none() {
        command.env("PROPTEST_RNG_SEED", "1841");
    }
    let mut child = match command.stdout(Stdio::piped()).spawn() {
        Ok(child) => child,
        Err(e) => return Err(format!("`{words}` cannot be started: {e}")),
    };
    let mut tests = Tests::default();
    let mut reader = BufReader::new(child.stdout.take().expect("piped"));
    let mut line = Vec::new();
    while reader.read_until(b'\n', &mut line).is_ok_and(|n| n > 0) {
        let _ = std::io::stdout().write_all(&line);
        tests.read(String::from_utf8_lossy(&line).trim_end());
        line.clear();
    }
    match child.wait() {
        Ok(status) if !status.success() => Err(format!("{} tests failed: {status}", tests.failed)),
        Err(e) => Err(format!("`{words}`: {e}")),
        Ok(_) if tests.passed == 0 => Err("no test ran".into()),
        Ok(_) => Ok(tests),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn result_lines_are_counted() {
        let mut tests = Tests::default();
        tests.read("test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s");
        tests
            .read("test result: FAILED. 12 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.25s");
        tests.read("test result: ok. 0 passed; 0 failed; 0 ignored; 0 measured; 9 filtered out; finished in 0.00s");
        tests.read("test passed ... ok");
        assert_eq!((tests.passed, tests.failed, tests.ignored, tests.lines.len()), (15, 2, 1, 2));
    }
}
