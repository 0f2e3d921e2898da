//! The stage "programs": runs the program of each channel for one cycle, block by block.
//!
//! | phase of a block | what happens | until |
//! |---|---|---|
//! | between | nothing | read-in disable (6.1) is 0, and a block is prepared |
//! | before | its functions "before the motion" are output | the PLC has acknowledged them |
//! | moving | functions "during the motion" are output; it moves, dwells, references | the motion has ended, with an exact stop the axes are in position |
//! | after | functions "at the end" are output | the PLC has acknowledged everything |
//!
//! Then the program stops (M0, M1, single block, 7.2), ends (M2, M30), or goes on with the next block in the same cycle. In G64 the path passes
//! from one block to the next without a stop as long as nothing has to be output before the next one, and nothing holds the change of blocks.

use crate::control::Changes;
use crate::image::ToNck;
use crate::motion::path::Feed;
use crate::nc_program::{End, Library, g, groups};
use crate::sinumerik::alarms::{Alarm, Reaction};
use crate::sinumerik::machine_data::{Element, MachineData, TableValue, Target};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::programs::OutputTime;
use crate::sinumerik::program::control::at_stop;
use crate::sinumerik::program::environment::Channel;
use crate::sinumerik::program::geometry;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::preparation::Preparing;
use crate::sinumerik::program::state::{BlockAlarm, Phase, Preparation, ProgramState, Run, block_name, on_path};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::spindle::functions::limit_of_spindle;
use crate::sinumerik::state::State;
use crate::units::{AxisSet, ChannelNumber};
use crate::variables::{EventId, Input, Parameter, Place};

/// Changes of blocks in one cycle: calculation blocks and blocks without motion take no time.
const CHANGES: usize = 100;

/// What a block does after a look at it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockProgress {
    /// Something has changed: look again in the same cycle.
    Changed,
    /// It waits for the next cycle.
    Waits,
    /// The program has ended.
    Ended,
}

/// What programs read, and what they write into machine data and compensation tables.
pub(super) struct ProgramMemory<'a> {
    pub library: &'a Library,
    pub stored: &'a MachineData,
    pub written: &'a mut Vec<(Target, crate::control::Value)>,
    pub tables: &'a mut Vec<(Element, TableValue)>,
}

impl Nck {
    /// The stage. `changes` says what the PLC has seen of the outputs.
    pub(in crate::sinumerik) fn run_programs(&mut self, to_nck: &ToNck, changes: &Changes) {
        let (mut written, mut tables, mut new_conf) = (Vec::new(), Vec::new(), false);
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        state.end_waits(parameters);
        let mut starts = Vec::new();
        for (channel, _) in parameters.existing_channels() {
            let Some(own) = parameters.programs[channel].as_deref() else { continue };
            let taken_back = state.acknowledge(channel, (own, parameters), changes);
            if let Some(mut run) = state.programs[channel].run.take() {
                let stage = Stage { channel, parameters, own, to_nck };
                let (written, tables) = (&mut written, &mut tables);
                let mut sources = ProgramMemory { library: &self.programs, stored: &self.stored, written, tables };
                let stays = state.run_program(&mut run, &stage, &mut sources);
                new_conf |= std::mem::take(&mut run.new_conf);
                starts.append(&mut run.starts);
                written.extend(run.spindle_limits.drain(..).filter_map(limit_of_spindle));
                if stays {
                    state.programs[channel].run = Some(run);
                } else {
                    state.return_axes(channel, state.programs[channel].cause, parameters);
                }
            }
            // The PLC sees change bits of 0 between two packages. If it sees them late, exactly one scan sees what is output from scan to scan.
            let cycle = state.log.cycle;
            let begins = !taken_back && (changes.scanned || !changes.is_late);
            if begins && let Some(cause) = state.programs[channel].output.next(cycle, own.whole_h_functions) {
                let event = state.log.now(Place::Channel(channel), cause, Rule::AuxiliaryOutput, [Input::None; 3]);
                state.programs[channel].output.cause = event;
                state.show_spindle_functions(&state.programs[channel].output.pending(), own, event);
            }
        }
        for start in starts {
            state.start_by_program(start, parameters, &self.programs, to_nck);
        }
        // POS of a synchronised action may have woken an axis that rested.
        let runs = parameters.existing_channels().filter_map(|(channel, _)| state.programs[channel].run.as_deref());
        let positioned = runs.flat_map(|run| &run.positionings).map(|one| one.axis).collect();
        self.resting.decide_now(positioned, &state.units);
        self.resting.hear_all(state.exchanged_axes(parameters));
        for (target, value) in written {
            // The environment has checked it.
            let _ = self.store(&target, &value);
        }
        self.store_tables(&tables);
        if new_conf {
            self.new_conf();
        }
    }
}

impl State {
    /// One cycle of a program. Returns whether it is still there.
    fn run_program(&mut self, run: &mut Run, stage: &Stage<'_>, sources: &mut ProgramMemory<'_>) -> bool {
        let channel = stage.channel;
        run.pauses = false;
        // An axis that another holder gets begins where that leaves it.
        run.left.retain(|(axis, _)| self.owners.is_program_axis(*axis, channel));
        let runs = matches!(self.programs[channel].state, ProgramState::Running | ProgramState::Waiting);
        if runs && run.stopping.is_none() && run.resetting.is_none() {
            run.stopping = self.program_stopper(channel, run.is_mda, stage.parameters, stage.to_nck);
        }
        if run.search.is_some() && run.resetting.is_none() && self.run_search(run, stage, sources) {
            self.show_interruption(channel, stage.parameters);
            return true;
        }
        self.take_program_control(run, stage);
        self.delete_distance_to_go_of_path(run, stage);
        self.delete_distance_to_go_of_axes(run, stage);
        self.run_actions(run, stage, sources);
        if runs && run.stopping.is_none() {
            self.hold_block_change(run, stage);
            self.watch_limits_ahead(run, stage);
        }
        let ended = self.move_program(run, stage);
        self.take_command_axes(run, stage);
        self.end_approach(run, stage);
        for _ in 0..ended {
            run.on_path -= 1;
            if run.on_path > 0 {
                self.pass_to_next_block(run, stage);
            }
        }
        if let Some(event) = run.resetting {
            if self.program_rests(run, stage) && !self.reset_waits_for_gear(stage, event) {
                let event = self.log.now(Place::Channel(channel), event, Rule::ProgramAborted, [Input::None; 3]);
                self.end_program(channel, stage.own, event, false);
                return false;
            }
            return true;
        }
        if let Some(event) = run.stopping {
            if runs && self.program_rests(run, stage) {
                let event = self.log.now(Place::Channel(channel), event, Rule::ProgramStopped, [Input::None; 3]);
                self.stop_program(channel, event);
            }
        } else if runs && !run.approaches {
            for _ in 0..CHANGES {
                match self.execute(run, stage, sources) {
                    BlockProgress::Changed => {}
                    BlockProgress::Waits => break,
                    BlockProgress::Ended => return false,
                }
                let runs = matches!(self.programs[channel].state, ProgramState::Running | ProgramState::Waiting);
                // An alarm of the block stops the program in this block.
                if !runs || self.stop(channel, stage.parameters).is_some() {
                    break;
                }
            }
            self.lengthen_path(run, stage);
        }
        if runs && !matches!(self.programs[channel].state, ProgramState::Running | ProgramState::Waiting) {
            self.note_interruption_point(run, stage);
            // NC start may follow in the next cycle.
            self.take_skip_levels_while_stopped(run, stage);
        }
        self.show_interruption(channel, stage.parameters);
        true
    }

    pub(super) fn stop_program(&mut self, channel: ChannelNumber, event: EventId) {
        let program = &mut self.programs[channel];
        (program.state, program.cause) = (ProgramState::Stopped, event);
    }

    /// Whether something holds the change to the next block: read-in disable, also by RDISABLE, single block, NC stop at the block limit.
    pub(super) fn holds_block_change(&self, run: &Run, stage: &Stage<'_>) -> bool {
        let signals = &stage.to_nck.channels[stage.channel];
        let single =
            signals.activate_single_block() && !run.queue.front().is_some_and(|one| one.origin.is_single_block_off);
        let disabled = self.is_read_in_disabled(stage.channel, stage.to_nck) || run.read_in_disabled;
        disabled || signals.nc_stop_at_block_limit() || single || self.is_axis_wanted(stage.channel)
    }

    /// Stops the path at the end of its block while something holds the change to the next one.
    fn hold_block_change(&mut self, run: &mut Run, stage: &Stage<'_>) {
        if run.path.is_empty() {
            return;
        }
        if self.holds_block_change(run, stage) {
            run.path.stop_at_block_end(stage.parameters.cycle.seconds());
        } else {
            run.path.pass_block_end();
        }
    }

    /// Gives the path the blocks into which it can pass without a stop.
    fn lengthen_path(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let moves =
            run.phase == Phase::Moving && run.on_path > 0 && run.returning.is_none() && run.commanded.is_empty();
        if !moves || self.holds_block_change(run, stage) || run.deleting || run.change.is_some() {
            return;
        }
        let cycle = stage.parameters.cycle.seconds();
        let busy = self.programs[stage.channel].output.is_busy();
        while let (Some(last), Some(next)) = (run.queue.get(run.on_path - 1), run.queue.get(run.on_path)) {
            // The first block has output what it has; those behind it have not begun.
            let outputs = if run.on_path == 1 { busy } else { last.has_outputs() };
            // A fulfilled WAITMC behind the block that runs does not stop the path.
            if run.on_path == 1
                && next.is_only_action()
                && next.actions.first().is_some_and(|action| self.passes_mark(action, stage.channel))
            {
                run.queue.remove(1);
                run.executed += 1;
                continue;
            }
            if outputs || last.way.is_none_or(|block| block.exact_stop) || !run.can_pass(last, next) {
                return;
            }
            let Some(mut block) = next.way else { return };
            block.feed = run.effective_feed(block.feed, next.is_per_revolution(), stage);
            if run.path.append(block, cycle).is_err() {
                return;
            }
            run.on_path += 1;
        }
    }

    /// The path has passed into the next block without a stop.
    fn pass_to_next_block(&mut self, run: &mut Run, stage: &Stage<'_>) {
        run.take_executed();
        if run.take_dry_run_at_block_end(stage) {
            run.refeed(stage);
        }
        self.begin_block(run, stage);
        run.phase = Phase::Moving;
        self.output(run, OutputTime::During, stage);
    }

    /// A block begins to run: it is displayed.
    fn begin_block(&mut self, run: &mut Run, stage: &Stage<'_>) {
        run.alarm_origin = None;
        let Some(block) = run.queue.front() else { return };
        let input = Input::Block(block_name(&block.origin.name));
        let program = &self.programs[stage.channel];
        let place = Place::Channel(stage.channel);
        let event = self.log.note_one(place, Rule::BlockBegins, input, program.cause);
        (run.block_cause, run.block_cycle) = (event, self.log.cycle);
        let modal = block.modal;
        let read = block.block.as_ref().map(|read| &read.block);
        let feed = read.and_then(|block| block.feed);
        let program = &mut self.programs[stage.channel];
        program.last_feed = feed.or(program.last_feed);
        if let Some(block) = read {
            program.programmable.clone_from(&block.offset);
        }
        if program.modal != modal {
            let switches = !program.modal.agrees(&modal, groups::FEED_FORWARD);
            (program.modal, program.modal_cause) = (modal, event);
            if switches {
                self.prepare_position_control(stage.parameters);
            }
        }
    }

    fn execute(&mut self, run: &mut Run, stage: &Stage<'_>, sources: &mut ProgramMemory<'_>) -> BlockProgress {
        let channel = stage.channel;
        match run.phase {
            Phase::Between => self.take_next_block(run, stage, sources),
            Phase::Before => {
                if self.programs[channel].output.is_busy() || self.gear_changing(stage).is_some() {
                    return BlockProgress::Waits;
                }
                self.begin_motion(run, stage, sources);
                BlockProgress::Changed
            }
            Phase::Moving => {
                self.prepare(run, stage, sources);
                if !self.motion_has_ended(run, stage) {
                    return BlockProgress::Waits;
                }
                self.output(run, OutputTime::End, stage);
                run.phase = Phase::After;
                BlockProgress::Changed
            }
            Phase::After => {
                // The program ends when what POSA has started is over, too.
                let ends = run.queue.front().is_some_and(|block| block.end == Some(End::Program));
                let moves = !run.positionings.is_empty() || self.spindles_are_positioned(stage.own);
                let changes = self.gear_changing(stage).is_some();
                let busy = self.programs[channel].output.is_busy() || ends && moves || changes;
                if busy || self.single_block_waits(run, stage) {
                    return BlockProgress::Waits;
                }
                self.end_block(run, stage)
            }
        }
    }

    pub(super) fn prepare(&mut self, run: &mut Run, stage: &Stage<'_>, sources: &mut ProgramMemory<'_>) {
        if std::mem::take(&mut run.reads_again) && run.queue.is_empty() {
            self.read_failed_again(run, stage);
        }
        let group = stage.parameters.mode_group(stage.channel);
        let signals = &stage.to_nck.channels[stage.channel];
        let restarts = stage.to_nck.jumps[stage.channel].enable_gotos();
        let second = stage.to_nck.mode_groups[group].single_block_type_b();
        let preparing = Preparing {
            parameters: stage.parameters,
            own: stage.own,
            axes: &self.axes,
            owners: &self.owners,
            channel: stage.channel,
            to_nck: stage.to_nck,
            open: self.open_groupings(stage.parameters),
            at_stop: at_stop(stage),
            stops_after_calculations: signals.activate_single_block() && second,
        };
        let mut environment = Channel {
            channel: stage.channel,
            parameters: stage.own,
            axes: &self.axes,
            owners: &self.owners,
            single: &self.single,
            coupled: self.coupled_axes(),
            all: stage.parameters,
            spindles: &self.spindles,
            r_parameters: &mut self.r_parameters,
            library: sources.library,
            stored: sources.stored,
            written: sources.written,
            tables: sources.tables,
            program: &mut self.programs[stage.channel],
            skips: run.skips,
            restarts,
            now: self.log.cycle as f64 * stage.parameters.cycle.seconds(),
            block_begun: run.block_cycle as f64 * stage.parameters.cycle.seconds(),
            modal: run.interpreter.modal(),
            feed: run.interpreter.feed(),
            offset: run.interpreter.offset().to_vec(),
            r_written: Vec::new(),
            search_level: run.search.as_ref().map_or(0, |search| search.level()),
            prepared_spindles: Vec::new(),
            end: run.end,
            is_executed: run.is_executed(),
            is_at_rest: run.is_at_rest(),
            is_inch: geometry::is_inch(run.interpreter.modal(), stage.parameters.is_inch),
        };
        run.prepare(&preparing, &mut environment);
    }

    fn take_next_block(&mut self, run: &mut Run, stage: &Stage<'_>, sources: &mut ProgramMemory<'_>) -> BlockProgress {
        if self.is_axis_wanted(stage.channel) {
            // Between two blocks the PLC, or GETD of another channel, gets it in the next cycle.
            return BlockProgress::Waits;
        }
        self.prepare(run, stage, sources);
        if self.waits_for_claim(run, stage) {
            return BlockProgress::Waits;
        }
        if run.queue.is_empty() {
            return match &run.preparation {
                Preparation::Reads | Preparation::Waits => BlockProgress::Waits,
                Preparation::Failed { alarm, .. } => {
                    let alarm = *alarm;
                    // NC start on a block that is as bad as before is seen for a cycle: 35.0 = 1, and its alarm is gone.
                    if run.positionings.is_empty() && run.read_again_cycle != Some(self.log.cycle) {
                        self.raise_block_alarm(alarm, run, stage);
                    }
                    BlockProgress::Waits
                }
                Preparation::Ended if !run.positionings.is_empty() => BlockProgress::Waits,
                Preparation::Ended if run.search.is_some() => {
                    self.target_is_missing(run, stage);
                    BlockProgress::Waits
                }
                Preparation::Ended => {
                    let place = Place::Channel(stage.channel);
                    let event = self.log.note_plain(place, Rule::ProgramEnded, run.block_cause);
                    self.end_program(stage.channel, stage.own, event, !run.is_mda);
                    BlockProgress::Ended
                }
            };
        }
        if let (Some(search), Some(block)) = (&run.search, run.queue.front())
            && search.is_target(&block.origin)
        {
            self.found(run, stage);
            return BlockProgress::Waits;
        }
        if run.waits_for_command_axis(stage) {
            return BlockProgress::Waits;
        }
        if self.is_read_in_disabled(stage.channel, stage.to_nck) || run.read_in_disabled {
            return BlockProgress::Waits;
        }
        if let Some(alarm) = run.still_positioned(stage.own) {
            run.refuse_next(alarm);
            self.raise_block_alarm(alarm, run, stage);
            return BlockProgress::Waits;
        }
        run.take_dry_run_at_block_end(stage);
        self.begin_block(run, stage);
        self.output(run, OutputTime::Before, stage);
        run.phase = Phase::Before;
        BlockProgress::Changed
    }

    /// Everything before a block that cannot be executed has been executed: its alarm appears, and the program stops.
    pub(super) fn raise_block_alarm(&mut self, alarm: BlockAlarm, run: &Run, stage: &Stage<'_>) {
        let place = Place::Channel(stage.channel);
        let [second, third, mut fourth] = alarm.parameters;
        if let Preparation::Failed { alarm: failed, reason, .. } = &run.preparation
            && *failed == alarm
            && !reason.is_empty()
        {
            fourth = self.reasons.keep(reason);
        }
        let shown = [Parameter::Channel(stage.channel), second, third, fourth];
        let input = Input::Block(alarm.block);
        let event = self.log.note_one(place, Rule::BlockNotExecutable, input, run.block_cause);
        self.alarms.raise(alarm.number, place, shown, event);
        let row = Alarm::find(alarm.number);
        debug_assert!(row.is_some(), "{} has no row", alarm.number.0);
        let stops = row.is_none_or(|row| {
            row.reaction.has(Reaction::CORRECTION_BLOCK)
                || row.reaction.has(Reaction::INTERPRETER_STOP)
                || row.reaction.has(Reaction::STOP)
        });
        if stops {
            self.stop_program(stage.channel, event);
        }
    }

    fn begin_motion(&mut self, run: &mut Run, stage: &Stage<'_>, sources: &ProgramMemory<'_>) {
        let cycle = stage.parameters.cycle.seconds();
        let Some(block) = run.queue.front() else { return };
        block.begin_behind_interruption(&mut run.left);
        let path = &stage.own.axes.path;
        if run.path.is_empty() && run.returning.is_none() {
            let position = block
                .way
                .map_or_else(|| on_path(path, |axis| self.axes[axis].setpoint.position), |block| block.way.start());
            run.path.place(position);
            let moving: AxisSet = run.positionings.iter().map(|positioning| positioning.axis).collect();
            run.commanded = run.commanded.and(moving);
            let is_soft = block.modal.is(g::SOFT);
            let counted = block.way.map_or(stage.own.axes.counted, |block| block.way.counted());
            run.path.set_jerk_window(if is_soft { stage.own.jerk.window(counted) } else { 1 });
        }
        (run.dwell, run.dwell_turns) = (block.dwell, block.dwell_turns);
        let positions = block.positions.clone();
        let mut references = AxisSet::NONE;
        // In a program test nothing moves, so G74 does nothing (P-62).
        let test = self.programs[stage.channel].test.axes;
        for axis in block.references.iter().filter(|axis| !test.contains(**axis)) {
            references.set(*axis, true);
        }
        (run.referencing, run.referencing_started) = (references, AxisSet::NONE);
        run.limits = stage.own.accelerated(run.limits, &block.actions, stage.parameters);
        run.path.set_limits(run.limits);
        // A block into which the path would have passed is there already.
        if let (Some(mut way), 0) = (block.way, run.on_path) {
            way.feed = run.effective_feed(way.feed, block.is_per_revolution(), stage);
            if run.path.append(way, cycle).is_ok() {
                run.on_path = 1;
                run.awaits_spindles = matches!(way.feed, Feed::Programmed(_));
            }
        }
        let actions = block.actions.clone();
        for action in actions {
            self.coordinate(&action, run, stage, sources.library);
            self.act(action, run, stage);
        }
        for positioning in positions {
            run.positionings.retain(|other| other.axis != positioning.axis);
            self.begin_way_by_handwheel(positioning.axis);
            run.positionings.push(positioning);
        }
        run.phase = Phase::Moving;
        self.output(run, OutputTime::During, stage);
    }
}
