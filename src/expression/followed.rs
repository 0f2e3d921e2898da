//! What a caller follows from cycle to cycle for its expressions: the conditions of `since(E)` and `count(E)`, and the signals of
//! `cause(S, 'ID')`.

use super::edges::Edges;
use super::history::History;
use super::term::{Term, truth};
use super::view::View;

/// What all expressions of a caller look back at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Followed {
    /// The conditions of `since` and `count`.
    pub conditions: Conditions,
    /// The signals of `cause`.
    pub edges: Edges,
}

impl Followed {
    /// Whether it has a condition or a signal that `known` does not have.
    #[must_use]
    pub fn is_more_than(&self, known: &Self) -> bool {
        self.conditions.len() > known.conditions.len() || self.edges.len() > known.edges.len()
    }
}

/// The conditions of all `since` and `count` of a caller, each once, with their histories.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conditions {
    terms: Vec<Term>,
    histories: Vec<History>,
}

impl Conditions {
    /// The number of conditions.
    #[must_use]
    pub fn len(&self) -> usize {
        self.terms.len()
    }

    /// Whether there is no condition.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.terms.is_empty()
    }

    /// The histories, for [`View::followed`].
    #[must_use]
    pub fn histories(&self) -> &[History] {
        &self.histories
    }

    /// The index of a condition; a new one is added.
    pub(super) fn index_of(&mut self, term: &Term) -> usize {
        self.terms.iter().position(|known| known == term).unwrap_or_else(|| {
            self.terms.push(term.clone());
            self.histories.push(History::default());
            self.terms.len() - 1
        })
    }

    /// Starts the conditions from `first` on with the state before the next cycle.
    pub fn begin(&mut self, first: usize, view: &View<'_>) {
        for (term, history) in self.terms.iter().zip(&mut self.histories).skip(first) {
            *history = History::begin(truth(term.value(view)));
        }
    }

    /// Takes up the state after a cycle.
    pub fn observe(&mut self, view: &View<'_>) {
        for (term, history) in self.terms.iter().zip(&mut self.histories) {
            history.observe(truth(term.value(view)), view.now.time);
        }
    }
}
