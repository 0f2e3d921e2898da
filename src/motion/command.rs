//! What an axis is commanded to do in one cycle: brake, run, go to a position, follow the actual value, or hold.

use serde::{Deserialize, Serialize};

use super::{Limits, Setpoint};
use crate::units::Position;

/// What an axis is commanded to do in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Motion {
    /// Brake to rest.
    Brake {
        /// In increments per second squared.
        deceleration: f64,
    },
    /// Move at a velocity.
    Run {
        /// Signed, in increments per second.
        velocity: f64,
        /// In increments per second squared.
        acceleration: f64,
    },
    /// Move to a position.
    GoTo {
        /// Where.
        target: Position,
        /// In increments per second.
        velocity: f64,
        /// In increments per second squared.
        acceleration: f64,
    },
    /// Follow-up: the setpoint is the actual value.
    Track,
    /// The setpoint stays.
    Hold,
}

impl Motion {
    /// A movement that an override of 0 % holds.
    #[must_use]
    pub fn is_held(&self) -> bool {
        match *self {
            Self::Run { velocity, .. } | Self::GoTo { velocity, .. } => velocity.abs() <= 0.0,
            Self::Brake { .. } | Self::Track | Self::Hold => false,
        }
    }

    /// One cycle of it on a setpoint. `actual` is the actual value for [`Motion::Track`]; `hold` is the deceleration, in increments per
    /// second squared, of a movement that an override of 0 % holds; `cycle` is in seconds. Returns whether the target of a
    /// [`Motion::GoTo`] is reached and the setpoint rests on it.
    pub fn execute(self, setpoint: &mut Setpoint, actual: Position, hold: f64, cycle: f64) -> bool {
        match self {
            Self::Brake { deceleration } => setpoint.run(0.0, deceleration, cycle),
            Self::Run { velocity, acceleration } => setpoint.run(velocity, acceleration, cycle),
            Self::GoTo { target, velocity, acceleration } if velocity > 0.0 => {
                return setpoint.go_to(target, Limits { velocity, acceleration }, cycle);
            }
            Self::GoTo { .. } => setpoint.run(0.0, hold, cycle),
            Self::Track => *setpoint = Setpoint::at(actual),
            Self::Hold => *setpoint = Setpoint::at(setpoint.position),
        }
        false
    }

    /// It passes the jerk filter by: a braking harder than `hardest`, the hardest acceleration of the axis, or no movement at all.
    #[must_use]
    pub fn is_fast(self, hardest: f64) -> bool {
        match self {
            Self::Brake { deceleration } => deceleration > hardest,
            Self::Track | Self::Hold => true,
            Self::Run { .. } | Self::GoTo { .. } => false,
        }
    }

    /// The acceleration with which it sets off.
    #[must_use]
    pub fn acceleration(self) -> Option<f64> {
        match self {
            Self::Run { acceleration, .. } | Self::GoTo { acceleration, .. } => Some(acceleration),
            Self::Brake { .. } | Self::Track | Self::Hold => None,
        }
    }

    /// The direction that is commanded: +1, −1, or 0.
    #[must_use]
    pub fn direction(&self, from: Position) -> i8 {
        let sign = match *self {
            Self::Run { velocity, .. } => velocity,
            Self::GoTo { target, velocity, .. } if velocity > 0.0 => (target - from).increments() as f64,
            Self::GoTo { .. } | Self::Brake { .. } | Self::Track | Self::Hold => 0.0,
        };
        if sign > 0.0 {
            1
        } else if sign < 0.0 {
            -1
        } else {
            0
        }
    }
}
