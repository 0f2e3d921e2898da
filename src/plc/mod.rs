//! The PLC program: it runs in every PLC cycle on the PLC side of the interface.
//!
//! A program is a closure over its own state and [`PlcIo`], the view of the PLC on the memory: it writes the PLC side and reads all other
//! parts. The closure captures nothing that it can change, so its state is its complete memory. A fork or a saved run therefore continues
//! exactly like the original.
//!
//! ```
//! use opennck::plc::{OnDelay, program};
//! use opennck::units::Time;
//!
//! // The drive of axis XF gets pulse enable half a second after input I3.4 is on.
//! let delayed = program("delayed_pulses", OnDelay::default(), |delay, io| {
//!     let Some(axis) = io.axis("XF") else { return };
//!     let on = delay.scan(io.inputs.bit(3, 4), Time::from_millis(500), io.time);
//!     io.to_nck.axis(axis).set_pulse_enable(on);
//! });
//! # let _ = delayed;
//! ```
//!
//! Programs for controls other than the SINUMERIK are closures over the structures of that control, or over bytes: [`program_for`].
//!
//! The machine calls [`PlcProgram::startup`] once after power on (OB100) and [`PlcProgram::scan`] in each PLC cycle (OB1). Between two
//! scans, only queued commands and forces write to the PLC side.

mod basic_program;
#[cfg(test)]
mod bench;
mod blocks;
mod closure;
mod diagnosis;
mod io;
mod link;
mod nc;
mod process;
mod programs;
mod registry;
mod spin_ctrl;
pub mod step7;
#[cfg(test)]
mod tests;

pub use basic_program::{
    AlarmMessages, ControlPanel, Group, MessageLayout, Messages, PanelInputs, PanelKind, PanelOutputs,
};
pub use blocks::{FallingEdge, OffDelay, OnDelay, ResetDominantLatch, RisingEdge, SetDominantLatch};
pub use closure::{ClosureProgram, program, program_for, program_with_fault};
pub use diagnosis::PlcDiagnosis;
pub use io::PlcIo;
pub use link::Link;
pub use nc::{NcOrder, NcServices, NcVariable, NoNc};
pub use process::PlcProcess;
pub use programs::{
    GearChange, LimitEdgeMarker, MACHINE_CONTROL_PANEL_LAYOUT, MachineControlPanel, PositionAxis, ToolChange,
    enable_all, gantry_start, gear_change, limit_edge_marker, machine_control_panel, position_axis,
    shared_reference_cam, tool_change,
};
pub use registry::Programs;
pub use spin_ctrl::{SpinCtrl, SpinCtrlInputs, SpinCtrlOutputs};

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::image::{AsBytes, Location, Memory, Names, Part};
use crate::source::Problem;
use crate::units::Time;

/// The PLC program cannot continue: the PLC stops, and the NCK detects the missing sign of life (alarm 2000).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the PLC program stopped: {reason}")]
pub struct PlcFault {
    /// The reason, in the words of the program.
    pub reason: String,
    /// The entries of the diagnostic buffer, if the program is one of a CPU with such entries.
    pub diagnosis: Option<PlcDiagnosis>,
}

impl PlcFault {
    /// A fault with the given reason.
    #[must_use]
    pub fn new(reason: impl Into<String>) -> Self {
        Self { reason: reason.into(), diagnosis: None }
    }
}

/// Why a program changed bits of the memory: the statement that wrote them, and the operands that made its result.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramCause {
    /// The first of the bits.
    pub part: Part,
    /// Its address in bits, from the beginning of the part.
    pub bit: u32,
    /// The number of bits.
    pub bits: u32,
    /// The new value.
    pub value: u32,
    /// The statement with its place: `FC10, network 3, statement 5 (motor.awl:12)`.
    pub statement: Arc<str>,
    /// The operands that were decisive, with their values.
    pub tested: Vec<Tested>,
}

/// An operand that a program has tested.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Tested {
    /// A bit of the memory.
    Bit(Location, bool),
    /// A byte, a word or a double word of the memory, with the value that it had when it was read.
    Word(Location, u32),
    /// The status of a timer.
    Timer(u16, bool),
    /// The value of a timer as it was loaded.
    TimerValue(u16, u16),
    /// Whether a counter is not 0.
    Counter(u16, bool),
    /// The value of a counter as it was loaded.
    CounterValue(u16, u16),
    /// An operation whose operand is no part of the memory, such as a status bit, with its place, and the bit that it tested.
    Operation(Arc<str>, bool),
}

impl ProgramCause {
    /// What it wrote at a location; `None` if it wrote elsewhere, or only a part of it.
    #[must_use]
    pub fn wrote(&self, location: Location) -> Option<u32> {
        let begin = location.offset * 8 + u32::from(location.bit);
        let width = u32::from(location.width);
        if self.part != location.part || begin < self.bit || begin + width > self.bit + self.bits {
            return None;
        }
        if (self.bits, self.bit) == (width, begin) {
            return Some(self.value);
        }
        // The first byte is the highest.
        let bytes = location.bytes();
        let behind = self.bits / 8 - (location.offset - self.bit / 8) - bytes;
        let value = self.value.checked_shr(behind * 8 + u32::from(location.bit)).unwrap_or(0);
        Some(value & u32::MAX.checked_shr(32 - width).unwrap_or(0))
    }
}

/// A PLC program of any kind. It sees the parts of the interface as bytes, independent of the control. [`PlcIo::typed`] gives the
/// structures of one control.
pub trait PlcProgram: Send {
    /// The name of the program.
    fn name(&self) -> &str;

    /// Called before the first step of a run. A program in another process starts here, so that one that cannot start is an error and not
    /// a fault of the PLC.
    ///
    /// # Errors
    /// The program cannot start.
    fn begin(&mut self) -> Result<(), Problem> {
        Ok(())
    }

    /// Called when a machine loads the program, with the memory after power on: the program can enlarge areas and add data blocks of its
    /// own. It may be called again, with the memory of a machine that runs.
    fn install(&mut self, _memory: &mut Memory, _names: &Names) {}

    /// The time between two scans, rounded up to whole NC cycles; `None` if the machine decides.
    fn cycle(&self) -> Option<Time> {
        None
    }

    /// Whether [`PlcProgram::interrupt`] is to be called.
    fn has_interrupts(&self) -> bool {
        false
    }

    /// Called in each NC cycle without a scan: what runs between two scans, such as OB35.
    ///
    /// # Errors
    /// The program cannot continue; the PLC stops.
    fn interrupt(&mut self, _io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        Ok(())
    }

    /// OB100: runs once after power on and after each restart of the PLC, before the first scan.
    ///
    /// # Errors
    /// The program cannot start; the PLC stays in stop.
    fn startup(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault>;

    /// OB1: runs once in each PLC cycle.
    ///
    /// # Errors
    /// The program cannot continue; the PLC stops.
    fn scan(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault>;

    /// Observes the program from now on, for [`PlcProgram::causes`] and [`PlcProgram::coverage`]: slower, with the same results. What was
    /// observed is no part of the state.
    fn observe(&mut self) {}

    /// The same, and from now on [`PlcProgram::causes`] has every write of a bit, also of one with its present value.
    fn observe_every_write(&mut self) {}

    /// Why the program changed bits in this cycle, in the order of its statements, if it is observed.
    fn causes(&self, _cycle: u64) -> Vec<ProgramCause> {
        Vec::new()
    }

    /// The symbols of the program for bits, timers and counters, by their addresses such as `I1.0` and `T5`.
    fn symbols(&self) -> Option<&Arc<BTreeMap<String, String>>> {
        None
    }

    /// What ran of the program since it is observed, if it is a program with statements.
    fn coverage(&self) -> Option<step7::Coverage> {
        None
    }

    /// The complete state of the program, as bytes.
    fn save(&self) -> Vec<u8>;

    /// Restores a state from [`PlcProgram::save`].
    ///
    /// # Errors
    /// The bytes are from another program; the state is then unchanged.
    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem>;

    /// A second program with the same state that runs independently; `None` if this kind of program cannot be forked.
    fn fork(&self) -> Option<Box<dyn PlcProgram>>;

    /// Clears the state, as after power on.
    fn reset(&mut self);

    /// The next [`PlcProgram::startup`] is a cold restart (OB102).
    fn prepare_cold_restart(&mut self) {}
}
