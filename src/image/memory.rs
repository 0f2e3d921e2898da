//! The memory of one control: the interface by writer, and the areas of the PLC program.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::source::Problem;

use super::interface::Run;
use super::{Address, Area, Bytes, Format, Interface, Location, Part, PartBytes, Profile, Width};

/// A data block of the PLC program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DataBlock {
    /// The number of the block.
    pub number: u16,
    /// The name of the block, for display.
    pub name: Option<Arc<str>>,
    /// The bytes of the block.
    pub bytes: Bytes,
}

/// The data blocks of the PLC program, ascending by number.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Blocks(Vec<DataBlock>);

impl Blocks {
    /// All blocks, ascending by number.
    pub fn iter(&self) -> impl Iterator<Item = &DataBlock> {
        self.0.iter()
    }

    /// Whether the block at a place in the list may have been written to since this was last asked.
    pub(crate) fn take_written(&mut self, index: usize) -> bool {
        self.0.get_mut(index).is_some_and(|block| block.bytes.take_written())
    }

    /// The bytes of a block.
    #[must_use]
    pub fn get(&self, number: u16) -> Option<&Bytes> {
        let index = self.0.binary_search_by_key(&number, |block| block.number).ok()?;
        Some(&self.0[index].bytes)
    }

    /// The bytes of a block, mutable.
    pub fn get_mut(&mut self, number: u16) -> Option<&mut Bytes> {
        let index = self.0.binary_search_by_key(&number, |block| block.number).ok()?;
        Some(&mut self.0[index].bytes)
    }

    /// The place of a block in the list, which stays while no block is added.
    #[must_use]
    pub fn place(&self, number: u16) -> Option<usize> {
        self.0.binary_search_by_key(&number, |block| block.number).ok()
    }

    /// The number of the block at a place of the list.
    #[must_use]
    pub fn number_at(&self, place: usize) -> Option<u16> {
        self.0.get(place).map(|block| block.number)
    }

    /// The bytes of the block at a place of the list.
    #[must_use]
    pub fn at(&self, place: usize) -> Option<&Bytes> {
        self.0.get(place).map(|block| &block.bytes)
    }

    /// The bytes of the block at a place of the list, mutable.
    pub fn at_mut(&mut self, place: usize) -> Option<&mut Bytes> {
        self.0.get_mut(place).map(|block| &mut block.bytes)
    }

    /// Removes a block; `false` if there is none with this number.
    pub fn remove(&mut self, number: u16) -> bool {
        let place = self.place(number);
        place.map(|place| self.0.remove(place)).is_some()
    }

    /// Adds a block and replaces a block with the same number.
    pub fn put(&mut self, block: DataBlock) {
        match self.0.binary_search_by_key(&block.number, |other| other.number) {
            Ok(index) => self.0[index] = block,
            Err(index) => self.0.insert(index, block),
        }
    }
}

/// The memory that PLC programs, HMIs and the NCK share. A clone shares the plain areas until one of the copies is written.
///
/// The parts of the interface are bytes. [`to_nck`](Memory::to_nck()) and similar methods show them as structures of the SINUMERIK; the
/// [`Interface`] describes their contents for any control.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// The signals that the PLC writes to the NCK.
    pub to_nck: PartBytes,
    /// The signals that the NCK writes.
    pub from_nck: PartBytes,
    /// The signals that the HMI writes.
    pub hmi: PartBytes,
    /// Inputs (I).
    pub inputs: Bytes,
    /// Outputs (Q).
    pub outputs: Bytes,
    /// Flags (M).
    pub flags: Bytes,
    /// Timers (T), two bytes each.
    pub timers: Bytes,
    /// Counters (C), two bytes each.
    pub counters: Bytes,
    /// The data blocks of the PLC program.
    pub blocks: Blocks,
}

/// Access to the memory by writer, for all types that contain it.
pub trait Parts {
    /// The bytes of a part; empty for a block that does not exist.
    fn part(&self, part: Part) -> &[u8];

    /// The bytes of a part, mutable; empty if the part must not be written.
    fn part_mut(&mut self, part: Part) -> &mut [u8];
}

impl Parts for Memory {
    fn part(&self, part: Part) -> &[u8] {
        Self::part(self, part)
    }

    fn part_mut(&mut self, part: Part) -> &mut [u8] {
        Self::part_mut(self, part)
    }
}

impl Memory {
    /// The number of bytes of each standard block of an interface.
    pub const STANDARD_LENGTH: usize = 256;

    /// A memory of zeros: the interface, M 256, I 128, Q 128, T 64, C 64 bytes, and the standard blocks (O-24).
    #[must_use]
    pub fn of(interface: &Interface) -> Self {
        let block = |&number| DataBlock { number, name: None, bytes: Bytes::zeroed(Self::STANDARD_LENGTH) };
        let tables = interface.tables();
        let mut standard: Vec<_> = tables.standard_blocks.iter().map(block).collect();
        standard.sort_by_key(|block| block.number);
        Self {
            to_nck: PartBytes::zeroed(tables.to_nck),
            from_nck: PartBytes::zeroed(tables.from_nck),
            hmi: PartBytes::zeroed(tables.hmi),
            inputs: Bytes::zeroed(128),
            outputs: Bytes::zeroed(128),
            flags: Bytes::zeroed(256),
            timers: Bytes::zeroed(64),
            counters: Bytes::zeroed(64),
            blocks: Blocks(standard),
        }
    }

    /// Whether its parts have the lengths that an interface defines.
    #[must_use]
    pub fn fits(&self, interface: &Interface) -> bool {
        let tables = interface.tables();
        (self.to_nck.len(), self.from_nck.len(), self.hmi.len()) == (tables.to_nck, tables.from_nck, tables.hmi)
    }

    /// The bytes of a part; empty for a block that does not exist.
    #[must_use]
    pub fn part(&self, part: Part) -> &[u8] {
        match part {
            Part::ToNck => &self.to_nck,
            Part::FromNck => &self.from_nck,
            Part::Hmi => &self.hmi,
            Part::Inputs => &self.inputs,
            Part::Outputs => &self.outputs,
            Part::Flags => &self.flags,
            Part::Timers => &self.timers,
            Part::Counters => &self.counters,
            Part::Block(number) => self.blocks.get(number).map_or(&[], |bytes| bytes),
        }
    }

    /// The bytes of a part, mutable.
    pub fn part_mut(&mut self, part: Part) -> &mut [u8] {
        match part {
            Part::ToNck => &mut self.to_nck,
            Part::FromNck => &mut self.from_nck,
            Part::Hmi => &mut self.hmi,
            Part::Inputs => &mut self.inputs,
            Part::Outputs => &mut self.outputs,
            Part::Flags => &mut self.flags,
            Part::Timers => &mut self.timers,
            Part::Counters => &mut self.counters,
            Part::Block(number) => self.blocks.get_mut(number).map_or(&mut [], |bytes| bytes),
        }
    }

    /// The location of an address.
    ///
    /// # Errors
    /// The data block does not exist, the address is beyond its end, or it spans bytes of two writers.
    pub fn locate(&self, address: &Address, profile: Profile) -> Result<Location, Problem> {
        let (bit, width) = match address.width {
            Width::Bit(bit) => (bit, 1),
            Width::Bits { first, last } => (first, last - first + 1),
            Width::Byte => (0, 8),
            Width::Word => (0, 16),
            Width::Double => (0, 32),
        };
        let byte = match address.area {
            Area::Timers | Area::Counters => u32::from(address.byte) * 2,
            _ => u32::from(address.byte),
        };
        let bytes = u32::from(width).div_ceil(8);
        let run = self
            .run(address.area, byte, bytes, profile)
            .map_err(|problem| Problem { what: format!("{address}: {}", problem.what), ..problem })?;
        if run.left < bytes {
            return Err(Problem::new(format!("{address} spans bytes of two writers"), "read or write single bytes"));
        }
        let mut location = Location { part: run.part, offset: run.offset, bit, width, format: Format::Unsigned };
        location.format = address.format.unwrap_or_else(|| profile.interface().usual_format(location));
        Ok(location)
    }

    /// Whether it contains a location.
    #[must_use]
    pub fn contains(&self, location: Location) -> bool {
        let end = u64::from(location.offset) + u64::from(location.bytes());
        location.is_well_formed() && end <= self.part(location.part).len() as u64
    }

    /// The raw bits at a location; 0 if this memory does not contain it.
    #[must_use]
    pub fn read(&self, location: Location) -> u64 {
        let start = location.offset as usize;
        let bytes = self.part(location.part).get(start..start + location.bytes() as usize).unwrap_or(&[]);
        let number = bytes.iter().fold(0, |number, &byte| number << 8 | u64::from(byte));
        number >> location.bit & location.mask()
    }

    /// The number at a location, in the number format of the location.
    #[must_use]
    pub fn value(&self, location: Location) -> f64 {
        location.number(self.read(location))
    }

    /// Writes raw bits to a location. Bits that do not fit are dropped. It has no effect if this memory does not contain the location.
    #[expect(clippy::cast_possible_truncation, reason = "each byte is extracted on purpose")]
    pub fn write(&mut self, location: Location, raw: u64) {
        if self.read(location) == raw & location.mask() {
            return; // a clone that shares the bytes keeps sharing them
        }
        let (start, count) = (location.offset as usize, location.bytes() as usize);
        let Some(bytes) = self.part_mut(location.part).get_mut(start..start + count) else {
            return;
        };
        let (mask, raw) = (location.mask() << location.bit, raw << location.bit);
        for (index, byte) in bytes.iter_mut().rev().enumerate() {
            let (mask, raw) = ((mask >> (8 * index)) as u8, (raw >> (8 * index)) as u8);
            *byte = *byte & !mask | raw & mask;
        }
    }

    /// Copies bytes of an area or a data block, as an S7 client reads them.
    ///
    /// # Errors
    /// The data block does not exist, or it ends before the last byte; `into` is then unchanged or partly filled.
    pub fn read_bytes(&self, area: Area, start: u32, into: &mut [u8], profile: Profile) -> Result<(), Problem> {
        let mut done = 0;
        while done < into.len() {
            let run = self.run_of(area, start, done, into.len(), profile)?;
            let count = (run.left as usize).min(into.len() - done);
            let from = run.offset as usize;
            into[done..done + count].copy_from_slice(&self.part(run.part)[from..from + count]);
            done += count;
        }
        Ok(())
    }

    /// Writes bytes of an area or a data block, as an S7 client writes them, regardless of the writer of the bytes.
    ///
    /// # Errors
    /// The data block does not exist, or it ends before the last byte; nothing is then written.
    pub fn write_bytes(&mut self, area: Area, start: u32, bytes: &[u8], profile: Profile) -> Result<(), Problem> {
        for write in [false, true] {
            let mut done = 0;
            while done < bytes.len() {
                let run = self.run_of(area, start, done, bytes.len(), profile)?;
                let count = (run.left as usize).min(bytes.len() - done);
                if write {
                    let to = run.offset as usize;
                    self.part_mut(run.part)[to..to + count].copy_from_slice(&bytes[done..done + count]);
                }
                done += count;
            }
        }
        Ok(())
    }

    fn run_of(&self, area: Area, start: u32, done: usize, length: usize, profile: Profile) -> Result<Run, Problem> {
        let (done, length) = (u32::try_from(done), u32::try_from(length));
        let (Ok(done), Ok(length)) = (done, length) else {
            return Err(Problem::new("expected at most 65536 bytes at once, found more", "access fewer bytes at once"));
        };
        self.run(area, start.saturating_add(done), length - done, profile)
    }
}
