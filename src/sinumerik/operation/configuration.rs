//! Alarms of power on about channels, cycles and units: 4000 and 4001 keep the NC from ready (`parameters/configuration.rs`); a changed
//! scaling datum (4070) and a corrected interpolation cycle (4110) are only reported.
//!
//! Choices: 4070 is raised for the data whose change gives lengths another meaning, MD10240, MD10250 and MD30300, and for any number of
//! them once. After 4110 the stored MD10070 keeps its value, so each power on raises it again. 4113 is not raised: no source says which
//! values of MD10050 a control changes.

use crate::sinumerik::activation::axis_of;
use crate::sinumerik::alarms;
use crate::sinumerik::machine_data::MachineData;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::configuration::ChannelFault;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::variables::{EventId, Input, Parameter, Place, RaisedAlarm};

/// The scaling machine data.
const SCALING: [u32; 3] = [10240, 10250, 30300];

impl Nck {
    /// 4070, after power on made these data active.
    pub(in crate::sinumerik) fn report_scaling(&mut self, before: &MachineData, power_on: EventId) {
        let changed = self.active().differences(before);
        let Some(target) = changed.iter().find(|target| SCALING.contains(&target.datum().number)) else { return };
        let value = self.active().get(target).and_then(|value| value.number()).unwrap_or(0.0);
        let input = Input::Datum(target.datum().number, axis_of(target), value);
        let cause = self.state.log.note_one(Place::Nck, Rule::ScalingChanged, input, power_on);
        self.state.alarms.raise(alarms::SCALING_CHANGED, Place::Nck, [Parameter::None; 4], cause);
    }
}

impl State {
    /// 4000 and 4001, in every cycle: only power off clears them.
    pub(in crate::sinumerik) fn raise_faults(&mut self, parameters: &Parameters) {
        for &ChannelFault { fault, rule, tested } in &parameters.faults {
            let alarm = RaisedAlarm { number: fault.alarm, place: fault.place, parameters: fault.parameters };
            self.raise_new(alarm, rule, [tested, Input::None, Input::None], self.power_on_cause);
        }
    }

    /// 4110, in the first cycle after power on.
    pub(in crate::sinumerik) fn report_cycle(&mut self, parameters: &Parameters) {
        let Some([interpolation, position]) = parameters.corrected_ratios else { return };
        let inputs = [Input::Datum(10070, None, interpolation), Input::Datum(10060, None, position), Input::None];
        let shown = [Parameter::Milliseconds(parameters.cycle), Parameter::None, Parameter::None, Parameter::None];
        let alarm = RaisedAlarm { number: alarms::CYCLE_CHANGED, place: Place::Nck, parameters: shown };
        self.raise_new(alarm, Rule::CycleCorrected, inputs, self.power_on_cause);
    }
}
