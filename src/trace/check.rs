//! Checks the causes in a trace: replays the record and compares each cause with it. Called after a run, on its complete trace.
//!
//! The cause of an edge is an event. It is correct if the event happened in the cycle of the edge, if it has an input or a parent event,
//! and if each signal among its inputs had the value in the event. For a signal of the PLC, this is the value at the end of the cycle, after
//! inputs, scan and forces. For a signal of the control, it is the value decided in the cycle or the value published in the cycle before.
//! Machine data, lengths and alarms among the inputs are not compared.

use std::fmt;

use super::because::because;
use super::places::Places;
use super::printable::{mask_in_byte, signal_at, signal_name};
use super::{By, Change, Row, Trace, Watch};
use crate::image::{Format, Interface, Location, Memory, Part};
use crate::units::Time;
use crate::variables::{Describe, Event, Input, SignalBit};

/// A wrong or missing cause.
#[derive(Clone, Debug, PartialEq)]
pub struct CauseFinding {
    /// When the signal changed, since the start of the trace.
    pub time: Time,
    /// The signal: its symbol and its address.
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
    /// The event contains these bits, which are no signal.
    Unknown(String),
}

impl fmt::Display for CauseFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: ", self.time, self.signal)?;
        match &self.fault {
            CauseFault::Missing => f.write_str("no cause")?,
            CauseFault::Empty => f.write_str("the cause has neither an input nor a parent event")?,
            CauseFault::AnotherCycle(time) => write!(f, "the cause is an event at {time} s")?,
            CauseFault::Untrue(signal, named, found) => write!(f, "the cause names {signal} = {named}, found {found}")?,
            CauseFault::Unknown(bits) => write!(f, "the cause names {bits}, which is no signal")?,
        }
        self.because.as_ref().map_or(Ok(()), |because| write!(f, " ({because})"))
    }
}

impl Trace {
    /// Checks the cause of each edge of the control, for the signals selected by `watch`. If the trace lost rows, the findings after them
    /// are not reliable.
    #[must_use]
    pub fn check_causes(&self, describe: &dyn Describe, watch: &Watch) -> Vec<CauseFinding> {
        let names = describe.names();
        let mut places = Places::new(names, watch);
        let mut memory = self.start.clone();
        let mut findings = Vec::new();
        for rows in self.rows.chunk_by(|one, next| one.cycle == next.cycle) {
            let cycle = rows[0].cycle;
            for row in rows {
                if let Change::Byte { part, offset, new, .. } = row.change {
                    memory.write(byte(part, offset), new.into());
                }
            }
            let seen = Seen { memory: &memory, rows, interface: names.interface() };
            for row in rows {
                let Change::Byte { part, offset, old, new, by, causes } = row.change else { continue };
                for printable in places.at(part, offset) {
                    let changed = (old ^ new) & mask_in_byte(printable.location, offset);
                    let bit = changed.trailing_zeros() as usize;
                    if changed == 0 || by[bit] != By::Nck {
                        continue;
                    }
                    let event = self.event(causes[bit], cycle);
                    let signal = match &printable.symbol {
                        Some(symbol) => format!("{symbol} ({})", printable.address),
                        None => printable.address.clone(),
                    };
                    findings.extend(self.faults(event, cycle, &seen, describe).into_iter().map(|fault| CauseFinding {
                        time: self.time(cycle),
                        signal: signal.clone(),
                        because: event.map(|event| because(event, describe)),
                        fault,
                    }));
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
}

/// The memory at the end of a cycle, and the changes in this cycle.
struct Seen<'a> {
    memory: &'a Memory,
    rows: &'a [Row],
    interface: &'static Interface,
}

impl Seen<'_> {
    /// The values that a signal had when it could be tested: as it is now, and for a signal of the control also as it was before. `None`
    /// if no signal begins at this bit.
    fn values(&self, bit: SignalBit) -> Option<[u64; 2]> {
        let (_, number) = bit.place.block();
        let signal = signal_at(bit, self.interface)?;
        let location = self.interface.location(signal, number)?;
        let now = self.memory.read(location);
        if !matches!(location.part, Part::FromNck | Part::Hmi) {
            return Some([now; 2]);
        }
        let before = self.rows.iter().find_map(|row| match row.change {
            Change::Byte { part, offset, old, .. } if (part, offset) == (location.part, location.offset) => {
                Some(u64::from((old & mask_in_byte(location, offset)) >> location.bit))
            }
            Change::Byte { .. } | Change::Alarm { .. } | Change::Happened { .. } | Change::Overwritten { .. } => None,
        });
        Some([now, before.unwrap_or(now)])
    }
}

const fn byte(part: Part, offset: u32) -> Location {
    Location { part, offset, bit: 0, width: 8, format: Format::Unsigned }
}

#[cfg(test)]
mod tests;
