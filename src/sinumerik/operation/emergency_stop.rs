//! Emergency stop with its handshake (DB10.DBX56.1, 56.2, 106.1; E-06 names the bits).
//!
//! Called before RESET in the control's part of a cycle. 56.1 = 1 starts it: alarm 3000 (NC not ready, mode group not ready),
//! 106.1 = 1, all axes brake on the ramp of MD36610, are switched off after MD36620 at the latest, and follow up. It ends when
//! 56.1 is 0 and both acknowledge 56.2 and mode group RESET (DB11.DBX0.7, of every mode group that has channels) are 1. Neither
//! alone ends it. A user alarm of an 828D with the reaction emergency stop acts as 56.1.

use crate::image::{ToNck, mode_group_to_nck, nck_to_nck};
use crate::sinumerik::alarms::Cancel;
use crate::sinumerik::inputs::{mode_group_signal, nck_signal};
use crate::sinumerik::operation::state::EmergencyStop;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::sinumerik::user::state::UserReaction;
use crate::variables::{EventId, Input, Place};

impl State {
    /// One cycle of the handshake.
    pub(in crate::sinumerik) fn watch_emergency_stop(&mut self, parameters: &Parameters, to_nck: &ToNck) {
        let by_alarm = self.user.input(UserReaction::EmergencyStop);
        let requested = to_nck.nck.emergency_stop() || by_alarm.is_some();
        let acknowledged = to_nck.nck.acknowledge_emergency_stop();
        let reset = parameters.existing_mode_groups().all(|group| to_nck.mode_groups[group].mode_group_reset());
        if requested && !self.emergency_stop.active {
            let signal = nck_signal(nck_to_nck::emergency_stop, true);
            let (input, parent) = match self.user.reactions[UserReaction::EmergencyStop as usize] {
                Some(alarm) if !to_nck.nck.emergency_stop() => (by_alarm.unwrap_or(signal), alarm.cause),
                Some(_) | None => (signal, EventId::NONE),
            };
            let cause = self.log.note_one(Place::Nck, Rule::EmergencyStop, input, parent);
            self.emergency_stop = EmergencyStop { active: true, cause };
        } else if !requested && acknowledged && reset && self.emergency_stop.active {
            let pressed = |group| mode_group_signal(group, mode_group_to_nck::mode_group_reset, true);
            // An event names one mode group; without RESET of the other groups the emergency stop would not have ended.
            let group = parameters.existing_mode_groups().next().map_or(Input::None, pressed);
            let inputs = [
                nck_signal(nck_to_nck::emergency_stop, false),
                nck_signal(nck_to_nck::acknowledge_emergency_stop, true),
                group,
            ];
            let cause = self.log.note(Place::Nck, Rule::EmergencyStopAcknowledged, inputs, self.emergency_stop.cause);
            self.emergency_stop = EmergencyStop { active: false, cause };
            self.alarms.cancel(Cancel::ModeGroupReset, cause, |_| true);
        }
    }
}
