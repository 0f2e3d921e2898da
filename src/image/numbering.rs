//! Under which data block numbers the PLC sees an interface: windows from data blocks onto the bytes of its blocks. A bit
//! keeps its number.

use std::fmt;

use crate::source::Problem;

use super::interface::Run;
use super::{Area, Block, Interface, Memory};

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
    db: u16,
    first: u16,
    last: u16,
    block: Block,
    byte: u16,
    count: u8,
}

impl Window {
    /// Bytes `first` to `last` of `count` data blocks from number `db` on show a block from `byte`.
    #[must_use]
    pub const fn new(db: u16, first: u16, last: u16, block: Block, byte: u16, count: u8) -> Self {
        Self { db, first, last, block, byte, count }
    }

    /// The number of the block that the window shows in data block `db`, if it is one of its own.
    fn number(&self, db: u16) -> Option<u8> {
        let index = db.checked_sub(self.db).filter(|index| *index < u16::from(self.count))?;
        u8::try_from(index + 1).ok()
    }

    fn contains(&self, byte: u32) -> bool {
        (u32::from(self.first)..=u32::from(self.last)).contains(&byte)
    }
}

/// An interface under one of its numberings.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Profile {
    interface: &'static Interface,
    index: usize,
}

impl fmt::Debug for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Profile {
    pub(super) const fn new(interface: &'static Interface, index: usize) -> Self {
        Self { interface, index }
    }

    /// Whose numbering it is.
    #[must_use]
    pub const fn interface(self) -> &'static Interface {
        self.interface
    }

    /// Its name in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.numbering().name
    }

    /// Its number in a mapped image.
    #[must_use]
    pub fn number(self) -> u64 {
        self.numbering().number
    }

    /// The data blocks of the interface, ascending.
    #[must_use]
    pub fn data_blocks(self) -> Vec<u16> {
        let of_window = |window: &'static Window| (0..u16::from(window.count)).map(|index| window.db + index);
        let mut numbers: Vec<u16> = self.numbering().windows.iter().flat_map(of_window).collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }

    /// Whether the interface has a data block of this number.
    #[must_use]
    pub fn has(self, db: u16) -> bool {
        self.windows(db).next().is_some()
    }

    /// The block that a data block shows; where blocks share a data block, the first.
    #[must_use]
    pub fn block_of(self, db: u16) -> Option<(Block, u8)> {
        self.windows(db).find_map(|window| Some((window.block, window.number(db)?)))
    }

    /// The bytes that an interface data block has: from, to before, ascending.
    #[must_use]
    pub fn spans(self, db: u16) -> Vec<(u16, u16)> {
        self.windows(db).map(|window| (window.first, window.last + 1)).collect()
    }

    /// The data block and byte under which it shows a byte of a block; `None` if it does not.
    #[must_use]
    pub fn shown(self, block: Block, number: u8, byte: u16) -> Option<(u16, u16)> {
        let (number, byte) = self.interface.shared(block, number, byte);
        let window = self.numbering().windows.iter().find(|window| {
            let length = window.last - window.first;
            window.block == block && (window.byte..=window.byte + length).contains(&byte)
        })?;
        let db = window.db + u16::from(number) - 1;
        window.number(db)?;
        Some((db, window.first + (byte - window.byte)))
    }

    fn numbering(self) -> &'static Numbering {
        &self.interface.tables().numberings[self.index]
    }

    fn windows(self, db: u16) -> impl Iterator<Item = &'static Window> {
        self.numbering().windows.iter().filter(move |window| window.number(db).is_some())
    }

    /// Where the bytes of an interface data block from `byte` lie; all up to `last` must exist.
    fn run(self, db: u16, byte: u32, last: u32) -> Result<Run, Problem> {
        let find = |byte| self.windows(db).find(|window| window.contains(byte));
        let mut next = byte;
        while let Some(window) = find(next).filter(|_| next <= last) {
            next = u32::from(window.last) + 1;
        }
        let found = find(byte).filter(|_| next > last).and_then(|window| {
            let byte = u16::try_from(byte).ok()?;
            let run = self.interface.place(window.block, window.number(db)?, window.byte + (byte - window.first))?;
            Some(Run { left: run.left.min(u32::from(window.last - byte) + 1), ..run })
        });
        found.ok_or_else(|| self.no_byte(db, next, last))
    }

    /// The problem of a byte that an interface data block does not have.
    fn no_byte(self, db: u16, byte: u32, last: u32) -> Problem {
        let area = Area::DataBlock(db);
        let is_whole =
            |window: &Window| (window.byte, window.last + 1) == (window.first, self.interface.length(window.block));
        if self.windows(db).any(|window| window.first == 0 && is_whole(window)) {
            let length = self.windows(db).last().map_or(0, |window| u32::from(window.last) + 1);
            return beyond(&area.to_string(), length, last + 1);
        }
        let ranges: Vec<_> = self.windows(db).map(|window| format!("{} to {}", window.first, window.last)).collect();
        Problem::new(
            format!("expected a byte that {area} of {} has, found byte {byte}", self.numbering().title),
            format!("its bytes are {}", ranges.join(", ")),
        )
    }
}

impl Memory {
    /// Where `bytes` bytes from `byte` of an area lie; the run may be shorter, but the whole span exists.
    pub(super) fn run(&self, area: Area, byte: u32, bytes: u32, profile: Profile) -> Result<Run, Problem> {
        if let Area::DataBlock(db) = area {
            if profile.has(db) {
                return profile.run(db, byte, byte.saturating_add(bytes.max(1)) - 1);
            }
            if self.blocks.get(db).is_none() {
                return Err(self.unknown(db, profile));
            }
        }
        let part = area.plain_part();
        let length = u32::try_from(self.part(part).len()).unwrap_or(u32::MAX);
        if byte.saturating_add(bytes) > length {
            return Err(beyond(&area.to_string(), length, byte.saturating_add(bytes)));
        }
        Ok(Run { part, offset: byte, left: length - byte })
    }

    fn unknown(&self, db: u16, profile: Profile) -> Problem {
        let own: Vec<String> = self.blocks.iter().map(|block| block.number.to_string()).collect();
        let Numbering { blocks, axes, .. } = profile.numbering();
        let mut others = profile.interface.profiles().filter(|other| *other != profile);
        let cure = match others.find(|other| other.has(db)) {
            Some(other) => {
                format!("it is a block of {}: set its profile, or use a symbol", other.numbering().title)
            }
            None => format!("an axis has {axes}; other blocks are declared in a PLC image"),
        };
        Problem::new(format!("expected {blocks} or an own block ({}), found DB{db}", own.join(", ")), cure)
    }
}

/// The problem of an address behind the end.
fn beyond(what: &str, length: u32, needed: u32) -> Problem {
    Problem::new(
        format!("expected an address inside the {length} bytes of {what}, found one that needs {needed}"),
        match length {
            0 => "a PLC image can declare it larger".to_owned(),
            length => format!("the last byte is {}", length - 1),
        },
    )
}
