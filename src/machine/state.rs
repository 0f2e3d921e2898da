//! The state that a machine keeps from one step to the next, without its control and its PLC program, which save themselves. It is plain
//! data with derived copies. Everything else is part of the definition or can be computed from this state.

use serde::{Deserialize, Serialize};

use super::command::Command;
use super::delay::Delay;
use super::plc::PlcState;
use super::written::Force;
use crate::control::PlcSide;
use crate::image::Memory;
use crate::motion::Feedback;
use crate::plant::{Fault, Plant};
use crate::units::{PerAxis, Time};
use crate::variables::{EventId, Variables};

/// The state of a machine.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct State {
    /// Number of cycles run so far.
    pub(super) cycle: u64,
    /// Simulated time since the machine was opened.
    pub(super) time: Time,
    pub(super) memory: Memory,
    /// The PLC's half on its way to the control.
    pub(super) to_nck: Delay,
    /// The NCK's half on its way to the PLC program.
    pub(super) from_nck: Delay,
    pub(super) variables: Variables,
    pub(super) plant: Plant,
    /// What drives and encoders reported last.
    pub(super) feedback: PerAxis<Feedback>,
    pub(super) plc: PlcState,
    pub(super) forces: Vec<Force>,
    pub(super) queue: Vec<Command>,
    /// Slides and encoders to be displaced in this step, with the measuring system that was active at that time.
    pub(super) displaced: Vec<(Fault, Option<u8>)>,
    /// The last recorded event. Events before the first step are recorded with that step.
    pub(super) recorded: EventId,
}

impl State {
    /// The data that the control reads.
    pub(super) fn plc_side(&self) -> PlcSide<'_> {
        PlcSide { to_nck: self.to_nck.seen(&self.memory.to_nck), hmi: &self.memory.hmi }
    }
}
