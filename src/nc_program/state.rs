//! The state of the interpreter as plain data: it is saved with its channel, and a copy of it continues exactly as the original.

use serde::{Deserialize, Serialize};

use super::functions::Modal;
use super::macros::Macro;
use super::names::AxisIndex;
use super::search::{BlockTarget, StructureKind};
use super::source::Program;
use super::variables::Variable;

/// The interpreter of a channel: one program from its start to its end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interpreter {
    pub(super) modal: Modal,
    pub(super) feed: Option<f64>,
    /// The programmable offset, in millimetres or degrees.
    pub(super) offset: Vec<(AxisIndex, f64)>,
    /// The main program first.
    pub(super) levels: Vec<Level>,
    /// The next block waits until everything before has been executed.
    pub(super) is_stopped: bool,
    /// MSG, SETM, CLEARM or WAITMC, and no executable block since.
    pub(super) is_unseparated: bool,
    /// The end of the text is the end of the program: blocks of MDA need no M30.
    pub(super) ends_with_text: bool,
    /// The block of the main program before which preparation stops, if it only calculates.
    pub(super) target: Option<BlockTarget>,
}

/// A program level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Level {
    /// The path of the program.
    pub(super) program: String,
    /// The line that is read next, counted from one.
    pub(super) line: u32,
    /// Passes, with this one.
    pub(super) passes: u32,
    /// No statement has been read yet: PROC is possible.
    pub(super) is_at_start: bool,
    /// A block other than PROC and DEF has been read.
    pub(super) has_begun: bool,
    pub(super) variables: Vec<Variable>,
    /// How many of the variables are parameters.
    pub(super) parameters: usize,
    /// Open control structures, the innermost one last.
    pub(super) structures: Vec<Structure>,
    /// Running repetitions of REPEAT label, the innermost one last.
    pub(super) repetitions: Vec<Repetition>,
    /// SAVE: what comes back at the return.
    pub(super) saved: Option<Saved>,
    pub(super) is_single_block_off: bool,
    pub(super) is_display_off: bool,
    /// DEFINE.
    pub(super) macros: Vec<Macro>,
    /// The subprogram replaces an M function (MD10715).
    pub(super) replaces_function: bool,
}

/// An open control structure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Structure {
    pub(super) kind: StructureKind,
    /// The line of its first word.
    pub(super) line: u32,
    /// The end value of FOR.
    pub(super) last: f64,
}

/// A part of the program that is repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Repetition {
    pub(super) first: u32,
    pub(super) last: u32,
    /// Passes after this one.
    pub(super) left: u32,
    /// Where the program goes on.
    pub(super) back: u32,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Saved {
    pub(super) modal: Modal,
    pub(super) offset: Vec<(AxisIndex, f64)>,
}

impl Level {
    pub(super) fn new(program: String) -> Self {
        Self {
            program,
            line: 1,
            passes: 1,
            is_at_start: true,
            has_begun: false,
            variables: Vec::new(),
            parameters: 0,
            structures: Vec::new(),
            repetitions: Vec::new(),
            saved: None,
            is_single_block_off: false,
            is_display_off: false,
            macros: Vec::new(),
            replaces_function: false,
        }
    }

    pub(super) fn variable(&self, name: &str) -> Option<usize> {
        self.variables.iter().position(|variable| variable.name == name)
    }
}

impl Interpreter {
    /// A program at its first block.
    ///
    /// `path` is the [`Program::path`](super::Program::path), `modal` and `feed` are what holds at the start (MD20150, MD20152, SD42110).
    /// With `ends_with_text` the program needs no M30, as the blocks of MDA.
    #[must_use]
    pub fn new(path: &str, modal: Modal, feed: Option<f64>, ends_with_text: bool) -> Self {
        Self {
            modal,
            feed,
            offset: Vec::new(),
            levels: vec![Level::new(path.to_owned())],
            is_stopped: false,
            is_unseparated: false,
            ends_with_text,
            target: None,
        }
    }

    /// The modal G functions after the last prepared block.
    #[must_use]
    pub fn modal(&self) -> Modal {
        self.modal
    }

    /// A path feedrate for a program that has none yet.
    pub fn assume_feed(&mut self, feed: Option<f64>) {
        self.feed = self.feed.or(feed);
    }

    /// The path feedrate after the last prepared block.
    #[must_use]
    pub fn feed(&self) -> Option<f64> {
        self.feed
    }

    /// The programmable offset after the last prepared block.
    #[must_use]
    pub fn offset(&self) -> &[(AxisIndex, f64)] {
        &self.offset
    }

    /// Stops once before a block of the main program that only calculates, jumps or calls:
    /// [`step`](Self::step) returns [`Prepared::Before`](super::Prepared::Before) instead of executing it.
    pub fn stop_before(&mut self, target: BlockTarget) {
        self.target = Some(target);
    }

    /// Whether the program has ended.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.levels.is_empty()
    }

    /// The programs of all levels with the line that each reads next; the main program first.
    pub fn stack(&self) -> impl Iterator<Item = (&str, u32)> {
        self.levels.iter().map(|level| (level.program.as_str(), level.line))
    }

    /// Passes that the current subprogram still has, with this one.
    #[must_use]
    pub fn passes(&self) -> u32 {
        self.levels.last().map_or(0, |level| level.passes)
    }

    /// Goes to a block of the main program, as if there were nothing before it. Returns whether it exists.
    pub fn go_to(&mut self, program: &Program, block: &BlockTarget) -> bool {
        let (Some(line), Some(level)) = (block.line(program), self.levels.first_mut()) else { return false };
        (level.line, level.is_at_start, level.has_begun) = (line, false, true);
        true
    }

    /// Drops the other passes of the current subprogram (DB21.DBX6.3).
    pub fn delete_passes(&mut self) {
        if let Some(level) = self.levels.last_mut() {
            level.passes = 1;
        }
    }

    /// Leaves the current subprogram (DB21.DBX6.4). Returns whether there was one; the main program stays.
    pub fn abort_level(&mut self) -> bool {
        if self.levels.len() < 2 {
            return false;
        }
        self.leave();
        true
    }

    /// Goes back to the caller; SAVE brings back what held before the call.
    pub(super) fn leave(&mut self) {
        let Some(level) = self.levels.pop() else { return };
        if let Some(saved) = level.saved {
            (self.modal, self.offset) = (saved.modal, saved.offset);
        }
    }
}
