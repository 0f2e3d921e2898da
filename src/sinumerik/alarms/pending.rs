//! The list of pending alarms, each with the event behind it, and the alarms that ended in the present cycle.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::sinumerik::alarms::{ALARM_LIST_FULL, Alarm, Cancel, Reaction};
use crate::units::AxisSet;
use crate::variables::{AlarmNumber, Alarms, EventId, Parameter, Place, RaisedAlarm};

/// A pending alarm and the event behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    alarm: RaisedAlarm,
    cause: EventId,
    /// Its cause raised it in this cycle. An alarm that clears by itself is removed in the first cycle in which nothing raises it.
    fresh: bool,
}

/// The number of alarms that the list takes. One more place is that of the message that it is full.
const ROOM: usize = Alarms::CAPACITY - 1;

/// The pending alarms. The list is bounded, as on a control; further alarms are dropped, and a message says so.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Pending {
    entries: ArrayVec<Entry, { Alarms::CAPACITY }>,
    /// The alarms that ended in this cycle, each with the event that ended it.
    ended: ArrayVec<(RaisedAlarm, EventId), { Alarms::CAPACITY }>,
    changed: bool,
    /// The first alarm that was dropped in this cycle.
    dropped: Option<AlarmNumber>,
    /// Counts the changes of the list.
    version: u32,
}

impl Pending {
    /// A cycle begins.
    pub(in crate::sinumerik) fn begin(&mut self) {
        self.ended.clear();
    }

    /// Raises an alarm, or keeps it raised. If it is new, `cause` is an event of this cycle.
    pub(in crate::sinumerik) fn raise(
        &mut self,
        number: AlarmNumber,
        place: Place,
        parameters: [Parameter; 4],
        cause: EventId,
    ) {
        let alarm = RaisedAlarm { number, place, parameters };
        if let Some(entry) = self.entries.iter_mut().find(|entry| entry.alarm == alarm) {
            entry.fresh = true;
            return;
        }
        if number != ALARM_LIST_FULL && !self.has_room() {
            self.dropped.get_or_insert(number);
            return;
        }
        let index = self.entries.partition_point(|entry| (entry.alarm.number, entry.alarm.place) < (number, place));
        let added = self.entries.try_insert(index, Entry { alarm, cause, fresh: true }).is_ok();
        self.note_changed(added);
    }

    /// Whether the list takes another alarm.
    #[must_use]
    pub(in crate::sinumerik) fn has_room(&self) -> bool {
        self.entries.iter().filter(|entry| entry.alarm.number != ALARM_LIST_FULL).count() < ROOM
    }

    /// The first alarm that was dropped since the last call.
    pub(in crate::sinumerik) fn take_dropped(&mut self) -> Option<AlarmNumber> {
        self.dropped.take()
    }

    /// Removes the alarms that this action clears, at places for which `concerns` is true, after the event of the action.
    pub(in crate::sinumerik) fn cancel(&mut self, by: Cancel, event: EventId, concerns: impl Fn(Place) -> bool) {
        self.remove(event, |entry| is_cancelled(&entry.alarm, by, &concerns));
    }

    /// Whether this action would clear an alarm.
    #[must_use]
    pub(in crate::sinumerik) fn cancels(&self, by: Cancel, concerns: impl Fn(Place) -> bool) -> bool {
        self.entries.iter().any(|entry| is_cancelled(&entry.alarm, by, &concerns))
    }

    /// Removes an alarm that clears by itself: its condition has ended, as this event says.
    pub(in crate::sinumerik) fn end(&mut self, alarm: &RaisedAlarm, event: EventId) {
        self.remove(event, |entry| entry.alarm == *alarm);
    }

    fn remove(&mut self, event: EventId, is_meant: impl Fn(&Entry) -> bool) {
        let (before, ended) = (self.entries.len(), &mut self.ended);
        self.entries.retain(|entry| {
            let removed = is_meant(entry);
            if removed && ended.is_full() {
                ended.pop_at(0);
            }
            if removed {
                ended.push((entry.alarm, event));
            }
            !removed
        });
        self.note_changed(self.entries.len() != before);
    }

    /// The first alarm that clears by itself and that nothing has raised in this cycle, with the event behind it.
    pub(in crate::sinumerik) fn expired(&self) -> Option<(RaisedAlarm, EventId)> {
        let clears = |number| Alarm::find(number).is_some_and(|alarm| alarm.cancel == Cancel::ByItself);
        let expired = self.entries.iter().find(|entry| !entry.fresh && clears(entry.alarm.number));
        expired.map(|entry| (entry.alarm, entry.cause))
    }

    /// Ends a cycle: an alarm that clears by itself must be raised again in the next one.
    pub(in crate::sinumerik) fn settle(&mut self) {
        for entry in &mut self.entries {
            entry.fresh = false;
        }
    }

    /// The event that ended an alarm in this cycle.
    #[must_use]
    pub(in crate::sinumerik) fn end_of(&self, number: AlarmNumber, place: Place) -> EventId {
        self.last_end(|alarm| (alarm.number, alarm.place) == (number, place))
    }

    /// The event that ended the last of the alarms that are meant and ended in this cycle.
    #[must_use]
    pub(in crate::sinumerik) fn last_end(&self, meant: impl Fn(&RaisedAlarm) -> bool) -> EventId {
        let last = self.ended.iter().rev().find(|(alarm, _)| meant(alarm));
        last.map_or(EventId::NONE, |(_, event)| *event)
    }

    fn note_changed(&mut self, changed: bool) {
        self.changed |= changed;
        self.version = self.version.wrapping_add(u32::from(changed));
    }

    /// A number that differs after each change of the list.
    #[must_use]
    pub(in crate::sinumerik) const fn version(&self) -> u32 {
        self.version
    }

    /// Whether this alarm is pending at this place.
    #[must_use]
    pub(in crate::sinumerik) fn is_pending(&self, number: AlarmNumber, place: Place) -> bool {
        self.entries.iter().any(|entry| (entry.alarm.number, entry.alarm.place) == (number, place))
    }

    /// The event behind an alarm at this place.
    #[must_use]
    pub(in crate::sinumerik) fn cause(&self, number: AlarmNumber, place: Place) -> EventId {
        let of_it = |entry: &&Entry| (entry.alarm.number, entry.alarm.place) == (number, place);
        self.entries.iter().find(of_it).map_or(EventId::NONE, |entry| entry.cause)
    }

    /// The axes with a pending alarm.
    #[must_use]
    pub(in crate::sinumerik) fn axes(&self) -> AxisSet {
        let place = |entry: &Entry| match entry.alarm.place {
            Place::Axis(axis) => Some(axis),
            Place::Nck | Place::ModeGroup(_) | Place::Channel(_) => None,
        };
        self.entries.iter().filter_map(place).collect()
    }

    /// Whether the list changed since the last call.
    pub(in crate::sinumerik) fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// All pending alarms with the events behind them, in order of number and place.
    pub(in crate::sinumerik) fn iter(&self) -> impl Iterator<Item = (&RaisedAlarm, EventId)> {
        self.entries.iter().map(|entry| (&entry.alarm, entry.cause))
    }

    /// The event behind the first pending alarm with this reaction that concerns this place (or all places).
    #[must_use]
    #[inline]
    pub(in crate::sinumerik) fn with_reaction(&self, reaction: Reaction, place: Option<Place>) -> Option<EventId> {
        self.first(|entry, alarm| place.is_none_or(|place| entry == place) && alarm.reaction.has(reaction))
    }

    /// The event behind the first pending alarm whose place and row match.
    #[must_use]
    #[inline]
    pub(in crate::sinumerik) fn first(&self, meant: impl Fn(Place, &Alarm) -> bool) -> Option<EventId> {
        self.first_alarm(meant).map(|(_, cause)| cause)
    }

    /// The number of the first pending alarm that is meant, and the event behind it.
    #[must_use]
    #[inline]
    pub(in crate::sinumerik) fn first_alarm(
        &self,
        meant: impl Fn(Place, &Alarm) -> bool,
    ) -> Option<(AlarmNumber, EventId)> {
        if self.entries.is_empty() {
            return None;
        }
        let is_meant =
            |entry: &&Entry| Alarm::find(entry.alarm.number).is_some_and(|alarm| meant(entry.alarm.place, alarm));
        self.entries.iter().find(is_meant).map(|entry| (entry.alarm.number, entry.cause))
    }
}

/// Whether an action clears an alarm.
fn is_cancelled(alarm: &RaisedAlarm, by: Cancel, concerns: impl Fn(Place) -> bool) -> bool {
    let class = Alarm::find(alarm.number).map_or(Cancel::PowerOn, |alarm| alarm.cancel);
    class != Cancel::ByItself && class <= by && concerns(alarm.place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sinumerik::alarms::{
        ENABLE_RESET, GANTRY_CONFIGURATION, GANTRY_TRIP_LIMIT, GANTRY_WAITING, GANTRY_WARNING_LIMIT,
    };

    fn has(pending: &Pending, number: AlarmNumber) -> bool {
        pending.iter().any(|(alarm, _)| alarm.number == number)
    }

    fn raise(pending: &mut Pending, number: AlarmNumber) {
        pending.raise(number, Place::Nck, [Parameter::None; 4], EventId::NONE);
    }

    #[test]
    fn a_stronger_reset_also_clears_the_alarms_of_a_weaker_one_and_no_others() {
        let mut pending = Pending::default();
        for number in [ENABLE_RESET, GANTRY_TRIP_LIMIT, GANTRY_CONFIGURATION, GANTRY_WAITING] {
            raise(&mut pending, number);
        }
        pending.cancel(Cancel::CancelKey, EventId(7), |_| true);
        assert!(!has(&pending, ENABLE_RESET) && has(&pending, GANTRY_TRIP_LIMIT));
        pending.cancel(Cancel::ModeGroupReset, EventId(8), |place| place != Place::Nck);
        assert!(has(&pending, GANTRY_TRIP_LIMIT), "its place is excluded");
        pending.cancel(Cancel::ModeGroupReset, EventId(9), |_| true);
        assert!(!has(&pending, GANTRY_TRIP_LIMIT));
        assert!(has(&pending, GANTRY_CONFIGURATION) && has(&pending, GANTRY_WAITING));
    }

    #[test]
    fn a_full_list_drops_alarms_and_has_a_place_for_the_message() {
        let mut pending = Pending::default();
        for number in 0..64 {
            assert_eq!(pending.take_dropped(), None);
            raise(&mut pending, AlarmNumber(700_000 + number));
        }
        assert!(!pending.has_room());
        assert_eq!(pending.take_dropped(), Some(AlarmNumber(700_063)));
        raise(&mut pending, ALARM_LIST_FULL);
        assert!(has(&pending, ALARM_LIST_FULL) && !has(&pending, AlarmNumber(700_063)));
        assert_eq!(pending.iter().count(), Alarms::CAPACITY);
        let alarm = *pending.iter().next().unwrap().0;
        pending.end(&alarm, EventId::NONE);
        assert!(pending.has_room(), "the message takes no place of an alarm");
        raise(&mut pending, AlarmNumber(700_063));
        assert!(has(&pending, AlarmNumber(700_063)));
        assert_eq!(pending.take_dropped(), None);
    }

    #[test]
    fn an_alarm_that_clears_by_itself_goes_in_the_first_cycle_without_its_cause() {
        let mut pending = Pending::default();
        raise(&mut pending, GANTRY_WARNING_LIMIT);
        pending.settle();
        raise(&mut pending, GANTRY_WARNING_LIMIT);
        assert!(pending.expired().is_none());
        pending.settle();
        raise(&mut pending, GANTRY_TRIP_LIMIT);
        pending.settle();
        let Some((alarm, _)) = pending.expired() else { panic!("one that clears by itself has expired") };
        pending.end(&alarm, EventId(9));
        assert!(pending.expired().is_none(), "the other one does not clear by itself");
        assert!(!has(&pending, GANTRY_WARNING_LIMIT) && has(&pending, GANTRY_TRIP_LIMIT));
        assert_eq!(pending.end_of(GANTRY_WARNING_LIMIT, Place::Nck), EventId(9));
        pending.begin();
        assert_eq!(pending.end_of(GANTRY_WARNING_LIMIT, Place::Nck), EventId::NONE);
    }
}
