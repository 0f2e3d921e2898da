//! Symbols of a machine as files of other tools, so that a panel, a flow or a PLC project begins with the names of the signals.
//!
//! | format | read by |
//! |---|---|
//! | [`node_red`](Format::NodeRed) | the import of node-red-contrib-s7 |
//! | [`python_snap7`](Format::PythonSnap7) | `load_csv` of python-snap7 3 |
//! | [`tia_xlsx`](Format::TiaXlsx) | the import of HMI tags in TIA Portal, WinCC Comfort and Advanced |
//! | [`step7_sdf`](Format::Step7Sdf), [`step7_asc`](Format::Step7Asc) | the symbol editor of STEP 7 V5: the data blocks |
//! | [`step7_awl`](Format::Step7Awl) | an AWL source of STEP 7 V5: the signals, since a bit of a data block cannot be a symbol |
//!
//! Several adjacent bits that are one number have no notation in these tools; each of them is a symbol: `X.controller_parameter_set_0` is the
//! lowest bit.

mod plain;
mod short;
mod step7;
mod tia;

#[cfg(test)]
mod tests;

use crate::image::{Address, Area, Width, Writer};

/// A format of another tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Lines `address;name`.
    NodeRed,
    /// CSV with the header `tag,db,offset,type,bit`.
    PythonSnap7,
    /// A workbook with the sheet `Hmi Tags`.
    TiaXlsx,
    /// Four quoted fields a line: symbol, address, type, comment.
    Step7Sdf,
    /// The same fields in columns of fixed width.
    Step7Asc,
    /// Data blocks with the signals as components.
    Step7Awl,
}

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
enum Type {
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
    const fn width(self) -> u32 {
        match self {
            Self::Bool => 1,
            Self::Byte => 8,
            Self::Word | Self::Int => 16,
            Self::Dword | Self::Dint | Self::Real => 32,
        }
    }

    /// The name in STEP 7.
    const fn name(self) -> &'static str {
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
    fn name(&self) -> String {
        format!("{}.{}", self.owner, self.signal)
    }

    fn kind(&self) -> Type {
        Type::of(self.address)
    }

    fn data_block(&self) -> u16 {
        match self.address.area {
            Area::DataBlock(number) => number,
            _ => unreachable!("signals of the interface are in data blocks"),
        }
    }

    /// The bit in its byte; 0 for whole bytes.
    const fn bit(&self) -> u8 {
        match self.address.width {
            Width::Bit(bit) => bit,
            _ => 0,
        }
    }

    /// The side that writes, and the meaning.
    fn comment(&self) -> String {
        let writer = match self.writer {
            Writer::Plc => "PLC",
            Writer::Nck => "NCK",
            Writer::Hmi => "HMI",
        };
        format!("{writer}: {}", self.meaning)
    }

    /// The symbol itself, or one for each of its bits if it is a number inside a byte.
    fn single_bits(&self) -> Vec<Self> {
        let Width::Bits { first, last } = self.address.width else { return vec![self.clone()] };
        let bit = |at| Self {
            signal: format!("{}_{}", self.signal, at - first),
            address: Address { width: Width::Bit(at), ..self.address },
            ..self.clone()
        };
        (first..=last).map(bit).collect()
    }
}

/// The file of a format for these symbols. `lengths` are the lengths of the data blocks in bytes, in the order of their numbers.
#[must_use]
pub fn symbol_file(format: Format, symbols: &[Symbol], lengths: &[(u16, u32)]) -> SymbolFile {
    let symbols: Vec<_> = symbols.iter().flat_map(Symbol::single_bits).collect();
    match format {
        Format::NodeRed => plain::node_red(&symbols),
        Format::PythonSnap7 => plain::python_snap7(&symbols),
        Format::TiaXlsx => tia::workbook(&symbols),
        Format::Step7Sdf => step7::quoted_table(&step7::blocks(&symbols, lengths)),
        Format::Step7Asc => step7::column_table(&step7::blocks(&symbols, lengths)),
        Format::Step7Awl => step7::source(&step7::blocks(&symbols, lengths)),
    }
}
