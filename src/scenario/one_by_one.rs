//! A session that is told its steps in the notation of scenario files, and one that continues from a saved machine. Callers in other
//! languages use it: the module for Python.

use std::path::Path;

use super::failure::Failure;
use super::file::steps_of;
use super::operator::Plan;
use super::passing::{Book, Next};
use super::program_rows::begun;
use super::programs::NcPrograms;
use super::session::Session;
use super::steps::{Reader, Steps};
use super::timed::Timed;
use super::written::WrittenSteps;
use crate::machine::Machine;
use crate::source::Table;

impl Session {
    /// Executes one step, `{ wait = "X.position > 5", within = "2s" }`, with any verb of scenarios. Paths in it are relative to the working
    /// directory. A `wait` without `within` waits without limit.
    ///
    /// # Errors
    /// The step has no verb, or a name or a value in it is wrong; or the machine does not do what it expects.
    pub fn step(&mut self, step: Table) -> Result<(), Failure> {
        self.execute(Path::new(""), &WrittenSteps::Tables([step].into()))
    }

    /// Executes the steps of a scenario file, or of a file that has only steps; a head has no effect. Captured names are shared.
    ///
    /// # Errors
    /// The file cannot be used, or a step fails.
    pub fn include(&mut self, file: impl AsRef<Path>) -> Result<(), Failure> {
        let file = file.as_ref();
        self.execute(file, &steps_of(file)?)
    }

    fn execute(&mut self, file: &Path, written: &WrittenSteps) -> Result<(), Failure> {
        let mut reader = Reader::new(&self.machine, file);
        reader.captured.clone_from(&self.book.captured_names);
        reader.followed.clone_from(&self.book.followed);
        reader.programs = NcPrograms::after(self.texts.clone(), &self.machine);
        let mut steps = Steps::default();
        reader.steps(written, &mut steps)?;
        let Reader { captured, followed, programs, .. } = reader;
        self.texts = programs.texts().to_vec();
        programs.load(&mut self.machine);
        self.book.captured_names = captured;
        self.follow_more(followed);
        let mut plan = Plan::new(steps, Timed::default());
        loop {
            let Self { machine, book, trace, .. } = self;
            let note = &mut |machine: &Machine, text: &str| trace.note(machine.cycle() + 1, text);
            if plan.go_on(book, machine, note)? == Next::Over {
                return Ok(());
            }
            self.cycle();
            plan.end_cycle(&mut self.book, &self.machine)?;
        }
    }

    /// The complete state of the machine, as bytes.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        self.machine.save()
    }

    /// Continues from a saved machine with the same files and the same PLC program. The session begins anew: its trace is empty, its time
    /// is 0, its rules and captured values are forgotten. What it watches stays.
    ///
    /// # Errors
    /// The bytes are not those of such a machine; nothing has changed then.
    pub fn restore(&mut self, saved: &[u8]) -> Result<(), Failure> {
        self.machine.restore(saved)?;
        self.trace = begun(&self.machine);
        self.trace.watch_values(&self.watch, self.machine.cycle(), self.machine.variables());
        self.book = Book::new(&self.machine);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Problem;

    fn step(text: &str) -> Table {
        Table::parse(text, "step").unwrap()
    }

    fn session() -> Session {
        Session::open("g1_example").unwrap()
    }

    #[test]
    fn a_step_acts_as_in_a_file() {
        let mut session = session();
        session.step(step("set = { \"M10.0\" = 1 }\nnote = \"on\"")).unwrap();
        session.step(step("run = \"2ms\"")).unwrap();
        session.step(step("capture = { before = \"M10.0 + 1\" }")).unwrap();
        session.step(step("expect = [\"M10.0 == 1\", \"before == 2\"]")).unwrap();
        assert!(session.text().contains("# on"), "{}", session.text());
        let missed = session.step(step("expect = \"M10.0 == 0\"")).unwrap_err();
        assert!(missed.to_string().contains("M10.0 = 1"), "{missed}");
        let wrong = session.step(step("sett = { \"M10.0\" = 1 }")).unwrap_err();
        assert!(matches!(&wrong, Failure::Unusable(Problem { cure, .. }) if cure.contains("`set`")), "{wrong}");
    }

    #[test]
    fn another_text_of_a_program_is_another_program() {
        let mut session = session();
        session.step(step("nc = \"G0 X1\"")).unwrap();
        session.step(step("nc = \"G0 X2\"")).unwrap();
        let paths: Vec<_> = session.texts.iter().map(|(_, path)| path.as_str()).collect();
        assert_eq!(paths.len(), 2);
        assert_ne!(paths[0], paths[1]);
    }

    #[test]
    fn a_restored_session_begins_anew_and_continues_with_the_same_bytes() {
        let mut first = session();
        first.set("M10.0", 1).unwrap();
        first.run("100ms").unwrap();
        let saved = first.save();
        first.run("100ms").unwrap();
        let mut second = session();
        second.watch(&["X.position"]).unwrap();
        second.run("10ms").unwrap();
        second.restore(&saved).unwrap();
        assert_eq!(second.time(), crate::units::Time::ZERO);
        let rows = second.text();
        assert!(!rows.contains("M10.0") && rows.contains("0.000  X.position"), "{rows}");
        second.run("100ms").unwrap();
        assert_eq!(second.save(), first.save());
        assert!(second.restore(&saved[1..]).is_err());
        assert_eq!(second.save(), first.save());
    }
}
