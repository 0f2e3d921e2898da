//! Why the PLC program changed bits, from the machine to the trace.

use crate::image::{Format, Location, Part};
use crate::machine::Machine;
use crate::plc::{ProgramCause, Tested};
use crate::trace::{ProgramRow, Trace};

/// Why the PLC program changed bits in the last cycle, for the trace.
pub(super) fn program_rows(machine: &Machine) -> impl Iterator<Item = ProgramRow> {
    let word = |part, number: u16| {
        let offset = u32::from(number) * 2;
        Location { part, offset, bit: 0, width: 16, format: Format::Unsigned }
    };
    let tested = move |tested: &Tested| match *tested {
        Tested::Bit(location, value) => (location, value),
        Tested::Timer(number, status) => (word(Part::Timers, number), status),
        Tested::Counter(number, status) => (word(Part::Counters, number), status),
    };
    machine.program_causes().into_iter().map(move |cause| {
        let ProgramCause { part, bit, bits, value, statement, tested: operands } = cause;
        let tested = operands.iter().map(tested).collect();
        ProgramRow { cycle: machine.cycle(), part, bit, bits, value, statement, tested }
    })
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
