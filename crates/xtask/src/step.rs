//! What a step is, and how steps are run one after the other.

use std::io::Write;
use std::process::{Command, ExitCode, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

use crate::context::{Context, component, passes};
use crate::tested::{Tests, test};

/// What a step needs, what it does and when it runs.
pub(crate) struct Step {
    /// Also the name of the task that runs it alone.
    pub(crate) name: &'static str,
    /// Said in the list of tasks.
    pub(crate) about: &'static str,
    /// Environment of the command.
    env: &'static [(&'static str, &'static str)],
    action: Action,
    /// Whether a tool that cannot be had makes the step `skipped` instead of failed.
    may_skip: bool,
    /// Whether `check` runs it too.
    pub(crate) in_check: bool,
    /// What it builds in a folder of its own, beside the steps before it: they often wait for one core. The step begins when that
    /// has ended. What comes of it is not looked at; the step itself builds what is missing.
    ahead: Option<fn(&Context) -> Vec<Command>>,
}

pub(crate) enum Action {
    /// Words of a command, run in the root of the repository.
    Run(&'static str),
    /// The same, of a tool that is a component of the toolchain: `component`, command.
    RunComponent(&'static str, &'static str),
    /// The same, counting tests.
    Test(&'static str),
    /// Anything else.
    Call(fn(&Context) -> Outcome),
}

/// What a step came to.
pub(crate) enum Outcome {
    Passed,
    /// With the reason. Only for steps that may be skipped.
    Skipped(String),
    /// With the reason; the output is already on the screen.
    Failed(String),
    /// With the lines of the test runner.
    Tested(Tests),
}

pub(crate) fn outcome(result: Result<(), String>) -> Outcome {
    result.map_or_else(Outcome::Failed, |()| Outcome::Passed)
}

pub(crate) fn tested(result: Result<Tests, String>) -> Outcome {
    result.map_or_else(Outcome::Failed, Outcome::Tested)
}

impl Step {
    /// A step of `ci` that must pass.
    pub(crate) const fn new(name: &'static str, about: &'static str, action: Action) -> Self {
        Self { name, about, env: &[], action, may_skip: false, in_check: false, ahead: None }
    }

    /// A tool that cannot be had makes it `skipped` instead of failed.
    pub(crate) const fn may_skip(self) -> Self {
        Self { may_skip: true, ..self }
    }

    /// `check` runs it too.
    pub(crate) const fn in_check(self) -> Self {
        Self { in_check: true, ..self }
    }

    /// Runs these, one after the other, beside the steps before it.
    pub(crate) const fn ahead(self, builds: fn(&Context) -> Vec<Command>) -> Self {
        Self { ahead: Some(builds), ..self }
    }

    /// With this in the environment of its command.
    pub(crate) const fn env(self, env: &'static [(&'static str, &'static str)]) -> Self {
        Self { env, ..self }
    }

    /// What to type to see it again.
    pub(crate) fn repeat(&self) -> String {
        match self.action {
            Action::Run(words) | Action::RunComponent(_, words) | Action::Test(words) => {
                let env = self.env.iter().map(|(name, value)| format!("{name}='{value}' "));
                env.collect::<String>() + words
            }
            Action::Call(_) => format!("cargo xtask {}", self.name),
        }
    }

    pub(crate) fn run(&self, context: &Context) -> Outcome {
        let outcome = match self.action {
            Action::Run(words) => outcome(passes(context.words(words).envs(self.env.iter().copied()), words)),
            Action::RunComponent(name, words) => outcome(component(context, name).and_then(|()| context.run(words))),
            Action::Test(words) => tested(test(context, words)),
            Action::Call(call) => call(context),
        };
        match outcome {
            Outcome::Skipped(reason) if !self.may_skip => Outcome::Failed(reason),
            other => other,
        }
    }
}

/// Runs steps up to the first that fails, and closes with what they came to.
pub(crate) fn run(steps: &[&Step], context: &Context) -> ExitCode {
    let over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        // However the steps end, nothing is built for them any longer.
        let _ended = Ended(&over);
        let (tell, built) = mpsc::channel();
        let ahead: Vec<_> = steps.iter().filter(|_| steps.len() > 1).filter_map(|s| Some((s.name, s.ahead?))).collect();
        let over = &over;
        scope.spawn(move || {
            for (name, builds) in ahead {
                builds(context).into_iter().for_each(|build| until(over, build));
                // Nobody listens when the steps have ended.
                let _ = tell.send(name);
            }
        });
        run_in_order(steps, context, &built)
    })
}

/// Says that it is over when it goes.
struct Ended<'a>(&'a AtomicBool);

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Runs a command silently, to its end or until it is over. What the command itself has started (compilers, of `cargo`) is not
/// killed with it: those end when their file is done, and nobody waits for them.
fn until(over: &AtomicBool, mut command: Command) {
    if over.load(Ordering::Relaxed) {
        return;
    }
    let Ok(mut child) = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn() else { return };
    while matches!(child.try_wait(), Ok(None)) {
        if over.load(Ordering::Relaxed) {
            let _ = child.kill();
            let _ = child.wait();
            return;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

fn run_in_order(steps: &[&Step], context: &Context, built: &Receiver<&str>) -> ExitCode {
    let begin = Instant::now();
    let mut summary = Vec::new();
    let mut tests = None;
    let mut failure = None;
    for (k, step) in steps.iter().enumerate() {
        println!("── {}/{} {}: {}", k + 1, steps.len(), step.name, step.repeat());
        let _ = std::io::stdout().flush();
        let start = Instant::now();
        if step.ahead.is_some() {
            // Those of steps before it have ended before; without any the channel is closed.
            let _ = built.iter().find(|name| *name == step.name);
        }
        let outcome = step.run(context);
        let took = time(start.elapsed());
        let (word, remark) = match outcome {
            Outcome::Passed => ("ok", String::new()),
            Outcome::Tested(counted) => {
                let remark = format!("{} passed, {} ignored", counted.passed, counted.ignored);
                tests = Some(counted);
                ("ok", remark)
            }
            Outcome::Skipped(reason) => ("skipped", reason),
            Outcome::Failed(reason) => {
                eprintln!("{reason}");
                failure = Some(step);
                ("FAILED", reason.lines().next().unwrap_or_default().to_owned())
            }
        };
        let colon = if word == "skipped" { ": " } else { "  " };
        let line =
            format!("{:<11} {took:>12}  {word}{}{remark}", step.name, if remark.is_empty() { "" } else { colon });
        println!("── {line}\n");
        summary.push(line);
        if failure.is_some() {
            summary.extend(steps[k + 1..].iter().map(|s| format!("{:<11} {:>12}  not run", s.name, "")));
            break;
        }
    }
    println!("{}\n{:<11} {:>12}", summary.join("\n"), "all", time(begin.elapsed()));
    if let Some(tests) = tests {
        println!("\n{}", tests.lines.join("\n"));
        println!("tests: {} passed, {} failed, {} skipped", tests.passed, tests.failed, tests.ignored);
    }
    let Some(step) = failure else { return ExitCode::SUCCESS };
    println!("\n{} failed; repeat it with\n    {}", step.name, step.repeat());
    ExitCode::FAILURE
}

/// Times as people read them.
pub(crate) fn time(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    if seconds < 99.5 {
        format!("{seconds:.1} s")
    } else {
        format!("{:.0} min {:02.0} s", (seconds / 60.0).floor(), (seconds % 60.0).floor())
    }
}
