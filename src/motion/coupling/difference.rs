//! The differences of a coupling and their limits. A difference is the actual value of the follower minus factor × actual value of the
//! leader minus a base.
//!
//! The base is the offset that counts as no difference. A captured offset stays the base. An offset of zero or of a configured length
//! becomes the base when leader and follower are referenced; before that, the base is their distance when counting began. A reference
//! changes the actual value of a position, and the base changes with it, so the difference does not jump. The exception is the reference
//! that makes the difference absolute.

use arrayvec::ArrayVec;

use super::policy::{BeforeReference, OffsetSource, Reaction, TwoStage};
use super::state::{Axes, Connection, Coupled, Coupling, Halt, MEMBERS, Stage};
use crate::units::{AxisNumber, Position};

/// A limit in effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The largest permitted distance from the base, in both directions.
    pub at: Position,
    /// The difference from which the limit counts; `None` if it counts from zero.
    pub base: Option<Position>,
}

impl Limit {
    /// The distance of a difference from the base.
    #[must_use]
    pub fn distance(self, difference: Position) -> Position {
        (difference - self.base.unwrap_or(Position::ZERO)).abs()
    }

    fn is_exceeded_by(self, difference: Position) -> bool {
        self.distance(difference) > self.at
    }
}

/// An event of a follower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// Its difference exceeded the first limit.
    FirstExceeded(Limit),
    /// Its difference returned within the first limit; `None` if the first limit no longer exists.
    FirstBack(Option<Limit>),
    /// Its difference exceeded the second limit.
    SecondExceeded(Limit),
    /// Its difference returned within the second limit; `None` if the second limit no longer exists.
    SecondBack(Option<Limit>),
    /// The realignment reached its target.
    Realigned,
    /// It no longer follows.
    Released,
    /// The coupling is closed again: it follows when all members are at rest.
    Closed,
}

/// An event of a coupling, independent of the kind of control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CouplingEvent {
    /// The follower.
    pub follower: AxisNumber,
    /// Its difference.
    pub difference: Position,
    /// The event.
    pub what: What,
}

/// The events of one call, in the order of the followers: at most one for each of the two stages.
pub type Events = ArrayVec<CouplingEvent, { 2 * (MEMBERS - 1) }>;

impl Coupled {
    /// The distance of the actual values, without a base.
    fn apart(&self, leader: AxisNumber, axes: &impl Axes) -> Position {
        axes.actual(self.follower.axis) - self.follower.factor * axes.actual(leader)
    }

    pub(super) fn difference(&self, leader: AxisNumber, axes: &impl Axes) -> Position {
        self.apart(leader, axes) - self.base
    }

    /// The base that acts when both axes are referenced; none if the offset was captured.
    const fn absolute_base(&self) -> Option<Position> {
        match self.follower.offset {
            OffsetSource::Zero => Some(Position::ZERO),
            OffsetSource::Configured(offset) => Some(offset),
            OffsetSource::AtStartUp | OffsetSource::AtActivation => None,
        }
    }

    fn is_referenced(&self, leader: AxisNumber, axes: &impl Axes) -> bool {
        axes.is_referenced(self.follower.axis) && axes.is_referenced(leader)
    }

    /// The distance between follower and leader at the end of a realignment: before both are referenced, the distance that counts as no
    /// difference.
    pub(super) fn offset(&self, leader: AxisNumber, axes: &impl Axes) -> Position {
        self.absolute_base().filter(|_| self.is_referenced(leader, axes)).unwrap_or(self.base)
    }

    /// Takes the present positions as no difference, unless the base is absolute or is captured at another time.
    pub(super) fn count_anew(&mut self, leader: AxisNumber, axes: &impl Axes) {
        match self.absolute_base() {
            Some(base) if self.is_referenced(leader, axes) => self.base = base,
            Some(_) => self.base = self.apart(leader, axes),
            None => {}
        }
    }

    /// Captures the present offset of the setpoints, if the policy captures it at activation.
    pub(super) fn activate(&mut self, leader: AxisNumber, axes: &impl Axes) {
        if self.follower.offset == OffsetSource::AtActivation {
            let setpoint = |axis| axes.setpoint(axis).position;
            self.base = setpoint(self.follower.axis) - self.follower.factor * setpoint(leader);
        }
    }

    /// The limits with which its difference is compared; `None` if it is not monitored.
    fn compared(&self, leader: AxisNumber, before_reference: BeforeReference, axes: &impl Axes) -> Option<TwoStage> {
        let counts = before_reference == BeforeReference::Relative
            || self.absolute_base().is_none()
            || self.is_referenced(leader, axes);
        self.follower.limits.filter(|_| counts)
    }

    /// The limits in effect. They count from the kept base if they are defined to do so; the smaller second limit then acts.
    fn limits(&self, limits: TwoStage) -> (Option<Limit>, Limit) {
        let base = self.kept.filter(|_| limits.second_beyond_base.is_some());
        let beyond_base = limits.second_beyond_base.filter(|_| base.is_some());
        let second = beyond_base.map_or(limits.second, |at| at.min(limits.second));
        (limits.first.map(|at| Limit { at, base }), Limit { at: second, base })
    }

    /// While members realign, the base follows the difference towards zero; otherwise the realignment itself would exceed the limits.
    fn lower_base(&mut self, difference: Position) {
        if let Some(base) = &mut self.kept {
            *base = difference.clamp(Position::ZERO.min(*base), Position::ZERO.max(*base));
        }
    }

    fn compare(&mut self, difference: Position, limits: Option<TwoStage>, events: &mut Events) {
        let limits = limits.map(|limits| self.limits(limits));
        let (first, second) = (limits.and_then(|(first, _)| first), limits.map(|(_, second)| second));
        let exceeded = |limit: Option<Limit>| limit.filter(|limit| limit.is_exceeded_by(difference));
        let stage = Stage { first: exceeded(first).is_some(), second: exceeded(second).is_some() };
        let mut push = |what| events.push(CouplingEvent { follower: self.follower.axis, difference, what });
        if stage.first != self.stage.first {
            push(exceeded(first).map_or(What::FirstBack(first), What::FirstExceeded));
        }
        if stage.second != self.stage.second {
            push(exceeded(second).map_or(What::SecondBack(second), What::SecondExceeded));
        }
        (self.difference, self.stage) = (difference, stage);
    }
}

impl<const FOLLOWERS: usize> Coupling<FOLLOWERS> {
    /// The control starts: captures the offsets of start-up. Differences that are not absolute count from the present positions.
    pub fn start_up(&mut self, axes: &impl Axes) {
        let leader = self.leader;
        for coupled in &mut self.followers {
            if coupled.follower.offset == OffsetSource::AtStartUp {
                coupled.base = coupled.apart(leader, axes);
            }
            coupled.activate(leader, axes);
            coupled.count_anew(leader, axes);
        }
    }

    /// Differences that are not absolute and have no captured offset count from the present positions.
    pub fn count_anew(&mut self, axes: &impl Axes) {
        for coupled in &mut self.followers {
            coupled.count_anew(self.leader, axes);
        }
    }

    /// A reference shifted the actual value of an axis by this amount. Nothing moved.
    pub fn value_shifted(&mut self, axis: AxisNumber, by: Position, axes: &impl Axes) {
        for coupled in &mut self.followers {
            let shift = if axis == coupled.follower.axis {
                by
            } else if axis == self.leader {
                -(coupled.follower.factor * by)
            } else {
                continue;
            };
            match coupled.absolute_base() {
                Some(base) if coupled.is_referenced(self.leader, axes) => coupled.base = base,
                Some(_) | None => coupled.base += shift,
            }
        }
    }

    /// Replaces the limits of all followers. A follower with `None` is not monitored.
    pub fn set_limits(&mut self, limits: impl Fn(AxisNumber) -> Option<TwoStage>) {
        for coupled in &mut self.followers {
            coupled.follower.limits = limits(coupled.follower.axis);
        }
    }

    /// Replaces configured offsets. Where follower and leader are referenced, the new one acts at once.
    pub fn set_offsets(&mut self, offset: impl Fn(AxisNumber) -> Position, axes: &impl Axes) {
        for coupled in &mut self.followers {
            let new = offset(coupled.follower.axis);
            if let OffsetSource::Configured(old) = coupled.follower.offset
                && old != new
            {
                coupled.follower.offset = OffsetSource::Configured(new);
                if coupled.is_referenced(self.leader, axes) {
                    coupled.base = new;
                }
            }
        }
    }

    /// Compares the differences of all followers with their limits, once per cycle after the encoders. Adds one event to `events` for each
    /// limit that was crossed since the last call. While the coupling is open, no limit counts as exceeded.
    pub fn compare(&mut self, axes: &impl Axes, events: &mut Events) {
        events.clear();
        let (leader, open) = (self.leader, self.is_open());
        let realigns = matches!(self.connection, Connection::Realigning(_) | Connection::Settling);
        for coupled in &mut self.followers {
            let limits = coupled.compared(leader, self.policy.before_reference, axes).filter(|_| !open);
            let difference = coupled.difference(leader, axes);
            if realigns {
                coupled.lower_base(difference);
            }
            coupled.compare(difference, limits, events);
        }
        for event in &*events {
            let reaction = match event.what {
                What::FirstExceeded(_) => self.policy.first,
                What::SecondExceeded(_) => self.policy.second,
                What::FirstBack(_) | What::SecondBack(_) | What::Realigned | What::Released | What::Closed => continue,
            };
            self.halt = self.halt.max(match reaction {
                Reaction::Report => None,
                Reaction::Stop => Some(Halt::UntilReset),
                Reaction::Lock => Some(Halt::Locked),
            });
        }
    }

    /// The first and the second limit in effect for a follower; `None` while its difference is not monitored.
    #[must_use]
    pub fn limits(&self, follower: AxisNumber, axes: &impl Axes) -> Option<(Option<Limit>, Limit)> {
        let coupled = self.follower(follower)?;
        let compared = coupled.compared(self.leader, self.policy.before_reference, axes);
        compared.filter(|_| !self.is_open()).map(|limits| coupled.limits(limits))
    }

    /// The present difference of a follower.
    #[must_use]
    pub fn difference(&self, follower: AxisNumber, axes: &impl Axes) -> Option<Position> {
        Some(self.follower(follower)?.difference(self.leader, axes))
    }

    /// The distance between a follower and the leader beyond the offset, independent of the base. A realignment removes it.
    #[must_use]
    pub fn misalignment(&self, follower: AxisNumber, axes: &impl Axes) -> Option<Position> {
        let coupled = self.follower(follower)?;
        Some(coupled.apart(self.leader, axes) - coupled.offset(self.leader, axes))
    }

    /// The distance between the setpoints of a follower and the leader beyond the offset: what a realignment moves.
    #[must_use]
    pub fn setpoint_misalignment(&self, follower: AxisNumber, axes: &impl Axes) -> Option<Position> {
        let coupled = self.follower(follower)?;
        let setpoint = |axis| axes.setpoint(axis).position;
        let apart = setpoint(follower) - coupled.follower.factor * setpoint(self.leader);
        Some(apart - coupled.offset(self.leader, axes))
    }

    /// Whether the difference of a follower is compared with limits.
    #[must_use]
    pub fn is_monitored(&self, follower: AxisNumber) -> bool {
        self.follower(follower).is_some_and(|coupled| coupled.follower.limits.is_some())
    }

    /// The difference of each follower and the limits that it exceeded at the last comparison.
    pub fn differences(&self) -> impl Iterator<Item = (AxisNumber, Position, Stage)> + '_ {
        self.followers.iter().map(|coupled| (coupled.follower.axis, coupled.difference, coupled.stage))
    }

    /// The halt of the group by its policy, if any.
    #[must_use]
    pub const fn halt(&self) -> Option<Halt> {
        self.halt
    }

    /// Ends a halt that can be reset. A difference that still exceeds its limit halts the group again only after it has returned within the
    /// limit.
    pub fn reset(&mut self) {
        self.halt = self.halt.filter(|halt| *halt == Halt::Locked);
    }

    /// Keeps each present difference, with its sign, as the base from which limits count.
    pub fn keep_bases(&mut self, axes: &impl Axes) {
        for coupled in &mut self.followers {
            coupled.kept = Some(coupled.difference(self.leader, axes));
        }
    }

    /// Moves the base from which the limits of one follower count: its difference has changed by this amount although nothing moved.
    pub fn move_base(&mut self, follower: AxisNumber, by: Position) {
        for coupled in self.followers.iter_mut().filter(|coupled| coupled.follower.axis == follower) {
            coupled.kept = Some(coupled.kept.unwrap_or(Position::ZERO) + by);
        }
    }

    /// Limits count from zero again.
    pub fn clear_bases(&mut self) {
        for coupled in &mut self.followers {
            coupled.kept = None;
        }
    }

    /// The same event for each follower.
    pub(super) fn for_each(&self, what: What, axes: &impl Axes) -> Events {
        let event = |coupled: &Coupled| CouplingEvent {
            follower: coupled.follower.axis,
            difference: coupled.difference(self.leader, axes),
            what,
        };
        self.followers.iter().map(event).collect()
    }
}
