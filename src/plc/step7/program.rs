//! A compiled program: a flat list of instructions, and the tables that they index. The engine runs it; nothing in it changes while it runs.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::basic_program::BLOCKS;
use super::instruction::{BlockKind, BlockName, CallSite, Copy, Line, MakePointer, Op, ParameterSource};

/// A block with statements.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) struct CodeBlock {
    pub(in crate::plc::step7) name: BlockName,
    pub(in crate::plc::step7) symbol: Option<String>,
    /// The index of its first instruction; its last one ends the block.
    pub(in crate::plc::step7) start: u32,
    /// Its local data, in bytes.
    pub(in crate::plc::step7) local: u32,
    /// The number of parameters that a call has to pass by reference.
    pub(in crate::plc::step7) parameters: u16,
}

/// A data block as it is loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProgramBlock {
    /// Its number.
    pub number: u16,
    /// Its symbol, if it has one.
    pub symbol: Option<String>,
    /// Its bytes after loading: the initial values, and over them the actual values.
    pub bytes: Vec<u8>,
}

/// The numbers of bytes, timers and counters that a program needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Bytes of inputs (I).
    pub inputs: u32,
    /// Bytes of outputs (Q).
    pub outputs: u32,
    /// Bytes of flags (M).
    pub flags: u32,
    /// Timers (T).
    pub timers: u32,
    /// Counters (C).
    pub counters: u32,
}

/// A compiled program: blocks, instructions, data blocks as loaded, and the places of the statements.
#[derive(Clone, Debug)]
pub struct Program {
    pub(in crate::plc::step7) code: Vec<Op>,
    /// One for each instruction.
    pub(in crate::plc::step7) lines: Vec<Line>,
    pub(in crate::plc::step7) blocks: Vec<CodeBlock>,
    pub(in crate::plc::step7) index: BTreeMap<BlockName, u16>,
    pub(in crate::plc::step7) copies: Vec<Copy>,
    pub(in crate::plc::step7) pointers: Vec<MakePointer>,
    pub(in crate::plc::step7) calls: Vec<CallSite>,
    pub(in crate::plc::step7) parameters: Vec<ParameterSource>,
    pub(in crate::plc::step7) data: Vec<ProgramBlock>,
    pub(in crate::plc::step7) sizes: Sizes,
    pub(in crate::plc::step7) files: Vec<String>,
    pub(in crate::plc::step7) statements: u32,
    /// A number that another program does not have, for saved states.
    pub(in crate::plc::step7) fingerprint: u64,
    /// The symbols of bits, timers and counters by their addresses.
    pub(in crate::plc::step7) symbols: Arc<BTreeMap<String, String>>,
    /// Blocks of the basic program that are called and built in, with their indices.
    pub(in crate::plc::step7) basic: Vec<(BlockName, usize)>,
    /// Blocks that are called, are nowhere, and are left out.
    pub(in crate::plc::step7) ignored: Vec<BlockName>,
    /// Data blocks that are used, and that the machine must bring.
    pub(in crate::plc::step7) foreign: Vec<u16>,
}

impl Program {
    /// Its data blocks as they are loaded, by number.
    #[must_use]
    pub fn data_blocks(&self) -> &[ProgramBlock] {
        &self.data
    }

    /// The sizes of the areas that it uses.
    #[must_use]
    pub fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// The symbols of bits, timers and counters by their addresses, such as `I1.0` and `T5`.
    #[must_use]
    pub fn symbols(&self) -> &Arc<BTreeMap<String, String>> {
        &self.symbols
    }

    /// The number of its statements.
    #[must_use]
    pub fn statements(&self) -> u32 {
        self.statements
    }

    /// Its blocks with statements, with their symbols.
    pub fn code_blocks(&self) -> impl Iterator<Item = (BlockName, Option<&str>)> {
        self.blocks.iter().map(|block| (block.name, block.symbol.as_deref()))
    }

    /// The data blocks that its blocks of the basic program need and the sources do not have, with their lengths.
    pub(in crate::plc::step7) fn basic_data_blocks(&self) -> impl Iterator<Item = (u16, usize)> {
        let needed = self.basic.iter().flat_map(|&(_, index)| BLOCKS[index].data_blocks());
        needed.filter(|(number, _)| self.data.iter().all(|block| block.number != *number))
    }

    /// The blocks of the basic program that are called and built in, with their names.
    pub fn basic_program(&self) -> impl Iterator<Item = (BlockName, &'static str)> {
        self.basic.iter().map(|&(name, index)| (name, BLOCKS[index].name))
    }

    /// Blocks that are called, are nowhere, and are left out.
    #[must_use]
    pub fn left_out(&self) -> &[BlockName] {
        &self.ignored
    }

    /// The numbers of data blocks that are used and are not in the sources: those of the interface.
    #[must_use]
    pub fn foreign_data_blocks(&self) -> &[u16] {
        &self.foreign
    }

    /// The place of an instruction: `FC10, network 3, statement 5 (motor.awl:12)`.
    pub(in crate::plc::step7) fn place(&self, pc: u32) -> String {
        let line = self.lines.get(pc as usize).copied().unwrap_or_default();
        let block = self.block_at(pc).map_or_else(String::new, |block| block.name.to_string());
        let file = self.files.get(usize::from(line.file)).map_or("", String::as_str);
        format!("{block}, network {}, statement {} ({file}:{})", line.network, line.statement, line.line)
    }

    /// The block to which an instruction belongs.
    pub(in crate::plc::step7) fn block_at(&self, pc: u32) -> Option<&CodeBlock> {
        let after = self.blocks.partition_point(|block| block.start <= pc);
        self.blocks.get(after.checked_sub(1)?)
    }

    pub(in crate::plc::step7) fn find(&self, kind: BlockKind, number: u16) -> Option<u16> {
        self.index.get(&BlockName { kind, number }).copied()
    }
}
