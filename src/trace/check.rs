//! Checks the causes in a trace: replays the record and compares each cause with it. Called after a run, on its complete trace.
//!
//! The cause of an edge of a signal, and of an alarm that is raised or cleared, is an event. It is correct if the event happened in the
//! cycle of the edge, if it has an input or a parent event, and if each signal among its inputs had the value in the event. For a signal of
//! the PLC, this is the value at the end of the cycle, after inputs, scan and forces; with `to_nck_delay` (O-28) it is the value that the
//! control read. For a signal of the control, it is the value decided in the cycle or the value published in the cycle before. An alarm
//! among the inputs must be pending, or be raised or cleared in the cycle. A machine datum must have the active value: the latest one in
//! the trace, or the one from the start.
//!
//! Values of an axis are compared with those after the cycle and after the one before:
//!
//! | a cause names | compared with | within |
//! |---|---|---|
//! | `position`, `setpoint` | the same value | half an increment |
//! | `target` | setpoint + distance-to-go | half an increment |
//! | `synchronism_difference`, `setpoint_compensation` | the same value | half an increment |
//! | `deviation` | ± following error, or the difference of the two encoders | half an increment |
//! | `zero_mark` | the middle of the way of the cycle | 1.5 times this way, and an increment |
//! | `velocity` | actual velocity | 60 increments/min, of a rotary axis / 360 where it is in rev/min |
//! | | way of the setpoint in the cycle / cycle time T | 60 (1 + 1 s/T) increments/min likewise, because its ends are whole increments |
//!
//! An increment is a millionth of a mm or degree. `base`, `distance` (travelled), `velocity_command`, `contour_deviation`,
//! `zero_mark_deviation`, `sag` and faults are not compared: no value of the axis shows them.
//!
//! What no row of a trace shows is measured during the run: call [`Trace::measure_causes`] before it. Without this, lengths and velocities
//! are not compared, and with a delay the bytes of the PLC are taken as they were written.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use super::because::{because, input_name, per_turn};
use super::bits::Bits;
use super::measured::{byte, possible};
use super::places::Places;
use super::printable::{mask_in_byte, signal_at, signal_name};
use super::{By, Change, Row, Trace, Watch};
use crate::image::{Interface, Memory, Part};
use crate::units::{AxisNumber, Position, Time};
use crate::variables::{
    AlarmNumber, DatumValue, Describe, Event, EventId, Happening, Input, Place, Quantity, RaisedAlarm, SignalBit,
    axis_name, place_name, six_decimals,
};

/// A wrong or missing cause.
#[derive(Clone, Debug, PartialEq)]
pub struct CauseFinding {
    /// When the signal or the alarm changed, since the start of the trace.
    pub time: Time,
    /// The signal with its symbol and its address, or the alarm with its place.
    pub signal: String,
    /// The cause as printed in the trace, if there is one.
    pub because: Option<String>,
    /// The fault.
    pub fault: CauseFault,
}

/// The fault of a cause.
#[derive(Clone, Debug, PartialEq)]
pub enum CauseFault {
    /// The edge has no event.
    Missing,
    /// The event has neither an input nor a parent event.
    Empty,
    /// The event happened in another cycle, at this time.
    AnotherCycle(Time),
    /// The event contains this signal with the first value, but the signal had the second value.
    Untrue(String, u64, u64),
    /// The event contains this machine datum with the first value, but the second value is active.
    OtherDatum(String, f64, f64),
    /// The event contains this length or velocity with the first value, but the axis had the second value.
    OtherLength(String, f64, f64),
    /// The event contains these bits, which are no signal.
    Unknown(String),
    /// The event contains this alarm, which was not pending.
    NotPending(String),
}

impl fmt::Display for CauseFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: ", self.time, self.signal)?;
        match &self.fault {
            CauseFault::Missing => f.write_str("no cause")?,
            CauseFault::Empty => f.write_str("the cause has neither an input nor a parent event")?,
            CauseFault::AnotherCycle(time) => write!(f, "the cause is an event at {time} s")?,
            CauseFault::Untrue(signal, named, found) => write!(f, "the cause names {signal} = {named}, found {found}")?,
            CauseFault::OtherDatum(datum, named, active) => {
                write!(f, "the cause names {datum} = {named}, active is {active}")?;
            }
            CauseFault::OtherLength(name, named, found) => {
                write!(f, "the cause names {name} = {}, found {}", six_decimals(*named), six_decimals(*found))?;
            }
            CauseFault::Unknown(bits) => write!(f, "the cause names {bits}, which is no signal")?,
            CauseFault::NotPending(alarm) => write!(f, "the cause names alarm {alarm}, which is not pending")?,
        }
        self.because.as_ref().map_or(Ok(()), |because| write!(f, " ({because})"))
    }
}

impl Trace {
    /// Checks the cause of each edge of the control, for the signals selected by `watch`, and of each alarm that is raised or cleared. If
    /// the trace lost rows, the findings after them are not reliable.
    #[must_use]
    pub fn check_causes(&self, describe: &dyn Describe, watch: &Watch) -> Vec<CauseFinding> {
        let names = describe.names();
        let mut places = Places::new(names, watch);
        let mut memory = self.start.clone();
        let mut pending: Vec<RaisedAlarm> = Vec::new();
        let mut data = BTreeMap::new();
        let activated: BTreeSet<_> = self.cycles().flat_map(|(_, _, rows)| rows).filter_map(active_datum).collect();
        let mut findings = Vec::new();
        let mut late = self.measured.as_ref().and_then(|measured| measured.read_late(&self.start));
        for (cycle, bits, rows) in self.cycles() {
            for bits in bits {
                memory.write(byte(bits.part, bits.offset), bits.new.into());
            }
            for row in rows {
                match row.change {
                    Change::Alarm { alarm, raised: true, .. } => pending.push(alarm),
                    Change::Happened { what: Happening::DatumActive(datum), .. } => {
                        data.extend(datum.value.map(|value| (key(&datum), value)));
                    }
                    Change::Byte { .. }
                    | Change::Alarm { raised: false, .. }
                    | Change::Happened { .. }
                    | Change::Overwritten { .. }
                    | Change::NoEffect(_) => {}
                }
            }
            let read = late.as_mut().map(|late| late.at(cycle));
            let interface = names.interface();
            let seen =
                Seen { memory: &memory, read, pending: &pending, data: &data, activated: &activated, bits, interface };
            let mut check = |cause: EventId, what: String| {
                let event = self.event(cause, cycle);
                findings.extend(self.faults(event, cycle, &seen, describe).into_iter().map(|fault| CauseFinding {
                    time: self.time(cycle),
                    signal: what.clone(),
                    because: event.map(|event| because(event, describe)),
                    fault,
                }));
            };
            for bits in bits.iter().filter(|bits| bits.by == By::Nck) {
                for printable in places.at(bits.part, bits.offset) {
                    if bits.changed(printable.location) != 0 {
                        check(bits.cause, printable.called());
                    }
                }
            }
            for row in rows {
                if let Change::Alarm { alarm, raised, cause } = row.change {
                    let state = if raised { "raised" } else { "cleared" };
                    let place = place_name(alarm.place, names);
                    check(cause, format!("alarm {} of {place} {state}", describe.alarm_name(alarm.number)));
                }
            }
            for row in rows {
                if let Change::Alarm { alarm, raised: false, .. } = row.change {
                    pending.retain(|known| *known != alarm);
                }
            }
        }
        findings
    }

    fn faults(&self, event: Option<&Event>, cycle: u64, seen: &Seen<'_>, describe: &dyn Describe) -> Vec<CauseFault> {
        let Some(event) = event else { return vec![CauseFault::Missing] };
        let mut faults = Vec::new();
        if event.cycle != cycle {
            faults.push(CauseFault::AnotherCycle(self.time(event.cycle)));
        }
        if !event.parent.is_some() && event.inputs.iter().all(|input| *input == Input::None) {
            faults.push(CauseFault::Empty);
        }
        for input in event.inputs {
            if let Input::Alarm(number) = input
                && !seen.pending.iter().any(|alarm| alarm.number.0 == number)
            {
                faults.push(CauseFault::NotPending(describe.alarm_name(AlarmNumber(number))));
            }
            let differs = |number, axis, active: f64, named: f64| {
                // A datum that became active in mm, before the system was inch, is in mm.
                [active, describe.in_causes(number, axis, active)].iter().all(|value| (value - named).abs() > 1e-6)
            };
            let datum = match input {
                Input::Datum(number, axis, named) => Some(((number, None, axis), named)),
                Input::Element(number, index, axis, named) => Some(((number, Some(index), Some(axis)), named)),
                Input::None
                | Input::Bit(..)
                | Input::Number(..)
                | Input::Length(..)
                | Input::Alarm(_)
                | Input::Fault(_)
                | Input::Block(_) => None,
            };
            if let Some((key @ (number, _, axis), named)) = datum
                && let Some(active) = seen.active(key, describe)
                && differs(number, axis, active, named)
            {
                faults.push(CauseFault::OtherDatum(describe.datum_name(number), named, active));
            }
            if let Input::Length(quantity, axis, length) = input {
                faults.extend(self.other_length(event, quantity, axis, length, describe));
            }
            let Some((bit, named)) = input.signal() else { continue };
            let (name, named) = (signal_name(bit, describe.names()), u64::from(named));
            match seen.values(bit) {
                None => faults.push(CauseFault::Unknown(name)),
                Some(values) if values.contains(&named) => {}
                Some([now, _]) => faults.push(CauseFault::Untrue(name, named, now)),
            }
        }
        faults
    }

    /// The fault of a length or a velocity that the axis had neither in the cycle of the event nor in the one before.
    fn other_length(
        &self,
        event: &Event,
        quantity: Quantity,
        axis: AxisNumber,
        length: Position,
        describe: &dyn Describe,
    ) -> Option<CauseFault> {
        let values = self.measured.as_ref()?.values(event.id, event.cycle, axis)?;
        let per_turn = per_turn(axis, describe);
        let cycle = self.time(event.cycle) - self.time(event.cycle.saturating_sub(1));
        let possible = possible(quantity, values, per_turn, describe.half_count(axis), cycle)?;
        let (name, named) = input_name(quantity, length, per_turn, describe.names().interface());
        let found = possible.first()?.value;
        let is_true = possible.into_iter().any(|possible| possible.is(named));
        let name = format!("{}.{name}", axis_name(axis, describe.names()));
        (!is_true).then_some(CauseFault::OtherLength(name, named, found))
    }
}

/// The memory and the alarms at the end of a cycle, and the changes in this cycle.
struct Seen<'a> {
    memory: &'a Memory,
    /// The memory with the PLC's half as the control reads it, if it reads it late.
    read: Option<&'a Memory>,
    /// Also alarms that are cleared in this cycle.
    pending: &'a [RaisedAlarm],
    /// The machine data that became active so far.
    data: &'a BTreeMap<DatumKey, f64>,
    /// The machine data that become active anywhere in the trace.
    activated: &'a BTreeSet<DatumKey>,
    bits: &'a [Bits],
    interface: &'static Interface,
}

impl Seen<'_> {
    /// The active value of a machine datum: the latest one in the trace; for a datum without a row, the one that was active from the start.
    fn active(&self, key: DatumKey, describe: &dyn Describe) -> Option<f64> {
        if self.activated.contains(&key) {
            return self.data.get(&key).copied();
        }
        let (number, index, axis) = key;
        describe.active_datum(number, index, axis)
    }

    /// The values that a signal had when it could be tested: as it is now, and for a signal of the control also as it was before. `None`
    /// if no signal begins at this bit.
    fn values(&self, bit: SignalBit) -> Option<[u64; 2]> {
        let (_, number) = bit.place.block();
        let signal = signal_at(bit, self.interface)?;
        let location = self.interface.location(signal, number)?;
        let memory = self.read.filter(|_| location.part == Part::ToNck).unwrap_or(self.memory);
        let now = memory.read(location);
        if !matches!(location.part, Part::FromNck | Part::Hmi) {
            return Some([now; 2]);
        }
        let is_here = |bits: &&Bits| (bits.part, bits.offset) == (location.part, location.offset);
        let before = self.bits.iter().find(is_here).map(|bits| bits.old & mask_in_byte(location, bits.offset));
        Some([now, before.map_or(now, |before| u64::from(before >> location.bit))])
    }
}

/// The number, the index and the axis of a machine datum.
type DatumKey = (u32, Option<u8>, Option<AxisNumber>);

fn key(datum: &DatumValue) -> DatumKey {
    (datum.number, datum.index, axis_of(datum.place))
}

fn active_datum(row: &Row) -> Option<DatumKey> {
    match &row.change {
        Change::Happened { what: Happening::DatumActive(datum), .. } => Some(key(datum)),
        Change::Byte { .. }
        | Change::Alarm { .. }
        | Change::Happened { .. }
        | Change::Overwritten { .. }
        | Change::NoEffect(_) => None,
    }
}

fn axis_of(place: Place) -> Option<AxisNumber> {
    match place {
        Place::Axis(axis) => Some(axis),
        Place::Nck | Place::ModeGroup(_) | Place::Channel(_) => None,
    }
}

#[cfg(test)]
mod tests;
