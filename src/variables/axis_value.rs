//! Axis values in addition to signals, with their names in scenarios and traces: `X.position`, `XF.synchronism_difference`.

use std::fmt;

use super::Variables;
use crate::units::AxisNumber;

/// A value of a machine axis that is not a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AxisValue {
    /// Displayed actual value, in mm or degrees.
    Position,
    /// Setpoint, in mm or degrees.
    Setpoint,
    /// Actual velocity, in mm/min or rev/min.
    Velocity,
    /// Setpoint minus actual value, in mm or degrees.
    FollowingError,
    /// True position of the simulated slide, in mm or degrees.
    Slide,
    /// Actual value minus ideal position of a synchronous axis, in mm or degrees.
    SynchronismDifference,
    /// Actual value of encoder 1, in mm or degrees, active or not.
    Encoder1,
    /// Actual value of encoder 2, in mm or degrees, active or not.
    Encoder2,
    /// Remaining distance of a movement with a target, in mm or degrees, with sign.
    DistanceToGo,
    /// Compensation of the active encoder (leadscrew error, backlash), in mm or degrees.
    EncoderCompensation,
    /// Compensation of the setpoint (sag, temperature), in mm or degrees.
    SetpointCompensation,
}

impl AxisValue {
    /// All values, in the order of the service view of the manual.
    pub const ALL: [Self; 11] = [
        Self::Position,
        Self::Setpoint,
        Self::Velocity,
        Self::FollowingError,
        Self::Slide,
        Self::SynchronismDifference,
        Self::Encoder1,
        Self::Encoder2,
        Self::DistanceToGo,
        Self::EncoderCompensation,
        Self::SetpointCompensation,
    ];

    /// The name after the axis name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Setpoint => "setpoint",
            Self::Velocity => "velocity",
            Self::FollowingError => "following_error",
            Self::Slide => "slide",
            Self::SynchronismDifference => "synchronism_difference",
            Self::Encoder1 => "encoder_1",
            Self::Encoder2 => "encoder_2",
            Self::DistanceToGo => "distance_to_go",
            Self::EncoderCompensation => "encoder_compensation",
            Self::SetpointCompensation => "setpoint_compensation",
        }
    }

    /// What it is, with its unit.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Position => "Displayed actual value, in mm or degrees.",
            Self::Setpoint => "Setpoint, in mm or degrees.",
            Self::Velocity => "Actual velocity, in mm/min or rev/min.",
            Self::FollowingError => "Setpoint minus actual value, in mm or degrees.",
            Self::Slide => "True position of the simulated slide, in mm or degrees.",
            Self::SynchronismDifference => "Actual value minus ideal position of a synchronous axis, in mm or degrees.",
            Self::Encoder1 => "Actual value of encoder 1, in mm or degrees, active or not.",
            Self::Encoder2 => "Actual value of encoder 2, in mm or degrees, active or not.",
            Self::DistanceToGo => "Remaining distance of a movement with a target, in mm or degrees, with sign.",
            Self::EncoderCompensation => {
                "Compensation of the active encoder (leadscrew error and backlash), in mm or degrees; part of the actual value."
            }
            Self::SetpointCompensation => {
                "Compensation of the setpoint (sag and temperature), in mm or degrees; not part of the displayed values."
            }
        }
    }

    /// The value with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        // What a control with masters and slaves calls the same value.
        let name = if name == "gantry_difference" { "synchronism_difference" } else { name };
        Self::ALL.into_iter().find(|value| value.name() == name)
    }

    /// The value of this axis now.
    #[must_use]
    pub fn of(self, axis: AxisNumber, variables: &Variables) -> f64 {
        let values = &variables.axes[axis];
        match self {
            Self::Position => values.position.user(),
            Self::Setpoint => values.setpoint.user(),
            Self::Velocity => values.velocity,
            Self::FollowingError => values.following_error.user(),
            Self::Slide => values.slide.user(),
            Self::SynchronismDifference => values.synchronism_difference.user(),
            Self::Encoder1 => values.encoders[0].user(),
            Self::Encoder2 => values.encoders[1].user(),
            Self::DistanceToGo => values.distance_to_go.user(),
            Self::EncoderCompensation => values.encoder_compensation.user(),
            Self::SetpointCompensation => values.setpoint_compensation.user(),
        }
    }
}

impl fmt::Display for AxisValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Formats with six decimals; a zero has no minus sign.
#[must_use]
pub fn six_decimals(value: f64) -> String {
    let text = format!("{value:.6}");
    if text == "-0.000000" { "0.000000".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_name_of_a_value_is_found() {
        for value in AxisValue::ALL {
            assert_eq!(AxisValue::named(value.name()), Some(value));
        }
        assert_eq!(AxisValue::named("Position"), None);
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(six_decimals(-0.000_000_1), "0.000000");
        assert_eq!(six_decimals(-0.941), "-0.941000");
    }
}
