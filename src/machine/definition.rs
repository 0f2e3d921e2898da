//! The definition of a machine from its files.

use crate::image::{Location, Memory, Names};
use crate::plant::{Layout, Switch};
use crate::units::{AxisNumber, Time};

/// The definition of a machine from its files. It does not change after opening, and all forks share it.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) names: Names,
    pub(super) layout: Layout,
    /// Signals of switches that are not wired.
    pub(super) unwired: Vec<(AxisNumber, Switch, Location)>,
    /// The memory after power on: presets.
    pub(super) memory: Memory,
    /// The cycle of the PLC program; the NC cycle if not defined.
    pub(super) plc_cycle: Option<Time>,
    pub(super) warnings: Vec<String>,
}
