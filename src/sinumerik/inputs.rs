//! The inputs of causes: signals of this control that were tested in a decision.

use crate::image::Signal;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};
use crate::variables::{Input, Place, SignalBit};

/// A signal of an axis as an input.
#[must_use]
pub(super) const fn axis_signal(axis: AxisNumber, signal: Signal, value: bool) -> Input {
    signal_of(Place::Axis(axis), signal, 0, value)
}

/// A bit of a multi-bit signal of an axis; `index` counts from its lowest bit.
#[must_use]
pub(super) const fn axis_signal_bit(axis: AxisNumber, signal: Signal, index: u8, value: bool) -> Input {
    signal_of(Place::Axis(axis), signal, index, value)
}

/// A signal of a channel as an input.
#[must_use]
pub(super) const fn channel_signal(channel: ChannelNumber, signal: Signal, value: bool) -> Input {
    signal_of(Place::Channel(channel), signal, 0, value)
}

/// A signal of a mode group as an input.
#[must_use]
pub(super) const fn mode_group_signal(group: ModeGroupNumber, signal: Signal, value: bool) -> Input {
    signal_of(Place::ModeGroup(group), signal, 0, value)
}

/// A signal of the NCK as an input.
#[must_use]
pub(super) const fn nck_signal(signal: Signal, value: bool) -> Input {
    signal_of(Place::Nck, signal, 0, value)
}

const fn signal_of(place: Place, signal: Signal, index: u8, value: bool) -> Input {
    Input::Bit(SignalBit { place, byte: signal.byte, bit: signal.bit + index }, value)
}
