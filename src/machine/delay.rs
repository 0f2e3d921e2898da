//! How late the bytes of one half of the interface reach the other side (O-28): `to_nck_delay` and `from_nck_delay` of `plant.toml`.
//!
//! The memory contains each byte as its writer wrote it, and the record, conditions of scenarios and clients read it there. Only the reader
//! on the other side gets an older state: the control reads the PLC's half, and the PLC program reads the NCK's half. All bytes of a half are
//! equally late, whoever wrote them. HMI bytes are not delayed. Without a delay nothing is copied.

use serde::{Deserialize, Serialize};

use crate::image::PartBytes;

/// Largest delay in cycles.
pub(super) const MOST_CYCLES: u64 = 1_000;

/// The states of a half that are on their way to its reader.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Delay {
    /// The states of the last cycles, as a ring; empty without a delay.
    states: Vec<PartBytes>,
    /// The state that the reader has.
    seen: usize,
}

impl Delay {
    /// A delay of whole cycles. The reader sees these bytes until a later state arrives.
    pub(super) fn new(cycles: u64, bytes: &PartBytes) -> Self {
        // Those on their way, the one that the reader has, and the one that it had before.
        let states = if cycles == 0 { 0 } else { usize::try_from(cycles.min(MOST_CYCLES) + 2).expect("at most 1,002") };
        Self { states: vec![bytes.clone(); states], seen: 0 }
    }

    /// What the reader has; `now` without a delay.
    pub(super) fn seen<'a>(&'a self, now: &'a PartBytes) -> &'a PartBytes {
        self.late().unwrap_or(now)
    }

    /// What the reader has; `None` without a delay.
    pub(super) fn late(&self) -> Option<&PartBytes> {
        self.states.get(self.seen)
    }

    /// What the reader had in the last cycle; `None` without a delay.
    pub(super) fn seen_before(&self) -> Option<&PartBytes> {
        let count = self.states.len();
        self.states.get((self.seen + count).checked_sub(1)? % count.max(1))
    }

    /// A cycle ends for the writer, with these bytes.
    pub(super) fn advance(&mut self, now: &PartBytes) {
        let count = self.states.len();
        if count > 0 {
            self.states[(self.seen + count - 1) % count].copy_from_slice(now);
            self.seen = (self.seen + 1) % count;
        }
    }
}
