//! Program control: what the PLC selects for programs, and when it takes effect.
//!
//! | selected by | shown | takes effect |
//! |---|---|---|
//! | program test 1.7; 14.0 and 14.1 of an axis | 33.7 | while the program is aborted and the axes of the channel are at rest (P-61) |
//! | dry run 0.6 | | MD10704: at the end of a block, at once, at STOPRE |
//! | skip levels 2.0 to 2.7, 31.6, 31.7 | | MD10706: stopped at the end of a block, at once, at STOPRE |
//! | delete number of passes 6.3, program level abort 6.4 | | its rising edge, with a short stop of the path |
//!
//! A program test acts like axis disable (1.3) on the axes: setpoints and displays run, and nothing moves. Everything else runs as without it.
//! Preparation is ahead of the movement: a change that concerns blocks which are prepared already drops them, takes back what they have
//! written into R parameters, and reads them again.

use crate::image::{ToNck, axis_to_nck, channel_to_nck};
use crate::motion::path::Feed;
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::inputs::{axis_signal, channel_signal};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ChangeTime;
use crate::sinumerik::program::executable::Executable;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::state::{Change, Phase, Preparation, ProgramState, ProgramTest, Run, on_path};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisSet, ChannelNumber};
use crate::variables::{EventId, Input, Parameter, Place};

/// The skip levels that are selected, a bit each.
pub(in crate::sinumerik) fn skip_levels(channel: ChannelNumber, to_nck: &ToNck) -> u16 {
    let (signals, further) = (&to_nck.channels[channel], &to_nck.program_control[channel]);
    [
        signals.skip_block_level_0(),
        signals.skip_block_level_1(),
        signals.skip_block_level_2(),
        signals.skip_block_level_3(),
        signals.skip_block_level_4(),
        signals.skip_block_level_5(),
        signals.skip_block_level_6(),
        signals.skip_block_level_7(),
        further.skip_block_level_8(),
        further.skip_block_level_9(),
    ]
    .into_iter()
    .enumerate()
    .fold(0, |levels, (level, is_selected)| levels | u16::from(is_selected) << level)
}

/// What takes effect at STOPRE: skip levels, dry run.
pub(super) fn at_stop(stage: &Stage<'_>) -> (Option<u16>, Option<bool>) {
    let at_stop = |time| time == ChangeTime::StopPreparation;
    let dry_run = stage.to_nck.channels[stage.channel].activate_dry_run_feedrate();
    (
        at_stop(stage.own.skip_change).then(|| skip_levels(stage.channel, stage.to_nck)),
        at_stop(stage.own.dry_run_change).then_some(dry_run),
    )
}

impl Nck {
    /// Selects program tests, before NC start.
    pub(in crate::sinumerik) fn select_program_tests(&mut self, to_nck: &ToNck) {
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        for (channel, _) in parameters.existing_channels() {
            if state.select_program_test(channel, parameters, to_nck) {
                self.resting.wake_all();
            }
        }
    }
}

impl State {
    /// The program test of a channel. Returns whether it has changed: then all axes decide.
    fn select_program_test(&mut self, channel: ChannelNumber, parameters: &Parameters, to_nck: &ToNck) -> bool {
        let axes = parameters.channels[channel].axes;
        let before = self.programs[channel].test;
        let is_wanted = to_nck.channels[channel].activate_program_test();
        let concerned: AxisSet = axes
            .iter()
            .filter(|axis| {
                let signals = &to_nck.axes[*axis];
                signals.activate_program_test() || is_wanted && !signals.suppress_program_test()
            })
            .collect();
        if before.is_active == is_wanted && before.axes == concerned {
            return false;
        }
        let rests = axes.iter().all(|axis| self.axes[axis].setpoint.is_at_rest());
        if self.programs[channel].state != ProgramState::Aborted || !rests {
            return false;
        }
        let place = Place::Channel(channel);
        let changed = before.axes.without(concerned).with(concerned.without(before.axes)).iter().next();
        let input = if before.is_active == is_wanted {
            let of_axis = |axis| {
                if to_nck.axes[axis].activate_program_test() || !is_wanted {
                    let value = to_nck.axes[axis].activate_program_test();
                    axis_signal(axis, axis_to_nck::activate_program_test, value)
                } else {
                    let value = to_nck.axes[axis].suppress_program_test();
                    axis_signal(axis, axis_to_nck::suppress_program_test, value)
                }
            };
            changed.map_or(Input::None, of_axis)
        } else {
            channel_signal(channel, channel_to_nck::activate_program_test, is_wanted)
        };
        let event = self.log.note_one(place, Rule::ProgramTest, input, EventId::NONE);
        self.programs[channel].test = ProgramTest { is_active: is_wanted, axes: concerned, cause: event };
        if is_wanted && !before.is_active {
            let shown = [Parameter::Channel(channel), Parameter::None, Parameter::None, Parameter::None];
            self.alarms.raise(alarms::PROGRAM_TEST, place, shown, event);
        }
        true
    }

    /// Takes over what the PLC has selected, as soon as it may take effect.
    pub(super) fn take_program_control(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let signals = &stage.to_nck.channels[stage.channel];
        self.take_skip_levels_while_stopped(run, stage);
        if skip_levels(stage.channel, stage.to_nck) != run.skips && stage.own.skip_change == ChangeTime::AtOnce {
            run.change = run.change.or(Some(Change::Skips));
        }
        let dry_run = signals.activate_dry_run_feedrate();
        if dry_run != run.dry_run && stage.own.dry_run_change == ChangeTime::AtOnce {
            run.change = run.change.or(Some(Change::DryRun));
        }
        let level_signals = [signals.delete_number_of_passes(), signals.program_level_abort()];
        let were = std::mem::replace(&mut run.level_signals_were, level_signals);
        for (index, change) in [Change::Passes, Change::Level].into_iter().enumerate() {
            if level_signals[index] && !were[index] && run.level() > 0 {
                run.change = Some(change);
            }
        }
        let moves = |run: &Run| run.positionings.iter().any(|one| !self.axes[one.axis].setpoint.is_at_rest());
        let rests = run.path.velocity() <= 0.0 && run.returning.is_none();
        if run.change.is_some() && rests && (run.change != Some(Change::Level) || !moves(run)) {
            self.change(run, stage);
        }
    }

    /// MD10706 = 0: skip levels take effect while the program is stopped at the end of a block.
    pub(super) fn take_skip_levels_while_stopped(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let stopped = matches!(self.programs[stage.channel].state, ProgramState::Stopped | ProgramState::Interrupted);
        let skips = skip_levels(stage.channel, stage.to_nck);
        let at_block_end = stage.own.skip_change == ChangeTime::BlockEnd && run.phase == Phase::Between;
        if stopped && at_block_end && skips != run.skips {
            run.skips = skips;
            self.read_again_behind(run, 0, stage);
        }
    }

    /// The path stands: the change takes effect, and the program goes on.
    fn change(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let Some(change) = run.change.take() else { return };
        let begun = usize::from(run.phase != Phase::Between);
        if run.on_path > 1 {
            run.path.keep_first();
            run.on_path = 1;
        }
        match change {
            Change::DryRun => {
                run.dry_run = stage.to_nck.channels[stage.channel].activate_dry_run_feedrate();
                run.refeed(stage);
            }
            Change::Skips => {
                run.skips = skip_levels(stage.channel, stage.to_nck);
                self.read_again_behind(run, begun, stage);
            }
            Change::Passes => {
                self.read_again_behind(run, begun, stage);
                run.interpreter.delete_passes();
                run.keep_behind(begun);
            }
            Change::Level => {
                run.path.clear();
                (run.on_path, run.dwell) = (0, 0);
                run.positionings.clear();
                run.referencing = AxisSet::NONE;
                if begun > 0 {
                    run.take_executed();
                    run.phase = Phase::Between;
                }
                self.read_again_behind(run, 0, stage);
                run.interpreter.abort_level();
                let input = channel_signal(stage.channel, channel_to_nck::program_level_abort, true);
                self.log.note_one(Place::Channel(stage.channel), Rule::LevelAborted, input, run.block_cause);
                run.end = on_path(&stage.own.axes.path, |axis| self.axes[axis].setpoint.position);
                run.behind.end = run.end;
                run.keep_behind(0);
            }
        }
    }

    /// NC start has cancelled the alarm of a block: the block is read again, with the R parameters and variables that it finds now. What was read behind
    /// it before is read again, too.
    pub(super) fn read_failed_again(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let Preparation::Failed { block, .. } = &mut run.preparation else { return };
        if let Some(read) = block.take() {
            self.take_back(run, run.executed + 1, stage);
            run.again.clear();
            run.interpreter = read.before;
        }
        run.preparation = Preparation::Reads;
    }

    /// Takes back what was written into R parameters before this block and those behind it.
    fn take_back(&mut self, run: &mut Run, next: u64, stage: &Stage<'_>) {
        while let Some((before, index, value)) = run.r_log.back().copied() {
            if before < next {
                break;
            }
            self.r_parameters.set(stage.channel, index, value);
            run.r_log.pop_back();
        }
    }

    /// Drops the blocks behind the first `kept` ones, takes back what they have written into R parameters, and reads them again.
    pub(super) fn read_again_behind(&mut self, run: &mut Run, kept: usize, stage: &Stage<'_>) {
        self.take_back(run, run.executed + kept as u64, stage);
        run.queue.truncate(kept);
        run.again.clear();
        let behind = run.queue.back().and_then(|block| block.behind()).unwrap_or(&run.behind);
        run.interpreter.clone_from(&behind.interpreter);
        run.axis_feeds.clone_from(&behind.axis_feeds);
        (run.path_override, run.programmed_on_path) = (behind.path_override, behind.programmed_on_path);
        (run.end, run.offsets, run.counted) = (behind.end, behind.offsets, behind.counted);
        run.preparation = Preparation::Reads;
    }
}

impl Run {
    /// The program level of the block that runs, or of the one behind which the program stands; 0 is the main program.
    fn level(&self) -> usize {
        let running = self.queue.front().filter(|_| self.phase != Phase::Between);
        let next = || self.behind.interpreter.stack().count().saturating_sub(1);
        running.map_or_else(next, |block| usize::from(block.origin.level))
    }

    /// The state of preparation was changed behind the block that runs, or behind the last one.
    fn keep_behind(&mut self, begun: usize) {
        let interpreter = self.interpreter.clone();
        match self.queue.front_mut().and_then(|block| block.block.as_mut()).filter(|_| begun > 0) {
            Some(read) => read.behind.interpreter = interpreter,
            None => self.behind.interpreter = interpreter,
        }
    }

    /// MD10704 = 0: the dry run takes effect when the next block begins. Returns whether it has changed.
    pub(super) fn take_dry_run_at_block_end(&mut self, stage: &Stage<'_>) -> bool {
        let wanted = stage.to_nck.channels[stage.channel].activate_dry_run_feedrate();
        let changes = wanted != self.dry_run && stage.own.dry_run_change == ChangeTime::BlockEnd;
        self.dry_run ^= changes;
        changes
    }

    /// The feed of a block: that of the dry run, or of a search by program test.
    pub(super) fn effective_feed(&self, feed: Feed, per_revolution: bool, stage: &Stage<'_>) -> Feed {
        if self.search.as_ref().is_some_and(|search| search.is_by_program_test()) {
            return stage.own.search_feed(feed);
        }
        stage.own.dry_run_feed(feed, per_revolution, self.dry_run)
    }

    /// The blocks on the path get the feed that is in effect now.
    pub(super) fn refeed(&mut self, stage: &Stage<'_>) {
        let (queue, dry_run) = (&self.queue, self.dry_run);
        self.path.set_feeds(|number, feed| {
            let of_block = |block: &Executable| Some((block.way?, block.is_per_revolution()));
            let programmed = queue.iter().filter_map(of_block).find(|(way, _)| way.number == number);
            programmed.map_or(feed, |(way, per_revolution)| stage.own.dry_run_feed(way.feed, per_revolution, dry_run))
        });
    }
}
