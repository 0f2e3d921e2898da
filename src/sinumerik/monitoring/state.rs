//! The monitoring state of one axis and of its encoders.

use serde::{Deserialize, Serialize};

use crate::motion::advance;
use crate::units::Position;
use crate::variables::EventId;

/// The monitoring state of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct AxisMonitor {
    /// Cycles since the end of interpolation.
    pub rest_cycles: u64,
    /// Cycles of position control since then.
    pub positioning_cycles: u64,
    /// Exact stop fine was reached in these cycles.
    pub in_position: bool,
    /// 2.3: the axis is clamped.
    pub clamped: bool,
    /// The position of the axis model, which has a drive without delay.
    pub model: Position,
    pub carry: f64,
    /// Cycles with a speed setpoint above MD36210.
    pub limited_cycles: u64,
    /// Encoder 1 and 2.
    pub encoders: [EncoderMonitor; 2],
    /// Number of cycles waited for the drive.
    pub drive_waits: u64,
    /// The drive was ready in the last cycle.
    pub drive_was_ready: bool,
    /// The event behind the last change of 93.5.
    pub drive_cause: EventId,
}

impl AxisMonitor {
    /// Shifts the coordinate of the present position.
    pub(in crate::sinumerik) fn shift(&mut self, by: Position) {
        self.model += by;
    }

    /// The position of the axis model.
    pub(in crate::sinumerik) const fn model(&self) -> Position {
        self.model
    }

    /// Sets the axis model to this position.
    pub(in crate::sinumerik) fn restart_model(&mut self, actual: Position) {
        (self.model, self.carry) = (actual, 0.0);
    }

    /// Moves the axis model.
    pub(in crate::sinumerik) fn move_model(&mut self, movement: f64) {
        self.model = advance(self.model, &mut self.carry, movement);
    }

    /// Interpolation has not ended.
    pub(in crate::sinumerik) const fn moves(&mut self) {
        (self.rest_cycles, self.positioning_cycles, self.in_position) = (0, 0, false);
    }

    /// The axis counts as being here, at rest from now on.
    pub(in crate::sinumerik) fn restart(&mut self, actual: Position) {
        self.restart_model(actual);
        self.moves();
    }
}

/// The monitoring state of one encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct EncoderMonitor {
    /// 60.2 and 60.3.
    pub frequency_exceeded: bool,
    /// The event behind them.
    pub frequency_cause: EventId,
    /// It has no signal.
    pub fault: bool,
    /// The latest zero mark, in encoder counts.
    pub mark: Option<Position>,
    /// Wrong zero marks so far.
    pub errors: u32,
}

impl EncoderMonitor {
    /// The scale of the encoder changes: the next zero mark is not compared with an earlier one.
    pub(in crate::sinumerik) fn forget_mark(&mut self) {
        self.mark = None;
    }
}
