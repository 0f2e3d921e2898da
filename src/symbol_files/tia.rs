//! The workbook of HMI tags of TIA Portal: a sheet `Hmi Tags` with 33 columns of which a signal decides seven.

use rust_xlsxwriter::{Workbook, XlsxError};

use super::short::Names;
use super::symbol::{Symbol, SymbolFile, Type};

/// The columns, and the value of those that are the same for all signals.
const COLUMNS: [(&str, &str); 33] = [
    ("Name", ""),
    ("Path", "OpenNCK"),
    ("Connection", "HMI_Connection_1"),
    ("PLC tag", "<No Value>"),
    ("DataType", ""),
    ("Length", ""),
    ("Coding", ""),
    ("Access Method", "Absolute access"),
    ("Address", ""),
    ("Indirect addressing", "False"),
    ("Index tag", "<No Value>"),
    ("Start value", "<No Value>"),
    ("ID tag", "0"),
    ("Display name [en-US]", "<No Value>"),
    ("Comment [en-US]", ""),
    ("Acquisition mode", "Cyclic in operation"),
    ("Acquisition cycle", "1 s"),
    ("Limit Upper 2 Type", "None"),
    ("Limit Upper 2", "<No Value>"),
    ("Limit Upper 1 Type", "None"),
    ("Limit Upper 1", "<No Value>"),
    ("Limit Lower 1 Type", "None"),
    ("Limit Lower 1", "<No Value>"),
    ("Limit Lower 2 Type", "None"),
    ("Limit Lower 2", "<No Value>"),
    ("Linear scaling", "False"),
    ("End value PLC", "10"),
    ("Start value PLC", "0"),
    ("End value HMI", "100"),
    ("Start value HMI", "0"),
    ("Gmp relevant", "False"),
    ("Confirmation Type", "None"),
    ("Mandatory Commenting", "False"),
];

/// The longest name of an HMI tag.
const LONGEST: usize = 128;

pub(super) fn workbook(symbols: &[Symbol]) -> SymbolFile {
    let mut names = Names::up_to(LONGEST);
    let bytes = write(symbols, &mut names).expect("the sheet has fewer rows and shorter texts than a workbook allows");
    let notes = match names.changed {
        0 => Vec::new(),
        changed => vec![format!("{changed} names differ only in capitals from others and have a number at their end")],
    };
    SymbolFile { bytes, notes }
}

fn write(symbols: &[Symbol], names: &mut Names) -> Result<Vec<u8>, XlsxError> {
    let mut workbook = Workbook::new();
    // The date of creation would make each file different.
    let date = rust_xlsxwriter::ExcelDateTime::from_ymd(2000, 1, 1)?;
    workbook.set_properties(&rust_xlsxwriter::DocProperties::new().set_creation_datetime(&date));
    let sheet = workbook.add_worksheet();
    sheet.set_name("Hmi Tags")?;
    for (column, (head, _)) in (0..).zip(COLUMNS) {
        sheet.write_string(0, column, head)?;
    }
    for (row, symbol) in (1..).zip(symbols) {
        let kind = symbol.kind();
        let (data_type, coding) = match kind {
            Type::Bool => ("Bool", "Binary"),
            Type::Byte => ("Byte", "Binary"),
            Type::Word => ("Word", "Binary"),
            Type::Int => ("Int", "Binary"),
            Type::Dword => ("DWord", "Binary"),
            Type::Dint => ("DInt", "Binary"),
            Type::Real => ("Real", "IEEE754"),
        };
        let (block, byte) = (symbol.data_block(), symbol.address.byte);
        let address = match kind.width() {
            1 => format!("%DB{block}.DBX{byte}.{}", symbol.bit()),
            8 => format!("%DB{block}.DBB{byte}"),
            16 => format!("%DB{block}.DBW{byte}"),
            _ => format!("%DB{block}.DBD{byte}"),
        };
        for (column, (head, value)) in (0..).zip(COLUMNS) {
            let value = match head {
                "Name" => names.name(&symbol.name()),
                "DataType" => data_type.to_owned(),
                "Length" => kind.width().div_ceil(8).to_string(),
                "Coding" => coding.to_owned(),
                "Address" => address.clone(),
                "Comment [en-US]" => symbol.comment(),
                _ => value.to_owned(),
            };
            sheet.write_string(row, column, value)?;
        }
    }
    workbook.save_to_buffer()
}
