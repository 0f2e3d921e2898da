//! Traverse request (64.4, 64.5) and traverse command (64.6, 64.7), the event behind each of their edges, and the reason that stops a
//! channel.
//!
//! Called by all stages that move an axis. A movement may have begun in an earlier cycle. When the command is reset or set again
//! later, an event of this cycle gives the reason, and refers to the beginning of the movement as its cause.

use crate::image::{Signal, axis_from_nck, axis_to_nck, mode_group_from_nck};
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::inputs::{axis_signal, mode_group_signal, nck_signal};
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Place, Quantity};

/// The reason that stops every movement of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sinumerik) enum Stop {
    /// Emergency stop.
    Emergency(EventId),
    /// RESET is pressed.
    Reset(EventId),
    /// An alarm.
    Alarm(AlarmNumber, EventId),
}

impl Stop {
    /// The event that started it.
    pub(in crate::sinumerik) const fn cause(self) -> EventId {
        match self {
            Self::Emergency(cause) | Self::Reset(cause) | Self::Alarm(_, cause) => cause,
        }
    }

    /// The rule of the stop, and the tested input.
    pub(in crate::sinumerik) fn tested(self) -> (Rule, Input) {
        use crate::image::nck_from_nck::emergency_stop_active;
        match self {
            Self::Emergency(_) => (Rule::StoppedByEmergencyStop, nck_signal(emergency_stop_active, true)),
            Self::Reset(_) => (Rule::StoppedByReset, Input::None),
            Self::Alarm(number, _) => (Rule::StoppedByAlarm, Input::Alarm(number.0)),
        }
    }
}

/// The traverse command of a direction, −1 or +1.
#[must_use]
pub(in crate::sinumerik) const fn command_signal(direction: i8) -> Signal {
    if direction > 0 { axis_from_nck::traverse_command_plus } else { axis_from_nck::traverse_command_minus }
}

impl State {
    /// The reason that stops every movement of a channel: RESET, or an alarm with NC stop, NC not ready or mode group not ready.
    pub(in crate::sinumerik) fn stop(&self, channel: ChannelNumber, parameters: &Parameters) -> Option<Stop> {
        if let Some(cause) = self.emergency_stop.active_cause() {
            return Some(Stop::Emergency(cause));
        }
        if self.channels[channel].reset {
            return Some(Stop::Reset(self.channels[channel].reset_cause));
        }
        let stops = self.alarms.first_alarm(|place, alarm| {
            alarm.reaction.has(Reaction::STOP) && parameters.concerns_channel(place, channel)
                || alarm.reaction.has(Reaction::NC_NOT_READY)
        });
        let group = parameters.mode_group(channel);
        let not_ready = || self.mode_group_alarm(group, parameters);
        stops.or_else(not_ready).map(|(number, cause)| Stop::Alarm(number, cause))
    }

    /// Sets request (64.4, 64.5) and command (64.6, 64.7), with the event behind a change.
    pub(in crate::sinumerik) fn traverse(&mut self, number: AxisNumber, request: i8, command: i8, cause: EventId) {
        let axis = &mut self.axes[number];
        if (axis.traverse_request, axis.traverse_command) != (request, command) {
            axis.traverse_request = request;
            axis.traverse_command = command;
            axis.causes.motion = cause;
        }
    }

    /// The same for an axis whose keys have no function because of the mode.
    pub(in crate::sinumerik) fn traverse_without_jog(&mut self, unit: &Unit) {
        let number = unit.leader();
        let axis = &self.axes[number];
        if (axis.traverse_request, axis.traverse_command) == (0, 0) {
            return;
        }
        let (group, of) = (self.mode_group(unit), unit.mode_group);
        let inputs = [
            mode_group_signal(of, mode_group_from_nck::active_mode_jog, group.mode == Mode::Jog),
            mode_group_signal(of, mode_group_from_nck::active_machine_function_ref, group.is_referencing()),
            Input::None,
        ];
        let cause = group.cause();
        let cause = self.log.now(Place::Axis(number), cause, Rule::KeysWithoutJog, inputs);
        self.traverse(number, 0, 0, cause);
    }

    /// The same for an automatic movement, an approach or a synchronising motion. `begun` is its latest event, `begins` the
    /// condition tested when motion begins later than that, `target` its target.
    pub(in crate::sinumerik) fn traverse_on(
        &mut self,
        number: AxisNumber,
        (request, command): (i8, i8),
        begun: EventId,
        begins: (Rule, Input),
        target: Position,
    ) {
        let axis = &self.axes[number];
        if (axis.traverse_request, axis.traverse_command) == (request, command) {
            return;
        }
        let (rule, input) = if command == 0 && axis.feed_held {
            (Rule::HeldByFeedStop, axis.feed_holder)
        } else if command == 0 && axis.feed_factor <= 0.0 {
            (Rule::HeldByOverride, axis_signal(number, axis_to_nck::override_active, true))
        } else if command == 0 {
            (Rule::TargetReached, Input::Length(Quantity::Position, number, target))
        } else if axis.traverse_request == 0 {
            begins
        } else if axis.feed_holder == Input::None {
            (Rule::OverrideReleased, Input::None)
        } else {
            (Rule::FeedReleased, axis.feed_holder)
        };
        let cause = self.log.now(Place::Axis(number), begun, rule, [input, Input::None, Input::None]);
        self.traverse(number, request, command, cause);
    }
}
