//! Faults that a test can cause, and the switches of an axis, which can be stuck.

use serde::{Deserialize, Serialize};

use crate::units::{AxisNumber, Position};

/// A switch of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Switch {
    /// Reference cam.
    Cam,
    /// Hardware limit switch plus.
    LimitPlus,
    /// Hardware limit switch minus.
    LimitMinus,
}

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum FaultKind {
    /// The slide cannot move.
    Block,
    /// The slide is displaced once.
    Push {
        /// By this much.
        by: Position,
    },
    /// The active encoder gains or loses counts once.
    EncoderSlip {
        /// This many.
        by: Position,
    },
    /// The encoders give no zero marks.
    ZeroMarkMissing,
    /// The drive tells of a fault, and its motor has no power.
    DriveFault,
    /// An encoder tells nothing new.
    EncoderFault {
        /// 0 or 1; `None`: the active one, when it ends both.
        encoder: Option<u8>,
    },
    /// The motor does not turn as fast as its drive is told.
    Friction {
        /// Share of the velocity that is lost, 0 to 1.
        by: f64,
    },
    /// The slide moves by itself while its drive has no power.
    Drift {
        /// Velocity in increments per second.
        by: f64,
    },
    /// A switch stays as it is told.
    SwitchStuck {
        /// Which.
        which: Switch,
        /// Pressed or not.
        at: bool,
    },
}

/// A fault of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// Whose.
    pub axis: AxisNumber,
    /// What.
    pub kind: FaultKind,
}
