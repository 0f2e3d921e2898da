//! Converts the clock of the CPU between a point in time in UTC and `DATE_AND_TIME` of S7, which has no time zone.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use crate::s7::DateAndTime;

/// From 1970 to the first `DATE_AND_TIME`, 1990.
const EARLIER: Duration = Duration::from_secs(7305 * 86_400);

/// In whole milliseconds. Earlier times become 1990; from 2090 on the count starts again at 1990.
pub(super) fn to_date_and_time(time: SystemTime) -> DateAndTime {
    let since = time.duration_since(UNIX_EPOCH + EARLIER).unwrap_or_default();
    DateAndTime::FIRST.later(u64::try_from(since.as_millis()).unwrap_or(u64::MAX))
}

pub(super) fn from_date_and_time(time: DateAndTime) -> SystemTime {
    UNIX_EPOCH + EARLIER + Duration::from_millis(time.milliseconds())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_date_stays_what_it_is_and_the_century_begins_anew() {
        let leap = DateAndTime { year: 2088, month: 2, day: 29, hour: 23, minute: 59, second: 58, millisecond: 997 };
        assert_eq!(to_date_and_time(from_date_and_time(leap)), leap);
        let last = DateAndTime { year: 2089, month: 12, day: 31, hour: 23, minute: 59, second: 59, millisecond: 999 };
        assert_eq!(to_date_and_time(from_date_and_time(last) + Duration::from_millis(1)), DateAndTime::FIRST);
        // `date -u -d 2026-11-30T09:00:00 +%s` is 1796029200.
        let date = DateAndTime { year: 2026, month: 11, day: 30, hour: 9, ..DateAndTime::FIRST };
        assert_eq!(to_date_and_time(UNIX_EPOCH + Duration::from_secs(1_796_029_200)), date);
        assert_eq!(to_date_and_time(UNIX_EPOCH), DateAndTime::FIRST);
    }
}
