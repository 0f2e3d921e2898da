//! The counters of a server: connections, bytes, refusals. They are read with
//! [`Server::counters`](super::Server::counters).

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use super::end::End;
use super::refusals::Refused;

/// Counts since the start of a server.
#[derive(Debug, Default)]
pub struct Counters {
    /// Accepted connections, without those that were rejected.
    pub connections: Counter,
    /// Clients rejected because of their network.
    pub foreign: Counter,
    /// Clients rejected because of the client limit.
    pub crowded: Counter,
    /// Received bytes.
    pub received: Counter,
    /// Sent bytes.
    pub sent: Counter,
    /// Answers, pushes and transport confirms.
    pub answers: Counter,
    /// Requests that changed something.
    pub writes: Counter,
    /// Updates sent for subscriptions: cyclic values and changed values.
    pub pushes: Counter,
    /// Answers that were delayed, dropped, replaced or cut off by an injected fault.
    pub faults: Counter,
    /// Ended connections by kind of end.
    pub(super) ends: [Counter; End::ALL.len()],
    refusals: Mutex<BTreeMap<Refused, u64>>,
}

impl Counters {
    /// The number of refusals by code.
    #[must_use]
    pub fn refusals(&self) -> Vec<(Refused, u64)> {
        let refusals = self.refusals.lock().unwrap_or_else(PoisonError::into_inner);
        refusals.iter().map(|(refused, count)| (*refused, *count)).collect()
    }

    /// The number of ended connections by kind of end.
    pub fn ends(&self) -> impl Iterator<Item = (&'static str, u64)> {
        End::ALL.iter().zip(&self.ends).map(|(end, count)| (end.name(), count.get()))
    }

    pub(super) fn refused(&self, refused: Refused) {
        *self.refusals.lock().unwrap_or_else(PoisonError::into_inner).entry(refused).or_default() += 1;
    }
}

/// A number that only increases.
#[derive(Debug, Default)]
pub struct Counter(AtomicU64);

impl Counter {
    /// The number.
    #[must_use]
    pub fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    pub(super) fn add(&self, count: usize) {
        self.0.fetch_add(count as u64, Ordering::Relaxed);
    }

    /// Increments and returns the new number.
    pub(super) fn next(&self) -> u64 {
        self.0.fetch_add(1, Ordering::Relaxed) + 1
    }
}
