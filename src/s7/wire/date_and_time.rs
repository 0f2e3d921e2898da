//! DATE_AND_TIME of SIMATIC: year, month, day, hour, minute and second in BCD, three digits of milliseconds, and the
//! day of the week, Sunday as 1.

/// A calendar date and time, from 1990 to 2089.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct DateAndTime {
    /// 1990 to 2089.
    pub year: u16,
    /// 1 to 12.
    pub month: u8,
    /// 1 to 31.
    pub day: u8,
    /// 0 to 23.
    pub hour: u8,
    /// 0 to 59.
    pub minute: u8,
    /// 0 to 59.
    pub second: u8,
    /// 0 to 999.
    pub millisecond: u16,
}

impl DateAndTime {
    /// The earliest value.
    pub const FIRST: Self = Self { year: 1990, month: 1, day: 1, hour: 0, minute: 0, second: 0, millisecond: 0 };

    /// Its eight bytes.
    #[must_use]
    pub fn bytes(&self) -> [u8; 8] {
        let (hundreds, ones) = (self.millisecond / 10, self.millisecond % 10);
        let small = |number: u16| u8::try_from(number % 100).unwrap_or(0);
        let last = small(ones) << 4 | self.weekday();
        let parts = [small(self.year), self.month, self.day, self.hour, self.minute, self.second, small(hundreds)];
        let [a, b, c, d, e, f, g] = parts.map(bcd);
        [a, b, c, d, e, f, g, last]
    }

    /// Parses eight bytes; the day of the week is ignored.
    #[must_use]
    pub fn parse(bytes: &[u8]) -> Option<Self> {
        let [year, month, day, hour, minute, second, hundreds, last] = *<&[u8; 8]>::try_from(bytes).ok()?;
        let year = u16::from(number(year)?);
        let year = if year < 90 { 2000 + year } else { 1900 + year };
        let milliseconds = u16::from(number(hundreds)?) * 10 + u16::from(number(last >> 4)?);
        let time = Self {
            year,
            month: number(month)?,
            day: number(day)?,
            hour: number(hour)?,
            minute: number(minute)?,
            second: number(second)?,
            millisecond: milliseconds,
        };
        let valid = (1..=12).contains(&time.month)
            && (1..=days_of(time.year, time.month)).contains(&time.day)
            && time.hour < 24
            && time.minute < 60
            && time.second < 60;
        valid.then_some(time)
    }

    /// Sunday is 1, Saturday 7.
    #[must_use]
    pub fn weekday(&self) -> u8 {
        // 1 January 1990 was a Monday.
        u8::try_from((self.days() + 1) % 7 + 1).unwrap_or(1)
    }

    /// Days since 1 January 1990.
    #[must_use]
    pub fn days(&self) -> u32 {
        let years = (1990..self.year).map(|year| if is_leap(year) { 366 } else { 365 }).sum::<u32>();
        let months = (1..self.month).map(|month| u32::from(days_of(self.year, month))).sum::<u32>();
        years + months + u32::from(self.day.saturating_sub(1))
    }

    /// Milliseconds since the earliest value.
    #[must_use]
    pub fn milliseconds(&self) -> u64 {
        let seconds = u64::from(self.hour) * 3600 + u64::from(self.minute) * 60 + u64::from(self.second);
        u64::from(self.days()) * DAY + seconds * 1000 + u64::from(self.millisecond)
    }

    /// The time this many milliseconds earlier, but not before 1990.
    #[must_use]
    pub fn earlier(self, milliseconds: u64) -> Self {
        Self::FIRST.later(self.milliseconds().saturating_sub(milliseconds))
    }

    /// The time this many milliseconds later. 1990 follows 2089, because a year has only two digits.
    #[must_use]
    pub fn later(self, milliseconds: u64) -> Self {
        let total = self.milliseconds().saturating_add(milliseconds);
        let small = |number: u64| u8::try_from(number).unwrap_or(0);
        let (days, of_day) = (total / DAY % CENTURY, total % DAY);
        // 1992, the third of four years, is a leap year.
        let (year, mut day) = match days % FOUR_YEARS {
            day @ 0..365 => (1990, day),
            day @ 365..730 => (1991, day - 365),
            day @ 730..1096 => (1992, day - 730),
            day => (1993, day - 1096),
        };
        let year = year + 4 * u16::try_from(days / FOUR_YEARS).unwrap_or(0);
        let mut month = 1;
        while month < 12 && day >= u64::from(days_of(year, month)) {
            day -= u64::from(days_of(year, month));
            month += 1;
        }
        Self {
            year,
            month,
            day: small(day) + 1,
            hour: small(of_day / 3_600_000),
            minute: small(of_day / 60_000 % 60),
            second: small(of_day / 1000 % 60),
            millisecond: u16::try_from(of_day % 1000).unwrap_or(0),
        }
    }
}

/// Milliseconds of a day.
const DAY: u64 = 86_400_000;
/// Days of four years, one of which is a leap year.
const FOUR_YEARS: u64 = 4 * 365 + 1;
/// Days from 1990 to 2089.
const CENTURY: u64 = 25 * FOUR_YEARS;

fn is_leap(year: u16) -> bool {
    year.is_multiple_of(4) // 2000 is a leap year; 2100 is out of range
}

fn days_of(year: u16, month: u8) -> u8 {
    match month {
        2 if is_leap(year) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

fn bcd(number: u8) -> u8 {
    (number / 10 % 10) * 16 + number % 10
}

fn number(bcd: u8) -> Option<u8> {
    (bcd >> 4 < 10 && bcd & 0xF < 10).then_some((bcd >> 4) * 10 + (bcd & 0xF))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_2089_comes_1990() {
        let last = DateAndTime { year: 2089, month: 12, day: 31, hour: 23, minute: 59, second: 59, millisecond: 999 };
        assert_eq!(last.bytes(), [0x89, 0x12, 0x31, 0x23, 0x59, 0x59, 0x99, 0x97]); // a Saturday
        assert_eq!(last.later(1), DateAndTime::FIRST);
        assert_eq!(DateAndTime::FIRST.bytes(), [0x90, 1, 1, 0, 0, 0, 0, 2]); // a Monday
        // A century is 36,525 days: 2000 is a leap year.
        assert_eq!(last.later(36_525 * 86_400_000), last);
        assert_eq!(DateAndTime::FIRST.later(36_524 * 86_400_000 + 86_399_999), last);
        let leap = DateAndTime { year: 2088, month: 2, day: 29, ..DateAndTime::FIRST };
        assert_eq!(leap.later(86_400_000), DateAndTime { month: 3, day: 1, ..leap });
        for milliseconds in [0, 1, 86_400_000, u64::MAX / 3, u64::MAX] {
            let later = last.later(milliseconds);
            assert_eq!(DateAndTime::parse(&later.bytes()), Some(later), "{milliseconds}");
        }
    }
    #[test]
    fn every_day_of_the_century_is_as_far_from_the_first_as_it_says() {
        let mut expected = DateAndTime::FIRST;
        for day in 0..36_525 {
            let found = DateAndTime::FIRST.later(day * 86_400_000);
            assert_eq!((found, found.milliseconds()), (expected, day * 86_400_000));
            expected.day += 1;
            if expected.day > days_of(expected.year, expected.month) {
                (expected.month, expected.day) = (expected.month + 1, 1);
            }
            if expected.month > 12 {
                (expected.year, expected.month) = (expected.year + 1, 1);
            }
        }
        assert_eq!(expected.year, 2090);
    }
}
