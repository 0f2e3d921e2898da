//! Starts the referencing of axes, by the traversing key or by the channel, and applies its effects on other functions.
//!
//! Called in the stage "referencing and gantry". A held key starts one approach. It must be released before it starts another
//! one, also if it was pressed while the approach ran, before REF was selected, or during RESET, emergency stop or an alarm that
//! stops (O-26). A key that is pressed before the axes are in position control stays pending until they are, and the traverse command
//! is already output (O-27). With MD11300 = 0 it stays pending also when it is released; RESET, leaving REF, the other key and 4.4 end that. A key in REF of a synchronous axis of an open grouping raises 16794 (E-15).
//! A spindle (MD35000) has no approach: its key starts none, and channel-specific referencing and NC start leave it out.

use crate::image::{ToNck, axis_from_nck, axis_to_nck, channel_to_nck, mode_group_from_nck};
use crate::sinumerik::alarms;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::gantry::view::View;
use crate::sinumerik::inputs::{axis_signal, channel_signal, mode_group_signal};
use crate::sinumerik::jog::keys::{key_direction, key_signal};
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::{ADJUSTED, AxisParameters, Kind};
use crate::sinumerik::referencing::approach::Outcome;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, RaisedAlarm};

/// The source of a request for an approach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RequestedBy {
    /// The traversing key of the axis.
    Key,
    /// Channel-specific referencing.
    Channel,
    /// G74 of a program.
    Program,
}

impl State {
    /// An axis that is not in a closed grouping.
    pub(in crate::sinumerik) fn run_single(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        self.brake(unit, parameters);
        self.watch_limit_switches(unit, to_nck);
        self.watch_key(unit, self.axes[number].approach.is_running(), parameters, to_nck);
        if self.axes[number].approach.is_running() {
            self.reference_single(unit, parameters, to_nck);
        } else if self.follow_program(unit, parameters, to_nck) {
            self.watch_software_limits(unit, parameters, to_nck);
        } else if self.is_jogging(unit) {
            self.jog(unit, parameters, to_nck);
        } else {
            let open = self.is_gantry_axis(number);
            if open {
                self.refuse_approach_in_open_grouping(unit, parameters, to_nck);
            }
            if open || !self.wait_for_approach(unit, parameters, to_nck) {
                self.rest_without_jog(unit, parameters, &to_nck.axes[number]);
            }
            if self.unit_can_move(unit, parameters)
                && !open
                && let Some((direction, event)) = self.approach_wanted(unit, parameters, to_nck)
            {
                self.axes[number].approach_key = self.key_of_approach(unit, direction);
                let keeps = View { axes: &self.axes, owners: &self.owners, parameters }.keeps_reference(number);
                self.start_approach(number, f64::from(direction), keeps, event);
                self.reference_single(unit, parameters, to_nck);
            }
        }
    }

    fn reference_single(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        let key = self.axes[number].approach_key;
        if let Some((alarm, event)) = self.approach_interrupted(number, key, unit, parameters, to_nck) {
            self.axes[number].approach.abort();
            self.travel(number, Travel::None, event);
            if let Some(alarm) = alarm {
                self.raise_axis_alarm(alarm, number, event);
            }
            return;
        }
        match self.run_approach(number, parameters, to_nck) {
            Outcome::Running => {}
            Outcome::Failed(alarm, event) => {
                self.travel(number, Travel::None, event);
                self.raise_axis_alarm(alarm, number, event);
            }
            Outcome::Measured(shift, _) => self.shift_actual_value(number, shift),
            Outcome::Referenced(shift, event) => {
                self.travel(number, Travel::None, event);
                self.set_reference(number, shift, event);
            }
            Outcome::Adjusted(shift, event) => {
                self.travel(number, Travel::None, event);
                self.set_reference(number, shift, event);
                self.store_adjustment(number, event);
            }
            Outcome::NotAdjusted(event) => {
                self.travel(number, Travel::None, event);
                self.warn_not_adjusted(number, event);
            }
        }
    }

    /// A key that jogs, or is pressed during an approach, must be released before it starts an approach.
    pub(in crate::sinumerik) fn watch_key(&mut self, unit: &Unit, busy: bool, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        let jogging = self.is_jogging(unit);
        let opens = unit.grouping.is_some_and(|index| self.groupings[usize::from(index)].is_kept_open(parameters));
        for axis in unit.members() {
            self.axes[axis].jogging.watch_keys(&to_nck.axes[axis]);
            // Keys and handwheels of a synchronous axis move nothing (MIS-01), unless its grouping opens in this cycle.
            if !jogging || axis != number && !opens {
                self.axes[axis].jogging.end();
            }
        }
        let pressed = key_direction(&to_nck.axes[number]) != 0;
        let unheard = !self.mode_group(unit).is_referencing() || self.stop(unit.channel, parameters).is_some();
        let axis = &mut self.axes[number];
        axis.key_used = pressed && (axis.key_used || busy || unheard);
        let signals = &to_nck.axes[number];
        let other = if axis.key_pending > 0 { signals.traversing_key_minus() } else { signals.traversing_key_plus() };
        if busy || unheard || other || signals.traversing_key_disable() {
            axis.key_pending = 0;
        }
    }

    /// Shows an approach that is requested and waits for an enable or for the end of feed disable (O-27). Returns whether it is shown.
    pub(in crate::sinumerik) fn wait_for_approach(
        &mut self,
        unit: &Unit,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> bool {
        let number = unit.leader();
        let waits = !unit.members().all(|axis| self.axes[axis].enabling.is_on()) || self.axes[number].feed_disabled;
        if !waits || self.stop(unit.channel, parameters).is_some() || self.motion_forbidden(unit).is_some() {
            return false;
        }
        let Some((direction, by)) = self.approach_requested(unit, parameters, to_nck) else { return false };
        if !self.travels(number, &parameters.axes[number]) {
            // Nothing will move.
            return false;
        }
        let off = unit.members().any(|axis| !self.axes[axis].enabling.is_on());
        if by == RequestedBy::Key && !parameters.jog_mode && off {
            // The press counts: the key need not be held (MD11300 = 0). Feed disable does not keep it.
            self.axes[number].key_pending = direction;
        }
        // An approach that begins on the cam first leaves it.
        let on_cam = parameters.axes[number].reference.cam_is_active
            && to_nck.axes[number].deceleration_reference_point_approach();
        let travel = Travel::waiting(if on_cam { -direction } else { direction });
        if self.axes[number].travel != travel {
            let holder = if self.axes[number].feed_disabled {
                self.axes[number].feed_holder
            } else {
                self.missing_enable(unit, to_nck)
            };
            let (input, parent) = match by {
                RequestedBy::Key => {
                    (axis_signal(number, key_signal(direction), true), self.mode_group(unit).function_cause)
                }
                RequestedBy::Channel => (Input::None, self.channels[unit.channel].referencing.cause),
                RequestedBy::Program => (Input::None, self.programs[unit.channel].block_cause()),
            };
            let inputs = [input, holder, Input::None];
            let event = self.log.note(Place::Axis(number), Rule::ApproachWaits, inputs, parent);
            self.travel(number, travel, event);
        }
        true
    }

    /// A key in REF of an axis of an open grouping starts nothing; on a synchronous axis it raises 16794 (E-15).
    fn refuse_approach_in_open_grouping(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        let Some((direction, RequestedBy::Key)) = self.approach_requested(unit, parameters, to_nck) else { return };
        self.axes[number].key_used = true;
        let grouping = self.groupings.iter().find(|grouping| grouping.coupling.followers().any(|axis| axis == number));
        let Some(grouping) = grouping else { return };
        let open = grouping.coupling.members().find(|&axis| parameters.axes[axis].gantry.broken_up);
        let inputs = [
            axis_signal(number, key_signal(direction), true),
            mode_group_signal(unit.mode_group, mode_group_from_nck::active_machine_function_ref, true),
            open.map_or(Input::None, |axis| Input::Datum(37140, Some(axis), 1.0)),
        ];
        let parent = self.mode_group(unit).function_cause;
        // %2 is the block of a program.
        let shown = [Parameter::Channel(unit.channel), Parameter::None, Parameter::Axis(number), Parameter::None];
        let alarm = RaisedAlarm {
            number: alarms::programs::REFERENCING_COUPLED,
            place: Place::Axis(number),
            parameters: shown,
        };
        self.raise_new(alarm, Rule::NoApproachInOpenGrouping, inputs, parent);
    }

    /// The request for an approach of the unit's first axis, by its key in the correct direction or by the channel.
    fn approach_requested(&self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) -> Option<(i8, RequestedBy)> {
        let number = unit.leader();
        let reference = &parameters.axes[number].reference;
        let signals = &to_nck.axes[number];
        let key = match key_direction(signals) {
            0 => self.axes[number].key_pending,
            key => key,
        };
        let active = self.axes[number].measuring_system.map(usize::from);
        let has_approach = active.is_some_and(|active| reference.has_approach(active));
        let hindered = reference.is_spindle || signals.axis_spindle_disable();
        if !self.may_reference(unit) || !has_approach || hindered {
            return None;
        }
        let forward = if reference.cam_direction > 0.0 { 1 } else { -1 };
        if self.program_wants_reference(unit) {
            return Some((forward, RequestedBy::Program));
        }
        if !self.mode_group(unit).is_referencing() {
            return None;
        }
        if self.channels[unit.channel].referencing.wants(number, reference.cycle_number) {
            return Some((forward, RequestedBy::Channel));
        }
        // The other key: no start, no alarm. Without a cam both directions are correct, except for an absolute encoder.
        let is_absolute = active.is_some_and(|active| reference.kind[active] == Kind::Absolute);
        let right = key != 0 && (key == forward || !reference.cam_is_active && !is_absolute);
        (right && !self.axes[number].key_used).then_some((key, RequestedBy::Key))
    }

    /// The key that must be held during an approach; 0 if the channel or a program has started it.
    pub(in crate::sinumerik) fn key_of_approach(&self, unit: &Unit, direction: i8) -> i8 {
        let by_channel = self.channels[unit.channel].started(unit.leader());
        if by_channel || self.is_referenced_by_program(unit) { 0 } else { direction }
    }

    /// The start of a requested approach, which takes the request.
    pub(in crate::sinumerik) fn approach_wanted(
        &mut self,
        unit: &Unit,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<(i8, EventId)> {
        let number = unit.leader();
        if self.axes[number].feed_disabled {
            return None;
        }
        let (direction, by) = self.approach_requested(unit, parameters, to_nck)?;
        if by == RequestedBy::Channel {
            if self.datum_against_approach(number, parameters).is_some() {
                // Refused in the next cycle: the PLC first sees that its request was taken (C-46).
                return None;
            }
            let referencing = &mut self.channels[unit.channel].referencing;
            referencing.started |= 1 << number.index();
            let cause = referencing.cause;
            let event = self.log.note_plain(Place::Axis(number), Rule::ApproachStartedByChannel, cause);
            return Some((direction, event));
        }
        if by == RequestedBy::Program {
            let cause = self.begin_reference_by_program(unit);
            let event = self.log.note_plain(Place::Axis(number), Rule::ApproachStartedByProgram, cause);
            return Some((direction, event));
        }
        self.axes[number].key_used = true;
        let is_pending = std::mem::take(&mut self.axes[number].key_pending) != 0;
        let pressed = key_direction(&to_nck.axes[number]) == direction;
        let minus = parameters.axes[number].reference.cam_direction < 0.0;
        let inputs = [
            axis_signal(number, key_signal(direction), pressed),
            Input::Datum(34010, Some(number), f64::from(u8::from(minus))),
            mode_group_signal(unit.mode_group, mode_group_from_nck::active_machine_function_ref, true),
        ];
        // A key that is released was pressed when the request began to wait.
        let waited = is_pending && !pressed;
        let parent = if waited { self.axes[number].causes.motion } else { self.mode_group(unit).function_cause };
        let event = self.log.note(Place::Axis(number), Rule::KeyStartsApproach, inputs, parent);
        Some((direction, event))
    }

    /// Begins an approach: the reference of its measuring system is lost, except for an absolute encoder.
    pub(in crate::sinumerik) fn start_approach(
        &mut self,
        number: AxisNumber,
        direction: f64,
        keeps_reference: bool,
        cause: EventId,
    ) {
        self.absorb_overlay(number);
        let in_grouping = self.is_gantry_axis(number);
        let axis = &mut self.axes[number];
        let encoder = usize::from(axis.measuring_system.unwrap_or(0));
        if !keeps_reference && (axis.referenced[encoder] || axis.restored[encoder]) {
            let event = self.log.note_plain(Place::Axis(number), Rule::NewApproach, cause);
            if std::mem::take(&mut axis.referenced[encoder]) {
                axis.causes.reference[encoder] = event;
            }
            if std::mem::take(&mut axis.restored[encoder]) {
                axis.causes.restored[encoder] = event;
            }
        }
        axis.approach.start(&mut self.log, direction, axis.actual, in_grouping, cause);
    }

    /// Whether an approach of this axis moves it: an absolute encoder only travels to its reference point when it is adjusted.
    pub(in crate::sinumerik) fn travels(&self, number: AxisNumber, parameters: &AxisParameters) -> bool {
        let reference = &parameters.reference;
        let encoder = usize::from(self.axes[number].measuring_system.unwrap_or(0));
        let is_adjusted = reference.state[encoder] == ADJUSTED;
        let goes_on = is_adjusted && !reference.stops_at_marks[encoder] && !self.is_gantry_axis(number);
        reference.kind[encoder] != Kind::Absolute || goes_on
    }

    /// 25022 with %3 = 0.
    pub(in crate::sinumerik) fn warn_not_adjusted(&mut self, number: AxisNumber, event: EventId) {
        let encoder = usize::from(self.axes[number].measuring_system.unwrap_or(0));
        self.raise_encoder_alarm(alarms::ENCODER_WARNING, number, encoder, 0, event);
    }

    /// One cycle of an approach. Commands the motion of its axis.
    pub(in crate::sinumerik) fn run_approach(
        &mut self,
        number: AxisNumber,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Outcome {
        self.hold_approach_by_nc_stop(number, parameters, to_nck);
        let mut approach = self.axes[number].approach;
        let axis = &self.axes[number];
        let signals = &to_nck.axes[number];
        let (motion, outcome) = approach.run(&mut self.log, number, axis, &parameters.axes[number], signals);
        let axis = &mut self.axes[number];
        axis.approach = approach;
        axis.motion = motion;
        let direction = motion.direction(axis.setpoint.position);
        let wanted = approach.direction(axis, parameters.axes[number].reference.cam_is_active);
        let travel = if direction == 0 && axis.is_held() { Travel::waiting(wanted) } else { Travel::moving(direction) };
        let cam = axis_to_nck::deceleration_reference_point_approach;
        let cam = axis_signal(number, cam, signals.deceleration_reference_point_approach());
        let (begun, begins) = (approach.cause(), (Rule::ApproachStarted, cam));
        self.travel_on(number, travel, begun, begins, (Rule::ApproachTargetReached, approach.target));
        outcome
    }

    /// NC stop (7.3) holds an approach in JOG where it acts; NC start lets it go on (FB1, R1).
    fn hold_approach_by_nc_stop(&mut self, number: AxisNumber, parameters: &Parameters, to_nck: &ToNck) {
        let channel = self.owners.of(number).channel;
        let jog = self.mode_groups[parameters.mode_group(channel)].mode == Mode::Jog;
        let signals = &to_nck.channels[channel];
        let axis = &mut self.axes[number];
        let acts = jog && axis.approach.heeds_nc_stop(axis, &parameters.axes[number]);
        let pressed = signals.nc_stop() || signals.nc_stop_axes_plus_spindles();
        if pressed && acts {
            let signal =
                if signals.nc_stop() { channel_to_nck::nc_stop } else { channel_to_nck::nc_stop_axes_plus_spindles };
            axis.approach.stopped = Some(channel_signal(channel, signal, true));
        } else if !pressed && signals.nc_start() && axis.approach.stopped.take().is_some() && !axis.feed_held {
            axis.feed_holder = channel_signal(channel, channel_to_nck::nc_start, true);
        }
        if let Some(holder) = axis.approach.stopped {
            (axis.feed_held, axis.feed_holder) = (true, holder);
        }
    }

    /// The event that ends an approach from outside: an alarm that stops, RESET, leaving REF, a missing enable, the key.
    pub(in crate::sinumerik) fn approach_interrupted(
        &mut self,
        number: AxisNumber,
        key: i8,
        unit: &Unit,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<(Option<AlarmNumber>, EventId)> {
        let parent = self.axes[number].approach.cause();
        // A missing enable is reported even if alarm 21612, which stops every movement, was raised in the same cycle.
        if !self.channels[unit.channel].reset
            && let Some(off) = unit.members().find(|&axis| !to_nck.axes[axis].controller_enable())
        {
            let input = axis_signal(off, axis_to_nck::controller_enable, false);
            let event = self.log.note_one(Place::Axis(number), Rule::ApproachAborted, input, parent);
            return Some((Some(alarms::APPROACH_ABORTED), event));
        }
        if let Some(stop) = self.stop(unit.channel, parameters) {
            let (_, input) = stop.tested();
            let inputs = [input, Input::None, Input::None];
            return Some((None, self.log.now(Place::Axis(number), stop.cause(), Rule::ApproachAborted, inputs)));
        }
        // A hardware limit switch in the direction of travel ends the approach with its own alarm.
        let direction = unit.members().map(|axis| self.axes[axis].travel.request()).find(|&request| request != 0);
        let direction = direction.unwrap_or(0);
        if let Some(pressed) = self.limited_by(unit, direction) {
            self.brake_at_limit(unit, parameters);
            let limits = self.axes[pressed].limits;
            let input = limits.input(pressed, direction);
            return Some((None, self.log.note_one(Place::Axis(number), Rule::ApproachAborted, input, limits.cause)));
        }
        if !self.may_reference(unit) {
            let cause = self.mode_group(unit).function_cause.max(self.programs[unit.channel].cause);
            let referencing = mode_group_from_nck::active_machine_function_ref;
            let input = mode_group_signal(unit.mode_group, referencing, false);
            return Some((None, self.log.note_one(Place::Axis(number), Rule::ApproachAborted, input, cause)));
        }
        let pressed = key_direction(&to_nck.axes[number]);
        let (alarm, input) = if let Some(off) = unit.members().find(|&axis| !self.axes[axis].enabling.is_on()) {
            let axis = &self.axes[off];
            if axis.enabling.controllers()[2] {
                // The axis brakes in position control before it is switched off.
                let cause = axis.causes.enabling;
                let event = self.log.note_plain(Place::Axis(number), Rule::ApproachAborted, cause);
                return Some((Some(alarms::APPROACH_ABORTED), event));
            }
            (Some(alarms::APPROACH_ABORTED), axis_signal(off, axis_from_nck::position_controller_active, false))
        } else if let Some(forbidden) = self.motion_forbidden(unit) {
            (Some(alarms::APPROACH_ABORTED), forbidden)
        } else if key != 0 && parameters.jog_mode && pressed != key {
            let released = axis_signal(number, key_signal(key), false);
            // The datum with which the key ends the approach.
            let held = Input::Datum(11300, None, 1.0);
            let inputs = [released, held, Input::None];
            let event = self.log.note(Place::Axis(number), Rule::ApproachAborted, inputs, parent);
            return Some((Some(alarms::APPROACH_ABORTED), event));
        } else if key != 0 && !parameters.jog_mode && pressed == -key {
            (None, axis_signal(number, key_signal(-key), true))
        } else {
            return None;
        };
        Some((alarm, self.log.note_one(Place::Axis(number), Rule::ApproachAborted, input, parent)))
    }

    /// The measuring system was switched or lost during an approach (REF-33).
    pub(in crate::sinumerik) fn abort_approach(&mut self, number: AxisNumber, event: EventId) {
        self.axes[number].approach.abort();
        self.raise_axis_alarm(alarms::APPROACH_ABORTED, number, event);
        if let Some(index) =
            self.groupings.iter().position(|g| g.is_referencing() && g.coupling.members().any(|m| m == number))
        {
            self.reset_grouping(index, event);
        }
    }

    /// Shifts the actual value at the present position; the axis is referenced.
    pub(in crate::sinumerik) fn set_reference(&mut self, number: AxisNumber, shift: Position, event: EventId) {
        let axis = &mut self.axes[number];
        if let Some(active) = axis.measuring_system.map(usize::from) {
            axis.referenced[active] = true;
            axis.causes.reference[active] = event;
            if std::mem::take(&mut axis.restored[active]) {
                axis.causes.restored[active] = event;
            }
        }
        self.shift_actual_value(number, shift);
    }

    /// Shifts the actual value at the present position: nothing moves.
    pub(in crate::sinumerik) fn shift_actual_value(&mut self, number: AxisNumber, shift: Position) {
        self.axes[number].shift(shift);
        if let Some(filter) = self.shaping[number].as_deref_mut().and_then(|shaping| shaping.jerk.as_mut()) {
            filter.shift(shift);
        }
        self.value_shifted(number, shift);
        // An interruption point in other coordinates is none.
        for (_, program) in self.programs.iter_mut() {
            if let Some(run) = &mut program.run {
                run.left.retain(|(axis, _)| *axis != number);
            }
        }
        // The base of the limits ends with a new reference (E-14).
        for grouping in &mut self.groupings {
            if grouping.coupling.members().any(|axis| axis == number) {
                grouping.clear_bases();
            }
        }
    }

    pub(super) fn is_gantry_axis(&self, number: AxisNumber) -> bool {
        self.groupings.iter().any(|grouping| grouping.coupling.members().any(|member| member == number))
    }
}
