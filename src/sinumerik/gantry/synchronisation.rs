//! Section 3 of a grouping: comparing positions, waiting, the decoupled motion; and what takes synchronism away or gives
//! it back outside of it (G1 2.3.1, 2.3.2).
//!
//! Called by `gantry/mod.rs` once per cycle for each grouping. The choices are written there.

use crate::image::ToNck;
use crate::motion::Motion;
use crate::sinumerik::alarms;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::inputs::axis_bit;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::Position;
use crate::variables::{EventId, Input, Parameter, Place, Quantity};

impl State {
    /// Section 3: start by itself, or wait (REF-06, REF-07, REF-11).
    pub(in crate::sinumerik) fn compare_positions(
        &mut self,
        index: usize,
        event: EventId,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) {
        let coupling = self.groupings[index].coupling.clone();
        let leader = coupling.leader();
        self.groupings[index].from_referencing = true;
        self.groupings[index].waited = 0;
        let all = self.log.note_plain(Place::Axis(leader), Rule::AllReferenced, event);
        let mut wait = None;
        let apart = coupling.followers().find(|&axis| {
            let difference = self.axes[axis].actual - self.axes[leader].actual;
            difference.abs() > parameters.axes[axis].gantry.trip_limit_not_synchronised
        });
        if let Some(axis) = apart {
            // E-13: beyond MD37130 nothing is ready to be started; monitoring trips in this cycle.
            let difference = self.axes[axis].actual - self.axes[leader].actual;
            let limit = parameters.axes[axis].gantry.trip_limit_not_synchronised;
            let measured = Input::Length(Quantity::SynchronismDifference, axis, difference);
            let inputs = [measured, Input::Datum(37130, Some(axis), limit.user()), Input::None];
            self.step_grouping(index, Rule::ReadyNoMore, inputs, all);
            return;
        }
        for follower in coupling.followers() {
            let limit = parameters.axes[follower].gantry.warning_limit;
            let difference = self.axes[follower].actual - self.axes[leader].actual;
            let datum = Input::Datum(37110, Some(follower), limit.user());
            if limit == Position::ZERO {
                wait = wait.or(Some((Rule::WaitWarningLimitZero, [datum, Input::None, Input::None])));
            } else if difference.abs() >= limit {
                let measured = Input::Length(Quantity::SynchronismDifference, follower, difference);
                wait = wait.or(Some((Rule::WaitDifference, [measured, datum, Input::None])));
            }
        }
        if to_nck.axes[leader].no_automatic_synchronization() {
            let locked = [axis_bit(leader, 29, 5, true), Input::None, Input::None];
            wait = wait.or(Some((Rule::WaitLocked, locked)));
        }
        if let Some((rule, inputs)) = wait {
            self.step_grouping(index, rule, inputs, all);
        } else {
            self.set_target(index, parameters);
            self.step_grouping(index, Rule::AutomaticStart, [Input::None; 3], all);
        }
    }

    /// The common position: MD34100 of the leading axis after referencing, else its actual position (REF-15). A
    /// leading axis that has not come to rest there returns to it, or its actual value would not be that of the others.
    fn set_target(&mut self, index: usize, parameters: &Parameters) {
        let leader = self.groupings[index].coupling.leader();
        let from_referencing = self.groupings[index].from_referencing;
        let axis = &self.axes[leader];
        let runs_out = !axis.setpoint.is_at_rest()
            || axis.deviation().abs() > axis.active_set(&parameters.axes[leader]).exact_stop_fine;
        let grouping = &mut self.groupings[index];
        grouping.leading_axis_moves = from_referencing || runs_out;
        grouping.waited = 0;
        grouping.target =
            if from_referencing { self.axes[leader].approach.set_position() } else { self.axes[leader].actual };
    }

    pub(in crate::sinumerik) fn start_synchronising(&mut self, index: usize, parameters: &Parameters) {
        let leader = self.groupings[index].coupling.leader();
        let parent = self.groupings[index].cause;
        self.set_target(index, parameters);
        let inputs = [axis_bit(leader, 29, 4, true), Input::None, Input::None];
        self.step_grouping(index, Rule::StartByPlc, inputs, parent);
        let unit = Unit::of(&self.groupings[index].coupling, index, parameters);
        self.synchronise(index, &unit, parameters);
    }

    /// The decoupled motion of section 3: each axis with its own MD34040 (E-12).
    pub(in crate::sinumerik) fn synchronise(&mut self, index: usize, unit: &Unit, parameters: &Parameters) {
        let referencing = self.mode_group(unit).is_referencing();
        if !referencing || !self.unit_can_move(unit, parameters) || self.on_limit_switch(unit).is_some() {
            let cause = self.stop_cause(unit.channel, parameters).unwrap_or(self.groupings[index].cause);
            self.step_grouping(index, Rule::SynchronisationAborted, [Input::None; 3], cause);
            self.groupings[index].from_referencing = false;
            for axis in unit.members() {
                self.traverse(axis, 0, 0, cause);
            }
            return;
        }
        let leader = self.groupings[index].coupling.leader();
        let (target, leading_axis_moves) = (self.groupings[index].target, self.groupings[index].leading_axis_moves);
        let (mut arrived, mut late) = (true, None);
        for number in unit.members() {
            let axis_parameters = &parameters.axes[number];
            let axis = &mut self.axes[number];
            if number == leader && !leading_axis_moves {
                continue;
            }
            let encoder = usize::from(axis.measuring_system.unwrap_or(0));
            let factor = if axis.feed_held { 0.0 } else { axis.feed_factor };
            let velocity =
                (axis_parameters.reference.marker_velocity[encoder] * factor).min(axis_parameters.maximum_velocity);
            let at_rest = axis.setpoint.is_at_rest() && axis.setpoint.position == target;
            axis.motion = Motion::GoTo { target, velocity, acceleration: axis_parameters.maximum_acceleration };
            let direction = axis.motion.direction(axis.setpoint.position);
            let in_position = axis.deviation().abs() <= axis.active_set(axis_parameters).exact_stop_fine;
            if !(at_rest && in_position) {
                arrived = false;
                if at_rest {
                    late = late.or(Some(number));
                }
            }
            let wanted = (target - self.axes[number].setpoint.position).increments().signum();
            let request = i8::try_from(wanted).unwrap_or(0);
            let cause = self.groupings[index].cause;
            self.traverse(number, request, direction, cause);
        }
        if arrived {
            self.close_synchronised(index, unit, parameters);
        } else if let Some(number) = late {
            self.groupings[index].waited += 1;
            if self.groupings[index].waited > parameters.axes[number].positioning_cycles {
                let event = self.groupings[index].cause;
                self.raise_axis_alarm(alarms::APPROACH_ABORTED, number, event);
                self.step_grouping(index, Rule::SynchronisationAborted, [Input::None; 3], event);
                self.groupings[index].from_referencing = false;
                for axis in unit.members() {
                    self.traverse(axis, 0, 0, event);
                }
            }
        }
    }

    /// All axes are at their target: synchronised, and the coupling acts again (REF-10).
    fn close_synchronised(&mut self, index: usize, unit: &Unit, parameters: &Parameters) {
        let parent = self.groupings[index].cause;
        let target = Input::Length(Quantity::Position, unit.leader(), self.groupings[index].target);
        self.step_grouping(index, Rule::Synchronised, [target, Input::None, Input::None], parent);
        self.groupings[index].coupled = true;
        let cause = self.groupings[index].cause;
        for axis in unit.members() {
            let deceleration = parameters.axes[axis].maximum_acceleration;
            self.axes[axis].motion = Motion::Brake { deceleration };
            self.traverse(axis, 0, 0, cause);
        }
    }

    /// What takes synchronism or readiness away, and what gives it back outside of section 3.
    pub(in crate::sinumerik) fn watch_synchronism(
        &mut self,
        index: usize,
        unit: &Unit,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) {
        self.open_or_close(index, unit, parameters);
        let phase = self.groupings[index].phase;
        let follower = unit.members().find(|&axis| self.axes[axis].enabling.follow_up);
        let unreferenced = unit.members().find(|&axis| !self.axes[axis].is_referenced());
        let followed_up = std::mem::replace(&mut self.groupings[index].followed_up, follower.is_some());
        let lost = follower
            .map(|axis| (Rule::SynchronismLostFollowUp, axis_bit(axis, 61, 3, true), self.axes[axis].causes.enabling))
            .or_else(|| {
                let axis = unreferenced?;
                let (causes, active) = (self.axes[axis].causes, self.axes[axis].measuring_system.unwrap_or(0));
                let cause = causes.reference[usize::from(active)].max(causes.measuring_system);
                Some((Rule::SynchronismLostReference, axis_bit(axis, 60, 4 + active, false), cause))
            });
        match (phase, lost) {
            (Phase::Synchronised, Some((rule, input, cause))) => {
                self.step_grouping(index, rule, [input, Input::None, Input::None], cause);
            }
            (Phase::WaitingForStart | Phase::Synchronising, Some((_, input, cause))) => {
                self.end_ready(index, unit, input, cause);
            }
            (Phase::WaitingForStart | Phase::Synchronising, None) => {
                if let Some(cause) = self.trip_cause(index) {
                    self.end_ready(index, unit, Input::None, cause);
                }
            }
            (Phase::NotSynchronised, None) => self.make_ready(index, unit, parameters),
            _ => {}
        }
        if followed_up && follower.is_none() {
            self.count_anew(index);
            self.groupings[index].returning = true;
            self.groupings[index].monitored.iter_mut().for_each(|monitored| monitored.base = None);
        }
        if unreferenced.is_some() {
            self.clear_bases(index);
        }
        // Where an enable is missing on another axis, follow-up ends in hold.
        let back = unit.members().all(|axis| self.axes[axis].enabling.is_on());
        if back && std::mem::take(&mut self.groupings[index].returning) {
            let locked = to_nck.axes[unit.leader()].no_automatic_synchronization();
            self.restore_synchronism(index, unit, parameters, locked);
            self.set_bases(index);
        }
    }

    /// Not ready any more; a synchronising motion ends with it.
    fn end_ready(&mut self, index: usize, unit: &Unit, input: Input, cause: EventId) {
        self.step_grouping(index, Rule::ReadyNoMore, [input, Input::None, Input::None], cause);
        for axis in unit.members() {
            self.traverse(axis, 0, 0, cause);
        }
    }

    /// The event behind a difference that is beyond its trip limit.
    fn trip_cause(&self, index: usize) -> Option<EventId> {
        let tripped = self.groupings[index].monitored.iter().find(|monitored| monitored.trip)?;
        Some(tripped.trip_cause)
    }

    /// E-13: all referenced, not synchronised, difference within MD37130.
    fn make_ready(&mut self, index: usize, unit: &Unit, parameters: &Parameters) {
        let leader = unit.leader();
        let within = self.groupings[index].coupling.followers().all(|axis| {
            let difference = self.axes[axis].actual - self.axes[leader].actual;
            difference.abs() <= parameters.axes[axis].gantry.trip_limit_not_synchronised
        });
        if within && self.trip_cause(index).is_none() {
            let parent = self.groupings[index].cause;
            self.step_grouping(index, Rule::ReadyAgain, [Input::None; 3], parent);
            self.groupings[index].from_referencing = false;
        }
    }

    /// The end of follow-up: differences that are not absolute count anew.
    fn count_anew(&mut self, index: usize) {
        self.groupings[index].coupling.count_anew(&self.axes);
    }

    /// Back in position control after follow-up: synchronism is restored where every difference is within the standstill tolerance
    /// (SYN-06) and 29.5 is 0 (E-18).
    fn restore_synchronism(&mut self, index: usize, unit: &Unit, parameters: &Parameters, locked: bool) {
        let leader = unit.leader();
        if self.groupings[index].phase != Phase::WaitingForStart || locked {
            return;
        }
        let within = self.groupings[index].coupling.followers().all(|axis| {
            let difference = self.axes[axis].actual - self.axes[leader].actual;
            difference.abs() <= self.axes[axis].active_set(&parameters.axes[axis]).standstill_tolerance
        });
        if within {
            let cause = self.axes[leader].causes.enabling;
            self.step_grouping(index, Rule::SynchronismRestored, [Input::None; 3], cause);
            let common = self.axes[leader].setpoint;
            for axis in self.groupings[index].coupling.clone().followers() {
                self.axes[axis].setpoint = common;
            }
        }
    }

    fn open_or_close(&mut self, index: usize, unit: &Unit, parameters: &Parameters) {
        let open = unit.members().find(|&axis| parameters.axes[axis].gantry.broken_up);
        let is_open = self.groupings[index].phase == Phase::Open;
        if let Some(axis) = open
            && !is_open
        {
            if let Some(running) = self.groupings[index].referencing() {
                self.axes[running].approach.abort();
            }
            let input = Input::Datum(37140, Some(axis), 1.0);
            self.step_grouping(index, Rule::Opened, [input, Input::None, Input::None], EventId::NONE);
            let leader = unit.leader();
            self.groupings[index].coupling.lead_with(leader);
            self.groupings[index].coupled = false;
        } else if open.is_none() && is_open {
            let input = Input::Datum(37140, Some(unit.leader()), 0.0);
            self.step_grouping(index, Rule::Closed, [input, Input::None, Input::None], EventId::NONE);
            self.count_anew(index);
        }
    }

    /// The messages of section 3, raised in each cycle that they hold.
    pub(in crate::sinumerik) fn raise_grouping_messages(&mut self, index: usize, parameters: &Parameters) {
        let grouping = &self.groupings[index];
        let leader = grouping.coupling.leader();
        let unit = Parameter::Number(i64::from(grouping.number));
        let shown = [Parameter::Channel(parameters.axes[leader].channel), unit, Parameter::None, Parameter::None];
        let suppressed = parameters.axes[leader].gantry.suppress_message;
        let number = match grouping.phase {
            Phase::WaitingForStart if grouping.message => alarms::GANTRY_WAITING,
            Phase::Synchronising if !suppressed => alarms::GANTRY_SYNCHRONISING,
            Phase::WaitingForStart
            | Phase::Synchronising
            | Phase::NotSynchronised
            | Phase::ReferencingLeadingAxis
            | Phase::ReferencingSynchronousAxis
            | Phase::Synchronised
            | Phase::Open => return,
        };
        let cause = grouping.cause;
        self.alarms.raise(number, Place::Axis(leader), shown, cause);
    }
}
