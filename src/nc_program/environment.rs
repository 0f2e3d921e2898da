//! What the interpreter needs from its channel: R parameters, system variables, programs, axis names, skip levels.

use std::sync::Arc;

use super::dialect::Dialect;
use super::names::AxisNames;
use super::source::{Program, Request};
use super::value::Value;

/// A system variable with its indices: numbers, axes, or parts of frames (`TR`) as text.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemVariable<'a> {
    /// The name in capitals, with `$`.
    pub name: &'a str,
    /// The indices.
    pub indices: &'a [Value],
}

/// Why a system variable cannot be read or written. Each has its alarm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableRefusal {
    /// There is no variable of this name: 12550.
    Unknown,
    /// OpenNCK does not have this variable, the control does: 12553.
    NotModelled,
    /// The first index is outside its range: 17020.
    FirstIndex,
    /// The second index is outside its range: 17030.
    SecondIndex,
    /// The axis is no machine axis, or is not in the channel: 17040.
    Axis,
    /// Cannot be written: 17070.
    WriteProtected,
    /// Cannot be read: 17071.
    ReadProtected,
    /// The value is below its limit: 17080.
    Below,
    /// The value is above its limit: 17090.
    Above,
    /// The value is not valid: 17095.
    Invalid,
    /// The value has the wrong type: 12150.
    WrongType,
}

impl VariableRefusal {
    /// The number of its alarm.
    #[must_use]
    pub fn number(self) -> u32 {
        match self {
            Self::Unknown => 12550,
            Self::NotModelled => 12553,
            Self::FirstIndex => 17020,
            Self::SecondIndex => 17030,
            Self::Axis => 17040,
            Self::WriteProtected => 17070,
            Self::ReadProtected => 17071,
            Self::Below => 17080,
            Self::Above => 17090,
            Self::Invalid => 17095,
            Self::WrongType => 12150,
        }
    }

    pub(super) fn reason(self) -> &'static str {
        match self {
            Self::Unknown => "the control has no system variable of this name",
            Self::NotModelled => "OpenNCK does not model this system variable",
            Self::FirstIndex => "the first index is outside its range",
            Self::SecondIndex => "the second index is outside its range",
            Self::Axis => "the channel has no such machine axis",
            Self::WriteProtected => "it cannot be written",
            Self::ReadProtected => "it cannot be read",
            Self::Below => "the value is below the lower limit",
            Self::Above => "the value is above the upper limit",
            Self::Invalid => "the value is not valid",
            Self::WrongType => "the value has the wrong type",
        }
    }
}

/// The channel, as the interpreter sees it. All methods but the writes leave the channel as it is.
pub trait Environment {
    /// The dialect of the programs.
    fn dialect(&self) -> &'static Dialect;

    /// The names of axes.
    fn axes(&self) -> Arc<AxisNames>;

    /// The number of R parameters (MD28050): R0 to one less.
    fn r_parameters(&self) -> u32;

    /// An R parameter. The index is in the range.
    fn r_parameter(&self, index: u32) -> f64;

    /// Writes an R parameter. The index is in the range. R parameters belong to the control: they outlive program, RESET and power off.
    fn set_r_parameter(&mut self, index: u32, value: f64);

    /// Reads a system variable.
    ///
    /// # Errors
    /// The variable is unknown, or this cannot be read.
    fn system(&self, variable: &SystemVariable<'_>) -> Result<Value, VariableRefusal>;

    /// Writes a system variable.
    ///
    /// # Errors
    /// The variable is unknown, or the value is not allowed. Nothing is written then.
    fn set_system(&mut self, variable: &SystemVariable<'_>, value: &Value) -> Result<(), VariableRefusal>;

    /// Whether everything that was prepared has been executed. A block that must not run ahead waits for this.
    fn is_executed(&self) -> bool;

    /// Whether the movements that go on beyond their blocks (POSA) have ended, too. Commands that need standstill wait for this.
    fn is_at_rest(&self) -> bool {
        self.is_executed()
    }

    /// Whether blocks with this skip level, 0 to 9, are skipped.
    fn is_skipped(&self, level: u8) -> bool;

    /// Whether GOTOS jumps (DB21.DBX384.0).
    fn is_restarting(&self) -> bool;

    /// The program that is called instead of an M function (MD10715, MD10716).
    fn replacing_program(&self, _m: f64) -> Option<String> {
        None
    }

    /// The program that a call means.
    fn find_program(&self, request: &Request<'_>) -> Option<Arc<Program>>;

    /// The program with this [`Program::path`].
    fn program(&self, path: &str) -> Option<Arc<Program>>;
}
