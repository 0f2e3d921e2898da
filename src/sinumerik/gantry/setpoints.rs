//! Setpoints and coupling: executes the commanded motions. The axes of a closed grouping take the movement of the axis that leads
//! in the same cycle (DYN-01); if its jerk is limited, they take the filtered movement.

use arrayvec::ArrayVec;

use crate::sinumerik::axis::travel::{Travel, command_signal};
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::groupings::SYNCHRONOUS_AXES;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{Input, Place};

impl State {
    /// Setpoints of one unit.
    pub(in crate::sinumerik) fn set_setpoints(&mut self, unit: &Unit, parameters: &Parameters) {
        let cycle = parameters.cycle.seconds();
        for axis in unit.members() {
            self.axes[axis].before = self.axes[axis].setpoint.position;
        }
        // A unit that loses its enables brakes together, with the shortest of its emergency ramps.
        let emergency = |axis: AxisNumber| parameters.axes[axis].emergency_deceleration;
        let leader = unit.leader();
        if self.axes[leader].speed_controlled {
            self.axes[leader].brake_without_control(emergency(leader));
            self.axes[leader].execute_speed(&parameters.axes[leader], cycle);
            return;
        }
        match unit.grouping.map(usize::from) {
            None => self.axes[unit.leader()].brake_without_control(emergency(unit.leader())),
            Some(index) => {
                for (axis, emergency) in self.groupings[index].coupling.stop(emergency) {
                    self.axes[axis].brake_without_control(emergency);
                }
            }
        }
        match unit.grouping.map(usize::from).filter(|&index| self.groupings[index].coupling.is_closed()) {
            Some(index) => self.set_coupled_setpoints(index, parameters, cycle),
            None => {
                for axis in unit.members() {
                    self.axes[axis].execute(self.shaping[axis].as_deref_mut(), &parameters.axes[axis], cycle);
                }
            }
        }
    }

    /// The axis that leads moves, and the others follow it if they are in position control.
    fn set_coupled_setpoints(&mut self, index: usize, parameters: &Parameters, cycle: f64) {
        let (leads, leader) = (self.groupings[index].coupling.leads_now(), self.groupings[index].coupling.leader());
        let before = self.axes[leads].setpoint.position;
        self.axes[leads].execute(self.shaping[leads].as_deref_mut(), &parameters.axes[leads], cycle);
        let axis = &self.axes[leads];
        let moves = axis.enabling.moves();
        let travel = axis.travel;
        // A stop is braking harder than any acceleration, or braking before switching off. All axes make it in the same way.
        let stops = !axis.enabling.is_on() || axis.motion.is_fast(parameters.axes[leads].dynamics.jerk.hardest);
        let movement = axis.setpoint.moved_from(before);
        let led: ArrayVec<_, SYNCHRONOUS_AXES> = self.groupings[index].coupling.lead(movement).collect();
        for (axis, movement) in led {
            if moves && self.axes[axis].enabling.moves() {
                let velocity = self.axes[axis].setpoint.velocity();
                self.axes[axis].setpoint.follow(movement);
                if axis != leader && !stops && self.axes[axis].enabling.is_on() {
                    self.watch_overload(axis, velocity, parameters);
                }
            } else {
                self.axes[axis].execute(self.shaping[axis].as_deref_mut(), &parameters.axes[axis], cycle);
            }
            // SIG-09: the travel command of the leading axis is also displayed on the synchronous axes.
            let mirrored = if leads == leader { travel.of_led_axis() } else { Travel::None };
            if self.axes[axis].travel != mirrored {
                let (rule, begun) = if leads == leader {
                    (Rule::CommandOfLeadingAxis, self.axes[leader].causes.motion)
                } else {
                    (Rule::WithoutCommand, self.groupings[index].cause)
                };
                let command = travel.command(parameters);
                let commands = [1, -1].map(|sign| axis_signal(leads, command_signal(sign), command == sign));
                let cause = self.log.now(Place::Axis(axis), begun, rule, [commands[0], commands[1], Input::None]);
                self.travel(axis, mirrored, cause);
            }
        }
    }
}
