//! ONE STEP of a machine: control, simulated mechanics and PLC program in a fixed order. Also open, queue, power, save, restore and fork.
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
//! `step.rs` defines the order of a step, `open.rs` reads machines, `command.rs` lists the commands from outside, `queue.rs` queues them
//! and executes them at the edge of the next step, `delay.rs` delays the halves of the interface, `changes.rs` finds the changes for the
//! record, `conditions.rs` says what a signal waits for, `saved.rs` saves, restores and forks.

mod before;
mod changes;
mod command;
mod conditions;
mod definition;
mod delay;
mod describe;
mod nc_services;
mod open;
mod panel;
mod plc;
mod queue;
mod saved;
mod state;
mod step;
mod stop;
mod written;

pub use crate::control::FunctionGenerator;
pub use crate::control::SearchKind;
pub use crate::control::Value as DatumValue;
pub use crate::motion::Waveform;
pub use crate::plant::{Fault, FaultKind, Switch};
pub use command::{Command, PlcOrder};
pub use conditions::{Subject, Tested};
pub use open::OpenOptions;
pub use panel::Panel;
pub use saved::Snapshot;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use crate::control::{Control, Finding};
use crate::image::{Location, Memory, Names, OverrideCoding, PartBytes};
use crate::nc_program::Program;
use crate::plc::{PlcDiagnosis, PlcProgram, ProgramCause, Programs, step7};
use crate::source::{Place, Problem};
use crate::trace::Recorder;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, Time};
use crate::variables::{RaisedAlarm, Variables};

use before::Before;
use definition::Definition;
use state::State;

/// A machine: a control, its simulated mechanics and its PLC program.
pub struct Machine {
    definition: Arc<Definition>,
    control: Box<dyn Control>,
    program: Option<Box<dyn PlcProgram>>,
    state: State,
    before: Before,
    alarms_before: Vec<RaisedAlarm>,
    recorder: Recorder,
}

impl Machine {
    /// Findings in its files that did not prevent opening, the heaviest first.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.definition.findings
    }

    /// The findings in one line; empty without findings. `opennck machine-data check` lists them.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.definition.warnings
    }

    /// Loads a PLC program. Its OB100 runs in the next step. The memory after power on gets the data blocks of the program, and its areas
    /// become as large as the program needs them.
    pub fn load_program(&mut self, mut program: Box<dyn PlcProgram>) {
        let mut memory = self.definition.memory.clone();
        // The control names channels that the machine does not have, too.
        let mut names = self.definition.names.clone();
        for (channel, name) in names.channels.iter_mut() {
            name.take_if(|_| !self.control.has_channel(channel));
        }
        program.install(&mut memory, &names);
        let is_changed = memory != self.definition.memory;
        if is_changed || program.cycle().is_some() {
            let plc_cycle = program.cycle().or(self.definition.plc_cycle);
            self.definition = Arc::new(self.definition.with_program(memory, plc_cycle));
        }
        if is_changed {
            program.install(&mut self.state.memory, &names);
            self.before = Before::new(&self.state.memory);
        }
        self.program = Some(program);
        self.state.plc.restart();
    }

    /// Loads the PLC program with a name: a registered one, or with a `/` in the name the folder of a STEP 7 program, which is searched in
    /// `directories`, in order.
    ///
    /// # Errors
    /// No program has this name, it cannot run on this machine, or its sources have findings.
    pub fn load_named(&mut self, name: &str, directories: &[&Path], programs: &Programs) -> Result<(), Problem> {
        let program = if Programs::is_folder(name) {
            step7::load(&step7::folder(name, directories), name)?.boxed()
        } else {
            programs.program(name, self.names())?
        };
        self.load_program(program);
        Ok(())
    }

    /// Loads the PLC program that `plant.toml` names, if it does.
    ///
    /// # Errors
    /// As [`Machine::load_named`], with the place in the file.
    pub fn load_own_program(&mut self, programs: &Programs) -> Result<(), Problem> {
        let Some((name, place)) = self.definition.plc.clone() else { return Ok(()) };
        let directory = Path::new(&*place.file).parent().map(Path::to_owned).unwrap_or_default();
        self.load_named(&name, &[&directory], programs).map_err(|problem| problem.at(&place))
    }

    /// The name of the PLC program in `plant.toml`, and where it is.
    #[must_use]
    pub fn own_program(&self) -> Option<(&str, &Place)> {
        self.definition.plc.as_ref().map(|(name, place)| (name.as_str(), place))
    }

    /// Observes the PLC program from now on, for [`Machine::program_causes`] and [`Machine::program_coverage`].
    pub fn observe_program(&mut self) {
        if let Some(program) = &mut self.program {
            program.observe();
        }
    }

    /// Why the PLC program changed bits in the last cycle, if it is observed and says so, and what a STOP of the PLC reset.
    #[must_use]
    pub fn program_causes(&self) -> Vec<ProgramCause> {
        let mut causes = self.program.as_ref().map_or_else(Vec::new, |program| program.causes(self.state.cycle));
        causes.extend(self.causes_of_stop());
        causes
    }

    /// The symbols of the PLC program for bits, timers and counters, by their addresses such as `I1.0` and `T5`; none if it has no table.
    #[must_use]
    pub fn program_symbols(&self) -> Option<&Arc<BTreeMap<String, String>>> {
        self.program.as_ref()?.symbols()
    }

    /// What the PLC program does with a bit, a word, or the word of a timer in its next scan: the statements that write it, in order, with the
    /// operands that decide. Empty if it writes it in no statement that runs, or does not say so.
    #[must_use]
    pub fn program_writes(&self, location: Location) -> Vec<ProgramCause> {
        let Ok(mut next) = self.fork() else { return Vec::new() };
        let Some(program) = &mut next.program else { return Vec::new() };
        program.observe_every_write();
        for _ in 0..=self.state.plc.wait {
            next.step();
            next.drain();
        }
        next.program_causes().into_iter().filter(|cause| cause.wrote(location).is_some()).collect()
    }

    /// What ran of the PLC program since it is observed, if it is a program with statements.
    #[must_use]
    pub fn program_coverage(&self) -> Option<step7::Coverage> {
        self.program.as_ref()?.coverage()
    }

    /// Number of cycles run so far.
    #[must_use]
    pub fn cycle(&self) -> u64 {
        self.state.cycle
    }

    /// The interpolation cycle.
    #[must_use]
    pub fn cycle_time(&self) -> Time {
        self.control.cycle_times().interpolation
    }

    /// Simulated time since the machine was opened.
    #[must_use]
    pub fn time(&self) -> Time {
        self.state.time
    }

    /// The bytes of the interface and of the PLC.
    #[must_use]
    pub fn memory(&self) -> &Memory {
        &self.state.memory
    }

    /// Values of the control other than bits.
    #[must_use]
    pub fn variables(&self) -> &Variables {
        &self.state.variables
    }

    /// The value of an R parameter; `None` if it does not exist.
    #[must_use]
    pub fn r_parameter(&self, channel: ChannelNumber, number: u16) -> Option<f64> {
        self.control.r_parameter(channel, number)
    }

    /// Puts NC programs into the memory of the control, in the place of those with the same paths. Subprograms are found beside their
    /// caller, then in the folders of `search_path`.
    pub fn load_programs(&mut self, programs: Vec<Program>, search_path: Vec<String>) {
        self.control.load_programs(programs, search_path);
    }

    /// The NC programs in memory as a text in the form of an archive: first the one with this path, then, if `all`, the others. `None` if no
    /// program has this path.
    #[must_use]
    pub fn program_text(&self, path: &str, all: bool) -> Option<String> {
        self.control.program_text(path, all)
    }

    /// The effective override of an axis, in per cent.
    #[must_use]
    pub fn axis_override(&self, axis: AxisNumber) -> f64 {
        self.control.axis_override(axis, self.state.plc_side())
    }

    /// The effective override of a spindle, in per cent.
    #[must_use]
    pub fn spindle_override(&self, axis: AxisNumber) -> f64 {
        self.control.spindle_override(axis, self.state.plc_side())
    }

    /// The effective overrides of a channel, in per cent: feed and rapid traverse.
    #[must_use]
    pub fn channel_overrides(&self, channel: ChannelNumber) -> [f64; 2] {
        self.control.channel_overrides(channel, self.state.plc_side())
    }

    /// The motor speed of an axis in rev/min, with pitch and gear.
    #[must_use]
    pub fn motor_speed(&self, axis: AxisNumber) -> f64 {
        self.control.motor_speed(axis, self.state.variables.axes[axis].velocity)
    }

    /// The names of axes and channels.
    #[must_use]
    pub fn names(&self) -> &Names {
        &self.definition.names
    }

    /// The machine axis of this name.
    #[must_use]
    pub fn axis(&self, name: &str) -> Option<AxisNumber> {
        self.definition.names.axis(name)
    }

    /// Whether the machine has this channel, according to the stored data of its control.
    #[must_use]
    pub fn has_channel(&self, channel: ChannelNumber) -> bool {
        self.control.has_channel(channel)
    }

    /// Whether the machine has this mode group, according to the stored data of its control: one with a channel.
    #[must_use]
    pub fn has_mode_group(&self, mode_group: ModeGroupNumber) -> bool {
        self.control.has_mode_group(mode_group)
    }

    /// The PLC's half of the interface as the control reads it, if it reads it later than it is written (`to_nck_delay`).
    #[must_use]
    pub fn read_late(&self) -> Option<&PartBytes> {
        self.state.to_nck.late()
    }

    /// The control. `downcast` gives access to a specific type.
    #[must_use]
    pub fn control(&self) -> &(dyn Control + 'static) {
        &*self.control
    }

    /// Starts the PLC program if it is in another process. Without this call it starts in the first step.
    ///
    /// # Errors
    /// The process cannot start.
    pub fn begin_program(&mut self) -> Result<(), Problem> {
        self.program.as_mut().map_or(Ok(()), |program| program.begin())
    }

    /// Whether the PLC is stopped, by a command or because its program failed.
    #[must_use]
    pub fn is_plc_stopped(&self) -> bool {
        self.state.plc.stopped
    }

    /// The memory after power on, if the last step began with power off and on.
    #[must_use]
    pub fn powered_on(&self) -> Option<&Memory> {
        self.before.power_on.as_deref()
    }

    /// The fault that stopped the PLC program, if any.
    #[must_use]
    pub fn plc_fault(&self) -> Option<&str> {
        self.state.plc.fault.as_deref()
    }

    /// The fault that stopped the PLC program, if it is a program with a place in its sources.
    #[must_use]
    pub fn program_fault(&self) -> Option<&str> {
        self.plc_fault().filter(|_| self.state.plc.diagnosis.is_some())
    }

    /// The entries of this fault for the diagnostic buffer, if the program is one of a CPU with such entries.
    #[must_use]
    pub fn plc_diagnosis(&self) -> Option<PlcDiagnosis> {
        self.state.plc.diagnosis
    }

    /// The coding of overrides, for values such as `"100%"`.
    #[must_use]
    pub fn override_coding(&self) -> OverrideCoding {
        self.control.override_coding()
    }

    /// The record since it was last drained.
    #[must_use]
    pub fn recorder(&self) -> &Recorder {
        &self.recorder
    }

    /// Moves, monitors and publishes every axis in every cycle, including axes at rest: slower, with identical bytes.
    pub fn never_rest(&mut self) {
        self.control.never_rest();
    }

    /// Also makes all decisions for every axis in every cycle: even slower, with identical bytes.
    pub fn decide_always(&mut self) {
        self.control.decide_always();
    }

    /// Removes the record after it has been read.
    pub fn drain(&mut self) {
        self.recorder.clear();
    }
}

impl std::fmt::Debug for Machine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Machine")
            .field("cycle", &self.state.cycle)
            .field("time", &self.state.time)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests;
