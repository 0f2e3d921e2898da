//! Executes the steps of a scenario in order. A caller steps the machine: the scenario runner at full speed, a server in real time.

use super::failure::Failure;
use super::passing::{Book, Next};
use super::steps::{Action, Step};
use crate::machine::Machine;

/// The steps and the progress through them.
pub(super) struct Plan {
    steps: Vec<Step>,
    index: usize,
    /// The number of cycles that have passed in the current step.
    passed: u64,
    /// Whether the current step has begun.
    has_begun: bool,
}

impl Plan {
    pub(super) fn new(steps: Vec<Step>) -> Self {
        Self { steps, index: 0, passed: 0, has_begun: false }
    }

    /// Executes steps until a cycle must pass or all steps are done. The caller steps the machine next. Passes each note to the caller.
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

    /// Called after a cycle.
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

/// A scenario that runs on a machine which its caller steps.
pub struct Operator {
    book: Book,
    plan: Plan,
    state: State,
}

/// The progress of an operator.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum State {
    /// Steps remain.
    #[default]
    Acting,
    /// All steps are done.
    Done,
    /// A step failed; the steps after it are not executed.
    Failed(Failure),
}

impl Operator {
    pub(super) fn new(book: Book, plan: Plan) -> Self {
        Self { book, plan, state: State::Acting }
    }

    /// Queues the commands for the next step of the machine; call it before each step. Returns the notes of the steps that begin.
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

    /// Evaluates the last step. Call it after each step and before the record of the machine is drained, because edges are read from it.
    pub fn look(&mut self, machine: &Machine) {
        if self.state == State::Acting {
            self.book.note_changes(machine);
            if let Err(failure) = self.plan.end_cycle(&self.book, machine) {
                self.state = State::Failed(failure);
            }
        }
    }

    /// The progress so far.
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
