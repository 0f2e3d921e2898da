//! Addresses that clients may not write: data blocks, bytes, NC variables.

use std::ops::RangeInclusive;

use crate::image::Area;

/// A part of the machine that clients may read but not write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Protected {
    /// Data blocks by their numbers.
    Blocks(RangeInclusive<u16>),
    /// Bytes of an area or a data block; timers and counters have two bytes each.
    Bytes {
        /// The area.
        area: Area,
        /// The bytes.
        bytes: RangeInclusive<u32>,
    },
    /// All NC variables, including machine data.
    NcVariables,
}

impl Protected {
    /// Whether it contains one of the `length` bytes from `start` on.
    #[must_use]
    pub fn covers(&self, area: Area, start: u32, length: u32) -> bool {
        match self {
            Self::Blocks(numbers) => matches!(area, Area::DataBlock(number) if numbers.contains(&number)),
            Self::Bytes { area: own, bytes } => {
                let last = start.saturating_add(length.max(1)) - 1;
                *own == area && start <= *bytes.end() && *bytes.start() <= last
            }
            Self::NcVariables => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_protected_from_the_first_to_the_last() {
        let protected = Protected::Bytes { area: Area::DataBlock(1000), bytes: 10..=19 };
        let covers = |start, length| protected.covers(Area::DataBlock(1000), start, length);
        assert!(covers(10, 1) && covers(19, 1) && covers(0, 11) && covers(19, 100) && covers(0, 100));
        assert!(!covers(0, 10) && !covers(20, 100));
        assert!(covers(u32::MAX, 2) || !covers(u32::MAX, u32::MAX)); // no overflow
        assert!(!protected.covers(Area::DataBlock(1001), 10, 1) && !protected.covers(Area::Flags, 10, 1));
        let blocks = Protected::Blocks(21..=30);
        assert!(blocks.covers(Area::DataBlock(21), 0, 1) && blocks.covers(Area::DataBlock(30), 400, 1));
        assert!(!blocks.covers(Area::DataBlock(31), 0, 1) && !blocks.covers(Area::Flags, 21, 1));
    }
}
