//! The state of a coupling: its members, the leading member, and the connection. Plain data.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use super::policy::{Follower, Moves, Policy, Sign};
use crate::motion::{Movement, Setpoint};
use crate::units::{AxisNumber, AxisSet, Position};

/// Largest number of members of a coupling.
pub(super) const MEMBERS: usize = AxisNumber::MAX as usize;

/// The axis data that a coupling reads from a control.
pub trait Axes {
    /// The actual value.
    fn actual(&self, axis: AxisNumber) -> Position;
    /// The setpoint.
    fn setpoint(&self, axis: AxisNumber) -> &Setpoint;
    /// Whether the actual value refers to the zero point of the machine.
    fn is_referenced(&self, axis: AxisNumber) -> bool;
}

/// The limits that a difference exceeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stage {
    /// Above the first limit.
    pub first: bool,
    /// Above the second limit.
    pub second: bool,
}

/// The kind of a halt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Halt {
    /// A reset ends it.
    UntilReset,
    /// Only a restart of the control ends it.
    Locked,
}

/// A follower and its state in the engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Coupled {
    pub follower: Follower,
    /// The offset that counts as no difference.
    pub base: Position,
    /// The difference at the last comparison.
    pub difference: Position,
    /// The limits that it exceeded then.
    pub stage: Stage,
    /// The difference from which limits count.
    pub kept: Option<Position>,
}

impl Coupled {
    pub(super) const fn new(follower: Follower) -> Self {
        let stage = Stage { first: false, second: false };
        Self { follower, base: Position::ZERO, difference: Position::ZERO, stage, kept: None }
    }

    fn differs_only_in_difference(&self, other: &Self) -> bool {
        (self.follower, self.base, self.stage, self.kept) == (other.follower, other.base, other.stage, other.kept)
    }
}

/// The connection of the members.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Connection {
    /// Movements are passed on.
    Closed,
    /// The members move decoupled to their targets.
    Realigning(Realignment),
    /// It closes when all members are at rest.
    Settling,
    /// The members are independent.
    Open,
}

/// A running realignment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Realignment {
    pub target: Position,
    pub moves: Moves,
    /// Number of cycles in which a member rested on its target and was not in position.
    pub waited: u64,
}

/// Axes that move together. A control may limit the number of followers with `FOLLOWERS`; memory is reserved only for that number.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Coupling<const FOLLOWERS: usize = { MEMBERS - 1 }> {
    pub(super) leader: AxisNumber,
    pub(super) leads_now: AxisNumber,
    pub(super) policy: Policy,
    pub(super) connection: Connection,
    pub(super) halt: Option<Halt>,
    pub(super) followers: ArrayVec<Coupled, FOLLOWERS>,
}

impl<const FOLLOWERS: usize> Coupling<FOLLOWERS> {
    /// A closed coupling whose differences count from zero; `None` if an axis is listed twice or there are too many axes.
    #[must_use]
    pub fn new(leader: AxisNumber, policy: Policy, followers: impl IntoIterator<Item = Follower>) -> Option<Self> {
        let mut members = AxisSet::of(leader);
        let mut coupling = Self {
            leader,
            leads_now: leader,
            policy,
            connection: Connection::Closed,
            halt: None,
            followers: ArrayVec::new(),
        };
        for follower in followers {
            if members.contains(follower.axis) {
                return None;
            }
            members.set(follower.axis, true);
            coupling.followers.try_push(Coupled::new(follower)).ok()?;
        }
        Some(coupling)
    }

    /// The leader by definition.
    #[must_use]
    pub const fn leader(&self) -> AxisNumber {
        self.leader
    }

    /// The followers by definition, in the given order.
    pub fn followers(&self) -> impl DoubleEndedIterator<Item = AxisNumber> + ExactSizeIterator + '_ {
        self.followers.iter().map(|coupled| coupled.follower.axis)
    }

    /// The leader, then the followers.
    pub fn members(&self) -> impl Iterator<Item = AxisNumber> + '_ {
        std::iter::once(self.leader).chain(self.followers())
    }

    /// The member that leads at present.
    #[must_use]
    pub const fn leads_now(&self) -> AxisNumber {
        self.leads_now
    }

    /// Makes this member the leading one, or restores the definition. Differences do not change.
    pub fn lead_with(&mut self, axis: AxisNumber) {
        debug_assert!(self.members().any(|member| member == axis));
        self.leads_now = axis;
    }

    /// The movement of each member that does not lead, for a movement of the leading member. Empty while the coupling is not closed.
    pub fn lead(&self, movement: Movement) -> impl Iterator<Item = (AxisNumber, Movement)> + '_ {
        let common = self.factor(self.leads_now) * movement;
        let led = self.members().zip(self.factors()).filter(|_| self.is_closed());
        led.filter(|&(axis, _)| axis != self.leads_now).map(move |(axis, factor)| (axis, factor * common))
    }

    /// Whether the states are equal except for the differences at the last comparison, which exceed the same limits.
    #[must_use]
    pub fn differs_only_in_differences(&self, other: &Self) -> bool {
        (self.leader, self.leads_now, self.policy, self.connection, self.halt)
            == (other.leader, other.leads_now, other.policy, other.connection, other.halt)
            && self.followers.len() == other.followers.len()
            && self.followers.iter().zip(&other.followers).all(|(one, other)| one.differs_only_in_difference(other))
    }

    fn factors(&self) -> impl Iterator<Item = Sign> + '_ {
        std::iter::once(Sign::Plus).chain(self.followers.iter().map(|coupled| coupled.follower.factor))
    }

    fn factor(&self, axis: AxisNumber) -> Sign {
        self.follower(axis).map_or(Sign::Plus, |coupled| coupled.follower.factor)
    }

    pub(super) fn follower(&self, axis: AxisNumber) -> Option<&Coupled> {
        self.followers.iter().find(|coupled| coupled.follower.axis == axis)
    }
}
