//! The progress of time in a session: the action before each cycle, the conditions that must hold in each cycle, the text of a failure.
//!
//! This module does not step the machine. The caller that steps it asks a [`Book`] before each cycle how an action continues, and calls
//! the book again after each cycle. So the same actions run at full speed (for a file or a test) and in real time (for a server).

use std::borrow::Cow;

use super::duration::Duration;
use super::failure::{Failure, Missed};
use super::steps::Action;
use crate::expression::{Expression, Followed, Moment, View};
use crate::image::{Location, Memory};
use crate::machine::{Command, Machine};
use crate::monitor::Monitor;
use crate::source::Place;
use crate::trace::Past;
use crate::units::Time;
use crate::variables::{Describe, Variables, place_name};

/// The state of a session beside its machine.
#[derive(Clone, Debug)]
pub(super) struct Book {
    /// The cycle and the time of the machine that count as time zero.
    pub(super) start: (u64, Time),
    /// Bits that were written and that no cycle has taken over yet.
    pending: Vec<(Location, u64)>,
    /// A power on that the next cycle executes: what judges the state waits for it.
    powers_on: bool,
    pub(super) captured_names: Vec<String>,
    captured: Vec<f64>,
    /// The rules of the session.
    pub(super) monitor: Monitor,
    /// The histories of `since` and `count`, and the rules of `cause`.
    pub(super) followed: Followed,
    /// A rule that was broken before the first cycle.
    pub(super) broken: Option<Failure>,
    /// The breaches of rules after which the run goes on, and the notes about them that the trace has not taken yet.
    pub(super) noted: Vec<Missed>,
    pub(super) notes: Vec<String>,
    /// The longest time of this session.
    pub(super) limit: Option<Duration>,
    /// The state one cycle ago, kept if an expression uses `rose` or `fell`.
    before: Option<Box<Before>>,
}

/// The state of the machine one cycle ago.
#[derive(Clone, Debug)]
struct Before {
    past: Past,
    time: Time,
}

/// The progress of an action that lets time pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    /// The time of the machine at its start.
    start: Time,
    /// The cycles that have passed in it.
    cycles: u64,
    /// The time of the machine at which a pulse reset its bits.
    reset: Option<Time>,
}

impl Progress {
    /// An action that starts now.
    pub(super) fn new(machine: &Machine) -> Self {
        Self { start: machine.time(), cycles: 0, reset: None }
    }

    /// Called after a cycle.
    pub(super) fn count(&mut self) {
        self.cycles += 1;
    }

    fn time(&self, machine: &Machine) -> Time {
        machine.time() - self.start
    }

    fn is_over(&self, duration: Duration, machine: &Machine) -> bool {
        duration.is_over(self.cycles, self.time(machine))
    }
}

/// How an action continues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// One cycle must pass.
    Cycle,
    /// The action is complete.
    Over,
}

/// Why no cycle may follow.
pub(super) enum Stopped {
    Limit,
    Broken(Failure),
}

impl Book {
    /// Starts a session now.
    pub(super) fn new(machine: &Machine) -> Self {
        Self {
            start: (machine.cycle(), machine.time()),
            pending: Vec::new(),
            powers_on: false,
            captured_names: Vec::new(),
            captured: Vec::new(),
            monitor: Monitor::default(),
            followed: Followed::default(),
            broken: None,
            noted: Vec::new(),
            notes: Vec::new(),
            limit: None,
            before: Some(Box::new(Before::new(machine, Time::ZERO))),
        }
    }

    /// Selects whether the state before the last cycle is kept; expressions with `rose` or `fell` need it.
    pub(super) fn look_back(&mut self, wanted: bool, machine: &Machine) {
        self.before = wanted.then(|| Box::new(Before::new(machine, self.time(machine))));
    }

    /// Time since the start of the session.
    pub(super) fn time(&self, machine: &Machine) -> Time {
        machine.time() - self.start.1
    }

    /// Queues a command for the next cycle.
    pub(super) fn queue(&mut self, command: Command, machine: &mut Machine) -> Result<(), Failure> {
        if let Command::Write { location, value } | Command::Force { location, value } = command {
            self.pending.push((location, value));
        }
        let powers_on = command == Command::PowerOn;
        machine.queue(command)?;
        self.powers_on |= powers_on;
        Ok(())
    }

    fn write_bits(&mut self, locations: &[Location], value: u64, machine: &mut Machine) -> Result<(), Failure> {
        locations.iter().try_for_each(|&location| self.queue(Command::Write { location, value }, machine))
    }

    /// Executes an action after some of its cycles have passed.
    pub(super) fn go_on(
        &mut self,
        action: &Action,
        progress: &mut Progress,
        machine: &mut Machine,
    ) -> Result<Next, Failure> {
        let until = |is_over: bool| if is_over { Next::Over } else { Next::Cycle };
        let judges = matches!(
            action,
            Action::Wait(..) | Action::Hold(..) | Action::Expect(_) | Action::Capture(_) | Action::Image(_)
        );
        if judges && self.powers_on {
            return Ok(Next::Cycle);
        }
        match action {
            Action::Queue(commands) => {
                commands.iter().try_for_each(|command| self.queue(command.clone(), machine))?;
                Ok(Next::Over)
            }
            Action::Handwheel(turn) => {
                self.queue(turn.command(machine.cycle_time()), machine)?;
                Ok(Next::Over)
            }
            Action::Pulse(locations, length) => {
                if progress.reset.is_some() {
                    return Ok(Next::Over);
                }
                if progress.cycles == 0 {
                    self.write_bits(locations, 1, machine)?;
                } else if progress.is_over(*length, machine) {
                    self.write_bits(locations, 0, machine)?;
                    progress.reset = Some(machine.time());
                }
                Ok(Next::Cycle)
            }
            Action::Run(length) => Ok(until(progress.is_over(*length, machine))),
            Action::Wait(expression, within) => {
                if self.holds(expression, machine) {
                    return Ok(Next::Over);
                }
                if within.is_some_and(|within| progress.is_over(within, machine)) {
                    let what = format!("{}; it did not become true", waited(progress.time(machine), expression));
                    return Err(self.missed(what, Some(expression), machine));
                }
                Ok(Next::Cycle)
            }
            Action::Hold(expression, during) => {
                if self.holds(expression, machine) {
                    return Ok(until(progress.is_over(*during, machine)));
                }
                let held = progress.time(machine);
                let what = format!("expected `{}` to stay true; it was false after {held} s", expression.source());
                Err(self.missed(what, Some(expression), machine))
            }
            Action::Expect(expressions) => {
                self.expect_all(expressions, machine)?;
                Ok(Next::Over)
            }
            Action::Capture(captures) => {
                for (index, expression) in captures {
                    self.keep(*index, expression, machine);
                }
                Ok(Next::Over)
            }
            // The plan executes repetitions.
            Action::Nothing | Action::Repeat { .. } => Ok(Next::Over),
            Action::Image(bytes) => {
                self.expect_bits(bytes, machine)?;
                Ok(Next::Over)
            }
        }
    }

    /// Called before a cycle.
    pub(super) fn begin_cycle(&mut self, machine: &Machine) -> Result<(), Stopped> {
        if let Some(failure) = self.broken.take() {
            return Err(Stopped::Broken(failure));
        }
        let time = self.time(machine);
        if self.limit.is_some_and(|limit| limit.is_over(machine.cycle() - self.start.0, time)) {
            return Err(Stopped::Limit);
        }
        if let Some(before) = &mut self.before {
            before.past.begin_step(machine.memory(), machine.variables(), machine.cycle());
            before.time = time;
        }
        Ok(())
    }

    /// Called after a cycle, before its record is drained: stores the changes of the cycle.
    pub(super) fn note_changes(&mut self, machine: &Machine) {
        self.pending.clear();
        self.powers_on = false;
        if let Some(before) = &mut self.before {
            before.past.end_step(machine.recorder(), machine.cycle());
        }
        let events = machine.control().events();
        self.followed.edges.observe(|signal, known| match machine.recorder().edge(signal, machine.cycle()) {
            Some(cause) => events.find(cause).map(|event| event.rule),
            None => known,
        });
    }

    /// Called after a cycle and after [`Book::note_changes`]: checks the rules.
    pub(super) fn end_cycle(&mut self, machine: &Machine) -> Result<(), Stopped> {
        if let Some(memory) = machine.powered_on() {
            let (variables, time) = (Variables::default(), self.time(machine) - machine.cycle_time());
            let rules = self.followed.edges.rules_before();
            let now = Moment { memory, variables: &variables, time, named_values: &self.captured, rules };
            self.monitor.power_on(&View { followed: self.followed.conditions.histories(), ..View::at(now) });
        }
        if !self.followed.conditions.is_empty() {
            let mut conditions = std::mem::take(&mut self.followed.conditions);
            self.with_view(self.last(machine), machine, |view| conditions.observe(view));
            self.followed.conditions = conditions;
        }
        if self.monitor.rules().is_empty() {
            return Ok(());
        }
        let cycle = machine.cycle() - self.start.0;
        self.judge(machine, |monitor, view, report| monitor.observe(view, cycle, report)).map_err(Stopped::Broken)
    }

    /// The failure when a cycle ended an action early.
    pub(super) fn stopped(&self, stopped: Stopped, action: &Action, progress: &Progress, machine: &Machine) -> Failure {
        let run = |since: Time| format!("after {} s of a run", machine.time() - since);
        let (doing, expression) = match action {
            Action::Wait(expression, _) => (waited(progress.time(machine), expression), Some(&**expression)),
            Action::Hold(expression, _) => (format!("while `{}` held", expression.source()), Some(&**expression)),
            Action::Pulse(..) => (run(progress.reset.unwrap_or(progress.start)), None),
            Action::Run(_)
            | Action::Queue(_)
            | Action::Handwheel(_)
            | Action::Expect(_)
            | Action::Capture(_)
            | Action::Image(_)
            | Action::Nothing
            | Action::Repeat { .. } => (run(progress.start), None),
        };
        match stopped {
            Stopped::Limit => {
                let limit = self.time(machine);
                self.missed(
                    format!("reached the limit of {limit} s: {doing}; `limit` at the head of the scenario raises it"),
                    expression,
                    machine,
                )
            }
            Stopped::Broken(failure) => failure,
        }
    }

    /// The expression must be true now.
    pub(super) fn expect(&self, expression: &Expression, machine: &Machine) -> Result<(), Failure> {
        if self.holds(expression, machine) {
            Ok(())
        } else {
            let what = format!("expected `{}`, but it is false", expression.source());
            Err(self.missed(what, Some(expression), machine))
        }
    }

    /// All expressions must be true now; the failure names every false one.
    pub(super) fn expect_all(&self, expressions: &[(Place, Expression)], machine: &Machine) -> Result<(), Failure> {
        let of = expressions.len();
        let mut missed = expressions.iter().filter(|(_, expression)| !self.holds(expression, machine));
        let Some((place, first)) = missed.next() else {
            return Ok(());
        };
        let further: Vec<_> = missed.collect();
        if further.is_empty() {
            return self.expect(first, machine).map_err(|failure| failure.at(place));
        }
        let mut lines = Vec::new();
        for (place, expression) in std::iter::once(&(place.clone(), first.clone())).chain(further.iter().copied()) {
            lines.push(format!("line {}: `{}` is false", place.line, expression.source()));
            let operands = self.looked_at(machine, |view| expression.operands(view, machine));
            lines.extend(operands.into_iter().map(|operand| format!("  {operand}")));
        }
        let what = format!("{} of {of} expectations are false", further.len() + 1);
        Err(self.missed_with(what, lines, machine).at(place))
    }

    /// Stores a value.
    pub(super) fn keep(&mut self, index: usize, expression: &Expression, machine: &Machine) -> f64 {
        let value = self.evaluated(expression, machine);
        if self.captured.len() <= index {
            self.captured.resize(index + 1, f64::NAN);
        }
        self.captured[index] = value;
        value
    }

    /// The locations must have these bits now; the failure names every other one.
    pub(super) fn expect_bits(&self, expected: &[(Place, Location, u64)], machine: &Machine) -> Result<(), Failure> {
        let now = self.now(machine);
        let mut different = Vec::new();
        for (place, location, bits) in expected {
            let found = now.read(*location);
            if found != *bits {
                let width = usize::from(location.width);
                let address = machine.names().address(*location);
                different.push((place, format!("expected {address} = 2#{bits:0width$b}, found 2#{found:0width$b}")));
            }
        }
        let Some((place, first)) = different.first() else {
            return Ok(());
        };
        let further = different[1..].iter().map(|(place, what)| format!("line {}: {what}", place.line)).collect();
        Err(self.missed_with(first.clone(), further, machine).at(place))
    }

    /// The state after the last cycle.
    pub(super) fn last<'a>(&'a self, machine: &'a Machine) -> Moment<'a> {
        Moment {
            memory: machine.memory(),
            variables: machine.variables(),
            time: self.time(machine),
            named_values: &self.captured,
            rules: self.followed.edges.rules(),
        }
    }

    /// Evaluates the last two cycles and `now`.
    pub(super) fn with_view<T>(&self, now: Moment<'_>, machine: &Machine, look: impl FnOnce(&View<'_>) -> T) -> T {
        let last = self.last(machine);
        let before = self.before.as_ref().map_or(last, |before| Moment {
            memory: before.past.memory(),
            variables: before.past.variables(),
            time: before.time,
            named_values: &self.captured,
            rules: self.followed.edges.rules_before(),
        });
        look(&View { now, last, before, followed: self.followed.conditions.histories() })
    }

    /// The memory now: after the last cycle, including writes since then.
    fn now<'a>(&self, machine: &'a Machine) -> Cow<'a, Memory> {
        if self.pending.is_empty() {
            return Cow::Borrowed(machine.memory());
        }
        let mut memory = machine.memory().clone();
        for &(location, value) in &self.pending {
            memory.write(location, value);
        }
        Cow::Owned(memory)
    }

    pub(super) fn looked_at<T>(&self, machine: &Machine, look: impl FnOnce(&View<'_>) -> T) -> T {
        let now = self.now(machine);
        self.with_view(Moment { memory: &now, ..self.last(machine) }, machine, look)
    }

    fn holds(&self, expression: &Expression, machine: &Machine) -> bool {
        self.looked_at(machine, |view| expression.holds(view))
    }

    fn evaluated(&self, expression: &Expression, machine: &Machine) -> f64 {
        self.looked_at(machine, |view| expression.value(view))
    }

    pub(super) fn missed(&self, what: String, expression: Option<&Expression>, machine: &Machine) -> Failure {
        let operands = expression
            .map_or_else(Vec::new, |expression| self.looked_at(machine, |view| expression.operands(view, machine)));
        self.missed_with(what, operands, machine)
    }

    fn missed_with(&self, what: String, operands: Vec<String>, machine: &Machine) -> Failure {
        self.missed_now(what, operands, machine).into()
    }

    pub(super) fn missed_now(&self, what: String, operands: Vec<String>, machine: &Machine) -> Missed {
        let names = machine.names();
        let alarms = machine.variables().alarms.iter().map(|alarm| {
            let (name, text) = (machine.alarm_name(alarm.number), machine.alarm_text(alarm));
            format!("{name} [{}] {text}", place_name(alarm.place, names))
        });
        Missed { place: None, time: self.time(machine), case: None, what, operands, alarms: alarms.collect() }
    }
}

fn waited(time: Time, expression: &Expression) -> String {
    format!("waited {time} s for `{}`", expression.source())
}

impl Before {
    fn new(machine: &Machine, time: Time) -> Self {
        Self { past: Past::new(machine.memory(), machine.variables(), machine.cycle()), time }
    }
}
