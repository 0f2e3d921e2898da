//! Durations in scenarios: `100ms`, `1.5s`, `2min`, `10cycles`. They end with the first cycle that completes them, at least one. A time
//! is compared with the time of the machine, because power on can change the length of its cycles (MD10050, MD10070).

use crate::monitor::Span;
use crate::source::Problem;
use crate::units::Time;

/// A duration as written in a scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Duration {
    /// A span of time.
    Time(Time),
    /// A number of cycles.
    Cycles(u64),
}

impl Duration {
    /// Reads `<n>cycles`, or a number and a unit as [`Time::parse_saturating`] does.
    ///
    /// # Errors
    /// The text has neither form.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        let problem = || {
            Problem::new(
                format!("expected a duration, found `{text}`"),
                "write a number with a unit (us, ms, s, min or h) or a number of cycles: \"100ms\", \"10cycles\"",
            )
        };
        let trimmed = text.trim();
        let read = match trimmed.strip_suffix("cycles").or_else(|| trimmed.strip_suffix("cycle")) {
            Some(number) => whole_number(number.trim_end()).map(Self::Cycles),
            None => Time::parse_saturating(trimmed).map(Self::Time),
        };
        read.ok_or_else(problem)
    }

    /// The duration in cycles of this length.
    #[must_use]
    pub fn cycles(self, cycle: Time) -> u64 {
        match self {
            Self::Time(time) => time.in_cycles(cycle),
            Self::Cycles(cycles) => cycles.max(1),
        }
    }

    /// The duration as a limit of a rule.
    pub(super) fn span(self) -> Span {
        match self {
            Self::Time(time) => Span::time(time),
            Self::Cycles(cycles) => Span::cycles(cycles.max(1)),
        }
    }

    /// Whether it is over after a number of cycles that took this time together. At least one cycle must pass.
    #[must_use]
    pub fn is_over(self, cycles: u64, time: Time) -> bool {
        match self {
            Self::Time(span) => cycles > 0 && time >= span,
            Self::Cycles(count) => cycles >= count.max(1),
        }
    }
}

/// Accepts digits only, no sign.
fn whole_number(text: &str) -> Option<u64> {
    text.bytes().all(|digit| digit.is_ascii_digit()).then(|| text.parse().ok()).flatten()
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
            (" 3 cycle ", 3),
        ] {
            let duration = Duration::parse(text).unwrap();
            assert_eq!(duration.cycles(cycle), cycles, "{text}");
            assert!(duration.is_over(cycles, cycle.times(cycles)), "{text}");
            assert!(!duration.is_over(cycles - 1, cycle.times(cycles - 1)), "{text}");
        }
    }

    #[test]
    fn what_is_no_duration_is_refused() {
        for text in ["", "5", "ms", "-1s", "1.2.3s", "5 days", "1.5cycles", "1e3s", "+5cycles", "cycles"] {
            assert!(Duration::parse(text).is_err(), "{text}");
        }
    }
}
