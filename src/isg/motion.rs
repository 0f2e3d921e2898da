//! Setpoints and position control. An axis that follows takes the movement of its master in the same cycle (HG-20, SG-03).

use super::state::{AxesView, State};
use crate::motion::{Motion, velocity_command};
use crate::units::{AxisNumber, AxisSet, Position};

/// Gain of position control in 1/s: a following error of 1 mm at 1 m/min. The manuals give none.
const GAIN: f64 = 1000.0 / 60.0;

impl State {
    /// Moves the setpoints: leading axes as commanded, then those that follow.
    pub(super) fn move_setpoints(&mut self) {
        let cycle = self.cycle.0.seconds();
        let mut moved = AxisSet::NONE;
        let existing: Vec<AxisNumber> = self.existing().collect();
        // The position before the cycle, of all: a slave of one coupling may be the master of another.
        let before: Vec<Position> = existing.iter().map(|axis| self.axes[*axis].setpoint.position).collect();
        for axis in &existing {
            let state = &mut self.axes[*axis];
            let motion = state.motion.take();
            if !state.is_powered() {
                let actual = state.actual();
                Motion::Track.execute(&mut state.setpoint, actual, 0.0, cycle);
                moved.set(*axis, true);
                continue;
            }
            if let Some(motion) = motion {
                let (actual, hold) = (state.actual(), state.parameters.acceleration);
                motion.execute(&mut state.setpoint, actual, hold, cycle);
                moved.set(*axis, true);
            }
        }
        // A movement goes from masters to slaves, and on from there.
        for _ in 0..existing.len() {
            let mut new = Vec::new();
            let hard = self.combinations.iter().map(|one| &one.coupling);
            let soft = self.channels.iter().flat_map(|channel| channel.couplings());
            for coupling in hard.chain(soft) {
                let leads = coupling.leads_now();
                let Some(index) = existing.iter().position(|axis| *axis == leads) else { continue };
                if !moved.contains(leads) || !self.axes[leads].is_powered() {
                    continue;
                }
                let movement = self.axes[leads].setpoint.moved_from(before[index]);
                new.extend(coupling.lead(movement).filter(|(slave, _)| !moved.contains(*slave)));
            }
            if new.is_empty() {
                break;
            }
            for (slave, movement) in new {
                moved.set(slave, true);
                self.axes[slave].setpoint.follow(movement);
            }
        }
        // Nobody moves the others: they come to rest.
        for axis in existing {
            if !moved.contains(axis) {
                let state = &mut self.axes[axis];
                let deceleration = state.parameters.emergency;
                let actual = state.actual();
                Motion::Brake { deceleration }.execute(&mut state.setpoint, actual, deceleration, cycle);
            }
        }
        self.settle_couplings();
    }

    /// A coupling that was opened or realigned closes at rest.
    fn settle_couplings(&mut self) {
        let Self { combinations, channels, axes, .. } = self;
        let hard = combinations.iter_mut().map(|one| &mut one.coupling);
        let soft = channels.iter_mut().flat_map(|channel| channel.couplings_mut());
        for coupling in hard.chain(soft) {
            let rests = coupling.members().all(|member| axes[member].setpoint.is_at_rest());
            coupling.settle(rests);
        }
    }

    /// The velocity command of an axis; `None` without power.
    pub(super) fn velocity_command(&mut self, number: AxisNumber, count: Position) -> Option<f64> {
        // After a restart there is no setpoint before the encoders have reported.
        let starts = self.starts;
        let axis = &mut self.axes[number];
        if starts || !axis.exists || !axis.is_powered() {
            return None;
        }
        let actual = count + axis.shift;
        if std::mem::take(&mut axis.tracks_once) {
            // The displacement alone: a following error stays.
            let by = count - axis.feedback.encoders[0].value;
            axis.setpoint.shift(by);
        }
        let deviation = (axis.setpoint.position - actual).increments() as f64;
        Some(velocity_command(deviation, GAIN, axis.feedback.half_count[0], 0.0))
    }

    /// The differences at the start of the controller are those of the present positions.
    pub(super) fn start_couplings(&mut self) {
        let Self { combinations, axes, .. } = self;
        for one in combinations {
            one.coupling.start_up(&AxesView(axes));
        }
    }
}
