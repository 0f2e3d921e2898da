//! The events in a trace: consecutively numbered, each with the inputs that it tested and the event that led to it.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::Trace;
use super::because::{because, by_program, input_name, per_turn};
use super::history::ProgramRow;
use super::lines::{Line, LineKind};
use super::printable::{Shown, signal_at};
use crate::image::{Location, Names, Part};
use crate::units::Time;
use crate::variables::{AlarmNumber, Describe, Event, Input, Place, SignalBit, place_name, six_decimals};

/// An event: a transition of the control, with its rule, its inputs and the event that led to it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cause {
    /// The number in the trace, from one.
    pub(super) number: u32,
    pub(super) time: Time,
    /// The place: `X`, `CHAN1`.
    pub(super) place: String,
    /// The ID of the rule: `REF-11`.
    pub(super) rule: String,
    /// Rule and inputs, in the same form as in all texts of a trace.
    pub(super) because: String,
    pub(super) inputs: Vec<CauseInput>,
    /// The event that led to it; zero for none.
    pub(super) parent: u32,
}

/// An input that was tested, with its value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum CauseInput {
    /// A signal by address, and by symbol if it has one.
    Signal { address: String, symbol: Option<String>, value: String },
    /// A machine datum, in the notation of scenarios: `37110[XF]`, `36012[0,XF]`.
    Datum(String, f64),
    /// A value that is not a signal, with six decimals.
    Value(String, String),
    /// An alarm: its number, or its name if it has only a name.
    Alarm(String),
    /// A fault, by its name in scenarios.
    Fault(String),
    /// A block of a program, by its number, label or line.
    Block(String),
    /// A timer or a counter of the PLC, and its status, or the value that was loaded.
    Timer(String, u64),
}

impl CauseInput {
    fn of(input: &Input, describe: &dyn Describe) -> Option<Self> {
        let names = describe.names();
        Some(match *input {
            Input::None => return None,
            Input::Bit(bit, value) => Self::signal(bit, value.into(), names)?,
            Input::Number(bit, value) => Self::signal(bit, value, names)?,
            Input::Datum(number, axis, value) => {
                let axis = axis.map(|axis| format!("[{}]", place_name(Place::Axis(axis), names)));
                Self::Datum(format!("{number}{}", axis.unwrap_or_default()), value)
            }
            Input::Element(number, index, axis, value) => {
                Self::Datum(format!("{number}[{index},{}]", place_name(Place::Axis(axis), names)), value)
            }
            Input::Length(quantity, axis, length) => {
                let (name, value) = input_name(quantity, length, per_turn(axis, describe), names.interface());
                Self::Value(format!("{}.{name}", place_name(Place::Axis(axis), names)), six_decimals(value))
            }
            Input::Fault(fault) => Self::Fault(fault.name().to_owned()),
            Input::Block(name) => Self::Block(name.to_string()),
            Input::Alarm(number) => Self::Alarm(describe.alarm_name(AlarmNumber(number))),
        })
    }

    fn signal(bit: SignalBit, value: u8, names: &Names) -> Option<Self> {
        let signal = signal_at(bit, names.interface())?;
        let (_, number) = bit.place.block();
        let location = names.interface().location(signal, number)?;
        let address = names.address(location).to_string();
        Some(Self::Signal { address, symbol: names.symbol(location), value: value.to_string() })
    }
}

impl Trace {
    /// The text of the event with this number.
    pub(super) fn cause(&self, number: u32, describe: &dyn Describe) -> Option<Cause> {
        let names: &Names = describe.names();
        if let Some(row) = self.program_numbered(number) {
            return Some(self.cause_in_program(number, row, names));
        }
        let event: &Event = self.event_numbered(number)?;
        Some(Cause {
            number,
            time: self.time(event.cycle),
            place: place_name(event.place, names),
            rule: describe.rule(event.rule).id.to_owned(),
            because: because(event, describe),
            inputs: event.inputs.iter().filter_map(|input| CauseInput::of(input, describe)).collect(),
            parent: self.event_number(event.parent, event.cycle),
        })
    }

    fn cause_in_program(&self, number: u32, row: &ProgramRow, names: &Names) -> Cause {
        let input = |&(location, value): &(Location, u64)| {
            let address = names.address(location).to_string();
            match location.part {
                Part::Timers | Part::Counters => CauseInput::Timer(address, value),
                _ => {
                    let value = Shown::of(location, value).to_string();
                    CauseInput::Signal { address, symbol: names.symbol(location), value }
                }
            }
        };
        let operation =
            |(text, value): &(Arc<str>, bool)| CauseInput::Value(text.to_string(), u8::from(*value).to_string());
        Cause {
            number,
            time: self.time(row.cycle),
            place: "PLC".to_owned(),
            rule: "PLC".to_owned(),
            because: by_program(self, row, names),
            inputs: row.tested.iter().map(input).chain(row.operations.iter().map(operation)).collect(),
            parent: 0,
        }
    }

    /// The events that caused these lines, and the events that led to them, in order.
    pub(super) fn causes_of(&self, lines: &[Line], describe: &dyn Describe) -> Vec<Cause> {
        let mut wanted = BTreeSet::new();
        for line in lines {
            let mut number = match &line.kind {
                LineKind::Signal(signal) => signal.event,
                LineKind::Alarm(alarm) => alarm.event,
                LineKind::Happening(happening) => happening.event,
                LineKind::Note(_) | LineKind::Value(..) | LineKind::Text(..) => 0,
            };
            if self.program_numbered(number).is_some() {
                wanted.insert(number);
                continue;
            }
            while let Some(event) = self.event_numbered(number) {
                if !wanted.insert(number) {
                    break;
                }
                number = self.event_number(event.parent, event.cycle);
            }
        }
        let mut causes: Vec<_> = wanted.into_iter().filter_map(|number| self.cause(number, describe)).collect();
        // Those of the PLC program have numbers behind all events.
        causes.sort_by_key(|cause| cause.time);
        causes
    }
}
