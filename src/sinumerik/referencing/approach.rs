//! Reference point approach of one axis with an incremental encoder (R1; G1 2.3.1 runs it for each gantry axis).
//!
//! Called once per cycle for the axis that is being referenced. Reads its cam (12.7), its reference point value bits
//! (2.4 to 2.7), the zero mark that the encoder caught, override and feed; writes the motion of the axis. Every phase
//! repeats its command in each cycle, so that override and feed stop need no states of their own; every phase ends
//! with success, with an alarm, or with an abort. [`TRANSITIONS`] is the table by which the code runs: a step that is not in it
//! cannot be taken.
//!
//! Choices where the manuals leave one: the search direction after the cam is opposite to MD34010 (E-19); an
//! approach that begins on the cam leaves it with MD34040 for MD34050 = 0 and with MD34020 for MD34050 = 1; a cam
//! that is never left within MD34030 ends with alarm 20000; 20006 comes when the cam edge is met at the wrong speed
//! for the second time. NC stop is not read; an axis that is held by force is stopped by contour monitoring (25050).

use crate::control::Log;
use crate::control::next;
use crate::image::{AxisToNck, axis_to_nck, channel_to_nck};
use crate::motion::Motion;
use crate::sinumerik::alarms;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::inputs::{axis_signal, channel_signal};
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::referencing::state::{APPROACH_CHART, Approach, Phase, TRANSITIONS};
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Place, Quantity};

/// How an approach went on in this cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum Outcome {
    /// It goes on.
    Running,
    /// The reference point is reached: the place where the axis is gets another value by this much.
    Referenced(Position, EventId),
    /// It ended with an alarm.
    Failed(AlarmNumber, EventId),
}

/// What an approach looks at in a cycle.
struct View<'a> {
    number: AxisNumber,
    axis: &'a Axis,
    parameters: &'a AxisParameters,
    signals: &'a AxisToNck,
    encoder: usize,
}

impl Approach {
    /// Where it is.
    #[must_use]
    pub(in crate::sinumerik) const fn phase(&self) -> Phase {
        self.phase
    }

    /// Whether one is running.
    #[must_use]
    pub(in crate::sinumerik) fn is_running(&self) -> bool {
        self.phase != Phase::Idle
    }

    /// The latest event of it.
    #[must_use]
    pub(in crate::sinumerik) const fn cause(&self) -> EventId {
        self.cause
    }

    /// MD34100 as it was selected for the latest approach.
    #[must_use]
    pub(in crate::sinumerik) const fn set_position(&self) -> Position {
        self.set_position
    }

    /// Ends it, from wherever it is.
    pub(in crate::sinumerik) fn abort(&mut self) {
        self.phase = Phase::Idle;
    }

    fn step(&mut self, log: &mut Log, number: AxisNumber, by: Rule, inputs: [Input; 3]) {
        self.phase = next(TRANSITIONS, &mut log.taken.0[APPROACH_CHART], self.phase, by);
        self.cause = log.note(Place::Axis(number), by, inputs, self.cause);
    }

    /// Starts towards the cam, in the direction of a sign; `cause` is the event that asked for it.
    pub(in crate::sinumerik) fn start(&mut self, log: &mut Log, direction: f64, actual: Position, cause: EventId) {
        let phase = next(TRANSITIONS, &mut log.taken.0[APPROACH_CHART], Phase::Idle, Rule::ApproachStarted);
        *self = Self {
            phase,
            cam_direction: direction,
            marker_direction: direction,
            origin: actual,
            cause,
            ..Self::default()
        };
    }

    /// One cycle: the motion that the axis is to make, and how it went on.
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
            Phase::BrakeOnCam | Phase::BrakeOffCam => {}
            Phase::SearchMark => {
                let Some(mark) = axis.zero_mark else {
                    let maximum = reference.maximum_marker_distance[view.encoder];
                    return self.too_far(log, view, maximum, alarms::REFERENCE_MARK_NOT_FOUND, 34060);
                };
                self.target = mark + reference.move_distance[view.encoder];
                let inputs = [Input::Length(Quantity::Position, view.number, mark), Input::None, Input::None];
                self.step(log, view.number, Rule::ZeroMark, inputs);
            }
            Phase::GoToReferencePoint if axis.arrived => {
                let inputs = [Input::Length(Quantity::Position, view.number, self.target), Input::None, Input::None];
                self.step(log, view.number, Rule::ReferencePointReached, inputs);
                self.waited = 0;
            }
            Phase::GoToReferencePoint => {}
            Phase::ExactStop => return self.exact_stop(log, view),
        }
        self.pass_shift(log, view);
        Outcome::Running
    }

    /// From the cam towards the edge: for MD34050 = 0 it is left at creep velocity, for 1 it is left first.
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

    /// What ends an approach in any phase: feed disable; 0 % while the override does not act (phase 2).
    fn interrupted(&mut self, log: &mut Log, view: &View<'_>) -> Option<Outcome> {
        let creeping = matches!(self.phase, Phase::LeaveCam | Phase::SearchEdge | Phase::PassShift | Phase::SearchMark);
        let input = if view.axis.feed_disabled {
            channel_signal(view.parameters.channel, channel_to_nck::feed_disable, true)
        } else if creeping && view.axis.feed_factor <= 0.0 {
            axis_signal(view.number, axis_to_nck::override_active, true)
        } else {
            return None;
        };
        Some(self.fail(log, view, alarms::APPROACH_ABORTED, [input, Input::None, Input::None]))
    }

    /// The axis was on the cam when the approach began: it has not moved yet.
    fn set_off_on_cam(&self, axis: &Axis) -> bool {
        !self.creep_velocity_missed && axis.setpoint.is_at_rest()
    }

    /// The cam edge that starts the search, if it is met at creep velocity.
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

    /// MD34092 delays the search, by whole cycles; MD34092 = 0 delays nothing.
    fn pass_shift(&mut self, log: &mut Log, view: &View<'_>) {
        let shift = view.parameters.reference.cam_shift[view.encoder];
        if self.phase == Phase::PassShift && (view.axis.actual - self.origin).abs() >= shift {
            let input = Input::Datum(34092, Some(view.number), shift.user());
            self.step(log, view.number, Rule::CamShiftPassed, [input, Input::None, Input::None]);
        }
    }

    fn too_far(
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

    fn exact_stop(&mut self, log: &mut Log, view: &View<'_>) -> Outcome {
        let deviation = view.axis.deviation().abs();
        let inputs = [
            Input::Length(Quantity::Deviation, view.number, deviation),
            Input::Datum(36010, Some(view.number), view.axis.active_set(view.parameters).exact_stop_fine.user()),
            Input::None,
        ];
        if deviation <= view.axis.active_set(view.parameters).exact_stop_fine {
            self.step(log, view.number, Rule::Referenced, inputs);
            return Outcome::Referenced(self.set_position - self.target, self.cause);
        }
        self.waited += 1;
        if self.waited > view.parameters.positioning_cycles {
            return self.fail(log, view, alarms::APPROACH_ABORTED, inputs);
        }
        Outcome::Running
    }

    fn fail(&mut self, log: &mut Log, view: &View<'_>, alarm: AlarmNumber, inputs: [Input; 3]) -> Outcome {
        self.cause = log.note(Place::Axis(view.number), Rule::ApproachAborted, inputs, self.cause);
        self.phase = Phase::Idle;
        Outcome::Failed(alarm, self.cause)
    }

    /// What the phase commands. The override acts in phases 1 and 3 only, feed stop in all.
    fn motion(&self, view: &View<'_>) -> Motion {
        let (parameters, reference) = (view.parameters, &view.parameters.reference);
        let acceleration = parameters.maximum_acceleration;
        let brake = Motion::Brake { deceleration: acceleration };
        let creep = reference.marker_velocity[view.encoder];
        let velocity = match self.phase {
            Phase::Idle | Phase::BrakeOnCam | Phase::BrakeOffCam => return brake,
            Phase::SearchCam if reference.cam_is_active => {
                self.cam_direction * (reference.cam_velocity * view.axis.feed_factor).min(parameters.maximum_velocity)
            }
            Phase::LeaveCam => -self.cam_direction * reference.cam_velocity,
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

/// MD34100 as 2.4 to 2.7 select it; none set means value 1.
fn selected(view: &View<'_>) -> Position {
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
