//! Units: time in whole nanoseconds, positions in whole nanometres or millionths of a degree, and the numbers
//! of axes, channels and mode groups, which count from one as in the manuals.
//!
//! Everything that is compared with a limit is an integer, because `37.7 − 37.5 > 0.2` is true in `f64`
//! (decision O-11 asks for "strictly greater").

use std::fmt;
use std::ops::{Add, AddAssign, Index, IndexMut, Neg, Sub, SubAssign};

use serde::{Deserialize, Serialize};

/// A point in time or a span of time, in whole nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Time(i64);

impl Time {
    /// The start of everything, or no time at all.
    pub const ZERO: Self = Self(0);

    /// From whole nanoseconds.
    #[must_use]
    pub const fn from_nanos(nanos: i64) -> Self {
        Self(nanos)
    }

    /// From whole microseconds.
    #[must_use]
    pub const fn from_micros(micros: i64) -> Self {
        Self(micros * 1_000)
    }

    /// From whole milliseconds.
    #[must_use]
    pub const fn from_millis(millis: i64) -> Self {
        Self(millis * 1_000_000)
    }

    /// From seconds, rounded to the nearest nanosecond; saturates beyond 292 years.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate, as documented")]
    pub fn from_seconds(seconds: f64) -> Self {
        Self((seconds * 1e9).round() as i64)
    }

    /// Reads a number and its unit, `us`, `ms`, `s`, `min` or `h`: `10ms`, `0.5 s`. `None` where it is something
    /// else, negative, or beyond 292 years.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "the value is checked to be in range before")]
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let end = text.find(|letter: char| !letter.is_ascii_digit() && letter != '.')?;
        let (number, unit) = text.split_at(end);
        let nanos_per_unit = match unit.trim_start() {
            "us" => 1e3,
            "ms" => 1e6,
            "s" => 1e9,
            "min" => 60e9,
            "h" => 3_600e9,
            _ => return None,
        };
        let nanos = (number.parse::<f64>().ok()? * nanos_per_unit).round();
        (nanos < 9.2e18).then_some(Self(nanos as i64))
    }

    /// Whole nanoseconds.
    #[must_use]
    pub const fn nanos(self) -> i64 {
        self.0
    }

    /// Seconds, for display and for the arithmetic of the model.
    #[must_use]
    pub fn seconds(self) -> f64 {
        self.0 as f64 / 1e9
    }

    /// How many cycles of `cycle` this span takes: rounded up, at least one.
    #[must_use]
    pub fn in_cycles(self, cycle: Self) -> u64 {
        let cycles = self.0.max(1).unsigned_abs().div_ceil(cycle.0.max(1).unsigned_abs());
        cycles.max(1)
    }

    /// This span `count` times.
    #[must_use]
    pub const fn times(self, count: u64) -> Self {
        Self(self.0.saturating_mul(count.cast_signed()))
    }
}

impl Add for Time {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Time {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl AddAssign for Time {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

/// Seconds with milliseconds, more digits only where they are needed: `12.346`, `0.0005`.
impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let nanos = self.0.unsigned_abs();
        let fraction = format!("{:09}", nanos % 1_000_000_000);
        let kept = fraction.trim_end_matches('0').len().max(3);
        let text = format!("{sign}{}.{}", nanos / 1_000_000_000, &fraction[..kept]);
        f.pad_integral(true, "", &text)
    }
}

/// A position or a distance: whole nanometres on a linear axis, whole millionths of a degree on a rotary one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Position(i64);

impl Position {
    /// Zero.
    pub const ZERO: Self = Self(0);
    /// How many of these make one millimetre or one degree.
    pub const PER_USER_UNIT: f64 = 1e6;

    /// From whole nanometres or millionths of a degree.
    #[must_use]
    pub const fn new(increments: i64) -> Self {
        Self(increments)
    }

    /// From millimetres or degrees, rounded to the nearest increment.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate")]
    pub fn from_user(millimetres_or_degrees: f64) -> Self {
        Self((millimetres_or_degrees * Self::PER_USER_UNIT).round() as i64)
    }

    /// Whole nanometres or millionths of a degree.
    #[must_use]
    pub const fn increments(self) -> i64 {
        self.0
    }

    /// Millimetres or degrees.
    #[must_use]
    pub fn user(self) -> f64 {
        self.0 as f64 / Self::PER_USER_UNIT
    }

    /// Without its sign; the one position that has no positive counterpart becomes the largest.
    #[must_use]
    pub const fn abs(self) -> Self {
        Self(self.0.saturating_abs())
    }
}

impl Add for Position {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl Sub for Position {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Position {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

impl AddAssign for Position {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Position {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// Millimetres or degrees with three decimals, more only where they are needed: `0.941`, `-0.00025`.
impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let increments = self.0.unsigned_abs();
        let fraction = format!("{:06}", increments % 1_000_000);
        let kept = fraction.trim_end_matches('0').len().max(3);
        f.pad_integral(true, "", &format!("{sign}{}.{}", increments / 1_000_000, &fraction[..kept]))
    }
}

/// Makes a number that counts from one, with its largest value.
macro_rules! number_from_one {
    ($(#[$doc:meta])* $name:ident, $table:ident, $max:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(try_from = "u8")]
        pub struct $name(u8);

        /// A saved number is checked when it is read, because it is used as a place in a table.
        impl TryFrom<u8> for $name {
            type Error = &'static str;
            fn try_from(number: u8) -> Result<Self, Self::Error> {
                Self::new(number).ok_or(concat!("a ", stringify!($name), " is from 1 to ", $max))
            }
        }

        impl $name {
            /// The largest number there is.
            pub const MAX: u8 = $max;
            /// Number one.
            pub const FIRST: Self = Self(1);

            /// The number as the manuals count it, from one; `None` for 0 and beyond the largest.
            #[must_use]
            pub const fn new(number: u8) -> Option<Self> {
                if number >= 1 && number <= $max { Some(Self(number)) } else { None }
            }

            /// The number as the manuals count it.
            #[must_use]
            pub const fn number(self) -> u8 {
                self.0
            }

            /// Its place in a table, from zero.
            #[must_use]
            pub const fn index(self) -> usize {
                self.0 as usize - 1
            }

            /// All of them, ascending.
            pub fn all() -> impl DoubleEndedIterator<Item = Self> {
                (1..=$max).map(Self)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }

        /// One of something for each number.
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

            /// One made for each number.
            pub fn from_fn(make: impl FnMut($name) -> T) -> Self {
                let mut make = make;
                Self(std::array::from_fn(|index| {
                    #[expect(clippy::cast_possible_truncation, reason = "a table has at most 31 places")]
                    make($name(index as u8 + 1))
                }))
            }

            /// One of something else for each.
            pub fn map<U>(self, make: impl FnMut(T) -> U) -> $table<U> {
                $table(self.0.map(make))
            }

            /// Each with its number, ascending.
            pub fn iter(&self) -> impl Iterator<Item = ($name, &T)> {
                $name::all().zip(self.0.iter())
            }

            /// Each with its number, ascending.
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
    /// Number of a machine axis, 1 to 31; its data block is DB 30 + number.
    AxisNumber, PerAxis, 31
);
/// A set of machine axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AxisSet(u32);

impl AxisSet {
    /// No axis.
    pub const NONE: Self = Self(0);
    /// All that there can be.
    pub const ALL: Self = Self((1 << AxisNumber::MAX) - 1);

    /// One axis.
    #[must_use]
    pub const fn of(axis: AxisNumber) -> Self {
        Self(1 << axis.index())
    }

    /// Whether nothing is in it.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether it has this axis.
    #[must_use]
    pub const fn contains(self, axis: AxisNumber) -> bool {
        self.0 >> axis.index() & 1 == 1
    }

    /// Takes an axis in, or out.
    pub const fn set(&mut self, axis: AxisNumber, member: bool) {
        self.0 = self.0 & !(1 << axis.index()) | (member as u32) << axis.index();
    }

    /// What is in either.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// What is in both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Whether all of the other are in it.
    #[must_use]
    pub const fn has_all_of(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Its axes, ascending.
    pub fn iter(self) -> impl Iterator<Item = AxisNumber> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let index = rest.trailing_zeros();
            rest &= rest.wrapping_sub(1);
            u8::try_from(index + 1).ok().and_then(AxisNumber::new)
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
    /// Number of a mode group, 1 or 2; both live in DB11.
    ModeGroupNumber, PerModeGroup, 2
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_is_rounded_up_to_whole_cycles_and_takes_at_least_one() {
        let cycle = Time::from_millis(2);
        assert_eq!(Time::from_millis(4).in_cycles(cycle), 2);
        assert_eq!(Time::from_micros(4_001).in_cycles(cycle), 3);
        assert_eq!(Time::ZERO.in_cycles(cycle), 1);
    }

    #[test]
    fn a_time_is_read_with_its_unit_and_only_with_it() {
        assert_eq!(Time::parse("10ms"), Some(Time::from_millis(10)));
        assert_eq!(Time::parse("0.1 ms"), Some(Time::from_micros(100)));
        assert_eq!(Time::parse("2min"), Some(Time::from_millis(120_000)));
        assert_eq!(Time::parse("1h"), Some(Time::from_millis(3_600_000)));
        for text in ["10", "ms", "", "-1s", "1e3s", "1.2.3s", "5cycles", "9999999999h", "inf s"] {
            assert_eq!(Time::parse(text), None, "{text}");
        }
    }

    #[test]
    fn times_and_positions_print_three_decimals_and_more_where_needed() {
        assert_eq!(Time::from_millis(12_346).to_string(), "12.346");
        assert_eq!(Time::from_micros(500).to_string(), "0.0005");
        assert_eq!(Position::from_user(-0.941).to_string(), "-0.941");
        assert_eq!(Position::new(250).to_string(), "0.00025");
        assert_eq!(format!("{:>8}", Position::from_user(1.5)), "   1.500");
    }

    #[test]
    fn a_set_of_axes_gives_them_back_in_order() {
        let axes = [31, 1, 8].map(|number| AxisNumber::new(number).unwrap());
        let mut set: AxisSet = axes.into_iter().collect();
        assert_eq!(set.iter().map(AxisNumber::number).collect::<Vec<_>>(), [1, 8, 31]);
        assert!(set.contains(axes[0]) && AxisSet::ALL.has_all_of(set) && !set.has_all_of(AxisSet::ALL));
        set.set(axes[0], false);
        assert_eq!(set.iter().last(), Some(axes[2]));
        assert_eq!(AxisSet::ALL.iter().count(), 31);
        assert_eq!(AxisSet::NONE.iter().count(), 0);
    }

    #[test]
    fn numbers_count_from_one() {
        assert_eq!(AxisNumber::new(0), None);
        assert_eq!(AxisNumber::new(32), None);
        assert_eq!(AxisNumber::new(3).map(AxisNumber::index), Some(2));
        assert_eq!(postcard::from_bytes(&[31]), Ok(AxisNumber(31)));
        assert!([0, 32].iter().all(|&byte| postcard::from_bytes::<AxisNumber>(&[byte]).is_err()));
    }
}
