//! The signals of the function generator, and what an axis has of them.

use serde::{Deserialize, Serialize};

use crate::control::FunctionGenerator;
use crate::sinumerik::state::Unit;
use crate::units::Position;
use crate::variables::EventId;

/// What becomes of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Phase {
    /// NC start begins it.
    Set,
    /// Its axes have asked for travel.
    Requested,
    /// It has been added for this number of cycles.
    Runs(u64),
    /// It returns to 0.
    Returns,
}

/// A signal of the function generator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Generator {
    /// As the operator gave it.
    pub wanted: FunctionGenerator,
    /// What becomes of it.
    pub phase: Phase,
    /// The axes that it moves, once it was started.
    pub unit: Option<Unit>,
    /// The event behind its phase.
    pub cause: EventId,
}

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
