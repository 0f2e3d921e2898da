//! Axes that rest are not computed again.
//!
//! A cycle of the control is a function of its state, of what the PLC wrote and of what encoders and drives told. An axis
//! whose state came out of a cycle as it went in, and that gets the same inputs again, comes out of the next one as it is: it
//! rests, and the stages leave it out until something that it depends on is another one. What all axes depend on (modes,
//! channels, handwheels, run-up, emergency stop, machine data, any alarm) wakes all. Nothing that anybody can see depends on who rests
//! ([`Control::never_rest`] computes everything always, and tests compare both).

use arrayvec::ArrayVec;

use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::control::Control;
use crate::sinumerik::gantry::state::Grouping;
use crate::sinumerik::jog::state::{GroupFunction, HANDWHEELS, Handwheel};
use crate::sinumerik::operation::state::{Channel, EmergencyStop, ModeGroup, RunUp};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::groupings::GROUPINGS;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet, PerAxis, PerChannel, PerModeGroup};

/// What the PLC's half has other than in the last cycle.
#[derive(Clone, Copy, Debug)]
pub struct Changes {
    /// Axes whose block changed.
    pub axes: AxisSet,
    /// A block of the NCK, of a mode group or of a channel changed.
    pub shared: bool,
}

/// What every axis depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shared {
    run_up: RunUp,
    mode_groups: PerModeGroup<ModeGroup>,
    emergency_stop: EmergencyStop,
    channels: PerChannel<Channel>,
    handwheels: [Handwheel; HANDWHEELS],
    group_functions: PerModeGroup<GroupFunction>,
}

impl Shared {
    fn is_of(&self, state: &State, parameters: &Parameters) -> bool {
        let mut channels = parameters.existing_channels();
        self.run_up == state.run_up
            && self.emergency_stop == state.emergency_stop
            && self.mode_groups == state.mode_groups
            && self.handwheels == state.handwheels
            && self.group_functions == state.group_functions
            && channels.all(|(channel, _)| self.channels[channel] == state.channels[channel])
    }
}

/// Who rests, and what the last cycle left.
#[derive(Clone, Debug)]
pub(super) struct Resting {
    /// Who is computed in this cycle.
    awake: AxisSet,
    /// Their units, a bit for each place in the list of units.
    awake_units: u32,
    never: bool,
    /// Groupings may have been opened or closed.
    units_stale: bool,
    alarm_version: u32,
    shared: Shared,
    axes: PerAxis<Axis>,
    groupings: ArrayVec<Grouping, GROUPINGS>,
}

impl Resting {
    /// Nobody rests.
    pub(super) fn new(state: &State) -> Self {
        Self {
            awake: AxisSet::ALL,
            awake_units: u32::MAX,
            never: false,
            units_stale: true,
            alarm_version: state.alarms.version(),
            shared: state.shared(),
            axes: state.axes.clone(),
            groupings: state.groupings.clone(),
        }
    }

    /// The state is another one, after power on or restored: what was before is nothing to compare with.
    pub(super) fn begin_anew(&mut self, state: &State) {
        *self = Self { never: self.never, ..Self::new(state) };
    }

    /// Everybody is computed in the next cycle.
    pub(super) fn wake_all(&mut self) {
        self.awake = AxisSet::ALL;
        self.units_stale = true;
    }

    /// An axis was told something new.
    pub(super) fn wake_axis(&mut self, axis: AxisNumber) {
        self.awake.set(axis, true);
    }

    /// Who is computed in this cycle.
    pub(super) const fn awake(&self) -> AxisSet {
        self.awake
    }

    /// Groupings were opened or closed, or machine data became active, since this was last asked.
    pub(super) fn take_units_stale(&mut self) -> bool {
        std::mem::take(&mut self.units_stale)
    }
}

impl State {
    fn shared(&self) -> Shared {
        Shared {
            run_up: self.run_up,
            mode_groups: self.mode_groups,
            emergency_stop: self.emergency_stop,
            channels: self.channels,
            handwheels: self.handwheels,
            group_functions: self.group_functions,
        }
    }

    /// An alarm is pending, or one came or went: that can stop anybody.
    pub(super) fn alarms_wake(&self, resting: &Resting) -> bool {
        !self.alarms.is_empty() || self.alarms.version() != resting.alarm_version
    }

    /// The first unit from this place on that is computed in this cycle.
    pub(super) fn next_awake(&self, from: usize, resting: &Resting) -> Option<usize> {
        // An alarm of a unit before concerns those behind it in the same cycle.
        let rest = if self.alarms_wake(resting) { u32::MAX } else { resting.awake_units };
        let index = (rest & u32::MAX.checked_shl(u32::try_from(from).ok()?)?).trailing_zeros() as usize;
        (index < self.units.len()).then_some(index)
    }
}

impl Control {
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
