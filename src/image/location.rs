//! Locations in memory, the result of resolving a name or an address.

use serde::{Deserialize, Serialize};

/// A part of the memory. Each part of the interface has one writer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Part {
    /// The signals that the PLC writes to the NCK, and the plain bytes of the interface blocks.
    ToNck,
    /// The signals that the NCK writes.
    FromNck,
    /// The signals that the HMI writes.
    Hmi,
    /// Inputs (I).
    Inputs,
    /// Outputs (Q).
    Outputs,
    /// Flags (M).
    Flags,
    /// Timers (T), two bytes each.
    Timers,
    /// Counters (C), two bytes each.
    Counters,
    /// A data block of the PLC program, by its number.
    Block(u16),
}

/// The number format of bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Format {
    /// A whole number without sign.
    Unsigned,
    /// A whole number in two's complement: INT or DINT.
    Signed,
    /// A floating point number of 32 bits.
    Real,
}

/// A group of bits in memory, with their number format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Location {
    /// The part of the memory.
    pub part: Part,
    /// The first byte in the part.
    pub offset: u32,
    /// The lowest bit in that byte; 0 for whole bytes.
    pub bit: u8,
    /// The number of bits: 1 to 8 inside one byte, or 16, or 32.
    pub width: u8,
    /// The number format.
    pub format: Format,
}

impl Location {
    /// Whether it is 1 to 8 bits inside one byte, or 16 or 32 bits.
    #[must_use]
    pub const fn is_well_formed(self) -> bool {
        match self.width {
            1..=8 => self.bit <= 8 - self.width,
            16 | 32 => self.bit == 0,
            _ => false,
        }
    }

    /// The number of bytes that it uses.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        (self.width as u32).div_ceil(8)
    }

    /// The largest raw value that fits.
    #[must_use]
    pub const fn mask(self) -> u64 {
        (1 << self.width) - 1
    }

    /// The number that raw bits are in its number format.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "the width is checked: the number has at most 32 bits")]
    pub fn number(self, raw: u64) -> f64 {
        match self.format {
            Format::Unsigned => raw as f64,
            Format::Signed => {
                let unused = 64 - u32::from(self.width);
                ((raw << unused).cast_signed() >> unused) as f64
            }
            Format::Real => f64::from(f32::from_bits(raw as u32)),
        }
    }

    /// Whether two locations share a bit.
    #[must_use]
    pub fn overlaps(self, other: Self) -> bool {
        let span = |l: Self| {
            let first = u64::from(l.offset) * 8 + u64::from(l.bit);
            (first, first + u64::from(l.width))
        };
        let ((a, a_end), (b, b_end)) = (span(self), span(other));
        self.part == other.part && a < b_end && b < a_end
    }
}
