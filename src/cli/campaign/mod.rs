//! `opennck campaign`: runs the cases of a campaign on all processors, writes their results in the order of the cases, and reports.

#![expect(clippy::disallowed_methods, reason = "the estimate before a campaign measures one case")]

mod answer;
mod merge;
mod page;
mod report;
mod results;

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::num::NonZeroU16;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};

use super::output::Output;
use super::test::Shard;
use crate::campaign::{Header, Record, Spec, Summary};
use crate::plc::Programs;
use crate::source::Problem;
use results::Results;

/// What runs, and where the results go.
#[derive(Clone, Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct Arguments {
    /// The file of the campaign.
    #[arg(required = true, value_name = "SPEC.toml")]
    spec: Option<PathBuf>,
    /// The folder of the results and the report [default: the name of the campaign with `-results`, in the present folder].
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Runs the third of sixteen parts of the cases: 3/16. `opennck campaign merge` makes one result of all parts.
    #[arg(long, value_name = "N/M")]
    shard: Option<Shard>,
    /// Runs only the first N cases.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    limit: Option<u64>,
    /// Continues an interrupted run. Cases that have a result in the folder do not run again.
    #[arg(long)]
    resume: bool,
    /// Number of cases that run at the same time [default: the number of processors].
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroU16>,
    /// Prints the values of each case and runs nothing.
    #[arg(long, conflicts_with_all = ["out", "resume", "jobs"])]
    list: bool,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Clone, Debug, Subcommand)]
enum Command {
    /// Makes one result of the results of all parts (`--shard`), the same as without parts, byte for byte.
    Merge {
        /// The file of the campaign.
        #[arg(value_name = "SPEC.toml")]
        spec: PathBuf,
        /// The folders with the results of the parts.
        #[arg(required = true, value_name = "FOLDER")]
        parts: Vec<PathBuf>,
        /// The folder of the whole result.
        #[arg(long, value_name = "FOLDER")]
        out: PathBuf,
    },
}

/// The stack of a thread that runs cases, as that of the thread that runs a command.
const STACK: usize = 16 << 20;

/// The number of cases that run without a limit.
const WITHOUT_LIMIT: u128 = 1_000_000;

pub(super) fn campaign(arguments: &Arguments, programs: &Programs, output: &mut Output) -> u8 {
    let done = match (&arguments.command, &arguments.spec) {
        (Some(Command::Merge { spec, parts, out }), _) => merge::merge(spec, parts, out, programs, output),
        (None, Some(spec)) => run(spec, arguments, programs, output),
        (None, None) => Err(Problem::new("expected the file of a campaign, found none", "name one")),
    };
    done.unwrap_or_else(|problem| {
        output.error(problem);
        2
    })
}

fn run(path: &Path, arguments: &Arguments, programs: &Programs, output: &mut Output) -> Result<u8, Problem> {
    let spec = Spec::read(path, programs)?;
    let all = spec.cases();
    let jobs = arguments.jobs.map_or_else(processors, |jobs| usize::from(jobs.get()));
    let cases = match (arguments.limit, u64::try_from(all)) {
        (Some(limit), cases) => cases.map_or(limit, |cases| cases.min(limit)),
        (None, Ok(cases)) if all <= WITHOUT_LIMIT => cases,
        (None, _) => {
            let hours = one_case(&spec, programs).as_secs_f64() * all as f64 / jobs as f64 / 3600.0;
            let what = format!(
                "expected at most {WITHOUT_LIMIT} cases, found {all}: about {hours:.0} hours on {jobs} processors"
            );
            return Err(Problem::new(
                what,
                "write strategy = { random = 10000 } or \"pairwise\", or run the first N cases with --limit N",
            ));
        }
    };
    if arguments.list {
        list(&spec, cases, output);
        return Ok(0);
    }
    let shard = arguments.shard.map_or((1, 1), |shard| (shard.part as u64, shard.of as u64));
    let header = Header { version: env!("CARGO_PKG_VERSION").to_owned(), spec: spec.hash.clone(), cases, shard };
    let folder = arguments.out.clone().unwrap_or_else(|| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        PathBuf::from(format!("{stem}-results"))
    });
    let units = spec.units(cases);
    let own: Vec<u64> = (0..units).filter(|unit| unit % shard.1 == shard.0 - 1).collect();
    let mut summary = Summary::of(&spec);
    let (mut results, next) = match arguments.resume {
        true => Results::resume(&folder, &header, &spec, &mut summary)?,
        false => (Results::begin(&folder, &header)?, 0),
    };
    let left: Vec<u64> = own.into_iter().filter(|unit| *unit >= next).collect();
    output.line(format!("{}: {}", spec.title, spec.strategy()));
    for (name, count) in spec.varied() {
        output.line(format!("  {name}: {count} {}", if count == 1 { "value" } else { "values" }));
    }
    if !left.is_empty() {
        // With bisection, the first unit is a whole interval.
        let one = one_case(&spec, programs).as_secs_f64();
        let runs = if spec.is_bisected() { units } else { cases };
        let seconds = one * runs as f64 * (left.len() as f64 / units.max(1) as f64) / jobs as f64;
        let noun = if spec.is_bisected() { "intervals" } else { "cases" };
        output.remark(format!("{runs} {noun}; one alone takes {one:.3} s: about {seconds:.0} s on {jobs} processors"));
    }
    parallel(&spec, &left, cases, jobs, programs, &mut |records| {
        for record in records {
            summary.add(record);
        }
        results.write(records)
    })?;
    results.finish()?;
    report::report(&spec, summary, &folder, programs, output)
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// How long the first case takes by itself.
fn one_case(spec: &Spec, programs: &Programs) -> Duration {
    let begin = Instant::now();
    let _ = spec.run(0, 1, programs);
    begin.elapsed()
}

fn list(spec: &Spec, cases: u64, output: &mut Output) {
    for number in 0..cases {
        if output.is_closed() {
            return;
        }
        let values: Vec<_> = spec.values(number).into_iter().map(|(key, value)| format!("{key} = {value}")).collect();
        output.line(format!("{number}: {}", values.join(", ")));
    }
}

/// Runs units on several threads, and passes their records on in the order of the units.
fn parallel(
    spec: &Spec,
    units: &[u64],
    cases: u64,
    jobs: usize,
    programs: &Programs,
    take: &mut dyn FnMut(&[Record]) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let bar = bar(units.len());
    let next = AtomicU64::new(0);
    let (sender, receiver) = mpsc::sync_channel::<(u64, Vec<Record>)>(1024);
    std::thread::scope(|scope| {
        for _ in 0..jobs.min(units.len()).max(1) {
            let (sender, next) = (sender.clone(), &next);
            let work = move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(unit) = usize::try_from(index).ok().and_then(|index| units.get(index)) else { return };
                    // Without a receiver the run has ended with an error.
                    if sender.send((index, spec.run(*unit, cases, programs))).is_err() {
                        return;
                    }
                }
            };
            let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work);
            thread.map_err(|error| Problem::new(format!("no thread can be started: {error}"), "use --jobs 1"))?;
        }
        drop(sender);
        let mut waiting = BTreeMap::new();
        let mut due = 0;
        for (index, records) in receiver {
            waiting.insert(index, records);
            while let Some(records) = waiting.remove(&due) {
                take(&records)?;
                due += 1;
                bar.inc(1);
            }
        }
        bar.finish_and_clear();
        Ok(())
    })
}

fn bar(length: usize) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length as u64);
    match ProgressStyle::with_template("{bar:40} {pos}/{len} parts, {eta} left") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
