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
            let limit = Input::Datum(36200, Some(number), parameters.entered_velocity(set.velocity_limit));
            let inputs = [axis.measured_velocity(number), limit, Input::None];
            self.raise_monitoring(alarms::ACTUAL_VELOCITY, number, Rule::VelocityMonitoring, inputs);
        }
        if too_long {
            #[expect(clippy::cast_possible_truncation, reason = "a velocity for display; the cast saturates")]
            let commanded = Input::Length(Quantity::VelocityCommand, number, Position::new(wanted as i64));
            // The datum is a percentage of the rated speed.
            let percent = Input::Datum(36210, Some(number), limits.speed_setpoint_percent);
            let inputs = [commanded, percent, Input::None];
            self.raise_monitoring(alarms::SPEED_SETPOINT, number, Rule::SpeedSetpointMonitoring, inputs);
        }
    }
}
