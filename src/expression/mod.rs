//! EXPRESSIONS over the interface: `X.gantry_synchronization_ready_to_start && alarm(10654)`.
//!
//! Numbers are `f64`, and 0 is false. Operators and their precedence are Rust's; comparisons do not chain.
//!
//! # Contract
//!
//! A caller meets this module twice.
//!
//! 1. **Reading.** [`Expression::parse`] looks up every name in a [`Scope`]. The scope is a trait, implemented where the names are
//!    known: `Machine` knows signals, axes, channels and alarms, a scenario adds its captured values. An
//!    unknown name is refused here, before anything runs, and the nearest known name is in the error. The result holds
//!    places in memory and numbers, no names to look up.
//! 2. **Evaluation.** [`Expression::value`] and [`Expression::holds`] read a [`View`]: three borrowed [`Moment`]s of the same machine
//!    that the expression was read for. Nothing is allocated, copied or kept, and the same view gives the same value. A caller
//!    that keeps no history passes [`View::at`], in which no edge occurs.
//!
//! | in an expression | means | read from |
//! |---|---|---|
//! | `X.controller_enable`, `DB31.DBX2.1`, `MD24:REAL` | [`Scope::signal`] | [`Moment::memory`] of `now` |
//! | `X.position` | [`AxisValue`](crate::variables::AxisValue) of an axis in [`Scope::describe`] | [`Moment::variables`] of `now` |
//! | `alarm(10654)`, `alarm(10651, X)`, `alarm_parameter(10651, 1)`, `alarms()` | alarms in [`Scope::describe`] | [`Moment::variables`] of `now` |
//! | `time` | seconds since the caller's time zero | [`Moment::time`] of `now` |
//! | any other plain name | [`Scope::named_values`] | [`Moment::named_values`] of `now` |
//! | `rose(…)`, `fell(…)` | an edge between two cycles | the same of `before` and `last` |
//! | `abs`, `min`, `max` | arithmetic | |
//!
//! `now` can be ahead of `last`: a scenario sees in it what it wrote and no cycle has taken up yet. A caller that evaluates edges has
//! to provide `before`, the state one cycle earlier; [`Expression::looks_back`] says whether it is needed.

mod parse;
mod scope;
mod term;
mod tokens;
mod view;

pub use scope::Scope;
pub use view::{Moment, View};

use crate::source::Problem;
use crate::variables::Describe;
use term::{Term, truth};

/// An expression whose names have been looked up.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    source: String,
    root: Term,
}

impl Expression {
    /// Reads an expression and looks its names up.
    ///
    /// # Errors
    /// It is not one, or a name in it is unknown; the problem names the nearest known one.
    pub fn parse(source: &str, scope: &dyn Scope) -> Result<Self, Problem> {
        Ok(Self { source: source.trim().to_owned(), root: parse::parse(source.trim(), scope)? })
    }

    /// The expression as it was written.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Its value; allocates nothing.
    #[must_use]
    pub fn value(&self, view: &View<'_>) -> f64 {
        self.root.value(view)
    }

    /// Whether its value is true, that is neither 0 nor undefined.
    #[must_use]
    pub fn holds(&self, view: &View<'_>) -> bool {
        truth(self.value(view))
    }

    /// Whether it compares two cycles, so that somebody has to remember the last one.
    #[must_use]
    pub fn looks_back(&self) -> bool {
        self.root.any(&|term| matches!(term, Term::Edge { .. }))
    }

    /// Every signal and value in it with what it is now, one line each, each once.
    #[must_use]
    pub fn operands(&self, view: &View<'_>, describe: &dyn Describe) -> Vec<String> {
        let mut lines = Vec::new();
        self.root.operands(view, describe, &mut lines);
        lines
    }
}

#[cfg(test)]
mod tests;
