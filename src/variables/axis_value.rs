//! Values beside signals, as scenarios and traces name them: `X.position`, `XF.synchronism_difference`.

use std::fmt;

use super::Variables;
use crate::units::AxisNumber;

/// What can be asked of a machine axis beside its signals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AxisValue {
    /// Actual value shown, in mm or degrees.
    Position,
    /// Setpoint, in mm or degrees.
    Setpoint,
    /// Actual velocity, in mm/min or rev/min.
    Velocity,
    /// Setpoint minus actual value, in mm or degrees.
    FollowingError,
    /// True position of the slide, in mm or degrees.
    Slide,
    /// Actual value minus ideal position of a synchronous axis, in mm or degrees.
    SynchronismDifference,
    /// Actual value of encoder 1, in mm or degrees, whether it is active or not.
    Encoder1,
    /// Actual value of encoder 2, as encoder 1.
    Encoder2,
    /// The way that is left of a movement that has an end, in mm or degrees, with its sign.
    DistanceToGo,
}

impl AxisValue {
    /// All of them, in the order of the manual's service view.
    pub const ALL: [Self; 9] = [
        Self::Position,
        Self::Setpoint,
        Self::Velocity,
        Self::FollowingError,
        Self::Slide,
        Self::SynchronismDifference,
        Self::Encoder1,
        Self::Encoder2,
        Self::DistanceToGo,
    ];

    /// The name behind the axis name.
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
        }
    }

    /// The value of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|value| value.name() == name)
    }

    /// What it is on this axis now.
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
        }
    }
}

impl fmt::Display for AxisValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Six decimals, and never a minus before zero.
#[must_use]
pub fn six_decimals(value: f64) -> String {
    let text = format!("{value:.6}");
    if text == "-0.000000" { "0.000000".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_found_by_its_name_and_nothing_else_is() {
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
