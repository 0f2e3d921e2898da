//! The steps of a scenario, in order, on a machine that somebody steps: the runner as fast as it can, a server in real time.

use super::failure::Failure;
use super::passing::{Book, Next};
use super::steps::{Action, Step};
use crate::machine::Machine;

/// Steps, and how far they have come.
pub(super) struct Plan {
    steps: Vec<Step>,
    index: usize,
    /// How many cycles the step has let pass.
    passed: u64,
    /// It has been looked at.
    has_begun: bool,
}

impl Plan {
    pub(super) fn new(steps: Vec<Step>) -> Self {
        Self { steps, index: 0, passed: 0, has_begun: false }
    }

    /// Goes on until a cycle has to pass, which then must follow, or until all is over; gives each note to be noted.
    pub(super) fn go_on(
        &mut self,
        book: &mut Book,
        machine: &mut Machine,
        note: &mut dyn FnMut(&Machine, &str),
    ) -> Result<Next, Failure> {
        while let Some(step) = self.steps.get(self.index) {
            if let (false, Some(text)) = (self.has_begun, &step.note) {
                note(machine, text);
            }
            self.has_begun = true;
            let next = book.go_on(&step.action, self.passed, machine).map_err(|failure| failure.at(&step.place))?;
            if next == Next::Cycle {
                let begun = book.begin_cycle(machine);
                begun.map_err(|stopped| book.stopped(&stopped, &step.action, self.passed, machine).at(&step.place))?;
                return Ok(Next::Cycle);
            }
            (self.index, self.passed, self.has_begun) = (self.index + 1, 0, false);
        }
        Ok(Next::Over)
    }

    /// The cycle has passed.
    pub(super) fn end_cycle(&mut self, book: &Book, machine: &Machine) -> Result<(), Failure> {
        let ended = book.end_cycle(machine);
        if let (Err(stopped), Some(step)) = (ended, self.steps.get(self.index)) {
            return Err(book.stopped(&stopped, &step.action, self.passed, machine).at(&step.place));
        }
        self.passed += 1;
        Ok(())
    }

    pub(super) fn looks_back(&self) -> bool {
        self.steps.iter().any(Step::looks_back)
    }
}

impl Step {
    fn looks_back(&self) -> bool {
        match &self.action {
            Action::Wait(expression, _) | Action::Hold(expression, _) => expression.looks_back(),
            Action::Expect(expressions) => expressions.iter().any(|(_, expression)| expression.looks_back()),
            Action::Capture(captures) => captures.iter().any(|(_, expression)| expression.looks_back()),
            Action::Queue(_) | Action::Pulse(..) | Action::Run(_) | Action::Image(_) => false,
        }
    }
}

/// A scenario at work on a machine that somebody else steps.
pub struct Operator {
    book: Book,
    plan: Plan,
    state: State,
}

/// How far an operator is.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum State {
    /// At work.
    #[default]
    Acting,
    /// All steps were done.
    Done,
    /// One failed; the ones behind it were not done.
    Failed(Failure),
}

impl Operator {
    pub(super) fn new(book: Book, plan: Plan) -> Self {
        Self { book, plan, state: State::Acting }
    }

    /// Before each step of the machine: queues what is to be done at its edge. Gives the notes of the steps that begin.
    pub fn act(&mut self, machine: &mut Machine) -> Vec<String> {
        let mut notes = Vec::new();
        if self.state == State::Acting {
            match self.plan.go_on(&mut self.book, machine, &mut |_, note| notes.push(note.to_owned())) {
                Ok(Next::Cycle) => {}
                Ok(Next::Over) => self.state = State::Done,
                Err(failure) => self.state = State::Failed(failure),
            }
        }
        notes
    }

    /// After each step, before the machine's record is drained: edges are found in the record.
    pub fn look(&mut self, machine: &Machine) {
        if self.state == State::Acting {
            self.book.note_changes(machine);
            if let Err(failure) = self.plan.end_cycle(&self.book, machine) {
                self.state = State::Failed(failure);
            }
        }
    }

    /// How far it is.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }
}

impl std::fmt::Debug for Operator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Operator").field("state", &self.state).finish_non_exhaustive()
    }
}
