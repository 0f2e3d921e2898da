//! `opennck test`: runs all scenarios below the given paths in parallel and compares their traces with the golden files. A case is one
//! scenario with one combination of its matrix under one profile.

#![expect(clippy::disallowed_methods, reason = "reports tell how long a case took")]

mod annotations;
mod arguments;
mod junit;
mod page;
mod select;
mod watch;

pub(super) use arguments::Arguments;

use std::collections::BTreeSet;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::files::Files;
use super::flowchart;
use super::output::Output;
use crate::golden::{Case, Exercised, Outcome, Update, cases, scenario_files};
use crate::plc::Programs;
use crate::source::{Problem, Replacement};
use arguments::Format;

/// A case, or the reason why a file has none.
enum Item {
    Case(Box<Case>),
    Unusable(Problem),
}

/// A case with its name and the file of its scenario.
struct Work {
    name: String,
    file: PathBuf,
    item: Item,
}

impl Work {
    /// The case, if its file is usable.
    fn case(&self) -> Option<&Case> {
        match &self.item {
            Item::Case(case) => Some(case),
            Item::Unusable(_) => None,
        }
    }

    /// The files and folders that it reads, the golden file included.
    fn inputs(&self) -> Vec<PathBuf> {
        let of_case = self.case().map(|case| {
            let mut inputs = case.scenario.inputs();
            inputs.push(case.snap.clone());
            inputs
        });
        of_case.unwrap_or_else(|| vec![self.file.clone()])
    }
}

/// A case that has run.
struct Ran {
    outcome: Outcome,
    /// By the clock of the computer.
    time: Duration,
    /// The timing diagram of a case that did not pass; it needs a run.
    picture: Option<String>,
}

/// The output files, open before anything runs.
struct Reports {
    junit: Option<Replacement>,
    flowchart: Option<Replacement>,
    html: Option<Replacement>,
}

pub(super) fn test(arguments: &Arguments, programs: &Programs, output: &mut Output) -> u8 {
    let begun = found(arguments).and_then(|work| Ok((reports(arguments, &work)?, work)));
    let (reports, work) = match begun {
        Ok(begun) => begun,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    if arguments.list {
        return list(&work, output);
    }
    let code = once(work, Some(reports), arguments, programs, output);
    if arguments.watch { watch::again(arguments, programs, output) } else { code }
}

/// The selected cases, in the order in which they run.
fn found(arguments: &Arguments) -> Result<Vec<Work>, Problem> {
    let mut work = Vec::new();
    for file in scenario_files(&arguments.paths)? {
        match cases(&file) {
            Err(problem) => {
                work.push(Work { name: file.display().to_string(), file, item: Item::Unusable(problem) });
            }
            Ok(cases) => work.extend(cases.into_iter().map(|case| Work {
                name: case.name(),
                file: file.clone(),
                item: Item::Case(Box::new(case)),
            })),
        }
    }
    select::select(work, arguments)
}

/// Opens the files of the reports; none of them is a file that the command reads.
fn reports(arguments: &Arguments, work: &[Work]) -> Result<Reports, Problem> {
    let inputs: BTreeSet<PathBuf> = work.iter().flat_map(Work::inputs).collect();
    let mut files = Files::of(inputs);
    let mut open = |option, path: &Option<PathBuf>| path.as_ref().map(|path| files.open(option, path)).transpose();
    Ok(Reports {
        junit: open("--junit", &arguments.junit)?,
        flowchart: open("--flowchart", &arguments.flowchart)?,
        html: open("--html", &arguments.html)?,
    })
}

/// Prints the names of the cases; a file without cases is an error.
fn list(work: &[Work], output: &mut Output) -> u8 {
    let mut code = 0;
    for work in work {
        match &work.item {
            Item::Case(_) => output.line(&work.name),
            Item::Unusable(problem) => {
                output.error(problem);
                code = 2;
            }
        }
    }
    code
}

/// Runs the cases once and reports them.
fn once(
    work: Vec<Work>,
    reports: Option<Reports>,
    arguments: &Arguments,
    programs: &Programs,
    output: &mut Output,
) -> u8 {
    let begin = Instant::now();
    let (ran, taken) = all(&work, arguments, programs);
    let took = begin.elapsed();
    // One line for each machine with findings.
    for warning in taken.iter().flat_map(|control| &control.warnings).collect::<BTreeSet<_>>() {
        output.warning(warning);
    }
    // With --fail-fast, cases may not have run.
    let left = ran.iter().filter(|ran| ran.is_none()).count();
    let done: Vec<(&Work, Ran)> = work.iter().zip(ran).filter_map(|(work, ran)| Some((work, ran?))).collect();
    let mut code = report(&done, left, arguments.format, output);
    let Some(reports) = reports else { return code };
    let written = |file: Option<Replacement>, text: &mut dyn FnMut() -> Result<String, Problem>| {
        file.map_or(Ok(()), |mut file| {
            file.write(&text()?)?;
            file.finish()
        })
    };
    let written = [
        written(reports.junit, &mut || junit::text(&done, took)),
        written(reports.flowchart, &mut || {
            let chart = flowchart::text(None, &taken);
            flowchart::summary(&chart).for_each(|line| output.line(line));
            Ok(chart)
        }),
        written(reports.html, &mut || Ok(page::text(&done, left, took))),
    ];
    for problem in written.into_iter().filter_map(Result::err) {
        output.error(problem);
        code = 2;
    }
    code
}

/// Runs all cases in parallel. The outcomes are in the order of the work, not in order of completion; with `--fail-fast`, a case that did
/// not begin before the first failure has none. The transitions taken in all cases are added up per control.
fn all(work: &[Work], arguments: &Arguments, programs: &Programs) -> (Vec<Option<Ran>>, Vec<Exercised>) {
    let update = if arguments.accept { Update::Accept } else { Update::No };
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = arguments.jobs.map_or_else(processors, usize::from).min(work.len()).max(1);
    let bar = bar(work.len());
    let (next, is_over) = (AtomicUsize::new(0), AtomicBool::new(false));
    let done: Mutex<Vec<(usize, Ran, Option<Exercised>)>> = Mutex::new(Vec::with_capacity(work.len()));
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                while !is_over.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(work) = work.get(index) else {
                        return;
                    };
                    let (ran, taken) = run(work, update, arguments.html.is_some(), programs);
                    is_over.fetch_or(arguments.fail_fast && !ran.outcome.is_good(), Ordering::Relaxed);
                    // A poisoned lock means that another thread panicked; the scope passes its panic on.
                    if let Ok(mut done) = done.lock() {
                        done.push((index, ran, taken));
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
    let mut outcomes: Vec<Option<Ran>> = work.iter().map(|_| None).collect();
    for (index, ran, taken) in done {
        if let Some(more) = taken {
            match sum.iter_mut().find(|known| known.texts.name() == more.texts.name()) {
                Some(known) => {
                    known.taken.add(more.taken);
                    known.warnings.extend(more.warnings);
                }
                None => sum.push(more),
            }
        }
        outcomes[index] = Some(ran);
    }
    (outcomes, sum)
}

fn run(work: &Work, update: Update, is_drawn: bool, programs: &Programs) -> (Ran, Option<Exercised>) {
    let begin = Instant::now();
    let (outcome, finished) = match &work.item {
        Item::Case(case) => case.run_finished(programs, update),
        Item::Unusable(problem) => (Outcome::Unusable(problem.clone()), None),
    };
    let time = begin.elapsed();
    let picture = finished.as_ref().filter(|_| is_drawn && !outcome.is_good()).map(|finished| finished.svg());
    (Ran { outcome, time, picture }, finished.as_deref().map(Exercised::of))
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
fn report(done: &[(&Work, Ran)], left: usize, format: Format, output: &mut Output) -> u8 {
    let mut code = 0;
    for (work, Ran { outcome, .. }) in done {
        code = code.max(outcome.exit_code());
        match outcome {
            Outcome::Held => {}
            Outcome::Accepted => output.line(format!("accepted  {}", work.name)),
            Outcome::Failed(_) | Outcome::Unusable(_) => output.error(outcome),
            Outcome::Differs(_) | Outcome::Missing(_) => output.error(format!("{}: {outcome}", work.name)),
        }
        if format == Format::Github && !outcome.is_good() {
            output.line(annotations::annotation(work, outcome));
        }
    }
    output.line(sum(done, left));
    code
}

/// The number of cases, and how many ended how.
fn sum(done: &[(&Work, Ran)], left: usize) -> String {
    let count = done.len() + left;
    let noun = if count == 1 { "scenario" } else { "scenarios" };
    format!("{count} {noun}: {}", counts(done, left))
}

/// How many cases ended how.
fn counts(done: &[(&Work, Ran)], left: usize) -> String {
    let count = |test: fn(&Outcome) -> bool| done.iter().filter(|(_, ran)| test(&ran.outcome)).count();
    let counts = [
        (count(|outcome| matches!(outcome, Outcome::Held)), "passed"),
        (count(|outcome| matches!(outcome, Outcome::Accepted)), "accepted"),
        (count(|outcome| matches!(outcome, Outcome::Failed(_))), "failed"),
        (count(|outcome| matches!(outcome, Outcome::Differs(_))), "differ"),
        (count(|outcome| matches!(outcome, Outcome::Missing(_))), "without a golden file"),
        (count(|outcome| matches!(outcome, Outcome::Unusable(_))), "unusable"),
        (left, "not run"),
    ];
    let counts: Vec<_> =
        counts.iter().filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}")).collect();
    if counts.is_empty() { "none in this shard".to_owned() } else { counts.join(", ") }
}
