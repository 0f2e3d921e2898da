//! G74: axes approach their reference points because a program says so.
//!
//! The approach is that of REF, in the direction of MD34010. The block ends when every axis is referenced; a gantry grouping must also be
//! synchronised: while it waits for 29.4 the block waits, and the condition "REF" of its sections counts as met (O-08). A stop of the program
//! aborts the approach; NC start begins it again.

use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::program::state::{ChannelProgram, ProgramState, Run};
use crate::sinumerik::state::{State, Unit};
use crate::variables::EventId;

impl ChannelProgram {
    /// The event of the block that runs.
    pub(in crate::sinumerik) fn block_cause(&self) -> EventId {
        self.run.as_ref().map_or(self.cause, |run| run.block_cause)
    }
}

impl State {
    /// Whether REF is active, or a program references the axes of this unit.
    pub(in crate::sinumerik) fn may_reference(&self, unit: &Unit) -> bool {
        self.mode_group(unit).is_referencing() || self.is_referenced_by_program(unit)
    }

    /// Whether the block that runs references this unit.
    pub(in crate::sinumerik) fn is_referenced_by_program(&self, unit: &Unit) -> bool {
        let program = &self.programs[unit.channel];
        let references =
            |run: &Run| run.stopping.is_none() && run.resetting.is_none() && run.referencing.contains(unit.leader());
        program.state == ProgramState::Running && program.run.as_deref().is_some_and(references)
    }

    /// Whether a program wants the approach of this unit to begin.
    pub(in crate::sinumerik) fn program_wants_reference(&self, unit: &Unit) -> bool {
        let run = self.programs[unit.channel].run.as_deref();
        let begun = run.is_some_and(|run| run.referencing_started.contains(unit.leader()));
        self.is_referenced_by_program(unit) && !begun
    }

    /// The approach begins. Returns the event of the block.
    pub(in crate::sinumerik) fn begin_reference_by_program(&mut self, unit: &Unit) -> EventId {
        let program = &mut self.programs[unit.channel];
        if let Some(run) = &mut program.run {
            run.referencing_started.set(unit.leader(), true);
        }
        program.block_cause()
    }

    /// Whether every axis of G74 is referenced, and every grouping synchronised.
    pub(in crate::sinumerik) fn references_are_done(&self, run: &Run) -> bool {
        run.referencing.iter().all(|axis| {
            let Some(unit) = self.unit_of(axis) else { return true };
            let synchronised =
                unit.grouping.is_none_or(|index| self.groupings[usize::from(index)].phase == Phase::Synchronised);
            let referenced = unit.members().all(|member| self.axes[member].is_referenced());
            run.referencing_started.contains(axis)
                && referenced
                && synchronised
                && !self.axes[axis].approach.is_running()
        })
    }
}
