//! CAMPAIGNS: many cases of one scenario, and one answer.
//!
//! A [`Spec`] names a base scenario, what varies, and what must hold. Its cases are numbered: [`Spec::values`] is a pure function of the
//! number, so that threads and computers can share the work. Cases that are the same up to some time are one [unit](Spec::units), which
//! runs their common beginning once and forks it. [`Spec::run`] runs a unit; a [`Record`] is the result of a case, one line of JSON. A
//! [`Summary`] groups the failures of all records, and [`Spec::shrink`] makes the smallest scenario that fails in the same way.
//!
//! Nothing here uses a clock, a thread or a file other than those of the base scenario: `cli::campaign` does.

mod apply;
mod dimension;
mod hash;
mod oracles;
mod record;
mod run;
mod shrink;
mod spec;
mod strategy;
mod summary;
mod timed;
mod written;

pub use record::{Header, Lines, Reading, Record, Verdict};
pub use shrink::Smallest;
pub use spec::Spec;
pub use summary::{Boundary, Group, MarginRow, Summary};

#[cfg(test)]
mod tests;
