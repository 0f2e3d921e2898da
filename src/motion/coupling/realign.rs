//! Realignment: members move decoupled until each follower is at factor × leader + offset.
//!
//! The target is fixed when the realignment begins. The control gives velocity and acceleration of each member in every cycle, so overrides
//! and feed stops act. It also executes the commands, with its own filters if it has any. The realignment ends when every moving member
//! rests on its target and is in position. Only the control aborts it and limits the waiting time.

use arrayvec::ArrayVec;

use super::difference::{Events, What};
use super::policy::{Realign, Target};
use super::state::{Axes, Connection, Coupled, Coupling, MEMBERS, Realignment};
use crate::motion::{Limits, Motion};
use crate::units::{AxisNumber, Position};

/// Progress of a realignment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// A member moves.
    Running,
    /// This member is the first that rests on its target and is not in position, and the number of cycles for which a member has been in
    /// this state.
    Waiting(AxisNumber, u64),
    /// All members are in position. The coupling is closed, with this position of the leader.
    Done(Position),
}

/// One cycle of a realignment.
#[derive(Clone, Debug, PartialEq)]
pub struct Realigning {
    /// The command of each moving member, in the order of the members: a [`Motion::GoTo`].
    pub commands: ArrayVec<(AxisNumber, Motion), MEMBERS>,
    /// Progress.
    pub progress: Progress,
    /// [`What::Realigned`] for each follower when the realignment is done.
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

    /// One cycle of a realignment; `None` if none is running. It ends only in a cycle in which it `may_end`.
    pub fn realign(
        &mut self,
        axes: &impl Axes,
        limits: impl Fn(AxisNumber) -> Limits,
        is_in_position: impl Fn(AxisNumber) -> bool,
        may_end: bool,
    ) -> Option<Realigning> {
        let Connection::Realigning(mut realignment) = self.connection else { return None };
        let mut commands = ArrayVec::new();
        let (mut arrived, mut late) = (true, None);
        for axis in self.members().filter(|&axis| realignment.moves.moves(axis, self.leader)) {
            let target = self.member_target(axis, realignment.target, axes);
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
        let (progress, events) = if arrived && may_end {
            self.connection = Connection::Closed;
            (Progress::Done(realignment.target), self.for_each(What::Realigned, axes))
        } else {
            self.connection = Connection::Realigning(realignment);
            let waiting = |axis| Progress::Waiting(axis, realignment.waited);
            (late.map_or(Progress::Running, waiting), Events::new())
        };
        Some(Realigning { commands, progress, events })
    }

    /// Aborts a realignment. The coupling closes when its members are at rest.
    pub fn abort_realignment(&mut self) {
        if matches!(self.connection, Connection::Realigning(_)) {
            self.connection = Connection::Settling;
        }
    }

    fn member_target(&self, axis: AxisNumber, leader: Position, axes: &impl Axes) -> Position {
        let target = |coupled: &Coupled| coupled.follower.factor * leader + coupled.offset(self.leader, axes);
        self.follower(axis).map_or(leader, target)
    }
}
