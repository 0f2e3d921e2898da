//! The alarms that are pending, and when each of them came.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use super::Place;
use crate::units::{AxisNumber, ChannelNumber, Time};

/// How many alarms can be pending at once.
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
}

/// Number of an alarm in the manual's list; from [`AlarmNumber::OWN`] on, one that has only a name of our own (O-18).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct AlarmNumber(pub u32);

impl AlarmNumber {
    /// The first number that stands for a name of our own and is never shown.
    pub const OWN: u32 = 1_000_000;
}

/// An alarm or message that is pending.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RaisedAlarm {
    /// Which one.
    pub number: AlarmNumber,
    /// Whose.
    pub place: Place,
    /// `%1` to `%4`.
    pub parameters: [Parameter; 4],
}

/// When an alarm came.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Arrival {
    /// The how many-th alarm since power on it is, from 1.
    pub ordinal: u32,
    /// Simulated time of the cycle that raised it.
    pub time: Time,
}

/// The alarms that are pending, in order of number and place; bounded, because a list on a control is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Alarms {
    raised: ArrayVec<RaisedAlarm, ALARMS>,
    /// Of each of them, at the same index.
    arrivals: ArrayVec<Arrival, ALARMS>,
    /// How many there were since power on.
    ordinals: u32,
    /// How many of those have their time.
    dated: u32,
}

impl Alarms {
    /// How many alarms can be pending at once.
    pub const CAPACITY: usize = ALARMS;

    /// Takes over what is pending now, in order of number and place. Who stays keeps its ordinal number and its time.
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

    /// Gives the time to those that are new since it was last called.
    pub fn date(&mut self, now: Time) {
        if self.dated != self.ordinals {
            for arrival in self.arrivals.iter_mut().filter(|arrival| arrival.ordinal > self.dated) {
                arrival.time = now;
            }
            self.dated = self.ordinals;
        }
    }

    /// All that are pending.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &RaisedAlarm> {
        self.raised.iter()
    }

    /// All that are pending with their arrivals, in order of number and place.
    pub fn arrivals(&self) -> impl ExactSizeIterator<Item = (&RaisedAlarm, Arrival)> {
        self.raised.iter().zip(self.arrivals.iter().copied())
    }

    /// How many are pending.
    #[must_use]
    pub fn count(&self) -> usize {
        self.raised.len()
    }

    /// The pending alarm of this number, at this place if one is named.
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
    fn who_stays_keeps_its_ordinal_number_and_its_time() {
        let mut alarms = Alarms::default();
        alarms.publish([alarm(20000)].into_iter());
        alarms.date(Time::from_millis(2));
        alarms.publish([alarm(3000), alarm(20000)].into_iter());
        alarms.date(Time::from_millis(4));
        alarms.date(Time::from_millis(6));
        let arrivals: Vec<_> =
            alarms.arrivals().map(|(alarm, came)| (alarm.number.0, came.ordinal, came.time)).collect();
        assert_eq!(arrivals, [(3000, 2, Time::from_millis(4)), (20000, 1, Time::from_millis(2))]);
        // Who goes and comes again is another one.
        alarms.publish([alarm(3000)].into_iter());
        alarms.publish([alarm(3000), alarm(20000)].into_iter());
        alarms.date(Time::from_millis(8));
        let last = alarms.arrivals().last().map(|(_, came)| came);
        assert_eq!(last, Some(Arrival { ordinal: 3, time: Time::from_millis(8) }));
    }
}
