//! The interruption point: where a program goes on whose axes were moved meanwhile (P-77).
//!
//! An axis that is not where the path is (it was moved in JOG, or braked alone because it lost its enables) first comes back: all axes go on a
//! straight line to where the path was left (REPOS).

use crate::motion::path::{Feed, Path, PathBlock, Way};
use crate::nc_program::End;
use crate::sinumerik::program::executable::Executable;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::state::{Run, on_path};
use crate::sinumerik::state::State;
use crate::units::Position;

/// An axis that is farther from the path than this is not on it, in increments.
const ON_PATH: f64 = 1.5;

impl State {
    /// Whether an axis of the path is not where the path is. While no block is on the path, its axes are where they are.
    pub(super) fn is_off(&self, run: &Run, stage: &Stage<'_>) -> bool {
        if run.path.is_empty() {
            return false;
        }
        let position = run.path.position();
        stage.own.axes.path.iter().enumerate().any(|(place, &axis)| {
            let is_positioned = run.commanded.contains(axis) || run.positionings.iter().any(|one| one.axis == axis);
            let away = (self.axes[axis].setpoint.position.increments() as f64 - position[place]).abs();
            !is_positioned && away > ON_PATH && self.owners.is_program_axis(axis, stage.channel)
        })
    }

    /// The program has stopped. Without a block on the path, its axes are where the last one ended; axes that have not returned from an earlier
    /// interruption still have to.
    pub(super) fn note_interruption_point(&self, run: &mut Run, stage: &Stage<'_>) {
        if !run.approaches {
            // The axes may be moved meanwhile: the way back begins anew, from where they are then.
            run.returning = None;
        }
        if !run.path.is_empty() {
            return;
        }
        for &axis in &stage.own.axes.path {
            let is_known = run.left.iter().any(|(of, _)| *of == axis);
            if !is_known && !run.leaves_alone(axis) && self.owners.is_program_axis(axis, stage.channel) {
                run.left.push((axis, self.axes[axis].setpoint.position));
            }
        }
    }

    /// Whether the block that runs waits until its axes are back where the program was interrupted: a dwell, and the end of the program. Other
    /// blocks without a motion on the path leave the way back to the next motion (P-77).
    pub(super) fn returns_first(&self, run: &mut Run, stage: &Stage<'_>) -> bool {
        let waits = |block: &Executable| block.end == Some(End::Program);
        let concerned = run.dwell > 0 || run.dwell_turns.is_some() || run.queue.front().is_some_and(waits);
        if !concerned || !run.path.is_empty() {
            return false;
        }
        let mut to = on_path(&stage.own.axes.path, |axis| self.axes[axis].setpoint.position);
        let (mut is_off, mut rests) = (false, true);
        for (place, &axis) in stage.own.axes.path.iter().enumerate() {
            let left = run.left.iter().find(|(of, _)| *of == axis).map(|(_, left)| left.increments() as f64);
            let mine = self.owners.is_program_axis(axis, stage.channel) && !run.leaves_alone(axis);
            let Some(left) = left.filter(|_| mine) else { continue };
            rests &= self.axes[axis].setpoint.is_at_rest();
            if (left - to[place]).abs() > ON_PATH {
                (to[place], is_off) = (left, true);
            }
        }
        if is_off {
            run.path.place(to);
            run.returning = self.way_back(run, stage);
        }
        is_off || !rests
    }

    /// A straight line from where the axes stand to the path; `None` while one of them still moves.
    pub(super) fn way_back(&self, run: &Run, stage: &Stage<'_>) -> Option<Path> {
        let axes = &stage.own.axes;
        let mut own = axes.path.iter().filter(|axis| self.owners.is_program_axis(**axis, stage.channel));
        if !own.all(|axis| self.axes[*axis].setpoint.is_at_rest()) {
            return None;
        }
        let from = on_path(&axes.path, |axis| self.axes[axis].setpoint.position);
        let mut way = Path::new(from, run.limits);
        let programmed = run.queue.front().and_then(|block| block.way).map_or(Feed::Rapid, |block| block.feed);
        let feed = match stage.own.approach_feed {
            feed if feed > 0.0 => Feed::Programmed(feed * Position::PER_USER_UNIT / 60.0),
            _ => programmed,
        };
        let mut to = run.path.position();
        for (place, axis) in axes.path.iter().enumerate() {
            if run.commanded.contains(*axis) {
                to[place] = from[place];
            }
        }
        let line = Way::line(from, to, axes.counted);
        let block = PathBlock { number: 0, way: line, feed, exact_stop: false };
        way.append(block, stage.parameters.cycle.seconds()).ok()?;
        Some(way)
    }
}
