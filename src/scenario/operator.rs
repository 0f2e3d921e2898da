//! Executes the steps of a scenario in order. A caller steps the machine: the scenario runner at full speed, a server in real time.

use std::sync::Arc;

use super::failure::Failure;
use super::passing::{Book, Next, Progress};
use super::steps::{Action, Included, Step, Steps};
use super::timed::Timed;
use crate::machine::Machine;
use crate::source::Place;

/// The steps and the progress through them.
#[derive(Clone)]
pub(super) struct Plan {
    steps: Arc<Steps>,
    timed: Timed,
    index: usize,
    /// The steps at which a repetition continues, and how often its steps have run; the inner one last.
    repeated: Vec<(usize, u64)>,
    /// The progress of the current step, if it has begun.
    progress: Option<Progress>,
}

impl Plan {
    pub(super) fn new(steps: Steps, timed: Timed) -> Self {
        Self { steps: Arc::new(steps), timed, index: 0, repeated: Vec::new(), progress: None }
    }

    /// Executes steps until a cycle must pass or all steps are done. The caller steps the machine next. Passes each note to the caller.
    pub(super) fn go_on(
        &mut self,
        book: &mut Book,
        machine: &mut Machine,
        note: &mut dyn FnMut(&Machine, &str),
    ) -> Result<Next, Failure> {
        self.timed.go_on(book, machine, note)?;
        while let Some(step) = self.steps.steps.get(self.index) {
            if let &Action::Repeat { from, times } = &step.action {
                self.repeat(from, times);
                continue;
            }
            if let (None, Some(text)) = (&self.progress, &step.note) {
                note(machine, text);
            }
            let mut progress = self.progress.take().unwrap_or_else(|| Progress::new(machine));
            let next = book.go_on(&step.action, &mut progress, machine);
            let next = next.map_err(|failure| self.described(failure.at(&step.place)))?;
            if next == Next::Cycle {
                if let Err(stopped) = book.begin_cycle(machine) {
                    let failure = book.stopped(stopped, &step.action, &progress, machine);
                    return Err(self.described(failure.at(&step.place)));
                }
                self.progress = Some(progress);
                return Ok(Next::Cycle);
            }
            (self.index, self.progress) = (self.index + 1, None);
        }
        Ok(Next::Over)
    }

    /// Called after a cycle.
    pub(super) fn end_cycle(&mut self, book: &mut Book, machine: &Machine) -> Result<(), Failure> {
        let ended = book.end_cycle(machine);
        let (Some(step), Some(progress)) = (self.steps.steps.get(self.index), &mut self.progress) else {
            return Ok(());
        };
        if let Err(stopped) = ended {
            let failure = book.stopped(stopped, &step.action, progress, machine).at(&step.place);
            return Err(self.described(failure));
        }
        progress.count();
        Ok(())
    }

    /// Goes back to the first of the repeated steps, or on if they have run often enough.
    fn repeat(&mut self, from: usize, times: u64) {
        let at = self.index;
        let done = match self.repeated.last_mut() {
            Some((index, done)) if *index == at => {
                *done += 1;
                *done
            }
            Some(_) | None => {
                self.repeated.push((at, 1));
                1
            }
        };
        if done < times {
            self.index = from;
        } else {
            self.repeated.pop();
            self.index += 1;
        }
    }

    /// The failure, with the steps that include the present one and the number of the repetition.
    fn described(&self, failure: Failure) -> Failure {
        let Failure::Missed(mut missed) = failure else {
            return failure;
        };
        let mut lines = Vec::new();
        for Included { place, range, times } in
            self.steps.included.iter().filter(|included| included.range.contains(&self.index))
        {
            let repetition = range.end - 1;
            let done = self.repeated.iter().find(|(index, _)| *index == repetition).map_or(0, |(_, done)| *done);
            let times = if *times > 1 { format!(", time {} of {times}", done + 1) } else { String::new() };
            lines.push(format!("included at {place}{times}"));
        }
        missed.operands.splice(0..0, lines);
        Failure::Missed(missed)
    }

    /// Exchanges what happens at a time; the steps and their progress stay.
    pub(super) fn happen(&mut self, timed: Timed) {
        self.timed = timed;
    }

    /// The entries of `[[at]]` whose time did not come.
    pub(super) fn remarks(&self) -> impl Iterator<Item = String> {
        self.timed.remarks()
    }

    /// The steps, with those that they include.
    pub(super) fn stages(&self) -> Vec<Stage> {
        let stage = |step: &Step| Stage { place: step.place.clone(), note: step.note.as_deref().map(str::to_owned) };
        self.steps.steps.iter().map(stage).collect()
    }

    /// The index of the step that is executed; the number of steps if all are done.
    pub(super) fn index(&self) -> usize {
        self.index
    }

    pub(super) fn looks_back(&self) -> bool {
        self.steps.steps.iter().any(Step::looks_back)
    }
}

impl Step {
    fn looks_back(&self) -> bool {
        match &self.action {
            Action::Wait(expression, _) | Action::Hold(expression, _) => expression.looks_back(),
            Action::Expect(expressions) => expressions.iter().any(|(_, expression)| expression.looks_back()),
            Action::Capture(captures) => captures.iter().any(|(_, expression)| expression.looks_back()),
            Action::Queue(_)
            | Action::Handwheel(_)
            | Action::Pulse(..)
            | Action::Run(_)
            | Action::Image(_)
            | Action::Nothing
            | Action::Repeat { .. } => false,
        }
    }
}

/// A scenario that runs on a machine which its caller steps.
pub struct Operator {
    book: Book,
    plan: Plan,
    state: State,
}

/// A step of a scenario, for a list of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stage {
    /// Where it is written.
    pub place: Place,
    /// Its note.
    pub note: Option<String>,
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
                Err(failure) => self.fail(failure, machine),
            }
        }
        notes
    }

    /// Evaluates the last step. Call it after each step and before the record of the machine is drained, because edges are read from it.
    pub fn look(&mut self, machine: &Machine) {
        if self.state == State::Acting {
            self.book.note_changes(machine);
            if let Err(failure) = self.plan.end_cycle(&mut self.book, machine) {
                self.fail(failure, machine);
            }
        }
    }

    /// Ends the scenario with a failure, which also names the rules that were broken before.
    fn fail(&mut self, failure: Failure, machine: &Machine) {
        self.state = self.book.finish(Some(failure), machine).map_or(State::Done, State::Failed);
    }

    /// Its steps, with those that it includes.
    #[must_use]
    pub fn stages(&self) -> Vec<Stage> {
        self.plan.stages()
    }

    /// The index of the step that is executed; the number of steps if all are done.
    #[must_use]
    pub fn index(&self) -> usize {
        self.plan.index
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
