//! One printable item of a trace, with its address, its symbol and its value.

use crate::image::{Format, Interface, Location, Memory, Names, Signal};
use crate::variables::{SignalBit, place_name};

/// An item that has its own row when it changes.
#[derive(Clone, Debug)]
pub(super) struct Printable {
    pub(super) location: Location,
    pub(super) symbol: Option<String>,
    pub(super) address: String,
    /// The order of rows within a cycle.
    pub(super) order: Order,
}

impl Printable {
    /// The symbol with the address, or the address alone.
    pub(super) fn called(&self) -> String {
        match &self.symbol {
            Some(symbol) => format!("{symbol} ({})", self.address),
            None => self.address.clone(),
        }
    }
}

/// Order of addresses: inputs, outputs, flags, timers, counters, data blocks; then number, byte, bit.
pub(super) type Order = (u8, u32, u32, u32);

/// The bits of the byte at `offset` that belong to this location.
pub(super) fn mask_in_byte(location: Location, offset: u32) -> u8 {
    if !(location.offset..location.offset + location.bytes()).contains(&offset) {
        return 0;
    }
    if location.width >= 8 { 0xFF } else { (0xFF >> (8 - location.width)) << location.bit }
}

pub(super) fn printable(names: &Names, location: Location) -> Printable {
    let address = names.address(location).to_string();
    Printable { location, symbol: names.symbol(location), order: order(&address), address }
}

/// The order of an address, from its text: the letters of its area, then its numbers.
pub(super) fn order(address: &str) -> Order {
    let mut numbers = address
        .split(|c: char| !c.is_ascii_digit())
        .filter(|digits| !digits.is_empty())
        .map(|digits| digits.parse().unwrap_or(u32::MAX));
    let mut next = || numbers.next().unwrap_or(0);
    match address.as_bytes() {
        [b'D', b'B', ..] => (5, next(), next(), next()),
        [first, ..] => {
            let area = b"IQMTC".iter().position(|letter| letter == first).unwrap_or(5);
            (u8::try_from(area).unwrap_or(5), 0, next(), next())
        }
        [] => (u8::MAX, 0, 0, 0),
    }
}

/// Whether an address is a single bit: `DB31.DBX4.7`, `M0.3`.
pub(super) fn is_bit(address: &str) -> bool {
    address.rsplit_once('.').is_some_and(|(_, bit)| bit.len() == 1 && bit.as_bytes()[0].is_ascii_digit())
}

/// The signal of the catalogue that begins at a bit of a block.
pub(super) fn signal_at(bit: SignalBit, interface: &'static Interface) -> Option<&'static Signal> {
    let (block, _) = bit.place.block();
    interface.signals().find(|signal| signal.block == block && signal.byte == bit.byte && signal.bit == bit.bit)
}

/// The name of a signal in a cause: `X.traversing_key_plus`.
pub(super) fn signal_name(bit: SignalBit, names: &Names) -> String {
    let owner = place_name(bit.place, names);
    match signal_at(bit, names.interface()) {
        Some(signal) => format!("{owner}.{}", signal.name),
        None => format!("{owner} byte {} bit {}", bit.byte, bit.bit),
    }
}

/// The value at a location in a memory.
pub(super) fn shown(memory: &Memory, location: Location) -> Shown {
    Shown::of(location, memory.read(location))
}

/// A value in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shown {
    /// A bit.
    Bit(bool),
    /// A number without sign.
    Unsigned(u64),
    /// A number with sign, or a REAL.
    Number(f64),
}

impl Shown {
    /// The value of raw bits in the format of a location.
    #[must_use]
    pub fn of(location: Location, raw: u64) -> Self {
        if location.width == 1 {
            return Self::Bit(raw != 0);
        }
        match location.format {
            Format::Unsigned => Self::Unsigned(raw),
            Format::Signed | Format::Real => Self::Number(location.number(raw)),
        }
    }
}

impl std::fmt::Display for Shown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Bit(bit) => write!(f, "{}", u8::from(*bit)),
            Self::Unsigned(number) => write!(f, "{number}"),
            // A REAL has 32 bits, so the shortest text of its 32 bits is used.
            #[expect(clippy::cast_possible_truncation, reason = "the value has 32 bits")]
            Self::Number(number) if number.fract() != 0.0 => write!(f, "{}", *number as f32),
            Self::Number(number) => write!(f, "{number}"),
        }
    }
}
