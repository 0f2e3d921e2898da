//! The rows of a block: each gives a signal once, with its value and the reason for the value.
//!
//! A block is a function over [`Rows`]. Publication runs it with [`Written`], which takes the values and evaluates no cause. When
//! a bit has changed, the same function runs with [`Asked`], which takes the cause of that bit and no value.

use crate::image::Signal;
use crate::sinumerik::rules::Rule;
use crate::variables::{EventId, Input};

/// The reason for the value of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Why {
    /// An event that was recorded when the value was decided.
    Event(EventId),
    /// The value follows directly from these inputs; an event is recorded for its edge.
    Tested(Rule, [Input; 3], EventId),
}

/// Takes the rows of a block.
pub(super) trait Rows {
    /// Adjacent signals of one byte, from the first to the last, with their common value.
    fn group(&mut self, first: Signal, last: Signal, value: u8, why: impl FnOnce() -> Why);

    /// Whole bytes, from the byte of this number in the block.
    fn bytes(&mut self, first: u16, values: &[u8], why: impl FnOnce() -> Why);

    /// A signal of one bit.
    #[inline]
    fn bit(&mut self, signal: Signal, value: bool, why: impl FnOnce() -> Why) {
        self.group(signal, signal, u8::from(value), why);
    }

    /// A signal of several bits.
    #[inline]
    fn number(&mut self, signal: Signal, value: u8, why: impl FnOnce() -> Why) {
        self.group(signal, signal, value, why);
    }
}

/// The bits from the first signal to the last one.
pub(super) const fn mask(first: Signal, last: Signal) -> u8 {
    let width = last.bit + last.kind.width() - first.bit;
    (0xFF >> (8 - width)) << first.bit
}

/// Writes the values into the bytes of a block.
pub(super) struct Written<'a> {
    bytes: &'a mut [u8],
    /// Number of the first byte in its block.
    first: u16,
}

impl<'a> Written<'a> {
    #[inline]
    pub(super) fn new(bytes: &'a mut [u8], first: u16) -> Self {
        Self { bytes, first }
    }
}

impl Rows for Written<'_> {
    #[inline]
    fn group(&mut self, first: Signal, last: Signal, value: u8, _: impl FnOnce() -> Why) {
        debug_assert!(first.byte == last.byte && first.byte >= self.first, "{} to {}", first.name, last.name);
        let mask = mask(first, last);
        let byte = &mut self.bytes[usize::from(first.byte - self.first)];
        *byte = *byte & !mask | value << first.bit & mask;
    }

    fn bytes(&mut self, first: u16, values: &[u8], _: impl FnOnce() -> Why) {
        self.bytes[usize::from(first - self.first)..][..values.len()].copy_from_slice(values);
    }
}

/// Finds the reason for one bit of a block.
pub(super) struct Asked {
    byte: u16,
    bit: u8,
    why: Option<Why>,
}

impl Asked {
    pub(super) const fn new(byte: u16, bit: u8) -> Self {
        Self { byte, bit, why: None }
    }

    /// The reason given by the rows; `None` if no row has this bit.
    pub(super) const fn found(&self) -> Option<Why> {
        self.why
    }
}

impl Rows for Asked {
    fn group(&mut self, first: Signal, last: Signal, _: u8, why: impl FnOnce() -> Why) {
        if first.byte == self.byte && mask(first, last) >> self.bit & 1 == 1 {
            self.why = Some(why());
        }
    }

    fn bytes(&mut self, first: u16, values: &[u8], why: impl FnOnce() -> Why) {
        if usize::from(self.byte.wrapping_sub(first)) < values.len() {
            self.why = Some(why());
        }
    }
}
