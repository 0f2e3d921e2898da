//! One signal of the interface as data: its name, position and writer.

/// The writer of a signal. Every program can read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Writer {
    /// The PLC program: requests and enables to the NCK.
    Plc,
    /// The NCK: states and messages to the PLC.
    Nck,
    /// The operator panel: selections and strobes, written by HMI and basic program.
    Hmi,
}

/// The owner of a block of signals. An interface has some of these kinds, and a number of blocks of each.
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

/// The size and type of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// One bit.
    Bit,
    /// A binary number with this number of bits inside one byte.
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
    /// The number of bits.
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

    /// Whether it is a number of several bytes.
    pub(super) const fn is_number(self) -> bool {
        self.width() > 8
    }
}

/// A signal of the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// The name of the manual, in full, in lower case with underscores.
    pub name: &'static str,
    /// The kind of block that contains it.
    pub block: Block,
    /// The byte in its block, counted from the start of the block.
    pub byte: u16,
    /// The lowest bit in the byte.
    pub bit: u8,
    /// The size and type.
    pub kind: Kind,
    /// The writer.
    pub writer: Writer,
    /// The meaning, with its 1 and 0.
    pub doc: &'static str,
}

/// The ends of the names of a control unit's signals. The beginning that they share is the name of the unit, which stands for all of them:
/// written, it is `enable` = 1 and the command; read, it is the state.
#[derive(Clone, Copy, Debug)]
pub struct UnitElements {
    /// 1 = the command acts.
    pub enable: &'static str,
    /// The value that the PLC gives.
    pub command: &'static str,
    /// The value that acts.
    pub state: &'static str,
}
