//! Messages that are pending, and how many there have been since the scenario began.

use serde::{Deserialize, Serialize};

use super::messages;
use crate::units::AxisNumber;
use crate::variables::{AlarmNumber, EventId, LongTexts, MessageCount, Parameter, Place, RaisedAlarm, short_text};

/// How many messages can be pending; more are counted and not shown.
const PENDING: usize = 64;

/// A parameter of a message before it is raised.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Detail {
    None,
    Axis(AxisNumber),
    Number(i64),
    Text(String),
}

impl Detail {
    /// The axis that it names.
    pub(super) const fn axis(&self) -> Option<AxisNumber> {
        match self {
            Self::Axis(axis) => Some(*axis),
            Self::None | Self::Number(_) | Self::Text(_) => None,
        }
    }
}

/// The messages.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Pending {
    alarms: Vec<(RaisedAlarm, EventId)>,
    /// By number and place, in this order.
    pub counts: Vec<MessageCount>,
    /// The event that ended the last ones.
    pub cleared: EventId,
    /// Those that were raised in this cycle although they were pending, as a control reports each of them.
    again: Vec<RaisedAlarm>,
    /// Texts that are too long for a parameter.
    texts: LongTexts,
}

impl Pending {
    /// A parameter with its text, however long.
    pub(super) fn parameter(&mut self, detail: Detail) -> Parameter {
        match detail {
            Detail::None => Parameter::None,
            Detail::Axis(axis) => Parameter::Axis(axis),
            Detail::Number(number) => Parameter::Number(number),
            Detail::Text(text) => {
                let short = short_text(&text);
                if short.len() == text.len() { Parameter::Text(short) } else { self.texts.keep(&text) }
            }
        }
    }

    /// A text that is kept.
    pub(super) fn text(&self, index: u32) -> &str {
        self.texts.get(index)
    }

    /// Raises a message. `other` is the second axis that it names.
    pub(super) fn raise(&mut self, alarm: RaisedAlarm, other: Option<AxisNumber>, cause: EventId) {
        self.raise_as(alarm, other, messages::is_warning(alarm.number), cause);
    }

    /// Raises a message that is a warning, or an error.
    pub(super) fn raise_as(&mut self, alarm: RaisedAlarm, other: Option<AxisNumber>, is_warning: bool, cause: EventId) {
        let key = (alarm.number, alarm.place, other, is_warning);
        let found =
            self.counts.iter_mut().find(|count| (count.number, count.place, count.other, count.is_warning) == key);
        match found {
            Some(count) => count.count += 1,
            None => {
                let (number, place, other, is_warning) = key;
                self.counts.push(MessageCount { number, place, other, is_warning, count: 1 });
            }
        }
        if let Some((_, last)) = self.alarms.iter_mut().find(|(pending, _)| *pending == alarm) {
            *last = cause;
            if self.again.len() < PENDING {
                self.again.push(alarm);
            }
        } else if self.alarms.len() < PENDING {
            self.alarms.push((alarm, cause));
            self.alarms.sort_by_key(|(alarm, _)| (alarm.number, place_order(alarm.place)));
        }
    }

    /// A new cycle begins.
    pub(super) fn begin_cycle(&mut self) {
        self.again.clear();
    }

    /// Those that were raised in this cycle although they were pending.
    pub(super) fn raised_again(&self) -> &[RaisedAlarm] {
        &self.again
    }

    /// A reset takes all but those that only a restart takes.
    pub(super) fn reset(&mut self, cause: EventId, stays: impl Fn(&RaisedAlarm) -> bool) {
        self.alarms.retain(|(alarm, _)| stays(alarm));
        self.cleared = cause;
    }

    /// A restart takes all.
    pub(super) fn restart(&mut self, cause: EventId) {
        self.alarms.clear();
        self.cleared = cause;
    }

    /// The pending messages, ascending by number.
    pub(super) fn iter(&self) -> impl Iterator<Item = RaisedAlarm> + '_ {
        self.alarms.iter().map(|(alarm, _)| *alarm)
    }

    /// Whether a message of an axis is pending.
    pub(super) fn has(&self, number: AlarmNumber, axis: AxisNumber) -> bool {
        self.alarms.iter().any(|(alarm, _)| (alarm.number, alarm.place) == (number, Place::Axis(axis)))
    }

    /// The event behind a pending message.
    pub(super) fn cause(&self, number: AlarmNumber, place: Place) -> EventId {
        // Of several with other parameters, the one that came last.
        let same = self.alarms.iter().filter(|(alarm, _)| (alarm.number, alarm.place) == (number, place));
        same.map(|(_, cause)| *cause).max().unwrap_or(EventId::NONE)
    }
}

fn place_order(place: Place) -> (u8, u8) {
    match place {
        Place::Nck => (0, 0),
        Place::ModeGroup(number) => (1, number.number()),
        Place::Channel(number) => (2, number.number()),
        Place::Axis(number) => (3, number.number()),
    }
}

/// A message of an axis.
pub(super) const fn of_axis(number: AlarmNumber, axis: AxisNumber) -> RaisedAlarm {
    let parameters = [Parameter::Axis(axis), Parameter::None, Parameter::None, Parameter::None];
    RaisedAlarm { number, place: Place::Axis(axis), parameters }
}
