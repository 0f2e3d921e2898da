//! What the drive and the encoders of an axis report in one cycle.

use serde::{Deserialize, Serialize};

use super::EncoderSignal;
use crate::units::Position;

/// The holding brake of a motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Brake {
    /// The motor has none.
    #[default]
    None,
    /// It holds.
    Closed,
    /// It opens or closes.
    Moving,
    /// It is open.
    Open,
}

/// The signals of drive and encoders in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Feedback {
    /// Encoder 1 and 2.
    pub encoders: [EncoderSignal; 2],
    /// Half a count of each encoder: the largest deviation that position control cannot detect.
    pub half_count: [Position; 2],
    /// Velocity at the motor, in increments per second.
    pub velocity: f64,
    /// The drive has started up and has no fault.
    pub drive_ready: bool,
    /// Its holding brake.
    pub brake: Brake,
    /// The drive reports a fault.
    pub drive_fault: bool,
    /// Encoders that read their position without a movement.
    pub absolute: [bool; 2],
    /// Encoders without a signal.
    pub encoder_faults: [bool; 2],
    /// The slide presses its reference cam.
    pub cam: bool,
    /// True position of the slide. Only the display of the simulator uses it; the control does not know it.
    pub slide: Position,
}
