//! An interface as data: its kinds of block, the owner of every byte, its signals and its names. Each control provides one. All other
//! files of this module use it and are independent of the control.

use std::fmt;
use std::sync::OnceLock;

use crate::units::{AxisNumber, AxisSet};

use super::{Block, Format, Kind, Location, Numbering, Part, Signal, UnitElements, ValueTerms, Writer};

/// The description of an interface, provided by a control.
#[derive(Debug)]
pub struct Tables {
    /// The name of the interface in saved machines.
    pub name: &'static str,
    /// The kinds of block, each once, in the order of [`Block`].
    pub blocks: &'static [BlockTable],
    /// The signals, run by run.
    pub signals: &'static [&'static [Signal]],
    /// The number of bytes that the PLC writes, including the plain bytes of the blocks.
    pub to_nck: usize,
    /// The number of bytes that the NCK writes.
    pub from_nck: usize,
    /// The number of bytes that the HMI writes.
    pub hmi: usize,
    /// The numberings of the data blocks for the PLC; the first is the default.
    pub numberings: &'static [Numbering],
    /// Data blocks of the basic program of the control. They exist as plain memory unless a PLC image declares them.
    pub standard_blocks: &'static [u16],
    /// The bytes that accept a percentage of an override switch.
    pub overrides: &'static [(Signal, Override)],
    /// Signals of an axis that the plant sets if a switch is not wired to an input.
    pub switches: Option<SwitchSignals>,
    /// How the signals of a control unit are named; `None` without control units.
    pub units: Option<UnitElements>,
    /// The machine data that name axes and channels, for the remedy in error messages.
    pub named_in: &'static str,
    /// An example of a symbol, for the remedy in error messages.
    pub example: &'static str,
    /// How the control names and shows the values of its axes.
    pub values: ValueTerms,
}

/// One kind of block: the bytes of one axis, one channel and so on.
#[derive(Debug)]
pub struct BlockTable {
    /// The kind.
    pub block: Block,
    /// The number of blocks of this kind.
    pub count: u8,
    /// The names before the point of a symbol, one per block; empty if the machine defines the names.
    pub names: &'static [&'static str],
    /// The term for one block in messages: `axis`; with its article if only one block exists.
    pub called: &'static str,
    /// The distance in bytes of blocks that share one data block; `None` if each block has its own data block.
    pub apart: Option<u16>,
    /// The bytes of the block, ascending and without gaps.
    pub ranges: &'static [ByteRange],
}

/// One range of a block: bytes `first` to `last` are stored in a part from `base` on, `stride` bytes apart for each block.
#[derive(Debug)]
pub struct ByteRange {
    first: u16,
    last: u16,
    part: Part,
    base: usize,
    stride: usize,
    is_plain: bool,
}

impl ByteRange {
    /// A range with signals, in the part of their writer.
    #[must_use]
    pub const fn signals(first: u16, last: u16, part: Part, base: usize, stride: usize) -> Self {
        Self { first, last, part, base, stride, is_plain: false }
    }

    /// A range without signals: plain memory in [`Part::ToNck`] that every program can use.
    #[must_use]
    pub const fn plain(first: u16, last: u16, base: usize, stride: usize) -> Self {
        Self { first, last, part: Part::ToNck, base, stride, is_plain: true }
    }

    const fn length(&self) -> usize {
        (self.last - self.first) as usize + 1
    }
}

/// The object of an override switch. [`OverrideCoding`](super::OverrideCoding) defines its coding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Override {
    /// The feed of an axis.
    Axis,
    /// The feed of a channel.
    Feed,
    /// Rapid traverse of a channel.
    RapidTraverse,
    /// The speed of a spindle.
    Spindle,
}

/// The signals of an axis that its switches set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SwitchSignals {
    /// Reference cam.
    pub cam: Signal,
    /// Hardware limit switch in the positive direction.
    pub limit_plus: Signal,
    /// Hardware limit switch in the negative direction.
    pub limit_minus: Signal,
}

/// Adjacent bytes in one part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    /// The part.
    pub(super) part: Part,
    /// The first byte in the part.
    pub(super) offset: u32,
    /// The number of adjacent bytes, including the first one.
    pub(super) left: u32,
}

/// One byte of the interface: its block and its signals.
#[derive(Clone, Copy, Debug)]
pub struct ByteSignals {
    /// The kind of block.
    pub block: Block,
    /// Its number, from one.
    pub number: u8,
    /// The byte in the block, counted from the start of the block.
    pub byte: u16,
    /// The signals that use the byte, lowest bit first.
    pub signals: &'static [&'static Signal],
}

/// The interface of a control. A process has one instance per control, so interfaces are compared by their address.
pub struct Interface {
    tables: Tables,
    index: OnceLock<Index>,
}

impl PartialEq for Interface {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Eq for Interface {}

impl fmt::Debug for Interface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.tables.name)
    }
}

/// Search results that are computed once: the signals at each position.
struct Index {
    /// All signals in order of block, byte and bit.
    signals: Vec<&'static Signal>,
    /// For each kind of block, the signals that use each of its bytes.
    by_byte: Vec<Vec<Vec<&'static Signal>>>,
    /// For each byte of the three parts: the index of its kind of block, the number of the block, and its byte there.
    by_part: [Vec<Option<(usize, u8, u16)>>; 3],
    /// For each byte of the part of the NCK, the bits that have a name.
    named: Vec<u8>,
    /// The positions of the PLC signals: those of one axis, or those without an axis.
    plc_runs: Vec<PlcRun>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct PlcRun {
    axis: Option<AxisNumber>,
    start: usize,
    end: usize,
}

impl Interface {
    /// Makes an interface from its tables.
    ///
    /// # Panics
    /// At compile time, if it is a static: ranges have gaps or exceed their part, a signal is outside its block or in the part of another
    /// writer, or a kind of block names only some of its blocks.
    #[must_use]
    pub const fn new(tables: Tables) -> Self {
        assert!(!tables.numberings.is_empty(), "an interface has at least one numbering");
        let mut index = 0;
        while index < tables.blocks.len() {
            check_block(&tables, &tables.blocks[index]);
            index += 1;
        }
        let mut run = 0;
        while run < tables.signals.len() {
            let mut row = 0;
            while row < tables.signals[run].len() {
                check_signal(&tables, &tables.signals[run][row]);
                row += 1;
            }
            run += 1;
        }
        if let Some(SwitchSignals { cam, limit_plus, limit_minus }) = tables.switches {
            assert!(is_of_the_plc(cam) && is_of_the_plc(limit_plus) && is_of_the_plc(limit_minus));
        }
        Self { tables, index: OnceLock::new() }
    }

    /// The tables of the interface.
    #[must_use]
    pub fn tables(&self) -> &Tables {
        &self.tables
    }

    /// How the control names and shows values of its axes.
    #[must_use]
    pub const fn values(&self) -> &ValueTerms {
        &self.tables.values
    }

    /// The number of blocks of a kind.
    #[must_use]
    pub fn count(&self, block: Block) -> u8 {
        self.table(block).map_or(0, |table| table.count)
    }

    /// The fixed name of a block, if it has one.
    #[must_use]
    pub fn fixed_name(&self, block: Block, number: u8) -> Option<&'static str> {
        let index = usize::from(number).checked_sub(1)?;
        self.table(block)?.names.get(index).copied()
    }

    /// The term for a block in messages.
    pub(super) fn described(&self, block: Block, number: u8) -> String {
        match self.table(block) {
            Some(table) if table.count == 1 => table.called.to_owned(),
            Some(table) => format!("{} {number}", table.called),
            None => format!("block {number}"),
        }
    }

    /// All signals, in order of block, byte and bit.
    pub fn signals(&'static self) -> impl Iterator<Item = &'static Signal> {
        self.index().signals.iter().copied()
    }

    /// The location of a signal in block number `number` of its kind, counted from one; `None` if the block does not exist.
    #[must_use]
    pub fn location(&self, signal: &Signal, number: u8) -> Option<Location> {
        if number == 0 || number > self.count(signal.block) {
            return None;
        }
        let (index, byte) = self.shared(signal.block, number, signal.byte);
        let run = self.place(signal.block, index, byte)?;
        let format = if signal.kind == Kind::Real { Format::Real } else { Format::Unsigned };
        let (bit, width) = (signal.bit, signal.kind.width());
        Some(Location { part: run.part, offset: run.offset, bit, width, format })
    }

    /// The block and byte of a byte of a part, and the signals that use it. `None` for parts outside the interface, beyond the end, and for
    /// bytes that belong to no block.
    #[must_use]
    pub fn signals_at(&'static self, part: Part, offset: u32) -> Option<ByteSignals> {
        let index = self.index();
        let (kind, number, byte) = (*index.by_part[index_of(part)?].get(offset as usize)?)?;
        let signals = &index.by_byte[kind][usize::from(byte)];
        Some(ByteSignals { block: self.tables.blocks[kind].block, number, byte, signals })
    }

    /// The signals that share a bit with a location, with the numbers of their blocks.
    pub fn touching(&'static self, location: Location) -> impl Iterator<Item = (u8, &'static Signal)> {
        let at = move |byte| self.signals_at(location.part, location.offset + byte);
        let bytes = (0..location.bytes()).filter_map(at);
        let all = bytes.flat_map(|byte| byte.signals.iter().map(move |signal| (byte.number, *signal)));
        all.filter(move |(number, signal)| self.location(signal, *number).is_some_and(|other| other.overlaps(location)))
    }

    /// The signal with exactly this location, with the number of its block.
    pub(super) fn exactly(&'static self, location: Location) -> Option<(u8, &'static Signal)> {
        self.touching(location).find(|(number, signal)| {
            let place = |l: Location| (l.part, l.offset, l.bit, l.width);
            self.location(signal, *number).map(place) == Some(place(location))
        })
    }

    /// The meaning of the signal with exactly this location, with its 1 and 0.
    #[must_use]
    pub fn meaning(&'static self, location: Location) -> Option<&'static str> {
        self.exactly(location).map(|(_, signal)| signal.doc)
    }

    /// The default number format of a location: REAL if the tables define a REAL there.
    pub(super) fn usual_format(&'static self, location: Location) -> Format {
        let is_real = self.touching(location).any(|(number, signal)| {
            let same = |other: Location| (other.offset, other.width) == (location.offset, location.width);
            signal.kind == Kind::Real && self.location(signal, number).is_some_and(same)
        });
        if is_real { Format::Real } else { Format::Unsigned }
    }

    /// Sets every signal of the NCK to 0 and keeps plain memory unchanged. The control then publishes all signals again, including those
    /// that a client has overwritten.
    pub fn clear_signals(&'static self, from_nck: &mut [u8]) {
        for (byte, named) in from_nck.iter_mut().zip(self.index().named.iter()) {
            *byte &= !named;
        }
    }

    /// The blocks in which PLC signals differ: the set of axes, and whether any other block differs.
    #[must_use]
    pub fn plc_changes(&'static self, before: &[u8], now: &[u8]) -> (AxisSet, bool) {
        let (mut axes, mut others) = (AxisSet::NONE, false);
        for run in &self.index().plc_runs {
            if before.get(run.start..run.end) != now.get(run.start..run.end) {
                match run.axis {
                    Some(axis) => axes.set(axis, true),
                    None => others = true,
                }
            }
        }
        (axes, others)
    }

    /// The position of a byte of the data block of block number `number`; `None` beyond its end. Blocks that share a data block have the
    /// number 1.
    pub(super) fn place(&self, block: Block, number: u8, byte: u16) -> Option<Run> {
        let range = self.table(block)?.ranges.iter().find(|range| range.last >= byte)?;
        let offset = range.base + range.stride * (usize::from(number) - 1) + usize::from(byte - range.first);
        let offset = u32::try_from(offset).expect("a part has only some thousand bytes");
        Some(Run { part: range.part, offset, left: u32::from(range.last - byte) + 1 })
    }

    /// The number and byte of a byte of a block in the data block that the block may share.
    pub(super) fn shared(&self, block: Block, number: u8, byte: u16) -> (u8, u16) {
        match self.table(block).and_then(|table| table.apart) {
            Some(apart) => (1, byte + apart * (u16::from(number) - 1)),
            None => (number, byte),
        }
    }

    pub(super) fn table(&self, block: Block) -> Option<&'static BlockTable> {
        self.tables.blocks.iter().find(|table| table.block == block)
    }

    fn index(&'static self) -> &'static Index {
        self.index.get_or_init(|| Index::of(self))
    }
}

impl BlockTable {
    /// The number of data blocks of this kind.
    pub(super) const fn data_blocks(&self) -> u8 {
        if self.apart.is_some() { 1 } else { self.count }
    }

    /// The number of a block, and its own byte, for a byte of a data block.
    fn own(&self, index: u8, byte: u16) -> (u8, u16) {
        match self.apart {
            Some(apart) => {
                let number = (byte / apart).min(u16::from(self.count) - 1);
                (u8::try_from(number + 1).unwrap_or(self.count), byte - apart * number)
            }
            None => (index, byte),
        }
    }
}

impl Index {
    fn of(interface: &Interface) -> Self {
        let Tables { blocks, signals, to_nck, from_nck, hmi, .. } = &interface.tables;
        let mut all: Vec<&'static Signal> = signals.iter().copied().flatten().collect();
        all.sort_by_key(|signal| (signal.block, signal.byte, signal.bit));
        let by_byte: Vec<Vec<Vec<_>>> = blocks
            .iter()
            .map(|table| {
                let mut bytes = vec![Vec::new(); length_of(table.ranges).into()];
                for signal in all.iter().filter(|signal| signal.block == table.block) {
                    for byte in 0..usize::from(signal.kind.width().div_ceil(8)) {
                        bytes[usize::from(signal.byte) + byte].push(*signal);
                    }
                }
                bytes
            })
            .collect();
        let mut by_part = [*to_nck, *from_nck, *hmi].map(|length| vec![None; length]);
        let mut plc_runs = Vec::new();
        for (kind, table) in blocks.iter().enumerate() {
            for number in 1..=table.data_blocks() {
                for byte in 0..length_of(table.ranges) {
                    let run = interface.place(table.block, number, byte).expect("the byte is below the length");
                    let part = index_of(run.part).expect("interface blocks are in the three parts");
                    let (own, own_byte) = table.own(number, byte);
                    by_part[part][run.offset as usize] = Some((kind, own, own_byte));
                }
                let of_the_plc = |range: &&ByteRange| range.part == Part::ToNck && !range.is_plain;
                plc_runs.extend(table.ranges.iter().filter(of_the_plc).map(|range| {
                    let start = range.base + range.stride * (usize::from(number) - 1);
                    let axis = if table.block == Block::Axis { AxisNumber::new(number) } else { None };
                    PlcRun { axis, start, end: start + range.length() }
                }));
            }
        }
        plc_runs.sort_by_key(|run| run.start);
        plc_runs.dedup_by(|next, last| {
            let follows = next.axis == last.axis && next.start == last.end;
            if follows {
                last.end = next.end;
            }
            follows
        });
        let named = by_part[1]
            .iter()
            .map(|place| place.map_or(0, |(kind, _, byte)| named_bits(&by_byte[kind][usize::from(byte)])));
        let named = named.collect();
        Self { signals: all, by_byte, by_part, named, plc_runs }
    }
}

/// The bits of a byte that its signals use.
fn named_bits(signals: &[&Signal]) -> u8 {
    signals.iter().fold(0, |mask, signal| match signal.kind.width() {
        width @ 1..=7 => mask | (0xFF >> (8 - width)) << signal.bit,
        _ => 0xFF,
    })
}

const fn length_of(ranges: &[ByteRange]) -> u16 {
    if ranges.is_empty() { 0 } else { ranges[ranges.len() - 1].last + 1 }
}

fn index_of(part: Part) -> Option<usize> {
    match part {
        Part::ToNck => Some(0),
        Part::FromNck => Some(1),
        Part::Hmi => Some(2),
        Part::Inputs | Part::Outputs | Part::Flags | Part::Timers | Part::Counters | Part::Block(_) => None,
    }
}

/// Checks that ranges are contiguous and inside their parts, and that all blocks of a kind have a name or none has.
const fn check_block(tables: &Tables, table: &BlockTable) {
    assert!(table.count > 0, "a kind of block has at least one block");
    assert!(
        table.names.is_empty() || table.names.len() == table.count as usize,
        "all blocks of a kind have a fixed name, or none has"
    );
    let (mut index, mut next) = (0, 0);
    while index < table.ranges.len() {
        let range = &table.ranges[index];
        assert!(range.first == next && range.last >= next, "ranges must be contiguous");
        let length = match range.part {
            Part::ToNck => tables.to_nck,
            Part::FromNck => tables.from_nck,
            Part::Hmi => tables.hmi,
            _ => panic!("an interface block must be in the three parts by writer"),
        };
        let last_block = range.base + range.stride * (table.data_blocks() as usize - 1);
        assert!(last_block + range.length() <= length, "a range exceeds its part");
        next = range.last + 1;
        index += 1;
    }
}

/// Whether the signal is a bit of an axis that the PLC writes.
const fn is_of_the_plc(signal: Signal) -> bool {
    matches!((signal.block, signal.writer, signal.kind), (Block::Axis, Writer::Plc, Kind::Bit))
}

/// Checks that a signal is in one range of its block, in the part of its writer.
const fn check_signal(tables: &Tables, signal: &Signal) {
    let mut kind = 0;
    while tables.blocks[kind].block as u8 != signal.block as u8 {
        kind += 1;
        assert!(kind < tables.blocks.len(), "the interface does not have the kind of block of a signal");
    }
    let ranges = tables.blocks[kind].ranges;
    let mut index = 0;
    while ranges[index].last < signal.byte {
        index += 1;
        assert!(index < ranges.len(), "a signal is beyond the end of its block");
    }
    let range = &ranges[index];
    let bytes = signal.kind.width().div_ceil(8) as u16;
    assert!(signal.byte + bytes - 1 <= range.last, "a signal exceeds its range");
    let of_its_writer = matches!(
        (signal.writer, range.part),
        (Writer::Plc, Part::ToNck) | (Writer::Nck, Part::FromNck) | (Writer::Hmi, Part::Hmi)
    );
    assert!(of_its_writer && !range.is_plain, "a signal is in the bytes of another writer");
}
