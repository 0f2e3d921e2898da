//! The end of a block: when its motion is over, and whether the program then stops, ends or goes on.

use crate::image::channel_to_nck;
use crate::nc_program::{End, groups};
use crate::sinumerik::inputs::channel_signal;
use crate::sinumerik::parameters::programs::{OutputTime, ProgramParameters};
use crate::sinumerik::program::executable::{Criterion, Executable, ProgrammedStop};
use crate::sinumerik::program::execution::BlockProgress;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::positioning::AxisPositioning;
use crate::sinumerik::program::state::{Phase, Preparation, Run, block_name};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet};
use crate::variables::{Input, Place};

impl State {
    pub(super) fn motion_has_ended(&mut self, run: &mut Run, stage: &Stage<'_>) -> bool {
        if run.queue.is_empty() {
            return true;
        }
        if run.returning.is_some() || self.returns_first(run, stage) {
            return false;
        }
        // What START begins or refuses at the end of the cycle belongs to its block.
        if !run.starts.is_empty() {
            return false;
        }
        if run.dwell > 0 {
            // Runs on with feed disable; NC stop holds it.
            run.dwell -= 1;
            return false;
        }
        if self.dwells_for_turns(&mut run.dwell_turns, stage) {
            return false;
        }
        if run.waits.is_some() {
            self.show_wait(run, stage);
            return false;
        }
        let Some(block) = run.queue.front() else { return true };
        if run.positionings.iter().any(|one| block.waits_for(one, stage.own)) || !self.references_are_done(run) {
            return false;
        }
        if !self.spindles_have_arrived(&block.actions, stage.own, stage.parameters) {
            return false;
        }
        if self.waits_for_axes(run, stage) {
            return false;
        }
        let Some(block) = run.queue.front() else { return true };
        if block.ends_approach {
            return self.is_in_position(block.criterion, run, stage);
        }
        let Some(way) = block.way else { return true };
        if run.on_path > 0 && !run.path.stands() {
            return false;
        }
        // In G64 the path has ended because it could not pass into what follows: an exact stop, unless that is a motion that only came late.
        // G603 lets the next motion begin at the end of interpolation.
        let checks = way.exact_stop && block.criterion != Criterion::Interpolation;
        if (checks || !self.passes_late(run, stage)) && !self.is_in_position(block.criterion, run, stage) {
            return false;
        }
        if run.on_path > 0 {
            run.path.go_on();
            run.on_path -= 1;
        }
        true
    }

    /// Whether what follows the block that runs is a motion on the path that begins without standstill.
    ///
    /// Everything else behind a motion finds the axes at rest: auxiliary functions before or without motion, stops and the end of the program,
    /// preprocessing stop, PRESETON, WAITM, the exchange of axes.
    fn passes_late(&self, run: &Run, stage: &Stage<'_>) -> bool {
        let (Some(block), Some(next)) = (run.queue.front(), run.queue.get(1)) else { return false };
        run.can_pass(block, next) && !self.holds_block_change(run, stage)
    }

    /// Whether the axes of the path are at rest, and within the windows of an exact stop that has one.
    fn is_in_position(&self, criterion: Criterion, run: &Run, stage: &Stage<'_>) -> bool {
        let positioned = |axis| run.positionings.iter().any(|positioning| positioning.axis == axis);
        let own = |axis: &AxisNumber| self.owners.is_program_axis(*axis, stage.channel) && !positioned(*axis);
        stage.own.axes.path.iter().filter(|axis| own(axis)).all(|&number| {
            let axis = &self.axes[number];
            let set = axis.active_set(&stage.parameters.axes[number]);
            let is_within = match criterion {
                Criterion::Fine => axis.deviation().abs() <= set.exact_stop_fine,
                Criterion::Coarse => axis.deviation().abs() <= set.exact_stop_coarse,
                Criterion::Interpolation => true,
            };
            axis.setpoint.is_at_rest() && is_within
        })
    }

    /// Whether the stop of single block behind the block that runs waits for the next cycle: each NC start and each block before such a stop
    /// is seen for a cycle with 35.0.
    pub(super) fn single_block_waits(&self, run: &Run, stage: &Stage<'_>) -> bool {
        let is_new = run.block_cycle.max(run.continued_cycle) == self.log.cycle;
        is_new && run.queue.front().is_some_and(|block| single_block_stops(block, stage))
    }

    /// The block is over: the program stops, ends, or goes on.
    pub(super) fn end_block(&mut self, run: &mut Run, stage: &Stage<'_>) -> BlockProgress {
        let channel = stage.channel;
        let place = Place::Channel(channel);
        let Some(block) = run.take_executed() else { return BlockProgress::Waits };
        run.phase = Phase::Between;
        self.release_axes(&block, (channel, stage.own), run.block_cause, stage.parameters);
        // The path stands: what it would have passed into begins again when nothing holds it.
        run.path.clear();
        run.on_path = 0;
        run.referencing = AxisSet::NONE;
        let signals = &stage.to_nck.channels[channel];
        let input = Input::Block(block_name(&block.origin.name));
        if let Some(alarm) = run.cycle_alarm.take() {
            self.raise_block_alarm(alarm, run, stage);
            run.alarm_origin = Some(block.origin);
            return BlockProgress::Changed;
        }
        if block.end == Some(End::Program) && run.search.is_some() {
            self.target_is_missing(run, stage);
            return BlockProgress::Changed;
        }
        if block.end == Some(End::Program) {
            let event = self.log.note_one(place, Rule::ProgramEnded, input, run.block_cause);
            self.end_spindle_functions(channel, stage.parameters, event);
            self.end_program(channel, stage.own, event, true);
            return BlockProgress::Ended;
        }
        let associated = stage.to_nck.program_control[channel].activate_associated_m0_m1();
        let programmed = match block.stop {
            ProgrammedStop::None => false,
            ProgrammedStop::Always | ProgrammedStop::Associated => {
                // SERUPRO can pass M0.
                run.search.is_none() || !stage.own.serupro_passes_m0
            }
            ProgrammedStop::Optional => signals.activate_m01(),
            ProgrammedStop::AssociatedOptional => associated,
        };
        if programmed {
            let event = self.log.note_one(place, Rule::ProgrammedStop, input, run.block_cause);
            self.stop_program(channel, event);
            let is_own = matches!(block.stop, ProgrammedStop::Always | ProgrammedStop::Optional);
            let program = &mut self.programs[channel];
            (program.programmed_stop, program.associated_stop) = (is_own, !is_own);
        } else if signals.nc_stop_at_block_limit() {
            let pressed = channel_signal(channel, channel_to_nck::nc_stop_at_block_limit, true);
            let event = self.log.note(place, Rule::StopAtBlockEnd, [pressed, input, Input::None], run.block_cause);
            self.stop_program(channel, event);
        } else if single_block_stops(&block, stage) {
            let single = channel_signal(channel, channel_to_nck::activate_single_block, true);
            let event = self.log.note(place, Rule::SingleBlock, [single, input, Input::None], run.block_cause);
            self.stop_program(channel, event);
        }
        BlockProgress::Changed
    }

    /// Outputs the auxiliary functions of the block that runs which have this time; with MD20800 bit 1 M1 only while it stops.
    pub(super) fn output(&mut self, run: &Run, time: OutputTime, stage: &Stage<'_>) {
        if let Some(package) = run.queue.front().and_then(|block| block.output(time)) {
            let mut package = package.clone();
            if stage.own.outputs_m1_only_active && !stage.to_nck.channels[stage.channel].activate_m01() {
                package.retain(|entry| !entry.is_optional_stop());
            }
            self.programs[stage.channel].output.add(&package, run.block_cause, stage.own.quick_is_free);
        }
    }
}

impl Run {
    /// Whether a program that runs waits for the end of a positioning: its block does, or nothing but the end of the program is left.
    pub(in crate::sinumerik) fn awaits(&self, running: &AxisPositioning, own: &ProgramParameters) -> bool {
        match (self.queue.front(), self.phase) {
            (None, _) => matches!(self.preparation, Preparation::Ended),
            (Some(block), Phase::Moving) => block.waits_for(running, own),
            (Some(block), Phase::After) => block.end == Some(End::Program),
            (Some(_), Phase::Between | Phase::Before) => false,
        }
    }

    /// Whether the path can pass from one block to the next without standstill, whatever G64 and the interface say.
    pub(super) fn can_pass(&self, last: &Executable, next: &Executable) -> bool {
        let stops = last.by_handwheel
            || last.end.is_some()
            || last.stop != ProgrammedStop::None
            || !last.positions.is_empty()
            || !last.references.is_empty();
        // SOFT and BRISK, and the kind of feed (G94, G95), change at standstill.
        let switches = [groups::ACCELERATION, groups::FEED].iter().any(|group| !next.modal.agrees(&last.modal, *group));
        let is_target = self.search.as_ref().is_some_and(|search| search.is_target(&next.origin));
        !stops && !switches && next.is_plain() && self.positionings.is_empty() && !is_target
    }
}

/// Whether single block stops the program behind a block. Type B (SBL2) stops behind every block, also behind one that only calculates.
fn single_block_stops(block: &Executable, stage: &Stage<'_>) -> bool {
    let group = stage.parameters.mode_group(stage.channel);
    let is_active = stage.to_nck.channels[stage.channel].activate_single_block() && !block.origin.is_single_block_off;
    is_active && (block.is_executable || stage.to_nck.mode_groups[group].single_block_type_b())
}
