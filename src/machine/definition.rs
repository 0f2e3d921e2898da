//! What the files say of a machine.

use crate::image::{Location, Memory, Names};
use crate::plant::{Layout, Switch};
use crate::units::{AxisNumber, Time};

/// What the files say of a machine; it never changes after opening and is shared by all forks.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) names: Names,
    pub(super) layout: Layout,
    /// Signals of switches that are not wired.
    pub(super) unwired: Vec<(AxisNumber, Switch, Location)>,
    /// The memory after power on: presets.
    pub(super) memory: Memory,
    /// How often the PLC program runs; in every cycle where it is not said.
    pub(super) plc_cycle: Option<Time>,
    pub(super) warnings: Vec<String>,
}
