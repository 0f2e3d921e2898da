//! The stage: leads the compensation values of all axes to what they should be.
//!
//! * The compensation of an encoder begins in the cycle in which it is referenced. The setpoint is shifted with the actual value then, so that
//!   nothing moves (K-01). From then on it changes by at most MD36500 in each position-control cycle, and position control moves the axis.
//! * Without a reference it is 0, in the same way.
//! * The compensation of the setpoint changes only in position control: an axis that is switched off keeps it (K-03). It changes by at most
//!   MD32730 (sag) and MD32760 (temperature) of MD32000.

use std::sync::Arc;

use crate::sinumerik::alarms;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::compensation::state::Compensation;
use crate::sinumerik::compensation::targets::{encoder_error, temperature_of};
use crate::sinumerik::machine_data::{Element, TableValue};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Parameter, Place, Quantity, RaisedAlarm};

/// The traverse command of a compensation ends after this number of cycles without a change (K-04).
const STILL_CYCLES: u8 = 5;

impl Nck {
    /// The stage.
    pub(in crate::sinumerik) fn compensate(&mut self) {
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        for number in parameters.compensated.with(state.compensating).and(parameters.existing).iter() {
            let before = state.axes[number].compensation;
            state.compensate_axis(number, parameters);
            let now = &state.axes[number].compensation;
            if *now != before {
                self.resting.hear(number);
            }
            state.compensating.set(number, !now.is_off());
        }
    }

    /// Stores elements of compensation tables that a program has written and the environment has checked. They act at once.
    pub(in crate::sinumerik) fn store_tables(&mut self, elements: &[(Element, TableValue)]) {
        if elements.is_empty() {
            return;
        }
        for (element, value) in elements {
            // A datum that became active in the same stage may protect the table now.
            let _ = Arc::make_mut(&mut self.stored).write_table(*element, *value);
        }
        Arc::make_mut(&mut self.active).tables.clone_from(&self.stored.tables);
        self.parameters = Arc::new(self.parameters_now());
        self.resting.wake_all();
    }
}

impl State {
    fn compensate_axis(&mut self, number: AxisNumber, parameters: &Parameters) {
        let own = &parameters.axes[number];
        let axis = &self.axes[number];
        let mut next = axis.compensation;
        let moved = (axis.setpoint.position - axis.before).increments();
        if moved != 0 {
            next.direction = if moved > 0 { 1 } else { -1 };
            next.side_is_kept = false;
        }
        let mut anew = Position::ZERO;
        for encoder in 0..usize::from(own.encoders).min(2) {
            let referenced = axis.referenced[encoder];
            if referenced && !next.was_referenced[encoder] && !next.side_is_kept {
                let approach = if own.reference.cam_direction > 0.0 { 1 } else { -1 };
                next.reference_direction[encoder] = if next.direction == 0 { approach } else { next.direction };
            }
            let measured = self.feedback[number].encoders[encoder].value + axis.offset[encoder];
            let target = if referenced { encoder_error(axis, &next, encoder, measured, own) } else { 0 };
            let value = next.encoder[encoder].increments();
            let changes = referenced != next.was_referenced[encoder];
            let by = match own.compensation.ramp {
                Some(ramp) if !changes => (target - value).clamp(-ramp, ramp),
                Some(_) | None => target - value,
            };
            next.encoder[encoder] = Position::new(value + by);
            next.was_referenced[encoder] = referenced;
            if changes && axis.measuring_system.map(usize::from) == Some(encoder) {
                anew = Position::new(by);
            }
        }
        let referenced = axis.is_referenced();
        let lost = !referenced && next.setpoint != Position::ZERO;
        let before = next.setpoint;
        if lost {
            (next.sag, next.temperature, next.setpoint) = (0.0, 0.0, Position::ZERO);
            anew += before;
        } else if axis.enabling.moves() {
            self.compensate_setpoint(number, &mut next, parameters);
        }
        let by = if lost { Position::ZERO } else { next.setpoint - before };
        let backlash = &own.compensation;
        if by != Position::ZERO && !backlash.ignores_compensations.iter().all(|ignores| *ignores) {
            next.direction = if by > Position::ZERO { 1 } else { -1 };
        }
        self.command_of_compensation(number, &mut next, by);
        let axis = &mut self.axes[number];
        let old = std::mem::replace(&mut axis.compensation, next);
        axis.take_compensation(&old, anew, by);
    }

    /// Sag and temperature of an axis in position control.
    fn compensate_setpoint(&mut self, number: AxisNumber, next: &mut Compensation, parameters: &Parameters) {
        let own = &parameters.axes[number];
        let acts = self.setpoint_is_compensated(number);
        let wanted = if acts && own.compensation.sag.is_some() { self.sag_of(number, parameters) } else { 0.0 };
        let mut sag = wanted;
        if let Some(limits) = own.compensation.sag {
            sag = wanted.clamp(-limits.maximum, limits.maximum);
            if sag.to_bits() != wanted.to_bits() {
                self.report_sag(alarms::SAG_LIMITED, number, Rule::SagLimited, (32720, limits.data[0]), wanted);
            }
            if (sag - next.sag).abs() > limits.change {
                self.report_sag(alarms::SAG_TOO_FAST, number, Rule::SagTooFast, (32730, limits.data[1]), sag);
            }
            next.sag += (sag - next.sag).clamp(-limits.change, limits.change);
        } else {
            // MD32710 was set to 0: it goes as fast as temperature compensation may.
            let change = own.maximum_velocity * 0.01 * parameters.cycle.seconds();
            next.sag += (sag - next.sag).clamp(-change, change);
        }
        let temperature = if acts { temperature_of(&self.axes[number], own) } else { 0.0 };
        let slowest = own.maximum_velocity * 0.01 * parameters.cycle.seconds();
        let change = own.compensation.temperature.map_or(slowest, |temperature| temperature.change);
        next.temperature += (temperature - next.temperature).clamp(-change, change);
        #[expect(clippy::cast_possible_truncation, reason = "compensation values are bounded; the cast saturates")]
        let sum = (next.sag + next.temperature).round() as i64;
        next.setpoint = Position::new(sum);
    }

    fn report_sag(
        &mut self,
        alarm: crate::variables::AlarmNumber,
        number: AxisNumber,
        rule: Rule,
        datum: (u32, f64),
        value: f64,
    ) {
        #[expect(clippy::cast_possible_truncation, reason = "a value of a table; the cast saturates")]
        let measured = Input::Length(Quantity::Sag, number, Position::new(value.round() as i64));
        let inputs = [measured, Input::Datum(datum.0, Some(number), datum.1), Input::None];
        let parameters = [Parameter::Axis(number), Parameter::None, Parameter::None, Parameter::None];
        let parent = self.axes[number].causes.movement();
        self.raise_new(RaisedAlarm { number: alarm, place: Place::Axis(number), parameters }, rule, inputs, parent);
    }

    /// The traverse command of a movement by the compensation of the setpoint (SIG-10).
    fn command_of_compensation(&mut self, number: AxisNumber, next: &mut Compensation, by: Position) {
        let wanted = match by.increments() {
            0 if next.still_cycles + 1 >= STILL_CYCLES => 0,
            0 => next.command,
            1.. => 1,
            _ => -1,
        };
        next.still_cycles = if by == Position::ZERO && next.command != 0 { next.still_cycles + 1 } else { 0 };
        if wanted == next.command {
            return;
        }
        let (rule, begins) =
            if wanted == 0 { (Rule::CompensationRests, false) } else { (Rule::CompensationMoves, true) };
        let value = Input::Length(Quantity::SetpointCompensation, number, next.setpoint);
        let parent = if begins { EventId::NONE } else { next.cause };
        next.cause = self.log.note_one(Place::Axis(number), rule, value, parent);
        next.command = wanted;
        if wanted == 0 {
            next.still_cycles = 0;
        }
    }
}

impl Axis {
    /// The compensation values have changed: `anew` without a movement, `by` as a movement of the setpoint.
    fn take_compensation(&mut self, old: &Compensation, anew: Position, by: Position) {
        let Some(active) = self.measuring_system.map(usize::from) else { return };
        self.actual += self.compensation.of(active) - old.of(active);
        if anew != Position::ZERO {
            self.setpoint.shift(anew);
            self.before += anew;
            self.monitor.shift(anew);
            self.signals.shift(anew);
        }
        // The axis model gets the same setpoints.
        self.monitor.shift(Position::ZERO - by);
    }
}
