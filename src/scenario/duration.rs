//! Durations in scenarios: `100ms`, `1.5s`, `2min`, `10cycles`; rounded up to whole cycles, at least one.

use crate::source::Problem;
use crate::units::Time;

/// A span of time as a scenario writes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Duration {
    /// A span of time.
    Time(Time),
    /// A number of cycles.
    Cycles(u64),
}

/// The units of a duration with their seconds.
const UNITS: [(&str, f64); 5] = [("us", 1e-6), ("ms", 1e-3), ("s", 1.0), ("min", 60.0), ("h", 3600.0)];

impl Duration {
    /// Reads `<number>us|ms|s|min|h` or `<n>cycles`.
    ///
    /// # Errors
    /// It is neither.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        let problem = || {
            Problem::new(
                format!("expected a duration, found `{text}`"),
                "write a number and a unit, us, ms, s, min or h, or a number of cycles: \"100ms\", \"10cycles\"",
            )
        };
        let trimmed = text.trim();
        let digits = trimmed.find(|c: char| c != '.' && !c.is_ascii_digit()).unwrap_or(trimmed.len());
        let (number, unit) = trimmed.split_at(digits);
        let unit = unit.trim_start();
        if unit == "cycles" || unit == "cycle" {
            return number.parse().map(Self::Cycles).map_err(|_| problem());
        }
        let (_, seconds) = UNITS.iter().find(|(name, _)| *name == unit).ok_or_else(problem)?;
        let number: f64 = number.parse().map_err(|_| problem())?;
        Ok(Self::Time(Time::from_seconds(number * seconds)))
    }

    /// How many cycles it takes.
    #[must_use]
    pub fn cycles(self, cycle: Time) -> u64 {
        match self {
            Self::Time(time) => time.in_cycles(cycle),
            Self::Cycles(cycles) => cycles.max(1),
        }
    }

    /// How long it is, before rounding.
    #[must_use]
    pub fn time(self, cycle: Time) -> Time {
        match self {
            Self::Time(time) => time,
            Self::Cycles(cycles) => cycle.times(cycles),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_read_and_rounded_up_to_cycles() {
        let cycle = Time::from_millis(2);
        for (text, cycles) in [
            ("1us", 1),
            ("100ms", 50),
            ("101ms", 51),
            ("1.5s", 750),
            ("2 min", 60_000),
            ("1h", 1_800_000),
            ("10cycles", 10),
            ("0s", 1),
            ("0cycles", 1),
        ] {
            assert_eq!(Duration::parse(text).unwrap().cycles(cycle), cycles, "{text}");
        }
    }

    #[test]
    fn what_is_no_duration_is_refused() {
        for text in ["", "5", "ms", "-1s", "1.2.3s", "5 days", "1.5cycles", "1e3s"] {
            assert!(Duration::parse(text).is_err(), "{text}");
        }
    }
}
