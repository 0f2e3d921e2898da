//! How a prepared scenario runs: to its end, up to a time, or on from a copy of its state.

use super::failure::{Failure, Missed, Progress};
use super::file::Scenario;
use super::passing::Next;
use super::run::{Finished, Prepared};
use super::session::Session;
use super::steps::Reader;
use super::timed::Timed;
use crate::machine::Machine;
use crate::source::Problem;
use crate::trace::Window;
use crate::units::Time;
use crate::variables::Describe;

impl Prepared {
    /// Runs the steps in order until one fails.
    #[must_use]
    pub fn run(self) -> Finished {
        self.run_until(None)
    }

    /// The same, but ends after the last cycle up to this time, if a time is given and the scenario lasts so long.
    #[must_use]
    pub fn run_until(self, end: Option<Time>) -> Finished {
        self.run_with(end, &mut |_| {})
    }

    /// The same, and shows the machine after each cycle.
    #[must_use]
    pub fn run_with(mut self, end: Option<Time>, look: &mut dyn FnMut(&Machine)) -> Finished {
        let failure = self.go(end, look);
        let Session { machine, book, .. } = &mut self.session;
        // A run that was to end here is not judged by what its rules still wait for.
        let failure = failure.and_then(|failure| book.finish(failure, machine));
        let failure = failure.map(|failure| failure.of_case(self.head.case.as_deref()));
        let Self { session, plan, head, causes, .. } = self;
        Finished { session, plan, head, causes, window: Window::default(), failure }
    }

    /// Runs up to the last cycle that ends at or before this time, for a caller that goes on with [`Prepared::run`] or forks it.
    pub fn advance(&mut self, end: Time) {
        let _ = self.go(Some(end), &mut |_| {});
    }

    /// The index of the step that is executed next.
    #[must_use]
    pub fn reached(&self) -> usize {
        self.plan.index()
    }

    /// The time since the start, and whether the steps are done or one has failed.
    #[must_use]
    pub fn progress(&self) -> (Time, bool) {
        (self.session.time(), matches!(self.progress, Progress::Over(_)))
    }

    /// A second run that continues independently from this state.
    ///
    /// # Errors
    /// The PLC program cannot be copied.
    pub fn fork(&self) -> Result<Self, Failure> {
        let Self { session, plan, head, causes, process, progress } = self;
        let (plan, head, process) = (plan.clone(), head.clone(), process.clone());
        Ok(Self { session: session.fork()?, plan, head, causes: *causes, process, progress: progress.clone() })
    }

    /// Exchanges what happens at a time, from now on, for the `[[at]]` of another scenario that is otherwise the same.
    ///
    /// # Errors
    /// An entry does not fit the machine; the problem names file and line.
    pub fn happen(&mut self, other: &Scenario) -> Result<(), Problem> {
        let timed = Timed::read(&other.at, &mut Reader::new(self.session.machine(), &other.path))?;
        self.plan.happen(timed);
        Ok(())
    }

    /// Runs until a step fails or all are done, and returns the failure, if there is one; `None` if the time came first.
    fn go(&mut self, end: Option<Time>, look: &mut dyn FnMut(&Machine)) -> Option<Option<Failure>> {
        let failure = match &self.progress {
            Progress::Over(failure) => return Some(failure.clone()),
            Progress::New => {
                self.progress = Progress::Running;
                let begun = self.session.machine.begin_program().err();
                begun.map(|problem| match &self.process {
                    Some(place) => problem.at(place),
                    None => problem,
                })
            }
            Progress::Running => None,
        };
        let failure = match failure {
            Some(problem) => Some(problem.into()),
            None => loop {
                let Session { machine, book, trace, .. } = &mut self.session;
                let next = book.time(machine) + machine.cycle_time();
                if end.is_some_and(|end| next > end) {
                    return None;
                }
                let note = &mut |machine: &Machine, text: &str| trace.note(machine.cycle() + 1, text);
                match self.plan.go_on(book, machine, note) {
                    Err(failure) => break Some(failure),
                    Ok(Next::Over) => break None,
                    Ok(Next::Cycle) => self.session.cycle(),
                }
                look(&self.session.machine);
                let Session { machine, book, trace, .. } = &mut self.session;
                let ended = self.plan.end_cycle(book, machine);
                for note in book.take_notes() {
                    trace.note(machine.cycle(), note);
                }
                if let Err(failure) = ended {
                    break Some(failure);
                }
                if let Some(failure) = self.end_of_process() {
                    break Some(failure);
                }
            },
        };
        self.progress = Progress::Over(failure.clone());
        Some(failure)
    }

    /// The failure of a PLC process that has ended or is silent. The PLC is then in STOP, and no step of the scenario is a test of it.
    fn end_of_process(&self) -> Option<Failure> {
        let place = self.process.as_ref()?;
        let machine = &self.session.machine;
        let fault = machine.plc_fault()?;
        let alarms = machine.variables().alarms.iter();
        let alarms = alarms.map(|alarm| format!("{} {}", machine.alarm_name(alarm.number), machine.alarm_text(alarm)));
        let missed = Missed {
            place: Some(place.clone()),
            time: self.session.time(),
            case: None,
            what: fault.to_owned(),
            operands: Vec::new(),
            alarms: alarms.collect(),
        };
        Some(missed.into())
    }
}
