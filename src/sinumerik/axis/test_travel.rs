//! What an axis has of a signal of the function generator.

use serde::{Deserialize, Serialize};

use crate::units::Position;
use crate::variables::EventId;

/// What an axis has of a signal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct TestTravel {
    /// The part of the setpoint that is the signal.
    pub offset: Position,
    /// 61.0.
    pub requested: bool,
    /// The signal moves the setpoint.
    pub moves: bool,
    /// The event behind both.
    pub cause: EventId,
}

impl TestTravel {
    /// Everything but the movement is equal.
    pub(in crate::sinumerik) fn has_decisions_of(&self, other: &Self) -> bool {
        (self.requested, self.moves, self.cause) == (other.requested, other.moves, other.cause)
    }
}
