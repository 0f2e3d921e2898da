//! Numbers of axes, channels and mode groups, which count from one as in the manuals; tables with one element per number; sets of axes.

use std::fmt;
use std::ops::{Index, IndexMut};

use serde::{Deserialize, Serialize};

/// Defines a number that counts from one, with its maximum, and a table with one element per number.
macro_rules! number_from_one {
    ($(#[$doc:meta])* $name:ident, $table:ident, $max:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(try_from = "u8")]
        pub struct $name(u8);

        /// A saved number is checked when it is read, because it is used as an index.
        impl TryFrom<u8> for $name {
            type Error = &'static str;
            fn try_from(number: u8) -> Result<Self, Self::Error> {
                Self::new(number).ok_or(concat!("a ", stringify!($name), " must be from 1 to ", $max))
            }
        }

        impl $name {
            /// The largest number.
            pub const MAX: u8 = $max;
            /// Number one.
            pub const FIRST: Self = Self(1);

            /// The number as counted in the manuals, from one; `None` for 0 and for numbers above the maximum.
            #[must_use]
            pub const fn new(number: u8) -> Option<Self> {
                if number >= 1 && number <= $max { Some(Self(number)) } else { None }
            }

            /// The number as counted in the manuals.
            #[must_use]
            pub const fn number(self) -> u8 {
                self.0
            }

            /// The index in a table, from zero.
            #[must_use]
            pub const fn index(self) -> usize {
                self.0 as usize - 1
            }

            /// All numbers, ascending.
            pub fn all() -> impl DoubleEndedIterator<Item = Self> {
                Self::up_to($max)
            }

            /// The first `count` numbers, ascending; all numbers if `count` is larger.
            pub fn up_to(count: u8) -> impl DoubleEndedIterator<Item = Self> {
                (1..=count.min($max)).map(Self)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }

        /// A table with one element per number.
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize,
            zerocopy::FromBytes, zerocopy::IntoBytes, zerocopy::Immutable, zerocopy::KnownLayout, zerocopy::Unaligned,
        )]
        #[repr(transparent)]
        pub struct $table<T>([T; $max])
        where
            [T; $max]: Sized;

        impl<T> $table<T> {
            /// From a table in ascending order.
            pub const fn new(table: [T; $max]) -> Self {
                Self(table)
            }

            /// A table whose elements are computed from their numbers.
            pub fn from_fn(make: impl FnMut($name) -> T) -> Self {
                let mut make = make;
                Self(std::array::from_fn(|index| {
                    #[expect(clippy::cast_possible_truncation, reason = "a table has at most 32 elements")]
                    make($name(index as u8 + 1))
                }))
            }

            /// A table of the converted elements.
            pub fn map<U>(self, make: impl FnMut(T) -> U) -> $table<U> {
                $table(self.0.map(make))
            }

            /// Each element with its number, ascending.
            pub fn iter(&self) -> impl Iterator<Item = ($name, &T)> {
                $name::all().zip(self.0.iter())
            }

            /// Each element with its number, ascending.
            pub fn iter_mut(&mut self) -> impl Iterator<Item = ($name, &mut T)> {
                $name::all().zip(self.0.iter_mut())
            }
        }

        impl<T: Default> Default for $table<T> {
            fn default() -> Self {
                Self(std::array::from_fn(|_| T::default()))
            }
        }

        impl<T> Index<$name> for $table<T> {
            type Output = T;
            fn index(&self, number: $name) -> &T {
                &self.0[number.index()]
            }
        }

        impl<T> IndexMut<$name> for $table<T> {
            fn index_mut(&mut self, number: $name) -> &mut T {
                &mut self.0[number.index()]
            }
        }
    };
}

number_from_one!(
    /// Number of a machine axis, 1 to 32; a control may have fewer.
    AxisNumber, PerAxis, 32
);

/// A set of machine axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AxisSet(u32);

impl AxisSet {
    /// No axis.
    pub const NONE: Self = Self(0);
    /// All possible axes.
    pub const ALL: Self = Self(u32::MAX >> (u32::BITS - AxisNumber::MAX as u32));

    /// One axis.
    #[must_use]
    pub const fn of(axis: AxisNumber) -> Self {
        Self(1 << axis.index())
    }

    /// Whether the set is empty.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether the set contains this axis.
    #[must_use]
    pub const fn contains(self, axis: AxisNumber) -> bool {
        self.0 >> axis.index() & 1 == 1
    }

    /// Adds an axis or removes it.
    pub const fn set(&mut self, axis: AxisNumber, member: bool) {
        self.0 = self.0 & !(1 << axis.index()) | (member as u32) << axis.index();
    }

    /// The union of both sets.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The intersection of both sets.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The axes of this set that are not in the other.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether this set contains all axes of the other set.
    #[must_use]
    pub const fn has_all_of(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// The axes of the set, ascending.
    pub fn iter(self) -> impl Iterator<Item = AxisNumber> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            if rest == 0 {
                return None;
            }
            #[expect(clippy::cast_possible_truncation, reason = "32 bits have places below 32")]
            let index = rest.trailing_zeros() as u8;
            rest &= rest - 1;
            Some(AxisNumber(index + 1))
        })
    }
}

impl FromIterator<AxisNumber> for AxisSet {
    fn from_iter<I: IntoIterator<Item = AxisNumber>>(axes: I) -> Self {
        axes.into_iter().fold(Self::NONE, |set, axis| set.with(Self::of(axis)))
    }
}

number_from_one!(
    /// Number of a channel, 1 to 10; its data block is DB 20 + number.
    ChannelNumber, PerChannel, 10
);
number_from_one!(
    /// Number of a mode group, 1 or 2; both are in DB11.
    ModeGroupNumber, PerModeGroup, 2
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_of_axes_iterates_in_order() {
        let axes = [32, 1, 8].map(|number| AxisNumber::new(number).unwrap());
        let mut set: AxisSet = axes.into_iter().collect();
        assert_eq!(set.iter().map(AxisNumber::number).collect::<Vec<_>>(), [1, 8, 32]);
        assert!(set.contains(axes[0]) && AxisSet::ALL.has_all_of(set) && !set.has_all_of(AxisSet::ALL));
        set.set(axes[0], false);
        assert_eq!(set.iter().last(), Some(axes[2]));
        assert_eq!(AxisSet::ALL.iter().count(), 32);
        assert_eq!(AxisSet::NONE.iter().count(), 0);
    }

    #[test]
    fn numbers_count_from_one() {
        assert_eq!(AxisNumber::new(0), None);
        assert_eq!(AxisNumber::new(33), None);
        assert_eq!(AxisNumber::up_to(2).chain(AxisNumber::up_to(99)).count(), 34);
        assert_eq!(AxisNumber::new(3).map(AxisNumber::index), Some(2));
        assert_eq!(postcard::from_bytes(&[32]), Ok(AxisNumber(32)));
        assert!([0, 33].iter().all(|&byte| postcard::from_bytes::<AxisNumber>(&[byte]).is_err()));
    }
}
