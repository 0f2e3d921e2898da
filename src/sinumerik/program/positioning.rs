//! The movement of an axis on its own way to a target: POS, POSA, and rapid traverse with MD20730 = 0.

use serde::{Deserialize, Serialize};

use crate::units::{AxisNumber, Position};
use crate::variables::BlockName;

/// The movement of a positioning axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct AxisPositioning {
    pub axis: AxisNumber,
    /// In machine coordinates.
    pub target: Position,
    /// In increments per second.
    pub velocity: f64,
    /// POS: the block ends when the axis is there.
    pub waits: bool,
    /// G0 with MD20730 = 0: the rapid traverse override of the channel acts, not that of the axis.
    pub is_rapid: bool,
    /// FDA.
    pub handwheel: Handwheel,
    /// The block that begins it; empty for one of a synchronised action.
    pub block: BlockName,
}

/// What a handwheel does in the movement of a positioning axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Handwheel {
    /// Nothing.
    None,
    /// FDA above 0: it changes the velocity.
    Velocity,
    /// FDA = 0: its pulses move the axis.
    Way,
}
