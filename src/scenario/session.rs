//! A machine under test: the calls that a test in Rust uses step by step. The scenario runner uses the same calls for a file.
//!
//! Time does not pass between calls. `run`, `wait`, `hold` and `pulse` let whole cycles pass. "Now" is the state after the last cycle
//! plus the writes of this session that no cycle has taken over yet.

use std::path::Path;

use super::duration::Duration;
use super::failure::Failure;
use super::naming::{Known, check_captured_name, enable_of, place_named, writable};
use super::passing::{Book, Next, Progress};
use super::program_rows::{begun, program_rows, remember};
use super::programs::Text;
use super::steps::Action;
use super::values::Setting;
use crate::expression::{Expression, Followed};
use crate::image::Location;
use crate::machine::{Command, Machine};
use crate::monitor::{Claim, Consequence, Rule, Span};
use crate::plc::{PlcProgram, Programs};
use crate::source::{Place, Problem};
use crate::trace::{Head, Trace, Watch, Window};
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
    /// The NC programs whose texts were selected.
    pub(super) texts: Vec<Text>,
}

impl Session {
    /// Opens a machine: a directory, an archive file, or the name of a built-in machine.
    ///
    /// # Errors
    /// The files of the machine are invalid.
    pub fn open(machine: impl AsRef<Path>) -> Result<Self, Failure> {
        let mut machine = Machine::open(machine)?;
        machine.load_own_program(&Programs::ready())?;
        Ok(Self::new(machine))
    }

    /// A session with a machine that is already open.
    #[must_use]
    pub fn new(mut machine: Machine) -> Self {
        machine.observe_program();
        Self { trace: begun(&machine), watch: Watch::default(), book: Book::new(&machine), texts: Vec::new(), machine }
    }

    /// The same session with a PLC program.
    #[must_use]
    pub fn with_program(mut self, program: Box<dyn PlcProgram>) -> Self {
        self.machine.load_program(program);
        self.machine.observe_program();
        remember(&mut self.trace, &self.machine);
        self
    }

    /// The machine.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// All changes so far.
    #[must_use]
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// The trace as text, with causes.
    #[must_use]
    pub fn text(&self) -> String {
        self.rows(true)
    }

    /// The trace without causes, as in golden files. Use it for snapshots, so that a reworded cause does not change them.
    #[must_use]
    pub fn sequence(&self) -> String {
        self.rows(false)
    }

    pub(super) fn rows(&self, causes: bool) -> String {
        self.trace.text(&self.machine, &self.watch, causes)
    }

    /// The trace as JSON lines, for programs.
    #[must_use]
    pub fn json_lines(&self) -> String {
        self.trace.json_lines(&self.machine, &self.watch)
    }

    /// The trace as a waveform (VCD), for GTKWave and similar viewers.
    #[must_use]
    pub fn vcd(&self) -> String {
        self.vcd_in(Window::default())
    }

    pub(super) fn vcd_in(&self, window: Window) -> String {
        self.trace.vcd(&self.machine, &self.watch, window)
    }

    /// The trace as a timing diagram.
    #[must_use]
    pub fn svg(&self, head: &Head) -> String {
        self.svg_in(Window::default(), head)
    }

    pub(super) fn svg_in(&self, window: Window, head: &Head) -> String {
        self.trace.svg(&self.machine, &self.watch, window, head)
    }

    /// Time since the start of the session.
    #[must_use]
    pub fn time(&self) -> Time {
        self.book.time(&self.machine)
    }

    /// Selects what the texts of the trace show, like `watch` in a scenario. Values are recorded from now on.
    ///
    /// # Errors
    /// An entry does not name a signal or value.
    pub fn watch(&mut self, entries: &[&str]) -> Result<(), Failure> {
        let (names, memory) = (self.machine.names(), self.machine.memory());
        let watch = Watch::parse(entries, names, memory, self.machine.variables());
        self.set_watch(watch.map_err(|(_, problem)| problem)?);
        Ok(())
    }

    pub(super) fn set_watch(&mut self, watch: Watch) {
        self.trace.watch_values(&watch, self.machine.cycle(), self.machine.variables());
        self.watch = watch;
    }

    /// Writes a signal or a byte once, in the next cycle, as a client can: also a bit of the NCK, which the NCK then overwrites.
    ///
    /// # Errors
    /// The signal does not exist, or the value does not fit.
    pub fn write(&mut self, signal: &str, value: impl Into<Setting>) -> Result<(), Failure> {
        let location = place_named(&self.machine, signal)?;
        let bits = value.into().bits(signal, location, self.machine.override_coding())?;
        self.queue(Command::Write { location, value: bits })
    }

    /// Writes a signal once, in the next cycle; the PLC program may overwrite it.
    ///
    /// # Errors
    /// The signal does not exist, the NCK writes it, or the value does not fit.
    pub fn set(&mut self, signal: &str, value: impl Into<Setting>) -> Result<(), Failure> {
        let (location, bits) = self.resolved(signal, value.into())?;
        if let Some(location) = enable_of(&self.machine, signal) {
            self.queue(Command::Write { location, value: 1 })?;
        }
        self.queue(Command::Write { location, value: bits })
    }

    /// Overrides a signal after every scan of the PLC program, until [`Session::release`].
    ///
    /// # Errors
    /// As [`Session::set`].
    pub fn force(&mut self, signal: &str, value: impl Into<Setting>) -> Result<(), Failure> {
        let (location, bits) = self.resolved(signal, value.into())?;
        if let Some(location) = enable_of(&self.machine, signal) {
            self.queue(Command::Force { location, value: 1 })?;
        }
        self.queue(Command::Force { location, value: bits })
    }

    /// Ends the override of a signal.
    ///
    /// # Errors
    /// The signal does not exist.
    pub fn release(&mut self, signal: &str) -> Result<(), Failure> {
        let location = writable(&self.machine, signal)?;
        if let Some(location) = enable_of(&self.machine, signal) {
            self.queue(Command::Release { location })?;
        }
        self.queue(Command::Release { location })
    }

    fn resolved(&self, signal: &str, value: Setting) -> Result<(Location, u64), Problem> {
        let location = writable(&self.machine, signal)?;
        Ok((location, value.bits(signal, location, self.machine.override_coding())?))
    }

    /// Sets a bit for 100 ms and resets it. It returns one cycle later, when the bit is 0 again.
    ///
    /// # Errors
    /// The bit does not exist, the NCK writes it, or a condition that must hold in every cycle failed.
    pub fn pulse(&mut self, signal: &str) -> Result<(), Failure> {
        self.pulse_for(signal, "100ms")
    }

    /// Sets a bit for the given time and resets it. It returns one cycle later, when the bit is 0 again.
    ///
    /// # Errors
    /// As [`Session::pulse`].
    pub fn pulse_for(&mut self, signal: &str, time: &str) -> Result<(), Failure> {
        self.pulse_all(&[signal], time)
    }

    /// Sets several bits in the same cycle and resets them after the given time.
    ///
    /// # Errors
    /// As [`Session::pulse`].
    pub fn pulse_all(&mut self, signals: &[&str], time: &str) -> Result<(), Failure> {
        let mut locations = Vec::with_capacity(signals.len());
        for signal in signals {
            locations.extend(enable_of(&self.machine, signal));
            locations.push(writable(&self.machine, signal)?);
        }
        let locations = locations.into_boxed_slice();
        self.act(&Action::Pulse(locations, Duration::parse(time)?))
    }

    /// Lets time pass.
    ///
    /// # Errors
    /// The text is not a duration, or a condition that must hold in every cycle failed.
    pub fn run(&mut self, time: &str) -> Result<(), Failure> {
        self.act(&Action::Run(Duration::parse(time)?))
    }

    /// Lets time pass until an expression is true, and returns in the cycle in which it becomes true.
    ///
    /// # Errors
    /// The time has expired; the failure shows every signal in the expression.
    pub fn wait(&mut self, expression: &str, within: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        let within = Duration::parse(within)?;
        self.act(&Action::Wait(Box::new(expression), Some(within)))
    }

    /// Lets time pass. The expression must be true now and in every cycle.
    ///
    /// # Errors
    /// The expression became false; the failure shows every signal in it.
    pub fn hold(&mut self, expression: &str, during: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        let during = Duration::parse(during)?;
        self.act(&Action::Hold(Box::new(expression), during))
    }

    /// The expression must be true now.
    ///
    /// # Errors
    /// The expression is false; the failure shows every signal in it.
    pub fn expect(&mut self, expression: &str) -> Result<(), Failure> {
        let expression = self.expression(expression)?;
        self.take_power_on()?;
        self.book.expect(&expression, &self.machine)
    }

    /// All expressions must be true now.
    ///
    /// # Errors
    /// The failure names every expression that is false, and shows every signal in it.
    pub fn expect_all(&mut self, expressions: &[&str]) -> Result<(), Failure> {
        let here = Place::file("expect_all");
        let mut parsed = Vec::new();
        for (index, expression) in expressions.iter().enumerate() {
            let place = here.at_line(u32::try_from(index + 1).unwrap_or(0));
            parsed.push((place, self.expression(expression)?));
        }
        self.take_power_on()?;
        self.book.expect_all(&parsed, &self.machine)
    }

    /// These bytes, words or bits must have these values now, as `("DB31.DBB101", "2#1100_0000")`.
    ///
    /// # Errors
    /// The failure names every one that differs.
    pub fn image(&mut self, expected: &[(&str, &str)]) -> Result<(), Failure> {
        let mut bytes = Vec::new();
        for (name, value) in expected {
            let location = place_named(&self.machine, name)?;
            let number = value.parse().map_or_else(|_| Setting::from(*value), Setting::Integer);
            let bits = number.bits(name, location, self.machine.override_coding())?;
            bytes.push((Place::file(name), location, bits));
        }
        self.take_power_on()?;
        self.book.expect_bits(&bytes, &self.machine)
    }

    /// The expression must be true after every cycle from now on.
    ///
    /// # Errors
    /// The text is not an expression.
    pub fn always(&mut self, expression: &str) -> Result<(), Failure> {
        let claim = Claim::Always(self.expression(expression)?);
        self.watch_over(None, claim)
    }

    /// The expression must be false after every cycle from now on.
    ///
    /// # Errors
    /// The text is not an expression.
    pub fn never(&mut self, expression: &str) -> Result<(), Failure> {
        let claim = Claim::Never(self.expression(expression)?);
        self.watch_over(None, claim)
    }

    /// From now on, `then` must become true within a time after every rising edge of `when`; `name` is for messages.
    ///
    /// # Errors
    /// A text is not an expression or not a duration.
    pub fn follows(&mut self, name: &str, when: &str, then: &str, within: &str) -> Result<(), Failure> {
        let consequence = Consequence {
            when: self.expression(when)?,
            then: self.expression(then)?,
            within: Duration::parse(within)?.span(),
            not_before: Span::NONE,
            from_start: false,
            must_begin: false,
        };
        self.watch_over(Some(name.to_owned()), Claim::Follows(Box::new(consequence)))
    }

    fn watch_over(&mut self, name: Option<String>, claim: Claim) -> Result<(), Failure> {
        let rule = Rule { name, place: None, claim, go_on: false };
        self.book.watch_over(vec![rule], self.book.followed.clone(), &self.machine);
        Ok(())
    }

    /// Follows the rising edges of a condition from now on, for `since` and `count` of this condition. Without this call they begin with the
    /// first expression that contains them.
    ///
    /// # Errors
    /// The text is not an expression.
    pub fn follow(&mut self, condition: &str) -> Result<(), Failure> {
        self.expression(&format!("count({condition})")).map(drop).map_err(Failure::from)
    }

    /// The value of an expression now.
    ///
    /// # Errors
    /// The text is not an expression, or a name in it is unknown.
    pub fn value(&self, expression: &str) -> Result<f64, Failure> {
        let mut followed = self.book.followed.clone();
        let expression = self.parsed(expression, &mut followed)?;
        self.begin_edges(&mut followed);
        Ok(self.book.looked_at(&self.machine, |view| expression.value(&view.with_edges(&followed.edges))))
    }

    /// Stores a value for later expressions.
    ///
    /// # Errors
    /// The name is not a plain name, or the expression is invalid.
    pub fn capture(&mut self, name: &str, expression: &str) -> Result<f64, Failure> {
        check_captured_name(name)?;
        let expression = self.expression(expression)?;
        let names = &mut self.book.captured_names;
        let known = names.iter().position(|known| known == name);
        let index = known.unwrap_or(names.len());
        if known.is_none() {
            names.push(name.to_owned());
        }
        self.take_power_on()?;
        Ok(self.book.keep(index, &expression, &self.machine))
    }

    /// Writes a note into the trace, at the time of the next cycle.
    pub fn note(&mut self, text: &str) {
        self.trace.note(self.machine.cycle() + 1, text);
    }

    /// Also measures what causes name, for [`Trace::check_causes`]: call it before the first cycle. This is slower and gives the same trace.
    pub fn measure_causes(&mut self) {
        self.trace.measure_causes(self.machine.variables(), self.machine.read_late());
    }

    /// A second session that continues independently from this state.
    ///
    /// # Errors
    /// The PLC program cannot be copied.
    pub fn fork(&self) -> Result<Self, Failure> {
        Ok(Self {
            machine: self.machine.fork()?,
            trace: self.trace.clone(),
            watch: self.watch.clone(),
            book: self.book.clone(),
            texts: self.texts.clone(),
        })
    }

    /// Queues a command for the next cycle.
    pub(super) fn queue(&mut self, command: Command) -> Result<(), Failure> {
        self.book.queue(command, &mut self.machine)
    }

    /// A power on acts in the next cycle: what judges the state waits for it.
    fn take_power_on(&mut self) -> Result<(), Failure> {
        self.act(&Action::Capture(Box::default()))
    }

    /// Executes the action of a step.
    fn act(&mut self, action: &Action) -> Result<(), Failure> {
        let mut progress = Progress::new(&self.machine);
        while self.book.go_on(action, &mut progress, &mut self.machine)? == Next::Cycle {
            let begun = self.book.begin_cycle(&self.machine);
            let ended = begun.and_then(|()| {
                self.cycle();
                self.book.end_cycle(&self.machine)
            });
            ended.map_err(|stopped| self.book.stopped(stopped, action, &progress, &self.machine))?;
            progress.count();
        }
        Ok(())
    }

    /// Runs one cycle and records it.
    pub(super) fn cycle(&mut self) {
        self.machine.step();
        self.trace.extend(self.machine.recorder());
        self.trace.note_fault(self.machine.recorder(), self.machine.program_fault());
        self.trace.extend_causes(self.machine.cycle(), program_rows(&self.machine));
        self.book.note_changes(&self.machine);
        self.machine.drain();
        let (machine, cycle) = (&self.machine, self.machine.cycle());
        self.trace.end_cycle(cycle, machine.time(), machine.variables());
        self.trace.measure(cycle, machine.variables(), machine.read_late());
    }

    /// An expression; its `since` and `count` begin now unless their conditions are followed already.
    fn expression(&mut self, source: &str) -> Result<Expression, Problem> {
        let mut followed = self.book.followed.clone();
        let expression = self.parsed(source, &mut followed)?;
        self.follow_more(followed);
        Ok(expression)
    }

    /// Takes over what new expressions follow.
    pub(super) fn follow_more(&mut self, mut followed: Followed) {
        if followed.is_more_than(&self.book.followed) {
            self.begin_edges(&mut followed);
            self.book.follow(followed, &self.machine);
        }
    }

    /// The signals of new `cause` begin with the last edges in the trace.
    fn begin_edges(&self, followed: &mut Followed) {
        let cycle = self.machine.cycle();
        let rule = |signal, cycle| self.trace.last_rule(signal, cycle);
        let known = self.book.followed.edges.len();
        followed.edges.begin(known, |signal| [rule(signal, cycle), rule(signal, cycle.saturating_sub(1))]);
    }

    fn parsed(&self, source: &str, followed: &mut Followed) -> Result<Expression, Problem> {
        let captured = &self.book.captured_names;
        let known = Known { machine: &self.machine, captured, is_reconfigured: false };
        let mut expression = Expression::parse(source, &known)?;
        expression.follow(followed);
        Ok(expression)
    }
}
