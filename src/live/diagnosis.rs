//! The diagnostic buffer of the PLC's CPU: when its operating state changed, and why. A server shows it in the form of its protocol.

use std::sync::Arc;
use std::time::SystemTime;

use crate::machine::{Command, Machine};

/// The most entries that are kept.
const ENTRIES: usize = 100;

/// A change of the operating state, or its reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Power came; what is retentive is still there.
    PowerOn,
    /// STOP became START-UP.
    StartUp,
    /// START-UP became RUN.
    Run,
    /// STOP on request.
    Stop,
    /// STOP by a fault of the program.
    Fault,
    /// A client asked for a warm restart.
    WarmRestart,
    /// A client asked for a cold restart.
    ColdRestart,
}

/// An event and its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What happened.
    pub event: Event,
    /// When, by the clock of the CPU, in UTC.
    pub time: SystemTime,
}

/// The diagnostic buffer, newest entry first.
#[derive(Debug)]
pub(super) struct Buffer {
    /// Shared with the copies of the machine, and replaced when an entry is added.
    entries: Arc<[Entry]>,
    is_stopped: bool,
    /// The restart that a client asked for.
    restart: Option<Event>,
}

impl Buffer {
    /// A CPU that was just switched on.
    pub(super) fn new(machine: &Machine, now: SystemTime) -> Self {
        let mut buffer = Self { entries: Arc::new([]), is_stopped: machine.is_plc_stopped(), restart: None };
        for event in [Event::PowerOn, Event::StartUp, Event::Run] {
            buffer.add(event, now);
        }
        buffer
    }

    /// Notes a restart that a client asks for; it is entered when the CPU runs again.
    pub(super) fn ordered(&mut self, command: &Command) {
        match command {
            Command::PlcRun => self.restart = Some(Event::WarmRestart),
            Command::PlcColdRestart => self.restart = Some(Event::ColdRestart),
            Command::Write { .. }
            | Command::Force { .. }
            | Command::Release { .. }
            | Command::MachineDatum { .. }
            | Command::RParameter { .. }
            | Command::NewConf
            | Command::PowerOn
            | Command::PlcStop
            | Command::Cancel
            | Command::Handwheel { .. }
            | Command::Fault(_)
            | Command::ClearFault(_) => {}
        }
    }

    /// Looks at the operating state after a step.
    pub(super) fn observe(&mut self, machine: &Machine, now: impl Fn() -> SystemTime) {
        if machine.is_plc_stopped() == self.is_stopped {
            return;
        }
        self.is_stopped = !self.is_stopped;
        let now = now();
        if self.is_stopped {
            self.add(if machine.plc_fault().is_some() { Event::Fault } else { Event::Stop }, now);
            return;
        }
        if let Some(restart) = self.restart.take() {
            self.add(restart, now);
        }
        self.add(Event::StartUp, now);
        self.add(Event::Run, now);
    }

    /// All that are kept.
    pub(super) fn entries(&self) -> Arc<[Entry]> {
        Arc::clone(&self.entries)
    }

    fn add(&mut self, event: Event, time: SystemTime) {
        let before = self.entries.iter().copied();
        self.entries = std::iter::once(Entry { event, time }).chain(before).take(ENTRIES).collect();
    }
}
