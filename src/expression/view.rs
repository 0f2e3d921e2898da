//! The input of an evaluation: borrowed moments of a machine.

use super::edges::Edges;
use super::history::History;
use crate::image::Memory;
use crate::units::Time;
use crate::variables::{RuleNumber, Variables};

/// The state of a machine at one moment, as far as expressions read it.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The signals.
    pub memory: &'a Memory,
    /// Axis values and alarms.
    pub variables: &'a Variables,
    /// Time since time zero of the caller, such as the start of a scenario.
    pub time: Time,
    /// The values of the caller, in the order of [`Scope::named_values`](super::Scope::named_values); NaN for a value that is not yet
    /// available.
    pub named_values: &'a [f64],
    /// The rules behind the last edges of the signals of `cause`: those of [`Edges`](super::Edges).
    pub rules: &'a [Option<RuleNumber>],
}

/// The current state, and the last two cycles for the detection of edges.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The state that everything except an edge reads.
    pub now: Moment<'a>,
    /// The state after the last cycle.
    pub last: Moment<'a>,
    /// The state after the cycle before the last one.
    pub before: Moment<'a>,
    /// The histories of `since` and `count`: those of [`Conditions`](super::Conditions).
    pub followed: &'a [History],
}

impl<'a> View<'a> {
    /// One moment without a history, in which no edge occurs.
    #[must_use]
    pub fn at(now: Moment<'a>) -> Self {
        Self { now, last: now, before: now, followed: &[] }
    }

    /// The same with these signals of `cause`.
    #[must_use]
    pub fn with_edges<'b>(&self, edges: &'b Edges) -> View<'b>
    where
        'a: 'b,
    {
        View {
            now: Moment { rules: edges.rules(), ..self.now },
            last: Moment { rules: edges.rules(), ..self.last },
            before: Moment { rules: edges.rules_before(), ..self.before },
            followed: self.followed,
        }
    }
}
