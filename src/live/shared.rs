//! The data shared between the stepping thread and all other threads: the machine behind its lock, the copy of its last step, the inbox,
//! and the statistics of the schedule.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, SystemTime};

use tokio::sync::{oneshot, watch};

use super::clocked::Clocked;
use super::driving::Driving;
use super::following::Counter;
use super::inbox::Inbox;
use super::seen::{Seen, View};
use super::speed::Speed;
use super::steps::Readers;
use crate::source::Problem;

/// How often a caller that does not wait tries the lock.
const TRIES: u32 = 40;
/// How often, at most, the stepping thread lets other threads take the lock first.
const YIELDS_BEFORE_A_STEP: u32 = 100;
/// How often a caller yields before it blocks on the lock.
const YIELDS_BEFORE_BLOCKING: u32 = 20;

/// How well the schedule was kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pace {
    /// Cycles that began after the next one was already due.
    pub overruns: u64,
    /// The largest delay.
    pub worst: Duration,
    /// Time that was skipped.
    pub lost: Duration,
}

/// A request to go back to the end of a cycle.
#[derive(Debug)]
pub(super) struct Return {
    pub(super) cycle: u64,
    pub(super) answer: oneshot::Sender<Result<(), Problem>>,
}

/// The data shared between the stepping thread and all other threads.
#[derive(Debug)]
pub(super) struct Shared {
    clocked: Mutex<Clocked>,
    /// The state that clients see.
    view: View,
    /// The orders of clients.
    pub(super) inbox: Inbox,
    /// A scan may wait for a process, so each step is copied before the next one begins.
    is_lock_step: bool,
    /// The number of threads that wait for the lock.
    waiting: AtomicUsize,
    /// The number of completed steps.
    steps: watch::Sender<u64>,
    overruns: AtomicU64,
    worst: AtomicU64,
    lost: AtomicU64,
    /// Its speed, and whether it pauses.
    pub(super) driving: Driving,
    /// The servers that need every step.
    pub(super) readers: Arc<Readers>,
    /// Where its record is handed over.
    pub(super) counter: Counter,
    /// The request to go back in time.
    return_asked: Mutex<Option<Return>>,
    is_return_asked: AtomicBool,
    /// It takes no steps yet.
    is_held: AtomicBool,
    /// It takes no more steps.
    has_ended: AtomicBool,
}

impl Shared {
    pub(super) fn new(clocked: Clocked, speed: Speed, is_held: bool, is_lock_step: bool) -> Self {
        Self {
            view: View::new(clocked.seen()),
            inbox: Inbox::new(),
            is_lock_step,
            steps: watch::Sender::new(0),
            clocked: Mutex::new(clocked),
            waiting: AtomicUsize::new(0),
            overruns: AtomicU64::new(0),
            worst: AtomicU64::new(0),
            lost: AtomicU64::new(0),
            driving: Driving::new(speed),
            readers: Arc::default(),
            counter: Counter::default(),
            return_asked: Mutex::new(None),
            is_return_asked: AtomicBool::new(false),
            is_held: AtomicBool::new(is_held),
            has_ended: AtomicBool::new(false),
        }
    }

    /// The machine, when no other thread shares it any more.
    pub(super) fn into_clocked(self) -> Clocked {
        self.clocked.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// How well the schedule has been kept so far.
    pub(super) fn pace(&self) -> Pace {
        let nanos = |counter: &AtomicU64| Duration::from_nanos(counter.load(Ordering::Relaxed));
        let Self { overruns, worst, lost, .. } = self;
        Pace { overruns: overruns.load(Ordering::Relaxed), worst: nanos(worst), lost: nanos(lost) }
    }

    /// Counts a cycle that began too late.
    pub(super) fn overrun(&self, late: Duration, is_given_up: bool) {
        let nanos = u64::try_from(late.as_nanos()).unwrap_or(u64::MAX);
        self.overruns.fetch_add(1, Ordering::Relaxed);
        self.worst.fetch_max(nanos, Ordering::Relaxed);
        if is_given_up {
            self.lost.fetch_add(nanos, Ordering::Relaxed);
        }
    }

    pub(super) fn begin(&self) {
        self.is_held.store(false, Ordering::Release);
    }

    pub(super) fn is_held(&self) -> bool {
        self.is_held.load(Ordering::Acquire)
    }

    /// The requested speed relative to real time.
    pub(super) fn speed(&self) -> Speed {
        self.driving.speed()
    }

    /// Asks the stepping thread to go back in time. A new request replaces one that is still waiting, and the sender of that one gets an error.
    pub(super) fn ask_to_return(&self, asked: Return) {
        *self.return_asked.lock().unwrap_or_else(PoisonError::into_inner) = Some(asked);
        self.is_return_asked.store(true, Ordering::Release);
    }

    /// The request to go back, if there is one; called before each step.
    pub(super) fn take_return(&self) -> Option<Return> {
        if !self.is_return_asked.swap(false, Ordering::AcqRel) {
            return None;
        }
        self.return_asked.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Locks the machine between two steps.
    pub(super) fn lend(&self) -> MutexGuard<'_, Clocked> {
        // A step ends sooner than the system can put a thread to sleep and wake it.
        for _ in 0..YIELDS_BEFORE_BLOCKING {
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

    /// Locks the machine between two steps; `None` if that takes longer than some milliseconds.
    pub(super) fn lend_soon(&self) -> Option<MutexGuard<'_, Clocked>> {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        let lent = (0..TRIES).find_map(|_| match self.clocked.try_lock() {
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

    /// Locks the machine for its next step, after the threads that wait for it.
    pub(super) fn lend_for_a_step(&self) -> MutexGuard<'_, Clocked> {
        for _ in 0..YIELDS_BEFORE_A_STEP {
            if self.waiting.load(Ordering::Relaxed) == 0 {
                break;
            }
            std::thread::yield_now();
        }
        self.clocked.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads the machine as it was after its last step.
    pub(super) fn look<T>(&self, look: impl FnOnce(&Seen) -> T) -> T {
        self.view.look(|| self.lend().seen(), look)
    }

    /// Ends a step: unlocks the machine and shows the step to readers.
    pub(super) fn give_back(&self, mut clocked: MutexGuard<'_, Clocked>) {
        // Above real time few of the steps are read, and the reader copies them.
        let copies = self.readers.listening();
        let read: Vec<_> = (0..copies).map(|_| clocked.seen()).collect();
        let is_shown = self.is_lock_step || self.speed() <= Speed::default() && self.view.is_looked_at();
        let (step, shown) = (clocked.steps(), is_shown.then(|| clocked.seen()));
        self.hand_over(&mut clocked);
        drop(clocked);
        if !read.is_empty() {
            self.readers.put(read, self.speed() == Speed::default(), SystemTime::now());
        }
        self.view.over(step, shown);
        self.steps.send_replace(step);
    }

    /// Hands over what happened, if a server asks for it.
    fn hand_over(&self, clocked: &mut Clocked) {
        if !self.counter.is_asked() || clocked.collected.as_ref().is_none_or(|collected| !collected.has_news()) {
            return;
        }
        let seen = clocked.seen();
        let Clocked { collected, machine, .. } = clocked;
        if let Some(collected) = collected {
            self.counter.put(collected.hand_over(machine, seen));
        }
    }

    /// The same for a machine that takes no step now: it may have taken one while nobody asked.
    pub(super) fn hand_over_at_rest(&self) {
        if self.counter.is_asked() {
            self.hand_over(&mut self.lend());
        }
    }

    /// Waits until a step has ended; returns false if it never will.
    pub(super) async fn over(&self, step: u64) -> bool {
        let mut steps = self.steps.subscribe();
        let _ = steps.wait_for(|steps| *steps >= step || self.has_ended()).await;
        *self.steps.borrow() >= step
    }

    /// Marks the end: no step follows.
    pub(super) fn end(&self) {
        self.has_ended.store(true, Ordering::Release);
        self.steps.send_modify(|_| {});
    }

    pub(super) fn has_ended(&self) -> bool {
        self.has_ended.load(Ordering::Acquire)
    }
}
