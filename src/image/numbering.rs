//! Under which data block numbers the PLC sees an interface: windows from data blocks onto the bytes of its blocks. A bit
//! keeps its number.

use super::Block;

/// One numbering of the data blocks of an interface.
#[derive(Debug)]
pub struct Numbering {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// What messages call the control that has it.
    pub title: &'static str,
    /// Its number in a mapped image.
    pub number: u64,
    /// Its data blocks, ascending by number and byte.
    pub windows: &'static [Window],
    /// Its data blocks in words, for messages.
    pub blocks: &'static str,
    /// Where the block of an axis is, in words.
    pub axes: &'static str,
}

/// Bytes `first` to `last` of data block `db` (the next number for the next block) are the bytes of a block from `byte`.
#[derive(Debug)]
pub struct Window {
    pub(super) db: u16,
    pub(super) first: u16,
    pub(super) last: u16,
    pub(super) block: Block,
    pub(super) byte: u16,
    pub(super) count: u8,
}

impl Window {
    /// Bytes `first` to `last` of `count` data blocks from number `db` on show a block from `byte`.
    #[must_use]
    pub const fn new(db: u16, first: u16, last: u16, block: Block, byte: u16, count: u8) -> Self {
        Self { db, first, last, block, byte, count }
    }

    /// The number of the block that the window shows in data block `db`, if it is one of its own.
    pub(super) fn number(&self, db: u16) -> Option<u8> {
        let index = db.checked_sub(self.db).filter(|index| *index < u16::from(self.count))?;
        u8::try_from(index + 1).ok()
    }

    pub(super) fn contains(&self, byte: u32) -> bool {
        (u32::from(self.first)..=u32::from(self.last)).contains(&byte)
    }
}
