//! Data blocks as tables of ranges over the memory by writer: which byte of DB31 is which byte of whom.

use std::mem::offset_of;

use crate::source::Problem;

use super::{
    Area, AxisFromNck, AxisToNck, Block, ChannelFromNck, ChannelHmi, ChannelToNck, FromNck, Hmi, Memory,
    ModeGroupFromNck, ModeGroupHmi, ModeGroupToNck, NckFromNck, NckHmi, NckToNck, Part, Profile, ToNck, profile_828d,
};

/// Plain bytes of DB10: 0 to 55, 58 to 67, 110 to 271.
pub(super) const PLAIN_NCK: usize = 56 + 10 + 162;
/// Plain bytes of DB11: 3, 9 to 19, 23, 29 to 63.
pub(super) const PLAIN_MODE_GROUPS: usize = 1 + 11 + 1 + 35;
/// Plain bytes of DB21: 22 and 23, 26 to 31, 54 to 415.
pub(super) const PLAIN_CHANNEL: usize = 2 + 6 + 362;
/// Plain bytes of DB31: 30 to 59, 103 to 147.
pub(super) const PLAIN_AXIS: usize = 30 + 45;
/// The second mode group lies so many bytes above the first.
pub(super) const DB11_STRIDE: u16 = 20;

/// Bytes that lie together in one part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    /// The part.
    pub(super) part: Part,
    /// The byte in the part.
    pub(super) offset: u32,
    /// How many bytes follow together, this one included.
    pub(super) left: u32,
}

/// One range of a data block: bytes `first` to `last` lie in `part` from `base`, `stride` further for each block.
struct Range {
    first: u16,
    last: u16,
    part: Part,
    base: usize,
    stride: usize,
}

const fn range(first: u16, last: u16, part: Part, base: usize, stride: usize) -> Range {
    Range { first, last, part, base, stride }
}

const NCK_PLAIN: usize = offset_of!(ToNck, plain.nck);
#[rustfmt::skip]
static NCK: [Range; 7] = [
    range(0, 55, Part::ToNck, NCK_PLAIN, 0),
    range(56, 57, Part::ToNck, offset_of!(ToNck, nck), 0),
    range(58, 67, Part::ToNck, NCK_PLAIN + 56, 0),
    range(68, 96, Part::FromNck, offset_of!(FromNck, nck), 0),
    range(97, 103, Part::Hmi, offset_of!(Hmi, nck), 0),
    range(104, 109, Part::FromNck, offset_of!(FromNck, nck) + (104 - 68), 0),
    range(110, 271, Part::ToNck, NCK_PLAIN + 66, 0),
];

const GROUPS_PLAIN: usize = offset_of!(ToNck, plain.mode_groups);
#[rustfmt::skip]
static MODE_GROUPS: [Range; 10] = [
    range(0, 2, Part::ToNck, offset_of!(ToNck, mode_groups), 0),
    range(3, 3, Part::ToNck, GROUPS_PLAIN, 0),
    range(4, 5, Part::Hmi, offset_of!(Hmi, mode_groups), 0),
    range(6, 8, Part::FromNck, offset_of!(FromNck, mode_groups), 0),
    range(9, 19, Part::ToNck, GROUPS_PLAIN + 1, 0),
    range(20, 22, Part::ToNck, offset_of!(ToNck, mode_groups) + size_of::<ModeGroupToNck>(), 0),
    range(23, 23, Part::ToNck, GROUPS_PLAIN + 12, 0),
    range(24, 25, Part::Hmi, offset_of!(Hmi, mode_groups) + size_of::<ModeGroupHmi>(), 0),
    range(26, 28, Part::FromNck, offset_of!(FromNck, mode_groups) + size_of::<ModeGroupFromNck>(), 0),
    range(29, 63, Part::ToNck, GROUPS_PLAIN + 13, 0),
];

const CHANNEL_PLAIN: usize = offset_of!(ToNck, plain.channels);
#[rustfmt::skip]
static CHANNEL: [Range; 6] = [
    range(0, 21, Part::ToNck, offset_of!(ToNck, channels), size_of::<ChannelToNck>()),
    range(22, 23, Part::ToNck, CHANNEL_PLAIN, PLAIN_CHANNEL),
    range(24, 25, Part::Hmi, offset_of!(Hmi, channels), size_of::<ChannelHmi>()),
    range(26, 31, Part::ToNck, CHANNEL_PLAIN + 2, PLAIN_CHANNEL),
    range(32, 53, Part::FromNck, offset_of!(FromNck, channels), size_of::<ChannelFromNck>()),
    range(54, 415, Part::ToNck, CHANNEL_PLAIN + 8, PLAIN_CHANNEL),
];

const AXIS_PLAIN: usize = offset_of!(ToNck, plain.axes);
#[rustfmt::skip]
static AXIS: [Range; 4] = [
    range(0, 29, Part::ToNck, offset_of!(ToNck, axes), size_of::<AxisToNck>()),
    range(30, 59, Part::ToNck, AXIS_PLAIN, PLAIN_AXIS),
    range(60, 102, Part::FromNck, offset_of!(FromNck, axes), size_of::<AxisFromNck>()),
    range(103, 147, Part::ToNck, AXIS_PLAIN + 30, PLAIN_AXIS),
];

/// Holds at compile time: the ranges follow one another without a gap, up to the length of the block (O-24).
const fn tiles(ranges: &[Range], length: u16) {
    let (mut index, mut next) = (0, 0);
    while index < ranges.len() {
        assert!(ranges[index].first == next && ranges[index].last >= next, "ranges must follow one another");
        next = ranges[index].last + 1;
        index += 1;
    }
    assert!(next == length, "the ranges must fill the block");
}

const _: () = {
    tiles(&NCK, 272);
    tiles(&MODE_GROUPS, 64);
    tiles(&CHANNEL, 416);
    tiles(&AXIS, 148);
    // The bytes of the runs, as the manual counts them.
    assert!(NckToNck::FIRST == 56 && size_of::<NckToNck>() == 2);
    assert!(NckFromNck::FIRST == 68 && size_of::<NckFromNck>() == 42);
    assert!(NckHmi::FIRST == 97 && size_of::<NckHmi>() == 7);
    assert!(ModeGroupToNck::FIRST == 0 && size_of::<ModeGroupToNck>() == 3);
    assert!(ModeGroupHmi::FIRST == 4 && size_of::<ModeGroupHmi>() == 2);
    assert!(ModeGroupFromNck::FIRST == 6 && size_of::<ModeGroupFromNck>() == 3);
    assert!(ChannelToNck::FIRST == 0 && size_of::<ChannelToNck>() == 22);
    assert!(ChannelHmi::FIRST == 24 && size_of::<ChannelHmi>() == 2);
    assert!(ChannelFromNck::FIRST == 32 && size_of::<ChannelFromNck>() == 22);
    assert!(AxisToNck::FIRST == 0 && size_of::<AxisToNck>() == 30);
    assert!(AxisFromNck::FIRST == 60 && size_of::<AxisFromNck>() == 43);
    // The parts, without padding and in this order.
    assert!(offset_of!(ToNck, mode_groups) == 2 && offset_of!(ToNck, channels) == 8);
    assert!(offset_of!(ToNck, axes) == 228 && offset_of!(ToNck, plain) == 1158);
    assert!(size_of::<ToNck>() == 1158 + PLAIN_NCK + PLAIN_MODE_GROUPS + 10 * PLAIN_CHANNEL + 31 * PLAIN_AXIS);
    assert!(offset_of!(FromNck, mode_groups) == 42 && offset_of!(FromNck, channels) == 48);
    assert!(offset_of!(FromNck, axes) == 268 && size_of::<FromNck>() == 268 + 31 * 43);
    assert!(offset_of!(Hmi, mode_groups) == 7 && offset_of!(Hmi, channels) == 11 && size_of::<Hmi>() == 31);
};

fn ranges(block: Block) -> &'static [Range] {
    match block {
        Block::Nck => &NCK,
        Block::ModeGroup => &MODE_GROUPS,
        Block::Channel => &CHANNEL,
        Block::Axis => &AXIS,
    }
}

/// How many bytes the data block of such a block has (O-24).
pub(super) fn length(block: Block) -> u16 {
    ranges(block).last().map_or(0, |range| range.last + 1)
}

/// Where a byte of the data block of block number `number` lies; `None` beyond its end.
pub(super) fn place(block: Block, number: u8, byte: u16) -> Option<Run> {
    let range = ranges(block).iter().find(|range| range.last >= byte)?;
    let offset = range.base + range.stride * (usize::from(number) - 1) + usize::from(byte - range.first);
    let offset = u32::try_from(offset).expect("the parts have some thousand bytes");
    Some(Run { part: range.part, offset, left: u32::from(range.last - byte) + 1 })
}

/// The interface block behind a data block number of the 840D sl; both mode groups count as the first.
pub(super) fn interface_840d(db: u16) -> Option<(Block, u8)> {
    let (block, first) = match db {
        10 => (Block::Nck, 10),
        11 => (Block::ModeGroup, 11),
        21..=30 => (Block::Channel, 21),
        31..=61 => (Block::Axis, 31),
        _ => return None,
    };
    u8::try_from(db - first + 1).ok().map(|number| (block, number))
}

/// The interface block behind a data block number; both mode groups count as the first.
#[cfg(feature = "mapped")]
pub(super) fn block_of(db: u16, profile: Profile) -> Option<(Block, u8)> {
    match profile {
        Profile::Sinumerik840dSl => interface_840d(db),
        Profile::Sinumerik828d => profile_828d::block_of(db),
    }
}

/// The bytes that an interface block has: from, to before, ascending.
#[cfg(feature = "mapped")]
pub(super) fn spans(db: u16, profile: Profile) -> Vec<(usize, usize)> {
    match profile {
        Profile::Sinumerik840dSl => {
            interface_840d(db).map(|(block, _)| (0, length(block).into())).into_iter().collect()
        }
        Profile::Sinumerik828d => profile_828d::spans(db),
    }
}

/// Whether the interface has a data block of this number.
pub(super) fn is_interface(db: u16, profile: Profile) -> bool {
    match profile {
        Profile::Sinumerik840dSl => interface_840d(db).is_some(),
        Profile::Sinumerik828d => profile_828d::has(db),
    }
}

/// Where `bytes` bytes from `byte` of an area lie; the run may be shorter, but the whole span exists.
pub(super) fn run(memory: &Memory, area: Area, byte: u32, bytes: u32, profile: Profile) -> Result<Run, Problem> {
    let (part, length) = match area {
        Area::DataBlock(db) if is_interface(db, profile) => {
            return interface(db, byte, bytes, profile);
        }
        Area::DataBlock(db) => match memory.blocks.get(db) {
            Some(block) => (Part::Block(db), block.len()),
            None => return Err(unknown(memory, db, profile)),
        },
        Area::Inputs | Area::Outputs | Area::Flags | Area::Timers | Area::Counters => {
            let part = area.plain_part();
            (part, memory.part(part).len())
        }
    };
    let length = u32::try_from(length).unwrap_or(u32::MAX);
    if byte.saturating_add(bytes) > length {
        return Err(beyond(&area.to_string(), length, byte.saturating_add(bytes)));
    }
    Ok(Run { part, offset: byte, left: length - byte })
}

fn interface(db: u16, byte: u32, bytes: u32, profile: Profile) -> Result<Run, Problem> {
    let last = byte.saturating_add(bytes.max(1)) - 1;
    match profile {
        Profile::Sinumerik840dSl => {
            let (block, number) = interface_840d(db).expect("only called for interface blocks");
            let exists = |byte| u16::try_from(byte).ok().and_then(|byte| place(block, number, byte));
            match (exists(byte), exists(last)) {
                (Some(run), Some(_)) => Ok(run),
                _ => Err(beyond(&Area::DataBlock(db).to_string(), length(block).into(), last + 1)),
            }
        }
        Profile::Sinumerik828d => profile_828d::run(db, byte, last),
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

fn unknown(memory: &Memory, db: u16, profile: Profile) -> Problem {
    let (interface, axes, other) = match profile {
        Profile::Sinumerik840dSl => {
            ("DB10, DB11, DB21 to DB30, DB31 to DB61", "DB 30 + axis number", profile_828d::has(db))
        }
        Profile::Sinumerik828d => (
            "DB1800, DB2600, DB2700, DB3000, DB3100, DB3200, DB3300, DB3800 to DB3807, DB3900 to DB3907",
            "DB 3800 + axis number - 1",
            interface_840d(db).is_some(),
        ),
    };
    let own: Vec<String> = memory.blocks.iter().map(|block| block.number.to_string()).collect();
    let cure = match (other, profile) {
        (true, Profile::Sinumerik840dSl) => "it is a block of the 828D: set its profile, or use a symbol".to_owned(),
        (true, Profile::Sinumerik828d) => "it is a block of the 840D sl: set its profile, or use a symbol".to_owned(),
        (false, _) => format!("an axis has {axes}; other blocks are declared in a PLC image"),
    };
    Problem::new(format!("expected {interface} or an own block ({}), found DB{db}", own.join(", ")), cure)
}
