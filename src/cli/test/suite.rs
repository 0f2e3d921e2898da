//! Runs the selected cases once, in parallel, and reports them.

use std::collections::BTreeSet;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

use super::annotations;
use super::arguments::{Arguments, Format};
use super::junit;
use super::page;
use super::select::Found;
use super::work::{Item, Ran, Work, sum};
use crate::cli::coverage;
use crate::cli::files::Files;
use crate::cli::flowchart;
use crate::cli::output::Output;
use crate::golden::{Exercised, Outcome, Update, is_of};
use crate::plc::Programs;
use crate::plc::step7::Coverage;
use crate::source::{Problem, Replacement, unwritable};

/// The output files, open before anything runs.
pub(super) struct Reports {
    junit: Option<Replacement>,
    flowchart: Option<Replacement>,
    html: Option<Replacement>,
    coverage: Option<(coverage::Form, Replacement)>,
}

/// Opens the files of the reports; none of them is a file that the command reads.
pub(super) fn reports(arguments: &Arguments, work: &[Work]) -> Result<Reports, Problem> {
    let inputs: BTreeSet<PathBuf> = work.iter().flat_map(Work::inputs).collect();
    let mut files = Files::of(inputs);
    let mut open = |option, path: &Option<PathBuf>| path.as_ref().map(|path| files.open(option, path)).transpose();
    Ok(Reports {
        junit: open("--junit", &arguments.junit)?,
        flowchart: open("--flowchart", &arguments.flowchart)?,
        html: open("--html", &arguments.html)?,
        coverage: match &arguments.plc_coverage {
            Some(path) => {
                let form = coverage::Form::of(path)?;
                open("--plc-coverage", &arguments.plc_coverage)?.map(|file| (form, file))
            }
            None => None,
        },
    })
}

/// Prints the names of the cases; a file without cases is an error.
pub(super) fn list(work: &[Work], output: &mut Output) -> u8 {
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
pub(super) fn once(
    found: &Found,
    reports: Option<Reports>,
    arguments: &Arguments,
    programs: &Programs,
    output: &mut Output,
) -> u8 {
    let begin = Instant::now();
    let work = &found.work;
    let (ran, taken, covered) = all(work, arguments, programs);
    let took = begin.elapsed();
    // One line for each machine with findings.
    for warning in taken.iter().flat_map(|control| &control.warnings).collect::<BTreeSet<_>>() {
        output.warning(warning);
    }
    taken.iter().flat_map(|control| &control.remarks).for_each(|remark| output.line(remark));
    // With --fail-fast, cases may not have run.
    let left = ran.iter().filter(|ran| ran.is_none()).count();
    let done: Vec<(&Work, Ran)> = work.iter().zip(ran).filter_map(|(work, ran)| Some((work, ran?))).collect();
    let mut code = report(&done, left, arguments, output);
    covered.iter().for_each(|one| output.line(format!("PLC {}", one.summary())));
    code = code.max(orphans(&found.orphans, &done, arguments.accept, output));
    let Some(reports) = reports else { return code };
    let written = |file: Option<Replacement>, text: &mut dyn FnMut() -> Result<String, Problem>| {
        file.map_or(Ok(()), |mut file| {
            file.write(&text()?)?;
            file.finish()
        })
    };
    let (form, covering) = reports.coverage.unzip();
    let written = [
        written(covering, &mut || form.map_or_else(|| Ok(String::new()), |form| form.text(&covered))),
        written(reports.junit, &mut || junit::text(&done, took)),
        written(reports.flowchart, &mut || {
            let chart = flowchart::text(None, &taken);
            flowchart::summary(&chart).for_each(|line| output.line(line));
            Ok(chart)
        }),
        written(reports.html, &mut || Ok(page::text(&done, left, arguments.shard.is_some(), took))),
    ];
    for problem in written.into_iter().filter_map(Result::err) {
        output.error(problem);
        code = 2;
    }
    code
}

/// Golden files that belong to no case: with `--accept`, those of scenarios that have run are removed. The others are named.
fn orphans(orphans: &[PathBuf], done: &[(&Work, Ran)], is_accepted: bool, output: &mut Output) -> u8 {
    let has_run = |snap: &PathBuf| done.iter().any(|(work, _)| work.case().is_some() && is_of(snap, &work.file));
    let (removed, left): (Vec<_>, Vec<_>) = orphans.iter().partition(|snap| is_accepted && has_run(snap));
    let mut code = 0;
    for snap in removed {
        match std::fs::remove_file(snap) {
            Ok(()) => output.line(format!("removed  {}", snap.display())),
            Err(error) => {
                output.error(unwritable(snap, &error));
                code = 2;
            }
        }
    }
    let names: Vec<_> = left.iter().take(SHOWN).map(|snap| snap.display().to_string()).collect();
    let more = if left.len() > SHOWN { format!(" and {} more", left.len() - SHOWN) } else { String::new() };
    let names = format!("{}{more}", names.join(", "));
    match left.len() {
        0 => {}
        1 => output.warning(format!("1 golden file belongs to no case: {names}; {CURE}")),
        count => output.warning(format!("{count} golden files belong to no case: {names}; {CURE}")),
    }
    code
}

/// The number of golden files without a case that are named.
const SHOWN: usize = 10;

/// What to do about golden files without a case.
const CURE: &str =
    "delete those of scenarios that do not exist any more; `--accept` removes those of scenarios that run";

/// Runs all cases in parallel. The outcomes are in the order of the work, not in order of completion; with `--fail-fast`, a case that did
/// not begin before the first failure has none. The transitions taken in all cases are added up per control.
fn all(work: &[Work], arguments: &Arguments, programs: &Programs) -> (Vec<Option<Ran>>, Vec<Exercised>, Vec<Coverage>) {
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
    let mut covered = Vec::new();
    let mut outcomes: Vec<Option<Ran>> = work.iter().map(|_| None).collect();
    for (index, ran, taken) in done {
        if let Some(mut more) = taken {
            if let Some(one) = more.coverage.take() {
                coverage::add(&mut covered, one);
            }
            let name = &work[index].name;
            more.remarks.iter_mut().for_each(|remark| *remark = format!("{name}: {remark}"));
            match sum.iter_mut().find(|known| known.texts.name() == more.texts.name()) {
                Some(known) => {
                    known.taken.add(more.taken);
                    known.warnings.extend(more.warnings);
                    known.remarks.extend(more.remarks);
                }
                None => sum.push(more),
            }
        }
        outcomes[index] = Some(ran);
    }
    (outcomes, sum, covered)
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
fn report(done: &[(&Work, Ran)], left: usize, arguments: &Arguments, output: &mut Output) -> u8 {
    let mut code = 0;
    for (work, Ran { outcome, .. }) in done {
        code = code.max(outcome.exit_code());
        match outcome {
            Outcome::Held => {}
            Outcome::Accepted => output.line(format!("accepted  {}", work.name)),
            Outcome::Failed(_) | Outcome::Unusable(_) => output.error(outcome),
            Outcome::Untrue(_) | Outcome::Differs(_) | Outcome::Missing(_) => {
                output.error(format!("{}: {outcome}", work.name));
            }
        }
        if arguments.format == Format::Github && !outcome.is_good() {
            output.line(annotations::annotation(work, outcome));
        }
    }
    output.line(sum(done, left, arguments.shard.is_some()));
    code
}
