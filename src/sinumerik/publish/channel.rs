//! The signals of a channel: DB21 to DB30.

use std::cmp::Reverse;

use crate::image::channel_from_nck;
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::axis::travel::command_signal;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::publish::rows::{Rows, Why};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{EventId, Input};

impl State {
    /// "At least one axis is being traversed in JOG", or is being referenced; also while feed stop, an override of 0 % or a missing enable
    /// holds the movement, and in the complete section 3 of a grouping while 10655 is pending (O-31).
    pub(super) fn is_channel_active(&self, channel: ChannelNumber, parameters: &Parameters) -> bool {
        !self.summary.in_motion.and(parameters.channels[channel].axes).is_empty()
    }

    /// DB21 to DB30 of one channel.
    pub(super) fn show_channel(&self, channel: ChannelNumber, parameters: &Parameters, rows: &mut impl Rows) {
        let active = self.is_channel_active(channel, parameters);
        let motion = || self.activity(|of| of == channel, active, parameters);
        // The first alarm with the reaction of a group signal; without one, the event that cancelled the last alarm.
        let alarm = |reaction| self.channel_alarm(channel, reaction, parameters);
        let or_cancelled = |alarm: Option<EventId>| alarm.unwrap_or(self.channels[channel].cancel_cause);
        rows.bit(channel_from_nck::referencing_active, self.channels[channel].is_referencing(), || {
            Why::Event(self.channels[channel].referencing.cause)
        });
        // Without a program its state is "aborted", as after RESET.
        rows.bit(channel_from_nck::program_state_aborted, true, || Why::Event(EventId::NONE));
        rows.bit(channel_from_nck::channel_state_active, active, motion);
        rows.bit(channel_from_nck::channel_state_reset, !active, motion);
        let referenced = self.is_referenced(channel, parameters);
        rows.bit(channel_from_nck::all_axes_requiring_reference_point_are_referenced, referenced, || {
            Why::Event(self.reference_event(channel, parameters))
        });
        let standing = self.summary.standing.has_all_of(parameters.channels[channel].axes);
        rows.bit(channel_from_nck::all_axes_stationary, standing, || {
            Why::Event(self.motion_event(|of| of == channel, parameters))
        });
        let not_ready = alarm(Reaction::CHANNEL_NOT_READY);
        let ready = self.run_up.is_nc_ready() && not_ready.is_none();
        rows.bit(channel_from_nck::channel_ready, ready, || Why::Event(or_cancelled(not_ready).max(self.run_up.cause)));
        let pending = alarm(Reaction::INTERFACE_SIGNALS);
        rows.bit(channel_from_nck::channel_specific_nck_alarm_active, pending.is_some(), || {
            Why::Event(or_cancelled(pending))
        });
        let stopping = alarm(Reaction::STOP);
        rows.bit(channel_from_nck::nck_alarm_with_machining_stop_active, stopping.is_some(), || {
            Why::Event(or_cancelled(stopping))
        });
    }

    /// The event that started or ended the activity of channels.
    pub(super) fn activity(
        &self,
        channels: impl Fn(ChannelNumber) -> bool + Copy,
        active: bool,
        parameters: &Parameters,
    ) -> Why {
        let of_channels = parameters.existing().filter(|(_, axis)| channels(axis.channel)).map(|(number, _)| number);
        let counts = |axis: &AxisNumber| !active || self.summary.in_motion.contains(*axis);
        // The axis that started or stopped last; the first of axes that move together.
        let order = |axis: &AxisNumber| {
            let commanded = active && self.axes[*axis].travel.is_pending();
            (commanded, self.axes[*axis].causes.motion, Reverse(*axis))
        };
        let Some(number) = of_channels.filter(counts).max_by_key(order) else { return Why::Event(EventId::NONE) };
        let axis = &self.axes[number];
        let section_3 = if active && self.synchronising().contains(number) {
            self.groupings.iter().find(|grouping| grouping.coupling.members().any(|member| member == number))
        } else {
            None
        };
        let parent = match section_3 {
            Some(grouping) => grouping.cause,
            None if active && axis.approach.is_running() => axis.approach.cause(),
            None => axis.causes.motion,
        };
        if self.log.is_of_this_cycle(axis.causes.motion) {
            return Why::Event(axis.causes.motion);
        }
        if section_3.is_some() && self.log.is_of_this_cycle(parent) {
            return Why::Event(parent);
        }
        // An axis without signals shows nothing.
        let audible = |input| if parameters.axes[number].silent { Input::None } else { input };
        if active {
            let shown = if axis.travel.is_pending() { axis.travel.shown(number, parameters) } else { Input::None };
            return Why::Tested(Rule::ChannelActive, [audible(shown), Input::None, Input::None], parent);
        }
        if !parent.is_some() {
            return Why::Event(EventId::NONE);
        }
        let [plus, minus] = [1, -1].map(|sign| audible(axis_signal(number, command_signal(sign), false)));
        Why::Tested(Rule::ChannelAtRest, [plus, minus, Input::None], parent)
    }

    /// The latest movement of any axis of these channels.
    pub(super) fn motion_event(&self, channels: impl Fn(ChannelNumber) -> bool, parameters: &Parameters) -> EventId {
        let axes = parameters.existing().filter(|(_, axis)| channels(axis.channel));
        axes.map(|(number, _)| self.axes[number].causes.motion).max().unwrap_or(EventId::NONE)
    }

    fn reference_event(&self, channel: ChannelNumber, parameters: &Parameters) -> EventId {
        let axes = parameters.existing().filter(|(_, axis)| axis.channel == channel);
        let causes = axes.map(|(number, _)| self.axes[number].causes.reference);
        causes.map(|[first, second]| first.max(second)).max().unwrap_or(EventId::NONE)
    }
}
