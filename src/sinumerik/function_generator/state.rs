//! The signals of the function generator.

use serde::{Deserialize, Serialize};

use crate::control::FunctionGenerator;
use crate::units::AxisSet;
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
    /// The axes that it moves; none before it was started.
    pub axes: AxisSet,
    /// The event behind its phase.
    pub cause: EventId,
}
