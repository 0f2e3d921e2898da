//! The loop of a spindle: in speed control the drive gets the speed of the setpoint, and the setpoint stays with the actual value.

use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::units::Position;

impl Axis {
    /// Executes the command of the cycle in speed control: the setpoint has the commanded velocity at the actual position.
    pub(in crate::sinumerik) fn execute_speed(&mut self, parameters: &AxisParameters, cycle: f64) {
        self.arrived = self.motion.execute(&mut self.setpoint, self.actual, parameters.maximum_acceleration, cycle);
        self.setpoint.lead(self.actual, self.setpoint.velocity());
        self.before = self.actual;
    }

    /// Closes the position control loop of a spindle at its present speed: the setpoint leads by the following error of this speed. Leads are
    /// exact without feed-forward.
    pub(in crate::sinumerik) fn close_position_control(&mut self, parameters: &AxisParameters) {
        let velocity = self.setpoint.velocity();
        let lead = velocity / self.active_set(parameters).gain.max(f64::MIN_POSITIVE);
        self.setpoint.lead(self.actual + Position::from_user(lead / Position::PER_USER_UNIT), velocity);
        (self.before, self.speed_controlled) = (self.setpoint.position, false);
        self.monitor.restart(self.actual);
    }

    /// 61.5: the position control loop is closed.
    pub(in crate::sinumerik) fn is_position_controlled(&self) -> bool {
        self.enabling.controllers()[2] && !self.speed_controlled
    }

    /// The speed of a spindle: the actual one; while its setpoint is not output (1.3, program test) the commanded one, as it is displayed then.
    pub(in crate::sinumerik) fn turning_speed(&self) -> f64 {
        if self.signals.disabled_at.is_some() { self.setpoint.velocity() } else { self.velocity }
    }

    /// The velocity for the drive in speed control; `None` in position control.
    pub(in crate::sinumerik) fn speed_command(&self) -> Option<f64> {
        let withheld = self.signals.disabled_at.is_some();
        self.speed_controlled.then(|| if withheld { 0.0 } else { self.setpoint.velocity() })
    }
}
