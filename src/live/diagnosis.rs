//! The diagnostic buffer of the PLC's CPU: the changes of its operating state with their reasons. A server shows it in the format of its
//! protocol.

use std::sync::Arc;
use std::time::SystemTime;

use crate::machine::{Command, Machine, PlcOrder};
use crate::plc::PlcDiagnosis;

/// The maximum number of entries.
const ENTRIES: usize = 100;

/// A change of the operating state, or its reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Power on; retentive data are kept.
    PowerOn,
    /// STOP to START-UP.
    StartUp,
    /// START-UP to RUN.
    Run,
    /// STOP on request.
    Stop,
    /// STOP because of an error in the program.
    Fault,
    /// An event with its number and additional information: why the program stopped the CPU.
    Numbered(u16, [u8; 10]),
    /// A client requested a warm restart.
    WarmRestart,
    /// A client requested a cold restart.
    ColdRestart,
}

/// An event and its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The event.
    pub event: Event,
    /// The time by the clock of the CPU, in UTC.
    pub time: SystemTime,
}

/// The diagnostic buffer, newest entry first.
#[derive(Debug)]
pub(super) struct Buffer {
    /// Shared with the copies of the machine; replaced when an entry is added.
    entries: Arc<[Entry]>,
    is_stopped: bool,
    /// The restart that a client requested.
    restart: Option<Event>,
}

impl Buffer {
    /// The buffer of a CPU that was just switched on.
    pub(super) fn new(machine: &Machine, now: SystemTime) -> Self {
        let mut buffer = Self { entries: Arc::new([]), is_stopped: machine.is_plc_stopped(), restart: None };
        for event in [Event::PowerOn, Event::StartUp, Event::Run] {
            buffer.add(event, now);
        }
        buffer
    }

    /// Remembers a restart that a client requested. It is entered when the CPU runs again.
    pub(super) fn ordered(&mut self, command: &Command) {
        match command.plc_order() {
            Some(PlcOrder::WarmRestart) => self.restart = Some(Event::WarmRestart),
            Some(PlcOrder::ColdRestart) => self.restart = Some(Event::ColdRestart),
            Some(PlcOrder::Stop) | None => {}
        }
    }

    /// Enters changes of the operating state after a step.
    pub(super) fn observe(&mut self, machine: &Machine, now: impl Fn() -> SystemTime) {
        if machine.is_plc_stopped() == self.is_stopped {
            return;
        }
        self.is_stopped = !self.is_stopped;
        let now = now();
        if self.is_stopped {
            match machine.plc_diagnosis() {
                Some(PlcDiagnosis { cause, stop, information }) => {
                    for event in cause.into_iter().chain([stop]) {
                        self.add(Event::Numbered(event, information), now);
                    }
                }
                None => self.add(if machine.plc_fault().is_some() { Event::Fault } else { Event::Stop }, now),
            }
            return;
        }
        if let Some(restart) = self.restart.take() {
            self.add(restart, now);
        }
        self.add(Event::StartUp, now);
        self.add(Event::Run, now);
    }

    /// All entries.
    pub(super) fn entries(&self) -> Arc<[Entry]> {
        Arc::clone(&self.entries)
    }

    fn add(&mut self, event: Event, time: SystemTime) {
        let before = self.entries.iter().copied();
        self.entries = std::iter::once(Entry { event, time }).chain(before).take(ENTRIES).collect();
    }
}
