//! One step, including the PLC.

use super::Machine;
use super::nc_services::NcOfMachine;
use super::state::State;
use super::written::Force;
use crate::control::{ControlCommand, ControlSide, CycleTimes};
use crate::image::AsBytes;
use crate::motion::Feedback;
use crate::plc::{PlcFault, PlcIo, PlcProgram};
use crate::trace::By;
use crate::units::{AxisSet, PerAxis};
use crate::variables::{AxisValues, Happening, RParameters, Variables};

impl Machine {
    /// One interpolation cycle. The order of the stages defines in which cycle each part receives the data of the others.
    pub fn step(&mut self) {
        self.state.cycle += 1;
        self.control.begin_cycle(self.state.cycle);
        // Queued commands.
        self.take_commands();
        // Power on can change the length of a cycle, so the time follows it.
        self.state.time += self.cycle_time();
        // Plant signals: wired switches are inputs of the PLC.
        self.sense_wired_switches();
        // PLC scan, if it is due; cams that are not wired; forces.
        let scanned = self.scan();
        self.note_overwritten();
        self.sense_unwired_switches();
        self.apply_forces();
        // The control decides.
        let changes = self.plc_changes(scanned);
        self.control.decide(self.state.plc_side(), changes);
        self.stop_plc();
        self.record_activated(By::Nck);
        // Position control, drives and mechanics.
        let vertical = self.definition.layout.vertical;
        let axes = self.definition.layout.with_bridged(self.control.awake().with(vertical));
        self.move_axes(axes);
        self.displace();
        let changed = self.state.plant.news(axes);
        self.sense(changed);
        // Monitoring and alarms, publication, record.
        self.control.observe(&self.state.feedback, changed);
        let restless = self.state.plant.restless(axes);
        let State { memory, variables, .. } = &mut self.state;
        let out = ControlSide { from_nck: &mut memory.from_nck, hmi: &mut memory.hmi };
        self.control.publish(out, variables, restless);
        let State { from_nck, memory, .. } = &mut self.state;
        from_nck.advance(&memory.from_nck);
        self.state.variables.alarms.date(self.state.time);
        self.record();
    }

    /// Returns whether the PLC has seen the image of the last cycle; without a program nobody looks.
    fn scan(&mut self) -> bool {
        if self.state.plc.stopped {
            let _ = self.control.command(&ControlCommand::PlcMissing);
            return false;
        }
        if self.state.plc.wait > 0 {
            self.state.plc.wait -= 1;
            if self.program.as_ref().is_some_and(|program| program.has_interrupts()) {
                self.run_program(|program, io| program.interrupt(io));
            }
            return false;
        }
        let cycle = self.cycle_time();
        self.state.plc.wait = self.definition.plc_cycle.map_or(0, |every| every.in_cycles(cycle) - 1);
        if self.program.is_some() {
            let started = std::mem::replace(&mut self.state.plc.started, true);
            self.run_program(|program, io| {
                let startup = if started { Ok(()) } else { program.startup(io) };
                startup.and_then(|()| program.scan(io))
            });
            self.state.plc.last_scan = self.state.time;
        }
        true
    }

    /// Runs a part of the program on the memory. If it fails, the PLC stops.
    fn run_program(&mut self, run: impl FnOnce(&mut dyn PlcProgram, &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault>) {
        let Some(program) = &mut self.program else { return };
        let memory = &mut self.state.memory;
        let mut nc = NcOfMachine {
            control: &*self.control,
            variables: &self.state.variables,
            orders: Vec::new(),
            messages: &mut self.state.plc.messages,
            has_new_messages: false,
        };
        let mut io = PlcIo::<AsBytes> {
            to_nck: &mut memory.to_nck,
            from_nck: self.state.from_nck.seen(&memory.from_nck),
            hmi: &memory.hmi,
            inputs: &memory.inputs,
            outputs: &mut memory.outputs,
            flags: &mut memory.flags,
            timers: &mut memory.timers,
            counters: &mut memory.counters,
            blocks: &mut memory.blocks,
            cycle: self.state.cycle,
            time: self.state.time,
            cycle_time: self.state.time - self.state.plc.last_scan,
            names: &self.definition.names,
            nc: &mut nc,
        };
        let done = run(&mut **program, &mut io);
        let NcOfMachine { orders, has_new_messages, .. } = nc;
        if has_new_messages {
            let messages = self.state.plc.messages.clone();
            let _ = self.control.command(&ControlCommand::PlcMessages(messages));
        }
        for order in orders {
            let event = self.control.command(&order);
            self.record_command(&order, event, By::Plc);
        }
        if let Err(fault) = done {
            self.enter_stop();
            self.state.plc.fault = Some(fault.reason);
            self.state.plc.diagnosis = fault.diagnosis;
            let event = self.control.command(&ControlCommand::PlcMissing);
            self.record_happening(Happening::PlcStopped, By::Plc, event);
        }
    }

    /// The control stops the PLC program.
    fn stop_plc(&mut self) {
        if self.state.plc.stopped || self.program.is_none() {
            return;
        }
        let Some(reason) = self.control.stops_plc() else { return };
        self.enter_stop();
        self.state.plc.fault = Some(reason);
        let event = self.control.command(&ControlCommand::PlcMissing);
        self.record_happening(Happening::PlcStopped, By::Nck, event);
    }

    fn sense_wired_switches(&mut self) {
        for &(axis, switch, input) in &self.definition.layout.wired {
            let pressed = self.state.plant.pressed(switch).contains(axis);
            self.state.memory.inputs.set_bit(usize::from(input.byte), input.bit, pressed);
        }
    }

    /// Switches without an input: the simulator itself sets their signals after the PLC scan.
    fn sense_unwired_switches(&mut self) {
        for &(axis, switch, location) in &self.definition.unwired {
            if let Some(byte) = self.state.memory.to_nck.get_mut(location.offset as usize) {
                let pressed = u8::from(self.state.plant.pressed(switch).contains(axis));
                *byte = *byte & !(1 << location.bit) | pressed << location.bit;
            }
        }
    }

    fn apply_forces(&mut self) {
        for &Force { location, value } in &self.state.forces {
            self.state.memory.write(location, value);
        }
    }

    /// Position control, drives and mechanics, once per position-control cycle.
    fn move_axes(&mut self, axes: AxisSet) {
        let CycleTimes { interpolation: cycle, position_control: count } = self.control.cycle_times();
        let servo_cycle = cycle.seconds() / f64::from(count);
        self.state.plant.run_up(axes, cycle);
        let open = self.definition.layout.vertical.iter().filter(|axis| self.control.opens_brake(*axis)).collect();
        self.state.plant.move_brakes(&self.definition.layout, open, cycle);
        let (layout, mut moving) = (&self.definition.layout, axes);
        for part in 1..=count {
            let command = |axis, counts| self.control.velocity_command(axis, counts, part, count);
            let changed = self.state.plant.advance(layout, moving, servo_cycle, command);
            // Axes that did not move and have an unchanged command do not move in the other parts either.
            moving = layout.with_bridged(moving.without(self.control.still()).with(changed));
        }
    }

    /// Takes the feedback of drives and encoders.
    pub(super) fn sense(&mut self, axes: AxisSet) {
        self.state.plant.press_switches(&self.definition.layout, axes);
        for axis in axes.iter() {
            let mut feedback = self.state.plant.feedback(&self.definition.layout, axis);
            feedback.cam = self.state.plant.pressed(crate::plant::Switch::Cam).contains(axis);
            self.state.feedback[axis] = feedback;
        }
    }
}

/// The variables of a machine after power on: the positions of its slides and its R parameters are known before the first cycle.
pub(super) fn first_variables(feedback: &PerAxis<Feedback>, r_parameters: RParameters) -> Variables {
    let mut variables = Variables { r_parameters, ..Variables::default() };
    for (axis, values) in variables.axes.iter_mut() {
        *values = AxisValues { slide: feedback[axis].slide, ..AxisValues::default() };
    }
    variables
}
