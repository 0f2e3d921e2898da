//! What the drive and the encoders of an axis report in one cycle.

use serde::{Deserialize, Serialize};

use super::EncoderSignal;
use crate::units::Position;

/// What drive and encoders tell in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Feedback {
    /// Encoder 1 and 2.
    pub encoders: [EncoderSignal; 2],
    /// Half a count of each: the largest deviation that position control cannot see.
    pub half_count: [Position; 2],
    /// Velocity at the motor, in increments per second.
    pub velocity: f64,
    /// The drive has run up, and has no fault.
    pub drive_ready: bool,
    /// The drive tells of a fault.
    pub drive_fault: bool,
    /// Which encoder tells nothing.
    pub encoder_faults: [bool; 2],
    /// True position of the slide, which only the display of the simulator knows.
    pub slide: Position,
}
