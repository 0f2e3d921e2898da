//! Conditions of the signals of a program: its state, the state of the channel, auxiliary functions.

use crate::control::{Condition, Fact, Question, fact, yes};
use crate::image::{
    ChannelAuxiliary, axis_from_nck, channel_auxiliary, channel_from_nck, channel_search_from_nck, channel_to_nck,
    mode_group_from_nck, mode_group_to_nck, nck_from_nck,
};
use crate::nc_program::g;
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::program::search_state::{Search, SearchProgress};
use crate::sinumerik::program::state::{Phase, ProgramState, WaitFor};
use crate::sinumerik::publish::conditions::look::{Look, Row};
use crate::sinumerik::user::state::UserReaction;
use crate::units::{AxisNumber, ChannelNumber};

/// DB21.DBX32.5, 33.2, 33.5, 35.0 to 35.7.
pub(super) const CHANNEL: &[Row<ChannelNumber>] = &[
    Row::with(
        channel_from_nck::m0_m1_active,
        |look, channel| look.stopped_by(channel, "M0 or M1", look.state.programs[channel].programmed_stop),
        |look, channel| look.stopped_no_more(channel, "M0 or M1", look.state.programs[channel].programmed_stop),
    ),
    Row::with(
        channel_from_nck::action_block_active,
        |look, channel| {
            let output = &look.state.programs[channel].output;
            look.search_is(channel, "outputs action blocks", |search| search.acts(output))
        },
        |look, channel| {
            let output = &look.state.programs[channel].output;
            look.search_is_not(channel, "outputs action blocks", |search| search.acts(output))
        },
    ),
    Row::with(
        channel_from_nck::approach_block_active,
        |look, channel| look.approaches(channel, true),
        |look, channel| look.approaches(channel, false),
    ),
    Row::with(
        channel_from_nck::last_action_block_active,
        |look, channel| look.search_is(channel, "has output its last action block", Search::is_last_action),
        |look, channel| look.search_is_not(channel, "has output its last action block", Search::is_last_action),
    ),
    Row::with(
        channel_from_nck::block_search_active,
        |look, channel| look.search_is(channel, "looks for its block", Search::is_searching),
        |look, channel| look.search_is_not(channel, "looks for its block", Search::is_searching),
    ),
    Row::with(
        channel_search_from_nck::search_by_program_test_active,
        |look, channel| look.search_is(channel, "looks for its block by program test", Search::is_by_program_test),
        |look, channel| look.search_is_not(channel, "looks for its block by program test", Search::is_by_program_test),
    ),
    Row::with(
        channel_from_nck::program_test_active,
        |look, channel| look.program_test(channel, true),
        |look, channel| look.program_test(channel, false),
    ),
    Row::with(
        channel_from_nck::revolutional_feedrate_active,
        |look, channel| look.revolutional(channel, true),
        |look, channel| look.revolutional(channel, false),
    ),
    Row::new(channel_from_nck::handwheel_override_active, |look, channel| {
        let overrides =
            |axis: AxisNumber| look.state.axes[axis].by_handwheel.is_some_and(|one| one.is_active && !one.is_axial);
        let active = look.state.owners.of_channel(channel).iter().any(overrides);
        fact(format!("a handwheel overrides the path of {}", look.channel_name(channel)), active)
            .after(|| look.override_of_path_begins(channel))
    }),
    Row::with(
        channel_search_from_nck::associated_m0_m1_active,
        |look, channel| look.stopped_by(channel, ASSOCIATED, look.state.programs[channel].associated_stop),
        |look, channel| look.stopped_no_more(channel, ASSOCIATED, look.state.programs[channel].associated_stop),
    ),
    Row::with(
        channel_from_nck::m2_m30_active,
        |look, channel| look.ended(channel, true).after(|| look.reaches(channel, "M2 or M30")),
        |look, channel| look.ended(channel, false).after(|| look.program_starts(channel)),
    ),
    Row::with(
        channel_from_nck::program_state_running,
        |look, owner| look.program(owner, ProgramState::Running),
        |look, owner| look.program_leaves(owner, ProgramState::Running),
    ),
    Row::with(
        channel_from_nck::program_state_wait,
        |look, owner| look.program(owner, ProgramState::Waiting),
        |look, owner| look.program_leaves(owner, ProgramState::Waiting),
    ),
    Row::with(
        channel_from_nck::program_state_stopped,
        |look, owner| look.program(owner, ProgramState::Stopped),
        |look, owner| look.program_leaves(owner, ProgramState::Stopped),
    ),
    Row::with(
        channel_from_nck::program_state_interrupted,
        |look, owner| look.program(owner, ProgramState::Interrupted),
        |look, owner| look.program_leaves(owner, ProgramState::Interrupted),
    ),
    Row::with(
        channel_from_nck::program_state_aborted,
        |look, owner| look.program(owner, ProgramState::Aborted),
        |look, owner| look.program_leaves(owner, ProgramState::Aborted),
    ),
    Row::with(
        channel_from_nck::channel_state_active,
        |look, owner| look.channel_active(owner),
        |look, owner| look.channel_active_no_more(owner),
    ),
    Row::with(
        channel_from_nck::channel_state_interrupted,
        |look, owner| look.channel_interrupted(owner),
        |look, owner| look.channel_interrupted_no_more(owner),
    ),
    Row::with(
        channel_from_nck::channel_state_reset,
        |look, channel| Condition::All(vec![look.program(channel, ProgramState::Aborted), look.at_rest(channel)]),
        |look, channel| {
            let leaves = look.program_leaves(channel, ProgramState::Aborted);
            Condition::Any(vec![leaves, look.at_rest(channel).opposite()])
        },
    ),
];

/// The M functions that stop a program as M0 and M1 do.
const ASSOCIATED: &str = "an M function of MD22254 or MD22256";

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
    /// A program stands behind a block with a programmed stop.
    fn stopped_by(self, channel: ChannelNumber, what: &str, holds: bool) -> Condition {
        fact(format!("the program of {} is stopped by {what}", self.channel_name(channel)), holds)
            .after(|| self.reaches(channel, &format!("one with {what}")))
    }

    fn stopped_no_more(self, channel: ChannelNumber, what: &str, holds: bool) -> Condition {
        let shown = format!("the program of {} is stopped by {what}", self.channel_name(channel));
        Fact::new(shown, yes(holds), "no", !holds)
            .after(|| Condition::Any(vec![self.program_starts(channel), self.program_ends(channel)]))
    }

    fn ended(self, channel: ChannelNumber, wanted: bool) -> Fact {
        let ended = self.state.programs[channel].ended;
        let what = format!("a program of {} has ended, and none has started since", self.channel_name(channel));
        Fact::new(what, yes(ended), yes(wanted), ended == wanted)
    }

    /// 32.4: the approach of a search.
    fn approaches(self, channel: ChannelNumber, wanted: bool) -> Condition {
        let run = self.state.programs[channel].run.as_deref();
        let approaches = run.is_some_and(|run| run.approaches);
        let what = format!("the axes of {} approach the block of a search", self.channel_name(channel));
        Fact::new(what, yes(approaches), yes(wanted), approaches == wanted).after(|| {
            match (wanted, self.stage(channel)) {
                (true, _) => {
                    self.search_is(channel, "has output everything, and NC start begins its approach", |search| {
                        search.progress == SearchProgress::Ready
                    })
                }
                (false, Some(stage)) => {
                    let held = run.map(|run| self.path_not_held(run, &stage)).into_iter().flatten();
                    let way = Fact::new("way of the approach", "not over", "over", false).into();
                    Condition::Any(vec![Condition::All(held.chain([way]).collect()), self.program_ends(channel)])
                }
                (false, None) => Condition::NOTHING,
            }
        })
    }

    /// 33.2: G95.
    fn revolutional(self, channel: ChannelNumber, wanted: bool) -> Condition {
        let active = self.state.programs[channel].modal.is(g::G95);
        let word = |on: bool| if on { "per revolution (G95)" } else { "per minute (G94)" };
        let what = format!("feed of {}", self.channel_name(channel));
        Fact::new(what, word(active), word(wanted), active == wanted)
            .after(|| self.reaches(channel, if wanted { "one with G95" } else { "one with G94" }))
    }

    /// What a program that waits waits for.
    pub(super) fn no_wait(self, channel: ChannelNumber) -> Condition {
        let found = match self.state.programs[channel].run.as_deref().and_then(|run| run.waits.as_ref()) {
            Some(WaitFor::Mark { mark, .. }) => format!("for mark {mark} in other channels"),
            Some(WaitFor::End(_)) => "for the end of programs of other channels".to_owned(),
            None => "for an axis that it does not have".to_owned(),
        };
        Fact::new(format!("wait of {}", self.channel_name(channel)), found, "none", false).into()
    }

    /// What NC start, or START of another channel, tests, in the order of `program/start.rs`.
    pub(super) fn program_starts(self, channel: ChannelNumber) -> Condition {
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
    pub(super) fn mode_of_start(self, channel: ChannelNumber) -> Condition {
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
        // Change bits, quick functions and decoded M functions stand for one scan, the values until the next output of their place.
        let is_for_a_scan = question.byte < channel_auxiliary::m_function_1_extension.byte
            || question.byte >= channel_auxiliary::decoded_m_function_0.byte;
        Some(shown.after(|| match (question.wanted, is_for_a_scan) {
            (true, _) => self.reaches(channel, "a block that outputs it"),
            (false, true) => self.output_ends(channel),
            (false, false) => self.reaches(channel, "a block that outputs another value in its place"),
        }))
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
