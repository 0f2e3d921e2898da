//! A machine in real time: a thread steps it when its cycle is due. Clients do not take the lock of the machine: they read a copy of the
//! last step (`seen.rs`), and their orders wait for the start of the next step (`inbox.rs`).
//!
//! The schedule is absolute: cycle n is due n cycles after the start, so delays do not accumulate. A cycle that begins after the next one
//! was due is an overrun, and the thread catches up at once. Delays of more than [`GIVE_UP`] are skipped: a computer that was asleep does
//! not catch up.

use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError, TryRecvError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::clocked::{Clocked, Kept};
use super::following::Collected;
use super::handle::Handle;
use super::history::History;
use super::record::Recording;
use super::shared::{Pace, Return, Shared};
use super::speed::Speed;
use super::urgency::Urgency;
use crate::machine::Machine;
use crate::scenario::{Operator, State, Transcript};
use crate::trace::{Trace, Watch};
use crate::variables::{Describe, RaisedAlarm};

/// The delay above which the lost time is skipped.
pub const GIVE_UP: Duration = Duration::from_millis(500);
/// The most bytes of memory for a trace, unless the options say otherwise.
const TRACE_BYTES: usize = 1 << 30;
/// The accuracy with which a computer wakes a thread.
const EXACT: Duration = Duration::from_millis(1);
/// Polling interval of a machine that is held.
const HELD: Duration = Duration::from_millis(1);
/// The longest pause between two steps without a look at the speed.
const LOOK: Duration = Duration::from_millis(20);

/// A machine that runs in real time until it is dropped. Servers connect through its [`handle`](Live::handle) and end before it.
#[derive(Debug)]
pub struct Live {
    shared: Arc<Shared>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// The options of a live machine.
#[derive(Debug, Default)]
pub struct LiveOptions {
    /// Records the changes made to it.
    pub recording: Option<Recording>,
    /// Keeps the trace in memory, with this content.
    pub trace: Option<Watch>,
    /// The most bytes of memory for the trace, which ends there with a note; default 1 GiB.
    pub trace_bytes: Option<usize>,
    /// A scenario that runs on a machine that has not run yet.
    pub operator: Option<Operator>,
    /// The machine shows its state after power on, and takes its first step only after [`Live::begin`].
    pub is_held: bool,
    /// Its scans may wait for a process: each step is shown to clients before the next one waits.
    pub is_lock_step: bool,
    /// Keeps the last minutes, so that the machine can go back in time.
    pub keeps_history: bool,
    /// Everything since power on as a scenario; it grows with the history.
    pub transcript: Option<Transcript>,
}

/// The result of a machine that has ended.
#[derive(Debug)]
pub struct Ended {
    /// The machine.
    pub machine: Machine,
    /// Its trace and the content of that trace, if it was kept.
    pub trace: Option<(Trace, Watch)>,
}

impl Ended {
    /// The trace as JSON lines, if it was kept.
    #[must_use]
    pub fn json_lines(&self) -> Option<String> {
        self.trace.as_ref().map(|(trace, watch)| trace.json_lines(&self.machine, watch))
    }
}

impl Live {
    /// Starts a machine. The clock of its CPU is set to the computer's clock, in UTC.
    #[must_use]
    pub fn start(machine: Machine, speed: Speed) -> Self {
        Self::start_with(machine, speed, LiveOptions::default())
    }

    /// Starts a machine with options.
    #[must_use]
    pub fn start_with(machine: Machine, speed: Speed, options: LiveOptions) -> Self {
        let LiveOptions { recording, trace, trace_bytes, operator, is_held, is_lock_step, .. } = options;
        let trace = trace.map(|watch| Kept { watch, bytes: trace_bytes.unwrap_or(TRACE_BYTES) });
        let mut clocked = Clocked::new(machine, recording, trace, operator);
        if options.keeps_history {
            clocked.history = Some(History::new(options.transcript));
            // A server that follows begins a moment later, and is to have the first steps as well.
            clocked.collected = Some(Collected::new(&clocked.machine));
        }
        let shared = Arc::new(Shared::new(clocked, speed, is_held, is_lock_step));
        let (end, ended) = mpsc::channel();
        let stepped = Arc::clone(&shared);
        let thread = std::thread::spawn(move || run(&stepped, &ended));
        Self { shared, end: Some(end), thread: Some(thread) }
    }

    /// The handle with which servers connect.
    #[must_use]
    pub fn handle(&self) -> Handle {
        Handle::new(self.shared())
    }

    /// Lets a machine that is held take its first step. Its schedule begins now.
    pub fn begin(&self) {
        self.shared.begin();
    }

    /// Whether it takes no steps yet.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.shared.is_held()
    }

    /// Makes the current step the last one.
    pub fn finish(&self) {
        if let Some(end) = &self.end {
            let _ = end.send(());
        }
    }

    /// Reads the machine between two steps, or queues commands.
    pub fn with<T>(&self, look: impl FnOnce(&mut Machine) -> T) -> T {
        look(&mut self.shared.lend().machine)
    }

    /// Reads the machine and the scenario that runs on it, if they are free within some milliseconds: a scan in lock-step may wait for
    /// long.
    pub fn with_soon<T>(&self, look: impl FnOnce(&Machine, Option<&State>) -> T) -> Option<T> {
        self.shared.lend_soon().map(|lent| look(&lent.machine, lent.operator.as_ref().map(Operator::state)))
    }

    /// The state of the scenario that runs on it, if there is one.
    #[must_use]
    pub fn scenario(&self) -> Option<State> {
        self.shared.lend().operator.as_ref().map(|operator| operator.state().clone())
    }

    /// The duration of a cycle at its speed, by the clock of the computer.
    #[must_use]
    pub fn cycle(&self) -> Duration {
        let nanos = self.with(|machine| machine.cycle_time().nanos());
        self.shared.speed().real(u128::try_from(nanos).unwrap_or(1))
    }

    /// How well the schedule has been kept so far.
    #[must_use]
    pub fn pace(&self) -> Pace {
        self.shared.pace()
    }

    /// Whether it still runs. Before it is dropped, only a bug in the simulator ends it.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.thread.as_ref().is_some_and(|thread| !thread.is_finished())
    }

    /// Ends it and returns the result. Returns `None` if a server still holds a handle: servers must end first.
    #[must_use]
    pub fn end(mut self) -> Option<Ended> {
        self.stop();
        let shared = Arc::clone(&self.shared);
        drop(self);
        let (machine, trace) = Arc::into_inner(shared)?.into_clocked().into_parts();
        Some(Ended { machine, trace })
    }

    fn stop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
            let left = self.shared.inbox.count();
            if left > 0 {
                tracing::warn!("{left} requests of clients were still queued at shutdown and were not executed");
            }
        }
        // Closes the file of the recording, so that it is complete for its first reader.
        drop(self.shared.lend().recording.take());
    }

    pub(super) fn shared(&self) -> Arc<Shared> {
        Arc::clone(&self.shared)
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Marks the end for all waiting threads, also if a step panics.
struct End<'a>(&'a Shared);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.end();
    }
}

/// Steps a machine until the end.
fn run(shared: &Shared, ended: &mpsc::Receiver<()>) {
    let _end = End(shared);
    while shared.is_held() {
        if ended.recv_timeout(HELD) != Err(RecvTimeoutError::Timeout) {
            return;
        }
    }
    let driving = &shared.driving;
    let (mut speed, mut changes) = (driving.speed(), driving.changes());
    let mut begin = Instant::now();
    let mut simulated = 0_u128; // nanoseconds since then
    let mut alarms = Vec::new();
    let mut urgency = Urgency::new(speed);
    loop {
        if let Some(asked) = shared.take_return() {
            go_back(shared, asked);
        }
        if !driving.may_step() {
            shared.hand_over_at_rest();
            if ended.recv_timeout(HELD) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            continue;
        }
        if driving.changes() != changes {
            (speed, changes) = (driving.speed(), driving.changes());
            (begin, simulated) = (Instant::now(), 0);
        }
        let period = step(shared, &mut alarms);
        driving.stepped();
        if driving.is_paused() {
            // Single steps have no schedule.
            continue;
        }
        simulated += period;
        let due = begin + speed.real(simulated);
        let ahead = due.saturating_duration_since(Instant::now());
        if waits_in_vain(due, ended, || driving.changes() != changes) {
            return;
        }
        urgency.note(!ahead.is_zero());
        let late = due.elapsed();
        if late > speed.real(period).max(EXACT) {
            let is_given_up = late > GIVE_UP;
            shared.overrun(late, is_given_up);
            if is_given_up {
                begin += late;
            }
        }
    }
}

/// Waits until a step is due, or the speed changes. Returns whether the machine ends.
fn waits_in_vain(due: Instant, ended: &mpsc::Receiver<()>, is_changed: impl Fn() -> bool) -> bool {
    loop {
        let ahead = due.saturating_duration_since(Instant::now());
        if ahead.is_zero() {
            return ended.try_recv() != Err(TryRecvError::Empty);
        }
        if ended.recv_timeout(ahead.min(LOOK)) != Err(RecvTimeoutError::Timeout) {
            return true;
        }
        if is_changed() {
            return false;
        }
    }
}

/// Goes back in time instead of taking a step, and pauses there. A machine that cannot go back goes on.
fn go_back(shared: &Shared, asked: Return) {
    let mut clocked = shared.lend_for_a_step();
    let orders = shared.inbox.take();
    let went = clocked.go_back(asked.cycle);
    if went.is_ok() {
        shared.driving.pause(true);
    }
    let refused = clocked.take(orders);
    shared.give_back(clocked);
    for line in refused {
        tracing::info!("{line}");
    }
    let _ = asked.answer.send(went);
}

/// Takes one step; returns the nanoseconds of its cycle.
fn step(shared: &Shared, alarms: &mut Vec<RaisedAlarm>) -> u128 {
    let mut clocked = shared.lend_for_a_step();
    let before = clocked.machine.time();
    let refused = clocked.take(shared.inbox.take());
    let over = clocked.step();
    clocked.observe();
    let changed = changed_alarms(&clocked.machine, alarms);
    let period = (clocked.machine.time() - before).nanos();
    shared.give_back(clocked);
    // Log after releasing the machine: a blocked terminal must not hold up a step.
    for line in refused.into_iter().chain(changed).chain(over) {
        tracing::info!("{line}");
    }
    u128::try_from(period).unwrap_or(1).max(1)
}

/// A log line for each alarm that was raised or cancelled.
fn changed_alarms(machine: &Machine, known: &mut Vec<RaisedAlarm>) -> Vec<String> {
    let pending = &machine.variables().alarms;
    if pending.iter().eq(known.iter()) {
        return Vec::new();
    }
    let said =
        |alarm: &RaisedAlarm| format!("alarm {} {}", machine.alarm_name(alarm.number), machine.alarm_text(alarm));
    let come = pending.iter().filter(|alarm| !known.contains(alarm)).map(said);
    let gone = known.iter().filter(|known| !pending.iter().any(|alarm| alarm == *known));
    let changed = come.chain(gone.map(|alarm| format!("cancelled: {}", said(alarm)))).collect();
    known.clear();
    known.extend(pending.iter().copied());
    changed
}
