//! A machine in real time: a thread that steps it when its cycle is due, and a lock that lends it between two steps. Clients do not take
//! that lock: they see a copy of the last step (`seen.rs`), and what they ask for waits for the edge of the next (`inbox.rs`).
//!
//! The schedule is absolute: cycle n is due n cycles after the start, so delays do not add up. A cycle that begins later than the
//! next one was due is an overrun and is made up for at once. Who is late by more than [`GIVE_UP`] lets the time go: a computer that
//! slept does not rush.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, TryRecvError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use tokio::sync::watch;

use super::diagnosis::Buffer;
use super::inbox::{self, Inbox, Order};
use super::record::Recording;
use super::seen::{Seen, View};
use super::speed::Speed;
use super::urgency::Urgency;
use crate::machine::Machine;
use crate::s7::DateAndTime;
use crate::scenario::{Operator, State};
use crate::trace::{Trace, Watch};
use crate::units::Time;
use crate::variables::{Describe, RaisedAlarm};

/// Later than this, and the time is lost.
pub const GIVE_UP: Duration = Duration::from_millis(500);
/// A computer wakes nobody more exactly than this.
const EXACT: Duration = Duration::from_millis(1);
/// How often a machine that is held looks whether it may begin.
const HELD: Duration = Duration::from_millis(1);
/// How often the lock is tried by whoever does not wait for it.
const SOON: u32 = 40;
/// How often the stepping thread lets others go first, at most.
const COURTESY: u32 = 100;

/// How often who wants the machine lets others go first before it waits in a queue.
const PATIENCE: u32 = 20;

/// A machine that runs in real time until it is dropped.
#[derive(Debug)]
pub struct Live {
    shared: Arc<Shared>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// How well the schedule was kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pace {
    /// Cycles that began later than the next one was due.
    pub overruns: u64,
    /// The latest of them.
    pub worst: Duration,
    /// Time that was given up.
    pub lost: Duration,
}

/// What the stepping thread and those outside share.
#[derive(Debug)]
pub(crate) struct Shared {
    clocked: Mutex<Clocked>,
    /// What clients see of it.
    view: View,
    /// What clients asked for.
    pub(crate) inbox: Inbox,
    /// A scan may wait for a process: each step is shown before it does.
    is_lock_step: bool,
    /// A step is shown while somebody looks; faster, few of so many are looked at, and each is copied for who does.
    is_real_time: bool,
    /// How many wait for the lock.
    waiting: AtomicUsize,
    /// How many steps are over.
    pub(crate) steps: watch::Sender<u64>,
    overruns: AtomicU64,
    worst: AtomicU64,
    lost: AtomicU64,
    speed: Speed,
    /// It takes no step yet.
    is_held: AtomicBool,
}

/// A machine with the clock of its CPU, and what is kept of what happens to it.
#[derive(Debug)]
pub(crate) struct Clocked {
    pub(crate) machine: Machine,
    /// How many steps it has taken here.
    steps: u64,
    pub(crate) diagnosis: Buffer,
    set: DateAndTime,
    set_at: Time,
    pub(crate) recording: Option<Recording>,
    trace: Option<(Trace, Watch)>,
    pub(crate) operator: Option<Operator>,
}

/// What goes with a live machine.
#[derive(Debug, Default)]
pub struct LiveOptions {
    /// Writes down what is done to it.
    pub recording: Option<Recording>,
    /// Keeps its trace, in memory, which shows this.
    pub trace: Option<Watch>,
    /// Acts on it, for a machine that has not run yet.
    pub operator: Option<Operator>,
    /// It is looked at as it was switched on, and takes its first step after [`Live::begin`].
    pub is_held: bool,
    /// Its scans may wait for a process: each step is shown to clients before it waits in the next one.
    pub is_lock_step: bool,
}

/// What was kept of a machine that has ended.
#[derive(Debug)]
pub struct Ended {
    /// The machine.
    pub machine: Machine,
    /// Its trace and what that shows, if it was kept.
    pub trace: Option<(Trace, Watch)>,
}

impl Ended {
    /// The trace as JSON lines, if it was kept.
    #[must_use]
    pub fn json_lines(&self) -> Option<String> {
        self.trace.as_ref().map(|(trace, watch)| trace.json_lines(&self.machine, watch))
    }
}

impl Clocked {
    fn new(machine: Machine, options: LiveOptions) -> Self {
        let LiveOptions { recording, trace, operator, .. } = options;
        let trace = trace.map(|watch| {
            let mut trace = Trace::begin(machine.memory(), machine.cycle_time(), machine.cycle());
            trace.watch_values(&watch, machine.cycle(), machine.variables());
            (trace, watch)
        });
        let set = today();
        let (diagnosis, set_at) = (Buffer::new(&machine, set), machine.time());
        Self { diagnosis, set, set_at, steps: 0, machine, recording, trace, operator }
    }

    /// Notes what became of the CPU in a step.
    fn observe(&mut self) {
        let Self { machine, diagnosis, set, set_at, .. } = self;
        diagnosis.observe(machine, || clock(*set, machine.time() - *set_at));
    }

    /// The clock goes with the machine, at whatever speed.
    pub(crate) fn clock(&self) -> DateAndTime {
        clock(self.set, self.machine.time() - self.set_at)
    }

    pub(crate) fn set_clock(&mut self, time: DateAndTime) {
        (self.set, self.set_at) = (time, self.machine.time());
    }

    /// What clients see of it now.
    fn seen(&self) -> Box<Seen> {
        let (machine, diagnosis) = (self.machine.snapshot(), self.diagnosis.entries().to_vec());
        Box::new(Seen { step: self.steps, machine, clock: self.clock(), diagnosis })
    }

    /// Queues what clients asked for. Says what of it the machine does not take.
    fn take(&mut self, orders: Vec<Order>) -> Vec<String> {
        let mut lines = Vec::new();
        for Order { client, commands } in orders {
            if let Some(recording) = &mut self.recording {
                recording.client(&self.machine, client);
            }
            let queued = commands.iter().map(|command| inbox::queue(self, command));
            let problems = queued.filter_map(Result::err);
            lines.extend(problems.map(|problem| format!("a client wrote what the machine does not take: {problem}")));
        }
        lines
    }

    /// One step, with what goes with the machine. Says how the scenario ended, if it did in this step.
    fn step(&mut self) -> Option<String> {
        let Self { machine, steps, recording, trace, operator, .. } = self;
        let was_at_work = operator.as_ref().is_some_and(|operator| *operator.state() == State::Acting);
        if was_at_work && let Some(operator) = operator {
            let queued = machine.queued().len();
            for note in operator.act(machine) {
                if let Some((trace, _)) = trace {
                    trace.note(machine.cycle() + 1, note.clone());
                }
                if let Some(recording) = recording {
                    recording.note(&note);
                }
            }
            if let Some(recording) = recording {
                recording.remark(queued, "the scenario".to_owned());
            }
        }
        if let Some(recording) = recording {
            recording.edge(machine);
        }
        machine.step();
        *steps += 1;
        if let Some((trace, _)) = trace {
            trace.extend(machine.recorder());
            trace.note_values(machine.cycle(), machine.variables());
        }
        if was_at_work && let Some(operator) = operator {
            operator.look(machine);
        }
        machine.drain();
        match operator.as_ref().filter(|_| was_at_work)?.state() {
            State::Acting => None,
            State::Done => Some("the scenario is over, all of it held; serving goes on".to_owned()),
            State::Failed(failure) => Some(format!("the scenario failed, serving goes on: {failure}")),
        }
    }
}

impl Live {
    /// Starts a machine. The clock of its CPU begins with the computer's, in UTC.
    #[must_use]
    pub fn start(machine: Machine, speed: Speed) -> Self {
        Self::start_with(machine, speed, LiveOptions::default())
    }

    /// Starts a machine with what goes with it.
    #[must_use]
    pub fn start_with(machine: Machine, speed: Speed, options: LiveOptions) -> Self {
        let (is_held, is_lock_step) = (options.is_held, options.is_lock_step);
        let clocked = Clocked::new(machine, options);
        let shared = Arc::new(Shared {
            view: View::new(clocked.seen()),
            inbox: Inbox::new(),
            is_lock_step,
            is_real_time: speed <= Speed::default(),
            steps: watch::Sender::new(0),
            clocked: Mutex::new(clocked),
            waiting: AtomicUsize::new(0),
            overruns: AtomicU64::new(0),
            worst: AtomicU64::new(0),
            lost: AtomicU64::new(0),
            speed,
            is_held: AtomicBool::new(is_held),
        });
        let (end, ended) = mpsc::channel();
        let stepped = Arc::clone(&shared);
        let thread = std::thread::spawn(move || stepped.run(speed, &ended));
        Self { shared, end: Some(end), thread: Some(thread) }
    }

    /// A machine that is held takes its first step; its schedule begins now.
    pub fn begin(&self) {
        self.shared.begin();
    }

    /// Whether it takes no step yet.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.shared.is_held()
    }

    /// The step that is being taken is the last one.
    pub(crate) fn finish(&self) {
        if let Some(end) = &self.end {
            let _ = end.send(());
        }
    }

    /// Looks at the machine between two steps, or queues commands.
    pub fn with<T>(&self, look: impl FnOnce(&mut Machine) -> T) -> T {
        look(&mut self.shared.lend().machine)
    }

    /// The same if it can be had soon: a scan in lock-step may wait for long.
    pub(crate) fn with_soon<T>(&self, look: impl FnOnce(&Clocked) -> T) -> Option<T> {
        self.shared.lend_soon().map(|lent| look(&lent))
    }

    /// How far the scenario is that acts on it, if one does.
    #[must_use]
    pub fn scenario(&self) -> Option<State> {
        self.shared.lend().operator.as_ref().map(|operator| operator.state().clone())
    }

    /// How long a cycle takes at its speed, by the clock of the computer.
    #[must_use]
    pub fn cycle(&self) -> Duration {
        let nanos = self.with(|machine| machine.cycle_time().nanos());
        self.shared.speed.real(u128::try_from(nanos).unwrap_or(1))
    }

    /// How well the schedule was kept so far.
    #[must_use]
    pub fn pace(&self) -> Pace {
        self.shared.pace()
    }

    /// Whether it still runs; only a defect of the simulator ends it otherwise than by dropping it.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.thread.as_ref().is_some_and(|thread| !thread.is_finished())
    }

    /// Ends it; gives what was kept. Nothing where somebody else still looks at it: windows close before.
    #[must_use]
    pub fn end(mut self) -> Option<Ended> {
        self.stop();
        let shared = Arc::clone(&self.shared);
        drop(self);
        let clocked = Arc::into_inner(shared)?.clocked.into_inner().unwrap_or_else(PoisonError::into_inner);
        let Clocked { machine, trace, .. } = clocked;
        Some(Ended { machine, trace })
    }

    fn stop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
            let left = self.shared.inbox.count();
            if left > 0 {
                tracing::warn!("no step came any more for what clients wrote last: {left} requests");
            }
        }
        // Its file is whole before anybody looks at it.
        drop(self.shared.lend().recording.take());
    }

    pub(crate) fn shared(&self) -> Arc<Shared> {
        Arc::clone(&self.shared)
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.stop();
    }
}

impl Shared {
    /// How well the schedule was kept so far.
    pub(crate) fn pace(&self) -> Pace {
        let nanos = |counter: &AtomicU64| Duration::from_nanos(counter.load(Ordering::Relaxed));
        let Self { overruns, worst, lost, .. } = self;
        Pace { overruns: overruns.load(Ordering::Relaxed), worst: nanos(worst), lost: nanos(lost) }
    }

    pub(crate) fn begin(&self) {
        self.is_held.store(false, Ordering::Release);
    }

    pub(crate) fn is_held(&self) -> bool {
        self.is_held.load(Ordering::Acquire)
    }

    /// How many times real time is wanted.
    pub(crate) fn speed(&self) -> Speed {
        self.speed
    }

    /// The machine between two steps.
    pub(crate) fn lend(&self) -> MutexGuard<'_, Clocked> {
        // A step is over sooner than the system puts a thread to sleep and wakes it.
        for _ in 0..PATIENCE {
            match self.clocked.try_lock() {
                Ok(lent) => return lent,
                Err(TryLockError::Poisoned(lent)) => return lent.into_inner(),
                Err(TryLockError::WouldBlock) => std::thread::yield_now(),
            }
        }
        self.waiting.fetch_add(1, Ordering::Relaxed);
        let lent = self.clocked.lock().unwrap_or_else(PoisonError::into_inner);
        self.waiting.fetch_sub(1, Ordering::Relaxed);
        lent
    }

    /// The machine as it was after its last step.
    pub(crate) fn look<T>(&self, look: impl FnOnce(&Seen) -> T) -> T {
        self.view.look(|| self.lend().seen(), look)
    }

    /// The machine between two steps, or none within some milliseconds.
    fn lend_soon(&self) -> Option<MutexGuard<'_, Clocked>> {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        let lent = (0..SOON).find_map(|_| match self.clocked.try_lock() {
            Ok(lent) => Some(lent),
            Err(TryLockError::Poisoned(lent)) => Some(lent.into_inner()),
            Err(TryLockError::WouldBlock) => {
                std::thread::sleep(Duration::from_micros(250));
                None
            }
        });
        self.waiting.fetch_sub(1, Ordering::Relaxed);
        lent
    }

    fn run(&self, speed: Speed, ended: &mpsc::Receiver<()>) {
        while self.is_held() {
            if ended.recv_timeout(HELD) != Err(RecvTimeoutError::Timeout) {
                return;
            }
        }
        let mut begin = Instant::now();
        let mut simulated = 0_u128; // nanoseconds since then
        let mut alarms = Vec::new();
        let mut urgency = Urgency::new(speed);
        loop {
            let period = self.step(&mut alarms);
            simulated += period;
            let due = begin + speed.real(simulated);
            let ahead = due.saturating_duration_since(Instant::now());
            let is_ended = if ahead.is_zero() {
                ended.try_recv() != Err(TryRecvError::Empty)
            } else {
                ended.recv_timeout(ahead) != Err(RecvTimeoutError::Timeout)
            };
            if is_ended {
                return;
            }
            urgency.note(!ahead.is_zero());
            let late = due.elapsed();
            if late > speed.real(period).max(EXACT) {
                let nanos = u64::try_from(late.as_nanos()).unwrap_or(u64::MAX);
                self.overruns.fetch_add(1, Ordering::Relaxed);
                self.worst.fetch_max(nanos, Ordering::Relaxed);
                if late > GIVE_UP {
                    self.lost.fetch_add(nanos, Ordering::Relaxed);
                    begin += late;
                }
            }
        }
    }

    /// One step; gives the nanoseconds of its cycle.
    fn step(&self, alarms: &mut Vec<RaisedAlarm>) -> u128 {
        for _ in 0..COURTESY {
            if self.waiting.load(Ordering::Relaxed) == 0 {
                break;
            }
            std::thread::yield_now();
        }
        let mut clocked = self.clocked.lock().unwrap_or_else(PoisonError::into_inner);
        let orders = self.inbox.take();
        let refused = clocked.take(orders);
        let over = clocked.step();
        clocked.observe();
        let machine = &clocked.machine;
        let changed = changed_alarms(machine, alarms);
        let (step, period) = (clocked.steps, machine.cycle_time().nanos());
        let is_shown = self.is_lock_step || self.is_real_time && self.view.is_looked_at();
        let shown = is_shown.then(|| clocked.seen());
        drop(clocked);
        self.view.over(step, shown);
        self.steps.send_replace(step);
        // Nobody waits for the machine while a terminal waits for its reader.
        for line in refused.into_iter().chain(changed).chain(over) {
            tracing::info!("{line}");
        }
        u128::try_from(period).unwrap_or(1).max(1)
    }
}

/// What to say of alarms that have come or gone.
fn changed_alarms(machine: &Machine, known: &mut Vec<RaisedAlarm>) -> Vec<String> {
    let pending = &machine.variables().alarms;
    if pending.iter().eq(known.iter()) {
        return Vec::new();
    }
    let said =
        |alarm: &RaisedAlarm| format!("alarm {} {}", machine.alarm_name(alarm.number), machine.alarm_text(alarm));
    let come = pending.iter().filter(|alarm| !known.contains(alarm)).map(said);
    let gone = known.iter().filter(|known| !pending.iter().any(|alarm| alarm == *known));
    let changed = come.chain(gone.map(|alarm| format!("gone: {}", said(alarm)))).collect();
    known.clear();
    known.extend(pending.iter().copied());
    changed
}

/// The clock so long after it was set.
fn clock(set: DateAndTime, since: Time) -> DateAndTime {
    set.later(u64::try_from(since.nanos() / 1_000_000).unwrap_or(0))
}

/// The computer's clock in UTC.
fn today() -> DateAndTime {
    /// From 1970 to 1990.
    const EARLIER: Duration = Duration::from_secs(7305 * 86_400);
    let since = SystemTime::now().duration_since(UNIX_EPOCH + EARLIER).unwrap_or_default();
    DateAndTime::FIRST.later(u64::try_from(since.as_millis()).unwrap_or(0))
}
