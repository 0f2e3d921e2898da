//! Waking and resting of axes: the calls of [`Resting`](crate::sinumerik::resting::Resting) in a cycle.

use crate::control::Changes;
use crate::sinumerik::nck::Nck;
use crate::units::AxisSet;

impl Nck {
    /// Moves, monitors and publishes every axis in every cycle, including axes at rest. The results are the same.
    pub fn never_rest(&mut self) {
        self.resting.never = true;
        self.resting.wake_all();
    }

    /// Also makes all decisions for every axis in every cycle. The results are the same.
    pub fn decide_always(&mut self) {
        self.resting.always = true;
        self.resting.wake_all();
    }

    /// The machine was changed from outside: every axis is computed in the next cycle.
    pub fn wake_all(&mut self) {
        self.resting.wake_all();
    }

    /// The axes that are computed in this cycle. An alarm that is raised during the cycle concerns all of them from there on.
    #[must_use]
    pub fn awake(&self) -> AxisSet {
        if self.state.alarms_wake(&self.resting) { self.parameters.existing } else { self.resting.awake }
    }

    /// The axes for which decisions were made in this cycle, or for which something other than their movement has changed.
    pub(super) fn decided(&self) -> AxisSet {
        self.resting.deciding_now(&self.state).with(self.state.log.news)
    }

    /// The axes with a constant position-control command in all position-control cycles, while their encoders report the same
    /// values.
    #[must_use]
    pub fn still(&self) -> AxisSet {
        self.resting.still
    }

    /// After the stages that concern all axes: determines the axes to compute in this cycle, and those that need decisions.
    pub(super) fn wake(&mut self, changes: Changes) {
        let (state, resting) = (&*self.state, &mut *self.resting);
        let same = resting.shared.is_of(state, &self.parameters);
        if resting.always || changes.shared || !same || state.alarms_wake(resting) {
            resting.shared = state.shared();
            resting.wake_all();
        } else if resting.never {
            resting.awake = AxisSet::ALL;
        }
        let programs = state.program_axes(&self.parameters);
        let active = programs.with(self.parameters.spindles);
        resting.deciding = resting.deciding.with(changes.axes).with(active).and(self.parameters.existing);
        resting.awake = resting.awake.with(resting.deciding).and(self.parameters.existing);
        // Until position control changes it.
        (resting.still, resting.heard) = (AxisSet::ALL, AxisSet::NONE);
        (resting.awake_units, resting.deciding_units) = (0, 0);
        for (index, unit) in state.units.iter().enumerate() {
            if resting.awake.and(unit.set).is_empty() {
                continue;
            }
            resting.awake = resting.awake.with(unit.set);
            resting.awake_units |= 1 << index;
            if !resting.deciding.and(unit.set).is_empty() {
                resting.deciding = resting.deciding.with(unit.set);
                resting.deciding_units |= 1 << index;
            }
        }
    }

    /// At the end of a cycle: an axis rests if the cycle did not change it and its mechanics are at rest. An axis of which only
    /// the movement has changed needs no decisions in the next cycle.
    pub(super) fn rest(&mut self, restless: AxisSet) {
        let (state, resting) = (&mut *self.state, &mut *self.resting);
        let pending = state.alarms.axes();
        let news = std::mem::take(&mut state.log.news);
        let (mut awake, mut deciding) = (restless.with(pending).with(news), pending.with(news));
        if state.alarms_wake(resting) {
            // An alarm that has just cleared by itself held other axes in this cycle, and will not in the next.
            resting.wake_all();
            (awake, deciding) = (AxisSet::ALL, AxisSet::ALL);
        }
        resting.alarm_version = state.alarms.version();
        if resting.axes.is_empty() {
            // There is no previous state to compare with.
            resting.axes.extend(state.axes.iter().map(|(_, axis)| axis.clone()));
            resting.wake_all();
            (awake, deciding) = (AxisSet::ALL, AxisSet::ALL);
        }
        for number in resting.awake.iter() {
            let (axis, before) = (&state.axes[number], &mut resting.axes[number.index()]);
            let decided = resting.deciding.contains(number) || news.contains(number);
            debug_assert!(decided || axis.has_decisions_of(before), "axis {number} has decided unasked");
            if decided && !axis.has_decisions_of(before) {
                deciding.set(number, true);
                before.clone_from(axis);
            }
            // If the mechanics moved, no comparison is needed: the movement has changed.
            let moved = restless.contains(number);
            let moves = moved || resting.heard.contains(number) || !axis.has_movement_of(before);
            if !moves {
                debug_assert!(axis == before, "axis {number} has a field that neither of both compares");
                continue;
            }
            awake.set(number, true);
            if !moved || cfg!(debug_assertions) {
                before.take_movement_of(axis);
            }
            let way = axis.way();
            if way != resting.ways[number] || axis.decisions_follow_movement() {
                resting.ways[number] = way;
                deciding.set(number, true);
            }
        }
        for (now, before) in state.groupings.iter().zip(&mut resting.groupings) {
            let axes: AxisSet = now.coupling.members().collect();
            if resting.awake.with(awake).and(axes).is_empty() {
                continue;
            }
            if !now.has_decisions_of(before) {
                resting.units_stale |= now.phase != before.phase;
                before.clone_from(now);
                // It may have been opened or closed, and then other stages decide about its axes.
                deciding = deciding.with(axes);
            } else if now.decisions_follow_movement(&state.axes) {
                deciding = deciding.with(axes.and(awake));
            }
        }
        (resting.awake, resting.deciding) = (awake.with(deciding), deciding);
    }
}
