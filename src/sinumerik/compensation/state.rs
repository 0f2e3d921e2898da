//! The compensation values of one axis.

use serde::{Deserialize, Serialize};

use crate::units::Position;
use crate::variables::EventId;

/// The compensation values of one axis, and what they depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Compensation {
    /// Added to the measured value of each encoder: leadscrew error and backlash.
    pub encoder: [Position; 2],
    /// Sag, in increments.
    pub sag: f64,
    /// Temperature, in increments.
    pub temperature: f64,
    /// The sum of both: what the setpoint gets in addition.
    pub setpoint: Position,
    /// Direction of the last movement of the setpoint, +1 or −1; 0 before the first one.
    pub direction: i8,
    /// Direction of the last movement when each encoder was referenced: there the backlash compensation is 0.
    pub reference_direction: [i8; 2],
    /// Both directions are those before power off (MD32454 bit 0), until the axis moves.
    pub side_is_kept: bool,
    /// Which encoder was referenced in the last cycle.
    pub was_referenced: [bool; 2],
    /// The traverse command of a movement by the compensation of the setpoint: +1, −1 or 0.
    pub command: i8,
    /// Cycles since the compensation of the setpoint last changed, while there is a traverse command.
    pub still_cycles: u8,
    /// The event behind the traverse command.
    pub cause: EventId,
}

impl Compensation {
    /// After power on: the side of the play is as before power off.
    pub(in crate::sinumerik) fn keep_side_of(&mut self, before: &Self) {
        (self.direction, self.reference_direction) = (before.direction, before.reference_direction);
        self.side_is_kept = self.direction != 0;
    }

    /// What an encoder value gets to become an actual value.
    #[must_use]
    pub(in crate::sinumerik) fn of(&self, encoder: usize) -> Position {
        self.encoder[encoder] - self.setpoint
    }

    /// Whether it has no value and remembers no command.
    #[must_use]
    pub(in crate::sinumerik) fn is_off(&self) -> bool {
        self.encoder == [Position::ZERO; 2]
            && self.setpoint == Position::ZERO
            && self.sag.abs() <= 0.0
            && self.temperature.abs() <= 0.0
            && self.command == 0
            && self.was_referenced == [false; 2]
    }
}
