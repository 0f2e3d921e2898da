//! Position monitoring of an axis: standstill (25040), clamping (26000), positioning (25080) and contour (25050).
//!
//! Standstill: when MD36040 has passed since the end of interpolation, the actual value must stay within MD36030 × MD36012 of the setpoint.
//! This applies in position control and also in "hold" (2.1 = 0 without follow-up), where only an external force can move the axis. In
//! follow-up the setpoint is the actual value, and nothing is monitored. While 2.3 = 1 the tolerance is MD36050 (without MD36012) and the
//! alarm is 26000; the delay is the same.
//!
//! Positioning: exact stop fine must be reached within MD36020 after the end of interpolation, in position control. A reference point
//! approach and a synchronising motion monitor this themselves and end with 20005.
//!
//! Contour: the actual value is compared with an axis model, which receives the same setpoints, has the same gain, and has a drive without
//! delay. Position control updates the model in each of its cycles. An axis that brakes to be switched off has already been stopped and is
//! not compared. An axis whose setpoint is not output (1.3, 20.1) is not compared either.

use crate::sinumerik::alarms;
use crate::sinumerik::axis::controllers::ControllerState;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{Input, Quantity};

impl State {
    pub(in crate::sinumerik) fn monitor_position(&mut self, number: AxisNumber, parameters: &AxisParameters) {
        let follows_up = self.axes[number].enabling.follow_up;
        let actual = self.axes[number].actual;
        if follows_up || self.axes[number].speed_controlled {
            self.axes[number].monitor.restart(actual);
            return;
        }
        self.monitor_contour(number, parameters);
        let axis = &mut self.axes[number];
        if axis.setpoint_moves() {
            axis.monitor.moves();
            return;
        }
        let deviation = axis.deviation().abs();
        let set = axis.active_set(parameters);
        let (monitor, delay) = (&mut axis.monitor, parameters.monitoring.standstill_cycles);
        monitor.rest_cycles = (monitor.rest_cycles + 1).min(delay + 1);
        if monitor.rest_cycles > delay {
            let (alarm, tolerance, data, rule) = if monitor.clamped {
                let tolerance = parameters.monitoring.clamping_tolerance;
                let data = [Input::Datum(36050, Some(number), tolerance.user()), Input::None];
                (alarms::CLAMPING, tolerance, data, Rule::ClampingMonitoring)
            } else {
                let data = set.stop_limits.inputs(StopLimit::Standstill, number);
                (alarms::STANDSTILL, set.standstill_tolerance, data, Rule::StandstillMonitoring)
            };
            if deviation > tolerance {
                self.raise_monitoring(alarm, number, rule, deviates(number, deviation, data));
            }
        }
        self.monitor_positioning(number, deviation, parameters);
    }

    fn monitor_positioning(&mut self, number: AxisNumber, deviation: Position, parameters: &AxisParameters) {
        let axis = &mut self.axes[number];
        let set = axis.active_set(parameters);
        let (fine, data) = (set.exact_stop_fine, set.stop_limits.inputs(StopLimit::Fine, number));
        let (on, monitor) = (axis.enabling.is_on(), &mut axis.monitor);
        if !on {
            (monitor.positioning_cycles, monitor.in_position) = (0, false);
            return;
        }
        if monitor.in_position {
            return;
        }
        monitor.positioning_cycles = (monitor.positioning_cycles + 1).min(parameters.positioning_cycles + 1);
        let late = monitor.positioning_cycles > parameters.positioning_cycles;
        if deviation <= fine || self.watches_exact_stop_itself(number) {
            self.axes[number].monitor.in_position = true;
        } else if late {
            let inputs = deviates(number, deviation, data);
            self.raise_monitoring(alarms::POSITIONING, number, Rule::PositioningMonitoring, inputs);
        }
    }

    /// Whether a reference point approach or a synchronising motion is active, which ends with 20005.
    fn watches_exact_stop_itself(&self, number: AxisNumber) -> bool {
        let synchronises = self.groupings.iter().any(|grouping| {
            grouping.phase == Phase::Synchronising && grouping.coupling.members().any(|axis| axis == number)
        });
        synchronises || self.axes[number].approach.is_running()
    }

    fn monitor_contour(&mut self, number: AxisNumber, parameters: &AxisParameters) {
        let axis = &mut self.axes[number];
        if !axis.enabling.is_powered() || axis.signals.withholds_setpoint() {
            axis.monitor.restart_model(axis.actual);
            return;
        }
        let (difference, tolerance) =
            ((axis.monitor.model() - axis.actual).abs(), parameters.monitoring.contour_tolerance);
        if difference > tolerance && matches!(axis.enabling.control, ControllerState::On) {
            let measured = Input::Length(Quantity::ModelDeviation, number, difference);
            let inputs = [measured, Input::Datum(36400, Some(number), tolerance.user()), Input::None];
            self.raise_monitoring(alarms::CONTOUR, number, Rule::ContourMonitoring, inputs);
        }
    }
}

fn deviates(number: AxisNumber, deviation: Position, [datum, factor]: [Input; 2]) -> [Input; 3] {
    [Input::Length(Quantity::Deviation, number, deviation), datum, factor]
}
