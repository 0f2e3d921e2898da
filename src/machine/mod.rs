//! ONE STEP of a machine: control, iron and PLC program in a fixed order; and what goes with it: open, queue, power, save,
//! restore, fork.
//!
//! ```
//! use opennck::machine::Machine;
//!
//! let mut machine = Machine::open("g1_example")?;
//! for _ in 0..100 {
//!     machine.step();
//! }
//! let x = machine.axis("X").ok_or("the example has an axis X")?;
//! assert!(machine.memory().from_nck().axes[x].gantry_leading_axis()); // DB31.DBX101.6
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `step.rs` holds the order of a step, `open.rs` reads machines, `command.rs` lists what can be done to a machine from
//! outside, `queue.rs` keeps these commands and does them at the edge of the next step, `changes.rs` finds what changed for the
//! record, `saved.rs` saves, restores and forks.

mod before;
mod changes;
mod command;
mod definition;
mod describe;
mod open;
mod plc;
mod queue;
mod saved;
mod step;
mod written;

pub use crate::plant::{Fault, FaultKind, Switch};
pub use crate::sinumerik::machine_data::Value as DatumValue;
pub use crate::sinumerik::{ApproachPhase, GroupingPhase, TakenTransitions};
pub use command::Command;
pub use open::OpenOptions;
#[cfg(feature = "live")]
pub(crate) use saved::Snapshot;

use std::sync::Arc;

use crate::image::{Memory, Names, OverrideCoding};
use crate::motion::Feedback;
use crate::plant::Plant;
use crate::plc::PlcProgram;
use crate::sinumerik::Control;
use crate::sinumerik::machine_data::MachineData;
use crate::trace::Recorder;
use crate::units::{AxisNumber, ChannelNumber, PerAxis, Time};
use crate::variables::{RParameters, RaisedAlarm, Variables};

use before::Before;
use definition::{Definition, override_coding};
use plc::Plc;
use written::Force;

/// A machine: a control, its iron and its PLC program.
pub struct Machine {
    definition: Arc<Definition>,
    control: Control,
    plant: Plant,
    memory: Memory,
    variables: Variables,
    r_parameters: RParameters,
    plc: Plc,
    forces: Vec<Force>,
    queue: Vec<Command>,
    /// Slides and encoders to be displaced in this step, with the measuring system that was active then.
    displaced: Vec<(Fault, Option<u8>)>,
    cycle: u64,
    time: Time,
    feedback: PerAxis<Feedback>,
    before: Before,
    alarms_before: Vec<RaisedAlarm>,
    recorder: Recorder,
}

impl Machine {
    /// What was odd in its files but did not hinder, for people.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.definition.warnings
    }

    /// Gives the machine a PLC program; its OB100 runs in the next step.
    pub fn load_program(&mut self, program: Box<dyn PlcProgram>) {
        self.plc.load(program);
    }

    /// How many cycles have been run.
    #[must_use]
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The interpolation cycle.
    #[must_use]
    pub fn cycle_time(&self) -> Time {
        self.control.parameters().cycle
    }

    /// Simulated time since the machine was opened.
    #[must_use]
    pub fn time(&self) -> Time {
        self.time
    }

    /// The bytes of the interface and of the PLC.
    #[must_use]
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// What the control shows beside bits.
    #[must_use]
    pub fn variables(&self) -> &Variables {
        &self.variables
    }

    /// The R parameters of its channels.
    #[must_use]
    pub fn r_parameters(&self) -> &RParameters {
        &self.r_parameters
    }

    /// The override of an axis that acts, in per cent.
    #[must_use]
    pub fn axis_override(&self, axis: AxisNumber) -> f64 {
        self.control.axis_override(&self.memory.to_nck().axes[axis])
    }

    /// The overrides of a channel that act, in per cent: feed and rapid traverse.
    #[must_use]
    pub fn channel_overrides(&self, channel: ChannelNumber) -> [f64; 2] {
        self.control.channel_overrides(&self.memory.to_nck().channels[channel])
    }

    /// The speed of the motor of an axis in rev/min, behind pitch and gear.
    #[must_use]
    pub fn motor_speed(&self, axis: AxisNumber) -> f64 {
        self.control.motor_speed(axis, self.variables.axes[axis].velocity)
    }

    /// What axes and channels are called.
    #[must_use]
    pub fn names(&self) -> &Names {
        &self.definition.names
    }

    /// The machine axis of this name.
    #[must_use]
    pub fn axis(&self, name: &str) -> Option<AxisNumber> {
        self.definition.names.axis(name)
    }

    /// The machine data that act.
    #[must_use]
    pub fn machine_data(&self) -> &MachineData {
        self.control.active()
    }

    /// The machine data as they are stored; those that differ from [`Machine::machine_data`] act when their class says.
    #[must_use]
    pub fn stored_machine_data(&self) -> &MachineData {
        self.control.stored()
    }

    /// Where the reference point approach of an axis is.
    #[must_use]
    pub fn approach_phase(&self, axis: AxisNumber) -> ApproachPhase {
        self.control.approach_phase(axis)
    }

    /// Where the gantry grouping of this number, 1 to 8, is; `None` where the machine data define none.
    #[must_use]
    pub fn grouping_phase(&self, number: u8) -> Option<GroupingPhase> {
        self.control.grouping_phase(number)
    }

    /// Which steps of referencing and of the gantry groupings its control has taken.
    #[must_use]
    pub fn taken_transitions(&self) -> TakenTransitions {
        self.control.taken_transitions()
    }

    /// Whether the PLC is stopped: it was asked to, or its program failed.
    #[must_use]
    pub fn is_plc_stopped(&self) -> bool {
        self.plc.stopped
    }

    /// Why the PLC program stopped by itself, if it did.
    #[must_use]
    pub fn plc_fault(&self) -> Option<&str> {
        self.plc.fault()
    }

    /// How overrides are coded, for values such as `"100%"`.
    #[must_use]
    pub fn override_coding(&self) -> OverrideCoding {
        override_coding(self.control.active())
    }

    /// The record since it was last drained.
    #[must_use]
    pub fn recorder(&self) -> &Recorder {
        &self.recorder
    }

    /// Computes every axis in every cycle, also those that rest: slower, and the same bytes.
    pub fn never_rest(&mut self) {
        self.control.never_rest();
    }

    /// Forgets the record that has been read.
    pub fn drain(&mut self) {
        self.recorder.clear();
    }
}

impl std::fmt::Debug for Machine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Machine").field("cycle", &self.cycle).field("time", &self.time).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests;
