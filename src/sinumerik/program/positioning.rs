//! POS and POSA: an axis on its own way to a target.

use serde::{Deserialize, Serialize};

use crate::units::{AxisNumber, Position};

/// The movement of a positioning axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Positioning {
    pub axis: AxisNumber,
    /// In machine coordinates.
    pub target: Position,
    /// In increments per second.
    pub velocity: f64,
    /// POS: the block ends when the axis is there.
    pub waits: bool,
}
