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
mod symbol;
mod tia;

#[cfg(test)]
mod tests;

pub use symbol::{Symbol, SymbolFile};

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
