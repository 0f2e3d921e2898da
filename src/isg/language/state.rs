//! The state of the interpreter as plain data: it is saved with its channel, and a copy of it continues exactly as the original.

use serde::{Deserialize, Serialize};

use super::block::{Block, Origin};
use super::scope::Store;
use super::search::Structure;

/// The interpreter of a channel: one program from its start to its end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interpreter {
    /// Documentation slips are read as they were meant.
    pub(super) lenient: bool,
    /// The main program first; empty: ended.
    pub(super) levels: Vec<Level>,
    /// P parameters and `V.P.` variables.
    pub(super) variables: Store,
}

/// A program level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Level {
    /// The path of the program.
    pub(super) program: String,
    /// The first line of the main program or of the local subroutine; 0: it is searched first.
    pub(super) section: u32,
    /// The line that is read next.
    pub(super) line: u32,
    /// A subroutine of its file (`LL`), which the next header line ends; a `%` in a main program is an error.
    pub(super) is_local: bool,
    /// `V.L.` variables.
    pub(super) variables: Store,
    /// Open control blocks, the innermost one last.
    pub(super) open: Vec<Open>,
}

/// An open control block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Open {
    pub(super) structure: Structure,
    /// The line that opens it.
    pub(super) line: u32,
    /// The line behind that.
    pub(super) next: u32,
    /// `$IF`, `$SWITCH`: no branch was taken yet.
    pub(super) is_searching: bool,
    /// `$IF`: its `$ELSE` has been passed.
    pub(super) has_else: bool,
    /// `$IF`: it has no `$ENDIF`; only with `lenient`.
    pub(super) is_unclosed: bool,
    /// `$SWITCH`: the value that is compared. `$FOR`: the end value.
    pub(super) value: f64,
    /// `$FOR`: the step.
    pub(super) step: f64,
    /// `$FOR`: the counting variable.
    pub(super) variable: String,
}

impl Level {
    /// The main program of a file; where it begins is searched first.
    pub(super) fn main(program: String) -> Self {
        Self { program, section: 0, line: 0, is_local: false, variables: Store::new(), open: Vec::new() }
    }

    /// A local subroutine that begins at a line.
    pub(super) fn local(program: String, section: u32) -> Self {
        Self { section, line: section, is_local: true, ..Self::main(program) }
    }
}

/// What the interpreter has prepared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Prepared {
    /// A block to execute.
    Block(Box<Block>),
    /// The block reads or writes a variable that needs everything before to be executed: call again when it is.
    Waits(Box<Origin>),
    /// Many blocks that only calculate, jump or call, up to this one: call again.
    Calculated(Box<Origin>),
    /// There are no more blocks.
    Ended,
}

impl Interpreter {
    /// A program at its first block. `path` is the [`Program::path`](crate::nc_program::Program::path).
    #[must_use]
    pub fn new(path: &str, lenient: bool) -> Self {
        Self { lenient, levels: vec![Level::main(path.to_owned())], variables: Store::new() }
    }

    /// Whether the program has ended.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.levels.is_empty()
    }

    /// How many subroutines deep the program is; 0 in the main program.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.levels.len().saturating_sub(1)
    }

    /// The program and the line that are read next; none at the end. The line is 0 before the first block.
    #[must_use]
    pub fn position(&self) -> Option<(&str, u32)> {
        self.levels.last().map(|level| (level.program.as_str(), level.line))
    }

    /// A P parameter (`P10`), or a variable `V.P.` or `V.L.` of the innermost level.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<f64> {
        let local = self.levels.last().and_then(|level| level.variables.get(name));
        local.or_else(|| self.variables.get(name)).copied()
    }
}
