//! The inputs of the NC variables.

use super::{ControlValues, MachineData};
use crate::image::{Memory, Names};
use crate::s7::wire::date_and_time::DateAndTime;
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
    pub clock: DateAndTime,
    /// The serial number of the hardware.
    pub serial_number: &'a str,
}

impl std::fmt::Debug for View<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("View").finish_non_exhaustive()
    }
}
