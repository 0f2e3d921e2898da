//! Position control: the velocity that an axis wants from where it is, and what of it the drive is given.
//!
//! The machine asks for it in every position-control cycle; contour monitoring asks for its ideal axis, and speed monitoring
//! for what was wanted before MD36210 limited it.

use super::axis::Axis;
use super::parameters::AxisParameters;
use crate::motion::velocity_command;
use crate::units::Position;

/// The velocity that position control asks for at this actual value, in part `part` of `count` of the interpolation cycle.
#[must_use]
pub(super) fn velocity_wanted(
    axis: &Axis,
    parameters: &AxisParameters,
    actual: Position,
    half_count: Position,
    part: u32,
    count: u32,
) -> f64 {
    let setpoint = if part == count {
        axis.setpoint.position
    } else {
        let way = (axis.setpoint.position - axis.before).increments();
        axis.before + Position::new(way * i64::from(part) / i64::from(count))
    };
    velocity_command(setpoint - actual, parameters.gain, half_count, axis.setpoint.velocity(), 0.0)
}

/// What of it the drive is given: MD36210.
#[must_use]
pub(super) fn limited(velocity: f64, parameters: &AxisParameters) -> f64 {
    let limit = parameters.monitoring.speed_setpoint_limit;
    velocity.clamp(-limit, limit)
}
