//! Expressions over the interface: `X.gantry_synchronization_ready_to_start && alarm(10654)`.
//!
//! Numbers are `f64`, and 0 is false. Operators and their precedence are Rust's; comparisons do not chain.
//!
//! # Contract
//!
//! A caller uses this module in two phases.
//!
//! 1. **Parsing.** [`Expression::parse`] looks up every name in a [`Scope`]. The scope is a trait that the owner of the names implements:
//!    `Machine` knows signals, axes, channels and alarms, a scenario adds its captured values. An unknown name is rejected here, before
//!    anything runs, and the error contains the nearest known name. The result contains memory locations and numbers, but no names.
//! 2. **Evaluation.** [`Expression::value`] and [`Expression::holds`] read a [`View`]: three borrowed [`Moment`]s of the machine that the
//!    expression was parsed for. Evaluation allocates, copies and stores nothing, and the same view gives the same value. A caller without
//!    a history passes [`View::at`], in which no edge occurs.
//!
//! | in an expression | means | read from |
//! |---|---|---|
//! | `X.controller_enable`, `DB31.DBX2.1`, `MD24:REAL` | [`Scope::signal`] | [`Moment::memory`] of `now` |
//! | `X.position`, `CHAN1.block`, `R5`, `R5[CHAN2]` | [`NamedValue`](crate::variables::NamedValue), with the names in [`Scope::describe`] | [`Moment::variables`] of `now` |
//! | `alarm(10654)`, `alarm(10651, X)`, `alarm_parameter(10651, 1)`, `alarms()` | alarms in [`Scope::describe`] | [`Moment::variables`] of `now` |
//! | `time` | seconds since time zero of the caller | [`Moment::time`] of `now` |
//! | any other plain name | [`Scope::named_values`] | [`Moment::named_values`] of `now` |
//! | `rose(…)`, `fell(…)` | an edge between two cycles | the same of `before` and `last` |
//! | `since(…)`, `count(…)` | the last rising edge of a condition, and their number | [`View::followed`] |
//! | `cause(X.referenced_synchronized_1, 'REF-03')` | whether this rule made the last edge of a signal | [`Moment::rules`] of `now` |
//! | `abs`, `min`, `max` | arithmetic | |
//!
//! `now` can be ahead of `last`: a scenario sees its own writes before a cycle takes them over. A caller that evaluates edges must provide
//! `before`, the state one cycle earlier. [`Expression::looks_back`] reports whether an expression needs it. A caller that evaluates `since`
//! and `count` lists their conditions with [`Expression::follow`] and shows them every cycle; otherwise they never became true. The same call
//! lists the signals of `cause`, whose edges the caller takes up in every cycle; otherwise they have no edge.

mod edges;
mod followed;
mod history;
mod of_control;
mod parse;
mod scope;
mod term;
mod tokens;
mod view;

pub use edges::Edges;
pub use followed::{Conditions, Followed};
pub use history::History;
pub use scope::Scope;
pub use view::{Moment, View};

use crate::source::Problem;
use crate::variables::Describe;
use term::{Term, truth};

/// An expression whose names have been looked up.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    source: Box<str>,
    root: Term,
}

impl Expression {
    /// Parses an expression and looks its names up.
    ///
    /// # Errors
    /// The text is not an expression, or a name in it is unknown; the problem names the nearest known name.
    pub fn parse(source: &str, scope: &dyn Scope) -> Result<Self, Problem> {
        Ok(Self { source: source.trim().into(), root: parse::parse(source.trim(), scope)? })
    }

    /// The text of the expression.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Its value. Evaluation does not allocate.
    #[must_use]
    pub fn value(&self, view: &View<'_>) -> f64 {
        self.root.value(view)
    }

    /// Whether its value is true: neither 0 nor undefined.
    #[must_use]
    pub fn holds(&self, view: &View<'_>) -> bool {
        truth(self.value(view))
    }

    /// How far its value is from becoming false, or true if it is false, which is negative then: the distance of the nearest comparison that
    /// decides, in the unit of the compared values; `None` if no comparison decides.
    #[must_use]
    pub fn distance(&self, view: &View<'_>) -> Option<f64> {
        Some(self.root.distance(view)).filter(|distance| distance.is_finite())
    }

    /// Whether it compares two cycles. The caller must then keep the previous cycle.
    #[must_use]
    pub fn looks_back(&self) -> bool {
        self.root.any(&|term| matches!(term, Term::Edge { .. }))
    }

    /// Lists the conditions of `since` and `count` and the signals of `cause` in it, each once, so that the caller can follow them.
    pub fn follow(&mut self, followed: &mut Followed) {
        self.root.each(&mut |term| {
            if let Term::Cause(term) = term {
                term.index = Some(followed.edges.index_of(term.signal));
            } else if let Term::Followed(term) = term {
                term.index = Some(followed.conditions.index_of(&term.of));
            }
        });
    }

    /// Every signal and value in it with its current value, one line each, without repetition.
    #[must_use]
    pub fn operands(&self, view: &View<'_>, describe: &dyn Describe) -> Vec<String> {
        let mut lines = Vec::new();
        self.root.operands(view, describe, &mut lines);
        lines
    }
}

#[cfg(test)]
mod tests;
