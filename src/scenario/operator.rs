//! Executes the steps of a scenario in order. A caller steps the machine: the scenario runner at full speed, a server in real time.

use super::failure::Failure;
use super::passing::{Book, Next, Progress};
use super::steps::{Action, Step};
use crate::machine::Machine;

/// The steps and the progress through them.
pub(super) struct Plan {
    steps: Vec<Step>,
    index: usize,
    /// The progress of the current step, if it has begun.
    progress: Option<Progress>,
}

impl Plan {
    pub(super) fn new(steps: Vec<Step>) -> Self {
        Self { steps, index: 0, progress: None }
    }

    /// Executes steps until a cycle must pass or all steps are done. The caller steps the machine next. Passes each note to the caller.
    pub(super) fn go_on(
        &mut self,
        book: &mut Book,
        machine: &mut Machine,
        note: &mut dyn FnMut(&Machine, &str),
    ) -> Result<Next, Failure> {
        while let Some(step) = self.steps.get(self.index) {
            if let (None, Some(text)) = (&self.progress, &step.note) {
                note(machine, text);
            }
            let progress = self.progress.get_or_insert_with(|| Progress::new(machine));
            let next = book.go_on(&step.action, progress, machine).map_err(|failure| failure.at(&step.place))?;
            if next == Next::Cycle {
                let begun = book.begin_cycle(machine);
                begun.map_err(|stopped| book.stopped(stopped, &step.action, progress, machine).at(&step.place))?;
                return Ok(Next::Cycle);
            }
            (self.index, self.progress) = (self.index + 1, None);
        }
        Ok(Next::Over)
    }

    /// Called after a cycle.
    pub(super) fn end_cycle(&mut self, book: &mut Book, machine: &Machine) -> Result<(), Failure> {
        let ended = book.end_cycle(machine);
        let (Some(step), Some(progress)) = (self.steps.get(self.index), &mut self.progress) else { return Ok(()) };
        ended.map_err(|stopped| book.stopped(stopped, &step.action, progress, machine).at(&step.place))?;
        progress.count();
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
            Action::Queue(_) | Action::Handwheel(_) | Action::Pulse(..) | Action::Run(_) | Action::Image(_) => false,
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
        let mut notes = self.book.take_notes();
        if self.state == State::Acting {
            match self.plan.go_on(&mut self.book, machine, &mut |_, note| notes.push(note.to_owned())) {
                Ok(Next::Cycle) => {}
                Ok(Next::Over) => {
                    self.state = self.book.finish(None, machine).map_or(State::Done, State::Failed);
                }
                Err(failure) => self.state = State::Failed(failure),
            }
        }
        notes
    }

    /// Evaluates the last step. Call it after each step and before the record of the machine is drained, because edges are read from it.
    pub fn look(&mut self, machine: &Machine) {
        if self.state == State::Acting {
            self.book.note_changes(machine);
            if let Err(failure) = self.plan.end_cycle(&mut self.book, machine) {
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
