//! The gantry grouping: referencing in sections 1 to 3, waiting, synchronisation, and the loss of synchronism (G1 2.3.1; figure
//! 2-2 is missing there, and [`TRANSITIONS`] is our reconstruction from its text).
//!
//! Called once per cycle for each grouping in the stage "referencing and gantry". Reads REF, traversing keys of the leading axis,
//! 29.4 and 29.5 of the leading axis; writes the motions of all its axes. The stage calls the grouping in the order of the cycle
//! and executes its requests. Section 3 is in `synchronisation.rs`, monitoring in `synchronism.rs`.
//!
//! Choices where the manuals leave one: 29.4 acts by its rising edge while the grouping waits (O-01), and not while an axis of the grouping
//! is not in position control. The key is held through sections 1 and 2 but not 3 (O-02). The override acts in section 3, and 0 % holds
//! (O-03). 101.4 stays until 101.5 (O-07). Where no axis has to move, 10655 is shown for two cycles (O-32). RESET clears the display of
//! 10654 and keeps 101.4 (O-09). A synchronising motion that does not reach exact stop fine within MD36020 ends with 20005.

use crate::control::Log;
use crate::image::{ToNck, mode_group_from_nck};
use crate::motion::Motion;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::gantry::state::{Grouping, Phase};
use crate::sinumerik::gantry::view::{Permit, View, Want, Wants};
use crate::sinumerik::inputs::mode_group_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::referencing::approach::Outcome;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{AlarmNumber, EventId, Input, Place, Quantity, RaisedAlarm};

impl State {
    /// One cycle of a grouping.
    pub(in crate::sinumerik) fn run_grouping(
        &mut self,
        index: usize,
        unit: &Unit,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) {
        let leader = unit.leader();
        let start = to_nck.axes[leader].start_gantry_synchronization();
        let start_was = std::mem::replace(&mut self.groupings[index].start_was, start);
        let start_rises = start && !start_was;
        self.brake_grouping(index, parameters);
        self.watch_limit_switches(unit, to_nck);
        self.watch_key(unit, self.groupings[index].is_referencing(), parameters, to_nck);
        let locked = to_nck.axes[leader].no_automatic_synchronization();
        self.ask(index, parameters, |grouping, view, log, wants| grouping.watch_synchronism(view, locked, log, wants));
        let grouping = &mut self.groupings[index];
        if !grouping.coupling.is_closed() {
            grouping.coupling.settle(unit.members().all(|axis| self.axes[axis].setpoint.is_at_rest()));
        }
        if !self.may_reference(unit) {
            self.groupings[index].from_referencing = false;
        }
        if self.groupings[index].may_start_approach()
            && self.unit_can_move(unit, parameters)
            && let Some((direction, event)) = self.approach_wanted(unit, parameters, to_nck)
        {
            let key = self.key_of_approach(unit, direction);
            self.ask(index, parameters, |grouping, view, log, wants| {
                *wants = grouping.start_approach(view, direction, key, event, log);
            });
        }
        match self.groupings[index].phase {
            Phase::ReferencingLeadingAxis | Phase::ReferencingSynchronousAxis => {
                self.reference_grouping(index, unit, parameters, to_nck);
            }
            Phase::WaitingForStart if start_rises && !self.channels[unit.channel].is_referencing() => {
                let permit = self.permit(unit, parameters);
                self.ask(index, parameters, |grouping, view, log, wants| {
                    *wants = grouping.start_synchronising(view, permit, log);
                });
            }
            Phase::Synchronising => {
                let permit = self.permit(unit, parameters);
                self.ask(index, parameters, |grouping, view, log, wants| {
                    *wants = grouping.synchronise(view, permit, log);
                });
            }
            Phase::NotSynchronised | Phase::WaitingForStart | Phase::Synchronised | Phase::Open => {}
        }
        let idle = !self.groupings[index].is_referencing() && self.groupings[index].coupling.is_closed();
        if idle && self.follow_program(unit, parameters, to_nck) {
            self.watch_software_limits(unit, parameters, to_nck);
        } else if idle && self.is_jogging(unit) {
            self.jog(unit, parameters, to_nck);
        } else if idle && !self.wait_for_approach(unit, parameters, to_nck) {
            // The key of a moving grouping has no function in the new mode.
            self.rest_without_jog(unit, parameters, &to_nck.axes[leader]);
        }
    }

    /// Sections 1 and 2.
    fn reference_grouping(&mut self, index: usize, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let Some(number) = self.groupings[index].referencing() else {
            return;
        };
        let key = self.groupings[index].key;
        let abort = |alarm, event| {
            move |grouping: &mut Grouping, _: &View<'_>, log: &mut Log, wants: &mut Wants| {
                *wants = grouping.abort(number, alarm, event, log);
            }
        };
        if let Some((alarm, event)) = self.approach_interrupted(unit.leader(), key, unit, parameters, to_nck) {
            self.ask(index, parameters, abort(alarm, event));
            return;
        }
        match self.run_approach(number, parameters, to_nck) {
            Outcome::Running => {}
            Outcome::Failed(alarm, event) => self.ask(index, parameters, abort(Some(alarm), event)),
            Outcome::Measured(shift, _) => self.shift_actual_value(number, shift),
            Outcome::NotAdjusted(event) => {
                self.warn_not_adjusted(number, event);
                self.ask(index, parameters, abort(None, event));
            }
            outcome @ (Outcome::Referenced(shift, event) | Outcome::Adjusted(shift, event)) => {
                self.set_reference(number, shift, event);
                if matches!(outcome, Outcome::Adjusted(..)) {
                    self.store_adjustment(number, event);
                }
                let locked = to_nck.axes[unit.leader()].no_automatic_synchronization();
                self.ask(index, parameters, |grouping, view, log, wants| {
                    *wants = grouping.next_section(view, event, locked, log);
                });
            }
        }
    }

    /// RESET, or the loss of an approach.
    pub(in crate::sinumerik) fn reset_grouping(&mut self, index: usize, event: EventId) {
        let wants = self.groupings[index].reset(event, &mut self.log);
        self.carry_out(&wants);
    }

    /// All axes brake together, unless a later stage commands something else.
    fn brake_grouping(&mut self, index: usize, parameters: &Parameters) {
        let own = |axis| parameters.axes[axis].maximum_acceleration;
        for (axis, deceleration) in self.groupings[index].coupling.stop(own) {
            self.axes[axis].motion = Motion::Brake { deceleration };
        }
    }

    /// Whether a synchronising motion may run.
    fn permit(&self, unit: &Unit, parameters: &Parameters) -> Permit {
        let free = self.unit_can_move(unit, parameters) && self.on_limit_switch(unit).is_none();
        let granted = free && self.may_reference(unit);
        let hindrance = if granted { (Input::None, EventId::NONE) } else { self.hindrance(unit, parameters) };
        Permit { granted, hindrance }
    }

    /// The reason that disables a synchronising motion: the tested input, and the event behind it.
    fn hindrance(&self, unit: &Unit, parameters: &Parameters) -> (Input, EventId) {
        if let Some(stop) = self.stop(unit.channel, parameters) {
            return (stop.tested().1, stop.cause());
        }
        let group = self.mode_group(unit);
        if !self.may_reference(unit) {
            let referencing = mode_group_from_nck::active_machine_function_ref;
            return (mode_group_signal(unit.mode_group, referencing, false), group.function_cause);
        }
        if let Some(forbidden) = self.motion_forbidden(unit) {
            return (forbidden, EventId::NONE);
        }
        if let Some(axis) = unit.members().find(|&axis| !self.axes[axis].enabling.is_on()) {
            return (Input::None, self.axes[axis].causes.enabling);
        }
        self.on_limit_switch(unit).unwrap_or((Input::None, EventId::NONE))
    }

    /// Calls a grouping and executes its requests.
    pub(in crate::sinumerik) fn ask(
        &mut self,
        index: usize,
        parameters: &Parameters,
        question: impl FnOnce(&mut Grouping, &View<'_>, &mut Log, &mut Wants),
    ) {
        let view = View { axes: &self.axes, owners: &self.owners, parameters };
        let mut wants = Wants::new();
        question(&mut self.groupings[index], &view, &mut self.log, &mut wants);
        self.carry_out(&wants);
    }

    pub(in crate::sinumerik) fn carry_out(&mut self, wants: &Wants) {
        for &want in wants {
            match want {
                Want::Move { axis, motion, travel, cause } => {
                    self.axes[axis].motion = motion;
                    if let Motion::GoTo { target, .. } = motion {
                        let begins = (Rule::SynchronisingMotion, Input::Length(Quantity::Target, axis, target));
                        self.travel_on(axis, travel, cause, begins, (Rule::SynchronisingTargetReached, target));
                    } else {
                        self.travel(axis, travel, cause);
                    }
                }
                Want::Rest { axis, cause } => self.travel(axis, Travel::None, cause),
                Want::StartApproach { axis, direction, keeps, cause } => {
                    self.start_approach(axis, direction, keeps, cause);
                }
                Want::AbortApproach(axis) => self.axes[axis].approach.abort(),
                Want::TakeSetpoint { axis, of } => self.axes[axis].setpoint = self.axes[of].setpoint,
                Want::RaiseOfAxis { alarm, axis, cause } => self.raise_axis_alarm(alarm, axis, cause),
                Want::Raise { alarm, place, shown, cause } => {
                    let alarm = RaisedAlarm { number: alarm, place, parameters: shown };
                    self.raise_tested(alarm, cause, Rule::ConditionHolds, [Input::None; 3]);
                }
            }
        }
    }
}

impl Grouping {
    fn may_start_approach(&self) -> bool {
        let phase = matches!(self.phase, Phase::NotSynchronised | Phase::WaitingForStart | Phase::Synchronised);
        phase && self.coupling.is_closed()
    }

    /// Section 1 begins, by a key or by the channel.
    fn start_approach(&mut self, view: &View<'_>, direction: i8, key: i8, event: EventId, log: &mut Log) -> Wants {
        let leader = self.coupling.leader();
        self.step(log, Rule::LeadingAxisApproach, [Input::None; 3], event);
        self.key = key;
        self.coupling.lead_with(leader);
        let (direction, keeps) = (f64::from(direction), view.keeps_reference(leader));
        Wants::from_iter([Want::StartApproach { axis: leader, direction, keeps, cause: event }])
    }

    fn abort(&mut self, number: AxisNumber, alarm: Option<AlarmNumber>, event: EventId, log: &mut Log) -> Wants {
        let mut wants = Wants::new();
        wants.push(Want::AbortApproach(number));
        wants.extend(alarm.map(|alarm| Want::RaiseOfAxis { alarm, axis: number, cause: event }));
        self.step(log, Rule::ReferencingAborted, [Input::None; 3], event);
        self.coupling.lead_with(self.coupling.leader());
        self.rest(event, &mut wants);
        wants
    }

    /// After a reference point in sections 1 and 2: continues with the next synchronous axis (O-10: ascending) or with section 3.
    fn next_section(&mut self, view: &View<'_>, event: EventId, locked: bool, log: &mut Log) -> Wants {
        let (by, turn) = if self.phase == Phase::ReferencingLeadingAxis {
            (Rule::LeadingAxisReferenced, 0)
        } else {
            (Rule::NextSynchronousAxis, self.turn + 1)
        };
        let leader = self.coupling.leader();
        let Some(next) = self.coupling.followers().nth(usize::from(turn)) else {
            self.coupling.lead_with(leader);
            self.compare_positions(view, event, locked, log);
            return Wants::new();
        };
        self.step(log, by, [Input::None; 3], event);
        self.turn = turn;
        self.coupling.lead_with(next);
        // MD37150 bit 1: direction of its own MD34010, or of the leading axis.
        let axes = &view.parameters.axes;
        let own = !axes[next].gantry.direction_of_leading_axis;
        let direction = axes[if own { next } else { leader }].reference.cam_direction;
        let cause = log.note_plain(Place::Axis(next), Rule::ApproachStartedInGrouping, event);
        let keeps = view.keeps_reference(next);
        Wants::from_iter([
            Want::StartApproach { axis: next, direction, keeps, cause },
            Want::Rest { axis: leader, cause },
        ])
    }

    /// RESET: sections 1 and 2 start again with the leading axis (REF-12), section 3 with 29.4 (REF-13, O-09).
    fn reset(&mut self, event: EventId, log: &mut Log) -> Wants {
        let mut wants = Wants::new();
        if let Some(number) = self.referencing() {
            wants = self.abort(number, None, event, log);
        } else if self.phase == Phase::Synchronising {
            self.step(log, Rule::SynchronisationAborted, [Input::None; 3], event);
            self.rest(event, &mut wants);
        }
        self.from_referencing = false;
        self.message = false;
        wants
    }

    /// Ends the travel requests and travel commands of all axes of the grouping.
    pub(in crate::sinumerik) fn rest(&self, cause: EventId, wants: &mut Wants) {
        wants.extend(self.coupling.members().map(|axis| Want::Rest { axis, cause }));
    }
}
