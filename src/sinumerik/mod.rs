//! THE CONTROL of the gantry manual (G1): machine data, mode group, channel, enabling, JOG, reference point approach,
//! gantry groupings, alarms.
//!
//! The machine calls [`Control`] in this order, once per interpolation cycle, and that order is the specification:
//! [`Control::decide`] takes what the PLC wrote and commands setpoints (run-up, modes, emergency stop, RESET, handwheels,
//! measuring systems, parameter sets, enabling, referencing and gantry or JOG, setpoints, coupling);
//! [`Control::velocity_command`] is position control, while drives and mechanics move; [`Control::observe`] takes what encoders
//! and drives tell and monitors it; [`Control::publish`] writes the NCK's half of the interface and the variables. The control
//! reads [`ToNck`], the HMI's selection of handwheels, and nothing else. Axes that rest are left out (`resting.rs`).
//!
//! | I want to add | I do |
//! |---|---|
//! | a machine datum | a row in `machine_data/`, a field in `parameters/` where the model needs it |
//! | an alarm | a row in `alarms/mod.rs`, a `raise` where it happens |
//! | a rule that causes an edge | a row in `rules.rs`, a `note` where it is decided |
//! | a step of referencing or of the gantry | a row in `TRANSITIONS` of `referencing/approach.rs` or `gantry/mod.rs` |
//! | something that all axes depend on | a field of `Shared` in `resting.rs`, or nobody wakes for it |
//! | something to watch | a file in `monitoring/`, a row in its table |
//! | a signal that the control shows | a line in `publish.rs`, and its cause in `causes.rs` |

mod alarms;
mod axis;
mod causes;
mod gantry;
mod jog;
mod log;
pub mod machine_data;
mod monitoring;
mod operation;
mod parameters;
mod publish;
mod referencing;
mod resting;
mod rules;
mod shown;
mod transitions;

pub use alarms::not_raised::NOT_RAISED as ALARMS_NOT_RAISED;
pub use alarms::{Alarm, CATALOGUE as ALARMS, Cancel, Reaction};
pub use axis::Feedback;
pub use gantry::{Phase as GroupingPhase, TRANSITIONS as GROUPING_TRANSITIONS};
pub use jog::increments::KeyModes;
pub use parameters::dynamics::{Dynamics, FeedForward, Jerk, PARAMETER_SETS, ParameterSet};
pub use parameters::mechanics::{Mechanics, Misfit};
pub use parameters::{AxisPresence, Parameters};
pub use referencing::approach::{Phase as ApproachPhase, TRANSITIONS as APPROACH_TRANSITIONS};
pub use resting::Changes;
pub use rules::Rule;
pub use transitions::{Rows, TakenTransitions, Transition};

use std::sync::Arc;

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::image::ToNck;
use crate::motion::Coupling;
use crate::source::Problem;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel, PerModeGroup};
use crate::variables::{EventId, Place};

use axis::position_control::Shaping;
use axis::{Axis, Motion};
use gantry::Grouping;
use log::Log;
use machine_data::{Effect, MachineData, Target, Value};
use operation::channel::Channel;
use operation::emergency_stop::EmergencyStop;
use operation::mode_group::ModeGroup;
use operation::run_up::RunUp;
use parameters::groupings::GROUPINGS;
use resting::Resting;

/// Axes that are enabled, stopped and held together: a closed grouping with its leading axis first, or one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Unit {
    axes: [AxisNumber; 3],
    count: u8,
    set: AxisSet,
    /// Which grouping it is.
    grouping: Option<u8>,
    channel: ChannelNumber,
    mode_group: ModeGroupNumber,
}

impl Unit {
    fn single(axis: AxisNumber, parameters: &Parameters) -> Self {
        let channel = parameters.axes[axis].channel;
        let (set, mode_group) = (AxisSet::of(axis), parameters.mode_group(channel));
        Self { axes: [axis; 3], count: 1, set, grouping: None, channel, mode_group }
    }

    fn of(coupling: &Coupling, index: usize, parameters: &Parameters) -> Self {
        let mut unit = Self::single(coupling.leader(), parameters);
        for (place, axis) in unit.axes.iter_mut().zip(coupling.members()) {
            *place = axis;
        }
        unit.count = u8::try_from(coupling.members().count()).unwrap_or(3);
        unit.set = coupling.members().collect();
        unit.grouping = u8::try_from(index).ok();
        unit
    }

    const fn leader(&self) -> AxisNumber {
        self.axes[0]
    }

    fn members(&self) -> impl Iterator<Item = AxisNumber> {
        self.axes.iter().take(usize::from(self.count)).copied()
    }
}

/// What of all axes goes into the signals of channels and of the NCK.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Summary {
    drive_ready: AxisSet,
    referenced: AxisSet,
    /// The setpoint rests and the velocity is below MD36060.
    standing: AxisSet,
    in_motion: AxisSet,
}

/// All that the control remembers from one cycle to the next: plain data, without machine data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct State {
    log: Log,
    run_up: RunUp,
    mode_groups: PerModeGroup<ModeGroup>,
    emergency_stop: EmergencyStop,
    channels: PerChannel<Channel>,
    axes: PerAxis<Axis>,
    /// Filters and delays of setpoints, where machine data ask for them.
    shaping: PerAxis<Option<Box<Shaping>>>,
    groupings: ArrayVec<Grouping, GROUPINGS>,
    units: ArrayVec<Unit, { AxisNumber::MAX as usize }>,
    alarms: alarms::Pending,
    feedback: PerAxis<Feedback>,
    summary: Summary,
    handwheels: [jog::handwheel::Handwheel; jog::handwheel::COUNT],
    group_functions: PerModeGroup<jog::increments::GroupFunction>,
    power_on_cause: EventId,
    definition_cause: EventId,
    plc_missing: bool,
    plc_cause: EventId,
    declared: gantry::declarations::Declared,
    /// Somebody else wrote into the NCK's half; the next publication overwrites all of it (SIG-11).
    overwritten: bool,
}

/// The control.
///
/// Machine data have a stored and an active set (DEF-09, REF-22): a file or an operator changes the stored one, and
/// the class of a datum says when it begins to act.
#[derive(Clone, Debug)]
pub struct Control {
    stored: Arc<MachineData>,
    active: Arc<MachineData>,
    presence: Arc<PerAxis<AxisPresence>>,
    parameters: Arc<Parameters>,
    state: Box<State>,
    resting: Box<Resting>,
}

/// A saved control.
#[derive(Serialize, Deserialize)]
pub struct SavedControl {
    stored: MachineData,
    active: MachineData,
    state: State,
}

impl Control {
    /// A control that has just been switched on.
    #[must_use]
    pub fn new(data: MachineData, presence: PerAxis<AxisPresence>) -> Self {
        let stored = Arc::new(data);
        let parameters = Arc::new(Parameters::new(&stored, &presence));
        let state = Box::new(State::new(&parameters));
        let resting = Box::new(Resting::new(&state));
        Self { active: Arc::clone(&stored), stored, presence: Arc::new(presence), parameters, state, resting }
    }

    /// Power off and on: stored machine data become active, everything else starts anew.
    pub fn power_on(&mut self) {
        let cycle = self.state.log.cycle;
        self.active = Arc::clone(&self.stored);
        self.parameters = Arc::new(Parameters::new(&self.active, &self.presence));
        let events = std::mem::take(&mut self.state.log.events);
        let taken = self.state.log.taken;
        *self.state = State::new(&self.parameters);
        self.state.log = Log { cycle, events, taken };
        self.state.note_power_on();
        self.resting.begin_anew(&self.state);
    }

    /// What the stages work with.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The machine data that act.
    #[must_use]
    pub fn active(&self) -> &MachineData {
        &self.active
    }

    /// The machine data as they are stored.
    #[must_use]
    pub fn stored(&self) -> &MachineData {
        &self.stored
    }

    /// Stores a machine datum; it acts when its class says.
    ///
    /// # Errors
    /// The value does not fit the datum, or only the control writes it; nothing has changed then.
    pub fn store(&mut self, target: &Target, value: &Value) -> Result<(), Problem> {
        Arc::make_mut(&mut self.stored).set(target, value)?;
        if target.datum().effect == Effect::Immediate {
            self.activate(Effect::Immediate);
        }
        Ok(())
    }

    /// "Set machine data active".
    pub fn new_conf(&mut self) {
        self.activate(Effect::NewConf);
    }

    /// Makes the stored data of a class and of those below it active.
    fn activate(&mut self, level: Effect) {
        if Arc::ptr_eq(&self.stored, &self.active) {
            return;
        }
        Arc::make_mut(&mut self.active).activate(&self.stored, level);
        self.parameters = Arc::new(Parameters::new(&self.active, &self.presence));
        self.state.prepare_position_control(&self.parameters);
        self.resting.wake_all();
    }

    /// The PLC program does not run, or runs again after power on.
    pub fn plc_missing(&mut self) {
        if !self.state.plc_missing {
            self.state.plc_missing = true;
            self.state.plc_cause = self.state.log.note_plain(Place::Nck, Rule::PlcMissing, EventId::NONE);
        }
    }

    /// The PLC program runs again; alarm 2000 stays until power off.
    pub fn plc_restarted(&mut self) {
        self.state.plc_missing = false;
    }

    /// The active measuring system of an axis, 0 or 1.
    #[must_use]
    pub fn measuring_system(&self, axis: AxisNumber) -> Option<u8> {
        self.state.axes[axis].measuring_system
    }

    /// Which steps of referencing and of the groupings this control has taken.
    #[must_use]
    pub fn taken_transitions(&self) -> TakenTransitions {
        self.state.log.taken
    }

    /// Where the reference point approach of an axis is.
    #[must_use]
    pub fn approach_phase(&self, axis: AxisNumber) -> ApproachPhase {
        self.state.axes[axis].approach.phase()
    }

    /// Where the gantry grouping of this number is.
    #[must_use]
    pub fn grouping_phase(&self, number: u8) -> Option<GroupingPhase> {
        let grouping = self.state.groupings.iter().find(|grouping| grouping.number == number)?;
        Some(grouping.phase)
    }

    /// Somebody else wrote into the NCK's half.
    pub fn half_overwritten(&mut self) {
        self.state.overwritten = true;
        self.resting.wake_all();
    }

    /// Somebody else wrote DBB5 of a mode group in DB11 (E-01).
    pub fn strobe_written(&mut self, group: ModeGroupNumber) {
        self.state.strobe_written(group);
    }

    /// Takes what the PLC wrote, and which of it is new, and commands setpoints.
    pub fn decide(&mut self, cycle: u64, to_nck: &ToNck, changes: Changes, cancel_key: bool) {
        self.state.log.cycle = cycle;
        self.state.run_up(&self.parameters);
        self.state.select_modes(&self.parameters, to_nck);
        self.state.watch_emergency_stop(&self.parameters, to_nck);
        self.reset_and_cancel(to_nck, cancel_key);
        if self.resting.take_units_stale() | self.state.check_closings(&self.parameters) {
            self.state.form_units(&self.parameters);
            self.state.report_declarations(&self.parameters);
        }
        self.state.start_channel_referencing(&self.parameters, to_nck);
        self.state.select_group_functions(&self.parameters, to_nck);
        self.state.turn_handwheels();
        self.wake(changes);
        let (parameters, state, resting) = (&*self.parameters, &mut *self.state, &*self.resting);
        state.select_measuring_systems(parameters, to_nck, resting);
        state.select_parameter_sets(parameters, to_nck, resting);
        state.enable(parameters, to_nck, resting);
        state.select_functions(parameters, to_nck, resting);
        let mut next = 0;
        while let Some(index) = state.next_awake(next, resting) {
            next = index + 1;
            let unit = state.units[index];
            state.take_feed(&unit, parameters, to_nck);
            state.take_axis_signals(&unit, to_nck);
            match unit.grouping {
                Some(index) => state.run_grouping(usize::from(index), &unit, parameters, to_nck),
                None => state.run_single(&unit, parameters, to_nck),
            }
            state.stop_by_ramp_function_generator(&unit);
            state.set_setpoints(&unit, parameters);
        }
        state.order_channel_referencing(parameters);
    }

    /// Takes what encoders and drives of these axes tell, and monitors it. The others tell what they told before.
    pub fn observe(&mut self, feedback: &PerAxis<Feedback>, told: AxisSet) {
        for number in told.and(self.parameters.existing).iter() {
            let axis = &self.state.axes[number];
            let feedback = match &axis.active_set(&self.parameters.axes[number]).misfit {
                None => feedback[number],
                Some(misfit) => misfit.seen(&feedback[number], usize::from(axis.measuring_system.unwrap_or(0))),
            };
            if self.state.feedback[number] != feedback {
                self.state.feedback[number] = feedback;
                self.resting.wake_axis(number);
            }
        }
        for number in self.awake().iter() {
            self.state.axes[number].sense(&self.state.feedback[number]);
        }
        self.monitor();
        for number in self.awake().iter() {
            let (axis, summary) = (&self.state.axes[number], &mut self.state.summary);
            summary.drive_ready.set(number, axis.drive_ready);
            summary.referenced.set(number, axis.is_referenced());
            summary.standing.set(number, axis.stands(&self.parameters.axes[number]));
            // An approach that waits at rest is on its way, too.
            summary.in_motion.set(number, axis.is_in_motion() || axis.approach.is_running());
        }
    }

    /// For save and restore.
    #[must_use]
    pub fn save(&self) -> SavedControl {
        SavedControl {
            stored: MachineData::clone(&self.stored),
            active: MachineData::clone(&self.active),
            state: State::clone(&self.state),
        }
    }

    /// Takes back what [`Control::save`] gave.
    pub fn restore(&mut self, saved: SavedControl) {
        let same = saved.stored == saved.active;
        self.stored = Arc::new(saved.stored);
        self.active = if same { Arc::clone(&self.stored) } else { Arc::new(saved.active) };
        self.parameters = Arc::new(Parameters::new(&self.active, &self.presence));
        let taken = self.state.log.taken;
        *self.state = saved.state;
        self.state.log.taken = taken;
        self.resting.begin_anew(&self.state);
    }
}

impl State {
    fn new(parameters: &Parameters) -> Self {
        let mut state = Self {
            log: Log::default(),
            run_up: RunUp::default(),
            mode_groups: PerModeGroup::from_fn(|group| ModeGroup::new(parameters, group)),
            emergency_stop: EmergencyStop::default(),
            channels: PerChannel::default(),
            axes: PerAxis::default(),
            shaping: PerAxis::default(),
            groupings: parameters.groupings.groupings.iter().map(Grouping::new).collect(),
            units: ArrayVec::new(),
            alarms: alarms::Pending::default(),
            feedback: PerAxis::default(),
            summary: Summary::default(),
            handwheels: Default::default(),
            group_functions: PerModeGroup::default(),
            power_on_cause: EventId::NONE,
            definition_cause: EventId::NONE,
            plc_missing: false,
            plc_cause: EventId::NONE,
            declared: gantry::declarations::Declared::default(),
            overwritten: true,
        };
        state.note_power_on();
        state.form_units(parameters);
        state.prepare_position_control(parameters);
        state
    }

    fn note_power_on(&mut self) {
        self.power_on_cause = self.log.note_plain(Place::Nck, Rule::PowerOn, EventId::NONE);
        self.definition_cause = self.log.note_plain(Place::Nck, Rule::GroupingDefined, self.power_on_cause);
    }

    /// Closed groupings and single axes; an open grouping is single axes that are still run as a grouping.
    fn form_units(&mut self, parameters: &Parameters) {
        self.units.clear();
        let mut taken = AxisSet::NONE;
        for (index, grouping) in self.groupings.iter().enumerate() {
            let unit = Unit::of(&grouping.coupling, index, parameters);
            if grouping.phase == gantry::Phase::Open && self.is_kept_open(index, parameters) {
                continue;
            }
            taken = taken.with(unit.set);
            self.units.push(unit);
        }
        for (axis, _) in parameters.existing().filter(|(axis, _)| !taken.contains(*axis)) {
            self.units.push(Unit::single(axis, parameters));
        }
    }

    /// JOG without a machine function.
    fn is_jogging(&self, unit: &Unit) -> bool {
        self.mode_group(unit).is_jogging()
    }

    /// Every axis is in position control, and nothing stops.
    fn unit_can_move(&self, unit: &Unit, parameters: &Parameters) -> bool {
        let free = self.stop_cause(unit.channel, parameters).is_none() && self.motion_forbidden(unit).is_none();
        free && unit.members().all(|axis| self.axes[axis].enabling.is_on())
    }

    /// Every axis of the unit brakes at the slowest rate (O-04), unless a later stage commands something else.
    fn brake(&mut self, unit: &Unit, parameters: &Parameters) {
        let slowest =
            unit.members().map(|axis| parameters.axes[axis].maximum_acceleration).fold(f64::INFINITY, f64::min);
        for axis in unit.members() {
            self.axes[axis].motion = Motion::Brake { deceleration: slowest };
        }
    }
}
