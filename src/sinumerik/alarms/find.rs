//! The row of an alarm in the tables.

use crate::sinumerik::alarms::axis_exchange::AXIS_EXCHANGE;
use crate::sinumerik::alarms::{Alarm, CATALOGUE, Cancel, Reaction, programs};
use crate::variables::AlarmNumber;

/// The user alarms of an 828D: MD14516 defines what clears them and their reactions, which act beside this list. `%1` is their variable.
static USER_ALARM: Alarm = Alarm {
    number: AlarmNumber(700_000),
    text: "user alarm of the PLC, variable %1",
    reaction: Reaction::DISPLAY,
    cancel: Cancel::ByItself,
};

/// The messages of a PLC program by DB2 and FC 10.
static PLC_MESSAGE: Alarm = Alarm {
    number: AlarmNumber(510_000),
    text: "message of the PLC program",
    reaction: Reaction::DISPLAY,
    cancel: Cancel::ByItself,
};

fn plc_message(number: AlarmNumber) -> Option<&'static Alarm> {
    (510_000..800_000).contains(&number.0).then_some(&PLC_MESSAGE)
}

fn user_alarm(number: AlarmNumber) -> Option<&'static Alarm> {
    (700_000..700_248).contains(&number.0).then_some(&USER_ALARM)
}

impl Alarm {
    /// All alarms that the model can raise; not in the order of their numbers.
    pub(in crate::sinumerik) fn raised() -> impl Iterator<Item = &'static Self> {
        CATALOGUE.iter().chain(programs::PROGRAMS).chain(AXIS_EXCHANGE)
    }

    /// The row of this number.
    #[must_use]
    pub fn find(number: AlarmNumber) -> Option<&'static Self> {
        let in_table = |table: &'static [Self]| {
            table.binary_search_by_key(&number, |alarm| alarm.number).ok().map(|index| &table[index])
        };
        let tables = [CATALOGUE, programs::PROGRAMS, AXIS_EXCHANGE];
        tables
            .into_iter()
            .find_map(in_table)
            .or_else(|| programs::of_a_cycle(number))
            .or_else(|| user_alarm(number))
            .or_else(|| plc_message(number))
    }
}
