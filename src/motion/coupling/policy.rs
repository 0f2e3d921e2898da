//! What a control decides about a coupling: how each follower is coupled, where its difference counts from, its two limits,
//! and how the group reacts.
//!
//! A control builds these values from its machine data or parameter lists. They are plain data; the engine reads them and
//! never changes them, except for the limits of a follower, which a control may replace in every cycle.

use std::ops::Mul;

use serde::{Deserialize, Serialize};

use crate::motion::Movement;
use crate::units::{AxisNumber, Position};

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

/// What a coupled follower and its leader are apart when nothing is wrong: follower minus factor × leader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum OffsetSource {
    /// Nothing, once both are referenced.
    #[default]
    Zero,
    /// This much, once both are referenced.
    Configured(Position),
    /// What their actual values were apart when the control started.
    AtStartUp,
    /// What their setpoints were apart when the coupling was closed the last time.
    AtActivation,
}

/// The limits of a difference. Strictly greater is beyond a limit, equal is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TwoStage {
    /// The first limit; `None` where there is no first stage.
    pub first: Option<Position>,
    /// The second limit.
    pub second: Position,
    /// A second limit that counts beyond the base that [`Coupling::keep_bases`](super::Coupling::keep_bases) left. While
    /// there is a base, the smaller one of both second limits acts.
    pub second_beyond_base: Option<Position>,
}

impl TwoStage {
    /// Two limits that are the same with and without a base, but for the first, which always counts beyond it.
    #[must_use]
    pub const fn new(first: Option<Position>, second: Position) -> Self {
        Self { first, second, second_beyond_base: None }
    }
}

/// A follower, as a control defines it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Follower {
    /// Which axis.
    pub axis: AxisNumber,
    /// In which direction it follows.
    pub factor: Sign,
    /// Where its difference counts from.
    pub offset: OffsetSource,
    /// Its limits; without any, its difference is not monitored.
    pub limits: Option<TwoStage>,
}

impl Follower {
    /// A follower with factor +1 and no offset, which is not monitored yet.
    #[must_use]
    pub const fn new(axis: AxisNumber) -> Self {
        Self { axis, factor: Sign::Plus, offset: OffsetSource::Zero, limits: None }
    }
}

/// What the engine does when a limit is exceeded, besides the event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reaction {
    /// Nothing. What follows is the business of the control, for example of its alarms.
    Report,
    /// The group is halted until [`Coupling::reset`](super::Coupling::reset).
    Stop,
    /// The group is halted as long as this coupling exists: only a new start of the control ends it.
    Lock,
}

/// What a difference with offset [`OffsetSource::Zero`] or [`OffsetSource::Configured`] means before both axes are referenced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BeforeReference {
    /// It is not monitored.
    Off,
    /// It counts from where the axes were when counting began: at start-up, or when the coupling closed.
    Relative,
}

/// Where a difference counts from when the coupling closes again, as long as it is relative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Release {
    /// From where the axes are then: what arose while it was open does not count.
    CountAnew,
    /// From where it counted before: what arose while it was open counts.
    Keep,
}

/// Which members stop, and how, when the group has to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum GroupStop {
    /// All, with the smallest deceleration of any of them.
    AllAtTheSlowest,
    /// All, each with its own deceleration.
    EachAtItsOwn,
    /// The one that leads, with its own deceleration; the others follow it to rest.
    Leading,
}

/// How a group reacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Policy {
    /// To a difference beyond the first limit.
    pub first: Reaction,
    /// To a difference beyond the second limit.
    pub second: Reaction,
    /// Before its axes are referenced.
    pub before_reference: BeforeReference,
    /// To being closed again.
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
}

/// Where the leader is at the end; each follower goes to where that puts it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// At its present actual value.
    LeaderActual,
    /// At its present setpoint.
    LeaderSetpoint,
    /// Here.
    Given(Position),
}

/// How a realignment runs. A control decides it when it begins one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Realign {
    /// Which members move.
    pub moves: Moves,
    /// Where to.
    pub target: Target,
}
