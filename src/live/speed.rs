//! The speed of a machine relative to real time: `--speed N` of `opennck serve`, and its use in the schedule.

use std::time::Duration;

/// The speed relative to real time, in thousandths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Speed(u32);

impl Default for Speed {
    fn default() -> Self {
        Self(1000)
    }
}

impl Speed {
    /// The factor: 1 is real time.
    #[must_use]
    pub fn ratio(self) -> f64 {
        f64::from(self.0) / 1000.0
    }

    pub(super) fn thousandths(self) -> u32 {
        self.0
    }

    /// The speed of a number that [`Speed::thousandths`] returned.
    pub(super) fn of_thousandths(thousandths: u32) -> Self {
        Self(thousandths)
    }

    /// The real time that corresponds to a simulated time in nanoseconds.
    pub(super) fn real(self, simulated: u128) -> Duration {
        Duration::from_nanos(u64::try_from(simulated * 1000 / u128::from(self.0)).unwrap_or(u64::MAX))
    }
}

impl std::str::FromStr for Speed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = text.parse::<f64>().ok().filter(|number| (0.001..=1000.0).contains(number));
        let number = number.ok_or("expected a number from 0.001 to 1000, where 1 is real time")?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the value is from 1 to 1,000,000")]
        Ok(Self((number * 1000.0).round() as u32))
    }
}

impl std::fmt::Display for Speed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", f64::from(self.0) / 1000.0)
    }
}
