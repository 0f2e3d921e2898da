//! What conditions are computed from, and parts of many conditions.

use crate::control::{self, Condition, Looks, fact};
use crate::image::{Names, Signal};
use crate::isg::channel::Channel;
use crate::isg::inputs::bit_of;
use crate::isg::state::State;
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{Place, axis_name, six_decimals};

/// What conditions are computed from.
#[derive(Clone, Copy)]
pub(super) struct Look<'a> {
    pub(super) state: &'a State,
    pub(super) names: &'a Names,
}

/// The conditions of this control.
pub(super) struct Conditions;

impl Looks for Conditions {
    type At<'a> = Look<'a>;
}

/// The conditions of a signal.
pub(super) type Row<Owner> = control::Row<Conditions, Owner>;

impl<'a> Look<'a> {
    pub(super) fn axis(self, axis: AxisNumber) -> String {
        axis_name(axis, self.names)
    }

    pub(super) fn rests(self, axis: AxisNumber) -> Condition {
        fact(format!("the setpoint of {} rests", self.axis(axis)), self.state.axes[axis].setpoint.is_at_rest()).into()
    }

    /// The channel whose reset acts on an axis.
    pub(super) fn channel_of(self, axis: AxisNumber) -> Option<&'a Channel> {
        let mut channels = self.state.channels.iter().enumerate();
        channels.find(|(index, _)| self.state.is_of_channel(*index, axis)).map(|(_, channel)| channel)
    }
}

/// A signal of an axis.
pub(super) fn of_axis(axis: AxisNumber, signal: Signal, wanted: bool) -> Condition {
    Condition::Signal(bit_of(Place::Axis(axis), signal), wanted)
}

/// A signal of a channel.
pub(super) fn of_channel(channel: ChannelNumber, signal: Signal, wanted: bool) -> Condition {
    Condition::Signal(bit_of(Place::Channel(channel), signal), wanted)
}

/// A length in user units.
pub(super) fn length(position: Position) -> String {
    six_decimals(position.user())
}
