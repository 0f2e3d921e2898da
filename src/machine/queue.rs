//! The command queue. Commands are executed at the edge of the next step, in the order in which they were queued.

use std::sync::Arc;

use super::written::Force;
use super::{Command, Fault, FaultKind, Machine};
use crate::control::ControlCommand;
use crate::image::{Location, Part};
use crate::source::Problem;
use crate::trace::{By, NoEffect};
use crate::units::{AxisSet, Position};
use crate::variables::{EventId, FaultName, Happening, program_name};

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
    /// A machine datum, R parameter, handwheel, axis or location does not exist, a value does not fit, or the NCK writes what is to be
    /// forced.
    pub fn check(&self, command: &Command) -> Result<(), Problem> {
        if let Some(command) = of_the_control(command) {
            self.control.check(&command)?;
        }
        if let Some(location) = command.location() {
            self.names().check_location(self.memory(), location)?;
            if !matches!(command, Command::Write { .. }) {
                self.names().check_writer(location)?;
            }
        }
        if let Command::Fault(fault) | Command::ClearFault(fault) = command {
            self.check_fault(*fault)?;
        }
        Ok(())
    }

    fn check_fault(&self, Fault { axis, kind }: Fault) -> Result<(), Problem> {
        if self.names().axes[axis].is_none() {
            let known: Vec<_> = self.names().axes.iter().filter_map(|(_, name)| name.as_deref()).collect();
            return Err(Problem::new(
                format!("expected a machine axis, found axis {axis}, which does not exist"),
                format!("machine axes are {}", known.join(", ")),
            ));
        }
        kind.check()
    }

    /// The queued commands, in the order of execution.
    #[must_use]
    pub fn queued(&self) -> &[Command] {
        &self.state.queue
    }

    /// Removes the queued commands before they take effect.
    pub fn forget_queued(&mut self) {
        self.state.queue.clear();
    }

    /// Executes the queued commands.
    pub(super) fn take_commands(&mut self) {
        self.before.written.clear();
        self.before.power_on = None;
        self.before.stuck.clear();
        if self.state.queue.is_empty() {
            return;
        }
        // Those that were saved with the machine.
        self.before.written.make_room(&self.state.memory);
        let mut queue = std::mem::take(&mut self.state.queue);
        for command in queue.drain(..) {
            self.take(&command);
        }
        self.state.queue = queue;
    }

    /// Executes a command. What it does besides a change of the memory becomes a row of the record.
    fn take(&mut self, command: &Command) {
        if let Some(command) = of_the_control(command) {
            let event = self.control.command(&command);
            self.record_command(&command, event, By::Outside);
            return;
        }
        match *command {
            Command::Write { location, value } => self.write(location, value),
            Command::Force { location, value } => {
                self.state.forces.retain(|force| force.location != location);
                self.state.forces.push(Force { location, value });
            }
            Command::Release { location } => {
                let before = self.state.forces.len();
                self.state.forces.retain(|force| !force.location.overlaps(location));
                if self.state.forces.len() == before {
                    self.record_no_effect(NoEffect::Release(location));
                }
            }
            Command::PowerOn => {
                let event = self.power_on();
                self.record_happening(Happening::PowerOn, By::Outside, event);
                self.record_activated(By::PowerOn);
            }
            Command::PlcStop => {
                let is_new = self.enter_stop();
                let event = self.control.command(&ControlCommand::PlcMissing);
                if is_new {
                    self.record_happening(Happening::PlcStopped, By::Outside, event);
                }
            }
            Command::PlcRun => {
                self.state.plc.restart();
                let event = self.control.command(&ControlCommand::PlcRestarted);
                self.record_happening(Happening::PlcStarted, By::Outside, event);
            }
            Command::PlcColdRestart => {
                self.forget_plc_memory();
                self.restart_program();
                if let Some(program) = &mut self.program {
                    program.prepare_cold_restart();
                }
                let event = self.control.command(&ControlCommand::PlcRestarted);
                self.record_happening(Happening::PlcColdRestart, By::Outside, event);
            }
            // A single displacement acts after the mechanics of this step, so that encoders and monitoring detect all of it.
            Command::Fault(fault @ Fault { kind: FaultKind::Push { .. } | FaultKind::EncoderSlip { .. }, .. }) => {
                self.state.displaced.push((fault, self.control.measuring_system(fault.axis)));
                self.report_fault(fault, true);
            }
            Command::Fault(fault) => {
                let active = self.control.measuring_system(fault.axis);
                self.state.plant.fault(fault, active);
                self.state.plant.press_switches(&self.definition.layout, AxisSet::of(fault.axis));
                self.report_fault(fault, true);
            }
            Command::ClearFault(fault) => {
                if !self.state.plant.clear_fault(fault) {
                    let (name, _) = named(fault.kind);
                    self.record_no_effect(NoEffect::ClearFault { axis: fault.axis, name });
                    return;
                }
                self.state.plant.press_switches(&self.definition.layout, AxisSet::of(fault.axis));
                self.report_fault(fault, false);
            }
            Command::MachineDatum { .. }
            | Command::RParameter { .. }
            | Command::SelectProgram { .. }
            | Command::EnterBlocks { .. }
            | Command::Preset { .. }
            | Command::Search { .. }
            | Command::FunctionGenerator(_)
            | Command::NewConf
            | Command::Cancel
            | Command::Handwheel { .. } => {}
        }
    }

    /// Records a command that the control has taken. A datum that is active at once has one row.
    pub(super) fn record_command(&mut self, command: &ControlCommand, event: EventId, by: By) {
        match command {
            ControlCommand::Store { target, .. } => {
                if !self.record_activated(by)
                    && let Some(datum) = self.control.data().named(target)
                {
                    self.record_happening(Happening::DatumStored(datum), by, EventId::NONE);
                }
            }
            ControlCommand::Activate => {
                self.record_happening(Happening::DataSetActive, by, event);
                self.record_activated(By::Nck);
            }
            ControlCommand::Cancel => self.record_happening(Happening::CancelKey, by, event),
            &ControlCommand::Handwheel { number, pulses, .. } => {
                self.record_happening(Happening::HandwheelTurned { number, pulses }, by, event);
            }
            ControlCommand::SelectProgram { channel, path } => {
                let (channel, program) = (*channel, program_name(path));
                self.record_happening(Happening::ProgramSelected { channel, program }, by, event);
            }
            &ControlCommand::EnterBlocks { channel, .. } => {
                self.record_happening(Happening::BlocksEntered { channel }, by, event);
            }
            ControlCommand::PlcMissing
            | ControlCommand::PlcRestarted
            | ControlCommand::PlcMessages(_)
            | ControlCommand::RParameter { .. }
            | ControlCommand::Preset { .. }
            | ControlCommand::Search { .. }
            | ControlCommand::FunctionGenerator(_)
            | ControlCommand::Written(_)
            | ControlCommand::Fault { .. } => {}
        }
    }

    /// Reports a fault to the control and to the record.
    fn report_fault(&mut self, fault: Fault, begins: bool) {
        let Fault { axis, kind } = fault;
        let (name, by) = named(kind);
        let affected = self.definition.layout.with_bridged(AxisSet::of(axis));
        let event = self.control.command(&ControlCommand::Fault { axis, name, begins, affected });
        if let FaultKind::SwitchStuck { which, .. } = kind {
            self.before.stuck.push((axis, which, event));
        }
        let by = by.filter(|_| begins);
        self.record_happening(Happening::Fault { axis, name, by, begins }, By::Outside, event);
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
            let _ = self.control.command(&ControlCommand::Written(location));
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

    /// Power off and on: interface, PLC memory and forces start again; plant, faults and stored machine data stay.
    fn power_on(&mut self) -> EventId {
        let event = self.control.power_on();
        self.state.plant.power_on(&self.definition.layout);
        let mut memory = self.definition.memory.clone();
        // O-21: the overrides hold 100 % in the coding that is active now.
        let (before, now) = (self.definition.control.override_coding(), self.control.override_coding());
        memory.recode_overrides(&self.definition.names, before, now);
        self.before.power_on = Some(Box::new(memory.clone()));
        self.state.memory = memory;
        let cycle = self.cycle_time();
        (self.state.to_nck, self.state.from_nck) = self.definition.delays(cycle, &self.state.memory);
        self.state.plc.scans.clear();
        self.state.plc.messages.clear();
        self.state.variables = crate::variables::Variables::default();
        self.state.forces.clear();
        self.before.written.clear();
        self.restart_program();
        self.sense(AxisSet::ALL);
        event
    }
}

/// The name of a fault and its amount in user units, a drift per second as in a scenario.
fn named(kind: FaultKind) -> (FaultName, Option<f64>) {
    match kind {
        FaultKind::Block => (FaultName::Block, None),
        FaultKind::Push { by } => (FaultName::Push, Some(by.user())),
        FaultKind::EncoderSlip { by } => (FaultName::EncoderSlip, Some(by.user())),
        FaultKind::ZeroMarkMissing => (FaultName::ZeroMarkMissing, None),
        FaultKind::DriveFault => (FaultName::DriveFault, None),
        FaultKind::EncoderFault { .. } => (FaultName::EncoderFault, None),
        FaultKind::Friction { by } => (FaultName::Friction, Some(by)),
        FaultKind::Drift { by } => (FaultName::Drift, Some(by / Position::PER_USER_UNIT)),
        FaultKind::SwitchStuck { .. } => (FaultName::SwitchStuck, None),
        FaultKind::Hold { by } => (FaultName::Hold, Some(by.user())),
        FaultKind::MovedByHand { by } => (FaultName::MovedByHand, Some(by.user())),
        FaultKind::DriveNotReady => (FaultName::DriveNotReady, None),
    }
}

/// The command to the control that a command contains.
fn of_the_control(command: &Command) -> Option<ControlCommand> {
    match command {
        Command::MachineDatum { target, value } => {
            Some(ControlCommand::Store { target: target.clone(), value: value.clone() })
        }
        &Command::RParameter { channel, number, value } => Some(ControlCommand::RParameter { channel, number, value }),
        Command::SelectProgram { channel, path } => {
            Some(ControlCommand::SelectProgram { channel: *channel, path: path.clone() })
        }
        Command::EnterBlocks { channel, text } => {
            Some(ControlCommand::EnterBlocks { channel: *channel, text: text.clone() })
        }
        &Command::Preset { axis, value } => Some(ControlCommand::Preset { axis, value }),
        Command::Search { channel, block, kind } => {
            Some(ControlCommand::Search { channel: *channel, block: block.clone(), kind: *kind })
        }
        &Command::FunctionGenerator(one) => Some(ControlCommand::FunctionGenerator(one)),
        Command::NewConf => Some(ControlCommand::Activate),
        Command::Cancel => Some(ControlCommand::Cancel),
        &Command::Handwheel { number, pulses, cycles } => Some(ControlCommand::Handwheel { number, pulses, cycles }),
        Command::Write { .. }
        | Command::Force { .. }
        | Command::Release { .. }
        | Command::PowerOn
        | Command::PlcStop
        | Command::PlcRun
        | Command::PlcColdRestart
        | Command::Fault(_)
        | Command::ClearFault(_) => None,
    }
}
