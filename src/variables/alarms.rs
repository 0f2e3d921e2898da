//! The pending alarms, and the time at which each of them was raised.

use arrayvec::{ArrayString, ArrayVec};
use serde::{Deserialize, Serialize};

use super::Place;
use crate::units::{AxisNumber, ChannelNumber, Time};

/// The maximum number of pending alarms.
const ALARMS: usize = 64;

/// One parameter of an alarm, `%1` to `%4` in its text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Parameter {
    /// Not used by this alarm.
    #[default]
    None,
    /// A channel, shown by its name.
    Channel(ChannelNumber),
    /// A machine axis, shown by its name.
    Axis(AxisNumber),
    /// A number: a reason, a code, a grouping.
    Number(i64),
    /// A direction, shown as `+` or `-`.
    Direction(i8),
    /// A duration, shown in milliseconds.
    Milliseconds(Time),
    /// A name or a text of a program.
    Text(ShortText),
    /// A longer text that the control keeps, by its index ([`Describe::message_text`](super::Describe::message_text)).
    OfControl(u32),
}

/// A text of at most 24 bytes.
pub type ShortText = ArrayString<24>;

/// The beginning of a text, as long as it fits.
#[must_use]
pub fn short_text(text: &str) -> ShortText {
    let mut short = ShortText::new();
    for letter in text.chars() {
        if short.try_push(letter).is_err() {
            break;
        }
    }
    short
}

/// How many different long texts are kept; of further ones the beginning is shown.
const LONG_TEXTS: usize = 4096;

/// The longer texts of a control's alarms, for [`Parameter::OfControl`]. They stay: the trace reads them later.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LongTexts(Vec<String>);

impl LongTexts {
    /// A parameter with this text, which is kept.
    pub fn keep(&mut self, text: &str) -> Parameter {
        let known = self.0.iter().position(|other| other == text);
        let index = known.or_else(|| {
            (self.0.len() < LONG_TEXTS).then(|| {
                self.0.push(text.to_owned());
                self.0.len() - 1
            })
        });
        let index = index.and_then(|index| u32::try_from(index).ok());
        index.map_or_else(|| Parameter::Text(short_text(text)), Parameter::OfControl)
    }

    /// The text of an index; empty if there is none.
    #[must_use]
    pub fn get(&self, index: u32) -> &str {
        let index = usize::try_from(index).ok();
        index.and_then(|index| self.0.get(index)).map_or("", String::as_str)
    }
}

/// Number of an alarm in the list of the manual. Numbers from [`AlarmNumber::OWN`] on stand for alarms that have only a name (O-18).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct AlarmNumber(pub u32);

impl AlarmNumber {
    /// The first number that stands for a name; it is never shown.
    pub const OWN: u32 = 1_000_000;
}

/// An alarm or message that is pending.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RaisedAlarm {
    /// The number of the alarm.
    pub number: AlarmNumber,
    /// The place that it belongs to.
    pub place: Place,
    /// The parameters `%1` to `%4`.
    pub parameters: [Parameter; 4],
}

/// How often a message has been raised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MessageCount {
    /// The number of the message.
    pub number: AlarmNumber,
    /// The place that it belongs to.
    pub place: Place,
    /// The second axis that it names.
    pub other: Option<AxisNumber>,
    /// It is a warning: it stops nothing.
    pub is_warning: bool,
    /// How often.
    pub count: u32,
}

/// When an alarm was raised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Arrival {
    /// Sequence number since power on, from 1.
    pub ordinal: u32,
    /// Simulated time of the cycle that raised the alarm.
    pub time: Time,
}

/// The pending alarms, in order of number and place. The list is bounded, as on a real control.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Alarms {
    raised: ArrayVec<RaisedAlarm, ALARMS>,
    /// The arrival of each alarm, at the same index.
    arrivals: ArrayVec<Arrival, ALARMS>,
    /// The number of alarms since power on.
    ordinals: u32,
    /// The number of alarms that have a time.
    dated: u32,
}

impl Alarms {
    /// The maximum number of pending alarms.
    pub const CAPACITY: usize = ALARMS;

    /// Takes over the alarms that are pending now, in order of number and place. An alarm that remains pending keeps its sequence number
    /// and its time.
    pub fn publish(&mut self, pending: impl Iterator<Item = RaisedAlarm>) {
        let (before, arrivals) = (self.raised.clone(), self.arrivals.clone());
        self.raised.clear();
        self.arrivals.clear();
        for alarm in pending.take(Self::CAPACITY) {
            let known = before.iter().position(|other| *other == alarm);
            let arrival = known.and_then(|index| arrivals.get(index).copied()).unwrap_or_else(|| {
                self.ordinals = self.ordinals.wrapping_add(1);
                Arrival { ordinal: self.ordinals, time: Time::ZERO }
            });
            self.raised.push(alarm);
            self.arrivals.push(arrival);
        }
    }

    /// Sets the time of the alarms that are new since the last call.
    pub fn date(&mut self, now: Time) {
        if self.dated != self.ordinals {
            for arrival in self.arrivals.iter_mut().filter(|arrival| arrival.ordinal > self.dated) {
                arrival.time = now;
            }
            self.dated = self.ordinals;
        }
    }

    /// All pending alarms.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &RaisedAlarm> {
        self.raised.iter()
    }

    /// All pending alarms with their arrivals, in order of number and place.
    pub fn arrivals(&self) -> impl ExactSizeIterator<Item = (&RaisedAlarm, Arrival)> {
        self.raised.iter().zip(self.arrivals.iter().copied())
    }

    /// The number of pending alarms.
    #[must_use]
    pub fn count(&self) -> usize {
        self.raised.len()
    }

    /// The pending alarm with this number, at this place if a place is given.
    #[must_use]
    pub fn find(&self, number: AlarmNumber, place: Option<Place>) -> Option<&RaisedAlarm> {
        self.raised.iter().find(|alarm| alarm.number == number && place.is_none_or(|place| alarm.place == place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alarm(number: u32) -> RaisedAlarm {
        RaisedAlarm { number: AlarmNumber(number), place: Place::Nck, parameters: [Parameter::None; 4] }
    }

    #[test]
    fn an_alarm_that_remains_pending_keeps_its_sequence_number_and_its_time() {
        let mut alarms = Alarms::default();
        alarms.publish([alarm(20000)].into_iter());
        alarms.date(Time::from_millis(2));
        alarms.publish([alarm(3000), alarm(20000)].into_iter());
        alarms.date(Time::from_millis(4));
        alarms.date(Time::from_millis(6));
        let arrivals: Vec<_> =
            alarms.arrivals().map(|(alarm, came)| (alarm.number.0, came.ordinal, came.time)).collect();
        assert_eq!(arrivals, [(3000, 2, Time::from_millis(4)), (20000, 1, Time::from_millis(2))]);
        // An alarm that is cleared and raised again is a new alarm.
        alarms.publish([alarm(3000)].into_iter());
        alarms.publish([alarm(3000), alarm(20000)].into_iter());
        alarms.date(Time::from_millis(8));
        let last = alarms.arrivals().last().map(|(_, came)| came);
        assert_eq!(last, Some(Arrival { ordinal: 3, time: Time::from_millis(8) }));
    }
}
