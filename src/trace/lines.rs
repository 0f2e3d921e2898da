//! Converts rows to lines: bytes become signals, numbers become names, in the documented order.
//!
//! Order within one time: notes, happenings, writes by address, bits of the NCK by address, alarms by number, values.

use std::collections::BTreeMap;

use super::because::{because, by_program};
use super::bits::Bits;
use super::happened::{HappeningLine, happened};
use super::places::Places;
use super::printable::{Order, Printable, Shown, printable, shown};
use super::value::Recorded;
use super::{By, Change, NoEffect, Trace, Watch};
use crate::image::{Format, Location, Memory, Names, Part};
use crate::units::Time;
use crate::variables::{
    AlarmNumber, Describe, EventId, FaultName, Parameter, Place, RaisedAlarm, axis_name, place_name,
};

/// One line of a trace.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Time since the start of the trace, a whole number of cycles.
    pub time: Time,
    /// The content.
    pub kind: LineKind,
}

/// The content of a line.
#[derive(Clone, Debug, PartialEq)]
pub enum LineKind {
    /// A note of the scenario, or a message of the simulator.
    Note(String),
    /// Something happened that is not a change of a signal: power on, machine data, faults, operator keys.
    Happening(HappeningLine),
    /// A signal changed.
    Signal(SignalLine),
    /// An alarm was raised or cleared.
    Alarm(AlarmLine),
    /// A watched value changed: its name, the old and the new value; measured values have six decimals.
    Value(String, Option<String>, String),
    /// A watched text changed: its name, the old and the new text; `-` if it is empty.
    Text(String, Option<String>, String),
}

/// A signal changed.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalLine {
    /// The symbol, if the signal has one.
    pub symbol: Option<String>,
    /// The address.
    pub address: String,
    /// The old value.
    pub old: Shown,
    /// The new value.
    pub new: Shown,
    /// The writer.
    pub by: By,
    /// The cause, if it is known.
    pub because: Option<String>,
    /// The number of the event that caused it, as counted in the trace, from one; zero if it is unknown.
    pub event: u32,
    /// The location.
    pub location: Location,
}

/// An alarm was raised or cleared.
#[derive(Clone, Debug, PartialEq)]
pub struct AlarmLine {
    /// Its number, or its name if it has only a name.
    pub name: String,
    /// Whether it has a number.
    pub numbered: bool,
    /// Whether it was raised.
    pub raised: bool,
    /// The axis or channel.
    pub place: String,
    /// Its parameters, as text or number.
    pub parameters: Vec<Result<i64, String>>,
    /// Its text.
    pub text: String,
    /// The cause, if it is known.
    pub because: Option<String>,
    /// The number of the event that caused it, as counted in the trace, from one; zero if it is unknown.
    pub event: u32,
}

/// Says that a command had no effect, and why.
fn without_effect(what: NoEffect, names: &Names) -> String {
    match what {
        NoEffect::Release(location) => {
            let what = printable(names, location).called();
            format!("`release` without effect: {what} was not forced; a value that was set stays until it is set again")
        }
        NoEffect::ClearFault { axis, name } => {
            let (axis, kind) = (axis_name(axis, names), name.name());
            match name {
                FaultName::Push | FaultName::EncoderSlip | FaultName::MovedByHand => {
                    format!("`clear_fault` without effect: a {kind} displaces {axis} once, and the displacement stays")
                }
                FaultName::Block
                | FaultName::ZeroMarkMissing
                | FaultName::DriveFault
                | FaultName::EncoderFault
                | FaultName::Friction
                | FaultName::Drift
                | FaultName::SwitchStuck
                | FaultName::Hold
                | FaultName::DriveNotReady => format!("`clear_fault` without effect: {axis} had no fault {kind}"),
            }
        }
    }
}

/// A signal that changes in the current cycle.
struct Draft {
    printable: Printable,
    old: Shown,
    by: By,
    cause: EventId,
}

impl Trace {
    /// The lines of the trace, in order.
    #[must_use]
    pub fn lines(&self, describe: &dyn Describe, watch: &Watch) -> Vec<Line> {
        let names = describe.names();
        let mut places = Places::new(names, watch);
        let mut memory = self.start.clone();
        // Ordered by cycle and by kind; lines of equal rank keep their order.
        let mut ranked: Vec<(u64, u8, Line)> = Vec::new();
        let mut push = |cycle, rank, kind| {
            let time = self.time(cycle);
            ranked.push((cycle, rank, Line { time, kind }));
        };
        for (cycle, text) in &self.notes {
            push(*cycle, 0, LineKind::Note(text.clone()));
        }
        for (cycle, bits, others) in self.cycles() {
            let mut drafts: BTreeMap<(bool, Order, u8), Draft> = BTreeMap::new();
            for bits in bits {
                draft(bits, &memory, &mut places, &mut drafts);
            }
            for row in others {
                if let Change::Happened { what, by, cause } = row.change {
                    let because = self.event(cause, cycle).map(|event| because(event, describe));
                    let event = self.event_number(cause, cycle);
                    let line = HappeningLine { because, event, ..happened(&what, by, describe) };
                    push(cycle, 1, LineKind::Happening(line));
                }
                if let Change::Overwritten { part, offset, bits } = row.change {
                    let what = places.call(part, offset, bits);
                    push(
                        cycle,
                        0,
                        LineKind::Note(format!("the PLC program overwrote what was set: {what}; force wins over it")),
                    );
                }
                if let Change::NoEffect(what) = row.change {
                    push(cycle, 0, LineKind::Note(without_effect(what, names)));
                }
            }
            for &Bits { part, offset, new, .. } in bits {
                let byte = Location { part, offset, bit: 0, width: 8, format: Format::Unsigned };
                memory.write(byte, new.into());
            }
            for Draft { printable, old, by, cause } in drafts.into_values() {
                let new = shown(&memory, printable.location);
                if old != new {
                    let mut because = self.event(cause, cycle).map(|event| because(event, describe));
                    let mut event = self.event_number(cause, cycle);
                    let Printable { symbol, address, location, .. } = printable;
                    if by == By::Plc
                        && let Some((number, row)) = self.program_cause(location, memory.read(location), cycle)
                    {
                        because = Some(by_program(self, row, names));
                        event = number;
                    }
                    let is_clock = location.part == Part::Timers && because.is_none() && watch.is_of_everything();
                    if is_clock {
                        continue;
                    }
                    let rank = if by == By::Nck { 3 } else { 2 };
                    let line = SignalLine { symbol, address, old, new, by, because, event, location };
                    push(cycle, rank, LineKind::Signal(line));
                }
            }
            let mut alarms: Vec<_> = others
                .iter()
                .filter_map(|row| match row.change {
                    Change::Alarm { alarm, raised, cause } => Some((alarm, raised, cause)),
                    Change::Byte { .. }
                    | Change::Happened { .. }
                    | Change::Overwritten { .. }
                    | Change::NoEffect(_) => None,
                })
                .collect();
            alarms.sort_by_key(|(alarm, ..)| (alarm.number, alarm.place));
            for (alarm, raised, cause) in alarms {
                push(cycle, 4, LineKind::Alarm(self.alarm(&alarm, raised, (cause, cycle), describe)));
            }
        }
        for row in &self.values {
            let watched = &self.watched[row.index];
            let name = watched.value.name(names);
            let shown = |value: Recorded| value.shown(&self.texts);
            let (old, new) = (row.old.map(shown), shown(row.new));
            let kind = match row.new {
                Recorded::Measured(_) | Recorded::Number(_) => LineKind::Value(name, old, new),
                Recorded::Text(_) => LineKind::Text(name, old, new),
            };
            push(row.cycle, 5, kind);
        }
        ranked.sort_by_key(|(cycle, rank, _)| (*cycle, *rank));
        ranked.into_iter().map(|(_, _, line)| line).collect()
    }

    fn alarm(
        &self,
        alarm: &RaisedAlarm,
        raised: bool,
        (cause, cycle): (EventId, u64),
        describe: &dyn Describe,
    ) -> AlarmLine {
        let names = describe.names();
        let parameter = |parameter: &Parameter| match *parameter {
            Parameter::None => None,
            Parameter::Channel(channel) => Some(Err(place_name(Place::Channel(channel), names))),
            Parameter::Axis(axis) => Some(Err(place_name(Place::Axis(axis), names))),
            Parameter::Number(number) => Some(Ok(number)),
            Parameter::Direction(direction) => Some(Err(if direction < 0 { "-" } else { "+" }.to_owned())),
            Parameter::Milliseconds(time) => Some(Err(time.milliseconds().to_string())),
            Parameter::Text(text) => Some(Err(text.to_string())),
            Parameter::OfControl(index) => Some(Err(describe.message_text(index).to_owned())),
        };
        AlarmLine {
            name: describe.alarm_name(alarm.number),
            numbered: alarm.number.0 < AlarmNumber::OWN,
            raised,
            place: place_name(alarm.place, names),
            parameters: alarm.parameters.iter().filter_map(parameter).collect(),
            text: describe.alarm_text(alarm),
            because: self.event(cause, cycle).map(|event| because(event, describe)),
            event: self.event_number(cause, cycle),
        }
    }
}

/// Records the printable items that bits change; a number of several bytes, or with bits that changed for several reasons, is recorded once.
fn draft(bits: &Bits, before: &Memory, places: &mut Places<'_>, drafts: &mut BTreeMap<(bool, Order, u8), Draft>) {
    for printable in places.at(bits.part, bits.offset) {
        if bits.changed(printable.location) == 0 {
            continue;
        }
        let key = |by_nck| (by_nck, printable.order, printable.location.width);
        if [true, false].iter().any(|by_nck| drafts.contains_key(&key(*by_nck))) {
            continue;
        }
        let old = shown(before, printable.location);
        let draft = Draft { printable: printable.clone(), old, by: bits.by, cause: bits.cause };
        drafts.insert(key(bits.by == By::Nck), draft);
    }
}
