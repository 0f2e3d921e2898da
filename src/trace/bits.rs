//! The changes of bytes as a trace keeps them: 24 bytes for the bits of a byte that changed for one reason.
//!
//! A row of the record has a writer and a cause for each bit, so that the machine writes it without looking for equal ones. Almost always
//! all bits that change in a byte have the same writer and the same cause, and a long run has hundreds of thousands of rows.

use super::printable::mask_in_byte;
use super::{By, Change, Recorder, Row};
use crate::image::{Location, Part};
use crate::variables::EventId;

/// Bits of a byte that one writer changed in one cycle, for one cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bits {
    /// The number of the cycle, from one.
    pub(super) cycle: u64,
    pub(super) part: Part,
    pub(super) offset: u32,
    /// The byte before these bits changed.
    pub(super) old: u8,
    /// The byte after these bits changed; further bits of it can change in the same cycle.
    pub(super) new: u8,
    pub(super) by: By,
    pub(super) cause: EventId,
}

impl Bits {
    /// The changed bits of a row in ascending order, nothing for a row without a byte. Bits with the same writer and cause stay together if
    /// no changed bit with another one is between them, so that the first of these that touches a signal has its lowest changed bit.
    pub(super) fn of(row: &Row) -> impl Iterator<Item = Self> + use<> {
        let cycle = row.cycle;
        let byte = match row.change {
            Change::Byte { part, offset, old, new, by, causes } => Some((part, offset, old, new, by, causes)),
            Change::Alarm { .. } | Change::Happened { .. } | Change::Overwritten { .. } | Change::NoEffect(_) => None,
        };
        byte.into_iter().flat_map(move |(part, offset, mut old, new, by, causes)| {
            std::iter::from_fn(move || {
                let left = old ^ new;
                let lowest = (0..8).find(|bit| left >> bit & 1 == 1)?;
                let reason = |bit: usize| (by[bit], causes[bit]);
                let together = |bit: &usize| left >> bit & 1 == 0 || reason(*bit) == reason(lowest);
                let mask = (lowest..8).take_while(together).fold(0, |mask, bit| mask | 1 << bit) & left;
                let (before, after) = (old, old ^ mask);
                old = after;
                Some(Self { cycle, part, offset, old: before, new: after, by: by[lowest], cause: causes[lowest] })
            })
        })
    }

    /// The bits of a location that changed, as a mask of the byte.
    pub(super) fn changed(&self, location: Location) -> u8 {
        let mask = if self.part == location.part { mask_in_byte(location, self.offset) } else { 0 };
        (self.old ^ self.new) & mask
    }
}

impl Recorder {
    /// The cause of the edge that a location had in this cycle, which is the last one recorded; `None` if it had none.
    #[must_use]
    pub fn edge(&self, location: Location, cycle: u64) -> Option<EventId> {
        let first = self.rows().iter().rposition(|row| row.cycle != cycle).map_or(0, |last| last + 1);
        let bits = self.rows()[first..].iter().flat_map(Bits::of).find(|bits| bits.changed(location) != 0)?;
        Some(bits.cause)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_takes_24_bytes() {
        assert_eq!(size_of::<Bits>(), 24);
    }

    #[test]
    fn bits_with_one_writer_and_one_cause_stay_together_and_all_others_are_apart() {
        let row = |old, new, by, causes: [u32; 8]| {
            let change = Change::Byte { part: Part::Flags, offset: 3, old, new, by, causes: causes.map(EventId) };
            let all: Vec<_> = Bits::of(&Row { cycle: 7, change }).collect();
            assert!(all.iter().all(|bits| (bits.cycle, bits.part, bits.offset) == (7, Part::Flags, 3)));
            all.iter().map(|bits| (bits.old, bits.new, bits.by, bits.cause.0)).collect::<Vec<_>>()
        };
        let (plc, nck) = (By::Plc, By::Nck);
        assert_eq!(row(5, 5, [plc; 8], [0; 8]), []);
        assert_eq!(row(0b1010, 0b0101, [plc; 8], [0; 8]), [(0b1010, 0b0101, plc, 0)]);
        // The writer of a bit that does not change does not matter.
        assert_eq!(row(0, 0b1001, [nck, plc, plc, nck, nck, nck, nck, nck], [4; 8]), [(0, 0b1001, nck, 4)]);
        assert_eq!(
            row(0, 0b1111, [nck; 8], [4, 4, 5, 4, 0, 0, 0, 0]),
            [(0, 0b0011, nck, 4), (0b0011, 0b0111, nck, 5), (0b0111, 0b1111, nck, 4)]
        );
        assert_eq!(
            row(0b1000_0000, 1, [plc, nck, nck, nck, nck, nck, nck, nck], [0; 8]),
            [(0b1000_0000, 0b1000_0001, plc, 0), (0b1000_0001, 1, nck, 0)]
        );
    }
}
