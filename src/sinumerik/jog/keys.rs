//! JOG: traversing keys with rapid traverse, override, feed stop and feed disable.
//!
//! Called once per cycle for each unit in the stage "referencing and gantry", while JOG is active without REF. Keys of a
//! synchronous axis of a closed grouping are ignored without an alarm (MIS-01): only the keys of the first axis of a unit are
//! read. `increments.rs` defines the movements that a press of a key starts and ends, `handwheels.rs` those of handwheels.
//!
//! Traverse request (64.4, 64.5) shows the requested movement, traverse command (64.6, 64.7) the commanded one. Override 0 %,
//! feed stop, feed disable, RESET, an alarm that stops, and a limit reset the command and keep the request. A movement with an
//! end continues to it after feed stop, feed disable and 0 %; every other stop drops it.

use crate::image::{AxisToNck, Signal, ToNck, axis_from_nck, axis_to_nck, channel_to_nck};
use crate::motion::Motion;
use crate::sinumerik::axis::limits::Ahead;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::inputs::{axis_signal, channel_signal};
use crate::sinumerik::jog::handwheels;
use crate::sinumerik::jog::state::{By, Movement};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Place, Quantity};

/// The direction of the traversing keys: +1, −1, or 0 if no key, both keys or disabled keys (4.4) are pressed.
#[must_use]
pub(in crate::sinumerik) fn key_direction(signals: &AxisToNck) -> i8 {
    let (plus, minus) = (signals.traversing_key_plus(), signals.traversing_key_minus());
    match (plus, minus, signals.traversing_key_disable()) {
        (true, false, false) => 1,
        (false, true, false) => -1,
        _ => 0,
    }
}

/// The traversing key of a direction.
#[must_use]
pub(in crate::sinumerik) const fn key_signal(direction: i8) -> Signal {
    if direction > 0 { axis_to_nck::traversing_key_plus } else { axis_to_nck::traversing_key_minus }
}

impl State {
    /// Determines whether a movement of a unit is held: override factor 0, feed stop on any of its axes (SIG-06), feed disable.
    pub(in crate::sinumerik) fn take_feed(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let disabled = to_nck.channels[unit.channel].feed_disable();
        let stopper = unit.members().find(|&axis| to_nck.axes[axis].feed_stop());
        let stopped = stopper.is_some();
        let holder = stopper.map_or(Input::None, |axis| axis_signal(axis, axis_to_nck::feed_stop, true));
        let holder = if disabled { channel_signal(unit.channel, channel_to_nck::feed_disable, true) } else { holder };
        for axis in unit.members() {
            let signals = &to_nck.axes[axis];
            // O-21: the axial override acts while 1.7 = 1; otherwise it is 100 %.
            let factor =
                if signals.override_active() { parameters.axis_override(signals.feed_override()) } else { 1.0 };
            self.axes[axis].feed_factor = factor;
            let before = self.axes[axis].feed_holder;
            let released = match before {
                Input::Bit(signal, true) if !stopped && !disabled => Input::Bit(signal, false),
                _ => holder,
            };
            self.axes[axis].feed_held = stopped || disabled;
            self.axes[axis].feed_disabled = disabled;
            self.axes[axis].feed_holder = released;
        }
    }

    /// Traversing keys and handwheels of the unit's first axis.
    pub(in crate::sinumerik) fn jog(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        self.watch_software_limits(unit, parameters, to_nck);
        let (signals, axis_parameters) = (&to_nck.axes[number], &parameters.axes[number]);
        let key = key_direction(signals);
        let jogging = &mut self.axes[number].jogging;
        let way = jogging.function.way(axis_parameters);
        jogging.take_keys(key, signals.traversing_key_disable(), way, parameters.key_modes);
        self.take_handwheels(number, parameters, signals);
        self.raise_handwheel_alarms(number, key);
        let axis = &self.axes[number];
        if let Some(stop) = self.stop(unit.channel, parameters) {
            // The unit brakes as commanded (O-04).
            let (rule, input) = stop.tested();
            self.stop_jogging(number, parameters, signals, rule, [input, Input::None, Input::None], stop.cause());
            return;
        }
        let direction = axis.jogging.movement.direction(axis.setpoint.position);
        if let Some(pressed) = self.limited_by(unit, direction) {
            // Nothing moves towards a pressed switch; every movement away from it is permitted.
            self.brake_at_limit(unit, parameters);
            let limits = self.axes[pressed].limits;
            let inputs = [limits.input(pressed, direction), Input::None, Input::None];
            self.stop_jogging(number, parameters, signals, Rule::HardwareLimitSwitch, inputs, limits.cause);
            return;
        }
        if axis.signals.fast_stop {
            let shown = axis_signal(number, axis_from_nck::ramp_function_generator_disable_active, true);
            let (inputs, cause) = ([shown, Input::None, Input::None], axis.signals.fast_stop_cause);
            self.stop_jogging(number, parameters, signals, Rule::FastStop, inputs, cause);
            return;
        }
        self.axes[number].motion = Motion::Brake { deceleration: axis_parameters.jog_acceleration };
        let ended = self.axes[number].begin_or_end_way();
        let axis = &self.axes[number];
        let movement = axis.jogging.movement;
        if movement == Movement::None {
            self.show_jogging(number, 0, 0, if ended { Rule::EndReached } else { Rule::KeyReleased }, signals);
            return;
        }
        let direction = movement.direction(axis.setpoint.position);
        let velocity = axis.jog_velocity(axis_parameters, signals);
        let held = axis.feed_held || velocity <= 0.0;
        if !held && axis.enabling.is_on() {
            let ahead = self.software_limit_ahead(number, direction, parameters, to_nck);
            if direction != 0 && ahead == Ahead::Reached && !matches!(movement, Movement::Pending(..)) {
                self.rest_on_software_limit(number, direction, parameters, signals);
                return;
            }
            self.axes[number].follow_keys(direction, velocity, ahead, axis_parameters.jog_acceleration);
        }
        // Without controller enable the command stays pending and runs when the enable returns.
        let command = if held { 0 } else { direction };
        let rule = match movement {
            Movement::None | Movement::Path(..) if direction == 0 => Rule::EndReached,
            Movement::None | Movement::Continuous(_) => Rule::TraversingKey,
            Movement::Pending(_, By::Key(_)) | Movement::Path(_, By::Key(_)) => Rule::IncrementStarted,
            Movement::Pending(_, By::Handwheel) | Movement::Path(_, By::Handwheel) => Rule::HandwheelTurned,
        };
        self.show_jogging(number, direction, command, if held { Rule::MotionBlocked } else { rule }, signals);
    }

    /// Stops by this rule. A movement with an end is dropped; the request of a held key stays visible.
    fn stop_jogging(
        &mut self,
        number: AxisNumber,
        parameters: &Parameters,
        signals: &AxisToNck,
        rule: Rule,
        inputs: [Input; 3],
        cause: EventId,
    ) {
        let axis = &mut self.axes[number];
        if !(parameters.key_modes.continuous_held && matches!(axis.jogging.movement, Movement::Continuous(_))) {
            axis.jogging.movement = Movement::None;
        }
        let request = axis.jogging.movement.direction(axis.setpoint.position);
        if axis.traverse_command == 0 && axis.traverse_request != request {
            // The axis is already at standstill: only the request changes.
            let rule = if request == 0 { Rule::KeyReleased } else { Rule::MotionBlocked };
            let event = self.log.note(Place::Axis(number), rule, key_inputs(number, axis, signals), cause);
            self.traverse(number, request, 0, event);
        } else if (axis.traverse_request, axis.traverse_command) != (request, 0) {
            let cause = self.log.now(Place::Axis(number), cause, rule, inputs);
            self.traverse(number, request, 0, cause);
        }
    }

    fn rest_on_software_limit(
        &mut self,
        number: AxisNumber,
        direction: i8,
        parameters: &Parameters,
        signals: &AxisToNck,
    ) {
        let axis = &self.axes[number];
        let mut cause = axis.causes.motion;
        let reached = Input::Length(Quantity::Position, number, axis.setpoint.position);
        let inputs = [reached, Input::None, Input::None];
        if (axis.traverse_request, axis.traverse_command) != (direction, 0) {
            cause = self.log.note(Place::Axis(number), Rule::SoftwareLimit, inputs, cause);
        }
        self.stop_jogging(number, parameters, signals, Rule::SoftwareLimit, inputs, cause);
    }

    fn show_jogging(&mut self, number: AxisNumber, request: i8, command: i8, rule: Rule, signals: &AxisToNck) {
        let axis = &self.axes[number];
        if (axis.traverse_request, axis.traverse_command) == (request, command) {
            return;
        }
        let event = if axis.jogging.movement.is_by_handwheel() {
            self.log.note_plain(Place::Axis(number), rule, axis.jogging.handwheel_cause)
        } else {
            // The event that starts a movement does not depend on the previous movement.
            let begins = axis.traverse_request == 0;
            let parent = if begins { EventId::NONE } else { axis.causes.motion };
            self.log.note(Place::Axis(number), rule, key_inputs(number, axis, signals), parent)
        };
        self.traverse(number, request, command, event);
    }
}

impl Axis {
    /// Starts a waiting distance and ends one whose target is reached. Returns whether one ended. An increment begins at
    /// standstill.
    fn begin_or_end_way(&mut self) -> bool {
        let rests = self.setpoint.is_at_rest();
        if let Movement::Pending(way, by) = self.jogging.movement
            && self.enabling.is_on()
            && (rests || by == By::Handwheel)
        {
            self.jogging.movement = Movement::Path(self.setpoint.position + way, by);
        }
        let ended =
            matches!(self.jogging.movement, Movement::Path(target, _) if rests && self.setpoint.position == target);
        if ended {
            self.jogging.movement = Movement::None;
        }
        ended
    }

    /// Velocity of keys or handwheels, with the override.
    fn jog_velocity(&self, parameters: &AxisParameters, signals: &AxisToNck) -> f64 {
        let of_keys =
            if signals.rapid_traverse_override() { parameters.jog_rapid_velocity } else { parameters.jog_velocity };
        if self.jogging.movement.is_by_handwheel() {
            handwheels::velocity(parameters, of_keys, self.feed_factor)
        } else {
            (of_keys * self.feed_factor).min(parameters.maximum_velocity)
        }
    }

    /// Commands the movement. A distance that leads beyond a software limit is dropped.
    fn follow_keys(&mut self, direction: i8, velocity: f64, ahead: Ahead, acceleration: f64) {
        self.motion = match (self.jogging.movement, ahead) {
            (Movement::None | Movement::Pending(..), _) => return,
            (Movement::Continuous(_), Ahead::At(target)) => Motion::GoTo { target, velocity, acceleration },
            (Movement::Continuous(_), Ahead::Free | Ahead::Reached) => {
                Motion::Run { velocity: velocity * f64::from(direction), acceleration }
            }
            (Movement::Path(target, by), ahead) => {
                let target = match ahead {
                    Ahead::At(limit) if (target > limit) == (direction > 0) => limit,
                    Ahead::At(_) | Ahead::Free | Ahead::Reached => target,
                };
                self.jogging.movement = Movement::Path(target, by);
                Motion::GoTo { target, velocity, acceleration }
            }
        };
    }
}

/// The keys, and the signals of the axis itself that hold its movement.
fn key_inputs(number: AxisNumber, axis: &Axis, signals: &AxisToNck) -> [Input; 3] {
    let holds = if signals.feed_stop() {
        axis_signal(number, axis_to_nck::feed_stop, true)
    } else if axis.feed_factor <= 0.0 {
        // The effective override is 0 %.
        axis_signal(number, axis_to_nck::override_active, true)
    } else {
        axis.feed_holder
    };
    [
        axis_signal(number, axis_to_nck::traversing_key_plus, signals.traversing_key_plus()),
        axis_signal(number, axis_to_nck::traversing_key_minus, signals.traversing_key_minus()),
        holds,
    ]
}
