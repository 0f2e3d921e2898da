//! What clients see: a copy of the machine as its last step left it, apart from the machine that goes on.
//!
//! Clients that look again and again hold up neither the step that is due nor, where a step lasts (a scan that waits for a PLC process),
//! each other. A step is copied once, which takes some microseconds, however many look at it: by the stepping thread while somebody
//! has looked not long ago, else by the first client that looks, which takes the lock of the machine for that.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use super::diagnosis::Entry;
use crate::machine::{Machine, Snapshot};

/// So many steps are shown after somebody has looked.
const LINGER: u32 = 1000;

/// A machine after a step, with the clock of its CPU and what its diagnostic buffer held. It does not change.
#[derive(Debug)]
pub struct Seen {
    pub(super) step: u64,
    pub(super) machine: Snapshot,
    pub(super) clock: SystemTime,
    pub(super) diagnosis: Arc<[Entry]>,
}

impl Seen {
    /// The number of the step: how many have been taken since the start. All that is seen is of this step.
    /// [`Machine::cycle`] may differ: a machine that is restored counts its cycles anew.
    #[must_use]
    pub fn step(&self) -> u64 {
        self.step
    }

    /// The machine.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The clock of the PLC's CPU, in UTC.
    #[must_use]
    pub fn clock(&self) -> SystemTime {
        self.clock
    }

    /// The diagnostic buffer of the PLC's CPU, newest entry first. It is another allocation only when an entry was added.
    #[must_use]
    pub fn diagnosis(&self) -> &Arc<[Entry]> {
        &self.diagnosis
    }
}

/// The last step, for everybody who looks.
#[derive(Debug)]
pub(super) struct View {
    /// How many steps are over.
    step: AtomicU64,
    /// How many more steps are shown.
    lingers: AtomicU32,
    /// What the stepping thread shows, if it does; nobody holds this lock for longer than it takes to put something there.
    fresh: Mutex<Option<Box<Seen>>>,
    seen: Mutex<Box<Seen>>,
}

impl View {
    pub(super) fn new(seen: Box<Seen>) -> Self {
        let (step, lingers) = (AtomicU64::new(seen.step), AtomicU32::new(0));
        Self { step, lingers, fresh: Mutex::new(None), seen: Mutex::new(seen) }
    }

    /// Whether somebody has looked not long ago; asked once a step.
    pub(super) fn is_looked_at(&self) -> bool {
        let less = |lingers: u32| lingers.checked_sub(1);
        self.lingers.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).is_ok()
    }

    /// A step is over; whoever looks from now on sees what it left.
    pub(super) fn over(&self, step: u64, shown: Option<Box<Seen>>) {
        let before = shown.and_then(|shown| lock(&self.fresh).replace(shown));
        self.step.store(step, Ordering::Release);
        drop(before);
    }

    /// Looks at the last step; `copy` gives it where nobody has shown it.
    pub(super) fn look<T>(&self, copy: impl FnOnce() -> Box<Seen>, look: impl FnOnce(&Seen) -> T) -> T {
        self.lingers.store(LINGER, Ordering::Relaxed);
        let mut seen = lock(&self.seen);
        // Asked once: another step may be over a moment later, and nobody waits for the one behind it.
        let step = self.step.load(Ordering::Acquire);
        if seen.step < step {
            let shown = lock(&self.fresh).take();
            *seen = shown.filter(|shown| shown.step >= step).unwrap_or_else(copy);
        }
        look(&seen)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(step: u64) -> Box<Seen> {
        let machine = Machine::open("g1_example").expect("it is built in").snapshot();
        Box::new(Seen { step, machine, clock: SystemTime::UNIX_EPOCH, diagnosis: Arc::new([]) })
    }

    #[test]
    fn steps_are_shown_for_a_while_after_somebody_has_looked() {
        let view = View::new(seen(0));
        assert!(!view.is_looked_at());
        view.look(|| unreachable!("it is the last step"), |_| ());
        assert_eq!((0..2 * LINGER).filter(|_| view.is_looked_at()).count(), LINGER as usize);
    }

    #[test]
    fn a_step_that_was_shown_is_not_copied_again() {
        let view = View::new(seen(0));
        view.over(1, Some(seen(1)));
        assert_eq!(view.look(|| unreachable!("it was shown"), |seen| seen.step), 1);
        view.over(2, None);
        assert_eq!(view.look(|| seen(2), |seen| seen.step), 2);
        // Who copies meets a machine that is further already.
        view.over(3, None);
        assert_eq!(view.look(|| seen(4), |seen| seen.step), 4);
        view.over(4, Some(seen(4)));
        assert_eq!(view.look(|| unreachable!("it was seen"), |seen| seen.step), 4);
    }
}
