//! The state of the control between cycles: plain data, saved and restored without change.
//!
//! Each topic has a `state.rs` with its part of the state. The other files of a topic are stages that read and change it.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::control::Log;
use crate::motion::{Feedback, Motion};
use crate::sinumerik::alarms;
use crate::sinumerik::axis::shaping::Shaping;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::exchange::state::Owners;
use crate::sinumerik::function_generator::state::Generator;
use crate::sinumerik::gantry::state::{Declared, Grouping, Phase};
use crate::sinumerik::jog::state::{GroupFunction, HANDWHEELS, Handwheel};
use crate::sinumerik::operation::state::{Channel, EmergencyStop, ModeGroup, RunUp};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::groupings::{GROUPINGS, GantryCoupling, SYNCHRONOUS_AXES};
use crate::sinumerik::program::state::{ChannelProgram, Led};
use crate::sinumerik::referencing::state::{Buffered, EncoderDatum};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::single_axis::state::SingleAxes;
use crate::sinumerik::spindle::state::Spindle;
use crate::sinumerik::user::state::User;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel, PerModeGroup};
use crate::variables::{EventId, LongTexts, Place, RParameters};

/// Axes that are enabled, stopped and held together: a closed grouping with its leading axis first, or one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Unit {
    pub axes: [AxisNumber; 1 + SYNCHRONOUS_AXES],
    pub count: u8,
    pub set: AxisSet,
    /// The grouping, if it is one.
    pub grouping: Option<u8>,
    pub channel: ChannelNumber,
    pub mode_group: ModeGroupNumber,
}

impl Unit {
    pub(super) fn single(axis: AxisNumber, owners: &Owners, parameters: &Parameters) -> Self {
        let channel = owners.of(axis).channel;
        let (set, mode_group) = (AxisSet::of(axis), parameters.mode_group(channel));
        Self { axes: [axis; 1 + SYNCHRONOUS_AXES], count: 1, set, grouping: None, channel, mode_group }
    }

    pub(super) fn of(coupling: &GantryCoupling, index: usize, owners: &Owners, parameters: &Parameters) -> Self {
        let mut unit = Self::single(coupling.leader(), owners, parameters);
        for (place, axis) in unit.axes.iter_mut().zip(coupling.members()) {
            *place = axis;
        }
        unit.count = u8::try_from(coupling.members().count()).unwrap_or(1);
        unit.set = coupling.members().collect();
        unit.grouping = u8::try_from(index).ok();
        unit
    }

    pub(super) const fn leader(&self) -> AxisNumber {
        self.axes[0]
    }

    pub(super) fn members(&self) -> impl Iterator<Item = AxisNumber> {
        self.axes.iter().take(usize::from(self.count)).copied()
    }
}

/// A summary of all axes for the signals of channels and of the NCK.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Summary {
    pub drive_ready: AxisSet,
    pub referenced: AxisSet,
    /// The setpoint rests and the velocity is below MD36060.
    pub standing: AxisSet,
    pub in_motion: AxisSet,
    /// The same in the previous cycle: an axis that differs changed a signal of its channel.
    pub before: Standing,
}

/// The axes that stand, move and are referenced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Standing {
    pub standing: AxisSet,
    pub in_motion: AxisSet,
    pub referenced: AxisSet,
}

/// The state of the control between cycles: plain data, without machine data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct State {
    pub log: Log,
    pub run_up: RunUp,
    pub mode_groups: PerModeGroup<ModeGroup>,
    pub emergency_stop: EmergencyStop,
    pub channels: PerChannel<Channel>,
    pub axes: PerAxis<Axis>,
    /// The axes that are spindles.
    pub spindles: PerAxis<Option<Box<Spindle>>>,
    /// Filters and delays of setpoints, if machine data require them.
    pub shaping: PerAxis<Option<Box<Shaping>>>,
    pub groupings: ArrayVec<Grouping, GROUPINGS>,
    pub units: ArrayVec<Unit, { AxisNumber::MAX as usize }>,
    pub alarms: alarms::pending::Pending,
    /// Why blocks of programs could not be executed, in words. They outlast power off: the trace reads them later.
    pub reasons: LongTexts,
    pub feedback: PerAxis<Feedback>,
    pub summary: Summary,
    pub handwheels: [Handwheel; HANDWHEELS],
    pub group_functions: PerModeGroup<GroupFunction>,
    /// The encoders have been read after power on.
    pub encoders_read: bool,
    /// Actual values at the last power off; `None` before the first one.
    pub buffered: Option<PerAxis<[Buffered; 2]>>,
    /// Machine data of encoders that the control writes.
    pub written: Vec<EncoderDatum>,
    pub power_on_cause: EventId,
    /// The event of power on, for everything that has not changed since.
    pub as_after_power_on: EventId,
    pub definition_cause: EventId,
    pub plc_missing: bool,
    pub plc_cause: EventId,
    pub declared: Declared,
    /// Who has each axis.
    pub owners: Owners,
    /// The axes that the PLC or synchronised actions position.
    pub single: SingleAxes,
    /// The programs of the channels.
    pub programs: PerChannel<ChannelProgram>,
    /// They outlast power off.
    pub r_parameters: RParameters,
    /// The signals of the function generator.
    pub generators: Vec<Generator>,
    /// Where programs want axes in this cycle; empty between cycles.
    pub led: PerAxis<Option<Led>>,
    /// The axes with a compensation value.
    pub compensating: AxisSet,
    /// The user alarms of an 828D.
    pub user: User,
    /// Another writer wrote into the NCK's half. The next publication overwrites all of it (SIG-11).
    pub overwritten: bool,
}

impl State {
    pub(super) fn new(parameters: &Parameters) -> Self {
        let mut state = Self {
            log: Log::default(),
            run_up: RunUp::default(),
            mode_groups: PerModeGroup::from_fn(|group| ModeGroup::new(parameters, group)),
            emergency_stop: EmergencyStop::default(),
            channels: PerChannel::default(),
            axes: PerAxis::default(),
            spindles: PerAxis::from_fn(|number| parameters.spindles.contains(number).then(Box::default)),
            shaping: PerAxis::default(),
            groupings: parameters.groupings.groupings.iter().map(Grouping::new).collect(),
            units: ArrayVec::new(),
            alarms: alarms::pending::Pending::default(),
            reasons: LongTexts::default(),
            feedback: PerAxis::default(),
            summary: Summary::default(),
            handwheels: Default::default(),
            group_functions: PerModeGroup::default(),
            encoders_read: false,
            buffered: None,
            written: Vec::new(),
            power_on_cause: EventId::NONE,
            as_after_power_on: EventId::NONE,
            definition_cause: EventId::NONE,
            plc_missing: false,
            plc_cause: EventId::NONE,
            declared: Declared::default(),
            owners: Owners::new(parameters),
            single: SingleAxes::default(),
            programs: PerChannel::from_fn(|channel| ChannelProgram::new(parameters.programs[channel].as_deref())),
            r_parameters: parameters.r_parameters(),
            generators: Vec::new(),
            led: PerAxis::default(),
            compensating: AxisSet::NONE,
            user: User::default(),
            overwritten: true,
        };
        for number in parameters.spindles.iter() {
            state.axes[number].speed_controlled = true;
        }
        for grouping in &mut state.groupings {
            grouping.remember_trips(parameters);
        }
        state.form_units(parameters);
        state.prepare_position_control(parameters);
        state
    }

    /// Recorded in the first cycle of a machine, because its signals belong to this cycle.
    pub(super) fn note_power_on(&mut self) {
        if self.power_on_cause.is_some() {
            return;
        }
        let event = self.log.note_plain(Place::Nck, Rule::PowerOn, EventId::NONE);
        self.note_after_power_on(event);
    }

    /// Records what holds from power on, and the event of power on itself.
    pub(super) fn note_after_power_on(&mut self, power_on: EventId) {
        self.power_on_cause = power_on;
        self.as_after_power_on = self.log.note_plain(Place::Nck, Rule::AsAfterPowerOn, power_on);
        self.definition_cause = self.log.note_plain(Place::Nck, Rule::GroupingDefined, power_on);
    }

    /// Forms the units: closed groupings and single axes. The axes of an open grouping are single axes, and the grouping still
    /// runs.
    pub(super) fn form_units(&mut self, parameters: &Parameters) {
        self.units.clear();
        let mut taken = AxisSet::NONE;
        for (index, grouping) in self.groupings.iter().enumerate() {
            let unit = Unit::of(&grouping.coupling, index, &self.owners, parameters);
            if grouping.phase == Phase::Open && grouping.is_kept_open(parameters) {
                continue;
            }
            taken = taken.with(unit.set);
            self.units.push(unit);
        }
        for (axis, _) in parameters.existing().filter(|(axis, _)| !taken.contains(*axis)) {
            self.units.push(Unit::single(axis, &self.owners, parameters));
        }
    }

    /// The axes of groupings in the synchronising motion of section 3.
    pub(super) fn synchronising(&self) -> AxisSet {
        let groupings = self.groupings.iter().filter(|grouping| grouping.phase == Phase::Synchronising);
        groupings.flat_map(|grouping| grouping.coupling.members()).collect()
    }

    /// The axes of groupings that are open or open in this cycle.
    pub(super) fn open_groupings(&self, parameters: &Parameters) -> AxisSet {
        let open = self.groupings.iter().filter(|grouping| grouping.is_kept_open(parameters));
        open.flat_map(|grouping| grouping.coupling.members()).collect()
    }

    /// The synchronous axes of closed groupings.
    pub(super) fn coupled_axes(&self) -> AxisSet {
        self.units.iter().fold(AxisSet::NONE, |axes, unit| axes.with(unit.set.without(AxisSet::of(unit.leader()))))
    }

    /// JOG without a machine function.
    pub(super) fn is_jogging(&self, unit: &Unit) -> bool {
        self.mode_group(unit).is_jogging()
    }

    /// Whether every axis is in position control and nothing stops the unit.
    pub(super) fn unit_can_move(&self, unit: &Unit, parameters: &Parameters) -> bool {
        let free = self.stop(unit.channel, parameters).is_none() && self.motion_forbidden(unit).is_none();
        free && unit.members().all(|axis| self.axes[axis].enabling.is_on())
    }

    /// Every axis of the unit brakes at the slowest rate (O-04), unless a later stage commands something else.
    pub(super) fn brake(&mut self, unit: &Unit, parameters: &Parameters) {
        let slowest =
            unit.members().map(|axis| parameters.axes[axis].maximum_acceleration).fold(f64::INFINITY, f64::min);
        for axis in unit.members() {
            self.axes[axis].motion = Motion::Brake { deceleration: slowest };
        }
    }
}
