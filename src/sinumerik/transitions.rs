//! Tables of transitions: a state machine takes only the steps that stand in its table, and each row remembers that it was taken.

use crate::sinumerik::rules::Rule;

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
pub(super) fn next<P: Copy + PartialEq + Default + std::fmt::Debug>(
    table: &[Transition<P>],
    taken: &mut Rows,
    from: P,
    by: Rule,
) -> P {
    let index = table.iter().position(|row| row.from == from && row.by == by);
    debug_assert!(index.is_some(), "no step from {from:?} by {by:?}");
    index.map_or_else(P::default, |index| {
        taken.0 |= 1 << index;
        table[index].to
    })
}

/// Rows of a table, a bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rows(u64);

impl Rows {
    /// Whether this row is among them.
    #[must_use]
    pub const fn has(self, index: usize) -> bool {
        index < u64::BITS as usize && self.0 >> index & 1 == 1
    }
}

/// The rows of both tables by which a control has gone since it was made, of whichever axis and grouping. They decide nothing and
/// are neither saved nor taken back: they tell what a suite of scenarios has exercised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TakenTransitions {
    /// Of the reference point approach.
    pub approach: Rows,
    /// Of the gantry grouping.
    pub grouping: Rows,
}

impl TakenTransitions {
    /// Adds what another control has taken.
    pub fn add(&mut self, other: Self) {
        self.approach.0 |= other.approach.0;
        self.grouping.0 |= other.grouping.0;
    }
}
