//! The state that clients see: a copy of the machine after its last step, separate from the running machine.
//!
//! Clients that read again and again do not delay the next step. If a step takes long (a scan that waits for a PLC process), they do not
//! delay each other either. Each step is copied at most once, in a few microseconds, for any number of readers: by the stepping thread if a
//! client has read recently, otherwise by the first reader, which takes the lock of the machine.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use super::causes::Causes;
use super::diagnosis::Entry;
use super::history::Reach;
use crate::machine::{Machine, Snapshot};
use crate::scenario::State;
use crate::units::Time;
use crate::variables::RaisedAlarm;

/// The number of steps that are copied after a client has read.
const LINGER: u32 = 1000;

/// A machine after a step, with the clock of its CPU and the content of its diagnostic buffer. It does not change.
#[derive(Debug)]
pub struct Seen {
    pub(super) step: u64,
    pub(super) machine: Snapshot,
    pub(super) clock: SystemTime,
    pub(super) diagnosis: Arc<[Entry]>,
    pub(super) scenario: Option<(State, usize)>,
    pub(super) reach: Option<Result<Reach, Arc<str>>>,
    pub(super) causes: Causes,
}

impl Seen {
    /// The number of the step, counted from the start. Everything in this copy is of this step. [`Machine::cycle`] may differ: a restored
    /// machine counts its cycles anew.
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

    /// The scenario that runs on the machine: its state, and the index of its step. `None` if there is none.
    #[must_use]
    pub fn scenario(&self) -> Option<(&State, usize)> {
        self.scenario.as_ref().map(|(state, index)| (state, *index))
    }

    /// Why a pending alarm was raised: the rule, and the inputs that were tested. `None` if it is not known.
    #[must_use]
    pub fn cause(&self, alarm: &RaisedAlarm) -> Option<&str> {
        self.causes.of(alarm)?.because.as_deref()
    }

    /// When a pending alarm was raised. `None` if it is not known.
    #[must_use]
    pub fn raised_at(&self, alarm: &RaisedAlarm) -> Option<Time> {
        self.causes.of(alarm).map(|raised| raised.time)
    }

    /// The moments to which the machine can go back.
    ///
    /// # Errors
    /// The reason why it cannot: it keeps no history, or cannot be copied.
    pub fn reach(&self) -> Result<Reach, &str> {
        match &self.reach {
            Some(Ok(reach)) => Ok(*reach),
            Some(Err(refusal)) => Err(refusal),
            None => Err("the machine keeps no history"),
        }
    }

    /// The diagnostic buffer of the PLC's CPU, newest entry first. The allocation changes only when an entry is added.
    #[must_use]
    pub fn diagnosis(&self) -> &Arc<[Entry]> {
        &self.diagnosis
    }
}

/// The last step, for all readers.
#[derive(Debug)]
pub(super) struct View {
    /// The number of completed steps.
    step: AtomicU64,
    /// The number of further steps to be copied.
    lingers: AtomicU32,
    /// The copy made by the stepping thread, if any. The lock is held only while the copy is exchanged.
    fresh: Mutex<Option<Box<Seen>>>,
    seen: Mutex<Box<Seen>>,
}

impl View {
    pub(super) fn new(seen: Box<Seen>) -> Self {
        let (step, lingers) = (AtomicU64::new(seen.step), AtomicU32::new(0));
        Self { step, lingers, fresh: Mutex::new(None), seen: Mutex::new(seen) }
    }

    /// Whether a client has read recently; called once per step.
    pub(super) fn is_looked_at(&self) -> bool {
        let less = |lingers: u32| lingers.checked_sub(1);
        self.lingers.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).is_ok()
    }

    /// A step has ended. Readers see its result from now on.
    pub(super) fn over(&self, step: u64, shown: Option<Box<Seen>>) {
        let before = shown.and_then(|shown| lock(&self.fresh).replace(shown));
        self.step.store(step, Ordering::Release);
        drop(before);
    }

    /// Reads the last step; `copy` makes the copy if the stepping thread has not.
    pub(super) fn look<T>(&self, copy: impl FnOnce() -> Box<Seen>, look: impl FnOnce(&Seen) -> T) -> T {
        self.lingers.store(LINGER, Ordering::Relaxed);
        let mut seen = lock(&self.seen);
        // Loaded once: another step may end a moment later, and the reader does not wait for it.
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
        let machine = Machine::open("g1_example").expect("it is a built-in machine").snapshot();
        let (clock, diagnosis) = (SystemTime::UNIX_EPOCH, Arc::new([]));
        Box::new(Seen { step, machine, clock, diagnosis, scenario: None, reach: None, causes: Causes::default() })
    }

    #[test]
    fn steps_are_copied_for_a_while_after_a_read() {
        let view = View::new(seen(0));
        assert!(!view.is_looked_at());
        view.look(|| unreachable!("the copy is of the last step"), |_| ());
        assert_eq!((0..2 * LINGER).filter(|_| view.is_looked_at()).count(), LINGER as usize);
    }

    #[test]
    fn a_step_is_copied_only_once() {
        let view = View::new(seen(0));
        view.over(1, Some(seen(1)));
        assert_eq!(view.look(|| unreachable!("the copy exists already"), |seen| seen.step), 1);
        view.over(2, None);
        assert_eq!(view.look(|| seen(2), |seen| seen.step), 2);
        // The reader that copies may find a machine that has advanced further.
        view.over(3, None);
        assert_eq!(view.look(|| seen(4), |seen| seen.step), 4);
        view.over(4, Some(seen(4)));
        assert_eq!(view.look(|| unreachable!("the copy exists already"), |seen| seen.step), 4);
    }
}
