//! Variables of programs, and what the language needs from the channel.

use std::sync::Arc;

use crate::nc_program::Program;

/// Why a variable cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// There is no variable of this name.
    Unknown,
    /// It can only be read.
    ReadOnly,
    /// The value is not allowed.
    Value,
}

/// The variables of the channel: all `V.` variables but `V.L.` and `V.P.`, which the interpreter has itself, as it has the P parameters.
///
/// A name comes as it is written, with its indices as numbers: `V.G.AX_LINK.NR`, `V.G.T[2].X`.
pub trait Variables {
    /// The value; none if there is no such variable, or it cannot be read.
    fn read(&self, name: &str) -> Option<f64>;

    /// Whether [`write`](Self::write) will write this value. The interpreter asks for all variables of a block before it writes one.
    ///
    /// # Errors
    /// Why it cannot be written.
    fn may_write(&self, name: &str, value: f64) -> Result<(), Refusal>;

    /// Writes a variable, after [`may_write`](Self::may_write).
    fn write(&mut self, name: &str, value: f64);

    /// Whether reading or writing it has to wait until every block before has been executed. Indices are empty here: `V.G.T[].X`.
    fn waits(&self, name: &str) -> bool;
}

/// The channel, as the interpreter sees it.
pub trait Environment: Variables {
    /// Whether every block that was prepared has been executed.
    fn is_executed(&self) -> bool;

    /// Whether blocks with this skip level, 1 to 10, are skipped.
    fn is_skipped(&self, level: u8) -> bool;

    /// The program with this [`Program::path`].
    fn program(&self, path: &str) -> Option<Arc<Program>>;

    /// The global subroutine that `L NAME` means. The name is [`normalised`](crate::nc_program::normalised): in capitals, with its ending
    /// if the call has one.
    fn find_program(&self, name: &str) -> Option<Arc<Program>>;
}
