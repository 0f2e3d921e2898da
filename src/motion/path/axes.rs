//! The axes of a path and their limits.

use serde::{Deserialize, Serialize};

/// The largest number of axes of a path.
pub const PATH_AXES: usize = 8;

/// One value per axis of a path, in increments or in increments per second.
pub type PerPathAxis = [f64; PATH_AXES];

/// What the axes of a path can do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathLimits {
    /// Largest velocity of each axis, in increments per second.
    pub velocity: PerPathAxis,
    /// Largest acceleration, in increments per second squared.
    pub acceleration: PerPathAxis,
    /// How many times its acceleration per cycle an axis may change its velocity at a corner; at least 1.
    pub overload: PerPathAxis,
}
