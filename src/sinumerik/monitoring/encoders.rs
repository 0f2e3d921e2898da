//! Encoder monitoring: frequency (21610), faults (25000, 25001, 25010, 25011), zero marks (25020, 25021), the difference of two
//! encoders (25105), and reasons that prevent a switch-over (25100, 25110).
//!
//! Frequency: above MD36300 the encoder value is not used: 60.2 or 60.3 is 1 until the frequency is below MD36302, and its
//! reference is lost. The alarm is raised for the active encoder only. The axis brakes in position control.
//!
//! Faults: position control does not use an encoder without a signal; the speed command of the drive is 0. The reference of the
//! encoder is lost, also that of a passive one. MD36310 = 100 switches this monitoring off; above 100 the alarms are those of
//! pollution.
//!
//! Zero marks: the distance of two zero marks must be a multiple of MD34300; lost counts are detected at the next zero mark.
//! MD36310 (minus 100 if above 100) is the number of wrong zero marks that raises the alarm; counting restarts with the alarm. The distance
//! of two distance-coded marks must be one that the code has. The marks of an absolute encoder (MD34200 = 0) are not read.
//!
//! Switch-over: two referenced encoders must not differ by more than MD36500. An encoder that is not referenced has no position
//! to compare. Selecting a second measuring system that does not exist according to MD30200 has no effect.

use crate::image::axis_from_nck;
use crate::sinumerik::alarms;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::axis::{AxisParameters, Kind};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Parameter, Place, Quantity};

impl State {
    pub(in crate::sinumerik) fn monitor_encoders(&mut self, number: AxisNumber, parameters: &AxisParameters) {
        for encoder in 0..usize::from(parameters.encoders).min(2) {
            self.monitor_frequency(number, encoder, parameters);
            self.monitor_fault(number, encoder, parameters);
            self.monitor_zero_marks(number, encoder, parameters);
            self.keep_position(number, encoder, parameters);
        }
        if let Some(limit) = parameters.monitoring.encoder_difference
            && self.axes[number].referenced == [true; 2]
        {
            let [first, second] = self.both_actual_values(number);
            let difference = (first - second).abs();
            if difference > limit {
                let inputs = exceeds(number, difference, 36510, limit);
                self.raise_monitoring(alarms::ENCODERS_DIFFER, number, Rule::EncodersDiffer, inputs);
            }
        }
    }

    fn monitor_frequency(&mut self, number: AxisNumber, encoder: usize, parameters: &AxisParameters) {
        let (limit, low) =
            (parameters.monitoring.frequency_limit[encoder], parameters.monitoring.frequency_low[encoder]);
        let speed = self.feedback[number].velocity.abs();
        let before = self.axes[number].monitor.encoders[encoder].frequency_exceeded;
        if before == (speed > limit) && !before {
            return;
        }
        let exceeded = if before { speed >= low } else { speed > limit };
        if exceeded != before {
            let [frequency, percent] = parameters.monitoring.frequency_data[encoder];
            let (rule, datum, bound) = if exceeded {
                (Rule::FrequencyExceeded, 36300, frequency)
            } else {
                (Rule::FrequencyNormal, 36302, percent)
            };
            let measured = self.axes[number].measured_velocity(number);
            let inputs = [measured, Input::Datum(datum, Some(number), bound), Input::None];
            let parent = self.axes[number].causes.movement();
            let event = self.log.note(Place::Axis(number), rule, inputs, parent);
            let monitor = &mut self.axes[number].monitor.encoders[encoder];
            (monitor.frequency_exceeded, monitor.frequency_cause) = (exceeded, event);
        }
        if exceeded {
            let cause = self.axes[number].monitor.encoders[encoder].frequency_cause;
            self.lose_reference(number, encoder, cause);
            if self.is_active(number, encoder) {
                let channel = Parameter::Channel(parameters.channel);
                let shown = [channel, Parameter::Axis(number), Parameter::Number(encoder as i64 + 1), Parameter::None];
                self.alarms.raise(alarms::ENCODER_FREQUENCY, Place::Axis(number), shown, cause);
            }
        }
    }

    fn monitor_fault(&mut self, number: AxisNumber, encoder: usize, parameters: &AxisParameters) {
        let fault = self.feedback[number].encoder_faults[encoder];
        self.axes[number].monitor.encoders[encoder].fault = fault;
        let watched = &parameters.monitoring.zero_marks[encoder];
        if !fault || watched.off {
            return;
        }
        let (alarm, rule) = match (self.is_active(number, encoder), watched.pollution) {
            (true, false) => (alarms::ACTIVE_ENCODER_FAULT, Rule::EncoderFault),
            (false, false) => (alarms::PASSIVE_ENCODER_FAULT, Rule::EncoderFault),
            (true, true) => (alarms::ACTIVE_ENCODER_POLLUTION, Rule::EncoderPollution),
            (false, true) => (alarms::PASSIVE_ENCODER_POLLUTION, Rule::EncoderPollution),
        };
        let activated = [
            axis_from_nck::position_measuring_system_1_activated,
            axis_from_nck::position_measuring_system_2_activated,
        ];
        let selected = axis_signal(number, activated[encoder], self.is_active(number, encoder));
        self.raise_monitoring(alarm, number, rule, [selected, Input::None, Input::None]);
        let cause = self.alarms.cause(alarm, Place::Axis(number));
        self.lose_reference(number, encoder, cause);
    }

    fn monitor_zero_marks(&mut self, number: AxisNumber, encoder: usize, parameters: &AxisParameters) {
        let Some(mark) = self.feedback[number].encoders[encoder].zero_mark else { return };
        let watched = &parameters.monitoring.zero_marks[encoder];
        let monitor = &mut self.axes[number].monitor.encoders[encoder];
        let before = monitor.mark.replace(mark);
        let (Some(tolerated), Some(before)) = (watched.errors, before) else { return };
        let reference = &parameters.reference;
        let slipped = match reference.kind[encoder] {
            Kind::Absolute => return,
            Kind::DistanceCoded => reference.scale[encoder].misses((mark - before).abs()),
            Kind::ZeroMark | Kind::None => {
                let spacing = watched.spacing.increments();
                let remainder = (mark - before).increments().rem_euclid(spacing);
                Position::new(remainder.min(spacing - remainder))
            }
        };
        // Two zero marks are each latched with an accuracy of half a count.
        let one_count = Position::new(2 * self.feedback[number].half_count[encoder].increments() + 1);
        if slipped <= one_count {
            return;
        }
        monitor.errors += 1;
        if monitor.errors < tolerated {
            return;
        }
        monitor.errors = 0;
        let measured = Input::Length(Quantity::ZeroMarkDeviation, number, slipped);
        let inputs = [measured, Input::Datum(36310, Some(number), f64::from(tolerated)), Input::None];
        if self.is_active(number, encoder) {
            self.raise_monitoring(alarms::ACTIVE_ZERO_MARK, number, Rule::ZeroMarkMonitoring, inputs);
            let cause = self.alarms.cause(alarms::ACTIVE_ZERO_MARK, Place::Axis(number));
            self.lose_reference(number, encoder, cause);
        } else {
            self.raise_monitoring(alarms::PASSIVE_ZERO_MARK, number, Rule::ZeroMarkMonitoring, inputs);
        }
    }

    /// The reference of a measuring system is lost. Synchronism is lost in the same cycle.
    fn lose_reference(&mut self, number: AxisNumber, encoder: usize, cause: EventId) {
        let axis = &mut self.axes[number];
        if std::mem::take(&mut axis.restored[encoder]) {
            axis.causes.restored[encoder] = cause;
            self.log.news.set(number, true);
        }
        if std::mem::take(&mut axis.referenced[encoder]) {
            axis.causes.reference[encoder] = cause;
            self.log.news.set(number, true);
        }
    }

    fn is_active(&self, number: AxisNumber, encoder: usize) -> bool {
        self.axes[number].measuring_system.map(usize::from) == Some(encoder)
    }

    fn both_actual_values(&self, number: AxisNumber) -> [Position; 2] {
        let axis = &self.axes[number];
        [0, 1].map(|encoder| self.feedback[number].encoders[encoder].value + axis.to_actual(encoder))
    }

    /// Whether the switch-over to another measuring system is impossible; raises the alarm.
    pub(in crate::sinumerik) fn switch_over_fails(
        &mut self,
        number: AxisNumber,
        wanted: Option<u8>,
        parameters: &AxisParameters,
    ) -> bool {
        let (Some(_), Some(target)) = (self.axes[number].measuring_system, wanted) else { return false };
        let tolerance = parameters.monitoring.switch_over_tolerance;
        let [first, second] = self.both_actual_values(number);
        let jump = (first - second).abs();
        let too_far = self.axes[number].referenced == [true; 2] && jump > tolerance;
        let dead = self.feedback[number].encoder_faults[usize::from(target)];
        if too_far || dead {
            let inputs = if too_far { exceeds(number, jump, 36500, tolerance) } else { [Input::None; 3] };
            self.raise_monitoring(alarms::SWITCH_OVER_IMPOSSIBLE, number, Rule::SwitchOverImpossible, inputs);
        }
        too_far || dead
    }

    /// The switch-over was done.
    pub(in crate::sinumerik) fn report_switch_over(&mut self, number: AxisNumber) {
        self.raise_monitoring(alarms::SWITCH_OVER, number, Rule::MeasuringSystem, [Input::None; 3]);
    }

    /// Measuring system 2 is selected and does not exist.
    pub(in crate::sinumerik) fn report_missing_encoder(&mut self, number: AxisNumber, parameters: &AxisParameters) {
        let count = Input::Datum(30200, Some(number), f64::from(parameters.encoders));
        let inputs = [count, Input::None, Input::None];
        self.raise_monitoring(alarms::ENCODER_NOT_AVAILABLE, number, Rule::EncoderMissing, inputs);
    }
}

fn exceeds(number: AxisNumber, measured: Position, datum: u32, limit: Position) -> [Input; 3] {
    [Input::Length(Quantity::Deviation, number, measured), Input::Datum(datum, Some(number), limit.user()), Input::None]
}
