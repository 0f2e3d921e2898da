//! A machine together with the clock and the diagnostic buffer of its CPU, its recording, its trace, and the scenario that runs on it. The
//! stepping thread changes it under the lock in `shared.rs`.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::causes::Causes;
use super::diagnosis::Buffer;
use super::following::Collected;
use super::history::History;
use super::inbox::Order;
use super::record::Recording;
use super::seen::Seen;
use crate::machine::Machine;
use crate::scenario::{Operator, State, program_rows};
use crate::source::Problem;
use crate::trace::{Trace, Watch};
use crate::units::Time;

/// A machine with its clock, diagnostic buffer, recording, trace and scenario.
#[derive(Debug)]
pub(super) struct Clocked {
    pub(super) machine: Machine,
    /// The number of steps taken since the start.
    steps: u64,
    diagnosis: Buffer,
    /// The time to which the clock was last set, and the machine time at that moment.
    set: SystemTime,
    set_at: Time,
    pub(super) recording: Option<Recording>,
    trace: Option<(Trace, Watch)>,
    /// The most bytes of memory for the trace; `None` when they are used up.
    trace_bytes: Option<usize>,
    pub(super) operator: Option<Operator>,
    /// The record for a server that follows the machine.
    pub(super) collected: Option<Collected>,
    /// The last minutes.
    pub(super) history: Option<History>,
    /// Why the pending alarms were raised.
    causes: Causes,
}

/// The trace that is kept, and the most bytes of memory for it.
#[derive(Debug)]
pub(super) struct Kept {
    pub(super) watch: Watch,
    pub(super) bytes: usize,
}

impl Clocked {
    pub(super) fn new(
        machine: Machine,
        recording: Option<Recording>,
        trace: Option<Kept>,
        operator: Option<Operator>,
    ) -> Self {
        let trace_bytes = trace.as_ref().map(|kept| kept.bytes);
        let trace = trace.map(|Kept { watch, .. }| {
            let mut trace = Trace::begin(machine.memory(), machine.cycle_time(), machine.cycle(), machine.time());
            trace.watch_values(&watch, machine.cycle(), machine.variables());
            (trace, watch)
        });
        let set = today();
        let (diagnosis, set_at) = (Buffer::new(&machine, set), machine.time());
        let (collected, history, causes) = (None, None, Causes::default());
        let steps = 0;
        Self {
            diagnosis,
            set,
            set_at,
            steps,
            machine,
            recording,
            trace,
            trace_bytes,
            operator,
            collected,
            history,
            causes,
        }
    }

    /// The number of steps taken since the start.
    pub(super) fn steps(&self) -> u64 {
        self.steps
    }

    /// The machine and its trace, at the end.
    pub(super) fn into_parts(self) -> (Machine, Option<(Trace, Watch)>) {
        (self.machine, self.trace)
    }

    /// The copy of the current state for clients.
    pub(super) fn seen(&self) -> Box<Seen> {
        let (machine, diagnosis) = (self.machine.snapshot(), self.diagnosis.entries());
        let clock = clock(self.set, self.machine.time() - self.set_at);
        let scenario = self.operator.as_ref().map(|operator| (operator.state().clone(), operator.index()));
        let reach = self.history.as_ref().map(History::reach);
        Box::new(Seen { step: self.steps, machine, clock, diagnosis, scenario, reach, causes: self.causes.clone() })
    }

    /// Queues the orders of clients. Returns a log line for each command that the machine rejects.
    pub(super) fn take(&mut self, orders: Vec<Order>) -> Vec<String> {
        let mut lines = Vec::new();
        for Order { client, commands, clock } in orders {
            if let Some(recording) = &mut self.recording {
                recording.client(&self.machine, client);
            }
            for command in commands {
                self.diagnosis.ordered(&command);
                if let Err(problem) = self.machine.queue(command) {
                    lines.push(format!("rejected a command of a client: {problem}"));
                }
            }
            if let Some(time) = clock {
                (self.set, self.set_at) = (time, self.machine.time());
            }
        }
        lines
    }

    /// Takes one step. Returns a log line if the PLC program stopped the PLC or the PLC starts again, and if the scenario or the trace ended in
    /// this step.
    pub(super) fn step(&mut self) -> Vec<String> {
        let Self { machine, steps, recording, trace, trace_bytes, operator, collected, history, causes, .. } = self;
        let mut lines = Vec::new();
        let was_at_work = operator.as_ref().is_some_and(|operator| *operator.state() == State::Acting);
        if was_at_work && let Some(operator) = operator {
            let queued = machine.queued().len();
            for note in operator.act(machine) {
                if let (Some((trace, _)), Some(_)) = (&mut *trace, &*trace_bytes) {
                    trace.note(machine.cycle() + 1, note.clone());
                }
                if let Some(recording) = recording {
                    recording.note(&note);
                }
                if let Some(collected) = collected {
                    collected.note(machine, &note);
                }
                if let Some(history) = history {
                    history.note(&note);
                }
            }
            if let Some(recording) = recording {
                recording.remark(queued, "the scenario".to_owned());
            }
        }
        if let Some(recording) = recording {
            recording.edge(machine);
        }
        if let Some(history) = history {
            history.edge(machine);
        }
        let was_faulty = machine.program_fault().is_some();
        machine.step();
        *steps += 1;
        match machine.program_fault() {
            Some(fault) if !was_faulty => lines.push(format!("the PLC stops: {}", fault.replace("\n ", ";"))),
            None if was_faulty => lines.push("the PLC starts again".to_owned()),
            Some(_) | None => {}
        }
        causes.observe(machine);
        if let Some(collected) = collected {
            collected.extend(machine);
        }
        if let (Some((trace, _)), &mut Some(most)) = (trace, &mut *trace_bytes) {
            trace.extend(machine.recorder());
            trace.extend_causes(machine.cycle(), program_rows(machine));
            trace.note_fault(machine.recorder(), machine.program_fault());
            trace.end_cycle(machine.cycle(), machine.time(), machine.variables());
            if trace.bytes() > most {
                let mib = most / (1024 * 1024);
                // In the next cycle, which has no rows: the notes of a cycle stand before its rows.
                trace.note(machine.cycle() + 1, format!("the trace ends here: it has reached its limit of {mib} MiB"));
                lines.push(format!("the trace has reached its limit of {mib} MiB and ends; the machine keeps running"));
                *trace_bytes = None;
            }
        }
        if was_at_work && let Some(operator) = operator {
            operator.look(machine);
        }
        machine.drain();
        lines.extend(match operator.as_ref().filter(|_| was_at_work).map(Operator::state) {
            None | Some(State::Acting) => None,
            Some(State::Done) => Some("the scenario passed".to_owned()),
            Some(State::Failed(failure)) => Some(format!("the scenario failed: {failure}")),
        });
        lines
    }

    /// Goes back to the end of a cycle, instead of a step. A scenario that was running ends.
    pub(super) fn go_back(&mut self, cycle: u64) -> Result<(), Problem> {
        self.steps += 1;
        let cure = "start the machine without the option: what it writes cannot be taken back";
        for (is_on, option) in [(self.recording.is_some(), "--record"), (self.trace.is_some(), "--trace")] {
            if is_on {
                return Err(Problem::new(format!("the machine cannot go back in time: it runs with {option}"), cure));
            }
        }
        let Some(history) = &mut self.history else {
            return Err(Problem::new("the machine cannot go back in time: it keeps no history", "start it with --web"));
        };
        let now = self.machine.cycle();
        if cycle > now {
            let what = format!("expected a moment of the past, found cycle {cycle}; the machine is in cycle {now}");
            return Err(Problem::new(what, "let it run to see what will be"));
        }
        self.machine = history.back_to(cycle)?;
        self.operator = None;
        self.causes.forget_after(cycle);
        self.collected = self.collected.take().map(|_| Collected::new(&self.machine));
        Ok(())
    }

    /// Adds the CPU events of a step to the diagnostic buffer.
    pub(super) fn observe(&mut self) {
        let Self { machine, diagnosis, set, set_at, .. } = self;
        diagnosis.observe(machine, || clock(*set, machine.time() - *set_at));
    }
}

/// The clock after a time since it was set, in whole milliseconds. It advances with machine time, at any speed.
fn clock(set: SystemTime, since: Time) -> SystemTime {
    set + Duration::from_millis(u64::try_from(since.nanos() / 1_000_000).unwrap_or(0))
}

/// The clock of the computer, in whole milliseconds. The clock of a CPU starts in 1990, that of a computer without a battery in 1970.
fn today() -> SystemTime {
    /// From 1970 to 1990.
    const EARLIER: Duration = Duration::from_secs(7305 * 86_400);
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().max(EARLIER);
    UNIX_EPOCH + Duration::from_millis(u64::try_from(since.as_millis()).unwrap_or(0))
}
