//! The areas I, Q, M and DB behind a small trait, and a memory of their own for programs that run without a machine.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::plc::Link;
use crate::plc::step7::program::{Program, ProgramBlock};

/// An area that is one piece of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// Inputs (I).
    Inputs,
    /// Outputs (Q).
    Outputs,
    /// Flags (M).
    Flags,
}

/// A data block in a register: its number, where the memory has it, and its length in bytes. Number 0 is no block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct OpenBlock {
    /// The number; 0 is no block.
    pub number: u16,
    /// Where the memory has it; the meaning is the memory's own.
    pub slot: u32,
    /// The length in bytes.
    pub length: u32,
}

/// The memory that a program sees. A memory decides itself where a data block is: in one piece, or spread over the parts of an interface.
pub trait Areas {
    /// The bytes of an area.
    fn bytes(&self, area: Area) -> &[u8];

    /// The bytes of an area, to be written.
    fn bytes_mut(&mut self, area: Area) -> &mut [u8];

    /// A data block by its number; `None` if it does not exist.
    fn block(&self, number: u16) -> Option<OpenBlock>;

    /// Makes a data block of zeros; `false` if the memory has no room, or has the block already.
    fn create(&mut self, _number: u16, _length: u16) -> bool {
        false
    }

    /// Deletes a data block that the program has made; `false` for another one.
    fn delete(&mut self, _number: u16) -> bool {
        false
    }

    /// Whether a data block is one of an interface with a control.
    fn is_interface(&self, _block: OpenBlock) -> bool {
        false
    }

    /// The interface and the NC, as the blocks of the basic program see them; `None` without a machine.
    fn link(&mut self) -> Option<Link<'_>> {
        None
    }

    /// Bytes of a data block; `None` beyond its end.
    fn read<const N: usize>(&self, block: OpenBlock, byte: u32) -> Option<[u8; N]>;

    /// Writes bytes of a data block; `None` beyond its end.
    fn write<const N: usize>(&mut self, block: OpenBlock, byte: u32, value: [u8; N]) -> Option<()>;
}

/// A memory with exactly the areas and data blocks of a program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OwnMemory {
    /// Inputs (I).
    pub inputs: Vec<u8>,
    /// Outputs (Q).
    pub outputs: Vec<u8>,
    /// Flags (M).
    pub flags: Vec<u8>,
    blocks: Vec<Vec<u8>>,
    /// How many of them the program brought.
    loaded: usize,
    /// For each number the index of its block and 1, or 0.
    slots: Arc<[u16]>,
}

impl OwnMemory {
    /// The memory of a program after loading.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        let sizes = program.sizes();
        let zeros = |bytes: u32| vec![0; bytes as usize];
        let mut slots = vec![0; program.data_blocks().last().map_or(0, |last| usize::from(last.number) + 1)];
        for (index, block) in (1..).zip(program.data_blocks()) {
            slots[usize::from(block.number)] = index;
        }
        let bytes = |block: &ProgramBlock| block.bytes.clone();
        Self {
            inputs: zeros(sizes.inputs),
            outputs: zeros(sizes.outputs),
            flags: zeros(sizes.flags),
            blocks: program.data_blocks().iter().map(bytes).collect(),
            loaded: program.data_blocks().len(),
            slots: slots.into(),
        }
    }

    fn index(&self, number: u16) -> Option<usize> {
        usize::from(*self.slots.get(usize::from(number))?).checked_sub(1)
    }

    /// The bytes of a data block.
    #[must_use]
    pub fn data(&self, number: u16) -> Option<&[u8]> {
        self.blocks.get(self.index(number)?).map(Vec::as_slice)
    }

    /// The bytes of a data block, to be written.
    pub fn data_mut(&mut self, number: u16) -> Option<&mut [u8]> {
        let index = self.index(number)?;
        self.blocks.get_mut(index).map(Vec::as_mut_slice)
    }
}

impl Areas for OwnMemory {
    fn bytes(&self, area: Area) -> &[u8] {
        match area {
            Area::Inputs => &self.inputs,
            Area::Outputs => &self.outputs,
            Area::Flags => &self.flags,
        }
    }

    fn bytes_mut(&mut self, area: Area) -> &mut [u8] {
        match area {
            Area::Inputs => &mut self.inputs,
            Area::Outputs => &mut self.outputs,
            Area::Flags => &mut self.flags,
        }
    }

    fn block(&self, number: u16) -> Option<OpenBlock> {
        let index = self.index(number)?;
        let length = u32::try_from(self.blocks.get(index)?.len()).ok()?;
        Some(OpenBlock { number, slot: u32::try_from(index).ok()?, length })
    }

    fn create(&mut self, number: u16, length: u16) -> bool {
        if self.index(number).is_some() || self.blocks.len() == usize::from(u16::MAX) {
            return false;
        }
        self.blocks.push(vec![0; length.into()]);
        let mut slots = self.slots.to_vec();
        slots.resize(slots.len().max(usize::from(number) + 1), 0);
        slots[usize::from(number)] = u16::try_from(self.blocks.len()).unwrap_or(u16::MAX);
        self.slots = slots.into();
        true
    }

    fn delete(&mut self, number: u16) -> bool {
        // Blocks of the program are before those that it made.
        let Some(index) = self.index(number).filter(|index| *index >= self.loaded) else { return false };
        self.blocks[index].clear();
        let mut slots = self.slots.to_vec();
        slots[usize::from(number)] = 0;
        self.slots = slots.into();
        true
    }

    fn read<const N: usize>(&self, block: OpenBlock, byte: u32) -> Option<[u8; N]> {
        let bytes = self.blocks.get(block.slot as usize)?.get(byte as usize..)?;
        bytes.first_chunk().copied()
    }

    fn write<const N: usize>(&mut self, block: OpenBlock, byte: u32, value: [u8; N]) -> Option<()> {
        let bytes = self.blocks.get_mut(block.slot as usize)?.get_mut(byte as usize..)?;
        *bytes.first_chunk_mut()? = value;
        Some(())
    }
}
