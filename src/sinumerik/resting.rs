//! Skips axes at rest and repeated decisions.
//!
//! A cycle of the control is a function of its state, of the data from the PLC, and of the feedback of encoders and drives. If a
//! cycle does not change the state of an axis, and its inputs stay the same, the next cycle does not change it either. The axis
//! then rests, and the stages skip it until something that it depends on changes.
//!
//! An axis that only moves is awake, but needs no decisions: the stages that read signals and command a movement are skipped, and
//! the commanded movement continues. These stages are a function of signals, of earlier decisions, and of three facts about a
//! movement: whether the setpoint rests, on which side its target is, and, if [`Axis::decisions_follow_movement`] is true, the
//! whole movement. The same applies to a grouping: it gets decisions in every cycle only while its axes are referenced, synchronise
//! or are independent ([`Grouping::decisions_follow_movement`]).
//!
//! A change of anything that all axes depend on (modes, channels, handwheels, start-up, emergency stop, machine data, an alarm
//! that is raised or cleared) wakes all axes. A pending alarm keeps its own axis awake, because the axis may have to raise it
//! again. No visible result depends on which axes rest ([`Nck::decide_always`](crate::sinumerik::Nck::decide_always) computes
//! everything in every cycle, and tests compare both).

use arrayvec::ArrayVec;

use crate::motion::Motion;
use crate::sinumerik::axis::state::{Axis, Way};
use crate::sinumerik::gantry::state::Grouping;
use crate::sinumerik::jog::state::{GroupFunction, HANDWHEELS, Handwheel};
use crate::sinumerik::operation::state::{Channel, EmergencyStop, ModeGroup, RunUp};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::groupings::GROUPINGS;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, AxisSet, PerAxis, PerChannel, PerModeGroup};

/// The data that every axis depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shared {
    run_up: RunUp,
    mode_groups: PerModeGroup<ModeGroup>,
    emergency_stop: EmergencyStop,
    channels: PerChannel<Channel>,
    handwheels: [Handwheel; HANDWHEELS],
    group_functions: PerModeGroup<GroupFunction>,
}

impl Shared {
    pub(super) fn is_of(&self, state: &State, parameters: &Parameters) -> bool {
        let mut channels = parameters.existing_channels();
        self.run_up == state.run_up
            && self.emergency_stop == state.emergency_stop
            && self.mode_groups == state.mode_groups
            && self.handwheels == state.handwheels
            && self.group_functions == state.group_functions
            && channels.all(|(channel, _)| self.channels[channel] == state.channels[channel])
    }
}

/// The axes at rest, and the state at the end of the last cycle.
#[derive(Debug)]
pub(super) struct Resting {
    /// The axes that are computed in this cycle.
    pub awake: AxisSet,
    /// Their units, as bits by index in the list of units.
    pub awake_units: u32,
    /// Those that need decisions in this cycle.
    pub deciding: AxisSet,
    /// Their units.
    pub deciding_units: u32,
    /// The axes with a constant position-control command in all position-control cycles, while their encoders report the same
    /// values.
    pub still: AxisSet,
    /// The axes with changed feedback of drive or encoders in this cycle.
    pub heard: AxisSet,
    /// The course of each movement at the end of the previous cycle.
    pub ways: PerAxis<Way>,
    /// No axis rests.
    pub never: bool,
    /// No axis rests, and all decisions are made in every cycle.
    pub always: bool,
    /// Groupings may have been opened or closed.
    pub units_stale: bool,
    pub alarm_version: u32,
    pub shared: Shared,
    /// The decisions and the movement of each axis at the end of the last cycle; empty if unknown.
    pub axes: Vec<Axis>,
    pub groupings: ArrayVec<Grouping, GROUPINGS>,
}

impl Resting {
    /// No axis rests.
    pub(super) fn new(state: &State) -> Self {
        Self {
            awake: AxisSet::ALL,
            awake_units: u32::MAX,
            deciding: AxisSet::ALL,
            deciding_units: u32::MAX,
            still: AxisSet::NONE,
            heard: AxisSet::NONE,
            ways: PerAxis::default(),
            never: false,
            always: false,
            units_stale: true,
            alarm_version: state.alarms.version(),
            shared: state.shared(),
            axes: Vec::with_capacity(AxisNumber::MAX.into()),
            groupings: state.groupings.clone(),
        }
    }

    /// Starts again after power on or restoring: there is no earlier state to compare with.
    pub(super) fn begin_anew(&mut self, state: &State) {
        let mut axes = std::mem::take(&mut self.axes);
        axes.clear();
        *self = Self { never: self.never, always: self.always, axes, ..Self::new(state) };
    }

    /// The initial value for a copy of the control: no axis rests. It needs little memory.
    pub(super) fn anew(&self, state: &State) -> Self {
        Self { never: self.never, always: self.always, ..Self::new(state) }
    }

    /// Every axis is computed in the next cycle.
    pub(super) fn wake_all(&mut self) {
        self.awake = AxisSet::ALL;
        self.deciding = AxisSet::ALL;
        self.units_stale = true;
    }

    /// The feedback of drive or encoders of an axis has changed.
    pub(super) fn hear(&mut self, axis: AxisNumber) {
        self.awake.set(axis, true);
        self.heard.set(axis, true);
    }

    /// Something other than the movement of these axes has changed.
    pub(super) fn hear_all(&mut self, axes: AxisSet) {
        self.awake = self.awake.with(axes);
        self.heard = self.heard.with(axes);
    }

    /// A stage behind the waking moves these axes: their units are computed in this cycle, with all decisions.
    pub(super) fn decide_now(&mut self, axes: AxisSet, units: &[Unit]) {
        if axes.without(self.deciding).is_empty() {
            return;
        }
        for (index, unit) in units.iter().enumerate().filter(|(_, unit)| !unit.set.and(axes).is_empty()) {
            self.awake = self.awake.with(unit.set);
            self.deciding = self.deciding.with(unit.set);
            self.awake_units |= 1 << index;
            self.deciding_units |= 1 << index;
        }
    }

    /// The axes that need decisions in this cycle.
    pub(super) const fn deciding(&self) -> AxisSet {
        self.deciding
    }

    /// The axes that need decisions in this cycle: all of them as soon as an alarm was raised or cleared in it.
    pub(super) fn deciding_now(&self, state: &State) -> AxisSet {
        if state.alarms_wake(self) { AxisSet::ALL } else { self.deciding }
    }

    /// Whether groupings were opened or closed, or machine data became active, since the last call.
    pub(super) fn take_units_stale(&mut self) -> bool {
        std::mem::take(&mut self.units_stale)
    }
}

impl State {
    pub(super) fn shared(&self) -> Shared {
        Shared {
            run_up: self.run_up,
            mode_groups: self.mode_groups,
            emergency_stop: self.emergency_stop,
            channels: self.channels,
            handwheels: self.handwheels,
            group_functions: self.group_functions,
        }
    }

    /// Whether an alarm was raised or cleared, which can stop every axis.
    pub(super) fn alarms_wake(&self, resting: &Resting) -> bool {
        self.alarms.version() != resting.alarm_version
    }

    /// The first unit from this index on that needs decisions in this cycle.
    pub(super) fn next_deciding(&self, from: usize, resting: &Resting) -> Option<usize> {
        self.next_unit(from, resting.deciding_units, resting)
    }

    /// The first unit from this index on that is computed in this cycle.
    pub(super) fn next_awake(&self, from: usize, resting: &Resting) -> Option<usize> {
        self.next_unit(from, resting.awake_units, resting)
    }

    fn next_unit(&self, from: usize, units: u32, resting: &Resting) -> Option<usize> {
        // An alarm of an earlier unit concerns the later units in the same cycle.
        let rest = if self.alarms_wake(resting) { u32::MAX } else { units };
        let index = (rest & u32::MAX.checked_shl(u32::try_from(from).ok()?)?).trailing_zeros() as usize;
        (index < self.units.len()).then_some(index)
    }

    /// The setpoint of a single axis is at rest, and its command does not change it.
    pub(super) fn stays(&self, unit: &Unit) -> bool {
        let (axis, shaping) = (&self.axes[unit.leader()], &self.shaping[unit.leader()]);
        let commanded = matches!(axis.motion, Motion::Brake { .. } | Motion::Hold);
        let rests = axis.setpoint.is_still() && axis.setpoint.position == axis.before && !axis.arrived;
        unit.grouping.is_none() && commanded && rests && shaping.is_none()
    }

    /// Whether a unit needs decisions in this cycle.
    pub(super) fn decides(&self, index: usize, resting: &Resting) -> bool {
        resting.deciding_units >> index & 1 == 1 || self.alarms_wake(resting)
    }
}
