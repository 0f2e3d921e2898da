//! Times of the computer on the command line.

use std::time::Duration;

use crate::units::Time;

/// Parses `30s` or `10min`.
pub(super) fn duration(text: &str) -> Result<Duration, String> {
    Time::parse(text)
        .map(|time| Duration::from_nanos(time.nanos().unsigned_abs()))
        .filter(|time| !time.is_zero())
        .ok_or_else(|| format!("expected a time such as 500ms, 30s or 10min, found {text}"))
}
