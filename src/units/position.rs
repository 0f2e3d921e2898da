//! Positions and distances, in whole nanometres or millionths of a degree.

use std::fmt;
use std::ops::{Add, AddAssign, Neg, Sub, SubAssign};

use serde::{Deserialize, Serialize};

/// A position or a distance: whole nanometres on a linear axis, whole millionths of a degree on a rotary one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Position(i64);

impl Position {
    /// Zero.
    pub const ZERO: Self = Self(0);
    /// The number of increments per millimetre or degree.
    pub const PER_USER_UNIT: f64 = 1e6;

    /// Makes a position from whole nanometres or millionths of a degree.
    #[must_use]
    pub const fn new(increments: i64) -> Self {
        Self(increments)
    }

    /// Makes a position from millimetres or degrees, rounded to the nearest increment.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate")]
    pub fn from_user(millimetres_or_degrees: f64) -> Self {
        Self((millimetres_or_degrees * Self::PER_USER_UNIT).round() as i64)
    }

    /// The position in whole nanometres or millionths of a degree.
    #[must_use]
    pub const fn increments(self) -> i64 {
        self.0
    }

    /// The position in millimetres or degrees.
    #[must_use]
    pub fn user(self) -> f64 {
        self.0 as f64 / Self::PER_USER_UNIT
    }

    /// The absolute value. The smallest position has no positive counterpart and becomes the largest position.
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

/// Prints millimetres or degrees with three decimals, and more only if they are needed: `0.941`, `-0.00025`.
impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let increments = self.0.unsigned_abs();
        let fraction = format!("{:06}", increments % 1_000_000);
        let kept = fraction.trim_end_matches('0').len().max(3);
        f.pad_integral(true, "", &format!("{sign}{}.{}", increments / 1_000_000, &fraction[..kept]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_prints_three_decimals_and_more_where_needed() {
        assert_eq!(Position::from_user(-0.941).to_string(), "-0.941");
        assert_eq!(Position::new(250).to_string(), "0.00025");
        assert_eq!(format!("{:>8}", Position::from_user(1.5)), "   1.500");
    }
}
