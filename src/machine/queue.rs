//! Commands wait here for the edge of the next step, where they are done in the order in which they came.

use std::sync::Arc;

use super::written::Force;
use super::{Command, Fault, FaultKind, Machine};
use crate::image::{Location, Part};
use crate::source::Problem;
use crate::units::AxisSet;
use crate::variables::RParameters;

/// What the commands of one step mean for the rest of it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Taken {
    pub(super) cancel: bool,
}

impl Machine {
    /// Queues a command for the edge of the next step.
    ///
    /// # Errors
    /// As [`Machine::check`]; nothing is queued then.
    pub fn queue(&mut self, command: Command) -> Result<(), Problem> {
        self.check(&command)?;
        self.queue.push(command);
        Ok(())
    }

    /// Whether a command could be queued now.
    ///
    /// # Errors
    /// A machine datum, R parameter or handwheel that does not exist, or a value that does not fit it.
    pub fn check(&self, command: &Command) -> Result<(), Problem> {
        if let Command::MachineDatum { target, value } = command {
            let stored = self.control.stored();
            let target = stored.parse_target(target)?;
            stored.check(&target, value)?;
        }
        if let Command::Handwheel { number, .. } = command
            && !(1..=3).contains(number)
        {
            return Err(Problem::new(
                format!("expected a handwheel from 1 to 3, found {number}"),
                "there are handwheels 1, 2 and 3",
            ));
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

    /// What waits for the edge of the next step, in the order in which it will be done.
    #[must_use]
    pub fn queued(&self) -> &[Command] {
        &self.queue
    }

    /// Does what was queued.
    pub(super) fn take_commands(&mut self) -> Taken {
        let mut taken = Taken::default();
        self.before.written.clear();
        self.before.power_on = false;
        let mut queue = std::mem::take(&mut self.queue);
        for command in queue.drain(..) {
            match command {
                Command::Write { location, value } => self.write(location, value),
                Command::Force { location, value } => {
                    self.forces.retain(|force| force.location != location);
                    self.forces.push(Force { location, value });
                }
                Command::Release { location } => self.forces.retain(|force| !force.location.overlaps(location)),
                Command::MachineDatum { target, value } => {
                    // Checked when it was queued; a later command of the same step may have renamed its axis.
                    if let Ok(target) = self.control.stored().parse_target(&target) {
                        let _ = self.control.store(&target, &value);
                    }
                }
                Command::RParameter { channel, number, value } => {
                    self.r_parameters.set(channel, number, value);
                }
                Command::NewConf => self.control.new_conf(),
                Command::PowerOn => self.power_on(),
                Command::PlcStop => self.plc.stop(),
                Command::PlcRun => {
                    self.plc.restart();
                    self.control.plc_restarted();
                }
                Command::PlcColdRestart => {
                    self.forget_plc_memory();
                    self.plc.power_on();
                    self.control.plc_restarted();
                }
                Command::Cancel => taken.cancel = true,
                Command::Handwheel { number, pulses, cycles } => self.control.turn_handwheel(number, pulses, cycles),
                // What displaces once does so after the mechanics of this step, where encoders and monitoring see all of it.
                Command::Fault(fault @ Fault { kind: FaultKind::Push { .. } | FaultKind::EncoderSlip { .. }, .. }) => {
                    self.displaced.push((fault, self.control.measuring_system(fault.axis)));
                    self.control.wake_all();
                }
                Command::Fault(fault) => self.break_something(fault),
                Command::ClearFault(fault) => {
                    self.plant.clear_fault(fault);
                    self.plant.press_switches(&self.definition.layout, AxisSet::of(fault.axis));
                    self.control.wake_all();
                }
            }
        }
        self.queue = queue;
        taken
    }

    fn write(&mut self, location: Location, value: u64) {
        self.memory.write(location, value);
        self.before.written.push(location, value);
        match location.part {
            Part::FromNck => self.control.half_overwritten(),
            Part::Hmi => {
                for group in self.definition.strobe.touched_by(location) {
                    self.control.strobe_written(group);
                }
            }
            _ => {}
        }
    }

    /// What the PLC writes has its first values again. What others write to it stays: the NCK's half, the operator panel's, inputs.
    fn forget_plc_memory(&mut self) {
        let first = Arc::clone(&self.definition);
        for part in [Part::ToNck, Part::Outputs, Part::Flags, Part::Timers, Part::Counters] {
            self.memory.part_mut(part).copy_from_slice(first.memory.part(part));
        }
        for block in first.memory.blocks.iter() {
            self.memory.part_mut(Part::Block(block.number)).copy_from_slice(&block.bytes);
        }
    }

    pub(super) fn displace(&mut self) {
        while let Some((fault, active)) = self.displaced.pop() {
            self.plant.fault(fault, active);
        }
    }

    fn break_something(&mut self, fault: Fault) {
        let active = self.control.measuring_system(fault.axis);
        self.plant.fault(fault, active);
        self.plant.press_switches(&self.definition.layout, AxisSet::of(fault.axis));
        self.control.wake_all();
    }

    /// Power off and on: interface, PLC memory and forces start anew; plant, faults and stored machine data stay.
    fn power_on(&mut self) {
        self.control.power_on();
        self.plant.power_on(&self.definition.layout);
        self.memory = self.definition.memory.clone();
        self.variables = crate::variables::Variables::default();
        self.forces.clear();
        self.before.written.clear();
        self.before.power_on = true;
        self.plc.power_on();
        self.definition.strobe.apply(&mut self.control);
        self.sense(AxisSet::ALL);
    }
}
