//! `opennck run`: runs scenarios and prints their signal sequences with causes.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;

use super::coverage;
use super::durations::duration;
use super::files::Files;
use super::output::Output;
use crate::machine::Machine;
use crate::plc::{PlcProcess, Programs};
use crate::scenario::{Failure, Finished, Named, Prepared, Scenario};
use crate::source::{Place, Problem, Replacement};
use crate::trace::{Curves, Window};
use crate::units::Time;

/// What runs, and the files to which the trace is written as well.
#[derive(Clone, Debug, Args)]
pub(super) struct Options {
    /// Runs only the cases of a matrix whose values contain this text, as `plc = a`.
    #[arg(long, value_name = "TEXT")]
    case: Option<String>,
    /// Prints the smallest margin of each rule: cycles until a consequence would have been too late, or the distance of a compared value.
    #[arg(long)]
    margins: bool,
    /// Runs this PLC program in place of that of the scenario: a registered name, or with a `/` the folder of a STEP 7 program.
    #[arg(long, value_name = "NAME", conflicts_with = "plc_process")]
    plc: Option<String>,
    /// Runs the PLC program in another process: starts this command, which maps the file `{image}`, and ends it after the run.
    ///
    /// The process answers each scan (lock-step), so the trace is the same to the byte in every run. It replaces `plc` of the scenario; in a
    /// scenario the same is `plc = { process = "…" }`. Its output is printed on standard error. The words of the command are separated by
    /// spaces, quotes keep a word together; it is not run by a shell.
    #[arg(long, value_name = "COMMAND")]
    plc_process: Option<String>,
    /// With --plc-process: how long the process may take until it opens the image, and for an answer.
    #[arg(long, value_name = "TIME", requires = "plc_process", default_value = "10s", value_parser = duration)]
    plc_timeout: Duration,
    /// Writes the trace as JSON lines, for programs; one scenario only.
    #[arg(long, value_name = "F.jsonl")]
    trace: Option<PathBuf>,
    /// Writes the trace as waveforms (VCD), for GTKWave and similar viewers; one scenario only.
    #[arg(long, value_name = "F.vcd")]
    vcd: Option<PathBuf>,
    /// Writes the trace as a timing diagram of the watched signals; one scenario only.
    #[arg(long, value_name = "F.svg")]
    svg: Option<PathBuf>,
    /// With --svg: draws these values as curves with one scale, instead of the watched signals.
    ///
    /// Names are those of values: `X.following_error`, `XF.synchronism_difference`, `R5`, and patterns such as `*.velocity`. Values in
    /// other units have a scale of their own. The values need not be watched.
    #[arg(long, value_name = "VALUE", value_delimiter = ',', requires = "svg")]
    curves: Vec<String>,
    /// Writes which statements, networks, branches and contacts of STEP 7 programs ran in all scenarios together.
    #[arg(long, value_name = "F.html|F.json|F.lcov")]
    plc_coverage: Option<PathBuf>,
    /// With --svg or --vcd: shows only what happens from this time on, in seconds or with a unit.
    #[arg(long, value_name = "TIME", value_parser = time)]
    from: Option<Time>,
    /// With --svg or --vcd: shows only what happens up to this time.
    #[arg(long, value_name = "TIME", value_parser = time)]
    to: Option<Time>,
}

/// Formats a finished run as the text of a file.
type Form = fn(&Finished, Option<&Curves>) -> String;

/// An open file and the format of its text.
struct Waiting {
    file: Replacement,
    text: Form,
}

/// The file of the coverage, with its form.
type Covering = (coverage::Form, Replacement);

impl Options {
    /// The part of the trace that waveform and diagram show.
    fn window(&self) -> Result<Window, Problem> {
        let Self { from, to, .. } = *self;
        if (from.is_some() || to.is_some()) && self.svg.is_none() && self.vcd.is_none() {
            let what = "expected --svg or --vcd together with --from and --to, found neither";
            return Err(Problem::new(what, "--from and --to select a part of the picture; other outputs are complete"));
        }
        match (from, to) {
            (Some(from), Some(to)) if from >= to => {
                let what = format!("expected a time --from before the time --to, found {from} s and {to} s");
                Err(Problem::new(what, "exchange the two"))
            }
            _ => Ok(Window { from, to }),
        }
    }

    /// The values for curves on a machine, without values yet.
    fn curves(&self, machine: &Machine) -> Result<Option<Curves>, Problem> {
        if self.curves.is_empty() {
            return Ok(None);
        }
        let entries: Vec<&str> = self.curves.iter().map(String::as_str).collect();
        let curves = Curves::parse(&entries, machine.names(), machine.memory(), machine.variables());
        curves.map(Some).map_err(|(_, problem)| problem.at(&Place::file("--curves")))
    }

    /// The PLC program in another process; it runs in the folder of the user.
    fn process(&self) -> Option<PlcProcess> {
        self.plc_process.clone().map(|command| PlcProcess {
            command,
            directory: PathBuf::new(),
            time_out: Time::from_nanos(i64::try_from(self.plc_timeout.as_nanos()).unwrap_or(i64::MAX)),
            is_shown: true,
        })
    }

    /// Opens all files before anything runs.
    fn open(&self, runs: usize, inputs: Vec<PathBuf>) -> Result<(Vec<Waiting>, Option<Covering>), Problem> {
        let wanted: [(&'static str, &Option<PathBuf>, Form); 3] = [
            ("--trace", &self.trace, |finished, _| finished.json_lines()),
            ("--vcd", &self.vcd, |finished, _| finished.vcd()),
            ("--svg", &self.svg, picture),
        ];
        let mut files = Files::of(inputs);
        let mut waiting = Vec::new();
        let coverage = match &self.plc_coverage {
            Some(path) => Some((coverage::Form::of(path)?, files.open("--plc-coverage", path)?)),
            None => None,
        };
        for (option, path, text) in wanted {
            let Some(path) = path else {
                continue;
            };
            if runs != 1 {
                return Err(Problem::new(
                    format!("expected one scenario under one profile with {option}, found {runs} runs"),
                    "run each scenario separately, with its own file; `--case TEXT` chooses a case of a matrix",
                ));
            }
            waiting.push(Waiting { file: files.open(option, path)?, text });
        }
        Ok((waiting, coverage))
    }
}

/// Reads all files before anything runs. If one file is unusable, nothing runs.
pub(super) fn run(scenarios: &[PathBuf], options: &Options, programs: &Programs, output: &mut Output) -> u8 {
    let (mut ready, mut inputs) = (Vec::new(), Vec::new());
    let mut usable = true;
    for file in scenarios {
        match prepare(file, options, programs, &mut inputs) {
            Ok(prepared) => ready.extend(prepared),
            Err(problem) => {
                output.error(problem);
                usable = false;
            }
        }
    }
    if !usable {
        return 2;
    }
    let opened = options.window().and_then(|window| {
        let curves = ready.first().map(|prepared| options.curves(prepared.machine())).transpose()?.flatten();
        Ok((window, curves, options.open(ready.len(), inputs)?))
    });
    let (window, mut curves, (mut waiting, covering)) = match opened {
        Ok(opened) => opened,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let mut code = 0;
    let mut covered = Vec::new();
    for (index, prepared) in ready.into_iter().enumerate() {
        if index > 0 {
            output.line("");
        }
        for warning in prepared.warnings() {
            output.warning(warning);
        }
        let prepared = if options.margins { prepared.measure_margins() } else { prepared };
        let mut finished = prepared.run_with(None, &mut |machine| {
            if let Some(curves) = &mut curves {
                curves.look(machine.cycle(), machine.variables());
            }
        });
        finished.window = window;
        output.print(&finished.text());
        code = code.max(result(&finished, output));
        if let Some(one) = finished.session().machine().program_coverage().filter(|_| covering.is_some()) {
            coverage::add(&mut covered, one);
        }
        if options.margins {
            finished.margins().iter().for_each(|margin| output.line(margin));
        }
        if let Some(from) = window.from.filter(|from| *from > finished.session().time()) {
            let end = finished.session().time();
            output.warning(format!("the trace ends at {end} s, before --from {from} s: the picture shows no change"));
        }
        for Waiting { mut file, text } in waiting.drain(..) {
            if let Err(problem) = file.write(&text(&finished, curves.as_ref())).and_then(|()| file.finish()) {
                output.error(problem);
                code = 2;
            }
        }
    }
    if let Some((form, mut file)) = covering {
        covered.iter().for_each(|one| output.line(format!("PLC {}", one.summary())));
        if let Err(problem) = form.text(&covered).and_then(|text| file.write(&text)).and_then(|()| file.finish()) {
            output.error(problem);
            code = 2;
        }
    }
    code
}

/// The timing diagram of the watched signals, or the curves that were asked for.
fn picture(finished: &Finished, curves: Option<&Curves>) -> String {
    let Some(curves) = curves else {
        return finished.svg();
    };
    finished.plot(curves, &curves.by_unit(finished.session().machine()))
}

/// All cases of one scenario under each of its profiles; with `wanted`, the cases whose values contain this text.
fn prepare(
    file: &Path,
    options: &Options,
    programs: &Programs,
    inputs: &mut Vec<PathBuf>,
) -> Result<Vec<Prepared>, Problem> {
    let wanted = options.case.as_deref();
    let mut cases = Scenario::read_cases(file)?;
    if let Some(process) = options.process() {
        for case in &mut cases {
            case.plc = None;
            case.plc_process = Some((process.clone(), Place::file("--plc-process")));
        }
    }
    if let Some(name) = &options.plc {
        // A folder is one of the user's working directory, not of the scenario.
        let folder = Path::new(name).canonicalize().ok().filter(|_| Programs::is_folder(name));
        let text = folder.map_or_else(|| name.clone(), |folder| folder.to_string_lossy().into_owned());
        for case in &mut cases {
            case.plc = Some(Named { text: text.clone(), place: Place::file("--plc") });
            case.plc_process = None;
        }
    }
    inputs.extend(cases.iter().flat_map(Scenario::inputs));
    let mut ready = Vec::new();
    let mut known = Vec::new();
    for scenario in &cases {
        if let Some(wanted) = wanted {
            match &scenario.variant {
                Some(variant) if variant.fits(wanted) => {}
                Some(variant) => {
                    known.push(variant.to_string());
                    continue;
                }
                None => continue,
            }
        }
        for profile in &scenario.profiles {
            ready.push(scenario.prepare(*profile, programs)?);
        }
    }
    if ready.is_empty() {
        let what = format!("expected a case with `{}`, found none", wanted.unwrap_or_default());
        known.truncate(10);
        let cure = match known.is_empty() {
            true => "the scenario has no `[matrix]`: omit --case".to_owned(),
            false => format!("cases are {}", known.join("; ")),
        };
        return Err(Place::file(&file.display().to_string()).problem(what, cure));
    }
    Ok(ready)
}

/// Prints how a scenario ended, and returns its exit code.
pub(super) fn result(finished: &Finished, output: &mut Output) -> u8 {
    let session = finished.session();
    if session.trace().lost() > 0 {
        output.warning(format!("{} rows of the trace were lost", session.trace().lost()));
    }
    let word = if finished.failure.is_none() { "passed" } else { "failed" };
    output.line(format!("\n{word}, after {} s", session.time()));
    finished.remarks().iter().for_each(|remark| output.line(remark));
    match &finished.failure {
        None => 0,
        Some(failure) => {
            output.error(failure);
            match failure {
                Failure::Missed(_) => 1,
                Failure::Unusable(_) => 2,
            }
        }
    }
}

/// Parses a time in seconds or with a unit.
fn time(text: &str) -> Result<Time, String> {
    Time::parse_or_seconds(text).ok_or_else(|| format!("expected a time such as 7.5, 7.5s or 500ms, found {text}"))
}
