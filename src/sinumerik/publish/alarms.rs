//! The events behind alarms, and the causes of the signals that show whether alarms are pending.

use crate::sinumerik::alarms::Alarm;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::publish::rows::Why;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::{AlarmNumber, EventId, Input, Place, RaisedAlarm};

impl Nck {
    /// The event behind a pending alarm.
    #[must_use]
    pub fn alarm_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        self.state.alarms.cause(number, place)
    }

    /// The event that cleared an alarm in this cycle. Power on clears all of them.
    #[must_use]
    pub fn cleared_cause(&self, number: AlarmNumber, place: Place) -> EventId {
        let event = self.state.alarms.end_of(number, place);
        if event.is_some() { event } else { self.state.as_after_power_on }
    }
}

impl State {
    /// The cause of a signal that shows whether an alarm of these is pending: the alarm, or the event that cleared the last one in this
    /// cycle.
    pub(super) fn why_alarm(&self, meant: impl Fn(Place, &Alarm) -> bool) -> Why {
        let Some((number, cause)) = self.alarms.first_alarm(&meant) else {
            let of_kind =
                |ended: &RaisedAlarm| Alarm::find(ended.number).is_some_and(|alarm| meant(ended.place, alarm));
            let end = self.alarms.last_end(of_kind);
            // An axis may have gone to another channel, with its alarms.
            return Why::Event(if end.is_some() { end } else { self.exchange_of_this_cycle() });
        };
        if self.log.is_of_this_cycle(cause) {
            return Why::Event(cause);
        }
        Why::Tested(Rule::AlarmPending, [Input::Alarm(number.0), Input::None, Input::None], cause)
    }

    /// The event with which an axis got another channel or holder in this cycle.
    pub(super) fn exchange_of_this_cycle(&self) -> EventId {
        let causes = AxisNumber::all().map(|axis| self.owners.of(axis).cause);
        causes.filter(|cause| self.log.is_of_this_cycle(*cause)).max().unwrap_or(EventId::NONE)
    }

    /// The first of these events that is of this cycle: each would have caused the change.
    pub(super) fn of_this_cycle<const N: usize>(&self, events: [EventId; N]) -> Option<Why> {
        events.into_iter().find(|&event| self.log.is_of_this_cycle(event)).map(Why::Event)
    }
}
