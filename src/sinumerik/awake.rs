//! When axes wake and when they rest: the calls of [`Resting`](crate::sinumerik::resting::Resting) in a cycle.

use crate::control::Changes;
use crate::sinumerik::nck::Nck;
use crate::units::AxisSet;

impl Nck {
    /// Computes every axis in every cycle, also those that rest. The results are the same.
    pub fn never_rest(&mut self) {
        self.resting.never = true;
        self.resting.wake_all();
    }

    /// Something happened to the machine: everybody is computed in the next cycle.
    pub fn wake_all(&mut self) {
        self.resting.wake_all();
    }

    /// The axes that are computed in this cycle: an alarm that comes in the middle of it concerns everybody from there on.
    #[must_use]
    pub fn awake(&self) -> AxisSet {
        if self.state.alarms_wake(&self.resting) { self.parameters.existing } else { self.resting.awake }
    }

    /// After the stages that concern everybody: who is computed in this cycle.
    pub(super) fn wake(&mut self, changes: Changes) {
        let (state, resting) = (&*self.state, &mut *self.resting);
        let same = resting.shared.is_of(state, &self.parameters);
        if resting.never || changes.shared || !same || state.alarms_wake(resting) {
            resting.shared = state.shared();
            resting.wake_all();
        }
        resting.awake = resting.awake.with(changes.axes).and(self.parameters.existing);
        resting.awake_units = 0;
        for (index, unit) in state.units.iter().enumerate() {
            if !resting.awake.and(unit.set).is_empty() {
                resting.awake = resting.awake.with(unit.set);
                resting.awake_units |= 1 << index;
            }
        }
    }

    /// At the end of a cycle: who came out of it as it went in, and of whom the iron says that it rests, rests.
    pub(super) fn rest(&mut self, restless: AxisSet) {
        let (state, resting) = (&*self.state, &mut *self.resting);
        let mut awake = restless;
        if state.alarms_wake(resting) {
            // One that has just gone by itself held others in this cycle, and will not in the next.
            resting.wake_all();
            awake = AxisSet::ALL;
        }
        resting.alarm_version = state.alarms.version();
        for axis in resting.awake.iter() {
            if state.axes[axis] != resting.axes[axis] {
                resting.axes[axis] = state.axes[axis].clone();
                awake.set(axis, true);
            }
        }
        for (now, before) in state.groupings.iter().zip(&mut resting.groupings) {
            let axes: AxisSet = now.coupling.members().collect();
            if !resting.awake.and(axes).is_empty() && now != before {
                resting.units_stale = true;
                before.clone_from(now);
                awake = awake.with(axes);
            }
        }
        resting.awake = awake;
    }
}
