//! The command queue. Commands are executed at the edge of the next step, in the order in which they were queued.

use std::sync::Arc;

use super::written::Force;
use super::{Command, Fault, FaultKind, Machine};
use crate::control::ControlCommand;
use crate::image::{Location, Part};
use crate::source::Problem;
use crate::units::AxisSet;
use crate::variables::RParameters;

impl Machine {
    /// Queues a command for the edge of the next step.
    ///
    /// # Errors
    /// As [`Machine::check`]. In this case nothing is queued.
    pub fn queue(&mut self, command: Command) -> Result<(), Problem> {
        self.check(&command)?;
        self.state.queue.push(command);
        self.before.written.make_room(&self.state.memory);
        Ok(())
    }

    /// Checks whether a command can be queued now.
    ///
    /// # Errors
    /// A machine datum, R parameter or handwheel does not exist, or a value does not fit it.
    pub fn check(&self, command: &Command) -> Result<(), Problem> {
        if let Some(command) = of_the_control(command) {
            self.control.check(&command)?;
        }
        if let Command::RParameter { number, value, .. } = command
            && (*number >= RParameters::COUNT || !value.is_finite())
        {
            return Err(Problem::new(
                format!("expected a finite value for R0 to R{}, found {value} for R{number}", RParameters::COUNT - 1),
                "a channel has 100 R parameters",
            ));
        }
        Ok(())
    }

    /// The queued commands, in the order of execution.
    #[must_use]
    pub fn queued(&self) -> &[Command] {
        &self.state.queue
    }

    /// Executes the queued commands.
    pub(super) fn take_commands(&mut self) {
        self.before.written.clear();
        self.before.power_on = false;
        if self.state.queue.is_empty() {
            return;
        }
        // Those that were saved with the machine.
        self.before.written.make_room(&self.state.memory);
        let mut queue = std::mem::take(&mut self.state.queue);
        for command in queue.drain(..) {
            if let Some(command) = of_the_control(&command) {
                self.control.command(&command);
                continue;
            }
            match command {
                Command::Write { location, value } => self.write(location, value),
                Command::Force { location, value } => {
                    self.state.forces.retain(|force| force.location != location);
                    self.state.forces.push(Force { location, value });
                }
                Command::Release { location } => self.state.forces.retain(|force| !force.location.overlaps(location)),
                Command::RParameter { channel, number, value } => {
                    self.state.r_parameters.set(channel, number, value);
                }
                Command::PowerOn => self.power_on(),
                Command::PlcStop => self.state.plc.stopped = true,
                Command::PlcRun => {
                    self.state.plc.restart();
                    self.control.command(&ControlCommand::PlcRestarted);
                }
                Command::PlcColdRestart => {
                    self.forget_plc_memory();
                    self.restart_program();
                    self.control.command(&ControlCommand::PlcRestarted);
                }
                // A single displacement acts after the mechanics of this step, so that encoders and monitoring detect all of it.
                Command::Fault(fault @ Fault { kind: FaultKind::Push { .. } | FaultKind::EncoderSlip { .. }, .. }) => {
                    self.state.displaced.push((fault, self.control.measuring_system(fault.axis)));
                    self.control.command(&ControlCommand::Wake);
                }
                Command::Fault(fault) => self.break_something(fault),
                Command::ClearFault(fault) => {
                    self.state.plant.clear_fault(fault);
                    self.state.plant.press_switches(&self.definition.layout, AxisSet::of(fault.axis));
                    self.control.command(&ControlCommand::Wake);
                }
                Command::MachineDatum { .. } | Command::NewConf | Command::Cancel | Command::Handwheel { .. } => {}
            }
        }
        self.state.queue = queue;
    }

    /// The program starts again, in OB100.
    fn restart_program(&mut self) {
        if let Some(program) = &mut self.program {
            program.reset();
        }
        self.state.plc.restart();
    }

    fn write(&mut self, location: Location, value: u64) {
        self.state.memory.write(location, value);
        self.before.written.push(location, value);
        if matches!(location.part, Part::FromNck | Part::Hmi) {
            self.control.command(&ControlCommand::Written(location));
        }
    }

    /// The bytes that the PLC writes return to their initial values. The bytes that others write stay: the NCK's half, the operator panel,
    /// inputs.
    fn forget_plc_memory(&mut self) {
        let first = Arc::clone(&self.definition);
        for part in [Part::ToNck, Part::Outputs, Part::Flags, Part::Timers, Part::Counters] {
            self.state.memory.part_mut(part).copy_from_slice(first.memory.part(part));
        }
        for block in first.memory.blocks.iter() {
            self.state.memory.part_mut(Part::Block(block.number)).copy_from_slice(&block.bytes);
        }
    }

    pub(super) fn displace(&mut self) {
        while let Some((fault, active)) = self.state.displaced.pop() {
            self.state.plant.fault(fault, active);
        }
    }

    fn break_something(&mut self, fault: Fault) {
        let active = self.control.measuring_system(fault.axis);
        self.state.plant.fault(fault, active);
        self.state.plant.press_switches(&self.definition.layout, AxisSet::of(fault.axis));
        self.control.command(&ControlCommand::Wake);
    }

    /// Power off and on: interface, PLC memory and forces start again; plant, faults and stored machine data stay.
    fn power_on(&mut self) {
        self.control.power_on();
        self.state.plant.power_on(&self.definition.layout);
        self.state.memory = self.definition.memory.clone();
        self.state.variables = crate::variables::Variables::default();
        self.state.forces.clear();
        self.before.written.clear();
        self.before.power_on = true;
        self.restart_program();
        self.sense(AxisSet::ALL);
    }
}

/// The command to the control that a command contains.
fn of_the_control(command: &Command) -> Option<ControlCommand> {
    match command {
        Command::MachineDatum { target, value } => {
            Some(ControlCommand::Store { target: target.clone(), value: value.clone() })
        }
        Command::NewConf => Some(ControlCommand::Activate),
        Command::Cancel => Some(ControlCommand::Cancel),
        &Command::Handwheel { number, pulses, cycles } => Some(ControlCommand::Handwheel { number, pulses, cycles }),
        Command::Write { .. }
        | Command::Force { .. }
        | Command::Release { .. }
        | Command::RParameter { .. }
        | Command::PowerOn
        | Command::PlcStop
        | Command::PlcRun
        | Command::PlcColdRestart
        | Command::Fault(_)
        | Command::ClearFault(_) => None,
    }
}
