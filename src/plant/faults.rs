//! Faults for tests, and the switches of an axis, which can be stuck.

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

/// The kind of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum FaultKind {
    /// The slide cannot move.
    Block,
    /// The slide is displaced once.
    Push {
        /// Distance.
        by: Position,
    },
    /// The active encoder gains or loses counts once.
    EncoderSlip {
        /// Distance.
        by: Position,
    },
    /// The encoders send no zero marks.
    ZeroMarkMissing,
    /// The drive reports a fault, and its motor has no power.
    DriveFault,
    /// An encoder sends no new values.
    EncoderFault {
        /// 0 or 1; `None`: the active encoder; clearing with `None` clears both.
        encoder: Option<u8>,
    },
    /// The motor is slower than its speed command.
    Friction {
        /// Share of the velocity that is lost, 0 to 1.
        by: f64,
    },
    /// The slide moves on its own while its drive has no power.
    Drift {
        /// Velocity in increments per second.
        by: f64,
    },
    /// A switch is stuck at a value.
    SwitchStuck {
        /// The switch.
        which: Switch,
        /// Pressed or not.
        at: bool,
    },
}

/// A fault of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// The axis.
    pub axis: AxisNumber,
    /// The kind.
    pub kind: FaultKind,
}
