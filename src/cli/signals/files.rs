//! The formats of `opennck signals`, and where the result goes.

use std::io::{IsTerminal, Write};
use std::path::Path;

use clap::ValueEnum;

use crate::cli::files::Files;
use crate::cli::list::Format;
use crate::cli::output::Output;
use crate::image::{Address, Profile, Writer};
use crate::source::{Problem, Replacement};
use crate::symbol_files::{self, Symbol, SymbolFile};

/// A list, or the symbol file of another tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum SignalFormat {
    /// Aligned columns.
    Table,
    /// A JSON array of objects.
    Json,
    /// Comma-separated values with a header.
    Csv,
    /// Variables of node-red-contrib-s7: the import of its endpoint.
    NodeRed,
    /// Tags of python-snap7 3: `load_csv`.
    PythonSnap7,
    /// HMI tags of TIA Portal (WinCC Comfort, Advanced), a workbook.
    TiaXlsx,
    /// Symbol table of STEP 7 V5 with the data blocks.
    Step7Sdf,
    /// The same symbol table with columns of fixed width.
    Step7Asc,
    /// AWL source of STEP 7 V5: the signals as components of data blocks.
    Step7Awl,
}

impl SignalFormat {
    /// The list of this format; `None` for a symbol file.
    pub(super) const fn list(self) -> Option<Format> {
        match self {
            Self::Table => Some(Format::Table),
            Self::Json => Some(Format::Json),
            Self::Csv => Some(Format::Csv),
            _ => None,
        }
    }

    fn tool(self) -> symbol_files::Format {
        match self {
            Self::NodeRed => symbol_files::Format::NodeRed,
            Self::PythonSnap7 => symbol_files::Format::PythonSnap7,
            Self::TiaXlsx => symbol_files::Format::TiaXlsx,
            Self::Step7Sdf => symbol_files::Format::Step7Sdf,
            Self::Step7Asc => symbol_files::Format::Step7Asc,
            Self::Step7Awl => symbol_files::Format::Step7Awl,
            Self::Table | Self::Json | Self::Csv => unreachable!("lists are no symbol files"),
        }
    }
}

/// What of the catalogue is listed, how, and where.
pub(in crate::cli) struct Listed<'a> {
    pub(in crate::cli) filter: Option<&'a str>,
    pub(in crate::cli) format: SignalFormat,
    pub(in crate::cli) file: Option<&'a Path>,
}

/// A signal of the list.
pub(super) struct SymbolRow<'a> {
    pub(super) symbol: &'a str,
    pub(super) address: Address,
    pub(super) writer: Writer,
    pub(super) meaning: &'a str,
}

/// The symbol file for rows of the list.
pub(super) fn symbol_file(format: SignalFormat, rows: &[SymbolRow<'_>], profile: Profile) -> SymbolFile {
    let symbol = |row: &SymbolRow<'_>| {
        let (owner, signal) = row.symbol.split_once('.').expect("a symbol has an owner and a signal");
        let (owner, signal) = (owner.to_owned(), signal.to_owned());
        Symbol { owner, signal, address: row.address, writer: row.writer, meaning: row.meaning.to_owned() }
    };
    let symbols: Vec<_> = rows.iter().map(symbol).collect();
    let length = |db| (db, profile.spans(db).iter().map(|&(_, end)| u32::from(end)).max().unwrap_or(0));
    let lengths: Vec<_> = profile.data_blocks().into_iter().map(length).collect();
    symbol_files::symbol_file(format.tool(), &symbols, &lengths)
}

/// Writes the result to the file of `--output`, or to standard output.
pub(super) fn write(bytes: &[u8], listed: &Listed<'_>, output: &mut Output) -> Result<(), Problem> {
    let Some(path) = listed.file else {
        if let (Some(_), Ok(text)) = (listed.format.list(), std::str::from_utf8(bytes)) {
            output.print(text);
        } else if listed.format == SignalFormat::TiaXlsx && std::io::stdout().is_terminal() {
            return Err(Problem::new("a workbook is no text for a terminal", "add --output FILE.xlsx"));
        } else {
            // Exactly these bytes: a carriage return is part of a line of STEP 7.
            let written = std::io::stdout().lock().write_all(bytes);
            output.note(written);
        }
        return Ok(());
    };
    let mut file = open(path, listed.format)?;
    file.write_bytes(bytes)?;
    file.finish()
}

fn open(path: &Path, format: SignalFormat) -> Result<Replacement, Problem> {
    match format {
        SignalFormat::Step7Sdf | SignalFormat::Step7Asc | SignalFormat::Step7Awl => Files::open_new("--output", path),
        _ => Files::default().open("--output", path),
    }
}
