//! The signals of a spindle: DB31.DBX60.0, 82 to 90.

use crate::image::axis_from_nck;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::spindle::REVOLUTION_PER_MINUTE;
use crate::sinumerik::publish::rows::{Rows, Why};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::spindle::state::Mode;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::Input;

impl State {
    /// The event with which a spindle went into speed control in this cycle: it does not count for its channel any more (S-02).
    pub(super) fn opened_loop(&self, number: AxisNumber) -> Option<Why> {
        let spindle = self.spindles[number].as_deref().filter(|_| self.axes[number].speed_controlled)?;
        self.of_this_cycle([spindle.mode_cause])
    }

    pub(super) fn show_spindle(&self, number: AxisNumber, parameters: &Parameters, rows: &mut impl Rows) {
        let own = &parameters.axes[number];
        let (Some(spindle), Some(data)) = (self.spindles[number].as_deref(), own.spindle.as_deref()) else { return };
        let axis = &self.axes[number];
        let mode = || Why::Event(spindle.mode_cause);
        let gear = || Why::Event(spindle.gear_cause);
        rows.number(axis_from_nck::setpoint_gear_stage, spindle.wanted_stage, gear);
        rows.bit(axis_from_nck::change_gear_stage, spindle.change.is_some(), gear);
        let oscillates = spindle.oscillates();
        let oscillation = || self.of_this_cycle([spindle.oscillation_cause, spindle.gear_cause]).unwrap_or_else(mode);
        rows.bit(axis_from_nck::oscillation_mode, oscillates, oscillation);
        let is_spindle = spindle.mode != Mode::Axis || axis.speed_controlled;
        rows.bit(axis_from_nck::spindle_no_axis, is_spindle, mode);
        let stage = data.stage(spindle.gear_stage);
        let movement = || axis.causes.movement().max(spindle.cause);
        let measured = || axis.measured_velocity(number);
        let largest = data.speed_limit.min(stage.maximum_speed);
        let exceeded = axis.velocity.abs() > largest * (1.0 + data.tolerance);
        let tolerance = || Input::Datum(35150, Some(number), data.tolerance);
        rows.bit(axis_from_nck::speed_limit_exceeded, exceeded, || {
            let limit = if data.speed_limit < stage.maximum_speed {
                Input::Datum(35100, Some(number), data.speed_limit / REVOLUTION_PER_MINUTE)
            } else {
                Input::Element(35130, spindle.gear_stage.max(1), number, stage.maximum_speed / REVOLUTION_PER_MINUTE)
            };
            Why::Tested(Rule::SpeedExceeded, [measured(), limit, tolerance()], movement())
        });
        let limits = || Why::Event(spindle.limit_cause);
        rows.bit(axis_from_nck::setpoint_speed_limited, spindle.limited, limits);
        rows.bit(axis_from_nck::setpoint_speed_increased, spindle.raised, limits);
        let in_range = spindle.mode == Mode::Control && self.is_in_speed_range(number, parameters);
        rows.bit(axis_from_nck::spindle_in_setpoint_range, in_range, || {
            if spindle.mode != Mode::Control && self.log.is_of_this_cycle(spindle.mode_cause) {
                return mode();
            }
            if spindle.commanded == 0.0 && spindle.holder != Input::None {
                // While the controllers are switched on one after the other, 61.6 is 1 before the axis is ready to be moved.
                let missing = axis_signal(number, axis_from_nck::speed_controller_active, false);
                let [_, speed_controller, _] = axis.enabling.controllers();
                let is_past = spindle.holder == missing && speed_controller;
                let holder = if is_past { Input::None } else { spindle.holder };
                return Why::Tested(Rule::SpindleHeld, [holder, Input::None, Input::None], movement());
            }
            Why::Tested(Rule::SpeedReached, [measured(), tolerance(), Input::None], movement())
        });
        let clockwise = axis.velocity >= own.standstill_velocity;
        rows.bit(axis_from_nck::actual_direction_of_rotation_clockwise, clockwise, || {
            Why::Tested(Rule::SpindleDirection, [measured(), Input::None, Input::None], movement())
        });
        let positioning = matches!(spindle.mode, Mode::Positioning(_));
        rows.bit(axis_from_nck::positioning_mode, positioning, mode);
        rows.bit(axis_from_nck::control_mode, is_spindle && !positioning && !oscillates, || {
            self.of_this_cycle([spindle.mode_cause]).unwrap_or_else(oscillation)
        });
        rows.bit(axis_from_nck::spindle_in_position, spindle.is_in_position(), || Why::Event(spindle.position_cause));
        let functions = || Why::Event(spindle.function_cause);
        let (m, s) = (axis_from_nck::spindle_m_function, axis_from_nck::spindle_s_function);
        rows.bytes(m.byte, &spindle.m_function.to_be_bytes(), functions);
        rows.bytes(s.byte, &spindle.s_function.to_be_bytes(), functions);
    }
}
