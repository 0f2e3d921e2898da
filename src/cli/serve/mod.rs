//! `opennck serve`: a machine in real time with its S7 server. This module has the arguments, banner, status line and exit code. The
//! machine is [`live`](crate::live), the server is [`s7::live`](crate::s7::live).

#![expect(clippy::disallowed_methods, reason = "the command runs in real time")]

mod arguments;
mod banner;
mod handles;
#[cfg(feature = "opcua")]
mod opcua;
#[cfg(any(feature = "opcua", feature = "web"))]
mod protects;
mod status;
#[cfg(feature = "web")]
mod web;

pub(super) use arguments::Arguments;

use std::path::Path;
use std::time::Duration;

use indicatif::ProgressBar;
use tokio::runtime::Builder;

use super::files::Files;
use super::interrupt;
use super::log::Log;
use super::output::Output;
use crate::live::{Exchange, Keeper, Live, LiveOptions, MappedPlc, Opened};
use crate::plc::Programs;
use crate::s7::live::LiveServer;
use crate::scenario::{Failure, State};
use crate::source::{Problem, Replacement};
use status::{Status, status_line};

/// How often the scenario is looked at with `--exit`.
const LOOK: Duration = Duration::from_millis(10);
/// Refresh interval of the status line.
const DRAW: Duration = Duration::from_millis(200);

pub(super) fn serve(arguments: &Arguments, programs: &Programs, output: &mut Output) -> u8 {
    let attended = open(arguments, programs, output).and_then(|served| {
        let attended = attend(arguments, &served, output);
        let closed = served.close();
        attended.and_then(|code| closed.map(|()| code))
    });
    match attended {
        Ok(code) => code,
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}

/// Everything that is open while the machine is served.
struct Served {
    /// Closed before the machine ends.
    server: LiveServer,
    /// Likewise.
    #[cfg(feature = "web")]
    page: Option<crate::web::WebServer>,
    /// Likewise.
    #[cfg(feature = "opcua")]
    opcua: Option<crate::opcua::OpcUaServer>,
    /// Also ended before the machine.
    keeper: Option<Keeper>,
    live: Live,
    status: ProgressBar,
    /// The banner.
    head: String,
    /// The file to which the trace is written at the end.
    trace: Option<Replacement>,
}

impl Served {
    /// Ends in this order: clients can no longer write, the machine takes its last step, the trace is written.
    fn close(self) -> Result<(), Problem> {
        #[cfg(feature = "web")]
        drop(self.page);
        #[cfg(feature = "opcua")]
        drop(self.opcua);
        let Self { server, keeper, live, trace, .. } = self;
        drop(server);
        drop(keeper);
        let Some(mut trace) = trace else {
            return Ok(());
        };
        let ended = live.end();
        let lost = ended.as_ref().and_then(|ended| ended.trace.as_ref()).map_or(0, |(trace, _)| trace.lost());
        if lost > 0 {
            tracing::warn!("{lost} rows of the trace were lost: too many changes in one cycle");
        }
        let text = ended.and_then(|ended| ended.json_lines());
        trace.write(&text.unwrap_or_default())?;
        trace.finish()
    }
}

/// The file of `--trace`, which must differ from every other file of the command.
fn trace_file(path: &Path, opened: &Opened, arguments: &Arguments) -> Result<Replacement, Problem> {
    let Arguments { scenario, image, identity, pcap, record, .. } = arguments;
    let files = [scenario, image, identity, pcap, record, &opened.image].into_iter().flatten().cloned();
    Files::of(files.chain([opened.path.clone()])).open("--trace", path)
}

/// Opens everything, or reports what cannot be opened.
fn open(arguments: &Arguments, programs: &Programs, output: &mut Output) -> Result<Served, Problem> {
    let opened = arguments.open(programs, output)?;
    let machine = &opened.machine;
    let server = arguments.server_options(machine)?;
    if let (Some(_), Some(name)) = (&arguments.image, opened.plc.as_ref().or(opened.plc_process.as_ref())) {
        return Err(Problem::new(
            format!("expected one PLC program, found two: {name} in the scenario, and --image"),
            "remove `plc` from the scenario, or omit --image",
        ));
    }
    let terms = server.terms.clone();
    let mut head = banner::machine(&opened, arguments);
    let status = status_line();
    // A program that has set up its own log keeps it.
    let _ = tracing::subscriber::set_global_default(Log { status: status.clone(), writes: arguments.log_writes });
    let exchange = Exchange { lock_step: arguments.lock_step, time_out: arguments.plc_timeout };
    let mapped = arguments.image.as_deref().map(|file| MappedPlc::create(file, machine, exchange)).transpose()?;
    let trace = arguments.trace.as_deref().map(|path| trace_file(path, &opened, arguments)).transpose()?;
    // The recording is opened last: if opening failed after it, the new file would block the next attempt.
    let recording = arguments.record.as_deref().map(|path| opened.record(path)).transpose()?;
    #[cfg(feature = "web")]
    let (page, history) =
        (web::options(arguments, &opened, &terms), web::with_history(LiveOptions::default(), arguments, &opened));
    #[cfg(not(feature = "web"))]
    let history = LiveOptions::default();
    let Opened { machine, operator, watch, .. } = opened;
    let (is_held, is_lock_step) = (arguments.lock_step, arguments.lock_step);
    let trace_of = trace.is_some().then_some(watch);
    let trace_bytes = usize::try_from(arguments.trace_limit).ok().and_then(|mib| mib.checked_mul(1024 * 1024));
    let options = LiveOptions { recording, trace: trace_of, trace_bytes, operator, is_held, is_lock_step, ..history };
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
    let server = match LiveServer::open_with(&live, &addresses, server) {
        Ok(server) => server,
        Err(problem) => {
            // No client could connect. Remove the new recording: it would block the next attempt.
            drop(keeper);
            drop(live);
            let _ = arguments.record.as_ref().map(std::fs::remove_file);
            return Err(problem);
        }
    };
    #[cfg(feature = "web")]
    let page = match web::open(&live, page) {
        Ok(page) => page,
        Err(problem) => {
            drop(server);
            drop(keeper);
            drop(live);
            let _ = arguments.record.as_ref().map(std::fs::remove_file);
            return Err(problem);
        }
    };
    #[cfg(feature = "opcua")]
    let opcua = match opcua::open(&live, arguments, &terms) {
        Ok(opcua) => opcua,
        Err(problem) => {
            #[cfg(feature = "web")]
            drop(page);
            drop(server);
            drop(keeper);
            drop(live);
            let _ = arguments.record.as_ref().map(std::fs::remove_file);
            return Err(problem);
        }
    };
    if let Some(warning) = arguments.warning(server.addresses()) {
        output.warning(warning);
    }
    head += &banner::endpoints(server.addresses(), arguments, &terms);
    for address in server.metrics_addresses() {
        head += &format!("metrics on http://{address}/metrics\n");
    }
    #[cfg(feature = "web")]
    {
        head += &web::banner(page.as_ref());
    }
    #[cfg(feature = "opcua")]
    {
        head += &opcua::banner(opcua.as_ref());
    }
    if let Some(file) = arguments.image.as_deref().filter(|_| arguments.lock_step) {
        head += &waiting(file);
    }
    if let Some(faults) = &arguments.s7_fault {
        head += &format!("injected faults: {faults}\n");
    }
    head += "press Ctrl-C to stop\n";
    Ok(Served {
        server,
        #[cfg(feature = "web")]
        page,
        #[cfg(feature = "opcua")]
        opcua,
        keeper,
        live,
        status,
        head,
        trace,
    })
}

/// The hint about what the first step waits for.
fn waiting(image: &Path) -> String {
    let image = image.display();
    format!(
        "waiting for a PLC process to open {image} before the first step, for example\n  \
        python3 examples/python_plc/worked_example.py {image}\n"
    )
}

/// Waits for Ctrl-C, SIGTERM or SIGHUP, or with `--exit` for the end of the scenario; returns the exit code.
fn attend(arguments: &Arguments, served: &Served, output: &mut Output) -> Result<u8, Problem> {
    let Served { live, server, keeper, status: bar, head, .. } = served;
    let mut status = Status::new(live, server);
    let no_signals = |error: std::io::Error| {
        Problem::new(
            format!("cannot wait for Ctrl-C and SIGTERM: {error}"),
            "close other programs: the system may have no free file handles",
        )
    };
    let runtime = Builder::new_current_thread().enable_all().build().map_err(no_signals)?;
    let ended = runtime.block_on(async {
        let mut end = std::pin::pin!(interrupt::signals().map_err(no_signals)?);
        // From here on Ctrl-C and SIGTERM shut down in order.
        output.print(head);
        let mut draw = tokio::time::interval(DRAW);
        let mut looks = tokio::time::interval(LOOK);
        loop {
            tokio::select! {
                () = &mut end => return Ok(0),
                _ = draw.tick() => bar.set_message(status.line(arguments.speed)),
                _ = looks.tick(), if arguments.exit => match live.with_soon(|_, scenario| scenario.cloned()).flatten() {
                    Some(State::Done) => return Ok(0),
                    Some(State::Failed(Failure::Missed(_))) => return Ok(1),
                    Some(State::Failed(Failure::Unusable(_))) => return Ok(2),
                    Some(State::Acting) | None => {}
                },
            }
            if !live.is_running() {
                return Err(Problem::new(
                    "the machine stopped because of a bug in the simulator",
                    "please report it together with the messages above",
                ));
            }
        }
    });
    if arguments.lock_step {
        // Call this before the waiting scan is released. That scan is then the last one, independent of when the signal arrived.
        live.finish();
    }
    if let Some(keeper) = keeper {
        keeper.let_go();
    }
    bar.finish_and_clear();
    tracing::info!("stopped: {}", status.sum());
    ended
}
