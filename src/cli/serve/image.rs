//! `--image FILE`: the PLC program runs in another process, which sees the interface as a mapped file.
//!
//! [`MappedPlc`] is that program as the machine sees it. A scan publishes the memory and takes what the other process made of it: in
//! lock-step the answer to this very scan, else the newest that there is. While a scan waits in lock-step nobody else sees the
//! machine, for it is in the middle of a step; the time-out bounds that. A process that is silent for longer is a PLC without a sign
//! of life: the PLC stops, alarm 2000. The monitoring begins with the first answer, so that the process may be started later.
//!
//! [`Keeper`] keeps the file alive while no scan does: it says RUN and STOP, shows the memory in STOP, restarts the PLC when a new
//! process comes after a fault (alarm 2000 stays, as on a control, until power off and on), and switches power on request.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::live::{Live, Shared};
use crate::image::mapped::{Look, MappedImage, Refusal, Rules, State, Step};
use crate::machine::{Command, Machine};
use crate::plc::{PlcFault, PlcIo, PlcProgram};
use crate::source::Problem;
use crate::units::Time;

/// How often the keeper looks.
const KEEP: Duration = Duration::from_millis(10);
/// One scan counts at most this part of the time-out as silence: a computer that slept makes nobody silent.
const SHARE: u32 = 4;
/// How long the last scans wait for their answer when all of it ends.
const FAREWELL: Duration = Duration::from_millis(100);
/// So long a scan waits awake for its answer, before it sleeps in between.
const AWAKE: Duration = Duration::from_micros(20);
/// So short it sleeps then.
const NAP: Duration = Duration::from_micros(20);

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
    /// Answers to earlier steps are from before the start.
    least: u64,
    /// The process has answered since it was found silent.
    is_watched: bool,
    silent: Duration,
    last_scan: Instant,
    refusal: Option<Refusal>,
    /// How often a process had opened the file when this was created.
    plc_starts: u64,
    /// Nobody waits for the process any more.
    ends: Arc<AtomicBool>,
}

impl MappedPlc {
    /// Creates the file for a machine.
    ///
    /// # Errors
    /// The file cannot be used, is no image, or is in use by another machine.
    pub fn create(path: &Path, machine: &Machine, exchange: Exchange) -> Result<Self, Problem> {
        let time_out = i64::try_from(exchange.time_out.as_nanos()).unwrap_or(i64::MAX);
        let rules = Rules { lock_step: exchange.lock_step, time_out: Time::from_nanos(time_out) };
        let image = MappedImage::create(path, machine.memory(), machine.names(), rules)?;
        image.cycle_time(machine.cycle_time());
        Ok(Self {
            least: 0,
            plc_starts: image.plc_starts(),
            image: Arc::new(Mutex::new(image)),
            exchange,
            is_watched: false,
            silent: Duration::ZERO,
            last_scan: Instant::now(),
            refusal: None,
            ends: Arc::default(),
        })
    }

    /// Waits until a process has opened the file. In lock-step it then answers from the first scan on, and the same program gives
    /// the same trace in every run.
    ///
    /// # Errors
    /// Nobody came in time.
    pub fn wait_for_plc(&mut self, longest: Duration) -> Result<(), Problem> {
        let start = Instant::now();
        while lock(&self.image).plc_starts() == self.plc_starts {
            if start.elapsed() > longest {
                return Err(Problem::new(
                    format!("expected a PLC that opens the image within {longest:?}, found none"),
                    "start it; it adds 1 to PLC_STARTS when it has opened the file",
                ));
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        self.is_watched = true;
        Ok(())
    }

    fn take_newest(&mut self, io: &mut PlcIo<'_>) -> Result<(), PlcFault> {
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
                return Err(self.silence());
            }
        }
        Ok(())
    }

    /// Publishes a step and waits for its answer.
    fn take_answer(&mut self, step: Step, io: &mut PlcIo<'_>) -> Result<(), PlcFault> {
        let mut image = lock(&self.image);
        let mut number = image.publish(io, step, true);
        let start = Instant::now();
        loop {
            match image.look(number) {
                Look::Answer(_) => {
                    image.take(io);
                    return Ok(());
                }
                // An answer to a step from before the start: now that it was seen, the PLC goes on with a step that says so.
                Look::Refused(Refusal::Step) => number = image.publish(io, step, true),
                Look::Refused(refusal) => self.refusal = Some(refusal),
                Look::Nothing => {}
            }
            let waited = start.elapsed();
            if waited > FAREWELL && self.ends.load(Ordering::Relaxed) {
                return Ok(());
            }
            if waited > self.exchange.time_out {
                image.give_up();
                drop(image);
                return Err(self.silence());
            }
            if waited < AWAKE {
                std::hint::spin_loop();
            } else {
                std::thread::sleep(NAP);
            }
        }
    }

    fn silence(&self) -> PlcFault {
        let refused =
            self.refusal.map_or_else(String::new, |refusal| format!("; its last answer was refused: {refusal}"));
        PlcFault::new(format!("no answer from the PLC process for {:?}{refused}", self.exchange.time_out))
    }
}

impl PlcProgram for MappedPlc {
    fn name(&self) -> &'static str {
        "mapped image"
    }

    fn startup(&mut self, _: &mut PlcIo<'_>) -> Result<(), PlcFault> {
        self.least = lock(&self.image).start();
        self.silent = Duration::ZERO;
        self.refusal = None;
        self.last_scan = Instant::now();
        Ok(())
    }

    fn scan(&mut self, io: &mut PlcIo<'_>) -> Result<(), PlcFault> {
        let mut taken = Ok(());
        if !(self.exchange.lock_step && self.is_watched) {
            taken = self.take_newest(io);
        }
        self.last_scan = Instant::now();
        let step = Step { cycle: io.cycle, time: io.time, since_last: io.cycle_time };
        if self.exchange.lock_step && self.is_watched && taken.is_ok() {
            taken = self.take_answer(step, io);
        } else {
            lock(&self.image).publish(io, step, false);
        }
        if taken.is_err() {
            self.is_watched = false;
        }
        taken
    }

    /// What it remembers is in the other process.
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

/// Keeps the file of a live machine alive until it is dropped.
#[derive(Debug)]
pub struct Keeper {
    ends: Arc<AtomicBool>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Keeper {
    /// Gives a machine its program in another process, starts the machine, and keeps the file.
    #[must_use]
    pub fn start(mut machine: Machine, plc: MappedPlc, start: impl FnOnce(Machine) -> Live) -> (Live, Self) {
        let (image, ends) = (Arc::clone(&plc.image), Arc::clone(&plc.ends));
        machine.load_program(Box::new(plc));
        let live = start(machine);
        let shared = live.shared();
        let (end, ended) = mpsc::channel();
        let thread = std::thread::spawn(move || keep(&shared, &image, &ended));
        (live, Self { ends, end: Some(end), thread: Some(thread) })
    }
}

impl Keeper {
    /// All of it ends: nobody waits long for a process any more, however patient the time-out is.
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

fn keep(shared: &Shared, image: &Mutex<MappedImage>, ended: &mpsc::Receiver<()>) {
    let mut starts = lock(image).plc_starts();
    let mut powers = lock(image).power_requests();
    let mut was_stopped = false;
    while ended.recv_timeout(KEEP) == Err(RecvTimeoutError::Timeout) {
        let mut lines = Vec::new();
        let mut clocked = shared.lend();
        let machine = &mut clocked.machine;
        let mut image = lock(image);
        let is_stopped = machine.is_plc_stopped();
        image.cycle_time(machine.cycle_time());
        image.state(if is_stopped { State::Stop } else { State::Run });
        if is_stopped {
            show(&mut image, machine);
        }
        if let Some(fault) = machine.plc_fault().filter(|_| is_stopped && !was_stopped) {
            lines.push(format!("the PLC stops: {fault}"));
        }
        if image.plc_starts() != starts {
            starts = image.plc_starts();
            lines.push("a PLC process has opened the image".to_owned());
            if machine.plc_fault().is_some() {
                lines.push("the PLC restarts; alarm 2000 stays until power off and on".to_owned());
                let _ = machine.queue(Command::PlcRun); // it has no parameter that could be wrong
            }
        }
        if image.power_requests() != powers {
            powers = image.power_requests();
            lines.push("the PLC process switches power off and on".to_owned());
            let _ = machine.queue(Command::PowerOn);
        }
        was_stopped = is_stopped;
        drop(image);
        drop(clocked);
        // Nobody waits for the machine while a terminal waits for its reader.
        for line in lines {
            tracing::info!("{line}");
        }
    }
}

/// Shows the memory while no scan does.
fn show(image: &mut MappedImage, machine: &Machine) {
    let step = Step { cycle: machine.cycle(), time: machine.time(), since_last: Time::ZERO };
    image.publish(machine.memory(), step, false);
}

fn lock(image: &Mutex<MappedImage>) -> MutexGuard<'_, MappedImage> {
    image.lock().unwrap_or_else(PoisonError::into_inner)
}
