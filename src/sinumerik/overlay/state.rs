//! The DRF offset of one axis.

use serde::{Deserialize, Serialize};

use crate::motion::Setpoint;
use crate::units::Position;
use crate::variables::EventId;

/// The DRF offset of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Overlay {
    /// The offset, and how it moves.
    pub setpoint: Setpoint,
    /// The sum of all pulses: `$AC_DRF`.
    pub target: Position,
    /// The remaining fraction of an increment.
    pub carry: f64,
    /// The handwheel that moves the axis, as a bit.
    pub handwheels: u8,
    /// The traverse command of its movement: +1, −1 or 0.
    pub command: i8,
    /// The event behind handwheel and command.
    pub cause: EventId,
}

impl Overlay {
    /// The offset.
    #[must_use]
    pub(in crate::sinumerik) const fn position(&self) -> Position {
        self.setpoint.position
    }

    /// Whether the offset is where the pulses want it, and no handwheel is selected.
    #[must_use]
    pub(in crate::sinumerik) fn rests(&self) -> bool {
        self.setpoint.position == self.target && self.setpoint.is_at_rest() && self.handwheels == 0 && self.command == 0
    }
}
