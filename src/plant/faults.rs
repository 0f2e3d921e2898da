//! Faults for tests, and the switches of an axis, which can be stuck.

use serde::{Deserialize, Serialize};

use crate::source::Problem;
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
    /// The slide stands this far from where its drive wants it.
    Hold {
        /// Distance.
        by: Position,
    },
    /// The slide is displaced once, with its drive off: the drive does not bring it back.
    MovedByHand {
        /// Distance.
        by: Position,
    },
    /// The drive is not ready; it reports no fault.
    DriveNotReady,
}

impl FaultKind {
    /// The fastest drift in mm or degrees per second. No real axis is faster.
    pub const FASTEST_DRIFT: f64 = 1e6;
    /// The largest push in mm or degrees: one kilometre, longer than any machine.
    pub const FARTHEST_PUSH: f64 = 1e6;

    /// Checks that the plant can have this fault.
    ///
    /// # Errors
    /// A number is not finite or out of range, or there is no such encoder.
    pub fn check(self) -> Result<(), Problem> {
        let (expected, found, is_possible) = match self {
            Self::Block | Self::ZeroMarkMissing | Self::DriveFault | Self::DriveNotReady | Self::SwitchStuck { .. } => {
                return Ok(());
            }
            Self::Push { by } | Self::EncoderSlip { by } | Self::Hold { by } | Self::MovedByHand { by } => {
                let by = by.user();
                ("a distance in mm or degrees from -1000000 to 1000000", by, by.abs() <= Self::FARTHEST_PUSH)
            }
            Self::EncoderFault { encoder } => {
                let number = encoder.map_or(1.0, |encoder| f64::from(encoder) + 1.0);
                ("encoder 1 or 2", number, number <= 2.0)
            }
            Self::Friction { by } => ("a share of the velocity, 0 to 1", by, (0.0..=1.0).contains(&by)),
            Self::Drift { by } => {
                let by = by / Position::PER_USER_UNIT;
                let expected = "a velocity in mm or degrees per second from -1000000 to 1000000";
                (expected, by, by.abs() <= Self::FASTEST_DRIFT)
            }
        };
        if is_possible {
            return Ok(());
        }
        Err(Problem::new(
            format!("expected {expected}, found {found}"),
            "the plant can have no other fault of this kind",
        ))
    }
}

/// A fault of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// The axis.
    pub axis: AxisNumber,
    /// The kind.
    pub kind: FaultKind,
}
