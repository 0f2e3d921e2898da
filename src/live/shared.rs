//! What the stepping thread and everybody else share: the machine behind its lock, the copy of its last step, the inbox, and how well
//! the schedule is kept.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

use tokio::sync::watch;

use super::clocked::Clocked;
use super::inbox::Inbox;
use super::seen::{Seen, View};
use super::speed::Speed;

/// How often the lock is tried by a caller that does not wait for it.
const SOON: u32 = 40;
/// How often the stepping thread lets others go first, at most.
const COURTESY: u32 = 100;
/// How often a caller that wants the machine lets others go first before it waits in a queue.
const PATIENCE: u32 = 20;

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
pub(super) struct Shared {
    clocked: Mutex<Clocked>,
    /// What clients see of it.
    view: View,
    /// What clients asked for.
    pub(super) inbox: Inbox,
    /// A scan may wait for a process: each step is shown before it does.
    is_lock_step: bool,
    /// A step is shown while somebody looks; faster, few of so many are looked at, and each is copied by the client that looks.
    is_real_time: bool,
    /// How many wait for the lock.
    waiting: AtomicUsize,
    /// How many steps are over.
    steps: watch::Sender<u64>,
    overruns: AtomicU64,
    worst: AtomicU64,
    lost: AtomicU64,
    speed: Speed,
    /// It takes no step yet.
    is_held: AtomicBool,
    /// It takes no step any more.
    has_ended: AtomicBool,
}

impl Shared {
    pub(super) fn new(clocked: Clocked, speed: Speed, is_held: bool, is_lock_step: bool) -> Self {
        Self {
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
            has_ended: AtomicBool::new(false),
        }
    }

    /// The machine with what goes with it, when nobody shares it any more.
    pub(super) fn into_clocked(self) -> Clocked {
        self.clocked.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// How well the schedule was kept so far.
    pub(super) fn pace(&self) -> Pace {
        let nanos = |counter: &AtomicU64| Duration::from_nanos(counter.load(Ordering::Relaxed));
        let Self { overruns, worst, lost, .. } = self;
        Pace { overruns: overruns.load(Ordering::Relaxed), worst: nanos(worst), lost: nanos(lost) }
    }

    /// A cycle began too late.
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

    /// How many times real time is wanted.
    pub(super) fn speed(&self) -> Speed {
        self.speed
    }

    /// The machine between two steps.
    pub(super) fn lend(&self) -> MutexGuard<'_, Clocked> {
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

    /// The machine between two steps, or none within some milliseconds.
    pub(super) fn lend_soon(&self) -> Option<MutexGuard<'_, Clocked>> {
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

    /// The machine for its next step, after those that wait for it.
    pub(super) fn lend_for_a_step(&self) -> MutexGuard<'_, Clocked> {
        for _ in 0..COURTESY {
            if self.waiting.load(Ordering::Relaxed) == 0 {
                break;
            }
            std::thread::yield_now();
        }
        self.clocked.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The machine as it was after its last step.
    pub(super) fn look<T>(&self, look: impl FnOnce(&Seen) -> T) -> T {
        self.view.look(|| self.lend().seen(), look)
    }

    /// A step is over: gives the machine back, and shows the step to those who look.
    pub(super) fn give_back(&self, clocked: MutexGuard<'_, Clocked>) {
        let is_shown = self.is_lock_step || self.is_real_time && self.view.is_looked_at();
        let (step, shown) = (clocked.steps(), is_shown.then(|| clocked.seen()));
        drop(clocked);
        self.view.over(step, shown);
        self.steps.send_replace(step);
    }

    /// Waits until a step is over; whether it ever is.
    pub(super) async fn over(&self, step: u64) -> bool {
        let mut steps = self.steps.subscribe();
        let _ = steps.wait_for(|steps| *steps >= step || self.has_ended()).await;
        *self.steps.borrow() >= step
    }

    /// No step follows.
    pub(super) fn end(&self) {
        self.has_ended.store(true, Ordering::Release);
        self.steps.send_modify(|_| {});
    }

    pub(super) fn has_ended(&self) -> bool {
        self.has_ended.load(Ordering::Acquire)
    }
}
