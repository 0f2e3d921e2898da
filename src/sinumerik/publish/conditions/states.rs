//! Conditions of the state of a program: how it comes into a state (35.0 to 35.4), and how it leaves it; and of block searches.

use crate::control::{Condition, Fact, fact, yes};
use crate::image::{channel_from_nck, channel_to_nck, mode_group_from_nck, mode_group_to_nck, nck_from_nck};
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::program::search_state::{Search, SearchProgress};
use crate::sinumerik::program::state::ProgramState;
use crate::sinumerik::publish::conditions::look::Look;
use crate::units::ChannelNumber;

pub(super) const fn word(state: ProgramState) -> &'static str {
    match state {
        ProgramState::Aborted => "aborted",
        ProgramState::Running => "running",
        ProgramState::Waiting => "waiting",
        ProgramState::Stopped => "stopped",
        ProgramState::Interrupted => "interrupted",
    }
}

impl Look<'_> {
    /// The program of a channel is in this state, without what leads there.
    fn state_of_program(self, channel: ChannelNumber, wanted: ProgramState, is: bool) -> Fact {
        let found = self.state.programs[channel].state;
        let not = if is { "" } else { "not " };
        let what = format!("state of the program of {}", self.channel_name(channel));
        Fact::new(what, word(found), format!("{not}{}", word(wanted)), (found == wanted) == is)
    }

    /// The program of a channel is in this state.
    pub(super) fn program(self, channel: ChannelNumber, wanted: ProgramState) -> Condition {
        let found = self.state.programs[channel].state;
        let group = self.parameters.mode_group(channel);
        let jog = || self.mode_group(group, mode_group_from_nck::active_mode_jog, true);
        self.state_of_program(channel, wanted, true).after(|| match (wanted, found) {
            (ProgramState::Running, ProgramState::Waiting) => self.no_wait(channel),
            (ProgramState::Running, _) => self.program_starts(channel),
            (ProgramState::Waiting, ProgramState::Running) => {
                self.reaches(channel, "one that waits for another channel or for an axis")
            }
            (ProgramState::Stopped, ProgramState::Running | ProgramState::Waiting) => self.program_stops(channel),
            (ProgramState::Stopped, ProgramState::Interrupted) => self.mode_of_start(channel),
            (ProgramState::Interrupted, ProgramState::Stopped) => jog(),
            (ProgramState::Interrupted, ProgramState::Running | ProgramState::Waiting) => {
                Condition::All(vec![jog(), self.program_stops(channel)])
            }
            (ProgramState::Aborted, _) => self.program_ends(channel),
            (ProgramState::Waiting | ProgramState::Stopped | ProgramState::Interrupted, _) => {
                self.channel(channel, channel_from_nck::program_state_running, true)
            }
        })
    }

    /// The program of a channel is in another state.
    pub(super) fn program_leaves(self, channel: ChannelNumber, left: ProgramState) -> Condition {
        let group = self.parameters.mode_group(channel);
        self.state_of_program(channel, left, false).after(|| match left {
            ProgramState::Running => {
                let waits = self.reaches(channel, "one that waits for another channel or for an axis");
                Condition::Any(vec![self.program_stops(channel), waits, self.program_ends(channel)])
            }
            ProgramState::Waiting => {
                Condition::Any(vec![self.no_wait(channel), self.program_stops(channel), self.program_ends(channel)])
            }
            ProgramState::Stopped => Condition::Any(vec![
                self.program_starts(channel),
                self.mode_group(group, mode_group_from_nck::active_mode_jog, true),
                self.program_ends(channel),
            ]),
            ProgramState::Interrupted => Condition::Any(vec![self.mode_of_start(channel), self.program_ends(channel)]),
            ProgramState::Aborted => self.program_starts(channel),
        })
    }

    /// 35.5.
    pub(super) fn channel_active(self, channel: ChannelNumber) -> Condition {
        let program = [ProgramState::Running, ProgramState::Waiting].map(|state| self.program(channel, state));
        let moved = Condition::All(vec![
            self.state_of_program(channel, ProgramState::Stopped, false).into(),
            self.at_rest(channel).opposite(),
        ]);
        Condition::Any(program.into_iter().chain([moved]).collect())
    }

    pub(super) fn channel_active_no_more(self, channel: ChannelNumber) -> Condition {
        let program = [ProgramState::Running, ProgramState::Waiting].map(|state| self.program_leaves(channel, state));
        let rests = Condition::Any(vec![
            self.state_of_program(channel, ProgramState::Stopped, true).into(),
            self.at_rest(channel),
        ]);
        Condition::All(program.into_iter().chain([rests]).collect())
    }

    /// 35.6.
    pub(super) fn channel_interrupted(self, channel: ChannelNumber) -> Condition {
        if self.state.programs[channel].state == ProgramState::Interrupted {
            return Condition::Any(vec![self.program(channel, ProgramState::Stopped), self.at_rest(channel)]);
        }
        self.program(channel, ProgramState::Stopped)
    }

    pub(super) fn channel_interrupted_no_more(self, channel: ChannelNumber) -> Condition {
        if self.state.programs[channel].state == ProgramState::Interrupted {
            let leaves = self.program_leaves(channel, ProgramState::Interrupted);
            return Condition::Any(vec![leaves, self.at_rest(channel).opposite()]);
        }
        self.program_leaves(channel, ProgramState::Stopped)
    }

    /// What stops a program that runs: in its block, or behind one.
    fn program_stops(self, channel: ChannelNumber) -> Condition {
        let Some(run) = self.state.programs[channel].run.as_deref() else { return Condition::NOTHING };
        if run.search.is_some() {
            return self.reaches(channel, "the block of the search");
        }
        if run.stopping.is_some() || run.resetting.is_some() {
            return self.comes_to_rest(channel);
        }
        let group = self.parameters.mode_group(channel);
        let own_mode =
            if run.is_mda { mode_group_from_nck::active_mode_mdi } else { mode_group_from_nck::active_mode_automatic };
        let behind_block = Condition::All(vec![
            Condition::Any(vec![
                self.channel(channel, channel_to_nck::nc_stop_at_block_limit, true),
                self.channel(channel, channel_to_nck::activate_single_block, true),
                Fact::new("M0, M1 or an alarm of the next block", "not reached", "reached", false).into(),
            ]),
            self.reaches(channel, "one at which the program stops"),
        ]);
        Condition::Any(vec![
            self.channel(channel, channel_to_nck::nc_stop, true),
            self.channel(channel, channel_to_nck::nc_stop_axes_plus_spindles, true),
            self.mode_group(group, mode_group_to_nck::mode_group_stop, true),
            self.mode_group(group, mode_group_to_nck::mode_group_stop_axes_plus_spindles, true),
            self.mode_group(group, own_mode, false),
            self.nck(nck_from_nck::emergency_stop_active, true),
            self.no_channel_alarm(channel, "the reaction stop", Reaction::STOP).opposite(),
            behind_block,
        ])
    }

    /// What ends a program: RESET, or its last block.
    pub(super) fn program_ends(self, channel: ChannelNumber) -> Condition {
        let Some(run) = self.state.programs[channel].run.as_deref() else { return Condition::NOTHING };
        if run.resetting.is_some() {
            return self.comes_to_rest(channel);
        }
        let group = self.parameters.mode_group(channel);
        Condition::Any(vec![
            self.channel(channel, channel_to_nck::channel_reset, true),
            self.mode_group(group, mode_group_to_nck::mode_group_reset, true),
            self.reaches(channel, if run.is_mda { "the end of the blocks" } else { "M2 or M30" }),
        ])
    }

    /// A program that is being stopped or ended waits until its axes rest.
    fn comes_to_rest(self, channel: ChannelNumber) -> Condition {
        let run = self.state.programs[channel].run.as_deref();
        let Some((run, stage)) = run.zip(self.stage(channel)) else { return Condition::NOTHING };
        let moving: Vec<_> = stage
            .own
            .axes
            .path
            .iter()
            .filter(|axis| !self.state.axes[**axis].setpoint.is_at_rest())
            .map(|axis| self.axis_name(*axis))
            .collect();
        let rests = self.state.program_rests(run, &stage);
        if rests {
            // A gear change, for example, keeps the block: nothing is named that was not tested.
            let what = format!("what keeps the program of {}, whose axes are at rest", self.channel_name(channel));
            return Fact::new(what, "its block", "nothing", false).into();
        }
        let found = if moving.is_empty() { "the path".to_owned() } else { moving.join(", ") };
        Fact::new(
            format!("what of {} still moves, before the program stops", self.channel_name(channel)),
            found,
            "none",
            false,
        )
        .into()
    }

    /// A state of a block search; with what leads there from how far the search is.
    pub(super) fn search_is(self, channel: ChannelNumber, what: &str, is: impl Fn(&Search) -> bool) -> Condition {
        let search = self.state.programs[channel].search();
        let holds = search.is_some_and(is);
        let name = self.channel_name(channel);
        fact(format!("a block search of {name} {what}"), holds).after(|| match search.map(|search| search.progress) {
            None => Fact::new(format!("order of a block search of {name}"), "none", "one", false).into(),
            Some(SearchProgress::Searching) => self.search_finds(channel),
            Some(SearchProgress::Found | SearchProgress::Ready) => self.program_starts(channel),
            Some(SearchProgress::Acting | SearchProgress::LastAction) => self.output_ends(channel),
            Some(SearchProgress::WaitsForPlc) => self.channel(channel, channel_to_nck::plc_action_completed, true),
        })
    }

    /// The state of a block search is over.
    pub(super) fn search_is_not(self, channel: ChannelNumber, what: &str, is: impl Fn(&Search) -> bool) -> Condition {
        let search = self.state.programs[channel].search();
        let holds = search.is_some_and(is);
        let shown = format!("a block search of {} {what}", self.channel_name(channel));
        Fact::new(shown, yes(holds), "no", !holds).after(|| {
            let goes_on = match search.map(|search| search.progress) {
                None | Some(SearchProgress::Searching) => self.search_finds(channel),
                Some(SearchProgress::Acting) => self.output_ends(channel),
                Some(SearchProgress::LastAction | SearchProgress::WaitsForPlc) => {
                    Condition::All(vec![self.output_ends(channel), self.program_starts(channel)])
                }
                Some(SearchProgress::Found | SearchProgress::Ready) => self.program_starts(channel),
            };
            Condition::Any(vec![goes_on, self.program_ends(channel)])
        })
    }

    /// A search has reached its block.
    fn search_finds(self, channel: ChannelNumber) -> Condition {
        let program = &self.state.programs[channel];
        let wanted = program.search().map_or_else(|| "one".to_owned(), |search| search.target.clone());
        let next = program.run.as_deref().and_then(|run| run.queue.front());
        let found = next.map_or_else(|| "none".to_owned(), |block| block.origin.name.clone());
        Fact::new(format!("next block of {}", self.channel_name(channel)), found, wanted, false).into()
    }

    /// The PLC has seen what is output.
    pub(super) fn output_ends(self, channel: ChannelNumber) -> Condition {
        let is_busy = self.state.programs[channel].output.is_busy();
        let what = format!("auxiliary functions of {} that the PLC has not acknowledged", self.channel_name(channel));
        Fact::new(what, if is_busy { "one or more" } else { "none" }, "none", !is_busy).into()
    }
}
