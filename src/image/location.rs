//! Where something lies in memory, once a name or an address has been resolved.

use serde::{Deserialize, Serialize};

/// A piece of the memory; each interface part has one writer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Part {
    /// What the PLC writes to the NCK, and plain bytes of the interface blocks.
    ToNck,
    /// What the NCK writes.
    FromNck,
    /// What the HMI writes.
    Hmi,
    /// Inputs, I.
    Inputs,
    /// Outputs, Q.
    Outputs,
    /// Flags, M.
    Flags,
    /// Timers, T: two bytes each.
    Timers,
    /// Counters, C: two bytes each.
    Counters,
    /// An own data block of the PLC program, by its number.
    Block(u16),
}

/// How bits make a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Format {
    /// A whole number from 0.
    Unsigned,
    /// A whole number in two's complement: INT or DINT.
    Signed,
    /// A floating point number of 32 bits.
    Real,
}

/// Some bits in memory and how to read them as a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Location {
    /// The piece of memory.
    pub part: Part,
    /// The first byte in the piece.
    pub offset: u32,
    /// The lowest bit in that byte; 0 for whole bytes.
    pub bit: u8,
    /// How many bits: 1 to 8 inside one byte, or 16, or 32.
    pub width: u8,
    /// How the bits make a number.
    pub format: Format,
}

impl Location {
    /// How many bytes it touches.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        (self.width as u32).div_ceil(8)
    }

    /// The largest raw value that fits.
    #[must_use]
    pub const fn mask(self) -> u64 {
        (1 << self.width) - 1
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
