//! What conditions are computed from, and parts of many conditions.

use crate::control::{Condition, Fact, Question};
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

/// The conditions for 1, and those for 0 if they are not the opposite.
pub(super) struct Row<Owner: 'static> {
    pub(super) signal: Signal,
    pub(super) set: fn(Look<'_>, Owner) -> Condition,
    pub(super) reset: Option<fn(Look<'_>, Owner) -> Condition>,
}

impl<Owner> Row<Owner> {
    /// A signal that is 0 exactly if these conditions for 1 do not hold.
    pub(super) const fn new(signal: Signal, set: fn(Look<'_>, Owner) -> Condition) -> Self {
        Self { signal, set, reset: None }
    }

    /// A signal that is reset by other conditions than those that set it.
    pub(super) const fn with(
        signal: Signal,
        set: fn(Look<'_>, Owner) -> Condition,
        reset: fn(Look<'_>, Owner) -> Condition,
    ) -> Self {
        Self { signal, set, reset: Some(reset) }
    }
}

/// The row of a signal, for the value that is wanted.
pub(super) fn find<Owner>(
    rows: &[Row<Owner>],
    look: Look<'_>,
    owner: Owner,
    question: &Question<'_>,
) -> Option<Condition> {
    let is_meant = |row: &&Row<Owner>| (row.signal.byte, row.signal.bit) == (question.byte, question.bit);
    let row = rows.iter().find(is_meant)?;
    Some(match (question.wanted, row.reset) {
        (true, _) => (row.set)(look, owner),
        (false, Some(reset)) => reset(look, owner),
        (false, None) => (row.set)(look, owner).opposite(),
    })
}

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

pub(super) const fn yes(holds: bool) -> &'static str {
    if holds { "yes" } else { "no" }
}

/// A fact that is true or false.
pub(super) fn fact(what: impl Into<String>, holds: bool) -> Fact {
    Fact::new(what, yes(holds), "yes", holds)
}
