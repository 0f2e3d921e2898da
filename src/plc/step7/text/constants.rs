//! Constants of STEP 7: what `L` loads, and what a declaration sets as an initial value.

/// A constant with the form in which it is written.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::plc::step7) enum Constant {
    /// `5`, `-5`.
    Integer(i64),
    /// `L#-3`.
    Long(i32),
    /// `W#16#1F`, `2#101`, `B#(1, 2)`: the value and its bits; 0 bits for `2#…`, which fits any width.
    Bits(u32, u8),
    /// `1.5`.
    Real(f32),
    /// `'AB'`, in Latin-1.
    Text(Vec<u8>),
    /// `TRUE`, `FALSE`.
    Boolean(bool),
    /// `S5T#1S`.
    S5Time(u16),
    /// `T#1S`, in ms.
    Time(i32),
    /// `D#2004-2-29`, days since 1990-1-1.
    Date(u16),
    /// `TOD#12:30:0.5`, in ms.
    TimeOfDay(u32),
    /// `DT#95-12-31-23:59:59.123`, as BCD.
    DateTime([u8; 8]),
    /// `C#125`, as BCD.
    Count(u16),
    /// `P#10.3`: a bit address.
    Bit(u32),
    /// `P#M 12.5`, `P#DB10.DBX 2.0 BYTE 6`.
    Pointer {
        /// The number of the DB, or 0.
        block: u16,
        /// The area-crossing pointer.
        pointer: u32,
        /// The code of the type and the count, for ANY.
        any: Option<(u8, u16)>,
    },
}

impl Constant {
    /// The value in a register of 32 bits; `None` for one that does not fit.
    pub(in crate::plc::step7) fn bits(&self) -> Option<u32> {
        Some(match *self {
            Self::Integer(value) => u32::from(word(value)?),
            Self::Long(value) | Self::Time(value) => value.cast_unsigned(),
            Self::Bits(value, _) | Self::TimeOfDay(value) | Self::Bit(value) => value,
            Self::Real(value) => value.to_bits(),
            Self::Text(ref text) if text.len() <= 4 => {
                text.iter().fold(0, |value, &letter| value << 8 | u32::from(letter))
            }
            Self::Boolean(value) => u32::from(value),
            Self::S5Time(value) | Self::Date(value) | Self::Count(value) => u32::from(value),
            Self::Pointer { pointer, .. } => pointer,
            Self::Text(_) | Self::DateTime(_) => return None,
        })
    }
}

/// The 16 bits of a number between −32768 and 65535.
pub(in crate::plc::step7) fn word(value: i64) -> Option<u16> {
    u16::try_from(value).ok().or_else(|| i16::try_from(value).ok().map(i16::cast_unsigned))
}

/// A constant with its type before `#`; the error says what was expected.
pub(in crate::plc::step7) fn typed(kind: &str, rest: &str) -> Result<Constant, &'static str> {
    let kind = kind.to_ascii_uppercase();
    match kind.as_str() {
        "2" => Ok(Constant::Bits(radix(rest, 2, u32::MAX).ok_or("binary digits, at most 32")?, 0)),
        "8" => Ok(Constant::Bits(radix(rest, 8, u32::MAX).ok_or("octal digits")?, 0)),
        "16" => Ok(Constant::Bits(radix(rest, 16, u32::MAX).ok_or("hexadecimal digits, at most 8")?, 0)),
        "B" | "BYTE" => based(rest, 8),
        "W" | "WORD" => based(rest, 16),
        "DW" | "DWORD" => based(rest, 32),
        "L" | "DINT" => {
            rest.replace('_', "").parse().map(Constant::Long).map_err(|_| "a number from -2147483648 to 2147483647")
        }
        "S5T" | "S5TIME" => s5time(rest).map(Constant::S5Time).ok_or("a duration up to 2H46M30S, as S5T#1S500MS"),
        "T" | "TIME" => time(rest).ok_or("a duration up to 24D20H31M23S647MS, as T#1S500MS"),
        "D" | "DATE" => date(rest).map(Constant::Date).ok_or("a date from 1990-1-1 to 2168-12-31, as D#2004-2-29"),
        "TOD" | "TIME_OF_DAY" => time_of_day(rest).map(Constant::TimeOfDay).ok_or("a time, as TOD#12:30:0.5"),
        "DT" | "DATE_AND_TIME" => {
            date_time(rest).map(Constant::DateTime).ok_or("date and time, as DT#95-12-31-23:59:59.123")
        }
        "C" | "Z" => {
            let digits = (!rest.is_empty() && rest.len() <= 3).then_some(rest);
            let count =
                digits.and_then(|digits| digits.parse::<u16>().ok()).ok_or("a number from 0 to 999, as C#125")?;
            Ok(Constant::Count(bcd(count)))
        }
        _ => Err("one of the types B W DW L S5T T D TOD DT C P, or 2#"),
    }
}

fn based(rest: &str, bits: u8) -> Result<Constant, &'static str> {
    let maximum = u32::MAX >> (32 - u32::from(bits));
    let value = match rest.split_once('#') {
        Some(("16", digits)) => radix(digits, 16, maximum),
        Some(("8", digits)) => radix(digits, 8, maximum),
        Some(("2", digits)) => radix(digits, 2, maximum),
        Some(_) => None,
        None => radix(rest, 10, maximum),
    };
    value.map(|value| Constant::Bits(value, bits)).ok_or("hexadecimal digits of this width, as W#16#1F")
}

fn radix(digits: &str, radix: u32, maximum: u32) -> Option<u32> {
    let digits = digits.replace('_', "");
    if digits.starts_with(['+', '-']) {
        return None;
    }
    u32::from_str_radix(&digits, radix).ok().filter(|&value| value <= maximum)
}

/// A number up to 999 as three digits.
pub(in crate::plc::step7) fn bcd(value: u16) -> u16 {
    (value / 100 % 10) << 8 | (value / 10 % 10) << 4 | (value % 10)
}

/// The parts of a duration, in ms; each unit may be there once, in order.
fn milliseconds(text: &str) -> Option<i64> {
    let text = text.replace('_', "").to_ascii_uppercase();
    let (sign, mut rest) = match text.strip_prefix('-') {
        Some(rest) => (-1, rest),
        None => (1, text.as_str()),
    };
    if rest.is_empty() {
        return None;
    }
    let mut sum = 0.0_f64;
    let mut last = usize::MAX;
    const UNITS: [(&str, f64); 5] = [("MS", 1.0), ("S", 1e3), ("M", 6e4), ("H", 3.6e6), ("D", 8.64e7)];
    while !rest.is_empty() {
        let end = rest.find(|letter: char| !letter.is_ascii_digit() && letter != '.')?;
        let number: f64 = rest[..end].parse().ok()?;
        let unit = UNITS.iter().position(|(unit, _)| {
            rest[end..]
                .strip_prefix(unit)
                .is_some_and(|after| after.is_empty() || after.starts_with(|c: char| c.is_ascii_digit()))
        })?;
        if unit >= last {
            return None;
        }
        last = unit;
        sum += number * UNITS[unit].1;
        rest = &rest[end + UNITS[unit].0.len()..];
    }
    #[expect(clippy::cast_possible_truncation, reason = "the sum is checked")]
    (sum < 1e12).then(|| sign * sum.round() as i64)
}

/// A duration in the form of the timers: the finest base that can hold it, the rest is cut.
fn s5time(text: &str) -> Option<u16> {
    s5time_of(milliseconds(text)?)
}

/// The form of the timers for a number of ms; `None` beyond 9,990 s.
pub(in crate::plc::step7) fn s5time_of(milliseconds: i64) -> Option<u16> {
    let milliseconds = u32::try_from(milliseconds).ok()?;
    (0..4_u16).find_map(|base| {
        let value = milliseconds / (10 * 10_u32.pow(u32::from(base)));
        u16::try_from(value).ok().filter(|&value| value <= 999).map(|value| base << 12 | bcd(value))
    })
}

fn time(text: &str) -> Option<Constant> {
    i32::try_from(milliseconds(text)?).ok().map(Constant::Time)
}

/// The days of the months before a month, without leap days.
const BEFORE: [u32; 13] = [0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334, 365];

fn is_leap(year: u32) -> bool {
    year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
}

/// The days from 1990-1-1 to a date.
pub(in crate::plc::step7) fn days(year: u32, month: u32, day: u32) -> Option<u32> {
    let in_month = BEFORE.get(month as usize)?.checked_sub(*BEFORE.get((month as usize).checked_sub(1)?)?)?;
    let leap = u32::from(month == 2 && is_leap(year));
    if !(1990..=2168).contains(&year) || day == 0 || day > in_month + leap {
        return None;
    }
    let years: u32 = (1990..year).map(|year| 365 + u32::from(is_leap(year))).sum();
    Some(years + BEFORE[month as usize - 1] + u32::from(month > 2 && is_leap(year)) + day - 1)
}

/// Year, month and day of a number of days since 1990-1-1.
pub(in crate::plc::step7) fn calendar(days: u32) -> (u32, u32, u32) {
    let mut rest = days;
    let mut year = 1990;
    while rest >= 365 + u32::from(is_leap(year)) {
        rest -= 365 + u32::from(is_leap(year));
        year += 1;
    }
    let mut month = 1;
    loop {
        let length = BEFORE[month] - BEFORE[month - 1] + u32::from(month == 2 && is_leap(year));
        if rest < length {
            #[expect(clippy::cast_possible_truncation, reason = "at most 12")]
            return (year, month as u32, rest + 1);
        }
        rest -= length;
        month += 1;
    }
}

fn date(text: &str) -> Option<u16> {
    let mut parts = text.split('-').map(|part| part.parse::<u32>().ok());
    let (year, month, day) = (parts.next()??, parts.next()??, parts.next()??);
    if parts.next().is_some() {
        return None;
    }
    u16::try_from(days(year, month, day)?).ok()
}

fn time_of_day(text: &str) -> Option<u32> {
    let mut parts = text.split(':');
    let hours: u32 = parts.next()?.parse().ok()?;
    let minutes: u32 = parts.next()?.parse().ok()?;
    let (seconds, fraction) = parts
        .next()?
        .split_once('.')
        .map_or_else(|| (text.rsplit(':').next(), ""), |(seconds, fraction)| (Some(seconds), fraction));
    let seconds: u32 = seconds?.parse().ok()?;
    if parts.next().is_some() || hours > 23 || minutes > 59 || seconds > 59 || fraction.len() > 9 {
        return None;
    }
    let digits = format!("{fraction:0<3}");
    let milliseconds: u32 = digits.get(..3)?.parse().ok()?;
    Some(((hours * 60 + minutes) * 60 + seconds) * 1000 + milliseconds)
}

fn date_time(text: &str) -> Option<[u8; 8]> {
    let (rest, clock) = text.rsplit_once('-')?;
    let mut parts = rest.split('-').map(|part| part.parse::<u32>().ok());
    let (year, month, day) = (parts.next()??, parts.next()??, parts.next()??);
    let year = match year {
        0..=89 => year + 2000,
        90..=99 => year + 1900,
        year => year,
    };
    if parts.next().is_some() || !(1990..=2089).contains(&year) {
        return None;
    }
    Some(date_time_of(days(year, month, day)?, time_of_day(clock)?))
}

/// The eight bytes of DATE_AND_TIME, for days since 1990-1-1 and ms of the day.
pub(in crate::plc::step7) fn date_time_of(days: u32, milliseconds: u32) -> [u8; 8] {
    #[expect(clippy::cast_possible_truncation, reason = "two digits")]
    let two = |value: u32| (((value / 10 % 10) << 4) | (value % 10)) as u8;
    let (year, month, day) = calendar(days);
    let seconds = milliseconds / 1000;
    let rest = milliseconds % 1000;
    // 1990-1-1 was a Monday, 2 of 1 (Sunday) to 7.
    let weekday = (days + 1) % 7 + 1;
    [
        two(year % 100),
        two(month),
        two(day),
        two(seconds / 3600),
        two(seconds / 60 % 60),
        two(seconds % 60),
        two(rest / 10),
        two(rest % 10 * 10 + weekday),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn timer_values_have_the_finest_base() {
        for (text, wanted) in [
            ("2S", 0x0200),
            ("10S", 0x1100),
            ("12S340MS", 0x1123),
            ("2H46M30S", 0x3999),
            ("1S500MS", 0x0150),
            ("1H_1M", 0x3366),
            ("10MS", 0x0001),
        ] {
            assert_eq!(typed("S5T", text), Ok(Constant::S5Time(wanted)), "{text}");
        }
        assert!(typed("S5T", "2H46M31S").is_ok_and(|value| value == Constant::S5Time(0x3999)));
        assert!(typed("S5T", "3H").is_err() && typed("S5T", "1MS1S").is_err() && typed("S5T", "").is_err());
    }

    #[test]
    fn dates_and_times_have_their_bytes() {
        // 14 years with the leap days of 1992, 1996, 2000: 14 × 365 + 3 = 5113; January 31, 29 February is the 59th day after that.
        assert_eq!(typed("D", "2004-2-29"), Ok(Constant::Date(5113 + 31 + 28)));
        assert_eq!(typed("TOD", "12:30:0.5"), Ok(Constant::TimeOfDay(45_000_500)));
        assert_eq!(typed("T", "-1S"), Ok(Constant::Time(-1000)));
        // 31 December 1995 was a Sunday: 1.
        let bytes = [0x95, 0x12, 0x31, 0x23, 0x59, 0x59, 0x12, 0x31];
        assert_eq!(typed("DT", "95-12-31-23:59:59.123"), Ok(Constant::DateTime(bytes)));
        assert!(
            typed("D", "2003-2-29").is_err() && typed("D", "1990-13-1").is_err() && typed("D", "1990-0-1").is_err()
        );
        for day in [0, 58, 59, 365, 5172, 65_000] {
            let (year, month, date) = calendar(day);
            assert_eq!(days(year, month, date), Some(day));
        }
    }

    #[test]
    fn integers_and_bits_are_right_aligned() {
        assert_eq!(Constant::Integer(-2).bits(), Some(0x0000_FFFE));
        assert_eq!(typed("W", "16#1F").unwrap().bits(), Some(0x1F));
        assert_eq!(typed("2", "1010_0101").unwrap().bits(), Some(0xA5));
        assert_eq!(typed("C", "125").unwrap().bits(), Some(0x125));
        assert_eq!(Constant::Text(b"AB".to_vec()).bits(), Some(0x4142));
        assert!(typed("B", "16#1FF").is_err() && typed("C", "1000").is_err() && typed("W", "16#-1").is_err());
    }
}
