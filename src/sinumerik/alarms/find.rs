//! The row of an alarm in the tables.

use crate::sinumerik::alarms::{Alarm, CATALOGUE, programs};
use crate::variables::AlarmNumber;

impl Alarm {
    /// All alarms that the model can raise; not in the order of their numbers.
    pub(in crate::sinumerik) fn raised() -> impl Iterator<Item = &'static Self> {
        CATALOGUE.iter().chain(programs::PROGRAMS)
    }

    /// The row of this number.
    #[must_use]
    pub fn find(number: AlarmNumber) -> Option<&'static Self> {
        let in_table = |table: &'static [Self]| {
            table.binary_search_by_key(&number, |alarm| alarm.number).ok().map(|index| &table[index])
        };
        in_table(CATALOGUE).or_else(|| in_table(programs::PROGRAMS)).or_else(|| programs::of_a_cycle(number))
    }
}
