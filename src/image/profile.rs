//! An interface with one of its numberings: its data blocks, and the positions of their bytes.

use std::fmt;

use crate::source::Problem;

use super::interface::Run;
use super::{Area, Block, Interface, Location, Numbering, Part, Signal, Window};

/// An interface with one of its numberings.
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

    /// All profiles of an interface, the default first.
    pub fn all(interface: &'static Interface) -> impl Iterator<Item = Self> {
        (0..interface.tables().numberings.len()).map(move |index| Self::new(interface, index))
    }

    /// The profile with this name.
    #[must_use]
    pub fn named(interface: &'static Interface, name: &str) -> Option<Self> {
        Self::all(interface).find(|profile| profile.name() == name)
    }

    /// The interface of the profile.
    #[must_use]
    pub const fn interface(self) -> &'static Interface {
        self.interface
    }

    /// The name in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.numbering().name
    }

    /// The number in a mapped image.
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

    /// Whether the interface has a data block with this number.
    #[must_use]
    pub fn has(self, db: u16) -> bool {
        self.windows(db).next().is_some()
    }

    /// The block that a data block shows; the first block if several blocks share the data block.
    #[must_use]
    pub fn block_of(self, db: u16) -> Option<(Block, u8)> {
        self.windows(db).find_map(|window| Some((window.block, window.number(db)?)))
    }

    /// The byte ranges of an interface data block: from, to before, ascending.
    #[must_use]
    pub fn spans(self, db: u16) -> Vec<(u16, u16)> {
        self.windows(db).map(|window| (window.first, window.last + 1)).collect()
    }

    /// The place of each byte of an interface data block: its part, and the byte in the part. `None` for a byte that does not exist.
    #[must_use]
    pub fn places(self, db: u16) -> Vec<Option<(Part, u32)>> {
        let end = self.windows(db).map(|window| u32::from(window.last) + 1).max().unwrap_or(0);
        let place = |byte| self.run(db, byte, byte).ok().map(|run| (run.part, run.offset));
        (0..end).map(place).collect()
    }

    /// The data block and byte that show a byte of a block; `None` if the profile does not show it.
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

    /// Whether the profile shows a location.
    #[must_use]
    pub fn shows(self, location: Location) -> bool {
        (location.offset..location.offset + location.bytes()).all(|offset| self.shows_byte(location.part, offset))
    }

    /// Whether the profile shows a byte of a part.
    #[must_use]
    pub fn shows_byte(self, part: Part, offset: u32) -> bool {
        let at = self.interface.signals_at(part, offset);
        at.is_some_and(|at| self.shown(at.block, at.number, at.byte).is_some())
    }

    /// Whether the profile shows the signals of a byte of a part elsewhere, with a width of its own.
    #[must_use]
    pub fn shows_elsewhere(self, part: Part, offset: u32) -> bool {
        let Some(at) = self.interface.signals_at(part, offset) else { return false };
        let same = |one: &Signal, other: &Signal| (one.block, one.name) == (other.block, other.name);
        let shown = |signal: &Signal| self.shown(signal.block, at.number, signal.byte).is_some();
        let is_twice = |one: &Signal| self.interface.signals().any(|other| same(one, other) && shown(other));
        !self.shows_byte(part, offset) && at.signals.iter().any(|signal| is_twice(signal))
    }

    pub(super) fn numbering(self) -> &'static Numbering {
        &self.interface.tables().numberings[self.index]
    }

    fn windows(self, db: u16) -> impl Iterator<Item = &'static Window> {
        self.numbering().windows.iter().filter(move |window| window.number(db).is_some())
    }

    /// The position of the bytes of an interface data block from `byte` on; all bytes up to `last` must exist.
    pub(super) fn run(self, db: u16, byte: u32, last: u32) -> Result<Run, Problem> {
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

    /// The problem of a byte that an interface data block does not contain.
    fn no_byte(self, db: u16, byte: u32, last: u32) -> Problem {
        let area = Area::DataBlock(db);
        let is_whole = |window: &Window| (window.first, window.byte) == (0, 0) && self.windows(db).count() == 1;
        if self.windows(db).any(is_whole) {
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

/// The problem of an address beyond the end.
pub(super) fn beyond(what: &str, length: u32, needed: u32) -> Problem {
    Problem::new(
        format!("expected an address inside the {length} bytes of {what}, found one that needs {needed}"),
        match length {
            0 => "a PLC image can declare it larger".to_owned(),
            length => format!("the last byte is {}", length - 1),
        },
    )
}
