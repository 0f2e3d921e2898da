//! Reference point approach of one axis (R1; G1 2.3.1 runs it for each gantry axis).
//!
//! Called once per cycle for the axis that is being referenced. Reads its cam (12.7), its reference point value bits (2.4 to
//! 2.7), the zero mark latched by the encoder, override and feed; writes the motion of the axis. Every phase repeats its command
//! in each cycle, so override and feed stop need no states of their own. Every phase ends with success, with an alarm, or with an
//! abort. [`TRANSITIONS`] is the table of the possible transitions; no other transition can be made.
//!
//! Choices where the manuals leave one: the search direction after the cam is opposite to MD34010 (E-19). An approach that begins
//! on the cam leaves it with MD34040 for MD34050 = 0 and with MD34020 for MD34050 = 1. If the cam is not left within MD34030,
//! alarm 20000 ends the approach. A velocity of 0 that a control accepted (MD34020, MD34040, MD34070, MD32000, MD32300) ends it
//! with 20005 when it starts (O-30), and so does MD34200 other than 1 of a synchronous axis when its turn comes (C-47); a distance of 0
//! (MD34030, MD34060) ends it with the alarm of this distance. An axis whose setpoint rests on or off the cam and that does not
//! stand (MD36060) within 10 s ends it with 20005. 20006 is raised when the axis passes the cam edge at the wrong speed for the
//! second time. Distance-coded marks and absolute encoders are in `known_position.rs`. NC stop holds an approach
//! in phases 1 and 3, and until NC start. Contour monitoring (25050) stops an axis that is blocked.

use crate::control::Log;
use crate::control::next;
use crate::image::{AxisToNck, axis_to_nck};
use crate::motion::Motion;
use crate::sinumerik::alarms;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::axis::{AxisParameters, Kind};
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::referencing::state::{APPROACH_CHART, Approach, Phase, TRANSITIONS};
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Place, Quantity};

/// The result of an approach in this cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum Outcome {
    /// It continues.
    Running,
    /// The reference point is reached: the actual value at the present position is shifted by this distance.
    Referenced(Position, EventId),
    /// Distance-coded marks gave the position, and it continues: the actual value is shifted by this distance.
    Measured(Position, EventId),
    /// The absolute encoder is adjusted: the actual value is shifted by this distance.
    Adjusted(Position, EventId),
    /// The absolute encoder is not adjusted (25022), and it ended.
    NotAdjusted(EventId),
    /// It ended with an alarm.
    Failed(AlarmNumber, EventId),
}

/// The inputs of an approach in a cycle.
pub(super) struct View<'a> {
    pub(super) number: AxisNumber,
    pub(super) axis: &'a Axis,
    pub(super) parameters: &'a AxisParameters,
    pub(super) signals: &'a AxisToNck,
    pub(super) encoder: usize,
}

impl Approach {
    /// Its phase.
    #[must_use]
    pub(in crate::sinumerik) const fn phase(&self) -> Phase {
        self.phase
    }

    /// Whether an approach is running.
    #[must_use]
    pub(in crate::sinumerik) fn is_running(&self) -> bool {
        self.phase != Phase::Idle
    }

    /// Its latest event.
    #[must_use]
    pub(in crate::sinumerik) const fn cause(&self) -> EventId {
        self.cause
    }

    /// The value of MD34100 selected for the latest approach.
    #[must_use]
    pub(in crate::sinumerik) const fn set_position(&self) -> Position {
        self.set_position
    }

    /// Aborts the approach in any phase.
    pub(in crate::sinumerik) fn abort(&mut self) {
        self.phase = Phase::Idle;
    }

    pub(super) fn step(&mut self, log: &mut Log, number: AxisNumber, by: Rule, inputs: [Input; 3]) {
        self.phase = next(TRANSITIONS, &mut log.taken.0[APPROACH_CHART], self.phase, by);
        self.cause = log.note(Place::Axis(number), by, inputs, self.cause);
        self.waited = 0;
    }

    /// Starts towards the cam; `cam_direction` is a sign, `cause` the event that requested the approach.
    pub(in crate::sinumerik) fn start(
        &mut self,
        log: &mut Log,
        direction: f64,
        actual: Position,
        in_grouping: bool,
        cause: EventId,
    ) {
        let phase = next(TRANSITIONS, &mut log.taken.0[APPROACH_CHART], Phase::Idle, Rule::ApproachStarted);
        *self = Self {
            phase,
            cam_direction: direction,
            marker_direction: direction,
            origin: actual,
            in_grouping,
            cause,
            ..Self::default()
        };
    }

    /// One cycle: the motion of the axis, and the result.
    pub(in crate::sinumerik) fn run(
        &mut self,
        log: &mut Log,
        number: AxisNumber,
        axis: &Axis,
        parameters: &AxisParameters,
        signals: &AxisToNck,
    ) -> (Motion, Outcome) {
        let encoder = usize::from(axis.measuring_system.unwrap_or(0));
        let view = View { number, axis, parameters, signals, encoder };
        let outcome = self.decide(log, &view);
        (self.motion(&view), outcome)
    }

    fn decide(&mut self, log: &mut Log, view: &View<'_>) -> Outcome {
        if let Some(failed) = self.interrupted(log, view) {
            return failed;
        }
        let (axis, reference) = (view.axis, &view.parameters.reference);
        let on_cam = view.signals.deceleration_reference_point_approach();
        let cam = [
            axis_signal(view.number, axis_to_nck::deceleration_reference_point_approach, on_cam),
            Input::None,
            Input::None,
        ];
        let creep_from_rising_edge = reference.marker_reverse[view.encoder];
        match self.phase {
            Phase::Idle | Phase::PassShift => {}
            Phase::SearchCam if reference.kind[view.encoder] == Kind::Absolute => return self.absolute(log, view),
            Phase::SearchCam if reference.kind[view.encoder] == Kind::DistanceCoded => {
                self.search_marks(log, view, cam);
            }
            Phase::SearchMark if reference.kind[view.encoder] == Kind::DistanceCoded => {
                return self.coded_marks(log, view, cam);
            }
            Phase::BrakeAfterMarks if axis.stands(view.parameters) => return self.referenced_at_rest(log, view),
            Phase::SearchCam if !reference.cam_is_active => {
                self.origin = axis.actual;
                self.set_position = selected(view);
                self.step(
                    log,
                    view.number,
                    Rule::WithoutCam,
                    [Input::Datum(34000, Some(view.number), 0.0), Input::None, Input::None],
                );
            }
            Phase::SearchCam if on_cam && self.set_off_on_cam(axis) => {
                self.set_position = selected(view);
                self.origin = axis.actual;
                self.turn(log, view, Rule::OnCamAtStart, cam);
            }
            Phase::SearchCam if on_cam => {
                self.set_position = selected(view);
                self.step(log, view.number, Rule::CamReached, cam);
            }
            Phase::SearchCam => {
                return self.too_far(log, view, reference.maximum_cam_distance, alarms::CAM_NOT_REACHED, 34030);
            }
            Phase::BrakeOnCam if axis.stands(view.parameters) => {
                if !on_cam {
                    return self.fail(log, view, alarms::CAM_SIGNAL_MISSING, cam);
                }
                self.origin = axis.actual;
                self.turn(log, view, Rule::StoppedOnCam, cam);
            }
            Phase::LeaveCam if !on_cam => self.step(log, view.number, Rule::CamLeft, cam),
            Phase::BrakeOffCam if axis.stands(view.parameters) => {
                self.origin = axis.actual;
                self.step(log, view.number, Rule::StoppedOffCam, cam);
            }
            Phase::SearchEdge if on_cam == creep_from_rising_edge => {
                return self.edge(log, view, cam);
            }
            Phase::LeaveCam | Phase::SearchEdge => {
                return self.too_far(log, view, reference.maximum_cam_distance, alarms::CAM_NOT_REACHED, 34030);
            }
            Phase::BrakeOnCam | Phase::BrakeOffCam | Phase::BrakeAfterMarks => return self.standstill(log, view),
            Phase::SearchMark => {
                let Some(mark) = axis.zero_mark else {
                    let maximum = reference.maximum_marker_distance[view.encoder];
                    return self.too_far(log, view, maximum, alarms::REFERENCE_MARK_NOT_FOUND, 34060);
                };
                self.target = mark + reference.move_distance[view.encoder];
                let inputs = [Input::Length(Quantity::ZeroMark, view.number, mark), Input::None, Input::None];
                self.step(log, view.number, Rule::ZeroMark, inputs);
            }
            Phase::GoToReferencePoint if axis.arrived => {
                let inputs = [Input::Length(Quantity::Target, view.number, self.target), Input::None, Input::None];
                self.step(log, view.number, Rule::ReferencePointReached, inputs);
            }
            Phase::GoToReferencePoint => {}
            Phase::ExactStop => return self.exact_stop(log, view),
        }
        self.pass_shift(log, view);
        Outcome::Running
    }

    /// From the cam towards the edge: for MD34050 = 0 the cam is left at creep velocity; for MD34050 = 1 it is left first.
    fn turn(&mut self, log: &mut Log, view: &View<'_>, falling: Rule, cam: [Input; 3]) {
        if view.parameters.reference.marker_reverse[view.encoder] {
            self.marker_direction = self.cam_direction;
            let inputs = [cam[0], Input::Datum(34050, Some(view.number), 1.0), Input::None];
            self.step(log, view.number, Rule::LeaveCamFirst, inputs);
        } else {
            self.marker_direction = -self.cam_direction;
            self.step(log, view.number, falling, cam);
        }
    }

    /// The event that ends an approach in any phase: a datum that does not allow it, feed disable, or 0 % while the override does not act
    /// (phase 2).
    fn interrupted(&mut self, log: &mut Log, view: &View<'_>) -> Option<Outcome> {
        let creeping = matches!(self.phase, Phase::LeaveCam | Phase::SearchEdge | Phase::PassShift | Phase::SearchMark)
            && !override_acts_on_marks(view);
        let input = if let Some((datum, value)) = view.parameters.approach_hindered_by(view.encoder) {
            Input::Datum(datum, Some(view.number), value)
        } else if view.axis.feed_disabled {
            view.axis.feed_holder
        } else if creeping && view.axis.feed_factor <= 0.0 {
            view.axis.zero_override(view.number).1
        } else {
            return None;
        };
        Some(self.fail(log, view, alarms::APPROACH_ABORTED, [input, Input::None, Input::None]))
    }

    /// The axis was on the cam when the approach began and has not moved yet.
    fn set_off_on_cam(&self, axis: &Axis) -> bool {
        !self.creep_velocity_missed && axis.setpoint.is_at_rest()
    }

    /// The cam edge that starts the search, if the axis passes it at creep velocity.
    fn edge(&mut self, log: &mut Log, view: &View<'_>, cam: [Input; 3]) -> Outcome {
        let reference = &view.parameters.reference;
        let creep = reference.marker_velocity[view.encoder];
        let speed = view.axis.setpoint.velocity().abs();
        if (speed - creep).abs() > creep * reference.creep_tolerance {
            if self.creep_velocity_missed {
                return self.fail(log, view, alarms::CREEP_VELOCITY_NOT_REACHED, cam);
            }
            self.creep_velocity_missed = true;
            self.origin = view.axis.actual;
            self.step(log, view.number, Rule::CreepVelocityMissed, cam);
            return Outcome::Running;
        }
        self.origin = view.axis.actual;
        self.step(log, view.number, Rule::CamEdge, cam);
        self.pass_shift(log, view);
        Outcome::Running
    }

    /// MD34092 delays the search by whole cycles; with MD34092 = 0 there is no delay.
    fn pass_shift(&mut self, log: &mut Log, view: &View<'_>) {
        let shift = view.parameters.reference.cam_shift[view.encoder];
        if self.phase == Phase::PassShift && (view.axis.actual - self.origin).abs() >= shift {
            let input = Input::Datum(34092, Some(view.number), shift.user());
            self.step(log, view.number, Rule::CamShiftPassed, [input, Input::None, Input::None]);
        }
    }

    pub(super) fn too_far(
        &mut self,
        log: &mut Log,
        view: &View<'_>,
        maximum: Position,
        alarm: AlarmNumber,
        datum: u32,
    ) -> Outcome {
        let travelled = (view.axis.actual - self.origin).abs();
        if travelled <= maximum {
            return Outcome::Running;
        }
        let inputs = [
            Input::Length(Quantity::Distance, view.number, travelled),
            Input::Datum(datum, Some(view.number), maximum.user()),
            Input::None,
        ];
        self.fail(log, view, alarm, inputs)
    }

    /// Waits for standstill after the setpoint has come to rest.
    fn standstill(&mut self, log: &mut Log, view: &View<'_>) -> Outcome {
        self.waited = if view.axis.setpoint.is_at_rest() { self.waited + 1 } else { 0 };
        if self.waited <= view.parameters.standstill_cycles {
            return Outcome::Running;
        }
        let measured = view.axis.measured_velocity(view.number);
        let limit = view.parameters.entered_velocity(view.parameters.standstill_velocity);
        let inputs = [measured, Input::Datum(36060, Some(view.number), limit), Input::None];
        self.fail(log, view, alarms::APPROACH_ABORTED, inputs)
    }

    fn exact_stop(&mut self, log: &mut Log, view: &View<'_>) -> Outcome {
        let deviation = view.axis.deviation().abs();
        let set = view.axis.active_set(view.parameters);
        let [limit, factor] = set.stop_limits.inputs(StopLimit::Fine, view.number);
        let inputs = [Input::Length(Quantity::Deviation, view.number, deviation), limit, factor];
        if deviation <= set.exact_stop_fine {
            self.step(log, view.number, Rule::Referenced, inputs);
            return Outcome::Referenced(self.set_position - self.target, self.cause);
        }
        self.waited += 1;
        if self.waited > view.parameters.positioning_cycles {
            return self.fail(log, view, alarms::APPROACH_ABORTED, inputs);
        }
        Outcome::Running
    }

    pub(super) fn fail(&mut self, log: &mut Log, view: &View<'_>, alarm: AlarmNumber, inputs: [Input; 3]) -> Outcome {
        self.cause = log.note(Place::Axis(view.number), Rule::ApproachAborted, inputs, self.cause);
        self.phase = Phase::Idle;
        Outcome::Failed(alarm, self.cause)
    }

    /// The direction of the movement of the phase, also while it is held: +1, −1, or 0 while braking and at the target.
    pub(in crate::sinumerik) fn direction(&self, axis: &Axis, cam_is_active: bool) -> i8 {
        let sign = match self.phase {
            Phase::Idle | Phase::BrakeOnCam | Phase::BrakeOffCam | Phase::BrakeAfterMarks => return 0,
            Phase::SearchCam if cam_is_active => self.cam_direction,
            Phase::LeaveCam => -self.cam_direction,
            Phase::SearchCam | Phase::SearchEdge | Phase::PassShift | Phase::SearchMark => self.marker_direction,
            Phase::GoToReferencePoint | Phase::ExactStop => {
                let way = (self.target - axis.setpoint.position).increments().signum();
                return i8::try_from(way).unwrap_or(0);
            }
        };
        if sign > 0.0 { 1 } else { -1 }
    }

    /// Whether NC stop acts now: in phases 1 and 3 of an incremental encoder, in the whole search for distance-coded marks without a cam.
    pub(super) fn heeds_nc_stop(&self, axis: &Axis, parameters: &AxisParameters) -> bool {
        let reference = &parameters.reference;
        let encoder = usize::from(axis.measuring_system.unwrap_or(0));
        let in_phases_1_and_3 = match self.phase {
            Phase::SearchCam => reference.cam_is_active,
            Phase::BrakeOnCam | Phase::GoToReferencePoint | Phase::ExactStop => true,
            Phase::Idle
            | Phase::LeaveCam
            | Phase::BrakeOffCam
            | Phase::SearchEdge
            | Phase::PassShift
            | Phase::SearchMark
            | Phase::BrakeAfterMarks => false,
        };
        if reference.kind[encoder] == Kind::DistanceCoded { !reference.cam_is_active } else { in_phases_1_and_3 }
    }

    /// The command of the phase. The override acts in phases 1 and 3 only, feed stop in all.
    fn motion(&self, view: &View<'_>) -> Motion {
        let (parameters, reference) = (view.parameters, &view.parameters.reference);
        let acceleration = parameters.maximum_acceleration;
        let brake = Motion::Brake { deceleration: acceleration };
        let creep = reference.marker_velocity[view.encoder];
        let velocity = match self.phase {
            Phase::Idle | Phase::BrakeOnCam | Phase::BrakeOffCam | Phase::BrakeAfterMarks => return brake,
            Phase::SearchCam if reference.cam_is_active => {
                self.cam_direction * (reference.cam_velocity * view.axis.feed_factor).min(parameters.maximum_velocity)
            }
            Phase::LeaveCam => -self.cam_direction * reference.cam_velocity,
            Phase::SearchMark if reference.kind[view.encoder] == Kind::DistanceCoded => {
                let factor = if override_acts_on_marks(view) { view.axis.feed_factor } else { 1.0 };
                let share = if self.second_attempt { 0.5 } else { 1.0 };
                self.marker_direction * (creep * share * factor).min(parameters.maximum_velocity)
            }
            Phase::SearchCam | Phase::SearchEdge | Phase::PassShift | Phase::SearchMark => {
                self.marker_direction * creep
            }
            Phase::GoToReferencePoint | Phase::ExactStop => {
                let held = view.axis.feed_held;
                let velocity = (reference.position_velocity * view.axis.feed_factor).min(parameters.maximum_velocity);
                let velocity = if held { 0.0 } else { velocity };
                return Motion::GoTo { target: self.target, velocity, acceleration };
            }
        };
        if view.axis.feed_held { brake } else { Motion::Run { velocity, acceleration } }
    }
}

/// Whether the override acts in the search for marks: with distance-coded marks and without a cam (nc_programs 6.1).
fn override_acts_on_marks(view: &View<'_>) -> bool {
    let reference = &view.parameters.reference;
    reference.kind[view.encoder] == Kind::DistanceCoded && !reference.cam_is_active
}

/// The value of MD34100 selected by 2.4 to 2.7; if no bit is set, value 1.
pub(super) fn selected(view: &View<'_>) -> Position {
    let signals = view.signals;
    let values = &view.parameters.reference.set_position;
    let index = [
        signals.reference_point_value_1(),
        signals.reference_point_value_2(),
        signals.reference_point_value_3(),
        signals.reference_point_value_4(),
    ]
    .iter()
    .position(|&bit| bit)
    .unwrap_or(0);
    values[index]
}
