//! The signals of `cause(S, 'ID')`, with the rules behind their last edges.

use crate::image::Location;
use crate::variables::RuleNumber;

/// The signals of all `cause` of a caller, each once, with the rules behind their last edges. A signal without an edge has no rule; nor has
/// one whose last edge has no cause, because another side than the control wrote it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edges {
    signals: Vec<Location>,
    rules: Vec<Option<RuleNumber>>,
    /// The rules one cycle earlier.
    before: Vec<Option<RuleNumber>>,
}

impl Edges {
    /// The number of signals.
    #[must_use]
    pub fn len(&self) -> usize {
        self.signals.len()
    }

    /// Whether there is no signal.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.signals.is_empty()
    }

    /// The rules after the last cycle, for [`Moment::rules`](super::Moment::rules).
    #[must_use]
    pub fn rules(&self) -> &[Option<RuleNumber>] {
        &self.rules
    }

    /// The rules one cycle earlier.
    #[must_use]
    pub fn rules_before(&self) -> &[Option<RuleNumber>] {
        &self.before
    }

    /// The index of a signal; a new one is added.
    pub(super) fn index_of(&mut self, signal: Location) -> usize {
        self.signals.iter().position(|known| *known == signal).unwrap_or_else(|| {
            self.signals.push(signal);
            self.rules.push(None);
            self.before.push(None);
            self.signals.len() - 1
        })
    }

    /// Starts the signals from `first` on with the rules behind their last edges so far: now, and one cycle earlier.
    pub fn begin(&mut self, first: usize, rules: impl Fn(Location) -> [Option<RuleNumber>; 2]) {
        for (index, signal) in self.signals.iter().enumerate().skip(first) {
            [self.rules[index], self.before[index]] = rules(*signal);
        }
    }

    /// Takes up the edges of a cycle: `rule` returns the rule behind the edge of a signal, or the given one if the cycle has no edge of it.
    pub fn observe(&mut self, rule: impl Fn(Location, Option<RuleNumber>) -> Option<RuleNumber>) {
        self.before.clone_from(&self.rules);
        for (signal, last) in self.signals.iter().zip(&mut self.rules) {
            *last = rule(*signal, *last);
        }
    }
}
