//! One step, and the PLC in it.

use super::Machine;
use super::written::Force;
use crate::image::{AsBytes, FromNck, Hmi};
use crate::motion::Feedback;
use crate::plc::PlcIo;
use crate::units::{AxisSet, PerAxis};
use crate::variables::{AxisValues, Variables};

impl Machine {
    /// One interpolation cycle. The order of the stages is the specification of who sees whom when.
    pub fn step(&mut self) {
        self.cycle += 1;
        self.time += self.cycle_time();
        // What waited outside.
        let taken = self.take_commands();
        // Plant senses: wired switches are inputs of the PLC.
        self.sense_wired_switches();
        // PLC scan, when its time has come; cams that are not wired; forces.
        self.scan();
        self.note_overwritten();
        self.sense_unwired_switches();
        self.apply_forces();
        // The control decides.
        self.control.select_handwheels(&self.memory.hmi().nck);
        let changes = self.plc_changes();
        self.control.decide(self.cycle, self.memory.to_nck(), changes, taken.cancel);
        // Position control, drives and mechanics.
        let axes = self.definition.layout.with_bridged(self.control.awake());
        self.move_axes(axes);
        self.displace();
        self.sense(axes);
        // Monitoring and alarms, publication, record.
        self.control.observe(&self.feedback, axes);
        let restless = self.plant.restless(axes);
        let memory = &mut self.memory;
        let (from_nck, hmi) = (FromNck::of_mut(&mut memory.from_nck), Hmi::of_mut(&mut memory.hmi));
        self.control.publish(from_nck, hmi, &mut self.variables, restless);
        self.variables.alarms.date(self.time);
        self.record();
    }

    fn scan(&mut self) {
        if self.plc.stopped {
            self.control.plc_missing();
            return;
        }
        if self.plc.wait > 0 {
            self.plc.wait -= 1;
            return;
        }
        let cycle = self.cycle_time();
        self.plc.wait = self.definition.plc_cycle.map_or(0, |every| every.in_cycles(cycle) - 1);
        let Some(program) = &mut self.plc.program else {
            return;
        };
        let memory = &mut self.memory;
        let mut io = PlcIo::<AsBytes> {
            to_nck: &mut memory.to_nck,
            from_nck: &memory.from_nck,
            hmi: &memory.hmi,
            inputs: &memory.inputs,
            outputs: &mut memory.outputs,
            flags: &mut memory.flags,
            timers: &mut memory.timers,
            counters: &mut memory.counters,
            blocks: &mut memory.blocks,
            cycle: self.cycle,
            time: self.time,
            cycle_time: self.time - self.plc.last_scan,
            names: &self.definition.names,
        };
        self.plc.last_scan = self.time;
        let started = std::mem::replace(&mut self.plc.started, true);
        let startup = if started { Ok(()) } else { program.startup(&mut io) };
        if let Err(fault) = startup.and_then(|()| program.scan(&mut io)) {
            self.plc.stopped = true;
            self.plc.fault = Some(fault.reason);
            self.control.plc_missing();
        }
    }

    fn sense_wired_switches(&mut self) {
        for &(axis, switch, input) in &self.definition.layout.wired {
            let pressed = self.plant.pressed(switch).contains(axis);
            self.memory.inputs.set_bit(usize::from(input.byte), input.bit, pressed);
        }
    }

    /// Switches without an input: the simulator itself sets their signals after the PLC scan.
    fn sense_unwired_switches(&mut self) {
        for &(axis, switch, location) in &self.definition.unwired {
            if let Some(byte) = self.memory.to_nck.get_mut(location.offset as usize) {
                let pressed = u8::from(self.plant.pressed(switch).contains(axis));
                *byte = *byte & !(1 << location.bit) | pressed << location.bit;
            }
        }
    }

    fn apply_forces(&mut self) {
        for &Force { location, value } in &self.forces {
            self.memory.write(location, value);
        }
    }

    /// Position control, drives and mechanics, MD10070 / MD10060 times.
    fn move_axes(&mut self, axes: AxisSet) {
        let parameters = self.control.parameters();
        let (count, cycle) = (parameters.servo_cycles, parameters.cycle);
        let servo_cycle = cycle.seconds() / f64::from(count);
        self.plant.run_up(axes, cycle);
        for part in 1..=count {
            let command = |axis, counts| self.control.velocity_command(axis, counts, part, count);
            self.plant.advance(&self.definition.layout, axes, servo_cycle, command);
        }
    }

    /// What drives and encoders tell.
    pub(super) fn sense(&mut self, axes: AxisSet) {
        self.plant.press_switches(&self.definition.layout, axes);
        for axis in axes.iter() {
            self.feedback[axis] = Feedback {
                encoders: self.plant.tell(axis),
                half_count: self.plant.half_counts(axis),
                velocity: self.plant.velocity(axis),
                drive_ready: self.plant.is_drive_ready(axis),
                drive_fault: self.plant.has_drive_fault(axis),
                encoder_faults: self.plant.encoder_faults(axis),
                slide: self.plant.slide(axis),
            };
        }
    }
}

/// The variables of a machine that was just switched on: where its slides are is known before the first cycle.
pub(super) fn first_variables(feedback: &PerAxis<Feedback>) -> Variables {
    let mut variables = Variables::default();
    for (axis, values) in variables.axes.iter_mut() {
        *values = AxisValues { slide: feedback[axis].slide, ..AxisValues::default() };
    }
    variables
}
