//! JOG: traversing keys with rapid traverse, override, feed stop and feed disable.
//!
//! Called once per cycle for each unit in the stage "referencing and gantry", while JOG is active without REF. Keys of
//! a synchronous axis of a closed grouping are ignored without alarm (MIS-01): only the first axis of a unit is asked.

use super::axis::Motion;
use super::log::axis_bit;
use super::parameters::Parameters;
use super::rules::Rule;
use super::{State, Unit};
use crate::image::{AxisToNck, ToNck};
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Place};

/// The direction of the traversing keys: +1, −1, or 0 for none, both, or keys that are disabled (4.4).
#[must_use]
pub(super) fn key_direction(signals: &AxisToNck) -> i8 {
    let (plus, minus) = (signals.traversing_key_plus(), signals.traversing_key_minus());
    match (plus, minus, signals.traversing_key_disable()) {
        (true, false, false) => 1,
        (false, true, false) => -1,
        _ => 0,
    }
}

impl State {
    /// What holds every movement of a unit: override factor 0, feed stop on any of its axes (SIG-06), feed disable.
    pub(super) fn take_feed(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let disabled = to_nck.channels[unit.channel].feed_disable();
        let stopped = unit.members().any(|axis| to_nck.axes[axis].feed_stop());
        for axis in unit.members() {
            let signals = &to_nck.axes[axis];
            // O-21: the axial override acts while 1.7 = 1, else 100 %.
            let factor =
                if signals.override_active() { parameters.axis_override(signals.feed_override()) } else { 1.0 };
            self.axes[axis].feed_factor = factor;
            self.axes[axis].feed_held = stopped || disabled;
            self.axes[axis].feed_disabled = disabled;
        }
    }

    /// Traversing keys of the unit's first axis.
    pub(super) fn jog(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        self.watch_software_limits(unit, parameters, to_nck);
        let signals = &to_nck.axes[number];
        let direction = key_direction(signals);
        let axis_parameters = &parameters.axes[number];
        let stopped = self.stop_cause(unit.channel, parameters);
        let axis = &mut self.axes[number];
        let velocity = if signals.rapid_traverse_override() {
            axis_parameters.jog_rapid_velocity
        } else {
            axis_parameters.jog_velocity
        };
        let velocity = (velocity * axis.feed_factor).min(axis_parameters.maximum_velocity);
        if let Some(cause) = stopped {
            // The unit brakes as it was told (O-04); what is wanted stays visible.
            self.traverse(number, direction, 0, cause);
            return;
        }
        if let Some(cause) = self.limited(unit, direction) {
            // Towards a pressed switch nothing moves; away from it everything does.
            self.brake_at_limit(unit, parameters);
            self.traverse(number, direction, 0, cause);
            return;
        }
        let axis = &mut self.axes[number];
        let held = axis.feed_held || velocity <= 0.0;
        let acceleration = axis_parameters.jog_acceleration;
        axis.motion = Motion::Brake { deceleration: acceleration };
        if direction != 0 && !held && axis.enabling.is_on() {
            let run = Motion::Run { velocity: velocity * f64::from(direction), acceleration };
            let Some(motion) = self.within_software_limit(number, run, direction, parameters, to_nck) else {
                let cause = self.axes[number].causes.motion;
                let event = self.log.note_plain(Place::Axis(number), Rule::SoftwareLimit, cause);
                self.traverse(number, direction, 0, event);
                return;
            };
            self.axes[number].motion = motion;
        }
        // Without controller enable the command stays pending and runs when the enable returns.
        let command = if held { 0 } else { direction };
        self.note_keys(number, direction, command, signals);
    }

    fn note_keys(&mut self, number: AxisNumber, request: i8, command: i8, signals: &AxisToNck) {
        let axis = &self.axes[number];
        if (axis.traverse_request, axis.traverse_command) == (request, command) {
            return;
        }
        let rule = if request == 0 {
            Rule::KeyReleased
        } else if command == 0 {
            Rule::MotionBlocked
        } else {
            Rule::TraversingKey
        };
        let event = self.log.note(Place::Axis(number), rule, key_inputs(number, signals), axis.causes.motion);
        self.traverse(number, request, command, event);
    }

    /// What is wanted (64.4, 64.5) and commanded (64.6, 64.7), with the event behind a change.
    pub(super) fn traverse(&mut self, number: AxisNumber, request: i8, command: i8, cause: EventId) {
        let axis = &mut self.axes[number];
        if (axis.traverse_request, axis.traverse_command) != (request, command) {
            axis.traverse_request = request;
            axis.traverse_command = command;
            axis.causes.motion = cause;
        }
    }
}

fn key_inputs(number: AxisNumber, signals: &AxisToNck) -> [Input; 3] {
    [
        axis_bit(number, 4, 7, signals.traversing_key_plus()),
        axis_bit(number, 4, 6, signals.traversing_key_minus()),
        if signals.feed_stop() { axis_bit(number, 4, 3, true) } else { Input::None },
    ]
}
