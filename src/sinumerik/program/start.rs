//! NC start and its refusals, stop, RESET, the end of a program, and what a change of the mode does to it.

use crate::image::{ToNck, channel_from_nck, channel_to_nck, mode_group_from_nck, mode_group_to_nck};
use crate::motion::path::{PATH_AXES, Path, PathLimits};
use crate::nc_program::{Interpreter, Library};
use crate::sinumerik::alarms::{Alarm, Reaction, START_WITHOUT_REFERENCE, programs as alarms};
use crate::sinumerik::inputs::{channel_signal, mode_group_signal};
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::control::skip_levels;
use crate::sinumerik::program::executable::StateBehind;
use crate::sinumerik::program::state::{Phase, Preparation, ProgramState, Run, on_path};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisSet, ChannelNumber, ModeGroupNumber, PerAxis};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, short_text};

use std::collections::VecDeque;

/// What an alarm of NC start calls it.
const NC_START: &str = "NC start";

impl State {
    /// NC start: the rising edge of DB21.DBX7.1, after it has cancelled alarms.
    pub(in crate::sinumerik) fn start_program(
        &mut self,
        (channel, group): (ChannelNumber, ModeGroupNumber),
        parameters: &Parameters,
        library: &Library,
        to_nck: &ToNck,
    ) {
        let Some(own) = parameters.programs[channel].as_deref() else { return };
        let signals = &to_nck.channels[channel];
        let mode = self.mode_groups[group].mode;
        let pressed = channel_signal(channel, channel_to_nck::nc_start, true);
        let of_group = &to_nck.mode_groups[group];
        let stops = signals.nc_stop()
            || signals.nc_stop_at_block_limit()
            || signals.nc_stop_axes_plus_spindles()
            || of_group.mode_group_stop()
            || of_group.mode_group_stop_axes_plus_spindles();
        if self.is_start_disabled(channel, to_nck) || stops {
            return;
        }
        if mode == Mode::Jog {
            self.start_generators(channel, parameters, pressed);
            return;
        }
        let may_start = self.is_referenced(channel, parameters)
            || self.may_start_unreferenced(channel, mode == Mode::Mda, parameters);
        if !may_start {
            self.refuse_unreferenced(channel, pressed);
            return;
        }
        if let Some(number) = self.start_is_locked(channel, parameters) {
            let inputs = [pressed, Input::Alarm(number.0), Input::None];
            self.refuse_start(channel, alarms::ALARM_PENDING, Rule::StartHinderedByAlarm, inputs);
            return;
        }
        if self.stop(channel, parameters).is_some() || !self.is_nc_ready() {
            return;
        }
        let program = &self.programs[channel];
        match program.state {
            ProgramState::Running | ProgramState::Waiting => {
                let running = channel_signal(channel, channel_from_nck::program_state_running, true);
                let inputs = [pressed, running, Input::None];
                self.refuse_start(channel, alarms::ALREADY_ACTIVE, Rule::StartAlreadyActive, inputs);
            }
            ProgramState::Stopped | ProgramState::Interrupted => {
                if program.run.as_ref().is_some_and(|run| run.is_mda == (mode == Mode::Mda)) {
                    self.go_on(channel, pressed);
                    self.release_spindles(channel, parameters, self.programs[channel].cause);
                }
            }
            ProgramState::Aborted => {
                let selected = if mode == Mode::Mda { program.mda.clone() } else { program.selected.clone() };
                match selected.filter(|path| library.program(path).is_some()) {
                    Some(path) => {
                        let event = self.note_start(channel, mode, parameters, pressed);
                        self.begin_program((channel, mode), &path, own, (parameters, to_nck), event);
                        self.release_spindles(channel, parameters, self.programs[channel].cause);
                    }
                    None if mode == Mode::Mda => {}
                    None => self.refuse_missing_program(channel, pressed),
                }
            }
        }
    }

    /// 14014: NC start without a selected program, or the selected one does not exist.
    fn refuse_missing_program(&mut self, channel: ChannelNumber, pressed: Input) {
        let place = Place::Channel(channel);
        let event = self.log.note_one(place, Rule::NoProgramSelected, pressed, EventId::NONE);
        let name = self.programs[channel].selected.as_deref().unwrap_or(alarms::NONE_SELECTED);
        let name = Parameter::Text(short_text(name));
        let shown = [Parameter::Channel(channel), Parameter::None, name, Parameter::None];
        self.alarms.raise(alarms::NO_PROGRAM, place, shown, event);
    }

    /// 10203: NC start although an axis is not referenced (MD20700).
    fn refuse_unreferenced(&mut self, channel: ChannelNumber, pressed: Input) {
        let place = Place::Channel(channel);
        let referenced = channel_from_nck::all_axes_requiring_reference_point_are_referenced;
        let missing = channel_signal(channel, referenced, false);
        let event = self.log.note(place, Rule::StartRefused, [pressed, missing, Input::None], EventId::NONE);
        let shown = [Parameter::Channel(channel), Parameter::None, Parameter::None, Parameter::None];
        self.alarms.raise(START_WITHOUT_REFERENCE, place, shown, event);
    }

    /// Whether an alarm at this place disables NC start of a channel.
    pub(in crate::sinumerik) fn locks_start(
        &self,
        (place, alarm): (Place, &Alarm),
        channel: ChannelNumber,
        parameters: &Parameters,
    ) -> bool {
        alarm.reaction.has(Reaction::START_DISABLED) && self.owners.concerns_channel(parameters, place, channel)
    }

    /// The first pending alarm that disables NC start of a channel.
    pub(in crate::sinumerik) fn start_is_locked(
        &self,
        channel: ChannelNumber,
        parameters: &Parameters,
    ) -> Option<AlarmNumber> {
        let locks = |place, alarm: &Alarm| self.locks_start((place, alarm), channel, parameters);
        self.alarms.first_alarm(locks).map(|(number, _)| number)
    }

    /// NC start has no effect: a message says why.
    pub(in crate::sinumerik) fn refuse_start(
        &mut self,
        channel: ChannelNumber,
        number: AlarmNumber,
        rule: Rule,
        inputs: [Input; 3],
    ) {
        let place = Place::Channel(channel);
        let event = self.log.note(place, rule, inputs, EventId::NONE);
        let action = Parameter::Text(short_text(NC_START));
        let shown = [Parameter::Channel(channel), action, Parameter::None, Parameter::None];
        self.alarms.raise(number, place, shown, event);
    }

    /// NC start begins a program: the event.
    fn note_start(&mut self, channel: ChannelNumber, mode: Mode, parameters: &Parameters, pressed: Input) -> EventId {
        let automatic = mode_group_from_nck::active_mode_automatic;
        let mda = mode_group_from_nck::active_mode_mdi;
        let group = parameters.mode_group(channel);
        let active = mode_group_signal(group, if mode == Mode::Mda { mda } else { automatic }, true);
        self.log.note(
            Place::Channel(channel),
            Rule::ProgramStarted,
            [pressed, active, Input::None],
            self.mode_groups[group].mode_cause,
        )
    }

    /// Begins a program, after the event that starts it.
    pub(super) fn begin_program(
        &mut self,
        (channel, mode): (ChannelNumber, Mode),
        path: &str,
        own: &ProgramParameters,
        (parameters, to_nck): (&Parameters, &ToNck),
        event: EventId,
    ) {
        let interpreter = Interpreter::new(path, own.modal, self.initial_feed(channel, own), mode == Mode::Mda);
        let run = self.new_run((channel, mode == Mode::Mda), interpreter, own, (parameters, to_nck), event);
        let program = &mut self.programs[channel];
        program.run = Some(Box::new(run));
        (program.state, program.cause) = (ProgramState::Running, event);
        (program.ended, program.programmed_stop, program.associated_stop) = (false, false, false);
        (program.modal, program.modal_cause) = (own.modal, event);
        program.programmable.clear();
    }

    /// The feed with which a program begins: with MD22410 that of the last one, else SD42110.
    pub(super) fn initial_feed(&self, channel: ChannelNumber, own: &ProgramParameters) -> Option<f64> {
        let stays = self.programs[channel].last_feed.filter(|_| own.feed_stays);
        stays.or_else(|| own.initial_feed())
    }

    /// A program before its first block, or before that of the interpreter.
    pub(super) fn new_run(
        &self,
        (channel, is_mda): (ChannelNumber, bool),
        interpreter: Interpreter,
        own: &ProgramParameters,
        (parameters, to_nck): (&Parameters, &ToNck),
        event: EventId,
    ) -> Run {
        let position = on_path(&own.axes.path, |axis| self.axes[axis].setpoint.position);
        let modal = interpreter.modal();
        let offsets = on_path(&own.axes.path, |axis| self.programs[channel].active_offset(modal, axis));
        let limits = limits(own, parameters);
        let behind = StateBehind {
            interpreter: interpreter.clone(),
            axis_feeds: Vec::new(),
            path_override: 1.0,
            programmed_on_path: AxisSet::NONE,
            offsets,
            counted: own.axes.counted,
            end: position,
        };
        Run {
            interpreter,
            is_mda,
            preparation: Preparation::Reads,
            queue: VecDeque::new(),
            on_path: 0,
            phase: Phase::Between,
            path: Path::new(position, limits),
            limits,
            returning: None,
            has_returned: false,
            end: position,
            left: Vec::new(),
            numbers: 0,
            axis_feeds: Vec::new(),
            positionings: Vec::new(),
            awaits_spindles: false,
            prepared_spindles: Vec::new(),
            spindle_limits: Vec::new(),
            dwell_turns: None,
            dwell: 0,
            block_cause: event,
            block_cycle: self.log.cycle,
            continued_cycle: self.log.cycle,
            read_again_cycle: None,
            stopping: None,
            resetting: None,
            delete_was: false,
            axial_delete_were: AxisSet::NONE,
            axial_delete_causes: PerAxis::default(),
            axial_deleting: AxisSet::NONE,
            deleting: false,
            reads_again: false,
            new_conf: false,
            alarm_origin: None,
            cycle_alarm: None,
            pauses: false,
            again: VecDeque::new(),
            claim: None,
            holds_preparation: false,
            referencing: AxisSet::NONE,
            referencing_started: AxisSet::NONE,
            behind,
            executed: 0,
            r_log: VecDeque::new(),
            skips: skip_levels(channel, to_nck),
            dry_run: to_nck.channels[channel].activate_dry_run_feedrate(),
            change: None,
            level_signals_were: [false; 2],
            commanded: AxisSet::NONE,
            commanded_arrived: false,
            read_in_disabled: false,
            path_override: 1.0,
            handwheel_share: 0.0,
            programmed_on_path: AxisSet::NONE,
            offsets,
            counted: own.axes.counted,
            waits: None,
            starts: Vec::new(),
            search: None,
            approaches: false,
        }
    }

    /// NC start of a program that is stopped or interrupted.
    fn go_on(&mut self, channel: ChannelNumber, pressed: Input) {
        let before = self.programs[channel].cause;
        let event = self.log.note_one(Place::Channel(channel), Rule::ProgramGoesOn, pressed, before);
        let program = &mut self.programs[channel];
        (program.state, program.cause) = (ProgramState::Running, event);
        (program.programmed_stop, program.associated_stop) = (false, false);
        let cycle = self.log.cycle;
        if let Some(run) = &mut program.run {
            (run.stopping, run.reads_again) = (None, true);
            (run.continued_cycle, run.read_again_cycle) = (cycle, Some(cycle));
            run.referencing_started = AxisSet::NONE;
        }
    }

    /// RESET of a channel: its program ends when its axes are at rest.
    pub(in crate::sinumerik) fn reset_program(&mut self, channel: ChannelNumber, event: EventId) {
        let program = &mut self.programs[channel];
        if let Some(run) = &mut program.run {
            run.resetting.get_or_insert(event);
        }
        // What is in DB21 already stays for its cycle.
        program.output.drop_waiting();
        program.main_run.clear_markers();
        program.message = None;
    }

    /// The program of a channel has ended, by its M2 or M30, by its last block, or by RESET.
    pub(in crate::sinumerik) fn end_program(
        &mut self,
        channel: ChannelNumber,
        own: &ProgramParameters,
        event: EventId,
        by_itself: bool,
    ) {
        let program = &mut self.programs[channel];
        (program.state, program.cause) = (ProgramState::Aborted, event);
        (program.ended, program.programmed_stop, program.associated_stop) = (by_itself, false, false);
        (program.modal, program.modal_cause) = (own.modal, event);
        program.message = None;
        program.programmable.clear();
        program.search_cause = event;
        program.actions.retain(|one| one.action.is_static);
    }

    /// What outlasts power off: R parameters, the selected programs, settable offsets.
    pub(in crate::sinumerik) fn keep_programs(&mut self, before: &Self) {
        self.r_parameters.keep(&before.r_parameters);
        self.reasons.clone_from(&before.reasons);
        for (channel, program) in self.programs.iter_mut() {
            let old = &before.programs[channel];
            program.selected.clone_from(&old.selected);
            program.mda.clone_from(&old.mda);
            program.offsets.clone_from(&old.offsets);
        }
    }

    /// Whether something stops the program of a channel in this cycle: the event.
    pub(in crate::sinumerik) fn program_stopper(
        &mut self,
        channel: ChannelNumber,
        is_mda: bool,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<EventId> {
        let place = Place::Channel(channel);
        let before = self.programs[channel].cause;
        if let Some(stop) = self.stop(channel, parameters) {
            let (rule, input) = stop.tested();
            return Some(self.log.now(place, stop.cause(), rule, [input, Input::None, Input::None]));
        }
        if let Some((alarm, cause)) = self.stopped_at_limit(channel) {
            let inputs = [alarm, Input::None, Input::None];
            return Some(self.log.now(place, cause, Rule::StoppedByAlarm, inputs));
        }
        let signals = &to_nck.channels[channel];
        let pressed = [
            (signals.nc_stop(), channel_to_nck::nc_stop),
            (signals.nc_stop_axes_plus_spindles(), channel_to_nck::nc_stop_axes_plus_spindles),
        ];
        if let Some((_, signal)) = pressed.into_iter().find(|(is_pressed, _)| *is_pressed) {
            let input = channel_signal(channel, signal, true);
            return Some(self.log.note_one(place, Rule::NcStop, input, before));
        }
        let group = parameters.mode_group(channel);
        let signals = &to_nck.mode_groups[group];
        let pressed = [
            (signals.mode_group_stop(), mode_group_to_nck::mode_group_stop),
            (signals.mode_group_stop_axes_plus_spindles(), mode_group_to_nck::mode_group_stop_axes_plus_spindles),
        ];
        if let Some((_, signal)) = pressed.into_iter().find(|(is_pressed, _)| *is_pressed) {
            let input = mode_group_signal(group, signal, true);
            return Some(self.log.note_one(place, Rule::NcStop, input, before));
        }
        let wanted = if is_mda { Mode::Mda } else { Mode::Automatic };
        if self.mode_groups[group].mode != wanted {
            let shown =
                if is_mda { mode_group_from_nck::active_mode_mdi } else { mode_group_from_nck::active_mode_automatic };
            let input = mode_group_signal(group, shown, false);
            return Some(self.log.note_one(place, Rule::ModeLeft, input, self.mode_groups[group].mode_cause));
        }
        None
    }

    /// 35.3 while a stopped program waits in JOG, 35.2 in its own mode.
    pub(in crate::sinumerik) fn show_interruption(&mut self, channel: ChannelNumber, parameters: &Parameters) {
        let group = parameters.mode_group(channel);
        let jog = self.mode_groups[group].mode == Mode::Jog;
        let program = &self.programs[channel];
        let state = match program.state {
            ProgramState::Stopped if jog => ProgramState::Interrupted,
            ProgramState::Interrupted if !jog => ProgramState::Stopped,
            _ => return,
        };
        let input = mode_group_signal(group, mode_group_from_nck::active_mode_jog, jog);
        let parent = self.mode_groups[group].mode_cause;
        let event = self.log.note_one(Place::Channel(channel), Rule::InterruptionInJog, input, parent);
        let program = &mut self.programs[channel];
        (program.state, program.cause) = (state, event);
    }
}

/// The limits of the path of a channel: those of its axes, and of the synchronous axes that they lead.
fn limits(own: &ProgramParameters, parameters: &Parameters) -> PathLimits {
    let mut limits = PathLimits {
        velocity: [f64::INFINITY; PATH_AXES],
        acceleration: [f64::INFINITY; PATH_AXES],
        overload: [1.0; PATH_AXES],
    };
    for (place, axis) in own.axes.path.iter().enumerate() {
        let axis = &parameters.axes[*axis];
        limits.velocity[place] = axis.maximum_velocity;
        limits.acceleration[place] = axis.maximum_acceleration;
        limits.overload[place] = axis.overload;
    }
    limits
}
