//! A rule: what must hold, its name and its place.

use super::span::Span;
use crate::expression::Expression;
use crate::source::Place;

/// What must hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// The condition is true after every cycle.
    Always(Expression),
    /// The condition is false after every cycle.
    Never(Expression),
    /// A consequence follows every rising edge.
    Follows(Box<Consequence>),
}

/// A consequence that must follow every rising edge of a condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Consequence {
    /// The condition whose rising edges open a watch.
    pub when: Expression,
    /// The consequence.
    pub then: Expression,
    /// The consequence must be true at the latest in the cycle that completes this.
    pub within: Span,
    /// The consequence must not be true before this is over.
    pub not_before: Span,
    /// A condition that is true before the first cycle counts as an edge.
    pub from_start: bool,
    /// A run without any edge breaks the rule.
    pub must_begin: bool,
}

/// A rule of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Its name; a condition of the head of a scenario has none.
    pub name: Option<String>,
    /// Its place, if it is in a file.
    pub place: Option<Place>,
    /// What must hold.
    pub claim: Claim,
    /// A breach is noted and the run goes on.
    pub go_on: bool,
}

impl Rule {
    /// All its expressions.
    pub fn expressions(&self) -> impl Iterator<Item = &Expression> {
        let pair = match &self.claim {
            Claim::Always(expression) | Claim::Never(expression) => [Some(expression), None],
            Claim::Follows(consequence) => [Some(&consequence.when), Some(&consequence.then)],
        };
        pair.into_iter().flatten()
    }
}
