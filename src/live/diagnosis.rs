//! The diagnostic buffer of the CPU: when its operating state changed, and by whom.

use crate::machine::Machine;
use crate::s7::{DateAndTime, Diagnosis, Restart};

/// The most entries that are kept.
const ENTRIES: usize = 100;

/// The diagnostic buffer, newest entry first.
#[derive(Debug)]
pub(crate) struct Buffer {
    entries: Vec<Diagnosis>,
    is_stopped: bool,
    /// What a client asked for.
    restart: Option<Restart>,
}

impl Buffer {
    /// A CPU that was just switched on.
    pub(crate) fn new(machine: &Machine, now: DateAndTime) -> Self {
        let mut buffer = Self { entries: Vec::new(), is_stopped: machine.is_plc_stopped(), restart: None };
        for event in [Diagnosis::POWER_ON, Diagnosis::START_UP, Diagnosis::RUN] {
            buffer.add(event, now);
        }
        buffer
    }

    /// Notes who asked for the restart that comes.
    pub(crate) fn restart_asked(&mut self, restart: Restart) {
        self.restart = Some(restart);
    }

    /// Looks at the operating state after a step.
    pub(crate) fn observe(&mut self, machine: &Machine, now: impl Fn() -> DateAndTime) {
        if machine.is_plc_stopped() == self.is_stopped {
            return;
        }
        self.is_stopped = !self.is_stopped;
        let now = now();
        if self.is_stopped {
            self.add(if machine.plc_fault().is_some() { Diagnosis::FAULT } else { Diagnosis::STOP }, now);
            return;
        }
        match self.restart.take() {
            Some(Restart::Warm) => self.add(Diagnosis::WARM_RESTART, now),
            Some(Restart::Cold) => self.add(Diagnosis::COLD_RESTART, now),
            None => {}
        }
        self.add(Diagnosis::START_UP, now);
        self.add(Diagnosis::RUN, now);
    }

    /// All that are kept.
    pub(crate) fn entries(&self) -> &[Diagnosis] {
        &self.entries
    }

    fn add(&mut self, event: u16, now: DateAndTime) {
        self.entries.truncate(ENTRIES - 1);
        self.entries.insert(0, Diagnosis::of_state(event, now));
    }
}
