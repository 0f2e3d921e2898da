//! Measured values in millionths, the unit of six displayed decimals.

/// A value in millionths.
#[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate")]
pub(super) fn millionths(value: f64) -> i64 {
    (value * 1e6).round() as i64
}

/// Millionths as text with six decimals.
pub(super) fn decimals(millionths: i64) -> String {
    let sign = if millionths < 0 { "-" } else { "" };
    let digits = millionths.unsigned_abs();
    format!("{sign}{}.{:06}", digits / 1_000_000, digits % 1_000_000)
}
