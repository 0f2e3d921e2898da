//! The gantry grouping: referencing in sections 1 to 3, waiting, synchronisation, and the loss of synchronism
//! (G1 2.3.1, figure 2-2 is missing there; [`TRANSITIONS`] is our reconstruction from its text).
//!
//! Called once per cycle for each grouping in the stage "referencing and gantry". Reads REF, traversing keys of the
//! leading axis, 29.4 and 29.5 of the leading axis; writes the motions of all its axes. Monitoring is in
//! `synchronism.rs`.
//!
//! Choices where the manuals leave one: 29.4 acts by its rising edge while the grouping waits (O-01), and not while
//! an axis of the grouping is not in position control; the key is held through sections 1 and 2 but not 3 (O-02); the
//! override acts in section 3 and 0 % holds (O-03); 101.4 stays until 101.5 (O-07); RESET takes the display of 10654
//! away and leaves 101.4 (O-09); a synchronising motion that does not end in exact stop fine within MD36020 ends with 20005.

use crate::control::next;
use crate::image::ToNck;
use crate::sinumerik::gantry::state::{GROUPING_CHART, Phase, TRANSITIONS};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::referencing::approach::Outcome;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{AlarmNumber, EventId, Input, Place};

impl State {
    /// One cycle of a grouping.
    pub(in crate::sinumerik) fn run_grouping(
        &mut self,
        index: usize,
        unit: &Unit,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) {
        let leader = self.groupings[index].coupling.leader();
        let start = to_nck.axes[leader].start_gantry_synchronization();
        let start_rises = start && !self.groupings[index].start_was;
        self.groupings[index].start_was = start;
        self.brake(unit, parameters);
        self.watch_limit_switches(unit, to_nck);
        self.watch_key(unit, self.groupings[index].is_referencing(), to_nck);
        self.watch_synchronism(index, unit, parameters, to_nck);
        if !self.groupings[index].coupled {
            let rest = unit.members().all(|axis| self.axes[axis].setpoint.is_at_rest());
            let decoupled = matches!(self.groupings[index].phase, Phase::Synchronising | Phase::Open);
            self.groupings[index].coupled = rest && !decoupled;
        }
        if !self.mode_group(unit).is_referencing() {
            self.groupings[index].from_referencing = false;
        }
        if self.may_start_approach(index, unit, parameters)
            && let Some((direction, event)) = self.approach_wanted(unit, parameters, to_nck)
        {
            self.start_grouping_approach(index, unit.channel, direction, event);
        }
        match self.groupings[index].phase {
            Phase::ReferencingLeadingAxis | Phase::ReferencingSynchronousAxis => {
                self.reference_grouping(index, unit, parameters, to_nck);
            }
            Phase::WaitingForStart if start_rises && self.may_synchronise(unit, parameters) => {
                self.start_synchronising(index, parameters);
            }
            Phase::Synchronising => self.synchronise(index, unit, parameters),
            Phase::NotSynchronised | Phase::WaitingForStart | Phase::Synchronised | Phase::Open => {}
        }
        let idle = !self.groupings[index].is_referencing() && self.groupings[index].coupled;
        if idle && self.is_jogging(unit) {
            self.jog(unit, parameters, to_nck);
        } else if idle {
            // A key that moved the grouping lost its meaning with the mode.
            let cause = self.mode_group(unit).cause();
            self.traverse(leader, 0, 0, cause);
        }
    }

    /// Takes a step of the table.
    pub(in crate::sinumerik) fn step_grouping(&mut self, index: usize, by: Rule, inputs: [Input; 3], parent: EventId) {
        let grouping = &mut self.groupings[index];
        grouping.phase = next(TRANSITIONS, &mut self.log.taken.0[GROUPING_CHART], grouping.phase, by);
        grouping.cause = self.log.note(Place::Axis(grouping.coupling.leader()), by, inputs, parent);
        match grouping.phase {
            Phase::WaitingForStart => (grouping.message, grouping.waited_for) = (true, true),
            Phase::Synchronising => grouping.coupled = false,
            Phase::ReferencingLeadingAxis => grouping.waited_for = false,
            Phase::NotSynchronised => grouping.lost_in_operation |= by == Rule::SynchronismLostFollowUp,
            Phase::ReferencingSynchronousAxis | Phase::Synchronised | Phase::Open => {}
        }
        if matches!(self.groupings[index].phase, Phase::ReferencingLeadingAxis | Phase::Synchronised | Phase::Open) {
            self.clear_bases(index);
        }
    }

    fn may_start_approach(&self, index: usize, unit: &Unit, parameters: &Parameters) -> bool {
        let grouping = &self.groupings[index];
        let phase = matches!(grouping.phase, Phase::NotSynchronised | Phase::WaitingForStart | Phase::Synchronised);
        phase && grouping.coupled && self.unit_can_move(unit, parameters)
    }

    /// REF active, no referencing of the channel running (REF-14), all axes in position control, nothing stops.
    fn may_synchronise(&self, unit: &Unit, parameters: &Parameters) -> bool {
        let free = self.unit_can_move(unit, parameters) && self.on_limit_switch(unit).is_none();
        self.mode_group(unit).is_referencing() && !self.channels[unit.channel].is_referencing() && free
    }

    fn start_grouping_approach(&mut self, index: usize, channel: ChannelNumber, direction: i8, event: EventId) {
        let leader = self.groupings[index].coupling.leader();
        self.step_grouping(index, Rule::LeadingAxisApproach, [Input::None; 3], event);
        let key = if self.channels[channel].started(leader) { 0 } else { direction };
        let grouping = &mut self.groupings[index];
        grouping.key = key;
        grouping.coupling.lead_with(leader);
        self.start_approach(leader, f64::from(direction), event);
    }

    /// Sections 1 and 2.
    fn reference_grouping(&mut self, index: usize, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let Some(number) = self.groupings[index].referencing() else {
            return;
        };
        let leader = self.groupings[index].coupling.leader();
        if let Some((alarm, event)) =
            self.approach_interrupted(leader, self.groupings[index].key, unit, parameters, to_nck)
        {
            self.abort_grouping(index, number, alarm, event);
            return;
        }
        match self.run_approach(number, parameters, to_nck) {
            Outcome::Running => {}
            Outcome::Failed(alarm, event) => self.abort_grouping(index, number, Some(alarm), event),
            Outcome::Referenced(shift, event) => {
                self.set_reference(number, shift, event);
                self.next_section(index, event, parameters, to_nck);
            }
        }
    }

    fn abort_grouping(&mut self, index: usize, number: AxisNumber, alarm: Option<AlarmNumber>, event: EventId) {
        self.axes[number].approach.abort();
        if let Some(alarm) = alarm {
            self.raise_axis_alarm(alarm, number, event);
        }
        self.step_grouping(index, Rule::ReferencingAborted, [Input::None; 3], event);
        let leader = self.groupings[index].coupling.leader();
        self.groupings[index].coupling.lead_with(leader);
        for axis in self.groupings[index].coupling.clone().members() {
            self.traverse(axis, 0, 0, event);
        }
    }

    /// After a reference point of sections 1 and 2: the next synchronous axis (O-10: ascending), or section 3.
    fn next_section(&mut self, index: usize, event: EventId, parameters: &Parameters, to_nck: &ToNck) {
        let (by, turn) = if self.groupings[index].phase == Phase::ReferencingLeadingAxis {
            (Rule::LeadingAxisReferenced, 0)
        } else {
            (Rule::NextSynchronousAxis, self.groupings[index].turn + 1)
        };
        let leader = self.groupings[index].coupling.leader();
        let Some(next) = self.groupings[index].coupling.followers().nth(usize::from(turn)) else {
            self.groupings[index].coupling.lead_with(leader);
            self.compare_positions(index, event, parameters, to_nck);
            return;
        };
        self.step_grouping(index, by, [Input::None; 3], event);
        self.groupings[index].turn = turn;
        self.groupings[index].coupling.lead_with(next);
        // MD37150 bit 1: direction by its own MD34010, or the leading axis'.
        let own = !parameters.axes[next].gantry.direction_of_leading_axis;
        let direction = parameters.axes[if own { next } else { leader }].reference.cam_direction;
        let cause = self.log.note_plain(Place::Axis(next), Rule::ApproachStartedInGrouping, event);
        self.start_approach(next, direction, cause);
        self.traverse(leader, 0, 0, cause);
    }

    /// RESET: sections 1 and 2 start anew with the leading axis (REF-12), section 3 with 29.4 (REF-13, O-09).
    pub(in crate::sinumerik) fn reset_grouping(&mut self, index: usize, event: EventId) {
        match self.groupings[index].phase {
            Phase::ReferencingLeadingAxis | Phase::ReferencingSynchronousAxis => {
                if let Some(number) = self.groupings[index].referencing() {
                    self.abort_grouping(index, number, None, event);
                }
            }
            Phase::Synchronising => {
                self.step_grouping(index, Rule::SynchronisationAborted, [Input::None; 3], event);
                for axis in self.groupings[index].coupling.clone().members() {
                    self.traverse(axis, 0, 0, event);
                }
            }
            Phase::NotSynchronised | Phase::WaitingForStart | Phase::Synchronised | Phase::Open => {}
        }
        self.groupings[index].from_referencing = false;
        self.groupings[index].message = false;
    }
}
