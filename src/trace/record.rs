//! The record that the machine writes: one row for each byte or alarm that changed in a cycle.
//!
//! A row consists of numbers only: no text, no allocation. The machine fills a chunk of fixed size; the owner of the machine drains it
//! between two steps.

use crate::image::{Location, Part};
use crate::units::AxisNumber;
use crate::variables::{DatumValue, Event, EventId, Events, FaultName, Happening, RaisedAlarm};

/// The writer of a bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum By {
    /// The control.
    Nck,
    /// The PLC program.
    Plc,
    /// A `set` of a scenario, or another write from outside.
    Outside,
    /// A force.
    Force,
    /// The simulated cams, switches and inputs.
    Plant,
    /// Power on: presets.
    PowerOn,
}

/// The kind of a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// A byte of the memory changed; writer of each bit, and the event that caused it (only the control has events).
    Byte {
        /// The part of the memory.
        part: Part,
        /// The byte in the part.
        offset: u32,
        /// The old value.
        old: u8,
        /// The new value.
        new: u8,
        /// The writer of each bit.
        by: [By; 8],
        /// The event that caused the change of each bit.
        causes: [EventId; 8],
    },
    /// An alarm was raised or cleared.
    Alarm {
        /// The alarm.
        alarm: RaisedAlarm,
        /// Whether it was raised.
        raised: bool,
        /// The event that caused it.
        cause: EventId,
    },
    /// Something happened that is not a change of the memory.
    Happened {
        /// What happened.
        what: Happening,
        /// The side that it comes from.
        by: By,
        /// The event that was recorded for it, if any.
        cause: EventId,
    },
    /// A write from outside that the PLC program overwrote in the same cycle.
    Overwritten {
        /// The part of the memory.
        part: Part,
        /// The byte in the part.
        offset: u32,
        /// The overwritten bits.
        bits: u8,
    },
    /// A command from outside had no effect.
    NoEffect(NoEffect),
}

/// A command from outside that had no effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoEffect {
    /// Bits were released that were not forced.
    Release(Location),
    /// A fault was cleared that did not act.
    ClearFault {
        /// The axis.
        axis: AxisNumber,
        /// The kind of the fault.
        name: FaultName,
    },
}

/// The writer, as one term.
pub(super) fn by_in_words(by: By) -> &'static str {
    match by {
        By::Nck => "nck",
        By::Plc => "plc",
        By::Outside => "outside",
        By::Force => "force",
        By::Plant => "plant",
        By::PowerOn => "power on",
    }
}

/// One change, and the cycle at whose end it is visible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The number of the cycle, from one.
    pub cycle: u64,
    /// The change.
    pub change: Change,
}

/// A chunk of the record. The machine fills it, its owner drains it between two steps.
#[derive(Debug)]
pub struct Recorder {
    rows: Vec<Row>,
    events: Vec<Event>,
    lost: u64,
}

impl Default for Recorder {
    fn default() -> Self {
        Self { rows: Vec::with_capacity(Self::INITIAL_ROWS), events: Vec::with_capacity(Events::CAPACITY), lost: 0 }
    }
}

impl Recorder {
    /// The number of rows that are kept between two drains: several times the number that clients can write at the edge of one step.
    pub const ROWS: usize = 16_384;
    /// The initial capacity for rows; one step without such clients writes fewer. For events it is the number of one step.
    const INITIAL_ROWS: usize = 512;
    /// The number of events that are kept between two drains.
    pub const EVENTS: usize = 1024;

    /// A recorder without capacity, for a machine that does not continue.
    #[must_use]
    pub const fn without_capacity() -> Self {
        Self { rows: Vec::new(), events: Vec::new(), lost: 0 }
    }

    /// Records a change; counts it as lost if the record is full.
    pub fn push(&mut self, row: Row) {
        if self.rows.len() < Self::ROWS {
            self.rows.push(row);
        } else {
            self.lost += 1;
        }
    }

    /// A datum becomes active in this cycle: the rows that say that it was stored in the same cycle say nothing more.
    pub fn forget_stored(&mut self, cycle: u64, active: DatumValue) {
        let is_of_cycle = |row: &Row| row.cycle == cycle;
        let first = self.rows.iter().rposition(|row| !is_of_cycle(row)).map_or(0, |last| last + 1);
        let says_so = |row: &Row| match row.change {
            Change::Happened { what: Happening::DatumStored(stored), .. } => {
                (stored.number, stored.place, stored.index) == (active.number, active.place, active.index)
            }
            Change::Happened { .. }
            | Change::Byte { .. }
            | Change::Alarm { .. }
            | Change::Overwritten { .. }
            | Change::NoEffect(_) => false,
        };
        let mut index = 0;
        self.rows.retain(|row| {
            index += 1;
            index <= first || !says_so(row)
        });
    }

    /// Records the events of this cycle.
    pub fn events<'a>(&mut self, events: impl Iterator<Item = &'a Event>) {
        let left = Self::EVENTS - self.events.len();
        self.events.extend(events.take(left));
    }

    /// The rows since the last drain.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The events since the last drain.
    #[must_use]
    pub fn new_events(&self) -> &[Event] {
        &self.events
    }

    /// The number of lost rows.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Removes the rows that were read.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.events.clear();
    }
}
