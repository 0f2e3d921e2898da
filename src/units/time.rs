//! Points in time and durations, in whole nanoseconds.

use std::fmt;
use std::ops::{Add, AddAssign, Sub};

use serde::{Deserialize, Serialize};

/// A point in time or a duration, in whole nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Time(i64);

impl Time {
    /// Time zero, or a duration of zero.
    pub const ZERO: Self = Self(0);

    /// Makes a time from whole nanoseconds.
    #[must_use]
    pub const fn from_nanos(nanos: i64) -> Self {
        Self(nanos)
    }

    /// Makes a time from whole microseconds.
    #[must_use]
    pub const fn from_micros(micros: i64) -> Self {
        Self(micros * 1_000)
    }

    /// Makes a time from whole milliseconds.
    #[must_use]
    pub const fn from_millis(millis: i64) -> Self {
        Self(millis * 1_000_000)
    }

    /// Makes a time from seconds, rounded to the nearest nanosecond; saturates beyond 292 years.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate, as documented")]
    pub fn from_seconds(seconds: f64) -> Self {
        Self((seconds * 1e9).round() as i64)
    }

    /// Parses a number with a unit, `us`, `ms`, `s`, `min` or `h`: `10ms`, `0.5 s`. `None` if the text has another form, is negative, or is
    /// beyond 292 years.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        Self::parse_saturating(text).filter(|time| time.0 < 9_200_000_000_000_000_000)
    }

    /// Parses like [`Time::parse`]; a number without a unit is seconds.
    #[must_use]
    pub fn parse_or_seconds(text: &str) -> Option<Self> {
        let seconds = || text.parse().ok().filter(|seconds| (0.0..9e9).contains(seconds)).map(Self::from_seconds);
        Self::parse(text).or_else(seconds)
    }

    /// Parses like [`Time::parse`], but a time beyond 292 years becomes the maximum.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate, as documented")]
    pub fn parse_saturating(text: &str) -> Option<Self> {
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
        Some(Self((number.parse::<f64>().ok()? * nanos_per_unit).round() as i64))
    }

    /// The time in whole nanoseconds.
    #[must_use]
    pub const fn nanos(self) -> i64 {
        self.0
    }

    /// The time in seconds, for display and for the arithmetic of the model.
    #[must_use]
    pub fn seconds(self) -> f64 {
        self.0 as f64 / 1e9
    }

    /// The time in milliseconds, for display.
    #[must_use]
    pub fn milliseconds(self) -> f64 {
        self.0 as f64 / 1e6
    }

    /// The duration in cycles of length `cycle`: rounded up, at least one.
    #[must_use]
    pub fn in_cycles(self, cycle: Self) -> u64 {
        let cycles = self.0.max(1).unsigned_abs().div_ceil(cycle.0.max(1).unsigned_abs());
        cycles.max(1)
    }

    /// The duration multiplied by `count`.
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

/// Prints seconds with three decimals, and more only if they are needed: `12.346`, `0.0005`.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_duration_is_rounded_up_to_whole_cycles_and_takes_at_least_one() {
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
        assert_eq!(Time::parse_or_seconds("7.5"), Some(Time::from_millis(7_500)));
        assert_eq!(Time::parse_or_seconds("20ms"), Some(Time::from_millis(20)));
        assert_eq!((Time::parse_or_seconds("-1"), Time::parse_or_seconds("nan")), (None, None));
        assert_eq!(Time::parse_saturating("9999999999h"), Some(Time::from_nanos(i64::MAX)));
    }

    #[test]
    fn a_time_prints_three_decimals_and_more_where_needed() {
        assert_eq!(Time::from_millis(12_346).to_string(), "12.346");
        assert_eq!(Time::from_micros(500).to_string(), "0.0005");
    }
}
