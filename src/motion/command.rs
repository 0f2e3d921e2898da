//! The motion command of an axis in one cycle: brake, run, go to a position, be where the path is, follow the actual value, or hold.

use serde::{Deserialize, Serialize};

use super::{Limits, Setpoint};
use crate::units::Position;

/// The motion command of an axis in one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Motion {
    /// Brakes to standstill.
    Brake {
        /// In increments per second squared.
        deceleration: f64,
    },
    /// Moves at a velocity.
    Run {
        /// Signed, in increments per second.
        velocity: f64,
        /// In increments per second squared.
        acceleration: f64,
    },
    /// Moves to a position.
    GoTo {
        /// Target position.
        target: Position,
        /// In increments per second.
        velocity: f64,
        /// In increments per second squared.
        acceleration: f64,
    },
    /// Is at this position at the end of the cycle: the path of a program interpolates it.
    Interpolated {
        /// The position.
        position: Position,
        /// The velocity of the axis in this cycle, signed, in increments per second.
        velocity: f64,
    },
    /// Follow-up: the setpoint is the actual value.
    Track,
    /// The setpoint does not change.
    Hold,
}

impl Motion {
    /// Whether an override of 0 % holds the movement.
    #[must_use]
    pub fn is_held(&self) -> bool {
        match *self {
            Self::Run { velocity, .. } | Self::GoTo { velocity, .. } => velocity.abs() <= 0.0,
            Self::Brake { .. } | Self::Interpolated { .. } | Self::Track | Self::Hold => false,
        }
    }

    /// Executes the command on a setpoint for one cycle. `actual` is the actual value for [`Motion::Track`]. `hold` is the deceleration, in
    /// increments per second squared, of a movement that an override of 0 % holds. `cycle` is in seconds. Returns true when the setpoint is
    /// at rest on the target of a [`Motion::GoTo`].
    pub fn execute(self, setpoint: &mut Setpoint, actual: Position, hold: f64, cycle: f64) -> bool {
        match self {
            Self::Brake { deceleration } => setpoint.run(0.0, deceleration, cycle),
            Self::Run { velocity, acceleration } => setpoint.run(velocity, acceleration, cycle),
            Self::GoTo { target, velocity, acceleration } if velocity > 0.0 => {
                return setpoint.go_to(target, Limits { velocity, acceleration }, cycle);
            }
            Self::GoTo { .. } => setpoint.run(0.0, hold, cycle),
            Self::Interpolated { position, velocity } => setpoint.lead(position, velocity),
            Self::Track => *setpoint = Setpoint::at(actual),
            Self::Hold => *setpoint = Setpoint::at(setpoint.position),
        }
        false
    }

    /// Whether the command bypasses the jerk filter: it brakes harder than `hardest`, the largest acceleration of the axis, or it is no
    /// movement.
    #[must_use]
    pub fn is_fast(self, hardest: f64) -> bool {
        match self {
            Self::Brake { deceleration } => deceleration > hardest,
            // The path has the limits of its axes already.
            Self::Interpolated { .. } | Self::Track | Self::Hold => true,
            Self::Run { .. } | Self::GoTo { .. } => false,
        }
    }

    /// The acceleration at the start of the movement.
    #[must_use]
    pub fn acceleration(self) -> Option<f64> {
        match self {
            Self::Run { acceleration, .. } | Self::GoTo { acceleration, .. } => Some(acceleration),
            Self::Brake { .. } | Self::Interpolated { .. } | Self::Track | Self::Hold => None,
        }
    }

    /// The commanded direction: +1, −1, or 0.
    #[must_use]
    pub fn direction(&self, from: Position) -> i8 {
        let sign = match *self {
            Self::Run { velocity, .. } | Self::Interpolated { velocity, .. } => velocity,
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
