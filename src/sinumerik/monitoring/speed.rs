//! Velocity monitoring of an axis: actual velocity (25030) and speed setpoint (25060).
//!
//! The actual velocity is monitored while a measuring system is active, whatever the cause of the motion. The speed setpoint from position
//! control to the drive is limited to MD36210 in every position-control cycle
//! ([`limited`](crate::sinumerik::axis::position_control::limited)). The setpoint without this limit is compared once per interpolation
//! cycle, with the encoder value at its end.

use crate::sinumerik::alarms;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{Input, Quantity};

impl State {
    pub(in crate::sinumerik) fn monitor_speed(&mut self, number: AxisNumber, parameters: &AxisParameters) {
        let limits = &parameters.monitoring;
        let axis = &mut self.axes[number];
        let set = axis.active_set(parameters);
        let velocity = axis.velocity;
        let resting =
            axis.setpoint.is_at_rest() && axis.setpoint.position == axis.actual || axis.signals.withholds_setpoint();
        let wanted = if resting || !axis.enabling.is_powered() {
            0.0
        } else {
            let wanted = || axis.velocity_wanted(set, axis.setpoint.position, axis.actual, axis.half_count);
            axis.speed_command().unwrap_or_else(wanted)
        };
        let limited = wanted.abs() > limits.speed_setpoint_limit;
        axis.monitor.limited_cycles =
            if limited { (axis.monitor.limited_cycles + 1).min(limits.speed_setpoint_cycles + 1) } else { 0 };
        let too_long = axis.monitor.limited_cycles > limits.speed_setpoint_cycles;
        // MD35100 limits a spindle, not MD36200.
        if velocity.abs() > set.velocity_limit && parameters.spindle.is_none() {
            let measured = (Quantity::Velocity, velocity);
            let inputs = velocities(number, measured, 36200, set.velocity_limit);
            self.raise_monitoring(alarms::ACTUAL_VELOCITY, number, Rule::VelocityMonitoring, inputs);
        }
        if too_long {
            let commanded = (Quantity::VelocityCommand, wanted);
            let [commanded, ..] = velocities(number, commanded, 36210, limits.speed_setpoint_limit);
            // The datum is a percentage of the rated speed.
            let percent = Input::Datum(36210, Some(number), limits.speed_setpoint_percent);
            let inputs = [commanded, percent, Input::None];
            self.raise_monitoring(alarms::SPEED_SETPOINT, number, Rule::SpeedSetpointMonitoring, inputs);
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "velocities for display; the cast saturates")]
fn velocities(number: AxisNumber, (quantity, velocity): (Quantity, f64), datum: u32, limit: f64) -> [Input; 3] {
    let measured = Input::Length(quantity, number, Position::new(velocity as i64));
    [measured, Input::Datum(datum, Some(number), limit * 60.0 / Position::PER_USER_UNIT), Input::None]
}
