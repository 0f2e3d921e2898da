//! The interface blocks of the SINUMERIK 828D: the same memory under other data block numbers, as windows of bytes.
//! A bit keeps its number. There are one mode group, one channel and eight axes, axis *n* with index *n* − 1.

use crate::source::Problem;

use super::places::{Run, place};
use super::{Area, Block};

/// Bytes `first` to `last` of data block `db` (the next number for the next axis) are the bytes of an interface block
/// from `byte`.
struct Window {
    db: u16,
    first: u16,
    last: u16,
    block: Block,
    byte: u16,
}

const fn window(db: u16, first: u16, last: u16, block: Block, byte: u16) -> Window {
    Window { db, first, last, block, byte }
}

/// How many axes the 828D has.
const AXES: u16 = 8;

static WINDOWS: [Window; 21] = [
    window(1800, 0, 1, Block::ModeGroup, 4),
    window(2600, 0, 1, Block::Nck, 56),
    window(2700, 0, 3, Block::Nck, 106),
    window(3000, 0, 2, Block::ModeGroup, 0),
    window(3100, 0, 2, Block::ModeGroup, 6),
    window(3200, 0, 7, Block::Channel, 0),
    window(3200, 1000, 1011, Block::Channel, 12),
    window(3300, 0, 5, Block::Channel, 32),
    window(3300, 1000, 1003, Block::Channel, 40),
    window(3300, 1004, 1007, Block::Channel, 46),
    window(3300, 1008, 1011, Block::Channel, 52),
    window(3800, 0, 11, Block::Axis, 0),
    window(3800, 1000, 1003, Block::Axis, 12),
    window(3800, 2000, 2003, Block::Axis, 16),
    window(3800, 4000, 4003, Block::Axis, 20),
    window(3800, 5000, 5007, Block::Axis, 24),
    window(3900, 0, 11, Block::Axis, 60),
    window(3900, 1000, 1003, Block::Axis, 74),
    window(3900, 2000, 2003, Block::Axis, 82),
    window(3900, 4000, 4003, Block::Axis, 92),
    window(3900, 5000, 5007, Block::Axis, 96),
];

impl Window {
    /// The number of the interface block that the window shows in data block `db`, if it is one of its own.
    fn number(&self, db: u16) -> Option<u8> {
        let count = if matches!(self.block, Block::Axis) { AXES } else { 1 };
        let index = db.checked_sub(self.db).filter(|index| *index < count)?;
        u8::try_from(index + 1).ok()
    }
}

/// Whether the 828D has an interface block of this number.
pub(super) fn has(db: u16) -> bool {
    WINDOWS.iter().any(|window| window.number(db).is_some())
}

/// The interface block that a data block shows.
#[cfg(feature = "mapped")]
pub(super) fn block_of(db: u16) -> Option<(Block, u8)> {
    WINDOWS.iter().find_map(|window| Some((window.block, window.number(db)?)))
}

/// The bytes that a data block has: from, to before, ascending.
#[cfg(feature = "mapped")]
pub(super) fn spans(db: u16) -> Vec<(usize, usize)> {
    let shown = WINDOWS.iter().filter(|window| window.number(db).is_some());
    shown.map(|window| (window.first.into(), usize::from(window.last) + 1)).collect()
}

/// Where the bytes from `byte` lie; all up to `last` must exist.
pub(super) fn run(db: u16, byte: u32, last: u32) -> Result<Run, Problem> {
    let windows = || WINDOWS.iter().filter(|window| window.number(db).is_some());
    let find = |byte: u32| windows().find(|w| (u32::from(w.first)..=u32::from(w.last)).contains(&byte));
    let hole = (byte..=last).take(1 << 16).find(|byte| find(*byte).is_none());
    let window = find(byte).filter(|_| hole.is_none());
    let found = window.and_then(|window| {
        let byte = u16::try_from(byte).ok()?;
        let run = place(window.block, window.number(db)?, window.byte + (byte - window.first))?;
        Some(Run { left: run.left.min(u32::from(window.last - byte) + 1), ..run })
    });
    found.ok_or_else(|| {
        let ranges: Vec<String> = windows().map(|window| format!("{} to {}", window.first, window.last)).collect();
        Problem::new(
            format!(
                "expected a byte that {} of the 828D has, found byte {}",
                Area::DataBlock(db),
                hole.unwrap_or(byte)
            ),
            format!("its bytes are {}", ranges.join(", ")),
        )
    })
}

/// The data block and byte under which the 828D shows a byte of an interface block; `None` if it does not.
pub(super) fn shown(block: Block, number: u8, byte: u16) -> Option<(u16, u16)> {
    let window = WINDOWS.iter().find(|window| {
        let length = window.last - window.first;
        window.block == block && (window.byte..=window.byte + length).contains(&byte)
    })?;
    let db = window.db + u16::from(number) - 1;
    window.number(db)?;
    Some((db, window.first + (byte - window.byte)))
}
