//! The control as called by the machine: machine data, and the order of the stages in a cycle.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::control::{Activated, Changes, Taken};
use crate::image::{Location, Part, ToNck};
use crate::motion::Feedback;
use crate::nc_program::Library;
use crate::sinumerik::gantry::state::Phase as GroupingPhase;
use crate::sinumerik::machine_data::{MachineData, Target};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisPresence;
use crate::sinumerik::referencing::state::Phase as ApproachPhase;
use crate::sinumerik::resting::Resting;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{Standing, State};
use crate::sinumerik::strobe::Strobe;
use crate::source::Problem;
use crate::units::{AxisNumber, AxisSet, PerAxis};
use crate::variables::{EventId, FaultName, Input, Place};

/// The control.
///
/// Machine data have a stored and an active set (DEF-09, REF-22). A file or an operator changes the stored set. The class of a
/// datum defines when its value becomes active.
#[derive(Debug)]
pub struct Nck {
    pub(super) stored: Arc<MachineData>,
    pub(super) active: Arc<MachineData>,
    pub(super) presence: Arc<PerAxis<AxisPresence>>,
    /// Values of the archive outside of their ranges (O-30): the model works with the nearest permitted ones.
    out_of_range: Arc<[Target]>,
    /// The profile is that of the 828D.
    is_828d: bool,
    /// The axes whose MD30350 was entered at the control, and those whose entry is active (E-26).
    pub(super) output_entered: [AxisSet; 2],
    pub(super) parameters: Arc<Parameters>,
    pub(super) state: Box<State>,
    pub(super) resting: Box<Resting>,
    strobe: Strobe,
    /// The NC programs in memory.
    pub(super) programs: Arc<Library>,
    /// The cancel key was pressed at the edge of this cycle: its event. The stage resets it, so no saved machine contains it.
    cancel_key: EventId,
    /// The machine data that became active, until the machine has recorded them.
    pub(super) activated: Vec<Activated>,
}

impl Clone for Nck {
    fn clone(&self) -> Self {
        Self {
            stored: Arc::clone(&self.stored),
            active: Arc::clone(&self.active),
            presence: Arc::clone(&self.presence),
            out_of_range: Arc::clone(&self.out_of_range),
            is_828d: self.is_828d,
            output_entered: self.output_entered,
            parameters: Arc::clone(&self.parameters),
            state: self.state.clone(),
            resting: Box::new(self.resting.anew(&self.state)),
            strobe: self.strobe,
            programs: Arc::clone(&self.programs),
            cancel_key: self.cancel_key,
            activated: Vec::new(),
        }
    }
}

/// The data that the stages work with; MD30350 of the axes `entered` was entered at the control. On an 828D, the PLC has
/// machine data and alarms of its own.
fn parameters(
    data: &MachineData,
    presence: &PerAxis<AxisPresence>,
    out_of_range: &[Target],
    (entered, is_828d): (AxisSet, bool),
) -> Parameters {
    let given = |axis| AxisPresence {
        output_is_given: presence[axis].output_is_given || entered.contains(axis),
        ..presence[axis]
    };
    let presence = PerAxis::from_fn(given);
    let data = data.acting(out_of_range);
    let parameters = Parameters::new(&data, &presence);
    if is_828d { parameters.on_828d(&data) } else { parameters }
}

/// A saved control. Its large parts are boxed: a reader has several copies of a part on its stack, which has 2 MB in a thread.
#[derive(Serialize, Deserialize)]
struct SavedNck {
    stored: Box<MachineData>,
    active: Box<MachineData>,
    output_entered: [AxisSet; 2],
    programs: Library,
    state: Box<State>,
}

impl Nck {
    /// A control after power on.
    #[must_use]
    pub(super) fn new(
        data: MachineData,
        presence: PerAxis<AxisPresence>,
        out_of_range: Vec<Target>,
        strobe: Strobe,
        is_828d: bool,
    ) -> Self {
        let stored = Arc::new(data);
        let parameters = Arc::new(parameters(&stored, &presence, &out_of_range, (AxisSet::NONE, is_828d)));
        let state = Box::new(State::new(&parameters));
        let resting = Box::new(Resting::new(&state));
        let (active, presence) = (Arc::clone(&stored), Arc::new(presence));
        let (cancel_key, activated) = (EventId::NONE, Vec::new());
        let (out_of_range, output_entered) = (out_of_range.into(), [AxisSet::NONE; 2]);
        let mut nck = Self {
            stored,
            active,
            presence,
            out_of_range,
            is_828d,
            output_entered,
            parameters,
            state,
            resting,
            strobe,
            programs: Arc::default(),
            cancel_key,
            activated,
        };
        nck.fix_strobes();
        nck
    }

    fn fix_strobes(&mut self) {
        for group in self.strobe.fixed() {
            self.state.strobe_written(group);
        }
    }

    /// Power off and on: stored machine data become active, everything else starts again.
    pub fn power_on(&mut self) -> EventId {
        // What the last cycle wants to store outlasts power off.
        self.store_differences();
        self.store_encoder_data();
        let cycle = self.state.log.cycle;
        let changes_system =
            self.stored.general.scaling_system_is_metric != self.active.general.scaling_system_is_metric;
        if changes_system {
            Arc::make_mut(&mut self.stored).change_system(&self.active);
        }
        let mut before = std::mem::replace(&mut self.active, Arc::clone(&self.stored));
        if changes_system {
            // Lengths that keep their length did not change.
            Arc::make_mut(&mut before).convert_like(&self.active);
        }
        self.output_entered[1] = self.output_entered[0];
        self.parameters = Arc::new(self.parameters_now());
        let events = std::mem::take(&mut self.state.log.events);
        let taken = self.state.log.taken;
        let buffered = self.state.buffered_positions();
        let faults = PerAxis::from_fn(|number| self.state.axes[number].causes.fault);
        let old = std::mem::replace(&mut *self.state, State::new(&self.parameters));
        self.state.keep_programs(&old);
        for (number, axis) in self.state.axes.iter_mut() {
            // A fault outlasts power off.
            axis.causes.fault = faults[number];
            if self.parameters.axes[number].compensation.keeps_side {
                axis.compensation.keep_side_of(&old.axes[number].compensation);
            }
        }
        self.state.buffered = Some(buffered);
        let log = &mut self.state.log;
        (log.cycle, log.events, log.taken) = (cycle, events, taken);
        self.resting.begin_anew(&self.state);
        self.fix_strobes();
        let event = self.state.log.note_plain(Place::Nck, Rule::PowerOn, EventId::NONE);
        self.note_activated(&before, Rule::DataActiveAtPowerOn, event);
        self.report_scaling(&before, event);
        self.lose_adjustments(&before, event);
        self.state.note_after_power_on(event);
        event
    }

    /// From the active machine data.
    pub(super) fn parameters_now(&self) -> Parameters {
        parameters(&self.active, &self.presence, &self.out_of_range, (self.output_entered[1], self.is_828d))
    }

    /// The data that the stages work with.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The active machine data.
    #[must_use]
    pub fn active(&self) -> &MachineData {
        &self.active
    }

    /// The stored machine data.
    #[must_use]
    pub fn stored(&self) -> &MachineData {
        &self.stored
    }

    /// A fault of an axis began or ended. It can move the axes `affected`, or change what their drives and encoders report.
    pub(super) fn note_fault(&mut self, axis: AxisNumber, name: FaultName, begins: bool, affected: AxisSet) -> EventId {
        let rule = if begins { Rule::FaultBegins } else { Rule::FaultEnds };
        let event = self.state.log.note_one(Place::Axis(axis), rule, Input::Fault(name), EventId::NONE);
        for number in affected.iter() {
            self.state.axes[number].causes.fault = event;
        }
        self.wake_all();
        event
    }

    /// The active measuring system of an axis, 0 or 1.
    #[must_use]
    pub fn measuring_system(&self, axis: AxisNumber) -> Option<u8> {
        self.state.axes[axis].measuring_system
    }

    /// The transitions of referencing and of the groupings that this control has made.
    #[must_use]
    pub fn taken_transitions(&self) -> Taken {
        self.state.log.taken
    }

    /// The phase of the reference point approach of an axis.
    #[must_use]
    pub fn approach_phase(&self, axis: AxisNumber) -> ApproachPhase {
        self.state.axes[axis].approach.phase()
    }

    /// The phase of the gantry grouping of this number.
    #[must_use]
    pub fn grouping_phase(&self, number: u8) -> Option<GroupingPhase> {
        let grouping = self.state.groupings.iter().find(|grouping| grouping.number == number)?;
        Some(grouping.phase)
    }

    /// The cancel key is pressed in this cycle.
    pub(super) fn press_cancel_key(&mut self) -> EventId {
        self.cancel_key = self.state.log.note_plain(Place::Nck, Rule::CancelKey, EventId::NONE);
        self.cancel_key
    }

    /// A cycle begins.
    pub(super) fn begin(&mut self, cycle: u64) {
        self.state.log.begin(cycle);
        self.state.alarms.begin();
    }

    /// A client or a scenario wrote these bits.
    pub(super) fn written_from_outside(&mut self, location: Location) {
        match location.part {
            Part::FromNck => {
                self.state.overwritten = true;
                self.resting.wake_all();
            }
            Part::Hmi => {
                for group in self.strobe.touched_by(location) {
                    self.state.strobe_written(group);
                }
            }
            Part::ToNck
            | Part::Inputs
            | Part::Outputs
            | Part::Flags
            | Part::Timers
            | Part::Counters
            | Part::Block(_) => {}
        }
    }

    /// Reads the data of the PLC and their changes, and commands setpoints.
    pub fn decide(&mut self, to_nck: &ToNck, changes: Changes) {
        let cancel_key = std::mem::take(&mut self.cancel_key);
        self.store_differences();
        self.store_encoder_data();
        self.state.note_power_on();
        self.state.run_up(&self.parameters);
        self.state.select_modes(&self.parameters, to_nck);
        self.state.watch_user_alarms(&self.parameters, to_nck);
        self.state.raise_messages();
        self.state.watch_emergency_stop(&self.parameters, to_nck);
        self.select_program_tests(to_nck);
        self.start_searches(to_nck);
        self.reset_and_cancel(to_nck, cancel_key);
        self.exchange_axes(changes.axes, to_nck);
        if self.resting.take_units_stale() {
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
        self.run_programs(to_nck, &changes);
        self.position_single_axes(changes.axes, to_nck);
        let (parameters, state, resting) = (&*self.parameters, &mut *self.state, &*self.resting);
        let mut next = 0;
        while let Some(index) = state.next_awake(next, resting) {
            next = index + 1;
            let unit = state.units[index];
            if state.decides(index, resting) {
                state.take_feed(&unit, parameters, to_nck);
                state.take_axis_signals(&unit, to_nck);
                match unit.grouping {
                    Some(index) => state.run_grouping(usize::from(index), &unit, parameters, to_nck),
                    None if state.spindles[unit.leader()].is_some() => state.run_spindle(&unit, parameters, to_nck),
                    None => state.run_single(&unit, parameters, to_nck),
                }
                state.stop_by_ramp_function_generator(&unit);
            } else if state.stays(&unit) {
                continue;
            }
            state.set_setpoints(&unit, parameters);
        }
        state.order_channel_referencing(parameters, to_nck);
        self.store_encoder_data();
        self.generate_signals(to_nck);
        self.overlay(to_nck);
        self.compensate();
    }

    /// Takes the feedback of encoders and drives of these axes, and monitors it. The feedback of the other axes has not changed.
    pub fn observe(&mut self, feedback: &PerAxis<Feedback>, changed: AxisSet) {
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        for number in changed.with(self.resting.deciding_now(state)).and(parameters.existing).iter() {
            let axis = &mut state.axes[number];
            let seen = match &axis.active_set(&parameters.axes[number]).misfit {
                None => feedback[number],
                Some(misfit) => misfit.seen(&feedback[number], usize::from(axis.measuring_system.unwrap_or(0))),
            };
            if state.feedback[number] != seen {
                state.feedback[number] = seen;
                self.resting.hear(number);
            }
            if (axis.drive_ready, axis.brake) != (seen.drive_ready, seen.brake) {
                state.log.news.set(number, true);
            }
            axis.sense(&seen);
        }
        if self.state.read_encoders(&self.parameters) {
            self.resting.wake_all();
        }
        self.monitor();
        let (awake, decided) = (self.awake(), self.decided());
        let mut summary = self.state.summary;
        let synchronising = self.state.synchronising();
        summary.before =
            Standing { standing: summary.standing, in_motion: summary.in_motion, referenced: summary.referenced };
        for number in awake.iter() {
            let axis = &self.state.axes[number];
            let turns = axis.speed_controlled; // A spindle in speed control does not count (S-02).
            summary.standing.set(number, turns || axis.is_stationary(&self.parameters.axes[number]));
            // An approach and a synchronising motion that wait at standstill also count as motion (O-31).
            let busy = axis.approach.is_running() || synchronising.contains(number);
            summary.in_motion.set(number, !turns && (axis.is_in_motion() || busy));
        }
        for number in awake.and(decided).iter() {
            let axis = &self.state.axes[number];
            summary.drive_ready.set(number, axis.drive_ready);
            summary.referenced.set(number, axis.is_referenced());
        }
        self.state.summary = summary;
    }

    /// The complete state, as bytes.
    pub(super) fn save(&self) -> Vec<u8> {
        let saved = SavedNck {
            stored: Box::new(MachineData::clone(&self.stored)),
            active: Box::new(MachineData::clone(&self.active)),
            output_entered: self.output_entered,
            programs: Library::clone(&self.programs),
            state: Box::new(State::clone(&self.state)),
        };
        postcard::to_stdvec(&saved).expect("plain data can always be written")
    }

    /// Restores the state from [`Nck::save`].
    ///
    /// # Errors
    /// The bytes are not a saved control of this version. In this case nothing has changed.
    pub(super) fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        let damaged = |what: &dyn std::fmt::Display| {
            Problem::new(
                format!("expected a saved control, found damaged bytes: {what}"),
                "restore bytes from `save` of this version, on the same machine",
            )
        };
        let (saved, rest) = postcard::take_from_bytes::<SavedNck>(saved).map_err(|error| damaged(&error))?;
        if !rest.is_empty() {
            return Err(damaged(&format_args!("{} more than expected", rest.len())));
        }
        // Not by value: 0.0 and -0.0 are equal, and are saved with different bytes.
        let same = postcard::to_stdvec(&saved.stored) == postcard::to_stdvec(&saved.active);
        self.stored = Arc::from(saved.stored);
        self.active = if same { Arc::clone(&self.stored) } else { Arc::from(saved.active) };
        self.output_entered = saved.output_entered;
        self.programs = Arc::new(saved.programs);
        self.parameters = Arc::new(self.parameters_now());
        let taken = std::mem::replace(&mut self.state, saved.state).log.taken;
        self.state.log.taken = taken;
        self.resting.begin_anew(&self.state);
        Ok(())
    }
}
