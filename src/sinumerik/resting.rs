//! Axes that rest are not computed again, and nothing is decided twice.
//!
//! A cycle of the control is a function of its state, of what the PLC wrote and of what encoders and drives told. An axis
//! whose state came out of a cycle as it went in, and that gets the same inputs again, comes out of the next one as it is: it
//! rests, and the stages leave it out until something that it depends on is another one.
//!
//! An axis that only moves is awake, and no decision is made for it: the stages that read signals and command a movement are
//! left out, and it goes on with the movement that was commanded. They are a function of signals, of what was decided before, and
//! of three things about a movement: whether the setpoint rests, on which side of its target it is, and, where
//! [`Axis::decisions_follow_movement`] says so, of all of it. Axes of a closed grouping are decided in every cycle in which they are awake.
//!
//! What all axes depend on (modes, channels, handwheels, run-up, emergency stop, machine data, an alarm that comes or goes)
//! wakes all; an alarm that stays keeps its own axis awake, which may have to raise it again. Nothing that can be seen depends
//! on which axes rest ([`Nck::decide_always`](crate::sinumerik::Nck::decide_always) computes everything always, and tests compare both).

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

/// What every axis depends on.
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

/// Which axes rest, and what the last cycle left.
#[derive(Debug)]
pub(super) struct Resting {
    /// The axes that are computed in this cycle.
    pub awake: AxisSet,
    /// Their units, a bit for each place in the list of units.
    pub awake_units: u32,
    /// Those of them for which is decided in this cycle.
    pub deciding: AxisSet,
    /// Their units.
    pub deciding_units: u32,
    /// The axes for which position control asks for the same in all its cycles, as long as their encoders tell the same.
    pub still: AxisSet,
    /// The axes that were told something else by their drives or encoders in this cycle.
    pub heard: AxisSet,
    /// Where the movement of each was at the end of the cycle before.
    pub ways: PerAxis<Way>,
    /// No axis rests.
    pub never: bool,
    /// No axis rests, and everything is decided in every cycle.
    pub always: bool,
    /// Groupings may have been opened or closed.
    pub units_stale: bool,
    pub alarm_version: u32,
    pub shared: Shared,
    /// What was decided about each axis and how it moved; nothing yet where nothing is known.
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

    /// The state is another one, after power on or restored: what was before is nothing to compare with.
    pub(super) fn begin_anew(&mut self, state: &State) {
        let mut axes = std::mem::take(&mut self.axes);
        axes.clear();
        *self = Self { never: self.never, always: self.always, axes, ..Self::new(state) };
    }

    /// That of a copy of the control: no axis rests, and it costs little.
    pub(super) fn anew(&self, state: &State) -> Self {
        Self { never: self.never, always: self.always, ..Self::new(state) }
    }

    /// Every axis is computed in the next cycle.
    pub(super) fn wake_all(&mut self) {
        self.awake = AxisSet::ALL;
        self.deciding = AxisSet::ALL;
        self.units_stale = true;
    }

    /// An axis was told something else by its drive or encoders.
    pub(super) fn hear(&mut self, axis: AxisNumber) {
        self.awake.set(axis, true);
        self.heard.set(axis, true);
    }

    /// The axes for which is decided in this cycle.
    pub(super) const fn deciding(&self) -> AxisSet {
        self.deciding
    }

    /// The axes for which is decided in this cycle: all of them as soon as an alarm came or went in it.
    pub(super) fn deciding_now(&self, state: &State) -> AxisSet {
        if state.alarms_wake(self) { AxisSet::ALL } else { self.deciding }
    }

    /// Groupings were opened or closed, or machine data became active, since this was last asked.
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

    /// An alarm came or went: that can stop every axis.
    pub(super) fn alarms_wake(&self, resting: &Resting) -> bool {
        self.alarms.version() != resting.alarm_version
    }

    /// The first unit from this place on for which is decided in this cycle.
    pub(super) fn next_deciding(&self, from: usize, resting: &Resting) -> Option<usize> {
        self.next_unit(from, resting.deciding_units, resting)
    }

    /// The first unit from this place on that is computed in this cycle.
    pub(super) fn next_awake(&self, from: usize, resting: &Resting) -> Option<usize> {
        self.next_unit(from, resting.awake_units, resting)
    }

    fn next_unit(&self, from: usize, units: u32, resting: &Resting) -> Option<usize> {
        // An alarm of a unit before concerns those behind it in the same cycle.
        let rest = if self.alarms_wake(resting) { u32::MAX } else { units };
        let index = (rest & u32::MAX.checked_shl(u32::try_from(from).ok()?)?).trailing_zeros() as usize;
        (index < self.units.len()).then_some(index)
    }

    /// The setpoint of a single axis rests, and what it is commanded to do leaves it where it is.
    pub(super) fn stays(&self, unit: &Unit) -> bool {
        let (axis, shaping) = (&self.axes[unit.leader()], &self.shaping[unit.leader()]);
        let commanded = matches!(axis.motion, Motion::Brake { .. } | Motion::Hold);
        let rests = axis.setpoint.is_still() && axis.setpoint.position == axis.before && !axis.arrived;
        unit.grouping.is_none() && commanded && rests && shaping.is_none()
    }

    /// Whether is decided for a unit in this cycle.
    pub(super) fn decides(&self, index: usize, resting: &Resting) -> bool {
        resting.deciding_units >> index & 1 == 1 || self.alarms_wake(resting)
    }
}
