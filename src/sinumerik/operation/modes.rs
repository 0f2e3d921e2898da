//! The mode groups: modes and machine functions.
//!
//! Called first in the control's part of a cycle. Requests are levels (O-19): the highest of JOG, MDA, AUTO that is 1 is
//! selected; if all are 0, the mode does not change; DBX0.4 inhibits a change. Machine functions act within their mode: TEACH IN
//! in MDA, REF and REPOS in JOG; REF has priority over REPOS. NC start takes the axes of an
//! interrupted program back to its path; the keys of REPOS move nothing. MD10720 defines the mode after power on; the default
//! is JOG. AUTOMATIC and MDA exclude each other while a program of either runs or is stopped (16913), and so does REF (16914).

use crate::image::{Signal, ToNck, mode_group_from_nck, mode_group_to_nck};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::inputs::mode_group_signal;
use crate::sinumerik::operation::state::{MachineFunction, Mode, ModeGroup};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{ChannelNumber, ModeGroupNumber};
use crate::variables::{EventId, Input, Parameter, Place, short_text};

impl State {
    /// Selects modes and machine functions as requested.
    pub(in crate::sinumerik) fn select_modes(&mut self, parameters: &Parameters, to_nck: &ToNck) {
        for group in parameters.existing_mode_groups() {
            self.select_mode(group, parameters, to_nck);
        }
    }

    /// The channel of a group whose program hinders a change between AUTOMATIC and MDA: one of the other mode runs or is stopped.
    fn hinders_mode(&self, group: ModeGroupNumber, mode: Mode, parameters: &Parameters) -> Option<ChannelNumber> {
        let mut channels = parameters.existing_channels().filter(|(_, of)| *of == group);
        let (channel, _) = channels.find(|(channel, _)| {
            let run = self.programs[*channel].run.as_deref();
            mode != Mode::Jog && run.is_some_and(|run| run.is_mda != (mode == Mode::Mda))
        })?;
        Some(channel)
    }

    /// REF is not selected while a program of the group is stopped or interrupted (16914).
    fn refuses_reference(
        &mut self,
        group: ModeGroupNumber,
        is_requested: bool,
        input: Input,
        parameters: &Parameters,
    ) -> bool {
        let mut channels = parameters.existing_channels().filter(|(_, of)| *of == group).map(|(channel, _)| channel);
        let hindering = channels.find(|channel| self.programs[*channel].run.is_some()).filter(|_| is_requested);
        let was = std::mem::replace(&mut self.mode_groups[group].refused_reference, hindering.is_some());
        if let (Some(channel), false) = (hindering, was) {
            let event =
                self.log.note_one(Place::ModeGroup(group), Rule::ModeRefused, input, self.programs[channel].cause);
            let action = Parameter::Text(short_text("machine function REF"));
            let shown =
                [Parameter::Number(group.number().into()), Parameter::Channel(channel), action, Parameter::None];
            self.alarms.raise(alarms::MODE_NOT_ALLOWED, Place::ModeGroup(group), shown, event);
        }
        hindering.is_some()
    }

    fn select_mode(&mut self, group: ModeGroupNumber, parameters: &Parameters, to_nck: &ToNck) {
        let signals = &to_nck.mode_groups[group];
        let place = Place::ModeGroup(group);
        let input = |signal: Signal, value: bool| mode_group_signal(group, signal, value);
        let requested = if signals.mode_change_inhibit() {
            None
        } else if signals.mode_jog() {
            Some((Mode::Jog, input(mode_group_to_nck::mode_jog, true)))
        } else if signals.mode_mdi() {
            Some((Mode::Mda, input(mode_group_to_nck::mode_mdi, true)))
        } else if signals.mode_automatic() {
            Some((Mode::Automatic, input(mode_group_to_nck::mode_automatic, true)))
        } else {
            None
        };
        let hinders = requested.and_then(|(mode, input)| {
            let change = mode != self.mode_groups[group].mode;
            let channel = self.hinders_mode(group, mode, parameters).filter(|_| change)?;
            Some((mode, input, channel))
        });
        let was_refused = self.mode_groups[group].refused;
        self.mode_groups[group].refused = hinders.map(|(mode, ..)| mode);
        if let Some((mode, input, channel)) = hinders
            && was_refused != Some(mode)
        {
            self.refuse_mode(group, channel, input);
        }
        let requested = requested.filter(|_| hinders.is_none());
        let state = &mut self.mode_groups[group];
        if let Some((mode, input)) = requested
            && mode != state.mode
        {
            state.mode = mode;
            state.mode_cause = self.log.note_one(place, Rule::ModeSelected, input, EventId::NONE);
        }
        self.select_function(group, parameters, to_nck);
    }

    /// 16913: a program of the channel hinders the change of the mode.
    fn refuse_mode(&mut self, group: ModeGroupNumber, channel: ChannelNumber, input: Input) {
        let place = Place::ModeGroup(group);
        let event = self.log.note_one(place, Rule::ModeRefused, input, self.programs[channel].cause);
        let action = Parameter::Text(short_text("mode change"));
        let shown = [Parameter::Number(group.number().into()), Parameter::Channel(channel), action, Parameter::None];
        self.alarms.raise(alarms::MODE_ONLY_IN_RESET, place, shown, event);
    }

    /// The machine function of the mode: REF and REPOS in JOG, TEACH IN in MDA.
    fn select_function(&mut self, group: ModeGroupNumber, parameters: &Parameters, to_nck: &ToNck) {
        let signals = &to_nck.mode_groups[group];
        let place = Place::ModeGroup(group);
        let input = |signal: Signal, value: bool| mode_group_signal(group, signal, value);
        let state = &self.mode_groups[group];
        let wants_reference = state.mode == Mode::Jog && signals.machine_function_ref();
        let pressed = input(mode_group_to_nck::machine_function_ref, true);
        let refuses = self.refuses_reference(group, wants_reference, pressed, parameters);
        let state = &mut self.mode_groups[group];
        let function = match state.mode {
            Mode::Jog if signals.machine_function_ref() && !refuses => MachineFunction::Reference,
            Mode::Jog if signals.machine_function_repos() => MachineFunction::Repos,
            Mode::Mda if signals.machine_function_teach_in() => MachineFunction::TeachIn,
            Mode::Jog | Mode::Mda | Mode::Automatic => MachineFunction::None,
        };
        if function != state.function {
            let of_either = if function == MachineFunction::None { state.function } else { function };
            let requested = match of_either {
                MachineFunction::TeachIn => {
                    input(mode_group_to_nck::machine_function_teach_in, signals.machine_function_teach_in())
                }
                MachineFunction::Repos => {
                    input(mode_group_to_nck::machine_function_repos, signals.machine_function_repos())
                }
                MachineFunction::Reference | MachineFunction::None => {
                    input(mode_group_to_nck::machine_function_ref, signals.machine_function_ref())
                }
            };
            let within = if of_either == MachineFunction::TeachIn {
                input(mode_group_from_nck::active_mode_mdi, state.mode == Mode::Mda)
            } else {
                input(mode_group_from_nck::active_mode_jog, state.mode == Mode::Jog)
            };
            state.function = function;
            state.function_cause =
                self.log.note(place, Rule::MachineFunction, [requested, within, Input::None], EventId::NONE);
        }
    }

    /// The mode group of a unit.
    pub(in crate::sinumerik) fn mode_group(&self, unit: &Unit) -> &ModeGroup {
        &self.mode_groups[unit.mode_group]
    }

    /// Another writer wrote DBB5 of a mode group in DB11: from now on it belongs to the HMI (E-01).
    pub(in crate::sinumerik) fn strobe_written(&mut self, group: ModeGroupNumber) {
        if !self.mode_groups[group].hmi_owns_strobe {
            self.mode_groups[group].hmi_owns_strobe = true;
            self.log.note_plain(Place::ModeGroup(group), Rule::StrobeOwnedByHmi, EventId::NONE);
        }
    }
}
