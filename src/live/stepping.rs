//! A machine in real time: a thread that steps it when its cycle is due. Clients do not take the lock of the machine: they see a copy of
//! the last step (`seen.rs`), and their orders wait for the edge of the next (`inbox.rs`).
//!
//! The schedule is absolute: cycle n is due n cycles after the start, so delays do not add up. A cycle that begins later than the
//! next one was due is an overrun and is made up for at once. A delay of more than [`GIVE_UP`] is not made up for: a computer that
//! slept does not rush.

use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError, TryRecvError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::clocked::Clocked;
use super::handle::Handle;
use super::record::Recording;
use super::shared::{Pace, Shared};
use super::speed::Speed;
use super::urgency::Urgency;
use crate::machine::Machine;
use crate::scenario::{Operator, State};
use crate::trace::{Trace, Watch};
use crate::variables::{Describe, RaisedAlarm};

/// Later than this, and the time is lost.
pub const GIVE_UP: Duration = Duration::from_millis(500);
/// A computer wakes nobody more exactly than this.
const EXACT: Duration = Duration::from_millis(1);
/// How often a machine that is held looks whether it may begin.
const HELD: Duration = Duration::from_millis(1);

/// A machine that runs in real time until it is dropped. Servers plug in by its [`handle`](Live::handle) and end before it.
#[derive(Debug)]
pub struct Live {
    shared: Arc<Shared>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
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

impl Live {
    /// Starts a machine. The clock of its CPU begins with the computer's, in UTC.
    #[must_use]
    pub fn start(machine: Machine, speed: Speed) -> Self {
        Self::start_with(machine, speed, LiveOptions::default())
    }

    /// Starts a machine with what goes with it.
    #[must_use]
    pub fn start_with(machine: Machine, speed: Speed, options: LiveOptions) -> Self {
        let LiveOptions { recording, trace, operator, is_held, is_lock_step } = options;
        let clocked = Clocked::new(machine, recording, trace, operator);
        let shared = Arc::new(Shared::new(clocked, speed, is_held, is_lock_step));
        let (end, ended) = mpsc::channel();
        let stepped = Arc::clone(&shared);
        let thread = std::thread::spawn(move || run(&stepped, speed, &ended));
        Self { shared, end: Some(end), thread: Some(thread) }
    }

    /// What a server plugs into.
    #[must_use]
    pub fn handle(&self) -> Handle {
        Handle::new(self.shared())
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
    pub fn finish(&self) {
        if let Some(end) = &self.end {
            let _ = end.send(());
        }
    }

    /// Looks at the machine between two steps, or queues commands.
    pub fn with<T>(&self, look: impl FnOnce(&mut Machine) -> T) -> T {
        look(&mut self.shared.lend().machine)
    }

    /// Looks at the machine and at the scenario that acts on it, if they can be had within some milliseconds: a scan in lock-step may wait
    /// for long.
    pub fn with_soon<T>(&self, look: impl FnOnce(&Machine, Option<&State>) -> T) -> Option<T> {
        self.shared.lend_soon().map(|lent| look(&lent.machine, lent.operator.as_ref().map(Operator::state)))
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
        self.shared.speed().real(u128::try_from(nanos).unwrap_or(1))
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

    /// Ends it; gives what was kept. Nothing where a server still holds a handle: servers end before.
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
                tracing::warn!("no step came any more for what clients wrote last: {left} requests");
            }
        }
        // Its file is whole before anybody looks at it.
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

/// Tells everybody that no step follows, also where a step ends by a defect.
struct End<'a>(&'a Shared);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.end();
    }
}

/// Steps a machine until the end.
fn run(shared: &Shared, speed: Speed, ended: &mpsc::Receiver<()>) {
    let _end = End(shared);
    while shared.is_held() {
        if ended.recv_timeout(HELD) != Err(RecvTimeoutError::Timeout) {
            return;
        }
    }
    let mut begin = Instant::now();
    let mut simulated = 0_u128; // nanoseconds since then
    let mut alarms = Vec::new();
    let mut urgency = Urgency::new(speed);
    loop {
        let period = step(shared, &mut alarms);
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
            let is_given_up = late > GIVE_UP;
            shared.overrun(late, is_given_up);
            if is_given_up {
                begin += late;
            }
        }
    }
}

/// One step; gives the nanoseconds of its cycle.
fn step(shared: &Shared, alarms: &mut Vec<RaisedAlarm>) -> u128 {
    let mut clocked = shared.lend_for_a_step();
    let refused = clocked.take(shared.inbox.take());
    let over = clocked.step();
    clocked.observe();
    let changed = changed_alarms(&clocked.machine, alarms);
    let period = clocked.machine.cycle_time().nanos();
    shared.give_back(clocked);
    // Nobody waits for the machine while a terminal waits for its reader.
    for line in refused.into_iter().chain(changed).chain(over) {
        tracing::info!("{line}");
    }
    u128::try_from(period).unwrap_or(1).max(1)
}

/// A line for each alarm that has come or gone.
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
