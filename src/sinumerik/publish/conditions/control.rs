//! Conditions of the signals of the NCK, the mode groups and the channels: start-up, ready, modes, states.

use crate::control::{Condition, Fact, fact};
use crate::image::{
    UserFromNck, axis_from_nck, channel_from_nck, mode_group_from_nck, mode_group_to_nck, nck_from_nck, nck_to_nck,
};
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::operation::state::{MachineFunction, Mode};
use crate::sinumerik::program::state::Run;
use crate::sinumerik::publish::conditions::look::{Look, Row};
use crate::sinumerik::user::state::UserReaction;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber};

/// DB10.
pub(super) const NCK: &[Row<()>] = &[
    Row::new(nck_from_nck::inch_measuring_system_active, |look, ()| look.inch()),
    Row::new(nck_from_nck::nc_cpu_ready, |look, ()| look.started_up("computes", look.state.run_up.is_cpu_ready())),
    Row::with(
        nck_from_nck::emergency_stop_active,
        |look, ()| look.emergency_stop(),
        |look, ()| look.no_emergency_stop(),
    ),
    Row::new(nck_from_nck::drives_in_cyclic_operation, |look, ()| {
        look.started_up("exchanges data with its drives", look.state.run_up.are_drives_cyclic())
    }),
    Row::new(nck_from_nck::drives_ready, |look, ()| look.drives_ready()),
    Row::new(nck_from_nck::nc_ready, |look, ()| look.nc_ready()),
    Row::new(nck_from_nck::nc_alarm_active, |look, ()| {
        look.no_alarm("alarm with interface signals".to_owned(), |_, alarm| {
            alarm.reaction.has(Reaction::INTERFACE_SIGNALS)
        })
        .opposite()
    }),
    Row::new(UserFromNck::SIGNALS[0], |look, ()| look.user_alarm(UserReaction::NcStart, true).into()),
    Row::new(UserFromNck::SIGNALS[1], |look, ()| look.user_alarm(UserReaction::ReadIn, true).into()),
    Row::new(UserFromNck::SIGNALS[2], |look, ()| look.user_alarm(UserReaction::Feed, true).into()),
    Row::new(UserFromNck::SIGNALS[3], |look, ()| look.user_alarm(UserReaction::EmergencyStop, true).into()),
    Row::new(UserFromNck::SIGNALS[4], |look, ()| look.user_alarm(UserReaction::PlcStop, true).into()),
];

/// DB11.
pub(super) const MODE_GROUP: &[Row<ModeGroupNumber>] = &[
    Row::with(
        mode_group_from_nck::active_mode_automatic,
        |look, group| look.mode(group, Mode::Automatic),
        |look, group| look.mode_is_left(group, Mode::Automatic),
    ),
    Row::with(
        mode_group_from_nck::active_mode_mdi,
        |look, group| look.mode(group, Mode::Mda),
        |look, group| look.mode_is_left(group, Mode::Mda),
    ),
    Row::with(
        mode_group_from_nck::active_mode_jog,
        |look, group| look.mode(group, Mode::Jog),
        |look, group| look.mode_is_left(group, Mode::Jog),
    ),
    Row::new(mode_group_from_nck::mode_group_ready, |look, owner| look.mode_group_ready(owner)),
    Row::new(mode_group_from_nck::all_channels_in_reset_state, |look, owner| look.all_channels_reset(owner)),
    Row::new(mode_group_from_nck::active_machine_function_teach_in, |look, group| {
        look.function(group, MachineFunction::TeachIn)
    }),
    Row::new(mode_group_from_nck::active_machine_function_repos, |look, group| {
        look.function(group, MachineFunction::Repos)
    }),
    Row::new(mode_group_from_nck::active_machine_function_ref, |look, group| {
        look.function(group, MachineFunction::Reference)
    }),
];

/// DB21.
pub(super) const CHANNEL: &[Row<ChannelNumber>] = &[
    Row::with(
        channel_from_nck::referencing_active,
        |look, owner| look.channel_referencing(owner),
        |look, owner| look.channel_referencing_ended(owner),
    ),
    Row::with(
        channel_from_nck::all_axes_requiring_reference_point_are_referenced,
        |look, owner| look.all_referenced(owner),
        |look, owner| look.not_all_referenced(owner),
    ),
    Row::with(
        channel_from_nck::all_axes_stationary,
        |look, owner| look.all_stand(owner),
        |look, owner| look.not_all_stand(owner),
    ),
    Row::new(channel_from_nck::channel_ready, |look, owner| look.channel_ready(owner)),
    Row::new(channel_from_nck::channel_specific_nck_alarm_active, |look, channel| {
        look.no_channel_alarm(channel, "interface signals", Reaction::INTERFACE_SIGNALS).opposite()
    }),
    Row::new(channel_from_nck::nck_alarm_with_machining_stop_active, |look, channel| {
        look.no_channel_alarm(channel, "the reaction stop", Reaction::STOP).opposite()
    }),
];

const fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Automatic => "AUTO",
        Mode::Mda => "MDA",
        Mode::Jog => "JOG",
    }
}

impl Look<'_> {
    fn inch(self) -> Condition {
        let is_inch = self.parameters.is_inch;
        let found = if is_inch { "inch" } else { "metric" };
        Fact::new("active system of units (MD10240, from power on)", found, "inch", is_inch).into()
    }

    /// A step of the start-up, which takes a fixed number of cycles.
    fn started_up(self, step: &str, holds: bool) -> Condition {
        let cycles = self.state.run_up.cycles;
        let found = if holds { "yes".to_owned() } else { format!("no, in cycle {cycles} of its start-up") };
        Fact::new(format!("the control {step}"), found, "yes", holds).into()
    }

    /// The start-up has ended; its last step waits once for all drives.
    fn run_up(self) -> Condition {
        fact("the start-up of the control has ended", self.state.run_up.is_nc_ready())
            .after(|| self.nck(nck_from_nck::drives_ready, true))
    }

    fn drives_ready(self) -> Condition {
        let missing = |axis: AxisNumber| !self.state.axes[axis].drive_ready;
        let found: Vec<_> =
            self.parameters.existing.iter().filter(|&axis| missing(axis)).map(|axis| self.axis_name(axis)).collect();
        let ready = self.state.run_up.drives_ready;
        let found = if ready || found.is_empty() { "none".to_owned() } else { found.join(", ") };
        let drives = Fact::new("drives that are not ready", found, "none", ready);
        let all = self.parameters.existing.iter().map(|axis| self.axis(axis, axis_from_nck::drive_ready, true));
        let drives = drives.after(|| Condition::All(all.collect()));
        Condition::All(vec![self.nck(nck_from_nck::drives_in_cyclic_operation, true), drives])
    }

    fn nc_ready(self) -> Condition {
        let alarm = self.no_alarm("alarm with the reaction NC not ready".to_owned(), |_, alarm| {
            alarm.reaction.has(Reaction::NC_NOT_READY)
        });
        Condition::All(vec![self.run_up(), alarm])
    }

    fn emergency_fact(self, wanted: bool) -> Fact {
        let word = |active| if active { "active" } else { "not active" };
        let active = self.state.emergency_stop.is_active();
        Fact::new("emergency stop", word(active), word(wanted), active == wanted)
    }

    fn emergency_stop(self) -> Condition {
        self.emergency_fact(true).after(|| {
            let request = self.nck(nck_to_nck::emergency_stop, true);
            match self.parameters.user {
                None => request,
                Some(_) => Condition::Any(vec![request, self.user_alarm(UserReaction::EmergencyStop, true).into()]),
            }
        })
    }

    fn no_emergency_stop(self) -> Condition {
        self.emergency_fact(false).after(|| {
            let groups = self.parameters.existing_mode_groups();
            let resets = groups.map(|group| self.mode_group(group, mode_group_to_nck::mode_group_reset, true));
            let request = self.nck(nck_to_nck::emergency_stop, false);
            let acknowledged = self.nck(nck_to_nck::acknowledge_emergency_stop, true);
            let alarm =
                self.parameters.user.as_ref().map(|_| self.user_alarm(UserReaction::EmergencyStop, false).into());
            Condition::All([request, acknowledged].into_iter().chain(alarm).chain(resets).collect())
        })
    }

    /// The mode of a group is another one: that one has been selected.
    fn mode_is_left(self, group: ModeGroupNumber, left: Mode) -> Condition {
        let mode = self.state.mode_groups[group].mode;
        let wanted = format!("not {}", mode_name(left));
        Fact::new(format!("mode of mode group {group}"), mode_name(mode), wanted, mode != left).after(|| {
            let others = [Mode::Jog, Mode::Mda, Mode::Automatic].into_iter().filter(|mode| *mode != left);
            Condition::Any(others.map(|mode| Condition::All(self.selects_mode(group, mode))).collect())
        })
    }

    fn mode(self, group: ModeGroupNumber, wanted: Mode) -> Condition {
        let mode = self.state.mode_groups[group].mode;
        Fact::new(format!("mode of mode group {group}"), mode_name(mode), mode_name(wanted), mode == wanted)
            .after(|| Condition::All(self.selects_mode(group, wanted)))
    }

    /// What selects a mode.
    fn selects_mode(self, group: ModeGroupNumber, wanted: Mode) -> Vec<Condition> {
        let asks = |signal, value| self.mode_group(group, signal, value);
        let mut all = vec![asks(mode_group_to_nck::mode_change_inhibit, false)];
        let refused = self.state.mode_groups[group].refused == Some(wanted);
        if wanted != Mode::Jog {
            all.push(self.no_program(group, |run| run.is_mda != (wanted == Mode::Mda), refused));
        }
        // JOG has priority over MDA, MDA over AUTO.
        match wanted {
            Mode::Jog => all.push(asks(mode_group_to_nck::mode_jog, true)),
            Mode::Mda => {
                all.push(asks(mode_group_to_nck::mode_mdi, true));
                all.push(asks(mode_group_to_nck::mode_jog, false));
            }
            Mode::Automatic => {
                all.push(asks(mode_group_to_nck::mode_automatic, true));
                all.push(asks(mode_group_to_nck::mode_mdi, false));
                all.push(asks(mode_group_to_nck::mode_jog, false));
            }
        }
        all
    }

    fn function(self, group: ModeGroupNumber, wanted: MachineFunction) -> Condition {
        let asks = |signal, value| self.mode_group(group, signal, value);
        Condition::All(match wanted {
            MachineFunction::TeachIn => vec![
                asks(mode_group_from_nck::active_mode_mdi, true),
                asks(mode_group_to_nck::machine_function_teach_in, true),
            ],
            // REF has priority over REPOS.
            MachineFunction::Repos => {
                let is_refused = self.state.mode_groups[group].refused_reference;
                let mut all = vec![
                    asks(mode_group_from_nck::active_mode_jog, true),
                    asks(mode_group_to_nck::machine_function_repos, true),
                ];
                all.extend((!is_refused).then(|| asks(mode_group_to_nck::machine_function_ref, false)));
                all
            }
            MachineFunction::Reference => {
                let mut all = vec![
                    asks(mode_group_from_nck::active_mode_jog, true),
                    asks(mode_group_to_nck::machine_function_ref, true),
                ];
                // What refuses it is tested while it is requested.
                let mode = &self.state.mode_groups[group];
                let is_requested = mode.mode == Mode::Jog && self.to_nck.mode_groups[group].machine_function_ref();
                let is_refused = mode.refused_reference;
                if is_refused || !is_requested {
                    all.push(self.no_program(group, |_| true, is_refused));
                }
                all
            }
            MachineFunction::None => Vec::new(),
        })
    }

    /// No program of a mode group that has not ended stands against its request (16913, 16914).
    fn no_program(self, group: ModeGroupNumber, hinders: impl Fn(&Run) -> bool, refuses: bool) -> Condition {
        let mut channels = self.parameters.existing_channels().filter(|(_, of)| *of == group);
        let hindering =
            channels.find(|(channel, _)| self.state.programs[*channel].run.as_deref().is_some_and(&hinders));
        let found = match hindering {
            Some((channel, _)) => self.channel_name(channel),
            None if refuses => "one, which ended in this cycle".to_owned(),
            None => "none".to_owned(),
        };
        let holds = found == "none";
        Fact::new(format!("program of mode group {group} that has not ended"), found, "none", holds).into()
    }

    fn mode_group_ready(self, group: ModeGroupNumber) -> Condition {
        Condition::All(vec![self.run_up(), self.no_mode_group_alarm(group)])
    }

    /// No alarm resets "mode group ready".
    pub(super) fn no_mode_group_alarm(self, group: ModeGroupNumber) -> Condition {
        self.no_alarm(format!("alarm that resets ready of mode group {group}"), |place, alarm| {
            let only_channel =
                self.parameters.only_channel_not_ready && alarm.reaction.has(Reaction::CHANNEL_NOT_READY);
            alarm.reaction.has(Reaction::MODE_GROUP_NOT_READY)
                && !only_channel
                && self.state.owners.concerns_mode_group(self.parameters, place, group)
        })
    }

    fn all_channels_reset(self, group: ModeGroupNumber) -> Condition {
        let channels = self.parameters.existing_channels().filter(|(_, of)| *of == group);
        Condition::All(
            channels.map(|(channel, _)| self.channel(channel, channel_from_nck::channel_state_reset, true)).collect(),
        )
    }

    /// The axes of a channel that are not in a set.
    fn without(self, axes: AxisSet, set: AxisSet) -> String {
        let left: Vec<_> = axes.iter().filter(|&axis| !set.contains(axis)).map(|axis| self.axis_name(axis)).collect();
        if left.is_empty() { "none".to_owned() } else { left.join(", ") }
    }

    pub(super) fn at_rest(self, channel: ChannelNumber) -> Condition {
        let axes = self.state.active_axes(channel);
        let moving = self.state.summary.in_motion.and(axes);
        let found = if moving.is_empty() {
            "none".to_owned()
        } else {
            moving.iter().map(|axis| self.axis_name(axis)).collect::<Vec<_>>().join(", ")
        };
        let what = format!("axes of {} that move, are to move or are referenced", self.channel_name(channel));
        let at_rest = Fact::new(what, found, "none", moving.is_empty()).into();
        Condition::All(vec![at_rest, self.channel(channel, channel_from_nck::referencing_active, false)])
    }

    fn all_referenced(self, channel: ChannelNumber) -> Condition {
        let needed = self.parameters.channels[channel].reference_needed;
        let what = format!("axes of {} without the reference point that they need", self.channel_name(channel));
        let referenced = self.state.summary.referenced;
        let holds = referenced.has_all_of(needed);
        Fact::new(what, self.without(needed, referenced), "none", holds).after(|| {
            let missing = needed.iter().filter(|&axis| !referenced.contains(axis));
            Condition::All(missing.map(|axis| self.reference_signal(axis)).collect())
        })
    }

    fn not_all_referenced(self, channel: ChannelNumber) -> Condition {
        let needed = self.parameters.channels[channel].reference_needed;
        let what = format!("axes of {} without the reference point that they need", self.channel_name(channel));
        let referenced = self.state.summary.referenced;
        let holds = !referenced.has_all_of(needed);
        Fact::new(what, self.without(needed, referenced), "one", holds)
            .after(|| Condition::Any(needed.iter().map(|axis| self.reference_signal(axis).opposite()).collect()))
    }

    fn not_all_stand(self, channel: ChannelNumber) -> Condition {
        let axes = self.state.stationary_axes(channel, self.parameters);
        let standing = self.state.summary.standing;
        let what = format!("axes of {} that are not stationary", self.channel_name(channel));
        let holds = !standing.has_all_of(axes);
        Fact::new(what, self.without(axes, standing), "one", holds)
            // A spindle in speed control does not count (S-02).
            .after(|| {
                let axes = axes.iter().filter(|axis| self.state.spindles[*axis].is_none());
                Condition::Any(axes.map(|axis| self.stationary_no_more(axis)).collect())
            })
    }

    fn all_stand(self, channel: ChannelNumber) -> Condition {
        let axes = self.state.stationary_axes(channel, self.parameters);
        let standing = self.state.summary.standing;
        let what = format!("axes of {} that are not stationary", self.channel_name(channel));
        let holds = standing.has_all_of(axes);
        Fact::new(what, self.without(axes, standing), "none", holds).after(|| {
            let moving = axes.iter().filter(|&axis| !standing.contains(axis));
            Condition::All(moving.map(|axis| self.stationary(axis)).collect())
        })
    }

    pub(super) fn no_channel_alarm(self, channel: ChannelNumber, words: &str, reaction: Reaction) -> Condition {
        self.no_alarm(format!("alarm of {} with {words}", self.channel_name(channel)), |place, alarm| {
            alarm.reaction.has(reaction) && self.state.owners.concerns_channel(self.parameters, place, channel)
        })
    }

    fn channel_ready(self, channel: ChannelNumber) -> Condition {
        let alarm = self.no_channel_alarm(channel, "the reaction channel not ready", Reaction::CHANNEL_NOT_READY);
        Condition::All(vec![self.run_up(), alarm])
    }
}
