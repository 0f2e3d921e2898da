//! Realignment: members move decoupled until each follower is where factor × leader + offset is.
//!
//! The target is fixed when the realignment begins. The control gives velocity and acceleration of each member in every
//! cycle, so that overrides and feed stops act; it executes the commands, with filters of its own where it has any. The realignment ends when every member that moves rests on its target and is in
//! position; it is the control that breaks it off, and decides how long it waits.

use arrayvec::ArrayVec;

use super::difference::{Events, What};
use super::policy::{Moves, Realign, Target};
use super::state::{Axes, Connection, Coupling, MEMBERS, Realignment};
use crate::motion::{Limits, Motion};
use crate::units::{AxisNumber, Position};

/// How far a realignment is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// A member moves.
    Running,
    /// This member is the first that rests on its target and is not in position; a member is so for this many cycles in all.
    Waiting(AxisNumber, u64),
    /// All members are in position: the coupling is closed, with this leader's position.
    Done(Position),
}

/// One cycle of a realignment.
#[derive(Clone, Debug, PartialEq)]
pub struct Realigning {
    /// What each member that moves is to do, in the order of the members: a [`Motion::GoTo`].
    pub commands: ArrayVec<(AxisNumber, Motion), MEMBERS>,
    /// How far it is.
    pub progress: Progress,
    /// [`What::Realigned`] for each follower, once it is done.
    pub events: Events,
}

impl<const FOLLOWERS: usize> Coupling<FOLLOWERS> {
    /// Decouples the members and fixes their targets.
    pub fn begin_realignment(&mut self, how: Realign, axes: &impl Axes) {
        let target = match how.target {
            Target::LeaderActual => axes.actual(self.leader),
            Target::LeaderSetpoint => axes.setpoint(self.leader).position,
            Target::Given(position) => position,
        };
        self.connection = Connection::Realigning(Realignment { target, moves: how.moves, waited: 0 });
    }

    /// One cycle of a realignment; `None` where none is on its way.
    pub fn realign(
        &mut self,
        axes: &impl Axes,
        limits: impl Fn(AxisNumber) -> Limits,
        is_in_position: impl Fn(AxisNumber) -> bool,
    ) -> Option<Realigning> {
        let Connection::Realigning(mut realignment) = self.connection else { return None };
        let mut commands = ArrayVec::new();
        let (mut arrived, mut late) = (true, None);
        for axis in self.members().filter(|&axis| realignment.moves == Moves::All || axis != self.leader) {
            let target = self.member_target(axis, realignment.target);
            let setpoint = axes.setpoint(axis);
            let rests = setpoint.is_at_rest() && setpoint.position == target;
            let done = rests && is_in_position(axis);
            arrived &= done;
            if rests && !done && late.is_none() {
                late = Some(axis);
            }
            let Limits { velocity, acceleration } = limits(axis);
            commands.push((axis, Motion::GoTo { target, velocity, acceleration }));
        }
        realignment.waited += u64::from(late.is_some());
        let (progress, events) = if arrived {
            self.connection = Connection::Closed;
            (Progress::Done(realignment.target), self.for_each(What::Realigned, axes))
        } else {
            self.connection = Connection::Realigning(realignment);
            let waiting = |axis| Progress::Waiting(axis, realignment.waited);
            (late.map_or(Progress::Running, waiting), Events::new())
        };
        Some(Realigning { commands, progress, events })
    }

    /// Breaks a realignment off: the coupling closes where its members come to rest.
    pub fn abort_realignment(&mut self) {
        if matches!(self.connection, Connection::Realigning(_)) {
            self.connection = Connection::Settling;
        }
    }

    fn member_target(&self, axis: AxisNumber, leader: Position) -> Position {
        self.follower(axis).map_or(leader, |coupled| coupled.follower.factor * leader + coupled.offset())
    }
}
