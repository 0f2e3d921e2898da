//! Conditions of the signals of a program: its state, the state of the channel, auxiliary functions.

use crate::control::{Condition, Fact, Question, fact};
use crate::image::{
    ChannelAuxiliary, axis_from_nck, channel_auxiliary, channel_from_nck, channel_search_from_nck, channel_to_nck,
    mode_group_from_nck, mode_group_to_nck, nck_from_nck,
};
use crate::nc_program::g;
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::program::search_state::Search;
use crate::sinumerik::program::state::{Phase, ProgramState, WaitFor};
use crate::sinumerik::publish::conditions::look::{Look, Row};
use crate::sinumerik::user::state::UserReaction;
use crate::units::{AxisNumber, ChannelNumber};

/// DB21.DBX32.5, 33.2, 33.5, 35.0 to 35.7.
pub(super) const CHANNEL: &[Row<ChannelNumber>] = &[
    Row::new(channel_from_nck::m0_m1_active, |look, channel| {
        let is_stopped = look.state.programs[channel].programmed_stop;
        fact(format!("the program of {} is stopped by M0 or M1", look.channel_name(channel)), is_stopped).into()
    }),
    Row::new(channel_from_nck::action_block_active, |look, channel| {
        let program = &look.state.programs[channel];
        let acts = program.search().is_some_and(|search| search.acts(&program.output));
        fact(format!("action blocks of {} are output after a block search", look.channel_name(channel)), acts).into()
    }),
    Row::new(channel_from_nck::approach_block_active, |look, channel| {
        let approaches = look.state.programs[channel].run.as_ref().is_some_and(|run| run.approaches);
        fact(format!("the axes of {} approach the block of a search", look.channel_name(channel)), approaches).into()
    }),
    Row::new(channel_from_nck::last_action_block_active, |look, channel| {
        let is_last = look.state.programs[channel].search().is_some_and(Search::is_last_action);
        fact(
            format!("the last action block of {} was output, and NC start is waited for", look.channel_name(channel)),
            is_last,
        )
        .into()
    }),
    Row::new(channel_from_nck::block_search_active, |look, channel| {
        let searches = look.state.programs[channel].search().is_some_and(Search::is_searching);
        fact(format!("a block search of {} runs", look.channel_name(channel)), searches).into()
    }),
    Row::new(channel_search_from_nck::search_by_program_test_active, |look, channel| {
        let searches = look.state.programs[channel].search().is_some_and(Search::is_by_program_test);
        fact(format!("a block search with program test of {} runs", look.channel_name(channel)), searches).into()
    }),
    Row::with(
        channel_from_nck::program_test_active,
        |look, channel| look.program_test(channel, true),
        |look, channel| look.program_test(channel, false),
    ),
    Row::new(channel_from_nck::revolutional_feedrate_active, |look, channel| {
        let active = look.state.programs[channel].modal.is(g::G95);
        fact(format!("G95 is active in {}: feed per revolution", look.channel_name(channel)), active).into()
    }),
    Row::new(channel_from_nck::handwheel_override_active, |look, channel| {
        let overrides =
            |axis: AxisNumber| look.state.axes[axis].by_handwheel.is_some_and(|one| one.is_active && !one.is_axial);
        let active = look.state.owners.of_channel(channel).iter().any(overrides);
        fact(format!("a handwheel overrides the path of {}", look.channel_name(channel)), active)
            .after(|| look.override_of_path_begins(channel))
    }),
    Row::new(channel_search_from_nck::associated_m0_m1_active, |look, channel| {
        let is_stopped = look.state.programs[channel].associated_stop;
        let what =
            format!("the program of {} is stopped by an M function of MD22254 or MD22256", look.channel_name(channel));
        fact(what, is_stopped).into()
    }),
    Row::new(channel_from_nck::m2_m30_active, |look, channel| {
        let what = format!("a program of {} has ended, and none has started since", look.channel_name(channel));
        fact(what, look.state.programs[channel].ended).after(|| look.reaches(channel, "M2 or M30"))
    }),
    Row::new(channel_from_nck::program_state_running, |look, owner| look.program(owner, ProgramState::Running)),
    Row::new(channel_from_nck::program_state_wait, |look, owner| look.program(owner, ProgramState::Waiting)),
    Row::new(channel_from_nck::program_state_stopped, |look, owner| look.program(owner, ProgramState::Stopped)),
    Row::new(channel_from_nck::program_state_interrupted, |look, owner| look.program(owner, ProgramState::Interrupted)),
    Row::new(channel_from_nck::program_state_aborted, |look, owner| look.program(owner, ProgramState::Aborted)),
    Row::new(channel_from_nck::channel_state_active, |look, channel| {
        let program = [ProgramState::Running, ProgramState::Waiting].map(|state| look.program(channel, state));
        let moved = Condition::All(vec![
            look.program(channel, ProgramState::Stopped).opposite(),
            look.at_rest(channel).opposite(),
        ]);
        Condition::Any(program.into_iter().chain([moved]).collect())
    }),
    Row::new(channel_from_nck::channel_state_interrupted, |look, channel| {
        let rests = Condition::All(vec![look.program(channel, ProgramState::Interrupted), look.at_rest(channel)]);
        Condition::Any(vec![look.program(channel, ProgramState::Stopped), rests])
    }),
    Row::new(channel_from_nck::channel_state_reset, |look, channel| {
        Condition::All(vec![look.program(channel, ProgramState::Aborted), look.at_rest(channel)])
    }),
];

const fn word(state: ProgramState) -> &'static str {
    match state {
        ProgramState::Aborted => "aborted",
        ProgramState::Running => "running",
        ProgramState::Waiting => "waiting",
        ProgramState::Stopped => "stopped",
        ProgramState::Interrupted => "interrupted",
    }
}

/// What the block of a program does, in words.
const fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Between => "has not begun",
        Phase::Before => "waits before its motion",
        Phase::Moving => "runs",
        Phase::After => "waits after its motion",
    }
}

impl Look<'_> {
    fn program(self, channel: ChannelNumber, wanted: ProgramState) -> Condition {
        let found = self.state.programs[channel].state;
        let what = format!("state of the program of {}", self.channel_name(channel));
        let fact = Fact::new(what, word(found), word(wanted), found == wanted);
        match (wanted, found) {
            (ProgramState::Running, ProgramState::Waiting) => fact.after(|| self.no_wait(channel)),
            (ProgramState::Running, _) => fact.after(|| self.program_starts(channel)),
            _ => fact.into(),
        }
    }

    /// What a program that waits waits for.
    fn no_wait(self, channel: ChannelNumber) -> Condition {
        let found = match self.state.programs[channel].run.as_deref().and_then(|run| run.waits.as_ref()) {
            Some(WaitFor::Mark { mark, .. }) => format!("for mark {mark} in other channels"),
            Some(WaitFor::End(_)) => "for the end of programs of other channels".to_owned(),
            None => "for an axis that it does not have".to_owned(),
        };
        Fact::new(format!("wait of {}", self.channel_name(channel)), found, "none", false).into()
    }

    /// What NC start, or START of another channel, tests, in the order of `program/start.rs`.
    fn program_starts(self, channel: ChannelNumber) -> Condition {
        let mut all = vec![
            self.mode_of_start(channel),
            self.not_disabled(channel, channel_to_nck::nc_start_disable, UserReaction::NcStart),
            self.referenced_for_start(channel),
            self.no_alarm(format!("alarm that disables NC start of {}", self.channel_name(channel)), |place, alarm| {
                self.state.locks_start((place, alarm), channel, self.parameters)
            }),
            self.not_stopped(channel),
            self.nck(nck_from_nck::nc_ready, true),
        ];
        let is_first = self.state.programs[channel].state == ProgramState::Aborted;
        all.extend(is_first.then(|| self.selected_program(channel)));
        let others = self.parameters.existing_channels().count() > 1;
        let start = format!("START({channel}) in the program of another channel");
        let by_program = (is_first && others).then(|| Fact::new(start, "none", "one", false).into());
        all.push(match by_program {
            Some(by_program) => Condition::Any(vec![self.nc_start(channel), by_program]),
            None => self.nc_start(channel),
        });
        Condition::All(all)
    }

    /// The key: its rising edge, while nothing stops the channel.
    fn nc_start(self, channel: ChannelNumber) -> Condition {
        let asks = |signal, value| self.channel(channel, signal, value);
        let group = self.parameters.mode_group(channel);
        let was = self.state.channels[channel].start_was;
        Condition::All(vec![
            asks(channel_to_nck::nc_stop, false),
            asks(channel_to_nck::nc_stop_at_block_limit, false),
            asks(channel_to_nck::nc_stop_axes_plus_spindles, false),
            self.mode_group(group, mode_group_to_nck::mode_group_stop, false),
            self.mode_group(group, mode_group_to_nck::mode_group_stop_axes_plus_spindles, false),
            asks(channel_to_nck::nc_start, true),
            Fact::new("NC start in the last cycle", u8::from(was).to_string(), "0", !was).into(),
        ])
    }

    /// AUTOMATIC or MDA; a program that is stopped goes on in its own mode.
    fn mode_of_start(self, channel: ChannelNumber) -> Condition {
        let group = self.parameters.mode_group(channel);
        let [automatic, mda] = [mode_group_from_nck::active_mode_automatic, mode_group_from_nck::active_mode_mdi]
            .map(|mode| self.mode_group(group, mode, true));
        match self.state.programs[channel].run.as_deref() {
            Some(run) if run.is_mda => mda,
            Some(_) => automatic,
            None => Condition::Any(vec![automatic, mda]),
        }
    }

    /// 36.2; with MD20700 = 2 it suffices in MDA that positions are restored.
    fn referenced_for_start(self, channel: ChannelNumber) -> Condition {
        let referenced =
            self.channel(channel, channel_from_nck::all_axes_requiring_reference_point_are_referenced, true);
        let own = &self.parameters.channels[channel];
        if !own.restored_suffices_in_mda {
            return referenced;
        }
        let unknown: Vec<_> = own
            .reference_needed
            .iter()
            .filter(|axis| !self.state.axes[*axis].knows_position())
            .map(|axis| self.axis_name(axis))
            .collect();
        let found = if unknown.is_empty() { "none".to_owned() } else { unknown.join(", ") };
        let what =
            format!("axes of {} that are neither referenced nor restored (MD20700 = 2)", self.channel_name(channel));
        let restored = Condition::All(vec![
            self.mode_group(self.parameters.mode_group(channel), mode_group_from_nck::active_mode_mdi, true),
            Fact::new(what, found, "none", unknown.is_empty()).into(),
        ]);
        Condition::Any(vec![referenced, restored])
    }

    /// The program that NC start would begin: what was entered in MDA, or the selected one, and it exists.
    fn selected_program(self, channel: ChannelNumber) -> Condition {
        let program = &self.state.programs[channel];
        let is_mda = self.state.mode_groups[self.parameters.mode_group(channel)].mode == Mode::Mda;
        let (what, path) =
            if is_mda { ("block entered in MDA", &program.mda) } else { ("selected program", &program.selected) };
        let (found, holds) = match path {
            None => ("none".to_owned(), false),
            Some(path) if self.library.program(path).is_none() => (format!("{path}, which does not exist"), false),
            Some(path) => (path.clone(), true),
        };
        Fact::new(format!("{what} of {}", self.channel_name(channel)), found, "one", holds).into()
    }

    /// The bits of DB21.DBB58 to 206: what is output to the PLC now.
    pub(super) fn auxiliary(self, channel: ChannelNumber, question: &Question<'_>) -> Option<Condition> {
        let index = usize::from(question.byte.checked_sub(ChannelAuxiliary::FIRST)?);
        if question.byte >= channel_auxiliary::active_g_function_of_group_1.byte {
            return None;
        }
        let bytes = self.state.programs[channel].output.bytes();
        let byte = bytes.and_then(|bytes| bytes.get(index)).copied().unwrap_or(0);
        let is_set = byte >> question.bit & 1 == 1;
        let what = format!("auxiliary functions of {} set this bit", self.channel_name(channel));
        let found = if is_set { "yes" } else { "no" };
        let wanted = if question.wanted { "yes" } else { "no" };
        let shown = Fact::new(what, found, wanted, is_set == question.wanted);
        Some(if question.wanted {
            shown.after(|| self.reaches(channel, "a block that outputs it"))
        } else {
            shown.into()
        })
    }

    /// What a program waits for before it reaches a later block. Whether that block comes is not known.
    pub(super) fn reaches(self, channel: ChannelNumber, wanted: &str) -> Condition {
        let program = &self.state.programs[channel];
        let name = self.channel_name(channel);
        let Some((run, stage)) = program.run.as_deref().zip(self.stage(channel)) else {
            return self.program(channel, ProgramState::Running);
        };
        let nothing_held =
            |what: &str, found: &str| Fact::new(format!("{what} of {name}"), found, "none", false).into();
        let mut all = Vec::new();
        match program.state {
            ProgramState::Running => {}
            ProgramState::Waiting => all.push(self.no_wait(channel)),
            ProgramState::Stopped | ProgramState::Interrupted | ProgramState::Aborted => {
                all.push(self.program(channel, ProgramState::Running));
            }
        }
        all.push(self.not_disabled(channel, channel_to_nck::read_in_disable, UserReaction::ReadIn));
        if run.read_in_disabled {
            all.push(nothing_held("RDISABLE of a synchronised action", "active"));
        }
        if program.output.is_busy() {
            all.push(nothing_held("auxiliary functions that the PLC has not acknowledged", "one or more"));
        }
        if run.dwell > 0 {
            all.push(nothing_held("dwell time (G4)", "runs"));
        }
        all.extend(self.no_spindle_awaited(channel));
        if run.phase == Phase::Moving {
            all.extend(self.path_not_held(run, &stage));
        }
        for one in run.positionings.iter().filter(|one| run.awaits(one, stage.own)) {
            let unit = self.unit(one.axis);
            all.push(self.not_held(&unit));
            all.extend(unit.members().map(|axis| self.axis(axis, axis_from_nck::position_controller_active, true)));
        }
        let block = match run.queue.front() {
            Some(block) => format!("{}, {}", block.origin.name.as_str(), phase(run.phase)),
            None => "none".to_owned(),
        };
        all.push(Fact::new(format!("next block of {name}"), block, wanted, false).into());
        Condition::All(all)
    }

    /// A program test is selected and deselected while no program runs and the axes of the channel rest.
    fn program_test(self, channel: ChannelNumber, wanted: bool) -> Condition {
        let active = self.state.programs[channel].test.is_active;
        let what = format!("program test of {}", self.channel_name(channel));
        let word = |on: bool| if on { "selected" } else { "not selected" };
        Fact::new(what, word(active), word(wanted), active == wanted).after(|| {
            let rests = self.parameters.channels[channel].axes.iter().map(|axis| self.setpoint_rests(axis));
            let first = [
                self.channel(channel, channel_to_nck::activate_program_test, wanted),
                self.program(channel, ProgramState::Aborted),
            ];
            Condition::All(first.into_iter().chain(rests).collect())
        })
    }

    /// A block of a program moves the axis in a direction.
    pub(super) fn moved_by_program(self, channel: ChannelNumber, axis: AxisNumber, direction: i8) -> Condition {
        let goes = self.state.axes[axis].travel.request();
        let words = |direction: i8| match direction {
            1 => "plus",
            -1 => "minus",
            _ => "none",
        };
        let what = format!("direction in which the program moves {}", self.axis_name(axis));
        Fact::new(what, words(goes), words(direction), goes == direction)
            .after(|| self.reaches(channel, "one that moves the axis in this direction"))
    }
}
