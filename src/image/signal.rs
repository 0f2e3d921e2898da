//! One row of the interface as data: what a signal is called, where it lies and who writes it.

use super::places::{DB11_STRIDE, place};
use super::{Format, Location};

/// Who writes a signal; everybody may read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Writer {
    /// The PLC program: requests and enables to the NCK.
    Plc,
    /// The NCK: states and messages to the PLC.
    Nck,
    /// The operator panel: selections and strobes, written by HMI and basic program.
    Hmi,
}

/// The kinds of interface block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Block {
    /// The NCK as a whole, DB10.
    Nck,
    /// A mode group; both live in DB11, the second 20 bytes above the first.
    ModeGroup,
    /// A channel, DB21 to DB30.
    Channel,
    /// A machine axis or spindle, DB31 to DB61.
    Axis,
}

impl Block {
    /// How many blocks of this kind there are.
    #[must_use]
    pub const fn count(self) -> u8 {
        match self {
            Self::Nck => 1,
            Self::ModeGroup => 2,
            Self::Channel => 10,
            Self::Axis => 31,
        }
    }

    /// The data block of number `number` (from one) on the 840D sl.
    #[must_use]
    pub const fn data_block(self, number: u8) -> u16 {
        match self {
            Self::Nck => 10,
            Self::ModeGroup => 11,
            Self::Channel => 20 + number as u16,
            Self::Axis => 30 + number as u16,
        }
    }
}

/// What a signal is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// One bit.
    Bit,
    /// A binary number of this many bits inside one byte.
    Bits(u8),
    /// A whole byte.
    Byte,
    /// Two bytes, big-endian.
    Word,
    /// Four bytes, big-endian.
    Double,
    /// A floating point number of four bytes, big-endian.
    Real,
}

impl Kind {
    /// How many bits it takes.
    #[must_use]
    pub const fn width(self) -> u8 {
        match self {
            Self::Bit => 1,
            Self::Bits(width) => width,
            Self::Byte => 8,
            Self::Word => 16,
            Self::Double | Self::Real => 32,
        }
    }

    /// Whether it spans bytes.
    pub(super) const fn is_number(self) -> bool {
        self.width() > 8
    }
}

/// A signal of the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// The name of the manual, in full, in lower case with underscores.
    pub name: &'static str,
    /// The kind of block it lies in.
    pub block: Block,
    /// The byte in its block; in a mode group, the byte in the group's 20 bytes.
    pub byte: u16,
    /// The lowest bit in the byte.
    pub bit: u8,
    /// What it is made of.
    pub kind: Kind,
    /// Who writes it.
    pub writer: Writer,
    /// What it means, with its 1 and 0.
    pub doc: &'static str,
}

impl Signal {
    /// Where the signal lies for block number `number` of its kind, from one; `None` if there is no such block.
    #[must_use]
    pub fn location(&self, number: u8) -> Option<Location> {
        if number == 0 || number > self.block.count() {
            return None;
        }
        let byte = self.data_block_byte(number);
        let run = place(self.block, number, byte)?;
        let format = if self.kind == Kind::Real { Format::Real } else { Format::Unsigned };
        let (bit, width) = (self.bit, self.kind.width());
        Some(Location { part: run.part, offset: run.offset, bit, width, format })
    }

    /// The byte in the data block of the 840D sl for block number `number`.
    #[must_use]
    pub const fn data_block_byte(&self, number: u8) -> u16 {
        match self.block {
            Block::ModeGroup => self.byte + DB11_STRIDE * (number as u16 - 1),
            Block::Nck | Block::Channel | Block::Axis => self.byte,
        }
    }
}
