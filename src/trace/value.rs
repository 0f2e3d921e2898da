//! Measured values in millionths, as a trace keeps them and six decimals show them.

/// A value in millionths, as six decimals show it.
#[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate")]
pub(super) fn millionths(value: f64) -> i64 {
    (value * 1e6).round() as i64
}

/// Six decimals from millionths.
pub(super) fn decimals(millionths: i64) -> String {
    let sign = if millionths < 0 { "-" } else { "" };
    let digits = millionths.unsigned_abs();
    format!("{sign}{}.{:06}", digits / 1_000_000, digits % 1_000_000)
}
