//! `--image FILE`: the PLC program runs in another process, which accesses the interface through a mapped file.
//!
//! [`MappedPlc`] represents that program in the machine. A scan publishes the memory and takes the answer of the other process: in
//! lock-step the answer to this scan, otherwise the newest answer. While a scan waits in lock-step, the machine is in the middle of a step
//! and clients see the step before; the time-out limits the wait. If the process is silent for longer than the time-out, the sign of life
//! is missing: the PLC stops with alarm 2000. The process may be started later than the machine: monitoring begins with its first answer,
//! and in lock-step when it has opened the file, which is also when scans begin to wait. A run is reproducible to the byte if this happens
//! before the first step: a machine that is held ([`LiveOptions::is_held`](super::LiveOptions::is_held)) takes its first step then.
//!
//! [`Keeper`] maintains the file between scans: it starts a machine that is held, publishes RUN and STOP, shows the memory in STOP,
//! restarts the PLC when a new process opens the file after a fault (alarm 2000 stays until power off and on, as on a control), and
//! switches power off and on when requested.

use std::fmt;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::shared::Shared;
use super::stepping::Live;
use crate::image::mapped::{Look, MappedImage, Refusal, Rules, State, Step};
use crate::image::{AsBytes, Memory, Names};
use crate::machine::{Command, Machine};
use crate::plc::{PlcFault, PlcIo, PlcProgram};
use crate::source::Problem;
use crate::units::Time;

/// Polling interval of the keeper.
const KEEPER_INTERVAL: Duration = Duration::from_millis(10);
/// One scan adds at most this fraction of the time-out to the silence. A computer that was asleep must not make the process count as
/// silent.
const SHARE: u32 = 4;
/// How long the last scans wait for their answer at the end.
const LAST_ANSWER: Duration = Duration::from_millis(100);
/// How long a scan polls for its answer without sleeping: several times as long as an empty program needs. To let other threads run instead
/// (`yield_now`) is slower on a busy computer: they run for milliseconds.
const SPINNING: Duration = Duration::from_micros(200);
/// How long it sleeps between polls after that.
const POLL_INTERVAL: Duration = Duration::from_micros(50);
/// Shortest and longest interval between log lines about repeated events of the other process.
const PAUSES: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(64)];

/// How answers are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exchange {
    /// Each scan waits for its answer.
    pub lock_step: bool,
    /// How long the other process may be silent, by the clock of the computer.
    pub time_out: Duration,
}

/// A PLC program in another process.
#[derive(Debug)]
pub struct MappedPlc {
    image: Arc<Mutex<MappedImage>>,
    exchange: Exchange,
    /// Answers to earlier steps are older than the start.
    least: u64,
    /// A process has answered since the last silence; in lock-step, it has opened the file.
    is_watched: bool,
    silent: Duration,
    last_scan: Instant,
    refusal: Option<Refusal>,
    /// How often a process had opened the file when this was created or when the last silence was detected.
    plc_starts: u64,
    /// The machine is ending; scans no longer wait for the process.
    ends: Arc<AtomicBool>,
    has_ended: Option<HasEnded>,
}

/// Tells whether the process has ended, and how.
struct HasEnded(Box<dyn FnMut() -> Option<String> + Send>);

impl fmt::Debug for HasEnded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("HasEnded")
    }
}

impl MappedPlc {
    /// Creates the file for a machine.
    ///
    /// # Errors
    /// The file cannot be used, is not an image, or is in use by another machine.
    pub fn create(path: &Path, machine: &Machine, exchange: Exchange) -> Result<Self, Problem> {
        Self::of(path, machine.memory(), machine.names(), machine.cycle_time(), exchange)
    }

    /// The same from the parts of a machine.
    pub(super) fn of(
        path: &Path,
        memory: &Memory,
        names: &Names,
        cycle: Time,
        exchange: Exchange,
    ) -> Result<Self, Problem> {
        let time_out = i64::try_from(exchange.time_out.as_nanos()).unwrap_or(i64::MAX);
        let rules = Rules { lock_step: exchange.lock_step, time_out: Time::from_nanos(time_out) };
        let image = MappedImage::create(path, memory, names, rules)?;
        image.cycle_time(cycle);
        Ok(Self {
            least: 0,
            plc_starts: image.plc_starts_before(),
            image: Arc::new(Mutex::new(image)),
            exchange,
            is_watched: false,
            silent: Duration::ZERO,
            last_scan: Instant::now(),
            refusal: None,
            ends: Arc::default(),
            has_ended: None,
        })
    }

    /// Ends the waiting for an answer when the process has ended: this tells how, if it has.
    pub(super) fn notice_end(&mut self, has_ended: impl FnMut() -> Option<String> + Send + 'static) {
        self.has_ended = Some(HasEnded(Box::new(has_ended)));
    }

    /// Whether a process has opened the file since it was created.
    pub(super) fn is_opened(&self) -> bool {
        lock(&self.image).plc_starts() != self.plc_starts
    }

    /// How often a process has opened the file since it was created, and how often it has asked for power off and on.
    pub(super) fn counts(&self) -> [u64; 2] {
        let image = lock(&self.image);
        [image.plc_starts(), image.power_requests()]
    }

    /// Shows the end to the process, so that it can end by itself.
    pub(super) fn end(&self) {
        lock(&self.image).state(State::Ended);
    }

    /// Waits until a process has opened the file, for a machine without a [`Keeper`]. In lock-step the process then answers from the first
    /// scan on, and the same program gives the same trace in every run.
    ///
    /// # Errors
    /// No process opened the file in time.
    pub fn wait_for_plc(&mut self, longest: Duration) -> Result<(), Problem> {
        let start = Instant::now();
        while !self.is_opened() {
            if start.elapsed() > longest {
                return Err(Problem::new(
                    format!("no PLC process opened the image within {longest:?}"),
                    "start the process; it must add 1 to PLC_STARTS when it has opened the file",
                ));
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        Ok(())
    }

    fn take_newest(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        let mut image = lock(&self.image);
        let since = self.last_scan.elapsed();
        match image.look(self.least) {
            Look::Answer(_) => {
                image.take(io);
                self.is_watched = true;
                self.silent = Duration::ZERO;
                return Ok(());
            }
            Look::Refused(refusal) => self.refusal = Some(refusal),
            Look::Nothing => {}
        }
        if self.is_watched {
            self.silent += since.min(self.exchange.time_out / SHARE);
            if self.silent > self.exchange.time_out {
                self.plc_starts = image.plc_starts();
                return Err(self.silence());
            }
        }
        Ok(())
    }

    /// Publishes a step and waits for its answer.
    fn take_answer(&mut self, step: Step, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        let mut image = lock(&self.image);
        let mut number = publish(&mut image, io, step, true);
        let start = Instant::now();
        loop {
            match image.look(number) {
                Look::Answer(_) => {
                    image.take(io);
                    return Ok(());
                }
                // The process answered a step from before the start. It is alive: publish a new step for it to answer.
                Look::Refused(Refusal::Step) => number = publish(&mut image, io, step, true),
                Look::Refused(refusal) => self.refusal = Some(refusal),
                Look::Nothing => {}
            }
            let waited = start.elapsed();
            if waited > LAST_ANSWER && self.ends.load(Ordering::Relaxed) {
                return Ok(());
            }
            if waited > self.exchange.time_out {
                // A process that opens the file from now on is a new one.
                self.plc_starts = image.plc_starts();
                image.give_up();
                drop(image);
                return Err(self.silence());
            }
            if waited < SPINNING {
                std::hint::spin_loop();
                continue;
            }
            if let Some(how) = self.has_ended.as_mut().and_then(|HasEnded(has_ended)| has_ended()) {
                image.give_up();
                return Err(PlcFault::new(how));
            }
            std::thread::sleep(POLL_INTERVAL);
        }
    }

    fn silence(&self) -> PlcFault {
        let refused =
            self.refusal.map_or_else(String::new, |refusal| format!("; its last answer was rejected: {refusal}"));
        PlcFault::new(format!("no answer from the PLC process for {:?}{refused}", self.exchange.time_out))
    }
}

impl PlcProgram for MappedPlc {
    fn name(&self) -> &'static str {
        "mapped image"
    }

    fn startup(&mut self, _: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        self.least = lock(&self.image).start();
        self.silent = Duration::ZERO;
        self.refusal = None;
        self.last_scan = Instant::now();
        Ok(())
    }

    fn scan(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        let lock_step = self.exchange.lock_step;
        if lock_step && !self.is_watched {
            self.is_watched = lock(&self.image).plc_starts() != self.plc_starts;
        }
        let mut taken = Ok(());
        if !(lock_step && self.is_watched) {
            taken = self.take_newest(io);
        }
        self.last_scan = Instant::now();
        let step = Step { cycle: io.cycle, time: io.time, since_last: io.cycle_time };
        if lock_step && self.is_watched && taken.is_ok() {
            taken = self.take_answer(step, io);
        } else {
            publish(&mut lock(&self.image), io, step, false);
        }
        self.is_watched &= taken.is_ok();
        taken
    }

    /// The state of the program is in the other process.
    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        if saved.is_empty() {
            return Ok(());
        }
        Err(Problem::new(
            format!("expected the saved state of a mapped image, found {} bytes of another program", saved.len()),
            "restore it with the program that was saved",
        ))
    }

    fn fork(&self) -> Option<Box<dyn PlcProgram>> {
        None
    }

    fn reset(&mut self) {}
}

/// Maintains the file of a live machine until it is dropped.
#[derive(Debug)]
pub struct Keeper {
    ends: Arc<AtomicBool>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Keeper {
    /// Gives a machine its program in another process, starts the machine, and maintains the file. A machine that is held takes its first
    /// step when a process has opened the file.
    #[must_use]
    pub fn start(mut machine: Machine, plc: MappedPlc, start: impl FnOnce(Machine) -> Live) -> (Live, Self) {
        let (image, ends) = (Arc::clone(&plc.image), Arc::clone(&plc.ends));
        let starts = plc.plc_starts;
        machine.load_program(Box::new(plc));
        let live = start(machine);
        let shared = live.shared();
        let (end, ended) = mpsc::channel();
        let thread = std::thread::spawn(move || keep(&shared, &image, starts, &ended));
        (live, Self { ends, end: Some(end), thread: Some(thread) })
    }
}

impl Keeper {
    /// Ends the waiting: scans wait only a moment for their answer from now on, however long the time-out is.
    pub fn let_go(&self) {
        self.ends.store(true, Ordering::Relaxed);
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        self.let_go();
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn keep(shared: &Shared, image: &Mutex<MappedImage>, mut starts: u64, ended: &mpsc::Receiver<()>) {
    let mut powers = lock(image).power_requests();
    let mut was_stopped = false;
    let [mut opened, mut switched, mut replaced, mut doubled] = std::array::from_fn(|_| RepeatedEvent::default());
    let (mut replacement, mut both) = ([0; 2], [0; 2]);
    while ended.recv_timeout(KEEPER_INTERVAL) == Err(RecvTimeoutError::Timeout) {
        let mut lines = Vec::new();
        let mut clocked = shared.lend();
        let machine = &mut clocked.machine;
        let mut image = lock(image);
        let is_stopped = machine.is_plc_stopped();
        image.cycle_time(machine.cycle_time());
        // The PLC is not in RUN before its first scan: a process that answered then would have one scan more than in another run.
        image.state(if is_stopped || !image.has_started() { State::Stop } else { State::Run });
        if is_stopped {
            show(&mut image, machine);
        }
        if let Some(fault) = machine.plc_fault().filter(|_| is_stopped && !was_stopped) {
            lines.push(format!("the PLC stops: {fault}"));
        }
        if image.plc_starts() != starts {
            starts = image.plc_starts();
            opened.times += 1;
            shared.begin();
            if machine.plc_fault().is_some() && !machine.queued().contains(&Command::PlcRun) {
                lines.push("the PLC restarts; alarm 2000 stays until power off and on".to_owned());
                let _ = machine.queue(Command::PlcRun); // it has no parameters to reject
            }
        }
        if image.power_requests() != powers {
            powers = image.power_requests();
            switched.times += 1;
            // Queued once per step, however often it is requested.
            if !machine.queued().contains(&Command::PowerOn) {
                let _ = machine.queue(Command::PowerOn);
            }
        }
        if let Some(processes) = image.take_replacement() {
            replacement = processes;
            replaced.times += 1;
        }
        if let Some(processes) = image.take_both() {
            both = processes;
            doubled.times += 1;
        }
        was_stopped = is_stopped;
        drop(image);
        drop(clocked);
        // Log after releasing the machine: a blocked terminal must not hold up a step.
        let now = Instant::now();
        let opened = opened.line("a PLC process has opened the image", now);
        let switched = switched.line("the PLC process switches power off and on", now);
        for line in opened.into_iter().chain(lines).chain(switched) {
            tracing::info!("{line}");
        }
        let [new, old] = replacement;
        let replaced =
            replaced.line(&format!("PLC process {new} answers instead of {old}: end {old} if it still runs"), now);
        let [one, other] = both;
        let what =
            format!("two PLC processes answer, {one} and {other}: each takes steps of the other; end one of them");
        for line in replaced.into_iter().chain(doubled.line(&what, now)) {
            tracing::warn!("{line}");
        }
    }
}

/// An event that another process may repeat at any rate, for example because its words contain garbage.
#[derive(Debug, Default)]
struct RepeatedEvent {
    /// Number of events since the last log line.
    times: u64,
    last: Option<Instant>,
    /// Interval until the next log line.
    pause: Duration,
}

impl RepeatedEvent {
    /// The log line for an event: at once if it is rare, at growing intervals if it repeats.
    fn line(&mut self, what: &str, now: Instant) -> Option<String> {
        let since = self.last.map(|last| now.saturating_duration_since(last));
        if self.times == 0 || since.is_some_and(|since| since < self.pause) {
            return None;
        }
        let times = std::mem::take(&mut self.times);
        let [shortest, longest] = PAUSES;
        self.pause = if times == 1 { shortest } else { (2 * self.pause).min(longest) };
        self.last = Some(now);
        Some(if times == 1 { what.to_owned() } else { format!("{what}, {times} times") })
    }
}

/// Publishes a step of the PLC in RUN. The state follows the step: until then the newest step is from before the start.
fn publish(image: &mut MappedImage, io: &PlcIo<'_, AsBytes>, step: Step, waits: bool) -> u64 {
    let number = image.publish(io, step, waits);
    image.state(State::Run);
    number
}

/// Shows the memory between scans.
fn show(image: &mut MappedImage, machine: &Machine) {
    let step = Step { cycle: machine.cycle(), time: machine.time(), since_last: Time::ZERO };
    image.publish(machine.memory(), step, false);
}

fn lock(image: &Mutex<MappedImage>) -> MutexGuard<'_, MappedImage> {
    image.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_events_are_logged_at_growing_intervals_with_their_number() {
        let begin = Instant::now();
        let mut event = RepeatedEvent::default();
        let lines: Vec<_> = (0..=700_u64)
            .filter_map(|look| {
                event.times += 1;
                let after = 10 * look;
                Some((after, event.line("power off and on", begin + Duration::from_millis(after))?))
            })
            .collect();
        // Every 10 ms: logged at once, after 1 s, after 2 s more, after 4 s more.
        let wanted = [(0, ""), (1000, ", 100 times"), (3000, ", 200 times"), (7000, ", 400 times")];
        assert_eq!(lines, wanted.map(|(after, times)| (after, format!("power off and on{times}"))));
        // An event after a long pause is logged like the first one.
        event.times = 1;
        let later = begin + 2 * PAUSES[1];
        assert_eq!(event.line("opened", later).as_deref(), Some("opened"));
        assert_eq!(event.line("opened", later + PAUSES[0]), None);
    }
}
