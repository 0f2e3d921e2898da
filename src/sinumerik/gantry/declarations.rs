//! Reports machine data that do not match a gantry grouping but do not prevent it.
//!
//! Called whenever units are formed: after power on, when machine data become active, when a grouping closes.
//!
//! - MD30450 = 1 on a synchronous axis of a closed grouping is ignored, and the state of the leading axis applies; alarm 4300 reports it
//!   (DEF-11, E-21). It is raised once: at power on, when the datum becomes active, or when the grouping closes. RESET clears it.
//! - Data of interpolation and jerk that differ within a grouping (DYN-03) are reported at power on only. The manuals give no number: the
//!   alarm is `gantry-unequal-data`, with an entry for each datum of each synchronous axis. `machine-data check` reports the same.

use crate::sinumerik::alarms;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::groupings::Unequal;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::AxisSet;
use crate::variables::{Input, Parameter, Place};

impl State {
    /// Reports new findings.
    pub(in crate::sinumerik) fn report_declarations(&mut self, parameters: &Parameters) {
        if !std::mem::replace(&mut self.declared.compared, true) {
            // With equal number and place, the newest alarm comes first in the list.
            for &unequal in parameters.groupings.unequal.iter().rev() {
                self.report_unequal(unequal, parameters);
            }
        }
        let mut concurrent = AxisSet::NONE;
        for grouping in self.groupings.iter().filter(|grouping| grouping.phase != Phase::Open) {
            for axis in grouping.coupling.followers() {
                concurrent.set(axis, parameters.axes[axis].gantry.concurrent);
            }
        }
        let known = std::mem::replace(&mut self.declared.concurrent, concurrent);
        for axis in concurrent.iter().filter(|&axis| !known.contains(axis)) {
            let input = Input::Datum(30450, Some(axis), 1.0);
            let cause = self.log.note_one(Place::Axis(axis), Rule::ConcurrentAxisIgnored, input, self.definition_cause);
            let shown = [Parameter::Number(30450), Parameter::Axis(axis), Parameter::None, Parameter::None];
            self.alarms.raise(alarms::DECLARATION_NOT_ALLOWED, Place::Axis(axis), shown, cause);
        }
    }

    fn report_unequal(&mut self, unequal: Unequal, parameters: &Parameters) {
        let Unequal { grouping, leader, axis, datum, values: [wanted, found] } = unequal;
        let inputs = [Input::Datum(datum, Some(axis), found), Input::Datum(datum, Some(leader), wanted), Input::None];
        let cause = self.log.note(Place::Axis(axis), Rule::UnequalData, inputs, self.definition_cause);
        let shown = [
            Parameter::Channel(parameters.axes[axis].channel),
            Parameter::Axis(axis),
            Parameter::Number(i64::from(datum)),
            Parameter::Number(i64::from(grouping)),
        ];
        self.alarms.raise(alarms::GANTRY_UNEQUAL_DATA, Place::Axis(axis), shown, cause);
    }
}
