//! Raises the alarms of an axis, with the event behind each. The stages call these functions at the place of a condition.

use crate::sinumerik::alarms;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, RaisedAlarm};

impl State {
    /// An alarm of an axis: `%1` channel, `%2` axis.
    pub(in crate::sinumerik) fn axis_alarm(&self, number: AlarmNumber, axis: AxisNumber) -> RaisedAlarm {
        let unit = self.units.iter().find(|unit| unit.members().any(|member| member == axis));
        let channel = unit.map_or(ChannelNumber::FIRST, |unit| unit.channel);
        let parameters = [Parameter::Channel(channel), Parameter::Axis(axis), Parameter::None, Parameter::None];
        RaisedAlarm { number, place: Place::Axis(axis), parameters }
    }

    /// Raises an alarm of an axis: `%1` channel, `%2` axis.
    pub(in crate::sinumerik) fn raise_axis_alarm(&mut self, alarm: AlarmNumber, number: AxisNumber, event: EventId) {
        let RaisedAlarm { number, place, parameters } = self.axis_alarm(alarm, number);
        self.alarms.raise(number, place, parameters, event);
    }

    /// Whether an alarm is not pending, and the list takes it. An alarm that is dropped in each cycle has no event.
    fn is_new(&self, alarm: &RaisedAlarm) -> bool {
        let has_room = || alarm.number == alarms::ALARM_LIST_FULL || self.alarms.has_room();
        !self.alarms.iter().any(|(known, _)| known == alarm) && has_room()
    }

    /// After monitoring: the message that alarms were dropped in this cycle.
    pub(in crate::sinumerik) fn report_dropped(&mut self) {
        let Some(dropped) = self.alarms.take_dropped() else { return };
        let (number, place) = (alarms::ALARM_LIST_FULL, Place::Nck);
        if !self.alarms.is_pending(number, place) {
            let shown = [Parameter::Number(dropped.0.into()), Parameter::None, Parameter::None, Parameter::None];
            let alarm = RaisedAlarm { number, place, parameters: shown };
            // The alarm that took the last place.
            let last = self.alarms.iter().map(|(_, cause)| cause).max();
            self.raise_new(alarm, Rule::AlarmDropped, [Input::None; 3], last.unwrap_or(EventId::NONE));
        }
    }

    /// Raises an alarm whose condition these inputs fulfil. The event behind it is recorded when it is new.
    pub(in crate::sinumerik) fn raise_new(
        &mut self,
        alarm: RaisedAlarm,
        rule: Rule,
        inputs: [Input; 3],
        parent: EventId,
    ) {
        self.raise(alarm, |state| state.log.note(alarm.place, rule, inputs, parent));
    }

    /// The same; the event behind it is `cause` if that is of this cycle.
    pub(in crate::sinumerik) fn raise_tested(
        &mut self,
        alarm: RaisedAlarm,
        cause: EventId,
        rule: Rule,
        inputs: [Input; 3],
    ) {
        self.raise(alarm, |state| state.log.now(alarm.place, cause, rule, inputs));
    }

    /// As [`Self::raise_tested`], with this test as the reason also where the movement has ended in this cycle for another one.
    pub(in crate::sinumerik) fn raise_noted(
        &mut self,
        alarm: RaisedAlarm,
        cause: EventId,
        rule: Rule,
        inputs: [Input; 3],
    ) {
        self.raise(alarm, |state| state.log.note(alarm.place, rule, inputs, cause));
    }

    /// Raises an alarm; the event behind it is recorded when it is new.
    fn raise(&mut self, alarm: RaisedAlarm, event: impl FnOnce(&mut Self) -> EventId) {
        let event = if self.is_new(&alarm) { event(self) } else { EventId::NONE };
        self.alarms.raise(alarm.number, alarm.place, alarm.parameters, event);
    }

    /// Raises an alarm with the event behind it, which is recorded when the alarm is new; `%1` is the axis.
    pub(in crate::sinumerik) fn raise_monitoring(
        &mut self,
        alarm: AlarmNumber,
        number: AxisNumber,
        rule: Rule,
        inputs: [Input; 3],
    ) {
        let place = Place::Axis(number);
        let shown = [Parameter::Axis(number), Parameter::None, Parameter::None, Parameter::None];
        self.raise(RaisedAlarm { number: alarm, place, parameters: shown }, |state| {
            let causes = &state.axes[number].causes;
            // A hardware fault acts whether or not the axis moves.
            let breaks =
                matches!(rule, Rule::DriveFault | Rule::DriveNotReady | Rule::EncoderFault | Rule::EncoderPollution);
            let parent = if rule == Rule::EncoderMissing {
                // Only the selection of the PLC leads to a missing encoder.
                EventId::NONE
            } else if rule == Rule::MeasuringSystem {
                causes.measuring_system
            } else if breaks {
                // A fault without an event is there since power on.
                if causes.fault.is_some() { causes.fault } else { state.as_after_power_on }
            } else {
                causes.movement()
            };
            state.log.note(place, rule, inputs, parent)
        });
    }
}
