//! The channels: RESET, the alarm-cancel key, NC start, and the displayed states.
//!
//! RESET of a channel is the rising edge of DB21.DBX7.7 or of DB11.DBX0.7 of its mode group. While either is 1, none of its axes
//! starts to move. RESET cancels the channel's alarms of class RESET; alarms of class mode group RESET clear when RESET is
//! pressed in all channels of the group at the same time. The alarm-cancel key concerns all channels. NC start cancels alarms, and then
//! starts the program (`program/start.rs`).

use crate::image::{ToNck, channel_to_nck, mode_group_to_nck};
use crate::nc_program::Library;
use crate::sinumerik::alarms::{Alarm, Cancel, Reaction};
use crate::sinumerik::exchange::state::Owners;
use crate::sinumerik::inputs::{channel_signal, mode_group_signal};
use crate::sinumerik::machine_data::Effect;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{ChannelNumber, ModeGroupNumber};
use crate::variables::{AlarmNumber, EventId, Input, Place};

impl Nck {
    /// RESET, the cancel key and NC start; data of the classes RESET and NEWCONF become active with a RESET.
    pub(in crate::sinumerik) fn reset_and_cancel(&mut self, to_nck: &ToNck, cancel_key: EventId) {
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        let mut last = EventId::NONE;
        for (channel, group) in parameters.existing_channels() {
            state.start(channel, group, parameters, &self.programs, to_nck);
            last = last.max(state.reset(channel, group, parameters, to_nck));
        }
        if cancel_key.is_some() {
            state.cancel(Cancel::CancelKey, None, Input::None, cancel_key, parameters);
        }
        if !last.is_some() {
            return;
        }
        for group in parameters.existing_mode_groups() {
            let mut channels = parameters.existing_channels().filter(|(_, of)| *of == group);
            if channels.all(|(channel, _)| state.channels[channel].reset) {
                let concerns = |place| state.owners.concerns_mode_group(parameters, place, group);
                state.alarms.cancel(Cancel::ModeGroupReset, last, concerns);
            }
        }
        self.release_trips();
        self.activate(Effect::Reset, last);
    }
}

impl State {
    /// RESET of a channel. Returns its event if it begins in this cycle.
    fn reset(
        &mut self,
        channel: ChannelNumber,
        group: ModeGroupNumber,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> EventId {
        let by_mode_group = to_nck.mode_groups[group].mode_group_reset();
        let pressed = to_nck.channels[channel].channel_reset() || by_mode_group;
        let rises = pressed && !self.channels[channel].reset;
        self.channels[channel].reset = pressed;
        if !rises {
            return EventId::NONE;
        }
        let input = if by_mode_group {
            mode_group_signal(group, mode_group_to_nck::mode_group_reset, true)
        } else {
            channel_signal(channel, channel_to_nck::channel_reset, true)
        };
        let place = Place::Channel(channel);
        let event = self.log.note_one(place, Rule::ResetDone, input, EventId::NONE);
        self.channels[channel].reset_cause = event;
        self.reset_program(channel, event);
        self.end_spindle_functions(channel, parameters, event);
        let concerns = |place| self.owners.concerns_channel(parameters, place, channel);
        self.alarms.cancel(Cancel::Reset, event, concerns);
        if self.programs[channel].run.is_none() {
            self.return_axes(channel, event, parameters);
        }
        for index in 0..self.groupings.len() {
            let leader = self.groupings[index].coupling.leader();
            if self.owners.of(leader).channel == channel {
                self.reset_grouping(index, event);
            }
        }
        event
    }

    /// NC start of a channel.
    fn start(
        &mut self,
        channel: ChannelNumber,
        group: ModeGroupNumber,
        parameters: &Parameters,
        library: &Library,
        to_nck: &ToNck,
    ) {
        let signals = &to_nck.channels[channel];
        let start = signals.nc_start();
        let was = std::mem::replace(&mut self.channels[channel].start_was, start);
        let rises = start && !was;
        if rises {
            let pressed = channel_signal(channel, channel_to_nck::nc_start, true);
            self.cancel(Cancel::NcStart, Some(channel), pressed, EventId::NONE, parameters);
        }
        if rises {
            self.start_program((channel, group), parameters, library, to_nck);
        }
    }

    /// The cancel key (its event), or NC start of a channel (its signal).
    fn cancel(
        &mut self,
        by: Cancel,
        channel: Option<ChannelNumber>,
        pressed: Input,
        cause: EventId,
        parameters: &Parameters,
    ) {
        let of_channel = |place, channel| self.owners.concerns_channel(parameters, place, channel);
        let concerns = |place| channel.is_none_or(|channel| of_channel(place, channel));
        if self.alarms.cancels(by, concerns) {
            let shown = channel.unwrap_or(ChannelNumber::FIRST);
            let event = self.log.note_one(Place::Channel(shown), Rule::AlarmCancelled, pressed, cause);
            self.alarms.cancel(by, event, concerns);
        }
    }

    /// The alarm that resets "mode group ready" of a group, and the event behind it. An alarm that concerns a single axis does not stop the
    /// others.
    pub(in crate::sinumerik) fn mode_group_alarm(
        &self,
        group: ModeGroupNumber,
        parameters: &Parameters,
    ) -> Option<(AlarmNumber, EventId)> {
        self.alarms.first_alarm(|place, alarm| takes_ready(group, (parameters, &self.owners), place, alarm))
    }

    /// Whether the axes that need their reference point for NC start are referenced: those with MD34110 above −1, unless MD20700
    /// is 0.
    pub(in crate::sinumerik) fn is_referenced(&self, channel: ChannelNumber, parameters: &Parameters) -> bool {
        self.summary.referenced.has_all_of(parameters.channels[channel].reference_needed)
    }

    /// Whether the axes that need their reference point allow NC start in this mode: with MD20700 = 2 it suffices in MDA that their positions
    /// are restored (71.4, 71.5).
    pub(in crate::sinumerik) fn may_start_unreferenced(
        &self,
        channel: ChannelNumber,
        is_mda: bool,
        parameters: &Parameters,
    ) -> bool {
        let own = &parameters.channels[channel];
        let suffices = is_mda && own.restored_suffices_in_mda;
        suffices && own.reference_needed.iter().all(|axis| self.axes[axis].knows_position())
    }
}

/// Whether an alarm at this place resets "mode group ready" of a group.
pub(in crate::sinumerik) fn takes_ready(
    group: ModeGroupNumber,
    (parameters, owners): (&Parameters, &Owners),
    place: Place,
    alarm: &Alarm,
) -> bool {
    let only_channel = parameters.only_channel_not_ready && alarm.reaction.has(Reaction::CHANNEL_NOT_READY);
    let not_ready = alarm.reaction.has(Reaction::MODE_GROUP_NOT_READY) && !only_channel;
    not_ready && owners.concerns_mode_group(parameters, place, group)
}
