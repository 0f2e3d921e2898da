//! Tables of transitions: a state machine takes only the steps that stand in its table.

use super::rules::Rule;

/// A step from one phase to another by a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transition<P> {
    /// From.
    pub from: P,
    /// To.
    pub to: P,
    /// By.
    pub by: Rule,
}

/// A row of a table.
pub(super) const fn row<P>(from: P, by: Rule, to: P) -> Transition<P> {
    Transition { from, to, by }
}

/// Where a rule leads from a phase; a step that is not in the table is a mistake of the caller and leads to the first phase.
pub(super) fn next<P: Copy + PartialEq + Default + std::fmt::Debug>(table: &[Transition<P>], from: P, by: Rule) -> P {
    let to = table.iter().find(|row| row.from == from && row.by == by).map(|row| row.to);
    debug_assert!(to.is_some(), "no step from {from:?} by {by:?}");
    to.unwrap_or_default()
}
