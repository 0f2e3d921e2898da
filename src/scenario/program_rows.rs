//! Why the PLC program changed bits, from the machine to the trace.

use std::sync::Arc;

use crate::image::{Format, Location, Names, Part};
use crate::machine::Machine;
use crate::plc::{ProgramCause, Tested};
use crate::trace::{ProgramRow, Trace};

/// Why the PLC program changed bits in the last cycle, for the trace.
pub(crate) fn program_rows(machine: &Machine) -> impl Iterator<Item = ProgramRow> {
    let names = machine.names();
    let tested = move |tested: &Tested| {
        Some(match *tested {
            Tested::Bit(location, value) => (location, value.into()),
            Tested::Word(location, value) => (in_its_format(location, names), value.into()),
            Tested::Timer(number, status) => (word(Part::Timers, number), status.into()),
            Tested::TimerValue(number, value) => (word(Part::Timers, number), value.into()),
            Tested::Counter(number, status) => (word(Part::Counters, number), status.into()),
            Tested::CounterValue(number, value) => (word(Part::Counters, number), value.into()),
            Tested::Operation(..) => return None,
        })
    };
    let operation = |tested: &Tested| match tested {
        Tested::Operation(text, value) => Some((Arc::clone(text), *value)),
        _ => None,
    };
    machine.program_causes().into_iter().map(move |cause| {
        let ProgramCause { part, bit, bits, value, statement, tested: operands } = cause;
        let operations = operands.iter().filter_map(operation).collect();
        let tested = operands.iter().filter_map(tested).collect();
        ProgramRow { cycle: machine.cycle(), part, bit, bits, value: value != 0, statement, tested, operations }
    })
}

/// The word of a timer or a counter.
pub(super) fn word(part: Part, number: u16) -> Location {
    Location { part, offset: u32::from(number) * 2, bit: 0, width: 16, format: Format::Unsigned }
}

/// A word in the number format of its signal, if it is one.
pub(super) fn in_its_format(location: Location, names: &Names) -> Location {
    let formats = [Format::Unsigned, Format::Signed, Format::Real];
    let mut typed = formats.into_iter().map(|format| Location { format, ..location });
    typed.find(|typed| names.symbol(*typed).is_some()).unwrap_or(location)
}

/// A trace that begins with a machine.
pub(super) fn begun(machine: &Machine) -> Trace {
    let mut trace = Trace::begin(machine.memory(), machine.cycle_time(), machine.cycle(), machine.time());
    remember(&mut trace, machine);
    trace
}

/// Takes over the memory and the symbols of a program that was loaded before the first cycle.
pub(super) fn remember(trace: &mut Trace, machine: &Machine) {
    trace.remember(machine.memory());
    if let Some(symbols) = machine.program_symbols() {
        trace.name_program(symbols);
    }
}
