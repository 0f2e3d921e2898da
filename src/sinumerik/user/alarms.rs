//! The stage: which user alarms are active, and their reactions.

use zerocopy::IntoBytes;

use crate::image::{
    ACKNOWLEDGE_USER_ALARMS, NckToNck, ToNck, UserAlarmsToNck, UserFromNck, channel_to_nck, user_alarm,
};
use crate::sinumerik::inputs::{channel_signal, nck_signal};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::sinumerik::user::state::{ActiveAlarm, FIRST_ALARM, UserReaction};
use crate::units::ChannelNumber;
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, RaisedAlarm};

/// MD14516: the alarm stays until the PLC acknowledges it, or until power off.
const WAITS_FOR_ACKNOWLEDGEMENT: u8 = 1 << 6;
const WAITS_FOR_POWER_OFF: u8 = 1 << 7;

/// DB2600.DBX1.1 and 1.2 in DB10.DBB57.
const REQUEST_BYTE: usize = 57 - NckToNck::FIRST as usize;

impl State {
    /// DB1600 and DB2600.DBB1.
    pub(in crate::sinumerik) fn watch_user_alarms(&mut self, parameters: &Parameters, to_nck: &ToNck) {
        let Some(data) = parameters.user.as_deref() else { return };
        let requests = to_nck.nck.as_bytes()[REQUEST_BYTE];
        self.user.requests = [requests >> 1 & 1 == 1, requests >> 2 & 1 == 1];
        let signals = &to_nck.user_alarms;
        if self.user.active.is_empty() && signals.active.iter().all(|byte| *byte == 0) {
            return;
        }
        self.end_user_alarms(data, signals);
        self.begin_user_alarms(signals);
        for (bit, reaction) in self.user.reactions.iter_mut().enumerate() {
            let has = |alarm: &&ActiveAlarm| data.alarms[usize::from(alarm.index)] >> bit & 1 == 1;
            *reaction = self.user.active.iter().find(has).copied();
        }
    }

    fn end_user_alarms(&mut self, data: &UserFromNck, signals: &UserAlarmsToNck) {
        let mut next = 0;
        while let Some(alarm) = self.user.active.get(next).copied() {
            let configuration = data.alarms[usize::from(alarm.index)];
            let is_acknowledged = signals.acknowledgement & 1 == 1;
            let waits_for_acknowledgement = configuration & WAITS_FOR_ACKNOWLEDGEMENT != 0;
            let stays = is_set(signals, alarm.index)
                || configuration & WAITS_FOR_POWER_OFF != 0
                || waits_for_acknowledgement && !is_acknowledged;
            if stays {
                next += 1;
                continue;
            }
            self.user.active.remove(next);
            let gone = nck_signal(user_alarm(alarm.index), false);
            let (rule, second) = if waits_for_acknowledgement {
                (Rule::UserAlarmAcknowledged, nck_signal(ACKNOWLEDGE_USER_ALARMS, true))
            } else {
                (Rule::UserAlarmEnds, Input::None)
            };
            self.user.ended = self.log.note(Place::Nck, rule, [gone, second, Input::None], alarm.cause);
            self.alarms.end(&raised(&alarm), self.user.ended);
        }
    }

    fn begin_user_alarms(&mut self, signals: &UserAlarmsToNck) {
        for index in (0_u8..).take(signals.variables.len()).filter(|index| is_set(signals, *index)) {
            if let Err(place) = self.user.active.binary_search_by_key(&index, |alarm| alarm.index) {
                let variable = i32::from_be_bytes(signals.variables[usize::from(index)]);
                let set = nck_signal(user_alarm(index), true);
                let cause = self.log.note_one(Place::Nck, Rule::UserAlarm, set, EventId::NONE);
                self.user.active.insert(place, ActiveAlarm { index, variable, cause });
            }
        }
        for alarm in &self.user.active {
            let RaisedAlarm { number, place, parameters } = raised(alarm);
            self.alarms.raise(number, place, parameters, alarm.cause);
        }
    }

    /// What disables the feed of all axes of a channel.
    #[must_use]
    pub(in crate::sinumerik) fn feed_disable(&self, channel: ChannelNumber, to_nck: &ToNck) -> Option<Input> {
        let signal = || channel_signal(channel, channel_to_nck::feed_disable, true);
        let by_signal = to_nck.channels[channel].feed_disable().then(signal);
        by_signal.or_else(|| self.user.input(UserReaction::Feed))
    }

    /// Whether the next block of a channel must not begin.
    #[must_use]
    pub(in crate::sinumerik) fn is_read_in_disabled(&self, channel: ChannelNumber, to_nck: &ToNck) -> bool {
        to_nck.channels[channel].read_in_disable() || self.user.alarm(UserReaction::ReadIn).is_some()
    }

    /// Whether NC start has no effect.
    #[must_use]
    pub(in crate::sinumerik) fn is_start_disabled(&self, channel: ChannelNumber, to_nck: &ToNck) -> bool {
        to_nck.channels[channel].nc_start_disable() || self.user.alarm(UserReaction::NcStart).is_some()
    }
}

fn is_set(signals: &UserAlarmsToNck, index: u8) -> bool {
    signals.active[usize::from(index / 8)] >> (index % 8) & 1 == 1
}

/// `%1` is the variable.
fn raised(alarm: &ActiveAlarm) -> RaisedAlarm {
    let parameters = [Parameter::Number(alarm.variable.into()), Parameter::None, Parameter::None, Parameter::None];
    RaisedAlarm { number: AlarmNumber(FIRST_ALARM + u32::from(alarm.index)), place: Place::Nck, parameters }
}
