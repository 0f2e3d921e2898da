//! Positions that outlast power off: absolute encoders, their adjustment and its loss (MD34200 = 0 with MD30240 = 4), and incremental
//! encoders whose position is kept (MD34210).
//!
//! Called at the first feedback after power on, when a parked axis gets a measuring system again, after an adjustment, and once per cycle in
//! the monitoring of the encoders. The machine data that the control writes (MD34090, MD34210) are stored and active at the beginning or at
//! the end of the stage "decide", before a power off in any case.
//!
//! An absolute encoder: actual value = encoder value + MD34090 (C-70), with or without adjustment. MD34210 = 2: referenced. Otherwise 25022
//! with %3 = 0. Changed data of gear, encoder or serial number at power on: 26030, MD34210 = 0 (C-71). MD30240 = 4 for an encoder that
//! is not absolute: 26020 (C-72).
//!
//! An incremental encoder: MD34210 = 1 becomes 2 when it is referenced and the axis rests in exact stop fine, and 1 again when that ends.
//! At power on 2 takes the position of the last power off over, referenced; 3 restores it without a reference (71.4, 71.5), also if it was
//! never referenced (C-73). Without an earlier power off there is no position to take over.

use std::sync::Arc;

use crate::motion::Setpoint;
use crate::sinumerik::activation::axis_of;
use crate::sinumerik::alarms;
use crate::sinumerik::machine_data::MachineData;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::{ADJUSTED, AxisParameters, Kind, Scale};
use crate::sinumerik::referencing::state::{Buffered, EncoderDatum};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, PerAxis, Position};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, Quantity};

/// MD34210 = 1: an absolute encoder can be adjusted; the position of an incremental one is kept once it is referenced.
pub(in crate::sinumerik) const ENABLED: u8 = 1;
/// MD34210 = 3 of an incremental encoder: its position is restored without a reference.
const RESTORED: u8 = 3;
/// Data with which the adjustment of an absolute encoder is lost when they change: serial number, gears, lines, pitch.
const OF_ADJUSTMENT: [u32; 11] = [31000, 31010, 31020, 31030, 31040, 31050, 31060, 31070, 31080, 32100, 34230];
/// %3 of 26020: bit 4, no answer of an encoder with an absolute position, as in 25022.
const NO_ANSWER: i64 = 1 << 4;

impl Scale {
    /// Distance from the nearest distance that two neighbouring marks of the scale can have.
    #[must_use]
    pub(in crate::sinumerik) fn misses(&self, distance: Position) -> Position {
        let (spacing, shift) = (self.spacing.increments().max(1), self.shift.increments().max(1));
        // From a fixed mark to the next one: spacing / 2 + k · shift; from there to the next fixed one, the rest. After a turn: 0.
        let beyond = (distance.increments() - spacing / 2).abs();
        let off = beyond.rem_euclid(shift);
        Position::new(off.min(shift - off).min(distance.increments()))
    }

    /// The position of the first of two marks that were passed one after the other, along the axis from the first fixed mark (Heidenhain).
    ///
    /// With N = MD34300 / MD34310, MRR the distance of both marks in units of MD34310, B = 2 · MRR − N and D the direction:
    /// P1 = (|B| − sgn B − 1) · N / 2 + (sgn B − sgn D) · MRR / 2.
    #[must_use]
    pub(in crate::sinumerik) fn position_of(&self, first: Position, second: Position) -> Position {
        let unit = self.shift.increments().max(1);
        let sign = if self.inverted { -1 } else { 1 };
        let rounded = |length: i64| (length + unit / 2).div_euclid(unit);
        let way = sign * (second - first).increments();
        let (basic, apart) = (rounded(self.spacing.increments()), rounded(way.abs()));
        let code = 2 * apart - basic;
        let twice = (code.abs() - code.signum() - 1) * basic + (code.signum() - way.signum()) * apart;
        Position::new(sign * twice.saturating_mul(unit) / 2)
    }
}

impl State {
    /// The actual values of all encoders, for the next power on.
    pub(in crate::sinumerik) fn buffered_positions(&self) -> PerAxis<[Buffered; 2]> {
        PerAxis::from_fn(|number| {
            let (feedback, axis) = (&self.feedback[number], &self.axes[number]);
            [0, 1].map(|encoder| Buffered {
                position: feedback.encoders[encoder].value + axis.offset[encoder],
                referenced: axis.referenced[encoder],
            })
        })
    }

    /// The first feedback after power on. Returns whether an actual value or a reference changed.
    pub(in crate::sinumerik) fn read_encoders(&mut self, parameters: &Parameters) -> bool {
        if std::mem::replace(&mut self.encoders_read, true) {
            return false;
        }
        let mut changed = false;
        for (number, axis) in parameters.existing() {
            for encoder in 0..usize::from(axis.encoders).min(2) {
                changed |= self.read_encoder(number, encoder, axis);
            }
            if self.axes[number].measuring_system.is_some() {
                changed |= self.read_absolute(number, self.as_after_power_on, axis);
            }
        }
        changed
    }

    /// The zero of one encoder after power on.
    fn read_encoder(&mut self, number: AxisNumber, encoder: usize, parameters: &AxisParameters) -> bool {
        let (feedback, reference) = (&self.feedback[number], &parameters.reference);
        let (value, is_absolute) = (feedback.encoders[encoder].value, feedback.absolute[encoder]);
        let buffered = self.buffered.as_ref().map(|positions| positions[number][encoder]);
        let (kind, state) = (reference.kind[encoder], reference.state[encoder]);
        let offset = match (kind, buffered) {
            (Kind::Absolute, _) if is_absolute => reference.absolute_offset[encoder],
            (Kind::ZeroMark | Kind::DistanceCoded, Some(Buffered { position, referenced }))
                if state == RESTORED || state == ADJUSTED && referenced =>
            {
                self.take_over(number, encoder, state, position);
                position - value
            }
            // It counts from here, also if it could read its position.
            _ if is_absolute => -value,
            _ => return false,
        };
        let axis = &mut self.axes[number];
        axis.offset[encoder] = offset;
        if axis.measuring_system.map(usize::from) == Some(encoder) {
            // Before the first feedback every axis counts as at 0.
            let shift = value + offset;
            axis.actual = value + offset;
            axis.setpoint = Setpoint::at(axis.actual);
            axis.before = axis.actual;
            axis.monitor.restart(axis.actual);
            axis.signals.hold_at(axis.actual);
            self.value_shifted(number, shift);
        }
        true
    }

    /// The position of the last power off.
    fn take_over(&mut self, number: AxisNumber, encoder: usize, state: u8, position: Position) {
        let inputs = [
            Input::Datum(34210, Some(number), f64::from(state)),
            Input::Length(Quantity::Position, number, position),
            Input::None,
        ];
        let referenced = state == ADJUSTED;
        let rule = if referenced { Rule::PositionTakenOver } else { Rule::PositionRestored };
        let event = self.log.note(Place::Axis(number), rule, inputs, self.power_on_cause);
        let axis = &mut self.axes[number];
        if referenced {
            (axis.referenced[encoder], axis.causes.reference[encoder]) = (true, event);
        } else {
            (axis.restored[encoder], axis.causes.restored[encoder]) = (true, event);
        }
        self.log.news.set(number, true);
    }

    /// The absolute encoders of an axis that is not parked: adjusted ones are referenced. Returns whether a reference changed.
    pub(in crate::sinumerik) fn read_absolute(
        &mut self,
        number: AxisNumber,
        cause: EventId,
        parameters: &AxisParameters,
    ) -> bool {
        if !self.encoders_read {
            return false;
        }
        let mut changed = false;
        for encoder in 0..usize::from(parameters.encoders).min(2) {
            let reference = &parameters.reference;
            if reference.kind[encoder] != Kind::Absolute || self.feedback[number].encoder_faults[encoder] {
                continue;
            }
            let datum = Input::Datum(34210, Some(number), f64::from(reference.state[encoder]));
            let inputs = [datum, Input::None, Input::None];
            if !self.feedback[number].absolute[encoder] {
                let inputs = [Input::Datum(30240, Some(number), 4.0), Input::None, Input::None];
                let event = self.log.note(Place::Axis(number), Rule::EncoderNotAbsolute, inputs, cause);
                self.raise_encoder_alarm(alarms::ENCODER_INITIALISATION, number, encoder, NO_ANSWER, event);
            } else if reference.state[encoder] == ADJUSTED {
                let event = self.log.note(Place::Axis(number), Rule::AbsolutePosition, inputs, cause);
                let axis = &mut self.axes[number];
                (axis.referenced[encoder], axis.causes.reference[encoder]) = (true, event);
                self.log.news.set(number, true);
                changed = true;
            } else {
                let event = self.log.note(Place::Axis(number), Rule::NotAdjusted, inputs, cause);
                self.raise_encoder_alarm(alarms::ENCODER_WARNING, number, encoder, 0, event);
            }
        }
        if changed {
            // A difference is absolute from the reference of both axes on.
            self.value_shifted(number, Position::ZERO);
        }
        changed
    }

    /// 25022, 26020, 26030: `%1` axis, `%2` encoder, `%3` a code.
    pub(in crate::sinumerik) fn raise_encoder_alarm(
        &mut self,
        alarm: AlarmNumber,
        number: AxisNumber,
        encoder: usize,
        code: i64,
        event: EventId,
    ) {
        let code = if alarm == alarms::ABSOLUTE_POSITION_LOST { Parameter::None } else { Parameter::Number(code) };
        let shown = [Parameter::Axis(number), Parameter::Number(encoder as i64 + 1), code, Parameter::None];
        self.alarms.raise(alarm, Place::Axis(number), shown, event);
    }

    /// The absolute encoder in use was adjusted: the control stores MD34090 and MD34210.
    pub(in crate::sinumerik) fn store_adjustment(&mut self, number: AxisNumber, cause: EventId) {
        let axis = &self.axes[number];
        let Some(encoder) = axis.measuring_system else { return };
        let offset = Some(axis.offset[usize::from(encoder)]);
        self.written.push(EncoderDatum { axis: number, encoder, state: ADJUSTED, offset, cause });
    }

    /// MD34210 of an incremental encoder whose position is to outlast power off: 1 and 2.
    pub(in crate::sinumerik) fn keep_position(
        &mut self,
        number: AxisNumber,
        encoder: usize,
        parameters: &AxisParameters,
    ) {
        let reference = &parameters.reference;
        let state = reference.state[encoder];
        let keeps = matches!(reference.kind[encoder], Kind::ZeroMark | Kind::DistanceCoded);
        if !keeps || !matches!(state, ENABLED | ADJUSTED) {
            return;
        }
        let axis = &self.axes[number];
        let fine = axis.active_set(parameters).exact_stop_fine;
        let rests = axis.stands(parameters) && !axis.travel.is_pending() && axis.deviation().abs() <= fine;
        let kept = axis.referenced[encoder] && rests && !axis.approach.is_running();
        if kept == (state == ADJUSTED) {
            return;
        }
        let (rule, state) = if kept { (Rule::StandsReferenced, ADJUSTED) } else { (Rule::LeavesStandstill, ENABLED) };
        let parent = axis.causes.reference[encoder].max(axis.causes.movement());
        let cause = self.log.note_plain(Place::Axis(number), rule, parent);
        #[expect(clippy::cast_possible_truncation, reason = "0 or 1")]
        self.written.push(EncoderDatum { axis: number, encoder: encoder as u8, state, offset: None, cause });
    }
}

impl Nck {
    /// Writes the data of encoders, stored and active.
    pub(in crate::sinumerik) fn store_encoder_data(&mut self) {
        if self.state.written.is_empty() {
            return;
        }
        let before = Arc::clone(&self.active);
        let mut cause = EventId::NONE;
        for written in std::mem::take(&mut self.state.written) {
            let EncoderDatum { axis, encoder, state, offset, cause: event } = written;
            let encoder = usize::from(encoder);
            let number = offset.map(|offset| before.number_of(axis, offset));
            for data in [&mut self.stored, &mut self.active] {
                let data = &mut Arc::make_mut(data).axes[axis];
                data.enc_refp_state[encoder] = state;
                if let Some(number) = number {
                    data.refp_move_dist_corr[encoder] = number;
                }
            }
            cause = cause.max(event);
        }
        self.parameters = Arc::new(self.parameters_now());
        self.resting.wake_all();
        self.note_activated(&before, Rule::EncoderDataStored, cause);
    }

    /// After power on: changed data take the adjustment of absolute encoders (26030).
    pub(in crate::sinumerik) fn lose_adjustments(&mut self, before: &MachineData, power_on: EventId) {
        let changed = self.active.differences(before);
        for target in changed.iter().filter(|target| OF_ADJUSTMENT.contains(&target.datum().number)) {
            let Some(number) = axis_of(target) else { continue };
            let parameters = &self.parameters.axes[number];
            // The gears of the load belong to a parameter set, and act on both encoders.
            let of_encoder = |encoder: usize| target.datum().count != 2 || usize::from(target.index()) == encoder;
            for encoder in 0..usize::from(parameters.encoders).min(2) {
                let reference = &parameters.reference;
                let adjusted = reference.kind[encoder] == Kind::Absolute && reference.state[encoder] == ADJUSTED;
                #[expect(clippy::cast_possible_truncation, reason = "0 or 1")]
                let index = encoder as u8;
                let is_new =
                    !self.state.written.iter().any(|written| (written.axis, written.encoder) == (number, index));
                if !parameters.exists || !adjusted || !of_encoder(encoder) || !is_new {
                    continue;
                }
                let value = self.active.get(target).and_then(|value| value.number()).unwrap_or(0.0);
                let datum = Input::Datum(target.datum().number, Some(number), value);
                let cause = self.state.log.note_one(Place::Axis(number), Rule::AdjustmentLost, datum, power_on);
                self.state.raise_encoder_alarm(alarms::ABSOLUTE_POSITION_LOST, number, encoder, 0, cause);
                self.state.written.push(EncoderDatum { axis: number, encoder: index, state: 0, offset: None, cause });
            }
        }
        self.store_encoder_data();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mm(value: f64) -> Position {
        Position::from_user(value)
    }

    fn scale(inverted: bool) -> Scale {
        Scale { spacing: mm(20.0), shift: mm(0.02), inverted }
    }

    /// nc_programs 6.1: 20 mm / 0.02 mm, N = 1000, marks at 0, 501, 1000, 1502, 2000 periods. The actual values begin anywhere.
    #[test]
    fn two_distance_coded_marks_give_the_position_of_the_first_in_both_directions() {
        // First and second mark in periods.
        let marks =
            [(0, 501), (501, 1000), (1000, 1502), (1502, 2000), (501, 0), (1000, 501), (1502, 1000), (2000, 1502)];
        for (first, second) in marks {
            let at = |periods: i64| mm(-300.0) + Position::new(periods * 20_000);
            assert_eq!(
                scale(false).position_of(at(first), at(second)),
                Position::new(first * 20_000),
                "{first} {second}"
            );
            // A scale against the axis: the same marks, at negative positions.
            let turned = |periods: i64| mm(-300.0) - Position::new(periods * 20_000);
            let position = scale(true).position_of(turned(first), turned(second));
            assert_eq!(position, Position::new(-first * 20_000), "{first} {second}");
        }
    }

    /// Every pair of neighbours of a long scale: the mark of field k is k · N + N / 2 + k + 1.
    #[test]
    fn every_pair_of_marks_of_a_scale_has_its_own_position() {
        let marks: Vec<i64> = (0..200).flat_map(|field| [field * 1000, field * 1000 + 501 + field]).collect();
        for pair in marks.windows(2) {
            let at = |periods: i64| Position::new(periods * 20_000);
            for (first, second) in [(pair[0], pair[1]), (pair[1], pair[0])] {
                assert_eq!(scale(false).position_of(at(first), at(second)), at(first), "{first} {second}");
                assert_eq!(scale(false).misses((at(second) - at(first)).abs()), Position::ZERO, "{first} {second}");
            }
        }
    }

    #[test]
    fn a_distance_beside_the_code_is_found() {
        assert_eq!(scale(false).misses(mm(10.027)), mm(0.007));
        assert_eq!(scale(false).misses(mm(9.973)), mm(0.007));
        assert_eq!(scale(false).misses(mm(0.0)), mm(0.0));
    }
}
