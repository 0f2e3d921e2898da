//! The catalogue: all signals in order, and which of them live in a given byte. Built once per process.

use std::sync::LazyLock;

use zerocopy::IntoBytes;

use super::places::{length, place};
use super::{
    AxisFromNck, AxisToNck, Block, ChannelFromNck, ChannelHmi, ChannelToNck, Format, FromNck, Hmi, Kind, Location,
    ModeGroupFromNck, ModeGroupHmi, ModeGroupToNck, NckFromNck, NckHmi, NckToNck, Part, Signal, ToNck,
};

/// One byte of the interface: where STEP 7 sees it, and what lives there.
#[derive(Clone, Copy, Debug)]
pub struct ByteSignals {
    /// The kind of block.
    pub block: Block,
    /// Its number, from one.
    pub number: u8,
    /// The data block of the 840D sl.
    pub data_block: u16,
    /// The byte in the data block.
    pub byte: u16,
    /// The signals that touch the byte, lowest bit first.
    pub signals: &'static [&'static Signal],
}

static SIGNALS: LazyLock<Vec<&'static Signal>> = LazyLock::new(|| {
    let runs = [
        NckToNck::SIGNALS,
        NckFromNck::SIGNALS,
        NckHmi::SIGNALS,
        ModeGroupToNck::SIGNALS,
        ModeGroupHmi::SIGNALS,
        ModeGroupFromNck::SIGNALS,
        ChannelToNck::SIGNALS,
        ChannelHmi::SIGNALS,
        ChannelFromNck::SIGNALS,
        AxisToNck::SIGNALS,
        AxisFromNck::SIGNALS,
    ];
    let mut all: Vec<&Signal> = runs.into_iter().flatten().collect();
    all.sort_by_key(|signal| (signal.block, signal.byte, signal.bit));
    all
});

/// All signals of the interface, in order of block, byte and bit.
pub fn signals() -> impl Iterator<Item = &'static Signal> {
    SIGNALS.iter().copied()
}

/// For one block of each kind, the signals that touch each byte.
static BY_BYTE: LazyLock<[Vec<Vec<&'static Signal>>; 4]> = LazyLock::new(|| {
    [Block::Nck, Block::ModeGroup, Block::Channel, Block::Axis].map(|block| {
        let mut bytes = vec![Vec::new(); length(block).into()];
        for signal in signals().filter(|signal| signal.block == block) {
            for byte in 0..usize::from(signal.kind.width().div_ceil(8)) {
                bytes[usize::from(signal.byte) + byte].push(signal);
            }
        }
        bytes
    })
});

/// For each byte of the three parts, what STEP 7 sees there; `None` in the gap that belongs to the HMI.
static BY_PART: LazyLock<[Vec<Option<ByteSignals>>; 3]> = LazyLock::new(|| {
    let lengths = [size_of::<ToNck>(), size_of::<FromNck>(), size_of::<Hmi>()];
    let mut parts = lengths.map(|length| vec![None; length]);
    for block in [Block::Nck, Block::ModeGroup, Block::Channel, Block::Axis] {
        let data_blocks = if block == Block::ModeGroup { 1 } else { block.count() };
        for index in 1..=data_blocks {
            for byte in 0..length(block) {
                let run = place(block, index, byte).expect("the byte is below the length");
                let part = index_of(run.part).expect("interface blocks lie in the three parts");
                parts[part][run.offset as usize] = Some(byte_signals(block, index, byte));
            }
        }
    }
    parts
});

fn byte_signals(block: Block, index: u8, byte: u16) -> ByteSignals {
    let second = block == Block::ModeGroup && byte >= 20;
    let (number, own) = if second { (2, byte - 20) } else { (index, byte) };
    let signals = &BY_BYTE[block as usize][usize::from(own)];
    ByteSignals { block, number, data_block: block.data_block(index), byte, signals }
}

fn index_of(part: Part) -> Option<usize> {
    match part {
        Part::ToNck => Some(0),
        Part::FromNck => Some(1),
        Part::Hmi => Some(2),
        Part::Inputs | Part::Outputs | Part::Flags | Part::Timers | Part::Counters | Part::Block(_) => None,
    }
}

/// Which byte of which data block a byte of a part is, and the signals that touch it; `None` for parts outside the
/// interface, beyond the end, and for the bytes of [`FromNck`] in DB10 whose place the HMI's bytes take.
#[must_use]
pub fn signals_at(part: Part, offset: u32) -> Option<ByteSignals> {
    *BY_PART[index_of(part)?].get(offset as usize)?
}

/// The signals that share a bit with a place.
pub(super) fn touching(location: Location) -> impl Iterator<Item = (u8, &'static Signal)> {
    let bytes = (0..location.bytes()).filter_map(move |byte| signals_at(location.part, location.offset + byte));
    let all = bytes.flat_map(|byte| byte.signals.iter().map(move |signal| (byte.number, *signal)));
    all.filter(move |(number, signal)| signal.location(*number).is_some_and(|other| other.overlaps(location)))
}

/// How a number at a place is read when nothing else is said: REAL where the catalogue has a REAL.
pub(super) fn usual_format(location: Location) -> Format {
    let is_real = touching(location).any(|(number, signal)| {
        let same = |other: Location| (other.offset, other.width) == (location.offset, location.width);
        signal.kind == Kind::Real && signal.location(number).is_some_and(same)
    });
    if is_real { Format::Real } else { Format::Unsigned }
}

/// Which bits of each byte of [`FromNck`] have a name.
static NAMED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let mut named = vec![0; size_of::<FromNck>()];
    for (offset, mask) in named.iter_mut().enumerate() {
        let Some(found) = u32::try_from(offset).ok().and_then(|offset| signals_at(Part::FromNck, offset)) else {
            continue;
        };
        for bit in 0..8_u8 {
            let here = |signal: &&Signal| match signal.kind.width() {
                width @ 1..=7 => (signal.bit..signal.bit + width).contains(&bit),
                _ => true,
            };
            *mask |= u8::from(found.signals.iter().any(here)) << bit;
        }
    }
    named
});

/// Sets every signal of the NCK to 0 and leaves plain memory alone: the control publishes anew what somebody else overwrote.
pub fn clear_signals(from_nck: &mut FromNck) {
    for (byte, named) in from_nck.as_mut_bytes().iter_mut().zip(NAMED.iter()) {
        *byte &= !named;
    }
}
