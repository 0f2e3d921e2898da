//! Plain lists: a line for each signal.

use super::symbol::{Symbol, SymbolFile, Type};

/// `DB31,X4.7;X.traversing_key_plus`: address and name, as node-red-contrib-s7 reads them.
pub(super) fn node_red(symbols: &[Symbol]) -> SymbolFile {
    let line = |symbol: &Symbol| {
        let byte = symbol.address.byte;
        let place = match symbol.kind() {
            Type::Bool => format!("X{byte}.{}", symbol.bit()),
            Type::Byte => format!("B{byte}"),
            Type::Word => format!("W{byte}"),
            Type::Int => format!("I{byte}"),
            Type::Dword => format!("DW{byte}"),
            Type::Dint => format!("DI{byte}"),
            Type::Real => format!("R{byte}"),
        };
        format!("DB{},{place};{}\n", symbol.data_block(), symbol.name())
    };
    SymbolFile { bytes: symbols.iter().map(line).collect::<String>().into_bytes(), notes: Vec::new() }
}

/// `X.traversing_key_plus,31,4,BOOL,7`: the columns of `load_csv` of python-snap7.
pub(super) fn python_snap7(symbols: &[Symbol]) -> SymbolFile {
    let mut text = "tag,db,offset,type,bit\n".to_owned();
    for symbol in symbols {
        // Names of axes are words of letters, digits, and underscores: no field needs quotes.
        let (name, block, byte) = (symbol.name(), symbol.data_block(), symbol.address.byte);
        text += &format!("{name},{block},{byte},{},{}\n", symbol.kind().name(), symbol.bit());
    }
    SymbolFile { bytes: text.into_bytes(), notes: Vec::new() }
}
