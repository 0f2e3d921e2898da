//! The meaning of names in an expression, provided by the caller.

use crate::image::Location;
use crate::source::Problem;
use crate::variables::Describe;

/// The meaning of names in an expression.
pub trait Scope {
    /// The names of axes and channels, and the alarms of the control.
    fn describe(&self) -> &dyn Describe;

    /// The memory location of a symbol or an address.
    ///
    /// # Errors
    /// The signal does not exist; the problem names the nearest known signal.
    fn signal(&self, name: &str) -> Result<Location, Problem>;

    /// The names of values that the caller provides in addition to the machine, such as captured values or constants, in the order of
    /// [`Moment::named_values`](super::Moment::named_values).
    fn named_values(&self) -> &[String] {
        &[]
    }
}
