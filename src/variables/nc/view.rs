//! The inputs of the NC variables.

use super::{ControlValues, MachineData};
use crate::image::{Memory, Names};
use crate::variables::Variables;

/// The inputs of the NC variables.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The memory after a step.
    pub memory: &'a Memory,
    /// The variables after a step.
    pub variables: &'a Variables,
    /// The names of axes and channels.
    pub names: &'a Names,
    /// Machine data.
    pub machine_data: Option<&'a dyn MachineData>,
    /// Further values of the control.
    pub control: Option<&'a dyn ControlValues>,
    /// The clock.
    pub clock: ClockTime,
    /// The serial number of the hardware.
    pub serial_number: &'a str,
}

impl View<'_> {
    /// Whether lengths are shown in inches.
    #[must_use]
    pub fn shows_inch(&self) -> bool {
        self.memory.from_nck().nck.inch_measuring_system_active()
    }
}

/// A point in time by the clock of the CPU, which has no time zone: milliseconds since 1970.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct ClockTime(pub u64);

impl ClockTime {
    /// The time this many milliseconds earlier, but not before 1970.
    #[must_use]
    pub fn earlier(self, milliseconds: u64) -> Self {
        Self(self.0.saturating_sub(milliseconds))
    }

    /// Whole seconds since 1970.
    #[expect(clippy::cast_precision_loss, reason = "seconds of centuries are exact")]
    pub(super) fn seconds(self) -> f64 {
        (self.0 / 1000) as f64
    }
}

impl std::fmt::Debug for View<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("View").finish_non_exhaustive()
    }
}
