//! What monitoring remembers of one axis and of its encoders.

use serde::{Deserialize, Serialize};

use crate::motion::advance;
use crate::units::Position;
use crate::variables::EventId;

/// What monitoring remembers of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct AxisMonitor {
    /// Cycles since the end of interpolation.
    pub rest_cycles: u64,
    /// Cycles of position control since then.
    pub positioning_cycles: u64,
    /// Exact stop fine was reached in them.
    pub in_position: bool,
    /// 2.3: the axis is clamped.
    pub clamped: bool,
    /// Where the axis would be with an ideal speed loop.
    pub model: Position,
    pub carry: f64,
    /// Cycles with a speed setpoint beyond MD36210.
    pub limited_cycles: u64,
    /// Encoder 1 and 2.
    pub encoders: [EncoderMonitor; 2],
    /// Cycles that the drive has been waited for.
    pub drive_waits: u64,
    /// The drive was ready in the last cycle.
    pub drive_was_ready: bool,
    /// Why 93.5 came or went last.
    pub drive_cause: EventId,
}

impl AxisMonitor {
    /// The same place has another value.
    pub(in crate::sinumerik) fn shift(&mut self, by: Position) {
        self.model += by;
    }

    /// Where the axis would be.
    pub(in crate::sinumerik) const fn model(&self) -> Position {
        self.model
    }

    /// The axis would be here.
    pub(in crate::sinumerik) fn restart_model(&mut self, actual: Position) {
        (self.model, self.carry) = (actual, 0.0);
    }

    /// The ideal axis moves.
    pub(in crate::sinumerik) fn move_model(&mut self, movement: f64) {
        self.model = advance(self.model, &mut self.carry, movement);
    }

    /// Interpolation has not ended.
    pub(in crate::sinumerik) const fn moves(&mut self) {
        (self.rest_cycles, self.positioning_cycles, self.in_position) = (0, 0, false);
    }

    /// The axis counts as being here, at rest since now.
    pub(in crate::sinumerik) fn restart(&mut self, actual: Position) {
        self.restart_model(actual);
        self.moves();
    }
}

/// What monitoring remembers of one encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct EncoderMonitor {
    /// 60.2 and 60.3.
    pub frequency_exceeded: bool,
    /// Why.
    pub frequency_cause: EventId,
    /// It tells nothing.
    pub fault: bool,
    /// The latest zero mark, as it counts.
    pub mark: Option<Position>,
    /// Wrong zero marks so far.
    pub errors: u32,
}

impl EncoderMonitor {
    /// It counts in another measure from now on: the next zero mark has none before it.
    pub(in crate::sinumerik) fn forget_mark(&mut self) {
        self.mark = None;
    }
}
