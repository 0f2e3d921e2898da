//! PLC images, `plc_images/<name>.toml`: the areas and data blocks of the PLC program, and starting values for the complete memory.

use std::path::Path;
use std::sync::Arc;

use crate::source::{Node, Place, Problem, Table, Value, read_text};

use super::{Bytes, DataBlock, Location, Memory, Names, OverrideCoding, Writer, raw_value};

/// A PLC image as read from its file. Names and addresses are looked up when a memory is made from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    areas: [Option<usize>; 5],
    blocks: Vec<DeclaredBlock>,
    interface: Vec<(String, Place, Node)>,
}

#[derive(Clone, Debug, PartialEq)]
struct DeclaredBlock {
    place: Place,
    block: DataBlock,
    values: Vec<(String, Place, Node)>,
}

const SIZE_CURE: &str = "write a number of bytes up to 65535";

impl Preset {
    /// Reads a PLC image from its text; `file` is its name in messages.
    ///
    /// # Errors
    /// The text is not TOML, or it has unknown keys, sizes above 65535, or two blocks with one number.
    pub fn parse(text: &str, file: &str) -> Result<Self, Problem> {
        let mut top = Table::parse(text, file)?;
        let mut areas = [None; 5];
        if let Some(node) = top.take("areas") {
            let mut table = node.into_table("the sizes of the areas")?;
            for (size, name) in areas.iter_mut().zip(["M", "I", "Q", "T", "C"]) {
                *size = table.take(name).map(|node| bytes_count(&node, 0)).transpose()?;
            }
            table.finish()?;
        }
        let mut blocks: Vec<DeclaredBlock> = Vec::new();
        for node in top.take("db").map_or_else(Vec::new, Node::into_list) {
            let block = declared_block(node)?;
            let same = |other: &&DeclaredBlock| other.block.number == block.block.number;
            if let Some(other) = blocks.iter().find(same) {
                return Err(block.place.problem(
                    format!("expected different numbers, found DB{} again", block.block.number),
                    format!("it is declared at {}", other.place),
                ));
            }
            blocks.push(block);
        }
        let interface = match top.take("interface") {
            Some(node) => node.into_table("values by symbol or address")?.take_rest(),
            None => Vec::new(),
        };
        top.finish()?;
        Ok(Self { areas, blocks, interface })
    }

    /// Reads a PLC image from a file.
    ///
    /// # Errors
    /// Like [`Preset::parse`], or the file cannot be read.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        Self::parse(&read_text(path)?, &path.display().to_string())
    }
}

fn bytes_count(node: &Node, least: i64) -> Result<usize, Problem> {
    let size = node.integer("a size in bytes")?;
    match u16::try_from(size) {
        Ok(size) if i64::from(size) >= least => Ok(size.into()),
        _ => Err(node.expected(&format!("a size from {least} to 65535 bytes"), SIZE_CURE)),
    }
}

fn declared_block(node: Node) -> Result<DeclaredBlock, Problem> {
    let place = node.place.clone();
    let mut table = node.into_table("a data block")?;
    let place = if table.place.line > 0 { table.place.clone() } else { place };
    let missing = |what: &str| {
        place.problem(format!("expected `{what}` for a data block, found none"), format!("add {what} = …"))
    };
    let number = table.take("number").ok_or_else(|| missing("number"))?;
    let number = match u16::try_from(number.integer("the number of the data block")?) {
        Ok(valid) if valid > 0 => (valid, number.place),
        _ => return Err(number.expected("a data block number from 1 to 65535", "write 1000 for DB1000")),
    };
    let (number, number_place) = number;
    let size = bytes_count(&table.take("size").ok_or_else(|| missing("size"))?, 1)?;
    let name = table.take("name").map(|node| node.text("a name").map(Arc::from)).transpose()?;
    let mut bytes = vec![0; size];
    if let Some(node) = table.take("fill") {
        let pattern = fill(&node, size)?;
        for (byte, value) in bytes.iter_mut().zip(pattern.iter().cycle()) {
            *byte = *value;
        }
    }
    let values = match table.take("values") {
        Some(node) => node.into_table("values by address in the block")?.take_rest(),
        None => Vec::new(),
    };
    table.finish()?;
    Ok(DeclaredBlock { place: number_place, block: DataBlock { number, name, bytes: Bytes::from(bytes) }, values })
}

/// The bytes of a hexadecimal text such as `"8C 00 FF"`.
fn fill(node: &Node, size: usize) -> Result<Vec<u8>, Problem> {
    let text = node.text("bytes in hexadecimal")?;
    let byte = |part: &str| {
        let digits = part.len() == 2 && part.bytes().all(|digit| digit.is_ascii_hexdigit());
        if digits { u8::from_str_radix(part, 16).ok() } else { None }
    };
    let bytes: Option<Vec<u8>> = text.split_whitespace().map(byte).collect();
    match bytes {
        Some(bytes) if !bytes.is_empty() && bytes.len() <= size => Ok(bytes),
        Some(bytes) if !bytes.is_empty() => Err(node.place.problem(
            format!("expected at most {size} bytes to fill the block, found {}", bytes.len()),
            "increase the size of the block",
        )),
        _ => Err(node.expected("bytes in hexadecimal", "write fill = \"8C 00 FF\"")),
    }
}

impl Memory {
    /// Makes the memory that a PLC image declares, for a machine with these names.
    ///
    /// # Errors
    /// A block has the number of an interface block, values overlap or do not fit, a name or address does not exist, or a value belongs to
    /// the NCK. The problem names the place in the file.
    pub fn from_preset(preset: &Preset, names: &Names, coding: OverrideCoding) -> Result<Self, Problem> {
        let mut memory = Self::after_power_on(names, coding);
        let Self { flags, inputs, outputs, timers, counters, .. } = &mut memory;
        for (area, size) in [flags, inputs, outputs, timers, counters].into_iter().zip(preset.areas) {
            if let Some(size) = size {
                *area = Bytes::zeroed(size);
            }
        }
        for DeclaredBlock { place, block, .. } in &preset.blocks {
            if names.profile.has(block.number) {
                return Err(place.problem(
                    format!(
                        "expected the number of a block of the PLC program, found DB{}, an interface block",
                        block.number
                    ),
                    "use another number; write starting values of the interface into [interface]",
                ));
            }
            memory.blocks.put(block.clone());
        }
        let mut writes = Writes { names, coding, done: Vec::new() };
        for DeclaredBlock { block, values, .. } in &preset.blocks {
            for (key, place, node) in values {
                if !key.starts_with("DB") {
                    return Err(place.problem(
                        format!("expected an address in the block, found `{key}`"),
                        "write DBX0.3, DBB1, DBW2 or DBD4",
                    ));
                }
                writes.write(&mut memory, &format!("DB{}.{key}", block.number), place, node)?;
            }
        }
        for (key, place, node) in &preset.interface {
            writes.write(&mut memory, key, place, node)?;
        }
        Ok(memory)
    }
}

/// The starting values written so far, to detect overlaps.
struct Writes<'a> {
    names: &'a Names,
    coding: OverrideCoding,
    done: Vec<(Location, String, Place)>,
}

impl Writes<'_> {
    fn write(&mut self, memory: &mut Memory, key: &str, place: &Place, node: &Node) -> Result<(), Problem> {
        if let Value::Table(_) = node.value {
            return Err(node.expected("one value", "put the key in quotes: \"X.feed_override\" = \"100%\""));
        }
        let location = self.names.resolve(memory, key).map_err(|problem| problem.at(place))?;
        if self.names.writer(location) == Some(Writer::Nck) {
            return Err(place.problem(
                format!("expected a signal of the PLC or the HMI, found `{key}`, which the NCK writes"),
                "remove it; the NCK sets its own signals",
            ));
        }
        if let Some((_, other, at)) = self.done.iter().find(|(other, ..)| other.overlaps(location)) {
            return Err(place.problem(
                format!("expected each bit once, found `{key}`, which overlaps `{other}`"),
                format!("`{other}` is set at {at}"),
            ));
        }
        let raw = raw_value(node, location, self.coding)?;
        memory.write(location, raw);
        self.done.push((location, key.to_owned(), place.clone()));
        Ok(())
    }
}
