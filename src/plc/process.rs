//! The description of a PLC program in another process; `live` runs it.

use std::path::PathBuf;

use crate::units::Time;

/// A PLC program in another process, which maps the interface as a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlcProcess {
    /// The program and its arguments, separated by spaces; quotes keep a word together. `{image}` stands for the mapped file.
    pub command: String,
    /// The folder in which it runs.
    pub directory: PathBuf,
    /// How long it may take until it opens the file, and for an answer, by the clock of the computer.
    pub time_out: Time,
    /// Whether its output is printed on standard error; otherwise its last lines are part of a failure.
    pub is_shown: bool,
}

impl PlcProcess {
    /// The time-out unless a scenario says otherwise: a computer that runs many tests is slow.
    pub const TIME_OUT: Time = Time::from_millis(10_000);
}
