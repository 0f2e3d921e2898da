//! THE PROGRAM: what runs in the PLC, cycle after cycle, on the PLC's side of the interface.
//!
//! A program is a closure over its own state and [`PlcIo`], the PLC's view of the memory: it writes what the PLC
//! writes, and reads the rest. The closure captures nothing it could change, so all that it remembers is in its
//! state, and a fork or a saved run goes on exactly as the original does.
//!
//! ```
//! use opennck::plc::{OnDelay, program};
//! use opennck::units::Time;
//!
//! // The drive of axis XF gets its pulses half a second after input I3.4 is on.
//! let delayed = program("delayed_pulses", OnDelay::default(), |delay, io| {
//!     let Some(axis) = io.axis("XF") else { return };
//!     let on = delay.scan(io.inputs.bit(3, 4), Time::from_millis(500), io.time);
//!     io.to_nck.axis(axis).set_pulse_enable(on);
//! });
//! # let _ = delayed;
//! ```
//!
//! Programs for another control than the SINUMERIK are closures over its own structures, or over bytes: [`program_for`].
//!
//! The machine calls [`PlcProgram::startup`] once after power on (OB100) and [`PlcProgram::scan`] in each PLC cycle
//! (OB1); between two scans nobody else writes to the PLC's side but queued commands and forces.

#[cfg(test)]
mod bench;
mod blocks;
mod closure;
mod io;
mod programs;
mod registry;
#[cfg(test)]
mod tests;

pub use blocks::{FallingEdge, OffDelay, OnDelay, ResetDominantLatch, RisingEdge, SetDominantLatch};
pub use closure::{ClosureProgram, program, program_for, program_with_fault};
pub use io::PlcIo;
pub use programs::{
    LimitEdgeMarker, MACHINE_CONTROL_PANEL_LAYOUT, MachineControlPanel, enable_all, gantry_start, limit_edge_marker,
    machine_control_panel, shared_reference_cam,
};
pub use registry::Programs;

use crate::image::AsBytes;
use crate::source::Problem;

/// The PLC program cannot go on: the PLC stops, and the NCK misses its sign of life (alarm 2000).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the PLC program stopped: {reason}")]
pub struct PlcFault {
    /// Why, in words of the program.
    pub reason: String,
}

impl PlcFault {
    /// A fault with its reason.
    #[must_use]
    pub fn new(reason: impl Into<String>) -> Self {
        Self { reason: reason.into() }
    }
}

/// A program of the PLC, of whatever kind. It sees the parts of the interface as bytes, whichever control they are of;
/// [`PlcIo::typed`] gives the structures of one.
pub trait PlcProgram: Send {
    /// What it is called.
    fn name(&self) -> &str;

    /// OB100: runs once after power on and after each restart of the PLC, before the first scan.
    ///
    /// # Errors
    /// The program cannot start; the PLC stays in stop.
    fn startup(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault>;

    /// OB1: runs once in each PLC cycle.
    ///
    /// # Errors
    /// The program cannot go on; the PLC stops.
    fn scan(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault>;

    /// All that the program remembers, as bytes.
    fn save(&self) -> Vec<u8>;

    /// Takes back what [`PlcProgram::save`] gave.
    ///
    /// # Errors
    /// The bytes are from another program; then nothing has changed.
    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem>;

    /// A second program that remembers the same and goes on by itself; `None` where the kind of program cannot do it.
    fn fork(&self) -> Option<Box<dyn PlcProgram>>;

    /// Forgets everything, as after power on.
    fn reset(&mut self);
}
