//! The data block numbers of an interface for the PLC: windows from data blocks onto the bytes of its blocks. Bit numbers are unchanged.

use super::Block;

/// One numbering of the data blocks of an interface.
#[derive(Debug)]
pub struct Numbering {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// The name of the control with this numbering, in messages.
    pub title: &'static str,
    /// Its number in a mapped image.
    pub number: u64,
    /// The data blocks, ascending by number and byte.
    pub windows: &'static [Window],
    /// The list of the data blocks, for messages.
    pub blocks: &'static str,
    /// The data block number of an axis, for messages.
    pub axes: &'static str,
}

/// Bytes `first` to `last` of data block `db` show the bytes of a block from `byte` on. The next data block shows the next block.
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
    /// Bytes `first` to `last` of `count` data blocks, from number `db` on, show the bytes of a block from `byte` on.
    #[must_use]
    pub const fn new(db: u16, first: u16, last: u16, block: Block, byte: u16, count: u8) -> Self {
        Self { db, first, last, block, byte, count }
    }

    /// The number of the block that the window shows in data block `db`, if the window includes `db`.
    pub(super) fn number(&self, db: u16) -> Option<u8> {
        let index = db.checked_sub(self.db).filter(|index| *index < u16::from(self.count))?;
        u8::try_from(index + 1).ok()
    }

    pub(super) fn contains(&self, byte: u32) -> bool {
        (u32::from(self.first)..=u32::from(self.last)).contains(&byte)
    }
}
