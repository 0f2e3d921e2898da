//! Traverse request (64.4, 64.5) and traverse command (64.6, 64.7), the event behind each of their edges, and the reason that stops a
//! channel. `travel.rs` defines request and command.
//!
//! Called by all stages that move an axis. A movement may have begun in an earlier cycle. When something holds it or it goes on
//! later, an event of this cycle gives the reason, and refers to the beginning of the movement as its cause.

use crate::image::{AxisToNck, axis_to_nck, mode_group_from_nck};
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::inputs::{axis_number, axis_signal, mode_group_signal, nck_signal};
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
            alarm.reaction.has(Reaction::STOP) && self.owners.concerns_channel(parameters, place, channel)
                || alarm.reaction.has(Reaction::NC_NOT_READY)
        });
        let group = parameters.mode_group(channel);
        let not_ready = || self.mode_group_alarm(group, parameters);
        stops.or_else(not_ready).map(|(number, cause)| Stop::Alarm(number, cause))
    }

    /// Sets request (64.4, 64.5) and command (64.6, 64.7), with the event behind a change.
    pub(in crate::sinumerik) fn travel(&mut self, number: AxisNumber, travel: Travel, cause: EventId) {
        let axis = &mut self.axes[number];
        if axis.travel != travel {
            axis.travel = travel;
            axis.causes.motion = cause;
        }
    }

    /// Ends the travel of an axis whose keys do not jog it, because of the mode or of REF.
    pub(in crate::sinumerik) fn rest_without_jog(&mut self, unit: &Unit, parameters: &Parameters, signals: &AxisToNck) {
        let number = unit.leader();
        if self.axes[number].travel == Travel::None {
            return;
        }
        let (group, of) = (self.mode_group(unit), unit.mode_group);
        let (cause, rule, inputs) = if let Some(stop) = self.stop(unit.channel, parameters) {
            let (rule, input) = stop.tested();
            (stop.cause(), rule, [input, Input::None, Input::None])
        } else if group.is_referencing() && self.axes[number].travel.is_waiting() {
            // The request for an approach has ended before the approach began.
            (self.axes[number].causes.motion, Rule::KeyReleased, keys(number, signals))
        } else {
            let inputs = [
                mode_group_signal(of, mode_group_from_nck::active_mode_jog, group.mode == Mode::Jog),
                mode_group_signal(of, mode_group_from_nck::active_machine_function_ref, group.is_referencing()),
                Input::None,
            ];
            (group.cause(), Rule::KeysWithoutJog, inputs)
        };
        let cause = self.log.now(Place::Axis(number), cause, rule, inputs);
        self.travel(number, Travel::None, cause);
    }

    /// The travel of an automatic movement, an approach or a synchronising motion. `begun` is its latest event, `begins` the
    /// condition tested when motion begins later than that, `reached` the rule with which it ends at its target.
    pub(in crate::sinumerik) fn travel_on(
        &mut self,
        number: AxisNumber,
        travel: Travel,
        begun: EventId,
        begins: (Rule, Input),
        (reached, target): (Rule, Position),
    ) {
        let axis = &self.axes[number];
        let before = axis.travel;
        if before == travel {
            return;
        }
        let (rule, input) = match travel {
            Travel::None | Travel::Blocked(_) | Travel::LedMoving(_) | Travel::LedWaiting(_) => {
                (reached, Input::Length(Quantity::Target, number, target))
            }
            Travel::Moving(_) | Travel::Waiting(_) if before.request() != travel.request() => begins,
            Travel::Moving(_) => axis.released(number),
            Travel::Waiting(_) => axis.holder(number),
        };
        let cause = self.log.now(Place::Axis(number), begun, rule, [input, Input::None, Input::None]);
        self.travel(number, travel, cause);
    }
}

impl Axis {
    /// Whether feed stop, feed disable or an override of 0 % holds its movement.
    #[must_use]
    pub(in crate::sinumerik) fn is_held(&self) -> bool {
        self.feed_held || self.feed_factor <= 0.0
    }

    /// The rule and the signal that hold it.
    pub(in crate::sinumerik) fn holder(&self, number: AxisNumber) -> (Rule, Input) {
        if self.feed_held { (Rule::HeldByFeedStop, self.feed_holder) } else { self.zero_override(number) }
    }

    /// The rule by which the effective override is 0 %, and the override. The zero setting acts with either value of 1.7 (O-21).
    pub(in crate::sinumerik) fn zero_override(&self, number: AxisNumber) -> (Rule, Input) {
        let rule = if self.override_is_active { Rule::HeldByOverride } else { Rule::HeldByZeroSetting };
        (rule, self.override_input(number))
    }

    /// The axial override as an input.
    pub(in crate::sinumerik) fn override_input(&self, number: AxisNumber) -> Input {
        axis_number(number, axis_to_nck::feed_override, self.feed_override)
    }

    /// The rule and the signal that no longer hold it.
    fn released(&self, number: AxisNumber) -> (Rule, Input) {
        if self.feed_holder == Input::None {
            (Rule::OverrideReleased, self.override_input(number))
        } else {
            (Rule::FeedReleased, self.feed_holder)
        }
    }
}

/// Both traversing keys as inputs.
#[must_use]
pub(in crate::sinumerik) fn keys(number: AxisNumber, signals: &AxisToNck) -> [Input; 3] {
    [
        axis_signal(number, axis_to_nck::traversing_key_plus, signals.traversing_key_plus()),
        axis_signal(number, axis_to_nck::traversing_key_minus, signals.traversing_key_minus()),
        Input::None,
    ]
}
