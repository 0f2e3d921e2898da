//! The events behind raised and cleared alarms, for the record.

use crate::sinumerik::alarms::{self, Alarm, Cancel};
use crate::sinumerik::gantry::state::Grouping;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::{AlarmNumber, EventId, Place};

impl Nck {
    /// The event behind a pending alarm.
    #[must_use]
    pub fn alarm_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        let pending = &self.state.alarms;
        pending
            .iter()
            .find(|(alarm, _)| alarm.number == number && alarm.place == place)
            .map_or(EventId::NONE, |(_, cause)| cause)
    }

    /// The event that cleared an alarm: for an alarm that clears by itself, the latest event of its place; otherwise RESET, a key
    /// or power on.
    #[must_use]
    pub fn cleared_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        let state = &*self.state;
        let cancel = Alarm::find(number).map(|alarm| alarm.cancel);
        let cause = match (number, place) {
            (alarms::EMERGENCY_STOP, _) => state.emergency_stop.cause,
            (alarms::GANTRY_WARNING_LIMIT, Place::Axis(axis)) => state.warning_cause(axis),
            (alarms::GANTRY_WAITING | alarms::GANTRY_SYNCHRONISING, Place::Axis(axis)) => {
                let reset = state.channels[self.parameters.axes[axis].channel].reset_cause;
                state.grouping_of(axis).map_or(EventId::NONE, |grouping| grouping.cause.max(reset))
            }
            (alarms::WAITING_FOR_DRIVE, Place::Axis(_)) => state.run_up.cause,
            (_, Place::Axis(axis)) if cancel == Some(Cancel::ByItself) => state.axes[axis].causes.motion,
            (_, Place::Axis(axis)) => state.channels[self.parameters.axes[axis].channel].cancel_cause,
            (_, Place::Channel(channel)) => state.channels[channel].cancel_cause,
            (_, Place::Nck | Place::ModeGroup(_)) => state.cancel_event(),
        };
        if cause.is_some() { cause } else { state.as_after_power_on }
    }
}

impl State {
    fn grouping_of(&self, axis: AxisNumber) -> Option<&Grouping> {
        self.groupings.iter().find(|grouping| grouping.coupling.leader() == axis)
    }

    fn warning_cause(&self, axis: AxisNumber) -> EventId {
        let mut all = self.groupings.iter().flat_map(Grouping::monitored);
        all.find(|monitored| monitored.axis == axis).map_or(EventId::NONE, |monitored| monitored.causes.warning)
    }
}
