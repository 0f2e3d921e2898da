//! What the values of NC variables are taken from.

use super::{ControlValues, MachineData};
use crate::image::{Memory, Names};
use crate::s7::wire::date_and_time::DateAndTime;
use crate::variables::Variables;

/// What the values are taken from.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The memory after a step.
    pub memory: &'a Memory,
    /// The variables after a step.
    pub variables: &'a Variables,
    /// What axes and channels are called.
    pub names: &'a Names,
    /// Machine data.
    pub machine_data: Option<&'a dyn MachineData>,
    /// What else the control knows.
    pub control: Option<&'a dyn ControlValues>,
    /// The clock.
    pub clock: DateAndTime,
    /// The serial number of the hardware.
    pub serial_number: &'a str,
}

impl std::fmt::Debug for View<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("View").finish_non_exhaustive()
    }
}
