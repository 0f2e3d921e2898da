//! The conditions of `since(E)` and `count(E)`, which a caller shows every cycle.

use super::history::History;
use super::term::{Term, truth};
use super::view::View;

/// The conditions of all `since` and `count` of a caller, each once, with their histories.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Followed {
    terms: Vec<Term>,
    histories: Vec<History>,
}

impl Followed {
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
