//! What names mean in a scenario: those of its machine, and those of the values that its steps captured.

use crate::expression::Scope;
use crate::image::Location;
use crate::machine::Machine;
use crate::source::Problem;
use crate::variables::Describe;

/// The names of a machine and of the values captured so far.
pub(super) struct Known<'a> {
    pub(super) machine: &'a Machine,
    pub(super) captured: &'a [String],
}

impl Scope for Known<'_> {
    fn describe(&self) -> &dyn Describe {
        self.machine
    }

    fn signal(&self, name: &str) -> Result<Location, Problem> {
        self.machine.signal(name)
    }

    fn named_values(&self) -> &[String] {
        self.captured
    }
}
