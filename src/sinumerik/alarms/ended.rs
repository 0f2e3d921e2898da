//! Ends the alarms that clear by themselves, with the event that says why their condition has ended.
//!
//! A stage that tests a condition in every cycle ends its alarm itself ([`State::end_tested`]). The others end here, after monitoring: the
//! conditions of this cycle are known then, and the stages that were not called in it have not raised their alarms.

use crate::image::{axis_from_nck, mode_group_from_nck};
use crate::sinumerik::alarms;
use crate::sinumerik::inputs::{axis_signal, mode_group_signal};
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Place, Quantity, RaisedAlarm};

impl State {
    /// Ends an alarm that clears by itself: its condition does not hold, as these inputs say.
    pub(in crate::sinumerik) fn end_tested(
        &mut self,
        alarm: &RaisedAlarm,
        rule: Rule,
        inputs: [Input; 3],
        parent: EventId,
    ) {
        if self.alarms.iter().any(|(known, _)| known == alarm) {
            let event = self.log.note(alarm.place, rule, inputs, parent);
            self.alarms.end(alarm, event);
        }
    }

    /// After monitoring: ends the alarms that clear by themselves and were not raised in this cycle.
    pub(in crate::sinumerik) fn end_expired(&mut self, parameters: &Parameters) {
        while let Some((alarm, cause)) = self.alarms.expired() {
            let event = match alarm.place {
                Place::Axis(axis) => self.why_expired(&alarm, axis, cause, parameters),
                Place::Nck | Place::ModeGroup(_) | Place::Channel(_) => EventId::NONE,
            };
            self.alarms.end(&alarm, event);
        }
        self.alarms.settle();
    }

    fn why_expired(
        &mut self,
        alarm: &RaisedAlarm,
        number: AxisNumber,
        cause: EventId,
        parameters: &Parameters,
    ) -> EventId {
        let place = Place::Axis(number);
        match alarm.number {
            // The others are raised by stages that jog the axis.
            alarms::ON_SOFTWARE_LIMIT | alarms::HANDWHEEL_ACTIVE | alarms::HANDWHEEL_NOT_POSSIBLE => {
                let of = parameters.mode_group(self.owners.of(number).channel);
                let group = &self.mode_groups[of];
                let inputs = [
                    mode_group_signal(of, mode_group_from_nck::active_mode_jog, group.mode == Mode::Jog),
                    mode_group_signal(of, mode_group_from_nck::active_machine_function_ref, group.is_referencing()),
                    Input::None,
                ];
                // In JOG the unit has changed: the axis no longer leads one.
                let parent = if group.is_jogging() { self.grouping_event(number) } else { group.cause() };
                self.log.note(place, Rule::NoLongerJogging, inputs, parent)
            }
            alarms::GANTRY_WARNING_LIMIT => {
                let warning = self.warning_event(number);
                self.log.now(place, warning, Rule::NotMonitored, [Input::None; 3])
            }
            alarms::GANTRY_WAITING | alarms::GANTRY_SYNCHRONISING => {
                let (step, reset) =
                    (self.grouping_event(number), self.channels[self.owners.of(number).channel].reset_cause);
                let ends = [step, reset].into_iter().find(|&event| self.log.is_of_this_cycle(event));
                // Without either, the message is suppressed from now on.
                let data = parameters.axes[number].gantry.function_mask;
                let inputs = [Input::Datum(37150, Some(number), f64::from(data)), Input::None, Input::None];
                self.log.now(place, ends.unwrap_or(step), Rule::MessageSuppressed, inputs)
            }
            alarms::SWITCH_OVER => self.log.note_plain(place, Rule::SwitchOverReported, cause),
            alarms::WAITING_FOR_DRIVE => {
                let ready = axis_signal(number, axis_from_nck::drive_ready, self.axes[number].drive_ready);
                let fault = self.alarms.cause(alarms::DRIVE_FAULT, place);
                let cause = if fault.is_some() { fault } else { self.axes[number].monitor.drive_cause };
                self.log.now(place, cause, Rule::DriveFault, [ready, Input::None, Input::None])
            }
            alarms::SAG_TOO_FAST => {
                let value = self.axes[number].compensation.setpoint;
                let value = Input::Length(Quantity::SetpointCompensation, number, value);
                self.log.note_one(place, Rule::SagFollows, value, cause)
            }
            // Either there is a handwheel now, or the override has ended.
            alarms::programs::NO_HANDWHEEL => {
                self.axes[number].by_handwheel.map_or(self.single.axes[number].handwheel_cause, |now| now.cause)
            }
            _ => EventId::NONE,
        }
    }

    /// The latest event of the grouping of an axis.
    fn grouping_event(&self, number: AxisNumber) -> EventId {
        let has = |coupling: &crate::sinumerik::parameters::groupings::GantryCoupling| {
            coupling.members().any(|axis| axis == number)
        };
        self.groupings.iter().find(|grouping| has(&grouping.coupling)).map_or(EventId::NONE, |grouping| grouping.cause)
    }

    fn warning_event(&self, number: AxisNumber) -> EventId {
        let mut all = self.groupings.iter().flat_map(|grouping| grouping.monitored());
        all.find(|monitored| monitored.axis == number).map_or(EventId::NONE, |monitored| monitored.causes.warning)
    }
}
