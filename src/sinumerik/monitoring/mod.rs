//! MONITORING: the monitoring functions of the control, and the alarms that follow from states.
//!
//! Called once per cycle after the mechanics moved and the encoders reported, so that a value, its alarm and its bits appear
//! in one cycle. The reactions of an alarm act from the next cycle on. Each file contains one monitoring function:
//!
//! | file | monitors | alarms |
//! |---|---|---|
//! | `gantry/synchronism.rs` | the synchronism difference of a grouping | 10652, 10653 |
//! | `position.rs` | standstill, positioning to exact stop, clamping and contour of an axis | 25040, 25080, 26000, 25050 |
//! | `speed.rs` | actual velocity and speed setpoint | 25030, 25060 |
//! | `spindle.rs` | speed of a spindle | 22100 |
//! | `encoders.rs` | frequency, faults, zero marks and differences of the encoders, and their switch-over | 21610, 21613, 25000 to 25021, 25100 to 25110 |
//! | `drive.rs` | the status of a drive | 25201, 25202 |
//!
//! Only a value strictly greater than a limit raises an alarm (O-11). A condition that must last longer than a time is counted
//! in whole cycles and raises its alarm in the first cycle after that time. No counter continues after its time, so that an
//! axis can rest.

mod drive;
mod encoders;
mod position;
mod speed;
mod spindle;
pub(super) mod state;

use crate::image::nck_from_nck;
use crate::sinumerik::alarms;
use crate::sinumerik::inputs::nck_signal;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet};
use crate::variables::{Input, Parameter, Place, RaisedAlarm};

impl Nck {
    /// The stage "monitoring and alarms".
    pub(super) fn monitor(&mut self) {
        let awake = self.awake();
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        for number in awake.iter() {
            state.monitor_axis(number, &parameters.axes[number], parameters);
        }
        for index in 0..state.groupings.len() {
            let members: AxisSet = state.groupings[index].coupling.members().collect();
            if awake.and(members).is_empty() {
                continue;
            }
            state.monitor_grouping(index, parameters);
        }
        for fault in &parameters.groupings.faults {
            let alarm = RaisedAlarm { number: fault.alarm, place: fault.place, parameters: fault.parameters };
            state.raise_tested(alarm, state.definition_cause, Rule::ConditionHolds, [Input::None; 3]);
        }
        state.raise_faults(parameters);
        let of_nck = |number| RaisedAlarm { number, place: Place::Nck, parameters: [Parameter::None; 4] };
        if let Some(cause) = state.emergency_stop.active_cause() {
            let shown = nck_signal(nck_from_nck::emergency_stop_active, true);
            let inputs = [shown, Input::None, Input::None];
            state.raise_tested(of_nck(alarms::EMERGENCY_STOP), cause, Rule::EmergencyStop, inputs);
        }
        if state.plc_missing {
            state.raise_new(of_nck(alarms::PLC_SIGN_OF_LIFE), Rule::PlcMissing, [Input::None; 3], state.plc_cause);
        }
        state.report_dropped();
        state.end_expired(parameters);
    }
}

impl State {
    fn monitor_axis(&mut self, number: AxisNumber, axis: &AxisParameters, parameters: &Parameters) {
        self.monitor_drive(number, parameters);
        self.monitor_encoders(number, axis);
        if self.axes[number].measuring_system.is_none() {
            let actual = self.axes[number].actual;
            self.axes[number].monitor.restart(actual);
            return;
        }
        self.monitor_speed(number, axis);
        self.monitor_spindle(number, axis);
        self.monitor_position(number, axis);
    }
}
