//! Position control: fine interpolation, dynamic response adaptation, feedforward, servo gain.
//!
//! The machine calls it MD10070 / MD10060 times in each interpolation cycle, after the stage "setpoints", for every axis. Reads
//! setpoints, encoders and the active parameter set; writes only the delays of the setpoint branch.
//!
//! Position control compares setpoint and actual value of the same time, the end of the previous position-control cycle. The
//! displayed following error is the one used for control, v / Kv at steady speed.
//!
//! The setpoint branch: MD32900 delays the whole branch by MD32910 (PT1). After this delay, MD32610 times the setpoint velocity
//! goes to the drive, and the setpoint that is compared with the actual value is delayed by the balancing time, as PT1 or dead
//! time. If the time constant of the drive equals MD32810, nothing remains to be corrected. At steady speed the following error
//! (setpoint of the interpolator minus actual value) is v · (MD32910 + MD32810) + (1 − MD32610) · v / Kv with feedforward, and v
//! / Kv + v · MD32910 without.
//!
//! Choices: an axis without a delay needs no memory and no time for it. An axis without power or without a measuring system, and an axis whose setpoint is not
//! output (1.3, 20.1, an encoder fault), restarts its branch. MD32620 = 2 and 4 act with their speed part; MD32650 has no effect.

use crate::motion::velocity_command;
use crate::sinumerik::axis::shaping::SetpointBranch;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::parameters::dynamics::ParameterSet;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};

impl Nck {
    /// Position control of an axis in part `part` of `count` of the interpolation cycle. Returns the velocity command for the
    /// drive; `None` for a drive without power.
    pub fn velocity_command(
        &mut self,
        number: AxisNumber,
        encoders: [Position; 2],
        part: u32,
        count: u32,
    ) -> Option<f64> {
        let parameters = &self.parameters.axes[number];
        let axis = &mut self.state.axes[number];
        let branch = self.state.shaping[number].as_deref_mut().and_then(|shaping| shaping.branch.as_mut());
        let Some(active) = axis.measuring_system.filter(|_| axis.enabling.is_powered()).map(usize::from) else {
            axis.reset_branch(branch);
            // With power and its speed controller the drive holds the slide: while the brake opens and closes, and while a parked axis is
            // switched off.
            let [_, holds, _] = axis.enabling.controllers();
            return (holds && axis.enabling.pulses_enabled()).then_some(0.0);
        };
        let set = axis.active_set(parameters);
        let (shown, command) = match &set.misfit {
            None => (encoders[active], 1.0),
            Some(misfit) => (misfit.shown(active, encoders[active]), misfit.command),
        };
        let actual = shown + axis.to_actual(active);
        if axis.monitor.encoders[active].fault || axis.signals.fast_stop {
            axis.reset_branch(branch);
            axis.monitor.restart_model(actual);
            return Some(0.0);
        }
        if let Some(speed) = axis.speed_command() {
            axis.reset_branch(branch);
            axis.monitor.restart_model(actual);
            self.resting.still.set(number, false);
            return Some(limited(speed, parameters) * command);
        }
        if let Some(held) = axis.signals.disabled_at() {
            axis.reset_branch(branch);
            axis.monitor.restart_model(actual);
            let deviation = (held - actual).increments() as f64;
            return Some(limited(velocity_command(deviation, set.gain, axis.half_count, 0.0), parameters) * command);
        }
        let cycle = self.parameters.servo_cycle;
        let is_delayed = branch.is_some();
        if let Some(branch) = branch {
            let movement = axis.setpoint.velocity() * cycle;
            let by_program = self.state.programs[parameters.channel].has_feed_forward();
            axis.branch = branch.pass(parameters.dynamics.feed_forward(by_program), set, movement, cycle);
            axis.unsettled = axis.unsettled.wrapping_add(u32::from(branch.is_behind()));
        }
        // At the time at which the actual value was taken.
        let setpoint = axis.finely_interpolated(part - 1, count);
        let wanted = axis.velocity_wanted(set, setpoint, actual, axis.half_count);
        let ideal = axis.velocity_wanted(set, setpoint, axis.monitor.model(), Position::ZERO);
        axis.monitor.move_model(ideal * cycle);
        if axis.before != axis.setpoint.position || ideal != 0.0 || is_delayed {
            self.resting.still.set(number, false);
        }
        Some(limited(wanted, parameters) * command)
    }
}

impl State {
    /// Allocates the filters and delays required by the active machine data; those already in use stay unchanged.
    pub(in crate::sinumerik) fn prepare_position_control(&mut self, parameters: &Parameters) {
        let cycle = parameters.servo_cycle;
        for (number, axis) in parameters.existing() {
            let dynamics = &axis.dynamics;
            let by_program = self.programs[axis.channel].has_feed_forward();
            let shaping = &mut self.shaping[number];
            if !dynamics.delays_setpoints(by_program) {
                self.axes[number].branch = (0.0, 0.0);
            }
            if !dynamics.jerk.is_limited() && !dynamics.delays_setpoints(by_program) {
                *shaping = None;
                continue;
            }
            let shaping = shaping.get_or_insert_default();
            shaping.prepare_jerk(&dynamics.jerk);
            shaping.prepare_branch(dynamics, by_program, cycle);
        }
    }
}

/// The part of it that the drive receives: limited to MD36210.
#[must_use]
pub(in crate::sinumerik) fn limited(velocity: f64, parameters: &AxisParameters) -> f64 {
    let limit = parameters.monitoring.speed_setpoint_limit;
    velocity.clamp(-limit, limit)
}

impl Axis {
    /// The velocity command of position control for an actual value.
    #[must_use]
    pub(in crate::sinumerik) fn velocity_wanted(
        &self,
        set: &ParameterSet,
        setpoint: Position,
        actual: Position,
        half_count: Position,
    ) -> f64 {
        let (behind, feed_forward) = self.branch;
        let deviation = (setpoint - actual).increments() as f64;
        velocity_command(deviation - behind, set.gain, half_count, feed_forward)
    }

    /// Restarts the setpoint branch.
    fn reset_branch(&mut self, branch: Option<&mut SetpointBranch>) {
        if let Some(branch) = branch {
            branch.reset();
            self.branch = (0.0, 0.0);
        }
    }

    fn finely_interpolated(&self, part: u32, count: u32) -> Position {
        if part == count {
            return self.setpoint.position;
        }
        if part == 0 || self.before == self.setpoint.position {
            return self.before;
        }
        let way = (self.setpoint.position - self.before).increments();
        self.before + Position::new(way * i64::from(part) / i64::from(count))
    }
}
