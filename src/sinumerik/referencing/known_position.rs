//! The reference point approach of encoders whose position is known before the axis is at its reference point: distance-coded marks
//! (MD34200 = 3) and absolute encoders (MD34200 = 0 with MD30240 = 4).
//!
//! Called from `approach.rs`, which has the motion of the phases. Two distance-coded marks give the position; with MD34330 = 0 the axis then
//! travels to MD34100, with 1 it stops. An adjusted absolute encoder needs no marks. In a grouping neither travels: section 3 does (C-74).
//!
//! Choices where the manuals leave one: with MD34000 = 1 the cam only guards the end of travel. On the cam the marks are searched in the
//! direction away from it; elsewhere in the direction of MD34010 until the cam is reached, and then in the other direction (C-75). MD34060
//! counts from the start, and again from a change of direction. A mark that is passed twice because the axis turned counts once.

use crate::control::Log;
use crate::sinumerik::alarms;
use crate::sinumerik::parameters::axis::ADJUSTED;
use crate::sinumerik::referencing::approach::{Outcome, View, selected};
use crate::sinumerik::referencing::encoders::ENABLED;
use crate::sinumerik::referencing::state::{Approach, Phase};
use crate::sinumerik::rules::Rule;
use crate::units::Position;
use crate::variables::{Input, Place, Quantity};

impl Approach {
    /// The approach of an absolute encoder: its adjustment, or the way to the reference point.
    pub(super) fn absolute(&mut self, log: &mut Log, view: &View<'_>) -> Outcome {
        let (number, reference) = (view.number, &view.parameters.reference);
        self.set_position = selected(view);
        let state = reference.state[view.encoder];
        let datum = |value: f64| Input::Datum(34210, Some(number), value);
        match state {
            ENABLED => {
                let position = Input::Length(Quantity::Position, number, self.set_position);
                self.step(log, number, Rule::EncoderAdjusted, [datum(1.0), position, Input::None]);
                Outcome::Adjusted(self.set_position - view.axis.actual, self.cause)
            }
            ADJUSTED if self.in_grouping || reference.stops_at_marks[view.encoder] => {
                let stays = f64::from(u8::from(reference.stops_at_marks[view.encoder]));
                let inputs = [datum(2.0), Input::Datum(34330, Some(number), stays), Input::None];
                self.step(log, number, Rule::AbsoluteStays, inputs);
                Outcome::Referenced(Position::ZERO, self.cause)
            }
            ADJUSTED => {
                self.target = self.set_position;
                let inputs = [datum(2.0), Input::Datum(34330, Some(number), 0.0), Input::None];
                self.step(log, number, Rule::AbsoluteTravels, inputs);
                Outcome::Running
            }
            _ => {
                let inputs = [datum(f64::from(state)), Input::None, Input::None];
                self.cause = log.note(Place::Axis(number), Rule::NotAdjusted, inputs, self.cause);
                self.phase = Phase::Idle;
                Outcome::NotAdjusted(self.cause)
            }
        }
    }

    /// The search for distance-coded marks begins.
    pub(super) fn search_marks(&mut self, log: &mut Log, view: &View<'_>, cam: [Input; 3]) {
        let reference = &view.parameters.reference;
        self.origin = view.axis.actual;
        self.set_position = selected(view);
        if reference.cam_is_active && view.signals.deceleration_reference_point_approach() {
            self.marker_direction = -self.cam_direction;
            self.step(log, view.number, Rule::MarksSearchedOffCam, cam);
        } else {
            let datum = Input::Datum(34000, Some(view.number), f64::from(u8::from(reference.cam_is_active)));
            self.step(log, view.number, Rule::MarksSearched, [datum, Input::None, Input::None]);
        }
    }

    /// The search for two distance-coded marks.
    pub(super) fn coded_marks(&mut self, log: &mut Log, view: &View<'_>, cam: [Input; 3]) -> Outcome {
        let (axis, reference) = (view.axis, &view.parameters.reference);
        let ahead = self.marker_direction * self.cam_direction > 0.0;
        if reference.cam_is_active && ahead && view.signals.deceleration_reference_point_approach() {
            self.turn_round(view);
            self.step(log, view.number, Rule::CamAhead, cam);
            return Outcome::Running;
        }
        let Some(mark) = axis.zero_mark else {
            let maximum = reference.maximum_marker_distance[view.encoder];
            return self.too_far(log, view, maximum, alarms::REFERENCE_MARK_MISSING, 34060);
        };
        let shown = Input::Length(Quantity::ZeroMark, view.number, mark);
        let forward = self.marker_direction > 0.0;
        // After a turn the axis passes marks in the wrong direction, and the same one again.
        let Some(first) = self.mark.filter(|&first| if forward { mark > first } else { mark < first }) else {
            self.mark = Some(mark);
            self.step(log, view.number, Rule::FirstMark, [shown, Input::None, Input::None]);
            return Outcome::Running;
        };
        let scale = &reference.scale[view.encoder];
        let apart = (mark - first).abs();
        let distance = Input::Length(Quantity::Distance, view.number, apart);
        let inputs = [shown, distance, Input::Datum(34300, Some(view.number), scale.spacing.user())];
        if apart > scale.spacing + scale.spacing {
            if self.second_attempt {
                return self.fail(log, view, alarms::MEASURING_SYSTEM_ERROR, inputs);
            }
            self.second_attempt = true;
            self.turn_round(view);
            self.step(log, view.number, Rule::MarksTooFarApart, inputs);
            return Outcome::Running;
        }
        let position = reference.coded(scale.position_of(first, mark) + reference.absolute_offset[view.encoder]);
        self.target = self.set_position;
        let stops = self.in_grouping || reference.stops_at_marks[view.encoder];
        let rule = if stops { Rule::StopAfterMarks } else { Rule::MarksPassed };
        self.step(log, view.number, rule, inputs);
        Outcome::Measured(position - first, self.cause)
    }

    fn turn_round(&mut self, view: &View<'_>) {
        self.marker_direction = -self.marker_direction;
        self.origin = view.axis.actual;
        self.mark = None;
    }

    /// At rest after the marks.
    pub(super) fn referenced_at_rest(&mut self, log: &mut Log, view: &View<'_>) -> Outcome {
        let position = Input::Length(Quantity::Position, view.number, view.axis.actual);
        self.step(log, view.number, Rule::Referenced, [position, Input::None, Input::None]);
        Outcome::Referenced(Position::ZERO, self.cause)
    }
}
