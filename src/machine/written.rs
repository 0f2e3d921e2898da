//! The writes from outside in a step, by location. The writer is looked up for each bit that changed, and a client may write
//! thousands of bytes at once.

use serde::{Deserialize, Serialize};

use crate::image::{Location, Memory, Part};

/// Capacity for writes in one step before the list has to grow.
const WRITES: usize = 256;

/// A forced location.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Force {
    pub(super) location: Location,
    pub(super) value: u64,
}

/// The writes of a step.
#[derive(Debug)]
pub(super) struct Written {
    writes: Vec<Force>,
    /// The last write to each byte: the fixed parts in the order of [`FIXED`], then the PLC's own blocks in their order. Empty
    /// until the first write, because most forked machines are never written to.
    places: Vec<(Part, Vec<Bits>)>,
    /// The writes that the PLC program overwrote, last first.
    overwritten: Vec<usize>,
}

/// Bits of a byte that were written, and their values.
#[derive(Clone, Copy, Debug, Default)]
struct Bits {
    mask: u8,
    value: u8,
}

/// The parts that every memory has.
pub(super) const FIXED: [Part; 8] =
    [Part::ToNck, Part::FromNck, Part::Hmi, Part::Inputs, Part::Outputs, Part::Flags, Part::Timers, Part::Counters];

impl Written {
    /// Nothing yet.
    pub(super) const fn new() -> Self {
        Self { writes: Vec::new(), places: Vec::new(), overwritten: Vec::new() }
    }

    /// Allocates memory for writes to a memory of this layout, so that a step does not allocate.
    pub(super) fn make_room(&mut self, memory: &Memory) {
        if self.places.is_empty() {
            let own = memory.blocks.iter().map(|block| Part::Block(block.number));
            let bits = |part| (part, vec![Bits::default(); memory.part(part).len()]);
            self.places = FIXED.into_iter().chain(own).map(bits).collect();
            self.writes.reserve(WRITES);
            self.overwritten.reserve(WRITES);
        }
    }

    pub(super) fn push(&mut self, location: Location, value: u64) {
        self.writes.push(Force { location, value });
    }

    pub(super) fn clear(&mut self) {
        let Self { writes, places, .. } = self;
        for write in writes.drain(..) {
            for (offset, _) in bytes_of(&write) {
                if let Some(bits) = at(places, write.location.part, offset) {
                    *bits = Bits::default();
                }
            }
        }
    }

    /// Compares all writes after the PLC program has run, and returns those that it overwrote, in order. A write that another
    /// write of the same cycle replaced does not count as overwritten by the PLC.
    pub(super) fn settle(&mut self, memory: &Memory) -> impl Iterator<Item = Location> {
        let Self { writes, places, overwritten } = self;
        overwritten.clear();
        for (index, write) in writes.iter().enumerate().rev() {
            let Force { location, value } = *write;
            let mut is_replaced = false;
            for (offset, written) in bytes_of(write) {
                let Some(bits) = at(places, location.part, offset) else { continue };
                is_replaced |= bits.mask & written.mask != 0;
                let new = written.mask & !bits.mask;
                *bits = Bits { mask: bits.mask | new, value: bits.value | written.value & new };
            }
            if !is_replaced && memory.read(location) != value & location.mask() {
                overwritten.push(index);
            }
        }
        overwritten.iter().rev().map(|index| writes[*index].location)
    }

    /// The last write to a bit, if any; known after [`Written::settle`].
    pub(super) fn bit(&self, part: Part, offset: u32, bit: u8) -> Option<bool> {
        let (_, bytes) = self.places.get(index_of(&self.places, part)?)?;
        let bits = bytes.get(offset as usize)?;
        (bits.mask >> bit & 1 == 1).then_some(bits.value >> bit & 1 == 1)
    }
}

/// The bytes that a write touches, most significant first.
fn bytes_of(write: &Force) -> impl Iterator<Item = (u32, Bits)> {
    let Force { location, value } = *write;
    let count = location.bytes();
    (0..count).map(move |place| {
        let shift = if location.width < 8 { 0 } else { 8 * (count - 1 - place) };
        let byte = |bits: u64| u8::try_from(bits >> shift & 0xFF).unwrap_or(0);
        let bit = if location.width < 8 { location.bit } else { 0 };
        let mask = byte(location.mask()) << bit;
        (location.offset + place, Bits { mask, value: byte(value) << bit & mask })
    })
}

fn at(places: &mut [(Part, Vec<Bits>)], part: Part, offset: u32) -> Option<&mut Bits> {
    let index = index_of(places, part)?;
    places.get_mut(index)?.1.get_mut(offset as usize)
}

fn index_of(places: &[(Part, Vec<Bits>)], part: Part) -> Option<usize> {
    let Part::Block(number) = part else {
        return FIXED.iter().position(|fixed| *fixed == part);
    };
    let own = places.get(FIXED.len()..)?;
    let found = own.binary_search_by(|(part, _)| part.cmp(&Part::Block(number)));
    found.ok().map(|index| FIXED.len() + index)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::image::Format;

    /// A place among the first eight flags: one of 1, 5, 8, 16 or 32 bits.
    fn location() -> impl Strategy<Value = Location> {
        let place = |(offset, bit, width)| {
            let bit = if width < 8 { bit % (9 - width) } else { 0 };
            Location { part: Part::Flags, offset, bit, width, format: Format::Unsigned }
        };
        (0..5_u32, 0..8_u8, prop::sample::select(vec![1_u8, 5, 8, 16, 32])).prop_map(place)
    }

    proptest! {
        /// Compared with a search of all later writes for each write.
        #[test]
        fn the_last_write_of_a_bit_counts(
            writes in prop::collection::vec((location(), any::<u32>()), 0..12),
            now in any::<[u8; 8]>(),
        ) {
            let (mut memory, mut image) = (Memory::new(), Memory::new());
            let mut written = Written::new();
            written.make_room(&memory);
            written.push(Location { part: Part::Block(2), offset: 255, bit: 7, width: 1, format: Format::Unsigned }, 1);
            prop_assert_eq!(written.settle(&memory).count(), 1);
            prop_assert_eq!(written.bit(Part::Block(2), 255, 7), Some(true));
            written.clear();
            prop_assert_eq!(written.bit(Part::Block(2), 255, 7), None);
            memory.flags[..8].copy_from_slice(&now);
            let (mut expected, mut mask) = (Vec::new(), Memory::new());
            for (index, (location, value)) in writes.iter().enumerate() {
                let value = u64::from(*value) & location.mask();
                written.push(*location, value);
                image.write(*location, value);
                mask.write(*location, location.mask());
                let is_replaced = writes[index + 1..].iter().any(|(later, _)| later.overlaps(*location));
                if !is_replaced && memory.read(*location) != value {
                    expected.push(*location);
                }
            }
            prop_assert_eq!(written.settle(&memory).collect::<Vec<_>>(), expected);
            for (byte, bit) in (0..8).flat_map(|byte| (0..8).map(move |bit| (byte, bit))) {
                let is_set = |memory: &Memory| memory.flags[byte as usize] >> bit & 1 == 1;
                prop_assert_eq!(written.bit(Part::Flags, byte, bit), is_set(&mask).then(|| is_set(&image)));
            }
        }
    }
}
