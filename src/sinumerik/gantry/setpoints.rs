//! Setpoints and coupling: what was commanded becomes a setpoint, and the axes of a closed grouping take the movement
//! of the one that leads, in the same cycle (DYN-01): the filtered one, where its jerk is limited.

use crate::sinumerik::axis::state::ControllerState;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::state::{State, Unit};

impl State {
    /// Setpoints of one unit.
    pub(in crate::sinumerik) fn set_setpoints(&mut self, unit: &Unit, parameters: &Parameters) {
        let cycle = parameters.cycle.seconds();
        // A unit that loses its enables brakes together, by the shortest of its emergency ramps.
        let emergency =
            unit.members().map(|axis| parameters.axes[axis].emergency_deceleration).fold(f64::INFINITY, f64::min);
        for axis in unit.members() {
            self.axes[axis].before = self.axes[axis].setpoint.position;
            if let Some(motion) = self.axes[axis].motion_without_control(emergency) {
                self.axes[axis].motion = motion;
            }
        }
        let coupled = unit.grouping.map(usize::from).filter(|&index| self.groupings[index].coupled);
        let Some(index) = coupled else {
            for axis in unit.members() {
                self.axes[axis].execute(self.shaping[axis].as_deref_mut(), &parameters.axes[axis], cycle);
            }
            return;
        };
        let leads = self.groupings[index].coupling.leads_now();
        let before = self.axes[leads].setpoint.position;
        self.axes[leads].execute(self.shaping[leads].as_deref_mut(), &parameters.axes[leads], cycle);
        let led_by = self.axes[leads].setpoint;
        let moves = matches!(self.axes[leads].enabling.control, ControllerState::On | ControllerState::Braking(_));
        let leader = self.groupings[index].coupling.leader();
        let (request, command, cause) = {
            let axis = &self.axes[leads];
            (axis.traverse_request, axis.traverse_command, axis.causes.motion)
        };
        // Braking harder than any acceleration, and towards being switched off, is a stop that all axes make alike.
        let stops = !self.axes[leads].enabling.is_on()
            || self.axes[leads].motion.is_fast(parameters.axes[leads].dynamics.jerk.hardest);
        for axis in unit.members().filter(|&axis| axis != leads) {
            let follows =
                moves && matches!(self.axes[axis].enabling.control, ControllerState::On | ControllerState::Braking(_));
            if follows {
                let velocity = self.axes[axis].setpoint.velocity();
                self.axes[axis].setpoint.follow(led_by.moved_from(before));
                if axis != leader && !stops && self.axes[axis].enabling.is_on() {
                    self.watch_overload(axis, velocity, parameters);
                }
            } else {
                self.axes[axis].execute(self.shaping[axis].as_deref_mut(), &parameters.axes[axis], cycle);
            }
            // SIG-09: when the leading axis is traversed, its command shows on the synchronous axes, too.
            let mirrored = if leads == leader { (request, command) } else { (0, 0) };
            let led = &mut self.axes[axis];
            if (led.traverse_request, led.traverse_command) != mirrored {
                (led.traverse_request, led.traverse_command) = mirrored;
                led.causes.motion = cause;
            }
        }
    }
}
