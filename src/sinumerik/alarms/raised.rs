//! Raises the alarms of an axis, with the event behind each. The stages call these functions at the place of a condition.

use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place};

impl State {
    /// Raises an alarm of an axis: `%1` channel, `%2` axis.
    pub(in crate::sinumerik) fn raise_axis_alarm(&mut self, alarm: AlarmNumber, number: AxisNumber, event: EventId) {
        let unit = self.units.iter().find(|unit| unit.members().any(|axis| axis == number));
        let channel = unit.map_or(ChannelNumber::FIRST, |unit| unit.channel);
        let parameters = [Parameter::Channel(channel), Parameter::Axis(number), Parameter::None, Parameter::None];
        self.alarms.raise(alarm, Place::Axis(number), parameters, event);
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
        let cause = if self.alarms.is_pending(alarm, place) {
            EventId::NONE
        } else {
            let causes = &self.axes[number].causes;
            // A hardware fault acts whether or not the axis moves.
            let breaks =
                matches!(rule, Rule::DriveFault | Rule::DriveNotReady | Rule::EncoderFault | Rule::EncoderPollution);
            // Only the selection of the PLC leads to a missing encoder.
            let parent = if rule == Rule::EncoderMissing {
                EventId::NONE
            } else if breaks {
                causes.fault
            } else {
                causes.movement()
            };
            self.log.note(place, rule, inputs, parent)
        };
        self.alarms.raise(alarm, place, shown, cause);
    }
}
