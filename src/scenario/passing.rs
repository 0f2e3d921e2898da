//! How time passes in a session: cycle by cycle, with what must hold in each, and what a failure says.

use std::borrow::Cow;

use super::expression::{Expression, Moment, View};
use super::failure::{Failure, Missed};
use super::session::Session;
use crate::image::{Location, Memory};
use crate::machine::{Command, Machine};
use crate::trace::place_name;
use crate::units::Time;
use crate::variables::{Describe, Variables};

/// What the machine showed after a cycle.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    pub(super) memory: Memory,
    pub(super) variables: Variables,
    pub(super) time: Time,
}

/// Why a cycle was the last one.
enum Stopped {
    Limit,
    Condition(usize),
}

impl Session {
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

    pub(super) fn run_cycles(&mut self, cycles: u64) -> Result<(), Failure> {
        for done in 0..cycles {
            self.pass_cycle().map_err(|stopped| {
                let passed = self.machine.cycle_time().times(done);
                self.stopped(&stopped, &format!("after {passed} s of a run"), None)
            })?;
        }
        Ok(())
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

    pub(super) fn holds(&self, expression: &Expression) -> bool {
        self.looked_at(|view| expression.holds(view))
    }

    pub(super) fn evaluated(&self, expression: &Expression) -> f64 {
        self.looked_at(|view| expression.value(view))
    }

    fn missed(&self, what: String, expression: Option<&Expression>) -> Failure {
        let operands = expression
            .map_or_else(Vec::new, |expression| self.looked_at(|view| expression.operands(view, &self.machine)));
        let names = self.machine.names();
        let alarms = self.machine.variables().alarms.iter().map(|alarm| {
            let (name, text) = (self.machine.alarm_name(alarm.number), self.machine.alarm_text(alarm));
            format!("{name} [{}] {text}", place_name(alarm.place, names))
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
    pub(super) fn of(machine: &Machine, time: Time) -> Self {
        Self { memory: machine.memory().clone(), variables: machine.variables().clone(), time }
    }
}
