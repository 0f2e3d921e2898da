//! What ends the turning of a spindle, or holds it until NC start.
//!
//! RESET and the end of a program stop it with MD35040 = 0, and delete S with MD22400 = 0. 2.2 (spindle reset) stops it always. Emergency stop,
//! alarms that make the channel, the mode group or the NC not ready, and alarms of the spindle itself that stop or switch to follow-up end its
//! function; it does not turn again by itself (S-03). DB21.DBX7.4 and DB11.DBX0.6 hold it until NC start; NC stop (7.3) does not concern it.

use crate::image::{ToNck, axis_to_nck, channel_to_nck, mode_group_to_nck, nck_from_nck};
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::inputs::{axis_signal, channel_signal, mode_group_signal, nck_signal};
use crate::sinumerik::operation::reset::takes_ready;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::spindle::state::Mode;
use crate::sinumerik::state::{State, Unit};
use crate::units::ChannelNumber;
use crate::variables::{EventId, Input, Place};

impl State {
    /// RESET of a channel, or the end of its program by M2 or M30.
    pub(in crate::sinumerik) fn end_spindle_functions(
        &mut self,
        channel: ChannelNumber,
        parameters: &Parameters,
        event: EventId,
    ) {
        let speed_stays = parameters.programs[channel].as_deref().is_some_and(|own| own.speed_stays);
        for number in parameters.spindles.and(parameters.channels[channel].axes).iter() {
            let runs_on = parameters.axes[number].spindle.as_deref().is_some_and(|own| own.runs_on);
            let oscillates = self.plc_oscillates(number);
            if let Some(spindle) = self.spindles[number].as_deref_mut().filter(|_| !runs_on) {
                if spindle.is_programmed() || spindle.mode != Mode::Control || oscillates {
                    spindle.cause = event;
                }
                spindle.leave_positioning(event);
                (spindle.direction, spindle.stopped, spindle.is_ended) = (0, false, true);
                if !speed_stays {
                    spindle.speed = 0.0;
                }
            }
        }
    }

    /// NC start of a channel: its spindles that NC stop axes plus spindles holds turn again.
    pub(in crate::sinumerik) fn release_spindles(
        &mut self,
        channel: ChannelNumber,
        parameters: &Parameters,
        event: EventId,
    ) {
        for number in parameters.spindles.and(parameters.channels[channel].axes).iter() {
            if let Some(spindle) = self.spindles[number].as_deref_mut()
                && spindle.stopped
            {
                (spindle.stopped, spindle.cause) = (false, event);
            }
        }
    }

    /// Ends the function of a spindle if something demands that in this cycle.
    pub(super) fn stop_spindle(&mut self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let number = unit.leader();
        let signals = &to_nck.axes[number];
        let (reset, delete) = (signals.delete_distance_to_go_spindle_reset(), signals.delete_s_value());
        let stop = self.spindle_stop(unit, parameters);
        let pressed = pressed_stop(unit, to_nck);
        let oscillates = self.plc_oscillates(number);
        let Some(spindle) = self.spindles[number].as_deref_mut() else { return };
        let reset_rises = reset && !std::mem::replace(&mut spindle.reset_was, reset);
        let delete_rises = delete && !std::mem::replace(&mut spindle.delete_was, delete);
        let positioned = spindle.mode != Mode::Control;
        let (programmed, place) = (spindle.is_programmed() || positioned, Place::Axis(number));
        let ends = if let Some((rule, input, cause)) = stop {
            Some((rule, input, cause))
        } else if reset_rises {
            let input = axis_signal(number, axis_to_nck::delete_distance_to_go_spindle_reset, true);
            Some((Rule::SpindleReset, input, EventId::NONE))
        } else {
            None
        };
        if let Some((rule, input, cause)) = ends {
            (spindle.direction, spindle.stopped, spindle.is_ended) = (0, false, true);
            if programmed || oscillates {
                spindle.cause = self.log.now(place, cause, rule, [input, Input::None, Input::None]);
            }
            spindle.leave_positioning(spindle.cause);
        } else if delete_rises {
            spindle.speed = 0.0;
            if programmed && !positioned {
                let input = axis_signal(number, axis_to_nck::delete_s_value, true);
                spindle.cause = self.log.note_one(place, Rule::SpeedDeleted, input, EventId::NONE);
            }
        } else if pressed.is_some() && programmed {
            spindle.stopped = true;
        }
    }

    /// What ends the function of a spindle: its rule, the tested input, and the event behind it.
    fn spindle_stop(&self, unit: &Unit, parameters: &Parameters) -> Option<(Rule, Input, EventId)> {
        if let Some(cause) = self.emergency_stop.active_cause() {
            let shown = nck_signal(nck_from_nck::emergency_stop_active, true);
            return Some((Rule::StoppedByEmergencyStop, shown, cause));
        }
        let place = Place::Axis(unit.leader());
        let (number, cause) = self.alarms.first_alarm(|at, alarm| {
            alarm.reaction.has(Reaction::NC_NOT_READY)
                || alarm.reaction.has(Reaction::CHANNEL_NOT_READY)
                    && self.owners.concerns_channel(parameters, at, unit.channel)
                || takes_ready(unit.mode_group, (parameters, &self.owners), at, alarm)
                || at == place && (alarm.reaction.has(Reaction::STOP) || alarm.reaction.has(Reaction::FOLLOW_UP))
        })?;
        Some((Rule::StoppedByAlarm, Input::Alarm(number.0), cause))
    }

    /// The signal that holds a spindle until NC start: the one that is pressed, else that of the channel, which is 0 again.
    pub(super) fn stop_of_spindle(unit: &Unit, to_nck: &ToNck) -> Input {
        pressed_stop(unit, to_nck)
            .unwrap_or_else(|| channel_signal(unit.channel, channel_to_nck::nc_stop_axes_plus_spindles, false))
    }
}

/// DB21.DBX7.4 or DB11.DBX0.6.
fn pressed_stop(unit: &Unit, to_nck: &ToNck) -> Option<Input> {
    if to_nck.channels[unit.channel].nc_stop_axes_plus_spindles() {
        return Some(channel_signal(unit.channel, channel_to_nck::nc_stop_axes_plus_spindles, true));
    }
    let stop = mode_group_to_nck::mode_group_stop_axes_plus_spindles;
    let is_pressed = to_nck.mode_groups[unit.mode_group].mode_group_stop_axes_plus_spindles();
    is_pressed.then(|| mode_group_signal(unit.mode_group, stop, true))
}
