//! What clients see: the machine as it was after its last step, apart from the one that goes on.
//!
//! Whoever looks holds up nobody: neither the step that is due, nor, where a step lasts (a scan that waits for a PLC process), those
//! who look as well. A step is copied once, some microseconds, however many look at it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::machine::Snapshot;
use crate::s7::{DateAndTime, Diagnosis};

/// A machine after a step, with the clock of its CPU and what its diagnostic buffer held.
#[derive(Debug)]
pub(super) struct Seen {
    pub(super) machine: Snapshot,
    pub(super) clock: DateAndTime,
    pub(super) diagnosis: Vec<Diagnosis>,
}

/// The last step, for everybody who looks.
#[derive(Debug)]
pub(super) struct View {
    /// How many cycles are over.
    cycle: AtomicU64,
    /// Somebody has looked since a step was shown.
    is_looked_at: AtomicBool,
    /// What the stepping thread shows, if it does; nobody holds this lock for longer than it takes to put something there.
    fresh: Mutex<Option<Box<Seen>>>,
    seen: Mutex<Box<Seen>>,
}

impl View {
    pub(super) fn new(seen: Box<Seen>) -> Self {
        let is_looked_at = AtomicBool::new(false);
        Self {
            cycle: AtomicU64::new(seen.machine.cycle()),
            is_looked_at,
            fresh: Mutex::new(None),
            seen: Mutex::new(seen),
        }
    }

    /// Whether somebody has looked since this was asked last: most probably somebody will again.
    pub(super) fn is_looked_at(&self) -> bool {
        self.is_looked_at.swap(false, Ordering::Relaxed)
    }

    /// A cycle is over; whoever looks from now on sees what it left.
    pub(super) fn over(&self, cycle: u64, shown: Option<Box<Seen>>) {
        let before = shown.and_then(|shown| lock(&self.fresh).replace(shown));
        self.cycle.store(cycle, Ordering::Release);
        drop(before);
    }

    /// Looks at the last step; `copy` gives it where nobody has shown it.
    pub(super) fn look<T>(&self, copy: impl FnOnce() -> Box<Seen>, look: impl FnOnce(&Seen) -> T) -> T {
        self.is_looked_at.store(true, Ordering::Relaxed);
        let mut seen = lock(&self.seen);
        if seen.machine.cycle() < self.cycle.load(Ordering::Acquire) {
            let shown = lock(&self.fresh).take();
            *seen =
                shown.filter(|shown| shown.machine.cycle() >= self.cycle.load(Ordering::Acquire)).unwrap_or_else(copy);
        }
        look(&seen)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
