//! The policy of a coupling, defined by the control: how each follower is coupled, the base of its difference, its two limits, and the
//! reaction of the group.
//!
//! A control builds these values from its machine data or parameter lists. They are plain data. The engine reads them and does not change
//! them, except that a control may replace the limits of a follower in every cycle.

use std::ops::Mul;

use serde::{Deserialize, Serialize};

use crate::motion::Movement;
use crate::units::{AxisNumber, AxisSet, Position};

/// The coupling factor: +1, or −1 for a mirror coupling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sign {
    /// The follower moves in the direction of the leader.
    #[default]
    Plus,
    /// The follower moves in the opposite direction.
    Minus,
}

impl Mul for Sign {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if self == other { Self::Plus } else { Self::Minus }
    }
}

impl Mul<Position> for Sign {
    type Output = Position;
    fn mul(self, position: Position) -> Position {
        match self {
            Self::Plus => position,
            Self::Minus => -position,
        }
    }
}

impl Mul<Movement> for Sign {
    type Output = Movement;
    fn mul(self, movement: Movement) -> Movement {
        match self {
            Self::Plus => movement,
            Self::Minus => movement.reversed(),
        }
    }
}

/// The nominal distance between a coupled follower and its leader: follower minus factor × leader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum OffsetSource {
    /// Zero, when both are referenced.
    #[default]
    Zero,
    /// This distance, when both are referenced.
    Configured(Position),
    /// The distance of their actual values when the control started.
    AtStartUp,
    /// The distance of their setpoints when the coupling was last closed.
    AtActivation,
}

/// The limits of a difference. A limit is exceeded only by a strictly greater value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TwoStage {
    /// The first limit; `None` without a first stage.
    pub first: Option<Position>,
    /// The second limit.
    pub second: Position,
    /// With a value, both stages count from the base of [`Coupling::keep_bases`](super::Coupling::keep_bases) and
    /// [`Coupling::move_base`](super::Coupling::move_base). While there is a base, this is another second limit, and the smaller one acts. `None`: the limits count from zero, also while there is a base.
    pub second_beyond_base: Option<Position>,
}

impl TwoStage {
    /// Two limits that count from zero.
    #[must_use]
    pub const fn new(first: Option<Position>, second: Position) -> Self {
        Self { first, second, second_beyond_base: None }
    }
}

/// A follower, as a control defines it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Follower {
    /// The axis.
    pub axis: AxisNumber,
    /// The direction in which it follows.
    pub factor: Sign,
    /// The base of its difference.
    pub offset: OffsetSource,
    /// Its limits. Without limits its difference is not monitored.
    pub limits: Option<TwoStage>,
}

impl Follower {
    /// A follower with factor +1, without an offset and not yet monitored.
    #[must_use]
    pub const fn new(axis: AxisNumber) -> Self {
        Self { axis, factor: Sign::Plus, offset: OffsetSource::Zero, limits: None }
    }
}

/// The reaction of the engine to an exceeded limit, in addition to the event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reaction {
    /// None. The control reacts, for example with an alarm.
    Report,
    /// The group is halted until [`Coupling::reset`](super::Coupling::reset).
    Stop,
    /// The group is halted as long as this coupling exists. Only a restart of the control ends the halt.
    Lock,
}

/// The difference with offset [`OffsetSource::Zero`] or [`OffsetSource::Configured`] before both axes are referenced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BeforeReference {
    /// It is not monitored.
    Off,
    /// It counts from the positions at which counting began: at start-up, or when the coupling closed.
    Relative,
}

/// The base of a relative difference when the coupling closes again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Release {
    /// The positions at that time: a difference that arose while the coupling was open does not count.
    CountAnew,
    /// The previous base: a difference that arose while the coupling was open counts.
    Keep,
}

/// Which members stop, and how, when the group has to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum GroupStop {
    /// All, with the smallest deceleration among them.
    AllAtTheSlowest,
    /// All, each with its own deceleration.
    EachAtItsOwn,
    /// The leading member, with its own deceleration; the others follow it to standstill.
    Leading,
}

/// The reactions of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Policy {
    /// To a difference above the first limit.
    pub first: Reaction,
    /// To a difference above the second limit.
    pub second: Reaction,
    /// Differences before the axes are referenced.
    pub before_reference: BeforeReference,
    /// To closing after a release.
    pub release: Release,
    /// To a stop.
    pub stop: GroupStop,
}

/// Which members move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Moves {
    /// Leader and followers.
    All,
    /// The followers; the leader stays.
    Followers,
    /// These; all others stay.
    Only(AxisSet),
}

impl Moves {
    /// Whether a member of a coupling with this leader moves.
    pub(super) fn moves(self, axis: AxisNumber, leader: AxisNumber) -> bool {
        match self {
            Self::All => true,
            Self::Followers => axis != leader,
            Self::Only(members) => members.contains(axis),
        }
    }
}

/// The final position of the leader. The final position of each follower results from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// At its present actual value.
    LeaderActual,
    /// At its present setpoint.
    LeaderSetpoint,
    /// This position.
    Given(Position),
}

/// The parameters of a realignment. A control chooses them when the realignment begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Realign {
    /// Which members move.
    pub moves: Moves,
    /// The target.
    pub target: Target,
}
