//! The alarm lists: all pending alarms in three orders.
//!
//! | module | order |
//! |---|---|
//! | SALA, SALAC | oldest first |
//! | SALAL | newest first |
//! | SALAP | by cancel condition, the strongest first (POWER ON, RESET, cancel key, NC start, automatic), then oldest first |
//!
//! `alarmNo` is the sequence number since power on, `textIndex` is the alarm number that is shown; both are 0 in free rows. A list has as
//! many rows as alarms may be pending, so a client may read beyond the pending alarms.
//!
//! A parameter is a text whose first character gives its kind: `A` axis, `K` channel, `S` anything else.
//!
//! Choices: on a control, SALAC also keeps cancelled alarms and their history; here it is the same list as SALA.

use arrayvec::ArrayVec;

use super::{ClockTime, Shown, View};
use crate::variables::{Alarms, Arrival, Parameter, RaisedAlarm};

/// The order of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// SALA, SALAC.
    Time,
    /// SALAL.
    LastFirst,
    /// SALAP.
    Priority,
}

/// The alarm in a row, if there is one; the outer `None` means that the list has no such row.
fn at<'a>(view: &View<'a>, order: Order, line: u16) -> Option<Option<(&'a RaisedAlarm, Arrival)>> {
    let place = usize::from(line.checked_sub(1)?);
    if place >= Alarms::CAPACITY {
        return None;
    }
    let mut all: ArrayVec<_, { Alarms::CAPACITY }> = view.variables.alarms.arrivals().collect();
    let priority = |alarm: &RaisedAlarm| match view.control.map_or(0, |control| control.clear_info(alarm.number)) {
        1 => 0,
        6 => 1,
        2 => 2,
        3 => 3,
        5 => 4,
        _ => 5,
    };
    match order {
        Order::Time => all.sort_by_key(|(_, arrival)| arrival.ordinal),
        Order::LastFirst => all.sort_by_key(|(_, arrival)| std::cmp::Reverse(arrival.ordinal)),
        Order::Priority => all.sort_by_key(|(alarm, arrival)| (priority(alarm), arrival.ordinal)),
    }
    Some(all.get(place).copied())
}

pub(super) fn text_index<'a>(view: &View<'a>, order: Order, line: u16) -> Option<Shown<'a>> {
    at(view, order, line).map(|found| Shown::Number(found.map_or(0.0, |(alarm, _)| alarm.number.0.into())))
}

pub(super) fn ordinal<'a>(view: &View<'a>, order: Order, line: u16) -> Option<Shown<'a>> {
    at(view, order, line).map(|found| Shown::Number(found.map_or(0.0, |(_, arrival)| arrival.ordinal.into())))
}

pub(super) fn clear_info<'a>(view: &View<'a>, order: Order, line: u16) -> Option<Shown<'a>> {
    let control = view.control?;
    let info = |(alarm, _): (&RaisedAlarm, Arrival)| control.clear_info(alarm.number).into();
    at(view, order, line).map(|found| Shown::Number(found.map_or(0.0, info)))
}

pub(super) fn date<'a>(view: &View<'a>, order: Order, line: u16) -> Option<Shown<'a>> {
    let now = view.control?.time();
    let date = |arrival: Arrival| -> ClockTime {
        let ago = (now - arrival.time).nanos() / 1_000_000;
        view.clock.earlier(u64::try_from(ago).unwrap_or(0))
    };
    at(view, order, line).map(|found| Shown::Date(found.map(|(_, arrival)| date(arrival))))
}

pub(super) fn parameter<'a>(view: &View<'a>, order: Order, line: u16, which: usize) -> Option<Shown<'a>> {
    let text = |alarm: &RaisedAlarm| match alarm.parameters[which] {
        Parameter::None => "S".to_owned(),
        Parameter::Channel(number) => format!("K{}", view.names.channels[number].as_deref().unwrap_or("")),
        Parameter::Axis(number) => format!("A{}", view.names.axes[number].as_deref().unwrap_or("")),
        Parameter::Number(number) => format!("S{number}"),
        Parameter::Direction(direction) => if direction < 0 { "S-" } else { "S+" }.to_owned(),
        Parameter::Milliseconds(time) => format!("S{}", time.milliseconds()),
        Parameter::Text(text) => format!("S{text}"),
        Parameter::OfControl(index) => format!("S{}", view.control.map_or("", |control| control.message_text(index))),
    };
    let found = at(view, order, line)?;
    Some(Shown::Text(found.map_or_else(String::new, |(alarm, _)| text(alarm)).into()))
}
