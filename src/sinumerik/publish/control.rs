//! The signals of the control as a whole and of its mode groups: DB10 and DB11.

use crate::image::{mode_group_from_nck, mode_group_hmi, nck_from_nck};
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::jog::state::{Function, Handwheel};
use crate::sinumerik::operation::reset::takes_ready;
use crate::sinumerik::operation::state::{MachineFunction, Mode};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::publish::rows::{Rows, Why};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::ModeGroupNumber;
use crate::variables::{EventId, Input};

impl State {
    /// DB10.
    pub(super) fn show_nck(&self, parameters: &Parameters, rows: &mut impl Rows) {
        let run_up = || Why::Event(self.run_up.cause);
        let [first, second, third] = &self.handwheels;
        // A counter that no turn has changed was reset by power on.
        let turned = |handwheel: &Handwheel| match handwheel.cause {
            EventId::NONE => Why::Event(EventId::NONE),
            turn => Why::Tested(Rule::HandwheelTurned, [Input::None; 3], turn),
        };
        rows.number(nck_from_nck::handwheel_1_moved, first.counter, || turned(first));
        rows.number(nck_from_nck::handwheel_2_moved, second.counter, || turned(second));
        rows.number(nck_from_nck::handwheel_3_moved, third.counter, || turned(third));
        rows.bit(nck_from_nck::inch_measuring_system_active, parameters.is_inch, || {
            let scaling = Input::Datum(10240, None, f64::from(u8::from(!parameters.is_inch)));
            Why::Tested(Rule::SystemOfUnits, [scaling, Input::None, Input::None], EventId::NONE)
        });
        rows.bit(nck_from_nck::nc_cpu_ready, self.run_up.is_cpu_ready(), run_up);
        rows.bit(nck_from_nck::emergency_stop_active, self.emergency_stop.is_active(), || {
            Why::Event(self.emergency_stop.cause)
        });
        rows.bit(nck_from_nck::drives_in_cyclic_operation, self.run_up.are_drives_cyclic(), run_up);
        rows.bit(nck_from_nck::drives_ready, self.run_up.are_drives_ready(), || Why::Event(self.run_up.drives_cause));
        rows.bit(nck_from_nck::nc_ready, self.is_nc_ready(), || {
            let alarm = || self.why_alarm(|_, alarm| alarm.reaction.has(Reaction::NC_NOT_READY));
            self.why_ready(self.is_nc_ready(), alarm)
        });
        let alarm = self.alarms.with_reaction(Reaction::INTERFACE_SIGNALS, None);
        rows.bit(nck_from_nck::nc_alarm_active, alarm.is_some(), || {
            self.why_alarm(|_, alarm| alarm.reaction.has(Reaction::INTERFACE_SIGNALS))
        });
    }

    /// The cause of a ready signal: the end of start-up, or the alarms that reset it.
    pub(super) fn why_ready(&self, ready: bool, alarm: impl Fn() -> Why) -> Why {
        if ready && let Some(started) = self.of_this_cycle([self.run_up.cause]) { started } else { alarm() }
    }

    /// DB11 of one mode group.
    pub(super) fn show_mode_group(&self, number: ModeGroupNumber, parameters: &Parameters, rows: &mut impl Rows) {
        let (group, jog) = (&self.mode_groups[number], &self.group_functions[number]);
        let (mode, function) = (|| Why::Event(group.mode_cause), || Why::Event(group.function_cause));
        rows.bit(mode_group_from_nck::active_mode_automatic, group.mode == Mode::Automatic, mode);
        rows.bit(mode_group_from_nck::active_mode_mdi, group.mode == Mode::Mda, mode);
        rows.bit(mode_group_from_nck::active_mode_jog, group.mode == Mode::Jog, mode);
        let not_ready = self.mode_group_alarm(number, parameters);
        let ready = self.run_up.is_nc_ready() && not_ready.is_none();
        rows.bit(mode_group_from_nck::mode_group_ready, ready, || {
            let alarm = || self.why_alarm(|place, alarm| takes_ready(number, (parameters, &self.owners), place, alarm));
            self.why_ready(ready, alarm)
        });
        let mut channels = parameters.existing_channels().filter(|(_, group)| *group == number);
        let reset = channels.all(|(channel, _)| self.is_channel_reset(channel));
        rows.bit(mode_group_from_nck::all_channels_in_reset_state, reset, || {
            let mut own = parameters.existing_channels().filter(|(_, group)| *group == number);
            let by_program = own.find_map(|(channel, _)| self.of_this_cycle([self.programs[channel].cause]));
            by_program.unwrap_or_else(|| {
                self.activity(|channel| parameters.mode_group(channel) == number, !reset, parameters)
            })
        });
        let teach_in = group.function == MachineFunction::TeachIn;
        rows.bit(mode_group_from_nck::active_machine_function_teach_in, teach_in, function);
        let repos = group.function == MachineFunction::Repos;
        rows.bit(mode_group_from_nck::active_machine_function_repos, repos, function);
        rows.bit(mode_group_from_nck::active_machine_function_ref, group.is_referencing(), function);
        rows.group(
            mode_group_from_nck::active_machine_function_increment_1,
            mode_group_from_nck::active_machine_function_continuous,
            jog.function.map_or(0, Function::bits),
            || Why::Event(jog.cause.max(group.cause())),
        );
    }

    /// The values mirrored to the bytes of the HMI in DB11, for one mode group.
    pub(super) fn show_selection(&self, number: ModeGroupNumber, rows: &mut impl Rows) {
        let group = &self.mode_groups[number];
        rows.bit(mode_group_hmi::ref_selected, group.is_referencing(), || Why::Event(group.function_cause));
    }
}
