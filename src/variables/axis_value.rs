//! Axis values in addition to signals, with their names in scenarios and traces: `X.position`, `XF.synchronism_difference`. The difference of
//! a coupled axis has the name that its control uses.

use super::Variables;
use crate::image::Interface;
use crate::units::AxisNumber;

/// A value of a machine axis that is not a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AxisValue {
    /// Displayed actual value, in mm or degrees.
    Position,
    /// Setpoint, in mm or degrees.
    Setpoint,
    /// Actual velocity, in mm/min; of a rotary axis in the unit of its control.
    Velocity,
    /// Setpoint minus actual value, in mm or degrees.
    FollowingError,
    /// True position of the simulated slide, in mm or degrees.
    Slide,
    /// Actual value minus ideal position of a coupled axis, in mm or degrees.
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

    /// The name after the axis name, on a control with this interface.
    #[must_use]
    pub const fn name(self, interface: &Interface) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Setpoint => "setpoint",
            Self::Velocity => "velocity",
            Self::FollowingError => "following_error",
            Self::Slide => "slide",
            Self::SynchronismDifference => interface.values().difference,
            Self::Encoder1 => "encoder_1",
            Self::Encoder2 => "encoder_2",
            Self::DistanceToGo => "distance_to_go",
            Self::EncoderCompensation => "encoder_compensation",
            Self::SetpointCompensation => "setpoint_compensation",
        }
    }

    /// The names of all values, on a control with this interface.
    #[must_use]
    pub fn names(interface: &Interface) -> [&'static str; 11] {
        Self::ALL.map(|value| value.name(interface))
    }

    /// What it is, with its unit, on a control with this interface.
    #[must_use]
    pub const fn meaning(self, interface: &Interface) -> &'static str {
        match self {
            Self::Position => "Displayed actual value, in mm or degrees.",
            Self::Setpoint => "Setpoint, in mm or degrees.",
            Self::Velocity => interface.values().velocity_meaning,
            Self::FollowingError => "Setpoint minus actual value, in mm or degrees.",
            Self::Slide => "True position of the simulated slide, in mm or degrees.",
            Self::SynchronismDifference => interface.values().difference_meaning,
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

    /// The value with this name. The difference of a coupled axis has one value and a name on each control, and both are read.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "position" => Self::Position,
            "setpoint" => Self::Setpoint,
            "velocity" => Self::Velocity,
            "following_error" => Self::FollowingError,
            "slide" => Self::Slide,
            "synchronism_difference" | "gantry_difference" => Self::SynchronismDifference,
            "encoder_1" => Self::Encoder1,
            "encoder_2" => Self::Encoder2,
            "distance_to_go" => Self::DistanceToGo,
            "encoder_compensation" => Self::EncoderCompensation,
            "setpoint_compensation" => Self::SetpointCompensation,
            _ => return None,
        })
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

/// Formats with six decimals; a zero has no minus sign.
#[must_use]
pub fn six_decimals(value: f64) -> String {
    let text = format!("{value:.6}");
    if text == "-0.000000" { "0.000000".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::SINUMERIK;

    #[test]
    fn only_the_name_of_a_value_is_found() {
        for (value, name) in AxisValue::ALL.into_iter().zip(AxisValue::names(&SINUMERIK)) {
            assert_eq!(AxisValue::named(name), Some(value));
        }
        assert_eq!(AxisValue::named("Position"), None);
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(six_decimals(-0.000_000_1), "0.000000");
        assert_eq!(six_decimals(-0.941), "-0.941000");
    }
}
