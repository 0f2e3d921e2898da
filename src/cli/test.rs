//! `opennck test`: runs all scenarios below the given paths in parallel and compares their traces with the golden
//! files.

use std::collections::BTreeSet;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::flowchart;
use super::output::Output;
use crate::golden::{Case, Exercised, Outcome, Update, cases, scenario_files};
use crate::plc::Programs;
use crate::source::{Problem, unwritable};

/// The options of the command line.
#[derive(Clone, Debug)]
pub(super) struct Options {
    pub(super) accept: bool,
    pub(super) junit: Option<PathBuf>,
    pub(super) jobs: Option<u16>,
    pub(super) flowchart: Option<PathBuf>,
}

/// A case, or the reason why a file has none.
enum Work {
    Case(Box<Case>),
    Unusable(Problem),
}

pub(super) fn test(paths: &[PathBuf], options: &Options, programs: &Programs, output: &mut Output) -> u8 {
    let files = match scenario_files(paths) {
        Ok(files) => files,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let mut work = Vec::new();
    for file in files {
        let name = file.display().to_string();
        match cases(&file) {
            Err(problem) => work.push((name, Work::Unusable(problem))),
            Ok(cases) => work.extend(cases.into_iter().map(|case| (case.name(), Work::Case(Box::new(case))))),
        }
    }
    let (outcomes, taken) = all(&work, options, programs);
    // One line for each machine with findings.
    for warning in taken.iter().flat_map(|control| &control.warnings).collect::<BTreeSet<_>>() {
        output.warning(warning);
    }
    let named: Vec<_> = work.iter().map(|(name, _)| name.as_str()).zip(outcomes).collect();
    let mut code = report(&named, output);
    if let Some(junit) = &options.junit
        && let Err(problem) = write_junit(junit, &named)
    {
        output.error(problem);
        code = 2;
    }
    if let Some(path) = &options.flowchart {
        let chart = flowchart::text(None, &taken);
        flowchart::summary(&chart).for_each(|line| output.line(line));
        if let Err(error) = std::fs::write(path, chart) {
            output.error(unwritable(path, &error));
            code = 2;
        }
    }
    code
}

/// Runs all cases in parallel. The outcomes are in the order of the work, not in order of completion. The transitions
/// taken in all cases are added up per control.
fn all(work: &[(String, Work)], options: &Options, programs: &Programs) -> (Vec<Outcome>, Vec<Exercised>) {
    let update = if options.accept { Update::Accept } else { Update::No };
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = options.jobs.map_or_else(processors, usize::from).min(work.len()).max(1);
    let bar = bar(work.len());
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Outcome, Option<Exercised>)>> = Mutex::new(Vec::with_capacity(work.len()));
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some((_, item)) = work.get(index) else {
                        return;
                    };
                    let (outcome, taken) = match item {
                        Work::Case(case) => case.run_watched(programs, update),
                        Work::Unusable(problem) => (Outcome::Unusable(problem.clone()), None),
                    };
                    // A poisoned lock means that another thread panicked; the scope passes its panic on.
                    if let Ok(mut done) = done.lock() {
                        done.push((index, outcome, taken));
                    }
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    let mut done = done.into_inner().unwrap_or_default();
    done.sort_by_key(|(index, ..)| *index);
    let mut sum: Vec<Exercised> = Vec::new();
    let mut outcomes = Vec::with_capacity(done.len());
    for (_, outcome, taken) in done {
        if let Some(more) = taken {
            match sum.iter_mut().find(|known| known.texts.name() == more.texts.name()) {
                Some(known) => {
                    known.taken.add(more.taken);
                    known.warnings.extend(more.warnings);
                }
                None => sum.push(more),
            }
        }
        outcomes.push(outcome);
    }
    (outcomes, sum)
}

/// A progress bar, on a terminal only.
fn bar(length: usize) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length as u64);
    match ProgressStyle::with_template("{bar:40} {pos}/{len} scenarios") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Prints every case that did not pass, then the counts; returns the highest exit code.
fn report(outcomes: &[(&str, Outcome)], output: &mut Output) -> u8 {
    let mut code = 0;
    for (name, outcome) in outcomes {
        code = code.max(outcome.exit_code());
        match outcome {
            Outcome::Held => {}
            Outcome::Accepted => output.line(format!("accepted  {name}")),
            Outcome::Failed(_) => output.error(outcome),
            Outcome::Differs(_) | Outcome::Missing(_) => output.error(format!("{name}: {outcome}")),
            Outcome::Unusable(_) => output.error(outcome),
        }
    }
    let count = |test: fn(&Outcome) -> bool| outcomes.iter().filter(|(_, outcome)| test(outcome)).count();
    let counts = [
        (count(|outcome| matches!(outcome, Outcome::Held)), "passed"),
        (count(|outcome| matches!(outcome, Outcome::Accepted)), "accepted"),
        (count(|outcome| matches!(outcome, Outcome::Failed(_))), "failed"),
        (count(|outcome| matches!(outcome, Outcome::Differs(_))), "differ"),
        (count(|outcome| matches!(outcome, Outcome::Missing(_))), "without a golden file"),
        (count(|outcome| matches!(outcome, Outcome::Unusable(_))), "unusable"),
    ];
    let counts: Vec<_> =
        counts.iter().filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}")).collect();
    let noun = if outcomes.len() == 1 { "scenario" } else { "scenarios" };
    output.line(format!("{} {noun}: {}", outcomes.len(), counts.join(", ")));
    code
}

fn write_junit(path: &Path, outcomes: &[(&str, Outcome)]) -> Result<(), Problem> {
    let mut suite = TestSuite::new("scenarios");
    for (name, outcome) in outcomes {
        let status = match outcome {
            Outcome::Held | Outcome::Accepted => TestCaseStatus::success(),
            Outcome::Failed(_) | Outcome::Differs(_) | Outcome::Missing(_) => bad(NonSuccessKind::Failure, outcome),
            Outcome::Unusable(_) => bad(NonSuccessKind::Error, outcome),
        };
        suite.add_test_case(TestCase::new(*name, status));
    }
    let mut report = Report::new("opennck");
    report.add_test_suite(suite);
    let text = report
        .to_string()
        .map_err(|error| Problem::new(format!("the report cannot be written: {error}"), "report this as a bug"))?;
    std::fs::write(path, text).map_err(|error| unwritable(path, &error))
}

fn bad(kind: NonSuccessKind, outcome: &Outcome) -> TestCaseStatus {
    let text = outcome.to_string();
    let mut status = TestCaseStatus::non_success(kind);
    status.set_message(text.lines().next().unwrap_or_default().to_owned()).set_description(text);
    status
}
