//! Everything that happens, for a server that follows the machine: the record of all steps since it last asked, and the machine after the
//! last of them. The stepping thread collects the record and hands it over at the end of a step; it never waits for the server. If nobody
//! asks for long, the record is dropped, and the next one begins anew.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use tokio::sync::Notify;

use super::seen::Seen;
use crate::machine::Machine;
use crate::scenario::program_rows;
use crate::trace::Trace;
use crate::units::Time;

/// The most bytes of a record that nobody asks for.
const MOST: usize = 4 << 20;

/// The record of some steps, and the machine after them.
#[derive(Debug)]
pub struct Batch {
    /// What happened, with the notes of the scenario.
    pub trace: Trace,
    /// The time of the machine at the time zero of the trace.
    pub begin: Time,
    /// The machine after the last step.
    pub seen: Box<Seen>,
    /// The trace does not continue the one before: changes were lost, or the machine went back in time.
    pub is_new: bool,
}

/// Collects the record of a followed machine.
#[derive(Debug)]
pub(super) struct Collected {
    trace: Trace,
    begin: Time,
    is_new: bool,
    /// Something was not handed over yet.
    has_news: bool,
}

impl Collected {
    pub(super) fn new(machine: &Machine) -> Self {
        let begin = machine.time();
        let trace = Trace::begin(machine.memory(), machine.cycle_time(), machine.cycle(), begin);
        Self { trace, begin, is_new: true, has_news: true }
    }

    pub(super) fn has_news(&self) -> bool {
        self.has_news
    }

    /// A note that belongs to the next step.
    pub(super) fn note(&mut self, machine: &Machine, text: &str) {
        self.trace.note(machine.cycle() + 1, text);
    }

    /// Takes over the record of a step, before it is drained.
    pub(super) fn extend(&mut self, machine: &Machine) {
        self.trace.extend(machine.recorder());
        self.trace.extend_causes(machine.cycle(), program_rows(machine));
        self.trace.note_fault(machine.recorder(), machine.program_fault());
        self.trace.end_cycle(machine.cycle(), machine.time(), machine.variables());
        self.has_news = true;
        if self.trace.bytes() > MOST {
            *self = Self::new(machine);
        }
    }

    /// Hands over what is collected, and begins to collect what follows.
    pub(super) fn hand_over(&mut self, machine: &Machine, seen: Box<Seen>) -> Batch {
        self.has_news = false;
        let begin = machine.time();
        let next = self.trace.continued(machine.memory(), machine.cycle_time(), machine.cycle(), begin);
        let trace = std::mem::replace(&mut self.trace, next);
        let begin = std::mem::replace(&mut self.begin, begin);
        Batch { trace, begin, seen, is_new: std::mem::take(&mut self.is_new) }
    }
}

/// Where a record is handed over.
#[derive(Debug, Default)]
pub(super) struct Counter {
    is_asked: AtomicBool,
    batch: Mutex<Option<Batch>>,
    arrived: Notify,
}

impl Counter {
    pub(super) fn is_asked(&self) -> bool {
        self.is_asked.load(Ordering::Acquire)
    }

    pub(super) fn put(&self, batch: Batch) {
        // Both change under the lock: while more is asked for, no batch lies here that the next one would replace.
        let mut place = self.batch.lock().unwrap_or_else(PoisonError::into_inner);
        *place = Some(batch);
        self.is_asked.store(false, Ordering::Release);
        drop(place);
        self.arrived.notify_one();
    }

    /// What was handed over; asks for more if there is nothing.
    pub(super) fn take(&self) -> Option<Batch> {
        let mut place = self.batch.lock().unwrap_or_else(PoisonError::into_inner);
        let batch = place.take();
        if batch.is_none() {
            self.is_asked.store(true, Ordering::Release);
        }
        drop(place);
        batch
    }

    /// Waits until something is handed over.
    pub(super) async fn arrived(&self) {
        self.arrived.notified().await;
    }
}
