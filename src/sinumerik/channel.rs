//! Channel 1: RESET, the alarm-cancel key, and the states that it shows.
//!
//! RESET is the rising edge of DB21.DBX7.7 or DB11.DBX0.7; while either is 1 nothing starts to move. With one channel in
//! the mode group, a channel RESET is a RESET in all its channels.

use serde::{Deserialize, Serialize};

use super::alarms::{Cancel, Reaction};
use super::reference_axes::ChannelReferencing;
use super::rules::Rule;
use super::{Control, State};
use crate::image::ToNck;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};
use crate::variables::{EventId, Input, Place, SignalBit};

use super::machine_data::Effect;

/// The state of the channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Channel {
    /// RESET is pressed.
    pub reset: bool,
    /// The latest RESET.
    pub reset_cause: EventId,
    /// What took alarms away last: RESET, the cancel key or NC start.
    pub cancel_cause: EventId,
    /// Channel-specific referencing.
    pub referencing: ChannelReferencing,
}

impl Channel {
    /// 33.0.
    #[must_use]
    pub(super) const fn is_referencing(&self) -> bool {
        self.referencing.is_active()
    }

    /// Channel-specific referencing started this axis.
    #[must_use]
    pub(super) const fn started(&self, axis: AxisNumber) -> bool {
        self.referencing.started(axis)
    }
}

impl Control {
    /// RESET and the cancel key; data of the classes RESET and NEWCONF become active.
    pub(super) fn reset_and_cancel(&mut self, to_nck: &ToNck, cancel_key: bool) {
        let by_channel = to_nck.channels[ChannelNumber::FIRST].channel_reset();
        let by_mode_group = to_nck.mode_groups[ModeGroupNumber::FIRST].mode_group_reset();
        let pressed = by_channel || by_mode_group;
        let rises = pressed && !self.state.channel.reset;
        self.state.channel.reset = pressed;
        if to_nck.channels[ChannelNumber::FIRST].nc_start() {
            self.state.cancel(Cancel::NcStart);
        } else if cancel_key {
            self.state.cancel(Cancel::CancelKey);
        }
        if !rises {
            return;
        }
        let bit = if by_mode_group {
            SignalBit { place: Place::ModeGroup(ModeGroupNumber::FIRST), byte: 0, bit: 7 }
        } else {
            SignalBit { place: Place::Channel(ChannelNumber::FIRST), byte: 7, bit: 7 }
        };
        let channel = Place::Channel(ChannelNumber::FIRST);
        let event = self.state.log.note_one(channel, Rule::ResetDone, Input::Bit(bit, true), EventId::NONE);
        self.state.channel.reset_cause = event;
        self.state.channel.cancel_cause = event;
        self.state.alarms.cancel(Cancel::ModeGroupReset);
        self.activate(Effect::Reset);
        for index in 0..self.state.groupings.len() {
            self.state.reset_grouping(index, event);
        }
    }
}

impl State {
    /// The cancel key or NC start.
    fn cancel(&mut self, by: Cancel) {
        if self.alarms.cancel(by) {
            let channel = Place::Channel(ChannelNumber::FIRST);
            self.channel.cancel_cause = self.log.note_plain(channel, Rule::AlarmCancelled, EventId::NONE);
        }
    }

    /// What stops every movement: RESET, or an alarm with the reaction NC stop or NC not ready.
    pub(super) fn stop_cause(&self) -> Option<EventId> {
        if let Some(cause) = self.emergency_stop.active_cause() {
            return Some(cause);
        }
        if self.channel.reset {
            return Some(self.channel.reset_cause);
        }
        if self.alarms.is_empty() {
            return None;
        }
        self.alarms
            .with_reaction(Reaction::STOP, None)
            .or_else(|| self.alarms.with_reaction(Reaction::NC_NOT_READY, None))
    }
}
