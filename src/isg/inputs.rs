//! The inputs of causes and of conditions: signals of this control that are tested in a decision.

use super::channel::Channel;
use super::hli::channel_to_cnc;
use crate::image::Signal;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{BlockName, Input, Place, SignalBit};

/// A signal of an axis as an input.
pub(super) const fn axis_signal(axis: AxisNumber, signal: Signal, value: bool) -> Input {
    Input::Bit(bit_of(Place::Axis(axis), signal), value)
}

/// A signal of a channel as an input.
pub(super) const fn channel_signal(channel: ChannelNumber, signal: Signal, value: bool) -> Input {
    Input::Bit(bit_of(Place::Channel(channel), signal), value)
}

/// The lowest bit of a signal.
pub(super) const fn bit_of(place: Place, signal: Signal) -> SignalBit {
    SignalBit { place, byte: signal.byte, bit: signal.bit }
}

/// A block as an input.
pub(super) fn block(number: u32) -> Input {
    let mut name = BlockName::new();
    let _ = std::fmt::Write::write_fmt(&mut name, format_args!("N{number}"));
    Input::Block(name)
}

/// What holds the movement of a channel: feed hold, or else the override, which only the PLC can make 0.
pub(super) const fn holds(channel: &Channel) -> Input {
    if channel.inputs.feed_hold {
        channel_signal(channel.number, channel_to_cnc::feed_hold, true)
    } else {
        channel_signal(channel.number, channel_to_cnc::feed_override_enable, true)
    }
}
