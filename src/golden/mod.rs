//! Golden traces: runs every scenario below a directory and compares its trace with the `.snap` file beside it.
//!
//! `opennck test` does this on the command line, [`check`] does it for `cargo test`. Both read `name.toml` and `name.snap`. They write
//! `name.snap` only when accepting is requested, and `name.snap.new` for review. The files have the format of insta, so that the tools
//! of insta show and accept changes: `cargo insta review`.

mod orphans;
mod snapshot;

pub use orphans::{is_of, orphans};
pub use snapshot::{Snapshot, normalized, pending};

use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};

use crate::control::{Read, Taken, Texts};
use crate::controls;
use crate::image::Profile;
use crate::plc::Programs;
use crate::plc::step7::Coverage;
use crate::scenario::{Compare, Failure, Finished, Scenario, included_by, names_machine};
use crate::source::{Place, Problem, unreadable};
use crate::trace::{Watch, difference, difference_in_sequence};
use crate::units::Time;

/// What to do with a golden file that is missing or whose trace differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Update {
    /// Leave it unchanged.
    No,
    /// Write the new trace beside it, as `name.snap.new`, for review.
    New,
    /// Overwrite it with the new trace.
    Accept,
}

/// One scenario under one profile. It has one golden file.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The scenario.
    pub scenario: Scenario,
    /// The profile.
    pub profile: Profile,
    /// Its golden file.
    pub snap: PathBuf,
    /// Whether the cause of every edge and of every alarm is also checked ([`Trace::check_causes`](crate::trace::Trace::check_causes)).
    pub check_causes: bool,
}

/// The result of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// All expectations hold, and the trace matches the golden file.
    Held,
    /// All expectations hold, and the golden file was written.
    Accepted,
    /// An expectation failed: the report.
    Failed(String),
    /// All expectations hold, but causes in the trace are wrong: the findings.
    Untrue(String),
    /// All expectations hold, but the trace differs: the first difference.
    Differs(String),
    /// All expectations hold, but the golden file does not exist: its path.
    Missing(PathBuf),
    /// The scenario or its golden file cannot be used.
    Unusable(Problem),
}

impl Outcome {
    /// Whether the case passed.
    #[must_use]
    pub const fn is_good(&self) -> bool {
        matches!(self, Self::Held | Self::Accepted)
    }

    /// The exit code of the program for this result.
    #[must_use]
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::Held | Self::Accepted => 0,
            Self::Failed(_) | Self::Untrue(_) | Self::Differs(_) | Self::Missing(_) => 1,
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
            Self::Untrue(findings) => f.write_str(findings),
            Self::Differs(difference) => {
                write!(
                    f,
                    "the trace differs from the golden file: {difference}\n  \
                     review it, then accept it with `opennck test --accept` or `cargo insta review`"
                )
            }
            Self::Missing(snap) => write!(
                f,
                "golden file {} does not exist\n  review the trace with `opennck run`, then accept it with `opennck test --accept`",
                snap.display()
            ),
            Self::Unusable(problem) => problem.fmt(f),
        }
    }
}

/// All scenario files below the paths, sorted. A path may also be a file. A file below a directory that has no machine and whose steps
/// another one includes is a part of that one and no scenario.
///
/// # Errors
/// A path does not exist or cannot be read, or it contains no scenario.
pub fn scenario_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Problem> {
    let mut files = Vec::new();
    for path in paths {
        let before = files.len();
        collect(path, &mut Vec::new(), &mut files)?;
        if files.len() == before {
            return Err(Place::file(&path.display().to_string())
                .problem("expected scenarios (*.toml), found none", "name a directory that contains scenarios"));
        }
    }
    files.sort();
    files.dedup();
    let parts = parts_of(&files);
    files.retain(|file| paths.contains(file) || !parts.contains(&real(file)));
    Ok(files)
}

fn real(file: &Path) -> PathBuf {
    file.canonicalize().unwrap_or_else(|_| file.to_owned())
}

/// The files without a machine that these files include.
fn parts_of(files: &[PathBuf]) -> BTreeSet<PathBuf> {
    let included = files.iter().flat_map(|file| included_by(file).unwrap_or_default());
    // A file that many others include is read once.
    let included: BTreeSet<PathBuf> = included.map(|file| real(&file)).collect();
    included.into_iter().filter(|file| !names_machine(file)).collect()
}

/// A link to a folder above itself is not followed: it would show the same scenarios again, without end.
fn collect(path: &Path, above: &mut Vec<PathBuf>, files: &mut Vec<PathBuf>) -> Result<(), Problem> {
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(path, &error))?;
    if metadata.is_file() {
        files.push(path.to_owned());
        return Ok(());
    }
    let folder = real(path);
    if above.contains(&folder) {
        return Ok(());
    }
    above.push(folder);
    let entries = std::fs::read_dir(path).map_err(|error| unreadable(path, &error))?;
    for entry in entries {
        let entry = entry.map_err(|error| unreadable(path, &error))?;
        let path = entry.path();
        // A machine and a STEP 7 program may be stored beside their scenarios.
        let is_other = path.file_name().is_some_and(|name| name == "plant.toml" || name == "plc.toml");
        let is_toml = path.extension().is_some_and(|extension| extension == "toml") && !is_other;
        // A link that cannot be followed is a file that cannot be used; all others still run.
        if is_toml && std::fs::metadata(&path).is_err() {
            files.push(path);
        } else if path.is_dir() || is_toml {
            collect(&path, above, files)?;
        }
    }
    above.pop();
    Ok(())
}

/// The cases of a scenario file: one for each combination of its matrix and each of its profiles. The golden file of the first profile is
/// `<name>.snap`, that of every other profile is `<name>.<profile>.snap`; with a matrix, `<name>` is followed by `@` and the values.
///
/// # Errors
/// The file cannot be used.
pub fn cases(file: &Path) -> Result<Vec<Case>, Problem> {
    let mut cases = Vec::new();
    for scenario in Scenario::read_cases(file)? {
        for (index, profile) in scenario.profiles.iter().copied().enumerate() {
            let extension = if index == 0 { "snap".to_owned() } else { format!("{}.snap", profile.name()) };
            let plain = file.with_extension(extension);
            let snap = scenario.variant.as_ref().map_or_else(|| plain.clone(), |variant| variant.beside(&plain));
            cases.push(Case { scenario: scenario.clone(), profile, snap, check_causes: false });
        }
    }
    Ok(cases)
}

/// The transitions that a control has taken, and the findings about its machine.
#[derive(Clone)]
pub struct Exercised {
    /// The texts of the control, with the charts of its state machines.
    pub texts: &'static dyn Texts,
    /// The rows of the charts.
    pub taken: Taken,
    /// What the rules of the scenario have to say although they are not broken.
    pub remarks: Vec<String>,
    /// The findings about the files of the machine, in one line.
    pub warnings: Vec<String>,
    /// What ran of its PLC program, if this is one with statements.
    pub coverage: Option<Coverage>,
}

impl Exercised {
    /// What a run has exercised.
    #[must_use]
    pub fn of(finished: &Finished) -> Self {
        let machine = finished.session().machine();
        let (control, warnings) = (machine.control(), machine.warnings().to_vec());
        Self {
            texts: control.texts(),
            taken: control.taken(),
            remarks: finished.remarks(),
            warnings,
            coverage: machine.program_coverage(),
        }
    }
}

impl Case {
    /// The name of the case in reports: its file, the values of its matrix, and its profile if there are several.
    #[must_use]
    pub fn name(&self) -> String {
        let mut name = self.scenario.path.display().to_string();
        if let Some(variant) = &self.scenario.variant {
            name = format!("{name} [{variant}]");
        }
        if self.scenario.profiles.len() > 1 {
            name = format!("{name} ({})", self.profile.name());
        }
        name
    }

    /// Runs the case and compares its trace with the golden file.
    #[must_use]
    pub fn run(&self, programs: &Programs, update: Update) -> Outcome {
        self.run_finished(programs, update).0
    }

    /// Runs the case, and also returns the run, with its machine and trace; `None` if it could not run.
    #[must_use]
    pub fn run_finished(&self, programs: &Programs, update: Update) -> (Outcome, Option<Box<Finished>>) {
        self.finished_on(programs, update, controls::read)
    }

    /// Runs the case, and also returns the transitions that its control has taken; `None` if it could not run.
    #[must_use]
    pub fn run_watched(&self, programs: &Programs, update: Update) -> (Outcome, Option<Exercised>) {
        self.run_on(programs, update, controls::read)
    }

    /// The same with a control that this project does not know: `read` reads the files of the machine.
    #[must_use]
    pub fn run_on(&self, programs: &Programs, update: Update, read: Read) -> (Outcome, Option<Exercised>) {
        let (outcome, finished) = self.finished_on(programs, update, read);
        (outcome, finished.as_deref().map(Exercised::of))
    }

    fn finished_on(&self, programs: &Programs, update: Update, read: Read) -> (Outcome, Option<Box<Finished>>) {
        let finished = match self.scenario.prepare_on(self.profile, programs, read) {
            Ok(prepared) if self.check_causes => prepared.measure_causes().run(),
            Ok(prepared) => prepared.run(),
            Err(problem) => return (Outcome::Unusable(problem), None),
        };
        let outcome = self.outcome(&finished, update).unwrap_or_else(Outcome::Unusable);
        (outcome, Some(Box::new(finished)))
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
        if let Some(findings) = self.check_causes.then(|| wrong_causes(finished)).flatten() {
            return Ok(Outcome::Untrue(findings));
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

    /// The first difference from the golden file before the scenario failed, if there is one.
    fn difference_before(&self, finished: &Finished) -> Option<String> {
        let time = |row: &str| row.split_whitespace().next().and_then(|time| time.parse::<f64>().ok());
        let found = finished.golden();
        let last = found.lines().filter_map(time).fold(0.0, f64::max);
        let known = Snapshot::read(&self.snap).ok()?;
        let came = |row: &&str| time(row).is_none_or(|time| time <= last);
        let expected: String = known.body.lines().filter(came).flat_map(|row| [row, "\n"]).collect();
        // The width of a column depends on its contents, and a trace that ended early has fewer contents.
        let tolerance = match self.scenario.compare {
            Compare::Exact => Some(Time::ZERO),
            Compare::Sequence => None,
            Compare::Within(tolerance) => Some(tolerance),
        };
        let difference = difference_in_sequence(&normalized(&expected), &normalized(&found), tolerance)?;
        Some(format!("the trace already differed before this failure: {}: {difference}", self.snap.display()))
    }

    /// The first difference, under the comparison that the scenario selects.
    fn difference(&self, expected: &str, found: &str) -> Option<String> {
        let (expected, found) = (normalized(expected), normalized(found));
        match self.scenario.compare {
            Compare::Exact => difference(&expected, &found),
            Compare::Sequence => difference_in_sequence(&expected, &found, None),
            Compare::Within(tolerance) => difference_in_sequence(&expected, &found, Some(tolerance)),
        }
    }
}

/// The number of wrong causes of one scenario that are printed.
const SHOWN: usize = 20;

/// The wrong causes in the trace of a scenario, for all signals and alarms.
fn wrong_causes(finished: &Finished) -> Option<String> {
    let session = finished.session();
    let findings = session.trace().check_causes(session.machine(), &Watch::default());
    if findings.is_empty() {
        return None;
    }
    let rows = findings.iter().take(SHOWN).map(|finding| format!("\n  {finding}"));
    let more = findings.len().saturating_sub(SHOWN);
    let more = if more == 0 { String::new() } else { format!("\n  {more} more") };
    Some(format!("{} causes are wrong:{}{more}", findings.len(), rows.collect::<String>()))
}

/// Runs every scenario below a directory, for `cargo test`. `INSTA_UPDATE` selects what happens to golden files, as in insta: `no` changes
/// nothing, `new` (the default outside CI) writes `.snap.new` for `cargo insta review`, `always` overwrites them.
///
/// # Panics
/// A scenario fails or its trace differs. The message is a readable report.
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

/// A report of all failed scenarios below a directory; empty if all pass.
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
                        wrong.push(format!("{}\n{outcome}", case.name()));
                    }
                }
            }
        }
    }
    if wrong.is_empty() {
        return String::new();
    }
    format!("{} of {count} scenarios failed\n\n{}\n", wrong.len(), wrong.join("\n\n"))
}

#[cfg(test)]
mod tests;
