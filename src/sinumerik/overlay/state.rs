//! The DRF offset of one axis.

use serde::{Deserialize, Serialize};

use crate::motion::Setpoint;
use crate::units::Position;
use crate::variables::EventId;

/// The handwheel override of an axis (FDA), or of the path whose first axis it is (FD).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct HandwheelOverride {
    /// A handwheel is assigned: 62.1 of a positioning axis, 33.3 of a path.
    pub is_active: bool,
    /// Of a positioning axis, not of a path.
    pub is_axial: bool,
    /// What the handwheel adds, averaged, in increments per second.
    pub velocity: f64,
    /// How far the pulses of this cycle move the axis, in increments.
    pub turned: f64,
    /// FDA = 0: where the axis began, and how far the handwheel has moved it.
    pub way: Option<(Position, f64)>,
    /// The event behind it.
    pub cause: EventId,
}

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
    /// 67.0: the direction of this handwheel is inverted.
    pub inverted: bool,
    /// The traverse command of its movement: +1, −1 or 0.
    pub command: i8,
    /// The event behind the command.
    pub cause: EventId,
    /// The event behind the handwheel and its inversion alone.
    pub selected: EventId,
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
