//! What the names of an expression mean, given by the caller.

use crate::image::Location;
use crate::source::Problem;
use crate::variables::Describe;

/// What the names of an expression mean.
pub trait Scope {
    /// The names of axes and channels, and the alarms of the control.
    fn describe(&self) -> &dyn Describe;

    /// The place in memory of a symbol or an address.
    ///
    /// # Errors
    /// There is no such signal; the cure names the nearest known one.
    fn signal(&self, name: &str) -> Result<Location, Problem>;

    /// The names of values that the caller gives beside the machine, such as captured values or constants, in the order of
    /// [`Moment::named_values`](super::Moment::named_values).
    fn named_values(&self) -> &[String] {
        &[]
    }
}
