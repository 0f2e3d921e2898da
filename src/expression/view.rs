//! What an expression is evaluated against: borrowed moments of a machine.

use crate::image::Memory;
use crate::units::Time;
use crate::variables::Variables;

/// Everything that an expression looks at, at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The signals.
    pub memory: &'a Memory,
    /// Axis values and alarms.
    pub variables: &'a Variables,
    /// Since the caller's time zero, such as the start of a scenario.
    pub time: Time,
    /// The caller's own values, in the order of [`Scope::named_values`](super::Scope::named_values); one that is not there yet has no value (NaN).
    pub named_values: &'a [f64],
}

/// Now, and the last two cycles, between which edges are found.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// What everything but an edge looks at.
    pub now: Moment<'a>,
    /// After the last cycle.
    pub last: Moment<'a>,
    /// After the cycle before it.
    pub before: Moment<'a>,
}

impl<'a> View<'a> {
    /// One moment without a history, in which nothing rises or falls.
    #[must_use]
    pub fn at(now: Moment<'a>) -> Self {
        Self { now, last: now, before: now }
    }
}
