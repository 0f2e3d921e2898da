//! Golden traces: every scenario below a directory runs, and its trace must be the one in the `.snap` beside it.
//!
//! `opennck test` and [`check`], which is for `cargo test`, do the same. It reads `name.toml` and `name.snap`, and writes
//! the latter only where it is told to accept, or `name.snap.new` for review. The files have insta's format, so that
//! insta's tools show and accept what changed: `cargo insta review`.

mod snapshot;

pub use snapshot::{Snapshot, normalized, pending};

use std::fmt;
use std::path::{Path, PathBuf};

use crate::control::{Read, Taken, Texts};
use crate::controls;
use crate::image::Profile;
use crate::plc::Programs;
use crate::scenario::{Compare, Failure, Finished, Scenario};
use crate::source::{Place, Problem, unreadable};
use crate::trace::{difference, difference_in_sequence};
use crate::units::Time;

/// What happens to a golden file whose trace is another one, or that is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Update {
    /// Nothing.
    No,
    /// The trace is written beside it, as `name.snap.new`, for review.
    New,
    /// It is rewritten.
    Accept,
}

/// One scenario under one profile: one golden file.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The scenario.
    pub scenario: Scenario,
    /// The profile.
    pub profile: Profile,
    /// Its golden file.
    pub snap: PathBuf,
}

/// How a case ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Everything held, and the trace is the golden one.
    Held,
    /// Everything held, and the golden file was written.
    Accepted,
    /// An expectation failed.
    Failed(String),
    /// Everything held, but the trace is another one: the first difference.
    Differs(String),
    /// Everything held, but there is no golden file.
    Missing(PathBuf),
    /// The scenario or its golden file cannot be used.
    Unusable(Problem),
}

impl Outcome {
    /// Whether the case is as it should be.
    #[must_use]
    pub const fn is_good(&self) -> bool {
        matches!(self, Self::Held | Self::Accepted)
    }

    /// The exit code of the program for this outcome.
    #[must_use]
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::Held | Self::Accepted => 0,
            Self::Failed(_) | Self::Differs(_) | Self::Missing(_) => 1,
            Self::Unusable(_) => 2,
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Held => f.write_str("held"),
            Self::Accepted => f.write_str("accepted"),
            Self::Failed(failure) => f.write_str(failure),
            Self::Differs(difference) => {
                write!(
                    f,
                    "the trace is another one: {difference}\n  read it, then accept it with `opennck test --accept` or `cargo insta review`"
                )
            }
            Self::Missing(snap) => write!(
                f,
                "expected the golden file {}, found none\n  read the trace with `opennck run`, then accept it with `opennck test --accept`",
                snap.display()
            ),
            Self::Unusable(problem) => problem.fmt(f),
        }
    }
}

/// All scenario files below the paths, sorted; a path may be a file itself.
///
/// # Errors
/// A path does not exist or cannot be read, or there is no scenario below it.
pub fn scenario_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Problem> {
    let mut files = Vec::new();
    for path in paths {
        let before = files.len();
        collect(path, &mut files)?;
        if files.len() == before {
            return Err(Place::file(&path.display().to_string())
                .problem("expected scenarios (*.toml), found none", "name a directory that holds some"));
        }
    }
    files.sort();
    files.dedup();
    Ok(files)
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Result<(), Problem> {
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(path, &error))?;
    if metadata.is_file() {
        files.push(path.to_owned());
        return Ok(());
    }
    let entries = std::fs::read_dir(path).map_err(|error| unreadable(path, &error))?;
    for entry in entries {
        let entry = entry.map_err(|error| unreadable(path, &error))?;
        let path = entry.path();
        // A machine may lie beside its scenarios.
        let is_plant = path.file_name().is_some_and(|name| name == "plant.toml");
        let is_toml = path.extension().is_some_and(|extension| extension == "toml") && !is_plant;
        if path.is_dir() || is_toml {
            collect(&path, files)?;
        }
    }
    Ok(())
}

/// The cases of a scenario file: one for each of its profiles. The first has `<name>.snap`, each other one
/// `<name>.<profile>.snap`.
///
/// # Errors
/// The file cannot be used.
pub fn cases(file: &Path) -> Result<Vec<Case>, Problem> {
    let scenario = Scenario::read(file)?;
    let profiles = scenario.profiles.clone();
    Ok(profiles
        .into_iter()
        .enumerate()
        .map(|(index, profile)| {
            let extension = if index == 0 { "snap".to_owned() } else { format!("{}.snap", profile.name()) };
            Case { scenario: scenario.clone(), profile, snap: file.with_extension(extension) }
        })
        .collect())
}

/// Which transitions a control has taken.
#[derive(Clone, Copy)]
pub struct Exercised {
    /// The words of the control, with the charts of its state machines.
    pub texts: &'static dyn Texts,
    /// The rows of the charts.
    pub taken: Taken,
}

impl Case {
    /// Runs the case and compares its trace.
    #[must_use]
    pub fn run(&self, programs: &Programs, update: Update) -> Outcome {
        self.run_watched(programs, update).0
    }

    /// Runs it likewise, and returns which transitions its control has taken; `None` where it could not run.
    #[must_use]
    pub fn run_watched(&self, programs: &Programs, update: Update) -> (Outcome, Option<Exercised>) {
        self.run_on(programs, update, controls::read)
    }

    /// The same with a control that this project does not know: `read` reads the files of the machine.
    #[must_use]
    pub fn run_on(&self, programs: &Programs, update: Update, read: Read) -> (Outcome, Option<Exercised>) {
        let finished = match self.scenario.prepare_on(self.profile, programs, read) {
            Ok(prepared) => prepared.run(),
            Err(problem) => return (Outcome::Unusable(problem), None),
        };
        let outcome = self.outcome(&finished, update).unwrap_or_else(Outcome::Unusable);
        let control = finished.session().machine().control();
        (outcome, Some(Exercised { texts: control.texts(), taken: control.taken() }))
    }

    fn outcome(&self, finished: &Finished, update: Update) -> Result<Outcome, Problem> {
        match &finished.failure {
            Some(Failure::Unusable(problem)) => return Err(problem.clone()),
            Some(Failure::Missed(missed)) => {
                let before = self.difference_before(finished).map(|difference| format!("\n{difference}"));
                return Ok(Outcome::Failed(format!("{missed}{}", before.unwrap_or_default())));
            }
            None => {}
        }
        let body = finished.golden();
        let known = if self.snap.is_file() { Some(Snapshot::read(&self.snap)?) } else { None };
        let different = known.as_ref().map(|known| self.difference(&known.body, &body));
        if let Some(None) = different {
            let _ = std::fs::remove_file(pending(&self.snap));
            return Ok(Outcome::Held);
        }
        let snapshot = match known {
            Some(known) => Snapshot { body, ..known },
            None => Snapshot::new(&self.scenario.title, body),
        };
        match update {
            Update::No => {}
            Update::New => snapshot.write(&pending(&self.snap))?,
            Update::Accept => {
                snapshot.write(&self.snap)?;
                let _ = std::fs::remove_file(pending(&self.snap));
                return Ok(Outcome::Accepted);
            }
        }
        Ok(match different.flatten() {
            Some(difference) => Outcome::Differs(format!("{}: {difference}", self.snap.display())),
            None => Outcome::Missing(self.snap.clone()),
        })
    }

    /// What was already another trace when a scenario failed: the golden file, as far as the scenario came.
    fn difference_before(&self, finished: &Finished) -> Option<String> {
        let time = |row: &str| row.split_whitespace().next().and_then(|time| time.parse::<f64>().ok());
        let found = finished.golden();
        let last = found.lines().filter_map(time).fold(0.0, f64::max);
        let known = Snapshot::read(&self.snap).ok()?;
        let came = |row: &&str| time(row).is_none_or(|time| time <= last);
        let expected: String = known.body.lines().filter(came).flat_map(|row| [row, "\n"]).collect();
        // Columns are as wide as what stands in them, and less stands in a trace that ended early.
        let tolerance = match self.scenario.compare {
            Compare::Exact => Some(Time::ZERO),
            Compare::Sequence => None,
            Compare::Within(tolerance) => Some(tolerance),
        };
        let difference = difference_in_sequence(&normalized(&expected), &normalized(&found), tolerance)?;
        Some(format!("its trace was another one before: {}: {difference}", self.snap.display()))
    }

    /// The first difference, as far as the scenario wants it told.
    fn difference(&self, expected: &str, found: &str) -> Option<String> {
        let (expected, found) = (normalized(expected), normalized(found));
        match self.scenario.compare {
            Compare::Exact => difference(&expected, &found),
            Compare::Sequence => difference_in_sequence(&expected, &found, None),
            Compare::Within(tolerance) => difference_in_sequence(&expected, &found, Some(tolerance)),
        }
    }
}

/// Runs every scenario below a directory, for `cargo test`; `INSTA_UPDATE` says what happens to golden files as it does for insta: `no`
/// nothing, `new` (the default outside CI) writes `.snap.new` for `cargo insta review`, `always` rewrites them.
///
/// # Panics
/// With a readable report, when one of them does not hold or its trace is another one.
pub fn check(dir: impl AsRef<Path>, programs: &Programs) {
    let update = match std::env::var("INSTA_UPDATE").as_deref() {
        Ok("no") => Update::No,
        Ok("always" | "force" | "1") => Update::Accept,
        Ok("new" | "unseen") => Update::New,
        _ if std::env::var_os("CI").is_some() => Update::No,
        _ => Update::New,
    };
    let report = report(dir.as_ref(), programs, update);
    assert!(report.is_empty(), "{report}");
}

/// What does not hold below a directory; empty when all does.
fn report(dir: &Path, programs: &Programs, update: Update) -> String {
    let files = match scenario_files(&[dir.to_owned()]) {
        Ok(files) => files,
        Err(problem) => return problem.to_string(),
    };
    let mut wrong = Vec::new();
    let mut count = 0;
    for file in files {
        match cases(&file) {
            Err(problem) => wrong.push(problem.to_string()),
            Ok(cases) => {
                for case in cases {
                    count += 1;
                    let outcome = case.run(programs, update);
                    if !outcome.is_good() {
                        wrong.push(format!("{} ({})\n{outcome}", file.display(), case.profile.name()));
                    }
                }
            }
        }
    }
    if wrong.is_empty() {
        return String::new();
    }
    format!("{} of {count} scenarios are not as they should be\n\n{}\n", wrong.len(), wrong.join("\n\n"))
}

#[cfg(test)]
mod tests;
