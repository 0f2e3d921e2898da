//! Alarms: what they mean, what they stop, how they are cancelled, and the list of those that are pending.
//!
//! Numbers, reactions and cancel classes are those of the Diagnostics Manual. An alarm is raised in the stage
//! "monitoring and alarms"; its reactions act from the next cycle on and its bits are published in the same one.
//! A new alarm is a row of [`alarms!`] and a call of [`Pending::raise`].

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::variables::{AlarmNumber, Alarms, EventId, Parameter, Place, RaisedAlarm};

/// What an alarm does, as flags; the names are the Diagnostics Manual's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reaction(u16);

impl Reaction {
    /// NC not ready: DB10.DBX108.7 = 0, all axes stop.
    pub const NC_NOT_READY: Self = Self(1);
    /// Mode group not ready: DB11.DBX6.3 = 0.
    pub const MODE_GROUP_NOT_READY: Self = Self(1 << 1);
    /// Channel not ready: DB21.DBX36.5 = 0.
    pub const CHANNEL_NOT_READY: Self = Self(1 << 2);
    /// NC start disabled in this channel.
    pub const START_DISABLED: Self = Self(1 << 3);
    /// The NC switches the axis to follow-up.
    pub const FOLLOW_UP: Self = Self(1 << 4);
    /// Alarm interface signals are set: DB10.DBX109.0, DB21.DBX36.6, DB31.DBX61.1.
    pub const INTERFACE_SIGNALS: Self = Self(1 << 5);
    /// Shown.
    pub const DISPLAY: Self = Self(1 << 6);
    /// NC stop with the alarm: DB21.DBX36.7 = 1.
    pub const STOP: Self = Self(1 << 7);
    /// Only the axis concerned stops.
    pub const LOCAL: Self = Self(1 << 8);

    /// Whether it has all of these.
    #[must_use]
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// What removes an alarm; a stronger one also removes what a weaker one would.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cancel {
    /// Goes with its cause.
    ByItself,
    /// The alarm-cancel key, or NC start.
    CancelKey,
    /// RESET in the channel.
    Reset,
    /// RESET in all channels of the mode group.
    ModeGroupReset,
    /// Power off and on.
    PowerOn,
}

/// A row of the alarm list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Alarm {
    /// Its number, or one beyond [`AlarmNumber::OWN`].
    pub number: AlarmNumber,
    /// Its name in words, which is how an alarm of our own is called.
    pub name: &'static str,
    /// Its text with `%1` to `%4`.
    pub text: &'static str,
    /// What it does.
    pub reaction: Reaction,
    /// What removes it.
    pub cancel: Cancel,
}

/// Makes a constant and a catalogue entry of each row:
/// `NAME number "name" [REACTIONS] Cancel "text";`
macro_rules! alarms {
    ($($(#[$doc:meta])* $constant:ident $number:expr, $name:literal [$($reaction:ident)*] $cancel:ident $text:literal;)*) => {
        $($(#[$doc])* pub(super) const $constant: AlarmNumber = AlarmNumber($number);)*

        /// All alarms that can be raised, ascending by number.
        pub const CATALOGUE: &[Alarm] = &[$(Alarm {
            number: $constant,
            name: $name,
            text: $text,
            reaction: Reaction(0)$(.and(Reaction::$reaction))*,
            cancel: Cancel::$cancel,
        }),*];
    };
}

alarms! {
    /// The PLC program stopped or faulted.
    PLC_SIGN_OF_LIFE 2000, "plc-sign-of-life"
        [NC_NOT_READY LOCAL CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "sign-of-life monitoring: the PLC program does not run";
    /// Wrong gantry machine data. Code 1: wrong grouping number or designation; 2: leading axis declared more than once.
    GANTRY_MACHINE_DATA 10650, "gantry-machine-data"
        [NC_NOT_READY MODE_GROUP_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "channel %1 axis %2 wrong gantry machine data, error code %3";
    /// Illegal gantry configuration, reason and grouping in one number.
    GANTRY_CONFIGURATION 10651, "gantry-configuration"
        [NC_NOT_READY MODE_GROUP_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "channel %1 illegal gantry configuration, reason %2";
    /// Warning limit exceeded.
    GANTRY_WARNING_LIMIT 10652, "gantry-warning-limit-exceeded" [DISPLAY] ByItself
        "channel %1 axis %2 gantry warning limit exceeded";
    /// Trip limit exceeded; the axes brake in position control and stay under control.
    GANTRY_TRIP_LIMIT 10653, "gantry-error-limit-exceeded" [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 gantry error limit exceeded";
    /// Waiting for synchronisation start.
    GANTRY_WAITING 10654, "gantry-waiting-for-synchronisation-start" [DISPLAY] ByItself
        "channel %1 waiting for synchronisation start of gantry grouping %2";
    /// Synchronisation running.
    GANTRY_SYNCHRONISING 10655, "gantry-synchronisation-running" [DISPLAY] ByItself
        "channel %1 synchronisation of gantry grouping %2 running";
    /// Reference cam not reached within MD34030.
    CAM_NOT_REACHED 20000, "reference-cam-not-reached" [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 reference cam not reached";
    /// At rest after section 1 and not on the cam.
    CAM_SIGNAL_MISSING 20001, "cam-signal-missing" [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 cam signal missing";
    /// No zero mark within MD34060.
    REFERENCE_MARK_NOT_FOUND 20002, "reference-mark-not-found" [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 zero reference mark not found";
    /// Approach aborted.
    APPROACH_ABORTED 20005, "reference-approach-aborted" [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 reference point approach aborted";
    /// Creep velocity not reached at the cam edge, twice.
    CREEP_VELOCITY_NOT_REACHED 20006, "creep-velocity-not-reached" [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 reference point creep velocity not reached";
    /// Enable reset during motion. Cause 1: servo enable; 2: pulse enable; 3: pulses enabled; 4: drive ready.
    ENABLE_RESET 21612, "enable-reset" [FOLLOW_UP START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] CancelKey
        "channel %1 axis %2 enable reset during motion, cause %3";
    /// Linear and rotary axes in one grouping; the manuals give no number (O-18).
    GANTRY_MIXED_AXIS_TYPES AlarmNumber::OWN, "gantry-mixed-axis-types"
        [NC_NOT_READY MODE_GROUP_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "channel %1 axis %2 gantry grouping %3 mixes linear and rotary axes";
}

impl Alarm {
    /// The row of a number.
    #[must_use]
    pub fn find(number: AlarmNumber) -> Option<&'static Self> {
        CATALOGUE.binary_search_by_key(&number, |alarm| alarm.number).ok().map(|index| &CATALOGUE[index])
    }
}

/// A pending alarm and the event behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    alarm: RaisedAlarm,
    cause: EventId,
    /// Raised by its cause in this cycle; what goes by itself goes when nobody raises it any more.
    fresh: bool,
}

/// The alarms that are pending; bounded, as the list of a control is. What does not fit is the least of the troubles.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Pending {
    entries: ArrayVec<Entry, { Alarms::CAPACITY }>,
    changed: bool,
}

impl Pending {
    /// Raises an alarm, or keeps it raised.
    pub(super) fn raise(&mut self, number: AlarmNumber, place: Place, parameters: [Parameter; 4], cause: EventId) {
        let alarm = RaisedAlarm { number, place, parameters };
        if let Some(entry) = self.entries.iter_mut().find(|entry| entry.alarm == alarm) {
            entry.fresh = true;
            return;
        }
        let index = self.entries.partition_point(|entry| (entry.alarm.number, entry.alarm.place) < (number, place));
        if self.entries.try_insert(index, Entry { alarm, cause, fresh: true }).is_ok() {
            self.changed = true;
        }
    }

    /// Removes what this way of cancelling removes.
    pub(super) fn cancel(&mut self, by: Cancel) {
        let before = self.entries.len();
        self.entries.retain(|entry| {
            let class = Alarm::find(entry.alarm.number).map_or(Cancel::PowerOn, |alarm| alarm.cancel);
            class == Cancel::ByItself || class > by
        });
        self.changed |= self.entries.len() != before;
    }

    /// Ends a cycle: what goes by itself and was not raised in it goes.
    pub(super) fn settle(&mut self) {
        let before = self.entries.len();
        self.entries.retain(|entry| {
            let stays =
                entry.fresh || Alarm::find(entry.alarm.number).is_none_or(|alarm| alarm.cancel != Cancel::ByItself);
            entry.fresh = false;
            stays
        });
        self.changed |= self.entries.len() != before;
    }

    /// Whether the list changed since it was last asked.
    pub(super) fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// Whether nothing is pending.
    #[must_use]
    pub(super) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// All that are pending with the events behind them, in order of number and place.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&RaisedAlarm, EventId)> {
        self.entries.iter().map(|entry| (&entry.alarm, entry.cause))
    }

    /// The event behind the first pending alarm with this reaction that concerns this place (or all).
    #[must_use]
    #[inline]
    pub(super) fn with_reaction(&self, reaction: Reaction, place: Option<Place>) -> Option<EventId> {
        if self.entries.is_empty() {
            return None;
        }
        self.entries
            .iter()
            .find(|entry| {
                place.is_none_or(|place| entry.alarm.place == place)
                    && Alarm::find(entry.alarm.number).is_some_and(|alarm| alarm.reaction.has(reaction))
            })
            .map(|entry| entry.cause)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn has(pending: &Pending, number: AlarmNumber) -> bool {
        pending.iter().any(|(alarm, _)| alarm.number == number)
    }

    fn raise(pending: &mut Pending, number: AlarmNumber) {
        pending.raise(number, Place::Nck, [Parameter::None; 4], EventId::NONE);
    }

    #[test]
    fn the_catalogue_ascends_so_that_a_number_is_found() {
        assert!(CATALOGUE.windows(2).all(|pair| pair[0].number < pair[1].number));
        assert_eq!(Alarm::find(GANTRY_WAITING).map(|alarm| alarm.cancel), Some(Cancel::ByItself));
        assert_eq!(Alarm::find(AlarmNumber(1)), None);
    }

    #[test]
    fn a_stronger_reset_removes_what_a_weaker_one_does_and_no_more() {
        let mut pending = Pending::default();
        for number in [ENABLE_RESET, GANTRY_TRIP_LIMIT, GANTRY_CONFIGURATION, GANTRY_WAITING] {
            raise(&mut pending, number);
        }
        pending.cancel(Cancel::CancelKey);
        assert!(!has(&pending, ENABLE_RESET) && has(&pending, GANTRY_TRIP_LIMIT));
        pending.cancel(Cancel::ModeGroupReset);
        assert!(!has(&pending, GANTRY_TRIP_LIMIT));
        assert!(has(&pending, GANTRY_CONFIGURATION) && has(&pending, GANTRY_WAITING));
    }

    #[test]
    fn what_goes_by_itself_goes_in_the_first_cycle_without_its_cause() {
        let mut pending = Pending::default();
        raise(&mut pending, GANTRY_WARNING_LIMIT);
        pending.settle();
        raise(&mut pending, GANTRY_WARNING_LIMIT);
        pending.settle();
        assert!(has(&pending, GANTRY_WARNING_LIMIT));
        pending.settle();
        assert!(pending.is_empty());
    }
}
