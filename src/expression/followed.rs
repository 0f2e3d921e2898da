//! The history of `since(E)` and `count(E)`: how often a term became true, and when it did so last.

use super::term::{Term, truth};
use super::view::View;
use crate::units::Time;

/// A term of expressions whose rising edges are counted. The caller that evaluates the expressions owns it.
#[derive(Clone, Debug, PartialEq)]
pub struct Followed {
    pub(super) of: Term,
    was: bool,
    count: u64,
    last: Option<Time>,
}

impl Followed {
    pub(super) fn new(of: Term) -> Self {
        Self { of, was: false, count: 0, last: None }
    }

    /// Starts with the state before the first cycle: a term that is true there has not become true.
    pub fn begin(&mut self, view: &View<'_>) {
        *self = Self { was: truth(self.of.value(view)), count: 0, last: None, of: self.of.clone() };
    }

    /// Takes up the state after a cycle.
    pub fn observe(&mut self, view: &View<'_>) {
        let is = truth(self.of.value(view));
        if is && !self.was {
            self.count += 1;
            self.last = Some(view.now.time);
        }
        self.was = is;
    }

    /// How often the term became true.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// Seconds since it became true last; infinite if it never did.
    pub(super) fn since(&self, now: Time) -> f64 {
        self.last.map_or(f64::INFINITY, |last| (now - last).seconds())
    }
}
