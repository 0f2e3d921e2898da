//! A signal as a symbol, and its type in STEP 7.

use crate::image::{Address, Area, Width, Writer};

/// A signal under its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// The owner: the name of an axis, of a channel, `nck`.
    pub owner: String,
    /// The name of the signal.
    pub signal: String,
    /// The address in a data block, with its type.
    pub address: Address,
    /// The side that writes the signal.
    pub writer: Writer,
    /// The meaning.
    pub meaning: String,
}

/// The bytes of a file, and what a person should know about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SymbolFile {
    /// The content.
    pub bytes: Vec<u8>,
    /// Names that differ from those of the machine, and signals that the format cannot contain: one line each.
    pub notes: Vec<String>,
}

/// The types of STEP 7 that signals have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    Bool,
    Byte,
    Word,
    Int,
    Dword,
    Dint,
    Real,
}

impl Type {
    fn of(address: Address) -> Self {
        use crate::image::Format as Number;
        match (address.width, address.format) {
            (Width::Bit(_) | Width::Bits { .. }, _) => Self::Bool,
            (Width::Byte, _) => Self::Byte,
            (Width::Word, Some(Number::Signed)) => Self::Int,
            (Width::Word, _) => Self::Word,
            (Width::Double, Some(Number::Real)) => Self::Real,
            (Width::Double, Some(Number::Signed)) => Self::Dint,
            (Width::Double, _) => Self::Dword,
        }
    }

    /// The size in bits.
    pub(super) const fn width(self) -> u32 {
        match self {
            Self::Bool => 1,
            Self::Byte => 8,
            Self::Word | Self::Int => 16,
            Self::Dword | Self::Dint | Self::Real => 32,
        }
    }

    /// The name in STEP 7.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Bool => "BOOL",
            Self::Byte => "BYTE",
            Self::Word => "WORD",
            Self::Int => "INT",
            Self::Dword => "DWORD",
            Self::Dint => "DINT",
            Self::Real => "REAL",
        }
    }
}

impl Symbol {
    /// The name as in scenarios: `X.traversing_key_plus`.
    pub(super) fn name(&self) -> String {
        format!("{}.{}", self.owner, self.signal)
    }

    pub(super) fn kind(&self) -> Type {
        Type::of(self.address)
    }

    pub(super) fn data_block(&self) -> u16 {
        match self.address.area {
            Area::DataBlock(number) => number,
            _ => unreachable!("signals of the interface are in data blocks"),
        }
    }

    /// The bit in its byte; 0 for whole bytes.
    pub(super) const fn bit(&self) -> u8 {
        match self.address.width {
            Width::Bit(bit) => bit,
            _ => 0,
        }
    }

    /// The side that writes, and the meaning.
    pub(super) fn comment(&self) -> String {
        let writer = match self.writer {
            Writer::Plc => "PLC",
            Writer::Nck => "NCK",
            Writer::Hmi => "HMI",
        };
        format!("{writer}: {}", self.meaning)
    }

    /// The symbol itself, or one for each of its bits if it is a number inside a byte.
    pub(super) fn single_bits(&self) -> Vec<Self> {
        let Width::Bits { first, last } = self.address.width else { return vec![self.clone()] };
        let bit = |at| Self {
            signal: format!("{}_{}", self.signal, at - first),
            address: Address { width: Width::Bit(at), ..self.address },
            ..self.clone()
        };
        (first..=last).map(bit).collect()
    }
}
