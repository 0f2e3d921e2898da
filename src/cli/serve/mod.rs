//! `opennck serve`: a machine in real time, and its windows for operator panels and data collectors.

#![expect(clippy::disallowed_methods, reason = "real time is what it is for")]

mod arguments;
mod banner;
mod handles;
mod log;
mod opening;

pub(super) use arguments::Arguments;

use std::fs::File;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tokio::runtime::Builder;

use super::output::{Output, apart};
use crate::live::{Exchange, Keeper, Live, LiveOptions, MappedPlc, Speed};
use crate::plc::Programs;
use crate::s7::live::Window;
use crate::scenario::State;
use crate::source::Problem;
use crate::variables::Describe;
use opening::Opened;

/// How often the status line is drawn.
const DRAW: Duration = Duration::from_millis(200);
/// Over how long its rates are taken.
const RATES: Duration = Duration::from_secs(1);

pub(super) fn serve(arguments: &Arguments, programs: &Programs, output: &mut Output) -> u8 {
    let attended = open(arguments, programs, output).and_then(|served| {
        let attended = attend(arguments, &served, output);
        let closed = served.close();
        attended.and(closed)
    });
    match attended {
        Ok(()) => 0,
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}

/// What is open.
struct Served {
    /// It closes before the machine ends.
    window: Window,
    /// It ends before the machine, too.
    keeper: Option<Keeper>,
    live: Live,
    status: ProgressBar,
    /// What to say of it.
    head: String,
    /// Where the trace is written when it ends.
    trace: Option<Kept>,
}

impl Served {
    /// Ends it: no client writes any more, then the last step, then what was kept.
    fn close(self) -> Result<(), Problem> {
        let Self { window, keeper, live, trace, .. } = self;
        drop(window);
        drop(keeper);
        let Some(trace) = trace else {
            return Ok(());
        };
        let ended = live.end();
        let lost = ended.as_ref().and_then(|ended| ended.trace.as_ref()).map_or(0, |(trace, _)| trace.lost());
        if lost > 0 {
            tracing::warn!("{lost} rows of the trace were lost: too much changed in one cycle");
        }
        let text = ended.and_then(|ended| ended.json_lines());
        trace.write(&text.unwrap_or_default())
    }
}

/// A file that is written when all is over; what was in it before stays until then.
struct Kept {
    path: PathBuf,
    file: File,
}

impl Kept {
    fn open(path: &Path, arguments: &Arguments) -> Result<Self, Problem> {
        if arguments.record.as_deref() == Some(path) {
            return Err(Problem::new(
                format!("expected two files, found {} for --record and --trace", path.display()),
                "name another one for the trace, for example one that ends in .jsonl",
            ));
        }
        let Arguments { scenario, plc_image, image, identity, pcap, .. } = arguments;
        let files = [scenario, image, identity, pcap].into_iter().flatten().map(PathBuf::as_path);
        apart("--trace", path, files.chain(plc_image.iter().map(Path::new)))?;
        let file = File::options().write(true).create(true).truncate(false).open(path);
        let file = file.map_err(|error| Self::cannot(path, &error))?;
        Ok(Self { path: path.to_owned(), file })
    }

    fn write(mut self, text: &str) -> Result<(), Problem> {
        let is_file = self.file.metadata().is_ok_and(|data| data.is_file());
        let emptied = if is_file { self.file.set_len(0) } else { Ok(()) };
        let written = emptied.and_then(|()| self.file.write_all(text.as_bytes()));
        written.map_err(|error| Self::cannot(&self.path, &error))
    }

    fn cannot(path: &Path, error: &std::io::Error) -> Problem {
        Problem::new(
            format!("--trace {}: cannot be written: {error}", path.display()),
            "check the path, the rights and the disk",
        )
    }
}

/// Opens all doors, or says which one stays closed.
fn open(arguments: &Arguments, programs: &Programs, output: &mut Output) -> Result<Served, Problem> {
    let opened = Opened::open(arguments, programs, output)?;
    let machine = &opened.machine;
    let window = arguments.window(machine)?;
    if let (Some(_), Some(name)) = (&arguments.image, &opened.plc) {
        return Err(Problem::new(
            format!("expected one PLC program, found {name} of the scenario and --image"),
            "remove `plc` from the scenario: the PLC process is the program",
        ));
    }
    let terms = window.terms.clone();
    let mut head = banner::machine(&opened, arguments);
    let status = status_line();
    // A program that has a log of its own keeps it.
    let _ = tracing::subscriber::set_global_default(log::Log { status: status.clone(), writes: arguments.log_writes });
    let exchange = Exchange { lock_step: arguments.lock_step, time_out: arguments.plc_timeout };
    let mapped = arguments.image.as_deref().map(|file| MappedPlc::create(file, machine, exchange)).transpose()?;
    let trace = arguments.trace.as_deref().map(|path| Kept::open(path, arguments)).transpose()?;
    // Last of the files: one that has begun would be in the way of the next try.
    let recording = arguments.record.as_deref().map(|path| opening::recording(path, &opened)).transpose()?;
    let Opened { machine, operator, watch, .. } = opened;
    let (is_held, is_lock_step) = (arguments.lock_step, arguments.lock_step);
    let trace_of = trace.is_some().then_some(watch);
    let options = LiveOptions { recording, trace: trace_of, operator, is_held, is_lock_step };
    let start = |machine| Live::start_with(machine, arguments.speed, options);
    let (live, keeper) = match mapped {
        Some(mapped) => {
            let (live, keeper) = Keeper::start(machine, mapped, start);
            (live, Some(keeper))
        }
        None => (start(machine), None),
    };
    if let Some(warning) = handles::allow(arguments.clients) {
        output.warning(warning);
    }
    let addresses: Vec<_> = arguments.s7.iter().map(String::as_str).collect();
    let window = match Window::open_with(&live, &addresses, window) {
        Ok(window) => window,
        Err(problem) => {
            // Nobody could come: a file that has only just begun would be in the way of the next try.
            drop(keeper);
            drop(live);
            let _ = arguments.record.as_ref().map(std::fs::remove_file);
            return Err(problem);
        }
    };
    if let Some(warning) = arguments.warning(window.addresses()) {
        output.warning(warning);
    }
    head += &banner::doors(window.addresses(), arguments, &terms);
    for address in window.metrics_addresses() {
        head += &format!("metrics on http://{address}/metrics\n");
    }
    if let Some(file) = arguments.image.as_deref().filter(|_| arguments.lock_step) {
        head += &waiting(file);
    }
    if let Some(faults) = &arguments.s7_fault {
        head += &format!("faults on purpose: {faults}\n");
    }
    head += "Ctrl-C ends\n";
    Ok(Served { window, keeper, live, status, head, trace })
}

/// What the first step waits for.
fn waiting(image: &Path) -> String {
    let image = image.display();
    format!(
        "the first step waits for a PLC process that opens {image}, for example\n  \
        python3 examples/python_plc/worked_example.py {image}\n"
    )
}

fn status_line() -> ProgressBar {
    let bar = if std::io::stderr().is_terminal() {
        ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
    } else {
        ProgressBar::hidden()
    };
    bar.set_style(ProgressStyle::with_template("{wide_msg}").unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// Waits for Ctrl-C or SIGTERM.
fn attend(arguments: &Arguments, served: &Served, output: &mut Output) -> Result<(), Problem> {
    let Served { live, window, keeper, status: bar, head, .. } = served;
    let mut status = Status::new(live, window);
    let no_signals = |error: std::io::Error| {
        Problem::new(
            format!("the system gives no signals: {error}"),
            "close other programs: it may have no handles left",
        )
    };
    let runtime = Builder::new_current_thread().enable_all().build().map_err(no_signals)?;
    let ended = runtime.block_on(async {
        let mut end = std::pin::pin!(signals().map_err(no_signals)?);
        // From here on a signal ends it properly.
        output.print(head);
        let mut draw = tokio::time::interval(DRAW);
        loop {
            tokio::select! {
                () = &mut end => return Ok(()),
                _ = draw.tick() => bar.set_message(status.line(arguments.speed)),
            }
            if !live.is_running() {
                return Err(Problem::new(
                    "the machine has stopped by a defect of the simulator",
                    "please report it with what stands above",
                ));
            }
        }
    });
    if arguments.lock_step {
        // Before it need not wait any more: so the scan that waits is the last one, whenever the signal came.
        live.finish();
    }
    if let Some(keeper) = keeper {
        keeper.let_go();
    }
    bar.finish_and_clear();
    tracing::info!("ends: {}", status.sum());
    ended
}

/// Listens for signals from now on, and waits for the first.
#[cfg(unix)]
pub(super) fn signals() -> std::io::Result<impl Future<Output = ()>> {
    use tokio::signal::unix::{SignalKind, signal};
    let (mut interrupt, mut terminate) = (signal(SignalKind::interrupt())?, signal(SignalKind::terminate())?);
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
        }
    })
}

#[cfg(not(unix))]
pub(super) fn signals() -> std::io::Result<impl Future<Output = ()>> {
    Ok(async {
        let _ = tokio::signal::ctrl_c().await;
    })
}

/// The line at the bottom of a terminal.
struct Status<'a> {
    live: &'a Live,
    window: &'a Window,
    /// When rates were taken last: time of the machine, answers.
    last: (Instant, f64, u64),
    speed: Option<f64>,
    rate: u64,
}

impl<'a> Status<'a> {
    fn new(live: &'a Live, window: &'a Window) -> Self {
        let time = live.with(|machine| machine.time().seconds());
        Self { live, window, last: (Instant::now(), time, window.answers()), speed: None, rate: 0 }
    }

    fn line(&mut self, wanted: Speed) -> String {
        if self.live.is_held() {
            return format!("step 0  waits for a PLC process to open the image  clients {}", self.window.clients());
        }
        let looked = self.live.with_soon(|machine, scenario| {
            let name = |number| machine.alarm_name(number);
            let alarms: Vec<_> = machine.variables().alarms.iter().map(|alarm| name(alarm.number)).collect();
            (machine.time().seconds(), machine.cycle(), alarms, scenario.cloned())
        });
        let Some((time, cycle, alarms, scenario)) = looked else {
            // A scan in lock-step waits for its answer; whoever waited here would not hear a signal.
            return "waits for the PLC process".to_owned();
        };
        let elapsed = self.last.0.elapsed();
        if elapsed >= RATES {
            let answers = self.window.answers();
            self.speed = Some((time - self.last.1) / elapsed.as_secs_f64());
            let millis = u64::try_from(elapsed.as_millis()).unwrap_or(u64::MAX).max(1);
            self.rate = (answers - self.last.2) * 1000 / millis;
            self.last = (Instant::now(), time, answers);
        }
        let speed = self.speed.map_or_else(|| wanted.to_string(), |speed| format!("{speed:.2}"));
        let alarms = if alarms.is_empty() { "none".to_owned() } else { alarms.join(" ") };
        let mut line = format!("{time:.1} s  step {cycle}  speed {speed}");
        if self.live.pace().overruns > 0 {
            line += &format!("  {}", self.overruns());
        }
        if let Some(scenario) = scenario {
            let how = match scenario {
                State::Acting => "acts",
                State::Done => "held",
                State::Failed(_) => "FAILED",
            };
            line += &format!("  scenario {how}");
        }
        line += &format!("  clients {} ({}/s)  alarms {alarms}", self.window.clients(), self.rate);
        line
    }

    fn overruns(&self) -> String {
        let pace = self.live.pace();
        let mut text = format!("overruns {} (worst {} ms", pace.overruns, pace.worst.as_millis());
        if !pace.lost.is_zero() {
            text += &format!(", lost {:.1} s", pace.lost.as_secs_f64());
        }
        text + ")"
    }

    /// What all of it was.
    fn sum(&self) -> String {
        let step = self.live.with(|machine| machine.cycle());
        format!("step {step}  {}  answers {}", self.overruns(), self.window.answers())
    }
}
