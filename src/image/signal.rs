//! One row of the interface as data: what a signal is called, where it lies and who writes it.

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

/// What a block of signals belongs to. An interface has some of these kinds, and says how many blocks of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Block {
    /// The control as a whole.
    Nck,
    /// A mode group.
    ModeGroup,
    /// A channel.
    Channel,
    /// A machine axis or spindle.
    Axis,
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
    /// The byte in its block, counted from the block's own start.
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
