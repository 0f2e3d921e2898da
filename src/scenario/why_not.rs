//! Why a signal does not have another value now: the tree of what the control tests, back to the signals of the PLC and who wrote them.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::naming::signal_named;
use super::program_rows::{in_its_format, word};
use super::session::Session;
use crate::image::{Location, Part, Writer};
use crate::machine::{Subject, Tested};
use crate::plc;
use crate::source::Problem;
use crate::trace::Shown;

impl Session {
    /// What must hold so that a bit of the control becomes the opposite of its value now, as a tree. Shows only what does not hold;
    /// `complete` shows what holds, too. Of a byte or a word that the PLC program writes: the statements and the operands that make it.
    ///
    /// # Errors
    /// The signal does not exist, the control writes it and it is no bit, or the control says nothing about it.
    pub fn why_not(&self, signal: &str, complete: bool) -> Result<String, Problem> {
        let machine = self.machine();
        let names = machine.names();
        let location = signal_named(machine, signal)?;
        let shown = self.shown(location);
        if location.width != 1 && names.writer(location) != Some(Writer::Nck) {
            let value = Shown::of(location, machine.memory().read(location));
            let text = format!("{:>9}  {shown} is {value}: {}\n", self.time().to_string(), self.writer(location));
            let mut tree = Tree { session: self, complete, recursive: true, text, asked: BTreeSet::new() };
            tree.written(location, 1);
            return Ok(tree.text);
        }
        if location.width != 1 {
            let cure = "ask for one bit: `X.position_controller_active@0.3`, `DB31.DBX61.5@0.3`";
            return Err(Problem::new(format!("expected a signal of one bit, found {shown}"), cure));
        }
        let value = machine.memory().read(location) != 0;
        let head = format!("{:>9}  {shown} is {}", self.time().to_string(), u8::from(value));
        if names.writer(location) != Some(Writer::Nck) {
            let text = format!("{head}: the control does not write it; {}\n", self.writer(location));
            let asked = BTreeSet::from([(location, !value)]);
            let mut tree = Tree { session: self, complete, recursive: true, text, asked };
            tree.program(location, !value, 1);
            return Ok(tree.text);
        }
        let Some(tested) = machine.conditions(location, !value) else {
            let cure =
                "`opennck why` shows the cause of its last edge; `opennck signals` shows the signals that are modelled";
            return Err(Problem::new(format!("expected a signal with known conditions, found {shown}"), cure));
        };
        let asked = BTreeSet::from([(location, !value)]);
        let mut tree = Tree { session: self, complete, recursive: complete || !value, text: head, asked };
        let word = if value { "; it becomes 0 with" } else { ", because" };
        tree.below(&tested, 0, word);
        Ok(tree.text)
    }

    /// `X.controller_enable (DB31.DBX2.1)`.
    fn shown(&self, location: Location) -> String {
        let names = self.machine().names();
        let address = names.address(location).to_string();
        let own = self.machine().program_symbols().and_then(|symbols| symbols.get(&address));
        let own = own.map(|symbol| format!("\"{symbol}\""));
        names.symbol(location).or(own).map_or_else(|| address.clone(), |symbol| format!("{symbol} ({address})"))
    }

    /// Who wrote a signal last.
    fn writer(&self, location: Location) -> String {
        match self.trace().last_change(location) {
            Some((time, by)) => format!("changed last at {time} s by {by}"),
            None => "never changed".to_owned(),
        }
    }
}

/// The ways of a disjunction, with those of the disjunctions inside it.
fn ways(any: &Tested) -> Vec<&Tested> {
    let each = |part| if any_of(part) { ways(part) } else { vec![part] };
    any.parts.iter().flat_map(each).collect()
}

fn any_of(tested: &Tested) -> bool {
    tested.what == Subject::Any
}

/// A tree under construction.
struct Tree<'a> {
    session: &'a Session,
    complete: bool,
    /// Whether signals of the control are explained in turn.
    recursive: bool,
    text: String,
    /// The signals already explained, with the value that they are to have.
    asked: BTreeSet<(Location, bool)>,
}

impl Tree<'_> {
    fn line(&mut self, depth: usize, holds: bool, text: &str) {
        let mark = if holds { "\u{2713}" } else { "\u{2717}" };
        let _ = writeln!(self.text, "{:>9}  {}{mark} {text}", "", "  ".repeat(depth));
    }

    /// A condition, and what it consists of.
    fn node(&mut self, tested: &Tested, depth: usize) {
        if tested.holds && !self.complete {
            return;
        }
        match &tested.what {
            Subject::All => self.all(tested, depth),
            Subject::Any => {
                let ways = ways(tested);
                if let [only] = *ways {
                    return self.node(only, depth);
                }
                self.line(depth, tested.holds, "one of");
                for way in ways {
                    let open = way.parts.iter().filter(|part| self.complete || !part.holds).count();
                    if way.what == Subject::All && open > 1 {
                        self.line(depth + 1, way.holds, "all of");
                        self.node(way, depth + 2);
                    } else {
                        self.node(way, depth + 1);
                    }
                }
            }
            Subject::Fact { what, found, wanted } => {
                self.line(depth, tested.holds, &format!("{what}: {found}, wanted {wanted}"));
                self.first(tested, depth + 1);
            }
            Subject::Signal(location, wanted) => self.signal(*location, *wanted, tested.holds, depth),
        }
    }

    /// The parts of a conjunction stand on the level of the conjunction.
    fn all(&mut self, tested: &Tested, depth: usize) {
        for part in &tested.parts {
            self.node(part, depth);
        }
    }

    /// What must hold before a fact changes.
    fn first(&mut self, fact: &Tested, depth: usize) {
        for part in &fact.parts {
            if part.holds && !fact.holds {
                self.line(depth, true, "no known condition of the next step is open: it follows within some cycles, or waits for something not listed");
            }
            self.node(part, depth);
        }
    }

    /// What a signal waits for, behind its own line, which ends with a word. A fact that only repeats the signal is a remark in this line.
    fn below(&mut self, tested: &Tested, depth: usize, word: &str) {
        match &tested.what {
            Subject::Fact { found, .. } if !tested.parts.is_empty() => {
                let _ = writeln!(self.text, " ({found}){word}");
                self.first(tested, depth + 1);
            }
            Subject::Fact { .. } | Subject::All | Subject::Any | Subject::Signal(..) => {
                let _ = writeln!(self.text, "{word}");
                self.node(tested, depth + 1);
            }
        }
    }

    /// The statements of the PLC program that keep a bit from a value, and the contacts that are open in them.
    fn program(&mut self, location: Location, wanted: bool, depth: usize) {
        let keeps = |cause: &plc::ProgramCause| cause.wrote(location).is_some_and(|value| (value != 0) != wanted);
        for cause in self.session.machine().program_writes(location).into_iter().filter(keeps) {
            self.statement(&cause, depth);
        }
    }

    /// The statements of the PLC program that write a byte or a word, and the operands of which they make it.
    fn written(&mut self, location: Location, depth: usize) {
        for cause in self.session.machine().program_writes(location) {
            self.statement(&cause, depth);
        }
    }

    fn statement(&mut self, cause: &plc::ProgramCause, depth: usize) {
        self.line(depth, false, &cause.statement);
        for tested in &cause.tested {
            match *tested {
                plc::Tested::Bit(operand, value) => self.signal(operand, !value, false, depth + 1),
                plc::Tested::Word(operand, value) => self.value(operand, value.into(), depth + 1),
                plc::Tested::Timer(number, status) => self.word(Part::Timers, number, status, depth + 1),
                plc::Tested::TimerValue(number, value) => {
                    self.value(word(Part::Timers, number), value.into(), depth + 1);
                }
                plc::Tested::Counter(number, status) => self.word(Part::Counters, number, status, depth + 1),
                plc::Tested::CounterValue(number, value) => {
                    self.value(word(Part::Counters, number), value.into(), depth + 1);
                }
                plc::Tested::Operation(ref text, value) => {
                    self.line(depth + 1, false, &format!("{text} = {}", u8::from(value)));
                }
            }
        }
    }

    /// A byte or a word that a statement read, and the statements that write it.
    fn value(&mut self, location: Location, value: u64, depth: usize) {
        let session = self.session;
        let location = in_its_format(location, session.machine().names());
        let (shown, value) = (session.shown(location), Shown::of(location, value));
        self.line(depth, false, &format!("{shown} = {value}: {}", session.writer(location)));
        if self.asked.insert((location, false)) {
            self.written(location, depth + 1);
        }
    }

    /// A timer or a counter, and the statement that does not start it.
    fn word(&mut self, part: Part, number: u16, status: bool, depth: usize) {
        let location = word(part, number);
        let shown = self.session.shown(location);
        self.line(depth, false, &format!("{shown} = {}, wanted {}", u8::from(status), u8::from(!status)));
        if self.asked.insert((location, !status)) {
            self.program(location, !status, depth + 1);
        }
    }

    fn signal(&mut self, location: Location, wanted: bool, holds: bool, depth: usize) {
        let session = self.session;
        let machine = session.machine();
        let (shown, found) = (session.shown(location), u8::from(holds == wanted));
        let expected = if holds { String::new() } else { format!(", wanted {}", u8::from(wanted)) };
        let mut text = format!("{shown} = {found}{expected}");
        let below = machine.conditions(location, wanted).filter(|_| !holds);
        match below {
            None => {
                let _ = write!(text, ": {}", session.writer(location));
                if machine.memory().read(location) != u64::from(found) {
                    text += ", on its way to the control (to_nck_delay)";
                }
                self.line(depth, holds, &text);
                if !holds && self.asked.insert((location, wanted)) {
                    self.program(location, wanted, depth + 1);
                }
            }
            Some(_) if !self.recursive => self.line(depth, holds, &text),
            Some(_) if !self.asked.insert((location, wanted)) => self.line(depth, holds, &format!("{text}, see above")),
            Some(below) => {
                self.line(depth, holds, &text);
                self.text.truncate(self.text.trim_end().len());
                self.below(&below, depth, "");
            }
        }
    }
}
