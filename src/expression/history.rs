//! The history of a condition: how often it became true, and when it did so last.

use crate::units::Time;

/// The rising edges of a condition so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct History {
    was: bool,
    count: u64,
    last: Option<Time>,
}

impl History {
    /// A history that begins with this truth: a condition that is true at the beginning has not become true.
    pub(super) fn begin(is: bool) -> Self {
        Self { was: is, ..Self::default() }
    }

    /// Takes up the truth after a cycle.
    pub(super) fn observe(&mut self, is: bool, now: Time) {
        if is && !self.was {
            self.count += 1;
            self.last = Some(now);
        }
        self.was = is;
    }

    /// How often the condition became true.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// Seconds since it became true last; infinite if it never did.
    pub(super) fn since(&self, now: Time) -> f64 {
        self.last.map_or(f64::INFINITY, |last| (now - last).seconds())
    }
}
