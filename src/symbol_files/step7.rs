//! Symbol table and source of STEP 7 V5. A bit of a data block cannot be a symbol, so the table has the data blocks, and the source has the
//! signals as components of data types.

use std::collections::BTreeMap;

use super::short::Names;
use super::symbol::{Symbol, SymbolFile};

/// The longest symbol and the longest name of a component.
const LONGEST: usize = 24;
/// The longest comment of a symbol.
const COMMENT: usize = 80;

/// A component of a data type.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Component {
    name: String,
    /// BOOL, BYTE and so on, or an array of bytes.
    kind: String,
    comment: String,
}

/// A data block of the interface.
pub(super) struct Block {
    number: u16,
    symbol: String,
    owners: String,
    components: Vec<Component>,
}

/// The data blocks with their components, and notes.
pub(super) struct Blocks {
    blocks: Vec<Block>,
    notes: Vec<String>,
}

/// The data blocks that contain these symbols.
pub(super) fn blocks(symbols: &[Symbol], lengths: &[(u16, u32)]) -> Blocks {
    let mut of_block: BTreeMap<u16, Vec<&Symbol>> = BTreeMap::new();
    for symbol in symbols {
        of_block.entry(symbol.data_block()).or_default().push(symbol);
    }
    let mut owned: BTreeMap<&str, usize> = BTreeMap::new();
    for symbols in of_block.values() {
        *owned.entry(symbols[0].owner.as_str()).or_default() += 1;
    }
    let mut names = Names::up_to(LONGEST);
    let (mut notes, mut changed) = (Vec::new(), 0);
    let mut blocks: Vec<Block> = Vec::new();
    for (&number, symbols) in &of_block {
        let first = symbols[0].owner.as_str();
        // On the 828D, an axis has several data blocks.
        let wanted = if owned[first] == 1 { first.to_owned() } else { format!("{first}_DB{number}") };
        let mut owners: Vec<&str> = symbols.iter().map(|symbol| symbol.owner.as_str()).collect();
        owners.dedup();
        let length = lengths.iter().find(|(block, _)| *block == number).map_or(0, |(_, length)| *length);
        let components = components(number, symbols, length, &mut notes, &mut changed);
        blocks.push(Block { number, symbol: names.name(&wanted), owners: owners.join(", "), components });
    }
    if changed > 0 {
        let what = format!("{changed} names of components have more than {LONGEST} characters and are shortened");
        notes.push(format!("{what}; the comments have the full names"));
    }
    Blocks { blocks, notes }
}

/// The components at the addresses of the signals, with unnamed ones between them.
fn components(
    block: u16,
    symbols: &[&Symbol],
    length: u32,
    notes: &mut Vec<String>,
    changed: &mut usize,
) -> Vec<Component> {
    let start = |symbol: &Symbol| u32::from(symbol.address.byte) * 8 + u32::from(symbol.bit());
    let mut placed: BTreeMap<u32, &Symbol> = BTreeMap::new();
    let mut by_width: Vec<&Symbol> = symbols.to_vec();
    by_width.sort_by_key(|symbol| (symbol.kind().width(), start(symbol)));
    for symbol in by_width {
        let (from, width) = (start(symbol), symbol.kind().width());
        let before = placed.range(..from + width).next_back();
        let is_free = before.is_none_or(|(&at, other)| at + other.kind().width() <= from);
        if is_free && (width < 16 || from.is_multiple_of(16)) {
            placed.insert(from, symbol);
        } else {
            let what = if is_free { "begins at an odd byte" } else { "shares its bytes with other signals" };
            notes.push(format!("DB{block}: `{}` at {} {what} and is no component", symbol.signal, symbol.address));
        }
    }
    let mut names = Names::up_to(LONGEST);
    let mut found = Vec::new();
    let mut at = 0;
    for (&from, symbol) in &placed {
        fill(&mut found, at, from);
        let name = names.name(&symbol.signal);
        let comment = symbol.comment();
        let comment = if name == symbol.signal { comment } else { format!("{}: {comment}", symbol.signal) };
        found.push(Component { name, kind: symbol.kind().name().to_owned(), comment });
        at = from + symbol.kind().width();
    }
    // The length of a structure is even.
    fill(&mut found, at, length.next_multiple_of(2) * 8);
    *changed += names.changed;
    found
}

/// Components without a meaning from one bit up to another.
fn fill(components: &mut Vec<Component>, mut at: u32, end: u32) {
    let mut push = |name: String, kind: String| components.push(Component { name, kind, comment: String::new() });
    while at < end {
        let byte = at / 8;
        let bytes = (end - at) / 8;
        if !at.is_multiple_of(8) || bytes == 0 {
            push(format!("reserved_{byte}_{}", at % 8), "BOOL".to_owned());
            at += 1;
        } else if !byte.is_multiple_of(2) || bytes == 1 {
            push(format!("reserved_{byte}"), "BYTE".to_owned());
            at += 8;
        } else {
            // An array begins and ends at an even byte.
            let bytes = bytes - bytes % 2;
            let last = byte + bytes - 1;
            push(format!("reserved_{byte}"), format!("ARRAY [{byte} .. {last}] OF BYTE"));
            at += bytes * 8;
        }
    }
}

impl Block {
    fn comment(&self) -> String {
        format!("interface of {}", self.owners).chars().take(COMMENT).collect()
    }
}

/// The symbols of the data blocks, in quoted fields: `"X","DB 31","DB 31","interface of X"`.
pub(super) fn quoted_table(blocks: &Blocks) -> SymbolFile {
    let line = |block: &Block| {
        let (symbol, number, comment) = (&block.symbol, block.number, block.comment());
        format!("\"{symbol}\",\"DB {number}\",\"DB {number}\",\"{comment}\"\r\n")
    };
    table(blocks, line)
}

/// The symbols of the data blocks, in columns of 24, 12, 10 and 80 characters behind `126,`.
pub(super) fn column_table(blocks: &Blocks) -> SymbolFile {
    let line = |block: &Block| {
        let (symbol, address, comment) = (&block.symbol, format!("DB {}", block.number), block.comment());
        format!("126,{symbol:<24}{address:<12}{address:<10}{comment:<80}\r\n")
    };
    table(blocks, line)
}

fn table(blocks: &Blocks, line: impl Fn(&Block) -> String) -> SymbolFile {
    let text: String = blocks.blocks.iter().map(line).collect();
    SymbolFile { bytes: windows_1252(&text), notes: blocks.notes.clone() }
}

/// The data blocks.
pub(super) fn source(blocks: &Blocks) -> SymbolFile {
    let mut text = String::new();
    for block in &blocks.blocks {
        text += &format!("DATA_BLOCK DB {}\nTITLE ={}\nVERSION : 0.1\n\n  STRUCT\n", block.number, block.comment());
        for Component { name, kind, comment } in &block.components {
            let comment = if comment.is_empty() { String::new() } else { format!("  //{comment}") };
            text += &format!("   {name} : {kind} ;{comment}\n");
        }
        text += "  END_STRUCT ;\nBEGIN\nEND_DATA_BLOCK\n\n";
    }
    SymbolFile { bytes: windows_1252(&text.replace('\n', "\r\n")), notes: blocks.notes.clone() }
}

/// The code page of STEP 7 V5 in western Europe. Characters outside Latin-1 become a question mark.
fn windows_1252(text: &str) -> Vec<u8> {
    text.chars().map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?')).collect()
}
