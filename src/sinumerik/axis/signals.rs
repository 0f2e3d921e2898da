//! Axis disable 1.3, delete distance-to-go 2.2 and ramp-function generator fast stop 20.1: their effects on a unit.
//!
//! Called once per cycle for each unit: [`State::take_axis_signals`] before it is moved,
//! [`State::stop_by_ramp_function_generator`] when its motions are commanded. Axis disable acts on the leading axis, for all axes
//! of its unit, and has no effect on a synchronous axis (SIG-03). Delete distance-to-go acts on the leading axis and has no
//! effect on a synchronous axis (SIG-04). The fast stop of any axis acts on the whole unit (SIG-07) and is displayed as 92.1 on
//! each axis.
//!
//! Choices where the manuals leave one. **Axis disable**: setpoint and display continue while position control holds each axis at
//! its previous setpoint. It ends when 1.3 is 0 and the setpoints are at rest: then the setpoints take the held position, so that
//! nothing moves. An approach or a synchronising motion neither starts nor continues (20005). **Delete distance-to-go**: its
//! rising edge ends an increment or a handwheel movement. A movement without an end (continuous, reference point approach) has no
//! distance to delete. **Fast stop**: the drives brake to speed 0 on their own, position control stays active and its setpoint
//! follows the actual value. Increments and handwheel movements are dropped, an approach ends with 20005, and a key that is still
//! held continues its movement when 20.1 is reset.

use crate::image::{ToNck, axis_from_nck, axis_to_nck};
use crate::motion::Motion;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::jog::state::Movement;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Place};

impl State {
    /// Reads the signals of one unit.
    pub(in crate::sinumerik) fn take_axis_signals(&mut self, unit: &Unit, to_nck: &ToNck) {
        let leader = unit.leader();
        let stopped_by = unit.members().find(|&axis| to_nck.axes[axis].ramp_function_generator_fast_stop());
        let in_test = self.programs[unit.channel].test.axes.contains(leader);
        let disable = to_nck.axes[leader].axis_spindle_disable() || in_test;
        for number in unit.members() {
            let delete = to_nck.axes[number].delete_distance_to_go_spindle_reset();
            let was = std::mem::replace(&mut self.axes[number].signals.delete_was, delete);
            if delete && !was && number == leader {
                self.delete_distance_to_go(leader);
            }
            if stopped_by.is_some() != self.axes[number].signals.fast_stop {
                let axis = stopped_by.unwrap_or(number);
                let input = axis_signal(axis, axis_to_nck::ramp_function_generator_fast_stop, stopped_by.is_some());
                let event = self.log.note_one(Place::Axis(number), Rule::FastStop, input, EventId::NONE);
                self.axes[number].signals.fast_stop = stopped_by.is_some();
                self.axes[number].signals.fast_stop_cause = event;
            }
        }
        if disable || self.axes[leader].signals.disabled_at.is_some() {
            self.disable(unit, disable);
        }
    }

    /// Axis disable, from its start until the setpoints are at rest after it.
    fn disable(&mut self, unit: &Unit, disable: bool) {
        let leader = unit.leader();
        let rest = unit.members().all(|axis| self.axes[axis].setpoint.is_at_rest() || self.axes[axis].speed_controlled);
        let ends = !disable && rest;
        if disable != self.axes[leader].signals.disabled_at.is_some() && (disable || ends) {
            let input = axis_signal(leader, axis_to_nck::axis_spindle_disable, disable);
            let by_test = self.programs[unit.channel].test.axes.contains(leader);
            let test = self.programs[unit.channel].test.cause;
            if by_test {
                self.log.note_plain(Place::Axis(leader), Rule::ProgramTest, test);
            } else {
                self.log.note_one(Place::Axis(leader), Rule::AxisDisable, input, EventId::NONE);
            }
        }
        for number in unit.members() {
            let axis = &mut self.axes[number];
            if axis.enabling.follow_up {
                axis.signals.hold_at(axis.actual);
            }
            let held = axis.signals.disabled_at.unwrap_or(axis.setpoint.position);
            if ends {
                axis.signals.disabled_at = None;
                axis.setpoint = crate::motion::Setpoint::at(held);
                axis.jogging.movement = Movement::None;
            } else {
                axis.signals.disabled_at = Some(held);
            }
        }
    }

    fn delete_distance_to_go(&mut self, number: AxisNumber) {
        match self.axes[number].jogging.movement {
            Movement::Pending(..) | Movement::Path(..) => {}
            Movement::None | Movement::Continuous(_) => return,
        }
        self.axes[number].jogging.movement = Movement::None;
        let input = axis_signal(number, axis_to_nck::delete_distance_to_go_spindle_reset, true);
        let event = self.log.note_one(Place::Axis(number), Rule::DistanceDeleted, input, EventId::NONE);
        self.travel(number, Travel::None, event);
    }

    /// The signal that disables an approach or a synchronising motion of a unit: axis disable or the fast stop.
    pub(in crate::sinumerik) fn motion_forbidden(&self, unit: &Unit) -> Option<Input> {
        let leader = unit.leader();
        if self.axes[leader].signals.disabled_at.is_some() {
            return Some(axis_signal(leader, axis_to_nck::axis_spindle_disable, true));
        }
        self.axes[leader]
            .signals
            .fast_stop
            .then(|| axis_signal(leader, axis_from_nck::ramp_function_generator_disable_active, true))
    }

    /// During the fast stop the setpoint follows the axis, whatever else is commanded.
    pub(in crate::sinumerik) fn stop_by_ramp_function_generator(&mut self, unit: &Unit) {
        if self.axes[unit.leader()].signals.fast_stop {
            for axis in unit.members() {
                self.axes[axis].motion = Motion::Track;
            }
        }
    }
}
