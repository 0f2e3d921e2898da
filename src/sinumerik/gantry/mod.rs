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

pub(super) mod closing;
pub(super) mod declarations;
pub(super) mod overload;
pub(super) mod setpoints;
pub(super) mod synchronisation;
pub(super) mod synchronism;

use serde::{Deserialize, Serialize};

use crate::image::ToNck;
use crate::motion::Coupling;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::groupings::Definition;
use crate::sinumerik::referencing::approach::Outcome;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::transitions::{Transition, next, row};
use crate::sinumerik::{State, Unit};
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Place};

/// Where a grouping is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Not synchronised, and nothing is on the way.
    #[default]
    NotSynchronised,
    /// Section 1: the leading axis is referenced.
    ReferencingLeadingAxis,
    /// Section 2: a synchronous axis is referenced, the leading axis follows it.
    ReferencingSynchronousAxis,
    /// Section 3: all referenced, the start must come from outside.
    WaitingForStart,
    /// Section 3: the axes move decoupled to the common position.
    Synchronising,
    /// Synchronised.
    Synchronised,
    /// MD37140 = 1.
    Open,
}

impl Phase {
    /// What it is, in a few words.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::NotSynchronised => "not synchronised",
            Self::ReferencingLeadingAxis => "section 1: the leading axis is referenced",
            Self::ReferencingSynchronousAxis => "section 2: a synchronous axis is referenced",
            Self::WaitingForStart => "section 3: waiting for the start",
            Self::Synchronising => "section 3: synchronising motion",
            Self::Synchronised => "synchronised",
            Self::Open => "opened",
        }
    }
}

/// Every step that a grouping can take.
pub const TRANSITIONS: &[Transition<Phase>] = &[
    row(Phase::NotSynchronised, Rule::LeadingAxisApproach, Phase::ReferencingLeadingAxis),
    row(Phase::WaitingForStart, Rule::LeadingAxisApproach, Phase::ReferencingLeadingAxis),
    row(Phase::Synchronised, Rule::LeadingAxisApproach, Phase::ReferencingLeadingAxis),
    row(Phase::ReferencingLeadingAxis, Rule::LeadingAxisReferenced, Phase::ReferencingSynchronousAxis),
    row(Phase::ReferencingLeadingAxis, Rule::ReferencingAborted, Phase::NotSynchronised),
    row(Phase::ReferencingSynchronousAxis, Rule::NextSynchronousAxis, Phase::ReferencingSynchronousAxis),
    row(Phase::ReferencingSynchronousAxis, Rule::ReferencingAborted, Phase::NotSynchronised),
    row(Phase::ReferencingSynchronousAxis, Rule::AutomaticStart, Phase::Synchronising),
    row(Phase::ReferencingSynchronousAxis, Rule::WaitWarningLimitZero, Phase::WaitingForStart),
    row(Phase::ReferencingSynchronousAxis, Rule::WaitDifference, Phase::WaitingForStart),
    row(Phase::ReferencingSynchronousAxis, Rule::WaitLocked, Phase::WaitingForStart),
    row(Phase::ReferencingSynchronousAxis, Rule::ReadyNoMore, Phase::NotSynchronised),
    row(Phase::WaitingForStart, Rule::StartByPlc, Phase::Synchronising),
    row(Phase::WaitingForStart, Rule::ReadyNoMore, Phase::NotSynchronised),
    row(Phase::WaitingForStart, Rule::SynchronismRestored, Phase::Synchronised),
    row(Phase::Synchronising, Rule::Synchronised, Phase::Synchronised),
    row(Phase::Synchronising, Rule::SynchronisationAborted, Phase::WaitingForStart),
    row(Phase::Synchronising, Rule::ReadyNoMore, Phase::NotSynchronised),
    row(Phase::Synchronised, Rule::SynchronismLostFollowUp, Phase::NotSynchronised),
    row(Phase::Synchronised, Rule::SynchronismLostReference, Phase::NotSynchronised),
    row(Phase::NotSynchronised, Rule::ReadyAgain, Phase::WaitingForStart),
    row(Phase::NotSynchronised, Rule::Opened, Phase::Open),
    row(Phase::ReferencingLeadingAxis, Rule::Opened, Phase::Open),
    row(Phase::ReferencingSynchronousAxis, Rule::Opened, Phase::Open),
    row(Phase::WaitingForStart, Rule::Opened, Phase::Open),
    row(Phase::Synchronising, Rule::Opened, Phase::Open),
    row(Phase::Synchronised, Rule::Opened, Phase::Open),
    row(Phase::Open, Rule::Closed, Phase::NotSynchronised),
];

/// What monitoring found on one synchronous axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Monitored {
    /// The synchronism difference.
    pub difference: Position,
    /// Beyond MD37110: 101.3.
    pub warning: bool,
    /// Beyond MD37120 or MD37130: 101.2.
    pub trip: bool,
    /// The amount when position control came back after synchronism was lost in operation (MON-08).
    pub base: Option<Position>,
    /// Why the warning came or went.
    pub warning_cause: EventId,
    /// Why the trip came or went.
    pub trip_cause: EventId,
}

/// One grouping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Grouping {
    /// Its number, 1 to 8.
    pub number: u8,
    /// Leading and synchronous axes, who leads now, and the base of each difference.
    pub coupling: Coupling,
    /// Where it is.
    pub phase: Phase,
    /// The movement of the one that leads is handed on; not while the axes synchronise, and until all rest after that.
    pub coupled: bool,
    /// Which synchronous axis is being referenced.
    pub(super) turn: u8,
    /// Direction of the key that started the approach; 0 for channel-specific referencing.
    pub(super) key: i8,
    /// Section 3 was entered from section 2, without RESET and without leaving REF since (REF-15).
    pub(super) from_referencing: bool,
    /// 10654 is shown; RESET takes it away (O-09).
    pub message: bool,
    /// The synchronising motion was waited for; 101.4 was set before it.
    pub waited_for: bool,
    /// Where the synchronising motion leads, for all axes.
    pub(super) target: Position,
    /// Whether the leading axis moves there, too.
    pub(super) leading_axis_moves: bool,
    /// Cycles at the target without exact stop fine.
    pub(super) waited: u64,
    /// 29.4 of the leading axis in the last cycle.
    pub(super) start_was: bool,
    /// The axes were in follow-up in the last cycle.
    pub(super) followed_up: bool,
    /// Follow-up has ended and position control has not come back yet.
    pub(super) returning: bool,
    /// Synchronism was lost by follow-up, and nothing has given it back or begun anew since.
    pub(super) lost_in_operation: bool,
    /// Closing was refused with 10658 (BRK-05).
    pub(super) kept_open: bool,
    /// What monitoring found on each synchronous axis.
    pub monitored: [Monitored; 2],
    /// The latest event of the grouping.
    pub cause: EventId,
}

impl Grouping {
    /// As after power on: no difference, nothing referenced.
    #[must_use]
    pub(super) fn new(definition: &Definition) -> Self {
        Self {
            number: definition.number,
            coupling: definition.coupling.clone(),
            phase: Phase::NotSynchronised,
            coupled: true,
            turn: 0,
            key: 0,
            from_referencing: false,
            message: false,
            waited_for: false,
            target: Position::ZERO,
            leading_axis_moves: false,
            waited: 0,
            start_was: false,
            followed_up: false,
            returning: false,
            lost_in_operation: false,
            kept_open: false,
            monitored: [Monitored::default(); 2],
            cause: EventId::NONE,
        }
    }

    /// The axis that is referenced in section 1 or 2.
    pub(super) fn referencing(&self) -> Option<AxisNumber> {
        match self.phase {
            Phase::ReferencingLeadingAxis => Some(self.coupling.leader()),
            Phase::ReferencingSynchronousAxis => self.coupling.followers().nth(usize::from(self.turn)),
            Phase::NotSynchronised
            | Phase::WaitingForStart
            | Phase::Synchronising
            | Phase::Synchronised
            | Phase::Open => None,
        }
    }

    /// Sections 1 and 2 are on the way.
    #[must_use]
    pub(super) fn is_referencing(&self) -> bool {
        self.referencing().is_some()
    }
}

impl State {
    /// One cycle of a grouping.
    pub(super) fn run_grouping(&mut self, index: usize, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
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
    pub(super) fn step_grouping(&mut self, index: usize, by: Rule, inputs: [Input; 3], parent: EventId) {
        let grouping = &mut self.groupings[index];
        grouping.phase = next(TRANSITIONS, &mut self.log.taken.grouping, grouping.phase, by);
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
    pub(super) fn reset_grouping(&mut self, index: usize, event: EventId) {
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
