//! JOG: traversing keys with rapid traverse, override, feed stop and feed disable.
//!
//! Called once per cycle for each unit in the stage "referencing and gantry", while JOG is active without REF. Keys of a
//! synchronous axis of a closed grouping are ignored without an alarm (MIS-01): only the keys of the first axis of a unit are
//! read. `increments.rs` defines the movements that a press of a key starts and ends, `handwheels.rs` those of handwheels.
//!
//! A movement begins with the rising edge of a key. Decision O-26: feed stop, feed disable, an override of 0 % and the fast stop only
//! hold the movement of a key that stays pressed. RESET, emergency stop, an alarm that stops, a hardware limit switch, another mode,
//! machine function or increment, a lost enable, key disable (4.4) and the opposite key end it; it begins again only with a new rising
//! edge. A key that is pressed while an enable is missing stays pending, and moves when the enable comes. An edge during one of these
//! interruptions is lost. A movement with an end continues to it after feed stop, feed disable and 0 %; everything else drops it.

use crate::image::{AxisToNck, Signal, ToNck, axis_from_nck, axis_to_nck};
use crate::motion::Motion;
use crate::sinumerik::alarms;
use crate::sinumerik::axis::limits::Ahead;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::axis::traversing::keys;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::jog::handwheels::{self, active_handwheel};
use crate::sinumerik::jog::state::{By, Movement};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::sinumerik::user::state::ended;
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Parameter, Place, Quantity};

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
        let feed_disable = self.feed_disable(unit.channel, to_nck);
        let disabled = feed_disable.is_some();
        let stopper = unit.members().find(|&axis| to_nck.axes[axis].feed_stop());
        let stopped = stopper.is_some();
        let holder = stopper.map_or(Input::None, |axis| axis_signal(axis, axis_to_nck::feed_stop, true));
        let holder = feed_disable.unwrap_or(holder);
        for axis in unit.members() {
            let signals = &to_nck.axes[axis];
            self.axes[axis].feed_override = signals.feed_override();
            self.axes[axis].override_is_active = signals.override_active();
            self.axes[axis].feed_factor = parameters.axis_override(signals.feed_override(), signals.override_active());
            let before = self.axes[axis].feed_holder;
            let released = match before {
                Input::Bit(signal, true) if !stopped && !disabled => Input::Bit(signal, false),
                Input::Alarm(number) if !stopped && !disabled => ended(number),
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
        let stop = self.stop(unit.channel, parameters);
        // The first axis of the unit that is not in position control: none of them moves without the others (DYN-01, SIG-01).
        let off = self.not_in_control(unit);
        let enabled = self.interrupt_keys(unit, off, stop.is_some(), to_nck);
        let jogging = &mut self.axes[number].jogging;
        let way = jogging.function.way(axis_parameters);
        jogging.take_keys(key, signals.traversing_key_disable(), way, parameters.key_modes);
        self.take_handwheels(number, off, parameters, signals);
        self.watch_keys_and_handwheels(number, key, signals);
        let axis = &self.axes[number];
        if let Some(stop) = stop {
            // The unit brakes as commanded (O-04).
            let (rule, input) = stop.tested();
            self.stop_jogging(number, rule, [input, Input::None, Input::None], stop.cause());
            return;
        }
        let direction = axis.jogging.movement.direction(axis.setpoint.position);
        if let Some(pressed) = self.limited_by(unit, direction) {
            // Nothing moves towards a pressed switch; every movement away from it is permitted.
            self.brake_at_limit(unit, parameters);
            let limits = self.axes[pressed].limits;
            let inputs = [limits.input(pressed, direction), Input::None, Input::None];
            self.stop_jogging(number, Rule::HardwareLimitSwitch, inputs, limits.cause);
            return;
        }
        if axis.signals.fast_stop {
            let shown = axis_signal(number, axis_from_nck::ramp_function_generator_disable_active, true);
            self.block_jogging(number, parameters, signals, Rule::FastStop, shown, axis.signals.fast_stop_cause);
            return;
        }
        self.axes[number].motion = Motion::Brake { deceleration: axis_parameters.jog_acceleration };
        let ended = self.axes[number].begin_or_end_way(off.is_none());
        let axis = &self.axes[number];
        let movement = axis.jogging.movement;
        if movement == Movement::None {
            let rule = if ended { Rule::EndReached } else { Rule::KeyReleased };
            self.show_jogging(number, Travel::None, rule, (off, enabled), signals);
            return;
        }
        if let Some(datum) = axis_parameters.immovable_by {
            self.refuse_movement(number, datum, parameters, signals);
            return;
        }
        let direction = movement.direction(axis.setpoint.position);
        let velocity = axis.jog_velocity(axis_parameters, signals);
        // A movement that is held, and one without an enable, waits (O-27).
        let moves = off.is_none() && !axis.feed_held && velocity > 0.0;
        if moves {
            let ahead = self.software_limit_ahead(number, direction, parameters, to_nck);
            if direction != 0 && ahead == Ahead::Reached && !matches!(movement, Movement::Pending(..)) {
                let reached = Input::Length(Quantity::Setpoint, number, axis.machine_setpoint());
                let barrier = self.barrier(unit, direction, parameters, to_nck);
                let rule = barrier.map_or(Rule::SoftwareLimit, |barrier| barrier.rule());
                self.block_jogging(number, parameters, signals, rule, reached, axis.causes.motion);
                return;
            }
            self.axes[number].follow_keys(direction, velocity, ahead, axis_parameters.jog_acceleration);
        }
        let travel = if moves { Travel::moving(direction) } else { Travel::waiting(direction) };
        let rule = match movement {
            Movement::None | Movement::Path(..) if direction == 0 => Rule::EndReached,
            Movement::None | Movement::Continuous(_) => Rule::TraversingKey,
            Movement::Pending(_, By::Key(_)) | Movement::Path(_, By::Key(_)) => Rule::IncrementStarted,
            Movement::Pending(_, By::Handwheel) | Movement::Path(_, By::Handwheel) => Rule::HandwheelTurned,
        };
        self.show_jogging(number, travel, rule, (off, enabled), signals);
    }

    fn not_in_control(&self, unit: &Unit) -> Option<AxisNumber> {
        unit.members().find(|axis| !self.axes[*axis].enabling.is_on())
    }

    /// O-26: a lost enable and another machine function or increment end the movement of a key. `off` is an axis that is not in position
    /// control. Returns the axis whose position control has come last, if the enables have come in this cycle.
    fn interrupt_keys(
        &mut self,
        unit: &Unit,
        off: Option<AxisNumber>,
        stopped: bool,
        to_nck: &ToNck,
    ) -> Option<AxisNumber> {
        let number = unit.leader();
        let on = off.is_none();
        let was_on = std::mem::replace(&mut self.axes[number].jogging.was_on, on);
        let lost = was_on && !on;
        let last = unit.members().max_by_key(|axis| self.axes[*axis].causes.enabling);
        let enabled = last.filter(|_| on && !was_on);
        let axis = &self.axes[number];
        if !axis.jogging.movement.is_by_key() {
            return enabled;
        }
        let cause = if self.log.is_of_this_cycle(axis.jogging.function_cause) {
            axis.jogging.function_cause
        } else if lost && !stopped {
            let parent = self.axes[off.unwrap_or(number)].causes.enabling;
            let missing = self.missing_enable(unit, to_nck);
            self.log.note_one(Place::Axis(number), Rule::EnableLost, missing, parent)
        } else {
            return enabled;
        };
        self.axes[number].jogging.movement = Movement::None;
        self.travel(number, Travel::None, cause);
        enabled
    }

    /// Ends the movement by this rule.
    fn stop_jogging(&mut self, number: AxisNumber, rule: Rule, inputs: [Input; 3], cause: EventId) {
        self.axes[number].jogging.movement = Movement::None;
        if self.axes[number].travel != Travel::None {
            let cause = self.log.now(Place::Axis(number), cause, rule, inputs);
            self.travel(number, Travel::None, cause);
        }
    }

    /// A datum of 0 with which the axis cannot move (O-30).
    fn refuse_movement(&mut self, number: AxisNumber, datum: u32, parameters: &Parameters, signals: &AxisToNck) {
        let input = Input::Datum(datum, Some(number), 0.0);
        let cause = self.log.note_one(Place::Axis(number), Rule::DatumNotAllowed, input, EventId::NONE);
        let shown = [Parameter::Axis(number), Parameter::Number(datum.into()), Parameter::None, Parameter::None];
        self.alarms.raise(alarms::DATUM_NOT_ALLOWED, Place::Axis(number), shown, cause);
        self.block_jogging(number, parameters, signals, Rule::DatumNotAllowed, input, cause);
    }

    /// Blocks the movement by this rule. A movement with an end is dropped; that of a held key stays requested.
    fn block_jogging(
        &mut self,
        number: AxisNumber,
        parameters: &Parameters,
        signals: &AxisToNck,
        rule: Rule,
        input: Input,
        cause: EventId,
    ) {
        let axis = &mut self.axes[number];
        if !(parameters.key_modes.continuous_held && matches!(axis.jogging.movement, Movement::Continuous(_))) {
            axis.jogging.movement = Movement::None;
        }
        let travel = Travel::blocked(axis.jogging.movement.direction(axis.setpoint.position));
        let before = axis.travel;
        if before == travel {
            return;
        }
        let cause = if before.is_pending() {
            self.log.now(Place::Axis(number), cause, rule, [input, Input::None, Input::None])
        } else {
            // The axis is already at standstill: only the request changes.
            let rule = if travel == Travel::None { Rule::KeyReleased } else { Rule::MotionBlocked };
            let [plus, minus, _] = keys(number, signals);
            self.log.note(Place::Axis(number), rule, [plus, minus, input], cause)
        };
        self.travel(number, travel, cause);
    }

    /// Shows the travel of keys or handwheels; `rule` is that of the movement, `off` an axis that is not in position control, `enabled` the one
    /// whose position control has completed the enables in this cycle.
    fn show_jogging(
        &mut self,
        number: AxisNumber,
        travel: Travel,
        rule: Rule,
        (off, enabled): (Option<AxisNumber>, Option<AxisNumber>),
        signals: &AxisToNck,
    ) {
        let axis = &self.axes[number];
        let before = axis.travel;
        if before == travel {
            return;
        }
        let goes_on = before.request() == travel.request();
        let (rule, input) = if goes_on && travel.is_waiting() {
            axis.jog_holder(number, off)
        } else if goes_on && before.is_waiting() {
            axis.jog_released(number, rule, enabled)
        } else if goes_on {
            (rule, self.unblocked(number, travel.request(), signals))
        } else {
            (rule, Input::None)
        };
        let event = if axis.jogging.movement.is_by_handwheel() {
            let assigned = active_handwheel(number, axis.jogging.handwheels);
            self.log.note(Place::Axis(number), rule, [assigned, input, Input::None], axis.jogging.turn_cause)
        } else {
            // The event that starts a movement does not depend on the previous movement.
            let parent = if before.request() == 0 { EventId::NONE } else { axis.causes.motion };
            let [plus, minus, _] = keys(number, signals);
            self.log.note(Place::Axis(number), rule, [plus, minus, input], parent)
        };
        self.travel(number, travel, event);
    }
}

impl State {
    /// The signal that no longer blocks a movement: the fast stop has ended, or 12.2 or 12.3 selects another software limit switch.
    fn unblocked(&self, number: AxisNumber, direction: i8, signals: &AxisToNck) -> Input {
        if self.log.is_of_this_cycle(self.axes[number].signals.fast_stop_cause) {
            axis_signal(number, axis_from_nck::ramp_function_generator_disable_active, false)
        } else if direction > 0 {
            let second = signals.second_software_limit_switch_plus();
            axis_signal(number, axis_to_nck::second_software_limit_switch_plus, second)
        } else {
            let second = signals.second_software_limit_switch_minus();
            axis_signal(number, axis_to_nck::second_software_limit_switch_minus, second)
        }
    }
}

impl Axis {
    /// Starts a waiting distance and ends one whose target is reached. Returns whether one ended. An increment begins at
    /// standstill.
    fn begin_or_end_way(&mut self, is_on: bool) -> bool {
        let rests = self.setpoint.is_at_rest();
        if let Movement::Pending(way, by) = self.jogging.movement
            && is_on
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

    /// The rule and the signal that hold its movement.
    fn jog_holder(&self, number: AxisNumber, off: Option<AxisNumber>) -> (Rule, Input) {
        if !self.is_held() {
            let control = |axis| axis_signal(axis, axis_from_nck::position_controller_active, false);
            return (Rule::MotionBlocked, off.map_or(Input::None, control));
        }
        let (rule, input) = self.holder(number);
        let zero_setting = !self.feed_held && !self.override_is_active;
        (if zero_setting { rule } else { Rule::MotionBlocked }, input)
    }

    /// The rule and the signal that no longer hold its movement; `rule` is that of the movement.
    fn jog_released(&self, number: AxisNumber, rule: Rule, enabled: Option<AxisNumber>) -> (Rule, Input) {
        if let Some(enabled) = enabled {
            (rule, axis_signal(enabled, axis_from_nck::position_controller_active, true))
        } else if self.feed_holder == Input::None {
            (Rule::OverrideReleased, self.override_input(number))
        } else {
            (rule, self.feed_holder)
        }
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
