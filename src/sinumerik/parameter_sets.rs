//! Parameter sets of position control, and data sets of drives: what 9.0 to 9.2 and 21.0 to 21.4 of an axis select.
//!
//! Called once per cycle after measuring systems are selected. Each axis has its own selection, also in a grouping (SIG-05).
//! Writes the active parameter set, from which 69.0 to 69.2 follow, and the data set that a ready drive has taken
//! (93.0 to 93.4). Servo gain, feed-forward, adaptation, exact stop windows and limits of the set act from this cycle on.
//!
//! Choices: the selections 6 and 7, which are no parameter set, raise 25200 and change nothing. 9.3 forbids a change
//! by the NC, and there is none. A data set of a drive has no effect on the model.

use super::State;
use super::alarms;
use super::dynamics::PARAMETER_SETS;
use super::resting::Resting;
use super::rules::Rule;
use crate::image::ToNck;
use crate::units::AxisNumber;
use crate::variables::{EventId, Parameter, Place};

impl State {
    /// What the PLC selects for every axis.
    pub(super) fn select_parameter_sets(&mut self, to_nck: &ToNck, resting: &Resting) {
        for number in resting.awake().iter() {
            let signals = &to_nck.axes[number];
            let (wanted, data_set) = (signals.controller_parameter_set(), signals.drive_data_set_selection());
            let axis = &self.axes[number];
            if wanted != axis.parameter_set {
                self.change_parameter_set(number, wanted);
            }
            let axis = &mut self.axes[number];
            if axis.drive_ready && axis.drive_data_set != data_set {
                axis.drive_data_set = data_set;
                let event = self.log.note_plain(Place::Axis(number), Rule::DriveDataSet, EventId::NONE);
                self.axes[number].causes.drive_data_set = event;
            }
        }
    }

    fn change_parameter_set(&mut self, number: AxisNumber, wanted: u8) {
        let place = Place::Axis(number);
        if usize::from(wanted) >= PARAMETER_SETS {
            let (alarm, pending) = (alarms::PARAMETER_SET_INVALID, &self.alarms);
            if !pending.iter().any(|(known, _)| known.number == alarm && known.place == place) {
                let event = self.log.note_plain(place, Rule::ParameterSetRefused, EventId::NONE);
                let shown = [Parameter::Axis(number), Parameter::None, Parameter::None, Parameter::None];
                self.alarms.raise(alarm, place, shown, event);
            }
            return;
        }
        let event = self.log.note_plain(place, Rule::ParameterSet, EventId::NONE);
        let axis = &mut self.axes[number];
        axis.parameter_set = wanted;
        axis.causes.parameter_set = event;
    }
}
