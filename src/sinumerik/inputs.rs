//! The inputs of causes and of conditions: signals of this control that are tested in a decision.

use crate::control::Condition;
use crate::image::Signal;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};
use crate::variables::{Input, Place, SignalBit};

/// A signal of an axis as an input.
#[must_use]
pub(super) const fn axis_signal(axis: AxisNumber, signal: Signal, value: bool) -> Input {
    Input::Bit(bit_of(Place::Axis(axis), signal), value)
}

/// A signal of several bits of an axis as an input.
#[must_use]
pub(super) const fn axis_number(axis: AxisNumber, signal: Signal, value: u8) -> Input {
    Input::Number(bit_of(Place::Axis(axis), signal), value)
}

/// A signal of a channel as an input.
#[must_use]
pub(super) const fn channel_signal(channel: ChannelNumber, signal: Signal, value: bool) -> Input {
    Input::Bit(bit_of(Place::Channel(channel), signal), value)
}

/// A signal of several bits of a channel as an input.
#[must_use]
pub(super) const fn channel_number(channel: ChannelNumber, signal: Signal, value: u8) -> Input {
    Input::Number(bit_of(Place::Channel(channel), signal), value)
}

/// A signal of a mode group as an input.
#[must_use]
pub(super) const fn mode_group_signal(group: ModeGroupNumber, signal: Signal, value: bool) -> Input {
    Input::Bit(bit_of(Place::ModeGroup(group), signal), value)
}

/// A signal of the NCK as an input.
#[must_use]
pub(super) const fn nck_signal(signal: Signal, value: bool) -> Input {
    Input::Bit(bit_of(Place::Nck, signal), value)
}

/// A signal of one bit as a condition.
#[must_use]
pub(super) const fn required(place: Place, signal: Signal, wanted: bool) -> Condition {
    Condition::Signal(bit_of(place, signal), wanted)
}

/// The lowest bit of a signal.
const fn bit_of(place: Place, signal: Signal) -> SignalBit {
    SignalBit { place, byte: signal.byte, bit: signal.bit }
}
