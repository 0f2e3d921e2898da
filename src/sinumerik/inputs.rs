//! What causes name: signals of this control as inputs of a decision.

use crate::units::AxisNumber;
use crate::variables::{Input, Place, SignalBit};

/// A signal of an axis as an input.
#[must_use]
pub(super) const fn axis_bit(axis: AxisNumber, byte: u16, bit: u8, value: bool) -> Input {
    Input::Bit(SignalBit { place: Place::Axis(axis), byte, bit }, value)
}
