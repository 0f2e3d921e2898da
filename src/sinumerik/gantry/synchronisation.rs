//! Section 3 of a grouping: comparing positions, waiting, and the decoupled motion. Also the loss and the return of synchronism
//! outside of section 3 (G1 2.3.1, 2.3.2).
//!
//! Called by `grouping.rs` once per cycle for each grouping. The choices are described there.

use crate::control::Log;
use crate::image::{Signal, axis_from_nck, axis_to_nck};
use crate::motion::coupling::{Moves, Progress, Realign, Realigning, Target};
use crate::motion::{Limits, Motion};
use crate::sinumerik::alarms;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::gantry::state::{Grouping, Phase};
use crate::sinumerik::gantry::view::{Permit, View, Want, Wants};
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Parameter, Place, Quantity};

/// The smallest number of cycles of a synchronising motion (O-32).
const SHOWN_CYCLES: u8 = 2;

impl Grouping {
    /// Section 3: starts automatically, or waits (REF-06, REF-07, REF-11).
    pub(in crate::sinumerik) fn compare_positions(
        &mut self,
        view: &View<'_>,
        event: EventId,
        locked: bool,
        log: &mut Log,
    ) {
        let leader = self.coupling.leader();
        self.from_referencing = true;
        let all = log.note_plain(Place::Axis(leader), Rule::AllReferenced, event);
        if let Some((axis, difference)) = self.out_of_trip_limit(view) {
            // E-13: beyond MD37130 the grouping is not ready to be started; monitoring trips in this cycle.
            let limit = view.parameters.axes[axis].gantry.trip_limit_not_synchronised;
            let measured = Input::Length(Quantity::SynchronismDifference, axis, difference);
            let inputs = [measured, Input::Datum(37130, Some(axis), limit.user()), Input::None];
            self.step(log, Rule::ReadyNoMore, inputs, all);
            return;
        }
        let mut wait = None;
        for (follower, difference) in self.misalignments(view) {
            let limit = view.parameters.axes[follower].gantry.warning_limit;
            let datum = Input::Datum(37110, Some(follower), limit.user());
            if limit == Position::ZERO {
                wait = wait.or(Some((Rule::WaitWarningLimitZero, [datum, Input::None, Input::None])));
            } else if difference.abs() >= limit {
                let measured = Input::Length(Quantity::SynchronismDifference, follower, difference);
                wait = wait.or(Some((Rule::WaitDifference, [measured, datum, Input::None])));
            }
        }
        if locked {
            let locked =
                [axis_signal(leader, axis_to_nck::no_automatic_synchronization, true), Input::None, Input::None];
            wait = wait.or(Some((Rule::WaitLocked, locked)));
        }
        if let Some((rule, inputs)) = wait {
            self.step(log, rule, inputs, all);
        } else {
            self.decouple(view);
            self.step(log, Rule::AutomaticStart, [Input::None; 3], all);
        }
    }

    /// The distance of each synchronous axis from the leading axis, independent of the base of its difference.
    fn misalignments<'a>(&'a self, view: &'a View<'_>) -> impl Iterator<Item = (AxisNumber, Position)> + 'a {
        self.coupling.followers().filter_map(|axis| Some((axis, self.coupling.misalignment(axis, view.axes)?)))
    }

    /// The first synchronous axis whose distance exceeds MD37130.
    fn out_of_trip_limit(&self, view: &View<'_>) -> Option<(AxisNumber, Position)> {
        let limit = |axis: AxisNumber| view.parameters.axes[axis].gantry.trip_limit_not_synchronised;
        self.misalignments(view).find(|&(axis, difference)| difference.abs() > limit(axis))
    }

    /// The common position: MD34100 of the leading axis after referencing, or with MD34330 = 1 (REF-20) and otherwise its position (REF-15).
    /// A leading axis that runs out returns to its actual value. One that rests does not move, and the others go to its setpoint (C-78): a
    /// deviation within the window of exact stop would otherwise stay between the setpoints of the coupling.
    fn decouple(&mut self, view: &View<'_>) {
        let leader = self.coupling.leader();
        let axis = &view.axes[leader];
        let runs_out = !axis.setpoint.is_at_rest()
            || axis.deviation().abs() > axis.active_set(&view.parameters.axes[leader]).exact_stop_fine;
        // MD34330 = 1: the leading axis stays where its encoder gave the position.
        let to_reference_point = self.from_referencing && !stays_after_referencing(view, leader);
        let moves = if self.from_referencing || runs_out { Moves::All } else { Moves::Followers };
        let reference = to_reference_point.then(|| Target::Given(axis.approach.set_position()));
        let own = if moves == Moves::Followers { Target::LeaderSetpoint } else { Target::LeaderActual };
        let target = reference.unwrap_or(own);
        self.coupling.begin_realignment(Realign { moves, target }, view.axes);
    }

    /// 29.4 rises while the grouping waits.
    pub(in crate::sinumerik) fn start_synchronising(
        &mut self,
        view: &View<'_>,
        permit: Permit,
        log: &mut Log,
    ) -> Wants {
        if !permit.granted {
            return Wants::new();
        }
        self.decouple(view);
        let inputs = [
            axis_signal(self.coupling.leader(), axis_to_nck::start_gantry_synchronization, true),
            Input::None,
            Input::None,
        ];
        self.step(log, Rule::StartByPlc, inputs, self.cause);
        self.synchronise(view, permit, log)
    }

    /// The decoupled motion of section 3: each axis with its own MD34040, or MD34070 (E-12).
    pub(in crate::sinumerik) fn synchronise(&mut self, view: &View<'_>, permit: Permit, log: &mut Log) -> Wants {
        let mut wants = Wants::new();
        if !permit.granted {
            let (input, cause) = permit.hindrance;
            let cause = if cause.is_some() { cause } else { self.cause };
            self.abort_synchronising([input, Input::None, Input::None], cause, log, &mut wants);
            return wants;
        }
        let fast = self.moves_fast(view);
        let limits = |number| velocity_and_acceleration(view, number, fast);
        let in_position = |number: AxisNumber| {
            let axis = &view.axes[number];
            axis.deviation().abs() <= axis.active_set(&view.parameters.axes[number]).exact_stop_fine
        };
        // O-32: 10655 and 101.4 are shown for two cycles, also where nothing has to move.
        let may_end = self.shown_cycles >= SHOWN_CYCLES;
        let realigning = self.coupling.realign(view.axes, limits, in_position, may_end);
        let Some(Realigning { commands, progress, .. }) = realigning else {
            return wants;
        };
        let hindered = |(axis, motion): &(AxisNumber, Motion)| {
            let moves = matches!(motion, Motion::GoTo { target, .. } if *target != view.axes[*axis].setpoint.position);
            moves.then(|| Some((*axis, hindered_by(view, *axis, fast)?)))?
        };
        if let Some((axis, datum)) = commands.iter().find_map(hindered) {
            // MD34040 = 0 became active after the approach (O-30).
            let input = Input::Datum(datum, Some(axis), 0.0);
            self.abort_synchronising([input, Input::None, Input::None], self.cause, log, &mut wants);
            wants.push(Want::RaiseOfAxis { alarm: alarms::APPROACH_ABORTED, axis, cause: self.cause });
            return wants;
        }
        for (axis, motion) in commands {
            let setpoint = view.axes[axis].setpoint.position;
            let travel = match motion {
                // Feed stop or an override of 0 % holds it.
                Motion::GoTo { target, .. } if motion.is_held() => {
                    Travel::waiting(i8::try_from((target - setpoint).increments().signum()).unwrap_or(0))
                }
                Motion::GoTo { .. }
                | Motion::Brake { .. }
                | Motion::Run { .. }
                | Motion::Interpolated { .. }
                | Motion::Track
                | Motion::Hold => Travel::moving(motion.direction(setpoint)),
            };
            wants.push(Want::Move { axis, motion, travel, cause: self.cause });
        }
        match progress {
            Progress::Running => {}
            Progress::Waiting(axis, cycles) if cycles > view.parameters.axes[axis].positioning_cycles => {
                self.abort_synchronising(exact_stop(view, axis), self.cause, log, &mut wants);
                wants.push(Want::RaiseOfAxis { alarm: alarms::APPROACH_ABORTED, axis, cause: self.cause });
            }
            Progress::Waiting(..) => {}
            Progress::Done(_) => self.close_synchronised(view, log, &mut wants),
        }
        wants
    }

    /// E-12: MD34070 where the leading axis has an absolute or distance-coded encoder and goes to its reference point.
    fn moves_fast(&self, view: &View<'_>) -> bool {
        let leader = self.coupling.leader();
        let encoder = usize::from(view.axes[leader].measuring_system.unwrap_or(0));
        let knows = view.parameters.axes[leader].reference.knows_position_before(encoder);
        self.from_referencing && knows && !stays_after_referencing(view, leader)
    }

    fn abort_synchronising(&mut self, inputs: [Input; 3], cause: EventId, log: &mut Log, wants: &mut Wants) {
        self.step(log, Rule::SynchronisationAborted, inputs, cause);
        self.from_referencing = false;
        self.rest(if log.is_of_this_cycle(cause) { cause } else { self.cause }, wants);
    }

    /// All axes are at their target: the grouping is synchronised, and the coupling acts again (REF-10).
    fn close_synchronised(&mut self, view: &View<'_>, log: &mut Log, wants: &mut Wants) {
        let leader = self.coupling.leader();
        self.step(log, Rule::Synchronised, exact_stop(view, leader), self.cause);
        let cause = self.cause;
        wants.extend(self.coupling.members().map(|axis| {
            let motion = Motion::Brake { deceleration: view.parameters.axes[axis].maximum_acceleration };
            Want::Move { axis, motion, travel: Travel::None, cause }
        }));
    }

    /// The loss of synchronism or readiness, and the return of synchronism outside of section 3.
    pub(in crate::sinumerik) fn watch_synchronism(
        &mut self,
        view: &View<'_>,
        locked: bool,
        log: &mut Log,
        wants: &mut Wants,
    ) {
        self.open_or_close(view, log, wants);
        let (axes, phase) = (view.axes, self.phase);
        let follower = self.coupling.members().find(|&axis| axes[axis].enabling.follow_up);
        let followed_up = std::mem::replace(&mut self.followed_up, follower.is_some());
        let keeps = !self.lose_synchronism(view, log, wants);
        match phase {
            Phase::WaitingForStart | Phase::Synchronising if keeps => {
                if let Some((axis, cause)) = self.tripped() {
                    let trip = axis_signal(axis, axis_from_nck::gantry_trip_limit_exceeded, true);
                    self.end_ready(trip, cause, log, wants);
                }
            }
            Phase::NotSynchronised if keeps => self.make_ready(view, log),
            Phase::WaitingForStart
            | Phase::Synchronising
            | Phase::NotSynchronised
            | Phase::ReferencingLeadingAxis
            | Phase::ReferencingSynchronousAxis
            | Phase::Synchronised
            | Phase::Open => {}
        }
        if followed_up && follower.is_none() {
            // Differences that are not absolute count from the present positions.
            self.coupling.count_anew(axes);
            self.returning = true;
            self.coupling.clear_bases();
        }
        // MON-10: with an absolute encoder only synchronisation makes extended monitoring act.
        let referenced = |axis| axes[axis].is_referenced() && !view.keeps_reference(axis);
        self.extended.readiness.observe(self.coupling.members().all(referenced));
        // If an enable is missing on another axis, follow-up ends in hold.
        let back = self.coupling.members().all(|axis| axes[axis].enabling.is_on());
        if back && std::mem::take(&mut self.returning) {
            self.restore_synchronism(view, locked, log, wants);
            if self.lost_in_operation {
                // If synchronism is not restored, the present difference is the base of the limits (E-14).
                self.coupling.keep_bases(axes);
            }
        }
    }

    /// Follow-up or the loss of a reference takes synchronism and readiness. Returns whether one of them is there.
    ///
    /// It is called again after monitoring: a reference that an encoder fault takes there takes synchronism in the same cycle.
    pub(in crate::sinumerik) fn lose_synchronism(&mut self, view: &View<'_>, log: &mut Log, wants: &mut Wants) -> bool {
        let axes = view.axes;
        let follower = self.coupling.members().find(|&axis| axes[axis].enabling.follow_up);
        let unreferenced = self.coupling.members().find(|&axis| !axes[axis].is_referenced());
        let parked = follower.filter(|&axis| axes[axis].measuring_system.is_none());
        let (rule, input, cause) = if let Some(axis) = parked {
            // A parked axis has no actual value to follow, and 61.3 is 0.
            let signal = axis_signal(axis, axis_from_nck::position_measuring_system_1_activated, false);
            (Rule::SynchronismLostFollowUp, signal, axes[axis].causes.measuring_system)
        } else if let Some(axis) = follower {
            let signal = axis_signal(axis, axis_from_nck::follow_up_active, true);
            (Rule::SynchronismLostFollowUp, signal, axes[axis].causes.enabling)
        } else if let Some(axis) = unreferenced {
            let (causes, active) = (axes[axis].causes, axes[axis].measuring_system.unwrap_or(0));
            let cause = causes.reference[usize::from(active)].max(causes.measuring_system);
            (Rule::SynchronismLostReference, axis_signal(axis, referenced_signal(active), false), cause)
        } else {
            return false;
        };
        match self.phase {
            Phase::Synchronised => self.step(log, rule, [input, Input::None, Input::None], cause),
            Phase::WaitingForStart | Phase::Synchronising => self.end_ready(input, cause, log, wants),
            Phase::NotSynchronised
            | Phase::ReferencingLeadingAxis
            | Phase::ReferencingSynchronousAxis
            | Phase::Open => {}
        }
        true
    }

    /// The grouping is no longer ready; this also ends a synchronising motion.
    fn end_ready(&mut self, input: Input, cause: EventId, log: &mut Log, wants: &mut Wants) {
        self.step(log, Rule::ReadyNoMore, [input, Input::None, Input::None], cause);
        self.rest(if log.is_of_this_cycle(cause) { cause } else { self.cause }, wants);
    }

    /// A synchronous axis whose difference exceeds its trip limit, and the event behind it.
    fn tripped(&self) -> Option<(AxisNumber, EventId)> {
        self.monitored().find(|monitored| monitored.trip).map(|monitored| (monitored.axis, monitored.causes.trip))
    }

    /// E-13: all referenced, not synchronised, difference within MD37130.
    fn make_ready(&mut self, view: &View<'_>, log: &mut Log) {
        if self.out_of_trip_limit(view).is_none() && self.tripped().is_none() {
            // At power on nothing happened to the grouping: encoders that know their position made it ready.
            let reference = |axis: AxisNumber| {
                let active = view.axes[axis].measuring_system.unwrap_or(0);
                view.axes[axis].causes.reference[usize::from(active)]
            };
            let references = self.coupling.members().map(reference).max().unwrap_or(EventId::NONE);
            let cause = if self.cause.is_some() { self.cause } else { references };
            self.step(log, Rule::ReadyAgain, [Input::None; 3], cause);
            self.from_referencing = false;
        }
    }

    /// Back in position control after follow-up: synchronism that was lost in operation is restored if every difference is within the
    /// standstill tolerance (SYN-06) and 29.5 is 0 (E-18). A grouping that has not been synchronised since its reference keeps waiting for
    /// 29.4 (C-52).
    fn restore_synchronism(&mut self, view: &View<'_>, locked: bool, log: &mut Log, wants: &mut Wants) {
        if self.phase != Phase::WaitingForStart || locked || !self.lost_in_operation {
            return;
        }
        let within = self.misalignments(view).all(|(axis, difference)| {
            difference.abs() <= view.axes[axis].active_set(&view.parameters.axes[axis]).standstill_tolerance
        });
        if within {
            let leader = self.coupling.leader();
            self.step(log, Rule::SynchronismRestored, [Input::None; 3], view.axes[leader].causes.enabling);
            wants.extend(self.coupling.followers().map(|axis| Want::TakeSetpoint { axis, of: leader }));
        }
    }

    fn open_or_close(&mut self, view: &View<'_>, log: &mut Log, wants: &mut Wants) {
        let open = self.coupling.members().find(|&axis| view.parameters.axes[axis].gantry.broken_up);
        let is_open = self.phase == Phase::Open;
        if let Some(axis) = open
            && !is_open
        {
            wants.extend(self.referencing().map(Want::AbortApproach));
            let input = Input::Datum(37140, Some(axis), 1.0);
            self.step(log, Rule::Opened, [input, Input::None, Input::None], EventId::NONE);
            self.coupling.release(view.axes);
        } else if open.is_none() && is_open {
            let input = Input::Datum(37140, Some(self.coupling.leader()), 0.0);
            self.step(log, Rule::Closed, [input, Input::None, Input::None], EventId::NONE);
            self.coupling.close(view.axes);
            if self.lost_in_operation {
                self.coupling.keep_bases(view.axes);
            }
        }
    }

    /// Counts the cycles in which the synchronising motion is shown.
    pub(in crate::sinumerik) fn count_shown(&mut self) {
        if self.phase == Phase::Synchronising {
            self.shown_cycles = (self.shown_cycles + 1).min(SHOWN_CYCLES);
        }
    }

    /// The messages of section 3, raised in each cycle in which they apply.
    pub(in crate::sinumerik) fn message(&self, view: &View<'_>) -> Option<Want> {
        let leader = self.coupling.leader();
        let axis = &view.parameters.axes[leader];
        let alarm = match self.phase {
            Phase::WaitingForStart if self.message => alarms::GANTRY_WAITING,
            Phase::Synchronising if !axis.gantry.suppress_message => alarms::GANTRY_SYNCHRONISING,
            Phase::WaitingForStart
            | Phase::Synchronising
            | Phase::NotSynchronised
            | Phase::ReferencingLeadingAxis
            | Phase::ReferencingSynchronousAxis
            | Phase::Synchronised
            | Phase::Open => return None,
        };
        let number = Parameter::Number(i64::from(self.number));
        let channel = Parameter::Channel(view.owners.of(leader).channel);
        let shown = [channel, number, Parameter::None, Parameter::None];
        Some(Want::Raise { alarm, place: Place::Axis(leader), shown, cause: self.cause })
    }
}

/// The deviation of an axis and its window for exact stop fine (MD36010 and MD36012).
fn exact_stop(view: &View<'_>, number: AxisNumber) -> [Input; 3] {
    let axis = &view.axes[number];
    let limits = &axis.active_set(&view.parameters.axes[number]).stop_limits;
    let measured = Input::Length(Quantity::Deviation, number, axis.deviation().abs());
    let [limit, factor] = limits.inputs(StopLimit::Fine, number);
    [measured, limit, factor]
}

/// Whether the position of a leading axis is known without its reference point, and MD34330 = 1 leaves it where it is.
fn stays_after_referencing(view: &View<'_>, number: AxisNumber) -> bool {
    let encoder = usize::from(view.axes[number].measuring_system.unwrap_or(0));
    let reference = &view.parameters.axes[number].reference;
    reference.knows_position_before(encoder) && reference.stops_at_marks[encoder]
}

/// The velocity of the synchronising motion and its datum: MD34040 of the active measuring system, or MD34070.
fn velocity(view: &View<'_>, number: AxisNumber, fast: bool) -> (f64, u32) {
    let reference = &view.parameters.axes[number].reference;
    let encoder = usize::from(view.axes[number].measuring_system.unwrap_or(0));
    if fast { (reference.position_velocity, 34070) } else { (reference.marker_velocity[encoder], 34040) }
}

/// The velocity with the override, and the acceleration; feed stop holds.
fn velocity_and_acceleration(view: &View<'_>, number: AxisNumber, fast: bool) -> Limits {
    let (axis, parameters) = (&view.axes[number], &view.parameters.axes[number]);
    let factor = if axis.feed_held { 0.0 } else { axis.feed_factor };
    let velocity = (velocity(view, number, fast).0 * factor).min(parameters.maximum_velocity);
    Limits { velocity, acceleration: parameters.maximum_acceleration }
}

/// The datum of 0 with which an axis cannot make the synchronising motion.
fn hindered_by(view: &View<'_>, number: AxisNumber, fast: bool) -> Option<u32> {
    let (velocity, datum) = velocity(view, number, fast);
    view.parameters.axes[number].immovable_by.or_else(|| (velocity <= 0.0).then_some(datum))
}

/// "Referenced/synchronized" of a measuring system, 0 or 1.
const fn referenced_signal(measuring_system: u8) -> Signal {
    if measuring_system == 0 {
        axis_from_nck::referenced_synchronized_1
    } else {
        axis_from_nck::referenced_synchronized_2
    }
}
