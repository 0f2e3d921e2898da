//! The memory of a machine as a program sees it in one scan: the interface data blocks are the bytes of the interface, by writer; all other
//! areas and data blocks are those of the PLC.
//!
//! A program reads every byte and writes those of the PLC. What it writes to a byte of the control or of the HMI is lost, as on a control,
//! where the next transfer overwrites it. Inputs that it writes keep the value until the end of the scan.

use crate::image::{AsBytes, Blocks, Bytes, DataBlock, Memory, Names, Part};
use crate::plc::{Link, NcServices, PlcIo};
use crate::units::Time;

use super::engine::{Area, Areas, OpenBlock};

/// Where the data blocks of a machine are. It is made once, when the program is loaded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Map {
    /// For each number its slot and 1, or 0.
    slots: Vec<u32>,
    /// The bytes of the interface data blocks.
    interface: Vec<Vec<Byte>>,
}

/// A byte of an interface data block: the part, the place in it, and the bytes that follow it there and in the data block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Byte {
    side: Side,
    offset: u32,
    left: u32,
}

/// The writer of a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Plc,
    Control,
    Hmi,
    /// The byte does not exist.
    Nowhere,
}

/// A slot of an interface data block.
const INTERFACE: u32 = 1 << 31;

impl Map {
    /// The data blocks of a memory and of the interface of a machine.
    pub(super) fn new(memory: &Memory, names: &Names) -> Self {
        let mut map = Self::default();
        for number in names.profile.data_blocks() {
            let slot = u32::try_from(map.interface.len()).unwrap_or(0);
            map.enter(number, INTERFACE | slot);
            map.interface.push(bytes(&names.profile.places(number)));
        }
        // A block of the program wins: it has the number of an axis or a channel that the machine does not have (P-151).
        for (place, block) in memory.blocks.iter().enumerate() {
            map.enter(block.number, u32::try_from(place).unwrap_or(u32::MAX));
        }
        map
    }

    /// The part and the byte of a byte of a data block.
    pub(super) fn place(&self, number: u16, byte: u32) -> Option<(Part, u32)> {
        // A block that the program has made has no slot.
        let slot = self.slots.get(usize::from(number)).copied().unwrap_or(0).saturating_sub(1);
        let Some(slot) = slot.checked_sub(INTERFACE) else { return Some((Part::Block(number), byte)) };
        let byte = self.interface.get(slot as usize)?.get(byte as usize)?;
        let part = match byte.side {
            Side::Plc => Part::ToNck,
            Side::Control => Part::FromNck,
            Side::Hmi => Part::Hmi,
            Side::Nowhere => return None,
        };
        Some((part, byte.offset))
    }

    fn enter(&mut self, number: u16, slot: u32) {
        let index = usize::from(number);
        if self.slots.len() <= index {
            self.slots.resize(index + 1, 0);
        }
        self.slots[index] = slot + 1;
    }
}

fn bytes(places: &[Option<(Part, u32)>]) -> Vec<Byte> {
    let mut bytes: Vec<Byte> = Vec::with_capacity(places.len());
    for place in places.iter().rev() {
        let (side, offset) = match *place {
            Some((Part::ToNck, offset)) => (Side::Plc, offset),
            Some((Part::FromNck, offset)) => (Side::Control, offset),
            Some((Part::Hmi, offset)) => (Side::Hmi, offset),
            _ => (Side::Nowhere, 0),
        };
        let next = bytes.last().filter(|next| next.side == side && next.offset == offset + 1);
        let left = next.map_or(1, |next| next.left + 1);
        bytes.push(Byte { side, offset, left });
    }
    bytes.reverse();
    bytes
}

/// The memory during one scan.
pub(super) struct View<'a> {
    map: &'a Map,
    to_nck: &'a mut [u8],
    from_nck: &'a [u8],
    hmi: &'a [u8],
    inputs: &'a mut [u8],
    outputs: &'a mut [u8],
    flags: &'a mut [u8],
    blocks: &'a mut Blocks,
    time: Time,
    names: &'a Names,
    nc: &'a mut dyn NcServices,
}

impl<'a> View<'a> {
    /// A view of a memory; `inputs` is the process image of the inputs, which is read here.
    pub(super) fn new<'io: 'a>(map: &'a Map, io: &'a mut PlcIo<'io, AsBytes>, inputs: &'a mut Vec<u8>) -> Self {
        inputs.clear();
        inputs.extend_from_slice(io.inputs);
        Self {
            map,
            to_nck: io.to_nck,
            from_nck: io.from_nck,
            hmi: io.hmi,
            inputs,
            outputs: io.outputs,
            flags: io.flags,
            blocks: io.blocks,
            time: io.time,
            names: io.names,
            nc: io.nc,
        }
    }

    fn side(&self, side: Side) -> &[u8] {
        match side {
            Side::Plc => self.to_nck,
            Side::Control => self.from_nck,
            Side::Hmi => self.hmi,
            Side::Nowhere => &[],
        }
    }

    fn own(&self, block: OpenBlock) -> Option<&[u8]> {
        self.blocks.at(self.place_of(block)?).map(|bytes| &**bytes)
    }

    /// The place of a data block in the list: its slot, unless the program has made another block before it.
    fn place_of(&self, block: OpenBlock) -> Option<usize> {
        let slot = block.slot as usize;
        if self.blocks.number_at(slot) == Some(block.number) { Some(slot) } else { self.blocks.place(block.number) }
    }

    fn interface(&self, block: OpenBlock) -> Option<&'a [Byte]> {
        let slot = block.slot.checked_sub(INTERFACE)?;
        self.map.interface.get(slot as usize).map(Vec::as_slice)
    }
}

impl Areas for View<'_> {
    #[inline]
    fn bytes(&self, area: Area) -> &[u8] {
        match area {
            Area::Inputs => self.inputs,
            Area::Outputs => self.outputs,
            Area::Flags => self.flags,
        }
    }

    #[inline]
    fn bytes_mut(&mut self, area: Area) -> &mut [u8] {
        match area {
            Area::Inputs => self.inputs,
            Area::Outputs => self.outputs,
            Area::Flags => self.flags,
        }
    }

    fn block(&self, number: u16) -> Option<OpenBlock> {
        let slot = match self.map.slots.get(usize::from(number)).copied().unwrap_or(0).checked_sub(1) {
            Some(slot) => slot,
            None => u32::try_from(self.blocks.place(number)?).ok()?,
        };
        let block = OpenBlock { number, slot, length: 0 };
        let length = match self.interface(block) {
            Some(bytes) => bytes.len(),
            None => self.own(block)?.len(),
        };
        Some(OpenBlock { length: u32::try_from(length).ok()?, ..block })
    }

    fn link(&mut self) -> Option<Link<'_>> {
        let bytes = (&mut *self.to_nck, self.from_nck, self.hmi);
        Link::of_bytes(bytes, self.blocks, (self.time, self.names), self.nc)
    }

    fn create(&mut self, number: u16, length: u16) -> bool {
        if self.block(number).is_some() {
            return false;
        }
        self.blocks.put(DataBlock { number, name: None, bytes: Bytes::from(vec![0; length.into()]) });
        true
    }

    fn delete(&mut self, number: u16) -> bool {
        let is_loaded = self.map.slots.get(usize::from(number)).is_some_and(|slot| *slot != 0);
        !is_loaded && self.blocks.remove(number)
    }

    fn is_interface(&self, block: OpenBlock) -> bool {
        block.slot & INTERFACE != 0
    }

    fn read<const N: usize>(&self, block: OpenBlock, byte: u32) -> Option<[u8; N]> {
        let Some(bytes) = self.interface(block) else {
            return self.own(block)?.get(byte as usize..)?.first_chunk().copied();
        };
        let first = bytes.get(byte as usize)?;
        if first.left as usize >= N && first.side != Side::Nowhere {
            return self.side(first.side).get(first.offset as usize..)?.first_chunk().copied();
        }
        let mut value = [0; N];
        for (index, value) in value.iter_mut().enumerate() {
            let byte = bytes.get(byte as usize + index)?;
            *value = *self.side(byte.side).get(byte.offset as usize)?;
        }
        Some(value)
    }

    fn write<const N: usize>(&mut self, block: OpenBlock, byte: u32, value: [u8; N]) -> Option<()> {
        let Some(bytes) = self.interface(block) else {
            // Forks share a block until it is written to, so one that does not change is left alone.
            if self.own(block)?.get(byte as usize..)?.first_chunk::<N>()? != &value {
                let place = self.place_of(block)?;
                *self.blocks.at_mut(place)?.get_mut(byte as usize..)?.first_chunk_mut()? = value;
            }
            return Some(());
        };
        let places = bytes.get(byte as usize..)?.get(..N)?;
        if places.iter().any(|place| place.side == Side::Nowhere) {
            return None;
        }
        for (place, value) in places.iter().zip(value) {
            if place.side == Side::Plc {
                *self.to_nck.get_mut(place.offset as usize)? = value;
            }
        }
        Some(())
    }
}
