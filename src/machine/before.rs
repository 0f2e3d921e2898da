//! The memory at the time of the last record.

use super::Switch;
use super::written::{FIXED, Written};
use crate::image::{Memory, Part};
use crate::units::AxisNumber;
use crate::variables::EventId;

/// The memory at the time of the last record, and the writes from outside since then.
#[derive(Debug)]
pub(super) struct Before {
    pub(super) parts: Vec<(Part, Vec<u8>)>,
    pub(super) written: Written,
    /// The PLC's half differs from that at the end of the last cycle.
    pub(super) plc_wrote: bool,
    /// The memory after power on, if power was switched off and on in this step.
    pub(super) power_on: Option<Box<Memory>>,
    /// The switches that became stuck or free in this step, and the events of these faults.
    pub(super) stuck: Vec<(AxisNumber, Switch, EventId)>,
}

impl Before {
    /// The memory as it is now.
    pub(super) fn new(memory: &Memory) -> Self {
        let own = memory.blocks.iter().map(|block| Part::Block(block.number));
        let parts = FIXED.into_iter().chain(own).map(|part| (part, memory.part(part).to_vec())).collect();
        Self { parts, written: Written::new(), plc_wrote: true, power_on: None, stuck: Vec::new() }
    }

    /// Empty, for a machine that does not run.
    pub(super) const fn without_capacity() -> Self {
        Self { parts: Vec::new(), written: Written::new(), plc_wrote: true, power_on: None, stuck: Vec::new() }
    }
}
