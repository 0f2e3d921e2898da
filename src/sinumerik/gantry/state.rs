//! The state of gantry groupings, and the table of transitions of a grouping.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::control::{Log, Transition, next, row};
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::groupings::{Definition, GantryCoupling, SYNCHRONOUS_AXES};
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, AxisSet, PerAxis, Position};
use crate::variables::{EventId, Input, Place};

/// The phase of a grouping.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Not synchronised, and no movement to synchronism is active.
    #[default]
    NotSynchronised,
    /// Section 1: the leading axis is being referenced.
    ReferencingLeadingAxis,
    /// Section 2: a synchronous axis is being referenced, and the leading axis follows it.
    ReferencingSynchronousAxis,
    /// Section 3: all axes are referenced; the start must come from outside.
    WaitingForStart,
    /// Section 3: the axes move decoupled to the common position.
    Synchronising,
    /// Synchronised.
    Synchronised,
    /// MD37140 = 1.
    Open,
}

impl Phase {
    /// A short text for the phase.
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

/// All transitions of a grouping.
pub const TRANSITIONS: &[Transition<Phase, Rule>] = &[
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

const _: () = assert!(TRANSITIONS.len() <= u64::BITS as usize);

/// Index of the gantry grouping among the charts of this control.
pub(in crate::sinumerik) const GROUPING_CHART: usize = 1;

/// The events that set or reset the warning and the trip of a synchronous axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct LimitCauses {
    /// Event behind 101.3.
    pub warning: EventId,
    /// Event behind 101.2.
    pub trip: EventId,
}

/// The monitoring results of one synchronous axis.
#[derive(Clone, Copy, Debug)]
pub(in crate::sinumerik) struct Monitored {
    /// The axis.
    pub axis: AxisNumber,
    /// The synchronism difference.
    pub difference: Position,
    /// Above MD37110: 101.3.
    pub warning: bool,
    /// Above MD37120 or MD37130: 101.2.
    pub trip: bool,
    /// The events behind both.
    pub causes: LimitCauses,
}

/// Whether extended monitoring of a grouping can act (MON-10, MON-11).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Readiness {
    /// The axes have not all been referenced since power on, or since a trip was released.
    #[default]
    NotReferenced,
    /// All axes have been referenced.
    Ready,
    /// A trip was released. The grouping must be referenced or synchronised again.
    Released,
}

impl Readiness {
    /// Called in each cycle.
    pub(in crate::sinumerik) fn observe(&mut self, all_referenced: bool) {
        *self = match (*self, all_referenced) {
            (Self::Ready, true | false) | (Self::NotReferenced, true) => Self::Ready,
            (Self::Released, true) => Self::Released,
            (Self::NotReferenced | Self::Released, false) => Self::NotReferenced,
        };
    }

    /// A trip was released.
    pub(in crate::sinumerik) fn release(&mut self) {
        if *self == Self::Ready {
            *self = Self::Released;
        }
    }
}

/// The state of extended monitoring of a grouping.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Extended {
    /// Whether it can act.
    pub readiness: Readiness,
    /// Synchronous axes that tripped in extended monitoring; their 10653 stays.
    pub tripped: AxisSet,
    /// Synchronous axes that were switched off like this, each with the event behind its 10657.
    pub switched_off: ArrayVec<(AxisNumber, EventId), SYNCHRONOUS_AXES>,
    /// Differences to be written into MD37135.
    pub differences: ArrayVec<(AxisNumber, Position), SYNCHRONOUS_AXES>,
}

impl Extended {
    /// Whether extended monitoring of a synchronous axis acts.
    pub(in crate::sinumerik) fn acts(&self, axis: AxisNumber, parameters: &Parameters) -> bool {
        self.readiness == Readiness::Ready && parameters.axes[axis].gantry.extended_monitoring
    }

    /// An axis tripped in extended monitoring.
    pub(in crate::sinumerik) fn trip(&mut self, axis: AxisNumber, difference: Position) {
        self.tripped.set(axis, true);
        self.differences.retain(|(other, _)| *other != axis);
        self.differences.push((axis, difference));
    }
}

/// One grouping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Grouping {
    /// Its number, 1 to 8.
    pub number: u8,
    /// Leading and synchronous axes: the axis that leads now, the connection, and the differences.
    pub coupling: GantryCoupling,
    /// Phase.
    pub phase: Phase,
    /// Index of the synchronous axis that is being referenced.
    pub turn: u8,
    /// Direction of the key that started the approach; 0 for channel-specific referencing.
    pub key: i8,
    /// Section 3 was entered from section 2, and since then there was no RESET and REF stayed selected (REF-15).
    pub from_referencing: bool,
    /// 10654 is displayed; RESET clears it (O-09).
    pub message: bool,
    /// The grouping waited before the synchronising motion; 101.4 was set.
    pub waited_for: bool,
    /// The cycles for which the synchronising motion has been shown, up to the smallest number (O-32).
    pub shown_cycles: u8,
    /// 29.4 of the leading axis in the last cycle.
    pub start_was: bool,
    /// The axes were in follow-up in the last cycle.
    pub followed_up: bool,
    /// Follow-up has ended and position control is not yet active again.
    pub returning: bool,
    /// Synchronism was lost in operation: it has not been restored, and no reference has been set anew since.
    pub lost_in_operation: bool,
    /// Closing was prevented by 10658 (BRK-05).
    pub kept_open: bool,
    /// Extended monitoring.
    pub extended: Extended,
    /// The events that set or reset the warning and the trip of each synchronous axis.
    pub limit_causes: [LimitCauses; SYNCHRONOUS_AXES],
    /// The latest event of the grouping.
    pub cause: EventId,
}

impl Grouping {
    /// The state after power on: no difference, nothing referenced.
    #[must_use]
    pub(in crate::sinumerik) fn new(definition: &Definition) -> Self {
        Self {
            number: definition.number,
            coupling: definition.coupling.clone(),
            phase: Phase::NotSynchronised,
            turn: 0,
            key: 0,
            from_referencing: false,
            message: false,
            waited_for: false,
            shown_cycles: 0,
            start_was: false,
            followed_up: false,
            returning: false,
            lost_in_operation: false,
            kept_open: false,
            extended: Extended::default(),
            limit_causes: [LimitCauses::default(); SYNCHRONOUS_AXES],
            cause: EventId::NONE,
        }
    }

    /// The axis that is being referenced in section 1 or 2.
    pub(in crate::sinumerik) fn referencing(&self) -> Option<AxisNumber> {
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

    /// Whether section 1 or 2 is running.
    #[must_use]
    pub(in crate::sinumerik) fn is_referencing(&self) -> bool {
        self.referencing().is_some()
    }

    /// Whether the decisions about both groupings are equal; their differences may differ within the limits.
    pub(in crate::sinumerik) fn has_decisions_of(&self, other: &Self) -> bool {
        // Without `..`, so that a new field is named here.
        let Self {
            number: _,
            coupling,
            phase,
            turn,
            key,
            from_referencing,
            message,
            waited_for,
            shown_cycles,
            start_was,
            followed_up,
            returning,
            lost_in_operation,
            kept_open,
            extended,
            limit_causes,
            cause,
        } = self;
        coupling.differs_only_in_differences(&other.coupling)
            && (phase, turn, key, limit_causes) == (&other.phase, &other.turn, &other.key, &other.limit_causes)
            && (from_referencing, message, waited_for, shown_cycles)
                == (&other.from_referencing, &other.message, &other.waited_for, &other.shown_cycles)
            && (start_was, followed_up, returning) == (&other.start_was, &other.followed_up, &other.returning)
            && (lost_in_operation, kept_open, extended) == (&other.lost_in_operation, &other.kept_open, &other.extended)
            && cause == &other.cause
    }

    /// Whether its decisions depend on the positions of its axes: an approach, a synchronising motion, an open grouping, and one that is
    /// ready again when its differences are small enough.
    pub(in crate::sinumerik) fn decisions_follow_movement(&self, axes: &PerAxis<Axis>) -> bool {
        match self.phase {
            Phase::ReferencingLeadingAxis | Phase::ReferencingSynchronousAxis | Phase::Synchronising | Phase::Open => {
                true
            }
            Phase::NotSynchronised => self.coupling.members().all(|axis| axes[axis].is_referenced()),
            Phase::WaitingForStart | Phase::Synchronised => !self.coupling.is_closed(),
        }
    }

    /// The monitoring results of each synchronous axis.
    pub(in crate::sinumerik) fn monitored(&self) -> impl Iterator<Item = Monitored> {
        self.coupling.differences().zip(&self.limit_causes).map(|((axis, difference, stage), &causes)| Monitored {
            axis,
            difference,
            warning: stage.first,
            trip: stage.second,
            causes,
        })
    }

    /// Makes a transition of the table.
    pub(in crate::sinumerik) fn step(&mut self, log: &mut Log, by: Rule, inputs: [Input; 3], parent: EventId) {
        self.lost_in_operation |= self.phase == Phase::Synchronised;
        self.phase = next(TRANSITIONS, &mut log.taken.0[GROUPING_CHART], self.phase, by);
        self.cause = log.note(Place::Axis(self.coupling.leader()), by, inputs, parent);
        match self.phase {
            Phase::WaitingForStart => (self.message, self.waited_for) = (true, true),
            Phase::ReferencingLeadingAxis => self.waited_for = false,
            Phase::Synchronising => self.shown_cycles = 0,
            Phase::Synchronised => {
                self.clear_bases();
                self.extended.readiness = Readiness::Ready;
            }
            Phase::Open => self.coupling.clear_bases(),
            Phase::NotSynchronised | Phase::ReferencingSynchronousAxis => {}
        }
        if self.phase != Phase::Synchronising {
            self.coupling.abort_realignment();
        }
    }

    /// The limits count from 0 until synchronism is lost in operation again (E-14).
    pub(in crate::sinumerik) fn clear_bases(&mut self) {
        self.lost_in_operation = false;
        self.coupling.clear_bases();
    }
}

/// The declarations already reported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Declared {
    /// The data that must be equal have been compared since power on.
    pub compared: bool,
    /// Synchronous axes of closed groupings with MD30450 = 1.
    pub concurrent: AxisSet,
}
