//! The hours meters of the CPU (SFC 2 to 4).

use serde::{Deserialize, Serialize};

/// An hours meter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::plc::step7) struct HoursMeter {
    /// What it had counted when it was started last, in ns.
    pub(in crate::plc::step7) counted: i64,
    /// The time at which it was started, while it runs.
    pub(in crate::plc::step7) since: Option<i64>,
}

impl HoursMeter {
    pub(in crate::plc::step7) fn nanos(self, now: i64) -> i64 {
        self.counted.saturating_add(self.since.map_or(0, |since| now - since))
    }

    /// It stands, with what it has counted.
    pub(in crate::plc::step7) fn stopped(self, now: i64) -> Self {
        Self { counted: self.nanos(now), since: None }
    }
}
