//! The differences of a coupling: actual value of the follower minus factor × actual value of the leader minus a base, and
//! what becomes of it when it crosses a limit.
//!
//! The base is what counts as no difference. A captured offset is the base for good. An offset of zero or of a configured
//! length becomes the base once leader and follower are referenced; before that the base is where they were when counting
//! began. A reference gives a place another actual value: the base goes with it, so that the difference does not jump, except
//! for the reference that makes it absolute.

use arrayvec::ArrayVec;

use super::policy::{BeforeReference, OffsetSource, Reaction, TwoStage};
use super::state::{Axes, Coupled, Coupling, Halt, MEMBERS, Stage};
use crate::units::{AxisNumber, Position};

/// A limit as it acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The difference that may not be exceeded.
    pub at: Position,
    /// How much of it is the base, where it counts beyond one.
    pub base: Option<Position>,
}

impl Limit {
    fn new(at: Position, base: Option<Position>) -> Self {
        Self { at: base.map_or(at, |base| at + base), base }
    }

    /// The limit itself, without the base.
    #[must_use]
    pub fn own(self) -> Position {
        self.base.map_or(self.at, |base| self.at - base)
    }

    fn is_exceeded_by(self, difference: Position) -> bool {
        difference.abs() > self.at
    }
}

/// What happened to a follower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// Its difference went beyond the first limit.
    FirstExceeded(Limit),
    /// Its difference is not beyond the first limit any more; `None` where there is no such limit any more.
    FirstBack(Option<Limit>),
    /// Its difference went beyond the second limit.
    SecondExceeded(Limit),
    /// Its difference is not beyond the second limit any more; `None` where there is no such limit any more.
    SecondBack(Option<Limit>),
    /// The realignment ended on its target.
    Realigned,
    /// It does not follow any more.
    Released,
    /// The coupling is closed again: it will follow as soon as all members rest.
    Closed,
}

/// An event of a coupling, without the words of any control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CouplingEvent {
    /// Which follower.
    pub follower: AxisNumber,
    /// Its difference.
    pub difference: Position,
    /// What happened.
    pub what: What,
}

/// The events of one call, in the order of the followers: at most one for each of the two stages.
pub type Events = ArrayVec<CouplingEvent, { 2 * (MEMBERS - 1) }>;

impl Coupled {
    /// What the actual values are apart, without a base.
    fn apart(&self, leader: AxisNumber, axes: &impl Axes) -> Position {
        axes.actual(self.follower.axis) - self.follower.factor * axes.actual(leader)
    }

    pub(super) fn difference(&self, leader: AxisNumber, axes: &impl Axes) -> Position {
        self.apart(leader, axes) - self.base
    }

    /// The base that acts once both axes are referenced; none where the offset was captured.
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

    /// What the follower is apart from the leader at the end of a realignment.
    pub(super) fn offset(&self) -> Position {
        self.absolute_base().unwrap_or(self.base)
    }

    /// Takes the present positions as no difference, unless the base is absolute or was captured at another time.
    pub(super) fn count_anew(&mut self, leader: AxisNumber, axes: &impl Axes) {
        match self.absolute_base() {
            Some(base) if self.is_referenced(leader, axes) => self.base = base,
            Some(_) => self.base = self.apart(leader, axes),
            None => {}
        }
    }

    /// Takes the offset that the setpoints have now, where it is to be captured at activation.
    pub(super) fn activate(&mut self, leader: AxisNumber, axes: &impl Axes) {
        if self.follower.offset == OffsetSource::AtActivation {
            let setpoint = |axis| axes.setpoint(axis).position;
            self.base = setpoint(self.follower.axis) - self.follower.factor * setpoint(leader);
        }
    }

    /// The limits that act: a base widens the first one, and the second one where that says so.
    fn limits(&self, limits: TwoStage) -> (Option<Limit>, Limit) {
        let second = Limit::new(limits.second, None);
        let beyond_base = limits.second_beyond_base.filter(|_| self.kept.is_some());
        let beyond_base = beyond_base.map(|at| Limit::new(at, self.kept)).filter(|limit| limit.at < second.at);
        (limits.first.map(|at| Limit::new(at, self.kept)), beyond_base.unwrap_or(second))
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
    /// The control starts: offsets of start-up are captured, and differences that are not absolute count from here.
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

    /// Differences that are not absolute and have no captured offset count from here.
    pub fn count_anew(&mut self, axes: &impl Axes) {
        for coupled in &mut self.followers {
            coupled.count_anew(self.leader, axes);
        }
    }

    /// The actual value of an axis was given another value, by this much, by a reference: nothing moved.
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

    /// Replaces the limits of all followers; with `None` one is not monitored.
    pub fn set_limits(&mut self, limits: impl Fn(AxisNumber) -> Option<TwoStage>) {
        for coupled in &mut self.followers {
            coupled.follower.limits = limits(coupled.follower.axis);
        }
    }

    /// Compares the differences of all followers with their limits, once per cycle after the encoders. `events` takes an event
    /// for each limit that was crossed since the last time, and nothing else. While the coupling is open, nothing is beyond a limit.
    pub fn compare(&mut self, axes: &impl Axes, events: &mut Events) {
        events.clear();
        let (leader, open) = (self.leader, self.is_open());
        for coupled in &mut self.followers {
            let counts = self.policy.before_reference == BeforeReference::Relative
                || coupled.absolute_base().is_none()
                || coupled.is_referenced(leader, axes);
            let limits = coupled.follower.limits.filter(|_| counts && !open);
            coupled.compare(coupled.difference(leader, axes), limits, events);
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

    /// The present difference of a follower.
    #[must_use]
    pub fn difference(&self, follower: AxisNumber, axes: &impl Axes) -> Option<Position> {
        Some(self.follower(follower)?.difference(self.leader, axes))
    }

    /// What a follower and the leader are apart beyond the offset, whatever the difference counts from: what a realignment
    /// removes.
    #[must_use]
    pub fn misalignment(&self, follower: AxisNumber, axes: &impl Axes) -> Option<Position> {
        let coupled = self.follower(follower)?;
        Some(coupled.apart(self.leader, axes) - coupled.offset())
    }

    /// The difference of each follower and the limits that it is beyond, as they were compared the last time.
    pub fn differences(&self) -> impl Iterator<Item = (AxisNumber, Position, Stage)> + '_ {
        self.followers.iter().map(|coupled| (coupled.follower.axis, coupled.difference, coupled.stage))
    }

    /// Whether the group is halted by its policy.
    #[must_use]
    pub const fn halt(&self) -> Option<Halt> {
        self.halt
    }

    /// Ends a halt that can be reset. A difference that is still beyond its limit halts again only after it was back.
    pub fn reset(&mut self) {
        self.halt = self.halt.filter(|halt| *halt == Halt::Locked);
    }

    /// Position control is back after a loss: the amount of each difference is the base beyond which limits count.
    pub fn keep_bases(&mut self, axes: &impl Axes) {
        for coupled in &mut self.followers {
            coupled.kept = Some(coupled.difference(self.leader, axes).abs());
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
