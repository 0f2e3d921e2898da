//! The event behind each signal of the NCK, asked for when a bit has changed.
//!
//! States have their events; what follows from a value at the moment (exact stop, standstill, sums over axes and alarms)
//! is noted when its edge is seen.

use crate::sinumerik::alarms::{self, Alarm, Cancel, Reaction};
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::gantry::state::Grouping;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, Position};
use crate::variables::{AlarmNumber, Event, EventId, Input, Place, Quantity};

impl Nck {
    /// The event behind the present value of a bit of the NCK.
    pub fn cause(&mut self, place: Place, byte: u16, bit: u8) -> EventId {
        let cause = match place {
            Place::Nck => self.state.nck_cause(byte, bit),
            Place::ModeGroup(group) => self.state.mode_group_cause(group, byte, bit, &self.parameters),
            Place::Channel(channel) => self.state.channel_cause(channel, byte, bit, &self.parameters),
            Place::Axis(axis) => self.axis_cause(axis, byte, bit),
        };
        // What nothing has changed yet is as power on left it.
        if cause.is_some() { cause } else { self.state.power_on_cause }
    }

    /// The event behind a pending alarm.
    #[must_use]
    pub fn alarm_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        let pending = &self.state.alarms;
        pending
            .iter()
            .find(|(alarm, _)| alarm.number == number && alarm.place == place)
            .map_or(EventId::NONE, |(_, cause)| cause)
    }

    /// The event that took an alarm away: of one that goes by itself, what its place did last; else RESET, a key or power on.
    #[must_use]
    pub fn cleared_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        let state = &*self.state;
        let cancel = Alarm::find(number).map(|alarm| alarm.cancel);
        let cause = match (number, place) {
            (alarms::EMERGENCY_STOP, _) => state.emergency_stop.cause,
            (alarms::GANTRY_WARNING_LIMIT, Place::Axis(axis)) => state.monitored(axis, false),
            (alarms::GANTRY_WAITING | alarms::GANTRY_SYNCHRONISING, Place::Axis(axis)) => {
                let reset = state.channels[self.parameters.axes[axis].channel].reset_cause;
                state.grouping_of(axis).map_or(EventId::NONE, |grouping| grouping.cause.max(reset))
            }
            (alarms::WAITING_FOR_DRIVE, Place::Axis(_)) => state.run_up.cause,
            (_, Place::Axis(axis)) if cancel == Some(Cancel::ByItself) => state.axes[axis].causes.motion,
            (_, Place::Axis(axis)) => state.channels[self.parameters.axes[axis].channel].cancel_cause,
            (_, Place::Channel(channel)) => state.channels[channel].cancel_cause,
            (_, Place::Nck | Place::ModeGroup(_)) => state.cancel_event(),
        };
        if cause.is_some() { cause } else { state.power_on_cause }
    }

    /// The number of the latest event.
    #[must_use]
    pub fn last_event(&self) -> EventId {
        self.state.log.events.last()
    }

    /// The events after this one.
    pub fn events_since(&self, id: EventId) -> impl Iterator<Item = &Event> {
        self.state.log.events.since(id)
    }

    fn axis_cause(&mut self, number: AxisNumber, byte: u16, bit: u8) -> EventId {
        let parameters = &self.parameters.axes[number];
        let group = self.parameters.mode_group(parameters.channel);
        let state = &mut *self.state;
        let axis: &Axis = &state.axes[number];
        let set = axis.active_set(parameters);
        let windows = (set.exact_stop_coarse, set.exact_stop_fine, parameters.standstill_velocity);
        let causes = axis.causes;
        match (byte, bit) {
            (60, 2 | 3) => axis.monitor.encoders[usize::from(bit - 2)].frequency_cause,
            (60, 4 | 5) => causes.reference[usize::from(bit - 4)],
            (60, 6 | 7) if axis.is_in_motion() => causes.motion,
            (60, 6 | 7) => {
                let (datum, window) = if bit == 6 { (36000, windows.0) } else { (36010, windows.1) };
                let measured = Input::Length(Quantity::Deviation, number, axis.deviation());
                let limit = Input::Datum(datum, Some(number), window.user());
                state.log.note(Place::Axis(number), Rule::ExactStop, [measured, limit, Input::None], causes.motion)
            }
            (61, 1) => {
                let alarm = state.alarms.with_reaction(Reaction::INTERFACE_SIGNALS, Some(Place::Axis(number)));
                alarm.unwrap_or(state.channels[parameters.channel].cancel_cause)
            }
            (61, 2) => {
                let alarm = state.alarms.with_reaction(Reaction::INTERFACE_SIGNALS, Some(Place::Axis(number)));
                alarm.unwrap_or_else(|| match axis.measuring_system {
                    None => causes.measuring_system,
                    Some(_) if !axis.drive_ready => state.run_up.cause.max(axis.monitor.drive_cause),
                    Some(_) => state
                        .run_up
                        .cause
                        .max(causes.measuring_system)
                        .max(state.channels[parameters.channel].cancel_cause),
                })
            }
            (61, 3 | 5 | 6 | 7) => causes.enabling,
            (61, 4) => {
                #[expect(clippy::cast_possible_truncation, reason = "a velocity for display; the cast saturates")]
                let velocity = Position::new(axis.velocity.abs() as i64);
                let measured = Input::Length(Quantity::Velocity, number, velocity);
                let limit = Input::Datum(36060, Some(number), windows.2 * 60.0 / Position::PER_USER_UNIT);
                state.log.note(Place::Axis(number), Rule::Standstill, [measured, limit, Input::None], causes.motion)
            }
            (64, 0..=2) | (67, 0) => axis.jogging.handwheel_cause.max(state.mode_groups[group].cause()),
            (64, _) => causes.motion,
            (65, _) => axis.jogging.function_cause.max(state.mode_groups[group].cause()),
            (69, 0..=2) => causes.parameter_set,
            (92, 1) => axis.signals.fast_stop_cause,
            (93, 0..=4) => causes.drive_data_set,
            (93, 5) => state.run_up.cause.max(axis.monitor.drive_cause),
            (93, 7) => causes.drive,
            (101, 2 | 3) => state.monitored(number, bit == 2),
            (101, 4 | 5) => state.grouping_of(number).map_or(EventId::NONE, |grouping| grouping.cause),
            (101, 6 | 7) => state.definition_cause,
            (102, 5 | 6) => causes.measuring_system,
            _ => EventId::NONE,
        }
    }
}

impl State {
    fn nck_cause(&mut self, byte: u16, bit: u8) -> EventId {
        match (byte, bit) {
            (68..=70, _) => self.log.note_plain(Place::Nck, Rule::HandwheelTurned, EventId::NONE),
            (106, 1) => self.emergency_stop.cause,
            (109, _) => self.any_alarm_event(Reaction::INTERFACE_SIGNALS),
            (108, 7) if self.run_up.is_nc_ready() && !self.is_nc_ready() => {
                self.any_alarm_event(Reaction::NC_NOT_READY)
            }
            _ => self.run_up.cause,
        }
    }

    fn mode_group_cause(&mut self, group: ModeGroupNumber, byte: u16, bit: u8, parameters: &Parameters) -> EventId {
        match (byte, bit) {
            (6, 0..=2) => self.mode_groups[group].mode_cause,
            (6, 3) => {
                let alarm = self.mode_group_not_ready(group, parameters);
                alarm.unwrap_or_else(|| self.cancel_event()).max(self.run_up.cause)
            }
            (6, 7) => self.motion_event(|channel| parameters.mode_group(channel) == group, parameters),
            (8, _) => self.group_functions[group].cause.max(self.mode_groups[group].cause()),
            (5 | 7, _) => self.mode_groups[group].function_cause,
            _ => EventId::NONE,
        }
    }

    fn channel_cause(&mut self, channel: ChannelNumber, byte: u16, bit: u8, parameters: &Parameters) -> EventId {
        // The first alarm with the reaction that a signal sums up; once there is none any more, what cancelled the last.
        let alarm = |reaction| {
            let first = self.channel_alarm(channel, reaction, parameters);
            first.unwrap_or(self.channels[channel].cancel_cause)
        };
        match (byte, bit) {
            (33, 0) => self.channels[channel].referencing.cause,
            (35, 5..=7) | (36, 3) => self.motion_event(|of| of == channel, parameters),
            (36, 2) => self.reference_event(channel, parameters),
            (36, 5) => alarm(Reaction::CHANNEL_NOT_READY).max(self.run_up.cause),
            (36, 6) => alarm(Reaction::INTERFACE_SIGNALS),
            (36, 7) => alarm(Reaction::STOP),
            _ => EventId::NONE,
        }
    }

    fn any_alarm_event(&self, reaction: Reaction) -> EventId {
        self.alarms.with_reaction(reaction, None).unwrap_or_else(|| self.cancel_event())
    }

    /// What took alarms away last, in any channel.
    fn cancel_event(&self) -> EventId {
        self.channels.iter().map(|(_, channel)| channel.cancel_cause).max().unwrap_or(EventId::NONE)
    }

    /// The latest movement of any axis of these channels.
    fn motion_event(&self, channels: impl Fn(ChannelNumber) -> bool, parameters: &Parameters) -> EventId {
        let axes = parameters.existing().filter(|(_, axis)| channels(axis.channel));
        axes.map(|(number, _)| self.axes[number].causes.motion).max().unwrap_or(EventId::NONE)
    }

    fn reference_event(&self, channel: ChannelNumber, parameters: &Parameters) -> EventId {
        let axes = parameters.existing().filter(|(_, axis)| axis.channel == channel);
        let causes = axes.map(|(number, _)| self.axes[number].causes.reference);
        causes.map(|[first, second]| first.max(second)).max().unwrap_or(EventId::NONE)
    }

    fn grouping_of(&self, axis: AxisNumber) -> Option<&Grouping> {
        self.groupings.iter().find(|grouping| grouping.coupling.leader() == axis)
    }

    fn monitored(&self, axis: AxisNumber, trip: bool) -> EventId {
        let mut all = self.groupings.iter().flat_map(Grouping::monitored);
        let found = all.find(|monitored| monitored.axis == axis).map(|monitored| monitored.causes);
        found.map_or(EventId::NONE, |causes| if trip { causes.trip } else { causes.warning })
    }
}
