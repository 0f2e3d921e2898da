//! The record as the machine writes it, one row for each byte or alarm that changed in a cycle.
//!
//! A row is plain numbers: no text, no allocation. The machine fills a chunk of fixed size; whoever runs the
//! machine drains it between two steps.

use crate::image::Part;
use crate::variables::{Event, EventId, Events, RaisedAlarm};

/// Who changed a bit.
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
    /// The simulator's own cams, switches and inputs.
    Plant,
    /// Power on: presets.
    PowerOn,
}

/// What changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// A byte of the memory; who changed each bit, and the event behind it (only the control has events).
    Byte {
        /// Which memory.
        part: Part,
        /// Which byte of it.
        offset: u32,
        /// Before.
        old: u8,
        /// After.
        new: u8,
        /// Who, bit by bit.
        by: [By; 8],
        /// Why, bit by bit.
        causes: [EventId; 8],
    },
    /// An alarm came or went.
    Alarm {
        /// Which.
        alarm: RaisedAlarm,
        /// Came or went.
        raised: bool,
        /// Why.
        cause: EventId,
    },
    /// A write from outside that the PLC program overwrote in the same cycle.
    Overwritten {
        /// Which memory.
        part: Part,
        /// Which byte of it.
        offset: u32,
        /// Which bits.
        bits: u8,
    },
}

/// Who, in one word.
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

/// One change, and the cycle whose end shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Number of the cycle, from one.
    pub cycle: u64,
    /// What changed.
    pub change: Change,
}

/// A chunk of the record, filled by the machine and drained by its owner between two steps.
#[derive(Debug)]
pub struct Recorder {
    rows: Vec<Row>,
    events: Vec<Event>,
    lost: u64,
}

impl Default for Recorder {
    fn default() -> Self {
        Self { rows: Vec::with_capacity(Self::ROOM), events: Vec::with_capacity(Events::CAPACITY), lost: 0 }
    }
}

impl Recorder {
    /// How many rows are kept between two drains: some times those of what clients may write at the edge of one step.
    pub const ROWS: usize = 16_384;
    /// Room for rows before it has to grow; one step without such clients writes fewer. For events it is what one step can leave.
    const ROOM: usize = 512;
    /// How many events fit between two drains.
    pub const EVENTS: usize = 1024;

    /// One that has no room yet, for a machine that does not go on.
    #[must_use]
    pub const fn without_room() -> Self {
        Self { rows: Vec::new(), events: Vec::new(), lost: 0 }
    }

    /// Notes a change; counts it as lost where nobody drains.
    pub fn push(&mut self, row: Row) {
        if self.rows.len() < Self::ROWS {
            self.rows.push(row);
        } else {
            self.lost += 1;
        }
    }

    /// Notes the events of this cycle.
    pub fn events<'a>(&mut self, events: impl Iterator<Item = &'a Event>) {
        let room = Self::EVENTS - self.events.len();
        self.events.extend(events.take(room));
    }

    /// What happened since the last drain.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The events since the last drain.
    #[must_use]
    pub fn new_events(&self) -> &[Event] {
        &self.events
    }

    /// How many rows did not fit.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Forgets what has been read.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.events.clear();
    }
}
