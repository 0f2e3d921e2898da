//! Parameter sets of position control and data sets of drives, selected by 9.0 to 9.2 and 21.0 to 21.4 of an axis.
//!
//! Called once per cycle after the selection of measuring systems. Each axis has its own selection, also in a grouping (SIG-05).
//! Writes the active parameter set, which determines 69.0 to 69.2, and the data set accepted by a ready drive (93.0 to 93.4).
//! Servo gain, feedforward, adaptation, exact stop windows and limits of the set act from this cycle on.
//!
//! Choices: the selections 6 and 7 are not parameter sets; they raise 25200 and change nothing. A set with another load gear
//! (MD31050, MD31060) that changes the scale of an encoder is rejected with 26050 in position control. Without position control
//! it is accepted: the displayed value does not change, and the reference is lost. 9.3 disables a change by the NC, and the NC
//! makes none. A data set of a drive has no effect on the model.

use crate::image::{ToNck, axis_to_nck};
use crate::sinumerik::alarms;
use crate::sinumerik::inputs::axis_number;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::mechanics::Misfit;
use crate::sinumerik::resting::Resting;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place};

impl State {
    /// Applies the selection of the PLC for every axis.
    pub(in crate::sinumerik) fn select_parameter_sets(
        &mut self,
        parameters: &Parameters,
        to_nck: &ToNck,
        resting: &Resting,
    ) {
        for number in resting.deciding().iter() {
            let signals = &to_nck.axes[number];
            let (wanted, data_set) = (signals.controller_parameter_set(), signals.drive_data_set_selection());
            let axis = &self.axes[number];
            if wanted != axis.parameter_set {
                self.change_parameter_set(number, wanted, parameters);
            }
            let axis = &mut self.axes[number];
            if axis.drive_ready && axis.drive_data_set != data_set {
                axis.drive_data_set = data_set;
                let input = axis_number(number, axis_to_nck::drive_data_set_selection, data_set);
                let event = self.log.note_one(Place::Axis(number), Rule::DriveDataSet, input, EventId::NONE);
                self.axes[number].causes.drive_data_set = event;
            }
        }
    }

    fn change_parameter_set(&mut self, number: AxisNumber, wanted: u8, parameters: &Parameters) {
        let place = Place::Axis(number);
        let dynamics = &parameters.axes[number].dynamics;
        let Some(set) = dynamics.sets.get(usize::from(wanted)) else {
            let shown = [Parameter::Axis(number), Parameter::None, Parameter::None, Parameter::None];
            self.refuse(
                alarms::PARAMETER_SET_INVALID,
                Rule::ParameterSetRefused,
                requested(number, wanted),
                place,
                shown,
            );
            return;
        };
        let axis = &self.axes[number];
        let shows = |misfit: &Option<Misfit>| misfit.map_or([1.0; 2], |misfit| misfit.encoders);
        let (before, after) = (shows(&axis.active_set(&parameters.axes[number]).misfit), shows(&set.misfit));
        let jumps = [0, 1].map(|encoder| (after[encoder] - before[encoder]).abs() > 0.0);
        if jumps.contains(&true) && axis.enabling.is_powered() {
            let name = |set: u8| Parameter::Number(i64::from(set) + 1);
            let shown = [Parameter::Axis(number), name(axis.parameter_set), name(wanted), Parameter::None];
            self.refuse(
                alarms::PARAMETER_SET_NOT_POSSIBLE,
                Rule::ParameterSetJumps,
                requested(number, wanted),
                place,
                shown,
            );
            return;
        }
        let event = self.log.note(place, Rule::ParameterSet, requested(number, wanted), EventId::NONE);
        let axis = &mut self.axes[number];
        axis.parameter_set = wanted;
        axis.causes.parameter_set = event;
        for encoder in [0, 1] {
            if !jumps[encoder] {
                continue;
            }
            // The displayed value does not change; the reference is lost.
            let value = &mut self.feedback[number].encoders[encoder].value;
            let was = *value;
            *value = Misfit { encoders: [after[encoder] / before[encoder]; 2], command: 1.0 }.shown(encoder, was);
            axis.offset[encoder] += was - *value;
            axis.monitor.encoders[encoder].forget_mark();
            if axis.referenced[encoder] {
                axis.referenced[encoder] = false;
                axis.causes.reference[encoder] = event;
            }
        }
    }

    fn refuse(&mut self, alarm: AlarmNumber, rule: Rule, inputs: [Input; 3], place: Place, shown: [Parameter; 4]) {
        if !self.alarms.iter().any(|(known, _)| known.number == alarm && known.place == place) {
            // An alarm that is dropped in each cycle has no event.
            let has_room = self.alarms.has_room();
            let event = if has_room { self.log.note(place, rule, inputs, EventId::NONE) } else { EventId::NONE };
            self.alarms.raise(alarm, place, shown, event);
        }
    }
}

/// DBX9.0 to 9.2 of an axis for a requested set.
fn requested(number: AxisNumber, set: u8) -> [Input; 3] {
    [axis_number(number, axis_to_nck::controller_parameter_set, set), Input::None, Input::None]
}
