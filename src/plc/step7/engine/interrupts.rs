//! The interrupts that time makes: time-of-day interrupts (OB10 to OB17), time-delay interrupts (OB20 to OB23) and cyclic interrupts (OB30
//! to OB38). They run between two scans, in the NC cycle in which they are due and before OB1, those of the higher priority first.

use serde::{Deserialize, Serialize};

use crate::plc::step7::instruction::BlockKind;
use crate::plc::step7::program::Program;
use crate::plc::step7::text::constants::{calendar, days};

pub(in crate::plc::step7) const DAY_MILLIS: i64 = 86_400_000;
pub(super) const MILLI_NANOS: i64 = 1_000_000;

/// The blocks that time starts, by their first numbers.
pub(in crate::plc::step7) const TIME_OF_DAY: u16 = 10;
pub(in crate::plc::step7) const TIME_DELAY: u16 = 20;
pub(in crate::plc::step7) const CYCLIC: u16 = 30;

/// The period of a time-of-day interrupt, as the parameter PERIOD of SFC 28 has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::plc::step7) enum Period {
    Once,
    Every { millis: i64, code: u16 },
    Month,
    Year,
    EndOfMonth,
}

impl Period {
    pub(in crate::plc::step7) fn of(code: u32) -> Option<Self> {
        let every = |millis| Some(Self::Every { millis, code: u16::try_from(code).unwrap_or(0) });
        match code {
            0x0000 => Some(Self::Once),
            0x0201 => every(60_000),
            0x0401 => every(3_600_000),
            0x1001 => every(DAY_MILLIS),
            0x1201 => every(7 * DAY_MILLIS),
            0x1401 => Some(Self::Month),
            0x1801 => Some(Self::Year),
            0x2001 => Some(Self::EndOfMonth),
            _ => None,
        }
    }

    pub(super) fn code(self) -> u16 {
        match self {
            Self::Once => 0,
            Self::Every { code, .. } => code,
            Self::Month => 0x1401,
            Self::Year => 0x1801,
            Self::EndOfMonth => 0x2001,
        }
    }

    /// The first time after a time, in ms since 1990-1-1, for a series that begins at `start`. A month without the day of the start has
    /// none.
    pub(in crate::plc::step7) fn after(self, start: i64, time: i64) -> Option<i64> {
        match self {
            Self::Once => Some(start).filter(|start| *start > time),
            Self::Every { .. } | Self::Month | Self::Year if start > time => Some(start),
            Self::Every { millis, .. } => Some(start + ((time - start) / millis + 1) * millis),
            Self::Month | Self::Year | Self::EndOfMonth => {
                let (first, of_day) = (u32::try_from(start / DAY_MILLIS).ok()?, start % DAY_MILLIS);
                let (_, month_of_start, day) = calendar(first);
                // From the month before the time on; of every leap day one is at most eight years away.
                let (year, month, _) = calendar(u32::try_from(time.max(start) / DAY_MILLIS).ok()?);
                let months = (0..12 * 9).map(|later| (year + (month - 1 + later) / 12, (month - 1 + later) % 12 + 1));
                let mut at = months.filter_map(|(year, month)| {
                    let day = match self {
                        Self::EndOfMonth => (28..=31).rev().find_map(|day| days(year, month, day))?,
                        Self::Year if month != month_of_start => return None,
                        _ => days(year, month, day)?,
                    };
                    Some(i64::from(day) * DAY_MILLIS + of_day)
                });
                at.find(|at| *at > time && *at >= start)
            }
        }
    }
}

/// A time-of-day interrupt as SFC 28 set it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::plc::step7) struct TimeOfDay {
    /// In ms since 1990-1-1.
    pub(in crate::plc::step7) start: i64,
    pub(in crate::plc::step7) period: Period,
    /// The next time, while it is active.
    pub(in crate::plc::step7) next: Option<i64>,
}

/// A time-delay interrupt that SFC 32 started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::plc::step7) struct Delay {
    /// In ns.
    pub(in crate::plc::step7) due: i64,
    pub(in crate::plc::step7) millis: u32,
    pub(in crate::plc::step7) sign: u16,
}

/// The interrupts of time.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::plc::step7) struct Interrupts {
    pub(in crate::plc::step7) times: [Option<TimeOfDay>; 8],
    pub(in crate::plc::step7) delays: [Option<Delay>; 4],
    /// The next times of the cyclic interrupts, in ns.
    pub(super) next: [i64; 9],
    /// A bit for each organization block that SFC 39 has disabled: what comes is discarded.
    pub(in crate::plc::step7) disabled: u64,
}

impl Interrupts {
    /// After power on: the cyclic interrupts begin.
    pub(in crate::plc::step7) fn begin(now: i64, periods: &[i64; 9]) -> Self {
        Self { next: periods.map(|period| now.saturating_add(period)), ..Self::default() }
    }
}

/// A bit for each block of the program that time can start.
pub(in crate::plc::step7) fn present(program: &Program) -> u64 {
    let numbers = (TIME_OF_DAY..18).chain(TIME_DELAY..24).chain(CYCLIC..39);
    numbers.filter(|number| program.find(BlockKind::Ob, *number).is_some()).fold(0, |bits, number| bits | 1 << number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(year: u32, month: u32, day: u32, hour: i64) -> i64 {
        i64::from(days(year, month, day).unwrap()) * DAY_MILLIS + hour * 3_600_000
    }

    #[test]
    fn a_series_goes_on_after_a_time() {
        let start = at(2024, 1, 31, 6);
        for (code, time, next) in [
            (0x0000, at(2024, 1, 1, 0), Some(start)),
            (0x0000, start, None),
            (0x0201, start, Some(start + 60_000)),
            (0x0401, at(2024, 2, 1, 7) + 1, Some(at(2024, 2, 1, 8))),
            (0x1001, start, Some(at(2024, 2, 1, 6))),
            (0x1201, start, Some(at(2024, 2, 7, 6))),
            // February has no 31st; its end is the 29th in 2024.
            (0x1401, start, Some(at(2024, 3, 31, 6))),
            (0x1801, start, Some(at(2025, 1, 31, 6))),
            (0x2001, start, Some(at(2024, 2, 29, 6))),
            (0x2001, at(2024, 1, 10, 0), Some(start)),
            (0x1401, at(2024, 1, 10, 0), Some(start)),
        ] {
            assert_eq!(Period::of(code).unwrap().after(start, time), next, "{code:04X}");
        }
        let leap = at(2024, 2, 29, 0);
        assert_eq!(Period::Year.after(leap, leap), Some(at(2028, 2, 29, 0)));
        assert_eq!(Period::of(0x0202), None);
    }
}
