//! Tests of the language, over a channel that has what a test gives it.

mod any_text;
mod calls;
mod checks;
mod commands;
mod comments;
mod control;
mod examples;
mod expressions;
mod refused;
mod words;

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::isg::language::{Block, Command, Environment, Fault, Interpreter, Prepared, Refusal, Variables, is_called};
use crate::nc_program::{Program, ProgramKind};

/// A channel for tests.
pub(super) struct Channel {
    programs: Vec<Arc<Program>>,
    /// `V.` variables of the channel.
    pub(super) variables: BTreeMap<String, f64>,
    pub(super) is_executed: bool,
    pub(super) skipped: Vec<u8>,
}

impl Channel {
    pub(super) fn new(files: &[(&str, &str)]) -> Self {
        let programs = files.iter().map(|(name, text)| Arc::new(program(name, text))).collect();
        let variables = [("V.G.AX_LINK.NR", 3.0), ("V.G.AX_LINK.ACTIVE", 1.0), ("V.E.OUT", 0.0), ("V.S.KEPT", 7.0)];
        let variables = variables.map(|(name, value)| (name.to_owned(), value)).into();
        Self { programs, variables, is_executed: true, skipped: Vec::new() }
    }

    /// The first program from its start to its end.
    pub(super) fn run(&mut self, lenient: bool) -> Result<Vec<Block>, Fault> {
        let mut interpreter = Interpreter::new(&self.programs[0].path(), lenient);
        self.go_on(&mut interpreter)
    }

    pub(super) fn go_on(&mut self, interpreter: &mut Interpreter) -> Result<Vec<Block>, Fault> {
        let mut blocks = Vec::new();
        for _ in 0..1000 {
            match interpreter.next(self)? {
                Prepared::Block(block) => blocks.push(*block),
                Prepared::Calculated(_) => {}
                Prepared::Waits(origin) => panic!("waits in line {}", origin.line),
                Prepared::Ended => return Ok(blocks),
            }
        }
        panic!("the program does not end");
    }
}

impl Variables for Channel {
    fn read(&self, name: &str) -> Option<f64> {
        self.variables.get(name).copied()
    }

    fn may_write(&self, name: &str, value: f64) -> Result<(), Refusal> {
        match self.variables.get(name) {
            None => Err(Refusal::Unknown),
            Some(_) if value > 100.0 => Err(Refusal::Value),
            Some(_) => Ok(()),
        }
    }

    fn write(&mut self, name: &str, value: f64) {
        self.variables.insert(name.to_owned(), value);
    }

    fn waits(&self, name: &str) -> bool {
        name.starts_with("V.G.AX_LINK.")
    }
}

impl Environment for Channel {
    fn is_executed(&self) -> bool {
        self.is_executed
    }

    fn is_skipped(&self, level: u8) -> bool {
        self.skipped.contains(&level)
    }

    fn program(&self, path: &str) -> Option<Arc<Program>> {
        self.programs.iter().find(|program| program.path() == path).cloned()
    }

    fn find_program(&self, name: &str) -> Option<Arc<Program>> {
        self.programs.iter().find(|program| is_called(name, program)).cloned()
    }
}

pub(super) fn program(name: &str, text: &str) -> Program {
    Program::new(name, ProgramKind::Main, "", text.as_bytes())
}

/// The blocks of a program, read strictly.
pub(super) fn blocks(text: &str) -> Vec<Block> {
    Channel::new(&[("part.nc", text)]).run(false).unwrap()
}

/// The fault of a program, read strictly: its name, line, column, and text.
pub(super) fn fault(text: &str) -> (String, u32, u32, String) {
    let fault = Channel::new(&[("part.nc", text)]).run(false).unwrap_err();
    (fault.code.to_string(), fault.line, fault.column, fault.text)
}

/// The name and the column of the fault of one line.
pub(super) fn code(line: &str) -> (String, u32) {
    let (code, number, column, _) = fault(line);
    assert_eq!(number, 1, "{line}");
    (code, column)
}

/// The commands of a program, read strictly.
pub(super) fn commands(text: &str) -> Vec<Command> {
    blocks(text).into_iter().filter_map(|block| block.command).collect()
}
