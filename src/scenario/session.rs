//! A machine at work: what a test in Rust does with it, step by step, and what the scenario runner does for a file.
//!
//! Time stands still between the calls; `run`, `wait`, `hold` and `pulse` let it pass, in whole cycles. "Now" is the
//! state after the last cycle plus what this session has written and no cycle has taken up yet.

use std::borrow::Cow;
use std::path::Path;

use super::duration::Duration;
use super::expression::{Expression, Moment, Scope, View};
use super::failure::{Failure, Missed};
use super::steps::{axis_named, check_captured_name, writable};
use super::values::Setting;
use crate::image::{Location, Memory};
use crate::machine::{Command, DatumValue, Fault, FaultKind, Machine};
use crate::plc::PlcProgram;
use crate::source::{Place, Problem};
use crate::trace::{Trace, Watch};
use crate::units::Time;
use crate::variables::{Describe, Variables};

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
    machine: Machine,
    trace: Trace,
    watch: Watch,
    /// The cycle that counts as time zero.
    start: u64,
    /// Bits that were written and that no cycle has taken up yet.
    pending: Vec<(Location, u64)>,
    captured_names: Vec<String>,
    captured: Vec<f64>,
    conditions: Vec<Condition>,
    /// Bound on the cycles of this session.
    limit: Option<u64>,
    /// What was shown one cycle ago, kept where an expression looks back.
    before: Option<Box<Shown>>,
}

/// What must hold in every cycle.
#[derive(Clone, Debug)]
pub(super) struct Condition {
    pub(super) expression: Expression,
    /// `always` or, if false, `never`.
    pub(super) wanted: bool,
    pub(super) place: Option<Place>,
}

/// What the machine showed after a cycle.
#[derive(Clone, Debug)]
struct Shown {
    memory: Memory,
    variables: Variables,
    time: Time,
}

/// Why a cycle was the last one.
enum Stopped {
    Limit,
    Condition(usize),
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
        let start = machine.cycle();
        Self {
            trace: Trace::begin(machine.memory(), machine.cycle_time(), start),
            watch: Watch::default(),
            start,
            pending: Vec::new(),
            captured_names: Vec::new(),
            captured: Vec::new(),
            conditions: Vec::new(),
            limit: None,
            before: Some(Box::new(Shown::of(&machine, Time::ZERO))),
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

    pub(super) fn rows(&self, causes: bool) -> String {
        self.trace.text(&self.machine, &self.watch, causes)
    }

    /// The trace for programs, as JSON lines.
    #[must_use]
    pub fn json_lines(&self) -> String {
        self.trace.json_lines(&self.machine, &self.watch)
    }

    /// Since the start of the session.
    #[must_use]
    pub fn time(&self) -> Time {
        self.machine.cycle_time().times(self.elapsed())
    }

    fn elapsed(&self) -> u64 {
        self.machine.cycle() - self.start
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

    pub(super) fn bound(&mut self, limit: Option<u64>) {
        self.limit = limit;
    }

    pub(super) fn add_condition(&mut self, condition: Condition) {
        self.conditions.push(condition);
    }

    /// Whether the state before the last cycle is kept; needed where an expression has `rose` or `fell`.
    pub(super) fn look_back(&mut self, wanted: bool) {
        self.before = wanted.then(|| Box::new(Shown::of(&self.machine, self.time())));
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
        self.pulse_locations(&[location], cycles)
    }

    pub(super) fn pulse_locations(&mut self, locations: &[Location], cycles: u64) -> Result<(), Failure> {
        for &location in locations {
            self.queue(Command::Write { location, value: 1 })?;
        }
        self.run_cycles(cycles)?;
        for &location in locations {
            self.queue(Command::Write { location, value: 0 })?;
        }
        self.run_cycles(1)
    }

    /// Lets time pass.
    ///
    /// # Errors
    /// It is no duration, or something that must hold in every cycle did not.
    pub fn run(&mut self, time: &str) -> Result<(), Failure> {
        let cycles = self.cycles(time)?;
        self.run_cycles(cycles)
    }

    pub(super) fn run_cycles(&mut self, cycles: u64) -> Result<(), Failure> {
        for done in 0..cycles {
            self.pass_cycle().map_err(|stopped| {
                let passed = self.machine.cycle_time().times(done);
                self.stopped(&stopped, &format!("after {passed} s of a run"), None)
            })?;
        }
        Ok(())
    }

    /// Lets time pass until an expression is true; goes on in the cycle in which it became true.
    ///
    /// # Errors
    /// The time has passed; the failure says what every signal in the expression was then.
    pub fn wait(&mut self, expression: &str, within: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        let within = self.cycles(within)?;
        self.wait_for(&expression, Some(within))
    }

    pub(super) fn wait_for(&mut self, expression: &Expression, within: Option<u64>) -> Result<(), Failure> {
        if self.holds(expression) {
            return Ok(());
        }
        let mut waited = 0;
        loop {
            if within.is_some_and(|within| waited >= within) {
                let what = format!("{}, and it did not become true", self.waited(waited, expression));
                return Err(self.missed(what, Some(expression)));
            }
            let before = self.pass_cycle();
            before.map_err(|stopped| self.stopped(&stopped, &self.waited(waited, expression), Some(expression)))?;
            waited += 1;
            if self.holds(expression) {
                return Ok(());
            }
        }
    }

    fn waited(&self, cycles: u64, expression: &Expression) -> String {
        format!("waited {} s for `{}`", self.machine.cycle_time().times(cycles), expression.source())
    }

    /// Lets time pass, in every cycle of which an expression must be true; it must be true now, too.
    ///
    /// # Errors
    /// It was false; the failure says what every signal in it was then.
    pub fn hold(&mut self, expression: &str, during: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        let during = self.cycles(during)?;
        self.hold_for(&expression, during)
    }

    pub(super) fn hold_for(&mut self, expression: &Expression, during: u64) -> Result<(), Failure> {
        for held in 0..=during {
            if !self.holds(expression) {
                let held = self.machine.cycle_time().times(held);
                let what = format!("expected `{}` to hold, found it false after {held} s", expression.source());
                return Err(self.missed(what, Some(expression)));
            }
            if held < during {
                self.pass_cycle().map_err(|stopped| {
                    self.stopped(&stopped, &format!("while `{}` held", expression.source()), Some(expression))
                })?;
            }
        }
        Ok(())
    }

    /// An expression must be true now.
    ///
    /// # Errors
    /// It is not; the failure says what every signal in it is.
    pub fn expect(&mut self, expression: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        self.expect_now(&expression)
    }

    pub(super) fn expect_now(&mut self, expression: &Expression) -> Result<(), Failure> {
        if self.holds(expression) {
            Ok(())
        } else {
            Err(self.missed(format!("expected `{}`, found it false", expression.source()), Some(expression)))
        }
    }

    /// These bits must be there now.
    pub(super) fn expect_bits(&mut self, location: Location, bits: u64) -> Result<(), Failure> {
        let found = self.now().read(location);
        if found == bits {
            return Ok(());
        }
        let width = usize::from(location.width);
        let names = self.machine.names();
        let address = names.address(location);
        let what = format!("expected {address} = 2#{bits:0width$b}, found 2#{found:0width$b}");
        Err(self.missed(what, None))
    }

    /// What an expression is now.
    ///
    /// # Errors
    /// It is no expression, or a name in it is unknown.
    pub fn value(&self, expression: &str) -> Result<f64, Failure> {
        let expression = self.expression(expression)?;
        Ok(self.evaluated(&expression))
    }

    /// Keeps a value for later expressions.
    ///
    /// # Errors
    /// The name is not plain, or the expression cannot be used.
    pub fn capture(&mut self, name: &str, expression: &str) -> Result<f64, Failure> {
        check_captured_name(name)?;
        let expression = self.expression(expression)?;
        let known = self.captured_names.iter().position(|known| known == name);
        let index = known.unwrap_or(self.captured_names.len());
        if known.is_none() {
            self.captured_names.push(name.to_owned());
        }
        Ok(self.keep(index, &expression))
    }

    pub(super) fn keep(&mut self, index: usize, expression: &Expression) -> f64 {
        let value = self.evaluated(expression);
        if self.captured.len() <= index {
            self.captured.resize(index + 1, f64::NAN);
        }
        self.captured[index] = value;
        value
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
            start: self.start,
            pending: self.pending.clone(),
            captured_names: self.captured_names.clone(),
            captured: self.captured.clone(),
            conditions: self.conditions.clone(),
            limit: self.limit,
            before: self.before.clone(),
        })
    }

    /// Queues a command for the next cycle.
    pub(super) fn queue(&mut self, command: Command) -> Result<(), Failure> {
        match command {
            Command::Write { location, value } | Command::Force { location, value } => {
                self.pending.push((location, value));
            }
            _ => {}
        }
        Ok(self.machine.queue(command)?)
    }

    fn cycles(&self, time: &str) -> Result<u64, Problem> {
        Ok(Duration::parse(time)?.cycles(self.machine.cycle_time()))
    }

    fn expression(&self, source: &str) -> Result<Expression, Problem> {
        let scope = Scope { memory: self.machine.memory(), describe: &self.machine, captured: &self.captured_names };
        Expression::parse(source, scope)
    }

    /// One cycle, and what must hold in it.
    fn pass_cycle(&mut self) -> Result<(), Stopped> {
        if self.limit.is_some_and(|limit| self.elapsed() >= limit) {
            return Err(Stopped::Limit);
        }
        let time = self.time();
        if let Some(before) = &mut self.before {
            **before = Shown::of(&self.machine, time);
        }
        self.machine.step();
        self.pending.clear();
        self.trace.extend(self.machine.recorder());
        self.machine.drain();
        self.trace.note_values(self.machine.cycle(), self.machine.variables());
        let broken = self.conditions.iter().position(|condition| {
            self.with_view(self.last(), |view| condition.expression.holds(view)) != condition.wanted
        });
        broken.map_or(Ok(()), |index| Err(Stopped::Condition(index)))
    }

    /// The state after the last cycle.
    fn last(&self) -> Moment<'_> {
        Moment {
            memory: self.machine.memory(),
            variables: self.machine.variables(),
            time: self.time(),
            captured: &self.captured,
        }
    }

    /// Looks at the two last cycles and at `now`.
    fn with_view<T>(&self, now: Moment<'_>, look: impl FnOnce(&View<'_>) -> T) -> T {
        let last = self.last();
        let before = self.before.as_ref().map_or(last, |before| Moment {
            memory: &before.memory,
            variables: &before.variables,
            time: before.time,
            captured: &self.captured,
        });
        look(&View { now, last, before })
    }

    /// The memory now: after the last cycle, with what was written since.
    fn now(&self) -> Cow<'_, Memory> {
        if self.pending.is_empty() {
            return Cow::Borrowed(self.machine.memory());
        }
        let mut memory = self.machine.memory().clone();
        for &(location, value) in &self.pending {
            memory.write(location, value);
        }
        Cow::Owned(memory)
    }

    fn looked_at<T>(&self, look: impl FnOnce(&View<'_>) -> T) -> T {
        let now = self.now();
        self.with_view(Moment { memory: &now, ..self.last() }, look)
    }

    fn holds(&self, expression: &Expression) -> bool {
        self.looked_at(|view| expression.holds(view))
    }

    fn evaluated(&self, expression: &Expression) -> f64 {
        self.looked_at(|view| expression.value(view))
    }

    fn missed(&self, what: String, expression: Option<&Expression>) -> Failure {
        let operands = expression
            .map_or_else(Vec::new, |expression| self.looked_at(|view| expression.operands(view, &self.machine)));
        let names = self.machine.names();
        let alarms = self.machine.variables().alarms.iter().map(|alarm| {
            let (name, text) = (self.machine.alarm_name(alarm.number), self.machine.alarm_text(alarm));
            format!("{name} [{}] {text}", crate::trace::place_name(alarm.place, names))
        });
        Missed { place: None, time: self.time(), what, operands, alarms: alarms.collect() }.into()
    }

    /// The failure of a cycle that was the last one.
    fn stopped(&self, stopped: &Stopped, doing: &str, expression: Option<&Expression>) -> Failure {
        match stopped {
            Stopped::Limit => {
                let limit = self.machine.cycle_time().times(self.limit.unwrap_or(0));
                self.missed(format!("reached the limit of {limit} s: {doing}"), expression)
            }
            Stopped::Condition(index) => {
                let condition = &self.conditions[*index];
                let (word, found) = if condition.wanted { ("always", "false") } else { ("never", "true") };
                let source = condition.expression.source();
                let what = format!("expected {word} `{source}`, found it {found}");
                let failure = self.missed(what, Some(&condition.expression));
                match &condition.place {
                    Some(place) => failure.at(place),
                    None => failure,
                }
            }
        }
    }
}

impl Shown {
    fn of(machine: &Machine, time: Time) -> Self {
        Self { memory: machine.memory().clone(), variables: machine.variables().clone(), time }
    }
}
