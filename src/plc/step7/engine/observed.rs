//! What an observed CPU remembers, as plain data: what ran, and the changes of a cycle with the operands that made
//! them.

use arrayvec::ArrayVec;

use super::contacts::Contacts;
use super::memory::OpenBlock;
use super::origin::Flow;
use super::read::{Named, Read, TESTED};

/// The changes that are kept of one cycle.
pub(in crate::plc::step7) const CHANGES: usize = 512;
/// Of these, the words outside of an interface, which can change in every scan.
pub(in crate::plc::step7) const WORDS: usize = 128;

/// The instruction ran.
pub(in crate::plc::step7) const RAN: u8 = 1;
/// A contact was false, or a branch was not taken.
pub(in crate::plc::step7) const NO: u8 = 2;
/// A contact was true, or a branch was taken.
pub(in crate::plc::step7) const YES: u8 = 4;

/// A change of the memory, and the operands that made it.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) struct Seen {
    pub(in crate::plc::step7) pc: u32,
    pub(in crate::plc::step7) place: Named,
    /// The bits that were written from that place on.
    pub(in crate::plc::step7) bits: u32,
    /// The new value; of a timer whether it is started.
    pub(in crate::plc::step7) value: u32,
    pub(in crate::plc::step7) tested: ArrayVec<Read, TESTED>,
}

/// What was observed of a program.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) struct Observed {
    /// For each instruction [`RAN`], [`NO`] and [`YES`].
    pub(in crate::plc::step7) marks: Vec<u8>,
    /// The changes of the present cycle.
    pub(in crate::plc::step7) seen: Vec<Seen>,
    /// How many of them are words outside of an interface.
    pub(in crate::plc::step7) words: usize,
    /// Bits that are written with the value that they have count, too, and those that are not set or not reset.
    pub(in crate::plc::step7) has_all_writes: bool,
    /// The instruction that runs.
    pub(in crate::plc::step7) pc: u32,
    /// The IEC timer that is being called.
    pub(in crate::plc::step7) clock: Option<Clock>,
    /// Where the values in the accumulators come from.
    pub(in crate::plc::step7) flow: Flow,
    /// What the last bit operations tested.
    pub(in crate::plc::step7) contacts: Contacts,
    /// What the built-in block that runs has read.
    pub(in crate::plc::step7) inputs: ArrayVec<Read, TESTED>,
    /// The signals of the NCK in the last cycle, and in this one.
    pub(in crate::plc::step7) from_nck: [Vec<u8>; 2],
    /// The keys of the panels and the messages of DB2 in their last calls.
    pub(in crate::plc::step7) keys: [[u8; 8]; 2],
    pub(in crate::plc::step7) messages: Vec<u8>,
    /// The interface to the NCK before a block of the basic program; kept, so that no call allocates.
    pub(in crate::plc::step7) interface: Vec<u8>,
}

/// An IEC timer before its call: its instance, and whether Q was set.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) struct Clock {
    pub(in crate::plc::step7) block: OpenBlock,
    pub(in crate::plc::step7) begin: u32,
    pub(in crate::plc::step7) is_pulse: bool,
    pub(in crate::plc::step7) before: bool,
}

impl Observed {
    pub(in crate::plc::step7) fn new(instructions: usize) -> Self {
        Self {
            marks: vec![0; instructions],
            seen: Vec::with_capacity(CHANGES),
            words: 0,
            has_all_writes: false,
            pc: 0,
            clock: None,
            flow: Flow::default(),
            contacts: Contacts::new(),
            inputs: ArrayVec::new(),
            from_nck: [Vec::new(), Vec::new()],
            keys: [[0; 8]; 2],
            messages: Vec::new(),
            interface: Vec::new(),
        }
    }

    /// A cycle begins: its changes are still to come.
    pub(in crate::plc::step7) fn begin_cycle(&mut self) {
        self.seen.clear();
        self.words = 0;
        // A cycle in which no block has read them does not count.
        if !self.from_nck[1].is_empty() {
            self.from_nck.swap(0, 1);
            self.from_nck[1].clear();
        }
    }
}
