//! The messages of the language: what they are called, and where they were found.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What a message is called: a published number, or one of the names that stand in for a number that no source gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum FaultCode {
    /// `nc-syntax`: the block cannot be read.
    Syntax,
    /// `nc-call`: a subroutine does not exist, or calls are nested too deeply.
    Call,
    /// `nc-value`: a value is not possible.
    Value,
    /// `link-not-alone`: a command of axis coupling is not alone in its block.
    LinkNotAlone,
    /// `link-denominator`: the denominator of a coupling factor is 0.
    LinkDenominator,
    /// A published number; all of them are in [`NUMBERS`].
    Number(u32),
}

/// The published numbers that the language can report, with their meaning. 20003, 20375, 20685 and 21111 are warnings.
pub const NUMBERS: [(u32, &str); 27] = [
    (AXIS_MISSING, "G function without its axes"),
    (DWELL_TWICE, "dwell time both directly and with an axis"),
    (MOTION_TWICE, "more than one G function for the kind of movement"),
    (ZERO_OFFSET_TWICE, "more than one G function for zero offsets"),
    (TRANSITION_TWICE, "more than one G function for the block transition"),
    (CENTRE_TWICE, "more than one G function for the centre of circles"),
    (PERCENT_IN_MAIN_PROGRAM, "percent sign in the main program"),
    (CONTROL_DEPTH, "control blocks nested too deeply"),
    (UNEXPECTED_ELSE, "$ELSE does not match the control block"),
    (UNEXPECTED_ELSEIF, "$ELSEIF does not match the control block"),
    (UNEXPECTED_ENDIF, "$ENDIF does not match the control block"),
    (OPEN_AT_END, "valid control blocks open at the program end"),
    (SLAVE_IS_MASTER, "slave axis equals its master axis"),
    (SLAVE_TWICE, "slave axis listed twice"),
    (SLAVE_AND_MASTER, "axis is both master and slave"),
    (DWELL_AXES, "dwell time with additional axes"),
    (LABEL_TWICE, "label defined more than once"),
    (JUMP_TARGET, "character behind $GOTO not permitted"),
    (NUMBER_TWICE, "block number programmed twice"),
    (NUMERATOR, "numerator of the coupling factor is 0"),
    (NO_DENOMINATOR, "denominator of the coupling factor is missing"),
    (FACTOR, "coupling factor is not -1 or 1, set to 1"),
    (PERCENT_IN_GLOBAL_SUBROUTINE, "percent sign in a global subroutine"),
    (SKIPPED_AT_LOCAL_END, "skipped control blocks open at the end of a local subroutine"),
    (SKIPPED_AT_MAIN_END, "skipped control blocks open at the end of the main program"),
    (SKIPPED_AT_GLOBAL_END, "skipped control blocks open at the end of a global subroutine"),
    (BEHIND_CALL, "NC commands behind a subroutine call"),
];

pub(super) const AXIS_MISSING: u32 = 20003;
pub(super) const DWELL_TWICE: u32 = 20013;
pub(super) const MOTION_TWICE: u32 = 20108;
pub(super) const ZERO_OFFSET_TWICE: u32 = 20116;
pub(super) const TRANSITION_TWICE: u32 = 20117;
pub(super) const CENTRE_TWICE: u32 = 20127;
pub(super) const PERCENT_IN_MAIN_PROGRAM: u32 = 20193;
pub(super) const CONTROL_DEPTH: u32 = 20211;
pub(super) const UNEXPECTED_ELSE: u32 = 20214;
pub(super) const UNEXPECTED_ELSEIF: u32 = 20216;
pub(super) const UNEXPECTED_ENDIF: u32 = 20218;
pub(super) const OPEN_AT_END: u32 = 20375;
pub(super) const SLAVE_IS_MASTER: u32 = 20475;
pub(super) const SLAVE_TWICE: u32 = 20476;
pub(super) const SLAVE_AND_MASTER: u32 = 20477;
pub(super) const DWELL_AXES: u32 = 20685;
pub(super) const LABEL_TWICE: u32 = 20836;
pub(super) const JUMP_TARGET: u32 = 20839;
pub(super) const NUMBER_TWICE: u32 = 20841;
pub(super) const NUMERATOR: u32 = 21077;
pub(super) const NO_DENOMINATOR: u32 = 21110;
pub(super) const FACTOR: u32 = 21111;
pub(super) const PERCENT_IN_GLOBAL_SUBROUTINE: u32 = 21313;
pub(super) const SKIPPED_AT_LOCAL_END: u32 = 21500;
pub(super) const SKIPPED_AT_MAIN_END: u32 = 21501;
pub(super) const SKIPPED_AT_GLOBAL_END: u32 = 21502;
pub(super) const BEHIND_CALL: u32 = 21542;

impl fmt::Display for FaultCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Syntax => f.write_str("nc-syntax"),
            Self::Call => f.write_str("nc-call"),
            Self::Value => f.write_str("nc-value"),
            Self::LinkNotAlone => f.write_str("link-not-alone"),
            Self::LinkDenominator => f.write_str("link-denominator"),
            Self::Number(number) => write!(f, "{number}"),
        }
    }
}

/// A message about a block. As an error nothing of the block is executed, and the program ends there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fault {
    /// What it is called.
    pub code: FaultCode,
    /// The path of the program.
    pub program: String,
    /// The N number of the block, if it has one.
    pub block: Option<u32>,
    /// The line of the program, counted from one.
    pub line: u32,
    /// The column, counted from one.
    pub column: u32,
    /// What was found, and what is allowed.
    pub text: String,
    /// The pair of a coupling group that it is about.
    pub pair: Option<FaultyPair>,
}

/// The axis that a message about a pair names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaultyPair {
    /// Its name, or its logical number.
    pub axis: String,
    /// The number of the coupling group.
    pub group: i64,
}

impl Fault {
    /// The number that `channel_1.block` shows: the N number, of a block without one its line.
    #[must_use]
    pub fn number(&self) -> u32 {
        self.block.unwrap_or(self.line)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.code)?;
        if let Some(number) = self.block {
            write!(f, "block N{number}: ")?;
        }
        f.write_str(&self.text)
    }
}

/// An error inside the language: the place is a byte of the line that is being read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Error {
    pub(super) code: FaultCode,
    pub(super) at: usize,
    pub(super) text: String,
    pub(super) pair: Option<FaultyPair>,
}

impl Error {
    pub(super) fn new(code: FaultCode, at: usize, text: impl Into<String>) -> Self {
        Self { code, at, text: text.into(), pair: None }
    }

    /// The same error, about an axis of a coupling group.
    pub(super) fn of_pair(self, axis: String, group: i64) -> Self {
        Self { pair: Some(FaultyPair { axis, group }), ..self }
    }

    pub(super) fn syntax(at: usize, text: impl Into<String>) -> Self {
        Self::new(FaultCode::Syntax, at, text)
    }

    pub(super) fn value(at: usize, text: impl Into<String>) -> Self {
        Self::new(FaultCode::Value, at, text)
    }
}
