//! Coordination of channels: INIT, START, WAITE, SETM, CLEARM, WAITM, WAITMC.
//!
//! A channel that waits shows 35.1. A wait is judged once per cycle for all channels, with the marks and states at its beginning, so that no
//! channel misses a mark that another one takes away. A mark of WAITM or WAITMC is taken away when its channel goes on; a channel that did not
//! have to wait keeps its mark until the next judgement. Marks of SETM stay until CLEARM or power off (P-67).

use crate::image::ToNck;
use crate::image::{channel_from_nck, mode_group_from_nck};
use crate::nc_program::{Action, Library, Request, normalised};
use crate::sinumerik::alarms::{START_WITHOUT_REFERENCE, programs as alarms};
use crate::sinumerik::inputs::{channel_signal, mode_group_signal};
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::search_state::Search;
use crate::sinumerik::program::state::{BlockAlarm, ProgramState, Run, StartRequest, WaitFor, block_name};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::ChannelNumber;
use crate::variables::{AlarmNumber, Input, Parameter, Place, short_text};

/// The channels of these numbers.
fn channels(numbers: &[u16]) -> Vec<ChannelNumber> {
    let number = |number: &u16| u8::try_from(*number).ok().and_then(ChannelNumber::new);
    numbers.iter().filter_map(number).collect()
}

impl State {
    /// An action of coordination.
    pub(super) fn coordinate(&mut self, action: &Action, run: &mut Run, stage: &Stage<'_>, library: &Library) {
        let own = stage.channel;
        match action {
            Action::SetMarks(marks) => self.programs[own].set_marks(marks),
            Action::ClearMarks(marks) => self.programs[own].clear_marks(marks),
            Action::WaitMark { mark, channels: others, .. } => {
                let others = channels(others);
                self.programs[own].set_marks(&[*mark]);
                if self.have_mark(own, *mark, &others) {
                    self.programs[own].pass_mark(*mark);
                } else {
                    run.waits = Some(WaitFor::Mark { mark: *mark, channels: others });
                }
            }
            Action::WaitEnd(others) => {
                let others = channels(others);
                // A program that START of this cycle begins runs from the end of the stage on.
                let starts = run.starts.iter().any(|(_, other, _)| others.contains(other));
                if starts || !self.have_ended(own, &others) {
                    run.waits = Some(WaitFor::End(others));
                }
            }
            Action::Start(others) => {
                run.starts.extend(channels(others).into_iter().map(|other| (own, other, run.block_cause)));
            }
            Action::Initialise { channel, program, .. } => self.initialise(*channel, program, run, stage, library),
            _ => {}
        }
    }

    /// Whether other channels have a mark.
    fn have_mark(&self, own: ChannelNumber, mark: u16, others: &[ChannelNumber]) -> bool {
        others.iter().all(|other| *other == own || self.programs[*other].has_mark(mark))
    }

    fn have_ended(&self, own: ChannelNumber, others: &[ChannelNumber]) -> bool {
        others.iter().all(|other| *other == own || self.programs[*other].state == ProgramState::Aborted)
    }

    /// Whether a WAITMC that comes next is fulfilled already; then its channel passes it without a stop.
    pub(super) fn passes_mark(&mut self, action: &Action, own: ChannelNumber) -> bool {
        let Action::WaitMark { mark, channels: others, is_conditional: true } = action else { return false };
        let passes = self.have_mark(own, *mark, &channels(others));
        if passes {
            self.programs[own].pass_mark(*mark);
        }
        passes
    }

    /// Ends the waits that are fulfilled, for all channels alike.
    pub(super) fn end_waits(&mut self, parameters: &Parameters) {
        let mut ended = Vec::new();
        for (channel, _) in parameters.existing_channels() {
            let Some(waits) = self.programs[channel].run.as_ref().and_then(|run| run.waits.as_ref()) else { continue };
            let (is_over, mark, others) = match waits {
                WaitFor::Mark { mark, channels } => (self.have_mark(channel, *mark, channels), Some(*mark), channels),
                WaitFor::End(channels) => (self.have_ended(channel, channels), None, channels),
            };
            if is_over {
                let other = others.iter().copied().find(|other| *other != channel);
                ended.push((channel, mark, other));
            }
        }
        for (channel, mark, other) in ended {
            if let Some(mark) = mark {
                self.programs[channel].clear_marks(&[mark]);
            }
            let before = self.programs[channel].cause;
            let (input, parent) = match other {
                Some(other) if mark.is_none() => {
                    (channel_signal(other, channel_from_nck::program_state_aborted, true), self.programs[other].cause)
                }
                Some(other) => (Input::None, self.programs[other].block_cause()),
                None => (Input::None, before),
            };
            let is_shown = self.programs[channel].state == ProgramState::Waiting;
            if let Some(run) = &mut self.programs[channel].run {
                run.waits = None;
            }
            if is_shown {
                let parent = if parent.is_some() { parent } else { before };
                let event = self.log.note_one(Place::Channel(channel), Rule::WaitEnds, input, parent);
                (self.programs[channel].state, self.programs[channel].cause) = (ProgramState::Running, event);
            }
        }
        for (channel, _) in parameters.existing_channels() {
            let program = &mut self.programs[channel];
            program.marks &= !std::mem::take(&mut program.passed_marks);
        }
    }

    /// 35.1 while a program that runs waits for other channels.
    pub(super) fn show_wait(&mut self, run: &Run, stage: &Stage<'_>) {
        if self.programs[stage.channel].state != ProgramState::Running {
            return;
        }
        let name = run.queue.front().map(|block| block.origin.name.as_str()).unwrap_or_default();
        let input = Input::Block(block_name(name));
        let event = self.log.note_one(Place::Channel(stage.channel), Rule::WaitBegins, input, run.block_cause);
        let program = &mut self.programs[stage.channel];
        (program.state, program.cause) = (ProgramState::Waiting, event);
    }

    /// INIT: selects a program in another channel, which must be in the state reset (16912).
    fn initialise(&mut self, channel: u16, text: &str, run: &mut Run, stage: &Stage<'_>, library: &Library) {
        let Some(other) = u8::try_from(channel).ok().and_then(ChannelNumber::new) else { return };
        let caller = run.queue.front().map(|block| block.origin.program.clone()).unwrap_or_default();
        let caller = caller.rsplit_once('/').map_or("", |(folder, _)| folder);
        let name = normalised(text);
        let found = library.find(&Request { name: &name, folder: None, caller });
        if self.programs[other].state != ProgramState::Aborted {
            let shown =
                [Parameter::Channel(other), Parameter::Text(short_text("INIT")), Parameter::None, Parameter::None];
            self.alarms.raise(alarms::ONLY_IN_RESET, Place::Channel(other), shown, run.block_cause);
            return;
        }
        match found {
            Some(program) => self.programs[other].selected = Some(program.path()),
            None => {
                let block = run.queue.front().map(|block| block.origin.name.clone()).unwrap_or_default();
                let alarm = BlockAlarm {
                    number: alarms::PROGRAM_MISSING,
                    parameters: [
                        Parameter::Text(short_text(&block)),
                        Parameter::Text(short_text(&name)),
                        Parameter::None,
                    ],
                    block: block_name(&block),
                };
                self.raise_block_alarm(alarm, run, stage);
            }
        }
    }

    /// START: the program that is selected in another channel begins, if NC start could begin it.
    pub(super) fn start_by_program(
        &mut self,
        (by, channel, event): StartRequest,
        parameters: &Parameters,
        library: &Library,
        to_nck: &ToNck,
    ) {
        const ACTION: &str = "START";
        let Some(own) = parameters.programs[channel].as_deref() else { return };
        let searches = self.programs[by].search().is_some_and(Search::is_by_program_test);
        if searches && parameters.serupro_ignores_start {
            // MD10708 bit 1: no alarm, and nothing is started.
            return;
        }
        let group = parameters.mode_group(channel);
        let mode = self.mode_groups[group].mode;
        let block_alarm = if searches {
            Some(alarms::START_IN_SERUPRO)
        } else if mode == Mode::Mda {
            Some(alarms::START_IN_MDA)
        } else {
            None
        };
        if let Some(number) = block_alarm {
            let shown = [Parameter::Channel(channel), Parameter::None, Parameter::None, Parameter::None];
            self.alarms.raise(number, Place::Channel(by), shown, event);
            return;
        }
        let refuse = |state: &mut Self, number: AlarmNumber, shown: &str| {
            let name = Parameter::Text(short_text(shown));
            // The name of a program is %3, as for NC start.
            let [second, third] =
                if number == alarms::NO_PROGRAM { [Parameter::None, name] } else { [name, Parameter::None] };
            let shown = [Parameter::Channel(channel), second, third, Parameter::None];
            state.alarms.raise(number, Place::Channel(channel), shown, event);
        };
        let hindered = self.start_is_locked(channel, parameters);
        let selected = self.programs[channel].selected.clone();
        if mode == Mode::Jog {
            refuse(self, alarms::MODE_NOT_SUITABLE, ACTION);
        } else if self.programs[channel].state != ProgramState::Aborted {
            refuse(self, alarms::ALREADY_ACTIVE, ACTION);
        } else if hindered.is_some() {
            refuse(self, alarms::ALARM_PENDING, ACTION);
        } else if !self.is_referenced(channel, parameters) {
            refuse(self, START_WITHOUT_REFERENCE, ACTION);
        } else if self.is_start_disabled(channel, to_nck) || self.stop(channel, parameters).is_some() {
            // As NC start: no effect.
        } else {
            match selected.filter(|path| library.program(path).is_some()) {
                Some(path) => {
                    let active = mode_group_signal(group, mode_group_from_nck::active_mode_automatic, true);
                    let started = self.log.note_one(Place::Channel(channel), Rule::StartedByProgram, active, event);
                    self.begin_program((channel, mode), &path, own, (parameters, to_nck), started);
                }
                None => {
                    let name = self.programs[channel].selected.clone();
                    refuse(self, alarms::NO_PROGRAM, name.as_deref().unwrap_or(alarms::NONE_SELECTED));
                }
            }
        }
    }
}
