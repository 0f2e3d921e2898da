//! A machine at work: what a test in Rust does with it, step by step, and what the scenario runner does for a file.
//!
//! Time stands still between the calls; `run`, `wait`, `hold` and `pulse` let it pass, in whole cycles. "Now" is the
//! state after the last cycle plus what this session has written and no cycle has taken up yet.

use std::path::Path;

use super::duration::Duration;
use super::failure::Failure;
use super::naming::{Known, axis_named, check_captured_name, writable};
use super::passing::{Book, Next};
use super::steps::Action;
use super::values::Setting;
use crate::expression::Expression;
use crate::image::Location;
use crate::machine::{Command, DatumValue, Fault, FaultKind, Machine};
use crate::plc::PlcProgram;
use crate::source::Problem;
use crate::trace::{Head, Trace, Watch};
use crate::units::Time;

/// A machine with its growing trace.
///
/// ```no_run
/// use opennck::scenario::Session;
///
/// let mut session = Session::open("g1_example")?;
/// session.set("X.traversing_key_plus", 1)?;
/// session.wait("X.gantry_synchronization_ready_to_start", "60s")?;
/// session.expect("abs(XF.synchronism_difference) < 0.001")?;
/// # Ok::<(), opennck::scenario::Failure>(())
/// ```
pub struct Session {
    pub(super) machine: Machine,
    pub(super) trace: Trace,
    pub(super) watch: Watch,
    pub(super) book: Book,
}

impl Session {
    /// Opens a machine: a directory, an archive file, or the name of a built-in one.
    ///
    /// # Errors
    /// Its files cannot be used.
    pub fn open(machine: impl AsRef<Path>) -> Result<Self, Failure> {
        Ok(Self::new(Machine::open(machine)?))
    }

    /// A session with a machine that is already open.
    #[must_use]
    pub fn new(machine: Machine) -> Self {
        Self {
            trace: Trace::begin(machine.memory(), machine.cycle_time(), machine.cycle()),
            watch: Watch::default(),
            book: Book::new(&machine),
            machine,
        }
    }

    /// The same session with a PLC program.
    #[must_use]
    pub fn with_program(mut self, program: Box<dyn PlcProgram>) -> Self {
        self.machine.load_program(program);
        self
    }

    /// The machine.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Everything that changed so far.
    #[must_use]
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// The trace for people, with causes.
    #[must_use]
    pub fn text(&self) -> String {
        self.rows(true)
    }

    /// The trace without causes, as golden files have it: for snapshots, which a better wording must not break.
    #[must_use]
    pub fn sequence(&self) -> String {
        self.rows(false)
    }

    pub(super) fn rows(&self, causes: bool) -> String {
        self.trace.text(&self.machine, &self.watch, causes)
    }

    /// The trace for programs, as JSON lines.
    #[must_use]
    pub fn json_lines(&self) -> String {
        self.trace.json_lines(&self.machine, &self.watch)
    }

    /// The trace as a waveform, for GTKWave and its kind.
    #[must_use]
    pub fn vcd(&self) -> String {
        self.trace.vcd(&self.machine, &self.watch)
    }

    /// The trace as a timing diagram.
    #[must_use]
    pub fn svg(&self, head: &Head) -> String {
        self.trace.svg(&self.machine, &self.watch, head)
    }

    /// Since the start of the session.
    #[must_use]
    pub fn time(&self) -> Time {
        self.book.time(&self.machine)
    }

    /// Chooses what the texts of the trace show, as `watch` of a scenario does; values are noted from now on.
    ///
    /// # Errors
    /// An entry names nothing.
    pub fn watch(&mut self, entries: &[&str]) -> Result<(), Failure> {
        let watch = Watch::parse(entries, self.machine.names(), self.machine.memory());
        self.set_watch(watch.map_err(|(_, problem)| problem)?);
        Ok(())
    }

    pub(super) fn set_watch(&mut self, watch: Watch) {
        self.trace.watch_values(&watch, self.machine.cycle(), self.machine.variables());
        self.watch = watch;
    }

    /// Writes a signal once, in the next cycle; the PLC program may overwrite it.
    ///
    /// # Errors
    /// There is no such signal, the NCK writes it, or the value does not fit.
    pub fn set(&mut self, signal: &str, value: impl Into<Setting>) -> Result<(), Failure> {
        let (location, bits) = self.resolved(signal, value.into())?;
        self.queue(Command::Write { location, value: bits })
    }

    /// Holds a signal after every scan of the PLC program, until it is released.
    ///
    /// # Errors
    /// As [`Session::set`].
    pub fn force(&mut self, signal: &str, value: impl Into<Setting>) -> Result<(), Failure> {
        let (location, bits) = self.resolved(signal, value.into())?;
        self.queue(Command::Force { location, value: bits })
    }

    /// Ends the forcing of a signal.
    ///
    /// # Errors
    /// There is no such signal.
    pub fn release(&mut self, signal: &str) -> Result<(), Failure> {
        let location = writable(&self.machine, signal)?;
        self.queue(Command::Release { location })
    }

    fn resolved(&self, signal: &str, value: Setting) -> Result<(Location, u64), Problem> {
        let location = writable(&self.machine, signal)?;
        Ok((location, value.bits(signal, location, self.machine.override_coding())?))
    }

    /// Sets a bit for 100 ms and resets it; ends one cycle after that, in which the bit is 0 again.
    ///
    /// # Errors
    /// There is no such bit, the NCK writes it, or something that must hold in every cycle did not.
    pub fn pulse(&mut self, signal: &str) -> Result<(), Failure> {
        self.pulse_for(signal, "100ms")
    }

    /// Sets a bit for this long and resets it; ends one cycle after that, in which the bit is 0 again.
    ///
    /// # Errors
    /// As [`Session::pulse`].
    pub fn pulse_for(&mut self, signal: &str, time: &str) -> Result<(), Failure> {
        let location = writable(&self.machine, signal)?;
        let cycles = self.cycles(time)?;
        self.act(&Action::Pulse(vec![location], cycles))
    }

    /// Lets time pass.
    ///
    /// # Errors
    /// It is no duration, or something that must hold in every cycle did not.
    pub fn run(&mut self, time: &str) -> Result<(), Failure> {
        let cycles = self.cycles(time)?;
        self.act(&Action::Run(cycles))
    }

    /// Lets time pass until an expression is true; goes on in the cycle in which it became true.
    ///
    /// # Errors
    /// The time has passed; the failure says what every signal in the expression was then.
    pub fn wait(&mut self, expression: &str, within: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        let within = self.cycles(within)?;
        self.act(&Action::Wait(expression, Some(within)))
    }

    /// Lets time pass, in every cycle of which an expression must be true; it must be true now, too.
    ///
    /// # Errors
    /// It was false; the failure says what every signal in it was then.
    pub fn hold(&mut self, expression: &str, during: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        let during = self.cycles(during)?;
        self.act(&Action::Hold(expression, during))
    }

    /// An expression must be true now.
    ///
    /// # Errors
    /// It is not; the failure says what every signal in it is.
    pub fn expect(&mut self, expression: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        self.book.expect(&expression, &self.machine)
    }

    /// What an expression is now.
    ///
    /// # Errors
    /// It is no expression, or a name in it is unknown.
    pub fn value(&self, expression: &str) -> Result<f64, Failure> {
        let expression = self.expression(expression)?;
        Ok(self.book.evaluated(&expression, &self.machine))
    }

    /// Keeps a value for later expressions.
    ///
    /// # Errors
    /// The name is not plain, or the expression cannot be used.
    pub fn capture(&mut self, name: &str, expression: &str) -> Result<f64, Failure> {
        check_captured_name(name)?;
        let expression = self.expression(expression)?;
        let names = &mut self.book.captured_names;
        let known = names.iter().position(|known| known == name);
        let index = known.unwrap_or(names.len());
        if known.is_none() {
            names.push(name.to_owned());
        }
        Ok(self.book.keep(index, &expression, &self.machine))
    }

    /// Stores a machine datum, as `34090[XF]`; it acts when its class says.
    ///
    /// # Errors
    /// There is no such machine datum, or it refuses the value.
    pub fn machine_data(&mut self, target: &str, value: impl Into<Setting>) -> Result<(), Failure> {
        let value = match value.into() {
            Setting::Integer(number) => DatumValue::Integer(number),
            Setting::Float(number) => DatumValue::Real(number),
            Setting::Boolean(value) => DatumValue::Boolean(value),
            Setting::Text(text) => DatumValue::Text(text),
        };
        self.queue(Command::MachineDatum { target: target.to_owned(), value })
    }

    /// "Set machine data active".
    ///
    /// # Errors
    /// The machine refuses it.
    pub fn new_conf(&mut self) -> Result<(), Failure> {
        self.queue(Command::NewConf)
    }

    /// Off and on again.
    ///
    /// # Errors
    /// The machine refuses it.
    pub fn power_on(&mut self) -> Result<(), Failure> {
        self.queue(Command::PowerOn)
    }

    /// Stops the PLC.
    ///
    /// # Errors
    /// The machine refuses it.
    pub fn plc_stop(&mut self) -> Result<(), Failure> {
        self.queue(Command::PlcStop)
    }

    /// Restarts the PLC.
    ///
    /// # Errors
    /// The machine refuses it.
    pub fn plc_run(&mut self) -> Result<(), Failure> {
        self.queue(Command::PlcRun)
    }

    /// The operator's alarm-cancel key.
    ///
    /// # Errors
    /// The machine refuses it.
    pub fn cancel(&mut self) -> Result<(), Failure> {
        self.queue(Command::Cancel)
    }

    /// Makes something break on an axis.
    ///
    /// # Errors
    /// There is no such axis.
    pub fn fault(&mut self, axis: &str, kind: FaultKind) -> Result<(), Failure> {
        let axis = axis_named(&self.machine, axis)?;
        self.queue(Command::Fault(Fault { axis, kind }))
    }

    /// Repairs it.
    ///
    /// # Errors
    /// There is no such axis.
    pub fn clear_fault(&mut self, axis: &str, kind: FaultKind) -> Result<(), Failure> {
        let axis = axis_named(&self.machine, axis)?;
        self.queue(Command::ClearFault(Fault { axis, kind }))
    }

    /// Notes a text in the trace, at the time of the next cycle.
    pub fn note(&mut self, text: &str) {
        self.trace.note(self.machine.cycle() + 1, text);
    }

    /// A second session that goes its own way from here.
    ///
    /// # Errors
    /// The PLC program cannot be copied.
    pub fn fork(&self) -> Result<Self, Failure> {
        Ok(Self {
            machine: self.machine.fork()?,
            trace: self.trace.clone(),
            watch: self.watch.clone(),
            book: self.book.clone(),
        })
    }

    /// Queues a command for the next cycle.
    fn queue(&mut self, command: Command) -> Result<(), Failure> {
        self.book.queue(command, &mut self.machine)
    }

    /// Does what a step does.
    fn act(&mut self, action: &Action) -> Result<(), Failure> {
        let mut passed = 0;
        while self.book.go_on(action, passed, &mut self.machine)? == Next::Cycle {
            let begun = self.book.begin_cycle(&self.machine);
            let ended = begun.and_then(|()| {
                self.cycle();
                self.book.end_cycle(&self.machine)
            });
            ended.map_err(|stopped| self.book.stopped(&stopped, action, passed, &self.machine))?;
            passed += 1;
        }
        Ok(())
    }

    /// One cycle, and its record.
    pub(super) fn cycle(&mut self) {
        self.machine.step();
        self.trace.extend(self.machine.recorder());
        self.book.note_changes(&self.machine);
        self.machine.drain();
        self.trace.note_values(self.machine.cycle(), self.machine.variables());
    }

    fn cycles(&self, time: &str) -> Result<u64, Problem> {
        Ok(Duration::parse(time)?.cycles(self.machine.cycle_time()))
    }

    fn expression(&self, source: &str) -> Result<Expression, Problem> {
        Expression::parse(source, &Known { machine: &self.machine, captured: &self.book.captured_names })
    }
}
